//! Elements: datasets 780 and 2412.

use crate::deck::{Deck, Element, Place};
use crate::ledger::Weight;
use crate::text::Files;
use std::collections::BTreeMap;
use stridor_base::error::{Error, Result};
use stridor_base::universal::Dataset;
use stridor_base::universal::record::{columns, whole};
use stridor_mesh::CellKind;

/// FE descriptors of rods and beams, which have a line of their own.
const BEAMS: [i64; 5] = [11, 21, 22, 23, 24];
/// Descriptors of plane stress, plane strain, axial symmetry, plates and membranes that have the nodes of a thin shell.
const AS_SHELL: &[(&[i64], i64)] = &[
    (&[11, 22], 21),
    (&[23], 24),
    (&[41, 51, 61, 74, 81], 91),
    (&[42, 52, 62, 72, 82], 92),
    (&[44, 54, 64, 71, 84], 94),
    (&[45, 55, 65, 75, 85], 95),
];

/// The elements of a file, their nodes by number.
#[derive(Debug, Default)]
pub(super) struct Elements(Vec<Record>);

#[derive(Debug)]
struct Record {
    label: u64,
    descriptor: i64,
    table: i64,
    material: i64,
    nodes: Box<[u64]>,
    place: Place,
}

/// Numbers of what elements are made of, and the dimension of their cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Property {
    /// The table of the physical property.
    pub table: i64,
    /// The table of the material.
    pub material: i64,
    /// 1 lines, 2 faces, 3 solids.
    pub dimension: usize,
}

impl Elements {
    /// Reads a dataset of elements.
    pub fn read(&mut self, dataset: &Dataset<'_>, file: u32, faults: &mut impl FnMut(Error)) {
        let mut index = 0;
        while index < dataset.lines.len() {
            if dataset.lines[index].text.trim().is_empty() {
                index += 1;
                continue;
            }
            match element(dataset, &mut index, file) {
                Ok(element) => self.0.push(element),
                Err(error) => {
                    faults(error);
                    index += 1;
                }
            }
        }
    }

    /// Cells with their nodes, and what they are made of.
    pub fn finish(mut self, deck: &mut Deck, files: &mut Files) -> BTreeMap<Property, (Vec<usize>, Place)> {
        self.0.sort_by_key(|element| (element.label, element.place));
        let mut names: BTreeMap<i64, u32> = BTreeMap::new();
        let mut properties: BTreeMap<Property, (Vec<usize>, Place)> = BTreeMap::new();
        let mut last: Option<&Record> = None;
        for own in &self.0 {
            if let Some(before) = last.filter(|before| before.label == own.label) {
                if (before.descriptor, &before.nodes) == (own.descriptor, &own.nodes) {
                    let why = "the same nodes again";
                    deck.ledger.note(Weight::Nothing, "elements that stand twice", why, own.place);
                } else {
                    let found =
                        format!("element {}, which is another one in line {}", own.label, before.place.line);
                    files.fault(own.place, found, "each element once");
                }
                continue;
            }
            last = Some(own);
            let nodes: Option<Vec<usize>> = own.nodes.iter().map(|node| index_of(deck, *node)).collect();
            let Some(nodes) = nodes else {
                let missing = own.nodes.iter().find(|node| index_of(deck, **node).is_none());
                let found =
                    format!("element {} on node {}, which is not there", own.label, missing.unwrap_or(&0));
                files.fault(own.place, found, "nodes of the file");
                continue;
            };
            let Some((kind, nodes)) = cell(own.descriptor, &nodes) else {
                let what = format!("FE descriptor {} of {} nodes", own.descriptor, nodes.len());
                deck.ledger.note(Weight::Matters, what, "elements that are not read", own.place);
                continue;
            };
            let type_name = *names.entry(own.descriptor).or_insert_with(|| {
                deck.type_names.push(format!("FE descriptor {}", own.descriptor));
                deck.type_names.len() as u32 - 1
            });
            let (table, material, dimension) = (own.table, own.material, kind.dimension());
            let property = properties.entry(Property { table, material, dimension });
            property.or_insert((Vec::new(), own.place)).0.push(deck.elements.len());
            deck.elements.push(Element { number: own.label, kind, type_name, nodes, place: own.place });
        }
        properties
    }
}

/// The index of a node.
fn index_of(deck: &Deck, node: u64) -> Option<usize> {
    deck.nodes.binary_search_by_key(&node, |own| own.number).ok()
}

/// The kind of a descriptor with these nodes, and the nodes in its order.
fn cell(descriptor: i64, nodes: &[usize]) -> Option<(CellKind, Vec<usize>)> {
    let same = AS_SHELL.iter().find(|(all, _)| all.contains(&descriptor));
    let descriptor = same.map_or(descriptor, |(_, own)| *own);
    CellKind::all()
        .filter_map(|kind| {
            let own = kind.table().universal.filter(|own| i64::from(own.number) == descriptor)?;
            let nodes = own.order.from_file(nodes)?;
            (nodes.len() == kind.n_nodes()).then_some((kind, nodes))
        })
        .min_by_key(|(_, nodes)| nodes.len())
}

/// The element at a line; `index` is then that of the line after it.
fn element(dataset: &Dataset<'_>, index: &mut usize, file: u32) -> Result<Record> {
    let first = *index;
    let (label, descriptor, table, material, count) = if dataset.kind == 780 {
        let [label, descriptor, _, table, _, material, _, count] = dataset.wholes(first, [10; 8])?;
        (label, descriptor, table, material, count)
    } else {
        let [label, descriptor, table, material, _, count] = dataset.wholes(first, [10; 6])?;
        (label, descriptor, table, material, count)
    };
    let place = Place { file, line: dataset.lines[first].number as u32 };
    let mut next = first + 1 + usize::from(BEAMS.contains(&descriptor));
    let count = usize::try_from(count).ok().filter(|count| (1..=100).contains(count));
    let count = count
        .ok_or_else(|| dataset.fault(first, "an element without a number of nodes", "1 to 100 nodes"))?;
    let mut nodes = Vec::new();
    while nodes.len() < count {
        let text = dataset.line(next)?;
        let words: Vec<String> = match text.split_whitespace().count() {
            n if n == (count - nodes.len()).min(8) => text.split_whitespace().map(str::to_string).collect(),
            _ => columns(text, &[10; 8]).into_iter().filter(|field| !field.is_empty()).collect(),
        };
        if words.is_empty() {
            return Err(dataset.fault(next, "no nodes", format!("{count} nodes of element {label}")));
        }
        for word in words {
            let node = whole(&word).and_then(|node| u64::try_from(node).ok()).filter(|node| *node > 0);
            nodes.push(node.ok_or_else(|| dataset.fault(next, format!("`{word}`"), "the number of a node"))?);
        }
        next += 1;
    }
    if nodes.len() != count {
        let found = format!("{} nodes of element {label}", nodes.len());
        return Err(dataset.fault(first, found, format!("{count} nodes, as it states")));
    }
    let number = u64::try_from(label).ok().filter(|label| *label > 0);
    let label = number.ok_or_else(|| {
        dataset.fault(first, format!("element {label}"), "a number of an element above zero")
    })?;
    *index = next;
    Ok(Record { label, descriptor, table, material, nodes: nodes.into(), place })
}
