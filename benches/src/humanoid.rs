//! A humanoid of 30 joints that stands on its feet.

use crate::generated::turning;
use crate::{STATES, Spec};
use gyroflex::Scalar;
use gyroflex::dynamics::{
    AbaScratch, Anchor, Constrained, ConstrainedScratch, Constraint, ConstraintScratch, Directions, External, Forward,
    Frame, Hold, PropagatedScratch, Regularisation, State, SupportScratch, constrained_forward_dynamics,
    constrained_joint_matrix_len, constraint_matrix_len, constraint_rows, propagated_len,
};
use gyroflex::model::{BodySpec, Fidelity, JointKind, Model};
use gyroflex::spatial::{Force, SpatialInertia, SymMat3, Transform, Vec3};

/// Joints of each limb, and what it hangs on: legs on the pelvis, a waist, arms and a neck on its end.
const LIMBS: [(usize, Option<usize>); 6] = [(6, None), (6, None), (2, None), (7, Some(2)), (7, Some(2)), (2, Some(2))];

/// A floating pelvis with two legs of six joints, a waist of two, two arms of seven and a neck of two, all elastic, and its two feet.
pub fn humanoid() -> (Spec, [usize; 2]) {
    let mut bodies = vec![BodySpec {
        parent: None,
        joint: JointKind::Floating,
        axis: Vec3::new(0.0, 0.0, 1.0),
        placement: Transform::identity(),
        inertia: SpatialInertia::from_com(12.0, Vec3::new(0.0, 0.0, 0.05), SymMat3::diagonal(0.1, 0.08, 0.09)),
        friction: gyroflex::model::Friction::<f64>::none(),
        drive: None,
    }];
    let mut ends = [0; LIMBS.len()];
    for (limb, (joints, on)) in LIMBS.into_iter().enumerate() {
        let mut parent = on.map_or(0, |on| ends[on]);
        for _ in 0..joints {
            bodies.push(turning(Some(parent), bodies.len()));
            parent = bodies.len() - 1;
        }
        ends[limb] = parent;
    }
    (Spec { bodies, spring_tables: Vec::new(), gravity: Vec3::new(0.0, 0.0, -9.81) }, [ends[0], ends[1]])
}

/// The humanoid, some of its feet's motions held, and storage for calls.
#[derive(Debug)]
pub struct Standing<T: Scalar + 'static> {
    model: Model<'static, T::Param>,
    states: Vec<[Vec<T>; 5]>,
    feet: Vec<Constraint<T>>,
    bodies: Vec<AbaScratch<T>>,
    supports: Vec<SupportScratch<T>>,
    constraints: Vec<ConstraintScratch<T>>,
    propagated: Vec<PropagatedScratch<T>>,
    matrix: Vec<T>,
    joint_matrix: Vec<T>,
    out: [Vec<T>; 3],
    multipliers: Vec<T>,
    wrenches: Vec<Force<T>>,
}

impl<T: Scalar + 'static> Standing<T> {
    /// The robot on its feet, of which these motions are held; none of them are if `held` is `None`.
    pub fn new(fidelity: Fidelity, held: Option<Directions>) -> Self {
        let (spec, feet) = humanoid();
        let model = spec.lower::<T::Param>(fidelity);
        let nv = model.nv();
        let mut seed = 0x2545_f491_4f6c_dd1d_u64;
        let mut uniform = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut state = || {
            let mut random = |length: usize, scale: f64| (0..length).map(|_| scale * uniform()).collect::<Vec<_>>();
            let (angles, quaternion) = (random(nv - 6, 0.5), random(4, 1.0));
            let size = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
            let root = random(3, 0.3).into_iter().chain(quaternion.into_iter().map(|x| x / size));
            let q = root.chain(angles.iter().copied()).collect();
            let theta = random(6, 0.0).into_iter().chain(angles).collect::<Vec<_>>();
            let theta = theta.into_iter().zip(random(nv, 1e-3)).map(|(q, d)| q + d).collect();
            [q, random(nv, 1.0), theta, random(nv, 1.0), random(nv, 20.0)]
                .map(|x| x.into_iter().map(T::from_f64).collect())
        };
        let states = (0..STATES).map(|_| state()).collect();
        let foot = |body: usize, directions: Directions| {
            let placement = Transform { pos: Vec3::new(0.0, 0.0, 0.1), ..Transform::identity() }.map(T::from_f64);
            let anchor = Anchor { body: None, placement: Transform::identity() };
            let hold = Hold::Frame { frame: Frame { body, placement }, anchor, directions };
            Constraint { hold, stabilisation: T::zero(), contact: None }
        };
        let feet: Vec<_> = held.into_iter().flat_map(|held| feet.map(|body| foot(body, held))).collect();
        let n = model.bodies().len();
        Self {
            bodies: vec![AbaScratch::new(); n],
            supports: vec![SupportScratch::new(); n],
            constraints: vec![ConstraintScratch::new(); feet.len()],
            propagated: vec![PropagatedScratch::new(); propagated_len(&model, &feet)],
            matrix: vec![T::zero(); constraint_matrix_len(&feet)],
            joint_matrix: vec![T::zero(); constrained_joint_matrix_len(&model, &feet)],
            out: std::array::from_fn(|_| vec![T::zero(); nv]),
            multipliers: vec![T::zero(); constraint_rows(&feet)],
            wrenches: vec![Force::zero(); feet.len()],
            states,
            model,
            feet,
        }
    }

    /// One call at state `i`.
    #[inline]
    pub fn call(&mut self, i: usize) {
        let [q, qd, theta, thetad, tau] = &self.states[i % STATES];
        let [qdd, thetadd, tau_j] = &mut self.out;
        let scratch = ConstrainedScratch {
            bodies: &mut self.bodies,
            supports: &mut self.supports,
            constraints: &mut self.constraints,
            propagated: &mut self.propagated,
            matrix: &mut self.matrix,
            joint_space: &mut [],
            joint_matrix: &mut self.joint_matrix,
        };
        let done = constrained_forward_dynamics(
            &self.model,
            State { q, qd, theta, thetad },
            tau,
            External::none(),
            &self.feet,
            Regularisation::rank_revealing(T::from_f64(1e-9)),
            scratch,
            Forward { qdd, thetadd, tau_j },
            Constrained { multipliers: &mut self.multipliers, wrenches: &mut self.wrenches },
        );
        done.unwrap_or_else(|e| panic!("{e}"));
    }
}
