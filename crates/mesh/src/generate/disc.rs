//! The disc: a flat annulus or a full disc, mirror-symmetric about its vertical diameter.

use super::fill::{divide, fill};
use super::{Grading, refuse_too_fine, require_positive};
use crate::{Cell, Mesh};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use stridor_base::error::{Fault, Result};

/// A disc in the plane x = 0, centre at the origin, fine at its lowest rim point (0, 0, −a).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscSpec {
    /// a \[m\].
    pub outer_radius: f64,
    /// b \[m\]; 0 for a full disc, which has no region `hub`.
    pub hub_radius: f64,
    /// Sizes by distance from the lowest rim point.
    pub grading: Grading,
}

/// Fewest edges on half the rim and half the hub, so that they stay round.
const LEAST_EDGES: usize = 12;

/// Triangles of a disc, normals +x; the mesh is its own mirror image in y → −y, bit for bit.
/// Regions `disc` (faces), `rim` and `hub` (lines; counterclockwise seen from +x).
///
/// # Errors
/// Lengths that are not positive, a hub that is not smaller than the disc, or absurdly fine sizes.
///
/// ```
/// use stridor_mesh::generate::{DiscSpec, Grading, disc};
/// let spec = DiscSpec { outer_radius: 0.075, hub_radius: 0.02, grading: Grading::graded(1e-3, 2e-3, 8e-3) };
/// let mesh = disc(&spec)?;
/// assert!(mesh.nodes.contains(&[0.0, 0.0, -0.075]));
/// # Ok::<(), stridor_base::error::Error>(())
/// ```
pub fn disc(spec: &DiscSpec) -> Result<Mesh> {
    let DiscSpec { outer_radius: a, hub_radius: b, grading } = *spec;
    let mut faults = require_positive("disc", &[("outer_radius", a)]);
    if !(b >= 0.0 && b < a) {
        let expected = format!("0 … {a} m, less than `outer_radius`");
        faults.push(Fault::new("disc `hub_radius`", format!("{b} m"), expected));
    }
    faults.0.extend(grading.faults("disc").0);
    faults.into_result(())?;
    refuse_too_fine("disc", PI * a * a, &grading)?;

    // A small hub wants smaller elements around it than the grading alone would give.
    let hub_size = if b > 0.0 { PI * b / LEAST_EDGES as f64 } else { f64::INFINITY };
    let rim_size = PI * a / LEAST_EDGES as f64;
    let size = |p: [f64; 2]| {
        let from_hub = (p[0].hypot(p[1]) - b).max(0.0);
        grading.at(p[0].hypot(p[1] + a)).min(hub_size + grading.growth * from_hub).min(rim_size)
    };

    // Half the disc, y ≥ 0, in the coordinates (y, z): up the rim, down the diameter, round the hub, down again.
    let arc = |r: f64| {
        let at = |t: f64| [r * (PI * t).sin(), -r * (PI * t).cos()];
        let mut points: Vec<[f64; 2]> =
            divide(PI * r, LEAST_EDGES, |t| size(at(t))).into_iter().map(at).collect();
        let last = points.len() - 1;
        (points[0], points[last]) = ([0.0, -r], [0.0, r]);
        points
    };
    let diameter = |from: f64, to: f64| -> Vec<[f64; 2]> {
        let at = |t: f64| [0.0, from + t * (to - from)];
        divide((to - from).abs(), 1, |t| size(at(t))).into_iter().map(at).collect()
    };
    let rim = arc(a);
    let mut sides = vec![rim.clone()];
    let mut hub = Vec::new();
    if b > 0.0 {
        hub = arc(b);
        sides.push(diameter(a, b));
        sides.push(hub.iter().rev().copied().collect());
        sides.push(diameter(-b, -a));
    } else {
        sides.push(diameter(a, -a));
    }
    let boundary: Vec<[f64; 2]> = sides.iter().flat_map(|side| &side[..side.len() - 1]).copied().collect();
    let patch = fill(&boundary, size)?;

    // Mirror: nodes on the diameter are shared.
    let mut mesh =
        Mesh { nodes: patch.points.iter().map(|p| [0.0, p[0], p[1]]).collect(), ..Default::default() };
    let mirror: Vec<usize> = (0..patch.points.len())
        .map(|i| {
            let [y, z] = patch.points[i];
            if y == 0.0 {
                return i;
            }
            mesh.nodes.push([0.0, -y, z]);
            mesh.nodes.len() - 1
        })
        .collect();
    let half = patch.triangles.iter().map(|t| Cell::triangle(*t));
    let other = patch.triangles.iter().map(|[i, j, k]| Cell::triangle([mirror[*i], mirror[*k], mirror[*j]]));
    mesh.add_region("disc", 2, half.chain(other));

    let index: BTreeMap<[u64; 2], usize> =
        boundary.iter().enumerate().map(|(i, p)| (p.map(f64::to_bits), i)).collect();
    for (name, arc) in [("rim", rim), ("hub", hub)] {
        if arc.is_empty() {
            continue;
        }
        let nodes: Vec<usize> = arc.iter().map(|p| index[&p.map(|c| c.to_bits())]).collect();
        let right = nodes.windows(2).map(|w| Cell::line([w[0], w[1]]));
        let left = nodes.windows(2).rev().map(|w| Cell::line([mirror[w[1]], mirror[w[0]]]));
        mesh.add_region(name, 1, right.chain(left));
    }
    Ok(mesh)
}
