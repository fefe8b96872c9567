use super::*;
use crate::generate::{Faces, structured_plate};
use crate::quality::face_shape;
use crate::{CellKind, to_msh};
use stridor_base::bounds::{Origin::*, within};

/// The same small model in four formats, written by Gmsh 4.15 (tests/data/gmsh.geo).
const FILES: [(&str, &[u8]); 4] = [
    ("2.2 text", include_bytes!("../../tests/data/gmsh-22-ascii.msh")),
    ("2.2 binary", include_bytes!("../../tests/data/gmsh-22-binary.msh")),
    ("4.1 text", include_bytes!("../../tests/data/gmsh-41-ascii.msh")),
    ("4.1 binary", include_bytes!("../../tests/data/gmsh-41-binary.msh")),
];
const SECOND_ORDER: &[u8] = include_bytes!("../../tests/data/gmsh-second-order.msh");

const BAR: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"bar\"\n$EndPhysicalNames\n\
                   $Nodes\n2\n1 0 0 0\n2 100 0 0\n$EndNodes\n$Elements\n1\n1 1 2 1 1 1 2\n$EndElements\n";
/// Nodes numbered 2, 1: without gaps, not in order.
const BAR_4: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"bar\"\n$EndPhysicalNames\n\
                     $Entities\n0 1 0 0\n1 0 0 0 100 0 0 1 1 0\n$EndEntities\n\
                     $Nodes\n1 2 1 2\n1 1 0 2\n2\n1\n100 0 0\n0 0 0\n$EndNodes\n\
                     $Elements\n1 1 1 1\n1 1 1 1\n1 1 2\n$EndElements\n";

/// Message about bytes that are no valid mesh.
fn fault(bytes: impl AsRef<[u8]>) -> String {
    let error = parse(bytes.as_ref(), "a.msh", 1.0).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    let text = error.to_string();
    assert!(text.len() < 600, "{text}");
    text
}

#[test]
fn a_bar_is_read_in_the_order_of_its_tags() {
    for text in [BAR, BAR_4] {
        let mesh = parse(text.as_bytes(), "a.msh", 1.0).unwrap();
        assert_eq!(mesh.nodes, [[0.0; 3], [100.0, 0.0, 0.0]]);
        assert_eq!(mesh.require("bar", 1).unwrap().elements, [0]);
    }
}

/// Four formats of one model agree; the numbers are those of its geometry: 6 × 2 face, 2 long bar.
#[test]
fn meshes_of_gmsh_are_read_from_all_four_formats() {
    for (format, bytes) in FILES {
        let mesh = parse(bytes, format, 0.001).unwrap();
        let area = |name: &str| {
            let faces = &mesh.require(name, 2).unwrap().elements;
            faces.iter().filter_map(|e| face_shape(&mesh, &mesh.elements[*e])).map(|s| s.area).sum::<f64>()
        };
        assert!(
            within((area("plate") - 12e-6).abs(), 1e-16, RoundOff)
                && within((area("left half") - 6e-6).abs(), 1e-16, RoundOff),
            "{format}"
        );
        let names: Vec<&str> = mesh.regions.iter().map(|r| r.name.as_str()).collect();
        assert_eq!(names, ["tip", "clamped edge", "bar", "plate", "left half"], "{format}");
        let tip = mesh.region_nodes(mesh.require("tip", 0).unwrap());
        assert_eq!(mesh.nodes[tip[0]], [0.0, 0.0, 0.002], "{format}");
        let left = mesh.require("left half", 2).unwrap();
        let plate = mesh.require("plate", 2).unwrap();
        assert!(left.elements.iter().all(|e| plate.elements.contains(e)), "{format}: shared, not repeated");
        assert!(mesh.elements.iter().any(|e| e.kind() == CellKind::Quadrilateral4));
    }
}

#[test]
fn a_file_cut_off_anywhere_is_refused() {
    for (format, bytes) in FILES {
        let whole = bytes.trim_ascii_end().len();
        for end in 0..whole {
            assert!(parse(&bytes[..end], format, 1.0).is_err(), "{format} cut at {end}");
        }
    }
    let text = fault(&FILES[0].1[..900]);
    assert!(text.contains("a.msh, line") && text.contains("cut off"), "{text}");
    let text = fault(&FILES[2].1[..900]);
    assert!(text.contains("a.msh, line") && text.contains("the end of the file"), "{text}");
}

/// Every line of a text file matters: none can be left out or be there twice, and no white space between numbers can go.
#[test]
fn a_line_or_a_space_too_few_or_too_many_is_refused() {
    let files = [0, 2].map(|k| String::from_utf8(FILES[k].1.to_vec()).unwrap());
    for text in [BAR, BAR_4].map(String::from).into_iter().chain(files) {
        let lines: Vec<&str> = text.lines().collect();
        // A second line with the version is passed over.
        for k in 2..lines.len() {
            let [mut fewer, mut more] = [lines.clone(), lines.clone()];
            fewer.remove(k);
            more.insert(k, lines[k]);
            for changed in [fewer, more] {
                assert!(parse(changed.join("\n").as_bytes(), "a.msh", 1.0).is_err(), "line {}", k + 1);
            }
        }
        // MSH 2.2 lets the number of tags vary: there two numbers that touch can be another element.
        let numbers = if lines[1].starts_with("4.1") { text.find("$Nodes").unwrap() } else { text.len() };
        let space = |at: usize| text.as_bytes()[at].is_ascii_whitespace();
        for at in (numbers..text.len().saturating_sub(1))
            .filter(|at| space(*at) && !space(at - 1) && !space(at + 1))
        {
            let mut joined = text.clone();
            joined.remove(at);
            assert!(parse(joined.as_bytes(), "a.msh", 1.0).is_err(), "white space at byte {at}");
        }
    }
}

#[test]
fn entities_must_be_there_once_and_finite() {
    for (old, new, expected) in [
        (
            "$Elements\n1 1 1 1\n1 1 1 1",
            "$Elements\n1 1 1 1\n1 7 1 1",
            "entity 7 of dimension 1, which $Entities lacks",
        ),
        ("0 1 0 0\n", "0 2 0 0\n1 0 0 0 1 1 1 0 0\n", "line 11: found entity 1 of dimension 1 again"),
        ("1 1 0 2\n2\n1", "1 1 2 2\n2\n1", "mark 2"),
        ("$Nodes\n1 2", "$Nodes\n1 3", "found 2 nodes; expected 3"),
        ("$Elements\n1 1 1", "$Elements\n1 2 1", "found 1 elements; expected 2"),
        ("$EndNodes\n", "$EndNodes\n$Nodes\n0 0 0 0\n$EndNodes\n", "`$Nodes` again"),
        ("$Nodes", "$PartitionedEntities\n$EndPartitionedEntities\n$Nodes", "mesh in partitions"),
        ("2\n1\n100", "2\n0\n100", "node number 0"),
    ] {
        assert!(BAR_4.contains(old), "{old}");
        let text = fault(BAR_4.replacen(old, new, 1));
        assert!(text.contains(expected), "{text}");
    }
}

/// What Gmsh itself reads: any order of sections, comments, parametric coordinates, numbers as C reads them, any encoding.
#[test]
fn the_same_mesh_is_read_however_it_is_written() {
    let expected = parse(BAR_4.as_bytes(), "a.msh", 1.0).unwrap();
    let parametric = BAR_4.replace("1 1 0 2\n2\n1\n100 0 0\n0 0 0", "1 1 1 2\n2\n1\n100 0 0 0.5\n0 0 0 0.1");
    let numbers = BAR_4.replace("0 1 0 0\n1 0 0 0 100 0 0", "-0 +1 -0 0\n1 -0. 0 -inf 1.D+02 0 .0");
    for text in [BAR_4, &parametric, &numbers] {
        let (head, rest) = text.split_at(text.find("$PhysicalNames").unwrap());
        let (names, body) = rest.split_at(rest.find("$Entities").unwrap());
        let (entities, body) = body.split_at(body.find("$Nodes").unwrap());
        let (nodes, elements) = body.split_at(body.find("$Elements").unwrap());
        let comment = "$Comments\n1 2 3\n$EndComments\n";
        for parts in [
            [head, names, entities, nodes, elements],
            [names, entities, head, nodes, elements],
            [comment, head, elements, nodes, entities],
            [
                "\n// made by hand, see $Nodes\n",
                head,
                names,
                &[entities, "\n\n17 4\n", nodes].concat(),
                elements,
            ],
        ] {
            let named = parts.contains(&names);
            let text = parts.concat() + if named { "" } else { names };
            for text in [text.clone(), text.replace('\n', "\r"), format!("\u{feff}{text}")] {
                let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
                for bytes in [text.as_bytes(), &wide] {
                    let mesh = parse(bytes, "a.msh", 1.0).unwrap_or_else(|error| panic!("{text}\n{error}"));
                    assert_eq!((&mesh.nodes, &mesh.elements), (&expected.nodes, &expected.elements));
                    assert_eq!(mesh.regions, expected.regions);
                }
            }
        }
    }
}

/// Coordinates come through to the last bit and tags whatever they are, between elements of types that no mesh takes.
#[test]
fn numbers_are_exact_and_tags_may_be_any() {
    let mut seed = 41u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) | 1
    };
    for case in 0..50 {
        let count = 2 + case % 7;
        // Ascending multiples, so that all differ; with 1 for the first case, so that they have no gaps.
        let gap = if case == 0 { 1 } else { random() >> 8 };
        let nodes: Vec<(u64, f64)> =
            (1..=count).map(|k| (k * gap, f64::from_bits(random() << 1 & 0x3fff_ffff_ffff_ffff))).collect();
        let (mut tags, mut places, mut lines) = (String::new(), String::new(), String::new());
        for (tag, x) in nodes.iter().rev() {
            tags += &format!("{tag}\n");
            places += &format!("{x:e} {tag} 0\n");
        }
        for (k, pair) in nodes.windows(2).enumerate() {
            lines += &format!("{} {} {}\n", k as u64 + gap, pair[0].0, pair[1].0);
        }
        let text = format!(
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"bar\"\n$EndPhysicalNames\n\
             $Elements\n3 {total} 1 {total}\n1 2 8 1\n7 1 2 3\n1 1 1 {lines_count}\n{lines}1 2 67 1\n9 1 2\n$EndElements\n\
             $Nodes\n1 {count} 1 {count}\n1 1 0 {count}\n{tags}{places}$EndNodes\n\
             $Entities\n0 2 0 0\n1 0 0 0 0 0 0 1 -1 0\n2 0 0 0 0 0 0 0 0\n$EndEntities\n",
            total = count + 1,
            lines_count = count - 1,
        );
        let mesh = parse(text.as_bytes(), "a.msh", 1.0).unwrap_or_else(|error| panic!("{text}\n{error}"));
        let read: Vec<(u64, u64)> =
            mesh.origin.node_tags.iter().zip(&mesh.nodes).map(|(tag, n)| (*tag, n[0].to_bits())).collect();
        let written: Vec<(u64, u64)> = nodes.iter().map(|(tag, x)| (*tag, x.to_bits())).collect();
        assert_eq!(read, written);
        assert_eq!(mesh.require("bar", 1).unwrap().elements.len() as u64, count - 1);
    }
    let text = fault(BAR_4.replace("1 0 0 0 100 0 0", "2147483648 0 0 0 100 0 0"));
    assert!(
        text.contains("line 10: found entity's tag 2147483648; expected an integer of 32 bits"),
        "{text}"
    );
}

/// All types of Gmsh beyond those of the second order are named as what they are, of however many nodes.
#[test]
fn types_of_third_and_higher_order_are_faults() {
    for (kind, nodes, expected) in [
        (36, 16, "higher order (1 of type 36)"),
        (62, 8, "-order 2"),
        (47, 49, "-order 2"),
        (94, 216, "(1 of type 94)"),
    ] {
        let list = vec!["1"; nodes].join(" ");
        let two = fault(BAR.replace("1 1 2 1 1 1 2", &format!("1 {kind} 2 1 1 {list}")));
        let four = fault(BAR_4.replace("1 1 1 1\n1 1 2\n", &format!("1 1 {kind} 1\n1 {list}\n")));
        for text in [two, four] {
            assert!(text.contains(expected), "{text}");
        }
    }
}

/// A cell of every kind, written in both versions in the order of Gmsh: its nodes come back in the order of the kind.
#[test]
fn cells_of_every_kind_are_read_and_written() {
    for kind in CellKind::all() {
        let places = kind.reference_coordinates();
        let number: Vec<usize> = (1..=places.len()).collect();
        let list: Vec<String> =
            kind.table().gmsh.order.to_file(&number).iter().map(usize::to_string).collect();
        let nodes: String =
            places.iter().enumerate().map(|(k, [x, y, z])| format!("{} {x} {y} {z}\n", k + 1)).collect();
        let two = format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n{d} 1 \"part\"\n$EndPhysicalNames\n\
             $Nodes\n{n}\n{nodes}$EndNodes\n$Elements\n1\n1 {gmsh} 2 1 1 {list}\n$EndElements\n",
            d = kind.dimension(),
            n = places.len(),
            gmsh = kind.table().gmsh.number,
            list = list.join(" "),
        );
        let mesh = parse(two.as_bytes(), "a.msh", 1.0).unwrap_or_else(|error| panic!("{kind:?} {error}"));
        let expected: Vec<usize> = (0..places.len()).collect();
        assert_eq!((mesh.elements[0].kind(), mesh.elements[0].nodes()), (kind, &expected[..]));
        assert_eq!((&mesh.nodes, mesh.regions[0].dimension), (&places, kind.dimension()));
        let four = to_msh(&mesh, 1.0).unwrap();
        let back =
            parse(four.as_bytes(), "a.msh", 1.0).unwrap_or_else(|error| panic!("{kind:?} {error}\n{four}"));
        assert_eq!((back.elements, back.regions), (mesh.elements, mesh.regions), "{kind:?}");
    }
}

/// A file of Gmsh itself: the middle nodes lie in the middle of their edges.
#[test]
fn second_order_of_gmsh_has_its_middles_in_place() {
    let mesh = parse(SECOND_ORDER, "a.msh", 1e-3).unwrap();
    let mut middles = 0;
    for cell in mesh.elements.iter().filter(|cell| !cell.kind().is_first_order()) {
        let at = |k: usize| mesh.nodes[cell.nodes()[k]];
        for (k, of) in cell.kind().table().middles.iter().enumerate().skip(cell.kind().n_corners()) {
            let mean: [f64; 3] = std::array::from_fn(|c| {
                of.iter().map(|i| at(usize::from(*i))[c]).sum::<f64>() / of.len() as f64
            });
            let length = (0..3).map(|c| (at(0)[c] - at(1)[c]).powi(2)).sum::<f64>().sqrt();
            let off = (0..3).map(|c| (at(k)[c] - mean[c]).powi(2)).sum::<f64>().sqrt();
            // Edges on arcs are curved.
            assert!(within(off, 0.1 * length, Discretisation), "{cell:?}");
            middles += 1;
        }
    }
    assert!(middles > 10, "{middles}");
}

#[test]
fn neighbours_may_be_turned_opposite_ways() {
    let plate = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"plate\"\n$EndPhysicalNames\n\
                 $Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n\
                 $Elements\n2\n1 3 2 1 1 1 2 5 4\n2 3 2 1 1 2 5 6 3\n$EndElements\n";
    let mesh = parse(plate.as_bytes(), "a.msh", 1.0).unwrap();
    assert_eq!(mesh.elements[1], crate::Cell::quadrilateral([1, 2, 5, 4]));
}

#[test]
fn damaged_bytes_never_panic() {
    let mut seed = 2026u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize
    };
    for (format, bytes) in FILES {
        let mut refused = 0;
        for _ in 0..2000 {
            let mut damaged = bytes.to_vec();
            for _ in 0..1 + random() % 3 {
                let at = random() % damaged.len();
                damaged[at] = random() as u8;
            }
            refused += usize::from(parse(&damaged, format, 1.0).is_err());
        }
        assert!(refused > 200, "{format}: only {refused} refused");
        let noise: Vec<u8> = (0..3000).map(|_| random() as u8).collect();
        fault([&bytes[..60], &noise].concat());
        fault(noise);
    }
}

#[test]
fn absurd_counts_are_refused_before_anything_is_allocated() {
    for (text, old) in [(BAR, "$Nodes\n2\n"), (BAR, "$Elements\n1\n")] {
        let name = old.split('\n').next().unwrap();
        let text = fault(text.replace(old, &format!("{name}\n100000000000\n")));
        assert!(text.contains("100000000000") && text.contains("rest of the file can hold"), "{text}");
    }
    fault(BAR.replace("1 1 2 1 1 1 2", "1 1 2000000000 1 1 1 2"));
    for (old, new) in [
        ("$Nodes\n1 2 1 2", "$Nodes\n100000000000 2 1 2"),
        ("1 1 0 2\n2", "1 1 0 100000000000\n2"),
        ("$Elements\n1 1 1 1\n1 1 1 1", "$Elements\n1 1 1 1\n1 1 1 100000000000"),
        ("$Entities\n0 1 0 0", "$Entities\n100000000000 1 0 0"),
        ("100 0 0 1 1 0\n$End", "100 0 0 100000000000 1 0\n$End"),
        ("$Nodes\n1 2 1 2", "$Nodes\n1 100000000000 1 2"),
        ("4.1 0 8", "4.1 0 99999999999999999999999"),
    ] {
        assert!(BAR_4.contains(old), "{old}");
        fault(BAR_4.replace(old, new));
    }
    for (format, bytes) in FILES {
        if format.ends_with("binary") {
            for at in (0..bytes.len() - 8).step_by(4) {
                let mut damaged = bytes.to_vec();
                damaged[at..at + 8].copy_from_slice(&100_000_000_000u64.to_le_bytes());
                let _ = parse(&damaged, format, 1.0);
            }
        }
    }
}

#[test]
fn each_wrong_file_is_told_what_is_wrong_with_it() {
    let missing = read(Path::new("no/such/file.msh"), 1.0).unwrap_err();
    assert!(missing.exit_code() == 2 && missing.to_string().contains("no/such/file.msh"));
    assert!(read(Path::new("."), 1.0).is_err());
    for (bytes, expected) in [
        (String::new(), "an empty file"),
        ("solid cube\nfacet".into(), "begins with \"solid cube\\nfacet\""),
        (BAR.replace("2.2 0 8", "4 0 8"), "version 4; expected version 4.1 or 2.2"),
        (BAR.replace("2.2 0 8", "1 0 8"), "gmsh -save -format msh41"),
        (BAR.replace("2.2 0 8", "2.2 0 4"), "data size 4"),
        (BAR.replace("2.2 0 8", "2.2 7 8"), "file type 7"),
        (BAR.replace("2.2 0 8", "hello"), "version, file type and data size"),
        (BAR.replace("PhysicalNames", "Comments"), "no named physical group"),
        (BAR_4.replace("PhysicalNames", "Comments"), "Physical Surface(\"disc\")"),
        (BAR.replace("\n1 1 \"bar\"", "\n1 1 bar"), "dimension number"),
        (BAR.replace("1\n1 1 \"bar\"", "2\n1 1 \"bar\""), "found 1 names; expected 2"),
        (
            BAR.replace("2 100 0 0", "2 nan 0 0"),
            "node 2 (line 11): found coordinates that are infinite or not a number",
        ),
        (BAR.replace("2 100 0 0", "2 1e999 0 0"), "infinite"),
        (BAR_4.replace("\n100 0 0", "\n1e999 0 0"), "node 2 (line 15): found coordinates"),
        (BAR_4.replace("\n100 0 0", "\nnan 0 0"), "not a number"),
        (BAR.replace("2 100 0 0", "2 x 0 0"), "line 11: found `x`; expected a number, the node's x"),
        (BAR.replace("2 100 0 0", "1 100 0 0"), "node 1 (line 11): found its number twice"),
        (
            BAR.replace("1 1 1 2\n", "1 1 1 7\n"),
            "element 1 (line 15): found node 7, which the file does not hold",
        ),
        (BAR.replace("1 1 2 1 1 1 2", "1 4 2 1 1 1 2 1 2"), "1 elements without length"),
        (BAR.replace("1 1 2 1 1 1 2", "1 26 2 1 1 1 2 1 2"), "third or higher order (1 of type 26)"),
        (BAR.replace("1 1 2 1 1 1 2", "1 -1 2 1 1 1 2"), "element type -1"),
        (BAR.replace("1 1 2 1 1 1 2", "1 1 2 0 1 1 2"), "no element in any physical group"),
        (BAR.replace("2 100 0 0", "2 0 0 0"), "element 1 (line 15): found 1 elements without length"),
    ] {
        let text = fault(&bytes);
        assert!(text.contains(expected), "{bytes}\n{text}");
    }
    assert!(parse(BAR.as_bytes(), "a.msh", f64::NAN).is_err());
}

#[test]
fn groups_without_a_name_are_called_by_their_number_and_stray_nodes_are_noted() {
    let text = BAR
        .replace("$Nodes\n2\n", "$Nodes\n3\n9 5 5 5\n")
        .replace("$Elements\n1\n", "$Elements\n2\n7 15 2 4 1 2\n");
    let mesh = parse(text.as_bytes(), "a.msh", 1.0).unwrap();
    assert_eq!(mesh.region_nodes(mesh.require("point 4", 0).unwrap()), [1]);
    assert_eq!((mesh.nodes.len(), mesh.origin.unused_nodes.as_slice()), (2, [9].as_slice()));
    assert!(crate::diagnose(&mesh).warnings[0].to_string().contains("node 9"));
}

#[test]
fn big_endian_and_carriage_returns_are_read() {
    let crlf = BAR.replace('\n', "\r\n");
    assert_eq!(parse(crlf.as_bytes(), "a.msh", 1.0).unwrap().nodes.len(), 2);
    let crlf = BAR_4.replace('\n', "\r\n");
    assert_eq!(parse(crlf.as_bytes(), "a.msh", 1.0).unwrap().nodes.len(), 2);
    let mut bytes = b"$MeshFormat\n2.2 1 8\n".to_vec();
    let int = |bytes: &mut Vec<u8>, values: &[i32]| values.iter().for_each(|v| bytes.extend(v.to_be_bytes()));
    int(&mut bytes, &[1]);
    bytes.extend(b"\n$EndMeshFormat\n$PhysicalNames\n1\n1 3 \"bar\"\n$EndPhysicalNames\n$Nodes\n2\n");
    for (tag, x) in [(1, 0.0f64), (2, 0.25)] {
        int(&mut bytes, &[tag]);
        [x, 0.0, 0.0].iter().for_each(|v| bytes.extend(v.to_be_bytes()));
    }
    bytes.extend(b"\n$EndNodes\n$Elements\n1\n");
    int(&mut bytes, &[1, 1, 2, 1, 3, 3, 1, 2]);
    bytes.extend(b"\n$EndElements\n");
    let mesh = parse(&bytes, "a.msh", 1.0).unwrap();
    assert_eq!(mesh.nodes[1], [0.25, 0.0, 0.0]);
}

/// Faults of single nodes and elements name their lines, in both versions of the format.
#[test]
fn nodes_and_elements_have_their_lines() {
    let torn = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"plate\"\n$EndPhysicalNames\n\
                $Nodes\n4\n4 0 1 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n\
                $Elements\n3\n1 2 2 1 1 1 2 3\n8 2 2 1 1 1 2 4\n9 2 2 1 1 1 2 4\n$EndElements\n";
    let text = parse(torn.as_bytes(), "a.msh", 1.0).unwrap_err().to_string();
    for part in [
        "a.msh: nodes 3 (line 13) and 4 (line 10): found two nodes",
        "element 9 (line 19): found 1 elements on",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let mesh = structured_plate(1.0, 1.0, 2, 2, Faces::Triangles).unwrap();
    let lines: Vec<String> = to_msh(&mesh, 1.0).unwrap().lines().map(str::to_string).collect();
    let read = parse(lines.join("\n").as_bytes(), "a.msh", 1.0).unwrap();
    let first = |k: usize| lines[k - 1].split(' ').next().unwrap().parse::<u64>().unwrap();
    assert_eq!(read.origin.node_lines.len(), mesh.nodes.len());
    assert_eq!(read.origin.element_lines.len(), read.elements.len());
    for (tag, line) in read.origin.node_tags.iter().zip(&read.origin.node_lines) {
        assert!(first(*line) == *tag && !lines[line - 1].contains(' '), "{tag} {line}");
    }
    for (tag, line) in read.origin.element_tags.iter().zip(&read.origin.element_lines) {
        assert_eq!(first(*line), *tag);
    }
}
