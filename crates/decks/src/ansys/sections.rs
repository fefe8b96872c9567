//! What elements are made of: cross-sections by SECTYPE or real constants, and the elements that have the same.

use super::frames::{cross, minus, unit};
use super::materials;
use super::model::{Attributes, Model, RawElement};
use super::reader::Reader;
use super::shapes::{Family, Routine};
use crate::deck::{Elastic, Place, Profile, Section, SectionShape};
use crate::ledger::Weight;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Elements by what they are made of.
#[derive(Debug, Default)]
pub(super) struct Sections(BTreeMap<Key, Group>);

/// What elements of one section share: attributes, and the first axis of a beam in steps of 1e-9.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    own: Attributes,
    axis: [i64; 3],
}

#[derive(Debug)]
struct Group {
    routine: &'static Routine,
    elements: Vec<usize>,
    axis: Option<[f64; 3]>,
    place: Place,
}

impl Sections {
    /// Puts the element with this index into its section.
    pub fn add(&mut self, model: &Model, routine: &'static Routine, raw: &RawElement, index: usize) {
        let mut own = raw.attributes;
        if matches!(routine.family, Family::Solid) {
            (own.real, own.section) = (0, 0);
        } else {
            own.system = 0;
        }
        let axis = (routine.family == Family::Beam).then(|| first_axis(model, routine, &raw.nodes)).flatten();
        let key = Key { own, axis: axis.unwrap_or([0.0; 3]).map(|x| (x * 1e9).round() as i64) };
        let group = Group { routine, elements: Vec::new(), axis, place: raw.place };
        self.0.entry(key).or_insert(group).elements.push(index);
    }

    /// The sections, each named after the component of the same elements or after its numbers.
    pub fn finish(self, reader: &mut Reader<'_>, named: impl Fn(&[usize]) -> Option<String>) -> Vec<Section> {
        let mut sections: Vec<Section> = Vec::new();
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        let all = materials::materials(&reader.model);
        for (Key { own, .. }, group) in self.0 {
            let Some((shape, material)) = shape(reader, &group, own) else { continue };
            let name = named(&group.elements).unwrap_or_else(|| {
                let of_section = match (own.real, own.section) {
                    (0, 0) => String::new(),
                    (real, section) => format!("_REAL_{real}_SECTION_{section}"),
                };
                format!("TYPE_{}_MATERIAL_{}{of_section}", own.kind, own.material)
            });
            let count = names.entry(name.clone()).or_insert(0);
            *count += 1;
            let name = if *count > 1 { format!("{name}_{count}") } else { name };
            let elastic = all.get(&own.material).and_then(|material| material.elastic);
            let axes = material_axes(reader, own, &group, elastic);
            let material = materials::name(material);
            sections.push(Section {
                name,
                elements: group.elements,
                material,
                axes,
                shape,
                place: group.place,
            });
        }
        sections
    }
}

/// The directions of a material that is not isotropic.
fn material_axes(
    reader: &mut Reader<'_>,
    own: Attributes,
    group: &Group,
    elastic: Option<Elastic>,
) -> Option<[[f64; 3]; 2]> {
    let orthotropic = matches!(elastic, Some(Elastic::Orthotropic { .. }));
    if !orthotropic || own.system == 0 || group.routine.family != Family::Solid {
        return None;
    }
    match reader.model.systems.get(&i64::from(own.system)).cloned() {
        Some(system) if system.kind == 0 => Some([system.axes[0], system.axes[1]]),
        Some(system) => {
            reader.unused_system(system.kind, group.place);
            None
        }
        None => {
            let found = format!("coordinate system {}, which is not there", own.system);
            reader.fault(group.place, found, "a system that LOCAL or CS defines");
            None
        }
    }
}

/// The direction of the y axis of a beam: across the plane of its axis and its third node; without one it is parallel to the xy plane.
fn first_axis(model: &Model, routine: &Routine, nodes: &[u64]) -> Option<[f64; 3]> {
    let at = |k: usize| nodes.get(k).and_then(|node| model.nodes.get(node)).map(|node| node.position);
    let (a, b) = (at(0)?, at(1)?);
    let along = unit(minus(b, a))?;
    // The node after those of the axis.
    let third = if routine.nodes_of[0].is_empty() { 2 } else { 3 };
    match at(third) {
        Some(c) => unit(cross(minus(c, a), along)),
        // Within 0.01 per cent of the z axis y is that of the coordinates.
        None if along[0].hypot(along[1]) < 1e-4 => Some([0.0, 1.0, 0.0]),
        None => unit(cross([0.0, 0.0, 1.0], along)),
    }
}

/// The shape of a section and the number of its material.
fn shape(reader: &mut Reader<'_>, group: &Group, own: Attributes) -> Option<(SectionShape, u32)> {
    let place = group.place;
    let section = reader.model.sections.get(&own.section).cloned().unwrap_or_default();
    let reals = reader.model.reals.get(&own.real).cloned().unwrap_or_default();
    let real = |k: u32| reals.get(&k).copied().unwrap_or(0.0);
    let number = |k: usize| section.data.first().and_then(|data| data.get(k)).copied().unwrap_or(0.0);
    // Elements of the second generation take a section where there is one.
    let old = matches!(group.routine.number, 63 | 43 | 93 | 4 | 8);
    let positive = |x: f64| Some(x).filter(|x| *x > 0.0);
    let found = match group.routine.family {
        Family::Solid => return Some((SectionShape::Solid, own.material)),
        Family::Shell if !old && section.kind.starts_with("SHEL") && !section.data.is_empty() => {
            let material = match number(1) as u32 {
                0 => own.material,
                material => material,
            };
            if section.data.iter().any(|layer| layer.get(1).copied().unwrap_or(0.0) != number(1)) {
                reader.note(
                    Weight::Matters,
                    "SECDATA",
                    "layers of several materials: that of the first is taken",
                    place,
                );
            }
            if section.data.iter().any(|layer| layer.get(2).is_some_and(|angle| *angle != 0.0)) {
                reader.note(Weight::Matters, "SECDATA", "angles of layers are not read", place);
            }
            let thickness = section.data.iter().filter_map(|layer| layer.first()).sum();
            return positive(thickness).map(|thickness| (SectionShape::Shell { thickness }, material));
        }
        Family::Shell => {
            if (2..5).any(|k| real(k) != 0.0 && real(k) != real(1)) {
                reader.note(
                    Weight::Matters,
                    "real constants",
                    "a thickness that changes: that of the first node is taken",
                    place,
                );
            }
            positive(real(1)).map(|thickness| SectionShape::Shell { thickness })
        }
        Family::Link => {
            let area = if section.kind == "LINK" && !old { number(0) } else { real(1) };
            positive(area).map(|area| SectionShape::Truss { area })
        }
        _ => {
            let form = section.form.get(..4).unwrap_or(&section.form);
            let profile = match form {
                _ if old => Some(Profile::General {
                    area: real(1),
                    second_moments: [real(2), real(3)],
                    torsion: if real(8) > 0.0 { real(8) } else { real(2) + real(3) },
                }),
                "CSOL" => Some(Profile::Round { diameter: 2.0 * number(0) }),
                "RECT" => Some(rectangle(number(0), number(1))),
                "CTUB" => Some(tube(number(0), number(1))),
                "ASEC" => Some(Profile::General {
                    area: number(0),
                    second_moments: [number(3), number(1)],
                    torsion: number(5),
                }),
                _ => None,
            };
            if form == "ASEC" && number(2) != 0.0 {
                reader.note(Weight::Matters, "SECDATA", "a product of inertia is not read", place);
            }
            let sound = |profile: &Profile| match profile {
                Profile::Round { diameter } => *diameter > 0.0,
                Profile::General { area, second_moments, torsion } => {
                    [*area, second_moments[0], second_moments[1], *torsion].iter().all(|x| *x > 0.0)
                }
            };
            let profile = profile.filter(sound);
            profile.map(|profile| SectionShape::Beam {
                profile,
                first_axis: group.axis.filter(|_| !matches!(profile, Profile::Round { .. })),
            })
        }
    };
    if found.is_none() {
        let what = format!(
            "section of {} with real constants {} and section {}",
            group.routine.name, own.real, own.section
        );
        let why = format!(
            "no thickness, area or form that is read{}",
            if section.form.is_empty() { String::new() } else { format!(": `{}`", section.form) }
        );
        reader.note(Weight::Matters, what, why, place);
    }
    found.map(|shape| (shape, own.material))
}

/// A rectangle, b along y and h along z: A = bh, ∫y² dA = hb³/12, ∫z² dA = bh³/12, and J by the series of St Venant.
fn rectangle(b: f64, h: f64) -> Profile {
    let (long, short) = (b.max(h), b.min(h));
    let term = |k: u32| {
        let n = f64::from(2 * k + 1);
        (n * PI * long / (2.0 * short)).tanh() / n.powi(5)
    };
    let series: f64 = (0..50).map(term).sum();
    let torsion = long * short.powi(3) * (1.0 / 3.0 - 64.0 / PI.powi(5) * short / long * series);
    Profile::General { area: b * h, second_moments: [h * b.powi(3) / 12.0, b * h.powi(3) / 12.0], torsion }
}

/// A tube between two radii.
fn tube(inner: f64, outer: f64) -> Profile {
    let second = PI / 4.0 * (outer.powi(4) - inner.powi(4));
    Profile::General {
        area: PI * (outer * outer - inner * inner),
        second_moments: [second; 2],
        torsion: 2.0 * second,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin, within};

    /// J of a square is 0.140577 a⁴ (Timoshenko, Goodier, Theory of Elasticity, section 109, has 0.1406).
    #[test]
    fn a_square_twists_as_published() {
        let Profile::General { torsion, second_moments, .. } = rectangle(2.0, 2.0) else { panic!() };
        assert!(within((torsion / 16.0 - 0.1406).abs(), 5e-4, Origin::Reference));
        assert_eq!(second_moments, [16.0 / 12.0; 2]);
    }
}
