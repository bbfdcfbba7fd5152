//! The arm as a product of 4×4 matrices.

use crate::flexible::{BendingLink, Particle};
use crate::random::RandomFlexible;
use gyroflex::model::{BodySpec, JointKind};
use gyroflex::spatial::{Transform, Vec3};
use nalgebra::{Matrix4, Unit, Vector3, Vector4};

/// A serial arm of revolute joints and slender flexible links, as the paper has it.
#[derive(Clone, Debug)]
pub struct CetinkuntBook {
    pub(super) joints: Vec<BodySpec>,
    pub(super) links: Vec<BendingLink>,
    /// `g` with a fourth zero (eq. 24).
    pub(super) gravity: Vector4<f64>,
    /// `mg` and the `C` of every link.
    pub(super) integrals: Vec<Integrals>,
}

/// Sums over the particles of a link.
#[derive(Clone, Debug)]
pub(super) struct Integrals {
    /// `C_2i` (eq. 20.a).
    pub(super) c: Matrix4<f64>,
    /// `C_2i,j` (eq. 20.b).
    pub(super) c_j: Vec<Matrix4<f64>>,
    /// `C_2i,j,k = ∫ φ_j φ_kᵀ dm` (eq. 20.c) by rows.
    pub(super) c_jk: Vec<Matrix4<f64>>,
    /// `mg_2i` (eq. 25).
    pub(super) mg: Vector4<f64>,
    /// `me_2i,j` (eq. 26).
    pub(super) me: Vec<Vector4<f64>>,
}

/// Coordinate `index` of an element, elements counted from 1 as the paper does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Coordinate {
    pub(super) element: usize,
    pub(super) index: usize,
}

impl CetinkuntBook {
    /// The same arm by the paper.
    ///
    /// # Panics
    /// If the paper has no such arm: all joints revolute, one after the other, each at the end of a flexible link that carries nothing else.
    pub fn new(robot: &RandomFlexible) -> Self {
        let joints = robot.robot.bodies.clone();
        for (i, (joint, link)) in joints.iter().zip(&robot.links).enumerate() {
            assert!(joint.joint == JointKind::Revolute && joint.parent == i.checked_sub(1), "a serial arm");
            assert!(link.body == i && link.sections.len() == 1 && !link.stiffening, "every link bends");
            assert!(link.hub.mass == 0.0 && link.sections[0].lump.mass == 0.0, "links are slender");
            if i > 0 {
                assert!(joint.placement.pos == robot.links[i - 1].sections[0].at, "joints are where links end");
            }
        }
        let g = robot.robot.gravity;
        let integrals = robot.links.iter().map(Integrals::of).collect();
        Self { joints, links: robot.links.clone(), gravity: Vector4::new(g.x, g.y, g.z, 0.0), integrals }
    }

    /// Coordinates in the order of (37): of all joints, then of all links.
    pub(super) fn coordinates(&self) -> Vec<Coordinate> {
        let joints = (1..=self.joints.len()).map(|i| Coordinate { element: 2 * i - 1, index: 0 });
        let modes = |i: usize| (0..self.links[i - 1].modes()).map(move |index| Coordinate { element: 2 * i, index });
        joints.chain((1..=self.joints.len()).flat_map(modes)).collect()
    }

    /// `q_2i,j` of link `i`, counted from 1, in that order.
    pub(super) fn of_link<'x>(&self, i: usize, x: &'x [f64]) -> &'x [f64] {
        let first = self.joints.len() + self.links[..i - 1].iter().map(BendingLink::modes).sum::<usize>();
        &x[first..first + self.links[i - 1].modes()]
    }

    /// `A_k` (eq. 9 for links), or a derivative of it: once for each of `by`, coordinates of this element.
    fn element(&self, k: usize, x: &[f64], by: &[usize]) -> Matrix4<f64> {
        let i = k.div_ceil(2);
        if k % 2 == 1 {
            let joint = &self.joints[i - 1];
            // What is rigid between the end of the link before and the joint, of which only a turn is left.
            let before = if i == 1 { joint.placement } else { Transform { pos: Vec3::zero(), ..joint.placement } };
            return pose(&before) * turn(joint.axis, x[i - 1], by.len());
        }
        let (section, q) = (&self.links[i - 1].sections[0], self.of_link(i, x));
        let rest = Matrix4::new_translation(&vector(section.at));
        let delta = |j: usize| {
            let mut out = vector(section.turns[j]).cross_matrix().to_homogeneous();
            out.fixed_view_mut::<3, 1>(0, 3).copy_from(&vector(section.shapes.displacement[j]));
            out[(3, 3)] = 0.0;
            out
        };
        match by {
            [] => rest * (Matrix4::identity() + q.iter().enumerate().map(|(j, q)| delta(j) * *q).sum::<Matrix4<f64>>()),
            [j] => rest * delta(*j),
            _ => Matrix4::zeros(),
        }
    }

    /// `W_k` (eq. 3) or a derivative of it (eq. 17).
    pub(super) fn w(&self, k: usize, x: &[f64], by: &[Coordinate]) -> Matrix4<f64> {
        if by.iter().any(|c| c.element > k) {
            return Matrix4::zeros();
        }
        let of = |element: usize| {
            let by: Vec<usize> = by.iter().filter(|c| c.element == element).map(|c| c.index).collect();
            self.element(element, x, &by)
        };
        (1..=k).map(of).product()
    }
}

impl Integrals {
    fn of(link: &BendingLink) -> Self {
        let n = link.modes();
        let rest = |p: &Particle| vector(p.at).push(1.0);
        let phi = |p: &Particle, j: usize| vector(p.shapes.displacement[j]).push(0.0);
        let matrix = |of: &dyn Fn(&Particle) -> Matrix4<f64>| link.cloud.iter().map(|p| of(p) * p.mass).sum();
        let column = |of: &dyn Fn(&Particle) -> Vector4<f64>| link.cloud.iter().map(|p| of(p) * p.mass).sum();
        Self {
            c: matrix(&|p| rest(p) * rest(p).transpose()),
            c_j: (0..n).map(|j| matrix(&|p| rest(p) * phi(p, j).transpose())).collect(),
            c_jk: (0..n * n).map(|jk| matrix(&|p| phi(p, jk / n) * phi(p, jk % n).transpose())).collect(),
            mg: column(&rest),
            me: (0..n).map(|j| column(&|p| phi(p, j))).collect(),
        }
    }

    /// `Σ_k C_k,j q_k`: what deflection adds to `C_2i,j`.
    pub(super) fn bent(&self, j: usize, q: &[f64]) -> Matrix4<f64> {
        let n = self.c_j.len();
        q.iter().enumerate().map(|(k, q)| self.c_jk[k * n + j] * *q).sum()
    }

    /// `∫ h hᵀ dm`, the bracket of (32.a).
    pub(super) fn second_moments(&self, q: &[f64]) -> Matrix4<f64> {
        let linear = self.c_j.iter().zip(q).map(|(c, q)| (c + c.transpose()) * *q);
        let square = q.iter().enumerate().map(|(j, a)| self.bent(j, q) * *a);
        self.c + linear.sum::<Matrix4<f64>>() + square.sum::<Matrix4<f64>>()
    }
}

fn vector(v: Vec3<f64>) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

/// The core stores the transposed rotation, whose rows are the axes.
fn pose(t: &Transform<f64>) -> Matrix4<f64> {
    let mut out = nalgebra::Matrix3::from_columns(&t.rot.rows.map(vector)).to_homogeneous();
    out.fixed_view_mut::<3, 1>(0, 3).copy_from(&vector(t.pos));
    out
}

/// A turn about an axis, or one of its first two derivatives by the angle: `d/dq R = n~ R`.
fn turn(axis: Vec3<f64>, angle: f64, derivative: usize) -> Matrix4<f64> {
    let n = vector(axis);
    let mut out = *nalgebra::Rotation3::from_axis_angle(&Unit::new_normalize(n), angle).matrix();
    for _ in 0..derivative {
        out = n.cross_matrix() * out;
    }
    let mut out = out.to_homogeneous();
    out[(3, 3)] = if derivative == 0 { 1.0 } else { 0.0 };
    out
}
