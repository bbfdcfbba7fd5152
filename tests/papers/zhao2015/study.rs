//! The comparison of Zhao, Yu, Wang, Tomizuka, *Complete dynamic modelling of flexible joint robots*, DSCC 2015, section EXAMPLE:
//! a six-joint arm simulated twice, with the rotors' gyroscopics and without, under the same motor reference, feedforward and PD.

use gyroflex::dynamics::{Acceleration, External, Inverse, State};
use gyroflex::model::{Fidelity, Friction, SpringSpec, TransmissionSpec};
use gyroflex::spatial::{Transform, Vec3};
use gyroflex_sim::analyze::significance;
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::reference::Trajectory;
use gyroflex_sim::simulate::StateVec;
use gyroflex_sim::{Dynamics, Error, Robot};
use std::f64::consts::TAU;
use std::path::Path;

/// Joints.
const N: usize = 6;
/// Step of the integration, and of the controller [s].
const STEP: f64 = 1e-4;
/// Steps between two points of a record.
const EVERY: usize = 20;
/// Spacing of the differences in the feedforward [s].
const SPACING: f64 = 2e-3;
/// The reference's amplitudes `A` [–], frequencies `ω/2π` at pace 1 [Hz] and offsets [rad]; the paper gives none.
const AMPLITUDE: [f64; N] = [0.3; N];
const FREQUENCY: [f64; N] = [0.7, 0.5, 0.8, 1.5, 1.3, 1.7];
const OFFSET: [f64; N] = [-1.0, 0.2, -2.8, -0.5, -0.3, 0.0];
/// Gains of the PD on the reflected motor positions [N m/rad, N m s/rad], those of the robot's scenario `track.yaml`.
const KP: [f64; N] = [8000.0, 12000.0, 4000.0, 1000.0, 800.0, 800.0];
const KD: [f64; N] = [120.0, 240.0, 70.0, 20.0, 16.0, 17.0];

/// What is varied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Factor on all gear ratios.
    pub gears: f64,
    /// Factor on the masses and inertias of all links.
    pub links: f64,
    /// Factor on the frequencies of the reference.
    pub pace: f64,
    /// Simulated time [s].
    pub duration: f64,
}

impl Default for Conditions {
    fn default() -> Self {
        Self { gears: 1.0, links: 1.0, pace: 1.0, duration: 5.0 }
    }
}

/// Both simulations, instant by instant.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// Times [s].
    pub time: Vec<f64>,
    /// Distance of the tool from its reference [m]: the complete simulator's and the reduced one's.
    pub error: [Vec<f64>; 2],
    /// `r_s` of the complete simulator (eq. 12).
    pub ratio: Vec<f64>,
    /// Largest joint speed of the reference [rad/s].
    pub speed: f64,
}

impl Comparison {
    /// Largest distance of simulator `i` [m].
    pub fn max(&self, i: usize) -> f64 {
        self.error[i].iter().copied().fold(0.0, f64::max)
    }

    /// Root mean square of the distances of simulator `i` [m].
    pub fn rms(&self, i: usize) -> f64 {
        (self.error[i].iter().map(|e| e * e).sum::<f64>() / self.error[i].len() as f64).sqrt()
    }

    /// Largest `|r_s|`.
    pub fn largest_ratio(&self) -> f64 {
        self.ratio.iter().fold(0.0, |m, r| m.max(r.abs()))
    }
}

/// Simulates both.
///
/// # Errors
/// A robot that is not physical under these conditions.
pub fn compare(conditions: Conditions) -> Result<Comparison, Error> {
    let robot = robot(conditions)?;
    let mut plan = Plan::new(&robot, conditions.pace)?;
    let mut out = Comparison::default();
    for (i, fidelity) in [Fidelity::Complete, Fidelity::Reduced].into_iter().enumerate() {
        let mut dynamics = Dynamics::new(robot.model(fidelity)?);
        let start = plan.at(0.0)?;
        let mut state = StateVec { q: start.q, qd: start.qd, theta: start.theta, thetad: start.thetad };
        let steps = (conditions.duration / STEP).round() as usize;
        for k in 0..=steps {
            let t = k as f64 * STEP;
            let wanted = plan.at(t)?;
            if k % EVERY == 0 {
                out.error[i].push(distance(tool(&robot, &dynamics, &state.q)?, tool(&robot, &dynamics, &wanted.q)?));
                out.speed = wanted.qd.iter().fold(out.speed, |m, v| m.max(v.abs()));
                if i == 0 {
                    out.time.push(t);
                    out.ratio.push(significance(&mut dynamics, &state.q, Some(&state.qd))?.r_s.unwrap_or(0.0));
                }
            }
            // The torque is held over the step: its feedforward is that of the step's middle.
            let mut tau = plan.at(t + 0.5 * STEP)?.tau;
            for j in 0..N {
                tau[j] += KP[j] * (wanted.theta[j] - state.theta[j]) + KD[j] * (wanted.thetad[j] - state.thetad[j]);
            }
            dynamics.rk4(state.view_mut(), &tau, External::none(), STEP)?;
        }
    }
    Ok(out)
}

/// The PUMA 560 without friction, of which the paper says nothing, under the conditions.
fn robot(conditions: Conditions) -> Result<Robot, Error> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/puma560/robot.yaml");
    let mut robot = load(&file, &LoadOptions::default())?;
    for body in &mut robot.bodies {
        body.inertia = body.inertia.map(|x| conditions.links * x);
        body.friction = Friction::none();
        if let Some(drive) = &mut body.drive {
            drive.friction = Friction::none();
            drive.gear_ratio *= conditions.gears;
        }
    }
    Ok(robot)
}

/// Where the tool is [m].
fn tool(robot: &Robot, dynamics: &Dynamics, q: &[f64]) -> Result<Vec3<f64>, Error> {
    let mut poses = vec![Transform::identity(); robot.bodies.len()];
    dynamics.placements(q, &mut poses)?;
    let link = robot.links.iter().find(|l| l.name == "tool").expect("the robot has a tool");
    let body = link.body.expect("the tool moves");
    Ok(link.placement.after(poses[body]).pos)
}

fn distance(a: Vec3<f64>, b: Vec3<f64>) -> f64 {
    let d = a - b;
    d.dot(d).sqrt()
}

/// One instant of the reference: the links', the motors', and the feedforward.
struct Wanted {
    q: Vec<f64>,
    qd: Vec<f64>,
    theta: Vec<f64>,
    thetad: Vec<f64>,
    tau: Vec<f64>,
}

/// The reference trajectory and the inverse of the reduced model.
struct Plan {
    reduced: Dynamics,
    trajectories: Vec<Trajectory>,
    /// `K` and `D` of every joint.
    springs: Vec<[f64; 2]>,
}

impl Plan {
    fn new(robot: &Robot, pace: f64) -> Result<Self, Error> {
        let spring = |drive: &gyroflex::model::DriveSpec| match drive.transmission {
            TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, damping, .. } => {
                [stiffness, damping]
            }
            _ => unreachable!("all transmissions of this robot are linear"),
        };
        let zhao = |j: usize| {
            let (offset, amplitude, omega) = (OFFSET[j], AMPLITUDE[j], TAU * FREQUENCY[j] * pace);
            Trajectory::Zhao { offset, amplitude, omega }
        };
        Ok(Self {
            reduced: Dynamics::new(robot.model(Fidelity::Reduced)?),
            trajectories: (0..N).map(zhao).collect(),
            springs: robot.bodies.iter().filter_map(|b| b.drive.as_ref()).map(spring).collect(),
        })
    }

    /// What the links do at `t`, and the inverse dynamics of the reduced model (eq. 11) with motor accelerations `thetadd`:
    /// `q, qd, qdd`, `τ_J` and the motor torques.
    fn inverse(&mut self, t: f64, thetadd: &[f64]) -> Result<[Vec<f64>; 5], Error> {
        let points: Vec<_> = self.trajectories.iter().map(|r| r.at(t)).collect();
        let q: Vec<f64> = points.iter().map(|p| p.q).collect();
        let qd: Vec<f64> = points.iter().map(|p| p.qd).collect();
        let qdd: Vec<f64> = points.iter().map(|p| p.qdd).collect();
        let (mut tau_j, mut tau) = (vec![0.0; N], vec![0.0; N]);
        let state = State { q: &q, qd: &qd, theta: &q, thetad: &qd };
        let accel = Acceleration { qdd: &qdd, thetadd };
        self.reduced.inverse(state, accel, External::none(), Inverse { tau_j: &mut tau_j, tau: &mut tau })?;
        Ok([q, qd, qdd, tau_j, tau])
    }

    /// The motor reference and the feedforward of eq. 11b. The reduced model's `K δ + D δ̇ = τ_J` is solved for the slow motion,
    /// `δ = Σ (−D/K)ⁱ τ_J⁽ⁱ⁾ / K`, with derivatives of `τ_J` from differences.
    fn at(&mut self, t: f64) -> Result<Wanted, Error> {
        let rest = [0.0; N];
        let mut around = Vec::with_capacity(5);
        for k in -2..=2 {
            around.push(self.inverse(t + SPACING * f64::from(k), &rest)?);
        }
        let [q, qd, qdd, ..] = around[2].clone();
        let (mut theta, mut thetad, mut thetadd) = (q.clone(), qd.clone(), qdd);
        for j in 0..N {
            let f: [f64; 5] = std::array::from_fn(|k| around[k][3][j]);
            let derivatives = differences(f);
            let [stiffness, damping] = self.springs[j];
            let deflection = |order: usize| -> f64 {
                let term = |(i, d): (usize, &f64)| (-damping / stiffness).powi(i as i32) * d / stiffness;
                derivatives[order..].iter().enumerate().map(term).sum()
            };
            theta[j] += deflection(0);
            thetad[j] += deflection(1);
            thetadd[j] += deflection(2);
        }
        let tau = self.inverse(t, &thetadd)?[4].clone();
        Ok(Wanted { q, qd, theta, thetad, tau })
    }
}

/// Value and four derivatives in the middle of five points, `SPACING` apart.
fn differences([a, b, c, d, e]: [f64; 5]) -> [f64; 5] {
    let h = SPACING;
    [
        c,
        (a - 8.0 * b + 8.0 * d - e) / (12.0 * h),
        (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / (12.0 * h * h),
        (-a + 2.0 * b - 2.0 * d + e) / (2.0 * h * h * h),
        (a - 4.0 * b + 6.0 * c - 4.0 * d + e) / (h * h * h * h),
    ]
}
