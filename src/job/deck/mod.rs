//! A case as a model of another program: nodes, elements, sections, sets and surfaces, what joins and holds them, contacts, loads.
//!
//! Numbers are in SI. What a deck cannot hold is in its ledger.

mod contacts;
mod joints;
mod parts;
mod regions;
mod sides;

use super::prepared::Prepared;
use crate::case::Case;
use crate::decks::{Analysis, Deck, Place, Weight};
use crate::error::{Error, Fault, Result};
use crate::linalg::sparse::add_scaled;
use crate::mesh::CellKind;
use crate::structure::Model;
use sides::Sides;
use std::collections::HashSet;
use std::f64::consts::TAU;

/// Modes of a case that asks for none.
const MODES: usize = 10;

/// A deck that is being made of a case.
struct Maker<'p> {
    prepared: &'p Prepared<'p>,
    case: &'p Case,
    model: &'p Model,
    deck: Deck,
    sides: Sides,
}

/// The deck of a case.
///
/// # Errors
/// A case without elements, as one of matrices or of masses and springs alone is; regions that are missing.
pub fn deck(prepared: &Prepared) -> Result<Deck> {
    let case = prepared.case;
    if prepared.model.parts.is_empty() {
        let (key, found) =
            if case.matrices.is_some() { ("`matrices`", "M, C and K") } else { ("`mesh`", "no parts") };
        let fault = Fault::new(key, found, "a mesh with parts: a model of another program has elements");
        return Err(Error::input(
            fault.with_help("Export it as matrices: `--out` with the name of a folder"),
        ));
    }
    let deck = Deck { title: case.title.clone(), ..Deck::default() };
    let mut maker = Maker { prepared, case, model: &prepared.model, deck, sides: Sides::default() };
    maker.parts();
    maker.sides = Sides::new(&maker.deck);
    maker.regions();
    maker.masses()?;
    maker.springs();
    maker.links()?;
    maker.ties()?;
    maker.supports()?;
    maker.forces()?;
    maker.contacts()?;
    maker.rotations()?;
    maker.analyses()?;
    Ok(maker.deck)
}

impl Maker<'_> {
    fn note(&mut self, weight: Weight, what: impl Into<String>, why: impl Into<String>) {
        self.deck.ledger.note(weight, what, why, Place::default());
    }

    /// The nodes that shells or bars turn.
    fn turned(&self) -> HashSet<usize> {
        let turning = self.model.parts.iter().filter(|part| part.kind.dimension() < 3);
        turning.flat_map(|part| part.nodes()).collect()
    }

    /// The number of modes of the structure below a frequency \[Hz\], at most as many as another program can find.
    fn modes_below(&self, hz: f64) -> Result<usize> {
        let structure = &self.prepared.system.structure;
        let pencil = add_scaled(&[(1.0, &structure.stiffness), (-(TAU * hz).powi(2), &structure.mass)]);
        let below = structure.engine.analyse(pencil.symbolic())?.inertia(&pencil)?.negative;
        Ok(below.clamp(1, self.most_modes()))
    }

    /// ARPACK, by which CalculiX finds modes, does not find all of a matrix.
    fn most_modes(&self) -> usize {
        (self.prepared.system.n_dofs() - 1).max(1)
    }

    /// Complex modes, else the first modes of the whole: the band, and how many modes it has without the contacts, which make them fewer.
    fn analyses(&mut self) -> Result<()> {
        let case = self.case;
        if let Some(cea) = &case.cea {
            let count = Some(self.modes_below(cea.band[1])?);
            self.deck.analyses.push(Analysis::ComplexModes { count, band: cea.band.map(Some) });
        }
        for (name, modes) in &case.modes {
            if !modes.parts.is_empty() || !modes.clamp.is_empty() || modes.free {
                let why = "modes of parts, or with other supports, are another model";
                self.note(Weight::Nothing, format!("modes.{name}"), why);
            } else if self.deck.analyses.is_empty() {
                let count = match (modes.count, modes.below) {
                    (None, Some(hz)) => self.modes_below(hz)?,
                    (count, _) => count.unwrap_or(MODES).min(self.most_modes()),
                };
                self.deck.analyses.push(Analysis::Modes { count: Some(count), band: [None, modes.below] });
            }
        }
        if self.deck.analyses.is_empty() {
            let count = Some(MODES.min(self.most_modes()));
            self.deck.analyses.push(Analysis::Modes { count, band: [None; 2] });
        }
        if case.damping.modal_ratio != 0.0 || !case.damping.modal_ratios.is_empty() {
            self.note(Weight::Perhaps, "damping", "damping of modes is not written");
        }
        if case.prestress {
            let why = "the stiffness of the preload needs NLGEOM in the step of the loads";
            self.note(Weight::Perhaps, "prestress", why);
        }
        Ok(())
    }
}

/// The element of Abaqus and CalculiX that is the same as that of a part on cells of a kind, where it is not the usual one.
fn type_name(kind: CellKind, reduced: bool) -> &'static str {
    match kind {
        CellKind::Hexahedron20 if reduced => "C3D20R",
        // Euler–Bernoulli, of cubic shape.
        CellKind::Line2 => "B33",
        _ => "",
    }
}
