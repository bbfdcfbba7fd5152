//! Derivatives, column by column: the core's algorithms on symbols that carry the slope in one direction.
//!
//! Values are the same symbols in every column, and so are written once.

use super::super::tracing::{SymbolicState, zeros};
use super::Storage;
use crate::sym::Sym;
use gyroflex::dynamics::{
    Acceleration, External, FlexibleMatrices, Forward, Inverse, State, flexible_aba, flexible_mass_matrix,
    flexible_rnea,
};
use gyroflex::integrate::position_rate;
use gyroflex::model::FlexibleModel;
use gyroflex::{Jet, Scalar};

/// A symbol and its slope.
type Dual = Jet<Sym, 2>;

/// Vectors of a motion, one entry of one of which moves.
struct Moving {
    q: Vec<Dual>,
    rest: Vec<Vec<Dual>>,
}

impl Moving {
    /// Block `block` of `q` and `rest` moves along coordinate `k`, a pose of a floating root by a small motion in its own frame.
    fn along(model: &FlexibleModel<Sym>, q: &[Sym], rest: &[&[Sym]], block: usize, k: usize) -> Self {
        let nv = model.nv();
        let unit: Vec<Sym> = (0..nv).map(|i| if i == k { Sym::one() } else { Sym::zero() }).collect();
        let with = |x: &[Sym], slopes: &[Sym]| x.iter().zip(slopes).map(|(x, slope)| Jet([*x, *slope])).collect();
        let (still, mut rates) = (zeros(q.len().max(nv)), zeros(q.len()));
        if block == 0 {
            let (joints, modes) = (model.rigid().nq(), model.rigid().nv());
            position_rate(&model.rigid(), &q[..joints], &unit[..modes], &mut rates[..joints]).expect("it fits");
            rates[joints..].copy_from_slice(&unit[modes..]);
        }
        let rest = rest.iter().enumerate();
        let rest = rest.map(|(i, x)| with(x, if i + 1 == block { &unit } else { &still })).collect();
        Self { q: with(q, &rates), rest }
    }

    fn state(&self) -> State<'_, Dual> {
        State { q: &self.q, qd: &self.rest[0], theta: &self.rest[1], thetad: &self.rest[2] }
    }
}

/// Puts the slopes of a column into its place.
fn place(matrix: &mut [Sym], column: usize, results: &[Dual]) {
    let columns = matrix.len() / results.len();
    for (row, x) in matrix.chunks_mut(columns).zip(results) {
        row[column] = x.0[1];
    }
}

/// `∂q̈` and `∂θ̈` by `q, q̇, θ, θ̇, τ`: `nv` rows of as many blocks of `nv` columns.
pub(in super::super) fn forward_partials(
    model: &FlexibleModel<Sym>,
    state: &SymbolicState,
    tau: &[Sym],
) -> [Vec<Sym>; 2] {
    let nv = model.nv();
    let mut partials = [zeros(5 * nv * nv), zeros(5 * nv * nv)];
    let rest = [&state.qd[..], &state.theta, &state.thetad, tau];
    for column in 0..5 * nv {
        let x = Moving::along(model, &state.q, &rest, column / nv, column % nv);
        let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![Dual::zero(); nv]);
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        flexible_aba(model, x.state(), &x.rest[3], External::none(), Storage::of(model).lend(), out).expect("it fits");
        place(&mut partials[0], column, &qdd);
        place(&mut partials[1], column, &thetadd);
    }
    partials
}

/// `∂τ_J` and `∂τ` by `q, q̇, q̈, θ, θ̇, θ̈`, likewise.
pub(in super::super) fn inverse_partials(
    model: &FlexibleModel<Sym>,
    state: &SymbolicState,
    accel: Acceleration<Sym>,
) -> [Vec<Sym>; 2] {
    // The blocks in the order of the state.
    const BLOCKS: [usize; 6] = [0, 1, 3, 4, 2, 5];
    let nv = model.nv();
    let mut partials = [zeros(6 * nv * nv), zeros(6 * nv * nv)];
    let rest = [&state.qd[..], &state.theta, &state.thetad, accel.qdd, accel.thetadd];
    for (moving, block) in BLOCKS.into_iter().enumerate() {
        for k in 0..nv {
            let x = Moving::along(model, &state.q, &rest, moving, k);
            let [mut tau_j, mut tau] = [(); 2].map(|()| vec![Dual::zero(); nv]);
            let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
            let accel = Acceleration { qdd: &x.rest[3], thetadd: &x.rest[4] };
            flexible_rnea(model, x.state(), accel, External::none(), Storage::of(model).lend(), out).expect("it fits");
            place(&mut partials[0], block * nv + k, &tau_j);
            place(&mut partials[1], block * nv + k, &tau);
        }
    }
    partials
}

/// `∂M/∂q_k` and `∂S/∂q_k`.
pub(super) fn inertia_slope(model: &FlexibleModel<Sym>, q: &[Sym], k: usize) -> [Vec<Sym>; 2] {
    let nv = model.nv();
    let x = Moving::along(model, q, &[], 0, k);
    let [mut mass, mut coupling] = [(); 2].map(|()| vec![Dual::zero(); nv * nv]);
    let out = FlexibleMatrices { mass: &mut mass, coupling: &mut coupling };
    flexible_mass_matrix(model, &x.q, Storage::of(model).lend(), out).expect("it fits");
    [mass, coupling].map(|all| all.iter().map(|x| x.0[1]).collect())
}
