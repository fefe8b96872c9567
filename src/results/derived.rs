//! Sums over the points of a contact pair.

use super::SteadyResult;

/// The sums over the points of one contact pair.
#[derive(Debug, Clone, PartialEq)]
pub struct PairTotals<'a> {
    /// The pair's name.
    pub name: &'a str,
    /// The load it was given \[N\].
    pub load: f64,
    /// Sliding velocity \[m/s\].
    pub sliding_velocity: f64,
    /// Approach \[m\].
    pub approach: Option<f64>,
    /// ΣN \[N\].
    pub normal_force: f64,
    /// ΣF₁, ΣF₂ \[N\], friction on the body.
    pub friction_force: [f64; 2],
    /// Points that carry load.
    pub closed: usize,
    /// Points that do not.
    pub open: usize,
    /// Largest δ \[m\] of the closed points.
    pub largest_penetration: Option<f64>,
}

impl SteadyResult {
    /// The sums over each pair, in the order of [`SteadyResult::pairs`].
    pub fn totals(&self) -> Vec<PairTotals<'_>> {
        self.pairs.iter().enumerate().map(|(k, pair)| self.pair_totals(k, pair)).collect()
    }

    fn pair_totals<'a>(
        &'a self,
        k: usize,
        (name, load, sliding_velocity): &'a (String, f64, f64),
    ) -> PairTotals<'a> {
        let mut totals = PairTotals {
            name,
            load: *load,
            sliding_velocity: *sliding_velocity,
            approach: self.state.approach.get(k).copied(),
            normal_force: 0.0,
            friction_force: [0.0; 2],
            closed: 0,
            open: 0,
            largest_penetration: None,
        };
        for (_, state) in self.points.iter().zip(&self.state.points).filter(|((pair, _), _)| pair == name) {
            totals.normal_force += state.forces.normal;
            totals.friction_force[0] += state.forces.friction[0];
            totals.friction_force[1] += state.forces.friction[1];
            if state.closed() {
                totals.closed += 1;
                let largest = totals.largest_penetration.unwrap_or(state.penetration);
                totals.largest_penetration = Some(largest.max(state.penetration));
            } else {
                totals.open += 1;
            }
        }
        totals
    }
}
