//! Laws of constrained dynamics and of impacts, on random robots in all models.

mod dynamics;
mod impacts;
mod inverse;
mod solving;

use gyroflex::model::Fidelity;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, Tolerance};
use gyroflex_tests::{Held, Trial, for_trials};

/// Shows a law random robots with random constraints that are independent of each other; at least a third of them must be.
fn for_held<T: Real>(
    count: u64,
    options: &Options,
    fidelities: &[Fidelity],
    tolerance: Tolerance,
    law: impl Fn(&Trial<'_, T>, &Held),
) {
    for_changed(count, options, fidelities, tolerance, Held::clone, law);
}

/// The same with contacts that stick.
fn for_sticking<T: Real>(
    count: u64,
    options: &Options,
    fidelities: &[Fidelity],
    tolerance: Tolerance,
    law: impl Fn(&Trial<'_, T>, &Held),
) {
    let stick = |held: &Held| {
        let mut held = held.clone();
        for contact in held.constraints.iter_mut().filter_map(|c| c.contact.as_mut()) {
            contact.slip = None;
        }
        held
    };
    for_changed(count, options, fidelities, tolerance, stick, law);
}

fn for_changed<T: Real>(
    count: u64,
    options: &Options,
    fidelities: &[Fidelity],
    tolerance: Tolerance,
    change: impl Fn(&Held) -> Held,
    law: impl Fn(&Trial<'_, T>, &Held),
) {
    let shown = core::cell::Cell::new(0);
    for_trials::<T>(count, options, fidelities, tolerance, |t| {
        let held = change(&Held::new(t.robot.constraints(0)));
        // Poorly conditioned systems amplify rounding without end.
        let solved = t.core.constrained(&t.state, &held).solved;
        if held.rows() > 0 && solved.dependent == 0.0 && solved.independence > 1e-3 {
            shown.set(shown.get() + 1);
            law(t, &held);
        }
    });
    let all = count * fidelities.len() as u64;
    assert!(shown.get() * 3 > all, "only {} of {all} trials have independent constraints", shown.get());
}
