//! What is not symmetric in imported matrices as a coupling of low rank.
//!
//! K = ½(K + Kᵀ) + W k Wᵀ and C = ½(C + Cᵀ) + W c Wᵀ with k and c skew. Friction and other unsymmetric terms act
//! between the few degrees of freedom of a contact, so the rows that the skew parts touch fall apart into many small
//! groups. Each group has its own columns of W: an orthonormal basis Q of the joint range of the two skew parts,
//! from a QR factorisation with column pivoting after the rows are scaled to the size of K and C. S = −Sᵀ has its
//! columns in the span of Q, hence its rows too, and S = Q (QᵀSQ) Qᵀ loses nothing but round-off.
//!
//! A skew entry s_ij = ½(a_ij − a_ji) is the difference of two sums that were rounded at the size of a, however small it is
//! itself: |ν_ij| ≤ p u √(r_i r_j), u = 2⁻⁵³, p the roundings of a sum and r_i the largest entry of row i. With every row scaled by
//! 1/√r the matrix [K Kᵀ C Cᵀ] of a group, m × 4m, has a noise of ‖ν‖ ≤ 2 m p u: no rank is seen in what is smaller.

use super::halves::{Entry, mirrored};
use super::{Coupling, Skew};
use crate::connected::lowest_connected;
use crate::error::{Error, Result};
use crate::linalg::dense::product;
use crate::linalg::orthogonal::{PivotedQr, pivoted_qr};
use crate::linalg::sparse::{add_scaled, entry};
use crate::linalg::{SparseMatrix, SparseVector};
use faer::Mat;
use std::collections::BTreeMap;

/// The largest rank of a coupling of low rank, and the part of the order n above which even a smaller one costs more than sparse
/// skew parts do; a rank up to [`SMALL_RANK`] is always low.
const LARGEST_RANK: usize = 2000;
const RANK_PART: usize = 10;
const SMALL_RANK: usize = 200;
/// p u: an entry that friction was added to has been rounded a few times at its own size.
const ENTRY_NOISE: f64 = 4.0 * 0.5 * f64::EPSILON;

/// The largest rank of a coupling of low rank, on n rows.
pub(super) fn highest_rank(n: usize) -> usize {
    (n / RANK_PART).clamp(SMALL_RANK, LARGEST_RANK)
}

/// Two square matrices on the rows of a group.
struct Group {
    rows: Vec<usize>,
    stiffness: Mat<f64>,
    damping: Mat<f64>,
}

/// W, k and c of the skew parts, or these themselves where their rank is high.
pub(super) fn couple(
    n: usize,
    stiffness: &[Entry],
    damping: &[Entry],
    sizes: [&[f64]; 2],
) -> Option<Coupling> {
    if stiffness.is_empty() && damping.is_empty() {
        return None;
    }
    match grouped(n, &mirrored(stiffness), &mirrored(damping), sizes) {
        None => Some(Coupling::sparse(Skew::new(n, stiffness, damping))),
        Some(coupling) => Some(coupling).filter(|coupling| !coupling.directions.is_empty()),
    }
}

/// W, k and c of entries of K and C, whatever these are; none where the rank is high.
pub(super) fn grouped(
    n: usize,
    stiffness: &[Entry],
    damping: &[Entry],
    sizes: [&[f64]; 2],
) -> Option<Coupling> {
    let highest = highest_rank(n);
    // A dense group of more rows than this is not worth looking for its rank.
    let groups = groups(n, stiffness, damping, 2 * highest)?;
    let mut parts: Vec<(Vec<SparseVector>, Mat<f64>, Mat<f64>)> = Vec::new();
    let mut rank = 0;
    for group in &groups {
        parts.push(factor(group, sizes));
        rank += parts[parts.len() - 1].0.len();
    }
    if rank > highest {
        return None;
    }
    let (mut k, mut c) = (Mat::zeros(rank, rank), Mat::zeros(rank, rank));
    let mut directions = Vec::new();
    for (part, stiffness, damping) in parts {
        let (first, m) = (directions.len(), part.len());
        k.as_mut().submatrix_mut(first, first, m, m).copy_from(&stiffness);
        c.as_mut().submatrix_mut(first, first, m, m).copy_from(&damping);
        directions.extend(part);
    }
    Some(Coupling { directions, stiffness: k, damping: c, skew: None })
}

impl Skew {
    /// From the entries below the diagonal of both.
    fn new(n: usize, stiffness: &[Entry], damping: &[Entry]) -> Self {
        let whole = |list: &[Entry]| {
            let both: Vec<_> =
                list.iter().flat_map(|(i, j, v)| [entry(*i, *j, *v), entry(*j, *i, -v)]).collect();
            SparseMatrix::try_new_from_triplets(n, n, &both).expect("indices of a matrix")
        };
        Skew { stiffness: whole(stiffness).into(), damping: whole(damping).into() }
    }
}

/// The rows that the skew parts connect, group by group, in the order of their first row; none where a group has more than
/// `most` rows.
fn groups(n: usize, stiffness: &[Entry], damping: &[Entry], most: usize) -> Option<Vec<Group>> {
    let lowest = lowest_connected(n, stiffness.iter().chain(damping).map(|(i, j, _)| [*i, *j]));
    let mut rows: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut touched: Vec<usize> = stiffness.iter().chain(damping).flat_map(|(i, j, _)| [*i, *j]).collect();
    touched.sort_unstable();
    touched.dedup();
    let mut place = vec![(0, 0); n];
    for i in touched {
        let first = lowest[i];
        let list = rows.entry(first).or_default();
        place[i] = (first, list.len());
        list.push(i);
    }
    if rows.values().any(|rows| rows.len() > most) {
        return None;
    }
    let mut groups: BTreeMap<usize, Group> = rows
        .into_iter()
        .map(|(first, rows)| {
            let m = rows.len();
            (first, Group { rows, stiffness: Mat::zeros(m, m), damping: Mat::zeros(m, m) })
        })
        .collect();
    for (list, which) in [(stiffness, 0), (damping, 1)] {
        for (i, j, v) in list {
            let ((first, a), (_, b)) = (place[*i], place[*j]);
            let group = groups.get_mut(&first).expect("made from the same entries");
            let matrix = if which == 0 { &mut group.stiffness } else { &mut group.damping };
            matrix[(a, b)] = *v;
        }
    }
    Some(groups.into_values().collect())
}

/// The columns of W of one group with k and c on them; `sizes` are the largest entries of the rows of all K and all C.
fn factor(group: &Group, sizes: [&[f64]; 2]) -> (Vec<SparseVector>, Mat<f64>, Mat<f64>) {
    let m = group.rows.len();
    // κ brings C to the size of K, and r_i is the larger of the two in row i: with D = diag(1/√r) neither D K D nor
    // κ D C D has an entry, or noise of an entry, above that of a matrix of ones. W = D⁻¹Q.
    let largest = |size: &[f64]| group.rows.iter().map(|i| size[*i]).fold(0.0, f64::max);
    let (k_size, c_size) = (largest(sizes[0]), largest(sizes[1]));
    let kappa = if k_size > 0.0 && c_size > 0.0 { k_size / c_size } else { 1.0 };
    let d: Vec<f64> =
        group.rows.iter().map(|i| sizes[0][*i].max(kappa * sizes[1][*i]).sqrt().recip()).collect();
    let scaled = |s: &Mat<f64>, factor: f64| Mat::from_fn(m, m, |i, j| d[i] * s[(i, j)] * d[j] * factor);
    let (k, c) = (scaled(&group.stiffness, 1.0), scaled(&group.damping, kappa));
    // Columns and rows of both; rows of a skew part are its columns again.
    let both = Mat::from_fn(m, 4 * m, |i, j| match j / m {
        0 => k[(i, j)],
        1 => k[(j - m, i)],
        2 => c[(i, j - 2 * m)],
        _ => c[(j - 3 * m, i)],
    });
    let unit = |rows: &[usize]| rows.iter().map(|i| SparseVector::from_entries([(*i, 1.0)])).collect();
    let PivotedQr { q, r, .. } = pivoted_qr(both);
    let noise = 2.0 * m as f64 * ENTRY_NOISE;
    // The rows of R from the pivot on are what the directions before it do not span.
    let mut left = 0.0f64;
    let mut rank = m;
    while rank > 0 {
        left = left.hypot(r.row(rank - 1).norm_l2());
        if left > noise {
            break;
        }
        rank -= 1;
    }
    if rank == m {
        return (unit(&group.rows), group.stiffness.clone(), group.damping.clone());
    }
    let q = q.subcols(0, rank).to_owned();
    let within = |s: &Mat<f64>| product(q.transpose(), product(s.as_ref(), q.as_ref()).as_ref());
    let (small_k, small_c) = (within(&k), within(&c));
    // Twice: what the columns lose, the rows lose too.
    let lost = |s: &Mat<f64>, small: &Mat<f64>| {
        let kept = product(product(q.as_ref(), small.as_ref()).as_ref(), q.transpose());
        (s - kept).norm_l2() > 2.0 * noise
    };
    if lost(&k, &small_k) || lost(&c, &small_c) {
        return (unit(&group.rows), group.stiffness.clone(), group.damping.clone());
    }
    let direction = |j: usize| SparseVector::from_entries((0..m).map(|i| (group.rows[i], q[(i, j)] / d[i])));
    ((0..rank).map(direction).collect(), small_k, small_c * faer::Scale(kappa.recip()))
}

impl Coupling {
    /// Both couplings in one; sparse parts of either stay.
    pub(super) fn with(self, other: Coupling) -> Coupling {
        let (m, all) = (self.directions.len(), self.directions.len() + other.directions.len());
        let both = |a: &Mat<f64>, b: &Mat<f64>| {
            Mat::from_fn(all, all, |i, j| match (i < m, j < m) {
                (true, true) => a[(i, j)],
                (false, false) => b[(i - m, j - m)],
                _ => 0.0,
            })
        };
        Coupling {
            stiffness: both(&self.stiffness, &other.stiffness),
            damping: both(&self.damping, &other.damping),
            directions: self.directions.into_iter().chain(other.directions).collect(),
            skew: self.skew.or(other.skew),
        }
    }

    /// Of sparse skew parts alone.
    pub fn sparse(skew: Skew) -> Self {
        let none = || Mat::zeros(0, 0);
        Coupling { directions: Vec::new(), stiffness: none(), damping: none(), skew: Some(skew) }
    }

    /// Whether K gains something.
    pub fn has_stiffness(&self) -> bool {
        let skew = self.skew.as_ref().is_some_and(|skew| skew.stiffness.val().iter().any(|v| *v != 0.0));
        skew || self.stiffness.norm_max() > 0.0
    }

    /// W k Wᵀ and W c Wᵀ with the sparse skew parts, as sparse matrices, for writing.
    pub fn assembled(&self, n: usize) -> Result<[SparseMatrix; 2]> {
        let whole = |small: &Mat<f64>| {
            let mut triplets = Vec::new();
            for (a, left) in self.directions.iter().enumerate() {
                for (b, right) in self.directions.iter().enumerate().filter(|(b, _)| small[(a, *b)] != 0.0) {
                    for (i, x) in left.iter() {
                        triplets.extend(right.iter().map(|(j, y)| entry(i, j, x * small[(a, b)] * y)));
                    }
                }
            }
            SparseMatrix::try_new_from_triplets(n, n, &triplets).map_err(|e| {
                Error::analysis("coupling", format!("{e:?}"), "Its directions lie outside the system")
            })
        };
        let [k, c] = [whole(&self.stiffness)?, whole(&self.damping)?];
        Ok(match &self.skew {
            Some(skew) => [(&k, &skew.stiffness), (&c, &skew.damping)]
                .map(|(low, skew)| add_scaled(&[(1.0, low), (1.0, skew)])),
            None => [k, c],
        })
    }
}
