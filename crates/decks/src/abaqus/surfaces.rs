//! *SURFACE: faces of solids and shells, or nodes.

use super::space::Item;
use super::{Found, Reader, blocks};
use crate::deck::{Element, Place, ShellFace, Surface};
use crate::ledger::Weight;
use std::collections::BTreeSet;
use stridor_mesh::{Cell, Mesh, Program};

impl Reader {
    /// *SURFACE: sets or numbers of elements, with the number of a face, or of nodes.
    pub fn surface(&mut self, space: usize, found: Found<'_>) {
        let Some(name) = found.option("NAME") else {
            self.files.fault(found.place(), "*SURFACE without a name", "*SURFACE, NAME=…");
            return;
        };
        let own = self.spaces[space].qualified(name);
        let mut surface = Surface { name: own, internal: found.block.has("INTERNAL"), ..Surface::default() };
        let of_nodes = found.option("TYPE").is_some_and(|of| of.eq_ignore_ascii_case("NODE"));
        let read = if found.block.has("COMBINE") { Reader::combined } else { Reader::face_line };
        for row in found.rows() {
            if of_nodes {
                let nodes = self.nodes_of(space, row.cell(0), row.place).unwrap_or_default();
                surface.nodes.extend(nodes);
            } else {
                read(self, space, row.cell(0), row.cell(1), row.place, &mut surface);
            }
        }
        let sort = |list: &mut Vec<usize>| {
            list.sort_unstable();
            list.dedup();
        };
        sort(&mut surface.nodes);
        surface.faces.sort_unstable();
        surface.faces.dedup();
        surface.shells.sort_unstable();
        surface.shells.dedup();
        self.spaces[space].surfaces.entry(name, || surface);
    }

    /// A line of COMBINE: the name of a surface.
    fn combined(&mut self, space: usize, name: &str, _: &str, place: Place, surface: &mut Surface) {
        let Some(other) = self.surface_called(space, name).cloned() else {
            self.files.fault(place, format!("`{}`", blocks::short(name)), "the name of a *SURFACE");
            return;
        };
        surface.faces.extend(other.faces);
        surface.shells.extend(other.shells);
        surface.nodes.extend(other.nodes);
    }

    /// A line: elements, and which of their faces; without that the free ones.
    fn face_line(&mut self, space: usize, elements: &str, face: &str, place: Place, surface: &mut Surface) {
        let Some(items) = self.items_of(space, elements, place) else { return };
        let shapes: Vec<usize> = items
            .iter()
            .filter_map(|item| if let Item::Shape(index) = item { Some(*index) } else { None })
            .collect();
        let face = blocks::unquoted(face).to_uppercase();
        if face.is_empty() {
            let outer = outer_faces(&self.deck.elements);
            let of_shapes: BTreeSet<usize> = shapes.iter().copied().collect();
            surface.faces.extend(outer.into_iter().filter(|(element, _)| of_shapes.contains(element)));
            let shells = shapes.iter().filter(|index| self.deck.elements[**index].kind.dimension() == 2);
            surface.shells.extend(shells.map(|index| (*index, ShellFace::Positive)));
            return;
        }
        let mut wrong = 0;
        for index in shapes {
            let element = &self.deck.elements[index];
            match (element.kind.dimension(), face.as_str()) {
                (2, "SPOS" | "S2" | "SPOS1") => surface.shells.push((index, ShellFace::Positive)),
                (2, "SNEG" | "S1") => surface.shells.push((index, ShellFace::Negative)),
                (3, _) => match side_of(element, &face) {
                    Some(side) => surface.faces.push((index, side)),
                    None => wrong += 1,
                },
                _ => self.deck.ledger.note(
                    Weight::Matters,
                    format!("*SURFACE, face {face}"),
                    "edges of shells and beams are not read",
                    place,
                ),
            }
        }
        if wrong > 0 {
            let found = format!("face {face} of {wrong} elements that have none");
            self.files.fault(place, found, "S1 to S6 as the element has faces, SPOS or SNEG of shells");
        }
    }
}

/// The side of a solid that Abaqus calls S1, S2, …
pub(super) fn side_of(element: &Element, face: &str) -> Option<usize> {
    let number: u8 = face.strip_prefix(['S', 'P']).unwrap_or(face).parse().ok()?;
    let form = element.kind.named(Program::Abaqus).first()?;
    form.sides.iter().position(|side| *side == number)
}

/// The faces that one solid alone has.
fn outer_faces(elements: &[Element]) -> Vec<(usize, usize)> {
    let solids: Vec<usize> = (0..elements.len()).filter(|k| elements[*k].kind.dimension() == 3).collect();
    let cell = |index: &usize| Cell::new(elements[*index].kind, &elements[*index].nodes);
    let mesh = Mesh { elements: solids.iter().filter_map(cell).collect(), ..Mesh::default() };
    mesh.skin(0..mesh.elements.len()).into_iter().map(|side| (solids[side.cell], side.side)).collect()
}
