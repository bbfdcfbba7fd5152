//! `gyroflex.Impact`: what happens in no time.

use super::foxglove::Vector3;
use super::message;
use crate::record::{self, RunInfo};

message! { "gyroflex" "gyroflex/Struck.proto"
    /// A point that takes part in an impact.
    Struck {
        1 name: [string] String, "Name of the contact point";
        2 impulse: [message, optional] Option<Vector3>, "Impulse of the ground on it, world axes [N s]";
        3 velocity_before: [message, optional] Option<Vector3>, "Its velocity before the impact, world axes [m/s]";
        4 velocity_after: [message, optional] Option<Vector3>, "Its velocity after the impact, world axes [m/s]";
    }
}

message! { "gyroflex" "gyroflex/Impact.proto"
    /// An impact of the robot with the ground: positions stay, velocities jump.
    Impact {
        1 time: [double] f64, "Simulated time [s]";
        2 contacts: [message, repeated] Vec<Struck>, "Points that take part, those that were on the ground already among them";
        3 energy_lost: [double] f64, "Kinetic energy before less that after [J]";
    }
}

impl Impact {
    /// An impact that belongs to the run.
    pub(crate) fn new(info: &RunInfo, impact: &record::Impact) -> Self {
        let vector = |[x, y, z]: [f64; 3]| Some(Vector3 { x, y, z });
        let struck = |s: &record::Struck| Struck {
            name: info.contacts[s.contact].clone(),
            impulse: vector(s.impulse),
            velocity_before: vector(s.before),
            velocity_after: vector(s.after),
        };
        Self { time: impact.t, contacts: impact.struck.iter().map(struck).collect(), energy_lost: impact.energy_lost }
    }

    /// The impact again; `None` if it is of a point that the run has not.
    pub(crate) fn impact(&self, info: &RunInfo) -> Option<record::Impact> {
        let numbers = |v: &Option<Vector3>| v.as_ref().map_or([0.0; 3], |v| [v.x, v.y, v.z]);
        let struck = |s: &Struck| {
            let contact = info.contacts.iter().position(|name| *name == s.name)?;
            let (before, after) = (numbers(&s.velocity_before), numbers(&s.velocity_after));
            Some(record::Struck { contact, impulse: numbers(&s.impulse), before, after })
        };
        let struck = self.contacts.iter().map(struck).collect::<Option<Vec<_>>>()?;
        Some(record::Impact { t: self.time, struck, energy_lost: self.energy_lost })
    }
}
