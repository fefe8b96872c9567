//! Elements: dataset 2412.

/// An element of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    /// FE descriptor.
    pub descriptor: u32,
    /// Labels of its nodes, in the order of the format.
    pub nodes: Vec<u64>,
}

/// FE descriptors of rods and beams, which have a line of their own.
const BEAMS: [u32; 4] = [11, 21, 22, 24];

/// Dataset 2412, elements labelled from 1.
pub(super) fn write(elements: impl Iterator<Item = Element>) -> String {
    let mut text = String::from("    -1\n  2412\n");
    for (k, Element { descriptor, nodes }) in elements.enumerate() {
        text += &format!("{:10}{descriptor:10}{:10}{:10}{:10}{:10}\n", k + 1, 1, 1, 7, nodes.len());
        if BEAMS.contains(&descriptor) {
            text += &format!("{:10}{:10}{:10}\n", 0, 1, 1);
        }
        for line in nodes.chunks(8) {
            text.extend(line.iter().map(|node| format!("{node:10}")));
            text.push('\n');
        }
    }
    text + "    -1\n"
}
