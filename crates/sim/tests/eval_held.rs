//! Laws of the calculator where something holds the robot: what is held is an external load of the size it answers, and stays where it is.

mod arm;

use arm::arm;
use gyroflex::dynamics::{Anchor, Directions, Frame, Hold};
use gyroflex::model::Fidelity;
use gyroflex::spatial::{Mat3, Transform, Vec3};
use gyroflex_sim::Robot;
use gyroflex_sim::eval::{Answer, Distribution, Evaluator, HeldAnswer, Options, Query, Wrench, WrenchAxes};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::robot::{ContactPoint, HeldPart};
use std::path::Path;

const SEEDS: std::ops::Range<u64> = 0..8;
const POINT: [f64; 3] = [0.05, -0.1, 0.2];

/// Numbers between −1 and 1 without a pattern, the same ones for the same seed.
fn numbers(seed: u64, n: usize) -> Vec<f64> {
    (0..n).map(|i| 2.0 * ((12.9898 * (seed + 1) as f64 + 78.233 * (i + 1) as f64).sin() * 43758.5453).fract()).collect()
}

/// The arm with a point of its tip that may touch the ground, held in two directions to the world if asked for, and with a coupling.
fn held_arm(floating: bool) -> Robot {
    let mut robot = arm(floating);
    let tip = robot.bodies.len() - 1;
    robot.contacts.push(ContactPoint { name: "foot".to_owned(), body: tip, point: Vec3::from(POINT) });
    let frame = Frame { body: tip, placement: Transform { pos: Vec3::from(POINT), ..Transform::identity() } };
    let turned = Transform::from_pose(Mat3::from_rpy(0.2, -0.5, 0.3), Vec3::new(0.1, 0.2, 0.9));
    let hold =
        Hold::Frame { frame, anchor: Anchor { body: None, placement: turned }, directions: Directions::of(&[0, 4]) };
    robot.held.push(HeldPart { name: "rail".to_owned(), hold, stabilisation: 7.0 });
    let hold = Hold::Joints { joint: tip, follows: tip - 1, ratio: -0.4, offset: 0.1 };
    robot.held.push(HeldPart { name: "belt".to_owned(), hold, stabilisation: 3.0 });
    robot
}

fn evaluator(floating: bool, fidelity: Fidelity) -> Evaluator {
    let options = Options { fidelity: Some(fidelity), ..Options::default() };
    Evaluator::new(held_arm(floating), options).expect("the arm is physical")
}

fn state(floating: bool, seed: u64) -> Query {
    let lead = if floating { numbers(seed + 50, 3) } else { Vec::new() };
    let mut q = lead;
    if floating {
        let turn = numbers(seed + 60, 4);
        let norm = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
        q.extend(turn.iter().map(|x| x / norm));
    }
    q.extend(numbers(seed, 3));
    let near: Vec<f64> = q[q.len() - 3..].iter().zip(numbers(seed + 70, 3)).map(|(q, d)| q + 0.01 * d).collect();
    let qd = numbers(seed + 80, if floating { 9 } else { 3 });
    Query { q: Some(q), qd: Some(qd), theta: Some(near), thetad: Some(numbers(seed + 90, 3)), ..Query::default() }
}

fn named(names: &[&str]) -> Option<Vec<String>> {
    Some(names.iter().map(|name| (*name).to_owned()).collect())
}

fn answer(evaluator: &mut Evaluator, query: &Query) -> Answer {
    evaluator.evaluate(query).unwrap_or_else(|e| panic!("{e}"))
}

fn get(v: &Option<Vec<f64>>) -> &[f64] {
    v.as_deref().expect("asked for")
}

fn told(answer: &Answer) -> &[HeldAnswer] {
    answer.held.as_deref().expect("something is held")
}

fn assert_close(left: &[f64], right: &[f64], tolerance: f64, what: &str) {
    assert_eq!(left.len(), right.len(), "{what}");
    let scale = right.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    for (a, b) in left.iter().zip(right) {
        assert!((a - b).abs() <= tolerance * scale, "{what}: {left:?} {right:?}");
    }
}

/// The same question without anything held, and the forces of what was held as loads from outside.
fn with_loads(query: &Query, held: &[HeldAnswer], floating: bool) -> Query {
    let nv = if floating { 9 } else { 3 };
    let mut tau_ext = vec![0.0; nv];
    let mut wrenches = Vec::new();
    for part in held {
        match (part.force, part.moment) {
            (Some(force), Some(torque)) => {
                wrenches.push(Wrench { link: "tip".to_owned(), force, torque, axes: WrenchAxes::World, point: POINT })
            }
            // The joint that follows is pushed, the other one `ratio` times against it.
            _ => {
                tau_ext[nv - 1] += part.multipliers[0];
                tau_ext[nv - 2] += 0.4 * part.multipliers[0];
            }
        }
    }
    Query { wrenches, tau_ext: Some(tau_ext), held: named(&[]), distribution: None, ..query.clone() }
}

#[test]
fn what_is_held_is_a_load_of_the_size_it_answers() {
    for seed in SEEDS {
        for floating in [false, true] {
            for fidelity in Fidelity::ALL {
                let mut evaluator = evaluator(floating, fidelity);
                for names in [vec!["foot"], vec!["rail", "belt"]] {
                    let what = format!("seed {seed}, {}, floating {floating}, {names:?}", fidelity.name());
                    let query = Query { tau: Some(numbers(seed + 1, 3)), held: named(&names), ..state(floating, seed) };
                    let held = answer(&mut evaluator, &query);
                    assert_eq!(told(&held).iter().map(|h| h.name.as_str()).collect::<Vec<_>>(), names, "{what}");
                    assert_eq!(held.dependent, Some(0), "{what}");
                    let loaded = answer(&mut evaluator, &with_loads(&query, told(&held), floating));
                    assert_close(get(&loaded.qdd), get(&held.qdd), 1e-8, &what);
                    assert_close(get(&loaded.thetadd), get(&held.thetadd), 1e-8, &what);
                    assert_close(get(&loaded.tau_j), get(&held.tau_j), 1e-8, &what);
                }
            }
        }
    }
}

#[test]
fn a_held_point_stays_where_it_is() {
    let robot = held_arm(false);
    let dynamics = gyroflex_sim::Dynamics::new(robot.model(Fidelity::Complete).expect("physical"));
    for seed in SEEDS {
        let rest = Query { qd: Some(vec![0.0; 3]), thetad: Some(vec![0.0; 3]), ..state(false, seed) };
        let query = Query { tau: Some(numbers(seed + 1, 3)), held: named(&["foot"]), ..rest };
        let qdd = answer(&mut evaluator(false, Fidelity::Complete), &query).qdd;
        let place = |step: f64| {
            let q: Vec<f64> = get(&query.q).iter().zip(get(&qdd)).map(|(q, a)| q + step * a).collect();
            let mut poses = vec![Transform::identity(); 3];
            dynamics.placements(&q, &mut poses).expect("it fits");
            poses[2].point(Vec3::from(POINT))
        };
        let moved = (place(1e-6) - place(-1e-6)).scale(0.5e6);
        assert!(
            moved.norm() < 1e-6 * (1.0 + get(&qdd).iter().fold(0.0, |m: f64, x| m.max(x.abs()))),
            "seed {seed}: {moved:?}"
        );
    }
}

#[test]
fn inverse_of_what_is_held_makes_the_motion() {
    for seed in SEEDS {
        for floating in [false, true] {
            for fidelity in [Fidelity::Rigid, Fidelity::RigidReflected] {
                let what = format!("seed {seed}, {}, floating {floating}", fidelity.name());
                let mut evaluator = evaluator(floating, fidelity);
                let names = if floating { named(&["foot", "belt"]) } else { named(&["rail"]) };
                let query = Query { held: names, ..state(floating, seed) };
                let first = answer(&mut evaluator, &Query { tau: Some(numbers(seed + 1, 3)), ..query.clone() });
                let inverse = answer(&mut evaluator, &Query { qdd: first.qdd.clone(), ..query.clone() });
                let joints = get(&inverse.tau).len() - 3;
                assert_eq!(inverse.unborne.is_some(), floating, "{what}");
                let load = get(&inverse.tau_j).iter().chain(told(&inverse).iter().flat_map(|held| &held.multipliers));
                let most = load.fold(1.0, |most: f64, x| most.max(x.abs()));
                assert!(inverse.unborne.unwrap_or(0.0) < 1e-9 * most, "{what}: {:?} of {most}", inverse.unborne);
                let again = Query { tau: Some(get(&inverse.tau)[joints..].to_vec()), ..query };
                let again = answer(&mut evaluator, &again);
                assert_close(get(&again.qdd), get(&first.qdd), 1e-7, &what);
                for (a, b) in told(&again).iter().zip(told(&inverse)) {
                    assert_close(&a.multipliers, &b.multipliers, 1e-6, &what);
                    assert_close(&a.force.unwrap_or_default(), &b.force.unwrap_or_default(), 1e-6, &what);
                    assert_close(&a.moment.unwrap_or_default(), &b.moment.unwrap_or_default(), 1e-6, &what);
                }
            }
        }
    }
}

#[test]
fn no_other_share_of_the_load_costs_less() {
    let (weights, costs, wanted) = ([1.0, 0.3, 5.0], [1e-3, 2e-2, 4e-3], [3.0, -2.0, 10.0]);
    let distribution = Distribution {
        torques: Some(weights.to_vec()),
        multipliers: Some(costs.to_vec()),
        wanted: Some(wanted.to_vec()),
        passive: Vec::new(),
    };
    for seed in SEEDS {
        for fidelity in Fidelity::ALL {
            let mut evaluator = evaluator(false, fidelity);
            let thetadd = Some(numbers(seed + 3, 3));
            let query = Query {
                qdd: Some(numbers(seed + 2, 3)),
                thetadd,
                held: named(&["foot"]),
                distribution: Some(distribution.clone()),
                ..state(false, seed)
            };
            let found = answer(&mut evaluator, &query);
            let mut cost_of = |force: [f64; 3]| {
                let part = HeldAnswer { force: Some(force), moment: Some([0.0; 3]), ..told(&found)[0].clone() };
                let loaded = answer(&mut evaluator, &with_loads(&query, &[part], false));
                let torques: f64 = get(&loaded.tau_j).iter().zip(weights).map(|(t, w)| w * t * t).sum();
                let forces: f64 = force.iter().zip(wanted).zip(costs).map(|((f, f0), v)| v * (f - f0).powi(2)).sum();
                (torques + forces, get(&loaded.tau_j).to_vec())
            };
            let own = told(&found)[0].force.expect("a contact has a force");
            let what = format!("seed {seed}, {}", fidelity.name());
            let (least, tau_j) = cost_of(own);
            assert_close(&tau_j, get(&found.tau_j), 1e-9, &what);
            for other in 0..6 {
                let mut force = own;
                force[other / 2] += if other % 2 == 0 { 0.1 } else { -0.1 };
                assert!(cost_of(force).0 > least, "{what}: {force:?} costs less than {own:?}");
            }
        }
    }
}

#[test]
fn constraints_of_the_file_are_in_force_unless_told_otherwise() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/four_bar/robot.yaml");
    let robot = load(&file, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let mut evaluator = Evaluator::new(robot, Options::default()).expect("physical");
    let third = std::f64::consts::FRAC_PI_3;
    let q = vec![0.0, third, 2.0 * third];
    let query = Query {
        theta: Some(vec![0.01, 0.0, 0.0]),
        q: Some(q),
        qd: Some(vec![0.0; 3]),
        thetad: Some(vec![0.0; 3]),
        tau: Some(vec![1.0, 0.0, 0.0]),
        ..Query::default()
    };
    let [default, named_, free] =
        [None, named(&["loop"]), named(&[])].map(|held| answer(&mut evaluator, &Query { held, ..query.clone() }));
    assert_eq!(default, named_);
    assert_eq!(told(&default)[0].name, "loop");
    assert!(free.held.is_none() && free.qdd != default.qdd);
    // Nothing drives coupler and rocker: the loop bears all of their load.
    let passive = vec!["coupler_joint".to_owned(), "rocker_joint".to_owned()];
    let distribution = Some(Distribution { passive, ..Distribution::default() });
    let query = Query { tau: None, qdd: default.qdd.clone(), thetadd: default.thetadd.clone(), distribution, ..query };
    let inverse = answer(&mut evaluator, &query);
    assert!(inverse.unborne.expect("something is passive") < 1e-9, "{:?}", inverse.unborne);
    assert_close(get(&inverse.tau), &[1.0, 0.0, 0.0], 1e-9, "torque of the crank");
    assert_close(&told(&inverse)[0].multipliers, &told(&default)[0].multipliers, 1e-9, "force of the loop");
}

#[test]
fn what_makes_no_sense_is_refused_by_key() {
    let state = r#""q": [0.1, 0.2, 0.3], "qd": [1, 2, 3], "theta": [0.1, 0, 0], "thetad": [1, 0, 0]"#;
    let inverse = format!(r#"{state}, "qdd": [1, 2, 3], "thetadd": [0, 0, 0]"#);
    let forward = format!(r#"{state}, "tau": [1, 2, 3]"#);
    let cases = [
        (&forward, r#""held": ["fot"]"#, "held[0]", "`foot`"),
        (&forward, r#""held": ["foot", "foot"]"#, "held[1]", "once"),
        (&forward, r#""held": "foot""#, "held", "list of names"),
        (&forward, r#""distribution": {}"#, "distribution", "`qdd`"),
        (&inverse, r#""held": [], "distribution": {}"#, "distribution", "`held`"),
        (&inverse, r#""distribution": {"torque": [1]}"#, "distribution.torque", "`torques`"),
        (&inverse, r#""distribution": {"torques": [1]}"#, "distribution.torques", "per joint"),
        (&inverse, r#""distribution": {"torques": [1, 0, 1]}"#, "distribution.torques[1]", "above zero"),
        (&inverse, r#""distribution": {"multipliers": [1]}"#, "distribution.multipliers", "per held direction"),
        (&inverse, r#""distribution": {"multipliers": [1, -1, 1]}"#, "distribution.multipliers[1]", "zero or more"),
        (&inverse, r#""distribution": {"wanted": [1]}"#, "distribution.wanted", "per held direction"),
        (&inverse, r#""distribution": {"passive": ["elbo"]}"#, "distribution.passive[0]", "`elbow`"),
        (&inverse, r#""distribution": 3"#, "distribution", "object"),
    ];
    for (question, more, element, remedy) in cases {
        let line = format!("{{{question}, {more}}}");
        let error = evaluator(false, Fidelity::Complete).evaluate_line(&line).expect_err(&line);
        assert_eq!(error.element, element, "{error}");
        assert!(error.remedy.contains(remedy), "{error}");
    }
    let line = r#"{"q": [0.1, 0.2, 0.3], "held": ["foot"]}"#;
    let options = Options { matrices: true, ..Options::default() };
    let error = Evaluator::new(held_arm(false), options).expect("physical").evaluate_line(line).expect_err(line);
    assert_eq!(error.element, "held");
}
