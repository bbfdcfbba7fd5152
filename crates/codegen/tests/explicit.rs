//! Laws of explicit equations: they are the library's, and their structure is that of mechanics.

mod arms;

use arms::{Arm, at, numbers, options, seeds, shipped};
use gyroflex::model::Fidelity;
use gyroflex_codegen::explicit::{ExplicitModel, NotExplicit, Options};
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::{Options as Choices, Quantity, function};
use gyroflex_codegen::robot::Parameter;
use gyroflex_testkit::random::Options as Random;
use gyroflex_testkit::tolerance::assert_close_above;

const QUANTITIES: [Quantity; 6] = [
    Quantity::MassMatrix,
    Quantity::Coupling,
    Quantity::Gravity,
    Quantity::Coriolis,
    Quantity::Bias,
    Quantity::Inverse,
];

/// Output `name` of a function at numbers of the state, its arguments by their names.
fn output(f: &Function, name: &str, arm: &Arm, seed: u64) -> Option<Vec<f64>> {
    let place = f.outputs.iter().position(|o| o.name == name)?;
    Some(f.evaluate(&numbers(f, &arm.state(seed))).swap_remove(place))
}

/// Every result that both the library's function and the explicit one have.
fn agree(arm: &Arm, explicit: &ExplicitModel, quantity: Quantity, tolerance: f64) {
    let robot = arm.robot();
    let Ok(library) = function(&robot, quantity, &Choices::default()) else { return };
    let ours = explicit.function(quantity).expect("explicit equations say it");
    let mut compared = 0;
    for name in ours.outputs.iter().map(|o| &o.name) {
        // The torque of a rigid gear is that of its motor here.
        if name == "tau_j" && robot.model.bodies().iter().any(|b| b.drive.is_some_and(|d| d.elastic.is_none())) {
            continue;
        }
        for state in 0..3 {
            let want = output(&library, name, arm, state).expect("the library has it");
            let got = output(&ours, name, arm, state).expect("the output is its own");
            let context = format!("{} `{name}` of seed {}, state {state}", quantity.name(), arm.seed);
            assert_close_above("an explicit result", &context, &got, &want, tolerance, 1e-3);
            compared += 1;
        }
    }
    assert!(compared > 0, "nothing to compare of {}", quantity.name());
}

#[test]
fn explicit_equals_library() {
    for seed in seeds(40) {
        let arm = Arm::new(seed, &options(1..=5));
        let explicit = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
        QUANTITIES.into_iter().for_each(|quantity| agree(&arm, &explicit, quantity, 1e-12));
    }
}

#[test]
fn explicit_equals_library_of_six_joints() {
    for seed in 100..102 {
        let arm = Arm::new(seed, &Random { prismatic: 0.0, ..options(6..=6) });
        let explicit = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
        [Quantity::MassMatrix, Quantity::Gravity, Quantity::Bias]
            .into_iter()
            .for_each(|quantity| agree(&arm, &explicit, quantity, 1e-12));
    }
}

#[test]
fn explicit_equals_library_of_the_projects_robots() {
    for fidelity in Fidelity::ALL {
        for arm in [shipped::puma560(fidelity, 1.0), shipped::planar_2r(fidelity)] {
            let explicit = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
            QUANTITIES.into_iter().for_each(|quantity| agree(&arm, &explicit, quantity, 1e-12));
        }
    }
}

#[test]
fn accelerations_equal_the_librarys() {
    for seed in seeds(40) {
        let arm = Arm::new(seed, &options(1..=4));
        let explicit = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
        // Through the solution of equations whose matrix may be ill conditioned.
        agree(&arm, &explicit, Quantity::Forward, 1e-9);
    }
}

#[test]
fn whole_inertia_rate_is_coriolis_and_its_transpose() {
    for seed in seeds(20) {
        let arm = Arm::new(seed, &options(2..=4));
        let explicit = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
        let f = explicit.function(Quantity::Coriolis).expect("explicit equations say it");
        let state = arm.state(0);
        let n = explicit.nv();
        let get = |name| output(&f, name, &arm, 0);
        let c = get("c").expect("it is there");
        let rate = |sum: &gyroflex_codegen::explicit::Sum| -> f64 {
            (0..n)
                .map(|k| {
                    let slope = sum.derivative(explicit.layout(), explicit.layout().inputs[k]);
                    slope.value(explicit.layout(), &state.q) * state.qd[k]
                })
                .sum()
        };
        let mut got = Vec::new();
        let mut want = Vec::new();
        for i in 0..n {
            for j in 0..n {
                want.push(rate(explicit.mass(i, j)));
                got.push(c[i * n + j] + c[j * n + i]);
                if let (Some(c1), Some(c2)) = (get("c1"), get("c2")) {
                    want.push(rate(explicit.coupling(i, j)));
                    got.push(c1[i * n + j] + c2[j * n + i]);
                }
            }
        }
        assert_close_above("Ṁ − C − Cᵀ", &format!("seed {seed}"), &got, &want, 1e-12, 1e-6);
    }
}

#[test]
fn velocity_terms_are_the_forces_of_velocity() {
    for seed in seeds(20) {
        let arm = Arm::new(seed, &options(2..=4));
        let explicit = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
        let f = explicit.function(Quantity::Bias).expect("explicit equations say it");
        let state = arm.state(1);
        let value = |term: &gyroflex_codegen::explicit::VelocityTerm| {
            use gyroflex_codegen::explicit::Speed;
            let second = match term.second {
                Speed::Link(k) => state.qd[k],
                Speed::Motor(k) => state.thetad[k],
            };
            term.factor.value(explicit.layout(), &state.q) * state.qd[term.first] * second
        };
        let n = explicit.nv();
        let link: Vec<f64> = (0..n)
            .map(|i| {
                let weight = explicit.gravity(i).value(explicit.layout(), &state.q);
                weight + explicit.velocity_terms(i).iter().map(value).sum::<f64>()
            })
            .collect();
        let context = format!("seed {seed}");
        let want = output(&f, "link", &arm, 1).expect("it is there");
        assert_close_above("forces on links", &context, &link, &want, 1e-12, 1e-3);
        if let Some(want) = output(&f, "motor", &arm, 1) {
            let motor: Vec<f64> = (0..n).map(|i| explicit.motor_velocity_terms(i).iter().map(value).sum()).collect();
            assert_close_above("forces on motors", &context, &motor, &want, 1e-12, 1e-3);
        }
    }
}

#[test]
fn parallel_joints_have_no_products_of_sines() {
    for seed in seeds(10) {
        let arm = Arm::planar(seed, 3);
        let explicit = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
        assert_eq!(explicit.layout().groups.len(), 1, "seed {seed}");
        // Of a planar arm of three: 1, cos q₂, cos q₃, cos(q₂ + q₃), each with a sine where a centre of mass is off the line.
        let harmonics = explicit.mass(0, 0).terms().len();
        assert!(harmonics <= 7, "{harmonics} terms of M₁₁, seed {seed}");
        QUANTITIES.into_iter().for_each(|quantity| agree(&arm, &explicit, quantity, 1e-12));
    }
}

#[test]
fn what_does_not_fit_is_named() {
    for seed in seeds(40) {
        let random = Random { table: 1.0, elastic: 1.0, ..options(2..=3) };
        let arm = Arm::in_model(seed, &random, Fidelity::Complete);
        let robot = arm.robot();
        let table = robot.model.bodies().iter().position(|b| b.drive.is_some());
        let result = ExplicitModel::of(&robot, &Options::default());
        match table {
            Some(i) => {
                assert_eq!(result.unwrap_err(), NotExplicit::SpringTable(robot.joints[i].clone()), "seed {seed}")
            }
            None => drop(result.expect("there is no spring in it")),
        }
    }
    let arm = Arm::new(1, &Random { floating: 1.0, ..options(2..=3) });
    assert_eq!(ExplicitModel::of(&arm.robot(), &Options::default()).unwrap_err(), NotExplicit::Floating);
}

#[test]
fn truncation_leaves_out_higher_degrees_only() {
    for seed in seeds(12) {
        let arm = Arm::bending(seed);
        for degree in 0..3 {
            let options = Options { degree, ..Options::default() };
            let explicit = ExplicitModel::of(&arm.robot(), &options).expect("nothing in it is not explicit");
            let robot = arm.robot();
            for (quantity, name) in [(Quantity::MassMatrix, "m"), (Quantity::Gravity, "g")] {
                let library = function(&robot, quantity, &Choices::default()).expect("every robot has it");
                let ours = explicit.function(quantity).expect("explicit equations say it");
                let error = |size: f64| {
                    let state = at(&arm, 0, size);
                    let value = |f: &Function| f.evaluate(&numbers(f, &state)).swap_remove(0);
                    let (want, got) = (value(&library), value(&ours));
                    got.iter().zip(&want).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
                };
                // A quarter of the deflection: the error falls with the power after the degree.
                let (large, small) = (error(0.02), error(0.005));
                let falls = 0.6 * 4.0_f64.powi(degree as i32 + 1);
                assert!(
                    large >= falls * small || large < 1e-9,
                    "{name} to degree {degree}: {large:e} and {small:e}, seed {seed}"
                );
                assert!(error(0.0) < 1e-11, "{name} of the straight robot, seed {seed}");
            }
        }
    }
}

#[test]
fn kept_parameters_stay_symbols() {
    for seed in seeds(30) {
        let arm = Arm::new(seed, &Random { friction: 0.0, cubic: 0.0, ..options(2..=4) });
        let robot = arm.robot();
        // Every other one, of its own value and of others.
        let kept: Vec<Parameter> = Parameter::all(&robot).into_iter().step_by(2).collect();
        let explicit = ExplicitModel::of(&robot, &Options { kept: kept.clone(), ..Options::default() })
            .expect("nothing in it is not explicit");
        let choices = Choices { kept: kept.clone(), ..Choices::default() };
        for quantity in [Quantity::MassMatrix, Quantity::Coupling, Quantity::Gravity, Quantity::Inverse, Quantity::Bias]
        {
            let Ok(library) = function(&robot, quantity, &choices) else { continue };
            let ours = explicit.function(quantity).expect("explicit equations say it");
            let state = arm.state(seed);
            for scale in [1.0, 1.2] {
                let value = |f: &Function, name: &str| {
                    let place = f.outputs.iter().position(|o| o.name == name).expect("it is a result");
                    let state = numbers_of_state(f, &state);
                    let parameters = kept.iter().map(|p| scale * p.nominal());
                    f.evaluate(&state.into_iter().chain(parameters).collect::<Vec<f64>>()).swap_remove(place)
                };
                let name = if quantity == Quantity::Inverse { "tau" } else { &ours.outputs[0].name };
                let context = format!("{} of seed {seed}, parameters times {scale}", quantity.name());
                let (got, want) = (value(&ours, name), value(&library, name));
                assert_close_above("a result", &context, &got, &want, 1e-11, 1e-3);
            }
        }
    }
}

/// The numbers of a state, for a function whose last argument are parameters.
fn numbers_of_state(f: &Function, state: &gyroflex_testkit::State) -> Vec<f64> {
    let mut without = f.clone();
    assert_eq!(without.arguments.pop().expect("it has arguments").name, "parameters");
    numbers(&without, state)
}
