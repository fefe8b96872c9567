//! Axes over values of a scalar of the case.

use crate::report::readout::AxisScale;
use crate::sweep::Axis;

/// A parameter's path with its unit, for axes.
pub(super) fn axis_name(path: &str, unit: &str) -> String {
    if unit.is_empty() { path.to_string() } else { format!("{path} [{unit}]") }
}

/// A value's place on an axis: itself, or its logarithm.
pub(super) fn place(axis: &Axis, value: f64) -> f64 {
    if axis.log { value.abs().log10() } else { value }
}

/// The value at a place.
pub(super) fn value_at(axis: &Axis, place: f64) -> f64 {
    if axis.log { axis.from.signum() * 10f64.powf(place) } else { place }
}

/// The axis as the page's script reads it.
pub(super) fn scale<'a>(axis: &Axis, name: &'a str) -> AxisScale<'a> {
    AxisScale { name, decades: if axis.log { axis.from.signum() } else { 0.0 } }
}

/// Three digits, for labels of a logarithmic axis.
pub(super) fn round(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
