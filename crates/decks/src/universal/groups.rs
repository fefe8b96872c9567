//! Groups: datasets 2417, 2429, 2430, 2432, 2435, 2452, 2467 and 2477.
//!
//! A group has a line of eight numbers, its own first and that of its members last, a line with its name, and its members: kind and number
//! (older datasets), and two more numbers (from 2435 on).

use crate::deck::{Deck, Place, Set};
use crate::ledger::Weight;
use stridor_base::error::{Error, Result};
use stridor_base::universal::Dataset;
use stridor_base::universal::record::{columns, whole};

/// Kinds of members.
const NODE: i64 = 7;
const ELEMENT: i64 = 8;

/// Reads a dataset of groups.
pub(super) fn read(dataset: &Dataset<'_>, file: u32, deck: &mut Deck, faults: &mut impl FnMut(Error)) {
    let mut index = 0;
    while index < dataset.lines.len() {
        if dataset.lines[index].text.trim().is_empty() {
            index += 1;
            continue;
        }
        if let Err(error) = group(dataset, &mut index, file, deck) {
            // Where the next group begins is not known.
            return faults(error);
        }
    }
}

/// The group at a line; `index` is then that of the line after it.
fn group(dataset: &Dataset<'_>, index: &mut usize, file: u32, deck: &mut Deck) -> Result<()> {
    let head = dataset.wholes(*index, [10; 8])?;
    let place = Place { file, line: dataset.lines[*index].number as u32 };
    let name = match dataset.line(*index + 1)?.trim() {
        "" => format!("GROUP_{}", head[0]),
        name => name.to_string(),
    };
    let words = if matches!(dataset.kind, 2417 | 2429 | 2430 | 2432) { 2 } else { 4 };
    let mut left = usize::try_from(head[7]).map_err(|_| {
        dataset.fault(*index, format!("{} members", head[7]), "how many members the group has")
    })?;
    let (mut nodes, mut elements) = (Vec::new(), Vec::new());
    let mut gone = 0;
    let mut next = *index + 2;
    while left > 0 {
        let text = dataset.line(next)?;
        let fields = columns(text, &[10; 8]);
        let numbers: Option<Vec<i64>> = fields.iter().map(|field| whole(field)).collect();
        let numbers = numbers.ok_or_else(|| {
            dataset.fault(next, format!("`{}`", text.trim()), "kinds and numbers of members")
        })?;
        if numbers.iter().all(|number| *number == 0) {
            return Err(dataset.fault(next, "no members", format!("{left} more of group `{name}`")));
        }
        for member in numbers.chunks(words).take(left) {
            left -= 1;
            let Ok(number) = u64::try_from(member[1]) else { continue };
            let found = match member[0] {
                NODE => {
                    deck.nodes.binary_search_by_key(&number, |own| own.number).ok().map(|at| nodes.push(at))
                }
                ELEMENT => deck
                    .elements
                    .binary_search_by_key(&number, |own| own.number)
                    .ok()
                    .map(|at| elements.push(at)),
                kind => {
                    let why = format!("members of kind {kind}: nodes (7) and elements (8) are read");
                    deck.ledger.note(Weight::Perhaps, format!("dataset {}", dataset.kind), why, place);
                    continue;
                }
            };
            gone += usize::from(found.is_none());
        }
        next += 1;
    }
    if gone > 0 {
        let why = format!("{gone} members that are not in the file, or of kinds that are not read");
        deck.ledger.note(Weight::Perhaps, format!("group {name}"), why, place);
    }
    for (mut members, sets) in [(nodes, &mut deck.node_sets), (elements, &mut deck.element_sets)] {
        if !members.is_empty() {
            members.sort_unstable();
            members.dedup();
            sets.push(Set { name: name.clone(), members, internal: false });
        }
    }
    *index = next;
    Ok(())
}
