//! Origin of results: the case and the files it reads.

use super::bytes::{Bytes, Read as Parsed, RecordCursor};
use crate::error::{Error, Fault, Result};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Differences that are shown.
const SHOWN: usize = 3;
/// Characters of a value that are shown.
const CUT: usize = 40;

/// A file that a case reads.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct InputFile {
    /// As the case names it.
    pub path: String,
    /// Its length \[byte\].
    pub bytes: u64,
    /// SHA-256 of its content, hexadecimal.
    pub sha256: String,
}

impl InputFile {
    /// Reads the file that a case in `folder` names `path`.
    ///
    /// # Errors
    /// [`Error::Io`]: it cannot be read.
    pub fn read(folder: &Path, path: &str) -> Result<Self> {
        let place = folder.join(path);
        let digest = || {
            let (mut file, mut hasher, mut bytes) = (File::open(&place)?, Sha256::new(), 0);
            let mut buffer = vec![0; 1 << 16];
            loop {
                match file.read(&mut buffer)? {
                    0 => break Ok((bytes, hexadecimal(&hasher.finalize()))),
                    count => {
                        hasher.update(&buffer[..count]);
                        bytes += count as u64;
                    }
                }
            }
        };
        let digest: std::io::Result<(u64, String)> = digest();
        let (bytes, sha256) = digest.map_err(|source| Error::io(&place, source, "Make the file readable"))?;
        Ok(InputFile { path: path.into(), bytes, sha256 })
    }
}

impl InputFile {
    /// A file at `path` that has this text.
    pub fn of_text(path: &str, text: &str) -> Self {
        let sha256 = hexadecimal(&Sha256::digest(text.as_bytes()));
        InputFile { path: path.into(), bytes: text.len() as u64, sha256 }
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The case and the files it reads.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecordOrigin {
    /// The resolved case as TOML.
    pub case: String,
    /// The files.
    pub inputs: Vec<InputFile>,
}

/// Advice where an interrupted run cannot be resumed.
pub(super) const START_OVER: &str = "Run without --resume to start over (an interrupted run is kept aside), or name another folder with --out";

impl RecordOrigin {
    /// Whether results of `earlier` at `place` are results of this; otherwise the keys of the case, or the files, that have changed,
    /// with the advice `help`.
    pub(super) fn check(&self, earlier: &RecordOrigin, place: &Path, help: &str) -> Result<()> {
        let refused = |found: String, expected: &str| {
            let fault = Fault::new(place.display().to_string(), found, expected);
            Err(Error::input(fault.with_help(help)))
        };
        let changed = differences(&earlier.case, &self.case);
        if !changed.is_empty() {
            let found = format!("results of another case: {}", shown(&changed));
            return refused(found, "those of this case");
        }
        let before: BTreeMap<&str, &InputFile> =
            earlier.inputs.iter().map(|file| (file.path.as_str(), file)).collect();
        let changed = self.inputs.iter().filter(|file| before.get(file.path.as_str()) != Some(file));
        let changed: Vec<String> = changed
            .map(|file| {
                let was = before.get(file.path.as_str()).map_or("unknown".into(), |was| {
                    format!("{} bytes, SHA-256 {}…", was.bytes, cut(&was.sha256, 12))
                });
                let is = format!("{} bytes, SHA-256 {}…", file.bytes, cut(&file.sha256, 12));
                format!("`{}` has changed since ({was}; now {is})", cut(&file.path, 2 * CUT))
            })
            .collect();
        if changed.is_empty() {
            return Ok(());
        }
        refused(format!("results of other files: {}", shown(&changed)), "the files as they were")
    }

    /// Adds it to `bytes`.
    pub(super) fn write(&self, bytes: &mut Bytes) {
        bytes.text(&self.case);
        bytes.count(self.inputs.len());
        for InputFile { path, bytes: length, sha256 } in &self.inputs {
            bytes.text(path);
            bytes.0.extend(length.to_le_bytes());
            bytes.text(sha256);
        }
    }

    /// Takes it from bytes.
    pub(super) fn read(from: &mut RecordCursor) -> Parsed<Self> {
        let case = from.text()?;
        let count = from.count(24)?;
        let input = |_| Ok(InputFile { path: from.text()?, bytes: from.whole()?, sha256: from.text()? });
        let inputs = (0..count).map(input).collect::<Parsed<_>>()?;
        Ok(RecordOrigin { case, inputs })
    }
}

/// The first few, and how many more.
fn shown(all: &[String]) -> String {
    let more = all.len().saturating_sub(SHOWN);
    let first = all[..all.len() - more].join(", ");
    if more == 0 { first } else { format!("{first}, and {more} more") }
}

/// Each key in which two cases differ, with both values.
fn differences(earlier: &str, now: &str) -> Vec<String> {
    if earlier == now {
        return Vec::new();
    }
    let [earlier, now] = [earlier, now].map(|text| {
        let mut values = BTreeMap::new();
        // What is not TOML has no keys.
        if let Ok(table) = text.parse::<toml::Table>() {
            table.iter().for_each(|(key, value)| flatten(key, value, &mut values));
        }
        values
    });
    let keys: std::collections::BTreeSet<&String> = earlier.keys().chain(now.keys()).collect();
    let differ = keys.into_iter().filter(|key| earlier.get(*key) != now.get(*key));
    let value =
        |value: Option<&String>| value.map_or("absent".to_string(), |value| format!("`{}`", cut(value, CUT)));
    let found: Vec<String> = differ
        .map(|key| {
            format!("`{}` was {} and is {}", cut(key, 2 * CUT), value(earlier.get(key)), value(now.get(key)))
        })
        .collect();
    if found.is_empty() { vec!["its text differs".into()] } else { found }
}

fn flatten(path: &str, value: &toml::Value, values: &mut BTreeMap<String, String>) {
    match value {
        toml::Value::Table(table) => {
            table.iter().for_each(|(key, value)| flatten(&format!("{path}.{key}"), value, values));
        }
        value => {
            values.insert(path.to_string(), value.to_string());
        }
    }
}

/// The first characters of a text, without control characters.
fn cut(text: &str, characters: usize) -> String {
    text.chars().filter(|c| !c.is_control()).take(characters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_is_named_with_both_values() {
        let dir = Path::new("out");
        let input =
            |path: &str, sha256: &str| InputFile { path: path.into(), bytes: 5, sha256: sha256.into() };
        let origin = |case: &str, sha256: &str| RecordOrigin {
            case: case.into(),
            inputs: vec![input("a.msh", "00"), input("b.uff", sha256)],
        };
        let earlier = origin("title = \"x\"\n[cea]\nband = [0, 1]\na = 1\nb = 1\nc = 1\n", "11");
        assert!(earlier.check(&earlier, dir, START_OVER).is_ok());
        let now = origin("title = \"x\"\n[cea]\nband = [0, 2]\na = 2\nb = 2\nc = 2\n", "11");
        let said = now.check(&earlier, dir, START_OVER).unwrap_err();
        assert_eq!(said.exit_code(), 2);
        let said = said.to_string();
        assert!(said.contains("`cea.a` was `1` and is `2`") && said.contains("and 1 more"), "{said}");
        assert!(said.contains("`cea.band`") || said.contains("`cea.b`"), "{said}");
        let fewer = origin("title = \"x\"\n", "11").check(&earlier, dir, START_OVER).unwrap_err().to_string();
        assert!(fewer.contains("`cea.a` was `1` and is absent"), "{fewer}");
        let changed = RecordOrigin { inputs: origin("", "22").inputs, ..earlier.clone() };
        let said = changed.check(&earlier, dir, START_OVER).unwrap_err().to_string();
        assert!(said.contains("`b.uff` has changed") && !said.contains("a.msh"), "{said}");
    }
}
