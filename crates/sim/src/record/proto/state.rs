//! `gyroflex.State`: all that is particular to flexible joints and geared motors.

use super::foxglove::{Quaternion, Vector3};
use super::message;
use crate::bending::Tip as Deflection;
use crate::record::{Footing, RunInfo, Sample, Touch};

message! { "gyroflex" "gyroflex/Joint.proto"
    /// One joint at one instant. Motor quantities are reflected to the link side.
    /// Units are those of a turning joint; of a sliding one they are m, m/s, m/s^2 and N.
    Joint {
        1 name: [string] String, "Name of the joint in the URDF";
        2 prismatic: [bool] bool, "Whether the joint slides";
        3 q: [double] f64, "Link position [rad]";
        4 qd: [double] f64, "Link velocity [rad/s]";
        5 qdd: [double] f64, "Link acceleration [rad/s^2]";
        6 theta: [double] f64, "Motor position [rad]; q where no elastic transmission is";
        7 thetad: [double] f64, "Motor velocity [rad/s]";
        8 thetadd: [double] f64, "Motor acceleration [rad/s^2]";
        9 deflection: [double] f64, "Deflection of the transmission [rad]";
        10 tau_j: [double] f64, "Torque through the transmission [N m]";
        11 tau: [double] f64, "Torque of the motor [N m]";
        12 gyroscopic: [double] f64, "Torque on the link that the rotors' coupling causes [N m]";
        13 friction: [double] f64, "Friction of both sides [N m]";
        14 reference: [double] f64, "Reference position [rad]";
        15 tracking_error: [double] f64, "Reference minus link position [rad]";
    }
}

message! { "gyroflex" "gyroflex/Base.proto"
    /// A floating root: its pose in the world, its twist in its own frame.
    Base {
        1 position: [message, optional] Option<Vector3>, "Origin of the root frame in the world [m]";
        2 orientation: [message, optional] Option<Quaternion>, "Rotation from the root frame to the world";
        3 angular_velocity: [message, optional] Option<Vector3>, "Angular velocity, root axes [rad/s]";
        4 linear_velocity: [message, optional] Option<Vector3>, "Velocity of the root's origin, root axes [m/s]";
    }
}

message! { "gyroflex" "gyroflex/Contact.proto"
    /// A point of the robot that the ground may hold.
    Contact {
        1 name: [string] String, "Name of the contact point";
        2 force: [message, optional] Option<Vector3>, "Force of the ground on it, world axes [N]";
        3 gap: [double] f64, "Height above the ground [m]";
        4 mode: [double] f64, "0 off the ground, 1 held by it, 2 slipping on it";
    }
}

message! { "gyroflex" "gyroflex/Footing.proto"
    /// What holds a robot beside its joints.
    Support {
        1 contacts: [message, repeated] Vec<Contact>, "Points that the ground may hold";
        2 center_of_mass: [message, optional] Option<Vector3>, "Centre of mass in the world [m]";
        3 zero_moment_point: [message, optional] Option<Vector3>, "Where the ground's forces have no moment along it, in the world [m]";
        4 constraint_drift: [double] f64, "Largest error of position of all that is held so far [m or rad]";
    }
}

message! { "gyroflex" "gyroflex/Mode.proto"
    /// One assumed mode of a link that bends. Units are those of a displacement; in torsion they are rad, rad/s and rad/s^2.
    Mode {
        1 name: [string] String, "Name of the mode";
        2 turning: [bool] bool, "Whether its coordinate is an angle";
        3 eta: [double] f64, "Modal coordinate [m]";
        4 etad: [double] f64, "Its rate [m/s]";
        5 etadd: [double] f64, "Its acceleration [m/s^2]";
    }
}

message! { "gyroflex" "gyroflex/Tip.proto"
    /// How far the tip of a link that bends is from where it would be on the rigid link, in the link's axes.
    Tip {
        1 link: [string] String, "Name of the link";
        2 displacement: [message, optional] Option<Vector3>, "Displacement [m]";
        3 rotation: [message, optional] Option<Vector3>, "Rotation vector [rad]";
    }
}

message! { "gyroflex" "gyroflex/State.proto"
    /// The state of a robot with flexible joints at one instant.
    State {
        1 time: [double] f64, "Simulated time [s]";
        2 joints: [message, repeated] Vec<Joint>, "Joints of one degree of freedom, in coordinate order";
        3 kinetic_energy: [double] f64, "Kinetic energy of links and rotors [J]";
        4 gravity_energy: [double] f64, "Potential energy of gravity [J]";
        5 elastic_energy: [double] f64, "Energy stored in the transmissions and in links that bend [J]";
        6 power_in: [double] f64, "Power put in by motors and external loads [W]";
        7 dissipation: [double] f64, "Power lost in friction and damping, not negative [W]";
        8 significance: [double] f64, "Significance ratio of the gyroscopic coupling, Zhao et al. 2015, eq. 12 [-]";
        9 base: [message, optional] Option<Base>, "Floating root; absent on a fixed one";
        10 footing: [message, optional] Option<Support>, "What holds the robot beside its joints; absent where nothing does";
        11 modes: [message, repeated] Vec<Mode>, "Modes of links that bend";
        12 tips: [message, repeated] Vec<Tip>, "Tips of links that bend";
    }
}

impl State {
    /// The state of a sample that belongs to the run.
    pub(crate) fn new(info: &RunInfo, s: &Sample) -> Self {
        let joint = |i: usize| Joint {
            name: info.joints[i].clone(),
            prismatic: info.prismatic[i],
            q: s.q[i],
            qd: s.qd[i],
            qdd: s.qdd[i],
            theta: s.theta[i],
            thetad: s.thetad[i],
            thetadd: s.thetadd[i],
            deflection: s.deflection[i],
            tau_j: s.tau_j[i],
            tau: s.tau[i],
            gyroscopic: s.gyroscopic[i],
            friction: s.friction[i],
            reference: s.reference[i],
            tracking_error: s.tracking_error[i],
        };
        Self {
            time: s.t,
            joints: (0..info.joints.len()).map(joint).collect(),
            kinetic_energy: s.kinetic_energy,
            gravity_energy: s.gravity_energy,
            elastic_energy: s.elastic_energy,
            power_in: s.power_in,
            dissipation: s.dissipation,
            significance: s.significance,
            base: s.base_pose.zip(s.base_twist).map(|(pose, twist)| Base::new(pose, twist)),
            footing: s.footing.as_ref().map(|footing| Support::new(info, footing)),
            modes: (0..info.modes.len()).map(|i| Mode::new(info, s, i)).collect(),
            tips: info.tips.iter().zip(&s.tips).map(|(link, tip)| Tip::new(link, tip)).collect(),
        }
    }

    /// The sample again, without the poses of the links.
    pub(crate) fn sample(&self) -> Sample {
        let all = |get: fn(&Joint) -> f64| self.joints.iter().map(get).collect();
        Sample {
            t: self.time,
            base_pose: self.base.as_ref().map(Base::pose),
            base_twist: self.base.as_ref().map(Base::twist),
            q: all(|j| j.q),
            qd: all(|j| j.qd),
            qdd: all(|j| j.qdd),
            theta: all(|j| j.theta),
            thetad: all(|j| j.thetad),
            thetadd: all(|j| j.thetadd),
            deflection: all(|j| j.deflection),
            tau_j: all(|j| j.tau_j),
            tau: all(|j| j.tau),
            gyroscopic: all(|j| j.gyroscopic),
            friction: all(|j| j.friction),
            reference: all(|j| j.reference),
            tracking_error: all(|j| j.tracking_error),
            kinetic_energy: self.kinetic_energy,
            gravity_energy: self.gravity_energy,
            elastic_energy: self.elastic_energy,
            power_in: self.power_in,
            dissipation: self.dissipation,
            significance: self.significance,
            frames: Vec::new(),
            footing: self.footing.as_ref().map(Support::footing),
            eta: self.modes.iter().map(|m| m.eta).collect(),
            etad: self.modes.iter().map(|m| m.etad).collect(),
            etadd: self.modes.iter().map(|m| m.etadd).collect(),
            tips: self.tips.iter().map(Tip::deflection).collect(),
        }
    }
}

impl Mode {
    fn new(info: &RunInfo, s: &Sample, i: usize) -> Self {
        let (name, turning) = (info.modes[i].clone(), info.turning[i]);
        Self { name, turning, eta: s.eta[i], etad: s.etad[i], etadd: s.etadd[i] }
    }
}

impl Tip {
    fn new(link: &str, tip: &Deflection) -> Self {
        let vector = |[x, y, z]: [f64; 3]| Some(Vector3 { x, y, z });
        Self { link: link.to_owned(), displacement: vector(tip.displacement), rotation: vector(tip.rotation) }
    }

    fn deflection(&self) -> Deflection {
        let numbers = |v: &Option<Vector3>| v.as_ref().map_or([0.0; 3], |v| [v.x, v.y, v.z]);
        Deflection { displacement: numbers(&self.displacement), rotation: numbers(&self.rotation) }
    }
}

impl Support {
    fn new(info: &RunInfo, footing: &Footing) -> Self {
        let vector = |[x, y, z]: [f64; 3]| Some(Vector3 { x, y, z });
        let contact = |(name, touch): (&String, &Touch)| Contact {
            name: name.clone(),
            force: vector(touch.force),
            gap: touch.gap,
            mode: touch.mode,
        };
        let [x, y] = footing.zero_moment_point;
        Self {
            contacts: info.contacts.iter().zip(&footing.contacts).map(contact).collect(),
            center_of_mass: vector(footing.center_of_mass),
            zero_moment_point: vector([x, y, 0.0]),
            constraint_drift: footing.drift,
        }
    }

    fn footing(&self) -> Footing {
        let numbers = |v: &Option<Vector3>| v.as_ref().map_or([0.0; 3], |v| [v.x, v.y, v.z]);
        let touch = |c: &Contact| Touch { force: numbers(&c.force), gap: c.gap, mode: c.mode };
        let [x, y, _] = numbers(&self.zero_moment_point);
        Footing {
            contacts: self.contacts.iter().map(touch).collect(),
            center_of_mass: numbers(&self.center_of_mass),
            zero_moment_point: [x, y],
            drift: self.constraint_drift,
        }
    }

    /// Names of the contacts.
    pub(crate) fn names(&self) -> Vec<String> {
        self.contacts.iter().map(|c| c.name.clone()).collect()
    }
}

impl Base {
    fn new([x, y, z, qx, qy, qz, qw]: [f64; 7], [wx, wy, wz, vx, vy, vz]: [f64; 6]) -> Self {
        Self {
            position: Some(Vector3 { x, y, z }),
            orientation: Some(Quaternion { x: qx, y: qy, z: qz, w: qw }),
            angular_velocity: Some(Vector3 { x: wx, y: wy, z: wz }),
            linear_velocity: Some(Vector3 { x: vx, y: vy, z: vz }),
        }
    }

    fn pose(&self) -> [f64; 7] {
        let p = self.position.clone().unwrap_or_default();
        let o = self.orientation.clone().unwrap_or_default();
        [p.x, p.y, p.z, o.x, o.y, o.z, o.w]
    }

    fn twist(&self) -> [f64; 6] {
        let w = self.angular_velocity.clone().unwrap_or_default();
        let v = self.linear_velocity.clone().unwrap_or_default();
        [w.x, w.y, w.z, v.x, v.y, v.z]
    }
}
