//! A robot of the comparison, computed by gyroflex: one state at a time, or several side by side.

use gyroflex::dynamics::{
    AbaScratch, Acceleration, CrbaScratch, External, Forward, Inverse, RneaScratch, State, aba, coupling, crba,
    placements, reflected_inertia, rnea,
};
use gyroflex::model::{Fidelity, Model};
use gyroflex::spatial::Transform;
use gyroflex_benches::peers::{Coordinates, Point, Tree, error};
use gyroflex_benches::{Lane, STATES, load};
use std::hint::black_box;
use std::path::Path;

pub struct Robot<T: Lane> {
    pub tree: Tree,
    pub model: Model<'static, T::Param>,
    aba: Vec<AbaScratch<T>>,
    rnea: Vec<RneaScratch<T>>,
    crba: Vec<CrbaScratch<T>>,
    /// As many states each as a number holds.
    pub points: Vec<Point<T>>,
    out: [Vec<T>; 3],
    matrices: [Vec<T>; 3],
    poses: Vec<Transform<T>>,
    pub coordinates: Coordinates,
}

impl<T: Lane> Robot<T> {
    pub fn load(folder: &Path, name: &str) -> Self {
        let tree = Tree::read(folder, name);
        let model: Model<T::Param> = load(&folder.join(format!("{name}.yaml"))).lower(Fidelity::Complete);
        let (n, nv) = (model.bodies().len(), model.nv());
        let mut robot = Self {
            out: std::array::from_fn(|_| vec![T::zero(); nv]),
            matrices: [vec![T::zero(); nv * nv], vec![T::zero(); nv * nv], vec![T::zero(); nv]],
            poses: vec![Transform::identity(); n],
            aba: vec![AbaScratch::new(); n],
            rnea: vec![RneaScratch::new(); n],
            crba: vec![CrbaScratch::new(); n],
            points: Vec::new(),
            coordinates: Coordinates::of(&tree),
            tree,
            model,
        };
        robot.points = (0..STATES / T::WIDTH).map(|k| robot.points_from(k * T::WIDTH)).collect();
        robot
    }

    /// Whether its joints have no drives.
    pub fn is_rigid(&self) -> bool {
        self.tree.springs.is_empty()
    }

    /// The states from `first` on, side by side.
    fn points_from(&self, first: usize) -> Point<T> {
        let points: Vec<Point<f64>> =
            (first..first + T::WIDTH).map(|k| self.coordinates.point(&self.tree, k)).collect();
        let gather = |part: fn(&Point<f64>) -> &Vec<f64>| {
            (0..part(&points[0]).len()).map(|i| T::gather(|lane| part(&points[lane])[i])).collect()
        };
        Point {
            q: gather(|p| &p.q),
            qd: gather(|p| &p.qd),
            theta: gather(|p| &p.theta),
            thetad: gather(|p| &p.thetad),
            tau: gather(|p| &p.tau),
            qdd: gather(|p| &p.qdd),
            thetadd: gather(|p| &p.thetadd),
        }
    }

    /// Back to the tree's coordinates.
    pub fn tree_order(&self, links: &[f64], rotors: &[f64], motion: bool) -> Vec<f64> {
        self.coordinates.tree_order(&self.tree, links, rotors, motion)
    }

    /// Numbers of state `k` among those computed last.
    fn of_state(&self, k: usize, numbers: &[T]) -> Vec<f64> {
        numbers.iter().map(|x| x.lane(k % T::WIDTH)).collect()
    }

    /// At state `k` with its neighbours; nothing to do at those.
    pub fn forward(&mut self, k: usize) {
        if !k.is_multiple_of(T::WIDTH) {
            return;
        }
        let Point { q, qd, theta, thetad, tau, .. } = &self.points[k / T::WIDTH];
        let [qdd, thetadd, tau_j] = &mut self.out;
        let state = State { q, qd, theta, thetad };
        let out = Forward { qdd, thetadd, tau_j };
        let done = aba(&self.model, state, tau, External::none(), &mut self.aba, out);
        black_box((&self.out, done.is_ok()));
    }

    pub fn forward_error(&mut self, k: usize) -> f64 {
        let [qdd, thetadd, _] = self.out.each_ref().map(|x| self.of_state(k, x));
        self.coordinates.acceleration_error(&self.tree, k, &qdd, &thetadd)
    }

    /// Like [`Robot::forward`].
    pub fn inverse(&mut self, k: usize) {
        if !k.is_multiple_of(T::WIDTH) {
            return;
        }
        let Point { q, qd, theta, thetad, qdd, thetadd, .. } = &self.points[k / T::WIDTH];
        let [tau_j, tau, _] = &mut self.out;
        let (state, accel) = (State { q, qd, theta, thetad }, Acceleration { qdd, thetadd });
        let done = rnea(&self.model, state, accel, External::none(), &mut self.rnea, Inverse { tau_j, tau });
        black_box((&self.out, done.is_ok()));
    }

    pub fn inverse_error(&mut self, k: usize) -> f64 {
        let [tau_j, tau, _] = self.out.each_ref().map(|x| self.of_state(k, x));
        self.coordinates.torque_error(&self.tree, k, &tau_j, &tau)
    }
}

impl Robot<f64> {
    pub fn matrix(&mut self, k: usize) {
        let (q, [m, s, b]) = (&self.points[k].q, &mut self.matrices);
        let mut done = crba(&self.model, q, &mut self.crba, m).is_ok();
        if !self.tree.springs.is_empty() {
            done &= coupling(&self.model, q, &mut self.crba, s).is_ok() && reflected_inertia(&self.model, b).is_ok();
        }
        black_box((&self.matrices, done));
    }

    pub fn matrix_error(&mut self, k: usize) -> f64 {
        let ([m, s, b], Point { qdd, thetadd, .. }) = (&self.matrices, &self.points[k]);
        let nv = qdd.len();
        let sum = |f: &dyn Fn(usize) -> f64| (0..nv).map(f).sum::<f64>();
        let links: Vec<f64> = (0..nv).map(|i| sum(&|j| m[i * nv + j] * qdd[j] + s[i * nv + j] * thetadd[j])).collect();
        let rotors: Vec<f64> = (0..nv).map(|i| b[i] * thetadd[i] + sum(&|j| s[j * nv + i] * qdd[j])).collect();
        self.tree.torque_error(&self.tree_order(&links, &rotors, false), self.tree.expected(k)[2])
    }

    pub fn poses(&mut self, k: usize) {
        let done = placements(&self.model, &self.points[k].q, &mut self.poses);
        black_box((&self.poses, done.is_ok()));
    }

    pub fn pose_error(&mut self, k: usize) -> f64 {
        let numbers = |x: &Transform<f64>| {
            let (r, p) = (x.rotation(), x.pos);
            let row = |i: usize| r.rows[i].to_array();
            [row(0), row(1), row(2), p.to_array()].concat()
        };
        let got: Vec<f64> = self.poses.iter().flat_map(numbers).collect();
        error(got.into_iter(), self.tree.expected(k)[3].iter().copied())
    }
}
