//! *BOUNDARY, *EQUATION, *MPC, *TIE.

use super::blocks;
use super::reader::{Found, Reader, Row};
use crate::deck::{Coupling, CouplingKind, Equation, Frame, Place, Support, Tie};
use crate::ledger::Weight;
use std::collections::HashMap;
use stridor_mesh::quality::minus;

/// Names for what *BOUNDARY holds.
const HELD: [(&str, [bool; 6]); 9] = [
    ("ENCASTRE", [true; 6]),
    ("PINNED", [true, true, true, false, false, false]),
    ("XSYMM", [true, false, false, false, true, true]),
    ("YSYMM", [false, true, false, true, false, true]),
    ("ZSYMM", [false, false, true, true, true, false]),
    ("XASYMM", [false, true, true, true, false, false]),
    ("YASYMM", [true, false, true, false, true, false]),
    ("ZASYMM", [true, true, false, false, false, true]),
    ("NOWARP", [false; 6]),
];

impl Reader {
    /// *BOUNDARY: nodes, first and last degree of freedom, a displacement; or nodes and a name.
    pub fn boundary(&mut self, space: usize, found: Found<'_>) {
        self.renew_supports(found);
        for row in found.rows() {
            let Some(nodes) = self.nodes_of(space, row.cell(0), row.place) else { continue };
            let Some(held) = self.held(&row) else { continue };
            let is_number = row.cell(0).parse::<u64>().is_ok();
            let name = (!is_number).then(|| self.set_words(space, row.cell(0)));
            self.support((&found.block.title, name), nodes, held, row.place);
        }
    }

    /// With OP=NEW in a step those of the steps before are no more.
    fn renew_supports(&mut self, found: Found<'_>) {
        if self.step.is_some() && found.option("OP").is_some_and(|op| op.eq_ignore_ascii_case("NEW")) {
            let why = "supports of this step are read beside those above, which it replaces";
            self.deck.ledger.note(Weight::Perhaps, "*BOUNDARY, OP=NEW", why, found.place());
        }
    }

    fn held(&mut self, row: &Row<'_>) -> Option<[bool; 6]> {
        let second = row.cell(1).to_uppercase();
        if let Some((_, held)) = HELD.iter().find(|(name, _)| *name == second) {
            return Some(*held);
        }
        let dof = |cell: &str, default: Option<u32>| {
            if cell.is_empty() { default } else { cell.trim_end_matches('.').parse().ok() }
        };
        let first = dof(row.cell(1), None);
        let last = dof(row.cell(2), first);
        let (Some(first), Some(last)) = (first, last) else {
            let found = format!("`{}, {}`", blocks::short(row.cell(1)), blocks::short(row.cell(2)));
            self.files.fault(
                row.place,
                found,
                "first and last degree of freedom, or a name such as ENCASTRE",
            );
            return None;
        };
        if last < first {
            let words = format!("degrees of freedom from {first} to {last}");
            self.files.fault(row.place, words, "first and last degree of freedom");
            return None;
        }
        let value = self.number(row, 3)?;
        // Networks of CalculiX have their temperature at 0.
        if last > 6 || first == 0 {
            let why = "degrees of freedom but 1 to 6 (temperature, pressure) are not read";
            self.deck.ledger.note(Weight::Nothing, "*BOUNDARY", why, row.place);
        }
        let mut held = [false; 6];
        (first.max(1)..=last.min(6)).for_each(|dof| held[dof as usize - 1] = true);
        if value != 0.0 && held.contains(&true) {
            let why = "a displacement that is not zero is taken as held";
            self.deck.ledger.note(Weight::Perhaps, "*BOUNDARY", why, row.place);
        }
        held.contains(&true).then_some(held)
    }

    /// Adds a support of nodes, apart by their frames; lines that follow each other and hold more of the same nodes are one.
    fn support(
        &mut self,
        (title, name): (&str, Option<String>),
        nodes: Vec<usize>,
        held: [bool; 6],
        place: Place,
    ) {
        let mut apart: Vec<(Frame, Vec<usize>)> = Vec::new();
        let mut known = HashMap::new();
        for node in nodes {
            let frame = self.frame_of.get(&node).copied();
            let at = *known.entry(frame).or_insert(apart.len());
            if at == apart.len() {
                apart.push((frame.map_or(Frame::Global, |frame| self.frames[frame]), Vec::new()));
            }
            apart[at].1.push(node);
        }
        for (frame, nodes) in apart {
            let same = |last: &&mut Support| last.frame == frame && last.nodes == nodes;
            if let Some(last) = self.deck.supports.last_mut().filter(same) {
                last.held.iter_mut().zip(held).for_each(|(own, held)| *own |= held);
                continue;
            }
            let (title, name) = (title.to_string(), name.clone());
            self.deck.supports.push(Support { title, name, nodes, held, frame, place });
        }
    }

    /// What the deck calls a set that a name means here.
    pub fn set_words(&self, space: usize, name: &str) -> String {
        let own = self.spaces[space].node_sets.get(name).map(|set| set.name.clone());
        own.unwrap_or_else(|| blocks::unquoted(name).to_string())
    }

    /// *EQUATION: the number of terms; node, degree of freedom, factor of each, up to four a line.
    pub fn equation(&mut self, space: usize, found: Found<'_>) {
        if found.block.has("REMOVE") {
            self.deck.ledger.note(
                Weight::Perhaps,
                "*EQUATION, REMOVE",
                "the equations of steps before stay",
                found.place(),
            );
            return;
        }
        let mut rows = found.rows();
        while let Some(head) = rows.next() {
            let Some(count) = self.label(head.place, head.cell(0)) else { return };
            let mut terms: Vec<(Vec<usize>, u8, f64)> = Vec::new();
            let mut displacements = true;
            while (terms.len() as u64) < count {
                let Some(row) = rows.next() else {
                    let found = format!("{} terms of an equation of {count}", terms.len());
                    self.files.fault(head.place, found, "as many as the first line says");
                    return;
                };
                for at in (0..row.cells.len()).step_by(3).filter(|at| !row.cell(*at).is_empty()) {
                    let Some(nodes) = self.nodes_of(space, row.cell(at), row.place) else { return };
                    let dof = row.cell(at + 1).trim_end_matches('.').parse::<u8>().ok();
                    let (Some(dof), Some(factor)) = (dof, self.number(&row, at + 2)) else {
                        self.files.fault(
                            row.place,
                            format!("`{}`", blocks::short(row.cell(at + 1))),
                            "a degree of freedom and a factor",
                        );
                        return;
                    };
                    displacements &= (1..=6).contains(&dof);
                    terms.push((nodes, dof.saturating_sub(1), factor));
                }
            }
            if terms.len() as u64 > count {
                let words = format!("{} terms of an equation of {count}", terms.len());
                self.files.fault(head.place, words, "as many as the first line says");
            } else if displacements {
                self.equations(terms, head.place);
            } else {
                let why = "equations of temperatures, pressures or flows are not read";
                self.deck.ledger.note(Weight::Nothing, "*EQUATION", why, head.place);
            }
        }
    }

    /// One equation, or one for each node of the sets, which run alike.
    fn equations(&mut self, terms: Vec<(Vec<usize>, u8, f64)>, place: Place) {
        let n = terms.first().map_or(0, |(nodes, ..)| nodes.len());
        if terms.iter().any(|(nodes, ..)| nodes.len() != 1 && nodes.len() != n) {
            self.files.fault(
                place,
                "an equation between sets of different sizes",
                "sets of as many nodes each, or single nodes",
            );
            return;
        }
        if !self.may_name(n.saturating_mul(terms.len()), place) {
            return;
        }
        for k in 0..n {
            let term =
                |(nodes, dof, factor): &(Vec<usize>, u8, f64)| (nodes[k.min(nodes.len() - 1)], *dof, *factor);
            let terms = terms.iter().map(term).flat_map(|term| self.term(term)).collect();
            self.deck.equations.push(Equation { terms, place });
        }
    }

    /// A term of an equation, its degree of freedom in the frame of its node, as terms in that of the coordinates.
    fn term(&self, (node, dof, factor): (usize, u8, f64)) -> Vec<(usize, u8, f64)> {
        let Some(directions) = self.directions_at(node) else { return vec![(node, dof, factor)] };
        let direction = directions[usize::from(dof % 3)];
        let component = |k: u8| (node, dof / 3 * 3 + k, factor * direction[usize::from(k)]);
        (0..3).map(component).filter(|(.., factor)| *factor != 0.0).collect()
    }

    /// *MPC: its kind and nodes.
    pub fn mpc(&mut self, space: usize, found: Found<'_>) {
        for row in found.rows() {
            let kind = row.cell(0).to_uppercase();
            if !matches!(kind.as_str(), "BEAM" | "TIE" | "PIN" | "LINK") {
                let why = "a constraint of this kind is not read";
                self.deck.ledger.note(Weight::Matters, format!("*MPC, {kind}"), why, row.place);
                continue;
            }
            let (Some(nodes), Some(reference)) =
                (self.nodes_of(space, row.cell(1), row.place), self.node_of(space, row.cell(2), row.place))
            else {
                continue;
            };
            if kind != "BEAM" {
                let position = |node: usize| self.deck.nodes[node].position;
                if kind == "LINK" {
                    for node in nodes {
                        let line = minus(position(node), position(reference));
                        let along = |end: usize, a: f64| (0..3).map(move |k| (end, k as u8, a * line[k]));
                        let terms = along(node, 1.0).chain(along(reference, -1.0));
                        let terms: Vec<_> = terms.filter(|(.., a)| *a != 0.0).collect();
                        if !terms.is_empty() {
                            self.deck.equations.push(Equation { terms, place: row.place });
                        }
                    }
                    continue;
                }
                let apart = |node: &usize| position(*node) != position(reference);
                if kind == "TIE" && !nodes.iter().any(apart) {
                    self.rigid(kind, reference, nodes, row.place);
                    continue;
                }
                if kind == "TIE" {
                    let why = "the rotations of nodes that are apart are not tied, their displacements are";
                    self.deck.ledger.note(Weight::Matters, "*MPC, TIE", why, row.place);
                }
                for node in nodes {
                    let equation = |dof: u8| Equation {
                        terms: vec![(node, dof, 1.0), (reference, dof, -1.0)],
                        place: row.place,
                    };
                    self.deck.equations.extend((0..3).map(equation));
                }
                continue;
            }
            self.rigid(kind, reference, nodes, row.place);
        }
    }

    fn rigid(&mut self, name: String, reference: usize, nodes: Vec<usize>, place: Place) {
        let kind = CouplingKind::Rigid;
        self.deck.couplings.push(Coupling { name, reference, nodes, of: None, kind, place });
    }

    /// *TIE: slave and master.
    pub fn tie(&mut self, space: usize, found: Found<'_>) {
        if let Some(option) = ["CYCLICSYMMETRY", "MULTISTAGE", "FLUIDPERIODIC", "FLUIDCYCLIC"]
            .into_iter()
            .find(|name| found.block.has(name))
        {
            let why = "surfaces that repeat each other are not read: the sector alone is the model";
            self.deck.ledger.note(Weight::Matters, format!("*TIE, {option}"), why, found.place());
            return;
        }
        let tolerance = found.option("POSITIONTOLERANCE");
        let within =
            tolerance.and_then(|cell| self.number(&Row { place: found.place(), cells: vec![cell] }, 0));
        let name = found.option("NAME").unwrap_or_default().to_string();
        for row in found.rows() {
            let slave = self.surface_of(space, row.cell(0), row.place);
            let master = self.surface_of(space, row.cell(1), row.place);
            let (Some(slave), Some(master)) = (slave, master) else { continue };
            self.deck.ties.push(Tie { name: name.clone(), slave, master, within, place: row.place });
        }
    }
}
