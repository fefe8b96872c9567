//! Case and mesh → the plain description of the structure, for the whole or for some of its parts.

use super::couplings::{add_area_springs, add_couplings};
use super::links::{add_links, check_turning};
use super::regions::Regions;
use super::rotation::add_rotations;
use crate::case::{Case, ModesAnalysis, SpringPer};
use crate::error::{Fault, Faults, Result};
use crate::mesh::Cell;
use crate::structure::{Bar, Coupling, Model, Part, PointMass, Shell, Solid, Spring, Support};

/// The structure of the whole case with its equations; `warnings` take what the user should know of it.
///
/// # Errors
/// Every region that is missing or of the wrong kind, constraints that contradict each other.
pub fn whole_model(
    case: &Case,
    regions: &Regions,
    equations: Vec<Coupling>,
    warnings: &mut Vec<String>,
) -> Result<Model> {
    let mut faults = Faults::new();
    let mut model = Model { nodes: regions.mesh.nodes.clone(), ..Model::default() };
    for (name, shell) in &case.shell {
        let faces = faults.take(regions.elements(name, 2, &format!("`shell.{name}`")));
        let plate = Shell {
            theory: shell.theory,
            bending_only: shell.bending_only,
            rotary_inertia: shell.rotary_inertia,
            ..Shell::new(case.material[&shell.material], shell.thickness)
        };
        model.parts.push(Part::new(name, faces.unwrap_or_default(), plate));
    }
    for (name, bar) in &case.bar {
        let lines = faults.take(regions.elements(name, 1, &format!("`bar.{name}`")));
        let (material, section) = (case.material[&bar.material], bar.profile.section());
        let bar = Bar { material, section, orientation: bar.orientation };
        model.parts.push(Part::new(name, lines.unwrap_or_default(), bar));
    }
    for (name, solid) in &case.solid {
        let place = format!("`solid.{name}`");
        let cells = faults.take(regions.solids(name, solid.allow_locking, &place));
        let solid = Solid { material: case.material[&solid.material], integration: solid.integration };
        model.parts.push(Part::new(name, cells.unwrap_or_default(), solid));
    }
    for (name, mass) in &case.mass {
        for node in faults.take(regions.nodes(&mass.on, &format!("`mass.{name}.on`"))).unwrap_or_default() {
            model.masses.push(PointMass { node, mass: mass.mass, inertia: mass.inertia });
        }
    }
    for (name, spring) in case.spring.iter().filter(|(_, spring)| spring.per == SpringPer::Region) {
        let nodes =
            faults.take(regions.nodes(&spring.on, &format!("`spring.{name}.on`"))).unwrap_or_default();
        let other =
            spring.to.as_ref().and_then(|to| faults.take(regions.node(to, &format!("`spring.{name}.to`"))));
        if let Some(node) = other.filter(|other| nodes.contains(other)) {
            let found = format!("{}, which is in region \"{}\", too", regions.name_of_node(node), spring.on);
            let expected = "a point that is not among those of `on`, or no `to` for a spring to the ground";
            faults.push(Fault::new(format!("`spring.{name}.to`"), found, expected));
        }
        for node in &nodes {
            model.springs.push(Spring {
                node: *node,
                other,
                direction: spring.direction,
                rotational: spring.rotational,
                stiffness: spring.stiffness / nodes.len() as f64,
                damping: spring.damping / nodes.len() as f64,
            });
        }
    }
    add_area_springs(case, regions, &mut model, warnings, &mut faults);
    add_couplings(case, regions, &mut model, warnings, &mut faults);
    model.couplings.extend(equations);
    add_links(case, regions, &mut model, &mut faults);
    check_turning(case, regions, &model, &mut faults);
    add_rotations(case, &mut model, warnings, &mut faults);
    faults.into_result(model)
}

/// The structure of the parts that one analysis of real modes names, held as it says, at rest.
///
/// # Errors
/// A region to clamp that is missing.
pub fn part_model(regions: &Regions, whole: &Model, name: &str, analysis: &ModesAnalysis) -> Result<Model> {
    let mut faults = Faults::new();
    let wanted = |part: &str| analysis.parts.is_empty() || analysis.parts.iter().any(|p| p == part);
    let mut model = Model {
        nodes: whole.nodes.clone(),
        parts: whole.parts.iter().filter(|part| wanted(&part.name)).cloned().collect(),
        masses: whole.masses.clone(),
        ..Model::default()
    };
    if !analysis.free {
        model.springs = whole.springs.clone();
        model.links = whole.links.clone();
        model.couplings = whole.couplings.clone();
        model.supports = whole.supports.clone();
        model.inclined_supports = whole.inclined_supports.clone();
    }
    let clamp = regions.nodes_of(&analysis.clamp, &format!("`modes.{name}.clamp`"), &mut faults);
    // Of the whole, points that no cell has, too: masters of rigid bodies, ends of springs, nodes of equations.
    let mut used = vec![analysis.parts.is_empty(); model.nodes.len()];
    model.parts.iter().flat_map(|part| &part.cells).flat_map(Cell::nodes).for_each(|n| used[*n] = true);
    // The far ends of springs that are spread over faces.
    let ends = regions.mesh.nodes.len();
    for constraint in model.couplings.iter().flat_map(|coupling| &coupling.constraints) {
        let slave = constraint.slave.0;
        used[slave] |= slave >= ends && constraint.terms.iter().all(|(node, ..)| used[*node]);
    }
    // What hangs on nodes of other parts stays out; so does a rigid body whose clamped followers already hold it.
    model.masses.retain(|mass| used[mass.node]);
    model.springs.retain(|spring| used[spring.node] && spring.other.is_none_or(|n| used[n]));
    model.links.retain(|link| used[link.master] && !link.slaves.iter().any(|s| clamp.contains(s)));
    for link in &mut model.links {
        link.slaves.retain(|slave| used[*slave]);
    }
    for coupling in &mut model.couplings {
        coupling.constraints.retain(|constraint| {
            let slave = constraint.slave.0;
            used[slave] && !clamp.contains(&slave) && constraint.terms.iter().all(|(node, ..)| used[*node])
        });
    }
    model.inclined_supports.retain(|support| used[support.node] && !clamp.contains(&support.node));
    for support in &mut model.supports {
        support.nodes.retain(|node| used[*node] && !clamp.contains(node));
    }
    model.supports.push(Support { nodes: clamp, held: [true; 6] });
    model.supports.retain(|support| !support.nodes.is_empty());
    faults.into_result(model)
}
