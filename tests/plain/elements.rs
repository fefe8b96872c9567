//! What the elements must do on any mesh: patch tests, rank, rigid motions, frame invariance, closed forms.

use crate::common::*;
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, SMatrix, SVector, Vector3};
use stridor::bounds::{Origin::*, within};
use stridor::mesh::Cell;
use stridor::structure::elements::{Beam, FlatShell, dkt, opt};
use stridor::structure::*;

/// An irregular patch of the unit square: four corners, a node on each side, one inside.
fn patch(turn: &Rotation3<f64>) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let plane = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [0.43, 0.0],
        [1.0, 0.61],
        [0.37, 1.0],
        [0.0, 0.52],
        [0.58, 0.44],
    ];
    let nodes = plane.map(|[x, y]| (turn * Vector3::new(x, y, 0.0) + Vector3::new(0.3, -0.2, 0.7)).into());
    let faces = [[0, 4, 7], [4, 8, 7], [4, 1, 8], [1, 5, 8], [5, 2, 8], [2, 6, 8], [6, 3, 8], [3, 7, 8]];
    (nodes.to_vec(), faces.to_vec())
}

fn turned() -> Rotation3<f64> {
    Rotation3::from_euler_angles(0.4, -1.1, 2.3)
}

fn patch_stiffness(nodes: &[[f64; 3]], faces: &[[usize; 3]], h: f64) -> DMatrix<f64> {
    let mut k = DMatrix::zeros(6 * nodes.len(), 6 * nodes.len());
    for face in faces {
        let shell = FlatShell::new(&face.map(|n| nodes[n])).unwrap();
        let ke = shell.stiffness(&steel(), h, false);
        for a in 0..18 {
            for b in 0..18 {
                k[(6 * face[a / 6] + a % 6, 6 * face[b / 6] + b % 6)] += ke[(a, b)];
            }
        }
    }
    k
}

/// The nodal values of a quadratic deflection (constant curvature) and a linear membrane displacement (constant
/// strain, with its rotation), in global axes.
fn constant_state(turn: &Rotation3<f64>, x: f64, y: f64) -> [f64; 6] {
    let (exx, eyy, uy, vx) = (1.0e-3, -0.4e-3, 0.7e-3, 0.2e-3);
    let (u, v) = (exx * x + uy * y, vx * x + eyy * y);
    let w = 1e-3 * (0.8 * x * x - 0.5 * y * y + 0.6 * x * y);
    let (wx, wy) = (1e-3 * (1.6 * x + 0.6 * y), 1e-3 * (-y + 0.6 * x));
    let t = turn * Vector3::new(u, v, w);
    let r = turn * Vector3::new(wy, -wx, 0.5 * (vx - uy));
    [t[0], t[1], t[2], r[0], r[1], r[2]]
}

#[test]
fn patch_test_membrane_with_drilling_and_bending_in_any_plane() {
    for turn in [Rotation3::identity(), turned()] {
        let (nodes, faces) = patch(&turn);
        let k = patch_stiffness(&nodes, &faces, 0.01);
        let (flat, _) = patch(&Rotation3::identity());
        let exact = DVector::from_iterator(
            54,
            flat.iter().flat_map(|p| constant_state(&turn, p[0] - 0.3, p[1] + 0.2)),
        );
        // The inner node (8) is solved for from the others.
        let (inner, outer): (Vec<usize>, Vec<usize>) = (0..54).partition(|r| *r >= 48);
        let kii = k.select_rows(&inner).select_columns(&inner);
        let kio = k.select_rows(&inner).select_columns(&outer);
        let solved = -kii.lu().solve(&(kio * exact.select_rows(&outer))).unwrap();
        let error = (solved - exact.select_rows(&inner)).norm() / exact.select_rows(&inner).norm();
        // Round-off of membrane forces beside bending: (l/h)² ε is 1e-12, times ten.
        assert!(within(error, 1e-11, RoundOff), "{error:e}");

        // And the energy is that of the constant strains and curvatures, whatever the mesh.
        let elasticity = dkt::plane_stress(steel().youngs_modulus, 0.3);
        let rigidity = dkt::bending_rigidity(steel().youngs_modulus, 0.3, 0.01);
        let strain = Vector3::new(1.0e-3, -0.4e-3, 0.9e-3);
        let curvature = Vector3::new(1.6e-3, -1.0e-3, 1.2e-3);
        let energy = 0.01 * strain.dot(&(elasticity * strain)) + curvature.dot(&(rigidity * curvature));
        let found = exact.dot(&(&k * &exact));
        assert!(within((found / energy - 1.0).abs(), 1e-12, RoundOff), "{found} {energy}");
    }
}

#[test]
fn shell_triangle_has_six_rigid_motions_and_rank_twelve() {
    let nodes = [[0.1, 0.2, 0.3], [1.0, 0.1, 0.5], [0.4, 0.9, -0.2]];
    let shell = FlatShell::new(&nodes).unwrap();
    let k = shell.stiffness(&steel(), 0.05, false);
    assert_eq!(k, k.transpose());
    for motion in 0..6 {
        let r = rigid_motion(&nodes, motion);
        let r = SVector::<f64, 18>::from_column_slice(&r);
        assert!(
            within((k * r).norm(), 1e-12 * k.norm() * r.norm(), RoundOff),
            "motion {motion}: {:e}",
            (k * r).norm()
        );
    }
    let mut values: Vec<f64> = k.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    assert!(within(values[5].abs(), 1e-10 * values[6], RoundOff) && values[6] > 0.0, "{values:?}");
}

#[test]
fn masses_are_those_of_the_rigid_body_and_positive_definite() {
    let nodes = [[0.1, 0.2, 0.3], [1.0, 0.1, 0.5], [0.4, 0.9, -0.2]];
    let shell = FlatShell::new(&nodes).unwrap();
    let (rho, h) = (7850.0, 0.05);
    for rotary in [false, true] {
        let m = shell.mass(rho, h, rotary, false);
        assert_eq!(m, m.transpose());
        assert!(m.cholesky().is_some());
        let total = rho * h * shell.triangle().area;
        let centroid: [f64; 3] = std::array::from_fn(|k| (nodes[0][k] + nodes[1][k] + nodes[2][k]) / 3.0);
        let about = nodes.map(|p| std::array::from_fn(|k| p[k] - centroid[k]));
        // Second moment of a triangle about its centroid: A/12 Σ p pᵀ; rotary inertia adds h²/12 in the plane.
        let mut second = Matrix3::zeros();
        for p in about {
            let p = Vector3::from(p);
            second += p * p.transpose() * (total / 12.0);
        }
        let mut inertia = Matrix3::identity() * second.trace() - second;
        if rotary {
            let n = Vector3::from(shell.triangle().normal());
            inertia += (Matrix3::identity() - n * n.transpose()) * (total * h * h / 12.0);
        }
        let motions = SMatrix::<f64, 18, 6>::from_columns(&std::array::from_fn::<_, 6, _>(|k| {
            SVector::<f64, 18>::from_column_slice(&rigid_motion(&about, k))
        }));
        let found = motions.transpose() * m * motions;
        let mut expected = SMatrix::<f64, 6, 6>::identity() * total;
        expected.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia);
        assert!(within((found - expected).norm(), 1e-12 * total, RoundOff), "{found:e} {expected:e}");
    }
}

#[test]
fn matrices_turn_with_the_element() {
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.3, 0.8, 0.0]];
    let turn = turned();
    let moved = nodes.map(|p| (turn * Vector3::from(p) + Vector3::new(5.0, -3.0, 2.0)).into());
    let r = turn.matrix();
    let (a, b) = (FlatShell::new(&nodes).unwrap(), FlatShell::new(&moved).unwrap());
    // The same triangle with its corners numbered from another one.
    let cyclic = FlatShell::new(&[nodes[1], nodes[2], nodes[0]]).unwrap();
    for (ka, kb, kc) in [
        (
            a.stiffness(&steel(), 0.05, false),
            b.stiffness(&steel(), 0.05, false),
            cyclic.stiffness(&steel(), 0.05, false),
        ),
        (
            a.mass(7850.0, 0.05, true, false),
            b.mass(7850.0, 0.05, true, false),
            cyclic.mass(7850.0, 0.05, true, false),
        ),
        (a.geometric_stiffness([1.0, 2.0, 0.5]), b.geometric_stiffness([1.0, 2.0, 0.5]), SMatrix::zeros()),
    ] {
        let mut error = 0.0_f64;
        let mut renumbered = 0.0_f64;
        for i in (0..18).step_by(3) {
            for j in (0..18).step_by(3) {
                let block = r * ka.fixed_view::<3, 3>(i, j) * r.transpose();
                error = error.max((block - kb.fixed_view::<3, 3>(i, j)).norm());
                let back = |k: usize| (k + 12) % 18;
                renumbered = renumbered
                    .max((ka.fixed_view::<3, 3>(i, j) - kc.fixed_view::<3, 3>(back(i), back(j))).norm());
            }
        }
        assert!(within(error, 1e-12 * ka.norm(), RoundOff), "{error:e}");
        assert!(kc.norm() == 0.0 || within(renumbered, 1e-12 * ka.norm(), RoundOff), "{renumbered:e}");
    }
}

/// Felippa's shear-loaded cantilever, 48 × 12 × 1, E = 30000, ν = ¼, end shear 40 in all: 0.35583 at the middle of the tip
/// by elasticity; and pure bending of a rectangle of one pair of triangles, exact at any aspect ratio.
#[test]
fn optimal_triangle_bends_in_its_plane() {
    for aspect in [1.0, 4.0, 16.0] {
        let (e, nu) = (30000.0, 0.25);
        let elasticity = dkt::plane_stress(e, nu);
        let (a, b) = (aspect, 1.0);
        let corners = [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]];
        // Mean of both diagonals: u = −x y κ about the centre, v = κ x²/2, θ = κ x.
        let mut energy = 0.0;
        for face in [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]] {
            let c = face.map(|n: usize| corners[n]);
            let k = opt::stiffness(&c, &elasticity, nu, 1.0);
            let u = SVector::<f64, 9>::from_iterator(c.iter().flat_map(|p| {
                let (x, y) = (p[0] - a / 2.0, p[1] - b / 2.0);
                [-x * y, x * x / 2.0 + nu * y * y / 2.0, x]
            }));
            energy += 0.5 * u.dot(&(k * u)) * 0.5;
        }
        let exact = 0.5 * e * a * b.powi(3) / 12.0;
        assert!(within((energy / exact - 1.0).abs(), 1e-11, RoundOff), "aspect {aspect}: {}", energy / exact);
    }
}

#[test]
fn interpolation_meets_rigid_motions() {
    let nodes = [[0.1, 0.2, 0.3], [1.0, 0.1, 0.5], [1.2, 1.0, 0.1]];
    let at = [0.2, 0.3, 0.5];
    let point: [f64; 3] = std::array::from_fn(|k| (0..3).map(|i| at[i] * nodes[i][k]).sum());
    let columns = FlatShell::new(&nodes).unwrap().displacement_at(at);
    for motion in 0..6 {
        let r = rigid_motion(&nodes, motion);
        let found: [f64; 6] = std::array::from_fn(|i| columns.iter().zip(&r).map(|(c, u)| c[i] * u).sum());
        let exact = rigid_motion(&[point], motion);
        assert!(
            found.iter().zip(&exact).all(|(f, e)| within((f - e).abs(), 1e-13, RoundOff)),
            "{found:?} {exact:?}"
        );
    }
}

#[test]
fn bar_meets_the_closed_forms_in_any_direction() {
    let section = Section { area: 2e-4, inertia_1: 3e-9, inertia_2: 5e-9, torsion: 4e-9 };
    let material = steel();
    let along = Vector3::new(1.0, 2.0, -0.5).normalize();
    let ends = [[0.1, 0.2, 0.3], (Vector3::new(0.1, 0.2, 0.3) + along * 0.4).into()];
    let beam = Beam::new(&ends, [0.0, 0.0, 1.0]).unwrap();
    let k = beam.stiffness(&material, &section);
    let tip = k.fixed_view::<6, 6>(6, 6).into_owned();
    let first = (Vector3::z() - along * along.z).normalize();
    let second = along.cross(&first);
    let e = material.youngs_modulus;
    let g = e / 2.6;
    let l = 0.4_f64;
    for (force, flexibility) in [
        (along, l / (e * section.area)),
        (first, l.powi(3) / (3.0 * e * section.inertia_2)),
        (second, l.powi(3) / (3.0 * e * section.inertia_1)),
    ] {
        let f = SVector::<f64, 6>::from_column_slice(&[force[0], force[1], force[2], 0.0, 0.0, 0.0]);
        let u = tip.lu().solve(&f).unwrap();
        assert!(within((u.dot(&f) / flexibility - 1.0).abs(), 1e-10, RoundOff));
    }
    let t = SVector::<f64, 6>::from_column_slice(&[0.0, 0.0, 0.0, along[0], along[1], along[2]]);
    let twist = tip.lu().solve(&t).unwrap().dot(&t);
    assert!(within((twist * g * section.torsion / l - 1.0).abs(), 1e-10, RoundOff));
    for motion in 0..6 {
        let r = SVector::<f64, 12>::from_column_slice(&rigid_motion(&ends, motion));
        assert!(within((k * r).norm(), 1e-12 * k.norm() * r.norm(), RoundOff));
    }
}

/// Euler: a column held at one end buckles at π² E I / 4 l², one pinned at both at π² E I / l².
#[test]
fn euler_column_buckles() {
    let n = 8;
    let section = Section::round(0.01);
    let l = 0.5;
    let nodes: Vec<[f64; 3]> = (0..=n).map(|k| [0.0, 0.0, l * k as f64 / n as f64]).collect();
    let model = Model {
        nodes,
        parts: vec![Part::new(
            "column",
            (0..n).map(|k| Cell::line([k, k + 1])).collect(),
            Bar { material: steel(), section, orientation: [1.0, 0.0, 0.0] },
        )],
        supports: vec![Support { nodes: vec![0], held: [true; 6] }],
        ..Model::default()
    };
    let assembled = assemble(&model).unwrap();
    // Unit compression: the static displacement of a force −1 along z at the tip.
    let mut f = vec![0.0; assembled.dofs.n_dofs()];
    assembled.dofs.reduce(&[(n, 2, -1.0)]).add_to(1.0, &mut f);
    let u = solve(&assembled.structure.stiffness, &f);
    let k_sigma =
        stridor::system::Prestress::geometric_stiffness(&assembled.prestress(model.clone()), &u).unwrap();
    let load = smallest_buckling_load(&assembled.structure.stiffness, &k_sigma);
    let exact = std::f64::consts::PI.powi(2) * 210e9 * section.inertia_1 / (4.0 * l * l);
    assert!(within((load / exact - 1.0).abs(), 1e-4, Discretisation), "{load} {exact}");
}
