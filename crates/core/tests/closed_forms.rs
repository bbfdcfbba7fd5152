//! Mechanisms whose equations fit on a line.

mod common;
use common::{Lowered, drive, elastic, link};
use gyroflex::dynamics::*;
use gyroflex::model::*;

const N: f64 = 100.0;
const J: f64 = 1e-4;

fn close(got: f64, want: f64) {
    assert!((got - want).abs() <= 1e-12 * want.abs().max(1.0), "got {got}, closed form {want}");
}

/// `I q̈ = K (θ − q) + D (θ̇ − q̇) − m g c cos q`, `B θ̈ = τ − τ_J`: one link, its rotor on the world (Spong 1987, §II).
#[test]
fn single_flexible_joint_obeys_spongs_equations() {
    let mut body = link(None, [0.0, 1.0, 0.0], [0.0; 3], [0.3, 0.0, 0.0]);
    body.drive = Some(drive(None, [0.0, 1.0, 0.0], N, elastic(500.0, 2.0)));
    let (q, qd, theta, thetad, tau) = (0.4, 0.7, 0.45, 0.9, 3.0);
    for fidelity in [Fidelity::Complete, Fidelity::Reduced] {
        let robot = Lowered::new(&[body], [0.0, 0.0, -9.81], fidelity);
        let (mut qdd, mut thetadd, mut tau_j) = ([0.0], [0.0], [0.0]);
        let state = State { q: &[q], qd: &[qd], theta: &[theta], thetad: &[thetad] };
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        aba(&robot.model(), state, &[tau], External::none(), &mut [AbaScratch::new()], out).unwrap();

        let torque = 500.0 * (theta - q) + 2.0 * (thetad - qd);
        let inertia = 0.03 + 0.3 * 0.3;
        // About y, a positive turn lowers a link that points along x.
        close(tau_j[0], torque);
        close(qdd[0], (torque + 9.81 * 0.3 * f64::cos(q)) / inertia);
        close(thetadd[0], (tau - torque) / (N * N * J));
    }
}

/// A rotor spinning about x on a gimbal that yaws at Ω asks the pitch joint for `h Ω`, `h = J N θ̇`; the sign is that of
/// `ω × h n`. The reduced model does not know this couple.
#[test]
fn yawing_a_spinning_rotor_needs_the_precession_torque() {
    let yaw = link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]);
    let pitch = link(Some(0), [0.0, 1.0, 0.0], [0.0; 3], [0.0; 3]);
    let mut roll = link(Some(1), [1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]);
    roll.drive = Some(drive(Some(1), [1.0, 0.0, 0.0], N, elastic(500.0, 0.0)));
    let (omega, spin) = (2.0, 3.0);
    for (fidelity, couple) in [(Fidelity::Complete, J * N * spin * omega), (Fidelity::Reduced, 0.0)] {
        let robot = Lowered::new(&[yaw, pitch, roll], [0.0; 3], fidelity);
        let zero = [0.0; 3];
        let state = State { q: &zero, qd: &[omega, 0.0, 0.0], theta: &zero, thetad: &[0.0, 0.0, spin] };
        let (mut tau_j, mut tau) = ([0.0; 3], [0.0; 3]);
        rnea(
            &robot.model(),
            state,
            Acceleration { qdd: &zero, thetadd: &zero },
            External::none(),
            &mut [RneaScratch::new(); 3],
            Inverse { tau_j: &mut tau_j, tau: &mut tau },
        )
        .unwrap();
        close(tau_j[1], couple);
    }
}

/// A rotor on its own link's parent, gear rigid, axes parallel: turning the parent turns the rotor by `1` and the joint by
/// `N`, so that `M_11` holds `J` once, `M_12` holds `N J` and `M_22` holds `N² J`.
#[test]
fn parallel_rigid_rotor_adds_j_nj_and_n2j() {
    let first = link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]);
    let mut second = link(Some(0), [0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]);
    let bare = Lowered::new(&[first, second], [0.0; 3], Fidelity::Complete);
    let mut geared = drive(Some(0), [0.0, 0.0, 1.0], -N, TransmissionSpec::Rigid);
    geared.rotor.body = Some(RotorBody { mass: 0.0, transverse_inertia: 0.5 * J });
    second.drive = Some(geared);
    let whole = Lowered::new(&[first, second], [0.0; 3], Fidelity::Complete);
    let matrix = |robot: &Lowered| {
        let mut m = [0.0; 4];
        crba(&robot.model(), &[0.3, -0.8], &mut [CrbaScratch::new(); 2], &mut m).unwrap();
        m
    };
    let (m0, m) = (matrix(&bare), matrix(&whole));
    close(m[0] - m0[0], J);
    close(m[1] - m0[1], -N * J);
    close(m[2] - m0[2], -N * J);
    close(m[3] - m0[3], N * N * J);
}

/// Without torque and gravity the angular momentum of a floating body about its centre of mass keeps its size.
#[test]
fn free_body_tumbles_by_eulers_equations() {
    let mut body = link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]);
    body.joint = JointKind::Floating;
    let robot = Lowered::new(&[body], [0.0; 3], Fidelity::Complete);
    let q = [0.1, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0];
    let qd = [1.0, 2.0, 3.0, 0.5, -0.5, 0.25];
    let zero = [0.0; 6];
    let (mut qdd, mut thetadd, mut tau_j) = ([0.0; 6], [0.0; 6], [0.0; 6]);
    aba(
        &robot.model(),
        State { q: &q, qd: &qd, theta: &zero, thetad: &zero },
        &zero,
        External::none(),
        &mut [AbaScratch::new()],
        Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j },
    )
    .unwrap();
    // I ω̇ = −ω × I ω for I = diag(0.02, 0.03, 0.04)
    close(qdd[0], (0.03 - 0.04) * 2.0 * 3.0 / 0.02);
    close(qdd[1], (0.04 - 0.02) * 3.0 * 1.0 / 0.03);
    close(qdd[2], (0.02 - 0.03) * 1.0 * 2.0 / 0.04);
    // No force: d(R v)/dt = 0, so v̇ = −ω × v in body axes.
    close(qdd[3], -(2.0 * 0.25 - 3.0 * -0.5));
    close(qdd[4], -(3.0 * 0.5 - 1.0 * 0.25));
    close(qdd[5], -(1.0 * -0.5 - 2.0 * 0.5));
}

/// The Jacobian of a frame times `q̇` is the rate of its pose.
#[test]
fn jacobian_is_the_rate_of_the_pose() {
    use gyroflex::spatial::{Mat3, Transform, Vec3};
    let first = link(None, [0.6, 0.0, 0.8], [0.1, 0.2, 0.3], [0.0; 3]);
    let mut second = link(Some(0), [0.0, 1.0, 0.0], [0.4, -0.1, 0.2], [0.0; 3]);
    second.joint = JointKind::Prismatic;
    let third = link(Some(1), [1.0, 0.0, 0.0], [0.0, 0.3, 0.1], [0.0; 3]);
    let robot = Lowered::new(&[first, second, third], [0.0; 3], Fidelity::Complete);
    let model = robot.model();
    let placement = Transform::from_pose(Mat3::from_rpy(0.3, -0.4, 0.5), Vec3::new(0.1, 0.2, -0.3));
    let pose = |q: &[f64; 3]| {
        let mut poses = [Transform::identity(); 3];
        placements(&model, q, &mut poses).unwrap();
        (placement.after(poses[2]), poses)
    };
    let (q, qd, h) = ([0.3, -0.2, 0.9], [0.7, 0.4, -0.6], 1e-6);
    let (here, poses) = pose(&q);
    let mut jac = [0.0; 18];
    jacobian(&model, &poses, Frame { body: 2, placement }, Axes::World, &mut jac).unwrap();
    let step = |s: f64| pose(&[q[0] + s * qd[0], q[1] + s * qd[1], q[2] + s * qd[2]]).0;
    let (ahead, behind) = (step(h), step(-h));
    let rate = (ahead.pos - behind.pos).scale(0.5 / h);
    // Ṙ Rᵀ = ω×
    let spin = (ahead.rotation() - behind.rotation()).scale(0.5 / h) * here.rotation().transpose();
    let want = [spin.rows[2].y, spin.rows[0].z, spin.rows[1].x, rate.x, rate.y, rate.z];
    for (row, want) in want.into_iter().enumerate() {
        let got: f64 = (0..3).map(|k| jac[row * 3 + k] * qd[k]).sum();
        assert!((got - want).abs() < 1e-8, "row {row}: {got} against {want}");
    }
}

/// A spring table keeps its points, increases between them, and its energy is the integral of its torque.
#[test]
fn spring_table_is_monotone_and_conservative() {
    let table = [[0.0, 0.0], [0.01, 20.0], [0.02, 60.0], [0.05, 400.0]];
    let mut body = link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]);
    body.drive = Some(drive(
        None,
        [0.0, 0.0, 1.0],
        N,
        TransmissionSpec::Elastic {
            spring: SpringSpec::Table { first: 0, len: 4 },
            damping: 0.0,
            error: TransmissionError::none(),
        },
    ));
    let robot = Lowered::with_tables(&[body], &table, [0.0; 3], Fidelity::Complete);
    let model = robot.model();
    let spring = model.bodies()[0].drive.as_ref().unwrap().elastic.unwrap().spring;
    let torque = |x: f64| spring.torque(x, model.knots());
    for [x, y] in table {
        close(torque(x), y);
        close(torque(-x), -y);
    }
    let (mut x, h) = (-0.08, 1e-4);
    while x < 0.08 {
        let (low, high) = (torque(x), torque(x + h));
        assert!(high > low, "falls at {x}");
        // Simpson's rule is exact for the cubic pieces; a step across a knot is off by the jump in k''.
        let area = h / 6.0 * (low + 4.0 * torque(x + 0.5 * h) + high);
        let stored = spring.energy(x + h, model.knots()) - spring.energy(x, model.knots());
        assert!((stored - area).abs() < 1e-7, "energy at {x}: {stored} against {area}");
        let slope = (high - low) / h;
        assert!((spring.slope(x + 0.5 * h, model.knots()) - slope).abs() < 0.02 * slope.abs() + 1.0, "slope at {x}");
        x += h;
    }
    close(spring.energy(0.0, model.knots()), 0.0);
}

/// One robot hangs together: beside a floating root nothing stands on the world.
#[test]
fn a_body_beside_a_floating_root_is_refused() {
    let mut root = link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.1, 0.0, 0.0]);
    root.joint = JointKind::Floating;
    let child = |parent| link(parent, [0.0, 1.0, 0.0], [0.2, 0.0, 0.0], [0.1, 0.0, 0.0]);
    let defect = |parent| {
        let bodies = [root, child(parent)];
        let spec = RobotSpec { bodies: &bodies, spring_tables: &[], gravity: [0.0, 0.0, -9.81].into() };
        spec.validate().err().map(|e| (e.body, matches!(e.defect, Defect::BesideFloating)))
    };
    assert_eq!(defect(Some(0)), None);
    assert_eq!(defect(None), Some((1, true)));
}
