//! Robots that ship with the project, each at a thousand states: all that is generated for them.

use super::linearization::is_the_motion_beside_the_state;
use super::subject::{DOUBLE, Known, SINGLE, Subject};
use super::{bending, bending_derivatives, derivatives, elastic, library, rigid};
use gyroflex::dynamics::{Axes, Frame};
use gyroflex::spatial::Transform;
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::{Options, Quantity, available};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_testkit::random::random_point;
use gyroflex_testkit::tolerance::Real;
use std::path::Path;

const STATES: u64 = 1000;

#[test]
fn puma560_is_the_library() {
    everything_is_the_library("puma560");
}

#[test]
fn iiwa14_is_the_library() {
    everything_is_the_library("iiwa14");
}

#[test]
fn manutec_r3_is_the_library() {
    everything_is_the_library("manutec_r3");
}

#[test]
fn biped5_is_the_library() {
    everything_is_the_library("biped5");
}

#[test]
fn book_two_link_is_the_library() {
    everything_is_the_library("book_two_link");
}

fn everything_is_the_library(name: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name);
    let robot = load(&folder.join("robot.yaml"), &LoadOptions::default()).expect("it ships");
    let mut s = Subject::loaded(&robot);
    let functions: Vec<(Quantity, Function)> = available(&s.robot(), &Options::default())
        .into_iter()
        .map(|quantity| (quantity, s.function(quantity).expect("it is available")))
        .collect();
    println!("{name}: {} quantities", functions.len());
    for index in 0..STATES {
        s.go(index);
        for (quantity, function) in &functions {
            show::<f64>(&mut s, *quantity, function, DOUBLE);
            show::<f32>(&mut s, *quantity, function, SINGLE);
        }
    }
}

/// Shows one function at the state of the robot.
fn show<T: Real>(s: &mut Subject, quantity: Quantity, function: &Function, tolerance: f64) {
    let bends = s.robot().flexible.is_some();
    let known: fn(&Subject) -> Vec<Known> = match (quantity, bends) {
        (Quantity::Forward, false) => return rigid::accelerates_as_the_library::<T>(s, function, tolerance),
        (Quantity::Forward, true) => return bending::accelerates_as_the_library::<T>(s, function, tolerance),
        (Quantity::ForwardDerivatives, false) => {
            return derivatives::differentiates_as_the_library::<T>(s, function, tolerance);
        }
        (Quantity::ForwardDerivatives, true) => {
            return bending_derivatives::differentiates_as_the_library::<T>(s, function, tolerance);
        }
        (Quantity::Coriolis, true) => return bending_derivatives::are_christoffels::<T>(s, function, tolerance),
        (Quantity::Linearization, _) => return is_the_motion_beside_the_state::<T>(s, function, tolerance),
        (Quantity::ElasticInverse, _) => {
            let velocities = |row: usize| random_point(&s.bodies, &[], 10_000 + row as u64).qd;
            let random: Vec<Vec<f64>> = (0..30).map(velocities).collect();
            return elastic::is_the_inverse(s, function, 0, &|row| random[row].clone());
        }
        (Quantity::Inverse, false) => library::inverse,
        (Quantity::Inverse, true) => bending::inverse,
        (Quantity::MassMatrix, _) => |s| vec![Known::new("m", library::inertia(s)[0].clone())],
        (Quantity::Coupling, _) => |s| vec![Known::new("s", library::inertia(s)[1].clone())],
        (Quantity::ReflectedInertia, _) => library::reflected,
        (Quantity::Coriolis, false) => library::coriolis,
        (Quantity::Gravity, false) => library::gravity,
        (Quantity::Gravity, true) => bending::gravity,
        (Quantity::Bias, false) => library::bias_forces,
        (Quantity::Bias, true) => bending::bias_forces,
        (Quantity::Stiffness, false) => elastic::stiffness,
        (Quantity::Stiffness, true) => bending::stiffness,
        (Quantity::Energy, false) => library::energies,
        (Quantity::Energy, true) => bending::energies,
        (Quantity::Regressor, _) => library::regressors,
        (Quantity::Placements, false) => library::poses,
        (Quantity::Placements, true) => bending::poses,
        (Quantity::Jacobian, _) => |s| {
            let last = Frame { body: s.bodies.len() - 1, placement: Transform::identity() };
            library::jacobian_of(s, last, Axes::World)
        },
        (Quantity::InverseDerivatives, false) => library::inverse_partials,
        (Quantity::InverseDerivatives, true) => bending_derivatives::inverse_partials,
    };
    s.assert_equal::<T>(function, &known(s), &[], tolerance);
}
