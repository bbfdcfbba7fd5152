//! What elastic joints alone have: stiffness, and the inverse from the motion of the links.

use super::subject::{DOUBLE, Known, SINGLE, Subject, grown};
use gyroflex::Scalar;
use gyroflex::dynamics::{
    AbaScratch, Contains, Deflections, DerivativeScratch, ElasticInverse, ElasticInverseScratch, External, Forward,
    JointMotion, JointOrders, MAX_COEFFICIENTS, Smoothness, SmoothnessScratch, State, VANISHING, aba, elastic_inverse,
    elastic_inverse_len, required_smoothness, smoothness_len,
};
use gyroflex::model::{Fidelity, SpringSpec, TransmissionSpec};
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::{Options, Quantity, function};
use gyroflex_testkit::Dual;
use gyroflex_testkit::random::{Options as Grown, RandomRobot};
use gyroflex_testkit::tolerance::{Real, assert_close_above};

#[test]
fn generated_stiffness_is_the_slope_of_transmitted_torques() {
    let options = Grown { floating: 0.0, remote_rigid: false, ..grown() };
    let mut shown = 0;
    for seed in 0..60 {
        let robot = RandomRobot::new(seed, &options);
        for fidelity in [Fidelity::Complete, Fidelity::Reduced] {
            let s = Subject::of(&robot, fidelity);
            let Some(function) = s.function(Quantity::Stiffness) else { continue };
            shown += 1;
            s.assert_equal::<f64>(&function, &stiffness(&s), &[], DOUBLE);
        }
    }
    assert!(shown > 60, "{shown} robots are elastic");
}

/// `−∂τ_J/∂q` of forward dynamics: a transmission gives by its spring.
pub fn stiffness(s: &Subject) -> Vec<Known> {
    let (model, x) = (s.rigid.view(), &s.state);
    let constant = |x: &[f64]| x.iter().map(|x| Dual::from_f64(*x)).collect::<Vec<Dual>>();
    // Every transmission depends on its own joint alone: all may move at once.
    let q: Vec<Dual> = x.q.iter().map(|q| Dual::new(*q, 1.0)).collect();
    let (qd, theta, thetad, tau) = (constant(&x.qd), constant(&x.theta), constant(&x.thetad), constant(&x.tau));
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![Dual::zero(); model.nv()]);
    let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
    let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    let mut scratch = vec![AbaScratch::new(); model.bodies().len()];
    aba(&model, state, &tau, External::none(), &mut scratch, out).expect("it fits");
    let slope = |(body, tau_j): (&gyroflex::model::Body<f64>, &Dual)| {
        if body.is_elastic() { -tau_j.slope } else { 0.0 }
    };
    vec![Known::new("k", model.bodies().iter().zip(&tau_j).map(slope).collect())]
}

/// Arms whose motors are found in a motion of any derivatives: every joint elastic, damping such that transients are slow enough
/// to be differentiated.
fn arm(seed: u64) -> RandomRobot {
    let damped = if seed.is_multiple_of(2) { 1.0 } else { 0.0 };
    let options = Grown { bodies: 1..=5, driven: 1.0, elastic: 1.0, damping: damped, ..grown() };
    let mut robot = RandomRobot::new(seed, &options);
    for drive in robot.bodies.iter_mut().filter_map(|body| body.drive.as_mut()) {
        let TransmissionSpec::Elastic { spring, damping, .. } = &mut drive.transmission else { continue };
        let stiffness = match *spring {
            SpringSpec::Polynomial { stiffness, .. } => stiffness,
            SpringSpec::Table { first, .. } => robot.spring_tables[first + 1][1] / robot.spring_tables[first + 1][0],
        };
        if *damping > 0.0 {
            *damping = damping.max(stiffness.abs() / 50.0);
        }
    }
    robot
}

fn orders(s: &Subject, torque_derivatives: usize) -> Vec<JointOrders> {
    let model = s.rigid.view();
    let (n, nv) = (model.bodies().len(), model.nv());
    let mut orders = vec![JointOrders::default(); n];
    let scratch = SmoothnessScratch {
        bodies: &mut vec![DerivativeScratch::new(); n],
        numbers: &mut vec![0.0; smoothness_len(&model)],
        contains: &mut vec![Contains::default(); nv * nv],
    };
    required_smoothness(&model, torque_derivatives, VANISHING, scratch, &mut orders).expect("it fits");
    orders
}

#[test]
fn generated_elastic_inverse_equals_library() {
    for seed in 0..40 {
        let robot = arm(seed);
        for fidelity in [Fidelity::Complete, Fidelity::Reduced] {
            let mut s = Subject::of(&robot, fidelity);
            let torque_derivatives = seed as usize % 3;
            let options = Options { torque_derivatives, ..Options::default() };
            let Ok(function) = function(&s.robot(), Quantity::ElasticInverse, &options) else { continue };
            is_the_inverse(&mut s, &function, torque_derivatives, &|row| robot.state(10 + row as u64).qd);
        }
    }
}

/// A motion of about a hertz, whose derivatives are of the size that `random` has.
pub fn is_the_inverse(
    s: &mut Subject,
    function: &Function,
    torque_derivatives: usize,
    random: &dyn Fn(usize) -> Vec<f64>,
) {
    let orders = orders(s, torque_derivatives);
    let smoothness = Smoothness { joints: &orders, torque_derivatives };
    // Numbers that both scalars have.
    let single = s.round();
    let rates = |row: usize| random(row).into_iter().map(move |x| 0.1 * x * 6f64.powi(row as i32));
    let rounded = |x: f64| f64::from(x as f32);
    let derivatives: Vec<f64> = (1..=smoothness.order()).flat_map(rates).map(rounded).collect();
    let deflection: Vec<f64> = s.state.qd.iter().map(|x| rounded(1e-3 * x)).collect();
    let step = rounded(1e-3);
    let want = library(s, &smoothness, &derivatives, &deflection, step);
    let given: [(&str, &[f64]); 3] = [("derivatives", &derivatives), ("deflection", &deflection), ("step", &[step])];
    assert_rows_equal::<f64>(s, function, &want, &given, DOUBLE);
    if single {
        assert_rows_equal::<f32>(s, function, &want, &given, SINGLE);
    }
}

/// Every row is of a size of its own.
fn assert_rows_equal<T: Real>(
    s: &Subject,
    function: &Function,
    want: &[Known],
    given: &[(&str, &[f64])],
    tolerance: f64,
) {
    let nv = s.state.qd.len();
    for (name, got) in s.evaluate::<T>(function, given) {
        let want = &want.iter().find(|want| want.name == name).expect("the library gives it").value;
        for (row, (got, want)) in got.chunks(nv).zip(want.chunks(nv)).enumerate() {
            assert_close_above(&format!("{name}, row {row} in {}", T::NAME), s, got, want, tolerance, 0.0);
        }
    }
}

fn library(s: &Subject, smoothness: &Smoothness, derivatives: &[f64], deflection: &[f64], step: f64) -> Vec<Known> {
    let (model, rows) = (s.rigid.view(), 1 + smoothness.torque_derivatives);
    let nv = model.nv();
    let [mut theta, mut tau_j, mut tau] = [2 + rows, rows, rows].map(|rows| vec![0.0; rows * nv]);
    let [mut after, mut rate] = [(); 2].map(|()| vec![0.0; nv]);
    let len = elastic_inverse_len(&model, smoothness).expect("there is code for it");
    elastic_inverse::<f64, MAX_COEFFICIENTS>(
        &model,
        smoothness,
        JointMotion { q: &s.state.q, derivatives },
        External::none(),
        Deflections { now: deflection, step },
        &mut vec![ElasticInverseScratch::new(); len],
        ElasticInverse {
            theta: &mut theta,
            tau_j: &mut tau_j,
            tau: &mut tau,
            deflection: &mut after,
            deflection_rate: &mut rate,
        },
    )
    .unwrap_or_else(|error| panic!("{error}; {s}"));
    vec![
        Known::new("theta", theta),
        Known::new("tau_j", tau_j),
        Known::new("tau", tau),
        Known::new("deflection_after", after),
        Known::new("deflection_rate", rate),
    ]
}
