//! *NODE, *ELEMENT.

use super::collapsed::collapsed;
use super::points;
use super::reader::{Found, Reader, Row};
use super::space::Item;
use super::waiting::PointElement;
use crate::deck::{Element, Node, Place};
use crate::ledger::Weight;
use std::collections::btree_map::Entry;
use stridor_mesh::{CellKind, Program};

impl Reader {
    /// *NODE: number, coordinates.
    pub fn nodes(&mut self, space: usize, found: Found<'_>) {
        let mut read = Vec::new();
        for row in found.rows() {
            let (Some(number), Some(given)) =
                (self.label(row.place, row.cell(0)), self.numbers::<3>(&row, 1))
            else {
                continue;
            };
            let position = cartesian(given, found.option("SYSTEM"));
            let placement = self.spaces[space].placement;
            let position = placement.map_or(position, |placement| placement.place(position));
            read.extend(self.put_node(space, found, row.place, number, position, 0.0));
        }
        if let Some(name) = found.option("NSET") {
            self.spaces[space].node_set(name).members.extend(read);
        }
    }

    /// A node, which may stand there already: within this distance it is noted as the same one, else it is a fault.
    pub fn put_node(
        &mut self,
        space: usize,
        found: Found<'_>,
        place: Place,
        number: u64,
        position: [f64; 3],
        within: f64,
    ) -> Option<usize> {
        if !position.iter().all(|x| x.is_finite()) {
            self.files.fault(place, format!("node {number} at {position:?}"), "a place that is finite");
            return None;
        }
        match self.spaces[space].nodes.entry(number) {
            Entry::Vacant(free) => {
                free.insert(self.deck.nodes.len());
                self.deck.nodes.push(Node { number, position, place });
                Some(self.deck.nodes.len() - 1)
            }
            Entry::Occupied(taken) => {
                let first = &self.deck.nodes[*taken.get()];
                if (0..3).all(|k| (first.position[k] - position[k]).abs() <= within) {
                    let why = "nodes that stand there twice, at one place";
                    let what = format!("*{}", found.block.keyword);
                    self.deck.ledger.note(Weight::Nothing, what, why, place);
                } else {
                    let found = format!("a second node {number} at another place");
                    let expected =
                        format!("one node of each number; the first stands in line {}", first.place.line);
                    self.files.fault(place, found, expected);
                }
                Some(*taken.get())
            }
        }
    }

    /// *ELEMENT: number, nodes; as many lines as the nodes take.
    pub fn elements(&mut self, space: usize, found: Found<'_>) {
        let Some(type_name) = found.option("TYPE").map(str::to_uppercase) else {
            self.files.fault(found.place(), "*ELEMENT without a type", "*ELEMENT, TYPE=…");
            return;
        };
        let shape = shape_of(&type_name);
        let n_nodes = shape
            .as_ref()
            .map(|(_, n_nodes)| *n_nodes)
            .or_else(|| points::n_nodes(&type_name).map(|n| [n, n]));
        if n_nodes.is_none() {
            let what = format!("*ELEMENT, TYPE={type_name}");
            let weight = if type_name.starts_with("DC") { Weight::Nothing } else { Weight::Matters };
            self.deck.ledger.note(weight, what, "elements of a type that is not read", found.place());
        }
        let type_index = if shape.is_some() { self.type_index(&type_name) } else { 0 };
        let mut read = Vec::new();
        let mut rows = found.rows();
        while let Some(Row { place, mut cells }) = rows.next() {
            let mut n_lines = 0;
            loop {
                n_lines += 1;
                let open = drop_last_empty(&mut cells);
                // An element goes on until it has its nodes, whether the line ends in a comma or not.
                let complete =
                    n_nodes.map_or(!open, |[few, many]| cells.len() > if open { many } else { few });
                match if complete { None } else { rows.next() } {
                    Some(next) => cells.extend(next.cells),
                    None => break,
                }
            }
            let Some(number) = self.label(place, cells[0]) else { continue };
            let Some([few, many]) = n_nodes else {
                self.spaces[space].elements.entry(number).or_insert(Item::Unread);
                read.push(Item::Unread);
                continue;
            };
            let n_nodes = if cells.len() > many { many } else { few };
            if cells.len() > n_nodes + 1 && n_lines > 1 {
                let words = format!(
                    "element {number} of type {type_name} with {} nodes in {n_lines} lines",
                    cells.len() - 1
                );
                self.files.fault(place, words, format!("{n_nodes} nodes"));
                continue;
            }
            if cells.len() > n_nodes + 1 {
                let what = format!("*ELEMENT, TYPE={type_name}");
                let why = format!("nodes after the {n_nodes} of the type are not read");
                self.deck.ledger.note(Weight::Nothing, what, why, place);
            }
            cells.truncate(n_nodes + 1);
            let Some(nodes) = self.element_nodes(space, place, &type_name, &cells, n_nodes) else { continue };
            if let Some(known) = self.spaces[space].elements.get(&number).copied() {
                read.extend(self.again(found, place, &type_name, number, known, &nodes));
                continue;
            }
            let item = match &shape {
                Some((base, _)) => {
                    let own = CellKind::of_file(Program::Abaqus, base, &nodes);
                    let Some((kind, own)) = own.and_then(|(kind, own)| collapsed(kind, &own)) else {
                        let found =
                            format!("an element {number} of type {type_name} whose nodes fall together");
                        let expected =
                            "nodes that differ, or a brick that is a wedge, a pyramid or a tetrahedron";
                        self.files.fault(place, found, expected);
                        continue;
                    };
                    if own.len() < n_nodes && kind.dimension() == 3 {
                        self.collapsed.insert(self.deck.elements.len(), nodes[..8].to_vec());
                    }
                    let type_name = type_index;
                    self.deck.elements.push(Element { number, kind, type_name, nodes: own, place });
                    Item::Shape(self.deck.elements.len() - 1)
                }
                None => {
                    let Some(type_name) = points::type_named(&type_name) else { continue };
                    self.points.push(PointElement { number, type_name, nodes });
                    Item::Point(self.points.len() - 1)
                }
            };
            self.spaces[space].elements.insert(number, item);
            read.push(item);
        }
        if let Some(name) = found.option("ELSET") {
            self.spaces[space].element_set(name).items.extend(read);
        }
    }

    /// An element whose number is taken: a note if it is the same one, else a fault.
    pub fn again(
        &mut self,
        found: Found<'_>,
        place: Place,
        type_name: &str,
        number: u64,
        known: Item,
        nodes: &[usize],
    ) -> Option<Item> {
        let same = match known {
            Item::Shape(index) => {
                let element = &self.deck.elements[index];
                let mut own = [nodes.to_vec(), element.nodes.clone()];
                own.iter_mut().for_each(|nodes| {
                    nodes.sort_unstable();
                    nodes.dedup();
                });
                self.deck.type_names[element.type_name as usize] == type_name && own[0] == own[1]
            }
            Item::Point(index) => {
                self.points[index].type_name == type_name && self.points[index].nodes == nodes
            }
            Item::Unread => false,
        };
        if same {
            let why = "elements that stand there twice, on the same nodes";
            let what = format!("*{}", found.block.keyword);
            self.deck.ledger.note(Weight::Nothing, what, why, place);
            return Some(known);
        }
        self.files.fault(place, format!("a second element {number}"), "one element of each number");
        None
    }

    /// The nodes of an element by their numbers; a fault where one is not there, or where there are too few.
    fn element_nodes(
        &mut self,
        space: usize,
        place: Place,
        type_name: &str,
        cells: &[&str],
        n_nodes: usize,
    ) -> Option<Vec<usize>> {
        if cells.len() <= n_nodes {
            let found = format!("{} nodes of an element of type {type_name}", cells.len() - 1);
            self.files.fault(place, found, format!("{n_nodes} nodes"));
            return None;
        }
        let mut nodes = Vec::with_capacity(n_nodes);
        for cell in &cells[1..] {
            // Numbers of its own nodes, or those of an instance: `PART-1.5`.
            let own =
                || cell.parse().ok().and_then(|number: u64| self.spaces[space].nodes.get(&number)).copied();
            let other =
                || self.nodes_called(space, cell).and_then(|nodes| <[usize; 1]>::try_from(nodes).ok());
            match own().or_else(|| other().map(|[node]| node)) {
                Some(node) => nodes.push(node),
                None => {
                    let found = format!("an element on node {}", super::blocks::short(cell));
                    self.files.fault(place, found, "a node of the file");
                    return None;
                }
            }
        }
        Some(nodes)
    }

    /// The index of the name of a type, which is added if it is new.
    fn type_index(&mut self, name: &str) -> u32 {
        let names = &mut self.deck.type_names;
        let index = names.iter().position(|known| known == name).unwrap_or_else(|| {
            names.push(name.to_string());
            names.len() - 1
        });
        index as u32
    }
}

/// Whether the line ends in a comma, or in several: what stands behind is no cell.
fn drop_last_empty(cells: &mut Vec<&str>) -> bool {
    let n = cells.len();
    while cells.len() > 1 && cells.last().is_some_and(|cell| cell.is_empty()) {
        cells.pop();
    }
    cells.len() < n
}

/// The name in the table of kinds of a type with a shape, and the fewest and the most nodes that it has.
fn shape_of(type_name: &str) -> Option<(String, [usize; 2])> {
    let known = |name: &str| {
        let kinds = CellKind::all().filter(|kind| kind.dimension() > 0);
        let forms = kinds.flat_map(|kind| kind.named(Program::Abaqus).iter().map(move |form| (kind, form)));
        let fits = forms.filter(|(_, form)| form.names().any(|own| own == name));
        let counts: Vec<usize> = fits.map(|(kind, _)| kind.n_nodes()).collect();
        Some([*counts.iter().min()?, *counts.iter().max()?])
    };
    let exact = known(type_name).map(|n| (type_name.to_string(), n));
    // Coupled with temperature: the same nodes.
    exact.or_else(|| {
        let base = type_name.strip_suffix('T')?;
        known(base).map(|n| (base.to_string(), n))
    })
}

/// The coordinates that SYSTEM gives, as Cartesian ones.
pub(super) fn cartesian(given: [f64; 3], system: Option<&str>) -> [f64; 3] {
    match system.unwrap_or_default() {
        "C" | "c" => cylindrical(given),
        "S" | "s" => spherical(given),
        _ => given,
    }
}

/// (r, θ in degrees, z).
fn cylindrical([r, angle, z]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = angle.to_radians().sin_cos();
    [r * cos, r * sin, z]
}

/// (r, θ in degrees from x, φ in degrees from the plane of x and y).
fn spherical([r, angle, height]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = height.to_radians().sin_cos();
    cylindrical([r * cos, angle, r * sin])
}
