//! Coriolis and centrifugal terms: the Christoffel symbols of the whole inertia matrix `[[M_l, S], [Sᵀ, B]]`.

use super::compose::Composer;
use super::{ExplicitModel, Sum};
use crate::sym::Sym;
use gyroflex::Scalar;

/// What a product of two velocities does in one equation.
#[derive(Clone, Debug, PartialEq)]
pub struct VelocityTerm {
    /// The velocity of a coordinate.
    pub first: usize,
    /// Another: of a coordinate, or of a motor.
    pub second: Speed,
    /// What the product is multiplied by.
    pub factor: Sum,
}

/// A velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Speed {
    /// `q̇_j`.
    Link(usize),
    /// `θ̇_j`.
    Motor(usize),
}

impl ExplicitModel {
    /// What products of velocities do in the equation of coordinate `i`: `C q̇ + C₁ θ̇`.
    pub fn velocity_terms(&self, i: usize) -> Vec<VelocityTerm> {
        let n = self.nv();
        let mut out = Vec::new();
        for j in 0..n {
            for k in j..n {
                // q̇_j q̇_k: ∂_k M_ij + ∂_j M_ik − ∂_i M_jk, of a square half of it
                let twice = self
                    .by(self.mass(i, j), k)
                    .plus_scaled(1.0, &self.by(self.mass(i, k), j))
                    .plus_scaled(-1.0, &self.by(self.mass(j, k), i));
                let factor = if j == k { twice.scaled(0.5) } else { twice };
                out.push(VelocityTerm { first: j, second: Speed::Link(k), factor });
            }
        }
        for k in 0..n {
            for j in 0..n {
                // q̇_k θ̇_j: ∂_k S_ij − ∂_i S_kj
                let factor = self.by(self.coupling(i, j), k).plus_scaled(-1.0, &self.by(self.coupling(k, j), i));
                out.push(VelocityTerm { first: k, second: Speed::Motor(j), factor });
            }
        }
        out.retain(|term| !term.factor.is_zero());
        out
    }

    /// What products of velocities do in the equation of motor `i`: `C₂ q̇`.
    pub fn motor_velocity_terms(&self, i: usize) -> Vec<VelocityTerm> {
        let n = self.nv();
        let mut out = Vec::new();
        for j in 0..n {
            for k in j..n {
                let rate = self.by(self.coupling(j, i), k);
                let factor = if j == k { rate } else { rate.plus_scaled(1.0, &self.by(self.coupling(k, i), j)) };
                out.push(VelocityTerm { first: j, second: Speed::Link(k), factor });
            }
        }
        out.retain(|term| !term.factor.is_zero());
        out
    }
}

/// Derivatives of inertia as expressions.
pub(super) struct Slopes {
    n: usize,
    /// `∂_k M_ij` at `(i n + j) n + k`.
    mass: Vec<Sym>,
    /// `∂_k S_ij`, likewise.
    coupling: Vec<Sym>,
}

impl Slopes {
    pub(super) fn of(model: &ExplicitModel, composer: &mut Composer) -> Self {
        let n = model.nv();
        let (mut mass, mut coupling) = (vec![Sym::zero(); n * n * n], vec![Sym::zero(); n * n * n]);
        for i in 0..n {
            for j in 0..n {
                for k in 0..n {
                    if j >= i {
                        let slope = composer.compose(&model.by(model.mass(i, j), k));
                        mass[(i * n + j) * n + k] = slope;
                        mass[(j * n + i) * n + k] = slope;
                    }
                    coupling[(i * n + j) * n + k] = composer.compose(&model.by(model.coupling(i, j), k));
                }
            }
        }
        Self { n, mass, coupling }
    }

    fn mass(&self, i: usize, j: usize, k: usize) -> Sym {
        self.mass[(i * self.n + j) * self.n + k]
    }

    fn coupling(&self, i: usize, j: usize, k: usize) -> Sym {
        self.coupling[(i * self.n + j) * self.n + k]
    }

    /// `C q̇ + C₁ θ̇` and `C₂ q̇`, from every slope once: `d/dt (∂T/∂q̇) − ∂T/∂q`.
    pub(super) fn forces(&self, qd: &[Sym], thetad: &[Sym]) -> [Vec<Sym>; 2] {
        let (n, zero, half) = (self.n, Sym::zero(), Sym::from_f64(0.5));
        let (mut link, mut motor) = (vec![zero; n], vec![zero; n]);
        for i in 0..n {
            // ½ q̇_i² M_ii
            let square = half * qd[i] * qd[i];
            let rate = self.rate(|k| self.mass(i, i, k), &[i], qd);
            link[i] += rate * qd[i] + self.mass(i, i, i) * square;
            for k in (0..n).filter(|k| *k != i) {
                link[k] -= self.mass(i, i, k) * square;
            }
            // q̇_i q̇_j M_ij
            for j in i + 1..n {
                let slope = |k| self.mass(i, j, k);
                let rate = self.rate(slope, &[i, j], qd);
                link[i] += rate * qd[j] + slope(j) * (qd[j] * qd[j]);
                link[j] += rate * qd[i] + slope(i) * (qd[i] * qd[i]);
                for k in (0..n).filter(|k| *k != i && *k != j) {
                    link[k] -= slope(k) * (qd[i] * qd[j]);
                }
            }
            // q̇_i θ̇_j S_ij
            for j in 0..n {
                let slope = |k| self.coupling(i, j, k);
                let rate = self.rate(slope, &[i], qd);
                link[i] += rate * thetad[j];
                motor[j] += (rate + slope(i) * qd[i]) * qd[i];
                for k in (0..n).filter(|k| *k != i) {
                    link[k] -= slope(k) * (qd[i] * thetad[j]);
                }
            }
        }
        [link, motor]
    }

    /// How fast an entry changes by all coordinates but some.
    fn rate(&self, slope: impl Fn(usize) -> Sym, but: &[usize], qd: &[Sym]) -> Sym {
        (0..self.n).filter(|k| !but.contains(k)).fold(Sym::zero(), |sum, k| sum + slope(k) * qd[k])
    }

    /// `C, C₁, C₂` by rows.
    pub(super) fn matrices(&self, qd: &[Sym], thetad: &[Sym]) -> [Vec<Sym>; 3] {
        let (n, half) = (self.n, Sym::from_f64(0.5));
        let [mut c, mut c1, mut c2] = [(); 3].map(|()| vec![Sym::zero(); n * n]);
        for i in 0..n {
            for j in 0..n {
                let (mut twice, mut of_motor, mut of_link) = (Sym::zero(), Sym::zero(), Sym::zero());
                for k in 0..n {
                    twice += (self.mass(i, j, k) + self.mass(i, k, j) - self.mass(j, k, i)) * qd[k];
                    twice += (self.coupling(i, k, j) - self.coupling(j, k, i)) * thetad[k];
                    of_motor += (self.coupling(i, j, k) - self.coupling(k, j, i)) * qd[k];
                    of_link += (self.coupling(j, i, k) + self.coupling(k, i, j)) * qd[k];
                }
                (c[i * n + j], c1[i * n + j], c2[i * n + j]) = (half * twice, half * of_motor, half * of_link);
            }
        }
        [c, c1, c2]
    }
}
