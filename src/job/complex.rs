//! The complex eigenvalue analysis of a case: its band, the real modes that span it, its modes in words, and the second
//! method beside it.

use super::clock::Clock;
use super::modes::{
    check_damping_frequencies, damped_below, identify, labels, modal_damping, real_modes_below,
};
use super::operating_point::OperatingPoint;
use super::prepared::Prepared;
use crate::case::CeaAnalysis;
use crate::equilibrium::{self, SteadySliding};
use crate::error::Result;
use crate::modal::{self, ModesWanted, RealModes};
use crate::progress::Observer;
use crate::results::ComplexResult;
use crate::stability::{self, Band, Certificate, ClosedContact, ComplexModes, Nearest, Structural};
use crate::stability::{band_around, band_expected, keep_nearest};
use crate::system::{Structure, System};
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

/// Floating-point operations of a certificate that is not requested explicitly, one that takes at most half as many as the
/// eigenvalues aside: two seconds of one core.
const CHEAP: f64 = 1e10;
/// So many degrees of freedom have all their real modes as a basis: damping and friction may bring modes into the band, or let them
/// grow, that are far beyond it without them.
const SMALL: usize = 60;
/// How far real modes reach beyond the band that they span where the case leaves it open, by the band's top; and how far
/// at least, where the band turned out wider than expected.
const SPANNED: f64 = 1.5;
const SPANNED_AT_LEAST: f64 = 1.4;

/// The springs of more contact points are part of the stiffness before real modes are sought: the modes of bodies that contact
/// holds together have little in common with those of the bodies apart.
const MANY_POINTS: usize = 80;

/// Whether a case has so many contact points that its contact is closed before real modes are sought.
pub fn closes_contact(prepared: &Prepared) -> bool {
    prepared.system.points().nth(MANY_POINTS).is_some()
}

/// Whether the real modes that span the complex ones of a case are those with its contact closed, and no others are needed. Modal damping is
/// that of the structure alone, and so are its modes.
pub fn is_spanned_closed(prepared: &Prepared) -> bool {
    let damping = &prepared.case.damping;
    closes_contact(prepared) && damping.modal_ratio == 0.0 && damping.modal_ratios.is_empty()
}

/// Modes of an analysis, with the band and the real modes that span it.
pub struct BandModes {
    band: [f64; 2],
    basis: RealModes,
    /// The modes.
    pub modes: ComplexModes,
    certificate: Option<Certificate>,
}

/// The complex modes at the steady state that the analysis asks for, the system that they belong to (its modal damping in it) and, where real modes
/// with the contact closed span them, that with its contact closed. `basis` is the real modes of the whole where they are known already.
pub fn band_modes<'a>(
    (prepared, state): (&'a Prepared, &SteadySliding),
    cea: &CeaAnalysis,
    basis: Option<RealModes>,
    left_vectors: bool,
    clock: &mut Clock,
    observer: &dyn Observer,
) -> Result<(BandModes, Cow<'a, System>, Option<ClosedContact>)> {
    let closed = match is_spanned_closed(prepared) {
        true => Some(ClosedContact::of(&prepared.system, state)?),
        false => None,
    };
    let (own, state) = closed.as_ref().map_or((&prepared.system, state), |c| (&c.system, &c.steady));
    let basis = basis.filter(|_| closed.is_none());
    let preloaded = equilibrium::preloaded_structure(own, state)?;
    if basis.is_none() {
        check_damping_frequencies(&preloaded, prepared.case, cea.basis_below)?;
    }
    let mut system = Cow::Borrowed(own);
    let left_vectors = left_vectors || cea.left_vectors;
    let mut problem =
        ComplexProblem { prepared, cea, left_vectors, system: &mut system, state, clock, observer };
    let nearest = cea.nearest.zip(cea.count).map(|(hz, count)| Nearest { hz, count, within: cea.band });
    let found = match nearest {
        Some(asked) => problem.nearest(&asked, &preloaded)?,
        None => {
            let basis = match basis {
                Some(basis) => basis,
                None => {
                    let below = real_modes_below(prepared.case, cea, cea.basis_below);
                    whole_modes(&preloaded, below, problem.clock, observer)?
                }
            };
            let (modes, certificate) = problem.modes((&basis).into(), cea.band)?;
            BandModes { band: cea.band, basis, modes, certificate }
        }
    };
    let system = match system {
        Cow::Owned(damped) => Cow::Owned(damped),
        Cow::Borrowed(_) => Cow::Borrowed(&prepared.system),
    };
    Ok((found, system, closed))
}

/// Complex eigenvalues at the steady state, and the operating point that they belong to; `basis` is the real modes of the whole where they
/// are known already. Left vectors are kept where `left_vectors` or the case asks for them. It has no shares of the parts.
pub fn complex_result<'a>(
    (prepared, steady): (&'a Prepared, Arc<SteadySliding>),
    cea: &CeaAnalysis,
    basis: Option<RealModes>,
    left_vectors: bool,
    clock: &mut Clock,
    observer: &dyn Observer,
) -> Result<(ComplexResult, OperatingPoint<'a>)> {
    let (found, system, closed) = band_modes((prepared, &steady), cea, basis, left_vectors, clock, observer)?;
    let BandModes { band, basis: real, modes, certificate } = found;
    let asked = Band { hz: band, nearest: cea.nearest.zip(cea.count), left_vectors: false };
    let confirmation = match cea.confirm {
        true => Some(
            clock.time("second method", || stability::confirm(&system, &steady, &modes, asked, observer))?,
        ),
        false => None,
    };
    let case = prepared.case;
    let labels = labels(&identify(prepared, &real, (&prepared.model, &prepared.assembled)), &real);
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
        contact_closed: closed.is_some(),
        discs: Vec::new(),
        shares: None,
        without_split: Vec::new(),
        measured_squeal_hz: cea.measured_squeal.iter().map(|f| (*f, cea.measured_source.clone())).collect(),
        modal_damping_below_hz: (case.damping.modal_ratio > 0.0).then(|| damped_below(case, cea)),
        band_hz: band,
        certificate,
        confirmation,
        modes,
    };
    Ok((complex, OperatingPoint { prepared, steady, system, real, closed, open: OnceLock::new() }))
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
        let (mass, case) = (&self.system.structure.mass, self.prepared.case);
        if let Some(modal) = modal_damping(mass, known.real, case, damped_below(case, self.cea))? {
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
            let spanned = self.cea.basis_below.min(SPANNED * expected[1]);
            let below = real_modes_below(self.prepared.case, self.cea, spanned);
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
    let modes = clock.time("real modes of the whole", || {
        let all = (structure.n_dofs() <= SMALL).then(|| ModesWanted::Count(structure.n_dofs()));
        // What has no mass has no mode: there are fewer then.
        let all = all.and_then(|all| modal::compute(structure, all, observer).ok());
        all.map_or_else(|| modal::compute(structure, ModesWanted::BelowHz(below), observer), Ok)
    });
    modes.map(|(modes, _)| modes)
}

#[cfg(test)]
mod oscillators;
#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::case::Case;
    use crate::equilibrium::solve_steady;
    use crate::job::states::Whole;
    use crate::job::{Selection, analyse};
    use crate::linalg::c64;
    use crate::linalg::random::Random;
    use crate::sweep::SweepProblem;
    use std::path::Path;

    /// Writes a symmetric matrix.
    pub(super) fn write_matrix(path: &std::path::Path, a: &faer::Mat<f64>) {
        let n = a.nrows();
        let entries: Vec<String> = (0..n)
            .flat_map(|j| (j..n).map(move |i| (i, j)))
            .map(|(i, j)| format!("{} {} {:e}", i + 1, j + 1, a[(i, j)]))
            .collect();
        let head = format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {}\n", entries.len());
        std::fs::write(path, head + &entries.join("\n") + "\n").unwrap();
    }

    fn eigenvalues(case: &Case) -> Vec<c64> {
        let prepared = Prepared::new(case).unwrap();
        let results = analyse(&prepared, Selection::Only("cea"), &mut |_| Ok(()), &()).unwrap();
        results.get::<ComplexResult>().unwrap().modes.modes.iter().map(|m| m.eigenvalue).collect()
    }

    /// A coarse rig with a stiff contact, whose complex modes have much of the modes above the band.
    fn rig(random: &mut Random) -> Case {
        let between = |low: f64, high: f64, x: f64| low + 0.5 * (x + 1.0) * (high - low);
        let text = include_str!("../../validation/rig-coarse/case.toml")
            .replace("confirm = true", "")
            .replace("certify = true", "certify = false")
            .replace("[\"200 Hz\", \"6 kHz\"]", "[0, \"2 kHz\"]")
            .replace("\"1 mm\"", &between(0.8e-3, 3e-3, random.next()).to_string())
            .replace("\"10 MN/m\"", &10f64.powf(between(6.0, 9.0, random.next())).to_string())
            .replace("mu0 = 0.6", &format!("mu0 = {}", between(0.1, 0.8, random.next())))
            .replace(
                "modal_ratio = 0.0035",
                &format!("modal_ratio = {}", between(1e-3, 0.05, random.next())),
            );
        Case::parse("rig", &text[..text.find("[sensitivity]").unwrap()], ".".into()).unwrap()
    }

    /// A brake with 128 contact points: the real modes that span are those with the contact closed, which lie above those of the structure
    /// alone, one by one; the complex modes are those that the open ones give.
    #[test]
    fn many_points_are_spanned_by_modes_with_the_contact_closed() {
        let text = include_str!("../../validation/solid-brake/case.toml").replace("modal_ratio = 0.002", "");
        let model = &text[..text.find("[modes.disc]").unwrap()];
        let text = format!("{model}[cea]\nband = [500, 6000]\ncertify = false\n");
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/solid-brake");
        let case = Case::parse("solid-brake", &text, folder).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        assert!(is_spanned_closed(&prepared));
        let steady = solve_steady(&prepared.system, &prepared.steady_options(), &()).unwrap();
        let (cea, steady) = (case.cea.as_ref().unwrap(), Arc::new(steady));
        let at = (&prepared, steady.clone());
        let (found, point) = complex_result(at, cea, None, true, &mut Clock::default(), &()).unwrap();
        let open = point.open_modes(&()).unwrap();
        let both: Vec<_> = point.real.eigenvalues.iter().zip(&open.eigenvalues).collect();
        assert!(both.len() > 20 && point.real.len() < open.len());
        assert!(both.iter().all(|(closed, open)| **closed > **open * (1.0 - 1e-9)));
        assert!(both.iter().any(|(closed, open)| **closed > 1.1 * **open));
        let alone = stability::complex_modes(&prepared.system, &steady, open, cea.band, &()).unwrap();
        assert_eq!(found.modes.modes.len(), alone.modes.len());
        for (a, b) in found.modes.modes.iter().zip(&alone.modes) {
            let apart = (a.eigenvalue - b.eigenvalue).norm() / b.eigenvalue.norm();
            assert!(within(apart, 1e-8, Tolerance), "{apart:e}");
        }
    }

    #[test]
    fn modal_damping_does_not_depend_on_the_basis() {
        let mut random = Random::new();
        for k in 0..4 {
            let mut case = rig(&mut random);
            let cea = case.cea.clone().unwrap();
            case.damping.modal_below = [None, Some(2.5e3), Some(1.2e3), Some(7e3)][k];
            if k == 2 {
                case.damping.modal_ratios = vec![[cea.band[1], 0.1]];
            }
            let with = |below: f64, nearest: Option<(f64, usize)>| {
                let mut case = case.clone();
                let cea = case.cea.as_mut().unwrap();
                (cea.basis_below, cea.nearest, cea.count) =
                    (below, nearest.map(|n| n.0), nearest.map(|n| n.1));
                eigenvalues(&case)
            };
            let all: Vec<Vec<c64>> =
                [2e3, 2.2e3, 3e3, 4e3, 9e3].map(|below| with(below, None)).into_iter().collect();
            assert!(all[0].len() > 2, "{}", all[0].len());
            let alike = |a: &c64, b: &c64| {
                // The analysis aims at 1e-8 of |λ|.
                within((a.re - b.re).abs(), 1e-6 * a.re.abs() + 2e-8 * a.norm(), Tolerance)
            };
            for other in &all[1..] {
                assert_eq!(other.len(), all[0].len());
                for (a, b) in all[0].iter().zip(other) {
                    assert!(alike(a, b), "{k}: {a} {b}");
                }
            }
            for z in with(3e3, Some((800.0, 4))) {
                let near = all[0].iter().min_by(|a, b| (*a - z).norm().total_cmp(&(*b - z).norm())).unwrap();
                assert!(alike(near, &z) && within((near - z).norm(), 1e-6 * z.norm(), Tolerance), "{k}: {z}");
            }
        }
    }

    #[test]
    fn whole_analyses_of_a_sweep_look_for_the_nearest_modes_too() {
        let mut random = Random::new();
        for (hz, count) in [(300.0, 1), (900.0, 3), (1500.0, 2)] {
            let mut case = rig(&mut random);
            let cea = case.cea.as_mut().unwrap();
            (cea.nearest, cea.count) = (Some(hz), Some(count));
            let path = "shell.disc.thickness".to_string();
            let at = 1.1 * case.parameter(&path).unwrap().value;
            let expected = eigenvalues(&case.with_parameter(&path, at).unwrap());
            let found = Whole::new(&Prepared::new(&case).unwrap(), vec![path], None).eigenvalues(&[at]);
            let found = found.unwrap();
            assert_eq!(expected.len(), count);
            assert_eq!(found, expected);
        }
    }

    /// Small matrices with negative damping and springs, in bands below their real modes as often as above: every eigenvalue that grows and is
    /// real, or in the band, is there, by a dense solver.
    #[test]
    fn what_grows_in_small_systems_is_found_whatever_the_band() {
        let mut random = Random::seeded(83);
        let folder = tempfile::tempdir().unwrap();
        let mut beyond = 0;
        for trial in 0..60 {
            let n = 1 + trial % 5;
            let mut symmetric = |[low, high]: [f64; 2], others: f64| {
                let all: Vec<f64> = (0..n * n)
                    .map(|e| {
                        if e % (n + 1) == 0 {
                            random.between(low, high)
                        } else {
                            random.between(-others, others)
                        }
                    })
                    .collect();
                faer::Mat::from_fn(n, n, |i, j| all[i.max(j) * n + i.min(j)])
            };
            let (k, c) = (symmetric([1.0, 9.0], 0.2), symmetric([-8.0, 2.0], 0.5));
            let top = TOPS[trial % TOPS.len()];
            let write = |name: &str, a: &faer::Mat<f64>| write_matrix(&folder.path().join(name), a);
            write("m.mtx", &faer::Mat::identity(n, n));
            write("k.mtx", &k);
            write("c.mtx", &c);
            let text = format!(
                "[matrices]\nmass = \"m.mtx\"\ndamping = \"c.mtx\"\nstiffness = \"k.mtx\"\n[cea]\nband = [0, {top:?}]\n"
            );
            let found = eigenvalues(&Case::parse("small", &text, folder.path().into()).unwrap());
            let companion = faer::Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
                (true, _) => f64::from(j == i + n),
                (false, true) => -k[(i - n, j)],
                (false, false) => -c[(i - n, j - n)],
            });
            let (all, _) = crate::linalg::unsymmetric::eigenpairs(companion.as_ref()).unwrap();
            let top = std::f64::consts::TAU * top;
            for z in all.iter().filter(|z| z.re > 1e-6 && z.im >= 0.0) {
                if z.im > 1e-9 && z.im > top * (1.0 - 1e-9) {
                    continue;
                }
                beyond += usize::from(z.norm() > top);
                let off = found.iter().map(|other| (other - z).norm()).fold(f64::INFINITY, f64::min);
                assert!(
                    within(off, 1e-6 * z.norm(), Tolerance),
                    "{trial}: {z} of {all:?}, found {found:?}, up to {top}"
                );
            }
        }
        assert!(beyond > 20, "{beyond}");
    }

    /// Tops of bands \[Hz\]; the real modes are at 0.15 to 0.5 Hz.
    const TOPS: [f64; 4] = [0.02, 0.08, 0.3, 1.0];
}
