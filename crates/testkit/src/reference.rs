//! Reference cases from outside; see `tests/reference/README.md`.

use crate::State;
use gyroflex::model::{
    BodySpec, DriveSpec, Friction, JointKind, MountSpec, RobotSpec, RotorBody, RotorSpec, SpringSpec,
    TransmissionError, TransmissionSpec,
};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};
use serde_json::Value;
use std::path::PathBuf;

/// All case files, without their extension.
pub const CASES: [&str; 9] = [
    "r2__forward",
    "r2__inverse_point",
    "r2__inverse_trajectory",
    "r2__matrices",
    "r2__simulation",
    "r6_gyro__forward",
    "r6_gyro__inverse_point",
    "r6_gyro__matrices",
    "r6_gyro_undamped__inverse_trajectory",
];

/// A case file and its robot.
#[derive(Clone, Debug)]
pub struct Case {
    /// File name without its extension.
    pub name: &'static str,
    /// The whole file.
    pub json: Value,
    /// Gear ratios of the drives in joint order.
    pub gear_ratios: Vec<f64>,
    bodies: Vec<BodySpec>,
    gravity: Vec3<f64>,
}

impl Case {
    /// Reads a case file and the URDF it names.
    ///
    /// # Panics
    /// If a file is not as the README says: these files are part of the tests.
    pub fn load(name: &'static str) -> Self {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference");
        let read = |file: &str| std::fs::read_to_string(folder.join(file)).expect("the reference file is there");
        let json: Value = serde_json::from_str(&read(&format!("{name}.json"))).expect("the case is JSON");
        let robot = &json["robot"];
        let urdf = read(robot["urdf_file"].as_str().expect("the case names its URDF"));
        let mut bodies = read_urdf(&urdf, robot["joints"].as_array().expect("the case lists its joints"));
        let actuators = robot["actuators"].as_array().expect("the case lists its actuators");
        assert_eq!(actuators.len(), bodies.len(), "every joint of the reference robots has an actuator");
        for (body, actuator) in bodies.iter_mut().zip(actuators) {
            body.friction = friction(&actuator["link_friction"]);
            body.drive = Some(drive(body, actuator));
        }
        let gear_ratios = actuators.iter().map(|a| number(&a["gear_ratio"])).collect();
        let gravity = three(&robot["gravity"]);
        Self { name, json, gear_ratios, bodies, gravity }
    }

    /// All cases whose kind (`forward`, `matrices`, …) is this.
    pub fn of_kind(kind: &str) -> impl Iterator<Item = Self> {
        CASES.into_iter().filter(move |c| c.ends_with(&format!("__{kind}"))).map(Self::load)
    }

    /// The robot.
    pub fn spec(&self) -> RobotSpec<'_> {
        RobotSpec { bodies: &self.bodies, spring_tables: &[], gravity: self.gravity }
    }

    /// The samples, where the case has any.
    pub fn samples(&self) -> &[Value] {
        self.json["samples"].as_array().map_or(&[], Vec::as_slice)
    }

    /// The state of a sample, reflected; what the sample does not give is zero.
    pub fn state(&self, sample: &Value) -> State {
        let given = |key: &str| sample.get(key).map_or(vec![0.0; self.gear_ratios.len()], numbers);
        State {
            q: given("q"),
            qd: given("qd"),
            qdd: given("qdd"),
            theta: self.reflect(&given("theta_m")),
            thetad: self.reflect(&given("thetad_m")),
            thetadd: self.reflect(&given("thetadd_m")),
            tau: self.reflect_torque(&given("u")),
            tau_ext: given("d_l"),
            wrenches: Vec::new(),
        }
    }

    /// Link positions at time `t` on the case's trajectory, and `order` derivatives: sums of sines.
    pub fn trajectory(&self, t: f64, order: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
        let trajectory = &self.json["trajectory"];
        let offset = numbers(&trajectory["offset"]);
        let terms = |key: &str, i: usize| numbers(&trajectory[key][i]);
        let derivative = |i: usize, k: usize| {
            let sines = terms("amplitude", i).into_iter().zip(terms("omega", i)).zip(terms("phase", i));
            let quarter = k as f64 * core::f64::consts::FRAC_PI_2;
            sines.map(|((a, w), phase)| a * w.powi(k as i32) * (w * t + phase + quarter).sin()).sum::<f64>()
        };
        let n = offset.len();
        let q = (0..n).map(|i| offset[i] + derivative(i, 0)).collect();
        (q, (1..=order).map(|k| (0..n).map(|i| derivative(i, k)).collect()).collect())
    }

    /// What a sample expects under a label. Without transmission errors the labels `consistent` and `paper` coincide, and
    /// the file may give the latter alone.
    pub fn expected<'s>(&self, sample: &'s Value, label: &str) -> &'s Value {
        let all = &sample["expected"];
        all.get(label).unwrap_or(&all[label.replace("consistent", "paper")])
    }

    /// Motor angles, rates or accelerations to reflected ones: divided by the gear ratios.
    pub fn reflect(&self, motor: &[f64]) -> Vec<f64> {
        motor.iter().zip(&self.gear_ratios).map(|(x, n)| x / n).collect()
    }

    /// Motor torques to reflected ones: times the gear ratios.
    pub fn reflect_torque(&self, motor: &[f64]) -> Vec<f64> {
        motor.iter().zip(&self.gear_ratios).map(|(x, n)| x * n).collect()
    }
}

/// A list of numbers.
///
/// # Panics
/// If it is not one.
pub fn numbers(v: &Value) -> Vec<f64> {
    v.as_array().expect("a list of numbers").iter().map(number).collect()
}

/// A matrix given by rows, row after row.
///
/// # Panics
/// If it is not one.
pub fn rows(v: &Value) -> Vec<f64> {
    v.as_array().expect("a list of rows").iter().flat_map(numbers).collect()
}

/// A number.
///
/// # Panics
/// If it is not one.
pub fn number(v: &Value) -> f64 {
    v.as_f64().expect("a number")
}

fn three(v: &Value) -> Vec3<f64> {
    let v = numbers(v);
    Vec3::new(v[0], v[1], v[2])
}

fn rpy_pose(xyz: Vec3<f64>, rpy: Vec3<f64>) -> Transform<f64> {
    Transform::from_pose(Mat3::from_rpy(rpy.x, rpy.y, rpy.z), xyz)
}

fn friction(v: &Value) -> Friction<f64> {
    if v.is_null() {
        return Friction::none();
    }
    Friction::coulomb(number(&v["viscous"]), number(&v["coulomb"]), number(&v["tanh_velocity"]))
}

fn drive(body: &BodySpec, a: &Value) -> DriveSpec {
    let mount = &a["mount"];
    let (placement, axis) = if mount.is_null() {
        (body.placement, body.axis)
    } else {
        let axis = three(&a["axis"]);
        (rpy_pose(three(&mount["xyz"]), three(&mount["rpy"])), axis.scale(1.0 / axis.norm()))
    };
    let error = &a["transmission_error"];
    let error = if error.is_null() {
        TransmissionError::none()
    } else {
        TransmissionError {
            amplitude: number(&error["amplitude"]),
            cycles_per_rotor_turn: number(&error["multiplier"]),
            phase: number(&error["phase"]),
        }
    };
    let spring = SpringSpec::Polynomial { stiffness: number(&a["stiffness"]), cubic: number(&a["cubic_stiffness"]) };
    DriveSpec {
        rotor: RotorSpec {
            inertia: number(&a["rotor_inertia_axial"]),
            body: Some(RotorBody {
                mass: number(&a["rotor_mass"]),
                transverse_inertia: number(&a["rotor_inertia_transverse"]),
            }),
            mount: MountSpec { body: body.parent, placement, axis },
        },
        gear_ratio: number(&a["gear_ratio"]),
        transmission: TransmissionSpec::Elastic { spring, damping: number(&a["damping"]), error },
        friction: friction(&a["motor_friction"]),
    }
}

/// Reads what the reference URDFs use: a chain of revolute joints whose fixed links weigh nothing.
fn read_urdf(text: &str, joints: &[Value]) -> Vec<BodySpec> {
    let document = roxmltree::Document::parse(text).expect("the URDF is XML");
    let robot = document.root_element();
    let named = |tag: &'static str, name: &str| {
        let mut found = robot.children().filter(|n| n.has_tag_name(tag) && n.attribute("name") == Some(name));
        found.next().expect("the URDF has the element it refers to")
    };
    let link_of = |joint: &str, end: &str| child(named("joint", joint), end).attribute("link");
    let names: Vec<&str> = joints.iter().map(|j| j.as_str().expect("a joint name")).collect();
    let body_of = |link: Option<&str>| names.iter().position(|j| link_of(j, "child") == link);
    let body = |name: &&str| {
        let joint = named("joint", name);
        assert_eq!(joint.attribute("type"), Some("revolute"));
        BodySpec {
            parent: body_of(link_of(name, "parent")),
            joint: JointKind::Revolute,
            axis: triple(child(joint, "axis"), "xyz"),
            placement: origin(joint),
            inertia: inertia(named("link", link_of(name, "child").expect("a child link"))),
            friction: Friction::none(),
            drive: None,
        }
    };
    names.iter().map(body).collect()
}

type Node<'a> = roxmltree::Node<'a, 'a>;

fn child<'a>(n: Node<'a>, tag: &str) -> Node<'a> {
    n.children().find(|c| c.has_tag_name(tag)).expect("the URDF element has this child")
}

fn triple(n: Node<'_>, attribute: &str) -> Vec3<f64> {
    let text = n.attribute(attribute).expect("the URDF element has this attribute");
    let v: Vec<f64> = text.split_whitespace().map(|x| x.parse().expect("a number")).collect();
    Vec3::new(v[0], v[1], v[2])
}

fn origin(n: Node<'_>) -> Transform<f64> {
    let o = child(n, "origin");
    rpy_pose(triple(o, "xyz"), triple(o, "rpy"))
}

fn inertia(link: Node<'_>) -> SpatialInertia<f64> {
    let inertial = child(link, "inertial");
    let value = |n: Node<'_>, key: &str| n.attribute(key).and_then(|x| x.parse().ok()).expect("a number");
    let tensor = child(inertial, "inertia");
    let [xx, xy, xz, yy, yz, zz] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"].map(|k| value(tensor, k));
    let about_com = SymMat3 { xx, yy, zz, xy, xz, yz };
    let at = origin(inertial);
    SpatialInertia::from_com(value(child(inertial, "mass"), "value"), at.pos, at.inv_tensor(about_com))
}
