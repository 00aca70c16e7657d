//! Limits of a log. They keep memory and time bounded, whatever sizes a file states.

/// Largest number of joints of a log, a message or a row: more than any arm has.
pub(crate) const MOST_JOINTS: usize = 1024;

/// Largest number of bytes of the name of a joint, a column or a topic.
pub(crate) const LONGEST_NAME: usize = 256;

/// Largest count of numbers in rows that are in memory at once: 32 MB.
pub(crate) const MOST_NUMBERS: usize = 1 << 22;

/// Largest number of bytes of messages that are in memory at once.
pub(crate) const MOST_BYTES: usize = 32 << 20;

/// Longest gap that is filled by interpolation, in sampling intervals.
pub(crate) const LONGEST_GAP: f64 = 1000.0;

/// Largest number of rows of an even grid for each state of the log, checked above [`FEW_ROWS`] rows, because
/// interpolated rows are not measured.
pub(crate) const MOST_FILLED: u64 = 20;

/// Number of rows of an even grid up to which the computing time is negligible.
pub(crate) const FEW_ROWS: u64 = 100_000;

/// Refuses a message with too many joints, or with names that are too long; `Err` is the reason.
#[cfg(feature = "bags")]
pub(crate) fn check_names<'a>(mut names: impl ExactSizeIterator<Item = &'a str>) -> Result<(), String> {
    if names.len() > MOST_JOINTS {
        return Err(format!("it names {} joints; rne reads at most {MOST_JOINTS}", names.len()));
    }
    match names.find(|name| name.len() > LONGEST_NAME) {
        Some(name) => Err(format!(
            "the name of a joint has {} bytes; rne reads names of at most {LONGEST_NAME} bytes",
            name.len()
        )),
        None => Ok(()),
    }
}

/// Counts work in tests: it must grow in proportion to the log, which times cannot show reliably.
pub(crate) mod work {
    #[cfg(test)]
    thread_local! {
        static DONE: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
    }

    /// Adds steps to the work of this thread: names or numbers that were processed.
    #[inline]
    #[cfg_attr(not(test), expect(unused_variables, reason = "only tests count"))]
    pub(crate) fn add(steps: usize) {
        #[cfg(test)]
        DONE.set(DONE.get() + steps as u64);
    }

    /// Returns the work of a call.
    #[cfg(test)]
    pub(crate) fn of(call: impl FnOnce()) -> u64 {
        let before = DONE.get();
        call();
        DONE.get() - before
    }
}
