//! The multipliers: `A λ = b` with `A = J M⁻¹ Jᵀ`, where directions may depend on each other.

use super::spec::{Constraint, Contact};
use crate::Scalar;
use crate::dispatch::Over;

/// What is done about constrained directions that depend on others.
///
/// `A` is eliminated direction by direction. What is left of a direction's own entry when those before it are out says how far it is
/// independent of them: less than `threshold` of what it was, and it is left out, its multiplier zero. Of constraints that say the same, the first
/// bear the load.
#[derive(Clone, Copy, Debug)]
pub struct Regularisation<T> {
    /// Part of a direction's own entry below which it counts as dependent.
    pub threshold: T,
    /// Part of its own entry that is added to each, so that dependent directions share the load and all give way a little: `A + damping diag(A)`.
    pub damping: T,
}

impl<T: Scalar> Regularisation<T> {
    /// No damping, and the threshold given: 1e-9 suits `f64`, 1e-4 `f32`.
    pub fn rank_revealing(threshold: T) -> Self {
        Self { threshold, damping: T::zero() }
    }
}

/// How it went.
#[derive(Clone, Copy, Debug)]
pub struct Solved<T> {
    /// How many directions were left out because they depend on others.
    pub dependent: T,
    /// The largest acceleration that those ask for and do not get [m/s² or rad/s²; in impacts m/s or rad/s]. Not small: the constraints contradict
    /// each other.
    pub contradiction: T,
    /// The smallest part that was left of a direction's own entry, of those that count.
    pub independence: T,
    /// How many contacts were released because they would have pulled.
    pub released: T,
}

/// A square system in a caller's storage, by rows.
pub(super) struct System<'a, T> {
    pub(super) rows: usize,
    /// `A`.
    pub(super) a: &'a mut [T],
    /// `b`.
    pub(super) b: &'a mut [T],
    /// Room for the elimination.
    pub(super) work: &'a mut [T],
    /// 1 for directions that count, 0 for those released.
    pub(super) counts: &'a mut [T],
}

impl<'a, T: Scalar> System<'a, T> {
    /// Cuts `matrix`, of [`super::constraint_matrix_len`] entries.
    #[inline(always)]
    pub(super) fn of(rows: usize, matrix: &'a mut [T]) -> Self {
        let (a, rest) = matrix.split_at_mut_checked(rows * rows).unwrap_or_default();
        let (work, rest) = rest.split_at_mut_checked(rows * rows).unwrap_or_default();
        let (b, counts) = rest.split_at_mut_checked(rows).unwrap_or_default();
        Self { rows, a, b, work, counts }
    }

    #[inline(always)]
    fn at<F: Over<T>>(all: &[T], i: usize) -> F {
        all.get(i).map_or(F::zero(), |x| F::load(*x))
    }

    #[inline(always)]
    fn put<F: Over<T>>(all: &mut [T], i: usize, x: F) {
        if let Some(entry) = all.get_mut(i) {
            *entry = x.store();
        }
    }

    /// Solves for `λ`, which must have `rows` entries, and releases contacts that pull if `release` says so.
    #[inline(always)]
    pub(super) fn solve<F: Over<T>>(
        &mut self,
        constraints: &[Constraint<T>],
        regularisation: &Regularisation<T>,
        release: bool,
        lambda: &mut [T],
    ) -> Solved<T> {
        self.counts.iter_mut().for_each(|c| *c = T::one());
        let mut solved = self.once::<F>(constraints, regularisation, lambda);
        let contacts = constraints.iter().filter(|c| c.contact.is_some()).count();
        if release {
            // The contact that pulls most goes first; the others may then push.
            for _ in 0..contacts {
                let released = self.release::<F>(constraints, lambda);
                solved = self.once::<F>(constraints, regularisation, lambda);
                solved.released = released.store();
            }
        }
        solved
    }

    /// Takes out the contact that pulls most, if one does. Returns how many are out.
    #[inline(always)]
    fn release<F: Over<T>>(&mut self, constraints: &[Constraint<T>], lambda: &[T]) -> F {
        let mut strongest = F::zero();
        each_contact(constraints, |normal, _| {
            let force: F = Self::at(lambda, normal);
            strongest = force.select_less(strongest, force, strongest);
        });
        let mut out = F::zero();
        each_contact(constraints, |normal, (first, rows)| {
            let force: F = Self::at(lambda, normal);
            // Of those that pull at all, the strongest.
            let stays = strongest.select_less(force, F::one(), F::zero());
            let stays = force.select_less(F::zero(), stays, F::one());
            for row in first..first + rows {
                let counts = Self::at::<F>(self.counts, row) * stays;
                Self::put(self.counts, row, counts);
            }
            out += F::one() - Self::at::<F>(self.counts, normal);
        });
        out
    }

    #[inline(always)]
    fn once<F: Over<T>>(
        &mut self,
        constraints: &[Constraint<T>],
        regularisation: &Regularisation<T>,
        lambda: &mut [T],
    ) -> Solved<T> {
        let n = self.rows;
        let (threshold, more) = (F::load(regularisation.threshold), F::one() + F::load(regularisation.damping));
        // A released direction is an equation of its own: λ = 0.
        for (i, own) in self.counts.iter().enumerate() {
            let (row, work) = (self.a.get(i * n..(i + 1) * n), self.work.get_mut(i * n..(i + 1) * n));
            let (Some(row), Some(work), own) = (row, work, F::load(*own)) else { break };
            for ((to, entry), other) in work.iter_mut().zip(row).zip(self.counts.iter()) {
                *to = (own * F::load(*other) * F::load(*entry)).store();
            }
            if let Some(entry) = work.get_mut(i) {
                *entry = F::load(*entry).mul_add(more, F::one() - own).store();
            }
        }
        for ((to, b), own) in lambda.iter_mut().zip(self.b.iter()).zip(self.counts.iter()) {
            *to = (F::load(*own) * F::load(*b)).store();
        }
        // What slips is pushed by its normal force: λ_t = s λ_n.
        each_slip(constraints, |normal, row, ratio| {
            let ratio = F::load(ratio);
            for i in 0..n {
                let sum = ratio.mul_add(Self::at(self.work, i * n + row), Self::at(self.work, i * n + normal));
                Self::put(self.work, i * n + normal, sum);
                Self::put(self.work, i * n + row, F::zero());
                Self::put(self.work, row * n + i, F::zero());
            }
            Self::put(self.work, row * n + row, F::one());
            Self::put(lambda, row, F::zero());
        });

        // Elimination without exchanging rows: A is that of a positive quadratic form, but for what slips.
        // A direction in which nothing can move has an entry of rounding alone.
        let mut floor = F::zero();
        for k in 0..n {
            let own: F = Self::at(self.a, k * n + k);
            floor = own.select_less(floor, floor, own);
        }
        let floor = threshold.mul_add(floor, F::from_f64(1e-20));
        let (mut dependent, mut contradiction, mut independence) = (F::zero(), F::zero(), F::one());
        for k in 0..n {
            let (own, left): (F, F) = (Self::at(self.a, k * n + k), Self::at(self.work, k * n + k));
            let counts: F = Self::at(self.counts, k);
            let own = own.select_less(floor, floor, own);
            let least = threshold.mul_add(own, F::from_f64(1e-30));
            let part = left.select_less(least, F::zero(), F::one());
            let safe = left.select_less(least, F::one(), left);
            let inverse = part / safe;
            dependent += F::one() - part;
            // A direction that is left out has no equation left but this one.
            let missed: F = Self::at(lambda, k);
            let missed = (F::one() - part) * missed.select_less(F::zero(), -missed, missed);
            contradiction = missed.select_less(contradiction, contradiction, missed);
            let ratio = part * counts * (left / own) + (F::one() - part * counts);
            independence = ratio.select_less(independence, ratio, independence);
            let (head, below) = self.work.split_at_mut_checked((k + 1) * n).unwrap_or_default();
            let pivot = head.get(k * n + k + 1..).unwrap_or_default();
            let (head, right) = lambda.split_at_mut_checked(k + 1).unwrap_or_default();
            let right_k: F = head.last().map_or(F::zero(), |x| F::load(*x));
            for (i, right) in right.iter_mut().enumerate() {
                let row = below.get_mut(i * n + k..(i + 1) * n);
                let Some((first, rest)) = row.and_then(|row| row.split_first_mut()) else { break };
                let factor = -(F::load(*first) * inverse);
                for (entry, of_pivot) in rest.iter_mut().zip(pivot) {
                    *entry = factor.mul_add(F::load(*of_pivot), F::load(*entry)).store();
                }
                *right = factor.mul_add(right_k, F::load(*right)).store();
            }
            Self::put(self.work, k * n + k, inverse);
        }
        // Column by column: no sum waits for another one.
        for k in (0..n).rev() {
            let (above, rest) = lambda.split_at_mut_checked(k).unwrap_or_default();
            let Some(own) = rest.first_mut() else { continue };
            let solved = F::load(*own) * Self::at::<F>(self.work, k * n + k);
            *own = solved.store();
            for (i, sum) in above.iter_mut().enumerate() {
                *sum = (-Self::at::<F>(self.work, i * n + k)).mul_add(solved, F::load(*sum)).store();
            }
        }
        each_slip(constraints, |normal, row, ratio| {
            let force = F::load(ratio) * Self::at(lambda, normal);
            Self::put(lambda, row, force);
        });
        Solved {
            dependent: dependent.store(),
            contradiction: contradiction.store(),
            independence: independence.store(),
            released: T::zero(),
        }
    }
}

/// The row of a constraint's direction, from that of its first one.
#[inline(always)]
fn row_of<T: Scalar>(constraint: &Constraint<T>, first: usize, direction: usize) -> usize {
    first + (0..direction).filter(|k| constraint.holds(*k)).count()
}

/// Calls for every contact, with the row of its normal and its first row and number of rows.
#[inline(always)]
fn each_contact<T: Scalar>(constraints: &[Constraint<T>], mut call: impl FnMut(usize, (usize, usize))) {
    let mut first = 0;
    for constraint in constraints {
        if let Some(Contact { normal, .. }) = &constraint.contact {
            call(row_of(constraint, first, *normal), (first, constraint.rows()));
        }
        first += constraint.rows();
    }
}

/// Calls for every direction in which a contact slips, with the rows of the normal and of the direction, and the ratio of their forces.
#[inline(always)]
fn each_slip<T: Scalar>(constraints: &[Constraint<T>], mut call: impl FnMut(usize, usize, T)) {
    let mut first = 0;
    for constraint in constraints {
        if let Some(Contact { normal, slip: Some(ratios), .. }) = &constraint.contact {
            let at = row_of(constraint, first, *normal);
            for (k, ratio) in ratios.to_array().into_iter().enumerate() {
                let direction = k + 3;
                if direction != *normal && constraint.holds(direction) {
                    call(at, row_of(constraint, first, direction), ratio);
                }
            }
        }
        first += constraint.rows();
    }
}
