//! MSH 4.1: entities with their physical groups, then nodes and elements in blocks of one entity each.
//!
//! Every number that a count announces must be there, each node and element in a line of its own; faults name the line.

use super::bytes::{ByteReader, Encoding};
use super::raw::{RawElement, RawMesh, RawNode, element_nodes};
use std::collections::HashMap;
use stridor_base::error::{Error, Fault, Result};

/// Physical groups of the entities, by dimension and tag.
type Entities = HashMap<(i64, i64), Vec<i64>>;

/// Elements of one entity: its dimension and tag, where they are in the file, and which of all elements they are.
struct EntityBlock {
    entity: (i64, i64),
    position: String,
    elements: std::ops::Range<usize>,
}

/// Reads the whole file.
///
/// # Errors
/// Input: a number too few or too many, a count that the file does not hold, an entity that is missing or there twice.
pub(super) fn parse(mut file: ByteReader<'_>) -> Result<RawMesh> {
    let (mut entities, mut blocks) = (None, None);
    let mut nodes = false;
    let mut raw = RawMesh::default();
    loop {
        let section = file.section();
        let again = match section {
            "$Entities" => entities.is_some(),
            "$Nodes" => nodes,
            "$Elements" => blocks.is_some(),
            _ => false,
        };
        if again {
            return Err(file.wrong(format!("`{section}` again"), "each section once"));
        }
        match section {
            "" => break,
            "$Entities" => entities = Some(read_entities(&mut file)?),
            "$Nodes" => {
                read_nodes(&mut file, &mut raw)?;
                nodes = true;
            }
            "$Elements" => blocks = Some(read_elements(&mut file, &mut raw)?),
            "$PartitionedEntities" => {
                return Err(file.wrong("a mesh in partitions", "a whole mesh: `gmsh -part 0`"));
            }
            other => file.skip_section(other.trim_start_matches('$'))?,
        }
    }
    if !nodes {
        return Err(file.wrong("the end of the file", "`$Nodes`: the file holds none or is cut off"));
    }
    let Some(blocks) = blocks else {
        return Err(file.wrong("the end of the file", "`$Elements`: the file holds none or is cut off"));
    };
    let Some(entities) = entities else { return Ok(raw) };
    for EntityBlock { entity: (dimension, tag), position, elements } in blocks {
        let Some(groups) = entities.get(&(dimension, tag)) else {
            let found = format!("elements of entity {tag} of dimension {dimension}, which $Entities lacks");
            return Err(Error::input(Fault::new(position, found, "entities of the file")));
        };
        raw.elements[elements].iter_mut().for_each(|element| element.groups.clone_from(groups));
    }
    Ok(raw)
}

/// A count, bounded by what the rest of the file can hold.
fn count(file: &mut ByteReader<'_>, what: &str) -> Result<usize> {
    let count = file.size(what)?;
    if count > file.left() as u64 {
        return Err(file.wrong(format!("{what} {count}"), "a count that the rest of the file can hold"));
    }
    Ok(count as usize)
}

/// Goes to the first number of a section.
fn enter(file: &mut ByteReader<'_>) {
    if file.encoding != Encoding::Ascii {
        file.end_line();
    }
}

/// Points with three coordinates; curves, surfaces and volumes with a box and what bounds them.
fn read_entities(file: &mut ByteReader<'_>) -> Result<Entities> {
    enter(file);
    let mut entities = Entities::new();
    let mut counts = [0; 4];
    for (count, what) in counts.iter_mut().zip(["points", "curves", "surfaces", "volumes"]) {
        *count = self::count(file, &format!("number of {what}"))?;
    }
    for (dimension, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let tag = file.int("entity's tag")?;
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                file.float("entity's coordinate")?;
            }
            let mut groups = Vec::new();
            for _ in 0..self::count(file, "number of physical groups")? {
                // A negative group denotes the reversed side of a surface.
                groups.push(file.int("physical group")?.saturating_abs());
            }
            if dimension > 0 {
                for _ in 0..self::count(file, "number of bounding entities")? {
                    file.int("bounding entity")?;
                }
            }
            if entities.insert((dimension as i64, tag), groups).is_some() {
                let found = format!("entity {tag} of dimension {dimension} again");
                return Err(file.wrong(found, "each entity once"));
            }
        }
    }
    file.expect("$EndEntities")?;
    Ok(entities)
}

/// The head of a section of blocks: how many blocks and how many things in all; the smallest and largest tag are of no use.
fn head(file: &mut ByteReader<'_>, what: &str) -> Result<[usize; 2]> {
    enter(file);
    let counts = [count(file, "number of blocks")?, count(file, &format!("number of {what}"))?];
    file.size("smallest tag")?;
    file.size("largest tag")?;
    Ok(counts)
}

/// Fails where the blocks of a section hold another number of things than its head says.
fn check_total(file: &ByteReader<'_>, what: &str, found: usize, said: usize) -> Result<()> {
    if found == said {
        return Ok(());
    }
    Err(file.wrong(format!("{found} {what}"), format!("{said}, as stated in the head of the section")))
}

/// Blocks of nodes: all numbers, then all coordinates, which a parametric block follows by those on its curve or surface.
fn read_nodes(file: &mut ByteReader<'_>, raw: &mut RawMesh) -> Result<()> {
    let [blocks, total] = head(file, "nodes")?;
    for _ in 0..blocks {
        let dimension = file.int("entity's dimension")?;
        file.int("entity's tag")?;
        let parametric = match (file.int("mark of parametric coordinates")?, dimension) {
            (0, 0..=3) => 0,
            (1, 0..=3) => dimension,
            (mark, _) => {
                let found = format!("dimension {dimension} with mark {mark} of parametric coordinates");
                return Err(file.wrong(found, "a dimension of 0 to 3, a mark of 0 or 1"));
            }
        };
        let count = count(file, "number of nodes in the block")?;
        let first = raw.nodes.len();
        for _ in 0..count {
            let tag = tag(file, "node number")?;
            raw.nodes.push(RawNode { tag, place: [0.0; 3], offset: file.offset() });
            file.line_is_over("a node's number")?;
        }
        for node in &mut raw.nodes[first..] {
            node.place = [file.float("node's x")?, file.float("node's y")?, file.float("node's z")?];
            for _ in 0..parametric {
                file.float("node's parametric coordinate")?;
            }
            file.line_is_over("a node")?;
        }
    }
    check_total(file, "nodes", raw.nodes.len(), total)?;
    file.expect("$EndNodes")
}

/// Blocks of elements of one entity and one type.
fn read_elements(file: &mut ByteReader<'_>, raw: &mut RawMesh) -> Result<Vec<EntityBlock>> {
    let [n_blocks, total] = head(file, "elements")?;
    let mut blocks = Vec::new();
    for _ in 0..n_blocks {
        let entity = (file.int("entity's dimension")?, file.int("entity's tag")?);
        let kind = file.int("element type")?;
        let position = file.place();
        let count = count(file, "number of elements in the block")?;
        let first = raw.elements.len();
        for _ in 0..count {
            let tag = tag(file, "element number")?;
            let offset = file.offset();
            let nodes = element_nodes(file, kind, |file| self::tag(file, "node number"))?;
            file.line_is_over("an element")?;
            raw.elements.push(RawElement { tag, kind, nodes, groups: Vec::new(), offset });
        }
        blocks.push(EntityBlock { entity, position, elements: first..raw.elements.len() });
    }
    check_total(file, "elements", raw.elements.len(), total)?;
    file.expect("$EndElements")?;
    Ok(blocks)
}

fn tag(file: &mut ByteReader<'_>, what: &str) -> Result<u64> {
    match file.size(what)? {
        0 => Err(file.wrong(format!("{what} 0"), "a positive number")),
        tag => Ok(tag),
    }
}
