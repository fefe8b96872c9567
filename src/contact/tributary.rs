//! What each node stands for of lines and faces.

use super::projection::{area_vector, dot, scale, subtract};
use crate::mesh::Cell;
use crate::structure::elements::split_face;

/// The tributary length \[m\] or area \[m²\] of each node of some lines or faces, n_nodes: half of each straight piece of a line, a third of each triangle of a face; zero off them.
pub fn tributary(nodes: &[[f64; 3]], cells: &[Cell]) -> Vec<f64> {
    let mut weights = vec![0.0; nodes.len()];
    for cell in cells {
        for line in cell.pieces().filter(|_| cell.dimension() == 1) {
            let side = subtract(nodes[line[1]], nodes[line[0]]);
            line.into_iter().for_each(|node| weights[node] += 0.5 * dot(side, side).sqrt());
        }
        for triangle in split_face(cell) {
            let area = scale(triangle.weight, area_vector(&triangle.nodes.map(|node| nodes[node])));
            triangle.nodes.into_iter().for_each(|node| weights[node] += dot(area, area).sqrt() / 3.0);
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::mesh::CellKind;
    use crate::mesh::generate::structured_box;

    #[test]
    fn tributary_lengths_are_those_between_all_nodes_of_a_line() {
        let nodes = [[0.0; 3], [0.5, 0.0, 0.0], [0.3, 0.0, 0.0], [0.5, 0.4, 0.0]];
        let cells = [(CellKind::Line3, &[0, 1, 2][..]), (CellKind::Line2, &[1, 3])]
            .map(|(kind, nodes)| Cell::new(kind, nodes).unwrap());
        let weights = tributary(&nodes, &cells);
        for (found, right) in weights.iter().zip([0.15, 0.3, 0.25, 0.2]) {
            assert!(within((found - right).abs(), 1e-15, RoundOff), "{weights:?}");
        }
    }

    #[test]
    fn tributary_areas_add_up_to_the_area_and_none_is_negative() {
        for kind in CellKind::all().filter(|kind| kind.dimension() == 3) {
            let mesh = structured_box(kind, [0.3, 0.2, 0.1], [3, 2, 1]).unwrap();
            let region = mesh.require("z_max", 2).unwrap();
            let faces: Vec<Cell> = region.elements.iter().map(|e| mesh.elements[*e].clone()).collect();
            let weights = tributary(&mesh.nodes, &faces);
            assert!(within((weights.iter().sum::<f64>() - 0.06).abs(), 1e-15, RoundOff), "{kind:?}");
            let on = mesh.region_nodes(region);
            assert!(on.iter().all(|node| weights[*node] > 0.0), "{kind:?}");
        }
    }
}
