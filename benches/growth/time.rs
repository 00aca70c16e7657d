//! Times of work that this process does or waits for.

use std::time::Instant;

/// What some work returns, and the seconds that it takes: `start` is any time before it.
pub(crate) fn of<T>(start: Instant, work: impl FnOnce() -> T) -> (T, f64) {
    let before = seconds(start);
    let done = work();
    (done, seconds(start) - before)
}

/// Processor time of this process and of those it has waited for; without Linux, time since `start`.
fn seconds(start: Instant) -> f64 {
    processor_seconds().unwrap_or_else(|| start.elapsed().as_secs_f64())
}

fn processor_seconds() -> Option<f64> {
    const TICKS_PER_SECOND: f64 = 100.0;
    let number = |word: Option<&str>| word.and_then(|word| word.parse::<f64>().ok());
    let schedule = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let own = number(schedule.split_whitespace().next())?; // in ns
    let status = std::fs::read_to_string("/proc/self/stat").ok()?;
    let (_, words) = status.rsplit_once(')')?;
    let mut of_children = words.split_whitespace().skip(13);
    Some(own * 1e-9 + (number(of_children.next())? + number(of_children.next())?) / TICKS_PER_SECOND)
}
