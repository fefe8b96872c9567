//! A disc brake with a floating calliper.

use super::{structured_box, structured_ring};
use crate::{Cell, CellKind, Mesh};
use stridor_base::error::Result;

/// A disc of 280 × 12 mm with a hub of 130 mm about the z axis, linings and backplates on both of its faces, and a calliper over its rim, of 20-node
/// hexahedra in meshes that do not match. Regions: `disc`, `linings`, `backplates`, `calliper` (solids); `hub`, `disc_faces`, `lining_faces`, `lining_backs`,
/// `plate_faces`, `plate_backs`, `seats` (finger and piston, in the middle of the plates) and `calliper_back` (faces).
///
/// # Errors
/// None but of memory.
pub fn disc_brake() -> Result<Mesh> {
    let mut brake = structured_ring(CellKind::Hexahedron20, [0.065, 0.14], 0.012, [3, 40, 1])?;
    brake.nodes.iter_mut().for_each(|x| x[2] -= 0.006);
    brake.regions.retain(|region| region.name == "disc" || region.name == "hub");
    flat(&mut brake, "disc_faces", &[-6.0, 6.0]);
    let both_sides = |_, storey| storey != 1;
    let mut linings =
        sector("linings", &[92.0, 112.0, 132.0], &[-16.0, -6.0, 6.0, 16.0], (50.0, 6), both_sides)?;
    flat(&mut linings, "lining_faces", &[-6.0, 6.0]);
    flat(&mut linings, "lining_backs", &[-16.0, 16.0]);
    let mut plates =
        sector("backplates", &[90.0, 112.0, 134.0], &[-21.0, -16.0, 16.0, 21.0], (56.0, 5), both_sides)?;
    flat(&mut plates, "plate_faces", &[-16.0, 16.0]);
    flat(&mut plates, "plate_backs", &[-21.0, 21.0]);
    // Finger and piston are 3 mm high on the arms, which a bridge joins outside of the disc.
    let heights = [-45.0, -24.0, -21.0, 21.0, 24.0, 40.0];
    let full = |ring, storey| match storey {
        0 | 4 => true,
        1 | 3 => ring != 1,
        _ => ring == 2,
    };
    let mut calliper = sector("calliper", &[100.0, 126.0, 150.0, 170.0], &heights, (36.0, 4), full)?;
    flat(&mut calliper, "seats", &[-21.0, 21.0]);
    flat(&mut calliper, "calliper_back", &[-45.0]);
    [linings, plates, calliper].into_iter().for_each(|part| brake.append(part));
    Ok(brake)
}

/// Bricks between `radii` and between `heights` \[mm\], `around` of them over `angle` degrees about the x axis, where `full` says so of the intervals
/// of radius and of height.
fn sector(
    name: &str,
    radii: &[f64],
    heights: &[f64],
    (angle, around): (f64, usize),
    full: impl Fn(usize, usize) -> bool,
) -> Result<Mesh> {
    let cells = [radii.len() - 1, around, heights.len() - 1];
    let bricks = structured_box(CellKind::Hexahedron20, cells.map(|n| n as f64), cells)?;
    let level = |levels: &[f64], x: f64| {
        let k = (x as usize).min(levels.len() - 2);
        (levels[k] + (x - k as f64) * (levels[k + 1] - levels[k])) / 1e3
    };
    let place = |[x, y, z]: [f64; 3]| {
        let (r, turn) = (level(radii, x), (y / around as f64 - 0.5) * angle.to_radians());
        [r * turn.cos(), r * turn.sin(), level(heights, z)]
    };
    let (mut mesh, mut number, mut kept) =
        (Mesh::default(), vec![usize::MAX; bricks.nodes.len()], Vec::new());
    for cell in bricks.require("solid", 3)?.elements.iter().map(|e| &bricks.elements[*e]) {
        let first = |k: usize| cell.nodes().iter().map(|n| bricks.nodes[*n][k] as usize).min().unwrap_or(0);
        if !full(first(0), first(2)) {
            continue;
        }
        for node in cell.nodes() {
            if number[*node] == usize::MAX {
                number[*node] = mesh.nodes.len();
                mesh.nodes.push(place(bricks.nodes[*node]));
            }
        }
        kept.push(cell.renumbered(|node| number[node]));
    }
    mesh.add_region(name, 3, kept);
    Ok(mesh)
}

/// Adds the outer faces at these heights \[mm\] as a region.
fn flat(mesh: &mut Mesh, name: &str, heights: &[f64]) {
    let solids = mesh.regions[0].elements.clone();
    let at = |face: &Cell, height: f64| {
        face.nodes().iter().all(|n| (mesh.nodes[*n][2] - height / 1e3).abs() < 1e-9)
    };
    let skin = mesh.skin(solids).into_iter().map(|side| mesh.side(side));
    let faces: Vec<Cell> = skin.filter(|face| heights.iter().any(|height| at(face, *height))).collect();
    mesh.add_region(name, 2, faces);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Info, diagnose_apart};
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn the_parts_of_the_brake_have_their_volumes_and_seats() {
        let brake = disc_brake().unwrap();
        let touching =
            [["lining_faces", "disc_faces"], ["lining_backs", "plate_faces"], ["seats", "plate_backs"]];
        let diagnosis = diagnose_apart(&brake, &touching, Default::default());
        assert!(diagnosis.faults.0.is_empty(), "{diagnosis:?}");
        let measure =
            |name: &str| Info::of(&brake).regions.iter().find(|r| r.name == name).map_or(0.0, |r| r.measure);
        // Area between two radii over an angle: θ/2 (R² − r²); arcs are met to the fourth power of the angle of a brick.
        let area = |degrees: f64, [inner, outer]: [f64; 2]| {
            degrees.to_radians() / 2.0 * (outer * outer - inner * inner) * 1e-6
        };
        for (name, exact) in [
            ("linings", 2.0 * 0.01 * area(50.0, [92.0, 132.0])),
            ("backplates", 2.0 * 0.005 * area(56.0, [90.0, 134.0])),
            ("seats", 2.0 * area(36.0, [100.0, 126.0])),
            ("lining_faces", 2.0 * area(50.0, [92.0, 132.0])),
            ("disc_faces", 2.0 * area(360.0, [65.0, 140.0])),
        ] {
            let error = (measure(name) / exact - 1.0).abs();
            assert!(within(error, 1e-4, Discretisation), "{name}: {error}");
        }
    }
}
