//! Frames of links: of the world, fixed to a body, or carried by a cross-section of a link that bends.

use crate::bending::CrossSection;
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::robot::Robot;
use gyroflex::dynamics::{Axes, Frame, jacobian};
use gyroflex::model::SizeError;
use gyroflex::spatial::{Motion, Transform};

/// Where a link's frame is once the bodies' places are known.
#[derive(Clone, Debug)]
pub struct LinkFrame {
    /// The body that carries it; `None` in the world.
    pub(crate) body: Option<usize>,
    /// Its pose in that body's frame, or in the cross-section's.
    pub(crate) placement: Transform<f64>,
    /// The cross-section that it is fixed to where the body bends.
    section: Option<CrossSection>,
}

impl LinkFrame {
    /// The frame of entry `link` of [`Robot::links`].
    ///
    /// # Panics
    /// If there is no such entry.
    pub fn new(robot: &Robot, link: usize) -> Self {
        let section = CrossSection::of_link(robot, link);
        let link = &robot.links[link];
        Self { body: link.body, placement: link.placement, section }
    }

    /// Whether joints move it.
    pub fn moves(&self) -> bool {
        self.body.is_some()
    }

    /// From the world to the frame; `poses` are those of the bodies, `eta` has one entry per mode of the robot.
    pub fn pose(&self, poses: &[Transform<f64>], eta: &[f64]) -> Transform<f64> {
        match (self.body, &self.section) {
            (None, _) => self.placement,
            (Some(body), None) => self.placement.after(poses[body]),
            (Some(body), Some(section)) => self.placement.after(section.pose(eta).after(poses[body])),
        }
    }

    /// Its Jacobian, `6 × nv` by rows, angular rows first; zero in the world. This allocates.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn jacobian(&self, dynamics: &Dynamics, q: &[f64], axes: Axes, out: &mut [f64]) -> Result<(), Error> {
        let (model, nv) = (dynamics.model(), dynamics.nv());
        SizeError::check("jacobian", out.len(), 6 * nv)?;
        let mut poses = vec![Transform::identity(); model.bodies().len()];
        dynamics.placements(q, &mut poses)?;
        let Some(body) = self.body else {
            out.fill(0.0);
            return Ok(());
        };
        if dynamics.modes() == 0 {
            return Ok(jacobian(&model, &poses, Frame { body, placement: self.placement }, axes, out)?);
        }
        // Where links bend: what every coordinate does to the frame, one after the other.
        let eta = dynamics.eta(q);
        let carried = self.section.as_ref().map_or_else(Transform::identity, |s| s.pose(eta));
        let to_world = self.placement.after(carried.after(poses[body])).rotation();
        let mut twists = vec![Motion::zero(); poses.len()];
        for k in 0..nv {
            let mut unit = vec![0.0; nv];
            unit[k] = 1.0;
            dynamics.velocities(q, &unit, &mut twists)?;
            let own = self.section.as_ref().map_or_else(Motion::zero, |s| s.velocity(eta, &unit[nv - eta.len()..]));
            let v = self.placement.motion(carried.motion(twists[body]) + own);
            let (ang, lin) = match axes {
                Axes::World => (to_world * v.ang, to_world * v.lin),
                Axes::Local => (v.ang, v.lin),
            };
            let column = ang.to_array().into_iter().chain(lin.to_array());
            column.enumerate().for_each(|(row, x)| out[row * nv + k] = x);
        }
        Ok(())
    }
}
