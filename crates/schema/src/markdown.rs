//! The reference of all keys, in Markdown: a section for each table, a row for each key.

use super::key::describe_bounds;
use super::{By, Content, DescribedKey, DescribedTable, Form, Presence};
use std::fmt::Write;
use std::ops::Bound;

/// The reference of a table and of those in it.
pub fn key_reference(table: &DescribedTable) -> String {
    let mut text = String::new();
    section(&mut text, "", "", table);
    text
}

/// The section of a table at `path`, then those of the tables in it.
fn section(text: &mut String, path: &str, doc: &str, table: &DescribedTable) {
    let heading = if path.is_empty() { "The case itself".to_string() } else { format!("`[{path}]`") };
    let _ = writeln!(text, "## {heading}\n");
    let about = if doc.is_empty() { &table.doc } else { doc };
    let _ = writeln!(text, "{about}\n");
    let values: Vec<&DescribedKey> =
        table.keys.iter().filter(|key| matches!(key.content, Content::Value { .. })).collect();
    rows(text, &values);
    if let Some(free) = &table.free {
        let _ = writeln!(text, "Keys are free; each holds {}.\n", expected(free));
    }
    for variants in &table.variants {
        for (k, (word, doc, keys)) in variants.each.iter().enumerate() {
            let default = if variants.default == Some(k) { " (default)" } else { "" };
            let chosen = match variants.by {
                By::Tag(tag) => format!("`{tag} = \"{word}\"`{default}: "),
                By::Presence => format!("With `{word}`{default}: "),
            };
            let _ = writeln!(text, "{chosen}{doc}\n");
            rows(text, &keys.keys.iter().collect::<Vec<_>>());
        }
    }
    let of_variants = table.variants.iter().flat_map(|v| &v.each).flat_map(|(_, _, keys)| &keys.keys);
    for key in table.keys.iter().chain(of_variants) {
        let Content::Table(presence, inner) = &key.content else { continue };
        let name = if *presence == Presence::Named { format!("{}.NAME", key.name) } else { key.name.clone() };
        let path = if path.is_empty() { name } else { format!("{path}.{name}") };
        section(text, &path, &key.doc, inner);
    }
}

fn rows(text: &mut String, keys: &[&DescribedKey]) {
    let keys: Vec<&&DescribedKey> =
        keys.iter().filter(|key| matches!(key.content, Content::Value { .. })).collect();
    if keys.is_empty() {
        return;
    }
    text.push_str("| key | value | default | |\n|-|-|-|-|\n");
    for key in keys {
        let Content::Value { required, default, .. } = &key.content else { continue };
        let default = match default {
            Some(default) => cell(default),
            None if *required => "required".into(),
            None => String::new(),
        };
        let _ =
            writeln!(text, "| `{}` | {} | {default} | {} |", key.name, cell(&expected(key)), cell(&key.doc));
    }
    text.push('\n');
}

/// Expected value of a key, in words: unit, bounds, choices.
fn expected(key: &DescribedKey) -> String {
    let Content::Value { form, unit, bounds, expected, .. } = &key.content else { return "a table".into() };
    let unit = if unit.is_empty() { String::new() } else { format!(" \\[{unit}\\]") };
    let bounds = match bounds {
        (Bound::Unbounded, Bound::Unbounded) => String::new(),
        (low, high) if *form != Form::Whole => format!(", {}", describe_bounds(*low, *high)),
        _ => String::new(),
    };
    match form {
        Form::Choice(words) => {
            words.iter().map(|(word, _)| format!("`{word}`")).collect::<Vec<_>>().join(", ")
        }
        _ => format!("{expected}{unit}{bounds}"),
    }
}

/// Text in a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
