//! The analyses of a case in their order, each result handed on as soon as it is there.

use super::calibrate::Calibrate;
use super::clock::Clock;
use super::compare::{Tests, has_measured_frf, has_measured_modes};
use super::complex::{complex_result, whole_modes};
use super::explore::{KnownMap, KnownMaps, Nominal, explore};
use super::frf::{Frf, frfs};
use super::keeper::{Folder, Keeper, Memory, Stage};
use super::memory::check_memory;
use super::missed::nothing_is_missed;
use super::modes::{check_part, named, of_the_whole, part_modes, wanted};
use super::prepared::Prepared;
use super::sensitivity::Analysed;
use super::singular::explained;
use super::transient::{InTime, Places, places};
use crate::case::{Case, CeaAnalysis, ContactState, SensitivityAnalysis, TransientAnalysis};
use crate::equilibrium::{self, SteadySliding};
use crate::error::{Fault, Faults, Result};
use crate::modal;
use crate::progress::Observer;
use crate::results::{self, FolderLock, ResultsFile, RunResults, SteadyResult};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

/// The phase of motion in time.
const IN_TIME: &str = "transient";

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
    fn check(&self, case: &Case) -> Result<()> {
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
    fn sensitivities(&self, case: &Case) -> Option<SensitivityAnalysis> {
        match self.sensitivity {
            Sensitivities::No => None,
            Sensitivities::WhenListed => case.sensitivity.clone(),
            Sensitivities::Yes => Some(case.sensitivity.clone().unwrap_or_default()),
        }
    }
}

/// Runs the analyses of a case and writes the results folder `out`; nothing is written when the input is wrong.
///
/// With `resume` the maps and the run in time that an earlier run of the same case left in `out` are taken up where it
/// stopped; the result is the same, bit for bit. Results of another case are refused.
///
/// # Errors
/// Faults of the input, an analysis without an answer, a folder that cannot be written or that another process uses.
pub fn run_case(
    case: &Case,
    selection: Selection,
    out: &Path,
    resume: bool,
    observer: &dyn Observer,
) -> Result<RunResults> {
    let started = Instant::now();
    let prepared = Prepared::new(case)?;
    // Its faults are told before anything is written.
    let asked = Asked::new(&prepared, selection)?;
    if let Some(expected) = check_memory(&prepared, selection)? {
        observer.begin(&format!("memory: about {}", expected.words()), None);
        observer.end();
    }
    let _lock = FolderLock::take(out)?;
    let known = if resume { results::read_maps(out, &case.to_toml())? } else { BTreeMap::new() };
    let known: KnownMaps =
        known.into_iter().map(|(name, (points, trained))| (name, KnownMap { points, trained })).collect();
    let preparation = started.elapsed().as_secs_f64();
    let file = if resume { ResultsFile::resume(out)? } else { ResultsFile::create(out)? };
    let mut folder = Folder::new(out, file);
    let mut results = analyse_from(&prepared, asked, &known, &mut folder, observer)
        // What another run left, and does not fit, is input.
        .map_err(|error| if resume { error } else { error.while_computing() })
        .map_err(|error| explained(&prepared, error))?;
    // The time of a phase is that of computing.
    let in_time = results.timings.iter_mut().find(|(phase, _)| phase == IN_TIME);
    in_time.into_iter().for_each(|(_, seconds)| *seconds -= folder.seconds_in_time);
    let Folder { mut file, seconds: recording, .. } = folder;
    results.timings.insert(0, ("read mesh and assemble".into(), preparation));
    let writing = Instant::now();
    results::write_files(out, &results)?;
    crate::report::write_report(out, &results)?;
    file.write_measured(&results.measured)?;
    file.write_measured_frfs(&results.measured_frfs)?;
    results.timings.push(("write results".into(), recording + writing.elapsed().as_secs_f64()));
    file.finish(&results)?;
    nothing_is_missed(&results)?;
    Ok(results)
}

/// Runs the analyses of a prepared case; `record` is called with each result as soon as it is there.
///
/// # Errors
/// An analysis without an answer, or what `record` returns.
pub fn analyse(
    prepared: &Prepared,
    selection: Selection,
    record: &mut dyn FnMut(Stage) -> Result<()>,
    observer: &dyn Observer,
) -> Result<RunResults> {
    let asked = Asked::new(prepared, selection)?;
    analyse_from(prepared, asked, &KnownMaps::new(), &mut Memory::new(record), observer)
        .map_err(|error| explained(prepared, error.while_computing()))
}

/// Finds every fault that [`run_case`] finds before it computes; gives what the user should know.
///
/// # Errors
/// All of them.
pub fn check_case(prepared: &Prepared) -> Result<Vec<String>> {
    Ok(Asked::new(prepared, Selection::ALL)?.warnings)
}

/// [`analyse`] with the maps of an earlier run.
fn analyse_from(
    prepared: &Prepared,
    Asked { selection, sliding, mut in_time, frfs, tests, calibrate, warnings }: Asked<'_>,
    known: &KnownMaps,
    keeper: &mut dyn Keeper,
    observer: &dyn Observer,
) -> Result<RunResults> {
    let case = prepared.case;
    let mut results = RunResults {
        title: case.title.clone(),
        resolved_case: case.to_toml(),
        assumptions: case.assumptions.clone(),
        warnings: prepared.warnings.iter().cloned().chain(warnings).collect(),
        geometry: prepared.geometry(),
        size: prepared.size(),
        ..RunResults::default()
    };
    keeper.record(Stage::Model(&results))?;
    let mut clock = Clock::default();
    let asked = |name: &str| !selection.measured_only || has_measured_modes(case, name);
    let all_modes = case.modes.iter().filter(|(name, _)| asked(name));
    let contact_modes = all_modes.clone().filter(|(_, m)| m.contact == ContactState::Closed);

    // The modes that span the complex analysis; without prestress they do not wait for the steady state, and lists of
    // the whole's modes take their share.
    let basis = match &case.cea {
        Some(cea) if selection.cea && !case.prestress && cea.nearest.is_none() => {
            Some(whole_modes(&prepared.system.structure, cea.basis_below, &mut clock, observer)?)
        }
        _ => None,
    };
    if selection.modes {
        for (name, analysis) in all_modes.filter(|(_, m)| m.contact == ContactState::Open) {
            let known = basis.as_ref().filter(|_| of_the_whole(prepared, analysis));
            let modes = match known.and_then(|b| b.lowest(wanted(analysis, prepared.system.n_dofs()))) {
                Some(modes) => named(prepared, name, modes, &prepared.assembled),
                None => {
                    clock.time(&format!("real modes, {name}"), || part_modes(prepared, name, observer))?
                }
            };
            results.measured.extend(tests.modes(results.modes.len(), analysis, &modes));
            keeper.record(Stage::Modes(&modes))?;
            results.modes.push(modes);
        }
    }
    if sliding {
        let options = prepared.steady_options();
        let state = clock
            .time("steady sliding", || equilibrium::solve_steady(&prepared.system, &options, observer))?;
        let steady = steady_result(prepared, state);
        let slides = !prepared.system.pairs.is_empty();
        if slides {
            keeper.record(Stage::Steady(&steady))?;
        }
        results.steady = Some(steady);
        let state = &results.steady.as_ref().expect("set above").state;
        if selection.modes {
            for (name, analysis) in contact_modes {
                let wanted = wanted(analysis, prepared.system.n_dofs());
                let closed = equilibrium::closed_structure(&prepared.system, state)?;
                let (modes, _) = clock
                    .time(&format!("real modes, {name}"), || modal::compute(&closed, wanted, observer))?;
                let modes = named(prepared, name, modes, &prepared.assembled);
                results.measured.extend(tests.modes(results.modes.len(), analysis, &modes));
                keeper.record(Stage::Modes(&modes))?;
                results.modes.push(modes);
            }
        }
        let left_vectors = in_time.is_some() || selection.sensitivities(case).is_some();
        let complex = match selection.cea {
            true => complex_result(prepared, state, basis, left_vectors, &mut clock, observer)?,
            false => None,
        };
        if let Some((complex, system, real)) = complex {
            keeper.record(Stage::Complex(&complex))?;
            results.warnings.extend(complex.modes.warnings.iter().cloned());
            let steady = &state.clone();
            if let Some(wanted) = selection.sensitivities(case) {
                let analysed =
                    Analysed { prepared, system: &system, steady, real: &real, modes: &complex.modes };
                let sensitivity =
                    clock.time("sensitivities", || analysed.sensitivities(&wanted, observer))?;
                keeper.record(Stage::Sensitivity(&sensitivity))?;
                results.sensitivity = Some(sensitivity);
            }
            if let Some((wanted, places)) = in_time.take() {
                let (dofs, geometry) = (&prepared.assembled.dofs, &results.geometry);
                let run = InTime { system: &system, steady, complex: &complex, real: &real, dofs, geometry };
                let transient = clock.time(IN_TIME, || run.run(wanted, places, keeper, observer))?;
                keeper.record(Stage::Transient(&transient))?;
                results.transient = Some(transient);
            }
            results.complex = Some(complex);
            if selection.sweeps && !(case.sweep.is_empty() && case.map.is_empty()) {
                let nominal = Nominal { prepared, system: &system, steady, real: &real };
                let mut record = |stage: Stage| keeper.record(stage);
                clock.time("sweeps and maps", || {
                    explore(&nominal, known, &mut results, &mut record, observer)
                })?;
            }
        }
        results.steady = results.steady.filter(|_| slides);
    }
    for frf in &frfs {
        let steady = results.steady.as_ref().map(|steady| &steady.state);
        let (response, beside) = clock
            .time(&format!("frequency response {}", frf.name()), || frf.run(prepared, steady, observer))?;
        results.measured_frfs.extend(tests.responses(&response, &beside));
        keeper.record(Stage::Frf(&response))?;
        results.frfs.push(response);
    }
    if let Some(calibrate) = calibrate {
        let found = clock.time("calibration", || calibrate.run(observer))?;
        keeper.record(Stage::Calibration(&found))?;
        results.calibration = Some(found);
    }
    results.warnings.extend(thickness_warnings(prepared));
    results.timings = clock.phases;
    Ok(results)
}

/// The analyses that are selected, with the places that they need.
struct Asked<'a> {
    selection: Selection,
    /// Whether something is asked about steady sliding.
    sliding: bool,
    in_time: Option<(&'a TransientAnalysis, Places)>,
    frfs: Vec<Frf<'a>>,
    tests: Tests,
    calibrate: Option<Calibrate<'a>>,
    /// What the user should know.
    warnings: Vec<String>,
}

impl<'a> Asked<'a> {
    /// Finds the faults of all that is selected before anything is computed or written.
    fn new(prepared: &'a Prepared<'a>, selection: Selection) -> Result<Self> {
        let case = prepared.case;
        let mut faults = Faults::new();
        faults.take(selection.check(case));
        let wanted = case.transient.as_ref().filter(|_| selection.transient && selection.cea);
        let in_time = wanted.and_then(|wanted| Some((wanted, faults.take(places(prepared, wanted))?)));
        let mut frfs =
            if selection.frf { faults.take(frfs(prepared)).unwrap_or_default() } else { Vec::new() };
        frfs.retain(|frf| !selection.measured_only || has_measured_frf(case, frf.name()));
        let tests = match selection.modes || selection.frf {
            true => faults.take(Tests::new(prepared, &mut frfs)),
            false => None,
        };
        if selection.measured_only && tests.as_ref().is_some_and(Tests::is_empty) {
            faults.push(Fault::new("`measured`", "no measured data in the case", "a table [measured.NAME]"));
        }
        let tests = tests.unwrap_or_default();
        for name in case.modes.keys().filter(|_| selection.modes) {
            faults.take(check_part(prepared, name));
        }
        let wanted = case.calibrate.as_ref().filter(|_| selection.calibrate);
        let calibrate = wanted.and_then(|wanted| faults.take(Calibrate::new(prepared, wanted)));
        let closed = case.modes.values().any(|modes| modes.contact == ContactState::Closed);
        let cea = case.cea.as_ref().filter(|_| selection.cea);
        let sliding = cea.is_some() || (selection.modes && closed) || frfs.iter().any(Frf::slides);
        if sliding {
            faults.take(equilibrium::check(&prepared.system));
        }
        let moves = sliding || (selection.modes && !case.modes.is_empty()) || !frfs.is_empty();
        if moves && prepared.system.structure.mass.val().iter().all(|m| *m == 0.0) {
            let expected = "a part with mass: nothing vibrates without";
            faults.push(Fault::new("the case", "no mass", expected));
        }
        // A file that two analyses read has its faults once.
        let mut all = Vec::new();
        faults.0.into_iter().for_each(|fault| {
            if !all.contains(&fault) {
                all.push(fault)
            }
        });
        let warnings = tests.warnings.iter().cloned().chain(cea.and_then(not_all_of_the_band)).collect();
        Faults(all).into_result(Asked { selection, sliding, in_time, frfs, tests, calibrate, warnings })
    }
}

/// Says that `nearest` leaves modes of a band that the case gives beside it.
fn not_all_of_the_band(cea: &CeaAnalysis) -> Option<String> {
    let (hz, count) = cea.nearest.zip(cea.count)?;
    let [low, high] = cea.band;
    let given = low != 0.0 || high != 4.0 * hz;
    given.then(|| {
        format!(
            "[cea] looks for the {count} complex modes nearest to {hz} Hz alone, not for all from {low} to {high} Hz; \
             without `nearest` and `count` it looks for all"
        )
    })
}

fn steady_result(prepared: &Prepared, state: SteadySliding) -> SteadyResult {
    let system = &prepared.system;
    let mut point = state.points.iter();
    let pairs = system
        .pairs
        .iter()
        .map(|pair| {
            let load = point.by_ref().take(pair.points.len()).map(|p| p.forces.normal).sum();
            (pair.name.clone(), load, pair.sliding_velocity)
        })
        .collect();
    SteadyResult {
        displacement: prepared.assembled.dofs.expand(&state.displacement),
        points: system.points().map(|(pair, point)| (pair.name.clone(), point.position)).collect(),
        pairs,
        directions: prepared.arrows(),
        state,
    }
}

/// Where Kirchhoff's theory is off by more than a percent at the highest frequency asked for.
fn thickness_warnings(prepared: &Prepared) -> Vec<String> {
    let case = prepared.case;
    let asked = case.modes.values().filter_map(|m| m.below).chain(case.cea.iter().map(|c| c.band[1]));
    let highest = asked.fold(0.0, f64::max);
    let errors = crate::structure::thickness_errors(&prepared.model, highest);
    let worth_saying = errors.iter().filter(|e| e.relative_error > 0.01);
    worth_saying
        .map(|e| {
            format!(
                "Plate `{}` is thick for Kirchhoff's theory: its modes near {:.0} Hz come out about {:.1} % too high (kh = {:.2})",
                e.part,
                e.frequency_hz,
                100.0 * e.relative_error,
                e.wavenumber_times_thickness
            )
        })
        .collect()
}
