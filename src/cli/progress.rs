//! Progress bars on stderr; silent when stderr is not a terminal or the user asked for quiet.

use super::note;
use crate::error::text::printable;
use crate::progress::Observer;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::Mutex;
use std::time::Duration;

/// Draws each stage as a bar, or as a spinner when its length is not known.
pub struct Bars {
    current: Mutex<ProgressBar>,
    quiet: bool,
}

impl Bars {
    /// Bars on stderr; none when `quiet`.
    pub fn new(quiet: bool) -> Self {
        Bars { current: Mutex::new(ProgressBar::hidden()), quiet }
    }

    fn with_bar(&self, act: impl FnOnce(&mut ProgressBar)) {
        // A poisoned lock means that another thread panicked; progress is not worth a second panic.
        if let Ok(mut bar) = self.current.lock() {
            act(&mut bar);
        }
    }
}

impl Observer for Bars {
    fn begin(&self, stage: &str, total: Option<u64>) {
        if self.quiet {
            return;
        }
        self.with_bar(|bar| {
            bar.finish_and_clear();
            *bar = ProgressBar::with_draw_target(total, ProgressDrawTarget::stderr());
            let template = if total.is_some() {
                "{msg:32} [{bar:30}] {pos}/{len} {elapsed}"
            } else {
                "{msg:32} {spinner} {elapsed}"
            };
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_message(printable(stage));
            bar.enable_steady_tick(Duration::from_millis(100));
        });
    }

    fn advance(&self, steps: u64) {
        self.with_bar(|bar| bar.inc(steps));
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
