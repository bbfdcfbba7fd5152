//! What can be generated: one quantity a file, each the core's algorithm on symbols.

mod bending;
mod bias;
mod coriolis;
mod coupling;
mod elastic_inverse;
mod energy;
mod forward;
mod forward_derivatives;
mod gravity;
mod inverse;
mod inverse_derivatives;
mod jacobian;
mod linearization;
mod mass_matrix;
mod options;
mod placements;
mod reflected_inertia;
mod regressor;
mod stiffness;
mod tracing;
mod unavailable;

pub(crate) use bending::Storage;
pub use options::{Options, Point};
pub use unavailable::Unavailable;

use crate::function::Function;
use crate::robot::Robot;

/// Something to generate a function for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Accelerations from state and motor torques.
    Forward,
    /// Torques from motion.
    Inverse,
    /// `M_l`, the inertia matrix of links and modes.
    MassMatrix,
    /// `S`, the inertial coupling of links and motors.
    Coupling,
    /// The diagonal of `B`, the reflected inertia of rotors behind elastic transmissions.
    ReflectedInertia,
    /// `C, C₁, C₂` in Christoffel form.
    Coriolis,
    /// `g`, what holds the robot against gravity.
    Gravity,
    /// `C q̇ + C₁ θ̇ + g` and `C₂ q̇`.
    Bias,
    /// `k'(δ)` of the transmissions and `K` of links that bend.
    Stiffness,
    /// Kinetic, gravity and elastic energy.
    Energy,
    /// Inverse dynamics as a linear function of the robot's parameters.
    Regressor,
    /// Where the links are.
    Placements,
    /// How joint velocities move a point of a link.
    Jacobian,
    /// Derivatives of forward dynamics.
    ForwardDerivatives,
    /// Derivatives of inverse dynamics.
    InverseDerivatives,
    /// `A` and `B` of the linear model about a state.
    Linearization,
    /// Motors from the motion of the links.
    ElasticInverse,
}

impl Quantity {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::Forward,
        Self::Inverse,
        Self::MassMatrix,
        Self::Coupling,
        Self::ReflectedInertia,
        Self::Coriolis,
        Self::Gravity,
        Self::Bias,
        Self::Stiffness,
        Self::Energy,
        Self::Regressor,
        Self::Placements,
        Self::Jacobian,
        Self::ForwardDerivatives,
        Self::InverseDerivatives,
        Self::Linearization,
        Self::ElasticInverse,
    ];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Inverse => "inverse",
            Self::MassMatrix => "mass-matrix",
            Self::Coupling => "coupling",
            Self::ReflectedInertia => "reflected-inertia",
            Self::Coriolis => "coriolis",
            Self::Gravity => "gravity",
            Self::Bias => "bias",
            Self::Stiffness => "stiffness",
            Self::Energy => "energy",
            Self::Regressor => "regressor",
            Self::Placements => "placements",
            Self::Jacobian => "jacobian",
            Self::ForwardDerivatives => "forward-derivatives",
            Self::InverseDerivatives => "inverse-derivatives",
            Self::Linearization => "linearization",
            Self::ElasticInverse => "elastic-inverse",
        }
    }
}

/// All that a robot has.
pub fn available(robot: &Robot, options: &Options) -> Vec<Quantity> {
    let has = |quantity: &Quantity| unavailable::check(robot, *quantity, options).is_ok();
    Quantity::ALL.iter().copied().filter(has).collect()
}

/// The function that computes a quantity of a robot.
///
/// # Errors
/// Why there is none for this robot, and what to do.
pub fn function(robot: &Robot, quantity: Quantity, options: &Options) -> Result<Function, Unavailable> {
    unavailable::check(robot, quantity, options)?;
    Ok(match quantity {
        Quantity::Forward => forward::forward(robot, options),
        Quantity::Inverse => inverse::inverse(robot, options),
        Quantity::MassMatrix => mass_matrix::mass_matrix(robot, options),
        Quantity::Coupling => coupling::coupling(robot, options),
        Quantity::ReflectedInertia => reflected_inertia::reflected_inertia(robot, options),
        Quantity::Coriolis => coriolis::coriolis(robot, options),
        Quantity::Gravity => gravity::gravity(robot, options),
        Quantity::Bias => bias::bias(robot, options),
        Quantity::Stiffness => stiffness::stiffness(robot, options),
        Quantity::Energy => energy::energy(robot, options),
        Quantity::Regressor => regressor::regressor(robot, options),
        Quantity::Placements => placements::placements(robot, options),
        Quantity::Jacobian => jacobian::jacobian(robot, options),
        Quantity::ForwardDerivatives => forward_derivatives::forward_derivatives(robot, options),
        Quantity::InverseDerivatives => inverse_derivatives::inverse_derivatives(robot, options),
        Quantity::Linearization => linearization::linearization(robot, options),
        Quantity::ElasticInverse => return elastic_inverse::elastic_inverse(robot, options),
    })
}
