//! `results.h5`, safe against being killed at any moment.
//!
//! HDF5 keeps track of what is where in structures all over the file; a process that is killed while it writes them
//! leaves a file that may not open. So what is called `results.h5` never has its structure changed:
//!
//! - A run writes its stages to `results.new.h5`. When it begins what takes long, a run in time or a map, and at its
//!   end, this file takes the place of `results.h5` in one step; an earlier run's file is not touched before.
//! - A run in time and a map make room for all their numbers before that. From then on numbers are put into the room
//!   they have, and each time a flush and a count say how many; this changes no structure.
//! - What comes after that is written to a copy, again `results.new.h5`, which takes the place when it is whole.
//!
//! The root attribute `complete` turns true at the end. A run that is killed in its first stages leaves its
//! `results.new.h5`, which the next one overwrites.

use super::RunResults;
use super::folder::{FileNames, prepare_folder, refusal};
use super::hdf5::{Datasets, attribute, plain, text_attribute, texts};
use crate::error::Result;
use hdf5::plist::dataset_create::{AllocTime, FillTime};
use hdf5::types::OwnedDynValue;
use hdf5::{Extents, Group, H5Type};
use std::path::{Path, PathBuf};

/// What an interrupted run leaves to be taken up.
const TAKEN_UP: [&str; 2] = ["map", "transient"];

/// The results file of a run under way.
#[derive(Debug)]
pub struct ResultsFile {
    file: hdf5::File,
    /// Where the file is now.
    path: PathBuf,
    /// Where it belongs.
    home: PathBuf,
    pub(super) names: FileNames,
    /// Whether it has a result, so that it takes the place of an earlier file when the run fails.
    kept: bool,
    /// Whether a write was refused, so that it is not to be trusted.
    broken: bool,
    /// The channels of the run in time.
    pub(super) channels: Vec<String>,
}

impl ResultsFile {
    /// Begins a results file in the folder `dir`, which is made when missing.
    ///
    /// # Errors
    /// [`crate::error::Error::Io`], here and in every other method, when the machine refuses: a file in the
    /// folder's place, a folder that is not writable, a full disk.
    pub fn create(dir: &Path) -> Result<Self> {
        prepare_folder(dir)?;
        let (home, path) = (dir.join("results.h5"), dir.join("results.new.h5"));
        // The operating system tells why a file cannot be made more plainly than the library.
        std::fs::File::create(&path).map_err(|source| refusal(&path, source))?;
        let file = hdf5::File::create(&path).map_err(|source| refusal(&path, plain(&source)))?;
        let mut this = ResultsFile {
            file,
            path,
            home,
            names: FileNames::default(),
            kept: false,
            broken: false,
            channels: Vec::new(),
        };
        this.stage(|root| {
            text_attribute(root, "program", env!("CARGO_PKG_NAME"))?;
            text_attribute(root, "program_version", env!("CARGO_PKG_VERSION"))?;
            attribute(root, "complete", &false)
        })?;
        Ok(this)
    }

    /// Begins a results file with the maps and the run in time that an earlier run left in the folder.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn resume(dir: &Path) -> Result<Self> {
        let mut this = ResultsFile::create(dir)?;
        if this.home.exists() {
            let earlier = hdf5::File::open(&this.home);
            let earlier = earlier.map_err(|source| refusal(&this.home, plain(&source)))?;
            this.stage(|root| {
                let mut left = TAKEN_UP.into_iter().filter(|name| earlier.link_exists(name));
                left.try_for_each(|name| earlier.group(name)?.copy_to(root, name))
            })?;
        }
        Ok(this)
    }

    /// Writes warnings and timings, marks the file complete and closes it.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn finish(mut self, results: &RunResults) -> Result<()> {
        self.stage(|root| {
            texts(root, "warnings", &results.warnings, "what the user should know, one sentence each")?;
            let group = Datasets(root.create_group("timings")?);
            let (phases, seconds): (Vec<String>, Vec<f64>) = results.timings.iter().cloned().unzip();
            texts(&group.0, "phase", &phases, "phases of the run")?;
            group.list("wall_time", &seconds, "s", "wall time of each phase")?;
            root.attr("complete")?.write_scalar(&true)
        })?;
        self.take_place()
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

    /// Puts numbers into room that is there, in the file's place too, and flushes them.
    pub(super) fn fill(&mut self, write: impl FnOnce(&Group) -> hdf5::Result<()>) -> Result<()> {
        let written = self.file.as_group().and_then(|root| write(&root)).and_then(|()| self.file.flush());
        self.broken |= written.is_err();
        written.map_err(|source| refusal(&self.path, plain(&source)))
    }

    /// Reads what was written.
    pub(super) fn read<T>(&self, read: impl FnOnce(&Group) -> hdf5::Result<T>) -> Result<T> {
        let found = self.file.as_group().and_then(|root| read(&root));
        found.map_err(|source| refusal(&self.path, plain(&source)))
    }

    /// Takes the place of an earlier run's file, or of what this run had there.
    pub(super) fn take_place(&mut self) -> Result<()> {
        if self.path != self.home {
            std::fs::rename(&self.path, &self.home).map_err(|source| refusal(&self.home, source))?;
            self.path.clone_from(&self.home);
        }
        Ok(())
    }

    /// Goes on in a copy when the file is in its place.
    fn step_aside(&mut self) -> Result<()> {
        if self.path == self.home {
            let aside = self.home.with_file_name("results.new.h5");
            std::fs::copy(&self.home, &aside).map_err(|source| {
                let _ = std::fs::remove_file(&aside);
                refusal(&aside, source)
            })?;
            self.file = hdf5::File::open_rw(&aside).map_err(|source| refusal(&aside, plain(&source)))?;
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

/// Room for `count` numbers, all of it on the disk, to be filled later; `empty` until then.
pub(super) fn room<T: H5Type + Into<OwnedDynValue>>(
    group: &Group,
    name: &str,
    count: impl Into<Extents>,
    empty: T,
) -> hdf5::Result<hdf5::Dataset> {
    let room = group.new_dataset::<T>().shape(count).alloc_time(Some(AllocTime::Early));
    room.fill_time(FillTime::Alloc).fill_value(empty).create(name)
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn an_earlier_file_stays_until_there_is_a_result() {
        let dir = tempfile::tempdir().unwrap();
        let results = sample::rig();
        let home = dir.path().join("results.h5");
        std::fs::write(&home, "earlier").unwrap();
        {
            let mut file = ResultsFile::create(dir.path()).unwrap();
            file.write_case(&results).unwrap();
            assert_eq!(std::fs::read(&home).unwrap(), b"earlier");
        }
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1, "a run without results leaves nothing");
        // One that fails later leaves what it has.
        let mut file = ResultsFile::create(dir.path()).unwrap();
        file.write_modes(&results.modes[0]).unwrap();
        drop(file);
        let failed = hdf5::File::open(&home).unwrap();
        assert!(failed.dataset("modes/disc/frequency_hz").is_ok());
        assert!(!failed.attr("complete").unwrap().read_scalar::<bool>().unwrap());
        let mut file = ResultsFile::create(dir.path()).unwrap();
        file.write_steady(results.steady.as_ref().unwrap()).unwrap();
        file.finish(&results).unwrap();
        assert!(hdf5::File::open(&home).unwrap().group("steady").is_ok());
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
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
