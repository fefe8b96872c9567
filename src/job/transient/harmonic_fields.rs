//! The motion of all nodes over the last periods of a run, as a Fourier series.

use super::snapshots::Snapshots;
use crate::error::Result;
use crate::linalg::c64;
use crate::results::CycleFields;
use crate::transient::{Checkpoint, Marched};
use std::f64::consts::TAU;

/// The last part of a run, as its limit cycles are measured in, is where the periods lie.
const PART: usize = 4;
/// Periods, at least and at most. A harmonic is then at least four lines of a Hann window away from its neighbours and the mean.
const PERIODS: [usize; 2] = [4, 16];
/// Harmonics, at most, and the highest that a time step samples well, as a part of 1/Δt.
const HARMONICS: usize = 6;
const SAMPLED: f64 = 0.4;
/// Names in a checkpoint.
const CYCLE: &str = "cycle";
const SUMS: &str = "cycle_sums";

/// Running sums of the Fourier series, in the coordinates of the model: 2H vectors, however long the run is.
pub(super) struct HarmonicFields<'a> {
    /// The way from the coordinates to the nodes.
    pub(super) nodes: Snapshots<'a>,
    /// Δt \[s\] and the number of steps.
    pub(super) step: f64,
    pub(super) steps: usize,
    running: Option<Running>,
    moved: Vec<f64>,
}

/// Sums of f₀ over the steps after `begin`.
struct Running {
    hz: f64,
    begin: usize,
    /// Σ w (u − u₀) cos hωt and −Σ w (u − u₀) sin hωt, h = 1, 2 …
    sums: Vec<[Vec<f64>; 2]>,
}

impl<'a> HarmonicFields<'a> {
    pub(super) fn new(nodes: Snapshots<'a>, step: f64, steps: usize) -> Self {
        HarmonicFields { nodes, step, steps, running: None, moved: Vec::new() }
    }

    /// The step after which f₀ is known and the sums may begin.
    pub(super) fn ready(&self) -> usize {
        self.steps - self.steps / PART
    }

    /// Whether it has begun.
    pub(super) fn has_begun(&self) -> bool {
        self.running.is_some()
    }

    /// Begins the series of f₀; there is none where fewer than four periods are left.
    pub(super) fn begin(&mut self, hz: f64) {
        let left = ((self.steps - self.ready()) as f64 * self.step * hz) as usize;
        let count = HARMONICS.min((SAMPLED / (self.step * hz)) as usize);
        if left < PERIODS[0] || count == 0 {
            return;
        }
        let length = (left.min(PERIODS[1]) as f64 / (hz * self.step)).round() as usize;
        let zero = || vec![0.0; self.nodes.origin.len()];
        let sums = (0..count).map(|_| [zero(), zero()]).collect();
        self.running = Some(Running { hz, begin: self.steps - length, sums });
    }

    /// Adds a step.
    pub(super) fn take(&mut self, marched: &Marched) {
        let Some(Running { hz, begin, sums }) = self.running.as_mut().filter(|r| marched.step > r.begin)
        else {
            return;
        };
        let place = (marched.step - *begin) as f64 - 0.5;
        let weight = 0.5 - 0.5 * (TAU * place / (self.steps - *begin) as f64).cos();
        let displacement = marched.state.motion.col_as_slice(0);
        self.moved.clear();
        self.moved.extend(displacement.iter().zip(self.nodes.origin).map(|(u, origin)| u - origin));
        for (h, sums) in (1..).zip(sums) {
            let angle = TAU * f64::from(h) * *hz * marched.step as f64 * self.step;
            for (sum, factor) in sums.iter_mut().zip([weight * angle.cos(), -weight * angle.sin()]) {
                sum.iter_mut().zip(&self.moved).for_each(|(s, u)| *s += factor * u);
            }
        }
    }

    /// Adds what the steps to come depend on.
    pub(super) fn put(&self, checkpoint: &mut Checkpoint) {
        if let Some(Running { hz, begin, sums }) = &self.running {
            checkpoint.put(CYCLE, &[*hz, *begin as f64]);
            checkpoint.put(SUMS, &sums.iter().flatten().flatten().copied().collect::<Vec<f64>>());
        }
    }

    /// Goes on from what was put away, if it had begun.
    /// Refuses a checkpoint of another model.
    pub(super) fn restore(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        if !checkpoint.arrays.contains_key(CYCLE) {
            return Ok(());
        }
        let [hz, _] = checkpoint.numbers::<2>(CYCLE)?;
        self.begin(hz);
        let Some(running) = &mut self.running else { return Ok(()) };
        let own: Vec<&mut Vec<f64>> = running.sums.iter_mut().flatten().collect();
        let mut values = vec![0.0; own.len() * self.nodes.origin.len()];
        checkpoint.get(SUMS, &mut values)?;
        let parts = values.chunks_exact(self.nodes.origin.len().max(1));
        own.into_iter().zip(parts).for_each(|(sum, part)| sum.copy_from_slice(part));
        Ok(())
    }

    /// The series; `None` where it was not begun.
    pub(super) fn finish(self) -> Option<CycleFields> {
        let Running { hz, begin, sums } = self.running?;
        // The weights add up to half their number.
        let scale = 4.0 / (self.steps - begin) as f64;
        let field = |[cosine, sine]: &[Vec<f64>; 2]| {
            let [re, im] = [cosine, sine].map(|x| self.nodes.of_all(x));
            let node = |k: usize| [0, 1, 2].map(|axis| scale * c64::new(re[k][axis], im[k][axis]));
            (0..re.len()).map(node).collect()
        };
        Some(CycleFields {
            frequency_hz: hz,
            window: [begin + 1, self.steps].map(|step| step as f64 * self.step),
            harmonics: sums.iter().map(field).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::bounds::{Origin::*, within};
    use crate::case::Case;
    use crate::job::{Prepared, Selection, analyse};
    use crate::linalg::c64;
    use crate::results::TransientResult;
    use std::f64::consts::TAU;

    /// A mass of 1 kg on a spring, 100 Hz, that starts 1 µm out of its rest; the contact is a hair.
    const OSCILLATOR: &str = r#"
title = "An oscillator"
assumptions = ["Everything here is made up."]

[point]
block = [0, 0, 0]

[mass.block]
on = "block"
mass = "1 kg"

[support.guide]
on = "block"
held = ["uy", "uz", "rx", "ry", "rz"]

[spring.axis]
on = "block"
direction = [1, 0, 0]
stiffness = "394784.176 N/m"

[contact.hair]
body = "block"
counter = "ground"
into = [1, 0, 0]
approach = "1 nm"
sliding_velocity = "1 m/s"
sliding_direction = [0, 1, 0]
normal = { per = "point", stiffness = "1e-9 N/m", unilateral = false }
friction = { law = "coulomb", mu0 = 0 }

[cea]
band = [0, "200 Hz"]

[transient]
duration = "0.4 s"
time_step = "20 us"
scheme = "newmark"
disturbance = { mode_near = "100 Hz", amplitude = "1 um" }
probe.block = { on = "block", direction = [1, 0, 0] }
"#;

    fn run(duration: &str) -> TransientResult {
        let text = OSCILLATOR.replace("0.4 s", duration);
        let case = Case::parse("case.toml", &text, ".".into()).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &())
            .unwrap()
            .take::<TransientResult>()
            .unwrap()
    }

    #[test]
    fn an_oscillation_is_its_first_harmonic_with_amplitude_and_phase() {
        let run = run("0.4 s");
        let cycle = run.cycle.as_ref().unwrap();
        assert!(
            within((cycle.frequency_hz - 100.0).abs(), 0.1, Discretisation) && cycle.harmonics.len() == 6,
            "{}",
            cycle.frequency_hz
        );
        // Nine or ten whole periods of the last quarter.
        assert!(
            (0.299..0.311).contains(&cycle.window[0])
                && within((cycle.window[1] - 0.4).abs(), 1e-12, RoundOff)
        );
        let [first, others @ ..] = &cycle.harmonics[..] else { panic!("no harmonic") };
        let u = first[0][0];
        assert!(within((u.norm() - 1e-6).abs(), 1e-9, Discretisation), "{u}");
        assert!(
            others.iter().all(|field| within(field[0][0].norm(), 1e-10, Discretisation))
                && first[0][1].norm() == 0.0
        );
        // At the end the block is where the record has it.
        let channel = run.channels.iter().find(|c| c.name == "block_displacement").unwrap();
        let series = (u * c64::from_polar(1.0, TAU * cycle.frequency_hz * cycle.window[1])).re;
        assert!(
            within((series - channel.last.unwrap()).abs(), 5e-9, Discretisation),
            "{series} {:?}",
            channel.last
        );
    }

    #[test]
    fn a_run_with_fewer_than_four_periods_at_its_end_has_none() {
        assert!(run("0.15 s").cycle.is_none());
    }
}
