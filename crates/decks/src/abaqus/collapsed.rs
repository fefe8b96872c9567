//! Bricks and quadrilaterals whose nodes fall together: wedges, pyramids, tetrahedra, triangles.
//!
//! ANSYS names which nodes fall together ([`Program::Ansys`]); Abaqus and CalculiX take any edge or face, so that the brick is turned until it
//! is one of these.

use crate::deck::Element;
use stridor_mesh::{CellKind, Program};

/// The kind of an element of a kind by its nodes, some of which may be the same, and these in the order of the kind; none where it is no cell.
pub(super) fn collapsed<T: Copy + Ord>(kind: CellKind, nodes: &[T]) -> Option<(CellKind, Vec<T>)> {
    let mut once = nodes.to_vec();
    once.sort_unstable();
    once.dedup();
    if once.len() == nodes.len() {
        return Some((kind, nodes.to_vec()));
    }
    let name = match kind {
        CellKind::Hexahedron8 => "SOLID185",
        CellKind::Hexahedron20 => "SOLID186",
        CellKind::Quadrilateral4 => "SHELL181",
        CellKind::Quadrilateral8 => "SHELL281",
        _ => return None,
    };
    let found = turns(kind).into_iter().filter_map(|turn| {
        let turned: Vec<T> = turn.iter().map(|place| nodes[*place]).collect();
        CellKind::of_file(Program::Ansys, name, &turned)
    });
    found.min_by_key(|(_, own)| own.len()).filter(|(_, own)| own.len() == once.len())
}

/// The rotations that bring a brick or a quadrilateral onto itself: the node that comes to the place of each.
fn turns(kind: CellKind) -> Vec<Vec<usize>> {
    let places = kind.reference_coordinates();
    let axes: &[[usize; 3]] = &[[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2], [0, 2, 1], [2, 1, 0]];
    let mut all = Vec::new();
    for (odd, axis) in axes.iter().enumerate().map(|(k, axis)| (k >= 3, axis)) {
        for signs in 0..8_u32 {
            let mirrored = odd ^ (signs.count_ones() % 2 == 1);
            let keeps_plane = axis[2] == 2 && signs & 4 == 0;
            if mirrored || (kind.dimension() == 2 && !keeps_plane) {
                continue;
            }
            let sign = |k: usize| if signs >> k & 1 == 1 { -1.0 } else { 1.0 };
            let turned = |x: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|k| sign(k) * x[axis[k]]) };
            let node = |x: &[f64; 3]| {
                let from = turned(x);
                places.iter().position(|other| (0..3).all(|k| (other[k] - from[k]).abs() < 1e-9))
            };
            all.extend(places.iter().map(node).collect::<Option<Vec<usize>>>());
        }
    }
    all
}

/// The side that has the corners of face `number` of the brick of these corners; none where the face is no more than a line.
pub(super) fn side_of_brick(element: &Element, corners: &[usize], number: u8) -> Option<usize> {
    let form = CellKind::Hexahedron8.named(Program::Abaqus).first()?;
    let face = form.sides.iter().position(|side| *side == number)?;
    let (_, places) = CellKind::Hexahedron8.table().sides.get(face)?;
    let mut wanted: Vec<usize> =
        places.iter().map(|place| corners.get(usize::from(*place)).copied()).collect::<Option<_>>()?;
    wanted.sort_unstable();
    wanted.dedup();
    element.kind.table().sides.iter().position(|(side, places)| {
        let own = places[..side.n_corners()].iter().map(|place| element.nodes[usize::from(*place)]);
        let mut own: Vec<usize> = own.collect();
        own.sort_unstable();
        own == wanted
    })
}
