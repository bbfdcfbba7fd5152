//! Our coordinates of a robot whose rotors are bodies of their own in the tree: motors reflected, twists with the angular part
//! first.

use super::tree::Tree;

/// A state, with motor torques for forward dynamics and accelerations for inverse dynamics.
#[derive(Clone, Debug)]
pub struct Point<T> {
    /// Joint positions.
    pub q: Vec<T>,
    /// Joint velocities.
    pub qd: Vec<T>,
    /// Motor positions.
    pub theta: Vec<T>,
    /// Motor velocities.
    pub thetad: Vec<T>,
    /// Motor torques.
    pub tau: Vec<T>,
    /// Joint accelerations.
    pub qdd: Vec<T>,
    /// Motor accelerations.
    pub thetadd: Vec<T>,
}

/// Indices of our coordinates in the tree's velocities.
#[derive(Clone, Debug)]
pub struct Coordinates {
    links: Vec<usize>,
    /// Of those links that have one.
    rotors: Vec<Option<usize>>,
}

impl Coordinates {
    /// Those of a tree.
    pub fn of(tree: &Tree) -> Self {
        // The tree's twists have the linear part first.
        let mut links: Vec<usize> = if tree.floating() { vec![3, 4, 5, 0, 1, 2] } else { Vec::new() };
        if tree.springs.is_empty() {
            links.extend(links.len()..tree.nv);
        } else {
            links.extend(tree.springs.iter().map(|s| s.link_v));
        }
        let base = links.len() - tree.springs.len();
        let rotors = (0..links.len()).map(|k| Some(tree.springs.get(k.checked_sub(base)?)?.rotor_v)).collect();
        Self { links, rotors }
    }

    /// State `k` of the tree.
    pub fn point(&self, tree: &Tree, k: usize) -> Point<f64> {
        let [q, v, a, u] = tree.state(k);
        let lead = tree.nq - tree.nv;
        let joints = self.links.iter().skip(if lead > 0 { 6 } else { 0 }).map(|&i| q[i + lead]);
        let motors = self.of_links(u).into_iter().zip(&self.rotors);
        Point {
            q: q[..if lead > 0 { 7 } else { 0 }].iter().copied().chain(joints).collect(),
            qd: self.of_links(v),
            theta: self.of_rotors(tree, q, lead),
            thetad: self.of_rotors(tree, v, 0),
            tau: motors.map(|(on_link, r)| r.map_or(on_link, |i| u[i] * tree.gears[i])).collect(),
            qdd: self.of_links(a),
            thetadd: self.of_rotors(tree, a, 0),
        }
    }

    /// Velocities of links and motors, from those of the tree.
    pub fn velocities(&self, tree: &Tree, v: &[f64]) -> (Vec<f64>, Vec<f64>) {
        (self.of_links(v), self.of_rotors(tree, v, 0))
    }

    fn of_links(&self, x: &[f64]) -> Vec<f64> {
        self.links.iter().map(|&i| x[i]).collect()
    }

    /// Motion of the rotors on the link side of their gears.
    fn of_rotors(&self, tree: &Tree, x: &[f64], shift: usize) -> Vec<f64> {
        self.rotors.iter().map(|r| r.map_or(0.0, |i| x[i + shift] / tree.gears[i])).collect()
    }

    /// Back to the tree's coordinates; `motion` of rotors grows through the gear, their torque shrinks.
    pub fn tree_order(&self, tree: &Tree, links: &[f64], rotors: &[f64], motion: bool) -> Vec<f64> {
        let mut all = vec![0.0; tree.nv];
        for (k, (&i, rotor)) in self.links.iter().zip(&self.rotors).enumerate() {
            all[i] = links[k];
            if let Some(r) = *rotor {
                all[r] = if motion { rotors[k] * tree.gears[r] } else { rotors[k] / tree.gears[r] };
            }
        }
        all
    }

    /// How far accelerations are from the expected ones of state `k`.
    pub fn acceleration_error(&self, tree: &Tree, k: usize, qdd: &[f64], thetadd: &[f64]) -> f64 {
        tree.acceleration_error(&self.tree_order(tree, qdd, thetadd, true), tree.expected(k)[0])
    }

    /// How far torques on joints and of motors are from the expected ones of state `k`.
    pub fn torque_error(&self, tree: &Tree, k: usize, tau_j: &[f64], tau: &[f64]) -> f64 {
        let [q, v, ..] = tree.state(k);
        let on_rotors: Vec<f64> = tau.iter().zip(tau_j).map(|(motor, joint)| motor - joint).collect();
        let needed = self.tree_order(tree, tau_j, &on_rotors, false);
        let mut torques = needed.clone();
        tree.add_springs(q, v, &needed, -1.0, &mut torques);
        tree.torque_error(&torques, tree.expected(k)[1])
    }
}
