//! The inverse of an elastic robot: motors and torques from the motion of the links.

mod kept;
mod result;

pub(crate) use kept::Inverses;
pub(crate) use result::PyElasticInverse;

use crate::arguments::Layout;
use crate::arrays::{numbers, read_rows, text_of};
use crate::robot::PyRobot;
use crate::{arguments, errors, named};
use gyroflex::dynamics::{External, JointOrders};
use gyroflex_sim::inverse::{joint_orders, with_least_damping};
use kept::Wanted;
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl PyRobot {
    /// How many derivatives of every joint's position `elastic_inverse` needs.
    ///
    /// Parameters
    /// ----------
    /// model
    ///     Which physics of the motors.
    /// torque_derivatives
    ///     How many time derivatives of the torques are asked for besides the torques.
    /// damping
    ///     Damping that the elastic transmissions have at least [N m s/rad or N s/m]: damped ones need fewer.
    ///
    /// Returns
    /// -------
    /// dict
    ///     By name of the joint. A floating root is called `root`; its first derivative is its twist.
    #[pyo3(signature = (model=None, torque_derivatives=0, *, damping=None))]
    fn smoothness<'py>(
        &self,
        py: Python<'py>,
        model: Option<&str>,
        #[pyo3(from_py_with = named::torque_derivatives)] torque_derivatives: usize,
        #[pyo3(from_py_with = named::damping)] damping: Option<f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let Wanted { fidelity, damping, .. } = self.wanted(model, torque_derivatives, damping)?;
        let robot = with_least_damping(&self.robot, damping);
        let orders = joint_orders(&robot, fidelity, torque_derivatives).map_err(errors::raise)?;
        // The largest number that the library counts to stands for all above it.
        if orders.iter().any(|order| order.position == u8::MAX) {
            let problem = format!("{torque_derivatives} need more derivatives of the motion than can be counted");
            return Err(errors::argument("torque_derivatives", problem, "ask for fewer"));
        }
        let answer = PyDict::new(py);
        for (joint, order) in robot.joints.iter().zip(orders) {
            answer.set_item(&joint.name, order.position)?;
        }
        Ok(answer)
    }

    /// Motions and torques of the motors that make the links move as asked, elastic transmissions included.
    ///
    /// Of one moment, or of one motion over time, whose arrays have the times as their first axis: a damped transmission deflects from
    /// each to the next. Moments that do not follow each other take a call each.
    ///
    /// Parameters
    /// ----------
    /// q
    ///     Joint positions, shape `(nq,)` or `(times, nq)` [rad or m].
    /// derivatives
    ///     Their time derivatives from the velocities on, shape `(order, nv)` or `(times, order, nv)` [rad or m, per s, per s², …];
    ///     `smoothness` says how many
    ///     are needed. Of a floating root the twist in its own frame, and the derivatives of those six numbers.
    /// deflection
    ///     Present deflections of damped transmissions, which are a state of the inverse, shape `(nv,)` [rad or m]; at first those of
    ///     rest at `q`, which is what is taken if it is left out; later the `deflection` of the call before.
    /// step
    ///     Time to the next call [s], after which the `deflection` of the result is; of a motion, from each time to the next.
    /// model
    ///     Which physics of the motors.
    /// tau_ext
    ///     Generalised forces on the link side of the joints that help, shape `(nv,)` [N m or N], held constant; or with their
    ///     time derivatives, shape `(rows, nv)`. Of a motion over time `(nv,)`, `(times, nv)`, or `(times, rows, nv)`.
    /// torque_derivatives
    ///     How many time derivatives of the torques are asked for besides the torques.
    /// damping
    ///     Damping that the elastic transmissions have at least in the inverse [N m s/rad or N s/m]; fewer derivatives are needed
    ///     then, and the torques are those of a robot so damped.
    ///
    /// Returns
    /// -------
    /// ElasticInverse
    ///     Motor motions, torques and deflections.
    #[pyo3(signature = (q, derivatives, *, deflection=None, step=0.0, model=None, tau_ext=None, torque_derivatives=0, damping=None))]
    #[expect(clippy::too_many_arguments, reason = "most of them may be left out")]
    fn elastic_inverse<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        derivatives: &Bound<'py, PyAny>,
        deflection: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = named::step)] step: f64,
        model: Option<&str>,
        tau_ext: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = named::torque_derivatives)] torque_derivatives: usize,
        #[pyo3(from_py_with = named::damping)] damping: Option<f64>,
    ) -> PyResult<PyElasticInverse> {
        let wanted = self.wanted(model, torque_derivatives, damping)?;
        at_least_zero("step", step)?;
        let (nv, motion) = (self.layout.nv, self.motion_over_time(q, derivatives)?);
        let loads = self.loads(tau_ext, motion.times)?;
        let mut now = vec![0.0; nv];
        if let Some(deflection) = deflection {
            self.layout.forces("deflection", deflection, &mut now)?;
        }
        self.inverses.with(&self.robot, wanted, |inverse| {
            self.check(inverse.smoothness().joints, &motion)?;
            inverse.set_deflection(&now);
            let damped = inverse.smoothness().joints.iter().any(|j| j.damped);
            if damped && step == 0.0 && motion.times.is_some_and(|times| times > 1) {
                let problem = "it is 0, but damped transmissions deflect from each time to the next";
                return Err(errors::argument("step", problem, "give the time between the rows"));
            }
            if deflection.is_none() && damped {
                let at_rest = External { tau: loads.at(0).get(..nv).unwrap_or(&[]), wrenches: &[] };
                inverse.rest(motion.positions(0), at_rest).map_err(errors::raise)?;
            }
            let mut found = PyElasticInverse::new(nv, motion.times, torque_derivatives);
            let mut run = || {
                for k in 0..motion.times.unwrap_or(1) {
                    let ext = External { tau: loads.at(k), wrenches: &[] };
                    inverse.at(motion.positions(k), motion.derivatives(k), ext, step).map_err(|e| {
                        match motion.times {
                            Some(_) => gyroflex_sim::Error { problem: format!("at time {k}: {}", e.problem), ..e },
                            None => e,
                        }
                    })?;
                    inverse.advance();
                    found.push(inverse);
                }
                Ok::<(), gyroflex_sim::Error>(())
            };
            // Of one moment, letting others run takes longer than running.
            if motion.times.is_some() { py.detach(run) } else { run() }.map_err(errors::raise)?;
            Ok(found)
        })
    }
}

/// The library counts derivatives to 255, of which some are those of the motion.
const MOST_DERIVATIVES: usize = 250;

const DERIVATIVES: &str = "give a row for each derivative, the velocities first, with one entry per velocity coordinate in the order of \
                           `joint_names`; a floating root leads with six";

/// Loads from outside with their derivatives, the same all the time or with a width for every time.
struct Loads {
    width: Option<usize>,
    all: Vec<f64>,
}

impl Loads {
    fn at(&self, k: usize) -> &[f64] {
        self.width.map_or(&self.all[..], |width| &self.all[k * width..][..width])
    }
}

/// A motion of the links, of one moment or over time.
struct Motion {
    times: Option<usize>,
    order: usize,
    nq: usize,
    nv: usize,
    positions: Vec<f64>,
    derivatives: Vec<f64>,
}

impl Motion {
    fn positions(&self, k: usize) -> &[f64] {
        &self.positions[k * self.nq..][..self.nq]
    }

    fn derivatives(&self, k: usize) -> &[f64] {
        let width = self.order * self.nv;
        &self.derivatives[k * width..][..width]
    }
}

impl PyRobot {
    /// Reads a motion, and asks for as many times everywhere.
    fn motion_over_time(&self, q: &Bound<'_, PyAny>, derivatives: &Bound<'_, PyAny>) -> PyResult<Motion> {
        let Layout { nq, nv, .. } = self.layout;
        let (q_array, d_array) = (numbers("q", q)?, numbers("derivatives", derivatives)?);
        if q_array.ndim() != 2 && d_array.ndim() != 3 {
            let mut positions = vec![0.0; nq];
            self.layout.or_times().positions(q, &mut positions)?;
            let derivatives = read_rows("derivatives", derivatives, nv, DERIVATIVES)?;
            return Ok(Motion { times: None, order: derivatives.len() / nv.max(1), nq, nv, positions, derivatives });
        }
        let (q_shape, d_shape) = (q_array.shape(), d_array.shape());
        let (&[times, _], &[d_times, order, _]) = (q_shape, d_shape) else {
            let problem = format!("`q` has shape {}, `derivatives` {}", text_of(q_shape), text_of(d_shape));
            return Err(errors::shape("derivatives", problem, format!("give (times, {nq}) and (times, order, {nv})")));
        };
        if times != d_times || times == 0 {
            let problem = format!("`q` has {times} times, `derivatives` {d_times}");
            return Err(errors::shape("derivatives", problem, "give one row of each for every time"));
        }
        let mut positions = vec![0.0; times * nq];
        for (k, (row, to)) in q.try_iter()?.zip(positions.chunks_mut(nq.max(1))).enumerate() {
            self.layout.positions_of(&format!("q[{k}]"), &row?, to)?;
        }
        let mut all = Vec::new();
        for (k, row) in derivatives.try_iter()?.enumerate() {
            all.extend(read_rows(&format!("derivatives[{k}]"), &row?, nv, DERIVATIVES)?);
        }
        Ok(Motion { times: Some(times), order, nq, nv, positions, derivatives: all })
    }

    fn wanted(&self, model: Option<&str>, torque_derivatives: usize, damping: Option<f64>) -> PyResult<Wanted> {
        let fidelity = model.map_or(Ok(self.robot.fidelity), arguments::fidelity)?;
        let damping = damping.unwrap_or(0.0);
        at_least_zero("damping", damping)?;
        if torque_derivatives > MOST_DERIVATIVES {
            let problem = format!("{torque_derivatives} are more than can be counted");
            return Err(errors::argument("torque_derivatives", problem, format!("give at most {MOST_DERIVATIVES}")));
        }
        Ok(Wanted { fidelity, torque_derivatives, damping })
    }

    /// Loads with their derivatives, one row after the other; none for none.
    fn loads(&self, value: Option<&Bound<'_, PyAny>>, times: Option<usize>) -> PyResult<Loads> {
        let nv = self.layout.nv;
        let Some(value) = value else { return Ok(Loads { width: None, all: Vec::new() }) };
        let array = numbers("tau_ext", value)?;
        let Some(times) = times.filter(|_| array.ndim() > 1) else {
            if array.ndim() == 2 {
                return Ok(Loads { width: None, all: read_rows("tau_ext", value, nv, DERIVATIVES)? });
            }
            let mut all = vec![0.0; nv];
            self.layout.forces("tau_ext", value, &mut all)?;
            return Ok(Loads { width: None, all });
        };
        let shape = array.shape();
        if !matches!(shape, &[n, _] | &[n, _, _] if n == times) {
            let problem = format!("an array of shape {} is given, but there are {times} times", text_of(shape));
            let remedy = format!("give ({nv},), ({times}, {nv}), or ({times}, rows, {nv})");
            return Err(errors::shape("tau_ext", problem, remedy));
        }
        let (rows, mut all) = (if shape.len() == 3 { shape[1] } else { 1 }, Vec::new());
        for (k, row) in value.try_iter()?.enumerate() {
            let name = format!("tau_ext[{k}]");
            if shape.len() == 3 {
                all.extend(read_rows(&name, &row?, nv, DERIVATIVES)?);
            } else {
                let mut load = vec![0.0; nv];
                self.layout.forces(&name, &row?, &mut load)?;
                all.extend(load);
            }
        }
        Ok(Loads { width: Some(rows * nv), all })
    }

    /// Whether a motion has the derivatives that are needed, joint by joint.
    fn check(&self, orders: &[JointOrders], motion: &Motion) -> PyResult<()> {
        let given = motion.order;
        let few = self.robot.joints.iter().zip(orders).filter(|(_, order)| usize::from(order.position) > given);
        let few: Vec<String> =
            few.map(|(joint, order)| format!("`{}` needs {} and has {given}", joint.name, order.position)).collect();
        if few.is_empty() {
            return Ok(());
        }
        let most = orders.iter().map(|order| order.position).max().unwrap_or(0);
        Err(errors::shape(
            "derivatives",
            format!("the torques depend on more derivatives than are given: {}", few.join(", ")),
            format!(
                "give an array of shape {}, or invert a model that needs fewer: `reduced`, or one with added `damping`",
                text_of(&motion.times.into_iter().chain([most.into(), self.layout.nv]).collect::<Vec<_>>())
            ),
        ))
    }
}

fn at_least_zero(name: &str, value: f64) -> PyResult<()> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(errors::argument(name, format!("it is {value}"), "give a finite number that is not negative"))
}
