//! Universal files both ways with pyuff, an independent reader and writer (Python), which this test installs below the
//! target folder.

use crate::common::samples;
use crate::python;
use std::path::Path;
use std::process::Command;
use stridor::bounds::{Origin::*, within};
use stridor::linalg::c64;
use stridor::measured::Quantity;
use stridor::measured::uff::{Element, Function, RealShape, Unstated, functions_file, modes_text, read};

/// The release whose behaviour the test knows.
const PYUFF: &str = "2.5.8";

/// Writes `theirs.uff`, reads `modes.uff`, `frf.uff` and `frf_binary.uff`, and prints the largest relative deviation of each.
const SCRIPT: &str = r#"
import json, sys
import numpy as np, pyuff
n, m = 5, 7
ids = np.arange(1, n + 1)
xyz = np.array([[0.25 * k, -0.5 * k, 3.0 + k] for k in range(n)])
shape = np.array([[np.sin(1.0 + k + 3 * a) for a in range(3)] for k in range(n)])
hz = 10.0 + 2.5 * np.arange(m)
h = np.array([complex(np.sin(1.0 + k), np.cos(2.0 * k)) for k in range(m)])

def function(binary, even, kind, double):
    return {'type': 58, 'binary': binary, 'id1': 'test', 'func_type': 4, 'rsp_node': 2, 'rsp_dir': -3, 'ref_node': 4,
            'ref_dir': 1, 'abscissa_spacing': even, 'abscissa_spec_data_type': 18, 'ordinate_spec_data_type': kind,
            'orddenom_spec_data_type': 13, 'x': hz, 'data': h, 'ord_data_type': 6 if double else 5}

def theirs(path):
    file = pyuff.UFF(path)
    file.write_sets([
        {'type': 151, 'model_name': 'm', 'description': 'd', 'db_app': 'a', 'program': 'p'},
        {'type': 164, 'units_code': 9, 'units_description': 'mm', 'temp_mode': 1, 'length': 1000.0, 'force': 1.0,
         'temp': 1.0, 'temp_offset': 1.0},
        {'type': 15, 'node_nums': ids, 'x': xyz[:, 0], 'y': xyz[:, 1], 'z': xyz[:, 2]},
        {'type': 55, 'analysis_type': 2, 'data_ch': 2, 'spec_data_type': 8, 'load_case': 1, 'mode_n': 1, 'freq': 123.5,
         'modal_damp_vis': 0.0125, 'node_nums': ids, 'r1': shape[:, 0], 'r2': shape[:, 1], 'r3': shape[:, 2]},
        {'type': 55, 'analysis_type': 3, 'data_ch': 2, 'spec_data_type': 8, 'load_case': 1, 'mode_n': 2,
         'eig': complex(-20.0, 1500.0), 'node_nums': ids, 'r1': shape[:, 0] * (1 + 2j), 'r2': shape[:, 1] * 1j,
         'r3': shape[:, 2] * (1 + 0j)},
        function(0, 0, 12, True), function(0, 1, 11, True), function(1, 0, 8, True), function(1, 1, 12, True),
    ], 'overwrite')
    file.write_sets([function(0, 1, 12, False)], 'add', force_double=False)

def ours(folder):
    off = lambda a, b: float(np.max(np.abs(np.asarray(a) - b)) / np.max(np.abs(b)))
    modes = pyuff.UFF(folder + '/modes.uff')
    sets = modes.read_sets()
    assert list(modes.get_set_types()) == [164, 2411, 2412, 55], modes.get_set_types()
    units, nodes, elements, mode = sets
    assert list(elements[91][0]['nodes_nums']) == [1, 2, 3], elements
    assert list(elements[94][0]['nodes_nums']) == [2, 3, 4, 5], elements
    assert units['length'] == 1.0 and units['force'] == 1.0
    points = np.array([nodes['x'], nodes['y'], nodes['z']]).T
    motion = np.array([mode['r1'], mode['r2'], mode['r3']]).T
    assert list(nodes['node_nums']) == list(ids) and list(mode['node_nums']) == list(ids)
    assert mode['freq'] == 123.5 and mode['modal_damp_vis'] == 0.0125 and mode['modal_m'] == 1.0
    deviations = {'points': off(points, xyz), 'shape': off(motion, shape)}
    for name, binary in [('frf', 0), ('frf_binary', 1)]:
        frf = [s for s in pyuff.UFF(folder + '/' + name + '.uff').read_sets() if s['type'] == 58]
        assert len(frf) == 1 and frf[0]['binary'] == binary
        frf = frf[0]
        assert (frf['func_type'], frf['ref_node'], frf['ref_dir'], frf['rsp_node'], frf['rsp_dir']) == (4, 4, 1, 2, -3)
        assert frf['ordinate_spec_data_type'] == 12 and frf['orddenom_spec_data_type'] == 13
        deviations |= {name + '_hz': off(frf['x'], hz), name: off(frf['data'], h)}
    return deviations

theirs(sys.argv[1] + '/theirs.uff')
print(json.dumps(ours(sys.argv[1])))
"#;

/// The numbers of the script.
fn points() -> Vec<[f64; 3]> {
    (0..5).map(f64::from).map(|k| [0.25 * k, -0.5 * k, 3.0 + k]).collect()
}

fn shape() -> Vec<[f64; 3]> {
    (0..5).map(f64::from).map(|k| [0.0, 1.0, 2.0].map(|a| (1.0 + k + 3.0 * a).sin())).collect()
}

fn response() -> (Vec<f64>, Vec<c64>) {
    let k = || (0..7).map(f64::from);
    (k().map(|k| 10.0 + 2.5 * k).collect(), k().map(|k| c64::new((1.0 + k).sin(), (2.0 * k).cos())).collect())
}

#[test]
fn universal_files_go_both_ways_with_pyuff() {
    let python = python::with(&[("pyuff", PYUFF)]);
    let dir = tempfile::tempdir().unwrap();
    let label = |k: usize| k as u64 + 1;
    let labelled = || points().into_iter().enumerate().map(move |(k, x)| (label(k), x));
    let motion = shape().into_iter().enumerate().map(|(k, u)| (label(k), u));
    let mode = RealShape {
        number: 1,
        frequency_hz: 123.5,
        modal_mass: 1.0,
        damping_ratio: 0.0125,
        motion: Box::new(motion),
    };
    let element = |descriptor, nodes: &[u64]| Element { descriptor, nodes: nodes.to_vec() };
    let elements = [element(91, &[1, 2, 3]), element(94, &[2, 3, 4, 5])].into_iter();
    let modes = modes_text("test", labelled(), elements, std::iter::once(mode));
    std::fs::write(dir.path().join("modes.uff"), modes).unwrap();
    let (hz, h) = response();
    let function = Function {
        title: ["test", "NONE"],
        quantity: Quantity::Accelerance,
        excitation: (4, 1),
        response: (2, -3),
        frequencies_hz: &hz,
        values: &h,
    };
    for (name, binary) in [("frf.uff", false), ("frf_binary.uff", true)] {
        let file = functions_file(labelled(), std::iter::once(&function).cloned(), binary);
        std::fs::write(dir.path().join(name), file).unwrap();
    }

    let done = Command::new(python).args(["-c", SCRIPT]).arg(dir.path()).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let off: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    let off = |key: &str| off[key].as_f64().unwrap();
    // Six digits in single precision; the frequencies have fewer.
    assert!(
        within(off("points"), 1e-6, Reference)
            && within(off("shape"), 1e-5, Reference)
            && within(off("frf"), 1e-12, Reference)
    );
    assert!(off("frf_hz") == 0.0 && off("frf_binary_hz") == 0.0 && off("frf_binary") == 0.0);

    let bytes = std::fs::read(dir.path().join("theirs.uff")).unwrap();
    let records = read("theirs.uff", &bytes, Unstated { unit: 1.0, quantity: None }).unwrap();
    assert!(records.warnings.is_empty(), "{:?}", records.warnings);
    for (point, exact) in records.points.values().zip(points()) {
        assert!(
            (0..3).all(|k| within((1e3 * point[k] - exact[k]).abs(), 1e-6, Reference)),
            "{point:?} {exact:?} in mm"
        );
    }
    let [real, complex] = &records.modes[..] else { panic!("two modes") };
    assert_eq!((real.frequency_hz, real.damping_ratio), (123.5, Some(0.0125)));
    let size = 20f64.hypot(1500.0);
    assert!(within((complex.frequency_hz - size / std::f64::consts::TAU).abs(), 1e-9, Reference));
    assert!(within((complex.damping_ratio.unwrap() - 20.0 / size).abs(), 1e-12, Reference));
    let turn = [c64::new(1.0, 2.0), c64::new(0.0, 1.0), c64::new(1.0, 0.0)];
    for (k, exact) in shape().iter().enumerate() {
        for axis in 0..3 {
            let (a, b) = (real.shape[&label(k)][axis], complex.shape[&label(k)][axis]);
            // Written with six digits.
            assert!(within((a - exact[axis]).norm(), 5e-6 * exact[axis].abs(), Reference), "{k} {axis}: {a}");
            assert!(
                within((b - turn[axis] * exact[axis]).norm(), 1e-5 * b.norm(), Reference),
                "{k} {axis}: {b}"
            );
        }
    }
    // Text with twelve digits (even and uneven), binary (both), text with six. The file is in mm and N: what has no label
    // is in mm over N.
    let quantities = [
        (Quantity::Accelerance, 1e-11),
        (Quantity::Mobility, 1e-11),
        (Quantity::Receptance, 1e-12),
        (Quantity::Accelerance, 1e-12),
        (Quantity::Accelerance, 1e-5),
    ];
    assert_eq!(records.functions.len(), quantities.len());
    for (function, (quantity, tolerance)) in records.functions.iter().zip(quantities) {
        assert_eq!((function.quantity, &function.frequencies_hz), (quantity, &hz));
        assert_eq!((function.excitation, function.response), ((4, [1.0, 0.0, 0.0]), (2, [0.0, 0.0, -1.0])));
        for (value, exact) in function.values.iter().zip(&h) {
            assert!(
                within((1e3 * value - exact).norm(), tolerance * exact.norm(), Reference),
                "{value} {exact}"
            );
        }
    }
}

/// What is asked of a disc, and a test of it that the program itself wrote.
const ASKED: &str = r#"
[damping]
modal_ratio = 0.003
[modes.disc]
below = "1 kHz"
uff = true
[modes.other]
count = 2
[frf.hammer]
excitation = { at = [0, 0, "75 mm"], direction = [1, 0, 0] }
response.side = { at = [0, "75 mm", 0], direction = [1, 0, 0] }
band = ["50 Hz", "1 kHz"]
"#;

fn disc_case() -> String {
    samples::disc(4, 24) + ASKED
}

fn stridor(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let program =
        Command::new(env!("CARGO_BIN_EXE_stridor")).args(arguments).current_dir(folder).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (program.status.code().unwrap(), text(&program.stdout), text(&program.stderr))
}

#[test]
fn what_the_program_wrote_is_compared_with_itself() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    let disc = disc_case();
    std::fs::write(folder.join("disc.toml"), &disc).unwrap();
    for command in ["modes", "frf"] {
        let (code, _, error) = stridor(folder, &[command, "disc.toml", "--out", command]);
        assert_eq!(code, 0, "{error}");
    }
    let measured = "[measured.shapes]\nof = \"disc\"\nfile = \"modes/modes_disc.uff\"\n\
                    [measured.responses]\nfrf = \"hammer\"\nfile = \"frf/frf_hammer.uff\"\n";
    std::fs::write(folder.join("case.toml"), disc.clone() + measured).unwrap();
    let (code, table, error) = stridor(folder, &["compare", "case.toml", "--out", "out"]);
    assert_eq!(code, 0, "{error}");
    assert!(table.contains("FRAC") && table.contains("Every computed level"), "{table}");
    let summary = std::fs::read_to_string(folder.join("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let shapes = &summary["comparison"][0];
    assert_eq!(shapes["name"], "shapes");
    let rows = shapes["modes"].as_array().unwrap();
    assert!(rows.len() > 5);
    for row in rows {
        assert!(within(1.0 - row["mac"].as_f64().unwrap(), 1e-9, Reference), "{row}");
        assert!(within(row["difference_percent"].as_f64().unwrap().abs(), 1e-3, Reference), "{row}");
        assert_eq!(row["measured_damping_ratio"], row["computed_damping_ratio"]);
    }
    // Coordinates of six digits.
    assert!(within(shapes["geometry"]["largest_distance_m"].as_f64().unwrap(), 1e-6, Reference));
    let responses = &summary["comparison_frf"][0];
    assert_eq!(responses["name"], "responses");
    let response = &responses["responses"][0];
    assert!(
        within(1.0 - response["frac"].as_f64().unwrap(), 1e-6, Reference) && response["computed"] == "side",
        "{response}"
    );
    // What no test is of is not computed; the files are there.
    let sets = summary["mode_sets"].as_array().unwrap();
    assert!(sets.len() == 1 && sets[0]["name"] == "disc");
    for file in
        ["comparison_shapes.csv", "comparison_responses_frf.csv", "mac_shapes.svg", "frequencies_shapes.svg"]
    {
        assert!(folder.join("out").join(file).is_file(), "{file}");
    }
    let (code, table, _) = stridor(folder, &["check", "case.toml"]);
    assert!(code == 0 && table.contains("valid"), "{table}");
}

#[test]
fn wrong_measured_files_are_refused_before_anything_is_written() {
    let refused = |file: &str, content: &str, words: &[&str]| {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join(file), content).unwrap();
        let case = format!(
            "{}[measured.test]\nof = \"disc\"\nfile = \"{file}\"\n[measured.gone]\nof = \"disc\"\nfile = \"gone.uff\"\n",
            disc_case()
        );
        std::fs::write(dir.path().join("case.toml"), case).unwrap();
        for command in ["compare", "run", "check"] {
            let (code, _, error) = stridor(dir.path(), &[command, "case.toml"]);
            assert_eq!(code, 2, "{error}");
            assert!(words.iter().all(|word| error.contains(word)) && error.contains("gone.uff"), "{error}");
            assert!(!dir.path().join("results").exists());
        }
    };
    refused("a.csv", "frequency,colour\n330,red\n", &["a.csv:1", "colour", "no column \"frequency_hz\""]);
    refused("a.toml", "[mode.1]\nfrequency = \"330 m\"\n", &["a.toml:2", "mode.1.frequency"]);
    refused("a.uff", "330\n936\n", &["a.uff:1", "begins a dataset"]);
    refused("a.unv", "    -1\n    55\n    -1\n", &["a.unv:2", "dataset 55", "the end of the dataset"]);
    refused("a.mat", "", &["measured.test.file", "a.mat"]);
}
