//! Laws of the sliding mode controller.

#[expect(dead_code, reason = "its robot has no drives")]
mod common;
use common::{Lowered, link};
use gyroflex::control::{
    ComputedTorque, InputOutput, Joints, Outputs, Real, SlidingMode, SlidingModeError, SlidingScratch,
};
use gyroflex::dynamics::{Acceleration, CrbaScratch, External, Inverse, RneaScratch, State, crba, rnea};
use gyroflex::model::{Fidelity, SizeError};

/// A law with `M` outputs and `N` inputs, with the state in place.
#[derive(Clone)]
struct Law<T, const M: usize, const N: usize> {
    lambda: [T; M],
    steepness: [T; M],
    sigma: [T; M],
    eta: [T; N],
    weights: [T; N],
    integral: [T; M],
}

impl<T: Real, const M: usize, const N: usize> Law<T, M, N> {
    fn new(lambda: f64, steepness: f64, sigma: f64, eta: f64) -> Self {
        let (lambda, steepness) = ([T::from_f64(lambda); M], [T::from_f64(steepness); M]);
        let (sigma, eta) = ([T::from_f64(sigma); M], [T::from_f64(eta); N]);
        Self { lambda, steepness, sigma, eta, weights: [T::one(); N], integral: [T::zero(); M] }
    }

    /// Inputs and sliding variables for errors `e` and `ed` and desired accelerations `acceleration`.
    fn tick(
        &mut self,
        plant: InputOutput<T>,
        [e, ed, acceleration]: [[T; M]; 3],
        step: f64,
    ) -> Result<([T; N], [T; M]), SlidingModeError> {
        let (mut sliding, mut input, mut matrix) = ([T::zero(); M], [T::zero(); N], vec![T::zero(); M * (M + 1)]);
        let zero = [T::zero(); M];
        let mut law = SlidingMode {
            lambda: &self.lambda,
            steepness: &self.steepness,
            sigma: &self.sigma,
            eta: &self.eta,
            weights: &self.weights,
            independence: T::from_f64(1e-6),
            integral: &mut self.integral,
        };
        let (desired, measured) = (Outputs { p: &zero, pd: &zero }, Outputs { p: &e, pd: &ed });
        let scratch = SlidingScratch { sliding: &mut sliding, matrix: &mut matrix };
        law.tick(plant, desired, &acceleration, measured, T::from_f64(step), scratch, &mut input)?;
        Ok((input, sliding))
    }
}

/// Numbers between −1 and 1, the same in every run; equal steps of the argument would give matrices of rank two.
fn numbers<const N: usize>(seed: usize) -> [f64; N] {
    std::array::from_fn(|i| (12.9898 * ((i + 100 * seed + 1) as f64).powi(2)).sin())
}

/// Three outputs, five inputs.
fn redundant(seed: usize) -> ([f64; 3], [f64; 15], [f64; 5], [f64; 5]) {
    (numbers(seed), numbers(seed + 20), numbers(seed + 40), numbers(seed + 60))
}

fn times(gain: &[f64], x: &[f64]) -> Vec<f64> {
    gain.chunks(x.len()).map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

/// A double integrator whose input acts by `gain` and that a disturbance accelerates; the controller believes `p̈ = T`. The controller
/// is continuous but for the step of the integration. Returns the sliding variable over time.
fn double_integrator(law: &mut Law<f64, 1, 1>, gain: f64, disturbance: f64, start: [f64; 2]) -> Vec<f64> {
    let (step, [mut e, mut ed]) = (1e-4, start);
    (0..30_000)
        .map(|i| {
            let t = f64::from(i) * step;
            let plant = InputOutput { drift: &[0.0], gain: &[1.0], bias: &[0.0], preferred: &[0.0] };
            let ([input], [s]) = law.tick(plant, [[e], [ed], [0.0]], step).unwrap();
            ed += step * (gain * input + disturbance * (5.0 * t).sin());
            e += step * ed;
            s
        })
        .collect()
}

#[test]
fn the_sliding_variable_reaches_the_boundary_layer_and_stays() {
    for (gain, disturbance) in [(0.6, 3.0), (1.0, -3.0), (1.4, 3.0)] {
        let (alpha, sigma, eta) = (10.0, 5.0, 6.0);
        let mut law = Law::new(4.0, alpha, sigma, eta);
        let s = double_integrator(&mut law, gain, disturbance, [0.2, 1.0]);
        // ṡ = g T + d − u with T = u − (η + σ) tanh αs: what the model's error is worth is (1 − 1/g) u + d/g, which is within η here, and
        // |tanh αs| > η/(η + σ) is enough (equation 36).
        let width = f64::atanh(eta / (eta + sigma)) / alpha;
        assert!(s[0].abs() > 10.0 * width);
        let reached = s.iter().position(|s| s.abs() < width).expect("the layer is reached");
        assert!(s[..reached].windows(2).all(|pair| pair[1].abs() < pair[0].abs()), "it comes nearer all the time");
        assert!(s[reached..].iter().all(|s| s.abs() < width), "it stays inside");
    }
}

#[test]
fn without_the_switching_term_the_disturbance_leads_out_of_it() {
    let width = f64::atanh(6.0 / 11.0) / 10.0;
    let s = double_integrator(&mut Law::new(4.0, 10.0, 0.0, 0.0), 0.6, 3.0, [0.2, 1.0]);
    assert!(s[15_000..].iter().any(|s| s.abs() > width));
}

#[test]
fn on_the_surface_the_integral_of_the_error_dies_out_with_two_equal_rates() {
    let (lambda, e0, step) = (5.0_f64, 0.3, 1e-5);
    // On the surface from the start: ė = 0 and ∫e = −2e/λ.
    let mut law = Law::<f64, 1, 1>::new(lambda, 10.0, 35.0, 1.0);
    law.integral = [-2.0 * e0 / lambda];
    let ([mut e, mut ed], plant) =
        ([e0, 0.0], InputOutput { drift: &[0.0], gain: &[2.0], bias: &[0.7], preferred: &[0.7] });
    for i in 0..200_000 {
        let t = f64::from(i) * step;
        // E'' + 2λE' + λ²E = 0 with E(0) = −2e₀/λ, E'(0) = e₀.
        let (a, b) = (-2.0 * e0 / lambda, -e0);
        let decay = (-lambda * t).exp();
        assert!((law.integral[0] - (a + b * t) * decay).abs() < 1e-4 * e0, "{t}");
        assert!((e - (b - lambda * (a + b * t)) * decay).abs() < 1e-3 * e0, "{t}");
        let ([input], [s]) = law.tick(plant, [[e], [ed], [0.0]], step).unwrap();
        assert!(s.abs() < 1e-3 * e0 * lambda);
        ed += step * 2.0 * (input - 0.7);
        e += step * ed;
    }
}

#[test]
fn with_an_exact_model_on_the_surface_it_is_computed_torque() {
    let bodies = [
        link(None, [0.0, 1.0, 0.0], [0.0; 3], [0.2, 0.0, 0.1]),
        link(Some(0), [0.0, 1.0, 0.0], [0.4, 0.0, 0.0], [0.3, 0.1, 0.0]),
    ];
    let robot = Lowered::new(&bodies, [0.0, 0.0, -9.81], Fidelity::RigidReflected);
    let model = robot.model();
    let (q, qd, desired, wanted) = ([0.4, -0.9], [1.5, -0.7], [0.3, -0.6], [2.0, 1.0]);
    let (lambda, zero) = (7.0, [0.0; 2]);

    let (mut m, mut bias, mut tau_j, mut bodies) = ([0.0; 4], zero, zero, [RneaScratch::new(); 2]);
    crba(&model, &q, &mut [CrbaScratch::new(); 2], &mut m).unwrap();
    let state = State { q: &q, qd: &qd, theta: &zero, thetad: &zero };
    let out = Inverse { tau_j: &mut tau_j, tau: &mut bias };
    rnea(&model, state, Acceleration { qdd: &zero, thetadd: &zero }, External::none(), &mut bodies, out).unwrap();
    let inverse = [m[3], -m[1], -m[2], m[0]].map(|x| x / (m[0] * m[3] - m[1] * m[2]));

    let mut expected = zero;
    let gains = ([lambda * lambda; 2], [2.0 * lambda; 2]);
    let computed = ComputedTorque { kp: &gains.0, kd: &gains.1 };
    let (to, at) = (Joints { q: &desired, qd: &zero }, Joints { q: &q, qd: &qd });
    computed.torque(&model, to, at, &mut wanted.clone(), &mut bodies, &mut tau_j, &mut expected).unwrap();

    let mut law = Law::<f64, 2, 2>::new(lambda, 10.0, 35.0, 4.0);
    let e = [q[0] - desired[0], q[1] - desired[1]];
    // On the surface.
    law.integral = std::array::from_fn(|i| -(qd[i] + 2.0 * lambda * e[i]) / (lambda * lambda));
    let plant = InputOutput { drift: &zero, gain: &inverse, bias: &bias, preferred: &bias };
    let (tau, s) = law.tick(plant, [e, qd, wanted], 0.0).unwrap();
    for i in 0..2 {
        assert!((tau[i] - expected[i]).abs() < 1e-11 * expected[i].abs(), "{tau:?} {expected:?}");
        assert!(s[i].abs() < 1e-13);
    }
}

#[test]
fn the_outputs_get_the_acceleration_asked_for_with_the_least_inputs() {
    for seed in 0..10 {
        let (drift, gain, bias, preferred) = redundant(seed);
        let mut law = Law::<f64, 3, 5>::new(3.0, 10.0, 0.0, 0.0);
        law.weights = [0.5, 1.0, 2.0, 3.0, 0.1];
        let plant = InputOutput { drift: &drift, gain: &gain, bias: &bias, preferred: &preferred };
        let motion = [numbers(seed + 1), numbers(seed + 2), numbers(seed + 3)];
        let (input, _) = law.tick(plant, motion, 1e-3).unwrap();

        let acting: Vec<_> = input.iter().zip(&bias).map(|(t, n)| t - n).collect();
        for (i, a) in times(&gain, &acting).iter().enumerate() {
            let u = motion[2][i] - 6.0 * motion[1][i] - 9.0 * motion[0][i];
            assert!((a + drift[i] - u).abs() < 1e-9, "{seed}");
        }
        // The gradient of the cost is a combination of the rows of C: whatever moves no output changes it in second order only.
        let gradient: [f64; 5] = std::array::from_fn(|k| (input[k] - preferred[k]) / law.weights[k]);
        law.lambda = [0.0; 3];
        law.weights = [1.0; 5];
        let plant = InputOutput { drift: &[0.0; 3], gain: &gain, bias: &[0.0; 5], preferred: &numbers::<5>(seed + 9) };
        // With nothing asked for, what is nearest to any inputs is their part in the null space.
        let (null, _) = law.tick(plant, [[0.0; 3]; 3], 0.0).unwrap();
        assert!(times(&gain, &null).iter().all(|a| a.abs() < 1e-9) && null.iter().any(|x| x.abs() > 0.01));
        let slope: f64 = null.iter().zip(gradient).map(|(z, g)| z * g).sum();
        assert!(slope.abs() < 1e-9, "{slope}");
    }
}

#[test]
fn an_input_without_weight_stays_where_it_is_preferred() {
    let (drift, gain, bias, preferred) = redundant(3);
    let mut law = Law::<f64, 3, 5>::new(3.0, 10.0, 35.0, 1.0);
    law.weights[2] = 0.0;
    let plant = InputOutput { drift: &drift, gain: &gain, bias: &bias, preferred: &preferred };
    let (input, _) = law.tick(plant, [[0.1; 3], [0.2; 3], [1.0; 3]], 1e-3).unwrap();
    assert_eq!(input[2], preferred[2]);
    assert!((0..5).all(|k| k == 2 || input[k] != preferred[k]));
}

#[test]
fn a_steep_layer_is_the_law_with_the_signs_of_the_sliding_variables() {
    let (drift, gain, bias, _) = redundant(5);
    let plant = InputOutput { drift: &drift, gain: &gain, bias: &bias, preferred: &bias };
    let motion = [[0.1, -0.2, 0.3], [0.5, -0.1, -1.5], [1.0, 0.0, -1.0]];
    let (eta, sigma) = ([0.4, 0.3, 0.2, 0.1, 0.5], [3.0, 4.0, 5.0]);
    let mut steep = Law::<f64, 3, 5>::new(2.0, 1e9, 0.0, 0.0);
    (steep.eta, steep.sigma) = (eta, sigma);
    let (input, s) = steep.tick(plant, motion, 0.0).unwrap();
    let (without, _) = Law::<f64, 3, 5>::new(2.0, 1e9, 0.0, 0.0).tick(plant, motion, 0.0).unwrap();
    // Equation 33: C (T̂ − T) = sgn(s) (|C| η + σ), and T̂ − T is in the row space of C.
    let difference: Vec<_> = without.iter().zip(&input).map(|(a, b)| a - b).collect();
    for (i, switched) in times(&gain, &difference).iter().enumerate() {
        let bound: f64 = gain[5 * i..5 * i + 5].iter().zip(eta).map(|(c, eta)| c.abs() * eta).sum::<f64>() + sigma[i];
        assert!((switched - s[i].signum() * bound).abs() < 1e-9);
    }
    assert!(s.iter().any(|s| *s > 0.0) && s.iter().any(|s| *s < 0.0));
}

#[test]
fn outputs_that_the_inputs_cannot_move_apart_are_named_and_nothing_is_written() {
    let (drift, mut gain, bias, _) = redundant(7);
    for k in 0..5 {
        gain[10 + k] = 2.0 * gain[k] - 0.3 * gain[5 + k];
    }
    let mut law = Law::<f64, 3, 5>::new(3.0, 10.0, 35.0, 1.0);
    let plant = InputOutput { drift: &drift, gain: &gain, bias: &bias, preferred: &bias };
    let dependent = law.tick(plant, [[0.1; 3]; 3], 1e-3).unwrap_err();
    assert_eq!(dependent, SlidingModeError::Dependent { output: 2 });
    assert_eq!(dependent.to_string(), "the inputs cannot move output 2 apart from the outputs before it");
    assert_eq!(law.integral, [0.0; 3]);
    // Neither what cannot be moved at all, nor what is not a number.
    for entry in [0.0, f64::NAN] {
        gain[5..10].fill(entry);
        let plant = InputOutput { drift: &drift, gain: &gain, bias: &bias, preferred: &bias };
        assert_eq!(law.tick(plant, [[0.1; 3]; 3], 1e-3), Err(SlidingModeError::Dependent { output: 1 }));
    }
    let plant = InputOutput { drift: &drift, gain: &gain[1..], bias: &bias, preferred: &bias };
    let size = SizeError { argument: "gain", expected: 15, given: 14 };
    assert_eq!(law.tick(plant, [[0.1; 3]; 3], 1e-3), Err(SlidingModeError::Size(size)));
}

#[test]
fn single_precision_is_the_same_law() {
    let (drift, gain, bias, preferred) = redundant(11);
    let motion = [[0.01, -0.02, 0.03], [0.05, -0.01, -0.15], [1.0, 0.0, -1.0]];
    let plant = InputOutput { drift: &drift, gain: &gain, bias: &bias, preferred: &preferred };
    let (double, _) = Law::<f64, 3, 5>::new(2.0, 10.0, 3.0, 0.5).tick(plant, motion, 1e-3).unwrap();
    let (drift, gain) = (drift.map(|x| x as f32), gain.map(|x| x as f32));
    let (bias, preferred) = (bias.map(|x| x as f32), preferred.map(|x| x as f32));
    let plant = InputOutput { drift: &drift, gain: &gain, bias: &bias, preferred: &preferred };
    let motion = motion.map(|row| row.map(|x| x as f32));
    let (single, _) = Law::<f32, 3, 5>::new(2.0, 10.0, 3.0, 0.5).tick(plant, motion, 1e-3).unwrap();
    let size = double.iter().fold(1.0, |a: f64, x| a.max(x.abs()));
    assert!(double.iter().zip(single).all(|(a, b)| (a - f64::from(b)).abs() < 1e-4 * size), "{double:?} {single:?}");
}
