//! A mesh, a commented case and a page of what was read, of a model of another program.

mod analyses;
mod constraints;
mod contacts;
mod converter;
mod equations;
mod page;
mod parts;
mod regions;
mod text;
mod units;

use crate::deck::{Deck, Place};
use crate::ledger::{Ledger, Weight};
use converter::{Converter, TableNames};
use regions::Regions;
use std::collections::HashMap;
use stridor_base::error::{Fault, Faults, Result};
use stridor_mesh::Mesh;
use text::{CaseText, quoted};
pub use units::Units;

/// What is made of a deck.
#[derive(Debug, Clone)]
pub struct Converted {
    /// The mesh with its regions \[m\].
    pub mesh: Mesh,
    /// The text of the case, which reads the mesh from [`Converted::MESH_FILE`].
    pub case: String,
    /// The equations between degrees of freedom, a table that the case reads from [`Converted::EQUATIONS_FILE`].
    pub equations: Option<String>,
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
    /// The name of the file with the equations, beside the case.
    pub const EQUATIONS_FILE: &'static str = "equations.csv";
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
        held: Vec::new(),
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
        let unread = deck.ledger.rows().find(|row| row.weight == Weight::Matters);
        let help = unread.map_or(String::new(), |row| format!("Not read: {}: {}", row.what, row.why));
        let fault = Fault::new(place, found, "solids, shells or beams with a section and a material");
        converter.faults.push(fault.with_help(help));
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
    let equations = converter.equations();
    converter.analyses();
    let lost = converter.lost();
    let (page, mass) = converter.page();
    let Converter { regions, case, warnings, ledger, .. } = converter;
    let title = if deck.title.is_empty() { "An imported model".to_string() } else { deck.title.clone() };
    let head = format!(
        "title = {}\n\n# Imported with the units {}. What was read, and what was not: import.md\n{lost}\n[mesh]\nfile = {}\nunit = \"m\"\n",
        quoted(&title),
        units.words,
        quoted(Converted::MESH_FILE)
    );
    Ok(Converted { mesh: regions.mesh, case: head + &case.finish(), equations, page, warnings, mass, ledger })
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

    /// Comments on what the file says that it does not have of its model, but what stands with a contact.
    fn lost(&mut self) -> String {
        let mut text = String::new();
        for (what, why) in &self.deck.lost {
            self.ledger.note(
                Weight::Matters,
                what,
                format!("the file says that it was lost: {why}"),
                Place::default(),
            );
            if !self.deck.contacts.iter().any(|contact| contacts::is_of(what, contact)) {
                text += &format!("# Lost before it came here: {what}: {why}.\n");
            }
        }
        text
    }
}

#[cfg(test)]
mod tests;
