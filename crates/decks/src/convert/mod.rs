//! A mesh, a commented case and a page of what was read, of a model of another program.

mod constraints;
mod contacts;
mod converter;
mod page;
mod parts;
mod regions;
mod text;
mod units;

use crate::deck::{Analysis, Deck, Place};
use crate::ledger::{Ledger, Weight};
use converter::{Converter, TableNames};
use regions::Regions;
use std::collections::HashMap;
use stridor_base::error::{Fault, Faults, Result};
use stridor_mesh::Mesh;
use text::{CaseText, number, quantity, quoted};
pub use units::Units;

/// What is made of a deck.
#[derive(Debug, Clone)]
pub struct Converted {
    /// The mesh with its regions \[m\].
    pub mesh: Mesh,
    /// The text of the case, which reads the mesh from [`Converted::MESH_FILE`].
    pub case: String,
    /// What was read, in Markdown.
    pub page: String,
    /// Sentences that the user should see.
    pub warnings: Vec<String>,
    /// Mass of all parts and concentrated masses \[kg\].
    pub mass: f64,
    /// What was not read, or in part.
    pub ledger: Ledger,
}

impl Converted {
    /// The name of the file with the mesh, beside the case.
    pub const MESH_FILE: &'static str = "mesh.msh";
}

/// Makes a mesh and a case of a deck whose numbers are in a system of units.
///
/// # Errors
/// A deck without elements or sections; a section of a material that is not there.
pub fn convert(deck: &Deck, units: Units) -> Result<Converted> {
    let mut converter = Converter {
        deck,
        units,
        regions: Regions::new(deck, units.length),
        case: CaseText::default(),
        ledger: deck.ledger.clone(),
        parts: Vec::new(),
        names: TableNames::default(),
        uses: Vec::new(),
        axes_of_materials: HashMap::new(),
        warnings: Vec::new(),
        faults: Faults::new(),
    };
    converter.materials();
    converter.parts();
    if converter.parts.is_empty() && converter.faults.0.is_empty() {
        let place = deck.files.first().map(|file| file.display().to_string()).unwrap_or_default();
        let found = format!(
            "{} nodes and {} elements, none of which has a section that is read",
            deck.nodes.len(),
            deck.elements.len()
        );
        converter.faults.push(Fault::new(
            place,
            found,
            "solids, shells or beams with a section and a material",
        ));
    }
    std::mem::take(&mut converter.faults).into_result(())?;
    converter.find_uses();
    converter.sets();
    converter.supports();
    converter.joints();
    converter.point_masses();
    converter.springs();
    converter.loads();
    converter.contacts();
    converter.equations();
    converter.analyses();
    let (page, mass) = converter.page();
    let Converter { regions, case, warnings, ledger, .. } = converter;
    let title = if deck.title.is_empty() { "An imported model".to_string() } else { deck.title.clone() };
    let head = format!(
        "title = {}\n\n# Imported with the units {}. What was read, and what was not: import.md\n\n[mesh]\nfile = {}\nunit = \"m\"\n",
        quoted(&title),
        units.words,
        quoted(Converted::MESH_FILE)
    );
    Ok(Converted { mesh: regions.mesh, case: head + &case.finish(), page, warnings, mass, ledger })
}

impl Converter<'_> {
    /// Named sets and surfaces as regions; sets that the writer made for itself only where something needs them.
    fn sets(&mut self) {
        let deck = self.deck;
        let parts: Vec<String> = self.parts.iter().map(|part| part.name.clone()).collect();
        for surface in deck.surfaces.iter().filter(|surface| !surface.internal) {
            self.regions.surface(&surface.name, &mut self.ledger);
        }
        for set in deck.node_sets.iter().filter(|set| !set.internal) {
            self.regions.points(&set.name, &set.members);
        }
        for set in deck.element_sets.iter().filter(|set| !set.internal && !parts.contains(&set.name)) {
            let members: Vec<usize> =
                set.members.iter().copied().filter(|element| self.regions.has(*element)).collect();
            if self.pieces(&members).len() > 1 {
                let why = "a set of pieces that touch is no region; its parts are";
                self.ledger.note(
                    Weight::Nothing,
                    format!("set of elements {}", set.name),
                    why,
                    Place::default(),
                );
            } else {
                self.regions.elements(&set.name, &members);
            }
        }
    }

    /// The analyses that were meant; modes where there is none.
    fn analyses(&mut self) {
        let per_time = 1.0 / self.units.time;
        let mut asked = [false; 2];
        for analysis in &self.deck.analyses {
            match analysis {
                Analysis::Modes { count, band } if !asked[0] => {
                    asked[0] = true;
                    self.case.table("modes", "imported");
                    match (count, band[1]) {
                        (Some(count), _) => self.case.key("count", count.to_string()),
                        (None, Some(top)) => self.case.key("below", quantity(top * per_time, 1.0, "Hz")),
                        (None, None) => self.case.key("count", "10"),
                    };
                }
                Analysis::ComplexModes { band, .. } if !asked[1] => {
                    asked[1] = true;
                    self.complex(*band);
                }
                _ => {}
            }
        }
        if !asked[1] && !self.deck.contacts.is_empty() {
            self.complex([None; 2]);
        } else if asked == [false; 2] {
            self.case.table("modes", "imported").key("count", "10");
        }
    }

    fn complex(&mut self, band: [Option<f64>; 2]) {
        if self.deck.contacts.is_empty() && self.deck.motions.is_empty() {
            let why = "complex modes need a contact or a rotation";
            self.ledger.note(Weight::Matters, "complex modes", why, Place::default());
            return;
        }
        let per_time = 1.0 / self.units.time;
        let low = band[0].map_or(0.0, |f| f * per_time);
        let top = band[1].map_or(10_000.0, |f| f * per_time);
        self.case.only("cea");
        if band[1].is_none() {
            self.case.comment("The file names no highest frequency.");
        }
        self.case.key("band", format!("[{}, {}]", number(low), number(top)));
    }

    fn equations(&mut self) {
        for equation in &self.deck.equations {
            let why = "linear equations between degrees of freedom are not in the case";
            self.ledger.note(Weight::Matters, "equations", why, equation.place);
        }
    }
}
