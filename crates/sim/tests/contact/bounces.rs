//! A mass that falls on the ground.

use crate::machines::{G, MASS, assert_near, mass, run};
use gyroflex_sim::contact::EventKind;

const HEIGHT: f64 = 0.5;

fn dropped(restitution: f64, duration: f64) -> String {
    format!(
        "duration: {duration}\ninitial: {{q: {{z: {HEIGHT}}}}}\nground: {{friction: 0.5, restitution: {restitution}}}
integrator: {{method: rk4, step: 1e-3}}\nlog: {{rate: 1000}}"
    )
}

/// `√(2h/g)` for the fall, then twice the time of rising, `e` times as long at each bounce.
#[test]
fn every_bounce_comes_at_its_closed_form_time_with_its_impulse() {
    let (e, run) = (0.5_f64, run(&mass(), &dropped(0.5, 0.9)));
    let (mut t, mut speed) = ((2.0 * HEIGHT / G).sqrt(), (2.0 * G * HEIGHT).sqrt());
    assert!(run.summary.events.len() >= 4, "{:?}", run.summary.events);
    for event in &run.summary.events {
        assert_eq!(event.kind, EventKind::Bounce);
        assert_near("time", event.t, t, 1e-9);
        assert_near("impulse", event.impulse[2], MASS * (1.0 + e) * speed, 1e-8);
        speed *= e;
        t += 2.0 * speed / G;
    }
}

/// The sum of height and `v²/2g` is the height of the next apex.
#[test]
fn bounces_rise_to_the_square_of_restitution_of_the_height_before() {
    let run = run(&mass(), &dropped(0.5, 0.9));
    for sample in &run.samples {
        let bounces = run.summary.events.iter().filter(|e| e.t < sample.t).count();
        let apex = sample.q[2] + sample.qd[2] * sample.qd[2] / (2.0 * G);
        assert_near("apex", apex, HEIGHT * 0.25_f64.powi(bounces as i32), 1e-9);
    }
}

#[test]
fn plastic_mass_stays_where_it_came_down_and_is_carried() {
    let run = run(&mass(), &dropped(0.0, 0.6));
    let [event] = run.summary.events[..] else { panic!("{:?}", run.summary.events) };
    assert_eq!(event.kind, EventKind::TouchDown);
    assert_near("time", event.t, (2.0 * HEIGHT / G).sqrt(), 1e-9);
    let last = run.last();
    assert_near("height", last.q[2], 0.0, 1e-11);
    assert_near("force", run.touch(last, "foot").force[2], MASS * G, 1e-8);
    assert_near("mode", run.touch(last, "foot").mode, 1.0, 0.0);
}

/// A bounce is slower than `resting_speed` at last: infinitely many bounces in a finite time are not simulated.
#[test]
fn bouncing_mass_comes_to_rest() {
    let run = run(&mass(), &dropped(0.5, 1.2));
    let events = &run.summary.events;
    assert_eq!(events.last().expect("it falls").kind, EventKind::TouchDown, "{events:?}");
    // All bounces together last less than the geometric series.
    let whole = (2.0 * HEIGHT / G).sqrt() * (1.0 + 2.0 * 0.5 / (1.0 - 0.5));
    assert!(events.iter().all(|e| e.t < whole), "{events:?}");
    assert_near("height", run.last().q[2], 0.0, 1e-9);
}
