//! *SURFACE: faces of solids and shells, or nodes.

use super::blocks;
use super::collapsed::side_of_brick;
use super::reader::{Found, Reader};
use super::space::Item;
use crate::deck::{Place, ShellFace, Surface};
use crate::ledger::Weight;
use crate::skin::outer_faces;
use stridor_mesh::Program;

impl Reader {
    /// *SURFACE: sets or numbers of elements, with the number of a face, or of nodes.
    pub fn surface(&mut self, space: usize, found: Found<'_>) {
        let Some(name) = found.option("NAME") else {
            self.files.fault(found.place(), "*SURFACE without a name", "*SURFACE, NAME=…");
            return;
        };
        let own = self.spaces[space].qualified(name);
        let mut surface = Surface { name: own, internal: found.block.has("INTERNAL"), ..Surface::default() };
        let of = found.option("TYPE").unwrap_or("ELEMENT").to_uppercase();
        let combine = found.option("COMBINE").unwrap_or("UNION").to_uppercase();
        if !matches!(of.as_str(), "NODE" | "ELEMENT") || combine != "UNION" {
            let what = format!("*SURFACE, TYPE={of}, COMBINE={combine}");
            let why = "a surface of this kind is not read; it has no faces";
            self.deck.ledger.note(Weight::Matters, what, why, found.place());
            self.add_surface(space, name, surface, found.place());
            return;
        }
        for row in found.rows() {
            if found.block.has("COMBINE") {
                row.cells.iter().filter(|name| !name.is_empty()).for_each(|name| {
                    self.combined(space, name, row.place, &mut surface);
                });
            } else if of == "NODE" {
                let nodes = self.nodes_of(space, row.cell(0), row.place).unwrap_or_default();
                surface.nodes.extend(nodes);
            } else {
                self.face_line(space, row.cell(0), row.cell(1), row.place, &mut surface);
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
        self.add_surface(space, name, surface, found.place());
    }

    /// CalculiX takes a surface of nodes and one of faces of the same name as two.
    fn add_surface(&mut self, space: usize, name: &str, surface: Surface, place: Place) {
        let of_nodes = surface.faces.is_empty() && surface.shells.is_empty();
        let mut added = Some(surface);
        let known = self.spaces[space].surfaces.entry(name, || added.take().unwrap_or_default());
        let Some(surface) = added.filter(|surface| surface != known) else { return };
        let (no_faces, no_nodes) =
            (known.faces.is_empty() && known.shells.is_empty(), known.nodes.is_empty());
        if of_nodes && no_nodes {
            known.nodes = surface.nodes;
        } else if surface.nodes.is_empty() && no_faces {
            (known.faces, known.shells) = (surface.faces, surface.shells);
        } else {
            self.files.fault(place, format!("a second *SURFACE `{name}`"), "one surface of each name");
            return;
        }
        let why = "a surface of nodes and one of faces that have the same name are read as one of both";
        self.deck.ledger.note(Weight::Perhaps, "*SURFACE", why, place);
    }

    /// A line of COMBINE: the name of a surface.
    fn combined(&mut self, space: usize, name: &str, place: Place, surface: &mut Surface) {
        let Some(other) = self.surface_called(space, name).cloned() else {
            self.files.fault(place, format!("`{}`", blocks::short(name)), "the name of a *SURFACE");
            return;
        };
        if !self.may_name(other.faces.len() + other.shells.len() + other.nodes.len(), place) {
            return;
        }
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
            let outer = self.outer.get_or_insert_with(|| {
                let elements = &self.deck.elements;
                outer_faces(elements, 0..elements.len())
            });
            for index in &shapes {
                let from = outer.partition_point(|(element, _)| element < index);
                surface.faces.extend(outer[from..].iter().take_while(|(element, _)| element == index));
            }
            let dimension = |index: &usize| self.deck.elements[*index].kind.dimension();
            let shells: Vec<usize> = shapes.iter().copied().filter(|index| dimension(index) == 2).collect();
            if !shells.is_empty() {
                let why = "of shells without a face the side that the normal points out of is read";
                self.deck.ledger.note(Weight::Perhaps, "*SURFACE", why, place);
            }
            surface.shells.extend(shells.into_iter().map(|index| (index, ShellFace::Positive)));
            return;
        }
        let mut wrong = 0;
        for index in shapes {
            let element = &self.deck.elements[index];
            match (element.kind.dimension(), face.as_str()) {
                (2, "SPOS" | "S2") => surface.shells.push((index, ShellFace::Positive)),
                (2, "SNEG" | "S1") => surface.shells.push((index, ShellFace::Negative)),
                (3, _) => match self.side_of(index, &face) {
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

impl Reader {
    /// The side of a solid that Abaqus calls S1, S2, …
    pub fn side_of(&self, index: usize, face: &str) -> Option<usize> {
        let number: u8 = face.strip_prefix(['S', 'P']).unwrap_or(face).parse().ok()?;
        let element = &self.deck.elements[index];
        if let Some(corners) = self.collapsed.get(&index) {
            return side_of_brick(element, corners, number);
        }
        let form = element.kind.named(Program::Abaqus).first()?;
        form.sides.iter().position(|side| *side == number)
    }
}
