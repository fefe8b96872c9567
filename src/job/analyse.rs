//! The analyses of a case in their order, each result handed on as soon as it is there.

use super::calibrate::Calibrate;
use super::clock::Clock;
use super::compare::{Tests, has_measured_frf, has_measured_modes};
use super::complex::{complex_result, whole_modes};
use super::explore::{Nominal, explore};
use super::frf::{Frf, frfs};
use super::memory::check_memory;
use super::missed::results_hold;
use super::modes::{check_part, named, of_the_whole, part_modes, wanted};
use super::prepared::Prepared;
use super::selection::Selection;
use super::sensitivity::Analysed;
use super::singular::explained;
use super::sink::{Folder, KnownMap, KnownMaps, Memory, ResultSink, Stage};
use super::transient::{InTime, Places, places};
use crate::case::{Case, CeaAnalysis, ContactState, ModesAnalysis, TransientAnalysis};
use crate::equilibrium::{self, SteadySliding};
use crate::error::{Error, Fault, Faults, Result};
use crate::modal::{self, RealModes};
use crate::progress::Observer;
use crate::results::record::{Earlier, InputFile, Origin, Record};
use crate::results::{
    self, ComplexResult, FieldsFile, FolderLock, NamedModes, ResultsFile, RunResults, SteadyResult,
    fits_on_disk,
};
use crate::system::System;
use std::path::Path;
use std::time::Instant;

/// The phase of motion in time.
const IN_TIME: &str = "transient";

/// Runs the analyses of a case and writes the results folder `out`; nothing is written when the input is wrong.
///
/// With `resume` the maps and the run in time that an earlier run of the same case left in `out` are taken up where it
/// stopped; the result is the same, bit for bit. Results of another case or of other files are refused. Without it an
/// interrupted record is moved to a folder of its own in `out`; the files of a run that had ended are replaced.
///
/// When an analysis has no answer, the results of those before are written and the failure is named in them.
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
    if let Some((wanted, places)) = &asked.in_time {
        fits_on_disk(out, &places.least_record(&prepared, wanted))?;
    }
    let inputs =
        case.files().iter().map(|file| InputFile::read(&case.folder, file)).collect::<Result<_>>()?;
    let origin = Origin { case: case.to_toml(), inputs };
    let _lock = FolderLock::take(out)?;
    let mut results = RunResults { inputs: origin.inputs.clone(), ..RunResults::default() };
    let (record, earlier) = match resume {
        true => taken_up(out, origin, &asked)?,
        false => {
            results.warnings.extend(moved_aside(out, observer)?);
            (Record::new(out, origin), Earlier::default())
        }
    };
    let known = earlier.maps.iter().map(|(name, (points, trained))| {
        (name.clone(), KnownMap { points: points.clone(), trained: trained.clone() })
    });
    let known: KnownMaps = known.collect();
    let mut file = ResultsFile::create(out)?;
    let read = case.files().into_iter().chain(["calibrated.toml".into()]).map(|name| case.folder.join(name));
    file.spare(read.filter_map(|path| std::path::absolute(path).ok()));
    if resume {
        file.spare(record.files());
    }
    let preparation = started.elapsed().as_secs_f64();
    let mut folder = Folder::new(out, file, record, earlier);
    let done = analyse_from(&prepared, asked, &known, &mut folder, &mut results, observer)
        // What another run left, and does not fit, is input.
        .map_err(|error| if resume { error } else { error.while_computing() })
        .map_err(|error| explained(&prepared, error));
    let failure = match done {
        Ok(()) => results_hold(&results).err(),
        Err(failure @ Error::Analysis { .. }) => Some(failure),
        Err(Error::Input(faults)) => {
            folder.file.discard();
            return Err(Error::Input(faults));
        }
        Err(refused) => return Err(refused),
    };
    results.failed = failure.as_ref().map(Error::to_string);
    results.timings.insert(0, ("read mesh and assemble".into(), preparation));
    write_results(out, folder, &mut results)?;
    match failure {
        Some(failure) => Err(failure),
        None => Ok(results),
    }
}

/// What an earlier run has left to go on with.
fn taken_up(out: &Path, origin: Origin, asked: &Asked) -> Result<(Record, Earlier)> {
    let Some((record, earlier)) = Record::resume(out, &origin)? else {
        return Ok((Record::new(out, origin), Earlier::default()));
    };
    let left_out = [
        (
            earlier.rows > 0 && asked.in_time.is_none(),
            "a run in time",
            "`stridor transient` or `stridor run`",
        ),
        (!earlier.maps.is_empty() && !asked.selection.sweeps, "maps", "`stridor sweep` or `stridor run`"),
    ];
    let lost = left_out.into_iter().find(|(lost, ..)| *lost && !record.ended());
    if let Some((_, what, command)) = lost {
        let found = format!("an interrupted record of {what}");
        let fault = Fault::new(out.display().to_string(), found, format!("{command} to go on with it"));
        let help = "Use that command, or run without --resume (the record is kept aside)";
        return Err(Error::input(fault.with_help(help)));
    }
    Ok((record, earlier))
}

/// Keeps an interrupted record aside and says so.
fn moved_aside(out: &Path, observer: &dyn Observer) -> Result<Option<String>> {
    let sentence = results::set_aside(out)?.map(|aside| {
        format!(
            "The folder had the record of an interrupted run. It was moved to {}; --resume with --out of that folder goes on with it",
            aside.display()
        )
    });
    sentence.iter().for_each(|sentence| observer.note(sentence));
    Ok(sentence)
}

/// Writes all that is written at the end.
fn write_results(out: &Path, folder: Folder, results: &mut RunResults) -> Result<()> {
    // The time of a phase is that of computing.
    let in_time = results.timings.iter_mut().find(|(phase, _)| phase == IN_TIME);
    in_time.into_iter().for_each(|(_, seconds)| *seconds -= folder.seconds_in_time);
    let Folder { mut file, mut record, fields, seconds: recording, .. } = folder;
    let writing = Instant::now();
    fields.map_or(Ok(()), FieldsFile::finish)?;
    file.stand_alone()?;
    results::write_files(out, results)?;
    crate::report::write_report(out, results)?;
    file.write(&results.compared())?;
    results.timings.push(("write results".into(), recording + writing.elapsed().as_secs_f64()));
    file.finish(results)?;
    record.end()
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
    let mut results = RunResults::default();
    let sink = &mut Memory::new(record);
    analyse_from(prepared, asked, &KnownMaps::new(), sink, &mut results, observer)
        .map_err(|error| explained(prepared, error.while_computing()))?;
    Ok(results)
}

/// Finds every fault that [`run_case`] finds before it computes; gives what the user should know.
///
/// # Errors
/// All of them.
pub fn check_case(prepared: &Prepared) -> Result<Vec<String>> {
    Ok(Asked::new(prepared, Selection::ALL)?.warnings)
}

/// [`analyse`] with the maps of an earlier run. What was found before a failure is in `results`.
fn analyse_from(
    prepared: &Prepared,
    asked: Asked<'_>,
    known: &KnownMaps,
    sink: &mut dyn ResultSink,
    results: &mut RunResults,
    observer: &dyn Observer,
) -> Result<()> {
    let case = prepared.case;
    results.title = case.title.clone();
    results.resolved_case = case.to_toml();
    results.assumptions = case.assumptions.clone();
    results.warnings.extend(prepared.warnings.iter().chain(&asked.warnings).cloned());
    results.geometry = prepared.geometry();
    results.size = prepared.size();
    sink.record(Stage::Model(results))?;
    let mut run = Run { prepared, observer, sink, clock: Clock::default(), results };
    let done = run.analyses(asked, known);
    let Run { clock, results, .. } = run;
    results.warnings.extend(thickness_warnings(prepared));
    results.timings = clock.phases;
    done
}

/// The analyses of a case under way.
struct Run<'a, 'k> {
    prepared: &'a Prepared<'a>,
    observer: &'a dyn Observer,
    sink: &'k mut dyn ResultSink,
    clock: Clock,
    results: &'k mut RunResults,
}

impl Run<'_, '_> {
    fn analyses(&mut self, asked: Asked<'_>, known: &KnownMaps) -> Result<()> {
        let Asked { selection, sliding, mut in_time, frfs, tests, calibrate, .. } = asked;
        let (prepared, observer, case) = (self.prepared, self.observer, self.prepared.case);
        let wanted_set = |name: &str| !selection.measured_only || has_measured_modes(case, name);
        let all_modes = case.modes.iter().filter(|(name, _)| wanted_set(name));
        let contact_modes = all_modes.clone().filter(|(_, m)| m.contact == ContactState::Closed);

        // The modes that span the complex analysis; without prestress they do not wait for the steady state, and lists
        // of the whole's modes take their share.
        let basis = match &case.cea {
            Some(cea) if selection.cea && !case.prestress && cea.nearest.is_none() => {
                let structure = &prepared.system.structure;
                Some(whole_modes(structure, cea.basis_below, &mut self.clock, observer)?)
            }
            _ => None,
        };
        if selection.modes {
            for (name, analysis) in all_modes.filter(|(_, m)| m.contact == ContactState::Open) {
                let known = basis.as_ref().filter(|_| of_the_whole(prepared, analysis));
                let modes = match known.and_then(|b| b.lowest(wanted(analysis, prepared.system.n_dofs()))) {
                    Some(modes) => named(prepared, name, modes, &prepared.assembled),
                    None => self
                        .clock
                        .time(&format!("real modes, {name}"), || part_modes(prepared, name, observer))?,
                };
                self.keep_modes(modes, analysis, &tests)?;
            }
        }
        if sliding {
            let options = prepared.steady_options();
            let state = self
                .clock
                .time("steady sliding", || equilibrium::solve_steady(&prepared.system, &options, observer))?;
            let steady = steady_result(prepared, state);
            if !prepared.system.pairs.is_empty() {
                self.sink.record(Stage::Found(&steady))?;
            }
            let state = steady.state.clone();
            self.results.steady = Some(steady);
            let mut closed = contact_modes.filter(|_| selection.modes);
            let done = closed
                .try_for_each(|(name, analysis)| self.closed_modes(name, analysis, &state, &tests))
                .and_then(|()| self.complex(selection, &state, basis, in_time.take(), known));
            self.results.steady.take_if(|_| prepared.system.pairs.is_empty());
            done?;
        }
        for frf in &frfs {
            let steady = self.results.steady.as_ref().map(|steady| &steady.state);
            let (response, beside) =
                self.clock.time(&format!("frequency response {}", frf.name()), || {
                    frf.run(prepared, steady, observer)
                })?;
            self.results.measured_frfs.extend(tests.responses(&response, &beside));
            self.sink.record(Stage::Found(&response))?;
            self.results.frfs.push(response);
        }
        if let Some(calibrate) = calibrate {
            let found = self.clock.time("calibration", || calibrate.run(observer))?;
            self.sink.record(Stage::Found(&found))?;
            self.results.calibration = Some(found);
        }
        Ok(())
    }

    fn keep_modes(&mut self, modes: NamedModes, analysis: &ModesAnalysis, tests: &Tests) -> Result<()> {
        self.results.measured.extend(tests.modes(self.results.modes.len(), analysis, &modes));
        self.sink.record(Stage::Found(&modes))?;
        self.results.modes.push(modes);
        Ok(())
    }

    /// Real modes with the contact as it is in steady sliding.
    fn closed_modes(
        &mut self,
        name: &str,
        analysis: &ModesAnalysis,
        state: &SteadySliding,
        tests: &Tests,
    ) -> Result<()> {
        let prepared = self.prepared;
        let wanted = wanted(analysis, prepared.system.n_dofs());
        let closed = equilibrium::closed_structure(&prepared.system, state)?;
        let (modes, _) = self
            .clock
            .time(&format!("real modes, {name}"), || modal::compute(&closed, wanted, self.observer))?;
        self.keep_modes(named(prepared, name, modes, &prepared.assembled), analysis, tests)
    }

    /// Complex modes, and the analyses that begin with them.
    fn complex(
        &mut self,
        selection: Selection,
        steady: &SteadySliding,
        basis: Option<RealModes>,
        in_time: Option<(&TransientAnalysis, Places)>,
        known: &KnownMaps,
    ) -> Result<()> {
        let (prepared, observer, case) = (self.prepared, self.observer, self.prepared.case);
        if !selection.cea {
            return Ok(());
        }
        let left_vectors = in_time.is_some() || selection.sensitivities(case).is_some();
        let complex = complex_result(prepared, steady, basis, left_vectors, &mut self.clock, observer)?;
        let Some((complex, system, real)) = complex else { return Ok(()) };
        self.sink.record(Stage::Found(&complex))?;
        self.results.warnings.extend(complex.modes.warnings.iter().cloned());
        let done = self.with_complex_modes(selection, (&system, steady), (&complex, &real), in_time);
        self.results.complex = Some(complex);
        done?;
        if selection.sweeps && !(case.sweep.is_empty() && case.map.is_empty()) {
            let nominal = Nominal { prepared, system: &system, steady, real: &real };
            let Run { sink, results, clock, .. } = self;
            let mut record = |stage: Stage| sink.record(stage);
            clock.time("sweeps and maps", || explore(&nominal, known, results, &mut record, observer))?;
        }
        Ok(())
    }

    /// Sensitivities and motion in time.
    fn with_complex_modes(
        &mut self,
        selection: Selection,
        (system, steady): (&System, &SteadySliding),
        (complex, real): (&ComplexResult, &RealModes),
        in_time: Option<(&TransientAnalysis, Places)>,
    ) -> Result<()> {
        let (prepared, observer) = (self.prepared, self.observer);
        if let Some(wanted) = selection.sensitivities(prepared.case) {
            let analysed = Analysed { prepared, system, steady, real, modes: &complex.modes };
            let sensitivity =
                self.clock.time("sensitivities", || analysed.sensitivities(&wanted, observer))?;
            self.sink.record(Stage::Found(&sensitivity))?;
            self.results.sensitivity = Some(sensitivity);
        }
        if let Some((wanted, places)) = in_time {
            let (dofs, geometry) = (&prepared.assembled.dofs, &self.results.geometry);
            let run = InTime { system, steady, complex, real, dofs, geometry };
            let transient = self.clock.time(IN_TIME, || run.run(wanted, places, self.sink, observer))?;
            self.sink.record(Stage::Transient(&transient))?;
            self.results.transient = Some(transient);
        }
        Ok(())
    }
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
        if wanted.is_some() && prepared.system.skew().is_some() {
            let found = "matrices whose part that is not symmetric has no low rank, such as gyroscopic terms";
            let expected = "matrices that are symmetric but for contact with friction, for motion in time";
            let help = "Remove [transient]; complex modes and frequency responses are there";
            faults.push(Fault::new("`transient`", found, expected).with_help(help));
        }
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
