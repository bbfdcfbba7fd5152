//! The Rust that `gyroflex codegen` writes for the arms. Usage: `gyroflex-straight-line FOLDER ROBOT… [--count ROW CALLS]`

mod arm;
#[path = "../../../src/peers/mod.rs"]
#[allow(dead_code, unused_imports)] // shared with gyroflex's program, which has other needs
mod peers;

use arm::{Arm, State};
use peers::Worker;

// A module for every arm; `stages/build.py` writes the list.
include!(concat!(env!("GENERATED"), "/arms.rs"));

/// An arm without rotors, which is a robot without motor coordinates.
macro_rules! rigid {
    ($name:ident) => {
        Arm {
            forward: |State { q, qd, tau, .. }, [qdd, _, tau_j]| $name::forward_dynamics(q, qd, tau, qdd, tau_j),
            inverse: |State { q, qd, qdd, .. }, [tau_j, tau, _]| $name::inverse_dynamics(q, qd, qdd, tau_j, tau),
        }
    };
}

macro_rules! elastic {
    ($name:ident) => {
        Arm {
            forward: |State { q, qd, theta, thetad, tau, .. }, [qdd, thetadd, tau_j]| {
                $name::forward_dynamics(q, qd, theta, thetad, tau, qdd, thetadd, tau_j)
            },
            inverse: |State { q, qd, theta, thetad, qdd, thetadd, .. }, [tau_j, tau, _]| {
                $name::inverse_dynamics(q, qd, theta, thetad, qdd, thetadd, tau_j, tau)
            },
        }
    };
}

fn main() {
    let mut worker = Worker::from_args();
    for name in worker.robots.clone() {
        match name.as_str() {
            "panda" => arm::add::<7>(&mut worker, &name, rigid!(panda)),
            "panda_flex" => arm::add::<7>(&mut worker, &name, elastic!(panda_flex)),
            "ur5" => arm::add::<6>(&mut worker, &name, rigid!(ur5)),
            "ur5_flex" => arm::add::<6>(&mut worker, &name, elastic!(ur5_flex)),
            _ => {}
        }
    }
    worker.serve();
}
