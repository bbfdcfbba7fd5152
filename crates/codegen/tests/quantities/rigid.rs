//! Robots whose links do not bend: chains, trees, floating roots, rotors anywhere, all four models.

use super::library;
use super::subject::{DOUBLE, Known, SINGLE, Subject, equals_library, grown};
use gyroflex::dynamics::{Axes, Frame};
use gyroflex::model::Fidelity;
use gyroflex::spatial::{Mat3, Transform, Vec3};
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::{Options, Point, Quantity, function};
use gyroflex_testkit::random::{Options as Grown, RandomRobot};
use gyroflex_testkit::tolerance::{Real, assert_close_above, norm};

#[test]
fn generated_inverse_dynamics_equals_library() {
    equals_library(60, &grown(), Quantity::Inverse, library::inverse);
}

/// Inertia matrices of long robots are ill-conditioned, and accelerations are as uncertain. What they ask for is not: put into
/// inverse dynamics, both accelerations give the same torques, but for rounding of what these are the sum of.
#[test]
fn generated_forward_dynamics_equals_library() {
    for seed in 0..60 {
        let robot = RandomRobot::new(seed, &grown());
        for fidelity in Fidelity::ALL {
            let mut s = Subject::of(&robot, fidelity);
            let function = s.function(Quantity::Forward).expect("every robot has it");
            accelerates_as_the_library::<f64>(&s, &function, DOUBLE);
            if s.round() {
                accelerates_as_the_library::<f32>(&s, &function, SINGLE);
            }
        }
    }
}

pub fn accelerates_as_the_library<T: Real>(s: &Subject, function: &Function, tolerance: f64) {
    let got = s.evaluate::<T>(function, &[]);
    let got = |name: &str| got.iter().find(|(of, _)| of == name).map(|(_, x)| x.clone());
    let [qdd, thetadd, tau_j] = library::forward(s);
    let (got_qdd, got_tau_j) = (got("qdd").expect("it is there"), got("tau_j").expect("it is there"));
    let got_thetadd = got("thetadd").unwrap_or(got_qdd.clone());
    let want = library::torques(s, &qdd, &thetadd);
    let sum = norm(&library::mass_matrix(s)[0].value) * norm(&qdd);
    let what = |of: &str| format!("forward dynamics, {of} in {}", T::NAME);
    for (of, got, want) in [
        ("torques on joints", &library::torques(s, &got_qdd, &got_thetadd)[0], &want[0]),
        ("torques of motors", &library::torques(s, &got_qdd, &got_thetadd)[1], &want[1]),
        ("tau_j", &got_tau_j, &tau_j),
    ] {
        assert_close_above(&what(of), s, got, want, tolerance, sum);
    }
}

#[test]
fn generated_mass_matrix_equals_library() {
    equals_library(60, &grown(), Quantity::MassMatrix, library::mass_matrix);
}

#[test]
fn generated_coupling_equals_library() {
    equals_library(60, &grown(), Quantity::Coupling, library::coupling_matrix);
}

#[test]
fn generated_reflected_inertia_equals_library() {
    equals_library(60, &grown(), Quantity::ReflectedInertia, library::reflected);
}

#[test]
fn generated_coriolis_matrices_equal_library() {
    equals_library(60, &grown(), Quantity::Coriolis, library::coriolis);
}

#[test]
fn generated_gravity_torques_equal_library() {
    equals_library(60, &grown(), Quantity::Gravity, library::gravity);
}

#[test]
fn generated_bias_forces_equal_library() {
    equals_library(60, &grown(), Quantity::Bias, library::bias_forces);
}

#[test]
fn generated_energies_equal_library() {
    equals_library(60, &grown(), Quantity::Energy, library::energies);
}

#[test]
fn generated_regressor_equals_library() {
    equals_library(40, &grown(), Quantity::Regressor, library::regressors);
}

#[test]
fn generated_placements_equal_library() {
    equals_library(60, &grown(), Quantity::Placements, library::poses);
}

#[test]
fn generated_jacobian_equals_library() {
    let last = |s: &Subject| Frame { body: s.bodies.len() - 1, placement: Transform::identity() };
    equals_library(60, &grown(), Quantity::Jacobian, |s| library::jacobian_of(s, last(s), Axes::World));
}

#[test]
fn generated_jacobian_is_that_of_the_frame_asked_for() {
    for seed in 0..40 {
        let s = Subject::of(&RandomRobot::new(seed, &grown()), Fidelity::Complete);
        let placement = Transform::from_pose(Mat3::from_rpy(0.3, -0.5, 1.1), Vec3::new(0.1, -0.2, 0.3));
        for (body, axes) in [(0, Axes::Local), (s.bodies.len() / 2, Axes::World)] {
            let options = Options { point: Some(Point { body, placement, axes }), ..Options::default() };
            let function = function(&s.robot(), Quantity::Jacobian, &options).expect("the body is there");
            s.assert_equal::<f64>(&function, &library::jacobian_of(&s, Frame { body, placement }, axes), &[], DOUBLE);
        }
    }
}

/// What the mass of a rigid robot does not show, its rotors, is nowhere else either: `M q̈ + C q̇ + g` with friction is inverse dynamics.
#[test]
fn matrices_and_vectors_together_are_inverse_dynamics() {
    let options = Grown { friction: 0.0, transmission_error: 0.0, ..grown() };
    for seed in 0..40 {
        let robot = RandomRobot::new(seed, &options);
        for fidelity in Fidelity::ALL {
            let s = Subject::of(&robot, fidelity);
            let nv = s.state.qd.len();
            let all = |quantity| s.function(quantity).map(|f| s.evaluate::<f64>(&f, &[])).unwrap_or_default();
            let named: Vec<(String, Vec<f64>)> =
                [Quantity::MassMatrix, Quantity::Coupling, Quantity::Coriolis, Quantity::Gravity, Quantity::Inverse]
                    .into_iter()
                    .flat_map(all)
                    .collect();
            let find = |name: &str| named.iter().find(|(of, _)| of == name).map(|(_, x)| x.as_slice());
            let mut sum = find("g").expect("it is there").to_vec();
            let x = &s.state;
            for (matrix, by) in [("m", &x.qdd), ("s", &x.thetadd), ("c", &x.qd), ("c1", &x.thetad)] {
                let Some(matrix) = find(matrix) else { continue };
                for (row, sum) in sum.iter_mut().enumerate() {
                    *sum += (0..nv).map(|k| matrix[row * nv + k] * by[k]).sum::<f64>();
                }
            }
            // Behind a rigid gear the rotor is part of the matrices: the motor's torque.
            let want = Known::new("tau_j", find("tau_j").expect("it is there").to_vec());
            let tau = find("tau").expect("it is there");
            let model = s.rigid.view();
            let rigid = |k: usize| model.bodies().iter().any(|b| b.v_index() == k && !b.is_elastic());
            let want: Vec<f64> =
                want.value.iter().enumerate().map(|(k, x)| if rigid(k) { tau[k] } else { *x }).collect();
            assert_close_above("M q̈ + S θ̈ + C q̇ + C₁ θ̇ + g", &s, &sum, &want, DOUBLE, norm(&sum));
        }
    }
}
