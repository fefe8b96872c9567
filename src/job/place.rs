//! Where the case sets a body on its counter-body.

use super::regions::Regions;
use crate::case::{Case, Contact, Placement};
use crate::connected::lowest_connected;
use crate::contact::{self, OffCounter};
use crate::error::{Error, Fault, Result};
use crate::structure::Coupling;
use std::sync::Arc;

/// Turns and moves everything connected to the contact's body as [`contact::place`] does.
///
/// # Errors
/// A counter-body that is connected to the body, or a position that is off the counter-body.
pub fn place(
    regions: &mut Regions,
    (case, equations): (&Case, &[Coupling]),
    name: &str,
    contact: &Contact,
    placement: &Placement,
) -> Result<()> {
    let (body, counter) = (contact.body.as_str(), contact.counter.as_str());
    let place = format!("`contact.{name}.placement`");
    let body_nodes = regions.nodes(body, &format!("`contact.{name}.body`"))?;
    let counter_nodes = regions.nodes(counter, &format!("`contact.{name}.counter`"))?;
    let lowest = connected(regions, case, equations);
    let moves: Vec<bool> = lowest.iter().map(|node| *node == lowest[body_nodes[0]]).collect();
    if counter_nodes.iter().any(|n| moves[*n]) {
        return Err(Error::input(
            Fault::new(
                place,
                format!("`{body}` and `{counter}` joined in one body"),
                "two separate bodies to place",
            )
            .with_help("Remove the placement, or the nodes and links that join the two"),
        ));
    }
    let stand = contact::BodyPlacement {
        moves: &moves,
        touching: &body_nodes,
        counter: &counter_nodes,
        thickness: case.shell.get(counter).map_or(0.0, |shell| shell.thickness),
        lead_angle: placement.lead_angle,
        position: placement.position,
    };
    contact::place(&mut Arc::make_mut(&mut regions.mesh).nodes, &stand).map_err(
        |OffCounter { axis, reach }| {
            Error::input(Fault::new(
                format!("{place} position"),
                format!("{} m from the middle of `{counter}`", placement.position[axis]),
                format!("a point on it: at most {reach} m along {}", ["x", "y"][axis]),
            ))
        },
    )
}

/// For every node, the lowest node it is connected to through elements, rigid bodies, averaging links, ties and equations.
fn connected(regions: &Regions, case: &Case, equations: &[Coupling]) -> Vec<usize> {
    let nodes = |names: Vec<&String>| -> Vec<usize> {
        names.into_iter().filter_map(|name| regions.nodes(name, "").ok()).flatten().collect()
    };
    let bodies = case.rigid.values().map(|rigid| rigid.follow.iter().chain([&rigid.master]).collect());
    let means = case.averaging.values().map(|link| link.of.iter().chain([&link.point]).collect());
    let ties = case.tie.values().map(|tie| vec![&tie.on, &tie.to]);
    let mut joined: Vec<Vec<usize>> = bodies.chain(means).chain(ties).map(nodes).collect();
    let constraints = equations.iter().flat_map(|equation| &equation.constraints);
    joined.extend(constraints.map(|constraint| {
        let terms = constraint.terms.iter().map(|(node, ..)| *node);
        std::iter::once(constraint.slave.0).chain(terms).collect()
    }));
    let elements = regions.mesh.elements.iter().map(|element| element.nodes());
    lowest_connected(regions.mesh.nodes.len(), elements.chain(joined.iter().map(Vec::as_slice)))
}
