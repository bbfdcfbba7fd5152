//! What a linear model shows of its state.

use super::{Linearizer, OperatingPoint, Partials};
use crate::error::{Error, ErrorKind};
use crate::link_frame::LinkFrame;
use crate::load::nearest::nearest;
use gyroflex::dynamics::Axes;
use gyroflex::model::{Elastic, Knot, TransmissionError};
use nalgebra::DMatrix;

/// A kind of output: one entry per joint, or six for a pose.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// Reflected motor positions [rad or m]; the link's own without an elastic transmission.
    MotorPosition,
    /// Reflected motor velocities [rad/s or m/s].
    MotorVelocity,
    /// Link positions [rad or m].
    LinkPosition,
    /// Link velocities [rad/s or m/s].
    LinkVelocity,
    /// Torques through the transmissions on the links, `τ_J` [N m or N].
    JointTorque,
    /// Position [m] and rotation vector [rad] of a link's frame relative to the operating point, in world axes.
    Pose(String),
}

/// What is asked for unless said otherwise.
pub const DEFAULT: [Output; 2] = [Output::MotorPosition, Output::LinkPosition];

/// Entries of a pose.
const POSE: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

impl Output {
    /// The kinds of one entry per joint, by name.
    pub const NAMES: [(&'static str, Self); 5] = [
        ("motor-position", Self::MotorPosition),
        ("motor-velocity", Self::MotorVelocity),
        ("link-position", Self::LinkPosition),
        ("link-velocity", Self::LinkVelocity),
        ("joint-torque", Self::JointTorque),
    ];

    /// What is asked for unless said otherwise: motor and link positions.
    pub fn defaults() -> Vec<Self> {
        DEFAULT.to_vec()
    }

    /// From a name as on the command line: `motor-position`, …, or `pose:LINK`.
    ///
    /// # Errors
    /// Names the nearest known one.
    pub fn parse(text: &str) -> Result<Self, Error> {
        if let Some(link) = text.strip_prefix("pose:") {
            return Ok(Self::Pose(link.to_owned()));
        }
        let name = text.replace('_', "-");
        let known = || Self::NAMES.iter().map(|(name, _)| *name).chain(["pose:LINK"]);
        match Self::NAMES.iter().find(|(known, _)| *known == name) {
            Some((_, output)) => Ok(output.clone()),
            None => Err(fault(
                format!("`{text}` is no output"),
                format!(
                    "the nearest known one is `{}`; known: {}",
                    nearest(&name, Self::NAMES.iter().map(|(name, _)| *name)).unwrap_or_default(),
                    known().collect::<Vec<_>>().join(", ")
                ),
            )),
        }
    }
}

/// `C`, `D` and the names of their rows.
pub(super) struct Rows {
    pub(super) c: DMatrix<f64>,
    pub(super) d: DMatrix<f64>,
    pub(super) names: Vec<String>,
}

pub(super) fn rows(
    of: &Linearizer,
    point: &OperatingPoint,
    partials: &Partials,
    outputs: &[Output],
) -> Result<Rows, Error> {
    if outputs.is_empty() {
        return Err(fault("none is asked for".to_owned(), "name at least one".to_owned()));
    }
    let (half, joints) = (of.layout.positions(), of.layout.inputs().to_vec());
    let count = |o: &Output| if matches!(o, Output::Pose(_)) { POSE.len() } else { joints.len() };
    let total = outputs.iter().map(count).sum();
    let mut rows =
        Rows { c: DMatrix::zeros(total, 2 * half), d: DMatrix::zeros(total, joints.len()), names: Vec::new() };
    for output in outputs {
        let first = rows.names.len();
        let mut unit = |name: &str, place: &dyn Fn(usize) -> usize| {
            for (i, &k) in joints.iter().enumerate() {
                rows.c[(first + i, place(k))] = 1.0;
                rows.names.push(format!("{name}.{}", of.layout.joint(k)));
            }
        };
        match output {
            Output::MotorPosition => unit("motor_position", &|k| of.layout.motor(k)),
            Output::MotorVelocity => unit("motor_velocity", &|k| half + of.layout.motor(k)),
            Output::LinkPosition => unit("link_position", &|k| k),
            Output::LinkVelocity => unit("link_velocity", &|k| half + k),
            Output::JointTorque => joint_torques(of, point, partials, first, &mut rows),
            Output::Pose(link) => pose(of, point, link, first, &mut rows)?,
        }
    }
    Ok(rows)
}

/// Torques through the transmissions.
fn joint_torques(of: &Linearizer, point: &OperatingPoint, partials: &Partials, first: usize, rows: &mut Rows) {
    let (layout, model) = (&of.layout, of.dynamics.model());
    let (nv, half) = (layout.nv(), layout.positions());
    for (row, &k) in layout.inputs().iter().enumerate().map(|(i, k)| (first + i, k)) {
        rows.names.push(format!("joint_torque.{}", layout.joint(k)));
        if let Some(body) = model.bodies().iter().find(|b| b.v_index() == k)
            && let Some(drive) = &body.drive
            && let Some(elastic) = &drive.elastic
        {
            let (q, theta, thetad) = (point.state.q[body.q_index()], point.state.theta[k], point.state.thetad[k]);
            let by = spring_and_damper(elastic, drive.rotor.gear_ratio, model.knots(), [q, theta, thetad]);
            let motor = layout.motor(k);
            for (column, entry) in [k, motor, half + k, half + motor].into_iter().zip(by) {
                rows.c[(row, column)] = entry;
            }
            continue;
        }
        // Through a rigid gear goes what the rotor leaves of the motor's torque, which depends on everything.
        let by = &partials.tau_j;
        rows.c.view_mut((row, 0), (1, nv)).copy_from(&by.q.row(k));
        rows.c.view_mut((row, half), (1, nv)).copy_from(&by.qd.row(k));
        for (i, &of) in layout.elastic().iter().enumerate() {
            rows.c[(row, nv + i)] = by.theta[(k, of)];
            rows.c[(row, half + nv + i)] = by.thetad[(k, of)];
        }
        for (i, &of) in layout.inputs().iter().enumerate() {
            rows.d[(row, i)] = by.tau[(k, of)];
        }
    }
}

/// Derivatives of `τ_J = k(δ) + D δ̇`, `δ = θ − q − e(θ)`, by `q, θ, q̇, θ̇`.
fn spring_and_damper(
    elastic: &Elastic<f64>,
    ratio: f64,
    knots: &[Knot<f64>],
    [q, theta, thetad]: [f64; 3],
) -> [f64; 4] {
    let (e, slope) = elastic.error.map_or((0.0, 0.0), |e| e.value_and_slope(theta, ratio));
    let curvature = elastic.error.map_or(0.0, |x| curvature(&x, e, ratio));
    let (stiffness, damping) = (elastic.spring.slope(theta - q - e, knots), elastic.damping);
    [-stiffness, stiffness * (1.0 - slope) - damping * curvature * thetad, -damping, damping * (1.0 - slope)]
}

/// `e'' = −(c N)² e`, since `e` is a sine of `c N θ` [1/rad].
pub(super) fn curvature(error: &TransmissionError<f64>, e: f64, ratio: f64) -> f64 {
    -(error.cycles_per_rotor_turn * ratio).powi(2) * e
}

/// Small motions of a link's frame: its Jacobian in world axes.
fn pose(of: &Linearizer, point: &OperatingPoint, link: &str, first: usize, rows: &mut Rows) -> Result<(), Error> {
    let links = &of.robot.links;
    let Some(index) = links.iter().position(|l| l.name == link) else {
        let remedy = match nearest(link, links.iter().map(|l| l.name.as_str())) {
            Some(near) => format!("the nearest known one is `{near}`"),
            None => "the robot has no links".to_owned(),
        };
        return Err(fault(format!("the robot has no link `{link}`"), remedy));
    };
    rows.names.extend(POSE.iter().map(|entry| format!("pose.{link}.{entry}")));
    let nv = of.layout.nv();
    let mut j = vec![0.0; 6 * nv];
    LinkFrame::new(&of.robot, index).jacobian(&of.dynamics, &point.state.q, Axes::World, &mut j)?;
    for row in 0..6 {
        // The Jacobian has the angular part first, the pose the position.
        let from = (row + 3) % 6;
        (0..nv).for_each(|column| rows.c[(first + row, column)] = j[from * nv + column]);
    }
    Ok(())
}

fn fault(problem: String, remedy: String) -> Error {
    Error { kind: ErrorKind::Shape, file: String::new(), element: "output".to_owned(), problem, remedy }
}
