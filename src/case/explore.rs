//! `[sweep.NAME]` and `[map.NAME]`: complex eigenvalues over scalars of the rest of the case.

use super::varied::{no_number, refused};
use super::{Case, Invalidates, Parameter};
use crate::schema::units::{dimension_of, parse_of_scalar};
use crate::schema::{Report, declare, dotted, key};

/// The most points of one sweep or map.
const POINTS: usize = 1_000_000;

declare! {
    /// Complex eigenvalues along one scalar of the case.
    pub struct SweepAnalysis {
        /// The path of the scalar.
        pub parameter: String = key::name("the path of a scalar of the case"),
        /// Its first value.
        pub from: f64 = key::quantity_of_scalar().expecting("the first value"),
        /// Its last value.
        pub to: f64 = key::quantity_of_scalar().expecting("the last value"),
        /// How many values.
        pub points: usize = key::whole(2..=POINTS).or(41),
        /// Equal ratios instead of equal steps.
        pub log: bool = key::flag(false),
    }
}

declare! {
    /// Complex eigenvalues over a grid of two scalars of the case.
    pub struct MapAnalysis {
        /// The paths of the scalars.
        pub parameters: [String; 2] = key::value::<[String; 2]>("the paths of two scalars")
            .check("two different scalars", |[a, b]| a != b && [a, b].iter().all(|path| key::is_name(path))),
        /// Their first values.
        pub from: [f64; 2] = key::quantities_of_scalars().expecting("the first value of each"),
        /// Their last values.
        pub to: [f64; 2] = key::quantities_of_scalars().expecting("the last value of each"),
        /// How many values of each.
        pub points: [usize; 2] = key::value::<[usize; 2]>("a list of two whole numbers")
            .check("from 2 of each to a million in all", |[a, b]| {
                *a >= 2 && *b >= 2 && a.checked_mul(*b).is_some_and(|n| n <= POINTS)
            })
            .or([40, 25]),
        /// Equal ratios instead of equal steps.
        pub log: [bool; 2] = key::value::<[bool; 2]>("a list of two of true and false").or([false; 2]),
    }
}

/// Checks sweeps and maps against the case; `scalars` are those of the case, where they are known.
pub(super) fn check(case: &Case, scalars: Option<&[Parameter]>, report: &mut Report) {
    let all = case.sweep.keys().map(|name| ("sweep", name)).chain(case.map.keys().map(|name| ("map", name)));
    for (key, name) in all.filter(|(_, name)| !key::is_file_name(name)) {
        report.fault(key, format!("the name \"{name}\""), "letters, digits, `-` and `_`", "");
    }
    if case.cea.is_none() && !report.unread("cea") && !(case.sweep.is_empty() && case.map.is_empty()) {
        let key = if case.sweep.is_empty() { "map" } else { "sweep" };
        report.fault(key, "no [cea] in the case", "a [cea] with the band to look at", "");
    }
    let Some(scalars) = scalars else { return };
    let bare = case.without_studies();
    for (name, sweep) in &case.sweep {
        let SweepAnalysis { parameter, from, to, log, .. } = sweep;
        let place = format!("sweep.{}", dotted(name));
        let axis = Axis { path: parameter, key: "parameter", entry: None, ends: [*from, *to], log: *log };
        axis.check(&place, &bare, scalars, report);
    }
    for (name, map) in &case.map {
        let place = format!("map.{}", dotted(name));
        for k in 0..2 {
            let axis = Axis {
                path: &map.parameters[k],
                key: "parameters",
                entry: Some(k),
                ends: [map.from[k], map.to[k]],
                log: map.log[k],
            };
            axis.check(&place, &bare, scalars, report);
        }
    }
}

/// A scalar with the ends between which it is varied.
struct Axis<'a> {
    path: &'a str,
    /// The key that names the scalar.
    key: &'static str,
    /// Its entry in lists of two.
    entry: Option<usize>,
    ends: [f64; 2],
    log: bool,
}

impl Axis<'_> {
    fn check(&self, place: &str, case: &Case, scalars: &[Parameter], report: &mut Report) {
        let key = |key: &str| format!("{place}.{key}");
        if report.unread(&key(self.key)) || self.path.is_empty() {
            return;
        }
        let parameter = match scalars.iter().find(|p| p.path == self.path) {
            None => return no_number(report, &key(self.key), self.path, scalars),
            Some(p) if p.invalidates == Invalidates::Question => {
                let found = format!("`{}`, which only says what is asked", self.path);
                let expected = "a scalar of the model, one that eigenvalues depend on";
                return report.fault(&key(self.key), found, expected, "");
            }
            Some(p) => p,
        };
        let dimension = dimension_of(parameter.unit);
        let [from, to] = self.ends;
        let mut sound = true;
        for (name, value) in [("from", from), ("to", to)] {
            let given = report.given(&key(name));
            let mine = |k: usize| self.entry.is_none_or(|entry| entry == k);
            let wrong = given.iter().filter(|(k, _)| mine(*k));
            let wrong: Vec<String> =
                wrong.filter_map(|(_, text)| parse_of_scalar(text, dimension).err()).collect();
            sound &= wrong.is_empty() && !report.unread(&key(name));
            for found in wrong {
                report.fault(&key(name), found, dimension.name, "");
            }
            if !sound {
                continue;
            }
            if let Some(expected) = refused(case, self.path, value) {
                report.fault(&key(name), format!("{value} for `{}`", self.path), expected, "");
            }
        }
        if sound && from == to {
            report.fault(&key("to"), format!("{to}, as `from`"), "another value than `from`", "");
        }
        if sound && self.log && from * to <= 0.0 {
            let found = format!("{from} to {to} in equal ratios");
            let expected = "two values of one sign, neither zero, or `log = false`";
            report.fault(&key("log"), found, expected, "");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;

    const CASE: &str = include_str!("../../validation/two-dof/case.toml");

    fn parse(more: &str) -> Result<Case> {
        Case::parse("case.toml", &format!("{CASE}\n{more}"), ".".into())
    }

    const SWEEP: &str = "[sweep.mu]\nparameter = \"contact.belt.friction.mu0\"\nfrom = 0.1\nto = 0.9\npoints = 9\n\
        [map.both]\nparameters = [\"contact.belt.friction.mu0\", \"contact.belt.normal.stiffness\"]\n\
        from = [0.1, \"1 N/m\"]\nto = [0.9, \"0.003 kN/m\"]\npoints = [5, 4]\nlog = [false, true]\n";

    #[test]
    fn sweeps_and_maps_read_back_from_the_resolved_case() {
        let case = parse(SWEEP).unwrap();
        assert_eq!(case.sweep["mu"].points, 9);
        assert_eq!((case.map["both"].from, case.map["both"].to), ([0.1, 1.0], [0.9, 3.0]));
        let again = Case::parse("again", &case.to_toml(), ".".into()).unwrap();
        assert_eq!(again, case);
        assert!(case.parameter("sweep.mu.from").unwrap().invalidates == Invalidates::Question);
        assert!(case.without_studies().with_parameter("contact.belt.friction.mu0", 0.3).is_ok());
    }

    #[test]
    fn a_scalar_is_found_below_a_name_with_dots() {
        let sweep = "[sweep.mu]\nparameter = 'contact.\"belt.1\".friction.mu0'\nfrom = 0.1\nto = 0.9\n";
        let text = format!("{CASE}\n{sweep}").replace("[contact.belt]", "[contact.\"belt.1\"]");
        let case = Case::parse("case.toml", &text, ".".into()).unwrap();
        let path = &case.sweep["mu"].parameter;
        assert_eq!(case.parameter(path).unwrap().invalidates, Invalidates::Law);
        let other = case.with_parameter(path, 0.7).unwrap();
        assert_eq!(other.parameter(path).unwrap().value, 0.7);
        let wrong = text.replace("mu0 = 0.4", "mu0 = -1");
        let error = Case::parse("case.toml", &wrong, ".".into()).unwrap_err().to_string();
        assert!(error.contains("`contact.\"belt.1\".friction.mu0`"), "{error}");
    }

    #[test]
    fn every_fault_is_found_at_once() {
        let text = SWEEP
            .replace("belt.friction.mu0\"\nfrom = 0.1", "belt.friction.mu\"\nfrom = 0.1")
            .replace("points = 9", "points = 1")
            .replace("from = [0.1, \"1 N/m\"]", "from = [-0.1, \"1 N/m\"]")
            .replace("\"0.003 kN/m\"", "\"1 N/m\"");
        let more = "[sweep.band]\nparameter = \"cea.band.1\"\nfrom = 1\nto = 2\n\
            [sweep.load]\nparameter = \"contact.belt.sliding_velocity\"\nfrom = \"1 kg\"\nto = 0\nlog = true\n";
        let error = parse(&format!("{text}{more}")).unwrap_err().to_string();
        for expected in [
            "Did you mean `contact.belt.friction.mu0`?",
            "from 2 to a million",
            "-0.1 for `contact.belt.friction.mu0`; expected a value of zero or more",
            "another value than `from`",
            "only says what is asked",
            "another dimension",
        ] {
            assert!(error.contains(expected), "{expected} not in\n{error}");
        }
        let error =
            parse("[sweep.v]\nparameter = \"contact.belt.sliding_velocity\"\nfrom = 0\nto = 2\nlog = true\n");
        let error = error.unwrap_err().to_string();
        assert!(
            error.contains("a contact that pulls does not stick") && error.contains("equal ratios"),
            "{error}"
        );
        let without = CASE.replace("[cea]\nband = [0, \"1 Hz\"]", "");
        let error = Case::parse("c", &format!("{without}\n{SWEEP}"), ".".into()).unwrap_err().to_string();
        assert!(error.contains("no [cea]"), "{error}");
    }
    /// A contact that slides is at rest at zero, where a study would compare two kinds of contact.
    #[test]
    fn no_study_takes_a_contact_from_sliding_to_rest() {
        let sliding =
            CASE.replace("unilateral = false", "unilateral = true").replace("approach = 0", "load = \"1 N\"");
        let resting = sliding.replace("sliding_velocity = \"1 m/s\"", "sliding_velocity = 0");
        let studies = |from: &str, to: &str| {
            [
                format!(
                    "[sweep.v]\nparameter = \"contact.belt.sliding_velocity\"\nfrom = {from}\nto = {to}\n"
                ),
                format!(
                    "[map.v]\nparameters = [\"contact.belt.friction.mu0\", \"contact.belt.sliding_velocity\"]\n\
                     from = [0.1, {from}]\nto = [0.3, {to}]\n"
                ),
                format!(
                    "[uncertainty.v.parameter.v]\npath = \"contact.belt.sliding_velocity\"\nbetween = [{from}, {to}]\n"
                ),
            ]
        };
        let error_of =
            |text: String| Case::parse("c", &text, ".".into()).err().map(|error| error.to_string());
        for study in studies("0", "2") {
            let words = error_of(format!("{sliding}\n{study}")).unwrap();
            assert!(words.contains("a velocity at which [contact.belt] slides"), "{words}");
            let words = error_of(format!("{resting}\n{study}")).unwrap();
            assert!(words.contains("[contact.belt] sticks, and would slide"), "{words}");
        }
        for study in studies("0.5", "2") {
            assert_eq!(error_of(format!("{sliding}\n{study}")), None);
        }
    }
}
