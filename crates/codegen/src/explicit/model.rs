//! The explicit model of a robot.

use super::expand::Expansion;
use super::traced::{Law, Traced, traced};
use super::{Input, Layout, NotExplicit, Sum};
use crate::robot::{Parameter, Robot};
use gyroflex::model::{Body, Fidelity, Friction, JointKind};

/// Part of the largest coefficient of an entry below which another is rounding [–].
const ROUNDING: f64 = 1e-13;

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
    /// The equations of a robot.
    ///
    /// # Errors
    /// What does not fit: a floating root, a spring that is a table, an error of a gear.
    pub fn of(robot: &Robot, options: &Options) -> Result<Self, NotExplicit> {
        check(robot)?;
        let layout = Layout::of(robot, options.kept.len());
        let Traced { graph, mass, coupling, potential, laws } = traced(robot, &options.kept);
        let n = robot.nv();
        let upper: Vec<_> = (0..n).flat_map(|i| (i..n).map(move |j| (i, j))).map(|(i, j)| mass[i * n + j]).collect();
        let mut of_laws = Vec::new();
        for law in &laws {
            law.map(|id| of_laws.push(*id));
        }
        let inertia = upper.iter().chain(&coupling).chain(&of_laws).copied();
        let of_inertia = Expansion::new(&graph, &layout, options.degree, inertia)?;
        // A torque is a derivative: of one degree less.
        let of_potential = Expansion::new(&graph, &layout, options.degree + 1, [potential])?;
        let entry = |expansion: &Expansion, id| {
            let mut sum = expansion.of(id)?;
            sum.prune(ROUNDING);
            Ok(sum)
        };
        let entries = |ids: &[_]| ids.iter().map(|id| entry(&of_inertia, *id)).collect::<Result<Vec<Sum>, _>>();
        let mut potential = entry(&of_potential, potential)?;
        potential.drop_constant(&layout, n);
        let mut joints = Vec::new();
        for law in &laws {
            // Every number of a law is an expression, and all of them have been expanded.
            joints.push(joint_law(&law.map(|id| of_inertia.of(*id).unwrap_or_default())));
        }
        let (modal_stiffness, modal_damping) = modal(robot);
        let mut out = Self {
            name: robot.name.to_owned(),
            fidelity: robot.fidelity,
            options: options.clone(),
            coordinates: coordinates(robot),
            links: robot.links.to_vec(),
            mass: entries(&upper)?,
            coupling: entries(&coupling)?,
            layout,
            potential,
            joints,
            modal_stiffness,
            modal_damping,
        };
        out.prune();
        Ok(out)
    }

    /// Drops entries that are nothing but rounding beside those of their row and column on the diagonal.
    fn prune(&mut self) {
        let n = self.nv();
        let own: Vec<f64> = (0..n).map(|i| self.mass(i, i).largest()).collect();
        let of_motor = |joints: &[JointLaw], i: usize| {
            joints.get(i).and_then(|joint| joint.drive.as_ref()).map_or(0.0, |drive| drive.reflected_inertia.largest())
        };
        for i in 0..n {
            for j in i..n {
                let at = self.upper(i, j);
                self.mass[at].prune_below(ROUNDING * (own[i] * own[j]).sqrt());
            }
            for j in 0..n {
                let scale = (own[i] * of_motor(&self.joints, j)).sqrt();
                self.coupling[i * n + j].prune_below(ROUNDING * scale);
            }
        }
    }

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

fn check(robot: &Robot) -> Result<(), NotExplicit> {
    if robot.model.is_floating() {
        return Err(NotExplicit::Floating);
    }
    for (body, name) in robot.model.bodies().iter().zip(robot.joints) {
        let Some(elastic) = body.drive.as_ref().and_then(|drive| drive.elastic.as_ref()) else { continue };
        if elastic.spring.knots != 0 {
            return Err(NotExplicit::SpringTable(name.clone()));
        }
        if elastic.error.is_some() {
            return Err(NotExplicit::TransmissionError(name.clone()));
        }
    }
    Ok(())
}

fn joint_law(law: &Law<Sum>) -> JointLaw {
    let drive = law.motor.as_ref().map(|motor| DriveLaw {
        gear_ratio: motor.gear_ratio.clone(),
        reflected_inertia: motor.reflected_inertia.clone(),
        friction: motor.friction.clone(),
        transmission: motor.elastic.clone().map(|[stiffness, cubic, damping]| TransmissionLaw {
            stiffness,
            cubic,
            damping,
        }),
    });
    JointLaw { friction: law.friction.clone(), drive }
}

fn coordinates(robot: &Robot) -> Vec<Coordinate> {
    let joint = |(body, name): (&Body<f64>, &String)| match body.joint {
        JointKind::Prismatic => Coordinate::Displacement(name.clone()),
        _ => Coordinate::Angle(name.clone()),
    };
    let mut all: Vec<Coordinate> = robot.model.bodies().iter().zip(robot.joints).map(joint).collect();
    for (of, link) in robot.flexible.iter().flat_map(|model| model.links()).enumerate() {
        let name = &robot.links[usize::from(link.body)];
        all.extend((0..link.n()).map(|mode| Coordinate::Modal { link: name.clone(), of, mode }));
    }
    all
}

/// `K` and `D` of the modes, by rows.
fn modal(robot: &Robot) -> (Vec<f64>, Vec<f64>) {
    let Some(model) = robot.flexible else { return (Vec::new(), Vec::new()) };
    let n = model.modes();
    let (mut stiffness, mut damping) = (vec![0.0; n * n], vec![0.0; n * n]);
    for link in model.links() {
        let range = link.mode_range();
        for (p, pair) in model.pairs()[link.pair_range()].iter().enumerate() {
            let at = (range.start + p / range.len()) * n + range.start + p % range.len();
            (stiffness[at], damping[at]) = (pair.stiffness, pair.damping);
        }
    }
    (stiffness, damping)
}

impl Sum {
    /// Drops what depends on no coordinate.
    fn drop_constant(&mut self, layout: &Layout, coordinates: usize) {
        let depends: Vec<bool> = self
            .terms()
            .iter()
            .map(|(m, _)| {
                let by = |input: &Input| m.derivative(layout, *input).is_some();
                layout.inputs[..coordinates].iter().any(by)
            })
            .collect();
        self.retain(|place| depends[place]);
    }
}
