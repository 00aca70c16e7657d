//! Functions of an arm on a graphics card. The Python module `rne/gpu.py` builds `Arm.gpu` from them.
//!
//! Arrays on the card are addresses here. `rne/gpu.py` checks the arrays before it passes their addresses.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rne_codegen::Function;
use rne_gpu::{Device, GpuError, GpuRollout, Order, Precision};

use crate::arm::{Arm, function_named};
use crate::errors::of_evaluation;
use crate::functions::warn_of_loss;
use crate::xla::results;

/// The cards that were opened. They stay open until the process ends, as in other libraries.
static DEVICES: Mutex<Option<HashMap<usize, Device>>> = Mutex::new(None);

/// An arm on a graphics card.
#[pyclass(frozen, module = "rne._rne")]
pub(crate) struct GpuArm {
    arm: rne_gpu::GpuArm,
}

/// The arguments of a function with their numbers of elements, and the shapes of its results, each with a flag for
/// poses.
type Told = (Vec<(&'static str, usize)>, Vec<(Vec<usize>, bool)>);

fn of_gpu(error: &GpuError) -> PyErr {
    match error {
        GpuError::NoDriver { .. }
        | GpuError::OldDriver { .. }
        | GpuError::NoDevice { .. }
        | GpuError::Translation { .. }
        | GpuError::Call { .. } => PyRuntimeError::new_err(error.to_string()),
        _ => of_evaluation(error),
    }
}

#[pymethods]
impl GpuArm {
    #[new]
    fn new(arm: &Arm, device: usize) -> PyResult<Self> {
        let mut devices = DEVICES.lock().unwrap_or_else(PoisonError::into_inner);
        let devices = devices.get_or_insert_default();
        let device = if let Some(device) = devices.get(&device) {
            device.clone()
        } else {
            let found = Device::open(device).map_err(|error| of_gpu(&error))?;
            devices.entry(device).insert_entry(found).get().clone()
        };
        Ok(Self { arm: rne_gpu::GpuArm::new(&arm.arm, &device) })
    }

    /// The name of the card.
    #[getter]
    fn card(&self) -> &str {
        self.arm.device().name()
    }

    /// The names of the functions of the arm.
    #[getter]
    fn functions(&self) -> Vec<&'static str> {
        rne_codegen::functions_of(self.arm.arm().robot()).map(Function::name).collect()
    }

    /// The arguments and results of a function.
    fn told(&self, py: Python<'_>, function: &str) -> PyResult<Told> {
        let function = function_named(function)?;
        let arm = self.arm.arm();
        let compiled = py.detach(|| arm.function(function)).map_err(|error| of_evaluation(&error))?;
        Ok((compiled.arguments().to_vec(), results(arm, function)))
    }

    /// Translates the kernels of a function, or of rollouts by it.
    fn prepare(&self, py: Python<'_>, function: &str, is_double: bool, is_rollout: bool) -> PyResult<()> {
        let function = function_named(function)?;
        let precision = if is_double { Precision::Double } else { Precision::Single };
        if !is_double {
            warn_of_loss(py, self.arm.arm(), function)?;
        }
        py.detach(|| self.arm.prepare(function, precision, is_rollout)).map_err(|error| of_gpu(&error))
    }

    /// Waits for a stream.
    fn wait(&self, py: Python<'_>, stream: u64) -> PyResult<()> {
        py.detach(|| self.arm.device().wait(stream)).map_err(|error| of_gpu(&error))
    }

    /// Launches a function, or a rollout of (steps, step, every) by it. The addresses are those of arrays that have
    /// been checked.
    #[allow(unsafe_code)]
    #[pyo3(signature = (function, is_double, is_columns, states, arguments, results, stream, rollout=None))]
    fn launch(
        &self,
        py: Python<'_>,
        function: &str,
        is_double: bool,
        is_columns: bool,
        states: usize,
        arguments: Vec<u64>,
        results: Vec<u64>,
        stream: u64,
        rollout: Option<(u32, f64, u32)>,
    ) -> PyResult<()> {
        let function = function_named(function)?;
        let order = if is_columns { Order::Columns } else { Order::Rows };
        let rollout = rollout.map(|(steps, step, every)| GpuRollout { steps, step, every });
        let (arm, arguments, results) = (&self.arm, &arguments[..], &results[..]);
        // SAFETY: `rne/gpu.py` has read the addresses from the arrays of a library, has checked their shapes, number
        // type, order and card, and keeps the arrays until the launch is queued; libraries free memory in the order of
        // the stream. The caller must ensure that nobody else writes to the arrays meanwhile, as for all arrays on
        // cards.
        let launched = py.detach(|| match (rollout, is_double) {
            (None, false) => unsafe { arm.launch::<f32>(function, order, states, arguments, results, stream) },
            (None, true) => unsafe { arm.launch::<f64>(function, order, states, arguments, results, stream) },
            (Some(rollout), false) => unsafe {
                arm.launch_rollout::<f32>(function, &rollout, order, states, arguments, results, stream)
            },
            (Some(rollout), true) => unsafe {
                arm.launch_rollout::<f64>(function, &rollout, order, states, arguments, results, stream)
            },
        });
        launched.map_err(|error| of_gpu(&error))
    }
}

#[pymethods]
impl Arm {
    /// Functions of this arm on a graphics card of NVIDIA, for arrays of PyTorch, CuPy and JAX that are on it.
    ///
    /// Each function of the arm is an attribute of what is returned: `arm.gpu().inverse_dynamics(q, qd, qdd)`, with
    /// arrays of shape (N, n), float32 or float64. `rollout(q, qd, tau, step)` moves N samples on over T steps in one
    /// launch.
    /// A call reads the arrays where they are, launches a kernel on the caller's current stream, and does not wait.
    /// `device`: the number of the card. Needs NVIDIA's driver, and neither CUDA's toolkit nor a compiler.
    #[pyo3(signature = (device=None), text_signature = "($self, device=0)")]
    fn gpu<'py>(slf: &Bound<'py, Self>, device: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        let gpu = slf.py().import("rne.gpu")?.getattr("Gpu")?;
        // `rne/gpu.py` reports a wrong number of a card
        device.map_or_else(|| gpu.call1((slf,)), |device| gpu.call1((slf, device)))
    }
}
