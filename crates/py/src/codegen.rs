//! Generated code: what `gyroflex codegen` writes, as texts by the names of their files.

use crate::robot::PyRobot;
use crate::simulate::SIGNAL_INTERVAL;
use crate::{arguments, errors, named};
use gyroflex_sim::codegen::{Generated, Language, NOT_EXPLICIT, Precision, Request, Simplify, Style, Target, generate};
use gyroflex_sim::load::Disk;
use gyroflex_sim::{Error, ScenarioFile};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::time::Instant;

/// Code or equations of one robot.
#[pyclass(name = "GeneratedCode", module = "gyroflex", frozen)]
pub(crate) struct PyGeneratedCode {
    generated: Generated,
    language: &'static str,
}

#[pymethods]
impl PyGeneratedCode {
    /// Texts by the names of their files.
    #[getter]
    fn files<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let files = PyDict::new(py);
        for file in &self.generated.files {
            files.set_item(&file.name, &file.text)?;
        }
        Ok(files)
    }

    /// What was generated, as `gyroflex codegen --json` prints it: functions with their arguments, results and operation counts.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (self.generated.report.json().to_string(),))
    }

    /// Writes the files into a folder, which is made if it does not exist; returns their paths.
    fn write(&self, folder: PathBuf) -> PyResult<Vec<PathBuf>> {
        self.generated.write(&folder).map_err(errors::raise)
    }

    /// The functions as a Python module that is ready to use; of code in Python only.
    fn module<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyModule>> {
        let (Some(file), "python") = (self.generated.files.first(), self.language) else {
            let remedy = "generate it with lang=\"python\"";
            return Err(errors::argument("lang", format!("code in {} is no module", self.language), remedy));
        };
        // Not by importing: modules of the same name would be one.
        let name = file.name.trim_end_matches(".py");
        let (module, builtins) = (PyModule::new(py, name)?, py.import("builtins")?);
        let code = builtins.call_method1("compile", (&file.text, format!("<gyroflex codegen {name}>"), "exec"))?;
        builtins.call_method1("exec", (code, module.dict()))?;
        Ok(module)
    }

    fn __str__(&self) -> String {
        self.generated.report.text()
    }

    fn __repr__(&self) -> String {
        let names: Vec<&str> = self.generated.files.iter().map(|file| file.name.as_str()).collect();
        format!("<GeneratedCode: {}>", names.join(", "))
    }
}

#[pymethods]
impl PyRobot {
    /// Straight-line code of this robot's equations, or the equations themselves.
    ///
    /// Parameters
    /// ----------
    /// what
    ///     Quantities: `forward`, `inverse`, `mass-matrix`, `coupling`, `reflected-inertia`, `coriolis`, `gravity`, `bias`,
    ///     `stiffness`, `energy`, `regressor`, `placements`, `jacobian`, `forward-derivatives`, `inverse-derivatives`,
    ///     `linearization`, `elastic-inverse`; `all` is all that this robot has.
    /// lang
    ///     `python`, `rust`, `c`, `json` for the expression graph, or `latex` for the explicit equations as a document.
    /// model
    ///     Which physics of the motors.
    /// scalar
    ///     Number type of the code, `f64` or `f32`.
    /// lanes
    ///     Rust that takes so many states side by side.
    /// keep_symbol
    ///     Parameters that stay arguments of the code, such as `link6.mass`, `payload.mass`, `joint2.stiffness`.
    /// link
    ///     The link whose Jacobian is generated; the last that moves by default.
    /// simplify_to
    ///     Drop terms whose torque stays below this part of the largest torque of their equation.
    /// along
    ///     The scenario whose motion decides which terms matter; motions all over the workspace by default.
    /// split
    ///     Cut every function into so many parts for as many processors (Rust, with the crate rayon).
    /// name
    ///     Name of the files without their extensions; the robot's by default.
    #[pyo3(signature = (what=None, *, lang="python", model=None, scalar="f64",
        lanes=None, keep_symbol=Vec::new(), link=None, simplify_to=None, along=None, split=None, name=None))]
    #[pyo3(
        text_signature = "($self, what=('forward', 'inverse'), *, lang='python', model=None, scalar='f64', lanes=None, \
        keep_symbol=(), link=None, simplify_to=None, along=None, split=None, name=None)"
    )]
    #[expect(clippy::too_many_arguments, reason = "most of them may be left out")]
    fn codegen(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::what)] what: Option<Vec<String>>,
        lang: &str,
        model: Option<&str>,
        scalar: &str,
        #[pyo3(from_py_with = named::lanes)] lanes: Option<usize>,
        #[pyo3(from_py_with = named::keep_symbol)] keep_symbol: Vec<String>,
        link: Option<String>,
        #[pyo3(from_py_with = named::simplify_to)] simplify_to: Option<f64>,
        along: Option<PathBuf>,
        #[pyo3(from_py_with = named::split)] split: Option<usize>,
        name: Option<String>,
    ) -> PyResult<PyGeneratedCode> {
        let (language, target) = arguments::choice("lang", lang, &LANGUAGES)?;
        let precision = arguments::choice("scalar", scalar, &[("f64", Precision::Double), ("f32", Precision::Single)])?;
        let along = along.map(|path| ScenarioFile::load(&Disk, &path)).transpose().map_err(errors::raise)?;
        if along.is_some() && simplify_to.is_none() {
            return Err(errors::argument("along", "no terms are dropped", "give simplify_to, too, such as 1e-3"));
        }
        let request = Request {
            what: what.unwrap_or_else(|| ["forward", "inverse"].map(str::to_owned).to_vec()),
            target,
            style: Style { precision, lanes },
            fidelity: model.map(arguments::fidelity).transpose()?,
            kept: keep_symbol,
            link,
            simplify: simplify_to.map(|tolerance| Simplify { tolerance, along }),
            split,
            stem: name,
            overrides: self.options.overrides.clone(),
        };
        let generated = py.detach(|| {
            let (mut signal, mut looked) = (Ok(()), Instant::now());
            let mut progress = |_| {
                if looked.elapsed() >= SIGNAL_INTERVAL {
                    looked = Instant::now();
                    signal = Python::attach(|py| py.check_signals());
                }
                signal.is_ok()
            };
            let generated = generate(&self.robot, &request, &mut progress);
            signal?;
            generated.map_err(|e| about_arguments(e, language))
        })?;
        // Nothing but a signal, raised above, ends it early.
        let generated = generated.ok_or_else(|| PyErr::new::<pyo3::exceptions::PyKeyboardInterrupt, _>(()))?;
        Ok(PyGeneratedCode { generated, language })
    }
}

/// What is wrong with what was asked for, by the names of Python instead of those of the command line.
fn about_arguments(e: Error, language: &str) -> PyErr {
    // What of an argument is concerned stands after its name.
    let (name, value) = e.element.split_once(' ').unwrap_or((&e.element, ""));
    let argument = match name.strip_prefix("--") {
        Some(option) => option.replace('-', "_"),
        None if e.element != NOT_EXPLICIT => return errors::raise(e),
        None if language == "latex" => "lang".to_owned(),
        None => "simplify_to".to_owned(),
    };
    let problem =
        if value.is_empty() || e.element == NOT_EXPLICIT { e.problem } else { format!("`{value}`: {}", e.problem) };
    errors::argument(&argument, problem, in_python(&e.remedy))
}

/// `--lang rust` becomes `lang="rust"`, `--simplify-to` becomes `simplify_to`.
fn in_python(text: &str) -> String {
    let mut words = text.split(' ').peekable();
    let mut said = Vec::new();
    while let Some(word) = words.next() {
        let Some(option) = word.strip_prefix("--") else {
            said.push(word.to_owned());
            continue;
        };
        let name: String = option.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '-').collect();
        let (rest, name) = (&option[name.len()..], name.replace('-', "_"));
        match words.next_if(|_| name == "lang") {
            Some(value) => said.push(format!("`{name}=\"{value}\"`{rest}")),
            None => said.push(format!("`{name}`{rest}")),
        }
    }
    said.join(" ")
}

/// Languages by their names.
const LANGUAGES: [(&str, (&str, Target)); 5] = [
    ("python", ("python", Target::Code(Language::Python))),
    ("rust", ("rust", Target::Code(Language::Rust))),
    ("c", ("c", Target::Code(Language::C))),
    ("json", ("json", Target::Code(Language::Json))),
    ("latex", ("latex", Target::Latex)),
];
