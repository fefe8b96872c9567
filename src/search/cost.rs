//! Cost of the facts at some values of the numbers.

use super::facts::Facts;
use super::file::SearchFile;
use super::log::Log;
use crate::error::{Error, Result};
use crate::job::Coordinate;
use crate::validation::computed;
use std::collections::BTreeMap;

/// Where the loss turns from square to linear, in tolerances.
const FAR: f64 = 3.0;
/// A fact without an answer is missed by so many tolerances.
const MISSED: f64 = 50.0;

/// The cost as a function of the unknowns.
pub(super) struct Cost<'a> {
    pub(super) file: &'a SearchFile,
    pub(super) coordinates: &'a [Coordinate<'a>],
    pub(super) log: &'a Log,
}

impl Cost<'_> {
    /// The facts at `x`, which is moved inside the bounds: computed, or taken from the log.
    /// Fails for a value that the case refuses, or a fact that it does not have.
    pub(super) fn facts(&self, x: &[f64]) -> Result<Facts> {
        let values: Vec<f64> = self.coordinates.iter().zip(x).map(|(c, x)| c.value(*x)).collect();
        let known = self.log.find(&values);
        let computed = match known {
            Some(computed) => computed,
            None => {
                let at = |case| self.file.with(case, &values);
                let cases = self.file.cases.iter().map(|(name, case)| Ok((name.clone(), at(case)?)));
                let cases: BTreeMap<_, _> = cases.collect::<Result<_>>()?;
                match computed(&cases, &self.file.checks, &()) {
                    Ok(computed) => computed,
                    // No steady state, or an iteration that does not end: a place without an answer.
                    Err(Error::Analysis { .. }) => Vec::new(),
                    Err(error) => return Err(error),
                }
            }
        };
        let parts: Vec<f64> = self
            .file
            .checks
            .iter()
            .enumerate()
            .map(|(k, check)| {
                let row = check.beside(computed.get(k).copied().unwrap_or(f64::NAN));
                loss(row.difference() / row.tolerance)
            })
            .collect();
        let expected = self.coordinates.iter().zip(&values);
        let prior: f64 =
            expected.filter(|(c, _)| c.parameter.deviation.is_some()).map(|(c, v)| c.x(*v).powi(2)).sum();
        let cost = prior + parts.iter().sum::<f64>();
        let facts = Facts { cost, parts, computed };
        self.log.keep(&values, &facts);
        Ok(facts)
    }
}

/// 18 (√(1 + d²/9) − 1).
fn loss(d: f64) -> f64 {
    let d = if d.is_finite() { d } else { MISSED };
    2.0 * FAR * FAR * (1f64.hypot(d / FAR) - 1.0)
}

#[cfg(test)]
mod tests {
    use super::loss;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn small_differences_count_squared_and_large_ones_as_they_are() {
        assert!(within((loss(0.1) - 0.01).abs(), 1e-5, Theory) && loss(0.0) == 0.0);
        assert!(within((loss(2e6) / loss(1e6) - 2.0).abs(), 1e-5, Theory) && loss(f64::NAN) == loss(50.0));
    }
}
