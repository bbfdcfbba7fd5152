//! The robots that come with the project.

use gyroflex::model::{Fidelity, SpringSpec, TransmissionSpec};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::robot::Robot;
use gyroflex_testkit::dense::Oracle;
use gyroflex_testkit::tolerance::{assert_close, assert_close_above, norm};
use gyroflex_testkit::{State as Point, random::random_point};
use gyroflex_tests::Core;
use std::path::PathBuf;

fn robot(file: &str) -> Robot {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots").join(file);
    load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

const ALL: [&str; 15] = [
    "biped5/robot.yaml",
    "biped5_elastic/robot.yaml",
    "book_two_link/robot.yaml",
    "book_two_link/elastic.yaml",
    "deluca_siciliano/robot.yaml",
    "four_bar/robot.yaml",
    "iiwa14/robot.yaml",
    "iiwa14/lossless.yaml",
    "lwr/robot.yaml",
    "lwr/loaded.yaml",
    "lwr/undamped.yaml",
    "manutec_r3/robot.yaml",
    "planar_3r/robot.yaml",
    "puma560/robot.yaml",
    "single_link/robot.yaml",
];

#[test]
fn every_robot_in_every_model_equals_its_dense_oracle() {
    for file in ALL {
        let robot = robot(file);
        for fidelity in Fidelity::ALL {
            for seed in 0..20 {
                let s = random_point(&robot.bodies, &robot.spring_tables, seed);
                let (core, oracle) = (Core::<f64>::new(&robot.spec(), fidelity), Oracle::new(robot.spec(), fidelity));
                let context = format!("{file}, {}, state {seed}", fidelity.name());
                let (got, want) = (core.forward(&s), oracle.forward(&s));
                assert_close("qdd", &context, &got.qdd, &want.qdd, 1e-10);
                assert_close("thetadd", &context, &got.thetadd, &want.thetadd, 1e-10);
                assert_close_above("tau_j", &context, &got.tau_j, &want.tau_j, 1e-10, norm(&s.tau));
                let (got, want) = (core.inverse(&s), oracle.inverse(&s));
                assert_close("inverse tau_j", &context, &got.tau_j, &want.tau_j, 1e-10);
                assert_close("inverse tau", &context, &got.tau, &want.tau, 1e-10);
            }
        }
    }
}

/// The torques at the start pose with the load that `robots/manutec_r3/README.md` derives from its source.
#[test]
fn manutec_r3_is_held_by_the_published_torques() {
    let robot = robot("manutec_r3/robot.yaml");
    let q: Vec<f64> = [-60.0, 20.0, 90.0, 0.0, -110.0, 0.0_f64].iter().map(|a| a.to_radians()).collect();
    let zero = vec![0.0; 6];
    let s = Point {
        theta: q.clone(),
        q,
        qd: zero.clone(),
        thetad: zero.clone(),
        qdd: zero.clone(),
        thetadd: zero.clone(),
        tau: zero,
        tau_ext: Vec::new(),
        wrenches: Vec::new(),
    };
    for fidelity in Fidelity::ALL {
        let held = Core::<f64>::new(&robot.spec(), fidelity).inverse(&s).tau_j;
        for (got, want) in [(held[1], -460.5734), (held[2], -256.4001)] {
            assert!((got - want).abs() < 5.001e-5, "{}: {got} for {want}", fidelity.name());
        }
    }
}

/// The axis of a rotor stands across the axis of the joint before, to the last bit and at every pose.
#[test]
fn neighbouring_rotors_of_the_lwr_do_not_couple_at_all() {
    for file in ["lwr/robot.yaml", "lwr/undamped.yaml"] {
        let robot = robot(file);
        let model = robot.model(Fidelity::Complete).unwrap_or_else(|e| panic!("{e}"));
        let mut dynamics = gyroflex_sim::Dynamics::new(model);
        for seed in 0..20 {
            let q = random_point(&robot.bodies, &robot.spring_tables, seed).q;
            let mut s = vec![0.0; 49];
            dynamics.coupling(&q, &mut s).unwrap_or_else(|e| panic!("{e}"));
            for (i, row) in s.chunks(7).enumerate() {
                assert!(row[..(i + 2).min(7)].iter().all(|x| *x == 0.0), "{file}, row {i}: {row:?}");
                assert!(row.iter().skip(i + 2).all(|x| *x != 0.0), "{file}, row {i}: {row:?}");
            }
        }
    }
}

/// A robot at a pose with springs that carry its weight, and nothing else that acts.
fn let_go(robot: &Robot, core: &Core<f64>, q: &[f64]) -> Point {
    let zero = vec![0.0; q.len()];
    let mut s = Point {
        q: q.to_vec(),
        qd: zero.clone(),
        theta: q.to_vec(),
        thetad: zero.clone(),
        qdd: zero.clone(),
        thetadd: zero.clone(),
        tau: zero,
        ..Point::default()
    };
    let weight = core.inverse(&s).tau_j;
    for (i, body) in robot.bodies.iter().enumerate() {
        if let Some(TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, .. }) =
            body.drive.map(|d| d.transmission)
        {
            s.theta[i] += weight[i] / stiffness;
        }
    }
    s
}

/// Robots without friction and damping, where they are let go, and a step that leaves errors well above rounding and well
/// below the period of the fastest mode.
fn lossless() -> [(&'static str, Vec<f64>, f64); 2] {
    [
        ("planar_3r/robot.yaml", vec![0.5, -0.8, 0.6], 2e-4),
        ("iiwa14/lossless.yaml", vec![0.2, 0.8, 0.3, -1.2, 0.4, 0.9, 0.0], 2.5e-5),
    ]
}

/// Relative to the largest kinetic energy on the way.
#[test]
fn lossless_fall_of_ten_seconds_keeps_the_energy_to_1e_6() {
    for (file, q, _) in lossless() {
        let robot = robot(file);
        let core = Core::<f64>::new(&robot.spec(), Fidelity::Complete);
        let mut s = let_go(&robot, &core, &q);
        let total = |s: &Point| {
            let e = core.energy(s);
            e.kinetic + e.gravity + e.elastic
        };
        let start = total(&s);
        let (mut drift, mut largest) = (0.0_f64, 0.0_f64);
        for _ in 0..1000 {
            s = core.integrate(&s, 1e-4, 100);
            drift = drift.max((total(&s) - start).abs());
            largest = largest.max(core.energy(&s).kinetic);
        }
        assert!(drift < 1e-6 * largest, "{file}: {drift} J of {largest} J");
    }
}

/// Half the step, a sixteenth of the error; from slack springs, so that every mode rings.
#[test]
fn runge_kutta_converges_with_fourth_order() {
    for (file, q, step) in lossless() {
        let robot = robot(file);
        let core = Core::<f64>::new(&robot.spec(), Fidelity::Complete);
        let slack = Point { theta: q.clone(), ..let_go(&robot, &core, &q) };
        let end = |step: f64| {
            let s = core.integrate(&slack, step, (0.5 / step).round() as usize);
            [s.q, s.theta].concat()
        };
        let [a, b, c] = [step, step / 2.0, step / 4.0].map(end);
        let apart = |x: &[f64], y: &[f64]| norm(&x.iter().zip(y).map(|(x, y)| x - y).collect::<Vec<_>>());
        let ratio = apart(&a, &b) / apart(&b, &c);
        assert!((15.0..18.0).contains(&ratio), "{file}: {ratio}");
    }
}
