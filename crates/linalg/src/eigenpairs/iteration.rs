//! The eigenpairs nearest a shift: by block Lanczos, or by the eigensolver of the library that has the factors.

use crate::SparseMatrix;
use crate::factor::{EigenSolver, SymmetricFactor};
use crate::lanczos::{BlockLanczos, Ritz, Window};
use faer::Mat;
use stridor_base::error::{Error, Result};
use stridor_base::progress::Observer;

/// By how many pairs more than wanted a library is asked for, in turn, until the wanted ones are among them.
const MORE: [usize; 3] = [0, 4, 32];

/// An iteration at a shift, which goes on where it was when more is wanted.
pub(super) struct Iteration<'a> {
    shift: f64,
    method: Method<'a>,
}

/// θ, ascending, and x, one a column.
type Pairs = (Vec<f64>, Mat<f64>);

enum Method<'a> {
    BlockLanczos(Box<BlockLanczos<'a>>, Option<(Ritz, Window)>),
    Library(Library<'a>, Pairs),
}

/// The library and what it is to solve.
struct Library<'a> {
    solver: &'a dyn EigenSolver,
    pencil: [&'a SparseMatrix; 2],
    tolerance: f64,
}

impl<'a> Iteration<'a> {
    /// For the pencil K, M and K − σM factorised at a shift σ; pairs are accepted at ‖A x − ν x‖_M ≤ `accepted` |ν|. `capacity` columns
    /// are expected in the basis.
    pub(super) fn new(
        pencil: [&'a SparseMatrix; 2],
        (shift, factor): (f64, &'a dyn SymmetricFactor),
        capacity: usize,
        accepted: f64,
    ) -> Self {
        let method = match factor.eigensolver() {
            Some(solver) => {
                Method::Library(Library { solver, pencil, tolerance: accepted }, (Vec::new(), Mat::new()))
            }
            None => {
                let lanczos = BlockLanczos::new(pencil[1], factor, capacity, accepted);
                Method::BlockLanczos(Box::new(lanczos), None)
            }
        };
        Iteration { shift, method }
    }

    /// The eigenvalues θ of a window, ascending, and whether M reaches no others.
    ///
    /// # Errors
    /// They do not converge.
    pub(super) fn values(&mut self, window: Window, observer: &dyn Observer) -> Result<(Vec<f64>, bool)> {
        match &mut self.method {
            Method::BlockLanczos(lanczos, found) => {
                let ritz = lanczos.converge(window, observer)?;
                let all = ritz.is_none();
                let ritz = ritz.map_or_else(|| lanczos.ritz(), Ok)?;
                let window = if all { lanczos.everything(&ritz) } else { window };
                let mut values: Vec<f64> =
                    window.indices(&ritz).into_iter().map(|k| self.shift + 1.0 / ritz.values[k]).collect();
                values.sort_by(f64::total_cmp);
                *found = Some((ritz, window));
                Ok((values, all))
            }
            Method::Library(library, found) => {
                let all;
                (*found, all) = library.pairs(window, self.shift)?;
                observer.advance(1);
                Ok((found.0.clone(), all))
            }
        }
    }

    /// Looks in new directions too, for copies of multiple eigenvalues.
    pub(super) fn look_again(&mut self) {
        if let Method::BlockLanczos(lanczos, _) = &mut self.method {
            lanczos.look_again();
        }
    }

    /// The pairs (θ, x) of the last window, θ ascending.
    ///
    /// # Errors
    /// Numbers overflow.
    ///
    /// # Panics
    /// When there was no window.
    pub(super) fn pairs(self) -> Result<Pairs> {
        match self.method {
            Method::BlockLanczos(lanczos, found) => {
                let (ritz, window) = found.expect("values were asked for");
                let mut which: Vec<(f64, usize)> = window
                    .indices(&ritz)
                    .into_iter()
                    .map(|k| (self.shift + 1.0 / ritz.values[k], k))
                    .collect();
                which.sort_by(|a, b| a.0.total_cmp(&b.0));
                let columns: Vec<usize> = which.iter().map(|(_, k)| *k).collect();
                let vectors = lanczos.vectors(&ritz, &columns)?;
                Ok((which.into_iter().map(|(theta, _)| theta).collect(), vectors))
            }
            Method::Library(_, found) => Ok(found),
        }
    }
}

impl Library<'_> {
    /// The pairs of a window, and whether M reaches no others.
    fn pairs(&self, window: Window, shift: f64) -> Result<(Pairs, bool)> {
        let (wanted, n) = (window.negative + window.largest, self.pencil[1].ncols());
        if wanted == 0 {
            return Ok(((Vec::new(), Mat::zeros(n, 0)), false));
        }
        for more in MORE {
            let count = (wanted + more).min(n);
            let (mut values, mut vectors) = self.solver.nearest(self.pencil, shift, count, self.tolerance)?;
            let below = values.partition_point(|theta| *theta < shift);
            let farthest = (window.largest > 0).then(|| values.get(wanted - 1)).flatten();
            let inside =
                window.largest == 0 || farthest.is_some_and(|theta| 1.0 / (theta - shift) >= window.floor);
            let complete = below == window.negative && inside;
            if complete || count == n {
                values.truncate(wanted);
                vectors.resize_with(n, values.len(), |_, _| 0.0);
                return Ok(((values, vectors), !complete));
            }
        }
        Err(Error::analysis(
            "eigenvalues",
            format!("of {wanted} that the inertia counts near θ = {shift:.9e} the library finds fewer"),
            "Use another engine, or move the bound a little",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Wanted, lowest_eigenpairs};
    use super::*;
    use crate::samples;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use stridor_base::bounds::{Origin::*, within};

    /// An eigensolver that misses one of the nearest pairs, the first few times.
    #[derive(Debug)]
    struct Forgetful {
        missed: usize,
        times: usize,
        asked: AtomicUsize,
    }

    impl EigenSolver for Forgetful {
        fn nearest(&self, [k, m]: [&SparseMatrix; 2], shift: f64, count: usize, _: f64) -> Result<Pairs> {
            let all = lowest_eigenpairs(k, m, Wanted::Count(count + 20), &())?;
            let mut nearest: Vec<usize> = (0..all.values.len()).collect();
            nearest.sort_by(|a, b| (all.values[*a] - shift).abs().total_cmp(&(all.values[*b] - shift).abs()));
            if self.asked.fetch_add(1, Ordering::Relaxed) < self.times {
                nearest.remove(self.missed);
            }
            nearest.truncate(count);
            nearest.sort_unstable();
            let vectors = Mat::from_fn(k.ncols(), count, |i, j| all.vectors[(i, nearest[j])]);
            Ok((nearest.iter().map(|pair| all.values[*pair]).collect(), vectors))
        }
    }

    #[test]
    fn a_library_that_misses_a_pair_is_asked_again() {
        let (k, m) = samples::plate(12, false);
        let all = lowest_eigenpairs(&k, &m, Wanted::Count(12), &()).unwrap().values;
        // Between modes that are far apart: a square plate has double ones.
        let gap = |numbers: std::ops::Range<usize>| {
            numbers
                .max_by(|a, b| (all[*a] - all[a - 1]).total_cmp(&(all[*b] - all[b - 1])))
                .expect("a number")
        };
        let (negative, wanted) = (gap(4..7), gap(9..12));
        let [shift, bound] = [negative, wanted].map(|k| 0.5 * (all[k - 1] + all[k]));
        let window = Window { negative, largest: wanted - negative, floor: 1.0 / (bound - shift) };
        for (missed, times) in [(0, 0), (0, 1), (1, 1), (1, 2), (0, 9)] {
            let solver = Forgetful { missed, times, asked: AtomicUsize::new(0) };
            let library = Library { solver: &solver, pencil: [&k, &m], tolerance: 1e-10 };
            let mut iteration =
                Iteration { shift, method: Method::Library(library, (Vec::new(), Mat::new())) };
            let found = iteration.values(window, &());
            if times > MORE.len() {
                assert!(found.unwrap_err().to_string().contains("the library finds fewer"));
                continue;
            }
            let (values, all_of_m) = found.unwrap();
            assert!(
                values.iter().zip(&all).all(|(a, b)| within((a - b).abs(), 1e-9 * bound, Tolerance)),
                "{values:?}, {all:?}"
            );
            assert!(!all_of_m, "M reaches more");
            assert_eq!((values.len(), solver.asked.load(Ordering::Relaxed)), (wanted, times + 1));
            assert_eq!(iteration.pairs().unwrap().1.ncols(), wanted);
        }
    }
}
