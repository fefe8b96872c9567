//! Responses of the structure to interface and damping: the first directions besides the real modes.

use super::basis::Basis;
use crate::dynamics::{Block, Operator, Side};
use crate::linalg::SymmetricFactor;
use crate::linalg::c64;
use crate::linalg::multivector::{Columns, combine, expand, gram};
use crate::linalg::random::Random;
use crate::linalg::sparse::{multiply, times};
use crate::modal::ShiftedStiffness;
use faer::{Accum, Mat, MatRef};

/// Number of random combinations that represent many forces.
pub(super) const SKETCH: usize = 64;

/// A⁻¹W for the directions in which the interface moves or is moved, each weighed by √(its stiffness) so that its
/// E-norm measures the influence of the interface on it.
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

/// F ← F − MΦΦᵀF: forces less what moves the real modes, which are all that the basis has yet. So no digits are lost when
/// they are projected out of the responses, and no power of A⁻¹M turns into the mode nearest to the shift.
fn leave_out_modes(operator: &Operator<'_>, basis: &Basis<'_>, forces: &mut Mat<f64>) {
    let share = seen_by_modes(basis, forces.as_ref());
    let shapes = expand(basis.modes, share.as_ref());
    *forces -= times(operator.mass, shapes.as_ref());
}

/// ΦᵀF, from the rows in which forces act where those are few, as with contact and dashpots.
fn seen_by_modes(basis: &Basis<'_>, forces: MatRef<'_, f64>) -> Mat<f64> {
    const FEW: usize = 8;
    let mut acts = vec![false; forces.nrows()];
    for force in forces.col_iter() {
        acts.iter_mut().zip(force.iter()).for_each(|(acts, force)| *acts |= *force != 0.0);
    }
    let rows: Vec<usize> = (0..acts.len()).filter(|i| acts[*i]).collect();
    if FEW * rows.len() > forces.nrows() {
        return gram(basis.modes, forces);
    }
    let picked = |a| Columns::of([a]).picked(&rows);
    gram(picked(basis.modes).as_ref(), picked(forces).as_ref())
}

/// ω²ᵏ(A⁻¹M)ᵏA⁻¹F of `forces` F for k = 0, 1, … `terms` − 1: the series of the response in ω², but for real modes.
fn series(
    operator: &Operator<'_>,
    basis: &Basis<'_>,
    factor: &dyn SymmetricFactor,
    omega: f64,
    mut forces: Mat<f64>,
    terms: usize,
) -> Mat<f64> {
    let (n, r) = (forces.nrows(), forces.ncols());
    leave_out_modes(operator, basis, &mut forces);
    let mut all = Mat::zeros(n, r * terms);
    all.subcols_mut(0, r).copy_from(forces);
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

/// The forces that do not decouple the real modes, of damping and interface, right and left, in random combinations of the real
/// modes. A few such columns reveal what the forces on all modes have in common.
fn coupling_forces(operator: &Operator<'_>, basis: &Basis<'_>, omega: f64) -> Mat<f64> {
    let mut random = Random::new();
    let mut mixed = || Block::of_parts(Mat::from_fn(basis.len(), 2 * SAMPLES, |_, _| random.next()));
    let s = vec![c64::new(0.0, omega); SAMPLES];
    let mut sampled = Mat::zeros(operator.n(), 4 * SAMPLES);
    for (half, side) in [Side::Right, Side::Left].into_iter().enumerate() {
        let forces = operator.coupling(side, &s, &basis.expand(&mixed()));
        sampled.subcols_mut(2 * half * SAMPLES, 2 * SAMPLES).copy_from(forces.parts());
    }
    sampled *= faer::Scale(1.0 / omega);
    sampled
}

/// Adds to the real modes what damping and interface make of them: the first terms of the response to their forces in ω², term
/// after term. Only those directions of a term are followed up which brought something new, larger than `tolerance` in the
/// E-norm. With A z = f all that the E-norm asks for is at hand: E z = f + (s + τ) M z.
pub(super) fn add_coupled_responses(
    operator: &Operator<'_>,
    basis: &mut Basis<'_>,
    shifted: &ShiftedStiffness,
    omega: f64,
    tolerance: f64,
) {
    let n_modes = basis.len();
    let mut forces = coupling_forces(operator, basis, omega);
    leave_out_modes(operator, basis, &mut forces);
    // The basis grows from term to term: nothing is held longer than it is of use.
    for term in 1.. {
        let mut response = forces.clone();
        shifted.factor.solve_in_place(response.as_mut());
        let inertia = times(operator.mass, response.as_ref());
        let share = shifted.shift + omega * omega;
        for (force, inertia) in forces.col_iter_mut().zip(inertia.col_iter()) {
            force.iter_mut().zip(inertia.iter()).for_each(|(force, inertia)| *force += share * inertia);
        }
        let inertia = (term < TERMS).then_some(inertia);
        let followed = basis.append_new(response.as_ref(), forces.as_ref(), n_modes, tolerance);
        drop(response);
        let Some(inertia) = inertia.filter(|_| followed.ncols() > 0) else { break };
        forces = Mat::zeros(operator.n(), followed.ncols());
        combine(forces.as_mut(), Accum::Replace, inertia.as_ref(), followed.as_ref(), omega * omega);
    }
}
