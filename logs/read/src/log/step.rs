//! Finds the interval between the samples of a log, and checks the unit of its times.

use std::path::Path;

use crate::number::short;
use crate::remedy::Setting;
use crate::{LogError, TimeUnit};

/// Interval, s, from which on times are refused unless the user gives their unit: logs with such long intervals are
/// rare, so the times probably have another unit than s.
const SLOWEST: f64 = 0.5;

/// Interval, s, from which on a note says that times are read as seconds: 0.1 may also mean ms at 10 kHz.
const SLOW: f64 = 0.0999;

/// Returns the median of the intervals between increasing times, s.
#[expect(clippy::cast_precision_loss, reason = "ns of a step")]
pub(super) fn median_step(path: &Path, times: &[i64]) -> Result<f64, LogError> {
    let mut steps: Vec<i64> = times.windows(2).filter_map(|pair| pair[1].checked_sub(pair[0])).collect();
    steps.retain(|step| *step > 0);
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return Err(match times.len() {
            1 => LogError::file(path, "the log has one joint state; a motion needs many"),
            count => LogError::file(path, format_args!("the times of the first {count} joint states do not increase")),
        });
    }
    Ok(*steps.select_nth_unstable(middle).1 as f64 * 1e-9)
}

/// Refuses rows that are often not in the order of time.
pub(super) fn check_order(path: &Path, times: &[i64]) -> Result<(), LogError> {
    let (back, count) = (times.windows(2).filter(|pair| pair[1] < pair[0]).count(), times.len());
    if 4 * back <= count {
        return Ok(());
    }
    let what = format!(
        "the rows are not in the order of time: in the first {count} rows, time goes back {back} times; sort the rows \
         by their time"
    );
    Err(LogError::file(path, what))
}

/// Refuses times of unknown unit with intervals that are very long for seconds. Returns a note for intervals that are
/// nearly as long.
pub(super) fn check_unit(path: &Path, step: f64) -> Result<Option<String>, LogError> {
    let rates = rates(step);
    if step >= SLOWEST {
        let what = format!(
            "the unit of the times is not known: the times are {} apart, so samples are at {rates}; if the times only \
             count rows, remove their column and give the sampling rate",
            short(step)
        );
        return Err(LogError::request(path, what).give(Setting::TimeUnit).give(Setting::Rate));
    }
    let note = || {
        format!(
            "the times have no unit, so rne reads them as seconds unless you give another unit: samples are at {rates}"
        )
    };
    Ok((step >= SLOW).then(note))
}

/// Returns the sampling rates, in words, that the interval means in each unit of time.
fn rates(step: f64) -> String {
    let words = |unit: TimeUnit, rate: f64| {
        let (rate, prefix) = match rate {
            rate if rate >= 1e9 => (rate * 1e-9, "G"),
            rate if rate >= 1e6 => (rate * 1e-6, "M"),
            rate if rate >= 1e3 => (rate * 1e-3, "k"),
            rate => (rate, ""),
        };
        format!("{} {prefix}Hz in {}", short(rate), unit.name())
    };
    let units = [
        (TimeUnit::Seconds, 1.0),
        (TimeUnit::Milliseconds, 1e3),
        (TimeUnit::Microseconds, 1e6),
        (TimeUnit::Nanoseconds, 1e9),
    ];
    units.map(|(unit, each)| words(unit, each / step)).join(", ")
}
