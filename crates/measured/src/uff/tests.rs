use super::*;
use crate::Quantity;
use stridor_linalg::c64;

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
    let records = read("t", text.as_bytes(), 1.0).unwrap();
    assert!((records.points[&1][0] - 0.015).abs() < 1e-15 && (records.points[&3][1] - 0.075).abs() < 1e-15);
    let [complex, six] = &records.modes[..] else { panic!("two modes") };
    // λ = −2π + 628.287 i: |λ| = 628.318, f = 100 Hz, ζ = 1 %.
    assert!((complex.frequency_hz - 100.0).abs() < 1e-3);
    assert!((complex.damping_ratio.unwrap() - 0.01).abs() < 1e-6);
    assert_eq!(complex.shape[&3], [c64::new(1.0, 2.0), c64::new(0.0, 0.0), c64::new(-3.0, 4.0)]);
    assert_eq!((six.frequency_hz, six.damping_ratio), (50.0, Some(0.02)));
    assert_eq!(six.shape[&1].map(|u| u.re), [1.0, 2.0, 3.0]);
}

#[test]
fn functions_in_text_are_read_in_every_form() {
    let values = |records: TestRecords| records.functions[0].clone();
    let of = |text: &str| values(read("t", text.as_bytes(), 1.0).unwrap());
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
    assert!((scaled.values[0].re - 7e-3).abs() < 1e-15);
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
        let function = &read("t", &bytes, 1.0).unwrap().functions[0];
        assert_eq!(function.frequencies_hz, [5.0, 6.0]);
        // The label of the ordinate says g.
        let exact = 9.80665 * c64::new(1.5, -2.5);
        assert!((function.values[0] - exact).norm() < 1e-12 && function.values[1].im == 9.80665 * 4.0);
    }
}

#[test]
fn faults_name_the_line_and_what_is_wrong() {
    let said = |bytes: &[u8]| read("t.uff", bytes, 1.0).unwrap_err().to_string();
    assert!(said(b"frequency\n330\n").contains("t.uff:1: found `frequency`"));
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
    assert!(read("t.uff", of(&lines).as_bytes(), 1.0).is_ok());
    for k in 0..3 {
        let mut more = lines.to_vec();
        more.insert(k, lines[k]);
        let text = said(of(&more).as_bytes());
        assert!(text.contains("t.uff:17") && text.contains("6 numbers beyond the 14"), "{text}");
    }
    let uneven = said(of(&[lines[0], " 1.0 2.0", lines[1], lines[2]]).as_bytes());
    assert!(uneven.contains("t.uff:15") && uneven.contains("2 numbers in a line"), "{uneven}");
    let node = "         3\n  1.00000E+00  2.00000E+00  0.00000E+00  0.00000E+00 -3.00000E+00  4.00000E+00\n";
    let again = COMPLEX.replace(node, &node.repeat(2));
    assert!(said(again.as_bytes()).contains("node 3 again"), "{again}");
    let falling = said(text_58(4, 2, false, " 6.0 1.0 5.0 1.0\n").as_bytes());
    assert!(falling.contains("do not rise"), "{falling}");
    let cut = said(&binary_58(6, 2, false, false, &[0; 9]));
    assert!(cut.contains("byte") && cut.contains("58b"), "{cut}");
    let twice = said([NODES, NODES].concat().as_bytes());
    assert!(twice.contains("point 1 again") && twice.contains("t.uff:10"), "{twice}");
    // What is of no interest is skipped by name.
    let other = "    -1\n  2412\n   1 2 3\n    -1\n".to_string()
        + &text_58(2, 1, true, " 1.0\n").replace("    4    ", "    6    ");
    let records = read("t", other.as_bytes(), 1.0).unwrap();
    assert!(records.warnings.iter().any(|w| w.contains("dataset 2412")), "{:?}", records.warnings);
    let bare = read("t", text_58(2, 1, true, " 1.0\n").as_bytes(), 1.0).unwrap();
    assert!(bare.warnings[0].contains("1 frequency responses do not state"), "{:?}", bare.warnings);
}

#[test]
fn no_bytes_make_it_panic() {
    let data: Vec<u8> = [5.0f64, 1.5, -2.5].iter().flat_map(|v| v.to_le_bytes()).collect();
    let mut bytes = [UNITS, NODES, COMPLEX, SIX].concat().into_bytes();
    bytes.extend(text_58(6, 1, false, "  5.00000E+00  1.500000000000E+00 -2.500000000000E+00\n").as_bytes());
    bytes.extend(binary_58(6, 1, false, false, &data));
    let (set, warnings) = read("t", &bytes, 1.0).unwrap().into_set();
    assert!(set.frfs.len() == 2 && set.modes.len() == 2 && warnings.is_empty(), "{warnings:?}");
    let mut refused = 0;
    let mut survives = |bytes: &[u8]| match read("t", bytes, 1.0) {
        Ok(records) => drop(records.into_set()),
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
