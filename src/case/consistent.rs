//! Tables whose parts must go together.

use crate::schema::Report;

/// A table whose parts must go together.
pub(super) trait Consistent {
    /// Reports every part that does not go with the others.
    fn check(&self, report: &mut Report);
}
