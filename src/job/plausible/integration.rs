//! Solids whose cells do not have the reduced integration that is asked for.

use crate::error::Fault;
use crate::mesh::CellKind;
use crate::schema::dotted;
use crate::structure::{Integration, Model};

pub fn warnings(model: &Model) -> Vec<Fault> {
    let warning = |part: &crate::structure::Part| {
        let solid = part.as_solid()?;
        let others = part.cells.iter().filter(|cell| cell.kind() != CellKind::Hexahedron20).count();
        (solid.integration == Integration::Reduced && others > 0).then(|| {
            let place = format!("`solid.{}.integration`", dotted(&part.name));
            let found = format!("\"reduced\", and {others} of {} cells of other kinds", part.cells.len());
            let help = "The others keep their full integration: remove the key, or make the mesh of 20-node hexahedra";
            Fault::new(place, found, "20-node hexahedra").with_help(help)
        })
    };
    model.parts.iter().filter_map(warning).collect()
}
