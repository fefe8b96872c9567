//! A run of a case in time, with its histories.

use crate::job::Histories;
use crate::results::RunResults;

/// Results and histories of the analyses of a case.
pub(super) struct CaseRun {
    pub(super) results: RunResults,
    pub(super) histories: Histories,
}
