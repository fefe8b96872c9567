//! A run in time, as plain data.

use super::channel::Channel;
use super::explored::window;
use super::{CycleFields, Diagnostics, Geometry, NodalField, ReducedCheck, Sound, TouchState};
use crate::dataset::{Column, Describe, Dimension, Group, Table, Variable, column};
use crate::linalg::c64;
use crate::signal::{Growth, Peak, Spectrum};
use crate::transient::{Checkpoint, Event, EventKind, Work};
use std::f64::consts::TAU;

/// Extent of the record of a run in time.
#[derive(Debug, Clone, Copy)]
pub struct Recording<'a> {
    /// Δt \[s\].
    pub time_step: f64,
    /// Steps, the start included.
    pub rows: usize,
    /// How many of them an earlier run has recorded.
    pub done: usize,
    /// How many events it has recorded with them.
    pub happened: usize,
    /// Channels recorded at each step.
    pub channels: &'a [Channel],
    /// Number of real modes whose accelerations are recorded, too.
    pub modes: usize,
    /// The name of the pair of every contact point.
    pub pairs: &'a [String],
    /// Whether fields are written, too.
    pub fields: Option<Fields<'a>>,
}

/// The motion of all nodes at regular times, to be written.
#[derive(Debug, Clone, Copy)]
pub struct Fields<'a> {
    /// The mesh that moves.
    pub geometry: &'a Geometry,
    /// The first is written at the start, the others every so many seconds.
    pub every: f64,
    /// How many there will be.
    pub count: usize,
    /// How many of them an earlier run has written.
    pub done: usize,
}

/// The motion of all nodes at a time.
#[derive(Debug, Clone, Copy)]
pub struct FieldSnapshot<'a> {
    /// How many were written before it.
    pub number: usize,
    /// From steady sliding \[m\].
    pub displacement: &'a NodalField<f64>,
    /// \[m/s\].
    pub velocity: &'a NodalField<f64>,
}

/// A piece of the record, and the state from which the run resumes after it.
#[derive(Debug, Clone, Copy)]
pub struct RecordPiece<'a> {
    /// The first of its rows.
    pub first: usize,
    /// The values of each channel.
    pub values: &'a [Vec<f64>],
    /// Accelerations of the real modes \[√kg m/s²\], if they are recorded.
    pub modal: &'a [Vec<f32>],
    /// Events at the contact points during these rows.
    pub events: &'a [Event],
    /// Where the run stands after its last row.
    pub checkpoint: &'a Checkpoint,
}

/// A channel over frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectrumOf {
    /// Index of the channel.
    pub channel: usize,
    /// The first and last time of what was analysed \[s\].
    pub window: [f64; 2],
    /// Its spectrum.
    pub spectrum: Spectrum,
    /// The peaks of it.
    pub peaks: Vec<Peak>,
    /// Those that were measured \[Hz\], if any.
    pub measured: Vec<f64>,
    /// Where the highest line is \[Hz\], when that is beyond the modes of the case.
    pub beyond: Option<f64>,
}

/// The growth of a small disturbance beside the complex mode that it started along.
#[derive(Debug, Clone, PartialEq)]
pub struct GrowthCompared {
    /// The complex mode, counted from 0.
    pub mode: usize,
    /// Its λ.
    pub eigenvalue: c64,
    /// Growth in the transient while the motion is small; `None` where it cannot be read.
    pub found: Option<Growth>,
    /// Why it cannot.
    pub refused: Option<String>,
    /// What the integrator itself adds to σ \[1/s\] in steps that are not split.
    pub integrator: f64,
}

/// How near a reduced model comes to the deflections under the forces of contacts of many points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactResponses {
    /// The relative error that was asked for.
    pub tolerance: f64,
    /// The largest of random motions, in the norm of strain energy.
    pub error: f64,
    /// How many.
    pub probes: usize,
}

impl ContactResponses {
    /// The part of all such motions that has no larger error with a probability of 95 %: q with qᵐ = 0.05 for m motions.
    pub fn share(&self) -> f64 {
        0.05f64.powf(1.0 / self.probes.max(1) as f64)
    }

    fn group(&self) -> Group<'_> {
        Group::new("contact_responses", "deflections under contact forces in the reduced model")
            .value("tolerance", "1", "relative error that was asked for", self.tolerance)
            .value(
                "error",
                "1",
                "largest relative error of random motions, in the norm of strain energy",
                self.error,
            )
            .value("probes", "1", "random motions", self.probes)
            .value(
                "share",
                "1",
                "part of such motions with no larger error, with a probability of 95 %",
                self.share(),
            )
    }
}

/// A run in time.
#[derive(Debug, Clone, PartialEq)]
pub struct TransientResult {
    /// Δt \[s\].
    pub time_step: f64,
    /// Steps recorded, the start included.
    pub rows: usize,
    /// The integrator, in words.
    pub scheme: String,
    /// The contacts whose friction at rest is any force up to μ(0) N, without bristles and without regularisation.
    pub set_valued: Vec<String>,
    /// Real modes and attachment shapes of a reduced model; `None` for the full one.
    pub reduced: Option<[usize; 2]>,
    /// A reduced model beside the full one.
    pub reduced_check: Option<ReducedCheck>,
    /// The deflections under contact forces of a model that is reduced with many contact points.
    pub contact_responses: Option<ContactResponses>,
    /// Recorded channels.
    pub channels: Vec<Channel>,
    /// The channels shown in the pictures: acceleration, friction, and the force in a load cell, those of them
    /// that there are.
    pub shown: Vec<usize>,
    /// Spectra of the second half of the run.
    pub spectra: Vec<SpectrumOf>,
    /// Frequency of which the named peaks are multiples, one of all channels \[Hz\]; `None` of a record of few periods.
    pub fundamental_hz: Option<f64>,
    /// The motion of all nodes over the last periods; `None` where they are fewer than four.
    pub cycle: Option<CycleFields>,
    /// Growth beside the complex eigenvalue.
    pub growth: Option<GrowthCompared>,
    /// All work.
    pub work: Work,
    /// The largest |residual| of the energy balance of a step over the turnover of energy in it.
    pub worst_residual: f64,
    /// Steps that had to be split, and the most parts.
    pub split: (usize, usize),
    /// Steps and parts of steps in all.
    pub parts: usize,
    /// The share of time in which the most loaded point was in each state of [`TouchState::ALL`].
    pub spent: [f64; TouchState::ALL.len()],
    /// How often each [`EventKind`] happened, at all contact points together.
    pub events: [usize; EventKind::ALL.len()],
    /// Data of its pictures.
    pub diagnostics: Diagnostics,
    /// How loud it is, if the case asks for it.
    pub sound: Option<Sound>,
    /// What in this motion is beyond what the model or the record can mean.
    pub warnings: Vec<String>,
}

impl Describe for TransientResult {
    fn describe(&self) -> Group<'_> {
        let steps = self.len().saturating_sub(1);
        let [open, sticking, backwards, _] = self.spent;
        let (split, most) = self.split;
        let reduced =
            self.reduced.map(|[modes, attached]| {
                Group::new("reduced", "size of the reduced model")
                    .value("modes", "1", "real modes", modes)
                    .value("attachment", "1", "attachment shapes", attached)
            });
        let set_valued = Variable::texts(
            "set_valued_friction",
            "contacts whose friction at rest is any force up to μ(0) N",
            Dimension::of_variable("set_valued_friction", self.set_valued.len()),
            self.set_valued.clone(),
        );
        let spectra = self.spectra.iter().map(|of| of.group(&self.channels[of.channel])).collect();
        let cycles = self.diagnostics.cycle_table(&self.channels);
        Group::new("transient", "motion in time from steady sliding")
            .value("time_step_s", "s", "Δt", self.time_step)
            .value("steps", "1", "steps, the start not counted", steps)
            .value("duration_s", "s", "time from the first to the last step", steps as f64 * self.time_step)
            .value("scheme", "text", "the integrator", self.scheme.clone())
            .with(set_valued)
            .optional("reduced", reduced)
            .optional("reduced_check", self.reduced_check.as_ref().map(ReducedCheck::group))
            .optional("contact_responses", self.contact_responses.as_ref().map(ContactResponses::group))
            .table(Table::of("channels", "channel", &channel_columns(), &self.channels))
            .value(
                "fundamental_hz",
                "Hz",
                "frequency of which the named peaks are multiples",
                self.fundamental_hz,
            )
            .list("spectrum", spectra)
            .table(self.spectrum_lines())
            .optional("growth", self.growth.as_ref().map(GrowthCompared::group))
            .group(self.event_counts())
            .value("open_fraction", "1", "share of time in which the most loaded point was open", open)
            .value("backwards_fraction", "1", "share of time in which it slipped backwards", backwards)
            .value("sticking_fraction", "1", "share of time in which it stuck", sticking)
            .value("steps_split", "1", "steps that had to be split", split)
            .value("parts", "1", "steps and parts of steps in all", self.parts)
            .value("most_parts", "1", "most parts of a step", most)
            .group(Group::of("energy_j", "work since the start", &work_columns(), &self.work))
            .value(
                "worst_energy_residual",
                "1",
                "largest |residual| of a step's energy balance over its turnover of energy",
                self.worst_residual,
            )
            .table(cycles)
            .list("spectrogram", self.diagnostics.spectrogram_groups(&self.channels))
            .optional("cycle", self.cycle.as_ref().map(CycleFields::group))
            .optional("contact_state", self.diagnostics.contact.group())
            .optional("sound", self.sound.as_ref().map(super::sound::group))
    }
}

impl TransientResult {
    /// Steps recorded, the start included.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// The contacts of [`TransientResult::set_valued`], if any contact point came to rest.
    pub fn stuck_without_give(&self) -> &[String] {
        if self.events[EventKind::Sticks as usize] > 0 { &self.set_valued } else { &[] }
    }

    /// Whether nothing was recorded.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// The amplitudes of all spectra, a column each.
    fn spectrum_lines(&self) -> Table<'static> {
        let first = self.spectra.first().map(|of| &of.spectrum);
        let rows = Dimension::of_variable("frequency_hz", first.map_or(0, |first| first.amplitude.len()));
        let frequencies =
            first.map_or(Vec::new(), |first| (0..rows.length).map(|k| first.frequency_hz(k)).collect());
        let frequency = Variable::reals(rows.name, "Hz", "frequency", vec![rows.clone()], frequencies);
        let amplitude = |of: &SpectrumOf| {
            let channel = &self.channels[of.channel];
            let story = "amplitude of the sine that gives each line";
            let amplitudes = of.spectrum.amplitude.clone();
            Variable::reals(channel.name.clone(), channel.unit, story, vec![rows.clone()], amplitudes)
        };
        let columns = std::iter::once(frequency).chain(self.spectra.iter().map(amplitude)).collect();
        Table::along("spectrum_lines", rows.clone(), columns).file("transient_spectrum").long()
    }

    fn event_counts(&self) -> Group<'static> {
        let group = Group::new("events", "what happened at the contact points");
        EventKind::ALL.iter().zip(self.events).fold(group, |group, (kind, count)| {
            group.value(kind.name(), "1", "how often it happened, at all contact points together", count)
        })
    }
}

fn channel_columns() -> Vec<Column<Channel>> {
    vec![
        column("name", "text", "name of the channel", |c: &Channel| c.name.clone()),
        column("unit", "text", "its unit", |c: &Channel| c.unit),
        column("description", "text", "what it is", |c: &Channel| c.about.clone()),
        column("range", "unit", "the least and the greatest value", |c: &Channel| c.range)
            .along(Dimension::limits()),
        column("last", "unit", "the last value", |c: &Channel| c.last),
    ]
}

fn work_columns() -> Vec<Column<Work>> {
    vec![
        column("stored", "J", "½vᵀMv + ½uᵀKu gained", |w: &Work| w.kinetic + w.strain),
        column("external", "J", "work of constant load and excitations", |w: &Work| w.external),
        column("normal", "J", "work of the normal forces of the contacts", |w: &Work| w.normal),
        column("drive", "J", "spent by the drives of the counter-bodies against friction", |w: &Work| {
            w.drive
        }),
        column("heat", "J", "turned into heat by friction", |w: &Work| w.heat),
        column("damping", "J", "taken by structural damping (negative)", |w: &Work| w.damping),
        column("coupling", "J", "work of imported unsymmetric terms", |w: &Work| w.coupling),
        column("algorithm", "J", "added by the integrator (mostly negative)", |w: &Work| w.algorithm),
        column("residual", "J", "what the balance leaves", Work::residual),
    ]
}

impl SpectrumOf {
    /// The peaks of the spectrum of a channel.
    fn group<'a>(&self, channel: &'a Channel) -> Group<'a> {
        let peaks = [
            column("frequency_hz", "Hz", "frequency, between the lines", |peak: &Peak| peak.frequency_hz),
            column("amplitude", channel.unit, "amplitude", |peak: &Peak| peak.amplitude),
            column("relation", "text", "relation to the fundamental", |peak: &Peak| peak.relation.clone()),
        ];
        let measured = Dimension::of_variable("measured_hz", self.measured.len());
        Group::new(&*channel.name, "a channel over frequency")
            .value("channel", "text", "name of the channel", channel.name.clone())
            .value("unit", "text", "its unit", channel.unit)
            .with(window(self.window, "the first and the last time of what was analysed"))
            .value("resolution_hz", "Hz", "Δf, from line to line", self.spectrum.resolution_hz)
            .table(Table::of("peaks", "peak", &peaks, &self.peaks))
            .with(Variable::reals(
                "measured_hz",
                "Hz",
                "peaks that were measured",
                vec![measured],
                self.measured.clone(),
            ))
            .value(
                "strongest_beyond_hz",
                "Hz",
                "the highest line, where that is beyond the modes of the case",
                self.beyond,
            )
    }
}

impl GrowthCompared {
    fn group(&self) -> Group<'static> {
        type Compared = GrowthCompared;
        let columns = [
            column("mode", "1", "complex mode, from 1", |g: &Compared| g.mode + 1),
            column("cea_growth_rate", "1/s", "σ of the complex mode", |g: &Compared| g.eigenvalue.re),
            column("cea_frequency_hz", "Hz", "its frequency", |g: &Compared| g.eigenvalue.im / TAU),
            column("growth_rate", "1/s", "σ in time", |g: &Compared| g.found.map(|f| f.rate)),
            column("frequency_hz", "Hz", "frequency in time", |g: &Compared| g.found.map(|f| f.frequency_hz)),
            column("window_s", "s", "the first and the last time of what was fitted", |g: &Compared| {
                g.found.map(|f| f.window)
            })
            .along(Dimension::limits()),
            column("refused", "text", "why growth in time cannot be read", |g: &Compared| g.refused.clone()),
            column(
                "integrator_growth_rate",
                "1/s",
                "what the integrator itself adds to σ",
                |g: &Compared| g.integrator,
            ),
            column("deviation", "1", "r.m.s. deviation of ln|c| from its line", |g: &Compared| {
                g.found.map(|f| f.deviation)
            }),
        ];
        Group::of("growth", "growth in time beside a complex eigenvalue", &columns, self)
    }
}
