//! A second way to the same eigenvalues: two-level Arnoldi on the full order, which knows no real modes and no basis.

use super::band::Band;
use super::{ComplexMode, ComplexModes};
use crate::dynamics::{Operator, Shifted};
use crate::equilibrium::SteadySliding;
use crate::error::Result;
use crate::linalg::factor::{QuadraticProblem, QuadraticSolver};
use crate::linalg::sparse::add_scaled;
use crate::linalg::toar::toar;
use crate::linalg::{SparseMatrix, c64};
use crate::progress::Observer;
use crate::system::System;
use faer::MatRef;
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
const SAME: f64 = 1e-6;
/// Relative residual of the eigenvalues of the second method.
const TOLERANCE: f64 = 1e-12;
/// ω/|λ| below which a pair is two equal real eigenvalues to an iteration that ends at √[`TOLERANCE`] of what is double, and two of
/// these are a pair.
const NEXT_TO_REAL: f64 = 1e-3;
/// Uncertainties of an eigenvalue within which another method may find it.
const WITHIN: f64 = 10.0;

/// Looks for the oscillating modes of `found` (ω > 1e-3 |λ|, in `band_hz`) again, by two-level Arnoldi on the full order at shifts
/// along the band, each near a group of modes and with a margin for modes that `found` does not have.
///
/// Within the distance of the farthest eigenvalue that a shift gave, the method finds all that its Krylov space holds; it
/// is no proof that there are no others. Of equal eigenvalues it finds one, as a Krylov space of one vector holds one of each, and that
/// confirms all. It shares nothing with the projection: neither real modes, nor basis, nor
/// the dense solver of the small problem. Where an engine factorises over several processes it is the method of its library, at
/// the same shifts.
///
/// # Errors
/// A shift that cannot be factorised, or an iteration that does not converge.
pub fn confirm(
    system: &System,
    steady: &SteadySliding,
    found: &ComplexModes,
    band: impl Into<Band>,
    observer: &dyn Observer,
) -> Result<Confirmation> {
    let asked = band.into();
    let operator = Operator::new(system, steady)?;
    let oscillates = |z: c64| z.im > NEXT_TO_REAL * z.norm();
    let modes: Vec<&ComplexMode> = found.modes.iter().filter(|mode| oscillates(mode.eigenvalue)).collect();
    let band = asked.hz.map(|f| TAU * f);
    // Beside a zero that may be double the iteration ends at the root of its tolerance.
    let least = WITHIN * TOLERANCE.sqrt() * band[1];
    let zeros = found.modes.iter().filter(|mode| mode.is_zero() || mode.eigenvalue.norm() <= least);
    let zero = zeros.map(|mode| least.max(WITHIN * mode.uncertainty)).fold(0.0, f64::max);
    // Of those nearest to a frequency none is missed that is farther than the last.
    let centre = asked.nearest.map(|(hz, _)| c64::new(0.0, TAU * hz));
    let reach = centre.map_or(f64::INFINITY, |centre| {
        found.modes.iter().map(|mode| (mode.eigenvalue - centre).norm()).fold(0.0, f64::max) * (1.0 - SAME)
    });
    let to_find = |z: c64| {
        z.norm() > zero && z.im > band[0] && z.im < band[1] && centre.is_none_or(|c| (z - c).norm() < reach)
    };
    observer.begin("second method", Some(modes.len().div_ceil(GROUP) as u64));
    let second = SecondMethod::new(&operator)?;
    let mut confirmation = Confirmation::default();
    let mut seen = vec![false; modes.len()];
    for group in modes.chunks(GROUP) {
        let (first, last) = (group[0].eigenvalue.im, group[group.len() - 1].eigenvalue.im);
        let middle = 0.5 * (first + last);
        // Off the imaginary axis, where an undamped structure has its eigenvalues.
        let shift = c64::new(1e-3 * middle.max(1e-3 * band[1]), middle);
        let farthest = group.iter().map(|mode| (mode.eigenvalue - shift).norm()).fold(0.0, f64::max);
        let nearest = second.at(shift)?;
        confirmation.shifts += 1;
        let mut count = group.len() + 4;
        let values = loop {
            let values = nearest(farthest.max(1e-3 * middle), count)?;
            let reach = values.iter().map(|z| (z - shift).norm()).fold(0.0, f64::max);
            if reach > farthest * (1.0 + 1e-6) || values.len() < count || count >= 2 * operator.n() {
                break values;
            }
            count *= 2;
        };
        for value in values.iter().filter(|value| oscillates(**value)) {
            let alike: Vec<usize> = (0..modes.len()).filter(|j| same(modes[*j], *value)).collect();
            if alike.is_empty() && to_find(*value) {
                confirmation.missed.push(*value);
            }
            for j in alike.into_iter().filter(|j| !std::mem::replace(&mut seen[*j], true)) {
                let difference = (modes[j].eigenvalue - value).norm() / value.norm();
                if difference > confirmation.largest_difference {
                    confirmation.largest_difference = difference;
                    confirmation.condition = modes[j].condition;
                }
            }
        }
        observer.advance(1);
    }
    observer.end();
    confirmation.confirmed = seen.iter().filter(|s| **s).count();
    confirmation.unconfirmed =
        modes.iter().zip(&seen).filter(|(_, seen)| !**seen).map(|(mode, _)| mode.eigenvalue).collect();
    Ok(confirmation)
}

/// Two-level Arnoldi of this program, or of the library of the engine.
enum SecondMethod<'s, 'a> {
    Own(&'s Operator<'a>),
    Library(Box<dyn QuadraticSolver>),
}

/// Gives a number of eigenvalues within a distance, about, of a shift.
type NearestValues<'s> = Box<dyn Fn(f64, usize) -> Result<Vec<c64>> + 's>;

impl<'s, 'a> SecondMethod<'s, 'a> {
    fn new(operator: &'s Operator<'a>) -> Result<Self> {
        Ok(match operator.engine.backend() {
            None => SecondMethod::Own(operator),
            Some(library) => SecondMethod::Library(library.quadratic(&assembled(operator))?),
        })
    }

    fn at(&self, shift: c64) -> Result<NearestValues<'_>> {
        Ok(match self {
            SecondMethod::Own(operator) => {
                let problem = Shifted::new(operator, shift)?;
                Box::new(move |radius, count| {
                    toar(&problem, shift, radius, (count, f64::INFINITY), TOLERANCE).map(|pairs| pairs.values)
                })
            }
            SecondMethod::Library(solver) => {
                Box::new(move |_, count| solver.nearest(shift, count, TOLERANCE))
            }
        })
    }
}

/// M, C + C_c and K + K_σ + iH + K_c with the interface assembled; modal damping stays of low rank.
fn assembled<'s>(operator: &'s Operator<'_>) -> QuadraticProblem<'s> {
    let [stiff, damped] = operator.interface.assembled(operator.n());
    let (one, i) = (c64::new(1.0, 0.0), c64::new(0.0, 1.0));
    let mut stiffness: Vec<(c64, &SparseMatrix)> = vec![(one, &operator.stiffness), (one, &stiff)];
    let mut damping: Vec<(f64, &SparseMatrix)> = vec![(0.0, operator.mass), (1.0, &damped)];
    stiffness.extend(operator.damping.hysteretic.as_deref().map(|h| (i, h)));
    damping.extend(operator.damping.viscous.as_deref().map(|c| (1.0, c)));
    if let Some(skew) = operator.skew {
        stiffness.push((one, &skew.stiffness));
        damping.push((1.0, &skew.damping));
    }
    let modal = operator.damping.modal.as_ref();
    QuadraticProblem {
        mass: operator.mass,
        damping: add_scaled(&damping),
        stiffness: add_scaled(&stiffness),
        low_rank: modal.map_or((MatRef::from_column_major_slice(&[], 0, 0), &[]), |modal| {
            (modal.basis.as_ref(), modal.coefficients.as_slice())
        }),
        couples: &operator.stiffness,
    }
}

fn same(mode: &ComplexMode, value: c64) -> bool {
    let rounding = SAME * mode.condition.clamp(1.0, 1e4) * value.norm();
    (mode.eigenvalue - value).norm() <= rounding.max(WITHIN * mode.uncertainty)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equilibrium::samples::sparse;
    use crate::equilibrium::{SteadyOptions, solve_steady};
    use crate::linalg::random::Random;
    use crate::modal::samples::dense_modes;
    use crate::stability::complex_modes;
    use crate::system::{Damping, Structure};

    /// Oscillators, some of them equal, and free chains, with modes of a band or those nearest to a frequency: both methods agree, and
    /// do not where a mode is left out.
    #[test]
    fn equal_eigenvalues_zeros_and_the_nearest_are_confirmed() {
        let mut random = Random::seeded(31);
        for trial in 0..40 {
            let n = 4 + trial % 5;
            let free = trial % 2 == 1;
            let springs: Vec<f64> = (0..n).map(|_| 1e4 * (2.0 + random.next())).collect();
            let stiffness = |i: usize, j: usize| match (free, i.abs_diff(j)) {
                // Every second oscillator is equal to the one before.
                (false, 0) => springs[i - i % 2],
                (true, 0) => springs[i] * f64::from(i + 1 < n) + if i > 0 { springs[i - 1] } else { 0.0 },
                (true, 1) => -springs[i.min(j)],
                _ => 0.0,
            };
            let structure = Structure {
                mass: sparse(n, |i, j| f64::from(u8::from(i == j))).into(),
                stiffness: sparse(n, stiffness).into(),
                damping: Damping::default(),
                engine: Default::default(),
            };
            let system = System::new(structure, Vec::new());
            let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
            let real = dense_modes(&system, n);
            let hz = [0.0, 1.1 * real.frequency_hz(n - 1)];
            let nearest = (trial % 4 < 2).then(|| (real.frequency_hz(n / 2) * 1.01, 1 + trial % 3));
            let band = Band { hz, nearest, left_vectors: true };
            let mut found = complex_modes(&system, &steady, &real, band, &()).unwrap();
            let confirmation = confirm(&system, &steady, &found, band, &()).unwrap();
            assert!(confirmation.holds(), "{trial}: {confirmation:?}");
            if !free && nearest.is_none() {
                let first = found.modes[0].eigenvalue;
                found.modes.retain(|mode| (mode.eigenvalue - first).norm() > 1e-6 * first.norm());
                assert!(!confirm(&system, &steady, &found, band, &()).unwrap().holds(), "{trial}");
            }
        }
    }
}
