//! Properties of elements: PSOLID, PSHELL, PCOMP, PBAR, PBARL, PBEAM, PBEAML, PROD, PTUBE.

use super::beams;
use super::fields::Fields;
use super::notes::Notes;
use super::table::Table;
use crate::deck::SectionShape;
use crate::ledger::Weight;

/// What elements of a property are made of.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Property {
    /// The name of its card.
    pub card: String,
    pub material: u64,
    /// Mass that stiffens nothing, of an area of a shell or a length of a beam.
    pub carried: f64,
    pub shape: SectionShape,
    /// The system of the directions of the material of a solid; −1 is that of the element.
    pub system: i64,
}

/// The elements that a property may be of: properties of one class have numbers of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Class {
    Solid,
    Shell,
    Beam,
    Rod,
}

#[derive(Debug, Default)]
pub(super) struct Properties {
    solids: Table<Property>,
    shells: Table<Property>,
    beams: Table<Property>,
    rods: Table<Property>,
}

impl Properties {
    fn table(&mut self, class: Class) -> &mut Table<Property> {
        match class {
            Class::Solid => &mut self.solids,
            Class::Shell => &mut self.shells,
            Class::Beam => &mut self.beams,
            Class::Rod => &mut self.rods,
        }
    }

    fn of(&self, class: Class) -> &Table<Property> {
        match class {
            Class::Solid => &self.solids,
            Class::Shell => &self.shells,
            Class::Beam => &self.beams,
            Class::Rod => &self.rods,
        }
    }

    pub fn get(&self, class: Class, number: u64) -> Option<&Property> {
        self.of(class).get(number).map(|row| &row.value)
    }

    /// Whether there are any of a class.
    pub fn has(&self, class: Class) -> bool {
        !self.of(class).rows().is_empty()
    }

    pub fn sort(&mut self, notes: &mut Notes) {
        for class in [Class::Solid, Class::Shell, Class::Beam, Class::Rod] {
            self.table(class).sort("property", notes);
        }
    }

    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let name = fields.name();
        let number = fields.id(1)?;
        let (mut system, mut carried) = (0, 0.0);
        let (class, material, shape) = match name {
            "PSOLID" => {
                let material = fields.id(2)?;
                system = fields.integer_or(3, 0)?;
                fields.unread(
                    4,
                    6,
                    Weight::Perhaps,
                    "the integration of solids is not read: it is the one of the program",
                );
                if fields.word(7) == "PFLUID" {
                    fields.note(Weight::Matters, "a fluid is read as a solid");
                }
                (Class::Solid, material, SectionShape::Solid)
            }
            "PSHELL" => {
                let (membrane, bending) = (fields.id_or(2, 0)?, fields.integer_or(4, 0)?);
                let thickness = fields.real_or(3, 0.0)?;
                let shear = fields.id_or(6, 0)?;
                if membrane == 0 || bending == 0 {
                    fields.note(Weight::Matters, "a shell that is stiff as a membrane only, or in bending only, is read as one that is both");
                } else if bending > 0 && bending.unsigned_abs() != membrane || shear > 0 && shear != membrane
                {
                    fields.note(
                        Weight::Matters,
                        "materials of bending and shear are not read: that of the membrane holds",
                    );
                }
                if fields.real_or(5, 1.0)? != 1.0 {
                    fields.note(Weight::Matters, "the factor of bending stiffness, 12 I/T³, is not read");
                }
                if (fields.real_or(7, 0.833333)? - 5.0 / 6.0).abs() > 1e-3 {
                    fields
                        .note(Weight::Perhaps, "the factor of shear thickness, TS/T, is not read: it is 5/6");
                }
                carried = fields.real_or(8, 0.0)?;
                fields.unread(9, 10, Weight::Nothing, "places where stresses are wanted");
                fields.unread(11, 11, Weight::Matters, "coupling of membrane and bending is not read");
                let material = if membrane > 0 { membrane } else { bending.unsigned_abs() };
                (Class::Shell, material, SectionShape::Shell { thickness })
            }
            "PCOMP" => {
                carried = fields.real_or(3, 0.0)?;
                let (material, thickness) = layers(fields)?;
                (Class::Shell, material, SectionShape::Shell { thickness })
            }
            "PROD" | "PTUBE" => {
                let material = fields.id(2)?;
                let area = if name == "PROD" {
                    fields.unread(4, 4, Weight::Perhaps, "torsion of rods is not read");
                    fields.unread(5, 5, Weight::Nothing, "places where stresses are wanted");
                    carried = fields.real_or(6, 0.0)?;
                    fields.real(3)?
                } else {
                    carried = fields.real_or(5, 0.0)?;
                    fields.unread(6, 6, Weight::Matters, "a tube whose end is wider is not read");
                    let (outer, wall) = (fields.real(3)?, fields.real_or(4, 0.0)?);
                    let inner = if wall == 0.0 { 0.0 } else { outer - 2.0 * wall };
                    std::f64::consts::FRAC_PI_4 * (outer * outer - inner * inner)
                };
                (Class::Rod, material, SectionShape::Truss { area })
            }
            _ => {
                let (material, profile, of_length) = beams::profile(fields)?;
                carried = of_length;
                (Class::Beam, material, SectionShape::Beam { profile, first_axis: None })
            }
        };
        let place = fields.place();
        self.table(class).push(
            number,
            place,
            Property { card: name.to_string(), material, carried, shape, system },
        );
        Some(())
    }
}

/// Material and thickness of layers of one material; others are noted, and the first material has the whole thickness.
fn layers(fields: &mut Fields) -> Option<(u64, f64)> {
    fields.unread(2, 2, Weight::Matters, "the offset of its layers is not read");
    fields.unread(4, 6, Weight::Nothing, "strength and reference temperature are not read");
    fields.unread(7, 7, Weight::Perhaps, "damping of layers is not read");
    let twice = match fields.word(8) {
        "" => 1.0,
        "SYM" => 2.0,
        _ => {
            fields.note(Weight::Matters, "its kind of layers is not read");
            1.0
        }
    };
    let (mut material, mut thickness, mut last) = (0, 0.0, 0.0);
    let mut unlike = false;
    for first in (9..=fields.last()).step_by(4) {
        if (first..first + 4).all(|k| fields.is_blank(k)) {
            continue;
        }
        let own = fields.id_or(first, material)?;
        last = fields.real_or(first + 1, last)?;
        thickness += last;
        unlike |= material != 0 && own != material || fields.real_or(first + 2, 0.0)? != 0.0;
        fields.word(first + 3);
        material = if material == 0 { own } else { material };
    }
    if material == 0 {
        fields.fault(
            9,
            format!("{} without layers", fields.name()),
            "a material and a thickness of each layer",
        );
        return None;
    }
    if unlike {
        fields.note(
            Weight::Matters,
            "layers that differ are not read: the first material has the whole thickness",
        );
    }
    Some((material, twice * thickness))
}
