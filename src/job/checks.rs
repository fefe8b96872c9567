//! Consistency checks of the results of a completed run: modes that are inaccurate or missing, a fit that did not converge.

use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::numbers::hertz;
use crate::results::{CalibrationResult, ComplexResult, RunResults};
use crate::stability::{
    ACCEPTED_EIGENVALUE_ERROR, CloseCall, ComplexMode, LARGEST_BACKWARD_ERROR, LARGEST_EIGENVALUE_ERROR,
};
use std::f64::consts::TAU;

/// Fails where a result does not hold; the results are written all the same:
/// complex modes that are not accurate, an unstable mode that was missed, two methods that disagree, a calibration that has not
/// converged; the first of them.
pub(super) fn results_hold(results: &RunResults) -> Result<()> {
    modes_are_accurate(results)?;
    no_mode_is_missed(results)?;
    two_methods_agree(results)?;
    calibration_converged(results)
}

/// Complex modes whose errors are above the bounds are neither stable nor unstable.
fn modes_are_accurate(results: &RunResults) -> Result<()> {
    const LISTED: usize = 5;
    let modes = results.get::<ComplexResult>().into_iter().flat_map(|c| &c.modes.modes);
    let wrong: Vec<&ComplexMode> = modes.filter(|mode| !mode.accurate()).collect();
    if wrong.is_empty() {
        return Ok(());
    }
    let mut list: Vec<String> = wrong.iter().take(LISTED).map(|mode| mode.errors()).collect();
    if wrong.len() > LISTED {
        list.push(format!("and {} more", wrong.len() - LISTED));
    }
    Err(Error::analysis(
        "complex modes",
        format!(
            "the refinement did not settle for {} of them (bounds: eigenvalue error {LARGEST_EIGENVALUE_ERROR:e}, or \
             {ACCEPTED_EIGENVALUE_ERROR:e} where the backward error is above {LARGEST_BACKWARD_ERROR:e}): {}",
            wrong.len(),
            list.join("; ")
        ),
        "The results are written, with these modes marked. Raise `cea.basis_below`, or look for stiffnesses or masses many orders \
         of magnitude above the others",
    ))
}

/// The values of a fit that has not converged are not the best ones.
fn calibration_converged(results: &RunResults) -> Result<()> {
    let fit = results.get::<CalibrationResult>().map(|found| &found.calibration.best().fit);
    let Some(fit) = fit.filter(|fit| !fit.converged) else { return Ok(()) };
    Err(Error::analysis(
        "calibration",
        format!(
            "the fit has not converged after {} iterations (χ² {:.3e}, projected gradient {:.1e})",
            fit.iterations, fit.chi2, fit.gradient
        ),
        "The results are written; their values are not the best ones. Start nearer, with tighter bounds, or calibrate fewer parameters",
    ))
}

/// A missed mode is an error, but only once the results are written.
fn no_mode_is_missed(results: &RunResults) -> Result<()> {
    let certificate = results.get::<ComplexResult>().and_then(|c| c.certificate.as_ref());
    let Some(wrong) = certificate.filter(|c| !c.agrees()) else { return Ok(()) };
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

/// A disagreement between the two methods is an error, too.
fn two_methods_agree(results: &RunResults) -> Result<()> {
    let confirmation = results.get::<ComplexResult>().and_then(|c| c.confirmation.as_ref());
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
        "The results are written. Raise `basis_below`, and check the condition numbers of the modes near these",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    #[test]
    fn what_has_not_converged_fails_the_run() {
        let mut results = sample::rig();
        results_hold(&results).unwrap();
        let modes = &mut results.get_mut::<ComplexResult>().unwrap().modes.modes;
        modes.iter_mut().for_each(|mode| (mode.backward_error, mode.eigenvalue_error) = (1e-9, 1e-7));
        let error = results_hold(&results).unwrap_err();
        let text = error.to_string();
        assert!(
            text.contains("backward error 1.0e-9") && text.contains("more") && text.contains("marked"),
            "{text}"
        );
        assert_eq!(error.exit_code(), 1);

        let mut results = RunResults::default();
        results.records.push(sample::rig().take::<CalibrationResult>().unwrap());
        let fit = |results: &mut RunResults, converged: bool| {
            let fit = &mut results.get_mut::<CalibrationResult>().unwrap().calibration.ranked[0].fit;
            (fit.converged, fit.iterations) = (converged, 4);
        };
        fit(&mut results, true);
        results_hold(&results).unwrap();
        fit(&mut results, false);
        let text = results_hold(&results).unwrap_err().to_string();
        assert!(text.contains("not converged") && text.contains("4 iterations"), "{text}");
    }
}
