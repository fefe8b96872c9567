//! Bodies that rotate steadily, seen from outside, against closed forms: the tilt of a free body, the waves of a ring and of a disc.

use crate::common::*;
use std::f64::consts::TAU;
use stridor::bounds::{Origin::*, within};
use stridor::case::Case;
use stridor::equilibrium::{SteadyOptions, solve_steady};
use stridor::job::{Prepared, Selection, analyse};
use stridor::linalg::c64;
use stridor::linalg::sparse::multiply_vector;
use stridor::mesh::generate::structured_ring;
use stridor::mesh::{Cell, CellKind};
use stridor::modal::{ModesWanted, compute};
use stridor::results::{ComplexResult, SensitivityResult, SweepResult, TransientResult};
use stridor::stability::{ComplexMode, complex_modes};
use stridor::structure::*;
use stridor::system::System;

/// A free ring about the z axis, which turns at `speed` with all terms.
fn ring(
    solid: Solid,
    kind: CellKind,
    [radii, through]: [[f64; 2]; 2],
    cells: [usize; 3],
    speed: f64,
) -> Model {
    let mesh = structured_ring(kind, radii, through[1] - through[0], cells).unwrap();
    let own = |cell: &&Cell| cell.dimension() == 3;
    let part = Part::new("disc", mesh.elements.iter().filter(own).cloned().collect(), solid);
    let nodes = mesh.nodes.iter().map(|[x, y, z]| [*x, *y, z + through[0]]).collect();
    let axis = RotationAxis { point: [0.0; 3], direction: [0.0, 0.0, 1.0] };
    Model { nodes, parts: vec![part], rotations: vec![turning(axis, speed)], ..Model::default() }
}

/// Part `disc` that turns, with all that this brings.
fn turning(axis: RotationAxis, speed: f64) -> Rotation {
    Rotation {
        parts: vec!["disc".into()],
        axis,
        speed,
        gyroscopic: true,
        transport: true,
        spin_stiffness: true,
    }
}

/// The system of a model without contacts.
fn system(model: &Model) -> System {
    let (structure, coupling) = assemble(model).unwrap().rotating(model).unwrap();
    System { coupling, ..System::new(structure, Vec::new()) }
}

/// The complex modes in a band \[Hz\].
fn modes(system: &System, band: [f64; 2]) -> Vec<ComplexMode> {
    let steady = solve_steady(system, &SteadyOptions::default(), &()).unwrap();
    let (real, _) = compute(&system.structure, ModesWanted::BelowHz(2.0 * band[1]), &()).unwrap();
    let found = complex_modes(system, &steady, &real, band, &()).unwrap().modes;
    let worst = found.iter().map(|mode| mode.eigenvalue_error).fold(0.0, f64::max);
    // Rounding of a stiffness of thin cells.
    assert!(within(worst, 1e-6, RoundOff), "{worst:.1e}");
    found
}

/// xᵀ A y; the product with a matrix takes it for its transpose.
fn form(a: &stridor::linalg::SparseMatrix, x: &[f64], y: &[f64]) -> f64 {
    y.iter().zip(multiply_vector(a, x)).map(|(y, f)| y * f).sum()
}

/// The moments of the terms of a free body's rotation in rigid tilts and turns, as parts of those of G and of Ω² I_p; its polar inertia.
fn rigid_terms(model: &Model, name: &str) -> f64 {
    let speed = model.rotations[0].speed;
    let assembled = assemble(model).unwrap();
    let System { structure, coupling, .. } = system(model);
    let gyroscopic = coupling.unwrap().skew.unwrap().damping;
    let [.., x, y, turn] = assembled.dofs.rigid_body_vectors([0.0; 3]);
    let polar = form(&structure.mass, &turn, &turn);
    let moment = form(&gyroscopic, &x, &y);
    assert!(within((moment / (speed * polar) - 1.0).abs(), 1e-10, RoundOff), "{name}: {moment}");
    for [a, b] in [[&x, &x], [&x, &turn], [&turn, &turn]] {
        assert!(within(form(&gyroscopic, a, b).abs(), 1e-10 * moment, RoundOff), "{name}");
    }
    for [a, b] in [[&x, &x], [&x, &y], [&y, &y], [&turn, &turn]] {
        let held = form(&structure.stiffness, a, b).abs() / (speed * speed * polar);
        assert!(within(held, 1e-7, RoundOff), "{name}: {held:.1e}");
    }
    polar
}

/// Goal: a free body that turns about its axis tilts as Euler's equations say, I_d φ̈_x + I_p Ω φ̇_y = 0: nothing holds the tilt, or the turn, as
/// transport and centrifugal stress cancel, whatever the kind of cell.
#[test]
fn a_free_body_tilts_by_eulers_equations() {
    let (inner, outer, height, speed) = (0.02, 0.05, 0.03, 3e3);
    for kind in CellKind::all().filter(|kind| kind.dimension() == 3) {
        for integration in [Integration::Full, Integration::Reduced] {
            let solid = Solid { material: steel(), integration };
            let model = ring(solid, kind, [[inner, outer], [-0.5 * height, 0.5 * height]], [2, 24, 2], speed);
            let polar = rigid_terms(&model, &format!("{kind:?} {integration:?}"));
            let round = assemble(&model).unwrap().total_mass * (inner * inner + outer * outer) / 2.0;
            let off = (polar / round - 1.0).abs();
            let bound = if kind.is_first_order() { 0.03 } else { 3e-3 };
            assert!(within(off, bound, Discretisation), "{kind:?}: {off:.1e}");
        }
    }
    for theory in [PlateTheory::Kirchhoff, PlateTheory::Mindlin] {
        for triangles in [true, false] {
            let axis = RotationAxis { point: [0.0; 3], direction: [0.0, 0.0, 1.0] };
            let (around, rings) = (24, 3);
            let at = |ring: usize, k: usize| {
                let (r, angle) =
                    (inner + (outer - inner) * ring as f64 / rings as f64, TAU * k as f64 / around as f64);
                [r * angle.cos(), r * angle.sin(), 0.0]
            };
            let number = |ring: usize, k: usize| ring * around + k % around;
            let quadrilaterals = (0..rings).flat_map(|ring| (0..around).map(move |k| (ring, k)));
            let cells = quadrilaterals.flat_map(|(ring, k)| {
                let [a, b, c, d] =
                    [number(ring, k), number(ring + 1, k), number(ring + 1, k + 1), number(ring, k + 1)];
                match triangles {
                    true => vec![Cell::triangle([a, b, c]), Cell::triangle([a, c, d])],
                    false => vec![Cell::quadrilateral([a, b, c, d])],
                }
            });
            let shell = Shell { theory, ..Shell::new(steel(), 0.004) };
            let model = Model {
                nodes: (0..=rings).flat_map(|ring| (0..around).map(move |k| at(ring, k))).collect(),
                parts: vec![Part::new("disc", cells.collect(), shell)],
                rotations: vec![turning(axis, speed)],
                ..Model::default()
            };
            rigid_terms(&model, &format!("{theory:?} {triangles}"));
        }
    }
}

/// Goal: a thin ring whose waves do not stretch it has, seen from outside, ω₊ − ω₋ = 2nΩ(n² − 1)/(n² + 1) and ω₊ω₋ = ω_n²
/// (G. H. Bryan, Proc. Camb. Phil. Soc. 7 (1890) 101; with the stress of the spin G. F. Carrier, Q. Appl. Math. 3 (1945) 235).
#[test]
fn double_modes_of_a_ring_split_as_bryan_says() {
    let (radius, thickness, speed) = (0.1, 1e-3, 50.0);
    let (inner, outer) = (radius - 0.5 * thickness, radius + 0.5 * thickness);
    let model = |speed: f64| {
        let mut model = ring(
            Solid::new(steel()),
            CellKind::Hexahedron20,
            [[inner, outer], [0.0, thickness]],
            [1, 48, 1],
            speed,
        );
        let nodes = (0..model.nodes.len()).collect();
        model.supports = vec![Support { nodes, held: [false, false, true, false, false, false] }];
        model
    };
    let at_rest: Vec<f64> =
        lowest_frequencies(&assemble(&model(0.0)).unwrap().structure, 9, 20.0)[3..].to_vec();
    let found = modes(&system(&model(speed)), [5.0, 500.0]);
    // Without the rigid motions.
    let rates: Vec<f64> = found.iter().map(|mode| mode.eigenvalue.im).filter(|rate| *rate > 10.0).collect();
    assert_eq!(rates.len(), 6, "{rates:?}");
    for (k, n) in [2.0f64, 3.0, 4.0].into_iter().enumerate() {
        let [slow, fast] = [rates[2 * k], rates[2 * k + 1]];
        let split = 2.0 * n * speed * (n * n - 1.0) / (n * n + 1.0);
        let squared = (TAU * at_rest[2 * k]).powi(2);
        assert!(within(((fast - slow) / split - 1.0).abs(), 1e-3, Theory), "{n}: {slow} {fast} {split}");
        assert!(within((slow * fast / squared - 1.0).abs(), 1e-3, Theory), "{n}: {slow} {fast} {squared}");
    }
}

/// Goal: a thin disc that the spin alone stiffens has waves w = rⁿ cos nθ at ω_r² = Ω² (n(n + 2)(3 + ν) − n²(1 + 3ν))/8 for one who turns with it
/// (H. Lamb & R. V. Southwell, Proc. R. Soc. A 99 (1921) 272), with the bending beside it, between the least and that of this w
/// (R. V. Southwell, Proc. R. Soc. A 101 (1922) 133); seen from outside ω_r ± nΩ. A solid, and plates of both theories.
#[test]
fn waves_of_a_spinning_disc_are_those_of_lamb_and_southwell() {
    let (radius, thickness, speed, nu) = (0.1f64, 1e-3f64, 5e3f64, 0.3f64);
    let solid = Solid { material: steel(), integration: Integration::Reduced };
    let radii = [0.02 * radius, radius];
    let heights = [-0.5 * thickness, 0.5 * thickness];
    let solid = system(&ring(solid, CellKind::Hexahedron20, [radii, heights], [6, 24, 1], speed));
    let plates = ["kirchhoff", "mindlin"].map(|theory| {
        let free = plate(theory, "speed = 5000", "")
            .replace("\"20 mm\"", "0")
            .replace("[support.hub]\non = \"hub\"", "");
        Prepared::new(&parsed(&free)).unwrap().system
    });
    let bending = 210e9 / 7850.0 * thickness.powi(2) / (12.0 * (1.0 - nu * nu)) / radius.powi(4);
    for system in std::iter::once(&solid).chain(&plates) {
        let rates: Vec<f64> = modes(system, [300.0, 6000.0]).iter().map(|mode| mode.eigenvalue.im).collect();
        // λ² of a free plate, and the quotient of Rayleigh for rⁿ: 4n²(n² − 1)(1 − ν).
        for (n, least) in [(2.0f64, 5.3583f64.powi(2)), (3.0, 12.4390f64.powi(2))] {
            let spin = speed * speed * (n * (n + 2.0) * (3.0 + nu) - n * n * (1.0 + 3.0 * nu)) / 8.0;
            let most = 4.0 * n * n * (n * n - 1.0) * (1.0 - nu);
            let [low, high] = [least, most].map(|factor| (spin + factor * bending).sqrt());
            for sign in [-1.0, 1.0] {
                let [low, high] = [low, high].map(|rate| (rate + sign * n * speed).abs());
                let (middle, width) = (0.5 * (low + high), 0.5 * (high - low).abs());
                let near = rates.iter().map(|rate| (rate - middle).abs()).fold(f64::INFINITY, f64::min);
                assert!(
                    within(near, width + 2e-3 * speed, Discretisation),
                    "{n} {sign}: {low} {high} {rates:?}"
                );
            }
        }
    }
}

/// The text of the case of a plate that turns.
fn plate(theory: &str, of_rotation: &str, rest: &str) -> String {
    format!(
        r#"
[mesh.annulus]
outer_radius = "100 mm"
hub_radius = "20 mm"
radial = 8
around = 48
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"
[shell.disc]
material = "steel"
thickness = "1 mm"
theory = "{theory}"
[support.hub]
on = "hub"
[rotation.disc]
parts = "disc"
axis = [1, 0, 0]
{of_rotation}
[cea]
band = ["20 Hz", "400 Hz"]
{rest}
"#
    )
}

fn parsed(text: &str) -> Case {
    Case::parse("disc", text, ".".into()).unwrap()
}

/// Complex eigenvalues of a case.
fn eigenvalues(case: &Case) -> Vec<c64> {
    let prepared = Prepared::new(case).unwrap();
    let run = analyse(&prepared, Selection::Only("cea"), &mut |_| Ok(()), &()).unwrap();
    run.get::<ComplexResult>().unwrap().modes.modes.iter().map(|m| m.eigenvalue).collect()
}

/// Goal: without stress the double modes of a thin disc, by either theory, are at ω_n ± nΩ, to a thousandth of the split.
#[test]
fn plates_split_by_nodal_diameters() {
    for theory in ["kirchhoff", "mindlin"] {
        let turning = parsed(&plate(theory, "speed = \"900 rpm\"\nspin_stiffness = false", ""));
        let hz = |case: &Case| eigenvalues(case).iter().map(|z| z.im / TAU).collect::<Vec<_>>();
        let (at_rest, found) =
            (hz(&turning.with_parameter("rotation.disc.speed", 0.0).unwrap()), hz(&turning));
        // Of rising frequency: 1, 1, 0, 2, 2, 3, 3 nodal diameters.
        assert_eq!((at_rest.len(), found.len()), (7, 7), "{at_rest:?} {found:?}");
        for (k, n) in [(0, 1.0), (3, 2.0), (5, 3.0)] {
            for sign in [-1.0, 1.0] {
                let expected = at_rest[k] + sign * n * 15.0;
                let near = found.iter().map(|hz| (hz - expected).abs()).fold(f64::INFINITY, f64::min);
                assert!(within(near, 1e-3 * n * 15.0, Theory), "{theory} {n}: {near} Hz of {expected} Hz");
            }
        }
    }
}

/// Goal: without stress the stiffness of the fixed frame is singular where nΩ is a frequency ω_n of a thin disc: there a wave stands still.
#[test]
fn waves_stand_still_at_critical_speeds() {
    let case = parsed(&plate("kirchhoff", "speed = 1\nspin_stiffness = false", ""));
    let at_rest = eigenvalues(&case.with_parameter("rotation.disc.speed", 0.0).unwrap());
    let negative = |speed: f64| {
        let case = case.with_parameter("rotation.disc.speed", speed).unwrap();
        let structure = Prepared::new(&case).unwrap().system.structure;
        structure.engine.factorize(&structure.stiffness).unwrap().inertia().negative
    };
    // The first are those of 2, 3 and 1 nodal diameters.
    for (below, n, rate) in [(0, 2.0, at_rest[3].im), (2, 3.0, at_rest[5].im)] {
        let critical = rate / n;
        assert_eq!([negative(0.999 * critical), negative(1.001 * critical)], [below, below + 2], "{n}");
    }
}

/// Goal: a sweep over the speed has at each of its values the eigenvalues of an analysis there, as has a case of exported matrices.
#[test]
fn sweeps_and_exported_matrices_have_the_modes_of_single_analyses() {
    let sweep = "[sweep.speed]\nparameter = \"rotation.disc.speed\"\nfrom = \"300 rpm\"\nto = \"900 rpm\"\npoints = 3";
    let case = parsed(&plate("mindlin", "speed = \"300 rpm\"", sweep));
    let prepared = Prepared::new(&case).unwrap();
    let run = analyse(&prepared, Selection::Only("sweep"), &mut |_| Ok(()), &()).unwrap();
    let swept = &run.get::<SweepResult>().unwrap().sweep;
    for (k, rpm) in [300.0, 600.0, 900.0].into_iter().enumerate() {
        let single = eigenvalues(&case.with_parameter("rotation.disc.speed", rpm * TAU / 60.0).unwrap());
        let found: Vec<c64> = swept.branches.iter().filter_map(|branch| branch.at(k)).collect();
        assert_eq!(single.len(), found.len());
        for z in &single {
            let near = found.iter().map(|other| (other - z).norm()).fold(f64::INFINITY, f64::min);
            assert!(within(near, 1e-7 * z.norm(), RoundOff), "{rpm}: {z} {near:.1e}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    stridor::job::export(&case.without_studies(), stridor::job::ContactAs::Points, folder.path()).unwrap();
    let again = stridor::case::read_case(&folder.path().join("case.toml")).unwrap();
    for (a, b) in eigenvalues(&case).iter().zip(&eigenvalues(&again)) {
        assert!(within((a - b).norm(), 1e-7 * a.norm(), RoundOff), "{a} {b}");
    }
}

/// Goal: eigenvalues follow the speed as their sensitivities say.
#[test]
fn sensitivities_to_the_speed_are_those_of_differences() {
    let asked = "[sensitivity]\nparameters = [\"rotation.*.speed\"]\nmodes = [\"190 Hz\"]\nadvice = false";
    let case = parsed(&plate("mindlin", "speed = \"900 rpm\"", asked));
    let prepared = Prepared::new(&case).unwrap();
    let run = analyse(&prepared, Selection::Only("sensitivity"), &mut |_| Ok(()), &()).unwrap();
    let mode = &run.get::<SensitivityResult>().unwrap().modes[0];
    let near = |speed: f64| {
        let all = eigenvalues(&case.with_parameter("rotation.disc.speed", speed).unwrap());
        all.into_iter()
            .min_by(|a, b| (a - mode.eigenvalue).norm().total_cmp(&(b - mode.eigenvalue).norm()))
            .unwrap()
    };
    let (speed, step) = (mode.parameters[0].value, 0.5);
    let slope = (near(speed + step) - near(speed - step)) / (2.0 * step);
    // Twice nΩ of the split, two nodal diameters, and what stress adds.
    assert!(slope.im > 2.0 && slope.im < 3.0, "{slope}");
    assert!(within((mode.parameters[0].rate - slope).norm(), 1e-4 * slope.norm(), Discretisation), "{slope}");
}

/// Goal: gyroscopic forces do no work on an undamped disc in motion, and its balance of energy closes.
#[test]
fn an_undamped_disc_in_motion_keeps_its_energy() {
    let motion = "[transient]\nduration = \"20 ms\"\ntime_step = \"50 us\"\nscheme = \"newmark\"\n\
                  [transient.push.tip]\non = \"rim\"\nforce = [\"1 N\", 0, \"1 N\"]\nduration = \"1 ms\"";
    let case = parsed(&plate("kirchhoff", "speed = \"900 rpm\"", motion));
    let prepared = Prepared::new(&case).unwrap();
    let run = analyse(&prepared, Selection::Only("transient"), &mut |_| Ok(()), &()).unwrap();
    let found = run.get::<TransientResult>().unwrap();
    let work = &found.work;
    let turnover = work.kinetic.abs().max(work.strain.abs());
    assert!(turnover > 0.0 && work.coupling == 0.0, "{work:?}");
    assert!(within(found.worst_residual, 1e-8, RoundOff), "{:.1e}", found.worst_residual);
}

/// Goal: parts that are not of revolution, or cannot turn, are faults with the place, or a warning where the difference is small.
#[test]
fn what_cannot_turn_is_refused() {
    let refused = |text: &str, words: &[&str]| {
        let said = match Case::parse("disc", text, ".".into()) {
            Ok(case) => Prepared::new(&case).unwrap_err().to_string(),
            Err(error) => error.to_string(),
        };
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    };
    let text = plate("kirchhoff", "speed = 60", "");
    refused(
        &text.replace("axis = [1, 0, 0]", "axis = [0, 0, 1]"),
        &["`rotation.disc.axis`", "off its turned self"],
    );
    refused(
        &text.replace("axis = [1, 0, 0]", "axis = [1, 0, 0]\npoint = [0, 0.01, 0]"),
        &["`rotation.disc.axis`"],
    );
    refused(
        &text.replace("parts = \"disc\"", "parts = \"disk\""),
        &["rotation.disc.parts", "Did you mean \"disc\"?"],
    );
    refused(&text.replace("theory =", "bending_only = true\ntheory ="), &["rotation.disc.spin_stiffness"]);
    refused(&text.replace("speed = 60", "speed = \"60 mm/s\""), &["rotation.disc.speed", "600 rpm"]);
    let twice = "[rotation.again]\nparts = \"disc\"\naxis = [1, 0, 0]\nspeed = 1";
    refused(&plate("kirchhoff", "speed = 60", twice), &["rotation.disc.parts", "rotation.again"]);
    let warned = |point: &str| {
        let moved = text.replace("axis = [1, 0, 0]", &format!("axis = [2, 0, 0]\npoint = [5, {point}, 0]"));
        let all = Prepared::new(&parsed(&moved)).unwrap().warnings;
        all.iter().any(|warning| {
            warning.contains("`rotation.disc.parts`") && warning.contains("a body of revolution")
        })
    };
    assert!(!warned("0") && warned("\"1 mm\""));
}
