//! Laws of the controllers.

use gyroflex::Jet;
use gyroflex::control::{
    ComputedTorque, FeedbackLinearization, Joints, LinearizationScratch, Motors, Pd, TwoDof, TwoDofScratch,
};
use gyroflex::dynamics::{
    AbaScratch, ElasticInverseScratch, External, Forward, JointMotion, MAX_COEFFICIENTS, RneaScratch, Smoothness,
    State, VANISHING, aba, elastic_inverse_len,
};
use gyroflex::model::Fidelity;
use gyroflex_testkit::Lowered;
use gyroflex_testkit::random::{Options, RandomRobot};
use gyroflex_testkit::tolerance::assert_close;
use gyroflex_tests::{Core, LinkMotion, orders_of, random_motion, settling, smoothness};

/// Arms whose every joint is elastic and driven.
fn arms(damping: f64) -> Options {
    Options {
        bodies: 1..=6,
        floating: 0.0,
        driven: 1.0,
        elastic: 1.0,
        damping,
        friction: 0.0,
        table: 0.0,
        ..Options::default()
    }
}

/// The first derivative that the torque sets at once is the one commanded: `r` poles at the bandwidth.
#[test]
fn feedback_linearization_gives_joints_the_derivative_it_commands() {
    type Series = Jet<f64, 3>;
    for damping in [0.0, 1.0] {
        for seed in 0..60 {
            let robot = settling(RandomRobot::new(seed, &arms(damping)));
            let lowered = Lowered::<f64>::new(&robot.spec(), Fidelity::Reduced).expect("a random robot is valid");
            let (model, s) = (lowered.view(), robot.state(0));
            let orders = orders_of(&model, 0, VANISHING);
            let (n, nv) = (model.bodies().len(), model.nv());
            let smoothness = Smoothness { joints: &orders, torque_derivatives: 0 };
            let bandwidth: Vec<f64> = (0..nv).map(|k| 20.0 + k as f64).collect();
            let law = FeedbackLinearization { model, smoothness, bandwidth: &bandwidth };
            let degree = law.relative_degree();
            let desired: Vec<f64> = (0..(degree + 1) * nv).map(|i| (1.7 * i as f64).sin()).collect();
            let mut tau = vec![f64::NAN; nv];
            let scratch = LinearizationScratch {
                bodies: &mut vec![AbaScratch::new(); n],
                series: &mut vec![ElasticInverseScratch::new(); elastic_inverse_len(&model, &smoothness).unwrap()],
                jets: &mut vec![Jet([f64::NAN; 2]); 8 * nv],
                numbers: &mut vec![f64::NAN; 11 * nv],
            };
            let state = State { q: &s.q, qd: &s.qd, theta: &s.theta, thetad: &s.thetad };
            law.torque(&desired, state, scratch, &mut tau).expect("random springs can be inverted");

            // The same torque through forward dynamics on series, accelerations fed back until all coefficients are right.
            let tau: Vec<_> = tau.iter().map(|t| Series::constant(*t)).collect();
            let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![Series::constant(0.0); nv]);
            for _ in 0..4 {
                let moving = |x: &[f64], v: &[f64], a: &[Series]| -> (Vec<Series>, Vec<Series>) {
                    let at = |k: usize| Jet([x[k], v[k], 0.5 * a[k].0[0]]);
                    let speed = |k: usize| Jet([v[k], a[k].0[0], 0.5 * a[k].0[1]]);
                    ((0..nv).map(at).collect(), (0..nv).map(speed).collect())
                };
                let (q, qd) = moving(&s.q, &s.qd, &qdd);
                let (theta, thetad) = moving(&s.theta, &s.thetad, &thetadd);
                let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
                let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
                aba(&model, state, &tau, External::none(), &mut vec![AbaScratch::new(); n], out).expect("it fits");
            }
            let got: Vec<f64> = qdd.iter().map(|a| a.derivative(degree - 2)).collect();
            let binomial: &[f64] = if degree == 4 { &[1.0, 4.0, 6.0, 4.0] } else { &[1.0, 3.0, 3.0] };
            let want: Vec<f64> = (0..nv)
                .map(|k| {
                    let now = [s.q[k], s.qd[k], qdd[k].0[0], qdd[k].0[1]];
                    let of = |row: usize| desired[row * nv + k];
                    let gain = |row: usize| binomial[row] * bandwidth[k].powi((degree - row) as i32);
                    of(degree) + (0..degree).map(|row| gain(row) * (of(row) - now[row])).sum::<f64>()
                })
                .collect();
            assert_close("q⁽ʳ⁾", &format!("seed {seed}, damping {damping}"), &got, &want, 1e-6);
        }
    }
}

/// On the motion itself the feedback is silent: the torque is the inverse's, and so is the deflection that is kept.
#[test]
fn two_degrees_of_freedom_are_independent() {
    for seed in 0..40 {
        let robot = settling(RandomRobot::new(seed, &arms(0.5)));
        let orders = smoothness(&robot.spec(), Fidelity::Complete, 0, VANISHING);
        let core = Core::<f64>::new(&robot.spec(), Fidelity::Complete);
        let (model, nv) = (core.model(), core.model().nv());
        let motion =
            LinkMotion { tau_ext: Vec::new(), wrenches: Vec::new(), ..random_motion(&robot, &model, &orders, 0) };
        let want = core.elastic_inverse(&orders, 0, &motion).expect("it can be inverted");
        let smoothness = Smoothness { joints: &orders, torque_derivatives: 0 };
        let (kp, kd) = (vec![3.0; nv], vec![0.5; nv]);
        let derivatives = motion.derivatives.concat();
        let run = |error: f64| {
            let mut deflection = motion.deflection.clone();
            let mut law = TwoDof { model, smoothness, feedback: Pd { kp: &kp, kd: &kd }, deflection: &mut deflection };
            let (mut theta, mut tau_j, mut rates) = (vec![0.0; 3 * nv], vec![0.0; nv], vec![0.0; 2 * nv]);
            let scratch = TwoDofScratch {
                series: &mut vec![ElasticInverseScratch::new(); elastic_inverse_len(&model, &smoothness).unwrap()],
                theta: &mut theta,
                tau_j: &mut tau_j,
                rates: &mut rates,
            };
            let measured: Vec<f64> = want.theta[0].iter().map(|x| x - error).collect();
            let mut tau = vec![f64::NAN; nv];
            let motion = JointMotion { q: &motion.q, derivatives: &derivatives };
            let motors = Motors { theta: &measured, thetad: &want.theta[1] };
            law.tick::<MAX_COEFFICIENTS>(motion, motors, 1e-3, scratch, &mut tau).expect("it can be inverted");
            (tau, deflection)
        };
        let (tau, deflection) = run(0.0);
        assert_eq!((tau, deflection), (want.tau[0].clone(), want.deflection.clone()), "seed {seed}");
        let (tau, _) = run(0.1);
        let expected: Vec<f64> = want.tau[0].iter().map(|t| t + 0.3).collect();
        assert_close("tau", &format!("seed {seed}"), &tau, &expected, 1e-9);
    }
}

/// The rigid robot under computed torque has the accelerations asked for and those of its errors.
#[test]
fn computed_torque_decouples_the_rigid_robot() {
    let options = Options { floating: 0.0, ..arms(0.5) };
    for seed in 0..40 {
        let robot = RandomRobot::new(seed, &options);
        let core = Core::<f64>::new(&robot.spec(), Fidelity::Rigid);
        let (model, nv, s) = (core.model(), core.model().nv(), robot.state(0));
        let desired = robot.state(1);
        let (kp, kd) = (vec![100.0; nv], vec![20.0; nv]);
        let (mut qdd, mut tau_j, mut tau) = (desired.qdd.clone(), vec![0.0; nv], vec![0.0; nv]);
        let law = ComputedTorque { kp: &kp, kd: &kd };
        let (to, at) = (Joints { q: &desired.q, qd: &desired.qd }, Joints { q: &s.q, qd: &s.qd });
        let mut scratch = vec![RneaScratch::new(); model.bodies().len()];
        law.torque(&model, to, at, &mut qdd, &mut scratch, &mut tau_j, &mut tau).expect("it fits");
        let moved = gyroflex_testkit::State { tau, tau_ext: Vec::new(), wrenches: Vec::new(), ..s.clone() };
        let got = core.forward(&moved).qdd;
        let error = |k: usize| 100.0 * (desired.q[k] - s.q[k]) + 20.0 * (desired.qd[k] - s.qd[k]);
        let want: Vec<f64> = (0..nv).map(|k| desired.qdd[k] + error(k)).collect();
        assert_close("qdd", &format!("seed {seed}"), &got, &want, 1e-8);
    }
}
