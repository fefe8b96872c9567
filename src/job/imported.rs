//! A case made of matrices: files → a system, with the contact points and the places of rows that the case gives.

use super::table::{MOST_FAULTS, TextTable};
use crate::case::{Case, Contact, ContactPoints, Matrices};
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::matrix_files::{self, Found, Label, Labelled};
use crate::linalg::matrix_market::MarketMatrix;
use crate::linalg::sparse::{add_scaled, diagonal};
use crate::linalg::{SparseMatrix, SparseVector};
use crate::structure::{Assembled, FreeDof};
use crate::system::{ContactPoint, Coupling, Given, hysteretic_skew, is_unsymmetric, mass_skew, split};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The names of the six motions in the table of rows.
const MOTIONS: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];
/// The columns that the table of rows must have, and those that it may have.
const ROW_COLUMNS: [&[&str]; 2] =
    [&["node"], &["dof", "node", "ux", "uy", "uz", "rx", "ry", "rz", "x", "y", "z"]];
/// The same of the table of contact points.
const POINT_COLUMNS: [&[&str]; 2] =
    [&["normal", "t1"], &["normal", "t1", "t2", "weight", "gap", "speed", "x", "y", "z"]];

/// A file and what the name of a matrix in it begins with.
type MatrixPath = (PathBuf, char);

/// Matrices that were read, by their files: cases whose factors of terms differ share them.
#[derive(Debug, Default)]
pub struct MatrixFiles(Mutex<BTreeMap<MatrixPath, Arc<MarketMatrix>>>);

impl MatrixFiles {
    fn known(&self) -> MutexGuard<'_, BTreeMap<MatrixPath, Arc<MarketMatrix>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The matrix in a file, kept for the next one who asks where `again` says that there may be one; `columns` and `initial` as in
    /// [`matrix_files::read`].
    fn read(&self, path: &Path, initial: char, columns: usize, again: bool) -> Result<Arc<MarketMatrix>> {
        let key = (path.to_path_buf(), initial);
        if let Some(known) = self.known().get(&key) {
            return Ok(known.clone());
        }
        let matrix = match matrix_files::read(path, initial, columns)? {
            Found::Whole(matrix) => matrix,
            Found::Labelled(matrix) => matrix.numbered(&matrix.labels().into_iter().collect::<Vec<_>>())?,
        };
        let matrix = Arc::new(matrix);
        if again {
            self.known().insert(key, matrix.clone());
        }
        Ok(matrix)
    }

    /// Reads the matrices whose rows are of nodes: each of them has the rows of all, ascending by node and degree of freedom.
    fn number(&self, files: &BTreeSet<MatrixPath>, faults: &mut Faults) {
        let mut labelled: Vec<(&MatrixPath, Labelled)> = Vec::new();
        for file in files.iter().filter(|file| !self.known().contains_key(*file)) {
            // A file that cannot be read is a fault where it is wanted.
            let matrix = faults.take(matrix_files::read_labelled(&file.0, file.1)).flatten();
            labelled.extend(matrix.map(|matrix| (file, matrix)));
        }
        let rows: BTreeSet<Label> = labelled.iter().flat_map(|(_, matrix)| matrix.labels()).collect();
        let rows: Vec<Label> = rows.into_iter().collect();
        for (file, matrix) in labelled {
            if let Some(matrix) = faults.take(matrix.numbered(&rows)) {
                self.known().insert(file.clone(), Arc::new(matrix));
            }
        }
    }
}

/// All matrices that a case names.
fn matrix_paths(case: &Case, matrices: &Matrices) -> BTreeSet<MatrixPath> {
    let named = [(Some(&matrices.stiffness), 'K'), (Some(&matrices.mass), 'M')];
    let more = [(matrices.damping.as_ref(), 'B'), (matrices.load.as_ref(), 'P')];
    let terms = matrices.term.values().flat_map(|term| {
        [(term.mass.as_ref(), 'M'), (term.damping.as_ref(), 'B'), (term.stiffness.as_ref(), 'K')]
    });
    let all = named.into_iter().chain(more).chain(terms);
    all.filter_map(|(file, initial)| Some((case.folder.join(file?), initial))).collect()
}

/// The structure of a case that gives matrices.
pub struct ImportedModel {
    /// The symmetric matrices, and the places of their rows.
    pub assembled: Assembled,
    /// The rest.
    pub coupling: Option<Coupling>,
    /// External force \[N, N m\].
    pub load: Vec<f64>,
    /// Coordinates of the nodes \[m\]; empty when the case does not give them.
    pub nodes: Vec<[f64; 3]>,
    /// Warnings.
    pub warnings: Vec<String>,
}

/// Reads the matrices of a case, those of them that are not in `files`, and splits them.
///
/// # Errors
/// Every fault of every file.
pub fn read_model(case: &Case, matrices: &Matrices, files: &MatrixFiles) -> Result<ImportedModel> {
    let (mut faults, mut warnings) = (Faults::new(), Vec::new());
    let place = |key: &str, file: &str| format!("`matrices.{key}` {}", case.folder.join(file).display());
    // Without terms nothing of the matrices varies.
    let again = !matrices.term.is_empty();
    files.number(&matrix_paths(case, matrices), &mut faults);
    if !faults.0.is_empty() {
        return faults.into_result(()).map(|()| unreachable!("there are faults"));
    }
    let mut read = |file: &str, initial, columns| {
        faults.take(files.read(&case.folder.join(file), initial, columns, again))
    };
    // K has entries in every column; the other matrices may be nearly empty.
    let stiffness = read(&matrices.stiffness, 'K', 0);
    let columns = stiffness.as_ref().map_or(0, |k| k.re.ncols());
    let mass = read(&matrices.mass, 'M', columns);
    let damping: Option<Option<Arc<MarketMatrix>>> =
        matrices.damping.as_ref().map(|file| read(file, 'B', columns));
    let load = matrices.load.as_ref().map(|file| read(file, 'P', columns).map(|f| (file, f)));
    let rows = mass.as_ref().or(stiffness.as_ref()).map_or(0, |m| m.re.nrows());
    let known = rows > 0;
    let places = matrices
        .dofs
        .as_ref()
        .filter(|_| known)
        .and_then(|file| faults.take(rows_in(&case.folder.join(file), rows, &mut warnings)));
    let load = match load.flatten() {
        None => vec![0.0; rows],
        Some((file, f)) => faults.take(read_load(&place("load", file), &f, rows)).unwrap_or_default(),
    };
    let terms = read_terms((case, files), matrices, rows, &mut faults, &mut warnings);
    let all = mass.zip(stiffness).filter(|_| !matches!(damping, Some(None)));
    let Some(((mass, stiffness), terms)) = all.zip(terms) else {
        return faults.into_result(()).map(|()| unreachable!("a file that is missing is a fault"));
    };
    let (mass_place, stiffness_place) =
        (place("mass", &matrices.mass), place("stiffness", &matrices.stiffness));
    let damping_place = matrices
        .damping
        .as_ref()
        .map_or_else(|| "`matrices.term`".to_string(), |file| place("damping", file));
    let [mass, damping, stiffness] = [Some(mass), damping.flatten(), Some(stiffness)];
    let [mass_terms, damping_terms, stiffness_terms] = terms;
    warnings.extend(one_sided(&stiffness_place, stiffness.as_deref()));
    warnings.extend(one_sided(&damping_place, damping.as_deref()));
    // Terms of the stiffness that are not symmetric stay whole beside it.
    let unsymmetric = |term: &FactoredMatrix| term.matrix.im.is_none() && is_unsymmetric(&term.matrix.re);
    let (friction, stiffness_terms): (Vec<_>, Vec<_>) = stiffness_terms.into_iter().partition(unsymmetric);
    let friction: Vec<SparseMatrix> =
        friction.iter().map(|term| add_scaled(&[(term.factor, &term.matrix.re)])).collect();
    // Of a sum that must be symmetric the file is named that is not.
    let of_mass: fn(&str, &MarketMatrix) -> Option<Fault> = |place, m| mass_skew(place, &m.re);
    let of_losses: fn(&str, &MarketMatrix) -> Option<Fault> =
        |place, k| k.im.as_ref().and_then(|im| hysteretic_skew(place, im));
    let blamed = [
        unsymmetric_files((&mass_place, mass.as_deref()), &mass_terms, of_mass),
        unsymmetric_files((&stiffness_place, stiffness.as_deref()), &stiffness_terms, of_losses),
    ];
    let sums = (with_terms(mass, mass_terms), with_terms(stiffness, stiffness_terms));
    let (Some(mass), Some(stiffness)) = sums else { unreachable!("both have a term: themselves") };
    let sums = [of_mass("", &mass), of_losses("", &stiffness)];
    let blamed: Vec<Fault> =
        blamed.into_iter().zip(sums).filter(|(_, sum)| sum.is_some()).flat_map(|(files, _)| files).collect();
    if !blamed.is_empty() {
        faults.0.extend(blamed);
        return faults.into_result(()).map(|()| unreachable!("there are faults"));
    }
    let damping = with_terms(damping, damping_terms);
    let imported = faults.take(split(
        Given { place: &mass_place, matrix: &mass },
        damping.as_ref().map(|matrix| Given { place: &damping_place, matrix }),
        Given { place: &stiffness_place, matrix: &stiffness },
        &friction,
    ));
    let imported = faults.into_result(imported)?.expect("a missing one is a fault");
    let (nodes, free) = places.map_or((Vec::new(), None), |(nodes, free)| (nodes, Some(free)));
    Ok(ImportedModel {
        assembled: Assembled::imported(imported.structure, nodes.clone(), free),
        coupling: imported.coupling,
        load,
        nodes,
        warnings: warnings.into_iter().chain(imported.warnings).collect(),
    })
}

/// A term of a matrix: its factor, the place of its file, and what the factor multiplies.
struct FactoredMatrix {
    factor: f64,
    place: String,
    matrix: Arc<MarketMatrix>,
}

/// The faults that `skew` finds of the files of a sum, `first` and the terms, each by its own place.
fn unsymmetric_files(
    first: (&str, Option<&MarketMatrix>),
    terms: &[FactoredMatrix],
    skew: fn(&str, &MarketMatrix) -> Option<Fault>,
) -> Vec<Fault> {
    let first = first.1.map(|matrix| (first.0, matrix));
    let terms = terms.iter().map(|term| (term.place.as_str(), &*term.matrix));
    first.into_iter().chain(terms).filter_map(|(place, matrix)| skew(place, matrix)).collect()
}

/// Terms added to M, C and K, each of `rows` rows and columns; none when there is a fault.
fn read_terms(
    (case, files): (&Case, &MatrixFiles),
    matrices: &Matrices,
    rows: usize,
    faults: &mut Faults,
    warnings: &mut Vec<String>,
) -> Option<[Vec<FactoredMatrix>; 3]> {
    let mut terms = [Vec::new(), Vec::new(), Vec::new()];
    let earlier = faults.0.len();
    for (name, term) in &matrices.term {
        let named =
            [("mass", 'M', &term.mass), ("damping", 'B', &term.damping), ("stiffness", 'K', &term.stiffness)];
        for ((key, initial, file), terms) in named.into_iter().zip(&mut terms) {
            let path = file.as_ref().map(|file| case.folder.join(file));
            let Some(path) = path else { continue };
            let Some(matrix) = faults.take(files.read(&path, initial, rows, true)) else { continue };
            let (m, n) = (matrix.re.nrows(), matrix.re.ncols());
            if rows > 0 && (m, n) != (rows, rows) {
                faults.push(Fault::new(
                    format!("`matrices.term.{name}.{key}` {}", path.display()),
                    format!("{m} × {n} numbers"),
                    format!("{rows} × {rows}, as M has"),
                ));
            }
            let place = format!("`matrices.term.{name}.{key}` {}", path.display());
            // Friction alone, forces along t by motions along n, may well fill one triangle; half of a stiffness has a diagonal.
            if key != "stiffness" || diagonal(&matrix.re).iter().any(|v| *v != 0.0) {
                warnings.extend(one_sided(&place, Some(&matrix)));
            }
            terms.push(FactoredMatrix { factor: matrices.value(&term.factor), place, matrix });
        }
    }
    (faults.0.len() == earlier).then_some(terms)
}

/// The warning that one triangle of a matrix is empty: half of a symmetric one whose header says `general`, most likely.
fn one_sided(place: &str, matrix: Option<&MarketMatrix>) -> Option<String> {
    let (triangle, count) = matrix?.one_triangle()?;
    let entries = if count == 1 { "the one entry" } else { "all entries" };
    let found = format!("{entries} off the diagonal ({count}) in the {triangle} triangle");
    let fault = Fault::new(place, found, "both triangles, or the lower one of a symmetric matrix");
    let help = "If it is half of a symmetric matrix, its header has to say `symmetric` (form 6 of DMIG and OUTPUT4; `skew-symmetric` if its other half has \
                the other sign), with the lower triangle in the file; if it is whole, all is well";
    Some(fault.with_help(help).warning())
}

/// The matrix with what is added to it, if there is anything.
fn with_terms(matrix: Option<Arc<MarketMatrix>>, terms: Vec<FactoredMatrix>) -> Option<Arc<MarketMatrix>> {
    if terms.is_empty() {
        return matrix;
    }
    let terms = terms.into_iter().map(|term| (term.factor, term.matrix));
    let all: Vec<(f64, Arc<MarketMatrix>)> =
        matrix.into_iter().map(|matrix| (1.0, matrix)).chain(terms).collect();
    let sum = |parts: Vec<(f64, &SparseMatrix)>| (!parts.is_empty()).then(|| add_scaled(&parts));
    let re = sum(all.iter().map(|(factor, matrix)| (*factor, &matrix.re)).collect())?;
    let im = sum(all.iter().filter_map(|(factor, matrix)| Some((*factor, matrix.im.as_ref()?))).collect());
    Some(MarketMatrix { re, im }.into())
}

/// The one column of a real matrix with `n` rows.
fn read_load(place: &str, f: &MarketMatrix, n: usize) -> Result<Vec<f64>> {
    let (rows, columns) = (f.re.nrows(), f.re.ncols());
    if (rows, columns) != (n, 1) || f.im.is_some() {
        let kind = if f.im.is_some() { "complex" } else { "real" };
        let found = format!("{rows} × {columns} {kind} numbers");
        return Err(Error::input(Fault::new(
            place,
            found,
            format!("{n} × 1 real ones, a force for each row"),
        )));
    }
    let mut load = vec![0.0; n];
    f.re.row_idx_of_col(0).zip(f.re.val_of_col(0)).for_each(|(i, v)| load[i] = *v);
    Ok(load)
}

/// The nodes \[m\] and what each of the `n` rows of the matrices is, from the CSV `text` of the file `name`: one line a row,
/// in the order of the rows.
///
/// # Errors
/// Every fault of the heading, and the first faults of the lines.
pub fn read_rows(name: &str, text: &str, n: usize) -> Result<(Vec<[f64; 3]>, Vec<FreeDof>)> {
    let [required, known] = ROW_COLUMNS;
    rows_of(&TextTable::parse(name.to_string(), text.to_string(), required, known)?, n)
}

fn rows_in(path: &Path, n: usize, warnings: &mut Vec<String>) -> Result<(Vec<[f64; 3]>, Vec<FreeDof>)> {
    let [required, known] = ROW_COLUMNS;
    let table = TextTable::read(path, required, known)?;
    warnings.extend(table.warnings());
    rows_of(&table, n)
}

fn rows_of(table: &TextTable, n: usize) -> Result<(Vec<[f64; 3]>, Vec<FreeDof>)> {
    let mut faults = Faults::new();
    let mut nodes: Vec<[f64; 3]> = Vec::new();
    let mut free = Vec::with_capacity(table.rows().count());
    let mut index: BTreeMap<&str, usize> = BTreeMap::new();
    for (k, row) in table.rows().enumerate() {
        if faults.0.len() >= MOST_FAULTS {
            break;
        }
        let position = ["x", "y", "z"].map(|c| row.number(c, 0.0, &mut faults));
        let node = *index.entry(row.cell("node")).or_insert_with(|| {
            nodes.push(position);
            nodes.len() - 1
        });
        if nodes[node] != position {
            let found = format!("another place for node {} than before", row.cell("node"));
            faults.push(Fault::new(row.place(), found, "the same x, y, z in every row of a node"));
        }
        if !["", &(k + 1).to_string()].contains(&row.cell("dof")) {
            let found = format!("dof \"{}\"", row.cell("dof"));
            faults.push(Fault::new(
                row.place(),
                found,
                format!("dof {}: the rows of the matrices in their order", k + 1),
            ));
        }
        let direction = MOTIONS.map(|c| row.number(c, 0.0, &mut faults));
        if direction.iter().all(|d| *d == 0.0) && faults.0.is_empty() {
            faults.push(Fault::new(
                row.place(),
                "no motion",
                "1 in one of the columns ux, uy, uz, rx, ry, rz",
            ));
        }
        free.push(FreeDof { node, direction });
    }
    if free.len() != n && faults.0.is_empty() {
        faults.push(Fault::new(
            table.name(),
            format!("{} rows", free.len()),
            format!("{n}, one for each row of the matrices"),
        ));
    }
    faults.into_result((nodes, free))
}

/// The contact points that a pair of the case gives, on a system of `n` degrees of freedom.
///
/// # Errors
/// Every fault of the table or the list.
pub fn given_points(
    case: &Case,
    name: &str,
    contact: &Contact,
    points: &ContactPoints,
    n: usize,
) -> Result<Vec<ContactPoint>> {
    let mut faults = Faults::new();
    let mut found = Vec::new();
    match points {
        ContactPoints::Rows(rows) => {
            for (k, row) in rows.iter().enumerate() {
                let place = format!("`contact.{name}.points` row {}", k + 1);
                let cell = |c: usize| row.get(c).map_or("", String::as_str);
                if let Some([normal, t1, t2]) =
                    directions(&place, [cell(0), cell(1), cell(2)], n, &mut faults)
                {
                    let tangents = [t1, t2];
                    found.push(ContactPoint {
                        position: [0.0; 3],
                        gap: 0.0,
                        weight: 1.0,
                        speed: 1.0,
                        normal,
                        tangents,
                    });
                }
            }
        }
        ContactPoints::File(file) => {
            let [required, known] = POINT_COLUMNS;
            return points_of(
                &TextTable::read(&case.folder.join(file), required, known)?.all_read(known)?,
                n,
            );
        }
    }
    debug_assert!(contact.points.is_some());
    faults.into_result(found)
}

/// The contact points on `n` degrees of freedom, from the CSV `text` of the file `name`: one line a point.
///
/// # Errors
/// Every fault of the heading, and the first faults of the lines.
pub fn read_points(name: &str, text: &str, n: usize) -> Result<Vec<ContactPoint>> {
    let [required, known] = POINT_COLUMNS;
    points_of(&TextTable::parse(name.to_string(), text.to_string(), required, known)?.all_read(known)?, n)
}

fn points_of(table: &TextTable, n: usize) -> Result<Vec<ContactPoint>> {
    let mut faults = Faults::new();
    let mut found = Vec::with_capacity(table.rows().count());
    for row in table.rows() {
        if faults.0.len() >= MOST_FAULTS {
            break;
        }
        let place = row.place();
        let cells = [row.cell("normal"), row.cell("t1"), row.cell("t2")];
        let weight = row.number("weight", 1.0, &mut faults);
        if weight <= 0.0 {
            faults.push(Fault::new(format!("{place} `weight`"), weight.to_string(), "a weight above zero"));
        }
        let gap = row.number("gap", 0.0, &mut faults);
        let speed = row.number("speed", 1.0, &mut faults);
        if speed < 0.0 {
            let expected = "the sliding velocity there over that of the pair, zero or more";
            faults.push(Fault::new(format!("{place} `speed`"), speed.to_string(), expected));
        }
        let position = ["x", "y", "z"].map(|c| row.number(c, 0.0, &mut faults));
        if let Some([normal, t1, t2]) = directions(&place, cells, n, &mut faults) {
            found.push(ContactPoint { position, gap, weight, speed, normal, tangents: [t1, t2] });
        }
    }
    if found.is_empty() && faults.0.is_empty() {
        faults.push(Fault::new(table.name(), "no row", "at least one contact point"));
    }
    faults.into_result(found)
}

fn directions(place: &str, cells: [&str; 3], n: usize, faults: &mut Faults) -> Option<[SparseVector; 3]> {
    let mut parsed = Vec::new();
    for (cell, key) in cells.iter().zip(["normal", "t1", "t2"]) {
        match direction(cell, n) {
            Ok(d) if key == "normal" && d.indices().is_empty() => {
                faults.push(Fault::new(
                    format!("{place} `normal`"),
                    format!("\"{cell}\""),
                    "a direction such as \"12 -45\"",
                ));
            }
            Ok(d) => parsed.push(d),
            Err(found) => faults.push(Fault::new(
                format!("{place} `{key}`"),
                found,
                format!("degrees of freedom from 1 to {n} such as \"12 -45 0.5*7\""),
            )),
        }
    }
    parsed.try_into().ok()
}

/// `12 -45 0.5*7` → e₁₂ − e₄₅ + ½ e₇, counted from 1; 0 and an empty text are no direction (the ground).
fn direction(text: &str, n: usize) -> std::result::Result<SparseVector, String> {
    let mut entries = Vec::new();
    for word in text.split_whitespace() {
        let wrong = || format!("\"{word}\"");
        let (factor, dof) = match word.split_once('*') {
            Some((factor, dof)) => (factor.parse::<f64>().map_err(|_| wrong())?, dof),
            None => match word.strip_prefix('-') {
                Some(dof) => (-1.0, dof),
                None => (1.0, word.strip_prefix('+').unwrap_or(word)),
            },
        };
        match dof.parse::<usize>() {
            Ok(0) => {}
            Ok(dof) if dof <= n && factor.is_finite() => entries.push((dof - 1, factor)),
            _ => return Err(wrong()),
        }
    }
    Ok(SparseVector::from_entries(entries))
}

/// The text that [`direction`] reads as the same numbers.
pub fn direction_text(direction: &SparseVector) -> String {
    let word = |(i, v): (usize, f64)| match v {
        1.0 => format!("{}", i + 1),
        -1.0 => format!("-{}", i + 1),
        _ => format!("{v:e}*{}", i + 1),
    };
    direction.iter().map(word).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_sums_of_signed_degrees_of_freedom() {
        let d = direction("+2 -5 -0.25*3 1e-3*1", 5).unwrap();
        assert_eq!(d.iter().collect::<Vec<_>>(), [(0, 1e-3), (1, 1.0), (2, -0.25), (4, -1.0)]);
        assert_eq!(direction(&direction_text(&d), 5).unwrap(), d);
        assert!(
            direction("0", 5).unwrap().indices().is_empty() && direction("", 5).unwrap().indices().is_empty()
        );
        for wrong in ["6", "-6", "1.5", "x", "nan*1", "1*", "--1", "99999999999999999999"] {
            assert!(direction(wrong, 5).is_err(), "{wrong}");
        }
    }
}
