//! The linear model about a state.

use super::derivatives::natural;
use super::library;
use super::slopes::of_accelerations;
use super::subject::{Subject, grown, grown_bending};
use gyroflex::model::{Body, Fidelity};
use gyroflex::spatial::Motion;
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::Quantity;
use gyroflex_testkit::random::{Options as Grown, RandomFlexible, RandomRobot};
use gyroflex_testkit::tolerance::{Real, assert_close_above, norm};

/// Forward dynamics on numbers that move along one state or input after the other; a root that floats moves in its own frame,
/// which the twist carries along: `ξ̇ = δv − v × ξ`.
#[test]
fn generated_linearization_is_the_motion_beside_the_state() {
    for seed in 0..40 {
        for fidelity in Fidelity::ALL {
            let robot = RandomRobot::new(seed, &Grown { bodies: 1..=6, ..grown() });
            shows_the_motion_beside_the_state(&Subject::of(&robot, fidelity));
        }
    }
}

#[test]
fn so_is_that_of_links_that_bend() {
    for seed in 0..5 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &grown_bending().in_model(fidelity));
            shows_the_motion_beside_the_state(&Subject::bending(&robot, fidelity));
        }
    }
}

fn shows_the_motion_beside_the_state(s: &Subject) {
    let function = s.function(Quantity::Linearization).expect("every robot has it");
    is_the_motion_beside_the_state::<f64>(s, &function, 1e-11);
}

pub fn is_the_motion_beside_the_state<T: Real>(s: &Subject, function: &Function, tolerance: f64) {
    let [(_, a), (_, b)] = <[_; 2]>::try_from(s.evaluate::<T>(function, &[])).expect("A and B");
    let (model, nv) = (s.rigid.view(), s.state.qd.len());
    let elastic: Vec<usize> = model.bodies().iter().filter(|b| b.is_elastic()).map(Body::v_index).collect();
    let inputs: Vec<usize> = model.bodies().iter().filter(|b| b.joint.nv() == 1).map(Body::v_index).collect();
    let (half, [m, coupling]) = (nv + elastic.len(), library::inertia(s).map(|matrix| norm(&matrix)));
    for column in 0..2 * half + inputs.len() {
        // Which coordinate of q, q̇, θ, θ̇, τ it is.
        let (side, k) = (column / half, column % half);
        let (block, moves) = match column {
            _ if column >= 2 * half => (4, inputs[column - 2 * half]),
            _ if k < nv => (side, k),
            _ => (2 + side, elastic[k - nv]),
        };
        let entry = |row: usize| match block {
            4 => b[row * inputs.len() + column - 2 * half],
            _ => a[row * 2 * half + column],
        };
        let mut rate: Vec<f64> = (0..half).map(|row| f64::from(block % 2 == 1 && row == k)).collect();
        if model.is_floating() && block == 0 && moves < 6 {
            let twist = Motion::from(core::array::from_fn(|i| s.state.qd[i]));
            let moved = twist.cross(Motion::from(core::array::from_fn(|i| f64::from(i == moves))));
            rate[..6].iter_mut().zip(moved.to_array()).for_each(|(rate, x)| *rate = -x);
        }
        let positions: Vec<f64> = (0..half).map(entry).collect();
        assert_close_above(&format!("rates, column {column}"), s, &positions, &rate, tolerance, 1.0);

        let of_motor = |k: usize| elastic.iter().position(|e| *e == k).map_or(k, |i| nv + i);
        let got = [(0..nv).map(|k| entry(half + k)).collect(), (0..nv).map(|k| entry(half + of_motor(k))).collect()];
        let got: [Vec<f64>; 2] = got;
        let want = of_accelerations(s, core::array::from_fn(|i| (i == block).then_some(moves)));
        let [asks, asked] = [&got, &want].map(|x| library::weighed(s, &x[0], &x[1]));
        let floor = m * (norm(&want[0]) + natural(s)[block]) + coupling * norm(&want[1]);
        assert_close_above(&format!("links, column {column}"), s, &asks[0], &asked[0], tolerance, floor);
        assert_close_above(&format!("motors, column {column}"), s, &asks[1], &asked[1], tolerance, floor);
    }
}
