//! Which nodes hang together.

/// For each of `count` nodes the lowest one that it is connected to by `groups`: the nodes of a group, as those of an
/// element, hang together.
pub fn lowest_connected<'a>(count: usize, groups: impl IntoIterator<Item = &'a [usize]>) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..count).collect();
    for pair in groups.into_iter().flat_map(|nodes| nodes.windows(2)) {
        let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
        parent[a.max(b)] = a.min(b);
    }
    (0..count).map(|node| root(&mut parent, node)).collect()
}

/// The lowest node so far, the way to it halved.
fn root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_that_share_a_node_hang_together_and_others_do_not() {
        let groups: [&[usize]; 5] = [&[4, 5], &[7, 2, 3], &[5, 6], &[3, 1], &[]];
        assert_eq!(lowest_connected(8, groups), [0, 1, 1, 1, 4, 4, 4, 1]);
    }
}
