//! Everything of a run as one group: `summary.json`, `results.h5` and the tables come from it.
//!
//! `summary.json` is a contract that scripts may rely on: a change of a key that could break a reader raises
//! [`SCHEMA_VERSION`]. Keys are snake_case and name the unit where it is not plain SI or obvious (`growth_rate` σ is in 1/s).
//! A number that is not finite is `null`.

use super::provenance::Provenance;
use super::record::InputFile;
use super::{Geometry, ModelSize, RunResults, write_result};
use crate::dataset::{Describe, Dimension, Group, Table, Values, Variable, column};
use crate::error::Result;
use crate::mesh::Cell;
use serde_json::Value;
use std::path::Path;

/// The version of the layout of `summary.json` and `results.h5`.
pub const SCHEMA_VERSION: u32 = 3;

/// Writes `summary.json` into the folder `dir`, whole or not at all.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or the file not be written.
pub fn write_summary(dir: &Path, results: &RunResults) -> Result<()> {
    let text = format!("{:#}\n", summary_json(results));
    write_result(dir, "summary.json", text.as_bytes())
}

/// Contents of `summary.json`.
pub fn summary_json(results: &RunResults) -> Value {
    let mut json = Group::new("", "")
        .value("schema_version", "1", "version of the layout", SCHEMA_VERSION)
        .value("program", "text", "name of the program", env!("CARGO_PKG_NAME"))
        .value("program_version", "text", "its version", env!("CARGO_PKG_VERSION"))
        .value("complete", "1", "whether every requested analysis is present", results.failed.is_none())
        .value("failed", "text", "error message of the analysis that failed", results.failed.clone())
        .to_json();
    let parts = [head(results), tail(results), expected(), analyses(results)].map(|group| group.to_json());
    if let Some(object) = json.as_object_mut() {
        for part in parts {
            object.extend(part.as_object().cloned().unwrap_or_default());
        }
        object.insert("case".into(), case_object(&results.resolved_case));
    }
    json
}

/// The resolved case as a JSON object; `null` where it is not TOML (its text is in `results.h5` all the same).
fn case_object(toml_text: &str) -> Value {
    let table: Option<toml::Table> = toml_text.parse().ok();
    table.and_then(|table| serde_json::to_value(table).ok()).unwrap_or_default()
}

impl Describe for RunResults {
    /// Everything that `results.h5` has, but for the histories of a run in time and its events.
    fn describe(&self) -> Group<'_> {
        [analyses(self), tail(self)].into_iter().fold(model(self), Group::merged)
    }
}

/// Group of the model: what is known before the first analysis, with the case and the geometry.
pub(super) fn model(results: &RunResults) -> Group<'_> {
    let story = "the case with every default written out, as TOML";
    let case = Variable::text("case", story, &results.resolved_case);
    head(results).with(case).group(results.geometry.group())
}

/// Group of the data that are known before the first analysis.
pub(super) fn head(results: &RunResults) -> Group<'_> {
    let ModelSize { nodes, elements, dofs, nonzeros, contact_points } = results.size;
    let model = Group::new("model", "size of the model")
        .value("nodes", "1", "nodes of the mesh in use", nodes)
        .value("elements", "1", "elements in use", elements)
        .value("dofs", "1", "free degrees of freedom", dofs)
        .value("stiffness_nonzeros", "1", "stored entries of K, both triangles", nonzeros)
        .value("contact_points", "1", "contact points that may touch", contact_points);
    let inputs = [
        column("path", "text", "as the case names it", |file: &InputFile| file.path.clone()),
        column("bytes", "1", "length in bytes", |file: &InputFile| file.bytes),
        column("sha256", "text", "SHA-256 of its content", |file: &InputFile| file.sha256.clone()),
    ];
    Group::new("", "")
        .value("title", "text", "title of the case", results.title.clone())
        .with(sentences(
            "assumptions",
            "what the case assumes and its source does not state",
            &results.assumptions,
        ))
        .table(Table::by("inputs", "path", &inputs, &results.inputs))
        .group(model)
}

/// Group of the data that are known at the end.
pub(super) fn tail(results: &RunResults) -> Group<'_> {
    let timings = [
        column("phase", "text", "phase of the run", |(phase, _): &(String, f64)| phase.clone()),
        column("wall_s", "s", "its wall time", |(_, seconds): &(String, f64)| *seconds),
    ];
    Group::new("", "")
        .with(sentences("warnings", "what the user should know", &results.warnings))
        .table(Table::by("timings", "phase", &timings, &results.timings))
        .optional("provenance", results.provenance.as_ref().map(Provenance::group))
}

pub(super) fn sentences<'a>(
    key: &'static str,
    description: &'static str,
    sentences: &[String],
) -> Variable<'a> {
    Variable::texts(key, description, Dimension::of_variable(key, sentences.len()), sentences.to_vec())
}

/// Groups of the analyses.
pub(super) fn analyses(results: &RunResults) -> Group<'_> {
    results.records.iter().fold(Group::new("", ""), |all, record| all.merged(record.describe()))
}

/// Keys of `summary.json` that are there whatever was run: empty lists, and `null` for single results.
fn expected<'a>() -> Group<'a> {
    let lists =
        ["mode_sets", "modes", "frf", "sweeps", "maps", "uncertainty", "comparison", "comparison_frf"];
    let single = ["steady_sliding", "cea", "sensitivity", "transient", "calibration", "damping_verdicts"];
    let group = lists.into_iter().fold(Group::new("", ""), |group, key| group.list(key, Vec::new()));
    single.into_iter().fold(group, |group, key| group.optional(key, None))
}

impl Geometry {
    /// Nodes, elements and parts.
    fn group(&self) -> Group<'_> {
        let whole = |numbers: Vec<usize>| Values::Integers(numbers.into_iter().map(|n| n as i64).collect());
        let nodes = vec![Dimension::indexed("node", self.nodes.len()), Dimension::axes()];
        let flat: Vec<usize> = self.cells.iter().flat_map(Cell::to_vtk).collect();
        let mut offsets = vec![0];
        offsets.extend(self.cells.iter().scan(0, |end, cell| {
            *end += cell.nodes().len();
            Some(*end)
        }));
        let entries = vec![Dimension::indexed("entry", flat.len())];
        let ends = vec![Dimension::indexed("offset", offsets.len())];
        let elements = vec![Dimension::indexed("element", self.cells.len())];
        let parts = Dimension::indexed("part", self.parts.len());
        let story = "element e has the entries offsets[e] to offsets[e + 1] of element_nodes";
        let coordinates = Values::RealRows(Box::new(|node| self.nodes[node].to_vec()));
        Group::new("geometry", "nodes and elements as the analyses saw them")
            .with(Variable::new("nodes", "m", "coordinates of every node", nodes, coordinates))
            .with(Variable::new(
                "element_nodes",
                "1",
                "node indices, element after element, each in the order of VTK",
                entries,
                whole(flat),
            ))
            .with(Variable::new("element_offsets", "1", story, ends, whole(offsets)))
            .with(Variable::new(
                "element_part",
                "1",
                "part of every element",
                elements,
                whole(self.part_of_cell.clone()),
            ))
            .with(Variable::new(
                "element_kind",
                "1",
                "kind of every element, by its number in VTK files",
                vec![Dimension::indexed("element", self.cells.len())],
                whole(self.cells.iter().map(|cell| usize::from(cell.kind().table().vtk.number)).collect()),
            ))
            .with(Variable::texts("part_names", "names of the parts", parts, self.parts.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;
    use crate::results::ComplexResult;
    use crate::results::MeasuredComparison;
    use crate::results::NamedModes;
    use crate::results::SteadyResult;
    use serde_json::Value;

    fn written(results: &RunResults) -> Value {
        let dir = tempfile::tempdir().unwrap();
        write_summary(dir.path(), results).unwrap();
        serde_json::from_slice(&std::fs::read(dir.path().join("summary.json")).unwrap()).unwrap()
    }

    #[test]
    fn the_contract_holds() {
        let results = sample::rig();
        let json = written(&results);
        assert_eq!(json["schema_version"], SCHEMA_VERSION);
        assert_eq!(json["program_version"], env!("CARGO_PKG_VERSION"));
        assert_eq!(json["modes"][0]["frequency_hz"], results.all::<NamedModes>()[0].modes.frequency_hz(0));
        assert_eq!(json["modes"][0]["nodal_diameters"], 1);
        assert_eq!(json["mode_sets"][0]["certificate"]["holds"], true);
        let complex = results.get::<ComplexResult>().unwrap();
        let last = complex.modes.modes.len() - 1;
        assert_eq!(json["cea"]["eigenvalues"][last]["growth_rate"], complex.modes.modes[last].growth_rate());
        let unstable =
            json["cea"]["eigenvalues"].as_array().unwrap().iter().filter(|e| e["unstable"] == true);
        assert_eq!(unstable.count(), json["cea"]["unstable"].as_u64().unwrap() as usize);
        // The pairs' forces are the sums over their points, which carry 20 N.
        let pair = &json["steady_sliding"]["pairs"][0];
        assert!(within((pair["normal_force_n"].as_f64().unwrap() - 20.0).abs(), 1e-9, Tolerance));
        let points = &results.get::<SteadyResult>().unwrap().state.points;
        let friction: f64 = points.iter().map(|point| point.forces.friction[0]).sum();
        assert!(
            within((pair["friction_force_n"][0].as_f64().unwrap() - friction).abs(), 1e-12, RoundOff)
                && friction > 12.0
        );
        assert_eq!(json["case"]["contact"]["rim"]["friction"]["mu0"], 0.6);
        assert_eq!(json["timings"][1]["phase"], results.timings[1].0.as_str());
    }

    #[test]
    fn scaled_frequencies_are_compared_with_the_measured_ones() {
        let results = sample::rig();
        let row = &written(&results)["comparison"][0]["modes"][1];
        let k = row["mode"].as_u64().unwrap() as usize - 1;
        let computed = results.all::<NamedModes>()[0].modes.frequency_hz(k)
            * results.all::<MeasuredComparison>()[0].frequency_scale;
        // The product in another order.
        assert!(within(
            (row["computed_hz"].as_f64().unwrap() / computed - 1.0).abs(),
            20.0 * f64::EPSILON,
            RoundOff
        ));
        let percent = row["difference_percent"].as_f64().unwrap();
        assert!(within((percent - 100.0 * (computed / 936.0 - 1.0)).abs(), 1e-12, RoundOff));
    }

    #[test]
    fn numbers_that_are_not_finite_and_empty_runs_give_valid_json() {
        let mut results = sample::rig();
        results.get_mut::<NamedModes>().unwrap().modes.backward_errors[0] = f64::NAN;
        results.timings[0].1 = f64::INFINITY;
        results.resolved_case = "a = nan\nb = inf".into();
        let json = written(&results);
        assert!(json["modes"][0]["backward_error"].is_null() && json["timings"][0]["wall_s"].is_null());
        assert!(json["case"]["a"].is_null() && json["case"]["b"].is_null());
        let empty = written(&RunResults::default());
        assert!(empty["cea"].is_null() && empty["modes"].as_array().unwrap().is_empty());
    }
}
