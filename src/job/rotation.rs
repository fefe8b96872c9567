//! The rotations of a case: of bodies of revolution, which is held against the mesh.

use super::counter::counter_faces;
use super::regions::Regions;
use crate::case::{Case, SlidingChoice};
use crate::error::{Fault, Faults};
use crate::numbers::{components, given, significant};
use crate::schema::dotted;
use crate::structure::{Deviation, Model, Rotation, RotationAxis, deviation};
use nalgebra::Vector3;

/// Bodies that differ from one of revolution by more than this part of their radius are taken for a wrong axis.
const WRONG_AXIS: f64 = 0.1;
/// Axes are one, and speeds equal, to this part of the radius and of the speed.
const SAME: f64 = 1e-6;

/// Adds the rotations of the case to `model`; `warnings` say where a part is not a body of revolution.
pub fn add_rotations(case: &Case, model: &mut Model, warnings: &mut Vec<String>, faults: &mut Faults) {
    for (name, own) in &case.rotation {
        let place = |key: &str| format!("`rotation.{}.{key}`", dotted(name));
        let length = own.axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        let axis = RotationAxis { point: own.point, direction: own.axis.map(|a| a / length) };
        let rotation = Rotation {
            parts: own.parts.clone(),
            axis,
            speed: own.speed,
            gyroscopic: own.gyroscopic,
            transport: own.transport,
            spin_stiffness: own.spin_stiffness,
        };
        let turning = model.turned_by(&rotation);
        for part in turning.filter(|part| !part.kind.material().is_isotropic_about(axis.direction)) {
            let found = format!(
                "\"{}\", whose material is another one in other directions about the axis",
                part.name
            );
            let expected = "materials that are isotropic, or isotropic across `axis_3` along the axis";
            let help = "Seen from outside the stiffness of such a part changes with time, which has no modes";
            faults.push(Fault::new(place("parts"), found, expected).with_help(help));
        }
        if let Some(Deviation { distance, at, radius }) = deviation(model, &rotation) {
            let found = format!(
                "a body that is {} m off its turned self at {} m, of a radius of {} m",
                given(distance),
                components(at),
                significant(radius, 4)
            );
            let expected = "a body of revolution about the axis";
            if distance > WRONG_AXIS * radius {
                let help =
                    "Is it the right `axis` and `point`? Name all parts that turn, and none that do not";
                faults.push(Fault::new(place("axis"), found, expected).with_help(help));
            } else {
                let help = "Vanes, holes and eccentricities are taken as if they stood still while the material passes them";
                warnings.push(Fault::new(place("parts"), found, expected).with_help(help).warning());
            }
        }
        model.rotations.push(rotation);
    }
}

/// Holds contacts that slide by a rotation against the rotations of their bodies: about another axis is a fault; the speed of the contact is that of the
/// counter-body relative to the body, Ω_counter − Ω_body, or `warnings` say so.
pub fn check_sliding(
    case: &Case,
    (regions, model): (&Regions, &Model),
    warnings: &mut Vec<String>,
    faults: &mut Faults,
) {
    for (name, contact) in &case.contact {
        let SlidingChoice::About { rotation: sliding } = &contact.sliding else { continue };
        let place = |key: &str| format!("`contact.{}.rotation.{key}`", dotted(name));
        let body = regions.nodes(&contact.body, "").ok().and_then(|nodes| model.part_with(&nodes));
        let counter =
            counter_faces(&contact.counter, regions, model, ("", "")).map_or(Vec::new(), |found| found.parts);
        let turning = |parts: &[&str]| {
            case.rotation.iter().find(|(_, own)| parts.iter().any(|part| own.parts.iter().any(|p| p == part)))
        };
        let body: Vec<&str> = body.iter().map(|part| part.name.as_str()).collect();
        let counter: Vec<&str> = counter.iter().map(|part| part.name.as_str()).collect();
        let axis = Vector3::from(sliding.axis).normalize();
        let mut relative = None;
        for (parts, sign) in [(&body, -1.0), (&counter, 1.0)] {
            let Some((other, own)) = turning(parts) else { continue };
            let direction = Vector3::from(own.axis).normalize();
            let way = Vector3::from(own.point) - Vector3::from(sliding.point);
            let radius = parts.iter().filter_map(|part| model.part(part)).flat_map(|part| part.nodes());
            let radius = radius
                .map(|node| (Vector3::from(model.nodes[node]) - Vector3::from(own.point)).norm())
                .fold(0.0, f64::max);
            let off = way.cross(&axis).norm();
            if direction.cross(&axis).norm() > SAME || off > SAME * radius {
                let found = format!(
                    "an axis along {} through {} m, where `rotation.{other}` turns `{}` about one along {} through {} m",
                    components(sliding.axis),
                    components(sliding.point),
                    parts.join("`, `"),
                    components(own.axis),
                    components(own.point)
                );
                let help = "What turns slides about its own axis: give both the same `axis` and `point`";
                faults.push(
                    Fault::new(place("axis"), found, "the axis about which the body turns").with_help(help),
                );
            }
            *relative.get_or_insert(0.0) += sign * own.speed * direction.dot(&axis).signum();
        }
        if let Some(relative) = relative.filter(|relative| {
            (relative - sliding.speed).abs() > SAME * sliding.speed.abs().max(relative.abs())
        }) {
            let found = format!("{} rad/s", given(sliding.speed));
            let expected = format!(
                "{} rad/s, as `[rotation]` turns the counter-body relative to the body: one disc turns at one speed",
                given(relative)
            );
            let help = "Friction takes the one, gyroscopic and centrifugal terms the other";
            warnings.push(Fault::new(place("speed"), found, expected).with_help(help).warning());
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::case::Case;
    use crate::job::Prepared;
    use crate::mesh::generate::solid_brake;
    use crate::mesh::write;

    /// A disc that turns in `[rotation]` and under a pad: by one axis and one speed or not, the axis the other way round, the pad as body or
    /// counter-body. A fault where the axes differ, a warning where the speeds do.
    #[test]
    fn a_disc_turns_about_one_axis_at_one_speed() {
        let folder = tempfile::tempdir().unwrap();
        write(&folder.path().join("m.msh"), &solid_brake().unwrap(), 1.0).unwrap();
        let axes = ["[0, 0, 1]", "[0, 0, -3]", "[0, 0.01, 1]"];
        for (swap, sign) in [(false, 1.0), (true, -1.0)] {
            for (k, axis) in axes.iter().enumerate() {
                for point in ["[0, 0, 0]", "[0, 0, 0.3]", "[0.001, 0, 0]"] {
                    let same = k < 2 && !point.contains("0.001");
                    let speeds = if same && point == "[0, 0, 0.3]" { 3 } else { 1 };
                    for speed in &[20.0, -20.0, 21.0][..speeds] {
                        let [body, counter] =
                            if swap { ["disc_face", "pad_face"] } else { ["pad_face", "disc_face"] };
                        let text = format!(
                            "[mesh]\nfile = \"m.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 7800\n\
                             [solid.disc]\nmaterial = \"steel\"\n[solid.pad]\nmaterial = \"steel\"\n[support.hub]\non = \"hub\"\n\
                             [support.back]\non = \"pad_back\"\n[rotation.disc]\nparts = [\"disc\"]\nspeed = 20\n\
                             [contact.pad]\nbody = \"{body}\"\ncounter = \"{counter}\"\napproach = 1e-6\n\
                             rotation = {{ axis = {axis}, point = {point}, speed = {speed} }}\n\
                             normal = {{ per = \"area\", stiffness = 1e12 }}\nfriction = {{ law = \"coulomb\", mu0 = 0.3 }}\n[cea]\nband = [0, 1000]\n"
                        );
                        let case = Case::parse("a.toml", &text, folder.path().into()).unwrap();
                        match Prepared::new(&case) {
                            Err(error) => {
                                let error = error.to_string();
                                assert!(
                                    !same && error.contains("contact.pad.rotation.axis"),
                                    "{axis} {point}: {error}"
                                );
                            }
                            Ok(prepared) => {
                                assert!(same, "{axis} {point}");
                                let right = sign * if k == 1 { -20.0 } else { 20.0 };
                                let warned = prepared
                                    .warnings
                                    .iter()
                                    .any(|w| w.contains("one disc turns at one speed"));
                                assert_eq!(
                                    warned,
                                    *speed != right,
                                    "{axis} {speed} {swap}: {:?}",
                                    prepared.warnings
                                );
                            }
                        }
                    }
                }
            }
        }
    }
}
