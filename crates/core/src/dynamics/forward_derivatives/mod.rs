//! Forward dynamics with its first derivatives.
//!
//! The links obey `M q̈ + b(q, q̇, θ̇, r) = τ_J − friction + τ_ext` when elastic rotors are eliminated (PHYSICS §3), `r` being the net
//! torque on a rotor, and a rotor follows with `θ̈ = r/B − n·α/N`. So
//!
//! ```text
//! M ∂q̈ = ∂(τ_J − friction) − ∂(M q̈ + b) − R ∂r,    R_ij = S_i·n_j / N_j
//! ∂θ̈   = ∂r / B − ∂(n·α) / N − Rᵀ ∂q̈
//! ```
//!
//! where `∂(M q̈ + b)` are the sensitivities of [`super::at_base`] at the `q̈` found. With rigid gears the rotors' inertia is in `M` and
//! their columns belong to `q̇` and `q̈`. What acts on a joint depends on its own coordinates alone.
//!
//! Cost O(n·depth) for the right-hand sides, then two dense products. No allocation, no branch on values.

mod passes;

use super::at_base::DerivativeScratch;
use super::dense::{Part, invert, stride, transposed_times};
use super::{External, Forward, State, check_external, check_scratch, check_state};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Model, SizeError};
use passes::Passes;

/// What [`forward_derivatives`] writes: matrices of `nv` rows and `5 nv` columns by rows, one block of `nv` columns after the other
/// for the derivatives with respect to `q, q̇, θ, θ̇, τ`. Derivatives with respect to the pose of a floating root are with respect to
/// a small motion of it in its own frame, angular first. Columns of `θ` and `θ̇` are zero at joints without an elastic transmission.
#[derive(Debug)]
pub struct ForwardDerivatives<'a, T> {
    /// Of the joint accelerations.
    pub qdd: &'a mut [T],
    /// Of the reflected motor accelerations; those of `qdd` where there is no elastic transmission.
    pub thetadd: &'a mut [T],
}

/// Entries of the matrix that [`forward_derivatives`] works in.
pub fn derivative_matrix_len<P: Scalar>(model: &Model<P>) -> usize {
    let nv = model.nv;
    (2 * stride(nv) + 6 * nv + 2) * nv
}

/// The accelerations of [`super::forward_dynamics`] and how they change with state and motor torques, in all four models. Loads from
/// outside keep their coordinates: wrenches turn with their links. `scratch` has one record per body, `matrix`
/// [`derivative_matrix_len`] entries.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
///
/// # Example
///
/// The flexible link of the crate's example: the spring pulls link and rotor together.
///
/// ```
/// use gyroflex::dynamics::{DerivativeScratch, External, Forward, ForwardDerivatives, State, derivative_matrix_len, forward_derivatives};
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
/// let (mut qdd, mut thetadd, mut tau_j) = ([0.0_f64], [0.0], [0.0]);
/// let (mut by_qdd, mut by_thetadd) = ([0.0; 5], [0.0; 5]);
/// let mut matrix = vec![0.0; derivative_matrix_len(&model)];
/// forward_derivatives(
///     &model,
///     State { q: &[0.3], qd: &[0.0], theta: &[0.3], thetad: &[0.0] },
///     &[0.0],
///     External::none(),
///     &mut [DerivativeScratch::new()],
///     &mut matrix,
///     Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j },
///     ForwardDerivatives { qdd: &mut by_qdd, thetadd: &mut by_thetadd },
/// )?;
/// let (inertia, rotor, stiffness) = (0.04 + 2.0 * 0.25 * 0.25, 2e-5 * 100.0 * 100.0, 4000.0);
/// let [by_q, _by_qd, by_theta, _by_thetad, by_tau] = by_thetadd;
/// assert!((by_qdd[2] - stiffness / inertia).abs() < 1e-9);
/// assert!((by_theta + stiffness / rotor).abs() < 1e-9 && (by_q - stiffness / rotor).abs() < 1e-9);
/// assert!((by_tau - 1.0 / rotor).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[expect(clippy::too_many_arguments)]
pub fn forward_derivatives<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    scratch: &mut [DerivativeScratch<T>],
    matrix: &mut [T],
    value: Forward<T>,
    out: ForwardDerivatives<T>,
) -> Result<(), SizeError> {
    check_state(model, &state)?;
    check_external(model, &ext)?;
    check_scratch(model, scratch)?;
    value.check(model, tau)?;
    SizeError::check("matrix", matrix.len(), derivative_matrix_len(model))?;
    SizeError::check("derivatives of qdd", out.qdd.len(), 5 * model.nv * model.nv)?;
    SizeError::check("derivatives of thetadd", out.thetadd.len(), 5 * model.nv * model.nv)?;
    let nv = model.nv;
    let (m, rest) = matrix.split_at_mut(stride(nv) * nv);
    let (inverse, rest) = rest.split_at_mut(stride(nv) * nv);
    let (r, rest) = rest.split_at_mut(nv * nv);
    let (rhs, rest) = rest.split_at_mut(5 * nv * nv);
    let (left, pivots) = rest.split_at_mut(nv);
    T::dispatch(Passes { model, state, tau, ext, scratch, m, inverse, r, rhs, left, pivots, value, out })
}

impl<T: Scalar> Kernel<T> for Passes<'_, '_, T> {
    type Output = Result<(), SizeError>;

    #[inline(always)]
    fn run<F: Over<T>>(mut self) -> Result<(), SizeError> {
        let nv = self.model.nv;
        let width = 5 * nv;
        for all in [&mut *self.m, &mut *self.r, &mut *self.rhs, &mut *self.out.thetadd] {
            all.fill(T::zero());
        }
        self.without_accelerations::<F>()?;
        self.composites::<F>();
        invert::<T, F>(nv, self.m, self.pivots, self.inverse);
        self.accelerate::<F>();
        self.right_hand_sides::<F>();
        let elastic = self.model.bodies.iter().any(|body| body.is_elastic());
        let part = Part { rows: nv, columns: if elastic { width } else { 2 * nv }, width };
        transposed_times::<T, F, false>((self.inverse, stride(nv)), |_| nv, self.rhs, self.out.qdd, part);
        if elastic {
            // A rotor is carried by joints before its own: R is strictly triangular.
            transposed_times::<T, F, true>((self.r, nv), |end| end - 1, self.out.qdd, self.out.thetadd, part);
        } else {
            self.without_elastic_joints();
        }
        self.rotors::<F>();
        Ok(())
    }
}
