//! Names in a case that name nothing.

use crate::schema::Report;

/// A fault where `name`, at `key`, is none of the `known` names of a kind.
pub(super) fn unknown_name(root: &mut Report, key: &str, name: &str, kind: &str, known: &[&str]) {
    let help = crate::error::nearest(name, known.iter().copied())
        .map_or(String::new(), |near| format!("Did you mean \"{near}\"?"));
    let list = if known.is_empty() { "none is defined".to_string() } else { known.join(", ") };
    root.fault(key, format!("\"{name}\""), format!("the name of a {kind} ({list})"), &help);
}
