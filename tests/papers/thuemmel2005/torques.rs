//! Table 1 and figure 6: what the inverse dynamics of four models needs, and the torques that it finds.

use crate::arm::{N, robot, scenario};
use gyroflex_sim::inverse::{InverseRun, SmoothnessTable};
use gyroflex_sim::record::MemoryRecorder;
use gyroflex_sim::scenario::JointReference;
use gyroflex_sim::zeros::InverseOutput;
use gyroflex_sim::{Error, Fidelity};
use std::ops::{ControlFlow, Range};

/// The compared models, the first being what the others are compared with.
pub const MODELS: [Fidelity; 4] = [Fidelity::Complete, Fidelity::Reduced, Fidelity::Rigid, Fidelity::RigidReflected];

/// Where the whole filter of 8 lags is 3 dB down [Hz], as the paper's "cut-off frequency of 5 Hz" can be read: for the whole filter, and for
/// each lag, whence `5 √(2^(1/8) − 1)` for all.
pub const CUTOFFS: [f64; 2] = [5.0, 1.504];

/// Highest derivative of any joint's position that the torques of the complete and of the reduced model depend on.
///
/// # Errors
/// A robot that cannot be read.
pub fn orders(of: &str) -> Result<[u8; 2], Error> {
    let joints = SmoothnessTable::of(&robot(of)?)?.joints;
    let highest =
        |order: fn(&gyroflex_sim::inverse::JointSmoothness) -> u8| joints.iter().map(order).max().unwrap_or(0);
    Ok([highest(|j| j.complete), highest(|j| j.reduced)])
}

/// Torques along the filtered step.
pub struct Torques {
    /// Times [s].
    pub time: Vec<f64>,
    /// By model, joint and time: motor torques, reflected [N m].
    pub of: Vec<[Vec<f64>; N]>,
}

/// Size of a signal.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// Largest absolute value.
    pub peak: f64,
    /// Root mean square.
    pub rms: f64,
}

impl Size {
    /// The size of some values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let (mut peak, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
        for x in values {
            (peak, sum, count) = (peak.max(x.abs()), sum + x * x, count + 1.0);
        }
        Self { peak, rms: (sum / f64::max(count, 1.0)).sqrt() }
    }
}

impl Torques {
    /// Finds them by all models for a robot along `step.yaml`, the whole filter being 3 dB down at `cutoff` [Hz].
    ///
    /// # Errors
    /// Files that cannot be read.
    pub fn along_step(of: &str, cutoff: f64) -> Result<Self, Error> {
        let (robot, mut file) = (robot(of)?, scenario("step.yaml")?);
        for joint in file.scenario.reference.joints.values_mut() {
            if let JointReference::FilteredStep { cutoff: own, .. } = joint {
                *own = cutoff;
            }
        }
        let mut out = Self { time: Vec::new(), of: Vec::new() };
        for model in MODELS {
            let mut run = InverseRun::new(&robot, &file, Some(model), 0.0, InverseOutput::Link)?;
            let mut record = MemoryRecorder::new(run.run_info());
            run.run(&mut record, &mut |_| ControlFlow::Continue(()))?;
            let samples = record.samples();
            out.time = samples.iter().map(|s| s.t).collect();
            out.of.push(std::array::from_fn(|j| samples.iter().map(|s| s.tau[j]).collect()));
        }
        Ok(out)
    }

    /// Torques of some joints by the complete model [N m].
    pub fn torque(&self, joints: Range<usize>) -> Size {
        Size::of(joints.flat_map(|j| self.of[0][j].iter().copied()))
    }

    /// What a model's torques of some joints have more than the complete one's [N m].
    pub fn error(&self, model: usize, joints: Range<usize>) -> Size {
        Size::of(joints.flat_map(|j| self.difference(model, j)))
    }

    /// The same over time, of one joint.
    pub fn difference(&self, model: usize, joint: usize) -> Vec<f64> {
        self.of[model][joint].iter().zip(&self.of[0][joint]).map(|(a, b)| a - b).collect()
    }
}
