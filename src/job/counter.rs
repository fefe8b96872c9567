//! The faces that the counter-body of a contact offers, or the master of a tie.

use super::regions::Regions;
use crate::error::{Error, Fault, Result, nearest};
use crate::mesh::{Cell, made_of};
use crate::structure::{Model, Part};

/// The faces that a contact touches, and the part that they are of.
pub struct CounterFaces<'a> {
    /// A shell or a solid.
    pub part: &'a Part,
    /// All faces of a shell, or those of a region.
    pub faces: Vec<Cell>,
}

/// The faces that the counter-body `name` of a contact offers: a shell, or a region of faces on a solid or a shell. `beside` is what else
/// may stand at `place`.
///
/// # Errors
/// A name that is neither.
pub fn counter_faces<'a>(
    name: &str,
    regions: &Regions,
    model: &'a Model,
    (place, beside): (&str, &str),
) -> Result<CounterFaces<'a>> {
    if let Some(part) = model.part(name).filter(|part| part.as_shell().is_some()) {
        return Ok(CounterFaces { part, faces: part.cells.clone() });
    }
    let known: Vec<&str> = model.shells().map(|(part, _)| part.name.as_str()).collect();
    let expected = match known.len() {
        0 => format!("a region of faces on a solid{beside}"),
        _ => format!("one of the case's shells ({}), a region of faces on a solid{beside}", known.join(", ")),
    };
    let fault = |found: String, help: &str| Error::input(Fault::new(place, found, expected).with_help(help));
    if regions.mesh.region(name).is_none() {
        let faces = regions.mesh.regions.iter().filter(|region| region.dimension == 2);
        let names = known.iter().copied().chain(faces.map(|region| region.name.as_str()));
        let help = nearest(name, names).map_or(String::new(), |near| format!("Did you mean \"{near}\"?"));
        return Err(fault(format!("\"{name}\""), &help));
    }
    let region = regions.region(name, place)?;
    if region.dimension != 2 {
        let help = "Give the faces that are touched a name of their own, as a physical surface of the mesh";
        return Err(fault(format!("\"{name}\", a region of {}", made_of(region.dimension)), help));
    }
    let nodes = regions.mesh.region_nodes(region);
    let Some(part) = model.part_with(&nodes) else {
        return Err(fault(
            format!("region \"{name}\", whose nodes are not all on one shell or one solid"),
            "",
        ));
    };
    match part.outward(regions.cells(region)) {
        Some(faces) => Ok(CounterFaces { part, faces }),
        None => Err(fault(
            format!("region \"{name}\", some of whose faces are not on the skin of `{}`", part.name),
            "",
        )),
    }
}
