//! Dynamics as the frame at the end of a robot feels them: the operational-space model (Khatib 1987, eq. 26 to 32; Siciliano et al.,
//! *Robotics*, §7.8), for redundant arms too.
//!
//! ```text
//! Λ ẍ + μ + p = J̄ᵀ u,    Λ = (J M⁻¹ Jᵀ)⁻¹,   J̄ = M⁻¹ Jᵀ Λ,   μ = J̄ᵀ (C q̇) − Λ J̇ q̇,   p = J̄ᵀ g
//! ```
//!
//! In rigid models `u = τ`. Of an elastic robot `M` is the inertia of the links with the rotors free to follow (PHYSICS §3), and
//! `u = τ_J − S B⁻¹ (τ − τ_J)`: the transmissions' torques, and the couples of the rotors on their carriers.
//!
//! `J M⁻¹ Jᵀ` is never inverted: with `M = Lᵀ D L` it is `W Wᵀ` for `W = J L⁻¹ D^-½`, and the singular values of `W` say in which
//! directions the frame can move.

use super::at_base::{DerivativeScratch, carrier, hand_on, load_carrier, outward, spin, unit};
use super::branches::{factorise, half_solve, solve};
use super::euler::{Angles, Rotation};
use super::kinematics::Frame;
use super::pairs::{for_each_carrying, for_each_inertia};
use super::singular::{Rows, SingularValues, orthogonalise};
use super::tree::RootMotion;
use super::{State, check_scratch, check_state};
use crate::Scalar;
use crate::model::{JointKind, Model, SizeError};
use crate::spatial::{Mat3, Motion, Vec3};

/// What a frame is to do.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a, T> {
    /// The frame.
    pub frame: Frame<T>,
    /// Which of its six velocities count, of 0 to 5: three of rotation, then along x, y, z of the world.
    pub directions: &'a [usize],
    /// What the velocities of rotation are: [`Rotation::Geometric`] has the frame's angular velocity about x, y, z of the world, the
    /// others the rates of three angles, for which `J` is the analytical Jacobian.
    pub rotation: Rotation,
    /// A direction in which unit forces accelerate the frame less than this part of the most they do counts as one in which it cannot
    /// move; `Λ` is zero there.
    pub threshold: T,
}

/// What [`operational_space`] writes, for `m` directions and `nv` velocities; matrices by rows.
#[derive(Debug)]
pub struct OperationalSpace<'a, T> {
    /// `J`, `m × nv`.
    pub jacobian: &'a mut [T],
    /// `J̇ q̇`, `m` entries.
    pub bias_acceleration: &'a mut [T],
    /// `Λ`, `m × m`.
    pub inertia: &'a mut [T],
    /// `J̄`, the dynamically consistent inverse, `nv × m`: of all `q̇` that give the frame a velocity, that of least kinetic energy.
    pub inverse: &'a mut [T],
    /// `μ`, `m` entries.
    pub velocity_force: &'a mut [T],
    /// `p`, `m` entries.
    pub gravity_force: &'a mut [T],
}

/// Entries of the matrix that [`operational_space`] works in.
pub fn operational_len<P: Scalar>(model: &Model<P>, directions: usize) -> usize {
    (model.nv + 2 + directions) * model.nv
}

/// The operational-space model of a frame. `theta` of the state is not read. `scratch` has one record per body, `matrix`
/// [`operational_len`] entries.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model, the frame's body is not one of its bodies or a direction is not below 6; nothing is
/// written then.
///
/// # Example
///
/// What the tip of a flexible link, half a metre from its joint, weighs for a hand that pushes it up or down.
///
/// ```
/// use gyroflex::dynamics::{DerivativeScratch, Frame, OperationalSpace, Rotation, State, Task, operational_len, operational_space};
/// # use gyroflex::model::*;
/// # use gyroflex::spatial::{SpatialInertia, SymMat3, Transform, Vec3};
/// # let axis = Vec3::new(0.0, 1.0, 0.0);
/// # let mount = MountSpec { body: None, placement: Transform::identity(), axis };
/// # let link = BodySpec {
/// #     parent: None,
/// #     joint: JointKind::Revolute,
/// #     axis,
/// #     placement: Transform::identity(),
/// #     inertia: SpatialInertia::from_com(2.0, Vec3::new(0.25, 0.0, 0.0), SymMat3::diagonal(1e-3, 0.04, 0.04)),
/// #     friction: Friction::none(),
/// #     drive: Some(DriveSpec {
/// #         rotor: RotorSpec { inertia: 2e-5, body: None, mount },
/// #         gear_ratio: 100.0,
/// #         transmission: TransmissionSpec::Elastic {
/// #             spring: SpringSpec::Polynomial { stiffness: 4000.0, cubic: 0.0 },
/// #             damping: 5.0,
/// #             error: TransmissionError::none(),
/// #         },
/// #         friction: Friction::none(),
/// #     }),
/// # };
/// # let robot = RobotSpec { bodies: &[link], spring_tables: &[], gravity: Vec3::new(0.0, 0.0, -9.81) };
/// let mut bodies = [Body::empty(); 1];
/// let model = robot.lower(Fidelity::Complete, &mut bodies, &mut [])?;
///
/// let frame = Frame { body: 0, placement: Transform::from_pose(gyroflex::spatial::Mat3::identity(), Vec3::new(0.5, 0.0, 0.0)) };
/// let upwards = [5];
/// let task = Task { frame, directions: &upwards, rotation: Rotation::Geometric, threshold: 1e-6 };
/// let mut matrix = vec![0.0; operational_len(&model, upwards.len())];
/// let (mut jacobian, mut bias, mut inertia, mut inverse, mut mu, mut p) = ([0.0_f64], [0.0], [0.0], [0.0], [0.0], [0.0]);
/// operational_space(
///     &model,
///     State { q: &[0.0], qd: &[0.0], theta: &[0.0], thetad: &[0.0] },
///     task,
///     &mut [DerivativeScratch::new()],
///     &mut matrix,
///     OperationalSpace {
///         jacobian: &mut jacobian,
///         bias_acceleration: &mut bias,
///         inertia: &mut inertia,
///         inverse: &mut inverse,
///         velocity_force: &mut mu,
///         gravity_force: &mut p,
///     },
/// )?;
/// assert!((inertia[0] - (0.04 + 2.0 * 0.25 * 0.25) / (0.5 * 0.5)).abs() < 1e-12);
/// assert!((p[0] - 2.0 * 9.81 * 0.25 / 0.5).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn operational_space<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    task: Task<T>,
    scratch: &mut [DerivativeScratch<T>],
    matrix: &mut [T],
    out: OperationalSpace<T>,
) -> Result<SingularValues<T>, SizeError> {
    let (nv, rows) = (model.nv, task.directions.len());
    check_state(model, &state)?;
    check_scratch(model, scratch)?;
    SizeError::check("matrix", matrix.len(), operational_len(model, rows))?;
    SizeError::check("jacobian", out.jacobian.len(), rows * nv)?;
    SizeError::check("bias_acceleration", out.bias_acceleration.len(), rows)?;
    SizeError::check("inertia", out.inertia.len(), rows * rows)?;
    SizeError::check("inverse", out.inverse.len(), rows * nv)?;
    SizeError::check("velocity_force", out.velocity_force.len(), rows)?;
    SizeError::check("gravity_force", out.gravity_force.len(), rows)?;
    if task.frame.body >= model.bodies.len() {
        return Err(SizeError { argument: "frame.body", expected: model.bodies.len(), given: task.frame.body });
    }
    if let Some(given) = task.directions.iter().copied().find(|d| *d >= 6) {
        return Err(SizeError { argument: "direction", expected: 6, given });
    }
    let (m, rest) = matrix.split_at_mut(nv * nv);
    let (velocity, rest) = rest.split_at_mut(nv);
    let (gravity, w) = rest.split_at_mut(nv);

    joint_space(model, &state, scratch, m, velocity, gravity)?;
    let representation = of_frame(model, &state, task, scratch, out.jacobian, out.bias_acceleration);

    // Singular values of J, and of W = J L⁻¹ D^-½, whose rows come out orthogonal: U W
    w.copy_from_slice(out.jacobian);
    let values = orthogonalise(&mut Rows { rows, columns: nv, entries: w }, None);
    w.copy_from_slice(out.jacobian);
    factorise::<T, T>(model, m);
    for row in w.chunks_exact_mut(nv.max(1)) {
        half_solve(model, m, row);
    }
    identity(out.inertia, rows);
    let weighted = orthogonalise(&mut Rows { rows, columns: nv, entries: w }, Some(out.inertia));

    // Λ = Uᵀ Σ⁻² U, where Σ² is not next to nothing
    let u = &mut [T::zero(); 36];
    u.iter_mut().zip(out.inertia.iter()).for_each(|(to, from)| *to = *from);
    out.inertia.fill(T::zero());
    let limit = task.threshold * weighted.largest * weighted.largest;
    for k in 0..rows {
        let square = (0..nv).map(|c| w[k * nv + c]).fold(T::zero(), |sum, x| x.mul_add(x, sum));
        let safe =
            square.select_less(limit, T::one(), square).select_less(T::from_f64(f64::MIN_POSITIVE), T::one(), square);
        let inverse = square.select_less(limit, T::zero(), T::one() / safe);
        for r in 0..rows {
            for c in 0..rows {
                out.inertia[r * rows + c] += u[k * rows + r] * inverse * u[k * rows + c];
            }
        }
    }

    // J̄ = M⁻¹ Jᵀ Λ
    for k in 0..nv {
        for c in 0..rows {
            let product = |r: usize| out.jacobian[r * nv + k] * out.inertia[r * rows + c];
            out.inverse[k * rows + c] = (0..rows).map(product).fold(T::zero(), |a, b| a + b);
        }
    }
    solve::<T, T>(model, m, out.inverse, rows);

    // μ = J̄ᵀ (C q̇) − Λ J̇ q̇,   p = J̄ᵀ g
    for r in 0..rows {
        let along = |force: &[T]| (0..nv).fold(T::zero(), |sum, k| out.inverse[k * rows + r].mul_add(force[k], sum));
        let lost = (0..rows).fold(T::zero(), |sum, c| out.inertia[r * rows + c].mul_add(out.bias_acceleration[c], sum));
        out.velocity_force[r] = along(velocity) - lost;
        out.gravity_force[r] = along(gravity);
    }
    Ok(SingularValues { representation, ..values })
}

/// `M` (its lower triangle), `C q̇` and `g` of the links, elastic rotors eliminated.
fn joint_space<T: Scalar>(
    model: &Model<T::Param>,
    state: &State<T>,
    scratch: &mut [DerivativeScratch<T>],
    m: &mut [T],
    velocity: &mut [T],
    gravity: &mut [T],
) -> Result<(), SizeError> {
    let nv = model.nv;
    let no_gravity = model.with_gravity(Vec3::zero());
    outward::<T, T, false>(
        &no_gravity,
        state.q,
        |k| state.qd[k],
        |_| T::zero(),
        |body| body.inertia.map(T::from_param),
        scratch,
    )?;
    let mut lift = -model.gravity.map(T::from_param);
    if model.floating {
        lift = RootMotion::of(state.q, &[]).rot * lift;
    }
    m.fill(T::zero());
    for body in model.bodies {
        let Some(drive) = &body.drive else { continue };
        let Some((on, omega, n)) = carrier::<T, T>(&drive.rotor, scratch) else { continue };
        let mut h = spin::<T, T>(&drive.rotor) * drive.spin(state.qd[body.v_index()], state.thetad[body.v_index()]);
        if drive.elastic.is_some() {
            h += T::from_param(drive.rotor.inertia) * n.dot(omega);
        }
        load_carrier(scratch, on, omega.cross(n).scale(h), Mat3::zero());
    }
    for (i, body) in model.bodies.iter().enumerate().rev() {
        let (k, s) = (body.v_index(), &mut scratch[i]);
        s.column = s.inertia.momentum(s.axis);
        let (force, weight) = (s.f, s.inertia.momentum(Motion { ang: Vec3::zero(), lin: lift }));
        if body.joint == JointKind::Floating {
            for c in 0..6 {
                (velocity[k + c], gravity[k + c]) = (force.to_array()[c], weight.to_array()[c]);
                for (r, entry) in s.inertia.momentum(unit(c)).to_array().into_iter().enumerate() {
                    m[(k + r) * nv + k + c] = entry;
                }
            }
            continue;
        }
        (velocity[k], gravity[k]) = (s.axis.dot(force), s.axis.dot(weight));
        for_each_inertia(model, scratch, i, |column, entry: T| m[k * nv + column] = entry);
        m[k * nv + k] += body.rigid_reflected_inertia::<T>();
        if let Some((rotor, at)) = body.rigid_rotor().and_then(|rotor| Some((rotor, carrier::<T, T>(rotor, scratch)?)))
        {
            let spin = spin::<T, T>(rotor);
            velocity[k] += spin * at.2.dot(scratch[at.0].a.ang);
            for_each_carrying(model, scratch, at, |on| m[k * nv + on.column] += spin * on.speed);
        }
        hand_on::<T, T>(body, i, scratch);
    }
    Ok(())
}

/// `J` and `J̇ q̇` in the task's directions, and the smallest singular value of `T`.
fn of_frame<T: Scalar>(
    model: &Model<T::Param>,
    state: &State<T>,
    task: Task<T>,
    scratch: &[DerivativeScratch<T>],
    jacobian: &mut [T],
    bias: &mut [T],
) -> T {
    let nv = model.nv;
    // From base to world axes.
    let to_world = |v: Vec3<T>| if model.floating { RootMotion::of(state.q, &[]).rot.transpose_mul(v) } else { v };
    let s = &scratch[task.frame.body];
    let link = model.bodies[task.frame.body].frame.map(T::from_param);
    let pose = task.frame.placement.after(link).after(s.pose);
    let axes = pose.rot.rows.map(to_world);
    let angles = Angles::of(task.rotation, Mat3::from_rows(axes[0], axes[1], axes[2]).transpose(), task.threshold);
    let rates = |m: Motion<T>| Motion { ang: angles.as_ref().map_or(m.ang, |angles| angles.rates(m.ang)), lin: m.lin };
    let in_world = |m: Motion<T>| Motion { ang: to_world(m.ang), lin: to_world(m.lin) };
    // The point moves with v + ω × r, and accelerates with a + α × r + ω × (v + ω × r).
    let moved = |m: Motion<T>| Motion { ang: m.ang, lin: m.lin + m.ang.cross(pose.pos) };
    let (v, mut a) = (moved(s.v), moved(s.a));
    a.lin += v.ang.cross(v.lin);
    let (v, mut a) = (in_world(v), in_world(a));
    if let Some(angles) = &angles {
        a.ang -= angles.turning(v.ang);
    }
    let a = rates(a).to_array();
    for (entry, direction) in bias.iter_mut().zip(task.directions) {
        *entry = a[*direction];
    }
    jacobian.fill(T::zero());
    let mut body = Some(task.frame.body);
    while let Some(b) = body {
        let on = &model.bodies[b];
        for c in 0..on.joint.nv() {
            let axis = if on.joint == JointKind::Floating { unit(c) } else { scratch[b].axis };
            let column = rates(in_world(moved(axis))).to_array();
            for (row, direction) in task.directions.iter().enumerate() {
                jacobian[row * nv + on.v_index() + c] = column[*direction];
            }
        }
        body = on.parent();
    }
    angles.map_or(T::one(), |angles| angles.smallest)
}

fn identity<T: Scalar>(matrix: &mut [T], size: usize) {
    for (i, entry) in matrix.iter_mut().enumerate() {
        *entry = if i % (size + 1) == 0 { T::one() } else { T::zero() };
    }
}
