//! One evaluation point of a robot.

/// Coordinates, rates, accelerations and loads of a robot, as the core takes them: `q` has `nq` entries, every other joint
/// vector `nv`; motor quantities are reflected; six-vectors are angular first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Link positions [rad, m]; a floating root's are `x y z qx qy qz qw`.
    pub q: Vec<f64>,
    /// Link velocities [rad/s, m/s]; a floating root's are its body twist, angular first.
    pub qd: Vec<f64>,
    /// Motor positions [rad, m], meant at joints with an elastic transmission only.
    pub theta: Vec<f64>,
    /// Motor velocities [rad/s, m/s].
    pub thetad: Vec<f64>,
    /// Link accelerations, read by inverse dynamics [rad/s², m/s²].
    pub qdd: Vec<f64>,
    /// Motor accelerations, read by inverse dynamics [rad/s², m/s²].
    pub thetadd: Vec<f64>,
    /// Motor torques, read by forward dynamics [N m, N].
    pub tau: Vec<f64>,
    /// Generalised forces on the link side [N m, N]; empty for none.
    pub tau_ext: Vec<f64>,
    /// One wrench per body, in its link frame about its origin [N m, N]; empty for none.
    pub wrenches: Vec<[f64; 6]>,
}

impl State {
    /// The same state with every number rounded to single precision, so that `f32` and `f64` start from equal numbers.
    /// The spring deflection is a small difference of two such numbers; rounding it afterwards would hide the algorithm.
    pub fn rounded_to_f32(&self) -> Self {
        let round = |x: &[f64]| x.iter().map(|x| f64::from(*x as f32)).collect();
        Self {
            q: round(&self.q),
            qd: round(&self.qd),
            theta: round(&self.theta),
            thetad: round(&self.thetad),
            qdd: round(&self.qdd),
            thetadd: round(&self.thetadd),
            tau: round(&self.tau),
            tau_ext: round(&self.tau_ext),
            wrenches: self.wrenches.iter().map(|w| w.map(|x| f64::from(x as f32))).collect(),
        }
    }
}
