//! Scratch carries nothing from call to call: after a call on NaN, the next one gives the same bits.

use gyroflex::model::Fidelity;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, tol};
use gyroflex_tests::{Trial, for_trials};

fn bits(v: &[f64]) -> Vec<u64> {
    v.iter().map(|x| x.to_bits()).collect()
}

fn same_bits<T: Real>(t: &Trial<'_, T>) {
    let (clean, dirty, s) = (&t.core, t.core.clone().with_dirty_scratch(), &t.state);
    let same = |what: &str, a: &[f64], b: &[f64]| {
        assert!(a.iter().all(|x| x.is_finite()), "{what}; {t}");
        assert_eq!(bits(a), bits(b), "{what}; {t}");
    };
    for (a, b) in [
        (clean.forward(s), dirty.forward(s)),
        (clean.aba(s), dirty.aba(s)),
        (clean.forward_in_joint_space(s), dirty.forward_in_joint_space(s)),
    ] {
        same("qdd", &a.qdd, &b.qdd);
        same("thetadd", &a.thetadd, &b.thetadd);
        same("tau_j", &a.tau_j, &b.tau_j);
    }
    let (a, b) = (clean.inverse(s), dirty.inverse(s));
    same("tau_j of the inverse", &a.tau_j, &b.tau_j);
    same("tau of the inverse", &a.tau, &b.tau);
    same("M", &clean.mass_matrix(s), &dirty.mass_matrix(s));
    same("S", &clean.coupling(s), &dirty.coupling(s));
    let (a, b) = (clean.energy(s), dirty.energy(s));
    same("energies", &[a.kinetic, a.gravity, a.elastic], &[b.kinetic, b.gravity, b.elastic]);
    let (a, b) = (clean.power(s), dirty.power(s));
    same("powers", &[a.supplied, a.dissipated], &[b.supplied, b.dissipated]);
}

#[test]
fn nan_filled_scratch_gives_the_same_bits() {
    for_trials::<f64>(200, &Options::default(), &Fidelity::ALL, tol(0.0, 0.0), same_bits);
    for_trials::<f32>(200, &Options::default(), &Fidelity::ALL, tol(0.0, 0.0), same_bits);
}

/// Motor coordinates of joints without an elastic transmission mean nothing, and nobody reads them.
#[test]
fn motor_coordinates_of_rigid_joints_are_not_read() {
    for_trials::<f64>(200, &Options::default(), &Fidelity::ALL, tol(0.0, 0.0), |t| {
        let mut s = t.state.clone();
        let elastic = t.core.model().bodies().iter().filter(|b| b.is_elastic()).map(|b| b.v_index());
        let elastic: Vec<usize> = elastic.collect();
        for k in (0..s.qd.len()).filter(|k| !elastic.contains(k)) {
            (s.theta[k], s.thetad[k], s.thetadd[k]) = (f64::NAN, f64::NAN, f64::NAN);
        }
        let (a, b) = (t.core.forward(&t.state), t.core.forward(&s));
        assert_eq!(bits(&a.qdd), bits(&b.qdd), "{t}");
        assert_eq!(bits(&a.thetadd), bits(&b.thetadd), "{t}");
        assert_eq!(bits(&a.tau_j), bits(&b.tau_j), "{t}");
        let (a, b) = (t.core.inverse(&t.state), t.core.inverse(&s));
        assert_eq!(bits(&a.tau_j), bits(&b.tau_j), "{t}");
        assert_eq!(bits(&a.tau), bits(&b.tau), "{t}");
    });
}
