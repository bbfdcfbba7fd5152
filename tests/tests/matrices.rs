//! Inertia matrix, coupling and reflected inertia: against the oracle and against each other.

use gyroflex::model::{Fidelity, RobotSpec};
use gyroflex::spatial::Vec3;
use gyroflex_testkit::State;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, norm, tol};
use gyroflex_tests::{Core, Trial, for_trials};

fn equal_oracle<T: Real>(t: &Trial<'_, T>) {
    let want = t.oracle().matrices(&t.state);
    t.assert_close("M", &t.core.mass_matrix(&t.state), want.m.transpose().as_slice(), 0.0);
    // Zero, but for the oracle's rounding, where the rotors' axes never turn along.
    let size = want.motor.amax();
    t.assert_close("S", &t.core.coupling(&t.state), want.coupling.transpose().as_slice(), size);
    let diagonal = want.motor.diagonal();
    t.assert_close("B", &t.core.reflected_inertia(), diagonal.as_slice(), 0.0);
    // And nothing couples two motors.
    let off_diagonal = &want.motor - nalgebra::DMatrix::from_diagonal(&diagonal);
    assert_eq!(off_diagonal.amax(), 0.0, "{t}");
}

#[test]
fn matrices_equal_the_dense_oracles() {
    for_trials::<f64>(500, &Options::default(), &Fidelity::ALL, tol(1e-12, 0.0), equal_oracle);
}

#[test]
fn matrices_in_single_precision() {
    for_trials::<f32>(300, &Options::default(), &Fidelity::ALL, tol(0.0, 1e-4), equal_oracle);
}

/// Inverse dynamics at rest without gravity of a unit acceleration is a column: of links, `M` in the link rows and `Sᵀ` in
/// the motors'; of a motor, `S` and `B`.
fn columns_are_unit_motions<T: Real>(t: &Trial<'_, T>) {
    let spec = RobotSpec { gravity: Vec3::new(0.0, 0.0, 0.0), ..t.robot.spec() };
    let core = Core::<T>::new(&spec, t.fidelity);
    let model = core.model();
    let nv = model.nv();
    let zero = vec![0.0; nv];
    let still = State {
        qd: zero.clone(),
        thetad: zero.clone(),
        qdd: zero.clone(),
        thetadd: zero.clone(),
        tau_ext: Vec::new(),
        wrenches: Vec::new(),
        ..t.state.clone()
    };
    let (m, s, b) = (core.mass_matrix(&still), core.coupling(&still), core.reflected_inertia());
    // The row that an elastic transmission feels, and where it passes to the motor; a rigid gear's row is the motor's.
    let elastic: Vec<bool> = model.bodies().iter().flat_map(|b| vec![b.is_elastic(); b.joint.nv()]).collect();
    let size = norm(&m);
    let passed = t.oracle().passed_by_transmissions(&still);
    let rows = |accelerated: &State| {
        let torque = core.inverse(accelerated);
        let link: Vec<f64> = (0..nv).map(|i| if elastic[i] { torque.tau_j[i] } else { torque.tau[i] }).collect();
        let motor: Vec<f64> =
            (0..nv).map(|i| if elastic[i] { torque.tau[i] - passed[i] * torque.tau_j[i] } else { 0.0 }).collect();
        (link, motor)
    };
    for k in 0..nv {
        let mut unit = zero.clone();
        unit[k] = 1.0;
        let column = |a: &[f64]| -> Vec<f64> { (0..nv).map(|i| a[i * nv + k]).collect() };
        let row = |a: &[f64]| a[k * nv..(k + 1) * nv].to_vec();

        let (link, motor) = rows(&State { qdd: unit.clone(), ..still.clone() });
        t.assert_close("column of M", &link, &column(&m), size);
        t.assert_close("row of S", &motor, &row(&s), size);
        if elastic[k] {
            let (link, motor) = rows(&State { thetadd: unit.clone(), ..still.clone() });
            t.assert_close("column of S", &link, &column(&s), size);
            let own: Vec<f64> = unit.iter().map(|u| u * b[k]).collect();
            t.assert_close("column of B", &motor, &own, size);
        }
    }
}

#[test]
fn columns_of_the_inertia_matrix_are_inverse_dynamics_of_unit_accelerations() {
    for_trials::<f64>(150, &Options::default(), &Fidelity::ALL, tol(1e-12, 0.0), columns_are_unit_motions);
    for_trials::<f32>(50, &Options::default(), &Fidelity::ALL, tol(0.0, 1e-4), columns_are_unit_motions);
}

#[test]
fn inertia_matrix_is_symmetric_and_the_whole_of_it_positive_definite() {
    for_trials::<f64>(300, &Options::default(), &Fidelity::ALL, tol(1e-13, 0.0), |t| {
        let nv = t.robot.nv();
        let square = |a: &[f64]| nalgebra::DMatrix::from_row_slice(nv, nv, a);
        let m = square(&t.core.mass_matrix(&t.state));
        t.assert_close("Mᵀ", m.transpose().as_slice(), m.as_slice(), 0.0);
        // [M S; Sᵀ B] > 0  <=>  B > 0 and M − S B⁻¹ Sᵀ > 0
        let s = square(&t.core.coupling(&t.state));
        let inverse = t.core.reflected_inertia().iter().map(|b| if *b > 0.0 { 1.0 / b } else { 0.0 }).collect();
        let schur =
            m - &s * nalgebra::DMatrix::from_diagonal(&nalgebra::DVector::<f64>::from_vec(inverse)) * s.transpose();
        assert!(schur.cholesky().is_some(), "{t}");
    });
}
