//! Every scalar of a case has a path, such as `contact.rim.friction.mu0`, a unit, bounds, and can be set to another value.

use super::Case;
use super::keys::keys_of;
use crate::error::{Error, Fault, Result, nearest};
use std::ops::{Bound, RangeBounds};
use toml::Value;

/// A scalar of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Keys joined by dots; entries of lists by their index from 0.
    pub path: String,
    /// Its value in SI units.
    pub value: f64,
    /// The SI unit; empty for a pure number.
    pub unit: &'static str,
    /// The values that the case accepts.
    pub bounds: (Bound<f64>, Bound<f64>),
    /// What must be computed again when it changes.
    pub invalidates: Invalidates,
}

/// What a change of a scalar makes worthless, the cheapest first; each includes those before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Invalidates {
    /// What is asked or compared: bands, measured values. The system stays.
    Question,
    /// C of the structure. The steady state and the real modes stay.
    Damping,
    /// The contact law. The compliance that the steady state is condensed on stays.
    Law,
    /// The steady state: loads and velocities.
    Equilibrium,
    /// Which points may touch, and their directions.
    Interface,
    /// M or K: mesh, materials, sections, springs, where the bodies stand.
    Structure,
}

impl Parameter {
    /// Whether the case accepts `value`.
    pub fn accepts(&self, value: f64) -> bool {
        value.is_finite() && self.bounds.contains(&value)
    }
}

impl Case {
    /// Every scalar of the case, in the order of the file's sections.
    ///
    /// # Errors
    /// A case that is made in code and has what no file may say.
    pub fn parameters(&self) -> Result<Vec<Parameter>> {
        let quantities = self.quantities()?.into_iter();
        Ok(quantities
            .map(|q| Parameter {
                invalidates: self.invalidated_by(&q.path),
                path: q.path,
                value: q.value,
                unit: q.unit,
                bounds: q.bounds,
            })
            .collect())
    }

    /// The scalar at `path`.
    ///
    /// # Errors
    /// A path that is not a number of the case, with the nearest one that is.
    pub fn parameter(&self, path: &str) -> Result<Parameter> {
        let all = self.parameters()?;
        if let Some(found) = all.iter().find(|p| p.path == path) {
            return Ok(found.clone());
        }
        let near = nearest(path, all.iter().map(|p| p.path.as_str()));
        let help = near.map_or("`stridor check CASE --parameters` lists them".into(), |n| {
            format!("Did you mean `{n}`?")
        });
        let place = format!("parameter `{path}`");
        let fault = Fault::new(place, "no such number in the case", "the path of a scalar");
        Err(Error::input(fault.with_help(help)))
    }

    /// The same case with the scalar at `path` set to `value` \[SI\]; validated like a file.
    ///
    /// # Errors
    /// A path that is not a number of the case (with the nearest one that is), or a value that the case refuses.
    pub fn with_parameter(&self, path: &str, value: f64) -> Result<Case> {
        self.parameter(path)?;
        let mut table = Value::Table(self.to_toml().parse().unwrap_or_default());
        let slot = keys_of(path).iter().try_fold(&mut table, |node, key| match node {
            Value::Array(list) => list.get_mut(key.parse::<usize>().ok()?),
            _ => node.get_mut(key),
        });
        let Some(slot) = slot else {
            let fault = Fault::new(format!("parameter `{path}`"), "no number there", "the path of a scalar");
            return Err(Error::input(fault));
        };
        *slot = Value::Float(value);
        let text = toml::to_string(&table).unwrap_or_default();
        let case = Case::parse(&format!("{path} = {value}"), &text, self.folder.clone())?;
        Ok(Case { places: self.places.clone(), ..case })
    }

    /// The same case with the scalars at some paths set to values \[SI\], one after the other.
    ///
    /// # Errors
    /// As [`Case::with_parameter`].
    pub fn with_parameters<'a>(&self, values: impl IntoIterator<Item = (&'a String, f64)>) -> Result<Case> {
        values.into_iter().try_fold(self.clone(), |case, (path, value)| case.with_parameter(path, value))
    }

    fn invalidated_by(&self, path: &str) -> Invalidates {
        let keys = keys_of(path);
        let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
        let own = match keys[..] {
            [
                "modes" | "cea" | "sensitivity" | "transient" | "frf" | "measured" | "calibrate" | "sweep"
                | "map",
                ..,
            ] => Invalidates::Question,
            ["damping", ..] => Invalidates::Damping,
            // Loss factors and Rayleigh damping do not touch M and K.
            ["material", _, "loss_factor" | "rayleigh", ..] | ["spring", _, "damping"] => {
                Invalidates::Damping
            }
            ["contact", _, "normal" | "friction" | "bristle", ..] => Invalidates::Law,
            ["contact", _, "load" | "approach" | "sliding_velocity"] | ["force", ..] => {
                Invalidates::Equilibrium
            }
            ["contact", _, "reach" | "stroke" | "sliding_direction" | "into", ..] => Invalidates::Interface,
            _ => Invalidates::Structure,
        };
        // The preload's geometric stiffness follows the steady state.
        if self.prestress && own >= Invalidates::Law { Invalidates::Structure } else { own }
    }
}

/// Whether `path` is the pattern, in which every `*` stands for any letters, none included.
pub(crate) fn path_matches(pattern: &str, path: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == path,
        Some((head, tail)) => path.strip_prefix(head).is_some_and(|rest| {
            (0..=rest.len()).filter(|k| rest.is_char_boundary(*k)).any(|k| path_matches(tail, &rest[k..]))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::path_matches;

    #[test]
    fn patterns_match_as_people_expect() {
        assert!(path_matches("*", "contact.rim.load") && path_matches("contact.*.load", "contact.rim.load"));
        assert!(
            path_matches("*load*", "contact.rim.load") && !path_matches("contact.*.mu0", "contact.rim.load")
        );
        assert!(
            !path_matches("contact", "contact.rim.load")
                && path_matches("contact.rim.load", "contact.rim.load")
        );
        assert!(path_matches("**", "") && !path_matches("a*a", "a"));
    }
}
