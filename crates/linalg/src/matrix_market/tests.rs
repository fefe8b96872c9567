//! Files written and read again, and files as other programs write them.

use super::super::samples;
use super::*;

fn text(header: &str, rest: &str) -> Result<MarketMatrix> {
    parse("a.mtx", format!("%%MatrixMarket matrix {header}\n% a comment\n\n{rest}").as_bytes(), 0)
}

#[test]
fn every_kind_becomes_the_whole_matrix() {
    let dense = |m: &SparseMatrix| m.to_dense();
    let a = text("coordinate real general", "2 3 3\n2 3 -1.5D+01\n1 1 4\n2 3 1\n").unwrap();
    assert_eq!(dense(&a.re), faer::mat![[4.0, 0.0, 0.0], [0.0, 0.0, -14.0]]);
    assert!(a.im.is_none());
    let a = text("coordinate integer skew-symmetric", "2 2 1\n2 1 3").unwrap();
    assert_eq!(dense(&a.re), faer::mat![[0.0, -3.0], [3.0, 0.0]]);
    let a = text("coordinate complex hermitian", "2 2 2\r\n1 1 1 0\r\n2 1 2 5\r\n").unwrap();
    assert_eq!(dense(&a.re), faer::mat![[1.0, 2.0], [2.0, 0.0]]);
    assert_eq!(dense(&a.im.unwrap()), faer::mat![[0.0, -5.0], [5.0, 0.0]]);
    let a = text("coordinate complex symmetric", "2 2 1\n2 1 2 5\n").unwrap();
    assert_eq!(dense(&a.im.unwrap()), faer::mat![[0.0, 5.0], [5.0, 0.0]]);
    let a = text("array real general", "2 2\n1\n2\n3\n4\n").unwrap();
    assert_eq!(dense(&a.re), faer::mat![[1.0, 3.0], [2.0, 4.0]]);
    let a = text("array real symmetric", "3 3\n1\n2\n3\n4\n5\n6").unwrap();
    assert_eq!(dense(&a.re), faer::mat![[1.0, 2.0, 3.0], [2.0, 4.0, 5.0], [3.0, 5.0, 6.0]]);
    let a = text("array real skew-symmetric", "3 3\n1\n2\n3\n").unwrap();
    assert_eq!(dense(&a.re), faer::mat![[0.0, -1.0, -2.0], [1.0, 0.0, -3.0], [2.0, 3.0, 0.0]]);
}

/// Headers in any case and with any blanks, numbers as C or Fortran write them, text in any encoding: the same matrix.
#[test]
fn the_same_matrix_is_read_however_it_is_written() {
    let numbers = [
        ["-1500000", "0.25"],
        ["-1.5E+06", "+.25"],
        ["-1.5D6", "2.5d-1"],
        ["-0.15+007", "25-002"],
        ["-1.5e6", "0.2500000000000000E+00"],
    ];
    for (header, [a, b]) in [
        "%%MatrixMarket matrix coordinate real general",
        "%%matrixmarket  MATRIX\tCoordinate    Real     GENERAL   ",
        &format!("%%MatrixMarket{0}matrix{0}coordinate{0}real{0}general{0}", " ".repeat(40)),
    ]
    .iter()
    .flat_map(|header| numbers.map(|numbers| (header, numbers)))
    {
        let text = format!("{header}\n% größer\n  3\t2  +2 \n1 2 {a}\n 3  1   {b}\n");
        for text in [text.clone(), text.replace('\n', "\r"), format!("\u{feff}{text}")] {
            let wide = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
            for bytes in [text.clone().into_bytes(), wide] {
                let read = parse("a.mtx", &bytes, 0).unwrap();
                assert_eq!(read.re.to_dense(), faer::mat![[0.0, -1.5e6], [0.0, 0.0], [0.25, 0.0]], "{text}");
            }
        }
    }
}

/// Random triangles, lower or upper, real or complex, under a general header; with one entry on the other side they are whole.
#[test]
fn matrices_with_one_triangle_are_told() {
    let mut random = super::super::random::Random::new();
    for n in 2..12 {
        for upper in [false, true] {
            for complex in [false, true] {
                let mut lines = Vec::new();
                for i in 1..=n {
                    for j in 1..=i {
                        if i == j || random.next() > 0.0 || (i, j) == (2, 1) {
                            let [i, j] = if upper { [j, i] } else { [i, j] };
                            let (re, im) = (random.next(), random.next());
                            let im = if complex { format!(" {im}") } else { String::new() };
                            lines.push(format!("{i} {j} {}{im}", if complex && i != j { 0.0 } else { re }));
                        }
                    }
                }
                let field = if complex { "complex" } else { "real" };
                let read = |lines: &[String]| {
                    text(
                        &format!("coordinate {field} general"),
                        &format!("{n} {n} {}\n{}", lines.len(), lines.join("\n")),
                    )
                    .unwrap()
                    .one_triangle()
                };
                let expected = if upper { "upper" } else { "lower" };
                assert_eq!(read(&lines), Some((expected, lines.len() - n)), "{lines:?}");
                let whole = if complex { "1 0" } else { "1" };
                lines.push(if upper { format!("{n} 1 {whole}") } else { format!("1 {n} {whole}") });
                assert_eq!(read(&lines), None);
            }
        }
    }
}

#[test]
fn faults_have_their_lines_and_come_together() {
    let error = text(
        "coordinate real symmetric",
        "3 3 7\n1 1 1.0\n4 1 2.0\n2 1 nan\n1 2 1\n\n3 3 x\n0 1 1\n2 2 1 1\n",
    );
    let message = error.unwrap_err().to_string();
    for part in [
        "6 faults",
        "a.mtx:6: found row 4, column 1",
        "a.mtx:7: found `2 1 nan`; expected finite",
        "a.mtx:8: found an entry in row 1, column 2; expected the lower triangle",
        "a.mtx:10: found `3 3 x`",
        "a.mtx:11: found row 0",
        "a.mtx:12: found `2 2 1 1`",
    ] {
        assert!(message.contains(part), "{part} not in\n{message}");
    }
    let many = "1 9 1\n".repeat(100);
    let message = text("coordinate real general", &format!("2 2 100\n{many}")).unwrap_err().to_string();
    assert!(message.contains("a.mtx:12: found row 1, column 9") && message.contains("92 more"), "{message}");
}

#[test]
fn headers_that_lie_are_refused_before_memory_is_taken() {
    for (header, rest, part) in [
        ("coordinate real general", "9 9 100000000000\n1 1 1\n", "100000000000 entries"),
        ("coordinate real general", "99999999999999999 1 1\n1 1 1\n", "99999999999999999 rows"),
        ("coordinate real general", "3 10034222 1\n1 1 1\n", "10034222 columns for 1 entries"),
        ("coordinate real general", "99999999999999999999999 1 1\n1 1 1\n", "rows, columns and"),
        ("array real general", "60000000 60000000\n1\n", "entries in the"),
        ("coordinate real general", "2 2 3\n1 1 1\n2 2 1   \n1 2      0      \n1 2 0\n", "goes on to 4"),
        ("coordinate real general", "2 2 2\n1 1 1.00000\n", "ends after 1 entries"),
        ("coordinate real symmetric", "2 3 1\n1 1 1\n", "as many rows as columns"),
        ("coordinate real general", "", "rows, columns and"),
        ("coordinate pattern general", "2 2 1\n1 1\n", "A pattern has no values"),
        ("coordinate real", "1 1 1\n1 1 1\n", "kin"),
        ("coordinate complex general", "1 1 1\n1 1 1e999 0\n", "finite"),
    ] {
        let error = text(header, rest).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains(part), "{header} {rest}: {error}");
    }
    assert!(parse("empty", b"", 0).is_err() && parse("bytes", &[0xff, 0xfe, b'\n', 0x80], 0).is_err());
    assert!(read(Path::new("nowhere.mtx"), 0).unwrap_err().to_string().contains("no file there"));
}

#[test]
fn a_matrix_of_known_size_may_be_nearly_empty() {
    let n = EMPTY + 5;
    let file = format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} 1\n{n} {n} 2\n");
    let damper = parse("c", file.as_bytes(), n).unwrap();
    assert_eq!((damper.re.ncols(), damper.re.compute_nnz(), damper.re[(n - 1, n - 1)]), (n, 1, 2.0));
    assert!(parse("c", file.as_bytes(), n - 1).is_err() && parse("c", file.as_bytes(), 0).is_err());
}

#[test]
fn written_matrices_read_back_bit_for_bit() {
    let (k, m) = samples::plate(5, false);
    for a in [&k, &m] {
        let text = to_text(a, None, "a plate");
        assert!(text.starts_with("%%MatrixMarket matrix coordinate real symmetric\n% a plate\n"));
        let back = parse("k", text.as_bytes(), 0).unwrap();
        assert_eq!((back.re.val(), back.re.row_idx()), (a.val(), a.row_idx()));
    }
    let mut one_sided = k.clone();
    one_sided.val_of_col_mut(3)[0] *= 1.0 + f64::EPSILON;
    let back = parse("k", to_text(&one_sided, Some(&k), "general").as_bytes(), 0).unwrap();
    assert_eq!((back.re.val(), back.im.unwrap().val()), (one_sided.val(), k.val()));
}
