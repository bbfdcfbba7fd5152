//! Laws of frequency responses.

use crate::single_link::{LINK, ROTOR, STIFFNESS, linearizer};
use crate::{arm, assert_close, pose};
use gyroflex::dynamics::External;
use gyroflex::spatial::Vec3;
use gyroflex_sim::linearize::{KeptFriction, Linearizer, Response, Sweep, bode, frequency_response};
use gyroflex_sim::{Dynamics, Fidelity};
use nalgebra::{Complex, DMatrix};
use std::f64::consts::TAU;

fn sweep(from: f64, to: f64, points: usize) -> Sweep {
    Sweep { from: Some(from), to: Some(to), points: Some(points) }
}

fn at(linearizer: &mut Linearizer, q: &[f64], joint: &str, sweep: Sweep) -> Response {
    let point = linearizer.equilibrium_at(q).expect("it fits");
    frequency_response(linearizer, &point, joint, sweep).expect("it fits")
}

#[test]
fn resonance_and_antiresonance_of_two_masses_are_those_of_the_closed_form() {
    let mut link = linearizer(Fidelity::Complete, KeptFriction::None, false);
    let response = at(&mut link, &[0.0], "joint1", Sweep::default());
    let resonance = (STIFFNESS * (1.0 / LINK + 1.0 / ROTOR)).sqrt() / TAU;
    let held = (STIFFNESS / LINK).sqrt() / TAU;
    let frequencies = |of: &[gyroflex_sim::linearize::Extreme]| of.iter().map(|e| e.frequency).collect::<Vec<_>>();
    assert_close("resonance", &frequencies(&response.resonances), &[resonance], 1e-9);
    assert_close("antiresonance", &frequencies(&response.antiresonances), &[held], 1e-9);
    assert_eq!(response.resonances[0].magnitude, None, "an undamped resonance has no height");
}

#[test]
fn two_masses_answer_as_their_transfer_functions() {
    let mut link = linearizer(Fidelity::Complete, KeptFriction::None, false);
    let response = at(&mut link, &[0.0], "joint1", sweep(0.1, 20.0, 25));
    for (i, f) in response.frequency.iter().enumerate() {
        let s2 = -(TAU * f).powi(2);
        let below = s2 * (LINK * ROTOR * s2 + STIFFNESS * (LINK + ROTOR));
        let got = [response.motor[i], response.link[i]].map(|z| [z.re, z.im]);
        let want = [(LINK * s2 + STIFFNESS) / below, 0.0, STIFFNESS / below, 0.0];
        assert_close(&format!("{f} Hz"), got.as_flattened(), &want, 1e-10);
    }
}

#[test]
fn a_peak_of_a_damped_response_is_higher_than_all_its_surroundings() {
    let mut link = linearizer(Fidelity::Complete, KeptFriction::All, true);
    let response = at(&mut link, &[0.0], "joint1", Sweep::default());
    assert_eq!((response.resonances.len(), response.antiresonances.len()), (2, 1));
    for peak in &response.resonances {
        let f = peak.frequency;
        let near = at(&mut link, &[0.0], "joint1", sweep(0.95 * f, 1.05 * f, 2001));
        let highest = near.motor.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let magnitude = peak.magnitude.expect("it is damped");
        assert!(magnitude >= highest && magnitude < highest * (1.0 + 1e-6), "{f} Hz: {magnitude} against {highest}");
    }
}

/// Motor and link position per torque of the elastic shoulder, by `(M s² + D s + K)⁻¹` of the robot without gravity.
fn second_order(dynamics: &mut Dynamics, q: &[f64], theta: f64, s: Complex<f64>) -> [Complex<f64>; 2] {
    let n = 3;
    let (mut m_l, mut coupling, mut reflected) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n]);
    dynamics.mass_matrix(q, &mut m_l).expect("slices fit");
    dynamics.coupling(q, &mut coupling).expect("slices fit");
    dynamics.reflected_inertia(&mut reflected).expect("slices fit");
    let [mut m, mut d, mut k] = [(); 3].map(|()| DMatrix::<f64>::zeros(4, 4));
    for i in 0..n {
        (0..n).for_each(|j| m[(i, j)] = m_l[i * n + j]);
        (m[(i, 3)], m[(3, i)]) = (coupling[i * n], coupling[i * n]);
        d[(i, i)] = 0.3;
    }
    // The numbers of the arm's drives: spring, damper, and friction on the motors' sides.
    let [shoulder, elbow] = arm::RATIOS;
    let share = 1.0 - 1e-4 * 2.0 * shoulder * (2.0 * shoulder * theta + 0.4).cos();
    let through = [1.0, 0.0, 0.0, -share];
    for i in 0..4 {
        for j in 0..4 {
            k[(i, j)] += 900.0 * through[i] * through[j];
            d[(i, j)] += 3.0 * through[i] * through[j];
        }
    }
    m[(3, 3)] = reflected[0];
    d[(3, 3)] += 1e-4 * shoulder * shoulder;
    d[(1, 1)] += 1e-4 * elbow * elbow;
    let all = (m.map(Complex::from) * s + d.map(Complex::from)) * s + k.map(Complex::from);
    let x = all.lu().solve(&DMatrix::from_fn(4, 1, |i, _| Complex::from(f64::from(i == 3)))).expect("it is damped");
    [x[3], x[0]]
}

#[test]
fn an_arm_answers_as_mass_damper_and_spring_matrices_do() {
    for model in [Fidelity::Complete, Fidelity::Reduced] {
        let mut robot = arm::arm(false);
        robot.gravity = Vec3::zero();
        let mut linearizer = Linearizer::new(&robot, model, KeptFriction::All).expect("it is physical");
        let mut dynamics = Dynamics::new(robot.model(model).expect("it is physical"));
        let q = pose(&linearizer);
        let theta = linearizer.equilibrium_at(&q).expect("it fits").state.theta[0];
        let response = at(&mut linearizer, &q, "shoulder", sweep(0.05, 100.0, 30));
        for (i, f) in response.frequency.iter().enumerate() {
            let want = second_order(&mut dynamics, &q, theta, Complex::new(0.0, TAU * f));
            let parts = |z: [Complex<f64>; 2]| z.map(|z| [z.re, z.im]);
            let got = [response.motor[i], response.link[i]];
            for side in 0..2 {
                let (got, want) = (parts(got)[side], parts(want)[side]);
                assert_close(&format!("{model:?}, {f} Hz"), &got, &want, 1e-9);
            }
        }
    }
}

#[test]
fn a_robot_shaken_by_a_sine_moves_as_its_frequency_response_says() {
    const SIZE: f64 = 1e-7;
    const STEPS: usize = 4000;
    let mut link = linearizer(Fidelity::Complete, KeptFriction::All, true);
    let mut dynamics = Dynamics::new(link.robot().model(Fidelity::Complete).expect("it is physical"));
    for frequency in [0.2, 0.76, 1.3, 4.0] {
        let response = at(&mut link, &[0.0], "joint1", sweep(frequency, 2.0 * frequency, 2));
        let (motor, wave) = (response.motor[0], TAU * frequency);
        // Position and velocity of Im(z e^{jωt}).
        let on = |z: Complex<f64>, t: f64| {
            let z = z * Complex::from_polar(SIZE, wave * t);
            [z.im, wave * z.re]
        };
        let mut state = link.equilibrium_at(&[0.0]).expect("it fits").state;
        ([state.q[0], state.qd[0]], [state.theta[0], state.thetad[0]]) = (on(response.link[0], 0.0), on(motor, 0.0));
        let periods = 2.25;
        let step = periods / frequency / STEPS as f64;
        for i in 0..STEPS {
            // Torque at the middle of a step stands for all of it.
            let tau = [SIZE * (wave * step * (i as f64 + 0.5)).sin()];
            dynamics.rk4(state.view_mut(), &tau, External::none(), step).expect("slices fit");
        }
        let ([q, _], [theta, _]) = (on(response.link[0], periods / frequency), on(motor, periods / frequency));
        let size = SIZE * motor.norm().max(response.link[0].norm());
        for (got, want) in [(state.q[0], q), (state.theta[0], theta)] {
            assert!((got - want).abs() < 1e-5 * size, "{frequency} Hz: {got} instead of {want}, of {size}");
        }
    }
}

#[test]
fn phases_have_no_jumps_of_a_turn_and_begin_between_three_quarters_behind_and_one_ahead() {
    let turning: Vec<Complex<f64>> = (0..400).map(|i| Complex::from_polar(2.0, 3.0 - 0.05 * f64::from(i))).collect();
    let [magnitude, phase] = bode(&turning);
    assert_close("magnitude", &magnitude, &[2.0; 400], 1e-14);
    let want: Vec<f64> = (0..400).map(|i| 3.0 - TAU - 0.05 * f64::from(i)).collect();
    assert_close("phase", &phase, &want, 1e-13);
    // Real numbers: 0 or half a turn behind, whatever the signs of the zeros beside them.
    let real = [1.0, -1.0, -2.0, 3.0, -1.0].map(|re| Complex::new(re, if re > 2.0 { -0.0 } else { 0.0 }));
    let half = -0.5 * TAU;
    assert_close("undamped", &bode(&real)[1], &[0.0, half, half, 0.0, half], 1e-15);
}

#[test]
fn unknown_joints_and_ranges_that_are_none_are_refused() {
    let mut link = linearizer(Fidelity::Complete, KeptFriction::All, true);
    let point = link.equilibrium_at(&[0.0]).expect("it fits");
    let error = frequency_response(&link, &point, "joint2", Sweep::default()).expect_err("there is no such joint");
    assert!(error.problem.contains("joint2") && error.remedy.contains("joint1"), "{error}");
    for bad in
        [sweep(2.0, 1.0, 10), sweep(0.0, 1.0, 10), sweep(f64::NAN, 1.0, 10), sweep(1.0, 2.0, 1), sweep(1.0, 1e300, 5)]
    {
        assert!(frequency_response(&link, &point, "joint1", bad).is_err(), "{bad:?}");
    }
}
