//! The rigid bodies and supports of a case, and its constraints checked in the words of the case.

use super::regions::Regions;
use crate::case::{Axis, Case};
use crate::error::{Error, Fault, Faults, Result};
use crate::structure::{
    ConstraintWords, InclinedSupport, Model, Part, RigidLink, Support, check_constraints,
};
use nalgebra::Vector3;

/// Nodes nearer to an axis than this share of their distance from a point of it are on it.
const ON_AXIS: f64 = 1e-9;
/// Components of unit directions below this are round-off.
const ROUND_OFF: f64 = 1e-14;

/// Adds the rigid links and the supports of the case to `model`, which has its other constraints. A master among its followers moves with itself
/// anyway and is left out there.
///
/// Faults: regions that are missing, a master whose only follower is itself, nodes on the axis of a support, those of [`check_constraints`].
pub fn add_links(case: &Case, regions: &Regions, model: &mut Model, faults: &mut Faults) {
    let mut names = Vec::new();
    for (name, rigid) in &case.rigid {
        let followers = format!("`rigid.{name}.follow`");
        let master = faults.take(regions.node(&rigid.master, &format!("`rigid.{name}.master`")));
        let slaves = regions.nodes_of(&rigid.follow, &followers, faults);
        let Some(master) = master else { continue };
        if slaves == [master] {
            let found = format!("no node but the master itself, {}", regions.name_of_node(master));
            let help = format!(
                "Name the regions that move with `{}`; without this rigid body nothing changes",
                rigid.master
            );
            faults.push(Fault::new(followers, found, "regions with other nodes").with_help(help));
        }
        names.push(name);
        let slaves = slaves.into_iter().filter(|slave| *slave != master).collect();
        model.links.push(RigidLink { master, slaves });
    }
    let places: Vec<String> = case.support.keys().map(|name| format!("`support.{name}.on`")).collect();
    for (support, place) in case.support.values().zip(&places) {
        let nodes = regions.nodes_of(&support.on, place, faults);
        if let (Some(axis), held) = (&support.axis, support.holds_about_axis()) {
            let inclined = about_axis(axis, held, &nodes, (regions, model), place);
            model.inclined_supports.extend(faults.take(inclined).unwrap_or_default());
        }
        model.supports.push(Support { nodes, held: support.holds() });
    }
    let words = ConstraintWords {
        link: &|k| format!("`rigid.{}`", names[k]),
        followers: &|k| format!("`rigid.{}.follow`", names[k]),
        support: &|k| places[k].clone(),
        node: &|node| regions.name_of_node(node),
        nodes: &|nodes| regions.count_of_nodes(nodes),
    };
    check_constraints(model, &words, faults);
}

/// What holds nodes along directions about an axis: e_r away from it, e_t = a × e_r, a along it.
fn about_axis(
    axis: &Axis,
    held: [bool; 3],
    nodes: &[usize],
    (regions, model): (&Regions, &Model),
    place: &str,
) -> Result<Vec<InclinedSupport>> {
    let along = Vector3::from(axis.along).normalize();
    let (mut all, mut on_axis) = (Vec::with_capacity(nodes.len()), Vec::new());
    for node in nodes.iter().filter(|_| held.contains(&true)) {
        let from = Vector3::from(model.nodes[*node]) - Vector3::from(axis.through);
        let across = from - from.dot(&along) * along;
        let Some(radial) = across.try_normalize(ON_AXIS * from.norm()) else {
            if held[0] || held[1] {
                on_axis.push(*node);
            }
            continue;
        };
        let directions = [radial, along.cross(&radial), along];
        let held = directions.iter().zip(held).filter(|(_, held)| *held);
        let six = |d: &Vector3<f64>| {
            [d[0], d[1], d[2], 0.0, 0.0, 0.0].map(|c| if c.abs() < ROUND_OFF { 0.0 } else { c })
        };
        all.push(InclinedSupport {
            node: *node,
            held: held.map(|(d, _)| six(d)).collect(),
            name: place.to_string(),
        });
    }
    if on_axis.is_empty() {
        return Ok(all);
    }
    let found = format!("{} on the `axis`, where no direction is radial", regions.count_of_nodes(&on_axis));
    let fault = Fault::new(place, found, "nodes off the axis");
    Err(Error::input(fault.with_help("Leave them out of the region, or move the axis by `through`")))
}

/// Refuses what acts on rotations of nodes that have none: solids take displacements alone.
pub fn check_turning(case: &Case, regions: &Regions, model: &Model, faults: &mut Faults) {
    let mut turns = vec![true; model.nodes.len()];
    let turn =
        |part: &&Part| part.element(&model.nodes).is_some_and(|element| element.components().contains(&3));
    let (turning, others): (Vec<&Part>, Vec<&Part>) = model.parts.iter().partition(turn);
    others.into_iter().flat_map(Part::nodes).for_each(|node| turns[node] = false);
    turning.into_iter().flat_map(Part::nodes).for_each(|node| turns[node] = true);
    for link in &model.links {
        std::iter::once(&link.master).chain(&link.slaves).for_each(|node| turns[*node] = true);
    }
    let slaves = model.couplings.iter().flat_map(|coupling| &coupling.constraints).map(|c| c.slave);
    slaves.filter(|(_, component)| *component > 2).for_each(|(node, _)| turns[node] = true);
    for coupling in &model.couplings {
        let terms = coupling.constraints.iter().flat_map(|constraint| &constraint.terms);
        let still = |(node, component, _): &&(usize, usize, f64)| *component > 2 && !turns[*node];
        if let Some((node, ..)) = terms.into_iter().find(still) {
            let found = format!("a rotation of {} of solids", regions.name_of_node(*node));
            faults.push(Fault::new(&coupling.name, found, "displacements: solids have no rotations"));
        }
    }
    let mut check = |place: String, what: &str, on: &[String]| {
        // Regions that are missing are faults already.
        let nodes = regions.nodes_of(on, "", &mut Faults::new());
        let still: Vec<usize> = nodes.into_iter().filter(|node| !turns[*node]).collect();
        if !still.is_empty() {
            let found = format!("{what} on {} of solids", regions.count_of_nodes(&still));
            let fault = Fault::new(place, found, "nodes with rotations: solids have displacements alone");
            faults.push(fault.with_help(
                "Make a [point], join it to a face of the solid by [averaging], or by [rigid], which makes it stiff, and name the point here; \
                 a face whose displacements are held does not turn",
            ));
        }
    };
    for (name, support) in &case.support {
        if let Some(rotation) = support.held.iter().find(|held| ["rx", "ry", "rz"].contains(&held.as_str())) {
            check(format!("`support.{name}.held`"), &format!("\"{rotation}\""), &support.on);
        }
    }
    for (name, spring) in case.spring.iter().filter(|(_, spring)| spring.rotational) {
        let ends: Vec<String> = std::iter::once(&spring.on).chain(&spring.to).cloned().collect();
        check(format!("`spring.{name}.rotational`"), "true", &ends);
    }
    for (name, mass) in case.mass.iter().filter(|(_, mass)| mass.inertia != [0.0; 3]) {
        check(format!("`mass.{name}.inertia`"), "moments of inertia", std::slice::from_ref(&mass.on));
    }
}

/// An error of the structure in terms of the case: the keys of all that holds something, `clamp` among them, replace its supports.
pub fn in_terms_of_the_case(error: Error, case: &Case, clamp: Option<String>) -> Error {
    let Error::Input(mut faults) = error else { return error };
    let supports = case.support.keys().map(|name| format!("`support.{name}`"));
    let keys: Vec<String> = clamp.into_iter().chain(supports).collect();
    for fault in faults.0.iter_mut().filter(|fault| fault.place == "supports" && !keys.is_empty()) {
        fault.place = keys.join(", ");
    }
    Error::Input(faults)
}

#[cfg(test)]
mod tests {
    use crate::case::Case;
    use crate::job::Prepared;

    /// Four points, of which `tables` says who follows and who is held.
    fn said(tables: &str) -> String {
        let case = format!(
            "[point]\na = [0, 0, 0]\nb = [1, 0, 0]\nc = [0, 1, 0]\nd = [0, 0, 1]\n\
             [mass.all]\non = \"a\"\nmass = 1\n{tables}\n[modes.all]\ncount = 1\n"
        );
        let case = Case::parse("links.toml", &case, "".into()).unwrap();
        Prepared::new(&case).unwrap_err().to_string()
    }

    #[test]
    fn who_follows_is_named_with_key_line_and_point() {
        let body = |name: &str, master: &str, follow: &str| {
            format!("[rigid.{name}]\nmaster = \"{master}\"\nfollow = {follow}\n")
        };
        let text = said(&body("hub", "a", "[\"a\"]"));
        for part in ["links.toml:11 `rigid.hub.follow`", "the master itself, node 1 (`a`)", "move with `a`"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let two = body("one", "a", "[\"c\", \"d\"]") + &body("two", "b", "[\"c\", \"d\"]");
        let text = said(&two);
        for part in [
            "links.toml:14 `rigid.two.follow`",
            "2 nodes, the first node 3 (`c`),",
            "node 1 (`a`) by `rigid.one`",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let circle = body("one", "a", "\"b\"") + &body("two", "b", "\"c\"") + &body("three", "c", "\"a\"");
        let text = said(&circle);
        assert!(text.contains("a circle: node 1 (`a`) follows node 3 (`c`)"), "{text}");
        assert_eq!(text.matches("found").count(), 1, "{text}");
        let held = body("one", "a", "[\"b\", \"c\"]") + "[support.s]\non = [\"b\", \"c\", \"d\"]\n";
        let text = said(&held);
        for part in [
            "links.toml:13 `support.s.on`",
            "2 nodes, the first node 2 (`b`),",
            "Hold the master, node 1 (`a`)",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let text = said(&held.replace("\"b\", \"c\", \"d\"]", "\"c\", \"d\"]"));
        assert!(text.contains("node 3 (`c`) that follows node 1 (`a`) rigidly"), "{text}");
    }

    #[test]
    fn supports_that_hold_everything_are_named() {
        let text = said("[support.wall]\non = [\"a\", \"b\"]\n[support.floor]\non = [\"c\", \"d\"]\n");
        for part in ["links.toml:11 `support.floor`", "`support.wall`", "every degree of freedom held"] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
