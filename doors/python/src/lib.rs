//! Python's door to rne: any arm at run time, with numpy in and out.
//!
//! Thin: [`arm`] has the class, [`dynamics`] and [`insight`] its methods, [`arrays`] what numpy's arrays are to the
//! machine, [`load`] how an arm is read, [`errors`] what goes wrong. The package around it is in `rne/`.

mod arm;
mod arrays;
mod dynamics;
mod errors;
mod functions;
mod insight;
mod load;
mod notebook;

use pyo3::prelude::*;

/// Dynamics of robot arms, compiled when they are read.
#[pymodule]
mod _rne {
    #[pymodule_export]
    use super::arm::Arm;
    #[pymodule_export]
    use super::errors::{EvaluationError, RobotFileError};
    #[pymodule_export]
    use super::load::{builtin, load, names};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
