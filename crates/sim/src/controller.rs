//! Controllers: reference and measured motor motion in, motor torques out, once a tick.

use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::equilibrium::Equilibrium;
use crate::error::Error;
use crate::load::yaml::Keys;
use crate::reference::Point;
use crate::robot::Robot;
use crate::scenario::{Controller, Gains, RigidModel, fault};
use gyroflex::dynamics::{Acceleration, External, Inverse, State};
use gyroflex::model::Fidelity;

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
    theta: Vec<f64>,
    feed_forward: Vec<f64>,
    unused: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Law {
    None,
    Pd { gravity_compensation: bool },
    ComputedTorque { rigid: Box<Dynamics> },
}

impl Control {
    /// The controller a scenario asks for.
    ///
    /// # Errors
    /// Gains for unknown joints or none for known ones, and computed torque on a floating root.
    pub fn new(spec: &Controller, robot: &Robot, joints: &Coordinates, keys: &Keys) -> Result<Self, Error> {
        let n = joints.len();
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
                let law = Law::ComputedTorque { rigid: Box::new(Dynamics::new(robot.model(fidelity)?)) };
                (law, gains(kp, joints, keys, "controller.kp")?, gains(kd, joints, keys, "controller.kd")?)
            }
        };
        let root = if joints.floating { (7, 6) } else { (0, 0) };
        let (nq, nv) = (root.0 + n, root.1 + n);
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
            theta: vec![0.0; nv],
            feed_forward: vec![0.0; nv],
            unused: vec![0.0; nv],
            joints: joints.clone(),
        })
    }

    /// Motor torques `tau` (`nv` entries, reflected) for the reference and the state, limited to what the drives can give.
    /// `dynamics` is of the robot as the controller knows it. Of the state the controller reads the motor positions and velocities, and the pose of a floating root.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn tick(
        &mut self,
        dynamics: &mut Dynamics,
        reference: &[Point],
        state: State<f64>,
        tau: &mut [f64],
    ) -> Result<(), Error> {
        tau.fill(0.0);
        if let Law::None = self.law {
            return Ok(());
        }
        self.hold_reference(dynamics, reference, state)?;
        match &mut self.law {
            Law::None => {}
            Law::Pd { gravity_compensation } => {
                for (i, (joint, point)) in self.joints.joints.iter().zip(reference).enumerate() {
                    let k = joint.v;
                    let (target, feed) =
                        if *gravity_compensation { (self.theta[k], self.feed_forward[k]) } else { (point.q, 0.0) };
                    tau[k] = feed + self.kp[i] * (target - state.theta[k]) + self.kd[i] * (point.qd - state.thetad[k]);
                }
            }
            Law::ComputedTorque { rigid } => {
                for (i, (joint, point)) in self.joints.joints.iter().zip(reference).enumerate() {
                    let k = joint.v;
                    // Where the link would be if the transmission gave as it does at rest.
                    self.q[joint.q] = state.theta[k] - (self.theta[k] - point.q);
                    self.qdd[k] = point.qdd
                        + self.kp[i] * (point.q - self.q[joint.q])
                        + self.kd[i] * (point.qd - state.thetad[k]);
                }
                let measured = State { q: &self.q, qd: state.thetad, theta: &self.theta, thetad: state.thetad };
                let accel = Acceleration { qdd: &self.qdd, thetadd: &self.qdd };
                rigid.inverse(measured, accel, External::none(), Inverse { tau_j: &mut self.unused, tau })?;
            }
        }
        self.limit(tau);
        Ok(())
    }

    /// Static motor positions and torques at the reference, into `theta` and `feed_forward`.
    fn hold_reference(&mut self, dynamics: &mut Dynamics, reference: &[Point], state: State<f64>) -> Result<(), Error> {
        if self.joints.floating {
            self.q[..7].copy_from_slice(&state.q[..7]);
        }
        for (joint, point) in self.joints.joints.iter().zip(reference) {
            self.q[joint.q] = point.q;
        }
        self.equilibrium.solve(dynamics, &self.q, External::none(), &mut self.theta, &mut self.feed_forward)
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

    /// Velocity gain over inertia as a motor sees it [1/s], `inertia` (one entry per joint) the reflected inertia; zero without
    /// a controller. A sampled loop is unstable once this exceeds twice its rate.
    pub fn damping_rate(&self, joint: usize, inertia: f64) -> f64 {
        match self.law {
            Law::None => 0.0,
            Law::Pd { .. } => self.kd[joint] / inertia,
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
