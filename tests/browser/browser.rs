//! `report.html` in headless Chromium: on wide and narrow screens, light and dark, and on paper; the shapes move, the sound
//! decodes, charts show values. `.ci/browser` installs the browser and runs these tests.

use crate::program::command;
use crate::python;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use stridor::bounds::{Origin::*, within};

const PROGRAMS: [&str; 2] = ["/usr/bin/chromium", "/usr/bin/chromium-browser"];

/// The page of a validation case, written once.
fn page(case: &str) -> PathBuf {
    static PAGES: [OnceLock<()>; 2] = [const { OnceLock::new() }; 2];
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("browser").join(case);
    let at = usize::from(case == SOUND);
    PAGES[at].get_or_init(|| {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation").join(case).join("case.toml");
        std::fs::create_dir_all(&out).unwrap();
        let (file, folder) = (file.to_string_lossy(), out.to_string_lossy());
        let done = command(&out, &["run", &file, "--out", &folder, "--quiet"]).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    });
    out.join("report.html")
}

const RIG: &str = "rig";
const SOUND: &str = "sound-piston";

/// What `browser/measure.py` says of a page.
fn measure(case: &str, what: &str) -> Value {
    static PYTHON: OnceLock<PathBuf> = OnceLock::new();
    let python = PYTHON.get_or_init(|| python::with(&[("playwright", "1.65.2")]));
    let chromium =
        PROGRAMS.iter().find(|p| Path::new(p).exists()).expect("Chromium: .ci/browser installs it");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/measure.py");
    let done = Command::new(python).arg(script).arg(chromium).arg(page(case)).arg(what).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let found: Value = serde_json::from_slice(&done.stdout).unwrap();
    if let Some(log) = found.get("log") {
        assert_eq!(log, &serde_json::json!([]), "{case} {what}: messages");
    }
    found
}

/// Every list of faults is empty.
fn faultless(case: &str, what: &str) {
    let found = measure(case, what);
    let faults: Vec<String> = found
        .as_object()
        .unwrap()
        .iter()
        .flat_map(|(at, lists)| lists.as_object().unwrap().iter().map(move |(kind, list)| (at, kind, list)))
        .filter(|(_, _, list)| !list.as_array().unwrap().is_empty())
        .map(|(at, kind, list)| format!("{at}: {kind} {list:#}"))
        .collect();
    assert!(!found.as_object().unwrap().is_empty() && faults.is_empty(), "{case}\n{}", faults.join("\n"));
}

#[test]
#[ignore = "needs Chromium; .ci/browser runs it"]
fn pages_are_whole_on_wide_and_narrow_screens_light_and_dark() {
    [RIG, SOUND].iter().for_each(|case| faultless(case, "screens"));
}

#[test]
#[ignore = "needs Chromium; .ci/browser runs it"]
fn pages_are_whole_on_paper() {
    [RIG, SOUND].iter().for_each(|case| faultless(case, "paper"));
}

#[test]
#[ignore = "needs Chromium; .ci/browser runs it"]
fn shapes_move_and_follow_their_controls() {
    let found = measure(RIG, "motion");
    assert!(found["plays"] == true && found["pauses"] == true, "{found:#}");
    assert!(found["colours"].as_u64().unwrap() > 100, "{found:#}");
    assert!(found["changed"].as_object().unwrap().values().all(|changed| changed == true), "{found:#}");
    let summary = std::fs::read_to_string(page(RIG).with_file_name("summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let unstable =
        summary["cea"]["eigenvalues"].as_array().unwrap().iter().filter(|m| m["unstable"] == true).count();
    let listed = found["modes"].as_array().unwrap();
    let marked = listed.iter().filter(|name| name.as_str().unwrap().ends_with("unstable")).count();
    assert!(marked == unstable && !listed.is_empty(), "{unstable} {found:#}");
}

#[test]
#[ignore = "needs Chromium; .ci/browser runs it"]
fn without_webgl_there_is_a_still_picture_and_a_sentence() {
    let found = measure(RIG, "still");
    assert!(
        found["note"].as_str().unwrap().contains("a still picture")
            && found["colours"].as_u64().unwrap() > 20,
        "{found:#}"
    );
}

#[test]
#[ignore = "needs Chromium; .ci/browser runs it"]
fn the_sound_decodes_and_plays() {
    let found = measure(SOUND, "sound");
    let names = found["microphones"].as_array().unwrap();
    assert!(
        names.len() == 3 && names.iter().all(|name| name.as_str().unwrap().ends_with(" dB(A)")),
        "{found:#}"
    );
    let recordings = found["found"].as_array().unwrap();
    for one in recordings {
        let number = |key: &str| one[key].as_f64().unwrap();
        assert!(
            number("decoded") > 0.1 && within((number("decoded") - number("player")).abs(), 1e-3, Reference),
            "{one:#}"
        );
        assert!((0.5..=1.0).contains(&number("peak")) && number("position") > 0.0, "{one:#}");
    }
    // In front of the plate and behind it the pressure is opposite.
    assert!(recordings[0]["head"] != recordings[1]["head"] && recordings[1]["head"] != recordings[2]["head"]);
}

#[test]
#[ignore = "needs Chromium; .ci/browser runs it"]
fn the_motion_in_time_moves_and_says_when() {
    let found = measure(SOUND, "in_time");
    assert!(
        found["set"] == "motion in time" && found["differ"] == true && found["plays"] == true,
        "{found:#}"
    );
    assert!(found["name"].as_str().unwrap().contains("largest displacement 1.000 µm"), "{found:#}");
    // A quarter of a period of 273 Hz from one to the next, the last period of a run of 0.4 s.
    let time = |k: usize| -> f64 {
        let words = found["times"][k].as_str().unwrap();
        words.split(' ').rev().nth(1).unwrap().parse().unwrap()
    };
    assert!(within((time(0) - (400.0 - 1000.0 / 272.95)).abs(), 0.01, Reference), "{found:#}");
    for k in [1, 2] {
        assert!(within((time(k) - time(k - 1) - 250.0 / 272.95).abs(), 0.01, Reference), "{found:#}");
    }
    assert!(found["slower"][0] != found["slower"][1], "{found:#}");
}

#[test]
#[ignore = "needs Chromium; .ci/browser runs it"]
fn charts_show_the_values_under_the_pointer_and_zoom() {
    let found = measure(RIG, "charts");
    let points = found["points"].as_array().unwrap();
    // `mode 3: 1668.3 Hz, σ +1.2 1/s` and `frequency 1668.1 Hz · growth rate σ …`.
    let hertz =
        |words: &str, before: usize| -> f64 { words.split(' ').nth(before).unwrap().parse().unwrap() };
    for point in points {
        let [title, readout] = [0, 1].map(|k| point[k].as_str().unwrap());
        let (given, read) = (hertz(title, 2), hertz(readout, 1));
        // The readout is in whole hertz, of a mark at a hundredth of a pixel: 0.04 Hz on an axis of 3 kHz over 800 pixels.
        assert!(within((given - read).abs(), 1.0, Reference), "{title} | {readout}");
    }
    assert!(
        !points.is_empty() && found["zoomed"] != found["home"] && found["reset"] == found["home"],
        "{found:#}"
    );
}
