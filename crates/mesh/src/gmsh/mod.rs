//! Reads Gmsh meshes: MSH 4.1 and 2.2, ASCII and binary, cells of every [`super::CellKind`].
//!
//! Format: Gmsh reference manual, "MSH file format" and "MSH file format version 2".
//!
//! A file passes through five steps: its header says which reader takes it (`msh4`, by the crate mshio, or `msh2`), the reader lists what the file
//! holds (`RawMesh`), `names` reads the physical names, `raw` turns named groups into regions, and `orient` turns
//! neighbouring faces alike. Then the mesh is checked ([`check`]). Whatever the bytes, the answer is a mesh or a fault
//! that says where and what; no count in the file makes the reader allocate more than the file's size warrants.
//!
//! As Gmsh does, the readers take sections in any order and pass over lines between them that do not begin with `$`.

mod bytes;
mod msh2;
mod msh4;
mod names;
mod raw;

use super::{Mesh, check, orient};
use bytes::{ByteReader, Encoding};
use raw::{LineNumbers, RawMesh};
use std::path::Path;
use stridor_base::error::read::{plain, read_bytes};
use stridor_base::error::{Error, Fault, Faults, Result};

/// Reads the mesh file `path`, whose coordinates are in units of `unit_in_metres` (0.001: millimetres).
///
/// Physical groups become regions by their names; a group without a name is called `point 3`, `curve 3` or
/// `surface 3` after its number. Elements of no group are left out, and so are the nodes that only they use. Nodes and
/// elements are ordered by their tags.
///
/// # Errors
/// All faults that were found: a file that cannot be read or is cut off, another version, no named physical group,
/// elements of third or higher order, and the faults of [`super::diagnose`].
pub fn read(path: &Path, unit_in_metres: f64) -> Result<Mesh> {
    let place = path.display().to_string();
    let expected = "a Gmsh mesh (.msh), such as `stridor mesh rig` writes";
    parse(&read_bytes(path, expected)?, &place, unit_in_metres)
}

/// Like [`read`], from bytes in memory; messages call them `place`.
///
/// ```
/// let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"bar\"\n$EndPhysicalNames\n\
///             $Nodes\n2\n1 0 0 0\n2 100 0 0\n$EndNodes\n$Elements\n1\n1 1 2 1 1 1 2\n$EndElements\n";
/// let mesh = stridor_mesh::gmsh::parse(text.as_bytes(), "bar.msh", 0.001)?;
/// assert_eq!((mesh.nodes[1], mesh.regions[0].name.as_str()), ([0.1, 0.0, 0.0], "bar"));
/// # Ok::<(), stridor_base::error::Error>(())
/// ```
pub fn parse(bytes: &[u8], place: &str, unit_in_metres: f64) -> Result<Mesh> {
    if !(unit_in_metres.is_finite() && unit_in_metres > 0.0) {
        let found = unit_in_metres.to_string();
        return Err(Error::input(Fault::new(format!("{place} unit"), found, "a positive number of metres")));
    }
    let text = plain(bytes);
    let header = header(&text, place)?;
    let bytes = if header.encoding == Encoding::Ascii { &*text } else { bytes };
    let reader = ByteReader::new(bytes, 0, header.encoding, place);
    let raw: RawMesh = match header.version {
        Version::Four => msh4::parse(reader)?,
        Version::Two => msh2::parse(reader)?,
    };
    let names = names::parse(bytes, place)?;
    let mut mesh =
        raw.into_mesh(&names, (place, &LineNumbers::new(bytes, header.encoding)), unit_in_metres)?;
    orient::turn_alike(&mut mesh);
    let faults = check::diagnose(&mesh).faults.0;
    let placed = faults.into_iter().map(|f| Fault { place: format!("{place}: {}", f.place), ..f }).collect();
    Faults(placed).into_result(mesh)
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Version {
    Two,
    Four,
}

struct GmshHeader {
    version: Version,
    encoding: Encoding,
}

/// Reads `$MeshFormat`: version, 0 (ASCII) or 1 (binary), size of a number; and the byte order of a binary file.
fn header(bytes: &[u8], place: &str) -> Result<GmshHeader> {
    let wrong = |found: String, expected: &str, help: &str| {
        Error::input(Fault::new(format!("{place}: $MeshFormat"), found, expected).with_help(help))
    };
    const EXPECTED: &str = "a Gmsh mesh, MSH 4.1 or 2.2";
    const CONVERT: &str = "Convert it: `gmsh -save -format msh41 -o new.msh old.msh`";
    const EXPORT: &str = "Write it as Gmsh 4.1 or 2.2, its sets as physical groups with names, in the program that made it; \
                          `gmsh` itself does not convert Abaqus (.inp) or NASTRAN (.bdf) with their sets";
    if bytes.is_empty() {
        return Err(wrong("an empty file".into(), EXPECTED, ""));
    }
    let Some(start) = names::line_with(bytes, "$MeshFormat") else {
        let first = String::from_utf8_lossy(&bytes[..bytes.len().min(24)]).escape_debug().to_string();
        return Err(wrong(format!("a file that begins with \"{first}\""), EXPECTED, EXPORT));
    };
    let mut lines = bytes[start..].split_inclusive(|b| *b == b'\n');
    let skipped = lines.next().map_or(0, <[u8]>::len);
    let line = lines.next().unwrap_or_default();
    let body = start + skipped + line.len();
    let text = String::from_utf8_lossy(line);
    let words: Vec<&str> = text.split_whitespace().collect();
    let [version, kind, size] = words.as_slice() else {
        return Err(wrong(
            format!("{:?}", text.trim_end()),
            "version, file type and data size, like `4.1 0 8`",
            CONVERT,
        ));
    };
    let version = match version.parse::<f64>() {
        Ok(4.1) => Version::Four,
        Ok(v) if (2.0..3.0).contains(&v) => Version::Two,
        _ => return Err(wrong(format!("version {version}"), "version 4.1 or 2.2", CONVERT)),
    };
    if *size != "8" {
        return Err(wrong(format!("data size {size}"), "data size 8", CONVERT));
    }
    let encoding = match *kind {
        "0" => Encoding::Ascii,
        "1" => match bytes.get(body..body + 4) {
            Some([1, 0, 0, 0]) => Encoding::LittleEndian,
            Some([0, 0, 0, 1]) => Encoding::BigEndian,
            _ => {
                return Err(wrong(
                    "no byte order mark".into(),
                    "the integer 1 after a binary file's header",
                    CONVERT,
                ));
            }
        },
        _ => return Err(wrong(format!("file type {kind}"), "0 (ASCII) or 1 (binary)", CONVERT)),
    };
    Ok(GmshHeader { version, encoding })
}

#[cfg(test)]
mod tests;
