//! Axes over values of a scalar of the case.

use crate::report::chart::{self, widened};
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

/// The value at a place.
pub(super) fn value(axis: &Axis, place: f64) -> f64 {
    if axis.log { axis.from.signum() * 10f64.powf(place) } else { place }
}

/// The places of an axis, with a margin.
pub(super) fn places(axis: &Axis) -> Range<f64> {
    let ends = [place(axis, axis.from), place(axis, axis.to)];
    widened([ends[0].min(ends[1]), ends[0].max(ends[1])], 0.02)
}

/// The axis of a chart between some of the places.
pub(super) fn between(axis: &Axis, name: &str, places: Range<f64>) -> chart::Axis {
    match axis.log {
        true => chart::Axis::log(name, places, axis.from),
        false => chart::Axis::new(name, places),
    }
}
