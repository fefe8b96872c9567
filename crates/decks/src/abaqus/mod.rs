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
mod keywords;
mod loads;
mod materials;
mod mesh;
mod names;
mod parts;
mod points;
mod sections;
mod sets;
mod space;
mod steps;
mod surfaces;
#[cfg(test)]
mod tests;

use crate::deck::{Deck, Frame, Place};
use crate::ledger::Weight;
use crate::text::Files;
use blocks::{Block, Blocks};
use keywords::{Keyword, Phase};
use names::Names;
use space::Space;
use std::collections::HashMap;
use std::path::Path;
use stridor_base::error::Result;
use stridor_base::numbers::parse;

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
    let own = reader.instances_of(&blocks);
    for phase in Phase::ALL {
        for (space, block) in &own {
            reader.read_in(phase, *space, Found { blocks: &blocks, block });
        }
        if phase == Phase::Sets {
            reader.settle_sets();
        }
    }
    reader.finish();
    *files = reader.files;
    Ok(reader.deck)
}

/// A block with the file that its lines are in.
#[derive(Debug, Clone, Copy)]
struct Found<'a> {
    blocks: &'a Blocks,
    pub block: &'a Block,
}

/// A line of data as its cells.
#[derive(Debug, Clone)]
struct Row<'a> {
    pub place: Place,
    pub cells: Vec<&'a str>,
}

impl<'a> Found<'a> {
    /// The lines of data.
    pub fn lines(self) -> impl Iterator<Item = (Place, &'a str)> + Clone {
        self.blocks.lines(self.block)
    }

    /// The lines of data, each cut at its commas.
    pub fn rows(self) -> impl Iterator<Item = Row<'a>> + Clone {
        self.lines().map(|(place, line)| Row { place, cells: blocks::split(line).collect() })
    }

    /// The value of an option; none where it is empty.
    pub fn option(self, name: &str) -> Option<&'a str> {
        self.block.option(name).filter(|value| !value.is_empty())
    }

    /// The place of the keyword.
    pub fn place(self) -> Place {
        self.block.place
    }
}

impl<'a> Row<'a> {
    /// A cell; empty where there is none.
    pub fn cell(&self, at: usize) -> &'a str {
        self.cells.get(at).copied().unwrap_or("")
    }
}

/// What is read, and what names and numbers mean so far.
struct Reader {
    files: Files,
    deck: Deck,
    /// That of the model first, then those of the instances.
    spaces: Vec<Space>,
    /// Instances by name, as indices of `spaces`.
    instances: Names<usize>,
    /// Elements without a shape: masses, springs, dashpots.
    points: Vec<points::PointElement>,
    /// Corners of the bricks and quadrilaterals that were read as a kind with fewer, by their elements.
    collapsed: HashMap<usize, Vec<usize>>,
    /// Faces that one solid alone has, once they were asked for.
    outer: Option<Vec<(usize, usize)>>,
    /// Frames of nodes that are not global.
    frames: Vec<Frame>,
    /// Nodes with a frame, as an index of `frames`.
    frame_of: HashMap<usize, usize>,
    orientations: Names<sections::Orientation>,
    /// Materials and rotating sets by name, as indices of the deck's.
    materials: Names<usize>,
    motions: Names<usize>,
    interactions: Names<contacts::Interaction>,
    /// The one that *FRICTION and *SURFACE BEHAVIOR are of.
    interaction: Option<String>,
    /// What waits for laws that may stand below it.
    pending: Vec<contacts::PendingContact>,
    /// What the step that is read has asked for so far.
    step: Option<steps::Step>,
    /// How many steps have loads.
    steps_with_loads: usize,
    /// How many members of sets may still be named: sets of sets, and sets that are named again and again, grow beyond the file.
    members_left: usize,
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
            if !keyword.options.contains(&name) && !keyword.without_effect.contains(&name) {
                let what = format!("*{}, {name}", keyword.words);
                self.deck.ledger.note(Weight::Perhaps, what, "an option that is not read", found.place());
            }
        }
    }

    fn note_unread(&mut self, found: Found<'_>) {
        let (words, weight, why) = keywords::unread(&found.block.keyword);
        self.deck.ledger.note(weight, format!("*{words}"), why, found.place());
    }

    /// A number; a fault where it is none. An empty cell is zero.
    fn number(&mut self, row: &Row<'_>, at: usize) -> Option<f64> {
        let cell = row.cell(at);
        if cell.is_empty() {
            return Some(0.0);
        }
        let value = parse(cell).filter(|value| value.is_finite());
        if value.is_none() {
            self.files.fault(row.place, format!("`{}`", blocks::short(cell)), "a finite number");
        }
        value
    }

    /// N numbers from a cell on.
    fn numbers<const N: usize>(&mut self, row: &Row<'_>, from: usize) -> Option<[f64; N]> {
        let mut values = [0.0; N];
        for (k, value) in values.iter_mut().enumerate() {
            *value = self.number(row, from + k)?;
        }
        Some(values)
    }

    /// A number of a node or an element; a fault where it is none.
    fn label(&mut self, place: Place, cell: &str) -> Option<u64> {
        // `5.` is what some programs write.
        let label = cell.trim_end_matches('.').parse().ok().filter(|label| *label > 0);
        if label.is_none() {
            self.files.fault(
                place,
                format!("`{}`", blocks::short(cell)),
                "a number of a node or an element, from 1",
            );
        }
        label
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
