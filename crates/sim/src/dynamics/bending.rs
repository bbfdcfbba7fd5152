//! Dynamics of robots whose links bend: storage of the core's algorithms, and what is made of them here.

use super::Dynamics;
use crate::error::Error;
use gyroflex::dynamics::{
    self, Acceleration, External, FlexibleBody, FlexibleMatrices, FlexibleMode, FlexiblePlacements, FlexibleScratch,
    FlexibleStation, Forward, Inverse, State,
};
use gyroflex::integrate;
use gyroflex::model::FlexibleModel;
use gyroflex::spatial::{Motion, Transform};
use gyroflex::{Jet, Scalar};
use nalgebra::DMatrix;

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

/// What a robot needs once its links bend.
#[derive(Clone, Debug)]
pub(super) struct Bending {
    pub(super) scratch: Storage<f64>,
    /// `nv × nv` numbers that nobody asked for.
    pub(super) unasked: Vec<f64>,
    /// Of the integrators.
    pub(super) work: Vec<f64>,
    /// A state with its derivative, and what becomes of it.
    dual: DualState,
    pub(super) dual_scratch: Storage<Dual>,
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
