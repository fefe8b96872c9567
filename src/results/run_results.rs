//! Everything that a run produced.

use super::provenance::Provenance;
use super::record::InputFile;
use super::records::{AnalysisRecord, Records};
use crate::mesh::{Cell, outer_faces};

/// Everything a run produced, as plain data for the writers and the report.
#[derive(Debug, Default)]
pub struct RunResults {
    /// The case's title.
    pub title: String,
    /// The resolved case as TOML, every default written out.
    pub resolved_case: String,
    /// Assumptions of the case: what the source does not state, in the user's words.
    pub assumptions: Vec<String>,
    /// Things the user should know (a plate too thick for its theory, a guessed value that decides), one sentence each.
    pub warnings: Vec<String>,
    /// Nodes and elements for pictures and ParaView.
    pub geometry: Geometry,
    /// Degrees of freedom and nonzeros of K.
    pub size: ModelSize,
    /// Results of the analyses.
    pub records: Records,
    /// Wall time of each phase \[s\].
    pub timings: Vec<(String, f64)>,
    /// The files that the case reads.
    pub inputs: Vec<InputFile>,
    /// Where the results come from; `None` of a run that was not written into a folder.
    pub provenance: Option<Provenance>,
    /// Why the run has ended before its end, if it has: an analysis without an answer.
    pub failed: Option<String>,
}

impl RunResults {
    /// The first record of type `T`: `results.get::<ComplexResult>()`.
    pub fn get<T: AnalysisRecord>(&self) -> Option<&T> {
        self.records.get()
    }

    /// The same, to be changed.
    pub fn get_mut<T: AnalysisRecord>(&mut self) -> Option<&mut T> {
        self.records.get_mut()
    }

    /// The first record of type `T`, taken out.
    pub fn take<T: AnalysisRecord>(&mut self) -> Option<T> {
        self.records.take()
    }

    /// The records of type `T`, in the order in which they were found.
    pub fn all<T: AnalysisRecord>(&self) -> Vec<&T> {
        self.records.all()
    }
}

/// The size of a model.
#[derive(Debug, Clone, Copy, Default)]
pub struct ModelSize {
    /// Nodes of the mesh in use.
    pub nodes: usize,
    /// Elements in use.
    pub elements: usize,
    /// Free degrees of freedom.
    pub dofs: usize,
    /// Stored entries of K, both triangles.
    pub nonzeros: usize,
    /// Contact points that may touch.
    pub contact_points: usize,
}

/// Nodes and elements as analysed (after the disc was tilted and set on the slider).
#[derive(Debug, Clone, Default)]
pub struct Geometry {
    /// Coordinates \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Cells of every part.
    pub cells: Vec<Cell>,
    /// The part each cell belongs to, an index into `parts`.
    pub part_of_cell: Vec<usize>,
    /// What pictures show, points, lines, triangles and quadrilaterals by their nodes: the cells themselves, of solids their skin, faces of
    /// second order in pieces.
    pub elements: Vec<Vec<usize>>,
    /// The part each of these belongs to.
    pub part_of: Vec<usize>,
    /// The parts' names.
    pub parts: Vec<String>,
}

impl Geometry {
    /// That of parts, each with its name and its cells on `nodes`.
    pub fn new(nodes: Vec<[f64; 3]>, parts: Vec<(String, Vec<Cell>)>) -> Self {
        let mut geometry = Geometry { nodes, ..Geometry::default() };
        for (part, (name, cells)) in parts.into_iter().enumerate() {
            let drawn: Vec<Vec<usize>> = drawn(&cells);
            geometry.part_of.extend(vec![part; drawn.len()]);
            geometry.elements.extend(drawn);
            geometry.part_of_cell.extend(vec![part; cells.len()]);
            geometry.cells.extend(cells);
            geometry.parts.push(name);
        }
        geometry
    }

    /// Whether a part is made of solids.
    pub fn is_solid(&self, part: usize) -> bool {
        let own = self.part_of_cell.iter().position(|own| *own == part);
        own.is_some_and(|first| self.cells[first].dimension() == 3)
    }
}

/// What pictures show of cells.
fn drawn(cells: &[Cell]) -> Vec<Vec<usize>> {
    let (solids, others): (Vec<&Cell>, Vec<&Cell>) = cells.iter().partition(|cell| cell.dimension() == 3);
    let skin = outer_faces(solids.into_iter());
    others.into_iter().chain(&skin).flat_map(Cell::pieces).collect()
}

/// A displacement of every node: (ux, uy, uz, rx, ry, rz) \[m, rad\] in the order of [`Geometry::nodes`].
pub type NodalField<T> = Vec<[T; 6]>;
