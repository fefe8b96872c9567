//! Arithmetic of the scalars that a case names: `omega^2 - 1`, `1/omega - 1`, with the derivative by one of them.

use std::collections::BTreeMap;

/// The longest expression \[characters\], and the deepest nesting of parentheses, signs and powers.
const LONGEST: usize = 200;
const DEEPEST: usize = 30;

/// The value of an expression and its derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual {
    /// f.
    pub value: f64,
    /// df/dp.
    pub slope: f64,
}

/// Fault of an expression: (found, expected).
pub type Wrong = (String, String);

/// The value of `text` with the scalars `names`, and its derivative by the scalar `by`: numbers, names, `+ - * / ^` and
/// parentheses. A sign binds less than a power, −a^2 = −(a^2), and powers are taken from the right.
///
/// ```
/// use stridor::case::evaluate;
/// let names = [("omega".to_string(), 2.0)].into();
/// let f = evaluate("omega^2 - 1", &names, "omega").unwrap();
/// assert_eq!((f.value, f.slope), (3.0, 4.0));
/// assert!(evaluate("1/(omega - 2)", &names, "omega").is_err());
/// ```
///
/// # Errors
/// Text that is no expression, an unknown name, a division by zero, a result that is not finite.
pub fn evaluate(text: &str, names: &BTreeMap<String, f64>, by: &str) -> Result<Dual, Wrong> {
    if text.chars().count() > LONGEST {
        let start: String = text.chars().take(40).collect();
        return Err((format!("\"{start}…\""), format!("an expression of at most {LONGEST} characters")));
    }
    let mut parser = Parser { text, at: 0, names, by, depth: 0 };
    let dual = parser.sum()?;
    match parser.peek() {
        None if dual.value.is_finite() && dual.slope.is_finite() => Ok(dual),
        None => Err((format!("\"{text}\", which is {}", dual.value), "a finite number".into())),
        Some(_) => Err(parser.unexpected()),
    }
}

/// Whether a scalar may be called so.
pub fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    names: &'a BTreeMap<String, f64>,
    by: &'a str,
    depth: usize,
}

impl Parser<'_> {
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    /// Takes `symbol` when it comes next.
    fn take(&mut self, symbol: char) -> bool {
        let next = self.peek() == Some(symbol);
        self.at += if next { symbol.len_utf8() } else { 0 };
        next
    }

    fn unexpected(&self) -> Wrong {
        let rest = self.text[self.at..].trim_start();
        let found = if rest.is_empty() { "its end".to_string() } else { format!("\"{rest}\"") };
        (
            format!("\"{}\", in which {found} stands where it cannot", self.text),
            "numbers, the names of [matrices.scalar], + - * / ^ and parentheses".into(),
        )
    }

    fn sum(&mut self) -> Result<Dual, Wrong> {
        let mut left = self.product()?;
        loop {
            let sign = match self.peek() {
                Some('+') => 1.0,
                Some('-') => -1.0,
                _ => return Ok(left),
            };
            self.at += 1;
            let right = self.product()?;
            left = Dual { value: left.value + sign * right.value, slope: left.slope + sign * right.slope };
        }
    }

    fn product(&mut self) -> Result<Dual, Wrong> {
        let mut left = self.signed()?;
        loop {
            if self.take('*') {
                let right = self.signed()?;
                left = Dual {
                    value: left.value * right.value,
                    slope: left.slope * right.value + left.value * right.slope,
                };
            } else if self.take('/') {
                let right = self.signed()?;
                if right.value == 0.0 {
                    return Err((format!("\"{}\", a division by zero", self.text), "a finite number".into()));
                }
                let value = left.value / right.value;
                left = Dual { value, slope: (left.slope - value * right.slope) / right.value };
            } else {
                return Ok(left);
            }
        }
    }

    /// One level deeper.
    fn nested(&mut self, read: impl FnOnce(&mut Self) -> Result<Dual, Wrong>) -> Result<Dual, Wrong> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err((format!("\"{}\"", self.text), format!("at most {DEEPEST} levels of nesting")));
        }
        let found = read(self);
        self.depth -= 1;
        found
    }

    fn signed(&mut self) -> Result<Dual, Wrong> {
        if self.take('-') {
            let Dual { value, slope } = self.nested(Self::signed)?;
            return Ok(Dual { value: -value, slope: -slope });
        }
        if self.take('+') {
            return self.nested(Self::signed);
        }
        let base = self.atom()?;
        if !self.take('^') {
            return Ok(base);
        }
        let exponent = self.nested(Self::signed)?;
        let (b, e) = (base.value, exponent.value);
        if b == 0.0 && e < 0.0 {
            return Err((format!("\"{}\", a division by zero", self.text), "a finite number".into()));
        }
        let by_base = if base.slope == 0.0 { 0.0 } else { e * b.powf(e - 1.0) * base.slope };
        let by_exponent = if exponent.slope == 0.0 { 0.0 } else { b.powf(e) * b.ln() * exponent.slope };
        Ok(Dual { value: b.powf(e), slope: by_base + by_exponent })
    }

    fn atom(&mut self) -> Result<Dual, Wrong> {
        if self.take('(') {
            let inside = self.nested(Self::sum)?;
            return if self.take(')') { Ok(inside) } else { Err(self.unexpected()) };
        }
        let rest = match self.peek() {
            Some(_) => &self.text[self.at..],
            None => return Err(self.unexpected()),
        };
        let name =
            rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len();
        if is_name(&rest[..name]) {
            let name = &rest[..name];
            let Some(value) = self.names.get(name) else {
                let known: Vec<&str> = self.names.keys().map(String::as_str).collect();
                let expected = match known.as_slice() {
                    [] => "numbers alone: the case has no [matrices.scalar]".to_string(),
                    known => format!("one of {}", known.join(", ")),
                };
                return Err((format!("\"{name}\" in \"{}\"", self.text), expected));
            };
            self.at += name.len();
            return Ok(Dual { value: *value, slope: f64::from(u8::from(name == self.by)) });
        }
        let length = number_length(rest.as_bytes());
        match rest[..length].parse() {
            Ok(value) => {
                self.at += length;
                Ok(Dual { value, slope: 0.0 })
            }
            Err(_) => Err(self.unexpected()),
        }
    }
}

/// The bytes of a number at the beginning: digits, a point, digits, an exponent.
fn number_length(text: &[u8]) -> usize {
    let digits = |from: usize| text[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut length = digits(0);
    if text.get(length) == Some(&b'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(text.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(text.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits(length + 1 + sign);
        length += if exponent > 0 { 1 + sign + exponent } else { 0 };
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::random::Random;

    fn of(text: &str, omega: f64) -> Result<Dual, Wrong> {
        evaluate(text, &[("omega".to_string(), omega), ("b_2".to_string(), 3.0)].into(), "omega")
    }

    #[test]
    fn values_and_derivatives_are_those_of_the_formulas() {
        for (text, value, slope) in [
            ("1/omega - 1", -0.5, -0.25),
            ("omega^2 - 1", 3.0, 4.0),
            ("-omega^2", -4.0, -4.0),
            ("2^3^2", 512.0, 0.0),
            ("2 ^ omega", 4.0, 4.0 * 2f64.ln()),
            ("omega^-1", 0.5, -0.25),
            ("1e-3*omega + 2.5E+1 - .5", 24.502, 1e-3),
            ("(omega - 1)*(b_2 + omega)/b_2", 5.0 / 3.0, 2.0),
            ("--+omega", 2.0, 1.0),
        ] {
            let f = of(text, 2.0).unwrap();
            assert!(
                within((f.value - value).abs(), 1e-14, RoundOff)
                    && within((f.slope - slope).abs(), 1e-14, RoundOff),
                "{text}: {f:?}"
            );
        }
        assert_eq!(of("omega^2", 0.0).unwrap(), Dual { value: 0.0, slope: 0.0 });
    }

    #[test]
    fn what_is_no_number_is_refused_with_what_was_found() {
        for (text, omega, part) in [
            ("1/omega", 0.0, "division by zero"),
            ("omega^-2", 0.0, "division by zero"),
            ("10^omega", 400.0, "inf"),
            ("(0 - 1)^0.5", 1.0, "NaN"),
            ("omga + 1", 1.0, "\"omga\""),
            ("omega +", 1.0, "its end"),
            ("", 1.0, "its end"),
            ("(omega", 1.0, "its end"),
            ("omega)", 1.0, "\")\""),
            ("2 omega", 1.0, "\"omega\" stands"),
            ("omega · 2", 1.0, "\"· 2\""),
        ] {
            let (found, _) = of(text, omega).unwrap_err();
            assert!(found.contains(part), "{text}: {found}");
        }
        let deep = format!("{}1{}", "(".repeat(90), ")".repeat(90));
        assert!(of(&deep, 1.0).unwrap_err().1.contains("levels"));
        assert!(of(&"-".repeat(190), 1.0).unwrap_err().1.contains("levels"));
        assert!(of(&"1+".repeat(300), 1.0).unwrap_err().1.contains("characters"));
    }

    #[test]
    fn any_text_gives_a_number_or_a_fault() {
        let symbols: Vec<char> = "0123456789.eE+-*/^() omegab_2·é".chars().collect();
        let mut random = Random::new();
        let mut sound = 0;
        for _ in 0..20_000 {
            let mut pick = |n: usize| ((0.5 + 0.5 * random.next()) * n as f64) as usize;
            let length = 1 + pick(12);
            let text: String = (0..length).map(|_| symbols[pick(symbols.len())]).collect();
            if let Ok(f) = of(&text, 1.5) {
                assert!(f.value.is_finite() && f.slope.is_finite(), "{text}");
                sound += 1;
            }
        }
        assert!(sound > 200, "{sound}");
    }
}
