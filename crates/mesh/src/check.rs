//! Check of a mesh: all faults at once, in the numbers of its file.
//!
//! Faults make an analysis wrong or impossible; warnings say that a result may be poor.

use super::coincident::coincident;
use super::hanging::{Hanging, hanging};
use super::jacobian::keeps_orientation;
use super::orient::neighbours;
use super::quality::face_shape;
use super::{Cell, Mesh, Region};
use std::collections::{BTreeMap, BTreeSet, HashSet};
use stridor_base::connected::lowest_connected;
use stridor_base::error::{Fault, Faults};
use stridor_base::numbers::significant;

/// The smallest corner angle \[degrees\] that passes without a warning.
pub const POOR_ANGLE_DEG: f64 = 15.0;
/// The largest longest-to-shortest edge that passes without a warning.
pub const POOR_ASPECT: f64 = 8.0;
/// The largest warp of a quadrilateral that passes without a warning.
pub const POOR_WARP: f64 = 0.05;
/// How many numbers a message lists before it says how many more there are.
const LISTED: usize = 5;

/// Faults and warnings of a mesh.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Diagnosis {
    /// Faults: no analysis should take this mesh.
    pub faults: Faults,
    /// Warnings: results may be poor.
    pub warnings: Vec<Fault>,
}

/// Examines a mesh: coordinates, unreferenced, coincident and hanging nodes, duplicate, degenerate, folded and inverted
/// elements, their quality, and regions in several pieces.
///
/// ```
/// use stridor_mesh::{self as mesh, generate};
/// let diagnosis = mesh::diagnose(&generate::rig(&generate::RigSpec::small())?);
/// assert!(diagnosis.faults.0.is_empty() && diagnosis.warnings.is_empty());
/// # Ok::<(), stridor_base::error::Error>(())
/// ```
pub fn diagnose(mesh: &Mesh) -> Diagnosis {
    diagnose_apart(mesh, &[], HashSet::new())
}

/// The same of a mesh in which the two regions of each pair are in contact, or tied: their nodes may be in the same place, or on each other's
/// edges, without being joined; so may nodes that are `following` others by equations.
pub fn diagnose_apart(mesh: &Mesh, pairs: &[[&str; 2]], following: HashSet<usize>) -> Diagnosis {
    let mut faults = Faults::new();
    check_coordinates(mesh, &mut faults);
    if !faults.0.is_empty() {
        // Nothing else can be measured.
        return Diagnosis { faults, warnings: Vec::new() };
    }
    let mut diagnosis = Diagnosis { faults, warnings: Vec::new() };
    check_unreferenced(mesh, &mut diagnosis);
    let apart = Apart::new(mesh, pairs, following);
    check_coincident(mesh, &apart, &mut diagnosis);
    check_hanging(mesh, &apart, &mut diagnosis.warnings);
    check_shapes(mesh, &mut diagnosis);
    for region in &mesh.regions {
        check_duplicates(mesh, region, &mut diagnosis.faults);
        check_orientation(mesh, region, &mut diagnosis.faults);
    }
    check_pieces(mesh, &mut diagnosis.warnings);
    diagnosis
}

struct Apart {
    /// The nodes of regions that are in contact or tied, a pair of sets each.
    pairs: Vec<[HashSet<usize>; 2]>,
    /// The nodes that follow others by equations.
    following: HashSet<usize>,
}

impl Apart {
    fn new(mesh: &Mesh, pairs: &[[&str; 2]], following: HashSet<usize>) -> Self {
        let nodes = |name: &str| -> HashSet<usize> {
            mesh.region(name).map_or(HashSet::new(), |region| mesh.region_nodes(region).into_iter().collect())
        };
        Apart { pairs: pairs.iter().map(|pair| pair.map(nodes)).collect(), following }
    }

    /// Whether all of `a` are on one side of a contact and all of `b` on the other, or either follow others.
    fn are(&self, a: &[usize], b: &[usize]) -> bool {
        let on = |nodes: &[usize], side: &HashSet<usize>| nodes.iter().all(|node| side.contains(node));
        let apart =
            |[one, other]: &[HashSet<usize>; 2]| on(a, one) && on(b, other) || on(a, other) && on(b, one);
        on(a, &self.following) || on(b, &self.following) || self.pairs.iter().any(apart)
    }
}

/// `3 (line 12), 5 (line 14) and 312 more`.
fn list(places: impl ExactSizeIterator<Item = String>) -> String {
    let count = places.len();
    let mut text = places.take(LISTED).collect::<Vec<_>>().join(", ");
    if count > LISTED {
        text += &format!(" and {} more", count - LISTED);
    }
    text
}

fn elements(mesh: &Mesh, which: &[usize]) -> String {
    format!("element {}", list(which.iter().map(|e| mesh.element_place(*e))))
}

fn nodes(mesh: &Mesh, which: &[usize]) -> String {
    format!("node {}", list(which.iter().map(|n| mesh.node_place(*n))))
}

fn check_coordinates(mesh: &Mesh, faults: &mut Faults) {
    let bad: Vec<usize> =
        (0..mesh.nodes.len()).filter(|n| !mesh.nodes[*n].iter().all(|c| c.is_finite())).collect();
    if !bad.is_empty() {
        let found = format!("coordinates that are infinite or not a number ({} nodes)", bad.len());
        faults.push(Fault::new(nodes(mesh, &bad), found, "three finite numbers a node"));
    }
    let bad: Vec<usize> = (0..mesh.elements.len())
        .filter(|e| mesh.elements[*e].nodes().iter().any(|n| *n >= mesh.nodes.len()))
        .collect();
    if !bad.is_empty() {
        faults.push(Fault::new(elements(mesh, &bad), "a node that does not exist", "nodes of the mesh"));
    }
}

fn check_unreferenced(mesh: &Mesh, diagnosis: &mut Diagnosis) {
    let mut used = vec![false; mesh.nodes.len()];
    mesh.elements.iter().flat_map(Cell::nodes).for_each(|n| used[*n] = true);
    let stray: Vec<usize> = (0..used.len()).filter(|n| !used[*n]).collect();
    if !stray.is_empty() {
        let found = format!("{} nodes that no element uses", stray.len());
        let fault = Fault::new(nodes(mesh, &stray), found, "every node to belong to an element");
        diagnosis
            .faults
            .push(fault.with_help("They would have no stiffness; remove them or name their elements"));
    }
    let unused = &mesh.origin.unused_nodes;
    if !unused.is_empty() {
        diagnosis.warnings.push(
            Fault::new(
                format!("node {}", list(unused.iter().map(u64::to_string))),
                format!("{} nodes of the file that no element of a named physical group uses", unused.len()),
                "none",
            )
            .with_help("They are left out; if a part is missing, give it a physical group"),
        );
    }
}

/// Nodes at the same place: a fault inside a region (a hidden crack), a warning between regions.
fn check_coincident(mesh: &Mesh, apart: &Apart, diagnosis: &mut Diagnosis) {
    let mut pairs = coincident(&mesh.nodes);
    pairs.retain(|[n, m]| !apart.are(&[*n], &[*m]));
    if pairs.is_empty() {
        return;
    }
    let mut regions_of: BTreeMap<usize, Vec<usize>> =
        pairs.iter().flatten().map(|n| (*n, Vec::new())).collect();
    // Points hold nothing together.
    for (r, region) in mesh.regions.iter().enumerate().filter(|(_, region)| region.dimension > 0) {
        for e in &region.elements {
            for n in mesh.elements[*e].nodes() {
                if let Some(regions) = regions_of.get_mut(n) {
                    regions.push(r);
                }
            }
        }
    }
    let (within, between): (Vec<_>, Vec<_>) =
        pairs.iter().partition(|[i, j]| regions_of[i].iter().any(|r| regions_of[j].contains(r)));
    let text = |pairs: &[[usize; 2]]| {
        let tags = |p: &[usize; 2]| format!("{} and {}", mesh.node_place(p[0]), mesh.node_place(p[1]));
        let more = pairs.len().saturating_sub(LISTED);
        let first = pairs.iter().take(LISTED).map(tags).collect::<Vec<_>>().join("; ");
        format!("nodes {first}{}", if more > 0 { format!("; and {more} more pairs") } else { String::new() })
    };
    if !within.is_empty() {
        let fault = Fault::new(text(&within), "two nodes at the same place in one region", "one node");
        diagnosis
            .faults
            .push(fault.with_help("The part would be torn open there; merge them (Gmsh: `Coherence Mesh;`)"));
    }
    if !between.is_empty() {
        let fault =
            Fault::new(text(&between), "two nodes at the same place in different regions", "one node");
        diagnosis.warnings.push(fault.with_help(
            "The parts are not joined there unless the case joins them: merge the nodes (Gmsh: `Coherence Mesh;`), or join the surfaces by \
             `[tie]`",
        ));
    }
}

/// Nodes on edges of faces that do not have them: two meshes side by side that are not joined.
fn check_hanging(mesh: &Mesh, apart: &Apart, warnings: &mut Vec<Fault>) {
    let mut found = hanging(mesh);
    found.retain(|hanging| !apart.are(&[hanging.node], &hanging.edge));
    if found.is_empty() {
        return;
    }
    let regions_of = |holds: &dyn Fn(&[usize]) -> bool| -> Vec<usize> {
        let has = |region: &Region| {
            (1..=3).contains(&region.dimension)
                && region.elements.iter().any(|e| holds(mesh.elements[*e].nodes()))
        };
        (0..mesh.regions.len()).filter(|r| has(&mesh.regions[*r])).collect()
    };
    let Hanging { node, edge } = found[0];
    let mut names: Vec<usize> = regions_of(&|nodes| nodes.contains(&node));
    names.extend(regions_of(&|nodes| edge.iter().all(|end| nodes.contains(end))));
    names.sort_unstable();
    names.dedup();
    let names: Vec<String> = names.iter().map(|r| format!("`{}`", mesh.regions[*r].name)).collect();
    let which: Vec<usize> = found.iter().map(|hanging| hanging.node).collect();
    let [i, j] = edge.map(|end| mesh.node_place(end));
    let place = mesh.nodes[node].map(|x| significant(x, 4)).join(", ");
    let words = format!(
        "{} nodes on edges of faces or on lines that do not have them; the first at ({place}) m, between nodes {i} and {j}, in {}",
        which.len(),
        names.join(", ")
    );
    let help = "They are not joined there: mesh both sides with the same nodes (one curve between both surfaces; in Gmsh \
                `Coherence;` or `BooleanFragments`), or join the edge or the faces of one side to the other side by `[tie]`";
    warnings.push(Fault::new(nodes(mesh, &which), words, "nodes that both sides have").with_help(help));
}

fn check_shapes(mesh: &Mesh, diagnosis: &mut Diagnosis) {
    let (mut degenerate, mut folded, mut inverted) = (vec![], vec![], vec![]);
    let (mut sharp, mut slender, mut warped) = (vec![], vec![], vec![]);
    let mut worst = [f64::INFINITY, 0.0, 0.0];
    for (e, element) in mesh.elements.iter().enumerate() {
        let n = element.nodes();
        let repeated = (1..n.len()).any(|i| n[..i].contains(&n[i]));
        if repeated {
            degenerate.push(e);
            continue;
        }
        if let ([i, j], 1) = (element.corners(), element.dimension())
            && mesh.nodes[*i] == mesh.nodes[*j]
        {
            degenerate.push(e);
        }
        if !keeps_orientation(mesh, element) {
            inverted.push(e);
            continue;
        }
        let Some(shape) = face_shape(mesh, element) else { continue };
        if shape.area <= 1e-6 * shape.edges[1].powi(2) {
            degenerate.push(e);
            continue;
        }
        if shape.convexity <= 0.0 {
            folded.push(e);
            continue;
        }
        let aspect = shape.edges[1] / shape.edges[0];
        worst = [worst[0].min(shape.angles[0].to_degrees()), worst[1].max(aspect), worst[2].max(shape.warp)];
        for (poor, which) in [
            (shape.angles[0].to_degrees() < POOR_ANGLE_DEG, &mut sharp),
            (aspect > POOR_ASPECT, &mut slender),
            (shape.warp > POOR_WARP, &mut warped),
        ] {
            if poor {
                which.push(e);
            }
        }
    }
    if !degenerate.is_empty() {
        let found = format!("{} elements without length or area", degenerate.len());
        diagnosis.faults.push(Fault::new(
            elements(mesh, &degenerate),
            found,
            "distinct nodes, not in line, in order around the element",
        ));
    }
    if !folded.is_empty() {
        let found = format!("{} quadrilaterals that are folded or not convex", folded.len());
        diagnosis.faults.push(Fault::new(
            elements(mesh, &folded),
            found,
            "corners in order around the element",
        ));
    }
    if !inverted.is_empty() {
        let kinds: BTreeSet<&str> = inverted.iter().map(|e| mesh.elements[*e].kind().table().name).collect();
        let kinds: Vec<&str> = kinds.into_iter().collect();
        let found = format!("{} elements turned inside out ({})", inverted.len(), kinds.join(", "));
        let help = "Nodes in another order, corners that are crossed, or a node in the middle of an edge that lies beyond a quarter of it; of curved faces in Gmsh \
                    `Mesh.HighOrderOptimize = 2;`, or another element size, may help";
        let expected = "a positive Jacobian at every node";
        diagnosis.faults.push(Fault::new(elements(mesh, &inverted), found, expected).with_help(help));
    }
    let mut warn = |which: Vec<usize>, found: String, expected: String| {
        if !which.is_empty() {
            diagnosis.warnings.push(Fault::new(elements(mesh, &which), found, expected));
        }
    };
    let found = format!("{} sharp elements, smallest angle {:.1}°", sharp.len(), worst[0]);
    warn(sharp, found, format!("angles above {POOR_ANGLE_DEG}°"));
    let found = format!("{} slender elements, edges in the ratio {:.1}", slender.len(), worst[1]);
    warn(slender, found, format!("a ratio below {POOR_ASPECT}"));
    let found = format!("{} warped quadrilaterals, by {:.3} of an edge", warped.len(), worst[2]);
    warn(warped, found, format!("at most {POOR_WARP}"));
}

fn check_duplicates(mesh: &Mesh, region: &Region, faults: &mut Faults) {
    let mut keys: Vec<(Vec<usize>, usize)> = region
        .elements
        .iter()
        .map(|e| {
            let mut key = mesh.elements[*e].corners().to_vec();
            key.sort_unstable();
            (key, *e)
        })
        .collect();
    keys.sort_unstable();
    let mut twice: Vec<usize> = keys.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| w[1].1).collect();
    twice.sort_unstable();
    if !twice.is_empty() {
        let found =
            format!("{} elements on the nodes of another one in region `{}`", twice.len(), region.name);
        faults.push(Fault::new(elements(mesh, &twice), found, "each element once"));
    }
}

/// Neighbours that are turned opposite ways; a file's are turned alike when it is read, unless its surface has one side.
fn check_orientation(mesh: &Mesh, region: &Region, faults: &mut Faults) {
    let clashing = neighbours(mesh, region).into_iter().filter(|pair| pair.opposite);
    let mut clashing: Vec<[usize; 2]> = clashing.map(|pair| pair.faces).collect();
    clashing.sort_unstable();
    if let Some([e, f]) = clashing.first() {
        let place = format!("elements {} and {}", mesh.element_place(*e), mesh.element_place(*f));
        let found = format!(
            "neighbours turned opposite ways in region `{}` ({} edges like this)",
            region.name,
            clashing.len()
        );
        let fault = Fault::new(place, found, "one side up for the whole region");
        faults.push(fault.with_help("In Gmsh, `ReverseMesh Surface{…};` turns a surface's elements over"));
    }
}

/// Pieces nearer to each other than this part of their size touch.
const TOUCHING: f64 = 1e-6;

/// Regions that may be parts and are in pieces that touch, in one warning: of a mesh with solids these alone, as surfaces often are. Pieces that are
/// apart, as the linings on both sides of a disc, are one part on purpose.
fn check_pieces(mesh: &Mesh, warnings: &mut Vec<Fault>) {
    let solids = mesh.regions.iter().any(|region| region.dimension == 3);
    let parts = mesh.regions.iter().filter(|region| region.dimension >= if solids { 3 } else { 1 });
    for region in parts {
        let boxes = pieces(mesh, region);
        let near = |a: &[[f64; 3]; 2], b: &[[f64; 3]; 2]| {
            let size = (0..3).map(|k| a[1][k].max(b[1][k]) - a[0][k].min(b[0][k])).fold(0.0, f64::max);
            (0..3).all(|k| a[0][k].max(b[0][k]) - a[1][k].min(b[1][k]) <= TOUCHING * size)
        };
        let touching = (1..boxes.len()).any(|i| boxes[..i].iter().any(|other| near(&boxes[i], other)));
        if touching {
            let found = format!("{} pieces that touch and share no node", boxes.len());
            warnings.push(
                Fault::new(format!("region `{}`", region.name), found, "one")
                    .with_help("Where they should be one part, merge their nodes"),
            );
        }
    }
}

/// The number of pieces of a region that share no node.
pub(super) fn count_pieces(mesh: &Mesh, region: &Region) -> usize {
    pieces(mesh, region).len()
}

/// The boxes about the pieces of a region that share no node.
fn pieces(mesh: &Mesh, region: &Region) -> Vec<[[f64; 3]; 2]> {
    let elements = region.elements.iter().map(|e| mesh.elements[*e].nodes());
    let lowest = lowest_connected(mesh.nodes.len(), elements);
    let mut boxes: BTreeMap<usize, [[f64; 3]; 2]> = BTreeMap::new();
    for node in mesh.region_nodes(region) {
        let p = mesh.nodes[node];
        let of = boxes.entry(lowest[node]).or_insert([p; 2]);
        *of = around(*of, p);
    }
    boxes.into_values().collect()
}

/// A box about a box and a point.
fn around([low, high]: [[f64; 3]; 2], p: [f64; 3]) -> [[f64; 3]; 2] {
    [[0, 1, 2].map(|k| low[k].min(p[k])), [0, 1, 2].map(|k| high[k].max(p[k]))]
}

/// The corners of the bounding box; `None` for a mesh without nodes.
pub(super) fn bounds(mesh: &Mesh) -> Option<[[f64; 3]; 2]> {
    let first = *mesh.nodes.first()?;
    Some(mesh.nodes.iter().fold([first; 2], |of, p| around(of, *p)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CellKind;
    use crate::Origin;
    use crate::generate::structured_box;
    use crate::generate::{Faces, structured_plate};

    /// A 2 × 2 plate of quadrilaterals whose file numbers nodes from 101 and elements from 501.
    fn plate() -> Mesh {
        let mut mesh = structured_plate(2.0, 2.0, 2, 2, Faces::Quadrilaterals).unwrap();
        mesh.origin = Origin {
            node_tags: (101..101 + mesh.nodes.len() as u64).collect(),
            element_tags: (501..501 + mesh.elements.len() as u64).collect(),
            ..Origin::default()
        };
        mesh
    }

    /// Two boxes of one region, a gap apart.
    #[test]
    fn pieces_that_touch_are_warned_of_and_pieces_apart_are_one_part() {
        for (gap, touches) in [(0.0, true), (1e-9, true), (-0.2, true), (1e-3, false), (0.5, false)] {
            let mut mesh = structured_box(CellKind::Hexahedron8, [1.0, 2.0, 1.0], [1, 1, 1]).unwrap();
            let mut other = mesh.clone();
            let offset = mesh.nodes.len();
            other.nodes.iter_mut().for_each(|p| p[0] += 1.0 + gap);
            mesh.nodes.extend(other.nodes);
            let solids = mesh.regions.iter_mut().find(|region| region.dimension == 3).unwrap();
            let second: Vec<usize> = (0..solids.elements.len()).map(|k| mesh.elements.len() + k).collect();
            let own = solids.elements.clone();
            solids.elements.extend(second);
            for e in own {
                let nodes: Vec<usize> = mesh.elements[e].nodes().iter().map(|n| n + offset).collect();
                mesh.elements.push(Cell::new(CellKind::Hexahedron8, &nodes).unwrap());
            }
            let solids = mesh.regions.iter().find(|region| region.dimension == 3).unwrap();
            assert_eq!(count_pieces(&mesh, solids), 2);
            let said = diagnose(&mesh)
                .warnings
                .iter()
                .filter(|fault| fault.to_string().contains("share no node"))
                .count();
            assert_eq!(said, usize::from(touches), "{gap}");
        }
    }

    fn one_fault(mesh: &Mesh) -> String {
        let diagnosis = diagnose(mesh);
        assert_eq!(diagnosis.faults.0.len(), 1, "{}", diagnosis.faults);
        diagnosis.faults.to_string()
    }

    #[test]
    fn a_sound_plate_has_nothing_to_say() {
        assert_eq!(diagnose(&plate()), Diagnosis::default());
    }

    #[test]
    fn each_fault_is_found_and_named_by_the_tags_of_the_file() {
        let mut mesh = plate();
        mesh.nodes[3][1] = f64::NAN;
        mesh.nodes[4][0] = f64::INFINITY;
        assert!(one_fault(&mesh).contains("node 104, 105"));

        let mut mesh = plate();
        mesh.elements[2] = Cell::quadrilateral([3, 4, 7, 99]);
        assert!(one_fault(&mesh).contains("element 503"));

        let mut mesh = plate();
        mesh.nodes.push([5.0, 0.0, 0.0]);
        mesh.origin.node_tags.push(777);
        assert!(one_fault(&mesh).contains("node 777"));

        let mut mesh = plate();
        let repeated = mesh.elements[0].clone();
        mesh.elements.push(repeated);
        mesh.origin.element_tags.push(900);
        let last = mesh.elements.len() - 1;
        mesh.regions[0].elements.push(last);
        assert!(diagnose(&mesh).faults.to_string().contains("element 900: found 1 elements on the nodes"));

        let mut mesh = plate();
        mesh.nodes[4] = mesh.nodes[3];
        let text = diagnose(&mesh).faults.to_string();
        assert!(text.contains("nodes 104 and 105") && text.contains("same place in one region"), "{text}");
        let text = diagnose_apart(&mesh, &[], HashSet::from([4])).faults.to_string();
        assert!(!text.contains("same place"), "{text}");

        let mut mesh = plate();
        mesh.elements[1] = Cell::quadrilateral([1, 4, 5, 2]);
        assert!(one_fault(&mesh).contains("turned opposite ways"));

        let mut mesh = plate();
        mesh.nodes[4] = [-0.7, -0.7, 0.0];
        assert!(one_fault(&mesh).contains("element 501: found 1 quadrilaterals that are folded"));

        let mut mesh = plate();
        mesh.elements[1] = Cell::quadrilateral([1, 2, 4, 5]);
        assert!(
            diagnose(&mesh)
                .faults
                .to_string()
                .contains("element 502: found 1 elements without length or area")
        );
    }

    /// Two boxes on each other, with equal and with unlike meshes.
    #[test]
    fn nodes_of_regions_in_contact_may_be_at_the_same_place() {
        for cells in [[2, 2, 1], [3, 2, 1]] {
            let mut mesh = structured_box(CellKind::Hexahedron8, [1.0, 1.0, 0.2], [2, 2, 1]).unwrap();
            let mut upper = structured_box(CellKind::Hexahedron8, [1.0, 1.0, 0.2], cells).unwrap();
            upper.nodes.iter_mut().for_each(|x| x[2] += 0.2);
            upper.regions.iter_mut().for_each(|region| region.name += "_upper");
            mesh.append(upper);
            assert!(!diagnose(&mesh).warnings.is_empty(), "{cells:?}");
            for pair in [["z_max", "z_min_upper"], ["z_min_upper", "z_max"]] {
                let diagnosis = diagnose_apart(&mesh, &[pair], HashSet::new());
                assert!(diagnosis.warnings.is_empty(), "{cells:?}: {:?}", diagnosis.warnings);
            }
            assert!(!diagnose_apart(&mesh, &[["z_max", "z_max_upper"]], HashSet::new()).warnings.is_empty());
        }
    }

    #[test]
    fn poor_shapes_and_pieces_are_warnings() {
        let mut mesh = plate();
        mesh.nodes.iter_mut().for_each(|p| p[1] *= 0.1);
        mesh.nodes[4][2] = 0.2;
        let diagnosis = diagnose(&mesh);
        assert!(diagnosis.faults.0.is_empty());
        let text = Faults(diagnosis.warnings).to_string();
        assert!(text.contains("slender") && text.contains("warped"), "{text}");

        let mut mesh = plate();
        let mut far = plate();
        far.nodes.iter_mut().for_each(|p| p[0] += 2.0);
        mesh.append(far);
        let moved = mesh.regions.remove(5).elements;
        mesh.regions[0].elements.extend(moved);
        let text = Faults(diagnose(&mesh).warnings).to_string();
        assert!(text.contains("`plate`: found 2 pieces that touch"), "{text}");
    }

    #[test]
    fn long_lists_are_cut() {
        let numbers: Vec<String> = (1..=9).map(|k| k.to_string()).collect();
        assert_eq!(list(numbers.into_iter()), "1, 2, 3, 4, 5 and 4 more");
    }
}
