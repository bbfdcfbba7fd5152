//! What is told of contacts: where they are, their forces, and what those amount to.

use super::Contacts;
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::record::{Footing, Touch};
use gyroflex::spatial::Vec3;

impl Contacts {
    /// Heights of all contact points above the ground at a position [m].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn gaps(&mut self, dynamics: &Dynamics, q: &[f64], out: &mut Vec<f64>) -> Result<(), Error> {
        out.clear();
        let Some(ground) = self.ground else { return Ok(()) };
        dynamics.placements(q, &mut self.poses)?;
        out.extend(self.points.iter().map(|p| p.place(&self.poses).z - ground.height));
        Ok(())
    }

    /// What is logged: contacts, centre of mass, zero-moment point. Forces are those of the last call of [`Contacts::forward`], `couple` is what the
    /// ground exerts besides [N m].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn report(
        &mut self,
        dynamics: &Dynamics,
        q: &[f64],
        couple: Vec3<f64>,
        out: &mut Footing,
    ) -> Result<(), Error> {
        dynamics.placements(q, &mut self.poses)?;
        let (mut mass, mut moment) = (0.0, Vec3::zero());
        let model = dynamics.model();
        for (body, pose) in model.bodies().iter().zip(&self.poses) {
            // The records are in frames of their own, the poses are those of link frames.
            let inertia = body.inertia;
            let link = body.frame.inverse().after(*pose);
            mass += inertia.mass;
            moment +=
                link.point(inertia.first_moment.scale(1.0 / inertia.mass.max(f64::MIN_POSITIVE))).scale(inertia.mass);
        }
        out.center_of_mass = moment.scale(1.0 / mass).to_array();
        out.contacts.resize(self.points.len(), Touch::default());
        let height = self.ground.map_or(0.0, |ground| ground.height);
        let (mut load, mut at) = (0.0, [-couple.y, couple.x]);
        for i in 0..self.points.len() {
            let (place, force) = (self.points[i].place(&self.poses), self.force(i));
            out.contacts[i] =
                Touch { force: force.to_array(), gap: place.z - height, mode: self.points[i].mode.number() };
            load += force.z;
            at[0] += place.x * force.z;
            at[1] += place.y * force.z;
        }
        out.zero_moment_point = match load > 0.0 {
            true => at.map(|moment| moment / load),
            false => [out.center_of_mass[0], out.center_of_mass[1]],
        };
        out.drift = self.largest_drift;
        Ok(())
    }

    /// Where a contact point is at a position [m].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn place(&mut self, contact: usize, dynamics: &Dynamics, q: &[f64]) -> Result<Vec3<f64>, Error> {
        dynamics.placements(q, &mut self.poses)?;
        Ok(self.points[contact].place(&self.poses))
    }
}
