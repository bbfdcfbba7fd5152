//! Energies, and the power that changes them.

use super::{DriveAt, Oracle, law};
use crate::State;
use gyroflex::model::TransmissionSpec;

/// Energies of one state [J].
#[derive(Clone, Copy, Debug)]
pub struct Energy {
    /// Of links and rotors.
    pub kinetic: f64,
    /// In the field of gravity, zero at the world's origin.
    pub gravity: f64,
    /// In the transmission springs.
    pub elastic: f64,
}

impl Energy {
    /// The sum.
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravity + self.elastic
    }
}

/// What changes the total energy [W].
#[derive(Clone, Copy, Debug)]
pub struct Power {
    /// Of motors and external forces.
    pub input: f64,
    /// Lost in friction and damping, not negative.
    pub dissipation: f64,
}

impl Oracle<'_> {
    /// Energies at a state.
    pub fn energy(&self, s: &State) -> Energy {
        let (nv, tree) = (self.nv(), self.tree(s));
        let elastic = self.drives().iter().filter(|d| d.free >= nv).map(|d| self.spring_energy(d, s)).sum();
        Energy { kinetic: tree.kinetic_energy(&self.velocities(s)), gravity: tree.gravity_energy(), elastic }
    }

    /// Energy in the spring of an elastic transmission.
    pub(crate) fn spring_energy(&self, d: &DriveAt<'_>, s: &State) -> f64 {
        let TransmissionSpec::Elastic { spring, .. } = &d.spec.transmission else { return 0.0 };
        law::spring_energy(spring, self.spec.spring_tables, self.deflection(d, s).0)
    }

    /// Power of the motor torques and external loads of a state, and what friction and damping take.
    pub fn power(&self, s: &State) -> Power {
        let nv = self.nv();
        let (_, thetad) = self.rotors(s);
        let mut rates = s.qd.clone();
        let mut dissipation: f64 = self.link_friction(s).iter().zip(&s.qd).map(|(f, v)| f * v).sum();
        for ((d, friction), rate) in self.drives().iter().zip(self.motor_friction(s)).zip(thetad) {
            rates[d.joint] = rate;
            dissipation += friction * rate;
            if let (true, TransmissionSpec::Elastic { damping, .. }) = (d.free >= nv, &d.spec.transmission) {
                dissipation += damping * self.deflection(d, s).1.powi(2);
            }
        }
        let motors: f64 = s.tau.iter().zip(&rates).map(|(t, v)| t * v).sum();
        let external: f64 = self.external(s).iter().zip(&s.qd).map(|(t, v)| t * v).sum();
        Power { input: motors + external, dissipation }
    }
}
