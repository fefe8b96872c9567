//! The linear equations of a case as constraints: a₁ u₁ + a₂ u₂ + … = 0 makes u₁ = −(a₂ u₂ + …)/a₁ a slave of the others.

use super::regions::Regions;
use super::table::{MOST_FAULTS, TextRow, TextTable};
use crate::case::{Case, DOF_NAMES, Equation};
use crate::error::{Error, Fault, Faults, Result};
use crate::mesh::Mesh;
use crate::structure::{Constraint, Coupling};
use std::collections::{BTreeMap, HashMap, HashSet};

/// The columns of a file.
const COLUMNS: [&str; 4] = ["equation", "node", "component", "factor"];

/// A degree of freedom with its factor: node, component, a.
type Term = (usize, usize, f64);

/// The equations of the files of a case, by the name of their table.
pub(super) type EquationFiles = BTreeMap<String, Vec<Written>>;

/// An equation as a file has it.
#[derive(Debug)]
pub(super) struct Written {
    /// Where it begins, and what the file calls it.
    words: String,
    /// Its terms: file and line, node, component, a.
    terms: Vec<(String, String, usize, f64)>,
}

/// Reads the files of equations.
///
/// # Errors
/// Files that are missing, and the first faults of each.
pub(super) fn read_equations(case: &Case) -> Result<EquationFiles> {
    let mut faults = Faults::new();
    let mut files = EquationFiles::new();
    for (name, equation) in &case.equation {
        if let Equation::File { file } = equation {
            let table = TextTable::read(&case.folder.join(file), &COLUMNS, &COLUMNS);
            let read = table.and_then(|table| table.all_read(&COLUMNS)).and_then(|table| written(&table));
            files.extend(faults.take(read).map(|read| (name.clone(), read)));
        }
    }
    faults.into_result(files)
}

fn written(table: &TextTable) -> Result<Vec<Written>> {
    let mut faults = Faults::new();
    let (mut all, mut names): (Vec<Written>, HashSet<&str>) = (Vec::new(), HashSet::new());
    let mut last = None;
    for row in table.rows() {
        if faults.0.len() >= MOST_FAULTS {
            break;
        }
        let name = row.cell("equation");
        let first = last != Some(name);
        last = Some(name);
        if first && !names.insert(name) {
            let found = format!("equation {name} again, behind others");
            let expected = "the rows of one equation one after the other";
            faults.push(Fault::new(format!("{} `equation`", row.place()), found, expected));
        }
        let Some((component, factor)) = term(&row, first, &mut faults) else { continue };
        let term = (row.place(), row.cell("node").to_string(), component, factor);
        match all.last_mut().filter(|_| !first) {
            Some(equation) => equation.terms.push(term),
            None => {
                let words = format!("{}, equation {name}", row.place());
                all.push(Written { words, terms: vec![term] });
            }
        }
    }
    faults.into_result(all)
}

/// Component and factor of a row, the first of an equation or not.
fn term(row: &TextRow<'_>, first: bool, faults: &mut Faults) -> Option<(usize, f64)> {
    let before = faults.0.len();
    let mut fault = |column: &str, expected: &str| {
        let found = format!("\"{}\"", row.cell(column));
        faults.push(Fault::new(format!("{} `{column}`", row.place()), found, expected));
    };
    let component = DOF_NAMES.iter().position(|name| *name == row.cell("component"));
    if component.is_none() {
        fault("component", "ux, uy, uz, rx, ry or rz");
    }
    for column in ["equation", "node", "factor"].into_iter().filter(|column| row.cell(column).is_empty()) {
        fault(column, "a number or a name, a node, and a number");
    }
    let factor = row.number("factor", 1.0, faults);
    if first && factor == 0.0 {
        let expected = "a factor that is not zero: the first degree of freedom follows the others";
        faults.push(Fault::new(format!("{} `factor`", row.place()), "0", expected));
    }
    component.filter(|_| faults.0.len() == before).map(|component| (component, factor))
}

/// The equations of the case, each under the name that messages use.
///
/// # Errors
/// Regions and nodes that are missing, regions of more than one node, equations without a first degree of freedom.
pub(super) fn equations(case: &Case, regions: &Regions, files: &EquationFiles) -> Result<Vec<Coupling>> {
    let mut faults = Faults::new();
    let mut all = Vec::new();
    // The points of the case have no numbers.
    let numbers = numbers(&regions.mesh, regions.mesh.nodes.len() - case.point.len(), files);
    for (name, equation) in &case.equation {
        let place = format!("`equation.{name}`");
        if let Equation::Terms { on, component, factor } = equation {
            let terms: Vec<(&str, usize, f64)> = (on.iter().zip(component).zip(factor))
                .map(|((on, component), a)| {
                    let component = DOF_NAMES.iter().position(|name| name == component).unwrap_or_default();
                    (on.as_str(), component, *a)
                })
                .collect();
            all.extend(faults.take(of_regions(name, &terms, regions)));
        }
        for Written { words, terms } in files.get(name).into_iter().flatten() {
            if faults.0.len() >= MOST_FAULTS {
                break;
            }
            let mut own: Vec<Term> = Vec::with_capacity(terms.len());
            for (at, node, component, a) in terms {
                let found = match node.parse::<u64>() {
                    Ok(number) => numbers.get(&number).copied().ok_or_else(|| unknown(at, node)),
                    Err(_) => regions.node(node, &format!("{at} `node`")),
                };
                own.extend(faults.take(found).map(|node| (node, *component, *a)));
            }
            if own.len() == terms.len() {
                let constraints = vec![faults.take(constraint(&place, &own, regions))];
                let constraints = constraints.into_iter().flatten().collect();
                all.push(Coupling { name: format!("{place} ({words})"), constraints });
            }
        }
    }
    faults.into_result(all)
}

fn unknown(at: &str, node: &str) -> Error {
    let expected =
        "the number of a node of the mesh that an element of a region has, or the name of a region";
    Error::input(Fault::new(format!("{at} `node`"), format!("node {node}"), expected))
}

/// The nodes of a mesh that equations make follow others.
pub(super) fn following(case: &Case, mesh: &Mesh, files: &EquationFiles) -> HashSet<usize> {
    let numbers = numbers(mesh, mesh.nodes.len(), files);
    let in_files = files.values().flatten().filter_map(|equation| equation.terms.first());
    let in_case = case.equation.values().filter_map(|equation| match equation {
        Equation::Terms { on, .. } => on.first(),
        Equation::File { .. } => None,
    });
    let of_region = |name: &String| mesh.region(name).map_or(Vec::new(), |region| mesh.region_nodes(region));
    let of_file = |(_, node, ..): &(String, String, usize, f64)| match node.parse() {
        Ok(number) => numbers.get(&number).copied().into_iter().collect(),
        Err(_) => of_region(node),
    };
    in_files.flat_map(of_file).chain(in_case.flat_map(of_region)).collect()
}

/// The first `count` nodes of a mesh by their numbers in its file, where a case has equations in files.
fn numbers(mesh: &Mesh, count: usize, files: &EquationFiles) -> HashMap<u64, usize> {
    let count = if files.is_empty() { 0 } else { count };
    (0..count).map(|node| (mesh.node_tag(node), node)).collect()
}

/// An equation for each node of the first region; the other terms are on single points, or on that same region.
fn of_regions(name: &str, terms: &[(&str, usize, f64)], regions: &Regions) -> Result<Coupling> {
    let mut faults = Faults::new();
    let (place, at) = (format!("`equation.{name}`"), format!("`equation.{name}.on`"));
    let first = terms.first().map_or("", |(on, ..)| on);
    let followers = faults.take(regions.nodes(first, &at)).unwrap_or_default();
    let mut single = Vec::with_capacity(terms.len());
    for (on, ..) in terms {
        let nodes = if *on == first { None } else { faults.take(regions.nodes(on, &at)) };
        if let Some(nodes) = nodes.as_ref().filter(|nodes| nodes.len() != 1) {
            let found = format!("region \"{on}\" of {} nodes", nodes.len());
            let expected = format!("regions of one point behind the first, or the first itself, \"{first}\"");
            let help = "Equations between two sets of nodes, node by node, are rows of a `file`";
            faults.push(Fault::new(&at, found, expected).with_help(help));
        }
        single.push(nodes.and_then(|nodes| nodes.first().copied()));
    }
    faults.into_result(())?;
    let of = |node: &usize| {
        let own = terms.iter().zip(&single).map(|((_, k, a), other)| (other.unwrap_or(*node), *k, *a));
        constraint(&place, &own.collect::<Vec<_>>(), regions)
    };
    let constraints = followers.iter().map(of).collect::<Result<_>>()?;
    Ok(Coupling { name: place, constraints })
}

/// u₁ as a sum of the others; terms of one degree of freedom are added.
fn constraint(place: &str, terms: &[Term], regions: &Regions) -> Result<Constraint> {
    let slave = terms.first().map_or((0, 0), |(node, component, _)| (*node, *component));
    let is_first = |(node, component, _): &&Term| (*node, *component) == slave;
    let own: f64 = terms.iter().filter(is_first).map(|(.., a)| a).sum();
    if own == 0.0 {
        let (node, component) = (regions.name_of_node(slave.0), DOF_NAMES[slave.1]);
        let found = format!("terms of {component} of {node}, the first one, that add up to nothing");
        return Err(Error::input(Fault::new(
            place,
            found,
            "a first degree of freedom that follows the others",
        )));
    }
    let others = terms.iter().filter(|term| !is_first(term) && term.2 != 0.0);
    Ok(Constraint { slave, terms: others.map(|(node, k, a)| (*node, *k, -a / own)).collect() })
}
