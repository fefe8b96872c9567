//! Elements without a shape: *MASS, *ROTARY INERTIA, *SPRING, *DASHPOT.

use super::reader::{Found, Reader};
use super::space::Item;
use crate::deck::{PointMass, Spring};
use crate::ledger::Weight;

/// Types with the numbers of their nodes.
const TYPES: [(&str, usize); 9] = [
    ("MASS", 1),
    ("ROTARYI", 1),
    ("SPRING1", 1),
    ("DASHPOT1", 1),
    ("DCOUP3D", 1),
    ("SPRING2", 2),
    ("SPRINGA", 2),
    ("DASHPOT2", 2),
    ("DASHPOTA", 2),
];

/// The number of nodes of a type.
pub(super) fn n_nodes(type_name: &str) -> Option<usize> {
    TYPES.iter().find(|(name, _)| *name == type_name).map(|(_, n_nodes)| *n_nodes)
}

/// The name of a type as the table has it.
pub(super) fn type_named(type_name: &str) -> Option<&'static str> {
    TYPES.iter().find(|(name, _)| *name == type_name).map(|(name, _)| *name)
}

impl Reader {
    /// The point elements of the set that a block names, of types that begin so.
    fn points_of(&mut self, space: usize, found: Found<'_>, begins: &str) -> Vec<usize> {
        let Some(name) = found.option("ELSET") else {
            self.files.fault(found.place(), format!("*{} without a set", found.block.keyword), "ELSET=…");
            return Vec::new();
        };
        let items = self.items_of(space, name, found.place()).unwrap_or_default();
        let of_type = |index: &usize| self.points[*index].type_name.starts_with(begins);
        let points = items
            .into_iter()
            .filter_map(|item| if let Item::Point(index) = item { Some(index) } else { None });
        let points: Vec<usize> = points.filter(of_type).collect();
        if points.is_empty() {
            let why = format!("a set without an element of type {begins} has no effect");
            self.deck.ledger.note(Weight::Perhaps, format!("*{}", found.block.keyword), why, found.place());
        }
        points
    }

    /// *MASS: m.
    pub fn mass(&mut self, space: usize, found: Found<'_>) {
        let points = self.points_of(space, found, "MASS");
        let Some(row) = found.rows().next() else {
            self.files.fault(found.place(), "*MASS without a value", "a line with the mass");
            return;
        };
        let Some(mass) = self.number(&row, 0) else { return };
        self.point_mass(space, found, points, mass, [0.0; 3]);
    }

    /// *ROTARY INERTIA: I₁₁, I₂₂, I₃₃, I₁₂, I₁₃, I₂₃.
    pub fn rotary_inertia(&mut self, space: usize, found: Found<'_>) {
        let points = self.points_of(space, found, "ROTARYI");
        let Some(row) = found.rows().next() else {
            self.files.fault(
                found.place(),
                "*ROTARY INERTIA without values",
                "a line with moments of inertia",
            );
            return;
        };
        let Some([x, y, z, products @ ..]) = self.numbers::<6>(&row, 0) else { return };
        if products != [0.0; 3] {
            let why = "products of inertia are not read, those about the axes are";
            self.deck.ledger.note(Weight::Perhaps, "*ROTARY INERTIA", why, row.place);
        }
        self.point_mass(space, found, points, 0.0, [x, y, z]);
    }

    fn point_mass(
        &mut self,
        space: usize,
        found: Found<'_>,
        points: Vec<usize>,
        mass: f64,
        inertia: [f64; 3],
    ) {
        let nodes = points.iter().flat_map(|point| self.points[*point].nodes.iter().copied()).collect();
        let name = self.spaces[space].qualified(found.option("ELSET").unwrap_or_default());
        self.deck.masses.push(PointMass { name, nodes, mass, inertia, place: found.place() });
    }

    /// *SPRING: a line of degrees of freedom, if not along the line between the nodes; a line with k.
    pub fn spring(&mut self, space: usize, found: Found<'_>) {
        if found.block.has("NONLINEAR") {
            let why = "a nonlinear spring is not read";
            self.deck.ledger.note(Weight::Matters, "*SPRING, NONLINEAR", why, found.place());
            return;
        }
        self.spring_or_dashpot(space, found, "SPRING", |spring, value| spring.stiffness = value);
    }

    /// *DASHPOT: as *SPRING, with c.
    pub fn dashpot(&mut self, space: usize, found: Found<'_>) {
        self.spring_or_dashpot(space, found, "DASHPOT", |spring, value| spring.damping = value);
    }

    fn spring_or_dashpot(&mut self, space: usize, found: Found<'_>, begins: &str, set: fn(&mut Spring, f64)) {
        let points = self.points_of(space, found, begins);
        let Some(point) = points.first() else { return };
        if found.block.has("ORIENTATION") || self.turned(&points) {
            let why = "springs and dashpots in a frame of their own are read in that of the coordinates";
            self.deck.ledger.note(Weight::Matters, format!("*{}", found.block.keyword), why, found.place());
        }
        let along_line = self.points[*point].type_name.ends_with('A');
        if points.iter().any(|other| self.points[*other].type_name.ends_with('A') != along_line) {
            let words = "a set with springs along a line and along a degree of freedom";
            self.files.fault(found.place(), words, "sets of springs of one type");
            return;
        }
        // Of elements along a line the first line is blank, or has nothing but commas.
        let mut rows = found.rows().filter(|row| row.cells.iter().any(|cell| !cell.is_empty()));
        let Some(first) = rows.next() else {
            self.files.fault(
                found.place(),
                format!("*{} without data", found.block.keyword),
                "lines with degrees of freedom and the constant",
            );
            return;
        };
        let (dof, row) = if along_line {
            (None, first)
        } else {
            let dofs: Vec<&str> = first.cells.iter().copied().filter(|cell| !cell.is_empty()).collect();
            let dof =
                dofs.first().and_then(|cell| cell.parse::<u8>().ok()).filter(|dof| (1..=6).contains(dof));
            let Some(dof) = dof else {
                self.files.fault(
                    first.place,
                    format!("`{}`", first.cell(0)),
                    "a degree of freedom from 1 to 6",
                );
                return;
            };
            if dofs.iter().any(|other| other.parse() != Ok(dof)) {
                let why = "a spring between two different degrees of freedom is not read";
                self.deck.ledger.note(Weight::Matters, format!("*{}", found.block.keyword), why, first.place);
                return;
            }
            let Some(row) = rows.next() else {
                self.files.fault(first.place, "no line below", "a line with the constant");
                return;
            };
            (Some(dof - 1), row)
        };
        let Some(value) = self.number(&row, 0) else { return };
        if rows.next().is_some() {
            let why = "the first line of a table over temperature or frequency is read";
            self.deck.ledger.note(Weight::Perhaps, format!("*{}", found.block.keyword), why, row.place);
        }
        let of = |point: &usize| {
            let nodes = &self.points[*point].nodes;
            (nodes[0], nodes.get(1).copied())
        };
        let ends = points.iter().map(of).collect();
        let name = self.spaces[space].qualified(found.option("ELSET").unwrap_or_default());
        let mut spring = Spring { name, ends, dof, stiffness: 0.0, damping: 0.0, place: found.place() };
        set(&mut spring, value);
        self.deck.springs.push(spring);
    }

    /// Whether degrees of freedom of a node of these count in a frame.
    fn turned(&self, points: &[usize]) -> bool {
        let mut nodes = points.iter().flat_map(|point| &self.points[*point].nodes);
        !self.frame_of.is_empty() && nodes.any(|node| self.frame_of.contains_key(node))
    }
}
