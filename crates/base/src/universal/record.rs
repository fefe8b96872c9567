//! Fields of a record as Fortran writes and reads them.

use crate::numbers::parse;

/// The fields of a line: between white space where there are as many as `widths`, in fixed columns otherwise.
pub fn fields(text: &str, widths: &[usize]) -> Vec<String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    if words.len() == widths.len() {
        return words.into_iter().map(str::to_string).collect();
    }
    columns(text, widths)
}

/// The fields of a line in fixed columns, without the blanks about them; empty beyond its end.
pub fn columns(text: &str, widths: &[usize]) -> Vec<String> {
    let mut letters = text.chars();
    let mut field = |width: &usize| letters.by_ref().take(*width).collect::<String>().trim().to_string();
    widths.iter().map(&mut field).collect()
}

/// Every number of a line: between white space, or in columns of these widths, over and over, where numbers touch. What a
/// program writes in the place of a number, such as `NaN` or Fortran's `*****`, is NaN.
pub fn values(text: &str, widths: &[usize]) -> Result<Vec<f64>, String> {
    let words: Option<Vec<f64>> = text.split_whitespace().map(value).collect();
    if let Some(words) = words {
        return Ok(words);
    }
    let pattern: Vec<usize> = widths.iter().copied().cycle().take(text.len()).collect();
    let cells = columns(text.trim_end(), &pattern);
    cells.iter().filter(|cell| !cell.is_empty()).map(|cell| value(cell).ok_or(cell.clone())).collect()
}

/// The same where every number is finite.
pub fn numbers(text: &str, widths: &[usize]) -> Result<Vec<f64>, String> {
    let numbers = values(text, widths)?;
    match numbers.iter().find(|number| !number.is_finite()) {
        Some(number) => Err(number.to_string()),
        None => Ok(numbers),
    }
}

/// A number, or NaN where a program could write none.
fn value(text: &str) -> Option<f64> {
    let none = || {
        let stars = !text.is_empty() && text.chars().all(|c| c == '*');
        let upper = text.trim_start_matches(['+', '-']).to_uppercase();
        stars || ["1.#", "NAN(", "IND", "INFINITY"].iter().any(|word| upper.starts_with(word))
    };
    parse(text).or_else(|| none().then_some(f64::NAN))
}

/// A finite number with an exponent in E or D, or in neither as Fortran writes `1.5-103`.
pub fn float(text: &str) -> Option<f64> {
    parse(text.trim()).filter(|x| x.is_finite())
}

/// A whole number, also written as `12.`; zero where nothing is written.
pub fn whole(text: &str) -> Option<i64> {
    let text = text.trim();
    if text.is_empty() { Some(0) } else { text.strip_suffix('.').unwrap_or(text).parse().ok() }
}

/// A number in Fortran's E format: ` 1.66123E+03`.
pub fn e_format(x: f64, width: usize, digits: usize) -> String {
    let plain = format!("{x:.digits$e}");
    let (mantissa, exponent) = plain.split_once('e').unwrap_or((&plain, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let sign = if exponent < 0 { '-' } else { '+' };
    let text = format!("{mantissa}E{sign}{:02}", exponent.abs());
    format!("{text:>width$}")
}

/// A line of 80 columns; what is not ASCII is left out.
pub fn text_line(text: &str) -> String {
    let text: String = text.chars().filter(|c| c.is_ascii() && !c.is_ascii_control()).take(80).collect();
    // A line of text may not be blank.
    let text = if text.trim().is_empty() { "NONE" } else { &text };
    format!("{text:<80}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_however_fortran_wrote_them() {
        assert_eq!(float(" 1.5D+03"), Some(1500.0));
        assert_eq!(float("-1.5-103"), Some(-1.5e-103));
        assert_eq!(float("-2"), Some(-2.0));
        for wrong in ["", "nan", "inf", "1e999", "--1", "é-1", "+", "1-2-3"] {
            assert_eq!(float(wrong), None, "{wrong}");
        }
        assert_eq!(whole(" 12"), Some(12));
        assert_eq!(whole(""), Some(0));
        // Numbers that touch: columns of 13.
        let touching = "-1.23456e-103-1.23456e+103  1.00000E+00";
        assert_eq!(numbers(touching, &[13]).unwrap(), [-1.23456e-103, -1.23456e103, 1.0]);
        assert_eq!(numbers("1 2   3", &[13]).unwrap(), [1.0, 2.0, 3.0]);
        assert!(numbers("1 x", &[13]).is_err());
        for none in ["NaN", "-nan", "inf", "1.#QNAN", "-1.#IND", "*************", "-Infinity"] {
            let read = values(&format!("1.0 {none}"), &[13]).unwrap();
            assert!(read[0] == 1.0 && !read[1].is_finite() && numbers(none, &[13]).is_err(), "{none}");
        }
        assert_eq!(fields("  12   3", &[5, 5, 5]), ["12", "3", ""]);
    }

    #[test]
    fn numbers_are_written_in_columns() {
        assert_eq!(e_format(-0.00123456789, 13, 5), " -1.23457E-03");
        assert_eq!(e_format(0.0, 13, 5), "  0.00000E+00");
        assert_eq!(text_line("½").trim_end(), "½".replace('½', "NONE"));
    }
}
