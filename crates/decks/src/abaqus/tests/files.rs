//! How files are written: capitals, ends of lines, letters, and files that include others.

use super::*;
use crate::deck::Analysis;
use crate::format::read;
use std::fmt::Write as _;
use std::path::Path;

/// Blanks within keywords, small letters, CR LF, comments in Latin-1, a keyword line that goes on, quotation marks.
#[test]
fn writing_makes_no_difference() {
    let plain = bricks("*NSET, NSET=A\n1, 2\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n*STEP\n*END STEP\n");
    let other = format!(
        "  ** a comment\n{BRICKS}*nSet, \n nset = \"a\"\n** between\n1,2,\n\n*SolidSection,elset=\"eAll\",\n MATERIAL=M\n*STEP\n*ENDSTEP\n"
    );
    let mut bytes = other.replace('\n', "\r\n").into_bytes();
    bytes.extend(b"** Gr\xf6\xdfe\r\n");
    let other = read_bytes("b.inp", &bytes, Format::Abaqus).unwrap();
    assert_eq!(set(&other, "A"), set(&plain, "A"));
    assert_eq!(other.sections[0].elements, plain.sections[0].elements);
    assert_eq!(other.sections[0].material, "M");
    assert_eq!(notes(&other), []);
    // A comma at the end of a keyword line, and the next keyword below it.
    assert_eq!(
        bricks("*STEP, NLGEOM,\n*FREQUENCY,\n3\n").analyses,
        [Analysis::Modes { count: Some(3), band: [None; 2] }]
    );
}

#[test]
fn what_is_not_read_is_listed_with_its_line() {
    let deck =
        bricks("*NODE PRINT\nU\n*NEWTHING, A=B\n1, 2\n*SYSTEM\n1, 5, 1\n*MASS, ELSET=EALL, TYPE=X\n1.\n*\n");
    let expected = [
        (Weight::Matters, "*NEWTHING", 19),
        (Weight::Matters, "*SYSTEM", 21),
        (Weight::Perhaps, "*MASS", 23),
        (Weight::Perhaps, "*MASS, TYPE", 23),
        (Weight::Nothing, "*", 25),
        (Weight::Nothing, "*NODEPRINT", 17),
    ];
    assert_eq!(notes(&deck), expected);
    let unknown =
        bricks("*ELEMENT, TYPE=AC3D8, ELSET=W\n9, 1, 2, 3, 4, 5, 6, 7, 8\n*ELSET, ELSET=W2\nW, 9, 1\n");
    assert_eq!(
        (notes(&unknown), elements(&unknown, "W2")),
        (vec![(Weight::Matters, "*ELEMENT, TYPE=AC3D8", 17)], vec![1])
    );
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
    std::fs::write(folder.join(name), text).unwrap();
}

fn error(path: &Path) -> String {
    read(path, None).unwrap_err().to_string()
}

/// Lines of data in a file of their own, files within files and in folders, CR LF in one of them.
#[test]
fn files_include_files() {
    let folder = tempfile::tempdir().unwrap();
    let nodes: String = BRICKS.lines().skip(1).take(12).fold(String::new(), |mut all, line| {
        let _ = write!(all, "{line}\r\n");
        all
    });
    write(
        folder.path(),
        "a.INP",
        "*NODE\n*INCLUDE, INPUT=parts\\nodes.dat\n13, 5., 5., 5.\n*INCLUDE, INPUT=\"parts/rest.inc\"\n*NSET, NSET=LAST\n13\n",
    );
    write(folder.path(), "parts/nodes.dat", &nodes);
    write(folder.path(), "parts/rest.inc", "*Include, input=deep.inc\n*BOUNDARY\nX, 1\n");
    write(folder.path(), "parts/deep.inc", "*NSET, NSET=X\n99, 2\n");
    let deck = read(&folder.path().join("a.INP"), None).unwrap();
    assert_eq!((deck.nodes.len(), deck.files.len(), set(&deck, "LAST")), (13, 4, vec![13]));
    assert_eq!(
        deck.words(deck.nodes[1].place),
        format!("{}:2", folder.path().join("parts/nodes.dat").display())
    );
    assert!(deck.words(deck.supports[0].place).ends_with("rest.inc:3"));
    assert_eq!(
        deck.ledger.rows().map(|row| deck.words(row.first)).collect::<Vec<_>>(),
        [format!("{}:2", folder.path().join("parts/deep.inc").display())]
    );
}

#[test]
fn includes_that_are_wrong_are_faults() {
    let folder = tempfile::tempdir().unwrap();
    let main = folder.path().join("a.inp");
    write(
        folder.path(),
        "a.inp",
        "*INCLUDE, INPUT=none.inc\n*INCLUDE\n*INCLUDE, INPUT=zero.inc\n*BOUNDARY\n1, 1\n",
    );
    write(folder.path(), "zero.inc", "a\0b");
    let text = error(&main);
    for words in ["a.inp:1", "none.inc", "no file there", "a.inp:2", "a.inp:3", "NUL", "a.inp:5"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    write(folder.path(), "a.inp", "*INCLUDE, INPUT=b.inp\n");
    write(folder.path(), "b.inp", "*INCLUDE, INPUT=./a.inp\n");
    assert!(error(&main).contains("which is being read"), "{}", error(&main));
    // Each file includes the next one twice.
    for k in 0..40 {
        write(
            folder.path(),
            &format!("{k}.inp"),
            &format!("*INCLUDE, INPUT={0}.inp\n*INCLUDE, INPUT={0}.inp\n", k + 1),
        );
    }
    write(folder.path(), "40.inp", "*STEP\n*END STEP\n");
    assert!(error(&folder.path().join("0.inp")).contains("files that are included"));
    for k in 0..200 {
        write(folder.path(), &format!("{k}.inp"), &format!("*INCLUDE, INPUT={}.inp\n", k + 1));
    }
    assert!(error(&folder.path().join("0.inp")).contains("64 deep"));
    // A large one many times.
    write(folder.path(), "a.inp", &"*INCLUDE, INPUT=large.inc\n".repeat(100));
    write(folder.path(), "large.inc", &format!("** {}\n", "x".repeat(100_000)));
    assert!(error(&main).contains("included again"));
    assert!(read(&folder.path().join("none.inp"), None).unwrap_err().to_string().contains("no file there"));
    assert!(read(Path::new("a.txt"), None).unwrap_err().to_string().contains("`.txt`"));
}
