//! The instants a run must hit exactly: ticks of controller and log, edges of wrenches, the end.

/// Ticks `k / rate`, computed afresh from `k` so that nothing drifts.
#[derive(Clone, Copy, Debug)]
struct Ticks {
    rate: f64,
    next: u64,
}

impl Ticks {
    fn time(self) -> f64 {
        self.next as f64 / self.rate
    }
}

/// What happens at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Instant {
    /// When [s].
    pub(super) t: f64,
    /// Whether the controller ticks.
    pub(super) control: bool,
    /// Whether a sample is due.
    pub(super) log: bool,
    /// Whether the run ends here.
    pub(super) end: bool,
}

/// All instants of a run in order.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    control: Option<Ticks>,
    log: Ticks,
    /// Remaining edges of wrenches, the next one last.
    edges: Vec<f64>,
    duration: f64,
    over: bool,
}

/// Instants closer than this are one [s]: rounding of `k / rate` for rates that are no multiples of each other.
const TOGETHER: f64 = 1e-12;

impl Clock {
    pub(super) fn new(control: Option<f64>, log: f64, edges: impl Iterator<Item = f64>, duration: f64) -> Self {
        let mut edges: Vec<f64> = edges.filter(|t| *t > 0.0 && *t < duration).collect();
        edges.sort_by(|a, b| b.total_cmp(a));
        let ticks = |rate| Ticks { rate, next: 0 };
        Self { control: control.map(ticks), log: ticks(log), edges, duration, over: false }
    }

    /// Number of samples of the whole run, the last instant included.
    pub(super) fn samples(&self) -> u64 {
        (self.duration * self.log.rate * (1.0 + TOGETHER)) as u64 + 1
    }
}

impl Iterator for Clock {
    type Item = Instant;

    /// The next instant; the first is time 0. The last is the end of the run, where a sample is always due.
    fn next(&mut self) -> Option<Instant> {
        if self.over {
            return None;
        }
        let log = self.log.time();
        let control = self.control.map_or(f64::INFINITY, Ticks::time);
        let edge = self.edges.last().copied().unwrap_or(f64::INFINITY);
        let mut t = log.min(control).min(edge).min(self.duration);
        let within = TOGETHER * t.max(1.0);
        let end = self.duration - t <= within;
        if end {
            t = self.duration;
        }
        // A tick of the log gives the instant its time.
        if (log - t).abs() <= within && !end {
            t = log;
        }
        let due = |tick: f64| tick - t <= within;
        let instant = Instant { t, control: due(control), log: due(log) || end, end };
        if due(log) {
            self.log.next += 1;
        }
        if let Some(ticks) = self.control.as_mut().filter(|_| instant.control) {
            ticks.next += 1;
        }
        while self.edges.last().is_some_and(|e| due(*e)) {
            self.edges.pop();
        }
        self.over = end;
        Some(instant)
    }
}
