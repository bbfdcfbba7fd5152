//! Derivatives of robots some of whose links bend.

use super::derivatives::assert_close_by_torque;
use super::slopes::{of_accelerations, of_inertia, of_torques};
use super::subject::{DOUBLE, Known, Subject, bending_equals_library, grown_bending};
use gyroflex::model::Fidelity;
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::Quantity;
use gyroflex_testkit::random::RandomFlexible;
use gyroflex_testkit::tolerance::{Real, assert_close_above, norm};

/// Matrices of which a column is what `slopes` gives for a block and a coordinate.
fn by_columns(nv: usize, blocks: usize, slopes: impl Fn(usize, usize) -> [Vec<f64>; 2]) -> [Vec<f64>; 2] {
    let mut all = [(); 2].map(|()| vec![0.0; blocks * nv * nv]);
    for block in 0..blocks {
        for k in 0..nv {
            for (matrix, column) in all.iter_mut().zip(slopes(block, k)) {
                (0..nv).for_each(|row| matrix[(row * blocks + block) * nv + k] = column[row]);
            }
        }
    }
    all
}

#[test]
fn generated_inverse_derivatives_of_bending_links_are_the_slopes_of_the_library() {
    bending_equals_library(6, Quantity::InverseDerivatives, inverse_partials);
}

pub fn inverse_partials(s: &Subject) -> Vec<Known> {
    // Blocks by q, q̇, q̈, θ, θ̇, θ̈ in the order of the moving state.
    let moves = |block: usize, k: usize| core::array::from_fn(|i| (i == [0, 1, 4, 2, 3, 5][block]).then_some(k));
    let [tau_j, tau] = by_columns(s.state.qd.len(), 6, |block, k| of_torques(s, moves(block, k)));
    vec![Known::new("dtau_j", tau_j), Known::new("dtau", tau)]
}

#[test]
fn generated_forward_derivatives_of_bending_links_are_the_slopes_of_the_library() {
    for seed in 0..5 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &grown_bending().in_model(fidelity));
            let s = Subject::bending(&robot, fidelity);
            let function = s.function(Quantity::ForwardDerivatives).expect("every robot has it");
            differentiates_as_the_library::<f64>(&s, &function, 1e-11);
        }
    }
}

pub fn differentiates_as_the_library<T: Real>(s: &Subject, function: &Function, tolerance: f64) {
    let moves = |block: usize, k: usize| core::array::from_fn(|i| (i == block).then_some(k));
    let want = by_columns(s.state.qd.len(), 5, |block, k| of_accelerations(s, moves(block, k)));
    let got = s.evaluate::<T>(function, &[]);
    let of = |k: usize| got.get(k).map(|(_, x)| x.clone());
    let dqdd = of(0).expect("it is there");
    let got = [dqdd.clone(), of(1).unwrap_or(dqdd)];
    assert_close_by_torque::<T>(s, &got, &want, tolerance);
}

#[test]
fn generated_coriolis_matrices_of_bending_links_are_those_of_christoffel() {
    let mut shown = 0;
    for seed in 0..10 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &grown_bending().in_model(fidelity));
            let s = Subject::bending(&robot, fidelity);
            let Some(function) = s.function(Quantity::Coriolis) else { continue };
            shown += 1;
            are_christoffels::<f64>(&s, &function, DOUBLE);
        }
    }
    assert!(shown > 10, "{shown} roots are fixed");
}

/// `Ṁ = C + Cᵀ` and `Ṡ = C₁ + C₂ᵀ`, which with `C q̇ + C₁ θ̇ + g` for the bias is what Christoffel's symbols are.
pub fn are_christoffels<T: Real>(s: &Subject, function: &Function, tolerance: f64) {
    let x = &s.state;
    let (nv, got) = (x.qd.len(), s.evaluate::<T>(function, &[]));
    let of = |k: usize| got.get(k).map_or(vec![0.0; nv * nv], |(_, x)| x.clone());
    let [c, c1, c2] = [0, 1, 2].map(of);
    let [m_rate, s_rate] = of_inertia(s);
    let with =
        |a: &[f64], b: &[f64]| -> Vec<f64> { (0..nv * nv).map(|at| a[at] + b[at % nv * nv + at / nv]).collect() };
    let size = norm(&c).max(norm(&c1));
    assert_close_above("C + Cᵀ", s, &with(&c, &c), &m_rate, tolerance, size);
    assert_close_above("C₁ + C₂ᵀ", s, &with(&c1, &c2), &s_rate, tolerance, size);

    let values = |quantity| s.evaluate::<T>(&s.function(quantity).expect("it is there"), &[]);
    let (bias, g) = (values(Quantity::Bias), values(Quantity::Gravity)[0].1.clone());
    let times = |a: &[f64], v: &[f64]| -> Vec<f64> {
        a.chunks(nv).map(|row| row.iter().zip(v).map(|(a, v)| a * v).sum()).collect()
    };
    let (own, spun) = (times(&c, &x.qd), times(&c1, &x.thetad));
    let link: Vec<f64> = (0..nv).map(|k| own[k] + spun[k] + g[k]).collect();
    assert_close_above("C q̇ + C₁ θ̇ + g", s, &link, &bias[0].1, tolerance, size * norm(&x.qd));
    if let Some((_, motor)) = bias.get(1) {
        assert_close_above("C₂ q̇", s, &times(&c2, &x.qd), motor, tolerance, size * norm(&x.qd));
    }
}
