//! One second of the 1 kHz loop on a simulated arm, somebody leaning on it.

use crate::board::Board;
use crate::count::Count;
use gyroflex::dynamics::{Acceleration, State};
use gyroflex::model::{Model, SizeError};
use gyroflex_firmware::arm::N;
use gyroflex_firmware::controller::{Controller, PERIOD};
use gyroflex_firmware::laws::worse;
use gyroflex_firmware::plant::Plant;
use gyroflex_firmware::reference::Reference;
use gyroflex_firmware::scratch::{Scratch, Torques, inverse};

const FROM: [f32; N] = [0.0, 0.5, 0.0, -1.2, 0.0, 0.8, 0.0];
const TO: [f32; N] = [0.6, 0.9, 0.3, -0.8, -0.4, 1.2, 0.5];
/// Duration of the motion, of the rest after it, and of the rest in which a constant torque is on a joint [periods].
const MOVE: usize = 600;
const REST: usize = 200;
const CONTACT: usize = 200;
const JOINT: usize = 3;
const TORQUE: f32 = 8.0;

/// What came of it.
pub struct Outcome {
    /// Instructions of the controller's step.
    pub step: Count,
    /// Farthest a link was from where it should be, before the contact [rad].
    pub tracking: f32,
    /// Largest contact torque seen while there was none [N m].
    pub false_contact: f32,
    /// Contact torque seen at the end, and that which acted [N m].
    pub contact: [f32; N],
    pub acting: [f32; N],
}

pub fn run(model: &Model<f32>, board: &Board) -> Result<Outcome, SizeError> {
    let reference = Reference::new(FROM, TO, MOVE as f32 * PERIOD);
    let start = reference.at(0.0, false);
    let mut holding = Torques::default();
    let state = State { q: &start.q, qd: &start.qd, theta: &start.q, thetad: &start.qd };
    let accel = Acceleration { qdd: &start.qdd, thetadd: &start.qdd };
    inverse(model, state, accel, &[], &mut Scratch::new(), &mut holding)?;

    let mut plant = Plant::at_rest(model, &start, &holding.tau_j);
    let mut controller = Controller::new(model, plant.now.theta);
    let (mut step, mut tracking, mut false_contact) = (Count::NONE, 0.0, 0.0);
    let mut on_links = [0.0; N];
    for period in 0..MOVE + REST + CONTACT {
        if period == MOVE + REST {
            on_links[JOINT] = TORQUE;
        }
        let mut tau = Ok([0.0; N]);
        step.add(board, || {
            let target = reference.at(period as f32 * PERIOD, false);
            tau = controller.step(&target, &plant.now);
        });
        let tau = tau?;
        plant.step(&tau, &on_links)?;
        if period < MOVE + REST {
            let target = reference.at((period + 1) as f32 * PERIOD, false);
            tracking = (0..N).fold(tracking, |e, i| worse(e, (plant.now.q[i] - target.q[i]).abs()));
            false_contact = controller.observer.contact.iter().fold(false_contact, |e, x| worse(e, x.abs()));
        }
    }
    Ok(Outcome { step, tracking, false_contact, contact: controller.observer.contact, acting: on_links })
}
