//! Equations (30) to (35) and (46), element by element.

use super::chain::{CetinkuntBook, Coordinate};
use crate::State;
use crate::dense::solve_scaled;
use gyroflex::model::{SpringSpec, TransmissionSpec};
use nalgebra::{DMatrix, DVector, Matrix4, Vector4};

impl CetinkuntBook {
    /// `M(q)` (eq. 32), in the order of (37).
    pub fn inertia(&self, q: &[f64]) -> DMatrix<f64> {
        let all = self.coordinates();
        DMatrix::from_fn(all.len(), all.len(), |row, column| {
            let (p, s) = (all[row], all[column]);
            self.both_in_w(q, p, s) + self.one_in_w(q, p, s) + self.one_in_w(q, s, p) + self.none_in_w(q, p, s)
        })
    }

    /// (32.a): links beyond both coordinates.
    fn both_in_w(&self, q: &[f64], p: Coordinate, s: Coordinate) -> f64 {
        let links = p.element.max(s.element).div_ceil(2)..=self.links.len();
        let of = |i: usize| {
            let w = |c: Coordinate| self.w(2 * i - 1, q, &[c]);
            (w(s) * self.integrals[i - 1].second_moments(self.of_link(i, q)) * w(p).transpose()).trace()
        };
        links.filter(|i| 2 * i > p.element.max(s.element)).map(of).sum()
    }

    /// (32.b): a coordinate before a link and one of its modes.
    fn one_in_w(&self, q: &[f64], p: Coordinate, s: Coordinate) -> f64 {
        if s.element % 2 == 1 || p.element >= s.element {
            return 0.0;
        }
        let (of, i) = (&self.integrals[s.element / 2 - 1], s.element / 2);
        let inner = of.c_j[s.index] + of.bent(s.index, self.of_link(i, q));
        (self.w(s.element - 1, q, &[p]) * inner * self.w(s.element - 1, q, &[]).transpose()).trace()
    }

    /// (32.c): two modes of a link.
    fn none_in_w(&self, q: &[f64], p: Coordinate, s: Coordinate) -> f64 {
        if p.element != s.element || p.element % 2 == 1 {
            return 0.0;
        }
        let of = &self.integrals[p.element / 2 - 1];
        let w = self.w(p.element - 1, q, &[]);
        (w * of.c_jk[p.index * of.c_j.len() + s.index] * w.transpose()).trace()
    }

    /// `C(q, q̇)` (eq. 33).
    pub fn centrifugal(&self, q: &[f64], qd: &[f64]) -> DVector<f64> {
        let all = self.coordinates();
        // Σ ∂W q̇ and Σ Σ ∂²W q̇ q̇
        let first = |k: usize| all.iter().zip(qd).map(|(s, qd)| self.w(k, q, &[*s]) * *qd).sum::<Matrix4<f64>>();
        let second = |k: usize| {
            let of = |(s, sd): (&Coordinate, &f64)| {
                all.iter().zip(qd).map(|(u, ud)| self.w(k, q, &[*s, *u]) * (sd * ud)).sum::<Matrix4<f64>>()
            };
            all.iter().zip(qd).map(of).sum::<Matrix4<f64>>()
        };
        let (first, second): (Vec<_>, Vec<_>) =
            (1..=self.links.len()).map(|i| (first(2 * i - 1), second(2 * i - 1))).unzip();
        let of = |p: &Coordinate| {
            let mut sum = 0.0;
            for i in p.element.div_ceil(2)..=self.links.len() {
                let (integrals, eta, rates) = (&self.integrals[i - 1], self.of_link(i, q), self.of_link(i, qd));
                if 2 * i > p.element {
                    let by_p = self.w(2 * i - 1, q, &[*p]);
                    sum += (second[i - 1] * integrals.second_moments(eta) * by_p.transpose()).trace();
                    let moving = |(j, rate): (usize, &f64)| (integrals.c_j[j] + integrals.bent(j, eta)) * (2.0 * rate);
                    let moving = rates.iter().enumerate().map(moving).sum::<Matrix4<f64>>();
                    sum += (by_p * moving * first[i - 1].transpose()).trace();
                } else {
                    let w = self.w(p.element - 1, q, &[]).transpose();
                    sum += (second[i - 1] * (integrals.c_j[p.index] + integrals.bent(p.index, eta)) * w).trace();
                    sum += (first[i - 1] * integrals.bent(p.index, rates) * w).trace() * 2.0;
                }
            }
            sum
        };
        DVector::from_iterator(all.len(), all.iter().map(of))
    }

    /// `G(q)` (eq. 34).
    pub fn gravity(&self, q: &[f64]) -> DVector<f64> {
        let all = self.coordinates();
        let of = |p: &Coordinate| {
            let beyond = |i: usize| {
                let (integrals, eta) = (&self.integrals[i - 1], self.of_link(i, q));
                let bent = integrals.me.iter().zip(eta).map(|(me, q)| me * *q).sum::<Vector4<f64>>();
                self.gravity.dot(&(self.w(2 * i - 1, q, &[*p]) * (integrals.mg + bent)))
            };
            let mut sum: f64 = (p.element / 2 + 1..=self.links.len()).map(beyond).sum();
            if p.element.is_multiple_of(2) {
                let me = self.integrals[p.element / 2 - 1].me[p.index];
                sum += self.gravity.dot(&(self.w(p.element - 1, q, &[]) * me));
            }
            -sum
        };
        DVector::from_iterator(all.len(), all.iter().map(of))
    }

    /// `K q` (eq. 35).
    pub fn elastic(&self, q: &[f64]) -> DVector<f64> {
        let bent = (1..=self.links.len()).flat_map(|i| {
            let forces = &self.links[i - 1].stiffness * DVector::from_column_slice(self.of_link(i, q));
            forces.as_slice().to_vec()
        });
        DVector::from_vec(vec![0.0; self.joints.len()].into_iter().chain(bent).collect())
    }

    /// Accelerations of joints and links, then of the joints' rotors, reflected, by (38), or (46) of the joints that are elastic:
    /// linear springs, no losses, the rotor's energy that of its own spin.
    pub fn forward(&self, s: &State) -> [Vec<f64>; 2] {
        let mut forces = -self.centrifugal(&s.q, &s.qd) - self.gravity(&s.q) - self.elastic(&s.q);
        let mut motors = vec![0.0; self.joints.len()];
        for (i, joint) in self.joints.iter().enumerate() {
            let Some(drive) = &joint.drive else {
                forces[i] += s.tau[i];
                continue;
            };
            let TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, .. } = drive.transmission
            else {
                panic!("the paper's joints are linear springs");
            };
            let through = stiffness * (s.theta[i] - s.q[i]);
            forces[i] += through;
            motors[i] = (s.tau[i] - through) / (drive.gear_ratio.powi(2) * drive.rotor.inertia);
        }
        let accelerations = solve_scaled(&self.inertia(&s.q), &forces);
        [accelerations.as_slice().to_vec(), motors]
    }

    /// Forces on joints and modes that make these accelerations happen.
    pub fn inverse(&self, s: &State) -> Vec<f64> {
        let moved = self.inertia(&s.q) * DVector::from_column_slice(&s.qdd);
        let all = moved + self.centrifugal(&s.q, &s.qd) + self.gravity(&s.q) + self.elastic(&s.q);
        all.as_slice().to_vec()
    }
}
