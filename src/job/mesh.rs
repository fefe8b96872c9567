//! What a model is made from: the mesh of a case, read from a file or generated, and its equations.

use super::equations::{EquationFiles, following, read_equations};
use super::imported::MatrixFiles;
use crate::case::{AnnulusMesh, Case, MeshSource, PlateMesh, RigMesh, SpringPer};
use crate::error::{Error, Fault, Faults, Result};
use crate::mesh::generate::{self, BarSide, BarSpec, DiscSpec, Faces, Grading, PlateSpec, RigSpec};
use crate::mesh::{self, Mesh};
use std::sync::Arc;

/// What a model is made from, as it was read or generated.
#[derive(Debug, Default)]
pub(super) struct CaseFiles {
    /// Before anything is placed; empty where the case has none.
    pub(super) mesh: Arc<Mesh>,
    pub(super) matrices: MatrixFiles,
    pub(super) equations: EquationFiles,
    /// What the user should know of it.
    pub(super) warnings: Vec<String>,
}

/// Whether two cases that differ in scalars alone have the same mesh.
pub(super) fn same_mesh(a: &Case, b: &Case) -> bool {
    // A generated slider lies on the disc, half of its thickness above.
    let rig = |case: &Case| match &case.mesh {
        Some(MeshSource::Rig { .. }) => case.shell.get("slider").map(|slider| slider.thickness),
        _ => None,
    };
    a.mesh == b.mesh && a.folder == b.folder && rig(a) == rig(b)
}

/// What the model of the case is made from: its mesh, checked, an empty one where it has none; its equations.
pub(super) fn read_files(case: &Case) -> Result<CaseFiles> {
    let mut faults = Faults::new();
    let equations = faults.take(read_equations(case)).unwrap_or_default();
    let files = faults.take(read_mesh(case, &equations)).unwrap_or_default();
    faults.into_result(CaseFiles { equations, ..files })
}

fn read_mesh(case: &Case, equations: &EquationFiles) -> Result<CaseFiles> {
    let Some(source) = &case.mesh else { return Ok(CaseFiles::default()) };
    let mesh = match source {
        MeshSource::File { file, unit } => {
            mesh::read(&case.folder.join(file), mesh::unit_in_metres(unit.word()))
        }
        MeshSource::Rig { rig } => generate::rig(&rig_spec(case, rig)),
        MeshSource::Annulus { annulus: AnnulusMesh { outer_radius, hub_radius, radial, around } } => {
            generate::structured_annulus(*hub_radius, *outer_radius, *radial, *around)
        }
        MeshSource::Plate { plate: PlateMesh { length, width, cells_along, cells_across } } => {
            generate::structured_plate(*length, *width, *cells_along, *cells_across, Faces::Triangles)
        }
    };
    let mesh = mesh.map_err(|error| by_keys(error, source))?;
    let contacts = case.contact.values().map(|contact| [contact.body.as_str(), contact.counter.as_str()]);
    let springs = case.spring.values().filter(|spring| spring.per == SpringPer::Area);
    let springs = springs.filter_map(|spring| Some([spring.on.as_str(), spring.to.as_deref()?]));
    let ties = case.tie.values().map(|tie| [tie.on.as_str(), tie.to.as_str()]);
    let pairs = contacts.chain(ties).chain(springs);
    let diagnosis =
        mesh::diagnose_apart(&mesh, &pairs.collect::<Vec<_>>(), following(case, &mesh, equations));
    let key = match source {
        MeshSource::File { .. } => "file",
        MeshSource::Rig { .. } => "rig",
        MeshSource::Annulus { .. } => "annulus",
        MeshSource::Plate { .. } => "plate",
    };
    let at_key = |fault: Fault| Fault { place: format!("`mesh.{key}`: {}", fault.place), ..fault };
    Faults(diagnosis.faults.0.into_iter().map(at_key).collect()).into_result(())?;
    let warnings = diagnosis.warnings.iter().map(Fault::warning).collect();
    Ok(CaseFiles { mesh: mesh.into(), warnings, ..CaseFiles::default() })
}

/// Faults of a generator at the keys of the case that give its sizes.
fn by_keys(error: Error, source: &MeshSource) -> Error {
    let Error::Input(mut faults) = error else { return error };
    let keys: &[(&str, &str)] = match source {
        MeshSource::File { .. } => &[],
        MeshSource::Rig { .. } => &[
            ("disc `outer_radius`", "mesh.rig.outer_radius"),
            ("disc `hub_radius`", "mesh.rig.hub_radius"),
            ("rig `disc.hub_radius`", "mesh.rig.hub_radius"),
            ("disc `fine`", "mesh.rig.contact_size"),
            ("plate `fine`", "mesh.rig.contact_size"),
            ("disc `fine_radius`", "mesh.rig.contact_radius"),
            ("plate `fine_radius`", "mesh.rig.contact_radius"),
            ("disc `coarse`", "mesh.rig.disc_size"),
            ("plate `coarse`", "mesh.rig.slider_size"),
            ("disc element sizes", "mesh.rig.disc_size"),
            ("plate element sizes", "mesh.rig.slider_size"),
            ("plate `length`", "mesh.rig.slider"),
            ("plate `width`", "mesh.rig.slider"),
            ("plate contact x", "mesh.rig.contact"),
            ("plate contact y", "mesh.rig.contact"),
            ("rig `bar.length`", "mesh.rig.bar_length"),
            ("rig `slider_thickness`", "shell.slider.thickness"),
        ],
        MeshSource::Annulus { .. } => &[
            ("annulus `outer radius`", "mesh.annulus.outer_radius"),
            ("annulus `hub radius`", "mesh.annulus.hub_radius"),
            ("annulus hub radius", "mesh.annulus.hub_radius"),
            ("annulus cells", "mesh.annulus.radial"),
            ("annulus `n_angular`", "mesh.annulus.around"),
        ],
        MeshSource::Plate { .. } => &[
            ("plate `length`", "mesh.plate.length"),
            ("plate `width`", "mesh.plate.width"),
            ("plate cells", "mesh.plate.cells_along"),
        ],
    };
    for fault in &mut faults.0 {
        let Some((place, key)) = keys.iter().find(|(place, _)| *place == fault.place) else { continue };
        let coarse = if place.starts_with("disc") { "`disc_size`" } else { "`slider_size`" };
        fault.found = fault.found.replace("`coarse`", coarse);
        fault.expected = fault.expected.replace("`coarse`", coarse);
        fault.place = format!("`{key}`");
    }
    Error::Input(faults)
}

fn rig_spec(case: &Case, rig: &RigMesh) -> RigSpec {
    let grading = |coarse: f64| Grading::graded(rig.contact_size, rig.contact_radius, coarse);
    RigSpec {
        disc: DiscSpec {
            outer_radius: rig.outer_radius,
            hub_radius: rig.hub_radius,
            grading: grading(rig.disc_size),
        },
        bar: BarSpec {
            length: rig.bar_length.abs(),
            elements: 10,
            side: if rig.bar_length < 0.0 { BarSide::Plus } else { BarSide::Minus },
        },
        slider: PlateSpec {
            length: rig.slider[0],
            width: rig.slider[1],
            contact: rig.contact,
            grading: grading(rig.slider_size),
        },
        slider_thickness: case.shell.get("slider").map_or(0.01, |shell| shell.thickness),
    }
}

#[cfg(test)]
mod tests {
    use crate::case::Case;
    use crate::job::Prepared;

    #[test]
    fn faults_of_meshes_and_masses_name_file_line_and_key() {
        let said = |text: &str| {
            let case = Case::parse("made.toml", text, "".into());
            case.and_then(|case| {
                let prepared = Prepared::new(&case)?;
                crate::job::check_case(&prepared).map_err(|error| case.places.locate(error))
            })
            .unwrap_err()
            .to_string()
        };
        let plate = |mesh: &str| format!("title = \"t\"\n[mesh.{mesh}\n[modes.all]\ncount = 1\n");
        let text = said(&plate("annulus]\nouter_radius = 0.1\nhub_radius = 1e-9\nradial = 4\naround = 8"));
        assert!(text.contains("made.toml:2") && text.contains("`mesh.annulus`: nodes"), "{text}");
        let text = said("[point]\na = [0, 0, 0]\n[mass.a]\non = \"a\"\nmass = 1\ninertia = [1, -1, 0]\n");
        assert!(text.contains("made.toml:6 `mass.a.inertia`"), "{text}");
        let mass = "[point]\na = [0, 0, 0]\n[mass.a]\non = \"a\"\nmass = 0\n[spring.s]\non = \"a\"\n\
                    direction = [1, 0, 0]\nstiffness = 1\n[modes.all]\ncount = 1\n";
        let text = said(mass);
        assert!(text.contains("`mass`: found no mass") && text.contains("made.toml:"), "{text}");
    }

    #[test]
    fn faults_of_generated_meshes_are_at_keys_of_the_case() {
        let said = |mesh: &str| {
            let case = Case::parse("made.toml", mesh, "".into()).unwrap();
            Prepared::new(&case).unwrap_err().to_string()
        };
        let rig = "[mesh.rig]\ncontact_size = \"5 mm\"\ncontact = [\"1 m\", 0]\nhub_radius = \"90 mm\"\n";
        let text = said(rig);
        for part in [
            "made.toml:2 `mesh.rig.contact_size`",
            "larger than `disc_size`, 0.003 m",
            "made.toml:3 `mesh.rig.contact`",
            "made.toml:4 `mesh.rig.hub_radius`",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(!text.contains("coarse") && !text.contains("plate"), "{text}");
        let text = said("[mesh.annulus]\nouter_radius = 0.1\nhub_radius = 0.2\naround = 7\n");
        assert!(text.contains("made.toml:3 `mesh.annulus.hub_radius`"), "{text}");
        assert!(text.contains("made.toml:4 `mesh.annulus.around`"), "{text}");
    }
}
