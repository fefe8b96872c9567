//! Who follows whom, and who is held: rigid links and supports, checked in one place, in the words of a model or of a case.

use super::model::{Model, RigidLink};
use crate::error::{Fault, Faults};

/// How messages name links, supports and nodes, which are given by their indices.
pub struct TieWords<'a> {
    /// A link.
    pub link: &'a dyn Fn(usize) -> String,
    /// The place that lists its followers.
    pub followers: &'a dyn Fn(usize) -> String,
    /// The place that lists the nodes of a support.
    pub support: &'a dyn Fn(usize) -> String,
    /// A node.
    pub node: &'a dyn Fn(usize) -> String,
    /// Nodes: how many, and the first.
    pub nodes: &'a dyn Fn(&[usize]) -> String,
}

/// The last master of every node; its own number for a node that follows none. Links and supports of a model without names.
pub(super) fn resolve_links(model: &Model, faults: &mut Faults) -> Vec<usize> {
    let node = |node: usize| format!("node {}", node + 1);
    let link = |k: usize| format!("rigid link {}", k + 1);
    let nodes = |all: &[usize]| match all {
        [one] => node(*one),
        all => format!("{} nodes, the first {},", all.len(), node(all[0])),
    };
    let support = |k: usize| format!("support {}", k + 1);
    check_ties(
        model,
        &TieWords { link: &link, followers: &link, support: &support, node: &node, nodes: &nodes },
        faults,
    )
}

/// The last master of every node of `model`; its own number for a node that follows none.
///
/// Faults: a master among its followers, nodes that follow two masters, circles, supports of nodes that follow a master.
pub fn check_ties(model: &Model, words: &TieWords, faults: &mut Faults) -> Vec<usize> {
    let follow = |nodes: &[usize]| if nodes.len() == 1 { "follows" } else { "follow" };
    // The master of every follower, and the first link that says so.
    let mut leader: Vec<Option<(usize, usize)>> = vec![None; model.nodes.len()];
    for (k, RigidLink { master, slaves }) in model.links.iter().enumerate() {
        let twice = |slave: &&usize| leader[**slave].is_some_and(|(other, _)| other != *master);
        let twice: Vec<usize> = slaves.iter().filter(twice).copied().collect();
        if let Some((other, first)) = twice.first().and_then(|slave| leader[*slave]) {
            let (master, link) = ((words.node)(other), (words.link)(first));
            let (nodes, follow) = ((words.nodes)(&twice), follow(&twice));
            let found = format!("{nodes} that already {follow} {master} by {link}");
            let fault = Fault::new((words.followers)(k), found, "one master for every node");
            faults.push(fault.with_help("Let one of the masters follow the other instead"));
        }
        slaves.iter().for_each(|slave| {
            leader[*slave].get_or_insert((*master, k));
        });
    }
    let mut masters: Vec<usize> = (0..leader.len()).collect();
    for (node, own) in leader.iter().enumerate() {
        let Some((first, link)) = *own else { continue };
        // One that leads into a circle is not the one to be named.
        for _ in 0..leader.len() {
            let Some((next, _)) = leader[masters[node]] else { break };
            if next == node {
                let (node, first) = ((words.node)(node), (words.node)(first));
                let found = format!("a circle: {node} follows {first}, which follows {node} in the end");
                let expected = "a master that follows none of its followers";
                faults.push(Fault::new((words.followers)(link), found, expected));
                return masters;
            }
            masters[node] = next;
        }
    }
    for (k, support) in model.supports.iter().enumerate().filter(|(_, of)| of.held.contains(&true)) {
        let moved: Vec<usize> =
            support.nodes.iter().copied().filter(|node| masters[*node] != *node).collect();
        if let Some(first) = moved.first() {
            let (master, nodes, follow) =
                ((words.node)(masters[*first]), (words.nodes)(&moved), follow(&moved));
            let found = format!("{nodes} that {follow} {master} rigidly");
            let expected = "regions of masters, or of nodes that follow none";
            let fault = Fault::new((words.support)(k), found, expected);
            faults.push(fault.with_help(format!("Hold the master, {master}")));
        }
    }
    masters
}
