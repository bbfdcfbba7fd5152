//! Where motors are at time zero: in equilibrium with all that holds the robot.

use gyroflex::dynamics::Forward;
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::loads::Loads;
use gyroflex_sim::{Dynamics, Robot, ScenarioFile, Simulation};
use std::path::PathBuf;

/// The biped of `robots/biped5/sway.yaml`: feet level, one ahead of the hip and one behind it.
const ON_TWO_FEET: &str = "q: {hip_z: 0.55, left_hip: -0.7637505837591092, left_knee: 0.79048212789684213, \
                           right_hip: -0.066208576591295254, right_knee: 0.79048212789684213}";
/// The same with a foot in the air.
const ON_ONE_FOOT: &str = "q: {hip_z: 0.55, left_hip: -0.7637505837591092, left_knee: 0.79048212789684213, \
                           right_hip: -0.066208576591295254, right_knee: 1.2}";

fn robot(folder: &str) -> Robot {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(folder).join("robot.yaml");
    load(&file, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// Accelerations of links and motors at time zero while each motor exerts what its transmission asks for, torques through the transmissions, and forces
/// of the ground.
fn start(robot: &Robot, yaml: &str) -> ([Vec<f64>; 3], Vec<[f64; 3]>) {
    let text = format!("robot: robot.yaml\nduration: 0.1\nintegrator: {{method: rk4, step: 1e-4}}\n{yaml}");
    let file = ScenarioFile::parse(&text, &PathBuf::from("test.yaml")).unwrap_or_else(|e| panic!("{e}"));
    let simulation = Simulation::new(robot, &file).unwrap_or_else(|e| panic!("{e}"));
    let (state, mut contacts) = (simulation.initial_state(), simulation.contacts().clone());
    let mut dynamics = Dynamics::new(robot.model(robot.fidelity).expect("physical"));
    let mut loads = Loads::new(&[], robot, &file.keys).expect("no loads");
    let (nv, mut tau) = (dynamics.nv(), vec![0.0; dynamics.nv()]);
    let mut out = [(); 3].map(|()| vec![0.0; nv]);
    for _ in 0..2 {
        let [qdd, thetadd, tau_j] = &mut out;
        let rates = Forward { qdd, thetadd, tau_j };
        contacts.forward(&mut dynamics, state.view(), &tau, &mut loads, rates).unwrap_or_else(|e| panic!("{e}"));
        for (k, body) in dynamics.model().bodies().iter().enumerate() {
            tau[k] = if body.is_elastic() { out[2][k] } else { 0.0 };
        }
    }
    let forces = (0..contacts.names().count()).map(|i| contacts.force(i).to_array()).collect();
    (out, forces)
}

fn largest(all: &[f64]) -> f64 {
    all.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

#[test]
fn elastic_robot_that_stands_starts_at_rest() {
    let robot = robot("biped5_elastic");
    let yaml = format!("initial: {{{ON_TWO_FEET}}}\nground: {{friction: 0.8, planar: true}}");
    let ([qdd, thetadd, tau_j], forces) = start(&robot, &yaml);
    assert!(largest(&qdd) < 1e-6, "links: {qdd:?}");
    assert!(largest(&thetadd) < 1e-6, "motors: {thetadd:?}");
    assert!(largest(&tau_j) > 5.0, "the legs carry something: {tau_j:?}");
    let weight: f64 = robot.bodies.iter().map(|b| b.inertia.mass).sum::<f64>() * 9.81;
    let carried: f64 = forces.iter().map(|f| f[2]).sum();
    assert!((carried - weight).abs() < 1e-6 * weight, "{carried} N of {weight} N");
    assert!(forces.iter().all(|f| f[2] > 0.0 && f[0].abs() < 0.8 * f[2]), "{forces:?}");
}

#[test]
fn closed_loop_starts_at_rest_with_the_spring_of_its_crank() {
    let robot = robot("four_bar");
    let third = std::f64::consts::FRAC_PI_3;
    let yaml = format!("initial: {{q: {{coupler_joint: {third}, rocker_joint: {}}}}}", 2.0 * third);
    let ([qdd, thetadd, tau_j], _) = start(&robot, &yaml);
    assert!(largest(&qdd) < 1e-6, "links: {qdd:?}");
    assert!(largest(&thetadd) < 1e-6, "motors: {thetadd:?}");
    assert!(largest(&tau_j) > 0.1, "the crank carries something: {tau_j:?}");
}

/// No torque keeps a biped upright on a point: springs then carry the legs as without the ground.
#[test]
fn robot_that_nothing_keeps_at_rest_starts_as_in_the_air() {
    let robot = robot("biped5_elastic");
    let standing = format!("initial: {{{ON_ONE_FOOT}}}\nground: {{friction: 0.8, planar: true}}");
    let ([_, _, on_ground], _) = start(&robot, &standing);
    let ([_, _, in_air], _) = start(&robot, &format!("initial: {{{ON_ONE_FOOT}}}"));
    assert!(largest(&in_air) > 1.0, "{in_air:?}");
    let apart = on_ground.iter().zip(&in_air).map(|(a, b)| a - b).collect::<Vec<_>>();
    assert!(largest(&apart) < 1e-9, "{on_ground:?} {in_air:?}");
}
