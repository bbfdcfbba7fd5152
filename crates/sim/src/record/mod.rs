//! Where a simulation's samples go: memory, MCAP, CSV.

use crate::error::Error;
use gyroflex::spatial::Transform;

/// What a recorder must know before the first sample.
#[derive(Clone, Debug)]
pub struct RunInfo {
    /// Names of the single-degree-of-freedom joints in coordinate order: the order of every vector in [`Sample`].
    pub joints: Vec<String>,
    /// For each of these joints whether it has a motor coordinate of its own.
    pub elastic: Vec<bool>,
    /// For each of these joints its gear ratio; `None` without a drive.
    pub gear_ratios: Vec<Option<f64>>,
    /// Name and parent name of every link, in the order of [`Sample::frames`]. Links without a parent hang on `world`.
    pub frames: Vec<(String, String)>,
    /// Whether the robot has a floating root.
    pub floating: bool,
    /// The robot's URDF, for `/robot_description`.
    pub urdf: String,
    /// Files to attach: name and content.
    pub attachments: Vec<(String, String)>,
    /// Parameters and versions of the run, for a metadata record.
    pub metadata: Vec<(String, String)>,
}

/// One instant. Vectors run over [`RunInfo::joints`]; torques and motor positions are reflected to the link side.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    /// Simulated time [s].
    pub t: f64,
    /// Pose of a floating root `x y z qx qy qz qw` in the world.
    pub base_pose: Option<[f64; 7]>,
    /// Twist of a floating root in its own frame, angular part first.
    pub base_twist: Option<[f64; 6]>,
    /// Link positions [rad or m].
    pub q: Vec<f64>,
    /// Link velocities.
    pub qd: Vec<f64>,
    /// Link accelerations.
    pub qdd: Vec<f64>,
    /// Reflected motor positions `θ` [rad or m]; `q` where there is no elastic transmission.
    pub theta: Vec<f64>,
    /// Reflected motor velocities.
    pub thetad: Vec<f64>,
    /// Reflected motor accelerations.
    pub thetadd: Vec<f64>,
    /// Transmission deflection `δ` [rad or m].
    pub deflection: Vec<f64>,
    /// Torque through the transmission `τ_J` [N m or N].
    pub tau_j: Vec<f64>,
    /// Motor torque `τ` [N m or N].
    pub tau: Vec<f64>,
    /// Torque on each link joint that the rotors' coupling causes, `S θ̈ + C₁ θ̇` [N m or N].
    pub gyroscopic: Vec<f64>,
    /// Friction on both sides, reflected [N m or N].
    pub friction: Vec<f64>,
    /// Reference position [rad or m].
    pub reference: Vec<f64>,
    /// Reference minus link position [rad or m].
    pub tracking_error: Vec<f64>,
    /// Kinetic energy of links and rotors [J].
    pub kinetic_energy: f64,
    /// Potential energy of gravity [J].
    pub gravity_energy: f64,
    /// Energy stored in the transmissions [J].
    pub elastic_energy: f64,
    /// Power put in by the motors and external loads [W].
    pub power_in: f64,
    /// Power lost in friction and damping [W], ≥ 0.
    pub dissipation: f64,
    /// Significance ratio `r_s` of the gyroscopic coupling (Zhao et al. 2015, eq. 12); NaN-free: zero at rest.
    pub significance: f64,
    /// Pose of every link frame relative to its parent frame, in the order of [`RunInfo::frames`].
    pub frames: Vec<Transform<f64>>,
}

/// Takes the samples of one run.
pub trait Recorder {
    /// Takes one sample; times never decrease.
    ///
    /// # Errors
    /// When the sample cannot be written; what was written before is safe.
    fn record(&mut self, sample: &Sample) -> Result<(), Error>;

    /// Completes the record. Called once, also after a run that was interrupted or diverged.
    ///
    /// # Errors
    /// When the end of the record cannot be written.
    fn finish(&mut self) -> Result<(), Error>;
}
