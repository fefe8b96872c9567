//! Groups and tables as HDF5.
//!
//! Each dataset has the attributes `units` and `description`, and its dimensions have the coordinates of its group attached, as
//! dimension scales (HDF5 Dimension Scale Specification: attributes `CLASS`, `NAME`, `REFERENCE_LIST` of a scale, `DIMENSION_LIST` of
//! the others), so that xarray and netCDF show them by name.

use super::variable::{Values, Variable};
use super::{Entry, Group, Table};
use hdf5::types::{VarLenArray, VarLenUnicode};
use hdf5::{Dataset, H5Type, Location, ObjectReference1};
use ndarray::{Array1, ArrayViewD, s};
use num_complex::Complex64 as c64;
use std::collections::BTreeMap;

/// Datasets that a scale can list: an attribute holds 64 KiB.
const LISTED: usize = 4000;
/// A whole number that is not there.
const NO_NUMBER: i64 = -1;

impl Group<'_> {
    /// Writes the group into `parent`, in which it may be there already.
    ///
    /// # Errors
    /// Those of the HDF5 library.
    pub fn write_hdf5(&self, parent: &hdf5::Group) -> hdf5::Result<()> {
        let group = if self.key.is_empty() { parent.clone() } else { opened(parent, &self.key)? };
        if !self.description.is_empty() && group.attr("description").is_err() {
            text_attribute(&group, "description", self.description)?;
        }
        let variables = self.entries.iter().filter_map(|entry| match entry {
            Entry::Variable(variable) => Some(variable),
            _ => None,
        });
        write_variables(&group, &variables.collect::<Vec<_>>())?;
        for entry in &self.entries {
            match entry {
                Entry::Group(inner) => inner.write_hdf5(&group)?,
                Entry::Table(table) => table.write_hdf5(&group)?,
                Entry::List(key, groups) if !groups.is_empty() => {
                    let list = opened(&group, key)?;
                    groups.iter().try_for_each(|inner| inner.write_hdf5(&list))?;
                }
                Entry::Parts(key, _, tables) if !tables.is_empty() => {
                    let list = opened(&group, key)?;
                    tables.iter().try_for_each(|table| table.write_hdf5(&list))?;
                }
                Entry::List(..) | Entry::Parts(..) | Entry::Variable(_) | Entry::Absent(_) => {}
            }
        }
        Ok(())
    }
}

impl Table<'_> {
    /// Writes the columns and fields as datasets of a group of `parent`.
    ///
    /// # Errors
    /// Those of the HDF5 library.
    pub fn write_hdf5(&self, parent: &hdf5::Group) -> hdf5::Result<()> {
        let variables: Vec<&Variable> = self.columns.iter().chain(&self.fields).collect();
        write_variables(&opened(parent, &self.key)?, &variables)
    }

    /// Puts numbers of the columns into the datasets that are there for more rows, from row `first` on.
    ///
    /// # Errors
    /// Those of the HDF5 library.
    pub fn fill_hdf5(&self, parent: &hdf5::Group, first: usize) -> hdf5::Result<()> {
        let group = parent.group(&link(&self.key))?;
        let rows = first..first + self.rows.length;
        self.columns.iter().try_for_each(|column| {
            let dataset = group.dataset(&link(&column.key))?;
            match &column.values {
                Values::Integers(all) => dataset.write_slice(all, s![rows.clone()]),
                Values::Sparse(all) => dataset.write_slice(&filled(all), s![rows.clone()]),
                Values::Reals(all) => dataset.write_slice(all, s![rows.clone()]),
                _ => Err(format!("{} does not come row by row", column.key).into()),
            }
        })
    }
}

/// Whole numbers as they are written.
fn filled(numbers: &[Option<i64>]) -> Vec<i64> {
    numbers.iter().map(|number| number.unwrap_or(NO_NUMBER)).collect()
}

/// Name of a group or dataset in HDF5: the separator of groups in a path is replaced in a name.
pub fn link(name: &str) -> String {
    if name == "." { "．".to_string() } else { name.replace('/', "∕") }
}

/// The group `name`, made where it is not there.
///
/// # Errors
/// Those of the HDF5 library.
pub fn opened(parent: &hdf5::Group, name: &str) -> hdf5::Result<hdf5::Group> {
    let name = link(name);
    if parent.link_exists(&name) { parent.group(&name) } else { parent.create_group(&name) }
}

/// Writes variables, and the coordinates of their dimensions that are not among them.
fn write_variables(group: &hdf5::Group, variables: &[&Variable]) -> hdf5::Result<()> {
    let mut scales: BTreeMap<&str, AttachedScale> = BTreeMap::new();
    for dimension in variables.iter().flat_map(|variable| &variable.dimensions) {
        if scales.contains_key(dimension.name) {
            continue;
        }
        let own = variables.iter().find(|variable| variable.key == dimension.name);
        let dataset = match own {
            Some(variable) => write_variable(group, variable)?,
            None => write_variable(group, &dimension.coordinate())?,
        };
        scales.insert(dimension.name, AttachedScale::new(group, &dataset, dimension.name)?);
    }
    for variable in variables {
        if scales.contains_key(&*variable.key) {
            continue;
        }
        let dataset = write_variable(group, variable)?;
        let reference = group.reference::<ObjectReference1>(&link(&variable.key))?;
        let mut along = Vec::new();
        for (k, dimension) in variable.dimensions.iter().enumerate() {
            let scale = scales.get_mut(dimension.name).ok_or("every dimension has a scale")?;
            scale.of.push(Attached { dataset: reference, dimension: k as u32 });
            along.push(VarLenArray::from_slice(&[scale.reference]));
        }
        list_dimensions(&dataset, along)?;
    }
    scales.into_values().try_for_each(AttachedScale::finish)
}

/// The scales of the dimensions of a dataset, one each.
fn list_dimensions(dataset: &Dataset, scales: Vec<VarLenArray<ObjectReference1>>) -> hdf5::Result<()> {
    if scales.is_empty() {
        return Ok(());
    }
    let list = dataset.new_attr::<VarLenArray<ObjectReference1>>().shape(scales.len());
    list.create("DIMENSION_LIST")?.write(&Array1::from(scales))
}

/// Makes the dataset `name` of a group the coordinate of the first dimension of others, which are given by their paths; of more
/// than 4000 the others have none.
///
/// # Errors
/// Those of the HDF5 library.
pub fn attach_scale(group: &hdf5::Group, name: &str, others: &[String]) -> hdf5::Result<()> {
    let mut scale = AttachedScale::new(group, &group.dataset(name)?, name)?;
    for path in others.iter().take(LISTED) {
        scale.of.push(Attached { dataset: group.reference(path)?, dimension: 0 });
        list_dimensions(&group.dataset(path)?, vec![VarLenArray::from_slice(&[scale.reference])])?;
    }
    scale.finish()
}

/// A dataset that is the coordinate of a dimension.
struct AttachedScale {
    dataset: Dataset,
    reference: ObjectReference1,
    of: Vec<Attached>,
}

/// A dataset with the dimension that a scale is of: an entry of `REFERENCE_LIST`.
#[derive(Clone, Copy, H5Type)]
#[repr(C)]
struct Attached {
    dataset: ObjectReference1,
    dimension: u32,
}

impl AttachedScale {
    fn new(group: &hdf5::Group, dataset: &Dataset, name: &str) -> hdf5::Result<Self> {
        terminated_text(dataset, "CLASS", "DIMENSION_SCALE")?;
        terminated_text(dataset, "NAME", name)?;
        Ok(AttachedScale { dataset: dataset.clone(), reference: group.reference(name)?, of: Vec::new() })
    }

    fn finish(self) -> hdf5::Result<()> {
        if self.of.is_empty() {
            return Ok(());
        }
        let list = self.dataset.new_attr::<Attached>().shape(self.of.len());
        list.create("REFERENCE_LIST")?.write(&Array1::from(self.of))
    }
}

fn write_variable(group: &hdf5::Group, variable: &Variable) -> hdf5::Result<Dataset> {
    let shape = variable.shape();
    let dataset = match &variable.values {
        Values::Flags(all) => put(group, variable, all)?,
        Values::Integers(all) => put(group, variable, all)?,
        Values::Sparse(all) => {
            let dataset = put(group, variable, &filled(all))?;
            attribute(&dataset, "_FillValue", &NO_NUMBER)?;
            dataset
        }
        Values::Reals(all) => put(group, variable, all)?,
        Values::Complexes(all) => put(group, variable, all)?,
        Values::Texts(all) => {
            let all: Vec<VarLenUnicode> =
                all.iter().map(|text| unicode(text.as_deref().unwrap_or_default())).collect();
            put(group, variable, &all)?
        }
        Values::RealRows(row) => {
            let dataset = group.new_dataset::<f64>().shape(shape.clone()).create(&*link(&variable.key))?;
            put_rows(&dataset, &shape, row)?;
            dataset
        }
        Values::ComplexRows(row) => {
            let dataset = group.new_dataset::<c64>().shape(shape.clone()).create(&*link(&variable.key))?;
            put_rows(&dataset, &shape, row)?;
            dataset
        }
    };
    describe(&dataset, &variable.unit, &variable.description)?;
    Ok(dataset)
}

fn put<T: H5Type>(group: &hdf5::Group, variable: &Variable, values: &[T]) -> hdf5::Result<Dataset> {
    let shape = variable.shape();
    let dataset = group.new_dataset::<T>().shape(shape.clone()).create(&*link(&variable.key))?;
    let values = ArrayViewD::from_shape(shape, values).map_err(|error| error.to_string())?;
    dataset.write(values)?;
    Ok(dataset)
}

/// Writes some indices of the first dimension at a time: no field is held as a whole.
fn put_rows<T: H5Type>(
    dataset: &Dataset,
    shape: &[usize],
    row: impl Fn(usize) -> Vec<T>,
) -> hdf5::Result<()> {
    const VALUES_AT_ONCE: usize = 1 << 16;
    let width: usize = shape[1..].iter().product();
    let at_once = (VALUES_AT_ONCE / width.max(1)).max(1);
    for first in (0..shape[0]).step_by(at_once) {
        let rows = first..shape[0].min(first + at_once);
        let mut part = shape.to_vec();
        part[0] = rows.len();
        let values: Vec<T> = rows.clone().flat_map(&row).collect();
        let values = ArrayViewD::from_shape(part, &values).map_err(|error| error.to_string())?;
        match shape.len() {
            1 => dataset.write_slice(values, s![rows])?,
            2 => dataset.write_slice(values, s![rows, ..])?,
            3 => dataset.write_slice(values, s![rows, .., ..])?,
            _ => return Err("fields have three dimensions at most".into()),
        }
    }
    Ok(())
}

/// An attribute with a text that ends at a NUL, which is what the library itself asks for in dimension scales.
fn terminated_text(location: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    use hdf5_sys::{h5a, h5p::H5P_DEFAULT, h5s, h5t};
    let (name, text) = [name, text].map(std::ffi::CString::new).into();
    let (name, text) = (name.map_err(|e| e.to_string())?, text.map_err(|e| e.to_string())?);
    hdf5::sync::sync(|| {
        // SAFETY: the identifiers are those that the calls before gave, the text is as long as its type says, and the library is
        // locked.
        let written = unsafe {
            let of = h5t::H5Tcopy(*hdf5::globals::H5T_C_S1);
            h5t::H5Tset_size(of, text.as_bytes_with_nul().len());
            let space = h5s::H5Screate(h5s::H5S_class_t::H5S_SCALAR);
            let attribute =
                h5a::H5Acreate2(location.id(), name.as_ptr(), of, space, H5P_DEFAULT, H5P_DEFAULT);
            let written = h5a::H5Awrite(attribute, of, text.as_ptr().cast());
            h5a::H5Aclose(attribute);
            h5s::H5Sclose(space);
            h5t::H5Tclose(of);
            written
        };
        if written < 0 { Err("an attribute of a dimension scale cannot be written".into()) } else { Ok(()) }
    })
}

/// The attributes of every dataset.
///
/// # Errors
/// Those of the HDF5 library, here and below.
pub fn describe(dataset: &Dataset, units: &str, description: &str) -> hdf5::Result<()> {
    text_attribute(dataset, "units", units)?;
    text_attribute(dataset, "description", description)
}

/// An attribute with a single value.
///
/// # Errors
/// Those of the HDF5 library.
pub fn attribute<T: H5Type>(location: &Location, name: &str, value: &T) -> hdf5::Result<()> {
    location.new_attr::<T>().create(name)?.write_scalar(value)
}

/// An attribute with a text.
///
/// # Errors
/// Those of the HDF5 library.
pub fn text_attribute(location: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    location.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&unicode(text))
}

/// HDF5's strings end at a NUL, so one in the text cannot be kept.
fn unicode(text: &str) -> VarLenUnicode {
    text.replace('\0', "").parse().expect("holds no NUL")
}
