//! Progress of long work, reported to an observer. Solvers never print; the command line draws the bars.

/// Watches a long computation. All methods default to silence, so `()` is the quiet observer.
pub trait Observer: Sync {
    /// A stage begins; `total` is its length in steps of [`Observer::advance`], when known.
    fn begin(&self, stage: &str, total: Option<u64>) {
        let _ = (stage, total);
    }
    /// `steps` more steps of the current stage are done.
    fn advance(&self, steps: u64) {
        let _ = steps;
    }
    /// The current stage is over.
    fn end(&self) {}
    /// A sentence that the user should see now.
    fn note(&self, sentence: &str) {
        let _ = sentence;
    }
}

impl Observer for () {}
