//! Coordinate systems: CORD1R, CORD1C, CORD1S by three grid points, CORD2R, CORD2C, CORD2S by three places.
//!
//! A is the origin, B is on the third axis, C in the plane of the first and the third. Coordinates are x, y, z; r, θ, z; or r, θ from the
//! third axis, φ about it; angles in degrees.

use super::fields::Fields;
use super::grids::{Grid, Grids};
use super::notes::Notes;
use super::table::{Row, Table};
use crate::deck::{Frame, Node, Place};
use stridor_mesh::quality::{cross, dot, minus};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FrameKind {
    Rectangular,
    Cylindrical,
    Spherical,
}

/// A system as its card has it.
#[derive(Debug, Clone, PartialEq)]
struct Raw {
    kind: FrameKind,
    points: Points,
}

#[derive(Debug, Clone, PartialEq)]
enum Points {
    Grids([u64; 3]),
    /// Coordinates of A, B and C in another system.
    Places(u64, [[f64; 3]; 3]),
}

#[derive(Debug, Default)]
pub(super) struct RawFrames {
    table: Table<Raw>,
}

/// A system in Cartesian coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axes {
    kind: FrameKind,
    origin: [f64; 3],
    unit: [[f64; 3]; 3],
}

/// That of the coordinates, number 0.
pub(super) const BASIC: Axes = Axes {
    kind: FrameKind::Rectangular,
    origin: [0.0; 3],
    unit: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
};

/// All of them by number; none where it has a fault.
#[derive(Debug, Default)]
pub(super) struct Frames {
    table: Table<Raw>,
    axes: Vec<Option<Axes>>,
}

impl Axes {
    /// The place of coordinates.
    pub fn place(&self, [a, b, c]: [f64; 3]) -> [f64; 3] {
        let (b_rad, c_rad) = (b.to_radians(), c.to_radians());
        let local = match self.kind {
            FrameKind::Rectangular => [a, b, c],
            FrameKind::Cylindrical => [a * b_rad.cos(), a * b_rad.sin(), c],
            FrameKind::Spherical => {
                [a * b_rad.sin() * c_rad.cos(), a * b_rad.sin() * c_rad.sin(), a * b_rad.cos()]
            }
        };
        let turned = self.turn(self.unit, local);
        std::array::from_fn(|i| self.origin[i] + turned[i])
    }

    fn turn(&self, unit: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|k| v[k] * unit[k][i]).sum())
    }

    /// Whether a place is on its third axis, where the directions of cylinders and spheres are those of the system itself.
    fn is_on_axis(&self, at: [f64; 3]) -> bool {
        let [x, y, z] = self.unit.map(|unit| dot(unit, minus(at, self.origin)));
        x.hypot(y) <= 1e-9 * x.hypot(y).hypot(z)
    }

    /// Its directions at a place.
    pub fn directions(&self, at: [f64; 3]) -> [[f64; 3]; 3] {
        if self.kind == FrameKind::Rectangular || self.is_on_axis(at) {
            return self.unit;
        }
        let [x, y, z] = self.unit.map(|unit| dot(unit, minus(at, self.origin)));
        let r = x.hypot(y);
        let (cos, sin) = (x / r, y / r);
        let radial = self.turn(self.unit, [cos, sin, 0.0]);
        let tangential = self.turn(self.unit, [-sin, cos, 0.0]);
        if self.kind == FrameKind::Cylindrical {
            return [radial, tangential, self.unit[2]];
        }
        let length = r.hypot(z);
        let outward = self.turn(self.unit, [x / length, y / length, z / length]);
        let down = self.turn(self.unit, [cos * z / length, sin * z / length, -r / length]);
        [outward, down, tangential]
    }

    /// A vector by its components at a place.
    pub fn vector(&self, components: [f64; 3], at: [f64; 3]) -> [f64; 3] {
        self.turn(self.directions(at), components)
    }

    /// The frame of the degrees of freedom of a node.
    pub fn frame(&self, at: [f64; 3]) -> Frame {
        let directions = self.directions(at);
        match self.kind {
            FrameKind::Cylindrical if !self.is_on_axis(at) => Frame::Cylindrical([self.origin, self.unit[2]]),
            _ if directions == BASIC.unit => Frame::Global,
            _ => Frame::Turned(directions),
        }
    }

    /// Its unit vectors, of a system whose directions are the same everywhere.
    pub fn fixed(&self) -> Option<[[f64; 3]; 3]> {
        (self.kind == FrameKind::Rectangular).then_some(self.unit)
    }

    fn of([a, b, c]: [[f64; 3]; 3], kind: FrameKind) -> Option<Axes> {
        let unit = |v: [f64; 3]| {
            let length = dot(v, v).sqrt();
            (length > 0.0 && length.is_finite()).then(|| v.map(|x| x / length))
        };
        let e3 = unit(minus(b, a))?;
        let e1 = unit(minus(c, a))?;
        let e2 = cross(e3, e1);
        // C on the line of A and B leaves the directions open.
        let e2 = unit(e2).filter(|_| dot(e2, e2).sqrt() > 1e-8)?;
        Some(Axes { kind, origin: a, unit: [cross(e2, e3), e2, e3] })
    }
}

/// Grid points in their systems.
impl Grids {
    /// The place of a point that a card names.
    pub fn place_of(&self, id: u64, frames: &Frames, from: Place, notes: &mut Notes) -> Option<[f64; 3]> {
        let Some(row) = self.table.get(id) else {
            notes.files.fault(
                from,
                format!("grid point {id}, which is not there"),
                "the number of a GRID card",
            );
            return None;
        };
        Some(frames.get(self.system_number(&row.value), row.place, notes)?.place(row.value.coordinates))
    }

    /// All points as nodes.
    pub fn nodes(&self, frames: &Frames, notes: &mut Notes) -> Vec<Node> {
        let node = |row: &Row<Grid>| {
            let axes = frames.get(self.system_number(&row.value), row.place, notes);
            let position = axes.unwrap_or(BASIC).place(row.value.coordinates);
            Node { number: row.number, position, place: row.place }
        };
        self.table.rows().iter().map(node).collect()
    }

    /// The system of the displacements of a node; nodes that were added have that of the coordinates.
    pub fn displacements(&self, node: usize, frames: &Frames, notes: &mut Notes) -> Axes {
        let Some(row) = self.table.rows().get(node) else { return BASIC };
        let number = u64::from(row.value.displacements.unwrap_or(self.standard.1));
        frames.get(number, row.place, notes).unwrap_or(BASIC)
    }
}

impl RawFrames {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let name = fields.name();
        let kind = match name.as_bytes().last() {
            Some(b'R') => FrameKind::Rectangular,
            Some(b'C') => FrameKind::Cylindrical,
            _ => FrameKind::Spherical,
        };
        if name.starts_with("CORD1") {
            // Two on a card.
            for first in [1, 5] {
                if first == 5 && fields.is_blank(5) {
                    break;
                }
                let number = fields.id(first)?;
                let [a, b, c] = [1, 2, 3].map(|k| fields.id(first + k));
                self.table.push(number, fields.place(), Raw { kind, points: Points::Grids([a?, b?, c?]) });
            }
            return Some(());
        }
        let number = fields.id(1)?;
        let reference = fields.id_or(2, 0)?;
        let [a, b, c] = [3, 6, 9].map(|k| fields.vector(k));
        self.table.push(
            number,
            fields.place(),
            Raw { kind, points: Points::Places(reference, [a?, b?, c?]) },
        );
        Some(())
    }

    /// Finds each in Cartesian coordinates: after those that it is given in.
    pub fn resolve(self, grids: &Grids, notes: &mut Notes) -> Frames {
        let mut table = self.table;
        table.sort("coordinate system", notes);
        let n = table.rows().len();
        let mut frames = Frames { table, axes: vec![None; n] };
        let (mut begun, mut done) = (vec![false; n], vec![false; n]);
        for first in 0..n {
            let mut stack = vec![first];
            while let Some(&at) = stack.last() {
                if done[at] {
                    stack.pop();
                    continue;
                }
                let needs = frames.needs(at, grids);
                if !begun[at] {
                    begun[at] = true;
                    let open: Vec<usize> = needs.iter().copied().filter(|k| !begun[*k]).collect();
                    if !open.is_empty() {
                        stack.extend(open);
                        continue;
                    }
                }
                let row = &frames.table.rows()[at];
                if needs.iter().all(|k| done[*k]) {
                    frames.axes[at] = frames.axes_of(at, grids, notes);
                } else {
                    let found =
                        format!("coordinate system {}, which is given in itself through others", row.number);
                    notes.files.fault(
                        row.place,
                        found,
                        "systems of which each is given in one that stands by itself",
                    );
                }
                done[at] = true;
            }
        }
        frames
    }
}

impl Frames {
    /// Indices of the systems that one is given in.
    fn needs(&self, at: usize, grids: &Grids) -> Vec<usize> {
        let numbers = match &self.table.rows()[at].value.points {
            Points::Places(reference, _) => vec![*reference],
            Points::Grids(of) => of.iter().filter_map(|id| grids.system_of(*id)).collect(),
        };
        numbers.into_iter().filter_map(|number| self.table.find(number)).collect()
    }

    fn axes_of(&self, at: usize, grids: &Grids, notes: &mut Notes) -> Option<Axes> {
        let row = &self.table.rows()[at];
        let points = match &row.value.points {
            Points::Places(reference, places) => {
                let axes = self.get(*reference, row.place, notes)?;
                places.map(|place| axes.place(place))
            }
            Points::Grids(of) => {
                let [a, b, c] = of.map(|id| grids.place_of(id, self, row.place, notes));
                [a?, b?, c?]
            }
        };
        let axes = Axes::of(points, row.value.kind);
        if axes.is_none() {
            let found = format!("coordinate system {} of three points on a line", row.number);
            notes.files.fault(
                row.place,
                found,
                "an origin A, a point B on the third axis and a point C beside it",
            );
        }
        axes
    }

    /// A system by its number; one that is not there is a fault, one that has a fault is none.
    pub fn get(&self, number: u64, place: crate::deck::Place, notes: &mut Notes) -> Option<Axes> {
        if number == 0 {
            return Some(BASIC);
        }
        match self.table.find(number) {
            Some(at) => self.axes[at],
            None => {
                let found = format!("coordinate system {number}, which is not there");
                notes.files.fault(place, found, "the number of a CORD1 or CORD2 card, or 0");
                None
            }
        }
    }
}
