//! Laws of linear models.

use crate::arms::{EI, LENGTH, MASS_PER_LENGTH, beam, forward, state, tree};
use crate::{assert_close, numbers};
use gyroflex_sim::Dynamics;
use gyroflex_sim::linearize::{
    KeptFriction, Linearizer, ModeKind, Output, Sweep, frequency_response, natural_modes, partials, zero_order_hold_of,
};
use gyroflex_sim::simulate::StateVec;
use std::f64::consts::TAU;

/// Roots of `1 + cosh λ cos λ = 0`, as every textbook on vibration prints them.
const CANTILEVER: [f64; 3] = [1.875104, 4.694091, 7.854757];
/// Roots of `tan λ = tanh λ`: pinned at one end, free at the other.
const PINNED_FREE: [f64; 2] = [3.926602, 7.068583];

fn frequency(lambda: f64) -> f64 {
    lambda * lambda * (EI / (MASS_PER_LENGTH * LENGTH.powi(4))).sqrt() / TAU
}

#[test]
fn a_beam_behind_a_motor_of_great_inertia_swings_like_a_cantilever() {
    // A rotor that a thousand beams would not move holds the root.
    let drives = "drives:\n  hinge: {rotor: {inertia: 1.0e+6}, gear_ratio: 1, transmission: rigid}\n";
    let robot = beam(4, "", [0.0; 3], drives);
    let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::All).unwrap();
    let point = linearizer.equilibrium_at(&[0.4]).unwrap();
    let linear = linearizer.linearize(&point, &Output::defaults()).unwrap();
    assert_eq!(linear.states[..3], ["q.hinge", "eta.beam.bending_y1", "eta.beam.bending_y2"]);
    assert_eq!(linear.states[5..7], ["qd.hinge", "etad.beam.bending_y1"]);
    assert_eq!(linear.inputs, ["tau.hinge"]);
    let swings = natural_modes(&linear).unwrap();
    let swings: Vec<_> = swings.iter().filter(|m| m.kind == ModeKind::Oscillation).collect();
    assert_eq!(swings.len(), 4);
    for (i, lambda) in CANTILEVER.into_iter().enumerate() {
        assert_close("frequency", &[swings[i].frequency], &[frequency(lambda)], 2e-6);
        assert_eq!(swings[i].moves_most, format!("eta.beam.bending_y{}", i + 1));
    }
}

#[test]
fn a_beam_on_a_free_hinge_swings_like_a_pinned_one_and_its_motor_response_dips_at_the_cantilevers() {
    let robot = beam(6, "", [0.0; 3], "");
    let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::All).unwrap();
    let point = linearizer.equilibrium_at(&[0.0]).unwrap();
    let linear = linearizer.linearize(&point, &Output::defaults()).unwrap();
    let modes = natural_modes(&linear).unwrap();
    assert_eq!(modes[0].kind, ModeKind::Rigid);
    let swings: Vec<_> = modes.iter().filter(|m| m.kind == ModeKind::Oscillation).collect();
    // Clamped shapes and a rigid motion only approach pinned ones.
    for (swing, lambda) in swings.iter().zip(PINNED_FREE) {
        assert_close("frequency", &[swing.frequency], &[frequency(lambda)], 2e-3);
        assert!(swing.frequency >= frequency(lambda) * (1.0 - 1e-6), "assumed modes only stiffen");
    }
    let (from, to) = (frequency(CANTILEVER[0]) / 2.0, frequency(CANTILEVER[1]) * 1.2);
    let sweep = Sweep { from: Some(from), to: Some(to), points: Some(50) };
    let response = frequency_response(&linearizer, &point, "hinge", sweep).unwrap();
    let dips: Vec<f64> = response.antiresonances.iter().map(|e| e.frequency).collect();
    assert_close("dips", &dips, &[frequency(CANTILEVER[0]), frequency(CANTILEVER[1])], 2e-6);
}

#[test]
fn damping_ratios_of_modes_are_those_of_their_file() {
    let drives = "drives:\n  hinge: {rotor: {inertia: 1.0e+6}, gear_ratio: 1, transmission: rigid}\n";
    let yaml = "";
    let mut robot = beam(2, yaml, [0.0; 3], drives);
    for flexure in &mut robot.flexible.links {
        for mode in &mut flexure.beam.modes {
            mode.damping_ratio = 0.03;
        }
        let beam = &flexure.beam;
        flexure.integrals = beam.integrals(beam.enough_points()).seen_from_parent(flexure.placement);
    }
    let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::All).unwrap();
    let point = linearizer.equilibrium_at(&[0.4]).unwrap();
    let linear = linearizer.linearize(&point, &Output::defaults()).unwrap();
    let modes = natural_modes(&linear).unwrap();
    for mode in modes.iter().filter(|m| m.kind == ModeKind::Oscillation) {
        assert!((mode.damping_ratio.unwrap() - 0.03).abs() < 1e-6, "{mode:?}");
    }
}

/// Moves the state by `h` in one of the directions of the derivatives.
fn moved(dynamics: &Dynamics, at: &StateVec, block: usize, k: usize, h: f64) -> StateVec {
    let mut out = at.clone();
    match block {
        0 => {
            let mut step = vec![0.0; dynamics.nv()];
            step[k] = h;
            dynamics.integrate(&at.q, &step, &mut out.q).unwrap();
        }
        1 => out.qd[k] += h,
        2 => out.theta[k] += h,
        3 => out.thetad[k] += h,
        _ => {}
    }
    out
}

#[test]
fn derivatives_of_forward_dynamics_are_limits_of_differences() {
    for floating in [false, true] {
        for model in ["complete", "reduced", "rigid"] {
            let robot = tree(model, 0.02, floating);
            let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
            let (at, nv) = (state(&robot, 3), dynamics.nv());
            let tau: Vec<f64> = numbers(9, nv);
            let found = partials(&dynamics, &at, &tau).unwrap();
            const H: f64 = 1e-6;
            for block in 0..5 {
                for k in 0..nv {
                    let ends = [-H, H].map(|h| {
                        let mut tau = tau.clone();
                        if block == 4 {
                            tau[k] += h;
                        }
                        let state = moved(&dynamics, &at, block, k, h);
                        forward(&mut dynamics, &state, &tau)
                    });
                    for (i, of) in [&found.qdd, &found.thetadd, &found.tau_j].into_iter().enumerate() {
                        let slope: Vec<f64> =
                            ends[1][i].iter().zip(&ends[0][i]).map(|(b, a)| (b - a) / (2.0 * H)).collect();
                        let matrix = [&of.q, &of.qd, &of.theta, &of.thetad, &of.tau][block];
                        let size = slope.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
                        for row in 0..nv {
                            let apart = (matrix[(row, k)] - slope[row]).abs();
                            assert!(
                                apart < 2e-5 * size,
                                "{model} {floating} {i} block {block} ({row}, {k}): {apart} of {size}"
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_sampled_model_is_the_answer_over_a_step() {
    let robot = tree("complete", 0.02, false);
    let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::All).unwrap();
    let point = linearizer.equilibrium_at(&[0.4, -0.3, 0.1]).unwrap();
    let linear = linearizer.linearize(&point, &Output::defaults()).unwrap();
    let (half, whole) = (zero_order_hold_of(&linear, 5e-4).unwrap(), zero_order_hold_of(&linear, 1e-3).unwrap());
    let twice = &half.a * &half.a;
    assert!((twice - &whole.a).amax() < 1e-9 * whole.a.amax());
}

#[test]
fn the_pose_of_a_tool_on_a_tip_changes_as_its_frame_moves() {
    let robot = tree("complete", 0.0, false);
    let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::All).unwrap();
    let point = linearizer.equilibrium_at(&[0.4, -0.3, 0.1]).unwrap();
    let linear = linearizer.linearize(&point, &[Output::Pose("hand".to_owned())]).unwrap();
    assert_eq!(linear.outputs[0], "pose.hand.x");
    let place = |q: &[f64]| {
        let text = format!("duration: 0.001\ninitial: {{q: {:?}, eta: {:?}}}\nlog: {{rate: 1000}}\n", &q[..3], &q[3..]);
        let (_, table, _) = crate::arms::run(&robot, &text);
        let world = ["upper", "lower", "hand"].iter().fold(gyroflex::spatial::Transform::identity(), |sum, link| {
            let at = |key: &str| table.get(&format!("frame.{link}.{key}")).unwrap()[0];
            let turn = gyroflex::spatial::Mat3::from_quaternion(["qx", "qy", "qz", "qw"].map(at));
            let shift = gyroflex::spatial::Vec3::new(at("x"), at("y"), at("z"));
            gyroflex::spatial::Transform::from_pose(turn, shift).after(sum)
        });
        world.pos.to_array()
    };
    const H: f64 = 1e-6;
    for k in 0..point.state.q.len() {
        let ends = [-H, H].map(|h| {
            let mut q = point.state.q.clone();
            q[k] += h;
            place(&q)
        });
        let slope: Vec<f64> = (0..3).map(|i| (ends[1][i] - ends[0][i]) / (2.0 * H)).collect();
        let found: Vec<f64> = (0..3).map(|i| linear.c[(i, k)]).collect();
        assert!(slope.iter().zip(&found).all(|(a, b)| (a - b).abs() < 1e-8), "{k}: {slope:?} {found:?}");
    }
}
