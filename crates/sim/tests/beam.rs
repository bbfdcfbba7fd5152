//! Laws of beams: eigenvalues, orthogonality, boundary conditions, and integrals against closed forms.

use gyroflex_sim::beam::{
    Beam, BeamMode, Bending, Boundary, Deflection, Inertia, Profile, Resistance, Rod, Shape, Table, TipBody, composite,
    gauss_legendre,
};
use std::f64::consts::PI;

const LENGTH: f64 = 0.7;
const MASS: f64 = 0.6;
const EI: f64 = 4.5;

/// Every boundary of bending, one of them with a heavy body off the tip.
fn boundaries() -> [Boundary; 6] {
    [
        Boundary::ClampedFree,
        Boundary::ClampedClamped,
        Boundary::ClampedPinned,
        Boundary::PinnedPinned,
        Boundary::ClampedMass(TipBody { mass: 0.9, inertia: 0.02, first_moment: 0.05 }),
        Boundary::ClampedMass(TipBody { mass: 40.0, inertia: 3.0, first_moment: 0.0 }),
    ]
}

/// A uniform beam whose `modes` bend along y.
fn beam(boundary: Boundary, modes: usize) -> Beam {
    let mut beam = Beam {
        length: LENGTH,
        mass_per_length: Profile::Constant(MASS),
        polar_inertia_per_length: Profile::Constant(0.0),
        modes: Vec::new(),
        stiffening: true,
    };
    let shapes = beam.inertia_per_length().eigenmodes(Deflection::BendingY, boundary, modes);
    beam.modes = shapes.expect("it bends").into_iter().map(|(shape, lumped)| mode(shape, lumped)).collect();
    beam
}

fn mode(shape: Shape, lumped: f64) -> BeamMode {
    let resistance = Resistance::Stiffness(Profile::Constant(EI));
    BeamMode { deflection: Deflection::BendingY, shape, resistance, damping_ratio: 0.02, lumped }
}

/// `∫ f dx` over the beam by Simpson's rule, halved until it stands: none of the crate's quadrature.
fn simpson(f: &dyn Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    fn step(f: &dyn Fn(f64) -> f64, [a, b]: [f64; 2], [fa, fm, fb]: [f64; 3], whole: f64, eps: f64, depth: u32) -> f64 {
        let m = 0.5 * (a + b);
        let (fl, fr) = (f(0.5 * (a + m)), f(0.5 * (m + b)));
        let (left, right) = ((m - a) / 6.0 * (fa + 4.0 * fl + fm), (b - m) / 6.0 * (fm + 4.0 * fr + fb));
        if depth == 0 || (left + right - whole).abs() < 15.0 * eps {
            return left + right + (left + right - whole) / 15.0;
        }
        step(f, [a, m], [fa, fl, fm], left, 0.5 * eps, depth - 1)
            + step(f, [m, b], [fm, fr, fb], right, 0.5 * eps, depth - 1)
    }
    let n = 16;
    (0..n)
        .map(|i| {
            let [x, y] = [i, i + 1].map(|k| a + (b - a) * f64::from(k) / f64::from(n));
            let at = [f(x), f(0.5 * (x + y)), f(y)];
            step(f, [x, y], at, (y - x) / 6.0 * (at[0] + 4.0 * at[1] + at[2]), 1e-13, 30)
        })
        .sum()
}

fn close(is: f64, want: f64, tolerance: f64) {
    assert!((is - want).abs() <= tolerance, "{is} is not {want} to {tolerance}");
}

#[test]
fn eigenvalues_are_those_of_the_tables() {
    // Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1.
    let tables: [(Boundary, &[f64]); 3] = [
        (Boundary::ClampedFree, &[1.87510407, 4.69409113, 7.85475744, 10.99554073, 14.13716839]),
        (Boundary::ClampedClamped, &[4.73004074, 7.85320462, 10.9956078, 14.1371655, 17.2787597]),
        (Boundary::ClampedPinned, &[3.92660231, 7.06858275, 10.21017612, 13.35176878, 16.49336143]),
    ];
    for (boundary, want) in tables {
        let found = Bending::first(boundary, LENGTH, MASS, want.len());
        for (function, want) in found.iter().zip(want) {
            close(function.eigenvalue, *want, 6e-8);
        }
    }
    for (k, function) in Bending::first(Boundary::PinnedPinned, LENGTH, MASS, 5).iter().enumerate() {
        close(function.eigenvalue, (k + 1) as f64 * PI, 1e-14);
    }
}

#[test]
fn eigenvalues_solve_the_frequency_equations() {
    // 1 + cos λ cosh λ and its kin, divided by cosh λ.
    for (boundary, sign) in [(Boundary::ClampedFree, 1.0), (Boundary::ClampedClamped, -1.0)] {
        for function in Bending::first(boundary, LENGTH, MASS, 20) {
            let x = function.eigenvalue;
            close(x.cos() + sign / x.cosh(), 0.0, 1e-13);
        }
    }
    for function in Bending::first(Boundary::ClampedPinned, LENGTH, MASS, 20) {
        let x = function.eigenvalue;
        close(x.sin() - x.cos() * x.tanh(), 0.0, 1e-13);
    }
    // A mass alone: 1 + cos λ cosh λ = r λ (sin λ cosh λ − cos λ sinh λ)
    for ratio in [1e-6, 0.3, 1.0, 50.0, 1e6] {
        let tip = TipBody { mass: ratio * MASS * LENGTH, ..TipBody::default() };
        for function in Bending::first(Boundary::ClampedMass(tip), LENGTH, MASS, 6) {
            let x = function.eigenvalue;
            let (left, right) = (x.cos() + 1.0 / x.cosh(), ratio * x * (x.sin() - x.cos() * x.tanh()));
            close(left, right, 1e-12 * (1.0 + ratio * x));
        }
    }
}

#[test]
fn a_heavy_body_moves_on_a_massless_beam() {
    // Stiffness [12 −6; −6 4] of the beam's end, the body a point: ω² = 3 EI / (m L³), and with inertia both roots of the 2×2 problem.
    let (mass, inertia) = (1e5 * MASS * LENGTH, 4e3 * MASS * LENGTH.powi(3));
    let tip = TipBody { mass, inertia, first_moment: 0.0 };
    let functions = Bending::first(Boundary::ClampedMass(tip), LENGTH, MASS, 3);
    let (a, b, c) = (12.0 * EI / LENGTH.powi(3) / mass, 4.0 * EI / LENGTH / inertia, 6.0 * EI / LENGTH.powi(2));
    let mean = 0.5 * (a + b);
    let half = (0.25 * (a - b).powi(2) + c * c / (mass * inertia)).sqrt();
    for (function, want) in functions.iter().zip([mean - half, mean + half]) {
        let omega2 = (function.eigenvalue / LENGTH).powi(4) * EI / MASS;
        close(omega2, want, 1e-4 * want);
    }
    // The next is that of the beam between two walls.
    close(functions[2].eigenvalue, 4.73004, 1e-3);
}

#[test]
fn eigenfunctions_meet_their_boundaries_and_the_equation_of_the_beam() {
    for boundary in boundaries() {
        for function in Bending::first(boundary, LENGTH, MASS, 12) {
            let beta = function.eigenvalue / LENGTH;
            let most =
                (0..=100).fold(0.0_f64, |m, i| m.max(function.derivative(LENGTH * f64::from(i) / 100.0, 0).abs()));
            // Derivatives by ξ, all of the size of the function.
            let at = |x: f64, k: usize| function.derivative(x, k) / beta.powi(k as i32) / most;
            let root: &[usize] = if boundary == Boundary::PinnedPinned { &[0, 2] } else { &[0, 1] };
            root.iter().for_each(|k| close(at(0.0, *k), 0.0, 1e-12));
            let tip = boundary.tip();
            let (m, i, s) = (tip.mass / MASS, tip.inertia / MASS, tip.first_moment / MASS);
            let (f, g) = (at(LENGTH, 0), at(LENGTH, 1));
            let moment = at(LENGTH, 2) - beta.powi(3) * i * g - beta.powi(2) * s * f;
            let force = at(LENGTH, 3) + beta * m * f + beta.powi(2) * s * g;
            let loads = 1.0 + beta.powi(3) * i + beta * m + beta.powi(2) * s;
            match boundary {
                Boundary::ClampedClamped => [f, g].iter().for_each(|x| close(*x, 0.0, 1e-12)),
                Boundary::ClampedPinned | Boundary::PinnedPinned => {
                    [f, at(LENGTH, 2)].iter().for_each(|x| close(*x, 0.0, 1e-12))
                }
                _ => [moment, force].iter().for_each(|x| close(*x, 0.0, 1e-12 * loads)),
            }
            for x in [0.1, 0.33, 0.5, 0.69] {
                close(at(x, 4), at(x, 0), 1e-12);
                let h = 1e-5 * LENGTH / function.eigenvalue;
                let slope = (at(x + h, 0) - at(x - h, 0)) / (2.0 * h * beta);
                close(at(x, 1), slope, 1e-6);
            }
            let just = 1e-3 * LENGTH / function.eigenvalue;
            assert!(function.derivative(just, 0) > 0.0, "{}: not positive beyond the root", boundary.name());
        }
    }
}

#[test]
fn eigenmodes_are_orthogonal_with_the_body_at_their_tip_and_weigh_as_much_as_the_beam() {
    for boundary in boundaries() {
        let n = 8;
        let beam = beam(boundary, n);
        let integrals = beam.integrals(beam.enough_points());
        let tip = boundary.tip();
        for j in 0..n {
            for k in 0..n {
                let pair = &integrals.pairs[j * n + k];
                let [(f, df), (g, dg)] = [j, k].map(|i| {
                    let shape = &beam.modes[i].shape;
                    (shape.derivative(LENGTH, 0), shape.derivative(LENGTH, 1))
                });
                let at_tip = tip.mass * f * g + tip.first_moment * (f * dg + df * g) + tip.inertia * df * dg;
                let mass = pair.moments.trace() + at_tip;
                close(mass, if j == k { MASS * LENGTH } else { 0.0 }, 1e-10);
                // K_jj = ω² m
                let omega = |i: usize| (beam.modes[i].shape.eigenvalue() / LENGTH).powi(2) * (EI / MASS).sqrt();
                let want = if j == k { omega(j).powi(2) * MASS * LENGTH } else { 0.0 };
                close(pair.stiffness, want, 1e-10 * omega(j) * omega(k) * MASS * LENGTH);
            }
            let figures = beam.figures(j, &integrals);
            let omega = (beam.modes[j].shape.eigenvalue() / LENGTH).powi(2) * (EI / MASS).sqrt();
            close(figures.frequency, omega / (2.0 * PI), 1e-9 * omega);
            close(integrals.pairs[j * n + j].damping, 2.0 * 0.02 * omega * MASS * LENGTH, 1e-9 * omega);
        }
    }
}

#[test]
fn the_clamped_free_beam_has_the_integrals_of_the_books() {
    // φ(L) = ±2, and ∫ φ dx / L = 2 σ/λ, ∫ x φ dx / L² = 2/λ² (Blevins; by two integrations of φ'''' = β⁴ φ).
    let n = 6;
    let beam = beam(Boundary::ClampedFree, n);
    let integrals = beam.integrals(beam.enough_points());
    for (j, mode) in integrals.modes.iter().enumerate() {
        let x = beam.modes[j].shape.eigenvalue();
        let sigma = (x.cosh() + x.cos()) / (x.sinh() + x.sin());
        let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
        close(beam.modes[j].shape.derivative(LENGTH, 0), 2.0 * sign, 1e-12);
        close(beam.modes[j].shape.derivative(0.0, 2) * (LENGTH / x).powi(2), 2.0, 1e-12);
        close(mode.momentum.y, MASS * LENGTH * 2.0 * sigma / x, 1e-13);
        close(mode.moments.rows[0].y, MASS * LENGTH * LENGTH * 2.0 / (x * x), 1e-13);
    }
    let inertia = integrals.inertia;
    close(inertia.mass, MASS * LENGTH, 1e-15);
    close(inertia.first_moment.x, 0.5 * MASS * LENGTH * LENGTH, 1e-15);
    close(inertia.rotational.zz, MASS * LENGTH.powi(3) / 3.0, 1e-15);
    close(inertia.rotational.xx, 0.0, 0.0);
}

#[test]
fn integrals_over_tables_of_mass_and_stiffness_agree_with_adaptive_quadrature() {
    let mut beam = beam(Boundary::ClampedFree, 3);
    let (mass, stiffness) = (
        Profile::Table(vec![[0.0, 1.2], [0.25, 0.9], [0.4, 0.9], [LENGTH, 0.3]]),
        Profile::Table(vec![[0.0, 9.0], [0.31, 6.0], [LENGTH, 2.0]]),
    );
    beam.mass_per_length = mass.clone();
    beam.modes.iter_mut().for_each(|m| m.resistance = Resistance::Stiffness(stiffness.clone()));
    let integrals = beam.integrals(beam.enough_points());
    let phi = |j: usize, k: usize, x: f64| beam.modes[j].shape.derivative(x, k);
    let over = |f: &dyn Fn(f64) -> f64| {
        [0.0, 0.25, 0.31, 0.4, LENGTH].windows(2).map(|ends| simpson(f, ends[0], ends[1])).sum::<f64>()
    };
    for j in 0..3 {
        let a = over(&|x| mass.at(x) * phi(j, 0, x));
        close(integrals.modes[j].momentum.y, a, 1e-10);
        close(integrals.modes[j].moments.rows[0].y, over(&|x| mass.at(x) * x * phi(j, 0, x)), 1e-10);
        for k in 0..3 {
            let pair = &integrals.pairs[3 * j + k];
            close(pair.moments.rows[1].y, over(&|x| mass.at(x) * phi(j, 0, x) * phi(k, 0, x)), 1e-10);
            let want = over(&|x| stiffness.at(x) * phi(j, 2, x) * phi(k, 2, x));
            close(pair.stiffness, want, 1e-7 * want.abs().max(1.0));
            // s_jk as an integral of its own at every point, not with the integrals exchanged.
            let s = |x: f64| -simpson(&|xi| phi(j, 1, xi) * phi(k, 1, xi), 0.0, x);
            for x in [0.2, 0.5, LENGTH] {
                close(beam.shortening(j, k, x), -s(x), 1e-9 * s(x).abs().max(1.0));
            }
            let rule = composite(&[0.0, 0.25, 0.31, 0.4, LENGTH], 12);
            let g: f64 = rule.iter().map(|[x, w]| w * mass.at(*x) * s(*x)).sum();
            let moment: f64 = rule.iter().map(|[x, w]| w * mass.at(*x) * x * s(*x)).sum();
            close(pair.shortening.x, g, 1e-8 * g.abs().max(1.0));
            close(pair.shortening_moments.rows[0].x, moment, 1e-8 * moment.abs().max(1.0));
        }
    }
}

#[test]
fn rods_have_the_eigenvalues_of_their_closed_forms() {
    let first = |boundary, tip| Rod::first(boundary, LENGTH, tip, 5).expect("rods are clamped or free");
    for (k, rod) in first(Boundary::ClampedFree, 0.0).iter().enumerate() {
        close(rod.eigenvalue, (2.0 * k as f64 + 1.0) * PI / 2.0, 1e-14);
        close(rod.derivative(LENGTH, 1), 0.0, 1e-12);
    }
    for (k, rod) in first(Boundary::ClampedClamped, 0.0).iter().enumerate() {
        close(rod.eigenvalue, (k + 1) as f64 * PI, 1e-14);
        close(rod.derivative(LENGTH, 0), 0.0, 1e-13);
    }
    for ratio in [1e-9, 0.4, 1.0, 1e4] {
        for rod in first(Boundary::ClampedMass(TipBody::default()), ratio) {
            close(rod.eigenvalue.cos(), ratio * rod.eigenvalue * rod.eigenvalue.sin(), 1e-12 * (1.0 + ratio));
        }
    }
    // λ tan λ = 1, Abramowitz & Stegun table 4.20.
    close(first(Boundary::ClampedMass(TipBody::default()), 1.0)[0].eigenvalue, 0.86033, 6e-6);
    assert!(Rod::first(Boundary::PinnedPinned, LENGTH, 0.0, 1).is_none());
}

#[test]
fn torsion_turns_the_polar_inertia_and_extension_moves_the_mass() {
    let (polar, gj, ea) = (3e-4, 7.0, 5e4);
    let profiles = (Profile::Constant(MASS), Profile::Constant(polar));
    let inertia = Inertia { length: LENGTH, mass: &profiles.0, polar: &profiles.1 };
    for (deflection, stiffness, per_length) in [(Deflection::Torsion, gj, polar), (Deflection::Extension, ea, MASS)] {
        let tip = TipBody { mass: 0.3, inertia: 5e-5, first_moment: 0.0 };
        for boundary in [Boundary::ClampedFree, Boundary::ClampedClamped, Boundary::ClampedMass(tip)] {
            let modes: Vec<BeamMode> = inertia
                .eigenmodes(deflection, boundary, 3)
                .expect("rods are clamped or free")
                .into_iter()
                .map(|(shape, lumped)| {
                    let resistance = Resistance::Stiffness(Profile::Constant(stiffness));
                    BeamMode { deflection, shape, resistance, damping_ratio: 0.0, lumped }
                })
                .collect();
            let beam = Beam {
                length: LENGTH,
                mass_per_length: profiles.0.clone(),
                polar_inertia_per_length: profiles.1.clone(),
                modes,
                stiffening: true,
            };
            let integrals = beam.integrals(beam.enough_points());
            for j in 0..3 {
                let figures = beam.figures(j, &integrals);
                let beta = beam.modes[j].shape.eigenvalue() / LENGTH;
                close(figures.total_mass, per_length * LENGTH, 1e-12);
                close(2.0 * PI * figures.frequency, beta * (stiffness / per_length).sqrt(), 1e-9 * beta * 300.0);
                // A beam that turns as a whole and twists: the coupling is ∫ ψ ρI_p dx about x, and nothing about other axes.
                let sum = simpson(&|x| per_length * beam.modes[j].shape.derivative(x, 0), 0.0, LENGTH);
                let moments = integrals.modes[j].moments;
                let about_x = moments.rows[1].z - moments.rows[2].y;
                close(about_x, if deflection == Deflection::Torsion { sum } else { 0.0 }, 1e-12);
                close(moments.rows[2].x - moments.rows[0].z, 0.0, 0.0);
                close(integrals.modes[j].momentum.x, if deflection == Deflection::Torsion { 0.0 } else { sum }, 1e-10);
            }
            close(integrals.inertia.rotational.xx, polar * LENGTH, 1e-15);
        }
    }
}

#[test]
fn eighth_modes_and_fortieth_modes_keep_their_digits() {
    for boundary in boundaries() {
        let beam = beam(boundary, 40);
        let integrals = beam.integrals(beam.enough_points());
        for j in [7, 39] {
            let pair = &integrals.pairs[j * 40 + j];
            let omega2 = (beam.modes[j].shape.eigenvalue() / LENGTH).powi(4) * EI / MASS;
            close(pair.stiffness / (omega2 * MASS * LENGTH), 1.0, 1e-10);
        }
        assert!(beam.check(beam.enough_points()).is_ok());
    }
}

#[test]
fn the_two_link_arm_of_de_luca_and_siciliano_has_its_published_modes() {
    // De Luca & Siciliano 1991: φ_e, φ'_e, ∫φ dm, ∫xφ dm and frequencies [Hz] as printed.
    let (length, rho, stiffness, mass, hub, payload) = (0.5, 0.2, 1.0, 0.1, 1.0, 0.1);
    let (hub_inertia, payload_inertia) = (0.1, 0.0005);
    let second = TipBody { mass: payload, inertia: payload_inertia, first_moment: 0.0 };
    // What hangs on the first link, whatever the angle of the second one: its moment of mass is left out.
    let inertia = mass * length * length / 3.0 + hub_inertia + payload_inertia + payload * length * length;
    let first = TipBody { mass: mass + hub + payload, inertia, first_moment: 0.0 };
    type Printed = [f64; 5];
    let printed: [(TipBody, [Printed; 2]); 2] = [
        (first, [[0.186, 0.657, 0.007, 0.002, 0.48], [0.215, -0.560, 0.013, 0.004, 1.80]]),
        (second, [[0.883, 2.641, 0.033, 0.012, 2.18], [-0.069, -10.853, 0.054, 0.016, 15.91]]),
    ];
    for (tip, modes) in printed {
        let profile = Profile::Constant(rho);
        let inertia = Inertia { length, mass: &profile, polar: &profile };
        let shapes = inertia.eigenmodes(Deflection::BendingY, Boundary::ClampedMass(tip), 2).expect("it bends");
        for ((shape, _), [value, slope, v, w, f]) in shapes.iter().zip(modes) {
            close(shape.derivative(length, 0), value, 0.0006);
            close(shape.derivative(length, 1), slope, 0.0006);
            close(simpson(&|x| rho * shape.derivative(x, 0), 0.0, length), v, 0.0006);
            close(simpson(&|x| rho * x * shape.derivative(x, 0), 0.0, length), w, 0.0006);
            let omega = (shape.eigenvalue() / length).powi(2) * (stiffness / rho).sqrt();
            close(omega / (2.0 * PI), f, 0.006);
        }
    }
}

#[test]
fn gauss_rules_integrate_polynomials_exactly() {
    for n in [1, 2, 5, 24, 80] {
        let rule = gauss_legendre(n);
        for degree in [0, 1, 2, 3, n, 2 * n - 1] {
            let is: f64 = rule.iter().map(|[x, w]| w * x.powi(degree as i32)).sum();
            let want = if degree % 2 == 0 { 2.0 / (degree as f64 + 1.0) } else { 0.0 };
            if degree < 2 * n {
                close(is, want, 1e-14);
            }
        }
    }
}

#[test]
fn a_table_with_slopes_is_the_beam_element_of_hermite() {
    // The element's stiffness at its free end: EI/L³ [12 −6L; −6L 4L²].
    let shape =
        |value: f64, slope: f64| Shape::Table(Table::with_slopes(vec![[0.0, 0.0, 0.0], [LENGTH, value, slope]]));
    let mut beam = beam(Boundary::ClampedFree, 1);
    beam.modes = vec![mode(shape(1.0, 0.0), 0.0), mode(shape(0.0, 1.0), 0.0)];
    let integrals = beam.integrals(beam.enough_points());
    let stiffness: Vec<f64> = integrals.pairs.iter().map(|p| p.stiffness).collect();
    let (a, b, c) = (12.0 * EI / LENGTH.powi(3), -6.0 * EI / LENGTH.powi(2), 4.0 * EI / LENGTH);
    for (is, want) in stiffness.iter().zip([a, b, b, c]) {
        close(*is, want, 1e-12 * a);
    }
    // And its mass: m/420 [156 −22L; −22L 4L²].
    let mass: Vec<f64> = integrals.pairs.iter().map(|p| p.moments.trace()).collect();
    let m = MASS * LENGTH / 420.0;
    for (is, want) in mass.iter().zip([156.0 * m, -22.0 * LENGTH * m, -22.0 * LENGTH * m, 4.0 * LENGTH * LENGTH * m]) {
        close(*is, want, 1e-14);
    }
}

#[test]
fn a_spline_through_an_eigenfunction_gives_its_curvature_back() {
    let function = Bending::first(Boundary::ClampedFree, LENGTH, MASS, 2)[1];
    let points: Vec<[f64; 2]> = (0..=40)
        .map(|i| {
            let x = LENGTH * f64::from(i) / 40.0;
            [x, function.derivative(x, 0)]
        })
        .collect();
    let table = Table::spline(&points, true);
    let most = function.derivative(0.0, 2);
    // The error of a spline's curvature is of the order of h² times the fourth derivative, (β h)² β² φ.
    let error = (function.eigenvalue / 40.0).powi(2) * most;
    for i in 0..=97 {
        let x = LENGTH * f64::from(i) / 97.0;
        close(table.derivative(x, 0), function.derivative(x, 0), 1e-5);
        close(table.derivative(x, 2), function.derivative(x, 2), error);
    }
    let jump = table.derivative(points[7][0] - 1e-12, 2) - table.derivative(points[7][0] + 1e-12, 2);
    close(jump, 0.0, 1e-6 * most);
}
