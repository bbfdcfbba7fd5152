//! Arguments and outputs while a function is traced.

use super::Options;
use crate::function::{Argument, Function, Output};
use crate::robot::{Parameter, Records, Robot};
use crate::sym::{Sym, trace};
use gyroflex::Scalar;
use gyroflex::dynamics::State;

/// The signature of a function under way.
#[derive(Debug, Default)]
pub(super) struct Tracing {
    arguments: Vec<Argument>,
    outputs: Vec<(Output, Vec<Sym>)>,
    inputs: usize,
}

/// A state in symbols.
pub(super) struct SymbolicState {
    pub(super) q: Vec<Sym>,
    pub(super) qd: Vec<Sym>,
    pub(super) theta: Vec<Sym>,
    pub(super) thetad: Vec<Sym>,
}

impl SymbolicState {
    /// The view that the algorithms take.
    pub(super) fn view(&self) -> State<'_, Sym> {
        State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad }
    }
}

impl Tracing {
    /// An argument of `len` numbers, as symbols.
    pub(super) fn argument(&mut self, name: &str, len: usize, meaning: &str) -> Vec<Sym> {
        self.arguments.push(Argument { name: name.to_owned(), len, meaning: meaning.to_owned() });
        let first = self.inputs;
        self.inputs += len;
        (first..self.inputs).map(Sym::input).collect()
    }

    /// An argument of motors: of a robot without elastic joints it is none, and nothing depends on what is returned.
    pub(super) fn of_motors(&mut self, robot: &Robot, name: &str, meaning: &str) -> Vec<Sym> {
        if robot.is_elastic() { self.argument(name, robot.nv(), meaning) } else { zeros(robot.nv()) }
    }

    /// Positions of the joints, and of the modes of links that bend.
    pub(super) fn positions(&mut self, robot: &Robot) -> Vec<Sym> {
        let meaning = match robot.flexible {
            Some(_) => "joint positions [rad or m], then modal coordinates [m]",
            None => "joint positions [rad or m]",
        };
        self.argument("q", robot.nq(), meaning)
    }

    /// Positions and velocities of joints and motors.
    pub(super) fn state(&mut self, robot: &Robot) -> SymbolicState {
        SymbolicState {
            q: self.positions(robot),
            qd: self.argument("qd", robot.nv(), "joint velocities [rad/s or m/s]"),
            theta: self.of_motors(robot, "theta", "motor positions, reflected [rad or m]"),
            thetad: self.of_motors(robot, "thetad", "motor velocities, reflected [rad/s or m/s]"),
        }
    }

    /// The same without motor positions, for what does not depend on them.
    pub(super) fn moving(&mut self, robot: &Robot) -> SymbolicState {
        SymbolicState {
            q: self.positions(robot),
            qd: self.argument("qd", robot.nv(), "joint velocities [rad/s or m/s]"),
            theta: zeros(robot.nv()),
            thetad: self.of_motors(robot, "thetad", "motor velocities, reflected [rad/s or m/s]"),
        }
    }

    /// The robot's records. What is kept of its parameters is the last argument.
    pub(super) fn records(&mut self, robot: &Robot, options: &Options) -> Records {
        let kept = &options.kept;
        if kept.is_empty() {
            return Records::keeping(robot, &[]);
        }
        let say = |p: &Parameter| format!("{} [{}], {} in the robot's description", p.name(), p.unit(), p.nominal());
        let meaning = kept.iter().map(say).collect::<Vec<_>>().join("; ");
        let symbols = self.argument("parameters", kept.len(), &meaning);
        let kept: Vec<(Parameter, Sym)> = kept.iter().cloned().zip(symbols).collect();
        Records::keeping(robot, &kept)
    }

    /// A vector of results.
    pub(super) fn vector(&mut self, name: &str, entries: &[Sym], meaning: &str) {
        self.output(name, entries, entries.len(), None, meaning);
    }

    /// A matrix of results, by rows.
    pub(super) fn matrix(&mut self, name: &str, entries: &[Sym], columns: usize, meaning: &str) {
        self.output(name, entries, entries.len().checked_div(columns).unwrap_or(0), Some(columns), meaning);
    }

    fn output(&mut self, name: &str, entries: &[Sym], rows: usize, columns: Option<usize>, meaning: &str) {
        let (name, meaning) = (name.to_owned(), meaning.to_owned());
        self.outputs.push((Output { name, rows, columns, meaning, entries: Vec::new() }, entries.to_vec()));
    }
}

/// Traces a function.
pub(super) fn traced(name: &str, meaning: &str, build: impl FnOnce(&mut Tracing)) -> Function {
    let (Tracing { arguments, outputs, .. }, graph) = trace(|| {
        let mut tracing = Tracing::default();
        build(&mut tracing);
        tracing
    });
    let outputs = outputs
        .into_iter()
        .map(|(output, entries)| Output { entries: entries.into_iter().map(Sym::id).collect(), ..output })
        .collect();
    Function { name: name.to_owned(), meaning: meaning.to_owned(), arguments, outputs, graph }
}

/// So many zeros.
pub(super) fn zeros(len: usize) -> Vec<Sym> {
    vec![Sym::zero(); len]
}
