//! The cut-offs of the low-pass filter that are possible for a log.

use rne_logs::Log;

use crate::Options;
use crate::arm_log::error::ArmLogError;

/// Ratio of the cut-off of the log's own filter, which smooths positions, to that of the low-pass filter. The former is
/// higher, so that it does not change the torques in the band that is used.
pub(crate) const WIDER: f64 = 4.0;

/// Ratio of the cut-off of the low-pass filter to the one that the spectrum of the motion determines: the motion
/// passes, and most noise does not.
pub(crate) const PART: f64 = 0.5;

/// Highest cut-off of the log's own filter, as part of the sampling rate.
const HIGHEST: f64 = 0.3;

/// Returns the highest possible cut-off of the log's own filter, Hz.
pub(crate) fn highest(log: &Log) -> f64 {
    HIGHEST / log.layout().step
}

/// Refuses a cut-off of the low-pass filter, Hz, that is too high for the sampling rate or too low for the longest run,
/// s. `left` returns how much of that run, s, the log's own filter leaves for a cut-off of the low-pass filter.
pub(crate) fn check_cutoff(log: &Log, cutoff: f64, longest: f64, left: impl Fn(f64) -> f64) -> Result<(), ArmLogError> {
    let rate = 1.0 / log.layout().step;
    let highest = highest(log);
    let is_left = |cutoff: f64| left(cutoff) > 2.0 * Options::filter_reach(cutoff);
    if cutoff <= highest && is_left(cutoff) {
        return Ok(());
    }
    // bisection: the time that is left grows with the cut-off
    let (mut too_low, mut lowest) = (0.0, highest);
    while lowest - too_low > 1e-3 * lowest {
        let middle = f64::midpoint(too_low, lowest);
        *(if is_left(middle) { &mut lowest } else { &mut too_low }) = middle;
    }
    let possible = is_left(highest).then_some([lowest, highest]);
    Err(ArmLogError::Cutoff { cutoff, rate, longest, possible })
}
