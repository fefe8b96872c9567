//! Whether a model can be assembled: every fault at once, before any matrix.

use super::dofs::DofMap;
use super::elements::{BarElement, FiniteElement, FlatTriangle, split_face, spring_direction};
use super::material::Material;
use super::model::{Model, PlateTheory, ShellPart};
use super::registry::elements;
use crate::error::{Fault, Faults, Result};
use crate::mesh::Cell;
use crate::numbers::components;
use std::collections::{BTreeMap, HashMap};

/// Whether `model` can be assembled, without assembling it.
///
/// # Errors
/// Those of [`assemble`](super::assemble).
pub fn check(model: &Model) -> Result<()> {
    check_model(model)?;
    DofMap::new(model, &elements(model)).map(|_| ())
}

/// The faults of `model`, all of them; of like faults in one part the first, with their number.
pub(super) fn check_model(model: &Model) -> Result<()> {
    let mut faults = Faults::new();
    check_nodes(model, &mut faults);
    check_shells(model, &mut faults);
    check_bars(model, &mut faults);
    shared_elements(model, &mut faults);
    check_masses(model, &mut faults);
    check_springs(model, &mut faults);
    check_ties(model, &mut faults);
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

/// Plates: material, thickness, theory, faces.
fn check_shells(model: &Model, faults: &mut Faults) {
    let known = |node: &usize| *node < model.nodes.len();
    let sound = |node: &usize| known(node) && model.nodes[*node].iter().all(|x| x.is_finite());
    for part in &model.shells {
        let place = format!("`shell.{}`", part.name);
        check_material(&place, &part.material, faults);
        positive(&place, "thickness", part.thickness, "m", faults);
        check_theory(&place, part, faults);
        let not_faces = part.faces.iter().filter(|f| f.dimension() != 2).count();
        if not_faces > 0 {
            let found = format!("{not_faces} elements that are points or lines");
            faults.push(Fault::new(&place, found, "triangles and quadrilaterals"));
        }
        let missing = part.faces.iter().flat_map(|f| f.nodes()).filter(|n| !known(n));
        missing_nodes(&place, missing, model.nodes.len(), faults);
        let count = part.faces.len();
        let shapes: Vec<Option<Shape>> = part
            .faces
            .iter()
            .map(|f| f.nodes().iter().all(sound).then(|| shape(part, &model.nodes, f)))
            .collect();
        for (bad, what, expected) in [
            (Shape::NoArea, "without area", "elements with an area"),
            (Shape::Folded, "that are re-entrant or folded", "convex quadrilaterals"),
        ] {
            let mut found = (0..count).filter(|f| shapes[*f] == Some(bad));
            if let Some(first) = found.next() {
                let nodes: Vec<usize> = part.faces[first].nodes().iter().map(|n| n + 1).collect();
                let number = 1 + found.count();
                faults.push(
                    Fault::new(
                        &place,
                        format!("{number} elements {what}, the first with nodes {nodes:?}"),
                        expected,
                    )
                    .with_help("Merge coincident nodes or mesh the region again"),
                );
            }
        }
    }
}

/// Bars: material, section, ends.
fn check_bars(model: &Model, faults: &mut Faults) {
    let known = |node: &usize| *node < model.nodes.len();
    let sound = |node: &usize| known(node) && model.nodes[*node].iter().all(|x| x.is_finite());
    for part in &model.bars {
        let place = format!("`bar.{}`", part.name);
        check_material(&place, &part.material, faults);
        positive(&place, "area", part.section.area, "m²", faults);
        positive(&place, "first second moment", part.section.inertia_1, "m⁴", faults);
        positive(&place, "second second moment", part.section.inertia_2, "m⁴", faults);
        positive(&place, "torsion constant", part.section.torsion, "m⁴", faults);
        let missing = part.elements.iter().flatten().filter(|n| !known(n));
        missing_nodes(&place, missing, model.nodes.len(), faults);
        let bad = part
            .elements
            .iter()
            .find(|e| e.iter().all(sound) && BarElement::new(part, &model.nodes, **e).is_degenerate());
        if let Some([a, b]) = bad {
            faults.push(Fault::new(
                &place,
                format!("no length or an orientation along it between nodes {} and {}", a + 1, b + 1),
                "elements with a length, and an orientation that is not along them",
            ));
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

/// Rigid links and supports.
fn check_ties(model: &Model, faults: &mut Faults) {
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
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Sound,
    NoArea,
    Folded,
}

/// Whether all triangles of a face have an area and look the same way, and the elements of the part can be made of it.
fn shape(part: &ShellPart, nodes: &[[f64; 3]], face: &Cell) -> Shape {
    let split = split_face(face);
    let triangles: Vec<FlatTriangle> =
        split.iter().filter_map(|t| FlatTriangle::new(&t.nodes.map(|n| nodes[n]))).collect();
    if triangles.len() < split.len() {
        return Shape::NoArea;
    }
    let normals: Vec<[f64; 3]> = triangles.iter().map(FlatTriangle::normal).collect();
    let turned = |n: &[f64; 3]| n.iter().zip(normals[0]).map(|(a, b)| a * b).sum::<f64>() <= 0.0;
    let unusable = || part.elements_on(face, nodes).iter().any(|e| e.is_degenerate());
    if normals.iter().any(turned) || unusable() { Shape::Folded } else { Shape::Sound }
}

/// Checks the data that Mindlin's theory needs of a plate.
fn check_theory(place: &str, part: &ShellPart, faults: &mut Faults) {
    if let Some(kappa) = part.shear_coefficient {
        positive(place, "shear coefficient", kappa, "1", faults);
    }
    if part.theory == PlateTheory::Mindlin && !part.rotary_inertia {
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
    if model.shells.len() + model.bars.len() < 2 {
        return;
    }
    let shells = model.shells.iter().flat_map(|part| part.faces.iter().map(|f| (&part.name, f.nodes())));
    let bars = model.bars.iter().flat_map(|part| part.elements.iter().map(|e| (&part.name, &e[..])));
    let mut owners: HashMap<Vec<usize>, &String> = HashMap::new();
    let mut shared: BTreeMap<[&String; 2], usize> = BTreeMap::new();
    for (name, nodes) in shells.chain(bars) {
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
            ShellPart::new(name, faces, STEEL, 1e-3)
        };
        let nodes = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let apart = [plate("a", &[[0, 1, 2]]), plate("b", &[[1, 3, 2]])];
        let model = Model { nodes, shells: apart.to_vec(), ..Model::default() };
        assert!(check(&model).is_ok());
        let shared = [plate("a", &[[0, 1, 2]]), plate("b", &[[1, 3, 2], [2, 0, 1]])];
        let error = check(&Model { shells: shared.to_vec(), ..model }).unwrap_err().to_string();
        assert!(error.contains("part `b`: found 1 elements that `a` has, too"), "{error}");
    }
}
