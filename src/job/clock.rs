//! Wall times of the phases of a run.

use crate::progress::Observer;
use std::sync::Mutex;
use std::time::Instant;

/// Collects the wall times of phases.
#[derive(Default)]
pub struct Clock {
    pub(super) phases: Vec<(String, f64)>,
}

impl Clock {
    /// Times `work` as one phase.
    pub(super) fn time<T>(&mut self, phase: &str, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let value = work();
        self.phases.push((phase.to_string(), started.elapsed().as_secs_f64()));
        value
    }

    /// Times each stage that `work` reports to its observer, which is `observer` timed by this clock.
    pub(super) fn watch<T>(&mut self, observer: &dyn Observer, work: impl FnOnce(&dyn Observer) -> T) -> T {
        let timed = TimedObserver { observer, open: Mutex::default(), phases: Mutex::default() };
        let value = work(&timed);
        self.phases.extend(timed.phases.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner()));
        value
    }
}

/// Hands on what it hears, and notes when the outermost stages end.
struct TimedObserver<'a> {
    observer: &'a dyn Observer,
    open: Mutex<Vec<(String, Instant)>>,
    phases: Mutex<Vec<(String, f64)>>,
}

impl Observer for TimedObserver<'_> {
    fn begin(&self, stage: &str, total: Option<u64>) {
        self.observer.begin(stage, total);
        if let Ok(mut open) = self.open.lock() {
            open.push((stage.to_string(), Instant::now()));
        }
    }

    fn advance(&self, steps: u64) {
        self.observer.advance(steps);
    }

    fn status(&self, words: &str) {
        self.observer.status(words);
    }

    fn end(&self) {
        self.observer.end();
        if let (Ok(mut open), Ok(mut phases)) = (self.open.lock(), self.phases.lock())
            && let Some((stage, started)) = open.pop()
            && open.is_empty()
        {
            phases.push((stage, started.elapsed().as_secs_f64()));
        }
    }
}
