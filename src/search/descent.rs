//! The way down: samples whose mean and covariance follow the best of them.

use super::cost::Cost;
use super::file::SearchFile;
use crate::error::{Error, Result};
use crate::progress::Observer;
use cmaes::{CMAESOptions, DVector};
use std::sync::Mutex;

/// Penalty of a sample outside the bounds, times the square of its distance in units of their width.
const OUTSIDE: f64 = 100.0;

/// The unknowns of the least cost among samples from `start`, until `evaluations` different ones were computed: those beyond
/// the bounds are moved onto them, and the same place costs nothing twice. The samples depend on the seed alone.
pub(super) fn descend(
    file: &SearchFile,
    cost: &Cost,
    start: &[f64],
    observer: &dyn Observer,
) -> Result<Vec<f64>> {
    let bounds: Vec<[f64; 2]> =
        cost.coordinates.iter().map(|c| c.parameter.between.map(|value| c.x(value))).collect();
    // Each unknown in units of its bounds.
    let inside = |u: &[f64]| -> (Vec<f64>, f64) {
        let x: Vec<f64> =
            u.iter().zip(&bounds).map(|(u, [low, high])| low + u.clamp(0.0, 1.0) * (high - low)).collect();
        let outside = u.iter().map(|u| (u - u.clamp(0.0, 1.0)).powi(2)).sum();
        (x, outside)
    };
    let failure: Mutex<Option<Error>> = Mutex::new(None);
    let best: Mutex<(f64, Vec<f64>)> = Mutex::new((cost.facts(start)?.cost, start.to_vec()));
    let objective = |u: &DVector<f64>| -> f64 {
        let (x, outside) = inside(u.as_slice());
        match cost.facts(&x) {
            Ok(facts) => {
                let mut best = best.lock().expect("no thread panics here");
                // Of equals the first in order, so that the threads' haste does not matter.
                if (facts.cost, &x) < (best.0, &best.1) {
                    *best = (facts.cost, x);
                }
                facts.cost + OUTSIDE * outside
            }
            Err(error) => {
                failure.lock().expect("no thread panics here").get_or_insert(error);
                f64::NAN
            }
        }
    };
    let from: Vec<f64> = start.iter().zip(&bounds).map(|(x, [low, high])| (x - low) / (high - low)).collect();
    // An even number keeps two cores busy.
    let population = (4 + (3.0 * (start.len() as f64).ln()) as usize).next_multiple_of(2);
    let options = CMAESOptions::new(from, file.spread)
        .population_size(population)
        .tol_x(1e-7)
        .tol_fun(1e-6)
        .tol_fun_hist(1e-6)
        .seed(file.seed);
    let mut samples = options
        .build(&objective)
        .map_err(|error| Error::analysis("search", format!("{error:?}"), "Search for at least one number"))?;
    let mut computed = 0;
    while computed < file.evaluations {
        let end = samples.next_parallel();
        cost.log.flush()?;
        let before = std::mem::replace(&mut computed, cost.log.costs().len());
        observer.advance((computed - before) as u64);
        if let Some(error) = failure.lock().expect("no thread panics here").take() {
            return Err(error);
        }
        if end.is_some() {
            break;
        }
    }
    drop(samples);
    Ok(best.into_inner().expect("no thread panics here").1)
}
