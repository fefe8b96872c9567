//! Sweeps and maps in parts: parts that are computed apart, at the same time, or again after a kill make the result of one run,
//! bit for bit; wrong ones are refused.

use crate::program::{CASE, command, folder_with, names, run, said};
use crate::sweeps::{SWEEPS, disc, found};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};
use stridor::linalg::c64;
use stridor::results::record::{Entry, entries, to_bytes};

/// Two modes that part, and the line on which they do, by whole analyses.
const TWO_MODES: &str = r#"
[sweep.spring]
parameter = "spring.kt.stiffness"
from = "0.3 N/m"
to = "0.7 N/m"
points = 9

[map.plane]
parameters = ["spring.kt.stiffness", "contact.belt.friction.mu0"]
from = ["0.3 N/m", 0.1]
to = ["0.7 N/m", 0.8]
points = [7, 6]
"#;

/// The block of Rusli et al. (2020), unstable as it is.
fn block() -> String {
    let case = include_str!("../../validation/two-dof/case.toml");
    let unstable = case.replace("mu0 = 0.4 ", "mu0 = 0.7 ");
    assert!(unstable != case);
    unstable + TWO_MODES
}

/// `stridor sweep case.toml` with results in `out` and these arguments; what it prints on stderr, where the exit code is `code`.
#[track_caller]
fn sweep(at: &Path, out: &str, arguments: &[&str], code: i32) -> String {
    let arguments = [&["sweep", "case.toml", "--quiet", "--out", out], arguments].concat();
    said(&run(&mut command(at, &arguments)), code)
}

fn start(at: &Path, out: &str, part: &str) -> Child {
    let mut part = command(at, &["sweep", "case.toml", "--quiet", "--out", out, "--part", part]);
    part.stderr(Stdio::inherit()).spawn().expect("the binary runs")
}

fn read(path: &Path) -> Vec<Entry> {
    entries(path).expect("a part")
}

/// The studies of the answers of a part.
fn studies(part: &[Entry]) -> Vec<&str> {
    let mut all = Vec::new();
    for entry in part {
        if let Entry::Answer { study, .. } = entry {
            all.push(study.as_str());
        }
    }
    all
}

fn count(part: &[Entry]) -> usize {
    studies(part).len()
}

/// The lowest place of a sweep that has an answer.
fn lowest_place(part: &[Entry], sweep: &str) -> Vec<u64> {
    let places = part.iter().filter_map(|entry| match entry {
        Entry::Answer { study, place, .. } if study == sweep => Some(place),
        _ => None,
    });
    places.min().expect("an answer").clone()
}

/// λ of the first mode at a place of a sweep.
fn first_eigenvalue<'a>(part: &'a mut [Entry], sweep: &str, at: &[u64]) -> &'a mut c64 {
    let modes = part.iter_mut().find_map(|entry| match entry {
        Entry::Answer { study, place, modes } if study == sweep && place == at => Some(modes),
        _ => None,
    });
    &mut modes.expect("an answer").as_mut().expect("modes").eigenvalues[0]
}

#[test]
fn parts_computed_apart_make_the_result_of_one_run() {
    let folder = folder_with(&disc());
    let at = folder.path();
    sweep(at, "whole", &[], 0);
    let whole = found(&at.join("whole"));
    let warnings = whole.1["warnings"].to_string();
    let counted = |name: &str| warnings.contains(&format!("`{name}` leaves out "));
    assert!(counted("map.gap") && counted("sweep.gap"), "{warnings}");
    let pictures = whole.2.iter().filter(|(name, _)| name.ends_with(".svg")).count();
    assert!(whole.0.len() > 40 && pictures >= 3, "{} arrays, {pictures} pictures", whole.0.len());
    // Two at the same time in one folder, the third elsewhere.
    let both = ["1/3", "2/3"].map(|part| start(at, "out", part));
    both.into_iter().for_each(|mut part| assert!(part.wait().expect("it ends").success()));
    sweep(at, "elsewhere", &["--part", "3/3"], 0);
    assert_eq!(names(&at.join("elsewhere")), ["parts"]);
    let place = |out: &str, part: &str| at.join(out).join("parts/sweep").join(part);
    std::fs::copy(place("elsewhere", "3-of-3.bin"), place("out", "3-of-3.bin")).expect("it is copied");
    assert_eq!(names(&at.join("out/parts/sweep")), ["1-of-3.bin", "2-of-3.bin", "3-of-3.bin"]);
    let mut first = read(&place("out", "1-of-3.bin"));
    let tables: BTreeSet<&str> = studies(&first).into_iter().collect();
    assert_eq!(
        Vec::from_iter(tables),
        ["map.gap", "map.m", "sweep.friction", "sweep.gap", "sweep.thickness"]
    );
    // More than its two points: what is looked for between them, too.
    assert!(studies(&first).iter().filter(|study| **study == "sweep.thickness").count() > 2);
    sweep(at, "out", &["--merge"], 0);
    assert!(found(&at.join("out")) == whole, "the merged result is another one");
    assert!(names(&at.join("out")).contains(&"report.html".to_string()));
    // The parts are used, not computed again.
    let lowest = lowest_place(&first, "sweep.friction");
    first_eigenvalue(&mut first, "sweep.friction", &lowest).re += 1e-3;
    std::fs::write(place("out", "1-of-3.bin"), to_bytes(&first)).expect("it is written");
    sweep(at, "out", &["--merge"], 0);
    let altered = found(&at.join("out"));
    let differ = whole.0.iter().zip(&altered.0).filter(|(a, b)| a != b).map(|((name, _), _)| name.as_str());
    let differ: Vec<&str> = differ.collect();
    assert!(!differ.is_empty() && differ.iter().all(|name| name.contains("/friction/")), "{differ:?}");
}

#[test]
fn there_may_be_more_parts_than_a_case_can_be_cut_into() {
    let folder = folder_with(&block());
    let at = folder.path();
    sweep(at, "whole", &[], 0);
    let whole = found(&at.join("whole"));
    assert_eq!(whole.1["sweeps"][0]["critical"].as_array().map(Vec::len), Some(1));
    assert!(whole.1["maps"][0]["boundary_lines"].as_u64() > Some(0));
    // Eight intervals of the sweep, thirty cells of the map.
    for number in 1..=38 {
        sweep(at, "out", &["--part", &format!("{number}/40")], 0);
    }
    let empty = run(&mut command(at, &["sweep", "case.toml", "--out", "out", "--part", "39/40"]));
    said(&empty, 0);
    let printed = String::from_utf8_lossy(&empty.stdout);
    assert!(printed.contains("part 39 of 40 has none"), "{printed}");
    assert_eq!(names(&at.join("out/parts/sweep")).len(), 38);
    sweep(at, "out", &["--merge"], 0);
    assert!(found(&at.join("out")) == whole);
}

#[test]
fn a_part_that_was_killed_is_named_and_resumes() {
    let folder = folder_with(&block().replace("points = 9", "points = 8001"));
    let (at, file) = (folder.path(), folder.path().join("out/parts/sweep/1-of-2.bin"));
    let mut part = start(at, "out", "1/2");
    let began = Instant::now();
    while !(file.exists() && count(&read(&file)) > 0) && began.elapsed() < Duration::from_secs(100) {
        std::thread::sleep(Duration::from_millis(1));
    }
    let twice = sweep(at, "out", &["--part", "1/2"], 1);
    assert!(twice.contains(&format!("part 1 of 2 is in use by process {}", part.id())), "{twice}");
    part.kill().expect("it can be killed");
    part.wait().expect("it ends");
    let mut left = read(&file);
    // Half the intervals of the sweep; of the map 4 times 6 points.
    let all = 4001 + 24;
    assert!((1..4001).contains(&count(&left)), "{} of {all} points", count(&left));
    let unfinished = sweep(at, "out", &["--merge"], 2);
    let lacks = format!("not done: part 1 lacks {} of its {all} points", all - count(&left));
    for words in
        [&lacks, "of 2 parts these are missing: 2", "Compute 1-2 of 2 with --part", "out/parts/sweep:"]
    {
        assert!(unfinished.contains(words), "{unfinished}");
    }
    assert_eq!(names(&at.join("out")), ["parts"]);
    // What it had is not computed again.
    // Threads may have left lower places for later.
    let place = lowest_place(&left, "sweep.spring");
    let before = *first_eigenvalue(&mut left, "sweep.spring", &place);
    first_eigenvalue(&mut left, "sweep.spring", &place).re += 1e-12;
    std::fs::write(&file, to_bytes(&left)).expect("it is written");
    sweep(at, "out", &["--part", "1/2"], 0);
    let mut done = read(&file);
    assert!(count(&done) >= all && matches!(done.last(), Some(Entry::End)));
    assert_eq!(*first_eigenvalue(&mut done, "sweep.spring", &place), before + 1e-12);
    *first_eigenvalue(&mut done, "sweep.spring", &place) = before;
    std::fs::write(&file, to_bytes(&done)).expect("it is written");
    let second = sweep(at, "out", &["--merge"], 2);
    assert!(second.contains("missing: 2;") && second.contains("Compute 2 of 2"), "{second}");
    sweep(at, "out", &["--part", "2/2"], 0);
    sweep(at, "out", &["--merge"], 0);
    sweep(at, "whole", &[], 0);
    assert!(found(&at.join("out")) == found(&at.join("whole")));
}

#[test]
fn wrong_parts_are_refused_and_nothing_is_written() {
    let folder = folder_with(&block());
    let at = folder.path();
    for wrong in ["0/40", "41/40", "x", "3", "3/0", "1/2/3", "-1/4", "/4", ""] {
        let message = sweep(at, "out", &[&format!("--part={wrong}")], 2);
        assert!(message.contains("--part") && message.contains("1/40 to 40/40"), "{wrong}: {message}");
    }
    let pairs: [&[&str]; 3] =
        [&["--part", "1/2", "--merge"], &["--part", "1/2", "--resume"], &["--merge", "--resume"]];
    for pair in pairs {
        assert!(sweep(at, "out", pair, 2).contains("cannot be used with"), "{pair:?}");
    }
    let message = said(&run(&mut command(at, &["cea", "case.toml", "--part", "1/2"])), 2);
    assert!(message.contains("unexpected argument '--part'"), "{message}");
    let message = sweep(at, "out", &["--merge"], 2);
    assert!(
        message.contains("out/parts/sweep: found no part") && message.contains("--part 1/40"),
        "{message}"
    );
    std::fs::write(at.join("case.toml"), block().replace(TWO_MODES, "")).expect("a case");
    for arguments in [["--part", "1/2"].as_slice(), &["--merge"]] {
        let message = sweep(at, "out", arguments, 2);
        assert!(message.contains("`sweep`") && message.contains("[sweep.mu]"), "{message}");
    }
    assert_eq!(names(at), ["case.toml"]);
}

#[test]
fn parts_of_something_else_are_refused_and_nothing_is_written() {
    let (head, tail) = CASE.split_once("[mesh.annulus]").expect("a mesh");
    let (_, tail) = tail.split_once("[material.steel]").expect("a material");
    let (tail, _) = tail.split_once("[map.m]").expect("a map");
    let gap = SWEEPS.split_once("[map.gap]").expect("a map").1;
    let case = format!(
        "{head}[mesh]\nfile = \"disc.msh\"\nunit = \"mm\"\n[material.steel]{tail}[map.gap]{gap}\
         [sweep.friction]\nparameter = \"contact.pin.friction.mu0\"\nfrom = 0\nto = 1\npoints = 3\n"
    );
    let folder = folder_with(&case);
    let (at, parts) = (folder.path(), folder.path().join("out/parts/sweep"));
    let mesh = |size: &str| {
        let arguments =
            ["mesh", "disc", "--out", "disc.msh", "--force", "--size", size, "--contact-size", "10 mm"];
        said(&run(&mut command(at, &arguments)), 0);
    };
    mesh("30 mm");
    sweep(at, "out", &["--part", "1/2"], 0);
    sweep(at, "out", &["--part", "2/2"], 0);
    let refused = |arguments: &[&str], words: &[&str]| {
        let message = sweep(at, "out", arguments, 2);
        assert!(words.iter().all(|word| message.contains(word)), "{arguments:?}: {message}");
        assert_eq!(names(&at.join("out")), ["parts"], "{arguments:?}");
        assert_eq!(names(&parts), ["1-of-2.bin", "2-of-2.bin"], "{arguments:?}");
    };
    refused(&["--part", "1/3"], &["1-of-2.bin: found part 1 of 2", "expected parts of 3"]);
    std::fs::write(at.join("case.toml"), case.replace("mu0 = 0.3", "mu0 = 0.4")).expect("a case");
    let other =
        ["results of another case", "`contact.pin.friction.mu0` was `0.3` and is `0.4`", "Delete the parts"];
    [["--merge"].as_slice(), &["--part", "1/2"]].iter().for_each(|arguments| refused(arguments, &other));
    std::fs::write(at.join("case.toml"), &case).expect("a case");
    mesh("12 mm");
    let other = ["results of other files", "`disc.msh` has changed"];
    [["--merge"].as_slice(), &["--part", "2/2"]].iter().for_each(|arguments| refused(arguments, &other));
    mesh("30 mm");
    let path = parts.join("1-of-2.bin");
    let whole = std::fs::read(&path).expect("a part");
    let head = to_bytes(&read(&path)[..1]).len();
    for k in (0..whole.len()).step_by(whole.len() / 7) {
        let mut damaged = whole.clone();
        damaged[k] ^= 1;
        std::fs::write(&path, damaged).expect("it is written");
        // Without its head nothing is known of a part; otherwise what is before the damage counts.
        if k < head {
            refused(&["--merge"], &["1-of-2.bin", "Delete the file and compute the part again"]);
            refused(&["--part", "1/2"], &["1-of-2.bin", "Delete the file"]);
        } else {
            refused(&["--merge"], &["not done: part 1 lacks", "resumes where it stopped"]);
        }
    }
    std::fs::write(&path, &whole[..whole.len() / 2]).expect("it is written");
    refused(&["--merge"], &["not done: part 1 lacks", "resumes where it stopped"]);
    sweep(at, "out", &["--part", "1/2"], 0);
    let completed = count(&read(&path));
    std::fs::write(&path, &whole).expect("it is written");
    assert_eq!(completed, count(&read(&path)));
    std::fs::copy(parts.join("2-of-2.bin"), &path).expect("it is copied");
    refused(&["--merge"], &["1-of-2.bin", "another part"]);
    std::fs::write(&path, &whole).expect("it is written");
    let original = read(&path);
    let mut earlier = original.clone();
    let Entry::Head(head) = &mut earlier[0] else { panic!("a head") };
    head.program = "0.0.1 (0123456789ab)".into();
    std::fs::write(&path, to_bytes(&earlier)).expect("it is written");
    refused(&["--merge"], &["1-of-2.bin", "0.0.1 (0123456789ab)"]);
    let mut elsewhere = original;
    elsewhere.iter_mut().for_each(|entry| {
        if let Entry::Reference(digest) = entry {
            *digest = [1; 32];
        }
    });
    std::fs::write(&path, to_bytes(&elsewhere)).expect("it is written");
    refused(&["--merge"], &["1-of-2.bin", "processors of one type"]);
    assert!(matches!(elsewhere.pop(), Some(Entry::End)));
    std::fs::write(&path, to_bytes(&elsewhere)).expect("it is written");
    refused(&["--part", "1/2"], &["1-of-2.bin", "processors of one type"]);
    refused(&["--merge"], &["not done: part 1 lacks places between its points", "Compute 1 of 2"]);
    std::fs::write(&path, &whole).expect("it is written");
    sweep(at, "out", &["--merge"], 0);
}
