//! The matrices of the equations of motion, from kinetic and potential energy alone, by automatic differentiation.
//!
//! Independent of the core's algorithms and of [`crate::dense`]: positions and velocities of the centres of mass and angular
//! velocities of all bodies, every rotor a body of its own, give `T = Σ ½ m v² + ½ ωᵀ I ω` and `U = −Σ m g·c` in any number type.
//! Coordinates are `x = (q, θ)`, `nv` entries each, motors reflected; entries of `θ` that belong to no elastic transmission do not
//! move anything, and their rows and columns are zero. All else is differentiation, exact by [`Dual`] numbers:
//!
//! ```text
//! M_ij   T polarised on unit velocities
//! Ṁ      its slope along the motion
//! C      Σ_k c_ijk ẋ_k,   c_ijk = ½ (∂M_ij/∂x_k + ∂M_ik/∂x_j − ∂M_jk/∂x_i)   (Zhao et al. 2015, below eq. 10)
//! g      the slopes of U
//! ```
//!
//! The twist of a floating root is not the rate of any coordinates. Slopes are then along the motions `E_i` of unit twists,
//! which do not commute, and Christoffel's formula becomes Koszul's: `c_ijk` gets
//! `½ (⟨[E_k, E_j], E_i⟩ − ⟨[E_k, E_i], E_j⟩ − ⟨[E_j, E_i], E_k⟩)` more.
//!
//! In the reduced and the rigid reflected model a rotor does not turn: it rides on its mount, and `½ B θ̇²` is added.

mod bodies;

use crate::{Dual, State};
use bodies::{Body, Positions, bodies};
use gyroflex::Scalar;
use gyroflex::model::{Fidelity, JointKind, RobotSpec, TransmissionSpec};
use nalgebra::{DMatrix, DVector, Quaternion, Vector3};

/// Energies of one robot in one of the four models, and their derivatives.
#[derive(Clone, Debug)]
pub struct EnergyOracle<'a> {
    spec: RobotSpec<'a>,
    fidelity: Fidelity,
    nv: usize,
    /// Where in `xd` the rotor of a joint has its velocity: behind a rigid gear that of the joint.
    rotors: Vec<usize>,
    /// Reflected inertias that are in no body, at their places in `xd`.
    lumped: Vec<(usize, f64)>,
    /// The coordinates that move something.
    moving: Vec<usize>,
}

impl<'a> EnergyOracle<'a> {
    /// The energies of a valid description.
    pub fn new(spec: RobotSpec<'a>, fidelity: Fidelity) -> Self {
        let nv = spec.bodies.iter().map(|b| b.joint.nv()).sum();
        let mut out =
            Self { spec, fidelity, nv, rotors: (0..nv).collect(), lumped: Vec::new(), moving: (0..nv).collect() };
        let mut joint = 0;
        for body in spec.bodies {
            if let Some(drive) = &body.drive {
                if fidelity.is_elastic() && matches!(drive.transmission, TransmissionSpec::Elastic { .. }) {
                    out.rotors[joint] = nv + joint;
                    out.moving.push(nv + joint);
                }
                if !fidelity.is_gyroscopic() {
                    out.lumped.push((out.rotors[joint], drive.gear_ratio.powi(2) * drive.rotor.inertia));
                }
            }
            joint += body.joint.nv();
        }
        out
    }

    /// `ẋ` of a state: `2 nv` entries, zero where nothing moves.
    pub fn velocity(&self, s: &State) -> DVector<f64> {
        let mut xd = DVector::zeros(2 * self.nv);
        let all = [s.qd.as_slice(), &s.thetad].concat();
        for &i in &self.moving {
            xd[i] = all[i];
        }
        xd
    }

    /// `T` [J].
    pub fn kinetic(&self, s: &State) -> f64 {
        let motion = self.motion(&still(s), &self.velocity(s));
        0.5 * self.pairing(&motion, &motion).value
    }

    /// `M`: `2 nv` square.
    pub fn inertia(&self, s: &State) -> DMatrix<f64> {
        self.matrix(&still(s)).map(|m| m.value)
    }

    /// `Ṁ` along the motion of the state: `2 nv` square.
    pub fn inertia_rate(&self, s: &State) -> DMatrix<f64> {
        self.matrix(&self.along(s, &self.velocity(s))).map(|m| m.slope)
    }

    /// `C` with `Ṁ = C + Cᵀ`: `2 nv` square.
    ///
    /// `Σ_k (∂M_ik/∂x_j) ẋ_k` is how fast the momentum `p_i = (M ẋ)_i` changes along `x_j` with the velocities held, which saves
    /// to differentiate the whole of `M` along every coordinate. Of the brackets `Σ_k` leaves those with `ẋ`.
    pub fn coriolis(&self, s: &State) -> DMatrix<f64> {
        let xd = self.velocity(s);
        let (m, rate) = (self.inertia(s), self.inertia_rate(s));
        let momentum = &m * &xd;
        let mut slopes = DMatrix::zeros(2 * self.nv, 2 * self.nv);
        for &j in &self.moving {
            slopes.set_column(j, &self.momentum_slope(s, &self.unit(j), &xd));
        }
        // ⟨[ẋ, E_j], E_i⟩
        let turning = DMatrix::from_columns(&self.each(|j| &m * self.bracket(&xd, &self.unit(j))));
        let between = DMatrix::from_fn(2 * self.nv, 2 * self.nv, |i, j| {
            momentum.dot(&self.bracket(&self.unit(j), &self.unit(i)))
        });
        (rate + &slopes - slopes.transpose() + &turning - turning.transpose() - between) * 0.5
    }

    /// `g`: slopes of `U` along the link coordinates, `nv` entries [N m or N].
    pub fn gravity(&self, s: &State) -> DVector<f64> {
        let potential = |x: &Positions<Dual>| {
            let at_rest = self.motion(x, &DVector::zeros(2 * self.nv));
            at_rest.bodies.iter().map(|b| b.potential(self.spec.gravity).slope).sum()
        };
        DVector::from_fn(self.nv, |k, _| potential(&self.along(s, &self.unit(k))))
    }

    fn unit(&self, k: usize) -> DVector<f64> {
        DVector::from_fn(2 * self.nv, |i, _| f64::from(u8::from(i == k)))
    }

    fn each<R>(&self, of: impl FnMut(usize) -> R) -> Vec<R> {
        (0..2 * self.nv).map(of).collect()
    }

    fn motion(&self, x: &Positions<Dual>, xd: &DVector<f64>) -> Motion {
        let velocities: Vec<Dual> = xd.iter().map(|v| Dual::from_f64(*v)).collect();
        let bodies = bodies(&self.spec, self.fidelity, &self.rotors, x, &velocities);
        Motion { bodies, xd: xd.clone() }
    }

    /// `xdᵀ M xd'` of two motions from the same place.
    fn pairing(&self, a: &Motion, b: &Motion) -> Dual {
        let spins = self.lumped.iter().map(|&(i, reflected)| Dual::from_f64(reflected * a.xd[i] * b.xd[i]));
        let turning = a.bodies.iter().zip(&b.bodies).map(|(a, b)| a.pairing(b));
        turning.chain(spins).fold(Dual::zero(), |sum, t| sum + t)
    }

    fn matrix(&self, x: &Positions<Dual>) -> DMatrix<Dual> {
        let units: Vec<Motion> = self.moving.iter().map(|&k| self.motion(x, &self.unit(k))).collect();
        let mut m = DMatrix::from_element(2 * self.nv, 2 * self.nv, Dual::new(0.0, 0.0));
        for (a, &i) in units.iter().zip(&self.moving) {
            for (b, &j) in units.iter().zip(&self.moving) {
                m[(i, j)] = self.pairing(a, b);
            }
        }
        m
    }

    /// Slope of `M ẋ` along `direction`, `ẋ` held.
    fn momentum_slope(&self, s: &State, direction: &DVector<f64>, xd: &DVector<f64>) -> DVector<f64> {
        let x = self.along(s, direction);
        let motion = self.motion(&x, xd);
        let mut out = DVector::zeros(2 * self.nv);
        for &i in &self.moving {
            out[i] = self.pairing(&self.motion(&x, &self.unit(i)), &motion).slope;
        }
        out
    }

    /// Positions of a state on their way with the velocity `u`. A floating root moves in its own frame: `ṗ = R v`,
    /// `Q̇ = ½ Q (ω, 0)`.
    fn along(&self, s: &State, u: &DVector<f64>) -> Positions<Dual> {
        let mut x = still(s);
        let lead = if self.is_floating() { 6 } else { 0 };
        if lead > 0 {
            let turn = Quaternion::new(s.q[6], s.q[3], s.q[4], s.q[5]);
            let turning = turn * Quaternion::new(0.0, u[0], u[1], u[2]) * 0.5;
            let moving = nalgebra::UnitQuaternion::from_quaternion(turn) * Vector3::new(u[3], u[4], u[5]);
            let rates = [moving.x, moving.y, moving.z, turning.i, turning.j, turning.k, turning.w];
            for (q, rate) in x.q.iter_mut().zip(rates) {
                q.slope = rate;
            }
        }
        let first = x.q.len() - self.nv;
        for k in lead..self.nv {
            x.q[first + k].slope = u[k];
        }
        for (theta, rate) in x.theta.iter_mut().zip(u.rows(self.nv, self.nv).iter()) {
            theta.slope = *rate;
        }
        x
    }

    /// `[a, b]` of two velocities: of the twists of a floating root in its own frame; zero between coordinates.
    pub fn bracket(&self, a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
        let mut out = DVector::zeros(2 * self.nv);
        if self.is_floating() {
            let part = |x: &DVector<f64>, at: usize| Vector3::new(x[at], x[at + 1], x[at + 2]);
            let turned = part(a, 0).cross(&part(b, 0));
            let moved = part(a, 0).cross(&part(b, 3)) + part(a, 3).cross(&part(b, 0));
            out.fixed_rows_mut::<3>(0).copy_from(&turned);
            out.fixed_rows_mut::<3>(3).copy_from(&moved);
        }
        out
    }

    fn is_floating(&self) -> bool {
        self.spec.bodies.first().is_some_and(|b| b.joint == JointKind::Floating)
    }
}

/// All bodies, moving with `xd`.
struct Motion {
    bodies: Vec<Body<Dual>>,
    xd: DVector<f64>,
}

fn still(s: &State) -> Positions<Dual> {
    let constant = |x: &[f64]| x.iter().map(|x| Dual::from_f64(*x)).collect();
    Positions { q: constant(&s.q), theta: constant(&s.theta) }
}
