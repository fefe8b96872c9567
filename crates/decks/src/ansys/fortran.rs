//! Lines of blocks by the Fortran format that stands before them, such as `(3i9,6e21.13e3)`.

use stridor_base::numbers::parse;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A whole number.
    Whole,
    /// Any number.
    Real,
    /// Text.
    Text,
}

/// The columns of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Columns(Vec<(Kind, usize)>);

/// The most columns of a line, and the widest of them.
const MOST: usize = 1000;

impl Columns {
    /// The columns of a format in its brackets.
    pub fn read(format: &str) -> Option<Columns> {
        let inner = format.trim().strip_prefix('(')?.strip_suffix(')')?;
        let mut columns = Vec::new();
        items(inner, &mut columns, 0)?;
        (!columns.is_empty()).then_some(Columns(columns))
    }

    /// How many whole numbers a line begins with.
    pub fn leading_wholes(&self) -> usize {
        self.0.iter().take_while(|(kind, _)| *kind == Kind::Whole).count()
    }

    /// The fields of a line without the blanks about them: as many as the line has, but for those that are blank at its end.
    pub fn split<'a>(&self, line: &'a str) -> Vec<&'a str> {
        let line = line.trim_end();
        let mut fields = Vec::new();
        let mut at = 0;
        for (_, width) in &self.0 {
            if at >= line.len() {
                break;
            }
            let mut end = (at + width).min(line.len());
            while !line.is_char_boundary(end) {
                end += 1;
            }
            fields.push(line[at..end].trim());
            at = end;
        }
        // What stands beyond the last column is no field.
        fields
    }
}

/// Reads items between commas into `columns`.
fn items(text: &str, columns: &mut Vec<(Kind, usize)>, depth: usize) -> Option<()> {
    let mut rest = text.trim();
    while !rest.is_empty() {
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        let repeat: usize =
            if digits == 0 { 1 } else { rest[..digits].parse().ok().filter(|n| *n <= MOST)? };
        rest = rest[digits..].trim_start();
        if let Some(inner) = rest.strip_prefix('(') {
            let end = inner.find(')').filter(|_| depth == 0)?;
            let mut group = Vec::new();
            items(&inner[..end], &mut group, 1)?;
            for _ in 0..repeat {
                columns.extend(&group);
                (columns.len() <= MOST).then_some(())?;
            }
            rest = &inner[end + 1..];
        } else {
            let end = rest.find(',').unwrap_or(rest.len());
            // A scale factor, `1p` or `p`, changes nothing of what is read.
            let item = rest[..end].trim().trim_start_matches(['p', 'P']);
            let kind = match item.bytes().next()?.to_ascii_lowercase() {
                b'i' => Kind::Whole,
                b'e' | b'f' | b'g' | b'd' => Kind::Real,
                b'a' => Kind::Text,
                _ => return None,
            };
            let width = item[1..].split('.').next()?.trim();
            let width: usize = width.parse().ok().filter(|n| (1..=MOST).contains(n))?;
            columns.extend(std::iter::repeat_n((kind, width), repeat));
            (columns.len() <= MOST).then_some(())?;
            rest = &rest[end..];
        }
        rest = rest.trim_start().trim_start_matches(',').trim_start();
    }
    Some(())
}

/// A whole number, also written as `12.`; blank is zero.
pub(super) fn whole(field: &str) -> Option<i64> {
    match field.trim() {
        "" => Some(0),
        field => field.strip_suffix('.').unwrap_or(field).parse().ok(),
    }
}

/// A finite number in any form of Fortran; blank is zero.
pub(super) fn real(field: &str) -> Option<f64> {
    match field.trim() {
        "" => Some(0.0),
        field => parse(field).filter(|value| value.is_finite()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_of_archives_are_read() {
        let columns = Columns::read("(3i9,6e21.13e3)").unwrap();
        assert_eq!(columns.leading_wholes(), 3);
        assert_eq!(columns.0.len(), 9);
        assert_eq!(columns.0[3], (Kind::Real, 21));
        assert_eq!(
            Columns::read("(1i7,2i9,6e21.13)").unwrap().0[..3],
            [(Kind::Whole, 7), (Kind::Whole, 9), (Kind::Whole, 9)]
        );
        assert_eq!(Columns::read("(2i9,19a9)").unwrap().0[2], (Kind::Text, 9));
        assert_eq!(Columns::read("(i9,i4,i4,6(pg20.9))").unwrap().0.len(), 9);
        for wrong in ["", "()", "3i8", "(3i)", "(3x8)", "(99999999i8)", "(1000(1000i8))", "((i8)", "(i0)"] {
            assert_eq!(Columns::read(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn fields_that_touch_are_apart_and_a_short_line_has_fewer() {
        let columns = Columns::read("(3i8,6e20.13)").unwrap();
        let line = "     635       0       0 3.7826539829200E+00 1.2788958692644E+00-1.0220880953640E+00";
        let fields = columns.split(line);
        assert_eq!(fields.len(), 6);
        assert_eq!(real(fields[5]), Some(-1.0220880953640));
        assert_eq!(columns.split("      12").len(), 1);
        assert_eq!(whole("12."), Some(12));
        assert_eq!(real("1.5-3"), Some(1.5e-3));
        assert_eq!(real("nan"), None);
        assert_eq!(Columns::read("(2i1)").unwrap().split("é1"), ["é", "1"]);
    }
}
