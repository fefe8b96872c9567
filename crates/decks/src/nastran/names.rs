//! Names that pre-processors write into comments: HyperMesh, ANSA, Femap, I-DEAS, Simcenter and Patran.

use crate::written::lost;
use std::collections::BTreeMap;

/// What has a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Named {
    Property,
    Material,
    Set,
    Region,
}

/// Names by number.
#[derive(Debug, Default)]
pub(super) struct Names {
    by_number: BTreeMap<(Named, u64), String>,
    /// A name of the next card of its kind.
    next: BTreeMap<Named, String>,
    /// How many have a name, in capitals.
    counts: BTreeMap<(Named, String), usize>,
    /// What comments say that was not written, and why.
    pub lost: Vec<(String, String)>,
}

impl Names {
    /// A comment, without its `$`.
    pub fn comment(&mut self, comment: &str) {
        self.lost.extend(lost(comment));
        if let Some((what, number, name)) = by_number(comment) {
            self.by_number.insert((what, number), name);
        } else if let Some((what, name)) = next(comment) {
            self.next.insert(what, name);
        }
    }

    /// A card of this kind is read: the name that stands before it is its own.
    pub fn card(&mut self, what: Named, number: u64) {
        if let Some(name) = self.next.remove(&what) {
            self.by_number.entry((what, number)).or_insert(name);
        }
    }

    /// Counts how many have each name, once all are read.
    pub fn count(&mut self) {
        for ((what, _), name) in &self.by_number {
            *self.counts.entry((*what, name.to_uppercase())).or_default() += 1;
        }
    }

    /// The name of a thing; names of several get their numbers.
    pub fn of(&self, what: Named, number: u64, otherwise: &str) -> String {
        let Some(name) = self.by_number.get(&(what, number)) else { return format!("{otherwise}_{number}") };
        let several = self.counts.get(&(what, name.to_uppercase())).is_some_and(|count| *count > 1);
        if several { format!("{name}_{number}") } else { name.clone() }
    }
}

fn named(name: &str) -> Option<String> {
    let name = name.trim().trim_matches('"').trim();
    (!name.is_empty()).then(|| name.to_string())
}

/// `$HMNAME PROP       3"disc" 4`, `$HMSET 3 1 "nodes"`.
fn hypermesh(comment: &str) -> Option<(Named, u64, String)> {
    let (head, rest) = comment.split_once('"')?;
    let name = named(rest.split('"').next()?)?;
    let words: Vec<&str> = head.split_whitespace().collect();
    let (what, number) = match words[..] {
        ["HMNAME", "PROP", number, ..] => (Named::Property, number),
        ["HMNAME", "MAT", number, ..] => (Named::Material, number),
        ["HMSET", number, ..] => (Named::Set, number),
        _ => return None,
    };
    Some((what, number.parse().ok()?, name))
}

/// `$ANSA_NAME_COMMENT;3;PSOLID;disc;…`.
fn ansa(comment: &str) -> Option<(Named, u64, String)> {
    let mut words = comment.strip_prefix("ANSA_NAME_COMMENT;")?.split(';');
    let (number, kind, name) = (words.next()?, words.next()?, words.next()?);
    let what = match kind {
        "SET" => Named::Set,
        _ if kind.starts_with("MAT") => Named::Material,
        _ if kind.starts_with('P') => Named::Property,
        _ => return None,
    };
    Some((what, number.trim().parse().ok()?, named(name)?))
}

/// `$ Femap Property 3 : disc`, `$ Femap with NX Nastran Material 1 : steel`, `$ Femap Region 2 : pad`.
fn femap(comment: &str) -> Option<(Named, u64, String)> {
    let (head, name) = comment.trim().strip_prefix("Femap")?.split_once(':')?;
    let words: Vec<&str> = head.split_whitespace().collect();
    let (what, number) = match words[..] {
        [.., "Property", number] => (Named::Property, number),
        [.., "Material", number] => (Named::Material, number),
        [.., "Region", number] => (Named::Region, number),
        _ => return None,
    };
    Some((what, number.parse().ok()?, named(name)?))
}

/// `$*  I-DEAS property: 3  name: disc`.
fn ideas(comment: &str) -> Option<(Named, u64, String)> {
    let (head, name) = comment.strip_prefix('*')?.trim().strip_prefix("I-DEAS ")?.split_once("name:")?;
    let (what, number) = head.split_once(':')?;
    let what = match what.to_ascii_lowercase().as_str() {
        "property" => Named::Property,
        "material" => Named::Material,
        _ => return None,
    };
    Some((what, number.trim().parse().ok()?, named(name)?))
}

/// A name with the number of what has it.
fn by_number(comment: &str) -> Option<(Named, u64, String)> {
    hypermesh(comment).or_else(|| ansa(comment)).or_else(|| femap(comment)).or_else(|| ideas(comment))
}

/// `$*  Simcenter Nastran Property: disc`, `$ Elements and Element Properties for region : disc`, `$ Material Record : steel`.
fn next(comment: &str) -> Option<(Named, String)> {
    let (head, name) = comment.split_once(':')?;
    let what = match head.strip_prefix('*') {
        Some(head) if head.trim().starts_with("I-DEAS") => return None,
        Some(head) if head.trim_end().ends_with("Property") => Named::Property,
        Some(head) if head.trim_end().ends_with("Material") => Named::Material,
        None if head.trim() == "Elements and Element Properties for region" => Named::Property,
        None if head.trim() == "Material Record" => Named::Material,
        _ => return None,
    };
    Some((what, named(name)?))
}
