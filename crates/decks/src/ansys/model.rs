//! An archive as it stands: numbers of the file, before elements and sets are made of them.

use crate::deck::{Analysis, Motion, Place};
use crate::ledger::Ledger;
use std::collections::{BTreeMap, BTreeSet};

/// Terms of an equation: node, degree of freedom, factor.
pub(super) type Terms = Vec<(u64, u8, f64)>;

/// What the commands of a file define.
#[derive(Debug, Default)]
pub(super) struct Model {
    /// The title.
    pub title: String,
    /// Nodes by number.
    pub nodes: BTreeMap<u64, RawNode>,
    /// Rotation angles of nodes \[degree\], where they are not zero.
    pub angles: BTreeMap<u64, [f64; 3]>,
    /// Elements by number.
    pub elements: BTreeMap<u64, RawElement>,
    /// Types of elements.
    pub types: BTreeMap<u32, ElementType>,
    /// Real constants, each by its place from 1.
    pub reals: BTreeMap<u32, BTreeMap<u32, f64>>,
    /// Cross-sections.
    pub sections: BTreeMap<u32, RawSection>,
    /// Materials.
    pub materials: BTreeMap<u32, RawMaterial>,
    /// Local coordinate systems.
    pub systems: BTreeMap<i64, System>,
    /// Components, in the order of the file.
    pub components: Vec<Component>,
    /// The last component of each name, in capitals.
    pub names: BTreeMap<String, usize>,
    /// Degrees of freedom that are held.
    pub held: BTreeMap<u64, Held>,
    /// Forces at nodes, in the frames of the nodes.
    pub forces: BTreeMap<u64, ([f64; 3], Place)>,
    /// Pressures: element, face, p.
    pub pressures: Vec<(u64, u32, f64, Place)>,
    /// The equation whose terms follow.
    pub defined: i64,
    /// Constraint equations: node, degree of freedom, factor.
    pub equations: BTreeMap<i64, (Terms, Place)>,
    /// Degrees of freedom that are the same at nodes, by set.
    pub coupled: BTreeMap<(i64, u8), (Vec<u64>, Place)>,
    /// Rigid regions and averages.
    pub regions: Vec<Region>,
    /// Rotations.
    pub motions: Vec<Motion>,
    /// Analyses.
    pub analyses: Vec<Analysis>,
    /// α, β of the whole model.
    pub rayleigh: [f64; 2],
    /// η of the whole model.
    pub loss_factor: f64,
    /// Values of parameters.
    pub parameters: BTreeMap<String, f64>,
    /// Attributes of the elements that follow.
    pub current: Attributes,
    /// The set of real constants that RMORE is of.
    pub current_reals: u32,
    /// The section that SECDATA is of.
    pub section: u32,
    /// The table that TBDATA is of: material, property.
    pub table: Option<(u32, String)>,
    /// The active system of coordinates.
    pub system: i64,
    /// Selected nodes.
    pub selected_nodes: Selection,
    /// Selected elements.
    pub selected_elements: Selection,
    /// What was not read.
    pub ledger: Ledger,
}

/// A node.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawNode {
    pub position: [f64; 3],
    pub place: Place,
}

/// An element.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawElement {
    pub attributes: Attributes,
    /// 0 where there is none.
    pub nodes: Box<[u64]>,
    pub place: Place,
}

/// Numbers of what an element is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Attributes {
    pub kind: u32,
    pub material: u32,
    pub real: u32,
    pub section: u32,
    pub system: u32,
}

impl Default for Attributes {
    fn default() -> Self {
        Attributes { kind: 1, material: 1, real: 1, section: 1, system: 0 }
    }
}

/// A type of elements: the number in its name, such as 186 of SOLID186, and its key options from 1.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct ElementType {
    pub routine: u32,
    pub options: BTreeMap<u32, i64>,
    pub place: Place,
}

impl ElementType {
    /// Key option n.
    pub fn option(&self, n: u32) -> i64 {
        self.options.get(&n).copied().unwrap_or(0)
    }
}

/// A cross-section: its kind and form, its layers or its numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct RawSection {
    /// `SHELL`, `BEAM`, `LINK` and others, in capitals.
    pub kind: String,
    /// `RECT`, `CSOLID` and others, in capitals.
    pub form: String,
    /// A line for each layer, one line for others.
    pub data: Vec<Vec<f64>>,
    pub place: Place,
}

/// A material: the first value of each property in a table of temperatures.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct RawMaterial {
    pub properties: BTreeMap<String, f64>,
    pub place: Option<Place>,
}

/// A local system: its origin and its unit vectors; Cartesian or cylindrical, or another kind by number.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct System {
    pub kind: i64,
    pub origin: [f64; 3],
    pub axes: [[f64; 3]; 3],
}

/// A component: numbers from … to …
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Component {
    pub name: String,
    pub of_nodes: bool,
    /// Ascending, apart from each other.
    pub ranges: Vec<(u64, u64)>,
    pub place: Place,
}

impl Component {
    /// A component of ranges in any order.
    pub fn new(name: &str, of_nodes: bool, mut ranges: Vec<(u64, u64)>, place: Place) -> Component {
        ranges.sort_unstable();
        let mut apart: Vec<(u64, u64)> = Vec::new();
        for (from, to) in ranges {
            match apart.last_mut() {
                Some(last) if from <= last.1.saturating_add(1) => last.1 = last.1.max(to),
                _ => apart.push((from, to)),
            }
        }
        Component { name: name.to_string(), of_nodes, ranges: apart, place }
    }
}

/// What is held at a node, and whether it is moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Held {
    pub freedoms: [bool; 6],
    pub place: Place,
}

/// A node and others: of a rigid region, or of an average.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Region {
    pub reference: u64,
    pub nodes: Vec<u64>,
    pub rigid: bool,
    pub place: Place,
}

/// The degree of freedom of a label.
pub(super) fn freedom(label: &str) -> Option<u8> {
    let all = ["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"];
    all.iter().position(|own| own.eq_ignore_ascii_case(label.trim())).map(|k| k as u8)
}

/// Unit vectors of a frame that is turned from x y z by θxy about z, then θyz about its x, then θzx about its y \[degree\].
pub(super) fn turned([xy, yz, zx]: [f64; 3]) -> [[f64; 3]; 3] {
    let ((s1, c1), (s2, c2), (s3, c3)) =
        (xy.to_radians().sin_cos(), yz.to_radians().sin_cos(), zx.to_radians().sin_cos());
    [
        [c1 * c3 - s1 * s2 * s3, s1 * c3 + c1 * s2 * s3, -c2 * s3],
        [-s1 * c2, c1 * c2, s2],
        [c1 * s3 + s1 * s2 * c3, s1 * s3 - c1 * s2 * c3, c2 * c3],
    ]
}

/// Nodes or elements that commands of `ALL` act on.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) enum Selection {
    /// All of them.
    #[default]
    All,
    /// Those of these numbers.
    Some(BTreeSet<u64>),
    /// By a rule that is not read.
    Unknown,
}

impl Selection {
    /// Adds one that was just defined: it is selected.
    pub fn add(&mut self, number: u64) {
        if let Selection::Some(members) = self {
            members.insert(number);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    /// One angle alone turns as its name says: the first axis toward the second.
    #[test]
    fn angles_turn_from_the_first_axis_to_the_second() {
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| within((a[k] - b[k]).abs(), 1e-15, RoundOff));
        let [x, y, _] = turned([90.0, 0.0, 0.0]);
        assert!(near(x, [0.0, 1.0, 0.0]) && near(y, [-1.0, 0.0, 0.0]));
        let [_, y, z] = turned([0.0, 90.0, 0.0]);
        assert!(near(y, [0.0, 0.0, 1.0]) && near(z, [0.0, -1.0, 0.0]));
        let [x, _, z] = turned([0.0, 0.0, 90.0]);
        assert!(near(z, [1.0, 0.0, 0.0]) && near(x, [0.0, 0.0, -1.0]));
        // The second rotation is about the x that the first one turned.
        let [_, y, z] = turned([90.0, 90.0, 0.0]);
        assert!(near(y, [0.0, 0.0, 1.0]) && near(z, [1.0, 0.0, 0.0]));
    }

    #[test]
    fn ranges_that_touch_are_one() {
        let component = Component::new("A", true, vec![(8, 9), (1, 3), (4, 5), (2, 2)], Place::default());
        assert_eq!(component.ranges, [(1, 5), (8, 9)]);
    }
}
