//! The two-link arm of Cetinkunt & Book's case study: joint angles of the flexible arm beside those of the rigid one.

use gyroflex::dynamics::{External, Forward, State};
use gyroflex::integrate::StateMut;
use gyroflex_sim::Dynamics;
use gyroflex_sim::error::Error;
use gyroflex_sim::load::{LoadOptions, load_urdf_text};
use std::f64::consts::TAU;

const URDF: &str = include_str!("../../../robots/book_two_link/book_two_link.urdf");
/// What the paper takes from the beams' ends.
pub const BOUNDARIES: [&str; 2] = ["clamped_free", "clamped_clamped"];
/// Samples of a run.
const SAMPLES: usize = 400;
/// End of a run [s].
const END: f64 = 2.0;
/// Torques [N m] of one wave of a sine in the first second; the paper does not print its own.
const TORQUES: [f64; 2] = [3.0, 1.0];

/// Joint angles over time, and how well the energy balance closes.
pub struct Response {
    /// Time [s].
    pub time: Vec<f64>,
    /// Angles of both joints [rad].
    pub angles: [Vec<f64>; 2],
    /// Largest difference between the energy and what the motors put in, over the largest energy.
    pub balance: f64,
}

/// The arm with two modes per link of this stiffness [N m²], or rigid.
pub fn response(flexible: Option<(f64, &str)>) -> Result<Response, Error> {
    let beam = |link: &str, stiffness: f64, boundary: &str| {
        format!(
            "  {link}:\n    length: 1.0\n    mass_per_length: 0.5\n    bending_y: {{stiffness: {stiffness}, boundary: {boundary}, modes: 2}}\n"
        )
    };
    let mut yaml = "urdf: book_two_link.urdf\ngravity: [0, 0, 0]\n".to_owned();
    if let Some((stiffness, boundary)) = flexible {
        yaml += "flexible_links:\n";
        yaml += &["upper", "lower"].map(|link| beam(link, stiffness, boundary)).concat();
    }
    let robot = load_urdf_text(URDF, "book_two_link.urdf", Some(&yaml), &LoadOptions::default())?;
    let mut dynamics = Dynamics::new(robot.model(robot.fidelity)?);
    let n = dynamics.nv();
    let [mut q, mut qd, mut theta, mut thetad, mut tau] = [(); 5].map(|()| vec![0.0; n]);
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; n]);
    let mut out = Response { time: Vec::new(), angles: [Vec::new(), Vec::new()], balance: 0.0 };
    let (mut work, mut largest, mut worst) = (0.0, 0.0_f64, 0.0_f64);
    // The fastest mode waves at 15 kHz where EI is 10⁵ N m², and slower as its root.
    let every = flexible.map_or(250.0, |(stiffness, _)| (stiffness / 1e3).sqrt().max(1.0) * 250.0).round() as usize;
    let steps = every * SAMPLES;
    let step = END / steps as f64;
    for k in 0..=steps {
        let time = k as f64 * step;
        let energy = dynamics.energy(State { q: &q, qd: &qd, theta: &theta, thetad: &thetad })?;
        let total = energy.kinetic + energy.elastic;
        (largest, worst) = (largest.max(total), worst.max(f64::abs(total - work)));
        if k % every == 0 {
            out.time.push(time);
            (0..2).for_each(|j| out.angles[j].push(q[j]));
        }
        // Held over a step: the middle of it, so that arms with different steps get the same impulse to second order.
        let wave = if 2 * k < steps { (TAU * (time + 0.5 * step)).sin() } else { 0.0 };
        (0..2).for_each(|j| tau[j] = wave * TORQUES[j]);
        let before = [q[0], q[1]];
        let state = StateMut { q: &mut q, qd: &mut qd, theta: &mut theta, thetad: &mut thetad };
        dynamics.rk4(state, &tau, External::none(), step)?;
        work += (0..2).map(|j| tau[j] * (q[j] - before[j])).sum::<f64>();
    }
    // The last accelerations are asked for to see that they are numbers.
    let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
    dynamics.forward(
        state,
        &tau,
        External::none(),
        Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j },
    )?;
    debug_assert!(qdd.iter().all(|a| a.is_finite()));
    out.balance = worst / largest;
    Ok(out)
}

impl Response {
    /// The largest difference of both joints' angles from those of another run [rad].
    pub fn from(&self, other: &Self) -> [f64; 2] {
        [0, 1].map(|j| {
            self.angles[j].iter().zip(&other.angles[j]).fold(0.0, |most, (a, b)| f64::max(most, f64::abs(a - b)))
        })
    }
}
