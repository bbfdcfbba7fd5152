//! The walks of Mu & Wu (2004), section 4, from the scenarios of the robots, and what they amount to.

use gyroflex_sim::contact::{Event, EventKind};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::record::{MemoryRecorder, Table};
use gyroflex_sim::scenario::{Controller, Walk};
use gyroflex_sim::{ScenarioFile, Simulation};
use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// The first step begins in its middle, with all errors at zero; figures are of those after it [s].
const SETTLED: f64 = 1.1;

/// A walk and its record.
pub struct Study {
    pub table: Table,
    pub events: Vec<Event>,
    pub drift: f64,
    pub walk: Walk,
    /// Time of the gait at time 0 [s].
    pub offset: f64,
}

/// What is asked of one phase.
#[derive(Clone, Copy, Debug, Default)]
pub struct Figures {
    /// Largest errors of hip ahead, hip up [m] and trunk [rad].
    pub errors: [f64; 3],
    /// Least vertical force on the foot that stands or is in front, and on the rear one [N].
    pub vertical: [f64; 2],
    /// Largest ratio of horizontal to vertical force, of both.
    pub friction: [f64; 2],
    /// Largest torque of a joint, of the ankle [N m].
    pub torque: f64,
}

/// Runs a scenario of the project, its text changed.
pub fn walk(scenario: &str, change: impl Fn(String) -> String) -> Result<Study, Box<dyn Error>> {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots").join(scenario);
    let text = change(std::fs::read_to_string(&path)?);
    let file = ScenarioFile::parse(&text, &path)?;
    let robot = load(&file.robot_path(), &LoadOptions::default())?;
    let Controller::Walk(walk) = file.scenario.controller.clone() else { return Err("it does not walk".into()) };
    let mut simulation = Simulation::new(&robot, &file)?;
    let mut recorder = MemoryRecorder::new(simulation.run_info());
    let summary = simulation.run(&mut recorder, &mut |_| ControlFlow::Continue(()))?;
    Ok(Study {
        table: recorder.table(),
        offset: 0.5 * walk.gait.single_support(),
        walk: *walk,
        drift: summary.constraint_drift.unwrap_or_default(),
        events: summary.events,
    })
}

impl Study {
    /// A column of the record.
    pub fn column(&self, name: &str) -> &[f64] {
        self.table.get(name).unwrap_or_else(|| panic!("the record has no {name}"))
    }

    /// Step and part of it, on one foot or on both, at a time of the record; the phases are those that happened.
    pub fn phase(&self, t: f64) -> (i64, bool) {
        let step = ((t + self.offset) / self.walk.gait.step_time()).floor();
        let touched =
            self.touch_downs().any(|at| at <= t && ((at + self.offset) / self.walk.gait.step_time()).floor() == step);
        (step as i64, touched)
    }

    /// When swinging feet came down [s].
    pub fn touch_downs(&self) -> impl Iterator<Item = f64> {
        self.landings().map(|e| e.t)
    }

    /// The first touch-down of the swinging foot in the second half of each swing: feet may hop after it.
    pub fn landings(&self) -> impl Iterator<Item = &Event> {
        let gait = self.walk.gait;
        let mut last = -1;
        self.events.iter().filter(move |e| {
            let t = e.t + self.offset;
            let step = (t / gait.step_time()).floor();
            let swings = (step as i64 + 1).rem_euclid(2) as usize;
            let late = t - step * gait.step_time() > 0.5 * gait.single_support();
            let lands = e.kind == EventKind::TouchDown && e.contact == swings && late && step as i64 > last;
            if lands {
                last = step as i64;
            }
            lands
        })
    }

    /// Figures of one phase: on one foot, or on both.
    pub fn figures(&self, both: bool) -> Figures {
        let mut out = Figures { vertical: [f64::INFINITY; 2], ..Figures::default() };
        let time = self.column("time");
        let errors = ["hip_x", "hip_z", "trunk_pitch"].map(|j| self.column(&format!("tracking_error.{j}")));
        let feet = ["left_foot", "right_foot"]
            .map(|f| ["fx", "fz", "mode"].map(|what| self.column(&format!("contact.{f}.{what}"))));
        let torques = ["left_hip", "left_knee", "right_hip", "right_knee"].map(|j| self.column(&format!("tau.{j}")));
        for (k, t) in time.iter().enumerate().filter(|(_, t)| **t > SETTLED) {
            let (step, touched) = self.phase(*t);
            if touched != both {
                continue;
            }
            for (worst, error) in out.errors.iter_mut().zip(errors) {
                *worst = worst.max(error[k].abs());
            }
            let stands = if both { (step + 1).rem_euclid(2) } else { step.rem_euclid(2) } as usize;
            for (role, foot) in [stands, 1 - stands].into_iter().enumerate() {
                let [fx, fz, mode] = feet[foot].map(|column| column[k]);
                if (role == 0 || both) && mode > 0.0 {
                    out.vertical[role] = out.vertical[role].min(fz);
                    out.friction[role] = out.friction[role].max((fx / fz).abs());
                }
            }
            out.torque = torques.iter().fold(out.torque, |m, tau| m.max(tau[k].abs()));
        }
        out
    }

    /// Mean speed of the centre of mass [m/s].
    pub fn speed(&self) -> f64 {
        let (t, x) = (self.column("time"), self.column("center_of_mass.x"));
        // From middle to middle of steps, so that its swaying does not count.
        let steps = ((t[t.len() - 1] - t[0]) / self.walk.gait.step_time()).floor();
        let end = t.iter().position(|at| *at >= steps * self.walk.gait.step_time() - 1e-9).unwrap_or(t.len() - 1);
        (x[end] - x[0]) / (t[end] - t[0])
    }

    /// Largest distance between the footprints and multiples of the step length [m].
    pub fn foot_placing(&self) -> f64 {
        let time = self.column("time");
        let mut worst = 0.0_f64;
        for (n, landing) in self.landings().enumerate() {
            let foot = ["left", "right"][landing.contact];
            let k = time.iter().position(|t| *t > landing.t + 0.01).unwrap_or(time.len() - 1);
            let [x, _] = self.leg(foot, k)[2];
            worst = worst.max((x - (n + 1) as f64 * self.walk.gait.step_length).abs());
        }
        worst
    }

    /// Hip, knee and foot of a leg at sample `k`, ahead and up [m].
    pub fn leg(&self, side: &str, k: usize) -> [[f64; 2]; 3] {
        let at = |name: &str| self.column(name)[k];
        let (thigh, shank) = (self.walk.gait.leg.thigh, self.walk.gait.leg.shank);
        let hip = [at("q.hip_x"), at("q.hip_z")];
        let turn = at("q.trunk_pitch") + at(&format!("q.{side}_hip"));
        let bent = turn + at(&format!("q.{side}_knee"));
        let knee = [hip[0] - thigh * turn.sin(), hip[1] - thigh * turn.cos()];
        [hip, knee, [knee[0] - shank * bent.sin(), knee[1] - shank * bent.cos()]]
    }
}
