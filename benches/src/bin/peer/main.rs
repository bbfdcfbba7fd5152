//! gyroflex's program in the comparison with other libraries; `peers/README.md` says how it is run.

mod derivatives;
mod links;
mod robot;
mod standing;

use gyroflex::Lanes;
use gyroflex_benches::Lane;
use gyroflex_benches::peers::Worker;
use robot::Robot;
use std::cell::RefCell;
use std::rc::Rc;

/// What the light fast rotors of bodies of their own leave of the expected values, in multiples of the largest number.
const TOLERANCE: f64 = 1e-10;
/// Of `f32`: a spring's deflection of a thousandth is the difference of angles of three radians, rounded to 2e-7.
const SINGLE: f64 = 1e-2;

/// Forward and inverse dynamics of one robot, as many states at a time as the number holds.
fn add<T: Lane>(worker: &mut Worker, name: &str, variant: &str, tolerance: f64) -> Rc<RefCell<Robot<T>>> {
    let robot = Rc::new(RefCell::new(Robot::<T>::load(&worker.folder, name)));
    let row = |algorithm: &str| format!("{name}/{algorithm}{variant}");
    worker.add(row("aba"), tolerance, &robot, Robot::forward, Robot::forward_error);
    worker.add(row("rnea"), tolerance, &robot, Robot::inverse, Robot::inverse_error);
    robot
}

fn main() {
    let mut worker = Worker::from_args();
    for name in worker.robots.clone() {
        let robot = add::<f64>(&mut worker, &name, "", TOLERANCE);
        worker.add(format!("{name}/crba"), TOLERANCE, &robot, Robot::matrix, Robot::matrix_error);
        derivatives::add(&mut worker, &name);
        standing::add(&mut worker, &name, TOLERANCE);
        // The pose of a rotor is that of its mount, turned by its angle: nothing to compute.
        if robot.borrow().is_rigid() {
            worker.add(format!("{name}/fk"), TOLERANCE, &robot, Robot::poses, Robot::pose_error);
        }
        add::<Lanes<f64, 8>>(&mut worker, &name, ":8 lanes", TOLERANCE);
        add::<Lanes<f32, 16>>(&mut worker, &name, ":16 lanes of f32", SINGLE);
    }
    links::add(&mut worker);
    worker.serve();
}
