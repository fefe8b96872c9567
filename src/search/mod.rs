//! Numbers of a case searched for inside their bounds, so that it meets facts of any kind: natural frequencies, unstable
//! modes, the peaks of its motion in time, the moment it begins to squeal.
//!
//! A fact is a check of the validation suite: a quantity, a reference, a tolerance. With d the difference over the tolerance
//!
//!   cost = Σ 18 (√(1 + d²/9) − 1) + Σ ((p − p̄)/s)²
//!
//! over the facts and over the numbers of which something is known before. It is d² where a fact is nearly met and 6 d where it
//! is missed, so that one fact that the model cannot meet does not outweigh the others (the pseudo-Huber loss: convex, unlike
//! those that level off, so that it adds no valleys of its own; P. Charbonnier et al., IEEE Trans. Image Process. 6 (1997) 298).
//! A fact without an answer, such as the frequency of an unstable mode where none is unstable, counts as missed by fifty
//! tolerances.
//!
//! Such facts come and go with the numbers: there is no slope to follow. The cost is brought down by the adaptation of the
//! covariance matrix of samples (N. Hansen and A. Ostermeier, Evolutionary Computation 9 (2001) 159), a generation at a time, all
//! cores at work. Every evaluation is kept in `search.csv`; an interrupted search resumes where it stopped, unless the case or a
//! file it reads has changed.
//!
//! In the end each number alone is moved by a twentieth of its bounds to either side: what the cost then rises by says which
//! assumption matters most.

mod cost;
mod descent;
mod facts;
mod file;
mod log;

pub use file::{SearchFile, read_search};

use self::cost::Cost;
use self::log::Log;
use crate::error::{Error, Result};
use crate::job::Coordinate;
use crate::progress::Observer;
use crate::results::{CheckedCase, Moved, SearchResult, SearchedNumber, set_aside};
use rayon::prelude::*;
use std::path::Path;
use std::time::Instant;

/// The share of its bounds that a number is moved by in the end.
const MOVED: f64 = 0.05;

/// Searches, with every evaluation kept in the folder `out`.
///
/// # Errors
/// Input: evaluations of another search. As evaluations are written from then on, what follows is no error of the input: a case
/// that has no answer at the start, or not a fact of it; evaluations that cannot be written.
pub fn search(file: &SearchFile, out: &Path, resume: bool, observer: &dyn Observer) -> Result<SearchResult> {
    if !resume && let Some(aside) = set_aside(out)? {
        observer.note(&format!("The evaluations of an interrupted search were moved to {}", aside.display()));
    }
    let log = Log::open(out, file, resume)?;
    searched(file, &log, observer).map_err(Error::while_computing)
}

fn searched(file: &SearchFile, log: &Log, observer: &dyn Observer) -> Result<SearchResult> {
    let started = Instant::now();
    let coordinates: Vec<Coordinate> = file.parameters.values().map(Coordinate::new).collect();
    let start: Vec<f64> = coordinates.iter().zip(&file.start).map(|(c, value)| c.x(*value)).collect();
    let cost = Cost { file, coordinates: &coordinates, log };
    let first = cost.facts(&start)?;
    if first.computed.is_empty() {
        let found = "the case has no answer at its own values";
        return Err(Error::analysis("search", found, "Run the case alone to see its faults"));
    }
    observer.begin("searching", Some(file.evaluations as u64));
    let descent = descent::descend(file, &cost, &start, observer);
    observer.end();
    let best = descent?;
    let (history, without_answer) = (log.costs(), log.without_answer());
    let found = cost.facts(&best)?;
    let values: Vec<f64> = coordinates.iter().zip(&best).map(|(c, x)| c.value(*x)).collect();

    observer.begin("moving each number alone", Some(2 * coordinates.len() as u64));
    let moved = |(j, side): (usize, f64)| -> Result<Option<Moved>> {
        let [low, high] = coordinates[j].parameter.between.map(|value| coordinates[j].x(value));
        let x = best[j] + side * MOVED * (high - low);
        let answer = if (low..=high).contains(&x) {
            let mut there = best.clone();
            there[j] = x;
            let facts = cost.facts(&there)?;
            let rise = |k: &usize| facts.parts[*k] - found.parts[*k];
            let worst = (0..facts.parts.len()).max_by(|a, b| rise(a).total_cmp(&rise(b))).unwrap_or(0);
            Some(Moved { to: coordinates[j].value(x), cost: facts.cost, worst })
        } else {
            None
        };
        observer.advance(1);
        Ok(answer)
    };
    let sides: Vec<(usize, f64)> = (0..coordinates.len()).flat_map(|j| [(j, -1.0), (j, 1.0)]).collect();
    let moved: Vec<Option<Moved>> = sides.into_par_iter().map(moved).collect::<Result<_>>()?;
    observer.end();
    log.flush()?;
    log.end()?;

    let number = |(j, (name, parameter)): (usize, (&String, &crate::case::VariedParameter))| {
        let scalar = file.case.parameter(&parameter.path[0])?;
        Ok(SearchedNumber {
            name: name.clone(),
            paths: parameter.path.clone(),
            unit: scalar.unit.to_string(),
            between: parameter.between,
            before: file.start[j],
            after: values[j],
            moved: [moved[2 * j].clone(), moved[2 * j + 1].clone()],
        })
    };
    let rows = file.checks.iter().zip(&found.computed).map(|(check, value)| check.beside(*value)).collect();
    Ok(SearchResult {
        title: file.title.clone(),
        numbers: file.parameters.iter().enumerate().map(number).collect::<Result<_>>()?,
        facts: CheckedCase {
            name: file.name.clone(),
            title: file.title.clone(),
            source: file.source.clone(),
            rows,
            seconds: started.elapsed().as_secs_f64(),
        },
        before: first.computed,
        costs: [first.cost, found.cost],
        history,
        without_answer,
        found_case: file.with(&file.case, &values)?.with_absolute_paths().to_toml(),
    })
}

#[cfg(test)]
mod tests;
