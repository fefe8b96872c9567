//! MSH 4.1, parsed by the crate mshio: entities with their physical groups, then nodes and elements in blocks of one entity each.
//!
//! mshio reads on where a line is missing or two numbers touch, allocates what a count announces, and refuses much that Gmsh
//! takes: parametric nodes, text between sections, numbers such as `1.D+02`. So [`Walk`] goes through the file first, number by
//! number: every number that a count announces must be there, each node and element in a line of its own; faults name the
//! line. It writes what it read in the form that mshio takes.

use super::bytes::{ByteReader, Encoding};
use super::raw::{RawElement, RawMesh, RawNode, element_nodes};
use crate::CellKind;
use std::collections::{HashMap, HashSet};
use stridor_base::error::{Error, Fault, Result};

/// Of this kind mshio 0.4 has no number of nodes.
const UNKNOWN_TO_MSHIO: CellKind = CellKind::Wedge18;

/// Dimension and tag of an entity.
type Entity = (i64, i64);

/// Reads the whole file.
///
/// # Errors
/// Input: a number too few or too many, a count that the file does not hold, an entity that is missing or there twice.
pub(super) fn parse(file: ByteReader<'_>) -> Result<RawMesh> {
    let mut walk = Walk { file, plain: HEADER.to_vec(), nodes: vec![], elements: vec![], others: vec![] };
    walk.sections()?;
    let data = match mshio::parse_msh_bytes(&walk.plain) {
        Ok(file) => file.data,
        Err(error) => return Err(walk.file.wrong(format!("what mshio refuses: {error}"), "MSH 4.1")),
    };
    let mut groups: HashMap<Entity, Vec<i64>> = HashMap::new();
    let mut note = |dimension: i64, tag: i32, physical: Vec<i32>| {
        // A negative group denotes the reversed side of a surface.
        groups.insert((dimension, tag.into()), physical.into_iter().map(|p| i64::from(p).abs()).collect());
    };
    if let Some(entities) = data.entities {
        entities.points.into_iter().for_each(|e| note(0, e.tag, e.physical_tags));
        entities.curves.into_iter().for_each(|e| note(1, e.tag, e.physical_tags));
        entities.surfaces.into_iter().for_each(|e| note(2, e.tag, e.physical_tags));
        entities.volumes.into_iter().for_each(|e| note(3, e.tag, e.physical_tags));
    }
    let groups = |entity: Entity| groups.get(&entity).cloned().unwrap_or_default();
    let nodes = data.nodes.into_iter().flat_map(|nodes| nodes.node_blocks).flat_map(|block| block.nodes);
    let nodes = walk.nodes.into_iter().zip(nodes);
    let nodes = nodes.map(|((tag, offset), n)| RawNode { tag, place: [n.x, n.y, n.z], offset }).collect();
    let mut elements = Vec::new();
    let mut offsets = walk.elements.into_iter();
    for block in data.elements.into_iter().flat_map(|elements| elements.element_blocks) {
        let kind = block.element_type as i64;
        let groups = groups((block.entity_dim.into(), block.entity_tag.into()));
        elements.extend(block.elements.into_iter().zip(&mut offsets).map(|(e, offset)| RawElement {
            tag: e.element_tag,
            kind,
            nodes: e.nodes,
            groups: groups.clone(),
            offset,
        }));
    }
    let others = walk.others.into_iter();
    elements.extend(others.map(|(entity, element)| RawElement { groups: groups(entity), ..element }));
    Ok(RawMesh { nodes, elements })
}

/// How a binary file begins, lowest byte first.
const HEADER: &[u8] = b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n";

/// Goes through a file.
struct Walk<'a> {
    file: ByteReader<'a>,
    /// The file as mshio takes it: binary, nothing but entities, nodes, and elements of the types of a mesh.
    plain: Vec<u8>,
    /// Tags of the nodes, which mshio keeps only where they leave gaps, and where they are in the file \[bytes\].
    nodes: Vec<(u64, usize)>,
    /// Where the elements in `plain` are in the file \[bytes\].
    elements: Vec<usize>,
    /// Elements of types that are not in `plain`, with their entities: of many types mshio knows no number of nodes.
    others: Vec<(Entity, RawElement)>,
}

impl Walk<'_> {
    fn sections(&mut self) -> Result<()> {
        let (mut entities, mut blocks) = (None, None);
        let mut nodes = false;
        loop {
            let section = self.file.section();
            let again = match section {
                "$Entities" => entities.is_some(),
                "$Nodes" => nodes,
                "$Elements" => blocks.is_some(),
                _ => false,
            };
            if again {
                return Err(self.file.wrong(format!("`{section}` again"), "each section once"));
            }
            match section {
                "" => break,
                "$Entities" => entities = Some(self.entities()?),
                "$Nodes" => {
                    self.nodes()?;
                    nodes = true;
                }
                "$Elements" => blocks = Some(self.elements()?),
                "$PartitionedEntities" => {
                    return Err(self.file.wrong("a mesh in partitions", "a whole mesh: `gmsh -part 0`"));
                }
                other => self.file.skip_section(other.trim_start_matches('$'))?,
            }
        }
        let missing = |what| {
            self.file.wrong("the end of the file", format!("`{what}`: the file holds none or is cut off"))
        };
        if !nodes {
            return Err(missing("$Nodes"));
        }
        let blocks = blocks.ok_or_else(|| missing("$Elements"))?;
        let Some(entities) = entities else { return Ok(()) };
        match blocks.into_iter().find(|(entity, _)| !entities.contains(entity)) {
            None => Ok(()),
            Some(((dimension, tag), position)) => {
                let found =
                    format!("elements of entity {tag} of dimension {dimension}, which $Entities lacks");
                Err(Error::input(Fault::new(position, found, "entities of the file")))
            }
        }
    }

    /// A section of the file, and its name in `plain`.
    fn enter(&mut self, name: &str) {
        if self.file.encoding != Encoding::Ascii {
            self.file.end_line();
        }
        self.plain.extend(format!("\n${name}\n").bytes());
    }

    fn leave(&mut self, name: &str) -> Result<()> {
        self.plain.extend(format!("\n$End{name}\n").bytes());
        self.file.expect(&format!("$End{name}"))
    }

    /// An integer of 32 bits.
    fn int(&mut self, what: &str) -> Result<i64> {
        let number = self.file.int(what)?;
        let Ok(short) = i32::try_from(number) else {
            return Err(self.file.wrong(format!("{what} {number}"), "an integer of 32 bits"));
        };
        self.plain.extend(short.to_le_bytes());
        Ok(number)
    }

    fn size(&mut self, number: u64) {
        self.plain.extend(number.to_le_bytes());
    }

    fn float(&mut self, what: &str) -> Result<()> {
        let number = self.file.float(what)?;
        self.plain.extend(number.to_le_bytes());
        Ok(())
    }

    /// A count, bounded by what the rest of the file can hold.
    fn count(&mut self, what: &str) -> Result<usize> {
        let count = self.file.size(what)?;
        if count > self.file.left() as u64 {
            return Err(self
                .file
                .wrong(format!("{what} {count}"), "a count that the rest of the file can hold"));
        }
        self.size(count);
        Ok(count as usize)
    }

    /// A positive number.
    fn tag(&mut self, what: &str) -> Result<u64> {
        let tag = tag(&mut self.file, what)?;
        self.size(tag);
        Ok(tag)
    }

    /// Points with three coordinates; curves, surfaces and volumes with a box and what bounds them.
    fn entities(&mut self) -> Result<HashSet<Entity>> {
        self.enter("Entities");
        let mut entities = HashSet::new();
        let mut counts = [0; 4];
        for (count, what) in counts.iter_mut().zip(["points", "curves", "surfaces", "volumes"]) {
            *count = self.count(&format!("number of {what}"))?;
        }
        for (dimension, count) in counts.into_iter().enumerate() {
            for _ in 0..count {
                let tag = self.int("entity's tag")?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    self.float("entity's coordinate")?;
                }
                for _ in 0..self.count("number of physical groups")? {
                    self.int("physical group")?;
                }
                if dimension > 0 {
                    for _ in 0..self.count("number of bounding entities")? {
                        self.int("bounding entity")?;
                    }
                }
                if !entities.insert((dimension as i64, tag)) {
                    let found = format!("entity {tag} of dimension {dimension} again");
                    return Err(self.file.wrong(found, "each entity once"));
                }
            }
        }
        self.leave("Entities")?;
        Ok(entities)
    }

    /// The head of a section of blocks: how many blocks and how many things in all. The smallest and largest tag are of no
    /// use; those written make mshio see no gaps, so that it builds no table of tags.
    fn head(&mut self, name: &str, what: &str) -> Result<[usize; 2]> {
        self.enter(name);
        let blocks = self.count("number of blocks")?;
        let total = self.count(&format!("number of {what}"))?;
        for (bound, written) in [("smallest tag", 1), ("largest tag", total.max(1) as u64)] {
            self.file.size(bound)?;
            self.size(written);
        }
        Ok([blocks, total])
    }

    /// Fails where the blocks of a section hold another number of things than its head says.
    fn check_total(&self, what: &str, found: usize, said: usize) -> Result<()> {
        if found == said {
            return Ok(());
        }
        Err(self
            .file
            .wrong(format!("{found} {what}"), format!("{said}, as stated in the head of the section")))
    }

    /// Blocks of nodes: all numbers, then all coordinates, which a parametric block follows by those on its curve or surface.
    fn nodes(&mut self) -> Result<()> {
        let [blocks, total] = self.head("Nodes", "nodes")?;
        for _ in 0..blocks {
            let dimension = self.int("entity's dimension")?;
            self.int("entity's tag")?;
            let parametric = match (self.file.int("mark of parametric coordinates")?, dimension) {
                (0, 0..=3) => 0,
                (1, 0..=3) => dimension,
                (mark, _) => {
                    let found = format!("dimension {dimension} with mark {mark} of parametric coordinates");
                    return Err(self.file.wrong(found, "a dimension of 0 to 3, a mark of 0 or 1"));
                }
            };
            self.plain.extend(0i32.to_le_bytes());
            let count = self.count("number of nodes in the block")?;
            for _ in 0..count {
                let tag = self.tag("node number")?;
                self.nodes.push((tag, self.file.offset()));
                self.file.line_is_over("a node's number")?;
            }
            for _ in 0..count {
                for what in ["node's x", "node's y", "node's z"] {
                    self.float(what)?;
                }
                for _ in 0..parametric {
                    self.file.float("node's parametric coordinate")?;
                }
                self.file.line_is_over("a node")?;
            }
        }
        self.check_total("nodes", self.nodes.len(), total)?;
        self.leave("Nodes")
    }

    /// Blocks of elements of one entity and one type. Gives the entities and where their blocks are.
    fn elements(&mut self) -> Result<Vec<(Entity, String)>> {
        let [n_blocks, total] = self.head("Elements", "elements")?;
        let mut blocks = Vec::new();
        for _ in 0..n_blocks {
            let entity = (self.int("entity's dimension")?, self.int("entity's tag")?);
            let kind = self.int("element type")?;
            let position = self.file.place();
            let known = CellKind::of_gmsh(kind).is_some_and(|kind| kind != UNKNOWN_TO_MSHIO);
            let start = self.plain.len();
            for _ in 0..self.count("number of elements in the block")? {
                let tag = self.tag("element number")?;
                let offset = self.file.offset();
                let nodes = element_nodes(&mut self.file, kind, |file| self::tag(file, "node number"))?;
                self.file.line_is_over("an element")?;
                if known {
                    nodes.iter().for_each(|node| self.size(*node));
                    self.elements.push(offset);
                } else {
                    self.others.push((entity, RawElement { tag, kind, nodes, groups: vec![], offset }));
                }
            }
            if !known {
                // A block of no points in its place.
                self.plain.truncate(start - 4);
                self.plain.extend(15i32.to_le_bytes());
                self.size(0);
            }
            blocks.push((entity, position));
        }
        self.check_total("elements", self.elements.len() + self.others.len(), total)?;
        self.leave("Elements")?;
        Ok(blocks)
    }
}

fn tag(file: &mut ByteReader<'_>, what: &str) -> Result<u64> {
    match file.size(what)? {
        0 => Err(file.wrong(format!("{what} 0"), "a positive number")),
        tag => Ok(tag),
    }
}
