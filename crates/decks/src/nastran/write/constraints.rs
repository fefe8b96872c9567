//! SPC1, MPC, RBE2, RBE3, BGSET, BCTSET, FORCE, PLOAD4.

use super::card::Field;
use super::{SET, Writer};
use crate::deck::{CouplingKind, LoadOn};
use crate::ledger::Weight;
use crate::written::{Held, held};
use std::collections::BTreeMap;

use Field::{Blank, Integer, Real};

impl Writer<'_> {
    /// SPC1, and MPC where directions are held that are not those of the coordinates, or where the deck has equations.
    pub(super) fn supports(&mut self) {
        let deck = self.deck;
        let Held { supports, more, mut sums } = held(deck);
        let mut alike: BTreeMap<[bool; 6], Vec<usize>> = BTreeMap::new();
        let single = more.iter().map(|(node, dof)| (*node, std::array::from_fn(|k| k == usize::from(*dof))));
        let all = supports.iter().flatten().map(|own| (own.node, own.held)).chain(single);
        for (node, held) in all.filter(|(_, held)| held.contains(&true)) {
            alike.entry(held).or_default().push(node);
        }
        for (held, nodes) in alike {
            let mut fields = vec![Integer(SET), Field::components(held)];
            fields.extend(self.nodes_of(&nodes));
            self.card("SPC1", &fields);
        }
        sums.extend(deck.equations.iter().map(|equation| equation.terms.clone()));
        for terms in &sums {
            let mut fields = Vec::new();
            for pair in terms.chunks(2) {
                // Two terms a line, after the number of the set.
                fields.push(if fields.is_empty() { Integer(SET) } else { Blank });
                for (node, dof, factor) in pair {
                    fields.extend([self.node(*node), Integer(u64::from(*dof) + 1), Real(*factor)]);
                }
                fields.push(Blank);
            }
            self.card("MPC", &fields);
        }
    }

    pub(super) fn couplings(&mut self) {
        let deck = self.deck;
        for coupling in &deck.couplings {
            let (number, reference) = (self.new_element(), self.node(coupling.reference));
            let all = || Field::components([true; 6]);
            let nodes = self.nodes_of(&coupling.nodes);
            match coupling.kind {
                CouplingKind::Rigid => {
                    self.card("RBE2", &[&[number, reference, all()][..], &nodes].concat());
                }
                CouplingKind::Averaging => {
                    let head = [number, Blank, reference, all(), Real(1.0), Field::Word("123".into())];
                    self.card("RBE3", &[&head[..], &nodes].concat());
                    let why = "all nodes of an average weigh alike";
                    self.note(Weight::Perhaps, "averages", why);
                }
            }
        }
    }

    /// The numbers of two surfaces; none where one has none.
    fn pair(&mut self, what: &str, names: [&str; 2]) -> Option<[Field; 2]> {
        let deck = self.deck;
        let number = |name: &str| {
            let sides = deck.surface(name).is_some_and(|own| !own.faces.is_empty() || !own.shells.is_empty());
            self.surfaces.get(&name.to_uppercase()).filter(|_| sides).copied()
        };
        let found = names.map(number);
        let [Some(slave), Some(master)] = found else {
            self.note(Weight::Matters, what, "surfaces without sides are not written, nor what joins them");
            return None;
        };
        Some([Integer(slave), Integer(master)])
    }

    /// BGSET, a line a tie.
    pub(super) fn ties(&mut self) {
        let mut fields = Vec::new();
        for tie in &self.deck.ties {
            let Some([slave, master]) = self.pair("ties", [&tie.slave, &tie.master]) else { continue };
            fields.push(if fields.is_empty() { Integer(SET) } else { Blank });
            fields.extend([slave, master, tie.within.map_or(Blank, Real)]);
            fields.resize(fields.len().next_multiple_of(8), Blank);
        }
        if !fields.is_empty() {
            self.card("BGSET", &fields);
            self.note(
                Weight::Perhaps,
                "ties",
                "glue (BGSET) is of Simcenter Nastran: MSC Nastran has BCTABLE",
            );
        }
    }

    /// BCTSET, a line a contact.
    pub(super) fn contacts(&mut self) {
        let mut fields = Vec::new();
        for contact in &self.deck.contacts {
            let Some([slave, master]) = self.pair("contacts", [&contact.slave, &contact.master]) else {
                continue;
            };
            fields.push(if fields.is_empty() { Integer(SET) } else { Blank });
            fields.extend([slave, master, Real(contact.friction)]);
            fields.resize(fields.len().next_multiple_of(8), Blank);
            if contact.stiffness.is_some() || contact.stick.is_some() {
                let what = if contact.name.is_empty() {
                    "contacts".into()
                } else {
                    format!("contact.{}", contact.name)
                };
                let words = |k: Option<f64>, name: &str| k.map(|k| format!("{name} of {k:e} for an area"));
                let both = [
                    words(contact.stiffness, "a stiffness"),
                    words(contact.stick, "a stiffness of sticking"),
                ];
                let both: Vec<String> = both.into_iter().flatten().collect();
                self.out.lose(
                    &what,
                    &format!("{} is not written: give it in the other program", both.join(" and ")),
                );
            }
        }
        if !fields.is_empty() {
            self.card("BCTSET", &fields);
            self.note(Weight::Perhaps, "contacts", "BCTSET is of Simcenter Nastran: MSC Nastran has BCTABLE");
        }
    }

    pub(super) fn loads(&mut self) {
        let deck = self.deck;
        if !deck.loads.is_empty() {
            let why = "the loads are set 1, which no subcase chooses: modes have none";
            self.note(Weight::Nothing, "loads", why);
        }
        for load in &deck.loads {
            match &load.on {
                LoadOn::Nodes { nodes, force } => {
                    for node in nodes {
                        let [x, y, z] = force.map(Real);
                        self.card("FORCE", &[Integer(SET), self.node(*node), Blank, Real(1.0), x, y, z]);
                    }
                }
                LoadOn::Shells { shells, pressure } => {
                    for shell in shells {
                        let element = Integer(self.element_numbers[*shell]);
                        self.card("PLOAD2", &[Integer(SET), Real(*pressure), element]);
                    }
                }
                LoadOn::Faces { faces, pressure } => {
                    for (index, side) in faces {
                        self.pressure(*index, *side, *pressure);
                    }
                }
            }
        }
    }

    /// PLOAD4 on a side, which two corners name.
    fn pressure(&mut self, index: usize, side: usize, pressure: f64) {
        let element = &self.deck.elements[index];
        let kind = element.kind;
        let corners = || 0..kind.n_corners() as u8;
        let pairs = corners().flat_map(|first| {
            std::iter::once((first, None)).chain(corners().map(move |second| (first, Some(second))))
        });
        let mut named = pairs.filter(|(first, second)| kind.side_of_corners(*first, *second) == Some(side));
        let Some((first, second)) = named.next() else {
            self.note(Weight::Perhaps, "loads", "a pressure on sides that no corners name is not written");
            return;
        };
        let corner = |corner: u8| self.node(element.nodes[usize::from(corner)]);
        let mut fields = vec![Integer(SET), Integer(self.element_numbers[index]), Real(pressure)];
        fields.resize(6, Blank);
        fields.push(corner(first));
        fields.push(second.map_or(Blank, corner));
        self.card("PLOAD4", &fields);
    }
}
