//! Results of a sweep or a map, in words and tables.

use crate::report::format::{fixed, given, hertz, power, signed, significant};
use crate::report::table::ReportTable;
use crate::results::{DampingVerdicts, MapResult, SweepMethod, SweepResult};
use crate::stability::unstable;
use crate::sweep::{CriticalKind, InteractionKind};
use std::f64::consts::TAU;

/// Interactions that are named one by one.
const NAMED: usize = 6;

pub(super) fn with_unit(value: f64, unit: &str) -> String {
    let number = given(value);
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

fn method(method: SweepMethod) -> String {
    match method {
        SweepMethod::Reduced(dimension) => {
            format!("One reduced model of {dimension} degrees of freedom served every point.")
        }
        SweepMethod::Whole => {
            "The scalar changes the structure or the contact's directions: every point was a whole analysis."
                .into()
        }
    }
}

pub(super) fn list(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

/// Results of the sweep.
pub(in crate::report) fn sweep_words(result: &SweepResult) -> Vec<String> {
    let (sweep, unit) = (&result.sweep, result.unit.as_str());
    let grows = |b: &&crate::sweep::Branch| b.growing().any(|grows| grows);
    let ever: Vec<_> = sweep.branches.iter().filter(grows).collect();
    let (answered, without) = (sweep.answered().count(), sweep.unanswered.len());
    let all: Vec<String> = ever
        .iter()
        .filter(|b| b.eigenvalues.len() == answered)
        .filter(|b| b.growing().all(|grows| grows))
        .map(|b| format!("{} Hz", hertz(b.eigenvalues[0].im / TAU, 0)))
        .collect();
    let mut words = Vec::new();
    if !all.is_empty() {
        let values = if without > 0 { "value with an answer" } else { "value" };
        words.push(format!("Unstable at every {values}: {}.", list(&all)));
    }
    let change = |rises: bool| -> Vec<String> {
        let those = sweep.critical.iter().filter(|c| c.rises == rises);
        those
            .map(|c| {
                let what = match c.kind {
                    CriticalKind::Merging => ", where two frequencies merge",
                    CriticalKind::Growth => "",
                    CriticalKind::Divergence => ", without oscillation",
                };
                let hz = hertz(c.eigenvalue.im / TAU, 0);
                format!("{hz} Hz at {}{what}", with_unit(c.value, unit))
            })
            .collect()
    };
    for (rises, begin) in [(true, "Modes become unstable"), (false, "Modes become stable")] {
        let those = change(rises);
        if !those.is_empty() {
            words.push(format!("{begin}: {}.", list(&those)));
        }
    }
    let meet = |kind: InteractionKind| -> Vec<String> {
        let mut those: Vec<_> = sweep.interactions.iter().filter(|e| e.kind == kind).collect();
        // The nearest ones are named; they stand in the order of the sweep when all are.
        if those.len() > NAMED {
            those.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        }
        those
            .iter()
            .map(|e| format!("near {} Hz at {}", hertz(e.frequency_hz, 0), with_unit(e.value, unit)))
            .collect()
    };
    for (kind, begin) in
        [(InteractionKind::Veering, "Frequencies veer"), (InteractionKind::Crossing, "Frequencies cross")]
    {
        let mut those = meet(kind);
        let more = those.len().saturating_sub(NAMED);
        if more > 0 {
            those.truncate(NAMED);
            those.push(format!("at {more} more places"));
        }
        if !those.is_empty() {
            words.push(format!("{begin} {}.", list(&those)));
        }
    }
    let lowest = sweep.branches.iter().map(|b| b.lowest_mac).fold(1.0, f64::min);
    words.push(format!(
        "{}{} The least MAC of neighbouring shapes along a branch is {}.",
        method(result.method),
        measured(result.sample.iter().map(|(_, error)| *error), "values"),
        fixed(lowest, 2)
    ));
    words
}

/// The largest of the errors that were measured at some values or places.
fn measured(errors: impl ExactSizeIterator<Item = f64>, at: &str) -> String {
    match errors.len() {
        0 => String::new(),
        count => format!(
            " The largest error of an eigenvalue, measured on the full order at {count} {at}, is {}.",
            power(errors.fold(0.0, f64::max))
        ),
    }
}

/// The critical values of a sweep.
pub(in crate::report) fn critical_table(result: &SweepResult) -> ReportTable {
    let unit = if result.unit.is_empty() { String::new() } else { format!(" [{}]", result.unit) };
    let caption = format!("Sweep {}: critical values of {}{unit}", result.name, result.parameter);
    let mut table = ReportTable::of(caption, &result.critical_table(), false);
    table.alarming = true;
    let rows = table.rows.iter_mut().zip(&result.sweep.critical);
    rows.for_each(|(row, critical)| row.marked = critical.rises);
    if result.sweep.critical.is_empty() {
        let grows = result.sweep.branches.iter().any(|b| b.growing().any(|grows| grows));
        let words = match grows {
            true => {
                "No mode that is followed becomes unstable or stable in this range; those that grow begin, end or stay unstable."
            }
            false if result.sweep.broken() > 0 => {
                "No mode that is followed becomes unstable or stable in this range."
            }
            false => "No mode becomes unstable or stable in this range.",
        };
        table.notes.push(words.into());
    } else {
        let count = result.sweep.critical.len();
        let largest = (0..count).map(|k| result.value_error(k)).fold(0.0, f64::max);
        table.notes.push(format!("Largest estimated relative error of a critical value {}.", power(largest)));
        let wide = result.sweep.critical.iter().filter(|c| c.wide).count();
        if wide > 0 {
            table.notes.push(format!(
                "The search came to its limit of solutions: {wide} of {count} critical values are known less exactly than aimed at. More points of the sweep, or a narrower range, give them exactly."
            ));
        }
    }
    let broken = result.sweep.broken();
    if broken > 0 {
        table.notes.push(format!(
            "{broken} of {} modes begin or end between two values, where they enter or leave the band or change too much: critical values \
             there may be none. More points, or a wider `cea.band`, follow them.",
            result.sweep.branches.len()
        ));
    }
    let doubtful = result.sweep.doubtful_steps;
    if doubtful > 0 {
        table.notes.push(format!(
            "The sweep came to its limit of solutions: in {doubtful} of {} steps it is doubtful which mode goes on as which; critical values there may be none. More points of the sweep, or a narrower range, settle it.",
            result.sweep.values.len() - 1
        ));
    }
    table
}

/// The errors of the critical values, where there are any.
pub(in crate::report) fn critical_proof(result: &SweepResult) -> Option<ReportTable> {
    let caption = format!("Proof: errors of the critical values of sweep {}", result.name);
    let mut table = ReportTable::proof_of(caption, &result.critical_table(), false, &["value", "f [Hz]"]);
    table.notes.push("η and |Δλ|/|λ|: backward and eigenvalue error, measured at full order.".into());
    (!table.rows.is_empty()).then_some(table)
}

/// Results of the map.
pub(in crate::report) fn map_words(result: &MapResult) -> Vec<String> {
    let mut words = Vec::new();
    let line = match result.boundary.points.len() {
        0 => "No boundary of stability crosses the map.".to_string(),
        points => format!("The boundary of stability was located at {points} places."),
    };
    let checked = measured(result.sample.iter().map(|(_, error)| *error), "places");
    words.push(format!("{line} {}{checked}", method(result.method)));
    words
}

/// Which verdicts the modal damping decides.
pub(in crate::report) fn damping_table(verdicts: &DampingVerdicts) -> ReportTable {
    let percent = |ratio: f64| format!("{} %", significant(100.0 * ratio, 4));
    let caption = format!(
        "Verdicts that damping decides between {} and {}, the case having {}",
        percent(verdicts.range[0]),
        percent(verdicts.range[1]),
        percent(verdicts.ratio)
    );
    let headings = ["f [Hz]", "σ [1/s]", "<verdict", "critical damping ratio [%]", "of the case's"];
    let mut table = ReportTable::new(caption, &headings);
    table.alarming = true;
    for row in &verdicts.rows {
        let grows = unstable(row.eigenvalue);
        let Some(critical) = row.critical_ratio else { continue };
        let cells = vec![
            hertz(row.eigenvalue.im / TAU, 1),
            signed(row.eigenvalue.re, 2),
            if grows { "unstable, stable above".into() } else { "stable, unstable below".into() },
            significant(100.0 * critical, 5),
            format!("{} ×", fixed(critical / verdicts.ratio, 3)),
        ];
        table.row(cells, grows);
    }
    let firm = verdicts.rows.iter().filter(|r| r.critical_ratio.is_none() && unstable(r.eigenvalue));
    let firm: Vec<String> = firm.map(|r| format!("{} Hz", hertz(r.eigenvalue.im / TAU, 0))).collect();
    if table.rows.is_empty() {
        table.notes.push("No verdict flips in this range.".into());
    }
    if !firm.is_empty() {
        table.notes.push(format!("Unstable whatever the damping in this range: {}.", list(&firm)));
    }
    table
}
