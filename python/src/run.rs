//! A run on threads of its own: progress goes to a Python function, Ctrl-C stops it, and the GIL is free meanwhile.

use crate::case::Case;
use crate::errors::{exception, raised};
use crate::tree;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use stridor::dataset::Describe;
use stridor::error::{Error, Fault, Result};
use stridor::job::{ANALYSES, Histories, Prepared, RunOptions, Selection, analyse, run_case};
use stridor::progress::{Observer, interrupt, until_interrupted};
use stridor::results::{RunResults, summary_json};

/// Time between two looks at signals and progress.
const TICK: Duration = Duration::from_millis(30);

/// A run that has ended: results, and histories where they are in memory.
#[pyclass(frozen, module = "stridor._native")]
pub struct Run {
    results: RunResults,
    histories: Histories,
}

#[pymethods]
impl Run {
    /// Runs the analyses of a case; `only` is the name of one. With `out` results go to that folder, from which an interrupted run
    /// is resumed with `resume`; without, the whole record of a run in time stays in memory. `observe(stage, done, total)` is called
    /// on the calling thread.
    #[new]
    #[pyo3(signature = (case, only=None, out=None, resume=false, threads=None, observe=None))]
    fn new(
        py: Python<'_>,
        case: &Case,
        only: Option<&str>,
        out: Option<PathBuf>,
        resume: bool,
        threads: Option<usize>,
        observe: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let selection = raised(py, selection(only))?;
        let watch = Watch::default();
        let work = || match &out {
            Some(out) => {
                let options = RunOptions { resume, ..RunOptions::default() };
                let results = run_case(&case.inner, selection, out, &options, &watch)?;
                Ok(Run { results, histories: Histories::default() })
            }
            None => in_memory(case, selection, &watch),
        };
        let ended = py.detach(|| watch.through(threads, work, observe.as_ref()));
        match ended? {
            Ok(run) => Ok(run),
            Err(error) => Err(exception(py, &case.located(error))),
        }
    }

    /// The results as nested dicts, laid out as in `results.h5`.
    fn tree<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tree::to_python(py, &self.results.describe().merged(self.histories.describe()))
    }

    /// Rows of a field of the tree that is worked out on request.
    fn rows<'py>(
        &self,
        py: Python<'py>,
        path: Vec<String>,
        key: &str,
        rows: Vec<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        // Histories have none: they need not be described again.
        tree::rows(py, &self.results.describe(), (&path, key), &rows)
    }

    /// The contents of `summary.json`.
    fn summary(&self) -> String {
        summary_json(&self.results).to_string()
    }
}

/// The analyses that `only` names, or all that the case lists.
fn selection(only: Option<&str>) -> Result<Selection> {
    let Some(name) = only else { return Ok(Selection::Listed) };
    if name == "compare" {
        return Ok(Selection::Measured);
    }
    let own = ANALYSES.into_iter().find(|analysis| analysis.name == name);
    own.map(|analysis| Selection::Only(analysis.name)).ok_or_else(|| {
        let names: Vec<&str> = ANALYSES.iter().map(|analysis| analysis.name).chain(["compare"]).collect();
        Error::input(Fault::new("`only`", format!("\"{name}\""), format!("one of {}", names.join(", "))))
    })
}

fn in_memory(case: &Case, selection: Selection, observer: &dyn Observer) -> Result<Run> {
    let prepared = Prepared::new(&case.inner)?;
    let mut histories = Histories::default();
    let mut keep = |stage: stridor::job::ResultStage<'_>| {
        histories.keep(&stage);
        Ok(())
    };
    let results = analyse(&prepared, selection, &mut keep, observer)?;
    Ok(Run { results, histories })
}

/// Progress of a run that another thread reports, and whether the run is to stop.
#[derive(Default)]
struct Watch {
    stopped: AtomicBool,
    news: Mutex<Vec<Stage>>,
}

/// A stage of a run.
#[derive(Debug, Clone)]
struct Stage {
    name: String,
    done: u64,
    total: Option<u64>,
    /// Whether something has changed since it was last shown.
    new: bool,
}

impl Observer for Watch {
    fn begin(&self, stage: &str, total: Option<u64>) {
        self.go_on();
        self.stages().push(Stage { name: stage.into(), done: 0, total, new: true });
    }

    fn advance(&self, steps: u64) {
        self.go_on();
        if let Some(stage) = self.stages().last_mut() {
            stage.done += steps;
            stage.new = true;
        }
    }
}

impl Watch {
    /// Stops the run where that is wanted.
    fn go_on(&self) {
        if self.stopped.load(Ordering::Relaxed) {
            interrupt();
        }
    }

    fn stages(&self) -> std::sync::MutexGuard<'_, Vec<Stage>> {
        self.news.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does `work` on a pool of threads, which a process forked from this one does not share.
    ///
    /// # Errors
    /// `KeyboardInterrupt`, or what `observe` raises; the work has stopped then.
    fn through<T: Send>(
        &self,
        threads: Option<usize>,
        work: impl FnOnce() -> Result<T> + Send,
        observe: Option<&Py<PyAny>>,
    ) -> PyResult<Result<T>> {
        let pool = match rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build() {
            Ok(pool) => pool,
            Err(error) => return Ok(Err(Error::analysis("threads", error.to_string(), "Ask for fewer"))),
        };
        let mut wrong = None;
        let ended = std::thread::scope(|scope| {
            let inner = || catch_unwind(AssertUnwindSafe(|| until_interrupted(|| pool.install(work))));
            let working = scope.spawn(inner);
            while !working.is_finished() {
                std::thread::sleep(TICK);
                if wrong.is_none()
                    && let Err(error) = Python::attach(|py| self.look(py, observe))
                {
                    self.stopped.store(true, Ordering::Relaxed);
                    wrong = Some(error);
                }
            }
            working.join().unwrap_or_else(Err)
        });
        if let Some(wrong) = wrong {
            return Err(wrong);
        }
        match ended {
            Ok(Some(result)) => Ok(result),
            Ok(None) => Ok(Err(Error::analysis("run", "stopped", "Run it again"))),
            Err(panic) => resume_unwind(panic),
        }
    }

    /// Lets Python handle its signals, and shows the progress.
    fn look(&self, py: Python<'_>, observe: Option<&Py<PyAny>>) -> PyResult<()> {
        py.check_signals()?;
        let Some(observe) = observe else { return Ok(()) };
        let shown = {
            let mut stages = self.stages();
            let shown: Vec<Stage> = stages.iter().filter(|stage| stage.new).cloned().collect();
            let over = stages.len().saturating_sub(1);
            stages.drain(..over);
            stages.iter_mut().for_each(|stage| stage.new = false);
            shown
        };
        for Stage { name, done, total, .. } in shown {
            observe.call1(py, (name, done, total))?;
        }
        Ok(())
    }
}
