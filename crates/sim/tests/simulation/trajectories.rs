//! Laws of reference trajectories.

use gyroflex_sim::reference::{Spline, Trajectory};
use gyroflex_sim::scenario::SineTerm;

fn all() -> Vec<(&'static str, Trajectory)> {
    let times: Vec<f64> = (0..20).map(|i| 0.1 * i as f64 + 0.02 * (i % 3) as f64).collect();
    let values = times.iter().map(|t| (2.0 * t).sin()).collect();
    let sine = |amplitude, frequency, phase| SineTerm { amplitude, frequency, phase };
    vec![
        ("hold", Trajectory::Hold(0.3)),
        ("sines", Trajectory::Sines { offset: 0.1, terms: vec![sine(0.5, 0.7, 0.2), sine(-0.2, 1.9, 1.0)] }),
        ("zhao", Trajectory::Zhao { offset: -1.0, amplitude: 0.6, omega: 3.0 }),
        ("quintic", Trajectory::Quintic { from: -0.4, to: 0.9, start: 0.2, duration: 1.3 }),
        ("spline", Trajectory::Spline(Spline::new(times, values).unwrap())),
    ]
}

#[test]
fn velocity_and_acceleration_are_derivatives_of_position() {
    for (name, trajectory) in all() {
        for i in 0..170 {
            // Away from the knots of the spline, where the third derivative jumps.
            let (t, h) = (0.0117 * i as f64 + 0.0005, 1e-5);
            let (before, here, after) = (trajectory.at(t - h), trajectory.at(t), trajectory.at(t + h));
            let qd = (after.q - before.q) / (2.0 * h);
            let qdd = (after.qd - before.qd) / (2.0 * h);
            assert!((qd - here.qd).abs() < 1e-7, "{name} at {t}: {qd} is not {}", here.qd);
            assert!((qdd - here.qdd).abs() < 1e-3, "{name} at {t}: {qdd} is not {}", here.qdd);
        }
    }
}

#[test]
fn zhao_starts_without_velocity_or_acceleration() {
    let start = Trajectory::Zhao { offset: 0.5, amplitude: 0.7, omega: 2.3 }.at(0.0);
    assert!((start.q - (0.5 + 0.7 * 0.7 + 1.0)).abs() < 1e-15);
    assert!(start.qd.abs() < 1e-15 && start.qdd.abs() < 1e-14, "{start:?}");
}

#[test]
fn quintic_rests_at_both_ends() {
    let quintic = Trajectory::Quintic { from: 1.0, to: -2.0, start: 0.5, duration: 2.0 };
    for (t, q) in [(-1.0, 1.0), (0.5, 1.0), (1.5, -0.5), (2.5, -2.0), (9.0, -2.0)] {
        let point = quintic.at(t);
        assert!((point.q - q).abs() < 1e-14, "{t}");
        assert!(t == 1.5 || (point.qd == 0.0 && point.qdd == 0.0), "{t}");
    }
}

#[test]
fn spline_passes_its_points_and_reproduces_cubics() {
    let f = |t: f64| 0.3 - t + 0.8 * t * t - 0.2 * t * t * t;
    let times: Vec<f64> = [0.0, 0.3, 0.5, 1.1, 1.6, 2.0].into();
    let values: Vec<f64> = times.iter().copied().map(f).collect();
    let spline = Spline::new(times.clone(), values.clone()).unwrap();
    for (t, v) in times.iter().zip(&values) {
        assert!((spline.at(*t).q - v).abs() < 1e-14);
    }
    for i in 0..=100 {
        let t = 0.02 * i as f64;
        assert!((spline.at(t).q - f(t)).abs() < 1e-13, "{t}");
        assert!((spline.at(t).qdd - (1.6 - 1.2 * t)).abs() < 1e-11, "{t}");
    }
}

#[test]
fn spline_of_unusable_points_is_refused() {
    assert!(Spline::new(vec![0.0], vec![1.0]).is_none());
    assert!(Spline::new(vec![0.0, 0.0], vec![1.0, 2.0]).is_none());
    assert!(Spline::new(vec![0.0, 1.0], vec![1.0, f64::NAN]).is_none());
    assert!(Spline::new(vec![0.0, 1.0], vec![1.0]).is_none());
}
