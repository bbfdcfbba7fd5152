//! A link that bends in one mode: its equations can be written down.

use gyroflex::dynamics::{
    External, FlexibleBody, FlexibleMode, FlexibleScratch, Forward, State, flexible_aba, flexible_energy,
};
use gyroflex::model::{
    AssumedMode, Body, BodySpec, Fidelity, FlexibleLink, FlexibleModel, FlexibleRecords, Friction, JointKind, ModePair,
    RobotSpec, Seat,
};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};

/// Beam along x, hinged about z, bending along y by `φ(x) = x²`: unit mass per length and unit length.
const MASS: f64 = 1.0 / 5.0; // ∫ φ²
const COUPLING: f64 = 1.0 / 4.0; // ∫ x φ
const INERTIA: f64 = 1.0 / 3.0; // ∫ x²
const STIFFNESS: f64 = 7.0;

fn with_beam<R>(use_it: impl FnOnce(&FlexibleModel<f64>) -> R) -> R {
    let at_rest = SpatialInertia {
        mass: 1.0,
        first_moment: Vec3::new(0.5, 0.0, 0.0),
        rotational: SymMat3::diagonal(0.0, INERTIA, INERTIA),
    };
    let spec = [BodySpec {
        parent: None,
        placement: Transform::identity(),
        joint: JointKind::Revolute,
        axis: Vec3::new(0.0, 0.0, 1.0),
        inertia: at_rest,
        friction: Friction::none(),
        drive: None,
    }];
    let robot = RobotSpec { bodies: &spec, spring_tables: &[], gravity: Vec3::zero() };
    let mut bodies = [Body::empty()];
    let rigid = robot.lower(Fidelity::Complete, &mut bodies, &mut []).unwrap();
    let (x, y) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0));
    let pair = ModePair {
        moments: Mat3::outer(y, y.scale(MASS)),
        stiffness: STIFFNESS,
        damping: 0.0,
        shortening: Vec3::zero(),
        shortening_moments: Mat3::zero(),
    };
    let mode = AssumedMode { momentum: y.scale(1.0 / 3.0), moments: Mat3::outer(x, y.scale(COUPLING)) };
    let records = FlexibleRecords {
        links: &mut [FlexibleLink::new(0, 1, 0, false)],
        modes: &mut [mode],
        pairs: &mut [pair],
        stations: &mut [],
        shapes: &mut [],
        shortenings: &mut [],
        seats: &mut [Seat::default()],
    };
    use_it(&records.lower(&robot, rigid).unwrap())
}

#[test]
fn a_hinged_beam_of_one_mode_obeys_its_lagrangian() {
    with_beam(|model| {
        let (eta, qd, etad, tau) = (0.3, 1.7, -0.4, 2.0);
        let state = State { q: &[0.8, eta], qd: &[qd, etad], theta: &[0.0; 2], thetad: &[0.0; 2] };
        let scratch = || {
            let records = (vec![FlexibleBody::new()], vec![FlexibleMode::new()]);
            (records.0, records.1, vec![0.0])
        };
        let (mut bodies, mut modes, mut matrix) = scratch();
        let storage = FlexibleScratch {
            bodies: &mut bodies,
            stations: &mut [],
            modes: &mut modes,
            shapes: &mut [],
            matrix: &mut matrix,
        };
        let (mut qdd, mut thetadd, mut tau_j) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        flexible_aba(model, state, &[tau, 0.0], External::none(), storage, out).unwrap();

        // (J + m η²) q̈ + P η̈ + 2 m η η̇ q̇ = τ,   P q̈ + m η̈ − m q̇² η + K η = 0
        let (a, b, d) = (INERTIA + MASS * eta * eta, COUPLING, MASS);
        let right = [tau - 2.0 * MASS * eta * etad * qd, (MASS * qd * qd - STIFFNESS) * eta];
        let determinant = a * d - b * b;
        let expected = [(d * right[0] - b * right[1]) / determinant, (a * right[1] - b * right[0]) / determinant];
        for (found, expected) in qdd.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-11 * expected.abs(), "{found} {expected}");
        }

        let storage = FlexibleScratch {
            bodies: &mut bodies,
            stations: &mut [],
            modes: &mut modes,
            shapes: &mut [],
            matrix: &mut matrix,
        };
        let energy = flexible_energy(model, state, storage).unwrap();
        let kinetic = 0.5 * (a * qd * qd + d * etad * etad) + b * qd * etad;
        assert!((energy.kinetic - kinetic).abs() < 1e-12);
        assert!((energy.elastic - 0.5 * STIFFNESS * eta * eta).abs() < 1e-12);
    });
}
