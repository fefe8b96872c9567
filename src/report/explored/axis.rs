//! Axes over values of a scalar of the case.

use crate::report::chart::widened;
use crate::report::format::{given, rounded};
use crate::report::readout::AxisScale;
use crate::sweep::Axis;
use std::ops::Range;

/// A quantity with its unit, for axes.
pub(super) fn axis_name(label: &str, unit: &str) -> String {
    format!("{label} [{}]", if unit.is_empty() { "–" } else { unit })
}

/// A value's place on an axis: itself, or its logarithm.
pub(super) fn place(axis: &Axis, value: f64) -> f64 {
    if axis.log { value.abs().log10() } else { value }
}

/// The places of an axis, with a margin.
pub(super) fn places(axis: &Axis) -> Range<f64> {
    let ends = [place(axis, axis.from), place(axis, axis.to)];
    widened(ends[0].min(ends[1]), ends[0].max(ends[1]), 0.02)
}

/// The axis as the page's script reads it.
pub(super) fn scale<'a>(axis: &Axis, name: &'a str) -> AxisScale<'a> {
    AxisScale { name, decades: if axis.log { axis.from.signum() } else { 0.0 } }
}

/// The value at a place as a label.
pub(super) fn label(axis: &Axis, place: f64) -> String {
    if !axis.log {
        return given(place);
    }
    given(rounded(axis.from.signum() * 10f64.powf(place), 3))
}
