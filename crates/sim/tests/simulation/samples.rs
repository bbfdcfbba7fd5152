//! Laws of what a sample holds.

use crate::arm::{arm, distance, flying_arm, run, with_drives};
use gyroflex::dynamics::{Acceleration, External, Inverse, State};
use gyroflex::model::{Fidelity, Friction, JointKind};
use gyroflex::spatial::{Transform, Vec3};
use gyroflex_sim::{Dynamics, Robot};

const SWING: &str = "duration: 0.2\ninitial: {q: [0.3, -0.4, 0.8], qd: [1, -2, 3]}\nlog: {rate: 100}\n
controller: {type: pd, kp: 50, kd: 2}\nreference: {default: {type: sine, amplitude: 0.2, frequency: 1}}\n";

/// What the transmissions carry, less what they would carry with the same links and resting rotors.
#[test]
fn gyroscopic_torque_is_the_part_of_the_rotors() {
    let (_, samples, _) = run(&arm(3), SWING);
    let mut dynamics = Dynamics::new(arm(3).model(Fidelity::Complete).unwrap());
    let mut largest: f64 = 0.0;
    for s in &samples {
        let mut carried = |thetad: &[f64], thetadd: &[f64]| {
            let (mut tau_j, mut tau) = ([0.0; 3], [0.0; 3]);
            let state = State { q: &s.q, qd: &s.qd, theta: &s.theta, thetad };
            let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
            dynamics.inverse(state, Acceleration { qdd: &s.qdd, thetadd }, External::none(), out).unwrap();
            tau_j
        };
        let (with, without) = (carried(&s.thetad, &s.thetadd), carried(&[0.0; 3], &[0.0; 3]));
        assert!(distance(&with, &s.tau_j) < 1e-9, "inverse of forward at {}", s.t);
        for i in 0..3 {
            assert!((s.gyroscopic[i] - (with[i] - without[i])).abs() < 1e-9, "joint {i} at {}", s.t);
            largest = largest.max(s.gyroscopic[i].abs());
        }
    }
    assert!(largest > 1e-3, "nothing to see: {largest}");
}

#[test]
fn reduced_models_have_no_gyroscopic_torque() {
    for fidelity in [Fidelity::Reduced, Fidelity::RigidReflected] {
        let (_, samples, _) = run(&Robot { fidelity, ..arm(3) }, SWING);
        assert!(samples.iter().all(|s| s.gyroscopic.iter().all(|g| *g == 0.0) && s.significance == 0.0));
    }
}

/// What goes in less what is lost is what the energy gains, by Simpson's rule over each pair of samples.
#[test]
fn logged_energy_gains_what_the_logged_powers_say() {
    let robot = with_drives(arm(3), |d| d.friction = Friction::viscous(1e-4));
    // One tick of the controller spans the run, so that the powers are smooth.
    let yaml = "duration: 0.2\ninitial: {q: [0.3, -0.4, 0.8], qd: [1, -2, 3]}\nlog: {rate: 2000}
reference: {default: {type: hold, at: 0.0}}\ncontroller: {type: pd, rate: 1, kp: 50, kd: 2}";
    let (_, samples, _) = run(&robot, yaml);
    let energy = |i: usize| samples[i].kinetic_energy + samples[i].gravity_energy + samples[i].elastic_energy;
    let net = |i: usize| samples[i].power_in - samples[i].dissipation;
    let (mut work, h) = (0.0, 1.0 / 2000.0);
    for i in (2..samples.len()).step_by(2) {
        work += h / 3.0 * (net(i - 2) + 4.0 * net(i - 1) + net(i));
        let gained = energy(i) - energy(0);
        assert!((gained - work).abs() < 1e-6, "{gained} is not {work} at {}", samples[i].t);
    }
    assert!(work.abs() > 0.1);
}

#[test]
fn frames_lead_from_the_world_to_every_link() {
    for robot in [arm(3), flying_arm(3)] {
        let yaml = "duration: 0.1\ninitial: {qd: {joint2: 1, joint3: -1}}\nlog: {rate: 100}";
        let (_, samples, simulation) = run(&robot, yaml);
        let s = &samples[samples.len() - 1];
        let dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
        let mut placements = vec![Transform::identity(); robot.bodies.len()];
        dynamics.placements(&simulation.state().q, &mut placements).unwrap();
        let mut pose = Transform::identity();
        for (i, link) in robot.links.iter().enumerate() {
            pose = s.frames[i].after(pose);
            let want = link.body.map_or(Transform::identity(), |b| placements[b]);
            assert!((pose.pos - want.pos).norm() < 1e-12);
            for (a, b) in pose.rot.rows.iter().zip(&want.rot.rows) {
                assert!((*a - *b).norm() < 1e-12);
            }
        }
    }
}

#[test]
fn floating_root_logs_pose_and_twist() {
    let yaml = "duration: 1\ninitial: {base: {xyz: [1, 2, 3], rpy: [0.1, 0.2, 0.3], twist: [0, 0, 0, 0, 0, 0]}}\nlog: {rate: 10}";
    let (_, samples, _) = run(&flying_arm(1), yaml);
    let [x, y, z, qx, qy, qz, qw] = samples[10].base_pose.unwrap();
    // A body at rest falls without turning; its frame's origin with it.
    assert!((x - 1.0).abs() < 1e-12 && (y - 2.0).abs() < 1e-12);
    assert!((z - (3.0 - 9.81 / 2.0)).abs() < 1e-9, "{z}");
    assert!((qx * qx + qy * qy + qz * qz + qw * qw - 1.0).abs() < 1e-14);
    let start = samples[0].base_pose.unwrap();
    assert!(distance(&start[3..], &[qx, qy, qz, qw]) < 1e-12);
    // Roll, pitch, yaw as in URDF: rotation z(0.3) y(0.2) x(0.1) of the root's frame.
    let want = {
        let half = |a: f64| (a / 2.0).sin_cos();
        let mul = |a: [f64; 4], b: [f64; 4]| {
            let ([ax, ay, az, aw], [bx, by, bz, bw]) = (a, b);
            [
                aw * bx + ax * bw + ay * bz - az * by,
                aw * by - ax * bz + ay * bw + az * bx,
                aw * bz + ax * by - ay * bx + az * bw,
                aw * bw - ax * bx - ay * by - az * bz,
            ]
        };
        let (x, y, z) = (half(0.1), half(0.2), half(0.3));
        mul(mul([0.0, 0.0, z.0, z.1], [0.0, y.0, 0.0, y.1]), [x.0, 0.0, 0.0, x.1])
    };
    assert!(distance(&start[3..], &want) < 1e-15);
}

/// A slide along the world's x axis.
fn slide() -> Robot {
    let mut robot = arm(1);
    robot.bodies[0].joint = JointKind::Prismatic;
    robot.bodies[0].axis = Vec3::new(1.0, 0.0, 0.0);
    robot.bodies[0].drive = None;
    robot.joints[0].urdf_type = "prismatic".to_owned();
    robot
}

#[test]
fn wrench_gives_the_momentum_of_its_time_span() {
    // Start and end fall between all ticks.
    let yaml =
        "duration: 1\nlog: {rate: 10}\nwrenches: [{link: link1, force: [6, 5, 4], start: 0.12345, end: 0.7777}]\n";
    for method in ["{method: rk4, step: 0.003}", "{method: dopri5}", "{method: kvaerno5}"] {
        let (_, _, simulation) = run(&slide(), &format!("{yaml}integrator: {method}"));
        let momentum = 3.0 * simulation.state().qd[0];
        assert!((momentum - 6.0 * (0.7777 - 0.12345)).abs() < 1e-9, "{method}: {momentum}");
    }
}

/// A constant force in world axes does the work `F · Δr` on the point where it acts.
#[test]
fn work_of_a_constant_force_is_force_times_way() {
    let (force, point) = (Vec3::new(20.0, -10.0, 15.0), Vec3::new(0.3, 0.1, -0.2));
    let wrench = "wrenches: [{link: link3, force: [20, -10, 15], point: [0.3, 0.1, -0.2]}]";
    for method in ["{method: rk4, step: 1e-4}", "{method: dop853, rtol: 1e-10, atol: 1e-12}"] {
        let yaml = format!(
            "duration: 0.3\ninitial: {{q: [0.3, -0.4, 0.8]}}\nlog: {{rate: 10}}\n{wrench}\nintegrator: {method}"
        );
        let (_, samples, simulation) = run(&arm(3), &yaml);
        let dynamics = Dynamics::new(arm(3).model(Fidelity::Complete).unwrap());
        let at = |q: &[f64]| {
            let mut placements = [Transform::identity(); 3];
            dynamics.placements(q, &mut placements).unwrap();
            placements[2].point(point)
        };
        let way = at(&simulation.state().q) - at(&simulation.initial_state().q);
        let energy = |i: usize| samples[i].kinetic_energy + samples[i].gravity_energy + samples[i].elastic_energy;
        let gained = energy(samples.len() - 1) - energy(0);
        assert!((gained - force.dot(way)).abs() < 1e-6, "{method}: {gained} is not {}", force.dot(way));
        assert!(gained.abs() > 0.1);
    }
}

/// A force along the link's own axis, given in the link's axes or turned by hand, acts the same on a planar joint.
#[test]
fn link_axes_turn_with_the_link() {
    let world = "wrenches: [{link: link1, torque: [0, 7, 0]}]";
    let link = "wrenches: [{link: link1, torque: [0, 7, 0], frame: link}]";
    let lever = "wrenches: [{link: link1, force: [0, 0, -35], point: [0.2, 0, 0], frame: link}]";
    let ends = [world, link, lever].map(|w| run(&arm(1), &format!("duration: 0.5\n{w}")).2.state().q[0]);
    assert!((ends[0] - ends[1]).abs() < 1e-12 && (ends[0] - ends[2]).abs() < 1e-12, "{ends:?}");
}
