//! Laws of constraints that are always in force.

use crate::robots::{G, close, energy, joint, link, robot, run};
use gyroflex_sim::Robot;

/// A point mass on a rod: two sliding joints for the mass, and a rod that weighs next to nothing on a pivot, its end held to the mass.
fn held_pendulum(length: f64) -> Robot {
    let urdf = [
        "<robot name=\"held\"><link name=\"world\"/><link name=\"across\"/>".to_owned(),
        joint("x", "prismatic", ["world", "across"], [0.0; 3], "1 0 0"),
        joint("z", "prismatic", ["across", "ball"], [0.0; 3], "0 0 1"),
        link("ball", 2.0, [0.0; 3], 1e-3),
        joint("pivot", "revolute", ["world", "rod"], [0.0; 3], "0 1 0"),
        link("rod", 1e-9, [0.0; 3], 1e-9),
        "</robot>".to_owned(),
    ];
    let yaml = format!("constraints: {{end: {{link: rod, xyz: [0, 0, {}], to: {{link: ball}}, directions: planar_point}}}}", -length);
    robot(&urdf.concat(), &yaml)
}

fn pendulum(length: f64) -> Robot {
    let urdf = [
        "<robot name=\"pendulum\"><link name=\"world\"/>".to_owned(),
        joint("pivot", "revolute", ["world", "rod"], [0.0; 3], "0 1 0"),
        link("rod", 2.0, [0.0, 0.0, -length], 1e-12),
        "</robot>".to_owned(),
    ];
    robot(&urdf.concat(), "")
}

#[test]
fn mass_on_a_held_rod_swings_as_a_pendulum() {
    let (length, angle) = (0.7_f64, 1.2_f64);
    let rest = "log: {rate: 100}\nintegrator: {method: rk4, step: 5e-4}";
    let (x, z) = (-length * angle.sin(), -length * angle.cos());
    let held = run(&held_pendulum(length), &format!("duration: 2.0\ninitial: {{q: {{x: {x}, z: {z}, pivot: {angle}}}}}\n{rest}"));
    let free = run(&pendulum(length), &format!("duration: 2.0\ninitial: {{q: {{pivot: {angle}}}}}\n{rest}"));
    let names = held.simulation.coordinates().joints.iter().map(|j| j.name.clone()).collect::<Vec<_>>();
    let pivot = names.iter().position(|n| n == "pivot").unwrap();
    for (a, b) in held.samples.iter().zip(&free.samples) {
        close("angle", a.q[pivot], b.q[0], 1e-7);
        close("speed", a.qd[pivot], b.qd[0], 1e-6);
    }
    assert!(held.summary.constraint_drift.unwrap() < 1e-8, "{:?}", held.summary.constraint_drift);
}

/// Crank 0.2, coupler 0.5, rocker 0.4, ground 0.5 m: the crank goes round.
fn four_bar() -> Robot {
    let urdf = [
        "<robot name=\"four\"><link name=\"world\"/>".to_owned(),
        joint("crank", "continuous", ["world", "crank_link"], [0.0; 3], "0 1 0"),
        link("crank_link", 1.0, [0.1, 0.0, 0.0], 4e-3),
        joint("coupler", "continuous", ["crank_link", "coupler_link"], [0.2, 0.0, 0.0], "0 1 0"),
        link("coupler_link", 1.5, [0.25, 0.0, 0.0], 3e-2),
        joint("rocker", "continuous", ["world", "rocker_link"], [0.5, 0.0, 0.0], "0 1 0"),
        link("rocker_link", 1.2, [0.2, 0.0, 0.0], 2e-2),
        "</robot>".to_owned(),
    ];
    robot(&urdf.concat(), "constraints: {loop: {link: coupler_link, xyz: [0.5, 0, 0], to: {link: rocker_link, xyz: [0.4, 0, 0]}, directions: planar_point}}")
}

/// Angles of coupler and rocker where the crank is at `crank` [rad]; joint angles are about +y, so that z falls with them.
fn assemble(crank: f64) -> (f64, f64) {
    let (x, z) = (0.2 * crank.cos() - 0.5, -0.2 * crank.sin());
    let distance = x.hypot(z);
    // From the rocker's pivot: direction of the crank's end, and the triangle of rocker, coupler and that line.
    let inside = ((0.16 + distance * distance - 0.25) / (0.8 * distance)).acos();
    let rocker = (-z).atan2(x) - inside;
    let end = (0.5 + 0.4 * rocker.cos(), -0.4 * rocker.sin());
    let coupler = (-(end.1 - -0.2 * crank.sin())).atan2(end.0 - 0.2 * crank.cos()) - crank;
    (coupler, rocker)
}

#[test]
fn four_bar_keeps_its_loop_and_its_energy() {
    let (coupler, rocker) = assemble(0.3);
    let made = run(&four_bar(), &format!("duration: 5.0\ninitial: {{q: {{crank: 0.3, coupler: {coupler}, rocker: {rocker}}}, qd: {{crank: 9}}}}\nlog: {{rate: 200}}\nintegrator: {{method: rk4, step: 1e-3}}"));
    let drift = made.summary.constraint_drift.unwrap();
    assert!(drift < 1e-8, "{drift} m");
    let (first, last) = (energy(&made.samples[0]), energy(made.last()));
    close("energy", last, first, 1e-4 * first.abs().max(made.samples[0].kinetic_energy));
    assert!(made.last().q[0].abs() > 6.0 || made.samples.iter().any(|s| s.q[0].abs() > 6.0), "the crank goes round");
    let angle = made.last().q[0];
    let (_, rocker) = assemble(angle);
    let turn = std::f64::consts::TAU;
    let off = (made.last().q[2] - rocker + 0.5 * turn).rem_euclid(turn) - 0.5 * turn;
    close("rocker", off, 0.0, 1e-7);
}

#[test]
fn coupled_joints_keep_their_ratio() {
    let urdf = [
        "<robot name=\"gears\"><link name=\"world\"/>".to_owned(),
        joint("one", "continuous", ["world", "a"], [0.0; 3], "0 1 0"),
        link("a", 1.0, [0.1, 0.0, 0.0], 1e-2),
        joint("two", "continuous", ["world", "b"], [1.0, 0.0, 0.0], "0 1 0"),
        link("b", 0.5, [0.0; 3], 2e-2),
        "</robot>".to_owned(),
    ];
    let gears = robot(&urdf.concat(), "couplings: {mesh: {joint: two, follows: one, ratio: -2.0, offset: 0.1}}");
    let made = run(&gears, "duration: 2.0\ninitial: {q: {one: 0.2, two: -0.3}}");
    for s in &made.samples {
        close("ratio", s.q[1], -2.0 * s.q[0] + 0.1, 1e-8);
    }
    // One degree of freedom: (I + m c² + 4 I₂) φ̈ = m g c cos φ.
    let expected = G * 0.1 * 0.2_f64.cos() / (1e-2 + 0.01 + 4.0 * 2e-2);
    close("acceleration", made.samples[0].qdd[0], expected, 1e-9);
}
