//! What interface and damping make of the structure: the first directions besides the real modes.

use super::basis::Basis;
use super::block::Block;
use super::operator::{Operator, Side};
use crate::linalg::SymmetricFactor;
use crate::linalg::c64;
use crate::linalg::random::Random;
use crate::linalg::sparse::times;
use crate::linalg::tall::{beside, gram};
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
    let interface = &operator.interface;
    let (largest, active) = (interface.sizes(omega), interface.active(omega));
    let mut responses = Mat::<f64>::zeros(operator.n(), active.len());
    for (j, d) in active.iter().enumerate() {
        interface.directions[*d].add_to(largest[*d].sqrt() / omega, responses.col_as_slice_mut(j));
    }
    factor.solve_in_place(responses.as_mut());
    responses
}

/// Combinations of the modes whose forces are sampled, complex ones, for either side.
const SAMPLES: usize = 12;
/// Terms of the series in ω². Each brings the vectors nearer by the distance of the shift from the band over that of the
/// real modes which are left out, here about a third.
const TERMS: usize = 4;

/// What the forces that do not decouple the real modes bring about: ω²ᵏ(A⁻¹M)ᵏA⁻¹R, the first terms of the response in
/// ω², R being the forces of damping and interface, right and left, in random combinations of the real modes, less what
/// moves those modes. A few such columns reveal what the responses to all modes have in common.
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
    let mut responses = Mat::zeros(operator.n(), 0);
    for side in [Side::Right, Side::Left] {
        let images = operator.images(basis.expand(&mixed()));
        let mut forces = Block::zeros(operator.n(), s.len());
        operator.add_rest(side, &s, &images, &mut forces);
        responses = beside(&beside(&responses, &forces.re), &forces.im);
    }
    responses *= faer::Scale(1.0 / omega);
    // The response of the real modes is theirs: without it no digits are lost when they are projected out.
    let share = gram(basis.vectors.as_ref(), responses.as_ref());
    responses -= times(operator.mass, basis.expand_real(&share).as_ref());
    factor.solve_in_place(responses.as_mut());
    let mut all = responses.clone();
    for _ in 1..TERMS {
        responses = times(operator.mass, responses.as_ref());
        responses *= faer::Scale(omega * omega);
        factor.solve_in_place(responses.as_mut());
        all = beside(&all, &responses);
    }
    all
}
