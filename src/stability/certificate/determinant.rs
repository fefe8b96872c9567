//! A count at full order, where the part that is not symmetric has no low rank: the winding number of det Q around the region.
//!
//! f(s) = det Q(s) / Π (s − λ) over the eigenvalues λ that were found has the phase of U's diagonal in Q(s) = L U, less that of the
//! known factors. Its winding number along the contour counts the eigenvalues inside that were not found; near a found eigenvalue it
//! is smooth, so that few points are enough. A stretch is halved until the phase changes by less than [`STEP`] on either half:
//! the phase between the points is followed, not bounded, so that this is a count and no proof.

use super::count::{Certificate, close_calls, found, slowest_growth};
use super::region::CountedRegion;
use crate::dynamics::{Operator, Shifted};
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::numbers::hertz;
use crate::stability::ComplexModes;
use crate::stability::general::General;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// The largest change of phase from point to point.
const STEP: f64 = 0.25 * PI;
/// The fastest growth that is counted where no bound is known, by the top of the band: a damping ratio of about −10 %.
const FASTEST: f64 = 0.1;
/// Pieces of an edge that are followed independently of each other. The eigenvalues that were not found, all but a few, change the
/// phase, too: with 4 pieces, halves of a piece changed by multiples of 2π at 4,680 degrees of freedom, and the count was wrong.
const PIECES: usize = 64;
/// Halvings of a piece at most, where the region is no taller than the band.
const HALVINGS: usize = 14;
/// Points that a contour takes as a rule.
const POINTS: f64 = 1000.0;
/// Seen from two shifts, an eigenvalue differs by less than this part of |λ|.
const SAME: f64 = 1e-9;

/// Analyses the pattern of Q, where that is not known, by its factors off the middle of the band.
/// Fails where these do not exist.
pub(super) fn analyse_pattern(
    operator: &Operator<'_>,
    general: &mut General,
    band_hz: [f64; 2],
) -> Result<()> {
    if general.symbolic.is_none() {
        let [low, high] = band_hz.map(|f| TAU * f);
        let shift = c64::new(1e-3 * high, 0.5 * (low + high));
        general.symbolic = Shifted::new(operator, shift)?.symbolic();
    }
    Ok(())
}

/// Floating-point operations that the count is expected to take; infinity where no factorisation was made.
pub(super) fn work(general: &General) -> f64 {
    general.symbolic.as_ref().map_or(f64::INFINITY, |symbolic| POINTS * 8.0 * symbolic.multiplications())
}

/// The eigenvalues in the band with growth rates from [`slowest_growth`] to `fastest`, beyond which none grows, or to
/// [`FASTEST`] of the top, counted. Fails at an eigenvalue on the contour that the search has not found.
pub(in crate::stability) fn count(
    operator: &Operator<'_>,
    general: &General,
    band_hz: [f64; 2],
    fastest: Option<f64>,
) -> Result<Certificate> {
    let far = fastest.map(|reach| count_up_to(operator, general, band_hz, reach));
    match far {
        Some(Ok(certificate)) => Ok(Certificate { nothing_faster: true, ..certificate }),
        _ => count_up_to(operator, general, band_hz, FASTEST * TAU * band_hz[1]),
    }
}

fn count_up_to(
    operator: &Operator<'_>,
    general: &General,
    band_hz: [f64; 2],
    reach: f64,
) -> Result<Certificate> {
    let [low, high] = band_hz.map(|f| TAU * f);
    // With loss factors the spectrum is not symmetric, and at ω = 0 they mean nothing.
    let lossy = operator.damping.hysteretic.is_some();
    let bottom = if low == 0.0 && lossy { 1e-3 * high } else { low };
    let region =
        CountedRegion { growth: [slowest_growth(&general.modes, high, reach), reach], omega: [bottom, high] };
    let known = known(&general.seen, !lossy);
    let halvings = HALVINGS + (reach / high).max(1.0).log2().ceil() as usize;
    let determinant = Determinant { operator, general, known: &known, halvings };
    let pieces: Vec<[c64; 2]> = region
        .path()
        .windows(2)
        .flat_map(|edge| {
            let (a, b) = (edge[0], edge[1]);
            let at = move |k: usize| if k == PIECES { b } else { a + (b - a) * (k as f64 / PIECES as f64) };
            (0..PIECES).map(move |k| [at(k), at(k + 1)])
        })
        .collect();
    let followed =
        pieces.par_iter().map(|[a, b]| determinant.follow(*a, *b)).collect::<Result<Vec<FollowedPhase>>>()?;
    let change: f64 = followed.iter().map(|w| w.change).sum();
    let winding = if region.symmetric() { 2.0 * change / TAU } else { change / TAU };
    let widest = followed
        .iter()
        .copied()
        .reduce(|a, b| if b.step > a.step { b } else { a })
        .expect("a region has edges");
    if (winding - winding.round()).abs() > 1e-3 {
        return Err(Error::analysis(
            "count of the unstable modes",
            format!("the phase of the determinant winds {winding:.4} times around the region"),
            "Move the ends of the band by a few hertz",
        ));
    }
    let inside = known.iter().filter(|z| region.contains(**z)).count() as i64;
    Ok(Certificate {
        band_hz: region.omega.map(|w| w / TAU),
        growth: region.growth,
        counted: winding.round() as i64 + inside,
        found: found(&general.modes, &region),
        margin: PI / widest.step.max(1e-6),
        tightest: [widest.at.im / TAU, widest.at.re],
        points: followed.iter().map(|w| w.points).sum(),
        structure_poles: 0,
        dissipative: false,
        nothing_faster: false,
        proven: false,
        close_calls: close_calls(&general.modes, &region),
    })
}

/// Each found eigenvalue once, with its conjugate where the spectrum is symmetric.
fn known(seen: &[c64], symmetric: bool) -> Vec<c64> {
    let mut all: Vec<c64> = seen.to_vec();
    if symmetric {
        all.extend(seen.iter().map(|z| z.conj()));
    }
    all.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
    let mut known: Vec<c64> = Vec::new();
    for z in all {
        let near = known.iter().rev().take_while(|k| z.im - k.im <= SAME * z.norm());
        if near.into_iter().all(|k| (k - z).norm() > SAME * z.norm()) {
            known.push(z);
        }
    }
    if symmetric {
        // What round-off left beside its conjugate's conjugate: the upper half decides for both.
        known.retain(|z| z.im >= -SAME * z.norm());
        let lower: Vec<c64> = known.iter().filter(|z| z.im > SAME * z.norm()).map(|z| z.conj()).collect();
        known.iter_mut().filter(|z| z.im <= SAME * z.norm()).for_each(|z| z.im = 0.0);
        known.extend(lower);
    }
    known
}

struct Determinant<'a> {
    operator: &'a Operator<'a>,
    general: &'a General,
    known: &'a [c64],
    /// Halvings of a piece at most.
    halvings: usize,
}

/// A stretch of the contour: the change of the phase along it, the largest step and where, and the points.
#[derive(Debug, Clone, Copy)]
struct FollowedPhase {
    change: f64,
    step: f64,
    at: c64,
    points: usize,
}

impl Determinant<'_> {
    /// f(s)/|f(s)|.
    fn phase(&self, s: c64) -> Result<c64> {
        let shifted = Shifted::with_pattern(self.operator, s, self.general.symbolic.as_ref())?;
        let phase = shifted.phase().ok_or_else(|| {
            Error::analysis(
                "count of the unstable modes",
                format!("an eigenvalue lies on the contour near {} Hz", hertz(s.im / TAU, 6)),
                "Move the ends of the band by a few hertz",
            )
        })?;
        let factors = self.known.iter().map(|z| {
            let d = s - z;
            d.conj() / d.norm().max(f64::MIN_POSITIVE)
        });
        Ok(factors.fold(phase, |product, factor| product * factor))
    }

    fn follow(&self, a: c64, b: c64) -> Result<FollowedPhase> {
        let (first, last) = (self.phase(a)?, self.phase(b)?);
        let mut followed = FollowedPhase { change: 0.0, step: 0.0, at: a, points: 2 };
        let mut open = vec![(a, first, b, last, 0)];
        while let Some((a, of_a, b, of_b, depth)) = open.pop() {
            let middle = (a + b) * 0.5;
            let of_middle = self.phase(middle)?;
            followed.points += 1;
            let steps = [(of_middle * of_a.conj()).arg(), (of_b * of_middle.conj()).arg()];
            let largest = steps[0].abs().max(steps[1].abs());
            if largest <= STEP {
                followed.change += steps[0] + steps[1];
                if largest > followed.step {
                    (followed.step, followed.at) = (largest, middle);
                }
            } else if depth == self.halvings {
                return Err(Error::analysis(
                    "count of the unstable modes",
                    format!(
                        "the phase of the determinant jumps near {} Hz: an eigenvalue lies on the contour",
                        hertz(middle.im / TAU, 6)
                    ),
                    "Move the ends of the band by a few hertz",
                ));
            } else {
                open.push((middle, of_middle, b, of_b, depth + 1));
                open.push((a, of_a, middle, of_middle, depth + 1));
            }
        }
        Ok(followed)
    }
}

/// Warning that the unstable modes are not counted.
pub(super) fn not_counted(modes: &mut ComplexModes, work: f64) {
    modes.warnings.push(format!(
        "The unstable modes were not counted: at full order that would take about {work:.0e} operations; `cea.certify = true` counts them all the same"
    ));
}
