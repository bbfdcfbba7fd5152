//! Parameters of a robot by name: those that may stay symbols.

use super::Robot;
use core::fmt;
use gyroflex::model::{Drive, JointKind};

/// A number of a robot that generated functions may take as an argument.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    name: String,
    nominal: f64,
    unit: &'static str,
    pub(super) place: Place,
}

/// Which number it is; joints and links by their body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Magnitude of gravity, its direction fixed.
    Gravity,
    /// Mass of a link without a payload, at the same centre of mass and the same rotational inertia about it.
    LinkMass(usize),
    /// Mass of the payload, whose inertia grows with it.
    PayloadMass(usize),
    /// `K` of an elastic transmission.
    Stiffness(usize),
    /// `D` of an elastic transmission.
    Damping(usize),
    /// Viscous friction on the link side.
    Viscous(usize),
    /// Viscous friction on the motor side.
    MotorViscous(usize),
    /// `N`.
    GearRatio(usize),
    /// `J`.
    RotorInertia(usize),
}

impl Parameter {
    /// Its name: `gravity`, `payload.mass`, `<link>.mass` or `<joint>.` followed by `stiffness`, `damping`, `viscous`, `motor_viscous`,
    /// `gear_ratio` or `rotor_inertia`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its value in the robot's description, in its unit.
    pub fn nominal(&self) -> f64 {
        self.nominal
    }

    /// Its unit.
    pub fn unit(&self) -> &'static str {
        self.unit
    }

    /// Whether it is the damping of a transmission that has none.
    pub(crate) fn adds_damping(&self) -> bool {
        matches!(self.place, Place::Damping(_)) && self.nominal == 0.0
    }

    /// All that a robot has in its model.
    ///
    /// A link that bends has no mass here: it is spread over the modes. Nor has a spring that is a table a stiffness.
    pub fn all(robot: &Robot) -> Vec<Self> {
        let mut all = Vec::new();
        let mut add = |name: String, nominal: f64, unit: &'static str, place: Place| {
            all.push(Self { name, nominal, unit, place });
        };
        let gravity = robot.model.gravity().norm();
        if gravity > 0.0 {
            add("gravity".to_owned(), gravity, "m/s²", Place::Gravity);
        }
        if let Some((body, load)) = robot.payload.filter(|(body, load)| load.mass > 0.0 && !robot.bends(*body)) {
            add("payload.mass".to_owned(), load.mass, "kg", Place::PayloadMass(body));
        }
        for (i, (body, link)) in robot.spec.bodies.iter().zip(robot.links).enumerate() {
            let load = robot.payload.filter(|(on, _)| *on == i).map_or(0.0, |(_, load)| load.mass);
            let mass = body.inertia.mass - load;
            if mass > 0.0 && !robot.bends(i) {
                add(format!("{link}.mass"), mass, "kg", Place::LinkMass(i));
            }
        }
        for (i, (body, joint)) in robot.model.bodies().iter().zip(robot.joints).enumerate() {
            let [stiffness, damping, ratio] = match body.joint {
                JointKind::Floating => continue,
                JointKind::Revolute => ["N m/rad", "N m s/rad", "1"],
                JointKind::Prismatic => ["N/m", "N s/m", "rad/m"],
            };
            let mut add = |key: &str, nominal, unit, place| add(format!("{joint}.{key}"), nominal, unit, place);
            add("viscous", body.friction.viscous, damping, Place::Viscous(i));
            let Some(Drive { rotor, elastic }) = &body.drive else { continue };
            if let Some(elastic) = elastic {
                if elastic.spring.knots == 0 {
                    add("stiffness", elastic.spring.stiffness, stiffness, Place::Stiffness(i));
                }
                add("damping", elastic.damping, damping, Place::Damping(i));
            }
            add("motor_viscous", rotor.friction.viscous, "N m s/rad", Place::MotorViscous(i));
            add("gear_ratio", rotor.gear_ratio, ratio, Place::GearRatio(i));
            add("rotor_inertia", rotor.inertia, "kg m²", Place::RotorInertia(i));
        }
        all
    }

    /// The parameter of that name.
    ///
    /// # Errors
    /// Names the nearest one, and all.
    pub fn of(name: &str, robot: &Robot) -> Result<Self, UnknownParameter> {
        let mut all = Self::all(robot);
        match all.iter().position(|parameter| parameter.name == name) {
            Some(k) => Ok(all.swap_remove(k)),
            None => {
                let known: Vec<String> = all.into_iter().map(|parameter| parameter.name).collect();
                let lower = name.to_lowercase();
                let slips = |known: &&String| strsim::damerau_levenshtein(&lower, &known.to_lowercase());
                Err(UnknownParameter { name: name.to_owned(), nearest: known.iter().min_by_key(slips).cloned(), known })
            }
        }
    }
}

/// A name that is no parameter's that the robot has in its model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownParameter {
    /// The name.
    pub name: String,
    /// The parameter with the most similar name.
    pub nearest: Option<String>,
    /// All parameters of the robot.
    pub known: Vec<String>,
}

impl fmt::Display for UnknownParameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the robot has no parameter `{}` in this model", self.name)?;
        match &self.nearest {
            Some(nearest) => write!(f, "; the nearest is `{nearest}`; it has {}", self.known.join(", ")),
            None => write!(f, "; it has none that may stay a symbol"),
        }
    }
}

impl core::error::Error for UnknownParameter {}
