//! Computed quantities beside their references.

/// A validation case and what it showed.
#[derive(Debug, Clone)]
pub struct CheckedCase {
    /// Its folder.
    pub name: String,
    /// One line.
    pub title: String,
    /// Where the references come from.
    pub source: String,
    /// The quantities.
    pub rows: Vec<CheckedQuantity>,
    /// Time taken \[s\].
    pub seconds: f64,
}

/// One quantity, computed beside its reference.
#[derive(Debug, Clone)]
pub struct CheckedQuantity {
    /// Computed quantity.
    pub quantity: String,
    /// The computed value.
    pub computed: f64,
    /// The reference value.
    pub reference: f64,
    /// The largest difference that passes.
    pub tolerance: f64,
    /// The difference is relative to the reference.
    pub relative: bool,
    /// Why this tolerance.
    pub reason: String,
}

impl CheckedQuantity {
    /// |computed − reference|, over |reference| when relative.
    pub fn difference(&self) -> f64 {
        let difference = (self.computed - self.reference).abs();
        if self.relative { difference / self.reference.abs() } else { difference }
    }

    /// Whether the difference is within the tolerance; a value that is not a number never is.
    pub fn passed(&self) -> bool {
        self.difference() <= self.tolerance
    }
}

/// Number of quantities, and how many of them are within their tolerance.
pub fn passed(cases: &[CheckedCase]) -> [usize; 2] {
    let rows = || cases.iter().flat_map(|case| &case.rows);
    [rows().count(), rows().filter(|row| row.passed()).count()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_no_number_fails() {
        let row = |computed: f64, relative: bool| CheckedQuantity {
            quantity: String::new(),
            computed,
            reference: 2.0,
            tolerance: 0.1,
            relative,
            reason: String::new(),
        };
        assert!(row(2.19, true).passed() && !row(2.21, true).passed());
        assert!(row(2.09, false).passed() && !row(2.11, false).passed());
        assert!(!row(f64::NAN, true).passed() && !row(f64::INFINITY, false).passed());
        let case = CheckedCase {
            name: String::new(),
            title: String::new(),
            source: String::new(),
            rows: vec![row(2.0, true), row(f64::NAN, true)],
            seconds: 0.0,
        };
        assert_eq!(passed(&[case]), [2, 1]);
    }
}
