//! Sections of solids, shells and beams; orientations.

use super::space::Item;
use super::{Found, Reader, Row};
use crate::deck::{Profile, Section, SectionShape};
use crate::ledger::Weight;
use std::f64::consts::PI;
use stridor_base::numbers::parse;

/// *ORIENTATION: a frame of the model.
#[derive(Debug, Clone)]
pub(super) enum Orientation {
    /// Directions 1 and 2.
    Axes([[f64; 3]; 2]),
    /// About an axis, or defined in another way.
    Other,
}

impl Reader {
    /// *ORIENTATION: a point on the local x and one in the plane of x and y; then perhaps a rotation.
    pub fn orientation(&mut self, space: usize, found: Found<'_>) {
        let Some(name) = found.option("NAME") else {
            self.files.fault(found.place(), "*ORIENTATION without a name", "*ORIENTATION, NAME=…");
            return;
        };
        let mut rows = found.rows();
        let system = found.option("SYSTEM").unwrap_or("RECTANGULAR").to_uppercase();
        let Some(row) = rows.next() else {
            self.files.fault(found.place(), "*ORIENTATION without data", "two points");
            return;
        };
        if parse(row.cell(0)).is_none() && !row.cell(0).is_empty() {
            // The name of a *DISTRIBUTION.
            let name = self.spaces[space].qualified(name);
            self.orientations.entry(&name, || Orientation::Other);
            return;
        }
        let Some([ax, ay, az, bx, by, bz]) = self.numbers::<6>(&row, 0) else { return };
        let origin: [f64; 3] =
            if row.cells.len() >= 9 { self.numbers::<3>(&row, 6).unwrap_or_default() } else { [0.0; 3] };
        let turned = rows.next().is_some_and(|row| self.number(&row, 1).is_some_and(|angle| angle != 0.0));
        let from = |p: [f64; 3]| std::array::from_fn(|k| p[k] - origin[k]);
        let orientation = if system.starts_with('R') && !turned {
            let axes: [[f64; 3]; 2] = [from([ax, ay, az]), from([bx, by, bz])];
            let placement = self.spaces[space].placement;
            Orientation::Axes(axes.map(|axis| placement.map_or(axis, |placement| placement.turn(axis))))
        } else {
            Orientation::Other
        };
        let name = self.spaces[space].qualified(name);
        self.orientations.entry(&name, || orientation);
    }

    /// Directions of an orientation; a note where it is none that a part can have.
    pub fn axes_of(&mut self, space: usize, found: Found<'_>) -> Option<[[f64; 3]; 2]> {
        let name = found.option("ORIENTATION")?;
        let own = self.spaces[space].qualified(name);
        match self.orientations.get(&own).or_else(|| self.orientations.get(name)) {
            Some(Orientation::Axes(axes)) => Some(*axes),
            Some(Orientation::Other) => {
                let why = "a material whose directions turn from point to point is not read; the axes of the coordinates are taken";
                self.deck.ledger.note(Weight::Matters, "*ORIENTATION", why, found.place());
                None
            }
            None => {
                self.files.fault(found.place(), format!("ORIENTATION={name}"), "the name of an *ORIENTATION");
                None
            }
        }
    }

    fn section(&mut self, space: usize, found: Found<'_>, shape: SectionShape) {
        let Some(name) = found.option("ELSET") else {
            self.files.fault(found.place(), format!("*{} without a set", found.block.keyword), "ELSET=…");
            return;
        };
        let items = self.items_of(space, name, found.place()).unwrap_or_default();
        let mut elements: Vec<usize> = items
            .into_iter()
            .filter_map(|item| if let Item::Shape(index) = item { Some(index) } else { None })
            .collect();
        elements.sort_unstable();
        elements.dedup();
        let axes = self.axes_of(space, found);
        let material = found.option("MATERIAL").unwrap_or_default().to_string();
        let name = self.spaces[space].qualified(name);
        self.deck.sections.push(Section { name, elements, material, axes, shape, place: found.place() });
    }

    /// *SOLID SECTION: of solids, and of trusses with their area.
    pub fn solid_section(&mut self, space: usize, found: Found<'_>) {
        let items = found.option("ELSET").and_then(|name| self.items_called(space, name)).unwrap_or_default();
        let lines = items.iter().any(
            |item| matches!(item, Item::Shape(index) if self.deck.elements[*index].kind.dimension() == 1),
        );
        let shape = if lines {
            let area = found.rows().next().and_then(|row| self.number(&row, 0)).filter(|area| *area > 0.0);
            SectionShape::Truss { area: area.unwrap_or(1.0) }
        } else {
            SectionShape::Solid
        };
        if found.block.has("COMPOSITE") {
            let why = "layers of a composite are not read";
            self.deck.ledger.note(Weight::Matters, "*SOLID SECTION, COMPOSITE", why, found.place());
        }
        self.section(space, found, shape);
    }

    /// *SHELL SECTION: thickness, number of points.
    pub fn shell_section(&mut self, space: usize, found: Found<'_>) {
        if found.block.has("COMPOSITE") {
            let why = "layers of a composite are not read";
            self.deck.ledger.note(Weight::Matters, "*SHELL SECTION, COMPOSITE", why, found.place());
            return;
        }
        let Some(row) = found.rows().next() else {
            self.files.fault(
                found.place(),
                "*SHELL SECTION without a thickness",
                "a line with the thickness",
            );
            return;
        };
        let Some(thickness) = self.number(&row, 0) else { return };
        self.section(space, found, SectionShape::Shell { thickness });
    }

    /// *BEAM SECTION: sizes of the profile; a direction of its first axis.
    pub fn beam_section(&mut self, space: usize, found: Found<'_>) {
        let form = found.option("SECTION").unwrap_or("GENERAL").to_uppercase();
        let rows: Vec<Row<'_>> = found.rows().collect();
        let Some(row) = rows.first() else {
            self.files.fault(
                found.place(),
                "*BEAM SECTION without sizes",
                "a line with the sizes of the profile",
            );
            return;
        };
        let Some([a, b, c, d, e, f]) = self.numbers::<6>(row, 0) else { return };
        let general = |area, second_moments, torsion| Profile::General { area, second_moments, torsion };
        let profile = match form.as_str() {
            "CIRC" => Profile::Round { diameter: 2.0 * a },
            // Sizes a along the first axis, b along the second.
            "RECT" => general(a * b, [a.powi(3) * b / 12.0, a * b.powi(3) / 12.0], rectangle_torsion(a, b)),
            // Outer radius, wall.
            "PIPE" => {
                let inner = (a - b).max(0.0);
                let second = PI * (a.powi(4) - inner.powi(4)) / 4.0;
                general(PI * (a * a - inner * inner), [second; 2], 2.0 * second)
            }
            // a, b, and the walls t₁ to t₄; where they are all alike.
            "BOX" if c == d && c == e && c == f => {
                let (inner_a, inner_b) = (a - 2.0 * c, b - 2.0 * c);
                let middle = (a - c) * (b - c);
                let second = |x: f64, y: f64, u: f64, v: f64| (x.powi(3) * y - u.powi(3) * v) / 12.0;
                let torsion = 2.0 * middle * middle * c / (a + b - 2.0 * c);
                general(
                    a * b - inner_a * inner_b,
                    [second(a, b, inner_a, inner_b), second(b, a, inner_b, inner_a)],
                    torsion,
                )
            }
            // A, I₁₁ (about the first axis), I₁₂, I₂₂, J.
            "GENERAL" => general(a, [d, b], e),
            _ => {
                let what = format!("*BEAM SECTION, SECTION={form}");
                self.deck.ledger.note(Weight::Matters, what, "a profile that is not read", found.place());
                return;
            }
        };
        let first_axis =
            rows.get(1).and_then(|row| self.numbers::<3>(row, 0)).filter(|axis| *axis != [0.0; 3]);
        let placement = self.spaces[space].placement;
        let first_axis = first_axis.map(|axis| placement.map_or(axis, |placement| placement.turn(axis)));
        self.section(space, found, SectionShape::Beam { profile, first_axis });
    }
}

/// J of a rectangle \[length⁴\], to 4 · 10⁻³ of it: long side a, short side b, ab³(⅓ − 0.21 b/a (1 − b⁴/12a⁴)). Source: Young and
/// Budynas, *Roark's Formulas for Stress and Strain*, table 10.1.
fn rectangle_torsion(a: f64, b: f64) -> f64 {
    let (long, short) = (a.max(b), a.min(b));
    let ratio = short / long;
    long * short.powi(3) * (1.0 / 3.0 - 0.21 * ratio * (1.0 - ratio.powi(4) / 12.0))
}
