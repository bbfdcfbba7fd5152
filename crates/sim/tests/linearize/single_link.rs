//! The single link on a spring, whose linear model is that of two masses: closed forms for everything.

use gyroflex::spatial::Vec3;
use gyroflex_sim::Fidelity;
use gyroflex_sim::linearize::{KeptFriction, Linearizer};
use gyroflex_sim::load::{LoadOptions, load};
use std::path::Path;

/// Inertia of the link about its joint, as its URDF has it [kg m²].
pub(crate) const LINK: f64 = 0.0091840165 + 0.21 * 0.014920859 * 0.014920859;
/// Inertia of the rotor, gear ratio 1 [kg m²].
pub(crate) const ROTOR: f64 = 3.703704e-3;
/// Of the transmission [N m/rad].
pub(crate) const STIFFNESS: f64 = 0.18;
/// Viscous friction of the motor [N m s/rad].
pub(crate) const FRICTION: f64 = 4.62963e-3;
/// Torque of gravity on the horizontal link [N m].
pub(crate) const WEIGHT: f64 = 0.21 * 9.81 * 0.014920859;

pub(crate) fn linearizer(model: Fidelity, friction: KeptFriction, gravity: bool) -> Linearizer {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/single_link/robot.yaml");
    let mut robot = load(&path, &LoadOptions::default()).expect("it is a robot");
    if !gravity {
        robot.gravity = Vec3::zero();
    }
    Linearizer::new(&robot, model, friction).expect("it is physical")
}
