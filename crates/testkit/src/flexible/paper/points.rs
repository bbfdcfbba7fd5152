//! The paper's arm as points, for Lagrange's equations by automatic differentiation.

use super::CetinkuntBook;
use crate::flexible::lagrange::{Mechanism, Pair};
use crate::flexible::pose::{Pose, number};
use gyroflex::Scalar;
use gyroflex::spatial::{Transform, Vec3};

/// Particles where the paper's kinematics (eq. 1–9) has them; coordinates in the order of (37).
#[derive(Clone, Copy, Debug)]
pub struct AsPoints<'a>(pub &'a CetinkuntBook);

impl AsPoints<'_> {
    /// Particles and their masses.
    fn particles<T: Scalar>(&self, x: &[T]) -> Vec<(f64, Vec3<T>)> {
        let Self(arm) = self;
        let (mut at, mut modes) = (Pose::<T>::world(), &x[arm.joints.len()..]);
        let mut out = Vec::new();
        for (i, (joint, link)) in arm.joints.iter().zip(&arm.links).enumerate() {
            let before = if i == 0 { joint.placement } else { Transform { pos: Vec3::zero(), ..joint.placement } };
            at = at.placed(&before).turned(joint.axis, x[i]);
            let (eta, rest) = modes.split_at(link.modes());
            modes = rest;
            let sum = |of: &[Vec3<f64>]| of.iter().zip(eta).fold(Vec3::zero(), |sum, (v, q)| sum + number(*v) * *q);
            for particle in &link.cloud {
                out.push((particle.mass, at.point(number::<T>(particle.at) + sum(&particle.shapes.displacement))));
            }
            let end = &link.sections[0];
            at = at.bent_linearly(end.at, sum(&end.shapes.displacement), sum(&end.turns));
        }
        out
    }
}

impl Mechanism for AsPoints<'_> {
    fn pairs<T: Scalar<Param = f64>>(&self, x: &[T]) -> Vec<Pair<T>> {
        self.particles(x).into_iter().map(|(mass, p)| Pair { weight: 0.5 * mass, a: p, b: p }).collect()
    }

    fn potential<T: Scalar<Param = f64>>(&self, x: &[T]) -> T {
        let Self(arm) = self;
        let g = Vec3::new(arm.gravity.x, arm.gravity.y, arm.gravity.z);
        let moment = self.particles(x).iter().fold(Vec3::zero(), |sum, (mass, p)| sum + *p * T::from_f64(*mass));
        let mut modes = &x[arm.joints.len()..];
        let mut sum = -moment.dot(number(g));
        for link in &arm.links {
            let (eta, rest) = modes.split_at(link.modes());
            modes = rest;
            sum += link.bending_energy(eta);
        }
        sum
    }
}
