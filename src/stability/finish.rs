//! The modes as they are given: right vectors sharpened by the last corrections, and what is told of them.

use super::ComplexMode;
use super::GrowthBudget;
use super::block::Block;
use super::budget::growth_budgets;
use super::operator::{Operator, Side};
use super::round::Measured;
use crate::linalg::c64;
use crate::linalg::tall::gram;
use crate::modal::RealModes;

/// Right vectors with unit mass, and what is told of them.
struct Told {
    vectors: Block,
    backward_error: Vec<f64>,
    growth: Vec<GrowthBudget>,
    participation: Vec<Vec<(usize, f64)>>,
}

/// The modes of pairs that were measured. The error of φ is about the correction z = −A⁻¹Q(λ)φ, which was solved for to tell
/// that of λ: φ + z is given where its residual is the smaller one, which leaves a few hundredths of that error. Its contact
/// motion and its share of the modes are settled by the projection; z meets only the rest of the spectrum, as far as the
/// basis goes.
pub(super) fn finished(operator: &Operator<'_>, measured: Measured, real: &RealModes) -> Vec<ComplexMode> {
    let Measured { pairs, mut correction, backward_error, eigenvalue_error, condition, .. } = measured;
    let all: Vec<usize> = (0..pairs.lambda.len()).collect();
    all.iter().for_each(|j| correction.add_column(*j, &pairs.right, *j));
    let corrected = Told::of(operator, &pairs.lambda, correction, real);
    let better = |j: &usize| corrected.backward_error[*j] < backward_error[*j];
    let plain: Vec<usize> = all.iter().copied().filter(|j| !better(j)).collect();
    let lambda: Vec<c64> = plain.iter().map(|j| pairs.lambda[*j]).collect();
    let uncorrected = Told::of(operator, &lambda, Block::gathered(&pairs.right, &plain), real);
    let mode = |j: usize| {
        let (told, k) = match plain.binary_search(&j) {
            Ok(k) => (&uncorrected, k),
            Err(_) => (&corrected, j),
        };
        ComplexMode {
            eigenvalue: pairs.lambda[j],
            right: told.vectors.column(k),
            left: pairs.left.column(j),
            backward_error: told.backward_error[k],
            eigenvalue_error: eigenvalue_error[j],
            condition: condition[j],
            growth: told.growth[k],
            participation: told.participation[k].clone(),
        }
    };
    all.into_iter().map(mode).collect()
}

impl Told {
    /// Of vectors that are yet to be scaled to unit mass.
    fn of(operator: &Operator<'_>, lambda: &[c64], vectors: Block, real: &RealModes) -> Self {
        let images = operator.images(vectors).normalise();
        let growth = growth_budgets(operator, lambda, &images);
        let amplitudes = images.inertia.map(|part| gram(real.shapes.as_ref(), part.as_ref()));
        let residual = operator.value(Side::Right, lambda, &images);
        let error = |j: usize| residual.norm(j) / (operator.size(lambda[j]) * images.vectors.norm(j));
        let columns = 0..lambda.len();
        Told {
            backward_error: columns.clone().map(error).collect(),
            growth,
            participation: columns.map(|j| shares(&amplitudes, j)).collect(),
            vectors: images.vectors,
        }
    }
}

/// |φₖᵀMφ|² of every real mode that has at least one part in ten thousand, largest first.
fn shares(amplitudes: &Block, j: usize) -> Vec<(usize, f64)> {
    let mut shares: Vec<(usize, f64)> = (0..amplitudes.re.nrows())
        .map(|k| (k, amplitudes.re[(k, j)].powi(2) + amplitudes.im[(k, j)].powi(2)))
        .filter(|(_, share)| *share >= 1e-4)
        .collect();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    shares
}
