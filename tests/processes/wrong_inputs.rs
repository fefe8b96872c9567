//! Wrong inputs of every kind: exit code 2, nothing written, and a message that says where, what and what to do.

use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A strip that is held at one end and pressed on the ground at a point.
const CASE: &str = r#"title = "A strip"

[mesh]
file = "strip.msh"
unit = "m"

[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = 7850

[shell.strip]
material = "steel"
thickness = "1 mm"

[support.end]
on = "end"

[modes.strip]
count = 2
"#;

/// Points that stand for a machine, with all that moves in time.
const POINTS: &str = r#"title = "Two masses"

[point]
a = [0, 0, 0]
b = [1, 0, 0]

[mass.a]
on = "a"
mass = 1

[mass.b]
on = "b"
mass = 1

[spring.a]
on = "a"
direction = [1, 0, 0]
stiffness = 1e4

[spring.b]
on = "b"
to = "a"
direction = [1, 0, 0]
stiffness = 1e4

[spring.up]
on = "a"
direction = [0, 0, 1]
stiffness = 1e4

[support.a]
on = "a"
held = ["uy", "rx", "ry", "rz"]

[support.b]
on = "b"
held = ["uy", "uz", "rx", "ry", "rz"]

[contact.belt]
body = "a"
counter = "ground"
into = [0, 0, -1]
load = 10
sliding_velocity = 1
normal = { per = "point", stiffness = 1e6 }
friction = { law = "coulomb", mu0 = 0.2 }

[cea]
band = [0, 100]

[transient]
duration = 1e-2
time_step = 1e-4
probe.a = { on = "a", direction = [1, 0, 0] }
"#;

fn validation(file: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/wrong-files").join(file)
}

fn mesh() -> String {
    std::fs::read_to_string(validation("strip.msh")).expect("a mesh")
}

fn stridor(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_stridor"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

/// A folder with files.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).expect("a file");
    }
    folder
}

fn names(folder: &Path) -> Vec<std::ffi::OsString> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.file_name()).collect();
    names.sort();
    names
}

/// Expects a refusal with these words that writes nothing, and gives its message.
fn refused(folder: &Path, arguments: &[&str], words: &[&str]) -> String {
    let before = names(folder);
    let output = stridor(folder, arguments);
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(message.starts_with("error: ") && output.stdout.is_empty(), "{arguments:?}: {message}");
    assert!(message.chars().all(|c| c == '\n' || !c.is_control()), "{message:?}");
    for word in words {
        assert!(message.contains(word), "\"{word}\" is not in: {message}");
    }
    assert_eq!(names(folder), before, "{arguments:?} wrote something");
    message
}

fn refused_case(case: &str, words: &[&str]) -> String {
    let folder = folder(&[("strip.msh", mesh().as_bytes()), ("case.toml", case.as_bytes())]);
    refused(folder.path(), &["run", "case.toml", "--out", "out"], words)
}

#[test]
fn what_the_wrong_ones_are_made_from_is_sound() {
    for case in [CASE, POINTS] {
        let folder = folder(&[("strip.msh", mesh().as_bytes()), ("case.toml", case.as_bytes())]);
        let output = stridor(folder.path(), &["run", "case.toml", "--out", "out"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn every_wrong_file_is_refused_and_nothing_is_written() {
    let mut count = 0;
    for entry in std::fs::read_dir(validation("")).expect("a folder").flatten() {
        let path = entry.path();
        let sound = ["case.toml", "reference.toml"].iter().any(|name| path.ends_with(name));
        if path.extension().is_some_and(|e| e == "toml") && !sound {
            let folder = folder(&[]);
            refused(folder.path(), &["run", path.to_str().expect("UTF-8"), "--out", "out"], &[]);
            count += 1;
        }
    }
    assert!(count >= 4);
}

#[test]
fn wrong_cases_are_refused_with_place_and_advice() {
    let long = format!("title = \"{}\"", "x".repeat(300));
    for (from, to, words) in [
        ("[mesh]", "[mseh]", &["case.toml:3 `mseh`", "Did you mean `mesh`?"][..]),
        ("thickness =", "thicknes =", &["case.toml:14", "Did you mean `thickness`?"]),
        ("thickness = \"1 mm\"", "thickness = \"1 m", &["case.toml:14", "TOML"]),
        ("\"1 mm\"", "\"1\"", &["case.toml:14 `shell.strip.thickness`", "without a unit", "write 1 without"]),
        ("\"1 mm\"", "\"1 kg\"", &["\"kg\" is of another dimension", "a length such as"]),
        ("\"1 mm\"", "\"1 furlong\"", &["\"furlong\" is not known"]),
        ("\"1 mm\"", "\"thin\"", &["does not begin with a number"]),
        ("\"1 mm\"", "-1", &["found -1", "above zero"]),
        ("\"1 mm\"", "[1]", &["a list of 1", "a length"]),
        ("\"1 mm\"", "inf", &["inf, which is not finite"]),
        ("unit = \"m\"", "unit = \"mms\"", &["case.toml:5 `mesh.unit`", "did you mean \"mm\"?"]),
        ("file = \"strip.msh\"", "file = \"strap.msh\"", &["strap.msh: found no file there", "a Gmsh mesh"]),
        ("file = \"strip.msh\"", "file = \"no/s.msh\"", &["no/s.msh", "there is no folder \"no\""]),
        ("file = \"strip.msh\"", "file = \".\"", &["found a folder", "a Gmsh mesh"]),
        ("on = \"end\"", "on = \"edn\"", &["case.toml:17 `support.end.on`", "Did you mean \"end\"?"]),
        ("on = \"end\"", "on = 3", &["case.toml:17 `support.end.on`", "the whole number 3"]),
        (
            "on = \"end\"",
            "on = \"end\"\nheld = \"ux,uy\"",
            &["case.toml:18 `support.end.held`", "ux, uy, uz"],
        ),
        ("[shell.strip]", "[shell.strap]", &["case.toml:12 `shell.strap`", "Did you mean \"strip\"?"]),
        ("[shell.strip]", "[bar.strip]\ndiameter=1", &["`bar.strip.thickness`", "an unknown key"]),
        (
            "[material.steel]",
            "[material.steal]",
            &["case.toml:13 `shell.strip.material`", "Did you mean \"steal\"?"],
        ),
        ("count = 2", "count = 0", &["case.toml:20 `modes.strip.count`", "a whole number"]),
        ("count = 2", "count = 2\nbelow = 3", &["`modes.strip.count`", "one of them"]),
        ("count = 2", "count = 2\nclamp = \"tip\"", &["case.toml:21 `modes.strip.clamp`", "\"tip\""]),
        ("density = 7850", "density = 7850\ndensity = 1", &["case.toml:11", "duplicate key"]),
        ("title = \"A strip\"", &long, &["mesh"]),
        ("title = \"A strip\"", "title = 3", &["case.toml:1 `title`", "the whole number 3", "a string"]),
    ] {
        assert!(CASE.contains(from), "{from}");
        let case = CASE.replacen(from, to, 1);
        // A long title is none of the faults.
        let case = if to == long { case.replace("[mesh]", "[mseh]") } else { case };
        refused_case(&case, words);
    }
    refused_case("", &["case.toml:1 `mesh`"]);
    refused_case("hello", &["case.toml:1", "`hello`"]);
}

#[test]
fn what_is_echoed_is_short_and_plain() {
    let long = "7".repeat(5000);
    for (from, to) in [
        ("\"1 mm\"", format!("\"{long} mms\"")),
        ("thickness", format!("\"{long}\"")),
        ("\"end\"", format!("\"{}\"", "ä".repeat(5000))),
        ("\"1 mm\"", "\"\\u001b[31m\\u202e mm\"".to_string()),
        ("[shell.strip]", "[shell.\"\\u001b[2Jstrip\\r\"]".to_string()),
        ("\"strip.msh\"", "\"\\u001b[2J.msh\"".to_string()),
    ] {
        let message = refused_case(&CASE.replacen(from, &to, 1), &[]);
        assert!(!message.contains(&"7".repeat(81)) && !message.contains(&"ä".repeat(81)), "{message}");
        assert!(!message.contains('\u{202e}'), "{message}");
    }
}

#[test]
fn one_mistake_is_one_fault() {
    let once = |case: &str, words: &[&str]| {
        let message = refused_case(case, words);
        assert_eq!(message.matches("found").count(), 1, "{message}");
    };
    // The name of a table was left out.
    once(&POINTS.replace("[contact.belt]", "[contact]"), &["case.toml:40 `contact.body`", "[contact.NAME]"]);
    once(
        &CASE.replace("[material.steel]", "[material]"),
        &["case.toml:8 `material.youngs_modulus`", "[material.NAME]"],
    );
    // A name that many ask for.
    let more: String = (0..30).map(|k| format!("[force.f{k}]\non = \"tip\"\nforce = [1, 0, 0]\n")).collect();
    once(&format!("{CASE}{more}"), &["case.toml:22 `force.f0.on`", "and 18 more places", "(end, strip)"]);
    // Two masters of the same nodes, a master of itself.
    let twice = "[point]\na = [0, 0, 0]\nb = [0, 1, 0]\n[rigid.a]\nmaster = \"a\"\nfollow = \"end\"\n\
                 [rigid.b]\nmaster = \"b\"\nfollow = \"end\"\n";
    let case = CASE.replace("[support.end]\non = \"end\"", twice);
    once(&case, &["`rigid.b.follow`", "already follow", "(`a`) by `rigid.a`"]);
    let own = "[rigid.a]\nmaster = \"a\"\nfollow = [\"a\"]\n";
    once(&format!("{POINTS}{own}"), &["`rigid.a.follow`", "the master itself, node 1 (`a`)"]);
}

#[test]
fn time_steps_that_no_computer_can_take_are_refused() {
    for step in ["1e-40", "1e-12"] {
        let case = POINTS.replace("duration = 1e-2", &format!("duration = {step}"));
        let case = case.replace("time_step = 1e-4", &format!("time_step = {step}"));
        refused_case(&case, &["`transient.time_step`", "so short that", "at least 1"]);
    }
}

#[test]
fn bytes_that_are_no_text_are_named_with_their_line() {
    let latin = |text: &str| text.chars().map(|c| c as u8).collect::<Vec<u8>>();
    let run = ["run", "case.toml", "--out", "out"];
    let title = latin(&CASE.replace("A strip", "Ein Blechstück"));
    refused(folder(&[("case.toml", &title)]).path(), &run, &["case.toml:1, column 21", "0xFC", "`ü`"]);
    let nul = CASE.replace("count = 2", "count = \0");
    refused(folder(&[("case.toml", nul.as_bytes())]).path(), &run, &["case.toml:20, column 9", "NUL"]);
    let utf16: Vec<u8> =
        std::iter::once(0xfeff).chain(CASE.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    // Text in UTF-16 is read; it lacks its mesh alone.
    refused(folder(&[("case.toml", &utf16)]).path(), &run, &["strip.msh: found no file there"]);
    let group = latin(&mesh().replace("\"end\"", "\"Ende über\""));
    let files: [(&str, &[u8]); 2] = [("case.toml", CASE.as_bytes()), ("strip.msh", &group)];
    refused(folder(&files).path(), &run, &["strip.msh:", ", column ", "0xFC"]);
    let table = format!("{CASE}[measured.test]\nfile = \"test.csv\"\nof = \"strip\"\n");
    let files: [(&str, &[u8]); 3] = [
        ("case.toml", table.as_bytes()),
        ("strip.msh", mesh().leak().as_bytes()),
        ("test.csv", b"frequency_hz\n1\xb5\n"),
    ];
    refused(folder(&files).path(), &run, &["test.csv:2, column 2", "0xB5"]);
    refused(
        folder(&[("search.toml", b"# \xe4\n")]).path(),
        &["search", "search.toml"],
        &["search.toml:1, column 3"],
    );
    let one = folder(&[]);
    std::fs::create_dir(one.path().join("one")).expect("a folder");
    std::fs::write(one.path().join("one/reference.toml"), b"\n\xe4").expect("a file");
    refused(one.path(), &["validate", "--from", "."], &["one/reference.toml:2, column 1", "0xE4"]);
    // A byte order mark and Windows line ends are fine.
    let windows = format!("\u{feff}{CASE}").replace('\n', "\r\n");
    let mesh = mesh().replace('\n', "\r\n");
    let files = folder(&[("case.toml", windows.as_bytes()), ("strip.msh", mesh.as_bytes())]);
    let output = stridor(files.path(), &["check", "case.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn wrong_commands_are_refused_with_advice() {
    let folder = folder(&[("case.toml", CASE.as_bytes()), ("strip.msh", mesh().as_bytes())]);
    let message = refused(folder.path(), &["new", "."], &["something there already", "another name"]);
    assert!(!message.contains("--force"), "`new` has no such flag: {message}");
    for (arguments, words) in [
        (&["chek", "case.toml"][..], &["chek", "check"][..]),
        (&["run"], &["<CASE>"]),
        (&["run", "case.toml", "--rezume"], &["--rezume", "--resume"]),
        (&["run", "."], &["found a folder", "stridor new"]),
        (&["run", "none.toml"], &["none.toml: found no file there", "stridor new"]),
        (&["check", "case.toml", "--threads", "0"], &["--threads", "1 to 1024"]),
        (&["mesh", "info", "case.toml"], &["case.toml", "a Gmsh mesh"]),
        (&["mesh", "info", "none.msh"], &["none.msh", "no file there"]),
        (&["mesh", "disc", "--out", "strip.msh"], &["something there already", "`--force` overwrites it"]),
        (&["mesh", "disc", "--out", "d.msh", "--size", "-3 mm"], &["-0.003"]),
        (&["mesh", "disc", "--out", "d.msh", "--size", "3"], &["without a unit"]),
        (&["mesh", "disc", "--out", "d.msh", "--hub-radius", "1 m"], &["hub_radius", "less than"]),
        (&["validate", "--from", "none"], &["none", "the folder of validation cases"]),
    ] {
        refused(folder.path(), arguments, words);
    }
}
