//! `[sweep.NAME]` and `[map.NAME]`: read last, because they name scalars of the rest of the case.

use super::read::collect;
use super::reader::Section;
use super::units::{Dimension, NUMBER, dimension_of};
use super::{Case, Invalidates, MapAnalysis, Parameter, SweepAnalysis};
use crate::error::nearest;

/// The most points of one sweep or map.
const POINTS: usize = 1_000_000;

/// Reads the sweeps and maps of `case`. Their scalars are looked up when the rest of the file is sound.
pub(super) fn read(root: &Section, case: Case) -> Case {
    if !root.has("sweep") && !root.has("map") {
        return Case {
            sweep: collect(root, "sweep", |s| read_sweep(s, None)),
            map: collect(root, "map", |s| read_map(s, None)),
            ..case
        };
    }
    let scalars = root.sound_so_far().then(|| root.take(case.parameters())).flatten();
    let scalars = scalars.as_deref().map(|all| Scalars { case: &case, all });
    let sweep = collect(root, "sweep", |s| read_sweep(s, scalars.as_ref()));
    let map = collect(root, "map", |s| read_map(s, scalars.as_ref()));
    check_names(root, "sweep", &sweep);
    check_names(root, "map", &map);
    if case.cea.is_none() {
        let key = if sweep.is_empty() { "map" } else { "sweep" };
        root.fault(key, "no [cea] in the case", "a [cea] with the band to look at", "");
    }
    Case { sweep, map, ..case }
}

/// Refuses names that cannot be part of a file name.
fn check_names<T>(root: &Section, key: &str, all: &std::collections::BTreeMap<String, T>) {
    let plain = |name: &String| name.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_');
    for name in all.keys().filter(|name| !plain(name) || name.is_empty()) {
        root.fault(key, format!("the name \"{name}\""), "letters, digits, `-` and `_`", "");
    }
}

/// The scalars that a sound case has.
struct Scalars<'a> {
    case: &'a Case,
    all: &'a [Parameter],
}

impl Scalars<'_> {
    /// The scalar at `path`, which `key` names; a fault when there is none, or when it changes nothing.
    fn find(&self, s: &Section, key: &str, path: &str) -> Option<&Parameter> {
        let found = self.all.iter().find(|p| p.path == path);
        match found {
            Some(p) if p.invalidates == Invalidates::Question => {
                let expected = "a scalar of the model, one that eigenvalues depend on";
                s.fault(key, format!("`{path}`, which only says what is asked"), expected, "");
                None
            }
            Some(p) => Some(p),
            None => {
                let help = nearest(path, self.all.iter().map(|p| p.path.as_str()))
                    .map_or("`stridor check CASE --parameters` lists them".to_string(), |near| {
                        format!("Did you mean `{near}`?")
                    });
                s.fault(key, format!("`{path}`, no number of the case"), "the path of a scalar", &help);
                None
            }
        }
    }

    /// Refuses ends that the case would refuse.
    fn check(&self, s: &Section, parameter: &Parameter, ends: [(&str, f64); 2]) {
        for (key, value) in ends {
            if let Err(error) = self.case.with_parameter(&parameter.path, value) {
                let reason = match &error {
                    crate::error::Error::Input(faults) => {
                        faults.0.first().map_or(String::new(), |f| f.expected.clone())
                    }
                    other => other.to_string(),
                };
                s.fault(key, format!("{value} for `{}`", parameter.path), reason, "");
            }
        }
    }
}

fn read_sweep(s: &Section, scalars: Option<&Scalars>) -> SweepAnalysis {
    let path = s.string("parameter").required("the path of a scalar of the case");
    let parameter = scalars.filter(|_| !path.is_empty()).and_then(|all| all.find(s, "parameter", &path));
    let dimension = parameter.map_or(NUMBER, |p| dimension_of(p.unit));
    let (from, to) = match parameter {
        Some(_) => (
            s.quantity("from", dimension).required("the first value"),
            s.quantity("to", dimension).required("the last value"),
        ),
        None => {
            s.skip(&["from", "to"]);
            (0.0, 1.0)
        }
    };
    let points = s.count("points").check("from 2 to a million", |n| (2..=POINTS).contains(n)).or(41);
    let log = s.boolean("log").or(false);
    if let (Some(parameter), Some(all)) = (parameter, scalars)
        && s.has("from")
        && s.has("to")
    {
        check_ends(s, "to", from, to, log);
        all.check(s, parameter, [("from", from), ("to", to)]);
    }
    SweepAnalysis { parameter: path, from, to, points, log }
}

fn read_map(s: &Section, scalars: Option<&Scalars>) -> MapAnalysis {
    let paths = s
        .strings("parameters")
        .check("two different scalars", |list| list.len() == 2 && list[0] != list[1])
        .required("the paths of two scalars");
    let paths: [String; 2] = paths.try_into().unwrap_or_default();
    let parameters = match scalars.filter(|_| paths.iter().all(|p| !p.is_empty())) {
        Some(all) => [0, 1].map(|k| all.find(s, "parameters", &paths[k])),
        None => [None, None],
    };
    let points = s
        .two_counts("points")
        .check("from 2 of each to a million in all", |[a, b]| {
            *a >= 2 && *b >= 2 && a.checked_mul(*b).is_some_and(|n| n <= POINTS)
        })
        .or([40, 25]);
    let log = s.two_booleans("log").or([false; 2]);
    let (mut from, mut to) = ([0.0; 2], [1.0; 2]);
    if let ([Some(a), Some(b)], Some(all)) = (parameters, scalars) {
        let dimensions: [Dimension; 2] = [dimension_of(a.unit), dimension_of(b.unit)];
        from = s.two_quantities("from", dimensions).required("the first value of each");
        to = s.two_quantities("to", dimensions).required("the last value of each");
        if s.has("from") && s.has("to") {
            for (k, parameter) in [a, b].into_iter().enumerate() {
                check_ends(s, "to", from[k], to[k], log[k]);
                all.check(s, parameter, [("from", from[k]), ("to", to[k])]);
            }
        }
    } else {
        s.skip(&["from", "to"]);
    }
    MapAnalysis { parameters: paths, from, to, points, log }
}

fn check_ends(s: &Section, key: &str, from: f64, to: f64, log: bool) {
    if from == to {
        s.fault(key, format!("{to}, as `from`"), "another value than `from`", "");
    }
    if log && from * to <= 0.0 {
        let found = format!("{from} to {to} in equal ratios");
        s.fault("log", found, "two values of one sign, neither zero, or `log = false`", "");
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
        assert!(case.without_sweeps().with_parameter("contact.belt.friction.mu0", 0.3).is_ok());
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
        assert!(error.contains("no state at rest") && error.contains("equal ratios"), "{error}");
        let without = CASE.replace("[cea]\nband = [0, \"1 Hz\"]", "");
        let error = Case::parse("c", &format!("{without}\n{SWEEP}"), ".".into()).unwrap_err().to_string();
        assert!(error.contains("no [cea]"), "{error}");
    }
}
