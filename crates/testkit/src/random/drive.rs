//! Random drives.

use super::{Dice, Options, RandomRobot};
use gyroflex::model::{
    DriveSpec, Friction, JointKind, MountSpec, RotorBody, RotorSpec, SpringSpec, TransmissionError, TransmissionSpec,
};

/// Torques in transmissions are about this large [N m].
pub(super) const TORQUE: f64 = 50.0;

impl RandomRobot {
    pub(super) fn add_drives(&mut self, dice: &mut Dice, options: &Options) {
        for i in 0..self.bodies.len() {
            if self.bodies[i].joint == JointKind::Floating || !dice.chance(options.driven) {
                continue;
            }
            let gear_ratio = dice.sign() * dice.magnitude(1.0, 200.0);
            let transmission = self.transmission(dice, options, gear_ratio);
            let rigid = matches!(transmission, TransmissionSpec::Rigid);
            let rotor = self.rotor(dice, options, i, rigid);
            let friction = if dice.chance(options.friction) {
                Friction::coulomb(dice.magnitude(1e-5, 1e-3), dice.within(0.0, 0.02), dice.within(0.5, 10.0))
                    .with_stribeck(if dice.chance(0.5) { dice.within(0.0, 0.02) } else { 0.0 }, dice.within(2.0, 50.0))
            } else {
                Friction::none()
            };
            self.bodies[i].drive = Some(DriveSpec { rotor, gear_ratio, transmission, friction });
        }
    }

    fn rotor(&self, dice: &mut Dice, options: &Options, joint: usize, rigid: bool) -> RotorSpec {
        let body = &self.bodies[joint];
        let mut inertia = dice.magnitude(1e-5, 1e-3);
        let remote = dice.chance(options.remote_mount) && (options.remote_rigid || !rigid);
        let carrier = if remote { self.ancestor(dice, joint) } else { body.parent };
        // Where a data sheet would leave it, or anywhere.
        let (placement, axis) = if carrier == body.parent && dice.chance(0.4) {
            (body.placement, body.axis)
        } else {
            (dice.placement(0.2), dice.axis())
        };
        let rotor_body = match carrier {
            Some(link) if dice.chance(options.contained) => {
                // All rotors together must fit into the link.
                inertia = inertia.min(0.02 * self.smallest_moment(link));
                None
            }
            _ => {
                Some(RotorBody { mass: dice.magnitude(0.1, 2.0), transverse_inertia: inertia * dice.within(0.5, 2.0) })
            }
        };
        RotorSpec { inertia, body: rotor_body, mount: MountSpec { body: carrier, placement, axis } }
    }

    /// The parent, its parent, …, or the world.
    fn ancestor(&self, dice: &mut Dice, joint: usize) -> Option<usize> {
        let mut link = self.bodies[joint].parent;
        while let Some(here) = link {
            if dice.chance(0.3) {
                break;
            }
            link = self.bodies[here].parent;
        }
        link
    }

    fn transmission(&mut self, dice: &mut Dice, options: &Options, gear_ratio: f64) -> TransmissionSpec {
        if !dice.chance(options.elastic) {
            return TransmissionSpec::Rigid;
        }
        let stiffness = dice.magnitude(1e2, 1e5);
        let spring = if dice.chance(options.table) {
            self.spring_table(dice, stiffness)
        } else {
            // As large as the linear part at the usual torque.
            let cubic = stiffness * (stiffness / TORQUE).powi(2) * dice.within(0.0, 1.0);
            SpringSpec::Polynomial { stiffness, cubic: if dice.chance(options.cubic) { cubic } else { 0.0 } }
        };
        let damping = if dice.chance(options.damping) { dice.magnitude(0.1, 20.0) } else { 0.0 };
        let error = if dice.chance(options.transmission_error) {
            let cycles_per_rotor_turn = [1.0, 2.0, 3.0][dice.below(3)];
            let slope = dice.within(0.01, 0.4);
            TransmissionError {
                amplitude: slope / (cycles_per_rotor_turn * gear_ratio),
                cycles_per_rotor_turn,
                phase: dice.within(-3.0, 3.0),
            }
        } else {
            TransmissionError::none()
        };
        TransmissionSpec::Elastic { spring, damping, error }
    }

    /// Steps of random width and slope, from nought or from the negative side.
    fn spring_table(&mut self, dice: &mut Dice, stiffness: f64) -> SpringSpec {
        let (first, len) = (self.spring_tables.len(), 2 + dice.below(5));
        let reach = TORQUE / stiffness;
        let start = if dice.chance(0.5) { 0.0 } else { -dice.within(0.2, 1.0) };
        let mut point = [start * reach, start * TORQUE];
        for _ in 0..len {
            self.spring_tables.push(point);
            let step = dice.within(0.2, 0.6);
            point = [point[0] + step * reach, point[1] + step * dice.within(0.5, 2.0) * TORQUE];
        }
        SpringSpec::Table { first, len }
    }
}
