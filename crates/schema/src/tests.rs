use super::*;
use crate::units::{LENGTH, NUMBER};
use std::collections::BTreeMap;
use std::ops::Bound;

choices! {
    /// Colours.
    pub enum Colour {
        /// Red.
        Red = "red",
        /// Green.
        Green = "green",
    }
}

variants! {
    /// A body.
    pub enum Body by presence {
        /// A ball.
        Ball "radius" {
            /// r \[m\].
            radius: f64 = key::quantity(LENGTH).positive(),
        }
        /// A box.
        Box "edges" {
            /// Edges \[m\].
            edges: [f64; 3] = key::quantities(LENGTH),
            /// Whether it is open.
            open: bool = key::flag(false),
        }
    }
}

declare! {
    /// A thing.
    pub struct Thing, checked by check_thing {
        /// Its colour.
        pub colour: Colour = key::choice().or(Colour::Green),
        /// Its body.
        pub body: Body = key::flat(),
        /// A share.
        pub share: f64 = key::quantity(NUMBER).within(Bound::Included(0.0), Bound::Included(1.0)).or(0.5),
        /// Twice the share.
        pub twice: f64 = key::quantity(NUMBER).or_by("twice `share`", 2.0 * *share),
    }
}

declare! {
    /// All things.
    pub struct Things {
        /// By name.
        pub thing: BTreeMap<String, Thing> = key::named().invalidates(Invalidates::Law),
        /// Weights by name.
        pub weight: BTreeMap<String, f64> = key::values(|| key::quantity(NUMBER), "one letter", |n| n.len() == 1),
    }
}

fn check_thing(thing: &Thing, report: &mut Report) {
    if thing.colour == Colour::Red && matches!(thing.body, Body::Ball { .. }) {
        report.fault("colour", "red", "green for a ball", "");
    }
}

fn read(text: &str) -> stridor_base::error::Result<Things> {
    read_table("things.toml", text).map(|read| read.table)
}

#[test]
fn a_table_is_read_with_its_defaults_and_written_as_it_reads() {
    let things = read(
        "[thing.a]\nradius = \"2 mm\"\n[thing.\"b.c\"]\nedges = [1, 2, 3]\nshare = 0.25\n[weight]\nx = 3\n",
    );
    let things = things.unwrap();
    assert_eq!(things.thing["a"].body, Body::Ball { radius: 2e-3 });
    assert_eq!((things.thing["a"].twice, things.thing["b.c"].twice), (1.0, 0.5));
    assert_eq!((things.thing["a"].colour, things.weight["x"]), (Colour::Green, 3.0));
    let text = to_toml(&things).to_string();
    assert_eq!(read(&text).unwrap(), things, "{text}");
    let made = Thing { body: Body::Ball { radius: 1.0 }, ..Thing::default() };
    assert_eq!((made.share, made.twice), (0.5, 1.0));
}

#[test]
fn numbers_are_found_and_set_by_their_paths() {
    let mut things = read("[thing.\"b.c\"]\nedges = [1, 2, 3]\n[weight]\nx = 3\n").unwrap();
    let all = scalars(&things);
    let paths: Vec<&str> = all.iter().map(|s| s.path.as_str()).collect();
    let edges = "thing.\"b.c\".edges";
    let expected =
        [0, 1, 2].map(|k| format!("{edges}.{k}")).into_iter().chain(["thing.\"b.c\".share".into()]);
    assert_eq!(paths[..4], expected.collect::<Vec<String>>());
    assert_eq!((all[0].unit, all[0].invalidates), ("m", Invalidates::Law));
    assert_eq!((all[5].path.as_str(), all[5].invalidates), ("weight.x", Invalidates::Structure));
    assert!(!all[3].accepts(1.5) && all[3].accepts(1.0));
    assert!(set_scalar(&mut things, "thing.\"b.c\".edges.1", 7.0));
    assert!(!set_scalar(&mut things, "thing.b.c.edges.1", 8.0));
    assert_eq!(things.thing["b.c"].body, Body::Box { edges: [1.0, 7.0, 3.0], open: false });
}

#[test]
fn every_fault_is_named_once_at_its_line() {
    let text = "[thing.a]\nradius = \"2 kg\"\ncolour = \"rad\"\n[thing.b]\nradius = 1\nedges = [1, 2]\n\
                [thing.c]\nradius = 1\ncolour = \"red\"\nopen = true\n[thing.d]\nshare = 2\n[weight]\nxy = true\nab = 1\n";
    let error = read(text).unwrap_err().to_string();
    for expected in [
        "things.toml:2 `thing.a.radius`: found \"2 kg\", whose unit \"kg\" is of another dimension",
        "things.toml:3 `thing.a.colour`: found \"rad\" (did you mean \"red\"?); expected one of red, green",
        "things.toml:6 `thing.b.edges`: found both `radius` and `edges`; expected one of them",
        "things.toml:9 `thing.c.colour`: found red; expected green for a ball",
        "things.toml:10 `thing.c.open`: found an unknown key",
        "things.toml:11 `thing.d.radius`: found nothing; expected one of the keys radius, edges",
        "things.toml:12 `thing.d.share`: found 2.0; expected a value of zero or more and of 1 or less",
        "things.toml:14 `weight.xy`: found true",
        "things.toml:15 `weight.ab`: found the name \"ab\"; expected one letter",
    ] {
        assert!(error.contains(expected), "{expected} not in\n{error}");
    }
}

#[test]
fn paths_with_backslashes_are_told_how_to_write_them() {
    for path in ["meshes\\disc.msh", "C:\\Users\\me", "..\\case", "a\\x"] {
        let text = read(&format!("colour = \"{path}\"\n")).err().unwrap().to_string();
        assert!(text.contains("write paths with / or in '…'"), "{path}: {text}");
    }
    let text = read("colour = red\n").err().unwrap().to_string();
    assert!(!text.contains("paths"), "{text}");
}

#[test]
fn a_scalar_is_named_as_the_quantity_it_is() {
    let things =
        read("[thing.a]\nradius = 1\n[thing.\"b.c\"]\nedges = [1, 2, 3]\n[weight]\nx = 3\n").unwrap();
    let labels: BTreeMap<String, String> = scalars(&things).into_iter().map(|s| (s.path, s.label)).collect();
    assert_eq!(labels["thing.a.radius"], "radius r of a");
    assert_eq!(labels["thing.a.share"], "share of a");
    assert_eq!(labels["thing.\"b.c\".edges.1"], "edges of b.c, entry 2");
    assert_eq!(labels["weight.x"], "x");
}
