//! The ties and averaging links of a case, and its springs between faces.

use super::counter::{CounterFaces, counter_faces};
use super::regions::Regions;
use crate::case::{Averaging, Case, SpringPer, SpringSet, Tie};
use crate::contact::tributary;
use crate::error::{Error, Fault, Faults, Result};
use crate::mesh::{Cell, cell_nodes, made_of};
use crate::numbers::{components, given};
use crate::structure::{self, Constraint, Coupling, Model, Part, Spring, Tied, averaging, tied};
use std::collections::BTreeMap;

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
        all.extend(faults.take(tie_of(name, tie, regions, model, warnings)));
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
    let nodes = cell_nodes(&cells);
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

fn tie_of(
    name: &str,
    tie: &Tie,
    regions: &Regions,
    model: &Model,
    warnings: &mut Vec<String>,
) -> Result<Coupling> {
    let place = format!("tie.{name}");
    let (found, sides) = projected(&place, [&tie.on, &tie.to], tie.within, (regions, model), warnings)?;
    let [own, other] = sides.map(|faces| mean_size(&faces, model));
    if let (Some(own), Some(other)) = (own, other)
        && own > COARSE * other
    {
        warnings.push(format!(
            "`{place}`: the faces of \"{}\" are {:.1} times as large as those of `{}`, whose nodes between are not joined: the joint is \
             too soft. Exchange `on` and `to`: the finer surface follows",
            tie.on,
            own / other,
            tie.to
        ));
    }
    if found.largest_gap > 0.0 {
        warnings.push(format!(
            "`{place}`: gaps up to {} m between \"{}\" and `{}` are kept, and bridged rigidly",
            given(found.largest_gap),
            tie.on,
            tie.to
        ));
    }
    Ok(Coupling { name: format!("`{place}`"), constraints: found.constraints })
}

/// The largest gap of nodes that a tie joins \[m\].
///
/// # Errors
/// As of the tie itself.
pub(super) fn largest_tied_gap(name: &str, tie: &Tie, regions: &Regions, model: &Model) -> Result<f64> {
    let surfaces = [tie.on.as_str(), tie.to.as_str()];
    let found = projected(&format!("tie.{name}"), surfaces, tie.within, (regions, model), &mut Vec::new())?;
    Ok(found.0.within)
}

/// Faces of a surface that follows may be so much larger than those of the other.
const COARSE: f64 = 1.2;

/// √(mean area) of faces \[m\], of half that of second order, which have a node in the middle of each side; none of lines.
fn mean_size(faces: &[Cell], model: &Model) -> Option<f64> {
    let area: f64 = tributary(&model.nodes, faces).iter().sum();
    let sides = faces.iter().map(|face| if face.kind().is_first_order() { 1.0 } else { 4.0 });
    let size = (area / sides.sum::<f64>()).sqrt();
    (size.is_finite() && faces.iter().all(|face| face.dimension() == 2)).then_some(size)
}

/// The surface `on`, projected on the surface `to`, and the cells of both; `warnings` say which nodes are too far away.
fn projected(
    place: &str,
    [on, to]: [&str; 2],
    within: Option<f64>,
    (regions, model): (&Regions, &Model),
    warnings: &mut Vec<String>,
) -> Result<(Tied, [Vec<Cell>; 2])> {
    let at = |key: &str| format!("`{place}.{key}`");
    let mut faults = Faults::new();
    let surface = faults.take(surface(&at("on"), on, regions, model));
    let master = faults.take(counter_faces(to, regions, model, (&at("to"), "")));
    let (surface, master) = faults.into_result((surface, master))?;
    let (Some((slave, cells)), Some(CounterFaces { part: master, faces, .. })) = (surface, master) else {
        return Err(Error::Input(Faults::new()));
    };
    let found =
        tied(&structure::Tie { nodes: &model.nodes, slave, cells: &cells, master, faces: &faces, within });
    let farthest = found.far.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    if found.following.is_empty() {
        let (what, help) = match farthest {
            Some((_, gap)) => {
                let nearest = found.far.iter().map(|(_, gap)| *gap).fold(*gap, f64::min);
                let (within, nearest) = (given(found.within), given(nearest));
                let what = format!("no node within {within} m of `{to}`: the nearest is {nearest} m away");
                let help = match place.starts_with("tie.") {
                    true => {
                        "Bring the surfaces together, check the unit of the mesh, or give a larger `within`"
                    }
                    false => "Bring the surfaces together, or check the unit of the mesh",
                };
                (what, help)
            }
            None => (format!("nodes that `{to}` has, too"), "They are joined already: remove this table"),
        };
        let fault = Fault::new(at("on"), what, "nodes near the other surface, that are not its own");
        return Err(Error::input(fault.with_help(help)));
    }
    if let Some((node, gap)) = farthest {
        let far: Vec<usize> = found.far.iter().map(|(node, _)| *node).collect();
        let nodes = regions.count_of_nodes(&far);
        warnings.push(format!(
            "`{place}`: {} of \"{on}\" {} not joined to `{to}`: farther than {} m, at most {} m at {} m",
            nodes.trim_end_matches(','),
            if far.len() == 1 { "is" } else { "are" },
            given(found.within),
            given(*gap),
            components(model.nodes[*node])
        ));
    }
    Ok((found, [cells, faces]))
}

/// The cells of a region of faces on one shell or solid, or of lines on one shell, and that part.
fn surface<'a>(
    place: &str,
    name: &str,
    regions: &Regions,
    model: &'a Model,
) -> Result<(&'a Part, Vec<Cell>)> {
    let region = regions.region(name, place)?;
    let expected = "faces of one shell or solid, or lines on the edge of a shell";
    let refused =
        |found: String, help: &str| Error::input(Fault::new(place, found, expected).with_help(help));
    let Some(part) = model.part_with(&regions.mesh.region_nodes(region)) else {
        let found = format!("region \"{name}\", whose nodes are not all on one shell or one solid");
        return Err(refused(
            found,
            "Name the surface of each part by itself, as a physical group of the mesh",
        ));
    };
    if region.dimension == 2 || region.dimension == 1 && part.as_shell().is_some() {
        return Ok((part, regions.cells(region)));
    }
    let found = format!("region \"{name}\" of {} on `{}`", made_of(region.dimension), part.name);
    Err(refused(found, "Give the surface a name of its own, as a physical group of the mesh"))
}

/// Adds the springs of the case that are spread over faces. The far end of each, where it is not the ground, is a node of its own that
/// follows the other face as a tie does.
pub fn add_area_springs(
    case: &Case,
    regions: &Regions,
    model: &mut Model,
    warnings: &mut Vec<String>,
    faults: &mut Faults,
) {
    for (name, set) in case.spring.iter().filter(|(_, set)| set.per == SpringPer::Area) {
        faults.take(area_springs(name, set, regions, model, warnings));
    }
}

fn area_springs(
    name: &str,
    set: &SpringSet,
    regions: &Regions,
    model: &mut Model,
    warnings: &mut Vec<String>,
) -> Result<()> {
    let place = format!("spring.{name}");
    let region = regions.region(&set.on, &format!("`{place}.on`"))?;
    if region.dimension != 2 {
        let found = format!("region \"{}\" of {}, with `per = \"area\"`", set.on, made_of(region.dimension));
        return Err(Error::input(Fault::new(format!("`{place}.on`"), found, "a region of faces")));
    }
    let weights = tributary(&model.nodes, &regions.cells(region));
    let nodes = regions.mesh.region_nodes(region);
    let mut ends: Vec<(usize, Option<usize>)> = nodes.iter().map(|node| (*node, None)).collect();
    if let Some(to) = &set.to {
        let (found, _) = projected(&place, [&set.on, to], None, (regions, model), warnings)?;
        let mut far = BTreeMap::new();
        for node in &found.following {
            far.insert(*node, model.nodes.len());
            model.nodes.push(model.nodes[*node]);
        }
        // Of the plate's own rotations the far end has those of the node that it belongs to.
        let displacements = found.constraints.into_iter().filter(|constraint| constraint.slave.1 < 3);
        let moved = displacements.map(|c| Constraint { slave: (far[&c.slave.0], c.slave.1), ..c });
        let coupling = Coupling { name: format!("`{place}`"), constraints: moved.collect() };
        model.couplings.push(coupling);
        ends = far.into_iter().map(|(node, far)| (node, Some(far))).collect();
    }
    model.springs.extend(ends.into_iter().map(|(node, other)| Spring {
        node,
        other,
        direction: set.direction,
        rotational: false,
        stiffness: set.stiffness * weights[node],
        damping: set.damping * weights[node],
    }));
    Ok(())
}
