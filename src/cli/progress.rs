//! Progress bars on stderr; silent when stderr is not a terminal or with `--quiet`.

use super::output::note;
use crate::error::text::printable;
use crate::progress::Observer;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::io::IsTerminal;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Interval at which a bar is redrawn, so that its time advances.
const TICK: Duration = Duration::from_millis(100);

/// Draws each stage as a bar, or as a spinner when its length is not known.
pub struct Bars {
    current: Arc<Mutex<ProgressBar>>,
    quiet: bool,
}

impl Bars {
    /// Bars on stderr; none when `quiet`.
    pub fn new(quiet: bool) -> Self {
        let current = Arc::new(Mutex::new(ProgressBar::hidden()));
        if !quiet && std::io::stderr().is_terminal() {
            keep_ticking(&current);
        }
        Bars { current, quiet }
    }

    fn with_bar(&self, act: impl FnOnce(&mut ProgressBar)) {
        // A poisoned lock means that another thread panicked; progress is not worth a second panic.
        if let Ok(mut bar) = self.current.lock() {
            act(&mut bar);
        }
    }
}

/// The time that is left, once a step has shown how long one takes.
fn left(state: &ProgressState, text: &mut dyn std::fmt::Write) {
    if state.pos() > 0 && state.len().is_some_and(|all| state.pos() < all) {
        let _ = write!(text, ", {:#} left", HumanDuration(state.eta()));
    }
}

/// Draws the bar again and again, on a thread that ends with it. Where no thread can be had, steps alone draw it.
fn keep_ticking(current: &Arc<Mutex<ProgressBar>>) {
    let bar = Arc::downgrade(current);
    let tick = move || {
        while let Some(bar) = bar.upgrade() {
            if let Ok(bar) = bar.lock() {
                bar.tick();
            }
            drop(bar);
            std::thread::sleep(TICK);
        }
    };
    let _ = std::thread::Builder::new().name("progress".into()).spawn(tick);
}

impl Observer for Bars {
    fn begin(&self, stage: &str, total: Option<u64>) {
        if self.quiet {
            return;
        }
        self.with_bar(|bar| {
            bar.finish_and_clear();
            *bar = ProgressBar::with_draw_target(total, ProgressDrawTarget::stderr());
            // Of 80 columns, and less than a tenth of them for the times.
            let template = if total.is_some() {
                "{msg:26} [{bar:20}] {pos}/{len} {elapsed}{left}"
            } else {
                "{msg:26} {spinner} {elapsed} {prefix}"
            };
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style.progress_chars("=> ").with_key("left", left));
            }
            bar.set_message(printable(stage));
        });
    }

    fn advance(&self, steps: u64) {
        self.with_bar(|bar| bar.inc(steps));
    }

    fn status(&self, words: &str) {
        self.with_bar(|bar| bar.set_prefix(words.to_string()));
    }

    fn end(&self) {
        self.with_bar(|bar| bar.finish_and_clear());
    }

    fn note(&self, sentence: &str) {
        if !self.quiet {
            self.with_bar(|bar| bar.suspend(|| note(sentence)));
        }
    }
}
