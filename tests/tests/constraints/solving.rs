//! Constraints that depend on each other.

use super::for_sticking;
use gyroflex::model::Fidelity;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{norm, tol};
use gyroflex_tests::Held;

#[test]
fn constraints_said_twice_are_kept_once() {
    for_sticking::<f64>(200, &Options::default(), &Fidelity::ALL, tol(1e-6, 0.0), |t, held| {
        let mut twice = Held { threshold: 1e-8, ..held.clone() };
        twice.constraints.extend(held.constraints.clone());
        let (once, doubled) = (t.core.constrained(&t.state, held), t.core.constrained(&t.state, &twice));
        assert_eq!(doubled.solved.dependent, held.rows() as f64, "dependent directions; {t}");
        assert!(doubled.solved.contradiction < 1e-4 * norm(&once.links).max(1.0), "{:?}; {t}", doubled.solved);
        t.assert_close("qdd", &doubled.links, &once.links, 0.0);
        t.assert_close("wrenches", &flat(&doubled.wrenches[..held.constraints.len()]), &flat(&once.wrenches), 1.0);
    });
}

fn flat(wrenches: &[[f64; 6]]) -> Vec<f64> {
    wrenches.iter().flatten().copied().collect()
}

#[test]
fn constraints_that_contradict_each_other_are_told() {
    for_sticking::<f64>(200, &Options::default(), &[Fidelity::Complete], tol(0.0, 0.0), |t, held| {
        let mut twice = Held { threshold: 1e-8, ..held.clone() };
        // The same directions, drawn back at another rate: they cannot both be.
        twice.constraints.extend(
            held.constraints
                .iter()
                .map(|c| gyroflex::dynamics::Constraint { stabilisation: c.stabilisation + 10.0, ..*c }),
        );
        let found = t.core.constrained(&t.state, &twice);
        assert!(found.solved.contradiction > 1e-3, "{:?}; {t}", found.solved);
    });
}

#[test]
fn damped_constraints_share_the_load_and_give_way_a_little() {
    for_sticking::<f64>(200, &Options::default(), &[Fidelity::Complete], tol(1e-4, 0.0), |t, held| {
        let mut twice = Held { damping: 1e-9, threshold: 0.0, ..held.clone() };
        twice.constraints.extend(held.constraints.clone());
        let (once, shared) = (t.core.constrained(&t.state, held), t.core.constrained(&t.state, &twice));
        t.assert_close("qdd", &shared.links, &once.links, 0.0);
        let (first, second) = shared.multipliers.split_at(held.rows());
        t.assert_close("shares", first, second, norm(&once.multipliers));
    });
}
