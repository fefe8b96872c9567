//! A case in time: what is recorded, step after step, and what the record says.

use super::analyse::Stage;
use super::prepared::Prepared;
use super::reduced_check::{first_steps, reduced_check};
use crate::case::{Disturbance, ModelChoice, SchemeChoice, Slide, TransientAnalysis};
use crate::equilibrium::SteadySliding;
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::{SparseVector, c64};
use crate::modal::RealModes;
use crate::progress::Observer;
use crate::reduction::{Reduced, reduce};
use crate::results::{Channel, ComplexResult, GrowthCompared, SpectrumOf, TransientResult};
use crate::signal;
use crate::stability::{ModalFilter, modal_filter};
use crate::system::System;
use crate::transient::{self, Method, Model, Moment, Plan, Profile, Push, Scheme, State, march};

/// Steps between two writings.
const CHUNK: usize = 4096;
/// Lines of a spectrum reach to 1/Δt/2; a segment is this part of the second half of the run.
const SEGMENTS: usize = 3;
/// Peaks named, and how far below the highest they may be.
const PEAKS: usize = 12;
const FLOOR: f64 = 1e-3;
/// A disturbance is small while the penetration changes by less than this part of itself.
const SMALL: f64 = 0.01;

/// A run in time of `system`, whose modal damping is in it, from its steady state.
pub struct InTime<'a> {
    /// The system with its modal damping.
    pub system: &'a System,
    /// Where it starts.
    pub steady: &'a SteadySliding,
    /// Its complex modes.
    pub complex: &'a ComplexResult,
    /// The real modes that span them.
    pub real: &'a RealModes,
}

impl InTime<'_> {
    /// Marches; `record` gets the channels a chunk at a time.
    ///
    /// # Errors
    /// A mode to disturb that is not there, a step without a solution.
    pub fn run(
        &self,
        wanted: &TransientAnalysis,
        places: Places,
        record: &mut dyn FnMut(Stage) -> Result<()>,
        observer: &dyn Observer,
    ) -> Result<TransientResult> {
        let beside = first_steps(self, wanted, &places, observer)?;
        let Places { mut pushes, mut probes } = places;
        let mut disturbed = wanted.disturbance.as_ref().map(|d| self.along(d)).transpose()?;
        let reduced = match wanted.model {
            ModelChoice::Full => None,
            ModelChoice::Reduced => {
                let forces: Vec<SparseVector> = pushes.iter().map(|push| push.direction.clone()).collect();
                let reduced = reduce(self.system, self.steady, self.real, &forces)?;
                pushes.iter_mut().for_each(|push| push.direction = reduced.form(&push.direction));
                probes.iter_mut().for_each(|(_, direction)| *direction = reduced.form(direction));
                disturbed = disturbed.map(|along| along.reduced(&reduced));
                Some(reduced)
            }
        };
        let small = reduced.as_ref().map(|reduced| reduced.steady(self.steady));
        let steady = small.as_ref().unwrap_or(self.steady);
        let system = reduced.as_ref().map_or(self.system, |reduced| &reduced.system);
        let profiles: Vec<Profile> =
            self.system.pairs.iter().map(|pair| profile(wanted.slide.get(&pair.name))).collect();
        let model = Model::new(system, steady)?.driven(profiles, pushes);
        let mut start = State::steady(&model, steady);
        if let (Some(along), Some(wanted)) = (&disturbed, &wanted.disturbance) {
            start = start.disturbed(&model, along.eigenvalue, &along.shape, wanted.amplitude / along.largest);
        }
        let (scheme, words) = scheme(wanted.scheme);
        let steps = (wanted.duration / wanted.time_step).round().max(1.0) as usize;
        let method = if wanted.full_newton { Method::FullNewton } else { Method::Condensed };
        let plan = Plan { scheme, step: wanted.time_step, steps, method };
        let mut recorder = Recorder::new(system, steady, &model, probes, disturbed);
        record(Stage::TransientBegins(wanted.time_step, &recorder.channels))?;
        let mut written = 0;
        let marched = march(&model, start, &plan, observer, &mut |moment| {
            recorder.take(moment);
            if moment.step - written >= CHUNK || moment.step == steps {
                record(Stage::TransientRows(written, &recorder.channels))?;
                written = moment.step + 1;
            }
            Ok(())
        })?;
        let Recorder { channels, shown, penetration, amplitude, along, open, backwards, .. } = recorder;
        let growth = along.map(|Along { mode, eigenvalue, .. }| {
            let p = &channels[penetration].values;
            let large = |d: &f64| (d - p[0]).abs() > SMALL * p[0].abs();
            let end = p.iter().position(large).unwrap_or(p.len());
            let window = [0.0, end as f64 * plan.step];
            let [re, im] = amplitude.map(|channel| &channels[channel].values);
            GrowthCompared { mode, eigenvalue, found: signal::growth(re, im, plan.step, window) }
        });
        let spectra = shown.map(|channel| spectrum_of(&channels, channel, plan.step)).into();
        let first = |name: &str, count: usize| {
            let values = channels.iter().find(|channel| channel.name == name).map(|c| &c.values[..count]);
            Ok(values.unwrap_or_default().to_vec())
        };
        let compared = reduced
            .as_ref()
            .map(|r| reduced_check(self, r, beside.as_ref(), &first, observer))
            .transpose()?;
        let share = |count: usize| count as f64 / (steps + 1) as f64;
        Ok(TransientResult {
            time_step: plan.step,
            scheme: words,
            reduced_check: compared,
            channels,
            reduced: reduced.as_ref().map(|r| [r.modes, r.basis.ncols() - r.modes]),
            shown,
            spectra,
            growth,
            work: marched.work,
            worst_residual: marched.worst_residual,
            split: marched.split,
            open: share(open),
            backwards: share(backwards),
        })
    }

    /// The mode that a disturbance is along.
    fn along(&self, disturbance: &Disturbance) -> Result<Along> {
        let mode = self.mode(disturbance.mode_near)?;
        let own = &self.complex.modes.modes[mode];
        let moves = |node: &[c64; 6]| (0..3).map(|k| node[k].norm_sqr()).sum::<f64>().sqrt();
        let largest = self.complex.shapes[mode].iter().map(moves).fold(f64::MIN_POSITIVE, f64::max);
        let filter = modal_filter(self.system, self.steady, own)?;
        Ok(Along { mode, eigenvalue: own.eigenvalue, shape: own.right.clone(), filter, largest })
    }

    /// The mode nearest to a frequency, one that grows if any does, or the one that grows fastest.
    fn mode(&self, near: Option<f64>) -> Result<usize> {
        let modes = &self.complex.modes.modes;
        let all = 0..modes.len();
        let grows = modes.iter().any(|mode| mode.unstable());
        let chosen = match near {
            // Of a pair that coupled it is the one that grows that is meant.
            Some(hz) => all.filter(|k| modes[*k].unstable() || !grows).min_by(|a, b| {
                let distance = |k: usize| (modes[k].frequency_hz() - hz).abs();
                distance(*a).total_cmp(&distance(*b))
            }),
            None => all.max_by(|a, b| modes[*a].growth_rate().total_cmp(&modes[*b].growth_rate())),
        };
        chosen.ok_or_else(|| {
            Error::input(Fault::new(
                "`transient.disturbance`",
                "no complex mode in the band of [cea]",
                "a band with modes",
            ))
        })
    }
}

/// What acts on the structure in time, and where its motion is recorded.
#[derive(Debug, Clone)]
pub struct Places {
    pushes: Vec<Push>,
    /// Names and directions.
    probes: Vec<(String, SparseVector)>,
}

/// The places of a run in time; asked for before anything is computed or written.
///
/// # Errors
/// Every name that the mesh does not have, and damping that time does not know.
pub fn places(prepared: &Prepared<'_>, wanted: &TransientAnalysis) -> Result<Places> {
    transient::refuse_hysteretic(&prepared.system)?;
    let mut faults = Faults::new();
    let mut reduced = |on: &str, place: String, vector: [f64; 3]| {
        let nodes = faults.take(prepared.regions.nodes(on, &place)).unwrap_or_default();
        let share = vector.map(|v| v / nodes.len().max(1) as f64);
        let entries: Vec<(usize, usize, f64)> = nodes
            .iter()
            .flat_map(|node| share.iter().enumerate().map(|(axis, v)| (*node, axis, *v)))
            .collect();
        prepared.assembled.dofs.reduce(&entries)
    };
    let pushes = wanted.push.iter().map(|(name, push)| Push {
        direction: reduced(&push.on, format!("`transient.push.{name}.on`"), push.force),
        begin: push.begin,
        duration: push.duration,
    });
    let pushes: Vec<Push> = pushes.collect();
    let (mut probes, mut lost) = (Vec::<(String, SparseVector)>::new(), Vec::new());
    for (name, probe) in &wanted.probe {
        let length = probe.direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        let direction = probe.direction.map(|d| d / length);
        let form = match (&probe.on, probe.at) {
            (Some(on), _) => reduced(on, format!("`transient.probe.{name}.on`"), direction),
            (None, at) if !prepared.model.nodes.is_empty() => {
                nearest(prepared, at.unwrap_or_default(), direction)
            }
            (None, _) => {
                let (place, expected) =
                    (format!("`transient.probe.{name}.at`"), "a case whose nodes have coordinates");
                lost.push(Fault::new(place, "a place", expected).with_help("`matrices.dofs` may give them"));
                continue;
            }
        };
        probes.push((name.clone(), form));
    }
    lost.into_iter().for_each(|fault| faults.push(fault));
    for (name, _) in probes.iter().filter(|(_, d)| d.indices().is_empty()) {
        faults.push(Fault::new(
            format!("`transient.probe.{name}`"),
            "a place that is held in this direction",
            "one that can move",
        ));
    }
    faults.into_result(Places { pushes, probes })
}

/// The motion of the node nearest to a place along a direction.
fn nearest(prepared: &Prepared<'_>, place: [f64; 3], direction: [f64; 3]) -> SparseVector {
    let away = |node: &[f64; 3]| (0..3).map(|k| (node[k] - place[k]).powi(2)).sum::<f64>();
    let nodes = prepared.model.nodes.iter().enumerate();
    let node = nodes.min_by(|a, b| away(a.1).total_cmp(&away(b.1))).map_or(0, |(node, _)| node);
    let entries: Vec<_> = direction.iter().enumerate().map(|(axis, d)| (node, axis, *d)).collect();
    prepared.assembled.dofs.reduce(&entries)
}

fn profile(slide: Option<&Slide>) -> Profile {
    match slide {
        None => Profile::Constant,
        Some(Slide::Ramp { from, duration }) => Profile::Ramp { from: *from, duration: *duration },
        Some(Slide::Reciprocating { frequency, phase }) => {
            Profile::Reciprocating { frequency_hz: *frequency, phase: *phase }
        }
        Some(Slide::Table { time, factor }) => {
            Profile::Table { times: time.clone(), factors: factor.clone() }
        }
    }
}

fn scheme(choice: SchemeChoice) -> (Scheme, String) {
    match choice {
        SchemeChoice::Newmark => (Scheme::TRAPEZOIDAL, "Newmark, β = 1/4, γ = 1/2".into()),
        SchemeChoice::Hht { alpha } => (Scheme::hht(alpha), format!("HHT, α = {alpha}")),
        SchemeChoice::GeneralisedAlpha { rho } => {
            (Scheme::generalised_alpha(rho), format!("generalised α, ρ∞ = {rho}"))
        }
    }
}

/// The spectrum of the second half of a channel.
fn spectrum_of(channels: &[Channel], channel: usize, step: f64) -> SpectrumOf {
    let values = &channels[channel].values;
    let half = &values[values.len() / 2..];
    let spectrum = signal::spectrum(half, step, half.len() * 2 / (SEGMENTS + 1));
    let mut peaks = signal::peaks(&spectrum, FLOOR, PEAKS);
    signal::name_peaks(&mut peaks, 0.5 * spectrum.resolution_hz);
    let window = [(values.len() - half.len()) as f64 * step, values.len().saturating_sub(1) as f64 * step];
    SpectrumOf { channel, window, spectrum, peaks }
}

/// The complex mode that the motion starts along.
struct Along {
    mode: usize,
    eigenvalue: c64,
    shape: Vec<c64>,
    filter: ModalFilter,
    /// The largest translation of its shape.
    largest: f64,
}

impl Along {
    /// The same seen through the basis V of a reduced model: VᵀMφ, and Vᵀ of the filter.
    fn reduced(self, reduced: &Reduced) -> Along {
        let parts = |x: &[c64], of: &dyn Fn(&[f64]) -> Vec<f64>| -> Vec<c64> {
            let re = of(&x.iter().map(|z| z.re).collect::<Vec<f64>>());
            let im = of(&x.iter().map(|z| z.im).collect::<Vec<f64>>());
            re.into_iter().zip(im).map(|(re, im)| c64::new(re, im)).collect()
        };
        let shape = parts(&self.shape, &|x| reduced.coordinates(x));
        let filter = ModalFilter {
            displacement: parts(&self.filter.displacement, &|x| reduced.dual(x)),
            velocity: parts(&self.filter.velocity, &|x| reduced.dual(x)),
        };
        Along { shape, filter, ..self }
    }
}

/// Fills the channels.
struct Recorder<'a> {
    model: &'a Model<'a>,
    /// Directions, and where they stand in steady sliding.
    probes: Vec<(SparseVector, f64)>,
    /// The points of each pair.
    pairs: Vec<std::ops::Range<usize>>,
    /// The point that carries most at the start.
    point: usize,
    channels: Vec<Channel>,
    /// The channels to show: motion and friction.
    shown: [usize; 2],
    /// The channel of the penetration of the most loaded point.
    penetration: usize,
    along: Option<Along>,
    /// The channels of its amplitude, re and im.
    amplitude: [usize; 2],
    /// u₀.
    origin: &'a [f64],
    /// u − u₀.
    moved: Vec<f64>,
    open: usize,
    backwards: usize,
}

impl<'a> Recorder<'a> {
    fn new(
        system: &System,
        steady: &'a SteadySliding,
        model: &'a Model<'a>,
        mut probes: Vec<(String, SparseVector)>,
        along: Option<Along>,
    ) -> Self {
        let points = &steady.points;
        let heaviest = |a: &usize, b: &usize| points[*a].forces.normal.total_cmp(&points[*b].forces.normal);
        let point = (0..points.len()).max_by(heaviest).unwrap_or(0);
        if probes.is_empty()
            && let Some((_, place)) = system.points().nth(point)
        {
            probes.push(("contact".into(), place.tangents[0].clone()));
        }
        let mut channels = Vec::new();
        let mut add = |name: String, unit: &'static str, about: String| {
            channels.push(Channel { name, unit, about, values: Vec::new() });
            channels.len() - 1
        };
        let mut shown = [0, 0];
        for (k, (name, _)) in probes.iter().enumerate() {
            add(format!("{name}_displacement"), "m", format!("displacement at {name}, from steady sliding"));
            let velocity = add(format!("{name}_velocity"), "m/s", format!("velocity at {name}"));
            add(format!("{name}_acceleration"), "m/s^2", format!("acceleration at {name}"));
            if k == 0 {
                shown[0] = velocity;
            }
        }
        let mut first = 0;
        let mut pairs = Vec::new();
        for (k, pair) in system.pairs.iter().enumerate() {
            pairs.push(first..first + pair.points.len());
            first += pair.points.len();
            let name = &pair.name;
            add(format!("{name}_normal_force"), "N", format!("sum of the normal forces of {name}"));
            let friction = add(
                format!("{name}_friction_force"),
                "N",
                format!("sum of friction of {name} on the body along the sliding direction"),
            );
            add(format!("{name}_sliding_velocity"), "m/s", format!("velocity of the counter-body of {name}"));
            if k == 0 {
                shown[1] = friction;
            }
        }
        let penetration =
            add("penetration".into(), "m", "of the point that carries most in steady sliding".into());
        add("slip_velocity".into(), "m/s", "of the same point along the sliding direction".into());
        let story = "½vᵀMv + ½uᵀKu gained since the start";
        add("energy_stored".into(), "J", story.into());
        for (name, about) in [
            ("energy_drive", "spent by the drives of the counter-bodies against friction"),
            ("energy_heat", "turned into heat by friction"),
            ("energy_damping", "taken by structural damping (negative)"),
            ("energy_algorithm", "added by the integrator (mostly negative)"),
        ] {
            add(name.into(), "J", format!("{about}, since the start"));
        }
        let amplitude = [("mode_re", "real"), ("mode_im", "imaginary")].map(|(name, part)| {
            let about =
                format!("{part} part of the amplitude of the disturbed mode, its largest translation");
            if along.is_some() { add(name.into(), "m", about) } else { 0 }
        });
        let placed = |(_, direction): (String, SparseVector)| {
            let origin = direction.dot(&steady.displacement);
            (direction, origin)
        };
        let probes = probes.into_iter().map(placed).collect();
        let (origin, moved) = (&steady.displacement, Vec::new());
        Recorder {
            model,
            probes,
            pairs,
            point,
            channels,
            shown,
            penetration,
            along,
            amplitude,
            origin,
            moved,
            open: 0,
            backwards: 0,
        }
    }

    fn take(&mut self, moment: &Moment<'_>) {
        let (state, work) = (moment.state, moment.work);
        let mut row = Vec::with_capacity(self.channels.len());
        for (direction, origin) in &self.probes {
            row.push(direction.dot(state.motion.col_as_slice(0)) - origin);
            row.extend([1, 2].map(|k| direction.dot(state.motion.col_as_slice(k))));
        }
        for (k, points) in self.pairs.iter().enumerate() {
            let sum = |component: usize| -> f64 {
                points.clone().map(|p| state.contact_forces(p)[component]).sum()
            };
            row.extend([sum(0), sum(1), state.speeds()[k]]);
        }
        let slip = if self.pairs.is_empty() { 0.0 } else { state.slip_velocity(self.model, self.point)[0] };
        let deep = if self.pairs.is_empty() { 0.0 } else { state.penetration(self.model, self.point) };
        row.extend([deep, slip, work.kinetic + work.strain, work.drive, work.heat, work.damping]);
        row.push(work.algorithm);
        if let Some(along) = &self.along {
            let (u, v) = (state.motion.col_as_slice(0), state.motion.col_as_slice(1));
            self.moved.clear();
            self.moved.extend(u.iter().zip(self.origin).map(|(u, origin)| u - origin));
            let amplitude = along.filter.amplitude(&self.moved, v) * along.largest;
            row.extend([amplitude.re, amplitude.im]);
        }
        if !self.pairs.is_empty() {
            self.open += usize::from(state.contact_forces(self.point)[0] == 0.0);
            let along = state.speeds()[self.pair_of_point()];
            self.backwards += usize::from(slip * along < 0.0);
        }
        self.channels.iter_mut().zip(row).for_each(|(channel, value)| channel.values.push(value));
    }

    fn pair_of_point(&self) -> usize {
        self.pairs.iter().position(|points| points.contains(&self.point)).unwrap_or(0)
    }
}
