//! The facts of a search at one place.

/// Cost and computed values at one place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Facts {
    pub(super) cost: f64,
    /// The cost of each fact.
    pub(super) parts: Vec<f64>,
    /// Computed value of each fact; not a number where the case has no answer.
    pub(super) computed: Vec<f64>,
}
