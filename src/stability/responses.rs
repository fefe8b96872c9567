//! What interface and damping make of the structure: the first directions besides the real modes.

use super::basis::Basis;
use super::block::Block;
use super::operator::{Operator, Side};
use crate::linalg::SymmetricFactor;
use crate::linalg::c64;
use crate::linalg::random::Random;
use crate::linalg::sparse::multiply;
use crate::linalg::tall::gram;
use faer::Mat;

/// Random combinations that stand for many forces.
pub(super) const SKETCH: usize = 64;

/// A⁻¹W for the directions in which the interface moves or is moved, each weighed by √(its stiffness) so that its
/// E-norm tells how much the interface makes of it.
pub(super) fn interface_responses(
    operator: &Operator<'_>,
    factor: &dyn SymmetricFactor,
    omega: f64,
) -> Mat<f64> {
    let mut responses = interface_forces(operator, omega);
    factor.solve_in_place(responses.as_mut());
    responses
}

/// W of [`interface_responses`].
fn interface_forces(operator: &Operator<'_>, omega: f64) -> Mat<f64> {
    let interface = &operator.interface;
    let (largest, active) = (interface.sizes(omega), interface.active(omega));
    let mut forces = Mat::<f64>::zeros(operator.n(), active.len());
    for (j, d) in active.iter().enumerate() {
        interface.directions[*d].add_to(largest[*d].sqrt() / omega, forces.col_as_slice_mut(j));
    }
    forces
}

/// ω²ᵏ(A⁻¹M)ᵏA⁻¹F of `forces` F for k = 0, 1, … `terms` − 1: the series of the response in ω². F is taken without what moves
/// the real modes, which the basis has: so no digits are lost when they are projected out, and no power of A⁻¹M turns into
/// the mode nearest to the shift.
fn series(
    operator: &Operator<'_>,
    basis: &Basis<'_>,
    factor: &dyn SymmetricFactor,
    omega: f64,
    forces: Mat<f64>,
    terms: usize,
) -> Mat<f64> {
    let (n, r) = (forces.nrows(), forces.ncols());
    let share = gram(basis.vectors.as_ref(), forces.as_ref());
    let mut all = Mat::zeros(n, r * terms);
    multiply(operator.mass, basis.expand_real(&share).as_ref(), all.subcols_mut(0, r));
    for j in 0..r {
        let known = all.col_as_slice_mut(j).iter_mut();
        known.zip(forces.col_as_slice(j)).for_each(|(known, force)| *known = force - *known);
    }
    drop(forces);
    factor.solve_in_place(all.subcols_mut(0, r));
    for k in 1..terms {
        let (before, mut next) = all.subcols_mut((k - 1) * r, 2 * r).split_at_col_mut(r);
        multiply(operator.mass, before.as_ref(), next.as_mut());
        next *= faer::Scale(omega * omega);
        factor.solve_in_place(next);
    }
    all
}

/// Terms of the series of a few directions.
const TERMS_OF_FEW: usize = 6;

/// The responses to a few directions and, where they are far fewer than the real modes, further terms of their series, the
/// first `active` columns being [`interface_responses`] but for real modes. `basis` are the real modes.
pub(super) fn few_responses(
    operator: &Operator<'_>,
    basis: &Basis<'_>,
    factor: &dyn SymmetricFactor,
    omega: f64,
) -> Mat<f64> {
    let forces = interface_forces(operator, omega);
    let terms = if TERMS_OF_FEW * forces.ncols() <= basis.len() { TERMS_OF_FEW } else { 1 };
    series(operator, basis, factor, omega, forces, terms)
}

/// Combinations of the modes whose forces are sampled, complex ones, for either side.
const SAMPLES: usize = 12;
/// Terms of the series in ω². Each brings the vectors nearer by the distance of the shift from the band over that of the
/// real modes which are left out, here about a third.
const TERMS: usize = 4;

/// What the forces that do not decouple the real modes bring about: the first terms of the response in ω² to R, the forces
/// of damping and interface, right and left, in random combinations of the real modes. A few such columns reveal what the responses to all modes have in common.
pub(super) fn coupled_responses(
    operator: &Operator<'_>,
    basis: &Basis<'_>,
    factor: &dyn SymmetricFactor,
    omega: f64,
) -> Mat<f64> {
    let mut random = Random::new();
    let mut mixed = || {
        let mut part = || Mat::from_fn(basis.len(), SAMPLES, |_, _| random.next());
        Block { re: part(), im: part() }
    };
    let s = vec![c64::new(0.0, omega); SAMPLES];
    let mut sampled = Mat::zeros(operator.n(), 4 * SAMPLES);
    for (half, side) in [Side::Right, Side::Left].into_iter().enumerate() {
        let forces = operator.coupling(side, &s, &basis.expand(&mixed()));
        sampled.subcols_mut(2 * half * SAMPLES, SAMPLES).copy_from(&forces.re);
        sampled.subcols_mut((2 * half + 1) * SAMPLES, SAMPLES).copy_from(&forces.im);
    }
    sampled *= faer::Scale(1.0 / omega);
    series(operator, basis, factor, omega, sampled, TERMS)
}
