//! Every scalar of a case has a path, such as `contact.rim.friction.mu0`, a unit, bounds, and can be set to another value.

use super::{Case, Invalidates, Parameter};
use crate::error::{Error, Fault, Faults, Result, nearest};
use crate::schema::units::{dimension_of, parse_quantity};
use crate::schema::{Report, check, scalar, scalars, set_scalar};
use std::sync::{Mutex, PoisonError};

impl Case {
    /// Every scalar of the case, in the order of the declarations.
    pub fn parameters(&self) -> Vec<Parameter> {
        scalars(self).into_iter().map(|parameter| self.with_preload(parameter)).collect()
    }

    /// The preload's geometric stiffness follows the steady state.
    fn with_preload(&self, mut parameter: Parameter) -> Parameter {
        if self.prestress && parameter.invalidates >= Invalidates::Law {
            parameter.invalidates = Invalidates::Structure;
        }
        parameter
    }

    /// The scalar at `path`.
    ///
    /// # Errors
    /// A path that is not a number of the case, with the nearest one that is.
    pub fn parameter(&self, path: &str) -> Result<Parameter> {
        if let Some(found) = scalar(self, path) {
            return Ok(self.with_preload(found));
        }
        let all = self.parameters();
        let near = nearest(path, all.iter().map(|p| p.path.as_str()));
        let help = near.map_or("`stridor check CASE --parameters` lists them".into(), |n| {
            format!("Did you mean `{n}`?")
        });
        let place = format!("parameter `{path}`");
        let fault = Fault::new(place, "no such number in the case", "the path of a scalar");
        Err(Error::input(fault.with_help(help)))
    }

    /// The value \[SI\] that a text with a unit, such as `1.2 mm`, gives the scalar at `path`.
    ///
    /// # Errors
    /// A path that is not a number of the case, or a text that is no quantity of its dimension.
    pub fn parameter_value(&self, path: &str, text: &str) -> Result<f64> {
        let unit = self.parameter(path)?.unit;
        let expected = if unit.is_empty() { "a number".into() } else { format!("a value in {unit}") };
        parse_quantity(text, dimension_of(unit))
            .map_err(|found| Error::input(Fault::new(format!("parameter `{path}`"), found, expected)))
    }

    /// The same case with the scalar at `path` set to `value` \[SI\]; validated like a file.
    ///
    /// # Errors
    /// A path that is not a number of the case (with the nearest one that is), or a value that the case refuses.
    pub fn with_parameter(&self, path: &str, value: f64) -> Result<Case> {
        let mut case = self.clone();
        case.set([(path, value)])?;
        Ok(case)
    }

    /// The same case with the scalars at some paths set to values \[SI\].
    ///
    /// # Errors
    /// As [`Case::with_parameter`].
    pub fn with_parameters<'a>(&self, values: impl IntoIterator<Item = (&'a String, f64)>) -> Result<Case> {
        let mut case = self.clone();
        case.set(values.into_iter().map(|(path, value)| (path.as_str(), value)))?;
        Ok(case)
    }

    /// Sets the scalars at some paths to values \[SI\], which it then has, accepted or not.
    fn set<'a>(&mut self, values: impl IntoIterator<Item = (&'a str, f64)>) -> Result<()> {
        let mut given = Vec::new();
        for (path, value) in values {
            if !set_scalar(self, path, value) {
                self.parameter(path)?;
            }
            given.push(format!("{path} = {value}"));
        }
        let mut report = Report::default();
        check(self, &mut report);
        let named = |fault: Fault| Fault { place: format!("{} {}", given.join(", "), fault.place), ..fault };
        Faults(report.into_faults().into_iter().map(named).collect()).into_result(())
    }
}

/// A case whose scalars at some paths are set to other and other values: its copies, as many as are at work at once, are used again.
#[derive(Debug)]
pub struct VariedCase {
    case: Case,
    paths: Vec<String>,
    idle: Mutex<Vec<Case>>,
}

impl VariedCase {
    /// `case` with the scalars at `paths` to be varied.
    pub fn new(case: Case, paths: Vec<String>) -> Self {
        VariedCase { case, paths, idle: Mutex::default() }
    }

    /// Where the scalars are that are varied.
    pub fn paths(&self) -> &[String] {
        &self.paths
    }

    /// What `work` finds of the case with the values `at` \[SI\].
    ///
    /// # Errors
    /// As [`Case::with_parameter`], and those of `work`.
    pub fn at<T>(&self, at: &[f64], work: impl FnOnce(&Case) -> Result<T>) -> Result<T> {
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let own = idle().pop();
        let mut case = own.unwrap_or_else(|| self.case.clone());
        case.set(self.paths.iter().map(String::as_str).zip(at.iter().copied()))?;
        let found = work(&case);
        idle().push(case);
        found
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
    use super::{VariedCase, path_matches};
    use crate::case::Case;

    /// Places one after another give the cases that each of them gives by itself, on one copy; a refused one leaves nothing behind, and
    /// scalars that go together are set before they are checked.
    #[test]
    fn a_varied_case_is_the_case_with_its_parameters() {
        let text = include_str!("../../validation/rig/case.toml").replace(
            "friction = { law = \"exponential\", mu0 = 0.6, mu1 = 0.1, alpha = \"1 s/m\" }",
            "friction = { law = \"table\", velocity = [0, 1], mu = [[0.5, 0.4]] }",
        );
        let case = Case::parse("case", &text, ".".into()).unwrap().without_studies();
        let paths = [0, 1].map(|k| format!("contact.rim.friction.velocity.{k}"));
        let varied = VariedCase::new(case.clone(), paths.to_vec());
        for at in [[0.5, 0.7], [2.0, 3.0], [0.9, 0.8], [0.5, 0.6]] {
            let sound = at[0] < at[1];
            let expected = case.with_parameters(paths.iter().zip(at)).map_err(|error| error.to_string());
            let found = varied.at(&at, |case| Ok(case.clone())).map_err(|error| error.to_string());
            assert!(found == expected && found.is_ok() == sound, "{at:?}: {found:?}");
            assert_eq!(varied.idle.lock().unwrap().len(), usize::from(sound));
        }
    }

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
