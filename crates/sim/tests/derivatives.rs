//! Derivatives of accelerations and torques against differences of the algorithms themselves.

mod arm;

use arm::arm;
use gyroflex::dynamics::{Acceleration, External, Forward, ForwardDerivatives, Inverse, InverseDerivatives, State};
use gyroflex::model::Fidelity;
use gyroflex_sim::{Dynamics, ErrorKind};

/// `q, q̇, θ, θ̇, τ, q̈, θ̈`, `nv` entries each.
type Point = [Vec<f64>; 7];

const STEP: f64 = 1e-5;

fn dynamics(fidelity: Fidelity) -> Dynamics {
    Dynamics::new(arm(false).model(fidelity).unwrap())
}

fn point(nv: usize) -> Point {
    let numbers = |scale: f64, shift: f64| (0..nv).map(|k| scale * (1.7 * k as f64 + shift).sin()).collect::<Vec<_>>();
    let q = numbers(1.0, 0.3);
    let theta = q.iter().zip(numbers(1e-3, 1.1)).map(|(q, d)| q + d).collect();
    [q, numbers(1.0, 0.7), theta, numbers(1.0, 0.9), numbers(5.0, 0.1), numbers(3.0, 0.5), numbers(3.0, 1.9)]
}

fn forward(dynamics: &mut Dynamics, [q, qd, theta, thetad, tau, ..]: &Point) -> [Vec<f64>; 2] {
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; qd.len()]);
    let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    dynamics.forward(State { q, qd, theta, thetad }, tau, External::none(), out).unwrap();
    [qdd, thetadd]
}

fn inverse(dynamics: &mut Dynamics, [q, qd, theta, thetad, _, qdd, thetadd]: &Point) -> [Vec<f64>; 2] {
    let [mut tau_j, mut tau] = [(); 2].map(|()| vec![0.0; qd.len()]);
    let (accel, out) = (Acceleration { qdd, thetadd }, Inverse { tau_j: &mut tau_j, tau: &mut tau });
    dynamics.inverse(State { q, qd, theta, thetad }, accel, External::none(), out).unwrap();
    [tau_j, tau]
}

/// Every column of the matrices of `got` is the difference that one coordinate of the point makes.
fn assert_differences(at: &Point, moved: &[usize], got: [&[f64]; 2], call: &mut dyn FnMut(&Point) -> [Vec<f64>; 2]) {
    let nv = at[1].len();
    let width = moved.len() * nv;
    for column in 0..width {
        let mut shifted = |by: f64| {
            let mut at = at.clone();
            at[moved[column / nv]][column % nv] += by;
            call(&at)
        };
        let (more, less) = (shifted(STEP), shifted(-STEP));
        for side in 0..2 {
            let largest = got[side].iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            for row in 0..nv {
                let want = (more[side][row] - less[side][row]) / (2.0 * STEP);
                let got = got[side][row * width + column];
                assert!((got - want).abs() < 1e-6 * largest, "{side} {row} {column}: {got} for {want}");
            }
        }
    }
}

#[test]
fn derivatives_are_the_limits_of_differences_in_every_model() {
    for fidelity in Fidelity::ALL {
        let mut dynamics = dynamics(fidelity);
        let at = point(dynamics.nv());
        let [q, qd, theta, thetad, tau, qdd, thetadd] = &at;
        let (nv, state) = (qd.len(), State { q, qd, theta, thetad });

        let [mut a, mut b, mut c] = [(); 3].map(|()| vec![0.0; nv]);
        let [mut by_q, mut by_theta] = [(); 2].map(|()| vec![0.0; 5 * nv * nv]);
        let value = Forward { qdd: &mut a, thetadd: &mut b, tau_j: &mut c };
        let out = ForwardDerivatives { qdd: &mut by_q, thetadd: &mut by_theta };
        dynamics.forward_derivatives(state, tau, External::none(), value, out).unwrap();
        assert_differences(&at, &[0, 1, 2, 3, 4], [&by_q, &by_theta], &mut |at| forward(&mut dynamics, at));

        let [mut on_joint, mut on_motor] = [(); 2].map(|()| vec![0.0; 6 * nv * nv]);
        let accel = Acceleration { qdd, thetadd };
        let out = InverseDerivatives { tau_j: &mut on_joint, tau: &mut on_motor };
        dynamics.inverse_derivatives(state, accel, External::none(), out).unwrap();
        assert_differences(&at, &[0, 1, 5, 2, 3, 6], [&on_joint, &on_motor], &mut |at| inverse(&mut dynamics, at));
    }
}

#[test]
fn a_matrix_that_is_too_short_is_refused_with_its_name() {
    let mut dynamics = dynamics(Fidelity::Complete);
    let [q, qd, theta, thetad, _, qdd, thetadd] = point(dynamics.nv());
    let (nv, state) = (qd.len(), State { q: &q, qd: &qd, theta: &theta, thetad: &thetad });
    let (mut short, mut long) = (vec![0.0; 5 * nv * nv], vec![0.0; 6 * nv * nv]);
    let out = InverseDerivatives { tau_j: &mut short, tau: &mut long };
    let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
    let error = dynamics.inverse_derivatives(state, accel, External::none(), out).unwrap_err();
    assert_eq!((error.kind, error.element.as_str()), (ErrorKind::Shape, "tau_j"));
}
