//! Parts of a job array: the answers that one share of all sweeps and maps of a case asks for, a file each (`3-of-40.bin`).
//!
//! Sixteen bytes that name the format, the payload, and the SHA-256 of all before it (32 bytes). The file is replaced whole, after
//! what it holds is on the disk, so that a process that is killed leaves the one before. Each part has a lock of its own: parts of
//! one folder are computed at the same time.

use super::PAUSE;
use super::bytes::{Bytes, Read, RecordCursor};
use super::origin::RecordOrigin;
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::c64;
use crate::results::folder::{refusal, replace};
use crate::results::lock::FolderLock;
use crate::sweep::{Answers, Modes};
use faer::Mat;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The format and its version.
const FORMAT: &[u8; 16] = b"stridor part   1";

/// One of several shares of the sweeps and maps of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Part {
    /// How many shares there are.
    pub of: usize,
    /// Which one, from 1.
    pub number: usize,
}

impl Part {
    /// Reads `3/40`.
    ///
    /// # Errors
    /// Input: anything else.
    pub fn read(text: &str) -> Result<Self> {
        let part = text
            .split_once('/')
            .and_then(|(number, of)| Some(Part { number: number.parse().ok()?, of: of.parse().ok()? }));
        part.filter(|part| (1..=part.of).contains(&part.number)).ok_or_else(|| {
            let expected = "the part and how many there are, from 1/40 to 40/40 for a job array of 40";
            Error::input(Fault::new("--part", format!("`{text}`"), expected))
        })
    }

    /// The name of its file.
    pub fn file(self) -> String {
        format!("{}-of-{}.bin", self.number, self.of)
    }

    fn of_file(name: &str) -> Option<Self> {
        let (number, of) = name.strip_suffix(".bin")?.split_once("-of-")?;
        let part = Part { number: number.parse().ok()?, of: of.parse().ok()? };
        (part.file() == name).then_some(part)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "part {} of {}", self.number, self.of)
    }
}

/// Answers of a part.
#[derive(Debug, Clone)]
pub struct PartRecord {
    /// Version and commit of the program.
    pub program: String,
    /// The case and the files it reads.
    pub origin: RecordOrigin,
    /// Which part it is.
    pub part: Part,
    /// SHA-256 of M Φ of the real modes that shapes are compared by.
    pub reference: [u8; 32],
    /// Whether the part has all answers that it asks for.
    pub done: bool,
    /// The answers, by the table of the case that asks for them: `sweep.NAME`, `map.NAME`.
    pub answers: BTreeMap<String, Answers>,
}

/// Version and commit of this program.
fn program() -> String {
    format!("{} ({})", env!("CARGO_PKG_VERSION"), crate::COMMIT.unwrap_or("unknown commit"))
}

impl PartRecord {
    fn new(part: Part, origin: RecordOrigin) -> Self {
        let answers = BTreeMap::new();
        PartRecord { program: program(), origin, part, reference: [0; 32], done: false, answers }
    }

    /// Contents of its file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Bytes(FORMAT.to_vec());
        bytes.text(&self.program);
        self.origin.write(&mut bytes);
        bytes.count(self.part.number);
        bytes.count(self.part.of);
        bytes.0.extend(self.reference);
        bytes.0.push(u8::from(self.done));
        bytes.count(self.answers.len());
        for (name, answers) in &self.answers {
            bytes.text(name);
            bytes.count(answers.len());
            for (place, answer) in answers {
                bytes.count(place.len());
                place.iter().for_each(|value| bytes.0.extend(value.to_le_bytes()));
                write_answer(&mut bytes, answer);
            }
        }
        let digest = Sha256::digest(&bytes.0);
        bytes.0.extend(digest);
        bytes.0
    }

    /// Reads its file; what is wrong with it otherwise.
    ///
    /// # Errors
    /// Bytes that are not what [`PartRecord::to_bytes`] writes.
    pub fn from_bytes(bytes: &[u8]) -> std::result::Result<Self, &'static str> {
        if bytes.get(..FORMAT.len()) != Some(FORMAT) {
            return Err("it is not a part of this version of the program");
        }
        let (said, digest) =
            bytes.split_at_checked(bytes.len().saturating_sub(32)).ok_or("it ends too early")?;
        if said.len() < FORMAT.len() || Sha256::digest(said)[..] != *digest {
            return Err("its checksum is wrong");
        }
        let mut from = RecordCursor(&said[FORMAT.len()..]);
        let program = from.text()?;
        let origin = RecordOrigin::read(&mut from)?;
        let part = Part { number: from.index()?, of: from.index()? };
        let reference = from.array()?;
        let done = from.array::<1>()? != [0];
        let count = from.count(16)?;
        let table = |_| {
            let name = from.text()?;
            let count = from.count(9)?;
            let answer = |_| {
                let values = from.count(8)?;
                let place = (0..values).map(|_| from.whole()).collect::<Read<_>>()?;
                Ok((place, read_answer(&mut from)?))
            };
            Ok((name, (0..count).map(answer).collect::<Read<_>>()?))
        };
        let answers = (0..count).map(table).collect::<Read<_>>()?;
        from.end(PartRecord { program, origin, part, reference, done, answers })
    }

    /// Reads the file of a part in the folder `dir`, if it is there.
    fn read(dir: &Path, part: Part, origin: &RecordOrigin) -> Result<Option<Self>> {
        let path = dir.join(part.file());
        let bytes = match std::fs::read(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            bytes => bytes.map_err(|source| refusal(&path, source))?,
        };
        let whole = PartRecord::from_bytes(&bytes)
            .and_then(|found| if found.part == part { Ok(found) } else { Err("it is another part") });
        let found = whole.map_err(|what| {
            let fault = Fault::new(path.display().to_string(), what, "the file as --part left it");
            Error::input(fault.with_help("Delete the file and compute the part again"))
        })?;
        let help = "Delete the parts of the other run, or name another folder with --out";
        origin.check(&found.origin, &path, help)?;
        if found.program != program() {
            let (found, own) = (format!("a part by version {}", found.program), program());
            let fault = Fault::new(path.display().to_string(), found, format!("version {own}"));
            return Err(Error::input(fault.with_help("Compute and merge all parts with one program")));
        }
        Ok(Some(found))
    }

    /// Whether its shapes can be compared with those of real modes with this `reference`, if it has shapes.
    ///
    /// # Errors
    /// Input: they cannot.
    pub fn check_reference(&self, dir: &Path, reference: [u8; 32]) -> Result<()> {
        let shapes = |answer: &Result<Modes>| answer.as_ref().is_ok_and(|modes| modes.vectors.nrows() > 0);
        if self.reference == reference || !self.answers.values().flatten().any(|(_, one)| shapes(one)) {
            return Ok(());
        }
        let place = dir.join(self.part.file()).display().to_string();
        let found =
            "shapes relative to real modes whose last digits differ: the processor is of another type";
        let fault = Fault::new(place, found, "the same real modes, bit for bit");
        Err(Error::input(fault.with_help("Compute all parts, and merge them, on processors of one type")))
    }
}

fn write_answer(bytes: &mut Bytes, answer: &Result<Modes>) {
    let mut kind = |kind: u8| bytes.0.push(kind);
    match answer {
        Ok(Modes { eigenvalues, vectors }) => {
            kind(0);
            bytes.count(eigenvalues.len());
            bytes.count(vectors.nrows());
            let shapes = (0..vectors.ncols()).flat_map(|k| vectors.col_as_slice(k));
            eigenvalues.iter().chain(shapes).for_each(|z| bytes.doubles([&z.re, &z.im]));
        }
        Err(Error::Analysis { what, found, help }) => {
            kind(1);
            [what, found, help].into_iter().for_each(|text| bytes.text(text));
        }
        Err(Error::Io { path, source, help }) => {
            kind(2);
            [&path.display().to_string(), &source.to_string(), help]
                .into_iter()
                .for_each(|text| bytes.text(text));
        }
        Err(Error::Input(Faults(faults))) => {
            kind(3);
            bytes.count(faults.len());
            let texts = faults.iter().flat_map(|f| [&f.place, &f.found, &f.expected, &f.help]);
            texts.for_each(|text| bytes.text(text));
        }
    }
}

fn read_answer(from: &mut RecordCursor) -> Read<Result<Modes>> {
    let [kind] = from.array()?;
    Ok(match kind {
        0 => {
            let count = from.count(16)?;
            let rows = from.count(16 * count)?;
            let mut complex = |count: usize| -> Read<Vec<c64>> {
                let values = from.doubles(2 * count)?;
                Ok(values.chunks_exact(2).map(|z| c64::new(z[0], z[1])).collect())
            };
            let (eigenvalues, shapes) = (complex(count)?, complex(rows * count)?);
            Ok(Modes { eigenvalues, vectors: Mat::from_fn(rows, count, |i, j| shapes[i + rows * j]) })
        }
        1 => Err(Error::analysis(from.text()?, from.text()?, from.text()?)),
        2 => Err(Error::io(from.text()?, from.text()?, from.text()?)),
        3 => {
            let count = from.count(32)?;
            let fault = |_| {
                let fault = Fault::new(from.text()?, from.text()?, from.text()?);
                Ok(fault.with_help(from.text()?))
            };
            Err(Error::Input(Faults((0..count).map(fault).collect::<Read<_>>()?)))
        }
        _ => return Err("an answer of an unknown kind"),
    })
}

/// The parts in the folder `dir` whose number is `of`, or that of the first.
fn listed(dir: &Path, of: Option<usize>) -> Result<Vec<Part>> {
    let entries = match std::fs::read_dir(dir) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(|source| refusal(dir, source))?,
    };
    let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut parts: Vec<Part> = names.filter_map(|name| Part::of_file(&name)).collect();
    parts.sort_unstable();
    let of = of.or(parts.first().map(|part| part.of));
    if let Some(other) = parts.iter().find(|part| Some(part.of) != of) {
        let expected = format!("parts of {}", of.unwrap_or_default());
        let fault = Fault::new(dir.join(other.file()).display().to_string(), other.to_string(), expected);
        let help = "Delete the parts of one number, or name another folder with --out";
        return Err(Error::input(fault.with_help(help)));
    }
    Ok(parts)
}

/// All parts in the folder `dir`, which are of `origin`.
///
/// # Errors
/// Input: parts of different numbers, of another case, of other files, of another program, damaged ones. The machine refuses.
pub fn read_parts(dir: &Path, origin: &RecordOrigin) -> Result<Vec<PartRecord>> {
    let mut faults = Faults::new();
    let parts = listed(dir, None)?;
    let read = |part: &Part| faults.take(PartRecord::read(dir, *part, origin)).flatten();
    let parts = parts.iter().filter_map(read).collect();
    faults.into_result(parts)
}

/// The file of a part that is being computed.
#[derive(Debug)]
pub struct PartFile {
    dir: PathBuf,
    /// What is known of the part.
    pub record: PartRecord,
    _lock: FolderLock,
    /// Before this moment the file is not written again.
    due: Option<Instant>,
}

impl PartFile {
    /// Locks a part in the folder `dir`, and reads what was computed of it before.
    ///
    /// # Errors
    /// Input: the folder has parts of another number, of another case, of other files, of another program, or damaged ones. Another
    /// process has the lock; the machine refuses.
    pub fn open(dir: &Path, part: Part, origin: RecordOrigin) -> Result<Self> {
        // All parts are read when they are merged.
        let others = listed(dir, Some(part.of))?.into_iter().filter(|other| *other != part).take(1);
        for part in others.chain([part]) {
            PartRecord::read(dir, part, &origin)?;
        }
        let lock =
            FolderLock::take_file(dir, &format!(".{}-of-{}.lock", part.number, part.of), &part.to_string())?;
        let earlier = PartRecord::read(dir, part, &origin)?;
        let record = earlier.unwrap_or_else(|| PartRecord::new(part, origin));
        Ok(PartFile { dir: dir.to_path_buf(), record, _lock: lock, due: None })
    }

    /// Begins to compute, with the `reference` that shapes are compared by.
    ///
    /// # Errors
    /// Input: shapes of this part, or of another in the folder, were compared by another one. The machine refuses.
    pub fn begin(&mut self, reference: [u8; 32]) -> Result<()> {
        let Part { of, number } = self.record.part;
        let other = listed(&self.dir, Some(of))?.into_iter().find(|other| other.number != number);
        let other = other.map(|other| PartRecord::read(&self.dir, other, &self.record.origin)).transpose()?;
        for earlier in other.flatten().iter().chain([&self.record]) {
            earlier.check_reference(&self.dir, reference)?;
        }
        self.record.reference = reference;
        self.save()
    }

    /// Adds an answer that the table `name` of the case asks for; it is on the disk at once, or soon where the disk takes long.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn add(&mut self, name: &str, place: Vec<u64>, answer: Result<Modes>) -> Result<()> {
        self.record.answers.entry(name.into()).or_default().insert(place, answer);
        if self.due.is_some_and(|due| Instant::now() < due) { Ok(()) } else { self.save() }
    }

    /// Writes all to the disk.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn save(&mut self) -> Result<()> {
        let begun = Instant::now();
        replace(&self.dir, &self.record.part.file(), &self.record.to_bytes(), true)?;
        self.due = Some(Instant::now() + PAUSE * begun.elapsed());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::record::InputFile;

    fn record(part: Part) -> PartRecord {
        let input = InputFile { path: "a.msh".into(), bytes: 3, sha256: "00".into() };
        let origin = RecordOrigin { case: "title = \"a case\"\n".into(), inputs: vec![input] };
        let modes = |rows: usize| {
            let vectors = Mat::from_fn(rows, 2, |i, j| c64::new(i as f64, -0.5 * j as f64));
            Ok(Modes { eigenvalues: vec![c64::new(-0.1, 7.0), c64::new(f64::NAN, 1e300)], vectors })
        };
        let fault = |place: &str| Fault::new(place, "this", "that").with_help("Do so");
        let refused = Err(Error::Input(Faults(vec![fault("here"), fault("there")])));
        let failed = Err(Error::analysis("steady sliding", "no contact", "Press harder"));
        let io = Err(Error::io("a/b", "Permission denied", "Ask for it"));
        let answers = [
            ("sweep.a", Answers::from([(vec![0], modes(3)), (vec![7], modes(0))])),
            ("map.b", Answers::from([(vec![2, 9], failed), (vec![3, 9], refused), (vec![5, 9], io)])),
        ];
        let answers = answers.map(|(name, answers)| (name.to_string(), answers)).into();
        PartRecord { reference: [7; 32], done: true, answers, ..PartRecord::new(part, origin) }
    }

    #[test]
    fn a_part_is_read_as_it_was_written_and_no_other_bytes_are() {
        let record = record(Part { number: 3, of: 40 });
        let bytes = record.to_bytes();
        let read = PartRecord::from_bytes(&bytes).unwrap();
        assert_eq!(format!("{read:?}"), format!("{record:?}"));
        for k in 0..bytes.len() {
            assert!(PartRecord::from_bytes(&bytes[..k]).is_err(), "{k}");
            let mut damaged = bytes.clone();
            damaged[k] ^= 1;
            assert!(PartRecord::from_bytes(&damaged).is_err(), "{k}");
            // With the checksum that belongs to them, they may be another part.
            let end = bytes.len() - 32;
            let digest = Sha256::digest(&damaged[..end]);
            damaged[end..].copy_from_slice(&digest);
            let _ = PartRecord::from_bytes(&damaged);
        }
    }

    #[test]
    fn a_part_resumes_and_its_shapes_are_compared_by_one_reference() {
        let dir = tempfile::tempdir().unwrap();
        let (dir, part) = (dir.path(), Part { number: 1, of: 2 });
        let earlier = record(part);
        let origin = earlier.origin.clone();
        let mut file = PartFile::open(dir, part, origin.clone()).unwrap();
        let twice = PartFile::open(dir, part, origin.clone()).unwrap_err();
        assert!(twice.to_string().contains("part 1 of 2 is in use by process"), "{twice}");
        file.begin([7; 32]).unwrap();
        for (name, answers) in earlier.answers.clone() {
            answers.into_iter().for_each(|(place, answer)| file.add(&name, place, answer).unwrap());
        }
        file.record.done = true;
        file.save().unwrap();
        drop(file);
        let mut file = PartFile::open(dir, part, origin.clone()).unwrap();
        assert_eq!(file.record.to_bytes(), earlier.to_bytes());
        assert!(file.begin([7; 32]).is_ok());
        let error = file.begin([8; 32]).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("1-of-2.bin"), "{error}");
        // So are those of its neighbours; eigenvalues alone fit all.
        let other = Part { number: 2, of: 2 };
        let mut neighbour = PartFile::open(dir, other, origin.clone()).unwrap();
        assert!(neighbour.begin([8; 32]).is_err());
        file.record.answers.remove("sweep.a");
        file.begin([8; 32]).unwrap();
        neighbour.begin([9; 32]).unwrap();
        let read = read_parts(dir, &origin).unwrap();
        assert_eq!(read.iter().map(|part| part.part).collect::<Vec<_>>(), [part, other]);
    }
}
