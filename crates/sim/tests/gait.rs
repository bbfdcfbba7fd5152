//! Laws of reference gaits: smooth, cyclic, with feet that stay where they are, or refused.

use gyroflex_sim::gait::{Gait, HipPath, LegLengths, Phase, Planar, PlanarGait, Posture, Side};
use gyroflex_sim::load::yaml;
use gyroflex_sim::reference::Point;

/// The legs of Mu & Wu 2004 (table 1), and a walk for them.
const GAIT: Gait = Gait {
    step_length: 0.7,
    speed: 1.0,
    double_support: 0.1,
    clearance: 0.05,
    touchdown_speed: 0.03,
    hip: HipPath { height: Some(0.43), rise: 0.03, surge: 0.015, lead: -0.02 },
    trunk_pitch: 0.05,
    leg: LegLengths { thigh: 0.302, shank: 0.332 },
};
const SOFT: Gait = Gait { touchdown_speed: 0.0, ..GAIT };
/// A slow walk with short steps, half of the time on both feet, at the default height.
const SLOW: Gait = Gait {
    step_length: 0.3,
    speed: 0.2,
    double_support: 0.75,
    clearance: 0.1,
    touchdown_speed: 0.0,
    hip: HipPath { height: None, rise: 0.0, surge: 0.0, lead: 0.02 },
    trunk_pitch: -0.1,
    leg: LegLengths { thigh: 0.4, shank: 0.35 },
};

fn points(posture: &Posture) -> [Point; 7] {
    let Posture { hip, trunk, left, right, .. } = *posture;
    [hip.x, hip.z, trunk, left.x, left.z, right.x, right.z]
}

fn numbers(point: &Point) -> [f64; 3] {
    [point.q, point.qd, point.qdd]
}

/// Instants of four steps, none of them a change of phases.
fn instants(gait: &Gait) -> impl Iterator<Item = f64> {
    let time = 4.0 * gait.step_length / gait.speed;
    (0..997).map(move |i| time * (f64::from(i) + 0.5) / 997.0)
}

/// The tip of a leg by forward kinematics: hip and knee about +y, links along −z.
fn tip(joints: &[Point; 7], side: Side, leg: &LegLengths) -> [f64; 2] {
    let (hip, knee) = match side {
        Side::Left => (joints[3].q, joints[4].q),
        Side::Right => (joints[5].q, joints[6].q),
    };
    let thigh = joints[2].q + hip;
    let shank = thigh + knee;
    let x = joints[0].q - leg.thigh * thigh.sin() - leg.shank * shank.sin();
    [x, joints[1].q - leg.thigh * thigh.cos() - leg.shank * shank.cos()]
}

#[test]
fn positions_velocities_and_accelerations_are_continuous_across_phases() {
    for gait in [SOFT, SLOW] {
        let walk = PlanarGait::new(gait).unwrap();
        for step in -2..5 {
            let start = step as f64 * gait.step_time();
            let touchdown = start + gait.single_support();
            for (t, before, after) in [
                (touchdown, (step, Phase::Single), (step, Phase::Double)),
                (start, (step - 1, Phase::Double), (step, Phase::Single)),
            ] {
                let (a, b) = (walk.during(before.0, before.1, t), walk.during(after.0, after.1, t));
                for (a, b) in points(&a).iter().zip(&points(&b)) {
                    for ((a, b), tolerance) in numbers(a).iter().zip(numbers(b)).zip([1e-13, 1e-12, 1e-10]) {
                        assert!((a - b).abs() < tolerance, "{a} {b} at {t}");
                    }
                }
            }
        }
    }
}

#[test]
fn at_touch_down_the_swing_foot_stops_from_the_touch_down_speed_and_nothing_else_jumps() {
    let walk = PlanarGait::new(GAIT).unwrap();
    let t = GAIT.single_support();
    let (before, after) = (walk.during(0, Phase::Single, t - 1e-9), walk.during(0, Phase::Double, t));
    for (i, (a, b)) in points(&before).iter().zip(&points(&after)).enumerate() {
        let jump = if i == 6 { GAIT.touchdown_speed } else { 0.0 };
        assert!((a.q - b.q).abs() < 2e-9 && (b.qd - a.qd - jump).abs() < 1e-7 && (a.qdd - b.qdd).abs() < 1e-5);
    }
}

#[test]
fn a_foot_that_has_not_found_the_ground_goes_on_downwards() {
    let walk = PlanarGait::new(GAIT).unwrap();
    let foot = walk.during(0, Phase::Single, GAIT.single_support() + 0.05).right;
    assert!((foot.z.q + 0.05 * 0.03).abs() < 1e-15 && foot.z.qd == -0.03 && foot.x.q == 0.7);
    let soft = PlanarGait::new(SOFT).unwrap().during(0, Phase::Single, GAIT.single_support() + 0.05).right;
    assert_eq!(soft, Planar::on_ground(0.7));
}

#[test]
fn feet_on_the_ground_stay_exactly_where_they_are() {
    for gait in [GAIT, SLOW] {
        let walk = PlanarGait::new(gait).unwrap();
        for t in instants(&gait) {
            let posture = walk.at(t);
            let joints = walk.joints(&posture).unwrap();
            for (side, foot) in [(Side::Left, posture.left), (Side::Right, posture.right)] {
                let [x, z] = tip(&joints, side, &gait.leg);
                assert!((x - foot.x.q).abs() < 1e-12 && (z - foot.z.q).abs() < 1e-12, "{side:?} at {t}");
                if posture.phase == Phase::Double || side == PlanarGait::stance(posture.step) {
                    let print = if side == PlanarGait::stance(posture.step) { posture.step } else { posture.step + 1 };
                    assert_eq!(foot, Planar::on_ground(walk.footprint(print)));
                }
            }
            assert!(joints[4].q > 0.0 && joints[6].q > 0.0, "knees are bent");
        }
    }
}

#[test]
fn velocities_and_accelerations_are_those_of_the_positions() {
    let h = 1e-6;
    for gait in [GAIT, SLOW] {
        let walk = PlanarGait::new(gait).unwrap();
        for t in instants(&gait) {
            let (step, phase) = walk.phase(t);
            let at = |t: f64| {
                let posture = walk.during(step, phase, t);
                let joints = walk.joints(&posture).unwrap();
                [points(&posture), joints]
            };
            let [before, now, after] = [t - h, t, t + h].map(at);
            for i in 0..14 {
                let of = |all: &[[Point; 7]; 2]| all[i / 7][i % 7];
                let [a, b, c] = [of(&before), of(&now), of(&after)];
                assert!(((c.q - a.q) / (2.0 * h) - b.qd).abs() < 1e-7 * (1.0 + b.qd.abs()), "{i} at {t}");
                assert!(((c.qd - a.qd) / (2.0 * h) - b.qdd).abs() < 1e-6 * (1.0 + b.qdd.abs()), "{i} at {t}");
            }
        }
    }
}

#[test]
fn the_swing_foot_reaches_its_clearance_and_never_the_ground() {
    for gait in [GAIT, SOFT, SLOW] {
        let walk = PlanarGait::new(gait).unwrap();
        let middle = walk.during(0, Phase::Single, 0.5 * gait.single_support()).right;
        assert!((middle.z.q - gait.clearance).abs() < 1e-15 && middle.x.q.abs() < 1e-15);
        for i in 1..1000 {
            let t = gait.single_support() * f64::from(i) / 1000.0;
            let foot = walk.at(t).right;
            assert!(foot.z.q > 0.0 && foot.x.qd > 0.0, "{t}");
        }
    }
}

#[test]
fn the_mean_speed_is_exact() {
    for gait in [GAIT, SLOW] {
        let walk = PlanarGait::new(gait).unwrap();
        for t in instants(&gait) {
            let way = walk.at(t + gait.step_time()).hip.x.q - walk.at(t).hip.x.q;
            assert!((way / gait.step_time() - gait.speed).abs() < 1e-13);
        }
    }
}

#[test]
fn a_step_later_the_legs_have_changed_and_two_steps_later_all_is_the_same() {
    for gait in [GAIT, SLOW] {
        let walk = PlanarGait::new(gait).unwrap();
        for t in instants(&gait) {
            let [now, next, then] = [0.0, 1.0, 2.0].map(|steps| {
                let joints = walk.joints(&walk.at(t + steps * gait.step_time())).unwrap();
                joints.map(|point| numbers(&point))
            });
            // The first coordinate is a step length farther each time.
            let mirror = [1, 2, 5, 6, 3, 4];
            for (i, k) in (1..7).zip(mirror) {
                for order in 0..3 {
                    let tolerance = 1e-11 * (1.0 + now[i][order].abs()) * 10_f64.powi(order as i32);
                    assert!((now[i][order] - next[k][order]).abs() < tolerance, "{i} {order} at {t}");
                    assert!((now[i][order] - then[i][order]).abs() < tolerance, "{i} {order} at {t}");
                }
            }
        }
    }
}

#[test]
fn without_a_height_the_hip_is_as_high_as_slightly_bent_knees_allow() {
    let walk = PlanarGait::new(SLOW).unwrap();
    let (mut longest, length) = (0.0_f64, 0.75);
    for t in instants(&SLOW) {
        let Posture { hip, left, right, .. } = walk.at(t);
        for foot in [left, right] {
            longest = longest.max((foot.x.q - hip.x.q).hypot(foot.z.q - hip.z.q));
        }
    }
    assert!(longest < 0.98 * length + 1e-12 && longest > 0.98 * length - 1e-4, "{longest}");
}

#[test]
fn what_cannot_be_is_refused_by_the_name_of_the_parameter_with_a_remedy() {
    let hip = GAIT.hip;
    let cases = [
        ("step_length", Gait { step_length: 0.0, ..GAIT }),
        ("speed", Gait { speed: f64::NAN, ..GAIT }),
        ("leg.thigh", Gait { leg: LegLengths { thigh: -0.3, ..GAIT.leg }, ..GAIT }),
        ("leg.shank", Gait { leg: LegLengths { shank: f64::INFINITY, ..GAIT.leg }, ..GAIT }),
        ("clearance", Gait { clearance: 0.0, ..GAIT }),
        ("trunk_pitch", Gait { trunk_pitch: f64::NAN, ..GAIT }),
        ("double_support", Gait { double_support: 0.7, ..GAIT }),
        ("double_support", Gait { double_support: 0.0, ..GAIT }),
        ("touchdown_speed", Gait { touchdown_speed: -0.1, ..GAIT }),
        ("touchdown_speed", Gait { touchdown_speed: 1.0, ..GAIT }),
        ("hip.surge", Gait { hip: HipPath { surge: 0.12, ..hip }, ..GAIT }),
        ("hip.height", Gait { hip: HipPath { height: Some(0.0), ..hip }, ..GAIT }),
        // Legs too short for the height, for the step, and too long for their own folding.
        ("hip.height", Gait { hip: HipPath { height: Some(0.5), ..hip }, ..GAIT }),
        ("step_length", Gait { step_length: 1.4, speed: 2.0, ..GAIT }),
        ("step_length", Gait { leg: LegLengths { thigh: 0.2, shank: 0.2 }, ..GAIT }),
        ("hip.height", Gait { leg: LegLengths { thigh: 0.8, shank: 0.3 }, ..GAIT }),
    ];
    for (key, gait) in cases {
        let error = PlanarGait::new(gait).expect_err(key);
        assert_eq!(error.element, key, "{error}");
        assert!(!error.problem.is_empty() && !error.remedy.is_empty(), "{error}");
    }
}

#[test]
fn the_height_that_a_refusal_names_is_accepted() {
    let high = |height| Gait { hip: HipPath { height: Some(height), ..GAIT.hip }, ..GAIT };
    let remedy = PlanarGait::new(high(0.5)).unwrap_err().remedy;
    let named: f64 = remedy.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!(named > 0.43 && PlanarGait::new(high(named)).is_ok(), "{remedy}");
    assert!(PlanarGait::new(high(named + 2e-4)).is_err(), "{remedy}");
}

#[test]
fn a_file_may_leave_out_what_has_defaults_and_nothing_else() {
    let text = "step_length: 0.3\nspeed: 0.2\ndouble_support: 0.75\nclearance: 0.1\nleg: {thigh: 0.4, shank: 0.35}\n";
    let read = yaml::parse::<Gait>(text, "gait.yaml").unwrap();
    assert_eq!((read.value.hip, read.value.trunk_pitch, read.value.touchdown_speed), (HipPath::default(), 0.0, 0.0));
    PlanarGait::of_file(read.value, &read.keys, "").unwrap();

    let error = yaml::parse::<Gait>(&text.replace("clearance", "clearence"), "gait.yaml").unwrap_err();
    assert!(error.to_string().contains("clearance"), "{error}");

    let long = yaml::parse::<Gait>(&text.replace("0.3\n", "3.0\n").replace("0.2\n", "2.0\n"), "gait.yaml").unwrap();
    let error = PlanarGait::of_file(long.value, &long.keys, "").unwrap_err();
    assert_eq!((error.file.as_str(), error.element.as_str()), ("gait.yaml:1", "step_length"));
}
