//! Matrices from files: random systems against a dense solver, and any case against itself exported.

use faer::linalg::solvers::Solve;
use faer::{Mat, c64};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;
use stridor::bounds::{Origin::*, least, within};
use stridor::case::Case;
use stridor::equilibrium::steady_sliding;
use stridor::error::Result;
use stridor::job::{ContactAs, Prepared, Selection, analyse, export};
use stridor::results::{ComplexResult, MeasuredComparison, NamedModes, RunResults, SteadyResult};

/// M, C, K of a random system.
struct RandomSystem {
    m: Mat<f64>,
    c: Mat<f64>,
    k: Mat<f64>,
}

/// A chain-like random system of order n with stiffness-proportional and random damping; `rows` rows of K and C are not
/// symmetric, `massless` rows have no mass, and K is singular when `free`.
fn random_system(n: usize, rows: usize, massless: usize, free: bool, seed: u64) -> RandomSystem {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut random = || generator.gen_range(-1.0..1.0);
    let (mut m, mut c, mut k) = (Mat::zeros(n, n), Mat::zeros(n, n), Mat::<f64>::zeros(n, n));
    for i in 0..n {
        m[(i, i)] = 1.0 + 0.5 * random();
        for j in [i + 1, i + 3, i + 7].into_iter().filter(|j| *j < n) {
            let spring = 2e6 * (1.2 + random());
            for (a, b, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                k[(a, b)] += sign * spring;
                c[(a, b)] += sign * spring * 2e-6 * (1.0 + 0.3 * (i % 3) as f64);
            }
        }
        if !free {
            k[(i, i)] += 1e5 * (1.5 + random());
        }
        if i + 1 < n {
            let coupled = 0.2 * random();
            m[(i, i + 1)] = coupled;
            m[(i + 1, i)] = coupled;
        }
    }
    for p in 0..rows {
        let (row, column) = ((5 * p + 2) % n, (5 * p + 4) % n);
        k[(row, column)] += 1.5e6 * random();
        c[(row, (column + 1) % n)] += 20.0 * random();
    }
    for p in 0..massless {
        let row = (6 * p + 1) % n;
        for j in 0..n {
            m[(row, j)] = 0.0;
            m[(j, row)] = 0.0;
            // Without mass, damping between such rows would make first-order modes: keep to stiffness.
            c[(row, j)] = 0.0;
            c[(j, row)] = 0.0;
        }
    }
    RandomSystem { m, c, k }
}

/// All finite eigenvalues with Im λ > 0 and a frequency in the band, dense, independent of the program: the companion of
/// μ² Q(s) + μ Q′(s) + M at μ = 1/(λ − s), then Newton's inverse iteration on Q itself.
fn dense_eigenvalues(system: &RandomSystem, band: [f64; 2]) -> Vec<c64> {
    let RandomSystem { m, c, k } = system;
    let n = m.nrows();
    let s = TAU * band[1];
    let value = m * faer::Scale(s * s) + c * faer::Scale(s) + k;
    let slope = m * faer::Scale(2.0 * s) + c;
    let lu = value.partial_piv_lu();
    let (a, b) = (lu.solve(&slope), lu.solve(m));
    let companion = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => 0.0,
        (true, false) => f64::from(i == j - n),
        (false, true) => -b[(i - n, j)],
        (false, false) => -a[(i - n, j - n)],
    });
    let eigen = companion.eigen().unwrap();
    let q = |z: c64| Mat::from_fn(n, n, |i, j| z * z * m[(i, j)] + z * c[(i, j)] + k[(i, j)]);
    let slope = |z: c64| Mat::from_fn(n, n, |i, j| z * 2.0 * m[(i, j)] + c[(i, j)]);
    let mut found = Vec::new();
    for index in 0..2 * n {
        let mu = eigen.S()[index];
        if mu.norm() * s < 1e-7 {
            continue;
        }
        let mut z = c64::new(s, 0.0) + c64::new(1.0, 0.0) / mu;
        // One that diverges is given whatever the band; far beyond it are the infinite ones of what has no mass.
        let diverges = |z: c64| z.re > 1e-3 * s && z.re < 100.0 * s && z.im.abs() <= 1e-6 * z.norm();
        if !diverges(z) && (z.im < 1e-6 * z.norm() || z.im > 1.5 * s) {
            continue;
        }
        let mut x = Mat::from_fn(n, 1, |i, _| eigen.U()[(i, index)]);
        for _ in 0..4 {
            let y = q(z).partial_piv_lu().solve(slope(z) * &x);
            let dot = |u: &Mat<c64>, v: &Mat<c64>| (u.adjoint() * v)[(0, 0)];
            let step = dot(&x, &x) / dot(&x, &y);
            if !step.re.is_finite() {
                break;
            }
            z -= step;
            let size = dot(&y, &y).re.sqrt();
            x = Mat::from_fn(n, 1, |i, _| y[(i, 0)] / size);
        }
        if diverges(z) || (z.im >= TAU * band[0] && z.im <= TAU * band[1]) {
            found.push(z);
        }
    }
    found.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
    found
}

fn write_matrix(folder: &Path, name: &str, a: &Mat<f64>, scale: &[f64], factor: f64) {
    let mut body = String::new();
    let mut count = 0;
    for j in 0..a.ncols() {
        for i in (0..a.nrows()).filter(|i| a[(*i, j)] != 0.0) {
            let _ = writeln!(body, "{} {} {:e}", i + 1, j + 1, factor * scale[i] * a[(i, j)] * scale[j]);
            count += 1;
        }
    }
    let text = format!("%%MatrixMarket matrix coordinate real general\n{0} {0} {count}\n{body}", a.nrows());
    std::fs::write(folder.join(name), text).unwrap();
}

fn run(folder: &Path, text: &str) -> Result<RunResults> {
    let case = Case::parse("case.toml", text, folder.to_path_buf())?;
    let prepared = Prepared::new(&case)?;
    analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &())
}

fn eigenvalues(results: &RunResults) -> Vec<c64> {
    results.get::<ComplexResult>().unwrap().modes.modes.iter().map(|m| m.eigenvalue).collect()
}

const MATRICES: &str = "[matrices]\nmass = \"m.mtx\"\nstiffness = \"k.mtx\"\ndamping = \"c.mtx\"\n[cea]\n";

#[test]
fn random_systems_have_the_eigenvalues_of_a_dense_solver() {
    let folder = tempfile::tempdir().unwrap();
    let mut worst: (f64, String) = (0.0, String::new());
    let mut total = 0;
    for seed in 0..24u64 {
        let n = 12 + (seed as usize * 5) % 29;
        let (rows, massless, free) = (seed as usize % 5, (seed as usize / 2) % 4, seed % 3 == 0);
        let system = random_system(n, rows, massless, free, seed);
        let band = [20.0, 450.0];
        let expected = dense_eigenvalues(&system, band);
        // Units of the rows apart by up to 1e10, and all forces in another unit.
        let scales: [fn(usize) -> f64; 3] = [|_| 1.0, |i| [1.0, 1e-5, 1e5][i % 3], |i| [1e5, 1e-5][i % 2]];
        let scale: Vec<f64> = (0..n).map(scales[seed as usize % 3]).collect();
        let factor = [1.0, 1e10, 1e-10][(seed as usize / 3) % 3];
        for (name, a) in [("m.mtx", &system.m), ("c.mtx", &system.c), ("k.mtx", &system.k)] {
            write_matrix(folder.path(), name, a, &scale, factor);
        }
        let label =
            format!("seed {seed}: n {n}, {rows} rows, {massless} massless, free {free}, factor {factor:e}");
        let results = run(folder.path(), &format!("{MATRICES}band = [20, 450]"))
            .unwrap_or_else(|e| panic!("{label}: {e}"));
        let found = eigenvalues(&results);
        assert_eq!(found.len(), expected.len(), "{label}: {:?}", results.warnings);
        total += expected.len();
        for (a, b) in found.iter().zip(&expected) {
            let error = (a - b).norm() / b.norm();
            if error > worst.0 {
                worst = (error, format!("{label}: {a} {b} {:?}", results.warnings));
            }
        }
    }
    assert!(total > 150, "{total} eigenvalues compared");
    println!("{total} eigenvalues, largest relative error {:.1e} at {}", worst.0, worst.1);
    assert!(within(worst.0, 1e-8, Tolerance), "{:.1e} at {}", worst.0, worst.1);
}

#[test]
fn an_exported_case_has_the_same_modes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation");
    let along = "sliding_velocity = \"2 m/s\"\nsliding_direction = [0, 1, 0]\n";
    // Every point has a direction and a speed of its own.
    let about = "rotation = { axis = [1, 0, 0], speed = \"40 rad/s\" }\n";
    for (name, sliding) in [("two-dof", along), ("pad-on-disc", along), ("pad-on-disc", about)] {
        let folder = root.join(name);
        let text = std::fs::read_to_string(folder.join("case.toml")).unwrap().replace(along, sliding);
        let mut case = Case::parse(name, &text, folder).unwrap();
        let cea = case.cea.as_mut().unwrap();
        (cea.band[1], cea.basis_below) = (cea.band[1].min(600.0), cea.basis_below.min(900.0));
        let of = |case: &Case| {
            let prepared = Prepared::new(case).unwrap();
            analyse(&prepared, Selection::Only("cea"), &mut |_| Ok(()), &()).unwrap()
        };
        let exported = |contact| {
            let folder = tempfile::tempdir().unwrap();
            export(&case, contact, folder.path()).unwrap();
            of(&stridor::case::read_case(&folder.path().join("case.toml")).unwrap())
        };
        let (direct, back, linearised) =
            (of(&case), exported(ContactAs::Points), exported(ContactAs::Matrices));
        let (a, b) = (direct.get::<SteadyResult>().unwrap(), back.get::<SteadyResult>().unwrap());
        for (p, q) in a.state.points.iter().zip(&b.state.points) {
            let scale = a.state.points.iter().map(|p| p.penetration.abs()).fold(0.0, f64::max);
            assert!(within((p.penetration - q.penetration).abs(), 1e-9 * scale, Tolerance), "{name}");
        }
        for other in [back, linearised] {
            let (a, b) = (eigenvalues(&direct), eigenvalues(&other));
            assert!(!a.is_empty() && a.len() == b.len(), "{name}: {} {}", a.len(), b.len());
            for (x, y) in a.iter().zip(&b) {
                assert!(within((x - y).norm(), 1e-9 * x.norm(), Tolerance), "{name}: {x} {y}");
            }
        }
    }
}

/// Damping ratios of modes are no part of C, which has them twice if the case that is written kept them beside: a sentence says which modes
/// they are of.
#[test]
fn ratios_of_modes_are_no_part_of_an_exported_damping() {
    let text = include_str!("../../validation/pad-on-disc/case.toml");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/pad-on-disc");
    let exported = |more: &str, contact| {
        let case = Case::parse("case.toml", &format!("{text}{more}"), root.clone()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let sentences = export(&case, contact, folder.path()).unwrap();
        let damping = std::fs::read(folder.path().join("damping.mtx")).unwrap_or_default();
        (damping, sentences.iter().any(|sentence| sentence.contains("no part of the exported C")))
    };
    assert!(!text.contains("[damping]"));
    for (contact, said) in [(ContactAs::Points, false), (ContactAs::Matrices, true)] {
        let (without, none) = exported("", contact);
        for ratios in ["modal_ratio = 0.01", "modal_ratios = [[1000, 0.01]]"] {
            assert_eq!(exported(&format!("\n[damping]\n{ratios}\n"), contact), (without.clone(), said));
        }
        assert!(!none);
    }
}

#[test]
fn names_of_contacts_need_not_be_names_of_files() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/two-dof/case.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let named = text.replace("[contact.belt]", "[contact.\"pad/left\"]");
    let case = stridor::case::Case::parse("case.toml", &named, ".".into()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    export(&case, ContactAs::Points, folder.path()).unwrap();
    assert!(folder.path().join("contact_pad_left.csv").exists());
    let exported = stridor::case::read_case(&folder.path().join("case.toml")).unwrap();
    assert!(exported.contact.contains_key("pad/left"));
}

#[test]
fn an_exported_case_keeps_what_was_measured_of_what_it_has() {
    let (from, to) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    std::fs::write(from.path().join("tap.csv"), "frequency_hz,damping_ratio\n0.2,0.01\n").unwrap();
    let text = include_str!("../../validation/two-dof/case.toml").to_string()
        + r#"
[modes.whole]
count = 2
[modes.free]
count = 2
free = true
[frf.place]
excitation = { at = [0, 0, 0], direction = [1, 0, 0] }
band = [0.01, 1]
[frf.region]
excitation = { on = "block", direction = [1, 0, 0] }
band = [0.01, 1]
[measured.tap]
of = "whole"
file = "tap.csv"
[measured.listed]
of = "free"
frequencies = [0.2]
[sweep.mu]
parameter = "contact.belt.friction.mu0"
from = 0.1
to = 0.5
points = 3
[sweep.k]
parameter = "spring.k1.stiffness"
from = 1
to = 2
points = 3
[calibrate]
against = ["tap"]
parameter.k = { path = "spring.k1.stiffness", between = [0.5, 2] }
[sensitivity]
parameters = ["contact.*", "spring.k1.stiffness"]
[transient]
duration = "1 s"
time_step = "10 ms"
probe.place = { at = [0, 0, 0], direction = [1, 0, 0] }
probe.region = { on = "block", direction = [1, 0, 0] }
"#;
    let case = Case::parse("case.toml", &text, from.path().into()).unwrap();
    let left_out = export(&case, ContactAs::Points, to.path()).unwrap().join("\n");
    let exported = stridor::case::read_case(&to.path().join("case.toml")).unwrap();
    let names = |table: &str, kept: &str, gone: &str| {
        assert!(left_out.contains(&format!("[{table}.{gone}] is left out")), "{left_out}");
        assert!(!left_out.contains(&format!("[{table}.{kept}]")), "{left_out}");
    };
    names("modes", "whole", "free");
    names("frf", "place", "region");
    names("measured", "tap", "listed");
    names("sweep", "mu", "k");
    names("transient.probe", "place", "region");
    assert_eq!(exported.sensitivity.as_ref().unwrap().parameters, ["contact.*"]);
    let pushed = text + "push.knock = { on = \"block\", force = [\"1 N\", 0, 0], duration = \"0.1 s\" }\n";
    let pushed = Case::parse("case.toml", &pushed, from.path().into()).unwrap();
    let without = tempfile::tempdir().unwrap();
    assert!(
        export(&pushed, ContactAs::Points, without.path())
            .unwrap()
            .join("\n")
            .contains("[transient] is left out")
    );
    assert!(stridor::case::read_case(&without.path().join("case.toml")).unwrap().transient.is_none());
    assert!(left_out.contains("[calibrate] is left out") && exported.calibrate.is_none(), "{left_out}");
    let of = |case: &Case| {
        let selection = Selection::Measured;
        analyse(&Prepared::new(case).unwrap(), selection, &mut |_| Ok(()), &()).unwrap()
    };
    let row =
        |case: &Case| of(case).all::<MeasuredComparison>().iter().find(|m| m.name == "tap").unwrap().rows[0];
    assert_eq!(exported.measured["tap"].file.as_deref(), Some("measured_tap.csv"));
    assert_eq!((row(&exported).mode, row(&exported).damping_ratio), (row(&case).mode, Some(0.01)));
}

#[test]
fn left_vectors_are_kept_for_what_needs_them() {
    let folder = tempfile::tempdir().unwrap();
    let system = random_system(40, 3, 0, false, 5);
    for (name, a) in [("m", &system.m), ("c", &system.c), ("k", &system.k)] {
        write_matrix(folder.path(), &format!("{name}.mtx"), a, &[1.0; 40], 1.0);
    }
    let left = |cea: &str| -> Vec<usize> {
        let results = run(folder.path(), &format!("{MATRICES}band = [0, 250]\n{cea}")).unwrap();
        results.get::<ComplexResult>().unwrap().modes.modes.iter().map(|mode| mode.left.len()).collect()
    };
    let all = left("");
    assert!(!all.is_empty() && all.iter().all(|n| *n == 40));
    assert_eq!(left("left_vectors = false\n"), vec![0; all.len()]);
    assert_eq!(left("left_vectors = false\n[sensitivity]\n"), all);
}

#[test]
fn pairs_nearest_to_a_frequency_are_those_of_the_whole_band() {
    let folder = tempfile::tempdir().unwrap();
    let system = random_system(40, 4, 0, false, 3);
    for (name, a) in [("m.mtx", &system.m), ("c.mtx", &system.c), ("k.mtx", &system.k)] {
        write_matrix(folder.path(), name, a, &[1.0; 40], 1.0);
    }
    let all = eigenvalues(&run(folder.path(), &format!("{MATRICES}band = [0, 1200]")).unwrap());
    for (hz, count) in [(250.0, 5), (400.0, 12), (60.0, 3)] {
        let nearest =
            run(folder.path(), &format!("{MATRICES}nearest = {hz:.1}\ncount = {count}\nband = [0, 1200]"))
                .unwrap();
        let found = eigenvalues(&nearest);
        let target = c64::new(0.0, TAU * hz);
        let mut expected = all.clone();
        expected.sort_by(|a, b| (a - target).norm().total_cmp(&(b - target).norm()));
        expected.truncate(count);
        assert_eq!(found.len(), count);
        for z in &expected {
            let off = least(found.iter().map(|f| (f - z).norm()));
            assert!(within(off, 1e-8 * z.norm(), Tolerance), "{hz} {count}: {z} in {found:?}");
        }
    }
    let few =
        run(folder.path(), &format!("{MATRICES}nearest = 250.0\ncount = 30\nband = [200, 300]")).unwrap();
    assert!(few.warnings.iter().any(|w| w.contains("of the 30 complex modes")), "{:?}", few.warnings);
}

#[test]
fn faults_of_a_case_with_matrices_come_together() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("m.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1\n2 2 1\n");
    write("k.mtx", "%%MatrixMarket matrix coordinate real symmetric\n3 3 2\n1 1 x\n9 2 1\n");
    write("c.mtx", "%%MatrixMarket matrix coordinate pattern symmetric\n2 2 1\n1 1\n");
    let error = run(folder.path(), &format!("{MATRICES}band = [0, 100]")).unwrap_err();
    let text = error.to_string();
    for part in ["3 faults", "k.mtx:3", "k.mtx:4", "c.mtx:1"] {
        assert!(text.contains(part), "{part} not in\n{text}");
    }
    write("c.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 1\n1 1 1\n");
    write("k.mtx", "%%MatrixMarket matrix coordinate real general\n2 2 3\n1 1 1000\n2 2 2000\n1 2 100\n");
    write("contact.csv", "normal;t1;t2;weight;gap\n1;2;;1;0\n-7;x;;-1;nan\n");
    let contact = |points: &str| {
        format!(
            "{MATRICES}band = [0, 100]\n[contact.pad]\npoints = {points}\nload = 1\nsliding_velocity = 1\n\
             normal = {{ per = \"point\", stiffness = 100 }}\nfriction = {{ law = \"coulomb\", mu0 = 0.3 }}\n"
        )
    };
    let text = run(folder.path(), &contact("\"contact.csv\"")).unwrap_err().to_string();
    for part in ["4 faults", "contact.csv:3 `weight`", "contact.csv:3 `gap`", "`normal`", "`t1`"] {
        assert!(text.contains(part), "{part} not in\n{text}");
    }
    let mixed = contact("[[\"1\", \"2\"]]").replace("[cea]", "[material.steel]\nyoungs_modulus = 1\n[cea]")
        + "body = \"rim\"\n[modes.all]\ncount = 1\nclamp = \"hub\"\n";
    let text = run(folder.path(), &mixed).unwrap_err().to_string();
    for part in ["`material`", "modes.all.clamp", "no such section beside [matrices]"] {
        assert!(text.contains(part), "{part} not in\n{text}");
    }
}

/// K = \[1000 100; 0 2000\] under N = 1 along −1 and μN along 2: u = K⁻¹(−1, 0.3).
#[test]
fn a_stiffness_that_is_not_symmetric_carries_a_contact() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("m.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1\n2 2 1\n");
    write("k.mtx", "%%MatrixMarket matrix coordinate real general\n2 2 3\n1 1 1000\n2 2 2000\n1 2 100\n");
    let case = "title = \"Two\"\n[matrices]\nmass = \"m.mtx\"\nstiffness = \"k.mtx\"\n[cea]\nband = [0, 100]\n\
                [contact.pad]\npoints = [[\"1\", \"2\"]]\nload = 1\nsliding_velocity = 1\n\
                normal = { per = \"point\", stiffness = 100 }\nfriction = { law = \"coulomb\", mu0 = 0.3 }\n";
    let case = Case::parse("two.toml", case, folder.path().to_path_buf()).unwrap();
    let prepared = Prepared::new(&case).unwrap();
    let u = steady_sliding(&prepared.system).unwrap().displacement;
    for (found, exact) in u.iter().zip([-1.015e-3, 1.5e-4]) {
        assert!(within((found - exact).abs(), 1e-12 * exact.abs(), Tolerance), "{u:?}");
    }
}

/// Masses without any spring, with some springs, with dampers: every mode has a backward error.
#[test]
fn systems_without_stiffness_have_errors_of_numbers() {
    for n in 1..7 {
        for springs in [0, 1] {
            let folder = tempfile::tempdir().unwrap();
            let ones = vec![1.0; n];
            let m = Mat::from_fn(n, n, |i, j| if i == j { 1.0 + 0.3 * i as f64 } else { 0.0 });
            let k = Mat::from_fn(n, n, |i, j| if i == j && i < springs { 1e4 } else { 0.0 });
            write_matrix(folder.path(), "m.mtx", &m, &ones, 1.0);
            write_matrix(folder.path(), "k.mtx", &k, &ones, 1.0);
            let text = "[matrices]\nmass = \"m.mtx\"\nstiffness = \"k.mtx\"\n[cea]\nband = [0, 100]\n";
            let results = run(folder.path(), text).unwrap();
            let modes = &results.get::<ComplexResult>().unwrap().modes.modes;
            assert!(!modes.is_empty());
            for mode in modes {
                assert!(
                    within(mode.backward_error, 1e-10, Tolerance) && mode.eigenvalue_error.is_finite(),
                    "{n} {springs}: {}",
                    mode.errors()
                );
            }
        }
    }
}

/// One triangle under a `general` header in any of the files of which a symmetric matrix is the sum: the fault names that file, its key and
/// the header that helps.
#[test]
fn a_matrix_of_one_triangle_is_named_by_its_own_file() {
    let keys = ["mass", "stiffness", "term.a.mass", "term.a.stiffness", "term.b.mass", "term.b.stiffness"];
    for wrong in keys {
        for triangle in ["2 1", "1 2"] {
            let folder = tempfile::tempdir().unwrap();
            let mut text = "[matrices]\n".to_string();
            for key in keys {
                let complex = key.ends_with("stiffness");
                let number =
                    |x: f64| if complex { format!("{x:e} {:e}", 0.01 * x) } else { format!("{x:e}") };
                let [diagonal, beside] = if complex { [2e6, -1e6] } else { [0.2, -0.1] }.map(number);
                let (header, at) = if key == wrong { ("general", triangle) } else { ("symmetric", "2 1") };
                let field = if complex { "complex" } else { "real" };
                let matrix = format!(
                    "%%MatrixMarket matrix coordinate {field} {header}\n2 2 3\n1 1 {diagonal}\n{at} {beside}\n2 2 {diagonal}\n"
                );
                std::fs::write(folder.path().join(format!("{key}.mtx")), matrix).unwrap();
                text += &format!("{key} = \"{key}.mtx\"\n");
            }
            text += "term.a.factor = 0.5\nterm.b.factor = 2\n[cea]\nband = [0, \"1 kHz\"]\n";
            let said = run(folder.path(), &text).unwrap_err().to_string();
            for part in [
                format!("`matrices.{wrong}`"),
                format!("{wrong}.mtx"),
                "`symmetric` in place of `general`".into(),
            ] {
                assert!(said.contains(&part), "{part} not in\n{said}");
            }
            let others =
                keys.iter().filter(|key| **key != wrong && said.contains(&format!("matrices.{key}`")));
            assert_eq!(others.count(), 0, "{said}");
        }
    }
}

#[test]
fn an_exported_and_reread_file_of_rows_names_its_faults() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    for name in ["m.mtx", "k.mtx", "c.mtx"] {
        write(name, "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1\n2 2 5\n");
    }
    let text =
        MATRICES.replace("[cea]", "dofs = \"dofs.csv\"\n[modes.all]\ncount = 2\n[cea]") + "band = [0, 100]";
    write("dofs.csv", "dof,node,uz,rx,x,y,z\n1,7,1,0,0.1,0.2,0.3\n2,7,0,1,0.1,0.2,0.3\n");
    let results = run(folder.path(), &text).unwrap();
    let modes = results.all::<NamedModes>()[0];
    assert_eq!(results.geometry.nodes, [[0.1, 0.2, 0.3]]);
    assert!(modes.shape(0)[0].iter().filter(|u| **u != 0.0).count() == 1 && modes.modes.len() == 2);
    write("dofs.csv", "dof,node,uz,uz\n1,7,1,0\n");
    assert!(run(folder.path(), &text).unwrap_err().to_string().contains("the column \"uz\" again"));
    write("dofs.csv", "dof,node,uz,x\n1,7,1,0\n3,7,1,1\n");
    let message = run(folder.path(), &text).unwrap_err().to_string();
    assert!(message.contains("another place") && message.contains("dof \"3\""), "{message}");
}

/// A chain of three masses m on springs k, its first spring on the wall: ω = 2 √(k/m) sin((2j − 1) π/14), j = 1 … 3. Stiffness by nodes of
/// Abaqus, mass by grid points of NASTRAN, damping C = βK as OUTPUT4: rows are those of the nodes, ascending.
#[test]
fn matrices_of_abaqus_and_nastran_are_a_chain_of_masses() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    // Node 7 is between 12 and 5: its rows come second.
    write(
        "k.mtx",
        "12,1, 12,1, 1.0e+02\n7,1, 12,1, -1.0e+02\n7,1, 7,1, 2.0e+02\n5,1, 7,1, -1.0e+02\n5,1, 5,1, 2.0e+02\n",
    );
    let column = |node: usize| {
        format!(
            "DMIG*   MAAX            {node:>16}               1\n*       {node:>16}               1 4.000000000D+00\n"
        )
    };
    let cards: String = [5, 7, 12].map(column).concat();
    write(
        "m.pch",
        &format!("$ punched\nDMIG    MAAX    0       6       2       0                       3\n{cards}"),
    );
    let value = |values: &[f64]| values.iter().map(|v| format!("{v:>16.9E}")).collect::<String>();
    let c = [[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]].map(|row| row.map(|v| 0.02 * v));
    let records: String = (0..3).map(|k| format!("{:8}{:8}{:8}\n{}\n", k + 1, 1, 3, value(&c[k]))).collect();
    let head = "       3       3       6       2BAA     1P,5E16.9\n";
    write("c.op4", &format!("{head}{records}       4       1       1\n{}\n", value(&[1.0])));
    let text =
        "[matrices]\nmass = \"m.pch\"\nstiffness = \"k.mtx\"\ndamping = \"c.op4\"\n[cea]\nband = [0, 10]\n";
    let case = Case::parse("chain", text, folder.path().into()).unwrap();
    let prepared = Prepared::new(&case).unwrap_or_else(|error| panic!("{error}"));
    let results = analyse(&prepared, Selection::Only("cea"), &mut |_| Ok(()), &()).unwrap();
    let modes = &results.get::<ComplexResult>().unwrap().modes.modes;
    assert_eq!(modes.len(), 3);
    for (j, mode) in modes.iter().enumerate() {
        let omega = 2.0 * 25.0_f64.sqrt() * ((2 * j + 1) as f64 * std::f64::consts::PI / 14.0).sin();
        // β = 2 · 10⁻⁴ s: σ = −½ β ω².
        let sigma = -0.5 * 2e-4 * omega * omega;
        let wanted = c64::new(sigma, (omega * omega - sigma * sigma).sqrt());
        let off = (mode.eigenvalue - wanted).norm() / omega;
        assert!(within(off, 1e-11, RoundOff), "{j}: {} {wanted} {off:e}", mode.eigenvalue);
    }
}

/// What is wrong in files of other programs, by file and line.
#[test]
fn faults_of_matrices_of_other_programs_have_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("k.mtx"), "1,1, 1,1, 1.0\n2,1, 2,1\n").unwrap();
    std::fs::write(folder.path().join("m.mtx"), "1,1, 1,1, 1.0\n").unwrap();
    let text = "[matrices]\nmass = \"m.mtx\"\nstiffness = \"k.mtx\"\n[modes.all]\ncount = 1\n";
    let case = Case::parse("chain", text, folder.path().into()).unwrap();
    let error = Prepared::new(&case).unwrap_err().to_string();
    assert!(error.contains("k.mtx:2") && error.contains("node, degree of freedom"), "{error}");
}
