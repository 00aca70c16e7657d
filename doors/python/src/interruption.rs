//! Long work without the interpreter's lock, which Ctrl-C ends.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// Time between two looks at signals.
const MOMENT: Duration = Duration::from_millis(20);

/// An exception of a signal's handler, on its way out of the work.
struct Interrupted(PyErr);

/// Runs the handlers of signals that have come, from work without the lock.
#[allow(clippy::redundant_closure_for_method_calls)] // the method is of one lifetime
pub(crate) fn check_signals() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}

/// Does work without the lock. The work reports progress; a signal whose handler raises ends it there, by unwinding,
/// for readers of logs cannot be told to stop.
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
