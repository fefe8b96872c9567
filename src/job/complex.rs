//! The complex eigenvalue analysis of a case: its band, the real modes that span it, its modes in words, and the second
//! method beside it.

use super::clock::Clock;
use super::modes::{add_modal_damping, labels, named};
use super::nearest::{band_around, keep_nearest};
use super::prepared::Prepared;
use crate::equilibrium::{self, SteadySliding};
use crate::error::Result;
use crate::modal::{self, ModesWanted, RealModes};
use crate::progress::Observer;
use crate::results::ComplexResult;
use crate::stability;
use crate::system::{Structure, System};

/// Floating-point operations of a certificate that nobody asked for: some seconds.
const CHEAP: f64 = 5e9;

/// Complex eigenvalues at the steady state, with the system they belong to (its modal damping in it) and the real modes
/// of the whole, which `basis` gives where they are known already.
pub fn complex_result(
    prepared: &Prepared,
    state: &SteadySliding,
    mut basis: Option<RealModes>,
    clock: &mut Clock,
    observer: &dyn Observer,
) -> Result<Option<(ComplexResult, System, RealModes)>> {
    let Some(cea) = &prepared.case.cea else { return Ok(None) };
    let mut system = prepared.system.clone();
    let stiffness = equilibrium::tangent_stiffness(&prepared.system, &state.displacement)?.into_owned();
    let preloaded = Structure { stiffness, ..prepared.system.structure.clone() };
    let mut band = cea.band;
    if cea.nearest.is_some() {
        band = clock.time("counting modes", || band_around(&preloaded, cea))?;
    }
    let (basis, modes, certificate) = loop {
        let below = if cea.nearest.is_some() { cea.basis_below.min(1.5 * band[1]) } else { cea.basis_below };
        let basis = match basis.take() {
            Some(basis) => basis,
            None => whole_modes(&preloaded, below, clock, observer)?,
        };
        add_modal_damping(&mut system.structure, &basis, prepared)?;
        let (mut modes, certificate) = clock.watch(observer, |observer| {
            let certified =
                |most_work| stability::certified_modes(&system, state, &basis, band, most_work, observer);
            match cea.certify {
                Some(false) => {
                    stability::complex_modes(&system, state, &basis, band, observer).map(|m| (m, None))
                }
                Some(true) => certified(f64::INFINITY),
                None => certified(CHEAP),
            }
        })?;
        match keep_nearest(&mut modes, cea, band) {
            Some(wider) => band = wider,
            None => break (basis, modes, certificate),
        }
    };
    let confirmation = match cea.confirm {
        true => {
            Some(clock.time("second method", || stability::confirm(&system, state, &modes, band, observer))?)
        }
        false => None,
    };
    let real = named(prepared, "whole", basis, &prepared.assembled);
    let labels = labels(&real);
    let participation = modes
        .modes
        .iter()
        .map(|mode| {
            let words = mode.participation.iter().take(3).filter(|(_, share)| *share >= 0.05);
            words
                .map(|(k, share)| format!("{:.0} % {}", 100.0 * share, labels[*k]))
                .collect::<Vec<_>>()
                .join(", ")
        })
        .collect();
    let complex = ComplexResult {
        shapes: modes.modes.iter().map(|m| prepared.assembled.dofs.expand_complex(&m.right)).collect(),
        participation,
        real_modes: labels,
        measured_squeal_hz: cea.measured_squeal.iter().map(|f| (*f, cea.measured_source.clone())).collect(),
        band_hz: band,
        certificate,
        confirmation,
        modes,
    };
    Ok(Some((complex, system, real.modes)))
}

/// The real modes that span the complex analysis.
pub fn whole_modes(
    structure: &Structure,
    below: f64,
    clock: &mut Clock,
    observer: &dyn Observer,
) -> Result<RealModes> {
    let modes = clock
        .time("real modes of the whole", || modal::compute(structure, ModesWanted::BelowHz(below), observer));
    modes.map(|(modes, _)| modes)
}
