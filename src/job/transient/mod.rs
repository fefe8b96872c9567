//! A case in time: what is recorded, step after step, and what the record says.
//!
//! [`places`] says what acts and where motion is recorded, `along` finds the complex mode to start along, `recorder`
//! makes a row of every step, `snapshots` take the motion of all nodes now and then, `harmonic_fields` its Fourier series over the last periods, `history_writer` hands the rows on a piece at
//! a time, so that memory does not grow with the run, and `findings`, `diagnostics` and `modal` read them back in parts: spectra and growth, data of the pictures, sound.
//! `limits`, `deflection`, `rotation` and `depth` say what the record cannot bear.

mod along;
mod channels;
mod deflection;
mod depth;
mod diagnostics;
mod findings;
mod harmonic_fields;
mod history_writer;
mod in_time;
mod limits;
mod modal;
mod names;
mod places;
mod recorded_sound;
mod recorder;
mod reduced_check;
mod rotation;
mod snapshots;
mod start;
mod step;

pub use in_time::InTime;
pub use places::{TransientPlaces, places};

use super::modes::{identify, labels};
use super::sink::ResultSink;
use super::time_function::profile;
use crate::case::{SchemeChoice, TransientAnalysis};
use crate::equilibrium::SteadySliding;
use crate::error::{Error, Fault, Result};
use crate::linalg::SparseVector;
use crate::progress::Observer;
use crate::reduction::{ManyPoints, Reduced, ReducedContacts, has_many_points, reduce};
use crate::results::{ContactResponses, TransientResult};
use crate::sound::SoundAccumulator;
use crate::system::System;
use crate::transient::{Marched, Plan, Scheme, State, StepMethod, TimeProfile, TransientModel, resume};
use along::Along;
use deflection::Deflections;
use harmonic_fields::HarmonicFields;
use history_writer::HistoryWriter;
use modal::ModalMotion;
use recorder::Recorder;
use reduced_check::{first_steps, reduced_check};
use snapshots::Snapshots;
use start::InitialState;

/// Peaks and spectrograms reach this many times as high as the band of the complex eigenvalues: modes above it are neither
/// damped nor resolved as those in it are.
const WATCHED: f64 = 1.25;

impl InTime<'_> {
    /// Marches; `sink` gets what is recorded a piece at a time.
    ///
    /// # Errors
    /// A mode to disturb that is not there, a step without a solution; what was recorded until then is kept.
    pub fn run(
        &self,
        wanted: &TransientAnalysis,
        places: TransientPlaces,
        sink: &mut dyn ResultSink,
        observer: &dyn Observer,
    ) -> Result<TransientResult> {
        let point = self.point;
        let beside = first_steps(self, wanted, &places, observer)?;
        let start = self.start(wanted, &places)?;
        let loadings = self.loadings(wanted)?;
        let mut places = places;
        let heaviest = heaviest(&start.state);
        places.probe_contact(&point.system, heaviest);
        let mut disturbed = wanted.disturbance.as_ref().map(|d| self.along(d)).transpose()?;
        let reduced = match self.is_reduced(wanted) {
            false => None,
            true => {
                let state = &start.state.displacement;
                Some(self.on_reduced(&mut places, &mut disturbed, (wanted.contact_tolerance, state))?)
            }
        };
        let TransientPlaces { pushes, probes, gauges, tracks, acoustics, .. } = places;
        let InitialState { state: origin, at_rest } = start;
        let small = reduced.as_ref().map(|reduced| reduced.steady(&origin));
        let steady = small.as_ref().unwrap_or(&origin);
        let system = reduced.as_ref().map_or(&*point.system, |reduced| &reduced.system);
        let profiles: Vec<TimeProfile> = point
            .system
            .pairs
            .iter()
            .map(|pair| profile(wanted.slide.get(&pair.name).map(|s| &s.course)))
            .collect();
        let contacts = reduced.as_ref().and_then(|reduced| reduced.contacts.as_ref());
        let model = match contacts {
            Some(ReducedContacts { pairs, basis, .. }) => {
                TransientModel::reduced(system, (pairs, basis), steady)?
            }
            None => TransientModel::new(system, steady)?,
        };
        let model = model
            .driven(profiles, pushes)
            .loaded(loadings)
            .holding(self.loads(wanted))
            .travelling(tracks.iter().map(Option::as_ref).collect());
        let model = if contacts.is_some() && !at_rest { model.balanced(steady) } else { model };
        let mut start = if at_rest { State::at_rest(&model, steady)? } else { State::steady(&model, steady) };
        if let (Some(along), Some(wanted)) = (&disturbed, &wanted.disturbance) {
            start = start.disturbed(&model, along.eigenvalue, &along.shape, wanted.amplitude / along.largest);
        }
        let plan = plan(wanted);
        let steps = plan.steps;
        let nodes = Snapshots {
            every: wanted.fields_every.map_or(steps, |every| places::steps(every, wanted.time_step)),
            geometry: self.geometry,
            dofs: &point.prepared.assembled.dofs,
            reduced: reduced.as_ref(),
            origin: &steady.displacement,
        };
        let top = WATCHED * self.complex.band_hz[1];
        // Real modes are complete up to their highest.
        let real = match acoustics {
            Some(_) => Some(point.open_modes(observer)?),
            None => None,
        };
        let accumulator = acoustics.zip(real).map(|(acoustics, real)| {
            let highest = (0..real.len()).map(|k| real.frequency_hz(k)).fold(0.0, f64::max);
            SoundAccumulator::new(acoustics, (&real.shapes, highest), (plan.step, steps))
        });
        let mass = reduced.is_none().then_some(&*point.system.structure.mass);
        let modal = real.map(|real| ModalMotion::new(real, mass));
        let along = disturbed.as_ref().map(|along| along.eigenvalue);
        let mut recorder =
            Recorder::new((&point.system, heaviest), steady, &model, (probes, gauges), disturbed, modal);
        if let Some(motion) = recorder.shown.first_mut().filter(|shown| shown.measured.is_empty()) {
            motion.measured = self.complex.measured_squeal_hz.iter().map(|(hz, _)| *hz).collect();
        }
        let cycle = (HarmonicFields::new(nodes, plan.step, steps), top);
        let snapshots = wanted.fields_every.map(|_| nodes);
        let deflections = Deflections::new(point.prepared, nodes, steps);
        let mut history_writer = HistoryWriter::new(recorder, snapshots, (cycle, deflections), sink);
        let mut marched = history_writer.begin(start, &model, &plan)?;
        march_on(&mut history_writer, (&model, &plan), &mut marched, observer)?;
        let share = |count: usize| count as f64 / (steps + 1) as f64;
        let mut found = history_writer.findings(steps + 1, &plan, top)?;
        if let Some(growth) = found.growth.as_mut().filter(|_| model.holds_load()) {
            growth.found = None;
            growth.refused =
                Some("the load is kept in motion, and the complex eigenvalues keep the approach".to_string());
        }
        if !self.names_peaks(along, plan.step) {
            found.spectra.iter_mut().for_each(|of| of.peaks.clear());
            found.fundamental_hz = None;
        }
        let diagnostics = history_writer.diagnostics(steps + 1, plan.step, &found, top)?;
        let mut sound = accumulator
            .map(|accumulator| history_writer.recorded_sound(accumulator, steps + 1))
            .transpose()?;
        if let Some((sound, real)) = sound.as_mut().zip(real) {
            sound.name_tones(found.spectra.iter().flat_map(|of| &of.peaks));
            let whole = (&point.prepared.model, &*point.prepared.assembled);
            sound.mode_names = labels(&identify(point.prepared, real, whole), real);
        }
        let first = |name: &str, count: usize| history_writer.sink.recorded(name, 0..count);
        let own = (&*point.system, &*point.steady, self.complex);
        let check = |reduced| reduced_check(reduced, own, beside.as_ref(), &first, observer);
        let reduced_check = reduced.as_ref().map(check).transpose()?;
        let HistoryWriter { recorder, cycle, deflections, .. } = history_writer;
        let taken = plan.step * steps as f64 / marched.control.parts.max(1) as f64;
        let mut warnings = self.motion_warnings(wanted, along, taken, &recorder.described);
        warnings.extend(deflections.warnings());
        Ok(TransientResult {
            time_step: plan.step,
            rows: steps + 1,
            scheme: scheme(wanted.scheme).1,
            set_valued: set_valued(&point.system),
            reduced: reduced.as_ref().map(|r| [r.modes, r.basis.ncols() - r.modes]),
            reduced_check,
            contact_responses: contacts.map(|contacts| ContactResponses {
                tolerance: wanted.contact_tolerance,
                error: contacts.error.largest,
                probes: contacts.error.probes,
            }),
            shown: recorder.shown.into_iter().map(|shown| shown.channel).collect(),
            spent: recorder.spent.map(share),
            events: recorder.happened,
            channels: recorder.described,
            spectra: found.spectra,
            fundamental_hz: found.fundamental_hz,
            cycle: cycle.0.finish(),
            growth: found.growth,
            work: marched.work,
            worst_residual: marched.worst_residual,
            split: marched.split,
            parts: marched.control.parts,
            diagnostics,
            sound,
            warnings,
        })
    }

    /// The reduced model, on which all places and the disturbed mode stand from then on.
    fn on_reduced(
        &self,
        places: &mut TransientPlaces,
        disturbed: &mut Option<Along>,
        (tolerance, state): (f64, &[f64]),
    ) -> Result<Reduced> {
        let many_points = has_many_points(&self.point.system).then(|| ManyPoints {
            tolerance,
            linear: false,
            shapes: self.complex.modes.parts(),
            states: vec![state.to_vec()],
        });
        self.refuse_many_that_travel(places)?;
        let TransientPlaces { pushes, probes, gauges, tracks, .. } = places;
        let stations = tracks.iter().flatten().flat_map(|track| track.stations.iter().flatten());
        let stations = stations.flat_map(|point| [&point.normal, &point.tangents[0], &point.tangents[1]]);
        let pushed = pushes.iter().map(|push| &push.direction);
        let forces: Vec<SparseVector> = pushed.chain(stations).cloned().collect();
        let reduced = reduce(
            &self.point.system,
            &self.point.steady,
            self.point.open_modes(&())?,
            &forces,
            many_points,
        )?;
        pushes.iter_mut().for_each(|push| push.direction = reduced.form(&push.direction));
        probes.iter_mut().for_each(|probe| probe.direction = reduced.form(&probe.direction));
        for gauge in gauges {
            gauge.stiffness = reduced.form(&gauge.stiffness);
            gauge.damping = reduced.form(&gauge.damping);
        }
        let points = tracks.iter_mut().flatten().flat_map(|track| track.stations.iter_mut().flatten());
        points.for_each(|point| *point = reduced.point(point));
        *disturbed = disturbed.take().map(|along| along.reduced(&reduced));
        Ok(reduced)
    }

    /// A reduced model has the deflections under a contact of many points where that stands.
    fn refuse_many_that_travel(&self, places: &TransientPlaces) -> Result<()> {
        let pairs = self.point.system.pairs.iter().zip(&places.tracks);
        let travelling = pairs.filter(|(_, track)| track.is_some()).map(|(pair, _)| &pair.name);
        match travelling.take(1).find(|_| has_many_points(&self.point.system)) {
            None => Ok(()),
            Some(name) => {
                let found = format!(
                    "a contact that travels, with {} points in all",
                    self.point.system.points().count()
                );
                let expected = "contacts that stay, or up to 500 points";
                let help =
                    "Set `travels = false`, or `transient.model = \"full\"` where memory and time allow it";
                Err(Error::input(
                    Fault::new(format!("transient.slide.{name}"), found, expected).with_help(help),
                ))
            }
        }
    }
}

/// The contact point that carries most.
fn heaviest(steady: &SteadySliding) -> usize {
    let points = &steady.points;
    let heavier = |a: &usize, b: &usize| points[*a].forces.normal.total_cmp(&points[*b].forces.normal);
    (0..points.len()).max_by(heavier).unwrap_or(0)
}

/// Marches to the end; what was recorded is written, whatever comes.
fn march_on(
    writer: &mut HistoryWriter,
    (model, plan): (&TransientModel, &Plan),
    marched: &mut Marched,
    observer: &dyn Observer,
) -> Result<()> {
    let reached = resume(model, marched, plan, observer, &mut |marched| writer.take(marched));
    let kept = match &reached {
        // A field of the last row may be missing, and the next attempt to write would not be the first.
        Err(Error::Io { .. }) => Ok(()),
        _ => writer.flush(marched),
    };
    reached.and(kept)
}

fn plan(wanted: &TransientAnalysis) -> Plan {
    Plan {
        scheme: scheme(wanted.scheme).0,
        step: wanted.time_step,
        steps: places::steps(wanted.duration, wanted.time_step),
        method: if wanted.full_newton { StepMethod::FullNewton } else { StepMethod::Condensed },
        tolerance: wanted.tolerance,
    }
}

/// The contacts whose friction at rest follows from the motion of the whole.
fn set_valued(system: &System) -> Vec<String> {
    let pairs = system.pairs.iter().filter(|pair| pair.law.is_set_valued());
    pairs.map(|pair| pair.name.clone()).collect()
}

fn scheme(choice: SchemeChoice) -> (Scheme, String) {
    match choice {
        SchemeChoice::Newmark {} => (Scheme::TRAPEZOIDAL, "Newmark, β = 1/4, γ = 1/2".into()),
        SchemeChoice::Hht { alpha } => (Scheme::hht(alpha), format!("HHT, α = {alpha}")),
        SchemeChoice::GeneralisedAlpha { rho } => {
            (Scheme::generalised_alpha(rho), format!("generalised α, ρ∞ = {rho}"))
        }
    }
}
