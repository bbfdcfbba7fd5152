//! A run allocates when it is set up, not while it goes.

use gyroflex_sim::coordinates::Coordinates;
use gyroflex_sim::inverse::MotorOutput;
use gyroflex_sim::load::{Disk, LoadOptions, load};
use gyroflex_sim::record::{Recorder, Sample};
use gyroflex_sim::reference::{References, Trajectory};
use gyroflex_sim::scenario::SineTerm;
use gyroflex_sim::{Error, ScenarioFile, Simulation};
use std::alloc::{GlobalAlloc, Layout, System};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

struct Nowhere;

impl Recorder for Nowhere {
    fn record(&mut self, _: &Sample) -> Result<(), Error> {
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Error> {
        Ok(())
    }
}

#[test]
fn fixed_step_run_allocates_nothing_per_step() {
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    for name in ["puma560/push.yaml", "planar_3r/waypoints.yaml"] {
        let mut file = ScenarioFile::load(&Disk, &robots.join(name)).unwrap();
        let robot = load(&file.robot_path(), &LoadOptions::default()).unwrap();
        let mut allocations = |duration: f64| {
            file.scenario.duration = duration;
            let mut simulation = Simulation::new(&robot, &file).unwrap();
            let before = ALLOCATIONS.load(Ordering::Relaxed);
            simulation.run(&mut Nowhere, &mut |_| ControlFlow::Continue(())).unwrap();
            ALLOCATIONS.load(Ordering::Relaxed) - before
        };
        // Both end while the same wrenches have come and gone, and with the same warnings.
        let (short, long) = (allocations(0.05), allocations(0.4));
        assert!(long <= short, "{name}: {short} allocations in 50 ms, {long} in 400 ms");
    }
}

#[test]
fn inverse_for_the_motors_motion_allocates_nothing_per_call() {
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    let file = ScenarioFile::load(&Disk, &robots.join("lwr/step.yaml")).unwrap();
    let robot = load(&robots.join("lwr/robot.yaml"), &LoadOptions::default()).unwrap();
    let term = SineTerm { amplitude: 0.3, frequency: 0.5, phase: 0.0 };
    let references = References::new((0..7).map(|_| Trajectory::Sines { offset: 0.2, terms: vec![term] }).collect());
    let model = robot.model(robot.fidelity).unwrap();
    let mut along = MotorOutput::new(model, &Coordinates::of(&robot), &references, &file.keys).unwrap();
    let mut allocations = |calls: u32| {
        along.start(&references).unwrap();
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        for i in 0..calls {
            let t = 1e-3 * f64::from(i);
            along.at(&references, t).unwrap();
            along.advance(&references, t, 1e-3).unwrap();
        }
        ALLOCATIONS.load(Ordering::Relaxed) - before
    };
    // Tests beside this one allocate on their own: the least of several runs is this one's.
    let least = (0..10).map(|_| allocations(20)).min();
    assert_eq!(least, Some(0));
}
