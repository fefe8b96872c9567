use super::*;
use stridor_base::bounds::{Origin::*, within};
use stridor_base::universal::record;
use stridor_linalg::c64;

const SI: Unstated = Unstated { unit: 1.0, quantity: None };

/// Eleven lines of dataset 58: a response of point 3 along −y for a force at 1 along x.
fn header(kind: i64, count: usize, even: bool, unit: &str) -> String {
    let (first, step) = if even { (10.0, 2.5) } else { (0.0, 0.0) };
    let number = |v: f64| record::e_format(v, 13, 5);
    let mut text = record::text_line("hammer") + &record::text_line("NONE").repeat(4);
    text += &format!(
        "{:5}{:10}{:5}{:10} {:<10}{:10}{:4} {:<10}{:10}{:4}\n",
        4, 0, 0, 0, "NONE", 3, -2, "NONE", 1, 1
    );
    text += &format!(
        "{kind:10}{count:10}{:10}{}{}{}\n",
        i32::from(even),
        number(first),
        number(step),
        number(0.0)
    );
    let axis = |kind: i64, unit: &str| format!("{kind:10}{:5}{:5}{:5} {:<20} {unit:<20}\n", 0, 0, 0, "NONE");
    text + &axis(18, "Hz") + &axis(12, unit) + &axis(13, "N") + &axis(0, "NONE")
}

fn text_58(kind: i64, count: usize, even: bool, lines: &str) -> String {
    format!("    -1\n    58\n{}{lines}    -1\n", header(kind, count, even, "NONE"))
}

fn binary_58(kind: i64, count: usize, even: bool, big: bool, data: &[u8]) -> Vec<u8> {
    let order = if big { 2 } else { 1 };
    // The byte count of the header is wrong on purpose, as many writers have it.
    let name = format!("    58b{order:6}{:6}{:12}{:12}{:6}{:6}{:12}{:12}\n", 2, 11, 8 * count, 0, 0, 0, 0);
    let mut bytes = format!("    -1\n{name}{}", header(kind, count, even, "g")).into_bytes();
    bytes.extend(data);
    bytes.extend(b"    -1\n");
    bytes
}

const UNITS: &str = "    -1\n   164\n         5mm                           2\n 1.0000000000000000D+03 1.0000000000000000D+03 1.0D+00\n 2.7315D+02\n    -1\n";
const NODES: &str = "    -1\n  2411\n         1         0         0        11\n   1.5000000000000000D+01   0.0000000000000000D+00  -2.0000000000000000D+00\n         3         0         0        11\n   0.0D+00   7.5D+01   0.0D+00\n    -1\n";
const COMPLEX: &str = "    -1\n    55\nNONE\nNONE\nNONE\nNONE\nNONE\n         1         7         2         8         5         3\n         2         6         1         1\n -6.28319E+00  6.28287E+02  0.0  0.0  0.0  0.0\n         3\n  1.00000E+00  2.00000E+00  0.00000E+00  0.00000E+00 -3.00000E+00  4.00000E+00\n    -1\n";
const SIX: &str = "    -1\n    55\nNONE\nNONE\nNONE\nNONE\nNONE\n         1         2         3         8         2         6\n         2         4         1         1\n  5.00000E+01  1.00000E+00  0.00000E+00  4.00000E-02\n         1\n  1.00000E+00  2.00000E+00  3.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00\n    -1\n";

#[test]
fn modes_of_both_kinds_are_read() {
    let text = [UNITS, NODES, COMPLEX, SIX].concat();
    let records = read("t", text.as_bytes(), SI).unwrap();
    assert!(
        within((records.points[&1][0] - 0.015).abs(), 1e-15, RoundOff)
            && within((records.points[&3][1] - 0.075).abs(), 1e-15, RoundOff)
    );
    let [complex, six] = &records.modes[..] else { panic!("two modes") };
    // λ = −2π + 628.287 i: |λ| = 628.318, f = 100 Hz, ζ = 1 %.
    assert!(within((complex.frequency_hz - 100.0).abs(), 1e-3, Reference));
    assert!(within((complex.damping_ratio.unwrap() - 0.01).abs(), 1e-6, Reference));
    assert_eq!(complex.shape[&3], [c64::new(1.0, 2.0), c64::new(0.0, 0.0), c64::new(-3.0, 4.0)]);
    assert_eq!((six.frequency_hz, six.damping_ratio), (50.0, Some(0.02)));
    assert_eq!(six.shape[&1].map(|u| u.re), [1.0, 2.0, 3.0]);
}

#[test]
fn functions_in_text_are_read_in_every_form() {
    let values = |records: TestRecords| records.functions[0].clone();
    let of = |text: &str| values(read("t", text.as_bytes(), SI).unwrap());
    let even = of(&text_58(5, 2, true, "  1.00000E+00 -2.00000E+00  3.00000E+00  4.00000E+00\n"));
    assert_eq!(even.frequencies_hz, [10.0, 12.5]);
    assert_eq!(even.values, [c64::new(1.0, -2.0), c64::new(3.0, 4.0)]);
    assert_eq!((even.excitation, even.response), ((1, [1.0, 0.0, 0.0]), (3, [0.0, -1.0, 0.0])));
    assert_eq!((even.quantity, even.name.as_str()), (Quantity::Accelerance, "hammer, 3-y/1+x"));
    let uneven = of(&text_58(6, 1, false, "  5.00000E+00  1.500000000000E+00 -2.500000000000E+00\n"));
    assert_eq!((uneven.frequencies_hz[0], uneven.values[0]), (5.0, c64::new(1.5, -2.5)));
    let real =
        of(&text_58(4, 2, false, "  5.00000E+00  1.500000000000E+00  6.00000E+00 -2.500000000000E+00\n"));
    assert_eq!(real.values[1], c64::new(-2.5, 0.0));
    // In a file in mm and mN whose force is labelled N, numbers are (mm/s²)/N.
    let scaled = of(&(UNITS.to_string() + &text_58(2, 1, true, "  7.00000E+00\n")));
    assert!(within((scaled.values[0].re - 7e-3).abs(), 1e-15, RoundOff));
}

#[test]
fn binary_functions_are_read_in_both_orders_and_sizes() {
    let rows = [[5.0f64, 1.5, -2.5], [6.0, 0.25, 4.0]];
    let all = || rows.iter().flatten();
    let doubles: Vec<u8> = all().flat_map(|v| v.to_le_bytes()).collect();
    let big: Vec<u8> = all().flat_map(|v| v.to_be_bytes()).collect();
    let singles: Vec<u8> = all().flat_map(|v| (*v as f32).to_be_bytes()).collect();
    // An abscissa in single precision beside values in double precision.
    let mixed: Vec<u8> = rows
        .iter()
        .flat_map(|[x, re, im]| {
            [(*x as f32).to_le_bytes().to_vec(), re.to_le_bytes().to_vec(), im.to_le_bytes().to_vec()]
                .concat()
        })
        .collect();
    let cases = [(6, false, doubles), (6, true, big), (5, true, singles), (6, false, mixed)];
    for (kind, order, data) in cases {
        let bytes = binary_58(kind, 2, false, order, &data);
        let function = &read("t", &bytes, SI).unwrap().functions[0];
        assert_eq!(function.frequencies_hz, [5.0, 6.0]);
        // The label of the ordinate says g.
        let exact = 9.80665 * c64::new(1.5, -2.5);
        assert!(
            within((function.values[0] - exact).norm(), 1e-12, RoundOff)
                && function.values[1].im == 9.80665 * 4.0
        );
    }
}

#[test]
fn faults_name_the_line_and_what_is_wrong() {
    let no_file = read("t.uff", b"frequency\n330\n", SI).unwrap_err().to_string();
    assert!(no_file.contains("t.uff:1: found `frequency`"));
    // What is wrong costs itself.
    let said = |bytes: &[u8]| {
        let records = read("t.uff", bytes, SI).unwrap();
        assert!(records.modes.is_empty() && records.functions.is_empty());
        records.warnings.join("\n")
    };
    assert!(said(b"    -1\n    15\n").contains("does not end"));
    assert!(
        said(b"    -1\n    15\n         1         0         0         0  1.0 x 2.0\n    -1\n")
            .contains("t.uff:3")
    );
    assert!(said(SIX.replace("  3.00000E+00  9.0", "  9.0").as_bytes()).contains("dataset 55"));
    let short = said(text_58(5, 3, true, "  1.00000E+00\n").as_bytes());
    assert!(short.contains("found 1 numbers; expected 6"), "{short}");
    // A surplus line, anywhere, would shift every value behind it.
    let lines = ["  1.0 2.0 3.0 4.0 5.0 6.0", "  7.0 8.0 9.0 1.0 2.0 3.0", "  4.0 5.0 0.0 0.0 0.0 0.0"];
    let of = |lines: &[&str]| text_58(5, 7, true, &(lines.join("\n") + "\n"));
    assert_eq!(read("t.uff", of(&lines).as_bytes(), SI).unwrap().functions.len(), 1);
    for k in 0..3 {
        let mut more = lines.to_vec();
        more.insert(k, lines[k]);
        let text = said(of(&more).as_bytes());
        assert!(text.contains("t.uff:17") && text.contains("6 numbers beyond the 14"), "{text}");
    }
    let uneven = said(of(&[lines[0], " 1.0 2.0", lines[1], lines[2]]).as_bytes());
    assert!(uneven.contains("t.uff:15") && uneven.contains("2 numbers in a line"), "{uneven}");
    let node = "         3\n  1.00000E+00  2.00000E+00  0.00000E+00  0.00000E+00 -3.00000E+00  4.00000E+00\n";
    let again = COMPLEX.replace(node, &(node.to_string() + &node.replace("3.0", "4.0")));
    assert!(said(again.as_bytes()).contains("node 3 again"), "{again}");
    let falling = said(text_58(4, 3, false, " 6.0 1.0 5.0 1.0 7.0 1.0\n").as_bytes());
    assert!(falling.contains("neither rise nor fall"), "{falling}");
    let cut = said(&binary_58(6, 2, false, false, &[0; 9]));
    assert!(cut.contains("byte") && cut.contains("58b"), "{cut}");
    let twice = said([NODES, &NODES.replace("7.5D+01", "7.6D+01")].concat().as_bytes());
    assert!(twice.contains("point 3 again") && twice.contains("t.uff:12"), "{twice}");
    // What is of no interest is skipped by name.
    let other = "    -1\n  2412\n   1 2 3\n    -1\n".to_string()
        + &text_58(2, 1, true, " 1.0\n").replace("    4    ", "    6    ");
    let records = read("t", other.as_bytes(), SI).unwrap();
    assert!(records.warnings.iter().any(|w| w.contains("dataset 2412")), "{:?}", records.warnings);
    let bare = read("t", text_58(2, 1, true, " 1.0\n").as_bytes(), SI).unwrap();
    assert!(bare.warnings[0].contains("1 frequency responses do not state"), "{:?}", bare.warnings);
}

#[test]
fn no_bytes_make_it_panic() {
    let data: Vec<u8> = [5.0f64, 1.5, -2.5].iter().flat_map(|v| v.to_le_bytes()).collect();
    let mut bytes = [UNITS, NODES, COMPLEX, SIX].concat().into_bytes();
    bytes.extend(text_58(6, 1, false, "  5.00000E+00  1.500000000000E+00 -2.500000000000E+00\n").as_bytes());
    bytes.extend(binary_58(6, 1, false, false, &data));
    let (set, warnings) = read("t", &bytes, SI).unwrap().into_set();
    assert!(set.frfs.len() == 2 && set.modes.len() == 2 && warnings.is_empty(), "{warnings:?}");
    let mut refused = 0;
    let mut survives = |bytes: &[u8]| match read("t", bytes, SI) {
        Ok(records) => refused += usize::from(!records.into_set().1.is_empty()),
        Err(_) => refused += 1,
    };
    (0..bytes.len()).for_each(|end| survives(&bytes[..end]));
    for at in 0..bytes.len() {
        for change in [0x01, 0x80] {
            let mut wrong = bytes.clone();
            wrong[at] ^= change;
            survives(&wrong);
        }
        // A digit that makes counts huge.
        let mut wrong = bytes.clone();
        wrong[at] = b'9';
        survives(&wrong);
    }
    assert!(refused > bytes.len());
}

/// A file of five datasets of which one is spoiled, in any order: the others are read, and the spoiled one is named with its line.
#[test]
fn one_spoiled_record_costs_itself_in_every_order() {
    let row = "  5.00000E+00  1.500000000000E+00 -2.500000000000E+00\n";
    let response = text_58(6, 1, false, row);
    let sound = [UNITS, NODES, COMPLEX, SIX, &response];
    let spoiled: Vec<(usize, String, &str)> = vec![
        (1, NODES.replace("7.5D+01", "7.5x"), "7.5x"),
        (1, NODES.replace("         3         0         0        11\n", ""), "a whole number"),
        (2, COMPLEX.replace("2.00000E+00", "*******"), "dataset 55"),
        (2, COMPLEX.replace("         5         3\n", "         9         3\n"), "data type 9"),
        (3, SIX.replace("  5.00000E+01", "         NaN"), "NaN"),
        (3, SIX.replace("         1\n  1.0", "  1.0"), "dataset 55"),
        (4, response.replace("1.500000000000E+00", "               NaN"), "no frequency with a finite value"),
        (4, response.replace("         6         1 ", "         6         7 "), "3 numbers; expected 21"),
        (4, response.replace("    58\n", "    5x\n"), "`5x`"),
    ];
    // All orders of three datasets behind the units and the points, which may stand anywhere, too.
    let orders = [[0, 1, 2, 3, 4], [0, 4, 3, 2, 1], [0, 2, 1, 4, 3], [0, 3, 4, 1, 2], [0, 4, 2, 3, 1]];
    for (which, text, expected) in &spoiled {
        for order in &orders {
            for between in ["", "a remark between datasets\n\n"] {
                let dataset = |k: &usize| if k == which { text.as_str() } else { sound[*k] };
                let file = order.iter().map(dataset).collect::<Vec<_>>().join(between);
                let records = read("t.uff", file.as_bytes(), SI).unwrap();
                let counts = [records.points.len(), records.modes.len(), records.functions.len()];
                let left = |k: usize| usize::from(k != *which);
                assert_eq!(
                    counts,
                    [1 + left(1), left(2) + left(3), left(4)],
                    "{expected}: {order:?}\n{file}"
                );
                let told = records.warnings.join("\n");
                assert!(told.contains(expected) && told.contains("t.uff:"), "{expected}: {told}");
            }
        }
    }
    // Marks between datasets too few or too many, and line ends of any kind.
    let whole = sound.concat();
    for (k, _) in whole.match_indices("    -1\n    -1\n") {
        let (before, behind) = whole.split_at(k);
        let one = format!("{before}{}", &behind[7..]);
        let three = format!("{before}    -1\n{behind}");
        for file in [one, three] {
            for file in [file.clone(), file.replace('\n', "\r"), file.replace('\n', "\r\n")] {
                let records = read("t.uff", file.as_bytes(), SI).unwrap();
                let counts = [records.points.len(), records.modes.len(), records.functions.len()];
                assert_eq!(
                    (counts, records.warnings.len()),
                    ([2, 2, 1], 0),
                    "{file}\n{:?}",
                    records.warnings
                );
            }
        }
    }
}

#[test]
fn frequencies_without_a_value_or_twice_cost_themselves() {
    let of = |lines: &str, count: usize| {
        let records = read("t.uff", text_58(4, count, false, lines).as_bytes(), SI).unwrap();
        (records.functions[0].clone(), records.warnings.join("\n"))
    };
    for none in ["NaN", "-nan", "Inf", "********************", "1.#QNAN"] {
        let (function, told) = of(&format!(" 0.0 {none}\n 5.0 1.0\n 6.0 2.0\n"), 3);
        assert_eq!(function.frequencies_hz, [5.0, 6.0]);
        assert!(told.contains("t.uff:14, dataset 58 (0 Hz)") && told.contains("1 of 3"), "{told}");
    }
    let (function, told) = of(" 5.0 1.0\n 5.0 7.0\n 6.0 2.0\n", 3);
    assert_eq!((function.frequencies_hz, function.values[0].re), (vec![5.0, 6.0], 1.0));
    assert!(told.contains("5 Hz again: 1 of 3"), "{told}");
    let (function, _) = of(" 6.0 2.0\n 5.0 1.0\n", 2);
    assert_eq!((function.frequencies_hz, function.values[0].re), (vec![5.0, 6.0], 1.0));
    // Frequencies in the unit of their axis.
    let khz = text_58(4, 1, false, " 5.0 1.0\n").replace("Hz  ", "kHz ");
    assert_eq!(read("t", khz.as_bytes(), SI).unwrap().functions[0].frequencies_hz, [5000.0]);
}

#[test]
fn an_unknown_quantity_is_what_its_label_or_the_case_says() {
    let text = text_58(4, 1, false, " 5.0 1.0\n");
    let with = |label: &str, unit: &str| {
        let axis = format!("{:10}    0    0    0 {:<20} {:<20}\n", 12, "NONE", "NONE");
        assert!(text.contains(&axis));
        text.replace(&axis, &format!("{:10}    0    0    0 {label:<20} {unit:<20}\n", 0))
    };
    let of = |text: &str, quantity| read("t", text.as_bytes(), Unstated { quantity, ..SI }).unwrap();
    for (label, unit, expected) in [
        ("NONE", "m/s^2", Quantity::Accelerance),
        ("NONE", "g", Quantity::Accelerance),
        ("Acceleration", "NONE", Quantity::Accelerance),
        ("NONE", "mm/s", Quantity::Mobility),
        ("Velocity", "", Quantity::Mobility),
        ("NONE", "mm/N", Quantity::Receptance),
        ("Displacement", "NONE", Quantity::Receptance),
    ] {
        assert_eq!(of(&with(label, unit), None).functions[0].quantity, expected, "{label} {unit}");
    }
    let silent = with("NONE", "NONE");
    let none = of(&silent, None);
    assert!(none.functions.is_empty() && none.warnings[0].contains("quantity = "), "{:?}", none.warnings);
    for quantity in Quantity::ALL {
        assert_eq!(of(&silent, Some(quantity)).functions[0].quantity, quantity);
    }
}

/// Points and motions in turned and cylindrical systems of datasets 18 and 2420 are those of the same test in its own frame.
#[test]
fn coordinate_systems_are_applied() {
    let mut random = stridor_linalg::random::Random::new();
    let number = |v: f64| format!("{v:25.16E}").replace('E', "D");
    for cylindrical in [false, true] {
        for newer in [false, true] {
            for _ in 0..20 {
                let mut next = || random.next();
                let (a, b, c) = (3.0 * next(), 3.0 * next(), 3.0 * next());
                let turn = nalgebra::Rotation3::from_euler_angles(a, b, c);
                let origin = nalgebra::Vector3::new(next(), next(), next());
                let (own, motion) = ([0.5 + next().abs(), next(), next()], [next(), next(), next()]);
                // Closed forms: x = r cos θ, y = r sin θ, u = u_r e_r + u_θ e_θ + u_z e_z.
                let (sin, cos) = own[1].sin_cos();
                let (plain, moved, given) = if cylindrical {
                    let moved =
                        [motion[0] * cos - motion[1] * sin, motion[0] * sin + motion[1] * cos, motion[2]];
                    ([own[0] * cos, own[0] * sin, own[2]], moved, [own[0], own[1].to_degrees(), own[2]])
                } else {
                    (own, motion, own)
                };
                let place = origin + turn * nalgebra::Vector3::from(plain);
                let expected = turn * nalgebra::Vector3::from(moved);
                let line = |v: nalgebra::Vector3<f64>| [0, 1, 2].map(|k| number(v[k])).concat();
                let kind = usize::from(cylindrical);
                let system = if newer {
                    let rows: String =
                        [0, 1, 2].map(|k| line(turn * nalgebra::Vector3::ith(k, 1.0)) + "\n").concat();
                    format!(
                        "    -1\n  2420\n         1\npart\n         7{kind:10}         8\nown\n{rows}{}\n    -1\n",
                        line(origin)
                    )
                } else {
                    let [x, z] =
                        [nalgebra::Vector3::new(2.0, 0.0, 0.0), nalgebra::Vector3::new(1.5, 0.0, 0.7)];
                    let [x, z] = [x, z].map(|v| line(origin + turn * v));
                    format!(
                        "    -1\n    18\n         7{kind:10}         0         8         1\nown\n{} {x}\n{z}\n    -1\n",
                        line(origin)
                    )
                };
                let points = format!(
                    "    -1\n  2411\n         1         7         7        11\n{}\n    -1\n",
                    [0, 1, 2].map(|k| number(given[k])).concat()
                );
                let shape = format!(
                    "    -1\n    55\nNONE\nNONE\nNONE\nNONE\nNONE\n         1         2         2         8         2         3\n         2         4         1         1\n 5.0 1.0 0.0 0.0\n         1\n {} {} {}\n    -1\n",
                    motion[0], motion[1], motion[2]
                );
                let response = text_58(4, 1, false, " 5.0 1.0\n").replace("         3  -2", "         1  -2");
                for order in [[&system, &points, &shape, &response], [&response, &shape, &points, &system]] {
                    let file: String = order.map(String::as_str).concat();
                    let records = read("t", file.as_bytes(), SI).unwrap();
                    let axes = records.axes[&1].map(nalgebra::Vector3::from);
                    let force = records.functions[0].excitation.1;
                    let (set, _) = records.into_set();
                    let found = nalgebra::Vector3::from(set.points[0].position);
                    assert!(within((found - place).norm(), 1e-12, RoundOff), "{file}");
                    let values = set.modes[0].shape.clone().unwrap();
                    let sum: nalgebra::Vector3<f64> = set
                        .dofs
                        .iter()
                        .zip(&values)
                        .map(|(dof, v)| nalgebra::Vector3::from(dof.direction) * v.re)
                        .sum();
                    assert!(within((sum - expected).norm(), 1e-12, RoundOff), "{file}");
                    // The force acts along the first of its own directions.
                    assert!(within((nalgebra::Vector3::from(force) - axes[0]).norm(), 1e-15, RoundOff));
                }
            }
        }
    }
}

#[test]
fn motion_in_a_system_that_is_not_known_is_left_out_with_words() {
    let own = |definition: usize, displacement: usize| {
        NODES
            .replace("         3         0         0", &format!("         3{definition:10}{displacement:10}"))
    };
    let of = |points: String| read("t", [UNITS, &points, COMPLEX, SIX].concat().as_bytes(), SI).unwrap();
    let records = of(own(0, 4));
    assert!(
        records.points.len() == 2 && records.modes[0].shape.is_empty() && records.modes[1].shape.len() == 1
    );
    assert!(records.warnings[0].contains("motion in system 4") && records.warnings[0].contains("points 3"));
    let records = of(own(4, 0));
    assert!(records.points.len() == 1 && records.warnings[0].contains("coordinates in system 4"));
    // All in one of their own: the frame of the test.
    let records = of(own(4, 4).replace("         1         0         0", "         1         4         4"));
    assert!(records.points.len() == 2 && records.modes[0].shape.len() == 1 && records.axes.is_empty());
    assert!(records.warnings[0].contains("taken as the frame"), "{:?}", records.warnings);
    let spherical = "    -1\n    18\n         4         2         0         8         1\nS\n 0 0 0 1 0 0\n 1 0 1\n    -1\n";
    let records = read("t", [spherical, UNITS, &own(0, 4), COMPLEX].concat().as_bytes(), SI).unwrap();
    assert!(records.warnings[0].contains("type 2"), "{:?}", records.warnings);
}
