//! Places solved at once.

use crate::error::Result;
use rayon::prelude::*;
use rayon::{ThreadPoolBuilder, current_num_threads};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// How many places of a problem are solved at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AtOnce {
    /// One, which takes much memory or all threads.
    One,
    /// As many as there are threads, which share what is parallel inside, too.
    Shared,
    /// As many as there are threads, each on one of them: too little is parallel inside.
    Alone,
}

/// What `solve` gives for each of `numbers`, or its error, of the lowest number unless they share threads.
pub(super) fn solve_all<T: Send>(
    at_once: AtOnce,
    numbers: Range<usize>,
    solve: &(dyn Fn(usize) -> Result<T> + Sync),
) -> Result<Vec<T>> {
    match at_once {
        AtOnce::Shared => numbers.into_par_iter().map(solve).collect(),
        AtOnce::Alone if current_num_threads().min(numbers.len()) > 1 => each_on_one_thread(numbers, solve),
        AtOnce::One | AtOnce::Alone => numbers.map(solve).collect(),
    }
}

/// Threads take the numbers in order. What is parallel inside runs on the same thread, and none takes a number while it waits for the
/// parts of another.
fn each_on_one_thread<T: Send>(
    numbers: Range<usize>,
    solve: &(dyn Fn(usize) -> Result<T> + Sync),
) -> Result<Vec<T>> {
    let (next, failed) = (AtomicUsize::new(numbers.start), AtomicBool::new(false));
    let work = || {
        let mut own = Vec::new();
        while !failed.load(Ordering::Relaxed) {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= numbers.end {
                break;
            }
            let solved = solve(k);
            failed.fetch_or(solved.is_err(), Ordering::Relaxed);
            own.push((k, solved));
        }
        own
    };
    let mut all = thread::scope(|scope| {
        let start = |_| {
            let pool = ThreadPoolBuilder::new().num_threads(1).build().ok()?;
            thread::Builder::new().spawn_scoped(scope, move || pool.install(work)).ok()
        };
        let started: Vec<_> = (0..current_num_threads().min(numbers.len())).filter_map(start).collect();
        let ended = started.into_iter().map(|thread| thread.join());
        ended.flat_map(|own| own.unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect::<Vec<_>>()
    });
    // Where the machine has no thread left.
    all.extend(work());
    all.sort_by_key(|(k, _)| *k);
    all.into_iter().map(|(_, solved)| solved).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;
    use std::collections::BTreeSet;
    use std::sync::{Barrier, Mutex};

    #[test]
    fn answers_are_in_order_and_the_first_error_is_given() {
        let square = |k: usize| Ok(k * k);
        let fails = |k: usize| match k {
            0..20 => Ok(k),
            _ => Err(Error::analysis("a place", k.to_string(), "none")),
        };
        for threads in [1, 2, 5] {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for at_once in [AtOnce::One, AtOnce::Shared, AtOnce::Alone] {
                let all = pool.install(|| solve_all(at_once, 3..100, &square)).unwrap();
                assert!(all.iter().copied().eq((3..100).map(|k| k * k)));
                assert!(pool.install(|| solve_all(at_once, 0..0, &square)).unwrap().is_empty());
                let error = pool.install(|| solve_all(at_once, 3..100, &fails)).unwrap_err();
                let first = error.to_string().contains("20");
                assert!(first || at_once == AtOnce::Shared, "{error}");
            }
        }
    }

    #[test]
    fn a_place_has_one_thread_and_several_places_run_at_once() {
        let pool = ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        let (threads, together) = (Mutex::new(BTreeSet::new()), Barrier::new(3));
        let solve = |_| {
            let outside = format!("{:?}", thread::current().id());
            let inside: Vec<String> =
                (0..100).into_par_iter().map(|_| format!("{:?}", thread::current().id())).collect();
            assert!(inside.iter().all(|id| *id == outside));
            threads.lock().unwrap().insert(outside);
            together.wait();
            Ok(())
        };
        pool.install(|| solve_all(AtOnce::Alone, 0..12, &solve)).unwrap();
        assert_eq!(threads.lock().unwrap().len(), 3);
    }
}
