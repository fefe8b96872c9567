//! `[uncertainty.NAME]`: complex eigenvalues of samples of uncertain scalars.

use super::varied::check_parameters;
use super::{Case, Invalidates, Parameter, VariedParameter};
use crate::schema::raw::MOST;
use crate::schema::units::NUMBER;
use crate::schema::{Report, declare, dotted, key};
use crate::uncertainty::{Distribution, Sampling};
use std::collections::BTreeMap;
use std::ops::Bound;

/// The fewest and the most samples.
const SAMPLES: [usize; 2] = [10, 1_000_000];

declare! {
    /// Complex eigenvalues of samples of uncertain scalars: how probable it is that a mode grows, and which scalar decides.
    pub struct UncertaintyAnalysis {
        /// How many samples.
        pub samples: usize = key::whole(SAMPLES[0]..=SAMPLES[1]).or(1000),
        /// How they are drawn.
        pub sampling: Sampling = key::choice().or(Sampling::LatinHypercube),
        /// The same seed gives the same samples.
        pub seed: usize = key::whole(0..=MOST).or(1),
        /// How often the interval of a probability is to contain it.
        pub confidence: f64 =
            key::quantity(NUMBER).within(Bound::Included(0.5), Bound::Included(0.9999)).or(0.95),
        /// The uncertain scalars by name: uniform between the bounds, or normal where a `deviation` is given, of the logarithm
        /// with `log`; independent of each other.
        pub parameter: BTreeMap<String, VariedParameter> = key::named(),
    }
}

/// Checks the studies against the case; `scalars` are those of the case, where they are known.
pub(super) fn check(case: &Case, scalars: Option<&[Parameter]>, report: &mut Report) {
    for name in case.uncertainty.keys().filter(|name| !key::is_file_name(name)) {
        report.fault("uncertainty", format!("the name \"{name}\""), "letters, digits, `-` and `_`", "");
    }
    if case.cea.is_none() && !report.unread("cea") && !case.uncertainty.is_empty() {
        report.fault("uncertainty", "no [cea] in the case", "a [cea] with the band to look at", "");
    }
    let bare = case.without_studies();
    for (name, study) in &case.uncertainty {
        let place = format!("uncertainty.{}.parameter", dotted(name));
        check_parameters(&study.parameter, &place, &bare, scalars, report);
        let question = |path: &&String| {
            let of = scalars.and_then(|all| all.iter().find(|p| p.path == **path));
            // Others have a fault already.
            of.is_some_and(|p| p.invalidates == Invalidates::Question && path.ends_with(".frequency_scale"))
        };
        for (parameter, of) in &study.parameter {
            for path in of.path.iter().filter(question) {
                let found = format!("`{path}`, which only says what is asked");
                let expected = "a scalar of the model, one that eigenvalues depend on";
                report.fault(&format!("{place}.{}.path", dotted(parameter)), found, expected, "");
            }
        }
    }
}

impl VariedParameter {
    /// Its distribution: uniform inside the bounds, or normal about the expected value where a deviation is given.
    pub fn distribution(&self) -> Distribution {
        let normal = self.deviation.map(|deviation| [self.expectation(), deviation]);
        Distribution { between: self.between, normal, log: self.log }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;

    const CASE: &str = include_str!("../../validation/two-dof/case.toml");
    const STUDY: &str = "[uncertainty.all]\nsamples = 40\nsampling = \"random\"\n\
        [uncertainty.all.parameter.friction]\npath = \"contact.belt.friction.mu0\"\nbetween = [0.1, 0.9]\ndeviation = 0.1\n\
        [uncertainty.all.parameter.load]\npath = \"contact.belt.normal.stiffness\"\nbetween = [\"1 N/m\", \"0.003 kN/m\"]\nlog = true\n";

    fn parse(more: &str) -> Result<Case> {
        Case::parse("case.toml", &format!("{CASE}\n{more}"), ".".into())
    }

    #[test]
    fn studies_read_back_from_the_resolved_case() {
        let case = parse(STUDY).unwrap();
        let study = &case.uncertainty["all"];
        assert_eq!((study.samples, study.seed, study.confidence), (40, 1, 0.95));
        let friction = study.parameter["friction"].distribution();
        let own = case.parameter("contact.belt.friction.mu0").unwrap().value;
        assert_eq!(friction, Distribution { between: [0.1, 0.9], normal: Some([own, 0.1]), log: false });
        let load = study.parameter["load"].distribution();
        assert_eq!(load, Distribution { between: [1.0, 3.0], normal: None, log: true });
        assert_eq!(Case::parse("again", &case.to_toml(), ".".into()).unwrap(), case);
        assert!(case.without_studies().uncertainty.is_empty());
    }

    #[test]
    fn every_fault_is_found_at_once() {
        let text = STUDY
            .replace("samples = 40", "samples = 9")
            .replace("\"random\"", "\"sobol\"")
            .replace("mu0\"\nbetween = [0.1", "mu\"\nbetween = [-0.1")
            .replace("\"0.003 kN/m\"", "\"1 N/m\"");
        let more = "[uncertainty.\"a b\"]\nconfidence = 1\n[uncertainty.c]\n[uncertainty.c.parameter.a]\n\
            path = \"contact.belt.friction.mu0\"\nbetween = [-0.1, 0.5]\n[uncertainty.c.parameter.b]\n\
            path = [\"contact.belt.friction.mu0\", \"cea.band.1\"]\nbetween = [0.1, 0.5]\n";
        let error = parse(&format!("{text}{more}")).unwrap_err().to_string();
        for expected in [
            "from 10 to a million",
            "expected one of latin_hypercube, random",
            "Did you mean `contact.belt.friction.mu0`?",
            "the lower bound before the upper one",
            "the name \"a b\"",
            "a b.confidence`",
            "at least one table [uncertainty.",
            "-0.1 for `contact.belt.friction.mu0`; expected a value of zero or more",
            "`contact.belt.friction.mu0` twice",
            "only says what is asked",
        ] {
            assert!(error.contains(expected), "{expected} not in\n{error}");
        }
        let without = CASE.replace("[cea]\nband = [0, \"1 Hz\"]", "");
        let error = Case::parse("c", &format!("{without}\n{STUDY}"), ".".into()).unwrap_err().to_string();
        assert!(error.contains("no [cea]"), "{error}");
    }
}
