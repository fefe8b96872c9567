//! W A Wᵀ of a small matrix between sparse directions.

use crate::dense::product;
use crate::sparse::{Index, SparseVector, entry};
use faer::sparse::Triplet;
use faer::{Mat, MatRef};
use std::collections::BTreeSet;

/// The entries of W A Wᵀ that are not zero, W the directions one a column and A (r × r): both products are made on the rows in which some
/// direction acts, as directions that fill many rows have these in common.
pub fn congruence(directions: &[&SparseVector], a: MatRef<'_, f64>) -> Vec<Triplet<Index, Index, f64>> {
    let rows: BTreeSet<usize> = directions.iter().flat_map(|d| d.indices()).copied().collect();
    let rows: Vec<usize> = rows.into_iter().collect();
    let mut w = Mat::<f64>::zeros(rows.len(), directions.len());
    for (j, direction) in directions.iter().enumerate() {
        for (p, x) in direction.iter() {
            w[(rows.binary_search(&p).expect("a row in which a direction acts"), j)] = x;
        }
    }
    let sum = product(product(w.as_ref(), a).as_ref(), w.transpose());
    let entries = rows.iter().enumerate().flat_map(|(j, q)| {
        let sum = &sum;
        rows.iter().enumerate().map(move |(i, p)| (*p, *q, sum[(i, j)]))
    });
    entries.filter(|(.., v)| *v != 0.0).map(|(p, q, v)| entry(p, q, v)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn entries_are_those_of_the_dense_product() {
        let mut random = Random::seeded(4);
        for trial in 0..30 {
            let (n, r) = (5 + trial, 1 + trial % 7);
            let directions: Vec<SparseVector> = (0..r)
                .map(|_| {
                    SparseVector::from_entries((0..n).step_by(1 + trial % 3).map(|i| (i, random.next())))
                })
                .collect();
            let a = Mat::from_fn(r, r, |_, _| random.next());
            let w = Mat::from_fn(n, r, |i, j| {
                directions[j].iter().filter(|(p, _)| *p == i).map(|(_, x)| x).sum::<f64>()
            });
            let exact = product(product(w.as_ref(), a.as_ref()).as_ref(), w.transpose());
            let mut found = Mat::<f64>::zeros(n, n);
            for e in congruence(&directions.iter().collect::<Vec<_>>(), a.as_ref()) {
                found[(e.row as usize, e.col as usize)] += e.val;
            }
            assert!(within((&found - &exact).norm_max(), 1e-12, RoundOff));
        }
    }
}
