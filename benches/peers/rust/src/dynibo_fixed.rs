//! dynibo, robots on a fixed base.

use crate::peers::{Tree, Worker, error};
use dynibo::Frame;
use std::cell::RefCell;
use std::hint::black_box;
use std::rc::Rc;

/// dynibo has no FMA and turns joints by quaternions.
pub const TOLERANCE: f64 = 1e-10;

struct Robot {
    tree: Tree,
    model: dynibo::Robot,
    torques: Vec<f64>,
    out: Vec<f64>,
    matrix: Vec<f64>,
    poses: Vec<Frame>,
}

impl Robot {
    fn forward(&mut self, k: usize) {
        let [q, v, _, u] = self.tree.state(k);
        self.tree.add_springs(q, v, u, 1.0, &mut self.torques);
        let done = self.model.forward_dynamics(q, v, &self.torques, &[], &mut self.out);
        black_box((&self.out, done.is_ok()));
    }

    fn inverse(&mut self, k: usize) {
        let [q, v, a, _] = self.tree.state(k);
        let done = self.model.inverse_dynamics(q, v, a, &[], &mut self.torques);
        self.tree.add_springs(q, v, &self.torques, -1.0, &mut self.out);
        black_box((&self.out, done.is_ok()));
    }

    fn mass_matrix(&mut self, k: usize) {
        let done = self.model.mass_matrix(self.tree.state(k)[0], &mut self.matrix);
        black_box((&self.matrix, done.is_ok()));
    }

    fn kinematics(&mut self, k: usize) {
        let done = self.model.forward_kinematics_all(self.tree.state(k)[0], &mut self.poses);
        black_box((&self.poses, done.is_ok()));
    }

    fn momentum_error(&mut self, k: usize) -> f64 {
        let [_, _, a, _] = self.tree.state(k);
        self.tree.torque_error(&product(&self.matrix, a), self.tree.expected(k)[2])
    }

    fn pose_error(&mut self, k: usize) -> f64 {
        // The root link leads.
        let got: Vec<f64> = self.poses[1..].iter().flat_map(pose).collect();
        error(got.into_iter(), self.tree.expected(k)[3].iter().copied())
    }
}

/// A square matrix times a vector.
pub fn product(matrix: &[f64], x: &[f64]) -> Vec<f64> {
    matrix.chunks_exact(x.len()).map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum()).collect()
}

/// Rotation by rows, then the origin.
pub fn pose(frame: &Frame) -> Vec<f64> {
    let rotation = frame.rotation.to_rotation_matrix().into_inner().transpose();
    rotation.iter().chain(frame.translation.vector.iter()).copied().collect()
}

/// The rows of one robot.
pub fn add(worker: &mut Worker, tree: Tree) {
    let name = tree.name.clone();
    let model = dynibo::Robot::from_urdf(worker.folder.join(format!("{name}.urdf"))).unwrap();
    let n = tree.nv;
    let in_order = (0..n).all(|i| model.joint_name(i).is_ok_and(|joint| *joint == *format!("j{i}")));
    assert!(in_order && model.joint_count() == n, "{name}: dynibo's joints are not those of the tree");
    let poses = vec![Frame::identity(); model.link_count()];
    let robot = Robot { torques: vec![0.0; n], out: vec![0.0; n], matrix: vec![0.0; n * n], tree, model, poses };
    let robot = Rc::new(RefCell::new(robot));
    let row = |algorithm: &str| format!("{name}/{algorithm}:dynibo");
    worker.add(row("aba"), TOLERANCE, &robot, Robot::forward, |r, k| {
        r.tree.acceleration_error(&r.out, r.tree.expected(k)[0])
    });
    worker
        .add(row("rnea"), TOLERANCE, &robot, Robot::inverse, |r, k| r.tree.torque_error(&r.out, r.tree.expected(k)[1]));
    worker.add(row("crba"), TOLERANCE, &robot, Robot::mass_matrix, Robot::momentum_error);
    worker.add(row("fk"), TOLERANCE, &robot, Robot::kinematics, Robot::pose_error);
}
