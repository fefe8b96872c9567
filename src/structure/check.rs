//! Whether a model can be assembled: every fault at once, before any matrix.

use super::dofs::DofMap;
use super::elements::{FlatTriangle, split_face, spring_direction};
use super::material::Material;
use super::model::{Coupling, Model};
use super::part::Part;
use super::properties::{PlateTheory, Shell};
use crate::error::{Fault, Faults, Result};
use crate::mesh::{Cell, made_of};
use crate::numbers::components;
use std::collections::{BTreeMap, HashMap};

/// Whether `model` can be assembled, without assembling it.
///
/// # Errors
/// Those of [`assemble`](super::assemble).
pub fn check(model: &Model) -> Result<()> {
    check_model(model)?;
    DofMap::new(model, &model.elements()).map(|_| ())
}

/// The faults of `model`, all of them; of like faults in one part the first, with their number.
pub(super) fn check_model(model: &Model) -> Result<()> {
    let mut faults = Faults::new();
    check_nodes(model, &mut faults);
    check_parts(model, &mut faults);
    shared_elements(model, &mut faults);
    check_masses(model, &mut faults);
    check_springs(model, &mut faults);
    check_references(model, &mut faults);
    faults.into_result(())
}

/// Coordinates.
fn check_nodes(model: &Model, faults: &mut Faults) {
    let bad_nodes: Vec<usize> =
        (0..model.nodes.len()).filter(|n| model.nodes[*n].iter().any(|x| !x.is_finite())).collect();
    if let Some(first) = bad_nodes.first() {
        faults.push(Fault::new(
            "nodes",
            format!("{} with coordinates that are not finite, the first node {}", bad_nodes.len(), first + 1),
            "finite coordinates",
        ));
    }
}

/// Parts: material, section, cells.
fn check_parts(model: &Model, faults: &mut Faults) {
    let known = |node: &usize| *node < model.nodes.len();
    let sound = |node: &usize| known(node) && model.nodes[*node].iter().all(|x| x.is_finite());
    for part in &model.parts {
        let place = part.place();
        check_material(&place, part.kind.material(), faults);
        if part.kind.material().orthotropic.is_some() && part.kind.dimension() < 3 {
            let fault = Fault::new(
                &place,
                "an orthotropic material",
                "an isotropic one: plates and bars have no others",
            );
            faults.push(fault.with_help(
                "Model the part by solids, `[solid.NAME]`, or leave `orthotropic` out of its material",
            ));
        }
        for (what, value, unit) in part.kind.positive() {
            positive(&place, what, value, unit, faults);
        }
        part.as_shell().into_iter().for_each(|shell| check_theory(&place, shell, faults));
        let dimension = part.kind.dimension();
        let others = part.cells.iter().filter(|cell| cell.dimension() != dimension).count();
        if others > 0 {
            faults.push(Fault::new(
                &place,
                format!("{others} cells that are no {}", made_of(dimension)),
                made_of(dimension),
            ));
        }
        let missing = part.cells.iter().flat_map(Cell::nodes).filter(|n| !known(n));
        missing_nodes(&place, missing, model.nodes.len(), faults);
        let usable = |cell: &&Cell| cell.dimension() == dimension && cell.nodes().iter().all(sound);
        let shapes: Vec<(&Cell, Shape)> =
            part.cells.iter().filter(usable).map(|cell| (cell, shape(part, &model.nodes, cell))).collect();
        for (bad, what, expected, help) in SHAPES {
            let mut found = shapes.iter().filter(|(_, shape)| shape == bad);
            if let Some((first, _)) = found.next() {
                let nodes: Vec<usize> = first.nodes().iter().map(|n| n + 1).collect();
                let number = 1 + found.count();
                let found = format!("{number} elements {what}, the first with nodes {nodes:?}");
                faults.push(Fault::new(&place, found, *expected).with_help(*help));
            }
        }
    }
}

/// Point masses.
fn check_masses(model: &Model, faults: &mut Faults) {
    let known = |node: &usize| *node < model.nodes.len();
    for (k, point) in model.masses.iter().enumerate() {
        let place = format!("point mass {}", k + 1);
        missing_nodes(&place, std::iter::once(&point.node).filter(|n| !known(n)), model.nodes.len(), faults);
        not_negative(&place, "mass", point.mass, "kg", faults);
        for inertia in point.inertia {
            not_negative(&place, "moment of inertia", inertia, "kg m²", faults);
        }
    }
}

/// Springs and dashpots.
fn check_springs(model: &Model, faults: &mut Faults) {
    let known = |node: &usize| *node < model.nodes.len();
    for (k, spring) in model.springs.iter().enumerate() {
        let place = format!("spring {}", k + 1);
        let ends = std::iter::once(&spring.node).chain(&spring.other);
        missing_nodes(&place, ends.filter(|n| !known(n)), model.nodes.len(), faults);
        not_negative(&place, "stiffness", spring.stiffness, "N/m or N m/rad", faults);
        not_negative(&place, "damping", spring.damping, "N s/m or N m s/rad", faults);
        if spring_direction(spring).is_none() {
            let found = format!("direction {}", components(spring.direction));
            faults.push(Fault::new(&place, found, "a direction with a length"));
        }
        if spring.other == Some(spring.node) {
            let found = format!("both ends at node {}", spring.node + 1);
            faults.push(Fault::new(&place, found, "two nodes, or a node and the ground"));
        }
    }
}

/// Rigid links, other constraints and supports.
fn check_references(model: &Model, faults: &mut Faults) {
    let known = |node: &usize| *node < model.nodes.len();
    for (k, link) in model.links.iter().enumerate() {
        let ends = std::iter::once(&link.master).chain(&link.slaves);
        let place = format!("rigid link {}", k + 1);
        missing_nodes(&place, ends.filter(|n| !known(n)), model.nodes.len(), faults);
    }
    for (k, support) in model.supports.iter().enumerate() {
        let place = format!("support {}", k + 1);
        missing_nodes(&place, support.nodes.iter().filter(|n| !known(n)), model.nodes.len(), faults);
    }
    for support in &model.inclined_supports {
        let missing = std::iter::once(&support.node).filter(|n| !known(n));
        missing_nodes(&support.name, missing, model.nodes.len(), faults);
    }
    for Coupling { name, constraints } in &model.couplings {
        let terms = || constraints.iter().flat_map(|constraint| &constraint.terms);
        let nodes = constraints.iter().map(|c| &c.slave.0).chain(terms().map(|(node, ..)| node));
        missing_nodes(name, nodes.filter(|n| !known(n)), model.nodes.len(), faults);
        let components =
            constraints.iter().map(|c| c.slave.1).chain(terms().map(|(_, component, _)| *component));
        if let Some(component) = components.into_iter().find(|component| *component > 5) {
            faults.push(Fault::new(name, format!("component {component} of a node"), "0 to 5, for ux to rz"));
        }
        if let Some((_, _, c)) = terms().find(|(.., c)| !c.is_finite()) {
            faults.push(Fault::new(name, format!("a coefficient {c}"), "finite coefficients"));
        }
    }
}

/// What is wrong with the shape of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Sound,
    NoLength,
    NoArea,
    Folded,
    Inverted,
}

/// What is found, what is expected, what to do.
const SHAPES: &[(Shape, &str, &str, &str)] = &[
    (
        Shape::NoLength,
        "with no length or an orientation along it",
        "elements with a length, and an orientation that is not along them",
        "Merge coincident nodes, or give another orientation",
    ),
    (
        Shape::NoArea,
        "without area",
        "elements with an area",
        "Merge coincident nodes or mesh the region again",
    ),
    (
        Shape::Folded,
        "that are re-entrant or folded",
        "convex quadrilaterals",
        "Merge coincident nodes or mesh the region again",
    ),
    (
        Shape::Inverted,
        "whose Jacobian is not positive at a point of the quadrature",
        "solids that are not turned inside out",
        "Mesh the region again, or bring nodes in the middle of edges back into place",
    ),
];

/// Whether the elements of the part can be made of a cell: all triangles of a face have an area and look the same way.
fn shape(part: &Part, nodes: &[[f64; 3]], cell: &Cell) -> Shape {
    let unusable = || part.elements_on(cell, nodes).iter().any(|e| e.is_degenerate());
    match part.kind.dimension() {
        2 => {
            let split = split_face(cell);
            let triangles: Vec<FlatTriangle> =
                split.iter().filter_map(|t| FlatTriangle::new(&t.nodes.map(|n| nodes[n]))).collect();
            if triangles.len() < split.len() {
                return Shape::NoArea;
            }
            let normals: Vec<[f64; 3]> = triangles.iter().map(FlatTriangle::normal).collect();
            let turned = |n: &[f64; 3]| n.iter().zip(normals[0]).map(|(a, b)| a * b).sum::<f64>() <= 0.0;
            if normals.iter().any(turned) || unusable() { Shape::Folded } else { Shape::Sound }
        }
        _ if !unusable() => Shape::Sound,
        3 => Shape::Inverted,
        _ => Shape::NoLength,
    }
}

/// Checks the data that Mindlin's theory needs of a plate.
fn check_theory(place: &str, shell: &Shell, faults: &mut Faults) {
    if let Some(kappa) = shell.shear_coefficient {
        positive(place, "shear coefficient", kappa, "1", faults);
    }
    if shell.theory == PlateTheory::Mindlin && !shell.rotary_inertia {
        let found = "Mindlin's theory without rotary inertia";
        faults.push(
            Fault::new(
                place,
                found,
                "its rotary inertia, without which rotations of the section have no mass",
            )
            .with_help("Count the rotary inertia, or take Kirchhoff's theory"),
        );
    }
}

/// Elements that two parts have: their stiffness and mass would count twice.
fn shared_elements(model: &Model, faults: &mut Faults) {
    if model.parts.len() < 2 {
        return;
    }
    let cells = model.parts.iter().flat_map(|part| part.cells.iter().map(|cell| (&part.name, cell.nodes())));
    let mut owners: HashMap<Vec<usize>, &String> = HashMap::new();
    let mut shared: BTreeMap<[&String; 2], usize> = BTreeMap::new();
    for (name, nodes) in cells {
        let mut nodes = nodes.to_vec();
        nodes.sort_unstable();
        let owner = *owners.entry(nodes).or_insert(name);
        if owner != name {
            *shared.entry([owner, name]).or_default() += 1;
        }
    }
    for ([owner, name], count) in shared {
        let found = format!("{count} elements that `{owner}` has, too");
        let fault = Fault::new(format!("part `{name}`"), found, "elements of its own");
        faults.push(fault.with_help("Stiffness and mass would count twice: give each element to one part"));
    }
}

fn check_material(place: &str, material: &Material, faults: &mut Faults) {
    positive(place, "Young's modulus", material.youngs_modulus, "Pa", faults);
    let nu = material.poissons_ratio;
    if !(nu > -1.0 && nu < 0.5) {
        faults.push(
            Fault::new(place, format!("Poisson's ratio {nu}"), "a value above -1 and below 0.5")
                .with_help("Steel and aluminium have about 0.3"),
        );
    }
    not_negative(place, "density", material.density, "kg/m³", faults);
    not_negative(place, "loss factor", material.loss_factor, "1", faults);
    not_negative(place, "Rayleigh alpha", material.rayleigh.alpha, "1/s", faults);
    not_negative(place, "Rayleigh beta", material.rayleigh.beta, "s", faults);
}

fn positive(place: &str, what: &str, value: f64, unit: &str, faults: &mut Faults) {
    if !(value > 0.0 && value.is_finite()) {
        faults.push(Fault::new(place, format!("{what} {value}"), format!("a positive value [{unit}]")));
    }
}

fn not_negative(place: &str, what: &str, value: f64, unit: &str, faults: &mut Faults) {
    if !(value >= 0.0 && value.is_finite()) {
        faults.push(Fault::new(
            place,
            format!("{what} {value}"),
            format!("zero or a positive value [{unit}]"),
        ));
    }
}

fn missing_nodes<'a>(
    place: &str,
    missing: impl Iterator<Item = &'a usize>,
    n_nodes: usize,
    faults: &mut Faults,
) {
    let missing: Vec<usize> = missing.copied().collect();
    if let Some(first) = missing.first() {
        faults.push(Fault::new(
            place,
            format!(
                "{} references to nodes that do not exist, the first to node {}",
                missing.len(),
                first + 1
            ),
            format!("nodes 1 to {n_nodes}"),
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::samples::STEEL;

    #[test]
    fn an_element_belongs_to_one_part() {
        let plate = |name: &str, faces: &[[usize; 3]]| {
            let faces = faces.iter().map(|nodes| Cell::triangle(*nodes)).collect();
            Part::new(name, faces, Shell::new(STEEL, 1e-3))
        };
        let nodes = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let apart = [plate("a", &[[0, 1, 2]]), plate("b", &[[1, 3, 2]])];
        let model = Model { nodes, parts: apart.to_vec(), ..Model::default() };
        assert!(check(&model).is_ok());
        let shared = [plate("a", &[[0, 1, 2]]), plate("b", &[[1, 3, 2], [2, 0, 1]])];
        let error = check(&Model { parts: shared.to_vec(), ..model }).unwrap_err().to_string();
        assert!(error.contains("part `b`: found 1 elements that `a` has, too"), "{error}");
    }
}
