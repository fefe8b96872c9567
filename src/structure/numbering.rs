//! In which order nodes get their degrees of freedom: neighbours next to each other, so that products with the matrices meet
//! what they read in the processor's cache, however the mesh was numbered.

use super::users::users;

/// The nodes 0 … `count` − 1, each once, in waves that go from one end of what hangs together to the other (Cuthill & McKee,
/// Proc. 24th National Conference ACM (1969) 157). `pieces` are the nodes that are coupled with each other.
pub(super) fn node_order(count: usize, pieces: &[Vec<usize>]) -> Vec<usize> {
    let (starts, touching) = users(count, pieces.iter().map(Vec::as_slice));
    let mut graph = Graph { pieces, starts, touching, passed: vec![0; count] };
    let mut order = Vec::with_capacity(count);
    for node in 0..count {
        if graph.passed[node] == 0 {
            // The last node of a wave lies at an end.
            let end = graph.wave(node, 1).last().copied().unwrap_or(node);
            order.extend(graph.wave(end, 2));
        }
    }
    order
}

struct Graph<'a> {
    pieces: &'a [Vec<usize>],
    /// Node k is part of the pieces `touching[starts[k]..starts[k + 1]]`.
    starts: Vec<usize>,
    touching: Vec<usize>,
    /// The last wave that passed each node.
    passed: Vec<u8>,
}

impl Graph<'_> {
    /// The nodes that wave number `wave` passes from `start` on, those with few neighbours first among those that it meets together.
    fn wave(&mut self, start: usize, wave: u8) -> Vec<usize> {
        let mut met = vec![start];
        self.passed[start] = wave;
        let mut at = 0;
        while at < met.len() {
            let (node, first) = (met[at], met.len());
            for piece in &self.touching[self.starts[node]..self.starts[node + 1]] {
                for other in &self.pieces[*piece] {
                    if self.passed[*other] < wave {
                        self.passed[*other] = wave;
                        met.push(*other);
                    }
                }
            }
            met[first..].sort_by_key(|node| (self.starts[node + 1] - self.starts[*node], *node));
            at += 1;
        }
        met
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_near_each_other_however_nodes_are_numbered() {
        // A strip of 40 × 3 squares whose nodes are numbered at random, and a node on its own.
        let count = 41 * 4 + 1;
        let mut names: Vec<usize> = (0..count).collect();
        names.sort_by_key(|k| (k * 7919 + 13) % 10007);
        let at = |x: usize, y: usize| names[4 * x + y];
        let square = |x: usize, y: usize| vec![at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        let pieces: Vec<Vec<usize>> =
            (0..40).flat_map(|x| (0..3).map(move |y| (x, y))).map(|(x, y)| square(x, y)).collect();
        let order = node_order(count, &pieces);
        let mut place = vec![usize::MAX; count];
        order.iter().enumerate().for_each(|(k, node)| place[*node] = k);
        assert!(order.len() == count && place.iter().all(|k| *k < count));
        let spread = |nodes: &Vec<usize>| {
            let places = nodes.iter().map(|node| place[*node]);
            places.clone().max().unwrap_or(0) - places.min().unwrap_or(0)
        };
        let widest = pieces.iter().map(spread).max();
        assert!(widest <= Some(9), "{widest:?}");
        assert!(node_order(0, &[]).is_empty());
    }
}
