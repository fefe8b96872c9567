//! Radiating plates, microphones and air of a case.

use super::super::prepared::Prepared;
use crate::case::{ON_AXIS, SoundAnalysis};
use crate::error::{Fault, Faults, Result};
use crate::sound::{Acoustics, Air, Surface};
use crate::structure::Part;

/// Plates, microphones and air of a case, checked before anything is computed or written.
///
/// # Errors
/// Plates that are not flat, none at all, a microphone on a plate or in the plane of every one.
pub fn acoustics(prepared: &Prepared<'_>, wanted: &SoundAnalysis) -> Result<Acoustics> {
    let mut faults = Faults::new();
    let chosen = |part: &&Part| wanted.plates.is_empty() || wanted.plates.contains(&part.name);
    let mut plates = Vec::new();
    for part in prepared.model.shells().map(|(part, _)| part).filter(chosen) {
        match surface(prepared, part) {
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

/// A shell part; `None` when it is not flat.
fn surface(prepared: &Prepared<'_>, part: &Part) -> Option<Surface> {
    let faces = part.cells.iter().map(|face| face.nodes());
    let dofs = &prepared.assembled.dofs;
    Surface::new(&part.name, &prepared.model.nodes, faces, &|terms| dofs.reduce(terms))
}
