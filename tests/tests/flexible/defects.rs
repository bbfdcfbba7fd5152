//! Robots with flexible links that the core must refuse, since its recursion would be wrong about them.

use gyroflex::model::{Defect, Fidelity};
use gyroflex_testkit::random::{FlexibleOptions, RandomFlexible};

/// A rigidly geared rotor couples what carries it to its joint, and forward dynamics hands both to what the joint sits on. Behind an
/// elastic transmission a rotor may be anywhere.
#[test]
fn a_rigidly_geared_rotor_on_another_station_than_its_joint_is_refused() {
    let mut tried = 0;
    for seed in 0..200 {
        let options = FlexibleOptions::default().in_model(Fidelity::Rigid);
        let mut robot = RandomFlexible::new(seed, &options);
        let found = robot.seats.iter().zip(&robot.robot.bodies).position(|(seats, body)| {
            let stations = robot.links.iter().find(|l| Some(l.body) == body.parent).map_or(0, |l| l.sections.len());
            // One that the link contains could not move without what it is part of.
            seats.rotor.is_some() && stations > 1 && body.drive.is_some_and(|d| d.rotor.body.is_some())
        });
        let Some(body) = found else { continue };
        for fidelity in [Fidelity::Rigid, Fidelity::RigidReflected] {
            assert!(robot.lower::<f64>(fidelity).is_ok(), "seed {seed}");
        }
        robot.seats[body].rotor = Some(usize::from(robot.seats[body].joint == Some(0)));
        for fidelity in [Fidelity::Rigid, Fidelity::RigidReflected] {
            let refused = robot.lower::<f64>(fidelity).expect_err("a rigid gear");
            assert_eq!((refused.body, refused.defect), (body, Defect::RemoteRigidRotor), "seed {seed}");
        }
        tried += 1;
    }
    assert!(tried > 20, "only {tried} robots had such a rotor");
}

#[test]
fn a_joint_on_a_flexible_link_needs_one_of_its_stations() {
    let mut tried = 0;
    for seed in 0..60 {
        let robot = RandomFlexible::new(seed, &FlexibleOptions::default());
        for body in 0..robot.seats.len() {
            let Some(section) = robot.seats[body].joint else { continue };
            let mut wrong = robot.clone();
            wrong.seats[body].joint = None;
            let refused = wrong.lower::<f64>(Fidelity::Complete).expect_err("no station");
            assert_eq!((refused.body, refused.defect), (body, Defect::NoStation), "seed {seed}");
            tried += 1;
            // Past the link's last station there is another link's, or none.
            wrong.seats[body].joint = Some(section + 3);
            let refused = wrong.lower::<f64>(Fidelity::Complete).expect_err("another link's station");
            assert_eq!((refused.body, refused.defect), (body, Defect::NoStation), "seed {seed}");
        }
    }
    assert!(tried > 50, "only {tried} joints sat on flexible links");
}
