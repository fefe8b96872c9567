//! The readers, each from bytes in memory.

use sha2::{Digest, Sha256};
use std::path::PathBuf;
use stridor::case::{Case, read_test};
use stridor::decks::{Format, read_bytes};
use stridor::error::{Error, Fault, Result};
use stridor::linalg::matrix_files::{self, Found};
use stridor::results::record::{self, Entry, Saved};
use stridor::search::SearchFile;
use stridor::validation::Reference;
use stridor::{job, measured::uff, mesh::gmsh};

/// A reader and what it may need.
pub struct Reader {
    pub name: &'static str,
    /// Reads the bytes; what it found in few words, which distinguishes kinds of inputs.
    pub read: fn(&[u8]) -> Result<String>,
    /// Files of the repository to begin with, by their folder and the end of their name, beside those of the corpus.
    pub samples: &'static [(&'static str, &'static str)],
    /// Memory: at most so many times the input …
    pub times: usize,
    /// … and so many bytes.
    pub constant: usize,
}

const KIB: usize = 1 << 10;

/// `times` is what an input of the densest kind takes, a list just after it has been doubled and copied: `1,1,1` in a list of
/// TOML makes some 110 bytes of two, a line of one digit a mode of 64, an empty line of a universal file 32.
pub const READERS: [Reader; 17] = [
    Reader {
        name: "mesh",
        read: mesh,
        samples: &[("crates/mesh/tests/data", ".msh"), ("validation", ".msh")],
        times: 16,
        constant: 64 * KIB,
    },
    Reader {
        name: "matrix",
        read: matrix,
        samples: &[("validation", ".mtx")],
        times: 24,
        // Columns that are empty.
        constant: (128 << 10) * KIB,
    },
    Reader {
        name: "universal",
        read: universal,
        samples: &[("validation", ".uff")],
        times: 128,
        constant: 64 * KIB,
    },
    Reader { name: "table", read: table, samples: &[("validation", ".csv")], times: 128, constant: 64 * KIB },
    Reader { name: "rows", read: rows, samples: &[], times: 64, constant: 64 * KIB },
    Reader { name: "points", read: points, samples: &[], times: 128, constant: 64 * KIB },
    Reader { name: "checkpoint", read: checkpoint, samples: &[], times: 16, constant: 64 * KIB },
    // Entries of a few bytes each.
    Reader { name: "record", read: record, samples: &[], times: 64, constant: 64 * KIB },
    Reader {
        name: "test",
        read: test,
        samples: &[("validation", "list.toml"), ("validation", "tap.toml")],
        times: 192,
        constant: 512 * KIB,
    },
    Reader {
        name: "case",
        read: case,
        samples: &[("validation", "case.toml")],
        times: 224,
        constant: 512 * KIB,
    },
    Reader {
        name: "reference",
        read: reference,
        samples: &[("validation", "reference.toml")],
        times: 192,
        constant: 512 * KIB,
    },
    Reader {
        name: "search",
        read: search,
        samples: &[("validation", "search.toml")],
        times: 192,
        constant: 512 * KIB,
    },
    // Members of sets that are named again, and parts that are placed again.
    Reader { name: "abaqus", read: abaqus, samples: &[], times: 256, constant: (4 << 10) * KIB },
    Reader { name: "nastran", read: nastran, samples: &[], times: 256, constant: (4 << 10) * KIB },
    Reader { name: "ansys", read: ansys, samples: &[], times: 256, constant: (4 << 10) * KIB },
    Reader { name: "groups", read: groups, samples: &[], times: 256, constant: (4 << 10) * KIB },
    Reader { name: "grid", read: grid, samples: &[], times: 256, constant: (4 << 10) * KIB },
];

/// log₂: counts of about the same size are the same kind.
fn about(count: usize) -> u32 {
    count.checked_ilog2().map_or(0, |log| log + 1)
}

fn mesh(bytes: &[u8]) -> Result<String> {
    let mesh = gmsh::parse(bytes, "mesh", 1e-3)?;
    Ok(format!("{} nodes, {} regions", about(mesh.nodes.len()), about(mesh.regions.len())))
}

fn matrix(bytes: &[u8]) -> Result<String> {
    let matrix = match matrix_files::parse("matrix", bytes, 'K', 0)? {
        Found::Whole(matrix) => matrix,
        Found::Labelled(matrix) => matrix.numbered(&matrix.labels().into_iter().collect::<Vec<_>>())?,
    };
    Ok(format!("{} rows, {}", about(matrix.re.nrows()), about(matrix.re.compute_nnz())))
}

fn universal(bytes: &[u8]) -> Result<String> {
    let records = uff::read("universal", bytes, uff::Unstated { unit: 1e-3, quantity: None })?;
    let counts = [records.points.len(), records.modes.len(), records.functions.len()];
    let (_, warnings) = records.into_set();
    Ok(format!("{:?} {}", counts.map(about), about(warnings.len())))
}

/// A model of another program; one in memory includes no files.
fn deck(bytes: &[u8], format: Format) -> Result<String> {
    let deck = read_bytes("deck", bytes, format)?;
    let counts = [
        deck.nodes.len(),
        deck.elements.len(),
        deck.node_sets.len() + deck.element_sets.len() + deck.surfaces.len(),
        deck.materials.len() + deck.sections.len(),
        deck.supports.len() + deck.equations.len(),
        deck.ties.len() + deck.couplings.len() + deck.contacts.len(),
        deck.masses.len() + deck.springs.len(),
        deck.loads.len() + deck.motions.len() + deck.analyses.len(),
        deck.ledger.rows().count(),
    ];
    Ok(format!("{:?}", counts.map(about)))
}

fn abaqus(bytes: &[u8]) -> Result<String> {
    deck(bytes, Format::Abaqus)
}

fn nastran(bytes: &[u8]) -> Result<String> {
    deck(bytes, Format::Nastran)
}

fn ansys(bytes: &[u8]) -> Result<String> {
    deck(bytes, Format::Ansys)
}

fn groups(bytes: &[u8]) -> Result<String> {
    deck(bytes, Format::Universal)
}

fn grid(bytes: &[u8]) -> Result<String> {
    deck(bytes, Format::Vtk)
}

fn table(bytes: &[u8]) -> Result<String> {
    Ok(about(job::read_modes("table", &String::from_utf8_lossy(bytes))?.modes.len()).to_string())
}

/// Rows of the matrices, as many as the table has lines.
fn rows(bytes: &[u8]) -> Result<String> {
    let text = String::from_utf8_lossy(bytes);
    let lines = text.lines().skip(1).filter(|line| !line.trim().is_empty()).count();
    let (nodes, free) = job::read_rows("rows", &text, lines)?;
    Ok(format!("{} {}", about(nodes.len()), about(free.len())))
}

fn points(bytes: &[u8]) -> Result<String> {
    Ok(about(job::read_points("points", &String::from_utf8_lossy(bytes), 9)?.len()).to_string())
}

/// The bytes with the checksum that belongs to them.
fn mended(bytes: &[u8]) -> Vec<u8> {
    let said = &bytes[..bytes.len().saturating_sub(32)];
    [said, &Sha256::digest(said)[..]].concat()
}

/// As it is, and with its checksum mended.
fn checkpoint(bytes: &[u8]) -> Result<String> {
    let read = Saved::from_bytes(bytes).or_else(|_| Saved::from_bytes(&mended(bytes)));
    let saved = read.map_err(|what| Error::input(Fault::new("checkpoint", what, "a checkpoint")))?;
    Ok(about(saved.march.arrays.len()).to_string())
}

/// A record with the checksums that belong to its entries.
fn mended_record(bytes: &[u8]) -> Vec<u8> {
    let (mut all, mut rest) = (bytes[..16.min(bytes.len())].to_vec(), bytes.get(16..).unwrap_or_default());
    while let Some((length, after)) = rest.split_first_chunk::<8>() {
        let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
        let Some((_, after)) = after.split_at_checked(length).filter(|(_, after)| after.len() >= 32) else {
            break;
        };
        all.extend(&rest[..8 + length]);
        all.extend(Sha256::digest(&all));
        rest = &after[32..];
    }
    all
}

/// As it is, and with its checksums mended: records of runs and of parts.
fn record(bytes: &[u8]) -> Result<String> {
    let entries = match record::from_bytes(bytes) {
        Ok(entries) if !entries.is_empty() => entries,
        _ => record::from_bytes(&mended_record(bytes))?,
    };
    let mut kinds = [0; 7];
    for entry in &entries {
        kinds[match entry {
            Entry::Head(_) | Entry::Reference(_) => 0,
            Entry::Answer { modes: Ok(_), .. } => 1,
            Entry::Answer { modes: Err(_), .. } => 2,
            Entry::Transient { .. } => 3,
            Entry::Rows { .. } => 4,
            Entry::Field { .. } => 5,
            Entry::End => 6,
        }] += 1;
    }
    Ok(format!("{:?}", kinds.map(about)))
}

fn test(bytes: &[u8]) -> Result<String> {
    let records = read_test("test", &String::from_utf8_lossy(bytes))?;
    Ok(format!("{} {}", about(records.points.len()), about(records.modes.len())))
}

/// A case must also give its scalars, and what is written of it must read as the same case.
fn case(bytes: &[u8]) -> Result<String> {
    let case = Case::parse("case", &String::from_utf8_lossy(bytes), PathBuf::new())?;
    assert_eq!(Case::parse("again", &case.to_toml(), PathBuf::new())?, case);
    Ok(about(case.parameters().len()).to_string())
}

/// The case of every reference and search.
fn sample_case(_: &str) -> Result<Case> {
    Case::parse("case", include_str!("../validation/two-dof/case.toml"), PathBuf::new())
}

fn reference(bytes: &[u8]) -> Result<String> {
    let text = String::from_utf8_lossy(bytes);
    Ok(about(Reference::parse("reference", &text, sample_case)?.checks.len()).to_string())
}

fn search(bytes: &[u8]) -> Result<String> {
    let text = String::from_utf8_lossy(bytes);
    Ok(about(SearchFile::parse("search", &text, sample_case)?.parameters.len()).to_string())
}
