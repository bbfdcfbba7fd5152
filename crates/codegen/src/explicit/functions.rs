//! The quantities of an explicit model as functions, for every language that there is.

use super::parts::{couplings, mass, motor_friction, resist, weights};
use super::signature::{Signature, signed};
use super::velocity::Slopes;
use super::{ExplicitModel, solve};
use crate::function::Function;
use crate::quantity::{Quantity, Unavailable};
use crate::sym::Sym;
use gyroflex::Scalar;

impl ExplicitModel {
    /// The function that computes a quantity by the explicit equations. Arguments are those of [`crate::quantity::function`]; torques of
    /// rigid gears are those of their motors, and forward dynamics gives accelerations alone.
    ///
    /// # Errors
    /// For a quantity that explicit equations do not say.
    pub fn function(&self, quantity: Quantity) -> Result<Function, Unavailable> {
        let elastic = self.is_elastic();
        match quantity {
            Quantity::Forward => {
                Ok(signed(self, "forward_dynamics", "Accelerations from state and motor torques.", forward))
            }
            Quantity::Inverse => {
                Ok(signed(self, "inverse_dynamics", "Torques that make the robot accelerate as asked.", inverse))
            }
            Quantity::MassMatrix => Ok(signed(self, "mass_matrix", "Inertia matrix of links and modes.", mass_matrix)),
            Quantity::Coupling if elastic => {
                Ok(signed(self, "coupling", "Inertial coupling of links, by rows, with motors.", coupling))
            }
            Quantity::Coriolis => Ok(signed(
                self,
                "coriolis_matrices",
                "Coriolis and centrifugal matrices in Christoffel form.",
                coriolis,
            )),
            Quantity::Gravity => Ok(signed(
                self,
                "gravity_torques",
                "Generalised forces that hold the robot at rest against gravity.",
                gravity,
            )),
            Quantity::Bias => Ok(signed(
                self,
                "bias_forces",
                "What links and motors need to go on without acceleration, besides friction, springs and dampers.",
                bias,
            )),
            Quantity::Energy => Ok(signed(self, "energy", "Energies of links, rotors and springs.", energy)),
            _ => Err(Unavailable {
                quantity,
                reason: "explicit equations do not say it".to_owned(),
                remedy: "generate it from the robot itself".to_owned(),
            }),
        }
    }
}

fn mass_matrix(s: &mut Signature) {
    let (model, n) = (s.model, s.model.nv());
    let q = s.positions();
    let mut composer = s.composer(&q);
    let m = mass(model, &mut composer);
    s.matrix("m", m, n, "inertia matrix, symmetric [kg m², kg m or kg]");
}

fn coupling(s: &mut Signature) {
    let (model, n) = (s.model, s.model.nv());
    let q = s.positions();
    let mut composer = s.composer(&q);
    let entries = model.coupling.iter().map(|sum| composer.compose(sum)).collect();
    s.matrix("s", entries, n, "coupling, zero columns where no joint is elastic [kg m²]");
}

fn gravity(s: &mut Signature) {
    let model = s.model;
    let q = s.positions();
    let mut composer = s.composer(&q);
    let g = weights(model, &mut composer);
    s.vector("g", g, "gravity torques [N m or N]");
}

fn coriolis(s: &mut Signature) {
    let (model, n) = (s.model, s.model.nv());
    let (q, qd) = (s.positions(), s.velocities());
    let thetad = s.of_motors("thetad", "motor velocities, reflected [rad/s or m/s]");
    let mut composer = s.composer(&q);
    let [c, c1, c2] = Slopes::of(model, &mut composer).matrices(&qd, &thetad);
    s.matrix("c", c, n, "links by links [kg m²/s]");
    if model.is_elastic() {
        s.matrix("c1", c1, n, "links by motors [kg m²/s]");
        s.matrix("c2", c2, n, "motors by links [kg m²/s]");
    }
}

fn bias(s: &mut Signature) {
    let model = s.model;
    let (q, qd) = (s.positions(), s.velocities());
    let thetad = s.of_motors("thetad", "motor velocities, reflected [rad/s or m/s]");
    let mut composer = s.composer(&q);
    let [mut link, motor] = Slopes::of(model, &mut composer).forces(&qd, &thetad);
    link.iter_mut().zip(weights(model, &mut composer)).for_each(|(f, g)| *f += g);
    s.vector("link", link, "on the link side, with gravity [N m or N]");
    if model.is_elastic() {
        s.vector("motor", motor, "on the motors, reflected [N m or N]");
    }
}

fn inverse(s: &mut Signature) {
    let (model, n) = (s.model, s.model.nv());
    let [q, qd, _, thetad] = s.state();
    let qdd = s.argument("qdd", n, "joint accelerations [rad/s² or m/s²]");
    let thetadd = s.of_motors("thetadd", "motor accelerations, reflected [rad/s² or m/s²]");
    let mut composer = s.composer(&q);
    let (m, coupling) = (mass(model, &mut composer), couplings(model, &mut composer));
    let [mut link, mut motor] = Slopes::of(model, &mut composer).forces(&qd, &thetad);
    for (i, g) in weights(model, &mut composer).into_iter().enumerate() {
        let of_links = (0..n).fold(g, |sum, j| sum + m[i * n + j] * qdd[j]);
        link[i] += (0..n).fold(of_links, |sum, j| sum + coupling[i * n + j] * thetadd[j]);
        motor[i] += (0..n).fold(Sym::zero(), |sum, j| sum + coupling[j * n + i] * qdd[j]);
    }
    resist(model, &mut composer, (&q, &qd), &mut link);
    let mut tau = link.clone();
    for (i, joint) in model.joints.iter().enumerate() {
        let Some(drive) = &joint.drive else { continue };
        let speed = if drive.transmission.is_some() { thetad[i] } else { qd[i] };
        tau[i] += motor_friction(&mut composer, drive, speed);
        if drive.transmission.is_some() {
            tau[i] += motor[i] + composer.compose(&drive.reflected_inertia) * thetadd[i];
        }
    }
    if model.is_elastic() {
        s.vector("tau_j", link, "torque on each joint, of elastic ones that of the transmission [N m or N]");
    }
    s.vector("tau", tau, "torque of each motor, reflected [N m or N]");
}

fn forward(s: &mut Signature) {
    let (model, n) = (s.model, s.model.nv());
    let [q, qd, theta, thetad] = s.state();
    let tau = s.argument("tau", n, "motor torques, reflected [N m or N]");
    let mut composer = s.composer(&q);
    let (mut m, coupling) = (mass(model, &mut composer), couplings(model, &mut composer));
    let [mut needed, needed_by_motor] = Slopes::of(model, &mut composer).forces(&qd, &thetad);
    needed.iter_mut().zip(weights(model, &mut composer)).for_each(|(f, g)| *f += g);
    resist(model, &mut composer, (&q, &qd), &mut needed);
    let mut right: Vec<Sym> = tau.iter().zip(&needed).map(|(tau, f)| *tau - *f).collect();
    // θ̈ = (ρ − Sᵀ q̈)/B is put into the equations of the links.
    let mut motors = Vec::new();
    for (i, joint) in model.joints.iter().enumerate() {
        let Some(drive) = &joint.drive else { continue };
        let Some(transmission) = &drive.transmission else {
            right[i] -= motor_friction(&mut composer, drive, qd[i]);
            continue;
        };
        let [k, k3, d] =
            [&transmission.stiffness, &transmission.cubic, &transmission.damping].map(|x| composer.compose(x));
        let (deflection, rate) = (theta[i] - q[i], thetad[i] - qd[i]);
        let tau_j = deflection * (k + k3 * deflection * deflection) + d * rate;
        right[i] = tau_j - needed[i];
        let rest = tau[i] - tau_j - motor_friction(&mut composer, drive, thetad[i]) - needed_by_motor[i];
        let inverse = Sym::one() / composer.compose(&drive.reflected_inertia);
        let column: Vec<Sym> = (0..n).map(|r| coupling[r * n + i]).collect();
        for r in 0..n {
            right[r] -= column[r] * (inverse * rest);
            for c in 0..n {
                m[r * n + c] -= column[r] * (inverse * column[c]);
            }
        }
        motors.push((i, rest, inverse, column));
    }
    let qdd = solve::solved(m, right);
    let mut thetadd = qdd.clone();
    for (i, rest, inverse, column) in motors {
        thetadd[i] = (0..n).fold(rest, |rest, r| rest - column[r] * qdd[r]) * inverse;
    }
    s.vector("qdd", qdd, "joint accelerations [rad/s² or m/s²]");
    if model.is_elastic() {
        s.vector("thetadd", thetadd, "motor accelerations, reflected [rad/s² or m/s²]");
    }
}

fn energy(s: &mut Signature) {
    let (model, n) = (s.model, s.model.nv());
    let [q, qd, theta, thetad] = s.state();
    let mut composer = s.composer(&q);
    let (m, coupling) = (mass(model, &mut composer), couplings(model, &mut composer));
    let half = Sym::from_f64(0.5);
    let (mut twice, mut elastic) = (Sym::zero(), Sym::zero());
    for i in 0..n {
        for j in 0..n {
            twice += m[i * n + j] * (qd[i] * qd[j]);
            twice += Sym::from_f64(2.0) * coupling[i * n + j] * (qd[i] * thetad[j]);
        }
        let Some(transmission) = model.transmission(i) else { continue };
        let [k, k3] = [&transmission.stiffness, &transmission.cubic].map(|x| composer.compose(x));
        let square = (theta[i] - q[i]) * (theta[i] - q[i]);
        elastic += half * square * (k + half * k3 * square);
        if let Some(b) = model.reflected_inertia(i) {
            twice += composer.compose(b) * (thetad[i] * thetad[i]);
        }
    }
    let (first, modes) = (model.joints.len(), model.modes());
    for j in 0..modes {
        for k in 0..modes {
            elastic += Sym::from_f64(0.5 * model.modal_stiffness(j, k)) * q[first + j] * q[first + k];
        }
    }
    let potential = composer.compose(&model.potential);
    s.vector("kinetic", vec![half * twice], "of links and rotors [J]");
    s.vector("gravity", vec![potential], "in the field of gravity, but for a constant [J]");
    s.vector("elastic", vec![elastic], "in the springs of transmissions and links, zero where unloaded [J]");
}
