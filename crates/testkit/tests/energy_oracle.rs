//! The oracle of energies against the dense one, against what follows from energies, and against a textbook.

use gyroflex::model::{BodySpec, Fidelity, Friction, JointKind, RobotSpec};
use gyroflex::spatial::{SpatialInertia, SymMat3, Transform, Vec3};
use gyroflex_testkit::dense::Oracle;
use gyroflex_testkit::random::{Options, RandomRobot};
use gyroflex_testkit::tolerance::{assert_close, assert_close_above};
use gyroflex_testkit::{EnergyOracle, State};
use nalgebra::{DVector, Matrix2};

const TOLERANCE: f64 = 1e-12;

fn for_robots(law: impl Fn(&RandomRobot, Fidelity, &State, &str)) {
    let options = Options { bodies: 1..=8, ..Options::default() };
    for seed in 0..100 {
        let robot = RandomRobot::new(seed, &options);
        for fidelity in Fidelity::ALL {
            law(&robot, fidelity, &robot.state(0), &format!("seed {seed}, model {}", fidelity.name()));
        }
    }
}

#[test]
fn kinetic_energy_is_the_dense_oracles_and_half_a_quadratic_form() {
    for_robots(|robot, fidelity, s, context| {
        let energies = EnergyOracle::new(robot.spec(), fidelity);
        let want = Oracle::new(robot.spec(), fidelity).energy(s).kinetic;
        assert_close("T", &context, &[energies.kinetic(s)], &[want], TOLERANCE);
        let xd = energies.velocity(s);
        let form = 0.5 * xd.dot(&(energies.inertia(s) * &xd));
        assert_close("½ ẋᵀ M ẋ", &context, &[form], &[want], TOLERANCE);
    });
}

/// Newton's and Euler's equations at zero acceleration ask for the forces that follow from energies.
#[test]
fn coriolis_matrix_times_velocity_and_gravity_are_the_dense_oracles_forces() {
    for_robots(|robot, fidelity, s, context| {
        let nv = robot.nv();
        let energies = EnergyOracle::new(robot.spec(), fidelity);
        let mut got = energies.coriolis(s) * energies.velocity(s);
        let mut rows = got.rows_mut(0, nv);
        rows += energies.gravity(s);

        let zero = vec![0.0; nv];
        let forces =
            Oracle::new(robot.spec(), fidelity).tree_forces(&State { qdd: zero.clone(), thetadd: zero, ..s.clone() });
        let mut want = DVector::zeros(2 * nv);
        want.rows_mut(0, nv).copy_from_slice(&forces[..nv]);
        let (mut joint, mut rotor) = (0, nv);
        for body in &robot.bodies {
            if let Some(drive) = &body.drive {
                let rigid = matches!(drive.transmission, gyroflex::model::TransmissionSpec::Rigid);
                want[if rigid || !fidelity.is_elastic() { joint } else { nv + joint }] += forces[rotor];
                rotor += 1;
            }
            joint += body.joint.nv();
        }
        assert_close_above("C ẋ + g", &context, got.as_slice(), want.as_slice(), TOLERANCE, 1e-3);
    });
}

#[test]
fn inertia_matrix_changes_as_differences_say() {
    for_robots(|robot, fidelity, s, context| {
        if robot.is_floating() {
            return;
        }
        let energies = EnergyOracle::new(robot.spec(), fidelity);
        let xd = energies.velocity(s);
        let nv = robot.nv();
        let at = |t: f64| {
            let q = s.q.iter().zip(xd.iter()).map(|(q, v)| q + t * v).collect();
            let theta = s.theta.iter().zip(xd.iter().skip(nv)).map(|(q, v)| q + t * v).collect();
            energies.inertia(&State { q, theta, ..s.clone() })
        };
        let h = 1e-5;
        let want = (at(h) - at(-h)) / (2.0 * h);
        let size = energies.inertia(s).amax();
        assert_close_above("Ṁ", &context, energies.inertia_rate(s).as_slice(), want.as_slice(), 1e-8, size);
    });
}

/// Spong, Hutchinson, Vidyasagar, *Robot Modeling and Control*, the planar elbow manipulator: `h = −m₂ l₁ l_c2 sin q₂`.
#[test]
fn planar_arm_of_two_links_has_the_textbooks_matrices() {
    let (m, l1, lc, i) = ([3.0, 2.0], 0.7, [0.3, 0.25], [0.11, 0.07]);
    let link = |k: usize| BodySpec {
        parent: (k > 0).then(|| k - 1),
        joint: JointKind::Revolute,
        axis: Vec3::new(0.0, 0.0, 1.0),
        placement: Transform { pos: Vec3::new(if k > 0 { l1 } else { 0.0 }, 0.0, 0.0), ..Transform::identity() },
        inertia: SpatialInertia::from_com(m[k], Vec3::new(lc[k], 0.0, 0.0), SymMat3::diagonal(0.1, 0.1, i[k])),
        friction: Friction::none(),
        drive: None,
    };
    let (bodies, g) = ([link(0), link(1)], 9.81);
    let spec = RobotSpec { bodies: &bodies, spring_tables: &[], gravity: Vec3::new(0.0, -g, 0.0) };
    let (q, qd) = ([0.4, -1.1], [1.3, 0.8]);
    let s = State { q: q.to_vec(), qd: qd.to_vec(), theta: vec![0.0; 2], thetad: vec![0.0; 2], ..State::default() };
    let energies = EnergyOracle::new(spec, Fidelity::Complete);

    let (sin, cos) = f64::sin_cos(q[1]);
    let m22 = m[1] * lc[1] * lc[1] + i[1];
    let m12 = m22 + m[1] * l1 * lc[1] * cos;
    let m11 = m[0] * lc[0] * lc[0] + i[0] + m[1] * l1 * l1 + 2.0 * m12 - m22;
    let h = -m[1] * l1 * lc[1] * sin;
    let inertia = Matrix2::new(m11, m12, m12, m22);
    let coriolis = Matrix2::new(h * qd[1], h * (qd[0] + qd[1]), -h * qd[0], 0.0);
    let g2 = m[1] * lc[1] * g * f64::cos(q[0] + q[1]);
    let gravity = [(m[0] * lc[0] + m[1] * l1) * g * f64::cos(q[0]) + g2, g2];

    let links = |a: nalgebra::DMatrix<f64>| a.view((0, 0), (2, 2)).into_owned();
    assert_close("M", &"elbow", links(energies.inertia(&s)).as_slice(), inertia.as_slice(), TOLERANCE);
    assert_close("C", &"elbow", links(energies.coriolis(&s)).as_slice(), coriolis.as_slice(), TOLERANCE);
    assert_close("g", &"elbow", energies.gravity(&s).as_slice(), &gravity, TOLERANCE);
}
