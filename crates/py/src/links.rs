//! What hangs on what, for drawings of a robot.

use crate::robot::PyRobot;
use pyo3::prelude::*;
use std::collections::HashMap;

#[pymethods]
impl PyRobot {
    /// Name of every link's parent in the URDF; `None` of the root.
    #[getter]
    fn link_parents(&self) -> HashMap<&str, Option<&str>> {
        self.robot.links.iter().map(|link| (link.name.as_str(), link.parent.as_deref())).collect()
    }

    /// Centre of mass of every link that moves by itself, in the link's axes [m]; links fused to it count as parts of it, and
    /// one without mass has none.
    #[getter]
    fn centers_of_mass(&self) -> HashMap<&str, Option<[f64; 3]>> {
        let bodies = self.robot.joints.iter().zip(&self.robot.bodies);
        bodies
            .map(|(joint, body)| {
                let mass = body.inertia.mass;
                let center = (mass > 0.0).then(|| body.inertia.first_moment.to_array().map(|moment| moment / mass));
                (joint.child_link.as_str(), center)
            })
            .collect()
    }
}
