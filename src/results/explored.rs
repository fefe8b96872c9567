//! How sweeps and maps were solved.

use crate::dataset::{Dimension, Group, Variable};

/// How the points of a sweep or map were solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SweepMethod {
    /// On one reduced model of this many degrees of freedom, right at full order where it was measured.
    Reduced(usize),
    /// A whole analysis each, because the scalar changes the structure.
    Whole,
}

impl SweepMethod {
    pub(super) fn group(self) -> Group<'static> {
        let (kind, dimension) = match self {
            SweepMethod::Reduced(dimension) => ("reduced", Some(dimension)),
            SweepMethod::Whole => ("whole", None),
        };
        Group::new("method", "how the points were solved")
            .value("kind", "text", "on one reduced model, or a whole analysis each", kind)
            .value("dimension", "1", "degrees of freedom of the reduced model", dimension)
    }
}

/// Two of the same, one after the other.
pub(super) fn ends() -> Dimension {
    Dimension::named("end", &["first", "last"])
}

/// The first and the last time of what was analysed.
pub(super) fn window(times: [f64; 2], description: &'static str) -> Variable<'static> {
    Variable::reals("window_s", "s", description, vec![Dimension::limits()], times.to_vec())
}
