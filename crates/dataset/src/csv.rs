//! Tables as CSV: a header with units, a comma between fields, a point in numbers, full precision.

use super::Table;
use super::variable::{Dimension, Labels, Values, Variable};

impl Table<'_> {
    /// The table with a header of the keys, and units where a key does not name its own. A column that has several values a row, or
    /// complex ones, becomes several.
    pub fn to_csv(&self) -> String {
        let numbered = matches!(self.rows.labels, Labels::From(_));
        let number = numbered.then(|| self.rows.name.to_string());
        let header: Vec<String> = number.into_iter().chain(self.columns.iter().flat_map(titles)).collect();
        let mut table = CsvTable::new(&header);
        for k in 0..self.rows.length {
            let mut fields = Vec::with_capacity(header.len());
            if let Labels::From(first) = self.rows.labels {
                fields.push((first + k as i64).to_string());
            }
            for column in &self.columns {
                let width = column.width();
                (k * width..(k + 1) * width).for_each(|i| column.values.fields(i, &mut fields));
            }
            table.row(&fields);
        }
        table.text
    }
}

/// The names of the columns that a variable fills.
fn titles(variable: &Variable) -> Vec<String> {
    let title = variable.title();
    let label = |dimension: &Dimension, k: usize| match dimension.labels {
        Labels::Names(names) => names[k].to_string(),
        Labels::From(first) => (first + k as i64).to_string(),
        Labels::Variable => k.to_string(),
    };
    let (key, unit) =
        title.split_once(' ').map_or((&*title, String::new()), |(key, unit)| (key, format!(" {unit}")));
    let titles: Vec<String> = match variable.dimensions.get(1) {
        Some(dimension) => {
            (0..dimension.length).map(|k| format!("{key}_{}{unit}", label(dimension, k))).collect()
        }
        None => vec![title.clone()],
    };
    match variable.values {
        Values::Complexes(_) => {
            titles.iter().flat_map(|title| [format!("re_{title}"), format!("im_{title}")]).collect()
        }
        _ => titles,
    }
}

impl Values<'_> {
    /// The fields of value number `i`.
    fn fields(&self, i: usize, fields: &mut Vec<String>) {
        match self {
            Values::Flags(all) => fields.push(all[i].to_string()),
            Values::Integers(all) => fields.push(all[i].to_string()),
            Values::Sparse(all) => fields.push(all[i].map_or(String::new(), |v| v.to_string())),
            Values::Reals(all) => fields.push(number(all[i])),
            Values::Complexes(all) => fields.extend([all[i].re, all[i].im].map(number)),
            Values::Texts(all) => fields.push(all[i].clone().unwrap_or_default()),
            Values::RealRows(_) | Values::ComplexRows(_) => {}
        }
    }
}

/// Lines of comma-separated fields.
#[derive(Debug, Default)]
pub struct CsvTable {
    /// The lines so far, each with its end.
    pub text: String,
}

impl CsvTable {
    /// A table with its first line.
    pub fn new(header: &[impl AsRef<str>]) -> Self {
        let mut table = CsvTable::default();
        table.row(header);
        table
    }

    /// Adds a line of fields.
    pub fn row(&mut self, fields: &[impl AsRef<str>]) {
        let quoted: Vec<String> = fields.iter().map(|field| quote(field.as_ref())).collect();
        self.text.push_str(&quoted.join(","));
        self.text.push('\n');
    }
}

/// A field in quotes where it needs them (RFC 4180). Text that a spreadsheet would take for a formula begins with an
/// apostrophe, which makes it text there.
fn quote(field: &str) -> String {
    let formula = field.starts_with(['=', '+', '-', '@', '\t', '\r']) && field.parse::<f64>().is_err();
    let field = if formula { format!("'{field}") } else { field.to_string() };
    if field.contains([',', ';', '"', '\n', '\r', '\t']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field
    }
}

/// The shortest text that reads back as exactly `value`; empty when it is not finite.
pub fn number(value: f64) -> String {
    let magnitude = value.abs();
    match magnitude {
        m if !m.is_finite() => String::new(),
        m if m == 0.0 || (1e-3..1e9).contains(&m) => value.to_string(),
        _ => format!("{value:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_no_formulas() {
        let mut table = CsvTable::new(&["=1+1", "@sum(a)", "\tx", "\rx", "+3 N", "-a", "a=b"]);
        table.row(&["-2.5e-13", "+1", "-", "1 \n2", "=\"a\"", "a;=b", "'=1"]);
        let fields = "'=1+1,'@sum(a),\"'\tx\",\"'\rx\",'+3 N,'-a,a=b\n-2.5e-13,+1,'-,\"1 \n2\",\"'=\"\"a\"\"\",\"a;=b\",'=1\n";
        assert_eq!(table.text, fields);
    }

    #[test]
    fn fields_are_quoted_and_numbers_short() {
        assert_eq!(quote("61 % (0,1), \"x\""), "\"61 % (0,1), \"\"x\"\"\"");
        assert_eq!(number(f64::NAN), "");
        assert_eq!(number(0.1), "0.1");
        assert_eq!(number(-2.5e-13), "-2.5e-13");
    }
}
