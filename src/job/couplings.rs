//! The ties and averaging links of a case.

use super::counter::{CounterFaces, counter_faces};
use super::regions::Regions;
use crate::case::{Averaging, Case, Tie};
use crate::contact::tributary;
use crate::error::{Error, Fault, Faults, Result};
use crate::mesh::{Cell, made_of};
use crate::numbers::{components, given};
use crate::structure::{Coupling, Model, averaging, tied};

/// Adds the ties and the averaging links of the case to `model`; `warnings` say what of a tie is not joined, and which gaps are kept.
pub fn add_couplings(
    case: &Case,
    regions: &Regions,
    model: &mut Model,
    warnings: &mut Vec<String>,
    faults: &mut Faults,
) {
    let mut all = Vec::new();
    for (name, link) in &case.averaging {
        all.extend(faults.take(averaging_link(name, link, regions, model)));
    }
    for (name, tie) in &case.tie {
        all.extend(faults.take(surfaces(name, tie, regions, model, warnings)));
    }
    model.couplings.extend(all);
}

fn averaging_link(name: &str, link: &Averaging, regions: &Regions, model: &Model) -> Result<Coupling> {
    let mut faults = Faults::new();
    let place = format!("`averaging.{name}.of`");
    let point = faults.take(regions.node(&link.point, &format!("`averaging.{name}.point`")));
    let mut cells: Vec<Cell> = Vec::new();
    let mut dimensions: Vec<usize> = Vec::new();
    for region in link.of.iter().filter_map(|of| faults.take(regions.region(of, &place))) {
        cells.extend(regions.cells(region));
        dimensions.push(region.dimension);
    }
    let (point, cells) = faults.into_result((point.unwrap_or_default(), cells))?;
    let nodes = {
        let mut nodes: Vec<usize> = cells.iter().flat_map(Cell::nodes).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    if nodes.contains(&point) {
        let found = format!("{}, the point itself, among them", regions.name_of_node(point));
        let fault = Fault::new(place, found, "regions without the point");
        return Err(Error::input(fault.with_help("Make a [point] of its own that follows them")));
    }
    // By areas where all are faces, by lengths where all are lines; solids and points count node by node.
    let weights = match dimensions[..] {
        [first, ..] if dimensions.iter().all(|d| *d == first) && (1..=2).contains(&first) => {
            tributary(&model.nodes, &cells)
        }
        _ => vec![1.0; model.nodes.len()],
    };
    let weighted: Vec<(usize, f64)> = nodes.iter().map(|node| (*node, weights[*node])).collect();
    let Some(constraints) = averaging(&model.nodes, point, &weighted) else {
        let found = format!("{} on one line", regions.count_of_nodes(&nodes).trim_end_matches(','));
        let fault = Fault::new(place, found, "nodes off a line, about which their rotation is known");
        return Err(Error::input(fault.with_help("Name a region of faces, or join the point by [rigid]")));
    };
    Ok(Coupling { name: format!("`averaging.{name}`"), constraints })
}

fn surfaces(
    name: &str,
    tie: &Tie,
    regions: &Regions,
    model: &Model,
    warnings: &mut Vec<String>,
) -> Result<Coupling> {
    let [on, to] = ["on", "to"].map(|key| format!("`tie.{name}.{key}`"));
    let mut faults = Faults::new();
    let region = faults.take(regions.region(&tie.on, &on));
    let master = faults.take(counter_faces(&tie.to, regions, model, (&to, "")));
    let (Some(region), Some(CounterFaces { part: master, faces })) = faults.into_result((region, master))?
    else {
        return Ok(Coupling { name: format!("`tie.{name}`"), constraints: Vec::new() });
    };
    let nodes = regions.mesh.region_nodes(region);
    let expected = "faces of one shell or solid, or lines on the edge of a shell";
    let refused = |found: String, help: &str| Error::input(Fault::new(&on, found, expected).with_help(help));
    let Some(slave) = model.part_with(&nodes) else {
        let found = format!("region \"{}\", whose nodes are not all on one shell or one solid", tie.on);
        return Err(refused(found, "Tie each part by a [tie] of its own"));
    };
    if !(region.dimension == 2 || region.dimension == 1 && slave.as_shell().is_some()) {
        let found = format!("region \"{}\" of {} on `{}`", tie.on, made_of(region.dimension), slave.name);
        return Err(refused(found, "Give the surface a name of its own, as a physical group of the mesh"));
    }
    let cells = regions.cells(region);
    let found = tied(&crate::structure::Tie {
        nodes: &model.nodes,
        slave,
        cells: &cells,
        master,
        faces: &faces,
        within: tie.within,
    });
    let farthest = found.far.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    if found.following.is_empty() {
        let (found, help) = match farthest {
            Some((_, gap)) => {
                let nearest = found.far.iter().map(|(_, gap)| *gap).fold(*gap, f64::min);
                let found = format!(
                    "no node within {} m of `{}`: the nearest is {} m away",
                    given(found.within),
                    tie.to,
                    given(nearest)
                );
                (
                    found,
                    format!(
                        "Bring the surfaces together, check the unit of the mesh, or say `within = {:.3e}`",
                        1.01 * nearest
                    ),
                )
            }
            None => {
                (format!("nodes that `{}` has, too", tie.to), "They are joined: remove the tie".to_string())
            }
        };
        let fault = Fault::new(&on, found, "nodes near the other surface, that are not its own");
        return Err(Error::input(fault.with_help(help)));
    }
    if let Some((node, gap)) = farthest {
        let far: Vec<usize> = found.far.iter().map(|(node, _)| *node).collect();
        warnings.push(format!(
            "`tie.{name}`: {} of \"{}\" not joined to `{}`: farther than {} m, at most {} m at ({}) m",
            match far[..] {
                [_] => format!("{} is", regions.count_of_nodes(&far)),
                _ => format!("{} are", regions.count_of_nodes(&far).trim_end_matches(',')),
            },
            tie.on,
            tie.to,
            given(found.within),
            given(*gap),
            components(model.nodes[*node])
        ));
    }
    if found.largest_gap > 0.0 {
        warnings.push(format!(
            "`tie.{name}`: gaps up to {} m between \"{}\" and `{}` are kept, and bridged rigidly",
            given(found.largest_gap),
            tie.on,
            tie.to
        ));
    }
    Ok(Coupling { name: format!("`tie.{name}`"), constraints: found.constraints })
}
