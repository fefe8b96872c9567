//! A case as a model of another program: CalculiX finds the same frequencies, and what is written reads back.

use crate::common::named_box;
use std::path::Path;
use std::process::Command;
use stridor::bounds::{Origin::*, within};
use stridor::case::read_case;
use stridor::decks::{self, Format, Units, Weight, convert};
use stridor::job::{Prepared, Selection, analyse, deck};
use stridor::mesh::generate::structured_box;
use stridor::mesh::{CellKind, Mesh, coincident, to_msh_exactly};
use stridor::results::{NamedModes, RunResults};

const STEEL: &str = "[material.steel]\nyoungs_modulus = 2.1e11\npoissons_ratio = 0.3\ndensity = 7850\n";

/// Frequencies \[Hz\] of the first modes of a case.
fn frequencies(prepared: &Prepared) -> Vec<f64> {
    let results: RunResults = analyse(prepared, Selection::Only("modes"), &mut |_| Ok(()), &()).unwrap();
    let modes = &results.get::<NamedModes>().unwrap().modes;
    (0..modes.len()).map(|k| modes.frequency_hz(k)).collect()
}

/// Those that CalculiX finds in a file, if it is there.
fn calculix(folder: &Path, text: &str) -> Option<Vec<f64>> {
    std::fs::write(folder.join("model.inp"), text).unwrap();
    let run = Command::new("ccx").arg("model").current_dir(folder).env("OMP_NUM_THREADS", "1").output();
    let Ok(run) = run else {
        eprintln!("skipped: CalculiX (ccx) is not installed");
        return None;
    };
    let log = String::from_utf8_lossy(&run.stdout);
    assert!(!log.contains("*ERROR"), "{log}\n{text}");
    let data =
        std::fs::read_to_string(folder.join("model.dat")).unwrap_or_else(|error| panic!("{error}: {log}"));
    let rows = data.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    // Number, eigenvalue, rad/s, Hz, imaginary part.
    let rows = rows.skip_while(|row| !row.contains(&"FREQUENCY")).filter(|row| row.len() == 5);
    Some(rows.map_while(|row| row[0].parse::<usize>().ok().and(row[3].parse().ok())).collect())
}

struct Written {
    folder: tempfile::TempDir,
    text: String,
    left_out: decks::Ledger,
    own: Vec<f64>,
}

/// A case on a mesh, its frequencies, and its deck in a format.
fn written(mesh: &Mesh, case: &str, format: Format) -> Written {
    written_with("", mesh, case, format)
}

/// The same with a file of equations, `equations.csv`.
fn written_with(equations: &str, mesh: &Mesh, case: &str, format: Format) -> Written {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("equations.csv"), equations).unwrap();
    std::fs::write(folder.path().join("mesh.msh"), to_msh_exactly(mesh).unwrap()).unwrap();
    let text = format!("[mesh]\nfile = \"mesh.msh\"\nunit = \"m\"\n{STEEL}{case}");
    std::fs::write(folder.path().join("case.toml"), &text).unwrap();
    let case = read_case(&folder.path().join("case.toml")).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let prepared = Prepared::new(&case).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let own = frequencies(&prepared);
    let decks::Written { text, left_out, .. } = decks::write(&deck(&prepared).unwrap(), format).unwrap();
    Written { folder, text, left_out, own }
}

/// The largest relative difference of the frequencies that CalculiX finds; none where it is not installed.
fn difference(written: &Written) -> Option<f64> {
    let other = calculix(written.folder.path(), &written.text)?;
    assert!(other.len() >= written.own.len() && !written.own.is_empty(), "{other:?} {:?}", written.own);
    let off = written.own.iter().zip(&other).map(|(a, b)| (b / a - 1.0).abs());
    Some(off.fold(0.0, f64::max))
}

fn box_of(kind: CellKind, cells: [usize; 3], more: &str, count: usize) -> Written {
    let mesh = structured_box(kind, [0.1, 0.02, 0.01], cells).unwrap();
    let case = format!(
        "[solid.solid]\nmaterial = \"steel\"\n{more}[support.wall]\non = \"x_min\"\n[modes.all]\ncount = {count}\n"
    );
    let written = written(&mesh, &case, Format::Abaqus);
    assert_eq!(written.left_out.rows().count(), 0, "{kind:?}");
    written
}

/// A clamped beam of each kind of solid that CalculiX integrates as it is here, but for what holds the hourglass modes of C3D20R and for the
/// mass of C3D10.
#[test]
fn calculix_finds_the_frequencies_of_solids() {
    for (kind, cells, more) in [
        (CellKind::Hexahedron20, [6, 1, 1], ""),
        (CellKind::Hexahedron20, [6, 2, 1], "integration = \"reduced\"\n"),
        (CellKind::Tetrahedron10, [4, 1, 1], ""),
    ] {
        let Some(off) = difference(&box_of(kind, cells, more, 6)) else { return };
        assert!(within(off, 1e-3, Theory), "{kind:?}: {off:e}");
    }
}

/// Others are integrated at fewer points there, or are another element (C3D8I): what is between both programs falls with the mesh.
#[test]
fn calculix_finds_those_of_other_solids_as_the_mesh_is_fine() {
    let locks = "allow_locking = true\n";
    for (kind, cells, more) in [
        (CellKind::Hexahedron8, [8, 2, 1], ""),
        (CellKind::Wedge15, [5, 1, 1], ""),
        (CellKind::Tetrahedron4, [8, 2, 2], locks),
        (CellKind::Wedge6, [5, 1, 1], locks),
    ] {
        let of = |times: usize| difference(&box_of(kind, cells.map(|n| n * times), more, 3));
        let (Some(coarse), Some(fine)) = (of(1), of(2)) else { return };
        println!("{kind:?} {coarse:e} {fine:e}");
        assert!(fine < 0.5 * coarse, "{kind:?}: {coarse:e} {fine:e}");
    }
}

/// A beam and a pad on it whose meshes do not match, with parts named `beam` and `pad`.
fn beam_and_pad() -> Mesh {
    let kind = CellKind::Hexahedron20;
    let mut mesh = named_box("beam", "_", (kind, [0.1, 0.02, 0.01], [5, 2, 1]), [0.0; 3]);
    mesh.append(named_box("pad", "_", (kind, [0.04, 0.016, 0.008], [3, 3, 1]), [0.05, 0.002, 0.01]));
    mesh
}

/// A pad of an orthotropic material that is tied to a beam; a mass on a rigid bracket, springs, a wall that holds about an axis.
const JOINED: &str = r#"
[material.lining]
youngs_modulus = 8e9
poissons_ratio = 0.25
density = 2500
orthotropic = { axis_3 = [0, 0, 1], youngs_modulus_3 = 1e9, poissons_ratio_13 = 0.3, shear_modulus_13 = 1.5e9 }
[point]
bracket = [0.11, 0.01, 0.03]
[solid.beam]
material = "steel"
[solid.pad]
material = "lining"
[tie.glue]
on = "pad_z_min"
to = "beam_z_max"
[rigid.bracket]
master = "bracket"
follow = ["pad_z_max"]
[mass.lump]
on = "bracket"
mass = 0.05
[spring.soft]
on = "beam_x_max"
direction = [0, 0, 1]
stiffness = 2e6
[support.foot]
on = "beam_x_min"
held = ["uy"]
[modes.all]
count = 8
[support.wall]
on = "beam_x_min"
"#;
const ABOUT_AXIS: &str = r#"held = ["radial", "axial"]
axis = { through = [0.5, 0.5, 0], along = [0, 0, 1] }
"#;

/// Ties, rigid bodies, masses, springs, directions about an axis, orthotropic materials.
#[test]
fn calculix_finds_the_frequencies_of_joined_parts() {
    let case = format!("{JOINED}{ABOUT_AXIS}");
    let written = written(&beam_and_pad(), &case, Format::Abaqus);
    assert_eq!(written.left_out.rows().count(), 0);
    for name in
        ["NAME=pad_z_min", "NAME=glue", "CONSTRAINT NAME=bracket", "ELSET=lump", "ELSET=beam", "NAME=lining"]
    {
        assert!(written.text.contains(name), "{name}");
    }
    let Some(off) = difference(&written) else { return };
    println!("joined {off:e}");
    assert!(within(off, 1e-3, Theory), "{off:e}");
}

/// Two beams in a row whose coincident nodes equations join, the second with half the deflection of the first, u_z = ½ u_z', and with an end
/// that stays plane: mesh, equations, case.
fn geared_beams() -> (Mesh, String, String) {
    let mut mesh = Mesh::default();
    for (name, x) in [("beam", 0.0), ("tip", 0.1)] {
        let own = (CellKind::Hexahedron20, [0.1, 0.02, 0.01], [4, 2, 1]);
        mesh.append(named_box(name, "_", own, [x, 0.0, 0.0]));
    }
    let mut equations = "equation,node,component,factor\n".to_string();
    let mut count = 0;
    for [a, b] in coincident(&mesh.nodes) {
        for (component, factor) in [("ux", 1.0), ("uy", 1.0), ("uz", 2.0)] {
            count += 1;
            equations +=
                &format!("{count},{},{component},{factor}\n{count},{},{component},-1\n", b + 1, a + 1);
        }
    }
    assert_eq!(count, 39);
    let case = "[point]\nend = [0.2, 0.01, 0.005]\n[solid.beam]\nmaterial = \"steel\"\n[solid.tip]\nmaterial = \"steel\"\n\
                [equation.gear]\nfile = \"equations.csv\"\n[equation.plane]\non = [\"tip_x_max\", \"end\"]\n\
                component = [\"ux\", \"ux\"]\nfactor = [1, -1]\n[support.wall]\non = \"beam_x_min\"\n[modes.all]\ncount = 8\n";
    (mesh, equations, case.to_string())
}

/// The elements are the same there: the frequencies are, to the digits of its file.
#[test]
fn calculix_finds_the_frequencies_of_equations() {
    let (mesh, equations, case) = geared_beams();
    let written = written_with(&equations, &mesh, &case, Format::Abaqus);
    assert_eq!((written.left_out.rows().count(), written.text.matches("*EQUATION").count()), (0, 39 + 13));
    let Some(off) = difference(&written) else { return };
    println!("equations {off:e}");
    assert!(within(off, 1e-5, Reference), "{off:e}");
}

/// The deck of a case, imported, has the frequencies of the case, in both formats.
#[test]
fn what_is_written_is_imported_as_the_same_model() {
    let (geared, equations, case) = geared_beams();
    let directions = format!("{JOINED}{ABOUT_AXIS}");
    let axes = format!("{JOINED}held = [\"ux\", \"uz\"]\n");
    let models =
        [(&beam_and_pad(), "", &axes), (&beam_and_pad(), "", &directions), (&geared, &*equations, &case)];
    let formats = [(Format::Abaqus, 1e-9), (Format::Nastran, 1e-6)];
    for ((mesh, equations, case), (format, digits)) in
        models.into_iter().flat_map(|m| formats.map(|f| (m, f)))
    {
        let written = written_with(equations, mesh, case, format);
        let deck = decks::read_bytes("a", written.text.as_bytes(), format);
        let deck = deck.unwrap_or_else(|error| panic!("{error}\n{}", written.text));
        let made = convert(&deck, Units::named("m").unwrap()).unwrap();
        let matters = made.ledger.rows().filter(|row| row.weight == Weight::Matters);
        assert_eq!(matters.count(), 0, "{}", made.page);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("mesh.msh"), to_msh_exactly(&made.mesh).unwrap()).unwrap();
        std::fs::write(folder.path().join("case.toml"), &made.case).unwrap();
        std::fs::write(folder.path().join("equations.csv"), made.equations.unwrap_or_default()).unwrap();
        let case = read_case(&folder.path().join("case.toml"))
            .unwrap_or_else(|error| panic!("{error}\n{}", made.case));
        let other = frequencies(&Prepared::new(&case).unwrap());
        assert_eq!(written.own.len(), other.len());
        for (a, b) in written.own.iter().zip(&other) {
            assert!(within((b / a - 1.0).abs(), digits, Tolerance), "{format:?}: {a} {b}");
        }
    }
}

/// What a deck does not hold is listed, each with its reason; a case of matrices has no deck.
#[test]
fn what_is_not_written_is_listed() {
    let case = r#"
[solid.beam]
material = "steel"
[solid.pad]
material = "steel"
[spring.slanted]
on = "beam_x_max"
direction = [0, 1, 1]
stiffness = 1e6
[support.wall]
on = "beam_x_min"
[damping]
modal_ratio = 0.01
[contact.rub]
body = "pad_z_min"
counter = "beam_z_max"
load = 100
sliding_velocity = 1
normal = { per = "area", stiffness = 1e12 }
friction = { law = "stribeck", mu_static = 0.5, mu_kinetic = 0.3, stribeck_velocity = 1 }
[modes.all]
count = 3
"#;
    let written = written(&beam_and_pad(), case, Format::Abaqus);
    let rows: Vec<String> = written.left_out.rows().map(|row| format!("{}: {}", row.what, row.why)).collect();
    for words in
        ["springs in a direction", "damping of modes", "a load of 100 N", "sliding along", "a constant"]
    {
        assert!(rows.iter().any(|row| row.contains(words)), "{words}: {rows:?}");
    }
    assert!(
        written.text.contains("*CONTACT PAIR, INTERACTION=rub")
            && written.text.contains("pad_z_min, beam_z_max")
    );
    // What is lost stands in the file and in the case that it is imported as, where contact and support have their names.
    assert!(written.text.contains("** Not written: contact.rub: a load of 100 N"), "{}", written.text);
    let deck = decks::read_bytes("a", written.text.as_bytes(), Format::Abaqus).unwrap();
    let made = convert(&deck, Units::named("m").unwrap()).unwrap();
    for words in [
        "[contact.rub]",
        "[support.wall]",
        "# Lost before it came here: a load of 100 N",
        "springs in a direction",
    ] {
        assert!(made.case.contains(words), "{words}: {}", made.case);
    }
    assert!(made.page.contains("a load of 100 N"), "{}", made.page);
}

/// The number of modes is that of the band, or what the case asks for, and never more than there can be.
#[test]
fn the_number_of_modes_is_that_of_the_case() {
    let asked = |analysis: &str| {
        let parts = "[solid.beam]\nmaterial = \"steel\"\n[solid.pad]\nmaterial = \"steel\"\n[support.wall]\non = \"beam_x_min\"\n";
        let written =
            written(&beam_and_pad(), &format!("{parts}{analysis}[modes.all]\ncount = 9\n"), Format::Abaqus);
        let mut lines = written.text.lines().skip_while(|line| *line != "*FREQUENCY");
        let cells = lines.nth(1).unwrap_or_default().split(", ");
        (cells.map(|cell| cell.parse().ok()).collect::<Vec<Option<f64>>>(), written.own)
    };
    let (cells, own) = asked("");
    assert_eq!(cells, [Some(9.0)]);
    // The pad, which nothing holds, has six modes at 0 Hz.
    for k in [7, 8] {
        let below = 0.5 * (own[k - 1] + own[k]);
        let rub = "[contact.rub]\nbody = \"pad_z_min\"\ncounter = \"beam_z_max\"\napproach = 0\nsliding_velocity = 1\n\
                   normal = { per = \"area\", stiffness = 1e12 }\nfriction = { law = \"coulomb\", mu0 = 0.4 }\n";
        let (cells, _) = asked(&format!("{rub}[cea]\nband = [10, {below}]\n"));
        assert_eq!(cells, [Some(k as f64), Some(10.0), Some(below)]);
        let (cells, _) = asked(&format!("[modes.a]\nbelow = {below}\n"));
        assert_eq!(cells, [Some(k as f64), None, Some(below)]);
    }
    // One brick that is held on one side: 12 nodes move.
    let mesh = structured_box(CellKind::Hexahedron20, [0.1, 0.02, 0.01], [1, 1, 1]).unwrap();
    let case =
        "[solid.solid]\nmaterial = \"steel\"\n[support.wall]\non = \"x_min\"\n[modes.all]\ncount = 36\n";
    assert!(written(&mesh, case, Format::Abaqus).text.contains("*FREQUENCY\n35\n"));
}
