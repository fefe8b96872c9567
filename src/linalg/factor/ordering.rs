//! The order of elimination: equal rows are first taken together (the degrees of freedom of a node, as a rule), and
//! minimum degree orders the smaller graph that remains.

use crate::error::Result;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// A graph whose vertices are groups of rows with the same neighbours.
pub(super) struct Quotient {
    /// The rows of each group, ascending.
    pub members: Vec<Vec<usize>>,
    /// Where the neighbours of each group begin in `neighbours`.
    pub starts: Vec<usize>,
    /// The other groups that a group touches, ascending.
    pub neighbours: Vec<usize>,
}

impl Quotient {
    /// Groups the rows of a symmetric pattern.
    pub fn new(pattern: SymbolicSparseColMatRef<'_, usize>) -> Self {
        let n = pattern.ncols();
        let rows = |j: usize| pattern.row_idx_of_col_raw(j);
        // A sum of scrambled indices over the row's neighbours and itself tells most different rows apart at once.
        let scramble = |i: usize| (i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
        let scramble = |i: usize| scramble(i).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let keys: Vec<(u64, usize)> = (0..n)
            .map(|j| {
                let others = || rows(j).iter().filter(|i| **i != j);
                let key = others().fold(scramble(j), |sum, i| sum.wrapping_add(scramble(*i)));
                (key, others().count())
            })
            .collect();
        let same = |i: usize, j: usize| {
            let outside = |k: &&usize| **k != i && **k != j;
            keys[i] == keys[j] && rows(i).iter().filter(outside).eq(rows(j).iter().filter(outside))
        };
        let mut group = vec![usize::MAX; n];
        let mut members: Vec<Vec<usize>> = Vec::new();
        for j in 0..n {
            let older = rows(j).iter().filter(|i| **i < j && members[group[**i]][0] == **i);
            match older.copied().find(|i| same(*i, j)) {
                Some(i) => group[j] = group[i],
                None => {
                    group[j] = members.len();
                    members.push(Vec::new());
                }
            }
            members[group[j]].push(j);
        }
        let (mut starts, mut neighbours) = (vec![0], Vec::new());
        let mut seen = vec![usize::MAX; members.len()];
        for (g, rows_of_group) in members.iter().enumerate() {
            let begin = neighbours.len();
            for i in rows(rows_of_group[0]) {
                let other = group[*i];
                if other != g && seen[other] != g {
                    seen[other] = g;
                    neighbours.push(other);
                }
            }
            neighbours[begin..].sort_unstable();
            starts.push(neighbours.len());
        }
        Quotient { members, starts, neighbours }
    }

    /// The number of groups.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// The neighbours of group g.
    pub fn neighbours_of(&self, g: usize) -> &[usize] {
        &self.neighbours[self.starts[g]..self.starts[g + 1]]
    }

    /// The groups in an order that keeps the fill small.
    ///
    /// # Errors
    /// [`crate::error::Error::Analysis`] when memory does not suffice.
    pub fn order(&self) -> Result<Vec<usize>> {
        let q = self.len();
        let (mut order, mut place) = (vec![0; q], vec![0; q]);
        let failed = |said: String| super::out_of_memory(q, &said);
        let graph = SymbolicSparseColMatRef::new_checked(q, q, &self.starts, None, &self.neighbours);
        let mut memory = MemBuffer::try_new(amd::order_scratch::<usize>(q, self.neighbours.len()))
            .map_err(|e| failed(format!("{e:?}")))?;
        amd::order(&mut order, &mut place, graph, Default::default(), MemStack::new(&mut memory))
            .map_err(|e| failed(format!("{e:?}")))?;
        Ok(order)
    }
}
