//! Every scalar of a case has a path, such as `contact.rim.friction.mu0`, a unit, bounds, and can be set to another value.

use super::{Case, Invalidates, Parameter};
use crate::error::{Error, Fault, Faults, Result, nearest};
use crate::schema::units::{dimension_of, parse_quantity};
use crate::schema::{Report, check, scalar, scalars, set_scalar};

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
        if !set_scalar(&mut case, path, value) {
            self.parameter(path)?;
        }
        let mut report = Report::default();
        check(&mut case, &mut report);
        let named = |fault: Fault| Fault { place: format!("{path} = {value} {}", fault.place), ..fault };
        Faults(report.into_faults().into_iter().map(named).collect()).into_result(case)
    }

    /// The same case with the scalars at some paths set to values \[SI\], one after the other.
    ///
    /// # Errors
    /// As [`Case::with_parameter`].
    pub fn with_parameters<'a>(&self, values: impl IntoIterator<Item = (&'a String, f64)>) -> Result<Case> {
        values.into_iter().try_fold(self.clone(), |case, (path, value)| case.with_parameter(path, value))
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
