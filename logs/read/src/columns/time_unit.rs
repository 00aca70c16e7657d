//! Units of time stamps in tables. Internally, stamps are whole nanoseconds: floating-point seconds since 1970 have a
//! resolution of only a quarter of a microsecond, which would add errors to velocities.

/// The unit of a column of times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeUnit {
    /// Seconds, s.
    #[default]
    Seconds,
    /// Milliseconds, ms.
    Milliseconds,
    /// Microseconds, µs.
    Microseconds,
    /// Nanoseconds, ns.
    Nanoseconds,
}

impl TimeUnit {
    /// Returns the number of nanoseconds in one of this unit.
    pub(crate) fn nanoseconds(self) -> i64 {
        match self {
            Self::Seconds => 1_000_000_000,
            Self::Milliseconds => 1_000_000,
            Self::Microseconds => 1_000,
            Self::Nanoseconds => 1,
        }
    }

    /// Converts a number of this unit to ns; `None` if it is not a time between the years 1678 and 2262.
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "the range is looked at")]
    pub(crate) fn number(self, number: f64) -> Option<i64> {
        let time = (number * self.nanoseconds() as f64).round();
        (time.abs() < 9e18).then_some(time as i64)
    }

    /// Converts a text in this unit to ns. Decimal numbers are converted exactly.
    pub(crate) fn parse(self, text: &str) -> Option<i64> {
        let (negative, digits) = text.strip_prefix('-').map_or((false, text), |digits| (true, digits));
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let is_decimal = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        if !is_decimal(whole) || !is_decimal(fraction) || whole.is_empty() {
            return self.number(text.parse().ok()?);
        }
        let mut time = whole.parse::<i64>().ok()?.checked_mul(self.nanoseconds())?;
        let mut of_digit = self.nanoseconds();
        for digit in fraction.bytes().take(10) {
            let value = i64::from(digit - b'0');
            // rounds at the last digit of a nanosecond
            time = time.checked_add(if of_digit >= 10 { value * (of_digit / 10) } else { i64::from(value >= 5) })?;
            of_digit /= 10;
            if of_digit == 0 {
                break;
            }
        }
        Some(if negative { -time } else { time })
    }

    /// Returns the reason why a text is no time.
    pub(crate) fn refusal(self, text: &str) -> String {
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => {
                let name = self.name();
                format!("the time {text} {name} is later than the year 2262")
            }
            _ => format!("{text:?} is not a time"),
        }
    }

    /// Returns the symbol of the unit.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Seconds => "s",
            Self::Milliseconds => "ms",
            Self::Microseconds => "us",
            Self::Nanoseconds => "ns",
        }
    }

    /// Returns the time of a row, ns, of a table without times whose rows are `step` seconds apart.
    #[expect(clippy::cast_precision_loss, reason = "rows are fewer than 2^53")]
    pub(crate) fn step(row: u64, step: f64) -> i64 {
        Self::Seconds.number(row as f64 * step).unwrap_or(i64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_stamps_are_exact() {
        for (unit, text, time) in [
            (TimeUnit::Seconds, "1700000000.123456789", 1_700_000_000_123_456_789),
            (TimeUnit::Seconds, "0.0080000004", 8_000_000),
            (TimeUnit::Seconds, "0.0080000005", 8_000_001),
            (TimeUnit::Seconds, "-1.5", -1_500_000_000),
            (TimeUnit::Seconds, "8e-3", 8_000_000),
            (TimeUnit::Milliseconds, "8.000001", 8_000_001),
            (TimeUnit::Milliseconds, "8.0000019", 8_000_002),
            (TimeUnit::Microseconds, "17", 17_000),
            (TimeUnit::Nanoseconds, "17.9", 18),
        ] {
            assert_eq!(unit.parse(text), Some(time), "{text}");
        }
        for text in ["", "nan", "inf", "1e30", "99999999999999999999", "12:30"] {
            assert_eq!(TimeUnit::Seconds.parse(text), None, "{text}");
        }
    }
}
