//! Branches of a sweep as lines of a chart.

use crate::linalg::c64;
use crate::report::chart::Chart;
use crate::report::colours::MEASURED;
use crate::report::svg::{DASHED, Style, stroke};
use crate::results::SweepResult;
use crate::sweep::{Critical, CriticalKind, InteractionKind};

/// A branch as points (value, λ), its critical points among them, and which stretches grow.
fn trace(result: &SweepResult, b: usize) -> Vec<(f64, c64, bool)> {
    let sweep = &result.sweep;
    let branch = &sweep.branches[b];
    let mut points: Vec<(f64, c64, bool)> = Vec::new();
    // Two branches that merge meet in one point.
    let merges = |c: &&Critical| c.kind == CriticalKind::Merging && partner(result, c) == Some(b);
    let own = sweep.critical.iter().filter(|c| c.branch == b || merges(c));
    let own: Vec<(f64, c64)> = own.map(|c| (c.value, c64::new(0.0, c.eigenvalue.im))).collect();
    for (k, (z, grows)) in branch.eigenvalues.iter().zip(branch.growing()).enumerate() {
        let value = sweep.values[branch.first + k];
        if k > 0 {
            let before = sweep.values[branch.first + k - 1];
            let (low, high) = (before.min(value), before.max(value));
            let between = own.iter().filter(|(v, _)| *v > low && *v < high);
            points.extend(between.map(|(v, z)| (*v, *z, true)));
        }
        points.push((value, *z, grows));
    }
    points
}

/// The branch with which that of a critical value merges there.
fn partner(result: &SweepResult, critical: &Critical) -> Option<usize> {
    let near = 1e-3 * (result.axis.to - result.axis.from).abs();
    let merging = result.sweep.interactions.iter().find(|e| {
        e.kind == InteractionKind::Merging
            && e.branches.contains(&critical.branch)
            && (e.value - critical.value).abs() < near
    })?;
    merging.branches.into_iter().find(|b| *b != critical.branch)
}

/// Growing and other stretches of a branch, each a list of (value, λ).
fn stretches(result: &SweepResult, b: usize) -> Vec<(bool, Vec<(f64, c64)>)> {
    let mut all: Vec<(bool, Vec<(f64, c64)>)> = Vec::new();
    for pair in trace(result, b).windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let grows = from.2 && to.2;
        match all.last_mut() {
            Some((growing, points)) if *growing == grows => points.push((to.0, to.1)),
            _ => all.push((grows, vec![(from.0, from.1), (to.0, to.1)])),
        }
    }
    all
}

/// Every branch that is `chosen`: what does not grow in the first line, what grows in the second, on top.
pub(super) fn draw_lines(
    chart: &mut Chart,
    result: &SweepResult,
    point: impl Fn(f64, c64) -> [f64; 2],
    (chosen, lines): (impl Fn(usize) -> bool, &[Style; 2]),
) {
    for (growing, line) in [false, true].into_iter().zip(lines) {
        for b in (0..result.sweep.branches.len()).filter(|b| chosen(*b)) {
            for (_, points) in stretches(result, b).iter().filter(|(grows, _)| *grows == growing) {
                chart.line(points.iter().map(|(x, z)| point(*x, *z)), line);
            }
        }
    }
}

/// The case's own value as a dashed line.
pub(super) fn draw_nominal(chart: &mut Chart, result: &SweepResult) {
    chart.rule(0, result.nominal, &(stroke(MEASURED, 1.2) + DASHED));
}
