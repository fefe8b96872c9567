//! Nodes and elements as listed in a file, before groups have names and nodes have places.

use super::bytes::{ByteReader, Encoding};
use super::names::Names;
use crate::{Cell, CellKind, Mesh, Region, with_line};
use std::collections::{BTreeMap, HashMap};
use stridor_base::error::{Error, Fault, Faults, Result};

/// Nodes and elements of a file.
#[derive(Debug, Default)]
pub(super) struct RawMesh {
    pub nodes: Vec<RawNode>,
    pub elements: Vec<RawElement>,
}

/// One node of a file.
#[derive(Debug)]
pub(super) struct RawNode {
    pub tag: u64,
    /// Coordinates, in the unit of the file.
    pub place: [f64; 3],
    /// Where it is in the file \[bytes\].
    pub offset: usize,
}

/// One element of a file.
#[derive(Debug)]
pub(super) struct RawElement {
    pub tag: u64,
    /// Gmsh's number of the element type.
    pub kind: i64,
    /// Tags of its nodes.
    pub nodes: Vec<u64>,
    /// Physical groups of the element's own dimension.
    pub groups: Vec<i64>,
    /// Where it is in the file \[bytes\].
    pub offset: usize,
}

/// The lines of a text file, so that what is there can be found; none of a binary one.
pub(super) struct LineNumbers(Option<Vec<usize>>);

/// The type of pyramids of 14 nodes.
const PYRAMID_14: i64 = 14;

impl LineNumbers {
    /// The lines of `bytes`.
    pub fn new(bytes: &[u8], encoding: Encoding) -> Self {
        let ends = || (0..bytes.len()).filter(|at| bytes[*at] == b'\n').collect();
        LineNumbers((encoding == Encoding::Ascii).then(ends))
    }

    /// The line, from 1, of what is at a byte.
    fn of(&self, offset: usize) -> Option<usize> {
        self.0.as_ref().map(|ends| 1 + ends.partition_point(|end| *end < offset))
    }
}

/// The numbers of the nodes of an element of Gmsh's type `kind`, each read by `tag`: as many as types 1 to 31 have; those up to
/// the end of the line for one of the many other types, all of higher order or solids.
pub(super) fn element_nodes(
    file: &mut ByteReader<'_>,
    kind: i64,
    tag: impl Fn(&mut ByteReader<'_>) -> Result<u64>,
) -> Result<Vec<u64>> {
    const NODES: [usize; 31] = [
        2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6, 20,
        35, 56,
    ];
    let index = usize::try_from(kind).unwrap_or(0).wrapping_sub(1);
    let mut nodes = Vec::new();
    match NODES.get(index) {
        Some(count) => {
            for _ in 0..*count {
                nodes.push(tag(file)?);
            }
        }
        None if file.encoding == Encoding::Ascii && kind > 0 => {
            while !file.at_line_end() {
                nodes.push(tag(file)?);
            }
        }
        None => {
            let found = format!("element type {kind}");
            return Err(file.wrong(found, "elements of first or second order"));
        }
    }
    Ok(nodes)
}

impl RawMesh {
    /// Names the groups, drops what belongs to none, finds the nodes, and turns to metres.
    pub fn into_mesh(
        mut self,
        names: &Names,
        (place, lines): (&str, &LineNumbers),
        unit_in_metres: f64,
    ) -> Result<Mesh> {
        if names.is_empty() {
            let fault =
                Fault::new(place, "no named physical group", "parts marked by physical groups with names");
            return Err(Error::input(fault.with_help(
                "In the .geo file: `Physical Surface(\"disc\") = {1};`, `Physical Curve(\"rim\") = {1, 2};`, then mesh again",
            )));
        }
        let mut faults = Faults::new();
        self.elements.retain(|e| !e.groups.is_empty());
        self.refuse_kinds(place, &mut faults);
        self.elements.sort_by_key(|e| e.tag);
        self.nodes.sort_by_key(|n| n.tag);
        for (what, twice) in [
            ("node", self.nodes.windows(2).find(|w| w[0].tag == w[1].tag).map(|w| (w[0].tag, w[1].offset))),
            // MSH 2.2 may list an element once for each of its groups, with a tag of its own or the same one.
            (
                "element",
                self.elements
                    .windows(2)
                    .find(|w| w[0].tag == w[1].tag && w[0].nodes != w[1].nodes)
                    .map(|w| (w[0].tag, w[1].offset)),
            ),
        ] {
            if let Some((tag, offset)) = twice {
                faults.push(Fault::new(
                    format!("{place}: {what} {}", with_line(tag, lines.of(offset).as_ref())),
                    "its number twice",
                    "each number once",
                ));
            }
        }
        if self.elements.is_empty() {
            faults.push(Fault::new(
                place,
                "no element in any physical group",
                "elements of named physical groups",
            ));
        }
        faults.into_result(())?;
        self.assemble(names, (place, lines), unit_in_metres)
    }

    /// A fault where there are kinds that are not known: of third and higher order.
    fn refuse_kinds(&self, place: &str, faults: &mut Faults) {
        let mut counts: BTreeMap<i64, usize> = BTreeMap::new();
        for e in self.elements.iter().filter(|e| CellKind::of_gmsh(e.kind).is_none()) {
            *counts.entry(e.kind).or_default() += 1;
        }
        if counts.is_empty() {
            return;
        }
        let listed: Vec<String> =
            counts.iter().map(|(kind, count)| format!("{count} of type {kind}")).collect();
        let pyramids = counts.contains_key(&PYRAMID_14);
        let what = if pyramids { "14-node pyramids or elements" } else { "elements" };
        let found = format!("{what} of third or higher order ({})", listed.join(", "));
        let fault = Fault::new(place, found, "elements of first or second order");
        // 14-node pyramids have a node in the middle of their base.
        let help = match pyramids {
            true => "Mesh again with 13-node pyramids: in Gmsh `Mesh.SecondOrderIncomplete = 1;`",
            false => "Mesh again with second order: `gmsh -3 -order 2 model.geo -o model.msh`",
        };
        faults.push(fault.with_help(help));
    }

    fn assemble(
        self,
        names: &Names,
        (place, lines): (&str, &LineNumbers),
        unit_in_metres: f64,
    ) -> Result<Mesh> {
        let mut mesh = Mesh::default();
        let known: HashMap<u64, usize> = self.nodes.iter().enumerate().map(|(i, n)| (n.tag, i)).collect();
        let mut used = vec![false; self.nodes.len()];
        let mut lost = Vec::new();
        for e in &self.elements {
            for tag in &e.nodes {
                match known.get(tag) {
                    Some(i) => used[*i] = true,
                    None => lost.push((e, *tag)),
                }
            }
        }
        if let Some((element, node)) = lost.first() {
            let found = format!("node {node}, which the file does not hold ({} cases)", lost.len());
            return Err(Error::input(Fault::new(
                format!("{place}: element {}", with_line(element.tag, lines.of(element.offset).as_ref())),
                found,
                "nodes of the file",
            )));
        }
        let mut place_of = vec![0; self.nodes.len()];
        for (i, RawNode { tag, place, offset }) in self.nodes.iter().enumerate() {
            if used[i] {
                place_of[i] = mesh.nodes.len();
                mesh.nodes.push(place.map(|c| c * unit_in_metres));
                mesh.origin.node_lines.extend(lines.of(*offset));
                mesh.origin.node_tags.push(*tag);
            } else {
                mesh.origin.unused_nodes.push(*tag);
            }
        }
        let mut regions = RegionList::new(names);
        // Element and regions by nodes.
        let mut listed: HashMap<(i64, Vec<usize>), (usize, Vec<usize>)> = HashMap::new();
        for RawElement { tag, kind, nodes, groups, offset } in self.elements {
            let n: Vec<usize> = nodes.iter().map(|tag| place_of[known[tag]]).collect();
            let Some(known_kind) = CellKind::of_gmsh(kind) else { continue };
            let own = known_kind.table().gmsh.order.from_file(&n);
            let Some(element) = own.and_then(|own| Cell::new(known_kind, &own)) else { continue };
            let dimension = element.dimension();
            let of: Vec<usize> = groups.into_iter().map(|group| regions.index(dimension, group)).collect();
            // MSH 2.2 lists an element once more for every further group; twice in one group is a fault, found later.
            let listed = listed.entry((kind, n)).or_insert_with(|| (usize::MAX, vec![]));
            if listed.0 == usize::MAX || of.iter().any(|region| listed.1.contains(region)) {
                *listed = (mesh.elements.len(), vec![]);
                mesh.elements.push(element);
                mesh.origin.element_tags.push(tag);
                mesh.origin.element_lines.extend(lines.of(offset));
            }
            for region in of {
                if !listed.1.contains(&region) {
                    listed.1.push(region);
                    regions.all[region].elements.push(listed.0);
                }
            }
        }
        mesh.regions = regions.with_elements();
        Ok(mesh)
    }
}

/// Regions by dimension and number.
struct RegionList {
    all: Vec<Region>,
    of: HashMap<(usize, i64), usize>,
}

impl RegionList {
    /// Those that have names; two numbers with one name and dimension are one region.
    fn new(names: &Names) -> Self {
        let mut list = RegionList { all: Vec::new(), of: HashMap::new() };
        for ((dimension, number), name) in names {
            let same = list.all.iter().position(|r| r.name == *name && r.dimension == *dimension);
            let index = same.unwrap_or_else(|| {
                list.all.push(Region { name: name.clone(), dimension: *dimension, elements: vec![] });
                list.all.len() - 1
            });
            list.of.insert((*dimension, *number), index);
        }
        list
    }

    /// The place of a region, which is made where there is none: `surface 7`.
    fn index(&mut self, dimension: usize, number: i64) -> usize {
        let RegionList { all, of } = self;
        *of.entry((dimension, number)).or_insert_with(|| {
            let name = format!("{} {number}", ["point", "curve", "surface", "volume"][dimension]);
            all.push(Region { name, dimension, elements: vec![] });
            all.len() - 1
        })
    }

    /// The regions that have elements, those ascending.
    fn with_elements(mut self) -> Vec<Region> {
        self.all.iter_mut().for_each(|region| region.elements.sort_unstable());
        self.all.retain(|region| !region.elements.is_empty());
        self.all
    }
}
