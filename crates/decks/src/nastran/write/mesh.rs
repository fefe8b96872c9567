//! GRID, elements, BSURF, BSURFS, and what has no cards.

use super::Writer;
use super::card::Field;
use crate::deck::{SectionShape, Set, ShellFace};
use crate::ledger::Weight;
use crate::written::{one_line, sections_of_elements};
use stridor_mesh::quality::{cross, minus, norm};
use stridor_mesh::{CellKind, Program};

impl Writer<'_> {
    pub(super) fn nodes(&mut self) {
        for (k, node) in self.deck.nodes.iter().enumerate() {
            let [x, y, z] = node.position.map(Field::Real);
            self.card("GRID", &[self.node(k), Field::Blank, x, y, z]);
        }
    }

    /// Elements of a section, with its number as that of their property.
    pub(super) fn elements(&mut self) {
        let deck = self.deck;
        for (index, section) in sections_of_elements(deck).into_iter().enumerate() {
            let element = &deck.elements[index];
            // CBEAM3 and CQUAD are no bars and plates as these are.
            let known = !matches!(element.kind, CellKind::Line3 | CellKind::Quadrilateral9);
            let form = element.kind.named(Program::Nastran).first().filter(|_| known);
            let (Some(section), Some(form)) = (section, form) else {
                let what = element.kind.table().name;
                let why =
                    if section.is_none() { "elements without a section" } else { "elements of this kind" };
                self.note(Weight::Matters, what, &format!("{why} are not written"));
                continue;
            };
            let shape = &deck.sections[section].shape;
            let own = deck.type_names.get(element.type_name as usize).map_or("", String::as_str);
            let own = form.names().find(|name| name.eq_ignore_ascii_case(own));
            let name = match shape {
                SectionShape::Truss { .. } => "CROD",
                SectionShape::Beam { .. } if element.kind == CellKind::Line2 => "CBAR",
                _ => own.or(form.names().next()).unwrap_or_default(),
            };
            let mut fields =
                vec![Field::Integer(self.element_numbers[index]), Field::Integer(section as u64 + 1)];
            fields.extend(self.nodes_of(&form.order.to_file(&element.nodes)));
            if let SectionShape::Beam { first_axis, .. } = shape {
                let [a, b] = [0, 1].map(|k| deck.nodes[element.nodes[k]].position);
                fields.extend(beside(minus(b, a), *first_axis).map(Field::Real));
            }
            self.card(name, &fields);
        }
    }

    /// BSURFS of sides of solids, by three of their corners; BSURF of shells.
    pub(super) fn surfaces(&mut self) {
        let deck = self.deck;
        for (k, surface) in deck.surfaces.iter().enumerate() {
            let number = k as u64 + 1;
            self.surfaces.insert(surface.name.to_uppercase(), number);
            if !(surface.shells.is_empty() && surface.faces.is_empty()) {
                self.bulk.line(format!("$ Femap Region {number} : {}", one_line(&surface.name)));
            }
            if !surface.nodes.is_empty() {
                let why = "surfaces of nodes are not written";
                self.note(Weight::Matters, &format!("surface {}", surface.name), why);
            }
            if !surface.shells.is_empty() {
                if surface.shells.iter().any(|(_, face)| *face == ShellFace::Negative) {
                    let why = "both faces of the shells are written as one";
                    self.note(Weight::Perhaps, &format!("surface {}", surface.name), why);
                }
                let shells = surface.shells.iter().map(|(index, _)| self.element_numbers[*index]);
                let fields: Vec<Field> = std::iter::once(number).chain(shells).map(Field::Integer).collect();
                self.card("BSURF", &fields);
            }
            if !surface.faces.is_empty() {
                let mut fields = vec![Field::Integer(number), Field::Blank, Field::Blank, Field::Blank];
                for (index, side) in &surface.faces {
                    let element = &deck.elements[*index];
                    let (_, of_side) = element.kind.table().sides[*side];
                    fields.push(Field::Integer(self.element_numbers[*index]));
                    fields
                        .extend(of_side[..3].iter().map(|node| self.node(element.nodes[usize::from(*node)])));
                }
                self.card("BSURFS", &fields);
            }
        }
    }

    /// SET3 of nodes, and of elements that are no section; what has no cards here.
    pub(super) fn sets(&mut self) {
        let deck = self.deck;
        let section =
            |set: &&Set| deck.sections.iter().any(|section| section.name.eq_ignore_ascii_case(&set.name));
        let nodes = deck.node_sets.iter().map(|set| (set, "GRID", 1));
        let elements = deck.element_sets.iter().filter(|set| !section(set)).map(|set| (set, "ELEM", 2));
        let all = nodes.chain(elements).filter(|(set, ..)| !set.internal && !set.members.is_empty());
        for (k, (set, word, kind)) in all.enumerate() {
            let number = k as u64 + 1;
            let numbers = if kind == 1 { &self.node_numbers } else { &self.element_numbers };
            let members: Vec<Field> = set.members.iter().map(|at| Field::Integer(numbers[*at])).collect();
            let name = one_line(&set.name).replace('"', " ");
            self.bulk.line(format!("$HMSET {number:>8} {kind} \"{name}\""));
            self.card("SET3", &[&[Field::Integer(number), Field::Word(word.into())][..], &members].concat());
        }
        if deck.supports.iter().any(|support| !support.title.is_empty()) {
            self.note(Weight::Nothing, "supports", "names of supports are not written");
        }
        if !deck.motions.is_empty() {
            self.out.lose("rotations", "rotations are not written: RFORCE and RGYRO have them");
        }
    }
}

/// A direction beside a line: the one that is wanted, or that of the coordinates which is farthest from it.
fn beside(line: [f64; 3], wanted: Option<[f64; 3]>) -> [f64; 3] {
    let along = |axis: &[f64; 3]| norm(cross(line, *axis)) <= 1e-6 * norm(line) * norm(*axis);
    let least = (0..3).min_by(|a, b| line[*a].abs().total_cmp(&line[*b].abs())).unwrap_or(0);
    wanted.filter(|axis| !along(axis)).unwrap_or(std::array::from_fn(|k| f64::from(u8::from(k == least))))
}
