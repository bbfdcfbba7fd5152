//! Derivatives of inverse and forward dynamics against automatic differentiation of the algorithms themselves, which the dense
//! oracle has shown right.

use gyroflex::Scalar;
use gyroflex::dynamics::{
    AbaScratch, Acceleration, External, Forward, ForwardScratch, Inverse, JointSpaceScratch, RneaScratch, State,
    forward_dynamics, joint_space_len, matrix_len, rnea,
};
use gyroflex::model::{Fidelity, Model};
use gyroflex::spatial::Force;
use gyroflex_testkit::dual::moving_positions;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{norm, tol};
use gyroflex_testkit::{Dual, State as Point};
use gyroflex_tests::{Core, Trial, for_trials, small};

/// The state as dual numbers, one of its vectors moving along coordinate `k`.
struct Moving {
    q: Vec<Dual>,
    qd: Vec<Dual>,
    theta: Vec<Dual>,
    thetad: Vec<Dual>,
    qdd: Vec<Dual>,
    thetadd: Vec<Dual>,
    tau: Vec<Dual>,
    tau_ext: Vec<Dual>,
    wrenches: Vec<Force<Dual>>,
}

fn constant(x: &[f64]) -> Vec<Dual> {
    x.iter().map(|x| Dual::from_f64(*x)).collect()
}

impl Moving {
    fn at(s: &Point) -> Self {
        Self {
            q: constant(&s.q),
            qd: constant(&s.qd),
            theta: constant(&s.theta),
            thetad: constant(&s.thetad),
            qdd: constant(&s.qdd),
            thetadd: constant(&s.thetadd),
            tau: constant(&s.tau),
            tau_ext: constant(&s.tau_ext),
            wrenches: s.wrenches.iter().map(|w| Force::from(w.map(Dual::from_f64))).collect(),
        }
    }

    /// Along the velocity coordinate `k`.
    fn position(mut self, k: usize) -> Self {
        let mut unit = vec![0.0; self.qd.len()];
        unit[k] = 1.0;
        let q: Vec<f64> = self.q.iter().map(|x| x.value).collect();
        self.q = moving_positions(&q, &unit);
        self
    }

    fn state(&self) -> State<'_, Dual> {
        State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad }
    }

    fn external(&self) -> External<'_, Dual> {
        External { tau: &self.tau_ext, wrenches: &self.wrenches }
    }

    /// Slopes of `qdd` and `thetadd`.
    fn forward(&self, model: &Model<'_, f64>) -> [Vec<f64>; 2] {
        let zero = Dual::from_f64(0.0);
        let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![zero; model.nv()]);
        let mut bodies = vec![AbaScratch::new(); model.bodies().len()];
        let mut joint_space = vec![JointSpaceScratch::new(); joint_space_len(model)];
        let mut matrix = vec![zero; matrix_len(model)];
        let scratch = ForwardScratch { bodies: &mut bodies, joint_space: &mut joint_space, matrix: &mut matrix };
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        forward_dynamics(model, self.state(), &self.tau, self.external(), scratch, out).expect("slices fit");
        [qdd, thetadd].map(|x| x.iter().map(|x| x.slope).collect())
    }

    /// Slopes of `tau_j` and `tau`.
    fn inverse(&self, model: &Model<'_, f64>) -> [Vec<f64>; 2] {
        let zero = Dual::from_f64(0.0);
        let [mut tau_j, mut tau] = [(); 2].map(|()| vec![zero; model.nv()]);
        let mut scratch = vec![RneaScratch::new(); model.bodies().len()];
        let accel = Acceleration { qdd: &self.qdd, thetadd: &self.thetadd };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
        rnea(model, self.state(), accel, self.external(), &mut scratch, out).expect("slices fit");
        [tau_j, tau].map(|x| x.iter().map(|x| x.slope).collect())
    }
}

/// The name of a block of columns, and the motion that moves along one of its coordinates.
type Block = (&'static str, fn(Moving, usize) -> Moving);

/// Asserts that every block of `nv` columns of a matrix of slopes is what automatic differentiation gives column by column.
fn assert_blocks(
    t: &Trial<'_, f64>,
    names: [&str; 2],
    blocks: &[Block],
    got: [&[f64]; 2],
    slopes: impl Fn(&Moving) -> [Vec<f64>; 2],
) {
    let nv = t.robot.nv();
    let width = blocks.len() * nv;
    // Blocks that vanish are zero but for the rounding of what they are the sum of.
    let rounding = 1e-4 * norm(got[0]).max(norm(got[1]));
    for (b, (variable, moved)) in blocks.iter().enumerate() {
        let columns: Vec<[Vec<f64>; 2]> = (0..nv).map(|k| slopes(&moved(Moving::at(&t.state), k))).collect();
        for (side, name) in names.into_iter().enumerate() {
            let want: Vec<f64> = (0..nv * nv).map(|i| columns[i % nv][side][i / nv]).collect();
            let got: Vec<f64> = (0..nv * nv).map(|i| got[side][(i / nv) * width + b * nv + i % nv]).collect();
            t.assert_close(&format!("d {name} / d {variable}"), &got, &want, rounding);
        }
    }
}

fn along(x: &mut [Dual], k: usize) {
    x[k].slope = 1.0;
}

fn forward(t: &Trial<'_, f64>) {
    let (model, s) = (t.core.model(), &t.state);
    let (value, [d_qdd, d_thetadd]) = t.core.clone().with_dirty_scratch().forward_derivatives(s);
    let want = t.core.forward(s);
    t.assert_close("qdd", &value.qdd, &want.qdd, 0.0);
    t.assert_close("thetadd", &value.thetadd, &want.thetadd, 0.0);
    t.assert_close("tau_j", &value.tau_j, &want.tau_j, 0.0);
    let blocks: [Block; 5] = [
        ("q", Moving::position),
        ("qd", |mut m, k| {
            along(&mut m.qd, k);
            m
        }),
        ("theta", |mut m, k| {
            along(&mut m.theta, k);
            m
        }),
        ("thetad", |mut m, k| {
            along(&mut m.thetad, k);
            m
        }),
        ("tau", |mut m, k| {
            along(&mut m.tau, k);
            m
        }),
    ];
    assert_blocks(t, ["qdd", "thetadd"], &blocks, [&d_qdd, &d_thetadd], |m| m.forward(&model));
}

fn inverse(t: &Trial<'_, f64>) {
    let model = t.core.model();
    let [tau_j, tau] = t.core.clone().with_dirty_scratch().inverse_derivatives(&t.state);
    let blocks: [Block; 6] = [
        ("q", Moving::position),
        ("qd", |mut m, k| {
            along(&mut m.qd, k);
            m
        }),
        ("qdd", |mut m, k| {
            along(&mut m.qdd, k);
            m
        }),
        ("theta", |mut m, k| {
            along(&mut m.theta, k);
            m
        }),
        ("thetad", |mut m, k| {
            along(&mut m.thetad, k);
            m
        }),
        ("thetadd", |mut m, k| {
            along(&mut m.thetadd, k);
            m
        }),
    ];
    assert_blocks(t, ["tau_j", "tau"], &blocks, [&tau_j, &tau], |m| m.inverse(&model));
}

#[test]
fn derivatives_of_inverse_dynamics_equal_automatic_differentiation() {
    for_trials::<f64>(200, &Options::default(), &Fidelity::ALL, tol(1e-9, 0.0), inverse);
}

#[test]
fn derivatives_of_forward_dynamics_equal_automatic_differentiation() {
    for_trials::<f64>(200, &Options::default(), &Fidelity::ALL, tol(1e-9, 0.0), forward);
}

/// Block by block, against double precision, which automatic differentiation has shown right.
fn as_in_double_precision(t: &Trial<'_, f32>) {
    let (s, double) = (&t.state, Core::<f64>::new(&t.robot.spec(), t.fidelity));
    let [got, want] = [t.core.inverse_derivatives(s), double.inverse_derivatives(s)];
    for (name, got, want) in [("tau_j", &got[0], &want[0]), ("tau", &got[1], &want[1])] {
        t.assert_close(&format!("derivatives of {name}"), got, want, 0.0);
    }
    let [(_, got), (_, want)] = [t.core.forward_derivatives(s), double.forward_derivatives(s)];
    for (name, got, want) in [("qdd", &got[0], &want[0]), ("thetadd", &got[1], &want[1])] {
        t.assert_close(&format!("derivatives of {name}"), got, want, 0.0);
    }
}

#[test]
fn derivatives_in_single_precision() {
    for_trials::<f32>(200, &small(), &Fidelity::ALL, tol(0.0, 1e-3), as_in_double_precision);
}
