//! Work on long vectors, in fixed ranges of rows: the same bits for any number of threads.

use rayon::prelude::*;
use std::ops::Range;

/// Rows of a range; what has fewer never leaves its thread.
const ROWS: usize = 8192;

/// Lets `work` write ranges of vectors of one length, side by side; it is passed the first row.
pub(super) fn chunks<const N: usize>(out: [&mut [f64]; N], work: impl Fn(usize, [&mut [f64]; N]) + Sync) {
    let n = out.first().map_or(0, |x| x.len());
    if n <= ROWS {
        return work(0, out);
    }
    let mut rest = out;
    let mut tasks = Vec::with_capacity(n.div_ceil(ROWS));
    for first in (0..n).step_by(ROWS) {
        let count = ROWS.min(n - first);
        let parts = rest.map(|x| x.split_at_mut(count));
        let (now, later): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        tasks.push((first, now));
        rest = to_array(later);
    }
    tasks.into_par_iter().for_each(|(first, parts)| work(first, to_array(parts)));
}

fn to_array<const N: usize>(parts: Vec<&mut [f64]>) -> [&mut [f64]; N] {
    parts.try_into().unwrap_or_else(|_| unreachable!("as many parts as vectors"))
}

/// Sums of n rows, those of ranges added in their order.
pub(super) fn sums<const N: usize>(n: usize, of: impl Fn(Range<usize>) -> [f64; N] + Sync) -> [f64; N] {
    if n <= ROWS {
        return of(0..n);
    }
    let parts: Vec<[f64; N]> =
        (0..n.div_ceil(ROWS)).into_par_iter().map(|task| of(task * ROWS..n.min((task + 1) * ROWS))).collect();
    let mut total = [0.0; N];
    for part in parts {
        total.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
    }
    total
}

/// out = Σ factor · x.
pub(super) fn combine(factors: [f64; 3], x: [&[f64]; 3], out: &mut [f64]) {
    let [x, y, z] = x.map(|x| &x[..out.len()]);
    for i in 0..out.len() {
        out[i] = factors[0] * x[i] + factors[1] * y[i] + factors[2] * z[i];
    }
}
