//! Mindlin–Reissner plates: patch tests, closed forms of thick plates, three-dimensional elasticity, no locking.

use crate::common::*;
use nalgebra::{DMatrix, DVector, Rotation3, Vector3};
use puruspe::{In, Jn};
use std::f64::consts::{PI, TAU};
use stridor::bounds::{Origin::*, within};
use stridor::mesh::Cell;
use stridor::structure::elements::waves::mindlin_frequency;
use stridor::structure::elements::{ElementMatrix, FacePoint, dkt};
use stridor::structure::*;
use stridor::validation::kirchhoff;

fn thick(h: f64) -> Shell {
    Shell { theory: PlateTheory::Mindlin, ..Shell::new(steel(), h) }
}

/// An irregular patch of the unit square, three quadrilaterals and two triangles, warped by `warp` and turned in space.
fn patch(turn: &Rotation3<f64>, warp: f64) -> (Vec<[f64; 3]>, Vec<Cell>) {
    let plane = FLAT.map(|[x, y]| [x, y, warp * (3.0 * x - 2.0 * y) * (x + 2.0 * y)]);
    let nodes = plane.map(|x| (turn * Vector3::from(x) + Vector3::new(0.3, -0.2, 0.7)).into());
    let faces = vec![
        Cell::quadrilateral([0, 4, 8, 7]),
        Cell::quadrilateral([1, 5, 8, 4]),
        Cell::triangle([5, 2, 8]),
        Cell::triangle([8, 2, 6]),
        Cell::quadrilateral([6, 3, 7, 8]),
    ];
    (nodes.to_vec(), faces)
}

const FLAT: [[f64; 2]; 9] = [
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

fn turned() -> Rotation3<f64> {
    Rotation3::from_euler_angles(0.4, -1.1, 2.3)
}

/// K and M of one face on the six degrees of freedom of its nodes.
fn matrices(face: &Cell, nodes: &[[f64; 3]], h: f64) -> [DMatrix<f64>; 2] {
    let part = Part::new("plate", vec![face.clone()], thick(h));
    let element = part.element(nodes).unwrap();
    let n = element.n_freedoms();
    assert_eq!((n, element.nodes()), (6 * face.nodes().len(), face.nodes()));
    [true, false].map(|stiffness| {
        let mut matrix = ElementMatrix::default();
        matrix.reset(n);
        assert!(if stiffness { element.stiffness(&mut matrix) } else { element.mass(&mut matrix) });
        DMatrix::from_fn(n, n, |i, j| matrix.get(i, j))
    })
}

fn patch_stiffness(nodes: &[[f64; 3]], faces: &[Cell], h: f64) -> DMatrix<f64> {
    let mut k = DMatrix::zeros(6 * nodes.len(), 6 * nodes.len());
    for face in faces {
        let [ke, _] = matrices(face, nodes, h);
        let at = |a: usize| 6 * face.nodes()[a / 6] + a % 6;
        for a in 0..ke.nrows() {
            for b in 0..ke.nrows() {
                k[(at(a), at(b))] += ke[(a, b)];
            }
        }
    }
    k
}

/// Constant membrane strain and constant curvature at (x, y), turned into space.
fn constant_state(turn: &Rotation3<f64>, [x, y]: [f64; 2]) -> [f64; 6] {
    let (exx, eyy, uy, vx) = (1.0e-3, -0.4e-3, 0.7e-3, 0.2e-3);
    let w = 1e-3 * (0.8 * x * x - 0.5 * y * y + 0.6 * x * y);
    let (wx, wy) = (1e-3 * (1.6 * x + 0.6 * y), 1e-3 * (-y + 0.6 * x));
    let t = turn * Vector3::new(exx * x + uy * y, vx * x + eyy * y, w);
    let r = turn * Vector3::new(wy, -wx, 0.5 * (vx - uy));
    [t[0], t[1], t[2], r[0], r[1], r[2]]
}

/// Goal: constant moments and membrane forces exactly, however thick the plate, on triangles beside quadrilaterals.
#[test]
fn patch_test_of_constant_moments() {
    let strain = Vector3::new(1.0e-3, -0.4e-3, 0.9e-3);
    let curvature = Vector3::new(1.6e-3, -1.0e-3, 1.2e-3);
    for (turn, h) in [(Rotation3::identity(), 0.01), (turned(), 0.01), (turned(), 0.5), (turned(), 1e-3)] {
        let (nodes, faces) = patch(&turn, 0.0);
        let k = patch_stiffness(&nodes, &faces, h);
        let exact = DVector::from_iterator(54, FLAT.iter().flat_map(|p| constant_state(&turn, *p)));
        let (inner, outer): (Vec<usize>, Vec<usize>) = (0..54).partition(|r| *r >= 48);
        let kii = k.select_rows(&inner).select_columns(&inner);
        let kio = k.select_rows(&inner).select_columns(&outer);
        let solved = -kii.lu().solve(&(kio * exact.select_rows(&outer))).unwrap();
        let error = (solved - exact.select_rows(&inner)).norm() / exact.select_rows(&inner).norm();
        // Round-off of membrane forces beside bending: (l/h)² of 1e-16, times ten.
        assert!(within(error, 1e-9, RoundOff), "h {h}: {error:e}");
        let elasticity = dkt::plane_stress(steel().youngs_modulus, 0.3);
        let rigidity = dkt::bending_rigidity(steel().youngs_modulus, 0.3, h);
        let energy = h * strain.dot(&(elasticity * strain)) + curvature.dot(&(rigidity * curvature));
        let found = exact.dot(&(&k * &exact));
        assert!(within((found / energy - 1.0).abs(), 1e-11, RoundOff), "h {h}: {found} {energy}");
    }
}

/// Goal: where the plate is thick beside its elements, constant shear strain without bending has the energy ½ κGh γ² A and, with the
/// bulge of the sides 1/(1+φ), no more than that part of it besides; φ ≥ 2/(κ(1−ν)) (h/l)².
#[test]
fn patch_test_of_constant_shear_in_thick_plates() {
    for (h, bound) in [(1e2, 1e-3), (1e4, 1e-7)] {
        let (nodes, faces) = patch(&Rotation3::identity(), 0.0);
        let k = patch_stiffness(&nodes, &faces, h);
        let (gx, gy) = (0.3e-3, -0.8e-3);
        let state = DVector::from_iterator(
            54,
            FLAT.iter().flat_map(|[x, y]| [0.0, 0.0, gx * x + gy * y, 0.0, 0.0, 0.0]),
        );
        let shear = thick(h).shear_coefficient() * steel().shear_modulus() * h;
        let energy = shear * (gx * gx + gy * gy);
        let found = state.dot(&(&k * &state));
        assert!(within((found / energy - 1.0).abs(), bound, Theory), "h {h}: {:e}", found / energy - 1.0);
        // In equilibrium inside, beside the forces of the whole.
        let force = &k * &state;
        assert!(within(force.rows(48, 3).norm(), bound * force.norm(), Theory), "{force}");
    }
}

/// Goal: six rigid motions and nothing else free of strain, also warped; mass and its moments those of the body.
#[test]
fn rank_rigid_motions_and_mass() {
    for warp in [0.0, 0.1] {
        let (nodes, faces) = patch(&turned(), warp);
        for face in &faces {
            let corners: Vec<[f64; 3]> = face.nodes().iter().map(|n| nodes[*n]).collect();
            for h in [1e-3, 0.05, 2.0] {
                let [k, m] = matrices(face, &nodes, h);
                assert_eq!(k, k.transpose());
                assert_eq!(m, m.transpose());
                assert!(m.clone().cholesky().is_some(), "{face:?} {h}");
                for motion in 0..6 {
                    let r = DVector::from_vec(rigid_motion(&corners, motion));
                    let bound = 1e-11 * k.norm() * r.norm();
                    assert!(within((&k * &r).norm(), bound, RoundOff), "{face:?} {h} motion {motion}");
                }
                // Scaled to a unit diagonal, so that membrane and bending are of one size.
                let scale = DVector::from_fn(k.nrows(), |i, _| 1.0 / k[(i, i)].sqrt());
                let scaled = DMatrix::from_fn(k.nrows(), k.nrows(), |i, j| scale[i] * k[(i, j)] * scale[j]);
                let mut values: Vec<f64> = scaled.symmetric_eigenvalues().iter().copied().collect();
                values.sort_by(f64::total_cmp);
                assert!(within(values[5].abs(), 1e-9, RoundOff), "{face:?} h {h}: {values:?}");
                assert!(values[6] > 1e-7, "{face:?} h {h}: {values:?}");
                let part = Part::new("plate", vec![face.clone()], thick(h));
                let (total, _) = part.element(&nodes).unwrap().mass_and_center();
                assert!(within((total / (7850.0 * h * part.area(&nodes)) - 1.0).abs(), 1e-13, RoundOff));
                for axis in 0..3 {
                    let r = DVector::from_vec(rigid_motion(&corners, axis));
                    let found = r.dot(&(&m * &r));
                    assert!(within((found / total - 1.0).abs(), 1e-12, RoundOff), "{face:?} {h}: {found}");
                }
            }
        }
    }
}

/// Goal: points of a face move by rigid motions, and by constant curvature (w quadratic, β linear), exactly.
#[test]
fn interpolation_meets_rigid_motions_and_constant_curvature() {
    let (nodes, faces) = patch(&turned(), 0.0);
    let part = Part::new("plate", faces.clone(), thick(0.05));
    let l = [0.2, 0.3, 0.5];
    for (face, element) in faces.iter().enumerate() {
        let corners: [usize; 3] = std::array::from_fn(|k| element.nodes()[k + element.nodes().len() - 3]);
        let at = FacePoint { corners, barycentric: l };
        let moved = part.displacement_on(&nodes, &faces[face], &at);
        let found = |u: &dyn Fn(usize) -> [f64; 6]| {
            moved.iter().fold([0.0; 6], |sum, (node, component, by)| {
                std::array::from_fn(|i| sum[i] + by[i] * u(*node)[*component])
            })
        };
        let point: [f64; 3] = std::array::from_fn(|k| (0..3).map(|i| l[i] * nodes[corners[i]][k]).sum());
        for motion in 0..6 {
            let rigid = |x: [f64; 3]| -> [f64; 6] { rigid_motion(&[x], motion).try_into().unwrap() };
            let (found, exact) = (found(&|node| rigid(nodes[node])), rigid(point));
            assert!(
                found.iter().zip(exact).all(|(f, e)| within((f - e).abs(), 1e-13, RoundOff)),
                "{found:?}"
            );
        }
        let flat: [f64; 2] = std::array::from_fn(|k| (0..3).map(|i| l[i] * FLAT[corners[i]][k]).sum());
        let (found, exact) =
            (found(&|node| constant_state(&turned(), FLAT[node])), constant_state(&turned(), flat));
        assert!(found.iter().zip(exact).all(|(f, e)| within((f - e).abs(), 1e-15, RoundOff)), "{found:?}");
    }
}

/// Pseudo-random numbers from −½ to ½.
fn random(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

/// The unit square of n × n cells, simply supported (hard), inner nodes moved by up to `off` of half a cell at random.
fn supported_square(n: usize, shell: Shell, quadrilaterals: bool, off: f64) -> Model {
    let mut random = random(7);
    let id = |i: usize, j: usize| i * (n + 1) + j;
    let inside = |i: usize| i > 0 && i < n;
    let mut nodes = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            let (dx, dy) = (off * random(), off * random());
            let keep = if inside(i) && inside(j) { 1.0 } else { 0.0 };
            nodes.push([(i as f64 + keep * dx) / n as f64, (j as f64 + keep * dy) / n as f64, 0.0]);
        }
    }
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let [p, q, r, s] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            let first = if off > 0.0 { random() < 0.0 } else { (i + j) % 2 == 0 };
            match (quadrilaterals, first) {
                (true, _) => faces.push(Cell::quadrilateral([p, q, r, s])),
                (false, true) => faces.extend([Cell::triangle([p, q, r]), Cell::triangle([p, r, s])]),
                (false, false) => faces.extend([Cell::triangle([p, q, s]), Cell::triangle([q, r, s])]),
            }
        }
    }
    let along = |fixed: fn(usize, usize) -> bool| {
        (0..=n)
            .flat_map(|i| (0..=n).map(move |j| (i, j)))
            .filter(|(i, j)| fixed(*i % n, *j % n))
            .map(|(i, j)| id(i, j))
            .collect()
    };
    let supports = vec![
        Support { nodes: along(|i, _| i == 0), held: [false, false, true, true, false, false] },
        Support { nodes: along(|_, j| j == 0), held: [false, false, true, false, true, false] },
    ];
    Model { nodes, parts: vec![Part::new("plate", faces, shell)], supports, ..Model::default() }
}

/// Waves across the diagonals of a supported square, k² = π²(m² + n²), the lowest `count` of them.
fn wavenumbers(count: usize) -> Vec<f64> {
    let square = |m: usize, n: usize| PI * PI * (m * m + n * n) as f64;
    let mut k: Vec<f64> = (1..6).flat_map(|m| (1..6).map(move |n| square(m, n).sqrt())).collect();
    k.sort_by(f64::total_cmp);
    k.truncate(count);
    k
}

fn worst(found: &[f64], exact: &[f64]) -> f64 {
    exact.iter().zip(found).map(|(e, f)| (f / e - 1.0).abs()).fold(0.0, f64::max)
}

/// Navier's solution of Mindlin's plate: the frequency of the wave that stands between the edges.
fn navier(kappa: f64, h: f64, count: usize) -> Vec<f64> {
    wavenumbers(count).iter().map(|k| mindlin_frequency(&steel(), h, kappa, *k) / TAU).collect()
}

fn supported_errors(h: f64, kappa: f64, quadrilaterals: bool, off: f64, cells: [usize; 3]) -> [f64; 3] {
    let exact = navier(kappa, h, 6);
    cells.map(|n| {
        let shell = Shell { shear_coefficient: Some(kappa), bending_only: true, ..thick(h) };
        let assembled = assemble(&supported_square(n, shell, quadrilaterals, off)).unwrap();
        worst(&lowest_frequencies(&assembled.structure, exact.len(), 0.0), &exact)
    })
}

/// Goal: six modes of thick supported squares (h/a = 0.1 and 0.2, κ = 5/6 as in published tables) converge to Navier's solution with order
/// ≥ 1.9, on regular and on random meshes. Reason for the bound: 0.4 % at most on 24 × 24 cells.
#[test]
fn thick_supported_squares_converge_to_naviers_solution() {
    for h in [0.1, 0.2] {
        for (quadrilaterals, off) in [(false, 0.0), (false, 0.5), (true, 0.0), (true, 0.5)] {
            let errors = supported_errors(h, 5.0 / 6.0, quadrilaterals, off, [6, 12, 24]);
            let order = (errors[0] / errors[2]).log2() / 2.0;
            println!("h {h}, quadrilaterals {quadrilaterals}, random {off}: {errors:?} order {order:.2}");
            assert!(within(errors[2], 4.5e-3, Discretisation) && order >= 1.9, "{errors:?} {order}");
        }
    }
}

/// Goal: no locking at h/a = 1e-4, on regular and on random meshes of either shape: the errors are those of thicker plates, against
/// Kirchhoff's closed form, of which Mindlin's differs by 1e-7. Orders between the finer two meshes.
#[test]
fn no_locking_in_the_thin_limit() {
    let square =
        kirchhoff::ThinPlate { youngs_modulus: 210e9, poissons_ratio: 0.3, density: 7850.0, thickness: 1e-4 };
    let exact: Vec<f64> = wavenumbers(6).iter().map(|k| k * k * square.wave_constant() / TAU).collect();
    let mindlin = navier(5.0 / 5.7, 1e-4, 6);
    assert!(within(worst(&mindlin, &exact), 1e-6, Theory));
    for (quadrilaterals, off) in [(false, 0.0), (false, 0.5), (true, 0.0), (true, 0.5)] {
        let errors = [8, 16, 32].map(|n| {
            let shell = Shell { bending_only: true, ..thick(1e-4) };
            let assembled = assemble(&supported_square(n, shell, quadrilaterals, off)).unwrap();
            worst(&lowest_frequencies(&assembled.structure, exact.len(), 0.0), &exact)
        });
        let order = (errors[1] / errors[2]).log2();
        println!("quadrilaterals {quadrilaterals}, random {off}: {errors:?} order {order:.2}");
        assert!(within(errors[2], 3.5e-3, Discretisation) && order >= 1.8, "{errors:?} {order}");
    }
}

/// ω of the lowest antisymmetric Lamb wave of wavenumber k: three-dimensional elasticity, no plate theory.
fn lamb(h: f64, k: f64) -> f64 {
    let (e, nu, rho): (f64, f64, f64) = (210e9, 0.3, 7850.0);
    let long = (e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu) * rho)).sqrt();
    let shear = (e / (2.0 * (1.0 + nu) * rho)).sqrt();
    let f = |omega: f64| {
        let p = (k * k - (omega / long).powi(2)).sqrt();
        let q = (k * k - (omega / shear).powi(2)).sqrt();
        (q * q + k * k).powi(2) * (p * h / 2.0).tanh() - 4.0 * k * k * p * q * (q * h / 2.0).tanh()
    };
    let (mut low, mut high) = (1e-3 * shear * k, 0.9999 * shear * k);
    let sign = f(high) > 0.0;
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == sign { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// Goal: the elements, with the program's own κ, against exact elasticity of the supported thick square, whose modes are standing Lamb
/// waves (Srinivas, Joga Rao & Rao, J. Sound Vib. 12 (1970) 187: ωh√(ρ/G) = 0.0931 of the first mode at h/a = 0.1).
/// Reason for the bounds: the mesh errs by 0.1 %, Mindlin's theory by less than 0.1 % at kh = 0.44 and 0.4 % at kh = 2.
#[test]
fn thick_supported_squares_by_three_dimensional_elasticity() {
    let wave = (210e9 / 2.6 / 7850.0_f64).sqrt();
    let first = lamb(0.1, PI * 2.0_f64.sqrt()) * 0.1 / wave;
    assert!(within((first - 0.0931).abs(), 5e-5, Reference), "{first}");
    for h in [0.1, 0.2] {
        let exact: Vec<f64> = wavenumbers(6).iter().map(|k| lamb(h, *k) / TAU).collect();
        let theory = worst(&navier(5.0 / 5.7, h, 6), &exact);
        for quadrilaterals in [false, true] {
            let shell = Shell { bending_only: true, ..thick(h) };
            let assembled = assemble(&supported_square(32, shell, quadrilaterals, 0.0)).unwrap();
            let found = lowest_frequencies(&assembled.structure, 6, 0.0);
            let kirchhoff: Vec<f64> = {
                let thin = kirchhoff::ThinPlate {
                    youngs_modulus: 210e9,
                    poissons_ratio: 0.3,
                    density: 7850.0,
                    thickness: h,
                };
                wavenumbers(6).iter().map(|k| k * k * thin.wave_constant() / TAU).collect()
            };
            println!(
                "h {h}, quadrilaterals {quadrilaterals}: first {:.2e}, worst of six {:.2e}, of the theory {theory:.2e}, of Kirchhoff's {:.2}",
                found[0] / exact[0] - 1.0,
                worst(&found, &exact),
                worst(&kirchhoff, &exact)
            );
            assert!(within((found[0] / exact[0] - 1.0).abs(), 1.5e-3, Discretisation), "{found:?} {exact:?}");
            assert!(within(worst(&found, &exact), 6e-3, Discretisation), "{found:?} {exact:?}");
        }
    }
}

/// The edge of a circular plate.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Edge {
    Clamped,
    Free,
}

/// f, f′ and f″ at r of the function with ∇²(f cos nϑ) = −k² f cos nϑ that is finite in the middle: J_n or I_n, over |f|.
fn radial(n: u32, square: f64, r: f64) -> [f64; 3] {
    let (k, order) = (square.abs().sqrt(), f64::from(n));
    let x = k * r;
    let (f, next) = if square > 0.0 { (Jn(n, x), -Jn(n + 1, x)) } else { (In(n, x), In(n + 1, x)) };
    let slope = k * (order / x * f + next);
    let size = if square > 0.0 { 1.0 } else { f };
    [f, slope, -slope / r + (order * order / (r * r) - square) * f].map(|v| v / size)
}

/// Determinant of the edge conditions of Mindlin's circular plate of radius 1 with n nodal diameters at ω.
///
/// w = Σ A_i f(k_i r) cos nϑ of the two roots k² of the dispersion relation, β = Σ (σ_i − 1) ∇w_i + curl(H), σ = ρω²/(κG k²),
/// H = B f(k₃ r) sin nϑ with k₃² = (ρh³ω²/12 − κGh) 2/(D(1−ν)) (Mindlin & Deresiewicz, J. Appl. Phys. 25 (1954) 1329).
/// Clamped: w = β_r = β_ϑ = 0; free: M_r = M_rϑ = Q_r = 0.
fn edge_determinant(h: f64, kappa: f64, edge: Edge, n: u32, omega: f64) -> f64 {
    let m = steel();
    let (nu, g, order) = (m.poissons_ratio, kappa * m.shear_modulus(), f64::from(n));
    let d = m.youngs_modulus * h.powi(3) / (12.0 * (1.0 - nu * nu));
    let rotary = m.density * h.powi(3) / 12.0;
    let square = omega * omega;
    let b = square * (rotary + m.density * d / g);
    let c = square * (m.density / g * rotary * square - m.density * h);
    let root = (b * b - 4.0 * d * c).sqrt();
    let bending = [(b + root) / (2.0 * d), (b - root) / (2.0 * d)].map(|k2| {
        let s = m.density * square / (g * k2);
        let [f, f1, f2] = radial(n, k2, 1.0);
        match edge {
            Edge::Clamped => [f, (s - 1.0) * f1, -(s - 1.0) * order * f],
            Edge::Free => [
                (s - 1.0) * (f2 + nu * (f1 - order * order * f)),
                -(s - 1.0) * 2.0 * order * (f1 - f),
                s * f1,
            ],
        }
    });
    let [f, f1, f2] = radial(n, (rotary * square - g * h) * 2.0 / (d * (1.0 - nu)), 1.0);
    let twist = match edge {
        Edge::Clamped => [0.0, order * f, -f1],
        Edge::Free => [order * (f1 - f) * (1.0 - nu), -f2 - (order * order * f - f1), order * f],
    };
    let [p, q] = bending;
    if n == 0 {
        // No twist: the conditions on w and β_r, or on M_r and Q_r.
        let second = if edge == Edge::Clamped { 1 } else { 2 };
        return p[0] * q[second] - p[second] * q[0];
    }
    let minor = |i: usize, j: usize| q[i] * twist[j] - q[j] * twist[i];
    p[0] * minor(1, 2) - p[1] * minor(0, 2) + p[2] * minor(0, 1)
}

/// ω √(ρh/D) of the circular plate of radius 1 below `below`, double modes twice, ascending.
fn circular(h: f64, kappa: f64, edge: Edge, below: f64) -> Vec<f64> {
    let m = steel();
    let scale = (m.youngs_modulus * h * h / (12.0 * (1.0 - 0.09) * m.density)).sqrt();
    let mut all = Vec::new();
    for n in 0..8 {
        let f = |x: f64| edge_determinant(h, kappa, edge, n, x * scale);
        let (mut x, step) = (0.5, 0.05);
        while x < below {
            let (mut low, mut high) = (x, x + step);
            if f(low) * f(high) < 0.0 {
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if f(low) * f(middle) > 0.0 { low = middle } else { high = middle }
                }
                all.extend(vec![low; if n == 0 { 1 } else { 2 }]);
            }
            x += step;
        }
    }
    all.sort_by(f64::total_cmp);
    all
}

/// The closed form itself: published figures of Irie, Yamada & Takagi, J. Appl. Mech. 47 (1980) 652 (κ = π²/12), and Kirchhoff's plate as it
/// gets thin.
#[test]
fn the_closed_form_of_circular_plates() {
    let kappa = PI * PI / 12.0;
    for (edge, h, exact) in [
        (Edge::Clamped, 0.1, [9.941, 20.177, 20.177, 32.205]),
        (Edge::Clamped, 0.2, [9.240, 17.758, 17.758, 26.994]),
        (Edge::Free, 0.1, [5.278, 5.278, 8.868, 12.064]),
        (Edge::Free, 0.2, [5.114, 5.114, 8.505, 11.314]),
    ] {
        let found = circular(h, kappa, edge, 35.0);
        assert!(
            found.iter().zip(exact).all(|(f, e)| within((f - e).abs(), 6e-4, Reference)),
            "{h}: {found:?}"
        );
    }
    let thin =
        kirchhoff::ThinPlate { youngs_modulus: 210e9, poissons_ratio: 0.3, density: 7850.0, thickness: 0.01 };
    for (edge, of) in [(Edge::Clamped, kirchhoff::Edge::Clamped), (Edge::Free, kirchhoff::Edge::Free)] {
        let modes = kirchhoff::circular_modes(&thin, 1.0, of, None, 35.0 * thin.wave_constant() / TAU);
        let found = circular(0.01, kappa, edge, 34.9);
        let exact: Vec<f64> = modes
            .iter()
            .flat_map(|m| {
                vec![m.frequency_hz * TAU / thin.wave_constant(); if m.nodal_diameters == 0 { 1 } else { 2 }]
            })
            .collect();
        // Shear and rotary inertia take some (kh)² off, which is 0.35 % of these modes at most.
        assert!(within(worst(&found, &exact[..found.len()]), 4e-3, Theory), "{found:?} {exact:?}");
        assert!(found[0] < exact[0], "{found:?} {exact:?}");
    }
}

/// A disc of radius 1: a square grid of n × n cells mapped onto it, quadrilaterals or triangles.
fn disc(n: usize, quadrilaterals: bool) -> (Vec<[f64; 3]>, Vec<Cell>, Vec<usize>) {
    let at = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
    let id = |i: usize, j: usize| i * (n + 1) + j;
    let mut nodes = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            // Concentric squares become circles.
            let (x, y) = (at(i), at(j));
            let (size, norm) = (x.abs().max(y.abs()), x.hypot(y));
            let factor = if norm > 0.0 { size / norm * size + (1.0 - size) * 0.8 } else { 0.0 };
            nodes.push([factor * x, factor * y, 0.0]);
        }
    }
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let [p, q, r, s] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            // The diagonal towards the middle, so that no triangle lies flat along the rim.
            if quadrilaterals {
                faces.push(Cell::quadrilateral([p, q, r, s]));
            } else if (2 * i < n) == (2 * j < n) {
                faces.extend([Cell::triangle([p, q, r]), Cell::triangle([p, r, s])]);
            } else {
                faces.extend([Cell::triangle([p, q, s]), Cell::triangle([q, r, s])]);
            }
        }
    }
    let rim = (0..=n).flat_map(|k| [id(0, k), id(n, k), id(k, 0), id(k, n)]).collect();
    (nodes, faces, rim)
}

/// Goal: thick circular plates, clamped and free, converge to the closed form with order two. Reason for the bounds: the polygon lies inside
/// the circle, which adds an error of the order two; of triangles it takes the other's place, so that some of the errors change their sign.
/// Along a free edge is a layer of width h/√(12κ), half a cell of the coarser mesh at h = 0.1: there the order is 1.67 still.
#[test]
fn thick_circular_plates_converge_to_the_closed_form() {
    let kappa = PI * PI / 12.0;
    for (edge, h) in [(Edge::Clamped, 0.1), (Edge::Clamped, 0.2), (Edge::Free, 0.1), (Edge::Free, 0.2)] {
        let scale = h * (210e9_f64 / (12.0 * (1.0 - 0.09) * 7850.0)).sqrt() / TAU;
        let exact: Vec<f64> = circular(h, kappa, edge, 28.0).iter().map(|x| x * scale).collect();
        for quadrilaterals in [false, true] {
            let errors = [32, 64].map(|n| {
                let (nodes, faces, rim) = disc(n, quadrilaterals);
                let shell = Shell { shear_coefficient: Some(kappa), bending_only: true, ..thick(h) };
                let part = Part::new("plate", faces, shell);
                let mut model = Model { nodes, parts: vec![part], ..Model::default() };
                let (skip, shift) = match edge {
                    Edge::Clamped => (0, 0.0),
                    Edge::Free => (3, 0.3 * exact[0]),
                };
                if edge == Edge::Clamped {
                    model.supports.push(Support { nodes: rim, held: [true; 6] });
                }
                let assembled = assemble(&model).unwrap();
                let found = lowest_frequencies(&assembled.structure, skip + exact.len(), shift);
                worst(&found[skip..], &exact)
            });
            let order = (errors[0] / errors[1]).log2();
            println!(
                "{edge:?} {h}, quadrilaterals {quadrilaterals}: {} modes, {errors:?} order {order:.2}",
                exact.len()
            );
            let least = if edge == Edge::Clamped { 1.9 } else { 1.5 };
            assert!(within(errors[1], 2.5e-3, Discretisation), "{errors:?}");
            assert!(order >= least || within(errors[1], 1.5e-4, Discretisation), "{errors:?} {order}");
        }
    }
}

/// Goal: a membrane prestress stiffens bending by either theory alike: the strip with N along x, N k² on top of D k⁴.
#[test]
fn membrane_forces_raise_the_frequencies_as_they_should() {
    // A supported square under ε_x = ε_y (1 + ν makes N_x = N_y): ω² ρh = Dk⁴ + Nk² for a thin plate.
    let (h, strain) = (1e-3, 2e-5);
    let n = E_H * h * strain;
    let thin =
        kirchhoff::ThinPlate { youngs_modulus: 210e9, poissons_ratio: 0.3, density: 7850.0, thickness: h };
    for quadrilaterals in [false, true] {
        let model = supported_square(16, thick(h), quadrilaterals, 0.5);
        let assembled = assemble(&model).unwrap();
        let u: Vec<f64> = assembled
            .dofs
            .free_dofs()
            .iter()
            .map(|dof| {
                let [x, y, _] = model.nodes[dof.node];
                strain * (dof.direction[0] * x + dof.direction[1] * y)
            })
            .collect();
        use stridor::system::Prestress;
        let k_sigma = assembled.prestress(model.clone()).geometric_stiffness(&u).unwrap();
        // Rayleigh's quotient of the exact first mode: β = −∇w of a thin plate.
        let shape: Vec<f64> = assembled
            .dofs
            .free_dofs()
            .iter()
            .map(|dof| {
                let [x, y, _] = model.nodes[dof.node].map(|x| PI * x);
                let d = dof.direction;
                d[2] * x.sin() * y.sin() + PI * (d[3] * x.sin() * y.cos() - d[4] * x.cos() * y.sin())
            })
            .collect();
        let form = |a: &stridor::linalg::SparseMatrix| {
            let times = a * faer::ColRef::from_slice(&shape);
            shape.iter().enumerate().map(|(i, x)| x * times[i]).sum::<f64>()
        };
        // ∫ N |∇w|² dA = N 2π²/4.
        let exact = n * 2.0 * PI * PI / 4.0;
        assert!(within((form(&k_sigma) / exact - 1.0).abs(), 5e-3, Discretisation), "{exact}");
        let mass = form(&assembled.structure.mass) / (7850.0 * h * 0.25);
        assert!(within((mass - 1.0).abs(), 2e-3, Discretisation), "{mass}");
        let bending = form(&assembled.structure.stiffness) / (7850.0 * h * 0.25);
        let omega = 2.0 * PI * PI * thin.wave_constant();
        assert!(within((bending / (omega * omega) - 1.0).abs(), 2e-2, Discretisation), "{bending} {omega}");
    }
}

/// E/(1−ν): N = E h ε/(1−ν) of equal strains.
const E_H: f64 = 210e9 / 0.7;
