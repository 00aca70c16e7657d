//! Ctrl-C: the first one ends a search, which keeps its best; the second one ends the program.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by Ctrl-C.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// From now on Ctrl-C is a wish, if a handler can be had at all.
pub(crate) fn expect() {
    let _ = ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            process::exit(130);
        }
    });
}

/// Whether it was pressed.
pub(crate) fn is_wished() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}
