//! Forward and inverse dynamics, and the matrices, from `M`, `h` and the virtual work of every force.

use super::law;
use super::{DriveAt, Oracle};
use crate::State;
use gyroflex::model::{DriveSpec, TransmissionSpec};
use nalgebra::{DMatrix, DVector, Vector3};

/// Result of forward dynamics.
#[derive(Clone, Debug)]
pub struct Accelerations {
    /// Link accelerations.
    pub qdd: Vec<f64>,
    /// Motor accelerations, reflected; those of the link where there is no elastic transmission.
    pub thetadd: Vec<f64>,
    /// Torque through every transmission; `tau` itself where there is no drive.
    pub tau_j: Vec<f64>,
}

/// Result of inverse dynamics.
#[derive(Clone, Debug)]
pub struct Torques {
    /// What the transmission must deliver.
    pub tau_j: Vec<f64>,
    /// What the motor must deliver, reflected.
    pub tau: Vec<f64>,
}

/// Blocks of the mass matrix of the free coordinates, each `nv × nv`.
#[derive(Clone, Debug)]
pub struct Matrices {
    /// Links with every rotor at rest in them and rigidly geared ones turning along.
    pub m: DMatrix<f64>,
    /// `S`: link rows, elastic motor columns, reflected; zero columns elsewhere.
    pub coupling: DMatrix<f64>,
    /// `B`: the block of the elastic motors, zero elsewhere.
    pub motor: DMatrix<f64>,
}

impl Oracle<'_> {
    /// Accelerations under motor torques, external forces and the forces of the state.
    pub fn forward(&self, s: &State) -> Accelerations {
        let (nv, drives, p) = (self.nv(), self.drives(), self.projection());
        let tree = self.tree(s);
        let mass = tree.mass_matrix();
        let h = tree.forces(&DVector::zeros(mass.nrows()));

        // All forces but rigid gears' internal ones, which do no work.
        let outer = self.outer_link_forces(s);
        let mut q = self.motor_forces(s);
        for i in 0..nv {
            q[i] += outer[i];
        }
        for d in drives.iter().filter(|d| d.free >= nv) {
            let (tau_j, passed) = self.transmission(d, s);
            q[d.joint] += tau_j;
            q[d.rotor] -= passed * tau_j;
        }
        let xdd = &p * solve_scaled(&(p.transpose() * &mass * &p), &(p.transpose() * (q - &h)));

        // What the links' own rows need, a rigid gear delivers.
        let needed = mass * &xdd + h;
        let mut tau_j = s.tau.clone();
        let mut thetadd: Vec<f64> = xdd.iter().copied().take(nv).collect();
        for d in &drives {
            thetadd[d.joint] = xdd[d.rotor];
            tau_j[d.joint] = if d.free >= nv { self.transmission(d, s).0 } else { needed[d.joint] - outer[d.joint] };
        }
        Accelerations { qdd: xdd.iter().copied().take(nv).collect(), thetadd, tau_j }
    }

    /// Torques that make the accelerations of the state happen.
    pub fn inverse(&self, s: &State) -> Torques {
        let nv = self.nv();
        let needed = self.tree_forces(s);
        let outer = self.outer_link_forces(s);
        let tau_j: Vec<f64> = (0..nv).map(|i| needed[i] - outer[i]).collect();
        let mut tau = tau_j.clone();
        let friction = self.motor_friction(s);
        for (d, friction) in self.drives().iter().zip(friction) {
            let passed = if d.free >= nv { self.transmission(d, s).1 } else { 1.0 };
            tau[d.joint] = passed * tau_j[d.joint] + needed[d.rotor] + friction;
        }
        Torques { tau_j, tau }
    }

    /// `M xdd + h` of the bare tree, gravity included: `nv` link rows, then one reflected row per rotor.
    pub fn tree_forces(&self, s: &State) -> Vec<f64> {
        let nv = self.nv();
        let rotors = self.drives();
        let motor = |d: &DriveAt<'_>| if d.free >= nv { s.thetadd[d.joint] } else { s.qdd[d.joint] };
        let xdd = s.qdd.iter().copied().chain(rotors.iter().map(motor));
        let xdd = DVector::from_iterator(nv + rotors.len(), xdd);
        self.tree(s).forces(&xdd).as_slice().to_vec()
    }

    /// The blocks of the mass matrix at `q` (a state whose rates are not read).
    pub fn matrices(&self, s: &State) -> Matrices {
        let (nv, p) = (self.nv(), self.projection());
        let free = p.transpose() * self.tree(s).mass_matrix() * &p;
        let mut out = Matrices {
            m: free.view((0, 0), (nv, nv)).into_owned(),
            coupling: DMatrix::zeros(nv, nv),
            motor: DMatrix::zeros(nv, nv),
        };
        let drives = self.drives();
        for d in drives.iter().filter(|d| d.free >= nv) {
            out.coupling.column_mut(d.joint).copy_from(&free.view((0, d.free), (nv, 1)));
            for other in drives.iter().filter(|d| d.free >= nv) {
                out.motor[(d.joint, other.joint)] = free[(d.free, other.free)];
            }
        }
        out
    }

    /// `1 − e'` of every elastic transmission: the part of its torque that the motor feels; one elsewhere.
    pub fn passed_by_transmissions(&self, s: &State) -> Vec<f64> {
        let nv = self.nv();
        let mut out = vec![1.0; nv];
        for d in self.drives().iter().filter(|d| d.free >= nv) {
            out[d.joint] = self.deflection(d, s).2;
        }
        out
    }

    /// `τ_J` and the factor `1 − e'` with which the motor feels it, of an elastic transmission.
    pub(crate) fn transmission(&self, d: &DriveAt<'_>, s: &State) -> (f64, f64) {
        let (deflection, rate, passed) = self.deflection(d, s);
        let TransmissionSpec::Elastic { spring, damping, .. } = &d.spec.transmission else { return (0.0, 1.0) };
        (law::spring_torque(spring, self.spec.spring_tables, deflection) + damping * rate, passed)
    }

    /// `δ = θ − q − e(θ)`, `δ̇` and `1 − e'`.
    pub(crate) fn deflection(&self, d: &DriveAt<'_>, s: &State) -> (f64, f64, f64) {
        let TransmissionSpec::Elastic { error, .. } = &d.spec.transmission else { return (0.0, 0.0, 1.0) };
        let (theta, thetad) = (s.theta[d.joint], s.thetad[d.joint]);
        let (e, slope) = law::transmission_error(error, d.spec.gear_ratio, theta);
        let q = s.q[s.q.len() - s.qd.len() + d.joint];
        (theta - q - e, (1.0 - slope) * thetad - s.qd[d.joint], 1.0 - slope)
    }

    /// External and frictional forces on the link rows.
    fn outer_link_forces(&self, s: &State) -> DVector<f64> {
        let mut out = DVector::from_vec(self.external(s));
        for (i, f) in self.link_friction(s).into_iter().enumerate() {
            out[i] -= f;
        }
        out
    }

    /// `tau_ext` and the external wrenches' virtual work.
    pub(super) fn external(&self, s: &State) -> Vec<f64> {
        let nv = self.nv();
        let mut out = DVector::zeros(nv);
        for (i, f) in s.tau_ext.iter().enumerate() {
            out[i] += f;
        }
        for (link, w) in self.tree(s).links.iter().zip(&s.wrenches) {
            let (couple, force) = (Vector3::new(w[0], w[1], w[2]), Vector3::new(w[3], w[4], w[5]));
            let work = link.jac_ang.tr_mul(&(link.rot * couple)) + link.jac_lin.tr_mul(&(link.rot * force));
            out += work.rows(0, nv);
        }
        out.as_slice().to_vec()
    }

    /// Friction on the link side, per velocity.
    pub(crate) fn link_friction(&self, s: &State) -> Vec<f64> {
        let mut out = vec![0.0; self.nv()];
        let first = out.len() - self.spec.bodies.len();
        for (i, body) in self.spec.bodies.iter().enumerate() {
            // A floating root is body 0, takes six velocities and has no friction.
            if first == 0 || i > 0 {
                out[first + i] = law::friction(&body.friction, s.qd[first + i]);
            }
        }
        out
    }

    /// Friction of every rotor, reflected.
    pub(crate) fn motor_friction(&self, s: &State) -> Vec<f64> {
        let (_, thetad) = self.rotors(s);
        let reflected = |(d, rate): (&DriveSpec, f64)| d.gear_ratio * law::friction(&d.friction, d.gear_ratio * rate);
        let drives = self.drives();
        drives.iter().map(|d| d.spec).zip(thetad).map(reflected).collect()
    }

    /// `tau` where it acts: on the rotor, or on the joint itself where there is no drive; less the rotors' friction.
    fn motor_forces(&self, s: &State) -> DVector<f64> {
        let drives = self.drives();
        let mut out = DVector::zeros(self.nv() + drives.len());
        for (i, tau) in s.tau.iter().enumerate() {
            out[i] = *tau;
        }
        for (d, friction) in drives.iter().zip(self.motor_friction(s)) {
            out[d.joint] = 0.0;
            out[d.rotor] = s.tau[d.joint] - friction;
        }
        out
    }
}

/// Solves `A x = b` for a symmetric positive definite `A` brought to unit diagonal, with one step of refinement.
pub(crate) fn solve_scaled(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    let scale = a.diagonal().map(|d| 1.0 / d.sqrt());
    let by = DMatrix::from_diagonal(&scale);
    let scaled = &by * a * &by;
    let factor = scaled.clone().cholesky().expect("the mass matrix is positive definite");
    let right = b.component_mul(&scale);
    let mut x = factor.solve(&right);
    x += factor.solve(&(&right - &scaled * &x));
    x.component_mul(&scale)
}
