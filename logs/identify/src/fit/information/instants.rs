//! Chooses the instants at which rows are made, and interpolates samples there.

use crate::fit::smoothing::Kernel;
use crate::fit::structure::Structure;

/// Returns the instants at which rows are made. Without a filter, these are all states; with a filter, there is one
/// instant for every width of its kernel, or every state if states are farther apart. Near the ends, there are none
/// where the kernel, shifted by the delay of the torques, would reach beyond the samples.
pub(crate) fn instants(structure: &Structure, time: &[f64], delay: f64) -> Vec<f64> {
    let kernel = structure.options.cutoff.map(Kernel::of_cutoff);
    let (Some(first), Some(last)) = (time.first(), time.last()) else { return Vec::new() };
    let duration = last - first;
    let reach = kernel.map_or(0.0, Kernel::reach) + delay.abs();
    let (first, last) = (first + reach, last - reach);
    if first > last {
        return Vec::new();
    }
    #[allow(clippy::cast_precision_loss)] // states of a piece
    let is_wide = |kernel: &Kernel| kernel.width() * (time.len() - 1) as f64 >= duration;
    let Some(kernel) = kernel.filter(is_wide) else {
        return time.iter().copied().filter(|time| (first..=last).contains(time)).collect();
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // as many as a log has states, or fewer
    let count = ((last - first) / kernel.width()) as u64;
    #[allow(clippy::cast_precision_loss)]
    (0..=count).map(|k| first + k as f64 * kernel.width()).collect()
}

/// Interpolates samples linearly at the time `behind` (s, may be negative) after sample `at`.
pub(super) fn between(time: &[f64], at: usize, behind: f64, of: impl Fn(usize) -> f64) -> f64 {
    if behind == 0.0 {
        return of(at);
    }
    let instant = time[at] + behind;
    let next = time.partition_point(|time| *time <= instant).clamp(1, time.len() - 1);
    let elapsed = time[next] - time[next - 1];
    let part = if elapsed > 0.0 { ((instant - time[next - 1]) / elapsed).clamp(0.0, 1.0) } else { 0.0 };
    (1.0 - part) * of(next - 1) + part * of(next)
}

/// Returns the slope of the samples around sample `at`.
pub(super) fn slope(time: &[f64], values: &[f64], at: usize) -> f64 {
    let (before, after) = (at.saturating_sub(1), (at + 1).min(values.len() - 1));
    let elapsed = time[after] - time[before];
    if elapsed > 0.0 { (values[after] - values[before]) / elapsed } else { 0.0 }
}
