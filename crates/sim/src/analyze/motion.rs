//! One instant of a motion: what inverse dynamics needs.

/// One instant of a motion. Vectors have `nv` entries, `q` has `nq`; motors are reflected to the link side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// Time [s]; the number of the sample where there is none.
    pub t: f64,
    /// Positions [rad or m].
    pub q: Vec<f64>,
    /// Velocities.
    pub qd: Vec<f64>,
    /// Accelerations.
    pub qdd: Vec<f64>,
    /// Motor positions [rad or m].
    pub theta: Vec<f64>,
    /// Motor velocities.
    pub thetad: Vec<f64>,
    /// Motor accelerations.
    pub thetadd: Vec<f64>,
    /// Torques through the transmissions and of the motors [N m or N], where they are recorded; else those of the complete
    /// model's inverse dynamics count.
    pub torques: Option<[Vec<f64>; 2]>,
}
