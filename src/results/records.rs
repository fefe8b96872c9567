//! The results of the analyses of a run: records of any type, in the order in which they were found.

use crate::dataset::Describe;
use std::any::Any;
use std::fmt::Debug;

/// A result of an analysis: plain data that describes its quantities for the files.
pub trait AnalysisRecord: Any + Debug + Describe + Send + Sync {}

impl<T: Any + Debug + Describe + Send + Sync> AnalysisRecord for T {}

/// Records of any type.
#[derive(Debug, Default)]
pub struct Records(Vec<Box<dyn AnalysisRecord>>);

impl Records {
    /// Adds a record.
    pub fn push(&mut self, record: impl AnalysisRecord) {
        self.0.push(Box::new(record));
    }

    /// All records.
    pub fn iter(&self) -> impl Iterator<Item = &dyn AnalysisRecord> {
        self.0.iter().map(|record| &**record)
    }

    /// The first record of type `T`.
    pub fn get<T: AnalysisRecord>(&self) -> Option<&T> {
        self.iter().find_map(|record| (record as &dyn Any).downcast_ref())
    }

    /// The same, to be changed.
    pub fn get_mut<T: AnalysisRecord>(&mut self) -> Option<&mut T> {
        self.0.iter_mut().find_map(|record| (&mut **record as &mut dyn Any).downcast_mut())
    }

    /// The first record of type `T`, taken out.
    pub fn take<T: AnalysisRecord>(&mut self) -> Option<T> {
        let place = self.iter().position(|record| (record as &dyn Any).is::<T>())?;
        let record: Box<dyn Any> = self.0.remove(place);
        record.downcast().ok().map(|record| *record)
    }

    /// The records of type `T`, in the order in which they were found.
    pub fn all<T: AnalysisRecord>(&self) -> Vec<&T> {
        self.iter().filter_map(|record| (record as &dyn Any).downcast_ref()).collect()
    }
}
