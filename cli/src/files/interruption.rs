//! Handles Ctrl-C, SIGTERM and SIGHUP: they end the program, and its temporary files are removed first.
//!
//! A search may [`expect`] Ctrl-C instead: the first one ends the search, which keeps its best result; the second one
//! ends the program.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};
use std::{fs, io, process};

/// Whether the first Ctrl-C only asks a search to stop.
static EXPECTED: AtomicBool = AtomicBool::new(false);

/// Set to true by the first Ctrl-C if it is expected.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// The temporary files and folders that exist now.
static TEMPORARY: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// From now on the first Ctrl-C only asks the command to stop, if the system allows to catch signals.
pub(crate) fn expect() {
    EXPECTED.store(true, Ordering::Relaxed);
    catch();
}

/// Returns whether the first Ctrl-C has asked the command to stop.
pub(crate) fn is_wished() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// From now on, a signal that ends the program removes the temporary files first. It must be called before other
/// threads start, because a signal could end the program directly through a thread that was started before.
pub(crate) fn catch() {
    static ONCE: Once = Once::new();
    ONCE.call_once(signals::catch);
}

/// Locks the list of temporary paths. While the lock is held no signal ends the program, so files that are written or
/// renamed meanwhile are complete or unchanged.
pub(crate) fn hold() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // after a panic in another thread the list is still valid
    TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary file or folder that a signal removes. It must be dropped after the file itself: as a later field, or as
/// a variable declared before it.
pub(crate) struct Registered(PathBuf);

impl Registered {
    /// Makes a temporary file or folder and registers its path in one step. In the returned pair the file comes second,
    /// because variables are dropped in reverse order.
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

/// The exit status after Ctrl-C: 128 plus the number of SIGINT.
const INTERRUPTED_STATUS: i32 = 130;

/// Removes all temporary files and ends the program by `end`. The list stays locked until then, so that no new file
/// appears.
fn end_by(end: impl FnOnce()) -> ! {
    let paths = hold();
    for path in paths.iter() {
        let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    }
    end();
    process::exit(INTERRUPTED_STATUS)
}

/// Handles Ctrl-C in a command that expects it: the first one is recorded, the second one ends the program.
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

    /// Stack size of the thread that waits for signals, bytes; it does little.
    const STACK: usize = 256 << 10;

    /// Starts a thread that waits for the signals. This thread and all threads started later block them.
    pub(super) fn catch() {
        let signals: SigSet = [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP, Signal::SIGQUIT].into_iter().collect();
        if signals.thread_block().is_err() {
            return;
        }
        // Writing beyond the limit of file sizes then fails with an error, which is reported, and the signal does not
        // end the program.
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
            // ended by the signal itself, so that a shell sees which signal it was (status 128 plus its number)
            end_by(|| {
                let _ = SigSet::from(signal).thread_unblock();
                let _ = raise(signal);
            });
        }
    }

    /// Returns whether the parent process asked to ignore the signal, as `nohup` does. On Linux a waiting thread
    /// receives also ignored signals; on other systems it does not.
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
