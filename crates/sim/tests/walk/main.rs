//! A planar biped walks: the controller by itself, with feet that are held as its phases say.

mod held;

use gyroflex_sim::gait::{Gait, HipPath, LegLengths, PlanarGait};
use gyroflex_sim::walk::{Beliefs, Sliding, WalkSettings};
use held::Walk;

pub fn gait() -> PlanarGait {
    let gait = Gait {
        step_length: 0.7,
        speed: 1.0,
        double_support: 0.1,
        clearance: 0.05,
        touchdown_speed: 0.03,
        hip: HipPath { height: Some(0.43), rise: 0.03, surge: 0.015, lead: -0.02 },
        trunk_pitch: 0.05,
        leg: LegLengths { thigh: 0.302, shank: 0.332 },
    };
    PlanarGait::new(gait).expect("the legs can walk it")
}

pub fn settings(beliefs: Beliefs) -> WalkSettings {
    let env = |n: &str| std::env::var(n).map_or(0.3, |x| x.parse::<f64>().unwrap());
    let sliding = |eta| Sliding { lambda: 10.0, alpha: 10.0, sigma: 35.0, eta };
    WalkSettings {
        beliefs,
        rotors: true,
        single: sliding(2.0),
        double: sliding(1.0),
        rear_share: [env("S0"), env("S1")],
    }
}

#[test]
fn debug_walk() {
    let e = |n: &str, d| std::env::var(n).map_or(d, |x| x.parse::<f64>().unwrap());
    let beliefs = Beliefs { mass: e("BM", 1.4), length: e("BL", 1.1) };
    let path = std::env::var("BIPED").unwrap_or("/tmp/b5/robot.yaml".into());
    let rate: f64 = std::env::var("RATE").map_or(1000.0, |x| x.parse().unwrap());
    let mut walk = Walk::new(
        path.as_ref(),
        gait(),
        settings(beliefs),
        rate,
        std::env::var("SUB").map_or(2, |x| x.parse().unwrap()),
    );
    for _ in 0..20 {
        match walk.step() {
            Ok(done) => println!("{done:?}"),
            Err(e) => {
                println!("{e}");
                break;
            }
        }
    }
}
