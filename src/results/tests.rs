//! Every quantity of a run is in HDF5, in JSON and in CSV under the same name, and equal.

use super::{ComplexResult, NamedModes, ResultsFile, RunResults, summary, summary_json, write_files};
use crate::dataset::{Entry, Group, Table, Values, Variable, link};
use crate::job::sample;
use crate::linalg::c64;
use hdf5::types::VarLenUnicode;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// A value as a file has it.
#[derive(Debug, Clone, PartialEq)]
enum Found {
    Nothing,
    Flag(bool),
    Number(f64),
    Text(String),
}

fn in_json(value: &Value, all: &mut Vec<Found>) {
    match value {
        Value::Null => all.push(Found::Nothing),
        Value::Bool(flag) => all.push(Found::Flag(*flag)),
        Value::Number(number) => all.push(Found::Number(number.as_f64().unwrap())),
        Value::String(text) if text.is_empty() => all.push(Found::Nothing),
        Value::String(text) => all.push(Found::Text(text.clone())),
        Value::Array(list) => list.iter().for_each(|value| in_json(value, all)),
        Value::Object(complex) => ["re", "im"].iter().for_each(|part| in_json(&complex[*part], all)),
    }
}

fn in_hdf5(dataset: &hdf5::Dataset) -> Vec<Found> {
    let number = |value: f64| if value.is_nan() { Found::Nothing } else { Found::Number(value) };
    let dtype = dataset.dtype().unwrap();
    if dtype.is::<bool>() {
        return dataset.read_raw::<bool>().unwrap().into_iter().map(Found::Flag).collect();
    }
    if dtype.is::<f64>() {
        return dataset.read_raw::<f64>().unwrap().into_iter().map(number).collect();
    }
    if dtype.is::<i64>() {
        let filled = dataset.attr("_FillValue").is_ok();
        let whole =
            |value: i64| if filled && value == -1 { Found::Nothing } else { Found::Number(value as f64) };
        return dataset.read_raw::<i64>().unwrap().into_iter().map(whole).collect();
    }
    if dtype.is::<c64>() {
        let both = |z: c64| [number(z.re), number(z.im)];
        return dataset.read_raw::<c64>().unwrap().into_iter().flat_map(both).collect();
    }
    let text = |text: VarLenUnicode| match text.as_str() {
        "" => Found::Nothing,
        text => Found::Text(text.into()),
    };
    dataset.read_raw::<VarLenUnicode>().unwrap().into_iter().map(text).collect()
}

/// The fields of the columns that begin with `key`, row after row.
fn in_csv(file: &Path, variable: &Variable) -> Vec<Found> {
    let mut reader = csv::Reader::from_path(file).unwrap();
    let of = |title: &str| {
        let name = title.split(" [").next().unwrap();
        let name = name.strip_prefix("re_").or(name.strip_prefix("im_")).unwrap_or(name);
        match variable.dimensions.get(1) {
            Some(_) => name.strip_prefix(&*variable.key).is_some_and(|rest| rest.starts_with('_')),
            None => name == variable.key,
        }
    };
    let columns: Vec<usize> =
        reader.headers().unwrap().iter().enumerate().filter(|(_, t)| of(t)).map(|(k, _)| k).collect();
    assert!(!columns.is_empty(), "{} has no column {}", file.display(), variable.key);
    let found = |text: &str| match (&variable.values, text) {
        (_, "") => Found::Nothing,
        (Values::Texts(_), text) => Found::Text(text.strip_prefix('\'').unwrap_or(text).into()),
        (Values::Flags(_), text) => Found::Flag(text.parse().unwrap()),
        (_, text) => Found::Number(text.parse().unwrap()),
    };
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    rows.iter().flat_map(|row| columns.iter().map(|k| found(&row[*k])).collect::<Vec<_>>()).collect()
}

/// Counts quantities that were compared.
struct Walk<'a> {
    folder: &'a Path,
    quantities: usize,
    in_csv: usize,
}

/// Within a group and all groups in it a dimension has one length, as a tree of datasets in xarray asks for.
fn lengths(group: &Group, above: &BTreeMap<&'static str, usize>) {
    let mut all = above.clone();
    let add = |variables: &[&Variable], all: &mut BTreeMap<&'static str, usize>| {
        for dimension in variables.iter().flat_map(|variable| &variable.dimensions) {
            let length = *all.entry(dimension.name).or_insert(dimension.length);
            assert_eq!(length, dimension.length, "{} of {}", dimension.name, group.key);
        }
    };
    let own = group.entries.iter().filter_map(|entry| match entry {
        Entry::Variable(variable) => Some(variable),
        _ => None,
    });
    add(&own.collect::<Vec<_>>(), &mut all);
    let mut table = |table: &Table| {
        let variables: Vec<&Variable> = table.columns.iter().chain(&table.fields).collect();
        add(&variables, &mut all.clone());
    };
    for entry in &group.entries {
        match entry {
            Entry::Table(inner) => table(inner),
            Entry::Parts(_, _, tables) => tables.iter().for_each(&mut table),
            Entry::Group(inner) => lengths(inner, &all),
            Entry::List(_, groups) => groups.iter().for_each(|inner| lengths(inner, &all)),
            Entry::Variable(_) | Entry::Absent(_) => {}
        }
    }
}

impl Walk<'_> {
    fn variable(&mut self, variable: &Variable, json: &Value, group: &hdf5::Group) {
        let name = format!("{}/{}", group.name(), variable.key);
        let dataset = group.dataset(&link(&variable.key)).unwrap_or_else(|_| panic!("{name} is not in HDF5"));
        assert_eq!(dataset.shape(), variable.shape(), "{name}");
        for attribute in ["units", "description"] {
            assert!(dataset.attr(attribute).is_ok(), "{name} has no {attribute}");
        }
        let scales = ["CLASS", "DIMENSION_LIST"].map(|attribute| dataset.attr(attribute).is_ok());
        assert_eq!(
            scales.iter().any(|there| *there),
            !variable.dimensions.is_empty(),
            "{name} has no coordinates"
        );
        self.quantities += 1;
        if variable.values.are_worked_out() {
            return;
        }
        let mut found = Vec::new();
        in_json(json, &mut found);
        assert_eq!(found, in_hdf5(&dataset), "{name}");
    }

    fn table(&mut self, table: &Table, json: Option<&[Value]>, group: &hdf5::Group) {
        let group = group.group(&table.key).unwrap_or_else(|_| panic!("{} is not in HDF5", table.key));
        assert_eq!(group.dataset(table.rows.name).unwrap().shape(), [table.rows.length]);
        assert!(table.json == json.is_some(), "{}", table.key);
        for column in &table.columns {
            let whole = in_hdf5(&group.dataset(&link(&column.key)).unwrap());
            if let Some(rows) = json {
                let values: Value = rows.iter().map(|row| row[&*column.key].clone()).collect();
                self.variable(column, &values, &group);
            }
            if let Some(file) = &table.file {
                let path = self.folder.join(format!("{file}.csv"));
                assert_eq!(in_csv(&path, column), whole, "{file} {}", column.key);
                self.in_csv += 1;
            }
        }
        table
            .fields
            .iter()
            .for_each(|field| assert_eq!(group.dataset(&field.key).unwrap().shape(), field.shape()));
    }

    fn group(&mut self, of: &Group, json: &Value, group: &hdf5::Group) {
        lengths(of, &BTreeMap::new());
        for entry in &of.entries {
            match entry {
                Entry::Variable(variable) => self.variable(variable, &json[&*variable.key], group),
                Entry::Group(inner) => {
                    self.group(inner, &json[&*inner.key], &group.group(&inner.key).unwrap())
                }
                Entry::Table(table) => {
                    let rows = json.get(&*table.key).map(|rows| rows.as_array().unwrap().as_slice());
                    self.table(table, rows, group);
                }
                Entry::List(key, groups) => {
                    for (k, inner) in groups.iter().enumerate() {
                        let place = group.group(key).and_then(|list| list.group(&link(&inner.key))).unwrap();
                        assert_eq!(json[*key][k]["name"], *inner.key);
                        self.group(inner, &json[*key][k], &place);
                    }
                }
                Entry::Parts(key, by, tables) => {
                    for table in tables {
                        let rows = json[*key].as_array().unwrap().iter().filter(|row| row[*by] == *table.key);
                        let rows: Vec<Value> = rows.cloned().collect();
                        self.table(table, Some(&rows), &group.group(key).unwrap());
                    }
                }
                Entry::Absent(key) => assert!(json[*key].is_null() && group.group(key).is_err(), "{key}"),
            }
        }
    }
}

pub(super) fn write_all(folder: &Path, results: &RunResults) -> hdf5::File {
    let mut file = ResultsFile::create(folder).unwrap();
    file.write_head(results).unwrap();
    file.write(&summary::analyses(results)).unwrap();
    file.take_place().unwrap();
    write_files(folder, results).unwrap();
    file.finish(results).unwrap();
    hdf5::File::open(folder.join("results.h5")).unwrap()
}

#[test]
fn every_quantity_is_in_all_files_under_the_same_name_and_equal() {
    let dir = tempfile::tempdir().unwrap();
    let results = sample::rig();
    let file = write_all(dir.path(), &results);
    let json = summary_json(&results);
    let mut walk = Walk { folder: dir.path(), quantities: 0, in_csv: 0 };
    for group in [summary::head(&results), summary::tail(&results), summary::analyses(&results)] {
        walk.group(&group, &json, &file.as_group().unwrap());
    }
    assert!(
        walk.quantities > 100 && walk.in_csv > 30,
        "{} quantities, {} in CSV",
        walk.quantities,
        walk.in_csv
    );
}

#[test]
fn fields_read_back_bit_for_bit() {
    let dir = tempfile::tempdir().unwrap();
    let results = sample::rig();
    let file = write_all(dir.path(), &results);
    let set = results.get::<NamedModes>().unwrap();
    let shapes = file.dataset("modes/disc/shapes").unwrap().read_raw::<f64>().unwrap();
    assert!(shapes.into_iter().eq((0..set.modes.len()).flat_map(|k| set.shape(k)).flatten()));
    let complex = results.get::<ComplexResult>().unwrap();
    let right = file.dataset("cea/eigenvalues/right").unwrap().read_raw::<c64>().unwrap();
    assert!(right.into_iter().eq((0..complex.modes.modes.len()).flat_map(|k| complex.shape(k)).flatten()));
    let case = file.dataset("case").unwrap().read_scalar::<VarLenUnicode>().unwrap();
    assert_eq!(case.as_str(), results.resolved_case);
}
