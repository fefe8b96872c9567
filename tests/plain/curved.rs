//! Solids with curved faces against closed forms: natural frequencies converge with the order of the kind.

use crate::common::*;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use stridor::mesh::generate::structured_box;
use stridor::mesh::{Cell, CellKind, Mesh};
use stridor::structure::*;

/// Kinds with a node in the middle of edges, each with its quadratures.
fn second_order() -> impl Iterator<Item = (CellKind, Integration)> {
    let full = CellKind::all().filter(|kind| kind.dimension() == 3 && !kind.is_first_order());
    full.map(|kind| (kind, Integration::Full)).chain([(CellKind::Hexahedron20, Integration::Reduced)])
}

/// A box of unit edges whose nodes are moved to where `place` puts them.
fn mapped(kind: CellKind, cells: [usize; 3], place: impl Fn([f64; 3]) -> [f64; 3]) -> Mesh {
    let mut mesh = structured_box(kind, [1.0; 3], cells).unwrap();
    mesh.nodes.iter_mut().for_each(|x| *x = place(*x));
    mesh
}

/// A body of steel that slides without friction along `planes` through points of a normal: symmetry.
fn symmetric(mesh: &Mesh, integration: Integration, planes: &[([f64; 3], f64)]) -> Model {
    let region = mesh.require("solid", 3).unwrap();
    let cells: Vec<Cell> = region.elements.iter().map(|e| mesh.elements[*e].clone()).collect();
    let part = Part::new("body", cells, Solid { material: steel(), integration });
    let held = |x: &[f64; 3]| {
        let mut across: Vec<Vector3<f64>> = Vec::new();
        for (normal, at) in planes {
            let normal = Vector3::from(*normal).normalize();
            if (normal.dot(&Vector3::from(*x)) - at).abs() < 1e-12 {
                let rest = across.iter().fold(normal, |rest, held| rest - held * held.dot(&normal));
                across.push(rest.normalize());
            }
        }
        across.iter().map(|n| [n[0], n[1], n[2], 0.0, 0.0, 0.0]).collect::<Vec<_>>()
    };
    let support = |(node, x)| InclinedSupport { node, held: held(x), name: "symmetry".to_string() };
    let supports = mesh.nodes.iter().enumerate().map(support).filter(|support| !support.held.is_empty());
    Model {
        nodes: mesh.nodes.clone(),
        parts: vec![part],
        inclined_supports: supports.collect(),
        ..Model::default()
    }
}

/// The order at which the largest error of the eigenvalues ω² falls from one mesh to that of cells half as large.
fn order(exact: &[f64], model: impl Fn(usize) -> Model) -> (f64, [f64; 2]) {
    let errors = [1, 2].map(|finer| {
        let found = lowest_frequencies(&assemble(&model(finer)).unwrap().structure, exact.len(), 0.0);
        exact.iter().zip(found).map(|(e, f)| ((f / e).powi(2) - 1.0).abs()).fold(0.0, f64::max)
    });
    ((errors[0] / errors[1]).log2(), errors)
}

/// Goal: a quarter of a thick ring between smooth planes, radii 30 and 50 mm, has modes of 2 and 0 waves around at the zeros of Gazis's
/// determinant (validation/free-solids/exact.py), with order 4 in the eigenvalue.
#[test]
fn curved_cells_of_a_ring_converge_with_order_four() {
    let exact = [7524.518321360, 22191.268233470];
    let planes =
        [([1.0, 0.0, 0.0], 0.0), ([0.0, 1.0, 0.0], 0.0), ([0.0, 0.0, 1.0], 0.0), ([0.0, 0.0, 1.0], 0.01)];
    for (kind, integration) in second_order() {
        let (order, errors) = order(&exact, |finer| {
            let mesh = mapped(kind, [4 * finer, 14 * finer, 1], |[u, v, w]| {
                let (sin, cos) = (FRAC_PI_2 * v).sin_cos();
                let r = 0.03 + 0.02 * u;
                let clean = |x: f64| if x.abs() < 1e-15 { 0.0 } else { x };
                [clean(r * cos), clean(r * sin), 0.01 * w]
            });
            symmetric(&mesh, integration, &planes)
        });
        println!("{kind:?} {integration:?}: {errors:?}, order {order:.2}");
        assert!(order > 3.8, "{kind:?} {integration:?}: {errors:?}, order {order:.2}");
    }
}

/// Goal: an eighth of a sixth of a hollow sphere, radii 30 and 50 mm, breathes at the zero of the determinant of σ_r = 0 at both radii
/// (validation/nafems-solids/closed_form.py), with an order in the eigenvalue that approaches 4 from below.
#[test]
fn curved_cells_of_a_hollow_sphere_converge_with_order_four() {
    let exact = [35619.42528205];
    let planes =
        [([0.0, 1.0, 0.0], 0.0), ([0.0, 0.0, 1.0], 0.0), ([1.0, -1.0, 0.0], 0.0), ([1.0, 0.0, -1.0], 0.0)];
    for (kind, integration) in second_order() {
        let (order, errors) = order(&exact, |finer| {
            let mesh = mapped(kind, [2 * finer, 3 * finer, 3 * finer], |[u, v, w]| {
                let at = [1.0, (FRAC_PI_4 * v).tan(), (FRAC_PI_4 * w).tan()];
                let size = at.iter().map(|x| x * x).sum::<f64>().sqrt();
                at.map(|x| (0.03 + 0.02 * u) * x / size)
            });
            symmetric(&mesh, integration, &planes)
        });
        println!("{kind:?} {integration:?}: {errors:?}, order {order:.2}");
        assert!(order > 3.6, "{kind:?} {integration:?}: {errors:?}, order {order:.2}");
    }
}
