//! The threads of rayon, and what is done where a process does not have them.
//!
//! `fork` copies a process with the thread that called it and no other. The pool of the parent is then still in the
//! memory of the child, but its threads are not: whoever waits for them waits for ever. So the first batch notes the
//! process that it runs in, and a process with another id computes on the calling thread.

use std::sync::atomic::{AtomicU32, Ordering};

/// The process whose threads are those of rayon; 0 before the first batch.
static OWNER: AtomicU32 = AtomicU32::new(0);

/// Runs two parts of a batch: on two threads where this process has them, or one after the other.
pub(crate) fn join(first: impl FnOnce() + Send, second: impl FnOnce() + Send) {
    if has_threads(&OWNER, process()) {
        rayon::join(first, second);
    } else {
        first();
        second();
    }
}

/// Whether threads that `owner` notes are those of a process, which becomes the owner when there was none.
fn has_threads(owner: &AtomicU32, process: u32) -> bool {
    // no lock: `fork` copies one that another thread holds, and nobody would open it
    match owner.compare_exchange(0, process, Ordering::Relaxed, Ordering::Relaxed) {
        Ok(_) => true,
        Err(owner) => owner == process,
    }
}

#[cfg(unix)]
fn process() -> u32 {
    std::process::id()
}

/// Elsewhere nothing copies a process; WebAssembly does not even know an id.
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
        // the child has the memory of its parent, and the same answer every time
        let copied = AtomicU32::new(owner.load(Ordering::Relaxed));
        assert!(!has_threads(&copied, 8) && !has_threads(&copied, 8));
        // a child that is made before the first batch starts threads of its own
        assert!(has_threads(&AtomicU32::new(0), 8));
    }
}
