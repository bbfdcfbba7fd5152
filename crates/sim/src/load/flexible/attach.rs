//! What sits on links that bend: every joint, rotor and fixed link gets a station.

use super::super::inertial;
use super::FlexibleFiles;
use crate::flexible::{Place, SeatPlaces};
use crate::robot::Robot;
use gyroflex::spatial::Vec3;

impl FlexibleFiles<'_> {
    /// Puts fixed links, joints and rotors on stations, and gives the bodies their inertias.
    ///
    /// A cross-section carries what is next to it: the origin of a joint, fixed or moving, projected on the beam's axis. The rest of
    /// the way is a rigid lever. What hangs on a fixed link moves with that link.
    pub(super) fn attach(&self, robot: &mut Robot) {
        self.fixed_links(robot);
        let mut seats = vec![SeatPlaces::default(); robot.bodies.len()];
        for (i, seat) in seats.iter_mut().enumerate() {
            let joint = &robot.joints[i];
            let (name, parent) = (joint.name.clone(), joint.parent_link.clone());
            let origin = robot.bodies[i].placement.point(Vec3::zero());
            seat.joint = place(robot, &parent, origin, &name);
            let Some(mount) = robot.bodies[i].drive.map(|d| d.rotor.mount) else { continue };
            let link = self.drives.get(&name).and_then(|d| d.rotor.as_ref()?.mount.as_ref()?.link.clone());
            let centre = mount.placement.point(Vec3::zero());
            seat.rotor = place(robot, &link.unwrap_or(parent), centre, &format!("{name}_rotor"));
        }
        robot.flexible.seats = seats;
        for flexure in &robot.flexible.links {
            robot.bodies[flexure.body].inertia = flexure.total_inertia();
        }
    }

    fn fixed_links(&self, robot: &mut Robot) {
        for (i, element) in self.tree.links.iter().enumerate() {
            let link = &robot.links[i];
            let own = inertial::inertia(element).seen_from_parent(link.placement);
            let Some(index) = robot.flexible.of_body(link.body) else { continue };
            if element.inertial.is_none() || robot.flexible.links[index].name == link.name {
                continue;
            }
            let name = link.name.clone();
            if let Some((link, x)) = robot.flexible.place_of(&robot.links, i, Vec3::zero()) {
                let flexure = &mut robot.flexible.links[link];
                let station = flexure.station_at(x, &name);
                flexure.stations[station].inertia = flexure.stations[station].inertia + own;
            }
        }
    }
}

/// The station that carries a point of a link, a new one if there is none; `None` where the link's body does not bend.
fn place(robot: &mut Robot, link: &str, point: Vec3<f64>, name: &str) -> Option<Place> {
    let index = robot.links.iter().position(|l| l.name == link)?;
    let (link, x) = robot.flexible.place_of(&robot.links, index, point)?;
    Some(Place { link, station: robot.flexible.links[link].station_at(x, name) })
}
