//! One implicit step with sliding contact, timed: a case made of matrices with contact points, from the moment its
//! counter-body is put on, already sliding, nearly as deep as it will stand in the end.
//!
//! `step CASE [--threads N] [--step SECONDS] [--block STEPS] [--blocks N]` prints one JSON line. A step is that of the program:
//! motion, contact forces, and its balance of energy. Linux only: memory comes from /proc.

use std::error::Error;
use std::path::Path;
use std::time::Instant;
use stridor::case::read_case;
use stridor::equilibrium::{SteadyOptions, SteadySliding, solve_steady};
use stridor::job::Prepared;
use stridor::transient::{Plan, Scheme, State, StepMethod, TransientModel, march};

// As the program does it.
#[global_allocator]
static MEMORY: stridor::pages::LargePages = stridor::pages::LargePages;

/// The part of its steady displacement that the structure starts with.
const GIVEN_WAY: f64 = 0.97;
/// Steps before the clock counts.
const WARM: usize = 10;

/// CPU seconds of all threads so far.
fn cpu() -> f64 {
    let nanoseconds = |task: std::fs::DirEntry| {
        let text = std::fs::read_to_string(task.path().join("schedstat")).unwrap_or_default();
        text.split_whitespace().next().and_then(|ran| ran.parse::<f64>().ok()).unwrap_or(0.0)
    };
    let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    1e-9 * tasks.map(nanoseconds).sum::<f64>()
}

/// The most memory that this process had \[MiB\].
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or("");
    line.split_whitespace().nth(1).and_then(|kib| kib.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let option = |name: &str| arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1));
    let Some(path) = arguments.first().filter(|a| !a.starts_with("--")) else {
        println!("step CASE [--threads N] [--step SECONDS] [--block STEPS] [--blocks N]: see benches/run");
        return Ok(());
    };
    if let Some(threads) = option("--threads") {
        rayon::ThreadPoolBuilder::new().num_threads(threads.parse()?).build_global()?;
    }
    let number = |name: &str, otherwise: f64| option(name).map_or(Ok(otherwise), |text| text.parse::<f64>());
    let plan = Plan {
        scheme: Scheme::TRAPEZOIDAL,
        step: number("--step", 1e-5)?,
        steps: 0,
        method: StepMethod::Condensed,
        tolerance: None,
    };
    let (block, blocks) = (number("--block", 20.0)? as usize, number("--blocks", 5.0)? as usize);
    // On a thread of the pool, as the program does it.
    let line =
        rayon::scope(|_| measure(Path::new(path), plan, block, blocks).map_err(|error| error.to_string()))?;
    println!("{line}");
    Ok(())
}

/// Marches over `blocks` times `block` steps.
fn measure(
    path: &Path,
    plan: Plan,
    block: usize,
    blocks: usize,
) -> Result<serde_json::Value, Box<dyn Error>> {
    let case = read_case(path)?;
    let prepared = Prepared::new(&case)?;
    let system = &prepared.system;
    let before = peak();
    let steady = solve_steady(system, &SteadyOptions::default(), &())?;
    let model = TransientModel::new(system, &steady)?;
    let plan = Plan { steps: WARM + block * blocks, ..plan };
    let (cpu_0, began) = (cpu(), Instant::now());
    // CPU and wall seconds at the ends of the first step and of every block.
    let mut ends = Vec::with_capacity(blocks + 2);
    let (mut iterations, mut open) = (0, 0);
    let points = system.points().count();
    // Not steady: the structure has not given way to its end, so that the contact overshoots, opens and closes.
    let displacement = steady.displacement.iter().map(|u| GIVEN_WAY * u).collect();
    let nearly = SteadySliding { displacement, ..steady.clone() };
    let marched = march(&model, State::at_rest(&model, &nearly)?, &plan, &(), &mut |marched| {
        let step = marched.step;
        if step == 1 || (step >= WARM && (step - WARM).is_multiple_of(block)) {
            ends.push([cpu(), began.elapsed().as_secs_f64()]);
        }
        iterations += marched.state.iterations();
        open += (0..points).filter(|p| marched.state.contact_forces(*p)[0] == 0.0).count();
        Ok(())
    })?;
    let least = [0, 1].map(|clock| {
        let blocks = ends[1..].windows(2).map(|ends| ends[1][clock] - ends[0][clock]);
        1e3 * blocks.fold(f64::INFINITY, f64::min) / block as f64
    });
    Ok(serde_json::json!({
        "program": "stridor", "dofs": system.n_dofs(), "nonzeros": system.structure.stiffness.compute_nnz(),
        "points": points, "prepare_s": { "cpu": ends[0][0] - cpu_0, "wall": ends[0][1] },
        "step_ms": { "cpu": least[0], "wall": least[1] },
        "newton": iterations as f64 / plan.steps as f64, "open": open as f64 / (plan.steps * points.max(1)) as f64,
        "split": marched.split.0, "energy_residual": marched.worst_residual,
        "peak_mib": peak(), "before_mib": before,
        "speed": marched.state.motion.col_as_slice(1).iter().fold(0.0f64, |m, v| m.max(v.abs())),
    }))
}
