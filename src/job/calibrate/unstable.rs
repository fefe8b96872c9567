//! Levels of unstable complex modes at steady sliding: the same ones at every value of the parameters, and their slopes.

use super::super::clock::Clock;
use super::super::complex::complex_result;
use super::super::operating_point::OperatingPoint;
use super::super::prepared::Prepared;
use super::super::scalars::CaseScalar;
use super::follow::{Picks, most_alike};
use crate::calibration::Level;
use crate::equilibrium;
use crate::error::{Error, Result};
use crate::linalg::dense::mac;
use crate::results::ComplexResult;
use crate::stability::{ComplexMode, Sensitivity};
use std::f64::consts::TAU;

/// Half of this share of |λ| between two modes counts as much as shapes that have nothing in common.
const FAR: f64 = 0.04;

/// The complex modes of a case at some values of the parameters.
pub struct Sliding(ComplexResult);

impl Sliding {
    /// Those about steady sliding, and that operating point.
    pub fn new<'a>(prepared: &'a Prepared) -> Result<(Sliding, OperatingPoint<'a>)> {
        let options = prepared.steady_options();
        let steady = equilibrium::solve_steady(&prepared.system, &options, &())?;
        let missing = || Error::analysis("complex eigenvalues", "no [cea] in the case", "Give the case one");
        let cea = prepared.case.cea.as_ref().ok_or_else(missing)?;
        let at = (prepared, steady.into());
        let (complex, point) = complex_result(at, cea, None, true, &mut Clock::default(), &())?;
        Ok((Sliding(complex), point))
    }

    fn modes(&self) -> &[ComplexMode] {
        &self.0.modes.modes
    }

    /// The modes that grow, one a level.
    pub fn levels(&self) -> Picks {
        (0..self.modes().len()).filter(|k| self.modes()[*k].unstable()).map(|k| vec![k]).collect()
    }

    /// Name of each of `levels`.
    pub fn names(&self, levels: &Picks) -> Vec<String> {
        let name = |level: &Vec<usize>| format!("unstable, {}", first_part(&self.0.participation[level[0]]));
        levels.iter().map(name).collect()
    }

    /// Growth rate \[1/s\] of each level; none where it is not found.
    pub fn growth(&self, levels: &Picks) -> Vec<Option<f64>> {
        levels.iter().map(|level| level.first().map(|k| self.modes()[*k].growth_rate())).collect()
    }

    /// `levels` of `self` among the modes of `other`, and whether that is sure: by shape, less what λ moved. Where two modes
    /// have merged their shapes are one, and λ decides which of them grows. With another mesh λ alone decides.
    pub fn follow(&self, levels: &Picks, other: &Sliding) -> (Picks, bool) {
        let same_size = self.0.dofs.n_dofs() == other.0.dofs.n_dofs();
        let mac = |l: usize, k: usize| {
            let (a, b) = (&self.modes()[levels[l][0]], &other.modes()[k]);
            let moved = (a.eigenvalue - b.eigenvalue).norm() / a.eigenvalue.norm();
            let alike = if same_size { mac(&a.right, &b.right) } else { 1.0 };
            alike - 0.5 * (moved / FAR).min(1.0)
        };
        most_alike(levels, 0..other.modes().len(), mac)
    }

    /// Frequencies ω/2π of `levels` and their slopes ∂ ln ω/∂x = Im(∂λ/∂p) (dp/dx)/ω by the scalars of each unknown, which
    /// come with their dp/dx. The steady state follows every scalar.
    pub fn slopes(
        &self,
        point: &OperatingPoint,
        levels: &Picks,
        unknowns: &[(Vec<CaseScalar>, f64)],
    ) -> Result<Vec<Option<Level>>> {
        let found: Vec<usize> = levels.iter().filter_map(|level| level.first().copied()).collect();
        let modes: Vec<&ComplexMode> = found.iter().map(|k| &self.modes()[*k]).collect();
        let sensitivity = Sensitivity::new(&point.system, &point.steady, point.open_modes(&())?, &modes)?;
        let mut slopes = vec![vec![0.0; unknowns.len()]; modes.len()];
        for (j, (scalars, rate)) in unknowns.iter().enumerate() {
            for scalar in scalars {
                let rates = point.rates(&sensitivity, scalar)?;
                for (slopes, (of, mode)) in slopes.iter_mut().zip(rates.iter().zip(&modes)) {
                    slopes[j] += rate * of.value.im / mode.eigenvalue.im;
                }
            }
        }
        let mut slopes = slopes.into_iter().zip(&modes);
        let mut next = || {
            let (slope, mode) = slopes.next()?;
            let split = vec![0.0; unknowns.len()];
            Some(Level { frequency_hz: mode.eigenvalue.im / TAU, slope, split, span: None })
        };
        Ok(levels.iter().map(|level| if level.is_empty() { None } else { next() }).collect())
    }
}

/// The first of several parts, as in "disc (2, 0) 87 %, bar 400 Hz 9 %": up to a comma that is not in brackets.
fn first_part(words: &str) -> &str {
    let mut depth = 0;
    let end = words.char_indices().find(|(_, letter)| {
        depth += match letter {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        *letter == ',' && depth == 0
    });
    end.map_or(words, |(end, _)| &words[..end])
}

#[cfg(test)]
mod tests {
    use super::first_part;

    #[test]
    fn names_keep_their_brackets() {
        assert_eq!(first_part("disc (2, 0) 87 %, bar 400 Hz 9 %"), "disc (2, 0) 87 %");
        assert_eq!(first_part("slider 310 Hz"), "slider 310 Hz");
        assert_eq!(first_part(""), "");
    }
}
