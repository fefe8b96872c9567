//! Sound of a run, computed while the run proceeds.

use super::{
    Air, CrossSpectra, LoudHalf, MicrophoneSound, Plate, PressureRecord, Radiation, Receiver, Sound, Surface,
    Tone,
};
use faer::Mat;
use std::f64::consts::TAU;
use std::ops::Range;
use stridor_signal::{Resampler, Spectrum, Welch, peaks};

/// Highest audible frequency \[Hz\].
const AUDIBLE: f64 = 20_000.0;
/// Lines of the spectra are this far apart, if the run is long enough and they fit in memory \[Hz, bytes\].
const RESOLUTION: f64 = 10.0;
const MEMORY: f64 = 64e6;
/// Accelerations of all modes that wait for their spectra, at most.
const PENDING: f64 = 64e6;
/// Steps of silence that are resampled at once.
const SILENCE: usize = 1 << 16;
/// Tones named, and how far below the highest they may be.
const TONES: usize = 8;
const FLOOR: f64 = 1e-2;
/// Lines on either side of a peak that belong to it.
const SKIRT: usize = 2;
/// Samples a second of the recording, and how many of its last seconds are kept.
const RATE: u32 = 48_000;
const KEPT: usize = 60;
/// Steps that are best worked on together.
pub const BLOCK: usize = 1024;

/// Radiating plates, microphones and air of a case.
#[derive(Debug, Clone)]
pub struct Acoustics {
    /// The plates.
    pub plates: Vec<Surface>,
    /// Names and places of the microphones \[m\].
    pub microphones: Vec<(String, [f64; 3])>,
    /// Properties of the air.
    pub air: Air,
}

/// Sound of a run: takes modal accelerations block by block and returns levels and a recording; its memory does not grow with
/// the run.
pub struct SoundAccumulator {
    modes: usize,
    plates: Vec<Plate>,
    air: Air,
    step: f64,
    /// Steps of the run, those worked on, those that count for the levels, and the highest frequency that does \[Hz\].
    steps: usize,
    taken: usize,
    counted: Range<usize>,
    top: f64,
    cross: CrossSpectra,
    microphones: Vec<Microphone>,
}

/// A microphone at work.
struct Microphone {
    name: String,
    at: [f64; 3],
    receiver: Receiver,
    welch: Welch,
    resampler: Resampler,
    recording: Vec<f64>,
    /// Samples that lie before the recording.
    dropped: usize,
}

impl Microphone {
    /// With spectra of `length` samples, one every `step` seconds; silent until the first sound arrives.
    fn new((name, at): (String, [f64; 3]), receiver: Receiver, (length, step): (usize, f64)) -> Self {
        let mut resampler = Resampler::new(step, f64::from(RATE));
        let mut recording = Vec::new();
        let silence = receiver.delay();
        for first in (0..silence).step_by(SILENCE) {
            resampler.take(&vec![0.0; SILENCE.min(silence - first)], &mut recording);
        }
        Microphone { name, at, receiver, welch: Welch::new(length, step), resampler, recording, dropped: 0 }
    }

    /// The next accelerations of the modes, of which those `inside` count for the levels.
    fn add(&mut self, block: &[Vec<f64>], inside: Range<usize>) {
        let pressure = self.receiver.receive(block);
        self.welch.take(&pressure[inside]);
        self.resampler.take(&pressure, &mut self.recording);
        if self.recording.len() > 2 * KEPT * RATE as usize {
            self.forget();
        }
    }

    /// Keeps the end of the recording.
    fn forget(&mut self) {
        let excess = self.recording.len().saturating_sub(KEPT * RATE as usize);
        self.recording.drain(..excess);
        self.dropped += excess;
    }

    /// Levels of so many lines, and the recording.
    fn finish(mut self, lines: usize) -> MicrophoneSound {
        self.resampler.finish(&mut self.recording);
        self.forget();
        let mut spectrum = self.welch.finish();
        spectrum.amplitude.truncate(lines);
        spectrum.amplitude.iter_mut().take(1).for_each(|a| *a = 0.0);
        let begin = self.dropped as f64 / f64::from(RATE);
        let recording = PressureRecord { begin, rate: RATE, pressure: self.recording };
        MicrophoneSound { name: self.name, at: self.at, spectrum, recording }
    }
}

impl SoundAccumulator {
    /// For a run of `steps` steps of `step` seconds of a model whose real modes have `shapes`, n_dofs × n_modes, and are
    /// complete up to `highest` \[Hz\]. Levels are taken over its second half, if no other is named.
    pub fn new(
        acoustics: Acoustics,
        (shapes, highest): (&Mat<f64>, f64),
        (step, steps): (f64, usize),
    ) -> Self {
        let modes = shapes.ncols();
        let plates: Vec<Plate> = acoustics.plates.iter().map(|plate| plate.moving(shapes)).collect();
        let counted = steps / 2..steps + 1;
        // A time step carries what it samples well.
        let top = AUDIBLE.min(0.4 / step).min(highest.max(RESOLUTION));
        let most = (MEMORY / (4 * modes * (modes + 1)).max(1) as f64).max(16.0);
        let seconds = (1.0 / RESOLUTION).min(0.5 * counted.len() as f64 * step).min(most / top);
        let pending = (PENDING / modes.max(1) as f64).max(16.0);
        let length = (seconds / step).min(pending) as usize;
        let microphone = |(name, at): (String, [f64; 3])| {
            let receiver = Receiver::new(&plates, at, acoustics.air, step);
            Microphone::new((name, at), receiver, (length, step))
        };
        let microphones: Vec<_> = acoustics.microphones.into_iter().map(microphone).collect();
        SoundAccumulator {
            modes,
            cross: CrossSpectra::new(modes, length, step, top),
            plates,
            air: acoustics.air,
            step,
            steps,
            taken: 0,
            counted,
            top,
            microphones,
        }
    }

    /// What finds the half of the run that is loud.
    pub fn loud_half(&self) -> LoudHalf {
        LoudHalf::new(&self.plates, self.modes, self.steps + 1)
    }

    /// Levels are taken over the half of the run that begins with this row.
    pub fn count_from(&mut self, row: usize) {
        let length = self.counted.len();
        self.counted = row..row + length;
    }

    /// The next accelerations of the modes, one list each, all of one length; the start comes first.
    pub fn add(&mut self, mut block: Vec<Vec<f64>>) {
        let length = block.first().map_or(0, Vec::len);
        let inside =
            [self.counted.start, self.counted.end].map(|row| row.saturating_sub(self.taken).min(length));
        let inside = inside[0]..inside[1];
        self.microphones.iter_mut().for_each(|microphone| microphone.add(&block, inside.clone()));
        block.iter_mut().for_each(|mode| {
            mode.truncate(inside.end);
            drop(mode.drain(..inside.start));
        });
        self.cross.take(&block);
        self.taken += length;
    }

    /// Sound of the whole run.
    pub fn finish(self) -> Sound {
        let SoundAccumulator { cross, air, plates, step, .. } = &self;
        let (lines, resolution_hz) = (cross.lines(), cross.resolution_hz());
        let mut mode_shares = vec![0.0; self.modes];
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
        let last = self.taken.min(self.counted.end).saturating_sub(1);
        let window = [self.counted.start as f64 * step, last as f64 * step];
        let names = plates.iter().map(|plate| plate.name.clone());
        let plates = names.zip(power).collect();
        let microphones = self.microphones.into_iter().map(|microphone| microphone.finish(lines)).collect();
        Sound {
            window,
            air: self.air,
            resolution_hz,
            plates,
            mode_shares,
            mode_names: Vec::new(),
            tones: tones(&each, resolution_hz),
            microphones,
        }
    }
}

/// The peaks of a power.
fn tones(power: &[f64], resolution_hz: f64) -> Vec<Tone> {
    let amplitude = power.iter().map(|w| w.max(0.0).sqrt()).collect();
    let spectrum = Spectrum { resolution_hz, amplitude };
    let found = peaks(&spectrum, FLOOR, TONES);
    let whole: f64 = power.iter().sum();
    let tone = |peak: stridor_signal::Peak| {
        let line = (peak.frequency_hz / resolution_hz).round() as usize;
        let about = line.saturating_sub(SKIRT)..(line + SKIRT + 1).min(power.len());
        let power = power[about].iter().sum::<f64>();
        Tone { peak, power, share: power / whole }
    };
    found.into_iter().map(tone).collect()
}
