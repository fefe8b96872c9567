//! A case made ready: mesh read and placed, structure assembled, contact pairs built.

use super::contacts::{arrows, contact_pairs};
use super::discs::discs;
use super::equations::equations;
use super::forces::external_load;
use super::imported::read_model;
use super::links::in_terms_of_the_case;
use super::mesh::{CaseFiles, read_files, same_mesh};
use super::model::whole_model;
use super::place::place;
use super::regions::Regions;
use super::rotation::check_sliding;
use crate::case::{Case, Matrices};
use crate::equilibrium::SteadyOptions;
use crate::error::{Faults, Result};
use crate::linalg::Engine;
use crate::mesh::Cell;
use crate::modal::Disc;
use crate::results::{Geometry, ModelSize};
use crate::structure::{Assembled, Model, Part, assemble};
use crate::system::System;
use std::sync::Arc;

/// Everything that analyses need, built once from a case.
#[derive(Debug)]
pub struct Prepared<'a> {
    /// The case.
    pub case: &'a Case,
    /// The mesh, placed, with the case's points.
    pub regions: Regions,
    /// The description of the whole structure.
    pub model: Model,
    /// Its matrices, at rest, and degrees of freedom.
    pub assembled: Arc<Assembled>,
    /// System that is analysed.
    pub system: System,
    /// Things the user should know.
    pub warnings: Vec<String>,
    /// What it was made from.
    files: Arc<CaseFiles>,
}

impl<'a> Prepared<'a> {
    /// Reads the mesh and builds the system.
    ///
    /// # Errors
    /// Every fault of the mesh and of the names that tie the case to it.
    pub fn new(case: &'a Case) -> Result<Self> {
        let files = read_files(case).map(Arc::new);
        files.and_then(|files| Self::build(case, files)).map_err(|error| case.places.locate(error))
    }

    /// A case that differs from this one in scalars. Its mesh, unless that depends on them, and matrices with terms are not read again.
    ///
    /// # Errors
    /// As [`Prepared::new`].
    pub fn rebuilt<'b>(&self, case: &'b Case) -> Result<Prepared<'b>> {
        match same_mesh(self.case, case) {
            true => Prepared::build(case, self.files.clone()).map_err(|error| case.places.locate(error)),
            false => Prepared::new(case),
        }
    }

    fn build(case: &'a Case, files: Arc<CaseFiles>) -> Result<Self> {
        let mut regions = Regions::new(files.mesh.clone(), case);
        if let Some(matrices) = &case.matrices {
            return Self::imported(case, (files, regions), matrices);
        }
        let mut warnings = files.warnings.clone();
        let mut faults = Faults::new();
        let named = faults.take(regions.check_named(case)).is_some();
        let equations = faults.take(equations(case, &regions, &files.equations)).unwrap_or_default();
        for (name, contact) in case.contact.iter().filter(|_| named) {
            if let Some(placement) = &contact.placement {
                faults.take(place(&mut regions, (case, &equations), name, contact, placement));
            }
        }
        let model = faults.take(whole_model(case, &regions, equations, &mut warnings));
        let model = faults.into_result(model)?.unwrap_or_default();
        let assembled = Arc::new(assemble(&model).map_err(|error| in_terms_of_the_case(error, case, None))?);
        let pairs = contact_pairs(case, &regions, &model, &assembled.dofs)?;
        let mut faults = Faults::new();
        check_sliding(case, (&regions, &model), &mut warnings, &mut faults);
        faults.into_result(())?;
        let (structure, coupling) = assembled.rotating(&model)?;
        let system = System {
            structure,
            pairs,
            load: external_load(case, &regions, &model, &assembled)?,
            prestress: case.prestress.then(|| Arc::new(assembled.prestress(model.clone())) as Arc<_>),
            coupling,
        };
        Ok(Prepared { case, regions, model, assembled, system, warnings, files })
    }

    /// The same for a case that gives the matrices.
    fn imported(
        case: &'a Case,
        (files, regions): (Arc<CaseFiles>, Regions),
        matrices: &Matrices,
    ) -> Result<Self> {
        let imported = read_model(case, matrices, &files.matrices)?;
        let model = Model { nodes: imported.nodes, ..Model::default() };
        let assembled = Arc::new(imported.assembled);
        let pairs = contact_pairs(case, &regions, &model, &assembled.dofs)?;
        let system = System {
            structure: assembled.structure.clone(),
            pairs,
            load: imported.load,
            prestress: None,
            coupling: imported.coupling,
        };
        Ok(Prepared { case, regions, model, assembled, system, warnings: imported.warnings, files })
    }

    /// The same with its matrices factorised by `engine`.
    pub fn with_engine(mut self, engine: &Engine) -> Self {
        Arc::make_mut(&mut self.assembled).structure.engine = engine.clone();
        self.system.structure.engine = engine.clone();
        self
    }

    /// Nodes, elements, degrees of freedom.
    pub fn size(&self) -> ModelSize {
        let stiffness = &self.system.structure.stiffness;
        ModelSize {
            nodes: self.model.nodes.len(),
            elements: self.model.parts.iter().map(|part| part.cells.len()).sum(),
            dofs: self.system.n_dofs(),
            nonzeros: stiffness.compute_nnz(),
            contact_points: self.system.points().count(),
        }
    }

    /// Nodes and elements for pictures and ParaView.
    pub fn geometry(&self) -> Geometry {
        let nodes = &self.model.nodes;
        let points = |nodes: Vec<usize>| nodes.into_iter().map(Cell::point).collect::<Vec<_>>();
        if self.case.matrices.is_some() {
            return match nodes.len() {
                0 => Geometry::new(vec![[0.0; 3]; self.assembled.dofs.n_nodes()], Vec::new()),
                n => Geometry::new(nodes.clone(), vec![("nodes".into(), points((0..n).collect()))]),
            };
        }
        let mut parts: Vec<(String, Vec<Cell>)> =
            self.model.parts.iter().map(|part| (part.name.clone(), part.cells.clone())).collect();
        for name in self.case.mass.keys().filter(|_| self.case.mesh.is_none()) {
            let own = self.regions.nodes(&self.case.mass[name].on, "").unwrap_or_default();
            parts.push((name.clone(), points(own)));
        }
        Geometry::new(nodes.clone(), parts)
    }

    /// Two unit vectors of each pair, for pictures: where the load presses the body, and where the counter-body moves.
    pub fn arrows(&self) -> Vec<[[f64; 3]; 2]> {
        if self.case.matrices.is_some() {
            return Vec::new();
        }
        let pairs = self.system.pairs.iter();
        pairs
            .map(|pair| arrows(&self.case.contact[&pair.name], &self.regions, &self.model, &pair.points))
            .collect()
    }

    /// The thickness of the thinnest plate or the shortest side of a solid \[m\]; infinite where there is neither.
    pub fn thinnest(&self) -> f64 {
        let solid = |part: &&Part| part.kind.dimension() == 3;
        let sizes = self.model.parts.iter().filter(solid).map(|part| part.smallest_extent(&self.model.nodes));
        self.model.shells().map(|(_, shell)| shell.thickness).chain(sizes).fold(f64::INFINITY, f64::min)
    }

    /// Settings of the solution of steady sliding. A contact pressed deeper than half of the thinnest part makes no sense.
    pub fn steady_options(&self) -> SteadyOptions {
        SteadyOptions { penetration_limit: 0.5 * self.thinnest(), ..SteadyOptions::default() }
    }

    /// The parts that are discs, with their names.
    pub fn discs(&self) -> Vec<(&str, Disc)> {
        discs(&self.model)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Selection, Whole, analyse};
    use crate::results::{CalibrationResult, SensitivityResult};
    use crate::sweep::SweepProblem;
    use std::path::Path;

    /// Derivatives by the structure, whole analyses of a sweep and a calibration are those of the mesh that was read: its file may be gone.
    #[test]
    fn the_file_of_a_mesh_is_read_once() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("rig-small.msh");
        std::fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/rig-small.msh"), &file).unwrap();
        let text = include_str!("../../validation/cea-transient-rig/case.toml");
        let text =
            text.replace("../../meshes/rig-medium.msh", "rig-small.msh").replace("\"6 kHz\"", "\"2 kHz\"");
        let more = "[modes.disc]\nparts = [\"disc\"]\nclamp = [\"hub\"]\nbelow = \"1 kHz\"\nmeasured = [\"331 Hz\"]\n\
                    [sensitivity]\nparameters = [\"shell.*\", \"*.lead_angle\", \"*.load\"]\nadvice = false\nverify = false\n\
                    [calibrate]\nagainst = \"disc\"\nchance_draws = 0\ntrials = 1\n[calibrate.parameter.disc]\n\
                    path = \"shell.disc.thickness\"\nbetween = [\"0.9 mm\", \"1.1 mm\"]\n";
        let text = format!("{}{more}", &text[..text.find("[transient]").unwrap()]);
        let case = Case::parse("rig", &text, folder.path().into()).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        let all = || {
            let of = |name| analyse(&prepared, Selection::Only(name), &mut |_| Ok(()), &()).unwrap();
            let (sensitivity, calibration) = (of("sensitivity"), of("calibrate"));
            let rates = sensitivity.get::<SensitivityResult>().unwrap();
            assert!(
                rates.left_out.is_empty() && rates.modes[0].parameters.len() == 4,
                "{:?}",
                rates.left_out
            );
            let rates =
                rates.modes.iter().flat_map(|mode| &mode.parameters).map(|p| (p.path.clone(), p.rate));
            let found = calibration.get::<CalibrationResult>().unwrap().numbers[0].after;
            let whole = Whole::new(&prepared, vec!["shell.disc.thickness".into()], None);
            (rates.collect::<Vec<_>>(), found, whole.eigenvalues(&[1.01e-3]).unwrap())
        };
        let there = all();
        std::fs::remove_file(file).unwrap();
        assert_eq!(all(), there);
        assert!(Prepared::new(&case).is_err());
    }

    /// The same of matrices whose terms have factors.
    #[test]
    fn matrices_are_read_once() {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/rotating-matrices");
        let folder = tempfile::tempdir().unwrap();
        let copied = crate::case::read_case(&from.join("case.toml")).unwrap();
        let path = |name: &str| folder.path().join(name);
        let matrix = |name: &String| name.ends_with(".mtx");
        let files: Vec<String> = copied.files().into_iter().filter(matrix).collect();
        for name in &files {
            std::fs::copy(from.join(name), path(name)).unwrap();
        }
        let case = Case { folder: folder.path().into(), ..copied };
        let prepared = Prepared::new(&case).unwrap();
        let whole = Whole::new(&prepared, vec!["matrices.scalar.omega".into()], None);
        let at = [0.9 * case.parameter("matrices.scalar.omega").unwrap().value];
        let there = whole.eigenvalues(&at).unwrap();
        assert!(files.len() > 3 && !there.is_empty());
        files.iter().for_each(|name| std::fs::remove_file(path(name)).unwrap());
        assert_eq!(whole.eigenvalues(&at).unwrap(), there);
        assert!(Prepared::new(&case).is_err());
    }
}
