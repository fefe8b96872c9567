//! A ring of solids, and a pad of solids on it.

use super::{require_positive, structured_box};
use crate::{CellKind, Mesh};
use std::collections::HashMap;
use std::f64::consts::TAU;
use stridor_base::error::{Fault, Result};

/// A ring about the z axis between two radii, from z = 0 to `thickness` \[m\], of `cells` × bricks along the radius, around and through, each
/// made of cells of `kind` as in [`structured_box`]; nodes in the middle of edges are on the arcs. Regions `disc`, and `hub`, `rim`, `disc_back` (z = 0),
/// `disc_face` (faces).
///
/// # Errors
/// Radii that do not ascend, fewer than three bricks around, and those of [`structured_box`].
pub fn structured_ring(
    kind: CellKind,
    [inner, outer]: [f64; 2],
    thickness: f64,
    cells: [usize; 3],
) -> Result<Mesh> {
    let mut faults = require_positive("ring", &[("inner radius", inner), ("width", outer - inner)]);
    if cells[1] < 3 {
        faults.push(Fault::new("ring `cells`", format!("{} around", cells[1]), "three or more"));
    }
    faults.into_result(())?;
    let mut mesh = structured_box(kind, [outer - inner, TAU, thickness], cells)?;
    // The last bricks around have the nodes of the first.
    let size = (outer - inner).min(thickness) * 1e-6;
    let place = |x: [f64; 3]| [x[0], x[2]].map(|x| (x / size).round() as i64);
    let at = |x: [f64; 3], angle: f64| (x[1] - angle).abs() < 1e-9;
    let first: HashMap<[i64; 2], usize> =
        mesh.nodes.iter().enumerate().filter(|(_, x)| at(**x, 0.0)).map(|(n, x)| (place(*x), n)).collect();
    let (mut number, mut nodes) = (Vec::with_capacity(mesh.nodes.len()), Vec::new());
    for x in &mesh.nodes {
        if at(*x, TAU) {
            number.push(usize::MAX);
            continue;
        }
        let (radius, angle) = (inner + x[0], x[1]);
        number.push(nodes.len());
        nodes.push([radius * angle.cos(), radius * angle.sin(), x[2]]);
    }
    for (node, x) in mesh.nodes.iter().enumerate().filter(|(_, x)| at(**x, TAU)) {
        number[node] = number[first[&place(*x)]];
    }
    mesh.nodes = nodes;
    keep(
        &mut mesh,
        &[
            ("solid", "disc"),
            ("x_min", "hub"),
            ("x_max", "rim"),
            ("z_min", "disc_back"),
            ("z_max", "disc_face"),
        ],
    );
    mesh.elements.iter_mut().for_each(|cell| *cell = cell.renumbered(|node| number[node]));
    Ok(mesh)
}

/// A disc of 280 × 10 mm with a hub of 140 mm, and a pad of 40 × 100 × 12 mm on its upper face, of 20-node hexahedra: regions of the disc as in
/// [`structured_ring`], and `pad`, `pad_face`, `pad_back`.
///
/// # Errors
/// None but of memory.
pub fn solid_brake() -> Result<Mesh> {
    let kind = CellKind::Hexahedron20;
    let mut mesh = structured_ring(kind, [0.07, 0.14], 0.01, [4, 48, 1])?;
    let mut pad = structured_box(kind, [0.04, 0.1, 0.012], [4, 8, 2])?;
    keep(&mut pad, &[("solid", "pad"), ("z_min", "pad_face"), ("z_max", "pad_back")]);
    pad.nodes.iter_mut().for_each(|[x, y, z]| (*x, *y, *z) = (*x + 0.085, *y - 0.05, *z + 0.01));
    mesh.append(pad);
    Ok(mesh)
}

/// Keeps the regions that have a new name, and the cells of those alone.
fn keep(mesh: &mut Mesh, names: &[(&str, &str)]) {
    let elements = std::mem::take(&mut mesh.elements);
    for mut region in std::mem::take(&mut mesh.regions) {
        let Some((_, new)) = names.iter().find(|(old, _)| *old == region.name) else { continue };
        let first = mesh.elements.len();
        mesh.elements.extend(region.elements.iter().map(|e| elements[*e].clone()));
        region.elements = (first..mesh.elements.len()).collect();
        region.name = (*new).to_string();
        mesh.regions.push(region);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Info, diagnose_apart};
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn rings_of_every_kind_have_their_volume() {
        for kind in CellKind::all().filter(|kind| kind.dimension() == 3) {
            let info = Info::of(&structured_ring(kind, [0.02, 0.08], 0.01, [2, 40, 1]).unwrap());
            assert!(info.diagnosis.faults.0.is_empty(), "{kind:?}: {}", info.diagnosis.faults);
            let exact = std::f64::consts::PI * (0.08_f64.powi(2) - 0.02_f64.powi(2)) * 0.01;
            // Chords of 1/40 of a turn: 1 − sin(φ)/φ of the area; parabolas the fourth power of that angle.
            let bound = if kind.is_first_order() { 5e-3 } else { 2e-5 };
            assert!(within((info.regions[0].measure / exact - 1.0).abs(), bound, Discretisation), "{kind:?}");
            assert_eq!(info.regions.len(), 5);
            assert!(info.regions.iter().all(|region| region.pieces == 1));
        }
        assert!(structured_ring(CellKind::Hexahedron8, [0.02, 0.01], 0.01, [1, 2, 1]).is_err());
    }

    #[test]
    fn the_brake_is_in_two_pieces_that_touch() {
        let brake = solid_brake().unwrap();
        let diagnosis = diagnose_apart(&brake, &[["pad_face", "disc_face"]], Default::default());
        assert!(diagnosis.faults.0.is_empty() && diagnosis.warnings.is_empty(), "{diagnosis:?}");
        let area = |name: &str| Info::of(&brake).regions.iter().find(|r| r.name == name).unwrap().measure;
        assert!(
            within((area("pad_face") - 4e-3).abs(), 1e-15, RoundOff)
                && within((area("pad") - 4.8e-5).abs(), 1e-16, RoundOff)
        );
    }
}
