//! The explicit model of a robot.

use super::{Layout, Sum};
use crate::robot::Parameter;
use gyroflex::model::{Fidelity, Friction};

/// Choices about explicit equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Parameters that stay symbols.
    pub kept: Vec<Parameter>,
    /// Total degree in the modal coordinates up to which inertia and gravity torques are kept; one is that of Cetinkunt and Book.
    pub degree: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { kept: Vec::new(), degree: 1 }
    }
}

/// What a coordinate is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// The angle of a joint, by its name.
    Angle(String),
    /// The displacement of a joint that slides, by its name.
    Displacement(String),
    /// A modal coordinate of a link that bends.
    Modal {
        /// The link.
        link: String,
        /// Which of the links that bend it is, from zero.
        of: usize,
        /// Which of its modes, from zero.
        mode: usize,
    },
}

/// The law of one joint beside inertia; numbers, or terms in what is kept of them.
#[derive(Clone, Debug, PartialEq)]
pub struct JointLaw {
    /// Friction on the link side.
    pub friction: Friction<Sum>,
    /// Its drive.
    pub drive: Option<DriveLaw>,
}

/// The law of a drive.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveLaw {
    /// `N` [–].
    pub gear_ratio: Sum,
    /// `B = N² J` [kg m²]; in the inertia matrix already, where the gear is rigid.
    pub reflected_inertia: Sum,
    /// Friction on the motor side.
    pub friction: Friction<Sum>,
    /// What lies between gear and link; none is a rigid gear.
    pub transmission: Option<TransmissionLaw>,
}

/// The law of an elastic transmission, `τ_J = K δ + K₃ δ³ + D δ̇` with `δ = θ − q`.
#[derive(Clone, Debug, PartialEq)]
pub struct TransmissionLaw {
    /// `K` [N m/rad].
    pub stiffness: Sum,
    /// `K₃` [N m/rad³].
    pub cubic: Sum,
    /// `D` [N m s/rad].
    pub damping: Sum,
}

/// The equations of motion of a robot, explicit and not recursive, in terms (Cetinkunt & Book 1988, eq. 30 and 46):
///
/// ```text
/// M_l q̈ + S θ̈ + C q̇ + C₁ θ̇ + g + [0; K η + D η̇] = [τ_J − f; 0]
/// Sᵀ q̈ + B θ̈ + C₂ q̇ = τ − τ_J − N f_m
/// ```
///
/// What is stored is inertia and potential energy; Coriolis and centrifugal terms are the Christoffel symbols of the whole inertia
/// matrix, gravity is the derivative of the potential, so that energy is conserved whatever is left out.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplicitModel {
    pub(super) name: String,
    pub(super) fidelity: Fidelity,
    pub(super) options: Options,
    pub(super) coordinates: Vec<Coordinate>,
    /// Names of the links, one a joint.
    pub(super) links: Vec<String>,
    pub(super) layout: Layout,
    /// The upper triangle, by rows.
    pub(crate) mass: Vec<Sum>,
    /// By rows.
    pub(crate) coupling: Vec<Sum>,
    pub(crate) potential: Sum,
    pub(crate) joints: Vec<JointLaw>,
    /// Of the modes, by rows.
    pub(crate) modal_stiffness: Vec<f64>,
    pub(crate) modal_damping: Vec<f64>,
}

impl ExplicitModel {
    /// Name of the robot.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Which of the four models it is.
    pub fn fidelity(&self) -> Fidelity {
        self.fidelity
    }

    /// With what choices it was made.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The coordinates: joints, then modes.
    pub fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    /// Names of the links, one a joint.
    pub fn links(&self) -> &[String] {
        &self.links
    }

    /// What coordinates and kept parameters are in a term.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Number of coordinates, motors not counted.
    pub fn nv(&self) -> usize {
        self.coordinates.len()
    }

    /// Number of joints, whose coordinates are the first.
    pub fn joints(&self) -> &[JointLaw] {
        &self.joints
    }

    /// An entry of `M_l`.
    pub fn mass(&self, i: usize, j: usize) -> &Sum {
        &self.mass[self.upper(i, j)]
    }

    pub(crate) fn upper(&self, i: usize, j: usize) -> usize {
        let (i, j) = (i.min(j), i.max(j));
        i * self.nv() - i * (i + 1) / 2 + j
    }

    /// An entry of `S`: link `i`, motor `j`.
    pub fn coupling(&self, i: usize, j: usize) -> &Sum {
        &self.coupling[i * self.nv() + j]
    }

    /// Potential energy of gravity, but for a constant [J].
    pub fn potential(&self) -> &Sum {
        &self.potential
    }

    /// Gravity torque of coordinate `i`.
    pub fn gravity(&self, i: usize) -> Sum {
        self.by(&self.potential, i)
    }

    /// The derivative of a sum by coordinate `i`.
    pub(crate) fn by(&self, sum: &Sum, i: usize) -> Sum {
        sum.derivative(&self.layout, self.layout.inputs[i])
    }

    /// `K_jk` of the modes [N/m].
    pub fn modal_stiffness(&self, j: usize, k: usize) -> f64 {
        self.modal_stiffness[j * self.modes() + k]
    }

    /// `D_jk` of the modes [N s/m].
    pub fn modal_damping(&self, j: usize, k: usize) -> f64 {
        self.modal_damping[j * self.modes() + k]
    }

    /// The same with another `D` of the modes, by rows [N s/m].
    ///
    /// # Panics
    /// If it has not as many entries.
    pub fn with_modal_damping(self, modal_damping: Vec<f64>) -> Self {
        assert_eq!(modal_damping.len(), self.modal_damping.len(), "an entry a pair of modes");
        Self { modal_damping, ..self }
    }

    /// Number of modal coordinates.
    pub fn modes(&self) -> usize {
        self.nv() - self.joints.len()
    }

    /// The transmission of joint `i`, if it is elastic.
    pub fn transmission(&self, i: usize) -> Option<&TransmissionLaw> {
        self.joints.get(i)?.drive.as_ref()?.transmission.as_ref()
    }

    /// `B` of joint `i`, if it is elastic.
    pub fn reflected_inertia(&self, i: usize) -> Option<&Sum> {
        let drive = self.joints.get(i)?.drive.as_ref()?;
        drive.transmission.as_ref().map(|_| &drive.reflected_inertia)
    }

    /// Whether a joint has a motor coordinate of its own.
    pub fn is_elastic(&self) -> bool {
        (0..self.joints.len()).any(|i| self.transmission(i).is_some())
    }

    /// Whether motors act on other links than by their transmissions.
    pub fn is_coupled(&self) -> bool {
        self.coupling.iter().any(|sum| !sum.is_zero())
    }

    /// Terms of inertia and potential energy.
    pub fn terms(&self) -> usize {
        self.mass.iter().chain(&self.coupling).chain([&self.potential]).map(|sum| sum.terms().len()).sum()
    }
}
