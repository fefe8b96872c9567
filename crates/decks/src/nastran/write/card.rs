//! A card in fields of eight characters, or of sixteen where one needs more.

/// A field.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Field {
    Blank,
    Integer(u64),
    Real(f64),
    Word(String),
}

impl Field {
    /// Degrees of freedom as digits; blank where there are none.
    pub fn components(held: [bool; 6]) -> Field {
        let digits: String = (0..6).filter(|k| held[*k]).map(|k| char::from(b'1' + k as u8)).collect();
        if digits.is_empty() { Field::Blank } else { Field::Word(digits) }
    }

    /// As it stands in a field of so many characters.
    fn text(&self, width: usize) -> String {
        match self {
            Field::Blank => String::new(),
            Field::Integer(number) => number.to_string(),
            Field::Real(value) => real(*value, width),
            Field::Word(word) => word.clone(),
        }
    }

    /// Whether nothing of it is lost in eight characters.
    fn is_small(&self) -> bool {
        match self {
            Field::Real(value) => real(*value, usize::MAX).len() <= SMALL,
            _ => self.text(LARGE).len() <= SMALL,
        }
    }
}

const SMALL: usize = 8;
const LARGE: usize = 16;

/// A real number with a point, `1.5-3` for 1.5 · 10⁻³; of as many digits as the width holds.
fn real(value: f64, width: usize) -> String {
    let plain = format!("{value:?}");
    let plain = (!plain.contains('e')).then_some(plain);
    // 0.001 is .001, 10.0 is 10.
    let short = |text: String| {
        let text =
            text.strip_suffix('0').filter(|text| text.ends_with('.')).map(str::to_string).unwrap_or(text);
        match text.strip_prefix("0.").filter(|rest| !rest.is_empty()) {
            Some(rest) => format!(".{rest}"),
            None => text.replacen("-0.", "-.", usize::from(text.starts_with("-0.") && text.len() > 3)),
        }
    };
    let powers = |text: String| {
        let Some((digits, power)) = text.split_once('e') else { return text };
        let point = if digits.contains('.') { "" } else { "." };
        let sign = if power.starts_with('-') { "" } else { "+" };
        format!("{digits}{point}{sign}{power}")
    };
    let forms = [plain.map(short), Some(powers(format!("{value:e}")))];
    let shortest = forms.into_iter().flatten().min_by_key(String::len).unwrap_or_default();
    if shortest.len() <= width {
        return shortest;
    }
    let mut rounded = (0..width).rev().map(|digits| powers(format!("{value:.digits$e}")));
    rounded.find(|form| form.len() <= width).unwrap_or_default()
}

/// A card with its fields after the name, continued as far as it needs.
pub(super) fn card(name: &str, fields: &[Field]) -> String {
    let last = fields.iter().rposition(|field| *field != Field::Blank).map_or(0, |last| last + 1);
    let fields = &fields[..last];
    let small = fields.iter().all(Field::is_small);
    let (width, in_a_line, mark) = if small { (SMALL, 8, "") } else { (LARGE, 4, "*") };
    let mut text = String::new();
    let lines = fields.chunks(in_a_line);
    for (k, line) in lines.enumerate() {
        let head = if k == 0 { format!("{name}{mark}") } else { mark.to_string() };
        let mut row = format!("{head:SMALL$}");
        for field in line {
            row += &format!("{:width$}", field.text(width));
        }
        text += row.trim_end();
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn numbers_fit_their_fields_and_read_back() {
        for value in
            [0.0, 1.0, -1.0, 0.001, -0.25, 210e9, 7.85e-9, 1e-300, -1.234_567_890_123_456e-12, 1.0 / 3.0]
        {
            for (width, most) in [(8, 1e-2), (16, 1e-8)] {
                let text = real(value, width);
                assert!(text.len() <= width && text.contains('.'), "{value}: {text}");
                let read = stridor_base::numbers::parse(&text).unwrap();
                assert!(within((read - value).abs(), most * value.abs(), Stated), "{value}: {text}");
            }
        }
        assert_eq!([real(0.001, 8), real(-0.5, 8), real(10.0, 8)], [".001", "-.5", "10."]);
        assert_eq!(real(210e9, 8), "2.1+11");
    }
}
