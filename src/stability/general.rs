//! Complex modes where the part that is not symmetric has no low rank: two-level Arnoldi at shifts along the band, on Q and on
//! its adjoint.
//!
//! The band is cut into pieces. At a shift in the middle of a piece the Krylov space grows until it holds every eigenvalue
//! within a circle through the piece's corners ω ± h, σ ± h (h half its length); a piece with too many is halved. Right and
//! left vectors come from Krylov spaces of their own, so that their eigenvalues confirm each other, and the two-sided
//! Rayleigh quotient λ − ψᴴQ(λ)φ / ψᴴQ′(λ)φ has an error quadratic in those of the vectors.

use super::band::{Band, diverges, in_band, part_real_pairs};
use super::budget::growth_budget;
use super::certificate::Definiteness;
use super::post_processing::shares;
use super::refinement::TOGETHER;
use super::{CONTACT_ROUNDING, ComplexMode, ComplexModes, ROUNDING, accuracy_warnings, is_real};
use crate::dynamics::{Adjoint, Block, Operator, Shifted, Side};
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::factor::SymbolicFactor;
use crate::linalg::lu::Lu;
use crate::linalg::multivector::gram;
use crate::linalg::sparse::times;
use crate::linalg::toar::{ToarPairs, toar};
use crate::modal::RealModes;
use crate::numbers::hertz;
use crate::progress::Observer;
use faer::Mat;
use std::f64::consts::TAU;

/// ‖A v − θ v‖ / |θ| of the Ritz pairs.
const TOLERANCE: f64 = 1e-12;
/// Eigenvalues of a piece at most: more are cheaper at two shifts.
const MOST: usize = 60;
/// Eigenvalues sought at a shift on the real axis.
const DIVERGING: usize = 8;
/// How far along the real axis they are sought where no bound is known, by the top of the band.
const FARTHEST: f64 = 100.0;
/// Left eigenvalues are sought a little farther than right ones, so that those at the rim have their partners.
const RIM: f64 = 1.001;
/// How far a search along the positive real axis reaches, by its shift, so that the next at twice the shift joins it; the first reaches
/// zero.
const ALONG: f64 = 0.35;
/// Half of a piece in which an iteration did not converge is looked at by itself, down to this part of the band's top.
const LEAST: f64 = 0.01;
/// Pieces of a band at most.
const PIECES: usize = 4096;
/// Two eigenvalues nearer than this part of |λ| share their vectors.
const CLUSTER: f64 = 1e-6;
/// Computed twice, an eigenvalue differs by less than this part of |λ|.
const SAME: f64 = 1e-9;

/// The modes of a band, and what else was met on the way.
pub(super) struct General {
    pub(super) modes: ComplexModes,
    /// Every eigenvalue found, those outside the band included, one of each conjugate pair or both.
    pub(super) seen: Vec<c64>,
    /// The analysis of the pattern of Q.
    pub(super) symbolic: Option<SymbolicFactor>,
}

/// Eigenvalues with their right and left vectors (n × m), found at one shift.
struct SpectrumPart {
    values: Vec<c64>,
    left_values: Vec<c64>,
    right: Mat<c64>,
    left: Mat<c64>,
    /// Distance from the shift within which there are no others; infinite where these are all.
    within: f64,
}

/// Looks for the modes that `asked` names; `real` are the modes of the symmetric part, in which their shapes are expressed.
/// Fails where a shift cannot be factorised, or an iteration does not converge.
pub(super) fn general_modes(
    operator: &Operator<'_>,
    real: &RealModes,
    asked: Band,
    observer: &dyn Observer,
) -> Result<General> {
    let band = asked.hz.map(|f| TAU * f);
    let mut search = ShiftSearch {
        operator,
        band,
        symbolic: None,
        seen: Vec::new(),
        shifts: 0,
        solves: 0,
        depth: f64::INFINITY,
        unsure: None,
    };
    observer.begin("complex eigenvalues", None);
    let pieces = match asked.nearest {
        Some((hz, count)) => search.nearest(TAU * hz, count).map(|piece| vec![piece]),
        None => search.all(real, observer).and_then(|mut pieces| {
            pieces.extend(search.diverging(&pieces)?);
            Ok(pieces)
        }),
    };
    observer.end();
    let (mut modes, mut warnings) = (Vec::new(), Vec::new());
    for piece in pieces? {
        modes.extend(search.measured(piece, real, asked.left_vectors));
    }
    modes.sort_by(|a, b| {
        let key = |m: &ComplexMode| (m.eigenvalue.im, m.eigenvalue.re);
        key(a).partial_cmp(&key(b)).expect("eigenvalues are numbers")
    });
    part_real_pairs(&mut modes, band[1]);
    if asked.nearest.is_none() {
        warnings.push(format!(
            "{} complex eigenvalues of the band by two-level Arnoldi at {} shifts ({} solutions): every one with |σ| below {:.3e} 1/s that the Krylov spaces hold",
            modes.len(),
            search.shifts,
            search.solves,
            search.depth
        ));
    }
    warnings.extend(accuracy_warnings(&modes));
    let broken_premise =
        search.unsure.is_some().then_some("real eigenvalues that may grow are not all known");
    warnings.extend(search.unsure);
    let modes =
        ComplexModes { modes, subspace_dimension: operator.n(), refinements: 0, warnings, broken_premise };
    Ok(General { modes, seen: search.seen, symbolic: search.symbolic })
}

struct ShiftSearch<'a> {
    operator: &'a Operator<'a>,
    band: [f64; 2],
    symbolic: Option<SymbolicFactor>,
    seen: Vec<c64>,
    shifts: usize,
    solves: usize,
    /// |σ| up to which the circles cover the band.
    depth: f64,
    /// Why real eigenvalues may be missing.
    unsure: Option<String>,
}

impl<'a> ShiftSearch<'a> {
    fn shifted(&mut self, middle: f64) -> Result<Shifted<'a>> {
        // Off the imaginary axis, where an undamped structure has its eigenvalues.
        let size = middle.max(1e-3 * self.band[1]);
        let mut last = None;
        for nudge in [1e-3, 1.7e-3, 3.1e-3] {
            let shift = c64::new(nudge * size, middle);
            match Shifted::with_pattern(self.operator, shift, self.symbolic.as_ref()) {
                Ok(shifted) => {
                    self.symbolic = self.symbolic.take().or_else(|| shifted.symbolic());
                    self.shifts += 1;
                    return Ok(shifted.two_sided());
                }
                Err(error) => last = Some(error),
            }
        }
        Err(last.expect("three shifts were tried"))
    }

    /// The modes nearest to iω: `count` of them in the band.
    fn nearest(&mut self, omega: f64, count: usize) -> Result<SpectrumPart> {
        let shifted = self.shifted(omega)?;
        let n = 2 * self.operator.n();
        let distance = |z: &c64| (z - c64::new(0.0, omega)).norm();
        let mut wanted = count + 4;
        loop {
            let expected = 0.1 * omega.max(1e-3 * self.band[1]);
            let piece = self.at(&shifted, omega, expected, (wanted, f64::INFINITY))?;
            let mut inside: Vec<c64> =
                piece.values.iter().copied().filter(|z| in_band(*z, self.band)).collect();
            inside.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
            // The shift is off the axis: one more than requested shows that none nearer is missing.
            let far = piece.values.iter().map(distance).fold(0.0, f64::max);
            let enough = inside.get(count.max(1) - 1).is_some_and(|last| distance(last) < 0.99 * far);
            if enough || wanted >= n || piece.within.is_infinite() {
                let reach =
                    inside.get(count.max(1) - 1).map_or(f64::INFINITY, |last| distance(last) * (1.0 + SAME));
                let band = self.band;
                return Ok(piece.keep(|z| in_band(z, band) && distance(&z) <= reach));
            }
            wanted = (2 * wanted).min(n);
        }
    }

    /// All pieces of the band.
    fn all(&mut self, real: &RealModes, observer: &dyn Observer) -> Result<Vec<SpectrumPart>> {
        let [low, high] = self.band;
        let expected = |a: f64, b: f64| {
            let inside = (0..real.len()).map(|k| TAU * real.frequency_hz(k)).filter(|w| (a..b).contains(w));
            inside.count()
        };
        // Pieces with about as many modes each, and so that a circle holds no more than [`MOST`].
        let parts = (expected(low, high) * 3).div_ceil(2 * MOST).max(1);
        let mut open: Vec<[f64; 2]> = (0..parts)
            .map(|k| [k, k + 1].map(|k| low + (high - low) * k as f64 / parts as f64))
            .rev()
            .collect();
        let (mut pieces, mut done): (Vec<SpectrumPart>, usize) = (Vec::new(), 0);
        while let Some([a, b]) = open.pop() {
            done += 1;
            if done > PIECES {
                return Err(Error::analysis(
                    "two-level Arnoldi",
                    format!("the band takes more than {PIECES} shifts"),
                    "Take a narrower band",
                ));
            }
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            match self.circle(middle, half, expected(a, b))? {
                None => open.extend([[middle, b], [a, middle]]),
                Some(piece) => {
                    let band = self.band;
                    let (first, last) = (a == low, b == high);
                    let edge = SAME * high;
                    let own = |z: c64| {
                        let real = is_real(z);
                        let below = first || z.im >= a - edge;
                        in_band(z, band) && if real { first } else { below && (last || z.im <= b + edge) }
                    };
                    let known: Vec<c64> = pieces.iter().flat_map(|p| p.values.iter().copied()).collect();
                    let twice = |z: c64| {
                        z.im <= a + edge && known.iter().any(|k| (k - z).norm() <= SAME * z.norm().max(high))
                    };
                    pieces.push(piece.keep(|z| own(z) && !twice(z)));
                    self.depth = self.depth.min(half);
                    observer.advance(1);
                }
            }
        }
        Ok(pieces)
    }

    /// Real eigenvalues beyond the circles of `known`: those nearest to shifts along the positive real axis, up to where the growth of
    /// the symmetric part ends.
    fn diverging(&mut self, known: &[SpectrumPart]) -> Result<Vec<SpectrumPart>> {
        let matrices = Definiteness { operator: self.operator, factor: None };
        let (band, top) = (self.band, self.band[1]);
        let mut seen: Vec<c64> = known.iter().flat_map(|p| p.values.iter().copied()).collect();
        let mut found = Vec::new();
        if matrices.no_divergence()? {
            return Ok(found);
        }
        let reach = matrices.fastest(top)?.unwrap_or(FARTHEST * top);
        let (mut shift, mut along) = (0.25 * top, 1.0);
        while shift < 4.0 * reach {
            // A shift on an eigenvalue has no factor: it is moved.
            let shifted = [1.0, 1.0037]
                .map(|nudge| c64::new(nudge * shift, 0.0))
                .into_iter()
                .find_map(|s| Shifted::with_pattern(self.operator, s, self.symbolic.as_ref()).ok());
            if let Some(shifted) = shifted {
                let shifted = shifted.two_sided();
                self.symbolic = self.symbolic.take().or_else(|| shifted.symbolic());
                self.shifts += 1;
                let count = DIVERGING.min(2 * self.operator.n());
                let piece = match self.at(&shifted, 0.0, shift, (count, along * shift)) {
                    Ok(piece) => piece,
                    Err(error) => {
                        self.unsure = Some(format!("Real eigenvalues are not all known: {error}"));
                        break;
                    }
                };
                let piece = piece.keep(|z| {
                    diverges(z, band) && seen.iter().all(|k| (k - z).norm() > SAME * z.norm().max(top))
                });
                seen.extend(&piece.values);
                found.push(piece);
            }
            (shift, along) = (2.0 * shift, ALONG);
        }
        Ok(found)
    }

    /// All eigenvalues within √2 `half` of i `middle`; none where these are too many for one shift.
    fn circle(&mut self, middle: f64, half: f64, expected: usize) -> Result<Option<SpectrumPart>> {
        let shifted = self.shifted(middle)?;
        let off = 1e-3 * middle.max(1e-3 * self.band[1]);
        let reach = 2f64.sqrt() * half * (1.0 + 1e-6) + 4.0 * off;
        let n = 2 * self.operator.n();
        let mut count = (3 * expected / 2 + 6).min(n);
        loop {
            let piece = match self.at(&shifted, middle, half, (count, reach)) {
                // Smaller circles hold fewer.
                Err(_) if half > LEAST * self.band[1] => return Ok(None),
                piece => piece?,
            };
            if piece.within >= reach || count >= n {
                return Ok(Some(piece));
            }
            if count > 2 * MOST && half > 1e-6 * self.band[1] {
                return Ok(None);
            }
            count = (2 * count).min(n);
        }
    }

    /// The `count` eigenvalues nearest the shift, or those of them within `reach` of it, from both sides.
    fn at(
        &mut self,
        shifted: &Shifted<'_>,
        middle: f64,
        radius: f64,
        (count, reach): (usize, f64),
    ) -> Result<SpectrumPart> {
        let radius = radius.max(1e-3 * middle);
        let right = toar(shifted, shifted.shift(), radius, (count, reach), TOLERANCE)?;
        self.solves += right.solves;
        self.seen.extend(&right.values);
        // Partners are sought of those of which none is missing.
        let own = right.values.iter().take_while(|z| (*z - shifted.shift()).norm() <= right.within).count();
        let right = ToarPairs {
            values: right.values[..own].to_vec(),
            vectors: right.vectors.subcols(0, own).to_owned(),
            ..right
        };
        let adjoint = Adjoint(shifted);
        let mut further = 0;
        loop {
            let left =
                toar(&adjoint, shifted.shift().conj(), radius, (count + further, RIM * reach), TOLERANCE)?;
            self.solves += left.solves;
            let left_values: Vec<c64> = left.values.iter().map(|z| z.conj()).collect();
            let partners = partners(&right.values, &left_values);
            // A pair at the rim of the circle may have its partner just beyond. One that has none keeps the nearest, and an error
            // that shows it.
            let enough = left.within >= RIM * reach || further > count;
            if enough && left_values.is_empty() && !right.values.is_empty() {
                let found = format!("no left eigenvector near {} Hz", hertz(middle / TAU, 2));
                return Err(Error::analysis("two-level Arnoldi", found, "Move the band a little"));
            }
            if enough || partners.iter().all(Option::is_some) {
                let nearest = |z: c64| {
                    let all = 0..left_values.len();
                    all.min_by(|a, b| (left_values[*a] - z).norm().total_cmp(&(left_values[*b] - z).norm()))
                };
                let chosen: Vec<usize> = (0..right.values.len())
                    .filter_map(|j| partners[j].or_else(|| nearest(right.values[j])))
                    .collect();
                return Ok(SpectrumPart {
                    left_values: chosen.iter().map(|k| left_values[*k]).collect(),
                    left: Mat::from_fn(self.operator.n(), chosen.len(), |i, k| left.vectors[(i, chosen[k])]),
                    within: right.within,
                    values: right.values,
                    right: right.vectors,
                });
            }
            further += 4 + count / 4;
        }
    }

    /// Modes with their errors, condition numbers and growth budgets.
    fn measured(&self, piece: SpectrumPart, real: &RealModes, left_vectors: bool) -> Vec<ComplexMode> {
        let piece = self.biorthogonal(piece);
        let operator = self.operator;
        let mut modes = Vec::new();
        let columns: Vec<usize> = (0..piece.values.len()).collect();
        for chunk in columns.chunks(TOGETHER) {
            let block = |x: &Mat<c64>| Block::from_fn(operator.n(), chunk.len(), |i, k| x[(i, chunk[k])]);
            let (right, left) = (block(&piece.right), block(&piece.left));
            let found: Vec<c64> = chunk.iter().map(|j| piece.values[*j]).collect();
            let steepness = operator.steepness(&found, &left, &right);
            let rise = operator.value(Side::Right, &found, &right);
            let lambda: Vec<c64> = (0..chunk.len())
                .map(|k| {
                    let change = left.dot(k, &rise) / steepness[k];
                    let small = change.norm() <= CLUSTER * found[k].norm();
                    if small { found[k] - change } else { found[k] }
                })
                .collect();
            let mut residual = Block::zeros(operator.n(), chunk.len());
            let forms = operator.add_value(&lambda, &right, &mut residual, &[&right]).remove(0);
            let skew = operator.skew_forms(&right);
            let inertia = left.map(|x| times(operator.mass, x));
            let amplitudes = right.map(|x| gram(real.shapes.as_ref(), times(operator.mass, x).as_ref()));
            for k in 0..chunk.len() {
                let (z, mass) = (lambda[k], forms[k].mass.re);
                let left_mass = left.dot(k, &inertia).re.sqrt();
                let factor = mass.sqrt().recip();
                let apart = |other: c64| (other - z).norm();
                let spread = apart(found[k]).max(apart(piece.left_values[chunk[k]]));
                let condition = 2.0 * z.norm() * left_mass * mass.sqrt() / steepness[k].norm();
                let [of_left, of_right] = [&left, &right].map(|x| operator.interface.extents(x.vector(k)));
                let work = operator.interface.gross_work(z, &of_left, &of_right) / steepness[k].norm();
                let size = z.norm().max(1e-6 * self.band[1]);
                let error = spread / size + ROUNDING * condition + CONTACT_ROUNDING * work / size;
                let motion = operator.interface.motions(right.vector(k));
                let motion: Vec<c64> = motion.into_iter().map(|m| m * factor).collect();
                let own = Block::from_fn(real.len(), 1, |i, _| amplitudes.get(i, k) * factor);
                modes.push(ComplexMode {
                    eigenvalue: z,
                    right: right.scaled_column(k, factor),
                    left: if left_vectors { left.scaled_column(k, left_mass.recip()) } else { Vec::new() },
                    backward_error: residual.norm(k)
                        / (operator.size(z) * right.norm(k)).max(f64::MIN_POSITIVE),
                    eigenvalue_error: error,
                    uncertainty: error * size,
                    condition,
                    growth: growth_budget(
                        operator,
                        z,
                        &forms[k].scaled(factor * factor),
                        &motion,
                        skew[k].map(|s| s * factor * factor),
                    ),
                    participation: shares(&own, 0),
                });
            }
        }
        modes
    }

    /// Left vectors of eigenvalues that all but coincide are mixed until ψᵢᴴQ′φⱼ = 0 for i ≠ j: Krylov spaces give any vectors
    /// of the common space.
    fn biorthogonal(&self, mut piece: SpectrumPart) -> SpectrumPart {
        let m = piece.values.len();
        let mut grouped = vec![false; m];
        for j in 0..m {
            let near =
                |k: &usize| (piece.values[*k] - piece.values[j]).norm() <= CLUSTER * piece.values[j].norm();
            let group: Vec<usize> = (j..m).filter(|k| !grouped[*k] && near(k)).collect();
            group.iter().for_each(|k| grouped[*k] = true);
            if group.len() < 2 {
                continue;
            }
            let n = self.operator.n();
            let right = Block::from_fn(n, group.len(), |i, k| piece.right[(i, group[k])]);
            let lambda: Vec<c64> = group.iter().map(|k| piece.values[*k]).collect();
            let slope = self.operator.slope(Side::Right, &lambda, &right);
            let left = Mat::from_fn(n, group.len(), |i, k| piece.left[(i, group[k])]);
            let slopes = Mat::from_fn(n, group.len(), |i, k| slope.get(i, k));
            let lu = Lu::new(left.adjoint() * &slopes);
            if lu.phase().is_none() {
                continue;
            }
            // Ψ B⁻ᴴ, B = ΨᴴQ′Φ.
            let mixed = lu.solve(left.adjoint().to_owned());
            for (k, column) in group.iter().enumerate() {
                let norm = (0..n).map(|i| mixed[(k, i)].norm_sqr()).sum::<f64>().sqrt();
                (0..n).for_each(|i| piece.left[(i, *column)] = mixed[(k, i)].conj() / norm);
            }
        }
        piece
    }
}

impl SpectrumPart {
    /// Those whose eigenvalue is wanted.
    fn keep(self, wanted: impl Fn(c64) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.values.len()).filter(|j| wanted(self.values[*j])).collect();
        let some = |x: &Mat<c64>| Mat::from_fn(x.nrows(), kept.len(), |i, k| x[(i, kept[k])]);
        SpectrumPart {
            values: kept.iter().map(|j| self.values[*j]).collect(),
            left_values: kept.iter().map(|j| self.left_values[*j]).collect(),
            right: some(&self.right),
            left: some(&self.left),
            within: self.within,
        }
    }
}

/// For each eigenvalue of the right side the nearest one of the left side that no other has, where it is the same.
fn partners(right: &[c64], left: &[c64]) -> Vec<Option<usize>> {
    let mut taken = vec![false; left.len()];
    let partner = |z: &c64| {
        let free = (0..left.len()).filter(|k| !taken[*k]);
        let nearest = free.min_by(|a, b| (left[*a] - z).norm().total_cmp(&(left[*b] - z).norm()));
        let found = nearest.filter(|k| (left[*k] - z).norm() <= 1e-5 * z.norm().max(f64::MIN_POSITIVE))?;
        taken[found] = true;
        Some(found)
    };
    right.iter().map(partner).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::tests::{damped, dense_modes, dense_spectrum, nearest, steady};
    use super::super::{certified_modes, complex_modes};
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::equilibrium::samples::{random_system, skew_parts};
    use crate::system::System;

    /// A random body with skew parts of full rank, gyroscopic (`spin`) and circulatory (`friction`), and damping of a kind; with
    /// contacts, where these are all that is not symmetric in K.
    pub(crate) fn rotating(n: usize, seed: u64, spin: f64, friction: f64) -> System {
        let mut system = damped(random_system(n, 2, 20.0, seed), seed % 8);
        if friction > 0.0 {
            system.pairs.clear();
            system.load = vec![0.0; n];
        }
        system.coupling = Some(skew_parts(n, seed, spin, friction));
        system
    }

    #[test]
    fn random_rotating_systems_have_the_eigenvalues_of_a_dense_solver() {
        let (mut all, mut unstable, mut counted) = (0, 0, 0);
        for (seed, n) in (0..16).map(|seed| (seed, [6, 12, 40, 70][seed as usize % 4])) {
            let friction = if seed % 3 == 0 { 0.0 } else { 300.0 };
            let system = rotating(n, seed, 4.0, friction);
            let state = steady(&system);
            let real = dense_modes(&system, n);
            let top = real.frequency_hz(2 * n / 3) * 1.02;
            let band = [if seed % 2 == 0 { 0.0 } else { 0.3 * top }, top];
            let (modes, certificate) =
                certified_modes(&system, &state, &real, band, f64::INFINITY, &()).unwrap();
            let certificate = certificate.unwrap_or_else(|| panic!("{seed}: {:?}", modes.warnings));
            let spectrum = dense_spectrum(&system, &state);
            let exact: Vec<c64> =
                spectrum.iter().copied().filter(|z| in_band(*z, band.map(|f| TAU * f))).collect();
            assert_eq!(modes.modes.len(), exact.len(), "seed {seed}");
            for mode in &modes.modes {
                let z = mode.eigenvalue;
                let error = (nearest(z, &exact) - z).norm() / z.norm();
                // Ten times what the refinement aims at.
                assert!(
                    within(error, 1e-9, Tolerance) && mode.accepted(),
                    "seed {seed}: {z} {error:e} {mode:?}"
                );
                assert!(
                    within((mode.growth.total() - z.re).abs(), 1e-8 * z.norm(), RoundOff) || z.im == 0.0,
                    "seed {seed}"
                );
                unstable += usize::from(mode.unstable());
            }
            let inside = |z: &&c64| {
                let [low, high] = certificate.band_hz.map(|f| TAU * f);
                let bottom = if low == 0.0 { -high } else { low };
                z.re > certificate.growth[0] && z.re < certificate.growth[1] && z.im > bottom && z.im < high
            };
            assert_eq!(certificate.counted, spectrum.iter().filter(inside).count() as i64, "seed {seed}");
            assert!(certificate.holds() && !certificate.proven);
            counted += certificate.counted;
            all += exact.len();
        }
        println!("{all} {unstable} {counted}");
        assert!(all > 200 && unstable > 40 && counted > 40);
    }

    #[test]
    fn the_nearest_modes_and_the_left_vectors_are_right() {
        let system = rotating(40, 5, 6.0, 200.0);
        let (state, real) = (steady(&system), dense_modes(&system, 40));
        let target = real.frequency_hz(15);
        let band = Band { hz: [0.0, 1e4], nearest: Some((target, 6)), left_vectors: true };
        let modes = complex_modes(&system, &state, &real, band, &()).unwrap().modes;
        let mut exact = dense_spectrum(&system, &state);
        let distance = |z: &c64| (z - c64::new(0.0, TAU * target)).norm();
        exact.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        assert_eq!(modes.len(), 6);
        let operator = Operator::new(&system, &state).unwrap();
        for mode in &modes {
            let z = mode.eigenvalue;
            assert!(within((nearest(z, &exact[..6]) - z).norm(), 1e-10 * z.norm(), Tolerance));
            let left = Block::from_columns(40, &[&mode.left]);
            let residual = operator.value(Side::Left, &[z], &left);
            assert!(within(residual.norm(0), 1e-9 * operator.size(z) * left.norm(0), Tolerance));
        }
    }

    #[test]
    fn a_count_shows_a_mode_that_was_not_seen() {
        // The first sample with a mode inside the region that is counted, which begins above zero for loss factors and leaves out
        // what grows faster than a tenth of the band.
        let flutters = |m: &ComplexMode| {
            m.growth_rate() > 1e-2 * m.eigenvalue.norm() && m.growth_rate() < 0.09 * m.eigenvalue.im
        };
        let sample = |seed: u64| {
            let system = rotating(40, seed, 3.0, 400.0);
            let (state, real) = (steady(&system), dense_modes(&system, 40));
            let band = [0.0, real.frequency_hz(30)];
            let operator = Operator::new(&system, &state).unwrap();
            let found = general_modes(&operator, &real, band.into(), &()).unwrap().modes.modes;
            found.iter().any(flutters).then_some((system, state, real, band))
        };
        let (system, state, real, band) = (7..57).find_map(sample).expect("a sample with flutter");
        let operator = Operator::new(&system, &state).unwrap();
        let mut general = general_modes(&operator, &real, band.into(), &()).unwrap();
        let place = general.modes.modes.iter().position(flutters);
        let lost = general.modes.modes.remove(place.unwrap()).eigenvalue;
        general.seen.retain(|z| {
            (z - lost).norm() > 1e-6 * lost.norm() && (z - lost.conj()).norm() > 1e-6 * lost.norm()
        });
        let certificate =
            super::super::certificate::count_determinant(&operator, &general, band, None).unwrap();
        // With its conjugate, unless loss factors keep the region off zero.
        let missing = if certificate.band_hz[0] == 0.0 { 2 } else { 1 };
        assert_eq!(certificate.counted, certificate.found + missing, "{certificate:?}");
    }
}
