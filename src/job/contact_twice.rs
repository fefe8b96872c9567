//! Contacts that a case has twice.

use super::counter::counter_faces;
use super::regions::Regions;
use crate::case::Case;
use crate::error::{Fault, Faults};
use crate::linalg::SparseVector;
use crate::mesh::{Cell, cell_nodes};
use crate::structure::{Model, Part};
use crate::system::{ContactPair, ContactPoint};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Refuses contact points that are in the same place and press the same way: their stiffness would count twice. Points that are `given`,
/// without a mesh, are the same only where they slide the same way, too: a body may rub on several others at once, each of which is pressed by
/// the same degree of freedom.
pub(super) fn points_twice(pairs: &[ContactPair], given: bool, faults: &mut Faults) {
    let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<u64>>();
    let mut seen = HashMap::new();
    let mut twice: BTreeMap<[&str; 2], (usize, [usize; 2])> = BTreeMap::new();
    for pair in pairs {
        for (k, point) in pair.points.iter().enumerate().filter(|(_, p)| !p.normal.indices().is_empty()) {
            let vector = |v: &'_ SparseVector| (v.indices().to_vec(), bits(v.values()));
            let tangents = given.then(|| point.tangents.each_ref().map(vector));
            let key = (bits(&point.position), vector(&point.normal), tangents);
            let (other, j) = *seen.entry(key).or_insert((pair.name.as_str(), k));
            if (other, j) != (pair.name.as_str(), k) {
                twice.entry([other, &pair.name]).or_insert((0, [j + 1, k + 1])).0 += 1;
            }
        }
    }
    for ([first, second], (count, [j, k])) in twice {
        let found =
            format!("{count} points that `{first}` has, too, the first of them point {k} (point {j} there)");
        let expected = "contact points that are there once";
        let fault = Fault::new(format!("`contact.{second}`"), found, expected);
        faults.push(
            fault.with_help("The contact stiffness would count twice: give each point to one contact, once"),
        );
    }
}

/// Refuses two contacts between the same two plates with body and counter-body exchanged, where they have points near each other:
/// nearer than the points of one are to their neighbours, and half of both thicknesses.
pub(super) fn surfaces_twice(
    case: &Case,
    (regions, model): (&Regions, &Model),
    pairs: &[ContactPair],
    faults: &mut Faults,
) {
    let body = |name: &str| {
        let nodes = regions.nodes(&case.contact.get(name)?.body, "").ok()?;
        model.part_with(&nodes)
    };
    let thickness = |name: &str| model.part(name).map_or(0.0, Part::thickness);
    let surfaces: Vec<(&ContactPair, &str, &str)> = pairs
        .iter()
        .filter_map(|pair| {
            let counter =
                counter_faces(&case.contact.get(&pair.name)?.counter, regions, model, ("", "")).ok()?.part;
            Some((pair, body(&pair.name)?.name.as_str(), counter.name.as_str()))
        })
        .collect();
    for (k, (second, body, counter)) in surfaces.iter().enumerate() {
        for (first, ..) in surfaces[..k].iter().filter(|(_, b, c)| b == counter && c == body) {
            let across = 0.5 * (thickness(body) + thickness(counter));
            let near = |p: &ContactPoint, q: &ContactPoint| {
                let apart = (0..3).map(|c| (p.position[c] - q.position[c]).powi(2)).sum::<f64>();
                // A point stands for a length or an area.
                let spacing = p.weight.max(q.weight);
                apart <= spacing.max(spacing * spacing) + across * across
            };
            if second.points.iter().any(|p| first.points.iter().any(|q| near(p, q))) {
                let found =
                    format!("the plates of `{}` once more, body and counter-body exchanged", first.name);
                let fault = Fault::new(format!("`contact.{}`", second.name), found, "each contact once");
                let help = "The contact stiffness would count twice: the points of one side are enough";
                faults.push(fault.with_help(help));
            }
        }
    }
}

/// Refuses a contact between faces that a tie joins: what is joined does not slide.
pub(super) fn tied_and_in_contact(case: &Case, (regions, model): (&Regions, &Model), faults: &mut Faults) {
    type Faces = BTreeSet<Vec<usize>>;
    let nodes = |cells: Vec<Cell>| -> Faces { cells.iter().map(|face| cell_nodes([face])).collect() };
    let faces =
        |name: &str| counter_faces(name, regions, model, ("", "")).ok().map(|found| nodes(found.faces));
    let ties: Vec<(&String, Faces, Faces)> =
        case.tie.iter().filter_map(|(name, tie)| Some((name, faces(&tie.on)?, faces(&tie.to)?))).collect();
    if ties.is_empty() {
        return;
    }
    let common = |a: &Faces, b: &Faces| !a.is_disjoint(b);
    for (name, contact) in &case.contact {
        let body = regions.region(&contact.body, "").ok().map(|region| nodes(regions.cells(region)));
        let (Some(body), Some(counter)) = (body, faces(&contact.counter)) else { continue };
        for (tie, on, to) in &ties {
            if common(&body, on) && common(&counter, to) || common(&body, to) && common(&counter, on) {
                let found = format!("faces that `tie.{tie}` joins");
                let fault = Fault::new(format!("`contact.{name}`"), found, "faces that are free to slide");
                let help = "Remove the contact or the tie, or give each a region of its own";
                faults.push(fault.with_help(help));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::case::Case;
    use crate::job::Prepared;
    use crate::mesh::generate::{Faces, structured_plate};
    use crate::mesh::{Mesh, Region, write};

    /// A plate of 80 × 20 mm in 8 × 2 cells at height `z`, and its outermost cells.
    fn plate(name: &str, z: f64) -> Mesh {
        let mut mesh = structured_plate(0.08, 0.02, 8, 2, Faces::Quadrilaterals).unwrap();
        mesh.nodes.iter_mut().for_each(|x| x[2] = z);
        mesh.regions.truncate(1);
        mesh.elements.truncate(16);
        mesh.regions[0].name = name.into();
        for (side, elements) in [("left", vec![0, 8]), ("right", vec![7, 15])] {
            mesh.regions.push(Region { name: format!("{name}_{side}"), dimension: 2, elements });
        }
        mesh
    }

    /// Two plates, one above the other, and a second contact with body and counter-body exchanged: a fault where both are at the
    /// same place, in part or as a whole.
    #[test]
    fn a_contact_from_both_sides_is_a_fault_where_it_is_the_same() {
        let dir = tempfile::tempdir().unwrap();
        let mut mesh = plate("low", 0.0);
        mesh.append(plate("high", 0.01));
        write(&dir.path().join("m.msh"), &mesh, 1.0).unwrap();
        let shell = |name: &str| {
            format!(
                "[shell.{name}]\nmaterial = \"steel\"\nthickness = 0.01\n[support.{name}]\non = \"{name}\"\nheld = [\"ux\", \"uy\"]\n"
            )
        };
        for (a, b, same) in [
            ("", "", true),
            ("_left", "", true),
            ("", "_right", true),
            ("_left", "_left", true),
            ("_right", "_right", true),
            ("_left", "_right", false),
            ("_right", "_left", false),
        ] {
            for [one, two] in [["low", "high"], ["high", "low"]] {
                let contact = |name: &str, body: &str, side: &str, counter: &str| {
                    format!(
                        "[contact.{name}]\nbody = \"{body}{side}\"\ncounter = \"{counter}\"\napproach = 1e-6\nsliding_velocity = 1\n\
                         sliding_direction = [1, 0, 0]\nnormal = {{ per = \"area\", stiffness = 1e10 }}\n\
                         friction = {{ law = \"coulomb\", mu0 = 0.3 }}\n"
                    )
                };
                let text = format!(
                    "[mesh]\nfile = \"m.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\n\
                     density = 7800\n{}{}{}{}[cea]\nband = [0, 1000]\n",
                    shell("low"),
                    shell("high"),
                    contact("p", one, a, two),
                    contact("q", two, b, one)
                );
                let case = Case::parse("a.toml", &text, dir.path().into()).unwrap();
                let said = Prepared::new(&case).map_or_else(|error| error.to_string(), |_| String::new());
                assert_eq!(
                    said.contains("body and counter-body exchanged"),
                    same,
                    "{one}{a} {two}{b}: {said}"
                );
            }
        }
    }

    /// A contact and a tie between the same two plates, each of which names the whole plates or parts of them, in any order: a fault where
    /// faces of both sides are the same.
    #[test]
    fn what_a_tie_joins_does_not_slide() {
        let dir = tempfile::tempdir().unwrap();
        let mut mesh = plate("low", 0.0);
        mesh.append(plate("high", 0.01));
        write(&dir.path().join("m.msh"), &mesh, 1.0).unwrap();
        let sides = ["", "_left", "_right"];
        let meet = |a: &str, b: &str| a == b || a.is_empty() || b.is_empty();
        for member in 0..sides.len().pow(4) * 4 {
            let side = |k: u32| sides[member / sides.len().pow(k) % 3];
            let [a, b, c, d] = [0, 1, 2, 3].map(side);
            let turned = member / sides.len().pow(4);
            let order = |turned: bool| if turned { ["high", "low"] } else { ["low", "high"] };
            let ([on, to], [body, counter]) = (order(turned % 2 == 1), order(turned / 2 == 1));
            let text = format!(
                "[mesh]\nfile = \"m.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\n\
                 density = 7800\n[shell.low]\nmaterial = \"steel\"\nthickness = 0.01\n[shell.high]\nmaterial = \"steel\"\n\
                 thickness = 0.01\n[support.low]\non = \"{to}_left\"\nheld = \"all\"\n\
                 [tie.glue]\non = \"{on}{a}\"\nto = \"{to}{b}\"\n\
                 [contact.pad]\nbody = \"{body}{c}\"\ncounter = \"{counter}{d}\"\napproach = 1e-6\nsliding_velocity = 1\n\
                 sliding_direction = [1, 0, 0]\nnormal = {{ per = \"area\", stiffness = 1e10 }}\n\
                 friction = {{ law = \"coulomb\", mu0 = 0.3 }}\n[cea]\nband = [0, 1000]\n"
            );
            let case = Case::parse("a.toml", &text, dir.path().into()).unwrap();
            let said = Prepared::new(&case).map_or_else(|error| error.to_string(), |_| String::new());
            let same = if on == body { meet(a, c) && meet(b, d) } else { meet(a, d) && meet(b, c) };
            // Ends that are apart are a fault of their own.
            if meet(a, b) && meet(c, d) {
                assert_eq!(said.contains("faces that `tie.glue` joins"), same, "{text}{said}");
            }
        }
    }

    /// Two points that one degree of freedom presses, the tangents of which are the same or not, in one contact or two: a fault where both are.
    /// Where they differ, K has the stiffness of both along the normal.
    #[test]
    fn points_with_one_normal_are_two_where_they_slide_differently() {
        let dir = tempfile::tempdir().unwrap();
        let matrix = |name: &str, k: [f64; 3]| {
            let [a, b, c] = k;
            let text = format!(
                "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 {a}\n2 2 {b}\n3 3 {c}\n"
            );
            std::fs::write(dir.path().join(name), text).unwrap();
        };
        matrix("m.mtx", [1.0; 3]);
        matrix("k.mtx", [2e4, 1.5e4, 1.8e4]);
        let tangents =
            ["\"2\", \"\"", "\"3\", \"\"", "\"2\", \"3\"", "\"3\", \"2\"", "\"-2\", \"\"", "\"\", \"\""];
        let contact = |name: &str, points: &str| {
            format!(
                "[contact.{name}]\npoints = [{points}]\napproach = 1e-4\nsliding_velocity = 1\n\
                 normal = {{ per = \"point\", stiffness = 1e4 }}\nfriction = {{ law = \"coulomb\", mu0 = 0.3 }}\n"
            )
        };
        for first in tangents {
            for second in tangents {
                let [a, b] = [first, second].map(|tangents| format!("[\"-1\", {tangents}]"));
                let one = contact("p", &format!("{a}, {b}"));
                let two = contact("p", &a) + &contact("q", &b);
                for contacts in [one, two] {
                    let text = format!(
                        "[matrices]\nmass = \"m.mtx\"\nstiffness = \"k.mtx\"\n{contacts}[cea]\nband = [0, 100]\n"
                    );
                    let case = Case::parse("a.toml", &text, dir.path().into()).unwrap();
                    match Prepared::new(&case) {
                        Ok(prepared) => {
                            assert_ne!(first, second);
                            let system = &prepared.system;
                            let (closed, _) =
                                crate::equilibrium::closed_stiffness(system, &system.structure.stiffness);
                            assert_eq!(closed.get(0, 0), Some(&4e4), "{text}");
                        }
                        Err(error) => {
                            assert!(
                                first == second && error.to_string().contains("there once"),
                                "{text}{error}"
                            );
                        }
                    }
                }
            }
        }
    }
}
