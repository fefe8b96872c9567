//! The program on a small rig in a temporary folder.

use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

/// A small rig that needs no file beside it.
pub const RIG: &str = r#"
title = "A small rig"
assumptions = ["Everything here is made up."]

[mesh.rig]
hub_radius = "20 mm"
contact_size = "2 mm"
contact_radius = "4 mm"
disc_size = "12 mm"
slider_size = "20 mm"

[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = 7850

[shell.disc]
material = "steel"
thickness = "1 mm"

[shell.slider]
material = "steel"
thickness = "10 mm"

[bar.bar]
material = "steel"
diameter = "20 mm"

[rigid.hub]
master = "bar_root"
follow = "hub"

[support.clamp]
on = "bar_clamp"

[support.guides]
on = ["slider_edge_y_min", "slider_edge_y_max"]
held = ["uy", "uz"]

[spring.drive]
on = "slider_edge_x_min"
direction = [1, 0, 0]
stiffness = "10 MN/m"

[contact.rim]
body = "rim"
counter = "slider"
load = "20 N"
sliding_velocity = "0.5 m/s"
placement = { lead_angle = "4 deg" }
normal = { per = "length", stiffness = "10 GN/m^2" }
friction = { law = "coulomb", mu0 = 0.4 }

[modes.disc]
parts = ["disc"]
clamp = ["hub"]
below = "1 kHz"
measured = [330, 936]
measured_source = "made up"

[cea]
band = [0, "1.5 kHz"]
"#;

pub fn stridor(folder: &Path, arguments: &[&str]) -> Output {
    crate::program::command(folder, arguments).output().expect("the binary runs")
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

pub fn folder_with(case: &str) -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    std::fs::write(folder.path().join("rig.toml"), case).expect("a case file");
    folder
}

/// Runs the case and expects a refusal: the exit code, and words that the message must have.
pub fn refused(folder: &TempDir, code: i32, words: &[&str]) {
    let output = stridor(folder.path(), &["run", "rig.toml", "--out", "out"]);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{message}");
    assert!(message.starts_with("error: "), "{message}");
    for word in words {
        assert!(message.contains(word), "\"{word}\" is not in: {message}");
    }
    assert!(output.stdout.is_empty(), "{}", text(&output.stdout));
    if code == 2 {
        assert!(!folder.path().join("out").exists(), "nothing is written when the input is wrong");
    }
}
