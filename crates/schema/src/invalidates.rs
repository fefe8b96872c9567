//! Results that a change of a scalar invalidates, and whether eigenvalues have a derivative by it.

/// Results that a change of a scalar invalidates, the cheapest first; each level includes those before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Invalidates {
    /// Requests and references: bands, measured values. The system stays.
    Question,
    /// C of the structure. The steady state and the real modes stay.
    Damping,
    /// The contact law. The compliance that the steady state is condensed on stays.
    Law,
    /// The steady state: loads and velocities.
    Equilibrium,
    /// Which points may touch, and their directions.
    Interface,
    /// M or K: mesh, materials, sections, springs, where the bodies stand.
    Structure,
}

/// Whether eigenvalues have a derivative by a scalar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// They have.
    Exists,
    /// They do not depend on it.
    Zero,
    /// They have none, for this reason.
    None(&'static str),
}
