//! The modes as they are given: right vectors sharpened by the last corrections, and their errors.

use super::ComplexMode;
use super::budget::growth_budget;
use super::refinement::MeasuredPairs;
use crate::dynamics::{Block, Operator};
use crate::linalg::c64;
use rayon::prelude::*;

/// The modes of measured pairs, of those to be `given`. The error of φ is about the correction z = −A⁻¹Q(λ)φ, which was solved
/// for to give that of λ: φ + z is given where its residual is the smaller one, which leaves a few hundredths of that error. Its
/// contact motion and its share of the modes are settled by the projection; z meets only the rest of the spectrum, as far as the
/// basis goes: so `amplitudes`, what the real modes have of φ, gives their part in φ + z as well. Left vectors are given where
/// they are requested. The band ends at `top` \[rad/s\].
pub(super) fn post_processed(
    operator: &Operator<'_>,
    measured: &mut MeasuredPairs,
    given: &[bool],
    amplitudes: &Block,
    left: Option<&Block>,
    top: f64,
) -> Vec<Option<ComplexMode>> {
    let one = vec![c64::new(1.0, 0.0); measured.lambda.len()];
    measured.correction.add_scaled(&one, &measured.right);
    let measured = &*measured;
    let skew = [&measured.right, &measured.correction].map(|vectors| operator.skew_forms(vectors));
    let mode = |j: usize| {
        let corrected = measured.corrected[j] / measured.correction.norm(j);
        let found = measured.backward_error[j];
        let better = corrected < found;
        let vectors = if better { &measured.correction } else { &measured.right };
        let forms = measured.forms[j][usize::from(better)];
        let to_unit_mass = 1.0 / forms.mass.re.sqrt();
        let motion = operator.interface.motions(vectors.vector(j));
        let motion: Vec<c64> = motion.into_iter().map(|m| m * to_unit_mass).collect();
        // Of an eigenvalue that is zero but for rounding no digit is known.
        let (lambda, uncertainty) = (measured.lambda[j], measured.uncertainty(j, top));
        let is_zero = measured.zero[j].is_some() && lambda.norm() <= uncertainty;
        let eigenvalue = match lambda.im.abs() <= f64::EPSILON * lambda.norm() {
            _ if is_zero => c64::new(0.0, 0.0),
            // Real but for rounding.
            true => c64::new(lambda.re, 0.0),
            false => lambda,
        };
        ComplexMode {
            eigenvalue,
            right: vectors.scaled_column(j, to_unit_mass),
            left: left.map_or_else(Vec::new, |left| left.column(j)),
            backward_error: if better { corrected } else { found },
            eigenvalue_error: measured.error(j),
            uncertainty,
            condition: measured.condition[j],
            growth: growth_budget(
                operator,
                eigenvalue,
                &forms.scaled(to_unit_mass.powi(2)),
                &motion,
                skew[usize::from(better)][j].map(|form| form * to_unit_mass.powi(2)),
            ),
            participation: shares(amplitudes, j),
        }
    };
    given.par_iter().enumerate().map(|(j, given)| given.then(|| mode(j))).collect()
}

/// |φₖᵀMφ|² of every real mode that has at least one part in ten thousand, largest first.
pub(super) fn shares(amplitudes: &Block, j: usize) -> Vec<(usize, f64)> {
    let mut shares: Vec<(usize, f64)> = (0..amplitudes.nrows())
        .map(|k| (k, amplitudes.get(k, j).norm_sqr()))
        .filter(|(_, share)| *share >= 1e-4)
        .collect();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    shares
}
