//! What a linear model shows of its state.

use super::differences::{Argument, differences};
use super::{Linearizer, OperatingPoint};
use crate::error::{Error, ErrorKind};
use crate::load::nearest::nearest;
use gyroflex::dynamics::{Axes, Frame, jacobian};
use gyroflex::model::Body;
use gyroflex::spatial::Transform;
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
                    nearest(&name, known()).unwrap_or_default(),
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

pub(super) fn rows(of: &mut Linearizer, point: &OperatingPoint, outputs: &[Output]) -> Result<Rows, Error> {
    if outputs.is_empty() {
        return Err(fault("none is asked for".to_owned(), "name at least one, e.g. `motor-position`".to_owned()));
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
            Output::JointTorque => joint_torques(of, point, first, &mut rows)?,
            Output::Pose(link) => pose(of, point, link, first, &mut rows)?,
        }
    }
    Ok(rows)
}

/// Torques through transmissions: `τ_J = k(δ) + D δ̇` where they are elastic; through a rigid gear whatever is left of the motor's.
fn joint_torques(of: &mut Linearizer, point: &OperatingPoint, first: usize, rows: &mut Rows) -> Result<(), Error> {
    let (layout, nv) = (of.layout.clone(), of.layout.nv());
    let half = layout.positions();
    let elastic = |body: &&Body<f64>| body.is_elastic();
    let rigid = of.dynamics.model().bodies().iter().any(|b| !b.is_elastic());
    let mut by = |argument| differences(&mut of.dynamics, &point.state, &point.tau, argument).map(|d| d.tau_j);
    let through_gears = match rigid {
        true => Some([
            (0, by(Argument::Q)?),
            (nv, by(Argument::Theta)?),
            (half, by(Argument::Qd)?),
            (half + nv, by(Argument::Thetad)?),
            (usize::MAX, by(Argument::Tau)?),
        ]),
        false => None,
    };
    for (i, &k) in layout.inputs().iter().enumerate() {
        rows.names.push(format!("joint_torque.{}", layout.joint(k)));
        let model = of.dynamics.model();
        let body = model.bodies().iter().filter(elastic).find(|b| b.v_index() == k);
        let row = first + i;
        if let Some((body, drive)) = body.and_then(|b| Some((b, b.drive.as_ref()?)))
            && let Some(elastic) = &drive.elastic
        {
            let ratio = drive.rotor.gear_ratio;
            let (theta, thetad) = (point.state.theta[k], point.state.thetad[k]);
            let (e, slope) = elastic.error.map_or((0.0, 0.0), |e| e.value_and_slope(theta, ratio));
            // e'' = −(c N)² e, since e is a sine of c N θ.
            let bend = elastic.error.map_or(0.0, |x| -(x.cycles_per_rotor_turn * ratio).powi(2) * e);
            let deflection = theta - point.state.q[body.q_index()] - e;
            let tangent = elastic.spring.slope(deflection, model.knots());
            let motor = layout.motor(k);
            rows.c[(row, k)] = -tangent;
            rows.c[(row, motor)] = tangent * (1.0 - slope) - elastic.damping * bend * thetad;
            rows.c[(row, half + k)] = -elastic.damping;
            rows.c[(row, half + motor)] = elastic.damping * (1.0 - slope);
            continue;
        }
        for (place, numbers) in through_gears.iter().flatten() {
            let entry = |column: usize| numbers[k * nv + column];
            if *place == usize::MAX {
                layout.inputs().iter().enumerate().for_each(|(j, c)| rows.d[(row, j)] = entry(*c));
            } else if *place == 0 || *place == half {
                (0..nv).for_each(|c| rows.c[(row, place + c)] = entry(c));
            } else {
                layout.elastic().iter().enumerate().for_each(|(j, c)| rows.c[(row, place + j)] = entry(*c));
            }
        }
    }
    Ok(())
}

/// Small motions of a link's frame: its Jacobian in world axes.
fn pose(of: &Linearizer, point: &OperatingPoint, link: &str, first: usize, rows: &mut Rows) -> Result<(), Error> {
    let links = &of.robot.links;
    let Some(found) = links.iter().find(|l| l.name == link) else {
        let remedy = match nearest(link, links.iter().map(|l| l.name.as_str())) {
            Some(near) => format!("the nearest known one is `{near}`"),
            None => "the robot has no links".to_owned(),
        };
        return Err(fault(format!("the robot has no link `{link}`"), remedy));
    };
    rows.names.extend(POSE.iter().map(|entry| format!("pose.{link}.{entry}")));
    // A link of the world does not move.
    let Some(body) = found.body else { return Ok(()) };
    let (model, nv) = (of.dynamics.model(), of.layout.nv());
    let mut poses = vec![Transform::identity(); model.bodies().len()];
    of.dynamics.placements(&point.state.q, &mut poses)?;
    let mut j = vec![0.0; 6 * nv];
    jacobian(&model, &poses, Frame { body, placement: found.placement }, Axes::World, &mut j)?;
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
