//! Cells whose nodes are counted the other way round, as NASTRAN allows and as a mirror leaves them.

use stridor_mesh::CellKind;
use stridor_mesh::quality::{cross, dot, minus};

/// The volume of a solid of straight edges through its sides, ∮ x·n dA/3, negative where its nodes are counted the other way round.
fn signed_volume(kind: CellKind, corners: &[[f64; 3]]) -> f64 {
    let at = |node: u8| minus(corners[usize::from(node)], corners[0]);
    let side = |(side, nodes): &(CellKind, &[u8])| {
        let n = side.n_corners();
        let triangle = |k: usize| dot(at(nodes[0]), cross(at(nodes[k]), at(nodes[k + 1])));
        (1..n - 1).map(triangle).sum::<f64>()
    };
    kind.table().sides.iter().map(side).sum::<f64>() / 6.0
}

/// Turns the nodes of a solid round if its volume is negative.
pub(crate) fn right_handed(
    kind: CellKind,
    nodes: &mut Vec<usize>,
    position: impl Fn(usize) -> [f64; 3],
) -> bool {
    let corners: Vec<[f64; 3]> = nodes[..kind.n_corners()].iter().map(|node| position(*node)).collect();
    if kind.dimension() != 3 || signed_volume(kind, &corners) >= 0.0 {
        return false;
    }
    *nodes = mirrored(kind, nodes);
    true
}

/// The nodes of a cell that is mirrored in an order that is not: local directions 1 and 2 exchanged, which brings each kind but a line, which
/// stays as it is, onto itself.
pub(crate) fn mirrored<T: Copy>(kind: CellKind, nodes: &[T]) -> Vec<T> {
    let places = kind.reference_coordinates();
    let from = |[x, y, z]: &[f64; 3]| {
        let wanted = [*y, *x, *z];
        places.iter().position(|other| (0..3).all(|k| (other[k] - wanted[k]).abs() < 1e-9))
    };
    let order: Option<Vec<usize>> = places.iter().map(from).collect();
    order.map_or_else(|| nodes.to_vec(), |order| order.into_iter().map(|place| nodes[place]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every solid that is mirrored in x is turned so that each middle is between its corners and its volume is that of before.
    #[test]
    fn mirrored_solids_are_turned() {
        for kind in CellKind::all().filter(|kind| kind.dimension() == 3) {
            let places = kind.reference_coordinates();
            let mirrored: Vec<[f64; 3]> = places.iter().map(|[x, y, z]| [-x, *y, *z]).collect();
            let own: Vec<usize> = (0..places.len()).collect();
            let mut nodes = own.clone();
            assert!(!right_handed(kind, &mut nodes, |node| places[node]) && nodes == own);
            assert!(right_handed(kind, &mut nodes, |node| mirrored[node]), "{kind:?}");
            let corners: Vec<[f64; 3]> =
                nodes[..kind.n_corners()].iter().map(|node| mirrored[*node]).collect();
            assert_eq!(signed_volume(kind, &corners), signed_volume(kind, &places[..kind.n_corners()]));
            for (middle, of) in nodes.iter().zip(kind.table().middles) {
                let mean: [f64; 3] = std::array::from_fn(|k| {
                    of.iter().map(|corner| corners[usize::from(*corner)][k]).sum::<f64>() / of.len() as f64
                });
                assert_eq!(mean, mirrored[*middle], "{kind:?}");
            }
        }
    }
}
