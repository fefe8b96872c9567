//! Sets a body on its counter-body: lead angle and contact position (theory of the rig: x slides, z is up).

use super::regions::Regions;
use crate::case::{Case, Contact, Placement};
use crate::error::{Error, Fault, Result};

/// Tilts everything connected to the contact's body by the lead angle about y and moves it until its lowest contact
/// node stands at `position` on the upper face of the counter-body.
///
/// x′ = x cos θ + z sin θ, z′ = −x sin θ + z cos θ: the lowest point moves towards −x when θ > 0. Since the body is
/// then moved as a whole, the point it is turned about does not matter.
///
/// # Errors
/// A counter-body that is connected to the body, or a position that is off the counter-body.
pub fn place(
    regions: &mut Regions,
    case: &Case,
    name: &str,
    contact: &Contact,
    placement: &Placement,
) -> Result<()> {
    let (body, counter) = (contact.body.as_str(), contact.counter.as_str());
    let place = format!("`contact.{name}.placement`");
    let body_nodes = regions.nodes(body, &format!("`contact.{name}.body`"))?;
    let counter_nodes = regions.nodes(counter, &format!("`contact.{name}.counter`"))?;
    let group = connected_groups(regions, case);
    let moved = group[body_nodes[0]];
    if counter_nodes.iter().any(|n| group[*n] == moved) {
        return Err(Error::input(
            Fault::new(
                place,
                format!("`{body}` and `{counter}` joined in one body"),
                "two separate bodies to place",
            )
            .with_help("Remove the placement, or the nodes and links that join the two"),
        ));
    }
    let nodes = &mut regions.mesh.nodes;
    let (sin, cos) = placement.lead_angle.sin_cos();
    for (node, g) in nodes.iter_mut().zip(&group) {
        if *g == moved {
            let [x, y, z] = *node;
            *node = [x * cos + z * sin, y, -x * sin + z * cos];
        }
    }
    let lowest = body_nodes
        .iter()
        .copied()
        .min_by(|a, b| {
            let key = |n: usize| (nodes[n][2], nodes[n][1].abs());
            key(*a).partial_cmp(&key(*b)).unwrap_or(std::cmp::Ordering::Equal)
        })
        .expect("a region has nodes");
    let bound = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
        counter_nodes.iter().map(|n| nodes[*n][axis]).fold(start, pick)
    };
    let low = [0, 1, 2].map(|axis| bound(axis, f64::min, f64::INFINITY));
    let high = [0, 1, 2].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY));
    let middle = |axis: usize| 0.5 * (low[axis] + high[axis]);
    let target = [middle(0) + placement.position[0], middle(1) + placement.position[1]];
    for axis in 0..2 {
        if target[axis] < low[axis] || target[axis] > high[axis] {
            return Err(Error::input(Fault::new(
                format!("{place} position"),
                format!("{} m from the middle of `{counter}`", placement.position[axis]),
                format!(
                    "a point on it: at most {} m along {}",
                    0.5 * (high[axis] - low[axis]),
                    ["x", "y"][axis]
                ),
            )));
        }
    }
    let thickness = case.shell.get(counter).map_or(0.0, |shell| shell.thickness);
    let shift = [
        target[0] - nodes[lowest][0],
        target[1] - nodes[lowest][1],
        high[2] + 0.5 * thickness - nodes[lowest][2],
    ];
    for (node, g) in nodes.iter_mut().zip(&group) {
        if *g == moved {
            for axis in 0..3 {
                node[axis] += shift[axis];
            }
        }
    }
    Ok(())
}

/// For every node, the lowest node it is connected to through elements and rigid bodies.
fn connected_groups(regions: &Regions, case: &Case) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..regions.mesh.nodes.len()).collect();
    fn root(parent: &mut [usize], mut node: usize) -> usize {
        while parent[node] != node {
            parent[node] = parent[parent[node]];
            node = parent[node];
        }
        node
    }
    let mut join = |nodes: &[usize]| {
        for pair in nodes.windows(2) {
            let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
            parent[a.max(b)] = a.min(b);
        }
    };
    regions.mesh.elements.iter().for_each(|element| join(element.nodes()));
    for rigid in case.rigid.values() {
        let names = rigid.follow.iter().chain([&rigid.master]);
        let nodes: Vec<usize> = names.filter_map(|name| regions.nodes(name, "").ok()).flatten().collect();
        join(&nodes);
    }
    (0..parent.len()).map(|node| root(&mut parent, node)).collect()
}
