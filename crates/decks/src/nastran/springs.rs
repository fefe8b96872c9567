//! Springs and dashpots: CELAS1, CELAS2, CDAMP1, CDAMP2, CBUSH, CBUSH1D, and their properties.

use super::axis::Axis;
use super::fields::Fields;
use super::model::Model;
use super::table::Table;
use crate::deck::{Place, Spring};
use crate::ledger::Weight;
use std::collections::{BTreeMap, BTreeSet};
use stridor_mesh::quality::{cross, dot, minus, norm};

/// A spring as its card has it.
#[derive(Debug, Clone, PartialEq)]
struct Raw {
    card: &'static str,
    /// The grid points of its ends, 0 for the ground.
    ends: [u64; 2],
    of: Of,
    how: How,
}

#[derive(Debug, Clone, PartialEq)]
enum Of {
    Property(Class, u64),
    /// k and c.
    Own(f64, f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Class {
    Elastic,
    Damper,
    Bush,
    Line,
}

/// Which motions it resists.
#[derive(Debug, Clone, PartialEq)]
enum How {
    /// Degrees of freedom from 0 of its ends.
    Component([usize; 2]),
    /// All of them, in a system, or along the line of its ends with an axis beside it.
    Bush {
        system: Option<u64>,
        axis: Option<Axis>,
    },
    Line,
}

/// Stiffnesses and dampings of the six degrees of freedom; of a spring of one, the first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Rates {
    k: [f64; 6],
    c: [f64; 6],
}

#[derive(Debug, Default)]
pub(super) struct Springs {
    table: Table<Raw>,
    elastic: Table<Rates>,
    dampers: Table<Rates>,
    bushes: Table<Rates>,
    lines: Table<Rates>,
}

impl Springs {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let place = fields.place();
        match fields.name() {
            "PELAS" => {
                for first in [1, 5] {
                    if first == 5 && fields.is_blank(5) {
                        break;
                    }
                    let (number, k) = (fields.id(first)?, fields.real(first + 1)?);
                    damping(fields, first + 2);
                    fields.unread(first + 3, first + 3, Weight::Nothing, "stress coefficients are not read");
                    self.elastic.push(number, place, Rates { k: [k; 6], ..Rates::default() });
                }
            }
            "PDAMP" => {
                for first in [1, 3, 5, 7] {
                    if first > 1 && fields.is_blank(first) {
                        break;
                    }
                    let (number, c) = (fields.id(first)?, fields.real(first + 1)?);
                    self.dampers.push(number, place, Rates { c: [c; 6], ..Rates::default() });
                }
            }
            "PBUSH1D" => {
                let (number, k, c) = (fields.id(1)?, fields.real_or(2, 0.0)?, fields.real_or(3, 0.0)?);
                fields.unread(4, 4, Weight::Matters, "mass of springs is not read");
                let last = fields.last();
                fields.unread(5, last, Weight::Perhaps, "stresses and laws of force of CBUSH1D are not read");
                self.lines.push(number, place, Rates { k: [k; 6], c: [c; 6] });
            }
            "PBUSH" => {
                let (number, rates) = (fields.id(1)?, bush(fields)?);
                self.bushes.push(number, place, rates);
            }
            "CBUSH" => return self.bush(fields),
            "CBUSH1D" => {
                let (number, property) = (fields.id(1)?, fields.id_or(2, 0)?);
                let ends = [fields.id(3)?, fields.id_or(4, 0)?];
                let of = Of::Property(Class::Line, if property == 0 { number } else { property });
                fields.unread(
                    5,
                    5,
                    Weight::Matters,
                    "the system of CBUSH1D is not read: it acts along the line of its ends",
                );
                self.table.push(number, place, Raw { card: "CBUSH1D", ends, of, how: How::Line });
            }
            name => {
                let number = fields.id(1)?;
                let (card, of) = match name {
                    "CELAS1" => ("CELAS1", Of::Property(Class::Elastic, fields.id_or(2, number)?)),
                    "CDAMP1" => ("CDAMP1", Of::Property(Class::Damper, fields.id_or(2, number)?)),
                    "CELAS2" => ("CELAS2", Of::Own(fields.real(2)?, 0.0)),
                    _ => ("CDAMP2", Of::Own(0.0, fields.real(2)?)),
                };
                let ends = [fields.id_or(3, 0)?, fields.id_or(5, 0)?];
                let components = [fields.integer_or(4, 0)?, fields.integer_or(6, 0)?];
                if let Some(wrong) = components.iter().find(|c| !(0..=6).contains(*c)) {
                    fields.fault(4, format!("degree of freedom {wrong} of {name}"), "one of 1 to 6");
                    return None;
                }
                if name == "CELAS2" {
                    damping(fields, 7);
                    fields.unread(8, 8, Weight::Nothing, "stress coefficients are not read");
                }
                let how = How::Component(components.map(|c| c.max(1) as usize - 1));
                self.table.push(number, place, Raw { card, ends, of, how });
            }
        }
        Some(())
    }

    fn bush(&mut self, fields: &mut Fields) -> Option<()> {
        let (number, property) = (fields.id(1)?, fields.id_or(2, 0)?);
        let ends = [fields.id(3)?, fields.id_or(4, 0)?];
        let axis = Axis::read(fields)?;
        let system = if fields.is_blank(8) { None } else { Some(fields.id_or(8, 0)?) };
        if (fields.real_or(9, 0.5)? - 0.5).abs() > 1e-9 || !fields.is_blank(10) && fields.word(10) != "-1" {
            fields.note(Weight::Perhaps, "the place of the spring between its ends is not read");
        }
        fields.unread(11, 13, Weight::Perhaps, "the place of the spring between its ends is not read");
        let of = Of::Property(Class::Bush, if property == 0 { number } else { property });
        self.table.push(
            number,
            fields.place(),
            Raw { card: "CBUSH", ends, of, how: How::Bush { system, axis } },
        );
        Some(())
    }

    /// The numbers of all springs.
    pub fn numbers(&self, numbers: &mut BTreeSet<u64>) {
        numbers.extend(self.table.rows().iter().map(|row| row.number));
    }

    pub fn resolve(mut self, model: &mut Model) {
        self.table.sort("spring", model.notes);
        for table in [&mut self.elastic, &mut self.dampers, &mut self.bushes, &mut self.lines] {
            table.sort("property of springs", model.notes);
        }
        let mut groups = Groups::default();
        for row in self.table.rows() {
            let (name, rates) = match &row.value.of {
                Of::Own(k, c) => {
                    (format!("{}_{}", row.value.card, row.number), Rates { k: [*k; 6], c: [*c; 6] })
                }
                Of::Property(class, number) => {
                    let (card, table) = match class {
                        Class::Elastic => ("PELAS", &self.elastic),
                        Class::Damper => ("PDAMP", &self.dampers),
                        Class::Bush => ("PBUSH", &self.bushes),
                        Class::Line => ("PBUSH1D", &self.lines),
                    };
                    let Some(property) = table.get(*number) else {
                        let found = format!(
                            "{} {} of property {number}, which is not there",
                            row.value.card, row.number
                        );
                        model.notes.files.fault(row.place, found, format!("the number of a {card} card"));
                        continue;
                    };
                    (model.names.of(super::names::Named::Property, *number, card), property.value)
                }
            };
            spring(&row.value, row.place, (&name, rates), &mut groups, model);
        }
        model.deck.springs.extend(groups.0.into_values());
    }
}

/// The loss factor of a spring in a field.
fn damping(fields: &mut Fields, number: usize) {
    fields.unread(number, number, Weight::Perhaps, "loss factors of springs are not read");
}

/// PBUSH: lines of a word and six numbers.
fn bush(fields: &mut Fields) -> Option<Rates> {
    let mut rates = Rates::default();
    for line in (0..fields.last()).step_by(8) {
        let word = fields.word(line + 2);
        match word {
            "K" | "B" => {
                let mut values = [0.0; 6];
                for (k, value) in values.iter_mut().enumerate() {
                    // RIGID is as stiff as can be.
                    if fields.words(line + 3 + k, line + 3 + k).iter().any(|(_, text)| *text == "RIGID") {
                        fields.note(Weight::Matters, "a spring that is RIGID is not read");
                        continue;
                    }
                    *value = fields.real_or(line + 3 + k, 0.0)?;
                }
                *(if word == "K" { &mut rates.k } else { &mut rates.c }) = values;
            }
            "GE" => {
                fields.unread(line + 3, line + 8, Weight::Perhaps, "loss factors of springs are not read")
            }
            "M" => fields.unread(line + 3, line + 8, Weight::Matters, "mass of springs is not read"),
            "" => {}
            _ => fields.unread(line + 3, line + 8, Weight::Nothing, "places where stresses are wanted"),
        }
    }
    Some(rates)
}

/// Springs that differ in their ends only, by name, degree of freedom, and rates.
#[derive(Default)]
struct Groups(BTreeMap<(String, Option<u8>, [u64; 2]), Spring>);

impl Groups {
    fn add(&mut self, site: &Site, dof: Option<u8>, [k, c]: [f64; 2]) {
        if k == 0.0 && c == 0.0 {
            return;
        }
        let name = site.name.to_string();
        let key = (name.clone(), dof, [k.to_bits(), c.to_bits()]);
        let new = || Spring { name, ends: Vec::new(), dof, stiffness: k, damping: c, place: site.place };
        self.0.entry(key).or_insert_with(new).ends.push(site.ends);
    }
}

/// A spring and where it is.
struct Site<'a> {
    card: &'static str,
    name: &'a str,
    ends: (usize, Option<usize>),
    /// From the first end to the second; zero from the ground.
    line: [f64; 3],
    place: Place,
}

/// Adds a spring.
fn spring(raw: &Raw, place: Place, (name, rates): (&str, Rates), groups: &mut Groups, model: &mut Model) {
    let mut ends = raw.ends;
    let mut how = raw.how.clone();
    if ends[0] == 0 {
        ends.swap(0, 1);
        if let How::Component(components) = &mut how {
            components.swap(0, 1);
        }
    }
    let Some(a) = model.node(ends[0], raw.card, place) else { return };
    let b = if ends[1] == 0 { None } else { model.node(ends[1], raw.card, place) };
    if ends[1] != 0 && b.is_none() {
        return;
    }
    let line = b.map_or([0.0; 3], |b| minus(model.position(b), model.position(a)));
    let site = Site { card: raw.card, name, ends: (a, b), line, place };
    match how {
        How::Line => groups.add(&site, None, [rates.k[0], rates.c[0]]),
        How::Component([own, other]) => {
            let unit = model.directions(a);
            if b.is_some_and(|b| own != other || model.directions(b) != unit) {
                let why = "springs between unlike directions of their ends are not read";
                model.notes.ledger.note(Weight::Matters, raw.card, why, place);
                return;
            }
            let mut only = Rates::default();
            (only.k[own], only.c[own]) = (rates.k[0], rates.c[0]);
            turned(&site, unit, only, groups, model);
        }
        How::Bush { system, axis } => {
            let Some(unit) = directions(&site, system, axis, &rates, model) else { return };
            if norm(line) > 0.0 && (rates.k[1] != 0.0 || rates.k[2] != 0.0) {
                let why = "the moment of shear forces over its length is not read";
                model.notes.ledger.note(Weight::Perhaps, raw.card, why, place);
            }
            turned(&site, unit, rates, groups, model);
        }
    }
}

/// The directions of a bush: of a system, or along its line with a direction beside it, or of the displacements of its first end.
fn directions(
    site: &Site,
    system: Option<u64>,
    axis: Option<Axis>,
    rates: &Rates,
    model: &mut Model,
) -> Option<[[f64; 3]; 3]> {
    let (a, along) = (site.ends.0, norm(site.line));
    let at = model.position(a);
    if let Some(number) = system {
        return Some(model.frames.get(number, site.place, model.notes)?.directions(at));
    }
    if along == 0.0 {
        return Some(model.directions(a));
    }
    let e1 = site.line.map(|x| x / along);
    let beside = match axis {
        Some(axis) => Some(axis.direction(a, site.card, site.place, model)?),
        None => None,
    };
    let across = |of: &[f64; 6]| (0..6).any(|k| k % 3 != 0 && of[k] != 0.0);
    match beside.map(|v| cross(e1, v)).filter(|v| norm(*v) > 0.0) {
        Some(v) => {
            let e3 = v.map(|x| x / norm(v));
            Some([e1, cross(e3, e1), e3])
        }
        None if across(&rates.k) || across(&rates.c) => {
            let found = format!("{} without a direction beside its line", site.card);
            model.notes.files.fault(site.place, found, "a vector, a grid point or a coordinate system");
            None
        }
        None => Some([e1, [0.0; 3], [0.0; 3]]),
    }
}

/// Springs in the directions e: K = Σ kᵢ eᵢ eᵢᵀ. They are read where K is diagonal in the coordinates, or acts along the line only.
fn turned(site: &Site, unit: [[f64; 3]; 3], rates: Rates, groups: &mut Groups, model: &mut Model) {
    let matrix = |rates: &[f64]| -> [[f64; 3]; 3] {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|k| rates[k] * unit[k][i] * unit[k][j]).sum())
        })
    };
    let is_diagonal = |m: &[[f64; 3]; 3]| {
        let size = (0..3).map(|i| m[i][i].abs()).sum::<f64>();
        (0..3).all(|i| (0..3).all(|j| i == j || m[i][j].abs() <= 1e-9 * size))
    };
    for first in [0, 3] {
        let [k, c] = [&rates.k, &rates.c].map(|of| matrix(&of[first..first + 3]));
        if is_diagonal(&k) && is_diagonal(&c) {
            let size = |m: &[[f64; 3]; 3]| (0..3).map(|i| m[i][i].abs()).sum::<f64>();
            let clean =
                |m: &[[f64; 3]; 3], i: usize| if m[i][i].abs() <= 1e-12 * size(m) { 0.0 } else { m[i][i] };
            for i in 0..3 {
                groups.add(site, Some((first + i) as u8), [clean(&k, i), clean(&c, i)]);
            }
            continue;
        }
        let only: Vec<usize> =
            (0..3).filter(|i| rates.k[first + i] != 0.0 || rates.c[first + i] != 0.0).collect();
        let length = norm(site.line);
        match only[..] {
            [i] if first == 0 && length > 0.0 && dot(unit[i], site.line).abs() > (1.0 - 1e-9) * length => {
                groups.add(site, None, [rates.k[i], rates.c[i]]);
            }
            _ => {
                let why = "springs in directions other than the coordinates' are not read";
                model.notes.ledger.note(Weight::Matters, site.card, why, site.place);
            }
        }
    }
}
