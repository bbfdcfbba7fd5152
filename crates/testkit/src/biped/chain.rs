//! The biped on the pinned tip `b` as a description for the core.

use super::Biped;
use gyroflex::model::{BodySpec, Friction, JointKind};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};

impl Biped {
    /// Five revolute joints about +y from the tip `b` on, world x forward and z up. All links point upwards at zero, so that
    /// the coordinates are the paper's `q` of eq. 25 and the loads its `T_q`. To be had with gravity along −z.
    pub fn pinned_chain(&self) -> Vec<BodySpec> {
        let body = |i: usize| BodySpec {
            parent: i.checked_sub(1),
            joint: JointKind::Revolute,
            axis: Vec3::new(0.0, 1.0, 0.0),
            placement: Transform::from_pose(Mat3::identity(), Vec3::new(0.0, 0.0, self.before(i))),
            inertia: SpatialInertia::from_com(self.mass[i], Vec3::new(0.0, 0.0, self.centre[i]), self.moments(i)),
            friction: Friction::none(),
            drive: None,
        };
        (0..5).map(body).collect()
    }

    /// Gravity of the pinned chain, in its world axes [m/s²].
    pub fn chain_gravity(&self) -> Vec3<f64> {
        Vec3::new(0.0, 0.0, -self.gravity)
    }

    fn before(&self, i: usize) -> f64 {
        i.checked_sub(1).map_or(0.0, |parent| self.reach(parent))
    }

    /// Equal in all directions: what is not about y does nothing in the plane.
    fn moments(&self, i: usize) -> SymMat3<f64> {
        let about = self.inertia[i];
        SymMat3 { xx: about, yy: about, zz: about, xy: 0.0, xz: 0.0, yz: 0.0 }
    }
}
