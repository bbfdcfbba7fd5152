//! From a robot to its explicit model.

use super::expand::Expansion;
use super::model::{Coordinate, DriveLaw, ExplicitModel, JointLaw, Options, TransmissionLaw};
use super::traced::{Law, Traced, traced};
use super::{Input, Layout, NotExplicit, Sum};
use crate::robot::Robot;
use gyroflex::model::{Body, JointKind};

/// Part of the largest coefficient of an entry below which another is rounding [–].
const ROUNDING: f64 = 1e-13;

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
    (without_rounding(&stiffness, n), without_rounding(&damping, n))
}

/// What is left of integrals over products of different eigenfunctions is rounding.
fn without_rounding(matrix: &[f64], n: usize) -> Vec<f64> {
    let size = |j: usize, k: usize| (matrix[j * n + j] * matrix[k * n + k]).abs().sqrt();
    let entry = |(at, x): (usize, &f64)| if x.abs() > ROUNDING * size(at / n, at % n) { *x } else { 0.0 };
    matrix.iter().enumerate().map(entry).collect()
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
