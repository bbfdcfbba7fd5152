//! A walk whose contacts are what the controller's phases say.

use gyroflex::dynamics::*;
use gyroflex::spatial::{Force, Transform, Vec3};
use gyroflex_sim::gait::{Phase, PlanarGait, Side};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::walk::{Command, WalkSettings, Walker};
use gyroflex_sim::{Dynamics, Error, Robot};
use std::path::Path;

pub struct Walk {
    pub robot: Robot,
    pub dynamics: Dynamics,
    pub walker: Walker,
    pub t: f64,
    pub x: [Vec<f64>; 4],
    period: f64,
    parts: usize,
    held: [Option<[f64; 2]>; 2],
}

#[derive(Debug, Default)]
pub struct Step {
    pub touch_down: f64,
    pub impulses: Vec<f64>,
    pub errors: [[f64; 3]; 2],
    pub least_vertical: [f64; 3],
    pub friction: [f64; 3],
    pub torques: f64,
}

const FOOT: Vec3<f64> = Vec3::new(0.0, 0.0, -0.332);

fn shank(side: usize) -> usize {
    [4, 6][side]
}

impl Walk {
    pub fn new(path: &Path, gait: PlanarGait, settings: WalkSettings, rate: f64, parts: usize) -> Self {
        let robot = load(path, &LoadOptions::default()).expect("the robot loads");
        let mut walker = Walker::new(&robot, [FOOT; 2], gait, settings).expect("it is a biped");
        let t = 0.5 * gait.parameters().single_support();
        walker.start(t);
        let joints = gait.joints(&gait.at(t)).expect("within reach");
        let dynamics = Dynamics::new(robot.model(robot.fidelity).expect("physical"));
        let q: Vec<f64> = joints.iter().map(|p| p.q).collect();
        let qd: Vec<f64> = joints.iter().map(|p| p.qd).collect();
        let mut theta = q.clone();
        // Motors where their springs bear the weight would be better; they settle.
        let thetad = qd.clone();
        theta.copy_from_slice(&q);
        Self {
            robot,
            dynamics,
            walker,
            t,
            x: [q, qd, theta, thetad],
            period: 1.0 / rate,
            parts,
            held: [Some([0.0, 0.0]), None],
        }
    }

    fn constraints(&self) -> Vec<Constraint<f64>> {
        let mut out = Vec::new();
        for side in 0..2 {
            let Some([x, z]) = self.held[side] else { continue };
            let frame = Frame { body: shank(side), placement: Transform { pos: FOOT, ..Transform::identity() } };
            let anchor =
                Anchor { body: None, placement: Transform { pos: Vec3::new(x, 0.0, z), ..Transform::identity() } };
            let hold = Hold::Frame { frame, anchor, directions: Directions::PLANAR_POINT };
            out.push(Constraint {
                hold,
                stabilisation: 100.0,
                contact: Some(Contact { normal: 5, restitution: 0.0, slip: None }),
            });
        }
        out
    }

    fn rates(&self, x: &[Vec<f64>; 4], command: &Command) -> ([Vec<f64>; 4], Vec<f64>) {
        let model = self.dynamics.model();
        let constraints = self.constraints();
        let (n, nv) = (model.bodies().len(), model.nv());
        let mut poses = vec![Transform::identity(); n];
        self.dynamics.placements(&x[0], &mut poses).unwrap();
        let mut wrenches = vec![Force::zero(); n];
        wrenches[command.body] = Force::couple(poses[command.body].rot * Vec3::new(0.0, command.ankle, 0.0));
        let (mut qdd, mut thetadd, mut tau_j) = (vec![0.0; nv], vec![0.0; nv], vec![0.0; nv]);
        let mut multipliers = vec![0.0; constraint_rows(&constraints)];
        let mut forces = vec![Force::zero(); constraints.len()];
        let scratch = ConstrainedScratch {
            bodies: &mut vec![AbaScratch::new(); n],
            supports: &mut vec![SupportScratch::new(); n],
            constraints: &mut vec![ConstraintScratch::new(); constraints.len()],
            propagated: &mut vec![PropagatedScratch::new(); propagated_len(&model, &constraints)],
            matrix: &mut vec![0.0; constraint_matrix_len(&constraints)],
            joint_space: &mut [],
            joint_matrix: &mut [],
        };
        constrained_forward_dynamics(
            &model,
            State { q: &x[0], qd: &x[1], theta: &x[2], thetad: &x[3] },
            &command.tau,
            External { tau: &[], wrenches: &wrenches },
            &constraints,
            Regularisation::rank_revealing(1e-9),
            scratch,
            Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j },
            Constrained { multipliers: &mut multipliers, wrenches: &mut forces },
        )
        .unwrap();
        ([x[1].clone(), qdd, x[3].clone(), thetadd], multipliers)
    }

    fn rk4(&self, h: f64, command: &Command) -> [Vec<f64>; 4] {
        let plus = |x: &[Vec<f64>; 4], k: &[Vec<f64>; 4], h: f64| -> [Vec<f64>; 4] {
            core::array::from_fn(|i| x[i].iter().zip(&k[i]).map(|(x, k)| x + h * k).collect())
        };
        let k1 = self.rates(&self.x, command).0;
        let k2 = self.rates(&plus(&self.x, &k1, h / 2.0), command).0;
        let k3 = self.rates(&plus(&self.x, &k2, h / 2.0), command).0;
        let k4 = self.rates(&plus(&self.x, &k3, h), command).0;
        let mut x = self.x.clone();
        for (k, w) in [(&k1, 1.0), (&k2, 2.0), (&k3, 2.0), (&k4, 1.0)] {
            x = plus(&x, k, w * h / 6.0);
        }
        x
    }

    fn foot(&self, side: usize, x: &[Vec<f64>; 4]) -> [f64; 2] {
        let mut poses = vec![Transform::identity(); 7];
        self.dynamics.placements(&x[0], &mut poses).unwrap();
        let p = poses[shank(side)].point(FOOT);
        [p.x, p.z]
    }

    /// One step of the gait.
    pub fn step(&mut self) -> Result<Step, Error> {
        let mut done = Step { least_vertical: [f64::INFINITY; 3], ..Step::default() };
        let (step, _) = self.walker.phase();
        while self.walker.phase().0 == step {
            let command = self.walker.tick(self.t, &self.x[0], &self.x[1], self.period)?;
            let phase = usize::from(self.walker.phase().1 == Phase::Double);
            for k in 0..3 {
                done.errors[phase][k] = done.errors[phase][k].max(self.walker.errors()[k].abs());
            }
            let (_, forces) = self.rates(&self.x, &command);
            let mut which: Vec<usize> = (0..2).filter(|s| self.held[*s].is_some()).collect();
            let front = usize::from(self.walker.support() == Side::Right);
            for (i, s) in which.drain(..).enumerate() {
                let k = if phase == 0 {
                    0
                } else if s == front {
                    1
                } else {
                    2
                };
                let (fx, fz) = (forces[2 * i], forces[2 * i + 1]);
                done.least_vertical[k] = done.least_vertical[k].min(fz);
                done.friction[k] = done.friction[k].max((fx / fz).abs());
            }
            done.torques = command.tau.iter().fold(done.torques, |m, t| m.max(t.abs())).max(command.ankle.abs());
            let h = self.period / self.parts as f64;
            for _ in 0..self.parts {
                let next = self.rk4(h, &command);
                let swing = 1 - front;
                let begun = step as f64 * 0.7;
                if phase == 0 && self.t - begun > 0.3 && self.foot(swing, &next)[1] <= 0.0 {
                    // Regula falsi would do; bisection is enough here.
                    let (mut lo, mut hi) = (0.0, h);
                    for _ in 0..40 {
                        let mid = 0.5 * (lo + hi);
                        if self.foot(swing, &self.rk4(mid, &command))[1] > 0.0 { lo = mid } else { hi = mid }
                    }
                    self.x = self.rk4(hi, &command);
                    self.t += hi;
                    done.touch_down = self.t - begun;
                    let [x, z] = self.foot(swing, &self.x);
                    self.held[swing] = Some([x, z]);
                    done.impulses = self.blow();
                    self.walker.touched_down(if swing == 0 { Side::Left } else { Side::Right }, self.t);
                    break;
                }
                self.x = next;
                self.t += h;
            }
            if let Some(side) = self.walker.go_on(self.t) {
                self.held[usize::from(side == Side::Right)] = None;
            }
            assert!(self.x[0][2].abs() < 1.0, "fell at {}", self.t);
        }
        Ok(done)
    }

    fn blow(&mut self) -> Vec<f64> {
        let model = self.dynamics.model();
        let constraints = self.constraints();
        let (n, nv) = (model.bodies().len(), model.nv());
        let (mut qd, mut thetad, mut gears) = (vec![0.0; nv], vec![0.0; nv], vec![0.0; nv]);
        let mut multipliers = vec![0.0; constraint_rows(&constraints)];
        let mut forces = vec![Force::zero(); constraints.len()];
        let scratch = ConstrainedScratch {
            bodies: &mut vec![AbaScratch::new(); n],
            supports: &mut vec![SupportScratch::new(); n],
            constraints: &mut vec![ConstraintScratch::new(); constraints.len()],
            propagated: &mut vec![PropagatedScratch::new(); propagated_len(&model, &constraints)],
            matrix: &mut vec![0.0; constraint_matrix_len(&constraints)],
            joint_space: &mut [],
            joint_matrix: &mut [],
        };
        impact(
            &model,
            State { q: &self.x[0], qd: &self.x[1], theta: &self.x[2], thetad: &self.x[3] },
            &constraints,
            false,
            Regularisation::rank_revealing(1e-9),
            scratch,
            Impact { qd: &mut qd, thetad: &mut thetad, gears: &mut gears },
            Constrained { multipliers: &mut multipliers, wrenches: &mut forces },
        )
        .unwrap();
        (self.x[1], self.x[3]) = (qd, thetad);
        multipliers
    }
}
