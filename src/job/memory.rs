//! How much memory a run takes at its peak, worked out before it begins.

use super::analyses::Selection;
use super::complex::closes_contact;
use super::modes::real_modes_below;
use super::prepared::Prepared;
use super::states::keeps_the_structure;
use super::studies::{SHARED, UNCERTAINTY, studies};
use crate::error::{Error, Result};
use crate::linalg::sparse::{add_scaled, sum_of_squares};
use crate::memory::{Available, available};
use crate::numbers::significant;
use crate::reduction::has_many_points;
use crate::stability::CountSize;
use crate::structure::{Model, Part, as_plate};
use crate::system::System;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

/// Runs of fewer degrees of freedom fit any machine, with as many modes as they can have: 14 vectors each take 0.4 GiB.
const LEAST: usize = 2_000;
/// Runs of so many degrees of freedom or so many bytes are large: what others take is not reported.
const LARGE: (usize, f64) = (15_000, 2.5e8);

/// What the program itself takes \[bytes\].
const PROGRAM: f64 = 4e7;
/// Matrices like K at the peak.
const MATRICES: f64 = 5.8;
/// Further ones where K or C has sparse skew parts, as of a rotation: counted in runs of two plates and a solid.
const SKEW_MATRICES: f64 = 6.5;
/// Factors of K − σM at the peak.
const FACTORS: f64 = 1.4;
/// Vectors for each real mode at the peak of a complex analysis without left vectors,
const RIGHT_VECTORS: f64 = 4.5;
/// and with them.
const LEFT_AND_RIGHT_VECTORS: f64 = 6.5;
/// The same of many contact points, whose friction takes some four further vectors of the subspace for each real mode; both as the
/// subspace grows.
const VECTORS_OF_MANY_POINTS: f64 = 10.0;
/// Vectors besides.
const OTHER_VECTORS: f64 = 72.0;
/// Matrices of the contact directions in motion of the full model,
const DENSE_MATRICES: f64 = 6.0;
/// vectors of a reduced model beside those of modes, where contacts have many points, at a `contact_tolerance` of 0.1,
const CONTACT_SHAPES: f64 = 350.0;
/// and how many times its vectors are there while it is made.
const REDUCED_COPIES: f64 = 5.0;
/// Bytes of an entry between rows in which imported directions act, of the two matrices that a count has of them, as they are listed and
/// sorted.
const COUPLED_ENTRY: f64 = 2.0 * (24.0 + 24.0);
/// What a sample of uncertain scalars takes in all \[bytes\],
const SAMPLE: f64 = 460.0;
/// and for each of its modes: counted in runs of 20 000 to 200 000 samples of 2 and 22 modes.
const MODE_OF_SAMPLE: f64 = 34.0;

/// The peak of memory that is expected of a run, and what it is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExpectedMemory {
    /// The peak \[bytes\].
    pub bytes: f64,
    /// Degrees of freedom.
    pub dofs: usize,
    /// Entries of the factors of K.
    pub fill: usize,
    /// About how many real modes are computed at once.
    pub modes: f64,
    /// Whether it holds left vectors that only results need.
    pub left_vectors: bool,
    /// What samples of uncertain scalars take of it \[bytes\].
    pub samples: f64,
    /// What contacts of the full model take of it in motion in time \[bytes\].
    pub full_motion: f64,
    /// Sizes of the count of the unstable modes, where one is made.
    pub count: Option<CountSize>,
}

impl ExpectedMemory {
    /// The peak in words: `1.3 GiB`.
    pub fn words(&self) -> String {
        words(self.bytes)
    }

    /// What the count of the unstable modes takes of a run, in a sentence; none where it is not made.
    pub fn words_of_count(&self) -> Option<String> {
        let count = self.count?;
        let (seconds, memory) = (significant(count.seconds(), 1), words(count.bytes()));
        let operations = count.operations();
        Some(format!(
            "The count of the unstable modes is expected to take {operations:.0e} operations, about {seconds} s of one core, and {memory} of that."
        ))
    }

    /// Fails where `available` is less than the peak.
    ///
    /// # Errors
    /// Error when more memory is needed than is available, with the changes that reduce it.
    pub fn check(&self, available: &Available) -> Result<()> {
        if self.bytes <= available.bytes as f64 {
            return Ok(());
        }
        let ExpectedMemory { dofs, fill, modes, .. } = self;
        Err(Error::analysis(
            "memory",
            format!(
                "the run is expected to take {} at its peak ({dofs} degrees of freedom, {fill:.2e} entries of a factor, about \
                 {modes:.0} real modes), and {} leaves {}",
                self.words(),
                available.by,
                words(available.bytes as f64),
                fill = *fill as f64,
            ),
            format!(
                "Take a coarser mesh, a lower `cea.basis_below`, `below` or `count`, {}{}{}{}or a machine with more memory",
                if self.left_vectors { "`cea.left_vectors = false`, " } else { "" },
                if self.samples > 0.1 * self.bytes { "fewer `samples`, " } else { "" },
                if self.full_motion > 0.1 * self.bytes { "`transient.model = \"reduced\"`, " } else { "" },
                match self.count {
                    Some(count) if count.bytes() > 0.1 * self.bytes => "`cea.certify = false`, ",
                    _ => "",
                },
            ),
        ))
    }
}

/// Fails where a large run of `selection` cannot fit into the memory that is left; gives what it is expected to take.
///
/// # Errors
/// Those of [`ExpectedMemory::check`].
pub fn check_memory(prepared: &Prepared, selection: Selection) -> Result<Option<ExpectedMemory>> {
    let Some(expected) = expected_memory(prepared, selection)? else { return Ok(None) };
    if let Some(available) = available() {
        expected.check(&available)?;
    }
    Ok(Some(expected))
}

/// The expected peak of a large run, `None` for a small one.
///
/// # Errors
/// When the pattern of K cannot be analysed.
pub fn expected_memory(prepared: &Prepared, selection: Selection) -> Result<Option<ExpectedMemory>> {
    let dofs = prepared.system.n_dofs();
    if dofs < LEAST {
        return Ok(None);
    }
    let pencil = |square: f64| {
        let structure = &prepared.system.structure;
        let springs = prepared.system.points().map(|(_, point)| (1.0, &point.normal));
        add_scaled(&[
            (1.0, &structure.stiffness),
            (-square, &structure.mass),
            (1.0, &sum_of_squares(dofs, springs)),
        ])
    };
    let pattern = pencil(1.0);
    let engine = &prepared.system.structure.engine;
    let symbolic = engine.analyse(pattern.symbolic())?;
    // Of factors on several ranks this one has a share.
    let fill = symbolic.fill() / engine.ranks();
    let case = prepared.case;
    let below = |hz: f64| match &case.matrices {
        None => Ok(modes_below(&prepared.model, hz)),
        Some(_) => symbolic.inertia(&pencil((TAU * hz).powi(2))).map(|inertia| inertia.negative as f64),
    };
    let mut modes = 0.0_f64;
    for wanted in case.modes.values().filter(|_| selection.includes("modes", case)) {
        modes = modes.max(wanted.below.map_or(Ok(wanted.count.unwrap_or(1) as f64), below)?);
    }
    let complex = case.cea.as_ref().filter(|_| selection.includes("cea", case));
    let mut samples = 0.0;
    if let Some(cea) = complex {
        modes = modes.max(below(real_modes_below(case, cea, cea.basis_below))?);
        if selection.includes(UNCERTAINTY, case) {
            let count: usize = case.uncertainty.values().map(|study| study.samples).sum();
            // The band has fewer modes; to count them takes a factorisation where matrices are given.
            samples = count as f64 * (SAMPLE + MODE_OF_SAMPLE * modes);
        }
    }
    let run = ProblemSize {
        dofs,
        entries: pattern.compute_nnz(),
        fill,
        modes: modes.min(dofs as f64),
        many_points: closes_contact(prepared),
    };
    let mut explored = None;
    let varied = SHARED.into_iter().filter(|analysis| selection.includes(analysis, case));
    for path in varied.flat_map(|analysis| studies(case, analysis)).flat_map(|study| study.paths) {
        let kind = if keeps_the_structure(case, &path)? {
            AnalysisKind::Study
        } else {
            AnalysisKind::StudyOfStructures
        };
        explored = explored.max(Some(kind));
    }
    let kind = match complex {
        None => AnalysisKind::Real,
        Some(cea) => explored.unwrap_or(AnalysisKind::Complex {
            left_vectors: cea.left_vectors || selection.takes_left_vectors(case),
        }),
    };
    let skew = prepared.system.skew().map_or(0.0, |_| SKEW_MATRICES * run.matrix());
    let moves = case.transient.as_ref().filter(|_| selection.includes("transient", case));
    let many = has_many_points(&prepared.system);
    let reduced = moves.is_some_and(|wanted| wanted.is_reduced(many));
    let reduced_motion = if reduced { run.reduced_motion(&prepared.system) } else { 0.0 };
    let full = moves.is_some_and(|wanted| !reduced || wanted.compare_steps.map_or(!many, |steps| steps > 0));
    let full_motion = if full { run.full_motion(&prepared.system) } else { 0.0 };
    let count = complex.filter(|_| prepared.system.skew().is_none()).and_then(|cea| {
        let imported = prepared.system.coupling.as_ref().map_or(0, |rest| rest.directions.len());
        let directions = (3 * prepared.system.points().count() + imported) as f64;
        let size = CountSize::expected(dofs, fill, symbolic.multiplications(), run.modes, directions);
        let made = cea.certify.unwrap_or_else(|| size.within_the_analysis());
        (made && directions > 0.0).then_some(size)
    });
    let bytes = run.peak(kind)
        + skew
        + samples
        + reduced_motion.max(full_motion)
        + count.map_or(0.0, |size| size.bytes() + COUPLED_ENTRY * coupled_rows(&prepared.system).powi(2));
    if dofs < LARGE.0 && bytes < LARGE.1 {
        return Ok(None);
    }
    let left_vectors = kind == AnalysisKind::Complex { left_vectors: true }
        && !run.many_points
        && !selection.takes_left_vectors(case);
    Ok(Some(ExpectedMemory {
        bytes,
        dofs,
        fill,
        modes: run.modes,
        left_vectors,
        samples,
        full_motion,
        count,
    }))
}

/// The analysis that takes the most memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum AnalysisKind {
    /// Real modes.
    Real,
    /// Complex eigenvalues.
    Complex { left_vectors: bool },
    /// A study of friction, load or contact.
    Study,
    /// A study that changes M or K.
    StudyOfStructures,
}

/// Sizes that determine the peak.
struct ProblemSize {
    dofs: usize,
    entries: usize,
    fill: usize,
    modes: f64,
    /// Whether there are many contact points.
    many_points: bool,
}

impl ProblemSize {
    /// What motion in time of the full model takes besides \[bytes\]: square matrices of the contact directions, and of each of these both halves of
    /// a solution, with entries on its way through the factor only, about the side of a triangle of as many entries as that has.
    fn full_motion(&self, system: &System) -> f64 {
        let directions = 3.0 * system.points().count() as f64;
        let way = (2.0 * self.fill as f64).sqrt().min(self.dofs as f64);
        8.0 * DENSE_MATRICES * directions * directions + 2.0 * 16.0 * way * directions
    }

    /// What motion in time of a reduced model takes besides \[bytes\]: its vectors, which contacts of many points need many of.
    fn reduced_motion(&self, system: &System) -> f64 {
        let vectors = match has_many_points(system) {
            true => 2.0 * self.modes + CONTACT_SHAPES,
            false => self.modes + 3.0 * system.points().count() as f64,
        };
        8.0 * REDUCED_COPIES * vectors.min(self.dofs as f64) * self.dofs as f64
    }

    /// The bytes of a matrix like K.
    fn matrix(&self) -> f64 {
        12.0 * self.entries as f64
    }

    /// The peak \[bytes\]: as many matrices, factors and vectors as were counted in runs of 19 000 to 146 000 degrees of freedom.
    ///
    /// The size of the matrices also represents what is proportional to the mesh. Of each mode there are two vectors in the basis of Lanczos
    /// and the vector itself; of a complex analysis the vector, M times it for modal damping, further ones of the subspace, and Re
    /// and Im of the complex modes, about three for four real ones, with or without the left ones; of a study the vectors at other
    /// values.
    fn peak(&self, kind: AnalysisKind) -> f64 {
        let vector = 8.0 * self.dofs as f64;
        let (matrix, factor) = (self.matrix(), 8.0 * self.fill as f64);
        let vectors = match kind {
            AnalysisKind::Real => 3.0,
            AnalysisKind::Complex { .. } if self.many_points => VECTORS_OF_MANY_POINTS,
            AnalysisKind::Complex { left_vectors: false } => RIGHT_VECTORS,
            AnalysisKind::Complex { left_vectors: true } => LEFT_AND_RIGHT_VECTORS,
            AnalysisKind::Study | AnalysisKind::StudyOfStructures => 14.0,
        };
        let structures = if kind == AnalysisKind::StudyOfStructures { 1.7 } else { 1.0 };
        PROGRAM
            + structures
                * (MATRICES * matrix + FACTORS * factor + (vectors * self.modes + OTHER_VECTORS) * vector)
    }
}

/// About how many modes the plates of a model have below a frequency, Weyl's N = k² A/(4π) with the wavenumber k of bending
/// by the theory of each, √(ω √(ρh/D)) of a thin plate; a solid counts as a plate of half its skin that has its volume.
fn modes_below(model: &Model, hz: f64) -> f64 {
    let part = |part: &Part| {
        let k = part.element(&model.nodes).and_then(|element| element.bending_wavenumber(hz)).unwrap_or(0.0);
        k * k * part.area(&model.nodes) / (4.0 * PI)
    };
    let of = |own: &Part| match own.kind.dimension() {
        3 => 0.5 * part(&as_plate(own, *own.kind.material(), &model.nodes)),
        2 => part(own),
        _ => 0.0,
    };
    model.parts.iter().map(of).sum()
}

/// The rows in which imported directions act.
fn coupled_rows(system: &System) -> f64 {
    let directions = system.coupling.iter().flat_map(|rest| &rest.directions);
    directions.flat_map(|d| d.indices()).collect::<BTreeSet<_>>().len() as f64
}

fn words(bytes: f64) -> String {
    let mebibytes = bytes / f64::from(1 << 20);
    if mebibytes < 1024.0 { format!("{mebibytes:.0} MiB") } else { format!("{:.1} GiB", mebibytes / 1024.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::mesh::CellKind;
    use crate::structure::{Material, Shell, Solid};

    /// Peaks of runs as the system counted them (VmHWM, two threads): square plates and rigs.
    #[test]
    fn peaks_are_those_of_runs_within_twenty_percent() {
        use AnalysisKind::{Complex, Real, Study, StudyOfStructures};
        let [right, both] = [false, true].map(|left_vectors| Complex { left_vectors });
        // Plates and rigs of few contact points.
        let few = [
            (20_532, 846_576, 2_530_000, 9.0, Real, 135.0),
            (20_532, 846_576, 2_530_000, 48.0, Real, 146.0),
            (20_532, 846_576, 2_530_000, 377.0, Real, 322.0),
            (100_944, 4_204_872, 16_300_000, 9.0, Real, 599.0),
            (100_944, 4_204_872, 16_300_000, 48.0, Real, 664.0),
            (146_304, 6_086_192, 23_200_000, 28.0, Real, 855.0),
            (146_304, 6_086_192, 23_200_000, 111.0, Real, 1009.0),
            (18_876, 771_224, 2_040_000, 55.0, right, 164.0),
            (18_876, 771_224, 2_040_000, 186.0, right, 256.0),
            (18_876, 771_224, 2_040_000, 55.0, both, 171.0),
            (18_876, 771_224, 2_040_000, 186.0, both, 290.0),
            (39_228, 1_616_984, 4_820_000, 55.0, both, 306.0),
            (39_228, 1_616_984, 4_820_000, 186.0, both, 555.0),
            (74_796, 3_098_984, 10_700_000, 186.0, right, 852.0),
            (74_796, 3_098_984, 10_700_000, 186.0, both, 1020.0),
            (146_304, 6_086_192, 23_200_000, 55.0, right, 996.0),
            (146_304, 6_086_192, 23_200_000, 186.0, right, 1663.0),
            (146_304, 6_086_192, 23_200_000, 55.0, both, 1023.0),
            (146_304, 6_086_192, 23_200_000, 186.0, both, 1977.0),
            (18_876, 771_224, 2_040_000, 55.0, Study, 221.0),
            (39_228, 1_616_984, 4_820_000, 55.0, Study, 427.0),
            (18_876, 771_224, 2_040_000, 55.0, StudyOfStructures, 326.0),
            (39_228, 1_616_984, 4_820_000, 55.0, StudyOfStructures, 627.0),
        ];
        // Brakes of solids with 312 and 972 points.
        let many = [
            (37_269, 4_480_000, 11_500_000, 71.0, both, 689.0),
            (132_691, 10_190_929, 75_100_000, 150.0, right, 2977.0),
        ];
        let all = few.map(|run| (run, false)).into_iter().chain(many.map(|run| (run, true)));
        for ((dofs, entries, fill, modes, kind, mebibytes), many_points) in all {
            let expected =
                ProblemSize { dofs, entries, fill, modes, many_points }.peak(kind) / f64::from(1 << 20);
            assert!(
                within((expected / mebibytes - 1.0).abs(), 0.2, Theory),
                "{dofs}, {kind:?}: {expected} MiB, measured {mebibytes} MiB"
            );
        }
    }

    #[test]
    fn a_run_that_cannot_fit_is_refused_with_both_figures() {
        let expected = ExpectedMemory {
            bytes: 3e9,
            dofs: 100_000,
            fill: 20_000_000,
            modes: 40.0,
            left_vectors: true,
            samples: 0.0,
            full_motion: 0.0,
            count: None,
        };
        let by = "the machine's free memory";
        assert!(expected.check(&Available { bytes: 4_000_000_000, by }).is_ok());
        let error = expected.check(&Available { bytes: 1 << 30, by }).unwrap_err();
        let text = error.to_string();
        assert!(
            text.contains("2.8 GiB") && text.contains("leaves 1.0 GiB") && text.contains("coarser"),
            "{text}"
        );
        assert!(text.contains("left_vectors = false"), "{text}");
        let other = ExpectedMemory { left_vectors: false, samples: 1e9, ..expected };
        let text = other.check(&Available { bytes: 1 << 30, by }).unwrap_err().to_string();
        assert!(!text.contains("left_vectors") && text.contains("fewer `samples`"), "{text}");
        let other = ExpectedMemory { full_motion: 2e9, ..expected };
        let text = other.check(&Available { bytes: 1 << 30, by }).unwrap_err().to_string();
        assert!(text.contains("`transient.model = \"reduced\"`"), "{text}");
        let counted = ExpectedMemory {
            count: Some(CountSize::expected(100_000, 20_000_000, 1e10, 40.0, 3e3)),
            ..expected
        };
        let text = counted.check(&Available { bytes: 1 << 30, by }).unwrap_err().to_string();
        assert!(text.contains("`cea.certify = false`"), "{text}");
        assert_eq!(error.exit_code(), 1);
    }

    /// The vectors of as many modes as are asked for are in the prediction, at any number of degrees of freedom above the least.
    #[test]
    fn many_modes_of_a_small_model_are_predicted() {
        for cells in [26, 30] {
            for count in [10, 3000, 4000] {
                let text = format!(
                    "[mesh.plate]\nlength = 1\nwidth = 1\ncells_along = {cells}\ncells_across = {cells}\n\
                     [material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 8000\n\
                     [shell.plate]\nmaterial = \"steel\"\nthickness = 0.005\n[modes.all]\ncount = {count}\n"
                );
                let case = crate::case::Case::parse("", &text, "".into()).unwrap();
                let prepared = Prepared::new(&case).unwrap();
                let expected = expected_memory(&prepared, Selection::Listed).unwrap();
                let Some(expected) = expected else {
                    assert_eq!(count, 10);
                    continue;
                };
                assert!(expected.dofs == 6 * (cells + 1) * (cells + 1) && expected.modes == count as f64);
                // Two vectors in the basis and the mode itself.
                assert!(expected.bytes >= 3.0 * 8.0 * (expected.dofs * count) as f64);
            }
        }
    }

    #[test]
    fn the_number_of_modes_of_a_plate_is_weyls() {
        // 300 mm × 300 mm × 1 mm of steel: 48 modes below 1500 Hz, clamped at one edge.
        let steel = Material {
            youngs_modulus: 210e9,
            poissons_ratio: 0.3,
            density: 7850.0,
            loss_factor: 0.0,
            rayleigh: crate::structure::RayleighDamping::default(),
            orthotropic: None,
        };
        let faces = vec![crate::mesh::Cell::quadrilateral([0, 1, 2, 3])];
        let shell = Shell { rotary_inertia: false, ..Shell::new(steel, 1e-3) };
        let plate = Part::new("plate", faces, shell);
        let nodes = vec![[0.0; 3], [0.3, 0.0, 0.0], [0.3, 0.3, 0.0], [0.0, 0.3, 0.0]];
        let model = Model { nodes, parts: vec![plate], ..Model::default() };
        assert!(within((modes_below(&model, 1500.0) - 43.0).abs(), 1.0, Theory));
        // The same plate as a solid; Mindlin's waves and its rim count little.
        let brick =
            crate::mesh::generate::structured_box(CellKind::Hexahedron20, [0.3, 0.3, 1e-3], [6, 6, 1])
                .unwrap();
        let cells = brick.elements.iter().filter(|cell| cell.dimension() == 3).cloned().collect();
        let solid = Part::new("solid", cells, Solid::new(steel));
        let model = Model { nodes: brick.nodes, parts: vec![solid], ..Model::default() };
        assert!(within((modes_below(&model, 1500.0) - 43.0).abs(), 1.0, Theory));
    }
}
