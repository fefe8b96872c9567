//! Comparison of measured with computed modes and responses.

use super::frf::PreparedFrf;
use super::measured::measured_set;
use super::motion::Motion;
use super::prepared::Prepared;
use super::sensors::{Sensors, frame};
use crate::case::{Case, MeasuredData, ModesAnalysis};
use crate::error::{Faults, Result};
use crate::linalg::{c64, dense};
use crate::measured::compare::{ComputedModes, ModeToPair, mac_table, pair};
use crate::measured::geometry::{Frame, distance, dot};
use crate::measured::{MeasuredDof, MeasuredFrf, MeasuredMode, MeasuredSet, Quantity};
use crate::modal::levels;
use crate::results::{
    FrfResult, MeasuredComparison, MeasuredResponses, MeasuredRow, NamedModes, ResponsePair,
};

/// Directions that are farther apart than this are two: cos 15°.
const ALONG: f64 = 0.966;

/// All tests of a case, placed on its mesh.
#[derive(Default)]
pub struct Tests {
    tests: Vec<Test>,
    /// Warnings about them.
    pub warnings: Vec<String>,
}

/// One of them.
struct Test {
    name: String,
    /// The analysis whose modes it found.
    of: Option<String>,
    source: String,
    set: MeasuredSet,
    /// Where its shapes were measured, if it has any.
    sensors: Option<Sensors>,
    /// The nodes of the mesh.
    nodes: Vec<[f64; 3]>,
    responses: Option<PairedResponses>,
}

/// The frequency responses of a test that have a computed one beside them.
struct PairedResponses {
    frf: String,
    matches: Vec<Match>,
    measured_alone: Vec<String>,
    computed_alone: Vec<String>,
}

/// A measured response, and where the computed one will be.
struct Match {
    /// Index into the set's responses.
    measured: usize,
    /// The name of the computed place.
    place: String,
    swapped: bool,
    away: [f64; 2],
    /// −1 where one of the directions of the test is against that of the case.
    sign: f64,
    /// Which of the measured frequencies are in the band.
    lines: std::ops::Range<usize>,
    /// Index into the second answer of [`PreparedFrf::run`].
    answer: usize,
}

/// Whether an analysis of real modes has a measured side.
pub fn has_measured_modes(case: &Case, name: &str) -> bool {
    let short = case.modes.get(name).is_some_and(|analysis| !analysis.measured.is_empty());
    short || case.measured.values().any(|data| data.of.as_deref() == Some(name))
}

/// Whether a frequency response has a measured side.
pub fn has_measured_frf(case: &Case, name: &str) -> bool {
    case.measured.values().any(|data| data.frf.as_deref() == Some(name))
}

impl Tests {
    /// The frequencies that sets of real modes list themselves, and the tests of their modes; those of nothing at all, too,
    /// for their warnings. Each has a name of its own.
    ///
    /// # Errors
    /// Every file that cannot be read, and every point of a shape that lies off the mesh.
    pub fn of_modes(prepared: &Prepared<'_>) -> Result<Tests> {
        let case = prepared.case;
        let mut faults = Faults::new();
        let listed = case.modes.iter().filter(|(_, analysis)| !analysis.measured.is_empty());
        let tests = listed.map(|(name, analysis)| Test::listed(name, analysis)).collect();
        let mut all = Tests { tests, warnings: Vec::new() };
        for (name, data) in case.measured.iter().filter(|(_, data)| data.of.is_some() || data.frf.is_none()) {
            let Some(set) = faults.take(all.read(case, name, data)) else { continue };
            let taken = |tests: &[Test], name: &String| tests.iter().any(|test| test.name == *name);
            let numbered = (2..).map(|k| format!("{name} {k}"));
            let own = std::iter::once(name.clone()).chain(numbered).find(|name| !taken(&all.tests, name));
            let test = faults.take(Test::placed(prepared, name, data, set));
            all.tests.extend(test.zip(own).map(|(test, name)| Test { name, ..test }));
        }
        faults.into_result(all)
    }

    /// The tests of frequency responses; asks `frfs` for the responses that were measured.
    ///
    /// # Errors
    /// Every file that cannot be read.
    pub fn of_responses(prepared: &Prepared<'_>, frfs: &mut [PreparedFrf<'_>]) -> Result<Tests> {
        let case = prepared.case;
        let (mut faults, mut all) = (Faults::new(), Tests::default());
        for (name, data) in &case.measured {
            let Some(of) = data.frf.as_deref() else { continue };
            let Some(set) = faults.take(all.read(case, name, data)) else { continue };
            let frf = frfs.iter_mut().find(|frf| frf.name() == of);
            let responses = frf.map(|frf| PairedResponses::new(data, &set, frf));
            all.tests.push(Test { responses, ..Test::unplaced(name, data, set) });
        }
        faults.into_result(all)
    }

    /// The measured data called `name`; warns of what is not compared.
    fn read(&mut self, case: &Case, name: &str, data: &MeasuredData) -> Result<MeasuredSet> {
        let (set, mut warnings) = measured_set(case, name)?;
        let left_out = |count: usize, what: &str, key: &str| {
            format!("Measured {name}: {count} {what} were not compared, as it has no `{key}`")
        };
        if data.of.is_none() && !set.modes.is_empty() {
            warnings.push(left_out(set.modes.len(), "modes", "of"));
        }
        if data.frf.is_none() && !set.frfs.is_empty() {
            warnings.push(left_out(set.frfs.len(), "frequency responses", "frf"));
        }
        self.warnings.extend(warnings);
        Ok(set)
    }

    /// The tests of a set of real modes beside it.
    pub fn modes(&self, analysis: &ModesAnalysis, named: &NamedModes) -> Vec<MeasuredComparison> {
        let own = self.tests.iter().filter(|test| test.of.as_deref() == Some(&named.name));
        own.filter(|test| !test.set.modes.is_empty()).map(|test| test.compare(analysis, named)).collect()
    }

    /// The tests of a frequency response beside the receptances that they requested \[m/N\].
    pub fn responses(&self, computed: &FrfResult, receptances: &[Vec<c64>]) -> Vec<MeasuredResponses> {
        let of = |test: &Test| {
            let responses = test.responses.as_ref().filter(|responses| responses.frf == computed.name)?;
            let pair = |found: &Match| found.pair(&test.set.frfs[found.measured], &receptances[found.answer]);
            Some(MeasuredResponses {
                name: test.name.clone(),
                source: test.source.clone(),
                frf: responses.frf.clone(),
                pairs: responses.matches.iter().map(pair).collect(),
                measured_alone: responses.measured_alone.clone(),
                computed_alone: responses.computed_alone.clone(),
            })
        };
        self.tests.iter().filter_map(of).collect()
    }
}

impl Test {
    /// The frequencies that an analysis lists itself.
    fn listed(name: &str, analysis: &ModesAnalysis) -> Test {
        let mode =
            |hz: &f64| MeasuredMode { frequency_hz: *hz, damping_ratio: None, deviation: None, shape: None };
        Test {
            name: name.to_string(),
            of: Some(name.to_string()),
            source: analysis.measured_source.clone(),
            set: MeasuredSet {
                modes: analysis.measured.iter().map(mode).collect(),
                ..MeasuredSet::default()
            },
            sensors: None,
            nodes: Vec::new(),
            responses: None,
        }
    }

    /// A test whose shapes are placed on the mesh.
    fn placed(prepared: &Prepared<'_>, name: &str, data: &MeasuredData, set: MeasuredSet) -> Result<Test> {
        let of = data.of.as_ref().filter(|_| set.modes.iter().any(|mode| mode.shape.is_some()));
        let place = |of: &String| Sensors::new(prepared, name, data, &set, &prepared.case.modes[of]);
        let (sensors, nodes) = (of.map(place).transpose()?, prepared.model.nodes.clone());
        Ok(Test { sensors, nodes, ..Test::unplaced(name, data, set) })
    }

    /// A test without the places of its shapes.
    fn unplaced(name: &str, data: &MeasuredData, set: MeasuredSet) -> Test {
        Test {
            name: name.to_string(),
            of: data.of.clone(),
            source: data.source.clone(),
            sensors: None,
            nodes: Vec::new(),
            set,
            responses: None,
        }
    }

    fn compare(&self, analysis: &ModesAnalysis, named: &NamedModes) -> MeasuredComparison {
        // Rigid bodies have no frequency to compare.
        let first = named.modes.rigid_bodies;
        let scale = analysis.frequency_scale;
        let hz: Vec<f64> = (first..named.modes.len()).map(|k| scale * named.modes.frequency_hz(k)).collect();
        let levels = levels(&hz, &named.names[first..]);
        let motion = |k: usize, sensors: &Sensors| sensors.motions(&self.nodes, &named.shape(first + k));
        let motions: Vec<Vec<f64>> = match &self.sensors {
            Some(sensors) => (0..hz.len()).map(|k| motion(k, sensors)).collect(),
            None => Vec::new(),
        };
        let computed = ComputedModes { frequencies_hz: &hz, levels: &levels, motions: &motions };
        let own = self.set.modes.iter();
        let measured: Vec<ModeToPair> = own
            .map(|mode| ModeToPair { frequency_hz: mode.frequency_hz, shape: mode.shape.as_deref() })
            .collect();
        let mac = mac_table(&measured, &computed);
        let pairs = pair(&measured, &computed, &mac);
        let rows = self.set.modes.iter().zip(&pairs).map(|(mode, pair)| MeasuredRow {
            frequency_hz: mode.frequency_hz,
            deviation: mode.deviation,
            damping_ratio: mode.damping_ratio,
            mode: pair.map(|pair| first + pair.mode),
            computed_hz: pair.map(|pair| hz[pair.mode]),
            computed_damping_ratio: pair.and_then(|pair| named.damping_ratio.get(first + pair.mode)).copied(),
            mac: pair.and_then(|pair| pair.mac),
        });
        MeasuredComparison {
            name: self.name.clone(),
            set: named.name.clone(),
            source: self.source.clone(),
            rows: rows.collect(),
            frequency_scale: scale,
            levels_hz: levels.iter().map(|level| hz[level.start]).collect(),
            levels: levels.iter().map(|level| first + level.start..first + level.end).collect(),
            mac,
            placed: self.sensors.as_ref().map(|sensors| sensors.placed),
        }
    }
}

/// A measured response that is of a place of the case.
pub struct MatchedResponse {
    /// Index into the set's responses.
    pub measured: usize,
    /// Index of the place.
    pub seen: usize,
    swapped: bool,
    away: [f64; 2],
    sign: f64,
}

/// The measured responses that are of places of `frf`, and those that are not.
pub fn matches(
    data: &MeasuredData,
    set: &MeasuredSet,
    frf: &PreparedFrf<'_>,
) -> (Vec<MatchedResponse>, Vec<String>) {
    let frame = frame(data);
    let at = |dof: &MeasuredDof, motion: &Motion| place_sign(&frame, set, dof, motion, data.reach);
    let (mut all, mut alone) = (Vec::new(), Vec::new());
    for (measured, function) in set.frfs.iter().enumerate() {
        let ways = [(&function.excitation, &function.response), (&function.response, &function.excitation)];
        let ways = ways.into_iter().enumerate().filter(|(swapped, _)| *swapped == 0 || frf.reciprocal());
        let found = ways.flat_map(|(swapped, (force, motion))| {
            let driven = at(force, frf.force());
            let seen = frf.seen().iter().enumerate();
            seen.filter_map(move |(k, (_, place))| Some((swapped == 1, k, driven?, at(motion, place)?)))
        });
        match found.min_by(|a, b| (a.2.0 + a.3.0).total_cmp(&(b.2.0 + b.3.0))) {
            Some((swapped, seen, driven, motion)) => {
                let (away, sign) = ([driven.0, motion.0], driven.1 * motion.1);
                all.push(MatchedResponse { measured, seen, swapped, away, sign });
            }
            None => alone.push(format!("{}: no response of the case is there", function.name)),
        }
    }
    (all, alone)
}

impl PairedResponses {
    fn new(data: &MeasuredData, set: &MeasuredSet, frf: &mut PreparedFrf<'_>) -> PairedResponses {
        let [low, high] = frf.band();
        let (found, mut measured_alone) = matches(data, set, frf);
        let mut matches = Vec::new();
        for MatchedResponse { measured, seen, swapped, away, sign } in found {
            let function = &set.frfs[measured];
            let hz = &function.frequencies_hz;
            let lines = hz.partition_point(|f| *f < low)..hz.partition_point(|f| *f <= high);
            if lines.len() < 2 {
                measured_alone.push(format!("{}: no frequencies in the band", function.name));
                continue;
            }
            let (place, answer) = (frf.seen()[seen].0.clone(), frf.also_at(seen, hz[lines.clone()].to_vec()));
            matches.push(Match { measured, place, swapped, away, sign, lines, answer });
        }
        let alone = frf.seen().iter().map(|(name, _)| name);
        let alone = alone.filter(|name| !matches.iter().any(|m: &Match| m.place == **name));
        let computed_alone = alone.cloned().collect();
        PairedResponses { frf: frf.name().to_string(), matches, measured_alone, computed_alone }
    }
}

/// How far a degree of freedom of a test is from a place of the case \[m\], and 1 or −1 as it is along or against it;
/// `None` where it is another one. A direction that the test does not state is that of the case.
fn place_sign(
    frame: &Frame,
    set: &MeasuredSet,
    dof: &MeasuredDof,
    motion: &Motion,
    reach: f64,
) -> Option<(f64, f64)> {
    let away = distance(frame.point(set.points[dof.point].position), motion.at);
    let along = dot(frame.direction(dof.direction), motion.along);
    let stated = dof.direction != [0.0; 3];
    let same = away <= reach && (!stated || along.abs() >= ALONG);
    same.then_some((away, if along < 0.0 { -1.0 } else { 1.0 }))
}

impl Match {
    fn pair(&self, function: &MeasuredFrf, receptance: &[c64]) -> ResponsePair {
        let frequencies_hz = function.frequencies_hz[self.lines.clone()].to_vec();
        let measured: Vec<c64> = function.values[self.lines.clone()].iter().map(|v| v * self.sign).collect();
        let quantity: Quantity = function.quantity;
        let along = frequencies_hz.iter().zip(receptance);
        let computed: Vec<c64> = along.map(|(hz, h)| quantity.factor(*hz) * h).collect();
        ResponsePair {
            name: function.name.clone(),
            place: self.place.clone(),
            swapped: self.swapped,
            away: self.away,
            quantity,
            assurance: dense::mac(&measured, &computed),
            frequencies_hz,
            measured,
            computed,
        }
    }
}

#[cfg(test)]
mod tests;
