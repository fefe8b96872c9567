//! Writes MSH 4.1 ASCII with physical names.

use super::{CellKind, Mesh};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use stridor_base::error::{Error, Fault, Result};
use stridor_base::numbers::components;

/// Writes `mesh` to `path` in units of `unit_in_metres` (0.001: millimetres), rounded to 10⁻⁹ of the largest
/// coordinate. The same mesh gives the same bytes.
///
/// # Errors
/// See [`to_msh`]; a file that cannot be written.
pub fn write(path: &Path, mesh: &Mesh, unit_in_metres: f64) -> Result<()> {
    let text = to_msh(mesh, unit_in_metres)?;
    std::fs::write(path, text).map_err(|error| match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.exists() => {
            let help = "Make it with `mkdir -p`, or name a file in another folder";
            Error::io(folder, "there is no such folder", help)
        }
        _ => Error::io(path, error, "Choose a folder that can be written to"),
    })
}

/// The text of an MSH 4.1 file. Elements of the same regions form one entity; elements of no region are kept in
/// an entity without a physical group, as Gmsh does. Tags are indices + 1, so that faults found later can be
/// found in the mesh that was written.
///
/// # Errors
/// A mesh whose coordinates are not finite, a unit that is not positive, region names with a quotation mark or
/// a line break.
pub fn to_msh(mesh: &Mesh, unit_in_metres: f64) -> Result<String> {
    let largest = mesh.nodes.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs())) / unit_in_metres;
    text(mesh, unit_in_metres, 10f64.powf((largest * 1e-9).log10().floor()))
}

/// The same in metres, and every coordinate is read as it is here.
///
/// # Errors
/// See [`to_msh`].
pub fn to_msh_exactly(mesh: &Mesh) -> Result<String> {
    text(mesh, 1.0, 0.0)
}

/// The text with coordinates that are multiples of a power of ten, or as they are where that is zero.
fn text(mesh: &Mesh, unit_in_metres: f64, digit: f64) -> Result<String> {
    refuse(mesh, unit_in_metres)?;
    let names = physical_tags(mesh);
    let entities = entities(mesh);
    let mut out = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    // Writing to a String cannot fail.
    let mut line = |text: std::fmt::Arguments<'_>| writeln!(out, "{text}").expect("memory");

    line(format_args!("$PhysicalNames\n{}", names.len()));
    for (region, tag) in mesh.regions.iter().zip(&names) {
        line(format_args!("{} {tag} \"{}\"", region.dimension, region.name));
    }
    line(format_args!("$EndPhysicalNames\n$Entities"));
    let count = |dimension: usize| entities.keys().filter(|(d, _)| *d == dimension).count();
    line(format_args!("{} {} {} {}", count(0), count(1), count(2), count(3)));
    let mut seen = [0; 4];
    let mut entity_tags = Vec::new();
    for ((dimension, regions), elements) in &entities {
        seen[*dimension] += 1;
        entity_tags.push(seen[*dimension]);
        let corners = corners(mesh, elements).map(|p| p.map(|c| c / unit_in_metres));
        let mut text = format!("{}", seen[*dimension]);
        for corner in corners.iter().take(if *dimension == 0 { 1 } else { 2 }) {
            for c in corner {
                write!(text, " {}", rounded(*c, digit)).expect("memory");
            }
        }
        write!(text, " {}", regions.len()).expect("memory");
        for region in regions {
            write!(text, " {}", names[*region]).expect("memory");
        }
        if *dimension > 0 {
            text += " 0";
        }
        line(format_args!("{text}"));
    }
    line(format_args!("$EndEntities\n$Nodes"));

    // All nodes in one block: stridor and Gmsh take coordinates from there whatever entity they are listed under.
    let home = entities.keys().zip(&entity_tags).next_back();
    let (dimension, tag) = home.map_or((0, 0), |((dimension, _), tag)| (*dimension, *tag));
    let n = mesh.nodes.len();
    line(format_args!("{} {n} 1 {n}", usize::from(n > 0)));
    if n > 0 {
        line(format_args!("{dimension} {tag} 0 {n}"));
    }
    (1..=n).for_each(|i| line(format_args!("{i}")));
    for p in &mesh.nodes {
        let [x, y, z] = p.map(|c| rounded(c / unit_in_metres, digit));
        line(format_args!("{x} {y} {z}"));
    }
    line(format_args!("$EndNodes\n$Elements"));

    // A block holds one kind of element of one entity.
    let mut blocks = Vec::new();
    for (((dimension, _), elements), tag) in entities.iter().zip(&entity_tags) {
        for kind in CellKind::all() {
            let block: Vec<usize> =
                elements.iter().copied().filter(|e| mesh.elements[*e].kind() == kind).collect();
            if !block.is_empty() {
                blocks.push((*dimension, *tag, kind, block));
            }
        }
    }
    let m = mesh.elements.len();
    line(format_args!("{} {m} 1 {m}", blocks.len()));
    for (dimension, tag, kind, block) in blocks {
        line(format_args!("{dimension} {tag} {} {}", kind.table().gmsh.number, block.len()));
        for e in block {
            let nodes = kind.table().gmsh.order.to_file(mesh.elements[e].nodes());
            let nodes: Vec<String> = nodes.iter().map(|n| (n + 1).to_string()).collect();
            line(format_args!("{} {}", e + 1, nodes.join(" ")));
        }
    }
    line(format_args!("$EndElements"));
    Ok(out)
}

fn refuse(mesh: &Mesh, unit_in_metres: f64) -> Result<()> {
    let fault =
        |place: &str, found: String, expected: &str| Err(Error::input(Fault::new(place, found, expected)));
    if !(unit_in_metres.is_finite() && unit_in_metres > 0.0) {
        return fault("mesh unit", unit_in_metres.to_string(), "a positive number of metres");
    }
    if let Some(n) = mesh.nodes.iter().position(|p| p.iter().any(|c| !c.is_finite())) {
        return fault(
            "mesh to be written",
            format!("node {} at {}", n + 1, components(mesh.nodes[n])),
            "finite coordinates",
        );
    }
    if let Some(r) = mesh.regions.iter().find(|r| r.name.contains(['"', '\n', '\r'])) {
        return fault(
            "mesh to be written",
            format!("a region called {:?}", r.name),
            "names without \" and line breaks",
        );
    }
    Ok(())
}

/// A number for each region, counted from 1 in each dimension.
fn physical_tags(mesh: &Mesh) -> Vec<usize> {
    let mut next = [0; 4];
    let mut number = |dimension: usize| {
        next[dimension.min(3)] += 1;
        next[dimension.min(3)]
    };
    mesh.regions.iter().map(|region| number(region.dimension)).collect()
}

/// Elements by dimension and the regions they belong to.
fn entities(mesh: &Mesh) -> BTreeMap<(usize, Vec<usize>), Vec<usize>> {
    let mut regions_of = vec![Vec::new(); mesh.elements.len()];
    for (r, region) in mesh.regions.iter().enumerate() {
        region.elements.iter().for_each(|e| regions_of[*e].push(r));
    }
    let mut entities = BTreeMap::new();
    for (e, regions) in regions_of.into_iter().enumerate() {
        entities.entry((mesh.elements[e].dimension(), regions)).or_insert_with(Vec::new).push(e);
    }
    entities
}

/// Lowest and highest coordinates of some elements.
fn corners(mesh: &Mesh, elements: &[usize]) -> [[f64; 3]; 2] {
    let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for n in elements.iter().flat_map(|e| mesh.elements[*e].nodes()) {
        let p = mesh.nodes[*n];
        corners = [[0, 1, 2].map(|k| corners[0][k].min(p[k])), [0, 1, 2].map(|k| corners[1][k].max(p[k]))];
    }
    corners
}

/// `value` to the nearest multiple of `digit`, a power of ten, in its shortest form and without −0.
fn rounded(value: f64, digit: f64) -> f64 {
    let places = (-digit.log10()).round();
    if !(0.0..=300.0).contains(&places) {
        return value + 0.0;
    }
    // Through text: multiplying by 10ⁿ and back would leave digits of rounding.
    format!("{value:.*}", places as usize).parse::<f64>().map_or(value, |v| v + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{Faces, RigSpec, rig, structured_plate};
    use crate::gmsh;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn what_is_written_is_read_back() {
        for mesh in [
            rig(&RigSpec::small()).unwrap(),
            structured_plate(0.2, 0.1, 4, 3, Faces::Quadrilaterals).unwrap(),
        ] {
            let text = to_msh(&mesh, 1e-3).unwrap();
            let back = gmsh::parse(text.as_bytes(), "memory", 1e-3).unwrap();
            assert_eq!((&back.elements, &back.regions), (&mesh.elements, &mesh.regions));
            for (p, q) in mesh.nodes.iter().zip(&back.nodes) {
                (0..3)
                    .for_each(|k| assert!(within((p[k] - q[k]).abs(), 1e-9 * 0.2, Reference), "{p:?} {q:?}"));
            }
            assert!(text == to_msh(&back, 1e-3).unwrap(), "writing again gives other bytes");
        }
    }

    #[test]
    fn an_element_of_two_regions_keeps_both() {
        let mut mesh = structured_plate(0.2, 0.1, 2, 1, Faces::Triangles).unwrap();
        mesh.regions.push(crate::Region { name: "half".into(), dimension: 2, elements: vec![0, 1] });
        let back = gmsh::parse(to_msh(&mesh, 1.0).unwrap().as_bytes(), "memory", 1.0).unwrap();
        assert_eq!(back.regions, mesh.regions);
    }

    #[test]
    fn what_would_make_a_broken_file_is_refused() {
        let mut mesh = structured_plate(0.2, 0.1, 2, 1, Faces::Triangles).unwrap();
        assert!(to_msh(&mesh, 0.0).is_err());
        mesh.regions[0].name = "a\"b".into();
        assert!(to_msh(&mesh, 1.0).is_err());
        mesh.regions[0].name = "a".into();
        mesh.nodes[0][0] = f64::NAN;
        assert!(to_msh(&mesh, 1.0).is_err());
    }
}
