//! Pass 2 at one joint: the torque through it, where its motor must be for that, and what the motor and its carrier need.

use super::outward::{set, speeds};
use super::{ElasticInverse, ElasticInverseScratch, InverseError, Rates, transmission};
use crate::dispatch::{Kernel, Over};
use crate::jet::{factorial, inverse_factorial};
use crate::model::{Body, Drive, Friction, Knot};
use crate::spatial::Vec3;
use crate::{Jet, Scalar};

/// A joint, and all that is given about it.
pub(super) struct Site<'a, T: Scalar> {
    pub(super) index: usize,
    pub(super) body: &'a Body<T::Param>,
    pub(super) knots: &'a [Knot<T::Param>],
    pub(super) damped: bool,
    pub(super) q: T,
    pub(super) rates: Rates<'a, T>,
    pub(super) tau_ext: Rates<'a, T>,
    pub(super) deflection: T,
    pub(super) step: T,
}

/// Where results go.
pub(super) struct JointOutputs<'a, T> {
    /// Rows of the torques.
    pub(super) rows: usize,
    pub(super) nv: usize,
    pub(super) out: ElasticInverse<'a, T>,
}

impl<T: Scalar> JointOutputs<'_, T> {
    /// Writes derivatives from coefficients; whether all are finite.
    #[inline(always)]
    fn put<F: Over<T>>(to: &mut [T], nv: usize, k: usize, first_row: usize, rows: usize, c: &[F]) -> bool {
        let mut finite = true;
        for row in 0..rows {
            let (Some(slot), Some(c)) = (to.get_mut((first_row + row) * nv + k), c.get(row)) else { continue };
            *slot = (*c * F::from_f64(factorial(row))).store();
            finite &= slot.is_finite();
        }
        finite
    }

    /// Position and rate of the motor; whether all is finite.
    #[inline(always)]
    pub(super) fn theta<F: Over<T>>(&mut self, k: usize, now: F, rate: &[F]) -> bool {
        let (rows, nv) = (self.rows, self.nv);
        let at = Self::put(self.out.theta, nv, k, 0, 1, &[now]);
        Self::put(self.out.theta, nv, k, 1, rows + 1, rate) && at
    }

    /// A motor that moves with its joint: position and derivatives as they are given.
    pub(super) fn theta_of_joint(&mut self, k: usize, q: T, rates: Rates<T>) {
        for row in 0..self.rows + 2 {
            let given = if row == 0 { Some(&q) } else { rates.row(row - 1) };
            if let Some(slot) = self.out.theta.get_mut(row * self.nv + k) {
                *slot = given.map_or(T::zero(), |x| *x);
            }
        }
    }

    /// Torques on the joint and of the motor; whether all are finite.
    #[inline(always)]
    pub(super) fn torques<F: Over<T>>(&mut self, k: usize, tau_j: &[F], tau: &[F]) -> bool {
        let (rows, nv) = (self.rows, self.nv);
        let on_joint = Self::put(self.out.tau_j, nv, k, 0, rows, tau_j);
        Self::put(self.out.tau, nv, k, 0, rows, tau) && on_joint
    }

    /// Deflection after the step, and its present rate; whether both are finite.
    #[inline(always)]
    fn deflection<F: Over<T>>(&mut self, k: usize, after: F, rate: F) -> bool {
        let nv = self.nv;
        let end = Self::put(self.out.deflection, nv, k, 0, 1, &[after]);
        Self::put(self.out.deflection_rate, nv, k, 0, 1, &[rate]) && end
    }
}

/// The joint of a body, with the `N` coefficients of the force on the body.
pub(super) struct Joint<'a, 'o, T: Scalar, const N: usize> {
    pub(super) site: Site<'a, T>,
    pub(super) own: &'a [ElasticInverseScratch<T>],
    pub(super) carrier: &'a mut [ElasticInverseScratch<T>],
    pub(super) out: &'a mut JointOutputs<'o, T>,
}

impl<T: Scalar, const N: usize> Kernel<T> for Joint<'_, '_, T, N> {
    type Output = Result<(), InverseError>;
    const WIDE: bool = false;

    #[inline(always)]
    fn run<F: Over<T>>(self) -> Result<(), InverseError> {
        let Self { site, own, carrier, out } = self;
        let (body, k, index) = (site.body, site.rates.k, site.index);
        let overflow = InverseError::Overflow { body: index };
        let (Some(own), Some(carrier)) = (own.first_chunk::<N>(), carrier.first_chunk_mut::<N>()) else {
            return Err(overflow);
        };
        let (qd, qdd) = speeds::<T, F, N>(site.rates);
        let q = F::load(site.q);

        // τ_J = Sᵀ f + f_l(q̇) − τ_ext
        let mut tau_j = Jet::from_fn(|i| {
            let load = site.tau_ext.row(i).map_or(F::zero(), |x| F::load(*x) * F::from_f64(inverse_factorial(i)));
            body.joint.along(own[i].f.map(F::load)) - load
        });
        tau_j += friction(&body.friction, &qd, F::one());

        let Some(Drive { rotor, elastic }) = &body.drive else {
            out.theta_of_joint(k, site.q, site.rates);
            out.deflection(k, F::zero(), F::zero());
            return if out.torques(k, &tau_j.0, &tau_j.0) { Ok(()) } else { Err(overflow) };
        };

        // Where the motor is: at k(δ) + D δ̇ = τ_J, or with the joint
        let (mut now, mut rate, mut motor) = (q, qd, tau_j);
        let (mut after, mut deflection_rate) = (F::zero(), F::zero());
        if let Some(elastic) = elastic {
            let now_deflected = F::load(site.deflection);
            let deflection =
                transmission::deflection::<T, F, N>(elastic, site.knots, &tau_j, site.damped, now_deflected);
            after = deflection.now;
            if site.damped {
                let (damping, torque) = (T::from_param(elastic.damping), transmission::store(&tau_j).0);
                after = F::load(transmission::after(&deflection, site.step, damping, &torque));
            }
            deflection_rate = deflection.rate.value();
            (now, rate) = (q + deflection.now, qd + deflection.rate);
            if let Some(error) = &elastic.error {
                let found = transmission::motor(error, rotor, now.store(), &transmission::store(&rate));
                (now, rate) = (F::load(found.now), transmission::load(&found.rate));
                motor = transmission::load::<T, F, N>(&found.share) * tau_j;
            }
            if tau_j.value().store().is_finite() && !now.store().is_finite() {
                return Err(InverseError::Transmission { body: index });
            }
        }
        let acceleration = if elastic.is_some() { rate.rate() } else { qdd };

        // τ = (1 − e') τ_J + B θ̈ + N J n·α + N f_m,   and the couple ḣ n + ω × h n on the carrier
        motor += acceleration.scale(F::from_param(rotor.reflected_inertia))
            + friction(&rotor.friction, &rate, F::from_param(rotor.gear_ratio));
        let axis = rotor.axis_in::<F>();
        let (inertia, ratio) = (F::from_param(rotor.inertia), F::from_param(rotor.gear_ratio));
        let [mut about, mut across] = [(); 2].map(|()| Vec3::new(Jet::zero(), Jet::zero(), Jet::zero()));
        let mut h = Jet::<F, N>::zero();
        for i in 0..N {
            let carrier = carrier[i].moving.map(F::load);
            let (spin, spun) = (axis.dot(carrier.omega), axis.dot(carrier.accel.ang));
            motor.0[i] = (ratio * inertia).mul_add(spun, motor.0[i]);
            // An elastic rotor's J n nᵀ is not part of its carrier's inertia.
            let (spin, spun) = if elastic.is_some() { (spin, spun) } else { (F::zero(), F::zero()) };
            h.0[i] = inertia * ratio.mul_add(rate.0[i], spin);
            let h_dot = inertia * ratio.mul_add(acceleration.0[i], spun);
            set(&mut about, i, axis.scale(h_dot));
            set(&mut across, i, carrier.omega.cross(axis));
        }
        let couple = across.scale(h) + about;
        for i in 0..N {
            let c = couple.map(|c| c.0[i]);
            carrier[i].f.ang = (carrier[i].f.ang.map(F::load) + c).map(F::store);
        }

        let mut finite = out.torques(k, &tau_j.0, &motor.0);
        match elastic {
            Some(_) => finite &= out.theta(k, now, &rate.0),
            None => out.theta_of_joint(k, site.q, site.rates),
        }
        finite &= out.deflection(k, after, deflection_rate);
        if finite { Ok(()) } else { Err(overflow) }
    }
}

/// `N f(N v)`: friction of a shaft that turns `N` times as fast as `v`, seen from beyond the gear.
#[inline(always)]
fn friction<T: Scalar, F: Over<T>, const N: usize>(of: &Friction<T::Param>, v: &Jet<F, N>, ratio: F) -> Jet<F, N> {
    let speed = v.scale(ratio);
    let torque = if of.dry {
        transmission::load(&dry_friction(of, &transmission::store(&speed)))
    } else {
        speed.scale(F::from_param(of.viscous))
    };
    torque.scale(ratio)
}

/// Dry friction as a series: a subroutine, since few robots have it and it is long.
#[inline(never)]
fn dry_friction<T: Scalar, const N: usize>(of: &Friction<T::Param>, speed: &Jet<T, N>) -> Jet<T, N> {
    of.torque(*speed)
}
