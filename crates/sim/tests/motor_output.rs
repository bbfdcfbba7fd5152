//! Laws of the inverse for the motors' motion.

mod arm;

use gyroflex::control::reference::PointToPoint;
use gyroflex::dynamics::{External, Forward, State};
use gyroflex::model::{SpringSpec, TransmissionSpec};
use gyroflex_sim::coordinates::Coordinates;
use gyroflex_sim::equilibrium::Equilibrium;
use gyroflex_sim::inverse::{InverseModel, MotorOutput, ReferenceInverse};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::record::MemoryRecorder;
use gyroflex_sim::reference::{References, Trajectory};
use gyroflex_sim::scenario::SineTerm;
use gyroflex_sim::{Dynamics, Error, Fidelity, Robot, ScenarioFile, Simulation};
use std::ops::ControlFlow;
use std::path::Path;

fn robot(name: &str) -> Robot {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name);
    load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// An arm with a stiffening spring, an error of its gear, a rigid joint and a plain one; arms whose rotors couple, damped and not, complete
/// and reduced; one with friction.
fn robots() -> Vec<(String, Robot)> {
    let mut all = vec![("arm".to_owned(), arm::arm(false))];
    for name in ["lwr/loaded.yaml", "lwr/undamped.yaml", "manutec_r3/robot.yaml"] {
        for fidelity in [Fidelity::Complete, Fidelity::Reduced, Fidelity::Rigid] {
            let mut robot = robot(name);
            robot.fidelity = fidelity;
            all.push((format!("{name}, {}", fidelity.name()), robot));
        }
    }
    all
}

/// Each joint on a sine of its own.
fn sines(n: usize) -> References {
    let trajectory = |i: usize| Trajectory::Sines {
        offset: 0.3 - 0.2 * i as f64,
        terms: vec![SineTerm { amplitude: 0.3, frequency: 0.4 + 0.13 * i as f64, phase: i as f64 }],
    };
    References::new((0..n).map(trajectory).collect())
}

fn file(yaml: &str) -> ScenarioFile {
    ScenarioFile::parse(&format!("robot: x\n{yaml}"), Path::new("x.yaml")).unwrap_or_else(|e| panic!("{e}"))
}

fn prescribe(robot: &Robot, references: &References) -> Result<MotorOutput, Error> {
    let model = robot.model(robot.fidelity).expect("the robot is valid");
    MotorOutput::new(model, &Coordinates::of(robot), references, &file("duration: 1").keys)
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// The oracle is the articulated-body algorithm, of which the inverse uses no part.
#[test]
fn forward_dynamics_under_the_torque_accelerates_links_and_motors_as_found() {
    for (name, robot) in robots() {
        let references = sines(robot.joints.len());
        let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
        let mut along = prescribe(&robot, &references).unwrap();
        along.start(&references).unwrap();
        for i in 0..6 {
            let t = 0.01 * f64::from(i);
            along.at(&references, t).unwrap();
            let state = State { q: along.q(), qd: along.qd(), theta: along.theta(), thetad: along.thetad() };
            let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; dynamics.nv()]);
            let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
            dynamics.forward(state, along.tau(), External::none(), out).unwrap();
            for (what, got, want) in [("q̈", along.qdd(), &qdd), ("θ̈", along.thetadd(), &thetadd)] {
                let apart = worst(got, want) / (1.0 + largest(want));
                assert!(apart < 1e-8, "{name}, t = {t}: {what} is {got:?}, not {want:?}");
            }
            along.advance(&references, t, 0.01).unwrap();
        }
    }
}

/// The oracle solves for one equilibrium after the other; rates are differences between them.
#[test]
fn motors_are_led_through_the_equilibria_of_the_reference() {
    for (name, robot) in robots() {
        let n = robot.joints.len();
        let references = sines(n);
        let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
        let mut rest = |t: f64| {
            let q: Vec<f64> = (0..n).map(|i| references.point(i, t).q).collect();
            let (mut theta, mut tau) = (vec![0.0; n], vec![0.0; n]);
            Equilibrium::new(n).solve(&mut dynamics, &q, External::none(), &mut theta, &mut tau).unwrap();
            theta
        };
        let mut along = prescribe(&robot, &references).unwrap();
        for t in [0.0, 0.37, 1.4] {
            along.at(&references, t).unwrap();
            // Five points: the error of a gear has many cycles.
            let h = 1e-4;
            let at = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|i| rest(t + i * h));
            let weigh = |weights: [f64; 5], size: f64| -> Vec<f64> {
                (0..n).map(|j| weights.iter().zip(&at).map(|(w, at)| w * at[j]).sum::<f64>() / (12.0 * size)).collect()
            };
            let (now, first) = (&at[2], weigh([1.0, -8.0, 0.0, 8.0, -1.0], h));
            let second = weigh([-1.0, 16.0, -30.0, 16.0, -1.0], h * h);
            assert!(worst(along.theta(), now) < 1e-12, "{name}");
            assert!(worst(along.thetad(), &first) < 1e-6, "{name}: θ̇ {:?}, not {first:?}", along.thetad());
            assert!(worst(along.thetadd(), &second) < 1e-5, "{name}: θ̈ {:?}, not {second:?}", along.thetadd());
        }
    }
}

/// The whole robot under the torque alone, without feedback: motors where they are led, links where the inverse has them.
#[test]
fn open_loop_torque_moves_motors_and_links_as_the_inverse_says() {
    for name in ["lwr/robot.yaml", "lwr/undamped.yaml"] {
        let robot = robot(name);
        let (n, step) = (robot.joints.len(), 5e-5);
        let motion = |i: usize| {
            PointToPoint::new(0.1 * i as f64, 0.5 - 0.1 * i as f64, 0.01, 0.08, 2).map(Trajectory::Polynomial)
        };
        let references = References::new((0..n).map(|i| motion(i).unwrap()).collect());
        let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
        let mut along = prescribe(&robot, &references).unwrap();
        along.start(&references).unwrap();
        let mut y = [along.q(), along.theta(), along.qd(), along.thetad()].concat();
        let mut moved: f64 = 0.0;
        for i in 0..2000 {
            let t = f64::from(i) * step;
            let mut torques = Vec::new();
            for half in 0..3 {
                along.at(&references, t + 0.5 * f64::from(half) * step).unwrap();
                torques.push(along.tau().to_vec());
                if half < 2 {
                    along.advance(&references, t + 0.5 * f64::from(half) * step, 0.5 * step).unwrap();
                }
            }
            let mut rate = |y: &[f64], tau: &[f64]| {
                let part = |i: usize| &y[i * n..(i + 1) * n];
                let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; n]);
                let state = State { q: part(0), qd: part(2), theta: part(1), thetad: part(3) };
                let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
                dynamics.forward(state, tau, External::none(), out).unwrap();
                [part(2), part(3), &qdd, &thetadd].concat()
            };
            let to = |k: &[f64], h: f64| y.iter().zip(k).map(|(y, k)| y + h * k).collect::<Vec<_>>();
            let k1 = rate(&y, &torques[0]);
            let k2 = rate(&to(&k1, 0.5 * step), &torques[1]);
            let k3 = rate(&to(&k2, 0.5 * step), &torques[1]);
            let k4 = rate(&to(&k3, step), &torques[2]);
            for (j, y) in y.iter_mut().enumerate() {
                *y += step / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]);
            }
            let t = t + step;
            let apart = worst(&y[..n], along.q()).max(worst(&y[n..2 * n], along.theta()));
            assert!(apart < 1e-7, "{name}, t = {t}: {apart} rad");
            moved = moved.max((0..n).map(|i| (along.q()[i] - references.point(i, t).q).abs()).fold(0.0, f64::max));
        }
        assert!(moved > 1e-5, "{name}: the links do not swing, only {moved} rad");
    }
}

#[test]
fn links_at_rest_on_the_reference_stay_there() {
    for (name, robot) in robots() {
        let n = robot.joints.len();
        let references = References::new((0..n).map(|i| Trajectory::Hold(0.7 - 0.3 * i as f64)).collect());
        let mut along = prescribe(&robot, &references).unwrap();
        along.start(&references).unwrap();
        along.advance(&references, 0.0, 0.02).unwrap();
        along.at(&references, 0.02).unwrap();
        let apart = (0..n).map(|i| (along.q()[i] - references.point(i, 0.0).q).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-10, "{name}: {apart}");
    }
}

/// With stiffness `K` the links are off by `O(1/K)`, and so is the torque.
#[test]
fn torque_comes_to_that_of_the_links_inverse_as_springs_grow_stiff() {
    let n = 7;
    let motion = |i: usize| PointToPoint::new(0.2, 0.6 - 0.1 * i as f64, 0.0, 0.2, 8).map(Trajectory::Polynomial);
    let references = References::new((0..n).map(|i| motion(i).unwrap()).collect());
    let apart = [4.0, 16.0, 64.0].map(|factor: f64| {
        let mut robot = robot("lwr/robot.yaml");
        for drive in robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
            let TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, damping, .. } =
                &mut drive.transmission
            else {
                continue;
            };
            // The time constant of the transmission gets shorter with it, so that it fades in either case.
            (*stiffness, *damping) = (*stiffness * factor, *damping * factor.sqrt());
        }
        let inverse = InverseModel::new(&robot, robot.fidelity, 0).unwrap();
        let keys = file("duration: 1").keys;
        let mut links = ReferenceInverse::new(inverse, &Coordinates::of(&robot), &references, &keys).unwrap();
        links.start(&references).unwrap();
        let mut motors = prescribe(&robot, &references).unwrap();
        motors.start(&references).unwrap();
        let (step, mut most, mut size) = (1e-4, 0.0_f64, 0.0_f64);
        for i in 0..1000 {
            let t = f64::from(i) * step;
            links.at(&references, t, step).unwrap();
            motors.at(&references, t).unwrap();
            most = most.max(worst(motors.tau(), links.inverse().tau(0)));
            size = size.max(largest(motors.tau()));
            links.advance();
            motors.advance(&references, t, step).unwrap();
        }
        most / size
    });
    println!("{apart:?}");
    for pair in apart.windows(2) {
        assert!((3.0..6.0).contains(&(pair[0] / pair[1])), "a quarter is to be left each time: {apart:?}");
    }
    assert!(apart[2] < 0.03, "{apart:?}");
}

#[test]
fn rough_references_and_floating_roots_are_refused() {
    let robot = robot("lwr/undamped.yaml");
    let yaml = |order: usize| {
        format!(
            "duration: 1\nreference: {{default: {{type: filtered_step, from: 0, to: 1, order: {order}, cutoff: 5}}}}"
        )
    };
    let of = |order: usize| {
        let (joints, file) = (Coordinates::of(&robot), file(&yaml(order)));
        References::of(&file, &robot, &joints, &[None; 7], &mut Vec::new()).unwrap()
    };
    assert!(prescribe(&robot, &of(2)).is_ok());
    let error = prescribe(&robot, &of(1)).expect_err("one derivative is too few").to_string();
    for part in ["`joint1` needs 2 and has 1", "`joint7` needs 2 and has 1", "remedy: use `filtered_step`"] {
        assert!(error.contains(part), "{part}: {error}");
    }
    let error = prescribe(&arm::arm(true), &sines(3)).expect_err("the root floats");
    assert!(error.problem.contains("floats"), "{error}");
}

/// The controllers for an undamped arm on a reference whose third derivative jumps, where the links' inverse needs ten.
#[test]
fn controllers_follow_the_motors_of_an_undamped_robot() {
    let robot = robot("lwr/undamped.yaml");
    let deviations = "{link_position: 0.01, link_velocity: 0.1, motor_position: 0.01, motor_velocity: 0.1, torque: 50}";
    let laws =
        ["type: two_degree_of_freedom, kp: 2000, kd: 100".to_owned(), format!("type: lqr, deviations: {deviations}")];
    for law in laws {
        let yaml = |output: &str| {
            file(&format!(
                "duration: 0.4\n\
                 reference: {{default: {{type: filtered_step, from: 0.2, to: 0.3, order: 3, cutoff: 1.5}}}}\n\
                 controller: {{{law}, rate: 2000, inverse: {{output: {output}}}}}\n\
                 integrator: {{method: rk4, step: 5.0e-5}}\nlog: {{rate: 100}}"
            ))
        };
        let refused = Simulation::new(&robot, &yaml("link")).expect_err("the reference is too rough");
        assert!(refused.problem.contains("needs 10 and has 3"), "{refused}");
        let file = yaml("motor");
        let mut simulation = Simulation::new(&robot, &file).unwrap_or_else(|e| panic!("{law}: {e}"));
        let mut record = MemoryRecorder::new(simulation.run_info());
        simulation.run(&mut record, &mut |_| ControlFlow::Continue(())).unwrap_or_else(|e| panic!("{law}: {e}"));
        let joints = Coordinates::of(&robot);
        let references = References::of(&file, &robot, &joints, &[None; 7], &mut Vec::new()).unwrap();
        let mut along = prescribe(&robot, &references).unwrap();
        let mut most = 0.0_f64;
        for sample in record.samples() {
            along.at(&references, sample.t).unwrap();
            most = most.max(worst(&sample.theta, along.theta()));
        }
        println!("{law}: motors within {most} rad");
        assert!(most < 2e-4, "{law}: motors {most} rad from where they are led");
    }
}
