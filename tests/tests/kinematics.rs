//! Placements, velocities and Jacobians against the dense oracle.

use gyroflex::dynamics::{Axes, Frame, jacobian, placements, velocities};
use gyroflex::model::Fidelity;
use gyroflex::spatial::{Motion, Transform, Vec3};
use gyroflex_testkit::dense::LinkMotion;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, tol};
use gyroflex_tests::{Trial, for_trials};
use nalgebra::{Matrix3, Vector3};

fn equal_oracle<T: Real>(t: &Trial<'_, T>) {
    let model = t.core.model();
    let cast = |v: &[f64]| -> Vec<T> { v.iter().map(|x| T::from_f64(*x)).collect() };
    let (q, qd) = (cast(&t.state.q), cast(&t.state.qd));
    let n = model.bodies().len();
    let mut poses = vec![Transform::<T>::identity(); n];
    let mut twists = vec![Motion::<T>::zero(); n];
    placements(&model, &q, &mut poses).expect("slices fit the model");
    velocities(&model, &q, &qd, &mut twists).expect("slices fit the model");
    for (i, want) in t.oracle().links(&t.state).iter().enumerate() {
        let rotation: Vec<f64> = poses[i].rot.rows.iter().flat_map(|r| double(*r)).collect();
        // The core's matrix takes world to link coordinates: its rows are the oracle's columns.
        t.assert_close("rotation", &rotation, want.rotation.as_slice(), 1.0);
        t.assert_close("position", &double(poses[i].pos), want.position.as_slice(), 1.0);
        t.assert_close("angular velocity", &double(twists[i].ang), to_link(want, &want.omega).as_slice(), 1.0);
        t.assert_close("velocity", &double(twists[i].lin), to_link(want, &want.velocity).as_slice(), 10.0);
        equal_jacobians(t, i, &poses, want);
    }
}

/// Of a frame off the link's, in the axes of the world and in its own.
fn equal_jacobians<T: Real>(t: &Trial<'_, T>, body: usize, poses: &[Transform<T>], want: &LinkMotion) {
    let model = t.core.model();
    let nv = model.nv();
    // Placed as the next joint's frame would be: any pose will do.
    let placement = t.robot.bodies[body].placement;
    let frame = Frame { body, placement: placement.map(T::from_f64) };
    let [a, b, c] = placement.rot.rows.map(|r| Vector3::from(r.to_array()));
    let (turn, offset) = (want.rotation * Matrix3::from_columns(&[a, b, c]), Vector3::from(placement.pos.to_array()));
    let mut moved = want.jacobian.clone();
    let lever = (want.rotation * offset).cross_matrix() * moved.rows(0, 3);
    let mut linear = moved.rows_mut(3, 3);
    linear -= lever;
    for (axes, into) in [(Axes::World, Matrix3::identity()), (Axes::Local, turn.transpose())] {
        let mut got = vec![T::zero(); 6 * nv];
        jacobian(&model, poses, frame, axes, &mut got).expect("slices fit the model");
        let got: Vec<f64> = got.into_iter().map(Real::to_f64).collect();
        let mut want = moved.clone();
        want.rows_mut(0, 3).copy_from(&(into * moved.rows(0, 3)));
        want.rows_mut(3, 3).copy_from(&(into * moved.rows(3, 3)));
        t.assert_close("Jacobian", &got, want.transpose().as_slice(), 1.0);
    }
}

fn to_link(link: &LinkMotion, v: &Vector3<f64>) -> Vector3<f64> {
    link.rotation.transpose() * v
}

fn double<T: Real>(v: Vec3<T>) -> [f64; 3] {
    v.to_array().map(Real::to_f64)
}

#[test]
fn placements_velocities_and_jacobians_equal_the_dense_oracle() {
    for_trials::<f64>(300, &Options::default(), &[Fidelity::Complete], tol(1e-12, 0.0), equal_oracle);
    for_trials::<f32>(300, &Options::default(), &[Fidelity::Complete], tol(0.0, 1e-4), equal_oracle);
}
