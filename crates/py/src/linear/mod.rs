//! Linear models, modes and frequency responses of a robot.

mod model;
mod response;

pub(crate) use model::{PyLinearization, PyMode};
pub(crate) use response::PyFrequencyResponse;

use crate::batch::{Row, rows};
use crate::named;
use crate::robot::PyRobot;
use crate::{arguments, errors};
use gyroflex_sim::Error;
use gyroflex_sim::batch::in_parallel;
use gyroflex_sim::error::ErrorKind;
use gyroflex_sim::linearize::{KeptFriction, Linearizer, OperatingPoint, Output, Sweep, frequency_response};
use gyroflex_sim::simulate::StateVec;
use pyo3::exceptions::{PyIndexError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyString;

type Argument<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

#[pymethods]
impl PyRobot {
    /// Linear model `x' = A x + B u, y = C x + D u` about an operating point.
    ///
    /// The state `x` has the positions of the links, the positions of the motors behind elastic transmissions, and the
    /// velocities of both; the input `u` the motor torques of the joints, seen from the link side; all are deviations from the
    /// operating point. A floating root leads with six entries in its own frame, angular first, and has no input.
    ///
    /// Parameters
    /// ----------
    /// q
    ///     Joint positions, shape `([batch,] nq)` [rad or m]; zero if left out. Without `qd` the robot is at rest: where its motors
    ///     hold it at `q`, or, if `tau` is given, at the pose at which `tau` holds it, looked for from `q` on. If this or any array
    ///     below is a batch, there is a linear model for each row, computed on all cores.
    /// qd, theta, thetad, tau
    ///     With `qd`, any state and motor torques, shape `([batch,] nv)`, as in `forward_dynamics`.
    /// outputs
    ///     What `y` is made of: `motor_position`, `motor_velocity`, `link_position`, `link_velocity`, `joint_torque` (all
    ///     joints each), `pose:LINK` (position and rotation vector of a link's frame, world axes).
    ///     By default motor and link positions.
    /// model
    ///     Which physics of the motors.
    /// friction
    ///     Which friction acts: `all`, `viscous` or `none`. Dry friction is steep at standstill and all but locks the joints.
    #[pyo3(signature = (q=None, qd=None, theta=None, thetad=None, tau=None, *, outputs=None, model=None, friction="all"))]
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    fn linearize<'py>(
        &self,
        py: Python<'py>,
        q: Argument<'_, 'py>,
        qd: Argument<'_, 'py>,
        theta: Argument<'_, 'py>,
        thetad: Argument<'_, 'py>,
        tau: Argument<'_, 'py>,
        outputs: Argument<'_, 'py>,
        model: Option<&str>,
        friction: &str,
    ) -> PyResult<PyLinearization> {
        let linearizer = self.linearizer(model, friction)?;
        let outputs = read_outputs(outputs)?;
        let names = [("q", q), ("qd", qd), ("theta", theta), ("thetad", thetad), ("tau", tau)];
        let rows = rows(&self.layout, names)?;
        let batch = rows.is_some();
        let about_points = match rows {
            None => vec![self.about(&linearizer, [q, qd, theta, thetad, tau])?],
            Some(rows) => {
                let about = |row: &Row<'py, 5>| self.about(&linearizer, row.each_ref().map(|value| value.as_ref()));
                rows.iter().map(about).collect::<PyResult<_>>()?
            }
        };
        let linear = py.detach(|| {
            each(batch, about_points, &linearizer, |linearizer, about| {
                let point = about.point(linearizer)?;
                linearizer.linearize(&point, &outputs)
            })
        });
        linear.map(|linear| PyLinearization::new(linear, batch)).map_err(about("outputs"))
    }

    /// How the robot swings by itself about the equilibrium at a pose, from the slowest mode to the fastest.
    ///
    /// Parameters
    /// ----------
    /// q
    ///     Joint positions, shape `(nq,)` [rad or m]; zero if left out.
    /// model
    ///     Which physics of the motors.
    /// friction
    ///     Which friction acts: `all`, `viscous` or `none`. Dry friction is steep at standstill and all but locks the joints.
    #[pyo3(signature = (q=None, *, model=None, friction="all"))]
    fn modes<'py>(
        &self,
        py: Python<'py>,
        q: Argument<'_, 'py>,
        model: Option<&str>,
        friction: &str,
    ) -> PyResult<Vec<PyMode>> {
        if rows(&self.layout, [("q", q)])?.is_some() {
            let problem = "several poses are given, and each has modes of its own";
            let remedy = "take `[one.modes() for one in robot.linearize(q)]`, or `robot.linearize(q).eigenvalues`";
            return Err(errors::argument("q", problem, remedy));
        }
        self.linearize(py, q, None, None, None, None, None, model, friction)?.modes(py)
    }

    /// Response of a joint to its own motor about the equilibrium at a pose: from the motor's torque to the positions of motor
    /// and link, over frequencies in equal ratios.
    ///
    /// Parameters
    /// ----------
    /// joint
    ///     Name of the joint.
    /// q
    ///     Joint positions, shape `([batch,] nq)` [rad or m]; zero if left out.
    /// start, stop
    ///     The first and the last frequency [Hz]; by default well below the slowest and well above the fastest mode.
    /// points
    ///     How many frequencies.
    /// model
    ///     Which physics of the motors.
    /// friction
    ///     Which friction acts: `all`, `viscous` or `none`. Dry friction is steep at standstill and all but locks the joints.
    #[pyo3(signature = (joint, q=None, *, start=None, stop=None, points=500, model=None, friction="all"))]
    #[expect(clippy::too_many_arguments, reason = "most of them may be left out")]
    fn frequency_response<'py>(
        &self,
        py: Python<'py>,
        joint: &str,
        q: Argument<'_, 'py>,
        #[pyo3(from_py_with = named::start)] start: Option<f64>,
        #[pyo3(from_py_with = named::stop)] stop: Option<f64>,
        #[pyo3(from_py_with = named::points)] points: usize,
        model: Option<&str>,
        friction: &str,
    ) -> PyResult<PyFrequencyResponse> {
        let linearizer = self.linearizer(model, friction)?;
        linearizer.layout().find(joint).map_err(about("joint"))?;
        for (name, frequency) in [("start", start), ("stop", stop)] {
            match frequency {
                Some(f) if !f.is_finite() => return Err(errors::not_finite(name, "0".to_owned(), f)),
                Some(f) if f <= 0.0 => {
                    return Err(errors::argument(name, format!("it is {f}"), "give a frequency above zero [Hz]"));
                }
                _ => {}
            }
        }
        let rows = rows(&self.layout, [("q", q)])?;
        let batch = rows.is_some();
        let poses = match rows {
            None => vec![self.start(&linearizer, q)?],
            Some(rows) => rows.iter().map(|[q]| self.start(&linearizer, q.as_ref())).collect::<PyResult<Vec<_>>>()?,
        };
        let sweep = Sweep { from: start, to: stop, points: Some(points) };
        let responses = py.detach(|| {
            each(batch, poses, &linearizer, |linearizer, q| {
                let point = linearizer.equilibrium_at(&q)?;
                frequency_response(linearizer, &point, joint, sweep)
            })
        });
        let blamed = |e: Error| about(if e.element == "points" { "points" } else { "start" })(e);
        responses.map(|all| PyFrequencyResponse::new(all, batch)).map_err(blamed)
    }
}

/// What a linear model is about.
enum About {
    /// Where the motors hold the robot at these positions.
    Held(Vec<f64>),
    /// Where these motor torques hold it, looked for from these positions on.
    Under(Vec<f64>, Vec<f64>),
    /// This state.
    State(OperatingPoint),
}

impl About {
    fn point(self, linearizer: &mut Linearizer) -> Result<OperatingPoint, Error> {
        match self {
            Self::Held(q) => linearizer.equilibrium_at(&q),
            Self::Under(tau, q) => linearizer.equilibrium_for(&tau, &q),
            Self::State(point) => Ok(point),
        }
    }
}

/// Runs a calculation for every row, on all cores; an error says of which row of a batch.
fn each<T: Send, R: Send>(
    batch: bool,
    rows: Vec<T>,
    linearizer: &Linearizer,
    run: impl Fn(&mut Linearizer, T) -> Result<R, Error> + Sync,
) -> Result<Vec<R>, Error> {
    if !batch {
        let mut linearizer = linearizer.clone();
        return rows.into_iter().map(|row| run(&mut linearizer, row)).collect();
    }
    let run = |linearizer: &mut Linearizer, (k, row): (usize, T)| {
        // What has the wrong shape has it in all rows.
        let of_row = |e: Error| match e.kind {
            ErrorKind::Shape => e,
            _ => Error { problem: format!("row {k}: {}", e.problem), ..e },
        };
        run(linearizer, row).map_err(of_row)
    };
    let mut results: Vec<Option<R>> = rows.iter().map(|_| None).collect();
    let tasks = rows.into_iter().zip(results.iter_mut()).collect();
    in_parallel(
        tasks,
        || linearizer.clone(),
        |linearizer, (k, (row, result))| {
            *result = Some(run(linearizer, (k, row))?);
            Ok(())
        },
    )?;
    Ok(results.into_iter().flatten().collect())
}

impl PyRobot {
    fn linearizer(&self, model: Option<&str>, friction: &str) -> PyResult<Linearizer> {
        let fidelity = model.map_or(Ok(self.robot.fidelity), arguments::fidelity)?;
        let kept = arguments::choice("friction", friction, &KeptFriction::NAMES)?;
        Linearizer::new(&self.robot, fidelity, kept).map_err(errors::raise)
    }

    /// What the arguments `q, qd, theta, thetad, tau` say of one linear model.
    fn about(&self, linearizer: &Linearizer, [q, qd, theta, thetad, tau]: [Argument<'_, '_>; 5]) -> PyResult<About> {
        let q = self.start(linearizer, q)?;
        if let Some(qd) = qd {
            return Ok(About::State(self.state(linearizer, &q, qd, [theta, thetad, tau])?));
        }
        if let Some((name, _)) = [("theta", theta), ("thetad", thetad)].iter().find(|(_, value)| value.is_some()) {
            return Err(errors::argument(name, "it is given, but `qd` is not", "give all of a moving state"));
        }
        let Some(tau) = tau else { return Ok(About::Held(q)) };
        let mut torques = vec![0.0; self.layout.nv];
        self.layout.forces("tau", tau, &mut torques)?;
        Ok(About::Under(torques, q))
    }

    /// The positions given, or zero.
    fn start(&self, linearizer: &Linearizer, q: Argument<'_, '_>) -> PyResult<Vec<f64>> {
        let Some(q) = q else { return Ok(linearizer.zero_position()) };
        let mut positions = vec![0.0; self.layout.nq];
        self.layout.or_batch().positions(q, &mut positions)?;
        // Modes that are not given are found: the links hang at rest.
        if q.len().is_ok_and(|n| n + self.layout.modes == self.layout.nq) {
            positions.truncate(self.layout.nq - self.layout.modes);
        }
        Ok(positions)
    }

    /// A state that moves, with its motor torques.
    fn state(
        &self,
        linearizer: &Linearizer,
        q: &[f64],
        qd: &Bound<'_, PyAny>,
        [theta, thetad, tau]: [Argument<'_, '_>; 3],
    ) -> PyResult<OperatingPoint> {
        let nv = self.layout.nv;
        let elastic = !linearizer.layout().elastic().is_empty();
        let mut all = q.to_vec();
        all.resize(self.layout.nq, 0.0);
        let mut state = StateVec { q: all, ..StateVec::zeros(0, nv) };
        self.layout.or_batch().velocities("qd", qd, &mut state.qd)?;
        self.layout.motors("theta", theta, elastic, &mut state.theta)?;
        self.layout.motors("thetad", thetad, elastic, &mut state.thetad)?;
        let mut torques = vec![0.0; nv];
        let Some(tau) = tau else {
            return Err(errors::missing_torques("tau"));
        };
        self.layout.forces("tau", tau, &mut torques)?;
        linearizer.point(state, torques).map_err(errors::raise)
    }
}

/// One name or several.
fn read_outputs(value: Argument<'_, '_>) -> PyResult<Vec<Output>> {
    let Some(value) = value else { return Ok(Output::defaults()) };
    let names: Vec<String> = match value.cast::<PyString>() {
        Ok(name) => vec![name.to_string()],
        Err(_) => value.extract().map_err(|_| {
            errors::argument(
                "outputs",
                "it is not a list of names",
                "give names as `[\"motor_position\", \"pose:tool\"]`",
            )
        })?,
    };
    // Python's names have no hyphens.
    let parse = |name: &String| Output::parse(name).map_err(|e| Error { remedy: e.remedy.replace('-', "_"), ..e });
    names.iter().map(parse).collect::<Result<_, _>>().map_err(about("outputs"))
}

/// What an error of the library about its arguments is called here.
fn about(argument: &'static str) -> impl Fn(Error) -> PyErr {
    move |e| match e.kind {
        ErrorKind::Shape => errors::argument(argument, e.problem, e.remedy),
        _ => errors::raise(e),
    }
}

/// How many there are in a batch.
fn length(batch: bool, count: usize, what: &str) -> PyResult<usize> {
    if batch { Ok(count) } else { Err(PyTypeError::new_err(format!("a single {what} has no length"))) }
}

/// Which one of a batch an index means.
fn entry(batch: bool, count: usize, what: &str, index: isize) -> PyResult<usize> {
    if !batch {
        return Err(PyTypeError::new_err(format!("a single {what} has no entries")));
    }
    let from_start = if index < 0 { index.checked_add_unsigned(count) } else { Some(index) };
    from_start.and_then(|k| usize::try_from(k).ok()).filter(|k| *k < count).ok_or_else(|| {
        PyIndexError::new_err(format!("there are {count} {what}s in this batch, and none has index {index}"))
    })
}
