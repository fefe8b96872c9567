use super::*;
use crate::SparseMatrix;
use crate::matrix_market::MarketMatrix;
use stridor_base::bounds::{Origin::*, within};

/// Rows of the whole matrix.
fn rows(matrix: &SparseMatrix) -> Vec<Vec<f64>> {
    (0..matrix.nrows()).map(|i| (0..matrix.ncols()).map(|j| value(matrix, i, j)).collect()).collect()
}

fn value(matrix: &SparseMatrix, i: usize, j: usize) -> f64 {
    matrix.row_idx_of_col(j).zip(matrix.val_of_col(j)).find(|(row, _)| *row == i).map_or(0.0, |(_, v)| *v)
}

fn read(text: &str, initial: char) -> MarketMatrix {
    match parse("a", text.as_bytes(), initial, 0).unwrap_or_else(|error| panic!("{error}\n{text}")) {
        Found::Whole(matrix) => matrix,
        Found::Labelled(matrix) => matrix.numbered(&matrix.labels().into_iter().collect::<Vec<_>>()).unwrap(),
    }
}

/// What is wrong, in words.
fn wrong(text: &str) -> String {
    match parse("a", text.as_bytes(), 'K', 0) {
        Err(error) => error.to_string(),
        Ok(found) => panic!("{found:?}"),
    }
}

const ABAQUS: &str = "** K\r\n*MATRIX INPUT, NAME=K\r\n1,1, 1,1,  4.0e+00\r\n2,1, 1,1, -1.5\r\n\r\n-3,2, 1,1, 2.5D+00\r\n2,1, 2,1, 8.\r\n";
/// Large fields, a matrix K and a mass M, with cards between that are others.
const LARGE: &str = r"$ punched
GRID    1               0.      0.      0.
DMIG    KAAX    0       6       2       0                       2
DMIG*   KAAX                           7               1
*                      7               1 4.000000000D+00
*                      9               3-1.500000000D+00
DMIG*   KAAX                           9               3
*                      9               3 8.000000000E+00
CELAS2  4       1.      1       1
        2       2
DMIG    MAAX    0       6       2       0                       2
DMIG*   MAAX                           7               1
*                      7               1 2.000000000E+00
";
/// Small and free fields, complex, by amplitude and phase.
const POLAR: &str = "DMIG    B2      0       1       3       0       1\nDMIG,b2,1,1,,1,1,2.,90.\n,2,1,1.,0.\n\
DMIG    B2      2       1               2       1       3.0     180.\n";
/// A dense column and sparse ones of OUTPUT4; values that touch.
const OUTPUT4: &str = r"       3       3       6       2K       1P,3E23.16
       1       1       2
 4.0000000000000000E+00-1.5000000000000000E+00
       2       0       8
  327681
-1.5000000000000000E+00 8.0000000000000000E+00
  196611
 2.5000000000000000E+00
       3       0       3
  196611
 1.0000000000000000E+00
       4       1       1
 1.0000000000000000E+00
";

#[test]
fn every_format_is_known_by_how_it_begins() {
    let m = read(ABAQUS, 'K');
    // Rows −3.2, 1.1, 2.1.
    assert_eq!(rows(&m.re), [[0.0, 2.5, 0.0], [2.5, 4.0, -1.5], [0.0, -1.5, 8.0]]);
    assert_eq!(rows(&read(LARGE, 'K').re), [[4.0, -1.5], [-1.5, 8.0]]);
    assert_eq!(rows(&read(LARGE, 'M').re), [[2.0]]);
    // K4AA is structural damping.
    assert_eq!(
        rows(&read(&format!("{LARGE}{}", LARGE.replace("KAAX", "K4AA").replace("MAAX", "BAAX")), 'K').re),
        [[4.0, -1.5], [-1.5, 8.0]]
    );
    let polar = read(POLAR, 'B');
    let im = polar.im.unwrap();
    for (found, wanted) in
        [(value(&polar.re, 0, 0), 0.0), (value(&im, 0, 0), 2.0), (value(&polar.re, 1, 1), -3.0)]
    {
        assert!(within((found - wanted).abs(), 1e-14, RoundOff), "{found} {wanted}");
    }
    // Column 2 has rows 1, 2 and 3. Both halves hold entries, so that nothing is added.
    assert_eq!(rows(&read(OUTPUT4, 'K').re), [[4.0, -1.5, 0.0], [-1.5, 8.0, 0.0], [0.0, 2.5, 1.0]]);
    let market =
        "%%MATRIXMARKET MATRIX COORDINATE REAL SYMMETRIC\r\n% a\r\n\r\n2 2 2\r\n1 1 3.0\r\n2 1 -1.5\r\n";
    assert_eq!(rows(&read(market, 'K').re), [[3.0, -1.5], [-1.5, 0.0]]);
}

/// A mass may have fewer rows than the stiffness; the rows of all are those of any.
#[test]
fn matrices_of_nodes_share_their_rows() {
    let of = |initial| match parse("a", LARGE.as_bytes(), initial, 0).unwrap() {
        Found::Labelled(matrix) => matrix,
        other => panic!("{other:?}"),
    };
    let labels: Vec<Label> = of('K').labels().into_iter().collect();
    assert_eq!(labels, [(7, 1), (9, 3)]);
    assert_eq!(rows(&of('M').numbered(&labels).unwrap().re), [[2.0, 0.0], [0.0, 0.0]]);
    assert!(of('K').numbered(&[(7, 1)]).unwrap_err().to_string().contains("node 9"));
}

#[test]
fn faults_have_file_and_line() {
    for (text, place, words) in [
        ("1,1, 1,1, 4.0\n1,1, 2,1\n", "a:2", "node, degree of freedom"),
        ("1,1, 1,1, 4.0\n1,1, 2,1, nan\n", "a:2", "finite"),
        (
            "DMIG    K       0       6       2\nDMIG    K       x       1               1       1       1.\n",
            "a:2",
            "grid point",
        ),
        (
            "DMIG    K       0       6       2\nDMIG    K       1       1               1       1       1.x\n",
            "a:2",
            "finite",
        ),
        ("DMIG    K       0       6       7\n", "a:1", "kind"),
        ("DMIG    K       1       1               1       1       1.\n", "a:1", "no header"),
        ("DMIG    A       0       6       2\nDMIG    B       0       6       2\n", "a", "2 matrices: A, B"),
        (&OUTPUT4.replace("8.0000000000000000E+00", "8.0000000000000000X+00"), "a:6", "2 more numbers"),
        ("*MATRIX INPUT, NAME=K, SCALE FACTOR=x\n1,1, 1,1, 2.\n", "a:1", "SCALEFACTOR=X"),
        ("*MATRIX INPUT, NAME=K, INPUT=k.mtx\n", "a:1", "the entries below"),
        (
            "*MATRIX INPUT, NAME=K\n1,1, 1,1, 2.\n*MATRIX INPUT, NAME=K\n1,1, 1,1, 2.\n",
            "a",
            "2 matrices: K, K",
        ),
    ] {
        let text = wrong(text);
        assert!(text.contains(place) && text.contains(words), "{text}");
    }
}

/// A file of no known kind: the fault has how each of them begins.
#[test]
fn an_unknown_kind_of_file_names_those_that_are_read() {
    for text in
        ["", "no matrix\n", "1 1 4.0\n", "%MatrixMarket\n", "1,1, 1,1\n", "DMI     K\n", "PK\u{3}\u{4}"]
    {
        let text = wrong(text);
        for words in ["a:1: found", "%%MatrixMarket", "*MATRIX INPUT", "DMIG", "1P,3E23.16"] {
            assert!(text.contains(words), "{text}");
        }
    }
}

/// \*MATRIX INPUT: names, factor, and the type, which says whether a matrix with one triangle is half of a symmetric one.
#[test]
fn keywords_of_abaqus_are_read() {
    let text = "*Matrix Input, name=M\n1,1, 1,1, 1.\n*MATRIX INPUT, NAME=K, TYPE=UNSYMMETRIC, SCALE FACTOR=2.\n\
                1,1, 1,1, 3.\n2,1, 1,1, 1.5\n";
    assert_eq!(rows(&read(text, 'K').re), [[6.0, 0.0], [3.0, 0.0]]);
    assert_eq!(rows(&read(&text.replace("UNS", "S"), 'K').re), [[6.0, 3.0], [3.0, 0.0]]);
    assert_eq!(rows(&read(text, 'M').re), [[1.0]]);
}

/// Entries of Abaqus, of DMIG in small and large fields, of a matrix of a form or a type: place, place and value.
fn written(entries: &[(i64, u8, i64, u8, f64)], style: usize, symmetric: bool) -> (String, Vec<usize>) {
    let form = if symmetric { 6 } else { 1 };
    let mut text = match style {
        0 => format!("*MATRIX INPUT, NAME=K, TYPE={}SYMMETRIC\n", if symmetric { "" } else { "UN" }),
        _ => format!("DMIG    K       0       {form}       2\n"),
    };
    let mut lines = Vec::new();
    for (i, c, j, d, value) in entries {
        text += &match style {
            0 => format!("{i},{c}, {j},{d}, {value:e}\n"),
            1 => format!("DMIG    K       {j:<8}{d:<16}{i:<8}{c:<8}{value:<8}\n"),
            2 => format!("DMIG*   K               {j:<16}{d:<16}\n*       {i:<16}{c:<16}{value:<16}\n"),
            _ => format!("DMIG,K,{j},{d},,{i},{c},{value}\n"),
        };
        lines.push(text.lines().count());
    }
    (text, lines)
}

const ENTRIES: [(i64, u8, i64, u8, f64); 6] = [
    (1, 1, 1, 1, 4.0),
    (2, 3, 1, 1, -1.5),
    (2, 3, 2, 3, 8.0),
    (7, 2, 1, 1, 0.25),
    (1, 1, 7, 1, 0.5),
    (7, 2, 7, 2, 3.0),
];

/// Every entry given once more, and above the diagonal what is below it.
#[test]
fn an_entry_that_is_given_twice_is_a_fault() {
    for style in 0..4 {
        for symmetric in [false, true] {
            let whole = read(&written(&ENTRIES, style, symmetric).0, 'K').re.to_dense();
            for k in 0..ENTRIES.len() {
                for (value, mirrored) in [(1.0, false), (1.0, true), (2.0, true)] {
                    let (i, c, j, d, v) = ENTRIES[k];
                    let again = if mirrored { (j, d, i, c, value * v) } else { (i, c, j, d, v) };
                    let (text, lines) = written(&[&ENTRIES[..], &[again]].concat(), style, symmetric);
                    let diagonal = (i, c) == (j, d);
                    if mirrored && !diagonal && (value == 1.0 || !symmetric) {
                        let found = read(&text, 'K').re.to_dense();
                        assert!(!symmetric || found == whole, "{text}");
                        continue;
                    }
                    let message = wrong(&text);
                    let places = [format!("a:{}", lines[ENTRIES.len()]), format!("after line {};", lines[k])];
                    assert!(places.iter().all(|place| message.contains(place)), "{text}\n{message}");
                    assert!(
                        message.contains(if mirrored && !diagonal { "mirror" } else { "once" }),
                        "{message}"
                    );
                }
            }
        }
    }
}

/// Every field of every card of DMIG left out: a fault in that line, or of the point whose component is missing.
#[test]
fn a_card_with_a_field_left_out_is_a_fault() {
    for style in 1..4 {
        let (text, _) = written(&ENTRIES, style, true);
        let lines: Vec<&str> = text.lines().collect();
        for (at, line) in lines.iter().enumerate().skip(1) {
            let fields = if style == 3 { line.split(',').count() } else { line.len().div_ceil(8) };
            // All fields after the name of the matrix.
            let first = if line.starts_with('*') { 1 } else { 2 };
            for k in first..fields {
                let shorter = if style == 3 {
                    let mut fields: Vec<&str> = line.split(',').collect();
                    if std::mem::take(&mut fields[k]).is_empty() {
                        continue;
                    }
                    fields.join(",")
                } else {
                    let step = if style == 2 { 16 } else { 8 };
                    let from = 8 + (8 * k - 8) / step * step;
                    let to = (from + step).min(line.len());
                    if line[from..to].trim().is_empty() {
                        continue;
                    }
                    format!("{}{}{}", &line[..from], " ".repeat(to - from), &line[to..])
                };
                if shorter.split([',', ' ']).filter(|word| !word.is_empty()).nth(1) != Some("K") && first == 2
                {
                    continue;
                }
                let mut lines = lines.clone();
                lines[at] = &shorter;
                let message = wrong(&(lines.join("\n") + "\n"));
                let (near, card) = (format!("a:{}:", at + 1), format!("a:{at}:"));
                let mixed = message.contains("of a scalar point");
                assert!(message.contains(&near) || message.contains(&card) || mixed, "{shorter}\n{message}");
            }
        }
    }
}

#[test]
fn cut_and_empty_matrices_of_dmig_are_faults() {
    let header = "DMIG    K       0       6       2\n";
    let card =
        |mark: &str| format!("{:<72}{mark}\n", "DMIG    K       1       1               1       1       4.0");
    for (text, words) in [
        (header.to_string(), "without columns"),
        (format!("{header}DMIG*   K               1               1\n"), "column 1, 1 without rows"),
        (header.to_string() + &card("+A"), "the line that continues the card"),
        (format!("{header}DMIG,K,1,1,,1,1,4.,,+\n"), "the line that continues the card"),
        (format!("{header}DMIG,K,1,1,,1,1,4.,,5\n"), "after the last field"),
        (format!("{header}DMIG,K,1,1,1,1,4.\n"), "a blank field"),
        (format!("{header}DMIG,K,1,1,,1,1,4.,5.\n"), "one finite number"),
        (header.replace("2\n", "4\n") + "DMIG,K,1,1,,1,1,4.\n", "two finite numbers"),
        (format!("*       1               1               4.0\n{header}"), "a card before"),
        (format!("{header}{header}{}", card("")), "second header"),
    ] {
        let message = wrong(&text);
        assert!(message.contains(words) && message.contains("a:"), "{text}\n{message}");
    }
    // A mark in field 10 where the card does go on, and one of a matrix before the last card.
    let goes_on = header.to_string() + &card("+A") + "+A      2       1       -1.\n";
    assert_eq!(rows(&read(&goes_on, 'K').re), [[4.0, -1.0], [-1.0, 0.0]]);
    // Of a general form one triangle is no half.
    assert_eq!(
        rows(&read(&goes_on.replace("6       2\n", "1       2\n"), 'K').re),
        [[4.0, 0.0], [-1.0, 0.0]]
    );
}

/// Files cut at every byte, with every byte changed, and with numbers that are far too large: a fault or a matrix, and no panic.
#[test]
fn damaged_files_do_not_panic() {
    for text in [ABAQUS, LARGE, POLAR, OUTPUT4] {
        let try_it = |bytes: &[u8]| {
            if let Ok(Found::Labelled(matrix)) = parse("a", bytes, 'K', 0) {
                let _ = matrix.numbered(&matrix.labels().into_iter().collect::<Vec<_>>());
            }
        };
        for at in 0..text.len() {
            try_it(&text.as_bytes()[..at]);
            for byte in [b' ', b'9', b'-', b',', b'\n', b'*', b'.', 0, 0xff] {
                let mut bytes = text.as_bytes().to_vec();
                bytes[at] = byte;
                try_it(&bytes);
            }
        }
        try_it(text.replace('3', "99999999").as_bytes());
        try_it(text.replace('1', "18446744073709551616").as_bytes());
    }
}
