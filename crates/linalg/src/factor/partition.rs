//! The rows of a matrix shared out among processes.

use super::ordering::Quotient;
use crate::sparse::Index;
use faer::sparse::SymbolicSparseColMatRef;

/// The part, below `parts`, of every row of a symmetric pattern: about as many rows in each part, and few entries between
/// parts, by METIS. Where METIS gives up, the parts are consecutive rows.
pub fn partition(pattern: SymbolicSparseColMatRef<'_, Index>, parts: usize) -> Vec<usize> {
    let n = pattern.ncols();
    let quotient = Quotient::new(pattern);
    let Some(part_of_group) = quotient.parts(parts) else {
        return (0..n).map(|row| row * parts / n.max(1)).collect();
    };
    let mut part = vec![0; n];
    for (rows, own) in quotient.members.iter().zip(part_of_group) {
        rows.iter().for_each(|row| part[*row] = own);
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn parts_are_of_a_size_and_touch_little() {
        let (k, _) = samples::plate(30, false);
        let n = k.ncols();
        // METIS gets one vertex for each node of the mesh, so the degrees of freedom of a node are never parted.
        assert_eq!((Quotient::new(k.symbolic()).len(), n), (31 * 31, 3 * 31 * 31));
        for parts in [1, 2, 3, 8] {
            let part = partition(k.symbolic(), parts);
            assert!(part.chunks(3).all(|node| node.iter().all(|own| *own == node[0])));
            let rows = |p: usize| part.iter().filter(|own| **own == p).count();
            assert!((0..parts).all(|p| rows(p) * parts * 10 > n * 8 && rows(p) * parts * 10 < n * 12));
            let between = |j: usize| k.row_idx_of_col(j).filter(|i| part[*i] != part[j]).count();
            let cut: usize = (0..n).map(between).sum();
            // Of a square cut into parts the edges have about 2 √parts of its sides.
            assert!((cut as f64) < 2.0 * (parts as f64).sqrt() * 30.0 * 81.0 + 1.0, "{cut}");
        }
    }
}
