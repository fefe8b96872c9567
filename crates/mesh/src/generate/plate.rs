//! The slider: a rectangle, fine at the contact, made of four quarters around it.

use super::fill::{Patch, divide, fill};
use super::{Grading, refuse_too_fine, require_positive};
use crate::{Cell, Mesh};
use std::collections::HashMap;
use stridor_base::error::{Fault, Result};

/// A rectangle in the plane z = 0, centre at the origin, fine at the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateSpec {
    /// Along x \[m\].
    pub length: f64,
    /// Along y \[m\].
    pub width: f64,
    /// Where the contact is: x, y \[m\], inside the rectangle.
    pub contact: [f64; 2],
    /// Sizes by distance from the contact.
    pub grading: Grading,
}

/// Triangles of a rectangle, normals +z. The four quarters around the contact are filled one by one, so that with the
/// contact at the centre the mesh is its own mirror image in x and in y, bit for bit; there is a node at the contact.
/// Regions `slider` (faces) and `slider_edge_x_min`, `_x_max`, `_y_min`, `_y_max` (lines).
///
/// # Errors
/// Lengths that are not positive, a contact outside or closer to an edge than the fine size, absurdly fine sizes.
///
/// ```
/// use stridor_mesh::generate::{Grading, PlateSpec, plate};
/// let grading = Grading::graded(1e-3, 2e-3, 10e-3);
/// let mesh = plate(&PlateSpec { length: 0.2, width: 0.12, contact: [0.03, 0.0], grading })?;
/// assert!(mesh.nodes.contains(&[0.03, 0.0, 0.0]));
/// # Ok::<(), stridor_base::error::Error>(())
/// ```
pub fn plate(spec: &PlateSpec) -> Result<Mesh> {
    let PlateSpec { length, width, contact, grading } = *spec;
    let mut faults = require_positive("plate", &[("length", length), ("width", width)]);
    faults.0.extend(grading.faults("plate").0);
    for (name, at, whole) in [("x", contact[0], length), ("y", contact[1], width)] {
        let reach = at.abs() + grading.fine;
        if reach.is_nan() || reach > whole / 2.0 {
            let expected =
                format!("within ±{} m, one fine element from the edge", whole / 2.0 - grading.fine);
            faults.push(Fault::new(format!("plate contact {name}"), format!("{at} m"), expected));
        }
    }
    faults.into_result(())?;
    refuse_too_fine("plate", length * width, &grading)?;

    let mut mesh = Mesh::default();
    let mut known = HashMap::new();
    let mut faces = Vec::new();
    for sign in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
        let far = [length / 2.0 - sign[0] * contact[0], width / 2.0 - sign[1] * contact[1]];
        let patch = quarter(far, &grading)?;
        let nodes: Vec<usize> = patch
            .points
            .iter()
            .map(|p| {
                // Ends of a side exactly on the edge, whatever the rounding of contact + far; + 0.0 turns −0 into 0.
                let place = [0, 1].map(|k| {
                    let whole = [length, width][k];
                    let at = if p[k] == far[k] { sign[k] * whole / 2.0 } else { contact[k] + sign[k] * p[k] };
                    at + 0.0
                });
                *known.entry(place.map(f64::to_bits)).or_insert_with(|| {
                    mesh.nodes.push([place[0], place[1], 0.0]);
                    mesh.nodes.len() - 1
                })
            })
            .collect();
        faces.extend(patch.triangles.iter().map(|t| {
            let [i, j, k] = t.map(|v| nodes[v]);
            // A quarter mirrored once has to be turned over.
            Cell::triangle(if sign[0] * sign[1] > 0.0 { [i, j, k] } else { [i, k, j] })
        }));
    }
    mesh.add_region("slider", 2, faces);
    add_edges(&mut mesh, "slider", length, width);
    Ok(mesh)
}

/// The rectangle from the contact (0, 0) to `far`.
fn quarter(far: [f64; 2], grading: &Grading) -> Result<Patch> {
    let size = |p: [f64; 2]| grading.at(p[0].hypot(p[1]));
    let corners = [[0.0, 0.0], [far[0], 0.0], far, [0.0, far[1]]];
    // Always from the lower to the upper end, so that both quarters at a seam divide it alike.
    let side = |from: [f64; 2], to: [f64; 2]| -> Vec<[f64; 2]> {
        let at = |t: f64| [0, 1].map(|k| if t == 1.0 { to[k] } else { from[k] + t * (to[k] - from[k]) });
        divide((to[0] - from[0]).hypot(to[1] - from[1]), 1, |t| size(at(t))).into_iter().map(at).collect()
    };
    let mut boundary = side(corners[0], corners[1]);
    boundary.extend(&side(corners[1], corners[2])[1..]);
    boundary.extend(side(corners[3], corners[2]).iter().rev().skip(1));
    boundary.extend(side(corners[0], corners[3]).iter().rev().skip(1));
    boundary.pop();
    fill(&boundary, size)
}

/// The lines on the four edges of a rectangle in the plane z = 0, in the order of their coordinate: regions
/// `part_edge_x_min`, `part_edge_x_max` ….
pub(super) fn add_edges(mesh: &mut Mesh, part: &str, length: f64, width: f64) {
    let edges = [
        ("x_min", 0, -length / 2.0),
        ("x_max", 0, length / 2.0),
        ("y_min", 1, -width / 2.0),
        ("y_max", 1, width / 2.0),
    ];
    for (side, across, at) in edges {
        let mut nodes: Vec<usize> = (0..mesh.nodes.len()).filter(|n| mesh.nodes[*n][across] == at).collect();
        nodes.sort_by(|i, j| mesh.nodes[*i][1 - across].total_cmp(&mesh.nodes[*j][1 - across]));
        let lines: Vec<Cell> = nodes.windows(2).map(|w| Cell::line([w[0], w[1]])).collect();
        mesh.add_region(&format!("{part}_edge_{side}"), 1, lines);
    }
}
