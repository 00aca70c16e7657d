//! Converts the times of a log to dates.

use std::fmt;

use crate::Layout;

/// Stamps below this value, ns, count from the start of a machine, not from 1970.
const LEAST_DATE: i64 = 315_360_000_000_000_000;

/// Lengths of a second and a day, ms.
const SECOND: i64 = 1000;
const DAY: i64 = 86_400 * SECOND;

/// An instant in UTC, stored as a time stamp since 1970, ns. `Display` writes it as `2026-11-23 08:00:10 UTC`, without
/// fractions of a second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct UtcTime(i64);

impl UtcTime {
    /// Makes an instant from a stamp, ns since 1970. `None` for a stamp of the first ten years, which counts from the
    /// start of a machine.
    #[must_use]
    pub fn of_stamp(stamp: i64) -> Option<Self> {
        (stamp > LEAST_DATE).then_some(Self(stamp))
    }

    /// Returns the stamp, ns since 1970.
    #[must_use]
    pub fn stamp(self) -> i64 {
        self.0
    }

    /// Returns the day, such as `2026-11-23`.
    #[must_use]
    pub fn day(self) -> String {
        date(self.milliseconds().div_euclid(DAY))
    }

    /// Formats the instant by RFC 3339, with milliseconds: `2026-11-23T08:00:10.528Z`.
    #[must_use]
    pub fn rfc3339(self) -> String {
        format!("{}T{}.{:03}Z", self.day(), self.clock(), self.milliseconds().rem_euclid(SECOND))
    }

    /// Reads an instant from a text of [`Self::rfc3339`]. `None` for any other text.
    #[must_use]
    pub fn from_rfc3339(text: &str) -> Option<Self> {
        let numbers: Vec<i64> = text.split(['-', 'T', ':', '.', 'Z']).map_while(|part| part.parse().ok()).collect();
        let [year, month, day, hours, minutes, seconds, parts] = numbers[..] else { return None };
        if !(1970..=9999).contains(&year) || ![month, day, hours, minutes].iter().all(|of| (0..=60).contains(of)) {
            return None;
        }
        let clock = SECOND * (3600 * hours + 60 * minutes + seconds.clamp(0, 60)) + parts.clamp(0, SECOND);
        let milliseconds = days(year, month, day) * DAY + clock;
        let time = milliseconds.checked_mul(1_000_000).and_then(Self::of_stamp)?;
        // refuses dates that do not exist, such as 30 February
        (time.rfc3339() == text).then_some(time)
    }

    /// Returns the time of day, such as `08:00:10`.
    fn clock(self) -> String {
        let seconds = self.milliseconds().rem_euclid(DAY) / SECOND;
        format!("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)
    }

    /// Returns the time since 1970, rounded to ms.
    fn milliseconds(self) -> i64 {
        self.0.saturating_add(500_000).div_euclid(1_000_000)
    }
}

impl fmt::Display for UtcTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} UTC", self.day(), self.clock())
    }
}

impl Layout {
    /// Converts a time of the log, s, to an instant. `None` if the times of the log do not count from 1970.
    #[must_use]
    pub fn utc(&self, time: f64) -> Option<UtcTime> {
        let origin = UtcTime::of_stamp(self.origin)?;
        #[expect(clippy::cast_possible_truncation, reason = "it saturates")]
        let since = (time * 1e9).round() as i64;
        time.is_finite().then(|| UtcTime(origin.0.saturating_add(since)))
    }
}

/// Returns the date of a number of days since 1970-01-01, in the Gregorian calendar.
///
/// H. F. Fliegel, T. C. van Flandern, A machine algorithm for processing calendar dates, CACM 11 (1968), 657.
fn date(days: i64) -> String {
    let l = days + 2_440_588 + 68_569;
    let n = 4 * l / 146_097;
    let l = l - (146_097 * n + 3) / 4;
    let i = 4000 * (l + 1) / 1_461_001;
    let l = l - 1461 * i / 4 + 31;
    let j = 80 * l / 2447;
    let (day, l) = (l - 2447 * j / 80, j / 11);
    format!("{:04}-{:02}-{day:02}", 100 * (n - 49) + i + l, j + 2 - 12 * l)
}

/// Returns the number of days from 1970-01-01 to a date. It is the inverse of [`date`], by the same authors.
fn days(year: i64, month: i64, day: i64) -> i64 {
    let late = (month - 14) / 12;
    1461 * (year + 4800 + late) / 4 + 367 * (month - 2 - 12 * late) / 12 - 3 * ((year + 4900 + late) / 100) / 4 + day
        - 32_075
        - 2_440_588
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected dates are those of GNU date: `date -u -d @1795420810`.
    #[test]
    fn instants_are_dates() {
        for (stamp, shown, written) in [
            (1_795_420_810_528_000_000, "2026-11-23 08:00:10 UTC", "2026-11-23T08:00:10.528Z"),
            (1_709_251_199_999_400_000, "2024-02-29 23:59:59 UTC", "2024-02-29T23:59:59.999Z"),
            // rounding to ms gives the next month
            (1_709_251_199_999_600_000, "2024-03-01 00:00:00 UTC", "2024-03-01T00:00:00.000Z"),
            (4_102_444_800_000_000_000, "2100-01-01 00:00:00 UTC", "2100-01-01T00:00:00.000Z"),
        ] {
            let time = UtcTime::of_stamp(stamp).expect("a date");
            assert_eq!((time.to_string().as_str(), time.rfc3339().as_str()), (shown, written));
            assert_eq!((time.day().as_str(), time.stamp()), (&shown[..10], stamp));
        }
        assert_eq!(UtcTime::of_stamp(86_400_000_000_000), None);
        // every day of 200 years
        for day in 4000..77_000 {
            let written = format!("{}T23:59:59.999Z", date(day));
            let time = UtcTime::from_rfc3339(&written).expect(&written);
            assert_eq!(time.stamp(), (day + 1) * 86_400_000_000_000 - 1_000_000);
        }
        let wrong =
            ["2023-02-29T08:00:10.528Z", "2026-11-23 08:00:10.528Z", "2026-11-23", "99999999999-01-01T0:0:0.0Z"];
        assert!(wrong.iter().all(|text| UtcTime::from_rfc3339(text).is_none()));
    }
}
