//! Plates, discs and bars against closed forms and published figures.

use crate::closed_forms::{cantilever_roots, free_disc_in_plane, simply_supported_rectangle};
use crate::common::*;
use stridor::bounds::{Origin::*, within};
use stridor::mesh::Cell;
use stridor::structure::*;
use stridor::validation::kirchhoff::{Edge, ThinPlate, circular_modes};

const DISC: ThinPlate =
    ThinPlate { youngs_modulus: 210e9, poissons_ratio: 0.3, density: 7850.0, thickness: 1e-3 };

/// A structured annulus in the plane x = 0 (a disc whose axis is x), `radial` × `angular` cells cut along alternating
/// diagonals; the nodes of circle i are i·angular … .
fn annulus(b: f64, a: f64, radial: usize, angular: usize) -> (Vec<[f64; 3]>, Vec<Cell>) {
    let mut nodes = Vec::new();
    for i in 0..=radial {
        // Equal ratios, so that the cells keep their shape.
        let r = b * (a / b).powf(i as f64 / radial as f64);
        for j in 0..angular {
            let phi = std::f64::consts::TAU * j as f64 / angular as f64;
            nodes.push([0.0, r * phi.cos(), r * phi.sin()]);
        }
    }
    let mut faces = Vec::new();
    for i in 0..radial {
        for j in 0..angular {
            let id = |i: usize, j: usize| i * angular + j % angular;
            let [p, q, r, s] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            if (i + j) % 2 == 0 {
                faces.extend([Cell::triangle([p, q, r]), Cell::triangle([p, r, s])]);
            } else {
                faces.extend([Cell::triangle([p, q, s]), Cell::triangle([q, r, s])]);
            }
        }
    }
    (nodes, faces)
}

/// A full disc: the annulus closed by triangles at a node in the middle.
fn full_disc(a: f64, radial: usize, angular: usize) -> (Vec<[f64; 3]>, Vec<Cell>) {
    let (mut nodes, mut faces) = annulus(a / radial as f64, a, radial - 1, angular);
    for (k, node) in nodes.iter_mut().enumerate() {
        let r = a * (k / angular + 1) as f64 / radial as f64;
        let now = node[1].hypot(node[2]);
        *node = [0.0, node[1] * r / now, node[2] * r / now];
    }
    let middle = nodes.len();
    nodes.push([0.0; 3]);
    faces.extend((0..angular).map(|j| Cell::triangle([middle, j, (j + 1) % angular])));
    (nodes, faces)
}

/// A rectangle in the plane z = 0, n × m cells; quadrilaterals or triangles.
fn rectangle(a: f64, b: f64, n: usize, m: usize, quadrilaterals: bool) -> (Vec<[f64; 3]>, Vec<Cell>) {
    let id = |i: usize, j: usize| i * (m + 1) + j;
    let nodes = (0..=n)
        .flat_map(|i| (0..=m).map(move |j| [a * i as f64 / n as f64, b * j as f64 / m as f64, 0.0]))
        .collect();
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let [p, q, r, s] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            if quadrilaterals {
                faces.push(Cell::quadrilateral([p, q, r, s]));
            } else if (i + j) % 2 == 0 {
                faces.extend([Cell::triangle([p, q, r]), Cell::triangle([p, r, s])]);
            } else {
                faces.extend([Cell::triangle([p, q, s]), Cell::triangle([q, r, s])]);
            }
        }
    }
    (nodes, faces)
}

fn plate(thin: &ThinPlate, faces: Vec<Cell>, bending_only: bool) -> Part {
    let material = Material {
        youngs_modulus: thin.youngs_modulus,
        poissons_ratio: thin.poissons_ratio,
        density: thin.density,
        ..steel()
    };
    Part::new(
        "plate",
        faces,
        Shell { bending_only, rotary_inertia: false, ..Shell::new(material, thin.thickness) },
    )
}

fn clamped_annulus(ratio: f64, radial: usize, angular: usize, bending_only: bool) -> Model {
    let (nodes, faces) = annulus(ratio * 0.075, 0.075, radial, angular);
    Model {
        nodes,
        parts: vec![plate(&DISC, faces, bending_only)],
        supports: vec![Support { nodes: (0..angular).collect(), held: [true; 6] }],
        ..Model::default()
    }
}

/// Frequencies of the theory with the double modes twice.
fn doubled(modes: &[stridor::validation::kirchhoff::PlateMode]) -> Vec<f64> {
    modes.iter().flat_map(|m| vec![m.frequency_hz; if m.nodal_diameters == 0 { 1 } else { 2 }]).collect()
}

/// Goal: every mode below 3 kHz of the clamped annulus within 0.2 % of Kirchhoff's theory, at no more than 20,000 dof.
/// Reason for the tolerance: DKT errs by O(h²), some 1e-3 here.
#[test]
fn annular_plate_clamped_inside() {
    for (ratio, radial, angular) in [(0.2, 34, 128), (0.3, 28, 144)] {
        let assembled = assemble(&clamped_annulus(ratio, radial, angular, true)).unwrap();
        assert!(assembled.dofs.n_dofs() <= 20_000);
        let inner = Some((ratio * 0.075, Edge::Clamped));
        let exact = doubled(&circular_modes(&DISC, 0.075, Edge::Free, inner, 3000.0));
        let found = lowest_frequencies(&assembled.structure, exact.len() + 1, 0.0);
        let worst = exact.iter().zip(&found).map(|(e, f)| (f / e - 1.0).abs()).fold(0.0, f64::max);
        println!("b/a {ratio}: {} modes, {} dof, worst {worst:.1e}", exact.len(), assembled.dofs.n_dofs());
        assert!(within(worst, 2e-3, Discretisation), "{worst}: {found:?} {exact:?}");
        assert!(found[exact.len()] > 3000.0 * (1.0 - 2e-3));
    }
}

/// Goal: errors fall like h² (order ≥ 1.9) as the mesh is refined, for every mode below 1.6 kHz.
#[test]
fn annular_plate_converges_with_order_two() {
    let inner = Some((0.2 * 0.075, Edge::Clamped));
    let exact = doubled(&circular_modes(&DISC, 0.075, Edge::Free, inner, 1600.0));
    let errors = [1, 2, 4].map(|k| {
        let assembled = assemble(&clamped_annulus(0.2, 8 * k, 32 * k, true)).unwrap();
        let found = lowest_frequencies(&assembled.structure, exact.len(), 0.0);
        let sum: f64 = exact.iter().zip(found).map(|(e, f)| (f / e - 1.0).powi(2)).sum();
        (sum / exact.len() as f64).sqrt()
    });
    let orders = [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
    println!("errors {errors:?} orders {orders:?}");
    assert!(orders[1] >= 1.9, "{errors:?} {orders:?}");
}

/// The same annulus with its inner nodes moved by up to a quarter of a cell in radius and angle, and each cell cut along
/// either diagonal by chance.
fn random_annulus(ratio: f64, radial: usize, angular: usize, seed: u64) -> Model {
    let mut seed = seed;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut model = clamped_annulus(ratio, radial, angular, true);
    for [_, y, z] in &mut model.nodes[angular..radial * angular] {
        let stretch = ratio.powf(0.5 * random() / radial as f64);
        let (sin, cos) = (0.5 * std::f64::consts::TAU * random() / angular as f64).sin_cos();
        [*y, *z] = [stretch * (cos * *y - sin * *z), stretch * (sin * *y + cos * *z)];
    }
    for pair in model.parts[0].cells.chunks_mut(2) {
        // [p, q, r] and [p, r, s], or [p, q, s] and [q, r, s].
        let (first, second) = (pair[0].nodes(), pair[1].nodes());
        let [p, q] = [first[0], first[1]];
        let [r, s] = [second[1], second[2]];
        let cut = |diagonal| match diagonal {
            true => [[p, q, r], [p, r, s]],
            false => [[p, q, s], [q, r, s]],
        };
        pair.clone_from_slice(&cut(random() < 0.0).map(Cell::triangle));
    }
    model
}

/// Goal: on random meshes, too, errors fall like h² (order ≥ 1.9), for the worst mode below 1.6 kHz. Reason for the bounds: three
/// meshes of each size err by 1.0 to 1.1 %, 0.24 to 0.27 % and 0.060 to 0.063 %.
#[test]
fn annular_plate_on_random_meshes() {
    let inner = Some((0.2 * 0.075, Edge::Clamped));
    let exact = doubled(&circular_modes(&DISC, 0.075, Edge::Free, inner, 1600.0));
    for seed in 1..4 {
        let errors = [1, 2, 4].map(|k| {
            let assembled = assemble(&random_annulus(0.2, 8 * k, 32 * k, seed)).unwrap();
            let found = lowest_frequencies(&assembled.structure, exact.len(), 0.0);
            exact.iter().zip(&found).map(|(e, f)| (f / e - 1.0).abs()).fold(0.0, f64::max)
        });
        let order = (errors[0] / errors[2]).log2() / 2.0;
        println!("seed {seed}: worst {errors:?}, order {order:.2}");
        assert!(
            errors.iter().zip([1.2e-2, 3e-3, 7.5e-4]).all(|(error, bound)| within(
                *error,
                bound,
                Discretisation
            )),
            "{errors:?}"
        );
        assert!(order >= 1.9, "{errors:?} {order}");
    }
}

/// Goal: the full shell (six degrees of freedom a node) and the bending-only one have the same bending modes, also tilted.
#[test]
fn bending_only_is_the_same_plate_in_any_plane() {
    let full = assemble(&clamped_annulus(0.3, 8, 40, false)).unwrap();
    let mut tilted = clamped_annulus(0.3, 8, 40, true);
    let (c, s) = (0.1_f64.cos(), 0.1_f64.sin());
    tilted.nodes.iter_mut().for_each(|p| *p = [c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]]);
    let bending = assemble(&tilted).unwrap();
    // Three of six; the clamped edge of 40 nodes may turn about the normal of the membrane.
    assert_eq!(full.dofs.n_dofs(), 2 * bending.dofs.n_dofs() + 40);
    let (a, b) =
        (lowest_frequencies(&full.structure, 12, 0.0), lowest_frequencies(&bending.structure, 12, 0.0));
    assert!(a.iter().zip(&b).all(|(x, y)| within((x / y - 1.0).abs(), 1e-8, Tolerance)), "{a:?} {b:?}");
}

#[test]
fn free_circular_plate() {
    let (nodes, faces) = full_disc(0.075, 24, 96);
    let model = Model { nodes, parts: vec![plate(&DISC, faces, false)], ..Model::default() };
    let assembled = assemble(&model).unwrap();
    let exact = doubled(&circular_modes(&DISC, 0.075, Edge::Free, None, 2500.0));
    let found = lowest_frequencies(&assembled.structure, exact.len() + 6, 100.0);
    assert!(within(found[5], 1e-3 * found[6], RoundOff), "{found:?}");
    for (e, f) in exact.iter().zip(&found[6..]) {
        assert!(within((f / e - 1.0).abs(), 3e-3, Discretisation), "{found:?} {exact:?}");
    }
}

/// In its plane, n = 0 … 3 of a free disc; a thin one, so that bending modes are far below and shifted away from.
#[test]
fn in_plane_modes_of_a_free_disc() {
    let (nodes, faces) = full_disc(0.075, 16, 64);
    let mut model = Model { nodes, parts: vec![plate(&DISC, faces, false)], ..Model::default() };
    // Held out of its plane everywhere: only the membrane is left.
    model.supports.push(Support {
        nodes: (0..model.nodes.len()).collect(),
        held: [true, false, false, false, true, true],
    });
    let assembled = assemble(&model).unwrap();
    let mut exact: Vec<f64> = (0..4)
        .flat_map(|n| {
            let family = free_disc_in_plane(&DISC, 0.075, n, 32_000.0);
            family.into_iter().flat_map(move |f| vec![f; if n == 0 { 1 } else { 2 }])
        })
        .collect();
    exact.sort_by(f64::total_cmp);
    let found = lowest_frequencies(&assembled.structure, exact.len() + 3, 5000.0);
    println!("{exact:?}\n{found:?}");
    assert!(found[2] < 1.0);
    for (e, f) in exact.iter().zip(&found[3..]) {
        assert!(within((f / e - 1.0).abs(), 5e-3, Discretisation), "{found:?} {exact:?}");
    }
}

/// Square plates, ω a² √(ρh/D): SSSS in closed form; CCCC and FFFF (ν = 0.3) from Leissa, J. Sound Vib. 31 (1973) 257.
/// His Ritz figures are upper bounds, some 0.1 % high for FFFF.
#[test]
fn square_plates() {
    let square = ThinPlate { thickness: 2e-3, ..DISC };
    let n = 24;
    let edge = |i: usize| i == 0 || i == n;
    let rim: Vec<usize> = (0..(n + 1) * (n + 1)).filter(|k| edge(k / (n + 1)) || edge(k % (n + 1))).collect();
    let scale = square.wave_constant() / (0.3 * 0.3) / std::f64::consts::TAU;
    let simply: Vec<f64> =
        simply_supported_rectangle(&square, 0.3, 0.3, 1000.0).iter().map(|m| m.0 / scale).collect();
    for (name, held, exact, skip, shift) in [
        ("SSSS", Some([true, true, true, false, false, true]), &simply[..6], 0, 0.0),
        ("CCCC", Some([true; 6]), &[35.985, 73.394, 73.394, 108.22, 131.58, 132.20][..], 0, 0.0),
        ("FFFF", None, &[13.468, 19.596, 24.270, 34.801, 34.801, 61.093][..], 6, 50.0),
    ] {
        for quadrilaterals in [false, true] {
            let (nodes, faces) = rectangle(0.3, 0.3, n, n, quadrilaterals);
            let mut model = Model { nodes, parts: vec![plate(&square, faces, false)], ..Model::default() };
            model.supports.extend(held.map(|held| Support { nodes: rim.clone(), held }));
            let assembled = assemble(&model).unwrap();
            let found = lowest_frequencies(&assembled.structure, skip + 6, shift);
            let errors: Vec<f64> =
                exact.iter().zip(&found[skip..]).map(|(e, f)| f / scale / e - 1.0).collect();
            println!("{name} {quadrilaterals}: {errors:?}");
            assert!(
                errors.iter().all(|e| within(e.abs(), 6e-3, Discretisation)),
                "{name} {quadrilaterals}: {errors:?}"
            );
        }
    }
}

/// NAFEMS FV12 (free) and FV16 (cantilever): 10 × 10 × 0.05 m, E = 200 GPa, ν = 0.3, ρ = 8000. The benchmark's
/// figures are themselves of finite elements: its 4.233 and 7.416 Hz lie 1 % above the 4.191 and 7.356 Hz of Leissa's
/// 34.801 and 61.093, hence the tolerance.
#[test]
fn nafems_thin_plates() {
    let thin = ThinPlate { youngs_modulus: 200e9, poissons_ratio: 0.3, density: 8000.0, thickness: 0.05 };
    let n = 24;
    let free = [1.622, 2.360, 2.922, 4.233, 4.233, 7.416, 7.416];
    let cantilever = [0.421, 1.029, 2.582, 3.306, 3.753, 6.555];
    for (supports, exact, skip, shift) in [
        (vec![], &free[..], 6, 0.5),
        (vec![Support { nodes: (0..=n).collect(), held: [true; 6] }], &cantilever[..], 0, 0.0),
    ] {
        let (nodes, faces) = rectangle(10.0, 10.0, n, n, false);
        let model = Model { nodes, parts: vec![plate(&thin, faces, false)], supports, ..Model::default() };
        let found = lowest_frequencies(&assemble(&model).unwrap().structure, skip + exact.len(), shift);
        let errors: Vec<f64> = exact.iter().zip(&found[skip..]).map(|(e, f)| f / e - 1.0).collect();
        println!("{errors:?}");
        assert!(errors.iter().all(|e| within(e.abs(), 0.01, Reference)), "{errors:?} {found:?}");
    }
}

#[test]
fn cantilever_bar_bends_stretches_and_twists() {
    let n = 20;
    let l = 0.3;
    let section = Section { area: 1e-4, inertia_1: 5e-10, inertia_2: 2e-9, torsion: 1e-9 };
    let along = [2.0_f64 / 3.0, 1.0 / 3.0, 2.0 / 3.0];
    let model = Model {
        nodes: (0..=n).map(|k| along.map(|d| d * l * k as f64 / n as f64)).collect(),
        parts: vec![Part::new(
            "bar",
            (0..n).map(|k| Cell::line([k, k + 1])).collect(),
            Bar { material: steel(), section, orientation: [0.0, 0.0, 1.0] },
        )],
        supports: vec![Support { nodes: vec![0], held: [true; 6] }],
        ..Model::default()
    };
    let assembled = assemble(&model).unwrap();
    assert!(within((assembled.total_mass / (7850.0 * 1e-4 * l) - 1.0).abs(), 1e-12, RoundOff));
    let tau = std::f64::consts::TAU;
    let (e, rho) = (210e9_f64, 7850.0_f64);
    let mut exact: Vec<f64> = [section.inertia_1, section.inertia_2]
        .iter()
        .flat_map(|i| {
            cantilever_roots(4)
                .into_iter()
                .map(move |x| x * x * (e * i / (rho * 1e-4)).sqrt() / (l * l) / tau)
        })
        .collect();
    exact.push((e / rho).sqrt() / (4.0 * l));
    exact.push((e / 2.6 * section.torsion / (rho * 2.5e-9)).sqrt() / (4.0 * l));
    exact.sort_by(f64::total_cmp);
    exact.truncate(7);
    let found = lowest_frequencies(&assembled.structure, 7, 0.0);
    assert!(
        exact.iter().zip(&found).all(|(x, f)| within((f / x - 1.0).abs(), 5e-4, Discretisation)),
        "{exact:?} {found:?}"
    );
}

/// A square plate simply supported all round buckles at k = 4: N = 4 π² D / b² (Timoshenko & Gere).
#[test]
fn square_plate_buckles_at_four() {
    let n = 16;
    let (nodes, faces) = rectangle(1.0, 1.0, n, n, false);
    let thin = ThinPlate { thickness: 5e-3, ..DISC };
    let edge = |i: usize| i == 0 || i == n;
    let rim = (0..(n + 1) * (n + 1)).filter(|k| edge(k / (n + 1)) || edge(k % (n + 1))).collect();
    let hold = |nodes: Vec<usize>, k: usize| Support { nodes, held: std::array::from_fn(|i| i == k) };
    let model = Model {
        nodes,
        parts: vec![plate(&thin, faces, false)],
        // The loaded edges are free to widen along themselves.
        supports: vec![hold(rim, 2), hold((0..=n).collect(), 0), hold(vec![0], 1)],
        ..Model::default()
    };
    let assembled = assemble(&model).unwrap();
    // 1 N/m of compression on the edge x = 1, shared by its nodes.
    let mut load = vec![0.0; assembled.dofs.n_dofs()];
    for j in 0..=n {
        let share = if edge(j) { 0.5 } else { 1.0 } / n as f64;
        assembled.dofs.reduce(&[(n * (n + 1) + j, 0, -share)]).add_to(1.0, &mut load);
    }
    let u = solve(&assembled.structure.stiffness, &load);
    let prestress = assembled.prestress(model.clone());
    let k_sigma = stridor::system::Prestress::geometric_stiffness(&prestress, &u).unwrap();
    let critical = smallest_buckling_load(&assembled.structure.stiffness, &k_sigma);
    let rigidity = 210e9 * thin.thickness.powi(3) / (12.0 * 0.91);
    let k = critical / (std::f64::consts::PI.powi(2) * rigidity);
    assert!(within((k - 4.0).abs(), 0.02, Discretisation), "{k}");
}

/// A plate that starts along a real mode stays along it, and its amplitude follows the scheme's recursion: from the
/// balance α-weighted between two steps, (1−α_m) a₁ + α_m a₀ + ω²((1−α_f) u₁ + α_f u₀) = 0 (J. Chung & G. M. Hulbert,
/// J. Appl. Mech. 60 (1993) 371), whose error falls with the square of the step.
#[test]
fn a_plate_vibrates_in_time_as_its_modes_say() {
    use stridor::equilibrium::{SteadyOptions, solve_steady};
    use stridor::linalg::c64;
    use stridor::transient::{Plan, Scheme, State, StepMethod, TransientModel, march};
    let case = stridor::case::Case::parse("disc", &samples::disc(4, 16), ".".into()).expect("a case");
    let prepared = stridor::job::Prepared::new(&case).expect("a model");
    let system = &prepared.system;
    let (real, _) = stridor::modal::compute(&system.structure, stridor::modal::ModesWanted::Count(6), &())
        .expect("modes");
    let steady = solve_steady(system, &SteadyOptions::default(), &()).expect("nothing loads it");
    let model = TransientModel::new(system, &steady).expect("a model");
    for mode in [0, 2, 5] {
        let (shape, omega) = (real.shapes.col_as_slice(mode), real.eigenvalues[mode].sqrt());
        let along: Vec<c64> = shape.iter().map(|x| c64::new(*x, 0.0)).collect();
        for scheme in [Scheme::TRAPEZOIDAL, Scheme::hht(-0.1)] {
            let errors = [64, 128].map(|steps| {
                let step = 1.25 * std::f64::consts::TAU / (omega * steps as f64);
                let start =
                    State::steady(&model, &steady).disturbed(&model, c64::new(0.0, omega), &along, 1e-6);
                let plan = Plan { scheme, step, steps, method: StepMethod::Condensed, tolerance: None };
                let end = march(&model, start, &plan, &(), &mut |_| Ok(())).expect("a march");
                let u = end.state.motion.col_as_slice(0);
                let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
                let amplitude = dot(u, shape) / dot(shape, shape);
                let aside = u.iter().zip(shape).map(|(u, x)| (u - amplitude * x).abs()).fold(0.0, f64::max);
                let largest = 1e-6 * shape.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                assert!(
                    within(aside, 1e-7 * largest, Tolerance),
                    "mode {mode}: {aside:e} beside {largest:e}"
                );
                // The same for one degree of freedom: [u, v, a] in units of the step.
                let w = (omega * step).powi(2);
                let Scheme { alpha_m, alpha_f, beta, gamma } = scheme;
                let (mut x, mut v, mut a) = (1e-6, 0.0, -1e-6 * w);
                for _ in 0..steps {
                    let (xp, vp) = (x + v + (0.5 - beta) * a, v + (1.0 - gamma) * a);
                    let next = -(alpha_m * a + w * ((1.0 - alpha_f) * xp + alpha_f * x))
                        / (1.0 - alpha_m + w * (1.0 - alpha_f) * beta);
                    (x, v, a) = (xp + beta * next, vp + gamma * next, next);
                }
                assert!(within((amplitude - x).abs(), 1e-13, Tolerance), "mode {mode}: {amplitude:e} {x:e}");
                // cos(2.5 π) = 0.
                amplitude.abs()
            });
            let order = (errors[0] / errors[1]).log2();
            assert!(within((order - 2.0).abs(), 0.1, Discretisation), "mode {mode}, {scheme:?}: {order}");
        }
    }
}
