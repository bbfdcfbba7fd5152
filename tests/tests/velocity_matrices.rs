//! Matrices and forces that depend on velocity, and gravity: against derivatives of the energies, and against each other.

use gyroflex::Scalar;
use gyroflex::dynamics::{CrbaScratch, coupling, crba};
use gyroflex::integrate::position_rate;
use gyroflex::model::{Fidelity, TransmissionSpec};
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, norm, tol};
use gyroflex_testkit::{Dual, State};
use gyroflex_tests::{Core, Trial, for_trials, small};
use nalgebra::{DMatrix, DVector, Vector3};

/// What vanishes is zero but for the rounding of what it is the sum of: this part of its size.
const ROUNDING: f64 = 1e-2;

/// `[a, b; c, d]` of blocks by rows.
fn whole(nv: usize, blocks: [&[f64]; 4]) -> DMatrix<f64> {
    DMatrix::from_fn(2 * nv, 2 * nv, |i, j| blocks[2 * (i / nv) + j / nv][(i % nv) * nv + j % nv])
}

fn transposed(nv: usize, a: &[f64]) -> Vec<f64> {
    (0..nv * nv).map(|i| a[(i % nv) * nv + i / nv]).collect()
}

/// The core's Coriolis matrix in `x = (q, θ)`.
fn coriolis<T: Real>(t: &Trial<'_, T>, s: &State) -> DMatrix<f64> {
    let nv = t.robot.nv();
    let blocks = t.core.coriolis(s);
    whole(nv, [&blocks.c, &blocks.c1, &blocks.c2, &vec![0.0; nv * nv]])
}

/// The core's inertia matrix in `x = (q, θ)`.
fn inertia<T: Real>(t: &Trial<'_, T>) -> DMatrix<f64> {
    let nv = t.robot.nv();
    let (m, s) = (t.core.mass_matrix(&t.state), t.core.coupling(&t.state));
    let motors = DMatrix::from_diagonal(&DVector::from_vec(t.core.reflected_inertia()));
    whole(nv, [&m, &s, &transposed(nv, &s), motors.as_slice()])
}

/// Sizes of what the blocks of rates are sums of: links, links by motors (which may vanish beside the rotors it stems from), motors.
fn sizes(m: &DMatrix<f64>, xd: &DVector<f64>) -> [f64; 3] {
    let nv = xd.len() / 2;
    let [links, coupling, motors] = [(0, 0), (0, nv), (nv, nv)].map(|at| m.view(at, (nv, nv)).amax() * xd.amax());
    // N J = B / N, and no random gear has a ratio above 200.
    [links, coupling.max(motors / 200.0), motors]
}

/// Links by links, links by motors, motors by links, motors by motors.
fn assert_blocks_close<T: Real>(
    t: &Trial<'_, T>,
    what: &str,
    got: &DMatrix<f64>,
    want: &DMatrix<f64>,
    [links, coupling, motors]: [f64; 3],
) {
    let nv = t.robot.nv();
    for (name, at, size) in [
        ("links", (0, 0), links),
        ("links by motors", (0, nv), coupling),
        ("motors by links", (nv, 0), coupling),
        ("motors", (nv, nv), motors),
    ] {
        let block = |a: &DMatrix<f64>| a.view(at, (nv, nv)).into_owned();
        t.assert_close(&format!("{what}, {name}"), block(got).as_slice(), block(want).as_slice(), ROUNDING * size);
    }
}

/// `Ṁ` of the core in `x = (q, θ)`.
fn inertia_rate<T: Real>(t: &Trial<'_, T>) -> DMatrix<f64> {
    let nv = t.robot.nv();
    let [m, s] = t.core.inertia_rates(&t.state);
    whole(nv, [&m, &s, &transposed(nv, &s), &vec![0.0; nv * nv]])
}

fn equal_derivatives_of_energies<T: Real>(t: &Trial<'_, T>) {
    let (oracle, s) = (t.energies(), &t.state);
    let (m, xd) = (oracle.inertia(s), oracle.velocity(s));
    let still = DVector::from_element(xd.len(), 1.0);
    assert_blocks_close(t, "M", &inertia(t), &m, sizes(&m, &still));
    assert_blocks_close(t, "C", &coriolis(t, s), &oracle.coriolis(s), sizes(&m, &xd));
    assert_blocks_close(t, "dM/dt", &inertia_rate(t), &oracle.inertia_rate(s), sizes(&m, &xd));
    t.assert_close("g", &t.core.gravity(s), oracle.gravity(s).as_slice(), ROUNDING * sizes(&m, &still)[0]);
}

#[test]
fn matrices_equal_derivatives_of_the_energies() {
    let few = Options { bodies: 1..=10, ..Options::default() };
    for_trials::<f64>(1000, &few, &Fidelity::ALL, tol(1e-10, 0.0), equal_derivatives_of_energies);
    let many = Options { bodies: 20..=30, ..Options::default() };
    for_trials::<f64>(5, &many, &Fidelity::ALL, tol(1e-10, 0.0), equal_derivatives_of_energies);
}

#[test]
fn matrices_in_single_precision() {
    for_trials::<f32>(300, &small(), &Fidelity::ALL, tol(0.0, 1e-4), equal_derivatives_of_energies);
}

/// `Ṁ` in `x = (q, θ)`: the core's inertia matrix and coupling at positions that move.
fn differentiated_inertia<T: Real>(t: &Trial<'_, T>) -> DMatrix<f64> {
    let (s, core) = (&t.state, Core::<f64>::new(&t.robot.spec(), t.fidelity));
    let (model, nv) = (core.model(), t.robot.nv());
    let mut rate = vec![f64::NAN; s.q.len()];
    position_rate(&model, &s.q, &s.qd, &mut rate).expect("slices fit");
    let q: Vec<Dual> = s.q.iter().zip(rate).map(|(q, rate)| Dual::new(*q, rate)).collect();
    let mut scratch = vec![CrbaScratch::new(); model.bodies().len()];
    let [mut m, mut coupled] = [(); 2].map(|()| vec![Dual::from_f64(f64::NAN); nv * nv]);
    crba(&model, &q, &mut scratch, &mut m).expect("slices fit");
    coupling(&model, &q, &mut scratch, &mut coupled).expect("slices fit");
    let [m, coupled] = [m, coupled].map(|a| a.iter().map(|x| x.slope).collect::<Vec<f64>>());
    whole(nv, [&m, &coupled, &transposed(nv, &coupled), &vec![0.0; nv * nv]])
}

/// Coriolis forces do no work: `xᵀ (Ṁ − 2C) x = 0`, whatever `x`, because `Ṁ = C + Cᵀ`.
fn rate_of_inertia_is_twice_the_symmetric_part<T: Real>(t: &Trial<'_, T>) {
    let (oracle, s) = (t.energies(), &t.state);
    let (m, xd) = (oracle.inertia(s), oracle.velocity(s));
    let (c, rate) = (coriolis(t, s), differentiated_inertia(t));
    assert_blocks_close(t, "C + Cᵀ", &(&c + c.transpose()), &rate, sizes(&m, &xd));
    assert_blocks_close(t, "inertia_rates", &inertia_rate(t), &rate, sizes(&m, &xd));

    let x = oracle.velocity(&State { qd: s.qdd.clone(), thetad: s.thetadd.clone(), ..s.clone() });
    let form = |a: &DMatrix<f64>| x.dot(&(a * &x));
    t.assert_close("xᵀ 2C x", &[2.0 * form(&c)], &[form(&rate)], ROUNDING * form(&m) * xd.amax());
}

#[test]
fn rate_of_inertia_less_twice_the_coriolis_matrix_is_skew() {
    let floating = Options { bodies: 1..=10, floating: 0.5, ..Options::default() };
    let law = rate_of_inertia_is_twice_the_symmetric_part;
    for_trials::<f64>(500, &floating, &Fidelity::ALL, tol(1e-11, 0.0), law);
    for_trials::<f32>(100, &small(), &Fidelity::ALL, tol(0.0, 1e-4), rate_of_inertia_is_twice_the_symmetric_part);
}

/// Of all matrices with the law above this is the one of Christoffel symbols: `C(u) w = C(w) u`, and for a floating root, whose
/// motions do not commute, `C(u) w − C(w) u = M [u, w]`.
fn velocities_may_change_places<T: Real>(t: &Trial<'_, T>) {
    let (s, nv) = (&t.state, t.robot.nv());
    let other = State { qd: s.thetadd.clone(), thetad: s.qdd.clone(), ..s.clone() };
    let oracle = t.energies();
    let (u, w) = (oracle.velocity(s), oracle.velocity(&other));
    let m = oracle.inertia(s);
    let got = coriolis(t, s) * &w - coriolis(t, &other) * &u;
    let terms = sizes(&m, &u).map(|size| size * w.amax());
    let want = m * oracle.bracket(&u, &w);
    for (name, rows, size) in [("links", 0..nv, terms[0].max(terms[1])), ("motors", nv..2 * nv, terms[1])] {
        let part = |x: &DVector<f64>| x.as_slice()[rows.clone()].to_vec();
        t.assert_close(&format!("C(u) w − C(w) u, {name}"), &part(&got), &part(&want), ROUNDING * size);
    }
}

#[test]
fn two_velocities_change_places() {
    for_trials::<f64>(500, &Options::default(), &Fidelity::ALL, tol(1e-11, 0.0), velocities_may_change_places);
    for_trials::<f32>(100, &small(), &Fidelity::ALL, tol(0.0, 1e-4), velocities_may_change_places);
}

/// `C q̇ + C₁ θ̇ + g` and `C₂ q̇` are the `bias`, and what inverse dynamics asks for without acceleration.
fn bias_is_inverse_dynamics_without_acceleration<T: Real>(t: &Trial<'_, T>) {
    let nv = t.robot.nv();
    let zero = vec![0.0; nv];
    let s = State {
        qdd: zero.clone(),
        thetadd: zero.clone(),
        tau_ext: Vec::new(),
        wrenches: Vec::new(),
        ..t.state.clone()
    };
    let product = coriolis(t, &s) * t.energies().velocity(&s);
    let g = t.core.gravity(&s);
    let of_links: Vec<f64> = (0..nv).map(|i| product[i] + g[i]).collect();
    let torque = t.core.inverse(&s);
    let model = t.core.model();
    let elastic: Vec<bool> = model.bodies().iter().flat_map(|b| vec![b.is_elastic(); b.joint.nv()]).collect();
    let passed = t.oracle().passed_by_transmissions(&s);
    let link: Vec<f64> = (0..nv).map(|i| if elastic[i] { torque.tau_j[i] } else { torque.tau[i] }).collect();
    let motor: Vec<f64> =
        (0..nv).map(|i| if elastic[i] { torque.tau[i] - passed[i] * torque.tau_j[i] } else { 0.0 }).collect();
    let [bias_link, bias_motor] = t.core.bias(&s);
    let size = norm(&link).max(norm(&g)).max(norm(&product.as_slice()[..nv]));
    t.assert_close("bias and inverse dynamics, links", &bias_link, &link, size);
    t.assert_close("C q̇ + C₁ θ̇ + g and inverse dynamics, links", &of_links, &link, size);
    // The motor's own torque stands beside the transmission's.
    t.assert_close("bias and inverse dynamics, motors", &bias_motor, &motor, size);
    t.assert_close("C₂ q̇ and bias, motors", &product.as_slice()[nv..], &bias_motor, ROUNDING * size);
}

#[test]
fn coriolis_matrix_times_velocity_and_gravity_are_the_bias() {
    let smooth = |o: Options| Options { friction: 0.0, ..o };
    let law = bias_is_inverse_dynamics_without_acceleration;
    for_trials::<f64>(500, &smooth(Options::default()), &Fidelity::ALL, tol(1e-11, 0.0), law);
    let law = bias_is_inverse_dynamics_without_acceleration;
    for_trials::<f32>(100, &smooth(small()), &Fidelity::ALL, tol(0.0, 1e-4), law);
}

/// Zhao et al. 2015, eq. 7: in a serial arm a rotor on the parent of its joint feels the joints before it alone, and those by
/// `N J` times what each turns the carrier about the rotor's axis.
#[test]
fn coupling_of_a_serial_arm_is_strictly_upper_triangular() {
    let serial = Options { bodies: 2..=10, floating: 0.0, branching: 0.0, remote_mount: 0.0, ..Options::default() };
    let coupled = core::cell::Cell::new(0);
    for_trials::<f64>(200, &serial, &[Fidelity::Complete], tol(1e-12, 0.0), |t| {
        let nv = t.robot.nv();
        let got = t.core.coupling(&t.state);
        let mut want = DMatrix::zeros(nv, nv);
        let links = t.oracle().links(&t.state);
        for (j, body) in t.robot.bodies.iter().enumerate() {
            let Some(drive) = body.drive.filter(|d| matches!(d.transmission, TransmissionSpec::Elastic { .. })) else {
                continue;
            };
            let mount = drive.rotor.mount;
            let Some(carrier) = mount.body.map(|b| &links[b]) else { continue };
            let n = carrier.rotation * Vector3::from((mount.placement.rotation() * mount.axis).to_array());
            let turned = carrier.jacobian.rows(0, 3).tr_mul(&n);
            want.set_column(j, &(turned * (drive.gear_ratio * drive.rotor.inertia)));
        }
        t.assert_close("S", &got, want.transpose().as_slice(), 1e-6);
        for (i, entry) in got.iter().enumerate() {
            let (row, column) = (i / nv, i % nv);
            assert!(row < column || *entry == 0.0, "S({row}, {column}) is {entry:e}; {t}");
        }
        coupled.set(coupled.get() + usize::from(norm(&got) > 0.0));
    });
    assert!(coupled.get() > 100, "only {} arms of 200 couple links and rotors", coupled.get());
}

#[test]
fn links_and_motors_are_coupled_in_the_complete_model_alone() {
    let others = [Fidelity::Reduced, Fidelity::Rigid, Fidelity::RigidReflected];
    for_trials::<f64>(200, &Options::default(), &others, tol(0.0, 0.0), |t| {
        let blocks = t.core.coriolis(&t.state);
        assert_eq!([norm(&blocks.c1), norm(&blocks.c2)], [0.0; 2], "{t}");
        assert_eq!(norm(&t.core.inertia_rates(&t.state)[1]), 0.0, "{t}");
        assert_eq!(norm(&t.core.bias(&t.state)[1]), 0.0, "{t}");
    });
}
