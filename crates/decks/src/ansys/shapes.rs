//! Elements as cells: what an element of a number is, and its nodes in the order of a kind.
//!
//! Where a brick has fewer corners, nodes stand more than once; where an edge has no node in its middle, zero stands for it: displacements
//! are linear along that edge. The cell has a node of its own there, and three equations hold it half way between the ends.

use super::model::Model;
use super::reader::Reader;
use crate::deck::{Equation, Node, Place};
use crate::ledger::Weight;
use std::collections::HashMap;
use stridor_mesh::{CellKind, Program};

/// What an element is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Family {
    Solid,
    Shell,
    Beam,
    Link,
    Mass,
    Spring,
    Contact,
    Target,
    /// Loads on faces: SURF153, SURF154.
    Surface,
    /// MESH200.
    Drawn,
}

/// An element by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Routine {
    pub number: u32,
    /// Its name.
    pub name: &'static str,
    pub family: Family,
    /// Elements that have the nodes of this one: with nodes in the middles of edges, and without.
    pub nodes_of: [&'static str; 2],
    /// What is not as the name says.
    pub other: Option<(Weight, &'static str)>,
}

const fn row(number: u32, name: &'static str, family: Family, nodes_of: [&'static str; 2]) -> Routine {
    Routine { number, name, family, nodes_of, other: None }
}

const fn as_other(
    number: u32,
    name: &'static str,
    nodes_of: [&'static str; 2],
    why: &'static str,
) -> Routine {
    Routine { number, name, family: Family::Solid, nodes_of, other: Some((Weight::Matters, why)) }
}

const BRICK: [&str; 2] = ["", "SOLID185"];
const BRICK20: [&str; 2] = ["SOLID186", "SOLID185"];
const TETRAHEDRON: [&str; 2] = ["SOLID187", "SOLID285"];
const SHELL: [&str; 2] = ["", "SHELL181"];
const SHELL8: [&str; 2] = ["SHELL281", "SHELL181"];
const NONE: [&str; 2] = ["", ""];
const THERMAL: &str = "an element of heat, read as the solid of the same nodes";
const COUPLED: &str = "an element of several fields, read as the solid of the same nodes";

/// All that are known.
const ROUTINES: &[Routine] = &[
    row(185, "SOLID185", Family::Solid, BRICK),
    row(45, "SOLID45", Family::Solid, BRICK),
    row(186, "SOLID186", Family::Solid, BRICK20),
    row(95, "SOLID95", Family::Solid, BRICK20),
    row(187, "SOLID187", Family::Solid, TETRAHEDRON),
    row(92, "SOLID92", Family::Solid, TETRAHEDRON),
    row(285, "SOLID285", Family::Solid, ["", "SOLID285"]),
    as_other(190, "SOLSH190", BRICK, "a solid shell, read as SOLID185: bending needs incompatible modes"),
    as_other(5, "SOLID5", BRICK, COUPLED),
    as_other(226, "SOLID226", BRICK20, COUPLED),
    as_other(227, "SOLID227", TETRAHEDRON, COUPLED),
    as_other(70, "SOLID70", BRICK, THERMAL),
    as_other(278, "SOLID278", BRICK, THERMAL),
    as_other(90, "SOLID90", BRICK20, THERMAL),
    as_other(279, "SOLID279", BRICK20, THERMAL),
    as_other(87, "SOLID87", TETRAHEDRON, THERMAL),
    as_other(291, "SOLID291", TETRAHEDRON, THERMAL),
    row(181, "SHELL181", Family::Shell, SHELL),
    row(63, "SHELL63", Family::Shell, SHELL),
    row(43, "SHELL43", Family::Shell, SHELL),
    row(281, "SHELL281", Family::Shell, SHELL8),
    row(93, "SHELL93", Family::Shell, SHELL8),
    row(188, "BEAM188", Family::Beam, ["", "BEAM188"]),
    row(4, "BEAM4", Family::Beam, ["", "BEAM188"]),
    row(189, "BEAM189", Family::Beam, ["BEAM189", "BEAM188"]),
    row(180, "LINK180", Family::Link, ["", "LINK180"]),
    row(8, "LINK8", Family::Link, ["", "LINK180"]),
    row(21, "MASS21", Family::Mass, NONE),
    row(14, "COMBIN14", Family::Spring, NONE),
    row(173, "CONTA173", Family::Contact, NONE),
    row(174, "CONTA174", Family::Contact, NONE),
    row(175, "CONTA175", Family::Contact, NONE),
    row(170, "TARGE170", Family::Target, NONE),
    row(154, "SURF154", Family::Surface, NONE),
    row(152, "SURF152", Family::Surface, NONE),
    row(153, "SURF153", Family::Surface, NONE),
    row(156, "SURF156", Family::Surface, NONE),
    row(176, "CONTA176", Family::Contact, NONE),
    row(177, "CONTA177", Family::Contact, NONE),
    row(200, "MESH200", Family::Drawn, NONE),
];

/// The element of a number.
pub(super) fn routine(number: u32) -> Option<&'static Routine> {
    ROUTINES.iter().find(|row| row.number == number)
}

/// A cell with its nodes by number.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cell {
    pub kind: CellKind,
    pub nodes: Vec<u64>,
    /// Whether the brick was turned: faces have other numbers then.
    pub turned: bool,
}

/// Nodes in the middles of edges that the file leaves out.
#[derive(Debug, Default)]
pub(super) struct Middles {
    /// By the ends of the edge.
    of: HashMap<(u64, u64), u64>,
    /// The nodes, with the ends of their edges.
    pub made: Vec<(u64, [u64; 2], Place)>,
    next: u64,
}

/// The ends of each edge of a brick whose middles are its nodes 8 to 19, and turns about two of its axes.
const EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
const TURNS: [[usize; 8]; 2] = [[1, 2, 3, 0, 5, 6, 7, 4], [1, 5, 6, 2, 0, 4, 7, 3]];

impl Middles {
    pub fn new(model: &Model) -> Middles {
        let next = model.nodes.keys().next_back().map_or(1, |last| last.saturating_add(1));
        Middles { next, ..Middles::default() }
    }

    fn node(&mut self, a: u64, b: u64, place: Place) -> u64 {
        let made = &mut self.made;
        let next = &mut self.next;
        *self.of.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let own = *next;
            *next = next.saturating_add(1);
            made.push((own, [a.min(b), a.max(b)], place));
            own
        })
    }

    /// The index of a node that was made, behind `n` others.
    pub fn index(&self, node: u64, n: usize) -> usize {
        n + self.made.binary_search_by_key(&node, |(own, ..)| *own).unwrap_or(0)
    }

    /// The equations that hold the nodes, which are at these indices.
    pub fn equations(&self, index: impl Fn(u64) -> Option<usize>, equations: &mut Vec<Equation>) {
        for (node, [a, b], place) in &self.made {
            let (Some(node), Some(a), Some(b)) = (index(*node), index(*a), index(*b)) else { continue };
            for dof in 0..3 {
                equations.push(Equation {
                    terms: vec![(node, dof, 2.0), (a, dof, -1.0), (b, dof, -1.0)],
                    place: *place,
                });
            }
        }
    }

    /// The nodes with their places.
    pub fn nodes<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = Node> + 'a {
        self.made.iter().filter_map(|(number, ends, place)| {
            let [a, b] = ends.map(|end| model.nodes.get(&end).map(|node| node.position));
            let (a, b) = (a?, b?);
            let position = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
            Some(Node { number: *number, position, place: *place })
        })
    }
}

/// The edges of an element between its corners, as the middles stand in the file.
fn edges(corners: usize, family: Family) -> &'static [[usize; 2]] {
    match (family, corners) {
        (Family::Solid, 8) => &EDGES,
        (Family::Solid, _) => &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
        (Family::Beam, _) => &[[0, 1]],
        _ => &[[0, 1], [1, 2], [2, 3], [3, 0]],
    }
}

/// The corners of an element in the file.
pub(super) fn corners(own: &Routine) -> usize {
    match own.family {
        Family::Solid if own.nodes_of[1] == "SOLID285" => 4,
        Family::Solid => 8,
        Family::Beam | Family::Link => 2,
        _ => 4,
    }
}

/// The cell of an element whose nodes stand so; none where they have no shape.
pub(super) fn cell(
    reader: &mut Reader<'_>,
    middles: &mut Middles,
    own: &Routine,
    nodes: &[u64],
    place: Place,
) -> Option<Cell> {
    let n = corners(own);
    // A triangle may be written as three nodes.
    let mut nodes = nodes.to_vec();
    if own.family == Family::Shell && nodes.len() >= 3 && nodes.get(3).is_none_or(|node| *node == 0) {
        nodes.truncate(3);
        nodes.push(nodes[2]);
    }
    let (first, rest) = nodes.split_at_checked(n)?;
    if first.contains(&0) {
        return None;
    }
    let [with, without] = own.nodes_of;
    let edges = edges(n, own.family);
    let given = |k: usize| rest.get(k).copied().unwrap_or(0);
    let is_middle = |k: usize| given(k) != 0 && !first.contains(&given(k));
    if with.is_empty() || !(0..edges.len()).any(is_middle) {
        if !with.is_empty() {
            let why = "without nodes in the middles of edges: the cell has none either";
            reader.note(Weight::Perhaps, own.name, why, place);
        }
        return shape(without, first, own.family);
    }
    let mut all = first.to_vec();
    let mut made = 0;
    for (k, [i, j]) in edges.iter().enumerate() {
        let (a, b) = (first[*i], first[*j]);
        // The same edge where the brick is collapsed.
        let twin = || {
            let same = |other: &[usize; 2]| {
                let (c, d) = (first[other[0]], first[other[1]]);
                (c, d) == (a, b) || (d, c) == (a, b)
            };
            (0..edges.len()).find(|other| same(&edges[*other]) && is_middle(*other)).map(given)
        };
        all.push(match given(k) {
            _ if a == b => a,
            0 => twin().unwrap_or_else(|| {
                made += 1;
                middles.node(a, b, place)
            }),
            node => node,
        });
    }
    if made > 0 {
        let why = "edges without a node in the middle: one is put there and held half way between the ends";
        reader.note(Weight::Nothing, own.name, why, place);
    }
    shape(with, &all, own.family)
}

/// The kind of these nodes, of bricks however they are turned.
fn shape(name: &'static str, nodes: &[u64], family: Family) -> Option<Cell> {
    // A brick fits the order of bricks whatever its nodes are; where some fall together it is one of fewer nodes, or none.
    let apart = |(_, nodes): &(CellKind, Vec<u64>)| {
        let mut sorted = nodes.clone();
        sorted.sort_unstable();
        sorted.windows(2).all(|pair| pair[0] != pair[1])
    };
    let known = |nodes: &[u64]| CellKind::of_file(Program::Ansys, name, nodes).filter(apart);
    if let Some((kind, nodes)) = known(nodes) {
        return Some(Cell { kind, nodes, turned: false });
    }
    if family != Family::Solid || nodes.len() < 8 {
        return None;
    }
    turns().iter().skip(1).find_map(|turn| {
        let (kind, nodes) = known(&turned_nodes(turn, nodes)?)?;
        Some(Cell { kind, nodes, turned: true })
    })
}

/// The 24 turns of a cube; the first one changes nothing.
fn turns() -> Vec<[usize; 8]> {
    let mut all: Vec<[usize; 8]> = vec![std::array::from_fn(|k| k)];
    let mut at = 0;
    while let Some(turn) = all.get(at).copied() {
        for step in TURNS {
            let next = step.map(|k| turn[k]);
            if !all.contains(&next) {
                all.push(next);
            }
        }
        at += 1;
    }
    all
}

/// The nodes of a brick whose corner k is the corner `turn[k]` of another order.
fn turned_nodes(turn: &[usize; 8], nodes: &[u64]) -> Option<Vec<u64>> {
    let mut all: Vec<u64> = turn.iter().map(|k| nodes[*k]).collect();
    if nodes.len() > 8 {
        for [i, j] in EDGES {
            let ends = [turn[i], turn[j]];
            let edge = EDGES.iter().position(|own| *own == ends || [own[1], own[0]] == ends)?;
            all.push(*nodes.get(8 + edge)?);
        }
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All turns keep the edges of a brick, and there are 24.
    #[test]
    fn all_turns_of_a_brick_are_tried() {
        let nodes: Vec<u64> = (1..21).collect();
        assert_eq!(turns().len(), 24);
        for turn in turns() {
            let turned = turned_nodes(&turn, &nodes).unwrap();
            let (mut sorted, [low, high]) = (turned.clone(), [4, 6].map(|k: usize| turned[k]));
            sorted.sort_unstable();
            assert_eq!(sorted, nodes);
            // Opposite corners of a face stay so.
            assert!(low != high);
        }
    }
}
