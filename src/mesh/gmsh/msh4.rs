//! MSH 4.1: entities that carry physical groups, then nodes and elements in blocks, one block an entity.
//!
//! Text is read number by number between white space, so that a number too few or too many, wherever it is, ends in a fault
//! at the end of its section.

use super::bytes::{Encoding, Reader};
use super::raw::{RawElement, RawMesh, n_nodes};
use crate::error::{Error, Fault, Result};
use std::collections::HashMap;

/// Physical groups by the dimension and the tag of an entity.
type Entities = HashMap<(i64, i64), Vec<i64>>;

/// Elements of one entity: its dimension and tag, and where they stand in the mesh.
struct Block {
    entity: (i64, i64),
    elements: std::ops::Range<usize>,
    /// Where the block is in the file.
    position: String,
}

/// Reads what follows the header's line.
pub(super) fn parse(mut file: Reader<'_>) -> Result<RawMesh> {
    file.skip_section("MeshFormat")?;
    let mut raw = RawMesh::default();
    let (mut entities, mut blocks) = (None, None);
    let mut nodes = false;
    loop {
        let section = file.word();
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
            other => match other.strip_prefix('$') {
                Some(name) if !name.is_empty() && name.chars().all(char::is_alphanumeric) => {
                    file.skip_section(name)?;
                }
                _ => return Err(file.wrong("text between sections", "a section like `$Nodes`")),
            },
        }
    }
    if !nodes {
        return Err(file.wrong("the end of the file", "`$Nodes`: the file holds none or is cut off"));
    }
    let Some(blocks) = blocks else {
        return Err(file.wrong("the end of the file", "`$Elements`: the file holds none or is cut off"));
    };
    if let Some(entities) = entities {
        for block in blocks {
            let Some(groups) = entities.get(&block.entity) else {
                let (dimension, tag) = block.entity;
                let found =
                    format!("elements of entity {tag} of dimension {dimension}, which $Entities lacks");
                return Err(Error::input(Fault::new(block.position, found, "entities of the file")));
            };
            raw.elements[block.elements].iter_mut().for_each(|e| e.groups.clone_from(groups));
        }
    }
    Ok(raw)
}

/// A count, bounded by what the rest of the file can hold.
fn count(file: &mut Reader<'_>, what: &str) -> Result<usize> {
    let count = file.size(what)?;
    if count > file.left() as u64 {
        return Err(file.wrong(format!("{what} {count}"), "a count that the rest of the file can hold"));
    }
    Ok(count as usize)
}

/// Goes to the first number of a section.
fn enter(file: &mut Reader<'_>) {
    if file.encoding != Encoding::Ascii {
        file.end_line();
    }
}

/// Points with three coordinates; curves, surfaces and volumes with a box and what bounds them.
fn read_entities(file: &mut Reader<'_>) -> Result<Entities> {
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
                let bound = file.float("entity's coordinate")?;
                if !bound.is_finite() {
                    return Err(file.wrong(bound.to_string(), "a finite coordinate of an entity"));
                }
            }
            let groups = self::count(file, "number of physical groups")?;
            let mut physical = Vec::new();
            for _ in 0..groups {
                // A negative group stands for the reversed side of a surface.
                physical.push(file.int("physical group")?.saturating_abs());
            }
            if dimension > 0 {
                for _ in 0..self::count(file, "number of bounding entities")? {
                    file.int("bounding entity")?;
                }
            }
            if entities.insert((dimension as i64, tag), physical).is_some() {
                let found = format!("entity {tag} of dimension {dimension} again");
                return Err(file.wrong(found, "each entity once"));
            }
        }
    }
    file.expect("$EndEntities")?;
    Ok(entities)
}

/// The head of a section of blocks: how many blocks and how many things in all; the smallest and largest tag are of no use.
fn head(file: &mut Reader<'_>, what: &str) -> Result<[usize; 2]> {
    enter(file);
    let counts = [count(file, "number of blocks")?, count(file, &format!("number of {what}"))?];
    file.size("smallest tag")?;
    file.size("largest tag")?;
    Ok(counts)
}

/// Fails where the blocks of a section hold another number of things than its head says.
fn check_total(file: &Reader<'_>, what: &str, found: usize, said: usize) -> Result<()> {
    if found == said {
        return Ok(());
    }
    Err(file.wrong(format!("{found} {what}"), format!("{said}, as the head of the section says")))
}

fn read_nodes(file: &mut Reader<'_>, raw: &mut RawMesh) -> Result<()> {
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
            raw.nodes.push((tag(file, "node number")?, [0.0; 3]));
            file.line_is_over("a node's number")?;
        }
        for node in &mut raw.nodes[first..] {
            node.1 = [file.float("node's x")?, file.float("node's y")?, file.float("node's z")?];
            for _ in 0..parametric {
                file.float("node's parametric coordinate")?;
            }
            file.line_is_over("a node")?;
        }
    }
    check_total(file, "nodes", raw.nodes.len(), total)?;
    file.expect("$EndNodes")
}

fn read_elements(file: &mut Reader<'_>, raw: &mut RawMesh) -> Result<Vec<Block>> {
    let [n_blocks, total] = head(file, "elements")?;
    let mut blocks = Vec::new();
    for _ in 0..n_blocks {
        let entity = (file.int("entity's dimension")?, file.int("entity's tag")?);
        let kind = file.int("element type")?;
        let Some(n_nodes) = n_nodes(kind) else {
            return Err(file.wrong(format!("element type {kind}"), "a type of the MSH 4.1 format"));
        };
        let position = file.place();
        let first = raw.elements.len();
        for _ in 0..count(file, "number of elements in the block")? {
            let tag = tag(file, "element number")?;
            let nodes = (0..n_nodes).map(|_| self::tag(file, "node number")).collect::<Result<Vec<u64>>>()?;
            file.line_is_over("an element")?;
            raw.elements.push(RawElement { tag, kind, nodes, groups: Vec::new() });
        }
        blocks.push(Block { entity, elements: first..raw.elements.len(), position });
    }
    check_total(file, "elements", raw.elements.len(), total)?;
    file.expect("$EndElements")?;
    Ok(blocks)
}

fn tag(file: &mut Reader<'_>, what: &str) -> Result<u64> {
    match file.size(what)? {
        0 => Err(file.wrong(format!("{what} 0"), "a positive number")),
        tag => Ok(tag),
    }
}
