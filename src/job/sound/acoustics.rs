//! Radiating surfaces, microphones and air of a case.

use crate::case::{ON_AXIS, SoundAnalysis};
use crate::error::{Error, Fault, Faults, Result};
use crate::job::counter::counter_faces;
use crate::job::discs::flat_sides;
use crate::job::prepared::Prepared;
use crate::mesh::Cell;
use crate::sound::{Acoustics, Air, Surface};
use crate::structure::Part;

const PLACE: &str = "`transient.sound.plates`";

/// Plates, flat faces of solids, microphones and air of a case, checked before anything is computed or written.
///
/// # Errors
/// Surfaces that are not flat, none at all, a microphone on one of them or where none is heard.
pub fn acoustics(prepared: &Prepared<'_>, wanted: &SoundAnalysis) -> Result<Acoustics> {
    let mut faults = Faults::new();
    let mut heard: Vec<Heard> = Vec::new();
    if wanted.plates.is_empty() {
        for part in &prepared.model.parts {
            // Of all solids those are heard that have flat sides.
            let all = faults.take(of_part(prepared, part).or_else(|error| match part.as_shell() {
                Some(_) => Err(error),
                None => Ok(Vec::new()),
            }));
            heard.extend(all.unwrap_or_default());
        }
        if heard.is_empty() && faults.0.is_empty() {
            let expected = "a case with a [shell], or with a [solid] that has flat sides";
            faults.push(Fault::new("`transient.sound`", "a case without plates and flat solids", expected));
        }
    }
    for name in &wanted.plates {
        let found = match prepared.model.part(name) {
            Some(part) if part.kind.dimension() > 1 => of_part(prepared, part),
            _ => of_region(prepared, name).map(|heard| vec![heard]),
        };
        heard.extend(faults.take(found).unwrap_or_default());
    }
    let discs = prepared.discs();
    let disc = heard.iter().find(|of| discs.iter().any(|(name, _)| *name == of.part));
    let largest = heard.iter().max_by(|a, b| a.surface.area.total_cmp(&b.surface.area));
    let mut microphones = Vec::new();
    if let (Some(distance), Some(Heard { surface, .. })) = (wanted.distance, disc.or(largest)) {
        let direction = wanted.direction.unwrap_or(surface.normal);
        let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        let at = [0, 1, 2].map(|k| surface.middle[k] + distance * direction[k] / length);
        microphones.push((ON_AXIS.to_string(), at));
    }
    microphones.extend(wanted.microphone.iter().map(|(name, m)| (name.clone(), m.at)));
    let plates: Vec<Surface> = heard.into_iter().map(|of| of.surface).collect();
    for (name, at) in &microphones {
        let place = match name.as_str() {
            ON_AXIS => "`transient.sound.distance`".to_string(),
            _ => format!("`transient.sound.microphone.{name}.at`"),
        };
        if let Some(plate) = plates.iter().find(|plate| plate.touches(*at)) {
            let found = format!("a place on `{}`", plate.name);
            faults.push(Fault::new(&place, found, "a place farther from it than its elements are wide"));
        } else if !plates.is_empty() && plates.iter().all(|plate| plate.side(*at) == 0.0) {
            let [found, expected, help] = match plates.iter().any(|plate| plate.is_behind(*at)) {
                true => [
                    "a place behind the faces",
                    "one in front of one of them",
                    "A face of a solid is heard on its outer side only",
                ],
                false => [
                    "a place in the plane of the plates",
                    "one before or behind them",
                    "There the sound of a plate's front and that of its back cancel",
                ],
            };
            faults.push(Fault::new(&place, found, expected).with_help(help));
        }
    }
    let air = Air { density: wanted.air.density, speed: wanted.air.speed };
    faults.into_result(Acoustics { plates, microphones, air })
}

/// A surface that is heard, and the part that it is of.
struct Heard {
    surface: Surface,
    part: String,
}

/// A shell, both sides of which are heard, or the two flat sides of a solid.
fn of_part(prepared: &Prepared<'_>, part: &Part) -> Result<Vec<Heard>> {
    if part.as_shell().is_some() {
        return surface(prepared, part, &part.name, &part.cells).map(|heard| vec![heard]);
    }
    let sides = match part.kind.dimension() {
        3 => flat_sides(part, &prepared.model.nodes),
        _ => Default::default(),
    };
    let sides = ["front", "back"].into_iter().zip(sides).filter(|(_, faces)| !faces.is_empty());
    let all = sides.map(|(side, faces)| surface(prepared, part, &format!("{}_{side}", part.name), &faces));
    let all = all.collect::<Result<Vec<Heard>>>()?;
    if all.is_empty() { Err(not_flat(&part.name)) } else { Ok(all) }
}

/// A region of faces on a shell or a solid.
fn of_region(prepared: &Prepared<'_>, name: &str) -> Result<Heard> {
    let faces =
        counter_faces(name, &prepared.regions, &prepared.model, (PLACE, ", a solid with flat sides"))?;
    surface(prepared, faces.part, name, &faces.faces)
}

fn surface(prepared: &Prepared<'_>, part: &Part, name: &str, faces: &[Cell]) -> Result<Heard> {
    let pieces = faces.iter().flat_map(Cell::pieces);
    let (dofs, both_sides) = (&prepared.assembled.dofs, part.as_shell().is_some());
    let surface =
        Surface::new(name, &prepared.model.nodes, (pieces, both_sides), &|terms| dofs.reduce(terms));
    surface.map(|surface| Heard { surface, part: part.name.clone() }).ok_or_else(|| not_flat(name))
}

fn not_flat(name: &str) -> Error {
    let found = format!("`{name}`, which is not flat");
    let fault = Fault::new(PLACE, found, "flat plates and faces, for which Rayleigh's integral holds");
    Error::input(
        fault.with_help("List the flat ones in `plates`: shells, solids with flat sides, regions of faces"),
    )
}
