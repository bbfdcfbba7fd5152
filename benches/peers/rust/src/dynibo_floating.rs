//! dynibo, robots on a floating base. It takes the base's motion in world axes, angular part first, with the acceleration of the
//! origin; the states have it in the base's own axes, linear part first, spatial. Converted before anything is timed.

use crate::dynibo_fixed::{TOLERANCE, pose, product};
use crate::peers::{STATES, Spring, Tree, Worker, add_springs, error};
use dynibo::{BaseState, FloatingRobot, Frame, Twist};
use nalgebra::{Quaternion, Translation3, UnitQuaternion, Vector3};
use std::cell::RefCell;
use std::hint::black_box;
use std::rc::Rc;

/// A state as dynibo wants it, and what the base turns back by.
struct Point {
    base: BaseState,
    turn: UnitQuaternion<f64>,
    cross: Vector3<f64>,
    joints: [Vec<f64>; 3],
    torques: Vec<f64>,
}

struct Robot {
    tree: Tree,
    model: FloatingRobot,
    points: Vec<Point>,
    /// Per joint of dynibo, which counts breadth first, its velocity coordinate in the tree.
    order: Vec<usize>,
    /// Per body of the tree its link.
    links: Vec<usize>,
    /// In dynibo's order.
    springs: Vec<Spring>,
    torques: Vec<f64>,
    out: Vec<f64>,
    matrix: Vec<f64>,
    poses: Vec<Frame>,
}

fn vector(x: &[f64]) -> Vector3<f64> {
    Vector3::new(x[0], x[1], x[2])
}

impl Robot {
    fn point(&self, k: usize) -> Point {
        let [q, v, a, u] = self.tree.state(k);
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(q[6], q[3], q[4], q[5]));
        let cross = vector(&v[3..]).cross(&vector(v));
        let frame = Frame::from_parts(Translation3::from(vector(q)), turn);
        let twist = |lin: Vector3<f64>, ang: &[f64]| Twist::new(turn * vector(ang), turn * lin);
        let velocity = twist(vector(v), &v[3..]);
        let acceleration = twist(vector(a) + cross, &a[3..]);
        let pick = |x: &[f64], shift: usize| self.order.iter().map(|&i| x[i + shift]).collect::<Vec<_>>();
        Point {
            base: BaseState::new(frame, velocity, acceleration).unwrap(),
            joints: [pick(q, 1), pick(v, 0), pick(a, 0)],
            torques: self.there(turn, u),
            turn,
            cross,
        }
    }

    /// A vector over the velocity coordinates, and back.
    fn there(&self, turn: UnitQuaternion<f64>, x: &[f64]) -> Vec<f64> {
        let (ang, lin) = (turn * vector(&x[3..]), turn * vector(x));
        ang.iter().chain(lin.iter()).copied().chain(self.order.iter().map(|&i| x[i])).collect()
    }

    fn back(&self, turn: UnitQuaternion<f64>, x: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; x.len()];
        all[..3].copy_from_slice((turn.inverse() * vector(&x[3..])).as_slice());
        all[3..6].copy_from_slice((turn.inverse() * vector(x)).as_slice());
        self.order.iter().zip(&x[6..]).for_each(|(&i, x)| all[i] = *x);
        all
    }

    fn forward(&mut self, k: usize) {
        let Point { base, joints: [q, v, _], torques, .. } = &self.points[k];
        self.torques.copy_from_slice(torques);
        add_springs(&self.springs, q, v, 1.0, &mut self.torques[6..]);
        let done = self.model.forward_dynamics(base, q, v, &self.torques, &[], &mut self.out);
        black_box((&self.out, done.is_ok()));
    }

    fn forward_error(&mut self, k: usize) -> f64 {
        let point = &self.points[k];
        let mut got = self.back(point.turn, &self.out);
        // The acceleration of the origin, to the spatial one.
        got[..3].iter_mut().zip(point.cross.iter()).for_each(|(x, c)| *x -= c);
        self.tree.acceleration_error(&got, self.tree.expected(k)[0])
    }

    fn inverse(&mut self, k: usize) {
        let Point { base, joints: [q, v, a], .. } = &self.points[k];
        let done = self.model.inverse_dynamics(base, q, v, a, &[], &mut self.out);
        add_springs(&self.springs, q, v, -1.0, &mut self.out[6..]);
        black_box((&self.out, done.is_ok()));
    }

    fn inverse_error(&mut self, k: usize) -> f64 {
        self.tree.torque_error(&self.back(self.points[k].turn, &self.out), self.tree.expected(k)[1])
    }

    fn mass_matrix(&mut self, k: usize) {
        let Point { base, joints: [q, ..], .. } = &self.points[k];
        let done = self.model.mass_matrix(base, q, &mut self.matrix);
        black_box((&self.matrix, done.is_ok()));
    }

    fn momentum_error(&mut self, k: usize) -> f64 {
        let (turn, [_, _, a, _]) = (self.points[k].turn, self.tree.state(k));
        let momentum = product(&self.matrix, &self.there(turn, a));
        self.tree.torque_error(&self.back(turn, &momentum), self.tree.expected(k)[2])
    }

    fn kinematics(&mut self, k: usize) {
        let Point { base, joints: [q, ..], .. } = &self.points[k];
        let done = self.model.forward_kinematics_all(base, q, &mut self.poses);
        black_box((&self.poses, done.is_ok()));
    }

    fn pose_error(&mut self, k: usize) -> f64 {
        let got: Vec<f64> = self.links.iter().flat_map(|&i| pose(&self.poses[i])).collect();
        error(got.into_iter(), self.tree.expected(k)[3].iter().copied())
    }
}

/// The rows of one robot.
pub fn add(worker: &mut Worker, tree: Tree) {
    let name = tree.name.clone();
    let model = FloatingRobot::from_urdf(worker.folder.join(format!("{name}.urdf"))).unwrap();
    let (n, count) = (tree.nv, model.link_count());
    assert_eq!(model.generalized_count(), n, "{name}: dynibo's coordinates are not those of the tree");
    let body = |joint: &str| joint[1..].parse::<usize>().unwrap();
    // Joint jK moves body K, which has velocity coordinate K + 5.
    let order: Vec<usize> = (0..n - 6).map(|i| body(model.joint_name(i).unwrap()) + 5).collect();
    let link_name = |i: usize| model.link_name(model.link_id_at(i).unwrap()).unwrap().to_owned();
    let place = |b: usize| (0..count).find(|&i| link_name(i) == format!("b{b}")).unwrap();
    let links = (0..tree.bodies.len()).map(place).collect();
    let spot = |coordinate: usize| order.iter().position(|&o| o == coordinate).unwrap();
    let in_order = |s: &Spring| {
        let (rotor, link) = (spot(s.rotor_v), spot(s.link_v));
        Spring { rotor_q: rotor, rotor_v: rotor, link_q: link, link_v: link, ..*s }
    };
    let springs = tree.springs.iter().map(in_order).collect();
    let (torques, out, matrix) = (vec![0.0; n], vec![0.0; n], vec![0.0; n * n]);
    let poses = vec![Frame::identity(); count];
    let mut robot = Robot { tree, model, points: Vec::new(), order, links, springs, torques, out, matrix, poses };
    robot.points = (0..STATES).map(|k| robot.point(k)).collect();
    let robot = Rc::new(RefCell::new(robot));
    let row = |algorithm: &str| format!("{name}/{algorithm}:dynibo");
    worker.add(row("aba"), TOLERANCE, &robot, Robot::forward, Robot::forward_error);
    worker.add(row("rnea"), TOLERANCE, &robot, Robot::inverse, Robot::inverse_error);
    worker.add(row("crba"), TOLERANCE, &robot, Robot::mass_matrix, Robot::momentum_error);
    worker.add(row("fk"), TOLERANCE, &robot, Robot::kinematics, Robot::pose_error);
}
