//! Maps: the strongest growth over two scalars of the case.

use super::explored::SweepMethod;
use super::file_name;
use crate::dataset::{Column, Describe, Dimension, Group, Table, Values, Variable, column};
use crate::sweep::{Axis, Boundary, MapPoint};

/// The strongest growth over two scalars of the case.
#[derive(Debug, Clone)]
pub struct MapResult {
    /// The name the case gives it.
    pub name: String,
    /// The paths of the scalars.
    pub parameters: [String; 2],
    /// Names of the quantities with their symbols, for axes.
    pub labels: [String; 2],
    /// Their SI units.
    pub units: [String; 2],
    /// The values, the first parameter running fastest in `points`.
    pub axes: [Axis; 2],
    /// The values of the case itself.
    pub nominal: [f64; 2],
    /// One a point of the grid.
    pub points: Vec<MapPoint>,
    /// Where the largest growth rate is zero.
    pub boundary: Boundary,
    /// Places at which all modes were measured on the full order, with the largest |Δλ|/|λ| there.
    pub sample: Vec<([f64; 2], f64)>,
    /// How it was solved.
    pub method: SweepMethod,
}

fn point_columns() -> Vec<Column<MapPoint>> {
    vec![
        column("growth_rate", "1/s", "the largest σ of all modes in the band", |p: &MapPoint| p.growth_rate),
        column("frequency_hz", "Hz", "ω/2π of that mode", |p: &MapPoint| p.frequency_hz),
        column("unstable", "1", "how many modes grow", |p: &MapPoint| {
            p.growth_rate.is_finite().then_some(p.unstable as usize)
        }),
    ]
}

/// The points of a map, or some of them.
pub(super) fn grid(points: &[MapPoint]) -> Table<'static> {
    Table::of("grid", "point", &point_columns(), points).long()
}

/// Values of both parameters.
fn place<R>(at: impl Fn(&R) -> [f64; 2] + 'static) -> Column<R> {
    column("at", "unit", "values of both parameters, in their units", at).along(both())
}

/// The parameters of a map, in a group without their paths.
fn both() -> Dimension {
    Dimension::numbered("parameter", 2)
}

impl MapResult {
    /// Number of points.
    fn total(&self) -> usize {
        self.axes[0].points * self.axes[1].points
    }

    /// The values of the parameters at point `k`.
    fn at(&self, k: usize) -> [f64; 2] {
        let n = self.axes[0].points;
        [self.axes[0].value(k % n), self.axes[1].value(k / n)]
    }

    /// The parameters and the points, those that are not computed without growth rate.
    pub(super) fn begun(&self) -> Group<'_> {
        let parameters = Dimension::of_variable("parameters", 2);
        let reals = |key: &'static str, story: &'static str, values: [f64; 2]| {
            Variable::reals(key, "unit", story, vec![parameters.clone()], values.to_vec())
        };
        let texts = |key: &'static str, story: &'static str, of: &[String; 2]| {
            Variable::texts(key, story, parameters.clone(), of.to_vec())
        };
        let steps = Values::Integers(self.axes.iter().map(|axis| axis.points as i64).collect());
        let all: Vec<MapPoint> =
            (0..self.total()).map(|k| self.points.get(k).copied().unwrap_or(MapPoint::NONE)).collect();
        let mut grid = grid(&all).file(file_name("map", &self.name));
        for k in [1, 0] {
            let values = (0..self.total()).map(|point| self.at(point)[k]).collect();
            let (path, unit) = (self.parameters[k].clone(), self.units[k].clone());
            let story = "value of the parameter; the first runs fastest";
            grid.columns.insert(0, Variable::reals(path, unit, story, vec![grid.rows.clone()], values));
        }
        Group::new(&*self.name, "the strongest growth over two scalars of the case")
            .with(texts("parameters", "paths of the scalars", &self.parameters))
            .with(texts("labels", "names of the quantities with their symbols", &self.labels))
            .with(texts("units", "their units; empty of a pure number", &self.units))
            .with(reals("from", "first values, in their units", self.axes.map(|axis| axis.from)))
            .with(reals("to", "last values, in their units", self.axes.map(|axis| axis.to)))
            .with(Variable::new("points", "1", "numbers of values", vec![parameters.clone()], steps))
            .with(reals("nominal", "values of the case, in their units", self.nominal))
            .table(grid)
    }

    /// Results of a map with all points computed.
    pub(super) fn found(&self) -> Group<'_> {
        let answered = || self.points.iter().enumerate().filter(|(_, point)| point.growth_rate.is_finite());
        let largest =
            answered().max_by(|a, b| a.1.growth_rate.total_cmp(&b.1.growth_rate)).map(|(k, point)| {
                let of = Group::of("largest", "the point that grows most", &point_columns(), point);
                of.with(Variable::reals(
                    "at",
                    "unit",
                    "values of both parameters",
                    vec![both()],
                    self.at(k).to_vec(),
                ))
            });
        type Sample = ([f64; 2], f64);
        let sample = [
            place(|(at, _): &Sample| *at),
            column("eigenvalue_error", "1", "largest estimated |Δλ|/|λ| there", |(_, error): &Sample| {
                *error
            }),
        ];
        Group::new(&*self.name, "")
            .value("answered", "1", "points with an answer", answered().count())
            .value(
                "unstable_points",
                "1",
                "points at which a mode grows",
                answered().filter(|(_, point)| point.unstable > 0).count(),
            )
            .value("boundary_lines", "1", "lines of the boundary of stability", self.boundary.lines.len())
            .group(self.method.group())
            .optional("largest", largest)
            .table(self.boundary_table().file(file_name("map", &self.name) + "_boundary"))
            .table(Table::of("full_order_sample", "sample", &sample, &self.sample))
    }

    /// The boundary, line after line; a line that is closed ends where it begins.
    fn boundary_table(&self) -> Table<'static> {
        type Located = (Option<usize>, [f64; 2]);
        let Boundary { points, lines } = &self.boundary;
        let lined = lines.iter().enumerate();
        let lined = lined.flat_map(|(line, along)| along.iter().map(move |k| (Some(line + 1), points[*k])));
        let alone = points.iter().enumerate();
        let alone = alone.filter(|(k, _)| !lines.iter().flatten().any(|point| point == k));
        let all: Vec<Located> = lined.chain(alone.map(|(_, at)| (None, *at))).collect();
        let columns = [
            column("line", "1", "number of the line, if the point is on one", |(line, _): &Located| *line),
            place(|(_, at): &Located| *at),
        ];
        Table::of("boundary", "boundary_point", &columns, &all)
    }
}

impl MapResult {
    fn group(&self) -> Group<'_> {
        let mut group = self.begun();
        group.entries.extend(self.found().entries);
        group
    }
}

impl Describe for MapResult {
    fn describe(&self) -> Group<'_> {
        Group::new("", "").list("maps", vec![self.group()])
    }
}
