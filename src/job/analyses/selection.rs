//! The list of the analyses, and which of them to run.

use super::analysis::{Analysis, Scope};
use super::{calibrate, cea, frf, modes, sensitivity, sweep, transient, uncertainty};
use crate::case::Case;
use crate::error::{Fault, Faults, Result};

/// All analyses, in the order in which they run.
pub const ANALYSES: [Analysis; 8] = [
    modes::MODES,
    cea::CEA,
    sensitivity::SENSITIVITY,
    transient::TRANSIENT,
    sweep::SWEEP,
    uncertainty::UNCERTAINTY,
    frf::FRF,
    calibrate::CALIBRATE,
];

/// Which analyses to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Selection {
    /// Every one that the case lists.
    Listed,
    /// The one of this name, with those that it needs.
    Only(&'static str),
    /// Real modes and frequency responses that were measured.
    Measured,
}

impl Selection {
    /// Whether `analysis` is run for `case`.
    pub(in crate::job) fn takes(self, analysis: &Analysis, case: &Case) -> bool {
        match self {
            Selection::Listed => (analysis.listed)(case) && needed(analysis).iter().all(|a| (a.listed)(case)),
            Selection::Only(name) => {
                let own = ANALYSES.into_iter().find(|own| own.name == name);
                own.is_some_and(|own| own.name == analysis.name || own.needs.contains(&analysis.name))
            }
            Selection::Measured => ["modes", "frf"].contains(&analysis.name),
        }
    }

    /// Which of their items they take.
    pub(in crate::job) fn scope(self) -> Scope {
        if self == Selection::Measured { Scope::Measured } else { Scope::All }
    }

    /// The analyses that are run for `case`, in their order.
    pub(in crate::job) fn analyses(self, case: &Case) -> impl Iterator<Item = Analysis> {
        ANALYSES.into_iter().filter(move |analysis| self.takes(analysis, case))
    }

    /// Whether the analysis called `name` is run for `case`.
    pub(in crate::job) fn includes(self, name: &str, case: &Case) -> bool {
        self.analyses(case).any(|analysis| analysis.name == name)
    }

    /// Whether an analysis that is run for `case` takes the left vectors of the complex modes.
    pub(in crate::job) fn takes_left_vectors(self, case: &Case) -> bool {
        self.analyses(case).any(|analysis| analysis.left_vectors)
    }

    /// Refuses a case that lacks a table of an analysis that is requested by name.
    pub(in crate::job) fn check(self, case: &Case) -> Result<()> {
        let mut faults = Faults::new();
        if let Selection::Only(_) = self {
            for analysis in self.analyses(case).filter(|analysis| !(analysis.ready)(case)) {
                faults.take::<()>(Err(analysis.no_table()));
            }
        }
        let measured = |case: &Case| {
            !case.measured.is_empty() || case.modes.values().any(|modes| !modes.measured.is_empty())
        };
        if self == Selection::Measured && !measured(case) {
            faults.push(Fault::new("`measured`", "no measured data in the case", "a table [measured.NAME]"));
        }
        faults.into_result(())
    }
}

/// The analyses whose results `analysis` starts from.
fn needed(analysis: &Analysis) -> Vec<Analysis> {
    let needs = analysis.needs;
    ANALYSES.into_iter().filter(|other| needs.contains(&other.name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_analysis_runs_after_those_it_needs_and_has_a_name_of_its_own() {
        let names: Vec<&str> = ANALYSES.iter().map(|analysis| analysis.name).collect();
        for (k, analysis) in ANALYSES.iter().enumerate() {
            assert!(analysis.needs.iter().all(|need| names[..k].contains(need)), "{}", analysis.name);
            assert!(!names[..k].contains(&analysis.name), "{} twice", analysis.name);
            // What is needed by what is needed is listed, too.
            let further = needed(analysis).into_iter().flat_map(|other| other.needs);
            assert!(further.into_iter().all(|need| analysis.needs.contains(need)), "{}", analysis.name);
        }
    }
}
