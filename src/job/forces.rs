//! The forces of a case on the degrees of freedom.

use super::regions::Regions;
use crate::case::{Case, Force, ForceChoice};
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::SparseVector;
use crate::mesh::Cell;
use crate::structure::{Assembled, Model};
use nalgebra::Vector3;
use std::collections::HashSet;

/// Quadrature of a pressure on faces, exact on flat ones of second order.
const DEGREE: usize = 4;

/// The external force on the degrees of freedom \[N\].
///
/// # Errors
/// Regions that are missing, pressures on what has no faces.
pub fn external_load(
    case: &Case,
    regions: &Regions,
    model: &Model,
    assembled: &Assembled,
) -> Result<Vec<f64>> {
    let mut load = vec![0.0; assembled.dofs.n_dofs()];
    let mut faults = Faults::new();
    for (name, force) in &case.force {
        if let Some(form) = faults.take(force_form(name, force, (regions, model, assembled))) {
            form.add_to(1.0, &mut load);
        }
    }
    faults.into_result(load)
}

/// `[force.NAME]` on the degrees of freedom \[N\].
///
/// # Errors
/// As [`external_load`].
pub fn force_form(
    name: &str,
    force: &Force,
    (regions, model, assembled): (&Regions, &Model, &Assembled),
) -> Result<SparseVector> {
    let place = format!("`force.{name}.on`");
    match force.load {
        ForceChoice::Total { force: total } => {
            Ok(assembled.dofs.mean_motion(&regions.nodes(&force.on, &place)?, total))
        }
        ForceChoice::Pressure { pressure } => {
            pressed(pressure, &force.on, &place, (regions, model, assembled))
        }
    }
}

/// f = −p ∫ Nᵀn dA over faces of a solid, n outwards, or of a shell, n by the right hand about the nodes.
fn pressed(
    pressure: f64,
    on: &str,
    place: &str,
    (regions, model, assembled): (&Regions, &Model, &Assembled),
) -> Result<SparseVector> {
    let region = regions.region(on, place)?;
    let cells = regions.cells(region);
    let shell = model.parts.iter().filter(|part| part.as_shell().is_some()).find(|part| {
        let own: HashSet<&Cell> = part.cells.iter().collect();
        cells.iter().all(|cell| own.contains(cell))
    });
    let solid =
        || model.part_with(&regions.mesh.region_nodes(region)).filter(|part| part.as_shell().is_none());
    let faces = match (region.dimension, shell.or_else(solid)) {
        (2, Some(part)) => part.outward(cells).map(|faces| (part, faces)),
        _ => None,
    };
    let Some((part, faces)) = faces else {
        let found =
            format!("region \"{on}\", which is not one of faces of a shell or on the skin of a solid");
        let fault = Fault::new(place, found, "faces of one part of the case, which a `pressure` acts on");
        return Err(Error::input(fault.with_help("Push other regions by a `force`")));
    };
    let mut entries = Vec::new();
    for face in &faces {
        for point in face.kind().quadrature(DEGREE) {
            let [a, b, _] = face.tangents(&model.nodes, point.at);
            let force = -pressure * point.weight * Vector3::from(a).cross(&Vector3::from(b));
            for (node, component, moved) in part.displacement_at(&model.nodes, face, point.at) {
                entries.push((node, component, (0..3).map(|k| moved[k] * force[k]).sum()));
            }
        }
    }
    Ok(assembled.dofs.reduce(&entries))
}
