//! Points of studies that are known before a run, and the origin that they must have.

use super::sink::KnownMaps;
use crate::case::Case;
use crate::error::Result;
use crate::linalg::sparse::times;
use crate::modal::RealModes;
use crate::results::record::{InputFile, PartRecord, RecordOrigin};
use crate::sweep::{AnswerStore, Answers, Modes, SampleModes};
use crate::system::System;
use faer::Mat;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Points of studies that are known before a run.
#[derive(Default)]
pub struct KnownPoints {
    /// First points of the maps, of an interrupted run.
    pub maps: KnownMaps,
    /// First samples of the studies of uncertain scalars, by name, of an interrupted run.
    pub samples: BTreeMap<String, Vec<SampleModes>>,
    /// Points that a job array has computed.
    pub parts: Parts,
}

/// The parts that a job array has computed.
#[derive(Default)]
pub struct Parts {
    /// Their folder.
    pub dir: PathBuf,
    /// Their answers.
    pub records: Vec<PartRecord>,
}

impl Parts {
    /// The answers of the study with this table in the case; none unless `wanted`.
    pub(super) fn of<'a>(&'a self, table: &str, wanted: bool) -> KnownAnswers<'a> {
        let all = self.records.iter().filter_map(|part| part.answers.get(table));
        KnownAnswers(all.filter(|_| wanted).collect())
    }

    /// Whether their shapes are compared by this reference.
    pub(super) fn check(&self, reference: &Reference) -> Result<()> {
        if self.records.is_empty() {
            return Ok(());
        }
        let digest = reference.digest();
        self.records.iter().try_for_each(|part| part.check_reference(&self.dir, digest))
    }
}

/// Answers of the parts; more are not kept.
pub(super) struct KnownAnswers<'a>(Vec<&'a Answers>);

impl AnswerStore for KnownAnswers<'_> {
    fn find(&self, place: &[u64]) -> Option<Result<Modes>> {
        self.0.iter().find_map(|part| part.get(place)).cloned()
    }

    fn keep(&self, _: Vec<u64>, _: &Result<Modes>) -> Result<()> {
        Ok(())
    }
}

/// M Φ of the real modes of the case itself: in the coordinates Φᵀ M φ shapes of different places are compared.
pub(super) struct Reference(pub(super) Mat<f64>);

impl Reference {
    pub(super) fn new(system: &System, real: &RealModes) -> Self {
        Reference(times(&system.structure.mass, real.shapes.as_ref()))
    }

    /// Its SHA-256. Processors of different types round differently, and turn the shapes of double modes.
    pub(super) fn digest(&self) -> [u8; 32] {
        let mut hasher = Sha256::new();
        for column in self.0.col_iter() {
            column.iter().for_each(|value| hasher.update(value.to_le_bytes()));
        }
        hasher.finalize().into()
    }
}

/// The case and the files it reads.
pub(super) fn origin(case: &Case) -> Result<RecordOrigin> {
    let inputs = case.files().into_iter().map(|file| InputFile::read(&case.folder, &file));
    Ok(RecordOrigin { inputs: inputs.collect::<Result<_>>()?, case: case.to_toml() })
}
