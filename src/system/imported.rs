//! Matrices from elsewhere as a [`Structure`] that is symmetric and a [`Coupling`] for the rest: of low rank, or as sparse
//! skew-symmetric matrices where the rank is high, as that of gyroscopic terms is.
//!
//! K = ½(K + Kᵀ) + W k Wᵀ and C = ½(C + Cᵀ) + W c Wᵀ with k and c skew. Friction and other unsymmetric terms act
//! between the few degrees of freedom of a contact, so the rows that the skew parts touch fall apart into many small
//! groups. Each group has its own columns of W: an orthonormal basis Q of the joint range of the two skew parts,
//! from a QR factorisation with column pivoting after the rows are scaled to the size of K and C. S = −Sᵀ has its
//! columns in the span of Q, hence its rows too, and S = Q (QᵀSQ) Qᵀ loses nothing but round-off.
//!
//! A skew entry s_ij = ½(a_ij − a_ji) is the difference of two sums that were rounded at the size of a, however small it is
//! itself: |ν_ij| ≤ p u √(r_i r_j), u = 2⁻⁵³, p the roundings of a sum and r_i the largest entry of row i. With every row scaled by
//! 1/√r the matrix [K C] of a group, m × 2m, has a noise of ‖ν‖ ≤ √2 m p u: no rank is seen in what is smaller.

use super::{Coupling, Damping, Skew, Structure};
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::dense::product;
use crate::linalg::matrix_market::MarketMatrix;
use crate::linalg::orthogonal::{PivotedQr, pivoted_qr};
use crate::linalg::sparse::{add_scaled, diagonal, entry, on_one_pattern};
use crate::linalg::{Engine, SparseMatrix, SparseVector};
use faer::Mat;
use std::collections::BTreeMap;

/// The largest rank of a coupling of low rank, and the part of the order n above which even a smaller one costs more than sparse
/// skew parts do; a rank up to [`SMALL_RANK`] is always low.
const LARGEST_RANK: usize = 2000;
const RANK_PART: usize = 10;
const SMALL_RANK: usize = 200;
/// |a_ij − a_ji| / 2 up to this part of √(r_i r_j), r the largest entry of a row, is rounding of the exporting program.
const ROUND_OFF: f64 = 1e-14;
/// p u: an entry that friction was added to has been rounded a few times at its own size.
const ENTRY_NOISE: f64 = 4.0 * 0.5 * f64::EPSILON;
/// The same as [`ROUND_OFF`] for M, which must be symmetric: what is larger is told.
const MASS_ROUND_OFF: f64 = 1e-12;

/// A row of M up to this part of the largest mass, without a positive diagonal entry, is zero: u ‖M‖, the change of M that
/// a backward error of rounding stands for.
const MASS_ZERO: f64 = 0.5 * f64::EPSILON;

/// Imported matrices, split.
#[derive(Debug, Clone)]
pub struct Imported {
    /// The symmetric part; Im K is the hysteretic damping.
    pub structure: Structure,
    /// The unsymmetric part.
    pub coupling: Option<Coupling>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

/// A matrix with the words that faults call it by.
#[derive(Debug, Clone, Copy)]
pub struct Given<'a> {
    /// Key and file.
    pub place: &'a str,
    /// Its entries.
    pub matrix: &'a MarketMatrix,
}

/// Splits M, C and K, each n × n.
///
/// M \[kg, kg m²\] must be real, symmetric, with no negative entry on its diagonal. C \[N s/m, N m s\] must be real. The
/// imaginary part of K \[N/m, N m\] must be symmetric: it is taken as that of K(1 + iη), for λ = σ + iω with ω > 0.
///
/// # Errors
/// Every fault at once: other sizes, parts that have no meaning here, a degree of freedom on which nothing acts.
pub fn split(mass: Given<'_>, damping: Option<Given<'_>>, stiffness: Given<'_>) -> Result<Imported> {
    let mut faults = Faults::new();
    let n = mass.matrix.re.nrows();
    for given in [Some(mass), damping, Some(stiffness)].into_iter().flatten() {
        let (rows, columns) = (given.matrix.re.nrows(), given.matrix.re.ncols());
        if rows != columns || rows != n {
            let expected = if rows == columns {
                format!("{n} × {n}, as the mass has it")
            } else {
                "a square matrix".to_string()
            };
            faults.push(Fault::new(given.place, format!("{rows} × {columns}"), expected));
        }
    }
    faults.into_result(())?;
    let mut faults = Faults::new();
    let exact_mass = with_exact_zeros(&mass.matrix.re);
    check_mass(mass, &exact_mass, &mut faults);
    if let Some(damping) = damping
        && has_entries(damping.matrix.im.as_ref())
    {
        faults.push(
            Fault::new(damping.place, "an imaginary part", "a real damping matrix")
                .with_help("Loss factors go into the imaginary part of the stiffness"),
        );
    }
    let hysteretic = stiffness.matrix.im.as_ref().filter(|im| has_entries(Some(im)));
    if let Some(h) = hysteretic
        && let Some(fault) = largest_skew(h, MASS_ROUND_OFF)
    {
        faults.push(
            Fault::new(stiffness.place, format!("an imaginary part with {fault}"), "one that is symmetric")
                .with_help("It is the hysteretic damping H of K + iH; gyroscopic terms go into the damping"),
        );
    }
    let halves = Halves::of(&stiffness.matrix.re);
    let damping_halves = damping.map(|given| Halves::of(&given.matrix.re));
    let size: Vec<f64> = row_sizes(&stiffness.matrix.re);
    let inertia = row_sizes(&exact_mass);
    let untouched: Vec<usize> = (0..n).filter(|i| size[*i] == 0.0 && inertia[*i] == 0.0).collect();
    if let Some(first) = untouched.first() {
        let found = format!("{} rows of zeros, row {} the first", untouched.len(), first + 1);
        faults.push(
            Fault::new(
                format!("{} and {}", mass.place, stiffness.place),
                found,
                "mass or stiffness in every row",
            )
            .with_help("Leave degrees of freedom out that nothing acts on"),
        );
    }
    let empty = Vec::new();
    let skew_damping = damping_halves.as_ref().map_or(&empty, |h| &h.skew);
    let damping_size = damping.map_or(vec![0.0; n], |given| row_sizes(&given.matrix.re));
    let coupling = couple(n, &halves.skew, skew_damping, [&size, &damping_size]);
    let mut warnings = Vec::new();
    if let Some(skew) = coupling.as_ref().and_then(|c| c.skew.as_ref()) {
        warnings.push(format!(
            "The matrices have a part that is not symmetric in {} of {n} rows, which is not of low rank: the complex modes are found by two-level Arnoldi with sparse unsymmetric factors, at several frequencies of the band",
            skew.rows()
        ));
    }
    faults.into_result(())?;
    let [mass, stiffness] = on_one_pattern(Halves::of(&exact_mass).symmetric, halves.symmetric);
    let structure = Structure {
        mass: mass.into(),
        stiffness: stiffness.into(),
        damping: Damping {
            viscous: damping_halves.map(|h| h.symmetric).filter(|c| has_entries(Some(c))).map(Into::into),
            modal: None,
            hysteretic: hysteretic.map(|h| Halves::of(h).symmetric.into()),
        },
        engine: Engine::default(),
    };
    Ok(Imported { structure, coupling, warnings })
}

fn has_entries(a: Option<&SparseMatrix>) -> bool {
    a.is_some_and(|a| a.val().iter().any(|v| *v != 0.0))
}

/// M whose rows and columns that are zero but for rounding ([`MASS_ZERO`]) have exact zeros.
fn with_exact_zeros(mass: &SparseMatrix) -> SparseMatrix {
    let (diagonal, size) = (diagonal(mass), row_sizes(mass));
    let largest = diagonal.iter().fold(0.0f64, |l, m| l.max(*m));
    let zero: Vec<bool> = (0..size.len())
        .map(|i| size[i] > 0.0 && diagonal[i] <= 0.0 && size[i] <= MASS_ZERO * largest)
        .collect();
    let mut exact = mass.clone();
    for j in (0..exact.ncols()).filter(|_| zero.contains(&true)) {
        let rows: Vec<usize> = exact.row_idx_of_col(j).collect();
        let entries = rows.iter().zip(exact.val_of_col_mut(j));
        entries.filter(|(i, _)| zero[**i] || zero[j]).for_each(|(_, v)| *v = 0.0);
    }
    exact
}

/// `exact` is M with exact zeros.
fn check_mass(mass: Given<'_>, exact: &SparseMatrix, faults: &mut Faults) {
    if has_entries(mass.matrix.im.as_ref()) {
        faults.push(Fault::new(mass.place, "an imaginary part", "a real mass matrix"));
    }
    if !has_entries(Some(&mass.matrix.re)) {
        faults.push(Fault::new(mass.place, "zeros only", "a mass matrix"));
    }
    if let Some(found) = largest_skew(&mass.matrix.re, MASS_ROUND_OFF) {
        faults.push(Fault::new(mass.place, found, "a symmetric mass matrix"));
    }
    let negative: Vec<(usize, f64)> =
        diagonal(exact).into_iter().enumerate().filter(|(_, m)| *m < 0.0).collect();
    if let Some((row, value)) = negative.first() {
        let found = format!("{value:e} in row and column {}", row + 1);
        let found =
            if negative.len() > 1 { format!("{found} and {} more", negative.len() - 1) } else { found };
        faults.push(Fault::new(mass.place, found, "masses of zero or more"));
    }
}

/// max_j |a_ij|, |a_ji| of every row i.
fn row_sizes(a: &SparseMatrix) -> Vec<f64> {
    let mut size = vec![0.0f64; a.nrows()];
    for j in 0..a.ncols() {
        for (i, v) in a.row_idx_of_col(j).zip(a.val_of_col(j)) {
            size[i] = size[i].max(v.abs());
            size[j] = size[j].max(v.abs());
        }
    }
    size
}

/// ½(A + Aᵀ), and the entries below the diagonal of ½(A − Aᵀ) that are more than rounding.
struct Halves {
    symmetric: SparseMatrix,
    skew: Vec<(usize, usize, f64)>,
}

impl Halves {
    fn of(a: &SparseMatrix) -> Self {
        let Ok(t) = a.transpose().to_col_major() else {
            // Only memory can fail here, and add_scaled would need more of it.
            return Halves { symmetric: a.clone(), skew: Vec::new() };
        };
        if t.col_ptr() == a.col_ptr() && t.row_idx() == a.row_idx() && t.val() == a.val() {
            return Halves { symmetric: t, skew: Vec::new() };
        }
        let size = row_sizes(a);
        let half = add_scaled(&[(0.5, a), (-0.5, &t)]);
        let mut skew = Vec::new();
        for j in 0..half.ncols() {
            for (i, v) in half.row_idx_of_col(j).zip(half.val_of_col(j)) {
                if i > j && v.abs() > ROUND_OFF * (size[i] * size[j]).sqrt() {
                    skew.push((i, j, *v));
                }
            }
        }
        Halves { symmetric: add_scaled(&[(0.5, a), (0.5, &t)]), skew }
    }
}

/// The worst pair of entries that ought to be equal, when it is beyond rounding, in words.
fn largest_skew(a: &SparseMatrix, round_off: f64) -> Option<String> {
    let size = row_sizes(a);
    let relative = |(i, j, v): &(usize, usize, f64)| v.abs() / (size[*i] * size[*j]).sqrt();
    let halves = Halves::of(a);
    let worst = halves.skew.iter().max_by(|a, b| relative(a).total_cmp(&relative(b)))?;
    let entry = |i: usize, j: usize| a.get(i, j).copied().unwrap_or(0.0);
    (relative(worst) > round_off).then(|| {
        let (i, j, _) = *worst;
        let (a, b) = (i + 1, j + 1);
        format!("{:e} in row {a}, column {b} but {:e} in row {b}, column {a}", entry(i, j), entry(j, i))
    })
}

/// Two square matrices on the rows of a group.
struct Group {
    rows: Vec<usize>,
    stiffness: Mat<f64>,
    damping: Mat<f64>,
}

/// W, k and c of the skew parts, or these themselves where their rank is high.
fn couple(
    n: usize,
    stiffness: &[(usize, usize, f64)],
    damping: &[(usize, usize, f64)],
    sizes: [&[f64]; 2],
) -> Option<Coupling> {
    if stiffness.is_empty() && damping.is_empty() {
        return None;
    }
    let highest = (n / RANK_PART).clamp(SMALL_RANK, LARGEST_RANK);
    // A dense group of more rows than this is not worth looking for its rank.
    let Some(groups) = groups(n, stiffness, damping, 2 * highest) else {
        return Some(Coupling::sparse(Skew::new(n, stiffness, damping)));
    };
    let mut parts: Vec<(Vec<SparseVector>, Mat<f64>, Mat<f64>)> = Vec::new();
    let mut rank = 0;
    for group in &groups {
        parts.push(factor(group, sizes));
        rank += parts[parts.len() - 1].0.len();
    }
    if rank > highest {
        return Some(Coupling::sparse(Skew::new(n, stiffness, damping)));
    }
    if rank == 0 {
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
    fn new(n: usize, stiffness: &[(usize, usize, f64)], damping: &[(usize, usize, f64)]) -> Self {
        let whole = |list: &[(usize, usize, f64)]| {
            let both: Vec<_> =
                list.iter().flat_map(|(i, j, v)| [entry(*i, *j, *v), entry(*j, *i, -v)]).collect();
            SparseMatrix::try_new_from_triplets(n, n, &both).expect("indices of a matrix")
        };
        Skew { stiffness: whole(stiffness).into(), damping: whole(damping).into() }
    }

    /// How many rows have an entry.
    fn rows(&self) -> usize {
        let [k, c] = [&self.stiffness, &self.damping];
        (0..k.ncols())
            .filter(|j| !k.row_idx_of_col_raw(*j).is_empty() || !c.row_idx_of_col_raw(*j).is_empty())
            .count()
    }
}

/// The rows that the skew parts connect, group by group, in the order of their first row; none where a group has more than
/// `most` rows.
fn groups(
    n: usize,
    stiffness: &[(usize, usize, f64)],
    damping: &[(usize, usize, f64)],
    most: usize,
) -> Option<Vec<Group>> {
    let mut parent: Vec<usize> = (0..n).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    for (i, j, _) in stiffness.iter().chain(damping) {
        let (a, b) = (root(&mut parent, *i), root(&mut parent, *j));
        parent[a.max(b)] = a.min(b);
    }
    let mut rows: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut touched: Vec<usize> = stiffness.iter().chain(damping).flat_map(|(i, j, _)| [*i, *j]).collect();
    touched.sort_unstable();
    touched.dedup();
    let mut place = vec![(0, 0); n];
    for i in touched {
        let first = root(&mut parent, i);
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
            matrix[(b, a)] = -*v;
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
    let both = Mat::from_fn(m, 2 * m, |i, j| if j < m { k[(i, j)] } else { c[(i, j - m)] });
    let unit = |rows: &[usize]| rows.iter().map(|i| SparseVector::from_entries([(*i, 1.0)])).collect();
    let PivotedQr { q, r, .. } = pivoted_qr(both);
    let noise = std::f64::consts::SQRT_2 * m as f64 * ENTRY_NOISE;
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
    /// Of sparse skew parts alone.
    pub fn sparse(skew: Skew) -> Self {
        let none = || Mat::zeros(0, 0);
        Coupling { directions: Vec::new(), stiffness: none(), damping: none(), skew: Some(skew) }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::samples;

    fn real(re: SparseMatrix) -> MarketMatrix {
        MarketMatrix { re, im: None }
    }

    fn given(matrix: &MarketMatrix) -> Given<'_> {
        Given { place: "`matrices.stiffness` k.mtx", matrix }
    }

    /// K of a plate plus friction-like terms: n points that couple three rows each, in units far apart.
    fn with_friction(points: usize, unit: f64) -> (SparseMatrix, SparseMatrix) {
        let (k, m) = samples::plate(8, false);
        let (n, mut triplets) = (k.nrows(), Vec::new());
        for p in 0..points {
            let [w, t, r] = [3 * p, 3 * p + 1, 3 * p + 2];
            for (row, factor) in [(w, 1e4), (t, 4e3 * unit), (r, -3e3 * unit)] {
                triplets.push(entry(row, w, factor));
                triplets.push(entry(row, n - 3, -factor));
            }
        }
        let contact = SparseMatrix::try_new_from_triplets(n, n, &triplets).unwrap();
        (add_scaled(&[(1.0, &k), (1.0, &contact)]), m)
    }

    #[test]
    fn the_parts_add_up_to_what_was_given() {
        for (points, unit) in [(1, 1.0), (5, 1e-9), (9, 1.0)] {
            let (k, m) = with_friction(points, unit);
            let imported =
                split(given(&real(m)), Some(given(&real(k.clone()))), given(&real(k.clone()))).unwrap();
            let coupling = imported.coupling.unwrap();
            // The points share one dof, hence one group: ½ skew of g tᵀ per point has rank 2 for all that share t.
            assert!(coupling.directions.len() <= 2 * points, "{} of {points}", coupling.directions.len());
            let [rest, rest_c] = coupling.assembled(k.nrows()).unwrap();
            let viscous = imported.structure.damping.viscous.unwrap();
            let size = row_sizes(&k);
            for (symmetric, rest) in [(&imported.structure.stiffness, &rest), (&viscous, &rest_c)] {
                let difference = add_scaled(&[(1.0, &k), (-1.0, symmetric), (-1.0, rest)]);
                for j in 0..k.ncols() {
                    for (i, v) in difference.row_idx_of_col(j).zip(difference.val_of_col(j)) {
                        assert!(v.abs() <= 4e-15 * (size[i] * size[j]).sqrt(), "{i} {j} {v:e}");
                    }
                }
                let t = symmetric.transpose().to_col_major().unwrap();
                assert_eq!(t.val(), symmetric.val());
            }
        }
    }

    /// Two discs' worth of contact pairs, each friction term a moment about a slanted axis and far smaller than the
    /// entries of K that it is added to.
    #[test]
    fn rounding_of_small_terms_on_large_entries_is_no_rank() {
        let (k, m) = samples::plate(12, false);
        let (n, pairs) = (k.nrows(), 20);
        for size in [1e-2, 1e-5, 1e-7] {
            let mut triplets = Vec::new();
            for p in 0..pairs {
                let angle = 0.3 + p as f64;
                let [upper, lower] = [3 * p, n - 3 - 3 * p];
                for moment in [upper, lower] {
                    for (row, part) in [(moment + 1, angle.cos()), (moment + 2, angle.sin())] {
                        let scale = size * (k[(row, row)] * k[(upper, upper)]).sqrt() * part;
                        triplets.push(entry(row, upper, scale));
                        triplets.push(entry(row, lower, -scale));
                    }
                }
            }
            let friction = SparseMatrix::try_new_from_triplets(n, n, &triplets).unwrap();
            let noisy = add_scaled(&[(1.0, &k), (1.0, &friction)]);
            let damping = add_scaled(&[(1e-5, &k), (3.0, &m), (1e-6, &friction)]);
            let (k, c) = (real(noisy), real(damping));
            let coupling = split(given(&real(m.clone())), Some(given(&c)), given(&k)).unwrap().coupling;
            assert_eq!(coupling.unwrap().directions.len(), 2 * pairs, "{size:e}");
        }
    }

    #[test]
    fn groups_that_do_not_meet_stay_apart_and_sparse() {
        let (k, m) = samples::plate(8, false);
        let triplets: Vec<_> = (0..6).map(|p| entry(9 * p, 9 * p + 1, 1e3)).collect();
        let friction = SparseMatrix::try_new_from_triplets(k.nrows(), k.nrows(), &triplets).unwrap();
        let k = add_scaled(&[(1.0, &k), (1.0, &friction)]);
        let coupling = split(given(&real(m)), None, given(&real(k))).unwrap().coupling.unwrap();
        assert_eq!(coupling.directions.len(), 12);
        assert!(coupling.directions.iter().all(|d| d.indices().len() == 1));
        assert!((coupling.stiffness[(0, 1)] - 500.0).abs() < 1e-9 && coupling.stiffness[(0, 2)] == 0.0);
    }

    #[test]
    fn rounding_of_the_exporter_is_no_coupling_and_a_loss_factor_is_hysteretic() {
        let (k, m) = samples::plate(6, false);
        let mut rounded = k.clone();
        rounded.val_of_col_mut(5)[0] *= 1.0 + 4.0 * f64::EPSILON;
        let im = add_scaled(&[(0.01, &k)]);
        let lossy = MarketMatrix { re: rounded, im: Some(im.clone()) };
        let imported = split(given(&real(m)), None, given(&lossy)).unwrap();
        assert!(imported.coupling.is_none() && imported.structure.damping.viscous.is_none());
        let hysteretic = imported.structure.damping.hysteretic.unwrap();
        assert!(hysteretic.val().iter().zip(im.val()).all(|(a, b)| (a - b).abs() <= 1e-11));
    }

    #[test]
    fn what_has_no_meaning_is_refused_all_at_once() {
        let (k, m) = with_friction(2, 1.0);
        let complex = |re: &SparseMatrix, im: &SparseMatrix| MarketMatrix {
            re: add_scaled(&[(1.0, re), (0.0, im)]),
            im: Some(add_scaled(&[(0.0, re), (1.0, im)])),
        };
        let mut bad_mass = add_scaled(&[(1.0, &k)]);
        bad_mass.val_of_col_mut(0)[0] = -1.0;
        let (bad_mass, c, lossy) = (real(bad_mass), complex(&m, &m), complex(&m, &k));
        let text = split(given(&bad_mass), Some(given(&c)), given(&lossy)).unwrap_err().to_string();
        for part in ["4 faults", "symmetric mass", "masses of zero", "real damping", "imaginary part with"] {
            assert!(text.contains(part), "{part} not in\n{text}");
        }
        let small = real(samples::plate(5, false).1);
        let text = split(given(&small), None, given(&real(k.clone()))).unwrap_err().to_string();
        assert!(text.contains("as the mass has it"), "{text}");
        let n = k.nrows();
        let hole = SparseMatrix::try_new_from_triplets(n, n, &[entry(0, 0, 1.0)]).unwrap();
        let hole = real(hole);
        let text = split(given(&hole), None, given(&hole)).unwrap_err().to_string();
        assert!(text.contains(&format!("{} rows of zeros, row 2", n - 1)), "{text}");
    }

    #[test]
    fn masses_that_are_zero_but_for_rounding_are_zero() {
        let diagonal = |m: &[f64]| {
            let entries: Vec<_> = m.iter().enumerate().map(|(i, m)| entry(i, i, *m)).collect();
            real(SparseMatrix::try_new_from_triplets(m.len(), m.len(), &entries).unwrap())
        };
        let k = diagonal(&[1.0; 4]);
        let mass = split(given(&diagonal(&[1e-6, -1e-27, 3e-18, 2e-7])), None, given(&k)).unwrap();
        let mass = mass.structure.mass;
        assert_eq!([0, 1, 2, 3].map(|i| mass[(i, i)]), [1e-6, 0.0, 3e-18, 2e-7]);
        let error = split(given(&diagonal(&[1e-6, -1e-20, 1e-7, 2e-7])), None, given(&k)).unwrap_err();
        assert!(error.to_string().contains("masses of zero or more"), "{error}");
    }

    #[test]
    fn a_skew_part_of_high_rank_stays_sparse() {
        let n = 5000;
        let triplets: Vec<_> = (0..n)
            .flat_map(|i| [(i, i, 2.0), (i, (i + 1) % n, 0.5)])
            .map(|(i, j, v)| entry(i, j, v))
            .collect();
        let k = real(SparseMatrix::try_new_from_triplets(n, n, &triplets).unwrap());
        let ones: Vec<_> = (0..n).map(|i| entry(i, i, 1.0)).collect();
        let m = real(SparseMatrix::try_new_from_triplets(n, n, &ones).unwrap());
        let imported = split(given(&m), Some(given(&k)), given(&k)).unwrap();
        assert!(imported.warnings[0].contains("5000 of 5000 rows"), "{:?}", imported.warnings);
        let coupling = imported.coupling.unwrap();
        assert!(coupling.directions.is_empty());
        let [rest, rest_c] = coupling.assembled(n).unwrap();
        for (symmetric, rest) in
            [(imported.structure.stiffness, rest), (imported.structure.damping.viscous.unwrap(), rest_c)]
        {
            assert_eq!((rest.get(0, 1), rest.get(1, 0)), (Some(&0.25), Some(&-0.25)));
            let difference = add_scaled(&[(1.0, &k.re), (-1.0, &symmetric), (-1.0, &rest)]);
            assert!(difference.val().iter().all(|v| *v == 0.0));
        }
    }
}
