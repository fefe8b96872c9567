//! Sides of faces: neighbours are turned alike when they run along their common edge in opposite directions.
//!
//! Programs do not promise that neighbours are, nor do thickness, mass and stiffness depend on it.

use crate::{Mesh, Region};

/// Two faces with an edge in common, and whether they are turned opposite ways.
pub(super) struct Neighbours {
    pub faces: [usize; 2],
    pub opposite: bool,
}

/// The neighbours among the faces of a region. Where three or more plates meet there is no common side.
pub(super) fn neighbours(mesh: &Mesh, region: &Region) -> Vec<Neighbours> {
    let mut edges: Vec<([usize; 2], usize, bool)> = Vec::with_capacity(4 * region.elements.len());
    for e in region.elements.iter().filter(|_| region.dimension == 2) {
        let n = mesh.elements[*e].corners();
        edges.extend((0..n.len()).map(|i| {
            let (a, b) = (n[i], n[(i + 1) % n.len()]);
            ([a.min(b), a.max(b)], *e, a < b)
        }));
    }
    edges.sort_unstable();
    let pair = |faces: &[([usize; 2], usize, bool)]| match faces {
        [(_, e, up), (_, f, also_up)] if e != f => {
            Some(Neighbours { faces: [*e, *f], opposite: up == also_up })
        }
        _ => None,
    };
    edges.chunk_by(|a, b| a.0 == b.0).filter_map(pair).collect()
}

/// Turns faces over so that all neighbours within a region are turned alike: of those that hang together the fewer, and where
/// these are as many, the side of the first stays. A surface of one side, such as a Möbius strip, stays as it is.
pub fn turn_alike(mesh: &mut Mesh) {
    let mut near: Vec<Vec<(usize, bool)>> = vec![Vec::new(); mesh.elements.len()];
    let mut any = false;
    for Neighbours { faces: [e, f], opposite } in mesh.regions.iter().flat_map(|r| neighbours(mesh, r)) {
        near[e].push((f, opposite));
        near[f].push((e, opposite));
        any |= opposite;
    }
    if !any {
        return;
    }
    // Whether a face is turned opposite to the first of those that it hangs together with.
    let mut opposite_to_first: Vec<Option<bool>> = vec![None; near.len()];
    for first in 0..near.len() {
        if opposite_to_first[first].is_some() {
            continue;
        }
        opposite_to_first[first] = Some(false);
        let (mut found, mut next, mut two_sided) = (vec![(first, false)], 0, true);
        while let Some((e, turned)) = found.get(next).copied() {
            next += 1;
            for (f, opposite) in &near[e] {
                let side = turned != *opposite;
                match opposite_to_first[*f] {
                    None => {
                        opposite_to_first[*f] = Some(side);
                        found.push((*f, side));
                    }
                    Some(known) => two_sided &= known == side,
                }
            }
        }
        let opposite = found.iter().filter(|(_, turned)| *turned).count();
        let fewer = 2 * opposite <= found.len();
        for (e, turned) in found.into_iter().filter(|_| two_sided) {
            if turned == fewer {
                mesh.elements[e] = mesh.elements[e].turned_over();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Cell;
    use crate::generate::{Faces, structured_plate};

    /// However the faces of a plate are turned, they come back as they were, or all turned over.
    #[test]
    fn faces_that_were_turned_at_random_are_turned_back() {
        let mut seed = 2026u64;
        let mut coin = |one_in: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33).is_multiple_of(one_in)
        };
        for faces in [Faces::Triangles, Faces::Quadrilaterals] {
            for one_in in [1, 2, 5, 20] {
                let plate = structured_plate(2.0, 1.0, 5, 4, faces).unwrap();
                let mut mesh = plate.clone();
                // Half of the plate is a region of its own, too.
                let half: Vec<usize> = mesh.regions[0].elements.iter().copied().filter(|_| coin(2)).collect();
                mesh.regions.push(Region { name: "half".into(), dimension: 2, elements: half });
                let turn = |cell: &mut Cell| *cell = cell.turned_over();
                mesh.elements.iter_mut().filter(|_| coin(one_in)).for_each(turn);
                turn_alike(&mut mesh);
                if mesh.elements != plate.elements {
                    mesh.elements.iter_mut().for_each(turn);
                }
                assert_eq!(mesh.elements, plate.elements);
            }
        }
    }

    #[test]
    fn a_surface_of_one_side_stays_as_it_is() {
        let ring = |a: usize| Cell::quadrilateral([a, a + 1, a + 3, a + 2]);
        let mut mesh = Mesh { nodes: vec![[0.0; 3]; 8], ..Mesh::default() };
        mesh.add_region("strip", 2, [ring(0), ring(2), ring(4), Cell::quadrilateral([6, 7, 0, 1])]);
        let before = mesh.clone();
        turn_alike(&mut mesh);
        assert_eq!(mesh, before);
    }
}
