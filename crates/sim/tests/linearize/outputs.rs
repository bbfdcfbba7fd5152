//! Laws of the outputs.

use crate::{arms, assert_close, displaced, moving, numbers};
use gyroflex::dynamics::{External, Forward};
use gyroflex::spatial::{Mat3, Transform};
use gyroflex_sim::Dynamics;
use gyroflex_sim::linearize::Output;
use gyroflex_sim::simulate::StateVec;
use nalgebra::DVector;

const REACH: f64 = 1e-6;

fn torques(dynamics: &mut Dynamics, state: &StateVec, tau: &[f64]) -> Vec<f64> {
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; dynamics.nv()]);
    let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    dynamics.forward(state.view(), tau, External::none(), out).expect("slices fit");
    tau_j
}

#[test]
fn joint_torques_change_as_forward_dynamics_says() {
    for (name, linearizer, mut dynamics) in arms() {
        let (state, tau) = moving(&linearizer, &dynamics);
        let point = linearizer.point(state, tau).expect("it fits");
        let linear = linearizer.linearize(&point, &[Output::JointTorque]).expect("it fits");
        let layout = linearizer.layout();
        let x = DVector::from_vec(numbers(8, linear.c.ncols()));
        let u = DVector::from_vec(numbers(9, linear.d.ncols())) * 50.0;
        let mut at = |share: f64| {
            let state = displaced(&dynamics, layout, &point.state, &(&x * share));
            let mut tau = point.tau.clone();
            layout.inputs().iter().zip(&u).for_each(|(k, u)| tau[*k] += share * u);
            let tau_j = torques(&mut dynamics, &state, &tau);
            DVector::from_iterator(layout.inputs().len(), layout.inputs().iter().map(|k| tau_j[*k]))
        };
        let rate = (at(REACH) - at(-REACH)) / (2.0 * REACH);
        assert_close(&name, &(&linear.c * &x + &linear.d * &u), &rate, 1e-6);
    }
}

#[test]
fn a_pose_moves_and_turns_as_its_link_does() {
    for (name, linearizer, dynamics) in arms() {
        let (state, tau) = moving(&linearizer, &dynamics);
        let point = linearizer.point(state, tau).expect("it fits");
        let links = ["tool", "lower", "upper"];
        let outputs = links.map(|l| Output::Pose(l.to_owned()));
        let linear = linearizer.linearize(&point, &outputs).expect("it fits");
        let x = DVector::from_vec(numbers(10, linear.c.ncols()));
        for (i, link) in links.iter().enumerate() {
            let found = linearizer.robot().links.iter().find(|l| l.name == *link).expect("it is there");
            let at = |share: f64| {
                let state = displaced(&dynamics, linearizer.layout(), &point.state, &(&x * share));
                let mut poses = vec![Transform::identity(); dynamics.model().bodies().len()];
                dynamics.placements(&state.q, &mut poses).expect("slices fit");
                let pose = found.placement.after(poses[found.body.expect("it moves")]);
                (pose.pos, pose.rotation())
            };
            let ((p, r), (before, from)) = (at(REACH), at(-REACH));
            // R₊ R₋ᵀ is a small turn in world axes; its skew part is the rotation vector.
            let turn: Mat3<f64> = r * from.transpose();
            let [a, b, c] = turn.rows.map(|row| row.to_array());
            let turned = [c[1] - b[2], a[2] - c[0], b[0] - a[1]].map(|x| 0.5 * x);
            let moved = (p - before).to_array();
            let rate: Vec<f64> = moved.into_iter().chain(turned).map(|x| x / (2.0 * REACH)).collect();
            let got = linear.c.rows(6 * i, 6) * &x;
            assert_close(&format!("{name}: {link}"), &got, &rate, 1e-7);
        }
        assert!(linear.d.iter().all(|d| *d == 0.0), "{name}");
    }
}

#[test]
fn positions_and_velocities_are_entries_of_the_state_with_the_same_joint() {
    for (name, linearizer, dynamics) in arms() {
        let (state, tau) = moving(&linearizer, &dynamics);
        let point = linearizer.point(state, tau).expect("it fits");
        let outputs: Vec<Output> = ["motor-position", "motor-velocity", "link-position", "link_velocity"]
            .map(|o| Output::parse(o).expect(o))
            .into();
        let linear = linearizer.linearize(&point, &outputs).expect("it fits");
        for (row, output) in linear.c.row_iter().zip(&linear.outputs) {
            let (kind, joint) = output.split_once('.').expect("they have two parts");
            let column = row.iter().position(|x| *x == 1.0).expect("one entry is 1");
            assert_eq!(row.iter().filter(|x| **x != 0.0).count(), 1, "{name}: {output}");
            let state = &linear.states[column];
            assert!(state.ends_with(&format!(".{joint}")), "{name}: {output} is {state}");
            // Behind a rigid gear the motor is where the link is.
            let elastic = linear.states.contains(&format!("theta.{joint}")) && kind.starts_with("motor");
            let prefix = match (elastic, kind.ends_with("velocity")) {
                (false, false) => "q.",
                (false, true) => "qd.",
                (true, false) => "theta.",
                (true, true) => "thetad.",
            };
            assert!(state.starts_with(prefix), "{name}: {output} is {state}");
        }
    }
}

#[test]
fn an_output_or_a_link_that_does_not_exist_is_refused_with_the_nearest_one() {
    let error = Output::parse("motor-positon").expect_err("it is misspelt");
    assert!(error.remedy.contains("`motor-position`"), "{error}");
    for (name, linearizer, dynamics) in arms() {
        let (state, tau) = moving(&linearizer, &dynamics);
        let point = linearizer.point(state, tau).expect("it fits");
        let error = linearizer.linearize(&point, &[Output::Pose("tol".to_owned())]).expect_err(&name);
        assert!(error.problem.contains("`tol`") && error.remedy.contains("`tool`"), "{error}");
    }
}
