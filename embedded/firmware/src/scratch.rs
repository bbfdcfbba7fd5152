//! The algorithms on arrays of the arm's size.

use crate::arm::N;
use gyroflex::dynamics::{
    AbaScratch, Acceleration, CrbaScratch, External, Forward, Inverse, RneaScratch, State, aba, crba, rnea,
};
use gyroflex::model::{Model, SizeError};

/// Scratch of all algorithms; nothing in it outlives a call.
#[derive(Clone, Debug)]
pub struct Scratch {
    aba: [AbaScratch<f32>; N],
    rnea: [RneaScratch<f32>; N],
    pub crba: [CrbaScratch<f32>; N],
}

impl Scratch {
    pub fn new() -> Self {
        Self { aba: [AbaScratch::new(); N], rnea: [RneaScratch::new(); N], crba: [CrbaScratch::new(); N] }
    }
}

impl Default for Scratch {
    fn default() -> Self {
        Self::new()
    }
}

/// What forward dynamics gives.
#[derive(Clone, Debug, Default)]
pub struct Accelerations {
    pub qdd: [f32; N],
    pub thetadd: [f32; N],
    pub tau_j: [f32; N],
}

/// What inverse dynamics gives.
#[derive(Clone, Debug, Default)]
pub struct Torques {
    pub tau_j: [f32; N],
    pub tau: [f32; N],
}

/// Forward dynamics under motor torques and generalised forces on the links, which may be empty.
pub fn forward(
    model: &Model<f32>,
    state: State<f32>,
    tau: &[f32; N],
    on_links: &[f32],
    scratch: &mut Scratch,
    out: &mut Accelerations,
) -> Result<(), SizeError> {
    let ext = External { tau: on_links, wrenches: &[] };
    let out = Forward { qdd: &mut out.qdd, thetadd: &mut out.thetadd, tau_j: &mut out.tau_j };
    aba(model, state, tau, ext, &mut scratch.aba, out)
}

/// Inverse dynamics under generalised forces on the links, which may be empty.
pub fn inverse(
    model: &Model<f32>,
    state: State<f32>,
    accel: Acceleration<f32>,
    on_links: &[f32],
    scratch: &mut Scratch,
    out: &mut Torques,
) -> Result<(), SizeError> {
    let ext = External { tau: on_links, wrenches: &[] };
    let out = Inverse { tau_j: &mut out.tau_j, tau: &mut out.tau };
    rnea(model, state, accel, ext, &mut scratch.rnea, out)
}

/// The inertia matrix of the link side.
pub fn mass_matrix(
    model: &Model<f32>,
    q: &[f32; N],
    scratch: &mut Scratch,
    m: &mut [[f32; N]; N],
) -> Result<(), SizeError> {
    crba(model, q, &mut scratch.crba, m.as_flattened_mut())
}
