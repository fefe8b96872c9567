//! *BOUNDARY, *EQUATION, *TIE, *COUPLING, *CONTACT PAIR.

use super::{Writer, number, row};
use crate::deck::CouplingKind;
use crate::ledger::Weight;
use crate::written::{Held, HeldNode, held, one_line, rotates};

impl Writer<'_> {
    /// *BOUNDARY; *EQUATION where directions are held that are not those of the coordinates.
    pub(super) fn supports(&mut self) {
        let deck = self.deck;
        let Held { supports, more, sums } = held(deck);
        for (support, held) in deck.supports.iter().zip(&supports) {
            let alike = held.iter().all(|other| other.held == held[0].held);
            if !support.title.is_empty() {
                self.line(format!("** Name: {} Type: Displacement/Rotation", one_line(&support.title)));
            }
            self.line("*BOUNDARY");
            if let (true, Some(first)) = (alike, held.first()) {
                for words in self.words_for_nodes(support.name.as_deref(), &support.nodes) {
                    self.held(&words, first.held);
                }
            } else {
                for HeldNode { node, held, .. } in held {
                    self.held(&self.node_numbers[*node].to_string(), *held);
                }
            }
        }
        for (node, dof) in more {
            self.line("*BOUNDARY");
            self.line(format!("{}, {}, {}", self.node_numbers[node], dof + 1, dof + 1));
        }
        sums.iter().for_each(|sum| self.equation(sum));
    }

    /// Lines of first and last degree of freedom.
    fn held(&mut self, words: &str, held: [bool; 6]) {
        let mut dof = 0;
        while dof < 6 {
            let run = held[dof..].iter().take_while(|held| **held).count();
            if run > 0 {
                self.line(format!("{words}, {}, {}", dof + 1, dof + run));
            }
            dof += run.max(1);
        }
    }

    pub(super) fn equations(&mut self) {
        self.deck.equations.iter().for_each(|equation| self.equation(&equation.terms));
    }

    /// *EQUATION: how many terms, then four a line.
    fn equation(&mut self, terms: &[(usize, u8, f64)]) {
        self.line("*EQUATION");
        self.line(terms.len().to_string());
        for line in terms.chunks(4) {
            let term = |(node, dof, factor): &(usize, u8, f64)| {
                format!("{}, {}, {}", self.node_numbers[*node], dof + 1, number(*factor))
            };
            let words: Vec<String> = line.iter().map(term).collect();
            self.line(words.join(", "));
        }
    }

    /// The name of the k-th tie, coupling or contact: its own, or one of its kind.
    fn interaction(&mut self, own: &str, kind: &str, k: usize) -> String {
        let numbered = format!("{kind}_{}", k + 1);
        self.interactions.free(if own.is_empty() { &numbered } else { own })
    }

    /// *TIE. Gaps are kept.
    pub(super) fn ties(&mut self) {
        let deck = self.deck;
        for (k, tie) in deck.ties.iter().enumerate() {
            let name = self.interaction(&tie.name, "TIE", k);
            let within =
                tie.within.map_or(String::new(), |gap| format!(", POSITION TOLERANCE={}", number(gap)));
            self.line(format!("*TIE, NAME={name}{within}, ADJUST=NO"));
            let (slave, master) = (self.surfaces.of(&tie.slave), self.surfaces.of(&tie.master));
            self.line(format!("{slave}, {master}"));
        }
    }

    /// *COUPLING with *KINEMATIC or *DISTRIBUTING; a surface of nodes where there is none.
    pub(super) fn couplings(&mut self) {
        let deck = self.deck;
        let rotates = rotates(deck);
        for (k, coupling) in deck.couplings.iter().enumerate() {
            let name = self.interaction(&coupling.name, "COUPLING", k);
            let surface = coupling.of.as_ref().and_then(|of| deck.surface(of));
            let surface = match surface {
                Some(surface) => self.surfaces.of(&surface.name),
                None => {
                    let own = self.surfaces.free(&name);
                    self.line(format!("*SURFACE, NAME={own}, TYPE=NODE"));
                    let numbers = self.node_numbers_of(&coupling.nodes);
                    numbers.iter().for_each(|number| self.line(number.to_string()));
                    own
                }
            };
            let reference = self.node_numbers[coupling.reference];
            self.line(format!("*COUPLING, CONSTRAINT NAME={name}, REF NODE={reference}, SURFACE={surface}"));
            let turned = coupling.nodes.iter().any(|node| rotates[*node]);
            match coupling.kind {
                CouplingKind::Rigid => {
                    self.line("*KINEMATIC");
                    // Nodes of solids have no rotations.
                    self.line(if turned { "1, 6" } else { "1, 3" });
                    if turned {
                        let why = "CalculiX' *KINEMATIC takes displacements alone: of shells and beams Abaqus reads it";
                        self.note(Weight::Matters, "rigid bodies", why);
                    }
                }
                CouplingKind::Averaging => {
                    self.line("*DISTRIBUTING");
                    self.line("1, 6");
                    let why = "CalculiX' *DISTRIBUTING passes on forces alone: masses and springs of its point do not count there";
                    self.note(Weight::Perhaps, "averages", why);
                }
            }
        }
    }

    /// *SURFACE INTERACTION, *SURFACE BEHAVIOR, *FRICTION, *CONTACT PAIR.
    pub(super) fn contacts(&mut self) {
        let deck = self.deck;
        for (k, contact) in deck.contacts.iter().enumerate() {
            let name = self.interaction(&contact.name, "CONTACT", k);
            self.line(format!("*SURFACE INTERACTION, NAME={name}"));
            match contact.stiffness {
                Some(stiffness) => {
                    self.line("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR");
                    self.line(number(stiffness));
                }
                None => self.line("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"),
            }
            if contact.friction != 0.0 {
                self.line("*FRICTION");
                match contact.stick {
                    // The second number is CalculiX' stick slope; of Abaqus a slip rate, which one line alone does not depend on.
                    Some(stick) => self.line(row(&[contact.friction, stick])),
                    None => self.line(number(contact.friction)),
                }
            }
            let closed = if contact.closed { ", ADJUST=0.0" } else { "" };
            if !contact.name.is_empty() {
                self.line(format!("** Interaction: {}", one_line(&contact.name)));
            }
            self.line(format!("*CONTACT PAIR, INTERACTION={name}, TYPE=SURFACE TO SURFACE{closed}"));
            let (slave, master) = (self.surfaces.of(&contact.slave), self.surfaces.of(&contact.master));
            self.line(format!("{slave}, {master}"));
            if contact.friction != 0.0 && contact.stick.is_none() {
                let why = "CalculiX wants a stick slope beside μ: none is known";
                self.note(Weight::Perhaps, "contacts", why);
            }
        }
    }
}
