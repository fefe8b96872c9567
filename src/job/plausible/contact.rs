//! How the bodies of a contact stand to each other as they are meshed, and its stiffness beside that of the bodies.
//!
//! A layer of thickness h and modulus E gives way to a pressure p by p h/E: E/h \[N/m³\] is the stiffness per area of a body. A contact much
//! softer than that lets the bodies into each other before they deform. Of one much stiffer, k, only E/(h k) of the deflection is: it changes
//! nothing but the rounding of the equations.

use crate::case::{Contact, StiffnessPer};
use crate::contact::tributary;
use crate::error::Fault;
use crate::job::prepared::Prepared;
use crate::job::steady_warnings::SMALL_PENETRATION;
use crate::numbers::{shortest, significant};
use crate::schema::dotted;
use crate::system::{ContactPair, ContactPoint};

/// k over the E/h of the softest body, and of the stiffest, within which a contact is plausible: linings pressed against discs are near 1.
const RANGE: [f64; 2] = [1e-4, 1e4];

/// The part of the area of a face that lies over its counter-faces, up to which the rest is worth a warning.
const COVERED: f64 = 0.9;

pub fn warnings(prepared: &Prepared) -> Vec<Fault> {
    let of = |(name, contact): (&String, &Contact)| {
        let pair = prepared.system.pairs.iter().find(|pair| pair.name == *name);
        let stands = pair.map(|pair| [inside(prepared, pair), beside(prepared, contact, pair)]);
        stands.into_iter().flatten().chain([of_stiffness(prepared, name, contact)]).flatten()
    };
    prepared.case.contact.iter().flat_map(of).collect()
}

/// Bodies that begin inside each other.
fn inside(prepared: &Prepared, pair: &ContactPair) -> Option<Fault> {
    let (overlap, thinnest) = (-pair.least_gap(), prepared.thinnest());
    if overlap <= SMALL_PENETRATION * thinnest {
        return None;
    }
    let mm = |length: f64| shortest(1e3 * length, 3);
    let deep = |point: &&ContactPoint| point.gap < -SMALL_PENETRATION * thinnest;
    let (deep, all) = (pair.points.iter().filter(deep).count(), pair.points.len());
    let found =
        format!("bodies that begin up to {} mm inside each other, at {deep} of {all} points", mm(overlap));
    let expected = format!(
        "bodies that just touch, or an overlap below {} mm, {SMALL_PENETRATION} of the thinnest part",
        mm(SMALL_PENETRATION * thinnest)
    );
    let help = "Move one of them in the mesh; `initial_gap = \"closed\"` takes gaps and \
                overlaps as none, where they are of the meshes alone";
    Some(Fault::new(format!("`contact.{}`", dotted(&pair.name)), found, expected).with_help(help))
}

/// A face of which much is beside the counter-faces or out of reach.
fn beside(prepared: &Prepared, contact: &Contact, pair: &ContactPair) -> Option<Fault> {
    let regions = &prepared.regions;
    let region = regions.region(&contact.body, "").ok()?;
    if contact.points.is_some() || contact.normal.per != StiffnessPer::Area || region.dimension != 2 {
        return None;
    }
    let area: f64 = tributary(&prepared.model.nodes, &regions.cells(region)).iter().sum();
    let share = pair.points.iter().map(|point| point.weight).sum::<f64>() / area;
    let found = format!(
        "{} % of the area of \"{}\" over \"{}\" and within a `reach` of {} mm, {} contact points",
        significant(100.0 * share, 2),
        contact.body,
        contact.counter,
        shortest(1e3 * contact.reach, 3),
        pair.points.len()
    );
    let help = "What is beside the counter-faces, or farther away, takes no part: move the bodies over each other, raise \
                `reach`, or give as `body` the smaller of the two faces";
    let expected = format!("{} % or more", 100.0 * COVERED);
    let fault = Fault::new(format!("`contact.{}.body`", dotted(&pair.name)), found, expected).with_help(help);
    (share < COVERED).then_some(fault)
}

fn of_stiffness(prepared: &Prepared, name: &str, contact: &Contact) -> Option<Fault> {
    let stiffness = contact.normal.stiffness;
    if contact.normal.per != StiffnessPer::Area || stiffness == 0.0 {
        return None;
    }
    let (model, regions) = (&prepared.model, &prepared.regions);
    let of_body = |region: &String| {
        let nodes = regions.nodes(region, "").unwrap_or_default();
        let parts = model.parts.iter();
        let touching =
            parts.filter(move |part| part.nodes().iter().any(|node| nodes.binary_search(node).is_ok()));
        touching.map(|part| {
            let thickness = match part.as_shell() {
                Some(shell) => shell.thickness,
                None => part.smallest_extent(&model.nodes),
            };
            (part.kind.material().youngs_modulus / thickness, part, thickness)
        })
    };
    let bodies = || [&contact.body, &contact.counter].into_iter().flat_map(of_body);
    let soft = bodies().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let stiff = bodies().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let ((own, part, thickness), help) = if stiffness < RANGE[0] * soft.0 {
        (soft, "So soft a contact lets the bodies into each other before they deform")
    } else if stiffness > RANGE[1] * stiff.0 {
        (stiff, "So stiff a contact changes no deflection, but costs digits and time")
    } else {
        return None;
    };
    let help = format!("{help}: check its unit, such as \"100 GN/m^3\"");
    let found = format!("{} N/m^3", significant(stiffness, 3));
    let expected = format!(
        "{} to {} N/m^3: `{}` alone has E/h = {} N/m^3, h = {} m",
        significant(RANGE[0] * soft.0, 2),
        significant(RANGE[1] * stiff.0, 2),
        part.name,
        significant(own, 3),
        significant(thickness, 3)
    );
    Some(Fault::new(format!("`contact.{}.normal.stiffness`", dotted(name)), found, expected).with_help(help))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Case, read_case};
    use crate::mesh::generate::structured_box;
    use crate::mesh::{CellKind, write};
    use std::path::Path;

    /// The warnings of a pad of 20 × 20 × 10 mm on a slider of 60 × 40 × 12 mm whose top is at z = 0; the corner of its face is at `at`.
    fn of_pad(kind: CellKind, at: [f64; 3], pressing: &str, more: &str) -> Vec<String> {
        let named = |name: &str, size: [f64; 3], cells: [usize; 3], at: [f64; 3]| {
            let mut mesh = structured_box(kind, size, cells).unwrap();
            mesh.regions.iter_mut().for_each(|region| region.name = format!("{name}_{}", region.name));
            mesh.nodes.iter_mut().for_each(|x| (0..3).for_each(|k| x[k] += at[k]));
            mesh
        };
        let mut mesh = named("slider", [0.06, 0.04, 0.012], [6, 4, 2], [0.0, 0.0, -0.012]);
        mesh.append(named("pad", [0.02, 0.02, 0.01], [4, 4, 2], at));
        let folder = tempfile::tempdir().unwrap();
        write(&folder.path().join("m.msh"), &mesh, 1.0).unwrap();
        let solids = ["slider", "pad"]
            .map(|s| format!("[solid.{s}_solid]\nmaterial = \"steel\"\nallow_locking = true\n"));
        let text = format!(
            "[mesh]\nfile = \"m.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 7800\n\
             {}[support.floor]\non = \"slider_z_min\"\n[contact.pad]\nbody = \"pad_z_min\"\ncounter = \"slider_z_max\"\n\
             {pressing}\nsliding_velocity = 1\n{more}\nnormal = {{ per = \"area\", stiffness = 1e13 }}\n\
             friction = {{ law = \"coulomb\", mu0 = 0.3 }}\n[modes.all]\ncount = 1\n",
            solids.concat()
        );
        let case = Case::parse("a.toml", &text, folder.path().into()).unwrap();
        let prepared = Prepared::new(&case).unwrap_or_else(|error| panic!("{at:?}: {error}"));
        warnings(&prepared).iter().map(Fault::to_string).collect()
    }

    /// A tenth of the 10 mm of the pad.
    #[test]
    fn bodies_that_begin_inside_each_other_are_warned_of() {
        for kind in [CellKind::Hexahedron8, CellKind::Hexahedron20, CellKind::Tetrahedron10] {
            for pressing in ["load = 100", "approach = 0", "approach = -0.005"] {
                for (mm, deep) in
                    [(-0.3, false), (0.0, false), (0.9, false), (1.1, true), (3.0, true), (9.0, true)]
                {
                    let at = [0.02, 0.01, -1e-3 * mm];
                    let found = of_pad(kind, at, pressing, "");
                    assert_eq!(found.len(), usize::from(deep), "{kind:?} {mm} {found:?}");
                    let named = format!("up to {} mm inside each other", shortest(mm, 3));
                    let words = |text: &String| {
                        text.starts_with("`contact.pad`")
                            && text.contains(&named)
                            && text.contains("below 1 mm")
                    };
                    assert!(found.iter().all(words), "{found:?}");
                    // What is said to be the meshes' alone is no overlap.
                    assert!(of_pad(kind, at, pressing, "initial_gap = \"closed\"").is_empty());
                }
            }
        }
    }

    /// A pad of 20 mm beyond the edge of the slider at x = 0, and one over a corner.
    #[test]
    fn a_face_that_is_beside_its_counter_face_is_warned_of() {
        for kind in [CellKind::Hexahedron8, CellKind::Hexahedron20, CellKind::Tetrahedron10] {
            for ([x, y], share) in [
                ([0.0, 0.0], 1.0),
                ([1.0, 0.0], 0.95),
                ([5.0, 0.0], 0.75),
                ([12.0, 0.0], 0.4),
                ([4.0, 10.0], 0.4),
            ] {
                let found = of_pad(kind, [-1e-3 * x, -1e-3 * y, 0.0], "load = 100", "");
                assert_eq!(found.len(), usize::from(share < COVERED), "{kind:?} {x} {y} {found:?}");
                let named = format!("found {} % of the area of \"pad_z_min\"", significant(100.0 * share, 2));
                let place = "`contact.pad.body`";
                assert!(
                    found.iter().all(|text| text.contains(&named) && text.starts_with(place)),
                    "{found:?}"
                );
            }
        }
    }

    #[test]
    fn contacts_far_softer_or_stiffer_than_the_bodies_are_warned_of() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/disc-brake/case.toml");
        let mut case = read_case(&file).unwrap();
        // Linings of 8 GPa, discs of 120 GPa, parts of some 10 mm.
        for (stiffness, word) in
            [(1e11, ""), (1e9, ""), (1e14, ""), (1e3, "So soft"), (1e18, "So stiff"), (0.0, "")]
        {
            case.contact.get_mut("pads").unwrap().normal.stiffness = stiffness;
            case.contact.get_mut("pads").unwrap().normal.cubic = 1e20;
            let prepared = Prepared::new(&case).unwrap();
            let found = warnings(&prepared);
            assert_eq!(found.len(), usize::from(!word.is_empty()), "{stiffness:e} {found:?}");
            for fault in found {
                let text = fault.to_string();
                let both = text.contains("`contact.pads.normal.stiffness`") && text.contains("E/h = ");
                assert!(both && text.contains(word), "{text}");
            }
        }
    }
}
