//! Answers of studies that are known before a run, where new ones are kept, and the origin that they must have.

use crate::case::Case;
use crate::error::{Error, Result};
use crate::linalg::sparse::times;
use crate::modal::RealModes;
use crate::results::record::{InputFile, Record, RecordOrigin};
use crate::sweep::{AnswerStore, Modes};
use crate::system::System;
use faer::Mat;
use sha2::{Digest, Sha256};

/// Answers of studies in records.
#[derive(Default)]
pub struct KnownAnswers<'a> {
    /// Record of the run, to which new answers are added.
    pub own: Option<&'a Record>,
    /// Records of the parts that a job array has computed.
    pub parts: Vec<Record>,
}

impl KnownAnswers<'_> {
    /// The answers of the study with this table in the case, on the model of this round: each is richer than the one before, as the
    /// first was not good enough.
    pub(super) fn of(&self, table: &str, round: usize) -> StudyAnswers<'_> {
        let study = if round == 0 { table.to_string() } else { format!("{round}.{table}") };
        StudyAnswers { known: self, study }
    }

    fn all(&self) -> impl Iterator<Item = &Record> {
        self.own.into_iter().chain(&self.parts)
    }

    /// Compares shapes by this reference; says so when those that are known were compared by another one.
    pub(super) fn compare_by(&self, reference: &Reference) -> Result<()> {
        let digest = reference.digest();
        self.all().try_for_each(|record| record.compare_by(digest))
    }
}

/// The answers of a study.
pub(super) struct StudyAnswers<'a> {
    known: &'a KnownAnswers<'a>,
    study: String,
}

impl AnswerStore for StudyAnswers<'_> {
    fn find(&self, place: &[u64]) -> Option<Result<Modes>> {
        self.known.all().find_map(|record| record.answer(&self.study, place))
    }

    fn keep(&self, place: Vec<u64>, answer: &Result<Modes>) -> Result<()> {
        match (answer, self.known.own) {
            // That the machine refuses something is no answer.
            (Err(Error::Io { .. }), _) | (_, None) => Ok(()),
            (answer, Some(own)) => own.keep(&self.study, &place, answer),
        }
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
///
/// # Errors
/// A file that cannot be read.
pub fn origin(case: &Case) -> Result<RecordOrigin> {
    let inputs = case.files().into_iter().map(|file| InputFile::read(&case.folder, &file));
    Ok(RecordOrigin { inputs: inputs.collect::<Result<_>>()?, case: case.to_toml() })
}
