//! Impulses of several contacts at once, with friction: the law of Moreau and Jean, by projection contact by contact.
//!
//! Velocities after the impact and impulses agree: a point that is pushed is held (or thrown back), one that is not may leave, and friction is at
//! most `μ p_n` and against what is left of the velocity along the ground. Such an impact loses energy if it is plastic, however many feet there are
//! and however they depend on each other.

use super::{Contacts, THRESHOLD};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::scenario::Ground;
use crate::simulate::StateVec;
use gyroflex::dynamics::{Constrained, ConstraintMotion, External, Forward, Regularisation};
use gyroflex::spatial::{Force, Vec3};

/// Rounds of projection for an impact, which is rare and is to be exact, and for forces.
const IMPACT_ROUNDS: usize = 20_000;
const FORCE_ROUNDS: usize = 2_000;
/// Change of the largest impulse, relative, at which impulses are known.
const KNOWN: f64 = 1e-15;
/// The same where rounding or many feet keep it from becoming less.
const NEARLY: f64 = 1e-9;

/// What an impact needs to know of a robot at a position.
pub(super) struct Responses {
    /// Rows of each contact: those along the ground, then the normal.
    width: usize,
    /// Velocities of the contacts before [m/s].
    pub(super) before: Vec<f64>,
    /// Change of joint and motor velocities by an impulse of 1 N s in each row.
    rates: Vec<[Vec<f64>; 2]>,
    /// Change of the contacts' velocities by that, by columns [1/kg].
    compliance: Vec<Vec<f64>>,
}

impl Contacts {
    /// How joints, motors and contacts answer impulses on the closed contacts.
    pub(super) fn responses(
        &mut self,
        dynamics: &mut Dynamics,
        state: &StateVec,
        ground: &Ground,
    ) -> Result<Responses, Error> {
        let (nv, width) = (dynamics.nv(), if ground.planar { 2 } else { 3 });
        let rows = width * self.closed.len();
        let feet = self.constraints[self.permanent.len()..].to_vec();
        let (mut before, mut jacobian) = (vec![0.0; rows], vec![0.0; rows * nv]);
        let out = ConstraintMotion { error: &mut [], velocity: &mut before, jacobian: &mut jacobian };
        dynamics.constraint_motion(&state.q, &state.qd, &feet, out)?;
        dynamics.placements(&state.q, &mut self.poses)?;
        let axes = if ground.planar { &[0, 2][..] } else { &[0, 1, 2] };
        let mut wrenches = vec![Force::zero(); self.poses.len()];
        let rest = self.at_rest(dynamics, state, &wrenches)?;
        let (mut rates, mut compliance) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
        for contact in self.closed.clone() {
            let (body, point) = (self.points[contact].body, self.points[contact].point);
            for axis in axes {
                let mut unit = [0.0; 3];
                unit[*axis] = 1.0;
                let force = self.poses[body].rot * Vec3::from(unit);
                wrenches[body] = Force { ang: point.cross(force), lin: force };
                let mut answer = self.at_rest(dynamics, state, &wrenches)?;
                wrenches[body] = Force::zero();
                for (with, without) in answer.iter_mut().zip(&rest) {
                    with.iter_mut().zip(without).for_each(|(a, b)| *a -= b);
                }
                let dot = |row: &[f64]| row.iter().zip(&answer[0]).map(|(a, b)| a * b).sum();
                compliance.push(jacobian.chunks(nv.max(1)).map(dot).collect());
                rates.push(answer);
            }
        }
        Ok(Responses { width, before, rates, compliance })
    }

    /// Accelerations of joints and motors at rest under wrenches, held by what always holds.
    fn at_rest(
        &mut self,
        dynamics: &mut Dynamics,
        state: &StateVec,
        wrenches: &[Force<f64>],
    ) -> Result<[Vec<f64>; 2], Error> {
        let zeros = vec![0.0; dynamics.nv()];
        let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| zeros.clone());
        let mut multipliers = vec![0.0; self.permanent_rows()];
        let mut forces = vec![Force::zero(); self.permanent.len()];
        dynamics.constrained_forward(
            gyroflex::dynamics::State { q: &state.q, qd: &zeros, theta: &state.theta, thetad: &zeros },
            &zeros,
            External { tau: &[], wrenches },
            &self.permanent,
            Regularisation::rank_revealing(THRESHOLD),
            Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j },
            Constrained { multipliers: &mut multipliers, wrenches: &mut forces },
        )?;
        Ok([qdd, thetadd])
    }
}

impl Responses {
    /// Impulses by which points that approach leave at `restitution` times their speed, if that is above `resting_speed`. Where `clings`, points are held
    /// on the ground even by a pull. Much friction on feet that are far below the body may have projections go in a circle; without friction they come
    /// to an end.
    pub(super) fn impulses(&self, ground: &Ground, restitution: f64, clings: bool) -> Vec<f64> {
        let found = self.project(ground, ground.friction, restitution, clings);
        found.unwrap_or_else(|_| match self.project(ground, 0.0, restitution, clings) {
            Ok(p) | Err(p) => p,
        })
    }

    /// Impulses, or what was come to in vain.
    fn project(&self, ground: &Ground, friction: f64, restitution: f64, clings: bool) -> Result<Vec<f64>, Vec<f64>> {
        let (n, rows) = (self.width, self.before.len());
        let (mut p, mut v) = (vec![0.0_f64; rows], self.before.clone());
        let mut last = 0.0;
        for _ in 0..IMPACT_ROUNDS {
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for first in (0..rows).step_by(n) {
                let normal = first + n - 1;
                let own = self.compliance[normal][normal];
                if own > f64::MIN_POSITIVE {
                    let approach = -self.before[normal];
                    let target = if approach > ground.resting_speed { restitution * approach } else { 0.0 };
                    let wanted = p[normal] - (v[normal] - target) / own;
                    self.set(normal, if clings { wanted } else { wanted.max(0.0) }, &mut p, &mut v, &mut change);
                }
                self.rub(first, friction * p[normal].max(0.0), &mut p, &mut v, &mut change);
                size = p[first..=normal].iter().fold(size, |m, x| m.max(x.abs()));
            }
            if change <= KNOWN * size {
                return Ok(p);
            }
            last = change / size;
        }
        if last < NEARLY { Ok(p) } else { Err(p) }
    }

    /// Forces, and the accelerations that are left, where `before` has accelerations without contacts. Of points that slide the ratio of friction to the
    /// normal force is given; those at rest are held, as far as friction can.
    pub(super) fn forces(&self, friction: f64, sliding: &[Option<Vec3<f64>>]) -> (Vec<f64>, Vec<f64>) {
        let (n, rows) = (self.width, self.before.len());
        let (mut p, mut a) = (vec![0.0_f64; rows], self.before.clone());
        for _ in 0..FORCE_ROUNDS {
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for (first, ratio) in (0..rows).step_by(n).zip(sliding) {
                let normal = first + n - 1;
                let own = self.compliance[normal][normal].max(f64::MIN_POSITIVE);
                let wanted = (p[normal] - a[normal] / own).max(0.0);
                self.set(normal, wanted, &mut p, &mut a, &mut change);
                match ratio {
                    Some(ratio) => {
                        for (i, ratio) in [ratio.x, ratio.y].into_iter().enumerate().take(n - 1) {
                            self.set(first + i, ratio * wanted, &mut p, &mut a, &mut change);
                        }
                    }
                    None => self.rub(first, friction * wanted, &mut p, &mut a, &mut change),
                }
                size = p[first..=normal].iter().fold(size, |m, x| m.max(x.abs()));
            }
            if change <= 1e-12 * size {
                break;
            }
        }
        (p, a)
    }

    /// Friction of a contact, at most `most`.
    fn rub(&self, first: usize, most: f64, p: &mut [f64], v: &mut [f64], change: &mut f64) {
        let a = |i: usize, j: usize| self.compliance[first + j][first + i];
        let held = match self.width {
            2 => [p[first] - v[first] / a(0, 0).max(f64::MIN_POSITIVE), 0.0],
            _ => {
                let (u, w) = (v[first], v[first + 1]);
                let determinant = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
                if determinant > THRESHOLD * a(0, 0) * a(1, 1) {
                    let along = [a(1, 1) * u - a(0, 1) * w, a(0, 0) * w - a(1, 0) * u];
                    [p[first] - along[0] / determinant, p[first + 1] - along[1] / determinant]
                } else {
                    // It moves along a line, or not at all.
                    let trace = (a(0, 0) + a(1, 1)).max(f64::MIN_POSITIVE);
                    [p[first] - u / trace, p[first + 1] - w / trace]
                }
            }
        };
        let mut next = held;
        if held[0].hypot(held[1]) > most {
            let last = self.width - 2;
            let step = |i: usize| (0..=last).map(|k| a(k, k)).sum::<f64>().recip() * v[first + i];
            let aim = [p[first] - step(0), if last == 1 { p[first + 1] - step(1) } else { 0.0 }];
            let size = aim[0].hypot(aim[1]).max(f64::MIN_POSITIVE);
            next = aim.map(|x| x * (most / size).min(1.0));
        }
        for (i, value) in next.into_iter().enumerate().take(self.width - 1) {
            self.set(first + i, value, p, v, change);
        }
    }

    fn set(&self, row: usize, value: f64, p: &mut [f64], v: &mut [f64], change: &mut f64) {
        let more = value - p[row];
        p[row] = value;
        *change = change.max(more.abs());
        v.iter_mut().zip(&self.compliance[row]).for_each(|(v, a)| *v += a * more);
    }

    /// Adds what impulses do to a state.
    pub(super) fn give(&self, p: &[f64], state: &mut StateVec) {
        for (p, [qd, thetad]) in p.iter().zip(&self.rates) {
            state.qd.iter_mut().zip(qd).for_each(|(v, a)| *v += a * p);
            state.thetad.iter_mut().zip(thetad).for_each(|(v, a)| *v += a * p);
        }
    }
}
