//! How far plates bend in motion, beside their thickness, how far solids turn, and how deep contacts are pressed.

use super::depth::Depths;
use super::rotation::Rotations;
use super::snapshots::Snapshots;
use crate::error::Result;
use crate::job::prepared::Prepared;
use crate::structure::{Part, Shell};
use crate::transient::{Checkpoint, Marched, TransientModel};
use nalgebra::{Matrix3, Vector3};

/// The motion is looked at this many times in a run, at equal distances.
const LOOKS: usize = 256;
/// The deflection, as a part of the thickness, up to which a plate bends linearly: beyond it stretches, and its stiffness
/// rises (S. P. Timoshenko & S. Woinowsky-Krieger, Theory of Plates and Shells, 1959, ch. 13).
const LINEAR: f64 = 1.0;

/// The largest deflections of the plates of a run, rotations of its solids and penetrations of its contacts.
pub(super) struct Deflections<'a> {
    nodes: Snapshots<'a>,
    every: usize,
    plates: Vec<Plate<'a>>,
    solids: Rotations<'a>,
    contacts: Depths,
}

/// A plate: its nodes, where they are in its mean plane, and its normal.
struct Plate<'a> {
    part: &'a Part,
    shell: &'a Shell,
    nodes: Vec<usize>,
    /// 1, x, y of each node, the lengths as parts of the size of the plate.
    places: Vec<Vector3<f64>>,
    normal: Vector3<f64>,
    /// The inverse of Σ (1, x, y)(1, x, y)ᵀ.
    inverse: Matrix3<f64>,
    /// max |w| so far \[m\].
    largest: f64,
}

impl<'a> Deflections<'a> {
    /// Those of the parts and contacts of `prepared` in a run of so many steps.
    pub(super) fn new(prepared: &'a Prepared<'_>, nodes: Snapshots<'a>, steps: usize) -> Self {
        let model = &prepared.model;
        let plates =
            model.shells().filter_map(|(part, shell)| Plate::new(part, shell, &model.nodes)).collect();
        let (solids, contacts) = (Rotations::new(model), Depths::new(prepared));
        Deflections { nodes, every: steps.div_ceil(LOOKS).max(1), plates, solids, contacts }
    }

    /// Looks at the motion, where it is time for it, and at the contacts.
    pub(super) fn take(&mut self, model: &TransientModel<'_>, marched: &Marched) {
        self.contacts.take(model, marched);
        let none = self.plates.is_empty() && self.solids.are_none();
        if none || !marched.step.is_multiple_of(self.every) {
            return;
        }
        self.solids.take(&self.nodes.of_all(marched.state.motion.col_as_slice(0)));
        let [moved, _] = self.nodes.take(&marched.state);
        for plate in &mut self.plates {
            let moved = plate
                .nodes
                .iter()
                .map(|node| Vector3::from_column_slice(&moved[*node][..3]))
                .collect::<Vec<_>>();
            plate.largest = plate.largest.max(plate.deflection(&moved));
        }
    }

    /// Adds what the warnings depend on.
    pub(super) fn put(&self, checkpoint: &mut Checkpoint) {
        let largest: Vec<f64> = self.plates.iter().map(|plate| plate.largest).collect();
        checkpoint.put("deflections", &largest);
        self.solids.put(checkpoint);
        self.contacts.put(checkpoint);
    }

    /// Goes on from what was put away.
    pub(super) fn restore(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        let mut largest = vec![0.0; self.plates.len()];
        checkpoint.get("deflections", &mut largest)?;
        self.plates.iter_mut().zip(largest).for_each(|(plate, largest)| plate.largest = largest);
        self.solids.restore(checkpoint)?;
        self.contacts.restore(checkpoint)
    }

    /// Plates that bend, solids that turn and contacts that are pressed by more than the model can mean.
    pub(super) fn warnings(&self) -> Vec<String> {
        let words = |plate: &Plate| {
            let (name, thickness) = (&plate.part.name, plate.shell.thickness);
            format!(
                "In motion the plate {name} bends by {:.3} mm, {:.1} times its thickness of {:.3} mm: plates are linear here, which they \
                 are up to about one thickness; beyond, they stretch and stiffen. Amplitudes of this run have no meaning, \
                 only its beginning has.",
                1e3 * plate.largest,
                plate.largest / thickness,
                1e3 * thickness
            )
        };
        let far = |plate: &&Plate| plate.largest > LINEAR * plate.shell.thickness;
        let plates = self.plates.iter().filter(far).map(words);
        plates.chain(self.solids.warnings()).chain(self.contacts.warnings()).collect()
    }
}

impl<'a> Plate<'a> {
    /// `None` of a part without a mean normal, such as a tube.
    fn new(part: &'a Part, shell: &'a Shell, all: &[[f64; 3]]) -> Option<Self> {
        let nodes = part.nodes();
        let at = |node: usize| Vector3::from(all[node]);
        let area = |corners: &[usize]| -> Vector3<f64> {
            (1..corners.len().saturating_sub(1))
                .map(|k| {
                    0.5 * (at(corners[k]) - at(corners[0])).cross(&(at(corners[k + 1]) - at(corners[0])))
                })
                .sum()
        };
        let areas: Vec<Vector3<f64>> = part.cells.iter().map(|face| area(face.nodes())).collect();
        let whole: Vector3<f64> = areas.iter().sum();
        if whole.norm() < 0.5 * areas.iter().map(|a| a.norm()).sum::<f64>() || whole.norm() == 0.0 {
            return None;
        }
        let normal = whole.normalize();
        let across = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
        let other = normal.cross(&across);
        let size = whole.norm().sqrt();
        let middle: Vector3<f64> =
            nodes.iter().map(|node| at(*node)).sum::<Vector3<f64>>() / nodes.len() as f64;
        let place = |node: &usize| {
            let from = (at(*node) - middle) / size;
            Vector3::new(1.0, from.dot(&across), from.dot(&other))
        };
        let places: Vec<Vector3<f64>> = nodes.iter().map(place).collect();
        let inverse = places.iter().map(|p| p * p.transpose()).sum::<Matrix3<f64>>().try_inverse()?;
        Some(Plate { part, shell, nodes, places, normal, inverse, largest: 0.0 })
    }

    /// max |w| \[m\] of the motion along the normal without what moves the plate as a whole, w = a + b x + c y by least squares.
    fn deflection(&self, moved: &[Vector3<f64>]) -> f64 {
        let along: Vec<f64> = moved.iter().map(|u| u.dot(&self.normal)).collect();
        let whole = self.inverse * self.places.iter().zip(&along).map(|(p, w)| p * *w).sum::<Vector3<f64>>();
        let bent = self.places.iter().zip(&along).map(|(p, w)| (w - whole.dot(p)).abs());
        bent.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use crate::case::Case;
    use crate::job::{Prepared, Selection, analyse};
    use crate::results::TransientResult;

    /// A pad of solids under a blow that presses it through the disc and turns it, and under one that it bears.
    #[test]
    fn solids_that_turn_and_contacts_that_are_pressed_through_are_warned_of() {
        let meshes = concat!(env!("CARGO_MANIFEST_DIR"), "/meshes/");
        let case = include_str!("../../../validation/solid-brake/case.toml")
            .replace("../../meshes/", meshes)
            .replace("loss_factor = 0.02", "rayleigh = { beta = \"1 us\" }")
            .replace("8 kHz", "2 kHz")
            .replace("[modes.disc]\nparts = [\"disc\"]\nbelow = \"6 kHz\"\n", "");
        let warnings = |force: &str| {
            let motion = format!(
                "[transient]\nduration = \"0.5 ms\"\ntime_step = \"10 us\"\n\
                 push.blow = {{ on = \"pad_back\", force = {force}, duration = \"1 ms\" }}\n"
            );
            let case = Case::parse("case.toml", &format!("{case}{motion}"), ".".into()).unwrap();
            let prepared = Prepared::new(&case).unwrap();
            let mut results = analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &()).unwrap();
            results.take::<TransientResult>().unwrap().warnings.join("\n")
        };
        let far = warnings("[\"8 MN\", 0, \"-30 MN\"]");
        assert!(
            far.contains("the solid pad turns by") && far.contains("the contact face is pressed"),
            "{far}"
        );
        let near = warnings("[\"8 N\", 0, \"-30 N\"]");
        assert!(!near.contains("turns by") && !near.contains("is pressed"), "{near}");
    }
}
