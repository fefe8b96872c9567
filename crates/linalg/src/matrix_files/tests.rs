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
/// Dense and sparse columns of OUTPUT4; values that touch.
const OUTPUT4: &str = r"       3       3       6       2K       1P,3E23.16
       1       1       2
 4.0000000000000000E+00-1.5000000000000000E+00
       2       0       6
  131073
-1.5000000000000000E+00 8.0000000000000000E+00
   65539
 2.5000000000000000E+00
       3       0       3
       2       3
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
        rows(&read(&format!("{LARGE}{}", LARGE.replace("KAAX", "K4AA")), 'K').re),
        [[4.0, -1.5], [-1.5, 8.0]]
    );
    let polar = read(POLAR, 'B');
    let im = polar.im.unwrap();
    for (found, wanted) in
        [(value(&polar.re, 0, 0), 0.0), (value(&im, 0, 0), 2.0), (value(&polar.re, 1, 1), -3.0)]
    {
        assert!(within((found - wanted).abs(), 1e-14, RoundOff), "{found} {wanted}");
    }
    // Column 2 has rows 1, 2 and 3; the third string has the row 3, of many rows.
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
        ("DMIG    K       1       1               1       1       1.\n", "a K", "columns alone"),
        ("DMIG    A       0       6       2\nDMIG    B       0       6       2\n", "a", "2 matrices: A, B"),
        (&OUTPUT4.replace("       4       1       1\n", "       1       1       1\n"), "a:", "ends K"),
        (&OUTPUT4.replace("   65539\n", "   65549\n"), "a:8", "rows to 3"),
        (&OUTPUT4.replace("8.0000000000000000E+00", "8.0000000000000000X+00"), "a:6", "finite numbers"),
        ("no matrix\n", "a:1", "MatrixMarket"),
    ] {
        let text = wrong(text);
        assert!(text.contains(place) && text.contains(words), "{text}");
    }
    let binary = parse("a", &[24, 0, 0, 0, 1, 2, 3], 'K', 0).unwrap_err().to_string();
    assert!(binary.contains("FORMATTED"), "{binary}");
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
