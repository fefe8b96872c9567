//! `results.h5`, safe against being killed at any moment.
//!
//! HDF5 keeps track of what is where in structures all over the file; a process that is killed while it writes them
//! leaves a file that may not open. So what is called `results.h5` never has its structure changed:
//!
//! - A run writes its stages to `results.new.h5`. When it begins what takes long, a run in time or a map, and at its
//!   end, this file takes the place of `results.h5` in one step; an earlier run's file is not touched before.
//! - A run in time and a map allocate all their numbers before that. From then on numbers are written into the space
//!   they have, and each time a flush and a count say how many; this changes no structure.
//! - What comes after that is written to a copy, again `results.new.h5`, which takes the place when it is whole.
//!
//! Before the file takes its place for the first time, the files of the earlier run are deleted, so that what is in the
//! folder is always of one run. The root attribute `complete` turns true at the end; a run that fails says why in `failed`.
//! A run that is killed in its first stages leaves its `results.new.h5`, which the next one overwrites.
//!
//! An interrupted run is resumed from `record.bin` and `checkpoint.bin` (see `record`); `results.h5` is only written.

use super::folder::{make_durable, own, prepare_folder, refusal, retire, synchronise};
use super::held::check_held;
use super::{RunResults, TransientTables};
use crate::dataset::{attribute, text_attribute};
use crate::error::Result;
use hdf5::file::FileBuilder;
use hdf5::plist::dataset_create::{AllocTime, FillTime};
use hdf5::types::OwnedDynValue;
use hdf5::{Extents, Group, H5Type};
use std::path::{Path, PathBuf};

/// File name.
const NAME: &str = "results.h5";

/// The results file of a run under way.
#[derive(Debug)]
pub struct ResultsFile {
    /// Open until it is finished.
    file: Option<hdf5::File>,
    /// Where the file is now.
    path: PathBuf,
    /// Where it belongs.
    home: PathBuf,
    /// Files of the folder that are not deleted with those of the earlier run.
    spared: Vec<PathBuf>,
    /// Whether those are deleted.
    alone: bool,
    /// Whether it has a result, so that it takes the place of an earlier file when the run fails.
    kept: bool,
    /// Whether a write was refused, so that it is not to be trusted.
    broken: bool,
    /// The tables of the run in time.
    pub(super) tables: TransientTables,
}

impl ResultsFile {
    /// Begins a results file in the folder `dir`, which is made when missing.
    ///
    /// # Errors
    /// [`crate::error::Error::Io`], here and in every other method, when `results.h5` cannot be written: a file in the
    /// folder's place, a folder that is not writable, a full disk.
    pub fn create(dir: &Path) -> Result<Self> {
        prepare_folder(dir)?;
        let (home, path) = (dir.join(NAME), dir.join("results.new.h5"));
        // The operating system explains better than the library why a file cannot be created.
        std::fs::File::create(&path).map_err(|source| refusal(&path, source))?;
        let file = options().create(&path).map_err(|source| refusal(&path, plain(&source)))?;
        let mut this = ResultsFile {
            file: Some(file),
            path,
            home,
            spared: Vec::new(),
            alone: false,
            kept: false,
            broken: false,
            tables: TransientTables::default(),
        };
        this.stage(|root| {
            text_attribute(root, "program", env!("CARGO_PKG_NAME"))?;
            text_attribute(root, "program_version", env!("CARGO_PKG_VERSION"))?;
            attribute(root, "schema_version", &super::SCHEMA_VERSION)?;
            attribute(root, "complete", &false)
        })?;
        Ok(this)
    }

    /// Leaves these files where they are when those of the earlier run are deleted.
    pub fn spare(&mut self, files: impl IntoIterator<Item = PathBuf>) {
        self.spared.extend(files);
    }

    /// Deletes the files of the earlier run, so that those of this one can be written.
    pub fn stand_alone(&mut self) -> Result<()> {
        if !self.alone {
            retire(self.folder(), &self.spared)?;
            self.alone = true;
        }
        Ok(())
    }

    /// Lets go of what was written, unless it is in its place already; the earlier file stays.
    pub fn discard(mut self) {
        self.kept = false;
    }

    /// Writes warnings and timings, marks the file complete or says why the run has failed, and closes it.
    pub fn finish(mut self, results: &RunResults) -> Result<()> {
        self.stage(|root| {
            super::summary::tail(results).write_hdf5(root)?;
            results.failed.iter().try_for_each(|error| text_attribute(root, "failed", error))?;
            root.attr("complete")?.write_scalar(&results.failed.is_none())
        })?;
        // The library writes when a file is closed, too.
        if let Some(file) = self.file.take() {
            let closed = file.close();
            self.broken |= closed.is_err();
            closed.map_err(|source| refusal(&self.path, plain(&source)))?;
        }
        // A file that says that the run is complete is there when all others are on the disk.
        make_durable(self.folder(), &self.path)?;
        self.take_place()?;
        synchronise(self.folder()).map_err(|source| refusal(&self.home, source))
    }

    fn folder(&self) -> &Path {
        self.home.parent().unwrap_or(Path::new(""))
    }

    /// The root group.
    fn root(&self) -> hdf5::Result<Group> {
        self.file.as_ref().ok_or("it is closed")?.as_group()
    }

    /// Hands all that was written to the operating system.
    fn flush(&self) -> hdf5::Result<()> {
        self.file.as_ref().map_or(Ok(()), hdf5::File::flush)
    }

    /// Writes one stage and flushes it; what is in its place already is copied first.
    pub(super) fn stage(&mut self, write: impl FnOnce(&Group) -> hdf5::Result<()>) -> Result<()> {
        self.step_aside()?;
        self.fill(write)
    }

    /// The same with a result in it, worth keeping even when a later stage fails.
    pub(super) fn keep(&mut self, write: impl FnOnce(&Group) -> hdf5::Result<()>) -> Result<()> {
        self.stage(write)?;
        self.kept = true;
        Ok(())
    }

    /// Writes numbers into allocated datasets, in the file's place too, and flushes them.
    pub(super) fn fill(&mut self, write: impl FnOnce(&Group) -> hdf5::Result<()>) -> Result<()> {
        let written = self.root().and_then(|root| write(&root)).and_then(|()| self.flush());
        self.broken |= written.is_err();
        written.map_err(|source| refusal(&self.path, plain(&source)))
    }

    /// Reads what was written.
    pub(super) fn read<T>(&self, read: impl FnOnce(&Group) -> hdf5::Result<T>) -> Result<T> {
        let found = self.root().and_then(|root| read(&root));
        found.map_err(|source| refusal(&self.path, plain(&source)))
    }

    /// Whether the file is where it belongs.
    pub(super) fn in_place(&self) -> bool {
        self.path == self.home
    }

    /// Takes the place of an earlier run's file, or of what this run had there.
    pub fn take_place(&mut self) -> Result<()> {
        if !self.in_place() {
            // The earlier file stays until this one replaces it.
            self.spared.push(NAME.into());
            self.stand_alone()?;
            own(self.folder(), NAME)?;
            std::fs::rename(&self.path, &self.home).map_err(|source| refusal(&self.home, source))?;
            self.path.clone_from(&self.home);
        }
        Ok(())
    }

    /// Goes on in a copy when the file is in its place.
    fn step_aside(&mut self) -> Result<()> {
        if self.in_place() {
            check_held(self.folder())?;
            let aside = self.home.with_file_name("results.new.h5");
            std::fs::copy(&self.home, &aside).map_err(|source| {
                let _ = std::fs::remove_file(&aside);
                refusal(&aside, source)
            })?;
            let file = options().open_rw(&aside).map_err(|source| refusal(&aside, plain(&source)))?;
            self.file = Some(file);
            self.path = aside;
        }
        Ok(())
    }
}

impl Drop for ResultsFile {
    /// A run that fails leaves the results it has; one without any leaves the earlier file and nothing beside it.
    fn drop(&mut self) {
        if self.path != self.home && (self.broken || !self.kept || self.take_place().is_err()) {
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

/// How a file is opened to write to it: without the buffer for raw data, which is written when a dataset is closed, where
/// errors are not reported and the numbers are lost.
pub(super) fn options() -> FileBuilder {
    let mut options = hdf5::File::with_options();
    options.with_fapl(|access| access.sieve_buf_size(0));
    options
}

/// Dataset of `count` numbers, allocated on the disk, to be filled later; `empty` until then.
pub(super) fn preallocated<T: H5Type + Into<OwnedDynValue>>(
    group: &Group,
    name: &str,
    count: impl Into<Extents>,
    empty: T,
) -> hdf5::Result<hdf5::Dataset> {
    let dataset = group.new_dataset::<T>().shape(count).alloc_time(Some(AllocTime::Early));
    dataset.fill_time(FillTime::Alloc).fill_value(empty).create(name)
}

/// The operating system's words inside an error of the library, which runs over several lines, or its first line.
pub(super) fn plain(error: &hdf5::Error) -> String {
    let text = error.to_string();
    if text.contains("Resource temporarily unavailable") {
        return "another program has the file open".into();
    }
    let cause = text.split_once("error message = '").and_then(|(_, rest)| rest.split_once('\''));
    let words = cause.map(|(words, _)| words).or(text.lines().next()).unwrap_or_default();
    // So the library says when it has lost the cause, as it does where space cannot be allocated.
    if words == "unknown library error" { "the file cannot be written".into() } else { words.into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::Describe;
    use crate::job::sample;
    use crate::results::NamedModes;
    use crate::results::SteadyResult;

    #[test]
    fn an_earlier_file_stays_until_there_is_a_result() {
        let dir = tempfile::tempdir().unwrap();
        let results = sample::rig();
        let home = dir.path().join("results.h5");
        std::fs::write(&home, "earlier").unwrap();
        {
            let mut file = ResultsFile::create(dir.path()).unwrap();
            file.write_head(&results).unwrap();
            assert_eq!(std::fs::read(&home).unwrap(), b"earlier");
        }
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1, "a run without results leaves nothing");
        // One that fails later leaves what it has.
        let mut file = ResultsFile::create(dir.path()).unwrap();
        file.write(&results.get::<NamedModes>().unwrap().describe()).unwrap();
        drop(file);
        let failed = hdf5::File::open(&home).unwrap();
        assert!(failed.dataset("modes/disc/frequency_hz").is_ok());
        assert!(!failed.attr("complete").unwrap().read_scalar::<bool>().unwrap());
        let mut file = ResultsFile::create(dir.path()).unwrap();
        file.write(&results.get::<SteadyResult>().unwrap().describe()).unwrap();
        file.finish(&results).unwrap();
        assert!(hdf5::File::open(&home).unwrap().group("steady_sliding").is_ok());
        let mut names: Vec<_> =
            std::fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, [".files", "results.h5"]);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn refusals_of_the_machine_are_errors_of_one_line() {
        let dir = tempfile::tempdir().unwrap();
        let occupied = dir.path().join("occupied");
        std::fs::write(&occupied, "keep").unwrap();
        std::os::unix::fs::symlink("/dev/full", dir.path().join("results.new.h5")).unwrap();
        std::fs::write(dir.path().join("results.h5"), "earlier").unwrap();
        for place in [occupied.as_path(), Path::new("/proc"), dir.path()] {
            let result = ResultsFile::create(place).and_then(|file| file.finish(&sample::rig()));
            let error = result.expect_err("the machine refuses");
            assert_eq!(error.exit_code(), 1);
            assert!(!error.to_string().contains('\n') && error.to_string().len() < 250, "{error}");
        }
        assert_eq!(std::fs::read_to_string(&occupied).unwrap(), "keep");
        assert_eq!(std::fs::read_to_string(dir.path().join("results.h5")).unwrap(), "earlier");
    }
}
