//! The frequencies that a case asks for.

use crate::job::prepared::Prepared;

/// The highest frequency \[Hz\] that the analyses of the case ask of a part; zero where none has a band.
pub(super) fn highest_frequency(prepared: &Prepared, part: &str) -> f64 {
    let case = prepared.case;
    let of_part = |parts: &[String]| parts.is_empty() || parts.iter().any(|name| name == part);
    let modes = case.modes.values().filter(|modes| of_part(&modes.parts)).filter_map(|modes| modes.below);
    let complex = case.cea.iter().map(|cea| cea.band[1]).filter(|top| top.is_finite());
    let responses = case.frf.values().map(|frf| frf.band[1]);
    modes.chain(complex).chain(responses).fold(0.0, f64::max)
}
