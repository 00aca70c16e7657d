//! Limits of a log. A small file may claim a lot: memory and time stay within bounds whatever it claims.

/// Joints of a log, of a message or of a row: more than any arm has.
pub(crate) const MOST_JOINTS: usize = 1024;

/// Bytes of the name of a joint, a column or a topic.
pub(crate) const LONGEST_NAME: usize = 256;

/// Numbers of rows that are held at once: 32 MB.
pub(crate) const MOST_NUMBERS: usize = 1 << 22;

/// Bytes of messages that are held at once.
pub(crate) const MOST_BYTES: usize = 32 << 20;

/// Steps of a gap that is filled.
pub(crate) const LONGEST_GAP: f64 = 1000.0;

/// Rows of a grid for each state of the log, once there are more than [`FEW_ROWS`]: what is filled is not measured.
pub(crate) const MOST_FILLED: u64 = 20;

/// Rows of a grid that nobody waits for.
pub(crate) const FEW_ROWS: u64 = 100_000;

/// Why a message or a row has too many joints, if it has.
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

/// Work is counted, in tests: it is to grow as the log does, and no clock tells that surely.
pub(crate) mod work {
    #[cfg(test)]
    thread_local! {
        static DONE: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
    }

    /// Adds to the work of this thread: a name or a number that was looked at.
    #[inline]
    #[cfg_attr(not(test), expect(unused_variables, reason = "only tests count"))]
    pub(crate) fn add(steps: usize) {
        #[cfg(test)]
        DONE.set(DONE.get() + steps as u64);
    }

    /// Work that a call has done.
    #[cfg(test)]
    pub(crate) fn of(call: impl FnOnce()) -> u64 {
        let before = DONE.get();
        call();
        DONE.get() - before
    }
}
