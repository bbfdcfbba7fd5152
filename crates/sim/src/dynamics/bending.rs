//! Dynamics of robots whose links bend: storage of the core's algorithms, and what is made of them here.

use super::Dynamics;
use crate::error::{Error, ErrorKind};
use gyroflex::dynamics::{
    self, Acceleration, External, FlexibleBody, FlexibleMatrices, FlexibleMode, FlexiblePlacements, FlexibleScratch,
    FlexibleStation, Forward, Inverse, State,
};
use gyroflex::integrate::{self, StateMut};
use gyroflex::model::{FlexibleModel, JointKind, Model, SizeError};
use gyroflex::spatial::{Motion, Transform};
use gyroflex::{Jet, Scalar};
use nalgebra::{DMatrix, DVector};

/// A number with its derivative in one direction.
pub(crate) type Dual = Jet<f64, 2>;

/// Scratch of the algorithms of flexible links.
#[derive(Clone, Debug)]
pub(crate) struct Storage<T> {
    bodies: Vec<FlexibleBody<T>>,
    stations: Vec<FlexibleStation<T>>,
    modes: Vec<FlexibleMode<T>>,
    shapes: Vec<Motion<T>>,
    matrix: Vec<T>,
}

impl<T: Scalar> Storage<T> {
    pub(crate) fn new(model: &FlexibleModel<f64>) -> Self {
        Self {
            bodies: vec![FlexibleBody::new(); model.rigid().bodies().len()],
            stations: vec![FlexibleStation::new(); model.stations().len()],
            modes: vec![FlexibleMode::new(); model.modes()],
            shapes: vec![Motion::zero(); dynamics::flexible_shapes_len(model)],
            matrix: vec![T::zero(); dynamics::flexible_matrix_len(model)],
        }
    }

    pub(crate) fn lend(&mut self) -> FlexibleScratch<'_, T> {
        FlexibleScratch {
            bodies: &mut self.bodies,
            stations: &mut self.stations,
            modes: &mut self.modes,
            shapes: &mut self.shapes,
            matrix: &mut self.matrix,
        }
    }
}

/// A function of the core over positions and velocities of joints.
type OverJoints = fn(&Model<f64>, &[f64], &[f64], &mut [f64]) -> Result<(), SizeError>;

/// What a robot needs once its links bend.
#[derive(Clone, Debug)]
pub(super) struct Bending {
    pub(super) scratch: Storage<f64>,
    /// `nv × nv` numbers that nobody asked for.
    pub(super) unasked: Vec<f64>,
    /// Of the integrators.
    work: Vec<f64>,
    /// A state with its derivative, and what becomes of it.
    dual: DualState,
    dual_scratch: Storage<Dual>,
}

/// Vectors over all coordinates, with derivatives.
#[derive(Clone, Debug)]
struct DualState {
    q: Vec<Dual>,
    qd: Vec<Dual>,
    theta: Vec<Dual>,
    thetad: Vec<Dual>,
    tau: Vec<Dual>,
    out: [Vec<Dual>; 3],
}

/// What a direction of differentiation changes; one `nv`-th unit vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Direction {
    /// A position; of a floating root a small motion in its own frame.
    Q(usize),
    /// A velocity.
    Qd(usize),
    /// A motor position.
    Theta(usize),
    /// A motor velocity.
    Thetad(usize),
    /// A torque.
    Tau(usize),
}

impl Bending {
    pub(super) fn new(model: &FlexibleModel<f64>) -> Self {
        let (nq, nv) = (model.nq(), model.nv());
        let zeros = |n| vec![Dual::constant(0.0); n];
        Self {
            scratch: Storage::new(model),
            unasked: vec![0.0; nv * nv],
            work: vec![0.0; 3 * (nq + 3 * nv) + nv],
            dual: DualState {
                q: zeros(nq),
                qd: zeros(nv),
                theta: zeros(nv),
                thetad: zeros(nv),
                tau: zeros(nv),
                out: [zeros(nv), zeros(nv), zeros(nv)],
            },
            dual_scratch: Storage::new(model),
        }
    }
}

impl DualState {
    fn set(&mut self, state: State<f64>, tau: &[f64]) {
        let pairs = [
            (&mut self.q, state.q),
            (&mut self.qd, state.qd),
            (&mut self.theta, state.theta),
            (&mut self.thetad, state.thetad),
            (&mut self.tau, tau),
        ];
        for (slot, x) in pairs.into_iter().flat_map(|(slots, xs)| slots.iter_mut().zip(xs)) {
            *slot = Dual::constant(*x);
        }
    }

    fn view(&self) -> State<'_, Dual> {
        State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad }
    }
}

impl Dynamics {
    /// Number of modal coordinates: the last entries of every vector.
    pub fn modes(&self) -> usize {
        self.model.flexible().map_or(0, |model| model.modes())
    }

    /// Positions of the links' modes among `q`.
    pub fn eta<'a>(&self, q: &'a [f64]) -> &'a [f64] {
        &q[q.len().min(self.model().nq())..]
    }

    /// Torques that make the joints accelerate as asked while the links bend as they must, and the modes' accelerations; see
    /// [`dynamics::flexible_hybrid`]. A robot whose links do not bend has none.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn hybrid(
        &mut self,
        state: State<f64>,
        accel: Acceleration<f64>,
        ext: External<f64>,
        out: Inverse<f64>,
        etadd: &mut [f64],
    ) -> Result<(), Error> {
        match (self.model.flexible(), &mut self.bending) {
            (Some(model), Some(bending)) => {
                Ok(dynamics::flexible_hybrid(&model, state, accel, ext, bending.scratch.lend(), out, etadd)?)
            }
            _ => self.inverse(state, accel, ext, out),
        }
    }

    /// Stiffness and damping of the modes, `n × n` over all modes of the robot; blocks of a link.
    pub fn modal_matrices(&self) -> [DMatrix<f64>; 2] {
        let n = self.modes();
        let [mut stiffness, mut damping] = [(); 2].map(|()| DMatrix::zeros(n, n));
        let Some(model) = self.model.flexible() else { return [stiffness, damping] };
        for link in model.links() {
            let modes = link.mode_range();
            let pairs = &model.pairs()[link.pair_range()];
            for (i, pair) in pairs.iter().enumerate() {
                let at = (modes.start + i / link.n(), modes.start + i % link.n());
                (stiffness[at], damping[at]) = (pair.stiffness, pair.damping);
            }
        }
        [stiffness, damping]
    }

    /// Where links and stations are.
    pub(super) fn flexible_placements(
        model: &FlexibleModel<f64>,
        q: &[f64],
        out: &mut [Transform<f64>],
    ) -> Result<(), Error> {
        let mut stations = vec![Transform::identity(); model.stations().len()];
        let out = FlexiblePlacements { links: out, stations: &mut stations };
        Ok(dynamics::flexible_placements(model, q, Storage::new(model).lend(), out)?)
    }

    /// How forward dynamics changes in one direction: derivatives of `q̈`, `θ̈` and `τ_J`, `nv` entries each. Only for robots whose
    /// links bend.
    pub(crate) fn forward_slope(
        &mut self,
        state: State<f64>,
        tau: &[f64],
        direction: Direction,
        out: [&mut [f64]; 3],
    ) -> Result<(), Error> {
        let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) else { return Ok(()) };
        let dual = &mut bending.dual;
        dual.set(state, tau);
        dual.seed(&model, state.q, direction)?;
        let [mut qdd, mut thetadd, mut tau_j] = std::mem::take(&mut dual.out);
        let value = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        let done = dynamics::flexible_aba(
            &model,
            dual.view(),
            &dual.tau,
            External::none(),
            bending.dual_scratch.lend(),
            value,
        );
        for (out, found) in out.into_iter().zip([&qdd, &thetadd, &tau_j]) {
            out.iter_mut().zip(found).for_each(|(out, x)| *out = x.derivative(1));
        }
        dual.out = [qdd, thetadd, tau_j];
        Ok(done?)
    }

    /// How the inertia matrices `M` and `S` change in direction `k` of the positions, `nv × nv` by rows each. Only for robots whose links bend.
    pub(crate) fn inertia_slope(&mut self, q: &[f64], k: usize, out: [&mut [f64]; 2]) -> Result<(), Error> {
        let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) else { return Ok(()) };
        let nv = model.nv();
        let dual = &mut bending.dual;
        dual.q.iter_mut().zip(q).for_each(|(slot, x)| *slot = Dual::constant(*x));
        dual.seed(&model, q, Direction::Q(k))?;
        let [mut mass, mut coupling] = [(); 2].map(|()| vec![Dual::constant(0.0); nv * nv]);
        let value = FlexibleMatrices { mass: &mut mass, coupling: &mut coupling };
        dynamics::flexible_mass_matrix(&model, &dual.q, bending.dual_scratch.lend(), value)?;
        for (out, found) in out.into_iter().zip([&mass, &coupling]) {
            out.iter_mut().zip(found).for_each(|(out, x)| *out = x.derivative(1));
        }
        Ok(())
    }

    /// Deflections at which the links hang at rest in `q` under `ext`: writes the modal entries of `q`, starting from those that are there.
    /// Does nothing for a robot whose links do not bend.
    ///
    /// # Errors
    /// A slice that does not fit the model, and loads under which no equilibrium is found.
    pub fn settle(&mut self, q: &mut [f64], ext: External<f64>) -> Result<(), Error> {
        if self.modes() == 0 {
            return Ok(());
        }
        let rest = vec![0.0; self.nv()];
        self.settle_in_motion(q, &rest, &rest, ext)
    }

    /// The same for joints that move: deflections that the links keep while they accelerate as asked.
    ///
    /// # Errors
    /// As [`Dynamics::settle`].
    pub fn settle_in_motion(
        &mut self,
        q: &mut [f64],
        qd: &[f64],
        qdd: &[f64],
        ext: External<f64>,
    ) -> Result<(), Error> {
        let n = self.modes();
        if n == 0 {
            return Ok(());
        }
        let joints = q.len() - n.min(q.len());
        let mut before = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let (residual, stiffness) = self.modal_forces(q, qd, qdd, ext)?;
            let Some(step) = stiffness.lu().solve(&residual).filter(|s| s.iter().all(|x| x.is_finite())) else {
                break;
            };
            q[joints..].iter_mut().zip(step.iter()).for_each(|(eta, step)| *eta -= step);
            let size = step.amax();
            let eta = q[joints..].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            // Newton's steps shrink quadratically; once they no longer do, what is left is rounding.
            if size <= 1e-15 * eta || (size < 1e-9 * eta && size >= 0.5 * before) || size == 0.0 {
                return Ok(());
            }
            before = size;
        }
        Err(Error {
            kind: ErrorKind::Diverged,
            file: String::new(),
            element: format!("flexible_links.{}", self.model.first_bending_link().unwrap_or_default()),
            problem: "no deflection was found at which the links hang at rest".to_owned(),
            remedy: "check that the links are stiff enough for their loads, or give the modal coordinates (`eta`)"
                .to_owned(),
        })
    }

    /// Forces on the modes that a motion under `ext` asks for, and how they change with the modal coordinates.
    fn modal_forces(
        &mut self,
        q: &[f64],
        qd: &[f64],
        qdd: &[f64],
        ext: External<f64>,
    ) -> Result<(DVector<f64>, DMatrix<f64>), Error> {
        let n = self.modes();
        let (mut force, mut slope) = (DVector::zeros(n), DMatrix::zeros(n, n));
        let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) else {
            return Ok((force, slope));
        };
        let nv = model.rigid().nv();
        let zeros = |n| vec![Dual::constant(0.0); n];
        let constant = |v: &[f64]| v.iter().map(|x| Dual::constant(*x)).collect::<Vec<_>>();
        let (qd, qdd) = (constant(qd), constant(qdd));
        let wrenches: Vec<_> = ext.wrenches.iter().map(|w| w.map(Dual::constant)).collect();
        let loads = constant(ext.tau);
        let ext = External { tau: &loads, wrenches: &wrenches };
        let [mut tau, mut tau_j] = [zeros(nv + n), zeros(nv + n)];
        let mut at = constant(q);
        for k in 0..n {
            let seed = at.len() - n.min(at.len()) + k;
            at[seed].0[1] = 1.0;
            let state = State { q: &at, qd: &qd, theta: &qd, thetad: &qd };
            let accel = Acceleration { qdd: &qdd, thetadd: &qdd };
            let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
            dynamics::flexible_rnea(&model, state, accel, ext, bending.dual_scratch.lend(), out)?;
            at[seed].0[1] = 0.0;
            for (j, tau) in tau[nv..].iter().enumerate() {
                (force[j], slope[(j, k)]) = (tau.value(), tau.derivative(1));
            }
        }
        Ok((force, slope))
    }

    /// Inertia, damping and stiffness of the modes while all joints are held, at rest in `q`.
    pub(crate) fn held_modes(&mut self, q: &[f64]) -> Result<[DMatrix<f64>; 3], Error> {
        let (n, nv) = (self.modes(), self.nv());
        let mut m = vec![0.0; nv * nv];
        self.mass_matrix(q, &mut m)?;
        let inertia = DMatrix::from_row_slice(nv, nv, &m).view((nv - n, nv - n), (n, n)).into_owned();
        let [_, damping] = self.modal_matrices();
        let rest = vec![0.0; nv];
        Ok([inertia, damping, self.modal_forces(q, &rest, &rest, External::none())?.1])
    }

    /// One step of the classical Runge-Kutta scheme; see [`integrate::rk4`].
    pub(super) fn flexible_rk4(
        &mut self,
        state: StateMut<f64>,
        tau: &[f64],
        ext: External<f64>,
        step: f64,
    ) -> Result<(), Error> {
        let (nq, nv) = (self.nq(), self.nv());
        let Some(mut work) = self.bending.as_mut().map(|b| std::mem::take(&mut b.work)) else { return Ok(()) };
        let done = self.runge_kutta(state, tau, ext, step, (nq, nv), &mut work);
        if let Some(bending) = &mut self.bending {
            bending.work = work;
        }
        done
    }

    fn runge_kutta(
        &mut self,
        state: StateMut<f64>,
        tau: &[f64],
        ext: External<f64>,
        step: f64,
        (nq, nv): (usize, usize),
        work: &mut [f64],
    ) -> Result<(), Error> {
        let StateMut { q, qd, theta, thetad } = state;
        let (start, rest) = work.split_at_mut(nq + 3 * nv);
        let (slope, rest) = rest.split_at_mut(nq + 3 * nv);
        let (sum, tau_j) = rest.split_at_mut(nq + 3 * nv);
        let now = q.iter().chain(qd.iter()).chain(theta.iter()).chain(thetad.iter());
        start.iter_mut().zip(now).for_each(|(slot, x)| *slot = *x);
        sum.fill(0.0);
        // x ← x₀ + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄), each slope taken at x₀ + (0, ½, ½, 1) h k.
        for (reach, weight) in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)] {
            let (q_rate, rates) = slope.split_at_mut(nq);
            let (qdd, rates) = rates.split_at_mut(nv);
            let (theta_rate, thetadd) = rates.split_at_mut(nv);
            let at = State { q: &*q, qd: &*qd, theta: &*theta, thetad: &*thetad };
            self.forward(at, tau, ext, Forward { qdd, thetadd, tau_j: &mut *tau_j })?;
            self.position_rate(q, qd, q_rate)?;
            theta_rate.copy_from_slice(thetad);
            sum.iter_mut().zip(slope.iter()).for_each(|(total, k)| *total += weight * k);
            let next = q.iter_mut().chain(qd.iter_mut()).chain(theta.iter_mut()).chain(thetad.iter_mut());
            next.zip(start.iter().zip(slope.iter())).for_each(|(next, (x0, k))| *next = x0 + reach * step * k);
        }
        let next = q.iter_mut().chain(qd.iter_mut()).chain(theta.iter_mut()).chain(thetad.iter_mut());
        next.zip(start.iter().zip(sum.iter())).for_each(|(next, (x0, total))| *next = x0 + step / 6.0 * total);
        self.normalize(q)?;
        self.follow_joints(StateMut { q, qd, theta, thetad });
        Ok(())
    }

    /// One step of semi-implicit Euler; see [`integrate::semi_implicit_euler`].
    pub(super) fn flexible_euler(
        &mut self,
        state: StateMut<f64>,
        tau: &[f64],
        ext: External<f64>,
        step: f64,
    ) -> Result<(), Error> {
        let (nq, nv) = (self.nq(), self.nv());
        let Some(mut work) = self.bending.as_mut().map(|b| std::mem::take(&mut b.work)) else { return Ok(()) };
        let (qdd, rest) = work.split_at_mut(nv);
        let (thetadd, rest) = rest.split_at_mut(nv);
        let (shift, rest) = rest.split_at_mut(nv);
        let q_next = &mut rest[..nq];
        let StateMut { q, qd, theta, thetad } = state;
        let at = State { q: &*q, qd: &*qd, theta: &*theta, thetad: &*thetad };
        let done = self.forward(at, tau, ext, Forward { qdd, thetadd, tau_j: &mut *shift }).and_then(|()| {
            for k in 0..nv {
                qd[k] += step * qdd[k];
                thetad[k] += step * thetadd[k];
                shift[k] = step * qd[k];
                theta[k] += step * thetad[k];
            }
            self.integrate(q, shift, q_next)
        });
        if done.is_ok() {
            q.copy_from_slice(q_next);
            self.follow_joints(StateMut { q, qd, theta, thetad });
        }
        if let Some(bending) = &mut self.bending {
            bending.work = work;
        }
        done
    }

    /// `q ⊕ v`; see [`integrate::integrate`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn integrate(&self, q: &[f64], v: &[f64], out: &mut [f64]) -> Result<(), Error> {
        self.by_joints_and_modes(q, v, out, integrate::integrate, |q, v| q + v)
    }

    /// `dq/dt`; see [`integrate::position_rate`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn position_rate(&self, q: &[f64], qd: &[f64], out: &mut [f64]) -> Result<(), Error> {
        self.by_joints_and_modes(q, qd, out, integrate::position_rate, |_, v| v)
    }

    /// Brings the quaternion of a floating root back to unit length; see [`integrate::normalize`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn normalize(&self, q: &mut [f64]) -> Result<(), Error> {
        let joints = q.len() - self.modes().min(q.len());
        Ok(integrate::normalize(&self.model(), &mut q[..joints])?)
    }

    /// A function of the core over the joints, another over each mode.
    fn by_joints_and_modes(
        &self,
        q: &[f64],
        v: &[f64],
        out: &mut [f64],
        joints: OverJoints,
        mode: fn(f64, f64) -> f64,
    ) -> Result<(), Error> {
        let n = self.modes();
        let split = |len: usize| len.saturating_sub(n);
        let (q, eta) = q.split_at(split(q.len()));
        let (v, etad) = v.split_at(split(v.len()));
        let (out, modes) = out.split_at_mut(split(out.len()));
        joints(&self.model(), q, v, out)?;
        modes.iter_mut().zip(eta.iter().zip(etad)).for_each(|(out, (q, v))| *out = mode(*q, *v));
        Ok(())
    }

    /// Without an elastic transmission the motor turns with the joint; a mode has none.
    fn follow_joints(&self, state: StateMut<f64>) {
        let model = self.model();
        for body in model.bodies() {
            let (i, k) = (body.q_index(), body.v_index());
            match body.joint {
                JointKind::Floating => {
                    state.theta[k..k + 6].fill(0.0);
                    state.thetad[k..k + 6].fill(0.0);
                }
                _ if !body.is_elastic() => (state.theta[k], state.thetad[k]) = (state.q[i], state.qd[k]),
                _ => {}
            }
        }
        state.theta[model.nv()..].copy_from_slice(&state.q[model.nq()..]);
        state.thetad[model.nv()..].copy_from_slice(&state.qd[model.nv()..]);
    }
}

impl DualState {
    /// Sets the derivative of one entry to one.
    fn seed(&mut self, model: &FlexibleModel<f64>, q: &[f64], direction: Direction) -> Result<(), Error> {
        let rigid = model.rigid();
        let one = |slot: &mut Dual| slot.0[1] = 1.0;
        match direction {
            Direction::Q(k) if k < rigid.nv() => {
                let mut unit = vec![0.0; rigid.nv()];
                unit[k] = 1.0;
                let mut rate = vec![0.0; rigid.nq()];
                integrate::position_rate(&rigid, &q[..rigid.nq()], &unit, &mut rate)?;
                self.q.iter_mut().zip(rate).for_each(|(slot, rate)| slot.0[1] = rate);
            }
            Direction::Q(k) => one(&mut self.q[rigid.nq() + k - rigid.nv()]),
            Direction::Qd(k) => one(&mut self.qd[k]),
            Direction::Theta(k) => one(&mut self.theta[k]),
            Direction::Thetad(k) => one(&mut self.thetad[k]),
            Direction::Tau(k) => one(&mut self.tau[k]),
        }
        Ok(())
    }
}

/// Newton takes a handful of steps where it converges at all.
const MAX_STEPS: usize = 60;
