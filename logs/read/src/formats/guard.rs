//! Guards for libraries that panic on a corrupt file: their panics become errors.

use std::cell::Cell;

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread is reading a file by a library whose panic is about to become a [`LogError`](crate::LogError). A
/// program may call this in its panic hook and print nothing if it is true. This crate does not change the panic hook.
#[must_use]
pub fn is_guarded() -> bool {
    GUARDED.get()
}

/// Returns the result of a call; `None` if it panicked. After a panic, values that the call borrowed must not be used.
#[cfg(any(feature = "bags", feature = "parquet"))]
pub(crate) fn guarded<T>(call: impl FnOnce() -> T) -> Option<T> {
    let before = GUARDED.replace(true);
    let returned = std::panic::catch_unwind(std::panic::AssertUnwindSafe(call));
    GUARDED.set(before);
    returned.ok()
}

#[cfg(all(test, any(feature = "bags", feature = "parquet")))]
mod tests {
    use super::*;

    thread_local! {
        static HEARD: Cell<u32> = const { Cell::new(0) };
    }

    /// The panic hook is called, and `is_guarded` is true in it.
    #[test]
    fn a_panic_is_nothing_and_leaves_the_hook_alone() {
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(|_| HEARD.set(HEARD.get() + u32::from(is_guarded()))));
        let returned = guarded(|| -> i32 { panic!("a file is corrupt") });
        std::panic::set_hook(usual);
        assert_eq!((returned, HEARD.get()), (None, 1));
        assert_eq!(guarded(|| i32::from(is_guarded())), Some(1));
        assert!(!is_guarded());
    }
}
