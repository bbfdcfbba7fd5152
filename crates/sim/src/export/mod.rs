//! A robot as Rust source: records in read-only memory, for programs that can read no files.

mod layout;

use crate::error::{Error, ErrorKind};
use crate::robot::{OwnedModel, Robot};
use gyroflex::Scalar;
use gyroflex::model::{Body, Fidelity, Knot, Model};
use layout::{fields, lay_out};
use std::fmt::Write;

/// The number type of exported records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// `f32`.
    Single,
    /// `f64`.
    Double,
}

impl Precision {
    /// The name in Rust.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Single => "f32",
            Self::Double => "f64",
        }
    }
}

/// Rust source of one model of a robot: a module with `BODIES`, `KNOTS` and a `MODEL` that views them.
///
/// Numbers stand in the shortest form that reads back as the same bits, so that the compiled model gives what the loaded
/// robot gives. The module needs the crate `gyroflex` and nothing else.
///
/// # Errors
/// [`ErrorKind::Model`] if the robot is not physical, or a number of it is beyond the range of the precision.
pub fn rust(robot: &Robot, fidelity: Fidelity, precision: Precision) -> Result<String, Error> {
    robot.refuse_bending("exported code", crate::bending::RIGID)?;
    let model = robot.model(fidelity)?;
    match precision {
        Precision::Single => source::<f32>(robot, &model, precision),
        Precision::Double => source::<f64>(robot, &model, precision),
    }
}

/// A right angle of a robot is a number, not a constant of mathematics that somebody mistyped.
const LINTS: &str = "#[allow(clippy::approx_constant)]";

fn source<T: Scalar>(robot: &Robot, model: &OwnedModel, precision: Precision) -> Result<String, Error> {
    let view = model.view();
    let mut text = head(robot, model, precision);
    let scalar = precision.name();
    let mut list = |name: &str, kind: &str, doc: &str, records: Vec<(String, String)>| {
        let _ = write!(text, "\n/// {doc}\n{LINTS}\npub static {name}: [{kind}<{scalar}>; {}] = [", records.len());
        for (comment, record) in &records {
            let _ = write!(text, "\n    // {comment}\n    {},", lay_out(record, 1));
        }
        let end = if records.is_empty() { "];\n" } else { "\n];\n" };
        text.push_str(end);
    };
    list("BODIES", "Body", "One record per joint and the link it moves.", bodies::<T>(robot, view, precision)?);
    list("KNOTS", "Knot", "Pieces of the spring tables.", knots::<T>(robot, view, precision)?);

    let gravity = in_range(robot, "gravity", precision, format!("{:?}", view.gravity().map(T::from_f64)))?;
    let _ = write!(
        text,
        "\n/// The view that every algorithm takes.\n\
         pub static MODEL: Model<'static, {scalar}> = Model::new(&BODIES, &KNOTS, {gravity});\n"
    );
    Ok(text)
}

/// What the file is, how to make it again, and what the lengths of its vectors are.
fn head(robot: &Robot, model: &OwnedModel, precision: Precision) -> String {
    let view = model.view();
    let files: Vec<&str> = robot.sources.iter().map(|s| s.name.as_str()).collect();
    format!(
        "// {name}: the {model} model in {scalar}, from {files}.\n\
         // Written by gyroflex {version}, not by hand: `gyroflex export --rust ROBOT --model {model} --scalar {scalar}`.\n\
         // SI units and radians, six-vectors angular part first; motor quantities as their names say.\n\
         \n\
         use gyroflex::model::JointKind::*;\n\
         use gyroflex::model::*;\n\
         use gyroflex::spatial::*;\n\
         \n\
         /// Length of `q`.\n\
         #[allow(dead_code, reason = \"not every program asks\")]\n\
         pub const NQ: usize = {nq};\n\
         /// Length of `qd`, and of every other vector over the joints.\n\
         #[allow(dead_code, reason = \"not every program asks\")]\n\
         pub const NV: usize = {nv};\n",
        name = plain(&robot.name),
        model = model.fidelity.name(),
        scalar = precision.name(),
        files = plain(&files.join(" and ")),
        version = env!("CARGO_PKG_VERSION"),
        nq = view.nq(),
        nv = view.nv(),
    )
}

/// Each joint's name, and its record as Rust writes it.
fn bodies<T: Scalar>(robot: &Robot, view: Model<f64>, precision: Precision) -> Result<Vec<(String, String)>, Error> {
    let record = |(body, joint): (&Body<f64>, &crate::robot::Joint)| {
        let text = in_range(robot, &joint.name, precision, format!("{:?}", body.cast::<T>()))?;
        Ok((format!("{} moves {}", plain(&joint.name), plain(&joint.child_link)), text))
    };
    view.bodies().iter().zip(&robot.joints).map(record).collect()
}

fn knots<T: Scalar>(robot: &Robot, view: Model<f64>, precision: Precision) -> Result<Vec<(String, String)>, Error> {
    let record = |(i, knot): (usize, &Knot<f64>)| {
        let text = in_range(robot, "transmission.spring", precision, format!("{:?}", knot.cast::<T>()))?;
        Ok((format!("piece {i}"), text))
    };
    view.knots().iter().enumerate().map(record).collect()
}

/// Refuses a record with a number that the precision cannot hold.
fn in_range(robot: &Robot, element: &str, precision: Precision, record: String) -> Result<String, Error> {
    let beyond = |field: &&str| ["inf", "NaN"].iter().any(|word| field.contains(word));
    let Some(field) = fields(&record).into_iter().find(beyond) else { return Ok(record) };
    let remedy = match precision {
        Precision::Single => "export with --scalar f64, or check the numbers of this element",
        Precision::Double => "check the numbers of this element",
    };
    let files: Vec<&str> = robot.sources.iter().map(|s| s.name.as_str()).collect();
    Err(Error {
        kind: ErrorKind::Model,
        file: files.join(", "),
        element: element.to_owned(),
        problem: format!("a number is beyond the range of {}: {field}", precision.name()),
        remedy: remedy.to_owned(),
    })
}

/// A name that stays in its comment.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
