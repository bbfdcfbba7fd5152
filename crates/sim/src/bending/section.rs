//! Where the cross-sections of a link that bends are beside it, and what acts on them does to the link and its modes.

use crate::flexible::Flexible;
use crate::robot::Robot;
use gyroflex::model::StationShape;
use gyroflex::spatial::{Force, Mat3, Motion, Transform, Vec3};
use std::ops::Range;

/// A cross-section of a link that bends, with the frame that coincides with the link's at rest and is carried by it.
#[derive(Clone, Debug)]
pub struct CrossSection {
    /// The modes of its link among all of the robot.
    modes: Range<usize>,
    /// Where it is at rest, in the link's frame [m].
    position: Vec3<f64>,
    shapes: Vec<StationShape<f64>>,
    /// `n × n` by rows with stiffening, else none.
    shortenings: Vec<Vec3<f64>>,
}

/// How far a cross-section has moved beside the link as it is at rest, in the link's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Tip {
    /// Displacement [m].
    pub displacement: [f64; 3],
    /// Rotation vector [rad].
    pub rotation: [f64; 3],
}

impl CrossSection {
    /// The cross-section of flexible link `link` at `x` from its beam's root [m].
    pub fn new(flexible: &Flexible, link: usize, x: f64) -> Self {
        let first: usize = flexible.links[..link].iter().map(|l| l.modes.len()).sum();
        let flexure = &flexible.links[link];
        let n = flexure.modes.len();
        let pairs = if flexure.beam.stiffening { n * n } else { 0 };
        Self {
            modes: first..first + n,
            position: flexure.position(x),
            shapes: (0..n).map(|j| flexure.shape(j, x)).collect(),
            shortenings: (0..pairs).map(|p| flexure.shortening(p / n, p % n, x)).collect(),
        }
    }

    /// The tip of every flexible link.
    pub fn tips(flexible: &Flexible) -> Vec<Self> {
        let links = flexible.links.iter().enumerate();
        links.map(|(i, link)| Self::new(flexible, i, link.beam.length)).collect()
    }

    /// The cross-section that carries entry `link` of [`Robot::links`]; `None` where that is fixed to its body's own frame.
    pub fn of_link(robot: &Robot, link: usize) -> Option<Self> {
        let (index, x) = robot.flexible.place_of(&robot.links, link, Vec3::zero())?;
        (robot.flexible.links[index].name != robot.links[link].name).then(|| Self::new(&robot.flexible, index, x))
    }

    /// From the link's frame to the cross-section's; `eta` has one entry per mode of the robot.
    pub fn pose(&self, eta: &[f64]) -> Transform<f64> {
        let rotation = self.rotation(eta);
        Transform::from_pose(rotation, self.position + self.displacement(eta) - rotation * self.position)
    }

    /// Velocity of that frame beside the link, in its own axes.
    pub fn velocity(&self, eta: &[f64], etad: &[f64]) -> Motion<f64> {
        let columns = self.modes.clone().enumerate();
        columns.fold(Motion::zero(), |sum, (j, mode)| sum + self.column(j, eta).scale(etad[mode]))
    }

    /// What a wrench on that frame, about its origin and in its axes, does to the link, about the link's origin and in its axes; its
    /// generalised forces are added to `modal`, one entry per mode of the robot.
    pub fn carry(&self, eta: &[f64], wrench: Force<f64>, modal: &mut [f64]) -> Force<f64> {
        for (j, mode) in self.modes.clone().enumerate() {
            modal[mode] += self.column(j, eta).dot(wrench);
        }
        self.pose(eta).inv_force(wrench)
    }

    /// Its deflection.
    pub fn deflection(&self, eta: &[f64]) -> Tip {
        let theta = self.angle(eta);
        // Cayley's rotation turns by 2 atan(θ/2).
        let size = theta.norm();
        let turn = if size > 0.0 { 2.0 * (0.5 * size).atan() / size } else { 1.0 };
        Tip { displacement: self.displacement(eta).to_array(), rotation: theta.scale(turn).to_array() }
    }

    /// `θ = Σ ψ_j η_j`.
    fn angle(&self, eta: &[f64]) -> Vec3<f64> {
        let modes = self.shapes.iter().zip(&eta[self.modes.clone()]);
        modes.fold(Vec3::zero(), |sum, (shape, eta)| sum.plus_scaled(*eta, shape.rotation))
    }

    /// `u = Σ (φ_j + ½ Σ_k s_jk η_k) η_j`.
    fn displacement(&self, eta: &[f64]) -> Vec3<f64> {
        let modes = self.shapes.iter().zip(&eta[self.modes.clone()]).enumerate();
        modes.fold(Vec3::zero(), |sum, (j, (shape, own))| {
            sum.plus_scaled(*own, shape.displacement.plus_scaled(0.5, self.shortening(j, eta)))
        })
    }

    /// `Σ_k s_jk η_k`.
    fn shortening(&self, j: usize, eta: &[f64]) -> Vec3<f64> {
        let row = self.shortenings.iter().skip(j * self.shapes.len());
        row.zip(&eta[self.modes.clone()]).fold(Vec3::zero(), |sum, (s, eta)| sum.plus_scaled(*eta, *s))
    }

    /// `R = 1 + κ (θ× + ½ θ× θ×)`, `κ = 4/(4 + θ²)`.
    fn rotation(&self, eta: &[f64]) -> Mat3<f64> {
        let theta = self.angle(eta);
        let turn = Mat3::skew(theta);
        Mat3::identity() + (turn + turn.scale(0.5) * turn).scale(4.0 / (4.0 + theta.dot(theta)))
    }

    /// Motion of the cross-section's frame per unit of the rate of its link's mode `j`, in its own axes: `γ_j = κ (ψ_j − ½ θ × ψ_j)`.
    fn column(&self, j: usize, eta: &[f64]) -> Motion<f64> {
        let (theta, shape) = (self.angle(eta), self.shapes[j]);
        let kappa = 4.0 / (4.0 + theta.dot(theta));
        let ang = (shape.rotation - theta.cross(shape.rotation).scale(0.5)).scale(kappa);
        let slope = shape.displacement + self.shortening(j, eta);
        Motion { ang, lin: self.rotation(eta).transpose_mul(slope) + self.position.cross(ang) }
    }
}
