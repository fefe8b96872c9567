//! A smaller basis for the members of a family, by proper orthogonal decomposition of the modes of some of them.
//!
//! The modes in the band change smoothly with the scalars of a family, so that those of a few members nearly span those of all
//! (L. Sirovich, Quart. Appl. Math. 45 (1987) 561; with right and left vectors the error of λ is of second order). A basis that is
//! right at full order has the responses to every contact direction besides, by which the small dense problems of thousands of
//! members cost too much.

use super::band::in_band;
use super::reduced::{Projection, ReducedModes};
use crate::linalg::c64;
use crate::linalg::dense::{product, symmetric_eigen};
use faer::{Mat, MatRef};

/// A reduced model of more vectors than this is made smaller.
pub(super) const LARGE: usize = 160;
/// Principal directions below this part of a snapshot are left out of the reduced model; each snapshot is one in the E-norm.
const TOLERANCE: f64 = 3e-5;
/// The same of the basis, from which further members start.
const OF_BASIS: f64 = 1e-5;
/// The band of the snapshots is wider on both sides by this factor.
const WIDER: f64 = 1.2;

/// Whether λ is one of a snapshot.
pub(super) fn near_band(z: c64, [low, high]: [f64; 2]) -> bool {
    in_band(z, [low / WIDER, high * WIDER])
}

/// Real and imaginary parts of right and left vectors of some members, one a column, in coordinates of a basis that may have
/// grown since.
#[derive(Default)]
pub(super) struct Snapshots(Vec<Mat<f64>>);

impl Snapshots {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds the `modes` of a member, given by the `rotation` of their reduced model.
    pub(super) fn add(&mut self, rotation: MatRef<'_, f64>, modes: &ReducedModes) {
        for vectors in [&modes.right, &modes.left] {
            for part in [|z: &c64| z.re, |z: &c64| z.im] {
                let part = Mat::from_fn(vectors.nrows(), vectors.ncols(), |i, j| part(&vectors[(i, j)]));
                self.0.push(product(rotation, part.as_ref()));
            }
        }
    }

    /// The projection on their principal directions in the E-norm, E = K + τ M, and these; `None` where they are more than `most`.
    pub(super) fn compact(
        &self,
        projection: &Projection,
        tau: f64,
        most: usize,
    ) -> Option<(Projection, Mat<f64>)> {
        let m = projection.mass.nrows();
        let basis = principal(&self.whole(m), &projection.energy(tau), 0, TOLERANCE)?;
        (basis.ncols() <= most).then(|| (projection.onto(basis.as_ref()), basis))
    }

    /// E/τ-orthonormal combinations of the vectors of the basis from `first` on, to which the others are E-orthogonal, that hold
    /// what the snapshots have of them. The snapshots are in the coordinates of that smaller basis then. `None` where it is hardly
    /// smaller.
    pub(super) fn reduce(&mut self, projection: &Projection, tau: f64, first: usize) -> Option<Mat<f64>> {
        let (energy, all) = (projection.energy(tau), self.whole(projection.mass.nrows()));
        let rest = all.nrows() - first;
        let mut mix = principal(&all, &energy, first, OF_BASIS)?;
        if 5 * mix.ncols() > 4 * rest {
            return None;
        }
        mix *= faer::Scale(tau.sqrt());
        let image = product(energy.submatrix(first, first, rest, rest), all.subrows(first, rest));
        let share = product(mix.transpose(), image.as_ref());
        let coordinates =
            |i: usize, j: usize| if i < first { all[(i, j)] } else { share[(i - first, j)] / tau };
        self.0 = vec![Mat::from_fn(first + mix.ncols(), all.ncols(), coordinates)];
        Some(mix)
    }

    /// All of them in coordinates of a basis of `m` vectors.
    fn whole(&self, m: usize) -> Mat<f64> {
        let columns = self.0.iter().flat_map(|part| part.col_iter());
        let mut snapshots = Mat::<f64>::zeros(m, self.0.iter().map(|part| part.ncols()).sum());
        for (all, one) in snapshots.as_mut().col_iter_mut().zip(columns) {
            all.subrows_mut(0, one.nrows()).copy_from(one);
        }
        snapshots
    }
}

/// Principal directions in the E-norm of the `snapshots`, each scaled to length one, of what they have of the vectors from `first` on:
/// E-orthonormal ones, down to `tolerance`.
fn principal(snapshots: &Mat<f64>, energy: &Mat<f64>, first: usize, tolerance: f64) -> Option<Mat<f64>> {
    let image = product(energy.as_ref(), snapshots.as_ref());
    let length = |j: usize| (snapshots.col(j).transpose() * image.col(j)).max(0.0).sqrt();
    let lengths: Vec<f64> = (0..snapshots.ncols()).map(length).collect();
    let scale = |j: usize| if lengths[j] > 0.0 { 1.0 / lengths[j] } else { 0.0 };
    let rest = snapshots.nrows() - first;
    let own = snapshots.subrows(first, rest);
    let gram = product(own.transpose(), product(energy.submatrix(first, first, rest, rest), own).as_ref());
    let gram = Mat::from_fn(gram.nrows(), gram.ncols(), |i, j| scale(i) * gram[(i, j)] * scale(j));
    let (sizes, directions) = symmetric_eigen(gram.as_ref()).ok()?;
    let kept: Vec<usize> = (0..sizes.len()).rev().filter(|k| sizes[*k] > tolerance * tolerance).collect();
    let mix = Mat::from_fn(sizes.len(), kept.len(), |i, k| {
        scale(i) * directions[(i, kept[k])] / sizes[kept[k]].sqrt()
    });
    Some(product(own, mix.as_ref()))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{damped, dense_eigenvalues, dense_modes, nearest, steady};
    use super::super::{Family, FamilyFrame, SlidingState, closed_modes, complex_modes};
    use super::LARGE;
    use crate::bounds::{Origin::*, within};
    use crate::contact::{Coulomb, NormalLaw, SlidingLaw};
    use crate::equilibrium::SteadySliding;
    use crate::equilibrium::samples::random_system;
    use crate::linalg::c64;
    use crate::system::Closing;
    use std::collections::BTreeSet;
    use std::f64::consts::TAU;
    use std::sync::Arc;

    /// More directions of contact than real modes: between the members on which it was trained a family has the modes of the dense
    /// problem, for friction from none to its double and half to three times the stiffness of contact, on few vectors.
    #[test]
    fn many_contact_points_are_served_by_few_vectors() {
        // What diverges is given whatever the band, and may be on either side of its bottom.
        let oscillates = |z: &c64| z.im > 0.1 * z.norm();
        for (seed, power) in [(2, 4), (3, 5)] {
            let system = damped(random_system(200, 40, 20.0, 900 + seed), seed);
            let mut reference = steady(&system);
            for point in &mut reference.points {
                point.tangent.by_penetration.iter_mut().for_each(|k| *k *= 10f64.powi(power));
            }
            let real = dense_modes(&system, 40);
            let band = [0.01, 0.5 * (real.frequency_hz(4) + real.frequency_hz(5))];
            let (closed, own, _) =
                closed_modes((&system, &reference), &real, TAU * band[1], &()).unwrap().unwrap();
            let frame = FamilyFrame::closed(&closed, &own, Vec::new(), band).unwrap();
            let at = |friction: f64, stiffness: f64| {
                let mut state = reference.clone();
                for point in &mut state.points {
                    let k = &mut point.tangent.by_penetration;
                    *k = [k[0] * stiffness, k[1] * friction * stiffness, k[2] * friction * stiffness];
                }
                state
            };
            let member = |state: &SteadySliding| SlidingState {
                points: state.points.clone(),
                damping_weights: vec![1.0],
            };
            let trained = [(0.0, 0.5), (2.0, 0.5), (0.0, 3.0), (2.0, 3.0), (1.0, 1.0)]
                .map(|(friction, stiffness)| member(&at(friction, stiffness)));
            let mut family = Family::new(&frame, &trained).unwrap();
            for member in &trained {
                family.train(member).unwrap();
            }
            assert!(family.dimension() < LARGE, "seed {seed}: {}", family.dimension());
            for (friction, stiffness) in [(0.4, 0.7), (1.6, 2.0), (1.3, 1.0)] {
                let state = at(friction, stiffness);
                // Those at the top of the band may be on either side of it.
                let exact: Vec<c64> = dense_eigenvalues(&system, &state, [band[0], 1.05 * band[1]]);
                let inside = exact.iter().filter(|z| z.im < 0.98 * TAU * band[1] && oscillates(z));
                let (found, check) =
                    (family.modes(&member(&state)).unwrap(), family.check(&member(&state)).unwrap());
                for z in inside {
                    let error = (z - nearest(*z, &found.eigenvalues)).norm() / z.norm();
                    assert!(within(error, 1e-4, Discretisation), "seed {seed}: {z}");
                }
                let all = found.eigenvalues.iter().zip(&check.eigenvalue_errors);
                for (z, estimate) in all.filter(|(z, _)| oscillates(z)) {
                    let error = (z - nearest(*z, &exact)).norm() / z.norm();
                    assert!(within(error, 1e-4, Discretisation), "seed {seed}: {z}");
                    assert!(
                        within(error, 10.0 * estimate + 1e-10, Stated),
                        "seed {seed}: {error:.1e} {estimate:.1e}"
                    );
                }
            }
        }
    }

    /// A map over friction and load of a body with losses, whose points open and close: at each place a family has the modes of an
    /// analysis of its own.
    #[test]
    fn a_map_over_lift_off_with_losses_agrees_with_separate_analyses() {
        let base = damped(random_system(220, 60, 20.0, 77), 2);
        let at = |friction: f64, load: f64| {
            let mut system = base.clone();
            let normal = NormalLaw::linear(3e4);
            for pair in &mut system.pairs {
                pair.law = Arc::new(SlidingLaw::new(normal, Coulomb { mu0: friction }, 1e-3));
                pair.closing = Closing::Load(load);
            }
            let steady = steady(&system);
            (system, steady)
        };
        let (system, reference) = at(0.3, 400.0);
        let real = dense_modes(&system, 44);
        let band = [0.01, 0.5 * (real.frequency_hz(8) + real.frequency_hz(9))];
        let (closed, own, _) =
            closed_modes((&system, &reference), &real, TAU * band[1], &()).unwrap().unwrap();
        let frame = FamilyFrame::closed(&closed, &own, Vec::new(), band).unwrap();
        let member = |steady: &SteadySliding| SlidingState {
            points: steady.points.clone(),
            damping_weights: vec![1.0],
        };
        let corners = [(0.1, 200.0), (0.6, 800.0), (0.6, 200.0), (0.1, 800.0), (0.35, 500.0)];
        let trained = corners.map(|(friction, load)| member(&at(friction, load).1));
        let mut family = Family::new(&frame, &trained).unwrap();
        for member in &trained {
            family.train(member).unwrap();
        }
        let mut open = BTreeSet::new();
        for (friction, load) in [(0.25, 300.0), (0.5, 650.0), (0.2, 700.0), (0.6, 200.0)] {
            let (system, steady) = at(friction, load);
            open.insert(steady.points.iter().filter(|point| !point.closed()).count());
            // As of a map: where the family is not good enough, it is trained.
            if family.check(&member(&steady)).unwrap().worst() > 1e-8 {
                family.train(&member(&steady)).unwrap();
            }
            let alone = complex_modes(&system, &steady, &real, band, &()).unwrap();
            let found = family.eigenvalues(&member(&steady)).unwrap();
            let inside = |z: &c64| z.im > 0.1 * z.norm() && z.im < 0.98 * TAU * band[1];
            let all: Vec<_> = alone.modes.iter().filter(|mode| inside(&mode.eigenvalue)).collect();
            assert_eq!(found.iter().filter(|z| inside(z)).count(), all.len(), "{friction} {load}");
            for mode in all {
                let error =
                    (mode.eigenvalue - nearest(mode.eigenvalue, &found)).norm() / mode.eigenvalue.norm();
                assert!(
                    mode.accepted() && within(error, 1e-6, Discretisation),
                    "{friction} {load}: {error:e}"
                );
            }
        }
        assert!(open.len() > 2, "points open and close: {open:?}");
    }
}
