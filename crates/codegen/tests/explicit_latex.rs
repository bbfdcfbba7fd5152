//! Laws of explicit equations as a document.

mod arms;

use arms::document::{constants, entry, equations, evaluate};
use arms::{Arm, options, seeds, shipped};
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{File, Head, latex};
use gyroflex_codegen::explicit::{Coordinate, ExplicitModel, Options, Speed, VelocityTerm};
use gyroflex_codegen::robot::Parameter;
use gyroflex_testkit::State;
use gyroflex_testkit::tolerance::assert_close_above;
use std::collections::HashMap;

fn document(arm: &Arm) -> File {
    let model = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
    let head = Head {
        robot: arm.name.clone(),
        model: arm.fidelity.name().to_owned(),
        command: format!("gyroflex codegen {}/robot.yaml --language latex", arm.name),
    };
    latex::document(&model, &head)
}

/// What a document says of an equation, at a state: symbols by their text.
struct Read {
    equations: Vec<(String, String)>,
    constants: HashMap<String, f64>,
}

impl Read {
    fn of(text: &str) -> Self {
        Self { equations: equations(text), constants: constants(text) }
    }

    fn value(&self, name: &str, model: &ExplicitModel, state: &State) -> f64 {
        let Some((_, right)) = self.equations.iter().find(|(left, _)| left == name) else { return 0.0 };
        evaluate(right, &|symbol| self.symbol(symbol, model, state))
    }

    fn symbol(&self, symbol: &str, model: &ExplicitModel, state: &State) -> f64 {
        let (letter, index) = symbol.split_once("_{").unwrap_or((symbol, ""));
        let index = index.trim_end_matches('}');
        let digits: Vec<usize> = index.chars().filter_map(|c| c.to_digit(10)).map(|d| d as usize).collect();
        let mode = || {
            let is =
                |c: &Coordinate| matches!(c, Coordinate::Modal { of, mode, .. } if [of + 1, mode + 1] == digits[..]);
            model.coordinates().iter().position(is).expect("it is a mode")
        };
        let angle = || digits.iter().map(|d| state.q[d - 1]).sum::<f64>();
        match letter {
            "u" => self.value(symbol, model, state),
            "p" => self.constants[symbol],
            "c" => angle().cos(),
            "s" => angle().sin(),
            "q" => state.q[digits[0] - 1],
            "\\dotq" => state.qd[digits[0] - 1],
            "\\dot\\theta" => state.thetad[digits[0] - 1],
            "\\eta" => state.q[mode()],
            "\\dot\\eta" => state.qd[mode()],
            _ => panic!("`{symbol}` is not known"),
        }
    }
}

/// Six digits are printed, and terms of an entry may cancel.
const DIGITS: f64 = 2e-5;

#[test]
fn document_is_the_model() {
    let mut arms = vec![shipped::two_link(false), shipped::two_link(true)];
    for fidelity in Fidelity::ALL {
        arms.extend([shipped::planar_2r(fidelity), shipped::puma560(fidelity, 1.0)]);
    }
    arms.extend(seeds(12).map(|seed| Arm::new(seed, &options(2..=3))));
    for arm in arms {
        let model = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
        let text = document(&arm).text;
        let read = Read::of(&text);
        let state = arm.state(3);
        let n = model.nv();
        let (layout, context) = (model.layout(), format!("{} `{}`", arm.name, arm.fidelity.name()));
        let pair = |letter: &str, i: usize, j: usize| format!("{letter}_{{{}{}}}", i + 1, j + 1);
        let whole = read.equations.iter().find(|(left, _)| left == "M").map(|(_, matrix)| matrix);
        let mut compared = 0;
        for i in 0..n {
            for j in i..n {
                let want = model.mass(i, j).value(layout, &state.q);
                let symbol = |symbol: &str| read.symbol(symbol, &model, &state);
                let got = match whole {
                    Some(matrix) => evaluate(entry(matrix, i, j), &symbol),
                    None => read.value(&pair("M", i, j), &model, &state),
                };
                let context = format!("{i} {j}, {context}");
                assert_close_above("M", &context, &[got], &[want], DIGITS, model.mass(i, j).largest());
                compared += 1;
            }
            for j in 0..n {
                let want = model.coupling(i, j).value(layout, &state.q);
                let got = read.value(&pair("S", i, j), &model, &state);
                assert_close_above(
                    "S",
                    &format!("{i} {j}, {context}"),
                    &[got],
                    &[want],
                    DIGITS,
                    model.coupling(i, j).largest(),
                );
            }
            let size = |terms: &[VelocityTerm]| terms.iter().map(|t| t.factor.largest()).fold(0.0, f64::max);
            let value = |terms: &[VelocityTerm]| -> f64 {
                let second = |t: &VelocityTerm| match t.second {
                    Speed::Link(k) => state.qd[k],
                    Speed::Motor(k) => state.thetad[k],
                };
                terms.iter().map(|t| t.factor.value(layout, &state.q) * state.qd[t.first] * second(t)).sum()
            };
            for (name, terms) in [
                (format!("h_{{{}}}", i + 1), model.velocity_terms(i)),
                (format!("h_{{\\theta{}}}", i + 1), model.motor_velocity_terms(i)),
            ] {
                let got = read.value(&name, &model, &state);
                let scale = 4.0 * size(&terms);
                assert_close_above(&name, &context, &[got], &[value(&terms)], DIGITS, scale);
                compared += usize::from(!terms.is_empty());
            }
            let g = model.gravity(i);
            let got = read.value(&format!("g_{{{}}}", i + 1), &model, &state);
            assert_close_above("g", &context, &[got], &[g.value(layout, &state.q)], DIGITS, g.largest());
        }
        assert!(compared > 0, "nothing to compare of {context}");
    }
}

#[test]
fn kept_parameters_stand_by_their_names() {
    let arm = shipped::planar_2r(Fidelity::Complete);
    let robot = arm.robot();
    let names = ["gravity", "link2.mass", "joint1.stiffness", "joint2.rotor_inertia", "joint2.gear_ratio"];
    let kept = names.map(|name| Parameter::of(name, &robot).expect("the robot has it"));
    let options = Options { kept: kept.to_vec(), ..Options::default() };
    let model = ExplicitModel::of(&robot, &options).expect("nothing in it is not explicit");
    let head = Head { robot: arm.name.clone(), model: "complete".to_owned(), command: "none".to_owned() };
    let text = latex::document(&model, &head).text;
    for symbol in ["m_{2}", "gm_{2}c_{12}", "K_{1}", "J_{2}N_{2}", "N_{2}^{2}J_{2}"] {
        assert!(
            text.contains(symbol) || text.contains(&symbol.replace("N_{2}^{2}J_{2}", "J_{2}N_{2}^{2}")),
            "no `{symbol}` in {text}"
        );
    }
    assert!(!constants(&text).contains_key("K_{1}"), "what is kept has no value");
}

#[test]
fn names_with_signs_of_latex_are_text() {
    let mut arm = shipped::planar_2r(Fidelity::Rigid);
    arm.name = "a_b%c&d#e$f{g}~h^i\\j".to_owned();
    let text = document(&arm).text;
    assert!(text.contains(r"a\_b\%c\&d\#e\$f\{g\}\textasciitilde{}h\textasciicircum{}i\textbackslash{}j"), "{text}");
}
