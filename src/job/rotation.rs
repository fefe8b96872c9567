//! The rotations of a case: of bodies of revolution, which is held against the mesh.

use crate::case::Case;
use crate::error::{Fault, Faults};
use crate::numbers::{components, given, significant};
use crate::schema::dotted;
use crate::structure::{Deviation, Model, Rotation, RotationAxis, deviation};

/// Bodies that differ from one of revolution by more than this part of their radius are taken for a wrong axis.
const WRONG_AXIS: f64 = 0.1;

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
