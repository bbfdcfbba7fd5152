//! JSON: the graph, read back, gives the same bits.

use super::cases::mixed;
use gyroflex::Scalar;
use gyroflex_codegen::emit::{Language, Precision, files};
use serde_json::Value;

/// Evaluates a function as the documentation of the format says.
fn evaluate(function: &Value, inputs: &[f64]) -> Vec<Vec<f64>> {
    let text = |v: &Value| v.as_str().expect("it is a word").to_owned();
    let index = |v: &Value| v.as_u64().expect("it is a number of a node") as usize;
    let list = |v: &Value| v.as_array().expect("it is a list").clone();
    let argument = |name: &Value, k: usize| {
        let before = list(&function["arguments"]);
        let first = before.iter().take_while(|a| a["name"] != *name).map(|a| index(&a["length"])).sum::<usize>();
        inputs[first + k]
    };
    let mut values: Vec<f64> = Vec::new();
    for node in list(&function["nodes"]) {
        let at = |k: usize| values[index(&node[k])];
        let value = match text(&node[0]).as_str() {
            "number" => node[1].as_f64().unwrap_or_else(|| text(&node[1]).parse().expect("inf or nan")),
            "input" => argument(&node[1], index(&node[2])),
            "neg" => -at(1),
            "add" => at(1) + at(2),
            "sub" => at(1) - at(2),
            "mul" => at(1) * at(2),
            "div" => at(1) / at(2),
            "sin" => at(1).sin_cos_pair().0,
            "cos" => at(1).sin_cos_pair().1,
            "sqrt" => at(1).sqrt(),
            "tanh" => at(1).tanh(),
            "exp" => at(1).exp(),
            "atan2" => at(1).atan2(at(2)),
            "select" => {
                if at(1) < at(2) {
                    at(3)
                } else {
                    at(4)
                }
            }
            other => panic!("no node is called {other}"),
        };
        values.push(value);
    }
    let entries = |o: &Value| list(&o["entries"]).iter().map(|k| values[index(k)]).collect::<Vec<f64>>();
    list(&function["outputs"]).iter().map(entries).collect()
}

/// The library's sine and cosine, which the graph is evaluated with.
trait Circular {
    fn sin_cos_pair(self) -> (f64, f64);
}

impl Circular for f64 {
    fn sin_cos_pair(self) -> (f64, f64) {
        Scalar::sin_cos(self)
    }
}

#[test]
fn graphs_read_back_give_the_same_bits() {
    for case in mixed(0..8) {
        let files = files(Language::Json, &case.head(), &case.functions, Precision::Double, "graph");
        let whole: Value = serde_json::from_str(&files[0].text).expect("it is JSON");
        assert_eq!(whole["format"], "gyroflex-graph");
        for ((function, points), json) in
            case.functions.iter().zip(&case.points).zip(whole["functions"].as_array().expect("a list"))
        {
            assert_eq!(json["name"], function.name.as_str());
            for (o, output) in function.outputs.iter().enumerate() {
                let shape = output.columns.map_or(vec![output.rows], |columns| vec![output.rows, columns]);
                assert_eq!(json["outputs"][o]["shape"], serde_json::json!(shape));
            }
            for inputs in points.inputs.iter().take(20) {
                let (got, want) = (evaluate(json, inputs), function.evaluate::<f64>(inputs));
                let bits = |all: &[Vec<f64>]| all.concat().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&got), bits(&want), "{} of {}", function.name, case.about);
            }
        }
    }
}
