//! Symbolic factorisation: the order of elimination, the fronts and the tree that they form, and how
//! that tree is split into tasks.
//!
//! A *front* is a dense symmetric matrix: some columns that are eliminated together and the rows that they touch.
//! Its Schur complement after the elimination is added to the front of its parent (Duff & Reid, ACM TOMS 9 (1983) 302).
//! Columns of equal structure share a front; a child is merged with its parent when few zeros come in (`may_merge`).

use super::super::sparse::Index;
use super::ordering::Quotient;
use faer::sparse::SymbolicSparseColMatRef;
use std::ops::Range;
use stridor_base::error::Result;

/// The plan of a factorisation.
#[derive(Debug)]
pub(super) struct Plan {
    /// The number of stored entries of the analysed pattern.
    pub entries: usize,
    /// By which the pattern is known again.
    pub fingerprint: u64,
    /// order[k] is the row of A that is eliminated as number k.
    pub order: Vec<usize>,
    /// The inverse of `order`.
    pub place: Vec<usize>,
    /// Children before their parents, a whole subtree in one piece.
    pub nodes: Vec<Node>,
    /// The whole forest, split.
    pub root: Task,
    /// The entries of L, as far as the pattern decides.
    pub fill: usize,
}

/// A front as the pattern knows it.
#[derive(Debug)]
pub(super) struct Node {
    /// Its columns, numbered by elimination.
    pub columns: Range<usize>,
    /// The rows below its columns, ascending.
    pub rows: Vec<usize>,
    /// Its children, ascending.
    pub children: Vec<usize>,
}

/// A piece of the tree for one thread: a subtree without the subtrees that are tasks of their own.
#[derive(Debug, Default)]
pub(super) struct Task {
    /// All nodes of the subtree.
    pub nodes: Range<usize>,
    /// Disjoint parts of `nodes`, ascending, that may run side by side before the rest.
    pub subtasks: Vec<Task>,
}

impl Plan {
    /// Analyses a symmetric pattern stored whole.
    ///
    /// # Errors
    /// [`stridor_base::error::Error::Analysis`] when memory does not suffice.
    pub fn new(pattern: SymbolicSparseColMatRef<'_, Index>) -> Result<Self> {
        let quotient = Quotient::new(pattern);
        let graph = Graph::new(&quotient, &quotient.order()?);
        let mut supernodes = graph.supernodes();
        merge(&mut supernodes);
        Ok(Plan::number(pattern, &quotient, &graph, supernodes))
    }

    /// The first column of node s; of the node after the last one, how many there are.
    pub fn first_column(&self, s: usize) -> usize {
        self.nodes.get(s).map_or(self.order.len(), |node| node.columns.start)
    }

    /// Numbers the columns along the tree and writes everything out for the rows of A.
    fn number(
        pattern: SymbolicSparseColMatRef<'_, Index>,
        quotient: &Quotient,
        graph: &Graph,
        mut supernodes: Vec<Supernode>,
    ) -> Self {
        let parents: Vec<usize> = supernodes.iter().map(|s| s.parent).collect();
        let sequence = postorder(&parents);
        let mut order = Vec::with_capacity(pattern.ncols());
        let mut first = vec![0; graph.groups.len()];
        let mut number = vec![usize::MAX; supernodes.len()];
        let mut nodes: Vec<Node> = Vec::new();
        for s in sequence {
            if supernodes[s].columns.is_empty() {
                continue;
            }
            let begin = order.len();
            for group in &supernodes[s].columns {
                first[*group] = order.len();
                order.extend_from_slice(&quotient.members[graph.groups[*group]]);
            }
            number[s] = nodes.len();
            nodes.push(Node {
                columns: begin..order.len(),
                rows: std::mem::take(&mut supernodes[s].rows),
                children: Vec::new(),
            });
        }
        for s in 0..supernodes.len() {
            let parent = supernodes[s].parent;
            if number[s] != usize::MAX && parent != NONE {
                nodes[number[parent]].children.push(number[s]);
            }
        }
        let mut fill = 0;
        for node in &mut nodes {
            node.children.sort_unstable();
            let groups = std::mem::take(&mut node.rows);
            let size = |group: usize| quotient.members[graph.groups[group]].len();
            node.rows = groups.iter().flat_map(|g| first[*g]..first[*g] + size(*g)).collect();
            node.rows.sort_unstable();
            let width = node.columns.len();
            fill += width * (width + 1) / 2 + width * node.rows.len();
        }
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, row)| place[*row] = k);
        let root = Task::split(&nodes);
        Plan {
            entries: pattern.compute_nnz(),
            fingerprint: fingerprint(pattern),
            order,
            place,
            nodes,
            root,
            fill,
        }
    }
}

/// A number that two patterns share only when they are the same, but for one chance in 2⁶⁴ (FNV-1a over whole words).
pub(super) fn fingerprint(pattern: SymbolicSparseColMatRef<'_, Index>) -> u64 {
    let words = pattern.col_ptr().iter().chain(pattern.row_idx());
    words.fold(0xcbf2_9ce4_8422_2325, |hash, word| (hash ^ *word as u64).wrapping_mul(0x0000_0100_0000_01b3))
}

const NONE: usize = usize::MAX;

/// The quotient graph, its vertices numbered by elimination.
struct Graph {
    /// The group behind each vertex.
    groups: Vec<usize>,
    /// The rows of A in each vertex.
    weight: Vec<usize>,
    /// The neighbours of each vertex.
    neighbours: Vec<Vec<usize>>,
    /// The elimination tree.
    parent: Vec<usize>,
}

/// Vertices that are eliminated in one front.
struct Supernode {
    columns: Vec<usize>,
    rows: Vec<usize>,
    parent: usize,
    /// Rows of A in `columns` and in `rows`.
    width: usize,
    height: usize,
    /// Entries of L that are zero, brought in by merging.
    zeros: usize,
}

impl Graph {
    fn new(quotient: &Quotient, order: &[usize]) -> Self {
        // The elimination tree first, then the same order arranged so that every subtree is one piece.
        let draft = Graph::numbered(quotient, order.to_vec());
        let sequence = postorder(&draft.parent);
        Graph::numbered(quotient, sequence.into_iter().map(|k| draft.groups[k]).collect())
    }

    fn numbered(quotient: &Quotient, groups: Vec<usize>) -> Self {
        let q = groups.len();
        let mut place = vec![0; q];
        groups.iter().enumerate().for_each(|(k, g)| place[*g] = k);
        let neighbours: Vec<Vec<usize>> =
            groups.iter().map(|g| quotient.neighbours_of(*g).iter().map(|h| place[*h]).collect()).collect();
        let weight = groups.iter().map(|g| quotient.members[*g].len()).collect();
        // The parent of k is the first later vertex that its elimination touches (Liu, SIAM J. Matrix Anal. Appl. 11
        // (1990) 134); `ancestor` shortens the walks.
        let (mut parent, mut ancestor) = (vec![NONE; q], vec![NONE; q]);
        for (k, near) in neighbours.iter().enumerate() {
            for i in near.iter().filter(|i| **i < k) {
                let mut i = *i;
                while i != k {
                    let next = std::mem::replace(&mut ancestor[i], k);
                    if next == NONE {
                        parent[i] = k;
                        break;
                    }
                    i = next;
                }
            }
        }
        Graph { groups, weight, neighbours, parent }
    }

    /// The supernodes without a zero entry, children before parents.
    fn supernodes(&self) -> Vec<Supernode> {
        let q = self.groups.len();
        let mut supernodes: Vec<Supernode> = Vec::new();
        let mut waiting: Vec<Vec<usize>> = vec![Vec::new(); q];
        let mut seen = vec![NONE; q];
        for k in 0..q {
            seen[k] = k;
            let mut rows = Vec::new();
            let children = std::mem::take(&mut waiting[k]);
            let below = self.neighbours[k].iter().filter(|i| **i > k);
            for i in children.iter().flat_map(|s| &supernodes[*s].rows).chain(below) {
                if seen[*i] != k {
                    seen[*i] = k;
                    rows.push(*i);
                }
            }
            let height = rows.iter().map(|i| self.weight[*i]).sum();
            // Vertex k − 1 has k in its rows; when it has no others than k has, the two share a front.
            let extended = children.iter().copied().find(|s| {
                supernodes[*s].columns.last() == Some(&(k.wrapping_sub(1)))
                    && supernodes[*s].rows.len() == rows.len() + 1
            });
            let s = extended.unwrap_or(supernodes.len());
            if extended.is_none() {
                let new =
                    Supernode { columns: vec![], rows: vec![], parent: NONE, width: 0, height: 0, zeros: 0 };
                supernodes.push(new);
            }
            children.iter().filter(|c| **c != s).for_each(|c| supernodes[*c].parent = s);
            let node = &mut supernodes[s];
            node.columns.push(k);
            node.width += self.weight[k];
            (node.rows, node.height) = (rows, height);
            if self.parent[k] != NONE {
                waiting[self.parent[k]].push(s);
            }
        }
        supernodes
    }
}

/// Merges children into their parents where it pays; a merged supernode keeps no columns.
fn merge(supernodes: &mut [Supernode]) {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); supernodes.len()];
    for s in 0..supernodes.len() {
        // The child with the longest rows brings the fewest zeros.
        let mut candidates = std::mem::take(&mut children[s]);
        candidates.sort_by_key(|c| (usize::MAX - supernodes[*c].height, *c));
        for c in candidates {
            let (child, parent) = (&supernodes[c], &supernodes[s]);
            let new = child.width * (parent.width + parent.height - child.height);
            let zeros = child.zeros + parent.zeros + new;
            let width = child.width + parent.width;
            if may_merge(width, parent.height, zeros) {
                let mut columns = std::mem::take(&mut supernodes[c].columns);
                columns.append(&mut supernodes[s].columns);
                (supernodes[s].columns, supernodes[s].width, supernodes[s].zeros) = (columns, width, zeros);
                // `parent` of the child stays: its own children find their way through it.
            }
        }
        if supernodes[s].parent != NONE {
            children[supernodes[s].parent].push(s);
        }
    }
    for s in (0..supernodes.len()).rev() {
        let parent = supernodes[s].parent;
        if parent != NONE && supernodes[parent].columns.is_empty() {
            supernodes[s].parent = supernodes[parent].parent;
        }
    }
}

/// Whether a front of `width` columns above `height` rows may hold so many zeros: many in a small front, where the
/// work is in the handling, few in a large one, where it is in the arithmetic.
fn may_merge(width: usize, height: usize, zeros: usize) -> bool {
    let entries = (width * (width + 1) / 2 + width * height) as f64;
    let part = zeros as f64 / entries;
    part <= [(16, 0.5), (48, 0.15), (96, 0.08)]
        .iter()
        .find(|(limit, _)| width <= *limit)
        .map_or(0.03, |(_, p)| *p)
}

/// The vertices of a forest, children before parents and each subtree in one piece.
fn postorder(parent: &[usize]) -> Vec<usize> {
    let n = parent.len();
    let (mut first, mut next) = (vec![NONE; n], vec![NONE; n]);
    let mut stack = Vec::new();
    for k in (0..n).rev() {
        if parent[k] == NONE {
            stack.push(k);
        } else {
            next[k] = std::mem::replace(&mut first[parent[k]], k);
        }
    }
    let mut sequence = Vec::with_capacity(n);
    while let Some(k) = stack.pop() {
        let child = std::mem::replace(&mut first[k], NONE);
        if child == NONE {
            sequence.push(k);
            continue;
        }
        stack.push(k);
        let begin = stack.len();
        let mut child = child;
        while child != NONE {
            stack.push(child);
            child = next[child];
        }
        stack[begin..].reverse();
    }
    sequence
}

impl Task {
    /// The nodes that belong to no subtask, ascending.
    pub fn own_nodes(&self) -> impl DoubleEndedIterator<Item = usize> {
        let starts = self.subtasks.iter().map(|subtask| subtask.nodes.start).chain([self.nodes.end]);
        let ends =
            [self.nodes.start].into_iter().chain(self.subtasks.iter().map(|subtask| subtask.nodes.end));
        ends.zip(starts).map(|(end, start)| end..start).collect::<Vec<_>>().into_iter().flatten()
    }

    /// Splits the forest where two heavy subtrees meet. The split does not depend on the number of threads, and so
    /// neither does any result.
    fn split(nodes: &[Node]) -> Task {
        // A subtree's entries of L stand for its work.
        let mut work: Vec<usize> = Vec::with_capacity(nodes.len());
        let mut first: Vec<usize> = Vec::with_capacity(nodes.len());
        let mut is_root = vec![true; nodes.len()];
        for (s, node) in nodes.iter().enumerate() {
            let own = node.columns.len() * (node.columns.len() + node.rows.len());
            work.push(own + node.children.iter().map(|c| work[*c]).sum::<usize>());
            first.push(node.children.first().map_or(s, |c| first[*c]));
            node.children.iter().for_each(|c| is_root[*c] = false);
        }
        let roots: Vec<usize> = (0..nodes.len()).filter(|s| is_root[*s]).collect();
        let total: usize = roots.iter().map(|s| work[*s]).sum();
        let grain = (total / TASKS).max(SMALLEST_TASK);
        let tree = Tree { nodes, work, first, grain };
        Task { nodes: 0..nodes.len(), subtasks: tree.subtasks(&roots) }
    }
}

/// About how many tasks a tree is split into, and the entries of L below which a task is not worth its start.
const TASKS: usize = 48;
const SMALLEST_TASK: usize = 50_000;

struct Tree<'a> {
    nodes: &'a [Node],
    work: Vec<usize>,
    first: Vec<usize>,
    grain: usize,
}

impl Tree<'_> {
    /// The tasks below siblings: one each where two or more are heavy; a single heavy one is followed downwards.
    fn subtasks(&self, siblings: &[usize]) -> Vec<Task> {
        let mut siblings = siblings;
        loop {
            let heavy: Vec<usize> = siblings.iter().copied().filter(|s| self.work[*s] > self.grain).collect();
            match heavy.as_slice() {
                [] => return Vec::new(),
                [one] => siblings = &self.nodes[*one].children,
                several => {
                    let task = |s: &usize| Task {
                        nodes: self.first[*s]..s + 1,
                        subtasks: self.subtasks(&self.nodes[*s].children),
                    };
                    return several.iter().map(task).collect();
                }
            }
        }
    }
}
