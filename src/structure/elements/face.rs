//! Faces of a shell part as triangles.
//!
//! A quadrilateral is the mean of its two splittings into triangles: four triangles of half weight. The result does
//! not favour a diagonal, takes warped quadrilaterals, and passes every test that the triangle passes.

use super::{FacePoint, FlatTriangle};
use crate::mesh::Cell;

/// Barycentric coordinates above minus this are of points on the triangle.
const ON_TRIANGLE: f64 = 1e-9;

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

/// A place `x` of a face on its triangles, with the share of each: those that hold it of each splitting, whose mean depends on no order of
/// corners; of a warped face, over none of whose triangles it is, the nearest of them.
pub fn on_triangles(nodes: &[[f64; 3]], face: &Cell, x: [f64; 3]) -> Vec<(FacePoint, f64)> {
    let place = |corners: [usize; 3]| {
        let flat = FlatTriangle::new(&corners.map(|node| nodes[node]))?;
        let at = FacePoint { corners, barycentric: flat.barycentric(nodes[corners[0]], x) };
        Some((at, at.barycentric.into_iter().fold(f64::INFINITY, f64::min)))
    };
    let triangles = split_face(face);
    // A quadrilateral is split twice, a triangle is whole.
    let splittings: Vec<Vec<(FacePoint, f64)>> = triangles
        .chunk_by(|a, b| a.weight < 1.0 && b.weight < 1.0)
        .flat_map(|own| own.chunks(2))
        .map(|own| own.iter().filter_map(|triangle| place(triangle.nodes)).collect())
        .collect();
    let best = splittings.iter().flatten().map(|(_, least)| *least).fold(f64::NEG_INFINITY, f64::max);
    let held = -ON_TRIANGLE + best.min(0.0);
    let holding: Vec<Vec<FacePoint>> = splittings
        .into_iter()
        .map(|own| own.into_iter().filter(|(_, least)| *least >= held).map(|(at, _)| at).collect::<Vec<_>>())
        .filter(|own| !own.is_empty())
        .collect();
    let share = 1.0 / holding.len().max(1) as f64;
    let shared = |own: Vec<FacePoint>| {
        let share = share / own.len() as f64;
        own.into_iter().map(move |at| (at, share))
    };
    holding.into_iter().flat_map(shared).collect()
}
