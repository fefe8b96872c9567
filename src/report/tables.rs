//! The content of the tables, once for the terminal and the page.

use super::format::{fixed, given, hertz, power, rate, signed, significant};
use crate::dataset;
use crate::linalg::c64;
use crate::results::{
    ComplexResult, ModeSensitivity, NamedModes, RunResults, SensitivityResult, SteadyResult,
};
use crate::stability::{Certificate, Confirmation, Verdict};
use std::f64::consts::TAU;

/// A measured squeal frequency and an unstable mode nearer than this share of it are taken for the same.
pub(super) const SQUEAL_TOLERANCE: f64 = 0.03;

/// A table with its caption and the notes below it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    pub caption: String,
    pub columns: Vec<Column>,
    pub rows: Vec<Row>,
    pub notes: Vec<String>,
    /// Whether its marked rows are bad news.
    pub alarming: bool,
}

/// A column's heading and whether it holds words (set left) or numbers (set right).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    pub heading: &'static str,
    pub words: bool,
}

/// A row; `marked` rows stand out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    pub cells: Vec<String>,
    pub marked: bool,
}

impl Table {
    /// An empty table; a heading that begins with `<` is that of a column of words.
    pub(super) fn new(caption: impl Into<String>, headings: &[&'static str]) -> Self {
        let column = |heading: &&'static str| match heading.strip_prefix('<') {
            Some(heading) => Column { heading, words: true },
            None => Column { heading, words: false },
        };
        Table {
            caption: caption.into(),
            columns: headings.iter().map(column).collect(),
            rows: vec![],
            notes: vec![],
            alarming: false,
        }
    }

    /// The columns of a table that are shown to people, after the number of the row where `numbered`.
    pub(super) fn of(caption: impl Into<String>, data: &dataset::Table, numbered: bool) -> Self {
        let mut table = Table::new(caption, if numbered { &["no."] } else { &[] });
        let shown: Vec<_> = data.columns.iter().filter_map(|column| column.shown.as_ref()).collect();
        let column = |shown: &&dataset::Shown| Column { heading: shown.heading, words: shown.words };
        table.columns.extend(shown.iter().map(column));
        for k in 0..data.rows.length {
            let number = numbered.then(|| (k + 1).to_string());
            table.row(
                number.into_iter().chain(shown.iter().map(|shown| shown.cells[k].clone())).collect(),
                false,
            );
        }
        table
    }

    pub(super) fn row(&mut self, cells: Vec<String>, marked: bool) {
        self.rows.push(Row { cells, marked });
    }
}

/// The modes of set `index` beside the measured frequencies that were compared with it.
pub(super) fn modes(results: &RunResults, index: usize) -> Table {
    let set = &results.modes[index];
    let comparisons: Vec<_> = results.measured.iter().filter(|m| m.modes == index).collect();
    let mut headings = vec!["no.", "f [Hz]"];
    // Where several parts move, which one moves most tells a disc's mode from a slider's.
    let parted = set.moving_part.iter().any(|part| *part != set.moving_part[0]);
    if parted {
        headings.insert(0, "<part");
    }
    let named = set.names.iter().any(Option::is_some) || set.modes.rigid_bodies > 0;
    if named {
        headings.push("(n, s)");
    }
    let scale = comparisons.first().map_or(1.0, |m| m.frequency_scale);
    let scaled = scale != 1.0;
    if scaled {
        headings.push("scaled [Hz]");
    }
    if !comparisons.is_empty() {
        headings.extend(["measured", "diff. [%]"]);
    }
    headings.extend(["m_x [%]", "m_y [%]", "m_z [%]", "η"]);
    let mut table = Table::new(format!("Real modes: {}", set.name), &headings);
    let rows: Vec<_> = comparisons.iter().flat_map(|m| m.compare(&results.modes)).collect();
    for k in 0..set.modes.len() {
        // The frequency of a rigid-body motion is round-off.
        let show = if k < set.modes.rigid_bodies { fixed } else { hertz };
        let mut cells = vec![(k + 1).to_string(), show(set.modes.frequency_hz(k), 1)];
        if parted {
            cells.insert(0, set.moving_part[k].clone().unwrap_or("–".into()));
        }
        if named {
            let name = set.names.get(k).copied().flatten();
            cells.push(match name {
                _ if k < set.modes.rigid_bodies => "rigid".into(),
                Some(n) => format!("({}, {})", n.nodal_diameters, n.nodal_circles),
                None => "–".into(),
            });
        }
        let paired = rows.iter().find(|row| row.mode == Some(k));
        if scaled {
            cells.push(show(scale * set.modes.frequency_hz(k), 1));
        }
        if !comparisons.is_empty() {
            cells.push(paired.map_or(String::new(), |row| given(row.measured_hz)));
            cells.push(
                paired.and_then(|row| row.difference_percent()).map_or(String::new(), |d| signed(d, 2)),
            );
        }
        let mass = |axis: usize| set.effective_mass.get(k).map(|m| 100.0 * m[axis] / set.total_mass);
        cells.extend((0..3).map(|axis| mass(axis).map_or("–".into(), |share| fixed(share, 1))));
        cells.push(set.modes.backward_errors.get(k).map_or("–".into(), |e| power(*e)));
        table.row(cells, paired.is_some());
    }
    table.notes.push(certificate(set));
    for comparison in comparisons {
        table.notes.push(format!("Measured: {}.", comparison.source));
        if comparison.frequency_scale != 1.0 {
            let scale = given(comparison.frequency_scale);
            table
                .notes
                .push(format!("Scaled: computed frequencies times {scale}, an assumption of the case."));
        }
        let alone = comparison.compare(&results.modes).into_iter().filter(|row| row.computed_hz.is_none());
        let alone: Vec<String> = alone.map(|row| format!("{} Hz", given(row.measured_hz))).collect();
        if !alone.is_empty() {
            table.notes.push(format!("Measured without a computed mode beside it: {}.", alone.join(", ")));
        }
    }
    if named {
        table.notes.push("(n, s): nodal diameters and circles.".into());
    }
    table.notes.push("m: effective mass, share of the total; η: backward error.".into());
    table
}

/// The Sturm count in words.
fn certificate(set: &NamedModes) -> String {
    let c = &set.modes.certificate;
    let below = given(c.below_hz);
    if c.holds() {
        format!("Counted below {below} Hz: {}, found: {}. None is missing.", c.counted[0], c.found)
    } else {
        let [a, b] = c.counted;
        format!("NOT CERTIFIED: counted below {below} Hz: {a} and {b}, found: {}.", c.found)
    }
}

/// Steady sliding, one row a pair.
pub(super) fn steady(result: &SteadyResult) -> Table {
    let mut table = Table::of("Steady sliding", &result.pair_table(), false);
    let residual = power(result.state.residual);
    table.notes.push(format!("{} Newton iterations, relative residual {residual}.", result.state.iterations));
    table
}

/// The complex eigenvalues, unstable ones marked.
pub(super) fn complex(result: &ComplexResult) -> Table {
    let mut table = Table::of("Complex eigenvalues at steady sliding", &result.mode_table(), true);
    table.alarming = true;
    for (row, mode) in table.rows.iter_mut().zip(&result.modes.modes) {
        row.marked = matches!(mode.verdict(), Verdict::Unstable | Verdict::Inaccurate);
    }
    table.notes.push("σ: growth rate; ζ = −σ/|λ|: damping ratio, negative when unstable.".into());
    table.notes.push("η: backward error; |Δλ|/|λ|: estimated eigenvalue error; κ: condition number.".into());
    table.notes.extend(result.confirmation.as_ref().map(second_method));
    table
}

/// The unstable modes, the strongest growth first, with the nearest measured squeal.
pub(super) fn unstable(result: &ComplexResult) -> Table {
    let headings =
        ["f [Hz]", "growth rate σ [1/s]", "damping ratio [%]", "grows tenfold in [ms]", "<measured squeal"];
    let mut table = Table::new("Unstable modes", &headings);
    table.alarming = true;
    let mut modes: Vec<_> = result.modes.modes.iter().filter(|m| m.unstable()).collect();
    modes.sort_by(|a, b| b.growth_rate().total_cmp(&a.growth_rate()));
    for mode in modes {
        let hz = mode.frequency_hz();
        let squeal = match nearest_squeal(result, hz) {
            Some(measured) => {
                let difference = signed(100.0 * (hz / measured - 1.0), 1);
                format!("{} Hz ({difference} %)", given(measured))
            }
            None if result.measured_squeal_hz.is_empty() => "no measurement given".into(),
            None => format!("none within {} %", fixed(100.0 * SQUEAL_TOLERANCE, 0)),
        };
        let cells = vec![
            hertz(hz, 1),
            rate(mode.eigenvalue),
            signed(100.0 * mode.damping_ratio(), 3),
            significant(1e3 * 10_f64.ln() / mode.growth_rate(), 3),
            squeal,
        ];
        table.row(cells, true);
    }
    let unmatched: Vec<String> = result
        .measured_squeal_hz
        .iter()
        .filter(|(hz, _)| !result.modes.modes.iter().any(|m| m.unstable() && near(m.frequency_hz(), *hz)))
        .map(|(hz, source)| format!("{} Hz ({source})", given(*hz)))
        .collect();
    if !unmatched.is_empty() {
        table.notes.push(format!("Measured squeal without an unstable mode: {}.", unmatched.join(", ")));
    }
    table.notes.extend(result.certificate.as_ref().map(counted));
    table
}

/// What the count of the unstable eigenvalues says, in words.
fn counted(certificate: &Certificate) -> String {
    let ([low, high], [slow, fast]) = (certificate.band_hz, certificate.growth);
    let faster = match certificate.proven {
        true => format!("σ > {} 1/s", significant(slow, 2)),
        false => format!("σ from {} to {} 1/s", significant(slow, 2), significant(fast, 2)),
    };
    let region = format!("between {} and {} Hz with {faster}", given(low), hertz(high, 0));
    let with_conjugates = if low == 0.0 { ", conjugates included," } else { "" };
    let count = format!("{} eigenvalues {region}{with_conjugates}", certificate.counted);
    let mut words = if certificate.agrees() && !certificate.proven {
        let step = significant(180.0 / certificate.margin, 2);
        format!(
            "Counted: {count}, as many as were found, by the phase of the determinant at full order ({} points, steps up to {step}°).",
            certificate.points
        )
    } else if certificate.holds() {
        let margin = significant(certificate.margin, 2);
        format!(
            "Certified: {count} were counted, as many as were found. The count holds at full order (margin {margin}) if the real \
             modes are exact; rounding is not bounded."
        )
    } else if certificate.agrees() {
        format!(
            "{count} were counted, as many as were found; that the count holds at full order is not shown."
        )
    } else {
        format!("A MODE WAS MISSED: {count} were counted, {} found.", certificate.found)
    };
    for call in &certificate.close_calls {
        let hz = hertz(call.frequency_hz, 1);
        words += &format!(" Close call: the mode at {hz} Hz, σ = {} 1/s.", significant(call.growth_rate, 2));
    }
    words
}

/// What the second method says, in words.
fn second_method(confirmation: &Confirmation) -> String {
    if confirmation.holds() {
        return format!(
            "Two-level Arnoldi on the full order, at {} shifts, finds the same {} modes; largest relative difference {} (condition number {}).",
            confirmation.shifts,
            confirmation.confirmed,
            power(confirmation.largest_difference),
            significant(confirmation.condition, 3)
        );
    }
    let list = |all: &[c64]| -> String {
        let hz: Vec<String> = all.iter().map(|z| hertz(z.im / std::f64::consts::TAU, 2)).collect();
        if hz.is_empty() { "none".into() } else { hz.join(", ") }
    };
    format!(
        "THE TWO METHODS DISAGREE. Found only by two-level Arnoldi [Hz]: {}; only by the projection [Hz]: {}.",
        list(&confirmation.missed),
        list(&confirmation.unconfirmed)
    )
}

/// What a mode answers to, the scalar that moves its growth rate most first. The derivatives proper are the last two
/// columns.
pub(super) fn sensitivity(mode: &ModeSensitivity) -> Table {
    let hz = hertz(mode.eigenvalue.im / TAU, 1);
    let caption = format!("What the mode at {hz} Hz, σ = {} 1/s, answers to", rate(mode.eigenvalue));
    let mut table = Table::of(caption, &mode.rates(), false);
    table.notes.push(
        "The steady state follows every scalar. Error: of dλ/dp, relative; dσ/dp, df/dp: per SI unit.".into(),
    );
    if mode.parameters.iter().any(|p| p.kink) {
        table.notes.push("†: the slopes to the two sides differ; their mean is given.".into());
    }
    table
}

/// The best places for a mass and a damper, one row each.
pub(super) fn advice(result: &SensitivityResult) -> Table {
    let headings =
        ["f [Hz]", "σ [1/s]", "<mount", "<at x, y, z [mm]", "<along", "by slope", "done", "slope error"];
    let mut table =
        Table::new("What would calm the modes: σ with a thing mounted at its best place", &headings);
    for mode in &result.modes {
        for thing in &mode.best {
            let amount = if thing.kind == "mass" {
                format!("{} g", given(1e3 * thing.amount))
            } else {
                format!("{} {} {}", thing.kind, given(thing.amount), thing.unit)
            };
            let sigma = |d: c64| rate(mode.eigenvalue + d);
            let cells = vec![
                hertz(mode.eigenvalue.im / TAU, 1),
                rate(mode.eigenvalue),
                amount,
                thing.position.map(|c| fixed(1e3 * c, 1)).join(", "),
                thing.direction.map_or(String::new(), axis),
                sigma(thing.predicted),
                thing.done.map_or("–".into(), sigma),
                thing.slope_error.map_or("–".into(), power),
            ];
            table.row(cells, false);
        }
    }
    table
        .notes
        .push("By slope: to first order; done: mounted on the model and everything computed anew.".into());
    table.notes.push(
        "Slope error: how far a thousandth of the thing, really mounted, is from the slope, relative.".into(),
    );
    table
}

/// An axis by its name, any other direction as the surface's normal.
fn axis(direction: [f64; 3]) -> String {
    let named = [([1.0, 0.0, 0.0], "x"), ([0.0, 1.0, 0.0], "y"), ([0.0, 0.0, 1.0], "z")];
    named.iter().find(|(axis, _)| *axis == direction).map_or("normal", |(_, name)| name).to_string()
}

/// The scalars without a derivative, as a note.
pub(super) fn left_out(result: &SensitivityResult) -> Table {
    let mut table = Table::new("", &[]);
    table.notes.extend(result.left_out.iter().map(|(path, why)| format!("{path} is left out: {why}.")));
    table
}

/// Whether a computed frequency is that of a measured squeal.
fn near(computed: f64, measured: f64) -> bool {
    (computed / measured - 1.0).abs() <= SQUEAL_TOLERANCE
}

/// The measured squeal frequency that `hz` is taken for.
pub(super) fn nearest_squeal(result: &ComplexResult, hz: f64) -> Option<f64> {
    let all = result
        .measured_squeal_hz
        .iter()
        .map(|(measured, _)| *measured)
        .filter(|measured| near(hz, *measured));
    all.min_by(|a, b| (hz / a - 1.0).abs().total_cmp(&(hz / b - 1.0).abs()))
}

/// The verdict in one sentence.
pub(super) fn verdict(results: &RunResults) -> String {
    let Some(complex) = &results.complex else {
        return "No complex eigenvalues were asked for: this run says nothing about squeal.".into();
    };
    let band = complex.band_hz.map(given);
    let modes = &complex.modes.modes;
    let count = |verdict| modes.iter().filter(|m| m.verdict() == verdict).count();
    let (unstable, undecided, inaccurate) =
        (count(Verdict::Unstable), count(Verdict::Undecided), count(Verdict::Inaccurate));
    let between = format!("between {} and {} Hz", band[0], band[1]);
    let mut doubt = match undecided {
        0 => String::new(),
        1 => " The growth rate of 1 is within its error.".into(),
        n => format!(" The growth rates of {n} are within their errors."),
    };
    if inaccurate > 0 {
        doubt += &format!(
            " {inaccurate} {} not accurate: neither stable nor unstable.",
            if inaccurate == 1 { "is" } else { "are" }
        );
    }
    match (modes.len(), unstable) {
        (0, _) => format!("No complex mode was found {between}: this run says nothing about squeal there."),
        (all, 0) if undecided + inaccurate > 0 => {
            format!("Undecided: none of the {all} complex modes {between} grows for certain.{doubt}")
        }
        (all, 0) => format!("Stable: none of the {all} complex modes {between} grows."),
        (all, 1) => format!("Unstable: 1 of {all} complex modes {between} grows.{doubt}"),
        (all, n) => format!("Unstable: {n} of {all} complex modes {between} grow.{doubt}"),
    }
}

/// Where the wall time went.
pub(super) fn timings(results: &RunResults) -> Table {
    let mut table = Table::new("Wall time", &["<phase", "seconds"]);
    for (phase, seconds) in &results.timings {
        table.row(vec![phase.clone(), significant(*seconds, 3)], false);
    }
    let total: f64 = results.timings.iter().map(|(_, seconds)| seconds).sum();
    table.row(vec!["all".into(), significant(total, 3)], true);
    table
}
