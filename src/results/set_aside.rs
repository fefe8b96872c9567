//! An interrupted record is not deleted: it is moved to a folder of its own.

use super::folder::{FILES, owned, prepare_folder, refusal};
use super::record::{CHECKPOINT, RECORD, ended};
use crate::error::Result;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Moves an interrupted record with all the files of its run to a folder of its own, whose path is returned.
pub(crate) fn set_aside(dir: &Path) -> Result<Option<PathBuf>> {
    // It is unknown whether the work of a damaged one had ended.
    if matches!(ended(dir), Ok(None | Some(true))) {
        return Ok(None);
    }
    // One without a record is of a move that was killed on its way: the record goes last.
    let aside = (1..).map(|k| dir.join(format!("interrupted-{k}"))).find(|path| !path.join(RECORD).exists());
    let aside = aside.expect("some number is free");
    prepare_folder(&aside)?;
    let mut names = owned(dir);
    names.insert(CHECKPOINT.into());
    names.remove(RECORD);
    for name in names.iter().map(String::as_str).chain([RECORD, FILES]) {
        let path = dir.join(name);
        if let Err(source) = std::fs::rename(&path, aside.join(name))
            && source.kind() != ErrorKind::NotFound
        {
            return Err(refusal(&path, source));
        }
    }
    Ok(Some(aside))
}

#[cfg(test)]
mod tests {
    use super::super::write_result;
    use super::*;
    use std::collections::BTreeSet;

    fn names(dir: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(dir).unwrap().flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        names.collect::<BTreeSet<String>>().into_iter().collect()
    }

    #[test]
    fn an_interrupted_record_is_moved_with_its_files_even_when_the_move_was_killed() {
        let dir = tempfile::tempdir().unwrap();
        let dir = dir.path();
        write_result(dir, "transient.csv", b"rows").unwrap();
        std::fs::write(dir.join("notes.txt"), "mine").unwrap();
        assert_eq!(set_aside(dir).unwrap(), None);
        for k in ["interrupted-1", "interrupted-2"] {
            write_result(dir, "transient.csv", b"rows").unwrap();
            write_result(dir, CHECKPOINT, b"state").unwrap();
            write_result(dir, RECORD, b"points that are damaged").unwrap();
            if k == "interrupted-2" {
                std::fs::create_dir(dir.join(k)).unwrap();
                std::fs::rename(dir.join(CHECKPOINT), dir.join(k).join(CHECKPOINT)).unwrap();
            }
            assert_eq!(set_aside(dir).unwrap(), Some(dir.join(k)));
            assert_eq!(names(&dir.join(k)), [FILES, CHECKPOINT, RECORD, "transient.csv"]);
        }
        assert_eq!(names(dir), ["interrupted-1", "interrupted-2", "notes.txt"]);
    }
}
