use super::*;
use crate::quality::face_shape;
use crate::{Mesh, diagnose};
use std::collections::BTreeSet;
use std::f64::consts::PI;
use stridor_base::bounds::{Origin::*, within};

fn smallest_angle_deg(mesh: &Mesh) -> f64 {
    let angles = mesh.elements.iter().filter_map(|e| face_shape(mesh, e)).map(|s| s.angles[0].to_degrees());
    angles.fold(f64::INFINITY, f64::min)
}

fn area(mesh: &Mesh, region: &str) -> f64 {
    let faces = &mesh.require(region, 2).unwrap().elements;
    faces.iter().filter_map(|e| face_shape(mesh, &mesh.elements[*e])).map(|s| s.area).sum()
}

/// The faces as sets of corner coordinates, with the coordinate `axis` mirrored.
fn faces(mesh: &Mesh, axis: Option<usize>) -> BTreeSet<Vec<[u64; 3]>> {
    let corner = |n: &usize| {
        let mut p = mesh.nodes[*n];
        if let Some(axis) = axis {
            p[axis] = -p[axis];
        }
        // −0 is 0.
        p.map(|c| (c + 0.0).to_bits())
    };
    let face = |e: &crate::Cell| {
        let mut corners: Vec<[u64; 3]> = e.nodes().iter().map(corner).collect();
        corners.sort_unstable();
        corners
    };
    mesh.elements.iter().filter(|e| e.dimension() == 2).map(face).collect()
}

#[test]
fn the_rigs_have_the_promised_size_and_quality() {
    for (mesh, nodes) in [(rig(&RigSpec::small()), 350..=500), (rig(&RigSpec::medium()), 3200..=3400)] {
        let mesh = mesh.unwrap();
        assert!(nodes.contains(&mesh.nodes.len()), "{}", mesh.nodes.len());
        assert!(smallest_angle_deg(&mesh) > 25.0, "{}", smallest_angle_deg(&mesh));
        let diagnosis = diagnose(&mesh);
        assert!(diagnosis.faults.0.is_empty() && diagnosis.warnings.is_empty(), "{diagnosis:?}");
    }
}

#[test]
fn the_medium_rig_is_fine_within_two_millimetres_of_the_contact() {
    let mesh = rig(&RigSpec::medium()).unwrap();
    let contact = [0.0, 0.0, -0.075];
    assert!(mesh.nodes.contains(&contact) && mesh.nodes.contains(&[0.0, 0.0, -0.08]));
    for region in ["disc", "slider"] {
        for e in &mesh.require(region, 2).unwrap().elements {
            let near = mesh.elements[*e].nodes().iter().all(|n| {
                let p = mesh.nodes[*n];
                p[0].hypot(p[1]).hypot(if region == "disc" { p[2] + 0.075 } else { 0.0 }) < 2e-3
            });
            let edges = face_shape(&mesh, &mesh.elements[*e]).unwrap().edges;
            assert!(!near || edges.iter().all(|edge| (0.2e-3..0.65e-3).contains(edge)), "{edges:?}");
            assert!(edges[1] < if region == "disc" { 5e-3 } else { 12e-3 });
        }
    }
}

#[test]
fn meshes_are_mirror_images_of_themselves_and_turned_alike() {
    let mesh = rig(&RigSpec::small()).unwrap();
    assert_eq!(faces(&mesh, None), faces(&mesh, Some(1)), "rig in y");
    assert_eq!(faces(&mesh, None), faces(&mesh, Some(0)), "rig in x");
    let annulus = structured_annulus(0.02, 0.075, 4, 24).unwrap();
    assert_eq!(faces(&annulus, None), faces(&annulus, Some(1)), "annulus in y");
    let plate = structured_plate(0.2, 0.12, 6, 4, Faces::Triangles).unwrap();
    assert_eq!(faces(&plate, None), faces(&plate, Some(0)), "plate in x");
    for (mesh, region, normal) in [
        (&mesh, "disc", [1.0, 0.0, 0.0]),
        (&mesh, "slider", [0.0, 0.0, 1.0]),
        (&annulus, "disc", [1.0, 0.0, 0.0]),
    ] {
        for e in &mesh.require(region, 2).unwrap().elements {
            assert_eq!(face_shape(mesh, &mesh.elements[*e]).unwrap().normal.map(|c| c + 0.0), normal);
        }
    }
}

/// Area of the regular polygon with the corners on a circle of radius r is n r²/2 sin(2π/n).
#[test]
fn areas_are_those_of_the_polygons() {
    let annulus = structured_annulus(0.02, 0.075, 5, 40).unwrap();
    let polygon = |r: f64| 20.0 * r * r * (2.0 * PI / 40.0).sin();
    assert!(within((area(&annulus, "disc") / (polygon(0.075) - polygon(0.02)) - 1.0).abs(), 1e-13, RoundOff));
    let spec = PlateSpec {
        length: 0.2,
        width: 0.12,
        contact: [0.03, -0.02],
        grading: Grading::graded(1e-3, 2e-3, 9e-3),
    };
    let mesh = plate(&spec).unwrap();
    assert!(within((area(&mesh, "slider") / 0.024 - 1.0).abs(), 1e-13, RoundOff));
    assert!(mesh.nodes.contains(&[0.03, -0.02, 0.0]) && smallest_angle_deg(&mesh) > 25.0);
    assert!(diagnose(&mesh).faults.0.is_empty());
    let full =
        disc(&DiscSpec { outer_radius: 0.075, hub_radius: 0.0, grading: Grading::uniform(4e-3) }).unwrap();
    assert!(within((area(&full, "disc") / (PI * 0.075 * 0.075) - 1.0).abs(), 1e-3, Discretisation));
    assert!(full.region("hub").is_none() && smallest_angle_deg(&full) > 25.0);
    assert!(diagnose(&full).warnings.is_empty() && diagnose(&full).faults.0.is_empty());
}

#[test]
fn rim_and_hub_are_closed_and_lie_on_their_circles() {
    let mesh = rig(&RigSpec::small()).unwrap();
    for (name, radius) in [("rim", 0.075), ("hub", 0.02075)] {
        let region = mesh.require(name, 1).unwrap();
        let nodes = mesh.region_nodes(region);
        assert_eq!(nodes.len(), region.elements.len());
        for n in nodes {
            let [x, y, z] = mesh.nodes[n];
            assert!(
                x == 0.0 && within((y.hypot(z) / radius - 1.0).abs(), 20.0 * f64::EPSILON, RoundOff),
                "{:?}",
                mesh.nodes[n]
            );
        }
        // Each line starts where the one before ends.
        let ends: Vec<&[usize]> = region.elements.iter().map(|e| mesh.elements[*e].nodes()).collect();
        assert!(ends.iter().zip(ends.iter().cycle().skip(1)).all(|(a, b)| a[1] == b[0]));
    }
}

#[test]
fn wrong_specifications_are_explained() {
    let g = Grading::uniform(5e-3);
    let fault = |r: Result<Mesh>| r.unwrap_err().to_string();
    let text = fault(disc(&DiscSpec { outer_radius: 0.075, hub_radius: 0.08, grading: g }));
    assert!(text.contains("hub_radius"), "{text}");
    let text =
        fault(disc(&DiscSpec { outer_radius: 75.0, hub_radius: 20.0, grading: Grading::uniform(0.003) }));
    assert!(text.contains("in metres"), "{text}");
    for bad in [f64::NAN, -1.0, 0.0, f64::INFINITY] {
        assert!(disc(&DiscSpec { outer_radius: bad, hub_radius: 0.02, grading: g }).is_err());
        assert!(
            disc(&DiscSpec { outer_radius: 0.075, hub_radius: 0.02, grading: Grading::uniform(bad) })
                .is_err()
        );
        assert!(plate(&PlateSpec { length: 0.2, width: bad, contact: [0.0; 2], grading: g }).is_err());
        assert!(structured_annulus(0.02, bad, 2, 12).is_err());
    }
    assert!(plate(&PlateSpec { length: 0.2, width: 0.1, contact: [0.0, 0.05], grading: g }).is_err());
    assert!(structured_annulus(0.02, 0.075, 2, 13).is_err());
    assert!(structured_plate(1.0, 1.0, usize::MAX, 3, Faces::Triangles).is_err());
    let mut spec = RigSpec::small();
    spec.disc.hub_radius = 0.0;
    spec.bar.elements = 0;
    let text = fault(rig(&spec));
    assert!(text.contains("2 faults") && text.contains("full disc"), "{text}");
}

#[test]
fn a_pad_lies_on_the_face_of_its_disc() {
    let spec = PadOnDiscSpec::example();
    let mesh = pad_on_disc(&spec).unwrap();
    assert!(within((area(&mesh, "pad") / 6e-4 - 1.0).abs(), 1e-13, RoundOff));
    for e in &mesh.require("pad", 2).unwrap().elements {
        let normal = face_shape(&mesh, &mesh.elements[*e]).unwrap().normal;
        assert!(within((normal[0] - 1.0).abs(), 1e-15, RoundOff));
        assert!(mesh.elements[*e].nodes().iter().all(|n| mesh.nodes[*n][0] == 3e-3));
    }
    assert!(diagnose(&mesh).faults.0.is_empty() && diagnose(&mesh).warnings.is_empty());
    let text = pad_on_disc(&PadOnDiscSpec { radius: 0.07, ..spec }).unwrap_err().to_string();
    assert!(text.contains("on the disc"), "{text}");
}
