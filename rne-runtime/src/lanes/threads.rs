//! Uses the threads of rayon, or computes without them in a process that does not have them.
//!
//! `fork` copies a process with only the thread that called it. The memory of the child then still contains the
//! parent's pool of threads, but not the threads, so waiting for them would never end. Therefore the first batch
//! records the process in which it runs, and a process with another id computes on the calling thread.

use std::sync::atomic::{AtomicU32, Ordering};

/// The id of the process that has the threads of rayon; 0 before the first batch.
static OWNER: AtomicU32 = AtomicU32::new(0);

/// Runs two parts of a batch: on two threads if this process has them, otherwise one after the other.
pub(crate) fn join(first: impl FnOnce() + Send, second: impl FnOnce() + Send) {
    if has_threads(&OWNER, process()) {
        rayon::join(first, second);
    } else {
        first();
        second();
    }
}

/// Whether `process` has the threads whose owner is recorded in `owner`. If there is no owner yet, it becomes the
/// owner.
fn has_threads(owner: &AtomicU32, process: u32) -> bool {
    // not a lock: if another thread holds it during `fork`, it stays locked in the child forever
    match owner.compare_exchange(0, process, Ordering::Relaxed, Ordering::Relaxed) {
        Ok(_) => true,
        Err(owner) => owner == process,
    }
}

#[cfg(unix)]
fn process() -> u32 {
    std::process::id()
}

/// On other systems nothing copies a process; WebAssembly has not even a process id.
#[cfg(not(unix))]
fn process() -> u32 {
    1
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::has_threads;

    #[test]
    fn a_copy_of_a_process_has_no_threads() {
        let owner = AtomicU32::new(0);
        assert!(has_threads(&owner, 7), "the first batch starts them");
        assert!(has_threads(&owner, 7));
        // the child has a copy of its parent's memory, and gets the same answer every time
        let copied = AtomicU32::new(owner.load(Ordering::Relaxed));
        assert!(!has_threads(&copied, 8) && !has_threads(&copied, 8));
        // a child that is created before the first batch starts threads of its own
        assert!(has_threads(&AtomicU32::new(0), 8));
    }
}
