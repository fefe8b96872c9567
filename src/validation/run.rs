//! A run of a case in time, with its histories.

use crate::job::Histories;
use crate::results::RunResults;

/// What the analyses of a case brought.
pub(super) struct Run {
    pub(super) results: RunResults,
    pub(super) histories: Histories,
}
