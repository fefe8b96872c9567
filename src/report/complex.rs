//! Complex eigenvalues, what the count and the second method say of them, and the verdict.

use super::finding::{Finding, FindingClass};
use super::format::{fixed, given, hertz, power, rate, signed, significant};
use super::section::{Display, ReportSection};
use super::squeal::{SQUEAL_TOLERANCE, near, nearest_squeal};
use super::table::{ReportTable, idle};
use super::{budget, growth, part_shares, participation};
use crate::linalg::c64;
use crate::results::{ComplexResult, RunResults};
use crate::stability::{Certificate, ComplexMode, Confirmation, Verdict};

/// Complex eigenvalues, where the run has them.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let Some(complex) = results.get::<ComplexResult>() else { return Vec::new() };
    let pictures = [growth::picture(results), budget::picture(results), participation::picture(results)];
    let section = ReportSection::new("Complex eigenvalues").findings([finding(complex)]);
    let section = section.pictures(pictures.into_iter().flatten()).tables(Display::Titled, [table(complex)]);
    let section = section.pictures(part_shares::picture(complex));
    let section = section.tables(Display::Closed, part_shares::complex_table(complex));
    vec![section.tables(Display::Proof, [proof(complex)])]
}

/// The complex eigenvalues, unstable ones marked.
fn table(result: &ComplexResult) -> ReportTable {
    let mut table = ReportTable::of("Complex eigenvalues at steady sliding", &result.mode_table(), true);
    table.alarming = true;
    for (row, mode) in table.rows.iter_mut().zip(&result.modes.modes) {
        row.marked = matches!(mode.verdict(), Verdict::Unstable | Verdict::Inaccurate);
    }
    let mut table = table.without_columns(idle);
    let largest = |of: fn(&ComplexMode) -> f64| result.modes.modes.iter().map(of).fold(f64::NAN, f64::max);
    if !table.rows.is_empty() {
        table.notes.push("σ: growth rate; ζ = −σ/|λ|: damping ratio, negative when unstable.".into());
        table.notes.push(format!(
            "Largest backward error η {}, eigenvalue error |Δλ|/|λ| {}, condition number κ {}.",
            power(largest(|mode| mode.backward_error)),
            power(largest(|mode| mode.eigenvalue_error)),
            significant(largest(|mode| mode.condition), 2)
        ));
        if result.contact_closed {
            table.notes.push("The real modes are those with the contact closed as in steady sliding.".into());
        }
        table.notes.extend(result.modal_damping_below_hz.map(|hz| {
            format!(
                "Modal damping: of the real modes up to {} Hz (`damping.modal_below`); modes above have none, and σ depends on that limit as far as they take part.",
                given(hz)
            )
        }));
    }
    table.notes.extend(result.confirmation.as_ref().map(second_method));
    table
}

/// The errors of each mode.
fn proof(result: &ComplexResult) -> ReportTable {
    let caption = "Proof: backward errors, eigenvalue errors and condition numbers of the complex modes";
    let mut table = ReportTable::proof_of(caption, &result.mode_table(), true, &["f [Hz]"]);
    let words = "η: backward error; |Δλ|/|λ|: estimated eigenvalue error; κ: condition number.";
    table.notes.push(words.into());
    table
}

/// What is said of modes whose growth vanishes without the split of double modes.
const BY_MESH: &str = "unstable only by the asymmetry of the mesh";
const WITHOUT_SPLIT: &str = "No mesh split: σ, to first order, if the mesh did not part the double modes of the disc, a body of revolution; where it equals σ, the mesh has no part in the growth";

/// The unstable modes, the strongest growth first, with the nearest measured squeal.
fn unstable(result: &ComplexResult) -> ReportTable {
    let split = result.without_split.iter().any(Option::is_some);
    let without = split.then_some("no mesh split [1/s]");
    let headings = ["f [Hz]", "growth rate σ [1/s]"].into_iter().chain(without);
    let headings = headings.chain(["damping ratio [%]", "grows tenfold in [ms]", "<measured squeal"]);
    let mut table = ReportTable::new("Unstable modes", &headings.collect::<Vec<_>>());
    table.alarming = true;
    let mut modes: Vec<_> = result.modes.modes.iter().enumerate().filter(|(_, m)| m.unstable()).collect();
    modes.sort_by(|(_, a), (_, b)| b.growth_rate().total_cmp(&a.growth_rate()));
    for (k, mode) in modes {
        let hz = mode.frequency_hz();
        let squeal = match nearest_squeal(result, hz) {
            Some(measured) => {
                let difference = signed(100.0 * (hz / measured - 1.0), 1);
                format!("{} Hz ({difference} %)", given(measured))
            }
            None if result.measured_squeal_hz.is_empty() => "no measurement given".into(),
            None => format!("none within {} %", fixed(100.0 * SQUEAL_TOLERANCE, 0)),
        };
        let mut cells = vec![hertz(hz, 1), rate(mode.eigenvalue)];
        if split {
            let alone = if result.unstable_by_mesh(k) { " (mesh alone)" } else { "" };
            let words = |growth| rate(c64::new(growth, mode.eigenvalue.im)) + alone;
            cells.push(result.growth_without_split(k).map_or("–".into(), words));
        }
        cells.extend([
            signed(100.0 * mode.damping_ratio(), 3),
            significant(1e3 * 10_f64.ln() / mode.growth_rate(), 3),
            squeal,
        ]);
        table.row(cells, true);
    }
    if split {
        let by_mesh = (0..result.modes.modes.len()).any(|k| result.unstable_by_mesh(k));
        let alone = if by_mesh { format!("; mesh alone: {BY_MESH}") } else { String::new() };
        table.notes.push(format!("{WITHOUT_SPLIT}{alone}."));
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
    table
        .notes
        .extend(result.certificate.as_ref().map(|certificate| counted(certificate, result.band_hz[0])));
    table
}

/// Count of the unstable eigenvalues, in words, of a band that begins at `lowest` \[Hz\].
fn counted(certificate: &Certificate, lowest: f64) -> String {
    let ([low, high], [slow, fast]) = (certificate.band_hz, certificate.growth);
    let faster = match certificate.nothing_faster {
        true => format!("σ > {} 1/s", significant(slow, 2)),
        false => format!("σ from {} to {} 1/s", significant(slow, 2), significant(fast, 2)),
    };
    let region = format!("between {} and {} Hz with {faster}", given(low), hertz(high, 0));
    let with_conjugates = match (low, lowest) {
        (0.0, _) => " (conjugates included)",
        (_, 0.0) => {
            " (loss factors have no meaning at 0 Hz, so that nothing is counted below a thousandth of the band)"
        }
        _ => "",
    };
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
            "{count} were counted, as many as were found; that the count holds at full order is not shown{}.",
            if certificate.dissipative { "" } else { ", as the damping is not known to dissipate" }
        )
    } else {
        format!("A MODE WAS MISSED: {count} were counted, {} found.", certificate.found)
    };
    if !certificate.nothing_faster {
        words += " That no mode grows faster is not shown.";
    }
    for call in &certificate.close_calls {
        let hz = hertz(call.frequency_hz, 1);
        words += &format!(" Close call: the mode at {hz} Hz, σ = {} 1/s.", significant(call.growth_rate, 2));
    }
    words
}

/// Results of the second method, in words.
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

/// What an eigenvalue of zero stands for.
const ZERO_CAUSES: &str = "rigid-body motion, a drift, or the onset of divergence";

/// Whether the premises of a statement on stability hold, as far as they were examined.
fn premises_hold(result: &ComplexResult) -> bool {
    result.modes.broken_premise.is_none() && result.certificate.as_ref().is_none_or(|c| c.dissipative)
}

/// Whether any mode grows, and whether the count and the second method agree. A stable result is good only where as many
/// modes were counted as were found.
fn finding(result: &ComplexResult) -> Finding {
    let band = result.band_hz.map(given);
    let modes = &result.modes.modes;
    let count = |verdict| modes.iter().filter(|m| m.verdict() == verdict).count();
    let (unstable, undecided, inaccurate) =
        (count(Verdict::Unstable), count(Verdict::Undecided), count(Verdict::Inaccurate));
    let between = format!("between {} and {} Hz", band[0], band[1]);
    let mut doubt = match undecided {
        0 => String::new(),
        1 => " The growth rate of 1 is within its error.".into(),
        n => format!(" The growth rates of {n} are within their errors."),
    };
    let zero = modes.iter().filter(|m| m.is_zero()).count();
    let zeros = match zero {
        0 => String::new(),
        1 => " 1 eigenvalue is zero but for rounding".into(),
        n => format!(" {n} eigenvalues are zero but for rounding"),
    };
    if zero > 0 {
        doubt += &format!("{zeros}: {ZERO_CAUSES}.");
    }
    if inaccurate > 0 {
        let are = if inaccurate == 1 { "is" } else { "are" };
        doubt += &format!(" {inaccurate} {are} not accurate: neither stable nor unstable.");
    }
    let counted = result.certificate.as_ref().map(Certificate::agrees);
    let (mut class, mut words) = match (modes.len(), unstable) {
        (0, _) => (FindingClass::Attention, format!("No complex mode was found {between}.")),
        (all, 0) if undecided == zero && zero > 0 && inaccurate == 0 => {
            let words = format!("None of the {all} complex modes {between} grows.{zeros}: {ZERO_CAUSES}.");
            (FindingClass::Neutral, words)
        }
        (all, 0) if undecided + inaccurate > 0 => {
            let words =
                format!("Undecided: none of the {all} complex modes {between} grows for certain.{doubt}");
            (FindingClass::Attention, words)
        }
        (all, 0) if !premises_hold(result) => {
            (FindingClass::Neutral, format!("None of the {all} complex modes found {between} grows."))
        }
        (all, 0) => {
            let class = if counted == Some(true) { FindingClass::Good } else { FindingClass::Neutral };
            (class, format!("Stable: none of the {all} complex modes {between} grows."))
        }
        (all, 1) => {
            (FindingClass::Bad, format!("Unstable: 1 of {all} complex modes {between} grows.{doubt}"))
        }
        (all, n) => {
            (FindingClass::Bad, format!("Unstable: {n} of {all} complex modes {between} grow.{doubt}"))
        }
    };
    let by_mesh = (0..modes.len()).filter(|k| result.unstable_by_mesh(*k)).count();
    if by_mesh > 0 {
        let are = if by_mesh == 1 { "is" } else { "are" };
        words += &format!(
            " {by_mesh} {are} {BY_MESH} of the disc, which parts its double modes: try a finer or a symmetric mesh."
        );
    }
    match counted {
        Some(true) => {}
        Some(false) => {
            class = FindingClass::Bad;
            words += " A mode was missed.";
        }
        None => words += " That none was missed is not shown: they were not counted.",
    }
    if let Some(broken) = result.modes.broken_premise {
        if class != FindingClass::Bad {
            class = FindingClass::Attention;
        }
        words += &format!(" Nothing is said about stability, as {broken}.");
    }
    if result.confirmation.as_ref().is_some_and(|second| !second.holds()) {
        class = FindingClass::Bad;
        words += " The two methods disagree.";
    }
    let table = self::unstable(result);
    let table = (!table.rows.is_empty() || !table.notes.is_empty()).then_some(table);
    Finding { class, words, table }
}
