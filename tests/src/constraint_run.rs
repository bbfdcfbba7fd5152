//! Constrained dynamics on owned vectors.

use crate::Core;
use crate::core_run::{cast, double, nan};
use gyroflex::control::{ComputedTorque, HeldScratch, Joints};
use gyroflex::dynamics::{
    AbaScratch, Acceleration, Anchor, Constrained, ConstrainedScratch, Constraint, ConstraintMotion, ConstraintScratch,
    Contact, Forward, Frame, Hold, Impact, Inverse, JointSpaceScratch, PropagatedScratch, Regularisation, RneaScratch,
    Solved, SupportScratch, TorqueDistribution, constrained_forward_dynamics, constrained_inverse_dynamics,
    constrained_inverse_len, constrained_joint_matrix_len, constraint_matrix_len, constraint_motion, constraint_rows,
    impact, joint_space_len, propagated_len,
};
use gyroflex::model::Model;
use gyroflex::spatial::Force;
use gyroflex_testkit::State as Point;
use gyroflex_testkit::tolerance::Real;

/// Constraints of a robot, and how dependent ones are treated.
#[derive(Clone, Debug)]
pub struct Held {
    /// The constraints.
    pub constraints: Vec<Constraint<f64>>,
    /// Part of a direction's own entry below which it counts as dependent.
    pub threshold: f64,
    /// Damping, relative.
    pub damping: f64,
    /// Whether impacts release contacts that pull.
    pub release: bool,
}

/// What constrained dynamics writes: accelerations, or velocities after an impact and impulses.
#[derive(Clone, Debug)]
pub struct HeldMotion {
    /// Of the links.
    pub links: Vec<f64>,
    /// Of the motors.
    pub motors: Vec<f64>,
    /// Torques of transmissions, or impulses of rigid gears.
    pub tau_j: Vec<f64>,
    /// Multipliers.
    pub multipliers: Vec<f64>,
    /// Wrenches in the world about the frames' origins.
    pub wrenches: Vec<[f64; 6]>,
    /// How it went.
    pub solved: Solved<f64>,
}

impl Held {
    /// Constraints treated as independent unless they are next to not.
    pub fn new(constraints: Vec<Constraint<f64>>) -> Self {
        Self { constraints, threshold: 1e-11, damping: 0.0, release: false }
    }

    /// Number of multipliers.
    pub fn rows(&self) -> usize {
        constraint_rows(&self.constraints)
    }

    fn regularisation<T: Real>(&self) -> Regularisation<T> {
        Regularisation { threshold: T::from_f64(self.threshold), damping: T::from_f64(self.damping) }
    }

    fn cast<T: Real>(&self) -> Vec<Constraint<T>> {
        self.constraints.iter().map(cast_constraint).collect()
    }
}

fn cast_constraint<T: Real>(c: &Constraint<f64>) -> Constraint<T> {
    let to = T::from_f64;
    let hold = match c.hold {
        Hold::Frame { frame, anchor, directions } => Hold::Frame {
            frame: Frame { body: frame.body, placement: frame.placement.map(to) },
            anchor: Anchor { body: anchor.body, placement: anchor.placement.map(to) },
            directions,
        },
        Hold::Joints { joint, follows, ratio, offset } => {
            Hold::Joints { joint, follows, ratio: to(ratio), offset: to(offset) }
        }
    };
    let contact = |c: Contact<f64>| Contact {
        normal: c.normal,
        restitution: to(c.restitution),
        slip: c.slip.map(|slip| slip.map(to)),
    };
    Constraint { hold, stabilisation: to(c.stabilisation), contact: c.contact.map(contact) }
}

struct Storage<T> {
    bodies: Vec<AbaScratch<T>>,
    supports: Vec<SupportScratch<T>>,
    constraints: Vec<ConstraintScratch<T>>,
    propagated: Vec<PropagatedScratch<T>>,
    matrix: Vec<T>,
    joint_space: Vec<JointSpaceScratch<T>>,
    joint_matrix: Vec<T>,
    multipliers: Vec<T>,
    wrenches: Vec<Force<T>>,
}

impl<T: Real> Storage<T> {
    fn new(model: &Model<'_, T::Param>, held: &[Constraint<T>]) -> Self {
        let bodies = model.bodies().len();
        Self {
            bodies: vec![AbaScratch::new(); bodies],
            supports: vec![SupportScratch::new(); bodies],
            constraints: vec![ConstraintScratch::new(); held.len()],
            propagated: vec![PropagatedScratch::new(); propagated_len(model, held)],
            matrix: vec![nan(); constraint_matrix_len(held)],
            joint_space: vec![JointSpaceScratch::new(); joint_space_len(model)],
            joint_matrix: vec![nan(); constrained_joint_matrix_len(model, held)],
            multipliers: vec![nan(); constraint_rows(held)],
            wrenches: vec![Force::from([nan(); 6]); held.len()],
        }
    }

    fn parts(&mut self) -> (ConstrainedScratch<'_, T>, Constrained<'_, T>) {
        let scratch = ConstrainedScratch {
            bodies: &mut self.bodies,
            supports: &mut self.supports,
            constraints: &mut self.constraints,
            propagated: &mut self.propagated,
            matrix: &mut self.matrix,
            joint_space: &mut self.joint_space,
            joint_matrix: &mut self.joint_matrix,
        };
        (scratch, Constrained { multipliers: &mut self.multipliers, wrenches: &mut self.wrenches })
    }

    fn motion(&self, links: &[T], motors: &[T], tau_j: &[T], solved: Solved<T>) -> HeldMotion {
        let wrench = |w: &Force<T>| w.to_array().map(Real::to_f64);
        HeldMotion {
            links: double(links),
            motors: double(motors),
            tau_j: double(tau_j),
            multipliers: double(&self.multipliers),
            wrenches: self.wrenches.iter().map(wrench).collect(),
            solved: Solved {
                dependent: solved.dependent.to_f64(),
                contradiction: solved.contradiction.to_f64(),
                independence: solved.independence.to_f64(),
                released: solved.released.to_f64(),
            },
        }
    }
}

impl<T: Real> Core<T> {
    /// `constrained_forward_dynamics`.
    pub fn constrained(&self, s: &Point, held: &Held) -> HeldMotion {
        let (model, nv, constraints) = (self.model(), self.model().nv(), held.cast::<T>());
        let mut storage = Storage::new(&model, &constraints);
        let (mut qdd, mut thetadd, mut tau_j) = (vec![nan(); nv], vec![nan(); nv], vec![nan(); nv]);
        let solved = self.call_any(s, |x| {
            let (scratch, forces) = storage.parts();
            let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
            constrained_forward_dynamics(
                &model,
                x.state(),
                &x.tau,
                x.external(),
                &constraints,
                held.regularisation(),
                scratch,
                out,
                forces,
            )
            .expect("the constraints fit the robot")
        });
        storage.motion(&qdd, &thetadd, &tau_j, solved)
    }

    /// `impact`.
    pub fn impact(&self, s: &Point, held: &Held) -> HeldMotion {
        let (model, nv, constraints) = (self.model(), self.model().nv(), held.cast::<T>());
        let mut storage = Storage::new(&model, &constraints);
        let (mut qd, mut thetad, mut gears) = (vec![nan(); nv], vec![nan(); nv], vec![nan(); nv]);
        let solved = self.call_any(s, |x| {
            let (scratch, forces) = storage.parts();
            let out = Impact { qd: &mut qd, thetad: &mut thetad, gears: &mut gears };
            impact(&model, x.state(), &constraints, held.release, held.regularisation(), scratch, out, forces)
                .expect("the constraints fit the robot")
        });
        storage.motion(&qd, &thetad, &gears, solved)
    }

    /// `constrained_inverse_dynamics`: torques of transmissions, of motors, and multipliers. Velocities in `passive` are driven by nothing,
    /// all others cost `torques`; a multiplier costs `cost` beside.
    pub fn constrained_inverse(
        &self,
        s: &Point,
        held: &Held,
        torques: &[f64],
        passive: &[usize],
        cost: f64,
    ) -> [Vec<f64>; 3] {
        let (model, nv, constraints) = (self.model(), self.model().nv(), held.cast::<T>());
        let mut scratch = vec![RneaScratch::new(); model.bodies().len()];
        let mut supports = vec![SupportScratch::new(); model.bodies().len()];
        let mut matrix = vec![nan(); constrained_inverse_len(&model, &constraints, passive.len())];
        let (mut tau_j, mut tau, mut multipliers) = (vec![nan(); nv], vec![nan(); nv], vec![nan(); held.rows()]);
        let (torques, costs) = (cast::<T>(torques), vec![T::from_f64(cost); held.rows()]);
        let distribution = TorqueDistribution { torques: &torques, passive, multipliers: &costs, wanted: &[] };
        self.call_any(s, |x| {
            let accel = Acceleration { qdd: &x.qdd, thetadd: &x.thetadd };
            let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
            constrained_inverse_dynamics(
                &model,
                x.state(),
                accel,
                x.external(),
                &constraints,
                distribution,
                held.regularisation(),
                &mut scratch,
                &mut supports,
                &mut matrix,
                out,
                &mut multipliers,
            )
            .expect("the constraints fit the robot")
        });
        [double(&tau_j), double(&tau), double(&multipliers)]
    }

    /// `ComputedTorque::torque_while_held` with the same gains `kp`, `kd` at all joints, towards positions and velocities `desired` with the
    /// accelerations `qdd`: motor torques.
    pub fn computed_torque_while_held(
        &self,
        s: &Point,
        held: &Held,
        [kp, kd]: [f64; 2],
        desired: [&[f64]; 2],
        qdd: &[f64],
    ) -> Vec<f64> {
        let (model, nv, constraints) = (self.model(), self.model().nv(), held.cast::<T>());
        let mut bodies = vec![RneaScratch::new(); model.bodies().len()];
        let mut supports = vec![SupportScratch::new(); model.bodies().len()];
        let mut matrix = vec![nan(); constrained_inverse_len(&model, &constraints, 0)];
        let (mut tau_j, mut tau, mut multipliers) = (vec![nan(); nv], vec![nan(); nv], vec![nan(); held.rows()]);
        let (kp, kd, ones) = (vec![T::from_f64(kp); nv], vec![T::from_f64(kd); nv], vec![T::from_f64(1.0); nv]);
        let costs = vec![T::from_f64(1e-6); held.rows()];
        let [q, qd, aims, rates] = [&s.q, &s.qd, desired[0], desired[1]].map(cast::<T>);
        let mut qdd = cast::<T>(qdd);
        let law = ComputedTorque { kp: &kp, kd: &kd };
        law.torque_while_held(
            &model,
            Joints { q: &aims, qd: &rates },
            Joints { q: &q, qd: &qd },
            &mut qdd,
            &constraints,
            TorqueDistribution { torques: &ones, passive: &[], multipliers: &costs, wanted: &[] },
            held.regularisation(),
            HeldScratch { bodies: &mut bodies, supports: &mut supports, matrix: &mut matrix },
            Inverse { tau_j: &mut tau_j, tau: &mut tau },
            &mut multipliers,
        )
        .expect("the constraints fit the robot");
        double(&tau)
    }

    /// `constraint_motion`: errors, velocities, and the Jacobian by rows.
    pub fn constraint_motion(&self, q: &[f64], qd: &[f64], held: &Held) -> [Vec<f64>; 3] {
        let (model, constraints) = (self.model(), held.cast::<T>());
        let rows = held.rows();
        let mut scratch = vec![SupportScratch::new(); model.bodies().len()];
        let (mut error, mut velocity, mut jacobian) =
            (vec![nan(); rows], vec![nan(); rows], vec![nan(); rows * model.nv()]);
        let out = ConstraintMotion { error: &mut error, velocity: &mut velocity, jacobian: &mut jacobian };
        constraint_motion(&model, &cast::<T>(q), &cast::<T>(qd), &constraints, &mut scratch, out)
            .expect("the constraints fit the robot");
        [double(&error), double(&velocity), double(&jacobian)]
    }
}
