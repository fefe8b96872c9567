//! MSH 2.2: nodes, then elements that each carry their physical group.

use super::bytes::{ByteReader, Encoding};
use super::raw::{RawElement, RawMesh, RawNode, element_nodes};
use stridor_base::error::Result;

/// Reads the whole file.
pub(super) fn parse(mut file: ByteReader<'_>) -> Result<RawMesh> {
    let mut raw = RawMesh::default();
    let (mut nodes, mut elements) = (false, false);
    loop {
        match file.section() {
            "" => break,
            "$Nodes" => {
                read_nodes(&mut file, &mut raw)?;
                file.expect("$EndNodes")?;
                nodes = true;
            }
            "$Elements" => {
                read_elements(&mut file, &mut raw)?;
                file.expect("$EndElements")?;
                elements = true;
            }
            other => file.skip_section(other.trim_start_matches('$'))?,
        }
    }
    match (nodes, elements) {
        (true, true) => Ok(raw),
        (false, _) => Err(file.wrong("the end of the file", "`$Nodes`: the file holds none or is cut off")),
        _ => Err(file.wrong("the end of the file", "`$Elements`: the file holds none or is cut off")),
    }
}

/// The count at the head of a section, bounded by what the rest of the file can hold.
fn count(file: &mut ByteReader<'_>, what: &str) -> Result<usize> {
    let count: u64 = file.text_number(what)?;
    if count > file.left() as u64 {
        return Err(file.wrong(format!("{what} {count}"), "a count that the rest of the file can hold"));
    }
    if file.encoding != Encoding::Ascii {
        file.end_line();
    }
    Ok(count as usize)
}

fn read_nodes(file: &mut ByteReader<'_>, raw: &mut RawMesh) -> Result<()> {
    for _ in 0..count(file, "number of nodes")? {
        let tag = tag(file, "node number")?;
        let offset = file.offset();
        let place = [file.float("node's x")?, file.float("node's y")?, file.float("node's z")?];
        file.line_is_over("a node")?;
        raw.nodes.push(RawNode { tag, place, offset });
    }
    Ok(())
}

fn read_elements(file: &mut ByteReader<'_>, raw: &mut RawMesh) -> Result<()> {
    let total = count(file, "number of elements")?;
    let mut read = 0;
    while read < total {
        // Text: every element says its kind. Binary: elements of one kind follow a common head.
        if file.encoding == Encoding::Ascii {
            let tag = tag(file, "element number")?;
            let kind = file.int("element type")?;
            let n_tags = file.int("number of tags")?;
            read_element(file, raw, tag, kind, n_tags)?;
            file.line_is_over("an element")?;
            read += 1;
        } else {
            let (kind, follow) = (file.int("element type")?, file.int("number of elements in the block")?);
            let n_tags = file.int("number of tags")?;
            if follow < 1 || follow as usize > total - read {
                return Err(
                    file.wrong(format!("{follow} elements in a block"), format!("1 … {}", total - read))
                );
            }
            for _ in 0..follow {
                let tag = tag(file, "element number")?;
                read_element(file, raw, tag, kind, n_tags)?;
            }
            read += follow as usize;
        }
    }
    Ok(())
}

/// Tags, of which the first is the physical group (0: none), then nodes.
fn read_element(
    file: &mut ByteReader<'_>,
    raw: &mut RawMesh,
    tag: u64,
    kind: i64,
    n_tags: i64,
) -> Result<()> {
    if n_tags < 0 || n_tags > file.left() as i64 {
        return Err(file.wrong(format!("{n_tags} tags"), "a few"));
    }
    let offset = file.offset();
    let mut group = 0;
    for k in 0..n_tags {
        let number = file.int("element tag")?;
        if k == 0 {
            group = number;
        }
    }
    let nodes = element_nodes(file, kind, |file| self::tag(file, "node number"))?;
    // A negative group denotes the reversed side of a surface.
    let groups = if group == 0 { vec![] } else { vec![group.saturating_abs()] };
    raw.elements.push(RawElement { tag, kind, nodes, groups, offset });
    Ok(())
}

fn tag(file: &mut ByteReader<'_>, what: &str) -> Result<u64> {
    let number = file.int(what)?;
    match u64::try_from(number) {
        Ok(tag) if tag > 0 => Ok(tag),
        _ => Err(file.wrong(format!("{what} {number}"), "a positive number")),
    }
}
