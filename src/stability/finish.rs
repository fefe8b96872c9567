//! The modes as they are given: right vectors sharpened by the last corrections, and what is told of them.

use super::ComplexMode;
use super::GrowthBudget;
use super::block::Block;
use super::budget::growth_budgets;
use super::operator::{Operator, Side};
use super::round::Round;
use crate::linalg::c64;
use crate::linalg::tall::gram;
use crate::modal::RealModes;

/// Pairs that are worked on together.
const TOGETHER: usize = 16;

/// What is told of one right vector.
struct Told {
    backward_error: f64,
    growth: GrowthBudget,
    participation: Vec<(usize, f64)>,
}

/// The modes of a round. The error of φ is about the correction z = −A⁻¹Q(λ)φ, which was solved for to tell that of λ: φ + z
/// is given where its residual is the smaller one, which leaves a few hundredths of that error. Its contact motion and its
/// share of the modes are settled by the projection; z meets only the rest of the spectrum, as far as the basis goes.
pub(super) fn finished(operator: &Operator<'_>, mut round: Round, real: &RealModes) -> Vec<ComplexMode> {
    let (n, count) = (operator.n(), round.lambda.len());
    let all: Vec<usize> = (0..count).collect();
    let mut told: Vec<Option<Told>> = (0..count).map(|_| None).collect();
    let mut plain = Vec::new();
    for chunk in all.chunks(TOGETHER) {
        let lambda: Vec<c64> = chunk.iter().map(|j| round.lambda[*j]).collect();
        let (vectors, found) = told_of(operator, &lambda, round.corrected(chunk), real);
        for (k, (j, found)) in chunk.iter().zip(found).enumerate() {
            if found.backward_error < round.backward_error[*j] {
                round.phi.set_column(*j, &vectors, k);
                told[*j] = Some(found);
            } else {
                plain.push(*j);
            }
        }
    }
    for chunk in plain.chunks(TOGETHER) {
        let lambda: Vec<c64> = chunk.iter().map(|j| round.lambda[*j]).collect();
        let vectors = Block::gathered(chunk.iter().map(|j| (&round.phi, *j)));
        let (_, found) = told_of(operator, &lambda, vectors, real);
        chunk.iter().zip(found).for_each(|(j, found)| told[*j] = Some(found));
    }
    round.forget_corrections();
    let right: Vec<Vec<c64>> = all.iter().map(|j| round.phi.column(*j)).collect();
    round.phi = Block::zeros(n, 0);
    let left: Vec<Vec<c64>> = all.iter().map(|j| round.psi.column(*j)).collect();
    let vectors = right.into_iter().zip(left).zip(told).enumerate();
    vectors
        .map(|(j, ((right, left), told))| {
            let Told { backward_error, growth, participation } = told.expect("one for each pair");
            ComplexMode {
                eigenvalue: round.lambda[j],
                right,
                left,
                backward_error,
                eigenvalue_error: round.eigenvalue_error[j],
                condition: round.condition[j],
                growth,
                participation,
            }
        })
        .collect()
}

/// Vectors scaled to unit mass, and what is told of them.
fn told_of(operator: &Operator<'_>, lambda: &[c64], vectors: Block, real: &RealModes) -> (Block, Vec<Told>) {
    let images = operator.images(vectors).normalise();
    let growths = growth_budgets(operator, lambda, &images);
    let amplitudes = images.inertia.map(|part| gram(real.shapes.as_ref(), part.as_ref()));
    let residual = operator.value(Side::Right, lambda, &images);
    let told = growths.into_iter().enumerate().map(|(j, growth)| Told {
        backward_error: residual.norm(j) / (operator.size(lambda[j]) * images.vectors.norm(j)),
        growth,
        participation: shares(&amplitudes, j),
    });
    let told = told.collect();
    (images.vectors, told)
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
