//! The analysis: project, solve, measure on the full order, enrich, repeat.

use super::basis::{Basis, Images};
use super::block::Block;
use super::budget::growth_budget;
use super::operator::{Operator, Side};
use super::projected::{SmallPair, project_interface, solve};
use super::{ComplexMode, ComplexModes};
use crate::equilibrium::SteadySliding;
use crate::error::{Error, Fault, Result};
use crate::linalg::SymmetricFactor;
use crate::linalg::c64;
use crate::linalg::factor::factorize;
use crate::linalg::sparse::add_scaled;
use crate::linalg::tall::gram;
use crate::modal::RealModes;
use crate::progress::Observer;
use crate::system::System;
use faer::Mat;
use std::f64::consts::TAU;

/// Rounds of enrichment at most.
const ROUNDS: usize = 6;
/// The most static contact responses that enter the first basis; the residuals ask for the others where they matter.
const STATIC_RESPONSES: usize = 240;
/// Aims of the refinement, below what [`ComplexMode::accepted`] asks.
const BACKWARD_ERROR: f64 = 5e-11;
const EIGENVALUE_ERROR: f64 = 1e-10;
/// A condition number of λ above this is told.
const ILL_CONDITIONED: f64 = 1e6;

/// All complex modes with a frequency in `band_hz` = \[lowest, highest\], of `system` sliding steadily.
///
/// * Basis: the real modes (of K + K_σ and M, M-orthonormal, best up to twice the band) and A⁻¹W, A = K + K_σ − s M at
///   a shift s inside the band, for every direction in which the contact has a force.
/// * Every pair is measured on the full order. Its corrections z = −A⁻¹Q(λ)φ and, for the left vector, −A⁻¹Q(λ)ᴴψ show
///   no contact motion where A⁻¹W is in the basis: so the same real symmetric factor serves every pair, whatever the
///   friction. (Of more directions than real modes only those that matter enter at once.) They enrich the basis until η and the eigenvalue error are small, in six rounds at most.
/// * ψᴴQ(λ)φ vanishes identically after a projection, so the error of λ is estimated with the *correction* of the left
///   vector: |z_ψᴴ Q(λ)φ| / |ψᴴ(2λM + C + C_c)φ|. As A is symmetric, z_ψᴴ Q(λ)φ = (Q(λ)ᴴψ)ᴴ z, so that only the right
///   corrections are solved for, and the left ones of the pairs that are not yet right.
///
/// Modes with ω = 0 (overdamped, or divergence when σ > 0) are given when the band begins at zero. For them and near
/// λ = 0 the eigenvalue error is relative to 1e-6 of the band's top rather than to |λ|.
///
/// # Errors
/// A band that is none; real modes of another system; a projected problem that cannot be solved.
pub fn complex_modes(
    system: &System,
    steady: &SteadySliding,
    real: &RealModes,
    band_hz: [f64; 2],
    observer: &dyn Observer,
) -> Result<ComplexModes> {
    analyse(system, steady, real, band_hz, observer, |_, _| ()).map(|(modes, ())| modes)
}

/// What an analysis has at hand when its modes are found.
pub(super) struct Analysis<'a> {
    pub(super) operator: &'a Operator<'a>,
    pub(super) basis: &'a Basis<'a>,
    /// A = K + K_σ − shift · M.
    pub(super) factor: &'a dyn SymmetricFactor,
    pub(super) shift: f64,
    /// How many of the first vectors of the basis are real modes.
    pub(super) n_real: usize,
    /// Ω_b²: every real mode below it is in the basis, as the Sturm count proves; zero when it does not.
    pub(super) complete_below: f64,
    pub(super) band_hz: [f64; 2],
}

/// [`complex_modes`], and what `then` makes of them and the analysis.
pub(super) fn analyse<T>(
    system: &System,
    steady: &SteadySliding,
    real: &RealModes,
    band_hz: [f64; 2],
    observer: &dyn Observer,
    then: impl FnOnce(&mut ComplexModes, Analysis<'_>) -> T,
) -> Result<(ComplexModes, T)> {
    check(system, steady, real, band_hz)?;
    let operator = Operator::new(system, steady)?;
    let band = band_hz.map(|f| TAU * f);
    observer.begin("complex eigenvalues", None);
    let solved = shifted_factor(&operator, real, band).and_then(|(factor, shift)| {
        let solved = solve_and_refine(&operator, &*factor, real, band_hz, observer)?;
        Ok((factor, shift, solved))
    });
    observer.end();
    let (factor, shift, (mut modes, basis)) = solved?;
    let analysis = Analysis {
        operator: &operator,
        basis: &basis,
        factor: &*factor,
        shift,
        n_real: real.len(),
        complete_below: complete_below(system, real),
        band_hz,
    };
    let rest = then(&mut modes, analysis);
    Ok((modes, rest))
}

/// Ω_b² below which no real mode is missing.
fn complete_below(system: &System, real: &RealModes) -> f64 {
    if real.len() == system.n_dofs() {
        f64::INFINITY
    } else if real.certificate.holds() {
        (TAU * real.certificate.below_hz).powi(2)
    } else {
        0.0
    }
}

fn check(system: &System, steady: &SteadySliding, real: &RealModes, band_hz: [f64; 2]) -> Result<()> {
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

/// The pairs of one round with their full-order measures.
pub(super) struct Round {
    pub(super) lambda: Vec<c64>,
    phi: Block,
    psi: Block,
    /// M φ.
    momentum: Block,
    /// z = −A⁻¹Q(λ)φ.
    correction: Block,
    /// Q(λ)ᴴψ.
    left_residual: Block,
    pub(super) backward_error: Vec<f64>,
    pub(super) eigenvalue_error: Vec<f64>,
    condition: Vec<f64>,
}

impl Round {
    /// The pairs that are not yet as exact as the refinement aims at.
    pub(super) fn open(&self) -> Vec<usize> {
        let right = |j: &usize| {
            self.backward_error[*j] <= BACKWARD_ERROR && self.eigenvalue_error[*j] <= EIGENVALUE_ERROR
        };
        (0..self.lambda.len()).filter(|j| !right(j)).collect()
    }
}

/// The modes, and the basis they were found in.
fn solve_and_refine<'a>(
    operator: &'a Operator<'a>,
    factor: &dyn SymmetricFactor,
    real: &RealModes,
    band_hz: [f64; 2],
    observer: &dyn Observer,
) -> Result<(ComplexModes, Basis<'a>)> {
    let band = band_hz.map(|f| TAU * f);
    let mut basis = Basis::new(operator, real.shapes.as_ref(), band[1] * band[1]);
    let responses = interface_responses(operator, factor, band[1]);
    // Few directions: all of them, and the corrections show no contact motion. Many: those that matter, and the
    // corrections bring what is needed of the others.
    let tolerance = if responses.ncols() <= real.len() { 1e-9 } else { 1e-2 };
    basis.enrich(responses, tolerance, STATIC_RESPONSES);
    let mut warnings = Vec::new();
    let mut counts = Vec::new();
    let mut round = evaluate(operator, &basis, factor, band)?;
    observer.advance(1);
    let mut refinements = 0;
    loop {
        counts.push(round.lambda.len());
        let open = round.open();
        if open.is_empty() || refinements == ROUNDS {
            break;
        }
        // The error of λ is quadratic in that of the vectors: coarse first, so that the basis stays small.
        let tolerance = 1e-6 * 0.01f64.powi(refinements as i32);
        if basis.enrich(wanted_corrections(&round, factor, &open, 1e-3 * band[1]), tolerance, usize::MAX) == 0
        {
            break;
        }
        refinements += 1;
        round = evaluate(operator, &basis, factor, band)?;
        observer.advance(1);
    }
    if let Some(first) = counts.first().filter(|first| counts.iter().any(|c| c != *first)) {
        let last = counts.last().unwrap_or(first);
        warnings.push(format!(
            "the refinement changed the number of complex modes in the band from {first} to {last}"
        ));
    }
    let participations = participations(&round, real).into_iter().enumerate();
    let modes: Vec<ComplexMode> =
        participations.map(|(j, shares)| mode(operator, &round, shares, j)).collect();
    for mode in modes.iter().filter(|mode| mode.accepted() && mode.condition > ILL_CONDITIONED) {
        warnings.push(format!(
            "the mode at {:.2} Hz is ill-conditioned: a relative change of the matrices moves it by {:.0e} times as much",
            mode.frequency_hz(),
            mode.condition
        ));
    }
    for mode in modes.iter().filter(|mode| !mode.accepted()) {
        let cause = if mode.condition > 1e4 { ", near the coalescence of two modes" } else { "" };
        warnings.push(format!(
            "the mode at {:.2} Hz is not accurate: relative eigenvalue error {:.1e}, backward error {:.1e}{cause}",
            mode.frequency_hz(),
            mode.eigenvalue_error,
            mode.backward_error
        ));
    }
    if real.len() < operator.n() {
        let highest = real.len().checked_sub(1).map_or(0.0, |last| real.frequency_hz(last));
        if highest < band_hz[1] {
            warnings.push(format!(
                "the real modes end at {highest:.1} Hz, below the band's top of {:.1} Hz: complex modes may be missing",
                band_hz[1]
            ));
        }
    }
    let modes = ComplexModes { modes, subspace_dimension: basis.len(), refinements, warnings };
    Ok((modes, basis))
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
        factorize(&add_scaled(&[(1.0, &*operator.stiffness), (-s, operator.mass)])).map(|factor| (factor, s))
    };
    at(shift).or_else(|_| at(-middle))
}

/// A⁻¹W for the directions in which the interface moves or is moved, each weighed by √(its stiffness) so that its
/// E-norm tells how much the interface makes of it.
pub(super) fn interface_responses(
    operator: &Operator<'_>,
    factor: &dyn SymmetricFactor,
    omega: f64,
) -> Mat<f64> {
    let interface = &operator.interface;
    let largest = interface.sizes(omega);
    let columns: Vec<_> = interface
        .directions
        .iter()
        .zip(&largest)
        .filter(|(d, size)| **size > 0.0 && !d.indices().is_empty())
        .collect();
    let mut responses = Mat::<f64>::zeros(operator.n(), columns.len());
    for (j, (direction, size)) in columns.iter().enumerate() {
        direction.add_to(size.sqrt() / omega, responses.col_as_slice_mut(j));
    }
    factor.solve_in_place(responses.as_mut());
    responses
}

fn evaluate(
    operator: &Operator<'_>,
    basis: &Basis<'_>,
    factor: &dyn SymmetricFactor,
    band: [f64; 2],
) -> Result<Round> {
    let (unsymmetric_damping, unsymmetric_stiffness) = project_interface(operator, basis);
    let pairs = solve(
        &basis.mass,
        &(&basis.damping + unsymmetric_damping),
        &(&basis.stiffness + unsymmetric_stiffness),
        basis.hysteretic.as_ref(),
        |z| in_band(z, band),
    )?;
    let lambda: Vec<c64> = pairs.iter().map(|p| p.lambda).collect();
    let expand = |pick: fn(&SmallPair) -> Vec<c64>| {
        let small: Vec<Vec<c64>> = pairs.iter().map(pick).collect();
        basis.images(&Block::from_columns(basis.len(), &small)).normalise()
    };
    let (phi, psi) = (expand(|p| p.right.clone()), expand(|p| p.left.clone()));
    Ok(measure(operator, factor, band, lambda, phi, psi))
}

/// Whether λ is one to give: one of each conjugate pair, its frequency in the band.
pub(super) fn in_band(z: c64, band: [f64; 2]) -> bool {
    let oscillates = z.im > 1e-9 * z.norm();
    let real = z.im.abs() <= 1e-9 * z.norm();
    (oscillates && z.im >= band[0] && z.im <= band[1]) || (real && band[0] == 0.0 && z.norm() <= band[1])
}

/// Measures pairs on the full order; `phi` and `psi` are scaled to unit mass.
pub(super) fn measure(
    operator: &Operator<'_>,
    factor: &dyn SymmetricFactor,
    band: [f64; 2],
    lambda: Vec<c64>,
    phi: Images,
    psi: Images,
) -> Round {
    let (residual, slope) = operator.apply(Side::Right, &lambda, &phi);
    let (left_residual, _) = operator.apply(Side::Left, &lambda, &psi);
    let (momentum, phi, psi) = (phi.inertia, phi.vectors, psi.vectors);
    let correct = |r: &Block| {
        r.map(|v| {
            let mut z = -v;
            factor.solve_in_place(z.as_mut());
            z
        })
    };
    let correction = correct(&residual);
    let floor = 1e-6 * band[1];
    let of = |f: &dyn Fn(usize) -> f64| (0..lambda.len()).map(f).collect::<Vec<f64>>();
    let backward_error = of(&|j| residual.norm(j) / (operator.size(lambda[j]) * phi.norm(j)));
    let steepness: Vec<f64> = of(&|j| psi.dot(j, &slope).norm());
    let eigenvalue_error =
        of(&|j| left_residual.dot(j, &correction).norm() / (steepness[j] * lambda[j].norm().max(floor)));
    let condition = of(&|j| 2.0 * lambda[j].norm() / steepness[j]);
    Round {
        lambda,
        phi,
        psi,
        momentum,
        correction,
        left_residual,
        backward_error,
        eigenvalue_error,
        condition,
    }
}

/// Re and Im of the corrections of the `open` pairs, right and left, each divided by |λ|: their squared E-norm is then
/// about the relative error of λ that they stand for.
pub(super) fn wanted_corrections(
    round: &Round,
    factor: &dyn SymmetricFactor,
    open: &[usize],
    floor: f64,
) -> Mat<f64> {
    let n = round.phi.re.nrows();
    let size: Vec<f64> = open.iter().map(|j| 1.0 / round.lambda[*j].norm().max(floor)).collect();
    let mut left = Mat::from_fn(n, 2 * open.len(), |i, c| {
        let part = if c % 2 == 0 { &round.left_residual.re } else { &round.left_residual.im };
        -part[(i, open[c / 2])] * size[c / 2]
    });
    factor.solve_in_place(left.as_mut());
    Mat::from_fn(n, 4 * open.len(), |i, c| {
        let (k, part) = (c / 4, c % 4);
        match part {
            0 => round.correction.re[(i, open[k])] * size[k],
            1 => round.correction.im[(i, open[k])] * size[k],
            _ => left[(i, 2 * k + part - 2)],
        }
    })
}

fn mode(operator: &Operator<'_>, round: &Round, participation: Vec<(usize, f64)>, j: usize) -> ComplexMode {
    let lambda = round.lambda[j];
    ComplexMode {
        eigenvalue: lambda,
        right: round.phi.column(j),
        left: round.psi.column(j),
        backward_error: round.backward_error[j],
        eigenvalue_error: round.eigenvalue_error[j],
        condition: round.condition[j],
        growth: growth_budget(operator, lambda, &round.phi, j),
        participation,
    }
}

/// |φₖᵀMφ|² of every real mode that has at least one part in ten thousand, largest first; one list a complex mode.
fn participations(round: &Round, real: &RealModes) -> Vec<Vec<(usize, f64)>> {
    let amplitudes = round.momentum.map(|part| gram(real.shapes.as_ref(), part.as_ref()));
    let of = |j: usize| {
        let mut shares: Vec<(usize, f64)> = (0..real.len())
            .map(|k| (k, amplitudes.re[(k, j)].powi(2) + amplitudes.im[(k, j)].powi(2)))
            .filter(|(_, share)| *share >= 1e-4)
            .collect();
        shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        shares
    };
    (0..round.lambda.len()).map(of).collect()
}
