//! `[rotation.NAME]`: parts that rotate steadily.

use super::Case;
use super::names::unknown_name;
use crate::schema::units::{ANGULAR_VELOCITY, LENGTH};
use crate::schema::{Derivative, Report, declare, dotted, key};
use std::collections::BTreeMap;

declare! {
    /// Parts that rotate steadily about an axis, seen from outside: bodies of revolution, solids or plates.
    pub struct Rotation {
        /// The parts, which together are a body of revolution.
        pub parts: Vec<String> = key::names("parts that turn").not_empty(),
        /// Direction of the axis; a positive `speed` turns by the right hand about it.
        pub axis: [f64; 3] = key::direction().or([0.0, 0.0, 1.0]).derivative(given_by_the_body),
        /// A point on the axis \[m\].
        pub point: [f64; 3] = key::quantities(LENGTH).or([0.0; 3]).derivative(given_by_the_body),
        /// Ω \[rad/s\].
        pub speed: f64 = key::quantity(ANGULAR_VELOCITY).label("speed of rotation"),
        /// Whether gyroscopic forces count, G u̇.
        pub gyroscopic: bool = key::flag(true),
        /// Whether the softening by transport counts, −Ω² T.
        pub transport: bool = key::flag(true),
        /// Whether the centrifugal stress counts, K_σ.
        pub spin_stiffness: bool = key::flag(true),
    }
}

fn given_by_the_body(_: &[usize], _: f64) -> Derivative {
    Derivative::None("the axis is that of the body")
}

/// Refuses parts that are not there, that cannot turn, and those that turn twice.
pub(super) fn check(root: &mut Report, case: &Case) {
    let parts: Vec<&str> = case.parts().map(|(_, name, _)| name).collect();
    let mut turned: BTreeMap<&str, &str> = BTreeMap::new();
    for (name, rotation) in &case.rotation {
        let key = format!("rotation.{}.parts", dotted(name));
        for part in &rotation.parts {
            if !parts.contains(&part.as_str()) {
                unknown_name(root, &key, part, "shell or solid", &parts);
            } else if case.bar.contains_key(part) {
                let help = "Model the shaft by solids, or leave it out: one of a small diameter has small gyroscopic forces";
                root.fault(&key, format!("the bar \"{part}\""), "solids or plates", help);
            } else if let Some(other) = turned.insert(part, name) {
                let expected = "each part once in all rotations";
                root.fault(&key, format!("\"{part}\", which turns by `rotation.{other}`, too"), expected, "");
            }
            if rotation.spin_stiffness && case.shell.get(part).is_some_and(|shell| shell.bending_only) {
                let expected = "`spin_stiffness = false`, or a plate with a membrane, which carries the centrifugal stress";
                let found = format!("true, and \"{part}\" with `bending_only`");
                root.fault(&format!("rotation.{}.spin_stiffness", dotted(name)), found, expected, "");
            }
        }
    }
}
