//! Faces of a shell part as triangles.
//!
//! A quadrilateral is the mean of its two splittings into triangles: four triangles of half weight. The result does
//! not favour a diagonal, takes warped quadrilaterals, and passes every test that the triangle passes.

use super::FlatShell;
use crate::mesh::Element;

/// A triangle of a face and the weight with which it counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedTriangle {
    /// Its nodes.
    pub nodes: [usize; 3],
    /// 1, or ½ for the triangles of a quadrilateral.
    pub weight: f64,
}

/// The triangles of `face`: itself, or the four half-weight ones of a quadrilateral; none for points and lines.
pub fn split_face(face: &Element) -> Vec<WeightedTriangle> {
    match *face {
        Element::Triangle(nodes) => vec![WeightedTriangle { nodes, weight: 1.0 }],
        Element::Quadrilateral([a, b, c, d]) => [[a, b, c], [a, c, d], [a, b, d], [b, c, d]]
            .map(|nodes| WeightedTriangle { nodes, weight: 0.5 })
            .to_vec(),
        Element::Point(_) | Element::Line(_) => Vec::new(),
    }
}

/// (ux, uy, uz, rx, ry, rz) of the mid-surface of a face at the point `at` \[m\], projected onto it: for each node
/// its 6 × 6 matrix, rows and columns in global axes. A quadrilateral takes the mean over its two splittings.
///
/// `None` when the face has no area. A point outside is extrapolated.
pub fn face_displacement_at(
    nodes: &[[f64; 3]],
    face: &Element,
    at: [f64; 3],
) -> Option<Vec<(usize, [[f64; 6]; 6])>> {
    let mut result: Vec<(usize, [[f64; 6]; 6])> = face.nodes().iter().map(|n| (*n, [[0.0; 6]; 6])).collect();
    let triangles = split_face(face);
    if triangles.is_empty() {
        return None;
    }
    for pair in triangles.chunks(2) {
        // Of a splitting, the triangle that holds the point: the one in which it lies deepest.
        let mut best: Option<(f64, [f64; 3], FlatShell, &WeightedTriangle)> = None;
        for triangle in pair {
            let shell = FlatShell::new(&triangle.nodes.map(|n| nodes[n]))?;
            let barycentric = shell.triangle().barycentric(nodes[triangle.nodes[0]], at);
            let depth = barycentric.iter().fold(f64::INFINITY, |m, l| m.min(*l));
            if best.as_ref().is_none_or(|b| depth > b.0) {
                best = Some((depth, barycentric, shell, triangle));
            }
        }
        let (_, barycentric, shell, triangle) = best?;
        let weight = triangle.weight;
        let rows = shell.displacement_at(barycentric);
        for (corner, node) in triangle.nodes.iter().enumerate() {
            let entry = result.iter_mut().find(|(n, _)| n == node)?;
            for (target, row) in entry.1.iter_mut().zip(&rows) {
                for (t, value) in target.iter_mut().zip(&row[6 * corner..6 * corner + 6]) {
                    *t += weight * value;
                }
            }
        }
    }
    Some(result)
}
