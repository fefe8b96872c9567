//! How the numbers of a dataset 58 are stored: its record 7.

use super::dataset::{Dataset, shown};
use super::record::{columns, float, whole};
use crate::error::Result;

/// How the numbers of a function are stored.
pub struct ValueLayout {
    /// 2, 4: real; 5, 6: complex; single and double precision.
    pub kind: i64,
    /// How many values.
    pub count: usize,
    /// Whether abscissas follow from the first and the step.
    pub even: bool,
    /// The first abscissa.
    pub first: f64,
    /// From one abscissa to the next, where they are even.
    pub step: f64,
}

impl ValueLayout {
    /// Reads record 7.
    pub fn read(dataset: &Dataset<'_>) -> Result<ValueLayout> {
        const FORM: usize = 6;
        let cells = columns(dataset.line(FORM)?, &[10, 10, 10, 13, 13, 13]);
        let words: Vec<String> = dataset.line(FORM)?.split_whitespace().map(str::to_string).collect();
        let cells = if words.len() == 6 { words } else { cells };
        let whole = |k: usize| {
            whole(&cells[k]).ok_or_else(|| dataset.fault(FORM, shown(&cells[k]), "a whole number"))
        };
        let real = |k: usize| {
            let number = if cells[k].is_empty() { Some(0.0) } else { float(&cells[k]) };
            number.ok_or_else(|| dataset.fault(FORM, shown(&cells[k]), "a finite number"))
        };
        let (kind, count, spacing) = (whole(0)?, whole(1)?, whole(2)?);
        if !matches!(kind, 2 | 4 | 5 | 6) {
            let expected = "2 or 4 (real), 5 or 6 (complex)";
            return Err(dataset.fault(FORM, format!("ordinates of type {kind}"), expected));
        }
        let count = usize::try_from(count)
            .map_err(|_| dataset.fault(FORM, format!("{count} values"), "a count of zero or more"))?;
        if !matches!(spacing, 0 | 1) {
            let expected = "0 (uneven) or 1 (even)";
            return Err(dataset.fault(FORM, format!("abscissa spacing {spacing}"), expected));
        }
        Ok(ValueLayout { kind, count, even: spacing == 1, first: real(3)?, step: real(4)? })
    }

    /// Whether a value has an imaginary part.
    pub fn complex(&self) -> bool {
        self.kind > 4
    }

    /// Whether numbers have double precision.
    pub fn double(&self) -> bool {
        matches!(self.kind, 4 | 6)
    }

    /// Numbers of a value: one, or a real and an imaginary part.
    pub fn parts(&self) -> usize {
        if self.complex() { 2 } else { 1 }
    }

    /// Sizes in bytes of an abscissa and of a number of a value, as the type says first; then as other writers have it.
    pub fn sizes(&self) -> Vec<[usize; 2]> {
        let all = if self.double() { [[8, 8], [4, 8], [4, 4]] } else { [[4, 4], [8, 8], [4, 8]] };
        let even = |[abscissa, value]: [usize; 2]| [if self.even { 0 } else { abscissa }, value];
        all.map(even).to_vec()
    }

    /// Widths of the columns of a line of numbers.
    pub fn widths(&self) -> &'static [usize] {
        match (self.double(), self.even, self.complex()) {
            (false, ..) => &[13],
            (true, true, _) => &[20],
            (true, false, false) => &[13, 20],
            (true, false, true) => &[13, 20, 20],
        }
    }
}
