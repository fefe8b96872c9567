//! The faces that one solid alone has.

use crate::deck::Element;
use stridor_mesh::{Cell, Mesh};

/// Elements with the numbers of their sides that no other of them has; solids among `wanted` alone count. Ascending.
pub(crate) fn outer_faces(
    elements: &[Element],
    wanted: impl IntoIterator<Item = usize>,
) -> Vec<(usize, usize)> {
    let solids: Vec<usize> = wanted.into_iter().filter(|k| elements[*k].kind.dimension() == 3).collect();
    let cell = |index: &usize| Cell::new(elements[*index].kind, &elements[*index].nodes);
    let mesh = Mesh { elements: solids.iter().filter_map(cell).collect(), ..Mesh::default() };
    let skin = mesh.skin(0..mesh.elements.len()).into_iter();
    let mut faces: Vec<_> = skin.map(|side| (solids[side.cell], side.side)).collect();
    faces.sort_unstable();
    faces
}
