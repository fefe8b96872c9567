//! Connected components, such as those of nodes or of rows of a matrix.

/// For each of `count` nodes the lowest one that it is connected to by `groups`: the nodes of a group, such as those of an
/// element, or row and column of an entry, are connected.
pub fn lowest_connected<G: AsRef<[usize]>>(count: usize, groups: impl IntoIterator<Item = G>) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..count).collect();
    for group in groups {
        for pair in group.as_ref().windows(2) {
            let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
            parent[a.max(b)] = a.min(b);
        }
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
    fn groups_that_share_a_node_are_connected_and_others_are_not() {
        let groups: [&[usize]; 5] = [&[4, 5], &[7, 2, 3], &[5, 6], &[3, 1], &[]];
        assert_eq!(lowest_connected(8, groups), [0, 1, 1, 1, 4, 4, 4, 1]);
    }
}
