//! The size of the model.

use crate::case::MeshSource;
use crate::error::Fault;
use crate::job::prepared::Prepared;
use crate::mesh::unit_in_metres;
use crate::numbers::significant;
use std::ops::RangeInclusive;

/// The diagonal of the box about a model of something that squeals \[m\]: a hard disk's slider has 1 mm, a ship's shaft 30 m.
const DIAGONAL: RangeInclusive<f64> = 1e-3..=30.0;
/// Units that a mesh may be in beside the one that was said \[m\].
const UNITS: [(&str, f64); 4] = [("mm", 1e-3), ("m", 1.0), ("cm", 1e-2), ("in", 0.0254)];

pub fn warnings(prepared: &Prepared) -> Vec<Fault> {
    let case = prepared.case;
    let Some(mesh) = case.mesh.as_ref() else { return Vec::new() };
    let diagonal = diagonal(&prepared.model.nodes);
    if prepared.model.nodes.len() < 2 || DIAGONAL.contains(&diagonal) {
        return Vec::new();
    }
    let found = format!("a model {} m across", significant(diagonal, 3));
    let fault = Fault::new("`mesh`", found, "1 mm to 30 m");
    // The unit that gives a file the size of a machine's part.
    let help = match mesh {
        MeshSource::File { unit, .. } => {
            let raw = diagonal / unit_in_metres(unit.word());
            let likely = UNITS.into_iter().find(|(_, unit)| (0.02..=5.0).contains(&(raw * unit)));
            likely.map(|(name, _)| format!("Is the file in another unit? `unit = \"{name}\"`"))
        }
        _ => None,
    };
    vec![fault.with_help(help.unwrap_or_else(|| "Check the unit of its lengths".into()))]
}

/// The diagonal of the box about the nodes \[m\].
fn diagonal(nodes: &[[f64; 3]]) -> f64 {
    let extent = |axis: usize| {
        let values = nodes.iter().map(|node| node[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        high - low
    };
    (0..3).map(|axis| extent(axis).powi(2)).sum::<f64>().sqrt()
}
