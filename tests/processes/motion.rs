//! What a run in time says of forces beyond the load and of plates that bend by more than their thickness, beside its own record.

use crate::program::{CASE, folder_with, said};
use crate::small_rig::{stridor, text};
use stridor::bounds::{Origin::*, within};
use stridor::linalg::random::Random;
use stridor::numbers::significant;

/// The disc pressed on a pin by `load` \[N\], with a blow of `force` \[N\] along x on its rim; further keys of the run in time.
fn pressed(load: f64, force: f64, keys: &str) -> String {
    let begin = CASE.find("[map.m]").expect("a map");
    let end = CASE.find("[transient]").expect("a run in time");
    let text = format!("{}{}", &CASE[..begin], &CASE[end..]);
    text.replace("approach = \"1 um\"", &format!("load = {load:?}"))
        .replace("\"-50 N\"", &format!("{force:?}"))
        .replace("fields_every = \"1 ms\"", keys)
        + "probe.middle = { at = [0, 0, \"45 mm\"], direction = [1, 0, 0] }\n\
           probe.side = { at = [0, \"53.033 mm\", \"53.033 mm\"], direction = [1, 0, 0] }\n\
           probe.between = { at = [0, \"31.8198 mm\", \"31.8198 mm\"], direction = [1, 0, 0] }\n"
}

/// The columns of `transient.csv` whose names begin so.
fn columns<const N: usize>(table: &str, names: [&str; N]) -> [Vec<f64>; N] {
    let mut lines = table.lines();
    let heading: Vec<&str> = lines.next().expect("a heading").split(',').collect();
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()).collect();
    names.map(|name| {
        let k = heading.iter().position(|column| column.starts_with(name)).expect("a column");
        rows.iter().map(|row| row[k]).collect()
    })
}

/// Blows of random sizes towards the pin and away from it: the greatest ΣN and the greatest deflection are those of the record, the
/// warnings come where they exceed twice the load and the thickness, and not elsewhere.
#[test]
fn forces_beyond_the_load_and_large_deflections_are_named() {
    let mut random = Random::seeded(4);
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0f64, f64::max);
    let (mut beyond, mut bent, mut plain) = (0, 0, 0);
    for member in 0..24 {
        let load = [0.5, 1.0, 3.0][member % 3];
        let size = 10f64.powf(random.between(-0.5, 3.0));
        let force = if member % 4 == 3 { -size } else { size };
        // A load that runs in time is kept unless the case says otherwise, a constant one is not.
        let (hold, runs) =
            [(None, false), (Some("approach"), true), (None, true), (Some("load"), false)][member / 3 % 4];
        let keeps_load = hold == Some("load") || hold.is_none() && runs;
        let keys = [
            hold.map_or(String::new(), |hold| format!("hold = \"{hold}\"\n")),
            String::from(if runs {
                "load.pin = { motion = \"ramp\", from = 0.5, duration = \"1 ms\" }"
            } else {
                ""
            }),
        ]
        .concat();
        let folder = folder_with(&pressed(load, force, &keys));
        let output = stridor(folder.path(), &["transient", "case.toml", "--out", "out"]);
        said(&output, 0);
        // Tables are as wide as the window, words as lines.
        let words = text(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
        let table = std::fs::read_to_string(folder.path().join("out/transient.csv")).expect("a table");
        let [normal, places @ ..] = columns(
            &table,
            [
                "pin_normal_force",
                "rim_displacement",
                "middle_displacement",
                "side_displacement",
                "between_displacement",
            ],
        );
        let most = largest(&mut normal.iter().copied());
        let context = format!("load {load}, force {force}, {keys}, N up to {most}: {words}");

        let most_shown = format!("in motion up to {} N", significant(most, 3));
        assert_eq!(words.contains("in motion up to"), most > 1.1 * load, "{context}");
        assert!(words.contains(&most_shown) == (most > 1.1 * load), "{context}");
        let warned = words.contains("its approach is kept in motion");
        assert_eq!(warned, !keeps_load && most > 2.0 * load, "{context}");
        if warned {
            let reaches = format!(
                "is closed by {} N at rest and reaches {} N in motion, {:.1} times as much",
                significant(load, 3),
                significant(most, 3),
                most / load
            );
            assert!(words.contains(&reaches), "{reaches} is not in {context}");
        }
        if keeps_load {
            // ΣN is the load in every step of 20 µs, to the accuracy of Newton's method.
            assert!(
                normal.iter().enumerate().all(|(step, force)| {
                    let factor = if runs { (0.5 + 0.01 * step as f64).min(1.0) } else { 1.0 };
                    within((force / (factor * load) - 1.0).abs(), 1e-6, Tolerance)
                }),
                "{context}"
            );
        }

        // Three rings of eight nodes, the inner one held; triangles that meet at every second radius make two motions of each ring.
        // The mean plane of a motion without nodal diameters is its mean.
        let deflection = largest(&mut (0..normal.len()).map(|row| {
            let w = [0, 1, 2, 3].map(|k: usize| places[k][row]);
            let mean = w.iter().sum::<f64>() / 6.0;
            w.iter().chain([&0.0]).fold(0.0f64, |most, w| most.max((w - mean).abs()))
        }));
        let bends = words.contains("In motion the plate disc bends by");
        assert_eq!(bends, deflection > 1e-3, "{deflection}: {context}");
        if bends {
            let after = words.split("In motion the plate disc bends by ").nth(1).expect("it is there");
            let shown: f64 =
                after.split(' ').next().and_then(|number| number.parse().ok()).expect("a number");
            // Three decimals of a millimetre are shown.
            assert!(within((1e-3 * shown - deflection).abs(), 1e-6, Reference), "{deflection}: {context}");
        }
        beyond += usize::from(warned);
        bent += usize::from(bends);
        plain += usize::from(!warned && !bends);
    }
    assert!(beyond >= 3 && bent >= 2 && plain >= 3, "{beyond} {bent} {plain}");
}
