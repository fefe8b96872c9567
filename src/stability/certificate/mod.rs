//! The certificate that no unstable mode was missed.
//!
//! The eigenvalues inside a closed region, growth ε … R times the band, are *counted* without looking for them. With
//! Q_B the projection of Q on the basis of the analysis, brought to oscillators p(s) = s² + a s + θ + i h,
//!
//! det Q_B(s) = Π p(s) · d(s), d(s) = det(I + H(s) κ(s)), H = W_Bᵀ diag(1/p) W_B, κ = k + s c,
//!
//! d is as small as the contact, and the zeros of Q_B inside are the winding number of d around zero along the contour plus the
//! zeros of p inside, which are known in closed form. Three statements make it a proof, up to rounding:
//!
//! 1. *Between the points.* Each point of the contour comes with a disc in which d has no zero and its phase changes by
//!    less than a quarter turn ([`pencil`]). The discs cover the contour ([`contour`]): no winding can be missed.
//! 2. *Beyond the basis.* With the real modes below Ω_b complete, by the Sturm count, the full order differs from the
//!    basis by a perturbation of relative size ρ on the contour ([`remainder`]). Where ρ < 1 everywhere the full
//!    determinant winds like the small one. The margin is the smallest 1/ρ.
//!    Of a large interface d costs too much: the eigenvalues of the reduced model are then computed and counted one by
//!    one, their number inside is proven from what is left of the matrix in their coordinates, and the same coordinates
//!    bound ρ ([`spectrum`]). Where contact has many directions, that is done in the part of the basis that
//!    the modes of the band need ([`narrow`]), and in the whole where that proves nothing.
//! 3. *Beyond the region.* Nothing in the band grows faster than R ([`beyond`]), oscillating or not. Where that is not shown, or the
//!    region up to R could not be counted, R is the top of the band, 2π f, and that faster growth is not excluded is stated.
//!
//! Where the part that is not symmetric has no low rank the determinant is followed at full order ([`determinant`]).
//!
//! That M, C and H are symmetric and positive semidefinite is proven by inertia counts; otherwise nothing is certified.
//!
//! Assumptions: the real modes are exact (their residuals enter squared), rounding errors are not bounded, and modal
//! damping counts as acting on real modes when one random combination of its modes does.

mod beyond;
mod contour;
mod count;
mod coupling_factor;
mod damping;
mod determinant;
mod far;
mod few_rows;
mod largest;
mod missed;
mod narrow;
mod pencil;
mod probes;
mod reach;
mod reduced;
mod region;
mod remainder;
mod rows;
mod spectrum;
#[cfg(test)]
mod tests;
mod work;

use super::ComplexModes;
use super::Structural;
use super::analysis::{CompletedAnalysis, analyse};
use super::band::Band;
use super::complex::modes_with_skew_parts;
use crate::dynamics::Operator;
use crate::equilibrium::SteadySliding;
use crate::error::{Error, Result};
use crate::numbers::{hertz, significant};
use crate::progress::Observer;
use crate::system::System;
pub(super) use beyond::Definiteness;
use contour::{Limits, Stopped, Winding, wind};
pub use count::{Certificate, CloseCall, SLOWEST_GROWTH};
use count::{close_calls, found, slowest_growth};
#[cfg(test)]
pub(in crate::stability) use determinant::count as count_determinant;
use pencil::Pencil;
use reduced::ReducedModel;
use region::CountedRegion;
use spectrum::ReducedSpectrum;
use std::f64::consts::TAU;
pub use work::CountSize;

/// Operations of a count that is announced with them.
const LONG: f64 = 1e12;

/// How often the contour is moved a little when an eigenvalue is too near for it.
const ATTEMPTS: usize = 3;

/// Operations of a count along the contour, some seconds, beyond which a cheaper method is used.
const LONG_CONTOUR: f64 = 5e9;

/// Operations of a count along the contour, a minute or two, at most, whoever requests it: where the bound on what the basis leaves out is
/// weak, it needs ever more points, and a richer basis costs less.
const PATIENCE: f64 = 3e11;

/// [`complex_modes`](super::complex_modes) of the band, all of them as they are counted, and the count of those that grow.
///
/// The caller compares: [`Certificate::agrees`] is false when a mode was missed. Where the modes cannot be counted, such
/// as with an eigenvalue on the contour wherever it is drawn, or where that is expected to take more than `most_work`
/// floating-point operations (infinity for no limit) and more than those of the analysis, there is no certificate but a warning.
///
/// # Errors
/// Those of [`complex_modes`](super::complex_modes).
pub fn certified_modes<'a>(
    system: &System,
    steady: &SteadySliding,
    known: impl Into<Structural<'a>>,
    band: impl Into<Band>,
    most_work: f64,
    observer: &dyn Observer,
) -> Result<(ComplexModes, Option<Certificate>)> {
    if system.skew().is_some() {
        return counted_at_full_order(system, steady, known.into(), band.into(), most_work, observer);
    }
    let band = Band { nearest: None, ..band.into() };
    analyse(system, steady, known, band, observer, |modes, analysis| {
        let matrices = Definiteness { operator: analysis.operator, factor: Some(analysis.factor) };
        if let Some(broken) = matrices.broken_premise() {
            not_countable(modes, broken);
            return None;
        }
        let size = size(&analysis);
        let work = expected_work(&analysis, modes).min(size.operations());
        let of_analysis = size.operations_of_analysis(modes.refinements);
        let most_work = most_work.max(work::SHARE * of_analysis);
        if work > most_work {
            modes.warnings.push(format!(
                "The unstable modes were not counted: with {} directions of contact that would take about {work:.0e} operations, \
                 the analysis took {of_analysis:.0e}; `cea.certify = true` counts them all the same",
                directions(&analysis)
            ));
            return None;
        }
        if work >= LONG {
            observer.note(&format!(
                "The count of the unstable modes is expected to take about {work:.0e} operations"
            ));
        }
        observer.begin("certificate", None);
        let certificate = count(&analysis, modes, most_work);
        observer.end();
        match certificate {
            Ok(certificate) => {
                if certificate.agrees() && !certificate.holds() {
                    modes.warnings.push(weak(&certificate));
                }
                Some(certificate)
            }
            Err(error) => {
                modes.warnings.push(format!("The unstable modes could not be counted: {error}"));
                None
            }
        }
    })
}

/// [`certified_modes`] of a system with sparse skew parts; where only those nearest to a frequency are requested there is nothing
/// to compare a count with.
fn counted_at_full_order(
    system: &System,
    steady: &SteadySliding,
    known: Structural<'_>,
    band: Band,
    most_work: f64,
    observer: &dyn Observer,
) -> Result<(ComplexModes, Option<Certificate>)> {
    let mut general = modes_with_skew_parts((system, steady), known, band, observer)?;
    if band.nearest.is_some() {
        general.modes.warnings.push(
            "The unstable modes were not counted: those nearest to a frequency are requested, not all of a band"
                .to_string(),
        );
        return Ok((general.modes, None));
    }
    let operator = Operator::new(system, steady)?;
    let matrices = Definiteness { operator: &operator, factor: None };
    if let Some(broken) = matrices.broken_premise() {
        not_countable(&mut general.modes, broken);
        return Ok((general.modes, None));
    }
    determinant::analyse_pattern(&operator, &mut general, band.hz)?;
    let work = determinant::work(&general);
    if work > most_work {
        determinant::not_counted(&mut general.modes, work);
        return Ok((general.modes, None));
    }
    observer.begin("certificate", None);
    let top = TAU * band.hz[1];
    let dissipative = matrices.dissipates(top);
    let fastest = if dissipative { matrices.fastest(top)? } else { None };
    let certificate = determinant::count(&operator, &general, band.hz, fastest)
        .map(|certificate| Certificate { dissipative, ..certificate });
    observer.end();
    match certificate {
        Ok(certificate) => Ok((general.modes, Some(certificate))),
        Err(error) => {
            general.modes.warnings.push(format!("The unstable modes could not be counted: {error}"));
            Ok((general.modes, None))
        }
    }
}

/// Notes that a premise of every statement on stability is false.
fn not_countable(modes: &mut ComplexModes, broken: &'static str) {
    modes.warnings.push(format!("The unstable modes cannot be counted: {broken}"));
    modes.broken_premise = Some(broken);
}

/// The directions in which the interface acts.
fn directions(analysis: &CompletedAnalysis<'_>) -> usize {
    analysis.operator.interface.active(TAU * analysis.band_hz[1]).len()
}

/// About the floating-point operations of a point of the contour: products of matrices of the sizes of the basis (m) and
/// the interface (r), and what small ones cost besides.
fn work_of_a_point(analysis: &CompletedAnalysis<'_>) -> f64 {
    let (m, r) = (analysis.basis.len() as f64, directions(analysis) as f64);
    r * r * (16.0 * m + 40.0 * r) + 4.0 * m * r * (m - analysis.basis.n_real() as f64) + 3e5
}

/// Expected work of a count \[operations\]: about thirty points of the contour a mode.
fn expected_work(analysis: &CompletedAnalysis<'_>, modes: &ComplexModes) -> f64 {
    30.0 * (modes.modes.len() + 10) as f64 * work_of_a_point(analysis)
}

/// The sizes of a count from the spectrum.
fn size(analysis: &CompletedAnalysis<'_>) -> CountSize {
    let symbolic = analysis.factor.symbolic();
    CountSize {
        dofs: analysis.operator.n() as f64,
        fill: symbolic.fill() as f64,
        multiplications: symbolic.multiplications(),
        real_modes: analysis.basis.n_real() as f64,
        basis: analysis.basis.len() as f64,
        directions: directions(analysis) as f64,
    }
}

/// The count agrees, and yet is no proof.
fn weak(certificate: &Certificate) -> String {
    if certificate.margin > 1.0 {
        return "The count of the unstable modes is no proof at full order: damping that is negative somewhere, or not known to dissipate, is \
                outside of its premises"
            .to_string();
    }
    let help = match certificate.dissipative {
        true => "take more real modes (`cea.basis_below`)",
        false => {
            "damping that is negative somewhere, or not known to dissipate, makes that bound large, and more real modes \
             (`cea.basis_below`) may not lower it"
        }
    };
    format!(
        "The count of the unstable modes is no proof at full order: near {} Hz what the basis leaves out may be {} times what would change it; {help}",
        hertz(certificate.tightest[0], 1),
        significant(1.0 / certificate.margin, 2)
    )
}

/// The count along the contour, or from the spectrum where that is long, of a narrow basis first where contact has many directions: the
/// contour is the last resort.
fn count(analysis: &CompletedAnalysis<'_>, modes: &ComplexModes, most_work: f64) -> Result<Certificate> {
    let contour_work = expected_work(analysis, modes);
    if contour_work <= LONG_CONTOUR.max(work::dense(analysis.basis.len() as f64)) {
        return count_by(Way::Contour, analysis, modes, most_work);
    }
    let proves = |count: &Result<Certificate>| count.as_ref().is_ok_and(|count| count.margin > 1.0);
    let size = size(analysis);
    // A richer basis, then the contour, where that is within the limit.
    let mut further = vec![(Way::Contour, contour_work, most_work.min(PATIENCE))];
    let mut best = match size.is_narrow() {
        true => {
            further.insert(0, (Way::Spectrum, size.operations_in_whole_basis(), most_work));
            let narrow = narrow::narrow(analysis)?;
            let analysis = CompletedAnalysis { basis: &narrow, ..*analysis };
            count_by(Way::Spectrum, &analysis, modes, most_work)
        }
        false => count_by(Way::Spectrum, analysis, modes, most_work),
    };
    for (way, ..) in further.into_iter().filter(|(_, work, most)| work <= most) {
        if proves(&best) {
            break;
        }
        let next = count_by(way, analysis, modes, most_work);
        if proves(&next) || best.is_err() {
            best = next;
        }
    }
    best
}

/// How the eigenvalues of the reduced model are counted.
#[derive(Debug, Clone, Copy)]
enum Way {
    /// By the winding number of d ([`contour`]).
    Contour,
    /// One by one ([`spectrum`]).
    Spectrum,
}

/// Function that counts the zeros of Q_B in a region, within limits.
type Count<'a> = dyn Fn(&CountedRegion, Limits) -> std::result::Result<Winding, Stopped> + 'a;

fn count_by(
    way: Way,
    analysis: &CompletedAnalysis<'_>,
    modes: &ComplexModes,
    most_work: f64,
) -> Result<Certificate> {
    let model = ReducedModel::new(analysis)?;
    let top = TAU * analysis.band_hz[1];
    let interface = &analysis.operator.interface;
    let sizes = interface.sizes(top);
    let most_points = (most_work.min(PATIENCE) / work_of_a_point(analysis)).max(1.0) as usize;
    let count: Box<Count<'_>> = match way {
        Way::Contour => {
            let pencil = Pencil::new(&model, &interface.terms, &sizes, top)?;
            Box::new(move |region, limits| wind(&pencil, region, limits))
        }
        Way::Spectrum => {
            let spectrum = ReducedSpectrum::new(&model, &interface.terms, &sizes, top)?;
            Box::new(move |region, limits| spectrum.count(region, limits.defect))
        }
    };
    let matrices = Definiteness { operator: analysis.operator, factor: Some(analysis.factor) };
    let fastest = if model.dissipative { matrices.fastest(top)? } else { None };
    let mut best: Option<(CountedRegion, Winding)> = None;
    let mut stopped = Stopped::TooManyPoints;
    // As far as a mode can grow, or, where that cannot be counted, as far as the band reaches.
    let beyond = fastest.filter(|fastest| *fastest > top).map(|fastest| (fastest, 0));
    let tries = beyond.into_iter().chain((0..ATTEMPTS).map(|attempt| (top, attempt)));
    // All tries together take `most_points`; the one beyond the band, half of them.
    let mut left = most_points;
    for (reach, attempt) in tries {
        let region = region(analysis, modes, reach, attempt);
        // Beyond the band nothing but a proof is of use.
        let limits = match reach > top {
            true => Limits { points: left / 2, defect: 1.0 },
            false => Limits { points: left, defect: f64::INFINITY },
        };
        match count(&region, limits) {
            Ok(winding) => {
                left = left.saturating_sub(winding.points);
                let better = best.as_ref().is_none_or(|(_, b)| winding.defect < b.defect);
                if better {
                    best = Some((region, winding));
                }
                if winding.defect < 1.0 {
                    break;
                }
            }
            Err(why) => {
                left -= if matches!(why, Stopped::At(_)) { 0 } else { limits.points };
                stopped = why;
            }
        }
        if left == 0 {
            break;
        }
    }
    let Some((region, winding)) = best else {
        let (found, help) = match stopped {
            Stopped::At(place) => (
                format!(
                    "an eigenvalue lies on the contour near {} Hz, growth {:.3e} 1/s",
                    hertz(place.im / TAU, 6),
                    place.re
                ),
                "Move the ends of the band by a few hertz",
            ),
            Stopped::TooManyPoints | Stopped::Weak => (
                format!("the contour takes more than {most_points} points"),
                "Take more real modes (`cea.basis_below`)",
            ),
        };
        return Err(Error::analysis("certificate of the unstable modes", found, help));
    };
    let structure_poles =
        model.oscillators.iter().flat_map(|o| o.roots()).filter(|root| region.contains(*root)).count();
    let found = found(modes, &region);
    Ok(Certificate {
        band_hz: region.omega.map(|w| w / TAU),
        growth: region.growth,
        counted: winding.zeros,
        found,
        margin: 1.0 / winding.defect.max(1e-16),
        tightest: [winding.worst.im / TAU, winding.worst.re],
        points: winding.points,
        structure_poles,
        dissipative: model.dissipative,
        nothing_faster: fastest.is_some_and(|fastest| region.growth[1] >= fastest),
        proven: true,
        close_calls: close_calls(modes, &region),
    })
}

/// The band of the analysis times ε … `reach`, each attempt a little smaller.
fn region(
    analysis: &CompletedAnalysis<'_>,
    modes: &ComplexModes,
    reach: f64,
    attempt: usize,
) -> CountedRegion {
    let [low, high] = analysis.band_hz.map(|f| TAU * f);
    let inward = 1e-5 * attempt as f64;
    // With loss factors the spectrum is not symmetric, and at ω = 0 they mean nothing.
    let bottom = if low == 0.0 && analysis.operator.damping.hysteretic.is_some() { 1e-3 * high } else { low };
    let growth = slowest_growth(modes, high, reach) * (1.0 + 0.1 * attempt as f64);
    CountedRegion {
        growth: [growth, reach],
        omega: [if bottom > 0.0 { bottom + inward * high } else { 0.0 }, high * (1.0 - inward)],
    }
}
