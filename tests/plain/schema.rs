//! The JSON Schema of case files against a validator of its own: it takes every case of the validation suite, and refuses what the
//! program refuses of keys and types.

use serde_json::Value;
use std::path::{Path, PathBuf};
use stridor::case::Case;
use stridor::schema::{describe, json_schema, key_reference};

fn schema() -> Value {
    json_schema("A case of stridor", &describe::<Case>())
}

fn toml_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            toml_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "toml") {
            found.push(path);
        }
    }
}

/// The cases of the validation suite that the program reads, with their texts.
fn cases() -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    toml_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("validation"), &mut files);
    files.sort();
    let text = |path: PathBuf| (path.clone(), std::fs::read_to_string(path).unwrap());
    let is_case = |(_, text): &(PathBuf, String)| Case::parse("case", text, PathBuf::new()).is_ok();
    files.into_iter().map(text).filter(is_case).collect()
}

fn json(text: &str) -> Value {
    serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap()
}

#[test]
fn every_case_of_the_suite_is_valid_as_written_and_as_resolved() {
    let validator = jsonschema::draft7::new(&schema()).unwrap();
    let cases = cases();
    assert!(cases.len() > 60, "{}", cases.len());
    let mut faults = Vec::new();
    for (path, text) in &cases {
        let resolved = Case::parse("case", text, PathBuf::new()).unwrap().to_toml();
        for text in [text, &resolved] {
            let document = json(text);
            let of_case = validator.iter_errors(&document);
            faults.extend(of_case.map(|e| format!("{}: {}: {e}", path.display(), e.instance_path)));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Every place of a document with a key, as a JSON pointer.
fn places(value: &Value, at: &str, all: &mut Vec<String>) {
    if let Value::Object(table) = value {
        for (key, inner) in table {
            let at = format!("{at}/{}", key.replace('~', "~0").replace('/', "~1"));
            places(inner, &at, all);
            all.push(at);
        }
    }
}

/// Misspells every key and gives every key a table with an odd key: what the program refuses, the schema refuses, unless it is
/// about names, which no schema knows.
#[test]
fn keys_that_are_misspelt_or_of_another_type_are_refused() {
    let validator = jsonschema::draft7::new(&schema()).unwrap();
    let (mut refused, mut tried, mut wrong_ones) = (0, 0, Vec::new());
    for (path, text) in cases() {
        let sound = json(&text);
        let mut all = Vec::new();
        places(&sound, "", &mut all);
        for at in all {
            let (parent, key) = at.rsplit_once('/').unwrap();
            let mut wrong = sound.clone();
            let table = wrong.pointer_mut(parent).unwrap().as_object_mut().unwrap();
            let key = key.replace("~1", "/").replace("~0", "~");
            let value = table.remove(&key).unwrap();
            table.insert(format!("{key}zz"), value);
            let mut other = sound.clone();
            *other.pointer_mut(&at).unwrap() = serde_json::json!({ "zz": true });
            for wrong in [wrong, other] {
                let text = toml::to_string(&wrong).unwrap();
                let Err(error) = Case::parse("case", &text, PathBuf::new()) else {
                    if !validator.is_valid(&wrong) {
                        wrong_ones.push(format!("{} {at} is a case", path.display()));
                    }
                    continue;
                };
                tried += 1;
                let error = error.to_string();
                let of_schema = error.contains("an unknown key") || error.contains("found a table");
                let valid = validator.is_valid(&wrong);
                if of_schema && valid {
                    wrong_ones.push(format!("{} {at}: {error}", path.display()));
                }
                refused += usize::from(!valid);
            }
        }
    }
    assert!(
        wrong_ones.is_empty(),
        "{} of {tried}: {:#?}",
        wrong_ones.len(),
        wrong_ones.iter().take(20).collect::<Vec<_>>()
    );
    println!("{refused} of {tried} wrong cases are refused by the schema");
    assert!(tried > 1000 && refused * 10 > tried * 9, "{refused} of {tried}");
}

#[test]
fn wrong_values_are_refused() {
    let validator = jsonschema::draft7::new(&schema()).unwrap();
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/validation/wrong-files/keys.toml"));
    let faults: Vec<String> =
        validator.iter_errors(&json(&text.unwrap())).map(|e| e.instance_path.to_string()).collect();
    for place in
        ["/material/steel/poissons_ratio", "/material/steel/density", "/shell/strip", "/modes/strip/count"]
    {
        assert!(faults.iter().any(|fault| fault == place), "{place}: {faults:?}");
    }
}

/// The files of the guide are what the program prints today.
#[test]
fn the_guide_has_the_schema_and_the_keys() {
    let guide = Path::new(env!("CARGO_MANIFEST_DIR")).join("guide");
    let all = describe::<Case>();
    let keys = format!("# Keys of a case file\n\n{}\n", key_reference(&all).trim_end());
    for (file, command, expected) in [
        ("case.schema.json", "stridor schema", format!("{:#}\n", json_schema("A case of stridor", &all))),
        ("src/keys.md", "stridor schema --markdown", keys),
    ] {
        let found = std::fs::read_to_string(guide.join(file)).unwrap_or_default();
        assert!(found == expected, "guide/{file} is not what `{command}` prints: regenerate it");
    }
}
