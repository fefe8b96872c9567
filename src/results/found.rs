//! Where each result stands in the files, written as soon as it is found.

use super::{
    CalibrationResult, ComplexResult, DampingVerdicts, FrfResult, NamedModes, SensitivityResult,
    SteadyResult, SweepResult,
};
use crate::dataset::{Describe, Group};

impl Describe for NamedModes {
    fn describe(&self) -> Group<'_> {
        Group::new("", "").list("mode_sets", vec![self.summary()]).parts("modes", "set", vec![self.table("")])
    }
}

impl Describe for SteadyResult {
    fn describe(&self) -> Group<'_> {
        self.group()
    }
}

impl Describe for ComplexResult {
    fn describe(&self) -> Group<'_> {
        self.group()
    }
}

impl Describe for SensitivityResult {
    fn describe(&self) -> Group<'_> {
        self.group()
    }
}

impl Describe for SweepResult {
    fn describe(&self) -> Group<'_> {
        Group::new("", "").list("sweeps", vec![self.group(Default::default())])
    }
}

impl Describe for DampingVerdicts {
    fn describe(&self) -> Group<'_> {
        self.group()
    }
}

impl Describe for FrfResult {
    fn describe(&self) -> Group<'_> {
        Group::new("", "").list("frf", vec![self.group("")])
    }
}

impl Describe for CalibrationResult {
    fn describe(&self) -> Group<'_> {
        self.group()
    }
}
