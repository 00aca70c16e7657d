//! Runs long work without the interpreter's lock, so that Ctrl-C can end it.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// Time between two checks for signals.
const MOMENT: Duration = Duration::from_millis(20);

/// The exception of a signal's handler, as the payload of the panic that ends the work.
struct Interrupted(PyErr);

/// Runs the handlers of signals that have arrived. Work that does not have the interpreter's lock calls it.
#[allow(clippy::redundant_closure_for_method_calls)] // the method itself has only one lifetime
pub(crate) fn check_signals() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}

/// Runs work without the interpreter's lock. The work reports progress. If the handler of a signal raises then, the
/// work ends by a panic that is caught here, because readers of logs have no other way to stop.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    work: impl Send + FnOnce(&mut dyn FnMut(f64)) -> T,
) -> PyResult<T> {
    let done = py.detach(|| {
        let mut looked: Option<Instant> = None;
        let mut look = |_share: f64| {
            if looked.is_some_and(|looked| looked.elapsed() < MOMENT) {
                return;
            }
            looked = Some(Instant::now());
            if let Err(error) = check_signals() {
                resume_unwind(Box::new(Interrupted(error)));
            }
        };
        catch_unwind(AssertUnwindSafe(|| work(&mut look)))
    });
    done.or_else(|thrown: Box<dyn Any + Send>| match thrown.downcast::<Interrupted>() {
        Ok(interrupted) => Err(interrupted.0),
        Err(panic) => resume_unwind(panic),
    })
}
