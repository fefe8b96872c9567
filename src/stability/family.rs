//! One structure, many sliding states: everything large is done once, a state costs a small dense problem.

use super::analysis::{FIRST_TOLERANCE, shifted_factor};
use super::band::in_band;
use super::basis::Basis;
use super::closed::ClosedContact;
use super::compact::{LARGE, Snapshots, near_band};
use super::reduced::{FamilyMatrices, Projection, ReducedModes};
use super::refinement::{Corrections, MeasuredPairs, PairMeasurement, TOGETHER};
use super::responses::{add_coupled_responses, interface_responses};
use crate::dynamics::{Between, Block, Damper, Interface, InterfaceTerm, Operator, terms_of_every_point};
use crate::equilibrium::{PointState, tangent_stiffness};
use crate::error::Result;
use crate::linalg::c64;
use crate::linalg::dense::product;
use crate::linalg::multivector::beside;
use crate::linalg::sparse::times;
use crate::modal::{RealModes, ShiftedStiffness};
use crate::system::{Damping, System};
use faer::Mat;
use std::f64::consts::TAU;

/// Data on the full order common to all states of a family: the structure, every direction in which a contact point may
/// act, and the factor of A = K + K_σ − s M.
pub struct FamilyFrame<'a> {
    system: &'a System,
    operator: Operator<'a>,
    shifted: ShiftedStiffness,
    real: &'a RealModes,
    /// The springs of the contact points that are part of K \[N/m\], along g, t₁, t₂; none where K is that of the open structure.
    springs: &'a [[f64; 3]],
    /// The other dampings; states weigh them with the system's own.
    dampings: Vec<&'a Damping>,
    /// \[rad/s\].
    band: [f64; 2],
}

/// One member of a family.
#[derive(Debug, Clone)]
pub struct SlidingState {
    /// The contact points at steady sliding, in the order of [`System::points`].
    pub points: Vec<PointState>,
    /// C = w₀C₀ + w₁C₁ + …: the weight of the system's own damping, then of those given to [`FamilyFrame::new`]. As damping
    /// is affine in each of its scalars, weights that add up to one reach every value.
    pub damping_weights: Vec<f64>,
}

/// A reduced model that is right at full order on the states it was trained on, and measured on any other.
pub struct Family<'f> {
    frame: &'f FamilyFrame<'f>,
    basis: Basis<'f>,
    /// Closed contact springs of the reference stiffness: direction and N/m.
    springs: Vec<(usize, f64)>,
    projection: Projection,
    /// On the whole basis.
    reduced: FamilyMatrices,
    /// Modes of the members on which it was trained.
    snapshots: Snapshots,
    /// On fewer vectors, where the basis is large.
    compact: Option<FamilyMatrices>,
}

/// The complex modes of one state in the coordinates of its family, ascending in (ω, σ); one of each conjugate pair.
#[derive(Debug, Clone)]
pub struct FamilyModes {
    /// λ = σ + iω \[1/s\].
    pub eigenvalues: Vec<c64>,
    /// Unit vectors, one a column; their scalar product is φᴴMφ of the full order.
    pub vectors: Mat<c64>,
}

/// Modes of one state and their errors at full order.
#[derive(Debug, Clone, Default)]
pub struct FamilyCheck {
    /// λ of the modes \[1/s\].
    pub eigenvalues: Vec<c64>,
    /// η of each, as in [`super::ComplexMode`].
    pub backward_errors: Vec<f64>,
    /// Estimated |Δλ|/|λ| of each, likewise.
    pub eigenvalue_errors: Vec<f64>,
}

impl FamilyCheck {
    /// The largest estimated |Δλ|/|λ|.
    pub fn worst(&self) -> f64 {
        self.eigenvalue_errors
            .iter()
            .fold(0.0, |m: f64, e| if e.is_nan() { f64::INFINITY } else { m.max(*e) })
    }
}

impl<'a> FamilyFrame<'a> {
    /// For `system` whose structure does not change, `displacement` being its steady one where a prestress counts;
    /// `real` are its real modes, best up to twice the band.
    ///
    /// # Errors
    /// A stiffness that cannot be factorised.
    pub fn new(
        system: &'a System,
        displacement: &[f64],
        real: &'a RealModes,
        dampings: Vec<&'a Damping>,
        band_hz: [f64; 2],
    ) -> Result<Self> {
        FamilyFrame::with((system, displacement, &[]), real, dampings, band_hz)
    }

    /// [`FamilyFrame::new`] of a structure closed by many contact points, with its real modes. States have their own stiffness of contact; the nearer it is
    /// to that of the closed structure, the fewer vectors it takes.
    ///
    /// # Errors
    /// As [`FamilyFrame::new`].
    pub fn closed(
        closed: &'a ClosedContact,
        real: &'a RealModes,
        dampings: Vec<&'a Damping>,
        band_hz: [f64; 2],
    ) -> Result<Self> {
        let structure = (&closed.system, &*closed.steady.displacement, &*closed.springs);
        FamilyFrame::with(structure, real, dampings, band_hz)
    }

    fn with(
        (system, displacement, springs): (&'a System, &[f64], &'a [[f64; 3]]),
        real: &'a RealModes,
        dampings: Vec<&'a Damping>,
        band_hz: [f64; 2],
    ) -> Result<Self> {
        let stiffness = tangent_stiffness(system, displacement)?;
        let operator =
            Operator::with_interface(system, stiffness, Interface::of_every_point(system), &dampings);
        let band = band_hz.map(|f| TAU * f);
        let (factor, shift) = shifted_factor(&operator, real, band)?;
        let shifted = ShiftedStiffness { shift, factor };
        Ok(FamilyFrame { system, operator, shifted, real, springs, dampings, band })
    }

    /// The least frequency by which reduced models are balanced \[rad/s\].
    fn floor(&self) -> f64 {
        1e-3 * self.band[1]
    }

    fn terms(&self, state: &SlidingState) -> Vec<InterfaceTerm> {
        if self.springs.is_empty() {
            return terms_of_every_point(self.system, &state.points);
        }
        let mut points = state.points.clone();
        points.iter_mut().zip(self.springs).for_each(|(point, k)| point.tangent = point.tangent.without(*k));
        terms_of_every_point(self.system, &points)
    }
}

impl<'f> Family<'f> {
    /// A family spanned by the real modes and the responses to every direction in which a contact of any of the `states` has a
    /// force: A⁻¹W and the next term of their series in ω², A⁻¹M A⁻¹W; of more directions than real modes, what the forces of
    /// some combinations of the modes have in common. [`Family::train`] adds what a state still lacks.
    ///
    /// # Errors
    /// A projection that is not definite: parts without mass.
    pub fn new(frame: &'f FamilyFrame<'f>, states: &[SlidingState]) -> Result<Self> {
        const STATIC: usize = 240;
        let terms = envelope(states.iter().map(|state| frame.terms(state)));
        let springs: Vec<(usize, f64)> = terms
            .iter()
            .filter(|t| t.row == t.column && t.row < 3 * frame.system.points().count() && t.stiffness > 0.0)
            .map(|t| (t.row, t.stiffness))
            .collect();
        let mut basis = Basis::new(&frame.operator, frame.real.shapes.as_ref(), frame.band[1].powi(2));
        let top = frame.band[1];
        let weights = states.first().map_or(&[][..], |state| &state.damping_weights);
        let operator = frame.operator.with_terms(terms, weights);
        if operator.interface.active(top).len() > frame.real.len() {
            add_coupled_responses(&operator, &mut basis, &frame.shifted, top, FIRST_TOLERANCE);
        } else {
            let first = interface_responses(&operator, &*frame.shifted.factor, top);
            let mut second = times(frame.operator.mass, first.as_ref());
            second *= faer::Scale(top * top);
            frame.shifted.factor.solve_in_place(second.as_mut());
            basis.enrich(&first, 1e-9, STATIC);
            basis.enrich(&second, 1e-6, STATIC);
        }
        let projection = project(frame, &basis);
        let reduced = FamilyMatrices::new(&projection, &springs, frame.floor())?;
        let (snapshots, compact) = (Snapshots::default(), None);
        Ok(Family { frame, basis, springs, projection, reduced, snapshots, compact })
    }

    /// The size of the reduced model.
    pub fn dimension(&self) -> usize {
        self.matrices().rotation.ncols()
    }

    fn matrices(&self) -> &FamilyMatrices {
        self.compact.as_ref().unwrap_or(&self.reduced)
    }

    /// The modes of `state`: a small dense problem. Safe to call from many threads.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn modes(&self, state: &SlidingState) -> Result<FamilyModes> {
        let modes = self.solve(self.matrices(), state)?;
        Ok(FamilyModes { eigenvalues: modes.eigenvalues, vectors: modes.right })
    }

    /// λ of the modes of `state` alone, in no order, at a third of the cost or less.
    ///
    /// # Errors
    /// As [`Family::modes`].
    pub fn eigenvalues(&self, state: &SlidingState) -> Result<Vec<c64>> {
        let band = self.frame.band;
        self.matrices().eigenvalues(&self.frame.terms(state), &state.damping_weights, |z| in_band(z, band))
    }

    /// Measures the modes of `state` on the full order.
    ///
    /// # Errors
    /// As [`Family::modes`].
    pub fn check(&self, state: &SlidingState) -> Result<FamilyCheck> {
        let matrices = self.matrices();
        Ok(self.measure(matrices, state, &self.solve(matrices, state)?).0)
    }

    /// [`Family::check`] of the one mode whose λ is nearest to `near`; empty where there is no mode.
    ///
    /// # Errors
    /// As [`Family::modes`].
    pub fn check_nearest(&self, state: &SlidingState, near: c64) -> Result<FamilyCheck> {
        let matrices = self.matrices();
        let modes = self.solve(matrices, state)?;
        let far = |k: &usize| (modes.eigenvalues[*k] - near).norm();
        let nearest = (0..modes.eigenvalues.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
        let of = |k: usize, vectors: &Mat<c64>| Mat::from_fn(vectors.nrows(), 1, |i, _| vectors[(i, k)]);
        let one = |k: usize| ReducedModes {
            eigenvalues: vec![modes.eigenvalues[k]],
            right: of(k, &modes.right),
            left: of(k, &modes.left),
            steepness: vec![modes.steepness[k]],
        };
        Ok(nearest.map_or(FamilyCheck::default(), |k| self.measure(matrices, state, &one(k)).0))
    }

    /// Enriches the family until the modes of `state` are right at full order, as [`super::complex_modes`] does for a
    /// single state.
    ///
    /// # Errors
    /// As [`Family::new`].
    pub fn train(&mut self, state: &SlidingState) -> Result<FamilyCheck> {
        const REFINEMENTS: i32 = 6;
        let band = self.frame.band;
        let measure = |of: &Self| -> Result<_> {
            let spectrum = of.reduced.spectrum(&of.frame.terms(state), &state.damping_weights)?;
            let measured = of.measure(&of.reduced, state, &spectrum.modes(|z| in_band(z, band)));
            let near = (of.basis.len() > LARGE || !of.snapshots.is_empty())
                .then(|| spectrum.modes(|z| near_band(z, band)));
            Ok((measured, near))
        };
        let ((mut check, mut wanted), mut near) = measure(self)?;
        for k in 0..REFINEMENTS {
            if wanted.is_empty() {
                break;
            }
            let corrections = wanted.corrections(&*self.frame.shifted.factor);
            if self.basis.enrich(&corrections, FIRST_TOLERANCE * 0.01f64.powi(k), usize::MAX) == 0 {
                break;
            }
            self.project()?;
            ((check, wanted), near) = measure(self)?;
        }
        if let Some(near) = near {
            self.make_compact(&near)?;
        }
        Ok(check)
    }

    /// Adds the modes of a state, on which the basis is trained, to the snapshots, and makes the reduced model of all of them.
    ///
    /// Of many directions of contact each state brings its own corrections: then the basis, too, keeps only what the snapshots have of
    /// them, so that the dense problem of the next state is as small as that of the first.
    fn make_compact(&mut self, near: &ReducedModes) -> Result<()> {
        let (frame, tau) = (self.frame, self.frame.band[1].powi(2));
        self.snapshots.add(self.reduced.rotation.as_ref(), near);
        let (n_real, before) = (self.basis.n_real(), self.basis.len());
        let combinations = match frame.springs.is_empty() {
            true => None,
            false => self.snapshots.reduce(&self.projection, tau, n_real),
        };
        if let Some(mix) = combinations {
            self.basis = self.basis.combined(mix.as_ref());
            self.project()?;
        }
        let most = if self.basis.len() < before { self.basis.len() - 1 } else { before / 2 };
        let fewer = self.snapshots.compact(&self.projection, tau, most);
        let matrices = |(projection, basis): (Projection, Mat<f64>)| {
            let mut matrices = FamilyMatrices::new(&projection, &self.springs, frame.floor())?;
            matrices.rotation = product(basis.as_ref(), matrices.rotation.as_ref());
            Ok(matrices)
        };
        self.compact = fewer.map(matrices).transpose()?;
        Ok(())
    }

    /// The reduced model on the whole basis.
    fn project(&mut self) -> Result<()> {
        self.projection = project(self.frame, &self.basis);
        self.reduced = FamilyMatrices::new(&self.projection, &self.springs, self.frame.floor())?;
        Ok(())
    }

    fn solve(&self, matrices: &FamilyMatrices, state: &SlidingState) -> Result<ReducedModes> {
        let band = self.frame.band;
        matrices.solve(&self.frame.terms(state), &state.damping_weights, |z| in_band(z, band))
    }

    /// Some modes of `state` on the full order, and what those ask for that are not exact.
    fn measure(
        &self,
        matrices: &FamilyMatrices,
        state: &SlidingState,
        modes: &ReducedModes,
    ) -> (FamilyCheck, Corrections) {
        let operator = self.frame.operator.with_terms(self.frame.terms(state), &state.damping_weights);
        let (basis, factor) = (&self.basis, &*self.frame.shifted.factor);
        let scale = PairMeasurement { operator: &operator, basis, factor, top: self.frame.band[1] };
        let turned = |y: &Mat<c64>, first: usize, count: usize| {
            let y = Block::from_fn(y.nrows(), count, |i, j| y[(i, first + j)]);
            y.map(|y| product(matrices.rotation.as_ref(), y))
        };
        let mut wanted = Corrections::of_at_most(modes.eigenvalues.len());
        let (mut check, mut measured) = (FamilyCheck::default(), MeasuredPairs::default());
        for (chunk, lambda) in modes.eigenvalues.chunks(TOGETHER).enumerate() {
            let of = |y: &Mat<c64>| turned(y, chunk * TOGETHER, lambda.len());
            measured.lambda = lambda.to_vec();
            measured.steepness = modes.steepness[chunk * TOGETHER..][..lambda.len()].to_vec();
            measured.left = of(&modes.left);
            basis.expand_into(&of(&modes.right), &mut measured.right);
            scale.measure(&mut measured);
            wanted.add(&scale, &measured, true);
            check.eigenvalues.extend(lambda);
            check.backward_errors.extend(&measured.backward_error);
            check.eigenvalue_errors.extend((0..lambda.len()).map(|j| measured.error(j)));
        }
        (check, wanted)
    }
}

/// The matrices and every damping in coordinates of the basis.
fn project(frame: &FamilyFrame<'_>, basis: &Basis<'_>) -> Projection {
    let parts = basis.between();
    let whole = |form: &dyn Fn(&Between<'_>) -> Mat<f64>| {
        let [of_modes, of_added] = parts.each_ref().map(form);
        beside(of_modes.as_ref(), of_added.as_ref())
    };
    let damping = |(d, damper): (&&Damping, &Damper<'_>)| {
        let loss = d.hysteretic.as_ref().map(|_| whole(&|of| damper.loss.form(of)));
        (whole(&|of| damper.viscous_form(of)), loss)
    };
    let variants: Vec<_> = frame.dampings.iter().zip(&frame.operator.dampers[1..]).map(damping).collect();
    Projection {
        mass: basis.mass.clone(),
        stiffness: basis.stiffness.clone(),
        damping: std::iter::once(&basis.damping).chain(variants.iter().map(|v| &v.0)).cloned().collect(),
        hysteretic: std::iter::once(&basis.hysteretic)
            .chain(variants.iter().map(|v| &v.1))
            .cloned()
            .collect(),
        skew: basis.skew.clone(),
        interface: basis.interface.clone(),
    }
}

/// Every entry that any of the lists has, with its largest stiffness and damping.
fn envelope(lists: impl Iterator<Item = Vec<InterfaceTerm>>) -> Vec<InterfaceTerm> {
    let mut all = std::collections::BTreeMap::new();
    for term in lists.flatten() {
        let largest: &mut InterfaceTerm = all.entry((term.row, term.column)).or_insert(term);
        let larger = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
        largest.stiffness = larger(largest.stiffness, term.stiffness);
        largest.damping = larger(largest.damping, term.damping);
    }
    all.into_values().collect()
}
