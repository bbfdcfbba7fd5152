//! Tables over semihosting, and whether what they say is right.

use crate::board::Board;
use crate::count::Count;
use crate::motion;
use core::hint::black_box;
use cortex_m_semihosting::hprintln;
use gyroflex::dynamics::placements;
use gyroflex::model::Model;
use gyroflex::spatial::Transform;
use gyroflex_firmware::arm::{N, complete, rigid};
use gyroflex_firmware::elastic::Elastic;
use gyroflex_firmware::held::Held;
use gyroflex_firmware::laws::{LAWS, elastic_inverse_is_rnea, held_is_pushed, worse};
use gyroflex_firmware::random::{Dice, Point};
use gyroflex_firmware::scratch::{Accelerations, Scratch, Torques, forward, inverse, mass_matrix};

/// States that every law is shown at, and that every algorithm is counted at.
const STATES: usize = 200;
/// A link is to be where it should to a tenth of the deflection that holding the arm up costs its second joint: what a
/// controller that knew nothing of the transmissions would be off by [rad].
const TRACKING: f32 = 1e-3;
/// A contact is to be seen to this part of its torque.
const CONTACT: f32 = 0.1;

/// Whether all that was reported held.
pub struct Verdict(bool);

impl Verdict {
    pub fn new() -> Self {
        Self(true)
    }

    pub fn held(&self) -> bool {
        self.0
    }

    /// NaN does not hold.
    fn at_most(&mut self, value: f32, bound: f32) -> &'static str {
        let held = value <= bound;
        self.0 &= held;
        if held { "" } else { "  FAILED" }
    }
}

/// The laws, at random states of two models.
pub fn laws(seed: u32, verdict: &mut Verdict) {
    let mut scratch = Scratch::new();
    for (name, model) in [("complete", &complete::MODEL), ("rigid", &rigid::MODEL)] {
        for law in &LAWS {
            let mut dice = Dice::new(seed);
            let mut worst = 0.0;
            for _ in 0..STATES {
                let point = Point::random(&mut dice);
                let point = if name == "rigid" { point.geared() } else { point };
                // A slice of the wrong length is as bad as a wrong number.
                worst = worse(worst, (law.error)(model, &point, &mut scratch).unwrap_or(f32::NAN));
            }
            let mark = verdict.at_most(worst, law.bound);
            hprintln!("law {:<9} {:<36} {:8.1e} of {:.0e}{}", name, law.name, worst, law.bound, mark);
        }
    }
}

/// The inverse of the elastic arm is inverse dynamics at the motion of the motors that it finds.
pub fn elastic_law(seed: u32, verdict: &mut Verdict) {
    let (mut dice, mut scratch, mut elastic) = (Dice::new(seed), Scratch::new(), Elastic::new());
    let mut worst = 0.0;
    for _ in 0..STATES {
        let point = Point::random(&mut dice);
        let error = elastic_inverse_is_rnea(&complete::MODEL, &point, &mut scratch, &mut elastic);
        worst = worse(worst, error.unwrap_or(f32::NAN));
    }
    let mark = verdict.at_most(worst, 1e-3);
    hprintln!(
        "law {:<9} {:<36} {:8.1e} of {:.0e}{}",
        "complete",
        "elastic inverse and inverse dynamics",
        worst,
        1e-3,
        mark
    );
}

/// The arm with its tip held moves as the arm that the tip's force pushes.
pub fn held_law(seed: u32, verdict: &mut Verdict) {
    let (mut dice, mut scratch, mut held) = (Dice::new(seed), Scratch::new(), Held::new());
    let mut worst = 0.0;
    for _ in 0..STATES {
        let point = Point::random(&mut dice);
        let error = held_is_pushed(&complete::MODEL, &point, &mut scratch, &mut held);
        worst = worse(worst, error.unwrap_or(f32::NAN));
    }
    let mark = verdict.at_most(worst, 1e-2);
    hprintln!("law {:<9} {:<36} {:8.1e} of {:.0e}{}", "complete", "tip held and tip pushed", worst, 1e-2, mark);
}

/// Instructions of every algorithm, at random states.
pub fn counts(board: &Board, seed: u32, verdict: &mut Verdict) {
    let (complete, rigid) = (black_box(&complete::MODEL), black_box(&rigid::MODEL));
    let mut scratch = Scratch::new();
    let (mut torques, mut moved) = (Torques::default(), Accelerations::default());
    let (mut matrix, mut poses) = ([[0.0; N]; N], [Transform::identity(); N]);
    let mut count = |name: &str, call: &mut dyn FnMut(&Point) -> bool| {
        let mut dice = Dice::new(seed);
        let (mut count, mut done) = (Count::NONE, true);
        for _ in 0..STATES {
            let point = Point::random(&mut dice);
            count.add(board, || done &= call(black_box(&point)));
        }
        verdict.0 &= done;
        show(name, count);
    };
    count("rnea_complete", &mut |p| {
        inverse(complete, p.state(), p.acceleration(), &[], &mut scratch, &mut torques).is_ok()
    });
    count("rnea_rigid", &mut |p| inverse(rigid, p.state(), p.acceleration(), &[], &mut scratch, &mut torques).is_ok());
    count("aba_complete", &mut |p| forward(complete, p.state(), &p.tau, &[], &mut scratch, &mut moved).is_ok());
    count("aba_rigid", &mut |p| forward(rigid, p.state(), &p.tau, &[], &mut scratch, &mut moved).is_ok());
    count("crba", &mut |p| mass_matrix(complete, &p.q, &mut scratch, &mut matrix).is_ok());
    count("placements", &mut |p| placements(complete, &p.q, &mut poses).is_ok());
    let mut elastic = Elastic::new();
    count("elastic_inverse6", &mut |p| elastic.invert(complete, p).is_ok());
    let mut held = Held::new();
    count("held_forward", &mut |p| held.accelerate(complete, p).is_ok());
    count("held_impact", &mut |p| held.catch(complete, p).is_ok());
    count("held_inverse", &mut |p| held.drive(complete, p).is_ok());
    let _ = black_box((elastic, held, torques, moved, matrix, poses));
}

/// The 1 kHz loop.
pub fn motion(board: &Board, verdict: &mut Verdict) {
    let model: &Model<f32> = black_box(&complete::MODEL);
    let Ok(outcome) = motion::run(model, board) else {
        verdict.0 = false;
        return;
    };
    show("loop", outcome.step);
    let mark = verdict.at_most(outcome.tracking, TRACKING);
    hprintln!("loop tracking error {:.1e} rad of {:.0e}{}", outcome.tracking, TRACKING, mark);
    let acting = outcome.acting.iter().fold(0.0, |m: f32, x| m.max(x.abs()));
    let (bound, mark) = (CONTACT * acting, verdict.at_most(outcome.false_contact, CONTACT * acting));
    hprintln!("loop contact seen without one {:.2} N m of {:.1}{}", outcome.false_contact, bound, mark);
    let wrong = (0..N).fold(0.0, |e, i| worse(e, (outcome.contact[i] - outcome.acting[i]).abs()));
    let mark = verdict.at_most(wrong, bound);
    hprintln!("loop contact of {:.1} N m seen to {:.2} N m of {:.1}{}", acting, wrong, bound, mark);
}

fn show(name: &str, count: Count) {
    hprintln!("count {:<16} {:>8} {:>8}", name, count.least, count.most);
}
