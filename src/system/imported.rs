//! Matrices from elsewhere as a [`Structure`] that is symmetric and a [`Coupling`] for the rest: of low rank, or as sparse
//! skew-symmetric matrices where the rank is high, as that of gyroscopic terms is.

use super::friction::{divided, low_rank, parted};
use super::halves::{Halves, ROUND_OFF, row_sizes};
use super::low_rank::{couple, highest_rank};
use super::{Coupling, Damping, Structure};
use crate::error::{Fault, Faults, Result};
use crate::linalg::matrix_market::{MarketMatrix, one_triangle};
use crate::linalg::sparse::{add_scaled, diagonal, on_one_pattern};
use crate::linalg::{Engine, SparseMatrix};
use crate::numbers::typed;

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

/// Splits M, C and K, each n × n. Of the terms `friction` of K, which are not symmetric, what holds joins the structure, and the
/// rest stays whole; the same of K itself where ½(K + Kᵀ) is indefinite by what is not symmetric in it.
///
/// M \[kg, kg m²\] must be real, symmetric, with no negative entry on its diagonal. C \[N s/m, N m s\] must be real. The
/// imaginary part of K \[N/m, N m\] must be symmetric: it is taken as that of K(1 + iη), for λ = σ + iω with ω > 0.
///
/// # Errors
/// Every fault at once: other sizes, parts that have no meaning here, a degree of freedom on which nothing acts.
pub fn split(
    mass: Given<'_>,
    damping: Option<Given<'_>>,
    stiffness: Given<'_>,
    friction: &[SparseMatrix],
) -> Result<Imported> {
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
    if let Some(h) = hysteretic {
        faults.0.extend(hysteretic_skew(stiffness.place, h));
    }
    let highest = highest_rank(n);
    let mut coupling: Option<Coupling> = None;
    let mut add = |rest: Coupling| coupling = Some(coupling.take().map_or(rest.clone(), |c| c.with(rest)));
    let mut terms = vec![];
    for term in friction {
        let (holds, rest) = divided(term);
        terms.push(match low_rank(rest, highest) {
            Some(rest) => {
                add(rest);
                holds
            }
            None => term.clone(),
        });
    }
    let all: Vec<_> = std::iter::once(&stiffness.matrix.re).chain(&terms).map(|k| (1.0, k)).collect();
    let whole = if terms.is_empty() { stiffness.matrix.re.clone() } else { add_scaled(&all) };
    let mut halves = Halves::of(&whole);
    let mut damping_halves = damping.map(|given| Halves::of(&given.matrix.re));
    let size: Vec<f64> = row_sizes(&whole);
    let inertia = row_sizes(&exact_mass);
    if let Some(fault) = multipliers(&whole, &inertia, &size, [mass.place, stiffness.place]) {
        faults.push(fault);
    }
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
    faults.into_result(())?;
    let mut warnings = Vec::new();
    let damping_size = damping.map_or(vec![0.0; n], |given| row_sizes(&given.matrix.re));
    warnings.extend(halves.without_rounding(&size, stiffness.place));
    if let (Some(halves), Some(given)) = (&mut damping_halves, damping) {
        warnings.extend(halves.without_rounding(&damping_size, given.place));
    }
    let skew_damping = damping_halves.as_ref().map_or(&[][..], |h| &h.skew);
    let sizes: [&[f64]; 2] = [&size, &damping_size];
    let parted = (!halves.skew.is_empty())
        .then(|| parted(&halves, skew_damping, sizes, &exact_mass, &Engine::default()))
        .flatten();
    match parted {
        Some((structure, rest)) => {
            add(rest);
            halves.symmetric = structure;
        }
        None => {
            if let Some(rest) = couple(n, &halves.skew, skew_damping, sizes) {
                add(rest);
            }
        }
    }
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

/// Rows without mass whose diagonal entry of K is not positive though others are there: constraints, which make K indefinite, so
/// that no count of modes below a frequency holds.
fn multipliers(k: &SparseMatrix, inertia: &[f64], size: &[f64], places: [&str; 2]) -> Option<Fault> {
    let diagonal = diagonal(k);
    let constraint = |i: &usize| inertia[*i] == 0.0 && size[*i] > 0.0 && diagonal[*i] <= ROUND_OFF * size[*i];
    let rows: Vec<usize> = (0..size.len()).filter(constraint).collect();
    let first = *rows.first()?;
    let more = if rows.len() > 1 { format!(" and {} more", rows.len() - 1) } else { String::new() };
    let found = format!(
        "row {}{more} with no mass, {} on the diagonal of the stiffness and entries up to {} beside it",
        first + 1,
        typed(diagonal[first]),
        typed(size[first])
    );
    let expected = "mass or a positive stiffness of its own in every row";
    Some(Fault::new(places.join(" and "), found, expected).with_help(
        "Such rows are Lagrange multipliers of constraints: export the matrices with the constraints eliminated, or give each a stiff spring in their place",
    ))
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
    if !zero.contains(&true) {
        return exact;
    }
    for j in 0..exact.ncols() {
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
    faults.0.extend(mass_skew(mass.place, &mass.matrix.re));
    let negative: Vec<(usize, f64)> =
        diagonal(exact).into_iter().enumerate().filter(|(_, m)| *m < 0.0).collect();
    if let Some((row, value)) = negative.first() {
        let found = format!("{value:e} in row and column {}", row + 1);
        let found =
            if negative.len() > 1 { format!("{found} and {} more", negative.len() - 1) } else { found };
        faults.push(Fault::new(mass.place, found, "masses of zero or more"));
        return;
    }
    faults.0.extend(
        indefinite(exact)
            .map(|found| Fault::new(mass.place, found, "a mass matrix that is positive semidefinite")),
    );
}

/// How many times m_ii m_jj the square of m_ij may be where a program wrote three digits.
const WRITTEN_WITH_FEW_DIGITS: f64 = 1.01;

/// The first pair of rows that alone have a negative kinetic energy: m_ij² > m_ii m_jj.
fn indefinite(mass: &SparseMatrix) -> Option<String> {
    let own = diagonal(mass);
    let beyond = |i: usize, j: usize, m: f64| {
        i > j && own[i] * own[j] > 0.0 && m * m > WRITTEN_WITH_FEW_DIGITS * own[i] * own[j]
    };
    (0..mass.ncols()).find_map(|j| {
        let mut entries = mass.row_idx_of_col(j).zip(mass.val_of_col(j));
        let (i, m) = entries.find(|(i, m)| beyond(*i, j, **m))?;
        let [a, b] = [own[j], own[i]].map(|m| format!("{m:e}"));
        Some(format!(
            "{m:e} in row {} and column {}, more than the root of {a} × {b} on the diagonal",
            i + 1,
            j + 1
        ))
    })
}

/// The fault of a mass matrix that is not symmetric.
pub fn mass_skew(place: &str, mass: &SparseMatrix) -> Option<Fault> {
    let found = largest_skew(mass, MASS_ROUND_OFF)?;
    let fault = Fault::new(place, found, "a symmetric mass matrix");
    Some(match half(mass) {
        Some(help) => fault.with_help(help),
        None => fault,
    })
}

/// The fault of an imaginary part of a stiffness that is not symmetric.
pub fn hysteretic_skew(place: &str, h: &SparseMatrix) -> Option<Fault> {
    let found = format!("an imaginary part with {}", largest_skew(h, MASS_ROUND_OFF)?);
    let other = "It is the hysteretic damping H of K + iH; gyroscopic terms go into the damping";
    Some(Fault::new(place, found, "one that is symmetric").with_help(half(h).unwrap_or(other.to_string())))
}

/// What to do about a matrix that has one triangle where it must be symmetric.
fn half(a: &SparseMatrix) -> Option<String> {
    let (triangle, count) = one_triangle(a, None)?;
    let entries = if count == 1 { "The one entry" } else { "All entries" };
    Some(format!(
        "{entries} off the diagonal ({count}) in the {triangle} triangle: if it is half of a symmetric matrix, its header has to say \
         `symmetric` in place of `general`, with the lower triangle in the file"
    ))
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

#[cfg(test)]
mod tests;
