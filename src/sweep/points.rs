//! Points that are independent of each other, recorded piece by piece as they are there.

use super::AtOnce;
use super::at_once::solve_all;
use crate::error::{Error, Result};
use crate::progress::Observer;

/// Points that are recorded together.
const PIECE: usize = 32;

/// The numbers of places without an answer, ascending, and why they have none.
pub type Unanswered = Vec<(usize, Error)>;

/// Points, and those without an answer.
pub type Filled<P> = (Vec<P>, Unanswered);

/// Takes a piece of the points with the index of the first.
pub type RecordPoints<'a, P> = dyn FnMut(usize, &[P]) -> Result<()> + 'a;

/// An answer, or why there is none.
///
/// # Errors
/// [`Error::Io`]: the machine refused, which says nothing of the place.
pub fn reasoned<T>(answer: Result<T>) -> Result<Result<T>> {
    match answer {
        Err(refused @ Error::Io { .. }) => Err(refused),
        answer => Ok(answer),
    }
}

/// Points 0 to `total`; a point without an answer is `none`.
///
/// `record` is called with each new piece and the index of its first point, in order. Neither the numbers nor the pieces depend on the
/// number of threads.
pub(super) fn fill<P: Clone + Send>(
    (total, at_once): (usize, AtOnce),
    solve: &(dyn Fn(usize) -> Result<P> + Sync),
    none: P,
    record: &mut RecordPoints<P>,
    observer: &dyn Observer,
) -> Result<Filled<P>> {
    let (mut points, mut unanswered) = (Vec::new(), Vec::new());
    let solve = |k: usize| {
        let point = solve(k);
        observer.advance(1);
        Ok(point)
    };
    // Work for all threads, and the same pieces for any number of them.
    let chunk = match at_once {
        // Each takes long.
        AtOnce::One => 1,
        AtOnce::Shared | AtOnce::Alone => PIECE * rayon::current_num_threads().div_ceil(2),
    };
    while points.len() < total {
        let first = points.len();
        for point in solve_all(at_once, first..total.min(first + chunk), &solve)? {
            let point = reasoned(point)?.unwrap_or_else(|why| {
                unanswered.push((points.len(), why));
                none.clone()
            });
            points.push(point);
        }
        for (k, piece) in points[first..].chunks(PIECE).enumerate() {
            record(first + k * PIECE, piece)?;
        }
    }
    Ok((points, unanswered))
}
