//! A case with sweeps, a map and uncertain scalars, and what a results folder of it holds.
#![allow(dead_code)]

use crate::program::{CASE, Record, names, numbers};
use std::path::Path;

/// A thickness, which takes whole analyses and whose branches meet; a friction coefficient on a reduced model; a sweep and a map with points
/// at which the contact is open.
pub const SWEEPS: &str = r#"
[sweep.thickness]
parameter = "shell.disc.thickness"
from = "0.95 mm"
to = "1.05 mm"
points = 4

[sweep.friction]
parameter = "contact.pin.friction.mu0"
from = 0.1
to = 0.8
points = 5

[sweep.gap]
parameter = "contact.pin.approach"
from = "-2 um"
to = "2 um"
points = 6

[map.gap]
parameters = ["contact.pin.approach", "shell.disc.thickness"]
from = ["-2 um", "0.9 mm"]
to = ["2 um", "1.1 mm"]
points = [3, 2]
"#;

/// Samples on a reduced model, some with an open contact, and by whole analyses.
pub const SAMPLES: &str = r#"
[uncertainty.gap]
samples = 60
[uncertainty.gap.parameter.approach]
path = "contact.pin.approach"
between = ["-0.5 um", "2 um"]
[uncertainty.gap.parameter.friction]
path = "contact.pin.friction.mu0"
between = [0.1, 0.8]
deviation = 0.1

[uncertainty.thickness]
samples = 12
sampling = "random"
[uncertainty.thickness.parameter.disc]
path = "shell.disc.thickness"
between = ["0.95 mm", "1.05 mm"]
log = true
deviation = 0.02
"#;

/// A disc on a pin with a narrow band.
pub fn disc() -> String {
    let (head, _) = CASE.split_once("[transient]").expect("a run in time");
    let band = head.replace("\"1 kHz\"", "\"260 Hz\"");
    assert!(band != head);
    band + SWEEPS + SAMPLES
}

/// Arrays, summary, and other files by name.
pub type Found = (Record, serde_json::Value, Vec<(String, Vec<u8>)>);

/// The numbers of `results.h5`, the summary and the other files of a results folder, but what differs from run to run.
pub fn found(out: &Path) -> Found {
    let file = hdf5::File::open(out.join("results.h5")).expect("results.h5 opens");
    let mut record = Vec::new();
    numbers(&file, &mut record);
    let keys = stridor::results::KEYS_OF_THE_RUN;
    record.retain(|(name, _)| !keys.iter().any(|key| name.starts_with(&format!("/{key}"))));
    let summary = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let mut summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    keys.iter().for_each(|key| drop(summary[*key].take()));
    // The record has what was computed in this run, in the order in which the threads came to it.
    let apart = ["results.h5", "summary.json", "report.html", "record.bin", "parts"];
    let others = names(out).into_iter().filter(|name| !apart.contains(&name.as_str()));
    let others = others.map(|name| (name.clone(), std::fs::read(out.join(name)).expect("a file")));
    (record, summary, others.collect())
}
