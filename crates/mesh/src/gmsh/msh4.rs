//! MSH 4.1 through the crate mshio, and what has to be done around it.
//!
//! mshio keeps the tags of nodes only where the header's smallest and largest tag leave gaps, and otherwise takes
//! them to be in ascending order, which the format does not promise. So the largest tag is raised for it. What it does not
//! inspect, lines, counts and entities, `layout` has checked before.

use super::bytes::{ByteReader, Encoding};
use super::layout;
use super::names::find;
use super::raw::{RawElement, RawMesh, RawNode};
use mshio::MshFile;
use std::collections::HashMap;
use std::panic::catch_unwind;
use stridor_base::error::{Error, Fault, Result};

/// Reads the whole file, whose numbers after the header begin at `body`.
pub(super) fn parse(bytes: &[u8], body: usize, encoding: Encoding, place: &str) -> Result<RawMesh> {
    let offsets = layout::check(ByteReader::new(bytes, body, encoding, place))?;
    let wrong = |found: String, expected: &str| Error::input(Fault::new(place, found, expected));
    let bytes = with_gaps(bytes, encoding);
    let parsed = catch_unwind(|| mshio::parse_msh_bytes(&bytes).map_err(|error| explain(&error)));
    let file: MshFile<u64, i32, f64> = match parsed {
        Ok(Ok(file)) => file,
        Ok(Err(text)) => return Err(wrong(text, "a whole file in the format MSH 4.1")),
        Err(_) => return Err(wrong("numbers beyond the range of the reader".into(), "the format MSH 4.1")),
    };
    let Some(nodes) = file.data.nodes else { return Err(wrong("no section $Nodes".into(), "nodes")) };
    let Some(elements) = file.data.elements else {
        return Err(wrong("no section $Elements".into(), "elements"));
    };

    let mut raw = RawMesh::default();
    let [mut node_offsets, mut element_offsets] = [offsets.nodes, offsets.elements].map(Vec::into_iter);
    for block in nodes.node_blocks {
        let mut tags = vec![0; block.nodes.len()];
        for (tag, index) in block.node_tags.into_iter().flatten() {
            tags[index] = tag;
        }
        if let Some(k) = tags.iter().position(|t| *t == 0) {
            return Err(wrong(
                format!("the number of node {} in a block twice", k + 1),
                "each node number once",
            ));
        }
        raw.nodes.extend(tags.into_iter().zip(block.nodes).map(|(tag, n)| RawNode {
            tag,
            place: [n.x, n.y, n.z],
            offset: node_offsets.next().unwrap_or_default(),
        }));
    }
    if raw.nodes.len() as u64 != nodes.num_nodes {
        return Err(wrong(
            format!("{} nodes", raw.nodes.len()),
            &format!("{}, as stated in $Nodes", nodes.num_nodes),
        ));
    }

    // A negative group denotes the reversed side of a surface.
    let mut groups: HashMap<(i32, i32), Vec<i64>> = HashMap::new();
    let mut note = |dimension: i32, tag: i32, physical: Vec<i32>| {
        groups.insert((dimension, tag), physical.into_iter().map(|p| i64::from(p).abs()).collect());
    };
    if let Some(entities) = file.data.entities {
        entities.points.into_iter().for_each(|e| note(0, e.tag, e.physical_tags));
        entities.curves.into_iter().for_each(|e| note(1, e.tag, e.physical_tags));
        entities.surfaces.into_iter().for_each(|e| note(2, e.tag, e.physical_tags));
        entities.volumes.into_iter().for_each(|e| note(3, e.tag, e.physical_tags));
    }
    for block in elements.element_blocks {
        let kind = block.element_type as i64;
        let groups = groups.get(&(block.entity_dim, block.entity_tag)).cloned().unwrap_or_default();
        raw.elements.extend(block.elements.into_iter().map(|e| RawElement {
            tag: e.element_tag,
            kind,
            nodes: e.nodes,
            groups: groups.clone(),
            offset: element_offsets.next().unwrap_or_default(),
        }));
    }
    if raw.elements.len() as u64 != elements.num_elements {
        let (found, said) = (raw.elements.len(), elements.num_elements);
        return Err(wrong(format!("{found} elements"), &format!("{said}, as stated in $Elements")));
    }
    Ok(raw)
}

/// The file with the largest node tag of `$Nodes` raised, so that mshio keeps all tags.
fn with_gaps(bytes: &[u8], encoding: Encoding) -> Vec<u8> {
    let mut file = bytes.to_vec();
    let Some(start) = find(bytes, b"\n$Nodes") else { return file };
    let Some(line) = bytes[start + 1..].iter().position(|b| *b == b'\n') else { return file };
    let head = start + 1 + line + 1;
    if encoding != Encoding::Ascii {
        // Four eight-byte numbers: blocks, nodes, smallest tag, largest tag.
        if let Some(largest) = file.get_mut(head + 24..head + 32) {
            largest.fill(0xff);
        }
        return file;
    }
    let mut at = head;
    for word in 0..4 {
        let rest = &bytes[at..];
        at += rest.iter().take_while(|b| b.is_ascii_whitespace()).count();
        let length = bytes[at..].iter().take_while(|b| b.is_ascii_digit()).count();
        if word == 3 && length > 0 {
            file.splice(at..at + length, u64::MAX.to_string().into_bytes());
        }
        at += length;
    }
    file
}

/// Explanation of an error of mshio.
fn explain(error: &mshio::MshParserError<&[u8]>) -> String {
    let mut parts: Vec<String> =
        error.filter_msh_errors().filter_map(|(_, kind)| kind.context().map(String::from)).collect();
    parts.dedup();
    format!("what mshio cannot read ({})", parts.join(", in "))
}
