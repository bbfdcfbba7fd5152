//! Scratch carries nothing from call to call, lanes nothing from state to state, and what is not meant is not read.

use gyroflex::Lanes;
use gyroflex::dynamics::{Acceleration, External, Forward, Inverse, State as Given, flexible_aba, flexible_rnea};
use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::random::{FlexibleOptions, RandomFlexible};
use gyroflex_testkit::tolerance::{Real, relative_error, tol};
use gyroflex_tests::{FlexibleCore, FlexibleStorage, FlexibleTrial, for_flexible};

fn bits(v: &[f64]) -> Vec<u64> {
    v.iter().map(|x| x.to_bits()).collect()
}

fn same_bits<T: Real>(t: &FlexibleTrial<'_, T>) {
    let (clean, dirty, s) = (&t.core, t.core.clone().with_dirty_scratch(), &t.state);
    let all = |core: &FlexibleCore<T>| -> Vec<(&str, Vec<f64>)> {
        let (forward, inverse, (hybrid, etadd)) = (core.forward(s), core.inverse(s), core.hybrid(s));
        let ([m, coupling], [links, stations]) = (core.matrices(s), core.placements(s));
        let (e, p) = (core.energy(s), core.power(s));
        vec![
            ("qdd", forward.qdd),
            ("thetadd", forward.thetadd),
            ("tau_j", forward.tau_j),
            ("tau of the inverse", inverse.tau),
            ("tau_j of the inverse", inverse.tau_j),
            ("tau of the hybrid", hybrid.tau),
            ("tau_j of the hybrid", hybrid.tau_j),
            ("etadd", etadd),
            ("M", m),
            ("S", coupling),
            ("links", links),
            ("stations", stations),
            ("energies", vec![e.kinetic, e.gravity, e.elastic]),
            ("powers", vec![p.supplied, p.dissipated]),
        ]
    };
    for ((what, a), (_, b)) in all(clean).into_iter().zip(all(&dirty)) {
        assert!(a.iter().all(|x| x.is_finite()), "{what}; {t}");
        assert_eq!(bits(&a), bits(&b), "{what}; {t}");
    }
}

#[test]
fn nan_filled_scratch_gives_the_same_bits() {
    for_flexible::<f64>(100, &FlexibleOptions::default(), &Fidelity::ALL, tol(0.0, 0.0), same_bits);
    for_flexible::<f32>(50, &FlexibleOptions::default(), &Fidelity::ALL, tol(0.0, 0.0), same_bits);
}

/// Motor coordinates of modes, and of joints without an elastic transmission, mean nothing.
#[test]
fn motor_coordinates_of_modes_are_not_read() {
    for_flexible::<f64>(100, &FlexibleOptions::default(), &Fidelity::ALL, tol(0.0, 0.0), |t| {
        let mut s = t.state.clone();
        let model = t.core.model();
        let elastic: Vec<usize> =
            model.rigid().bodies().iter().filter(|b| b.is_elastic()).map(|b| b.v_index()).collect();
        for k in (0..s.qd.len()).filter(|k| !elastic.contains(k)) {
            (s.theta[k], s.thetad[k], s.thetadd[k]) = (f64::NAN, f64::NAN, f64::NAN);
        }
        let (a, b) = (t.core.forward(&t.state), t.core.forward(&s));
        assert_eq!(
            (bits(&a.qdd), bits(&a.thetadd), bits(&a.tau_j)),
            (bits(&b.qdd), bits(&b.thetadd), bits(&b.tau_j)),
            "{t}"
        );
        let (a, b) = (t.core.inverse(&t.state), t.core.inverse(&s));
        assert_eq!((bits(&a.tau), bits(&a.tau_j)), (bits(&b.tau), bits(&b.tau_j)), "{t}");
        let ((a, x), (b, y)) = (t.core.hybrid(&t.state), t.core.hybrid(&s));
        assert_eq!((bits(&a.tau), bits(&x)), (bits(&b.tau), bits(&y)), "{t}");
        let (a, b) = (t.core.power(&t.state), t.core.power(&s));
        assert_eq!(bits(&[a.supplied, a.dissipated]), bits(&[b.supplied, b.dissipated]), "{t}");
    });
}

type Eight = Lanes<f64, 8>;

/// Eight different states side by side are the eight alone.
#[test]
fn each_lane_equals_its_state_alone() {
    for seed in 0..50 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &FlexibleOptions::default().in_model(fidelity));
            let lowered = robot.lower::<f64>(fidelity).expect("a random robot is valid");
            let model = lowered.view();
            let points: [State; 8] = core::array::from_fn(|k| State { wrenches: Vec::new(), ..robot.state(k as u64) });
            let gather = |field: fn(&State) -> &Vec<f64>| -> Vec<Eight> {
                let entry = |k: usize| Lanes(core::array::from_fn(|lane| field(&points[lane])[k]));
                (0..field(&points[0]).len()).map(entry).collect()
            };
            let [q, qd, theta, thetad] =
                [gather(|s| &s.q), gather(|s| &s.qd), gather(|s| &s.theta), gather(|s| &s.thetad)];
            let [tau, tau_ext, qdd, thetadd] =
                [gather(|s| &s.tau), gather(|s| &s.tau_ext), gather(|s| &s.qdd), gather(|s| &s.thetadd)];
            let nan = Lanes([f64::NAN; 8]);
            let mut storage = FlexibleStorage::new(&model);
            let given = Given { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
            let ext = External { tau: &tau_ext, wrenches: &[] };
            let [mut a, mut b, mut c, mut d, mut e] = [(); 5].map(|()| vec![nan; model.nv()]);
            let out = Forward { qdd: &mut a, thetadd: &mut b, tau_j: &mut c };
            flexible_aba(&model, given, &tau, ext, storage.scratch(), out).expect("slices fit the model");
            let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
            let out = Inverse { tau_j: &mut d, tau: &mut e };
            flexible_rnea(&model, given, accel, ext, storage.scratch(), out).expect("slices fit the model");

            let alone = FlexibleCore::<f64>::new(&robot, fidelity);
            for (k, point) in points.iter().enumerate() {
                let (forward, inverse) = (alone.forward(point), alone.inverse(point));
                let pairs = [
                    (&a, forward.qdd),
                    (&b, forward.thetadd),
                    (&c, forward.tau_j),
                    (&d, inverse.tau_j),
                    (&e, inverse.tau),
                ];
                for (got, want) in pairs {
                    let got: Vec<f64> = got.iter().map(|x| x.0[k]).collect();
                    let error = relative_error(&got, &want, 0.0);
                    assert!(error <= 1e-11, "off by {error:e}; seed {seed}, {}, lane {k}", fidelity.name());
                }
            }
        }
    }
}
