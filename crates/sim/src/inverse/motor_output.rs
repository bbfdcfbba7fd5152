//! The inverse for a redefined output: the motors follow, and the links swing behind them.
//!
//! Thümmel, Otter & Bals (2005, §2) take "other outputs that are similar to the original" where an inverse cannot be used. Here it is the motor's
//! position. It is led to where it rests when the links rest at the reference,
//!
//! `θ_d = q_ref + δ_s + e(θ_d)`,   `k(δ_s) = g(q_ref)`,
//!
//! two derivatives with it, exact, from `rnea` and Newton's method on series in time. The links are the internal dynamics,
//!
//! `M q̈ + S θ̈_d + C + g + f_l = k(δ) + D δ̇`,   `δ = θ_d − q − e(θ_d)`,
//!
//! stable where the links are with their motors held ([`InverseOutput::Motor`](crate::zeros::InverseOutput)). Two derivatives of the references are
//! enough for any transmission; links reach the reference where it comes to rest, and only come near it on the way. Joints without an elastic
//! transmission are where their references are.

use super::along::{check_smoothness, refuse_floating_root};
use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::equilibrium::motor_position;
use crate::error::{Error, ErrorKind};
use crate::load::yaml::Keys;
use crate::reference::References;
use crate::robot::OwnedModel;
use gyroflex::dynamics::{Acceleration, External, Inverse, RneaScratch, State, rnea};
use gyroflex::model::{Drive, Knot};
use gyroflex::{Jet, Scalar};
use nalgebra::{Cholesky, DMatrix, DVector};

/// Derivatives of the references that the torques depend on.
pub const DERIVATIVES: u8 = 2;

/// A position with two derivatives.
type Series = Jet<f64, 3>;

/// Newton's steps on a series whose value is known: each doubles how many of its coefficients are.
const NEWTON_STEPS: usize = 2;
/// Longest substep, as part of the time constant of the fastest motion of the links [–]: the Runge-Kutta scheme is stable up to 2.7.
const LONGEST_SUBSTEP: f64 = 0.5;
/// Most substeps of a step.
const MOST_SUBSTEPS: f64 = 1e5;
/// Where in the substep the slopes of the classical Runge-Kutta scheme are taken, and what they weigh [–].
const STAGES: [(f64, f64); 4] = [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

/// The inverse of a robot on a fixed base whose motors are given.
#[derive(Clone, Debug)]
pub struct MotorOutput {
    dynamics: Dynamics,
    joints: Coordinates,
    /// The joints with an elastic transmission, by place in `joints`.
    elastic: Vec<usize>,
    /// The state: positions, then velocities of the links of those joints.
    links: DVector<f64>,
    /// Its slope at a stage, and the weighted sum of slopes.
    slope: DVector<f64>,
    sum: DVector<f64>,
    /// What was found last, and what is being worked on.
    found: Found,
    work: Found,
    series: [Vec<Series>; 4],
    series_scratch: Vec<RneaScratch<Series>>,
    matrix: Vec<f64>,
    inertia: DMatrix<f64>,
    qdd: DVector<f64>,
    unit: DVector<f64>,
    row: [f64; 3],
}

/// Links, motors and torques at one instant: `nv` entries each.
#[derive(Clone, Debug)]
struct Found {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    theta: Vec<f64>,
    thetad: Vec<f64>,
    thetadd: Vec<f64>,
    tau_j: Vec<f64>,
    tau: Vec<f64>,
}

impl Found {
    fn new(nv: usize) -> Self {
        let [q, qd, qdd, theta, thetad, thetadd, tau_j, tau] = [(); 8].map(|()| vec![0.0; nv]);
        Self { q, qd, qdd, theta, thetad, thetadd, tau_j, tau }
    }

    /// `τ_J` of the links and `τ` of the motors that move so.
    fn torques(&mut self, dynamics: &mut Dynamics) -> Result<(), Error> {
        let state = State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad };
        let accel = Acceleration { qdd: &self.qdd, thetadd: &self.thetadd };
        dynamics.inverse(state, accel, External::none(), Inverse { tau_j: &mut self.tau_j, tau: &mut self.tau })
    }
}

impl MotorOutput {
    /// Takes a model on a fixed base, for references with two derivatives.
    ///
    /// # Errors
    /// A floating root, and references with fewer derivatives, joint by joint.
    pub fn new(model: OwnedModel, joints: &Coordinates, references: &References, keys: &Keys) -> Result<Self, Error> {
        refuse_floating_root(joints, keys)?;
        let remedy = "use `filtered_step` with `order: 2`, `polynomial`, `spline` or `sines`";
        check_smoothness(joints, references, keys, |_| DERIVATIVES, remedy)?;
        let dynamics = Dynamics::new(model);
        let bodies = dynamics.model().bodies();
        let elastic = (0..joints.len()).filter(|i| bodies[joints.joints[*i].body].is_elastic());
        let elastic: Vec<usize> = elastic.collect();
        let (nv, n, count) = (dynamics.nv(), elastic.len(), bodies.len());
        Ok(Self {
            joints: joints.clone(),
            links: DVector::zeros(2 * n),
            slope: DVector::zeros(2 * n),
            sum: DVector::zeros(2 * n),
            found: Found::new(nv),
            work: Found::new(nv),
            series: [(); 4].map(|()| vec![Series::zero(); nv]),
            series_scratch: vec![RneaScratch::new(); count],
            matrix: vec![0.0; nv * nv],
            inertia: DMatrix::zeros(n, n),
            qdd: DVector::zeros(n),
            unit: DVector::zeros(n),
            row: [0.0; 3],
            elastic,
            dynamics,
        })
    }

    /// Goes to time 0: links where the motors hold them at rest, at the velocities of the references.
    ///
    /// # Errors
    /// As [`MotorOutput::at`].
    pub fn start(&mut self, references: &References) -> Result<(), Error> {
        let n = self.elastic.len();
        for (place, i) in self.elastic.iter().enumerate() {
            references.derivatives(*i, 0.0, &mut self.row);
            (self.links[place], self.links[n + place]) = (self.row[0], self.row[1]);
        }
        self.at(references, 0.0)
    }

    /// Finds motors and torques at time `t` [s], with the links where the last [`MotorOutput::advance`] left them.
    ///
    /// # Errors
    /// Links without inertia, and torques that are not finite.
    pub fn at(&mut self, references: &References, t: f64) -> Result<(), Error> {
        self.slope.fill(0.0);
        self.lead(references, t)?;
        self.swing(0.0)?;
        for (place, i) in self.elastic.iter().enumerate() {
            self.work.qdd[self.joints.joints[*i].v] = self.qdd[place];
        }
        self.work.torques(&mut self.dynamics)?;
        let wrong = self.joints.joints.iter().find(|j| !(self.work.tau[j.v] + self.work.theta[j.v]).is_finite());
        if let Some(joint) = wrong {
            let remedy = "check the references, and whether the links are stable with their motors held";
            let problem = "the inverse leaves the finite numbers";
            return Err(fault(ErrorKind::Diverged, &joint.name, problem, remedy));
        }
        std::mem::swap(&mut self.found, &mut self.work);
        Ok(())
    }

    /// Moves the links from time `t` on by `step` [s]; what was found last stays.
    ///
    /// # Errors
    /// Links without inertia, and links that are too stiff for the step.
    pub fn advance(&mut self, references: &References, t: f64, step: f64) -> Result<(), Error> {
        if self.elastic.is_empty() {
            return Ok(());
        }
        self.slope.fill(0.0);
        self.lead(references, t)?;
        let rate = self.swing(0.0)?;
        let count = (step * rate / LONGEST_SUBSTEP).ceil().max(1.0);
        if count.is_nan() || count > MOST_SUBSTEPS {
            let joint = &self.joints.joints[self.elastic[0]].name;
            let problem =
                format!("the links behind the motors move with {rate:.1e} 1/s, too fast for steps of {step} s");
            let remedy =
                "check inertias, stiffness, damping and the `smoothing_velocity` of friction, or make the joint rigid";
            return Err(fault(ErrorKind::Diverged, joint, &problem, remedy));
        }
        for i in 0..count as u32 {
            self.substep(references, t + f64::from(i) / count * step, step / count)?;
        }
        Ok(())
    }

    fn substep(&mut self, references: &References, t: f64, h: f64) -> Result<(), Error> {
        let n = self.elastic.len();
        self.sum.fill(0.0);
        self.slope.fill(0.0);
        let mut led = None;
        for (part, weight) in STAGES {
            if led != Some(part) {
                self.lead(references, t + part * h)?;
                led = Some(part);
            }
            self.swing(part * h)?;
            for (place, i) in self.elastic.iter().enumerate() {
                self.slope[place] = self.work.qd[self.joints.joints[*i].v];
                self.slope[n + place] = self.qdd[place];
            }
            self.sum.axpy(weight, &self.slope, 1.0);
        }
        self.links.axpy(h, &self.sum, 1.0);
        Ok(())
    }

    /// Motors, and links that are not behind an elastic transmission, at time `t`.
    fn lead(&mut self, references: &References, t: f64) -> Result<(), Error> {
        let Self { work, series: [q, rest, torque, on_motor], .. } = self;
        for (i, joint) in self.joints.joints.iter().enumerate() {
            references.derivatives(i, t, &mut self.row);
            q[joint.v] = Series::from_derivatives(&self.row);
        }
        let model = self.dynamics.model();
        let state = State { q: q.as_slice(), qd: rest, theta: rest, thetad: rest };
        let accel = Acceleration { qdd: rest.as_slice(), thetadd: rest };
        let out = Inverse { tau_j: torque, tau: on_motor };
        rnea(&model, state, accel, External::none(), &mut self.series_scratch, out)?;
        for joint in &self.joints.joints {
            let k = joint.v;
            let drive = model.bodies().get(joint.body).and_then(|b| b.drive.as_ref());
            let theta = drive.map_or(q[k], |drive| motor(drive, model.knots(), q[k], torque[k]));
            let [now, first, second] = [0, 1, 2].map(|order| q[k].derivative(order));
            (work.q[k], work.qd[k], work.qdd[k]) = (now, first, second);
            let [now, first, second] = [0, 1, 2].map(|order| theta.derivative(order));
            (work.theta[k], work.thetad[k], work.thetadd[k]) = (now, first, second);
        }
        Ok(())
    }

    /// Accelerations of the links `along` the slope from their state [s], into `qdd`; no motion of theirs is faster than what is returned [1/s].
    fn swing(&mut self, along: f64) -> Result<f64, Error> {
        let Self { work, dynamics, elastic, joints, qdd, unit, .. } = self;
        let n = elastic.len();
        if n == 0 {
            return Ok(0.0);
        }
        for (place, i) in elastic.iter().enumerate() {
            let k = joints.joints[*i].v;
            work.q[k] = along.mul_add(self.slope[place], self.links[place]);
            work.qd[k] = along.mul_add(self.slope[n + place], self.links[n + place]);
            work.qdd[k] = 0.0;
        }
        work.torques(dynamics)?;
        dynamics.mass_matrix(&work.q, &mut self.matrix)?;
        let nv = work.q.len();
        let v = |place: usize| joints.joints[elastic[place]].v;
        for i in 0..n {
            for j in 0..n {
                self.inertia[(i, j)] = self.matrix[v(i) * nv + v(j)];
            }
        }
        let inertia = std::mem::replace(&mut self.inertia, DMatrix::zeros(0, 0));
        let Some(inertia) = Cholesky::new(inertia) else {
            self.inertia = DMatrix::zeros(n, n);
            let remedy = "give the links that it moves a mass, or prescribe the link's position";
            let problem = "the links behind the motors have no inertia, or are no longer at finite positions";
            return Err(fault(ErrorKind::Diverged, &joints.joints[elastic[0]].name, problem, remedy));
        };
        // |s|² ≤ d |s| + c with the traces d of M⁻¹ (D + f_l') and c of M⁻¹ k', which bound the largest eigenvalues.
        let (mut c, mut d) = (0.0, 0.0);
        let model = dynamics.model();
        for (place, i) in elastic.iter().enumerate() {
            let joint = &joints.joints[*i];
            let (body, k) = (&model.bodies()[joint.body], joint.v);
            let Some((drive, elastic)) = body.drive.as_ref().and_then(|d| Some((d, d.elastic.as_ref()?))) else {
                continue;
            };
            let (error, share) =
                elastic.error.map_or((0.0, 0.0), |e| e.value_and_slope(work.theta[k], drive.rotor.gear_ratio));
            let deflection = work.theta[k] - error - work.q[k];
            let rate = (1.0 - share).mul_add(work.thetad[k], -work.qd[k]);
            let torque = elastic.damping.mul_add(rate, elastic.spring.torque(deflection, model.knots()));
            qdd[place] = torque - work.tau_j[k];
            unit.fill(0.0);
            unit[place] = 1.0;
            inertia.solve_mut(unit);
            c += unit[place] * elastic.spring.slope(deflection, model.knots());
            d += unit[place] * (elastic.damping + body.friction.slope(0.0));
        }
        inertia.solve_mut(qdd);
        self.inertia = inertia.unpack_dirty();
        Ok(0.5 * (d + d.mul_add(d, 4.0 * c).sqrt()))
    }

    /// Positions of the links at the last instant: `nq` entries.
    pub fn q(&self) -> &[f64] {
        &self.found.q
    }

    /// Their velocities: `nv` entries.
    pub fn qd(&self) -> &[f64] {
        &self.found.qd
    }

    /// Their accelerations: `nv` entries.
    pub fn qdd(&self) -> &[f64] {
        &self.found.qdd
    }

    /// Reflected motor positions there: `nv` entries.
    pub fn theta(&self) -> &[f64] {
        &self.found.theta
    }

    /// Their velocities: `nv` entries.
    pub fn thetad(&self) -> &[f64] {
        &self.found.thetad
    }

    /// Their accelerations: `nv` entries.
    pub fn thetadd(&self) -> &[f64] {
        &self.found.thetadd
    }

    /// Motor torques there, reflected: `nv` entries [N m or N].
    pub fn tau(&self) -> &[f64] {
        &self.found.tau
    }
}

/// Where the motor rests when its transmission carries `torque` on a joint at `q`, as a series like the two.
fn motor(drive: &Drive<f64>, knots: &[Knot<f64>], q: Series, torque: Series) -> Series {
    let Some(elastic) = &drive.elastic else { return q };
    let (theta, _) = motor_position(drive, knots, q.value(), torque.value());
    let (mut theta, ratio) = (Series::constant(theta), Series::constant(drive.rotor.gear_ratio));
    for _ in 0..NEWTON_STEPS {
        let zero = Series::zero();
        let (error, share) = elastic.error.map_or((zero, zero), |e| e.value_and_slope(theta, ratio));
        let deflection = theta - q - error;
        let slope = elastic.spring.slope(deflection, knots) * (Series::one() - share);
        theta -= (elastic.spring.torque(deflection, knots) - torque) / slope;
    }
    theta
}

fn fault(kind: ErrorKind, joint: &str, problem: &str, remedy: &str) -> Error {
    Error {
        kind,
        file: String::new(),
        element: format!("joint `{joint}`"),
        problem: problem.to_owned(),
        remedy: remedy.to_owned(),
    }
}
