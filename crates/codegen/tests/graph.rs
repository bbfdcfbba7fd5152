//! What the constructors of a graph simplify, and its derivatives.

use gyroflex::Scalar;
use gyroflex_codegen::graph::{Elementary, Graph, Id, Node};
use gyroflex_testkit::Dual;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A random expression of three inputs, made of every operation.
fn random(graph: &mut Graph, rng: &mut ChaCha8Rng, depth: usize) -> Id {
    if depth == 0 {
        return match rng.random_range(0..5) {
            0 => graph.constant([0.0, 1.0, -1.0, 0.5, core::f64::consts::FRAC_PI_2][rng.random_range(0..5)]),
            k => graph.input(k as usize % 3),
        };
    }
    let (a, b) = (random(graph, rng, depth - 1), random(graph, rng, depth - 1));
    match rng.random_range(0..10) {
        0 | 1 => graph.add(a, b),
        2 | 3 => graph.sub(a, b),
        4 | 5 => graph.mul(a, b),
        6 => graph.neg(a),
        7 => graph.call(Elementary::Sin, a),
        8 => graph.call(Elementary::Cos, a),
        _ => graph.call(Elementary::Tanh, a),
    }
}

#[test]
fn zeros_ones_and_signs_vanish() {
    let mut g = Graph::new();
    let (x, y) = (g.input(0), g.input(1));
    let (zero, one) = (g.constant(0.0), g.constant(1.0));
    assert_eq!([g.add(x, zero), g.sub(x, zero), g.mul(x, one), g.div(x, one)], [x; 4]);
    assert_eq!([g.mul(x, zero), g.sub(x, x), g.div(zero, x)], [zero; 3]);
    let minus = g.neg(x);
    assert_eq!(g.neg(minus), x);
    let (product, minus_product) = (g.mul(x, y), g.mul(minus, y));
    assert_eq!(minus_product, g.neg(product));
    assert_eq!(g.add(y, minus), g.sub(y, x));
    assert_eq!(g.mul(x, y), g.mul(y, x));
}

#[test]
fn right_angles_cost_nothing_and_parallel_axes_add_up() {
    let mut g = Graph::new();
    let (x, y) = (g.input(0), g.input(1));
    let right = g.constant(core::f64::consts::FRAC_PI_2);
    let beyond = g.add(x, right);
    let ((sin, cos), (sin_beyond, cos_beyond)) = (g.sin_cos(x), g.sin_cos(beyond));
    assert_eq!((sin_beyond, cos_beyond), (cos, g.neg(sin)));
    let ((sx, cx), (sy, cy)) = (g.sin_cos(x), g.sin_cos(y));
    let (a, b) = (g.mul(sx, cy), g.mul(cx, sy));
    let (c, d) = (g.mul(cx, cy), g.mul(sx, sy));
    let (sum, difference) = (g.add(x, y), g.sub(x, y));
    let sum_of = [g.call(Elementary::Sin, sum), g.call(Elementary::Cos, sum)];
    assert_eq!([g.add(a, b), g.sub(c, d)], sum_of);
    let difference_of = [g.call(Elementary::Sin, difference), g.call(Elementary::Cos, difference)];
    assert_eq!([g.sub(a, b), g.add(c, d)], difference_of);
}

/// An interpreter that simplifies nothing.
fn value(graph: &Graph, id: Id, inputs: &[f64]) -> f64 {
    let at = |id: Id| value(graph, id, inputs);
    match graph.node(id) {
        Node::Constant(bits) => f64::from_bits(bits),
        Node::Input(k) => inputs[k as usize],
        Node::Neg(a) => -at(a),
        Node::Add(a, b) => at(a) + at(b),
        Node::Sub(a, b) => at(a) - at(b),
        Node::Mul(a, b) => at(a) * at(b),
        Node::Div(a, b) => at(a) / at(b),
        Node::Call(f, a) => f.of(at(a)),
        Node::Atan2(a, b) => at(a).atan2(at(b)),
        Node::Select([a, b, c, d]) => {
            if at(a) < at(b) {
                at(c)
            } else {
                at(d)
            }
        }
    }
}

#[test]
fn rebuilt_expressions_have_the_same_value() {
    for seed in 0..500 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut g = Graph::new();
        let id = random(&mut g, &mut rng, 6);
        let mut again = Graph::new();
        let mut image: Vec<Id> = Vec::new();
        for i in 0..g.len() {
            let new = again.rebuild(g.nodes()[i], |o| image[o.index()]);
            image.push(new);
        }
        let x = [0.3, -0.8, 1.1];
        let (a, b) = (value(&g, id, &x), value(&again, image[id.index()], &x));
        assert!((a - b).abs() <= 1e-12 * (1.0 + a.abs()), "seed {seed}: {a} and {b}");
    }
}

#[test]
fn derivatives_are_those_of_dual_numbers() {
    for seed in 0..500 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut g = Graph::new();
        let id = random(&mut g, &mut rng, 5);
        let x = [0.3, -0.8, 1.1];
        for k in 0..3 {
            let by = g.input(k);
            let wanted = g.reached_from([id]);
            let derivatives = g.derivatives(by, &wanted);
            let dual: Vec<Dual> = (0..3).map(|j| Dual::new(x[j], f64::from(u8::from(j == k)))).collect();
            let want = g.evaluate(&dual, None)[id.index()].slope;
            let got = value(&g, derivatives[id.index()], &x);
            assert!((got - want).abs() <= 1e-11 * (1.0 + want.abs()), "seed {seed}, input {k}: {got} and {want}");
        }
    }
}

#[test]
fn symbols_trace_what_numbers_compute() {
    use gyroflex_codegen::sym::{Sym, trace};
    fn law<T: Scalar>(x: T, y: T) -> T {
        let (s, c) = (x * y).sin_cos();
        x.select_less(y, s.exp().tanh() / (c * c + T::from_f64(2.0)).sqrt(), y.atan2(x) - s)
    }
    let (result, graph) = trace(|| law(Sym::input(0), Sym::input(1)));
    for (x, y) in [(0.2, 0.9), (0.9, 0.2), (-0.4, 0.1), (1.5, -2.0)] {
        let got = graph.evaluate(&[x, y], None)[result.id().index()];
        let want: f64 = law(x, y);
        assert!((got - want).abs() <= 4e-16, "{got} and {want}");
    }
}
