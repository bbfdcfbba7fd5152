//! What a robot YAML may say of a link that bends.

use crate::beam::{Boundary, Profile, TipBody};
use schemars::JsonSchema;
use serde::Deserialize;

/// A link that bends, as a straight beam along x of its own frame. Beam, hub and masses replace the URDF's inertia of the link.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlexibleLinkFile {
    /// Length of the beam [m].
    pub length: f64,
    /// The beam's root in the link's frame, the beam along its x; default: the link's frame.
    #[serde(default)]
    pub origin: OriginFile,
    /// Mass per length [kg/m], or a table [[x, value], ...] from 0 to `length`, straight between its points.
    pub mass_per_length: ProfileFile,
    /// Polar moment of inertia per length about the beam's axis, density times polar moment of area [kg m], or a table; torsion needs
    /// it; default: 0.
    #[serde(default)]
    pub polar_inertia_per_length: Option<ProfileFile>,
    /// Bending along the beam's y; its stiffness is E I [N m²] about z.
    #[serde(default)]
    pub bending_y: Option<ModesFile>,
    /// Bending along the beam's z; its stiffness is E I [N m²] about y.
    #[serde(default)]
    pub bending_z: Option<ModesFile>,
    /// Torsion about the beam's x; its stiffness is G J [N m²].
    #[serde(default)]
    pub torsion: Option<ModesFile>,
    /// Extension along the beam's x; its stiffness is E A [N].
    #[serde(default)]
    pub extension: Option<ModesFile>,
    /// A rigid body at the beam's root, fixed to the link's frame; default: none.
    #[serde(default)]
    pub hub: Option<BodyFile>,
    /// Rigid bodies fixed to cross-sections of the beam; default: none. What hangs on the link by joints is not to be listed here.
    #[serde(default)]
    pub masses: Vec<LumpFile>,
    /// Whether a bent beam is shorter than a straight one, so that centrifugal forces stiffen it; default: false.
    #[serde(default)]
    pub geometric_stiffening: bool,
    /// Quadrature points per piece between points of tables; default: enough for the highest mode.
    #[serde(default)]
    pub quadrature_points: Option<usize>,
}

/// A pose.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OriginFile {
    /// Origin [m].
    #[serde(default)]
    pub xyz: [f64; 3],
    /// Roll, pitch and yaw, as in URDF [rad].
    #[serde(default)]
    pub rpy: [f64; 3],
}

/// The modes of one kind: eigenfunctions of a uniform beam (`boundary` and `modes`), or `shapes` from tables.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModesFile {
    /// E I, G J [N m²] or E A [N], or a table [[x, value], ...]; not read where every shape has its `frequency`.
    #[serde(default)]
    pub stiffness: Option<ProfileFile>,
    /// Whose eigenfunctions the modes are; default: clamped_free. With `shapes`, what they are checked against.
    #[serde(default)]
    pub boundary: Option<BoundaryName>,
    /// The rigid body at the tip that the eigenfunctions of `clamped_mass` are those of. It is not added to the robot.
    #[serde(default)]
    pub tip: Option<TipFile>,
    /// How many eigenfunctions; default: 1.
    #[serde(default)]
    pub modes: Option<usize>,
    /// Shapes from tables, one mode each, instead of eigenfunctions.
    #[serde(default)]
    pub shapes: Option<Vec<ShapeFile>>,
    /// Damping ratio of every mode at its own frequency, or a list, one number per mode; default: 0.
    #[serde(default)]
    pub damping: Option<DampingFile>,
}

/// How a beam is held at its ends, for the eigenfunctions that are taken as modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BoundaryName {
    /// Clamped at the root, free at the tip.
    ClampedFree,
    /// Clamped at both ends.
    ClampedClamped,
    /// Clamped at the root, the tip held in place but free to turn; bending only.
    ClampedPinned,
    /// Both ends held in place but free to turn; bending only.
    PinnedPinned,
    /// Clamped at the root, the rigid body `tip` at the tip.
    ClampedMass,
}

/// A rigid body at the tip, as the conditions of the eigenfunctions see it.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TipFile {
    /// Mass [kg]; default: 0. Torsion does not read it.
    #[serde(default)]
    pub mass: f64,
    /// Inertia about the tip [kg m²]: in bending about the axis that the tip turns about, in torsion about the beam's; default: 0.
    #[serde(default)]
    pub inertia: f64,
    /// Mass times the distance of its centre beyond the tip [kg m]; bending only; default: 0.
    #[serde(default)]
    pub first_moment: f64,
}

/// A shape as a finite-element tool writes it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShapeFile {
    /// Points [x, displacement] or [x, displacement, slope] from 0 to `length`; the angle instead of the displacement in torsion.
    pub table: Vec<Vec<f64>>,
    /// Frequency of the mode [Hz], in place of the integral over the stiffness; the modes that have one are taken for orthogonal.
    #[serde(default)]
    pub frequency: Option<f64>,
    /// Generalised mass as the tool gives it, of the beam and of `masses` [kg; kg m² in torsion]; checked; default: not checked.
    #[serde(default)]
    pub modal_mass: Option<f64>,
}

/// A rigid body.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyFile {
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass in the link's frame [m]; default: its origin.
    #[serde(default)]
    pub xyz: [f64; 3],
    /// Inertia about the centre of mass in the link's axes [kg m²]: one number about every axis, or [ixx, iyy, izz, ixy, ixz, iyz];
    /// default: 0.
    #[serde(default)]
    pub inertia: InertiaFile,
}

/// A rigid body fixed to a cross-section.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LumpFile {
    /// The cross-section: its distance from the root [m], or `tip`.
    pub at: AtFile,
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass from the cross-section's centre, in the beam's axes [m]; default: there.
    #[serde(default)]
    pub xyz: [f64; 3],
    /// Inertia about the centre of mass in the beam's axes [kg m²]: one number about every axis, or [ixx, iyy, izz, ixy, ixz, iyz];
    /// default: 0.
    #[serde(default)]
    pub inertia: InertiaFile,
}

/// A number, or a table over the beam's length.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or a table [[x, value], ...]")]
pub enum ProfileFile {
    /// The same all along.
    Constant(f64),
    /// Points [x, value].
    Table(Vec<[f64; 2]>),
}

/// One damping ratio, or one per mode.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a damping ratio, or a list of them")]
pub enum DampingFile {
    /// Of every mode.
    All(f64),
    /// One per mode.
    Each(Vec<f64>),
}

/// An inertia about a centre of mass.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or [ixx, iyy, izz, ixy, ixz, iyz]")]
pub enum InertiaFile {
    /// About every axis.
    Round(f64),
    /// ixx, iyy, izz, ixy, ixz, iyz.
    Six([f64; 6]),
}

/// A place on a beam.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a distance from the root in metres, or `tip`")]
pub enum AtFile {
    /// Distance from the root [m].
    Distance(f64),
    /// By name.
    Named(AtName),
}

/// The place on a beam that has a name.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AtName {
    /// Its end.
    Tip,
}

impl Default for InertiaFile {
    fn default() -> Self {
        Self::Round(0.0)
    }
}

impl InertiaFile {
    /// ixx, iyy, izz, ixy, ixz, iyz.
    pub(crate) fn six(self) -> [f64; 6] {
        match self {
            Self::Round(i) => [i, i, i, 0.0, 0.0, 0.0],
            Self::Six(six) => six,
        }
    }
}

impl BoundaryName {
    /// The boundary, with the body at the tip.
    pub(crate) fn with(self, tip: Option<TipFile>) -> Boundary {
        match self {
            Self::ClampedFree => Boundary::ClampedFree,
            Self::ClampedClamped => Boundary::ClampedClamped,
            Self::ClampedPinned => Boundary::ClampedPinned,
            Self::PinnedPinned => Boundary::PinnedPinned,
            Self::ClampedMass => {
                let tip = tip.map(|t| TipBody { mass: t.mass, inertia: t.inertia, first_moment: t.first_moment });
                Boundary::ClampedMass(tip.unwrap_or_default())
            }
        }
    }
}

impl From<&ProfileFile> for Profile {
    fn from(file: &ProfileFile) -> Self {
        match file {
            ProfileFile::Constant(value) => Self::Constant(*value),
            ProfileFile::Table(points) => Self::Table(points.clone()),
        }
    }
}
