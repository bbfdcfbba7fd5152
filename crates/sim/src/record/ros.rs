//! The ROS 2 messages of a log, as CDR, with the definitions a reader decodes them by.

use super::cdr::CdrWriter;

/// Full definition of `sensor_msgs/msg/JointState`, its dependencies appended the way rosbag2 does.
pub(super) const JOINT_STATE: &str = "\
std_msgs/Header header

# Names of the joints; position [rad or m], velocity [rad/s or m/s] and effort [N m or N] run in the same order.
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
";

/// Full definition of `std_msgs/msg/String`.
pub(super) const STRING: &str = "string data\n";

/// A moment of simulated time, whole nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stamp {
    pub(super) seconds: i32,
    pub(super) nanos: u32,
}

impl Stamp {
    /// The nearest nanosecond to `t` [s], for a time that [`Sample::check`](super::Sample::check) has let through.
    pub(super) fn new(t: f64) -> Self {
        let nanos = (t.fract() * 1e9).round() as u32;
        // 0.9999999999 s rounds up to the next second.
        Self { seconds: t.trunc() as i32 + (nanos / 1_000_000_000) as i32, nanos: nanos % 1_000_000_000 }
    }

    /// Nanoseconds since the start of simulated time.
    pub(super) fn total_nanos(self) -> u64 {
        self.seconds.unsigned_abs() as u64 * 1_000_000_000 + u64::from(self.nanos)
    }
}

/// One joint of a `JointState`.
pub(super) struct JointRow<'a> {
    pub(super) name: &'a str,
    pub(super) position: f64,
    pub(super) velocity: f64,
    pub(super) effort: f64,
}

/// A `sensor_msgs/msg/JointState` with an empty frame.
pub(super) fn joint_state(stamp: Stamp, joints: &[JointRow<'_>]) -> Vec<u8> {
    let mut cdr = CdrWriter::new();
    cdr.i32(stamp.seconds);
    cdr.u32(stamp.nanos);
    cdr.string("");
    cdr.strings(joints.iter().map(|j| j.name));
    cdr.f64s(joints.iter().map(|j| j.position));
    cdr.f64s(joints.iter().map(|j| j.velocity));
    cdr.f64s(joints.iter().map(|j| j.effort));
    cdr.finish()
}

/// A `std_msgs/msg/String`.
pub(super) fn string(text: &str) -> Vec<u8> {
    let mut cdr = CdrWriter::new();
    cdr.string(text);
    cdr.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joint_state_is_aligned_as_cdr_prescribes() {
        let stamp = Stamp { seconds: 1, nanos: 2 };
        let bytes = joint_state(stamp, &[JointRow { name: "j1", position: 1.0, velocity: 2.0, effort: 3.0 }]);
        let mut expected = vec![0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0];
        expected.extend([1, 0, 0, 0, 0, 0, 0, 0]); // frame_id "" with its NUL, then padding to the next length
        expected.extend([1, 0, 0, 0, 3, 0, 0, 0, b'j', b'1', 0, 0]); // one name
        for value in [1.0f64, 2.0, 3.0] {
            expected.extend([1, 0, 0, 0]);
            let padding = (8 - (expected.len() - 4) % 8) % 8;
            expected.extend(std::iter::repeat_n(0, padding));
            expected.extend(value.to_le_bytes());
        }
        assert_eq!(bytes, expected);
    }

    #[test]
    fn stamp_is_the_nearest_nanosecond() {
        for (t, total) in [(0.0, 0), (0.001, 1_000_000), (1.999_999_999_9, 2_000_000_000), (3.25, 3_250_000_000)] {
            assert_eq!(Stamp::new(t).total_nanos(), total);
        }
    }
}
