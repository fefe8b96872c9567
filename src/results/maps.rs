//! Maps: the strongest growth over two scalars of the case. The points are written as they come, so that a killed run leaves
//! its first ones.

use super::explored::Method;
use super::{ResultsFile, file_name};
use crate::dataset::{
    Column, Describe, Dimension, Group, Table, Values, Variable, attribute, column, link, opened,
};
use crate::error::Result;
use crate::sweep::{Axis, Boundary, MapPoint};

/// The strongest growth over two scalars of the case.
#[derive(Debug, Clone)]
pub struct MapResult {
    /// The name the case gives it.
    pub name: String,
    /// The paths of the scalars.
    pub parameters: [String; 2],
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
    pub method: Method,
}

fn point_columns() -> Vec<Column<MapPoint>> {
    vec![
        column("growth_rate", "1/s", "the largest σ of all modes in the band", |p: &MapPoint| p.growth_rate),
        column("frequency_hz", "Hz", "ω/2π of that mode", |p: &MapPoint| p.frequency_hz),
        column("unstable", "1", "how many modes grow", |p: &MapPoint| p.unstable),
    ]
}

/// The points of a map, or some of them.
fn grid(points: &[MapPoint]) -> Table<'static> {
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
    /// How many points there are.
    fn total(&self) -> usize {
        self.axes[0].points * self.axes[1].points
    }

    /// The values of the parameters at point `k`.
    fn at(&self, k: usize) -> [f64; 2] {
        let n = self.axes[0].points;
        [self.axes[0].value(k % n), self.axes[1].value(k / n)]
    }

    /// The parameters and the points, those that are not computed without growth rate.
    fn begun(&self) -> Group<'_> {
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
            .with(texts("units", "their units; empty of a pure number", &self.units))
            .with(reals("from", "first values, in their units", self.axes.map(|axis| axis.from)))
            .with(reals("to", "last values, in their units", self.axes.map(|axis| axis.to)))
            .with(Variable::new("points", "1", "numbers of values", vec![parameters.clone()], steps))
            .with(reals("nominal", "values of the case, in their units", self.nominal))
            .table(grid)
    }

    /// What is known when all points are there.
    fn found(&self) -> Group<'_> {
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

/// The group of the map `name`.
fn of(root: &hdf5::Group, name: &str) -> hdf5::Result<hdf5::Group> {
    root.group("maps")?.group(&link(name))
}

impl ResultsFile {
    /// Begins a map, or begins it again: its axes, space for its points, and those that are `known`.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn begin_map(&mut self, map: &MapResult, known: &[MapPoint], trained: &[[f64; 2]]) -> Result<()> {
        let places = vec![
            Dimension::numbered("trained_place", trained.len()),
            Dimension::of_variable("parameters", 2),
        ];
        let story = "places on which the reduced model was trained beyond those of every run, in the units";
        let places = Variable::reals("trained_at", "unit", story, places, trained.as_flattened().to_vec());
        self.keep(|root| {
            let maps = opened(root, "maps")?;
            if maps.link_exists(&link(&map.name)) {
                maps.unlink(&link(&map.name))?;
            }
            map.begun().with(places).write_hdf5(&maps)?;
            let map = of(root, &map.name)?;
            attribute(&map, "points_done", &0_u64)
        })?;
        self.write_map_points(&map.name, 0, known)?;
        self.take_place()
    }

    /// Writes points of the map `name`, from point `first` on.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn write_map_points(&mut self, name: &str, first: usize, points: &[MapPoint]) -> Result<()> {
        self.fill(|root| grid(points).fill_hdf5(&of(root, name)?, first))?;
        // They count when they are on the disk.
        let done = (first + points.len()) as u64;
        self.fill(|root| of(root, name)?.attr("points_done")?.write_scalar(&done))
    }

    /// Writes what a map has when all its points are there: the boundary and the full-order sample.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn finish_map(&mut self, map: &MapResult) -> Result<()> {
        self.stage(|root| {
            map.found().write_hdf5(&root.group("maps")?)?;
            let map = of(root, &map.name)?;
            attribute(&map, "complete", &true)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;
    use hdf5::types::TypeDescriptor;

    /// Paths, types and shapes of the datasets of a group.
    fn datasets(group: &hdf5::Group) -> Vec<(String, TypeDescriptor, Vec<usize>)> {
        let all = group.datasets().unwrap().into_iter();
        let own = all.map(|d| (d.name(), d.dtype().unwrap().to_descriptor().unwrap(), d.shape()));
        own.chain(group.groups().unwrap().iter().flat_map(datasets)).collect()
    }

    #[test]
    fn a_map_that_is_written_as_it_comes_is_that_which_is_written_whole() {
        let dir = tempfile::tempdir().unwrap();
        let results = sample::rig();
        let map = results.all::<MapResult>()[0];
        let mut file = ResultsFile::create(dir.path()).unwrap();
        let begun = MapResult { points: Vec::new(), ..map.clone() };
        for known in [&map.points[..5], &map.points[..2]] {
            file.begin_map(&begun, known, &[]).unwrap();
        }
        let before = file.read(|root| Ok(datasets(&of(root, &map.name)?))).unwrap();
        file.write_map_points(&map.name, 2, &map.points[2..8]).unwrap();
        file.write_map_points(&map.name, 8, &map.points[8..]).unwrap();
        let after = file.read(|root| Ok(datasets(&of(root, &map.name)?))).unwrap();
        assert!(before == after && before.len() > 10, "{after:?}");
        file.finish_map(map).unwrap();
        let (mut streamed, numbers) = file
            .read(|root| {
                let grid = of(root, &map.name)?.group("grid")?;
                assert_eq!(of(root, &map.name)?.attr("points_done")?.read_scalar::<u64>()?, 12);
                let numbers =
                    ["contact.rim.load", "growth_rate", "frequency_hz"].map(|name| grid.dataset(name));
                let numbers = numbers.map(|dataset| dataset.unwrap().read_raw::<f64>().unwrap());
                Ok((datasets(&of(root, &map.name)?), numbers))
            })
            .unwrap();
        drop(file);
        let mut file = ResultsFile::create(dir.path()).unwrap();
        file.write(&map.describe()).unwrap();
        let whole = file.read(|root| Ok(datasets(&of(root, &map.name)?))).unwrap();
        streamed.retain(|(name, ..)| !name.contains("trained"));
        assert_eq!(streamed, whole);
        assert_eq!(numbers[0][..5], [10.0, 20.0, 30.0, 40.0, 10.0]);
        for (number, of) in
            [(&numbers[1], |p: &MapPoint| p.growth_rate), (&numbers[2], |p: &MapPoint| p.frequency_hz)]
                as [(_, fn(&MapPoint) -> f64); 2]
        {
            let same = |(number, point): (&f64, &MapPoint)| number.to_bits() == of(point).to_bits();
            assert!(number.iter().zip(&map.points).all(same));
        }
    }
}
