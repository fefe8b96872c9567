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
    /// How far the current stage is, in a few words, where its length is not known.
    fn status(&self, words: &str) {
        let _ = words;
    }
    /// The current stage is over.
    fn end(&self) {}
    /// A sentence that the user should see now.
    fn note(&self, sentence: &str) {
        let _ = sentence;
    }
}

impl Observer for () {}

/// Payload with which [`interrupt`] unwinds.
#[derive(Debug)]
struct Interrupted;

/// Stops the work that is observed, from within a method of its [`Observer`]: unwinds to [`until_interrupted`].
pub fn interrupt() -> ! {
    std::panic::resume_unwind(Box::new(Interrupted))
}

/// The result of `work`, or `None` when its observer has called [`interrupt`]. Files that `work` was writing are left as by a
/// process that was killed: those with a final name are whole.
pub fn until_interrupted<T>(work: impl FnOnce() -> T) -> Option<T> {
    match std::panic::catch_unwind(std::panic::AssertUnwindSafe(work)) {
        Ok(done) => Some(done),
        Err(payload) if payload.is::<Interrupted>() => None,
        Err(payload) => std::panic::resume_unwind(payload),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// Stops the work at the tenth step.
    struct Impatient(AtomicU64);

    impl Observer for Impatient {
        fn advance(&self, _: u64) {
            if self.0.fetch_add(1, Ordering::Relaxed) == 9 {
                interrupt();
            }
        }
    }

    #[test]
    fn an_observer_can_stop_the_work_on_any_thread() {
        use rayon::prelude::*;
        let observer = Impatient(AtomicU64::new(0));
        let stopped = until_interrupted(|| (0..1000).into_par_iter().for_each(|_| observer.advance(1)));
        assert_eq!(stopped, None);
        assert_eq!(until_interrupted(|| 1), Some(1));
        let other = std::panic::catch_unwind(|| until_interrupted(|| std::panic::resume_unwind(Box::new(2))));
        assert_eq!(other.map(|_: Option<()>| ()).unwrap_err().downcast_ref(), Some(&2));
    }
}
