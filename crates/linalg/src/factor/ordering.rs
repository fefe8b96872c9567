//! The order of elimination: equal rows are first taken together (the degrees of freedom of a node, as a rule); METIS
//! dissects the smaller graph that remains, minimum degree orders a small one.
//!
//! On a plate of 199,692 unknowns dissection takes 0.3 s more than minimum degree, but L has 13 % fewer entries, a
//! factorisation takes 27 % less time and its tree is balanced.

use super::super::sparse::Index;
use super::refused::out_of_memory;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use metis_sys::idx_t;
use std::sync::Mutex;
use stridor_base::error::Result;

/// Groups below which dissection does not pay.
const SMALL: usize = 1000;

/// METIS draws its random numbers from one place for the whole process: two calls at once would disturb each other's result.
static METIS: Mutex<()> = Mutex::new(());

/// A graph whose vertices are groups of rows with the same neighbours.
pub(super) struct Quotient {
    /// The rows of each group, ascending.
    pub members: Vec<Vec<usize>>,
    /// Where the neighbours of each group begin in `neighbours`.
    pub starts: Vec<usize>,
    /// The other groups that a group touches, ascending.
    pub neighbours: Vec<usize>,
}

/// A graph as METIS takes it.
struct MetisGraph {
    starts: Vec<idx_t>,
    neighbours: Vec<idx_t>,
    weights: Vec<idx_t>,
}

impl Quotient {
    /// Groups the rows of a symmetric pattern.
    pub fn new(pattern: SymbolicSparseColMatRef<'_, Index>) -> Self {
        let n = pattern.ncols();
        let rows = |j: usize| pattern.row_idx_of_col(j);
        // A sum of scrambled indices over the row's neighbours and itself separates most different rows at once.
        let scramble = |i: usize| (i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
        let scramble = |i: usize| scramble(i).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let keys: Vec<(u64, usize)> = (0..n)
            .map(|j| {
                let others = || rows(j).filter(|i| *i != j);
                let key = others().fold(scramble(j), |sum, i| sum.wrapping_add(scramble(i)));
                (key, others().count())
            })
            .collect();
        let same = |i: usize, j: usize| {
            let outside = |k: &usize| *k != i && *k != j;
            keys[i] == keys[j] && rows(i).filter(outside).eq(rows(j).filter(outside))
        };
        let mut group = vec![usize::MAX; n];
        let mut members: Vec<Vec<usize>> = Vec::new();
        for j in 0..n {
            let mut older = rows(j).filter(|i| *i < j && members[group[*i]][0] == *i);
            match older.find(|i| same(*i, j)) {
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
                let other = group[i];
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
    /// [`stridor_base::error::Error::Analysis`] when memory does not suffice.
    pub fn order(&self) -> Result<Vec<usize>> {
        match self.dissected() {
            Some(order) => Ok(order),
            None => self.minimum_degree(),
        }
    }

    /// The graph as METIS takes it; none beyond its 32-bit indices.
    fn metis_graph(&self) -> Option<MetisGraph> {
        let short = |all: &[usize]| all.iter().map(|i| idx_t::try_from(*i).ok()).collect::<Option<Vec<_>>>();
        Some(MetisGraph {
            starts: short(&self.starts)?,
            neighbours: short(&self.neighbours)?,
            weights: self.members.iter().map(|rows| rows.len() as idx_t).collect(),
        })
    }

    /// The part, below `parts`, of every group: about as many rows in each part, and few neighbours in others. None where METIS
    /// gives up.
    pub fn parts(&self, parts: usize) -> Option<Vec<usize>> {
        if parts == 1 {
            return Some(vec![0; self.len()]);
        }
        let MetisGraph { mut starts, mut neighbours, mut weights } = self.metis_graph()?;
        let (mut q, mut constraints, mut count) = (self.len() as idx_t, 1, parts as idx_t);
        let (mut cut, mut part) = (0, vec![0; self.len()]);
        let mut options = [0; metis_sys::METIS_NOPTIONS as usize];
        let _guard = METIS.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        // SAFETY: the graph is in METIS's format, symmetric and without loops; every array has the length that METIS
        // expects and outlives the call; what is null is optional.
        let status = unsafe {
            metis_sys::METIS_SetDefaultOptions(options.as_mut_ptr());
            options[metis_sys::moptions_et_METIS_OPTION_SEED as usize] = 1;
            metis_sys::METIS_PartGraphKway(
                &mut q,
                &mut constraints,
                starts.as_mut_ptr(),
                neighbours.as_mut_ptr(),
                weights.as_mut_ptr(),
                std::ptr::null_mut(),
                std::ptr::null_mut(),
                &mut count,
                std::ptr::null_mut(),
                std::ptr::null_mut(),
                options.as_mut_ptr(),
                &mut cut,
                part.as_mut_ptr(),
            )
        };
        (status == metis_sys::rstatus_et_METIS_OK).then(|| part.into_iter().map(|p| p as usize).collect())
    }

    /// Nested dissection; none for a graph that is small, beyond METIS's 32-bit indices, or that METIS gives up.
    fn dissected(&self) -> Option<Vec<usize>> {
        if self.len() < SMALL {
            return None;
        }
        let MetisGraph { mut starts, mut neighbours, mut weights } = self.metis_graph()?;
        let mut q = self.len() as idx_t;
        let (mut order, mut place) = (vec![0; self.len()], vec![0; self.len()]);
        let mut options = [0; metis_sys::METIS_NOPTIONS as usize];
        let _guard = METIS.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        // SAFETY: the graph is in METIS's format, symmetric and without loops; every array has the length that METIS
        // expects and outlives the call.
        let status = unsafe {
            metis_sys::METIS_SetDefaultOptions(options.as_mut_ptr());
            options[metis_sys::moptions_et_METIS_OPTION_SEED as usize] = 1;
            // Equal rows are together already.
            options[metis_sys::moptions_et_METIS_OPTION_COMPRESS as usize] = 0;
            metis_sys::METIS_NodeND(
                &mut q,
                starts.as_mut_ptr(),
                neighbours.as_mut_ptr(),
                weights.as_mut_ptr(),
                options.as_mut_ptr(),
                order.as_mut_ptr(),
                place.as_mut_ptr(),
            )
        };
        (status == metis_sys::rstatus_et_METIS_OK).then(|| order.into_iter().map(|g| g as usize).collect())
    }

    /// Approximate minimum degree.
    fn minimum_degree(&self) -> Result<Vec<usize>> {
        let q = self.len();
        let (mut order, mut place) = (vec![0; q], vec![0; q]);
        let failed = |said: String| out_of_memory(q, &said);
        let graph = SymbolicSparseColMatRef::new_checked(q, q, &self.starts, None, &self.neighbours);
        let mut memory = MemBuffer::try_new(amd::order_scratch::<usize>(q, self.neighbours.len()))
            .map_err(|e| failed(format!("{e:?}")))?;
        amd::order(&mut order, &mut place, graph, Default::default(), MemStack::new(&mut memory))
            .map_err(|e| failed(format!("{e:?}")))?;
        Ok(order)
    }
}
