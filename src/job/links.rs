//! The rigid bodies and supports of a case, checked in the words of the case.

use super::regions::Regions;
use crate::case::Case;
use crate::error::{Error, Fault, Faults};
use crate::structure::{Model, RigidLink, Support, TieWords, check_ties};

/// Adds the rigid links and the supports of the case to `model`. A master among its followers moves with itself anyway and is left out
/// there.
///
/// Faults: regions that are missing, a master whose only follower is itself, those of [`check_ties`].
pub fn add_ties(case: &Case, regions: &Regions, model: &mut Model, faults: &mut Faults) {
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
        model.supports.push(Support { nodes, held: support.holds() });
    }
    let words = TieWords {
        link: &|k| format!("`rigid.{}`", names[k]),
        followers: &|k| format!("`rigid.{}.follow`", names[k]),
        support: &|k| places[k].clone(),
        node: &|node| regions.name_of_node(node),
        nodes: &|nodes| regions.count_of_nodes(nodes),
    };
    check_ties(model, &words, faults);
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
