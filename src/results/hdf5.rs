//! What stands in `results.h5`, stage by stage; how it is written safely: `file.rs`.
//!
//! Every dataset has the attributes `units` and `description`.
//!
//! | group | datasets |
//! |---|---|
//! | `/case` | `resolved_toml`, `assumptions`; `input_path`, `input_bytes`, `input_sha256` of the files it reads |
//! | `/geometry` | `nodes`, `element_nodes`, `element_offsets`, `element_part`, `part_names` |
//! | `/modes/<set>` | `frequency_hz`, `shapes`, `nodal_diameters`, `nodal_circles`, `backward_error`, `effective_mass` |
//! | `/measured/<k>` | `frequency_hz`, `deviation`, `damping_ratio`, `mode`, `level`, `mac` |
//! | `/measured_frf/<name>/<k>` | `frequency_hz`, `measured`, `computed` |
//! | `/steady` | `displacement`, `approach`, contact points with forces and tangents, pairs |
//! | `/complex` | `eigenvalue`, `right`, `left`, errors, `verdict`, `growth_…`, `participation` |
//! | `/sensitivity/mode_<k>` | `parameter`, `value`, `rate`, errors; `point_mass`, `point_spring`, `point_damper`, best places |
//! | `/transient` | a dataset for each channel; spectra with their peaks; see `transient_hdf5.rs` |
//! | `/sweep/<name>`, `/map/<name>` | branches, critical values; grids, boundary; see `explored_hdf5.rs` |
//! | `/timings`, `/warnings` | `phase`, `wall_time`; sentences |

use super::{
    ComplexResult, Geometry, NamedModes, NodalField, ParameterRate, ResultsFile, RunResults,
    SensitivityResult, SteadyResult,
};
use crate::error::Result;
use crate::linalg::c64;
use crate::stability::ComplexMode;
use hdf5::types::VarLenUnicode;
use hdf5::{Group, H5Type};
use ndarray::{Array1, Array2, Array3, ArrayView, ArrayViewD, Dimension};

/// Units of a mass-normalised displacement and rotation: φᵀMφ = 1.
const SHAPE_UNITS: &str = "1/√kg, 1/(m √kg)";

impl ResultsFile {
    /// Writes title, resolved case and assumptions.
    pub fn write_case(&mut self, results: &RunResults) -> Result<()> {
        self.stage(|root| {
            let group = root.create_group("case")?;
            text_attribute(&group, "title", &results.title)?;
            let size = &results.size;
            attribute(&group, "dofs", &(size.dofs as u64))?;
            attribute(&group, "stiffness_nonzeros", &(size.nonzeros as u64))?;
            let toml = group.new_dataset::<VarLenUnicode>().create("resolved_toml")?;
            toml.write_scalar(&unicode(&results.resolved_case))?;
            describe(&toml, "text", "the case with every default written out, as TOML")?;
            let inputs = &results.inputs;
            let paths: Vec<String> = inputs.iter().map(|file| file.path.clone()).collect();
            texts(&group, "input_path", &paths, "the files that the case reads")?;
            let digests: Vec<String> = inputs.iter().map(|file| file.sha256.clone()).collect();
            texts(&group, "input_sha256", &digests, "SHA-256 of each")?;
            let bytes: Vec<u64> = inputs.iter().map(|file| file.bytes).collect();
            Datasets(group.clone()).list("input_bytes", &bytes, "byte", "the length of each")?;
            texts(
                &group,
                "assumptions",
                &results.assumptions,
                "what the case assumes and its source does not state",
            )
        })
    }

    /// Writes nodes, elements and parts.
    pub fn write_geometry(&mut self, geometry: &Geometry) -> Result<()> {
        self.stage(|root| {
            let group = Datasets(root.create_group("geometry")?);
            let nodes = rows(&geometry.nodes);
            group.write("nodes", nodes.view(), "m", "coordinates of every node: x, y, z")?;
            let flat: Vec<u64> = geometry.elements.iter().flatten().map(|n| *n as u64).collect();
            group.list("element_nodes", &flat, "1", "node indices of all elements, one after the other")?;
            let mut offsets = vec![0_u64];
            for element in &geometry.elements {
                offsets.push(offsets.last().expect("begins with one") + element.len() as u64);
            }
            let story = "element e has the entries offsets[e] to offsets[e + 1] of element_nodes";
            group.list("element_offsets", &offsets, "1", story)?;
            let part: Vec<u64> = geometry.part_of.iter().map(|p| *p as u64).collect();
            group.list("element_part", &part, "1", "the part of every element, an index into part_names")?;
            texts(&group.0, "part_names", &geometry.parts, "names of the parts")
        })
    }

    /// Writes one set of real modes.
    pub fn write_modes(&mut self, set: &NamedModes) -> Result<()> {
        let name = self.names.next(&set.name);
        self.keep(|root| write_mode_set(root, &name, set))
    }

    /// Writes steady sliding.
    pub fn write_steady(&mut self, steady: &SteadyResult) -> Result<()> {
        self.keep(|root| write_steady(root, steady))
    }

    /// Writes the complex modes.
    pub fn write_complex(&mut self, complex: &ComplexResult) -> Result<()> {
        self.keep(|root| write_complex(root, complex))
    }

    /// Writes the sensitivities of the complex modes.
    pub fn write_sensitivity(&mut self, sensitivity: &SensitivityResult) -> Result<()> {
        self.keep(|root| write_sensitivity(root, sensitivity))
    }
}

fn write_mode_set(root: &Group, name: &str, set: &NamedModes) -> hdf5::Result<()> {
    let group = Datasets(root.create_group(&format!("modes/{name}"))?);
    text_attribute(&group.0, "name", &set.name)?;
    attribute(&group.0, "total_mass_kg", &set.total_mass)?;
    attribute(&group.0, "rigid_bodies", &(set.modes.rigid_bodies as u64))?;
    let certificate = &set.modes.certificate;
    attribute(&group.0, "certificate_below_hz", &certificate.below_hz)?;
    attribute(&group.0, "certificate_shift_1_hz", &certificate.shifts_hz[0])?;
    attribute(&group.0, "certificate_shift_2_hz", &certificate.shifts_hz[1])?;
    attribute(&group.0, "certificate_counted_1", &(certificate.counted[0] as u64))?;
    attribute(&group.0, "certificate_counted_2", &(certificate.counted[1] as u64))?;
    attribute(&group.0, "certificate_found", &(certificate.found as u64))?;
    attribute(&group.0, "certificate_holds", &certificate.holds())?;
    let hz: Vec<f64> = (0..set.modes.len()).map(|k| set.modes.frequency_hz(k)).collect();
    group.list("frequency_hz", &hz, "Hz", "natural frequencies, ascending")?;
    group.list("eigenvalue", &set.modes.eigenvalues, "rad²/s²", "ω² as computed")?;
    let story = "mass-normalised shapes: mode × node × (ux, uy, uz, rx, ry, rz)";
    group.write("shapes", fields(&set.shapes).view(), SHAPE_UNITS, story)?;
    let named = |count: fn(&crate::modal::DiscModeName) -> usize| -> Vec<i32> {
        set.names.iter().map(|name| name.as_ref().map_or(-1, |name| count(name) as i32)).collect()
    };
    group.list(
        "nodal_diameters",
        &named(|n| n.nodal_diameters),
        "1",
        "nodal diameters, -1 where not named",
    )?;
    group.list("nodal_circles", &named(|n| n.nodal_circles), "1", "nodal circles, -1 where not named")?;
    let story = "‖Kφ − ω²Mφ‖ / ((‖K‖ + |ω²| ‖M‖) ‖φ‖)";
    group.list("backward_error", &set.modes.backward_errors, "1", story)?;
    group.list("damping_ratio", &set.damping_ratio, "1", "by the damping of the case")?;
    group.write(
        "effective_mass",
        rows(&set.effective_mass).view(),
        "kg",
        "modal effective mass along x, y, z",
    )
}

fn write_steady(root: &Group, steady: &SteadyResult) -> hdf5::Result<()> {
    let group = Datasets(root.create_group("steady")?);
    attribute(&group.0, "iterations", &(steady.state.iterations as u64))?;
    attribute(&group.0, "residual", &steady.state.residual)?;
    let story = "displacement of every node: ux, uy, uz, rx, ry, rz";
    group.write("displacement", rows(&steady.displacement).view(), "m, rad", story)?;
    let pairs: Vec<String> = steady.pairs.iter().map(|(name, ..)| name.clone()).collect();
    texts(&group.0, "pair_names", &pairs, "contact pairs")?;
    let load: Vec<f64> = steady.pairs.iter().map(|(_, load, _)| *load).collect();
    group.list("load", &load, "N", "load of each pair")?;
    let velocity: Vec<f64> = steady.pairs.iter().map(|(.., velocity)| *velocity).collect();
    group.list("sliding_velocity", &velocity, "m/s", "sliding velocity of each pair")?;
    group.list("approach", &steady.state.approach, "m", "approach of each pair")?;
    let (names, places): (Vec<String>, Vec<[f64; 3]>) = steady.points.iter().cloned().unzip();
    texts(&group.0, "point_pair", &names, "pair of every contact point")?;
    group.write("point_position", rows(&places).view(), "m", "position of every contact point")?;
    let points = &steady.state.points;
    let of = |value: fn(&crate::equilibrium::PointState) -> f64| -> Vec<f64> {
        points.iter().map(value).collect()
    };
    group.list("penetration", &of(|p| p.penetration), "m", "δ, negative when open")?;
    group.list("normal_force", &of(|p| p.forces.normal), "N", "N, positive in compression")?;
    let friction: Vec<[f64; 2]> = points.iter().map(|p| p.forces.friction).collect();
    group.write("friction_force", rows(&friction).view(), "N", "F₁, F₂ on the body, along t₁ and t₂")?;
    let closed: Vec<bool> = points.iter().map(|p| p.closed()).collect();
    group.list("closed", &closed, "1", "whether the point carries load")?;
    let stiffness: Vec<[f64; 3]> = points.iter().map(|p| p.tangent.by_penetration).collect();
    group.write("force_by_penetration", rows(&stiffness).view(), "N/m", "∂(N, F₁, F₂)/∂δ")?;
    let rate: Vec<[f64; 3]> = points.iter().map(|p| p.tangent.by_penetration_rate).collect();
    group.write("force_by_penetration_rate", rows(&rate).view(), "N s/m", "∂(N, F₁, F₂)/∂δ̇")?;
    let slip = |(p, i, j): (usize, usize, usize)| points[p].tangent.by_slip_velocity[i][j];
    let slip = Array3::from_shape_fn((points.len(), 3, 2), slip);
    group.write("force_by_slip_velocity", slip.view(), "N s/m", "∂(N, F₁, F₂)/∂(v₁, v₂)")
}

fn write_complex(root: &Group, complex: &ComplexResult) -> hdf5::Result<()> {
    let group = Datasets(root.create_group("complex")?);
    let modes = &complex.modes.modes;
    attribute(&group.0, "subspace_dimension", &(complex.modes.subspace_dimension as u64))?;
    attribute(&group.0, "refinements", &(complex.modes.refinements as u64))?;
    group.list("band_hz", &complex.band_hz, "Hz", "frequency band of the analysis")?;
    if let Some(certificate) = &complex.certificate {
        attribute(&group.0, "certificate_holds", &certificate.holds())?;
        attribute(&group.0, "certificate_unstable_counted", &certificate.counted)?;
        attribute(&group.0, "certificate_unstable_found", &certificate.found)?;
        attribute(&group.0, "certificate_margin", &certificate.margin)?;
        attribute(&group.0, "certificate_proven", &certificate.proven)?;
        let growth = "growth rates between which eigenvalues were counted";
        group.list("certificate_growth_rate", &certificate.growth, "1/s", growth)?;
        let band = "frequencies between which eigenvalues were counted; from zero on with their conjugates";
        group.list("certificate_band_hz", &certificate.band_hz, "Hz", band)?;
    }
    let eigenvalues: Vec<c64> = modes.iter().map(|m| m.eigenvalue).collect();
    group.list("eigenvalue", &eigenvalues, "1/s", "λ = σ + iω; unstable when σ > 0")?;
    let of = |value: fn(&ComplexMode) -> f64| -> Vec<f64> { modes.iter().map(value).collect() };
    group.list("frequency_hz", &of(ComplexMode::frequency_hz), "Hz", "ω/2π")?;
    group.list("growth_rate", &of(ComplexMode::growth_rate), "1/s", "σ")?;
    group.list("damping_ratio", &of(ComplexMode::damping_ratio), "1", "−σ/|λ|")?;
    group.list(
        "backward_error",
        &of(|m| m.backward_error),
        "1",
        "‖Q(λ)φ‖ / ((|λ|²‖M‖ + |λ|‖C‖ + ‖K‖)‖φ‖)",
    )?;
    group.list("eigenvalue_error", &of(|m| m.eigenvalue_error), "1", "estimated |Δλ|/|λ|")?;
    group.list("condition", &of(|m| m.condition), "1", "condition number of λ")?;
    let part = "part of the growth rate: the four add up to it";
    group.list("growth_structural_damping", &of(|m| m.growth.structural_damping), "1/s", part)?;
    group.list("growth_falling_friction", &of(|m| m.growth.falling_friction), "1/s", part)?;
    group.list("growth_transverse_friction", &of(|m| m.growth.transverse_friction), "1/s", part)?;
    group.list("growth_mode_coupling", &of(|m| m.growth.mode_coupling), "1/s", part)?;
    let story = "φ at every node, φᴴMφ = 1: mode × node × (ux, uy, uz, rx, ry, rz)";
    group.write("right", fields(&complex.shapes).view(), SHAPE_UNITS, story)?;
    if let Some(n_dofs) = modes.first().map(|m| m.left.len()).filter(|n| *n > 0) {
        let left = Array2::from_shape_fn((modes.len(), n_dofs), |(m, i)| modes[m].left[i]);
        let story = "ψ on the free degrees of freedom of the solver, ψᴴQ(λ) = 0";
        group.write("left", left.view(), SHAPE_UNITS, story)?;
    }
    let n_real = modes.iter().flat_map(|m| &m.participation).map(|(k, _)| k + 1).max().unwrap_or(0);
    let mut share = Array2::<f64>::zeros((modes.len(), n_real));
    for (m, mode) in modes.iter().enumerate() {
        mode.participation.iter().for_each(|(k, value)| share[(m, *k)] = *value);
    }
    group.write("participation", share.view(), "1", "share of each real mode: complex mode × real mode")?;
    let verdicts: Vec<String> = modes.iter().map(|m| m.verdict().word().to_string()).collect();
    texts(
        &group.0,
        "verdict",
        &verdicts,
        "what the growth rate says: stable, unstable, undecided, not accurate",
    )?;
    texts(&group.0, "participation_text", &complex.participation, "the real modes that take part, in words")
}

fn write_sensitivity(root: &Group, sensitivity: &SensitivityResult) -> hdf5::Result<()> {
    let root = root.create_group("sensitivity")?;
    let (paths, reasons): (Vec<String>, Vec<String>) = sensitivity.left_out.iter().cloned().unzip();
    texts(&root, "left_out", &paths, "scalars that were asked for and have no derivative")?;
    texts(&root, "left_out_reason", &reasons, "why they have none")?;
    for result in &sensitivity.modes {
        let group = Datasets(root.create_group(&format!("mode_{:02}", result.mode + 1))?);
        attribute(&group.0, "mode", &(result.mode as u64))?;
        attribute(&group.0, "growth_rate", &result.eigenvalue.re)?;
        attribute(&group.0, "frequency_hz", &(result.eigenvalue.im / std::f64::consts::TAU))?;
        let rates = &result.parameters;
        let words =
            |pick: fn(&ParameterRate) -> &String| rates.iter().map(|r| pick(r).clone()).collect::<Vec<_>>();
        texts(&group.0, "parameter", &words(|r| &r.path), "paths of the scalars")?;
        texts(&group.0, "parameter_unit", &words(|r| &r.unit), "their SI units")?;
        let list = |pick: fn(&ParameterRate) -> f64| rates.iter().map(pick).collect::<Vec<f64>>();
        group.list("value", &list(|r| r.value), "SI unit of the scalar", "their values")?;
        let rate: Vec<c64> = rates.iter().map(|r| r.rate).collect();
        let story = "dλ/dp = dσ/dp + i dω/dp";
        group.list("rate", &rate, "1/s per SI unit of the scalar", story)?;
        let story = "estimated |error| of the rate";
        group.list("rate_error", &list(|r| r.error), "1/s per SI unit of the scalar", story)?;
        let kink: Vec<bool> = rates.iter().map(|r| r.kink).collect();
        group.list(
            "kink",
            &kink,
            "1",
            "whether the slopes to the two sides differ; the rate is their mean",
        )?;
        let story = "change of σ when the scalar grows by 1 %";
        group.list("growth_per_percent", &list(ParameterRate::growth_per_percent), "1/s", story)?;
        let story = "change of the frequency when the scalar grows by 1 %";
        group.list("frequency_per_percent", &list(ParameterRate::frequency_per_percent), "Hz", story)?;
        if let Some(advice) = &result.advice {
            let story = "dλ/dm of a point mass at every node";
            group.list("point_mass", &advice.mass, "1/(s kg)", story)?;
            let four = |rates: &[[c64; 4]]| Array2::from_shape_fn((rates.len(), 4), |(i, j)| rates[i][j]);
            let story =
                "dλ/dk of a spring to the ground at every node: along x, y, z, and the surface's normal";
            group.write("point_spring", four(&advice.stiffness).view(), "1/s per N/m", story)?;
            let story =
                "dλ/dc of a damper to the ground at every node: along x, y, z, and the surface's normal";
            group.write("point_damper", four(&advice.damping).view(), "1/s per N s/m", story)?;
        }
        for thing in &result.best {
            let best = group.0.create_group(&format!("best_{}", thing.kind))?;
            attribute(&best, "amount", &thing.amount)?;
            text_attribute(&best, "unit", thing.unit)?;
            attribute(&best, "node", &(thing.node as u64))?;
            if let Some(error) = thing.slope_error {
                attribute(&best, "slope_error", &error)?;
            }
            let best = Datasets(best);
            best.list("position", &thing.position, "m", "where it is mounted")?;
            best.list("predicted", &[thing.predicted], "1/s", "change of λ by the slope")?;
            if let Some(direction) = &thing.direction {
                best.list("direction", direction, "1", "along which it acts")?;
            }
            if let Some(done) = thing.done {
                best.list("done", &[done], "1/s", "change of λ when it is mounted and all is computed anew")?;
            }
        }
    }
    Ok(())
}

/// A group whose datasets all carry units and a description.
pub(super) struct Datasets(pub(super) Group);

impl Datasets {
    pub(super) fn list<T: H5Type>(
        &self,
        name: &str,
        data: &[T],
        units: &str,
        description: &str,
    ) -> hdf5::Result<()> {
        self.write(name, ArrayView::from(data), units, description)
    }

    /// Stored whole and uncompressed: mode shapes in full precision hardly shrink, and deflating them took longer than
    /// computing them.
    pub(super) fn write<T: H5Type, D: Dimension>(
        &self,
        name: &str,
        data: ArrayView<'_, T, D>,
        units: &str,
        description: &str,
    ) -> hdf5::Result<()> {
        let data: ArrayViewD<'_, T> = data.into_dyn();
        let dataset = self.0.new_dataset::<T>().shape(data.shape().to_vec()).create(name)?;
        dataset.write(data)?;
        describe(&dataset, units, description)
    }
}

/// A list of strings as a dataset.
pub(super) fn texts(group: &Group, name: &str, texts: &[String], description: &str) -> hdf5::Result<()> {
    let values: Array1<VarLenUnicode> = texts.iter().map(|text| unicode(text)).collect();
    let dataset = group.new_dataset::<VarLenUnicode>().shape(values.len()).create(name)?;
    dataset.write(values.view())?;
    describe(&dataset, "text", description)
}

pub(super) fn describe(dataset: &hdf5::Dataset, units: &str, description: &str) -> hdf5::Result<()> {
    text_attribute(dataset, "units", units)?;
    text_attribute(dataset, "description", description)
}

pub(super) fn attribute<T: H5Type>(group: &Group, name: &str, value: &T) -> hdf5::Result<()> {
    group.new_attr::<T>().create(name)?.write_scalar(value)
}

pub(super) fn text_attribute(location: &hdf5::Location, name: &str, text: &str) -> hdf5::Result<()> {
    location.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&unicode(text))
}

/// The operating system's words inside an error of the library, which runs over several lines, or its first line.
pub(super) fn plain(error: &hdf5::Error) -> String {
    let text = error.to_string();
    if text.contains("Resource temporarily unavailable") {
        return "another program has the file open".into();
    }
    let cause = text.split_once("error message = '").and_then(|(_, rest)| rest.split_once('\''));
    let words = cause.map(|(words, _)| words).or(text.lines().next()).unwrap_or_default();
    // So the library says when it has lost the cause, as it does where room cannot be made.
    if words == "unknown library error" { "the file cannot be written".into() } else { words.into() }
}

/// HDF5's strings end at a NUL, so one in the text cannot be kept.
fn unicode(text: &str) -> VarLenUnicode {
    text.replace('\0', "").parse().expect("holds no NUL")
}

pub(super) fn rows<const N: usize>(values: &[[f64; N]]) -> Array2<f64> {
    Array2::from_shape_fn((values.len(), N), |(i, j)| values[i][j])
}

fn fields<T: Copy>(shapes: &[NodalField<T>]) -> Array3<T> {
    let n_nodes = shapes.first().map_or(0, Vec::len);
    Array3::from_shape_fn((shapes.len(), n_nodes, 6), |(m, n, d)| shapes[m][n][d])
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;
    use std::path::Path;

    fn write_all(dir: &Path, results: &RunResults) {
        let mut file = ResultsFile::create(dir).unwrap();
        file.write_case(results).unwrap();
        file.write_geometry(&results.geometry).unwrap();
        results.modes.iter().for_each(|set| file.write_modes(set).unwrap());
        file.write_measured(&results.measured).unwrap();
        file.write_measured_frfs(&results.measured_frfs).unwrap();
        file.write_steady(results.steady.as_ref().unwrap()).unwrap();
        file.write_complex(results.complex.as_ref().unwrap()).unwrap();
        file.write_sensitivity(results.sensitivity.as_ref().unwrap()).unwrap();
        file.finish(results).unwrap();
    }

    #[test]
    fn what_was_written_reads_back_bit_for_bit() {
        let dir = tempfile::tempdir().unwrap();
        let results = sample::rig();
        write_all(dir.path(), &results);
        let file = hdf5::File::open(dir.path().join("results.h5")).unwrap();
        assert!(file.attr("complete").unwrap().read_scalar::<bool>().unwrap());
        let toml = file.dataset("case/resolved_toml").unwrap().read_scalar::<VarLenUnicode>().unwrap();
        assert_eq!(toml.as_str(), results.resolved_case);
        let shapes = file.dataset("modes/disc/shapes").unwrap();
        assert_eq!(shapes.shape(), [results.modes[0].modes.len(), results.geometry.nodes.len(), 6]);
        assert_eq!(shapes.read::<f64, ndarray::Ix3>().unwrap(), fields(&results.modes[0].shapes));
        assert_eq!(
            shapes.attr("units").unwrap().read_scalar::<VarLenUnicode>().unwrap().as_str(),
            SHAPE_UNITS
        );
        assert!(file.group("modes/rig_with_closed_contact").is_ok());
        let eigenvalues = file.dataset("complex/eigenvalue").unwrap().read_1d::<c64>().unwrap();
        let complex = results.complex.as_ref().unwrap();
        assert!(eigenvalues.iter().zip(&complex.modes.modes).all(|(a, b)| *a == b.eigenvalue));
        let right = file.dataset("complex/right").unwrap().read::<c64, ndarray::Ix3>().unwrap();
        assert_eq!(right, fields(&complex.shapes));
        let mode = file.dataset("measured/1/mode").unwrap().read_1d::<i64>().unwrap();
        assert_eq!(mode[3], -1);
    }

    #[test]
    fn every_dataset_has_units_and_a_description() {
        fn check(group: &Group) -> usize {
            for dataset in group.datasets().unwrap() {
                assert!(
                    dataset.attr("units").is_ok() && dataset.attr("description").is_ok(),
                    "{}",
                    dataset.name()
                );
            }
            group.datasets().unwrap().len() + group.groups().unwrap().iter().map(check).sum::<usize>()
        }
        let dir = tempfile::tempdir().unwrap();
        write_all(dir.path(), &sample::rig());
        assert!(check(&hdf5::File::open(dir.path().join("results.h5")).unwrap()) > 40);
    }
}
