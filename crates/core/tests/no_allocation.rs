//! Nothing in the core allocates: a counting allocator watches every algorithm.

mod common;
use common::{Lowered, drive, elastic, link};
use gyroflex::Jet;
use gyroflex::control::reference::*;
use gyroflex::control::*;
use gyroflex::control::{FeedbackLinearization, LinearizationScratch, Motors, Pd, TwoDof, TwoDofScratch};
use gyroflex::dynamics::*;
use gyroflex::integrate::*;
use gyroflex::model::*;
use gyroflex::spatial::{Mat3, Motion, SpatialInertia, Transform, Vec3};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;

thread_local! {
    // Per thread, so that the test harness's own threads do not count.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is forwarded unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|n| n.set(n.get() + 1));
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(work: impl FnOnce()) -> usize {
    let before = ALLOCATIONS.with(Cell::get);
    work();
    ALLOCATIONS.with(Cell::get) - before
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![1u8; 100]))), 1);
}

/// Floating, with an elastic joint and a rotor that needs the joint-space route.
fn robot() -> Lowered {
    let root = BodySpec { joint: JointKind::Floating, ..link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]) };
    let mut elbow = link(Some(0), [0.0, 1.0, 0.0], [0.3, 0.0, 0.0], [0.1, 0.0, 0.0]);
    elbow.drive = Some(drive(Some(0), [0.0, 1.0, 0.0], 80.0, elastic(800.0, 1.0)));
    elbow.friction = Friction::coulomb(0.1, 0.2, 0.01).with_stribeck(0.1, 0.2);
    let mut wrist = link(Some(1), [1.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.1, 0.0, 0.0]);
    // Away from the joint's parent: the joint-space route.
    wrist.drive = Some(drive(Some(0), [0.0, 0.0, 1.0], 50.0, TransmissionSpec::Rigid));
    Lowered::new(&[root, elbow, wrist], [0.0, 0.0, -9.81], Fidelity::Complete)
}

const POSITIONS: [f64; 9] = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.2, -0.4];

#[test]
fn no_algorithm_allocates() {
    let robot = robot();
    let model = robot.model();
    assert!(model.has_remote_rigid_rotor());

    let mut q = POSITIONS.to_vec();
    let (mut qd, mut theta, mut thetad) = (vec![0.1; 8], vec![0.2; 8], vec![0.1; 8]);
    let (tau, mut qdd, mut thetadd, mut tau_j) = (vec![0.3; 8], vec![0.0; 8], vec![0.0; 8], vec![0.0; 8]);
    let mut aba_scratch = vec![AbaScratch::new(); 3];
    let mut rnea_scratch = vec![RneaScratch::new(); 3];
    let mut crba_scratch = vec![CrbaScratch::new(); 3];
    let mut moving = vec![(Transform::identity(), Motion::zero()); 3];
    let mut joint_space = vec![JointSpaceScratch::new(); joint_space_len(&model)];
    let (mut m, mut matrix) = (vec![0.0; 64], vec![0.0; matrix_len(&model)]);
    let mut work = vec![0.0; rk4_len(&model).max(euler_len(&model))];

    let count = allocations(|| {
        let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
        let ext = External::none();
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        aba(&model, state, &tau, ext, &mut aba_scratch, out).unwrap();
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        let scratch = ForwardScratch { bodies: &mut aba_scratch, joint_space: &mut joint_space, matrix: &mut matrix };
        forward_dynamics(&model, state, &tau, ext, scratch, out).unwrap();
        let accel = Acceleration { qdd: &tau, thetadd: &tau };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut thetadd };
        rnea(&model, state, accel, ext, &mut rnea_scratch, out).unwrap();
        crba(&model, &q, &mut crba_scratch, &mut m).unwrap();
        coupling(&model, &q, &mut crba_scratch, &mut m).unwrap();
        energy(&model, state, &mut moving).unwrap();
        power(&model, state, &tau, ext, &mut moving).unwrap();
        for _ in 0..3 {
            let state = StateMut { q: &mut q, qd: &mut qd, theta: &mut theta, thetad: &mut thetad };
            let scratch =
                ForwardScratch { bodies: &mut aba_scratch, joint_space: &mut joint_space, matrix: &mut matrix };
            let n = rk4_len(&model);
            rk4(&model, state, &tau, ext, 1e-4, scratch, &mut work[..n]).unwrap();
            let state = StateMut { q: &mut q, qd: &mut qd, theta: &mut theta, thetad: &mut thetad };
            let scratch =
                ForwardScratch { bodies: &mut aba_scratch, joint_space: &mut joint_space, matrix: &mut matrix };
            let n = euler_len(&model);
            semi_implicit_euler(&model, state, &tau, ext, 1e-4, scratch, &mut work[..n]).unwrap();
        }
    });
    assert_eq!(count, 0);
    assert!(q.iter().chain(&qd).all(|x: &f64| x.is_finite()));
}

#[test]
fn no_algorithm_of_flexible_links_allocates() {
    // A beam along x that bends along y, and a joint with an elastic transmission at its end.
    let mut elbow = link(Some(0), [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.1, 0.0, 0.0]);
    elbow.drive = Some(drive(Some(0), [0.0, 0.0, 1.0], 80.0, elastic(800.0, 1.0)));
    let specs = [link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.5, 0.0, 0.0]), elbow];
    let robot = Lowered::new(&specs, [0.0, -9.81, 0.0], Fidelity::Complete);
    let (x, y) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0));
    let mut links = [FlexibleLink::new(0, 1, 1, true)];
    let mut modes = [gyroflex::model::AssumedMode { momentum: y.scale(0.3), moments: Mat3::outer(x, y.scale(0.25)) }];
    let mut pairs = [ModePair {
        moments: Mat3::outer(y, y.scale(0.2)),
        stiffness: 7.0,
        damping: 0.1,
        shortening: x.scale(-0.3),
        shortening_moments: Mat3::outer(x, x.scale(-0.25)),
    }];
    let mut stations = [Station::new(x, SpatialInertia::zero())];
    let mut shapes = [StationShape { displacement: y, rotation: Vec3::new(0.0, 0.0, 2.0) }];
    let mut shortenings = [x.scale(-4.0 / 3.0)];
    let mut seats = [Seat::default(), Seat { parent: Some(0), rotor: Some(0), link: None }];
    let spec = RobotSpec { bodies: &specs, spring_tables: &[], gravity: robot.gravity };
    let mut bodies = [FlexibleBody::new(); 2];
    let mut storage = ([FlexibleStation::new()], [FlexibleMode::new()], [Motion::zero()], [0.0]);
    let (q, qd, tau) = ([0.2, -0.4, 0.05], [0.5; 3], [0.3; 3]);
    let [mut a, mut b, mut c] = [[0.0; 3]; 3];
    let ([mut mass, mut coupling], mut etadd) = ([[0.0; 9]; 2], [0.0]);
    let (mut poses, mut at_stations) = ([Transform::identity(); 2], [Transform::identity()]);

    let count = allocations(|| {
        let model = FlexibleRecords {
            links: &mut links,
            modes: &mut modes,
            pairs: &mut pairs,
            stations: &mut stations,
            shapes: &mut shapes,
            shortenings: &mut shortenings,
            seats: &mut seats,
        }
        .lower(&spec, robot.model())
        .unwrap();
        let (state, ext) = (State { q: &q, qd: &qd, theta: &tau, thetad: &tau }, External::none());
        let accel = Acceleration { qdd: &tau, thetadd: &tau };
        for which in 0..7 {
            let scratch = FlexibleScratch {
                bodies: &mut bodies,
                stations: &mut storage.0,
                modes: &mut storage.1,
                shapes: &mut storage.2,
                matrix: &mut storage.3,
            };
            match which {
                0 => flexible_rnea(&model, state, accel, ext, scratch, Inverse { tau_j: &mut a, tau: &mut b }).unwrap(),
                1 => {
                    let out = Inverse { tau_j: &mut a, tau: &mut b };
                    flexible_hybrid(&model, state, accel, ext, scratch, out, &mut etadd).unwrap();
                }
                2 => {
                    let out = FlexibleMatrices { mass: &mut mass, coupling: &mut coupling };
                    flexible_mass_matrix(&model, &q, scratch, out).unwrap();
                }
                3 => {
                    flexible_energy(&model, state, scratch).unwrap();
                }
                4 => {
                    flexible_power(&model, state, &tau, ext, scratch).unwrap();
                }
                5 => {
                    let out = FlexiblePlacements { links: &mut poses, stations: &mut at_stations };
                    flexible_placements(&model, &q, scratch, out).unwrap();
                }
                _ => {
                    let out = Forward { qdd: &mut a, thetadd: &mut b, tau_j: &mut c };
                    flexible_aba(&model, state, &tau, ext, scratch, out).unwrap();
                }
            }
        }
    });
    assert_eq!(count, 0);
    let all = a.iter().chain(&b).chain(&c).chain(&mass).chain(&etadd);
    assert!(all.copied().all(|x: f64| x.is_finite() && x != 0.0));
}

#[test]
fn neither_the_elastic_inverse_nor_its_controllers_allocate() {
    const NV: usize = 3;
    let mut bodies = [
        link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.1, 0.0, 0.0]),
        link(Some(0), [0.0, 1.0, 0.0], [0.3, 0.0, 0.0], [0.1, 0.0, 0.0]),
        link(Some(1), [1.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.1, 0.05, 0.0]),
    ];
    let error = TransmissionError { amplitude: 1e-4, cycles_per_rotor_turn: 2.0, phase: 0.3 };
    let curved = |spring| TransmissionSpec::Elastic { spring, damping: 2.0, error };
    let springs = [
        elastic(900.0, 2.0),
        curved(SpringSpec::Polynomial { stiffness: 900.0, cubic: 1e5 }),
        curved(SpringSpec::Table { first: 0, len: 3 }),
    ];
    for (i, (body, spring)) in bodies.iter_mut().zip(springs).enumerate() {
        body.friction = Friction::coulomb(0.1, 0.2, 0.5);
        body.drive = Some(drive(i.checked_sub(1), [0.6, 0.0, 0.8], 80.0, spring));
    }
    let table = [[0.0, 0.0], [0.01, 10.0], [0.02, 25.0]];
    let lowered = |fidelity| Lowered::with_tables(&bodies, &table, [0.0, 0.0, -9.81], fidelity);
    let (complete, reduced) = (lowered(Fidelity::Complete), lowered(Fidelity::Reduced));

    let (mut orders, mut reduced_orders) = ([JointOrders::default(); NV], [JointOrders::default(); NV]);
    let mut derivative = [DerivativeScratch::new(); NV];
    let mut numbers = vec![0.0; smoothness_len(&complete.model())];
    let mut contains = [Contains::default(); NV * NV];
    let mut series = vec![ElasticInverseScratch::new(); (NV + 1) * MAX_COEFFICIENTS];
    let (q, derivatives, gains) = ([0.1, -0.2, 0.3], [0.4; 20 * NV], [2.0; NV]);
    let (mut deflection, mut theta, mut tau_j, mut tau, mut rates) =
        ([1e-3; NV], [0.0; 3 * NV], [0.0; NV], [0.0; NV], [0.0; 2 * NV]);
    let (mut jets, mut aba_jets) = ([Jet([0.0; 2]); 8 * NV], [AbaScratch::new(); NV]);
    let mut work = [0.0; 11 * NV];

    let count = allocations(|| {
        for (robot, orders) in [(&complete, &mut orders), (&reduced, &mut reduced_orders)] {
            let scratch = SmoothnessScratch { bodies: &mut derivative, numbers: &mut numbers, contains: &mut contains };
            required_smoothness(&robot.model(), 0, VANISHING, scratch, orders).unwrap();
        }
        let smoothness = Smoothness { joints: &orders, torque_derivatives: 0 };
        let length = elastic_inverse_len(&complete.model(), &smoothness).unwrap();
        let mut law = TwoDof {
            model: complete.model(),
            smoothness,
            feedback: Pd { kp: &gains, kd: &gains },
            deflection: &mut deflection,
        };
        let scratch =
            TwoDofScratch { series: &mut series[..length], theta: &mut theta, tau_j: &mut tau_j, rates: &mut rates };
        let motion = JointMotion { q: &q, derivatives: &derivatives };
        let motors = Motors { theta: &q, thetad: &gains };
        law.tick::<MAX_COEFFICIENTS>(motion, motors, 1e-3, scratch, &mut tau).unwrap();

        let smoothness = Smoothness { joints: &reduced_orders, torque_derivatives: 0 };
        let length = elastic_inverse_len(&reduced.model(), &smoothness).unwrap();
        let law = FeedbackLinearization { model: reduced.model(), smoothness, bandwidth: &gains };
        let scratch = LinearizationScratch {
            bodies: &mut aba_jets,
            series: &mut series[..length],
            jets: &mut jets,
            numbers: &mut work,
        };
        let state = State { q: &q, qd: &gains, theta: &q, thetad: &gains };
        law.torque(&derivatives[..4 * NV], state, scratch, &mut tau).unwrap();
    });
    assert_eq!(count, 0);
    assert!(tau.iter().chain(&theta).all(|x: &f64| x.is_finite()));
}

#[test]
fn neither_derivatives_nor_matrices_allocate() {
    const NV: usize = 8;
    let robot = robot();
    let model = robot.model();
    let (qd, theta, thetad, tau) = ([0.1; NV], [0.2; NV], [0.1; NV], [0.3; NV]);
    let mut scratch = vec![DerivativeScratch::new(); 3];
    let mut matrix = vec![0.0; derivative_matrix_len(&model).max(operational_len(&model, 6))];
    let [mut a, mut b, mut c] = [[0.0; NV]; 3];
    let [mut d, mut e] = [(); 2].map(|()| vec![0.0; 6 * NV * NV]);
    let [mut x, mut y, mut z] = [(); 3].map(|()| vec![0.0; NV * PARAMETERS * 3]);
    let (mut inertia, mut parameter) = ([0.0; 36], vec![0.0; PARAMETERS * 3]);

    let count = allocations(|| {
        let state = State { q: &POSITIONS, qd: &qd, theta: &theta, thetad: &thetad };
        let (ext, accel) = (External::none(), Acceleration { qdd: &tau, thetadd: &tau });
        let work = &mut matrix[..derivative_matrix_len(&model)];
        let value = Forward { qdd: &mut a, thetadd: &mut b, tau_j: &mut c };
        let out = ForwardDerivatives { qdd: &mut d[..5 * NV * NV], thetadd: &mut e[..5 * NV * NV] };
        forward_derivatives(&model, state, &tau, ext, &mut scratch, work, value, out).unwrap();
        let out = InverseDerivatives { tau_j: &mut d, tau: &mut e };
        inverse_derivatives(&model, state, accel, ext, &mut scratch, out).unwrap();

        let [x, y, z] = [&mut x, &mut y, &mut z].map(Vec::as_mut_slice);
        let square = NV * NV;
        let out = CoriolisMatrices { c: &mut x[..square], c1: &mut y[..square], c2: &mut z[..square] };
        coriolis_matrices(&model, state, &mut scratch, out).unwrap();
        let out = InertiaRates { m: &mut x[..square], s: &mut y[..square] };
        inertia_rates(&model, state, &mut scratch, out).unwrap();
        bias(&model, state, &mut scratch, Bias { link: &mut a, motor: &mut b }).unwrap();
        gravity_torques(&model, &POSITIONS, &mut scratch, &mut c).unwrap();
        regressor(&model, state, accel, &mut scratch, Regressor { link: x, transmission: y, motor: z }).unwrap();
        parameters(&model, &mut parameter).unwrap();

        let frame = Frame { body: 2, placement: Transform::identity() };
        let task = Task { frame, directions: &[0, 1, 2, 3, 4, 5], rotation: Rotation::Geometric, threshold: 1e-6 };
        let out = OperationalSpace {
            jacobian: &mut x[..6 * NV],
            bias_acceleration: &mut a[..6],
            inertia: &mut inertia,
            inverse: &mut y[..6 * NV],
            velocity_force: &mut b[..6],
            gravity_force: &mut c[..6],
        };
        let work = &mut matrix[..operational_len(&model, 6)];
        operational_space(&model, state, task, &mut scratch, work, out).unwrap();
    });
    assert_eq!(count, 0);
    assert!(d.iter().chain(&e).chain(&y).chain(&inertia).all(|x: &f64| x.is_finite()));
}

#[test]
fn neither_references_nor_filters_nor_shapers_allocate() {
    let mut memory = [0.0; 1000];
    let [mut sum, mut out] = [[0.0; 12]; 2];
    let count = allocations(|| {
        let sine = [Sine { amplitude: 0.4, frequency: 1.2, phase: 0.1 }];
        let steps = [Step { time: 0.1, to: 1.0 }];
        let polynomial = PointToPoint::new(0.0, 1.0, 0.0, 1.0, 6).unwrap();
        let minimum_time = MinimumTime::<_, 6>::new(0.0, 1.0, 0.0, &[1.0, 4.0, 30.0, 500.0]).unwrap();
        let shaper = Shaper::<_, 9>::new(ShaperKind::Zvd, Mode { frequency: 3.0, damping_ratio: 0.02 }).unwrap();
        let shaper =
            shaper.and(ShaperKind::Ei { tolerance: 0.05 }, Mode { frequency: 8.0, damping_ratio: 0.0 }).unwrap();
        let references: [&dyn Reference<f64>; 6] = [
            &Sines { offset: 0.2, terms: &sine },
            &polynomial,
            &minimum_time,
            &Piecewise::new(&[0.0, 1.0], &[0.0, 1.0, 2.0], Some(2)).unwrap(),
            &FilteredStep::new(0.0, &steps, 8, 5.0).unwrap(),
            &Shaped { reference: &polynomial, shaper: &shaper },
        ];
        for reference in references {
            reference.derivatives(0.4, &mut out);
            out.iter().zip(&mut sum).for_each(|(x, sum)| *sum += x);
        }
        let mut filter = LowPass::<_, 8>::new(5.0, 0.0).unwrap();
        let mut online = OnlineShaper::new(&shaper, 1e-3, 0.0, &mut memory).unwrap();
        for _ in 0..100 {
            filter.advance(online.shape(1.0), 1e-3);
            filter.derivatives(1.0, &mut out);
        }
    });
    assert_eq!(count, 0);
    assert!(sum.iter().chain(&out).all(|x| x.is_finite() && *x != 0.0));
}

#[test]
fn constrained_dynamics_do_not_allocate() {
    // One robot by the articulated-body route, one by the inertia matrix.
    let plain = [
        link(None, [0.0, 1.0, 0.0], [0.0; 3], [0.1, 0.0, 0.0]),
        link(Some(0), [0.0, 1.0, 0.0], [0.3, 0.0, 0.0], [0.1, 0.0, 0.0]),
        link(Some(1), [0.0, 1.0, 0.0], [0.3, 0.0, 0.0], [0.1, 0.0, 0.0]),
    ];
    held(&Lowered::new(&plain, [0.0, 0.0, -9.81], Fidelity::Complete));
    held(&robot());
}

fn held(robot: &Lowered) {
    let model = robot.model();
    let (nv, bodies) = (model.nv(), model.bodies().len());
    let q = if model.is_floating() { POSITIONS.to_vec() } else { vec![0.4; 3] };
    let (rates, mut a, mut b, mut c) = (vec![0.1; nv], vec![0.0; nv], vec![0.0; nv], vec![0.0; nv]);
    let foot = Frame { body: 2, placement: Transform::identity() };
    let anchor = Anchor { body: None, placement: Transform::identity() };
    let hold = Hold::Frame { frame: foot, anchor, directions: Directions::PLANAR_POINT };
    let contact = Some(Contact { normal: 5, restitution: 0.2, slip: None });
    let constraints = [Constraint { hold, stabilisation: 10.0, contact }];
    let rows = constraint_rows(&constraints);
    let passive = [0];
    let mut aba_scratch = vec![AbaScratch::new(); bodies];
    let mut rnea_scratch = vec![RneaScratch::new(); bodies];
    let mut supports = vec![SupportScratch::new(); bodies];
    let mut kept = vec![ConstraintScratch::new(); 1];
    let mut propagated = vec![PropagatedScratch::new(); propagated_len(&model, &constraints)];
    let mut matrix = vec![0.0; constraint_matrix_len(&constraints)];
    let mut inverse_matrix = vec![0.0; constrained_inverse_len(&model, &constraints, passive.len())];
    let mut joint_space = vec![JointSpaceScratch::new(); joint_space_len(&model)];
    let mut joint_matrix = vec![0.0; constrained_joint_matrix_len(&model, &constraints)];
    let (mut multipliers, mut wrenches) = (vec![0.0; rows], vec![gyroflex::spatial::Force::zero(); 1]);
    let regularisation = Regularisation::rank_revealing(1e-9);
    let count = allocations(|| {
        let state = State { q: &q, qd: &rates, theta: &rates, thetad: &rates };
        for turn in 0..2 {
            let scratch = ConstrainedScratch {
                bodies: &mut aba_scratch,
                supports: &mut supports,
                constraints: &mut kept,
                propagated: &mut propagated,
                matrix: &mut matrix,
                joint_space: &mut joint_space,
                joint_matrix: &mut joint_matrix,
            };
            let forces = Constrained { multipliers: &mut multipliers, wrenches: &mut wrenches };
            if turn == 0 {
                let out = Forward { qdd: &mut a, thetadd: &mut b, tau_j: &mut c };
                constrained_forward_dynamics(
                    &model,
                    state,
                    &rates,
                    External::none(),
                    &constraints,
                    regularisation,
                    scratch,
                    out,
                    forces,
                )
                .unwrap();
            } else {
                let out = Impact { qd: &mut a, thetad: &mut b, gears: &mut c };
                impact(&model, state, &constraints, true, regularisation, scratch, out, forces).unwrap();
            }
        }
        let distribution =
            TorqueDistribution { torques: &rates, passive: &passive, multipliers: &[1e-6; 2], wanted: &[] };
        let accel = Acceleration { qdd: &rates, thetadd: &rates };
        constrained_inverse_dynamics(
            &model,
            state,
            accel,
            External::none(),
            &constraints,
            distribution,
            regularisation,
            &mut rnea_scratch,
            &mut supports,
            &mut inverse_matrix,
            Inverse { tau_j: &mut a, tau: &mut b },
            &mut multipliers,
        )
        .unwrap();
    });
    assert_eq!(count, 0);
    assert!(multipliers.iter().all(|x: &f64| x.is_finite()));
}

#[test]
fn the_sliding_mode_controller_does_not_allocate() {
    let (gains, ones) = ([10.0; 3], [1.0; 5]);
    let [mut integral, mut sliding] = [[0.0; 3]; 2];
    let (mut matrix, mut input) = ([0.0; 12], [0.0; 5]);
    let gain = [3.0, 1.0, 0.0, 0.0, 1.0, 0.0, 2.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 4.0, 0.0];
    let count = allocations(|| {
        let mut law = SlidingMode {
            lambda: &gains,
            steepness: &gains,
            sigma: &gains,
            eta: &ones,
            weights: &ones,
            independence: 1e-12,
            integral: &mut integral,
        };
        let plant = InputOutput { drift: &gains, gain: &gain, bias: &ones, preferred: &ones };
        let (desired, measured) = (Outputs { p: &[0.0; 3], pd: &[0.0; 3] }, Outputs { p: &[0.1; 3], pd: &[0.2; 3] });
        for _ in 0..10 {
            let scratch = SlidingScratch { sliding: &mut sliding, matrix: &mut matrix };
            law.tick(plant, desired, &gains, measured, 1e-3, scratch, &mut input).unwrap();
        }
    });
    assert_eq!(count, 0);
    assert!(input.iter().chain(&integral).chain(&sliding).all(|x: &f64| x.is_finite() && *x != 0.0));
}
