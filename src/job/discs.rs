//! Which parts of a model are discs.

use crate::mesh::{Cell, outer_faces};
use crate::modal::Disc;
use crate::structure::{Model, Part, PartKind};
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Faces whose normal is nearer than this to the axis, by the cosine, are on a flat side of a solid.
const FLAT: f64 = 1.0 - 1e-6;

/// The shells that are discs and the solids with a flat side that is one, with their names.
pub(super) fn discs(model: &Model) -> Vec<(&str, Disc)> {
    model.parts.iter().filter_map(|part| Some((part.name.as_str(), disc(part, &model.nodes)?))).collect()
}

fn disc(part: &Part, nodes: &[[f64; 3]]) -> Option<Disc> {
    let side;
    let faces: &[Cell] = match part.kind {
        PartKind::Shell(_) => &part.cells,
        PartKind::Solid(_) => {
            side = flat_side(part, nodes)?;
            &side
        }
        PartKind::Bar(_) => return None,
    };
    let pieces: Vec<Vec<usize>> = faces.iter().flat_map(Cell::pieces).collect();
    Disc::recognise(&pieces.iter().map(Vec::as_slice).collect::<Vec<_>>(), nodes)
}

/// The faces of the skin that look along the axis to which most of it is normal, the eigenvector of Σ A n nᵀ of the largest eigenvalue.
fn flat_side(part: &Part, nodes: &[[f64; 3]]) -> Option<Vec<Cell>> {
    let skin = outer_faces(part.cells.iter());
    let area = |face: &Cell| {
        let at = |k: usize| Vector3::from(nodes[face.corners()[k]]);
        (2..face.corners().len())
            .map(|k| 0.5 * (at(k - 1) - at(0)).cross(&(at(k) - at(0))))
            .sum::<Vector3<f64>>()
    };
    let areas: Vec<Vector3<f64>> = skin.iter().map(area).collect();
    let tensor = areas.iter().filter(|a| a.norm() > 0.0).map(|a| a * a.transpose() / a.norm());
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(tensor.sum::<Matrix3<f64>>());
    let axis = eigenvectors.column(eigenvalues.imax()).into_owned();
    let flat = |(face, area): (Cell, Vector3<f64>)| (area.dot(&axis) > FLAT * area.norm()).then_some(face);
    let side: Vec<Cell> = skin.into_iter().zip(areas).filter_map(flat).collect();
    (!side.is_empty()).then_some(side)
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
