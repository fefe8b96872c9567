//! A deck as text of a format, and what both formats need for that.

use crate::deck::{Deck, Frame, Support};
use crate::ledger::{Ledger, Weight};
use crate::place::Place;
use std::collections::{HashMap, HashSet};
use stridor_mesh::quality::{cross, dot, minus, norm};

#[cfg(test)]
mod tests;

/// A deck as text, and what of it the format does not hold.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Written {
    /// The text of the file.
    pub text: String,
    /// What is left out, or written as the nearest thing that the format has.
    pub left_out: Ledger,
    /// What of the model itself is lost, in sentences for comments of the file.
    pub(crate) lost: Vec<String>,
}

/// How a comment begins that says what of a model is not in the file.
pub(crate) const LOST: &str = "Not written: ";

/// A text without line ends, for a comment.
pub(crate) fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// What is lost and why, of such a comment.
pub(crate) fn lost(comment: &str) -> Option<(String, String)> {
    let (what, why) = comment.trim().strip_prefix(LOST)?.split_once(": ")?;
    Some((what.to_string(), why.to_string()))
}

impl Written {
    /// The beginning of what a deck becomes: what it lost already is in its ledger.
    pub(crate) fn of(deck: &Deck) -> Self {
        let mut written = Written { left_out: deck.ledger.clone(), ..Written::default() };
        let matters = deck.ledger.rows().filter(|row| row.weight == Weight::Matters);
        written.lost = matters.map(|row| format!("{LOST}{}: {}", row.what, row.why)).collect();
        written
    }

    /// Notes what the file does not have of the model.
    pub(crate) fn lose(&mut self, what: &str, why: &str) {
        let comment = format!("{LOST}{what}: {why}");
        if !self.lost.contains(&comment) {
            self.lost.push(comment);
        }
        self.note(Weight::Matters, what, why);
    }

    /// Puts the comments on what is lost in at a byte of the text, each after `mark`.
    pub(crate) fn insert_lost(&mut self, at: usize, mark: &str) {
        let lines = self.lost.iter().map(|comment| format!("{mark}{}\n", one_line(comment)));
        let comments: String = lines.collect();
        self.text.insert_str(at, &comments);
    }

    pub(crate) fn line(&mut self, line: impl AsRef<str>) {
        self.text += line.as_ref();
        self.text.push('\n');
    }

    pub(crate) fn note(&mut self, weight: Weight, what: impl Into<String>, why: impl Into<String>) {
        self.left_out.note(weight, what, why, Place::default());
    }
}

/// Names as a format takes them: letters, digits, `_` and `-`, a letter first, each once whatever the case of its letters.
#[derive(Debug, Default)]
pub(crate) struct Names {
    taken: HashSet<String>,
    by_own: HashMap<String, String>,
}

/// So many characters has a name at most.
const LONGEST: usize = 70;

impl Names {
    /// The name of the thing that the deck calls `own`; the same one again, if it was asked for before.
    pub fn of(&mut self, own: &str) -> String {
        let key = own.to_uppercase();
        if let Some(known) = self.by_own.get(&key) {
            return known.clone();
        }
        let name = self.free(own);
        self.by_own.insert(key, name.clone());
        name
    }

    /// A name like `wanted` that nothing else has.
    pub fn free(&mut self, wanted: &str) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() || "_-".contains(c) { c } else { '_' };
        let mut clean: String = wanted.chars().map(plain).take(LONGEST).collect();
        if !clean.starts_with(|c: char| c.is_ascii_alphabetic()) {
            clean.insert(0, 'N');
        }
        let mut name = clean.clone();
        let mut count = 1;
        while !self.taken.insert(name.to_uppercase()) {
            count += 1;
            name = format!("{clean}_{count}");
        }
        name
    }
}

/// A number in full, or of as many digits as `most` characters hold.
pub(crate) fn number(value: f64, most: usize) -> String {
    let forms = [format!("{value:?}"), format!("{value:e}")];
    let shortest = forms.into_iter().min_by_key(String::len).unwrap_or_default();
    if shortest.len() <= most {
        return shortest;
    }
    let mut digits = (0..most).rev().map(|digits| format!("{value:.digits$e}"));
    digits.find(|form| form.len() <= most).unwrap_or_default()
}

/// What holds one node: degrees of freedom, and sums of them, Σ a u = 0, in each of which the first one stands in no other sum.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct HeldNode {
    pub node: usize,
    pub held: [bool; 6],
    pub sums: Vec<Vec<(usize, u8, f64)>>,
}

/// What all supports hold.
#[derive(Debug, Default)]
pub(crate) struct Held {
    /// Of each support, node by node.
    pub supports: Vec<Vec<HeldNode>>,
    /// What is held by sums that other supports leave one degree of freedom of.
    pub more: Vec<(usize, u8)>,
    /// Sums of degrees of freedom that no support holds.
    pub sums: Vec<Vec<(usize, u8, f64)>>,
}

/// What the supports of a deck hold: a degree of freedom that is held stands in no sum.
pub(crate) fn held(deck: &Deck) -> Held {
    let mut found =
        Held { supports: deck.supports.iter().map(|own| held_nodes(deck, own)).collect(), ..Held::default() };
    let nodes = found.supports.iter().flatten();
    let each =
        |own: &HeldNode| (0..6).filter(|k| own.held[*k]).map(|k| (own.node, k as u8)).collect::<Vec<_>>();
    let mut known: HashSet<(usize, u8)> = nodes.flat_map(each).collect();
    let mut sums: Vec<_> = found.supports.iter().flatten().flat_map(|own| own.sums.clone()).collect();
    loop {
        sums.iter_mut().for_each(|sum| sum.retain(|(node, dof, _)| !known.contains(&(*node, *dof))));
        let (single, others): (Vec<_>, Vec<_>) = sums.into_iter().partition(|sum| sum.len() < 2);
        sums = others;
        let before = found.more.len();
        for (node, dof, _) in single.into_iter().flatten() {
            if known.insert((node, dof)) {
                found.more.push((node, dof));
            }
        }
        if found.more.len() == before {
            found.sums = sums;
            return found;
        }
    }
}

/// What a support holds, node by node.
pub(crate) fn held_nodes(deck: &Deck, support: &Support) -> Vec<HeldNode> {
    let of = |node: usize| {
        let Some(axes) = axes_at(support.frame, deck.nodes[node].position) else {
            return HeldNode { node, held: support.held, sums: Vec::new() };
        };
        let (mut held, mut sums) = ([false; 6], Vec::new());
        for first in [0, 3] {
            let rows = (0..3).filter(|k| support.held[first + k]).map(|k| axes[k]).collect();
            for row in echelon(rows) {
                match row[..] {
                    [(k, _)] => held[first + k] = true,
                    _ => sums.push(row.iter().map(|(k, a)| (node, (first + k) as u8, *a)).collect()),
                }
            }
        }
        HeldNode { node, held, sums }
    };
    support.nodes.iter().map(|node| of(*node)).collect()
}

/// The directions of a frame at a point; none of those of the coordinates. On the axis of a cylinder any directions across it.
fn axes_at(frame: Frame, position: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    let unit = |v: [f64; 3]| v.map(|x| x / norm(v));
    match frame {
        Frame::Global => None,
        Frame::Turned(axes) => Some(axes),
        Frame::Cylindrical([point, along]) => {
            let along = unit(along);
            let from = minus(position, point);
            let across = |v: [f64; 3]| minus(v, along.map(|x| x * dot(v, along)));
            let mut radial = across(from);
            if norm(radial) <= 1e-9 * norm(from) {
                let least = (0..3).min_by(|a, b| along[*a].abs().total_cmp(&along[*b].abs())).unwrap_or(0);
                radial = across(std::array::from_fn(|k| f64::from(u8::from(k == least))));
            }
            let radial = unit(radial);
            Some([radial, cross(along, radial), along])
        }
    }
}

/// Coefficients below this of unit directions are round-off.
const ROUND_OFF: f64 = 1e-14;

/// Sums a·u = 0 that hold what `rows` hold, by Gauss's elimination: the first term of each has the coefficient 1 and stands in no other.
fn echelon(mut rows: Vec<[f64; 3]>) -> Vec<Vec<(usize, f64)>> {
    let mut first = Vec::new();
    for k in 0..rows.len() {
        let free = (0..3).filter(|column| !first.contains(column));
        let Some(pivot) = free.max_by(|a, b| rows[k][*a].abs().total_cmp(&rows[k][*b].abs())) else { break };
        let row = rows[k].map(|a| a / rows[k][pivot]);
        for (j, other) in rows.iter_mut().enumerate() {
            let factor = other[pivot];
            *other = if j == k { row } else { std::array::from_fn(|c| other[c] - factor * row[c]) };
        }
        first.push(pivot);
    }
    let sum = |(row, pivot): (&[f64; 3], &usize)| {
        let others = (0..3).filter(|c| c != pivot && row[*c].abs() > ROUND_OFF).map(|c| (c, row[c]));
        std::iter::once((*pivot, 1.0)).chain(others).collect()
    };
    rows.iter().zip(&first).map(sum).collect()
}

/// The section of each element, if it has one.
pub(crate) fn sections_of_elements(deck: &Deck) -> Vec<Option<usize>> {
    let mut of = vec![None; deck.elements.len()];
    for (k, section) in deck.sections.iter().enumerate() {
        section.elements.iter().for_each(|element| of[*element] = Some(k));
    }
    of
}

/// Whether shells or beams turn each node, or it leads a coupling.
pub(crate) fn rotates(deck: &Deck) -> Vec<bool> {
    let mut rotates = vec![false; deck.nodes.len()];
    for element in deck.elements.iter().filter(|element| (1..=2).contains(&element.kind.dimension())) {
        element.nodes.iter().for_each(|node| rotates[*node] = true);
    }
    deck.couplings.iter().for_each(|coupling| rotates[coupling.reference] = true);
    rotates
}

/// The numbers of a file where each is there once, else 1, 2, …
pub(crate) fn numbers(own: impl Iterator<Item = u64>) -> Vec<u64> {
    let own: Vec<u64> = own.collect();
    let once: HashSet<u64> = own.iter().copied().collect();
    if once.len() == own.len() { own } else { (1..=own.len() as u64).collect() }
}
