//! What solids must do on any mesh: patch tests, rank, rigid motions, closed forms and orders of convergence, geometric stiffness.

use crate::common::*;
use nalgebra::{Matrix3, SVector, Vector3};
use std::f64::consts::{PI, TAU};
use stridor::bounds::{Origin::*, within};
use stridor::linalg::random::Random;
use stridor::mesh::generate::structured_box;
use stridor::mesh::{Cell, CellKind, Mesh};
use stridor::structure::*;
use stridor::system::Prestress;

fn solids() -> impl Iterator<Item = CellKind> {
    CellKind::all().filter(|kind| kind.dimension() == 3)
}

/// Transversely isotropic, about a slanted axis.
fn lining() -> Material {
    let orthotropic = Orthotropic {
        axis_3: [0.48, -0.36, 0.8],
        axis_1: None,
        youngs_modulus_3: 1.1e9,
        poissons_ratio_13: 0.31,
        shear_modulus_13: 1.9e9,
        youngs_modulus_2: None,
        poissons_ratio_23: None,
        shear_modulus_23: None,
        shear_modulus_12: None,
    };
    let orthotropic = Some(orthotropic);
    Material { youngs_modulus: 8e9, poissons_ratio: 0.25, density: 2600.0, orthotropic, ..steel() }
}

fn of_mesh(mesh: &Mesh) -> Model {
    let cells =
        mesh.require("solid", 3).unwrap().elements.iter().map(|e| mesh.elements[*e].clone()).collect();
    let part = Part::new("solid", cells, Solid::new(steel()));
    Model { nodes: mesh.nodes.clone(), parts: vec![part], ..Model::default() }
}

/// A box whose nodes inside are moved at random; those in the middle of an edge stay there, or move by themselves, too.
fn distorted(kind: CellKind, curved: bool, seed: u64) -> (Mesh, Vec<bool>) {
    let mut random = Random::seeded(seed);
    let lengths = [1.0, 0.8, 0.6];
    let mut mesh = structured_box(kind, lengths, [2, 2, 2]).unwrap();
    let inside: Vec<bool> =
        mesh.nodes.iter().map(|x| (0..3).all(|k| x[k] > 1e-9 && x[k] < lengths[k] - 1e-9)).collect();
    let mut is_corner = vec![false; mesh.nodes.len()];
    mesh.elements.iter().flat_map(Cell::corners).for_each(|n| is_corner[*n] = true);
    for (node, x) in mesh.nodes.iter_mut().enumerate() {
        let far = if is_corner[node] { 0.06 } else { 0.01 };
        if inside[node] && (is_corner[node] || curved) {
            x.iter_mut().for_each(|x| *x += far * random.between(-1.0, 1.0));
        }
    }
    if !curved {
        let old = mesh.nodes.clone();
        for cell in &mesh.elements {
            for (node, of) in
                cell.nodes().iter().zip(cell.kind().table().middles).filter(|(_, of)| of.len() > 1)
            {
                mesh.nodes[*node] = std::array::from_fn(|k| {
                    of.iter().map(|c| old[cell.nodes()[usize::from(*c)]][k]).sum::<f64>() / of.len() as f64
                });
            }
        }
    }
    (mesh, inside)
}

/// A displacement at every node as values of the free degrees of freedom.
fn values(dofs: &DofMap, nodes: &[[f64; 3]], u: impl Fn([f64; 3]) -> Vector3<f64>) -> Vec<f64> {
    let of = |dof: &FreeDof| u(nodes[dof.node]).dot(&Vector3::from_column_slice(&dof.direction[..3]));
    dofs.free_dofs().iter().map(of).collect()
}

/// Goal: under a linear displacement no force acts on a node inside, however the mesh is distorted, and the energy is ½ εᵀDε V.
#[test]
fn patch_test_of_every_kind() {
    let gradient = Matrix3::new(0.3, -0.2, 0.5, 0.1, 0.7, -0.4, 0.6, 0.2, -0.1);
    let e = gradient + gradient.transpose();
    let strain = SVector::<f64, 6>::from([
        gradient[(0, 0)],
        gradient[(1, 1)],
        gradient[(2, 2)],
        e[(0, 1)],
        e[(1, 2)],
        e[(2, 0)],
    ]);
    let reduced = Solid { integration: Integration::Reduced, ..Solid::new(steel()) };
    let plain =
        solids().flat_map(|kind| [(kind, false), (kind, true)]).map(|(k, c)| (k, c, Solid::new(steel())));
    let special =
        [(CellKind::Hexahedron20, false, reduced), (CellKind::Hexahedron8, false, Solid::new(lining()))];
    for (kind, curved, solid) in plain.chain(special) {
        let energy = strain.dot(&(solid.material.elasticity() * strain)) * 0.48;
        let (mesh, inside) = distorted(kind, curved, 3);
        let mut model = of_mesh(&mesh);
        model.parts[0].kind = solid.into();
        let assembled = assemble(&model).unwrap();
        let u = values(&assembled.dofs, &mesh.nodes, |x| gradient * Vector3::from(x));
        let k = assembled.structure.stiffness.to_dense();
        let forces: Vec<f64> = (0..u.len()).map(|i| (0..u.len()).map(|j| k[(i, j)] * u[j]).sum()).collect();
        let found: f64 = forces.iter().zip(&u).map(|(f, u)| f * u).sum();
        let size = forces.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let free = assembled.dofs.free_dofs().iter().zip(&forces).filter(|(dof, _)| inside[dof.node]);
        let rest = free.fold(0.0_f64, |m, (_, f)| m.max(f.abs())) / size;
        println!("{kind:?} curved {curved}: {rest:e} {:e}", found / energy - 1.0);
        // Round-off of sums of stiffnesses; ten times what was seen.
        let bound = 1e-13;
        assert!(
            within(rest, bound, RoundOff) && within((found / energy - 1.0).abs(), bound, RoundOff),
            "{kind:?} curved {curved}: {rest:e} {found} {energy}"
        );
    }
}

/// Goal: one element has six motions without energy and no more, its mass along each axis is ρV.
#[test]
fn one_element_has_rank_and_mass() {
    let reduced = (CellKind::Hexahedron20, Integration::Reduced);
    for (kind, integration) in solids().map(|kind| (kind, Integration::Full)).chain([reduced]) {
        let mut mesh = structured_box(kind, [0.3, 0.2, 0.25], [1, 1, 1]).unwrap();
        let one = mesh.elements[0].clone();
        let mut used = one.nodes().to_vec();
        used.sort_unstable();
        mesh.nodes = used.iter().map(|n| mesh.nodes[*n]).collect();
        let cell = one.renumbered(|n| used.binary_search(&n).unwrap());
        let part = Part::new("one", vec![cell], Solid { material: steel(), integration });
        let model = Model { nodes: mesh.nodes.clone(), parts: vec![part], ..Model::default() };
        let assembled = assemble(&model).unwrap();
        let k = assembled.structure.stiffness.to_dense();
        let values = k.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        let largest = values[values.len() - 1];
        assert_eq!(values.len(), 3 * kind.n_nodes());
        assert!(
            within(values[5].abs(), 1e-13 * largest, RoundOff) && values[6] > 1e-5 * largest,
            "{kind:?}: {values:?}"
        );
        let m = assembled.structure.mass.to_dense();
        for rigid in assembled.dofs.rigid_body_vectors([0.1, -0.2, 0.3]).iter().take(3) {
            let all = (0..rigid.len()).flat_map(|i| (0..rigid.len()).map(move |j| (i, j)));
            let mass: f64 = all.map(|(i, j)| rigid[i] * m[(i, j)] * rigid[j]).sum();
            assert!(within((mass / assembled.total_mass - 1.0).abs(), 1e-13, RoundOff), "{kind:?}");
        }
        for rigid in assembled.dofs.rigid_body_vectors([0.1, -0.2, 0.3]) {
            for i in 0..rigid.len() {
                let force: f64 = (0..rigid.len()).map(|j| k[(i, j)] * rigid[j]).sum();
                assert!(within(force.abs(), 1e-13 * largest, RoundOff), "{kind:?}: {force:e}");
            }
        }
        if kind.table().name.contains("hexahedron") {
            assert!(within((assembled.total_mass / (7850.0 * 0.015) - 1.0).abs(), 1e-14, RoundOff));
        }
    }
}

/// A box held along the normal of each of its faces: waves of wavenumbers k = π (a/l_x, b/l_y, c/l_z), ω = c_p |k| of pressure, where two
/// of (a, b, c) may be zero, and ω = c_s |k| of shear, once where one of them is zero and twice where none is.
fn waves(lengths: [f64; 3], count: usize) -> Vec<f64> {
    let Material { youngs_modulus: e, poissons_ratio: nu, density, .. } = steel();
    let g = e / (2.0 * (1.0 + nu));
    let (pressure, shear) =
        ((2.0 * g * (1.0 - nu) / (1.0 - 2.0 * nu) / density).sqrt(), (g / density).sqrt());
    let mut all = Vec::new();
    for [a, b, c] in (0..6).flat_map(|a| (0..6).flat_map(move |b| (0..6).map(move |c| [a, b, c]))) {
        let k =
            [a, b, c].iter().zip(lengths).map(|(n, l)| (PI * f64::from(*n) / l).powi(2)).sum::<f64>().sqrt();
        let zeros = [a, b, c].iter().filter(|n| **n == 0).count();
        let shears = [2, 1, 0, 0][zeros];
        if zeros < 3 {
            all.push(pressure * k / TAU);
        }
        all.extend(vec![shear * k / TAU; shears]);
    }
    all.sort_by(f64::total_cmp);
    all.truncate(count);
    all
}

/// Goal: natural frequencies converge to those of the closed form, eigenvalues ω² with order 4 for kinds of second order and 2 for
/// the others.
#[test]
fn eigenvalues_converge_with_the_order_of_the_kind() {
    let lengths = [1.0, 0.83, 0.1];
    let exact = waves(lengths, 3);
    for kind in solids() {
        let second = !kind.is_first_order();
        let across = if second { 8 } else { 12 };
        let errors = [1, 2].map(|finer| {
            let mesh = structured_box(kind, lengths, [across, across, 1].map(|n| n * finer)).unwrap();
            let mut model = of_mesh(&mesh);
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                for end in ["min", "max"] {
                    let mut held = [false; 6];
                    held[axis] = true;
                    let nodes = mesh.region_nodes(mesh.require(&format!("{name}_{end}"), 2).unwrap());
                    model.supports.push(Support { nodes, held });
                }
            }
            let found = lowest_frequencies(&assemble(&model).unwrap().structure, exact.len(), 0.0);
            exact.iter().zip(found).map(|(e, f)| ((f / e).powi(2) - 1.0).abs()).fold(0.0, f64::max)
        });
        let order = (errors[0] / errors[1]).log2();
        println!("{kind:?}: {errors:?}, order {order:.2}");
        let least = if second { 3.8 } else { 1.9 };
        assert!(order > least, "{kind:?}: {errors:?}, order {order:.2}");
    }
}

/// Goal: NAFEMS FV52, a square plate of 10 × 10 × 1 m of solids, its lower edges held across: three rigid motions and the frequencies of the test
/// (NAFEMS, The Standard NAFEMS Benchmarks, 1990: 45.897, 109.44 twice, 167.89, 193.59, 206.19 twice).
#[test]
fn nafems_simply_supported_solid_plate() {
    let published = [45.897, 109.44, 109.44, 167.89, 193.59, 206.19, 206.19];
    let material = Material { youngs_modulus: 200e9, density: 8000.0, ..steel() };
    for kind in [
        CellKind::Hexahedron8,
        CellKind::Hexahedron20,
        CellKind::Hexahedron27,
        CellKind::Wedge15,
        CellKind::Tetrahedron10,
    ] {
        let cells = if kind.is_first_order() { [16, 16, 3] } else { [8, 8, 2] };
        let mesh = structured_box(kind, [10.0, 10.0, 1.0], cells).unwrap();
        let mut model = of_mesh(&mesh);
        model.parts[0].kind = Solid::new(material).into();
        let edge = |x: &[f64; 3]| x[2] < 1e-9 && (0..2).any(|k| x[k] < 1e-9 || x[k] > 10.0 - 1e-9);
        let nodes = (0..mesh.nodes.len()).filter(|n| edge(&mesh.nodes[*n])).collect();
        model.supports.push(Support { nodes, held: [false, false, true, false, false, false] });
        let found = lowest_frequencies(&assemble(&model).unwrap().structure, 10, 10.0);
        let errors: Vec<f64> = published.iter().zip(&found[3..]).map(|(e, f)| f / e - 1.0).collect();
        println!("{kind:?}: {errors:.4?}");
        assert!(found[2] < 0.05, "{kind:?}: {found:?}");
        assert!(errors.iter().all(|e| within(e.abs(), 0.06, Discretisation)), "{kind:?}: {errors:?}");
    }
}

/// Goal: a cantilever of 15 hexahedra of 20 nodes, 300 × 30 × 1 mm, has the frequencies that CalculiX states for the same mesh and
/// quadrature (its test dloadlin20f, C3D20).
#[test]
fn a_cantilever_of_hexahedra_is_that_of_calculix() {
    let published = [9.483, 59.577, 168.56, 183.57, 277.76, 336.68];
    let mesh = structured_box(CellKind::Hexahedron20, [0.3, 0.03, 0.001], [15, 1, 1]).unwrap();
    let mut model = of_mesh(&mesh);
    model.parts[0].kind = Solid::new(Material { youngs_modulus: 209e9, ..steel() }).into();
    let nodes = mesh.region_nodes(mesh.require("x_min", 2).unwrap());
    model.supports.push(Support { nodes, held: [true, true, true, false, false, false] });
    let found = lowest_frequencies(&assemble(&model).unwrap().structure, published.len(), 0.0);
    for (published, found) in published.iter().zip(&found) {
        // Five digits are published.
        assert!(within((found / published - 1.0).abs(), 5e-5, Reference), "{found} {published}");
    }
}

/// Goal: a cantilever of 2 × 2 × 8 hexahedra of 20 nodes with reduced integration, 1 × 1.5 × 8 mm, has the frequencies that CalculiX states
/// for the same mesh and quadrature (its test beamf, C3D20R).
#[test]
fn a_cantilever_with_reduced_integration_is_that_of_calculix() {
    let published = [13096.03, 19319.52, 76839.71, 86955.23, 105963.6, 162998.5];
    let mesh = structured_box(CellKind::Hexahedron20, [0.001, 0.0015, 0.008], [2, 2, 8]).unwrap();
    let mut model = of_mesh(&mesh);
    let material = Material { youngs_modulus: 210e9, density: 7800.0, ..steel() };
    let nodes = mesh.region_nodes(mesh.require("z_min", 2).unwrap());
    model.supports.push(Support { nodes, held: [true, true, true, false, false, false] });
    for (integration, nearer, farther) in [(Integration::Reduced, 0.0, 2e-4), (Integration::Full, 5e-4, 2e-2)]
    {
        model.parts[0].kind = Solid { material, integration }.into();
        let found = lowest_frequencies(&assemble(&model).unwrap().structure, published.len(), 0.0);
        for (published, found) in published.iter().zip(&found) {
            let error = (found / published - 1.0).abs();
            assert!(
                error >= nearer && within(error, farther, Theory),
                "{integration:?}: {found} {published}"
            );
        }
    }
}

/// Goal: a uniform stress σ along x gives a bar's K_σ: transverse motions w = x have the energy ½ σ A l; rigid translations none.
#[test]
fn geometric_stiffness_of_a_stretched_bar() {
    for kind in solids() {
        let (mesh, _) = distorted(kind, false, 5);
        let model = of_mesh(&mesh);
        let assembled = assemble(&model).unwrap();
        // Free to contract: σ = E ε along x alone.
        let strain = 1e-6;
        let stretched =
            values(&assembled.dofs, &mesh.nodes, |x| Vector3::new(x[0], -0.3 * x[1], -0.3 * x[2]) * strain);
        let k = assembled.prestress(model).geometric_stiffness(&stretched).unwrap().to_dense();
        let moved = values(&assembled.dofs, &mesh.nodes, |x| Vector3::new(0.0, 0.0, x[0]));
        let n = moved.len();
        let energy: f64 = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i, j)))
            .map(|(i, j)| moved[i] * k[(i, j)] * moved[j])
            .sum();
        let right = 210e9 * strain * 0.48 * 1.0;
        assert!(within((energy / right - 1.0).abs(), 1e-11, RoundOff), "{kind:?}: {energy} {right}");
        let rigid = values(&assembled.dofs, &mesh.nodes, |_| Vector3::new(0.0, 0.0, 1.0));
        let largest = (0..n).fold(0.0_f64, |m, i| m.max(k[(i, i)].abs()));
        for i in 0..n {
            let force: f64 = (0..n).map(|j| k[(i, j)] * rigid[j]).sum();
            assert!(within(force.abs(), 1e-11 * largest, RoundOff), "{kind:?}: {force:e} {largest:e}");
        }
    }
}

/// Goal: a slender cantilever of one layer of cells bends as a bar, first frequency (1.8751/l)² √(EI/ρA)/2π; without the displacements
/// inside of a hexahedron it would be a half too high.
#[test]
fn a_slender_bar_bends_without_locking() {
    let (l, h) = (1.0, 0.05);
    let exact = (1.875_104_f64 / l).powi(2) * (210e9_f64 * h * h / 12.0 / 7850.0).sqrt() / TAU;
    for kind in solids().filter(|kind| !kind.is_first_order() || *kind == CellKind::Hexahedron8) {
        let mesh = structured_box(kind, [l, h, h], [20, 1, 1]).unwrap();
        let mut model = of_mesh(&mesh);
        let nodes = mesh.region_nodes(mesh.require("x_min", 2).unwrap());
        model.supports.push(Support { nodes, held: [true, true, true, false, false, false] });
        let found = lowest_frequencies(&assemble(&model).unwrap().structure, 2, 0.0);
        println!("{kind:?}: {:?}", found.iter().map(|f| f / exact - 1.0).collect::<Vec<_>>());
        // Shear and rotary inertia lower it by some (h/l)²; the clamp holds the width, which raises it; cells cut tetrahedra unevenly.
        assert!(
            found.iter().all(|f| within((f / exact - 1.0).abs(), 0.012, Discretisation)),
            "{kind:?}: {found:?} {exact}"
        );
    }
}
