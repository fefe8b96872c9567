//! `part_shares.svg` and the tables of modes as reports on noise have them: frequency, damping, nodal diameters and circles, the shares of the
//! parts in the energies and the damping, and the mode of the part alone that it is.

use super::chart::WIDTH;
use super::colours::{ALARM_TEXT, INK, MUTED};
use super::format::{fixed, hertz, signed};
use super::html::described;
use super::participation::{FILLS, OTHERS, chosen};
use super::section::Picture;
use super::svg::{Key, Sheet, fill, ink, outlined};
use super::table::{ReportColumn, ReportTable};
use crate::modal::DiscModeName;
use crate::results::{ComplexResult, MODAL, NamedModes, POINTS, PartShare, PartShares, file_name};

/// Parts with columns and colours of their own; the others are one.
const MOST: usize = 8;
const OTHER_PARTS: &str = "others";
const LEFT: f64 = 206.0;
const LENGTH: f64 = WIDTH - LEFT - 24.0;
const ROW: f64 = 74.0;
const BAR: f64 = 17.0;
/// A label needs this width \[px\].
const LABEL: f64 = 34.0;

/// What a share is of.
type Kind = (&'static str, fn(&PartShare) -> Option<f64>);

const KINDS: [Kind; 3] = [
    ("kinetic", |share| share.kinetic),
    ("strain", |share| share.strain),
    ("damping", |share| share.damping),
];

/// The parts with the largest shares, in the order of the results, and those that are the others.
fn columns(shares: &PartShares) -> (Vec<usize>, Vec<usize>) {
    let largest = |p: usize| {
        let all = shares.modes.iter().flat_map(|mode| KINDS.iter().filter_map(move |(_, of)| of(&mode[p])));
        all.fold(0.0, f64::max)
    };
    let mut all: Vec<usize> = (0..shares.parts.len()).collect();
    let most = if all.len() > MOST { MOST - 1 } else { MOST };
    all.sort_by(|a, b| largest(*b).total_cmp(&largest(*a)));
    let mut others = all.split_off(most.min(all.len()));
    all.sort_unstable();
    others.sort_unstable();
    (all, others)
}

/// Whether there are parts to share between.
fn several(shares: &PartShares) -> bool {
    shares.parts.iter().filter(|part| ![POINTS, MODAL].contains(&part.as_str())).count() > 1
}

/// The sum of the shares of some parts; `None` where there are none.
fn sum(shares: &[PartShare], parts: &[usize], of: fn(&PartShare) -> Option<f64>) -> Option<f64> {
    parts.iter().map(|p| of(&shares[*p])).sum()
}

/// A mode of a table: frequency, damping, name of the disc's motion, and whether it is marked.
struct Mode {
    before: Vec<String>,
    disc: Option<DiscModeName>,
    marked: bool,
}

/// The table of some modes: `headings` are of what stands before the names and the shares.
fn table(caption: String, headings: &[&'static str], modes: Vec<Mode>, shares: &PartShares) -> ReportTable {
    let mut table = ReportTable::new(caption, headings);
    let discs = modes.iter().any(|mode| mode.disc.is_some());
    let alone = (0..modes.len()).any(|k| shares.part_mode(k).is_some());
    let mut column =
        |heading: String, words| table.columns.push(ReportColumn { heading: heading.into(), words });
    if discs {
        column("(n, s)".into(), false);
    }
    if alone {
        column("mode of a part alone (MAC)".into(), true);
    }
    let (own, others) = columns(shares);
    let mut groups: Vec<Vec<usize>> = own.iter().map(|p| vec![*p]).collect();
    own.iter().for_each(|p| column(format!("{} [%]", shares.parts[*p]), false));
    if !others.is_empty() {
        column(format!("{OTHER_PARTS} [%]"), false);
        groups.push(others);
    }
    let damped = shares.modes.iter().flatten().any(|share| share.damping.is_some());
    let kinds = if damped { &KINDS[..] } else { &KINDS[..2] };
    for (k, mode) in modes.into_iter().enumerate() {
        let mut cells = mode.before;
        if discs {
            let name = mode.disc.map(|n| format!("({}, {})", n.nodal_diameters, n.nodal_circles));
            cells.push(name.unwrap_or("–".into()));
        }
        if alone {
            let name = shares.part_mode(k).map(|mode| format!("{} ({})", mode.name, fixed(mode.mac, 2)));
            cells.push(name.unwrap_or("–".into()));
        }
        cells.extend(groups.iter().map(|parts| {
            let percent = |(_, of): &Kind| {
                sum(&shares.modes[k], parts, *of).map_or("–".into(), |share| fixed(100.0 * share, 0))
            };
            kinds.iter().map(percent).collect::<Vec<_>>().join(" / ")
        }));
        table.row(cells, mode.marked);
    }
    let kinds: Vec<&str> = kinds.iter().map(|(name, _)| *name).collect();
    let of = kinds.join(" / ").replace("kinetic", "kinetic energy").replace("strain", "strain energy");
    let contact = "of the structure, without contacts";
    table.notes.push(format!("Shares of the parts in {of}, {contact}, in percent."));
    if discs {
        table.notes.push("(n, s): nodal diameters and circles of the disc.".into());
    }
    if alone {
        let note = "Mode of a part alone: of the sets of real modes of parts, by kinetic energy times MAC at the part's nodes.";
        table.notes.push(note.into());
    }
    table
}

/// That of a set of real modes of several parts.
pub(super) fn real_table(set: &NamedModes) -> Option<ReportTable> {
    let shares = set.shares.as_ref().filter(|shares| several(shares) && !set.modes.is_empty())?;
    let mode = |k: usize| {
        let ratio = set.damping_ratio.get(k).map_or("–".into(), |ratio| fixed(100.0 * ratio, 3));
        let before = vec![(k + 1).to_string(), hertz(set.modes.frequency_hz(k), 1), ratio];
        Mode { before, disc: set.names.get(k).copied().flatten(), marked: false }
    };
    let caption = format!("Shares of the parts in the real modes: {}", set.name);
    let modes = (0..set.modes.len()).map(mode).collect();
    let mut table = table(caption, &["no.", "f [Hz]", "ζ [%]"], modes, shares);
    table.file = Some(file_name("mode_parts", &set.name));
    Some(table)
}

/// That of the complex modes, unstable ones marked.
pub(super) fn complex_table(complex: &ComplexResult) -> Option<ReportTable> {
    let shares = complex.shares.as_ref().filter(|_| !complex.modes.modes.is_empty())?;
    let modes = complex.modes.modes.iter().enumerate().map(|(k, mode)| Mode {
        before: vec![
            (k + 1).to_string(),
            hertz(mode.frequency_hz(), 1),
            signed(100.0 * mode.damping_ratio(), 3),
        ],
        disc: complex.discs.get(k).copied().flatten(),
        marked: mode.unstable(),
    });
    let caption = "Shares of the parts in the complex modes".to_string();
    let mut table = table(caption, &["no.", "f [Hz]", "ζ [%]"], modes.collect(), shares);
    table.alarming = true;
    table.file = Some("complex_modes_parts".into());
    Some(table)
}

/// Bars of the shares in the unstable modes or, where there is none, in those nearest to it.
pub(super) fn picture(complex: &ComplexResult) -> Option<Picture> {
    let shares = complex.shares.as_ref().filter(|shares| several(shares))?;
    let modes = chosen(&complex.modes.modes);
    let unstable = modes.first()?.unstable();
    let (own, others) = columns(shares);
    let mut groups: Vec<(&str, &str, Vec<usize>)> =
        own.iter().zip(FILLS).map(|(p, fill)| (&*shares.parts[*p], fill, vec![*p])).collect();
    if !others.is_empty() {
        groups.push((OTHER_PARTS, OTHERS, others));
    }
    let mut sheet = Sheet::new(WIDTH, 0.0);
    let keys = groups.iter().map(|(name, colour, _)| (Key::Box(fill(colour)), (*name).to_string()));
    let head = sheet.keys([LEFT, 10.0], keys) + 12.0;
    let mut seen = Vec::new();
    for (row, mode) in modes.iter().enumerate() {
        let top = head + ROW * row as f64;
        let k = complex.modes.modes.iter().position(|other| std::ptr::eq(other, *mode))?;
        let colour = if mode.unstable() { ALARM_TEXT } else { INK };
        let words = format!("{} Hz", hertz(mode.frequency_hz(), 0));
        sheet.text([96.0, top + 13.0], &words, ink(14.0, colour).bold().end());
        let ratio = format!("ζ {} %", signed(100.0 * mode.damping_ratio(), 2));
        sheet.text([96.0, top + 30.0], &ratio, ink(12.0, MUTED).end());
        if let Some(n) = complex.discs.get(k).copied().flatten() {
            let name = format!("({}, {})", n.nodal_diameters, n.nodal_circles);
            sheet.text([96.0, top + 47.0], &name, ink(12.0, MUTED).end());
        }
        for (line, (kind, of)) in KINDS.iter().enumerate() {
            let y = top + (BAR + 3.0) * line as f64;
            let mut start = LEFT;
            for (_, colour, parts) in &groups {
                let Some(share) = sum(&shares.modes[k], parts, *of) else { continue };
                let length = LENGTH * share.clamp(0.0, 1.0);
                sheet.rectangle([start, y], [length, BAR], &outlined(colour, "#ffffff", 0.8));
                if length >= LABEL {
                    let words = format!("{} %", fixed(100.0 * share, 0));
                    sheet.text([start + 0.5 * length, y + 13.0], &words, ink(11.5, INK).middle());
                }
                start += length;
            }
            if start > LEFT {
                sheet.text([LEFT - 10.0, y + 13.0], kind, ink(12.0, MUTED).end());
            }
        }
        let most = shares.moving_part(k).map(|part| (part, shares.kinetic(k, part)));
        seen.extend(most.map(|(part, share)| format!("{words}: {part} {} %", fixed(100.0 * share, 0))));
    }
    sheet.height = head + ROW * modes.len() as f64;
    let which = if unstable { "each unstable mode" } else { "the modes that die away most slowly" };
    let caption = format!(
        "Shares of the parts in the kinetic energy, the strain energy and the damping of the structure in {which}; (n, s): nodal diameters and \
         circles of the disc."
    );
    let seen = format!("The part with the largest kinetic energy: {}.", seen.join("; "));
    Some(Picture { file: "part_shares".into(), caption, svg: described(&sheet.finish(), &seen) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;
    use crate::report::table::idle;

    #[test]
    fn every_unstable_mode_has_its_bars_and_every_mode_its_row() {
        let results = sample::rig();
        let complex = results.get::<ComplexResult>().unwrap();
        let svg = picture(complex).unwrap().svg;
        let unstable = complex.modes.modes.iter().filter(|mode| mode.unstable()).count();
        assert!(svg.contains("276 Hz") && !svg.contains("NaN") && !svg.contains("632 Hz"), "{svg}");
        assert_eq!(svg.matches(">kinetic<").count(), unstable);
        assert_eq!(svg.matches(">strain<").count(), unstable);
        let table = complex_table(complex).unwrap();
        assert_eq!(table.rows.len(), complex.modes.modes.len());
        assert_eq!(table.rows.iter().filter(|row| row.marked).count(), unstable);
        let headings: Vec<&str> = table.columns.iter().map(|column| &*column.heading).collect();
        assert!(headings.contains(&"disc [%]") && headings.contains(&"(n, s)"), "{headings:?}");
        assert!(table.rows.iter().flat_map(|row| &row.cells).all(|cell| !cell.contains("NaN")));
        assert!(table.rows.iter().any(|row| !idle(row.cells.last().unwrap())));
    }

    #[test]
    fn many_parts_have_columns_for_the_largest_and_the_sum_of_the_others() {
        let share = |kinetic: f64| PartShare { kinetic: Some(kinetic), ..PartShare::default() };
        let parts: Vec<String> = (0..12).map(|k| format!("p{k}")).collect();
        let mode: Vec<PartShare> = (0..12).map(|k| share((k + 1) as f64 / 78.0)).collect();
        let shares = PartShares { parts, modes: vec![mode] };
        let (own, others) = columns(&shares);
        assert_eq!((&own[..], &others[..]), (&[5, 6, 7, 8, 9, 10, 11][..], &[0, 1, 2, 3, 4][..]));
        let rest = sum(&shares.modes[0], &others, |share| share.kinetic).unwrap();
        assert!(within((rest - 15.0 / 78.0).abs(), 1e-14, RoundOff));
        assert_eq!(sum(&shares.modes[0], &others, |share| share.strain), None);
    }
}
