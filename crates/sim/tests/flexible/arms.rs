//! Robots made for the tests.

use gyroflex::dynamics::{External, Forward, State};
use gyroflex_sim::load::{LoadOptions, load_urdf_text};
use gyroflex_sim::record::{MemoryRecorder, Table};
use gyroflex_sim::simulate::StateVec;
use gyroflex_sim::{Dynamics, Robot, ScenarioFile, Simulation, Summary};
use std::ops::ControlFlow;
use std::path::Path;

pub const LENGTH: f64 = 0.8;
pub const MASS_PER_LENGTH: f64 = 0.6;
pub const EI: f64 = 12.0;

/// One beam along x behind a joint about z, a massless tool fixed to its tip.
const BEAM: &str = r#"<robot name="beam">
  <link name="base"/>
  <joint name="hinge" type="continuous"><parent link="base"/><child link="beam"/><axis xyz="0 0 1"/></joint>
  <link name="beam"/>
  <joint name="grip" type="fixed"><parent link="beam"/><child link="tool"/><origin xyz="0.8 0 0" rpy="0.3 0 0"/></joint>
  <link name="tool"/>
</robot>"#;

/// That beam, bending along y in so many modes, with more in its description.
pub fn beam(modes: usize, more: &str, gravity: [f64; 3], drives: &str) -> Robot {
    let yaml = format!(
        "urdf: beam.urdf\ngravity: {gravity:?}\nflexible_links:\n  beam:\n    length: {LENGTH}\n    mass_per_length: {MASS_PER_LENGTH}\n    \
         bending_y: {{stiffness: {EI}, modes: {modes}}}\n{more}{drives}"
    );
    load_urdf_text(BEAM, "beam.urdf", Some(&yaml), &LoadOptions::default()).expect("the beam is sound")
}

/// A tree in space: a shoulder, two links that bend in all ways with an elastic joint and its rotor between them, a hand on a fixed joint
/// off the axis, and a branch.
const TREE: &str = r#"<robot name="tree">
  <link name="base"><inertial><mass value="3"/><origin xyz="0 0 0.1"/>
    <inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.4" rpy="0.2 0.1 0"/>
    <axis xyz="0 1 0"/></joint>
  <link name="upper"/>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="0.5 0.02 0.01" rpy="0.4 0 0.3"/>
    <axis xyz="0 0 1"/></joint>
  <link name="lower"/>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="slider"/><origin xyz="0.3 0 0.05"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" effort="100" velocity="10"/></joint>
  <link name="slider"><inertial><mass value="0.3"/><origin xyz="0.01 0.02 0"/>
    <inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="grip" type="fixed"><parent link="lower"/><child link="hand"/><origin xyz="0.4 0.03 0" rpy="0 0.5 0"/></joint>
  <link name="hand"><inertial><mass value="0.5"/><origin xyz="0.05 0 0"/>
    <inertia ixx="1e-3" iyy="2e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>"#;

const TREE_YAML: &str = "urdf: tree.urdf
model: MODEL
flexible_links:
  upper:
    length: 0.5
    mass_per_length: 1.2
    polar_inertia_per_length: 1.0e-3
    bending_y: {stiffness: 60.0, modes: 2, damping: DAMPING}
    bending_z: {stiffness: 90.0, modes: 1, damping: DAMPING}
    torsion: {stiffness: 40.0, modes: 1, damping: DAMPING}
    geometric_stiffening: true
  lower:
    length: 0.4
    mass_per_length: 0.8
    bending_y: {stiffness: 20.0, modes: 1, damping: DAMPING}
    bending_z: {stiffness: 30.0, modes: 1, damping: DAMPING}
drives:
  shoulder: {rotor: {inertia: 2.0e-5}, gear_ratio: 80, transmission: rigid}
  elbow:
    rotor: {inertia: 1.5e-5, mass: 0.2}
    gear_ratio: 100
    transmission: {stiffness: 300.0, damping: TDAMPING}
";

/// The tree in one of its models, with these damping ratios of its modes; without damping its elastic joint has none, either.
pub fn tree(model: &str, damping: f64, floating: bool) -> Robot {
    let transmission = if damping > 0.0 { "0.3" } else { "0.0" };
    let yaml = TREE_YAML.replace("MODEL", model).replace("TDAMPING", transmission);
    let yaml = yaml.replace("DAMPING", &damping.to_string());
    let options = LoadOptions { floating, ..LoadOptions::default() };
    load_urdf_text(TREE, "tree.urdf", Some(&yaml), &options).expect("the tree is sound")
}

/// A state without a pattern: joints anywhere, deflections of some millimetres.
pub fn state(robot: &Robot, seed: u64) -> StateVec {
    let dynamics = Dynamics::new(robot.model(robot.fidelity).expect("it is physical"));
    let (nq, nv, modes) = (dynamics.nq(), dynamics.nv(), dynamics.modes());
    let mut state = StateVec { q: crate::numbers(seed, nq), ..StateVec::zeros(nq, nv) };
    state.qd = crate::numbers(seed + 1, nv);
    if robot.is_floating() {
        let size = state.q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
        state.q[3..7].iter_mut().for_each(|x| *x /= size);
    }
    state.q[nq - modes..].iter_mut().for_each(|eta| *eta *= 0.02);
    state.qd[nv - modes..].iter_mut().for_each(|rate| *rate *= 0.3);
    let model = dynamics.model();
    for body in model.bodies().iter().filter(|b| b.joint.nv() == 1) {
        let (i, k) = (body.q_index(), body.v_index());
        (state.theta[k], state.thetad[k]) = (state.q[i], state.qd[k]);
        if body.is_elastic() {
            state.theta[k] += 0.02 * crate::numbers(seed + 2, 1)[0];
            state.thetad[k] += crate::numbers(seed + 3, 1)[0];
        }
    }
    state.theta[nv - modes..].copy_from_slice(&state.q[nq - modes..]);
    state.thetad[nv - modes..].copy_from_slice(&state.qd[nv - modes..]);
    state
}

/// `q̈`, `θ̈` and `τ_J` under torques.
pub fn forward(dynamics: &mut Dynamics, state: &StateVec, tau: &[f64]) -> [Vec<f64>; 3] {
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; dynamics.nv()]);
    let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    let at = State { q: &state.q, qd: &state.qd, theta: &state.theta, thetad: &state.thetad };
    dynamics.forward(at, tau, External::none(), out).expect("slices fit");
    [qdd, thetadd, tau_j]
}

pub fn scenario(text: &str) -> ScenarioFile {
    let text = format!("robot: robot.yaml\n{text}");
    ScenarioFile::parse(&text, Path::new("scenario.yaml")).expect("the scenario is sound")
}

/// A run and its record.
pub fn run(robot: &Robot, text: &str) -> (Summary, Table, Simulation) {
    let mut simulation = Simulation::new(robot, &scenario(text)).expect("the scenario fits");
    let mut recorder = MemoryRecorder::new(simulation.run_info());
    let summary = simulation.run(&mut recorder, &mut |_| ControlFlow::Continue(())).expect("it runs");
    (summary, recorder.table(), simulation)
}
