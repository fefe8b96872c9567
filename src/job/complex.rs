//! The complex eigenvalue analysis of a case: its band, the real modes that span it, its modes in words, and the second
//! method beside it.

use super::clock::Clock;
use super::modes::{identify, labels, modal_damping};
use super::prepared::Prepared;
use crate::case::CeaAnalysis;
use crate::equilibrium::{self, SteadySliding};
use crate::error::Result;
use crate::modal::{self, ModesWanted, RealModes};
use crate::progress::Observer;
use crate::results::ComplexResult;
use crate::stability::{self, Band, Certificate, ComplexModes, Nearest, Structural};
use crate::stability::{band_around, band_expected, keep_nearest};
use crate::system::{Structure, System};
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Floating-point operations of a certificate that is not requested explicitly, one that takes at most half as many as the
/// eigenvalues aside: two seconds of one core.
const CHEAP: f64 = 1e10;
/// How far real modes reach beyond the band that they span where the case leaves it open, by the band's top; and how far
/// at least, where the band turned out wider than expected.
const SPANNED: f64 = 1.5;
const SPANNED_AT_LEAST: f64 = 1.4;

/// Modes of an analysis, with the band and the real modes that span it.
struct BandModes {
    band: [f64; 2],
    basis: RealModes,
    modes: ComplexModes,
    certificate: Option<Certificate>,
}

/// Complex eigenvalues at the steady state, with the system they belong to (its modal damping in it) and the real modes
/// of the whole, which `basis` gives where they are known already. Left vectors are kept where `left_vectors` or the case asks
/// for them.
pub fn complex_result<'a>(
    (prepared, state): (&'a Prepared, &SteadySliding),
    cea: &CeaAnalysis,
    basis: Option<RealModes>,
    left_vectors: bool,
    clock: &mut Clock,
    observer: &dyn Observer,
) -> Result<(ComplexResult, Cow<'a, System>, RealModes)> {
    let structure = &prepared.system.structure;
    let preloaded = match equilibrium::tangent_stiffness(&prepared.system, &state.displacement)? {
        Cow::Borrowed(_) => Cow::Borrowed(structure),
        Cow::Owned(stiffness) => Cow::Owned(Structure { stiffness: stiffness.into(), ..structure.clone() }),
    };
    let mut system = Cow::Borrowed(&prepared.system);
    let left_vectors = left_vectors || cea.left_vectors;
    let mut problem =
        ComplexProblem { prepared, cea, left_vectors, system: &mut system, state, clock, observer };
    let nearest = cea.nearest.zip(cea.count).map(|(hz, count)| Nearest { hz, count, within: cea.band });
    let found = match nearest {
        Some(asked) => problem.nearest(&asked, &preloaded)?,
        None => {
            let basis = match basis {
                Some(basis) => basis,
                None => whole_modes(&preloaded, cea.basis_below, problem.clock, observer)?,
            };
            let (modes, certificate) = problem.modes((&basis).into(), cea.band)?;
            BandModes { band: cea.band, basis, modes, certificate }
        }
    };
    let BandModes { band, basis, modes, certificate } = found;
    let confirmation = match cea.confirm {
        true => {
            Some(clock.time("second method", || stability::confirm(&system, state, &modes, band, observer))?)
        }
        false => None,
    };
    let labels = labels(&identify(prepared, &basis, &prepared.assembled), &basis);
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
        dofs: prepared.assembled.dofs.clone(),
        participation,
        real_modes: labels,
        measured_squeal_hz: cea.measured_squeal.iter().map(|f| (*f, cea.measured_source.clone())).collect(),
        band_hz: band,
        certificate,
        confirmation,
        modes,
    };
    Ok((complex, system, basis))
}

/// Input of a complex eigenvalue analysis.
struct ComplexProblem<'p, 'a> {
    prepared: &'a Prepared<'p>,
    cea: &'a CeaAnalysis,
    left_vectors: bool,
    /// Its own where it gets modal damping.
    system: &'a mut Cow<'p, System>,
    state: &'a SteadySliding,
    clock: &'a mut Clock,
    observer: &'a dyn Observer,
}

impl ComplexProblem<'_, '_> {
    /// The complex modes of a band, counted where the case asks for it or where that is cheap.
    fn modes(
        &mut self,
        known: Structural<'_>,
        band: [f64; 2],
    ) -> Result<(ComplexModes, Option<Certificate>)> {
        let mass = &self.system.structure.mass;
        if let Some(modal) = modal_damping(mass, known.real, self.prepared.case)? {
            self.system.to_mut().structure.damping.modal = Some(modal);
        }
        let (system, state): (&System, _) = (&*self.system, self.state);
        let nearest = self.cea.nearest.zip(self.cea.count);
        let band = Band { hz: band, nearest, left_vectors: self.left_vectors };
        self.clock.watch(self.observer, |observer| {
            let certified =
                |most_work| stability::certified_modes(system, state, known, band, most_work, observer);
            match self.cea.certify {
                Some(false) => {
                    stability::complex_modes(system, state, known, band, observer).map(|m| (m, None))
                }
                Some(true) => certified(f64::INFINITY),
                None => certified(CHEAP),
            }
        })
    }

    /// The complex modes nearest to a frequency: the factors that count the modes below it find the real ones, those give
    /// the band, and all three serve the complex ones.
    fn nearest(&mut self, asked: &Nearest, structure: &Structure) -> Result<BandModes> {
        let (mut expected, shifted) =
            self.clock.time("counting modes", || band_expected(structure, asked))?;
        let mut start = Some(shifted);
        let mut least = [asked.hz; 2];
        loop {
            let below = self.cea.basis_below.min(SPANNED * expected[1]);
            let inside = |shift: f64| shift < 0.9 * (TAU * below).powi(2);
            let (basis, shifted) = self.clock.time("real modes of the whole", || {
                match start.take().filter(|start| inside(start.shift)) {
                    Some(start) => modal::compute_from(structure, below, start, self.observer),
                    None => modal::compute(structure, ModesWanted::BelowHz(below), self.observer),
                }
            })?;
            let around = band_around(&basis, asked);
            let band = [around[0].min(least[0]), around[1].max(least[1])];
            if below < self.cea.basis_below.min(SPANNED_AT_LEAST * band[1]) {
                (expected, start) = (band, Some(shifted));
                continue;
            }
            // Factors that do not serve are as large as those that the analysis makes in their place.
            let serve = Structural { real: &basis, shifted: Some(&shifted) }.serves(band);
            let shifted = Some(shifted).filter(|_| serve);
            let (mut modes, certificate) =
                self.modes(Structural { real: &basis, shifted: shifted.as_ref() }, band)?;
            match keep_nearest(&mut modes, asked, band) {
                Some(wider) => (expected, least, start) = (wider, wider, shifted),
                None => return Ok(BandModes { band, basis, modes, certificate }),
            }
        }
    }
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
