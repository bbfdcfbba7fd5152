//! A function cut into parts for several processors (Cetinkunt and Book 1988, advantage 3 of explicit equations).
//!
//! The results are dealt out in order, so that neighbours, which share most, stay together; where to cut is found by balancing.
//! What several parts need is either computed by each of them or once before them, whichever is over sooner. No part writes what
//! another one reads: nothing is waited for but the ends.

mod cost;

use crate::function::{Argument, Function, Output};
use crate::graph::{Graph, Id};
use cost::costs;
pub use cost::{HAND_OVER, Prediction};

/// A function in parts.
#[derive(Clone, Debug)]
pub struct Split {
    /// What several parts need, computed before them; its output `shared` is the last argument of each. None where nothing is.
    pub shared: Option<Function>,
    /// The parts, each with one output, `part`.
    pub parts: Vec<Function>,
    /// Where the entries of each part's output go: output and entry of the whole function.
    pub places: Vec<Vec<(usize, usize)>>,
    /// What to expect of it.
    pub prediction: Prediction,
}

/// How often cuts are moved to even out the parts.
const ROUNDS: usize = 24;

/// Cuts a function for so many processors, one at least.
pub fn split(function: &Function, processors: usize) -> Split {
    let processors = processors.max(1);
    let places: Vec<(usize, usize)> =
        (0..function.outputs.len()).flat_map(|o| (0..function.outputs[o].entries.len()).map(move |e| (o, e))).collect();
    let cost = costs(&function.graph);
    let by_rows = balanced(function, &cost, places.clone(), processors);
    let by_columns = balanced(function, &cost, transposed(function, &places), processors);
    let apart = |parts: &[Vec<(usize, usize)>]| Prediction::of(function, &cost, parts, false);
    let parts = if apart(&by_columns).parallel() < apart(&by_rows).parallel() { by_columns } else { by_rows };
    let (twice, once) = (Prediction::of(function, &cost, &parts, false), Prediction::of(function, &cost, &parts, true));
    let together = once.parallel() < twice.parallel();
    write(function, parts, if together { once } else { twice }, together)
}

/// The places with matrices by columns.
fn transposed(function: &Function, places: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let mut sorted = places.to_vec();
    sorted.sort_by_key(|&(o, e)| {
        let columns = function.outputs[o].columns.unwrap_or(1).max(1);
        (o, e % columns, e / columns)
    });
    sorted
}

/// Cuts a sequence of results where all parts cost about the same.
fn balanced(
    function: &Function,
    cost: &[f64],
    places: Vec<(usize, usize)>,
    processors: usize,
) -> Vec<Vec<(usize, usize)>> {
    let n = places.len();
    let mut cuts: Vec<usize> = (0..=processors).map(|k| k * n / processors).collect();
    let parts_of = |cuts: &[usize]| cuts.windows(2).map(|w| places[w[0]..w[1]].to_vec()).collect::<Vec<_>>();
    let mut best = (f64::INFINITY, cuts.clone());
    for round in 0..ROUNDS {
        let prediction = Prediction::of(function, cost, &parts_of(&cuts), false);
        let longest = prediction.parts.iter().copied().fold(0.0, f64::max);
        if longest < best.0 {
            best = (longest, cuts.clone());
        }
        // Parts that cost more than their share become shorter in proportion, less and less from round to round.
        let mean = prediction.parts.iter().sum::<f64>() / processors as f64;
        let step = 0.6 / (1.0 + 0.15 * round as f64);
        let sizes: Vec<f64> = (0..processors)
            .map(|k| (cuts[k + 1] - cuts[k]).max(1) as f64 * (mean / prediction.parts[k].max(1.0)).powf(step))
            .collect();
        let all: f64 = sizes.iter().sum();
        let mut sum = 0.0;
        for k in 1..processors {
            sum += sizes[k - 1];
            cuts[k] = ((sum / all * n as f64).round() as usize).clamp(cuts[k - 1], n);
        }
    }
    parts_of(&best.1)
}

/// The functions of all parts.
fn write(function: &Function, parts: Vec<Vec<(usize, usize)>>, prediction: Prediction, together: bool) -> Split {
    let entry = |&(o, e): &(usize, usize)| function.outputs[o].entries[e];
    let graph = &function.graph;
    let kept = if together {
        handed_on(graph, &parts.iter().map(|p| p.iter().map(entry).collect()).collect::<Vec<_>>())
    } else {
        Vec::new()
    };
    let vector = |name: &str, meaning: &str, entries: Vec<Id>| Output {
        name: name.to_owned(),
        rows: entries.len(),
        columns: None,
        meaning: meaning.to_owned(),
        entries,
    };
    let shared = (!kept.is_empty()).then(|| Function {
        name: format!("{}_shared", function.name),
        meaning: format!("What several parts of `{}` need.", function.name),
        outputs: vec![vector("shared", "what several parts need", kept.clone())],
        ..function.clone()
    });
    let part = |(k, places): (usize, &Vec<(usize, usize)>)| {
        let mut arguments = function.arguments.clone();
        if !kept.is_empty() {
            let meaning = "what several parts need".to_owned();
            arguments.push(Argument { name: "shared".to_owned(), len: kept.len(), meaning });
        }
        let (graph, entries) = beyond(graph, &kept, function.inputs(), places.iter().map(entry));
        Function {
            name: format!("{}_part_{k}", function.name),
            meaning: format!("Part {k} of `{}`.", function.name),
            arguments,
            outputs: vec![vector("part", "results of this part", entries)],
            graph,
        }
    };
    let functions = parts.iter().enumerate().map(part).collect();
    Split { shared, parts: functions, places: parts, prediction }
}

/// What is computed for several parts and used by one of them as it is.
fn handed_on(graph: &Graph, parts: &[Vec<Id>]) -> Vec<Id> {
    let shared = cost::shared(graph, parts);
    let mut kept = vec![false; graph.len()];
    for entries in parts {
        let reached = graph.reached_from(entries.iter().copied());
        entries.iter().for_each(|id| kept[id.index()] |= shared[id.index()]);
        for (_, node) in graph.nodes().iter().enumerate().filter(|(i, _)| reached[*i] && !shared[*i]) {
            node.operands().for_each(|o| kept[o.index()] |= shared[o.index()]);
        }
    }
    (0..graph.len()).filter(|i| kept[*i]).map(|i| Id(i as u32)).collect()
}

/// The graph of some results in which `known` expressions are inputs, counted from `first`.
fn beyond(graph: &Graph, known: &[Id], first: usize, results: impl Iterator<Item = Id>) -> (Graph, Vec<Id>) {
    let results: Vec<Id> = results.collect();
    let mut new = Graph::new();
    let mut image: Vec<Option<Id>> = vec![None; graph.len()];
    for (k, id) in known.iter().enumerate() {
        image[id.index()] = Some(new.input(first + k));
    }
    // Only what is not known is followed to its operands.
    let mut needed = vec![false; graph.len()];
    results.iter().for_each(|id| needed[id.index()] = true);
    for i in (0..graph.len()).rev() {
        if needed[i] && image[i].is_none() {
            graph.nodes()[i].operands().for_each(|o| needed[o.index()] = true);
        }
    }
    for i in 0..graph.len() {
        if needed[i] && image[i].is_none() {
            let id = new.rebuild(graph.nodes()[i], |o| image[o.index()].expect("operands come first"));
            image[i] = Some(id);
        }
    }
    let entries = results.iter().map(|id| image[id.index()].expect("results are needed")).collect();
    (new, entries)
}
