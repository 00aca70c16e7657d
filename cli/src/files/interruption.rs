//! Ctrl-C, SIGTERM and SIGHUP: they end the program, and no temporary file is left behind.
//!
//! A search may [`expect`] Ctrl-C instead: the first one ends the search, which keeps its best; the second one ends the
//! program.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};
use std::{fs, io, process};

/// Whether the first Ctrl-C is a wish.
static EXPECTED: AtomicBool = AtomicBool::new(false);

/// Set by Ctrl-C where it is expected.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// The temporary files and folders that are on the disk now.
static TEMPORARY: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// From now on the first Ctrl-C is a wish, if signals can be caught at all.
pub(crate) fn expect() {
    EXPECTED.store(true, Ordering::Relaxed);
    catch();
}

/// Whether Ctrl-C was pressed.
pub(crate) fn is_wished() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// From now on a signal that ends the program removes the temporary files first. Called before the threads of the work
/// start, for a thread of before would still be ended by the signal itself.
pub(crate) fn catch() {
    static ONCE: Once = Once::new();
    ONCE.call_once(signals::catch);
}

/// The registered paths. While this is held no signal ends the program, so what is written or renamed meanwhile is
/// done whole or not at all.
pub(crate) fn hold() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // a panic elsewhere leaves the paths as they are
    TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary file or folder that a signal removes. It outlives the file: a field after that of
/// the file, or a variable before it.
pub(crate) struct Registered(PathBuf);

impl Registered {
    /// Makes a temporary file or folder and registers its path in one step. Variables are dropped in reverse order, so
    /// that of the file comes second.
    pub(crate) fn new<T: AsRef<Path>>(make: impl FnOnce() -> io::Result<T>) -> io::Result<(Self, T)> {
        catch();
        let mut paths = hold();
        let made = make()?;
        let path = made.as_ref().to_owned();
        paths.insert(path.clone());
        Ok((Self(path), made))
    }
}

impl Drop for Registered {
    fn drop(&mut self) {
        hold().remove(&self.0);
    }
}

/// Exit status of what Ctrl-C ended: 128 and the number of SIGINT.
const INTERRUPTED_STATUS: i32 = 130;

/// Removes all temporary files and ends the program by `end`. The paths stay held until then: nothing new is written.
fn end_by(end: impl FnOnce()) -> ! {
    let paths = hold();
    for path in paths.iter() {
        let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    }
    end();
    process::exit(INTERRUPTED_STATUS)
}

/// Handles Ctrl-C in a command that expects it; does nothing in others.
fn expected_interrupt() {
    if EXPECTED.load(Ordering::Relaxed) && INTERRUPTED.swap(true, Ordering::Relaxed) {
        end_by(|| ());
    }
}

#[cfg(unix)]
mod signals {
    use std::thread;

    use nix::sys::signal::{SigSet, Signal, raise};

    use super::{EXPECTED, Ordering, end_by, expected_interrupt};

    /// Bytes: the thread does little.
    const STACK: usize = 256 << 10;

    /// A thread waits for the signals; all threads that are started later block them, as this one does.
    pub(super) fn catch() {
        let signals: SigSet = [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP, Signal::SIGQUIT].into_iter().collect();
        if signals.thread_block().is_err() {
            return;
        }
        // Beyond the limit of a file's size, writing then fails with an error, which is told, and ends nothing.
        let _ = SigSet::from(Signal::SIGXFSZ).thread_block();
        let waiting = move || {
            loop {
                if let Ok(signal) = signals.wait() {
                    received(signal);
                }
            }
        };
        let thread = thread::Builder::new().name("signals".to_owned()).stack_size(STACK).spawn(waiting);
        if thread.is_err() {
            let _ = signals.thread_unblock();
        }
    }

    fn received(signal: Signal) {
        if signal == Signal::SIGINT && EXPECTED.load(Ordering::Relaxed) {
            expected_interrupt();
        } else if !is_ignored(signal) {
            // by the signal itself, so that a shell sees what has ended the program: 128 and the signal's number
            end_by(|| {
                let _ = SigSet::from(signal).thread_unblock();
                let _ = raise(signal);
            });
        }
    }

    /// Whether whoever started the program wants the signal ignored, as `nohup` does. Linux hands an ignored signal to
    /// a thread that waits for it; other systems do not.
    fn is_ignored(signal: Signal) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        ignored.is_some_and(|mask| mask >> (signal as u32 - 1) & 1 == 1)
    }
}

#[cfg(not(unix))]
mod signals {
    use super::{EXPECTED, Ordering, end_by, expected_interrupt};

    pub(super) fn catch() {
        let _ = ctrlc::set_handler(|| {
            if EXPECTED.load(Ordering::Relaxed) {
                expected_interrupt();
            } else {
                end_by(|| ());
            }
        });
    }
}
