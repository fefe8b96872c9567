//! *ELGEN, *ELCOPY.

use crate::abaqus::reader::{Found, Reader, Row};
use crate::abaqus::space::Item;
use crate::abaqus::waiting::PointElement;
use crate::deck::{Element, Place};
use crate::ledger::Weight;
use crate::turn::mirrored;
use stridor_mesh::CellKind;

impl Reader {
    /// *ELGEN: an element and three times how many there are, with the increments of their nodes and numbers: in a row, in rows, in layers.
    pub fn elements_in_rows(&mut self, space: usize, found: Found<'_>) {
        let mut all = Vec::new();
        for row in found.rows() {
            all.extend(self.grid(space, found, &row).unwrap_or_default());
        }
        if let Some(name) = found.option("ELSET") {
            self.spaces[space].element_set(name).items.extend(all);
        }
    }

    fn grid(&mut self, space: usize, found: Found<'_>, row: &Row<'_>) -> Option<Vec<Item>> {
        let first = self.label(row.place, row.cell(0))?;
        let Some(item) = self.spaces[space].elements.get(&first).copied() else {
            self.files.fault(row.place, format!("element {first}"), "an element above this line");
            return None;
        };
        let mut directions = [(0, 0, 0); 3];
        for (k, direction) in directions.iter_mut().enumerate() {
            let count = self.count(row, 1 + 3 * k)?;
            let [nodes, number] = [self.whole(row, 2 + 3 * k, 1)?, self.whole(row, 3 + 3 * k, 1)?];
            *direction = (count as u64, i128::from(nodes), i128::from(number));
        }
        let [in_row, rows, layers] = directions;
        // Below 2¹⁸⁹: of the three numbers below 2⁶³ the last one may be too many.
        let n = u128::from(in_row.0).saturating_mul(u128::from(rows.0)).saturating_mul(u128::from(layers.0));
        if !self.may_generate(n - 1, row.place) {
            return None;
        }
        let mut all = vec![item];
        for (l, j, i) in
            (0..layers.0).flat_map(|l| (0..rows.0).flat_map(move |j| (0..in_row.0).map(move |i| (l, j, i))))
        {
            if (l, j, i) == (0, 0, 0) {
                continue;
            }
            let [i, j, l] = [i, j, l].map(i128::from);
            let by_node = i * in_row.1 + j * rows.1 + l * layers.1;
            let by = i * in_row.2 + j * rows.2 + l * layers.2;
            let number = self.shifted(first, by, row.place)?;
            all.extend(self.copied(space, found, row.place, (item, number), by_node));
        }
        Some(all)
    }

    /// *ELCOPY: the elements of a set on other nodes.
    pub fn copied_elements(&mut self, space: usize, found: Found<'_>) {
        let (Some(by), Some(by_node), Some(old)) = (
            self.shift(found, "ELEMENTSHIFT", "ELEMENT SHIFT"),
            self.shift(found, "SHIFTNODES", "SHIFT NODES"),
            self.old_set(found),
        ) else {
            return;
        };
        let Some(items) = self.items_so_far(space, old, found.place()) else { return };
        if !self.may_generate(items.len() as u128, found.place()) {
            return;
        }
        if found.block.has("REFLECT") {
            let why = "faces of reflected elements are numbered as if local directions 1 and 2 were exchanged: \
                       compare surfaces and pressures on them";
            self.deck.ledger.note(Weight::Perhaps, "*ELCOPY, REFLECT", why, found.place());
        }
        let mut all = Vec::with_capacity(items.len());
        for item in items {
            let number = match item {
                Item::Shape(index) => self.deck.elements[index].number,
                Item::Point(index) => self.points[index].number,
                // Its type is listed.
                Item::Unread => continue,
            };
            let Some(number) = self.shifted(number, i128::from(by), found.place()) else { return };
            all.extend(self.copied(space, found, found.place(), (item, number), i128::from(by_node)));
        }
        if let Some(name) = found.option("NEWSET") {
            self.spaces[space].element_set(name).items.extend(all);
        }
    }

    /// An element as another one, on nodes whose numbers are larger by so much.
    fn copied(
        &mut self,
        space: usize,
        found: Found<'_>,
        place: Place,
        (item, number): (Item, u64),
        by_node: i128,
    ) -> Option<Item> {
        let reflect = found.block.has("REFLECT");
        let nodes = self.nodes_shifted(space, place, number, &self.nodes_of_item(item), by_node)?;
        let known = self.spaces[space].elements.get(&number).copied();
        let new = match item {
            Item::Shape(index) => {
                let Element { kind, type_name, .. } = self.deck.elements[index];
                let nodes = if reflect { mirrored(kind, &nodes) } else { nodes };
                if let Some(known) = known {
                    let name = self.deck.type_names[type_name as usize].clone();
                    return self.again(found, place, &name, number, known, &nodes);
                }
                if let Some(corners) = self.collapsed.get(&index).cloned() {
                    let corners = self.nodes_shifted(space, place, number, &corners, by_node)?;
                    let corners = if reflect { mirrored(CellKind::Hexahedron8, &corners) } else { corners };
                    self.collapsed.insert(self.deck.elements.len(), corners);
                }
                self.deck.elements.push(Element { number, kind, type_name, nodes, place });
                Item::Shape(self.deck.elements.len() - 1)
            }
            Item::Point(index) => {
                let type_name = self.points[index].type_name;
                if let Some(known) = known {
                    return self.again(found, place, type_name, number, known, &nodes);
                }
                self.points.push(PointElement { number, type_name, nodes });
                Item::Point(self.points.len() - 1)
            }
            Item::Unread => *self.spaces[space].elements.entry(number).or_insert(item),
        };
        self.spaces[space].elements.insert(number, new);
        Some(new)
    }

    /// Nodes by numbers that are larger by so much; a fault where one is not there, or is of an instance.
    fn nodes_shifted(
        &mut self,
        space: usize,
        place: Place,
        element: u64,
        nodes: &[usize],
        by: i128,
    ) -> Option<Vec<usize>> {
        let own = &self.spaces[space].nodes;
        let shifted = |node: &usize| {
            let number = self.deck.nodes[*node].number;
            own.get(&number).filter(|own| *own == node).ok_or(i128::from(number))?;
            let number = i128::from(number).saturating_add(by);
            u64::try_from(number).ok().and_then(|number| own.get(&number)).copied().ok_or(number)
        };
        match nodes.iter().map(shifted).collect::<Result<Vec<usize>, i128>>() {
            Ok(nodes) => Some(nodes),
            Err(number) => {
                let words = format!("an element {element} generated on node {number}");
                self.files.fault(place, words, "a node of the file, not of an instance");
                None
            }
        }
    }
}
