//! Findings: what each analysis found, in a sentence or a few, first on the page and last on the terminal.

use super::table::ReportTable;

/// How a finding is to be taken. The most urgent class comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum FindingClass {
    /// The disc squeals, the model contradicts the measurement, or a proof has failed.
    Bad,
    /// Something is open: a verdict within its error, a limit that is passed, a check that was not made.
    Attention,
    /// A question with a good and a bad answer has the good one, and the results prove it.
    Good,
    /// A result that is neither good nor bad.
    Neutral,
    /// A result on which the others stand, such as the state of steady sliding.
    Basis,
}

impl FindingClass {
    /// Its class in the style sheet.
    pub(super) fn name(self) -> &'static str {
        match self {
            FindingClass::Bad => "bad",
            FindingClass::Attention => "attention",
            FindingClass::Good => "good",
            FindingClass::Neutral => "neutral",
            FindingClass::Basis => "basis",
        }
    }
}

/// What an analysis found. It claims no more than its results hold.
#[derive(Debug, Clone)]
pub(super) struct Finding {
    pub class: FindingClass,
    /// One sentence or a few, with numbers.
    pub words: String,
    /// Figures that belong to the sentence, with their notes; it may have notes alone.
    pub table: Option<ReportTable>,
}

impl Finding {
    /// A finding without a table.
    pub(super) fn new(class: FindingClass, words: impl Into<String>) -> Self {
        Finding { class, words: words.into(), table: None }
    }
}
