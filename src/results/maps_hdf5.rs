//! Maps in `results.h5`: the points are written as they come, so that a killed run leaves its first ones.

use super::ResultsFile;
use super::maps::{MapResult, grid};
use crate::dataset::{Dimension, Variable, attribute, link, opened};
use crate::error::Result;
use crate::sweep::MapPoint;

/// The group of the map `name`.
fn of(root: &hdf5::Group, name: &str) -> hdf5::Result<hdf5::Group> {
    root.group("maps")?.group(&link(name))
}

impl ResultsFile {
    /// Begins a map, or begins it again: its axes, space for its points.
    pub fn begin_map(&mut self, map: &MapResult, trained: &[[f64; 2]]) -> Result<()> {
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
        self.take_place()
    }

    /// Writes points of the map `name`, from point `first` on.
    pub fn write_map_points(&mut self, name: &str, first: usize, points: &[MapPoint]) -> Result<()> {
        self.fill(|root| grid(points).fill_hdf5(&of(root, name)?, first))?;
        // They count when they are on the disk.
        let done = (first + points.len()) as u64;
        self.fill(|root| of(root, name)?.attr("points_done")?.write_scalar(&done))
    }

    /// Writes what a map has when all its points are there: the boundary and the full-order sample.
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
    use super::*;
    use crate::dataset::Describe;
    use crate::job::sample;
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
        let mut map = results.all::<MapResult>()[0].clone();
        map.points[4] = MapPoint::NONE;
        let map = &map;
        let mut file = ResultsFile::create(dir.path()).unwrap();
        let begun = MapResult { points: Vec::new(), ..map.clone() };
        for known in [&map.points[..5], &map.points[..2]] {
            file.begin_map(&begun, &[]).unwrap();
            file.write_map_points(&map.name, 0, known).unwrap();
        }
        let before = file.read(|root| Ok(datasets(&of(root, &map.name)?))).unwrap();
        file.write_map_points(&map.name, 2, &map.points[2..8]).unwrap();
        file.write_map_points(&map.name, 8, &map.points[8..]).unwrap();
        let after = file.read(|root| Ok(datasets(&of(root, &map.name)?))).unwrap();
        assert!(before == after && before.len() > 10, "{after:?}");
        file.finish_map(map).unwrap();
        let (mut streamed, numbers, unstable) = file
            .read(|root| {
                let grid = of(root, &map.name)?.group("grid")?;
                assert_eq!(of(root, &map.name)?.attr("points_done")?.read_scalar::<u64>()?, 12);
                let numbers = ["contact.rim.friction.mu0", "growth_rate", "frequency_hz"]
                    .map(|name| grid.dataset(name));
                let numbers = numbers.map(|dataset| dataset.unwrap().read_raw::<f64>().unwrap());
                let unstable = grid.dataset("unstable")?.read_raw::<i64>()?;
                Ok((datasets(&of(root, &map.name)?), numbers, unstable))
            })
            .unwrap();
        drop(file);
        let mut file = ResultsFile::create(dir.path()).unwrap();
        file.write(&map.describe()).unwrap();
        let whole = file.read(|root| Ok(datasets(&of(root, &map.name)?))).unwrap();
        streamed.retain(|(name, ..)| !name.contains("trained"));
        assert_eq!(streamed, whole);
        assert_eq!(numbers[0][..5], [0, 1, 2, 3, 0].map(|k| map.axes[0].value(k)));
        let counted =
            |point: &MapPoint| if point.growth_rate.is_nan() { -1 } else { i64::from(point.unstable) };
        assert!(unstable.iter().copied().eq(map.points.iter().map(counted)) && unstable[4] == -1);
        for (number, of) in
            [(&numbers[1], |p: &MapPoint| p.growth_rate), (&numbers[2], |p: &MapPoint| p.frequency_hz)]
                as [(_, fn(&MapPoint) -> f64); 2]
        {
            let same = |(number, point): (&f64, &MapPoint)| number.to_bits() == of(point).to_bits();
            assert!(number.iter().zip(&map.points).all(same));
        }
    }
}
