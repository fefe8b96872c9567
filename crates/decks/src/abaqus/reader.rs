//! What is read so far, and the lines that it is read from.

use super::blocks::{self, Block, Blocks};
use super::names::Names;
use super::space::Space;
use super::waiting::{Interaction, Orientation, PendingContact, PointElement, Step};
use crate::deck::{Deck, Frame, Place};
use crate::text::Files;
use std::collections::HashMap;
use stridor_base::numbers::parse;

/// A block with the file that its lines are in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found<'a> {
    pub blocks: &'a Blocks,
    pub block: &'a Block,
}

/// A line of data as its cells.
#[derive(Debug, Clone)]
pub(super) struct Row<'a> {
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
pub(super) struct Reader {
    pub files: Files,
    pub deck: Deck,
    /// That of the model first, then those of the instances.
    pub spaces: Vec<Space>,
    /// Instances by name, as indices of `spaces`.
    pub instances: Names<usize>,
    /// Elements without a shape: masses, springs, dashpots.
    pub points: Vec<PointElement>,
    /// Corners of the bricks and quadrilaterals that were read as a kind with fewer, by their elements.
    pub collapsed: HashMap<usize, Vec<usize>>,
    /// Faces that one solid alone has, once they were asked for.
    pub outer: Option<Vec<(usize, usize)>>,
    /// Frames of nodes that are not global.
    pub frames: Vec<Frame>,
    /// Nodes with a frame, as an index of `frames`.
    pub frame_of: HashMap<usize, usize>,
    pub orientations: Names<Orientation>,
    /// Materials and rotating sets by name, as indices of the deck's.
    pub materials: Names<usize>,
    pub motions: Names<usize>,
    pub interactions: Names<Interaction>,
    /// The one that *FRICTION and *SURFACE BEHAVIOR are of.
    pub interaction: Option<String>,
    /// What waits for laws that may stand below it.
    pub pending: Vec<PendingContact>,
    /// What the step that is read has asked for so far.
    pub step: Option<Step>,
    /// How many steps have loads.
    pub steps_with_loads: usize,
    /// How many members of sets may still be named: sets of sets, and sets that are named again and again, grow beyond the file.
    pub members_left: usize,
    /// How many nodes and elements were generated.
    pub generated: usize,
}

impl Reader {
    /// A number; a fault where it is none. An empty cell is zero.
    pub fn number(&mut self, row: &Row<'_>, at: usize) -> Option<f64> {
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
    pub fn numbers<const N: usize>(&mut self, row: &Row<'_>, from: usize) -> Option<[f64; N]> {
        let mut values = [0.0; N];
        for (k, value) in values.iter_mut().enumerate() {
            *value = self.number(row, from + k)?;
        }
        Some(values)
    }

    /// A number of a node or an element; a fault where it is none.
    pub fn label(&mut self, place: Place, cell: &str) -> Option<u64> {
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
}
