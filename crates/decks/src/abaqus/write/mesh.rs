//! *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE.

use super::{Writer, row};
use crate::deck::{Element, SectionShape, Set, ShellFace};
use crate::ledger::Weight;
use crate::written::sections_of_elements;
use stridor_mesh::{CellKind, Program};

/// The numbers of the sides of a pyramid, as those of the brick whose upper corners are one.
const SIDES_OF_PYRAMID: [u8; 5] = [1, 3, 4, 5, 6];

/// What a file calls an element, and how it has its nodes and sides.
struct Form {
    name: &'static str,
    nodes: Vec<usize>,
    sides: &'static [u8],
}

/// The form of an element: its own type where these programs have it, else the first that does what the kind does.
fn form(element: &Element, type_name: &str, truss: bool) -> Option<Form> {
    let kind = element.kind;
    let own = kind.named(Program::Abaqus).iter().find_map(|form| {
        let name = form.names().find(|name| name.eq_ignore_ascii_case(type_name))?;
        Some((name, form))
    });
    let usual = match kind {
        CellKind::Point1 => return None,
        CellKind::Hexahedron8 => "C3D8I",
        CellKind::Quadrilateral4 => "S4",
        CellKind::Line2 if truss => "T3D2",
        CellKind::Line3 if truss => "T3D3",
        _ => "",
    };
    let first = kind.named(Program::Abaqus).first();
    let (name, form) = match own.filter(|(name, _)| !(truss && name.starts_with('B'))) {
        Some(own) => own,
        None => match first {
            Some(form) if usual.is_empty() => (form.names().next()?, form),
            Some(form) => (usual, form),
            None => return collapsed(element),
        },
    };
    Some(Form { name, nodes: form.order.to_file(&element.nodes), sides: form.sides })
}

/// A kind that these programs do not have, as a brick whose nodes fall together.
fn collapsed(element: &Element) -> Option<Form> {
    let form = element.kind.named(Program::Ansys).first()?;
    let name = if form.order.to_file(&element.nodes).len() == 20 { "C3D20" } else { return None };
    Some(Form { name, nodes: form.order.to_file(&element.nodes), sides: &SIDES_OF_PYRAMID })
}

impl Writer<'_> {
    /// *NODE.
    pub(super) fn nodes(&mut self) {
        self.line("*NODE");
        for (node, number) in self.deck.nodes.iter().zip(self.node_numbers.clone()) {
            self.line(format!("{number}, {}", row(&node.position)));
        }
    }

    fn form_of(&self, index: usize, truss: bool) -> Option<Form> {
        let element = &self.deck.elements[index];
        let name = self.deck.type_names.get(element.type_name as usize).map_or("", String::as_str);
        form(element, name, truss)
    }

    /// *ELEMENT: a block for each run of elements of one type.
    pub(super) fn elements(&mut self) {
        let mut last = "";
        for (index, section) in sections_of_elements(self.deck).into_iter().enumerate() {
            let shape = section.map(|section| &self.deck.sections[section].shape);
            let Some(form) = self.form_of(index, matches!(shape, Some(SectionShape::Truss { .. }))) else {
                let name = self.deck.elements[index].kind.table().name;
                self.note(Weight::Matters, name, "elements of this kind are not written");
                continue;
            };
            if self.deck.elements[index].kind == CellKind::Pyramid13 {
                let why = "13-node pyramids are C3D20 whose upper nodes fall together, which CalculiX integrates badly";
                self.note(Weight::Matters, "13-node pyramid", why);
            }
            if form.name.starts_with("C3D27") || form.name == "C3D5" || form.name.starts_with("C3D15V") {
                let why = format!("CalculiX has no {}: Abaqus alone reads the file", form.name);
                self.note(Weight::Perhaps, form.name, &why);
            }
            if form.name != last {
                self.line(format!("*ELEMENT, TYPE={}", form.name));
                last = form.name;
            }
            let mut numbers = vec![self.element_numbers[index]];
            numbers.extend(self.node_numbers_of(&form.nodes));
            let words: Vec<String> = numbers.iter().map(u64::to_string).collect();
            let lines: Vec<String> = words.chunks(super::IN_A_LINE).map(|line| line.join(", ")).collect();
            self.line(lines.join(",\n"));
        }
    }

    /// *NSET, *ELSET.
    pub(super) fn sets(&mut self) {
        let deck = self.deck;
        let internal = |set: &Set| if set.internal { ", INTERNAL" } else { "" };
        for set in deck.node_sets.iter().filter(|set| !set.members.is_empty()) {
            let name = self.node_sets.of(&set.name);
            self.line(format!("*NSET, NSET={name}{}", internal(set)));
            self.list(&self.node_numbers_of(&set.members));
        }
        for set in deck.element_sets.iter().filter(|set| !set.members.is_empty()) {
            let name = self.element_sets.of(&set.name);
            self.line(format!("*ELSET, ELSET={name}{}", internal(set)));
            self.list(&self.element_numbers_of(&set.members));
        }
    }

    /// *SURFACE, TYPE=ELEMENT with a line a side, or TYPE=NODE.
    pub(super) fn surfaces(&mut self) {
        let deck = self.deck;
        for surface in &deck.surfaces {
            let name = self.surfaces.of(&surface.name);
            let internal = if surface.internal { ", INTERNAL" } else { "" };
            if surface.faces.is_empty() && surface.shells.is_empty() {
                self.line(format!("*SURFACE, NAME={name}, TYPE=NODE{internal}"));
                self.node_numbers_of(&surface.nodes).iter().for_each(|number| self.line(number.to_string()));
                continue;
            }
            if !surface.nodes.is_empty() {
                let why = "nodes beside the sides of a surface are not written";
                self.note(Weight::Matters, &format!("surface {}", surface.name), why);
            }
            self.line(format!("*SURFACE, NAME={name}, TYPE=ELEMENT{internal}"));
            for (index, side) in &surface.faces {
                let sides = self.form_of(*index, false).map_or(&[][..], |form| form.sides);
                match sides.get(*side) {
                    Some(side) => self.line(format!("{}, S{side}", self.element_numbers[*index])),
                    None => {
                        let why = "sides that have no number are not written";
                        self.note(Weight::Matters, &format!("surface {}", surface.name), why);
                    }
                }
            }
            for (index, face) in &surface.shells {
                let word = if *face == ShellFace::Positive { "SPOS" } else { "SNEG" };
                self.line(format!("{}, {word}", self.element_numbers[*index]));
            }
        }
    }

    /// The number of a side of a solid.
    pub(super) fn side_number(&self, index: usize, side: usize) -> Option<u8> {
        self.form_of(index, false)?.sides.get(side).copied()
    }
}
