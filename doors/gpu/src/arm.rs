//! The functions of an arm on a card.
#![allow(unsafe_code)] // for launches: callers or checks ensure that arrays are valid

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use rne_codegen::Function;
use rne_emit::{Additions, Precision, Prefix, is_for_rollouts, ptx};
use rne_machine::{CompiledArm, CompiledFunction};

use crate::driver::{Kernel, Module, Real};
use crate::{Device, GpuError, Memory};

/// Threads of a block; every kernel can run with this number.
const WIDTH: u32 = 64;
/// The largest number of states of a launch.
const MOST_STATES: u64 = i32::MAX as u64;

/// How the numbers of a batch lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Order {
    /// Element e of state i is at i · elements + e.
    Rows,
    /// Element e of state i is at e · states + i. This is the faster order.
    Columns,
}

/// A rollout on a card, with the bits of a [`rne_machine::Rollout`] without friction and limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GpuRollout {
    /// The number T of steps, at least 1.
    pub steps: u32,
    /// The duration of a step, s; above zero.
    pub step: f64,
    /// States are written after the steps `every`, 2 · `every`, …: 1 for all states, T for the last alone.
    pub every: u32,
}

impl GpuRollout {
    /// A rollout that writes all states.
    #[must_use]
    pub const fn new(steps: u32, step: f64) -> Self {
        Self { steps, step, every: 1 }
    }

    /// How many states are written for each sample.
    #[must_use]
    pub const fn written(&self) -> u32 {
        match self.steps.checked_div(self.every) {
            Some(written) => written,
            None => 0,
        }
    }
}

/// The computation of a launch: a function, or a rollout by this function.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Work {
    Function,
    Rollout(GpuRollout),
}

/// An arm whose functions run on a card, a thread per state. The driver translates a function when it is first used.
#[derive(Debug)]
pub struct GpuArm {
    arm: CompiledArm,
    device: Device,
    modules: Mutex<HashMap<(Function, Precision, bool), Arc<Kernels>>>,
}

/// The kernels of a function, or of rollouts by a function.
#[derive(Debug)]
struct Kernels {
    device: Device,
    module: Module,
    rows: Kernel,
    columns: Kernel,
}

impl Drop for Kernels {
    fn drop(&mut self) {
        self.device.driver().unload(self.device.context(), self.module);
    }
}

impl GpuArm {
    /// Creates the functions of an arm on a card.
    #[must_use]
    pub fn new(arm: &CompiledArm, device: &Device) -> Self {
        Self { arm: arm.clone(), device: device.clone(), modules: Mutex::default() }
    }

    /// The arm on the processor.
    #[must_use]
    pub fn arm(&self) -> &CompiledArm {
        &self.arm
    }

    /// The card.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Translates a function, or rollouts by it, for a number type, unless that has been done. Call it before the
    /// capture of a graph, during which nothing can be translated.
    ///
    /// # Errors
    /// When the arm does not have the function, no rollout is possible by it, or the driver cannot translate it.
    pub fn prepare(&self, function: Function, precision: Precision, is_rollout: bool) -> Result<(), GpuError> {
        self.kernels(function, precision, is_rollout).map(|_| ())
    }

    /// Computes a function for many states and waits for the results. `arguments` are arrays by their names, in any
    /// order.
    ///
    /// # Errors
    /// When the arm does not have the function, an argument is missing or has another size, or a call of the driver
    /// fails.
    pub fn run<T: Real>(
        &self,
        function: Function,
        order: Order,
        states: usize,
        arguments: &[(&str, &Memory<T>)],
        results: &mut Memory<T>,
    ) -> Result<(), GpuError> {
        let outputs = self.compiled(function)?.outputs();
        let addresses = self.checked(function, states, 1, arguments)?;
        self.sized("results", outputs.saturating_mul(states), results)?;
        // SAFETY: all arrays are on this card and have as many numbers as are read and written; the results are
        // borrowed exclusively, and this call waits for the end of the kernel
        unsafe { self.launch::<T>(function, order, states, &addresses, &[results.address()], 0)? };
        self.device.wait(0)
    }

    /// Rolls samples out and waits for the states. `arguments` are those of forward dynamics, with `tau` for all steps
    /// of each sample, and `payload` where the tip carries something; `positions` and `velocities` get the states that
    /// are written, step by step.
    ///
    /// # Errors
    /// As for [`run`](Self::run), and when the rollout has no step.
    pub fn rollout<T: Real>(
        &self,
        rollout: &GpuRollout,
        order: Order,
        samples: usize,
        arguments: &[(&str, &Memory<T>)],
        [positions, velocities]: [&mut Memory<T>; 2],
    ) -> Result<(), GpuError> {
        let is_loaded = arguments.iter().any(|(name, _)| *name == "payload");
        let function = if is_loaded { Function::ForwardDynamicsWithPayload } else { Function::ForwardDynamics };
        let dof = self.compiled(function)?.outputs();
        let addresses = self.checked(function, samples, rollout.steps as usize, arguments)?;
        let size = dof.saturating_mul(rollout.written() as usize).saturating_mul(samples);
        self.sized("positions", size, positions)?;
        self.sized("velocities", size, velocities)?;
        let results = [positions.address(), velocities.address()];
        // SAFETY: as in `run`
        unsafe { self.launch_rollout::<T>(function, rollout, order, samples, &addresses, &results, 0)? };
        self.device.wait(0)
    }

    /// Launches a function on a stream of the caller, 0 for the default stream, and does not wait. `arguments` are the
    /// addresses of the arrays of [`CompiledFunction::arguments`](rne_machine::CompiledFunction::arguments) in their
    /// order; that of an array without elements may be 0.
    ///
    /// # Safety
    /// The addresses are those of memory that the card reaches, with as many numbers of this type as the order, the
    /// number of states and the sizes of the arrays say. The results overlap no argument. Nobody writes to any of them,
    /// nor reads results, until the kernel has ended. The stream is one of the primary context of the card.
    ///
    /// # Errors
    /// When the arm does not have the function, or a call of the driver fails.
    pub unsafe fn launch<T: Real>(
        &self,
        function: Function,
        order: Order,
        states: usize,
        arguments: &[u64],
        results: &[u64],
        stream: u64,
    ) -> Result<(), GpuError> {
        // SAFETY: promised by the caller of this function
        unsafe { self.launched::<T>(function, Work::Function, order, states, arguments, results, stream) }
    }

    /// Launches a rollout by forward dynamics on a stream of the caller, and does not wait. `results` are the addresses
    /// of positions and velocities.
    ///
    /// # Safety
    /// As for [`launch`](Self::launch), where `tau` has numbers for all steps and the results for all states that are
    /// written.
    ///
    /// # Errors
    /// As for [`launch`](Self::launch), and when the rollout has no step.
    #[allow(clippy::too_many_arguments)] // all of them are parameters of a launch
    pub unsafe fn launch_rollout<T: Real>(
        &self,
        function: Function,
        rollout: &GpuRollout,
        order: Order,
        samples: usize,
        arguments: &[u64],
        results: &[u64],
        stream: u64,
    ) -> Result<(), GpuError> {
        // SAFETY: promised by the caller of this function
        unsafe { self.launched::<T>(function, Work::Rollout(*rollout), order, samples, arguments, results, stream) }
    }

    #[allow(clippy::too_many_arguments)]
    unsafe fn launched<T: Real>(
        &self,
        function: Function,
        work: Work,
        order: Order,
        states: usize,
        arguments: &[u64],
        results: &[u64],
        stream: u64,
    ) -> Result<(), GpuError> {
        let is_of_range = |what, found: u64, least| {
            let allowed = [least, MOST_STATES];
            if (allowed[0]..=allowed[1]).contains(&found) {
                Ok(())
            } else {
                Err(GpuError::Range { what, found, allowed })
            }
        };
        is_of_range("states", states as u64, 0)?;
        let states = u32::try_from(states).unwrap_or(u32::MAX);
        let mut parameters = [arguments, results].concat();
        if let Work::Rollout(GpuRollout { steps, step, every }) = work {
            let dof = self.compiled(function)?.outputs() as u64;
            is_of_range("steps", steps.into(), 1)?;
            is_of_range("steps * joints", u64::from(steps) * dof, 1)?;
            let allowed = [1, steps.into()];
            if every == 0 || every > steps {
                return Err(GpuError::Range { what: "every", found: every.into(), allowed });
            }
            // as on the processor, the step and its square must be finite and above zero after rounding to the number
            // type
            let (bits, is_usable) = match T::PRECISION {
                #[allow(clippy::cast_possible_truncation)]
                Precision::Single => {
                    let step = step as f32;
                    (step.to_bits().into(), step.is_finite() && step * step > 0.0)
                }
                Precision::Double => (step.to_bits(), step.is_finite() && step * step > 0.0),
            };
            if !(step > 0.0 && is_usable) {
                return Err(GpuError::Step(step));
            }
            parameters.extend([bits, steps.into(), every.into()]);
        }
        parameters.push(states.into());
        let kernels = self.kernels(function, T::PRECISION, work != Work::Function)?;
        if states == 0 {
            return Ok(());
        }
        let kernel = if order == Order::Rows { kernels.rows } else { kernels.columns };
        let size = [states.div_ceil(WIDTH), WIDTH];
        // SAFETY: the parameters have the types of the kernel: addresses; for a rollout the step in the type of the
        // arrays and two numbers of 32 bits; and the number of states. The caller promises the rest
        unsafe { self.device.driver().launch(self.device.context(), kernel, size, stream, &parameters) }
    }

    fn compiled(&self, function: Function) -> Result<&CompiledFunction, GpuError> {
        self.arm.function(function).map_err(GpuError::Function)
    }

    /// Returns the addresses of the arguments in the order of the function, after a check of their names and sizes.
    fn checked<T: Real>(
        &self,
        function: Function,
        states: usize,
        steps: usize,
        arguments: &[(&str, &Memory<T>)],
    ) -> Result<Vec<u64>, GpuError> {
        let of_function = self.compiled(function)?.arguments();
        let known: Vec<&'static str> = of_function.iter().map(|(name, _)| *name).collect();
        let wrong = |argument: &str, is_missing| {
            let (argument, known) = (argument.to_owned(), known.clone());
            GpuError::Argument { argument, known, is_missing }
        };
        if let Some((name, _)) = arguments.iter().find(|(name, _)| !known.contains(name)) {
            return Err(wrong(name, false));
        }
        let address = |&(name, elements): &(&'static str, usize)| {
            let given = arguments.iter().find(|(given, _)| *given == name).ok_or_else(|| wrong(name, true))?;
            let steps = if name == "tau" { steps } else { 1 };
            self.sized(name, elements.saturating_mul(steps).saturating_mul(states), given.1)?;
            Ok(given.1.address())
        };
        of_function.iter().map(address).collect()
    }

    fn sized<T: Real>(&self, array: &str, expected: usize, memory: &Memory<T>) -> Result<(), GpuError> {
        if !memory.is_on(&self.device) {
            return Err(GpuError::OtherDevice { array: array.to_owned() });
        }
        let found = memory.len();
        if found == expected { Ok(()) } else { Err(GpuError::Size { array: array.to_owned(), expected, found }) }
    }

    fn kernels(&self, function: Function, precision: Precision, is_rollout: bool) -> Result<Arc<Kernels>, GpuError> {
        // locked during a translation, so that two threads do not translate the same function twice
        let mut modules = self.modules.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (function, precision, is_rollout);
        if let Some(kernels) = modules.get(&key) {
            return Ok(kernels.clone());
        }
        let compiled = self.compiled(function)?;
        let program = compiled.program();
        let (robot, prefix) = (self.arm.robot(), Prefix::of(self.arm.robot()));
        if is_rollout && !is_for_rollouts(function) {
            let words = format!("no rollout is possible by {function}; by forward_dynamics it is");
            return Err(GpuError::Constant(words));
        }
        let additions = Additions { rollout: is_rollout, ..Additions::default() };
        let text = ptx(robot, std::slice::from_ref(program), precision, &prefix, &additions);
        let text = text.map_err(|error| GpuError::Constant(error.to_string()))?;
        let (driver, context, device) = (self.device.driver(), self.device.context(), self.device.clone());
        let module = driver.module(context, &text)?;
        let name = if is_rollout { program.name.replace("forward_dynamics", "rollout") } else { program.name.clone() };
        let parameters = compiled.arguments().len() + if is_rollout { 6 } else { 2 };
        let kernel = |end| driver.kernel(context, module, &format!("{}_{name}_{end}", prefix.as_str()), parameters);
        let kernels = Arc::new(Kernels { device, module, rows: kernel("rows")?, columns: kernel("columns")? });
        modules.insert(key, kernels.clone());
        Ok(kernels)
    }
}
