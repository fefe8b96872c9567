//! The layout of MSH 4.1: whether a file has every number that its counts announce, each thing in a line of its own.
//!
//! mshio reads on where a line is missing or two numbers touch, takes any coordinate for one and needs no entities. So this
//! goes through the whole file first, number by number, and names the line of what is wrong.

use super::bytes::{ByteReader, Encoding};
use super::raw::n_nodes;
use std::collections::HashSet;
use stridor_base::error::{Error, Fault, Result};

/// Entities by dimension and tag.
type Entities = HashSet<(i64, i64)>;

/// Elements of one entity: its dimension and tag, and where they are in the file.
struct EntityBlock {
    entity: (i64, i64),
    position: String,
}

/// Where the lines of nodes and elements are, in the order of the file \[bytes\].
#[derive(Default)]
pub(super) struct Offsets {
    pub nodes: Vec<usize>,
    pub elements: Vec<usize>,
}

/// Goes through what follows the header's line; gives where nodes and elements are.
///
/// # Errors
/// Input: a number too few or too many, a count that the file does not hold, an entity that is missing or there twice.
pub(super) fn check(mut file: ByteReader<'_>) -> Result<Offsets> {
    file.skip_section("MeshFormat")?;
    let (mut entities, mut blocks) = (None, None);
    let mut nodes = false;
    let mut offsets = Offsets::default();
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
            "$Entities" => entities = Some(check_entities(&mut file)?),
            "$Nodes" => {
                offsets.nodes = check_nodes(&mut file)?;
                nodes = true;
            }
            "$Elements" => blocks = Some(check_elements(&mut file, &mut offsets.elements)?),
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
    let known =
        |block: &EntityBlock| entities.as_ref().is_none_or(|all: &Entities| all.contains(&block.entity));
    match blocks.into_iter().find(|block| !known(block)) {
        None => Ok(offsets),
        Some(EntityBlock { entity: (dimension, tag), position }) => {
            let found = format!("elements of entity {tag} of dimension {dimension}, which $Entities lacks");
            Err(Error::input(Fault::new(position, found, "entities of the file")))
        }
    }
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
fn check_entities(file: &mut ByteReader<'_>) -> Result<Entities> {
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
            for _ in 0..self::count(file, "number of physical groups")? {
                file.int("physical group")?;
            }
            if dimension > 0 {
                for _ in 0..self::count(file, "number of bounding entities")? {
                    file.int("bounding entity")?;
                }
            }
            if !entities.insert((dimension as i64, tag)) {
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

fn check_nodes(file: &mut ByteReader<'_>) -> Result<Vec<usize>> {
    let [blocks, total] = head(file, "nodes")?;
    let mut offsets = Vec::new();
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
        for _ in 0..count {
            tag(file, "node number")?;
            offsets.push(file.offset());
            file.line_is_over("a node's number")?;
        }
        for _ in 0..count {
            for what in ["node's x", "node's y", "node's z"] {
                file.float(what)?;
            }
            for _ in 0..parametric {
                file.float("node's parametric coordinate")?;
            }
            file.line_is_over("a node")?;
        }
    }
    check_total(file, "nodes", offsets.len(), total)?;
    file.expect("$EndNodes")?;
    Ok(offsets)
}

/// Adds where each element is to `offsets`.
fn check_elements(file: &mut ByteReader<'_>, offsets: &mut Vec<usize>) -> Result<Vec<EntityBlock>> {
    let [n_blocks, total] = head(file, "elements")?;
    let mut blocks = Vec::new();
    for _ in 0..n_blocks {
        let entity = (file.int("entity's dimension")?, file.int("entity's tag")?);
        let kind = file.int("element type")?;
        let Some(n_nodes) = n_nodes(kind) else {
            return Err(file.wrong(format!("element type {kind}"), "a type of the MSH 4.1 format"));
        };
        let position = file.place();
        let count = count(file, "number of elements in the block")?;
        for _ in 0..count {
            tag(file, "element number")?;
            offsets.push(file.offset());
            for _ in 0..n_nodes {
                tag(file, "node number")?;
            }
            file.line_is_over("an element")?;
        }
        blocks.push(EntityBlock { entity, position });
    }
    check_total(file, "elements", offsets.len(), total)?;
    file.expect("$EndElements")?;
    Ok(blocks)
}

fn tag(file: &mut ByteReader<'_>, what: &str) -> Result<()> {
    match file.size(what)? {
        0 => Err(file.wrong(format!("{what} 0"), "a positive number")),
        _ => Ok(()),
    }
}
