//! Functions that generated code brings along, since neither Rust without `std` nor C without a library has them.
//!
//! They are templates beside this file, the same formulas in each language, without a branch, so that compilers run several side
//! by side. Names between `@` stand for numbers of a precision. Sine and cosine are those of the library
//! (`crates/core/src/trig.rs`): Cody and Waite's reduction and polynomials fitted at Chebyshev points. The others:
//!
//! * square root: Newton's iteration for `1/√x` from the bits of `x`, and a last step on the remainder `x − s²`;
//! * exponential: `2ᵏ eʳ` with `|r| ≤ ln 2 / 2`, its Taylor series, and `2ᵏ` in two factors, so that nothing overflows early;
//! * hyperbolic tangent: `m/(m + 2)` of `m = e^{2|x|} − 1`, taken from the same series without cancellation;
//! * arc of a point: the smaller by the larger coordinate, less the nearest eighth, whose arc is in a table; a Taylor series of what
//!   is left.
//!
//! Each is within two units in the last place (`tests/languages` shows it).

use super::Precision;
use super::body::marked;
use crate::graph::{Elementary, Node};
use crate::program::{Program, Statement, Step};
use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, LN_2, LOG2_E, PI};

/// What the functions of a file use of what comes along.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Uses {
    pub mul_add: bool,
    pub mul_sub: bool,
    pub neg_mul_add: bool,
    pub sin_cos: bool,
    pub sqrt: bool,
    pub exp: bool,
    pub tanh: bool,
    pub atan2: bool,
    pub select: bool,
}

impl Uses {
    pub fn of(programs: &[Program]) -> Self {
        let mut uses = Self::default();
        for program in programs {
            uses.sin_cos |= !program.angles.is_empty();
            for statement in program.before.iter().chain(&program.statements) {
                uses.note(statement);
            }
        }
        // Series are sums of products.
        uses.mul_add |= uses.sin_cos | uses.exp | uses.tanh | uses.atan2 | uses.sqrt;
        uses.neg_mul_add |= uses.sqrt | uses.atan2;
        uses
    }

    fn note(&mut self, statement: &Statement) {
        match statement {
            Statement::SinCos(_) => self.sin_cos = true,
            Statement::Let(_, step) => match step {
                Step::MulAdd(..) => self.mul_add = true,
                Step::MulSub(..) => self.mul_sub = true,
                Step::SubMul(..) => self.neg_mul_add = true,
                Step::Plain(Node::Call(Elementary::Sqrt, _)) => self.sqrt = true,
                Step::Plain(Node::Call(Elementary::Exp, _)) => self.exp = true,
                Step::Plain(Node::Call(Elementary::Tanh, _)) => self.tanh = true,
                Step::Plain(Node::Atan2(..)) => self.atan2 = true,
                Step::Plain(Node::Select(_)) => self.select = true,
                Step::Plain(_) => {}
            },
        }
    }
}

/// Numbers of the sine and cosine of a precision, as in the library.
struct Circular {
    limit: &'static str,
    round: f64,
    half_pi: [f64; 3],
    sin: &'static [f64],
    cos: &'static [f64],
}

const DOUBLE: Circular = Circular {
    limit: "a million",
    round: 6755399441055744.0,
    half_pi: [1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21],
    sin: &[
        -0.16666666666666666,
        0.008333333333330946,
        -0.0001984126983675497,
        2.755731610068303e-6,
        -2.5051131455427946e-8,
        1.591810123027412e-10,
    ],
    cos: &[
        0.041666666666666664,
        -0.0013888888888887395,
        2.4801587298763433e-5,
        -2.7557317270560326e-7,
        2.0876146024689747e-9,
        -1.1382614868556325e-11,
    ],
};

const SINGLE: Circular = Circular {
    limit: "ten thousand",
    round: 12582912.0,
    half_pi: [1.5703125, 0.0004837513, 7.54979e-8],
    sin: &[-0.16666664, 0.008332748, -0.00019587841],
    cos: &[0.041666664, -0.0013888302, 2.4547891e-5],
};

/// A language as the templates need it: its literals, and the statements of Horner's scheme.
pub(super) struct Dialect {
    pub precision: Precision,
    /// A number.
    pub number: fn(f64, Precision) -> String,
    /// One step of Horner's scheme: the statement that takes `p` to the expression, or that makes it, if it is the first.
    pub step: fn(first: bool, value: &str) -> String,
    /// Space before every statement.
    pub indent: &'static str,
}

impl Dialect {
    /// A template with its numbers put in.
    pub fn fill(&self, template: &str) -> String {
        let circular = match self.precision {
            Precision::Single => SINGLE,
            Precision::Double => DOUBLE,
        };
        let n = |x: f64| (self.number)(x, self.precision);
        let single = self.precision == Precision::Single;
        let terms = |few: i32, many: i32| if single { few } else { many };
        let mut factorial = 1.0;
        let exp: Vec<f64> = (2..=terms(7, 13))
            .map(|k| {
                factorial *= f64::from(k);
                1.0 / factorial
            })
            .collect();
        let atan: Vec<f64> =
            (1..=terms(3, 7)).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 } / f64::from(2 * k + 1)).collect();
        let arcs: Vec<String> = (0..=8).map(|k| n((f64::from(k) / 8.0).atan())).collect();
        // What double precision itself lacks of ln 2 counts times k.
        let short = if single { 355.0 / 512.0 } else { f64::from_bits(LN_2.to_bits() & (!0 << 21)) };
        let ln2 = [short, (LN_2 - short) + 2.3190468138462996e-17];
        let pick =
            |single_is: &'static str, double_is: &'static str| (if single { single_is } else { double_is }).to_owned();
        let replacements: Vec<(&str, String)> = vec![
            ("@limit@", circular.limit.to_owned()),
            ("@round@", n(circular.round)),
            ("@two_by_pi@", n(FRAC_2_PI)),
            ("@half_pi_1@", n(circular.half_pi[0])),
            ("@half_pi_2@", n(circular.half_pi[1])),
            ("@half_pi_3@", n(circular.half_pi[2])),
            ("@sin@\n", self.horner(circular.sin, "z")),
            ("@cos@\n", self.horner(circular.cos, "z")),
            ("@exp@\n", self.horner(&exp, "r")),
            ("@atan@\n", self.horner(&atan, "z")),
            ("@arcs@", arcs.join(", ")),
            ("@log2_e@", n(LOG2_E)),
            // ln 2 in two parts, the first short enough for exact products.
            ("@ln2_1@", n(ln2[0])),
            ("@ln2_2@", n(ln2[1])),
            ("@least@", n(terms(-110, -760).into())),
            ("@most@", n(terms(100, 720).into())),
            ("@one@", n(terms(20, 40).into())),
            ("@half@", n(0.5)),
            ("@1@", n(1.0)),
            ("@1.5@", n(1.5)),
            ("@2@", n(2.0)),
            ("@8@", n(8.0)),
            ("@0@", n(0.0)),
            ("@pi@", n(PI)),
            ("@pi_by_2@", n(FRAC_PI_2)),
            ("@magic@", pick("0x5f37_59df", "0x5fe6_eb50_c7b5_37a9")),
            ("@c_magic@", pick("0x5f3759df", "0x5fe6eb50c7b537a9")),
            ("@fma@", pick("__builtin_fmaf", "__builtin_fma")),
            ("@newton@", pick("3", "4")),
            ("@mantissa@", pick("23", "52")),
            ("@bias@", pick("127", "1023")),
            ("@last@", pick("31", "63")),
            ("@sign_place@", pick("30", "62")),
            ("@width@", pick("32", "64")),
            ("@float@", pick("f32", "f64")),
            ("@real@", pick("float", "double")),
        ];
        replacements.iter().fold(template.to_owned(), |text, (name, value)| text.replace(name, value))
    }

    /// Statements that leave `c₀ + c₁ x + c₂ x² + …` in `p`.
    fn horner(&self, coefficients: &[f64], x: &str) -> String {
        let mut lines = Vec::new();
        for (i, c) in coefficients.iter().rev().enumerate() {
            let c = (self.number)(*c, self.precision);
            let value = if i == 0 { c } else { format!("mul_add(p, {x}, {c})") };
            lines.push((self.step)(i == 0, &value));
        }
        marked(&lines, self.indent)
    }
}
