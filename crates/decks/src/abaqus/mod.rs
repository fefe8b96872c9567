//! Input files of Abaqus and CalculiX.
//!
//! A keyword (`*NODE`) has options and lines of data ([`blocks`]). The table of [`keywords`] says which function reads it. Names and numbers
//! are looked up in a [`space`]: that of the model, or that of an instance of a part. Source of keywords, options and data: *Abaqus Keywords
//! Guide*; *CalculiX CrunchiX User's Manual*, *Input deck format*.

mod blocks;
mod collapsed;
mod constraints;
mod contacts;
mod couplings;
mod frames;
mod generate;
mod keywords;
mod loads;
mod lookup;
mod materials;
mod mesh;
mod names;
mod parts;
mod points;
mod reader;
mod sections;
mod sets;
mod space;
mod steps;
mod surfaces;
#[cfg(test)]
mod tests;
mod waiting;
mod write;

use crate::deck::{Deck, Place};
use crate::ledger::Weight;
use crate::text::Files;
use blocks::Blocks;
use keywords::{Keyword, Phase};
use names::Names;
use reader::{Found, Reader};
use space::Space;
use std::collections::HashMap;
use std::path::Path;
use stridor_base::error::Result;
pub(crate) use write::write;

/// Reads an input file and those that it includes.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn read(path: &Path, files: &mut Files) -> Result<Deck> {
    let blocks = Blocks::read(path, files)?;
    let mut reader = Reader {
        files: std::mem::take(files),
        deck: Deck::default(),
        spaces: vec![Space::default()],
        instances: Names::default(),
        points: Vec::new(),
        collapsed: HashMap::new(),
        outer: None,
        frames: Vec::new(),
        frame_of: HashMap::new(),
        orientations: Names::default(),
        materials: Names::default(),
        motions: Names::default(),
        interactions: Names::default(),
        interaction: None,
        pending: Vec::new(),
        step: None,
        steps_with_loads: 0,
        members_left: 0,
        generated: 0,
    };
    if blocks.blocks.is_empty() {
        reader.files.fault(
            Place::default(),
            "no keyword",
            "keywords that begin with an asterisk, such as *NODE",
        );
    }
    for place in &blocks.before {
        reader.deck.ledger.note(Weight::Nothing, "text", "lines before the first keyword", *place);
    }
    reader.deck.lost.clone_from(&blocks.lost);
    let own = reader.instances_of(&blocks);
    let needs_sets = own.iter().any(|(_, block)| generate::needs_sets(block));
    for phase in Phase::ALL {
        for (space, block) in &own {
            let found = Found { blocks: &blocks, block };
            if needs_sets {
                reader.set_so_far(phase, *space, found);
            }
            reader.read_in(phase, *space, found);
        }
        if phase == Phase::Sets {
            reader.settle_sets();
        }
    }
    reader.finish();
    *files = reader.files;
    Ok(reader.deck)
}

impl Reader {
    /// Reads a block where it is of this phase.
    fn read_in(&mut self, phase: Phase, space: usize, found: Found<'_>) {
        if self.files.too_many() {
            return;
        }
        match Keyword::named(&found.block.keyword) {
            Some(keyword) if keyword.phase == phase => {
                self.note_options(keyword, found);
                (keyword.read)(self, space, found);
            }
            None if phase == Phase::Rest => self.note_unread(found),
            _ => {}
        }
    }

    /// Notes the options that are not read.
    fn note_options(&mut self, keyword: &Keyword, found: Found<'_>) {
        for option in &found.block.options {
            let name = option.name.as_str();
            let off = option.value.eq_ignore_ascii_case("NO");
            if !off && !keyword.options.contains(&name) && !keyword.without_effect.contains(&name) {
                let (what, why) = keywords::unread_option(keyword.words, name);
                self.deck.ledger.note(Weight::Perhaps, what, why, found.place());
            }
        }
    }

    fn note_unread(&mut self, found: Found<'_>) {
        let (words, weight, why) = keywords::unread(&found.block.keyword);
        self.deck.ledger.note(weight, format!("*{words}"), why, found.place());
    }

    /// Moves what the spaces and the pending things have into the deck.
    fn finish(&mut self) {
        self.finish_contacts();
        if self.steps_with_loads > 1 {
            let why = "loads of several steps are read side by side";
            self.deck.ledger.note(Weight::Perhaps, "*STEP", why, Place::default());
        }
        self.finish_step();
        for space in std::mem::take(&mut self.spaces) {
            space.into_deck(&mut self.deck);
        }
    }
}
