//! The facts of a search at one place.

/// What was computed at one place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Facts {
    pub(super) cost: f64,
    /// The cost of each fact.
    pub(super) parts: Vec<f64>,
    /// What was computed for each fact; nothing where the case has no answer.
    pub(super) computed: Vec<f64>,
}
