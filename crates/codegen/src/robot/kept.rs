//! How kept parameters enter the records: what `lower.rs` of the core does with them, in closed form.
//!
//! Masses and rotor inertias enter inertias affinely, everything else as it is. What is made of gear ratio and rotor inertia is
//! made once both are known.

use super::parameter::Place;
use super::{Parameter, Records, Robot};
use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::model::Elastic;
use gyroflex::spatial::{SpatialInertia, SymMat3, Vec3};

impl Records {
    /// Puts a symbol in the place of a parameter.
    pub(super) fn enter(&mut self, robot: &Robot, parameter: &Parameter, value: Sym) {
        let nominal = parameter.nominal();
        match parameter.place {
            Place::Gravity => self.gravity = robot.model.gravity().map(|x| Sym::from_f64(x / nominal) * value),
            Place::LinkMass(i) => {
                let own = own_inertia(robot, i);
                let com = own.first_moment.scale(1.0 / own.mass);
                self.grow(robot, i, SpatialInertia::from_com(1.0, com, SymMat3::zero()), value, nominal);
            }
            Place::PayloadMass(i) => {
                if let Some((_, load)) = robot.payload {
                    self.grow(robot, i, load.map(|x| x / nominal), value, nominal);
                }
            }
            Place::Viscous(i) => self.bodies[i].friction.viscous = value,
            Place::Stiffness(i) => self.on_transmission(i, |elastic| elastic.spring.stiffness = value),
            Place::Damping(i) => self.on_transmission(i, |elastic| elastic.damping = value),
            Place::MotorViscous(i) => {
                if let Some(drive) = &mut self.bodies[i].drive {
                    drive.rotor.friction.viscous = value;
                }
            }
            Place::GearRatio(i) => {
                if let Some(drive) = &mut self.bodies[i].drive {
                    drive.rotor.gear_ratio = value;
                }
            }
            Place::RotorInertia(i) => self.spin_up(robot, i, value, nominal),
        }
    }

    /// `1/N`, `B` and `1/B` where `N` or `J` is kept.
    pub(super) fn finish(&mut self, kept: &[(Parameter, Sym)]) {
        for (parameter, _) in kept {
            let (Place::GearRatio(i) | Place::RotorInertia(i)) = parameter.place else { continue };
            let Some(drive) = &mut self.bodies[i].drive else { continue };
            let rotor = &mut drive.rotor;
            rotor.reflected_inertia = rotor.gear_ratio * rotor.gear_ratio * rotor.inertia;
            rotor.inv_gear_ratio = Sym::one() / rotor.gear_ratio;
            rotor.inv_reflected_inertia = Sym::one() / rotor.reflected_inertia;
        }
    }

    fn on_transmission(&mut self, i: usize, set: impl FnOnce(&mut Elastic<Sym>)) {
        if let Some(elastic) = self.bodies[i].drive.as_mut().and_then(|drive| drive.elastic.as_mut()) {
            set(elastic);
        }
    }

    /// Lets the inertia of a body grow by `slope`, given in its link frame, with a parameter.
    fn grow(&mut self, robot: &Robot, i: usize, slope: SpatialInertia<f64>, value: Sym, nominal: f64) {
        let slope = slope.seen_from_parent(robot.model.bodies()[i].frame);
        grow(&mut self.bodies[i].inertia, slope, value, nominal);
    }

    /// A rotor's spin inertia: its own, what is at rest of it in its carrier, and what its own equation takes out of that.
    fn spin_up(&mut self, robot: &Robot, i: usize, value: Sym, nominal: f64) {
        let (Some(spec), Some(record)) = (robot.spec.bodies[i].drive, &mut self.bodies[i].drive) else { return };
        record.rotor.inertia = value;
        let (rotor, gyroscopic) = (spec.rotor, robot.fidelity.is_gyroscopic());
        let eliminated = record.elastic.is_some() && gyroscopic;
        let Some(carrier) = rotor.mount.body else { return };
        let axis = rotor.mount.placement.rotation() * rotor.mount.axis;
        let spin = SymMat3::outer(robot.model.bodies()[carrier].frame.rot.transpose_mul(axis));
        let zero = SpatialInertia::zero();
        let at_rest = match (rotor.body.is_some(), eliminated) {
            (true, false) => SpatialInertia { rotational: spin, ..zero },
            (false, true) => SpatialInertia { rotational: SymMat3::zero() - spin, ..zero },
            _ => zero,
        };
        let body = &mut self.bodies[carrier];
        grow(&mut body.inertia, at_rest, value, nominal);
        if eliminated {
            grow_about(&mut body.rotors, spin, value, nominal);
        }
        // Of a link that bends, the station that carries the rotor has it, too.
        let station = self.bending.as_mut().and_then(|b| Some(&mut b.stations[usize::from(b.seats[i].rotor?)]));
        if let Some(station) = station {
            grow(&mut station.inertia, at_rest, value, nominal);
            if eliminated {
                grow_about(&mut station.rotors, spin, value, nominal);
            }
        }
    }
}

/// Inertia of a link without the payload, in its link frame.
fn own_inertia(robot: &Robot, i: usize) -> SpatialInertia<f64> {
    let all = robot.spec.bodies[i].inertia;
    match robot.payload {
        Some((body, load)) if body == i => SpatialInertia {
            mass: all.mass - load.mass,
            first_moment: all.first_moment - load.first_moment,
            rotational: all.rotational - load.rotational,
        },
        _ => all,
    }
}

fn grow(inertia: &mut SpatialInertia<Sym>, slope: SpatialInertia<f64>, value: Sym, nominal: f64) {
    inertia.mass = grown(inertia.mass, slope.mass, value, nominal);
    let (h, by) = (&mut inertia.first_moment, slope.first_moment);
    *h =
        Vec3::new(grown(h.x, by.x, value, nominal), grown(h.y, by.y, value, nominal), grown(h.z, by.z, value, nominal));
    grow_about(&mut inertia.rotational, slope.rotational, value, nominal);
}

fn grow_about(i: &mut SymMat3<Sym>, by: SymMat3<f64>, value: Sym, nominal: f64) {
    let grown = |x: Sym, slope: f64| grown(x, slope, value, nominal);
    *i = SymMat3 {
        xx: grown(i.xx, by.xx),
        yy: grown(i.yy, by.yy),
        zz: grown(i.zz, by.zz),
        xy: grown(i.xy, by.xy),
        xz: grown(i.xz, by.xz),
        yz: grown(i.yz, by.yz),
    };
}

/// `x + (p − p₀) slope`, the numbers put together: a body without mass of its own but this leaves nothing.
fn grown(x: Sym, slope: f64, value: Sym, nominal: f64) -> Sym {
    let taken = nominal * slope;
    let rest = match x.number() {
        Some(x) if (x - taken).abs() <= ROUNDING * (x.abs() + taken.abs()) => Sym::zero(),
        _ => x - Sym::from_f64(taken),
    };
    rest + Sym::from_f64(slope) * value
}

/// Part of a number below which a difference is rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
