//! What a robot does not have is refused, with a reason.

use super::subject::{Subject, grown, grown_bending};
use gyroflex::model::Fidelity;
use gyroflex_codegen::quantity::{Options, Point, Quantity, function};
use gyroflex_testkit::random::{RandomFlexible, RandomRobot};

const OF_ELASTIC: [Quantity; 4] =
    [Quantity::Coupling, Quantity::ReflectedInertia, Quantity::Stiffness, Quantity::ElasticInverse];

#[test]
fn rigid_models_have_all_but_what_belongs_to_elastic_joints() {
    for seed in 0..10 {
        let robot = RandomRobot::new(seed, &grown());
        for fidelity in [Fidelity::Rigid, Fidelity::RigidReflected] {
            let s = Subject::of(&robot, fidelity);
            for quantity in Quantity::ALL {
                match function(&s.robot(), *quantity, &Options::default()) {
                    Ok(function) => assert!(!OF_ELASTIC.contains(quantity), "{} of {s}", function.name),
                    Err(no) => {
                        assert!(OF_ELASTIC.contains(quantity), "{no}; {s}");
                        assert!(no.to_string().contains(fidelity.name()) && !no.remedy.is_empty(), "{no}");
                    }
                }
            }
        }
    }
}

#[test]
fn links_that_bend_have_what_the_core_has_for_them() {
    let s = Subject::bending(&RandomFlexible::new(1, &grown_bending()), Fidelity::Complete);
    for quantity in [Quantity::Regressor, Quantity::Jacobian, Quantity::ElasticInverse] {
        let no = function(&s.robot(), quantity, &Options::default()).expect_err("a link bends");
        assert!(no.reason.contains("bends"), "{no}");
    }
}

#[test]
fn a_jacobian_of_no_body_is_refused() {
    let s = Subject::of(&RandomRobot::new(0, &grown()), Fidelity::Complete);
    let options = Options { point: Some(Point::origin(s.bodies.len())), ..Options::default() };
    assert!(function(&s.robot(), Quantity::Jacobian, &options).is_err());
}

#[test]
fn names_of_quantities_are_their_own() {
    let mut names: Vec<&str> = Quantity::ALL.iter().map(|quantity| quantity.name()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), Quantity::ALL.len());
}
