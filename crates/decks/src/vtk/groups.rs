//! Parts, surfaces and sets by the whole numbers of cells.

use super::cells::CellNumbers;
use crate::deck::{Deck, Element, Material, Place, Section, SectionShape, Set, Surface};
use crate::ledger::Weight;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Arrays that are known to number parts, the first first: of Gmsh, of results of stridor, of ParaView's readers, of MFEM and Medit.
const PARTS: [&str; 8] =
    ["gmsh:physical", "part", "PartId", "part_id", "MaterialIds", "CellEntityIds", "attribute", "medit:ref"];
/// An array with more different numbers than this numbers the cells themselves.
const MOST: usize = 1000;

/// Parts by the array that numbers them, sets by the other ones.
pub(super) fn sections(numbers: CellNumbers, deck: &mut Deck) {
    let CellNumbers { arrays, points } = numbers;
    let known =
        |name: &str| PARTS.iter().position(|own| own.eq_ignore_ascii_case(name)).unwrap_or(PARTS.len());
    let few = |(_, values): &(String, Vec<(usize, i64)>)| {
        let different: BTreeSet<i64> = values.iter().map(|(_, value)| *value).collect();
        different.len() <= MOST && (different.len() <= 8 || different.len() <= values.len() / 2)
    };
    let (groups, ids): (Vec<usize>, Vec<usize>) = (0..arrays.len()).partition(|k| few(&arrays[*k]));
    let place = deck.elements.first().map_or_else(Place::default, |element| element.place);
    for k in ids {
        let why = "numbers of the cells themselves: neither parts nor sets";
        deck.ledger.note(Weight::Nothing, format!("CellData {}", arrays[k].0), why, place);
    }
    let parts = groups.iter().copied().min_by_key(|k| (known(&arrays[*k].0), *k));
    let sides = Sides::of(&deck.elements);
    let mut by_part: BTreeMap<(Reverse<usize>, Option<i64>), Vec<usize>> = BTreeMap::new();
    let mut of: Vec<Option<i64>> = vec![None; deck.elements.len()];
    for (element, value) in parts.iter().flat_map(|k| &arrays[*k].1) {
        of[*element] = Some(*value);
    }
    for (element, value) in of.into_iter().enumerate() {
        let dimension = deck.elements[element].kind.dimension();
        by_part.entry((Reverse(dimension), value)).or_default().push(element);
    }
    for ((Reverse(dimension), value), elements) in by_part {
        let name = match (parts, value) {
            (Some(k), Some(value)) => name(&arrays[k].0, value),
            (Some(_), None) => "other".to_string(),
            (None, _) => "part".to_string(),
        };
        let rest = sides.named(&name, dimension, elements, deck);
        if !rest.is_empty() {
            section(name, dimension, rest, deck);
        }
    }
    let known: HashSet<Vec<usize>> = deck.sections.iter().map(|section| section.elements.clone()).collect();
    for k in groups.into_iter().filter(|k| Some(*k) != parts) {
        let mut by_value: BTreeMap<(i64, usize), Vec<usize>> = BTreeMap::new();
        for (element, value) in &arrays[k].1 {
            by_value.entry((*value, deck.elements[*element].kind.dimension())).or_default().push(*element);
        }
        for ((value, dimension), elements) in by_value {
            let name = name(&arrays[k].0, value);
            let members = sides.named(&name, dimension, elements, deck);
            if !members.is_empty() && !known.contains(&members) {
                deck.element_sets.push(Set { name, members, internal: false });
            }
        }
    }
    let mut nodes: BTreeMap<(usize, i64), Vec<usize>> = BTreeMap::new();
    points.into_iter().for_each(|(k, value, node)| nodes.entry((k, value)).or_default().push(node));
    for ((k, value), nodes) in nodes {
        node_set(name(&arrays[k].0, value), nodes, deck);
    }
    if !deck.sections.is_empty() {
        deck.ledger.note(Weight::Matters, "materials", "the file has none: give them in the case", place);
    }
}

/// `gmsh_physical_3`.
fn name(array: &str, value: i64) -> String {
    let clean = |c: char| if c.is_ascii_alphanumeric() || "_-".contains(c) { c } else { '_' };
    format!("{}_{value}", array.chars().map(clean).collect::<String>())
}

/// A part.
fn section(name: String, dimension: usize, elements: Vec<usize>, deck: &mut Deck) {
    let place = deck.elements[elements[0]].place;
    if dimension < 3 {
        let why = "the file has no thickness of shells, no cross-section of bars: give them in the case";
        deck.ledger.note(Weight::Matters, &name, why, place);
    }
    if deck.material(&name).is_none() {
        deck.materials.push(Material { name: name.clone(), ..Material::default() });
    }
    let (material, shape) = (name.clone(), SectionShape::Unstated);
    deck.sections.push(Section { name, elements, material, axes: None, shape, place });
}

fn node_set(name: String, mut members: Vec<usize>, deck: &mut Deck) {
    members.sort_unstable();
    members.dedup();
    deck.node_sets.push(Set { name, members, internal: false });
}

/// Which faces are sides of solids, and which lines edges of other cells: meshers write them with names for supports and contacts.
struct Sides {
    /// The side of each face.
    sides: HashMap<usize, (usize, usize)>,
    edges: HashSet<usize>,
}

impl Sides {
    fn of(elements: &[Element]) -> Self {
        let mut faces: HashMap<Vec<usize>, Vec<usize>> = HashMap::new();
        let mut lines: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
        for (index, element) in elements.iter().enumerate() {
            let corners = &element.nodes[..element.kind.n_corners()];
            match (element.kind.dimension(), corners) {
                (2, _) => faces.entry(ordered(corners.iter().copied())).or_default().push(index),
                (1, [a, b]) => lines.entry(edge([*a, *b])).or_default().push(index),
                _ => {}
            }
        }
        let mut own = Sides { sides: HashMap::new(), edges: HashSet::new() };
        for (index, element) in
            elements.iter().enumerate().filter(|(_, element)| element.kind.dimension() > 1)
        {
            for (side, (kind, nodes)) in element.kind.table().sides.iter().enumerate() {
                let corners =
                    || nodes[..kind.n_corners()].iter().map(|node| element.nodes[usize::from(*node)]);
                if element.kind.dimension() == 3 && !faces.is_empty() {
                    for face in faces.get(&ordered(corners())).into_iter().flatten() {
                        own.sides.entry(*face).or_insert((index, side));
                    }
                }
                if !lines.is_empty() {
                    for (a, b) in corners().zip(corners().cycle().skip(1)) {
                        own.edges.extend(lines.get(&edge([a, b])).into_iter().flatten());
                    }
                }
            }
        }
        own
    }

    /// Puts the elements that are sides or edges into the deck as a surface or a set of nodes; those that are neither are given back.
    fn named(&self, name: &str, dimension: usize, elements: Vec<usize>, deck: &mut Deck) -> Vec<usize> {
        let is_side = |element: &usize| self.sides.contains_key(element) || self.edges.contains(element);
        let (sides, rest): (Vec<usize>, Vec<usize>) = elements.into_iter().partition(is_side);
        if dimension == 2 && !sides.is_empty() {
            let mut faces: Vec<(usize, usize)> = sides.iter().map(|face| self.sides[face]).collect();
            faces.sort_unstable();
            faces.dedup();
            deck.surfaces.push(Surface { name: name.into(), faces, ..Surface::default() });
        } else if dimension == 1 && !sides.is_empty() {
            let place = deck.elements[sides[0]].place;
            let why = "lines along edges of other cells are a set of nodes, no bars";
            deck.ledger.note(Weight::Perhaps, name, why, place);
            let nodes = sides.iter().flat_map(|line| deck.elements[*line].nodes.clone()).collect();
            node_set(name.into(), nodes, deck);
        }
        rest
    }
}

fn edge([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

fn ordered(nodes: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut nodes: Vec<usize> = nodes.collect();
    nodes.sort_unstable();
    nodes
}
