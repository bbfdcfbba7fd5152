//! Generated functions and the library's, at a state.

use super::described::Records;
use super::scratch::Scratch;
use gyroflex::dynamics::*;
use gyroflex::spatial::{Motion, Transform};
use gyroflex_codegen::function::Function;
use gyroflex_testkit::State as Point;

/// The results of a function at a state, by name; `parameters` last.
pub fn evaluate(function: &Function, s: &Point, parameters: &[f64]) -> Vec<(String, Vec<f64>)> {
    let mut inputs = Vec::new();
    for argument in &function.arguments {
        inputs.extend_from_slice(match argument.name.as_str() {
            "q" => &s.q,
            "qd" => &s.qd,
            "theta" => &s.theta,
            "thetad" => &s.thetad,
            "qdd" => &s.qdd,
            "thetadd" => &s.thetadd,
            "tau" => &s.tau,
            "parameters" => parameters,
            other => panic!("nobody gives `{other}`"),
        });
    }
    let results = function.evaluate(&inputs);
    function.outputs.iter().zip(results).map(|(output, x)| (output.name.clone(), x)).collect()
}

/// What inverse dynamics, energy, inertia and stiffness of the library are: these together have every number of a robot.
pub fn library(records: &Records, s: &Point) -> Vec<(&'static str, Vec<f64>, f64)> {
    let model = records.rigid.view();
    let (n, nv) = (model.bodies().len(), s.qd.len());
    let state = State { q: &s.q, qd: &s.qd, theta: &s.theta, thetad: &s.thetad };
    let accel = Acceleration { qdd: &s.qdd, thetadd: &s.thetadd };
    let [mut tau_j, mut tau] = [(); 2].map(|()| vec![0.0; nv]);
    let [mut m, mut c] = [(); 2].map(|()| vec![0.0; nv * nv]);
    let mut b = vec![0.0; nv];
    reflected_inertia(&model, &mut b[..model.nv()]).expect("it fits");
    let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
    let energies = match &records.bending {
        None => {
            rnea(&model, state, accel, External::none(), &mut vec![RneaScratch::new(); n], out).expect("it fits");
            let mut scratch = vec![CrbaScratch::new(); n];
            crba(&model, &s.q, &mut scratch, &mut m).expect("it fits");
            coupling(&model, &s.q, &mut scratch, &mut c).expect("it fits");
            let rest = (Transform::identity(), Motion::zero());
            energy(&model, state, &mut vec![rest; n]).expect("it fits")
        }
        Some(bending) => {
            let model = bending.view();
            let mut scratch = Scratch::<f64>::of(&model);
            flexible_rnea(&model, state, accel, External::none(), scratch.lend(), out).expect("it fits");
            let matrices = FlexibleMatrices { mass: &mut m, coupling: &mut c };
            flexible_mass_matrix(&model, &s.q, scratch.lend(), matrices).expect("it fits");
            flexible_energy(&model, state, scratch.lend()).expect("it fits")
        }
    };
    let Energy { kinetic, gravity, elastic } = energies;
    let height = 10.0 * model.bodies().iter().map(|body| body.inertia.mass).sum::<f64>();
    vec![
        ("tau_j", tau_j, 0.0),
        ("tau", tau, 0.0),
        ("m", m, 0.0),
        ("s", c, 0.0),
        ("b", b, 0.0),
        ("kinetic", vec![kinetic], 0.0),
        ("gravity", vec![gravity], height),
        ("elastic", vec![elastic], 0.0),
    ]
}
