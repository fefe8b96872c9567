//! The faces that the counter-body of a contact offers, or the master of a tie.

use super::regions::Regions;
use crate::error::{Error, Fault, Result, nearest};
use crate::mesh::{Cell, made_of, outward};
use crate::structure::{Model, Part};

/// The faces that a contact touches, and the part that they are of.
pub struct CounterFaces<'a> {
    /// A shell or a solid; the first of several solids, on whose faces the displacement is that of their nodes likewise.
    pub part: &'a Part,
    /// All of them.
    pub parts: Vec<&'a Part>,
    /// All faces of a shell, or those of a region.
    pub faces: Vec<Cell>,
}

/// The faces that the counter-body `name` of a contact offers: a shell, or a region of faces on solids or a shell. `beside` is what else
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
        return Ok(CounterFaces { part, parts: vec![part], faces: part.cells.clone() });
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
    let parts = model.parts_with(&nodes);
    let Some(part) = parts.first().copied() else {
        let found = format!("region \"{name}\", whose nodes are not all on one shell or on solids");
        return Err(fault(found, "Of several shells, give each a contact of its own"));
    };
    let faces = match part.kind.dimension() {
        3 => outward(parts.iter().flat_map(|part| &part.cells), &regions.cells(region)),
        _ => part.outward(regions.cells(region)),
    };
    match faces {
        Some(faces) => Ok(CounterFaces { part, parts, faces }),
        None => {
            let names: Vec<&str> = parts.iter().map(|part| part.name.as_str()).collect();
            let names = names.join("`, `");
            Err(fault(format!("region \"{name}\", some of whose faces are not on the skin of `{names}`"), ""))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::bounds::{Origin::*, within};
    use crate::case::Case;
    use crate::equilibrium::{SteadySliding, steady_sliding};
    use crate::job::Prepared;
    use crate::mesh::generate::structured_box;
    use crate::mesh::{CellKind, Mesh, Region, write};

    /// A box of 100 × 40 × 10 mm, `left` and `right` of x = 40 mm, with a pad on it.
    fn mesh(kind: CellKind) -> Mesh {
        let named = |name: &str, size: [f64; 3], cells: [usize; 3], at: [f64; 3]| {
            let mut mesh = structured_box(kind, size, cells).unwrap();
            mesh.regions.iter_mut().for_each(|region| region.name = format!("{name}_{}", region.name));
            mesh.nodes.iter_mut().for_each(|x| (0..3).for_each(|k| x[k] += at[k]));
            mesh
        };
        let mut mesh = named("slider", [0.1, 0.04, 0.01], [10, 4, 1], [0.0; 3]);
        let solid = mesh.region("slider_solid").unwrap().elements.clone();
        let first = |cell: &usize| {
            let nodes = mesh.elements[*cell].nodes();
            nodes.iter().map(|node| mesh.nodes[*node][0]).sum::<f64>() < 0.04 * nodes.len() as f64
        };
        let (left, right): (Vec<usize>, Vec<usize>) = solid.into_iter().partition(first);
        for (name, elements) in [("left", left), ("right", right)] {
            mesh.regions.push(Region { name: name.into(), dimension: 3, elements });
        }
        mesh.append(named("pad", [0.05, 0.04, 0.01], [5, 3, 1], [0.02, 0.0, 0.01]));
        mesh
    }

    /// Faces of two solids that share nodes are those of one solid of both: the same points and forces.
    #[test]
    fn a_pad_rests_on_two_solids_as_on_one() {
        let folder = tempfile::tempdir().unwrap();
        for kind in [CellKind::Hexahedron8, CellKind::Hexahedron20, CellKind::Tetrahedron10] {
            write(&folder.path().join("m.msh"), &mesh(kind), 1.0).unwrap();
            let solve = |solids: &[&str]| -> SteadySliding {
                let solids: String =
                    solids.iter().map(|s| format!("[solid.{s}]\nmaterial = \"steel\"\n")).collect();
                let text = format!(
                    "[mesh]\nfile = \"m.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 7800\n\
                     {solids}[solid.pad_solid]\nmaterial = \"steel\"\n[support.floor]\non = \"slider_z_min\"\n[support.back]\non = \"pad_z_max\"\n\
                     [contact.pad]\nbody = \"pad_z_min\"\ncounter = \"slider_z_max\"\napproach = 1e-6\nsliding_velocity = 1\n\
                     normal = {{ per = \"area\", stiffness = 1e13 }}\nfriction = {{ law = \"coulomb\", mu0 = 0.3 }}\n[cea]\nband = [0, 1000]\n"
                );
                let case = Case::parse("a.toml", &text, folder.path().into()).unwrap();
                let prepared = Prepared::new(&case).unwrap_or_else(|error| panic!("{kind:?}: {error}"));
                steady_sliding(&prepared.system).unwrap()
            };
            let (one, two) = (solve(&["slider_solid"]), solve(&["left", "right"]));
            assert!(one.points.len() > 40 && one.points.len() == two.points.len(), "{kind:?}");
            let largest = one.points.iter().map(|p| p.forces.normal).fold(0.0, f64::max);
            for (a, b) in one.points.iter().zip(&two.points) {
                assert!(
                    within((a.forces.normal - b.forces.normal).abs(), 1e-9 * largest, RoundOff),
                    "{kind:?} {a:?} {b:?}"
                );
            }
        }
    }
}
