//! An arm of `N` joints, computed by code that was generated for it.

use crate::peers::{Coordinates, Point, STATES, Tree, Worker};
use std::cell::RefCell;
use std::hint::black_box;
use std::rc::Rc;

/// As gyroflex's own program has it.
const TOLERANCE: f64 = 1e-10;

/// A state in arrays.
pub struct State<const N: usize> {
    pub q: [f64; N],
    pub qd: [f64; N],
    pub theta: [f64; N],
    pub thetad: [f64; N],
    pub tau: [f64; N],
    pub qdd: [f64; N],
    pub thetadd: [f64; N],
}

/// Three vectors of results; what is in them depends on the function.
pub type Results<const N: usize> = [[f64; N]; 3];

/// The generated functions with one signature. They are called by address, like those of the C programs.
pub struct Arm<const N: usize> {
    /// Leaves accelerations of joints and motors, and torques of transmissions.
    pub forward: fn(&State<N>, &mut Results<N>),
    /// Leaves torques on joints and of motors.
    pub inverse: fn(&State<N>, &mut Results<N>),
}

struct Loaded<const N: usize> {
    arm: Arm<N>,
    tree: Tree,
    coordinates: Coordinates,
    states: Vec<State<N>>,
    results: Results<N>,
}

impl<const N: usize> Loaded<N> {
    fn forward(&mut self, k: usize) {
        (self.arm.forward)(&self.states[k], &mut self.results);
        black_box(&self.results);
    }

    fn forward_error(&mut self, k: usize) -> f64 {
        let [qdd, thetadd, _] = &self.results;
        self.coordinates.acceleration_error(&self.tree, k, qdd, thetadd)
    }

    fn inverse(&mut self, k: usize) {
        (self.arm.inverse)(&self.states[k], &mut self.results);
        black_box(&self.results);
    }

    fn inverse_error(&mut self, k: usize) -> f64 {
        let [tau_j, tau, _] = &self.results;
        self.coordinates.torque_error(&self.tree, k, tau_j, tau)
    }
}

/// The rows of one arm.
pub fn add<const N: usize>(worker: &mut Worker, name: &str, arm: Arm<N>) {
    let tree = Tree::read(&worker.folder, name);
    let coordinates = Coordinates::of(&tree);
    let states = (0..STATES).map(|k| state(coordinates.point(&tree, k))).collect();
    let arm = Rc::new(RefCell::new(Loaded { arm, tree, coordinates, states, results: [[0.0; N]; 3] }));
    let row = |algorithm: &str| format!("{name}/{algorithm}:gyroflex-rust");
    worker.add(row("aba"), TOLERANCE, &arm, Loaded::forward, Loaded::forward_error);
    worker.add(row("rnea"), TOLERANCE, &arm, Loaded::inverse, Loaded::inverse_error);
}

fn state<const N: usize>(point: Point<f64>) -> State<N> {
    let array = |x: Vec<f64>| x.try_into().unwrap_or_else(|x: Vec<f64>| panic!("{} numbers for {N} joints", x.len()));
    State {
        q: array(point.q),
        qd: array(point.qd),
        theta: array(point.theta),
        thetad: array(point.thetad),
        tau: array(point.tau),
        qdd: array(point.qdd),
        thetadd: array(point.thetadd),
    }
}
