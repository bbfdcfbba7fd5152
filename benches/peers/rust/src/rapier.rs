//! rapier3d. It has no public call for forward dynamics: `step`, one step of its world without colliders, is the least that
//! computes accelerations. The step moves the state itself, so that it goes its own way from state 0, without torques and springs.

use crate::peers::{Body, Tree, Worker};
use rapier3d_f64::prelude::*;
use std::cell::RefCell;
use std::rc::Rc;

const STEP: f64 = 1e-5;
/// A step of that length is only near the acceleration at its start.
const TOLERANCE: f64 = 1e-3;

struct Robot {
    tree: Tree,
    world: PhysicsWorld,
    joint: MultibodyJointHandle,
    before: Vec<f64>,
}

impl Robot {
    fn step(&mut self) {
        self.world.step();
    }

    fn velocity(&mut self) -> Vec<f64> {
        let (multibody, _) = self.world.multibody_joints.get_mut(self.joint).unwrap();
        multibody.generalized_velocity().iter().copied().collect()
    }
}

fn vector(x: &[f64]) -> Vector {
    Vector::new(x[0], x[1], x[2])
}

/// From rows.
fn matrix(m: [f64; 9]) -> Matrix {
    let column = |c: usize| Vector::new(m[c], m[3 + c], m[6 + c]);
    Matrix::from_cols(column(0), column(1), column(2))
}

fn insert(world: &mut PhysicsWorld, parent: RigidBodyHandle, body: &Body) -> (RigidBodyHandle, MultibodyJointHandle) {
    let [xx, xy, yy, xz, yz, zz] = body.inertia;
    let inertia = matrix([xx, xy, xz, xy, yy, yz, xz, yz, zz]);
    let mass = MassProperties::with_inertia_matrix(vector(&body.centre), body.mass, inertia);
    let handle = world.bodies.insert(RigidBodyBuilder::dynamic().additional_mass_properties(mass).can_sleep(false));
    // Its revolute joints turn about x.
    let to_axis = Rotation::from_rotation_arc(Vector::new(1.0, 0.0, 0.0), vector(&body.axis));
    let turn = Rotation::from_mat3(&matrix(body.rotation)) * to_axis;
    let joint = GenericJointBuilder::new(JointAxesMask::LOCKED_REVOLUTE_AXES)
        .local_frame1(Pose::from_parts(vector(&body.position), turn))
        .local_frame2(Pose::from_parts(Vector::new(0.0, 0.0, 0.0), to_axis));
    let joint = world.multibody_joints.insert(parent, handle, joint.build(), true).unwrap();
    (handle, joint)
}

fn build(tree: Tree) -> Robot {
    let mut world = PhysicsWorld { gravity: Vector::new(0.0, 0.0, -tree.gravity), ..PhysicsWorld::default() };
    world.integration_parameters.dt = STEP;
    world.integration_parameters.num_solver_iterations = 1;
    world.integration_parameters.num_internal_stabilization_iterations = 0;
    let root = world.bodies.insert(RigidBodyBuilder::fixed());
    let mut inserted: Vec<(RigidBodyHandle, MultibodyJointHandle)> = Vec::new();
    for body in &tree.bodies {
        let parent = body.parent.map_or(root, |p| inserted[p].0);
        inserted.push(insert(&mut world, parent, body));
    }
    let joint = inserted[0].1;
    let (multibody, _) = world.multibody_joints.get_mut(joint).unwrap();
    multibody.forward_kinematics(&world.bodies, true);
    assert_eq!(multibody.ndofs(), tree.nv, "{}: rapier's coordinates are not those of the tree", tree.name);
    let [q, v, ..] = tree.state(0);
    multibody.apply_displacements(q);
    multibody.generalized_velocity_mut().iter_mut().zip(v).for_each(|(x, v)| *x = *v);
    multibody.damping_mut().fill(0.0);
    multibody.forward_kinematics(&world.bodies, false);
    multibody.update_rigid_bodies(&mut world.bodies, true);
    Robot { before: v.to_vec(), tree, world, joint }
}

/// The row of one robot.
pub fn add(worker: &mut Worker, tree: Tree) {
    let row = format!("{}/aba:rapier-step", tree.name);
    let robot = Rc::new(RefCell::new(build(tree)));
    worker.add(
        row,
        TOLERANCE,
        &robot,
        |r, _| r.step(),
        |r, k| {
            if k > 0 {
                return 0.0;
            }
            let after = r.velocity();
            let rates: Vec<f64> = after.iter().zip(&r.before).map(|(after, before)| (after - before) / STEP).collect();
            r.tree.acceleration_error(&rates, &r.tree.still)
        },
    );
}
