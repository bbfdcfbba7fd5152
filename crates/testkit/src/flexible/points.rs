//! Where the points of a robot with flexible links are.

use super::lagrange::{Mechanism, Pair};
use super::oracle::FlexibleOracle;
use super::pose::{Pose, number, symmetric_about};
use super::{BendingLink, Shapes};
use crate::State;
use gyroflex::Scalar;
use gyroflex::model::{DriveSpec, JointKind};
use gyroflex::spatial::{SpatialInertia, Vec3};
use nalgebra::{DVector, Vector3};

impl Shapes {
    /// `u1 = Σ φ_j η_j`.
    fn first<T: Scalar>(&self, eta: &[T]) -> Vec3<T> {
        self.displacement.iter().zip(eta).fold(Vec3::zero(), |sum, (phi, eta)| sum + number(*phi) * *eta)
    }

    /// `u2 = ½ Σ s_jk η_j η_k`.
    fn second<T: Scalar>(&self, eta: &[T]) -> Vec3<T> {
        let pairs = eta.iter().flat_map(|a| eta.iter().map(|b| *a * *b * T::from_f64(0.5)));
        self.shortening.iter().zip(pairs).fold(Vec3::zero(), |sum, (s, pair)| sum + number(*s) * pair)
    }
}

/// Where all bodies are.
pub(super) struct Placed<'x, T> {
    /// Link frames; of a flexible link the frame that its joint moves.
    pub(super) links: Vec<Pose<T>>,
    /// `η` of all links.
    eta: &'x [T],
    /// Reflected motor positions, one per drive.
    theta: &'x [T],
}

impl<'a> FlexibleOracle<'a> {
    pub(super) fn placed<'x, T: Scalar>(&self, x: &'x [T]) -> Placed<'x, T> {
        let (q, rest) = x.split_at(self.nq());
        let (eta, theta) = rest.split_at(self.modes());
        let mut placed = Placed { links: Vec::new(), eta, theta };
        let mut iq = 0;
        for (body, seats) in self.spec.bodies.iter().zip(self.seats) {
            let joint = self.carrier(&placed, body.parent, seats.joint).placed(&body.placement);
            placed.links.push(match body.joint {
                JointKind::Revolute => joint.turned(body.axis, q[iq]),
                JointKind::Prismatic => joint.slid(body.axis, q[iq]),
                JointKind::Floating => joint.flying(&q[iq..iq + 7]),
            });
            iq += body.joint.nq();
        }
        placed
    }

    /// The frame that coincides with a link's while it is straight and moves along with one of its sections, if one is named.
    fn carrier<T: Scalar>(&self, placed: &Placed<'_, T>, body: Option<usize>, section: Option<usize>) -> Pose<T> {
        let Some(body) = body else { return Pose::world() };
        let Some(section) = section else { return placed.links[body] };
        let (link, first) = self.bending(body).expect("only flexible links have sections");
        self.section(placed, link, first, section)
    }

    /// The same of a link whose modes begin at `first`.
    fn section<T: Scalar>(&self, placed: &Placed<'_, T>, link: &BendingLink, first: usize, section: usize) -> Pose<T> {
        let section = &link.sections[section];
        let eta = &placed.eta[first..first + link.modes()];
        let theta = section.turns.iter().zip(eta).fold(Vec3::zero(), |sum, (psi, eta)| sum + number(*psi) * *eta);
        placed.links[link.body].bent(section.at, section.shapes.first(eta) + section.shapes.second(eta), theta)
    }

    /// All rigid bodies and their frames: links or their hubs, lumps, and rotors turned as far as the model turns them.
    fn rigid_bodies<T: Scalar>(&self, placed: &Placed<'_, T>) -> Vec<(SpatialInertia<f64>, Pose<T>)> {
        let mut out: Vec<_> = self.spec.bodies.iter().zip(&placed.links).map(|(b, at)| (b.inertia, *at)).collect();
        let mut sections = Vec::new();
        for (link, first) in self.links_and_modes() {
            out[link.body].0 = link.hub;
            sections.push(out.len());
            for (k, section) in link.sections.iter().enumerate() {
                out.push((section.lump, self.section(placed, link, first, k)));
            }
        }
        for (k, (drive, seats)) in self.drives().enumerate() {
            let (rotor, mount) = (&drive.rotor, &drive.rotor.mount);
            let (mass, across) = rotor.body.map_or((0.0, 0.0), |b| (b.mass, b.transverse_inertia));
            let own = |n: Vec3<f64>| symmetric_about(n, rotor.inertia, across);
            if let (None, Some(body)) = (rotor.body, mount.body) {
                // The rotor is part of what carries it in the description.
                let link = self.links.iter().position(|link| link.body == body);
                let holder = seats.rotor.zip(link).map_or(body, |(section, l)| sections[l] + section);
                let n = mount.placement.rotation() * mount.axis;
                out[holder].0.rotational = out[holder].0.rotational - own(n);
            }
            let at = self.carrier(placed, mount.body, seats.rotor).placed(&mount.placement);
            let turn =
                if self.fidelity.is_gyroscopic() { T::from_f64(drive.gear_ratio) * placed.theta[k] } else { T::zero() };
            let inertia = SpatialInertia { mass, first_moment: Vec3::zero(), rotational: own(mount.axis) };
            out.push((inertia, at.turned(mount.axis, turn)));
        }
        out
    }

    /// Drives in the order of their joints, and where joint and rotor sit.
    pub(super) fn drives(&self) -> impl Iterator<Item = (&'a DriveSpec, super::Seats)> + use<'a> {
        let seats = self.seats;
        self.spec.bodies.iter().zip(seats).filter_map(|(body, seats)| Some((body.drive.as_ref()?, *seats)))
    }

    /// Flexible links and the index of the first mode of each.
    pub(super) fn links_and_modes(&self) -> impl Iterator<Item = (&'a BendingLink, usize)> + use<'a> {
        self.links.iter().scan(0, |next, link| {
            let first = *next;
            *next += link.modes();
            Some((link, first))
        })
    }

    fn bending(&self, body: usize) -> Option<(&'a BendingLink, usize)> {
        self.links_and_modes().find(|(link, _)| link.body == body)
    }

    pub(super) fn is_floating(&self) -> bool {
        self.spec.bodies.first().is_some_and(|b| b.joint == JointKind::Floating)
    }
}

/// Coordinates: `q` of the joints, all `η`, then one `θ` per drive.
impl Mechanism for FlexibleOracle<'_> {
    fn pairs<T: Scalar<Param = f64>>(&self, x: &[T]) -> Vec<Pair<T>> {
        let placed = self.placed(x);
        let mut out: Vec<_> = self.rigid_bodies(&placed).iter().flat_map(|(body, at)| at.rigid(body)).collect();
        for (link, first) in self.links_and_modes() {
            let (at, eta) = (placed.links[link.body], &placed.eta[first..first + link.modes()]);
            for particle in &link.cloud {
                let rest: Vec3<T> = number(particle.at);
                let bent = at.point(rest + particle.shapes.first(eta));
                out.push(Pair { weight: 0.5 * particle.mass, a: bent, b: bent });
                let shortened = at.out(particle.shapes.second(eta));
                out.push(Pair { weight: particle.mass, a: at.point(rest), b: shortened });
            }
        }
        if !self.fidelity.is_gyroscopic() {
            // ½ B θ̇² of a rotor that rides on its mount.
            out.extend(self.drives().zip(placed.theta).map(|((drive, _), theta)| {
                let a = Vec3::new(*theta, T::zero(), T::zero());
                Pair { weight: 0.5 * drive.gear_ratio.powi(2) * drive.rotor.inertia, a, b: a }
            }));
        }
        out
    }

    /// In the field of gravity, and in the bent links.
    fn potential<T: Scalar<Param = f64>>(&self, x: &[T]) -> T {
        self.gravity_energy(x) + self.bending_energy(x)
    }

    /// A floating root moves in its own frame: `ṗ = R v`, `Q̇ = ½ Q (ω, 0)`.
    fn rates<T: Scalar<Param = f64>>(&self, x: &[T], u: &[f64]) -> Vec<T> {
        let rest = |u: &[f64]| u.iter().map(|u| T::from_f64(*u)).collect::<Vec<T>>();
        if !self.is_floating() {
            return rest(u);
        }
        let (w, v): (Vec3<T>, Vec3<T>) = (number(Vec3::new(u[0], u[1], u[2])), number(Vec3::new(u[3], u[4], u[5])));
        let (i, r) = (Vec3::new(x[3], x[4], x[5]), x[6]);
        let moving = Pose::<T>::world().flying(&x[..7]).out(v);
        let (turning, real) = (w * r + i.cross(w), -i.dot(w));
        let half = T::from_f64(0.5);
        let root = [moving.to_array(), (turning * half).to_array()].concat();
        [root, vec![real * half], rest(&u[6..])].concat()
    }

    /// Of twists of a floating root in its own frame.
    fn bracket(&self, a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
        let mut out = DVector::zeros(a.len());
        if self.is_floating() {
            let part = |x: &DVector<f64>, at: usize| Vector3::new(x[at], x[at + 1], x[at + 2]);
            out.fixed_rows_mut::<3>(0).copy_from(&part(a, 0).cross(&part(b, 0)));
            let moved = part(a, 0).cross(&part(b, 3)) + part(a, 3).cross(&part(b, 0));
            out.fixed_rows_mut::<3>(3).copy_from(&moved);
        }
        out
    }
}

impl FlexibleOracle<'_> {
    /// Where link frames and the frames of their sections are: origin, then axes, in the world.
    pub fn placements(&self, s: &State) -> [Vec<f64>; 2] {
        let x = self.x(s);
        let placed = self.placed(&x);
        let sections = self.links_and_modes().flat_map(|(link, first)| {
            (0..link.sections.len()).map(|k| self.section(&placed, link, first, k)).collect::<Vec<_>>()
        });
        let sections: Vec<_> = sections.collect();
        [placed.links.clone(), sections].map(|poses| {
            let numbers = poses.iter().flat_map(|at| [at.origin, at.axes[0], at.axes[1], at.axes[2]]);
            numbers.flat_map(Vec3::to_array).collect()
        })
    }

    /// `−Σ m g·c` [J].
    pub(super) fn gravity_energy<T: Scalar<Param = f64>>(&self, x: &[T]) -> T {
        let placed = self.placed(x);
        let moment = |sum: Vec3<T>, (body, at): &(SpatialInertia<f64>, Pose<T>)| sum + at.moment(body);
        let mut moment = self.rigid_bodies(&placed).iter().fold(Vec3::zero(), moment);
        for (link, first) in self.links_and_modes() {
            let eta = &placed.eta[first..first + link.modes()];
            for particle in &link.cloud {
                let bent = number::<T>(particle.at) + particle.shapes.first(eta) + particle.shapes.second(eta);
                moment += placed.links[link.body].point(bent) * T::from_f64(particle.mass);
            }
        }
        -number::<T>(self.spec.gravity).dot(moment)
    }

    /// `½ ηᵀ K η` [J].
    pub(super) fn bending_energy<T: Scalar<Param = f64>>(&self, x: &[T]) -> T {
        let eta = &x[self.nq()..];
        let of = |(link, first): (&BendingLink, usize)| link.bending_energy(&eta[first..first + link.modes()]);
        self.links_and_modes().map(of).fold(T::zero(), |sum, e| sum + e)
    }
}

impl BendingLink {
    /// `½ ηᵀ K η` [J].
    pub(super) fn bending_energy<T: Scalar>(&self, eta: &[T]) -> T {
        let mut sum = T::zero();
        for (j, a) in eta.iter().enumerate() {
            for (k, b) in eta.iter().enumerate() {
                sum += *a * *b * T::from_f64(0.5 * self.stiffness[(j, k)]);
            }
        }
        sum
    }
}
