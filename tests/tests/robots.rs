//! The robots that come with the project.

use gyroflex::dynamics::{External, State};
use gyroflex::integrate::StateMut;
use gyroflex::model::{Fidelity, SpringSpec, TransmissionSpec};
use gyroflex_sim::dynamics::Dynamics;
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

const ALL: [&str; 6] = [
    "iiwa14/robot.yaml",
    "iiwa14/lossless.yaml",
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

/// A robot let go from a pose with springs that carry its weight and idle motors.
struct Falling {
    dynamics: Dynamics,
    q: Vec<f64>,
    qd: Vec<f64>,
    theta: Vec<f64>,
    thetad: Vec<f64>,
}

impl Falling {
    fn new(robot: &Robot, q: &[f64]) -> Self {
        let mut dynamics = Dynamics::new(robot.model(Fidelity::Complete).unwrap_or_else(|e| panic!("{e}")));
        let n = q.len();
        let zero = vec![0.0; n];
        let (mut tau_j, mut tau) = (zero.clone(), zero.clone());
        let rest = State { q, qd: &zero, theta: q, thetad: &zero };
        let still = gyroflex::dynamics::Acceleration { qdd: &zero, thetadd: &zero };
        let out = gyroflex::dynamics::Inverse { tau_j: &mut tau_j, tau: &mut tau };
        dynamics.inverse(rest, still, External::none(), out).expect("slices fit the model");
        let deflection = |i: usize| match robot.bodies[i].drive.map(|d| d.transmission) {
            Some(TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, .. }) => {
                tau_j[i] / stiffness
            }
            _ => panic!("all joints of this robot are elastic"),
        };
        let theta = (0..n).map(|i| q[i] + deflection(i)).collect();
        Self { dynamics, q: q.to_vec(), qd: zero.clone(), theta, thetad: zero }
    }

    fn fall(&mut self, step: f64) {
        let tau = vec![0.0; self.qd.len()];
        let state = StateMut { q: &mut self.q, qd: &mut self.qd, theta: &mut self.theta, thetad: &mut self.thetad };
        self.dynamics.rk4(state, &tau, External::none(), step).expect("slices fit the model");
    }

    /// Total and kinetic energy.
    fn energy(&mut self) -> (f64, f64) {
        let state = State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad };
        let e = self.dynamics.energy(state).expect("slices fit the model");
        (e.kinetic + e.gravity + e.elastic, e.kinetic)
    }
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
        let mut falling = Falling::new(&robot(file), &q);
        let start = falling.energy().0;
        let (mut drift, mut largest) = (0.0_f64, 0.0_f64);
        for _ in 0..1000 {
            for _ in 0..100 {
                falling.fall(1e-4);
            }
            let (total, kinetic) = falling.energy();
            drift = drift.max((total - start).abs());
            largest = largest.max(kinetic);
        }
        assert!(drift < 1e-6 * largest, "{file}: {drift} J of {largest} J");
    }
}

/// Half the step, a sixteenth of the error; from slack springs, so that every mode rings.
#[test]
fn runge_kutta_converges_with_fourth_order() {
    for (file, q, step) in lossless() {
        let end = |step: f64| {
            let mut falling = Falling::new(&robot(file), &q);
            falling.theta.clone_from(&falling.q);
            for _ in 0..(0.5 / step).round() as usize {
                falling.fall(step);
            }
            [falling.q, falling.theta].concat()
        };
        let [a, b, c] = [step, step / 2.0, step / 4.0].map(end);
        let apart = |x: &[f64], y: &[f64]| norm(&x.iter().zip(y).map(|(x, y)| x - y).collect::<Vec<_>>());
        let ratio = apart(&a, &b) / apart(&b, &c);
        assert!((15.0..18.0).contains(&ratio), "{file}: {ratio}");
    }
}
