//! The transform messages of Foxglove's schema registry, with their official field numbers.

use super::message;

message! { "google.protobuf" "google/protobuf/timestamp.proto"
    /// A moment, counted from the start of the clock in use: here, of simulated time.
    Timestamp {
        1 seconds: [int64] i64, "Whole seconds [s]";
        2 nanos: [int32] i32, "Nanoseconds beyond them [ns], 0 to 999,999,999";
    }
}

message! { "foxglove" "foxglove/Vector3.proto"
    /// A vector in 3D space that represents a direction only
    Vector3 {
        1 x: [double] f64, "x coordinate";
        2 y: [double] f64, "y coordinate";
        3 z: [double] f64, "z coordinate";
    }
}

message! { "foxglove" "foxglove/Quaternion.proto"
    /// A quaternion representing a rotation in 3D space
    Quaternion {
        1 x: [double] f64, "x value";
        2 y: [double] f64, "y value";
        3 z: [double] f64, "z value";
        4 w: [double] f64, "w value";
    }
}

message! { "foxglove" "foxglove/FrameTransform.proto"
    /// A transform between two reference frames in 3D space
    FrameTransform {
        1 timestamp: [message, optional] Option<Timestamp>, "Timestamp of transform";
        2 parent_frame_id: [string] String, "Name of the parent frame";
        3 child_frame_id: [string] String, "Name of the child frame";
        4 translation: [message, optional] Option<Vector3>, "Translation component of the transform [m]";
        5 rotation: [message, optional] Option<Quaternion>, "Rotation component of the transform";
    }
}

message! { "foxglove" "foxglove/FrameTransforms.proto"
    /// An array of FrameTransform messages
    FrameTransforms {
        1 transforms: [message, repeated] Vec<FrameTransform>, "Array of transforms";
    }
}
