//! Controllers: reference and measured motor motion in, motor torques out, once a tick.

mod inverse;
mod linearization;
mod lqr;
mod walking;

use crate::contact::Event;
use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::equilibrium::Equilibrium;
use crate::error::Error;
use crate::load::yaml::Keys;
use crate::reference::{Point, References};
use crate::robot::{OwnedModel, Robot};
use crate::scenario::{Controller, Gains, RigidModel, fault};
use gyroflex::control::{ComputedTorque, Joints, Motors, Pd};
use gyroflex::dynamics::{External, RneaScratch, State};
use gyroflex::model::Fidelity;
use gyroflex::spatial::Vec3;
use inverse::Feedforward;
use linearization::Linearization;
use lqr::Lqr;
use nalgebra::{DMatrix, DVector};
pub use walking::Walking;

/// A controller and what it remembers.
#[derive(Clone, Debug)]
pub struct Control {
    law: Law,
    joints: Coordinates,
    kp: Vec<f64>,
    kd: Vec<f64>,
    limits: Vec<Option<f64>>,
    ticks: u64,
    saturated: Vec<u64>,
    peak: Vec<f64>,
    equilibrium: Equilibrium,
    q: Vec<f64>,
    qdd: Vec<f64>,
    reference: Vec<f64>,
    reference_rate: Vec<f64>,
    theta: Vec<f64>,
    feed_forward: Vec<f64>,
    unused: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Law {
    None,
    Pd { gravity_compensation: bool },
    ComputedTorque { rigid: Box<OwnedModel>, scratch: Vec<RneaScratch<f64>> },
    TwoDegreeOfFreedom(Box<Feedforward>),
    Lqr(Box<Lqr>),
    FeedbackLinearization(Box<Linearization>),
    Walk(Box<Walking>),
}

/// An instant of control: what is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Tick<'a> {
    /// The time [s].
    pub t: f64,
    /// What the joints are to follow.
    pub references: &'a References,
    /// The same at this instant, one entry per joint.
    pub points: &'a [Point],
}

impl Control {
    /// The controller a scenario asks for, which ends at time `end` [s].
    ///
    /// # Errors
    /// Gains for unknown joints or none for known ones, a robot that the law cannot drive, and references that are not smooth
    /// enough for it.
    pub fn new(
        spec: &Controller,
        robot: &Robot,
        joints: &Coordinates,
        references: &References,
        end: f64,
        keys: &Keys,
    ) -> Result<Self, Error> {
        let n = joints.len();
        if !matches!(spec, Controller::None {} | Controller::Pd { .. } | Controller::ComputedTorque { .. }) {
            robot.refuse_bending(
                &format!("the controller `{}`", spec.name()),
                "use `pd` or `computed_torque`, or take the link out of `flexible_links`",
            )?;
        }
        let (law, kp, kd) = match spec {
            Controller::None {} => (Law::None, vec![0.0; n], vec![0.0; n]),
            Controller::Pd { kp, kd, gravity_compensation, .. } => {
                let law = Law::Pd { gravity_compensation: *gravity_compensation };
                (law, gains(kp, joints, keys, "controller.kp")?, gains(kd, joints, keys, "controller.kd")?)
            }
            Controller::ComputedTorque { kp, kd, model, .. } => {
                if joints.floating {
                    let problem = "computed torque cannot drive a floating root, which has no motor";
                    return Err(fault(keys, "controller.type", problem, "use `pd`, or fix the root"));
                }
                let fidelity = match model {
                    RigidModel::Rigid => Fidelity::Rigid,
                    RigidModel::RigidReflected => Fidelity::RigidReflected,
                };
                let scratch = vec![RneaScratch::new(); robot.bodies.len()];
                let law = Law::ComputedTorque { rigid: Box::new(robot.model(fidelity)?), scratch };
                (law, gains(kp, joints, keys, "controller.kp")?, gains(kd, joints, keys, "controller.kd")?)
            }
            Controller::TwoDegreeOfFreedom { rate, kp, kd, inverse } => {
                let feedforward = Feedforward::new(inverse, *rate, robot, joints, references, keys)?;
                let law = Law::TwoDegreeOfFreedom(Box::new(feedforward));
                (law, gains(kp, joints, keys, "controller.kp")?, gains(kd, joints, keys, "controller.kd")?)
            }
            Controller::Lqr { rate, deviations, inverse } => {
                let feedforward = Feedforward::new(inverse, *rate, robot, joints, references, keys)?;
                let law = Lqr::new(feedforward, deviations, *rate, robot, joints, (references, end), keys)?;
                (Law::Lqr(Box::new(law)), vec![0.0; n], vec![0.0; n])
            }
            Controller::FeedbackLinearization { bandwidth, .. } => {
                let bandwidth = gains(bandwidth, joints, keys, "controller.bandwidth")?;
                let law = Linearization::new(robot, joints, bandwidth, keys)?;
                law.check(references, joints, keys)?;
                (Law::FeedbackLinearization(Box::new(law)), vec![0.0; n], vec![0.0; n])
            }
            Controller::Walk(walk) => {
                (Law::Walk(Box::new(Walking::new(walk, robot, keys)?)), vec![0.0; n], vec![0.0; n])
            }
        };
        let (nq, nv) = (joints.nq(), joints.nv());
        Ok(Self {
            law,
            kp,
            kd,
            limits: joints.joints.iter().map(|j| robot.joints[j.body].max_torque).collect(),
            ticks: 0,
            saturated: vec![0; n],
            peak: vec![0.0; n],
            equilibrium: Equilibrium::new(nv),
            q: vec![0.0; nq],
            qdd: vec![0.0; nv],
            reference: vec![0.0; nv],
            reference_rate: vec![0.0; nv],
            theta: vec![0.0; nv],
            feed_forward: vec![0.0; nv],
            unused: vec![0.0; nv],
            joints: joints.clone(),
        })
    }

    /// Goes to time 0. Where the law knows how the motors move there, it says so.
    ///
    /// # Errors
    /// An inverse that is not finite.
    pub fn start(&mut self, references: &References) -> Result<Option<Motors<'_, f64>>, Error> {
        let feedforward = match &mut self.law {
            Law::TwoDegreeOfFreedom(feedforward) => feedforward,
            Law::Lqr(law) => &mut law.feedforward,
            _ => return Ok(None),
        };
        feedforward.start(references)?;
        Ok(Some(feedforward.motors()))
    }

    /// Motor torques `tau` (`nv` entries, reflected) for the reference and the state, limited to what the drives can give.
    /// Of the state the controller reads the motor positions and velocities, and the pose of a floating root; a regulator and feedback linearization
    /// read all.
    ///
    /// # Errors
    /// A slice that does not fit the model, or torques that are not finite.
    pub fn tick(&mut self, dynamics: &mut Dynamics, at: Tick, state: State<f64>, tau: &mut [f64]) -> Result<(), Error> {
        tau.fill(0.0);
        if let Law::Pd { .. } | Law::ComputedTorque { .. } = self.law {
            self.hold_reference(dynamics, at.points, state)?;
        }
        let measured = Motors { theta: state.theta, thetad: state.thetad };
        match &mut self.law {
            // The walk needs to know of its feet: see `walk`.
            Law::None | Law::Walk(_) => return Ok(()),
            Law::Pd { gravity_compensation } => {
                for (i, (joint, point)) in self.joints.joints.iter().zip(at.points).enumerate() {
                    let k = joint.v;
                    let (target, feed) =
                        if *gravity_compensation { (self.theta[k], self.feed_forward[k]) } else { (point.q, 0.0) };
                    tau[k] = feed + self.kp[i] * (target - state.theta[k]) + self.kd[i] * (point.qd - state.thetad[k]);
                }
            }
            Law::ComputedTorque { rigid, scratch } => {
                for (joint, point) in self.joints.joints.iter().zip(at.points) {
                    let k = joint.v;
                    // Where the link would be if the transmission gave as it does at rest.
                    self.q[joint.q] = state.theta[k] - (self.theta[k] - point.q);
                    (self.reference[k], self.reference_rate[k], self.qdd[k]) = (point.q, point.qd, point.qdd);
                }
                let law = ComputedTorque { kp: &self.kp, kd: &self.kd };
                // The law knows links that do not bend.
                let n = self.joints.len();
                let desired = Joints { q: &self.reference[..n], qd: &self.reference_rate[..n] };
                let now = Joints { q: &self.q[..n], qd: &state.thetad[..n] };
                let (qdd, unused) = (&mut self.qdd[..n], &mut self.unused[..n]);
                law.torque(&rigid.view(), desired, now, qdd, scratch, unused, &mut tau[..n])?;
            }
            Law::TwoDegreeOfFreedom(feedforward) => {
                feedforward.tick(at.references, at.t)?;
                tau.copy_from_slice(feedforward.tau());
                Pd { kp: &self.kp, kd: &self.kd }.add(feedforward.motors(), measured, tau)?;
            }
            Law::Lqr(law) => law.tick(at.references, at.t, state, tau)?,
            Law::FeedbackLinearization(law) => law.tick(at.references, at.t, state, tau)?,
        }
        self.limit(tau);
        Ok(())
    }

    /// The walk, where that is the law.
    pub fn walking(&mut self) -> Option<&mut Walking> {
        match &mut self.law {
            Law::Walk(walking) => Some(walking),
            _ => None,
        }
    }

    /// A tick of a walk, which hears of its feet: motor torques, and the couple that it asks of the ground, with the body that feels it; `None`
    /// if the law is another.
    ///
    /// # Errors
    /// A biped that has fallen.
    pub fn walk(
        &mut self,
        t: f64,
        events: &[Event],
        state: State<f64>,
        tau: &mut [f64],
    ) -> Result<Option<(usize, Vec3<f64>)>, Error> {
        let Some(walking) = self.walking() else { return Ok(None) };
        walking.hear(events);
        let couple = walking.tick(t, state, tau)?;
        self.limit(tau);
        Ok(Some(couple))
    }

    /// Static motor positions and torques at the reference, links that bend deflected as they hang there, into `theta` and
    /// `feed_forward`.
    fn hold_reference(&mut self, dynamics: &mut Dynamics, reference: &[Point], state: State<f64>) -> Result<(), Error> {
        if self.joints.floating {
            self.q[..7].copy_from_slice(&state.q[..7]);
        }
        for (joint, point) in self.joints.joints.iter().zip(reference) {
            self.q[joint.q] = point.q;
        }
        let joints = self.q.len() - self.joints.modes.len();
        self.q[joints..].fill(0.0);
        dynamics.settle(&mut self.q, External::none())?;
        self.equilibrium.solve(dynamics, &self.q, External::none(), &mut self.theta, &mut self.feed_forward)?;
        self.feed_forward[self.joints.nv() - self.joints.modes.len()..].fill(0.0);
        Ok(())
    }

    fn limit(&mut self, tau: &mut [f64]) {
        self.ticks += 1;
        for (i, joint) in self.joints.joints.iter().enumerate() {
            let asked = &mut tau[joint.v];
            if let Some(limit) = self.limits[i]
                && asked.abs() > limit
            {
                *asked = limit.copysign(*asked);
                self.saturated[i] += 1;
            }
            self.peak[i] = self.peak[i].max(asked.abs());
        }
    }

    /// Forgets all ticks so far.
    pub fn reset(&mut self) {
        if let Some(walking) = self.walking() {
            walking.reset();
        }
        self.ticks = 0;
        self.saturated.fill(0);
        self.peak.fill(0.0);
    }

    /// Number of ticks so far.
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    /// For each joint, at how many ticks the torque asked for was beyond what the drive can give.
    pub fn saturated(&self) -> &[u64] {
        &self.saturated
    }

    /// For each joint, the largest motor torque so far, reflected [N m or N].
    pub fn peak_torque(&self) -> &[f64] {
        &self.peak
    }

    /// Torque per velocity of `joints` (by place), a row and a column each, where `inertia` is that of the robot over them.
    pub(crate) fn velocity_feedback(&self, joints: &[usize], inertia: &DMatrix<f64>) -> DMatrix<f64> {
        let gains = DMatrix::from_diagonal(&DVector::from_iterator(joints.len(), joints.iter().map(|i| self.kd[*i])));
        match self.law {
            Law::ComputedTorque { .. } => inertia * gains,
            _ => gains,
        }
    }

    /// Velocity gain over inertia as a motor sees it [1/s], `inertia` (one entry per joint) the reflected inertia; zero without
    /// a controller. A sampled loop is unstable once this exceeds twice its rate.
    pub fn damping_rate(&self, joint: usize, inertia: f64) -> f64 {
        match self.law {
            Law::None | Law::Lqr(_) | Law::FeedbackLinearization(_) | Law::Walk(_) => 0.0,
            Law::Pd { .. } | Law::TwoDegreeOfFreedom(_) => self.kd[joint] / inertia,
            Law::ComputedTorque { .. } => self.kd[joint],
        }
    }
}

/// One gain per joint.
fn gains(spec: &Gains, joints: &Coordinates, keys: &Keys, key: &str) -> Result<Vec<f64>, Error> {
    let map = match spec {
        Gains::All(gain) => return Ok(vec![*gain; joints.len()]),
        Gains::Named(map) => map,
    };
    let mut out = vec![map.get("default").copied(); joints.len()];
    for (name, gain) in map.iter().filter(|(name, _)| *name != "default") {
        out[joints.find(name, keys, &format!("{key}.{name}"))?] = Some(*gain);
    }
    let missing = |i: usize| {
        let problem = format!("there is no gain for joint `{}`", joints.joints[i].name);
        fault(keys, key, problem, "add it, or a `default` for all joints not named")
    };
    out.into_iter().enumerate().map(|(i, gain)| gain.ok_or_else(|| missing(i))).collect()
}
