//! What the models become when transmissions stiffen or rotors vanish.

use gyroflex::model::{Fidelity, Friction, RotorBody, SpringSpec, TransmissionError, TransmissionSpec};
use gyroflex_testkit::State;
use gyroflex_testkit::dense::Oracle;
use gyroflex_testkit::random::{Options, RandomRobot};
use gyroflex_testkit::tolerance::{assert_close_above, norm, relative_error, tol};
use gyroflex_tests::{Core, Trial, for_trials};

/// Elastic models and what their transmissions stiffen into.
const STIFFENED: [(Fidelity, Fidelity); 2] =
    [(Fidelity::Complete, Fidelity::Rigid), (Fidelity::Reduced, Fidelity::RigidReflected)];

/// Linear springs without damping or error.
fn plain_springs() -> Options {
    Options { cubic: 0.0, table: 0.0, transmission_error: 0.0, damping: 0.0, ..Options::default() }
}

/// Rotors that reflect 0.1 kg m², so that the fastest mode is one a fixed step can follow.
fn set_reflected_inertia(robot: &mut RandomRobot) {
    for drive in robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
        drive.rotor.inertia = 0.1 / drive.gear_ratio.powi(2);
        drive.rotor.body = drive.rotor.body.map(|b| RotorBody { transverse_inertia: drive.rotor.inertia, ..b });
    }
}

fn set_stiffness(robot: &mut RandomRobot, stiffness: f64, damping: f64) {
    for drive in robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
        if let TransmissionSpec::Elastic { .. } = drive.transmission {
            drive.transmission = TransmissionSpec::Elastic {
                spring: SpringSpec::Polynomial { stiffness, cubic: 0.0 },
                damping,
                error: TransmissionError::none(),
            };
        }
    }
}

/// The state in which motors move with their joints and every spring carries what a rigid gear would.
fn carried_as_if_rigid(robot: &RandomRobot, rigid: Fidelity, s: &State) -> State {
    let carried = Core::<f64>::new(&robot.spec(), rigid).forward(s).tau_j;
    let mut s = State { thetad: s.qd.clone(), ..s.clone() };
    let (mut iq, mut iv) = (0, 0);
    for body in &robot.bodies {
        if let Some(TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, .. }) =
            body.drive.map(|d| d.transmission)
        {
            s.theta[iv] = s.q[iq] + carried[iv] / stiffness;
        }
        (iq, iv) = (iq + body.joint.nq(), iv + body.joint.nv());
    }
    s
}

/// No inertia depends on the rotors' angles, so a spring that carries exactly the torque of a rigid gear moves exactly like
/// one, whatever its stiffness. Deflections are differences of angles: their rounding limits the agreement.
#[test]
fn transmission_that_carries_the_rigid_gears_torque_accelerates_like_it() {
    for (elastic, rigid) in STIFFENED {
        for_trials::<f64>(300, &plain_springs(), &[elastic], tol(1e-9, 0.0), |t| {
            let mut robot = t.robot.clone();
            set_stiffness(&mut robot, 300.0, 0.0);
            let s = carried_as_if_rigid(&robot, rigid, &t.state);
            let want = Core::<f64>::new(&robot.spec(), rigid).forward(&s);
            let got = Core::<f64>::new(&robot.spec(), elastic).forward(&s);
            t.assert_close("qdd", &got.qdd, &want.qdd, 1.0);
            t.assert_close("thetadd", &got.thetadd, &want.thetadd, 1.0);
            t.assert_close("tau_j", &got.tau_j, &want.tau_j, 1.0);
        });
    }
}

/// Over a stretch of time, from equal positions and velocities: ten times the stiffness, a tenth of the distance.
#[test]
fn stiffness_to_infinity_approaches_the_rigid_gear() {
    let options = Options { bodies: 2..=5, friction: 0.0, contained: 0.0, elastic: 1.0, ..plain_springs() };
    for (elastic, rigid) in STIFFENED {
        for seed in 0..12 {
            let mut robot = RandomRobot::new(seed, &options);
            if robot.bodies.iter().all(|b| b.drive.is_none()) {
                continue;
            }
            set_reflected_inertia(&mut robot);
            let start = State { wrenches: Vec::new(), tau_ext: Vec::new(), ..robot.state(0) };
            let target = end_position(&robot, rigid, &start);
            let mut distance = |stiffness: f64| {
                set_stiffness(&mut robot, stiffness, 2e-4 * stiffness);
                let s = carried_as_if_rigid(&robot, rigid, &start);
                relative_error(&end_position(&robot, elastic, &s), &target, 1.0)
            };
            let (soft, stiff) = (distance(1e5), distance(1e6));
            let context = format!("seed {seed}, {}: {soft:e} then {stiff:e}", elastic.name());
            assert!(stiff < 0.2 * soft && stiff < 1e-3, "{context}");
        }
    }
}

/// Where the robot is after 50 ms under constant torques.
fn end_position(robot: &RandomRobot, fidelity: Fidelity, start: &State) -> Vec<f64> {
    Core::<f64>::new(&robot.spec(), fidelity).integrate(start, 5e-6, 10_000).q
}

/// With rigid gears, and rotors that are part of their links, nothing is left of vanishing rotors: plain rigid dynamics.
#[test]
fn vanishing_rotors_leave_plain_rigid_dynamics() {
    let options = Options { contained: 1.0, ..Options::default() };
    for seed in 0..300 {
        let mut robot = RandomRobot::new(seed, &options);
        for drive in robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
            drive.friction = Friction::none();
            // A rotor on the world is part of nothing that moves, and may as well have no mass.
            drive.rotor.body = None;
        }
        let s = robot.state(0);
        let mut plain = robot.clone();
        for body in &mut plain.bodies {
            body.drive = None;
        }
        let want = Oracle::new(plain.spec(), Fidelity::Rigid).forward(&s).qdd;
        for fidelity in [Fidelity::Rigid, Fidelity::RigidReflected] {
            let mut shrunk = robot.clone();
            let mut distance = |factor: f64| {
                for (own, original) in shrunk.bodies.iter_mut().zip(&robot.bodies) {
                    if let (Some(own), Some(original)) = (&mut own.drive, &original.drive) {
                        own.rotor.inertia = original.rotor.inertia * factor;
                    }
                }
                let got = Core::<f64>::new(&shrunk.spec(), fidelity).forward(&s).qdd;
                assert_close_above("qdd", &format!("seed {seed}"), &got, &want, f64::MAX, 0.0);
                relative_error(&got, &want, norm(&want))
            };
            let (small, smaller) = (distance(1e-7), distance(1e-9));
            // In proportion, until rounding takes over.
            let context = format!("seed {seed}, {}: {small:e} then {smaller:e}", fidelity.name());
            assert!(smaller < 0.02 * small + 1e-11 && smaller < 1e-4, "{context}");
        }
    }
}

#[test]
fn models_of_a_robot_without_drives_are_one_and_the_same() {
    let options = Options { driven: 0.0, ..Options::default() };
    for_trials::<f64>(100, &options, &[Fidelity::Complete], tol(0.0, 0.0), |t| {
        let complete = t.core.forward(&t.state);
        for fidelity in Fidelity::ALL {
            let other = Trial::<f64>::new(t.robot, fidelity, t.state.clone(), tol(0.0, 0.0));
            t.assert_close("qdd", &other.core.forward(&other.state).qdd, &complete.qdd, 0.0);
        }
    });
}
