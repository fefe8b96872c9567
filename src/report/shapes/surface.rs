//! Faces, bars and points of the model, as the viewer draws them.

use crate::report::view::{ViewVector, along, cross, dot, unit};
use crate::results::Geometry;
use std::collections::{BTreeMap, BTreeSet};

/// The drawn part of a model, with nodes of its own.
#[derive(Debug)]
pub(super) struct Surface {
    /// The nodes of the geometry that are drawn, ascending.
    pub nodes: Vec<usize>,
    /// Number of nodes that the elements have in all.
    pub all_nodes: usize,
    /// The parts in the order of the case.
    pub parts: Vec<SurfacePart>,
    /// Where the drawn nodes are \[m\].
    coordinates: Vec<ViewVector>,
}

/// A part; its corners are places in [`Surface::nodes`].
#[derive(Debug, Default)]
pub(super) struct SurfacePart {
    pub name: String,
    pub faces: Vec<[u32; 3]>,
    pub bars: Vec<[u32; 2]>,
    pub points: Vec<[u32; 1]>,
}

/// Bytes of a node without a field: 3 coordinates in 16 bits, 3 of the normal in 8.
const NODE: usize = 9;
/// Bytes of a complex field at a node: Re and Im of 3 displacements in 16 bits.
const FIELD: usize = 12;
/// Growth of the size of the cells from one trial to the next.
const COARSER: f64 = 1.2;

impl Surface {
    /// The surface with as many nodes as `fields` complex fields on it may have within `limit` bytes of base64.
    pub(super) fn within(geometry: &Geometry, fields: usize, limit: usize) -> Self {
        let fine = Surface::of(geometry, &(0..geometry.nodes.len()).collect::<Vec<_>>());
        if fine.encoded_size(fields) <= limit {
            return fine;
        }
        let mut cell = fine.size() / (fine.nodes.len() as f64).sqrt();
        loop {
            let surface = Surface::of(geometry, &clustered(geometry, cell));
            if surface.encoded_size(fields) <= limit || surface.nodes.len() <= geometry.parts.len() {
                return Surface { all_nodes: fine.all_nodes, ..surface };
            }
            cell *= COARSER;
        }
    }

    /// The elements with each node replaced by `stands_for`; those that shrink to less are left out.
    fn of(geometry: &Geometry, stands_for: &[usize]) -> Self {
        let mut nodes: Vec<usize> = geometry.elements.iter().flatten().map(|k| stands_for[*k]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let local = |node: usize| nodes.binary_search(&stands_for[node]).expect("collected above") as u32;
        let mut faces = vec![BTreeSet::new(); geometry.parts.len()];
        let part = |name: &String| SurfacePart { name: name.clone(), ..Default::default() };
        let mut parts: Vec<SurfacePart> = geometry.parts.iter().map(part).collect();
        for (element, part) in geometry.elements.iter().zip(&geometry.part_of) {
            let (seen, part) = (&mut faces[*part], &mut parts[*part]);
            let corners: Vec<u32> = element.iter().map(|k| local(*k)).collect();
            match corners[..] {
                [a] => part.points.push([a]),
                [a, b] if a != b => part.bars.push([a, b]),
                _ => {}
            }
            for k in 2..corners.len() {
                let face = [corners[0], corners[k - 1], corners[k]];
                let mut sorted = face;
                sorted.sort_unstable();
                if sorted[0] < sorted[1] && sorted[1] < sorted[2] && seen.insert(sorted) {
                    part.faces.push(face);
                }
            }
        }
        let coordinates = nodes.iter().map(|k| geometry.nodes[*k]).collect();
        Surface { all_nodes: nodes.len(), nodes, parts, coordinates }
    }

    /// Bytes of base64 with so many complex fields.
    pub(super) fn encoded_size(&self, fields: usize) -> usize {
        let corners: usize =
            self.parts.iter().map(|p| 3 * p.faces.len() + 2 * p.bars.len() + p.points.len()).sum();
        (NODE * self.nodes.len() + 4 * corners) * 4 / 3 + fields * self.encoded_field_size()
    }

    /// Bytes of base64 of a complex field.
    pub(super) fn encoded_field_size(&self) -> usize {
        FIELD * self.nodes.len() * 4 / 3
    }

    /// Least and greatest coordinates.
    fn bounds(&self) -> [ViewVector; 2] {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for place in &self.coordinates {
            for c in 0..3 {
                bounds[0][c] = bounds[0][c].min(place[c]);
                bounds[1][c] = bounds[1][c].max(place[c]);
            }
        }
        bounds
    }

    /// Half the diagonal of the box about all nodes \[m\]; 1 where there is but a point.
    fn size(&self) -> f64 {
        let [low, high] = self.bounds();
        let across = along(high, -1.0, low);
        let half = 0.5 * dot(across, across).sqrt();
        if half > 0.0 && half.is_finite() { half } else { 1.0 }
    }

    /// Coordinates from the middle of the box, in half diagonals: 3 numbers a node from −1 to 1.
    pub(super) fn places(&self) -> Vec<f64> {
        let ([low, high], size) = (self.bounds(), self.size());
        let middle = along(low, 1.0, high).map(|c| 0.5 * c);
        self.coordinates.iter().flat_map(|place| along(*place, -1.0, middle).map(|c| c / size)).collect()
    }

    /// Unit normal of the surface at each node, 3 numbers a node; zero where there is no face. Faces may be turned either
    /// way: each is added on the side of the first one at its node.
    pub(super) fn normals(&self) -> Vec<f64> {
        let mut sums = vec![[0.0; 3]; self.nodes.len()];
        for face in self.parts.iter().flat_map(|part| &part.faces) {
            let [a, b, c] = face.map(|k| self.coordinates[k as usize]);
            let area = cross(along(b, -1.0, a), along(c, -1.0, a));
            for k in face {
                let sum = &mut sums[*k as usize];
                *sum = along(*sum, if dot(*sum, area) < 0.0 { -1.0 } else { 1.0 }, area);
            }
        }
        sums.into_iter().flat_map(|sum| unit(sum).unwrap_or([0.0; 3])).collect()
    }
}

/// For each node the first of its part in its cell of a cubic grid: clustering of vertices (Rossignac, Borrel, 1993).
fn clustered(geometry: &Geometry, cell: f64) -> Vec<usize> {
    let mut part_of = vec![usize::MAX; geometry.nodes.len()];
    for (element, part) in geometry.elements.iter().zip(&geometry.part_of) {
        element.iter().for_each(|k| part_of[*k] = part_of[*k].min(*part));
    }
    let mut first: BTreeMap<(usize, [i64; 3]), usize> = BTreeMap::new();
    let places = geometry.nodes.iter().zip(part_of).enumerate();
    places
        .map(|(k, (place, part))| *first.entry((part, place.map(|c| (c / cell).floor() as i64))).or_insert(k))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;

    #[test]
    fn all_faces_bars_and_nodes_are_there_when_they_fit() {
        let geometry = sample::rig().geometry;
        let surface = Surface::within(&geometry, 3, 4_000_000);
        let count = |n: usize| geometry.elements.iter().filter(|e| e.len() == n).count();
        let faces: usize = surface.parts.iter().map(|part| part.faces.len()).sum();
        assert_eq!(faces, count(3) + 2 * count(4));
        assert_eq!(surface.parts[2].bars.len(), count(2));
        assert_eq!((surface.nodes.len(), surface.all_nodes), (geometry.nodes.len(), geometry.nodes.len()));
        assert!(surface.places().iter().all(|c| (-1.0..=1.0).contains(c)));
    }

    #[test]
    fn fewer_nodes_keep_the_form_and_the_limit() {
        let geometry = sample::rig().geometry;
        let limit = 20_000;
        let surface = Surface::within(&geometry, 3, limit);
        assert!(surface.encoded_size(3) <= limit && surface.nodes.len() > 100 && surface.all_nodes > 500);
        let area = |surface: &Surface, part: usize| -> f64 {
            let area = |face: &[u32; 3]| {
                let [a, b, c] = face.map(|k| surface.coordinates[k as usize]);
                let n = cross(along(b, -1.0, a), along(c, -1.0, a));
                0.5 * dot(n, n).sqrt()
            };
            surface.parts[part].faces.iter().map(area).sum()
        };
        let fine = Surface::within(&geometry, 3, 4_000_000);
        // π (75² − 21²) mm² of the disc, 0.2 × 0.12 m² of the slider.
        assert!(within((area(&fine, 1) - 0.024).abs(), 1e-12, RoundOff));
        for part in 0..2 {
            let ratio = area(&surface, part) / area(&fine, part);
            assert!((0.8..1.2).contains(&ratio), "{ratio}");
        }
    }

    #[test]
    fn normals_are_those_of_the_plates() {
        let geometry = sample::rig().geometry;
        let surface = Surface::within(&geometry, 1, 4_000_000);
        let normals = surface.normals();
        let tilt = 1f64.to_radians();
        let disc = &normals[..3];
        assert!(
            within((disc[0].abs() - tilt.cos()).abs(), 1e-9, RoundOff)
                && within(disc[1].abs(), 1e-9, RoundOff),
            "{disc:?}"
        );
        // The bar has none of its own.
        let bar = surface.parts[2].bars[1][1] as usize;
        assert_eq!(normals[3 * bar..3 * bar + 3], [0.0; 3]);
    }
}
