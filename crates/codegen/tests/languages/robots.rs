//! Random robots, and what the library computes for them.

use gyroflex::dynamics::*;
use gyroflex::model::{Fidelity, RobotSpec};
use gyroflex_codegen::robot::Robot;
use gyroflex_testkit::flexible::LoweredFlexible;
use gyroflex_testkit::random::{RandomFlexible, RandomRobot};
use gyroflex_testkit::{Lowered, State as Point};

/// A random robot in one of its models.
pub struct Subject {
    random: RandomRobot,
    fidelity: Fidelity,
    rigid: Lowered<f64>,
    pub bending: Option<LoweredFlexible<f64>>,
    names: Vec<String>,
}

impl Subject {
    pub fn of(random: RandomRobot, fidelity: Fidelity) -> Self {
        let rigid = Lowered::new(&random.spec(), fidelity).expect("a random robot is valid");
        let names = (0..random.bodies.len()).map(|i| format!("body{i}")).collect();
        Self { random, fidelity, rigid, bending: None, names }
    }

    pub fn bending(random: &RandomFlexible, fidelity: Fidelity) -> Self {
        let bending = random.lower(fidelity).expect("a random robot is valid");
        Self { bending: Some(bending), ..Self::of(random.robot.clone(), fidelity) }
    }

    pub fn about(&self) -> String {
        let bends = if self.bending.is_some() { ", links bend" } else { "" };
        format!("seed {}, {} bodies, {}{bends}", self.random.seed, self.names.len(), self.fidelity.name())
    }

    pub fn robot(&self) -> Robot<'_> {
        let RobotSpec { bodies, spring_tables, gravity } = self.random.spec();
        Robot {
            name: "random",
            joints: &self.names,
            links: &self.names,
            spec: RobotSpec { bodies, spring_tables, gravity },
            fidelity: self.fidelity,
            model: self.rigid.view(),
            flexible: self.bending.as_ref().map(LoweredFlexible::view),
            payload: None,
        }
    }

    fn at<'a>(&self, s: &'a Point) -> State<'a, f64> {
        State { q: &s.q, qd: &s.qd, theta: &s.theta, thetad: &s.thetad }
    }

    /// `qdd`, `thetadd`, `tau_j`.
    pub fn forward(&self, s: &Point) -> [Vec<f64>; 3] {
        let model = self.rigid.view();
        let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; model.nv()]);
        let scratch = ForwardScratch {
            bodies: &mut vec![AbaScratch::new(); self.names.len()],
            joint_space: &mut vec![JointSpaceScratch::new(); joint_space_len(&model)],
            matrix: &mut vec![0.0; matrix_len(&model)],
        };
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        forward_dynamics(&model, self.at(s), &s.tau, External::none(), scratch, out).expect("it fits");
        [qdd, thetadd, tau_j]
    }

    /// `tau_j`, `tau`.
    pub fn inverse(&self, s: &Point) -> [Vec<f64>; 2] {
        let model = self.rigid.view();
        let [mut tau_j, mut tau] = [(); 2].map(|()| vec![0.0; model.nv()]);
        let mut scratch = vec![RneaScratch::new(); self.names.len()];
        let accel = Acceleration { qdd: &s.qdd, thetadd: &s.thetadd };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
        rnea(&model, self.at(s), accel, External::none(), &mut scratch, out).expect("it fits");
        [tau_j, tau]
    }

    /// `m`, by rows.
    pub fn mass_matrix(&self, s: &Point) -> Vec<f64> {
        let model = self.rigid.view();
        let mut m = vec![0.0; model.nv() * model.nv()];
        crba(&model, &s.q, &mut vec![CrbaScratch::new(); self.names.len()], &mut m).expect("it fits");
        m
    }
}
