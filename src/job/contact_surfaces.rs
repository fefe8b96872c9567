//! The faces of contact pairs with the points on them.

use super::prepared::Prepared;
use crate::connected::lowest_connected;
use crate::mesh::{Cell, FaceTree, Region, cell_nodes};
use crate::results::{ContactFace, ContactSurface};
use crate::system::ContactPair;
use std::collections::BTreeMap;

/// The surfaces of all pairs whose bodies touch with faces.
pub fn contact_surfaces(prepared: &Prepared) -> Vec<ContactSurface> {
    let mut all = Vec::new();
    let mut first = 0;
    for pair in &prepared.system.pairs {
        all.extend(surfaces_of(prepared, pair, first));
        first += pair.points.len();
    }
    all
}

/// Those of a pair, whose first point has the number `first`.
fn surfaces_of(prepared: &Prepared, pair: &ContactPair, first: usize) -> Vec<ContactSurface> {
    let (regions, nodes) = (&prepared.regions, &prepared.model.nodes);
    let contact = prepared.case.contact.get(&pair.name).filter(|contact| contact.points.is_none());
    let region = contact.and_then(|contact| regions.region(&contact.body, "").ok());
    let (Some(contact), Some(region)) = (contact, region.filter(|region| region.dimension == 2)) else {
        return Vec::new();
    };
    let faces = regions.cells(region);
    let part = prepared.model.part_with(&regions.mesh.region_nodes(region));
    let faces = part.and_then(|part| part.outward(faces.clone())).unwrap_or(faces);
    let tree = FaceTree::new(nodes, &faces);
    let mut points: Vec<Vec<usize>> = vec![Vec::new(); faces.len()];
    for (k, point) in pair.points.iter().enumerate() {
        tree.nearest(point.position).iter().for_each(|place| points[place.face].push(k));
    }
    let face = |(cell, points): (&Cell, Vec<usize>)| {
        let share = 1.0 / points.len() as f64;
        let middle = |c: usize| points.iter().map(|p| share * pair.points[*p].position[c]).sum();
        let slides =
            contact.sliding.way().at(std::array::from_fn(middle)).map(|v| v * contact.sliding.rate());
        let points = points.into_iter().map(|p| first + p).collect();
        ContactFace { cell: cell.clone(), points, slides }
    };
    let touching = faces.iter().zip(points).filter(|(_, points)| !points.is_empty());
    let touching: Vec<ContactFace> = touching.map(face).collect();
    let piece = lowest_connected(nodes.len(), touching.iter().map(|face| face.cell.nodes()));
    let mut pieces: BTreeMap<usize, Vec<ContactFace>> = BTreeMap::new();
    for face in touching {
        pieces.entry(piece[face.cell.nodes()[0]]).or_default().push(face);
    }
    let names: Vec<String> = pieces.values().map(|faces| region_of(prepared, faces)).collect();
    let named = |(k, faces)| ContactSurface { pair: pair.name.clone(), name: numbered(&names, k), faces };
    pieces.into_values().enumerate().map(named).collect()
}

/// The name with a number, where several are the same.
fn numbered(names: &[String], k: usize) -> String {
    let before = names[..k].iter().filter(|name| **name == names[k]).count();
    match names.iter().filter(|name| **name == names[k]).count() {
        1 => names[k].clone(),
        _ => format!("{} {}", names[k], before + 1),
    }
}

/// The smallest region of the mesh with all nodes of the faces.
fn region_of(prepared: &Prepared, faces: &[ContactFace]) -> String {
    let mesh = &prepared.regions.mesh;
    let own = cell_nodes(faces.iter().map(|face| &face.cell));
    let with_all = |region: &Region| {
        let nodes = mesh.region_nodes(region);
        let all = own.iter().all(|node| nodes.binary_search(node).is_ok());
        all.then_some(nodes.len())
    };
    let regions = mesh.regions.iter().filter(|region| region.dimension > 1);
    let found = regions.filter_map(|region| Some((with_all(region)?, &region.name)));
    found.min_by_key(|(nodes, _)| *nodes).map_or(String::new(), |(_, name)| name.clone())
}
