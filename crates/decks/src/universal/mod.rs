//! Universal files of SDRC with a finite-element model (*Universal File Datasets Summary*).
//!
//! | dataset | read |
//! |---|---|
//! | 15, 781, 2411: nodes | yes |
//! | 780, 2412: elements | yes |
//! | 2417, 2429, 2430, 2432, 2435, 2452, 2467, 2477: groups | nodes and elements |
//! | 2420: coordinate systems of nodes | Cartesian and cylindrical |
//! | 164: units | stated in the ledger: numbers stay as they are |
//!
//! Any other is listed in the ledger by its number.

mod elements;
mod groups;
mod nodes;
#[cfg(test)]
mod tests;

use crate::deck::{Deck, Place, Section, SectionShape};
use crate::ledger::Weight;
use crate::text::Files;
use elements::Elements;
use nodes::Nodes;
use std::collections::BTreeMap;
use std::path::Path;
use stridor_base::error::{Error, Result};
use stridor_base::universal::{Dataset, datasets};

/// Reads a universal file.
///
/// # Errors
/// A file that cannot be read, or without any dataset.
pub(crate) fn read(path: &Path, files: &mut Files) -> Result<Deck> {
    let (file, text) = files.read(path)?;
    let name = path.display().to_string();
    let mut deck = Deck::default();
    let (mut nodes, mut elements) = (Nodes::default(), Elements::default());
    let mut lost = Vec::new();
    let all = datasets(&name, text.as_bytes(), &mut |error| lost.push(error))?;
    lost.into_iter().for_each(|error| note(files, error));
    // Elements and groups name nodes that may come later.
    let mut groups = Vec::new();
    for dataset in &all {
        let place = Place { file, line: dataset.first as u32 };
        let faults = &mut |error| note(files, error);
        match dataset.kind {
            15 | 781 | 2411 => nodes.read(dataset, file, faults),
            2420 => nodes.systems(dataset, faults),
            780 | 2412 => elements.read(dataset, file, faults),
            2417 | 2429 | 2430 | 2432 | 2435 | 2452 | 2467 | 2477 => groups.push(dataset),
            164 => units(dataset, place, &mut deck),
            kind => other(kind, place, &mut deck),
        }
    }
    nodes.finish(&mut deck, files);
    let properties = elements.finish(&mut deck, files);
    for dataset in groups {
        groups::read(dataset, file, &mut deck, &mut |error| note(files, error));
    }
    sections(properties, &mut deck);
    Ok(deck)
}

/// Keeps the faults of an error.
fn note(files: &mut Files, error: Error) {
    match error {
        Error::Input(faults) => faults.0.into_iter().for_each(|fault| files.keep(fault)),
        other => files.fault(Place::default(), other.to_string(), "a universal file"),
    }
}

/// Dataset 164 has a name of the units and factors to SI.
fn units(dataset: &Dataset<'_>, place: Place, deck: &mut Deck) {
    let name = dataset.lines.first().map_or("", |line| line.text.get(10..30).unwrap_or(&line.text).trim());
    let length = dataset.numbers(1, &[25]).ok().and_then(|factors| factors.first().copied());
    let factor = length.map_or(String::new(), |factor| format!(", {factor} of its length to the metre"));
    let why = format!("states the units `{name}`{factor}: numbers stay as they are");
    deck.ledger.note(Weight::Perhaps, "dataset 164", why, place);
}

/// What a dataset that is not read has.
fn other(kind: u32, place: Place, deck: &mut Deck) {
    let (weight, why) = match kind {
        151 => (Weight::Nothing, "a header"),
        55 | 56 | 57 | 58 | 2414 => {
            (Weight::Nothing, "results, or a test: `[measured]` of a case reads them")
        }
        82 | 2428 | 2437 | 2448 | 776 | 772 | 788 | 789 => {
            (Weight::Perhaps, "properties, beam sections, lines of a picture")
        }
        1710 | 1714 | 1716 | 773 | 774 => (Weight::Matters, "materials: give them in the case"),
        790 | 791 | 792 | 754 | 755 | 757 | 2416 => (Weight::Matters, "supports, loads and constraints"),
        18 => (Weight::Perhaps, "coordinate systems of a test"),
        _ => (Weight::Perhaps, "a dataset that is not read"),
    };
    deck.ledger.note(weight, format!("dataset {kind}"), why, place);
}

/// Sections by the numbers of their property and material.
fn sections(properties: BTreeMap<elements::Property, (Vec<usize>, Place)>, deck: &mut Deck) {
    let mut materials = std::collections::BTreeSet::new();
    for (property, (elements, place)) in properties {
        let name = format!("PROPERTY_{}_MATERIAL_{}", property.table, property.material);
        if property.dimension != 3 {
            let why = "thickness and area of shells and beams are in datasets that are not read: give them in the case";
            deck.ledger.note(Weight::Matters, &name, why, place);
        }
        let material = format!("MATERIAL_{}", property.material);
        materials.insert(material.clone());
        deck.sections.push(Section {
            name,
            elements,
            material,
            axes: None,
            shape: SectionShape::Unstated,
            place,
        });
    }
    deck.materials
        .extend(materials.into_iter().map(|name| crate::deck::Material { name, ..Default::default() }));
    if let Some(section) = deck.sections.first() {
        let (why, place) = ("their properties are not read: give them in the case", section.place);
        deck.ledger.note(Weight::Matters, "materials", why, place);
    }
}
