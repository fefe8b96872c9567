//! The plates of a case as the air sees them, and where one listens.

use super::super::prepared::Prepared;
use crate::case::{ON_AXIS, SoundAnalysis};
use crate::error::{Fault, Faults, Result};
use crate::linalg::SparseVector;
use crate::sound::{Air, Plate};
use crate::structure::ShellPart;
use faer::Mat;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// A plate is flat when its nodes are within this part of its extent of its plane.
const FLAT: f64 = 1e-3;

/// The plates of a case as the air sees them, and where one listens.
#[derive(Debug, Clone)]
pub struct Acoustics {
    pub(super) plates: Vec<Seen>,
    pub(super) microphones: Vec<(String, [f64; 3])>,
    pub(super) air: Air,
}

/// A plate as pistons at its nodes, each with its share of the area.
#[derive(Debug, Clone)]
pub(super) struct Seen {
    name: String,
    normal: [f64; 3],
    middle: [f64; 3],
    area: f64,
    /// The largest piston \[m²\].
    largest: f64,
    points: Vec<[f64; 3]>,
    /// The volume that each displaces as a linear form of the degrees of freedom \[m²\].
    forms: Vec<SparseVector>,
}

/// What listens to a case; asked for before anything is computed or written.
///
/// # Errors
/// Plates that are not flat, none at all, a microphone on a plate or in the plane of every one.
pub fn acoustics(prepared: &Prepared<'_>, wanted: &SoundAnalysis) -> Result<Acoustics> {
    let mut faults = Faults::new();
    let chosen = |part: &&ShellPart| wanted.plates.is_empty() || wanted.plates.contains(&part.name);
    let mut plates = Vec::new();
    for part in prepared.model.shells.iter().filter(chosen) {
        match Seen::new(prepared, part) {
            Some(plate) => plates.push(plate),
            None => faults.push(
                Fault::new(
                    "`transient.sound.plates`",
                    format!("`{}`, which is not flat", part.name),
                    "flat plates, for which Rayleigh's integral holds",
                )
                .with_help("List the flat ones in `plates`"),
            ),
        }
    }
    if plates.is_empty() && faults.0.is_empty() {
        faults.push(Fault::new("`transient.sound`", "a case without plates", "a case with a [shell]"));
    }
    let mut microphones = Vec::new();
    let largest = plates.iter().max_by(|a, b| a.area.total_cmp(&b.area));
    let discs = prepared.discs();
    let disc = plates.iter().find(|plate| discs.iter().any(|(name, _)| *name == plate.name));
    if let (Some(distance), Some(plate)) = (wanted.distance, disc.or(largest)) {
        let direction = wanted.direction.unwrap_or(plate.normal);
        let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        let at = [0, 1, 2].map(|k| plate.middle[k] + distance * direction[k] / length);
        microphones.push((ON_AXIS.to_string(), at));
    }
    microphones.extend(wanted.microphone.iter().map(|(name, m)| (name.clone(), m.at)));
    for (name, at) in &microphones {
        let place = match name.as_str() {
            ON_AXIS => "`transient.sound.distance`".to_string(),
            _ => format!("`transient.sound.microphone.{name}.at`"),
        };
        if let Some(plate) = plates.iter().find(|plate| plate.touches(*at)) {
            let found = format!("a place on `{}`", plate.name);
            faults.push(Fault::new(&place, found, "a place farther from it than its elements are wide"));
        } else if !plates.is_empty() && plates.iter().all(|plate| plate.side(*at) == 0.0) {
            let help = "There the sound of a plate's front and that of its back cancel";
            faults.push(
                Fault::new(&place, "a place in the plane of the plates", "one before or behind them")
                    .with_help(help),
            );
        }
    }
    let air = Air { density: wanted.air.density, speed: wanted.air.speed };
    faults.into_result(Acoustics { plates, microphones, air })
}

impl Seen {
    /// A shell part; `None` when it is not flat.
    fn new(prepared: &Prepared<'_>, part: &ShellPart) -> Option<Seen> {
        let nodes = &prepared.model.nodes;
        // The vector area of each node: a third of its triangles; a quadrilateral is four of half weight.
        let mut areas = BTreeMap::<usize, Vector3<f64>>::new();
        let at = |node: usize| Vector3::from(nodes[node]);
        let mut add = |[a, b, c]: [usize; 3], weight: f64| {
            let area = (at(b) - at(a)).cross(&(at(c) - at(a))) * (0.5 * weight / 3.0);
            for node in [a, b, c] {
                *areas.entry(node).or_default() += area;
            }
        };
        for face in &part.faces {
            match *face.nodes() {
                [a, b, c] => add([a, b, c], 1.0),
                [a, b, c, d] => {
                    [[a, b, c], [a, c, d], [a, b, d], [b, c, d]].into_iter().for_each(|t| add(t, 0.5));
                }
                _ => {}
            }
        }
        let whole: Vector3<f64> = areas.values().sum();
        let area = whole.norm();
        // The front is where the largest component of the normal is positive.
        let turn = whole[whole.iamax()].signum();
        let normal = whole * (turn / area);
        let share = |a: &Vector3<f64>| turn * a.dot(&normal);
        let middle: Vector3<f64> = areas.iter().map(|(node, a)| at(*node) * (share(a) / area)).sum();
        let from_middle = |node: &usize| at(*node) - middle;
        let extent = areas.keys().map(|n| from_middle(n).norm()).fold(0.0, f64::max);
        let flat = areas.keys().all(|n| from_middle(n).dot(&normal).abs() <= FLAT * extent);
        let form = |(node, a): (&usize, &Vector3<f64>)| {
            let entries: Vec<_> = (0..3).map(|c| (*node, c, turn * a[c])).collect();
            prepared.assembled.dofs.reduce(&entries)
        };
        (flat && area > 0.0).then(|| Seen {
            name: part.name.clone(),
            normal: normal.into(),
            middle: middle.into(),
            area,
            largest: areas.values().map(share).fold(0.0, f64::max),
            points: areas.keys().map(|n| nodes[*n]).collect(),
            forms: areas.iter().map(form).collect(),
        })
    }

    /// Whether a place is nearer than a piston is wide.
    fn touches(&self, at: [f64; 3]) -> bool {
        let square = |x: &[f64; 3]| (0..3).map(|c| (x[c] - at[c]).powi(2)).sum::<f64>();
        self.points.iter().any(|x| square(x) < self.largest)
    }

    fn side(&self, at: [f64; 3]) -> f64 {
        self.moving(&Mat::zeros(0, 0)).side(at)
    }

    /// The plate in its modes.
    pub(super) fn moving(&self, shapes: &Mat<f64>) -> Plate {
        let modes = shapes.ncols();
        let strength = Mat::from_fn(if modes > 0 { self.forms.len() } else { 0 }, modes, |i, m| {
            self.forms[i].dot(shapes.col_as_slice(m))
        });
        Plate {
            name: self.name.clone(),
            normal: self.normal,
            middle: self.middle,
            points: self.points.clone(),
            strength,
        }
    }
}
