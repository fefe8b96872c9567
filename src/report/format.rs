//! Numbers for people.

/// `value` with about `digits` significant digits: plain where that is short, in powers of ten elsewhere.
pub(super) fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let exponent = value.abs().log10().floor() as i32;
    if (-4..7).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        minus(&format!("{value:.decimals$}"))
    } else {
        minus(&format!("{value:.*e}", digits.saturating_sub(1)))
    }
}

/// A value that a person gave: as short as it was written, at most six significant digits.
pub(super) fn given(value: f64) -> String {
    let text = significant(value, 6);
    match text.split_once('.') {
        Some((whole, decimals)) if !text.contains('e') => {
            let decimals = decimals.trim_end_matches('0');
            if decimals.is_empty() { whole.to_string() } else { format!("{whole}.{decimals}") }
        }
        _ => text,
    }
}

/// `value` with a fixed number of decimals; a dash when it is not finite.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() { minus(&format!("{value:.decimals$}")) } else { "–".into() }
}

/// The same with a plus sign when positive.
pub(super) fn signed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    if value > 0.0 && value.is_finite() { format!("+{text}") } else { text }
}

/// An error measure as a power of ten with two digits, `–` when it is not finite.
pub(super) fn power(value: f64) -> String {
    if value.is_finite() { format!("{value:.1e}") } else { "–".into() }
}

/// The minus sign of print, and none before a number that rounds to zero.
fn minus(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_string(),
        Some(digits) => format!("−{}", digits.replace("e-", "e−")),
        None => text.replace("e-", "e−"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits() {
        assert_eq!(significant(1668.34, 4), "1668");
        assert_eq!(significant(0.012345, 3), "0.0123");
        assert_eq!(significant(-3.04e-8, 3), "−3.04e−8");
        assert_eq!(significant(123456.7, 2), "123457");
        assert_eq!(significant(f64::NAN, 3), "–");
        assert_eq!(
            (given(936.0), given(0.5), given(1e-9)),
            ("936".into(), "0.5".into(), "1.00000e−9".into())
        );
        assert_eq!(fixed(-0.0004, 2), "0.00");
        assert_eq!(signed(1.25, 1), "+1.2");
        assert_eq!(signed(-1.26, 1), "−1.3");
    }
}
