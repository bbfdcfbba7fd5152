//! Laws of the calculator's answers.

mod arm;

use arm::{RATIOS, arm};
use gyroflex::model::Fidelity;
use gyroflex_sim::eval::{Answer, Evaluator, Options, Query, Wrench, WrenchAxes};

const TOLERANCE: f64 = 1e-10;

fn evaluator(floating: bool, options: Options) -> Evaluator {
    Evaluator::new(arm(floating), options).expect("the arm is physical")
}

/// A state of the arm in motion, everything different from everything.
fn state(floating: bool) -> Query {
    let (mut q, mut qd) = (vec![0.4, -0.7, 0.2], vec![0.9, -1.4, 0.3]);
    if floating {
        q.splice(0..0, [0.3, -0.2, 1.1, 0.2, -0.4, 0.8, 0.4]);
        qd.splice(0..0, [0.5, -0.6, 0.7, 0.2, 0.1, -0.3]);
    }
    Query {
        q: Some(q),
        qd: Some(qd),
        theta: Some(vec![0.43, 0.0, 0.0]),
        thetad: Some(vec![1.3, 0.0, 0.0]),
        ..Query::default()
    }
}

fn assert_close(left: &[f64], right: &[f64], what: &str) {
    assert_eq!(left.len(), right.len(), "{what}");
    let scale = right.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    for (a, b) in left.iter().zip(right) {
        assert!((a - b).abs() <= TOLERANCE * scale, "{what}: {left:?} {right:?}");
    }
}

fn get(v: &Option<Vec<f64>>) -> &[f64] {
    v.as_deref().expect("asked for")
}

fn answer(floating: bool, options: Options, query: &Query) -> Answer {
    evaluator(floating, options).evaluate(query).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn inverse_undoes_forward() {
    for floating in [false, true] {
        for fidelity in Fidelity::ALL {
            for motor_side in [false, true] {
                let options = Options { fidelity: Some(fidelity), motor_side, ..Options::default() };
                let tau = vec![0.2, -0.3, 4.0];
                let load = Wrench {
                    link: "tool".to_owned(),
                    force: [1.0, -2.0, 3.0],
                    torque: [0.1, 0.2, -0.3],
                    axes: WrenchAxes::World,
                    point: [0.3, 0.1, 0.0],
                };
                let query = Query {
                    tau_ext: Some(vec![0.5, -0.4, 0.3]),
                    wrenches: vec![load],
                    gravity: Some([1.0, 2.0, -3.0]),
                    ..state(floating)
                };
                let forward = answer(floating, options, &Query { tau: Some(tau.clone()), ..query.clone() });
                let inverse = Query { qdd: forward.qdd.clone(), thetadd: forward.thetadd.clone(), ..query };
                let inverse = answer(floating, options, &inverse);
                let what = format!("{} floating {floating} motor side {motor_side}", fidelity.name());
                let joints = if floating { 6 } else { 0 };
                assert_close(&get(&inverse.tau)[joints..], &tau, &what);
                assert_close(get(&inverse.tau_j), get(&forward.tau_j), &what);
                assert_close(&get(&inverse.tau)[..joints], &vec![0.0; joints], &what);
            }
        }
    }
}

#[test]
fn motor_side_is_the_link_side_scaled_by_the_gears() {
    let ratios = [RATIOS[0], RATIOS[1], 1.0];
    let times = |v: &[f64]| v.iter().zip(ratios).map(|(x, n)| x * n).collect::<Vec<_>>();
    let over = |v: &[f64]| v.iter().zip(ratios).map(|(x, n)| x / n).collect::<Vec<_>>();
    let link_side = Options { matrices: true, energy: true, significance: true, ..Options::default() };
    let motor_side = Options { motor_side: true, ..link_side };
    let link_state = state(false);
    let motor_state = Query {
        theta: Some(times(get(&link_state.theta))),
        thetad: Some(times(get(&link_state.thetad))),
        ..link_state.clone()
    };

    let tau = [20.0, -30.0, 4.0];
    let link = answer(false, link_side, &Query { tau: Some(tau.to_vec()), ..link_state.clone() });
    let motor = answer(false, motor_side, &Query { tau: Some(over(&tau)), ..motor_state.clone() });
    assert_close(get(&motor.qdd), get(&link.qdd), "qdd");
    assert_close(get(&motor.thetadd), &times(get(&link.thetadd)), "thetadd");
    assert_close(get(&motor.tau_j), get(&link.tau_j), "tau_j");
    let total = |a: &Answer| [a.energy.expect("asked for").total];
    assert_close(&total(&motor), &total(&link), "energy");
    assert_eq!(motor.significance, link.significance);

    assert_eq!(motor.m, link.m);
    let rows = |m: &Option<Vec<Vec<f64>>>| m.clone().expect("asked for");
    for (motor_row, link_row) in rows(&motor.s).iter().zip(&rows(&link.s)) {
        assert_close(&times(motor_row), link_row, "S");
    }
    for (i, (motor_row, link_row)) in rows(&motor.b).iter().zip(&rows(&link.b)).enumerate() {
        let back: Vec<f64> = times(motor_row).iter().map(|x| x * ratios[i]).collect();
        assert_close(&back, link_row, "B");
    }

    let (qdd, thetadd) = (vec![3.0, -2.0, 1.0], [5.0, 0.0, 0.0]);
    let link =
        answer(false, link_side, &Query { qdd: Some(qdd.clone()), thetadd: Some(thetadd.to_vec()), ..link_state });
    let motor = answer(false, motor_side, &Query { qdd: Some(qdd), thetadd: Some(times(&thetadd)), ..motor_state });
    assert_close(&times(get(&motor.tau)), get(&link.tau), "tau");
    assert_close(get(&motor.tau_j), get(&link.tau_j), "tau_j");
}

#[test]
fn a_wrench_is_the_same_in_link_axes_and_in_world_axes_and_moves_along_its_line() {
    // The elbow and the slide at rest, the shoulder turned: axes differ, and the line of the force is known in both.
    let inverse = |load: Wrench| {
        let query = Query {
            qdd: Some(vec![0.0; 9]),
            thetadd: Some(vec![0.0; 9]),
            wrenches: vec![load],
            gravity: Some([0.0; 3]),
            q: Some(vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0, 0.0, 0.0]),
            qd: Some(vec![0.0; 9]),
            theta: Some(vec![0.0; 3]),
            thetad: Some(vec![0.0; 3]),
            ..Query::default()
        };
        answer(true, Options::default(), &query).tau_j.expect("asked for")
    };
    let load = |force, torque, axes, point| Wrench { link: "base".to_owned(), force, torque, axes, point };
    // The root is turned by 90° about z: the world's y is its x.
    let world = inverse(load([0.0, 2.0, 0.0], [0.0, 0.0, 0.0], WrenchAxes::World, [0.0, 0.3, 0.0]));
    let link = inverse(load([2.0, 0.0, 0.0], [0.0, 0.0, 0.0], WrenchAxes::Link, [0.0, 0.3, 0.0]));
    let moved = inverse(load([2.0, 0.0, 0.0], [0.0, 0.0, 0.0], WrenchAxes::Link, [7.0, 0.3, 0.0]));
    let at_origin = inverse(load([2.0, 0.0, 0.0], [0.0, 0.0, -0.6], WrenchAxes::Link, [0.0, 0.0, 0.0]));
    assert_close(&world, &link, "axes");
    assert_close(&moved, &link, "line of action");
    assert_close(&at_origin, &link, "moment");
    // Held at rest, the root feels exactly the opposite of the wrench.
    assert_close(&link, &[0.0, 0.0, 0.6, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0], "statics");
}

#[test]
fn the_significance_lies_between_its_extremes_and_below_its_bound() {
    let options = Options { significance: true, ..Options::default() };
    for floating in [false, true] {
        let s = answer(floating, options, &state(floating)).significance.expect("asked for");
        let r_s = s.r_s.expect("the arm moves");
        assert!(s.r_s_min <= r_s && r_s <= s.r_s_max, "{s:?}");
        assert!(s.r_s_min.abs().max(s.r_s_max.abs()) <= s.bound_singular_values, "{s:?}");
        assert!(s.sigma_s.is_sorted_by(|a, b| a >= b) && s.sigma_m_l.is_sorted_by(|a, b| a >= b), "{s:?}");
    }
}

#[test]
fn the_significance_is_that_of_the_complete_model_in_every_model() {
    let of = |fidelity| {
        let options = Options { fidelity: Some(fidelity), significance: true, ..Options::default() };
        answer(true, options, &state(true)).significance
    };
    assert!(Fidelity::ALL.into_iter().all(|fidelity| of(fidelity) == of(Fidelity::Complete)));
}

#[test]
fn answers_read_back_to_the_same_bits() {
    let options = Options { matrices: true, energy: true, ..Options::default() };
    let line =
        r#"{"q": [0.1, 0.2, 0.3], "qd": [1, 2, 3], "theta": [0.11, 0, 0], "thetad": [1, 0, 0], "tau": [1, 2, 3]}"#;
    let query = Query::parse(line).expect("the line is right");
    let value = answer(false, options, &query);
    let text = evaluator(false, options).evaluate_line(line).expect("the line is right");
    let read: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let numbers = |v: &serde_json::Value| -> Vec<u64> {
        v.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number").to_bits()).collect()
    };
    let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(numbers(&read["qdd"]), bits(get(&value.qdd)));
    assert_eq!(numbers(&read["thetadd"]), bits(get(&value.thetadd)));
    assert_eq!(numbers(&read["M"][1]), bits(&value.m.expect("asked for")[1]));
}

/// `M q̈ + S θ̈ + C q̇ + C₁ θ̇ + g`: all of inverse dynamics on the link side but friction, which is odd in the velocities, as the
/// matrices at `−q̇, −θ̇` are.
#[test]
fn matrices_make_up_inverse_dynamics() {
    for floating in [false, true] {
        for fidelity in Fidelity::ALL {
            for motor_side in [false, true] {
                let options = Options { fidelity: Some(fidelity), motor_side, matrices: true, ..Options::default() };
                let joints = if floating { 6 } else { 0 };
                let moving = Query {
                    qdd: Some((0..3 + joints).map(|i| 0.3 * i as f64 - 0.4).collect()),
                    thetadd: Some(vec![-2.0, 0.0, 0.0]),
                    ..state(floating)
                };
                let back = |v: &Option<Vec<f64>>| v.as_ref().map(|v| v.iter().map(|x| -x).collect::<Vec<_>>());
                let backwards = Query { qd: back(&moving.qd), thetad: back(&moving.thetad), ..moving.clone() };
                let (there, back) = (answer(floating, options, &moving), answer(floating, options, &backwards));
                // Half the sum: what is even in the velocities. A rigidly geared rotor is part of `M`, but not of `tau_j`.
                let elastic = matches!(fidelity, Fidelity::Complete | Fidelity::Reduced);
                let whole = |answer: &Answer, i: usize| match i.checked_sub(joints) {
                    Some(joint) if joint < 2 && !(joint == 0 && elastic) => {
                        get(&answer.tau)[i] * if motor_side { RATIOS[joint] } else { 1.0 }
                    }
                    _ => get(&answer.tau_j)[i],
                };
                let even: Vec<f64> = (0..3 + joints).map(|i| 0.5 * (whole(&there, i) + whole(&back, i))).collect();
                let motors = |v: &Option<Vec<f64>>| -> Vec<f64> {
                    vec![0.0; joints].into_iter().chain(get(v).iter().copied()).collect()
                };
                let times = |m: &[Vec<f64>], v: &[f64]| -> Vec<f64> {
                    m.iter().map(|row| row.iter().zip(v).map(|(m, v)| m * v).sum()).collect()
                };
                let velocity = there.velocity_matrices.as_ref().expect("velocities are given");
                let parts = [
                    times(there.m.as_ref().expect("asked for"), get(&moving.qdd)),
                    times(there.s.as_ref().expect("asked for"), &motors(&moving.thetadd)),
                    times(&velocity.c, get(&moving.qd)),
                    times(&velocity.c1, &motors(&moving.thetad)),
                    get(&there.g).to_vec(),
                ];
                let sum: Vec<f64> = (0..even.len()).map(|i| parts.iter().map(|p| p[i]).sum()).collect();
                // A floating root's `tau_j` is the wrench on it.
                assert_close(&sum, &even, &format!("{} floating {floating} motor side {motor_side}", fidelity.name()));
            }
        }
    }
}
