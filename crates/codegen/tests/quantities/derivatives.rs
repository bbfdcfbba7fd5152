//! Derivatives: the core's on symbols, those of the symbols themselves, and the linear model made of them.

use super::library;
use super::subject::{DOUBLE, SINGLE, Subject, equals_library, grown};
use gyroflex::model::Fidelity;
use gyroflex_codegen::function::Function;
use gyroflex_codegen::graph::Id;
use gyroflex_codegen::quantity::Quantity;
use gyroflex_testkit::random::{Options as Grown, RandomRobot};
use gyroflex_testkit::tolerance::{Real, assert_close_above, norm};

#[test]
fn generated_inverse_derivatives_equal_library() {
    equals_library(40, &grown(), Quantity::InverseDerivatives, library::inverse_partials);
}

/// As accelerations are compared: by the torques that they ask for.
#[test]
fn generated_forward_derivatives_equal_library() {
    for seed in 0..40 {
        let robot = RandomRobot::new(seed, &grown());
        for fidelity in Fidelity::ALL {
            let mut s = Subject::of(&robot, fidelity);
            let function = s.function(Quantity::ForwardDerivatives).expect("every robot has it");
            differentiates_as_the_library::<f64>(&s, &function, DOUBLE);
            if s.round() {
                differentiates_as_the_library::<f32>(&s, &function, SINGLE);
            }
        }
    }
}

pub fn differentiates_as_the_library<T: Real>(s: &Subject, function: &Function, tolerance: f64) {
    let got = s.evaluate::<T>(function, &[]);
    let of = |k: usize| got.get(k).map(|(_, x)| x.clone());
    let dqdd = of(0).expect("it is there");
    let got = [dqdd.clone(), of(1).unwrap_or(dqdd)];
    assert_close_by_torque::<T>(s, &got, &library::forward_partials(s), tolerance);
}

/// Columns of accelerations, block by block: each is of a size of its own.
pub fn assert_close_by_torque<T: Real>(s: &Subject, got: &[Vec<f64>; 2], want: &[Vec<f64>; 2], tolerance: f64) {
    let nv = s.state.qd.len();
    let m = norm(&library::inertia(s)[0]);
    let columns = got[0].len() / nv;
    for block in 0..columns / nv {
        let cut = |all: &Vec<f64>| -> Vec<f64> {
            all.chunks(columns).flat_map(|row| row[block * nv..][..nv].iter().copied()).collect()
        };
        let (got, want) = ([cut(&got[0]), cut(&got[1])], [cut(&want[0]), cut(&want[1])]);
        let (asked, asks) = (library::weighed(s, &want[0], &want[1]), library::weighed(s, &got[0], &got[1]));
        let floor = m * (norm(&want[0]) + natural(s)[block]);
        for (side, (got, want)) in ["links", "motors"].iter().zip(asks.iter().zip(&asked)) {
            let what = format!("torques on {side} of block {block} in {}", T::NAME);
            assert_close_above(&what, s, got, want, tolerance, floor);
        }
    }
}

/// Sizes of what derivatives of accelerations by `q, q̇, θ, θ̇, τ` are the sum of, beside which they may vanish.
pub fn natural(s: &Subject) -> [f64; 5] {
    let speed = norm(&s.state.qd).max(norm(&s.state.thetad));
    let acceleration = norm(&s.gravity().to_array()).max(speed * speed);
    [acceleration, speed, acceleration, speed, 0.0]
}

/// The derivative of every result of a function by every entry of an argument, by rows.
fn symbolic(s: &Subject, function: &Function, argument: &str, output: &str) -> Vec<f64> {
    let mut function = function.clone();
    let first: usize = function.arguments.iter().take_while(|a| a.name != argument).map(|a| a.len).sum();
    let len = function.arguments.iter().find(|a| a.name == argument).map_or(0, |a| a.len);
    let results = function.outputs.iter().find(|o| o.name == output).expect("it is there").entries.clone();
    let wanted = function.graph.reached_from(results.iter().copied());
    let columns: Vec<Vec<Id>> = (first..first + len)
        .map(|k| {
            let by = function.graph.input(k);
            let all = function.graph.derivatives(by, &wanted);
            // What was added after the function is none of its results.
            results.iter().map(|id| all[id.index()]).collect()
        })
        .collect();
    let entries = (0..results.len()).flat_map(|row| columns.iter().map(move |column| column[row])).collect();
    let output = function.outputs.iter_mut().find(|o| o.name == output).expect("it is there");
    (output.entries, output.columns) = (entries, Some(len));
    let name = output.name.clone();
    let all = s.evaluate::<f64>(&function, &[]);
    all.into_iter().find(|(of, _)| *of == name).expect("it is there").1
}

/// Fixed roots: the pose of a floating one has other derivatives.
fn fixed() -> Grown {
    Grown { bodies: 1..=6, floating: 0.0, ..grown() }
}

#[test]
fn derivatives_of_symbols_equal_the_analytical_ones_of_inverse_dynamics() {
    for seed in 0..30 {
        let robot = RandomRobot::new(seed, &fixed());
        for fidelity in Fidelity::ALL {
            let s = Subject::of(&robot, fidelity);
            let function = s.function(Quantity::Inverse).expect("every robot has it");
            let nv = s.state.qd.len();
            for (output, analytical) in ["tau_j", "tau"].into_iter().zip(library::inverse_partials(&s)) {
                for (block, argument) in ["q", "qd", "qdd", "theta", "thetad", "thetadd"].into_iter().enumerate() {
                    if !function.arguments.iter().any(|a| a.name == argument) {
                        continue;
                    }
                    let rows = analytical.value.chunks(6 * nv);
                    let want: Vec<f64> = rows.flat_map(|row| row[block * nv..][..nv].iter().copied()).collect();
                    let got = symbolic(&s, &function, argument, output);
                    // A block may vanish beside the torques that it is a derivative of.
                    let floor = norm(&library::inverse(&s)[0].value);
                    assert_close_above(&format!("∂{output}/∂{argument}"), &s, &got, &want, DOUBLE, floor);
                }
            }
        }
    }
}

#[test]
fn derivatives_of_symbols_equal_the_analytical_ones_of_forward_dynamics() {
    for seed in 0..20 {
        let robot = RandomRobot::new(seed, &Grown { bodies: 1..=4, ..fixed() });
        for fidelity in Fidelity::ALL {
            let s = Subject::of(&robot, fidelity);
            let function = s.function(Quantity::Forward).expect("every robot has it");
            let nv = s.state.qd.len();
            let want = library::forward_partials(&s);
            for (block, argument) in ["q", "qd", "theta", "thetad", "tau"].into_iter().enumerate() {
                if !function.arguments.iter().any(|a| a.name == argument) {
                    continue;
                }
                let cut = |all: &Vec<f64>| -> Vec<f64> {
                    all.chunks(5 * nv).flat_map(|row| row[block * nv..][..nv].iter().copied()).collect()
                };
                let got_qdd = symbolic(&s, &function, argument, "qdd");
                let elastic = s.robot().is_elastic();
                let got_thetadd = if elastic { symbolic(&s, &function, argument, "thetadd") } else { got_qdd.clone() };
                let want = [cut(&want[0]), cut(&want[1])];
                assert_close_by_torque::<f64>(&s, &[got_qdd, got_thetadd], &want, 1e-11);
            }
        }
    }
}
