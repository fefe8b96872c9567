use super::*;
use crate::bounds::{Origin::*, within};
use crate::case::Case;
use crate::equilibrium::{SteadyOptions, solve_steady};
use crate::linalg::SparseVector;
use crate::mesh::generate::structured_ring;
use crate::mesh::{CellKind, write};
use crate::stability::complex_modes;
use crate::system::Coupling;
use faer::Mat;
use std::borrow::Cow;
use std::sync::OnceLock;

/// Nodal diameters of the double mode.
const N: f64 = 2.0;

/// A ring whose elements are longer and shorter around it by the share `uneven`, four times a turn, so that its mesh splits the modes of two nodal
/// diameters into cos 2θ and sin 2θ; stretched along x by `oval`.
fn case(folder: &std::path::Path, uneven: f64, oval: f64, held: bool) -> Case {
    let mut mesh = structured_ring(CellKind::Hexahedron20, [0.05, 0.14], 0.01, [2, 12, 1]).unwrap();
    for x in &mut mesh.nodes {
        let (radius, angle) = (x[0].hypot(x[1]), x[1].atan2(x[0]));
        let (sin, cos) = (angle - uneven / (2.0 * N) * (2.0 * N * angle).sin()).sin_cos();
        (x[0], x[1]) = (oval * radius * cos, radius * sin);
    }
    write(&folder.join("m.msh"), &mesh, 1.0).unwrap();
    let support = if held { "[support.hub]\non = \"hub\"\n" } else { "" };
    let text = format!(
        "[mesh]\nfile = \"m.msh\"\nunit = \"m\"\n[material.iron]\nyoungs_modulus = 1.2e11\npoissons_ratio = 0.26\ndensity = 7200\n\
         [solid.disc]\nmaterial = \"iron\"\n{support}[modes.all]\ncount = 1\n"
    );
    Case::parse("a.toml", &text, folder.into()).unwrap()
}

/// Transverse forces as cos 2θ or sin 2θ on the upper face.
fn pattern(prepared: &Prepared, cos: bool) -> SparseVector {
    let nodes = prepared.regions.nodes("disc_face", "").unwrap();
    let entries = nodes.iter().flat_map(|node| {
        let [x, y, _] = prepared.model.nodes[*node];
        let angle = N * y.atan2(x);
        let by = if cos { angle.cos() } else { angle.sin() };
        prepared.assembled.dofs.terms(*node, 2).iter().map(move |(free, factor)| (*free, by * factor))
    });
    SparseVector::from_entries(entries)
}

/// The two real modes of two nodal diameters, the one as cos 2θ first: ω² and the work of its pattern.
fn doublet(prepared: &Prepared, real: &RealModes) -> [(f64, f64); 2] {
    let of = |cos: bool| {
        let g = pattern(prepared, cos);
        let along = |k: &usize| g.dot(real.shapes.col_as_slice(*k));
        let all = real.rigid_bodies..real.len().min(real.rigid_bodies + 6);
        let k = all.max_by(|a, b| along(a).abs().total_cmp(&along(b).abs())).unwrap();
        (real.eigenvalues[k], along(&k))
    };
    [of(true), of(false)]
}

/// A contact stiffness on one of the two patterns and friction between both: just as stiff as the split of an uneven mesh, so that both have one frequency
/// there and flutter, which they do on no even mesh. The growth without the split is that of the even mesh, none, of held and of free rings.
#[test]
fn flutter_by_an_uneven_mesh_is_gone_without_the_split() {
    for (held, uneven) in [(false, 0.3), (true, 0.3), (true, -0.02)] {
        let folder = tempfile::tempdir().unwrap();
        let mut law = None;
        for even in [false, true] {
            let case = case(folder.path(), if even { 0.0 } else { uneven }, 1.0, held);
            let mut prepared = Prepared::new(&case).unwrap();
            let (real, _) =
                modal::compute(&prepared.system.structure, ModesWanted::BelowHz(6e3), &()).unwrap();
            let [(cos, by_cos), (sin, by_sin)] = doublet(&prepared, &real);
            let omega = cos.sqrt();
            let (on_cos, k, b) = *law.get_or_insert_with(|| {
                let split = (cos - sin).abs();
                assert!(split > 1e-5 * cos, "{split} of {cos}");
                let on_cos = cos < sin;
                let by = if on_cos { by_cos } else { by_sin };
                (on_cos, split / (by * by), 0.25 * split / (by_cos * by_sin).abs())
            });
            let directions = vec![pattern(&prepared, on_cos), pattern(&prepared, !on_cos)];
            let stiffness = Mat::from_fn(2, 2, |i, j| [[k, b], [-b, 0.0]][i][j]);
            prepared.system.coupling =
                Some(Coupling { directions, stiffness, damping: Mat::zeros(2, 2), skew: None });
            let steady = solve_steady(&prepared.system, &SteadyOptions::default(), &()).unwrap();
            let band = [0.9 * omega / TAU, 1.1 * omega / TAU];
            let modes = complex_modes(&prepared.system, &steady, &real, band, &()).unwrap().modes;
            let unstable = modes.iter().filter(|mode| mode.unstable()).count();
            let point = OperatingPoint {
                prepared: &prepared,
                steady: steady.into(),
                system: Cow::Borrowed(&prepared.system),
                real,
                closed: None,
                open: OnceLock::new(),
            };
            let without = growth_without_split(&point, &modes, &()).unwrap();
            if even {
                assert_eq!((unstable, without.iter().flatten().count()), (0, 0), "{held} {uneven}");
                continue;
            }
            assert_eq!(
                unstable,
                1,
                "{held} {uneven}: {:?}",
                modes.iter().map(|m| m.eigenvalue).collect::<Vec<_>>()
            );
            let growth = modes.iter().map(|mode| mode.growth_rate()).fold(0.0, f64::max);
            // Of two modes of one frequency that friction couples: b/2ω.
            let expected = b * (by_cos * by_sin).abs() / (2.0 * omega);
            assert!(within(growth / expected - 1.0, 0.05, Theory), "{growth} {expected}");
            let left = without.iter().flatten().copied().fold(f64::NEG_INFINITY, f64::max);
            assert!(within(left.abs(), 0.01 * growth, Theory), "{held} {uneven}: {left} of {growth}");
        }
    }
}

/// A ring that is oval is no body of revolution: its split is its own.
#[test]
fn a_body_that_is_not_round_keeps_its_split() {
    let folder = tempfile::tempdir().unwrap();
    for (oval, round) in [(1.0, true), (1.001, false), (1.01, false), (1.1, false)] {
        let case = case(folder.path(), 0.3, oval, false);
        let prepared = Prepared::new(&case).unwrap();
        let change = without_split(&prepared, 3e3, &()).unwrap();
        assert_eq!(change.is_some_and(|change| !change.terms.is_empty()), round, "{oval}");
    }
}

/// Meshes of equal elements fall upon themselves, those of unequal ones do not; of the first no modes are computed, and no growth changes.
#[test]
fn even_meshes_are_known_without_modes() {
    let folder = tempfile::tempdir().unwrap();
    for (uneven, even) in [(0.0, true), (1e-4, false), (0.3, false), (-0.05, false)] {
        let case = case(folder.path(), uneven, 1.0, true);
        let prepared = Prepared::new(&case).unwrap();
        let disc = prepared.discs().remove(0).1;
        assert_eq!(is_even(&prepared, "disc", &disc), even, "{uneven}");
        let change = without_split(&prepared, 3e3, &()).unwrap().unwrap();
        assert_eq!(change.terms.is_empty(), even, "{uneven}");
    }
}
