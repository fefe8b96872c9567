//! A second way to the same eigenvalues: two-level Arnoldi on the full order, which knows no real modes and no basis.

use super::ComplexModes;
use super::operator::Operator;
use super::shifted::Shifted;
use crate::equilibrium::SteadySliding;
use crate::error::Result;
use crate::linalg::c64;
use crate::linalg::toar::toar;
use crate::progress::Observer;
use crate::system::System;
use std::f64::consts::TAU;

/// The complex modes of a band beside those that a second, independent method finds there.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Confirmation {
    /// Shifts at which the full-order problem was factorised.
    pub shifts: usize,
    /// Modes that both methods found.
    pub confirmed: usize,
    /// The largest |Δλ|/|λ| of those, and the condition number of that eigenvalue.
    pub largest_difference: f64,
    /// The condition number of the eigenvalue with the largest difference: it multiplies what rounding does.
    pub condition: f64,
    /// Eigenvalues that only the analysis found \[1/s\].
    pub unconfirmed: Vec<c64>,
    /// Eigenvalues that only the second method found \[1/s\].
    pub missed: Vec<c64>,
}

impl Confirmation {
    /// Whether both methods found the same modes.
    pub fn holds(&self) -> bool {
        self.unconfirmed.is_empty() && self.missed.is_empty()
    }
}

/// Modes sought at one shift.
const GROUP: usize = 16;
/// Two eigenvalues are the same when they differ by less than this part of |λ|, times the condition number.
const SAME: f64 = 1e-7;

/// Looks for the oscillating modes of `found` (ω > 0, in `band_hz`) again, by two-level Arnoldi on the full order at shifts
/// along the band, each near a group of modes and with a margin for modes that `found` does not have.
///
/// Within the distance of the farthest eigenvalue that a shift gave, the method finds all that its Krylov space holds; it
/// is no proof that there are no others, but it shares nothing with the projection: neither real modes, nor basis, nor
/// the dense solver of the small problem.
///
/// # Errors
/// A shift that cannot be factorised, or an iteration that does not converge.
pub fn confirm(
    system: &System,
    steady: &SteadySliding,
    found: &ComplexModes,
    band_hz: [f64; 2],
    observer: &dyn Observer,
) -> Result<Confirmation> {
    let operator = Operator::new(system, steady)?;
    let modes: Vec<(c64, f64)> =
        found.modes.iter().filter(|m| m.eigenvalue.im > 0.0).map(|m| (m.eigenvalue, m.condition)).collect();
    let band = band_hz.map(|f| TAU * f);
    observer.begin("second method", Some(modes.len().div_ceil(GROUP) as u64));
    let mut confirmation = Confirmation::default();
    let mut seen = vec![false; modes.len()];
    for group in modes.chunks(GROUP) {
        let (first, last) = (group[0].0.im, group[group.len() - 1].0.im);
        let middle = 0.5 * (first + last);
        // Off the imaginary axis, where an undamped structure has its eigenvalues.
        let shift = c64::new(1e-3 * middle.max(1e-3 * band[1]), middle);
        let farthest = group.iter().map(|(z, _)| (z - shift).norm()).fold(0.0, f64::max);
        let problem = Shifted::new(&operator, shift)?;
        confirmation.shifts += 1;
        let mut count = group.len() + 4;
        let values = loop {
            let pairs = toar(&problem, shift, farthest.max(1e-3 * middle), count, 1e-12)?;
            let reach = pairs.values.iter().map(|z| (z - shift).norm()).fold(0.0, f64::max);
            if reach > farthest * (1.0 + 1e-6) || pairs.values.len() < count || count >= 2 * operator.n() {
                break pairs.values;
            }
            count *= 2;
        };
        for value in values.iter().filter(|z| z.im > 1e-9 * z.norm()) {
            let near = (0..modes.len())
                .filter(|j| !seen[*j])
                .min_by(|a, b| (modes[*a].0 - value).norm().total_cmp(&(modes[*b].0 - value).norm()));
            let known = (0..modes.len()).any(|j| seen[j] && same(modes[j], *value));
            match near.filter(|j| same(modes[*j], *value)) {
                Some(j) => {
                    seen[j] = true;
                    let difference = (modes[j].0 - value).norm() / value.norm();
                    if difference > confirmation.largest_difference {
                        confirmation.largest_difference = difference;
                        confirmation.condition = modes[j].1;
                    }
                }
                // Neighbouring shifts see the same modes.
                None if known => {}
                None if value.im > band[0] && value.im < band[1] => confirmation.missed.push(*value),
                None => {}
            }
        }
        observer.advance(1);
    }
    observer.end();
    confirmation.confirmed = seen.iter().filter(|s| **s).count();
    confirmation.unconfirmed =
        modes.iter().zip(&seen).filter(|(_, seen)| !**seen).map(|((z, _), _)| *z).collect();
    Ok(confirmation)
}

fn same((known, condition): (c64, f64), value: c64) -> bool {
    (known - value).norm() <= SAME * condition.clamp(1.0, 1e4) * value.norm()
}
