//! The operational-space model, against dense algebra and against forward dynamics.

use gyroflex::Scalar;
use gyroflex::dynamics::{
    Axes, DerivativeScratch, Frame, OperationalSpace, Rotation, SingularValues, State, Task, jacobian, operational_len,
    operational_space, placements,
};
use gyroflex::integrate::integrate;
use gyroflex::model::{Fidelity, Model};
use gyroflex::spatial::{Mat3, Transform, Vec3};
use gyroflex_testkit::State as Point;
use gyroflex_testkit::dual::{Dual, moving_positions};
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{norm, tol};
use gyroflex_tests::{Trial, for_trials};
use nalgebra::{DMatrix, DVector};

const ALL: [usize; 6] = [0, 1, 2, 3, 4, 5];

struct Found {
    jacobian: DMatrix<f64>,
    bias_acceleration: DVector<f64>,
    inertia: DMatrix<f64>,
    inverse: DMatrix<f64>,
    velocity_force: DVector<f64>,
    gravity_force: DVector<f64>,
    values: SingularValues<f64>,
}

fn frame<T: Scalar>(model: &Model<'_, f64>) -> Frame<T> {
    let turn = Mat3::from_rpy(0.3, -0.5, 1.1).map(T::from_f64);
    let placement = Transform::from_pose(turn, Vec3::new(0.1, -0.2, 0.15).map(T::from_f64));
    Frame { body: model.bodies().len() - 1, placement }
}

fn found(model: &Model<'_, f64>, s: &Point, directions: &[usize]) -> Found {
    found_in(model, s, directions, Rotation::Geometric)
}

fn found_in(model: &Model<'_, f64>, s: &Point, directions: &[usize], rotation: Rotation) -> Found {
    let (nv, rows) = (model.nv(), directions.len());
    let mut scratch = vec![DerivativeScratch::new(); model.bodies().len()];
    let mut matrix = vec![f64::NAN; operational_len(model, rows)];
    let [mut jacobian, mut inverse] = [(); 2].map(|()| vec![f64::NAN; rows * nv]);
    let [mut bias_acceleration, mut velocity_force, mut gravity_force] = [(); 3].map(|()| vec![f64::NAN; rows]);
    let mut inertia = vec![f64::NAN; rows * rows];
    let out = OperationalSpace {
        jacobian: &mut jacobian,
        bias_acceleration: &mut bias_acceleration,
        inertia: &mut inertia,
        inverse: &mut inverse,
        velocity_force: &mut velocity_force,
        gravity_force: &mut gravity_force,
    };
    let state = State { q: &s.q, qd: &s.qd, theta: &s.theta, thetad: &s.thetad };
    let task = Task { frame: frame(model), directions, rotation, threshold: 1e-12 };
    let values = operational_space(model, state, task, &mut scratch, &mut matrix, out).expect("slices fit");
    Found {
        jacobian: DMatrix::from_row_slice(rows, nv, &jacobian),
        bias_acceleration: DVector::from_vec(bias_acceleration),
        inertia: DMatrix::from_row_slice(rows, rows, &inertia),
        inverse: DMatrix::from_row_slice(nv, rows, &inverse),
        velocity_force: DVector::from_vec(velocity_force),
        gravity_force: DVector::from_vec(gravity_force),
        values,
    }
}

/// Arms that can move their last frame in every direction, without what the model of links alone does not know.
fn able() -> Options {
    Options { bodies: 7..=12, branching: 0.0, transmission_error: 0.0, ..Options::default().lossless() }
}

/// Inertia of the links when elastic rotors are free to follow: `M − S B⁻¹ Sᵀ`.
fn effective_inertia(t: &Trial<'_, f64>) -> DMatrix<f64> {
    let nv = t.robot.nv();
    let square = |x: &[f64]| DMatrix::from_row_slice(nv, nv, x);
    let (m, s) = (square(&t.core.mass_matrix(&t.state)), square(&t.core.coupling(&t.state)));
    let free = t.core.reflected_inertia().iter().map(|b| if *b > 0.0 { 1.0 / b } else { 0.0 }).collect();
    m - &s * DMatrix::from_diagonal(&DVector::<f64>::from_vec(free)) * s.transpose()
}

#[test]
fn inertia_equals_the_inverse_of_j_m_inverse_j_transposed() {
    for_trials::<f64>(200, &able(), &Fidelity::ALL, tol(1e-10, 0.0), |t| {
        let got = found(&t.core.model(), &t.state, &ALL);
        let m = effective_inertia(t).cholesky().expect("it is positive definite");
        let j = &got.jacobian;
        let mobility = j * m.solve(&j.transpose());
        // Where the frame hardly moves, dense inversion loses the digits this is about.
        let spread = mobility.clone().symmetric_eigenvalues();
        if spread.min() < 1e-4 * spread.max() {
            return;
        }
        let want = mobility.try_inverse().expect("it is regular");
        t.assert_close("Λ", got.inertia.as_slice(), want.as_slice(), 0.0);
        t.assert_close("J̄", got.inverse.as_slice(), (m.solve(&j.transpose()) * want).as_slice(), 0.0);
        let svd = j.clone().singular_values();
        t.assert_close("σ", &[got.values.smallest, got.values.largest], &[svd.min(), svd.max()], 0.0);
    });
}

#[test]
fn jacobian_and_its_rate_equal_automatic_differentiation() {
    for_trials::<f64>(200, &able(), &Fidelity::ALL, tol(1e-11, 0.0), |t| {
        let (model, s) = (t.core.model(), &t.state);
        let got = found(&model, s, &ALL);
        let q = moving_positions(&s.q, &s.qd);
        let mut poses = vec![Transform::<Dual>::identity(); model.bodies().len()];
        placements(&model, &q, &mut poses).expect("slices fit");
        let mut j = vec![Dual::from_f64(0.0); 6 * model.nv()];
        jacobian(&model, &poses, frame(&model), Axes::World, &mut j).expect("slices fit");
        let part = |f: fn(&Dual) -> f64| DMatrix::from_row_iterator(6, model.nv(), j.iter().map(f));
        t.assert_close("J", got.jacobian.as_slice(), part(|x| x.value).as_slice(), 0.0);
        let want = part(|x| x.slope) * DVector::from_column_slice(&s.qd);
        t.assert_close("J̇ q̇", got.bias_acceleration.as_slice(), want.as_slice(), 1.0);
    });
}

/// `Λ ẍ + μ + p = J̄ᵀ u` with the acceleration that forward dynamics finds.
#[test]
fn frame_accelerates_as_the_forces_on_it_say() {
    for_trials::<f64>(200, &able(), &Fidelity::ALL, tol(1e-9, 0.0), |t| {
        let model = t.core.model();
        let nv = model.nv();
        let s = Point { tau_ext: Vec::new(), wrenches: Vec::new(), ..t.state.clone() };
        let got = found(&model, &s, &ALL);
        if got.values.smallest < 1e-2 * got.values.largest {
            return;
        }
        let moved = t.core.forward(&s);
        let coupling = DMatrix::from_row_slice(nv, nv, &t.core.coupling(&s));
        let b = t.core.reflected_inertia();
        // τ − τ_J accelerates an elastic rotor; elsewhere the motor acts on the link.
        let elastic: Vec<bool> = model.bodies().iter().flat_map(|b| vec![b.is_elastic(); b.joint.nv()]).collect();
        let pick = |a: f64, b: f64, k: usize| if elastic[k] { a } else { b };
        let on_rotor = DVector::from_fn(nv, |k, _| pick((s.tau[k] - moved.tau_j[k]) / b[k], 0.0, k));
        let u = DVector::from_fn(nv, |k, _| pick(moved.tau_j[k], s.tau[k], k)) - coupling * on_rotor;
        let acceleration = &got.jacobian * DVector::from_vec(moved.qdd) + &got.bias_acceleration;
        let left = &got.inertia * acceleration + &got.velocity_force + &got.gravity_force;
        let right = got.inverse.transpose() * u;
        t.assert_close("force", left.as_slice(), right.as_slice(), norm(right.as_slice()));
    });
}

/// A commanded force on the frame of a rigid arm gives the acceleration it was computed for.
#[test]
fn commanded_force_gives_the_predicted_acceleration() {
    for_trials::<f64>(200, &able(), &[Fidelity::Rigid, Fidelity::RigidReflected], tol(1e-8, 0.0), |t| {
        let model = t.core.model();
        let quiet = Point { tau_ext: Vec::new(), wrenches: Vec::new(), ..t.state.clone() };
        let got = found(&model, &quiet, &ALL);
        if got.values.smallest < 1e-2 * got.values.largest {
            return;
        }
        let wanted = DVector::from_column_slice(&[0.3, -0.2, 0.5, 1.0, -2.0, 0.7]);
        let force = &got.inertia * &wanted + &got.velocity_force + &got.gravity_force;
        let tau = got.jacobian.transpose() * force;
        let moved = t.core.forward(&Point { tau: tau.as_slice().to_vec(), ..quiet });
        let acceleration = &got.jacobian * DVector::from_vec(moved.qdd) + &got.bias_acceleration;
        t.assert_close("acceleration", acceleration.as_slice(), wanted.as_slice(), 0.0);
    });
}

/// Three joints cannot move a frame in six directions: the smallest singular value says so, and every number stays finite.
#[test]
fn singular_poses_are_reported_and_give_numbers() {
    let short = Options { bodies: 3..=3, floating: 0.0, branching: 0.0, ..Options::default() };
    for_trials::<f64>(50, &short, &Fidelity::ALL, tol(0.0, 0.0), |t| {
        let got = found(&t.core.model(), &t.state, &ALL);
        assert!(got.values.smallest <= 1e-12 * got.values.largest, "{t}: {:?}", got.values);
        let all = [&got.inertia, &got.inverse, &got.jacobian];
        assert!(all.iter().all(|m| m.iter().all(|x| x.is_finite())), "{t}");
        // Λ is an inertia: it has no more than three directions.
        let rank =
            got.inertia.clone().symmetric_eigenvalues().iter().filter(|x| **x > 1e-9 * got.inertia.amax()).count();
        assert!(rank <= 3, "{t}: rank {rank}");
    });
}

/// Roll, pitch and yaw, or the angles about z, y and z, of a frame that moves.
fn angles(model: &Model<'_, f64>, q: &[Dual], rotation: Rotation) -> [Dual; 3] {
    let mut poses = vec![Transform::<Dual>::identity(); model.bodies().len()];
    placements(model, q, &mut poses).expect("slices fit");
    let frame = frame::<Dual>(model);
    let [x, y, z] = frame.placement.after(poses[frame.body]).rotation().rows;
    match rotation {
        // R = Rz(yaw) Ry(pitch) Rx(roll)
        Rotation::RollPitchYaw => {
            let level = (x.x * x.x + y.x * y.x).sqrt();
            [z.y.atan2(z.z), (-z.x).atan2(level), y.x.atan2(x.x)]
        }
        // R = Rz(a) Ry(b) Rz(c)
        _ => {
            let level = (x.z * x.z + y.z * y.z).sqrt();
            [y.z.atan2(x.z), level.atan2(z.z), z.y.atan2(-z.x)]
        }
    }
}

#[test]
fn analytical_jacobian_gives_the_rates_of_the_angles() {
    for rotation in [Rotation::RollPitchYaw, Rotation::Zyz] {
        for_trials::<f64>(200, &able(), &[Fidelity::Complete], tol(1e-9, 0.0), |t| {
            let (model, s) = (t.core.model(), &t.state);
            let got = found_in(&model, s, &ALL, rotation);
            if got.values.representation < 0.05 {
                return;
            }
            let rates = angles(&model, &moving_positions(&s.q, &s.qd), rotation).map(|x| x.slope);
            let velocity = &got.jacobian * DVector::from_column_slice(&s.qd);
            t.assert_close("rates of the angles", &velocity.as_slice()[..3], &rates, 0.0);
        });
    }
}

/// `J̇_A q̇` is how the rates change while the joints keep their speeds, by a difference of them an instant before and after.
#[test]
fn rates_of_the_angles_change_as_the_bias_acceleration_says() {
    let step = 1e-6;
    for rotation in [Rotation::RollPitchYaw, Rotation::Zyz] {
        for_trials::<f64>(100, &able(), &[Fidelity::Complete], tol(1e-5, 0.0), |t| {
            let (model, s) = (t.core.model(), &t.state);
            let got = found_in(&model, s, &ALL, rotation);
            if got.values.representation < 0.1 {
                return;
            }
            let rates = |time: f64| {
                let mut q = vec![0.0; s.q.len()];
                let moved: Vec<f64> = s.qd.iter().map(|v| v * time).collect();
                integrate(&model, &s.q, &moved, &mut q).expect("slices fit");
                let later = Point { q, ..s.clone() };
                &found_in(&model, &later, &ALL, rotation).jacobian * DVector::from_column_slice(&s.qd)
            };
            let want = (rates(step) - rates(-step)) / (2.0 * step);
            t.assert_close("J̇ q̇", &got.bias_acceleration.as_slice()[..3], &want.as_slice()[..3], 1.0);
        });
    }
}
