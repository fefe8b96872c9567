//! *PART, *ASSEMBLY, *INSTANCE: a part is read once for each of its instances, where that is placed.

use super::blocks::{Block, Blocks};
use super::frames::rotation;
use super::names::Names;
use super::reader::{Found, Reader};
use super::space::{Placement, Space};
use crate::ledger::Weight;

/// The blocks of a part.
struct Part<'b> {
    blocks: Vec<&'b Block>,
    used: bool,
}

/// The most times that the bytes of a file may be placed as parts: a part is read once for each instance.
const MOST_COPIES: usize = 64;
/// Members of sets that may be named, beside four for each byte.
const FEWEST_MEMBERS: usize = 1 << 16;

impl Reader {
    /// Reads the mesh of all instances into spaces of their own; gives the blocks of the model with their spaces, the others of parts
    /// among them.
    pub fn instances_of<'b>(&mut self, all: &'b Blocks) -> Vec<(usize, &'b Block)> {
        let mut parts: Names<Part<'b>> = Names::default();
        let mut placed: Vec<(usize, &'b Block)> = Vec::new();
        let mut part: Option<String> = None;
        let mut instance: Option<usize> = None;
        let mut copied = 0;
        for block in &all.blocks {
            let found = Found { blocks: all, block };
            match block.keyword.as_str() {
                "PART" => {
                    let name = found.option("NAME").unwrap_or_default().to_string();
                    if parts.get(&name).is_some() {
                        let words = format!("a second *PART `{name}`");
                        self.files.fault(block.place, words, "names that are different");
                    }
                    parts.entry(&name, || Part { blocks: Vec::new(), used: false });
                    part = Some(name);
                }
                "ENDPART" => part = None,
                "ASSEMBLY" | "ENDASSEMBLY" => {}
                "INSTANCE" => {
                    let space = self.instance(found);
                    let of = found.option("PART").unwrap_or_default();
                    match parts.get(of).map(|part| part.blocks.clone()) {
                        Some(blocks) => {
                            copied += blocks.iter().map(|block| block.n_bytes()).sum::<usize>();
                            if copied > MOST_COPIES * (all.n_bytes() + MOST_COPIES) {
                                let words = format!("parts of {copied} bytes in all instances");
                                let expected = format!("at most {MOST_COPIES} times as many as the file has");
                                self.files.fault(block.place, words, expected);
                                return Vec::new();
                            }
                            parts.entry(of, || unreachable!("it is there")).used = true;
                            placed.extend(blocks.into_iter().map(|block| (space, block)));
                        }
                        None if of.is_empty() => {
                            let why = "an instance of another model's results is not read";
                            self.deck.ledger.note(Weight::Matters, "*INSTANCE", why, block.place);
                        }
                        None => self.files.fault(
                            block.place,
                            format!("*INSTANCE of part `{of}`"),
                            "the name of a *PART above",
                        ),
                    }
                    instance = Some(space);
                }
                "ENDINSTANCE" => instance = None,
                _ => match (&part, instance) {
                    (Some(name), _) => {
                        parts.entry(name, || unreachable!("it is there")).blocks.push(block);
                    }
                    (None, Some(space)) => placed.push((space, block)),
                    (None, None) => placed.push((0, block)),
                },
            }
        }
        for part in parts.all.iter().filter(|part| !part.used) {
            let Some(first) = part.blocks.first() else { continue };
            self.deck.ledger.note(
                Weight::Perhaps,
                "*PART",
                "a part without an instance is not in the model",
                first.place,
            );
        }
        self.members_left = 4 * (all.n_bytes() + copied) + FEWEST_MEMBERS;
        // Instances before the model, which names what is in them.
        placed.sort_by_key(|(space, _)| (*space == 0, *space));
        placed
    }

    /// A space for an instance.
    fn instance(&mut self, found: Found<'_>) -> usize {
        let name = found.option("NAME").unwrap_or_default().to_string();
        let space = self.spaces.len();
        if self.instances.get(&name).is_some() {
            self.files.fault(
                found.place(),
                format!("a second *INSTANCE `{name}`"),
                "names that are different",
            );
        }
        self.instances.entry(&name, || space);
        let placement = self.placement(found, 1.0);
        self.spaces.push(Space { name, placement, ..Space::default() });
        space
    }

    /// The first line of data is a translation; the second two points of an axis and an angle in degrees about it, after the translation,
    /// as many times.
    pub fn placement(&mut self, found: Found<'_>, times: f64) -> Option<Placement> {
        let mut rows = found.rows();
        let translation = self.numbers::<3>(&rows.next()?, 0)?;
        let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let Some(row) = rows.next() else { return Some(Placement { rotation: one, translation }) };
        let [ax, ay, az, bx, by, bz, angle] = self.numbers::<7>(&row, 0)?;
        if angle == 0.0 {
            return Some(Placement { rotation: one, translation });
        }
        let axis = [bx - ax, by - ay, bz - az];
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length == 0.0 || !length.is_finite() {
            self.files.fault(row.place, "two points of an axis that are one", "two points");
            return None;
        }
        let rotation = rotation(axis.map(|x| x / length), times * angle.to_radians());
        let turn = Placement { rotation, translation: [0.0; 3] };
        // R (x + t − a) + a.
        let moved: [f64; 3] = std::array::from_fn(|i| translation[i] - [ax, ay, az][i]);
        let turned = turn.turn(moved);
        Some(Placement { rotation, translation: std::array::from_fn(|i| turned[i] + [ax, ay, az][i]) })
    }
}
