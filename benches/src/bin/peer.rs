//! gyroflex's program in the comparison with other libraries; `peers/README.md` says how it is run.

use gyroflex::dynamics::{
    AbaScratch, Acceleration, CrbaScratch, External, Forward, Inverse, RneaScratch, State, aba, coupling, crba,
    placements, reflected_inertia, rnea,
};
use gyroflex::model::{Fidelity, Model};
use gyroflex::spatial::Transform;
use gyroflex_benches::peers::{Tree, Worker, error};
use gyroflex_benches::{STATES, load};
use std::cell::RefCell;
use std::hint::black_box;
use std::path::Path;
use std::rc::Rc;

/// The largest error the other libraries' light fast rotors leave room to see, in multiples of the largest number.
const TOLERANCE: f64 = 1e-10;

/// A state in our coordinates: motors reflected, twists with the angular part first.
struct Point {
    q: Vec<f64>,
    qd: Vec<f64>,
    theta: Vec<f64>,
    thetad: Vec<f64>,
    tau: Vec<f64>,
    qdd: Vec<f64>,
    thetadd: Vec<f64>,
}

struct Robot {
    tree: Tree,
    model: Model<'static, f64>,
    aba: Vec<AbaScratch<f64>>,
    rnea: Vec<RneaScratch<f64>>,
    crba: Vec<CrbaScratch<f64>>,
    points: Vec<Point>,
    out: [Vec<f64>; 3],
    matrices: [Vec<f64>; 3],
    poses: Vec<Transform<f64>>,
    /// Indices of our coordinates in the tree's velocities: of the links, and of their rotors where they have one.
    links: Vec<usize>,
    rotors: Vec<Option<usize>>,
}

impl Robot {
    fn load(folder: &Path, name: &str) -> Self {
        let tree = Tree::read(folder, name);
        let model: Model<f64> = load(&folder.join(format!("{name}.yaml"))).lower(Fidelity::Complete);
        let (n, nv) = (model.bodies().len(), model.nv());
        // The tree's twists have the linear part first.
        let mut links: Vec<usize> = if tree.floating() { vec![3, 4, 5, 0, 1, 2] } else { Vec::new() };
        if tree.springs.is_empty() {
            links.extend(links.len()..nv);
        } else {
            links.extend(tree.springs.iter().map(|s| s.link_v));
        }
        let base = nv - tree.springs.len();
        let rotors = (0..nv).map(|k| Some(tree.springs.get(k.checked_sub(base)?)?.rotor_v)).collect();
        let mut robot = Self {
            out: std::array::from_fn(|_| vec![0.0; nv]),
            matrices: [vec![0.0; nv * nv], vec![0.0; nv * nv], vec![0.0; nv]],
            poses: vec![Transform::identity(); n],
            aba: vec![AbaScratch::new(); n],
            rnea: vec![RneaScratch::new(); n],
            crba: vec![CrbaScratch::new(); n],
            points: Vec::new(),
            tree,
            model,
            links,
            rotors,
        };
        robot.points = (0..STATES).map(|k| robot.point(k)).collect();
        robot
    }

    fn point(&self, k: usize) -> Point {
        let [q, v, a, u] = self.tree.state(k);
        let lead = self.tree.nq - self.tree.nv;
        let of_links = |x: &[f64]| self.links.iter().map(|&i| x[i]).collect::<Vec<_>>();
        // Motion of the rotors on the link side of their gears.
        let of_rotors = |x: &[f64], shift: usize| {
            self.rotors.iter().map(|r| r.map_or(0.0, |i| x[i + shift] / self.tree.gears[i])).collect()
        };
        let joints = self.links.iter().skip(if lead > 0 { 6 } else { 0 }).map(|&i| q[i + lead]);
        let motors = of_links(u).into_iter().zip(&self.rotors);
        Point {
            q: q[..if lead > 0 { 7 } else { 0 }].iter().copied().chain(joints).collect(),
            qd: of_links(v),
            theta: of_rotors(q, lead),
            thetad: of_rotors(v, 0),
            tau: motors.map(|(on_link, r)| r.map_or(on_link, |i| u[i] * self.tree.gears[i])).collect(),
            qdd: of_links(a),
            thetadd: of_rotors(a, 0),
        }
    }

    /// Back to the tree's coordinates; `motion` of rotors grows through the gear, their torque shrinks.
    fn tree_order(&self, links: &[f64], rotors: &[f64], motion: bool) -> Vec<f64> {
        let mut all = vec![0.0; self.tree.nv];
        for (k, (&i, rotor)) in self.links.iter().zip(&self.rotors).enumerate() {
            all[i] = links[k];
            if let Some(r) = *rotor {
                all[r] = if motion { rotors[k] * self.tree.gears[r] } else { rotors[k] / self.tree.gears[r] };
            }
        }
        all
    }

    fn forward(&mut self, k: usize) {
        let Point { q, qd, theta, thetad, tau, .. } = &self.points[k];
        let [qdd, thetadd, tau_j] = &mut self.out;
        let state = State { q, qd, theta, thetad };
        let out = Forward { qdd, thetadd, tau_j };
        let done = aba(&self.model, state, tau, External::none(), &mut self.aba, out);
        black_box((&self.out, done.is_ok()));
    }

    fn forward_error(&mut self, k: usize) -> f64 {
        self.tree.acceleration_error(&self.tree_order(&self.out[0], &self.out[1], true), self.tree.expected(k)[0])
    }

    fn inverse(&mut self, k: usize) {
        let Point { q, qd, theta, thetad, qdd, thetadd, .. } = &self.points[k];
        let [tau_j, tau, _] = &mut self.out;
        let (state, accel) = (State { q, qd, theta, thetad }, Acceleration { qdd, thetadd });
        let done = rnea(&self.model, state, accel, External::none(), &mut self.rnea, Inverse { tau_j, tau });
        black_box((&self.out, done.is_ok()));
    }

    fn inverse_error(&mut self, k: usize) -> f64 {
        let [q, v, ..] = self.tree.state(k);
        let [tau_j, tau, _] = &self.out;
        let on_rotors: Vec<f64> = tau.iter().zip(tau_j).map(|(motor, joint)| motor - joint).collect();
        let needed = self.tree_order(tau_j, &on_rotors, false);
        let mut torques = needed.clone();
        self.tree.add_springs(q, v, &needed, -1.0, &mut torques);
        self.tree.torque_error(&torques, self.tree.expected(k)[1])
    }

    fn matrix(&mut self, k: usize) {
        let (q, [m, s, b]) = (&self.points[k].q, &mut self.matrices);
        let mut done = crba(&self.model, q, &mut self.crba, m).is_ok();
        if !self.tree.springs.is_empty() {
            done &= coupling(&self.model, q, &mut self.crba, s).is_ok() && reflected_inertia(&self.model, b).is_ok();
        }
        black_box((&self.matrices, done));
    }

    fn matrix_error(&mut self, k: usize) -> f64 {
        let ([m, s, b], Point { qdd, thetadd, .. }) = (&self.matrices, &self.points[k]);
        let nv = qdd.len();
        let sum = |f: &dyn Fn(usize) -> f64| (0..nv).map(f).sum::<f64>();
        let links: Vec<f64> = (0..nv).map(|i| sum(&|j| m[i * nv + j] * qdd[j] + s[i * nv + j] * thetadd[j])).collect();
        let rotors: Vec<f64> = (0..nv).map(|i| b[i] * thetadd[i] + sum(&|j| s[j * nv + i] * qdd[j])).collect();
        self.tree.torque_error(&self.tree_order(&links, &rotors, false), self.tree.expected(k)[2])
    }

    fn poses(&mut self, k: usize) {
        let done = placements(&self.model, &self.points[k].q, &mut self.poses);
        black_box((&self.poses, done.is_ok()));
    }

    fn pose_error(&mut self, k: usize) -> f64 {
        let numbers = |x: &Transform<f64>| {
            let (r, p) = (x.rotation(), x.pos);
            let row = |i: usize| r.rows[i].to_array();
            [row(0), row(1), row(2), p.to_array()].concat()
        };
        let got: Vec<f64> = self.poses.iter().flat_map(numbers).collect();
        error(got.into_iter(), self.tree.expected(k)[3].iter().copied())
    }
}

fn main() {
    let mut worker = Worker::from_args();
    for name in worker.robots.clone() {
        let robot = Rc::new(RefCell::new(Robot::load(&worker.folder, &name)));
        worker.add(format!("{name}/aba"), TOLERANCE, &robot, Robot::forward, Robot::forward_error);
        worker.add(format!("{name}/rnea"), TOLERANCE, &robot, Robot::inverse, Robot::inverse_error);
        worker.add(format!("{name}/crba"), TOLERANCE, &robot, Robot::matrix, Robot::matrix_error);
        // The pose of a rotor is that of its mount, turned by its angle: nothing to compute.
        if robot.borrow().tree.springs.is_empty() {
            worker.add(format!("{name}/fk"), TOLERANCE, &robot, Robot::poses, Robot::pose_error);
        }
    }
    worker.serve();
}
