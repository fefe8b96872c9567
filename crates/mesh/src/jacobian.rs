//! The Jacobian of a cell: lengths, areas and volumes, and cells that are turned inside out.

use super::quality::{cross, dot, norm};
use super::{Cell, CellShape, Mesh, QuadraturePoint};

/// How near to its apex a pyramid is looked at, as a share of the way from its centre: there the Jacobian has no value.
const NEAR_APEX: f64 = 0.9;

impl Cell {
    /// dl, dA or dV at reference coordinates, of nodes with the given coordinates, for one of the reference cell; of a solid that is turned inside
    /// out it is negative.
    pub fn scale(&self, nodes: &[[f64; 3]], at: [f64; 3]) -> f64 {
        let [a, b, c] = self.tangents(nodes, at);
        match self.dimension() {
            3 => dot(cross(a, b), c),
            2 => norm(cross(a, b)),
            _ => norm(a),
        }
    }
}

/// Whether the map x(ξ) = Σ N_k(ξ) x_k keeps one orientation: det ∂x/∂ξ > 0 at the nodes of a solid; on faces and lines of second order the
/// normal or tangent there is on the side of that in the middle. First-order faces and lines are left to [`super::quality`].
pub(super) fn keeps_orientation(mesh: &Mesh, cell: &Cell) -> bool {
    let kind = cell.kind();
    if kind.dimension() == 0 || kind.dimension() < 3 && kind.is_first_order() {
        return true;
    }
    let places = kind.reference_coordinates();
    let corners = kind.corners();
    let centre: [f64; 3] =
        std::array::from_fn(|k| corners.iter().map(|c| c[k]).sum::<f64>() / corners.len() as f64);
    let tangents = |at: [f64; 3]| cell.tangents(&mesh.nodes, at);
    let size = |at: [f64; 3], middle: &[[f64; 3]; 3]| {
        let [a, b, c] = tangents(at);
        match kind.dimension() {
            3 => dot(cross(a, b), c),
            2 => dot(cross(a, b), cross(middle[0], middle[1])),
            _ => dot(a, middle[0]),
        }
    };
    let middle = tangents(centre);
    let apex = |k: usize| kind.table().shape == CellShape::Pyramid && k == 4;
    let near = |k: usize| std::array::from_fn(|c| centre[c] + NEAR_APEX * (places[k][c] - centre[c]));
    (0..places.len()).all(|k| size(if apex(k) { near(k) } else { places[k] }, &middle) > 0.0)
        && size(centre, &middle) > 0.0
}

/// ∫ dl, dA or dV of a cell \[m, m², m³\].
pub(super) fn measure(mesh: &Mesh, cell: &Cell) -> f64 {
    let scaled = |point: QuadraturePoint| point.weight * cell.scale(&mesh.nodes, point.at);
    cell.kind().quadrature(5).into_iter().map(scaled).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CellKind;

    /// A mesh of one cell at its reference coordinates, moved by an affine map that keeps the orientation, or does not.
    fn one(kind: CellKind, mirrored: bool) -> Mesh {
        let sign = if mirrored { -1.0 } else { 1.0 };
        let map =
            |[x, y, z]: [f64; 3]| [sign * (2.0 * x + 0.3 * y), 0.2 * x + y - 0.1 * z, 0.1 * x + 0.5 * z];
        let nodes = kind.reference_coordinates().into_iter().map(map).collect();
        let all: Vec<usize> = (0..kind.n_nodes()).collect();
        Mesh { nodes, elements: vec![Cell::new(kind, &all).unwrap()], ..Mesh::default() }
    }

    #[test]
    fn sound_cells_of_every_kind_pass_and_mirrored_solids_do_not() {
        for kind in CellKind::all() {
            let sound = one(kind, false);
            assert!(keeps_orientation(&sound, &sound.elements[0]), "{kind:?}");
            let mirrored = one(kind, true);
            assert_eq!(keeps_orientation(&mirrored, &mirrored.elements[0]), kind.dimension() < 3, "{kind:?}");
        }
    }

    /// The middle of an edge beyond a quarter of it: there the map turns back at the nearer end.
    #[test]
    fn middles_far_out_of_place_fail() {
        for kind in CellKind::all().filter(|kind| !kind.is_first_order() && kind.dimension() > 1) {
            for (share, sound) in [(0.30, true), (0.20, false)] {
                let mut mesh = one(kind, false);
                let (a, b, middle) = (mesh.nodes[0], mesh.nodes[1], kind.n_corners());
                mesh.nodes[middle] = std::array::from_fn(|c| a[c] + share * (b[c] - a[c]));
                assert_eq!(keeps_orientation(&mesh, &mesh.elements[0]), sound, "{kind:?} {share}");
            }
        }
    }
}
