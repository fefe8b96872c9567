//! `modes_disc.svg`: every bending mode of the disc face-on, its nodal lines, and the measured frequency beside it.

use super::colours::{INK, MEASURED, MUTED};
use super::contours::at_least;
use super::format::{given, hertz, signed};
use super::plate::{PlateView, colour_bar};
use super::section::Picture;
use super::svg::{Sheet, SvgPoint, ink, outlined, stroke};
use super::view::{PlacedView, dot};
use crate::modal::{DiscModeName, levels};
use crate::results::{Geometry, MeasuredComparison, MeasuredRow, NamedModes, RunResults};
use std::ops::Range;

const MOST_COLUMNS: usize = 5;
const MOST: usize = 30;
const CELL: [f64; 2] = [196.0, 226.0];
const MARGIN: f64 = 14.0;
const FOOT: f64 = 62.0;

/// The picture, when a set of modes has named ones.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let set = chosen_set(results)?;
    let disc = DiscPicture::new(&results.geometry, set)?;
    let groups = groups(set);
    let comparisons = results.all::<MeasuredComparison>().into_iter().filter(|m| m.is_of(set));
    let rows: Vec<&MeasuredRow> = comparisons.clone().flat_map(|m| &m.rows).collect();
    let scale = comparisons.map(|m| m.frequency_scale).next();
    let shown = &groups[..groups.len().min(MOST)];
    let lines = shown.len().div_ceil(MOST_COLUMNS);
    let columns = shown.len().div_ceil(lines);
    let foot = lines as f64 * CELL[1] + 0.5 * MARGIN;
    let mut sheet = Sheet::new(columns.max(4) as f64 * CELL[0] + 2.0 * MARGIN, foot + FOOT);
    for (k, group) in shown.iter().enumerate() {
        let corner = [MARGIN + (k % columns) as f64 * CELL[0], 0.5 * MARGIN + (k / columns) as f64 * CELL[1]];
        let row = rows.iter().copied().find(|row| row.mode.is_some_and(|mode| group.modes.contains(&mode)));
        draw_mode(&mut sheet, corner, &disc, set, group, (row, scale));
    }
    draw_legend(&mut sheet, foot, scale);
    let more = if groups.len() > shown.len() { format!("; the first {MOST}") } else { String::new() };
    let caption = format!(
        "Bending modes ({}) by (nodal diameters, nodal circles); ×2: two modes at one frequency{more}.",
        set.name
    );
    Some(Picture { file: "modes_disc".into(), caption, svg: sheet.finish() })
}

/// The set with measured frequencies, or the first, among those whose modes have names.
fn chosen_set(results: &RunResults) -> Option<&NamedModes> {
    let sets = results.all::<NamedModes>();
    let mut named = sets.into_iter().filter(|set| set.names.iter().any(Option::is_some));
    let tests = results.all::<MeasuredComparison>();
    let measured = named.clone().find(|set| tests.iter().any(|test| test.is_of(set)));
    measured.or_else(|| named.next())
}

/// A mode that has a name, or the two of a double one.
struct ModeGroup {
    name: DiscModeName,
    modes: Range<usize>,
}

fn groups(set: &NamedModes) -> Vec<ModeGroup> {
    let hz: Vec<f64> = (0..set.modes.len()).map(|k| set.modes.frequency_hz(k)).collect();
    let named = |modes: Range<usize>| Some(ModeGroup { name: set.names[modes.start]?, modes });
    levels(&hz, &set.names).into_iter().filter_map(named).collect()
}

/// The disc seen along its axis.
struct DiscPicture {
    plate: PlateView,
    /// Nodes at rest in every mode: a clamped hub.
    held: Vec<bool>,
}

impl DiscPicture {
    fn new(geometry: &Geometry, set: &NamedModes) -> Option<Self> {
        let part = disc_part(geometry, set)?;
        let plate = PlateView::new(geometry, part)?;
        let mut disc = DiscPicture { held: vec![true; plate.nodes.len()], plate };
        for k in 0..set.modes.len() {
            let w = disc.deflection(&set.shape(k));
            disc.held.iter_mut().zip(&w).for_each(|(held, w)| *held &= w.abs() < 1e-6);
        }
        Some(disc)
    }

    /// The triangles in which the zero of w is a nodal line. Along a clamped hub w is zero too, and next to it
    /// nothing but round-off.
    fn lively(&self, w: &[f64]) -> Vec<[usize; 3]> {
        let held = |t: &[usize; 3]| t.iter().filter(|k| self.held[**k]).count() >= 2;
        let moves = |t: &[usize; 3]| t.iter().any(|k| w[*k].abs() > 1e-3);
        self.plate.triangles.iter().filter(|t| moves(t) && !held(t)).copied().collect()
    }

    /// Displacement along the axis, scaled to 1 at its largest.
    fn deflection(&self, shape: &[[f64; 6]]) -> Vec<f64> {
        let w: Vec<f64> = self
            .plate
            .nodes
            .iter()
            .map(|k| dot([shape[*k][0], shape[*k][1], shape[*k][2]], self.plate.normal))
            .collect();
        let largest = w.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(1.0);
        let scale = if largest == 0.0 || !largest.is_finite() { 1.0 } else { largest };
        w.iter().map(|w| w / scale).collect()
    }
}

/// The part that bears the set's name, or the plate that moves most in its modes.
fn disc_part(geometry: &Geometry, set: &NamedModes) -> Option<usize> {
    let motions = plate_motions(geometry, set);
    let by_name =
        geometry.parts.iter().position(|part| *part == set.name).filter(|part| motions[*part] > 0.0);
    by_name.or_else(|| {
        let parts = motions.into_iter().enumerate().filter(|(_, motion)| *motion > 0.0);
        parts.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(part, _)| part)
    })
}

/// For each part the mean over the nodes of its faces of |u|², summed over the modes that have a name \[1/kg\].
fn plate_motions(geometry: &Geometry, set: &NamedModes) -> Vec<f64> {
    let mut nodes = vec![Vec::new(); geometry.parts.len()];
    let elements = geometry.elements.iter().zip(&geometry.part_of);
    elements.filter(|(e, _)| e.len() >= 3).for_each(|(e, part)| nodes[*part].extend(e));
    let mut motions = vec![0.0; nodes.len()];
    for k in (0..set.modes.len()).filter(|k| set.names[*k].is_some()) {
        let shape = set.shape(k);
        let squared = |node: &usize| shape[*node][..3].iter().map(|u| u * u).sum::<f64>();
        motions
            .iter_mut()
            .zip(&nodes)
            .for_each(|(sum, nodes)| *sum += nodes.iter().map(squared).sum::<f64>());
    }
    motions.iter().zip(&nodes).map(|(sum, nodes)| sum / nodes.len().max(1) as f64).collect()
}

fn draw_mode(
    sheet: &mut Sheet,
    corner: SvgPoint,
    disc: &DiscPicture,
    set: &NamedModes,
    group: &ModeGroup,
    (row, scale): (Option<&MeasuredRow>, Option<f64>),
) {
    let radius = 74.0;
    let centre_x = corner[0] + 0.5 * CELL[0];
    if row.is_some() {
        let style = outlined("#eef5fa", MEASURED, 1.2) + " rx=\"8\"";
        sheet.rectangle([corner[0] + 5.0, corner[1] + 5.0], [CELL[0] - 10.0, CELL[1] - 10.0], &style);
    }
    let fit = PlacedView::new(
        disc.plate.points.iter().copied(),
        [centre_x - radius, corner[1] + 15.0],
        [2.0 * radius, 2.0 * radius],
    );
    let pixels: Vec<SvgPoint> = disc.plate.points.iter().map(|p| fit.pixel(*p)).collect();
    let w = disc.deflection(&set.shape(group.modes.start));
    disc.plate.paint(sheet, &pixels, &w);
    let nodal = at_least(&pixels, &disc.lively(&w), &w, 0.0).level_lines;
    if !nodal.is_empty() {
        let style = stroke(INK, 1.8) + " stroke-linecap=\"round\"";
        sheet.lines(nodal.iter().map(|line| &line[..]), &style);
    }
    let DiscModeName { nodal_diameters: n, nodal_circles: s } = group.name;
    let times = if group.modes.len() > 1 { " ×2" } else { "" };
    let hz = scale.unwrap_or(1.0) * set.modes.frequency_hz(group.modes.start);
    let title = format!("({n}, {s}){times}  {} Hz", hertz(hz, if hz < 1000.0 { 1 } else { 0 }));
    let y = corner[1] + 15.0 + 2.0 * radius + 24.0;
    sheet.text([centre_x, y], &title, ink(15.0, INK).bold().middle());
    match row {
        Some(row) => {
            let difference =
                row.difference_percent().map_or(String::new(), |d| format!(" ({} %)", signed(d, 1)));
            let text = format!("measured {} Hz{difference}", given(row.frequency_hz));
            sheet.text([centre_x, y + 18.0], &text, ink(12.5, MEASURED).middle());
        }
        None if scale.is_some() => {
            sheet.text([centre_x, y + 18.0], "no measured peak paired", ink(12.5, MUTED).middle());
        }
        None => {}
    }
}

fn draw_legend(sheet: &mut Sheet, top: f64, scale: Option<f64>) {
    let (left, y) = (MARGIN + 16.0, top + 14.0);
    let width = colour_bar(sheet, [left, y], 16.0, ["−max", "+max"]);
    let x = left + width + 40.0;
    sheet.text([x, y + 12.0], "deflection w along the disc's axis", ink(12.5, INK));
    sheet.line([[x, y + 25.0], [x + 22.0, y + 25.0]], &stroke(INK, 1.8));
    let scaled = match scale {
        Some(scale) if scale != 1.0 => format!(" · frequencies: computed × {} (assumed scale)", given(scale)),
        _ => String::new(),
    };
    sheet.text([x + 28.0, y + 29.0], &format!("nodal line{scaled}"), ink(12.5, INK));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;

    #[test]
    fn double_modes_share_a_disc_and_measured_ones_are_framed() {
        let results = sample::rig();
        let set = results.all::<NamedModes>()[0];
        let groups = groups(set);
        let named = set.names.iter().flatten().count();
        assert_eq!(groups.iter().map(|g| g.modes.len()).sum::<usize>(), named);
        assert!(named > groups.len());
        let svg = picture(&results).unwrap().svg;
        assert!(svg.contains("(4, 0) ×2  925.2 Hz") && svg.contains("measured 936 Hz (−1.0 %)"));
        assert_eq!(svg.matches("no measured peak paired").count(), groups.len() - 3);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn the_nodal_lines_are_where_the_shape_vanishes() {
        let results = sample::rig();
        let set = results.all::<NamedModes>()[0];
        let disc = DiscPicture::new(&results.geometry, set).unwrap();
        let k = set.names.iter().position(|n| n.is_some_and(|n| n.nodal_circles == 1)).unwrap();
        let w = disc.deflection(&set.shape(k));
        let lines = at_least(&disc.plate.points, &disc.lively(&w), &w, 0.0).level_lines;
        assert!(lines.len() > 20);
        // A circle about the middle of the disc, between the hub of 21 mm and the rim of 75 mm, on a mesh of 14 mm.
        let [[low, high], [left, right]] =
            [1, 0].map(|c| super::super::chart::ends(disc.plate.points.iter().map(|p| p[c])));
        let centre = [0.5 * (left + right), 0.5 * (low + high)];
        let radii: Vec<f64> = lines.iter().map(|[a, _]| (a[0] - centre[0]).hypot(a[1] - centre[1])).collect();
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        assert!(mean > 0.03 && mean < 0.07, "{mean}");
        assert!(radii.iter().all(|r| within((r - mean).abs(), 0.003, Discretisation)), "{radii:?}");
    }
}
