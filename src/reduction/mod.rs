//! A small system that moves like a large one where its contacts act: free-interface modes and residual attachment.
//!
//! u = V q with V = \[Φ, Ψ\]: Φ the real modes up to a frequency, Ψ what the static responses K⁻¹g, K⁻¹t₁, K⁻¹t₂ of the
//! contact points, those of the loads, and u₀ have besides them (D. J. Rixen, J. Comput. Appl. Math. 168 (2004) 383, for
//! the residual attachment of free-interface methods). Ψ is made M-orthogonal to Φ and diagonalised by itself, so that
//! VᵀMV = I and VᵀKV = diag(ω²): the reduced model is a [`System`] with contact points of its own, and every analysis
//! takes it like the large one. Its static compliance at the contact is that of the large one; steady sliding is the
//! same.
//!
//! Contacts of many points have far more directions than the model needs: there Ψ are the responses to the forces that occur in them
//! (`contacts`), and the points stay where they are, apart from the system.

mod contacts;
mod receptance;

pub use contacts::{ManyPoints, ProbedError, ReducedContacts};

pub use receptance::{DampingOfModes, MODES, Receptance};

use crate::equilibrium::{FEW_POINTS, SteadySliding, tangent_stiffness};
use crate::error::Result;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::factor::factorize;
use crate::linalg::multivector::{beside, combine, expand, gram};
use crate::linalg::sparse::{add_scaled, dense_columns, diagonal_matrix, entry, times};
use crate::linalg::{Engine, SparseMatrix, SparseVector};
use crate::modal::{RealModes, SturmCertificate};
use crate::system::{ContactPair, ContactPoint, Coupling, Damping, Structure, System};
use faer::{Accum, Mat, MatRef};
use std::f64::consts::TAU;

/// A reduced system with the basis that leads back.
#[derive(Debug, Clone)]
pub struct Reduced {
    /// M = I, K = diag(ω²), the contacts and the load of the large system seen through V; the geometric stiffness of
    /// the preload is in K.
    pub system: System,
    /// V, n × m.
    pub basis: Mat<f64>,
    /// M V.
    pub inertia: Mat<f64>,
    /// How many of the first columns are real modes.
    pub modes: usize,
    /// The contacts, where they have so many points that `system` is without them.
    pub contacts: Option<ReducedContacts>,
}

impl Reduced {
    /// Vᵀx of a linear form x of u: a direction, a force.
    pub fn form(&self, x: &SparseVector) -> SparseVector {
        form(&self.basis, x)
    }

    /// A contact point seen through V.
    pub fn point(&self, point: &ContactPoint) -> ContactPoint {
        seen(&self.basis, point)
    }

    /// VᵀM u: the coordinates of a displacement in the span of V.
    pub fn coordinates(&self, u: &[f64]) -> Vec<f64> {
        let u = MatRef::from_column_major_slice(u, u.len(), 1);
        gram(self.inertia.as_ref(), u).col_as_slice(0).to_vec()
    }

    /// Vᵀx of a dense linear form of u.
    pub fn dual(&self, x: &[f64]) -> Vec<f64> {
        let x = MatRef::from_column_major_slice(x, x.len(), 1);
        gram(self.basis.as_ref(), x).col_as_slice(0).to_vec()
    }

    /// Its real modes, which are its coordinates.
    pub fn real_modes(&self) -> RealModes {
        let stiffness = &self.system.structure.stiffness;
        let m = stiffness.ncols();
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|a, b| stiffness[(*a, *a)].total_cmp(&stiffness[(*b, *b)]));
        let squares: Vec<f64> = order.iter().map(|k| stiffness[(*k, *k)]).collect();
        let below_hz = 2.0 * squares.last().copied().unwrap_or(0.0).max(0.0).sqrt() / TAU;
        RealModes {
            shapes: Mat::from_fn(m, m, |i, j| f64::from(i == order[j])),
            backward_errors: vec![0.0; m],
            rigid_bodies: squares.iter().take_while(|s| **s <= 0.0).count(),
            negative: 0,
            certificate: SturmCertificate { below_hz, shifts_hz: [below_hz; 2], counted: [m; 2], found: m },
            eigenvalues: squares,
        }
    }

    /// V q.
    pub fn expand(&self, q: &[f64]) -> Vec<f64> {
        let q = MatRef::from_column_major_slice(q, q.len(), 1);
        expand(self.basis.as_ref(), q).col_as_slice(0).to_vec()
    }

    /// The steady state seen through V.
    pub fn steady(&self, steady: &SteadySliding) -> SteadySliding {
        SteadySliding { displacement: self.coordinates(&steady.displacement), ..steady.clone() }
    }

    /// A model whose contacts are apart from it, with K_c and C_c of these at a steady state of the `full` system between its coordinates in
    /// their place; `None` of one that has them in it.
    pub fn linearised(&self, full: &System, steady: &SteadySliding) -> Option<(System, SteadySliding)> {
        let [mut stiffness, mut damping] = self.contacts.as_ref()?.linearised(full, steady);
        if let Some(rest) = &self.system.coupling {
            for (i, row) in rest.directions.iter().enumerate() {
                for (j, column) in rest.directions.iter().enumerate() {
                    for ((a, x), (b, y)) in row.iter().flat_map(|x| column.iter().map(move |y| (x, y))) {
                        stiffness[(a, b)] += x * rest.stiffness[(i, j)] * y;
                        damping[(a, b)] += x * rest.damping[(i, j)] * y;
                    }
                }
            }
        }
        let unit = |k: usize| SparseVector::from_entries([(k, 1.0)]);
        let directions = (0..self.basis.ncols()).map(unit).collect();
        let system = System {
            coupling: Some(Coupling { directions, stiffness, damping, skew: None }),
            ..self.system.clone()
        };
        let own = SteadySliding { approach: Vec::new(), points: Vec::new(), ..self.steady(steady) };
        Some((system, own))
    }
}

/// Whether a system has so many contact points that they are not reduced one by one.
pub fn has_many_points(system: &System) -> bool {
    system.points().count() > FEW_POINTS
}

/// Reduces `system` about its steady state to its real modes `real` and the residual attachment of its contact points
/// and of the `forces` on it; with `many_points` to that of the forces that occur in the contacts and to what that
/// names, in place of the points one by one.
///
/// # Errors
/// A stiffness that cannot be factorised, even with a little mass on it.
pub fn reduce(
    system: &System,
    steady: &SteadySliding,
    real: &RealModes,
    forces: &[SparseVector],
    many_points: Option<ManyPoints>,
) -> Result<Reduced> {
    let n = system.n_dofs();
    let stiffness = tangent_stiffness(system, &steady.displacement)?;
    let mass = &system.structure.mass;
    let many = many_points.is_some();
    let imported = system.coupling.iter().flat_map(|rest| &rest.directions);
    let few = system.points().filter(|_| !many);
    let touched = few.flat_map(|(_, point)| {
        [&point.normal, &point.tangents[0], &point.tangents[1]]
            .into_iter()
            .filter(|d| !d.indices().is_empty())
    });
    let directions: Vec<&SparseVector> = touched.chain(imported).chain(forces).collect();
    let column = |x: &[f64]| Mat::from_fn(n, 1, |i, _| x[i]);
    let load = column(&system.load);
    let mut responses = beside(dense_columns(n, &directions).as_ref(), load.as_ref());
    let mut probed = None;
    if let Some(wanted) = many_points {
        let (found, error) = contacts::responses((system, steady), real, responses, wanted)?;
        (responses, probed) = (found, Some(error));
    } else {
        softened(&stiffness, mass, real)?.solve_in_place(responses.as_mut());
        responses = beside(responses.as_ref(), column(&steady.displacement).as_ref());
    }
    let attached = attachment(&stiffness, mass, real, responses)?;
    let modes = real.len();
    let basis = beside(real.shapes.as_ref(), attached.1.as_ref());
    let squares: Vec<f64> = real.eigenvalues.iter().chain(&attached.0).copied().collect();
    let inertia = times(mass, basis.as_ref());
    let structure = Structure {
        mass: diagonal_matrix(&vec![1.0; basis.ncols()]).into(),
        stiffness: diagonal_matrix(&squares).into(),
        damping: damping(&system.structure.damping, &basis, if many { basis.ncols() } else { modes }),
        engine: Engine::default(),
    };
    let contacts = probed.map(|error| ReducedContacts::new(&system.pairs, &basis, error));
    let pairs = system.pairs.iter().filter(|_| !many).map(|pair| ContactPair {
        points: pair.points.iter().map(|point| seen(&basis, point)).collect(),
        ..pair.clone()
    });
    let load = gram(basis.as_ref(), load.as_ref());
    let coupling = system.coupling.as_ref().map(|rest| seen_coupling(&basis, rest));
    let system = System {
        structure,
        pairs: pairs.collect(),
        load: load.col_as_slice(0).to_vec(),
        prestress: None,
        coupling,
    };
    Ok(Reduced { system, basis, inertia, modes, contacts })
}

/// A coupling seen through V; beside sparse skew parts all of it acts between its coordinates.
fn seen_coupling(basis: &Mat<f64>, rest: &Coupling) -> Coupling {
    match &rest.skew {
        None => {
            Coupling { directions: rest.directions.iter().map(|d| form(basis, d)).collect(), ..rest.clone() }
        }
        Some(skew) => {
            // A product with a matrix stored by columns is that with its transpose.
            let of_skew = |a: &SparseMatrix| -gram(basis.as_ref(), times(a, basis.as_ref()).as_ref());
            let along = Mat::from_fn(basis.ncols(), rest.directions.len(), |i, k| {
                rest.directions[k].dot(basis.col_as_slice(i))
            });
            let of_low_rank =
                |a: &Mat<f64>| product(along.as_ref(), product(a.as_ref(), along.transpose()).as_ref());
            Coupling {
                directions: (0..basis.ncols()).map(|k| SparseVector::from_entries([(k, 1.0)])).collect(),
                stiffness: of_skew(&skew.stiffness) + of_low_rank(&rest.stiffness),
                damping: of_skew(&skew.damping) + of_low_rank(&rest.damping),
                skew: None,
            }
        }
    }
}

/// K, or K with as much mass on it as a tenth of the first elastic mode has stiffness where K alone is singular.
fn softened(
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
    real: &RealModes,
) -> Result<Box<dyn crate::linalg::SymmetricFactor>> {
    if real.rigid_bodies == 0
        && let Ok(factor) = factorize(stiffness)
        && factor.inertia().zero == 0
    {
        return Ok(factor);
    }
    let first = real.eigenvalues.get(real.rigid_bodies).copied().unwrap_or(1.0).abs();
    Ok(factorize(&add_scaled(&[(1.0, stiffness), (0.1 * first, mass)]))?)
}

/// ω² and shapes of what `responses` have besides the modes: M-orthonormal, K-orthogonal, and both to the modes.
fn attachment(
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
    real: &RealModes,
    mut responses: Mat<f64>,
) -> Result<(Vec<f64>, Mat<f64>)> {
    /// A response of which less than this is left without the modes is theirs but for round-off.
    const LEFT: f64 = 1e-8;
    /// A direction below this part of the largest, in the energy of its own column, is round-off.
    const ROUND_OFF: f64 = 1e-10;
    let strain = |x: &Mat<f64>| {
        let energy = gram(x.as_ref(), times(stiffness, x.as_ref()).as_ref());
        let own = (0..energy.nrows()).map(|j| energy[(j, j)].abs().sqrt()).collect::<Vec<f64>>();
        (energy, own)
    };
    let (_, before) = strain(&responses);
    let modal = times(mass, real.shapes.as_ref());
    for _ in 0..2 {
        let share = gram(modal.as_ref(), responses.as_ref());
        combine(responses.as_mut(), Accum::Add, real.shapes.as_ref(), share.as_ref(), -1.0);
    }
    // Each column to unit strain energy, then the directions of their span by the energy they hold.
    let (energy, own) = strain(&responses);
    let scaled = |j: usize| if own[j] > LEFT * before[j] { 1.0 / own[j] } else { 0.0 };
    let unit = Mat::from_fn(energy.nrows(), energy.ncols(), |i, j| energy[(i, j)] * scaled(i) * scaled(j));
    let (values, vectors) = symmetric_eigen(unit.as_ref())?;
    let largest = values.last().copied().unwrap_or(0.0).max(f64::MIN_POSITIVE);
    let kept: Vec<usize> = (0..values.len()).filter(|k| values[*k] > ROUND_OFF * largest).collect();
    let mix = Mat::from_fn(energy.nrows(), kept.len(), |i, c| {
        scaled(i) * vectors[(i, kept[c])] / values[kept[c]].sqrt()
    });
    let mut shapes = expand(responses.as_ref(), mix.as_ref());
    // Now ΨᵀKΨ = I: M Ψ y = ν K Ψ y with ω² = 1/ν.
    let share = gram(modal.as_ref(), shapes.as_ref());
    combine(shapes.as_mut(), Accum::Add, real.shapes.as_ref(), share.as_ref(), -1.0);
    let inertia = gram(shapes.as_ref(), times(mass, shapes.as_ref()).as_ref());
    let (nu, turned) = symmetric_eigen(inertia.as_ref())?;
    let top = nu.last().copied().unwrap_or(0.0);
    let massive: Vec<usize> = (0..nu.len()).rev().filter(|k| nu[*k] > 1e-14 * top).collect();
    let mix = Mat::from_fn(nu.len(), massive.len(), |i, c| turned[(i, massive[c])] / nu[massive[c]].sqrt());
    Ok((massive.iter().map(|k| 1.0 / nu[*k]).collect(), expand(shapes.as_ref(), mix.as_ref())))
}

/// VᵀCV and VᵀHV; modal damping is that of the modes alone, whose VᵀB is diagonal.
fn damping(full: &Damping, basis: &Mat<f64>, modes: usize) -> Damping {
    let onto = |a: &SparseMatrix| gram(basis.as_ref(), times(a, basis.as_ref()).as_ref());
    let mut small = full.viscous.as_deref().map_or_else(|| Mat::zeros(basis.ncols(), basis.ncols()), onto);
    if let Some(modal) = &full.modal {
        let share = gram(basis.as_ref(), modal.basis.as_ref());
        for (k, c) in modal.coefficients.iter().enumerate() {
            for i in 0..modes {
                for j in 0..modes {
                    small[(i, j)] += share[(i, k)] * c * share[(j, k)];
                }
            }
        }
    }
    let hysteretic = full.hysteretic.as_ref().and_then(|h| sparse(&onto(h)));
    let [viscous, hysteretic] = [sparse(&small), hysteretic].map(|a| a.map(Into::into));
    Damping { viscous, modal: None, hysteretic }
}

/// The symmetric part of a matrix without what is round-off; modal damping is diagonal but for that. `None` of a zero matrix.
fn sparse(small: &Mat<f64>) -> Option<SparseMatrix> {
    let largest = (0..small.ncols()).map(|i| small[(i, i)].abs()).fold(0.0, f64::max);
    let mut entries = Vec::new();
    for j in 0..small.ncols() {
        for i in 0..small.nrows() {
            let value = 0.5 * (small[(i, j)] + small[(j, i)]);
            if value.abs() > 1e-13 * largest {
                entries.push(entry(i, j, value));
            }
        }
    }
    (!entries.is_empty()).then(|| {
        SparseMatrix::try_new_from_triplets(small.nrows(), small.ncols(), &entries)
            .expect("indices are below the size")
    })
}

fn seen(basis: &Mat<f64>, point: &ContactPoint) -> ContactPoint {
    ContactPoint {
        normal: form(basis, &point.normal),
        tangents: [form(basis, &point.tangents[0]), form(basis, &point.tangents[1])],
        ..point.clone()
    }
}

fn form(basis: &Mat<f64>, x: &SparseVector) -> SparseVector {
    let entries = (0..basis.ncols()).map(|j| (j, x.dot(basis.col_as_slice(j)))).filter(|(_, v)| *v != 0.0);
    SparseVector::from_entries(entries)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::equilibrium::samples::random_system;
    use crate::equilibrium::{SteadyOptions, solve_steady};
    use crate::modal::samples::dense_modes;

    #[test]
    fn the_reduced_system_slides_like_the_large_one_and_keeps_its_modes() {
        for seed in 1..6 {
            let system = random_system(40, 4, 3.0, seed);
            let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
            let real = dense_modes(&system, 9);
            let push = SparseVector::from_entries([(7, 1.0), (20, -0.5)]);
            let reduced = reduce(&system, &steady, &real, std::slice::from_ref(&push), None).unwrap();
            let m = reduced.basis.ncols();
            assert!(reduced.modes == 9 && m > 9 && m <= 9 + 4 * 3 + 3, "{m}");
            let off = |a: &Mat<f64>, expected: &dyn Fn(usize) -> f64| {
                let product = gram(reduced.basis.as_ref(), a.as_ref());
                let scale = |i: usize, j: usize| (expected(i) * expected(j)).sqrt().max(1e-3);
                let pairs = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
                pairs.fold(0.0, |worst: f64, (i, j)| {
                    let wanted = if i == j { expected(i) } else { 0.0 };
                    worst.max((product[(i, j)] - wanted).abs() / scale(i, j))
                })
            };
            let squares: Vec<f64> = (0..m).map(|i| reduced.system.structure.stiffness[(i, i)]).collect();
            assert!(within(off(&reduced.inertia, &|_| 1.0), 1e-9, RoundOff));
            let elastic = times(&system.structure.stiffness, reduced.basis.as_ref());
            assert!(within(off(&elastic, &|i| squares[i]), 1e-9, RoundOff));
            // Its steady sliding, solved again.
            let small = solve_steady(&reduced.system, &SteadyOptions::default(), &()).unwrap();
            for (a, b) in small.points.iter().zip(&steady.points) {
                let (a, b) = (a.forces.normal, b.forces.normal);
                assert!(within((a - b).abs(), 1e-9, RoundOff), "{a} {b}");
            }
            let back = reduced.expand(&small.displacement);
            let size = steady.displacement.iter().fold(0.0f64, |s, x| s.max(x.abs()));
            assert!(back.iter().zip(&steady.displacement).all(|(a, b)| within(
                (a - b).abs(),
                1e-9 * size,
                RoundOff
            )));
            // What a static push does at its own place.
            let force = reduced.form(&push);
            let mut answer = Mat::<f64>::zeros(40, 1);
            push.add_to(1.0, answer.col_as_slice_mut(0));
            factorize(&system.structure.stiffness).unwrap().solve_in_place(answer.as_mut());
            let static_small: f64 = force.iter().map(|(i, f)| f * f / squares[i]).sum();
            let exact = push.dot(answer.col_as_slice(0));
            assert!(within((static_small / exact - 1.0).abs(), 1e-9, RoundOff), "{static_small} {exact}");
        }
    }
}
