//! The modes as they are given: right vectors sharpened by the last corrections, and what is told of them.

use super::ComplexMode;
use super::GrowthBudget;
use super::block::Block;
use super::budget::growth_budgets;
use super::operator::{Images, Operator, Side};
use super::round::Measured;
use crate::linalg::c64;

/// What is told of right vectors.
struct Told {
    backward_error: Vec<f64>,
    growth: Vec<GrowthBudget>,
}

/// The modes of pairs that were measured. The error of φ is about the correction z = −A⁻¹Q(λ)φ, which was solved for to tell
/// that of λ: φ + z is given where its residual is the smaller one, which leaves a few hundredths of that error. Its contact
/// motion and its share of the modes are settled by the projection; z meets only the rest of the spectrum, as far as the
/// basis goes: so `amplitudes`, what the real modes have of φ, tells their part in φ + z as well.
pub(super) fn finished(
    operator: &Operator<'_>,
    measured: &mut Measured,
    amplitudes: &Block,
) -> Vec<ComplexMode> {
    let Measured { lambda, right, left, correction, backward_error, eigenvalue_error, condition } = measured;
    let mut lefts: Vec<Vec<c64>> = (0..lambda.len()).map(|j| left.column(j)).collect();
    // Their block is memory for residuals from here on.
    correction.add(right);
    let corrected = Told::of(operator, lambda, correction, left);
    let better = |j: &usize| corrected.backward_error[*j] < backward_error[*j];
    let plain: Vec<usize> = (0..lambda.len()).filter(|j| !better(j)).collect();
    let their: Vec<c64> = plain.iter().map(|j| lambda[*j]).collect();
    let mut as_found = right.gathered(&plain);
    let uncorrected = Told::of(operator, &their, &mut as_found, left);
    let mode = |j: usize| {
        let (told, images, k) = match plain.binary_search(&j) {
            Ok(k) => (&uncorrected, &as_found, k),
            Err(_) => (&corrected, &*correction, j),
        };
        ComplexMode {
            eigenvalue: lambda[j],
            right: images.vectors.column(k),
            left: std::mem::take(&mut lefts[j]),
            backward_error: told.backward_error[k],
            eigenvalue_error: eigenvalue_error[j],
            condition: condition[j],
            growth: told.growth[k],
            participation: shares(amplitudes, j),
        }
    };
    (0..lambda.len()).map(mode).collect()
}

impl Told {
    /// Of vectors that are scaled to unit mass first.
    fn of(operator: &Operator<'_>, lambda: &[c64], images: &mut Images, residual: &mut Block) -> Self {
        images.normalise();
        let growth = growth_budgets(operator, lambda, images);
        operator.value_into(Side::Right, lambda, images, residual);
        let error = |j: usize| residual.norm(j) / (operator.size(lambda[j]) * images.vectors.norm(j));
        Told { backward_error: (0..lambda.len()).map(error).collect(), growth }
    }
}

/// |φₖᵀMφ|² of every real mode that has at least one part in ten thousand, largest first.
fn shares(amplitudes: &Block, j: usize) -> Vec<(usize, f64)> {
    let mut shares: Vec<(usize, f64)> = (0..amplitudes.nrows())
        .map(|k| (k, amplitudes.get(k, j).norm_sqr()))
        .filter(|(_, share)| *share >= 1e-4)
        .collect();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    shares
}
