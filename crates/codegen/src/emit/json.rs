//! The graph itself, for programs that make something of their own of it.
//!
//! One object:
//!
//! | key | what it holds |
//! |---|---|
//! | `format` | `"gyroflex-graph"` |
//! | `format_version` | 1; it counts up when what is written here changes its meaning |
//! | `gyroflex`, `robot`, `model`, `command` | the version, and what the file is about and made by |
//! | `functions` | the functions, in order |
//!
//! A function:
//!
//! | key | what it holds |
//! |---|---|
//! | `name`, `meaning` | a name, and a sentence |
//! | `arguments` | in order: `name`, `length`, `meaning` with the unit |
//! | `outputs` | in order: `name`, `shape` (`[length]`, or `[rows, columns]`), `meaning`, and `entries`, by rows: numbers of nodes |
//! | `nodes` | operands before what is made of them; a node's number is its place, from 0 |
//! | `operations` | how many `additions` (subtractions and changes of sign among them), `multiplications`, `divisions`, `circular`, `others` |
//! | `depth` | the longest chain of operations that wait for each other |
//!
//! A node is an array of a word and what it works on, which is numbers of nodes but for the first two:
//!
//! | node | value |
//! |---|---|
//! | `["number", x]` | `x`, which reads back as the same double; `"inf"`, `"-inf"` and `"nan"` are strings |
//! | `["input", name, k]` | entry `k` of an argument |
//! | `["neg", a]` | `−a` |
//! | `["add", a, b]`, `["sub", a, b]`, `["mul", a, b]`, `["div", a, b]` | `a + b`, `a − b`, `a b`, `a / b` |
//! | `["sin", a]`, `["cos", a]`, `["sqrt", a]`, `["tanh", a]`, `["exp", a]` | the function of `a` |
//! | `["atan2", a, b]` | the angle of the point with ordinate `a` and abscissa `b` |
//! | `["select", a, b, c, d]` | `c` where `a < b`, else `d` |

use super::{File, Head};
use crate::function::Function;
use crate::graph::{Id, Node};
use serde_json::{Value, json};

const FORMAT_VERSION: u32 = 1;

pub(super) fn files(head: &Head, functions: &[Function], stem: &str) -> Vec<File> {
    let functions: Vec<String> = functions.iter().map(function).collect();
    let text = format!(
        "{{\n\"format\": \"gyroflex-graph\",\n\"format_version\": {FORMAT_VERSION},\n\"gyroflex\": {},\n\"robot\": {},\n\
         \"model\": {},\n\"command\": {},\n\"functions\": [\n{}\n]\n}}\n",
        json!(env!("CARGO_PKG_VERSION")),
        json!(head.robot),
        json!(head.model),
        json!(head.command),
        functions.join(",\n")
    );
    vec![File { name: format!("{stem}.json"), text }]
}

/// A function, a node a line.
fn function(function: &Function) -> String {
    let reached = function.graph.reached_from(function.results());
    let mut place = vec![0_usize; reached.len()];
    let mut nodes = Vec::new();
    for (i, node) in function.graph.nodes().iter().enumerate().filter(|(i, _)| reached[*i]) {
        place[i] = nodes.len();
        nodes.push(self::node(function, *node, |id| place[id.index()]).to_string());
    }
    let arguments = function.arguments.iter();
    let arguments: Value =
        arguments.map(|a| json!({ "name": a.name, "length": a.len, "meaning": a.meaning })).collect();
    let outputs: Value = function
        .outputs
        .iter()
        .map(|o| {
            let shape = o.columns.map_or(vec![o.rows], |columns| vec![o.rows, columns]);
            let entries: Vec<usize> = o.entries.iter().map(|id| place[id.index()]).collect();
            json!({ "name": o.name, "shape": shape, "meaning": o.meaning, "entries": entries })
        })
        .collect();
    let n = function.operations();
    let operations = json!({
        "additions": n.additions,
        "multiplications": n.multiplications,
        "divisions": n.divisions,
        "circular": n.circular,
        "others": n.others,
    });
    format!(
        "{{\n\"name\": {},\n\"meaning\": {},\n\"arguments\": {arguments},\n\"outputs\": {outputs},\n\"operations\": {operations},\n\
         \"depth\": {},\n\"nodes\": [\n{}\n]\n}}",
        json!(function.name),
        json!(function.meaning),
        function.depth(),
        nodes.join(",\n")
    )
}

fn node(function: &Function, node: Node, place: impl Fn(Id) -> usize) -> Value {
    match node {
        Node::Constant(bits) => json!(["number", number(f64::from_bits(bits))]),
        Node::Input(k) => {
            let (argument, k) = function.argument_of(k as usize);
            json!(["input", argument.name, k])
        }
        Node::Neg(a) => json!(["neg", place(a)]),
        Node::Add(a, b) => json!(["add", place(a), place(b)]),
        Node::Sub(a, b) => json!(["sub", place(a), place(b)]),
        Node::Mul(a, b) => json!(["mul", place(a), place(b)]),
        Node::Div(a, b) => json!(["div", place(a), place(b)]),
        Node::Call(f, a) => json!([f.name(), place(a)]),
        Node::Atan2(a, b) => json!(["atan2", place(a), place(b)]),
        Node::Select(all) => {
            let [a, b, c, d] = all.map(place);
            json!(["select", a, b, c, d])
        }
    }
}

/// A number; JSON has none that is infinite or nothing.
fn number(x: f64) -> Value {
    match x {
        x if x.is_finite() => json!(x),
        x if x.is_nan() => json!("nan"),
        x if x > 0.0 => json!("inf"),
        _ => json!("-inf"),
    }
}
