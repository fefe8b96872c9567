//! Sections of solids, shells and beams; orientations.

use super::frames::{rotation, turned};
use super::reader::{Found, Reader, Row};
use super::space::{Item, Placement};
use super::waiting::Orientation;
use crate::deck::{Elastic, Material, Profile, Section, SectionShape};
use crate::ledger::Weight;
use std::f64::consts::PI;
use stridor_base::numbers::parse;

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
        let Some([about, angle]) = rows.next().map_or(Some([0.0; 2]), |row| self.numbers::<2>(&row, 0))
        else {
            return;
        };
        let from = |p: [f64; 3]| std::array::from_fn(|k| p[k] - origin[k]);
        let axes = turned([from([ax, ay, az]), from([bx, by, bz])]);
        let orientation = match axes {
            _ if !system.starts_with('R') => Orientation::Other,
            None => {
                self.files.fault(
                    row.place,
                    "two points in one line with the origin",
                    "a point on x, and one in the plane of x and y",
                );
                return;
            }
            Some(axes) => {
                let about = if (1.0..=3.0).contains(&about) { axes[about as usize - 1] } else { axes[0] };
                let turn = Placement { rotation: rotation(about, angle.to_radians()), translation: [0.0; 3] };
                let placement = self.spaces[space].placement;
                let placed = |axis| placement.map_or(axis, |placement| placement.turn(axis));
                Orientation::Axes([axes[0], axes[1]].map(|axis| placed(turn.turn(axis))))
            }
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
        let name = self.spaces[space].qualified(name);
        let own = if found.block.keyword == "BEAMGENERALSECTION" { name.as_str() } else { "" };
        let material = found.option("MATERIAL").unwrap_or(own).to_string();
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
        let calculix = !row.cell(1).is_empty();
        // CalculiX takes one size as that of a square.
        let b = if form == "RECT" && !calculix { a } else { b };
        let Some(profile) = profile(&form, [a, b, c, d, e, f], calculix) else {
            let what = format!("*BEAM SECTION, SECTION={form}");
            self.deck.ledger.note(Weight::Matters, what, "a profile that is not read", found.place());
            return;
        };
        if form == "GENERAL" && c != 0.0 {
            let why = "I₁₂ is not read: give the directions of the principal axes";
            self.deck.ledger.note(Weight::Matters, "*BEAM SECTION, SECTION=GENERAL", why, row.place);
        }
        if let Profile::General { area, second_moments: [i, k], torsion } = profile
            && !(area > 0.0 && i > 0.0 && k > 0.0 && torsion > 0.0 && (area + i + k + torsion).is_finite())
        {
            self.files.fault(
                row.place,
                format!("a profile of area {area}"),
                "sizes of a profile that has an area",
            );
            return;
        }
        let first_axis =
            rows.get(1).and_then(|row| self.numbers::<3>(row, 0)).filter(|axis| *axis != [0.0; 3]);
        let placement = self.spaces[space].placement;
        let first_axis = first_axis.map(|axis| placement.map_or(axis, |placement| placement.turn(axis)));
        // What these programs take where there is none.
        let first_axis = first_axis.or(Some([0.0, 0.0, -1.0]));
        if found.block.keyword == "BEAMGENERALSECTION" && found.option("MATERIAL").is_none() {
            self.own_material(space, found, rows.get(2));
        }
        self.section(space, found, SectionShape::Beam { profile, first_axis });
    }
}

impl Reader {
    /// The material of *BEAM GENERAL SECTION, which is called as its set: E and G in the third line, DENSITY.
    fn own_material(&mut self, space: usize, found: Found<'_>, row: Option<&Row<'_>>) {
        let Some([youngs_modulus, shear]) = row.and_then(|row| self.numbers::<2>(row, 0)) else {
            self.files.fault(
                found.place(),
                "*BEAM GENERAL SECTION without E and G",
                "a third line with E, G",
            );
            return;
        };
        let name = self.spaces[space].qualified(found.option("ELSET").unwrap_or_default());
        let density = found.option("DENSITY").and_then(parse).filter(|density| density.is_finite());
        let poissons_ratio = youngs_modulus / (2.0 * shear) - 1.0;
        if !poissons_ratio.is_finite() {
            self.files.fault(
                found.place(),
                format!("E = {youngs_modulus} and G = {shear}"),
                "both above zero",
            );
            return;
        }
        let elastic = Some(Elastic::Isotropic { youngs_modulus, poissons_ratio });
        self.deck.materials.push(Material { name, elastic, density, ..Material::default() });
    }
}

/// A profile by its name and sizes; CalculiX gives a round by two diameters, Abaqus by one radius.
fn profile(form: &str, [a, b, c, d, e, f]: [f64; 6], calculix: bool) -> Option<Profile> {
    let general = |area, second_moments, torsion| Profile::General { area, second_moments, torsion };
    Some(match form {
        "CIRC" if calculix && a == b => Profile::Round { diameter: a },
        // An ellipse: πab/4, πa³b/64, πab³/64, πa³b³/16(a² + b²) of its diameters. Source: Young and Budynas, table 10.7.
        "CIRC" if calculix => general(
            PI * a * b / 4.0,
            [PI * a.powi(3) * b / 64.0, PI * a * b.powi(3) / 64.0],
            PI * (a * b).powi(3) / (16.0 * (a * a + b * b)),
        ),
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
        _ => return None,
    })
}

/// J of a rectangle \[length⁴\], to 4 · 10⁻³ of it: long side a, short side b, ab³(⅓ − 0.21 b/a (1 − b⁴/12a⁴)). Source: Young and
/// Budynas, *Roark's Formulas for Stress and Strain*, table 10.1.
fn rectangle_torsion(a: f64, b: f64) -> f64 {
    let (long, short) = (a.max(b), a.min(b));
    let ratio = short / long;
    long * short.powi(3) * (1.0 / 3.0 - 0.21 * ratio * (1.0 - ratio.powi(4) / 12.0))
}
