//! Elements and sides of a deck by their nodes.

use crate::decks::{Deck, ShellFace, Surface};
use crate::mesh::Cell;
use std::collections::HashMap;

/// Elements and sides of solids by their nodes.
#[derive(Debug, Default)]
pub(super) struct Sides {
    elements: HashMap<Vec<usize>, usize>,
    sides: HashMap<Vec<usize>, (usize, usize)>,
}

fn sorted(nodes: &[usize]) -> Vec<usize> {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    nodes
}

impl Sides {
    pub fn new(deck: &Deck) -> Self {
        let mut found = Sides::default();
        for (index, element) in deck.elements.iter().enumerate() {
            found.elements.entry(sorted(&element.nodes)).or_insert(index);
            if element.kind.dimension() < 3 {
                continue;
            }
            for (side, (_, nodes)) in element.kind.table().sides.iter().enumerate() {
                let nodes: Vec<usize> = nodes.iter().map(|node| element.nodes[usize::from(*node)]).collect();
                found.sides.entry(sorted(&nodes)).or_insert((index, side));
            }
        }
        found
    }

    /// The element of a cell.
    pub fn element(&self, cell: &Cell) -> Option<usize> {
        self.elements.get(&sorted(cell.nodes())).copied()
    }

    /// The surface of some cells: sides of solids, shells, or the nodes of lines and points.
    pub fn surface(&self, name: &str, cells: &[Cell]) -> Surface {
        let mut surface = Surface { name: name.into(), ..Surface::default() };
        for cell in cells {
            let nodes = sorted(cell.nodes());
            match (cell.dimension(), self.elements.get(&nodes), self.sides.get(&nodes)) {
                (2, Some(shell), _) => surface.shells.push((*shell, ShellFace::Positive)),
                (2, None, Some(side)) => surface.faces.push(*side),
                _ => surface.nodes.extend(nodes),
            }
        }
        surface.faces.sort_unstable();
        surface.shells.sort_unstable();
        surface.nodes.sort_unstable();
        surface.nodes.dedup();
        surface
    }
}
