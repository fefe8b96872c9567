//! *BOUNDARY, *TRANSFORM, *EQUATION, *MPC, *TIE, *COUPLING, *RIGID BODY.

use super::space::Item;
use super::{Found, Reader, Row, blocks};
use crate::deck::{Coupling, CouplingKind, Equation, Frame, Place, Support, Tie};
use crate::ledger::Weight;
use std::collections::BTreeMap;

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
            self.support(name, nodes, held, row.place);
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
        let value = self.number(row, 3)?;
        if value != 0.0 {
            let why = "a displacement that is not zero is taken as held";
            self.deck.ledger.note(Weight::Perhaps, "*BOUNDARY", why, row.place);
        }
        if last > 6 {
            let why = "degrees of freedom above 6 (temperature, pressure) are not read";
            self.deck.ledger.note(Weight::Nothing, "*BOUNDARY", why, row.place);
        }
        let mut held = [false; 6];
        (first.max(1)..=last.min(6)).for_each(|dof| held[dof as usize - 1] = true);
        held.contains(&true).then_some(held)
    }

    /// Adds a support of nodes, apart by their frames; lines that follow each other and hold more of the same nodes are one.
    fn support(&mut self, name: Option<String>, nodes: Vec<usize>, held: [bool; 6], place: Place) {
        let mut apart: Vec<(Frame, Vec<usize>)> = Vec::new();
        for node in nodes {
            let frame = self.frames.get(&node).copied().unwrap_or(Frame::Global);
            match apart.iter_mut().find(|(other, _)| *other == frame) {
                Some((_, nodes)) => nodes.push(node),
                None => apart.push((frame, vec![node])),
            }
        }
        for (frame, nodes) in apart {
            let same = |last: &&mut Support| last.frame == frame && last.nodes == nodes;
            if let Some(last) = self.deck.supports.last_mut().filter(same) {
                last.held.iter_mut().zip(held).for_each(|(own, held)| *own |= held);
                continue;
            }
            self.deck.supports.push(Support { name: name.clone(), nodes, held, frame, place });
        }
    }

    /// What the deck calls a set that a name means here.
    pub fn set_words(&self, space: usize, name: &str) -> String {
        let own = self.spaces[space].node_sets.get(name).map(|set| set.name.clone());
        own.unwrap_or_else(|| blocks::unquoted(name).to_string())
    }

    /// *TRANSFORM: two points of a frame for the degrees of freedom of a set.
    pub fn transform(&mut self, space: usize, found: Found<'_>) {
        let Some(name) = found.option("NSET") else {
            self.files.fault(found.place(), "*TRANSFORM without a set", "*TRANSFORM, NSET=…");
            return;
        };
        let nodes = self.nodes_of(space, name, found.place()).unwrap_or_default();
        let Some(row) = found.rows().next() else {
            self.files.fault(found.place(), "*TRANSFORM without data", "two points");
            return;
        };
        let Some([ax, ay, az, bx, by, bz]) = self.numbers::<6>(&row, 0) else { return };
        let placement = self.spaces[space].placement;
        let turn = |axis: [f64; 3]| placement.map_or(axis, |placement| placement.turn(axis));
        let place = |point: [f64; 3]| placement.map_or(point, |placement| placement.place(point));
        let frame = match found.option("TYPE").unwrap_or("R").to_uppercase().as_str() {
            "C" => Some(Frame::Cylindrical([place([ax, ay, az]), turn([bx - ax, by - ay, bz - az])])),
            "S" => None,
            _ => turned([turn([ax, ay, az]), turn([bx, by, bz])]).map(Frame::Turned),
        };
        let Some(frame) = frame else {
            let why = "a frame on a sphere, or of points in one line, is not read";
            self.deck.ledger.note(Weight::Matters, "*TRANSFORM", why, found.place());
            return;
        };
        self.frames.extend(nodes.into_iter().map(|node| (node, frame)));
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
            if displacements {
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
        for k in 0..n {
            let term =
                |(nodes, dof, factor): &(Vec<usize>, u8, f64)| (nodes[k.min(nodes.len() - 1)], *dof, *factor);
            self.deck.equations.push(Equation { terms: terms.iter().map(term).collect(), place });
        }
    }

    /// *MPC: its kind and nodes.
    pub fn mpc(&mut self, space: usize, found: Found<'_>) {
        for row in found.rows() {
            let kind = row.cell(0).to_uppercase();
            if !matches!(kind.as_str(), "BEAM" | "TIE" | "PIN") {
                let why = "a constraint of this kind is not read";
                self.deck.ledger.note(Weight::Matters, format!("*MPC, {kind}"), why, row.place);
                continue;
            }
            let (Some(nodes), Some(reference)) =
                (self.nodes_of(space, row.cell(1), row.place), self.node_of(space, row.cell(2), row.place))
            else {
                continue;
            };
            if kind == "PIN" {
                for node in nodes {
                    let equation = |dof: u8| Equation {
                        terms: vec![(node, dof, 1.0), (reference, dof, -1.0)],
                        place: row.place,
                    };
                    self.deck.equations.extend((0..3).map(equation));
                }
                continue;
            }
            let of = None;
            self.deck.couplings.push(Coupling {
                name: kind,
                reference,
                nodes,
                of,
                kind: CouplingKind::Rigid,
                place: row.place,
            });
        }
    }

    /// *TIE: slave and master.
    pub fn tie(&mut self, space: usize, found: Found<'_>) {
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

    /// The nodes of a surface or of a set of nodes.
    fn surface_nodes(&mut self, space: usize, name: &str, place: Place) -> Vec<usize> {
        let Some(surface) = self.surface_called(space, name).cloned() else {
            return self.nodes_of(space, name, place).unwrap_or_default();
        };
        let mut nodes = surface.nodes;
        for (element, side) in surface.faces {
            let element = &self.deck.elements[element];
            let (_, of_side) = element.kind.table().sides[side];
            nodes.extend(of_side.iter().map(|node| element.nodes[usize::from(*node)]));
        }
        nodes.extend(surface.shells.iter().flat_map(|(element, _)| &self.deck.elements[*element].nodes));
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// *COUPLING: a node and a surface; *KINEMATIC or *DISTRIBUTING below says how.
    pub fn coupling(&mut self, space: usize, found: Found<'_>) {
        let (Some(node), Some(surface)) = (found.option("REFNODE"), found.option("SURFACE")) else {
            self.files.fault(found.place(), "*COUPLING without REF NODE or SURFACE", "both");
            return;
        };
        let Some(reference) = self.node_of(space, node, found.place()) else { return };
        let mut nodes = self.surface_nodes(space, surface, found.place());
        nodes.retain(|node| *node != reference);
        let name = found.option("CONSTRAINTNAME").unwrap_or_default().to_string();
        let of = Some(blocks::unquoted(surface).to_string());
        self.deck.couplings.push(Coupling {
            name,
            reference,
            nodes,
            of,
            kind: CouplingKind::Rigid,
            place: found.place(),
        });
    }

    /// *KINEMATIC: degrees of freedom that are coupled; all when there are none.
    pub fn kinematic(&mut self, _: usize, found: Found<'_>) {
        self.all_coupled(found);
    }

    /// *DISTRIBUTING: as *KINEMATIC, on average.
    pub fn distributing(&mut self, _: usize, found: Found<'_>) {
        self.all_coupled(found);
        if let Some(last) = self.deck.couplings.last_mut() {
            last.kind = CouplingKind::Averaging;
        }
    }

    fn all_coupled(&mut self, found: Found<'_>) {
        let mut coupled = [false; 6];
        let mut some = false;
        for row in found.rows() {
            let dof = |at: usize| row.cell(at).trim_end_matches('.').parse::<usize>().ok();
            let Some(first) = dof(0) else { continue };
            let last = dof(1).unwrap_or(first);
            (first.max(1)..=last.min(6)).for_each(|k| coupled[k - 1] = true);
            some = true;
        }
        // Nodes of solids have no rotations.
        if some && coupled[..3] != [true; 3] {
            let why = "a coupling of some displacements is read as one of all";
            self.deck.ledger.note(Weight::Matters, format!("*{}", found.block.keyword), why, found.place());
        }
    }

    /// *KINEMATIC COUPLING, REF NODE: nodes and their degrees of freedom.
    pub fn kinematic_coupling(&mut self, space: usize, found: Found<'_>) {
        let Some(node) = found.option("REFNODE") else {
            self.files.fault(found.place(), "*KINEMATIC COUPLING without REF NODE", "REF NODE=…");
            return;
        };
        let Some(reference) = self.node_of(space, node, found.place()) else { return };
        let mut nodes = Vec::new();
        for row in found.rows() {
            nodes.extend(self.nodes_of(space, row.cell(0), row.place).unwrap_or_default());
        }
        let kind = CouplingKind::Rigid;
        self.deck.couplings.push(Coupling {
            name: String::new(),
            reference,
            nodes,
            of: None,
            kind,
            place: found.place(),
        });
    }

    /// *DISTRIBUTING COUPLING, ELSET: nodes with weights; the set has one DCOUP3D, whose node is the one that follows.
    pub fn distributing_coupling(&mut self, space: usize, found: Found<'_>) {
        let items = found
            .option("ELSET")
            .and_then(|name| self.items_of(space, name, found.place()))
            .unwrap_or_default();
        let [Item::Point(point)] = items.as_slice() else {
            self.files.fault(
                found.place(),
                "*DISTRIBUTING COUPLING",
                "a set with one element of type DCOUP3D",
            );
            return;
        };
        let reference = self.points[*point].nodes[0];
        let (mut nodes, mut weights) = (Vec::new(), BTreeMap::new());
        for row in found.rows() {
            nodes.extend(self.nodes_of(space, row.cell(0), row.place).unwrap_or_default());
            if let Some(weight) = self.number(&row, 1) {
                weights.insert(weight.to_bits(), ());
            }
        }
        if weights.len() > 1 {
            let why = "weights of the nodes are not read; areas are";
            self.deck.ledger.note(Weight::Perhaps, "*DISTRIBUTING COUPLING", why, found.place());
        }
        let kind = CouplingKind::Averaging;
        self.deck.couplings.push(Coupling {
            name: String::new(),
            reference,
            nodes,
            of: None,
            kind,
            place: found.place(),
        });
    }

    /// *RIGID BODY: elements or nodes that follow a node.
    pub fn rigid_body(&mut self, space: usize, found: Found<'_>) {
        let Some(node) = found.option("REFNODE") else {
            let why = "a rigid body without a reference node is not read";
            self.deck.ledger.note(Weight::Matters, "*RIGID BODY", why, found.place());
            return;
        };
        let Some(reference) = self.node_of(space, node, found.place()) else { return };
        let mut nodes = Vec::new();
        for option in ["NSET", "TIENSET", "PINNSET"] {
            let Some(name) = found.option(option) else { continue };
            nodes.extend(self.nodes_of(space, name, found.place()).unwrap_or_default());
        }
        if let Some(name) = found.option("ELSET") {
            let items = self.items_of(space, name, found.place()).unwrap_or_default();
            nodes.extend(items.into_iter().flat_map(|item| self.nodes_of_item(item)));
        }
        nodes.sort_unstable();
        nodes.dedup();
        nodes.retain(|node| *node != reference);
        let kind = CouplingKind::Rigid;
        self.deck.couplings.push(Coupling {
            name: String::new(),
            reference,
            nodes,
            of: None,
            kind,
            place: found.place(),
        });
    }
}

/// Unit vectors: the first along a, the third across the plane of a and b; none where these are in one line.
fn turned([a, b]: [[f64; 3]; 2]) -> Option<[[f64; 3]; 3]> {
    let cross = |u: [f64; 3], v: [f64; 3]| {
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let unit = |v: [f64; 3]| {
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        (length > 0.0).then(|| v.map(|x| x / length))
    };
    let first = unit(a)?;
    let third = unit(cross(a, b))?;
    Some([first, cross(third, first), third])
}
