//! What the certificate and the second method say against the modes found.

use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::numbers::hertz;
use crate::results::RunResults;
use crate::stability::CloseCall;
use std::f64::consts::TAU;

/// A mode that was missed is an error, but only once the results are there to look at.
pub(super) fn nothing_is_missed(results: &RunResults) -> Result<()> {
    let certificate = results.complex.as_ref().and_then(|c| c.certificate.as_ref());
    let Some(wrong) = certificate.filter(|c| !c.agrees()) else { return two_methods_agree(results) };
    let ([low, high], [slow, fast]) = (wrong.band_hz, wrong.growth);
    let near = |call: &CloseCall| {
        let hz = hertz(call.frequency_hz, 3);
        format!("; the mode at {hz} Hz is {:.2e} 1/s from the contour", call.distance)
    };
    Err(Error::analysis(
        "certificate of the unstable modes",
        format!(
            "{} eigenvalues counted but {} found from {} to {} Hz with growth rates from {slow:.3e} to {fast:.3e} 1/s (margin of the count {:.1e}){}",
            wrong.counted,
            wrong.found,
            hertz(low, 2),
            hertz(high, 2),
            wrong.margin,
            wrong.close_calls.iter().map(near).collect::<String>()
        ),
        "The results are written. Raise `cea.basis_below`, or move the band",
    ))
}

/// So is a disagreement between the two methods.
fn two_methods_agree(results: &RunResults) -> Result<()> {
    let confirmation = results.complex.as_ref().and_then(|c| c.confirmation.as_ref());
    let Some(wrong) = confirmation.filter(|c| !c.holds()) else { return Ok(()) };
    let list = |all: &[c64]| {
        let hz: Vec<String> = all.iter().map(|z| hertz(z.im / TAU, 2)).collect();
        if hz.is_empty() { "none".to_string() } else { hz.join(", ") }
    };
    Err(Error::analysis(
        "complex eigenvalues by two methods",
        format!(
            "modes that only two-level Arnoldi found [Hz]: {}; that only the projection found: {}",
            list(&wrong.missed),
            list(&wrong.unconfirmed)
        ),
        "The results are written. Raise `basis_below`, and look at the condition numbers of the modes near these",
    ))
}
