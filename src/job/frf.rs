//! Frequency responses of a case.

use super::frf_reach::Pieces;
use super::frf_stability::unstable_modes;
use super::modes::{
    check_damping_frequencies, damping_of_response, identify, labels, response_needs, without_prestress,
};
use super::motion::{Motion, motion};
use super::prepared::Prepared;
use crate::case::{Case, FrfAnalysis, FrfContact, FrfSolution, UniversalForm};
use crate::dynamics::{DAMPERS, Harmonic, is_unbounded};
use crate::equilibrium::{SteadySliding, closed_structure};
use crate::error::{Error, Faults, Result};
use crate::linalg::{SparseMatrix, SparseVector, c64};
use crate::modal::{ModesWanted, RealModes, compute};
use crate::progress::Observer;
use crate::reduction::{DampingOfModes, MODES, Receptance, Reduced};
use crate::results::{ComplexResult, FrfResponse, FrfResult, PlaceAndDirection, Resonance};
use crate::system::System;
use rayon::prelude::*;
use std::cell::OnceCell;
use std::f64::consts::TAU;

/// Frequencies to begin with, evenly spaced on a logarithmic scale, and the most there are in the end.
const FIRST: usize = 128;
const MOST: usize = 4000;
/// An interval is halved where the response bends by more than this part of itself away from a straight line.
const BEND: f64 = 0.01;
/// Frequencies at which superposition and direct solution are compared.
const COMPARED: usize = 5;
/// At a resonance that nothing damps there is no line closer than this part of its frequency.
const BESIDE: f64 = 1e-5;
/// A resonance at which the response is this many times as large as at that distance is one that nothing damps: |H| ∝ 1/|δ + iζ|
/// for δ = f/f₀ − 1, so that ζ < 1e-7. Eigenfrequencies are accurate to less than 1e-7.
const UNBOUNDED: f64 = 100.0;
/// Resonances that a message names.
const NAMED: usize = 5;

/// A frequency response whose places are known.
pub struct PreparedFrf<'a> {
    name: &'a str,
    wanted: &'a FrfAnalysis,
    stressed: bool,
    symmetric: bool,
    force: Motion,
    seen: Vec<(String, Motion)>,
    beside: Vec<(usize, Vec<f64>)>,
}

/// The frequency responses of the case, checked before anything is computed or written.
///
/// # Errors
/// Every place that the mesh does not have.
pub fn frfs<'a>(prepared: &Prepared<'a>) -> Result<Vec<PreparedFrf<'a>>> {
    let mut faults = Faults::new();
    let mut all = Vec::new();
    // With the contacts closed, and open.
    let pieces = [const { OnceCell::new() }; 2];
    for (name, wanted) in &prepared.case.frf {
        let mut place = |of: &crate::case::MotionAt, key: String| {
            faults.take(motion(prepared, of.on.as_deref(), of.at, of.direction, &key))
        };
        let force = place(&wanted.excitation, format!("frf.{name}.excitation"));
        let mut seen: Vec<(String, Motion)> = Vec::new();
        for (own, of) in &wanted.response {
            let found = place(of, format!("frf.{name}.response.{own}"));
            seen.extend(found.map(|motion| (own.clone(), motion)));
        }
        let Some(force) = force else { continue };
        let open = wanted.contact == FrfContact::Open;
        for (own, motion) in &seen {
            let pieces = pieces[usize::from(open)].get_or_init(|| Pieces::new(&prepared.system, !open));
            let contacts = if open { prepared.system.pairs.len() } else { 0 };
            faults.take(pieces.check((&force, motion), &format!("frf.{name}.response.{own}"), contacts));
        }
        if wanted.response.is_empty() {
            seen.push(("drive_point".into(), force.clone()));
        }
        let stressed = prepared.case.stressed_by_forces();
        let symmetric = prepared.system.coupling.is_none();
        all.push(PreparedFrf { name, wanted, stressed, symmetric, force, seen, beside: Vec::new() });
    }
    faults.into_result(all)
}

impl PreparedFrf<'_> {
    /// Its name.
    pub fn name(&self) -> &str {
        self.name
    }

    /// Whether it is about steady sliding, or, without contacts, about what the forces of a case with `prestress` stress.
    pub fn slides(&self) -> bool {
        self.wanted.contact == FrfContact::Sliding || self.stressed
    }

    /// What to know before it is computed.
    pub fn warning(&self, case: &Case) -> Option<String> {
        let open = self.wanted.contact == FrfContact::Open;
        without_prestress(case, &format!("frf.{}", self.name), "sliding").filter(|_| open)
    }

    /// Where the force acts.
    pub fn force(&self) -> &Motion {
        &self.force
    }

    /// The names of the places whose motion is computed, and where they are.
    pub fn seen(&self) -> &[(String, Motion)] {
        &self.seen
    }

    /// Whether force and motion may change places: nothing slides or rotates.
    pub fn reciprocal(&self) -> bool {
        self.wanted.contact == FrfContact::Open && self.symmetric
    }

    /// The requested frequencies \[Hz\].
    pub fn band(&self) -> [f64; 2] {
        self.wanted.band
    }

    /// Asks for the receptance of a place at frequencies \[Hz\] of its own, besides; gives where it will be in the second
    /// answer of [`PreparedFrf::run`].
    pub fn also_at(&mut self, place: usize, frequencies_hz: Vec<f64>) -> usize {
        self.beside.push((place, frequencies_hz));
        self.beside.len() - 1
    }

    /// The response, and the receptances that were requested besides \[m/N\]; `steady` is steady sliding, where the
    /// contacts slide, `known` the complex analysis about it, if the run has one.
    ///
    /// # Errors
    /// Modes that cannot be computed, a resonance that nothing damps.
    pub fn run(
        &self,
        prepared: &Prepared<'_>,
        (steady, known): (Option<&SteadySliding>, Option<&ComplexResult>),
        observer: &dyn Observer,
    ) -> Result<(FrfResult, Vec<Vec<c64>>)> {
        let FrfAnalysis { quantity, band, solution, .. } = *self.wanted;
        let places: Vec<SparseVector> = self.seen.iter().map(|(_, m)| m.direction.clone()).collect();
        let forms: Vec<SparseVector> =
            std::iter::once(&self.force.direction).chain(&places).cloned().collect();
        let steady = steady.filter(|_| self.slides());
        check_damping_frequencies(&prepared.system.structure, prepared.case, 2.0 * band[1])?;
        let receptance = {
            let of = |mass: &SparseMatrix, real: &RealModes| damping_of_response(mass, real, prepared.case);
            let damping = DampingOfModes { of: &of, needs_below: response_needs(prepared.case) };
            Receptance::new(&prepared.system, steady, (band[1], &forms), damping, observer)?
        };
        let unstable = match self.reciprocal() {
            true => Vec::new(),
            false => unstable_modes(&receptance, band[1], known, observer)?,
        };
        let Receptance { system, steady, real, reduced, small } = receptance;
        let few = Harmonic::new(&small.0, &small.1)?;
        let full = Harmonic::new(&system, &steady)?;
        let (force, seen) = (reduced.form(&self.force.direction), places.iter().map(|p| reduced.form(p)));
        let seen: Vec<SparseVector> = seen.collect();
        let superposed = |hz: f64| few.at(TAU * hz, &force, &seen);
        let direct = |hz: f64| full.at(TAU * hz, &self.force.direction, &places);
        let closed = match self.wanted.contact {
            FrfContact::Open => None,
            FrfContact::Sliding => {
                Some(closed_modes((&system, &steady), (&reduced, &small), MODES * band[1], observer)?)
            }
        };
        let mut resonances = self.resonances(prepared, closed.as_ref().unwrap_or(&real))?;
        for resonance in &mut resonances {
            resonance.undamped = unbounded(resonance.frequency_hz, &superposed)?;
        }
        let near: Vec<(f64, bool)> = resonances.iter().map(|r| (r.frequency_hz, r.undamped)).collect();
        let (frequencies, mut lines) = grid(band, &near, &superposed)?;
        let compared: Vec<usize> =
            (0..COMPARED).map(|k| (2 * k + 1) * frequencies.len() / (2 * COMPARED)).collect();
        observer.begin(
            "frequency response",
            Some(match solution {
                FrfSolution::Modes => COMPARED as u64,
                FrfSolution::Direct => frequencies.len() as u64,
            }),
        );
        let exact = |k: usize| {
            let line = direct(frequencies[k]);
            observer.advance(1);
            line
        };
        let mut deviation: f64 = 0.0;
        match solution {
            FrfSolution::Modes => {
                let exact = compared.par_iter().map(|k| exact(*k)).collect::<Result<Vec<_>>>()?;
                compared
                    .iter()
                    .zip(&exact)
                    .for_each(|(k, line)| deviation = deviation.max(apart(&lines[*k], line)));
            }
            FrfSolution::Direct => {
                let all = (0..frequencies.len()).into_par_iter().map(exact).collect::<Result<Vec<_>>>()?;
                compared.iter().for_each(|k| deviation = deviation.max(apart(&lines[*k], &all[*k])));
                lines = all;
            }
        }
        observer.end();
        let answer = |hz: f64| match solution {
            FrfSolution::Modes => superposed(hz),
            FrfSolution::Direct => direct(hz),
        };
        let along = |(place, hz): &(usize, Vec<f64>)| {
            hz.par_iter().map(|hz| answer(*hz).map(|line| line[*place])).collect::<Result<Vec<c64>>>()
        };
        let beside = self.beside.iter().map(along).collect::<Result<Vec<_>>>()?;
        let responses = self.seen.iter().enumerate().map(|(k, (name, motion))| FrfResponse {
            name: name.clone(),
            place: motion.place.clone(),
            at: place_of(motion),
            values: frequencies.iter().zip(&lines).map(|(hz, line)| quantity.factor(*hz) * line[k]).collect(),
        });
        let result = FrfResult {
            name: self.name.to_string(),
            quantity,
            force: place_of(&self.force),
            about: self.about(&reduced, closed.as_ref().unwrap_or(&real).negative),
            excitation: self.force.place.clone(),
            responses: responses.collect(),
            resonances,
            unstable,
            measured: self.wanted.measured.clone(),
            deviation,
            compared: COMPARED,
            frequencies_hz: frequencies,
            binary: self.wanted.uff == UniversalForm::Binary,
        };
        Ok((result, beside))
    }

    /// State of the contacts and method of the response, in words.
    fn about(&self, reduced: &Reduced, negative: usize) -> String {
        let contacts = match self.wanted.contact {
            _ if self.stressed => "with the stiffness of the preload",
            FrfContact::Open => "contacts open",
            FrfContact::Sliding => "contacts in steady sliding",
        };
        let way = match self.wanted.solution {
            FrfSolution::Modes => {
                let attached = reduced.basis.ncols() - reduced.modes;
                format!("superposition of {} real modes and {attached} residuals", reduced.modes)
            }
            FrfSolution::Direct => "solved at full order at every frequency".into(),
        };
        let unstable = match negative {
            0 => String::new(),
            n => format!("; beyond buckling, {n} of the modes with ω² < 0: no steady response is reached"),
        };
        format!("{contacts}; {way}{unstable}")
    }

    /// The real modes in the band, up to [`BESIDE`] its ends, and how much of them shows.
    fn resonances(&self, prepared: &Prepared<'_>, real: &RealModes) -> Result<Vec<Resonance>> {
        let names = labels(&identify(prepared, real, (&prepared.model, &prepared.assembled)), real);
        let [low, high] = self.wanted.band;
        let band = low * (1.0 - BESIDE)..=high * (1.0 + BESIDE);
        let inside: Vec<usize> = (0..real.len()).filter(|k| band.contains(&real.frequency_hz(*k))).collect();
        let at = |motion: &Motion, k: usize| motion.direction.dot(real.shapes.col_as_slice(k));
        let products: Vec<Vec<f64>> = inside
            .iter()
            .map(|k| {
                let driven = at(&self.force, *k);
                self.seen.iter().map(|(_, motion)| (driven * at(motion, *k)).abs()).collect()
            })
            .collect();
        let largest = |place: usize| products.iter().map(|p| p[place]).fold(f64::MIN_POSITIVE, f64::max);
        let share = |products: &Vec<f64>| {
            products.iter().enumerate().map(|(place, p)| p / largest(place)).collect::<Vec<f64>>()
        };
        let resonance = |(k, products): (&usize, &Vec<f64>)| Resonance {
            frequency_hz: real.frequency_hz(*k),
            name: names[*k].clone(),
            seen: share(products),
            undamped: false,
        };
        Ok(inside.iter().zip(&products).map(resonance).collect())
    }
}

/// The real modes below `hz` \[Hz\] with the contacts closed and without friction, of the small system that gives the response if the contacts
/// are in it.
fn closed_modes(
    (system, steady): (&System, &SteadySliding),
    (reduced, small): (&Reduced, &(System, SteadySliding)),
    hz: f64,
    observer: &dyn Observer,
) -> Result<RealModes> {
    let below = |structure| compute(&structure, ModesWanted::BelowHz(hz), observer);
    if reduced.contacts.is_some() {
        return Ok(below(closed_structure(system, steady)?)?.0);
    }
    let (modes, _) = below(closed_structure(&small.0, &small.1)?)?;
    Ok(RealModes { shapes: &reduced.basis * &modes.shapes, ..modes })
}

fn place_of(motion: &Motion) -> PlaceAndDirection {
    PlaceAndDirection { position: motion.at, direction: motion.along }
}

/// The largest |a − b| over |b|.
fn apart(a: &[c64], b: &[c64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm() / b.norm().max(f64::MIN_POSITIVE)).fold(0.0, f64::max)
}

/// Whether the response has no bound at `hz`, or one that is the inverse of rounding errors.
fn unbounded(hz: f64, response: &impl Fn(f64) -> Result<Vec<c64>>) -> Result<bool> {
    let largest = |hz: f64| match response(hz) {
        Ok(line) => Ok(line.iter().map(|h| h.norm()).fold(0.0, f64::max)),
        Err(error) if is_unbounded(&error) => Ok(f64::INFINITY),
        Err(error) => Err(error),
    };
    // On that side on which no neighbouring mode is.
    let [at, below, above] = [largest(hz)?, largest(hz * (1.0 - BESIDE))?, largest(hz * (1.0 + BESIDE))?];
    Ok(!at.is_finite() || at > UNBOUNDED * below.min(above))
}

/// What to know of the resonances that nothing damps, if there are any.
pub fn undamped(frf: &FrfResult) -> Option<String> {
    let all: Vec<String> = frf.undamped().map(|r| format!("{:.6} Hz ({})", r.frequency_hz, r.name)).collect();
    let rest = all.len().saturating_sub(NAMED);
    let more = if rest > 0 { format!(" and {rest} more") } else { String::new() };
    (!all.is_empty()).then(|| {
        format!(
            "frf.{}: nothing damps the modes at {}{more}: the response has no bound there, and no line closer than {BESIDE:e} of the \
             frequency. {DAMPERS}; or a `band` between them",
            frf.name,
            all[..all.len() - rest].join(", ")
        )
    })
}

type ResponseLines = (Vec<f64>, Vec<Vec<c64>>);

/// Frequencies \[Hz\] that show every bend of a response within `band`, and the response there. Begins with an even
/// logarithmic grid and the frequencies `near` which something happens, and halves every interval whose middle is off the
/// straight line between its ends by more than 1 %. Of the frequencies that are marked as without a bound those at the distance
/// [`BESIDE`] are taken, and none between.
fn grid(
    band: [f64; 2],
    near: &[(f64, bool)],
    response: &(impl Fn(f64) -> Result<Vec<c64>> + Sync),
) -> Result<ResponseLines> {
    let ratio = (band[1] / band[0]).powf(1.0 / (FIRST - 1) as f64);
    let even = (0..FIRST).map(|k| if k + 1 < FIRST { band[0] * ratio.powi(k as i32) } else { band[1] });
    let beside = |(hz, undamped): &(f64, bool)| match undamped {
        true => vec![hz * (1.0 - BESIDE), hz * (1.0 + BESIDE)],
        false => vec![*hz],
    };
    // All but rounding of the distance.
    let gap = |hz: f64| near.iter().any(|(at, undamped)| *undamped && (hz / at - 1.0).abs() < 0.999 * BESIDE);
    let mut all: Vec<f64> = even.chain(near.iter().flat_map(beside)).collect();
    all.retain(|hz| (band[0]..=band[1]).contains(hz) && !gap(*hz));
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| *a - *b < 1e-9 * *a);
    if all.is_empty() {
        let found = "a band that a resonance without damping fills";
        return Err(Error::analysis("frequency response", found, DAMPERS));
    }
    let answers = |hz: &[f64]| hz.par_iter().map(|hz| response(*hz)).collect::<Result<Vec<_>>>();
    let first = answers(&all)?;
    let mut lines: Vec<(f64, Vec<c64>)> = all.into_iter().zip(first).collect();
    // Intervals that may still be too long, by their lower ends.
    let mut open = vec![true; lines.len() - 1];
    while lines.len() < MOST && open.contains(&true) {
        let middles: Vec<Option<f64>> = lines
            .windows(2)
            .zip(&open)
            .map(|(ends, open)| Some(0.5 * (ends[0].0 + ends[1].0)).filter(|middle| *open && !gap(*middle)))
            .collect();
        let asked: Vec<f64> = middles.iter().flatten().copied().collect();
        let mut found = answers(&asked)?.into_iter();
        let (mut next, mut next_open) = (Vec::new(), Vec::new());
        for (k, line) in lines.iter().enumerate() {
            next.push(line.clone());
            let Some(middle) = middles.get(k).copied() else { continue };
            let (Some(hz), Some(answer)) = (middle, middle.and_then(|_| found.next())) else {
                next_open.push(false);
                continue;
            };
            let bends = bends(&line.1, &answer, &lines[k + 1].1);
            next.push((hz, answer));
            next_open.extend([bends; 2]);
        }
        (lines, open) = (next, next_open);
    }
    Ok(lines.into_iter().unzip())
}

/// Whether the middle is off the straight line between the ends.
fn bends(from: &[c64], middle: &[c64], to: &[c64]) -> bool {
    from.iter().zip(middle).zip(to).any(|((a, m), b)| {
        let size = a.norm().max(m.norm()).max(b.norm());
        ((a + b) * 0.5 - m).norm() > BEND * size
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::case::Case;
    use crate::equilibrium::{SteadyOptions, solve_steady};
    use crate::job::samples::disc;
    use crate::linalg::random::Random;

    const RESPONSES: &str = r#"
[damping]
modal_ratio = 0.003
[frf.rim]
excitation = { at = [0, 0, "75 mm"], direction = [1, 0, 0] }
response.rim = { at = [0, 0, "75 mm"], direction = [1, 0, 0] }
response.inside = { at = [0, "40 mm", 0], direction = [2, 0, 0] }
quantity = "receptance"
band = ["50 Hz", "2 kHz"]
[frf.back]
excitation = { at = [0, "40 mm", 0], direction = [1, 0, 0] }
response.rim = { at = [0, 0, "75 mm"], direction = [1, 0, 0] }
quantity = "receptance"
band = ["50 Hz", "2 kHz"]
solution = "direct"
"#;

    fn results(text: &str) -> Vec<FrfResult> {
        let case = Case::parse("disc", text, ".".into()).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        let steady = solve_steady(&prepared.system, &SteadyOptions::default(), &()).unwrap();
        frfs(&prepared)
            .unwrap()
            .iter()
            .map(|frf| frf.run(&prepared, (Some(&steady), None), &()).unwrap().0)
            .collect()
    }

    #[test]
    fn superposition_and_direct_solution_agree_and_the_way_back_is_the_same() {
        let [back, rim] = &results(&(disc(6, 24) + RESPONSES))[..] else { panic!("two responses") };
        assert!(
            within(back.deviation, 1e-3, Discretisation) && within(rim.deviation, 1e-3, Discretisation),
            "{} {}",
            back.deviation,
            rim.deviation
        );
        // Maxwell and Betti: from the rim to the inside as from the inside to the rim.
        let there = &rim.responses.iter().find(|r| r.name == "inside").unwrap().values;
        let drive = &rim.responses.iter().find(|r| r.name == "rim").unwrap().values;
        let (mut same, mut apart, mut whole) = (0, 0.0, 0.0);
        for (hz, value) in back.frequencies_hz.iter().zip(&back.responses[0].values) {
            if let Some(k) = rim.frequencies_hz.iter().position(|other| (other / hz - 1.0).abs() < 1e-11) {
                apart += (there[k] - value).norm_sqr();
                whole += value.norm_sqr();
                same += 1;
            }
        }
        assert!(same > 100 && within(apart, 1e-6 * whole, Discretisation), "{same}: {apart:e} of {whole:e}");
        // At the driving point the force never gains energy from a structure at rest: Im h < 0.
        assert!(drive.iter().all(|h| h.im < 0.0));
        // The first resonance is a frequency of the grid, and stands high above the static response.
        let first = rim.resonances[0].frequency_hz;
        let peak = rim.frequencies_hz.iter().position(|hz| (hz - first).abs() < 1e-9 * first).unwrap();
        assert!(drive[peak].norm() > 10.0 * drive[0].norm());
        for place in 0..2 {
            let shares = rim.resonances.iter().map(|r| r.seen[place]);
            assert!(shares.fold(0.0, f64::max) == 1.0);
        }
    }

    /// Chains of n masses on springs, driven at the first mass: h = 1/d_1 with d_n = k_n − ω²m_n and
    /// d_j = k_j + k_{j+1} − ω²m_j − k_{j+1}²/d_{j+1}.
    #[test]
    fn resonances_that_nothing_damps_are_named_and_have_no_line() {
        let mut random = Random::seeded(8);
        for round in 0..12 {
            let n = 1 + round % 4;
            // The first four as round numbers, at which the matrix is singular to the last bit.
            let number = |random: &mut Random, round: usize, low: f64, high: f64| match round < 4 {
                true => low,
                false => random.between(low, high),
            };
            let springs: Vec<f64> = (0..n).map(|_| number(&mut random, round, 1800.0, 9000.0)).collect();
            let masses: Vec<f64> = (0..n).map(|_| number(&mut random, round, 2.0, 5.0)).collect();
            let solution = ["modes", "direct"][round / 2 % 2];
            let mut text = String::from("[point]\n");
            (0..n).for_each(|k| text += &format!("p{k} = [{k}, 0, 0]\n"));
            for k in 0..n {
                let to = if k > 0 { format!("to = \"p{}\"\n", k - 1) } else { String::new() };
                text += &format!(
                    "[mass.p{k}]\non = \"p{k}\"\nmass = {}\n[spring.s{k}]\non = \"p{k}\"\n{to}direction = [1, 0, 0]\n\
                     stiffness = {}\n[support.h{k}]\non = \"p{k}\"\nheld = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n",
                    masses[k], springs[k]
                );
            }
            text += &format!(
                "[frf.a]\nband = [\"1 Hz\", \"40 Hz\"]\nquantity = \"receptance\"\nsolution = \"{solution}\"\n\
                 excitation = {{ on = \"p0\", direction = [1, 0, 0] }}\n"
            );
            let exact = |hz: f64, factor: c64| -> c64 {
                let square = (TAU * hz).powi(2);
                let mut d = factor * springs[n - 1] - square * masses[n - 1];
                for j in (0..n - 1).rev() {
                    let next = factor * springs[j + 1];
                    d = factor * springs[j] + next - square * masses[j] - next * next / d;
                }
                c64::new(1.0, 0.0) / d
            };
            let undamped = &results(&text)[0];
            assert_eq!(undamped.resonances.len(), n);
            assert!(undamped.resonances.iter().all(|r| r.undamped), "{text}");
            let words = super::undamped(undamped).unwrap();
            assert!(words.matches(" Hz (").count() == n && words.contains("modal_ratio"), "{words}");
            for (hz, h) in undamped.frequencies_hz.iter().zip(&undamped.responses[0].values) {
                let away = undamped.resonances.iter().map(|r| (hz / r.frequency_hz - 1.0).abs());
                let away = away.fold(f64::INFINITY, f64::min);
                let exact = exact(*hz, c64::new(1.0, 0.0));
                // Rounding, as the distance from the resonance magnifies it; an antiresonance is small for what it is made of.
                assert!(away > 0.99 * BESIDE, "{away:e}");
                let tolerance = 1e-11 * exact.norm() / away.min(1.0) + 1e-12 / springs[0];
                assert!(within((h - exact).norm(), tolerance, RoundOff), "{hz}: {h} {exact}");
            }
            for r in &undamped.resonances {
                let beside = |hz: &&f64| (*hz / r.frequency_hz - 1.0).abs() < 1.01 * BESIDE;
                assert_eq!(undamped.frequencies_hz.iter().filter(beside).count(), 2, "{}", r.frequency_hz);
            }
            // With damping ratios of 1e-6 every line has a bound: at a resonance |h| is its residue over 2ζω².
            let lossy = &results(&(text + "[damping]\nmodal_ratio = 1e-6\n"))[0];
            assert!(super::undamped(lossy).is_none());
            for r in &lossy.resonances {
                let at = lossy.frequencies_hz.iter().position(|hz| (hz / r.frequency_hz - 1.0).abs() < 1e-9);
                let found = lossy.responses[0].values[at.unwrap()].norm() * 2e-6;
                // The residue over ω², from both sides, right to the square of the distance.
                let part = |by: f64| {
                    exact(r.frequency_hz * (1.0 + by), c64::new(1.0, 0.0)).re * (1.0 - (1.0 + by).powi(2))
                };
                let residue = 0.5 * (part(1e-4) + part(-1e-4));
                assert!(
                    within((found / residue - 1.0).abs(), 1e-2, Discretisation),
                    "{n} {solution} {}: {found:e} {residue:e}",
                    r.frequency_hz
                );
            }
        }
    }

    #[test]
    fn a_free_oscillation_of_the_grid_is_resolved() {
        // One degree of freedom, ζ = 1e-3: the straight lines between the grid's points stay within 3 % of |h| at its peak.
        let (f0, zeta) = (300.0, 1e-3);
        let h = |hz: f64| {
            let r: f64 = hz / f0;
            vec![c64::new(1.0, 0.0) / c64::new(1.0 - r * r, 2.0 * zeta * r)]
        };
        let (hz, lines) = grid([10.0, 1000.0], &[], &|hz| Ok(h(hz))).unwrap();
        let largest = lines.iter().map(|l| l[0].norm()).fold(0.0, f64::max);
        assert!(largest > 490.0 && hz.len() < 1000, "{largest} {}", hz.len());
        for (ends, values) in hz.windows(2).zip(lines.windows(2)) {
            let middle = h(0.5 * (ends[0] + ends[1]))[0];
            let straight = (values[0][0] + values[1][0]) * 0.5;
            assert!(within((middle - straight).norm(), 0.02 * middle.norm(), Discretisation));
        }
    }

    #[test]
    fn places_that_are_not_there_are_told_together() {
        let with = |excitation: &str, response: &str| {
            let wrong = disc(6, 24) + RESPONSES;
            let at = |end: &str| format!("at = [0, \"40 mm\", 0]{end}");
            let wrong =
                wrong.replace(&at(", direction = [2"), &format!("on = \"{response}\", direction = [2"));
            let wrong = wrong.replace(
                &format!("excitation = {{ {}", at("")),
                &format!("excitation = {{ on = \"{excitation}\""),
            );
            Case::parse("disc", &wrong, ".".into()).unwrap()
        };
        let together = |error: &str| {
            error.contains("frf.back.excitation.on") && error.contains("frf.rim.response.inside")
        };
        // Regions that the mesh does not have, then places that do not move.
        let error = Prepared::new(&with("him", "her")).err().unwrap().to_string();
        assert!(together(&error), "{error}");
        let held = with("hub", "hub");
        let error = frfs(&Prepared::new(&held).unwrap()).err().unwrap().to_string();
        assert!(
            error.contains("frf.back.excitation") && error.contains("frf.rim.response.inside"),
            "{error}"
        );
    }
}
