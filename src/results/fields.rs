//! `transient.vtkhdf`: the motion of all nodes at regular times, for ParaView.
//!
//! VTKHDF 2 (docs.vtk.org, VTKHDF file format): an unstructured grid with `Steps`; the mesh is written once, in its rest
//! position. Point arrays `displacement` \[m\], from steady sliding, and `velocity` \[m/s\], single precision, one step after
//! the other; the cell array `part` counts the parts from 0 in the order of the case. All steps are allocated from the
//! start; `NSteps` says how many are there, so that a run in progress can be viewed.

use super::file::plain;
use super::file::{options, preallocated};
use super::folder::{own, refusal};
use super::hdf5::{attribute, rows};
use super::{FieldSnapshot, Fields, NodalField};
use crate::error::{Error, Result};
use crate::mesh::Cell;
use hdf5::Group;
use hdf5::types::FixedAscii;
use ndarray::{Array2, s};
use std::path::{Path, PathBuf};

/// File name.
const NAME: &str = "transient.vtkhdf";
/// The arrays of the motion.
const ARRAYS: [&str; 2] = ["displacement", "velocity"];

/// `transient.vtkhdf` of a run under way.
#[derive(Debug)]
pub struct FieldsFile {
    file: hdf5::File,
    path: PathBuf,
    nodes: usize,
}

impl FieldsFile {
    /// Begins the file in the folder `dir`.
    ///
    /// # Errors
    /// [`Error::Io`], here and later: `transient.vtkhdf` cannot be written.
    pub fn begin(dir: &Path, fields: &Fields) -> Result<Self> {
        let path = dir.join(NAME);
        let nodes = fields.geometry.nodes.len();
        let refused = |source: hdf5::Error| refusal(&path, plain(&source));
        let aside = dir.join("transient.new.vtkhdf");
        std::fs::File::create(&aside).map_err(|source| refusal(&aside, source))?;
        let file = options().create(&aside).map_err(refused)?;
        create(&file, fields).and_then(|()| file.flush()).map_err(refused)?;
        own(dir, NAME)?;
        std::fs::rename(&aside, &path).map_err(|source| refusal(&path, source))?;
        Ok(FieldsFile { file, path, nodes })
    }

    /// Writes the motion at the next of the times.
    pub fn write(&mut self, field: &FieldSnapshot) -> Result<()> {
        let part = field.number * self.nodes..(field.number + 1) * self.nodes;
        let put = |name: &str, values: &NodalField<f64>| {
            let short = Array2::from_shape_fn((values.len(), 3), |(node, axis)| values[node][axis] as f32);
            let array = self.file.dataset(&format!("VTKHDF/PointData/{name}"))?;
            array.write_slice(short.view(), s![part.clone(), ..])
        };
        let written = put(ARRAYS[0], field.displacement).and_then(|()| put(ARRAYS[1], field.velocity));
        written.and_then(|()| self.file.flush()).map_err(|source| self.refused(&source))?;
        self.count(field.number + 1)
    }

    /// Closes the file.
    pub fn finish(self) -> Result<()> {
        self.file.close().map_err(|source| refusal(&self.path, plain(&source)))
    }

    /// Says how many are there.
    fn count(&mut self, steps: usize) -> Result<()> {
        let said = self.file.group("VTKHDF/Steps").and_then(|group| {
            group.attr("NSteps")?.write_scalar(&(steps as i64))?;
            self.file.flush()
        });
        said.map_err(|source| self.refused(&source))
    }

    fn refused(&self, source: &hdf5::Error) -> Error {
        refusal(&self.path, plain(source))
    }
}

fn create(file: &hdf5::File, fields: &Fields) -> hdf5::Result<()> {
    let root = file.create_group("VTKHDF")?;
    root.new_attr::<i64>().shape(2).create("Version")?.write(&[2_i64, 1])?;
    // Readers want a string of this very length.
    let kind = FixedAscii::<16>::from_ascii(b"UnstructuredGrid").map_err(|error| error.to_string())?;
    root.new_attr::<FixedAscii<16>>().create("Type")?.write_scalar(&kind)?;
    let geometry = fields.geometry;
    let list = |group: &Group, name: &str, values: &[i64]| {
        group.new_dataset::<i64>().shape(values.len()).create(name)?.write(values)
    };
    let connectivity: Vec<i64> =
        geometry.cells.iter().flat_map(Cell::to_vtk).map(|node| node as i64).collect();
    let mut offsets = vec![0_i64];
    offsets.extend(geometry.cells.iter().scan(0, |end, cell| {
        *end += cell.nodes().len() as i64;
        Some(*end)
    }));
    list(&root, "NumberOfPoints", &[geometry.nodes.len() as i64])?;
    list(&root, "NumberOfCells", &[geometry.cells.len() as i64])?;
    list(&root, "NumberOfConnectivityIds", &[connectivity.len() as i64])?;
    list(&root, "Connectivity", &connectivity)?;
    list(&root, "Offsets", &offsets)?;
    root.new_dataset_builder().with_data(&rows(&geometry.nodes)).create("Points")?;
    let types: Vec<u8> = geometry.cells.iter().map(|cell| cell.kind().table().vtk.number).collect();
    root.new_dataset_builder().with_data(&types).create("Types")?;
    let part: Vec<i32> = geometry.part_of_cell.iter().map(|part| *part as i32).collect();
    root.create_group("CellData")?.new_dataset_builder().with_data(&part).create("part")?;
    let motion = root.create_group("PointData")?;
    for name in ARRAYS {
        preallocated(&motion, name, (fields.count * geometry.nodes.len(), 3), f32::NAN)?;
    }
    let steps = root.create_group("Steps")?;
    attribute(&steps, "NSteps", &0_i64)?;
    let times: Vec<f64> = (0..fields.count).map(|k| k as f64 * fields.every).collect();
    steps.new_dataset_builder().with_data(&times).create("Values")?;
    // One mesh for all steps.
    let nothing = vec![0_i64; fields.count];
    list(&steps, "NumberOfParts", &vec![1; fields.count])?;
    list(&steps, "PartOffsets", &nothing)?;
    list(&steps, "PointOffsets", &nothing)?;
    for name in ["CellOffsets", "ConnectivityIdOffsets"] {
        steps.new_dataset_builder().with_data(&Array2::<i64>::zeros((fields.count, 1))).create(name)?;
    }
    list(&steps.create_group("CellDataOffsets")?, "part", &nothing)?;
    let offsets = steps.create_group("PointDataOffsets")?;
    let begins: Vec<i64> = (0..fields.count).map(|k| (k * geometry.nodes.len()) as i64).collect();
    ARRAYS.iter().try_for_each(|name| list(&offsets, name, &begins))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    fn motion(number: usize, nodes: usize) -> NodalField<f64> {
        (0..nodes)
            .map(|node| std::array::from_fn(|k| (number * 7 + node) as f64 + 0.125 * k as f64))
            .collect()
    }

    #[test]
    fn fields_are_there_as_they_were_written() {
        let dir = tempfile::tempdir().unwrap();
        let geometry = sample::rig().geometry;
        let nodes = geometry.nodes.len();
        let fields = Fields { geometry: &geometry, every: 1e-3, count: 5, done: 0 };
        let write = |file: &mut FieldsFile, number: usize| {
            let (displacement, velocity) = (&motion(number, nodes), &motion(number + 100, nodes));
            file.write(&FieldSnapshot { number, displacement, velocity }).unwrap();
        };
        let mut file = FieldsFile::begin(dir.path(), &fields).unwrap();
        (0..2).for_each(|number| write(&mut file, number));
        let steps = |file: &FieldsFile| {
            file.file.group("VTKHDF/Steps").unwrap().attr("NSteps").unwrap().read_scalar::<i64>().unwrap()
        };
        assert_eq!(steps(&file), 2);
        (2..5).for_each(|number| write(&mut file, number));
        assert_eq!(steps(&file), 5);
        let velocity = file.file.dataset("VTKHDF/PointData/velocity").unwrap().read_2d::<f32>().unwrap();
        let begins =
            file.file.dataset("VTKHDF/Steps/PointDataOffsets/velocity").unwrap().read_1d::<i64>().unwrap();
        for number in 0..5 {
            let expected = motion(number + 100, nodes);
            let first = begins[number] as usize;
            assert!(
                (0..nodes)
                    .all(|node| (0..3).all(|k| velocity[(first + node, k)] == expected[node][k] as f32))
            );
        }
    }
}
