//! Where results come from: program and commit, command, time, machine, case file. The files that the case reads are in
//! [`RunResults::inputs`](super::RunResults).

use super::record::InputFile;
use crate::dataset::{Dimension, Group, Variable};
use crate::linalg::factor::engine_names;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Keys of `summary.json` and of the root of `results.h5` that say how a run went and not what it found: two runs of a case
/// differ in them.
pub const KEYS_OF_THE_RUN: [&str; 2] = ["timings", "provenance"];

/// Where results come from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Provenance {
    /// Commit of the program's sources: [`crate::COMMIT`]; `unknown` outside a repository.
    pub commit: &'static str,
    /// When the run began: date and time in UTC (ISO 8601), `2026-01-31T09:05:00Z`.
    pub started: String,
    /// The program that was called and its arguments.
    pub command: Vec<String>,
    /// Number of threads.
    pub threads: usize,
    /// What shares the work among processes: the value of `--engine`, `default` without it.
    pub engine: &'static str,
    /// Number of these processes: MPI ranks.
    pub ranks: usize,
    /// Operating system with its version, and the architecture.
    pub system: String,
    /// Model name of the processor, where the system says it.
    pub processor: Option<String>,
    /// Cores that the process may use, where the system says it.
    pub cores: Option<usize>,
    /// Memory of the machine \[bytes\], where the system says it.
    pub memory_bytes: Option<u64>,
    /// The case file with its checksum; `None` of a case that was no file.
    pub case_file: Option<InputFile>,
    /// Its text as the user wrote it; empty of a case that was no file.
    pub case_text: String,
}

impl Provenance {
    /// Of a run that this process begins now, of the case with this `text` in the file of this name.
    pub fn now(file: &str, text: &str) -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or(Duration::ZERO);
        Provenance {
            commit: crate::COMMIT.unwrap_or("unknown"),
            started: utc(since.as_secs()),
            command: std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect(),
            threads: rayon::current_num_threads(),
            engine: engine_names::DEFAULT,
            ranks: 1,
            system: system(),
            processor: field("/proc/cpuinfo", "model name"),
            cores: std::thread::available_parallelism().ok().map(usize::from),
            memory_bytes: memory_bytes(),
            case_file: (!file.is_empty()).then(|| InputFile::of_text(file, text)),
            case_text: text.to_string(),
        }
    }

    /// The same, of a run whose work `engine` shares among so many `ranks`.
    pub fn on_ranks(self, engine: &'static str, ranks: usize) -> Self {
        Provenance { engine, ranks, ..self }
    }

    /// Its quantities.
    pub(super) fn group(&self) -> Group<'_> {
        let words = Dimension::of_variable("command", self.command.len());
        let case = self.case_file.as_ref();
        Group::new("provenance", "where the results come from")
            .value("commit", "text", "commit of the program's sources", self.commit)
            .value("started", "text", "when the run began, UTC (ISO 8601)", self.started.clone())
            .with(Variable::texts("command", "the program and its arguments", words, self.command.clone()))
            .value("threads", "1", "number of threads", self.threads)
            .value("engine", "text", "what shares the work among processes, as --engine", self.engine)
            .value("ranks", "1", "number of MPI ranks", self.ranks)
            .value("system", "text", "operating system and architecture", self.system.clone())
            .value("processor", "text", "model name of the processor", self.processor.clone())
            .value("cores", "1", "cores that the process may use", self.cores)
            .value("memory_gib", "GiB", "memory of the machine", self.memory_gib())
            .value("case_file", "text", "the case file", case.map(|file| file.path.clone()))
            .value("case_sha256", "text", "SHA-256 of its content", case.map(|file| file.sha256.clone()))
    }

    /// Memory of the machine \[GiB\].
    pub fn memory_gib(&self) -> Option<f64> {
        self.memory_bytes.map(|bytes| bytes as f64 / f64::from(1 << 30))
    }
}

/// Seconds since 1970 as date and time; days to a date of the Gregorian calendar by years that begin in March, so that the day
/// of the leap year is the last.
fn utc(seconds: u64) -> String {
    let (days, second) = (seconds / 86_400, seconds % 86_400);
    // From 1 March of the year 0, in eras of 400 years, 146,097 days each.
    let day = days + 719_468;
    let (era, day) = (day / 146_097, day % 146_097);
    let year_of_era = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    // Months from March on have 153 days in five.
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = 400 * era + year_of_era + u64::from(month <= 2);
    let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

/// Name of the system with version and architecture, as far as they are known.
fn system() -> String {
    let name = std::fs::read_to_string("/etc/os-release").ok().and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("PRETTY_NAME="))?;
        Some(line.trim_matches('"').to_string())
    });
    let kernel = std::fs::read_to_string("/proc/sys/kernel/osrelease").ok();
    let os = std::env::consts::OS;
    let kernel = kernel.map_or_else(|| os.to_string(), |version| format!("{os} {}", version.trim()));
    [name, Some(kernel), Some(std::env::consts::ARCH.into())]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(", ")
}

/// Value of the first line `name : value` of a file.
fn field(file: &str, name: &str) -> Option<String> {
    let text = std::fs::read_to_string(file).ok()?;
    let mut lines = text.lines().filter_map(|line| line.split_once(':'));
    lines.find(|(key, _)| key.trim() == name).map(|(_, value)| value.trim().to_string())
}

fn memory_bytes() -> Option<u64> {
    let kilobytes = field("/proc/meminfo", "MemTotal")?;
    kilobytes.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_dates() {
        // By `date -u -d @N +%FT%TZ`.
        let known = [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (951_868_800, "2000-03-01T00:00:00Z"),
            (1_735_689_599, "2024-12-31T23:59:59Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
        ];
        for (seconds, date) in known {
            assert_eq!(utc(seconds), date);
        }
    }

    #[test]
    fn a_case_that_was_no_file_has_no_checksum() {
        let here = Provenance::now("case.toml", "title = 1");
        assert!(here.threads > 0 && !here.command.is_empty() && !here.system.is_empty());
        let file = here.case_file.unwrap();
        // By sha256sum.
        assert!(file.bytes == 9 && file.sha256.starts_with("18eedd0d53ee"), "{file:?}");
        assert!(Provenance::now("", "").case_file.is_none());
    }
}
