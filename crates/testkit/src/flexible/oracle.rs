//! Forward and inverse dynamics, energies and powers, from the Lagrangian and the virtual work of every force.

use super::lagrange::{along, equations, kinetic, mass_matrix, unit};
use super::points::Placed;
use super::{BendingLink, Seats};
use crate::State;
use crate::dense::{self, Accelerations, DriveAt, Energy, Power, Torques};
use crate::dual::Dual;
use gyroflex::model::{Fidelity, RobotSpec, TransmissionSpec};
use gyroflex::spatial::Vec3;
use nalgebra::{DMatrix, DVector};

/// The equations of motion of a robot with flexible links in one of the four models.
///
/// States are those of the core: modal coordinates follow those of the joints.
#[derive(Clone, Copy, Debug)]
pub struct FlexibleOracle<'a> {
    pub(super) spec: RobotSpec<'a>,
    pub(super) links: &'a [BendingLink],
    pub(super) seats: &'a [Seats],
    pub(super) fidelity: Fidelity,
}

impl<'a> FlexibleOracle<'a> {
    /// The oracle of a valid description: links in the order of their bodies, seats one a body.
    pub fn new(spec: RobotSpec<'a>, links: &'a [BendingLink], seats: &'a [Seats], fidelity: Fidelity) -> Self {
        Self { spec, links, seats, fidelity }
    }

    /// Number of the joints' positions.
    pub fn nq(&self) -> usize {
        self.spec.bodies.iter().map(|b| b.joint.nq()).sum()
    }

    /// Number of the joints' velocities.
    pub fn nv(&self) -> usize {
        self.spec.bodies.iter().map(|b| b.joint.nv()).sum()
    }

    /// Number of modal coordinates.
    pub fn modes(&self) -> usize {
        self.links.iter().map(BendingLink::modes).sum()
    }

    /// Accelerations under motor torques, external forces and the forces of the state.
    pub fn forward(&self, s: &State) -> Accelerations {
        let (size, rotors, p) = (self.nv() + self.modes(), self.rotors(), self.projection());
        let e = equations(self, &self.x(s), &self.u(s));
        let outer = self.outer_forces(s);
        let mut forces = DVector::zeros(size + rotors.len());
        forces.rows_mut(0, size).copy_from(&outer);
        for (i, tau) in s.tau.iter().enumerate() {
            forces[i] += tau;
        }
        for ((k, d), friction) in rotors.iter().enumerate().zip(self.motor_friction(s)) {
            forces[d.joint] -= s.tau[d.joint];
            forces[size + k] += s.tau[d.joint] - friction;
            if self.is_elastic(d) {
                let (tau_j, passed) = self.dense().transmission(d, &self.of_joints(s));
                forces[d.joint] += tau_j;
                forces[size + k] -= passed * tau_j;
            }
        }
        let mass = p.transpose() * &e.mass * &p;
        let right = p.transpose() * (&forces - &e.bias);
        let accelerations = &p * dense::solve_scaled(&mass, &right);

        // What the joints' own rows need, a rigid gear delivers.
        let needed = &e.mass * &accelerations + &e.bias;
        let mut tau_j = s.tau.clone();
        let mut thetadd: Vec<f64> = accelerations.iter().copied().take(size).collect();
        for (k, d) in rotors.iter().enumerate() {
            thetadd[d.joint] = accelerations[size + k];
            tau_j[d.joint] = if self.is_elastic(d) {
                self.dense().transmission(d, &self.of_joints(s)).0
            } else {
                needed[d.joint] - outer[d.joint]
            };
        }
        Accelerations { qdd: accelerations.iter().copied().take(size).collect(), thetadd, tau_j }
    }

    /// Torques and modal forces that make the accelerations of the state happen.
    pub fn inverse(&self, s: &State) -> Torques {
        let (size, rotors) = (self.nv() + self.modes(), self.rotors());
        let e = equations(self, &self.x(s), &self.u(s));
        let needed = e.mass * self.all(&s.qdd, &s.thetadd) + e.bias;
        let outer = self.outer_forces(s);
        let tau_j: Vec<f64> = (0..size).map(|i| needed[i] - outer[i]).collect();
        let mut tau = tau_j.clone();
        for ((k, d), friction) in rotors.iter().enumerate().zip(self.motor_friction(s)) {
            let passed = if self.is_elastic(d) { self.dense().transmission(d, &self.of_joints(s)).1 } else { 1.0 };
            tau[d.joint] = passed * tau_j[d.joint] + needed[size + k] + friction;
        }
        Torques { tau_j, tau }
    }

    /// The inertia matrix of joints and modes, elastic rotors at rest in what carries them and rigidly geared ones turning along; and
    /// what couples elastic rotors to it, columns at their joints, zero elsewhere.
    pub fn matrices(&self, s: &State) -> [DMatrix<f64>; 2] {
        let (size, p) = (self.nv() + self.modes(), self.projection());
        let mass = p.transpose() * mass_matrix(self, &self.x(s), size + self.rotors().len()) * p;
        let mut coupling = DMatrix::zeros(size, size);
        for (k, d) in self.elastic_rotors().enumerate() {
            coupling.column_mut(d.joint).copy_from(&mass.view((0, size + k), (size, 1)));
        }
        [mass.view((0, 0), (size, size)).into_owned(), coupling]
    }

    /// Energies at a state; the elastic one is that of transmissions and bent links.
    pub fn energy(&self, s: &State) -> Energy {
        let x = self.x(s);
        let springs: f64 = self.elastic_rotors().map(|d| self.dense().spring_energy(&d, &self.of_joints(s))).sum();
        Energy {
            kinetic: kinetic(self, &x, &self.u(s)),
            gravity: self.gravity_energy(&x),
            elastic: springs + self.bending_energy(&x),
        }
    }

    /// Power of the motor torques, modal forces and external loads of a state, and what friction and damping take.
    pub fn power(&self, s: &State) -> Power {
        let size = self.nv() + self.modes();
        let u = self.u(s);
        let mut rates: Vec<f64> = s.qd.clone();
        let link_friction = self.dense().link_friction(&self.of_joints(s));
        let mut dissipation: f64 = link_friction.iter().zip(&s.qd).map(|(f, v)| f * v).sum();
        dissipation -= self.modal_damping(s).dot(&u.rows(0, size));
        for ((k, d), friction) in self.rotors().iter().enumerate().zip(self.motor_friction(s)) {
            rates[d.joint] = u[size + k];
            dissipation += friction * u[size + k];
        }
        for d in self.elastic_rotors() {
            if let TransmissionSpec::Elastic { damping, .. } = &d.spec.transmission {
                dissipation += damping * self.dense().deflection(&d, &self.of_joints(s)).1.powi(2);
            }
        }
        let motors: f64 = s.tau.iter().zip(&rates).map(|(t, v)| t * v).sum();
        Power { input: motors + self.external(s).dot(&u.rows(0, size)), dissipation }
    }

    /// External, frictional and damping forces on joints and modes.
    fn outer_forces(&self, s: &State) -> DVector<f64> {
        let mut out = self.external(s) + self.modal_damping(s);
        for (i, f) in self.dense().link_friction(&self.of_joints(s)).into_iter().enumerate() {
            out[i] -= f;
        }
        out
    }

    /// `tau_ext`, and the virtual work of the wrenches, which act on the frames that joints move.
    fn external(&self, s: &State) -> DVector<f64> {
        let (size, drives) = (self.nv() + self.modes(), self.rotors().len());
        let mut out = DVector::zeros(size);
        for (i, f) in s.tau_ext.iter().enumerate() {
            out[i] += f;
        }
        if s.wrenches.is_empty() {
            return out;
        }
        for i in 0..size {
            let x = along(self, &self.x(s), &unit(size + drives, i));
            let placed: Placed<'_, Dual> = self.placed(&x);
            for (at, w) in placed.links.iter().zip(&s.wrenches) {
                // Σ a_k × ȧ_k = 2 ω of orthonormal axes.
                let value = |v: Vec3<Dual>| v.map(|x| x.value);
                let slope = |v: Vec3<Dual>| v.map(|x| x.slope);
                let twice = at.axes.iter().fold(Vec3::zero(), |sum, a| sum + value(*a).cross(slope(*a)));
                let [a, b, c] = at.axes.map(value);
                let out_of = |v: &[f64]| a * v[0] + b * v[1] + c * v[2];
                out[i] += 0.5 * out_of(&w[..3]).dot(twice) + out_of(&w[3..]).dot(slope(at.origin));
            }
        }
        out
    }

    /// `−D η̇`.
    fn modal_damping(&self, s: &State) -> DVector<f64> {
        let nv = self.nv();
        let mut out = DVector::zeros(nv + self.modes());
        for (link, first) in self.links_and_modes() {
            let rates = DVector::from_column_slice(&s.qd[nv + first..nv + first + link.modes()]);
            out.rows_mut(nv + first, link.modes()).copy_from(&(-&link.damping * rates));
        }
        out
    }

    fn motor_friction(&self, s: &State) -> Vec<f64> {
        self.dense().motor_friction(&self.of_joints(s))
    }

    /// The oracle of the robot that does not bend, for the scalar laws of its drives.
    fn dense(&self) -> dense::Oracle<'a> {
        dense::Oracle::new(self.spec, self.fidelity)
    }

    fn rotors(&self) -> Vec<DriveAt<'a>> {
        self.dense().drives()
    }

    fn elastic_rotors(&self) -> impl Iterator<Item = DriveAt<'a>> {
        self.rotors().into_iter().filter(|d| self.is_elastic(d))
    }

    fn is_elastic(&self, d: &DriveAt<'_>) -> bool {
        d.free >= self.nv()
    }

    /// The joints' part of a state.
    pub fn of_joints(&self, s: &State) -> State {
        let (nq, nv) = (self.nq(), self.nv());
        let part = |x: &[f64]| x.get(..nv).unwrap_or(&[]).to_vec();
        State {
            q: s.q[..nq].to_vec(),
            qd: part(&s.qd),
            theta: part(&s.theta),
            thetad: part(&s.thetad),
            qdd: part(&s.qdd),
            thetadd: part(&s.thetadd),
            tau: part(&s.tau),
            tau_ext: part(&s.tau_ext),
            wrenches: s.wrenches.clone(),
        }
    }

    /// `x`: positions of joints and modes, then one reflected motor position per drive, that of the joint behind a rigid gear.
    pub(super) fn x(&self, s: &State) -> Vec<f64> {
        let first = self.nq() - self.nv();
        let motor = |d: &DriveAt<'_>| if self.is_elastic(d) { s.theta[d.joint] } else { s.q[first + d.joint] };
        s.q.iter().copied().chain(self.rotors().iter().map(motor)).collect()
    }

    fn u(&self, s: &State) -> DVector<f64> {
        self.all(&s.qd, &s.thetad)
    }

    /// Rates of joints and modes, then of the motors.
    fn all(&self, joints: &[f64], motors: &[f64]) -> DVector<f64> {
        let motor = |d: &DriveAt<'_>| if self.is_elastic(d) { motors[d.joint] } else { joints[d.joint] };
        DVector::from_vec(joints.iter().copied().chain(self.rotors().iter().map(motor)).collect())
    }

    /// From the free velocities, joints, modes and elastic motors, to all of them.
    fn projection(&self) -> DMatrix<f64> {
        let (size, rotors) = (self.nv() + self.modes(), self.rotors());
        let mut p = DMatrix::zeros(size + rotors.len(), size + self.elastic_rotors().count());
        for i in 0..size {
            p[(i, i)] = 1.0;
        }
        let mut next = size;
        for (k, d) in rotors.iter().enumerate() {
            if self.is_elastic(d) {
                p[(size + k, next)] = 1.0;
                next += 1;
            } else {
                p[(size + k, d.joint)] = 1.0;
            }
        }
        p
    }
}
