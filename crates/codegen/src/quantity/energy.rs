//! Energies.

use super::Options;
use super::bending::Storage;
use super::tracing::traced;
use crate::function::Function;
use crate::robot::Robot;
use gyroflex::dynamics::{Energy, flexible_energy};
use gyroflex::spatial::{Motion, Transform};

/// Kinetic, gravity and elastic energy. Of regrouped links it would be another's.
pub(super) fn energy(robot: &Robot, options: &Options) -> Function {
    traced("energy", "Energies of links, rotors and springs.", |t| {
        let state = t.state(robot);
        let records = t.records(robot, options);
        let energy = match records.flexible() {
            Some(model) => flexible_energy(&model, state.view(), Storage::of(&model).lend()),
            None => {
                let mut scratch = vec![(Transform::identity(), Motion::zero()); records.view().bodies().len()];
                gyroflex::dynamics::energy(&records.view(), state.view(), &mut scratch)
            }
        };
        let Energy { kinetic, gravity, elastic } = energy.expect("lengths are the model's");
        t.vector("kinetic", &[kinetic], "of links and rotors [J]");
        t.vector("gravity", &[gravity], "in the field of gravity, zero for a mass at the world's origin [J]");
        t.vector("elastic", &[elastic], "in the springs of transmissions and links, zero where unloaded [J]");
    })
}
