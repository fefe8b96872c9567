//! A scalar of the case, or several of one value, to be varied between bounds: what a calibration and a search look for, and what is
//! uncertain in a study of samples.

use super::{Case, Invalidates, Parameter};
use crate::error::{Error, Fault, Result, nearest};
use crate::schema::units::{NUMBER, dimension_of, parse_of_scalar};
use crate::schema::{Report, declare, dotted, key, keys_of};
use std::collections::BTreeMap;

declare! {
    /// A scalar to be varied, or several of one value.
    pub struct VariedParameter {
        /// The paths of the scalars that have this value.
        pub path: Vec<String> = key::names("the path of a scalar of the case, or of several that are the same")
            .check("at least one path", |paths| !paths.is_empty()),
        /// Takes equal ratios, not equal differences, as equal steps.
        pub log: bool = key::flag(false),
        /// The least and the largest value \[SI\].
        pub between: [f64; 2] = {
            let log = *log;
            key::quantities_of_scalars()
                .expecting("two bounds")
                .check("the lower bound before the upper one", |[low, high]| low < high)
                .check("bounds above zero with `log`", move |[low, _]| !log || *low > 0.0)
        },
        /// Expected value \[SI\]; that of the case by default.
        pub expected: Option<f64> = {
            let [low, high] = *between;
            key::quantity_of_scalar()
                .check("a value inside the bounds", move |v| low >= high || (low..=high).contains(v))
                .optional()
        },
        /// Standard deviation of what is expected \[SI\]; its share of the value where `log`. Without it every value inside the
        /// bounds is as good.
        pub deviation: Option<f64> = key::quantity_of_scalar().positive().optional(),
    }
}

/// Checks the parameters of a study, whose tables are below `place`; `scalars` are those of the case, where they are known.
pub(super) fn check_parameters(
    parameters: &BTreeMap<String, VariedParameter>,
    place: &str,
    case: &Case,
    scalars: Option<&[Parameter]>,
    report: &mut Report,
) {
    if parameters.is_empty() && !report.unread(place) {
        report.fault(place, "nothing", format!("at least one table [{place}.NAME]"), "");
    }
    for (name, parameter) in parameters {
        check_parameter(parameter, &format!("{place}.{}", dotted(name)), case, scalars, report);
    }
    let all: Vec<(&String, &String)> =
        parameters.iter().flat_map(|(name, p)| p.path.iter().map(move |path| (name, path))).collect();
    for (k, (name, path)) in all.iter().enumerate() {
        if all[..k].iter().any(|(_, other)| other == path) {
            let key = format!("{place}.{}.path", dotted(name));
            report.fault(&key, format!("`{path}` twice"), "each scalar once", "");
        }
    }
}

/// Checks a parameter of a study of `case`, whose table is at `place`; `scalars` are those of the case, where they are known.
pub(crate) fn check_parameter(
    parameter: &VariedParameter,
    place: &str,
    case: &Case,
    scalars: Option<&[Parameter]>,
    report: &mut Report,
) {
    let key = |key: &str| if place.is_empty() { key.to_string() } else { format!("{place}.{key}") };
    let VariedParameter { path, between, log, .. } = parameter;
    let Some(all) = scalars.filter(|_| !report.unread(&key("path"))) else { return };
    let found: Option<Vec<&Parameter>> =
        path.iter().map(|path| find(report, &key("path"), all, path)).collect();
    let Some(first) = found.as_ref().and_then(|found| found.first()) else { return };
    let dimension = dimension_of(first.unit);
    for other in found.iter().flatten().filter(|p| p.unit != first.unit) {
        let found = format!("`{}` in {} beside {}", other.path, other.unit, first.unit);
        report.fault(&key("path"), found, "scalars of one unit", "");
    }
    let share = if *log { NUMBER } else { dimension };
    for (name, dimension) in [("between", dimension), ("expected", dimension), ("deviation", share)] {
        for (_, text) in report.given(&key(name)) {
            if let Err(found) = parse_of_scalar(&text, dimension) {
                report.fault(&key(name), found, dimension.name, "");
            }
        }
    }
    let sound = between[0] < between[1] && !report.unread(&key("between"));
    for value in between.iter().filter(|_| sound) {
        let refused = path.iter().find_map(|path| refused(case, path, *value).map(|why| (path, why)));
        if let Some((path, expected)) = refused {
            report.fault(&key("between"), format!("{value} for `{path}`"), expected, "");
        }
    }
}

/// What a study of the case expects in place of `value` at `path`, if that cannot be.
pub(super) fn refused(case: &Case, path: &str, value: f64) -> Option<String> {
    let other = match case.with_parameter(path, value) {
        Ok(other) => other,
        Err(Error::Input(faults)) => {
            return Some(faults.0.first().map_or(String::new(), |f| f.expected.clone()));
        }
        Err(other) => return Some(other.to_string()),
    };
    case.contact.iter().find(|(name, contact)| contact.rests() != other.contact[*name].rests()).map(
        |(name, contact)| match contact.rests() {
            true => format!(
                "no study of this: [contact.{name}] sticks, and would slide; give it a velocity first"
            ),
            false => format!("a velocity at which [contact.{name}] slides: at rest it sticks"),
        },
    )
}

fn find<'a>(report: &mut Report, key: &str, all: &'a [Parameter], path: &str) -> Option<&'a Parameter> {
    match all.iter().find(|p| p.path == path) {
        Some(p) if p.invalidates == Invalidates::Question && !is_scale(path) => {
            let expected = "a scalar of the model, or the `frequency_scale` of real modes";
            report.fault(key, format!("`{path}`, which only says what is asked"), expected, "");
            None
        }
        Some(p) => Some(p),
        None => {
            no_number(report, key, path, all);
            None
        }
    }
}

/// Notes that `path` is no number of a case, with the nearest one that is.
pub(super) fn no_number(report: &mut Report, key: &str, path: &str, all: &[Parameter]) {
    let help = nearest(path, all.iter().map(|p| p.path.as_str()))
        .map_or("`stridor check CASE --parameters` lists them".to_string(), |near| {
            format!("Did you mean `{near}`?")
        });
    report.fault(key, format!("`{path}`, no number of the case"), "the path of a scalar", &help);
}

/// Whether `path` is the `frequency_scale` of a set of real modes.
fn is_scale(path: &str) -> bool {
    matches!(&keys_of(path)[..], [modes, _, scale] if modes == "modes" && scale == "frequency_scale")
}

impl VariedParameter {
    /// Expected value \[SI\]: that of the case, or the middle of the bounds where it is not known.
    pub fn expectation(&self) -> f64 {
        self.expected.unwrap_or(0.5 * (self.between[0] + self.between[1]))
    }

    /// The value that its scalars have in `case`, where a search starts; `place` says where a key of it stands.
    ///
    /// # Errors
    /// Scalars whose values differ, or are outside the bounds.
    pub fn start(&self, case: &Case, place: impl Fn(&str) -> String) -> Result<f64> {
        let values = self.path.iter().map(|path| Ok(case.parameter(path)?.value));
        let values: Vec<f64> = values.collect::<Result<_>>()?;
        let [low, high] = self.between;
        if values.iter().any(|value| *value != values[0]) {
            let found = format!("values {values:?}");
            return Err(Error::input(Fault::new(place("path"), found, "scalars of one value")));
        }
        if !(low..=high).contains(&values[0]) {
            let found = format!("bounds {low} to {high} without the case's own value {}", values[0]);
            let expected = "bounds that hold the value of the case, where the search starts";
            return Err(Error::input(Fault::new(place("between"), found, expected)));
        }
        Ok(values[0])
    }
}

impl Case {
    /// Every parameter of a calibration or of uncertain scalars expects the value that it has, within its bounds, unless the case says
    /// otherwise.
    pub(super) fn expect_own_values(&mut self) {
        if self.calibrate.is_none() && self.uncertainty.is_empty() {
            return;
        }
        let all = self.parameters();
        let calibrated = self.calibrate.iter_mut().flat_map(|calibrate| calibrate.parameter.values_mut());
        let uncertain = self.uncertainty.values_mut().flat_map(|study| study.parameter.values_mut());
        for parameter in calibrated.chain(uncertain) {
            let first = parameter.path.first().and_then(|path| all.iter().find(|p| p.path == *path));
            let [low, high] = parameter.between;
            parameter.expected = parameter.expected.or(first.map(|p| p.value.clamp(low, high)));
        }
    }
}
