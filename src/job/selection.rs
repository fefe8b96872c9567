//! Which analyses of a case to run.

use crate::case::{Case, SensitivityAnalysis};
use crate::error::{Fault, Faults, Result};

/// Which analyses to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Selection {
    /// Real modes.
    pub modes: bool,
    /// Steady sliding and complex eigenvalues.
    pub cea: bool,
    /// Sensitivities of complex eigenvalues.
    pub sensitivity: Sensitivities,
    /// Sweeps and maps, about the complex eigenvalues.
    pub sweeps: bool,
    /// Motion in time, from steady sliding.
    pub transient: bool,
    /// Frequency responses.
    pub frf: bool,
    /// Of real modes and frequency responses only those that a test found something of.
    pub measured_only: bool,
    /// Numbers of the case from measured frequencies.
    pub calibrate: bool,
}

/// When to work out sensitivities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensitivities {
    /// Never.
    No,
    /// When the case has a table `[sensitivity]`.
    WhenListed,
    /// Always, by default values when the case has no such table.
    Yes,
}

impl Selection {
    /// Everything the case lists.
    pub const ALL: Selection = Selection {
        modes: true,
        cea: true,
        sensitivity: Sensitivities::WhenListed,
        sweeps: true,
        transient: true,
        frf: true,
        measured_only: false,
        calibrate: true,
    };
    /// Real modes only.
    pub const MODES: Selection = Selection {
        modes: true,
        cea: false,
        sensitivity: Sensitivities::No,
        sweeps: false,
        transient: false,
        frf: false,
        measured_only: false,
        calibrate: false,
    };
    /// Steady sliding and complex eigenvalues only.
    pub const CEA: Selection = Selection { modes: false, cea: true, ..Selection::MODES };
    /// Complex eigenvalues and their sensitivities.
    pub const SENSITIVITY: Selection = Selection { sensitivity: Sensitivities::Yes, ..Selection::CEA };
    /// Steady sliding, complex eigenvalues, sweeps and maps.
    pub const SWEEPS: Selection = Selection { sweeps: true, ..Selection::CEA };

    /// Frequency responses only.
    pub const FRF: Selection = Selection { modes: false, frf: true, ..Selection::MODES };
    /// Real modes and frequency responses that have a measured side.
    pub const COMPARE: Selection = Selection { frf: true, measured_only: true, ..Selection::MODES };
    /// Numbers of the case from measured frequencies only.
    pub const CALIBRATE: Selection = Selection { modes: false, calibrate: true, ..Selection::MODES };
    /// Steady sliding, complex eigenvalues and motion in time.
    pub const TRANSIENT: Selection = Selection { transient: true, ..Selection::CEA };

    /// Refuses a case that lacks a table of what is selected; not where all that the case lists is.
    pub(super) fn check(&self, case: &Case) -> Result<()> {
        if *self == Selection::ALL || self.measured_only {
            return Ok(());
        }
        let explored = !(case.sweep.is_empty() && case.map.is_empty());
        let needed = [
            ("modes", self.modes, !case.modes.is_empty(), "[modes.all] with `count = 10`"),
            ("cea", self.cea, case.cea.is_some(), "[cea] with `band = [0, \"6 kHz\"]`"),
            (
                "sweep",
                self.sweeps,
                explored,
                "[sweep.mu] with `parameter = \"contact.NAME.friction.mu0\"`, `from = 0.1` and `to = 0.7`, or a [map.NAME]",
            ),
            (
                "transient",
                self.transient,
                case.transient.is_some(),
                "[transient] with `duration = \"10 ms\"` and `time_step = \"5 us\"`",
            ),
            (
                "frf",
                self.frf,
                !case.frf.is_empty(),
                "[frf.tap] with `band = [\"10 Hz\", \"3 kHz\"]` and `excitation = { at = [0, 0, 0], direction = [0, 0, 1] }`",
            ),
            (
                "calibrate",
                self.calibrate,
                case.calibrate.is_some(),
                "[calibrate] with `against = \"disc\"`, and [calibrate.parameter.NAME] with `path` and `between`",
            ),
        ];
        let mut faults = Faults::new();
        for (key, _, _, example) in needed.into_iter().filter(|(_, selected, there, _)| *selected && !there) {
            let expected = format!("a table such as {example}");
            faults.push(Fault::new(format!("`{key}`"), "no such table in the case", expected));
        }
        faults.into_result(())
    }

    /// The sensitivities to compute, if any.
    pub(super) fn sensitivities(&self, case: &Case) -> Option<SensitivityAnalysis> {
        match self.sensitivity {
            Sensitivities::No => None,
            Sensitivities::WhenListed => case.sensitivity.clone(),
            Sensitivities::Yes => Some(case.sensitivity.clone().unwrap_or_default()),
        }
    }
}
