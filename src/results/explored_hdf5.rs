//! `/sweep/<name>` and `/map/<name>` of `results.h5`. A map is written in chunks, each flushed, so that a killed run
//! leaves its first points.
//!
//! | group | datasets |
//! |---|---|
//! | `/sweep/<name>` | `value`, `eigenvalue` (branch × value), `lowest_mac`, `critical_…`, `encounter_…`, `sample_…` |
//! | `/map/<name>` | `value_1`, `value_2`, `growth_rate`, `frequency_hz`, `unstable` (2 × 1), `boundary_…`, `sample_…` |

use super::hdf5::{Datasets, attribute, rows, text_attribute, texts};
use super::{MapResult, Method, ResultsFile, SweepResult};
use crate::error::Result;
use crate::linalg::c64;
use crate::sweep::{Checked, Critical, CriticalKind, Encounter, EncounterKind, MapPoint};
use hdf5::Group;
use ndarray::{Array2, s};

/// What a critical value is called in files.
pub(super) fn kind_name(kind: CriticalKind) -> &'static str {
    match kind {
        CriticalKind::Merging => "merging",
        CriticalKind::Growth => "growth",
        CriticalKind::Divergence => "divergence",
    }
}

/// What an encounter is called in files.
pub(super) fn encounter_name(kind: EncounterKind) -> &'static str {
    match kind {
        EncounterKind::Crossing => "crossing",
        EncounterKind::Veering => "veering",
        EncounterKind::Merging => "merging",
    }
}

impl ResultsFile {
    /// Writes a sweep.
    ///
    /// # Errors
    /// As every method of the file: the machine refuses.
    pub fn write_sweep(&mut self, sweep: &SweepResult) -> Result<()> {
        self.keep(|root| write_sweep(root, sweep))
    }

    /// Begins a map, or begins it again: its axes, room for its points, and those that are `known`.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn begin_map(&mut self, map: &MapResult, known: &[MapPoint], trained: &[[f64; 2]]) -> Result<()> {
        self.keep(|root| begin_map(root, map, trained))?;
        self.write_map_points(&map.name, 0, known)?;
        self.take_place()
    }

    /// Writes points of the map `name`, from point `first` on.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn write_map_points(&mut self, name: &str, first: usize, points: &[MapPoint]) -> Result<()> {
        self.fill(|root| {
            let group = root.group(&format!("map/{name}"))?;
            let part = s![first..first + points.len()];
            let growth: Vec<f64> = points.iter().map(|p| p.growth_rate).collect();
            group.dataset("growth_rate")?.write_slice(&growth, part)?;
            let hz: Vec<f64> = points.iter().map(|p| p.frequency_hz).collect();
            group.dataset("frequency_hz")?.write_slice(&hz, part)?;
            let unstable: Vec<u32> = points.iter().map(|p| p.unstable).collect();
            group.dataset("unstable")?.write_slice(&unstable, part)
        })?;
        // They count when they are on the disk.
        self.fill(|root| {
            let group = root.group(&format!("map/{name}"))?;
            group.attr("points_done")?.write_scalar(&((first + points.len()) as u64))
        })
    }

    /// Writes what a map has when all its points are there: the boundary and the full-order sample.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn finish_map(&mut self, map: &MapResult) -> Result<()> {
        self.stage(|root| {
            let group = Datasets(root.group(&format!("map/{}", map.name))?);
            let story = "places where the largest growth rate is zero: first and second parameter";
            group.write("boundary_points", rows(&map.boundary.points).view(), "as the parameters", story)?;
            let lines: Vec<u64> = map.boundary.lines.iter().flatten().map(|p| *p as u64).collect();
            group.list("boundary_lines", &lines, "1", "indices into boundary_points, line after line")?;
            let mut offsets = vec![0_u64];
            for line in &map.boundary.lines {
                offsets.push(offsets[offsets.len() - 1] + line.len() as u64);
            }
            let story = "line k has the entries offsets[k] to offsets[k + 1] of boundary_lines";
            group.list("boundary_offsets", &offsets, "1", story)?;
            let (places, errors): (Vec<[f64; 2]>, Vec<f64>) = map.sample.iter().copied().unzip();
            let story = "places where all modes were measured on the full order";
            group.write("sample_place", rows(&places).view(), "as the parameters", story)?;
            group.list("sample_error", &errors, "1", "largest estimated |Δλ|/|λ| there")?;
            attribute(&group.0, "reduced_dimension", &dimension(map.method))?;
            attribute(&group.0, "complete", &true)
        })
    }
}

/// The size of the reduced model; 0 for whole analyses.
fn dimension(method: Method) -> u64 {
    match method {
        Method::Reduced(m) => m as u64,
        Method::Whole => 0,
    }
}

fn write_sweep(root: &Group, result: &SweepResult) -> hdf5::Result<()> {
    let group = Datasets(root.create_group(&format!("sweep/{}", result.name))?);
    text_attribute(&group.0, "parameter", &result.parameter)?;
    attribute(&group.0, "nominal", &result.nominal)?;
    attribute(&group.0, "reduced_dimension", &dimension(result.method))?;
    let (sweep, unit) = (&result.sweep, unit(&result.unit));
    group.list("value", &sweep.values, unit, "values of the parameter")?;
    let nothing = c64::new(f64::NAN, f64::NAN);
    let shape = (sweep.branches.len(), sweep.values.len());
    let all = Array2::from_shape_fn(shape, |(b, k)| sweep.branches[b].at(k).unwrap_or(nothing));
    group.write(
        "eigenvalue",
        all.view(),
        "1/s",
        "λ = σ + iω: branch × value; not a number where it has none",
    )?;
    let mac: Vec<f64> = sweep.branches.iter().map(|b| b.lowest_mac).collect();
    group.list("lowest_mac", &mac, "1", "least likeness of neighbouring shapes along each branch")?;
    let critical = &sweep.critical;
    let of = |f: &dyn Fn(&Critical) -> f64| critical.iter().map(f).collect::<Vec<f64>>();
    group.list("critical_value", &of(&|c| c.value), unit, "where a branch becomes unstable or stable")?;
    let errors: Vec<f64> = (0..critical.len()).map(|k| result.value_error(k)).collect();
    group.list("critical_value_error", &errors, "1", "estimated relative error of the value")?;
    let z: Vec<c64> = critical.iter().map(|c| c.eigenvalue).collect();
    group.list("critical_eigenvalue", &z, "1/s", "λ there")?;
    let branch: Vec<u64> = critical.iter().map(|c| c.branch as u64).collect();
    group.list("critical_branch", &branch, "1", "the branch")?;
    let rises: Vec<bool> = critical.iter().map(|c| c.rises).collect();
    group.list("critical_rises", &rises, "1", "whether it is unstable beyond, along the sweep")?;
    let kinds: Vec<String> = critical.iter().map(|c| kind_name(c.kind).to_string()).collect();
    texts(&group.0, "critical_kind", &kinds, "merging (flutter), growth (σ passes zero) or divergence")?;
    let full = |f: fn(&Checked) -> f64| -> Vec<f64> {
        result.verified.iter().map(|c| c.as_ref().map_or(f64::NAN, f)).collect()
    };
    group.list("critical_backward_error", &full(|c| c.backward_error), "1", "η at full order")?;
    group.list("critical_eigenvalue_error", &full(|c| c.eigenvalue_error), "1", "|Δλ|/|λ| at full order")?;
    let meetings = &sweep.encounters;
    let of = |f: &dyn Fn(&Encounter) -> f64| meetings.iter().map(f).collect::<Vec<f64>>();
    group.list("encounter_value", &of(&|e| e.value), unit, "where two branches are nearest")?;
    group.list("encounter_distance", &of(&|e| e.distance), "1", "|λ₁ − λ₂|/|λ| there")?;
    let pairs: Vec<[u64; 2]> = meetings.iter().map(|e| e.branches.map(|b| b as u64)).collect();
    let pairs = Array2::from_shape_fn((pairs.len(), 2), |(k, i)| pairs[k][i]);
    group.write("encounter_branches", pairs.view(), "1", "the two branches")?;
    let kinds: Vec<String> = meetings.iter().map(|e| encounter_name(e.kind).to_string()).collect();
    texts(&group.0, "encounter_kind", &kinds, "crossing, veering or merging")?;
    let (values, errors): (Vec<f64>, Vec<f64>) = result.sample.iter().copied().unzip();
    group.list("sample_value", &values, unit, "values at which all modes were measured on the full order")?;
    group.list("sample_error", &errors, "1", "largest estimated |Δλ|/|λ| there")
}

fn begin_map(root: &Group, map: &MapResult, trained: &[[f64; 2]]) -> hdf5::Result<()> {
    let name = format!("map/{}", map.name);
    if root.link_exists(&name) {
        root.unlink(&name)?;
    }
    let group = Datasets(root.create_group(&name)?);
    for (k, path) in map.parameters.iter().enumerate() {
        text_attribute(&group.0, &format!("parameter_{}", k + 1), path)?;
        attribute(&group.0, &format!("nominal_{}", k + 1), &map.nominal[k])?;
        let story =
            "values of the parameter; point i + n₁ j of the map has value i of the first, j of the second";
        group.list(&format!("value_{}", k + 1), &map.axes[k].values(), unit(&map.units[k]), story)?;
    }
    let total = map.axes[0].points * map.axes[1].points;
    let empty = vec![f64::NAN; total];
    group.list("growth_rate", &empty, "1/s", "the largest σ of all modes in the band")?;
    group.list("frequency_hz", &empty, "Hz", "ω/2π of that mode")?;
    group.list("unstable", &vec![0_u32; total], "1", "how many modes grow")?;
    let story = "places on which the reduced model was trained beyond those of every run";
    group.write("trained_place", rows(trained).view(), "as the parameters", story)?;
    attribute(&group.0, "points_done", &0_u64)
}

fn unit(unit: &str) -> &str {
    if unit.is_empty() { "1" } else { unit }
}
