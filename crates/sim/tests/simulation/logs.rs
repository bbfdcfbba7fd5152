//! Laws of what is recorded, and when.

use crate::arm::{arm, run, scenario, simulation};
use gyroflex_sim::record::{MemoryRecorder, Recorder, Sample};
use gyroflex_sim::{Error, ErrorKind, Simulation};
use std::ops::ControlFlow;

/// Counts what it is told.
#[derive(Default)]
struct Counter {
    samples: u64,
    finished: u64,
    full_after: Option<u64>,
}

impl Recorder for Counter {
    fn record(&mut self, _: &Sample) -> Result<(), Error> {
        if self.full_after == Some(self.samples) {
            return Err(Error {
                kind: ErrorKind::Io,
                file: "log".into(),
                element: String::new(),
                problem: "the disk is full".into(),
                remedy: String::new(),
            });
        }
        self.samples += 1;
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Error> {
        self.finished += 1;
        Ok(())
    }
}

fn go(_: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

#[test]
fn log_times_are_exact() {
    let ticks = [("333", "1000", "none"), ("1000", "300", "pd"), ("100", "1000", "pd"), ("7", "1000", "pd")];
    for (log, control, kind) in ticks {
        let controller =
            if kind == "pd" { format!("{{type: pd, rate: {control}, kp: 10, kd: 1}}") } else { "{type: none}".into() };
        let yaml = format!(
            "duration: 0.777\ncontroller: {controller}\nlog: {{rate: {log}}}\nintegrator: {{method: rk4, step: 7e-4}}"
        );
        let (summary, samples, simulation) = run(&arm(1), &yaml);
        let rate: f64 = log.parse().unwrap();
        let last = samples.len() - 1;
        for (k, sample) in samples[..last].iter().enumerate() {
            assert_eq!(sample.t, k as f64 / rate, "log {log}, control {control}");
        }
        assert_eq!(samples[last].t, 0.777);
        assert!(samples[last - 1].t < 0.777);
        assert_eq!(summary.samples, samples.len() as u64);
        assert!(simulation.expected_samples().abs_diff(summary.samples) <= 1);
    }
}

#[test]
fn log_rate_does_not_change_the_motion_of_a_tick() {
    let yaml = |log: u32| {
        format!(
            "duration: 0.2\ninitial: {{q: [0.5, 0.1]}}\ncontroller: {{type: pd, kp: 10, kd: 1}}\nlog: {{rate: {log}}}"
        )
    };
    let ends = [1000, 100].map(|log| run(&arm(2), &yaml(log)).2.state().clone());
    assert_eq!(ends[0], ends[1]);
}

#[test]
fn stopped_run_completes_its_log() {
    let mut counter = Counter::default();
    let mut stop = |t: f64| if t >= 0.1 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let summary = simulation(&arm(1), "duration: 5\nlog: {rate: 100}").run(&mut counter, &mut stop).unwrap();
    assert!(summary.interrupted);
    assert_eq!((counter.samples, counter.finished, summary.end_time), (11, 1, 0.1));
}

#[test]
fn run_stops_between_distant_samples() {
    for method in ["{method: rk4, step: 1e-4}", "{method: dopri5}", "{method: kvaerno5, rtol: 1e-5, atol: 1e-7}"] {
        let yaml = format!("duration: 100\nlog: {{rate: 0.01}}\nintegrator: {method}");
        let (mut counter, mut calls) = (Counter::default(), 0);
        let mut stop = |_| {
            calls += 1;
            if calls == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let summary = simulation(&arm(1), &yaml).run(&mut counter, &mut stop).unwrap();
        assert!(summary.interrupted && summary.end_time < 50.0, "{method}: {}", summary.end_time);
        assert_eq!((counter.samples, counter.finished), (1, 1), "{method}");
    }
}

/// A velocity loop at 50 Hz that answers at 2000 1/s overshoots more at each tick.
const RUNAWAY: &str = "duration: 5\ninitial: {qd: {joint2: 0.1}}\nreference: {default: {type: hold, at: 0.0}}
controller: {type: pd, rate: 50, kp: 0, kd: 2000}\nlog: {rate: 100}";

#[test]
fn diverged_run_keeps_its_log() {
    let mut simulation = simulation(&arm(2), RUNAWAY);
    assert!(simulation.warnings().iter().any(|w| w.element.contains("controller.kd")));
    let mut memory = MemoryRecorder::new(simulation.run_info());
    let error = simulation.run(&mut memory, &mut go).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Diverged);
    assert!(error.element.contains("joint"), "{error}");
    assert!(error.problem.contains("t = "), "{error}");
    assert!(memory.samples().len() > 2);
    assert!(memory.samples().iter().all(|s| s.qd.iter().all(|v| v.is_finite())));
}

#[test]
fn log_is_completed_after_any_error() {
    let mut counter = Counter::default();
    simulation(&arm(2), RUNAWAY).run(&mut counter, &mut go).unwrap_err();
    assert_eq!(counter.finished, 1);

    let mut counter = Counter { full_after: Some(3), ..Counter::default() };
    let error = simulation(&arm(1), "duration: 1").run(&mut counter, &mut go).unwrap_err();
    assert_eq!((error.kind, counter.samples, counter.finished), (ErrorKind::Io, 3, 1));
}

#[test]
fn passing_a_limit_is_reported_once() {
    let mut robot = arm(1);
    robot.joints[0].limits = Some([-0.1, 0.1]);
    let (summary, ..) = run(&robot, "duration: 1\nlog: {rate: 100}");
    let told = summary.warnings.iter().filter(|w| w.contains("leaves -0.1 to 0.1")).count();
    assert_eq!(told, 1, "{:?}", summary.warnings);
}

#[test]
fn run_info_names_files_and_parameters() {
    let mut file = scenario("duration: 1\nintegrator: {method: dopri5, rtol: 1e-6}");
    file.source.text = "the text".to_owned();
    let info = Simulation::new(&arm(2), &file).unwrap().run_info();
    assert!(info.attachments.contains(&("test.yaml".to_owned(), "the text".to_owned())));
    let value = |key: &str| info.metadata.iter().find(|(k, _)| k == key).map(|(_, v)| v.as_str());
    assert_eq!(
        (value("integrator"), value("rtol"), value("model")),
        (Some("dopri5"), Some("0.000001"), Some("complete"))
    );
    assert_eq!(info.joints, ["joint1", "joint2"]);
}
