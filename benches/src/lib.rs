//! Robots and states shared by the benches.

use gyroflex::dynamics::{AbaScratch, CrbaScratch, External, Forward, State, aba, crba};
use gyroflex::dynamics::{Acceleration, Inverse, RneaScratch, rnea};
use gyroflex::model::{Fidelity, Model};
use gyroflex_sim::Robot;
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::robot::OwnedModel;
use std::path::Path;

/// How many states the benches walk through, so that no branch predictor learns one by heart.
pub const STATES: usize = 256;

/// A robot of `robots/`, its drives as in its YAML.
pub fn robot(name: &str) -> Robot {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots").join(name).join("robot.yaml");
    load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// The same robot without drives: its plain rigid dynamics.
pub fn without_drives(mut robot: Robot) -> Robot {
    for body in &mut robot.bodies {
        body.drive = None;
    }
    robot
}

/// A model, random states, and everything the algorithms write.
pub struct Workload {
    model: OwnedModel,
    states: Vec<[Vec<f64>; 5]>,
    aba: Vec<AbaScratch<f64>>,
    rnea: Vec<RneaScratch<f64>>,
    crba: Vec<CrbaScratch<f64>>,
    out: [Vec<f64>; 3],
    matrix: Vec<f64>,
}

impl Workload {
    /// Prepares a robot for one of the four models.
    pub fn new(robot: &Robot, fidelity: Fidelity) -> Self {
        let model = robot.model(fidelity).unwrap_or_else(|e| panic!("{e}"));
        let (n, nq, nv) = (model.view().bodies().len(), model.view().nq(), model.view().nv());
        let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
        let mut uniform = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let states = (0..STATES)
            .map(|_| {
                let q: Vec<f64> = (0..nq).map(|_| 3.0 * uniform()).collect();
                let theta = q.iter().take(nv).map(|q| q + 1e-3 * uniform()).collect();
                let mut vector = |scale: f64| (0..nv).map(|_| scale * uniform()).collect::<Vec<_>>();
                let (qd, thetad, tau) = (vector(2.0), vector(2.0), vector(20.0));
                [q, qd, theta, thetad, tau]
            })
            .collect();
        Self {
            model,
            states,
            aba: vec![AbaScratch::new(); n],
            rnea: vec![RneaScratch::new(); n],
            crba: vec![CrbaScratch::new(); n],
            out: [vec![0.0; nv], vec![0.0; nv], vec![0.0; nv]],
            matrix: vec![0.0; nv * nv],
        }
    }

    /// The model the workload runs on.
    pub fn model(&self) -> Model<'_, f64> {
        self.model.view()
    }

    /// One call of forward dynamics at state `i`.
    pub fn forward(&mut self, i: usize) {
        let [q, qd, theta, thetad, tau] = &self.states[i % STATES];
        let [qdd, thetadd, tau_j] = &mut self.out;
        let out = Forward { qdd, thetadd, tau_j };
        aba(&self.model.view(), State { q, qd, theta, thetad }, tau, External::none(), &mut self.aba, out)
            .unwrap_or_else(|e| panic!("{e}"));
    }

    /// One call of inverse dynamics at state `i`.
    pub fn inverse(&mut self, i: usize) {
        let [q, qd, theta, thetad, accel] = &self.states[i % STATES];
        let [tau_j, tau, _] = &mut self.out;
        let accel = Acceleration { qdd: accel, thetadd: accel };
        let state = State { q, qd, theta, thetad };
        rnea(&self.model.view(), state, accel, External::none(), &mut self.rnea, Inverse { tau_j, tau })
            .unwrap_or_else(|e| panic!("{e}"));
    }

    /// One call of the inertia matrix at state `i`.
    pub fn mass_matrix(&mut self, i: usize) {
        let [q, ..] = &self.states[i % STATES];
        crba(&self.model.view(), q, &mut self.crba, &mut self.matrix).unwrap_or_else(|e| panic!("{e}"));
    }
}
