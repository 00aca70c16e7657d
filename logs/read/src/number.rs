//! Formats numbers for messages.

/// Formats a number with four digits; very small and very large numbers with a power of ten.
#[must_use]
pub fn short(number: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return format!("{number}");
    }
    let magnitude = number.abs().log10().floor();
    if !(-4.0..7.0).contains(&magnitude) {
        return format!("{number:.2e}");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 7")]
    let digits = (3.0 - magnitude).max(0.0) as usize;
    let text = format!("{number:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Formats a number for a table: `digits` digits after the decimal point, an exact zero as 0, very small and very large
/// numbers with a power of ten.
#[must_use]
pub fn rounded(value: f64, digits: usize) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if value.abs() < 1e-4 || value.abs() >= 1e6 {
        format!("{value:.2e}")
    } else {
        format!("{value:.digits$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 30.0007, -1.5, 1e300, 4e-9, f64::NAN].map(short);
        assert_eq!(texts, ["0", "30", "-1.5", "1.00e300", "4.00e-9", "NaN"]);
    }
}
