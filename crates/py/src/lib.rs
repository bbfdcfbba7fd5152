//! The Python module `gyroflex._gyroflex`: arrays in, arrays out, no physics of its own.

mod analyze;
mod arguments;
mod arrays;
mod batch;
mod codegen;
mod constraint;
mod derivatives;
mod drive;
mod energy;
mod errors;
mod inverse;
mod linear;
mod links;
mod log;
mod matrices;
mod named;
mod operational;
mod overrides;
mod robot;
mod rollout;
mod simulate;
mod sweep;
mod workspace;

use pyo3::prelude::*;

/// The compiled half of the package `gyroflex`; users import that.
#[pymodule]
mod _gyroflex {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::codegen::PyGeneratedCode;
    #[pymodule_export]
    use crate::constraint::{PyConstrainedMotion, PyConstrainedTorques, PyConstraint, PyImpact};
    #[pymodule_export]
    use crate::drive::PyDrive;
    #[pymodule_export]
    use crate::inverse::PyElasticInverse;
    #[pymodule_export]
    use crate::linear::{PyFrequencyResponse, PyLinearization, PyMode};
    #[pymodule_export]
    use crate::log::{PyRecord, read_log};
    #[pymodule_export]
    use crate::robot::PyRobot;
    #[pymodule_export]
    use crate::simulate::run_scenario;
    #[pymodule_export]
    use crate::sweep::measure_scenario;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
