//! `[calibrate]`: scalars of the case to be found from measured modes and frequency responses.

use super::varied::check_parameters;
use super::{
    Case, ContactPoints, ContactState, Equation, Matrices, MatrixTerm, MeshSource, Parameter, VariedParameter,
};
use crate::error::Result;
use crate::schema::units::NUMBER;
use crate::schema::{Report, declare, key};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Bound;

/// The name in `against` that stands for `cea.measured_squeal`.
pub const SQUEAL: &str = "squeal";

declare! {
    /// Scalars to be found from measured modes and frequency responses.
    pub struct CalibrateAnalysis {
        /// Names of `[modes.NAME]` with measured frequencies, of `[measured.NAME]`, and `squeal` for those of `[cea]`.
        pub against: Vec<String> = key::names(
            "names of [modes.NAME] with measured frequencies, of [measured.NAME], or \"squeal\"",
        ).check("at least one name", |list| !list.is_empty()),
        /// Relative standard deviation of a measured frequency.
        pub deviation: f64 = key::quantity(NUMBER).positive().or(0.005),
        /// Takes the measured shapes of `[measured.NAME]` in, not its frequencies alone.
        pub shapes: bool = key::flag(true),
        /// Takes the measured frequency responses of `[measured.NAME]` with `frf` in.
        pub responses: bool = key::flag(true),
        /// A computed mode may be what was measured when, linearised, it comes as near as a factor 1 + this inside the bounds.
        pub mode_reach: f64 =
            key::quantity(NUMBER).within(Bound::Included(0.0), Bound::Excluded(1.0)).or(0.2),
        /// Predicts each measured mode and each response from all others.
        pub leave_one_out: bool = key::flag(true),
        /// Draws of measured sets that mean nothing, for the probability that frequencies match by chance; 0 for none.
        pub chance_draws: usize = key::whole(0..=1_000_000).or(1000),
        /// Fits of synthetic data, for the coverage of the intervals; 0 for none.
        pub trials: usize = key::whole(0..=1_000_000).or(0),
        /// Scalars to be found, by name.
        pub parameter: BTreeMap<String, VariedParameter> = key::named(),
    }
}

/// Checks `[calibrate]` against the case; `scalars` are those of the case, where they are known.
pub(super) fn check(case: &Case, scalars: Option<&[Parameter]>, report: &mut Report) {
    let Some(analysis) = &case.calibrate else { return };
    if !report.unread("calibrate.against") {
        check_against(case, analysis, report);
    }
    check_parameters(&analysis.parameter, "calibrate.parameter", &case.without_studies(), scalars, report);
}

fn check_against(case: &Case, analysis: &CalibrateAnalysis, report: &mut Report) {
    let against = &analysis.against;
    let positive = |all: &[f64]| all.iter().all(|hz| *hz > 0.0);
    for (k, name) in against.iter().enumerate() {
        let mut fault = |found: &str, expected: &str| {
            report.fault("calibrate.against", format!("\"{name}\"{found}"), expected, "");
        };
        if against[..k].contains(name) {
            fault(" twice", "each name once");
        }
        if name == SQUEAL {
            if case.cea.as_ref().is_none_or(|cea| cea.measured_squeal.is_empty()) {
                fault(" without measured frequencies", "a [cea] with `measured_squeal`");
            }
            if case.cea.as_ref().is_some_and(|cea| !positive(&cea.measured_squeal)) {
                fault(" with a measured frequency that is not above zero", "frequencies above zero");
            }
            continue;
        }
        if let Some(measured) = case.measured.get(name) {
            if case.modes.contains_key(name) {
                fault(", which is the name of real modes, too", "another name of [measured.NAME]");
            }
            let modes = measured.of.as_ref().and_then(|of| case.modes.get(of));
            let known = measured.frf.as_ref().is_some_and(|frf| case.frf.contains_key(frf));
            let responses = measured.of.is_none() && known && analysis.responses;
            if !responses && modes.is_none_or(|modes| modes.contact == ContactState::Closed) {
                fault(" without real modes", &format!("`of` in [measured.{name}]: modes with open contact"));
            }
            continue;
        }
        match case.modes.get(name) {
            None => {
                let known: Vec<&str> =
                    case.modes.keys().chain(case.measured.keys()).map(String::as_str).collect();
                fault(
                    "",
                    &format!(
                        "\"{SQUEAL}\", or the name of real modes or of measured data ({})",
                        known.join(", ")
                    ),
                );
            }
            Some(modes) if modes.measured.is_empty() => {
                fault(" without measured frequencies", &format!("`measured` in [modes.{name}]"));
            }
            Some(modes) if !positive(&modes.measured) => {
                fault(" with a measured frequency that is not above zero", "frequencies above zero");
            }
            Some(modes) if modes.contact == ContactState::Closed => {
                fault(" with closed contact", "real modes with open contact");
            }
            Some(_) => {}
        }
    }
}

impl Case {
    /// The same case with the scalars of some numbers at values \[SI\], one a number.
    pub(crate) fn with_numbers<'a>(
        &self,
        numbers: impl IntoIterator<Item = &'a VariedParameter>,
        values: &[f64],
    ) -> Result<Case> {
        let each = numbers.into_iter().zip(values);
        self.with_parameters(each.flat_map(|(p, value)| p.path.iter().map(move |path| (path, *value))))
    }

    /// The same case with every number that is to be found at its value in `values` \[SI\], in the order of the names.
    ///
    /// # Errors
    /// A value that the case refuses.
    pub fn with_calibrated(&self, values: &[f64]) -> Result<Case> {
        let parameters = self.calibrate.iter().flat_map(|c| c.parameter.values());
        let case = Case { calibrate: None, ..self.clone() }.with_numbers(parameters, values)?;
        Ok(Case { calibrate: self.calibrate.clone(), ..case })
    }

    /// The same case with the whole path of every file it names, so that it loads from any folder.
    pub fn with_absolute_paths(&self) -> Case {
        let mut case = self.clone();
        for file in case.files_mut() {
            // Without a current folder, which is all that can be missing, the path stays as it is.
            if let Ok(path) = std::path::absolute(self.folder.join(&*file)) {
                *file = path.to_string_lossy().into_owned();
            }
        }
        case
    }

    /// The path of every file that the case reads, as the case names it; each once.
    pub fn files(&self) -> BTreeSet<String> {
        self.clone().files_mut().into_iter().map(std::mem::take).collect()
    }

    fn files_mut(&mut self) -> Vec<&mut String> {
        let mut files = Vec::new();
        if let Some(MeshSource::File { file, .. }) = &mut self.mesh {
            files.push(file);
        }
        if let Some(Matrices { mass, stiffness, damping, load, dofs, scalar: _, term }) = &mut self.matrices {
            files.extend([mass, stiffness]);
            files.extend([damping, load, dofs].into_iter().flatten());
            for MatrixTerm { factor: _, mass, damping, stiffness } in term.values_mut() {
                files.extend([mass, damping, stiffness].into_iter().flatten());
            }
        }
        files.extend(self.equation.values_mut().filter_map(|equation| match equation {
            Equation::File { file } => Some(file),
            Equation::Terms { .. } => None,
        }));
        files.extend(self.measured.values_mut().filter_map(|measured| measured.file.as_mut()));
        files.extend(self.contact.values_mut().filter_map(|contact| match &mut contact.points {
            Some(ContactPoints::File(file)) => Some(file),
            _ => None,
        }));
        files
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = include_str!("../../validation/annulus-02/case.toml");

    fn parse(more: &str) -> Result<Case> {
        let measured = format!("{CASE}measured = [200, 300]\n[modes.other]\ncount = 3\n");
        Case::parse("case.toml", &format!("{measured}{more}"), ".".into())
    }

    #[test]
    fn it_reads_back_from_the_resolved_case() {
        let case = parse(
            "[calibrate]\nagainst = \"disc\"\n[calibrate.parameter.hub]\npath = \"mesh.annulus.hub_radius\"\n\
             between = [\"10 mm\", \"20 mm\"]\ndeviation = \"2 mm\"\n[calibrate.parameter.scale]\n\
             path = \"modes.disc.frequency_scale\"\nbetween = [0.9, 1.1]\nlog = true\n",
        )
        .unwrap();
        let calibrate = case.calibrate.as_ref().unwrap();
        let hub = &calibrate.parameter["hub"];
        assert_eq!((hub.between, hub.expected, hub.deviation), ([0.01, 0.02], Some(0.015), Some(0.002)));
        assert_eq!((calibrate.deviation, calibrate.chance_draws, calibrate.trials), (0.005, 1000, 0));
        assert_eq!(Case::parse("again", &case.to_toml(), ".".into()).unwrap(), case);
        let moved = case.with_calibrated(&[0.018, 0.97]).unwrap();
        assert_eq!(moved.parameter("mesh.annulus.hub_radius").unwrap().value, 0.018);
        assert_eq!(moved.modes["disc"].frequency_scale, 0.97);
        assert_eq!(Case::parse("again", &moved.to_toml(), ".".into()).unwrap(), moved);
    }

    #[test]
    fn every_fault_is_found_at_once() {
        let error = parse(
            "[calibrate]\nagainst = [\"disc\", \"disk\", \"other\", \"squeal\", \"disc\"]\ndeviation = 0\n\
             [calibrate.parameter.a]\npath = \"mesh.annulus.hub_radiu\"\nbetween = [1, 2]\n\
             [calibrate.parameter.b]\npath = \"shell.disc.thickness\"\nbetween = [\"2 mm\", \"0 mm\"]\n\
             [calibrate.parameter.c]\npath = \"shell.disc.thickness\"\nbetween = [\"2 mm\", \"3 mm\"]\n\
             [calibrate.parameter.d]\npath = \"material.steel.poissons_ratio\"\nbetween = [0.2, 0.6]\nexpected = 0.7\n\
             [calibrate.parameter.e]\npath = \"modes.disc.below\"\n\
             [calibrate.parameter.f]\npath = [\"material.steel.density\", \"material.steel.youngs_modulus\"]\n\
             between = [0, 9e9]\nlog = true\nfoo = 1\n",
        )
        .unwrap_err()
        .to_string();
        for expected in [
            "\"disk\"; expected \"squeal\", or the name of real modes or of measured data (disc, other)",
            "\"other\" without measured",
            "\"squeal\" without measured",
            "\"disc\" twice",
            "Did you mean `mesh.annulus.hub_radius`?",
            "the lower bound before the upper one",
            "`shell.disc.thickness` twice",
            "0.6 for `material.steel.poissons_ratio`; expected a value above -1 and below 0.5",
            "a value inside the bounds",
            "only says what is asked",
            "scalars of one unit",
            "bounds above zero with `log`",
            "`calibrate.deviation`",
            "unknown key",
        ] {
            assert!(error.contains(expected), "{expected} not in\n{error}");
        }
        let error =
            parse("[calibrate]\nagainst = \"disc\"\n[calibrate.parameter.a]\npath = []\n").unwrap_err();
        assert!(error.to_string().contains("at least one path"), "{error}");
        let error = parse("[calibrate]\nagainst = []\n").unwrap_err().to_string();
        assert!(
            error.contains("at least one name") && error.contains("[calibrate.parameter.NAME]"),
            "{error}"
        );
    }
}
