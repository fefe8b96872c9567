//! Small grids of our own.

use crate::convert::{Units, convert};
use crate::deck::Deck;
use crate::format::{Format, read_bytes};
use crate::ledger::Weight;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use miniz_oxide::deflate::compress_to_vec_zlib;
use stridor_mesh::CellKind;

fn read(bytes: &[u8]) -> Result<Deck, String> {
    read_bytes("a.vtu", bytes, Format::Vtk).map_err(|error| error.to_string())
}

fn sound(bytes: &[u8]) -> Deck {
    read(bytes).unwrap_or_else(|error| panic!("{error}"))
}

/// How arrays are written.
#[derive(Debug, Clone, Copy)]
struct Form {
    /// Text, else bytes.
    text: bool,
    appended: bool,
    /// Bytes as base64.
    encoded: bool,
    packed: bool,
    /// Header and data encoded for themselves.
    apart: bool,
    big_endian: bool,
    wide_header: bool,
}

const TEXT: Form = Form {
    text: true,
    appended: false,
    encoded: true,
    packed: false,
    apart: false,
    big_endian: false,
    wide_header: false,
};

/// An array: its element's attributes, numbers as text, their size in bytes, whether they are real.
type Array<'a> = (&'a str, &'a str, usize, bool);

/// Two bricks of edge 1 side by side along x, with the face at x = 0, a vertex and a line.
const POINTS: &str = "0 0 0  1 0 0  2 0 0  0 1 0  1 1 0  2 1 0  0 0 1  1 0 1  2 0 1  0 1 1  1 1 1  2 1 1";
const CONNECTIVITY: &str = "0 1 4 3 6 7 10 9  1 2 5 4 7 8 11 10  0 3 9 6  0 1  2";
const OFFSETS: &str = "8 16 20 22 23";
const TYPES: &str = "12 12 9 3 1";

fn file(form: Form) -> Vec<u8> {
    let arrays: [Array<'_>; 6] = [
        ("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", POINTS, 8, true),
        ("type=\"Int64\" Name=\"connectivity\"", CONNECTIVITY, 8, false),
        ("type=\"Int32\" Name=\"offsets\"", OFFSETS, 4, false),
        ("type=\"UInt8\" Name=\"types\"", TYPES, 1, false),
        ("type=\"Int16\" Name=\"gmsh:physical\"", "7 -8 1 2 3", 2, false),
        ("type=\"Float32\" Name=\"quality\"", "1 1 1 1 1", 4, true),
    ];
    let mut appended = Vec::new();
    let [points, connectivity, offsets, types, physical, quality] =
        arrays.map(|array| element(form, array, &mut appended));
    let compressor = if form.packed { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
    let order = if form.big_endian { "BigEndian" } else { "LittleEndian" };
    let header = if form.wide_header { "UInt64" } else { "UInt32" };
    let mut file = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{order}\" header_type=\"{header}\"{compressor}>\n\
         <UnstructuredGrid>\n<FieldData><Array type=\"String\" Name=\"names\">65 0</Array></FieldData>\n\
         <Piece NumberOfPoints=\"12\" NumberOfCells=\"5\">\n<PointData/>\n<CellData>\n{physical}{quality}</CellData>\n<Points>\n{points}</Points>\n\
         <Cells>\n{connectivity}{offsets}{types}</Cells>\n</Piece>\n</UnstructuredGrid>\n"
    );
    if form.appended {
        file += &format!("<AppendedData encoding=\"{}\">\n _", if form.encoded { "base64" } else { "raw" });
    }
    let mut bytes = file.into_bytes();
    bytes.extend(appended);
    if form.appended {
        bytes.extend(b"\n</AppendedData>\n");
    }
    bytes.extend(b"</VTKFile>\n");
    bytes
}

fn element(form: Form, (attributes, text, size, real): Array<'_>, appended: &mut Vec<u8>) -> String {
    if form.text {
        // VTK puts elements of its own into arrays.
        let key = "<InformationKey name=\"L2_NORM_RANGE\"><Value index=\"0\">0</Value></InformationKey>";
        return format!("<DataArray {attributes} format=\"ascii\">{text}\n{key}</DataArray>\n");
    }
    let number = |word: &str| {
        let little = match (real, size) {
            (true, 4) => word.parse::<f32>().unwrap().to_le_bytes().to_vec(),
            (true, _) => word.parse::<f64>().unwrap().to_le_bytes().to_vec(),
            _ => word.parse::<i64>().unwrap().to_le_bytes()[..size].to_vec(),
        };
        if form.big_endian { little.into_iter().rev().collect() } else { little }
    };
    let data: Vec<u8> = text.split_whitespace().flat_map(number).collect();
    let header = |sizes: &[usize]| -> Vec<u8> {
        let of = |size: &usize| match (form.wide_header, form.big_endian) {
            (false, false) => (*size as u32).to_le_bytes().to_vec(),
            (false, true) => (*size as u32).to_be_bytes().to_vec(),
            (true, false) => (*size as u64).to_le_bytes().to_vec(),
            (true, true) => (*size as u64).to_be_bytes().to_vec(),
        };
        sizes.iter().flat_map(of).collect()
    };
    let (header, data) = if form.packed {
        let blocks: Vec<Vec<u8>> = data.chunks(16).map(|block| compress_to_vec_zlib(block, 6)).collect();
        let sizes = blocks.iter().map(Vec::len);
        (
            header(&[blocks.len(), 16, data.len() % 16].into_iter().chain(sizes).collect::<Vec<_>>()),
            blocks.concat(),
        )
    } else {
        (header(&[data.len()]), data)
    };
    let bytes = match (form.encoded, form.apart) {
        (false, _) => [header, data].concat(),
        (true, true) => (STANDARD.encode(header) + &STANDARD.encode(data)).into_bytes(),
        (true, false) => STANDARD.encode([header, data].concat()).into_bytes(),
    };
    if form.appended {
        let offset = appended.len();
        appended.extend(bytes);
        return format!("<DataArray {attributes} format=\"appended\" offset=\"{offset}\"/>\n");
    }
    format!(
        "<DataArray {attributes} format=\"binary\">\n  {}\n</DataArray>\n",
        String::from_utf8(bytes).unwrap()
    )
}

/// All forms that VTK, ParaView and meshio write.
fn forms() -> Vec<Form> {
    let mut all = vec![TEXT];
    let flags = [false, true];
    for (appended, encoded) in [(false, true), (true, true), (true, false)] {
        for (packed, apart) in [(false, false), (false, true), (true, false), (true, true)] {
            for (big_endian, wide_header) in flags.into_iter().flat_map(|big| flags.map(|wide| (big, wide))) {
                all.push(Form { text: false, appended, encoded, packed, apart, big_endian, wide_header });
            }
        }
    }
    all
}

#[test]
fn all_forms_of_a_file_are_the_same_grid() {
    let deck = sound(&file(TEXT));
    assert_eq!((deck.nodes.len(), deck.nodes[11].position), (12, [2.0, 1.0, 1.0]));
    let kinds: Vec<CellKind> = deck.elements.iter().map(|element| element.kind).collect();
    assert_eq!(
        kinds,
        [CellKind::Hexahedron8, CellKind::Hexahedron8, CellKind::Quadrilateral4, CellKind::Line2]
    );
    assert_eq!(deck.elements[1].nodes, [1, 2, 5, 4, 7, 8, 11, 10]);
    let sections: Vec<_> =
        deck.sections.iter().map(|own| (own.name.as_str(), own.elements.as_slice())).collect();
    assert_eq!(sections, [("gmsh_physical_-8", &[1][..]), ("gmsh_physical_7", &[0][..])]);
    // The face at x = 0 is the side of the first brick with the corners 3, 0, 4, 7; the line is an edge of it.
    assert_eq!(
        (deck.surfaces[0].name.as_str(), &deck.surfaces[0].faces[..]),
        ("gmsh_physical_1", &[(0, 5)][..])
    );
    let sets: Vec<_> = deck.node_sets.iter().map(|own| (own.name.as_str(), own.members.as_slice())).collect();
    assert_eq!(sets, [("gmsh_physical_2", &[0, 1][..]), ("gmsh_physical_3", &[2][..])]);
    let notes: Vec<_> = deck.ledger.rows().map(|row| (row.weight, row.what)).collect();
    assert!(notes.contains(&(Weight::Nothing, "FieldData names")), "{notes:?}");
    assert!(notes.contains(&(Weight::Nothing, "CellData quality")), "{notes:?}");
    assert!(notes.contains(&(Weight::Matters, "materials")), "{notes:?}");
    for form in forms() {
        let other = sound(&file(form));
        let places = |deck: &Deck| deck.nodes.iter().map(|node| node.position).collect::<Vec<_>>();
        assert_eq!(places(&other), places(&deck), "{form:?}");
        let elements =
            |deck: &Deck| deck.elements.iter().map(|own| (own.kind, own.nodes.clone())).collect::<Vec<_>>();
        assert_eq!(elements(&other), elements(&deck), "{form:?}");
        assert_eq!(
            (other.surfaces, other.node_sets),
            (deck.surfaces.clone(), deck.node_sets.clone()),
            "{form:?}"
        );
    }
}

/// The same as a legacy file, of version 4 or 5, as text or bytes, with what else may stand in one.
fn legacy(binary: bool, modern: bool) -> Vec<u8> {
    let mut bytes =
        format!("# vtk DataFile Version {}.1\nTwo bricks\n", if modern { 5 } else { 4 }).into_bytes();
    bytes.extend(if binary { b"BINARY\n" as &[u8] } else { b"ASCII\n" });
    let mut put = |line: &str, kind: &str, text: &str| {
        bytes.extend(format!("{line}\n").as_bytes());
        if !binary {
            bytes.extend(format!("{text}\n\n").as_bytes());
            return;
        }
        for word in text.split_whitespace() {
            match kind {
                "float" => bytes.extend(word.parse::<f32>().unwrap().to_be_bytes()),
                "int" => bytes.extend(word.parse::<i32>().unwrap().to_be_bytes()),
                "long" => bytes.extend(word.parse::<i64>().unwrap().to_be_bytes()),
                _ => bytes.push(word.parse().unwrap()),
            }
        }
        bytes.push(b'\n');
    };
    put("DATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\nTIME 1 1 float", "float", "0.5");
    put("METADATA\nINFORMATION 1\nNAME X LOCATION y\n\nPOINTS 12 float", "float", POINTS);
    if modern {
        put("CELLS 6 23\nOFFSETS vtktypeint64", "long", &format!("0 {OFFSETS}"));
        put("CONNECTIVITY vtktypeint64", "long", CONNECTIVITY);
    } else {
        let ends: Vec<usize> = OFFSETS.split_whitespace().map(|end| end.parse().unwrap()).collect();
        let all: Vec<&str> = CONNECTIVITY.split_whitespace().collect();
        let begins = std::iter::once(0).chain(ends.iter().copied());
        let cells =
            begins.zip(&ends).map(|(begin, end)| format!("{} {}", end - begin, all[begin..*end].join(" ")));
        put("CELLS 5 28", "int", &cells.collect::<Vec<_>>().join("\n"));
    }
    put("CELL_TYPES 5", "int", TYPES);
    put("POINT_DATA 12\nVECTORS u float", "float", POINTS);
    put("SCALARS colour unsigned_char\nLOOKUP_TABLE mine", "unsigned_char", "1 2 3 4 5 6 7 8 9 10 11 12");
    put("CELL_DATA 5\nSCALARS quality float 1\nLOOKUP_TABLE default", "float", "1 1 1 1 1");
    put("FIELD FieldData 1\ngmsh:physical 1 5 int", "int", "7 -8 1 2 3");
    bytes
}

#[test]
fn legacy_files_are_the_same_grid() {
    let deck = sound(&file(TEXT));
    for (binary, modern) in [(false, false), (false, true), (true, false), (true, true)] {
        let bytes = legacy(binary, modern);
        let other = read_bytes("a.vtk", &bytes, Format::Vtk).unwrap_or_else(|error| panic!("{error}"));
        let places = |deck: &Deck| deck.nodes.iter().map(|node| node.position).collect::<Vec<_>>();
        assert_eq!((places(&other), other.title.as_str()), (places(&deck), "Two bricks"));
        let elements =
            |deck: &Deck| deck.elements.iter().map(|own| (own.kind, own.nodes.clone())).collect::<Vec<_>>();
        assert_eq!(elements(&other), elements(&deck));
        assert_eq!((other.surfaces, other.node_sets), (deck.surfaces.clone(), deck.node_sets.clone()));
        let notes: Vec<_> = other.ledger.rows().map(|row| row.what).collect();
        for what in ["FieldData TIME", "PointData u", "PointData colour", "CellData quality"] {
            assert!(notes.contains(&what), "{notes:?}");
        }
    }
    let text = String::from_utf8(legacy(false, false)).unwrap();
    for (from, to, words) in [
        ("ASCII", "HEX", ":3: found `HEX`; expected ASCII or BINARY"),
        ("UNSTRUCTURED_GRID", "POLYDATA", "DATASET POLYDATA"),
        ("POINTS 12", "POINTS 99999999999999999999", "`99999999999999999999`"),
        ("POINTS 12", "POINTS 999999999999999999", "`Points`, whose data end early"),
        ("CELLS 5 28", "CELLS 6 28", "the points of 5 cells; expected 6 cells"),
        ("8 0 1 4 3", "9 0 1 4 3", "the points of 6 cells"),
        ("CELL_TYPES", "CELL_TYPE", "`CELL_TYPE`; expected a keyword"),
        ("7 -8 1 2 3", "7 -8 1 2 x", "`gmsh:physical`: `x`, no whole number"),
        ("7 -8 1 2 3", "7 -8 1 2", "`gmsh:physical`, whose data end early"),
    ] {
        let faults = read(text.replace(from, to).as_bytes()).expect_err("a fault");
        assert!(faults.contains(words), "{from} {to}: {faults}");
    }
}

/// A grid of cells of one kind.
fn grid(points: &str, [connectivity, offsets, types]: [&str; 3], data: &str) -> Vec<u8> {
    let n = points.split_whitespace().count() / 3;
    let cells = types.split_whitespace().count();
    let array = |kind: &str, name: &str, text: &str| {
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">\n{text}\n</DataArray>\n")
    };
    format!(
        "<VTKFile type=\"UnstructuredGrid\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{n}\" NumberOfCells=\"{cells}\">\n<Points>\n{}</Points>\n\
         <Cells>\n{}{}{}</Cells>\n<CellData>{data}</CellData></Piece></UnstructuredGrid></VTKFile>",
        array("Float32", "Points", points),
        array("Int32", "connectivity", connectivity),
        array("Int32", "offsets", offsets),
        array("UInt8", "types", types)
    )
    .into_bytes()
}

/// Every kind in the order of its row of the table, a cell on nodes of its own.
#[test]
fn every_kind_comes_back_in_its_own_order() {
    for kind in CellKind::all().filter(|kind| kind.dimension() > 0) {
        let places = kind.reference_coordinates();
        let points: String = places.iter().map(|at| format!("{} {} {}\n", at[0], at[1], at[2])).collect();
        let own: Vec<usize> = (0..places.len()).collect();
        let row = kind.table().vtk;
        let file: Vec<String> = row.order.to_file(&own).iter().map(ToString::to_string).collect();
        let [offset, number] = [file.len().to_string(), row.number.to_string()];
        let deck = sound(&grid(&points, [&file.join(" "), &offset, &number], ""));
        assert_eq!((deck.elements[0].kind, &deck.elements[0].nodes), (kind, &own));
        assert_eq!((deck.sections.len(), deck.sections[0].name.as_str()), (1, "part"));
    }
    // Voxels go by coordinates.
    let points = "0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1";
    let deck = sound(&grid(points, ["0 1 2 3 4 5 6 7", "8", "11"], ""));
    assert_eq!(deck.elements[0].nodes, [0, 1, 3, 2, 4, 5, 7, 6]);
    // A wedge turned the other way has the same nodes in the order of the table.
    let points = "0 0 0 1 0 0 0 1 0 0 0 1 1 0 1 0 1 1";
    let deck = sound(&grid(points, ["0 1 2 3 4 5", "6", "13"], ""));
    assert_eq!(deck.elements[0].nodes, [0, 1, 2, 3, 4, 5]);
    assert_eq!(sound(&grid(points, ["0 2 1 3 5 4", "6", "13"], "")).elements[0].nodes, [0, 1, 2, 3, 4, 5]);
}

#[test]
fn sets_of_other_arrays_and_shells_without_a_thickness_are_in_the_case() {
    let points = "0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0";
    let cells = ["0 1 4 3 1 2 5 4 5 2", "4 8 10", "9 9 3"];
    let array = |name: &str, text: &str| {
        format!("<DataArray type=\"Int32\" Name=\"{name}\" format=\"ascii\">{text}</DataArray>")
    };
    let data = array("zone", "4 5 5") + &array("part", "0 0 1");
    let mut deck = sound(&grid(points, cells, &data));
    assert_eq!(deck.sections.iter().map(|own| own.name.as_str()).collect::<Vec<_>>(), ["part_0"]);
    assert_eq!(deck.node_sets[0].name, "part_1");
    assert_eq!(
        deck.element_sets.iter().map(|own| own.name.as_str()).collect::<Vec<_>>(),
        ["zone_4", "zone_5"]
    );
    // Nodes by themselves: the line is a bar.
    deck = sound(&grid(
        &format!("{points} 5 5 5"),
        [&cells[0].replace("5 2", "5 6"), cells[1], cells[2]],
        &data,
    ));
    let made = convert(&deck, Units::named("m").unwrap()).unwrap_or_else(|error| panic!("{error}"));
    for words in [
        "# The file has no thickness: give one.\n# The file has no elastic constants: add [material.part_0].\n[shell.part_0]\n",
        "# The file has no diameter: give one.\n# The file has no elastic constants: add [material.part_1].\n[bar.part_1]\n",
    ] {
        assert!(made.case.contains(words), "{}", made.case);
    }
    let regions: Vec<&str> = made.mesh.regions.iter().map(|region| region.name.as_str()).collect();
    assert!(regions.contains(&"zone_4"), "{regions:?}");
}

#[test]
fn faults_come_at_once_with_their_lines() {
    let found = |bytes: &[u8]| read(bytes).expect_err("a fault");
    let text = String::from_utf8(file(TEXT)).unwrap();
    let wrong = text.replace("1 2 5 4 7 8 11 10", "1 2 5 4 7 8 11 99").replace("2 1 1\n", "2 1 x\n");
    let faults = found(wrong.as_bytes());
    assert!(faults.contains("a.vtu:14: found points: `x`, no number"), "{faults}");
    assert!(faults.contains("a.vtu:18: found cell 1 on point 99"), "{faults}");
    for (from, to, words) in [
        ("NumberOfCells=\"5\"", "NumberOfCells=\"6\"", "expected 6 whole numbers, one for each cell"),
        ("NumberOfPoints=\"12\"", "NumberOfPoints=\"99999999999999\"", "36 coordinates"),
        ("NumberOfPoints=\"12\"", "NumberOfPoints=\"x\"", "NumberOfPoints `x`"),
        (OFFSETS, "8 16 20 22 99", "cell 4 of the entries 22 to 99 of 23"),
        (TYPES, "12 12 9 3 3", "1 points"),
        ("2 1 1\n", "2 1 nan\n", "the coordinate NaN of point 11"),
        ("Name=\"types\"", "Name=\"kinds\"", "no array `types`"),
        ("format=\"ascii\"", "format=\"hex\"", "format `hex`"),
        (
            "type=\"UnstructuredGrid\"",
            "compressor=\"vtkLZ4DataCompressor\"",
            "compressor `vtkLZ4DataCompressor`",
        ),
        ("UnstructuredGrid>", "PolyData>", "a file without a grid"),
        ("</Cells>", "</Cell>", "what is no XML"),
    ] {
        let faults = found(text.replace(from, to).as_bytes());
        assert!(faults.contains(words), "{from} {to}: {faults}");
    }
    // A bomb: a block that says to be larger than the file can hold.
    let packed = Form { text: false, packed: true, ..TEXT };
    let text = String::from_utf8(file(packed)).unwrap();
    let header = |size: u32| STANDARD.encode([6, size, 0].map(u32::to_le_bytes).concat());
    let start = STANDARD.encode([18_u32, 16, 0].map(u32::to_le_bytes).concat());
    assert!(text.contains(&start));
    let faults = found(text.replace(&start, &header(u32::MAX)).as_bytes());
    assert!(faults.contains("more than 64 times the file"), "{faults}");
    // Arrays that share a block of data.
    let bytes = file(Form { appended: true, text: false, ..TEXT });
    let text = String::from_utf8(bytes).unwrap();
    let (head, data) = text.split_once("encoding=\"base64\">\n _").unwrap();
    let (data, tail) = data.split_once('\n').unwrap();
    let block = STANDARD.encode([&100_000_u32.to_le_bytes()[..], &[7; 100_000]].concat());
    let array =
        format!("<DataArray type=\"UInt8\" Name=\"a\" format=\"appended\" offset=\"{}\"/>\n", data.len());
    let head = head.replace("<CellData>", &format!("<CellData>{}", array.repeat(100)));
    let faults = found(format!("{head}encoding=\"base64\">\n _{data}{block}\n{tail}").as_bytes());
    assert!(faults.contains("more than 64 times the file"), "{faults}");
}

#[test]
fn nothing_panics_on_damaged_files() {
    let all = [TEXT, forms()[1], Form { appended: true, encoded: false, packed: true, ..forms()[1] }];
    for bytes in
        all.map(file).into_iter().chain([legacy(false, false), legacy(true, true), legacy(true, false)])
    {
        for at in 0..bytes.len() {
            let _ = read(&bytes[..at]);
            for byte in [b'9', b'-', b'\n', b'<', 0xff, 0] {
                let mut bytes = bytes.clone();
                bytes[at] = byte;
                if let Ok(deck) = read(&bytes) {
                    let _ = convert(&deck, Units::named("m").unwrap());
                }
            }
        }
    }
}
