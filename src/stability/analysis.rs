//! The analysis: project, solve, measure on the full order, enrich, repeat.

use super::band::{Band, in_band, part_real_pairs};
use super::basis::Basis;
use super::closed::{closed_modes, share_out};
use super::post_processing::post_processed;
use super::projected::{SmallPair, project_interface, solve};
use super::refinement::{Corrections, MeasuredPairs, PairMeasurement, TOGETHER};
use super::responses::{add_coupled_responses, few_responses};
use super::{ComplexMode, ComplexModes, Structural, accuracy_warnings};
use crate::dynamics::{Block, Operator};
use crate::equilibrium::SteadySliding;
use crate::error::{Error, Fault, Result};
use crate::linalg::SymmetricFactor;
use crate::linalg::c64;
use crate::linalg::dense::product;
use crate::linalg::sparse::add_scaled;
use crate::modal::{RealModes, ShiftedStiffness};
use crate::numbers::{hertz, significant};
use crate::progress::Observer;
use crate::system::System;
use faer::Mat;
use std::f64::consts::TAU;

/// Most refinement steps.
const MOST_REFINEMENTS: usize = 6;
/// The most static contact responses that enter the first basis; of more directions the residuals ask for what matters.
const STATIC_RESPONSES: usize = 240;
/// The E-norm below which a first correction is left out.
pub(super) const FIRST_TOLERANCE: f64 = 1e-6;
/// Two eigenvalues nearer than this part of |λ| may be taken for each other.
const ALONE: f64 = 1e-6;
/// An eigenvalue that moved by less than this part of |λ| is the same.
const UNMOVED: f64 = 1e-10;
/// A condition number of λ above this is reported.
const ILL_CONDITIONED: f64 = 1e6;

/// Data of an analysis with its modes found.
pub(super) struct CompletedAnalysis<'a> {
    pub(super) operator: &'a Operator<'a>,
    pub(super) basis: &'a Basis<'a>,
    /// A = K + K_σ − shift · M.
    pub(super) factor: &'a dyn SymmetricFactor,
    pub(super) shift: f64,
    /// Ω_b²: every real mode below it is in the basis, as the Sturm count proves; zero when it does not.
    pub(super) complete_below: f64,
    pub(super) band_hz: [f64; 2],
}

/// `complex_modes` of a projection, and what `then` gives for them and the analysis.
pub(super) fn analyse<'a, T>(
    system: &System,
    steady: &SteadySliding,
    known: impl Into<Structural<'a>>,
    band: impl Into<Band>,
    observer: &dyn Observer,
    then: impl FnOnce(&mut ComplexModes, CompletedAnalysis<'_>) -> T,
) -> Result<(ComplexModes, T)> {
    let (known, asked) = (known.into(), band.into());
    check(system, steady, known.real, asked.hz)?;
    let top = TAU * asked.hz[1];
    let Some((closed, own, shifted)) = closed_modes((system, steady), known.real, top, observer)? else {
        return solved(&Operator::new(system, steady)?, known, asked, observer, then);
    };
    let (mut modes, rest) = {
        let operator = Operator::new(&closed.system, &closed.steady)?;
        let known = Structural { real: &own, shifted: Some(&shifted) };
        solved(&operator, known, asked, observer, then)?
    };
    share_out(&mut modes.modes, system, known.real);
    Ok((modes, rest))
}

/// The modes of `operator`, and what `then` gives for them and the analysis.
fn solved<T>(
    operator: &Operator<'_>,
    known: Structural<'_>,
    asked: Band,
    observer: &dyn Observer,
    then: impl FnOnce(&mut ComplexModes, CompletedAnalysis<'_>) -> T,
) -> Result<(ComplexModes, T)> {
    let (real, band_hz) = (known.real, asked.hz);
    let band = band_hz.map(|f| TAU * f);
    observer.begin("complex eigenvalues", None);
    let own = match known.serves(band_hz) {
        true => Ok(None),
        false => shifted_factor(operator, real, band)
            .map(|(factor, shift)| Some(ShiftedStiffness { shift, factor })),
    };
    let solved = own.and_then(|own| {
        let solved = solve_and_refine(operator, at(&own, known), real, asked, observer)?;
        Ok((own, solved))
    });
    observer.end();
    let (own, (mut modes, basis)) = solved?;
    let shifted = at(&own, known);
    let analysis = CompletedAnalysis {
        operator,
        basis: &basis,
        factor: &*shifted.factor,
        shift: shifted.shift,
        complete_below: complete_below(operator.n(), real),
        band_hz,
    };
    let rest = then(&mut modes, analysis);
    Ok((modes, rest))
}

/// The factors made here, or those at hand where none were.
fn at<'a>(own: &'a Option<ShiftedStiffness>, known: Structural<'a>) -> &'a ShiftedStiffness {
    own.as_ref().or(known.shifted).expect("made where none serve")
}

/// Ω_b² below which no real mode is missing.
fn complete_below(n: usize, real: &RealModes) -> f64 {
    if real.len() == n {
        f64::INFINITY
    } else if real.certificate.holds() {
        (TAU * real.certificate.below_hz).powi(2)
    } else {
        0.0
    }
}

pub(super) fn check(
    system: &System,
    steady: &SteadySliding,
    real: &RealModes,
    band_hz: [f64; 2],
) -> Result<()> {
    let [low, high] = band_hz;
    if !(low >= 0.0 && high > low && high.is_finite()) {
        let found = format!("{low} to {high} Hz");
        return Err(Error::input(Fault::new("frequency band", found, "0 ≤ lowest < highest")));
    }
    let n = system.n_dofs();
    if steady.displacement.len() != n
        || steady.points.len() != system.points().count()
        || real.shapes.nrows() != n
    {
        let found = format!("{} and {} degrees of freedom", steady.displacement.len(), real.shapes.nrows());
        return Err(Error::input(Fault::new(
            "steady state and real modes",
            found,
            format!("{n}, those of the system"),
        )));
    }
    Ok(())
}

/// The modes, and the basis they were found in.
fn solve_and_refine<'a>(
    operator: &'a Operator<'a>,
    shifted: &ShiftedStiffness,
    real: &'a RealModes,
    asked: Band,
    observer: &dyn Observer,
) -> Result<(ComplexModes, Basis<'a>)> {
    let factor = &*shifted.factor;
    let band = asked.hz.map(|f| TAU * f);
    let mut basis = Basis::new(operator, real.shapes.as_ref(), band[1] * band[1]);
    // Few directions: all their responses, so that the corrections show no contact motion. Many: what the forces of some
    // combinations of the modes have in common; the corrections bring what is missing.
    if operator.interface.active(band[1]).len() <= real.len() {
        let responses = few_responses(operator, &basis, factor, band[1]);
        let directions = operator.interface.active(band[1]).len();
        basis.enrich(&responses.subcols(0, directions).to_owned(), 1e-9, STATIC_RESPONSES);
        let further = responses.subcols(directions, responses.ncols() - directions);
        basis.enrich(&further.to_owned(), FIRST_TOLERANCE, STATIC_RESPONSES);
    } else {
        add_coupled_responses(operator, &mut basis, shifted, band[1], FIRST_TOLERANCE);
    }
    let mut warnings = Vec::new();
    let mut counts = Vec::new();
    let (mut found, mut refinements, mut finer, mut last) = (Vec::new(), 0, 0, false);
    loop {
        let scale = PairMeasurement { operator, basis: &basis, factor, top: band[1] };
        let wanted;
        (found, wanted) = evaluate(&scale, asked, found, last)?;
        observer.advance(1);
        counts.push(found.len());
        if wanted.is_empty() {
            break;
        }
        // The error of λ is quadratic in that of the vectors: coarse first, so that the basis stays small.
        let corrections = wanted.corrections(factor);
        let mut added = 0;
        while added == 0 && finer < MOST_REFINEMENTS {
            let tolerance = FIRST_TOLERANCE * 0.01f64.powi(finer as i32);
            added = basis.enrich(&corrections, tolerance, usize::MAX);
            finer += 1;
        }
        refinements += usize::from(added > 0);
        last = added == 0 || refinements == MOST_REFINEMENTS;
    }
    if let Some(first) = counts.first().filter(|first| counts.iter().any(|c| c != *first)) {
        let last = counts.last().unwrap_or(first);
        warnings.push(format!(
            "The refinement changed the number of complex modes in the band from {first} to {last}"
        ));
    }
    let mut modes: Vec<ComplexMode> = found.into_iter().filter_map(|found| found.mode).collect();
    part_real_pairs(&mut modes, band[1]);
    // The basis is that of the band: eigenvalues far beyond it, real or heavily damped, need not be those of the full order.
    let (unconfirmed, kept): (Vec<_>, Vec<_>) =
        modes.into_iter().partition(|mode| mode.eigenvalue.norm() > band[1] && !mode.accurate());
    modes = kept;
    warnings.extend(beyond_the_band(&unconfirmed));
    let grows = unconfirmed.iter().any(|mode| mode.growth_rate() > 0.0);
    let broken_premise = grows.then_some("a mode beyond the band that may grow is not confirmed");
    for mode in modes.iter().filter(|mode| mode.accepted() && mode.condition > ILL_CONDITIONED) {
        warnings.push(format!(
            "The mode at {} Hz is ill-conditioned: a relative change of the matrices moves it by {:.0e} times as much",
            hertz(mode.frequency_hz(), 2),
            mode.condition
        ));
    }
    warnings.extend(accuracy_warnings(&modes));
    warnings.extend(incomplete(operator, real, asked.hz[1]));
    let modes =
        ComplexModes { modes, subspace_dimension: basis.len(), refinements, warnings, broken_premise };
    Ok((modes, basis))
}

/// Warning of eigenvalues that are left out: their |λ| is beyond the band, and they are not accurate.
fn beyond_the_band(modes: &[ComplexMode]) -> Option<String> {
    let nearest = modes.iter().min_by(|a, b| a.eigenvalue.norm().total_cmp(&b.eigenvalue.norm()))?;
    let [growth, frequency] = [nearest.growth_rate(), nearest.eigenvalue.im].map(|part| significant(part, 3));
    let found = match modes.len() {
        1 => "An eigenvalue beyond the band is".to_string(),
        n => format!("{n} eigenvalues beyond the band are"),
    };
    let which = if modes.len() == 1 { "it is" } else { "the nearest is" };
    Some(format!(
        "{found} left out, as not accurate: {which} σ = {growth} 1/s at ω = {frequency} 1/s; a higher `cea.basis_below` makes such \
         eigenvalues more accurate"
    ))
}

/// Warning where the real modes do not reach the band's top: those known, or the frequency below which a count has shown
/// that there are no others.
fn incomplete(operator: &Operator<'_>, real: &RealModes, top_hz: f64) -> Option<String> {
    let highest = real.len().checked_sub(1).map_or(0.0, |last| real.frequency_hz(last));
    let counted = if real.certificate.holds() { real.certificate.below_hz } else { 0.0 };
    let reach = highest.max(counted);
    (real.len() < operator.n() && reach < top_hz).then(|| {
        format!(
            "The real modes are known up to {} Hz, the band reaches to {} Hz: complex modes may be missing",
            hertz(reach, 1),
            hertz(top_hz, 1)
        )
    })
}

/// A = K + K_σ − s M and s, in the widest gap between the real modes' ω² near the middle of the band.
pub(super) fn shifted_factor(
    operator: &Operator<'_>,
    real: &RealModes,
    band: [f64; 2],
) -> Result<(Box<dyn SymmetricFactor>, f64)> {
    let middle = 0.5 * (band[0] * band[0] + band[1] * band[1]);
    let (low, high) = (0.5 * middle, 1.5 * middle);
    let mut ends = vec![low];
    ends.extend(real.eigenvalues.iter().copied().filter(|w| *w > low && *w < high));
    ends.push(high);
    let widest = ends.windows(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let shift = widest.map_or(middle, |gap| 0.5 * (gap[0] + gap[1]));
    let at = |s: f64| {
        let pencil = add_scaled(&[(1.0, &*operator.stiffness), (-s, operator.mass)]);
        operator.engine.factorize(&pencil).map(|factor| (factor, s))
    };
    at(shift).or_else(|_| at(-middle))
}

/// The pairs of the projected problem in the band.
fn small_pairs(operator: &Operator<'_>, basis: &Basis<'_>, band: [f64; 2]) -> Result<Vec<SmallPair>> {
    let (mut unsymmetric_damping, mut unsymmetric_stiffness) = project_interface(operator, basis);
    if let Some([circulatory, gyroscopic]) = &basis.skew {
        unsymmetric_stiffness += circulatory;
        unsymmetric_damping += gyroscopic;
    }
    let stiffness = &basis.stiffness + unsymmetric_stiffness;
    solve(
        &basis.mass,
        &(&basis.damping + unsymmetric_damping),
        &stiffness,
        basis.hysteretic.as_ref(),
        middle_frequency(&basis.mass, &stiffness, band[1]),
        |z| in_band(z, band),
    )
}

/// Keeps the `count` pairs nearest to iω of `hz`, and those as near as the last.
fn keep_nearest(pairs: &mut Vec<SmallPair>, (hz, count): (f64, usize)) {
    let distance = |pair: &SmallPair| (pair.lambda - c64::new(0.0, TAU * hz)).norm();
    let mut sorted: Vec<f64> = pairs.iter().map(distance).collect();
    sorted.sort_by(f64::total_cmp);
    match count.checked_sub(1) {
        Some(last) => {
            let reach = sorted.get(last).copied().unwrap_or(f64::INFINITY);
            pairs.retain(|pair| distance(pair) <= reach + ALONE * pair.lambda.norm());
        }
        None => pairs.clear(),
    }
}

/// The median of the frequencies √(bᵀ(K + K_c)b/bᵀMb) of the basis that are below `top` \[rad/s\], but not less than a thousandth of
/// it; `top` when there is none.
fn middle_frequency(mass: &Mat<f64>, stiffness: &Mat<f64>, top: f64) -> f64 {
    let square = |i: usize| stiffness[(i, i)] / mass[(i, i)];
    let mut below: Vec<f64> =
        (0..mass.nrows()).map(square).filter(|w| *w > 0.0 && *w < top * top).map(f64::sqrt).collect();
    below.sort_by(f64::total_cmp);
    below.get(below.len() / 2).map_or(top, |middle| middle.max(1e-3 * top))
}

/// Pairs of the projected problem, the right vectors on the full order, and what the real modes have of those: ΦᵀMφ.
fn expand(basis: &Basis<'_>, pairs: &[&SmallPair], to: &mut MeasuredPairs) -> Block {
    let small = |pick: fn(&SmallPair) -> &Vec<c64>| {
        let small: Vec<&[c64]> = pairs.iter().map(|pair| pick(pair).as_slice()).collect();
        unit_mass(basis, Block::from_columns(basis.len(), &small))
    };
    let ((right, to_right), (left, to_left)) = (small(|p| &p.right), small(|p| &p.left));
    to.lambda = pairs.iter().map(|pair| pair.lambda).collect();
    let factors = to_right.iter().zip(&to_left).map(|(right, left)| right * left);
    to.steepness = pairs.iter().zip(factors).map(|(pair, factor)| pair.steepness * factor).collect();
    to.left = left;
    basis.expand_into(&right, &mut to.right);
    right.map(|y| product(basis.mass.as_ref().subrows(0, basis.n_real()), y))
}

/// Coordinates scaled so that the vectors which they represent have xᴴMx = 1, and by what.
fn unit_mass(basis: &Basis<'_>, mut y: Block) -> (Block, Vec<f64>) {
    let inertia = y.map(|y| product(basis.mass.as_ref(), y));
    let factors: Vec<f64> = (0..y.ncols()).map(|j| 1.0 / y.dot(j, &inertia).re.sqrt()).collect();
    y.scale(&factors);
    (y, factors)
}

/// A pair of the projected problem, and its mode where that is given: where it is as exact as the refinement aims at, and all
/// of them in the last round. Others are measured again, and their vectors are not held until then.
struct FoundMode {
    eigenvalue: c64,
    mode: Option<ComplexMode>,
}

/// The modes of the projected problem, measured on the full order, and what those ask for that are not exact. Of those found
/// before, the exact ones are kept. In the `last` round all modes are given as they are, and nothing is asked for.
fn evaluate(
    scale: &PairMeasurement<'_>,
    asked: Band,
    before: Vec<FoundMode>,
    last: bool,
) -> Result<(Vec<FoundMode>, Corrections)> {
    let mut pairs = small_pairs(scale.operator, scale.basis, asked.hz.map(|f| TAU * f))?;
    if let Some(nearest) = asked.nearest {
        keep_nearest(&mut pairs, nearest);
    }
    let settled: Vec<Option<usize>> = pairs.iter().map(|p| settled(&before, &pairs, p.lambda)).collect();
    // Those that are measured again are not held beside what replaces them.
    let stays = |k: usize| settled.contains(&Some(k));
    let mut before: Vec<Option<FoundMode>> =
        before.into_iter().enumerate().map(|(k, found)| stays(k).then_some(found)).collect();
    let fresh: Vec<&SmallPair> =
        pairs.iter().zip(&settled).filter(|(_, place)| place.is_none()).map(|(pair, _)| pair).collect();
    let mut wanted = Corrections::of_at_most(fresh.len());
    let (mut new, mut measured) = (Vec::new(), MeasuredPairs::default());
    for chunk in fresh.chunks(TOGETHER) {
        let amplitudes = expand(scale.basis, chunk, &mut measured);
        scale.measure(&mut measured);
        if !last {
            wanted.add(scale, &measured, asked.left_vectors);
        }
        let given: Vec<bool> = (0..chunk.len()).map(|j| last || measured.exact(j)).collect();
        let left = (asked.left_vectors && given.contains(&true)).then(|| scale.basis.expand(&measured.left));
        let modes =
            post_processed(scale.operator, &mut measured, &given, &amplitudes, left.as_ref(), scale.top);
        let found = |(pair, mode): (&&SmallPair, _)| FoundMode { eigenvalue: pair.lambda, mode };
        new.extend(chunk.iter().zip(modes).map(found));
    }
    let mut new = new.into_iter();
    let of = |place: Option<usize>| match place {
        Some(k) => before[k].take().expect("one pair settles on it"),
        None => new.next().expect("one for each pair that did not settle"),
    };
    Ok((settled.into_iter().map(of).collect(), wanted))
}

/// The place of the exact mode that has this λ, when there is just one mode and one pair of `all` there.
fn settled(before: &[FoundMode], all: &[SmallPair], lambda: c64) -> Option<usize> {
    let apart = |z: c64| (z - lambda).norm() / lambda.norm();
    let mut own = (0..before.len()).filter(|j| apart(before[*j].eigenvalue) <= ALONE);
    let alone = all.iter().filter(|pair| apart(pair.lambda) <= ALONE).count() == 1;
    let j = own.next().filter(|j| alone && own.next().is_none() && before[*j].mode.is_some())?;
    (apart(before[j].eigenvalue) <= UNMOVED).then_some(j)
}

#[cfg(test)]
mod tests {
    use super::super::tests::steady;
    use super::*;
    use crate::equilibrium::samples::random_system;
    use crate::modal::samples::dense_modes;

    #[test]
    fn real_modes_reach_as_far_as_they_are_counted() {
        let system = random_system(40, 2, 20.0, 1);
        let steady = steady(&system);
        let operator = Operator::new(&system, &steady).unwrap();
        let mut real = dense_modes(&system, 9);
        let (highest, counted) = (real.frequency_hz(8), real.certificate.below_hz);
        assert!(counted > highest);
        let between = 0.5 * (highest + counted);
        assert_eq!(incomplete(&operator, &real, between), None);
        let said = incomplete(&operator, &real, 2.0 * counted).unwrap();
        assert!(said.contains(&format!("up to {} Hz", hertz(counted, 1))), "{said}");
        real.certificate.found -= 1;
        let said = incomplete(&operator, &real, between).unwrap();
        assert!(said.contains(&format!("up to {} Hz", hertz(highest, 1))), "{said}");
        assert_eq!(incomplete(&operator, &dense_modes(&system, 40), 1e9), None);
    }
}
