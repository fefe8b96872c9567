//! The stiffness of the preload, in what is analysed with it and without.

use crate::program::{folder_with, said};
use crate::small_rig::{stridor, text};
use std::f64::consts::PI;
use stridor::bounds::{Origin::*, within};
use stridor::linalg::random::Random;

/// A strip of 200 mm × 20 mm × 2 mm, hinged at both ends and pressed along by `force` \[N\].
fn column(force: f64, more: &str) -> String {
    format!(
        r#"
prestress = true
mesh.plate = {{ length = "200 mm", width = "20 mm", cells_along = 24, cells_across = 3 }}
[material.steel]
youngs_modulus = "200 GPa"
poissons_ratio = 0
density = "7850 kg/m^3"
[shell.plate]
material = "steel"
thickness = "2 mm"
[support.left]
on = "plate_edge_x_min"
held = ["ux", "uy", "uz"]
[support.right]
on = "plate_edge_x_max"
held = ["uy", "uz"]
[force.press]
on = "plate_edge_x_max"
force = [{force:?}, 0, 0]
[damping]
modal_ratio = 0.01
[modes.all]
count = 1
[frf.tap]
band = [5, 300]
excitation = {{ at = [0, 0, 0], direction = [0, 0, 1] }}
{more}"#
    )
}

/// f² = f₁² (1 − P/P_cr) of hinged columns under loads of any size, f₁ = π/(2L²) √(EI/ρA), P_cr = π² EI/L² (Timoshenko, Vibration Problems
/// in Engineering): real modes and resonances of a case without contacts have it, and beyond buckling ω² < 0 is said.
#[test]
fn columns_under_load_have_the_frequencies_of_theory() {
    let (length, area, bending) = (0.2, 20e-3 * 2e-3, 200e9 * 20e-3 * 2e-3f64.powi(3) / 12.0);
    let first = PI / (2.0 * length * length) * (bending / (7850.0 * area)).sqrt();
    let buckling = PI * PI * bending / (length * length);
    let mut random = Random::seeded(5);
    for member in 0..6 {
        let share = if member % 3 == 2 { random.between(1.1, 3.0) } else { random.between(-1.5, 0.9) };
        let folder = folder_with(&column(-share * buckling, ""));
        let output = stridor(folder.path(), &["run", "case.toml", "--out", "out"]);
        said(&output, 0);
        let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("a summary");
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        let words = text(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
        let beyond = share > 1.0;
        assert_eq!(summary["mode_sets"][0]["negative"], i64::from(beyond), "{share}: {words}");
        assert_eq!(words.contains("ω² < 0"), beyond, "{share}: {words}");
        let of_theory = first * first * (1.0 - share);
        let square = if beyond {
            let rate = words.split("σ up to ").nth(1).and_then(|rest| rest.split(' ').next());
            let rate: f64 = rate.and_then(|number| number.parse().ok()).expect("a rate");
            -(rate / (2.0 * PI)).powi(2)
        } else {
            let table = std::fs::read_to_string(folder.path().join("out/modes_all.csv")).expect("a table");
            let column =
                table.lines().next().expect("a heading").split(',').position(|c| c.contains("frequency"));
            let cell = table.lines().nth(1).and_then(|row| row.split(',').nth(column?));
            let hz: f64 = cell.and_then(|cell| cell.parse().ok()).expect("a frequency");
            // The resonance of the response is the same mode.
            assert!(words.contains(&format!("plate {hz:.0} Hz")), "{hz} {words}");
            hz * hz
        };
        // 24 elements along: (π h/L)²/12 of first order, of the bending and of the load.
        let bound = 3e-3 * (1.0 + share.abs()) * first * first;
        assert!(within((square - of_theory).abs(), bound, Discretisation), "{share}: {square} {of_theory}");
    }
}

/// With contacts the preload is theirs, and an analysis of open ones says that it does not have it.
#[test]
fn open_contacts_have_no_preload_and_say_so() {
    let contact = |state: &str, sliding: &str| {
        let more = "[contact.pin]\nbody = \"plate_edge_y_min\"\ncounter = \"ground\"\ninto = [0, 0, -1]\nload = 10\n\
                    sliding_velocity = 1\nsliding_direction = [1, 0, 0]\nnormal = { per = \"point\", stiffness = 1e6 }\n\
                    friction = { law = \"coulomb\", mu0 = 0.1 }\n";
        column(-100.0, more)
            .replace("count = 1", &format!("count = 1\ncontact = \"{state}\""))
            .replace("band = [5, 300]", &format!("band = [5, 300]\ncontact = \"{sliding}\""))
    };
    for (state, sliding) in [("open", "open"), ("closed", "open"), ("open", "sliding"), ("closed", "sliding")]
    {
        let folder = folder_with(&contact(state, sliding));
        let output = stridor(folder.path(), &["check", "case.toml"]);
        let words = [text(&output.stdout), text(&output.stderr)].concat();
        let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
        said(&output, 0);
        assert_eq!(
            words.contains("modes.all is of open contacts"),
            state == "open",
            "{state} {sliding} {words}"
        );
        assert_eq!(
            words.contains("frf.tap is of open contacts"),
            sliding == "open",
            "{state} {sliding} {words}"
        );
    }
}

/// Modes of parts by themselves, or held in another way, are not those of the stressed structure.
#[test]
fn modes_of_other_supports_have_no_preload_and_say_so() {
    let sets = ["count = 1", "count = 7\nfree = true", "count = 1\nclamp = [\"plate_edge_y_min\"]"];
    for (set, without) in sets.iter().zip([false, true, true]) {
        let folder = folder_with(&column(-100.0, "").replace("count = 1", set));
        let output = stridor(folder.path(), &["check", "case.toml"]);
        let words = [text(&output.stdout), text(&output.stderr)].concat();
        let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
        said(&output, 0);
        assert_eq!(words.contains("`prestress` does not act on it"), without, "{set}: {words}");
    }
}
