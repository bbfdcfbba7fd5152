//! A beam that turns at constant speed: frequencies against the power series of its own equation and a published table, and what
//! happens without geometric stiffening.

use gyroflex::dynamics::{
    Acceleration, External, FlexibleBody, FlexibleMode, FlexibleScratch, Inverse, State, flexible_hybrid,
};
use gyroflex::model::{Body, BodySpec, Fidelity, FlexibleLink, FlexibleRecords, Friction, JointKind, RobotSpec, Seat};
use gyroflex::spatial::{Transform, Vec3};
use gyroflex_sim::beam::{Beam, BeamMode, Boundary, Deflection, Inertia, Profile, Resistance};
use nalgebra::DMatrix;

/// Wright, Smith, Thresher, Wang, *Vibration modes of centrifugally stiffened beams*, J. Appl. Mech. 49, 1982: the first two
/// frequencies of a uniform beam flapping at hub radius zero, `ω √(m L⁴/EI)`, at the speed `Ω √(m L⁴/EI)` of the line.
const FLAPPING: [(f64, [f64; 2]); 7] = [
    (0.0, [3.5160, 22.0345]),
    (2.0, [4.1373, 22.6149]),
    (4.0, [5.5850, 24.2733]),
    (6.0, [7.3604, 26.8091]),
    (8.0, [9.2568, 29.9954]),
    (10.0, [11.2023, 33.6404]),
    (12.0, [13.1702, 37.6031]),
];

/// Squares of the frequencies of a beam of unit length, mass and stiffness on a hub that turns about z at `speed`, lowest first.
fn squares(deflection: Deflection, stiffening: bool, count: usize, speed: f64) -> Vec<f64> {
    let (one, none) = (Profile::Constant(1.0), Profile::Constant(0.0));
    let inertia = Inertia { length: 1.0, mass: &one, polar: &none };
    let shapes = inertia.eigenmodes(deflection, Boundary::ClampedFree, count).unwrap();
    let modes = shapes.into_iter().map(|(shape, lumped)| BeamMode {
        deflection,
        shape,
        resistance: Resistance::Stiffness(Profile::Constant(1.0)),
        damping_ratio: 0.0,
        lumped,
    });
    let beam = Beam {
        length: 1.0,
        mass_per_length: one.clone(),
        polar_inertia_per_length: none.clone(),
        modes: modes.collect(),
        stiffening,
    };
    let mut integrals = beam.integrals(beam.enough_points());

    let hub = [BodySpec {
        parent: None,
        placement: Transform::identity(),
        joint: JointKind::Revolute,
        axis: Vec3::new(0.0, 0.0, 1.0),
        inertia: integrals.inertia,
        friction: Friction::<f64>::none(),
        drive: None,
    }];
    let robot = RobotSpec { bodies: &hub, spring_tables: &[], gravity: Vec3::zero() };
    let mut bodies = [Body::empty()];
    let rigid = robot.lower(Fidelity::Complete, &mut bodies, &mut []).unwrap();
    let records = FlexibleRecords {
        links: &mut [FlexibleLink::new(0, count as u16, 0, stiffening)],
        modes: &mut integrals.modes,
        pairs: &mut integrals.pairs,
        stations: &mut [],
        shapes: &mut [],
        shortenings: &mut [],
        seats: &mut [Seat::default()],
    };
    let model = records.lower(&robot, rigid).unwrap();

    // η̈ = −K η about the straight beam, whose bending is an even problem.
    let step = 1e-6;
    let accelerations = |mode: usize, sign: f64| {
        let mut q = vec![0.0; 1 + count];
        let mut qd = q.clone();
        (q[1 + mode], qd[0]) = (sign * step, speed);
        let zero = vec![0.0; 1 + count];
        let (mut tau_j, mut tau, mut etadd) = (zero.clone(), zero.clone(), vec![0.0; count]);
        let scratch = FlexibleScratch {
            bodies: &mut [FlexibleBody::new()],
            stations: &mut [],
            modes: &mut vec![FlexibleMode::new(); count],
            shapes: &mut [],
            matrix: &mut vec![0.0; count * count],
        };
        let state = State { q: &q, qd: &qd, theta: &zero, thetad: &zero };
        let accel = Acceleration { qdd: &zero, thetadd: &zero };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
        flexible_hybrid(&model, state, accel, External::none(), scratch, out, &mut etadd).unwrap();
        etadd
    };
    let columns: Vec<[Vec<f64>; 2]> = (0..count).map(|j| [accelerations(j, 1.0), accelerations(j, -1.0)]).collect();
    let matrix = DMatrix::from_fn(count, count, |i, j| (columns[j][1][i] - columns[j][0][i]) / (2.0 * step));
    let mut squares: Vec<f64> = matrix.complex_eigenvalues().iter().map(|z| z.re).collect();
    squares.sort_by(f64::total_cmp);
    squares
}

/// The first frequencies of flapping from the equation of the beam itself, `w'''' − (T w')' = ω² w` under the pull
/// `T = ½ Ω² (1 − x²)`, clamped at 0 and free at 1: where the determinant of the conditions at the tip changes sign.
fn of_the_continuous_beam(speed: f64) -> [f64; 2] {
    // w = Σ c_n xⁿ: (n+4)(n+3)(n+2)(n+1) c_{n+4} = ½ Ω² (n+2)(n+1) c_{n+2} + (ω² − ½ Ω² n(n+1)) c_n; it converges everywhere.
    let half = 0.5 * speed * speed;
    let tip = |first: usize, square: f64| {
        let mut c = [0.0; 160];
        c[first] = 1.0;
        for n in 0..c.len() - 4 {
            let k = n as f64;
            let pull = half * (k + 2.0) * (k + 1.0) * c[n + 2] + (square - half * k * (k + 1.0)) * c[n];
            c[n + 4] = pull / ((k + 4.0) * (k + 3.0) * (k + 2.0) * (k + 1.0));
        }
        // w'' and w''' at the tip.
        c.iter().enumerate().fold([0.0; 2], |[two, three], (n, c)| {
            let n = n as f64;
            [two + n * (n - 1.0) * c, three + n * (n - 1.0) * (n - 2.0) * c]
        })
    };
    let determinant = |omega: f64| {
        let ([a, b], [c, d]) = (tip(2, omega * omega), tip(3, omega * omega));
        a * d - b * c
    };
    let mut found = Vec::new();
    let (mut below, step) = (0.5, 0.25);
    while found.len() < 2 {
        let (mut low, mut high) = (below, below + step);
        if determinant(low) * determinant(high) < 0.0 {
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if determinant(low) * determinant(middle) <= 0.0 { high = middle } else { low = middle }
            }
            found.push(low);
        }
        below += step;
    }
    [found[0], found[1]]
}

#[test]
fn the_published_table_is_that_of_the_continuous_beam() {
    for (speed, published) in FLAPPING {
        for (found, published) in of_the_continuous_beam(speed).into_iter().zip(published) {
            // Half of the last digit printed, and a tenth of it for how it was rounded.
            assert!((found - published).abs() < 0.6e-4, "Ω = {speed}: {found}, published {published}");
        }
    }
}

#[test]
fn a_turning_beam_flaps_at_the_frequencies_of_the_continuous_one() {
    for (speed, _) in FLAPPING {
        let found = squares(Deflection::BendingZ, true, 8, speed);
        for (k, exact) in of_the_continuous_beam(speed).into_iter().enumerate() {
            // A truncated sum is too stiff, never too soft; eight modes of a beam at rest are enough for four digits.
            let found = found[k].sqrt();
            assert!(found > exact - 1e-6 * exact && found < exact + 1e-4 * exact, "Ω = {speed}: {found} for {exact}");
        }
    }
}

#[test]
fn a_turning_beam_flaps_at_the_published_frequencies() {
    for (speed, published) in FLAPPING {
        let found = squares(Deflection::BendingZ, true, 8, speed);
        for (k, published) in published.into_iter().enumerate() {
            let found = found[k].sqrt();
            // Half of the last digit printed, and what eight modes of a beam at rest lack, from above.
            assert!(
                (found - published).abs() < 2e-4 * published,
                "Ω = {speed}, mode {}: {found} for {published}",
                k + 1
            );
        }
    }
}

#[test]
fn in_the_plane_of_rotation_the_square_is_less_by_that_of_the_speed() {
    for (speed, _) in FLAPPING {
        let (flap, lag) =
            (squares(Deflection::BendingZ, true, 5, speed), squares(Deflection::BendingY, true, 5, speed));
        for (flap, lag) in flap.into_iter().zip(lag) {
            assert!((flap - speed * speed - lag).abs() < 1e-5 * flap, "Ω = {speed}: {flap} {lag}");
        }
    }
}

#[test]
fn without_stiffening_flapping_ignores_the_speed_and_lagging_buckles() {
    let at_rest = 3.516015_f64.powi(2);
    for speed in [0.0, 2.0, 3.5, 3.6, 12.0] {
        let flap = squares(Deflection::BendingZ, false, 4, speed)[0];
        assert!((flap - at_rest).abs() < 1e-4, "{flap}");
        // ω² = ω₀² − Ω²: beyond Ω = 3.52 the straight beam is unstable, which no real one is.
        let lag = squares(Deflection::BendingY, false, 4, speed)[0];
        assert!((lag - (at_rest - speed * speed)).abs() < 1e-3, "{lag}");
    }
    assert!(squares(Deflection::BendingY, false, 4, 3.6)[0] < 0.0);
    assert!(squares(Deflection::BendingY, true, 4, 3.6)[0] > 0.0);
}
