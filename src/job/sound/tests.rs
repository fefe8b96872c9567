use super::acoustics::acoustics;
use crate::bounds::{Origin::*, within};
use crate::case::Case;
use crate::case::{ON_AXIS, SoundAnalysis};
use crate::job::Prepared;
use crate::job::samples::disc;
use crate::modal::{ModesWanted, compute};
use crate::sound::{Air, BLOCK, SoundAccumulator, power_level, pressure_level};
use std::f64::consts::TAU;

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
fn one_mode_sounds_as_loud_as_its_closed_form() {
    let case = Case::parse("disc", &disc(8, 48), ".".into()).unwrap();
    let prepared = Prepared::new(&case).unwrap();
    let structure = &prepared.system.structure;
    let (real, _) = compute(structure, ModesWanted::Count(3), &()).unwrap();
    // The mode without nodal diameters: the one that displaces the most volume.
    let acoustics = acoustics(&prepared, &wanted(Some(0.5), &[("far", [-4.0, 0.3, 0.0])])).unwrap();
    let plate = acoustics.plates[0].moving(&real.shapes);
    let volume = |m: usize| plate.strength.col_as_slice(m).iter().sum::<f64>();
    let mode = (0..3).max_by(|a, b| volume(*a).abs().total_cmp(&volume(*b).abs())).unwrap();
    let (step, steps, hz) = (2e-5, 20_000, 180.0);
    let q = |k: usize| 3.0 * (TAU * hz * step * k as f64).sin();
    let mut accumulator =
        SoundAccumulator::new(acoustics, (&real.shapes, real.frequency_hz(2)), (step, steps));
    for first in (0..=steps).step_by(BLOCK) {
        let moments = first..(first + BLOCK).min(steps + 1);
        let motion = |m: usize| moments.clone().map(|k| if m == mode { q(k) } else { 0.0 }).collect();
        accumulator.add((0..3).map(motion).collect());
    }
    let sound = accumulator.finish();
    // Small beside the wavelength of 1.9 m: a monopole in a baffle, whichever its shape.
    let (air, volume) = (Air::default(), 3.0 * volume(mode).abs());
    let watt = air.density * volume * volume / (2.0 * std::f64::consts::PI * air.speed);
    let [level, weighted] = sound.power_levels();
    assert!(within((level - power_level(watt)).abs(), 0.1, Theory), "{level} {}", power_level(watt));
    assert!(within(
        (weighted - level - 20.0 * crate::sound::a_weighting(hz).log10()).abs(),
        0.05,
        Discretisation
    ));
    for microphone in &sound.microphones {
        let r = microphone.at.iter().map(|c| c * c).sum::<f64>().sqrt();
        let amplitude = air.density * volume / (TAU * r);
        let exact = pressure_level(0.5 * amplitude * amplitude);
        assert!(
            within((microphone.levels()[0] - exact).abs(), 0.1, Theory),
            "{} {exact}",
            microphone.levels()[0]
        );
    }
    assert!(within((sound.mode_shares[mode] - 1.0).abs(), 1e-9, RoundOff));
    assert_eq!(sound.tones.len(), 1);
    assert!(
        within((sound.tones[0].peak.frequency_hz - hz).abs(), 0.1, Discretisation)
            && sound.tones[0].share > 0.99
    );
    let far = &sound.microphones[1];
    // 4 m take 11.7 ms, 0.5 m take 1.5 ms; both are silent until then.
    assert!(far.name == "far");
    for (microphone, samples) in sound.microphones.iter().zip([70, 560]) {
        let pressure = &microphone.recording.pressure;
        assert!(pressure.len().abs_diff(19_200 + samples) < 5, "{}", pressure.len());
        assert!(
            pressure[..samples - 40].iter().all(|p| within(p.abs(), 1e-12, RoundOff))
                && pressure.iter().any(|p| p.abs() > 1e-6)
        );
    }
}

#[test]
fn places_where_nothing_can_be_said_are_refused() {
    let case = Case::parse("disc", &disc(8, 48), ".".into()).unwrap();
    let prepared = Prepared::new(&case).unwrap();
    let faults = |at: [f64; 3]| acoustics(&prepared, &wanted(None, &[("here", at)])).unwrap_err().to_string();
    assert!(faults([0.001, 0.05, 0.0]).contains("a place on `disc`"));
    assert!(faults([0.0, 0.5, 0.2]).contains("in the plane of the plates"));
    let acoustics = acoustics(&prepared, &wanted(Some(1.0), &[])).unwrap();
    let [(name, at)] = &acoustics.microphones[..] else { panic!("one microphone") };
    assert!(
        name == ON_AXIS
            && within((at[0] - 1.0).abs(), 1e-12, RoundOff)
            && within(at[1].abs(), 1e-12, RoundOff)
            && within(at[2].abs(), 1e-12, RoundOff)
    );
}

/// Half of a record sounds, the rest is silent: wherever that half is, its level is that of the tone, by the closed form.
#[test]
fn levels_are_those_of_the_loud_half() {
    let case = Case::parse("disc", &disc(4, 24), ".".into()).unwrap();
    let prepared = Prepared::new(&case).unwrap();
    let (real, _) = compute(&prepared.system.structure, ModesWanted::Count(3), &()).unwrap();
    let (step, steps, hz) = (2e-5, 20_000, 180.0);
    let (mut levels, mut windows) = (Vec::new(), Vec::new());
    for begin in [0, 2_500, 5_000, 7_777, 10_000] {
        let acoustics = acoustics(&prepared, &wanted(None, &[])).unwrap();
        let plate = acoustics.plates[0].moving(&real.shapes);
        let volume = |m: usize| plate.strength.col_as_slice(m).iter().sum::<f64>();
        let mode = (0..3).max_by(|a, b| volume(*a).abs().total_cmp(&volume(*b).abs())).unwrap();
        let sounds = |k: usize| k >= begin && k <= begin + steps / 2;
        let q = |k: usize| if sounds(k) { 3.0 * (TAU * hz * step * k as f64).sin() } else { 0.0 };
        let block = |moments: std::ops::Range<usize>| -> Vec<Vec<f64>> {
            let motion = |m: usize| moments.clone().map(|k| if m == mode { q(k) } else { 0.0 }).collect();
            (0..3).map(motion).collect()
        };
        let mut accumulator =
            SoundAccumulator::new(acoustics, (&real.shapes, real.frequency_hz(2)), (step, steps));
        let blocks = || (0..=steps).step_by(BLOCK).map(|first| first..(first + BLOCK).min(steps + 1));
        let mut loud = accumulator.loud_half();
        blocks().for_each(|moments| loud.add(&block(moments)));
        accumulator.count_from(loud.begin());
        blocks().for_each(|moments| accumulator.add(block(moments)));
        let sound = accumulator.finish();
        let volume = 3.0 * volume(mode).abs();
        let air = Air::default();
        let watt = air.density * volume * volume / (2.0 * std::f64::consts::PI * air.speed);
        levels.push(sound.power_levels()[0] - power_level(watt));
        windows.push(sound.window[0] - begin as f64 * step);
    }
    // A burst that begins inside of a segment spreads its lines.
    assert!(
        levels.iter().all(|difference| within(difference.abs(), 0.3, Discretisation)),
        "{levels:?} {windows:?}"
    );
    assert!(
        windows.iter().all(|late| within(late.abs(), 0.05 * step * steps as f64, Discretisation)),
        "{levels:?} {windows:?}"
    );
}
