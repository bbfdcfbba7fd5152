// Both the test and the program it builds include this file: what they compare.

use gyroflex::Scalar;
use gyroflex::dynamics::{
    AbaScratch, Acceleration, CrbaScratch, External, Forward, ForwardScratch, Inverse, JointSpaceScratch, RneaScratch,
    State, crba, forward_dynamics, joint_space_len, matrix_len, placements, rnea,
};
use gyroflex::model::Model;
use gyroflex::spatial::Transform;

/// Results of the algorithms at a state that moves every joint, digit for digit.
pub fn probe<T: Scalar<Param = T>>(model: &Model<'_, T>) -> String {
    let (nq, nv, n) = (model.nq(), model.nv(), model.bodies().len());
    let wave = |len: usize, size: f64| -> Vec<T> {
        (0..len).map(|i| T::from_f64(size * ((7 * i + 3) % 11) as f64 / 11.0 - size / 2.0)).collect()
    };
    let (q, qd, qdd, tau) = (wave(nq, 3.0), wave(nv, 2.0), wave(nv, 10.0), wave(nv, 30.0));
    // Motors lead by a deflection; a floating root leads with positions of another length.
    let theta: Vec<T> = q[nq - nv..].iter().zip(wave(nv, 0.01)).map(|(q, d)| *q + d).collect();
    let state = State { q: &q, qd: &qd, theta: &theta, thetad: &qd };
    let zeros = || vec![T::zero(); nv];

    let (mut moved, mut thetadd, mut tau_j) = (zeros(), zeros(), zeros());
    let mut bodies = vec![AbaScratch::new(); n];
    let mut matrix = vec![T::zero(); matrix_len(model)];
    let mut joint_space = vec![JointSpaceScratch::new(); joint_space_len(model)];
    let scratch = ForwardScratch { bodies: &mut bodies, joint_space: &mut joint_space, matrix: &mut matrix };
    let out = Forward { qdd: &mut moved, thetadd: &mut thetadd, tau_j: &mut tau_j };
    forward_dynamics(model, state, &tau, External::none(), scratch, out).expect("slices fit the model");

    let (mut needed_j, mut needed) = (zeros(), zeros());
    let mut scratch = vec![RneaScratch::new(); n];
    let accel = Acceleration { qdd: &qdd, thetadd: &qdd };
    let out = Inverse { tau_j: &mut needed_j, tau: &mut needed };
    rnea(model, state, accel, External::none(), &mut scratch, out).expect("slices fit the model");

    let mut m = vec![T::zero(); nv * nv];
    crba(model, &q, &mut vec![CrbaScratch::new(); n], &mut m).expect("slices fit the model");
    let mut poses = vec![Transform::<T>::identity(); n];
    placements(model, &q, &mut poses).expect("slices fit the model");
    // The shortest form that reads back as the same bits differs where a bit does.
    format!("{moved:?} {thetadd:?} {tau_j:?} {needed_j:?} {needed:?} {m:?} {poses:?}")
}
