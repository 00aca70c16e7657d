//! The low-passes that are possible for a log.

use rne_logs::Log;

use crate::Options;
use crate::arm_log::error::ArmLogError;

/// Ratio of the cut-off of the log's own filter to that of the low-pass. The first is wider, so that it does not shape
/// torques.
pub(crate) const WIDER: f64 = 4.0;

/// Ratio of the low-pass to the filter that the spectrum chooses: what moves passes, and most noise does not.
pub(crate) const PART: f64 = 0.5;

/// Highest cut-off of the log's filter, as part of the sampling rate.
const HIGHEST: f64 = 0.3;

/// Highest cut-off of the log's filter, Hz.
pub(crate) fn highest(log: &Log) -> f64 {
    HIGHEST / log.layout().step
}

/// Refuses a low-pass that samples are too far apart for, or that the longest run, s, has no room for: what is `left`
/// of it beside a low-pass.
pub(crate) fn check_cutoff(log: &Log, cutoff: f64, longest: f64, left: impl Fn(f64) -> f64) -> Result<(), ArmLogError> {
    let rate = 1.0 / log.layout().step;
    let highest = highest(log);
    let is_left = |cutoff: f64| left(cutoff) > 2.0 * Options::filter_reach(cutoff);
    if cutoff <= highest && is_left(cutoff) {
        return Ok(());
    }
    // what is left grows with the low-pass
    let (mut too_low, mut lowest) = (0.0, highest);
    while lowest - too_low > 1e-3 * lowest {
        let middle = f64::midpoint(too_low, lowest);
        *(if is_left(middle) { &mut lowest } else { &mut too_low }) = middle;
    }
    let possible = is_left(highest).then_some([lowest, highest]);
    Err(ArmLogError::Cutoff { cutoff, rate, longest, possible })
}
