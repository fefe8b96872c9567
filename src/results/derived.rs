//! What several writers and the report work out from the plain data: comparisons, sums over a contact pair.

use super::{MeasuredComparison, MeasuredRow, NamedModes, SteadyResult};

/// A measured frequency with the computed mode set beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComparedRow {
    /// The measured frequency \[Hz\].
    pub measured_hz: f64,
    /// The paired mode's index in its set.
    pub mode: Option<usize>,
    /// Its computed frequency times the frequency scale \[Hz\].
    pub computed_hz: Option<f64>,
}

impl ComparedRow {
    /// 100 (computed − measured) / measured \[%\]: positive when the computed frequency is too high.
    pub fn difference_percent(&self) -> Option<f64> {
        self.computed_hz.map(|computed| 100.0 * (computed / self.measured_hz - 1.0))
    }
}

impl MeasuredComparison {
    /// The rows with their computed frequencies; `sets` are [`super::RunResults::modes`].
    pub fn compare(&self, sets: &[NamedModes]) -> Vec<ComparedRow> {
        let set = sets.get(self.modes);
        let computed = |mode: Option<usize>| {
            let (set, k) = (set?, mode?);
            (k < set.modes.len()).then(|| self.frequency_scale * set.modes.frequency_hz(k))
        };
        let row = |row: &MeasuredRow| ComparedRow {
            measured_hz: row.frequency_hz,
            mode: row.mode,
            computed_hz: computed(row.mode),
        };
        self.rows.iter().map(row).collect()
    }
}

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
