//! The 1 kHz loop: measurement in, motor torques out.

use crate::arm::N;
use crate::observer::Observer;
use crate::reference::Target;
use crate::scratch::{Scratch, Torques, inverse};
use gyroflex::dynamics::{Acceleration, State};
use gyroflex::model::{Model, SizeError};

/// Time between two calls [s].
pub const PERIOD: f32 = 1e-3;
/// Natural frequency [rad/s] and damping ratio of a motor on the controller's spring.
const FREQUENCY: f32 = 50.0;
const DAMPING: f32 = 0.7;

/// What the encoders on both sides of the transmissions say.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    pub q: [f32; N],
    pub qd: [f32; N],
    pub theta: [f32; N],
    pub thetad: [f32; N],
}

impl Measured {
    pub fn state(&self) -> State<'_, f32> {
        State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad }
    }
}

/// Inverse dynamics of where the arm should be, a spring and a damper on the motors, and the observer.
#[derive(Clone, Debug)]
pub struct Controller<'a> {
    model: &'a Model<'a, f32>,
    pub observer: Observer,
    /// `1/K`: how far a transmission gives way [rad/(N m)].
    compliance: [f32; N],
    kp: [f32; N],
    kd: [f32; N],
    /// Where the motors should have been a period ago.
    theta: [f32; N],
    torques: Torques,
    scratch: Scratch,
}

impl<'a> Controller<'a> {
    /// For an arm at rest with its motors at `theta`.
    pub fn new(model: &'a Model<'a, f32>, theta: [f32; N]) -> Self {
        let (mut compliance, mut kp, mut kd) = ([0.0; N], [0.0; N], [0.0; N]);
        for (i, body) in model.bodies().iter().enumerate().take(N) {
            let Some(drive) = &body.drive else { continue };
            let b = drive.rotor.reflected_inertia;
            kp[i] = b * FREQUENCY * FREQUENCY;
            kd[i] = 2.0 * DAMPING * b * FREQUENCY;
            compliance[i] = drive.elastic.as_ref().map_or(0.0, |e| 1.0 / e.spring.stiffness);
        }
        let (observer, torques, scratch) = (Observer::new(), Torques::default(), Scratch::new());
        Self { model, observer, compliance, kp, kd, theta, torques, scratch }
    }

    /// One period.
    pub fn step(&mut self, target: &Target, measured: &Measured) -> Result<[f32; N], SizeError> {
        // The motors lead the links by the deflection that the asked motion needs.
        let state = State { q: &target.q, qd: &target.qd, theta: &self.theta, thetad: &target.qd };
        let accel = Acceleration { qdd: &target.qdd, thetadd: &target.qdd };
        inverse(self.model, state, accel, &[], &mut self.scratch, &mut self.torques)?;
        let theta: [f32; N] = core::array::from_fn(|i| target.q[i] + self.torques.tau_j[i] * self.compliance[i]);
        let thetad: [f32; N] = core::array::from_fn(|i| (theta[i] - self.theta[i]) / PERIOD);
        self.theta = theta;

        let tau = core::array::from_fn(|i| {
            self.torques.tau[i]
                + self.kp[i] * (theta[i] - measured.theta[i])
                + self.kd[i] * (thetad[i] - measured.thetad[i])
        });
        self.observer.observe(self.model, measured, &tau, &mut self.scratch)?;
        Ok(tau)
    }
}
