//! Which parts of a model are discs.

use crate::mesh::{Cell, outer_faces};
use crate::modal::Disc;
use crate::structure::{Model, Part};
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Faces whose normal is nearer than this to the axis, by the cosine, are on a flat side of a solid.
const FLAT: f64 = 1.0 - 1e-6;
/// Faces are in one plane where their heights differ by less than this part of the size of the solid, √(area of its skin).
const SAME_PLANE: f64 = 1e-4;

/// The shells that are discs and the solids with a flat side that is one, with their names.
pub(super) fn discs(model: &Model) -> Vec<(&str, Disc)> {
    model.parts.iter().filter_map(|part| Some((part.name.as_str(), disc(part, &model.nodes)?))).collect()
}

fn disc(part: &Part, nodes: &[[f64; 3]]) -> Option<Disc> {
    let side;
    let faces: &[Cell] = match part.kind.dimension() {
        2 => &part.cells,
        3 => {
            side = flat_side(part, nodes)?;
            &side
        }
        _ => return None,
    };
    let pieces: Vec<Vec<usize>> = faces.iter().flat_map(Cell::pieces).collect();
    Disc::recognise(&pieces.iter().map(Vec::as_slice).collect::<Vec<_>>(), nodes)
}

/// The faces of one flat side of a solid, along the axis to which most of its skin is normal.
fn flat_side(part: &Part, nodes: &[[f64; 3]]) -> Option<Vec<Cell>> {
    let [front, _] = flat_sides(part, nodes);
    Some(front).filter(|side| !side.is_empty())
}

/// The two flat sides of a solid, seen from outside counter-clockwise: the faces of its skin that look along ±axis, the eigenvector of
/// Σ A n nᵀ of the largest eigenvalue; of those in several planes the ones in the plane of the largest area.
pub(super) fn flat_sides(part: &Part, nodes: &[[f64; 3]]) -> [Vec<Cell>; 2] {
    let skin = outer_faces(part.cells.iter());
    let at = |node: usize| Vector3::from(nodes[node]);
    let area = |face: &Cell| {
        let at = |k: usize| at(face.corners()[k]);
        (2..face.corners().len())
            .map(|k| 0.5 * (at(k - 1) - at(0)).cross(&(at(k) - at(0))))
            .sum::<Vector3<f64>>()
    };
    let areas: Vec<Vector3<f64>> = skin.iter().map(area).collect();
    let tensor = areas.iter().filter(|a| a.norm() > 0.0).map(|a| a * a.transpose() / a.norm());
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(tensor.sum::<Matrix3<f64>>());
    let axis = eigenvectors.column(eigenvalues.imax()).into_owned();
    let axis = axis * axis[axis.iamax()].signum();
    let whole: f64 = areas.iter().map(|area| area.norm()).sum();
    [axis, -axis].map(|axis| {
        // (height along the axis, area, face), in planes whose heights differ by less than `SAME_PLANE` of the size.
        let looks = |(face, area): (&Cell, &Vector3<f64>)| {
            let height =
                face.corners().iter().map(|k| at(*k).dot(&axis)).sum::<f64>() / face.corners().len() as f64;
            (area.dot(&axis) > FLAT * area.norm()).then(|| (height, area.norm(), face.clone()))
        };
        let mut faces: Vec<(f64, f64, Cell)> = skin.iter().zip(&areas).filter_map(looks).collect();
        faces.sort_by(|a, b| a.0.total_cmp(&b.0));
        let planes = faces.chunk_by(|a, b| b.0 - a.0 <= SAME_PLANE * whole.sqrt());
        let area = |plane: &[(f64, f64, Cell)]| plane.iter().map(|face| face.1).sum::<f64>();
        let largest = planes.max_by(|a, b| area(a).total_cmp(&area(b)));
        largest.unwrap_or_default().iter().map(|face| face.2.clone()).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::CellKind;
    use crate::mesh::generate::{structured_box, structured_ring};
    use crate::structure::Solid;
    use crate::structure::samples::STEEL;

    #[test]
    fn rings_of_solids_are_discs_and_boxes_are_not() {
        for kind in CellKind::all().filter(|kind| kind.dimension() == 3) {
            for (mesh, is_disc) in [
                (structured_ring(kind, [0.02, 0.08], 0.01, [2, 40, 1]).unwrap(), true),
                (structured_box(kind, [0.1, 0.1, 0.01], [4, 4, 1]).unwrap(), false),
            ] {
                let cells = mesh.elements.iter().filter(|cell| cell.dimension() == 3).cloned().collect();
                let part = Part::new("disc", cells, Solid::new(STEEL));
                let found = disc(&part, &mesh.nodes);
                assert_eq!(found.is_some(), is_disc, "{kind:?}");
                assert!(found.is_none_or(|disc| disc.normal.z.abs() > 1.0 - 1e-12));
            }
        }
    }
}
