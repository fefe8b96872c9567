//! How loud a run in time is: what is heard of its plates while it goes on.

use super::prepared::Prepared;
use crate::case::{ON_AXIS, SoundAnalysis};
use crate::error::{Fault, Faults, Result};
use crate::linalg::sparse::times;
use crate::linalg::tall::gram;
use crate::linalg::{SparseMatrix, SparseVector};
use crate::modal::RealModes;
use crate::results::{Heard, Recording, Sound, Tone};
use crate::signal::{Resampler, Spectrum, Welch, name_peaks, peaks};
use crate::sound::{Air, CrossSpectra, Plate, Radiation, Receiver};
use crate::structure::ShellPart;
use faer::{Mat, MatRef};
use std::f64::consts::TAU;

/// No one hears beyond this \[Hz\].
const AUDIBLE: f64 = 20_000.0;
/// Lines of the spectra are this far apart, if the run is long enough and they fit in memory \[Hz, bytes\].
const RESOLUTION: f64 = 10.0;
const MEMORY: f64 = 64e6;
/// Tones named, and how far below the highest they may be.
const TONES: usize = 8;
const FLOOR: f64 = 1e-2;
/// Lines on either side of a peak that belong to it.
const SKIRT: usize = 2;
/// Samples a second of the recording, and how many of its last seconds are kept.
const RATE: u32 = 48_000;
const KEPT: usize = 60;
/// Steps that are worked on together; states of a full model that are projected together.
const BLOCK: usize = 1024;
const BATCH: usize = 16;
/// A plate is flat when its nodes are within this part of its extent of its plane.
const FLAT: f64 = 1e-3;

/// The plates of a case as the air sees them, and where one listens.
#[derive(Debug, Clone)]
pub struct Ears {
    plates: Vec<Seen>,
    microphones: Vec<(String, [f64; 3])>,
    air: Air,
}

/// A plate as pistons at its nodes, each with its share of the area.
#[derive(Debug, Clone)]
struct Seen {
    name: String,
    normal: [f64; 3],
    middle: [f64; 3],
    area: f64,
    /// The largest piston \[m²\].
    largest: f64,
    points: Vec<[f64; 3]>,
    /// The volume that each displaces as a linear form of the degrees of freedom \[m²\].
    forms: Vec<SparseVector>,
}

/// What listens to a case; asked for before anything is computed or written.
///
/// # Errors
/// Plates that are not flat, none at all, a microphone on a plate or in the plane of every one.
pub fn ears(prepared: &Prepared<'_>, wanted: &SoundAnalysis) -> Result<Ears> {
    let mut faults = Faults::new();
    let chosen = |part: &&ShellPart| wanted.plates.is_empty() || wanted.plates.contains(&part.name);
    let mut plates = Vec::new();
    for part in prepared.model.shells.iter().filter(chosen) {
        match Seen::new(prepared, part) {
            Some(plate) => plates.push(plate),
            None => faults.push(
                Fault::new(
                    "`transient.sound.plates`",
                    format!("`{}`, which is not flat", part.name),
                    "flat plates, for which Rayleigh's integral holds",
                )
                .with_help("List the flat ones in `plates`"),
            ),
        }
    }
    if plates.is_empty() && faults.0.is_empty() {
        faults.push(Fault::new("`transient.sound`", "a case without plates", "a case with a [shell]"));
    }
    let mut microphones = Vec::new();
    let largest = plates.iter().max_by(|a, b| a.area.total_cmp(&b.area));
    let discs = prepared.discs();
    let disc = plates.iter().find(|plate| discs.iter().any(|(name, _)| *name == plate.name));
    if let (Some(distance), Some(plate)) = (wanted.distance, disc.or(largest)) {
        let direction = wanted.direction.unwrap_or(plate.normal);
        let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        let at = [0, 1, 2].map(|k| plate.middle[k] + distance * direction[k] / length);
        microphones.push((ON_AXIS.to_string(), at));
    }
    microphones.extend(wanted.microphone.iter().map(|(name, m)| (name.clone(), m.at)));
    for (name, at) in &microphones {
        let place = match name.as_str() {
            ON_AXIS => "`transient.sound.distance`".to_string(),
            _ => format!("`transient.sound.microphone.{name}.at`"),
        };
        if let Some(plate) = plates.iter().find(|plate| plate.touches(*at)) {
            let found = format!("a place on `{}`", plate.name);
            faults.push(Fault::new(&place, found, "a place farther from it than its elements are wide"));
        } else if !plates.is_empty() && plates.iter().all(|plate| plate.side(*at) == 0.0) {
            let help = "There the sound of a plate's front and that of its back cancel";
            faults.push(
                Fault::new(&place, "a place in the plane of the plates", "one before or behind them")
                    .with_help(help),
            );
        }
    }
    let air = Air { density: wanted.air.density, speed: wanted.air.speed };
    faults.into_result(Ears { plates, microphones, air })
}

impl Seen {
    /// A shell part; `None` when it is not flat.
    fn new(prepared: &Prepared<'_>, part: &ShellPart) -> Option<Seen> {
        let nodes = &prepared.model.nodes;
        // The vector area of each node: a third of its triangles; a quadrilateral is four of half weight.
        let mut areas = std::collections::BTreeMap::<usize, [f64; 3]>::new();
        let mut add = |corners: [usize; 3], weight: f64| {
            let side = |k: usize| [0, 1, 2].map(|c| nodes[corners[k]][c] - nodes[corners[0]][c]);
            let area = cross(side(1), side(2)).map(|a| 0.5 * weight * a / 3.0);
            for node in corners {
                let sum = areas.entry(node).or_default();
                (0..3).for_each(|c| sum[c] += area[c]);
            }
        };
        for face in &part.faces {
            match *face.nodes() {
                [a, b, c] => add([a, b, c], 1.0),
                [a, b, c, d] => {
                    [[a, b, c], [a, c, d], [a, b, d], [b, c, d]].into_iter().for_each(|t| add(t, 0.5));
                }
                _ => {}
            }
        }
        let whole = areas.values().fold([0.0; 3], |sum, a| [0, 1, 2].map(|c| sum[c] + a[c]));
        let area = dot(whole, whole).sqrt();
        let mut normal = whole.map(|a| a / area);
        // The front is where the largest component of the normal is positive.
        let widest = (0..3).max_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs())).unwrap_or(0);
        let turn = normal[widest].signum();
        normal = normal.map(|n| turn * n);
        let share = |a: [f64; 3]| turn * dot(a, normal);
        let mut middle = [0.0; 3];
        for (node, a) in &areas {
            (0..3).for_each(|c| middle[c] += share(*a) * nodes[*node][c] / area);
        }
        let from_middle = |node: usize| [0, 1, 2].map(|c| nodes[node][c] - middle[c]);
        let extent = areas.keys().map(|n| dot(from_middle(*n), from_middle(*n)).sqrt()).fold(0.0, f64::max);
        let flat = areas.keys().all(|n| dot(from_middle(*n), normal).abs() <= FLAT * extent);
        let form = |(node, a): (&usize, &[f64; 3])| {
            let entries: Vec<_> = (0..3).map(|c| (*node, c, turn * a[c])).collect();
            prepared.assembled.dofs.reduce(&entries)
        };
        (flat && area > 0.0).then(|| Seen {
            name: part.name.clone(),
            normal,
            middle,
            area,
            largest: areas.values().map(|a| share(*a)).fold(0.0, f64::max),
            points: areas.keys().map(|n| nodes[*n]).collect(),
            forms: areas.iter().map(form).collect(),
        })
    }

    /// Whether a place is nearer than a piston is wide.
    fn touches(&self, at: [f64; 3]) -> bool {
        let square = |x: &[f64; 3]| (0..3).map(|c| (x[c] - at[c]).powi(2)).sum::<f64>();
        self.points.iter().any(|x| square(x) < self.largest)
    }

    fn side(&self, at: [f64; 3]) -> f64 {
        self.moving(&Mat::zeros(0, 0)).side(at)
    }

    /// The plate in its modes.
    fn moving(&self, shapes: &Mat<f64>) -> Plate {
        let modes = shapes.ncols();
        let strength = Mat::from_fn(if modes > 0 { self.forms.len() } else { 0 }, modes, |i, m| {
            self.forms[i].dot(shapes.col_as_slice(m))
        });
        Plate {
            name: self.name.clone(),
            normal: self.normal,
            middle: self.middle,
            points: self.points.clone(),
            strength,
        }
    }
}

/// Listens to a run: modal accelerations in, step by step, levels and a recording out; its memory does not grow with the
/// run.
pub struct Listener {
    /// M Φ of a full model; the first coordinates of a reduced one are those of the modes.
    weights: Option<Mat<f64>>,
    /// Accelerations of a full model that wait to be projected.
    batch: Mat<f64>,
    waiting: usize,
    /// Modal accelerations, one list a mode.
    block: Vec<Vec<f64>>,
    plates: Vec<Plate>,
    air: Air,
    step: f64,
    /// Steps worked on, the first that counts for the levels, and the highest frequency that does \[Hz\].
    heard: usize,
    counted: usize,
    top: f64,
    cross: CrossSpectra,
    microphones: Vec<(String, [f64; 3], Receiver, Welch)>,
    resampler: Resampler,
    recording: Vec<f64>,
    dropped: usize,
}

impl Listener {
    /// For a run of `steps` steps of `step` seconds of a model whose real modes are `real`: the full one with the mass
    /// matrix `mass`, or a reduced one whose first coordinates are theirs. Levels are taken over its second half.
    pub fn new(ears: Ears, real: &RealModes, mass: Option<&SparseMatrix>, step: f64, steps: usize) -> Self {
        let modes = real.len();
        let plates: Vec<Plate> = ears.plates.iter().map(|plate| plate.moving(&real.shapes)).collect();
        let counted = steps / 2;
        // Modes are complete up to their highest; a time step carries what it samples well.
        let highest = (0..modes).map(|k| real.frequency_hz(k)).fold(0.0, f64::max);
        let top = AUDIBLE.min(0.4 / step).min(highest.max(RESOLUTION));
        let most = (MEMORY / (4 * modes * (modes + 1)).max(1) as f64).max(16.0);
        let seconds = (1.0 / RESOLUTION).min(0.5 * (steps + 1 - counted) as f64 * step).min(most / top);
        let length = (seconds / step) as usize;
        let microphone = |(name, at): (String, [f64; 3])| {
            let receiver = Receiver::new(&plates, at, ears.air, step);
            (name, at, receiver, Welch::new(length, step))
        };
        let microphones: Vec<_> = ears.microphones.into_iter().map(microphone).collect();
        let mut resampler = Resampler::new(step, f64::from(RATE));
        let mut recording = Vec::new();
        if let Some((_, _, receiver, _)) = microphones.first() {
            resampler.take(&vec![0.0; receiver.delay()], &mut recording);
        }
        Listener {
            weights: mass.map(|mass| times(mass, real.shapes.as_ref())),
            batch: Mat::zeros(mass.map_or(0, |mass| mass.nrows()), BATCH),
            waiting: 0,
            block: vec![Vec::with_capacity(BLOCK); modes],
            cross: CrossSpectra::new(modes, length, step, top),
            plates,
            air: ears.air,
            step,
            heard: 0,
            counted,
            top,
            microphones,
            resampler,
            recording,
            dropped: 0,
        }
    }

    /// The acceleration of the degrees of freedom after the next step \[m/s², rad/s²\]; the start comes first.
    pub fn take(&mut self, acceleration: &[f64]) {
        if self.weights.is_none() {
            self.block.iter_mut().zip(acceleration).for_each(|(mode, a)| mode.push(*a));
            self.hear_full_blocks();
            return;
        }
        self.batch.col_as_slice_mut(self.waiting).copy_from_slice(acceleration);
        self.waiting += 1;
        if self.waiting == BATCH {
            self.project();
        }
    }

    /// ΦᵀM a of the accelerations that wait.
    fn project(&mut self) {
        let Some(weights) = &self.weights else { return };
        let modal = gram(weights.as_ref(), MatRef::subcols(self.batch.as_ref(), 0, self.waiting));
        for j in 0..self.waiting {
            self.block.iter_mut().zip(modal.col_as_slice(j)).for_each(|(mode, a)| mode.push(*a));
        }
        self.waiting = 0;
        self.hear_full_blocks();
    }

    fn hear_full_blocks(&mut self) {
        if self.block.first().is_some_and(|mode| mode.len() >= BLOCK) {
            self.hear();
        }
    }

    /// Works on the block.
    fn hear(&mut self) {
        let length = self.block.first().map_or(0, Vec::len);
        let early = self.counted.saturating_sub(self.heard).min(length);
        for (k, (_, _, receiver, welch)) in self.microphones.iter_mut().enumerate() {
            let pressure = receiver.hear(&self.block);
            welch.take(&pressure[early..]);
            if k == 0 {
                self.resampler.take(&pressure, &mut self.recording);
            }
        }
        self.forget();
        self.block.iter_mut().for_each(|mode| drop(mode.drain(..early)));
        self.cross.take(&self.block);
        self.block.iter_mut().for_each(Vec::clear);
        self.heard += length;
    }

    /// Keeps the end of the recording.
    fn forget(&mut self) {
        let kept = KEPT * RATE as usize;
        if self.recording.len() > 2 * kept {
            let dropped = self.recording.len() - kept;
            self.recording.drain(..dropped);
            self.dropped += dropped;
        }
    }

    /// What was heard.
    pub fn finish(mut self) -> Sound {
        self.project();
        self.hear();
        let Listener { cross, air, plates, step, .. } = &self;
        let (lines, resolution_hz) = (cross.lines(), cross.resolution_hz());
        let mut mode_shares = vec![0.0; self.block.len()];
        let mut power = vec![vec![0.0; lines]; plates.len()];
        let wavenumber = |hz: f64| TAU * hz / air.speed;
        for (plate, power) in plates.iter().zip(&mut power) {
            let radiation = Radiation::new(plate, wavenumber(self.top));
            // Line 0 holds what is left of the mean.
            for (k, power) in power.iter_mut().enumerate().skip(1) {
                let own = radiation.power(*air, wavenumber(k as f64 * resolution_hz), &cross.products(k));
                *power = own.iter().sum();
                mode_shares.iter_mut().zip(own).for_each(|(share, own)| *share += own);
            }
        }
        let whole: f64 = power.iter().flatten().sum();
        mode_shares.iter_mut().for_each(|share| *share /= whole.max(f64::MIN_POSITIVE));
        let each: Vec<f64> = (0..lines).map(|k| power.iter().map(|p| p[k]).sum()).collect();
        let window = [self.counted as f64 * step, self.heard.saturating_sub(1) as f64 * step];
        let names = plates.iter().map(|plate| plate.name.clone());
        let plates = names.zip(power).collect();
        let microphones = self.microphones.into_iter().map(|(name, at, _, welch)| {
            let mut spectrum = welch.finish();
            spectrum.amplitude.truncate(lines);
            spectrum.amplitude.iter_mut().take(1).for_each(|a| *a = 0.0);
            Heard { name, at, spectrum }
        });
        let microphones = microphones.collect();
        self.resampler.finish(&mut self.recording);
        let excess = self.recording.len().saturating_sub(KEPT * RATE as usize);
        self.recording.drain(..excess);
        let begin = (self.dropped + excess) as f64 / f64::from(RATE);
        Sound {
            window,
            air: self.air,
            resolution_hz,
            plates,
            mode_shares,
            tones: tones(&each, resolution_hz),
            microphones,
            recording: Recording { begin, rate: RATE, pressure: self.recording },
        }
    }
}

/// The peaks of a power.
fn tones(power: &[f64], resolution_hz: f64) -> Vec<Tone> {
    let amplitude = power.iter().map(|w| w.max(0.0).sqrt()).collect();
    let spectrum = Spectrum { resolution_hz, amplitude };
    let mut found = peaks(&spectrum, FLOOR, TONES);
    name_peaks(&mut found, 0.5 * resolution_hz);
    let whole: f64 = power.iter().sum();
    let tone = |peak: crate::signal::Peak| {
        let line = (peak.frequency_hz / resolution_hz).round() as usize;
        let about = line.saturating_sub(SKIRT)..(line + SKIRT + 1).min(power.len());
        let power = power[about].iter().sum::<f64>();
        Tone { peak, power, share: power / whole }
    };
    found.into_iter().map(tone).collect()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::modal::{ModesWanted, compute};
    use crate::sound::{power_level, pressure_level};

    const CASE: &str = r#"
[mesh.annulus]
outer_radius = "75 mm"
hub_radius = "15 mm"
radial = 8
around = 48
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"
[shell.disc]
material = "steel"
thickness = "1 mm"
bending_only = true
[support.hub]
on = "hub"
"#;

    fn wanted(distance: Option<f64>, at: &[(&str, [f64; 3])]) -> SoundAnalysis {
        let place = |(name, at): &(&str, [f64; 3])| (name.to_string(), crate::case::Microphone { at: *at });
        SoundAnalysis {
            distance,
            direction: None,
            plates: Vec::new(),
            air: Default::default(),
            microphone: at.iter().map(place).collect(),
        }
    }

    #[test]
    fn one_mode_sounds_as_loud_as_its_closed_form_and_both_kinds_of_model_agree() {
        let case = Case::parse("disc", CASE, ".".into()).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        let structure = &prepared.system.structure;
        let (real, _) = compute(structure, ModesWanted::Count(3), &()).unwrap();
        // The mode without nodal diameters: the one that displaces the most volume.
        let ears = ears(&prepared, &wanted(Some(0.5), &[("far", [-4.0, 0.3, 0.0])])).unwrap();
        let plate = ears.plates[0].moving(&real.shapes);
        let volume = |m: usize| plate.strength.col_as_slice(m).iter().sum::<f64>();
        let mode = (0..3).max_by(|a, b| volume(*a).abs().total_cmp(&volume(*b).abs())).unwrap();
        let (step, steps, hz) = (2e-5, 20_000, 180.0);
        let q = |k: usize| 3.0 * (TAU * hz * step * k as f64).sin();
        let mut reduced = Listener::new(ears.clone(), &real, None, step, steps);
        let mut full = Listener::new(ears, &real, Some(&structure.mass), step, steps);
        for k in 0..=steps {
            let modal: Vec<f64> = (0..5).map(|m| if m == mode { q(k) } else { 0.0 }).collect();
            reduced.take(&modal);
            if k <= 3000 {
                let shape = real.shapes.col_as_slice(mode);
                full.take(&shape.iter().map(|x| q(k) * x).collect::<Vec<f64>>());
            }
        }
        let full = full.finish();
        let sound = reduced.finish();
        let off = |k: usize| (full.recording.pressure[k] - sound.recording.pressure[k]).abs();
        let loudest = 1.0 / sound.recording.full_scale();
        assert!((200..2700).all(|k| off(k) * loudest < 1e-9));
        // Small beside the wavelength of 1.9 m: a monopole in a baffle, whichever its shape.
        let (air, volume) = (Air::default(), 3.0 * volume(mode).abs());
        let watt = air.density * volume * volume / (2.0 * std::f64::consts::PI * air.speed);
        let [level, weighted] = sound.power_levels();
        assert!((level - power_level(watt)).abs() < 0.1, "{level} {}", power_level(watt));
        assert!((weighted - level - 20.0 * crate::sound::a_weighting(hz).log10()).abs() < 0.05);
        for heard in &sound.microphones {
            let r = heard.at.iter().map(|c| c * c).sum::<f64>().sqrt();
            let amplitude = air.density * volume / (TAU * r);
            let exact = pressure_level(0.5 * amplitude * amplitude);
            assert!((heard.levels()[0] - exact).abs() < 0.1, "{} {exact}", heard.levels()[0]);
        }
        assert!((sound.mode_shares[mode] - 1.0).abs() < 1e-9);
        assert_eq!(sound.tones.len(), 1);
        assert!((sound.tones[0].peak.frequency_hz - hz).abs() < 0.1 && sound.tones[0].share > 0.99);
        let far = &sound.microphones[1];
        assert!(far.name == "far" && sound.recording.pressure.len().abs_diff(19_200 + 70) < 5);
    }

    #[test]
    fn places_where_nothing_can_be_said_are_refused() {
        let case = Case::parse("disc", CASE, ".".into()).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        let faults = |at: [f64; 3]| ears(&prepared, &wanted(None, &[("here", at)])).unwrap_err().to_string();
        assert!(faults([0.001, 0.05, 0.0]).contains("a place on `disc`"));
        assert!(faults([0.0, 0.5, 0.2]).contains("in the plane of the plates"));
        let ears = ears(&prepared, &wanted(Some(1.0), &[])).unwrap();
        let [(name, at)] = &ears.microphones[..] else { panic!("one microphone") };
        assert!(name == ON_AXIS && (at[0] - 1.0).abs() < 1e-12 && at[1].abs() < 1e-12 && at[2].abs() < 1e-12);
    }
}
