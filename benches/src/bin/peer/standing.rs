//! A robot of the comparison whose feet are held; `peers/stages/feet.py` writes the files.

use crate::robot::Robot;
use gyroflex::dynamics::{
    AbaScratch, Anchor, Constrained, ConstrainedScratch, Constraint, ConstraintScratch, Directions, External, Forward,
    Frame, Hold, PropagatedScratch, Regularisation, State, SupportScratch, constrained_forward_dynamics,
    constraint_matrix_len, constraint_rows, propagated_len,
};
use gyroflex::spatial::{Force, Mat3, Transform, Vec3};
use gyroflex_benches::peers::{Point, Worker, numbers};
use std::cell::RefCell;
use std::hint::black_box;
use std::path::Path;
use std::rc::Rc;

/// Numbers of a foot: its link, its body in the tree, rotation by rows and position.
const FOOT: usize = 14;

pub struct Standing {
    robot: Robot<f64>,
    feet: Vec<Constraint<f64>>,
    want: Vec<Vec<f64>>,
    out: [Vec<f64>; 3],
    bodies: Vec<AbaScratch<f64>>,
    supports: Vec<SupportScratch<f64>>,
    constraints: Vec<ConstraintScratch<f64>>,
    propagated: Vec<PropagatedScratch<f64>>,
    matrix: Vec<f64>,
    multipliers: Vec<f64>,
    wrenches: Vec<Force<f64>>,
}

/// Adds the row, if the robot has feet.
pub fn add(worker: &mut Worker, name: &str, tolerance: f64) {
    if worker.folder.join(format!("{name}.feet")).exists() {
        let standing = Rc::new(RefCell::new(Standing::load(&worker.folder, name)));
        worker.add(format!("{name}/constrained"), tolerance, &standing, Standing::forward, Standing::error);
    }
}

impl Standing {
    fn load(folder: &Path, name: &str) -> Self {
        let mut robot = Robot::<f64>::load(folder, name);
        let feet: Vec<_> = numbers(folder, name, "feet").chunks_exact(FOOT).map(foot).collect();
        let (n, nv) = (robot.model.bodies().len(), robot.tree.nv);
        let mut want = Vec::new();
        // The same states with the feet at rest.
        for (k, row) in numbers(folder, name, "held").chunks_exact(2 * nv).enumerate() {
            let (qd, thetad) = robot.coordinates.velocities(&robot.tree, &row[..nv]);
            (robot.points[k].qd, robot.points[k].thetad) = (qd, thetad);
            want.push(row[nv..].to_vec());
        }
        let rows = constraint_rows(&feet);
        Self {
            out: std::array::from_fn(|_| vec![0.0; robot.model.nv()]),
            bodies: vec![AbaScratch::new(); n],
            supports: vec![SupportScratch::new(); n],
            constraints: vec![ConstraintScratch::new(); feet.len()],
            propagated: vec![PropagatedScratch::new(); propagated_len(&robot.model, &feet)],
            matrix: vec![0.0; constraint_matrix_len(&feet)],
            multipliers: vec![0.0; rows],
            wrenches: vec![Force::zero(); feet.len()],
            robot,
            feet,
            want,
        }
    }

    fn forward(&mut self, k: usize) {
        let Point { q, qd, theta, thetad, tau, .. } = &self.robot.points[k];
        let [qdd, thetadd, tau_j] = &mut self.out;
        let scratch = ConstrainedScratch {
            bodies: &mut self.bodies,
            supports: &mut self.supports,
            constraints: &mut self.constraints,
            propagated: &mut self.propagated,
            matrix: &mut self.matrix,
            joint_space: &mut [],
            joint_matrix: &mut [],
        };
        let done = constrained_forward_dynamics(
            &self.robot.model,
            State { q, qd, theta, thetad },
            tau,
            External::none(),
            &self.feet,
            Regularisation::rank_revealing(1e-9),
            scratch,
            Forward { qdd, thetadd, tau_j },
            Constrained { multipliers: &mut self.multipliers, wrenches: &mut self.wrenches },
        );
        black_box((&self.out, &self.wrenches, done.is_ok()));
    }

    fn error(&mut self, k: usize) -> f64 {
        let [qdd, thetadd, _] = &self.out;
        self.robot.tree.acceleration_error(&self.robot.tree_order(qdd, thetadd, true), &self.want[k])
    }
}

/// A foot that is held to the world, in its axes.
fn foot(x: &[f64]) -> Constraint<f64> {
    let row = |i: usize| Vec3::new(x[i], x[i + 1], x[i + 2]);
    let placement = Transform::from_pose(Mat3 { rows: [row(2), row(5), row(8)] }, row(11));
    let frame = Frame { body: x[0] as usize, placement };
    let anchor = Anchor { body: None, placement: Transform::identity() };
    let hold = Hold::Frame { frame, anchor, directions: Directions::ALL };
    Constraint { hold, stabilisation: 0.0, contact: None }
}
