//! The laws that the project's tests hold every robot to, in single precision on the chip.
//!
//! Each gives the relative error at one state; its bound is the one the same law has in the tests for `f32`.

use crate::arm::N;
use crate::elastic::Elastic;
use crate::held::Held;
use crate::random::Point;
use crate::scratch::{Accelerations, Scratch, Torques, forward, inverse, mass_matrix};
use gyroflex::dynamics::{
    Acceleration, Axes, External, Forward, Frame, JointSpaceScratch, State, coupling, energy, forward_in_joint_space,
    jacobian, placements, power, reflected_inertia, velocities,
};
use gyroflex::model::{Model, SizeError};
use gyroflex::spatial::{Motion, Transform, Vec3};

/// A law: its error at one state of a model, to be at most `bound`.
pub struct Law {
    pub name: &'static str,
    pub bound: f32,
    pub error: fn(&Model<f32>, &Point, &mut Scratch) -> Result<f32, SizeError>,
}

/// All of them.
pub const LAWS: [Law; 7] = [
    Law { name: "inverse of forward dynamics", bound: 1e-3, error: inverse_of_forward },
    Law { name: "forward of inverse dynamics", bound: 1e-3, error: forward_of_inverse },
    Law { name: "articulated and joint-space routes", bound: 1e-3, error: two_routes },
    Law { name: "columns of M", bound: 1e-4, error: columns_of_m },
    Law { name: "columns of S and B", bound: 1e-4, error: columns_of_s },
    Law { name: "Jacobian and velocities", bound: 1e-4, error: jacobian_is_velocity },
    Law { name: "energy rate is power", bound: 1e-2, error: energy_rate },
];

type V = [f32; N];

fn inverse_of_forward(model: &Model<f32>, p: &Point, scratch: &mut Scratch) -> Result<f32, SizeError> {
    let (mut moved, mut back) = (Accelerations::default(), Torques::default());
    forward(model, p.state(), &p.tau, &[], scratch, &mut moved)?;
    let accel = Acceleration { qdd: &moved.qdd, thetadd: &moved.thetadd };
    inverse(model, p.state(), accel, &[], scratch, &mut back)?;
    let size = moving(model, p, &moved, scratch)?;
    let tau_j = difference(&back.tau_j, &moved.tau_j) / norm(&moved.tau_j).max(size);
    Ok(tau_j.max(difference(&back.tau, &p.tau) / norm(&p.tau).max(size)))
}

/// The torques that accelerate links and rotors, which the loads are a remainder of.
fn moving(model: &Model<f32>, p: &Point, a: &Accelerations, scratch: &mut Scratch) -> Result<f32, SizeError> {
    let (mut m, mut b) = ([[0.0; N]; N], [0.0; N]);
    mass_matrix(model, &p.q, scratch, &mut m)?;
    reflected_inertia(model, &mut b)?;
    let links = m.iter().map(|row| row.iter().zip(&a.qdd).fold(0.0, |sum, (m, qdd)| sum + (m * qdd).abs()));
    let rotors = b.iter().zip(&a.thetadd).map(|(b, thetadd)| (b * thetadd).abs());
    Ok(links.chain(rotors).fold(0.0, f32::max))
}

/// What the asked motion needs beyond the torque of the deflections is made an external load.
fn forward_of_inverse(model: &Model<f32>, p: &Point, scratch: &mut Scratch) -> Result<f32, SizeError> {
    let (mut moved, mut needed, mut b) = (Accelerations::default(), Torques::default(), [0.0; N]);
    forward(model, p.state(), &p.tau, &[], scratch, &mut moved)?;
    inverse(model, p.state(), p.acceleration(), &[], scratch, &mut needed)?;
    let load: V = core::array::from_fn(|i| match model.bodies()[i].is_elastic() {
        true => needed.tau_j[i] - moved.tau_j[i],
        false => 0.0,
    });
    inverse(model, p.state(), p.acceleration(), &load, scratch, &mut needed)?;
    forward(model, p.state(), &needed.tau, &load, scratch, &mut moved)?;
    // A light rotor's acceleration is a small difference of torques over a small inertia: compare what it takes.
    reflected_inertia(model, &mut b)?;
    let rotors: V = core::array::from_fn(|i| b[i] * (moved.thetadd[i] - p.thetadd[i]));
    let asked: V = core::array::from_fn(|i| b[i] * p.thetadd[i]);
    let qdd = difference(&moved.qdd, &p.qdd) / norm(&p.qdd);
    Ok(qdd.max(norm(&rotors) / norm(&asked).max(norm(&needed.tau))))
}

fn two_routes(model: &Model<f32>, p: &Point, scratch: &mut Scratch) -> Result<f32, SizeError> {
    let (mut a, mut b) = (Accelerations::default(), Accelerations::default());
    forward(model, p.state(), &p.tau, &[], scratch, &mut a)?;
    let mut bodies = [JointSpaceScratch::new(); N];
    let mut matrix = [0.0; N * N];
    let out = Forward { qdd: &mut b.qdd, thetadd: &mut b.thetadd, tau_j: &mut b.tau_j };
    forward_in_joint_space(model, p.state(), &p.tau, External::none(), &mut bodies, &mut matrix, out)?;
    let relative = |a: &V, b: &V| difference(a, b) / norm(b);
    Ok(relative(&a.qdd, &b.qdd).max(relative(&a.thetadd, &b.thetadd)))
}

/// Inverse dynamics at rest, without gravity, of a unit acceleration.
fn unit_motion(
    model: &Model<f32>,
    p: &Point,
    qdd: &V,
    thetadd: &V,
    scratch: &mut Scratch,
) -> Result<Torques, SizeError> {
    let still = model.with_gravity(Vec3::new(0.0, 0.0, 0.0));
    let state = State { q: &p.q, qd: &[0.0; N], theta: &p.q, thetad: &[0.0; N] };
    let mut torques = Torques::default();
    inverse(&still, state, Acceleration { qdd, thetadd }, &[], scratch, &mut torques)?;
    Ok(torques)
}

fn unit(k: usize) -> V {
    core::array::from_fn(|i| if i == k { 1.0 } else { 0.0 })
}

/// A rigid gear's row is the motor's, an elastic transmission's what it passes to the link.
fn columns_of_m(model: &Model<f32>, p: &Point, scratch: &mut Scratch) -> Result<f32, SizeError> {
    let (mut m, mut worst) = ([[0.0; N]; N], 0.0_f32);
    mass_matrix(model, &p.q, scratch, &mut m)?;
    let size = norm(m.as_flattened());
    for k in 0..N {
        let torques = unit_motion(model, p, &unit(k), &[0.0; N], scratch)?;
        for (i, body) in model.bodies().iter().enumerate() {
            let row = if body.is_elastic() { torques.tau_j[i] } else { torques.tau[i] };
            worst = worse(worst, (row - m[i][k]).abs() / size);
        }
    }
    Ok(worst)
}

/// A motor's unit acceleration: `S` on the links, `B` on itself. Zero, all of it, where no transmission is elastic.
fn columns_of_s(model: &Model<f32>, p: &Point, scratch: &mut Scratch) -> Result<f32, SizeError> {
    let (mut s, mut b, mut worst) = ([[0.0; N]; N], [0.0; N], 0.0_f32);
    coupling(model, &p.q, &mut scratch.crba, s.as_flattened_mut())?;
    reflected_inertia(model, &mut b)?;
    let (links, motors) = (norm(s.as_flattened()).max(f32::MIN_POSITIVE), norm(&b).max(f32::MIN_POSITIVE));
    for k in 0..N {
        let torques = unit_motion(model, p, &[0.0; N], &unit(k), scratch)?;
        for i in 0..N {
            let own = if i == k { b[k] } else { 0.0 };
            let motor = torques.tau[i] - torques.tau_j[i];
            worst = worse(worst, (torques.tau_j[i] - s[i][k]).abs() / links);
            worst = worse(worst, (motor - own).abs() / motors);
        }
    }
    Ok(worst)
}

fn jacobian_is_velocity(model: &Model<f32>, p: &Point, _: &mut Scratch) -> Result<f32, SizeError> {
    let mut poses = [Transform::identity(); N];
    let mut twists = [Motion::zero(); N];
    let mut j = [[0.0; N]; 6];
    placements(model, &p.q, &mut poses)?;
    velocities(model, &p.q, &p.qd, &mut twists)?;
    let tip = Frame { body: N - 1, placement: Transform::identity() };
    jacobian(model, &poses, tip, Axes::Local, j.as_flattened_mut())?;
    let want = twists[N - 1].to_array();
    let got = j.map(|row| row.iter().zip(&p.qd).fold(0.0, |sum, (j, qd)| sum + j * qd));
    Ok(difference(&got, &want) / norm(&want))
}

/// `dE/dt` along the accelerations, by a seven-point difference, is `supplied − dissipated`.
fn energy_rate(model: &Model<f32>, p: &Point, scratch: &mut Scratch) -> Result<f32, SizeError> {
    let mut a = Accelerations::default();
    forward(model, p.state(), &p.tau, &[], scratch, &mut a)?;
    let mut poses = [(Transform::identity(), Motion::zero()); N];
    // A geared motor turns with its joint.
    let elastic = model.bodies().iter().any(|b| b.is_elastic());
    let thetadd = if elastic { &a.thetadd } else { &a.qdd };
    let mut at = |h: f32| {
        let moved = |x: &V, v: &V| -> V { core::array::from_fn(|i| x[i] + h * v[i]) };
        let (q, qd) = (moved(&p.q, &p.qd), moved(&p.qd, &a.qdd));
        let (theta, thetad) = (moved(&p.theta, &p.thetad), moved(&p.thetad, thetadd));
        energy(model, State { q: &q, qd: &qd, theta: &theta, thetad: &thetad }, &mut poses)
    };
    // Long enough for differences of numbers with seven digits, well inside the period of the fastest mode.
    let h = 3e-4;
    let mut rate = 0.0;
    for (k, weight) in [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)] {
        let (after, before) = (at(k * h)?, at(-k * h)?);
        let parts =
            (after.kinetic - before.kinetic) + (after.gravity - before.gravity) + (after.elastic - before.elastic);
        rate += weight * parts / (60.0 * h);
    }
    let e = at(0.0)?;
    let power = power(model, p.state(), &p.tau, External::none(), &mut poses)?;
    let size = power.supplied.abs() + power.dissipated + e.kinetic + e.elastic + e.gravity.abs() + 100.0;
    Ok((rate - (power.supplied - power.dissipated)).abs() / size)
}

/// Torques of the elastic inverse against those of inverse dynamics, the motors moving as the former says.
pub fn elastic_inverse_is_rnea(
    model: &Model<f32>,
    p: &Point,
    scratch: &mut Scratch,
    elastic: &mut Elastic,
) -> Option<f32> {
    elastic.invert(model, p).ok()?;
    let [theta, thetad, thetadd] = &elastic.theta;
    let state = State { q: &p.q, qd: &p.derivatives[0], theta, thetad };
    let accel = Acceleration { qdd: &p.derivatives[1], thetadd };
    let mut torques = Torques::default();
    inverse(model, state, accel, &[], scratch, &mut torques).ok()?;
    let tau_j = difference(&elastic.tau_j, &torques.tau_j) / norm(&torques.tau_j);
    Some(worse(tau_j, difference(&elastic.tau, &torques.tau) / norm(&torques.tau)))
}

/// Accelerations of the arm with its tip held against those of the arm with the tip's force on its last link.
pub fn held_is_pushed(model: &Model<f32>, p: &Point, scratch: &mut Scratch, held: &mut Held) -> Option<f32> {
    held.accelerate(model, p).ok()?;
    let mut poses = [Transform::identity(); N];
    placements(model, &p.q, &mut poses).ok()?;
    let tip = Frame { body: N - 1, placement: Transform::identity() };
    let mut columns = [0.0; 6 * N];
    jacobian(model, &poses, tip, Axes::World, &mut columns).ok()?;
    let force = held.wrench[0].lin.to_array();
    let on_links: V = core::array::from_fn(|k| (0..3).map(|i| columns[(3 + i) * N + k] * force[i]).sum());
    let mut pushed = Accelerations::default();
    forward(model, p.state(), &p.tau, &on_links, scratch, &mut pushed).ok()?;
    Some(difference(&held.links, &pushed.qdd) / norm(&pushed.qdd))
}

/// Largest absolute entry; NaN if any is.
fn norm(v: &[f32]) -> f32 {
    v.iter().fold(0.0, |m, x| if x.is_nan() || m.is_nan() { f32::NAN } else { m.max(x.abs()) })
}

fn difference(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| worse(m, (a - b).abs()))
}

/// The larger of two errors; NaN if one is.
pub fn worse(a: f32, b: f32) -> f32 {
    if a.is_nan() || b.is_nan() { f32::NAN } else { a.max(b) }
}
