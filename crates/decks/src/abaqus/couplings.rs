//! *COUPLING, *KINEMATIC COUPLING, *DISTRIBUTING COUPLING, *RIGID BODY.

use super::blocks;
use super::reader::{Found, Reader, Row};
use super::space::Item;
use crate::deck::{Coupling, CouplingKind, Place};
use crate::ledger::Weight;
use std::collections::BTreeSet;

impl Reader {
    /// The nodes of a surface or of a set of nodes.
    fn surface_nodes(&mut self, space: usize, name: &str, place: Place) -> Vec<usize> {
        match self.surface_called(space, name) {
            Some(surface) => surface.all_nodes(&self.deck.elements),
            None => self.nodes_of(space, name, place).unwrap_or_default(),
        }
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

    /// A coupling of nodes that have no name.
    fn couple(&mut self, found: Found<'_>, reference: usize, mut nodes: Vec<usize>, kind: CouplingKind) {
        nodes.sort_unstable();
        nodes.dedup();
        nodes.retain(|node| *node != reference);
        let (name, of, place) = (String::new(), None, found.place());
        self.deck.couplings.push(Coupling { name, reference, nodes, of, kind, place });
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
        for row in found.rows().filter(|row| !row.cell(0).is_empty()) {
            some = true;
            if let Some(own) = self.dofs(&row, 0) {
                coupled.iter_mut().zip(own).for_each(|(all, own)| *all |= own);
            }
        }
        if some {
            self.note_coupled(found, coupled);
        }
    }

    /// Degrees of freedom from a first to a last one.
    fn dofs(&mut self, row: &Row<'_>, at: usize) -> Option<[bool; 6]> {
        let dof =
            |cell: &str| cell.trim_end_matches('.').parse::<usize>().ok().filter(|dof| (1..=6).contains(dof));
        let first = dof(row.cell(at));
        let last = if row.cell(at + 1).is_empty() { first } else { dof(row.cell(at + 1)) };
        let (Some(first), Some(last)) = (first, last) else {
            let found = format!("`{}, {}`", blocks::short(row.cell(at)), blocks::short(row.cell(at + 1)));
            self.files.fault(row.place, found, "first and last degree of freedom, from 1 to 6");
            return None;
        };
        Some(std::array::from_fn(|k| (first..=last).contains(&(k + 1))))
    }

    /// Notes a coupling of some displacements alone. Nodes of solids have no rotations.
    fn note_coupled(&mut self, found: Found<'_>, coupled: [bool; 6]) {
        if coupled[..3] != [true; 3] {
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
        let mut coupled = [false; 6];
        for row in found.rows() {
            nodes.extend(self.nodes_of(space, row.cell(0), row.place).unwrap_or_default());
            let own = if row.cell(1).is_empty() { Some([true; 6]) } else { self.dofs(&row, 1) };
            coupled.iter_mut().zip(own.unwrap_or_default()).for_each(|(all, own)| *all |= own);
        }
        self.note_coupled(found, coupled);
        self.couple(found, reference, nodes, CouplingKind::Rigid);
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
        let (mut nodes, mut weights) = (Vec::new(), BTreeSet::new());
        for row in found.rows() {
            nodes.extend(self.nodes_of(space, row.cell(0), row.place).unwrap_or_default());
            if let Some(weight) = self.number(&row, 1) {
                weights.insert(weight.to_bits());
            }
        }
        if weights.len() > 1 {
            let why = "weights of the nodes are not read; areas are";
            self.deck.ledger.note(Weight::Perhaps, "*DISTRIBUTING COUPLING", why, found.place());
        }
        self.couple(found, reference, nodes, CouplingKind::Averaging);
    }

    /// *RIGID BODY: elements or nodes that follow a node.
    pub fn rigid_body(&mut self, space: usize, found: Found<'_>) {
        let Some(node) = found.option("REFNODE") else {
            let why = "a rigid body without a reference node is not read";
            self.deck.ledger.note(Weight::Matters, "*RIGID BODY", why, found.place());
            return;
        };
        let Some(reference) = self.node_of(space, node, found.place()) else { return };
        if found.block.has("ROTNODE") {
            let why =
                "the rotations of the body are those of REF NODE; what is said of ROT NODE has no effect";
            self.deck.ledger.note(Weight::Matters, "*RIGID BODY, ROT NODE", why, found.place());
        }
        let mut nodes = Vec::new();
        for option in ["NSET", "TIENSET", "PINNSET"] {
            let Some(name) = found.option(option) else { continue };
            nodes.extend(self.nodes_of(space, name, found.place()).unwrap_or_default());
        }
        if let Some(name) = found.option("ELSET") {
            let items = self.items_of(space, name, found.place()).unwrap_or_default();
            nodes.extend(items.into_iter().flat_map(|item| self.nodes_of_item(item)));
        }
        self.couple(found, reference, nodes, CouplingKind::Rigid);
    }
}
