//! Arguments and results of a function of an explicit model.

use super::ExplicitModel;
use super::compose::Composer;
use crate::function::{Argument, Function, Output};
use crate::sym::{Sym, trace};
use gyroflex::Scalar;

/// A function under way.
pub(super) struct Signature<'a> {
    pub(super) model: &'a ExplicitModel,
    arguments: Vec<Argument>,
    outputs: Vec<(Output, Vec<Sym>)>,
    inputs: usize,
}

/// The function whose arguments and results `build` asks for.
pub(super) fn signed(model: &ExplicitModel, name: &str, meaning: &str, build: fn(&mut Signature)) -> Function {
    let ((arguments, outputs), graph) = trace(|| {
        let mut signature = Signature { model, arguments: Vec::new(), outputs: Vec::new(), inputs: 0 };
        build(&mut signature);
        (signature.arguments, signature.outputs)
    });
    let outputs = outputs
        .into_iter()
        .map(|(output, entries)| Output { entries: entries.into_iter().map(Sym::id).collect(), ..output })
        .collect();
    Function { name: name.to_owned(), meaning: meaning.to_owned(), arguments, outputs, graph }
}

impl<'a> Signature<'a> {
    pub(super) fn argument(&mut self, name: &str, len: usize, meaning: &str) -> Vec<Sym> {
        self.arguments.push(Argument { name: name.to_owned(), len, meaning: meaning.to_owned() });
        let first = self.inputs;
        self.inputs += len;
        (first..self.inputs).map(Sym::input).collect()
    }

    /// An argument of motors; of a robot without elastic joints it is none.
    pub(super) fn of_motors(&mut self, name: &str, meaning: &str) -> Vec<Sym> {
        let n = self.model.nv();
        if self.model.is_elastic() { self.argument(name, n, meaning) } else { vec![Sym::zero(); n] }
    }

    pub(super) fn positions(&mut self) -> Vec<Sym> {
        let meaning = match self.model.modes() {
            0 => "joint positions [rad or m]",
            _ => "joint positions [rad or m], then modal coordinates [m]",
        };
        self.argument("q", self.model.nv(), meaning)
    }

    pub(super) fn velocities(&mut self) -> Vec<Sym> {
        self.argument("qd", self.model.nv(), "joint velocities [rad/s or m/s]")
    }

    /// `q, q̇, θ, θ̇`.
    pub(super) fn state(&mut self) -> [Vec<Sym>; 4] {
        [
            self.positions(),
            self.velocities(),
            self.of_motors("theta", "motor positions, reflected [rad or m]"),
            self.of_motors("thetad", "motor velocities, reflected [rad/s or m/s]"),
        ]
    }

    /// Writes sums at positions; kept parameters are the last argument.
    pub(super) fn composer(&mut self, q: &[Sym]) -> Composer<'a> {
        let kept = &self.model.options().kept;
        let parameters = if kept.is_empty() {
            Vec::new()
        } else {
            let say: Vec<String> = kept.iter().map(|p| format!("{} [{}]", p.name(), p.unit())).collect();
            self.argument("parameters", kept.len(), &say.join("; "))
        };
        Composer::new(self.model, q, &parameters)
    }

    pub(super) fn vector(&mut self, name: &str, entries: Vec<Sym>, meaning: &str) {
        self.output(name, entries, None, meaning);
    }

    /// By rows.
    pub(super) fn matrix(&mut self, name: &str, entries: Vec<Sym>, columns: usize, meaning: &str) {
        self.output(name, entries, Some(columns), meaning);
    }

    fn output(&mut self, name: &str, entries: Vec<Sym>, columns: Option<usize>, meaning: &str) {
        let rows = columns.map_or(entries.len(), |columns| entries.len().checked_div(columns).unwrap_or(0));
        let (name, meaning) = (name.to_owned(), meaning.to_owned());
        self.outputs.push((Output { name, rows, columns, meaning, entries: Vec::new() }, entries));
    }
}
