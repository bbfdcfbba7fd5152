//! Inverse dynamics of a rigid model around a desired motion.

use crate::Scalar;
use crate::dynamics::{
    Acceleration, Constraint, ConstraintError, External, Inverse, Regularisation, RneaScratch, Solved, State,
    SupportScratch, TorqueDistribution, constrained_inverse_dynamics, rnea,
};
use crate::model::{Model, SizeError};

/// `τ = M (q̈_d + k_p (q_d − q) + k_d (q̇_d − q̇)) + C q̇ + g + friction` of a rigid model (Siciliano et al., §8.5.2): joints decoupled and
/// linear, as far as they are rigid.
#[derive(Clone, Copy, Debug)]
pub struct ComputedTorque<'a, T> {
    /// Position gains: `nv` entries [1/s²].
    pub kp: &'a [T],
    /// Velocity gains: `nv` entries [1/s].
    pub kd: &'a [T],
}

/// A motion to follow, or one that was measured, of a robot on a fixed base: `nv` entries each.
#[derive(Clone, Copy, Debug)]
pub struct Joints<'a, T> {
    /// Positions [rad or m].
    pub q: &'a [T],
    /// Velocities [rad/s or m/s].
    pub qd: &'a [T],
}

impl<T: Scalar> ComputedTorque<'_, T> {
    /// Writes the torques. `qdd` holds the desired accelerations and is left with those that are commanded; `tau_j` is written as by
    /// [`rnea`].
    ///
    /// # Errors
    /// [`SizeError`] if a slice does not fit the model, or the root floats.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own")]
    pub fn torque(
        &self,
        rigid: &Model<T::Param>,
        desired: Joints<T>,
        measured: Joints<T>,
        qdd: &mut [T],
        scratch: &mut [RneaScratch<T>],
        tau_j: &mut [T],
        tau: &mut [T],
    ) -> Result<(), SizeError> {
        self.command(rigid.nv(), desired, measured, qdd)?;
        let Joints { q, qd } = measured;
        let accel = Acceleration { qdd, thetadd: qdd };
        let state = State { q, qd, theta: qd, thetad: qd };
        rnea(rigid, state, accel, External::none(), scratch, Inverse { tau_j, tau })
    }

    /// The same for a robot that something holds: of all torques that make the commanded motion, those that `distribution` asks for
    /// ([`constrained_inverse_dynamics`]); nothing drives its passive velocities. What the command asks for along held directions, the constraints
    /// take up: errors that the constraints allow decay as without them. `multipliers` are the forces of the constraints that go with it.
    ///
    /// # Errors
    /// A slice that does not fit the model, a root that floats, or a constraint that does not fit.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own")]
    pub fn torque_while_held(
        &self,
        rigid: &Model<T::Param>,
        desired: Joints<T>,
        measured: Joints<T>,
        qdd: &mut [T],
        constraints: &[Constraint<T>],
        distribution: TorqueDistribution<T>,
        regularisation: Regularisation<T>,
        scratch: HeldScratch<T>,
        out: Inverse<T>,
        multipliers: &mut [T],
    ) -> Result<Solved<T>, ConstraintError> {
        self.command(rigid.nv(), desired, measured, qdd)?;
        let Joints { q, qd } = measured;
        let accel = Acceleration { qdd, thetadd: qdd };
        let state = State { q, qd, theta: qd, thetad: qd };
        let HeldScratch { bodies, supports, matrix } = scratch;
        constrained_inverse_dynamics(
            rigid,
            state,
            accel,
            External::none(),
            constraints,
            distribution,
            regularisation,
            bodies,
            supports,
            matrix,
            out,
            multipliers,
        )
    }

    /// `q̈_d + k_p (q_d − q) + k_d (q̇_d − q̇)` in the place of `q̈_d`.
    fn command(&self, nv: usize, desired: Joints<T>, measured: Joints<T>, qdd: &mut [T]) -> Result<(), SizeError> {
        let lengths = [
            ("kp", self.kp.len()),
            ("kd", self.kd.len()),
            ("q desired", desired.q.len()),
            ("qd desired", desired.qd.len()),
            ("q", measured.q.len()),
            ("qd", measured.qd.len()),
            ("qdd", qdd.len()),
        ];
        lengths.into_iter().try_for_each(|(name, given)| SizeError::check(name, given, nv))?;
        for (i, a) in qdd.iter_mut().enumerate() {
            let of = |all: &[T]| all.get(i).map_or(T::zero(), |x| *x);
            let (e, ed) = (of(desired.q) - of(measured.q), of(desired.qd) - of(measured.qd));
            *a = of(self.kp).mul_add(e, of(self.kd).mul_add(ed, *a));
        }
        Ok(())
    }
}

/// What [`ComputedTorque::torque_while_held`] works in.
#[derive(Debug)]
pub struct HeldScratch<'a, T> {
    /// One record per body.
    pub bodies: &'a mut [RneaScratch<T>],
    /// One record per body.
    pub supports: &'a mut [SupportScratch<T>],
    /// [`constrained_inverse_len`](crate::dynamics::constrained_inverse_len) entries.
    pub matrix: &'a mut [T],
}
