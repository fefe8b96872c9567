//! Stiffness terms that are not symmetric, as friction gives them: what holds joins the structure, the rest stays whole.
//!
//! Contacts that are assembled give A = Σ k (g − μ t) gᵀ, or friction alone A = −Σ μ k t gᵀ. The half ½(A + Aᵀ) of such a term has
//! eigenvalues of either sign, −½ μ k the lowest: as a part of the structure it would add modes of large negative ω² that no body
//! has. So a term is divided as A = H + R: H = Q \[½ Qᵀ(A + Aᵀ)Q\]₊ Qᵀ, Q an orthonormal basis of the range of Aᵀ (the normal motions
//! g) and \[·\]₊ the part with positive eigenvalues. With t ⊥ g that is Σ k g gᵀ, the closed contact, or nothing. R = Σ fⱼ eⱼᵀ by its
//! columns, or rows where those are fewer: a coupling of low rank without any loss.

use super::Coupling;
use super::halves::{Entry, Halves, mirrored};
use super::low_rank::grouped;
use crate::connected::lowest_connected;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::orthogonal::{pivoted_qr, thin_svd};
use crate::linalg::sparse::{add_scaled, diagonal, entry};
use crate::linalg::{Engine, SparseMatrix, SparseVector};
use faer::Mat;
use std::collections::BTreeMap;

/// Of a group of more rows than this what holds is not looked for: the work grows with their cube.
const LARGEST_GROUP: usize = 600;
/// An eigenvalue of Qᵀ(A + Aᵀ)Q/2 below this part of ‖A‖ is no stiffness that holds: friction on a face that is not flat.
const HOLDS: f64 = 0.1;
/// Columns that differ by less than this part of their size are parallel: a few roundings.
const PARALLEL: f64 = 8.0 * f64::EPSILON;
/// Negative eigenvalues θ of K φ = θ M φ are large below −1e-6 of the median of k_ii / m_ii.
const LARGE_NEGATIVE: f64 = 1e-6;

/// Whether A has entries beside its symmetric part that are more than rounding.
pub fn is_unsymmetric(a: &SparseMatrix) -> bool {
    a.nrows() == a.ncols() && !Halves::of(a).skew.is_empty()
}

/// What a term has beside its H: forces f, of length one, their sizes s, and motions m of R = Σ f s mᵀ.
type Terms = Vec<(SparseVector, f64, SparseVector)>;
/// The same with f and m by the rows of a group.
type GroupTerms = Vec<(Vec<f64>, f64, Vec<f64>)>;
/// Columns of R that are parallel to one, before they are scaled: its values, the same as a force by its rows, and the motion.
type Parallel = (Vec<f64>, SparseVector, Vec<(usize, f64)>);

/// H, n × n, and R of a term.
pub(super) fn divided(a: &SparseMatrix) -> (SparseMatrix, Terms) {
    let n = a.nrows();
    let (mut holding, mut wide, mut terms) = (Vec::new(), Vec::new(), Vec::new());
    for rows in groups(a) {
        let entries = rows
            .iter()
            .flat_map(|j| a.row_idx_of_col(*j).zip(a.val_of_col(*j)).map(move |(i, v)| (i, *j, *v)));
        if rows.len() > LARGEST_GROUP {
            wide.extend(entries.map(|(i, j, v)| entry(i, j, v)));
            continue;
        }
        let place: BTreeMap<usize, usize> = rows.iter().enumerate().map(|(k, row)| (*row, k)).collect();
        let mut dense = Mat::<f64>::zeros(rows.len(), rows.len());
        entries.for_each(|(i, j, v)| dense[(place[&i], place[&j])] += v);
        let size = dense.norm_l2();
        if let Some(held) = held(&dense) {
            for (j, column) in rows.iter().enumerate() {
                let entries = rows.iter().enumerate().map(|(i, row)| entry(*row, *column, held[(i, j)]));
                holding.extend(entries.filter(|e| e.val != 0.0));
            }
            dense -= held;
        }
        match factors(&dense, size) {
            Some(found) => {
                let vector = |x: Vec<f64>| SparseVector::from_entries(rows.iter().copied().zip(x));
                terms.extend(found.into_iter().map(|(f, s, m)| (vector(f), s, vector(m))));
            }
            None => {
                for (j, column) in rows.iter().enumerate() {
                    wide.extend(rows.iter().enumerate().map(|(i, row)| entry(*row, *column, dense[(i, j)])));
                }
            }
        }
    }
    let sparse =
        |entries: &[_]| SparseMatrix::try_new_from_triplets(n, n, entries).expect("rows of the matrix");
    let wide = sparse(&wide);
    let turned = wide.transpose().to_col_major().expect("memory for as many entries once more");
    let (by_columns, by_rows) = (column_terms(&wide), column_terms(&turned));
    if by_columns.len() <= by_rows.len() {
        terms.extend(by_columns);
    } else {
        terms.extend(by_rows.into_iter().map(|(m, s, f)| (f, s, m)));
    }
    (sparse(&holding), terms)
}

/// The singular vectors and values of R of one group that are more than rounding of a matrix of this size.
fn factors(rest: &Mat<f64>, size: f64) -> Option<GroupTerms> {
    let svd = thin_svd(rest.as_ref())?;
    let noise = 2.0 * f64::EPSILON * size;
    let kept = svd.values.iter().enumerate().take_while(|(_, s)| **s > noise);
    let column = |a: &Mat<f64>, k: usize| a.col(k).iter().copied().collect();
    Some(kept.map(|(k, s)| (column(&svd.left, k), *s, column(&svd.right, k))).collect())
}

/// H of one group of rows; none where it is nothing.
fn held(a: &Mat<f64>) -> Option<Mat<f64>> {
    let size = a.norm_l2();
    let qr = pivoted_qr(a.transpose().to_owned());
    let rank = (0..a.nrows()).take_while(|k| qr.r[(*k, *k)].abs() > 1e-12 * size).count();
    let q = qr.q.subcols(0, rank);
    let within = product(q.transpose(), product(a.as_ref(), q).as_ref());
    let symmetric = Mat::from_fn(rank, rank, |i, j| 0.5 * (within[(i, j)] + within[(j, i)]));
    let (values, vectors) = symmetric_eigen(symmetric.as_ref()).ok()?;
    let largest = (0..a.ncols()).map(|j| a.col(j).norm_l2()).fold(0.0, f64::max);
    let holds: Vec<usize> = (0..rank).filter(|k| values[*k] > HOLDS * largest).collect();
    if holds.is_empty() {
        return None;
    }
    let root = Mat::from_fn(rank, holds.len(), |i, k| vectors[(i, holds[k])] * values[holds[k]].sqrt());
    let root = product(q, root.as_ref());
    let held = product(root.as_ref(), root.transpose());
    // Products of the same two numbers in either order, and what is rounding beside them is none.
    let entry = |i: usize, j: usize| Some(held[(i.max(j), i.min(j))]).filter(|v| v.abs() > 1e-15 * largest);
    Some(Mat::from_fn(a.nrows(), a.nrows(), |i, j| entry(i, j).unwrap_or(0.0)))
}

/// The rows and columns that the entries connect, group by group.
fn groups(a: &SparseMatrix) -> Vec<Vec<usize>> {
    let stored = |j: usize| a.row_idx_of_col(j).zip(a.val_of_col(j)).map(move |(i, v)| ([i, j], *v));
    let entries: Vec<[usize; 2]> =
        (0..a.ncols()).flat_map(stored).filter(|(_, v)| *v != 0.0).map(|(place, _)| place).collect();
    let mut touched = vec![false; a.nrows()];
    entries.as_flattened().iter().for_each(|i| touched[*i] = true);
    let lowest = lowest_connected(a.nrows(), &entries);
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for i in (0..a.nrows()).filter(|i| touched[*i]) {
        groups.entry(lowest[i]).or_default().push(i);
    }
    groups.into_values().collect()
}

/// R as W k Wᵀ with at most `highest` directions; none where it takes more.
pub(super) fn low_rank(terms: Terms, highest: usize) -> Option<Coupling> {
    let rank = 2 * terms.len();
    if rank > highest {
        return None;
    }
    let none = || Mat::zeros(rank, rank);
    let mut coupling = Coupling { directions: Vec::new(), stiffness: none(), damping: none(), skew: None };
    for (k, (force, size, motion)) in terms.into_iter().enumerate() {
        coupling.stiffness[(2 * k, 2 * k + 1)] = size;
        coupling.directions.extend([force, motion]);
    }
    Some(coupling)
}

/// R = Σ f s mᵀ by its columns, those that are parallel in one term: the force f, of length one, its size s, and the motion m.
fn column_terms(rest: &SparseMatrix) -> Terms {
    let mut terms: Vec<Parallel> = Vec::new();
    let mut alike: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for j in 0..rest.ncols() {
        let entries = rest.row_idx_of_col(j).zip(rest.val_of_col(j).iter().copied());
        let entries: Vec<(usize, f64)> = entries.filter(|(_, v)| *v != 0.0).collect();
        if entries.is_empty() {
            continue;
        }
        let pattern: Vec<usize> = entries.iter().map(|(i, _)| *i).collect();
        let values: Vec<f64> = entries.iter().map(|(_, v)| *v).collect();
        let known = alike.entry(pattern).or_default();
        let factor = |values: &[f64], first: &[f64]| {
            let at = (0..first.len()).max_by(|a, b| first[*a].abs().total_cmp(&first[*b].abs())).unwrap_or(0);
            let factor = values[at] / first[at];
            let same = |(v, f): (&f64, &f64)| (v - factor * f).abs() <= PARALLEL * (factor * f).abs();
            values.iter().zip(first).all(same).then_some(factor)
        };
        let found = known.iter().find_map(|k| Some((*k, factor(&values, &terms[*k].0)?)));
        match found {
            Some((k, factor)) => terms[k].2.push((j, factor)),
            None => {
                known.push(terms.len());
                terms.push((values, SparseVector::from_entries(entries), vec![(j, 1.0)]));
            }
        }
    }
    let finish = |(values, force, motion): Parallel| {
        let size = values.iter().map(|v| v * v).sum::<f64>().sqrt();
        let unit = SparseVector::from_entries(force.iter().map(|(i, v)| (i, v / size)));
        (unit, size, SparseVector::from_entries(motion))
    };
    terms.into_iter().map(finish).collect()
}

/// A structure and the low-rank rest of K, unsymmetric as a whole, where its half ½(K + Kᵀ) has large negative eigenvalues: whichever
/// has fewest of these of
/// * K whose unequal pairs k_ij, k_ji both have the smaller value, as a friction force −μ k acts on one of the two alone;
/// * ½(K + Kᵀ) + |S|, S = ½(K − Kᵀ): with −μ k (t gᵀ + g tᵀ)/2 it adds ½ μ k (t − g)(t − g)ᵀ, which is not negative.
///
/// `sizes` are the largest entries of the rows of K and C; C's skew part is `damping`.
pub(super) fn parted(
    halves: &Halves,
    damping: &[Entry],
    sizes: [&[f64]; 2],
    mass: &SparseMatrix,
    engine: &Engine,
) -> Option<(SparseMatrix, Coupling)> {
    let k = &halves.symmetric;
    let n = k.nrows();
    let shift = LARGE_NEGATIVE * median_ratio(k, mass);
    let negative = |k: &SparseMatrix| {
        let pencil = add_scaled(&[(1.0, k), (shift, mass)]);
        engine.factorize(&pencil).map_or(usize::MAX, |factor| factor.inertia().negative)
    };
    let halved = negative(k);
    if halved == 0 {
        return None;
    }
    let damping = mirrored(damping);
    let sum = |entries: &[_]| {
        let moved = SparseMatrix::try_new_from_triplets(n, n, entries).ok()?;
        Some(add_scaled(&[(1.0, k), (1.0, &moved)]))
    };
    let (mut to_structure, mut rest) = (Vec::new(), Vec::new());
    for (i, j, v) in &halves.skew {
        let half = k.get(*i, *j).copied().unwrap_or(0.0);
        let (below, above) = (half + v, half - v);
        let (small, large) = (below.abs().min(above.abs()), below.abs().max(above.abs()));
        // Forces of equal size and opposite sign are gyroscopic or circulatory, not one-sided.
        let value = match small <= 0.5 * large {
            true if below.abs() < above.abs() => below,
            true => above,
            false => half,
        };
        to_structure.extend([entry(*i, *j, value - half), entry(*j, *i, value - half)]);
        rest.extend([(*i, *j, below - value), (*j, *i, above - value)]);
    }
    let structure = sum(&to_structure)?;
    let one_sided = negative(&structure);
    if one_sided == 0 {
        return Some((structure, grouped(n, &rest, &damping, sizes)?));
    }
    let mut coupling = grouped(n, &mirrored(&halves.skew), &damping, sizes)?;
    let s = &coupling.stiffness;
    let (squares, vectors) = symmetric_eigen(product(s.transpose(), s.as_ref()).as_ref()).ok()?;
    let root = Mat::from_fn(s.nrows(), s.nrows(), |i, j| vectors[(i, j)] * squares[j].max(0.0).sqrt());
    let size = product(root.as_ref(), vectors.transpose());
    let size = Mat::from_fn(s.nrows(), s.nrows(), |i, j| size[(i.max(j), i.min(j))]);
    coupling.stiffness -= &size;
    let none = Mat::zeros(size.nrows(), size.nrows());
    let whole =
        Coupling { directions: coupling.directions.clone(), stiffness: size, damping: none, skew: None };
    let [added, _] = whole.assembled(n).ok()?;
    let held = add_scaled(&[(1.0, k), (1.0, &Halves::of(&added).symmetric)]);
    match negative(&held) {
        held_negative if held_negative < one_sided.min(halved) => Some((held, coupling)),
        _ if one_sided < halved => Some((structure, grouped(n, &rest, &damping, sizes)?)),
        _ => None,
    }
}

/// The median of k_ii / m_ii where both are positive.
fn median_ratio(k: &SparseMatrix, mass: &SparseMatrix) -> f64 {
    let both = diagonal(k).into_iter().zip(diagonal(mass)).filter(|(k, m)| *k > 0.0 && *m > 0.0);
    let mut ratios: Vec<f64> = both.map(|(k, m)| k / m).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests;
