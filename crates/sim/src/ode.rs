//! Adaptive integration over one interval of held motor torques, with the schemes of the crate `differential-equations`.

use crate::dynamics::Dynamics;
use crate::loads::Loads;
use crate::scenario::Integrator;
use differential_equations::methods::{DiagonallyImplicitRungeKutta, ExplicitRungeKutta};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::status::Status;
use gyroflex::dynamics::{Forward, State};
use gyroflex::integrate::StateMut;
use std::cell::RefCell;
use std::ops::ControlFlow;

/// An adaptive scheme that remembers the step it came to.
///
/// The state vector is `q` (`nq` entries), the elastic motors' `theta`, `qd` (`nv` entries), the elastic motors' `thetad`. A
/// floating root's quaternion is integrated as four numbers and brought back to unit length.
#[derive(Clone, Debug)]
pub(crate) struct Adaptive {
    scheme: Integrator,
    /// Places of the elastic motors in `theta`.
    elastic: Vec<usize>,
    y: Vec<f64>,
    /// The step the error control would take next [s]; zero before the first.
    step: f64,
    buffers: Buffers,
}

/// Full-length vectors for one evaluation of the derivative.
#[derive(Clone, Debug)]
struct Buffers {
    q: Vec<f64>,
    qd: Vec<f64>,
    theta: Vec<f64>,
    thetad: Vec<f64>,
    q_rate: Vec<f64>,
    qdd: Vec<f64>,
    thetadd: Vec<f64>,
    tau_j: Vec<f64>,
}

/// Why an interval was not crossed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Halt {
    /// The scheme cannot go on from this time into the interval [s].
    Stuck { at: f64, why: &'static str },
    /// The caller asked to stop; the state is that of the interval's start.
    Stopped,
}

impl Adaptive {
    pub(crate) fn new(scheme: Integrator, dynamics: &Dynamics) -> Self {
        let (nq, nv) = (dynamics.nq(), dynamics.nv());
        let model = dynamics.model();
        let elastic: Vec<usize> = model.bodies().iter().filter(|b| b.is_elastic()).map(|b| b.v_index()).collect();
        let zeros = |n| vec![0.0; n];
        let buffers = Buffers {
            q: zeros(nq),
            qd: zeros(nv),
            theta: zeros(nv),
            thetad: zeros(nv),
            q_rate: zeros(nq),
            qdd: zeros(nv),
            thetadd: zeros(nv),
            tau_j: zeros(nv),
        };
        Self { scheme, y: zeros(nq + nv + 2 * elastic.len()), elastic, step: 0.0, buffers }
    }

    /// Moves the state over `length` seconds under held torques, and returns the number of steps. Now and then `go_on` is told
    /// the time into the interval [s] and may stop it.
    pub(crate) fn advance(
        &mut self,
        dynamics: &mut Dynamics,
        loads: &mut Loads,
        state: StateMut<f64>,
        tau: &[f64],
        length: f64,
        go_on: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<u64, Halt> {
        self.pack(&state);
        let step = if self.step > 0.0 { self.step.min(length) } else { 0.0 };
        let problem = Problem {
            elastic: &self.elastic,
            tau,
            inner: RefCell::new(Inner { dynamics: &mut *dynamics, loads, buffers: &mut self.buffers }),
        };
        let result = match self.scheme {
            Integrator::Dop853 { rtol, atol } => {
                let method = ExplicitRungeKutta::dop853().rtol(rtol).atol(atol).h0(step).max_steps(MAX_STEPS);
                cross(method, &problem, &mut self.y, length, step, go_on)
            }
            Integrator::Kvaerno5 { rtol, atol } => {
                let method = DiagonallyImplicitRungeKutta::kvaerno745().rtol(rtol).atol(atol).h0(step);
                let method =
                    method.newton_tol(newton_tolerance(atol)).h_min(0.0).max_steps(MAX_STEPS).max_rejects(MAX_STEPS);
                cross(method, &problem, &mut self.y, length, step, go_on)
            }
            Integrator::Dopri5 { rtol, atol } => {
                let method = ExplicitRungeKutta::dopri5().rtol(rtol).atol(atol).h0(step).max_steps(MAX_STEPS);
                cross(method, &problem, &mut self.y, length, step, go_on)
            }
            Integrator::SemiImplicitEuler { .. } | Integrator::Rk4 { .. } => {
                return Err(Halt::Stuck { at: 0.0, why: "the scheme has a fixed step" });
            }
        };
        let (steps, next) = result?;
        self.step = next;
        self.unpack(dynamics, state);
        Ok(steps)
    }

    fn pack(&mut self, state: &StateMut<f64>) {
        let motors = |of: &[f64]| self.elastic.iter().map(|&k| of[k]).collect::<Vec<_>>();
        let (theta, thetad) = (motors(state.theta), motors(state.thetad));
        let all = state.q.iter().chain(&theta).chain(state.qd.iter()).chain(&thetad);
        for (slot, x) in self.y.iter_mut().zip(all) {
            *slot = *x;
        }
    }

    fn unpack(&mut self, dynamics: &Dynamics, state: StateMut<f64>) {
        self.buffers.spread(&self.y, &self.elastic, dynamics);
        state.q.copy_from_slice(&self.buffers.q);
        state.qd.copy_from_slice(&self.buffers.qd);
        state.theta.copy_from_slice(&self.buffers.theta);
        state.thetad.copy_from_slice(&self.buffers.thetad);
    }
}

impl Buffers {
    /// The state vector in full length: quaternion of unit length, motors without a spring at their joints.
    fn spread(&mut self, y: &[f64], elastic: &[usize], dynamics: &Dynamics) {
        let (nq, nv, ne) = (self.q.len(), self.qd.len(), elastic.len());
        self.q.copy_from_slice(&y[..nq]);
        self.qd.copy_from_slice(&y[nq + ne..nq + ne + nv]);
        let model = dynamics.model();
        // The length of `q` is the model's, which is all that can be wrong here.
        let _ = dynamics.normalize(&mut self.q);
        for body in model.bodies().iter().filter(|b| b.joint.nv() == 1) {
            self.theta[body.v_index()] = self.q[body.q_index()];
            self.thetad[body.v_index()] = self.qd[body.v_index()];
        }
        // Motors of modes do not exist; their entries follow, as those of joints.
        self.theta[model.nv()..].copy_from_slice(&self.q[model.nq()..]);
        self.thetad[model.nv()..].copy_from_slice(&self.qd[model.nv()..]);
        for (i, &k) in elastic.iter().enumerate() {
            self.theta[k] = y[nq + i];
            self.thetad[k] = y[nq + ne + nv + i];
        }
    }
}

/// The robot as an ordinary differential equation. The library evaluates through a shared reference, hence the cell.
struct Problem<'a> {
    elastic: &'a [usize],
    tau: &'a [f64],
    inner: RefCell<Inner<'a>>,
}

struct Inner<'a> {
    dynamics: &'a mut Dynamics,
    loads: &'a mut Loads,
    buffers: &'a mut Buffers,
}

impl ODE<f64, Vec<f64>> for Problem<'_> {
    fn diff(&self, _t: f64, y: &Vec<f64>, rate: &mut Vec<f64>) {
        let inner = &mut *self.inner.borrow_mut();
        let b = &mut *inner.buffers;
        b.spread(y, self.elastic, inner.dynamics);
        let ok = inner.loads.update(inner.dynamics, &b.q).and_then(|()| {
            let state = State { q: &b.q, qd: &b.qd, theta: &b.theta, thetad: &b.thetad };
            let out = Forward { qdd: &mut b.qdd, thetadd: &mut b.thetadd, tau_j: &mut b.tau_j };
            inner.dynamics.forward(state, self.tau, inner.loads.external(), out)?;
            inner.dynamics.position_rate(&b.q, &b.qd, &mut b.q_rate)
        });
        if ok.is_err() {
            // Cannot happen with buffers of the model's own lengths; not a number stops the run with an error.
            rate.fill(f64::NAN);
            return;
        }
        let theta_rate = self.elastic.iter().map(|&k| &b.thetad[k]);
        let thetadd = self.elastic.iter().map(|&k| &b.thetadd[k]);
        for (slot, x) in rate.iter_mut().zip(b.q_rate.iter().chain(theta_rate).chain(&b.qdd).chain(thetadd)) {
            *slot = *x;
        }
    }
}

/// Crosses an interval, landing on its end; returns the number of steps and the step to take next.
fn cross<M: OrdinaryNumericalMethod<f64, Vec<f64>>>(
    mut method: M,
    problem: &Problem,
    y: &mut Vec<f64>,
    length: f64,
    step: f64,
    go_on: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<(u64, f64), Halt> {
    let stuck = |at, why| Err(Halt::Stuck { at, why });
    if y.iter().any(|x| !x.is_finite()) || method.init(problem, 0.0, length, y).is_err() {
        return stuck(0.0, "the state left the finite numbers");
    }
    let (mut steps, mut wanted) = (0, step);
    for attempt in 1..=2 * MAX_STEPS {
        if attempt % ATTEMPTS_BETWEEN_CALLS == 0 && go_on(method.t()).is_break() {
            return Err(Halt::Stopped);
        }
        let left = length - method.t();
        wanted = if method.h() < left { method.h() } else { wanted.max(method.h()) };
        if !method.h().is_finite() {
            return stuck(method.t(), "the state left the finite numbers");
        }
        if method.h() >= left {
            method.set_h(left);
        }
        if method.step(problem).is_err() {
            return stuck(method.t(), TOO_MANY);
        }
        if matches!(method.status(), Status::RejectedStep) {
            wanted = 0.0;
            continue;
        }
        steps += 1;
        if length - method.t() <= 1e-12 * length {
            y.clone_from(method.y());
            return Ok((steps, wanted.max(method.h())));
        }
    }
    stuck(method.t(), TOO_MANY)
}

/// Newton's iterations stop well below the error a step may make, and above what rounding lets them reach.
fn newton_tolerance(atol: f64) -> f64 {
    (0.1 * atol).max(1e-11)
}

/// Steps within one interval between ticks beyond which a scheme is taken to be stuck.
const MAX_STEPS: usize = 100_000;

/// Attempted steps after which the caller hears from a scheme.
const ATTEMPTS_BETWEEN_CALLS: usize = 16;

const TOO_MANY: &str = "the scheme cannot meet its tolerances in any reasonable number of steps";
