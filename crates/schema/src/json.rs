//! The JSON Schema of tables (draft 7, with `definitions`), with which editors complete and check while one types.

use super::{By, Content, DescribedKey, DescribedTable, DescribedVariants, Form, Presence};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::ops::Bound;

/// A number with a unit: units that are known, with prefixes and powers, in products and quotients.
const QUANTITY: &str = concat!(
    r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*(1\s*/\s*)?",
    r"((G|M|k|c|m|u|µ|n)?(kg|deg|°|rad|rpm|Hz|Pa|N|m|s|g|%)(\^?[0-9]+|[²³⁴])?\s*[*·/ ]?\s*)*$",
);

/// The JSON Schema of a table, called `title`.
pub fn json_schema(title: &str, table: &DescribedTable) -> Value {
    let mut definitions = Map::new();
    definitions.insert(
        "quantity".into(),
        json!({ "type": "string", "pattern": QUANTITY, "description": "A number with a unit, such as \"1 mm\"" }),
    );
    let mut root = object(table, "", &mut definitions);
    root["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    root["title"] = json!(title);
    root["definitions"] = Value::Object(definitions);
    root
}

/// A table at `path`: its keys, those that must be there, and no other. The tables in it become definitions.
fn object(table: &DescribedTable, path: &str, definitions: &mut Map<String, Value>) -> Value {
    let mut properties = Map::new();
    let mut all = json!({ "type": "object", "description": table.doc });
    for key in &table.keys {
        properties.insert(key.name.clone(), property(key, path, definitions));
    }
    let mut conditions = Vec::new();
    for variants in &table.variants {
        if let By::Tag(tag) = variants.by {
            let words =
                variants.each.iter().map(|(word, doc, _)| json!({ "const": word, "description": doc }));
            properties.insert(tag.into(), json!({ "oneOf": words.collect::<Vec<_>>() }));
        }
        for key in variants.each.iter().flat_map(|(_, _, keys)| &keys.keys) {
            if !properties.contains_key(&key.name) {
                let value = property(key, path, definitions);
                properties.insert(key.name.clone(), value);
            }
        }
        conditions.push(json!({ "oneOf": branches(variants) }));
    }
    all["required"] = json!(required(&table.keys));
    all["properties"] = Value::Object(properties);
    all["additionalProperties"] = match &table.free {
        Some(key) => property(key, path, definitions),
        None => json!(false),
    };
    if !conditions.is_empty() {
        all["allOf"] = json!(conditions);
    }
    all
}

/// One schema for each variant: its word, the keys that it must have, and none of the others'.
fn branches(variants: &DescribedVariants) -> Vec<Value> {
    let every: BTreeSet<&str> = variants.each.iter().flat_map(|(_, _, keys)| names(keys)).collect();
    let branch = |(k, (word, _, keys)): (usize, &(&'static str, String, DescribedTable))| {
        let own: BTreeSet<&str> = names(keys).collect();
        let mut properties: Map<String, Value> =
            every.difference(&own).map(|name| (name.to_string(), json!(false))).collect();
        let mut required: Vec<&str> = required(&keys.keys);
        match variants.by {
            By::Tag(tag) => {
                properties.insert(tag.into(), json!({ "const": word }));
                if variants.default != Some(k) {
                    required.push(tag);
                }
            }
            By::Presence if variants.default != Some(k) && !required.contains(word) => required.push(word),
            By::Presence => {}
        }
        json!({ "required": required, "properties": properties })
    };
    variants.each.iter().enumerate().map(branch).collect()
}

fn names(table: &DescribedTable) -> impl Iterator<Item = &str> {
    table.keys.iter().map(|key| key.name.as_str())
}

fn required(keys: &[DescribedKey]) -> Vec<&str> {
    let must = |key: &&DescribedKey| match &key.content {
        Content::Value { required, .. } => *required,
        Content::Table(presence, _) => matches!(presence, Presence::Required(_)),
    };
    keys.iter().filter(must).map(|key| key.name.as_str()).collect()
}

/// JSON Schema of the value of a key.
fn property(key: &DescribedKey, path: &str, definitions: &mut Map<String, Value>) -> Value {
    let path = if path.is_empty() { key.name.clone() } else { format!("{path}.{}", key.name) };
    match &key.content {
        Content::Value { form, unit, bounds, default, expected, .. } => {
            let mut value = of_form(form, *bounds);
            let unit = if unit.is_empty() { String::new() } else { format!(" Unit: {unit}.") };
            let default = default.as_ref().map_or(String::new(), |default| format!(" Default: {default}."));
            let doc = if key.doc.is_empty() { expected } else { &key.doc };
            value["description"] = json!(format!("{doc}{unit}{default}"));
            value
        }
        Content::Table(presence, table) => {
            let table = object(table, &path, definitions);
            definitions.insert(path.clone(), table);
            let one = json!({ "$ref": format!("#/definitions/{path}") });
            match presence {
                Presence::Named => {
                    json!({ "type": "object", "description": key.doc, "additionalProperties": one })
                }
                _ => one,
            }
        }
    }
}

fn of_form(form: &Form, bounds: (Bound<f64>, Bound<f64>)) -> Value {
    let number = |kind: &str| {
        let mut number = json!({ "type": kind });
        match bounds.0 {
            Bound::Included(v) => number["minimum"] = json!(v),
            Bound::Excluded(v) => number["exclusiveMinimum"] = json!(v),
            Bound::Unbounded => {}
        }
        match bounds.1 {
            Bound::Included(v) => number["maximum"] = json!(v),
            Bound::Excluded(v) => number["exclusiveMaximum"] = json!(v),
            Bound::Unbounded => {}
        }
        number
    };
    match form {
        Form::Quantity => json!({ "anyOf": [number("number"), { "$ref": "#/definitions/quantity" }] }),
        Form::Whole => {
            let mut whole = number("integer");
            if whole.get("minimum").is_none() {
                whole["minimum"] = json!(0);
            }
            whole
        }
        Form::Flag => json!({ "type": "boolean" }),
        Form::Text => json!({ "type": "string" }),
        Form::Choice(words) => {
            let each =
                words.iter().map(|(word, doc)| json!({ "const": word, "description": super::plain(doc) }));
            json!({ "oneOf": each.collect::<Vec<_>>() })
        }
        Form::List(entry, count) => {
            let mut list = json!({ "type": "array", "items": of_form(entry, bounds) });
            if let Some(count) = count {
                list["minItems"] = json!(count);
                list["maxItems"] = json!(count);
            }
            list
        }
        Form::Either(a, b) => json!({ "anyOf": [of_form(a, bounds), of_form(b, bounds)] }),
    }
}
