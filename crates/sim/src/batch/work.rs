//! Storage of one thread.

use gyroflex::Scalar;
use gyroflex::dynamics::{
    AbaScratch, CrbaScratch, DerivativeScratch, ForwardScratch, JointSpaceScratch, RneaScratch, joint_space_len,
    matrix_len,
};
use gyroflex::model::Model;
use gyroflex::spatial::{Motion, Transform};

/// States side by side, results, and scratch of the algorithms.
pub(super) struct Work<T> {
    pub(super) q: Vec<T>,
    pub(super) qd: Vec<T>,
    pub(super) theta: Vec<T>,
    pub(super) thetad: Vec<T>,
    pub(super) qdd: Vec<T>,
    pub(super) thetadd: Vec<T>,
    pub(super) tau: Vec<T>,
    pub(super) tau_ext: Vec<T>,
    /// Each with room for the largest result.
    pub(super) out: [Vec<T>; 3],
    pub(super) scratch: Scratch<T>,
}

pub(super) struct Scratch<T> {
    aba: Vec<AbaScratch<T>>,
    joint_space: Vec<JointSpaceScratch<T>>,
    matrix: Vec<T>,
    pub(super) rnea: Vec<RneaScratch<T>>,
    pub(super) crba: Vec<CrbaScratch<T>>,
    pub(super) derivative: Vec<DerivativeScratch<T>>,
    pub(super) moving: Vec<(Transform<T>, Motion<T>)>,
    pub(super) poses: Vec<Transform<T>>,
}

impl<T: Scalar> Work<T> {
    pub(super) fn new(model: &Model<T::Param>) -> Self {
        let (nq, nv) = (model.nq(), model.nv());
        let zeros = |n| vec![T::zero(); n];
        let room = (nv * nv).max(6 * nv).max(16);
        Self {
            q: zeros(nq),
            qd: zeros(nv),
            theta: zeros(nv),
            thetad: zeros(nv),
            qdd: zeros(nv),
            thetadd: zeros(nv),
            tau: zeros(nv),
            tau_ext: zeros(nv),
            out: core::array::from_fn(|_| zeros(room)),
            scratch: Scratch::new(model),
        }
    }

    /// All that is given.
    pub(super) fn given(&self) -> [&[T]; 8] {
        let Self { q, qd, theta, thetad, qdd, thetadd, tau, tau_ext, .. } = self;
        [q, qd, theta, thetad, qdd, thetadd, tau, tau_ext]
    }
}

impl<T: Scalar> Scratch<T> {
    pub(super) fn new(model: &Model<T::Param>) -> Self {
        let n = model.bodies().len();
        Self {
            aba: vec![AbaScratch::new(); n],
            joint_space: vec![JointSpaceScratch::new(); joint_space_len(model)],
            matrix: vec![T::zero(); matrix_len(model)],
            rnea: vec![RneaScratch::new(); n],
            crba: vec![CrbaScratch::new(); n],
            derivative: vec![DerivativeScratch::new(); n],
            moving: vec![(Transform::identity(), Motion::zero()); n],
            poses: vec![Transform::identity(); n],
        }
    }

    pub(super) fn forward(&mut self) -> ForwardScratch<'_, T> {
        ForwardScratch { bodies: &mut self.aba, joint_space: &mut self.joint_space, matrix: &mut self.matrix }
    }
}
