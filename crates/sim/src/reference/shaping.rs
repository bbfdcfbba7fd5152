//! From a scenario's words to a shaper.

use super::References;
use super::references::MAX_IMPULSES;
use crate::coordinates::Coordinates;
use crate::error::Error;
use crate::linearize::{KeptFriction, Linearization, Linearizer, ModeKind, Output, natural_modes};
use crate::robot::Robot;
use crate::scenario::{InputShaper, Motors, ScenarioFile, ShaperModes, ShaperType, fault};
use gyroflex::control::{Mode, Shaper, ShaperKind};

/// The shaper of a scenario for these references; `robot` has the scenario's gravity and model.
///
/// # Errors
/// Modes that are not there, or too many.
pub(super) fn shaper(
    file: &ScenarioFile,
    robot: &Robot,
    joints: &Coordinates,
    references: &References,
) -> Result<Shaper<f64, MAX_IMPULSES>, Error> {
    let Some(wanted) = &file.scenario.shaper else { return Ok(Shaper::none()) };
    let modes = match &wanted.modes {
        ShaperModes::Given(modes) => {
            modes.iter().map(|m| Mode { frequency: m.frequency, damping_ratio: m.damping_ratio }).collect()
        }
        ShaperModes::Of(_) => linearized(file, robot, joints, references, wanted)?,
    };
    modes.into_iter().try_fold(Shaper::none(), |shaper, mode| {
        shaper.and(kind(wanted), mode).ok_or_else(|| {
            let problem = format!("the shapers of all modes together have more than {MAX_IMPULSES} impulses");
            fault(&file.keys, "shaper.modes", problem, "give fewer modes, the lowest ones, or use `zv`")
        })
    })
}

fn kind(shaper: &InputShaper) -> ShaperKind<f64> {
    match shaper.kind {
        ShaperType::Zv => ShaperKind::Zv,
        ShaperType::Zvd => ShaperKind::Zvd,
        ShaperType::Ei => ShaperKind::Ei { tolerance: shaper.tolerance.unwrap_or(InputShaper::TOLERANCE) },
    }
}

/// The slowest oscillations of the robot in equilibrium where the references end. Dry friction is left out: it sticks only at
/// rest, when nothing vibrates any more.
fn linearized(
    file: &ScenarioFile,
    robot: &Robot,
    joints: &Coordinates,
    references: &References,
    wanted: &InputShaper,
) -> Result<Vec<Mode<f64>>, Error> {
    let count = wanted.count.unwrap_or(1);
    let fail = |problem: String, remedy: &str| Err(fault(&file.keys, "shaper.modes", problem, remedy));
    if joints.floating {
        return fail(
            "the robot's root floats, so that it has no equilibrium".to_owned(),
            "give `modes` as a list of `frequency` and `damping_ratio`",
        );
    }
    let mut linearizer = Linearizer::new(robot, robot.fidelity, KeptFriction::Viscous)?;
    let mut q = linearizer.zero_position();
    for (i, joint) in joints.joints.iter().enumerate() {
        q[joint.q] = references.point(i, file.scenario.duration).q;
    }
    let point = linearizer.equilibrium_at(&q)?;
    let mut linear = linearizer.linearize(&point, &Output::defaults())?;
    if wanted.motors.unwrap_or_default() == Motors::Held {
        hold_motors(&mut linear, &linearizer, robot);
    }
    let modes = natural_modes(&linear)?;
    let swings: Vec<_> = modes.iter().filter(|m| m.kind == ModeKind::Oscillation).take(count).collect();
    if swings.len() < count {
        let problem = format!("the model `{}` has {} oscillating modes there", robot.fidelity.name(), swings.len());
        return fail(
            problem,
            "use a model with elastic joints, lower `count`, try `motors: free`, or give `modes` as a list",
        );
    }
    let mut out = Vec::with_capacity(count);
    for mode in swings {
        let damping_ratio = mode.damping_ratio.unwrap_or(0.0);
        // Rounding of an undamped mode.
        if damping_ratio < -ROUNDING {
            let problem = format!("the mode at {:.4} Hz grows by itself where the references end", mode.frequency);
            return fail(problem, "let the references end at a pose that is stable, or give `modes` as a list");
        }
        out.push(Mode { frequency: mode.frequency, damping_ratio: damping_ratio.max(0.0) });
    }
    Ok(out)
}

/// Leaves of the states what moves while all motors stand still: links behind elastic transmissions, undriven joints, and links
/// that bend.
fn hold_motors(linear: &mut Linearization, linearizer: &Linearizer, robot: &Robot) {
    let half = linearizer.layout().positions();
    if linearizer.layout().modes() > 0 {
        stop_motors(linear, linearizer, robot);
    }
    let moves =
        |k: &usize| linearizer.layout().elastic().contains(k) || robot.bodies.get(*k).is_none_or(|b| b.drive.is_none());
    let positions: Vec<usize> = (0..linearizer.layout().nv()).filter(moves).collect();
    let kept: Vec<usize> = positions.iter().copied().chain(positions.iter().map(|k| half + k)).collect();
    linear.a = linear.a.select_rows(&kept).select_columns(&kept);
    linear.states = kept.iter().map(|k| linear.states[*k].clone()).collect();
}

/// Lets every motor exert what keeps it from accelerating: `A − B_h (C_h B_h)⁻¹ C_h A`, `C_h` the rows of the held motors' accelerations. Where
/// links bend, a joint that moves with its motor would else give way to them.
fn stop_motors(linear: &mut Linearization, linearizer: &Linearizer, robot: &Robot) {
    let layout = linearizer.layout();
    let driven = |k: &usize| robot.bodies.get(*k).is_some_and(|b| b.drive.is_some());
    let inputs = layout.inputs().iter().enumerate().filter(|(_, k)| driven(k));
    let (columns, rows): (Vec<usize>, Vec<usize>) =
        inputs.map(|(column, k)| (column, layout.positions() + layout.motor(*k))).unzip();
    let b = linear.b.select_columns(&columns);
    if let Some(torque) = b.select_rows(&rows).lu().solve(&linear.a.select_rows(&rows)) {
        linear.a -= b * torque;
    }
}

/// Damping ratios nearer to zero than this are zero.
const ROUNDING: f64 = 1e-6;
