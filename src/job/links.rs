//! Who follows whom, and who is held: the rigid bodies and supports of a case, checked in the words of the case.

use super::regions::Regions;
use crate::case::{Case, Rigid};
use crate::error::{Error, Fault, Faults};
use crate::structure::{RigidLink, Support};
use std::collections::BTreeMap;

/// The rigid links of the case. A master among its followers moves with itself anyway and is left out there.
///
/// Faults: regions that are missing, a master whose only follower is itself, nodes that follow two masters, circles.
pub fn rigid_links(case: &Case, regions: &Regions, faults: &mut Faults) -> Vec<RigidLink> {
    let mut links = Vec::new();
    // The master of every follower, and the rigid body that says so.
    let mut leader: BTreeMap<usize, (usize, &str)> = BTreeMap::new();
    for (name, rigid) in &case.rigid {
        let Some(link) = link(name, rigid, regions, faults) else { continue };
        let already = |slave: &&usize| leader.get(slave).is_some_and(|(master, _)| *master != link.master);
        let twice: Vec<usize> = link.slaves.iter().filter(already).copied().collect();
        if let Some(first) = twice.first() {
            let (master, other) = leader[first];
            let found = format!(
                "{} that already follow {} by `rigid.{other}`",
                regions.count_of_nodes(&twice),
                regions.name_of_node(master)
            );
            let help = "Let one of the masters follow the other instead";
            faults.push(Fault::new(follow(name), found, "one master for every node").with_help(help));
        }
        for slave in &link.slaves {
            leader.entry(*slave).or_insert((link.master, name));
        }
        links.push(link);
    }
    if let Some((node, (master, name))) = circle(&leader) {
        let (node, master) = (regions.name_of_node(node), regions.name_of_node(master));
        let found = format!("a circle: {node} follows {master}, which follows {node} in the end");
        faults.push(Fault::new(follow(name), found, "a master that follows none of its followers"));
    }
    links
}

fn follow(name: &str) -> String {
    format!("`rigid.{name}.follow`")
}

fn link(name: &str, rigid: &Rigid, regions: &Regions, faults: &mut Faults) -> Option<RigidLink> {
    let master = faults.take(regions.node(&rigid.master, &format!("`rigid.{name}.master`")));
    let slaves = regions.nodes_of(&rigid.follow, &follow(name), faults);
    let master = master?;
    if slaves == [master] {
        let found = format!("no node but the master itself, {}", regions.name_of_node(master));
        let help = format!(
            "Name the regions that move with `{}`; without this rigid body nothing changes",
            rigid.master
        );
        faults.push(Fault::new(follow(name), found, "regions with other nodes").with_help(help));
    }
    let slaves = slaves.into_iter().filter(|slave| *slave != master).collect();
    Some(RigidLink { master, slaves })
}

/// A follower that follows itself in the end, with its leader.
fn circle<'a>(leader: &BTreeMap<usize, (usize, &'a str)>) -> Option<(usize, (usize, &'a str))> {
    leader.iter().map(|(node, of)| (*node, *of)).find(|(node, (master, _))| {
        let mut at = *master;
        for _ in 0..leader.len() {
            match leader.get(&at) {
                _ if at == *node => return true,
                Some((next, _)) => at = *next,
                None => return false,
            }
        }
        false
    })
}

/// The supports of the case; a fault for each that holds nodes which follow a master.
pub fn supports(case: &Case, regions: &Regions, links: &[RigidLink], faults: &mut Faults) -> Vec<Support> {
    let followers: BTreeMap<usize, usize> =
        links.iter().flat_map(|link| link.slaves.iter().map(|slave| (*slave, link.master))).collect();
    let mut supports = Vec::new();
    for (name, support) in &case.support {
        let place = format!("`support.{name}.on`");
        let nodes = regions.nodes_of(&support.on, &place, faults);
        let held = support.holds();
        let moved: Vec<usize> = nodes.iter().filter(|node| followers.contains_key(node)).copied().collect();
        if let Some(first) = moved.first().filter(|_| held.contains(&true)) {
            let master = regions.name_of_node(followers[first]);
            let follow = if moved.len() == 1 { "follows" } else { "follow" };
            let found = format!("{} that {follow} {master} rigidly", regions.count_of_nodes(&moved));
            let fault = Fault::new(place, found, "regions of masters, or of nodes that follow none");
            faults.push(fault.with_help(format!("Hold the master, {master}")));
        }
        supports.push(Support { nodes, held });
    }
    supports
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
