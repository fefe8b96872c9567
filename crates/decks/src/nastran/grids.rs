//! Grid points: GRID, GRDSET; scalar points, which have no place, are noted.

use super::fields::Fields;
use super::list::{self, Ids};
use super::notes::Notes;
use super::table::Table;
use crate::ledger::Weight;

/// A grid point as its card has it; what is blank is as GRDSET has it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    pub coordinates: [f64; 3],
    system: Option<u32>,
    /// The system of its displacements.
    pub displacements: Option<u32>,
    /// Degrees of freedom that are held always.
    held: Option<[bool; 6]>,
}

#[derive(Debug, Default)]
pub(super) struct Grids {
    pub table: Table<Grid>,
    pub standard: (u32, u32, [bool; 6]),
    scalar: Vec<Ids>,
    /// The numbers of scalar points as ranges, ascending and apart.
    scalars: Vec<(u64, u64)>,
}

impl Grids {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        match fields.name() {
            "GRID" => self.grid(fields),
            "GRDSET" => {
                let (system, displacements) = (system(fields, 2)?, displacements(fields)?);
                let held = if fields.is_blank(7) { [false; 6] } else { fields.components(7)? };
                self.standard = (system.unwrap_or(0), displacements.unwrap_or(0), held);
                fields.unread(
                    8,
                    8,
                    Weight::Matters,
                    "superelements are not read: the points are of the model itself",
                );
                Some(())
            }
            _ => {
                let last = fields.last();
                self.scalar.extend(list::read(fields, 1, last));
                fields.note(Weight::Matters, "scalar points, and what acts on them, are not read");
                Some(())
            }
        }
    }

    /// The points of an element between scalar points are such points.
    pub fn scalar_element(&mut self, fields: &mut Fields) {
        let words = fields.words(3, 4);
        self.scalar.extend(words.iter().filter_map(|(_, text)| text.parse().ok()).map(Ids::One));
    }

    fn grid(&mut self, fields: &mut Fields) -> Option<()> {
        let number = fields.id(1)?;
        let system_of = system(fields, 2)?;
        let coordinates = fields.vector(3)?;
        let displacements = displacements(fields)?;
        let held = if fields.is_blank(7) { None } else { Some(fields.components(7)?) };
        fields.unread(8, 8, Weight::Matters, "superelements are not read: the point is of the model itself");
        self.table.push(number, fields.place(), Grid { coordinates, system: system_of, displacements, held });
        Some(())
    }

    pub fn sort(&mut self, notes: &mut Notes) {
        self.table.sort("GRID", notes);
        let mut ranges: Vec<(u64, u64)> = self.scalar.iter().map(Ids::bounds).collect();
        ranges.sort_unstable();
        for (first, last) in ranges {
            match self.scalars.last_mut() {
                Some((_, end)) if first <= *end => *end = last.max(*end),
                _ => self.scalars.push((first, last.max(first))),
            }
        }
    }

    /// Whether a scalar point has this number.
    pub fn is_scalar(&self, id: u64) -> bool {
        let at = self.scalars.partition_point(|(first, _)| *first <= id);
        at > 0 && id <= self.scalars[at - 1].1
    }

    pub fn system_number(&self, grid: &Grid) -> u64 {
        u64::from(grid.system.unwrap_or(self.standard.0))
    }

    /// The number of the system that a point is given in.
    pub fn system_of(&self, id: u64) -> Option<u64> {
        Some(self.system_number(&self.table.get(id)?.value))
    }

    /// What is always held of a node.
    pub fn held(&self, node: usize) -> [bool; 6] {
        self.table.rows().get(node).and_then(|row| row.value.held).unwrap_or(self.standard.2)
    }
}

/// The system of displacements; −1 is of a point of a fluid.
fn displacements(fields: &mut Fields) -> Option<Option<u32>> {
    if fields.word(6) == "-1" {
        fields.note(Weight::Matters, "a point of a fluid is read as one of the structure");
        return Some(Some(0));
    }
    system(fields, 6)
}

/// The number of a system, or none where the field is blank.
fn system(fields: &mut Fields, number: usize) -> Option<Option<u32>> {
    if fields.is_blank(number) {
        return Some(None);
    }
    let id = fields.id_or(number, 0)?;
    let id = u32::try_from(id).ok();
    if id.is_none() {
        fields.fault(number, "a number of a coordinate system above 4 294 967 295", "a smaller one");
    }
    Some(Some(id?))
}
