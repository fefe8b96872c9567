//! The reference of keys and the JSON Schema of the guide. The schema itself is tested by python/tests/test_schema.py.

use std::path::Path;
use stridor::case::Case;
use stridor::schema::{describe, json_schema, key_reference};

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
