//! Real modes beside the measured frequencies.

use super::finding::{Finding, FindingClass};
use super::format::{fixed, given, hertz, power, signed, significant};
use super::section::{Display, ReportSection};
use super::table::{ReportTable, idle};
use super::{disc_modes, part_shares};
use crate::results::{MeasuredComparison, NamedModes, RunResults, file_name};

/// The sets of real modes.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let sets = results.all::<NamedModes>();
    if sets.is_empty() {
        return Vec::new();
    }
    let measured = !results.all::<MeasuredComparison>().is_empty();
    let heading = if measured { "Real modes beside the measured frequencies" } else { "Real modes" };
    let mut section = ReportSection::new(heading).findings([finding(&sets)]);
    section = section.pictures(disc_modes::picture(results));
    for set in sets {
        section = section.tables(Display::Folded, [table(results, set)]);
        section = section.tables(Display::Closed, part_shares::real_table(set));
        section = section.tables(Display::Proof, [proof(set)]);
    }
    vec![section]
}

/// How many there are, and whether the Sturm count holds for all sets.
fn finding(sets: &[&NamedModes]) -> Finding {
    let range = |set: &NamedModes| match set.modes.len() {
        0 => format!("none of {}", set.name),
        n => format!("{n} of {} up to {} Hz", set.name, hertz(set.modes.frequency_hz(n - 1), 0)),
    };
    let ranges: Vec<String> = sets.iter().map(|set| range(set)).collect();
    let words = format!("Real modes: {}.", ranges.join(", "));
    let wrong: Vec<String> =
        sets.iter().filter(|set| !set.modes.certificate.holds()).map(|set| certificate(set)).collect();
    let unstable: Vec<String> = sets.iter().filter_map(|set| negative(set)).collect();
    match wrong.is_empty() {
        _ if !unstable.is_empty() => {
            Finding::new(FindingClass::Bad, format!("{words} {}", unstable.join(" ")))
        }
        true => Finding::new(FindingClass::Basis, format!("{words} None is missing: as many were counted.")),
        false => Finding::new(FindingClass::Bad, format!("{words} {}", wrong.join(" "))),
    }
}

/// The modes with ω² < 0, in words.
fn negative(set: &NamedModes) -> Option<String> {
    let negative = set.modes.negative;
    let fastest = set.modes.eigenvalues.first().map_or(0.0, |square| (-square).max(0.0).sqrt());
    let [modes, have] = if negative == 1 {
        ["1 mode".into(), "has".to_string()]
    } else {
        [format!("{negative} modes"), "have".to_string()]
    };
    (negative > 0).then(|| {
        format!(
            "Unstable: {modes} of {} {have} ω² < 0; the state is beyond buckling, and is left as exp(σt), σ up to {} 1/s.",
            set.name,
            significant(fastest, 4)
        )
    })
}

/// The backward error of each mode.
fn proof(set: &NamedModes) -> ReportTable {
    let caption = format!("Proof: backward errors of the real modes of {}", set.name);
    let mut table = ReportTable::new(caption, &["no.", "f [Hz]", "η"]);
    table.file = Some(file_name("modes", &set.name));
    for (k, error) in set.modes.backward_errors.iter().enumerate() {
        table.row(vec![(k + 1).to_string(), hertz(set.modes.frequency_hz(k), 1), power(*error)], false);
    }
    table.notes.push("η = ‖Kφ − ω²Mφ‖ / ((‖K‖ + |ω²| ‖M‖) ‖φ‖).".into());
    table
}

/// The modes of a set beside the measured frequencies that were compared with it.
fn table(results: &RunResults, set: &NamedModes) -> ReportTable {
    let comparisons: Vec<_> =
        results.all::<MeasuredComparison>().into_iter().filter(|m| m.is_of(set)).collect();
    let mut headings = vec!["no.", "f [Hz]"];
    // Where several parts move, the one that moves most distinguishes a disc's mode from a slider's.
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
    headings.extend(["m_x [%]", "m_y [%]", "m_z [%]"]);
    let mut table = ReportTable::new(format!("Real modes: {}", set.name), &headings);
    table.file = Some(file_name("modes", &set.name));
    let rows: Vec<_> = comparisons.iter().flat_map(|m| &m.rows).collect();
    for k in 0..set.modes.len() {
        // The frequency of a rigid-body motion is round-off.
        let show = if k < set.modes.rigid_bodies { fixed } else { hertz };
        let frequency =
            if k < set.modes.negative { "ω² < 0".into() } else { show(set.modes.frequency_hz(k), 1) };
        let mut cells = vec![(k + 1).to_string(), frequency];
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
            cells.push(paired.map_or(String::new(), |row| given(row.frequency_hz)));
            cells.push(
                paired.and_then(|row| row.difference_percent()).map_or(String::new(), |d| signed(d, 2)),
            );
        }
        let mass = |axis: usize| set.effective_mass.get(k).map(|m| 100.0 * m[axis] / set.total_mass);
        cells.extend((0..3).map(|axis| mass(axis).map_or("–".into(), |share| fixed(share, 1))));
        table.row(cells, paired.is_some());
    }
    let mut table = table.without_columns(idle);
    let largest = set.modes.backward_errors.iter().copied().fold(f64::NAN, f64::max);
    table.notes.push(format!("{} Largest backward error η {}.", certificate(set), power(largest)));
    for comparison in comparisons {
        table.notes.push(format!("Measured: {}.", comparison.source));
        if comparison.frequency_scale != 1.0 {
            let scale = given(comparison.frequency_scale);
            table
                .notes
                .push(format!("Scaled: computed frequencies times {scale}, an assumption of the case."));
        }
        let alone = comparison.rows.iter().filter(|row| row.computed_hz.is_none());
        let alone: Vec<String> = alone.map(|row| format!("{} Hz", given(row.frequency_hz))).collect();
        if !alone.is_empty() {
            table.notes.push(format!("Measured without a computed mode beside it: {}.", alone.join(", ")));
        }
    }
    if named {
        table.notes.push("(n, s): nodal diameters and circles.".into());
    }
    table.notes.push("m: effective mass, share of the total.".into());
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
