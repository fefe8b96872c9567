//! The report page in headless Chromium; .ci/browser runs them.

#[path = "../common/program.rs"]
mod program;
#[path = "../common/python.rs"]
mod python;

mod browser;
