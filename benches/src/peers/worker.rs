//! The program's side of the conversation with `run`: it says which rows it has and how far they are from the expected
//! values, then times one short batch for every row it is asked for.

use super::tree::STATES;
use std::cell::RefCell;
use std::io::BufRead;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::{Duration, Instant};

const BATCH: Duration = Duration::from_millis(3);

/// Makes a number of calls, each at the next state.
type Calls = Box<dyn FnMut(usize)>;

/// The rows of one program.
pub struct Worker {
    /// Where the robots are.
    pub folder: PathBuf,
    /// Names of the robots asked for.
    pub robots: Vec<String>,
    rows: Vec<(String, Calls)>,
    counted: Option<(String, usize)>,
}

impl Worker {
    /// Reads the arguments: `FOLDER ROBOT… [--count ROW CALLS]`.
    pub fn from_args() -> Self {
        let mut args = std::env::args().skip(1);
        let folder = args.next().unwrap_or_else(|| panic!("usage: FOLDER ROBOT… [--count ROW CALLS]")).into();
        let mut robots: Vec<String> = args.collect();
        let counted = robots.iter().position(|a| a == "--count").map(|at| {
            let tail = robots.split_off(at);
            let calls = tail.get(2).and_then(|n| n.parse().ok());
            (tail[1].clone(), calls.unwrap_or_else(|| panic!("--count needs a row and a number of calls")))
        });
        Self { folder, robots, rows: Vec::new(), counted }
    }

    /// Adds a row: `call` is timed at state `k`, `error` compares what the call has left in `robot` with what is expected.
    pub fn add<R: 'static>(
        &mut self,
        row: String,
        tolerance: f64,
        robot: &Rc<RefCell<R>>,
        call: impl Fn(&mut R, usize) + 'static,
        error: impl Fn(&mut R, usize) -> f64,
    ) {
        // A tool that counts instructions wants the calls and nothing else.
        if self.counted.is_none() {
            let robot = &mut *robot.borrow_mut();
            let worst = (0..STATES).fold(0.0_f64, |worst, k| {
                call(robot, k);
                worst.max(error(robot, k))
            });
            assert!(worst <= tolerance, "{row} is {worst:e} off the expected values");
            println!("row {row} {worst:e}");
        }
        let robot = Rc::clone(robot);
        let calls = move |n: usize| {
            let robot = &mut *robot.borrow_mut();
            for k in 0..n {
                call(robot, k % STATES);
            }
        };
        self.rows.push((row, Box::new(calls)));
    }

    /// Answers until nobody asks.
    pub fn serve(mut self) {
        if let Some((row, calls)) = &self.counted {
            self.rows.iter_mut().filter(|(name, _)| name == row).for_each(|(_, run)| run(*calls));
            return;
        }
        println!("ready");
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            for (_, run) in self.rows.iter_mut().filter(|(name, _)| *name == line) {
                let (fastest, middle) = batch(run);
                println!("{fastest} {middle}");
            }
        }
    }
}

/// One pass over the states to warm up, then passes for three milliseconds: the fastest and the middle one, in ns per call.
fn batch(run: &mut dyn FnMut(usize)) -> (f64, f64) {
    run(STATES);
    let mut ns = Vec::new();
    let start = Instant::now();
    while ns.len() < 3 || start.elapsed() < BATCH {
        let before = Instant::now();
        run(STATES);
        ns.push(before.elapsed().as_nanos() as f64 / STATES as f64);
    }
    ns.sort_by(f64::total_cmp);
    (ns[0], ns[ns.len() / 2])
}
