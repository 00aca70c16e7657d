//! The Python interface of rne: any arm at run time, with arrays of numpy as arguments and results.
//!
//! [`arm`] has the class `Arm`, and [`dynamics`], [`operational_space`], [`pose`], [`rollout`], [`integrator`],
//! [`friction`] and [`insight`] have its methods. Arrays of numpy are converted in [`arrays`], those of JAX in [`xla`],
//! and those on a graphics card in `gpu`. [`load`] reads an arm, [`repair`] proposes repairs of its
//! links, and [`errors`] makes exceptions. [`logs`], [`identification`], [`watching`] and [`excitation`] are about logs
//! of arms; [`log_errors`] words their errors, and [`interruption`] lets Ctrl-C end them. The Python files of the
//! package are in `rne/`.

mod arm;
mod arrays;
mod bases;
mod dynamics;
mod errors;
mod excitation;
mod friction;
mod functions;
#[cfg(feature = "gpu")]
mod gpu;
mod identification;
mod insight;
mod integrator;
mod interruption;
mod load;
mod log_errors;
mod logs;
mod notebook;
mod operational_space;
mod payload;
mod pose;
mod repair;
mod rollout;
mod watching;
mod xla;

use pyo3::prelude::*;

/// Dynamics of robot arms, compiled when they are read.
#[pymodule]
mod _rne {
    #[pymodule_export]
    use super::arm::Arm;
    #[pymodule_export]
    use super::bases::{base_from_imu, base_from_mujoco, base_from_pinocchio, derivatives_to_pinocchio};
    #[pymodule_export]
    use super::errors::{EvaluationError, RobotFileError, RobotFileWarning};
    #[pymodule_export]
    use super::excitation::exciting;
    #[cfg(feature = "gpu")]
    #[pymodule_export]
    use super::gpu::GpuArm;
    #[pymodule_export]
    use super::identification::identified;
    #[pymodule_export]
    use super::load::{builtin, load, names};
    #[pymodule_export]
    use super::logs::{log_content, log_motion};
    #[pymodule_export]
    use super::payload::{payload, payload_identified};
    #[pymodule_export]
    use super::pose::pose_log;
    #[pymodule_export]
    use super::repair::repair;
    #[pymodule_export]
    use super::watching::{followed, watched};
    #[pymodule_export]
    use super::xla::xla_handler;

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
