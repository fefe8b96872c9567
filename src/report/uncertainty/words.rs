//! Shares in percent and names of files.

use crate::report::format::{given, significant};
use crate::results::{UncertaintyResult, file_name};

/// A share in percent.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 3))
}

/// The confidence of the intervals in percent.
pub(super) fn level(result: &UncertaintyResult) -> String {
    format!("{} %", given(100.0 * result.study.confidence))
}

/// The file of a picture of the study, without extension.
pub(super) fn file(result: &UncertaintyResult, what: &str) -> String {
    file_name("uncertainty", &result.study.name) + what
}
