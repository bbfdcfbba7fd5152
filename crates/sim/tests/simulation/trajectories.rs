//! Laws of reference trajectories.

use gyroflex::control::reference::{MinimumTime, PointToPoint, Reference, Step};
use gyroflex_sim::reference::{Ends, SmoothSpline, Spline, Trajectory};
use gyroflex_sim::scenario::SineTerm;

fn all() -> Vec<(&'static str, Trajectory)> {
    let times: Vec<f64> = (0..20).map(|i| 0.1 * i as f64 + 0.02 * (i % 3) as f64).collect();
    let values: Vec<f64> = times.iter().map(|t| (2.0 * t).sin()).collect();
    let sine = |amplitude, frequency, phase| SineTerm { amplitude, frequency, phase };
    let smooth = |degree, ends| Trajectory::SmoothSpline(SmoothSpline::new(&times, &values, degree, ends).unwrap());
    let minimum_time = MinimumTime::new(-0.4, 0.9, 0.0, &[2.0, 8.0, 60.0, 900.0]).unwrap();
    vec![
        ("hold", Trajectory::Hold(0.3)),
        ("sines", Trajectory::Sines { offset: 0.1, terms: vec![sine(0.5, 0.7, 0.2), sine(-0.2, 1.9, 1.0)] }),
        ("zhao", Trajectory::Zhao { offset: -1.0, amplitude: 0.6, omega: 3.0 }),
        ("polynomial", Trajectory::Polynomial(PointToPoint::new(-0.4, 0.9, 0.2, 1.3, 2).unwrap())),
        ("smoother", Trajectory::Polynomial(PointToPoint::new(-0.4, 0.9, 0.0, 2.0, 5).unwrap())),
        ("filtered", Trajectory::FilteredStep { from: 0.1, step: Step { time: 0.0, to: 0.7 }, order: 4, cutoff: 1.0 }),
        ("minimum time", Trajectory::MinimumTime(Box::new(minimum_time))),
        ("spline", Trajectory::Spline(Spline::new(times.clone(), values.clone()).unwrap())),
        ("spline of degree 5", smooth(5, Ends::Nearest)),
        ("spline of degree 7", smooth(7, Ends::Nearest)),
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
fn as_many_derivatives_as_are_promised_are_slopes_of_the_ones_before() {
    let value = |trajectory: &Trajectory, t: f64, k: usize| {
        let mut out = vec![f64::NAN; k + 1];
        trajectory.derivatives(t, &mut out);
        out[k]
    };
    for (name, trajectory) in all() {
        let times: Vec<f64> = (0..150).map(|i| 0.0117 * i as f64 + 0.0045).collect();
        for k in 1..=trajectory.smoothness().unwrap_or(9) {
            let size = times.iter().map(|t| value(&trajectory, *t, k).abs()).fold(1.0, f64::max);
            let slope =
                |t: f64, h: f64| (value(&trajectory, t + h, k - 1) - value(&trajectory, t - h, k - 1)) / (2.0 * h);
            let errors = times
                .iter()
                .map(|t| (value(&trajectory, *t, k) - (4.0 * slope(*t, 2e-4) - slope(*t, 4e-4)) / 3.0).abs());
            // The last one may jump at a few places, whose surroundings no difference resolves.
            let wrong = errors.filter(|e| *e > 1e-6 * size).count();
            assert!(wrong <= 8, "{name}: derivative {k} is wrong at {wrong} of 150 instants");
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
    let quintic = Trajectory::Polynomial(PointToPoint::new(1.0, -2.0, 0.5, 2.0, 2).unwrap());
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
    let spline = Trajectory::Spline(Spline::new(times.clone(), values.clone()).unwrap());
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

/// Points at no equal distances, and a polynomial of this degree at them.
fn points(degree: i32) -> (Vec<f64>, Vec<f64>, impl Fn(f64, i32) -> f64) {
    let times: Vec<f64> = (0..24).map(|i| 0.1 * i as f64 + 0.03 * ((i * i) % 3) as f64).collect();
    let derivative = move |t: f64, k: i32| {
        let term = |j: i32| {
            (j - k + 1..=j).map(f64::from).product::<f64>() * (t - 1.2).powi(j - k) * (1.0 - 0.3 * f64::from(j))
        };
        (k..=degree).map(term).sum()
    };
    let values = times.iter().map(|t| derivative(*t, 0)).collect();
    (times, values, derivative)
}

#[test]
fn splines_reproduce_polynomials_of_their_degree() {
    for degree in [3, 5, 7, 9] {
        let (times, values, derivative) = points(degree);
        let spline = SmoothSpline::new(&times, &values, degree as usize, Ends::Nearest).unwrap();
        for i in 0..200 {
            let t = 2.29 * i as f64 / 200.0;
            let mut out = vec![0.0; degree as usize + 2];
            spline.derivatives(t, &mut out);
            for k in 0..=degree {
                let (own, exact) = (out[k as usize], derivative(t, k));
                assert!(
                    (own - exact).abs() < 1e-10 * 12f64.powi(k),
                    "degree {degree}, {k} at {t}: {own} is not {exact}"
                );
            }
        }
    }
}

#[test]
fn the_spline_of_third_degree_is_the_cubic() {
    let times: Vec<f64> = (0..2000).map(|i| 0.01 * i as f64 + 0.003 * ((i * i) % 3) as f64).collect();
    let values: Vec<f64> = times.iter().map(|t| (3.0 * t).sin() + (17.0 * t).cos()).collect();
    for n in [2, 3, 4, 5, 2000] {
        let (times, values) = (&times[..n], &values[..n]);
        let [cubic, own] = [
            Trajectory::Spline(Spline::new(times.to_vec(), values.to_vec()).unwrap()),
            Trajectory::SmoothSpline(SmoothSpline::new(times, values, 3, Ends::Nearest).unwrap()),
        ];
        for i in 0..=777 {
            let t = times[n - 1] * i as f64 / 777.0;
            let (a, b) = (cubic.at(t), own.at(t));
            assert!(
                (a.q - b.q).abs() < 1e-12 && (a.qd - b.qd).abs() < 1e-9 && (a.qdd - b.qdd).abs() < 1e-6,
                "{n}, {t}"
            );
        }
    }
}

#[test]
fn splines_pass_their_points_as_smoothly_as_promised() {
    let (times, values) = ([0.2, 0.5, 0.6, 1.1, 1.4, 2.0], [0.0, 0.7, 0.4, -0.3, 0.2, 1.0]);
    for n in 2..=6 {
        for degree in [3, 5, 7, 9] {
            for ends in [Ends::Rest, Ends::Nearest] {
                let spline = SmoothSpline::new(&times[..n], &values[..n], degree, ends).unwrap();
                let at = |t: f64| {
                    let mut out = vec![0.0; degree];
                    spline.derivatives(t, &mut out);
                    out
                };
                let sizes = (0..400)
                    .map(|i| at(0.2 + 0.0045 * i as f64))
                    .fold(vec![1f64; degree], |most, x| most.iter().zip(&x).map(|(m, x)| m.max(x.abs())).collect());
                for (i, (&t, &v)) in times[..n].iter().zip(&values).enumerate() {
                    assert!((at(t)[0] - v).abs() < 1e-11 * sizes[0], "{n} points, degree {degree}");
                    let end = i == 0 || i == n - 1;
                    if end && ends == Ends::Nearest {
                        continue;
                    }
                    let (before, after) = (at(t - 1e-9), at(t + 1e-9));
                    for k in 0..degree {
                        let next = sizes.get(k + 1).copied().unwrap_or(1e2 * sizes[k]);
                        let gap = (before[k] - after[k]).abs();
                        assert!(
                            gap < 1e-8 * sizes[k] + 4e-9 * next,
                            "{n} points, degree {degree}, {ends:?}, {k}: {gap}"
                        );
                    }
                }
                let outside = at(times[n - 1] + 0.1);
                assert!(
                    (outside[0] - values[n - 1]).abs() < 1e-11 * sizes[0] && outside[1..].iter().all(|x| *x == 0.0)
                );
                assert_eq!(at(0.1)[0], values[0]);
            }
        }
    }
}

#[test]
fn smooth_spline_of_unusable_points_is_refused() {
    let new = |times: &[f64], values: &[f64], degree| SmoothSpline::new(times, values, degree, Ends::Rest);
    assert!(new(&[0.0, 1.0], &[0.0, 1.0], 5).is_some());
    for degree in [0, 1, 2, 4, 17] {
        assert!(new(&[0.0, 1.0], &[0.0, 1.0], degree).is_none(), "{degree}");
    }
    assert!(new(&[0.0], &[1.0], 5).is_none() && new(&[0.0, 0.0], &[1.0, 2.0], 5).is_none());
    assert!(new(&[0.0, f64::INFINITY], &[1.0, 2.0], 5).is_none() && new(&[0.0, 1.0], &[1.0], 5).is_none());
}
