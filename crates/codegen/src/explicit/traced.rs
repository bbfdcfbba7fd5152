//! The core's algorithms on symbols, as far as explicit equations need them.

use crate::graph::{Graph, Id};
use crate::quantity::Storage;
use crate::robot::{Parameter, Records, Robot};
use crate::sym::{Sym, trace};
use gyroflex::Scalar;
use gyroflex::dynamics::{
    Acceleration, External, FlexibleMatrices, Inverse, RneaScratch, State, energy, flexible_energy,
    flexible_mass_matrix, rnea,
};
use gyroflex::model::{Body, Drive, Elastic, Friction, JointKind, Model};
use gyroflex::spatial::{Motion, Transform};

/// Inertia, potential energy and the laws of the joints as expressions of positions and kept parameters.
pub(super) struct Traced {
    pub(super) graph: Graph,
    /// `M_l`, by rows.
    pub(super) mass: Vec<Id>,
    /// `S`, by rows.
    pub(super) coupling: Vec<Id>,
    /// Of gravity.
    pub(super) potential: Id,
    /// One a body.
    pub(super) laws: Vec<Law<Id>>,
}

/// The numbers of one joint.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Law<T> {
    pub(super) friction: Friction<T>,
    pub(super) motor: Option<MotorLaw<T>>,
}

/// The numbers of its drive.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MotorLaw<T> {
    pub(super) gear_ratio: T,
    pub(super) reflected_inertia: T,
    pub(super) friction: Friction<T>,
    /// `K`, `K₃`, `D`.
    pub(super) elastic: Option<[T; 3]>,
}

pub(super) fn traced(robot: &Robot, kept: &[Parameter]) -> Traced {
    let nv = robot.nv();
    let (parts, graph) = trace(|| {
        let q: Vec<Sym> = (0..nv).map(Sym::input).collect();
        let symbols = (nv..nv + kept.len()).map(Sym::input);
        let kept: Vec<(Parameter, Sym)> = kept.iter().cloned().zip(symbols).collect();
        let records = Records::keeping(robot, &kept);
        let laws: Vec<Law<Id>> = records.view().bodies().iter().map(law).collect();
        let rest = vec![Sym::zero(); nv];
        let state = State { q: &q, qd: &rest, theta: &rest, thetad: &rest };
        let records = records.frictionless();
        let potential = match records.flexible() {
            Some(model) => flexible_energy(&model, state, Storage::of(&model).lend()),
            None => {
                let model = records.view();
                energy(&model, state, &mut vec![(Transform::identity(), Motion::zero()); model.bodies().len()])
            }
        };
        let potential = potential.expect("lengths are the model's").gravity;
        let (mut mass, mut coupling) = (vec![Sym::zero(); nv * nv], vec![Sym::zero(); nv * nv]);
        match records.flexible() {
            Some(model) => {
                let out = FlexibleMatrices { mass: &mut mass, coupling: &mut coupling };
                flexible_mass_matrix(&model, &q, Storage::of(&model).lend(), out).expect("lengths are the model's");
            }
            None => columns(records.regrouped().view(), &state, &mut mass, &mut coupling),
        }
        let ids = |all: Vec<Sym>| all.into_iter().map(Sym::id).collect::<Vec<Id>>();
        (ids(mass), ids(coupling), potential.id(), laws)
    });
    let (mass, coupling, potential, laws) = parts;
    Traced { graph, mass, coupling, potential, laws }
}

/// `M_l` and `S` from inverse dynamics, a column for every unit of acceleration: in the axes of the links their terms are fewer on the
/// way than at the base.
fn columns(model: Model<Sym>, at: &State<Sym>, mass: &mut [Sym], coupling: &mut [Sym]) {
    let nv = model.nv();
    let model = model.with_gravity(gyroflex::spatial::Vec3::zero());
    let mut scratch = vec![RneaScratch::new(); model.bodies().len()];
    let (rest, mut any) = (vec![Sym::zero(); nv], vec![Sym::zero(); nv]);
    let mut column = |qdd: &[Sym], thetadd: &[Sym]| {
        let mut tau_j = vec![Sym::zero(); nv];
        let out = Inverse { tau_j: &mut tau_j, tau: &mut any };
        let accel = Acceleration { qdd, thetadd };
        rnea(&model, *at, accel, External::none(), &mut scratch, out).expect("lengths are the model's");
        // What a rigid gear asks of its motor is inertia of its joint.
        for body in model.bodies().iter().filter(|body| !Body::is_elastic(body)) {
            tau_j[body.v_index()] = any[body.v_index()];
        }
        tau_j
    };
    for body in model.bodies() {
        let j = body.v_index();
        let mut unit = rest.clone();
        unit[j] = Sym::one();
        for (i, entry) in column(&unit, &rest).into_iter().enumerate() {
            mass[i * nv + j] = entry;
        }
        if Body::is_elastic(body) {
            for (i, entry) in column(&rest, &unit).into_iter().enumerate() {
                coupling[i * nv + j] = entry;
            }
        }
    }
}

fn law(body: &Body<Sym>) -> Law<Id> {
    let motor = body.drive.as_ref().map(|Drive { rotor, elastic }| MotorLaw {
        gear_ratio: rotor.gear_ratio.id(),
        reflected_inertia: rotor.reflected_inertia.id(),
        friction: rotor.friction.map(Sym::id),
        elastic: elastic
            .as_ref()
            .map(|Elastic { spring, damping, .. }| [spring.stiffness, spring.cubic, *damping].map(Sym::id)),
    });
    debug_assert_ne!(body.joint, JointKind::Floating);
    Law { friction: body.friction.map(Sym::id), motor }
}

impl<T> Law<T> {
    /// The same in other numbers.
    pub(super) fn map<U>(&self, mut f: impl FnMut(&T) -> U) -> Law<U> {
        Law {
            friction: friction_of(&self.friction, &mut f),
            motor: self.motor.as_ref().map(|motor| MotorLaw {
                gear_ratio: f(&motor.gear_ratio),
                reflected_inertia: f(&motor.reflected_inertia),
                friction: friction_of(&motor.friction, &mut f),
                elastic: motor.elastic.as_ref().map(|elastic| elastic.each_ref().map(&mut f)),
            }),
        }
    }
}

/// The same friction in other numbers, of which neither need be a scalar.
pub(super) fn friction_of<T, U>(friction: &Friction<T>, mut f: impl FnMut(&T) -> U) -> Friction<U> {
    Friction {
        viscous: f(&friction.viscous),
        coulomb: f(&friction.coulomb),
        smoothing_velocity: f(&friction.smoothing_velocity),
        stribeck: f(&friction.stribeck),
        stribeck_velocity: f(&friction.stribeck_velocity),
        dry: friction.dry,
    }
}
