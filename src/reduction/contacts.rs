//! Contacts of many points in a reduced model: the deflections under the forces that occur in them.
//!
//! With A = K + Σ k d dᵀ, the structure with its contacts closed (the springs k of steady sliding along d: g, and t₁, t₂ of points that
//! stick), and with a motion u about steady sliding, the contacts exert beside what A has of them
//!
//! φ(u, u̇) = r(u₀ + u, u̇) − r₀ − k Dᵀu:
//!
//! friction, and what opens, turns round or stiffens. The modes of A answer to inertia, the deflections A⁻¹Dφ are what the model needs
//! besides. They are smooth as the motion is, so that few directions hold nearly all of them, far fewer than there are points. These are the
//! range of the map from a random motion to its A⁻¹Dφ, found block by block (N. Halko, P. G. Martinsson & J. A. Tropp, SIAM Rev. 53 (2011) 217, §4.4): a
//! block of fresh motions first measures the basis, by the largest ‖x − P x‖_A/‖x‖_A of its x = A⁻¹Dφ, P being the projection on the basis in
//! the energy of A; where that is more than a part of the tolerance, the block joins the basis. Of the directions that were found in this way the principal ones
//! of all samples are kept, as many as fresh motions need to be within the tolerance.
//!
//! A basis that holds φ of Q(λ)φ = 0 has VᵀQ(λ)V y = 0 with φ = V y: λ is an eigenvalue of the reduced model, too. So complex modes are among the
//! shapes that it holds exactly, and a small motion grows and turns in it as in the full one.

use crate::equilibrium::{ContactBlock, SteadySliding, closed_structure, directions, linearize};
use crate::error::Result;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::multivector::{append, combine, expand, gram};
use crate::linalg::random::Random;
use crate::linalg::sparse::{add_scaled, quadratic_forms, times};
use crate::linalg::{SparseMatrix, SparseVector};
use crate::modal::{ModesWanted, RealModes, compute};
use crate::system::{ContactMotion, ContactPair, ContactPoint, System};
use faer::{Accum, Mat, MatMut, MatRef};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Random motions of a block. Where 20 of 20 are within an error, 86 % of all such motions are, with a probability of 95 %: 0.86²⁰ = 0.05.
pub(super) const PROBES: usize = 20;
/// Blocks, at most.
const BLOCKS: usize = 80;
/// The part of the tolerance within which the directions are from which the principal ones are taken.
const FINER: f64 = 0.6;
/// How far a random motion changes the penetrations, as a part of those in steady sliding: up to where most points open at times,
const CHANGE: [f64; 2] = [0.1, 1.5];
/// or so little that the contacts answer linearly.
const SMALL_CHANGE: [f64; 2] = [1e-6, 1e-6];
/// Terms of the series in ω² of the response to a force, besides the modes.
const TERMS: usize = 3;

/// Contacts of many points beside a reduced system.
#[derive(Debug, Clone)]
pub struct ReducedContacts {
    /// The pairs, with directions over the rows of `basis`.
    pub pairs: Vec<ContactPair>,
    /// The rows of V of the degrees of freedom in which contacts act.
    pub basis: Mat<f64>,
    /// The error of their deflections.
    pub error: ProbedError,
}

/// Error of the deflections under contact forces, estimated by random motions that had no part in the basis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbedError {
    /// The largest ‖x − P x‖_A/‖x‖_A.
    pub largest: f64,
    /// How many motions.
    pub probes: usize,
}

impl ReducedContacts {
    pub(super) fn new(pairs: &[ContactPair], basis: &Mat<f64>, error: ProbedError) -> Self {
        let points = || pairs.iter().flat_map(|pair| &*pair.points);
        let acting: BTreeSet<usize> = points()
            .flat_map(|point| directions(point).map(SparseVector::indices))
            .flatten()
            .copied()
            .collect();
        let rows: Vec<usize> = acting.into_iter().collect();
        let place =
            |dof: usize| rows.binary_search(&dof).unwrap_or_else(|_| unreachable!("a row of its own"));
        let over = |x: &SparseVector| SparseVector::from_entries(x.iter().map(|(dof, v)| (place(dof), v)));
        let moved = |point: &ContactPoint| ContactPoint {
            normal: over(&point.normal),
            tangents: [over(&point.tangents[0]), over(&point.tangents[1])],
            ..point.clone()
        };
        let pairs = pairs
            .iter()
            .map(|pair| ContactPair { points: pair.points.iter().map(moved).collect(), ..pair.clone() });
        let pairs = pairs.collect();
        let basis = Mat::from_fn(rows.len(), basis.ncols(), |i, j| basis[(rows[i], j)]);
        ReducedContacts { pairs, basis, error }
    }

    /// VᵀK_cV and VᵀC_cV of these contacts at a steady state of the `full` system.
    pub(super) fn linearised(&self, full: &System, steady: &SteadySliding) -> [Mat<f64>; 2] {
        let points: Vec<_> = self.pairs.iter().flat_map(|pair| &*pair.points).collect();
        let blocks = linearize(full, steady).blocks;
        let seen = Mat::from_fn(3 * blocks.len(), self.basis.ncols(), |i, j| {
            directions(points[blocks[i / 3].point])[i % 3].dot(self.basis.col_as_slice(j))
        });
        let between = |part: &dyn Fn(&ContactBlock) -> [[f64; 3]; 3]| {
            let forces = Mat::from_fn(seen.nrows(), seen.ncols(), |i, j| {
                let row = part(&blocks[i / 3])[i % 3];
                (0..3).map(|c| row[c] * seen[(i - i % 3 + c, j)]).sum::<f64>()
            });
            gram(seen.as_ref(), forces.as_ref())
        };
        [between(&|block| block.stiffness), between(&|block| block.damping)]
    }
}

/// What a reduced model holds whose contacts of many points are apart from it.
#[derive(Debug)]
pub struct ManyPoints {
    /// About the relative error of the deflections under contact forces.
    pub tolerance: f64,
    /// Whether the motions are small about steady sliding, so that the contacts answer linearly.
    pub linear: bool,
    /// Shapes that are held exactly, of about unit energy or less where they matter less: the [`ComplexModes::parts`] of complex modes.
    ///
    /// [`ComplexModes::parts`]: crate::stability::ComplexModes::parts
    pub shapes: Mat<f64>,
    /// States that are held exactly, besides steady sliding.
    pub states: Vec<Vec<f64>>,
}

/// A-orthonormal shapes: those that `wanted` holds exactly with u₀, the modes of A up to where `real` reaches, the responses to `forces` and to those that
/// occur in the contacts, these with about the relative error `wanted.tolerance`, which is measured.
pub(super) fn responses(
    (system, steady): (&System, &SteadySliding),
    real: &RealModes,
    mut forces: Mat<f64>,
    wanted: ManyPoints,
) -> Result<(Mat<f64>, ProbedError)> {
    let structure = closed_structure(system, steady)?;
    let highest = real.eigenvalues.last().copied().unwrap_or(0.0).max(0.0).sqrt() / TAU;
    let below = real.certificate.below_hz.max(highest);
    let (modes, _) = compute(&structure, ModesWanted::BelowHz(below), &())?;
    let closed: SparseMatrix = match modes.eigenvalues.get(modes.rigid_bodies) {
        Some(first) if modes.rigid_bodies > 0 => {
            add_scaled(&[(1.0, &structure.stiffness), (0.1 * first.abs(), &structure.mass)])
        }
        _ => (*structure.stiffness).clone(),
    };
    let factor = structure.engine.factorize(&closed)?;
    factor.solve_in_place(forces.as_mut());
    let states: Vec<&[f64]> = wanted.states.iter().chain([&steady.displacement]).map(|x| &**x).collect();
    let states = Mat::from_fn(system.n_dofs(), states.len(), |i, j| states[j][i]);
    let mut basis = Mat::zeros(system.n_dofs(), 0);
    let unit = |mut shapes: Mat<f64>| {
        let energies = quadratic_forms(&closed, shapes.as_ref());
        scale(&mut shapes, &energies);
        shapes
    };
    for shapes in [states, real.shapes.clone()] {
        join(&mut basis, unit(shapes), &closed, ROUND_OFF)?;
    }
    join(&mut basis, wanted.shapes, &closed, ROUND_OFF)?;
    let least = (0.1 * wanted.tolerance).powi(2);
    join(&mut basis, unit(modes.shapes.clone()), &closed, least)?;
    let mut exact = basis.ncols();
    join(&mut basis, unit(forces), &closed, ROUND_OFF)?;
    for _ in 1..TERMS {
        let mut next = times(&structure.mass, basis.subcols(exact, basis.ncols() - exact));
        factor.solve_in_place(next.as_mut());
        exact = basis.ncols();
        join(&mut basis, unit(next), &closed, ROUND_OFF)?;
    }
    let exact = basis.ncols();
    let change = if wanted.linear { SMALL_CHANGE } else { CHANGE };
    let mut motions = RandomMotions::new((system, steady), &modes, change);
    let mut fresh = || {
        let forces = motions.forces();
        let mut deflections = forces.clone();
        factor.solve_in_place(deflections.as_mut());
        Fresh { forces, deflections }
    };
    let mut samples = Vec::new();
    for _ in 0..BLOCKS {
        let mut block = fresh();
        let enough = block.largest_error(basis.as_ref()) <= FINER * wanted.tolerance;
        if enough || basis.ncols() + PROBES > basis.nrows() {
            break;
        }
        block.scale();
        join(&mut basis, block.deflections, &closed, least)?;
        samples.push(gram(basis.subcols(exact, basis.ncols() - exact), block.forces.as_ref()));
    }
    let all = basis.ncols() - exact;
    let mut kept = principal(basis.subcols_mut(exact, all), &samples, 0.5 * wanted.tolerance)?;
    let error = loop {
        let largest = fresh().largest_error(basis.subcols(0, exact + kept));
        if largest <= wanted.tolerance || kept == all {
            break ProbedError { largest, probes: PROBES };
        }
        kept = (kept + PROBES / 2).min(all);
    };
    basis.resize_with(basis.nrows(), exact + kept, |_, _| 0.0);
    Ok((basis, error))
}

/// Turns A-orthonormal directions into the principal ones of samples of unit energy, given their coordinates, largest first; says how many leave less
/// than a relative error in the mean.
fn principal(mut directions: MatMut<'_, f64>, samples: &[Mat<f64>], error: f64) -> Result<usize> {
    let all = directions.ncols();
    if all == 0 {
        return Ok(0);
    }
    let mut energy = Mat::<f64>::zeros(all, all);
    for block in samples {
        let m = block.nrows();
        let seen = product(block.as_ref(), block.transpose());
        let mut part = energy.submatrix_mut(0, 0, m, m);
        part += seen;
    }
    let (values, vectors) = symmetric_eigen(energy.as_ref())?;
    let vectors = Mat::from_fn(all, all, |i, j| vectors[(i, all - 1 - j)]);
    let turned = expand(directions.as_ref(), vectors.as_ref());
    directions.copy_from(turned);
    let (mut left, least) = (0.0, (PROBES * samples.len()) as f64 * error * error);
    let spare = values.iter().take_while(|value| {
        left += **value;
        left <= least
    });
    Ok(all - spare.count())
}

/// Deflections A⁻¹f of a block of fresh motions.
struct Fresh {
    forces: Mat<f64>,
    deflections: Mat<f64>,
}

impl Fresh {
    /// xᵀA x = xᵀf of each.
    fn energies(&self) -> Vec<f64> {
        let columns = self.forces.col_iter().zip(self.deflections.col_iter());
        columns.map(|(f, x)| f.iter().zip(x.iter()).map(|(f, x)| f * x).sum()).collect()
    }

    /// The largest ‖x − P x‖_A/‖x‖_A: with the A-orthonormal X of P, XᵀA x = Xᵀf.
    fn largest_error(&self, basis: MatRef<'_, f64>) -> f64 {
        let shares = gram(basis, self.forces.as_ref());
        let of = |(j, energy): (usize, f64)| {
            let held: f64 = shares.col_as_slice(j).iter().map(|s| s * s).sum();
            if energy > 0.0 { ((energy - held).max(0.0) / energy).sqrt() } else { 0.0 }
        };
        self.energies().into_iter().enumerate().map(of).fold(0.0, f64::max)
    }

    /// Brings each to unit energy.
    fn scale(&mut self) {
        let energies = self.energies();
        scale(&mut self.forces, &energies);
        scale(&mut self.deflections, &energies);
    }
}

/// Divides each column by the root of its energy.
fn scale(columns: &mut Mat<f64>, energies: &[f64]) {
    for (column, energy) in columns.col_iter_mut().zip(energies) {
        let factor = if *energy > 0.0 { 1.0 / energy.sqrt() } else { 0.0 };
        column.iter_mut().for_each(|x| *x *= factor);
    }
}

/// A direction of shapes below this part of their own energy is round-off.
const ROUND_OFF: f64 = 1e-10;

/// Makes `shapes` of unit energy A-orthogonal to a basis and adds the directions of their span that hold more than `least` of it.
fn join(basis: &mut Mat<f64>, mut shapes: Mat<f64>, closed: &SparseMatrix, least: f64) -> Result<()> {
    for _ in 0..2 {
        let share = gram(basis.as_ref(), times(closed, shapes.as_ref()).as_ref());
        combine(shapes.as_mut(), Accum::Add, basis.as_ref(), share.as_ref(), -1.0);
    }
    let energy = gram(shapes.as_ref(), times(closed, shapes.as_ref()).as_ref());
    let (values, vectors) = symmetric_eigen(energy.as_ref())?;
    let kept: Vec<usize> = (0..values.len()).rev().filter(|k| values[*k] > least.max(ROUND_OFF)).collect();
    let mix = Mat::from_fn(values.len(), kept.len(), |i, c| vectors[(i, kept[c])] / values[kept[c]].sqrt());
    append(basis, expand(shapes.as_ref(), mix.as_ref()).as_ref());
    Ok(())
}

/// Random motions in the span of the modes of A, about steady sliding, of equal energy in every mode.
struct RandomMotions<'a> {
    system: &'a System,
    steady: &'a SteadySliding,
    modes: &'a RealModes,
    /// The changes of the penetrations, as a part of `depth`.
    change: [f64; 2],
    /// √(mean δ₀²) of the points that are closed \[m\].
    depth: f64,
    random: Random,
}

impl<'a> RandomMotions<'a> {
    fn new(
        (system, steady): (&'a System, &'a SteadySliding),
        modes: &'a RealModes,
        change: [f64; 2],
    ) -> Self {
        let closed = steady.points.iter().filter(|point| point.closed());
        let depth = mean_square(closed.map(|point| point.penetration));
        RandomMotions { system, steady, modes, change, depth, random: Random::new() }
    }

    /// D φ of a block of motions, one a column.
    fn forces(&mut self) -> Mat<f64> {
        let mut amplitudes = [0, 1].map(|_| Mat::zeros(self.modes.len(), PROBES));
        for (k, square) in self.modes.eigenvalues.iter().enumerate().skip(self.modes.rigid_bodies) {
            for j in 0..PROBES {
                amplitudes[0][(k, j)] = self.random.next() / square.abs().sqrt();
                amplitudes[1][(k, j)] = self.random.next();
            }
        }
        let [mut u, mut v] = amplitudes.map(|of| expand(self.modes.shapes.as_ref(), of.as_ref()));
        let mut forces = Mat::zeros(u.nrows(), PROBES);
        for j in 0..PROBES {
            let points = self.system.points().map(|(_, point)| point.normal.dot(u.col_as_slice(j)));
            let change = self.random.between(self.change[0], self.change[1]) * self.depth;
            let scale = change / mean_square(points).max(f64::MIN_POSITIVE);
            for x in [&mut u, &mut v] {
                x.col_as_slice_mut(j).iter_mut().for_each(|x| *x *= scale);
            }
            let approach = 0.3 * change * self.random.next();
            self.add_forces([u.col_as_slice(j), v.col_as_slice(j)], approach, forces.col_as_slice_mut(j));
        }
        forces
    }

    /// D φ at u, u̇ and a change of the approaches.
    fn add_forces(&self, [u, v]: [&[f64]; 2], approach: f64, total: &mut [f64]) {
        for ((pair, point), at) in self.system.points().zip(&self.steady.points) {
            let along = directions(point);
            let [moved, rate] = [u, v].map(|x| along.map(|d| d.dot(x)));
            let penetration = at.penetration + approach + moved[0];
            let forces = if pair.sticks() {
                let origin = &self.steady.displacement;
                let slid = [1, 2].map(|c| -(along[c].dot(origin) + moved[c]));
                pair.law.hold(penetration, slid, point.weight).0
            } else {
                let slip_velocity = [pair.velocity_at(point) - rate[1], -rate[2]];
                let motion = ContactMotion { penetration, penetration_rate: rate[0], slip_velocity };
                pair.law.respond(&motion, point.weight).0
            };
            let springs = at.tangent.springs();
            let before = [at.forces.normal, -at.forces.friction[0], -at.forces.friction[1]];
            let now = [forces.normal, -forces.friction[0], -forces.friction[1]];
            for c in 0..3 {
                along[c].add_to(now[c] - before[c] - springs[c] * moved[c], total);
            }
        }
    }
}

/// √(mean x²).
fn mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    values.for_each(|x| (sum, count) = (sum + x * x, count + 1.0));
    (sum / count.max(1.0)).sqrt()
}
