//! One case made of matrices, timed: reading apart from computing, each stage in CPU seconds and in wall seconds.
//!
//! `matrices CASE [--threads N] [--vectors FILE]` prints one JSON line; the vectors go to FILE as plain f64 (re, im of
//! every entry, mode after mode), so that another program can measure their errors. Linux only: times and memory come
//! from /proc.

use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;
use stridor::case::read_case;
use stridor::job::{Prepared, Selection, analyse};
use stridor::progress::Observer;
use stridor::results::{ComplexResult, NamedModes, RunResults};

// As the program does it.
#[global_allocator]
static MEMORY: stridor::pages::LargePages = stridor::pages::LargePages;

/// CPU seconds of all threads of this process (user and system; clock ticks are 10 ms).
fn cpu() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name in parentheses may hold blanks; utime and stime are the 12th and 13th fields after it.
    let after = stat.rsplit(')').next().unwrap_or("");
    let ticks = |k: usize| after.split_whitespace().nth(k).and_then(|t| t.parse::<f64>().ok()).unwrap_or(0.0);
    0.01 * (ticks(11) + ticks(12))
}

/// A figure of /proc/self/status in MiB.
fn memory(key: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with(key)).unwrap_or("");
    line.split_whitespace().nth(1).and_then(|kib| kib.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

/// The stage that no peer has: its memory is told apart.
const CERTIFICATE: &str = "certificate";

/// Sums CPU and wall seconds of each stage; a stage inside another counts for the inner one.
#[derive(Default)]
struct Stages(Mutex<(Vec<Stage>, Vec<usize>)>, Mutex<Peaks>);

/// MiB held at most, before the certificate and in it.
#[derive(Default, Clone, Copy)]
struct Peaks {
    before: f64,
    certificate: Option<f64>,
}

struct Stage {
    name: String,
    cpu: f64,
    wall: f64,
    since: (f64, Instant),
}

impl Stages {
    fn lap(stage: &mut Stage) {
        stage.cpu += cpu() - stage.since.0;
        stage.wall += stage.since.1.elapsed().as_secs_f64();
    }
}

impl Observer for Stages {
    fn begin(&self, stage: &str, _total: Option<u64>) {
        if stage == CERTIFICATE {
            self.1.lock().expect("no panic while timing").before = memory("VmHWM");
        }
        let mut guard = self.0.lock().expect("no panic while timing");
        let (stages, open) = &mut *guard;
        if let Some(outer) = open.last() {
            Self::lap(&mut stages[*outer]);
        }
        let index = stages.iter().position(|s| s.name == stage).unwrap_or_else(|| {
            stages.push(Stage { name: stage.into(), cpu: 0.0, wall: 0.0, since: (0.0, Instant::now()) });
            stages.len() - 1
        });
        stages[index].since = (cpu(), Instant::now());
        open.push(index);
    }

    fn end(&self) {
        let mut guard = self.0.lock().expect("no panic while timing");
        let (stages, open) = &mut *guard;
        if let Some(index) = open.pop() {
            Self::lap(&mut stages[index]);
            if stages[index].name == CERTIFICATE {
                self.1.lock().expect("no panic while timing").certificate = Some(memory("VmHWM"));
                // The peak begins anew (proc(5), clear_refs).
                let _ = std::fs::write("/proc/self/clear_refs", "5");
            }
        }
        if let Some(outer) = open.last() {
            stages[*outer].since = (cpu(), Instant::now());
        }
    }
}

/// λ of every mode (ω² as `[ω², 0]` for real modes), and the vectors.
fn pairs(results: &RunResults) -> (Vec<[f64; 2]>, Vec<f64>) {
    let mut vectors = Vec::new();
    if let Some(complex) = results.get::<ComplexResult>() {
        let modes = &complex.modes.modes;
        modes.iter().for_each(|m| vectors.extend(m.right.iter().flat_map(|z| [z.re, z.im])));
        return (modes.iter().map(|m| [m.eigenvalue.re, m.eigenvalue.im]).collect(), vectors);
    }
    let Some(set) = results.get::<NamedModes>() else { return (Vec::new(), vectors) };
    for shape in set.modes.shapes.col_iter() {
        vectors.extend(shape.iter().flat_map(|v| [*v, 0.0]));
    }
    (set.modes.eigenvalues.iter().map(|w| [*w, 0.0]).collect(), vectors)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let option = |name: &str| arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1));
    let Some(path) = arguments.first().filter(|a| !a.starts_with("--")) else {
        println!("matrices CASE [--threads N] [--vectors FILE]: see benches/run");
        return Ok(());
    };
    if let Some(threads) = option("--threads") {
        rayon::ThreadPoolBuilder::new().num_threads(threads.parse()?).build_global()?;
    }
    let case = read_case(Path::new(path))?;
    let (cpu_0, wall_0) = (cpu(), Instant::now());
    // On a thread of the pool, as the program does it.
    let prepared = rayon::scope(|_| Prepared::new(&case))?;
    let read = (cpu() - cpu_0, wall_0.elapsed().as_secs_f64());
    let held = memory("VmHWM");
    let stages = Stages::default();
    let (cpu_0, wall_0) = (cpu(), Instant::now());
    let results = rayon::scope(|_| analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &stages))?;
    let total = (cpu() - cpu_0, wall_0.elapsed().as_secs_f64());
    let (eigenvalues, vectors) = pairs(&results);
    if let Some(file) = option("--vectors") {
        let bytes: Vec<u8> = vectors.iter().flat_map(|v| v.to_le_bytes()).collect();
        std::fs::File::create(file)?.write_all(&bytes)?;
    }
    let peaks = *stages.1.lock().expect("no panic while timing");
    let stages = stages.0.into_inner().expect("no panic while timing").0;
    let phases: Vec<_> =
        stages.iter().map(|s| serde_json::json!({ "name": s.name, "cpu": s.cpu, "wall": s.wall })).collect();
    let complex = results.get::<ComplexResult>().map(|c| &c.modes);
    let size = results.size;
    let line = serde_json::json!({
        "program": "stridor", "dofs": size.dofs, "nonzeros": size.nonzeros,
        "read": { "cpu": read.0, "wall": read.1 }, "total": { "cpu": total.0, "wall": total.1 },
        "phases": phases, "timings": results.timings,
        "peak_mib": memory("VmHWM").max(peaks.before), "certificate_peak_mib": peaks.certificate, "before_mib": held,
        "coupling_rank": prepared.system.coupling.as_ref().map_or(0, |c| c.directions.len()),
        "subspace": complex.map(|c| c.subspace_dimension), "refinements": complex.map(|c| c.refinements),
        "warnings": results.warnings, "eigenvalues": eigenvalues,
    });
    println!("{line}");
    Ok(())
}
