//! Faces of a shell part as triangles.
//!
//! A quadrilateral is the mean of its two splittings into triangles: four triangles of half weight. The result does
//! not favour a diagonal, takes warped quadrilaterals, and passes every test that the triangle passes.

use crate::mesh::Cell;

/// A triangle of a face and the weight with which it counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedTriangle {
    /// Its nodes.
    pub nodes: [usize; 3],
    /// 1, or ½ for the triangles of a quadrilateral.
    pub weight: f64,
}

/// The triangles of `face`: itself, or the four half-weight ones of a quadrilateral, of a face of second order those of its pieces; none
/// for points and lines.
pub fn split_face(face: &Cell) -> Vec<WeightedTriangle> {
    let nodes = face.nodes();
    let triangles = |piece: &&[u8]| match **piece {
        [a, b, c] => vec![([a, b, c], 1.0)],
        [a, b, c, d] => [[a, b, c], [a, c, d], [a, b, d], [b, c, d]].map(|t| (t, 0.5)).to_vec(),
        _ => Vec::new(),
    };
    let pieces = face.kind().table().pieces.iter().flat_map(triangles);
    pieces.map(|(t, weight)| WeightedTriangle { nodes: t.map(|k| nodes[usize::from(k)]), weight }).collect()
}
