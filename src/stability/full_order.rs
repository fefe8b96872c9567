//! A second way to the same eigenvalues: two-level Arnoldi on the full order, which knows no real modes and no basis.

use super::ComplexModes;
use super::operator::Operator;
use crate::equilibrium::SteadySliding;
use crate::error::Result;
use crate::linalg::dense::product;
use crate::linalg::factor::{SymmetricFactor, factorize};
use crate::linalg::lu::Lu;
use crate::linalg::sparse::{add_scaled, multiply};
use crate::linalg::tall::{expand, gram};
use crate::linalg::toar::{ShiftedQuadratic, toar};
use crate::linalg::{SparseMatrix, c64};
use crate::progress::Observer;
use crate::system::System;
use faer::{Mat, MatRef};
use std::f64::consts::TAU;

/// The complex modes of a band beside those that a second, independent method finds there.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Confirmation {
    /// Shifts at which the full-order problem was factorised.
    pub shifts: usize,
    /// Modes that both methods found.
    pub confirmed: usize,
    /// The largest |Δλ|/|λ| of those, and the condition number of that eigenvalue.
    pub largest_difference: f64,
    /// The condition number of the eigenvalue with the largest difference: it multiplies what rounding does.
    pub condition: f64,
    /// Eigenvalues that only the analysis found \[1/s\].
    pub unconfirmed: Vec<c64>,
    /// Eigenvalues that only the second method found \[1/s\].
    pub missed: Vec<c64>,
}

impl Confirmation {
    /// Whether both methods found the same modes.
    pub fn holds(&self) -> bool {
        self.unconfirmed.is_empty() && self.missed.is_empty()
    }
}

/// Modes looked for at one shift.
const GROUP: usize = 16;
/// Two eigenvalues are the same when they differ by less than this part of |λ|, times the condition number.
const SAME: f64 = 1e-7;

/// Looks for the oscillating modes of `found` (ω > 0, in `band_hz`) again, by two-level Arnoldi on the full order at shifts
/// along the band, each near a group of modes and with room for modes that `found` does not have.
///
/// Within the distance of the farthest eigenvalue that a shift gave, the method finds all that its Krylov space holds; it
/// is no proof that there are no others, but it shares nothing with the projection: neither real modes, nor basis, nor
/// the dense solver of the small problem.
///
/// # Errors
/// A shift that cannot be factorised, or an iteration that does not converge.
pub fn confirm(
    system: &System,
    steady: &SteadySliding,
    found: &ComplexModes,
    band_hz: [f64; 2],
    observer: &dyn Observer,
) -> Result<Confirmation> {
    let operator = Operator::new(system, steady)?;
    let modes: Vec<(c64, f64)> =
        found.modes.iter().filter(|m| m.eigenvalue.im > 0.0).map(|m| (m.eigenvalue, m.condition)).collect();
    let band = band_hz.map(|f| TAU * f);
    observer.begin("second method", Some(modes.len().div_ceil(GROUP) as u64));
    let mut confirmation = Confirmation::default();
    let mut seen = vec![false; modes.len()];
    for group in modes.chunks(GROUP) {
        let (first, last) = (group[0].0.im, group[group.len() - 1].0.im);
        let middle = 0.5 * (first + last);
        // Off the imaginary axis, where an undamped structure has its eigenvalues.
        let shift = c64::new(1e-3 * middle.max(1e-3 * band[1]), middle);
        let farthest = group.iter().map(|(z, _)| (z - shift).norm()).fold(0.0, f64::max);
        let problem = Shifted::new(&operator, shift)?;
        confirmation.shifts += 1;
        let mut count = group.len() + 4;
        let values = loop {
            let pairs = toar(&problem, shift, farthest.max(1e-3 * middle), count, 1e-12)?;
            let reach = pairs.values.iter().map(|z| (z - shift).norm()).fold(0.0, f64::max);
            if reach > farthest * (1.0 + 1e-6) || pairs.values.len() < count || count >= 2 * operator.n() {
                break pairs.values;
            }
            count *= 2;
        };
        for value in values.iter().filter(|z| z.im > 1e-9 * z.norm()) {
            let near = (0..modes.len())
                .filter(|j| !seen[*j])
                .min_by(|a, b| (modes[*a].0 - value).norm().total_cmp(&(modes[*b].0 - value).norm()));
            let known = (0..modes.len()).any(|j| seen[j] && same(modes[j], *value));
            match near.filter(|j| same(modes[*j], *value)) {
                Some(j) => {
                    seen[j] = true;
                    let difference = (modes[j].0 - value).norm() / value.norm();
                    if difference > confirmation.largest_difference {
                        confirmation.largest_difference = difference;
                        confirmation.condition = modes[j].1;
                    }
                }
                // Neighbouring shifts see the same modes.
                None if known => {}
                None if value.im > band[0] && value.im < band[1] => confirmation.missed.push(*value),
                None => {}
            }
        }
        observer.advance(1);
    }
    observer.end();
    confirmation.confirmed = seen.iter().filter(|s| **s).count();
    confirmation.unconfirmed =
        modes.iter().zip(&seen).filter(|(_, seen)| !**seen).map(|((z, _), _)| *z).collect();
    Ok(confirmation)
}

fn same((known, condition): (c64, f64), value: c64) -> bool {
    (known - value).norm() <= SAME * condition.clamp(1.0, 1e4) * value.norm()
}

/// Q at a shift: P = P_s + F G Fᵀ with the sparse, complex symmetric P_s = σ²M + σC + K + iH, and for what is not sparse
/// or not symmetric F = \[B W\], G = diag(σ c, k + σ c_c) of the modal damping and the interface.
///
/// P⁻¹ r = y − Y (I + G FᵀY)⁻¹ G Fᵀ y with y = P_s⁻¹ r and Y = P_s⁻¹ F (Sherman, Morrison & Woodbury).
pub(super) struct Shifted<'a> {
    operator: &'a Operator<'a>,
    shift: c64,
    factor: Box<dyn SymmetricFactor<c64>>,
    /// Y.
    responses: Mat<c64>,
    /// G.
    small: Mat<c64>,
    /// I + G FᵀY.
    lu: Lu<c64>,
}

impl<'a> Shifted<'a> {
    pub(super) fn new(operator: &'a Operator<'a>, shift: c64) -> Result<Self> {
        let one = c64::new(1.0, 0.0);
        let mut terms: Vec<(c64, &SparseMatrix)> =
            vec![(one, &operator.stiffness), (shift * shift, operator.mass)];
        terms.extend(operator.damping.viscous.as_deref().map(|c| (shift, c)));
        terms.extend(operator.damping.hysteretic.as_deref().map(|h| (c64::new(0.0, 1.0), h)));
        let factor = factorize(&add_scaled(&terms))?;
        let modal = operator.damping.modal.as_ref();
        let (m, interface) = (modal.map_or(0, |modal| modal.coefficients.len()), &operator.interface);
        let size = m + interface.directions.len();
        let mut small = Mat::<c64>::zeros(size, size);
        for (i, c) in modal.iter().flat_map(|modal| modal.coefficients.iter().enumerate()) {
            small[(i, i)] = shift * *c;
        }
        for term in &interface.terms {
            small[(m + term.row, m + term.column)] += c64::new(term.stiffness, 0.0) + shift * term.damping;
        }
        let mut responses = Mat::<c64>::zeros(operator.n(), size);
        if let Some(modal) = modal {
            let basis = modal.basis.as_ref();
            responses
                .subcols_mut(0, m)
                .copy_from(Mat::from_fn(operator.n(), m, |i, j| c64::new(basis[(i, j)], 0.0)));
        }
        for (j, direction) in interface.directions.iter().enumerate() {
            direction.iter().for_each(|(i, v)| responses[(i, m + j)] = c64::new(v, 0.0));
        }
        factor.solve_in_place(responses.as_mut());
        let mut shifted =
            Shifted { operator, shift, factor, responses, lu: Lu::new(Mat::zeros(0, 0)), small };
        let moved = shifted.along(shifted.responses.as_ref());
        shifted.lu =
            Lu::new(Mat::<c64>::identity(size, size) + product(shifted.small.as_ref(), moved.as_ref()));
        Ok(shifted)
    }

    /// Fᵀ x.
    fn along(&self, x: MatRef<'_, c64>) -> Mat<c64> {
        let modal = self.operator.damping.modal.as_ref();
        let m = modal.map_or(0, |modal| modal.coefficients.len());
        let mut moved = Mat::zeros(self.small.nrows(), x.ncols());
        if let Some(modal) = modal {
            let part = |f: fn(&c64) -> f64| {
                gram(modal.basis.as_ref(), Mat::from_fn(x.nrows(), x.ncols(), |i, j| f(&x[(i, j)])).as_ref())
            };
            let (re, im) = (part(|z| z.re), part(|z| z.im));
            for j in 0..x.ncols() {
                (0..m).for_each(|i| moved[(i, j)] = c64::new(re[(i, j)], im[(i, j)]));
            }
        }
        for (i, direction) in self.operator.interface.directions.iter().enumerate() {
            for j in 0..x.ncols() {
                moved[(m + i, j)] = direction.iter().map(|(row, v)| x[(row, j)] * v).sum();
            }
        }
        moved
    }

    /// P⁻¹ r.
    pub(super) fn invert(&self, mut r: Mat<c64>) -> Mat<c64> {
        self.factor.solve_in_place(r.as_mut());
        let force = self.lu.solve(product(self.small.as_ref(), self.along(r.as_ref()).as_ref()));
        r - expand(self.responses.as_ref(), force.as_ref())
    }
}

impl ShiftedQuadratic for Shifted<'_> {
    fn n(&self) -> usize {
        self.operator.n()
    }

    fn solve(&self, x: Mat<c64>, y: Mat<c64>) -> Mat<c64> {
        let times = |a: &SparseMatrix, x: &Mat<c64>| {
            let mut product = Mat::zeros(x.nrows(), x.ncols());
            multiply(a, x.as_ref(), product.as_mut());
            product
        };
        // P′ x + M y = M (2σ x + y) + C x + F (∂G/∂σ) Fᵀ x.
        let mut r = times(self.operator.mass, &(&x * faer::Scale(self.shift * 2.0) + y));
        if let Some(c) = &self.operator.damping.viscous {
            r += times(c, &x);
        }
        let damped = self.operator.damping.modal.as_ref();
        let m = damped.map_or(0, |modal| modal.coefficients.len());
        let moved = self.along(x.as_ref());
        if let Some(modal) = damped {
            let part = |f: fn(&c64) -> f64| {
                let force = Mat::from_fn(m, 1, |i, _| modal.coefficients[i] * f(&moved[(i, 0)]));
                expand(modal.basis.as_ref(), force.as_ref())
            };
            let (re, im) = (part(|z| z.re), part(|z| z.im));
            (0..r.nrows()).for_each(|i| r[(i, 0)] += c64::new(re[(i, 0)], im[(i, 0)]));
        }
        let directions = &self.operator.interface.directions;
        for term in self.operator.interface.terms.iter().filter(|term| term.damping != 0.0) {
            let force = moved[(m + term.column, 0)] * term.damping;
            directions[term.row].iter().for_each(|(i, v)| r[(i, 0)] += force * v);
        }
        self.invert(r)
    }
}
