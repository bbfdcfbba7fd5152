//! Random robots for the laws of generated functions.

use gyroflex::model::Fidelity;
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::{Options as Choices, Quantity, function};
use gyroflex_codegen::robot::Robot;
use gyroflex_testkit::Lowered;
use gyroflex_testkit::random::{Options, RandomRobot};

/// Seeds of random robots; a failing law prints the one it failed with.
pub fn seeds(n: u64) -> std::ops::Range<u64> {
    0..n
}

/// Forward and inverse dynamics of a random robot in one of the models.
pub fn functions(seed: u64) -> Vec<Function> {
    let options = Options { bodies: 1..=7, ..Options::default() };
    let random = RandomRobot::new(seed, &options);
    let fidelity = Fidelity::ALL[seed as usize % Fidelity::ALL.len()];
    let lowered = Lowered::<f64>::new(&random.spec(), fidelity).expect("random robots are physical");
    let model = lowered.view();
    let names: Vec<String> = (0..model.bodies().len()).map(|i| format!("body{i}")).collect();
    let robot = Robot {
        name: "random",
        joints: &names,
        links: &names,
        spec: random.spec(),
        fidelity,
        model,
        flexible: None,
        payload: None,
    };
    [Quantity::Forward, Quantity::Inverse]
        .map(|q| function(&robot, q, &Choices::default()).expect("every robot has them"))
        .into()
}

/// Numbers for all inputs of a function, of size one.
pub fn inputs(function: &Function, seed: u64) -> Vec<f64> {
    (0..function.inputs()).map(|k| (1.3 * k as f64 + 0.7 * seed as f64).sin()).collect()
}
