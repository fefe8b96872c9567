//! Numbers as text: in tables and messages, and as other programs write them.

/// The number that a program wrote: as C and Rust write it, or as Fortran does, with an exponent in `D` (`1.5D+03`) or without a
/// letter where it has three digits (`1.5-103`). `nan` and `inf` are numbers, too.
///
/// ```
/// use stridor_base::numbers::parse;
/// assert_eq!(["1.5D+03", "-1.5-103", "+2", ".5"].map(parse), [Some(1500.0), Some(-1.5e-103), Some(2.0), Some(0.5)]);
/// assert_eq!(["", "x", "1-2-3", "--1"].map(parse), [None; 4]);
/// ```
pub fn parse(text: &str) -> Option<f64> {
    text.parse().ok().or_else(|| {
        let plain = text.replace(['d', 'D', 'e'], "E");
        let exponent = plain.rfind(['+', '-']).filter(|at| *at > 0 && !plain.contains('E'));
        match exponent {
            Some(at) => format!("{}E{}", &plain[..at], &plain[at..]).parse().ok(),
            None => plain.parse().ok(),
        }
    })
}

/// `value` with about `digits` significant digits: plain where that is short, in powers of ten elsewhere.
pub fn significant(value: f64, digits: usize) -> String {
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

/// A frequency \[Hz\]: with a fixed number of decimals from 10 Hz to 10 MHz, with significant digits outside; zero where it is smaller
/// than any motion is slow, as the imaginary part of a real eigenvalue may be.
///
/// ```
/// use stridor_base::numbers::hertz;
/// assert_eq!([hertz(1668.34, 1), hertz(1.5918e-4, 1), hertz(1e10, 1)], ["1668.3", "0.0001592", "1.0000e10"]);
/// ```
pub fn hertz(value: f64, decimals: usize) -> String {
    const NONE: f64 = 1e-30;
    let value = if value.abs() < NONE { 0.0 } else { value };
    let size = value.abs();
    match size {
        _ if size == 0.0 || (10.0..1e7).contains(&size) => minus(&format!("{value:.decimals$}")),
        _ if size < 10.0 => significant(value, decimals + 3),
        _ => significant(value, decimals + 4),
    }
}

/// A growth rate \[1/s\] of an eigenvalue of size `lambda` \[1/s\], with its sign: two decimals, and significant digits where
/// these would hide a rate above `round_off` · `lambda`.
pub fn growth(value: f64, lambda: f64, round_off: f64) -> String {
    let size = value.abs();
    let text = match size {
        _ if !value.is_finite() => return "–".into(),
        _ if size >= 1e7 || (size < 0.1 && size > round_off * lambda) => significant(value, 3),
        _ => minus(&format!("{value:.2}")),
    };
    if value > 0.0 { format!("+{text}") } else { text }
}

/// A number as it is typed, with at most six significant digits: `10000`, `-0.0333333`, `3e-13`.
pub fn typed(value: f64) -> String {
    if value.is_finite() { given(value).replace('−', "-") } else { value.to_string() }
}

/// Coordinates or components as they are typed: `[0.1, -0.0333333, 0]`.
pub fn components(values: [f64; 3]) -> String {
    format!("[{}]", values.map(typed).join(", "))
}

/// The minus sign of print, and none before a number that rounds to zero.
pub fn minus(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_string(),
        Some(digits) => format!("−{}", digits.replace("e-", "e−")),
        None => text.replace("e-", "e−"),
    }
}

/// A value that a person gave: as short as it was written, at most six significant digits.
pub fn given(value: f64) -> String {
    shortest(value, 6)
}

/// A value without zeros at its end, of at most so many significant digits.
pub fn shortest(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (digits, exponent) = text.split_at(text.find('e').unwrap_or(text.len()));
    let digits = match digits.contains('.') {
        true => digits.trim_end_matches('0').trim_end_matches('.'),
        false => digits,
    };
    format!("{digits}{exponent}")
}

/// `value` with a fixed number of decimals; a dash when it is not finite.
pub fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() { minus(&format!("{value:.decimals$}")) } else { "–".into() }
}

/// The same with a plus sign when positive.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    if value > 0.0 && value.is_finite() { format!("+{text}") } else { text }
}

/// An error measure as a power of ten with two digits, `0` when it is zero, `–` when it is not finite.
pub fn power(value: f64) -> String {
    match value {
        0.0 => "0".into(),
        _ if value.is_finite() => format!("{value:.1e}"),
        _ => "–".into(),
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
    }

    #[test]
    fn frequencies_far_from_audio_keep_their_digits() {
        assert_eq!([hertz(0.0, 1), hertz(974.84, 1), hertz(974.84, 0)], ["0.0", "974.8", "975"]);
        assert_eq!([hertz(0.15918, 1), hertz(9.87654, 2), hertz(3.2e-7, 0)], ["0.1592", "9.8765", "3.20e−7"]);
        assert_eq!([hertz(12_345_678_901.0, 1), hertz(9_999_999.0, 1)], ["1.2346e10", "9999999.0"]);
        assert_eq!(hertz(f64::NAN, 1), "–");
        assert_eq!([-5.639e-50, 1e-300, -0.0].map(|hz| hertz(hz, 1)), ["0.0"; 3]);
    }

    #[test]
    fn components_have_six_digits() {
        assert_eq!(components([0.1, -1.0 / 30.0, 0.0]), "[0.1, -0.0333333, 0]");
        assert_eq!(components([1e-12 / 3.0, f64::NAN, 1234567.0]), "[3.33333e-13, NaN, 1234567]");
        assert_eq!(components([1e4, -0.0, 1e300]), "[10000, 0, 1e300]");
    }

    #[test]
    fn slow_growth_of_a_slow_mode_is_no_zero() {
        assert_eq!([growth(111.84, 6e3, 1e-9), growth(-2.4e-13, 6e3, 1e-9)], ["+111.84", "0.00"]);
        assert_eq!([growth(3.2e-6, 1e-3, 1e-9), growth(-3.2e-6, 1e-3, 1e-9)], ["+3.20e−6", "−3.20e−6"]);
        assert_eq!(growth(4.5e8, 1e10, 1e-9), "+4.50e8");
    }

    #[test]
    fn given_and_signed_numbers_are_short() {
        assert_eq!((given(936.0), given(0.5), given(1e-9)), ("936".into(), "0.5".into(), "1e−9".into()));
        assert_eq!(fixed(-0.0004, 2), "0.00");
        assert_eq!(signed(1.25, 1), "+1.2");
        assert_eq!(signed(-1.26, 1), "−1.3");
    }
}
