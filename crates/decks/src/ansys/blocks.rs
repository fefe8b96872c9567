//! Blocks of lines by a Fortran format: NBLOCK, EBLOCK, ETBLOCK, RLBLOCK, CMBLOCK, DBLOCK, SFEBLOCK, and SECBLOCK.

use super::fortran::{Columns, real, whole};
use super::model::{Attributes, Component, ElementType, RawElement, RawNode};
use super::reader::{Command, Reader, shown};
use crate::deck::Place;
use crate::ledger::Weight;

/// The most nodes of an element.
const MOST_NODES: i64 = 32;

impl<'a> Reader<'a> {
    /// The format of a block.
    fn columns(&mut self, command: &Command<'_>) -> Option<Columns> {
        let line = self.peek().unwrap_or("");
        let columns = Columns::read(line);
        match columns {
            Some(_) => _ = self.line(),
            None => {
                let found = format!("`{}` after {}", shown(line), command.name);
                self.fault(command.place, found, "a Fortran format, such as (3i9,6e21.13e3)");
            }
        }
        columns
    }

    /// The next line of a block, which ends at −1, at a command and at the end of the file.
    fn row(&mut self) -> Option<(&'a str, Place)> {
        loop {
            let line = self.peek()?;
            let text = line.trim();
            match text.bytes().next() {
                None => _ = self.line(),
                Some(b'0'..=b'9' | b'+' | b'.') => return self.line(),
                Some(b'-') => {
                    let row = self.line();
                    // A −1 alone ends the block.
                    return row.filter(|_| text != "-1");
                }
                Some(_) => return None,
            }
        }
    }

    /// A fault where a block states more lines than it has.
    fn complete(&mut self, command: &Command<'_>, stated: usize, read: usize, what: &str) {
        // Blank is not stated.
        let stated = self.value(command.arg(stated)).unwrap_or(0.0);
        if (read as f64) < stated {
            let found = format!("{} with {read} {what}, which ends here", command.name);
            self.files.fault_with_help(
                self.here(),
                found,
                format!("{stated} {what}, as it states"),
                "The file is cut off or damaged: write it again",
            );
        }
    }

    fn wholes(&mut self, fields: &[&str], place: Place) -> Option<Vec<i64>> {
        let read: Vec<Option<i64>> = fields.iter().map(|field| whole(field)).collect();
        if let Some(k) = read.iter().position(Option::is_none) {
            self.fault(place, format!("`{}`", shown(fields[k])), "a whole number");
            return None;
        }
        Some(read.into_iter().flatten().collect())
    }

    fn reals(&mut self, fields: &[&str], place: Place) -> Option<Vec<f64>> {
        let read: Vec<Option<f64>> = fields.iter().map(|field| real(field)).collect();
        if let Some(k) = read.iter().position(Option::is_none) {
            self.fault(place, format!("`{}`", shown(fields[k])), "a number");
            return None;
        }
        Some(read.into_iter().flatten().collect())
    }

    /// NBLOCK: node, line and keypoint of the geometry, x, y, z, θxy, θyz, θzx; the end of a line may be left out.
    pub fn nodes_block(&mut self, command: &Command<'_>) {
        let Some(columns) = self.columns(command) else { return };
        let n = columns.leading_wholes();
        if n == 0 {
            let expected = "a format that begins with whole numbers";
            return self.fault(command.place, "a format of NBLOCK without the number of a node", expected);
        }
        let mut count = 0;
        while let Some((line, place)) = self.row() {
            let fields = columns.split(line);
            let head = &fields[..n.min(fields.len())];
            count += 1;
            let Some(head) = self.wholes(head, place) else { continue };
            let Some(values) = self.reals(fields.get(n..).unwrap_or(&[]), place) else { continue };
            let at = |k: usize| values.get(k).copied().unwrap_or(0.0);
            self.node(head[0], [at(0), at(1), at(2)], [at(3), at(4), at(5)], place);
        }
        self.complete(command, 3, count, "nodes");
    }

    /// Defines a node.
    pub fn node(&mut self, number: i64, position: [f64; 3], angles: [f64; 3], place: Place) {
        let Some(number) = u64::try_from(number).ok().filter(|n| *n > 0) else {
            return self.fault(place, format!("node {number}"), "a number of a node above zero");
        };
        let known = self.model.nodes.get(&number).map(|node| (node.position == position, node.place));
        match known {
            None => {
                self.model.nodes.insert(number, RawNode { position, place });
                if angles != [0.0; 3] {
                    self.model.angles.insert(number, angles);
                }
                self.model.selected_nodes.add(number);
            }
            Some((true, _)) => {
                let why = "the same place again";
                self.note(Weight::Nothing, "nodes that stand twice", why, place);
            }
            Some((false, first)) => {
                let found = format!("node {number} at another place than in line {}", first.line);
                self.fault(place, found, "each node once");
            }
        }
    }

    /// EBLOCK: with SOLID material, type, real constants, section, coordinate system, birth, reference, shape, number of nodes,
    /// exclusion, element, nodes; without it element, type and section, real constants, material, coordinate system, nodes.
    pub fn elements_block(&mut self, command: &Command<'_>) {
        let solid = command.word(1).starts_with("SOL");
        let Some(columns) = self.columns(command) else { return };
        let mut count = 0;
        while let Some((line, place)) = self.row() {
            count += 1;
            let fields = columns.split(line);
            let Some(mut row) = self.wholes(&fields, place) else { continue };
            let (head, expected) = if solid { (11, row.get(8).copied().unwrap_or(0)) } else { (5, 0) };
            if row.len() <= head || !(0..=MOST_NODES).contains(&expected) {
                let found = format!("an element line of {} numbers: `{}`", row.len(), shown(line));
                self.fault(place, found, format!("{head} numbers, then 1 to {MOST_NODES} nodes"));
                continue;
            }
            let mut nodes = row.split_off(head);
            while (nodes.len() as i64) < expected {
                // Zeros at the end may be left out, and so may the whole line then.
                let next = self.peek().filter(|next| next.starts_with([' ', '\t']) && nodes.len() >= 8);
                let left = expected as usize - nodes.len();
                if !next.is_some_and(|next| are_nodes(&columns.split(next), left)) {
                    break;
                }
                let Some((line, place)) = self.row() else { break };
                let Some(more) = self.wholes(&columns.split(line), place) else { break };
                nodes.extend(more);
            }
            if solid && expected > 0 {
                nodes.resize(expected as usize, 0);
            }
            let attributes = if solid {
                [row[1], row[0], row[2], row[3], row[4]]
            } else {
                [row[1], row[3], row[2], row[1], row[4]]
            };
            self.element(if solid { row[10] } else { row[0] }, attributes, &nodes, place);
        }
        self.complete(command, 3, count, "elements");
    }

    /// Defines an element: type, material, real constants, section, coordinate system.
    pub fn element(&mut self, number: i64, attributes: [i64; 5], nodes: &[i64], place: Place) {
        let ids: Option<Vec<u32>> = attributes.iter().map(|id| u32::try_from(*id).ok()).collect();
        let known: Option<Box<[u64]>> = nodes.iter().map(|node| u64::try_from(*node).ok()).collect();
        let number = u64::try_from(number).ok().filter(|number| *number > 0);
        let (Some(ids), Some(nodes), Some(number)) = (ids, known, number) else {
            return self.fault(
                place,
                "a negative number in an element, or its own is zero",
                "numbers of nodes and properties",
            );
        };
        let attributes =
            Attributes { kind: ids[0], material: ids[1], real: ids[2], section: ids[3], system: ids[4] };
        let element = RawElement { attributes, nodes, place };
        match self.model.elements.get(&number) {
            None => {
                self.model.elements.insert(number, element);
                self.model.selected_elements.add(number);
            }
            Some(first) if first.attributes == attributes && first.nodes == element.nodes => {
                self.note(Weight::Nothing, "elements that stand twice", "the same nodes again", place);
            }
            Some(first) => {
                let found = format!("element {number}, which is another one in line {}", first.place.line);
                self.fault(place, found, "each element once");
            }
        }
    }

    /// ETBLOCK: type, the number in its name, key options from 1.
    pub fn types_block(&mut self, command: &Command<'_>) {
        let Some(columns) = self.columns(command) else { return };
        let mut count = 0;
        while let Some((line, place)) = self.row() {
            count += 1;
            let Some(row) = self.wholes(&columns.split(line), place) else { continue };
            let id = row.first().and_then(|id| u32::try_from(*id).ok());
            let routine = row.get(1).and_then(|routine| u32::try_from(*routine).ok());
            let (Some(id), Some(routine)) = (id, routine) else {
                self.fault(place, format!("`{}`", shown(line)), "a type and the number of an element");
                continue;
            };
            let options = row[2..].iter().zip(1..).filter(|(value, _)| **value != 0);
            let options = options.map(|(value, n)| (n, *value)).collect();
            self.model.types.insert(id, ElementType { routine, options, place });
        }
        self.complete(command, 0, count, "types");
    }

    /// RLBLOCK: sets of real constants, six in the first line, seven in others.
    pub fn reals_block(&mut self, command: &Command<'_>) {
        let Some(first) = self.columns(command) else { return };
        let Some(others) = self.columns(command) else { return };
        let n = first.leading_wholes().max(1);
        let mut count = 0;
        while let Some((line, place)) = self.row() {
            count += 1;
            let fields = first.split(line);
            let Some(head) = self.wholes(&fields[..n.min(fields.len())], place) else { continue };
            let Some(mut values) = self.reals(fields.get(n..).unwrap_or(&[]), place) else { continue };
            let wanted = head.get(1).copied().unwrap_or(0);
            // The first line holds as many as its format has; zeros at its end may be left out.
            let mut held = 6;
            while held < wanted {
                let Some((line, place)) = self.row() else { break };
                let Some(more) = self.reals(&others.split(line), place) else { break };
                values.resize(held as usize, 0.0);
                values.extend(more);
                held += 7;
            }
            match u32::try_from(head[0]) {
                Ok(set) if set > 0 => {
                    let own = self.model.reals.entry(set).or_default();
                    own.extend((1..).zip(values));
                }
                _ => self.fault(place, format!("set {} of real constants", head[0]), "a number above zero"),
            }
        }
        self.complete(command, 0, count, "sets of real constants");
    }

    /// CMBLOCK: name, NODE or ELEMENT, how many numbers; −n after m is all from m to n.
    pub fn component_block(&mut self, command: &Command<'_>) {
        let Some(columns) = self.columns(command) else { return };
        let stated = self.whole(command, 2).unwrap_or(0);
        let (mut ranges, mut count): (Vec<(u64, u64)>, i64) = (Vec::new(), 0);
        while count < stated {
            let Some((line, place)) = self.row() else { break };
            let Some(row) = self.wholes(&columns.split(line), place) else { continue };
            for number in row {
                count += 1;
                let end = number.unsigned_abs();
                match ranges.last_mut() {
                    _ if number > 0 => ranges.push((end, end)),
                    Some(last) if number < 0 && last.0 == last.1 && end >= last.0 => last.1 = end,
                    _ => {
                        let found = format!("{number} in component `{}`", shown(command.arg(0)));
                        self.fault(
                            place,
                            found,
                            "a number above zero, or −n after a smaller m: all from m to n",
                        );
                    }
                }
            }
        }
        self.complete(command, 2, count as usize, "numbers");
        let of_nodes = command.word(1).starts_with("NODE");
        if !of_nodes && !command.word(1).starts_with("ELEM") {
            let why = format!("a component of {}: nodes and elements are read", command.arg(1));
            return self.note(Weight::Nothing, "CMBLOCK", why, command.place);
        }
        self.model.add_component(Component::new(command.arg(0), of_nodes, ranges, command.place));
    }

    /// SECBLOCK: layers of a shell, each thickness, material, angle, points.
    pub fn section_block(&mut self, command: &Command<'_>) {
        let stated = self.whole(command, 0).unwrap_or(0);
        let mut data = Vec::new();
        while (data.len() as i64) < stated {
            let Some((line, place)) = self.row() else { break };
            let fields: Vec<&str> = line.split(',').collect();
            match self.reals(&fields, place) {
                Some(layer) => data.push(layer),
                None => return,
            }
        }
        self.complete(command, 0, data.len(), "layers");
        let section = self.model.section;
        self.model.sections.entry(section).or_default().data = data;
    }

    /// DBLOCK: node, label, value.
    pub fn held_block(&mut self, command: &Command<'_>) {
        let Some(_) = self.columns(command) else { return };
        while let Some((line, place)) = self.row() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let words = Command { name: "D".into(), args: words, place };
            self.hold(&words);
        }
    }

    /// SFEBLOCK: element, face, real or imaginary, values.
    pub fn pressures_block(&mut self, command: &Command<'_>) {
        let Some(columns) = self.columns(command) else { return };
        let pressure = command.word(1) == "PRES";
        while let Some((line, place)) = self.row() {
            let fields = columns.split(line);
            let Some(row) = self.reals(&fields, place).filter(|row| row.len() > 3) else { continue };
            if pressure {
                self.press(row[0] as u64, row[1] as u32, row[2] as i64, &row[3..], place);
            }
        }
        if !pressure {
            let why = "surface loads that are no pressure";
            self.note(Weight::Nothing, format!("SFEBLOCK {}", command.word(1)), why, command.place);
        }
    }
}

/// Whether a line is the second one of an element: nothing but nodes, and no more than are left.
fn are_nodes(fields: &[&str], left: usize) -> bool {
    (1..=left).contains(&fields.len())
        && fields.iter().all(|field| whole(field).is_some_and(|node| node >= 0))
}
