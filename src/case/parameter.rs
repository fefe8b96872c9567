//! Every scalar of a case has a path, such as `contact.rim.friction.mu0`, and can be set to another value.

use super::Case;
use crate::error::{Error, Fault, Result, nearest};
use toml::Value;

impl Case {
    /// The same case with the scalar at `path` set to `value` \[SI\]; validated like a file.
    ///
    /// # Errors
    /// A path that is not a number of the case (with the nearest one that is), or a value that the case refuses.
    pub fn with_parameter(&self, path: &str, value: f64) -> Result<Case> {
        let mut table = Value::try_from(self).expect("a case can be written as TOML");
        let paths = self.parameters();
        let slot = path.split('.').try_fold(&mut table, |node, key| match node {
            Value::Array(list) => list.get_mut(key.parse::<usize>().ok()?),
            _ => node.get_mut(key),
        });
        match slot {
            Some(slot @ Value::Float(_)) => *slot = Value::Float(value),
            _ => {
                let near = nearest(path, paths.iter().map(|(p, _)| p.as_str()));
                let help =
                    near.map_or("`stridor check CASE` lists them".into(), |n| format!("Did you mean `{n}`?"));
                return Err(Error::input(
                    Fault::new(
                        format!("parameter `{path}`"),
                        "no such number in the case",
                        "the path of a scalar",
                    )
                    .with_help(help),
                ));
            }
        }
        let text = toml::to_string(&table).expect("a case can be written as TOML");
        Case::parse(&format!("{path} = {value}"), &text, self.folder.clone())
    }

    /// Path and value \[SI\] of every scalar of the case.
    pub fn parameters(&self) -> Vec<(String, f64)> {
        let mut found = Vec::new();
        walk(&Value::try_from(self).expect("a case can be written as TOML"), String::new(), &mut found);
        found
    }
}

/// Whether `text` is the pattern, in which every `*` stands for any letters, none included.
pub(crate) fn matches(pattern: &str, text: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == text,
        Some((head, tail)) => text.strip_prefix(head).is_some_and(|rest| {
            (0..=rest.len()).filter(|k| rest.is_char_boundary(*k)).any(|k| matches(tail, &rest[k..]))
        }),
    }
}

fn walk(value: &Value, path: String, found: &mut Vec<(String, f64)>) {
    let join = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
    match value {
        Value::Float(number) => found.push((path, *number)),
        Value::Table(table) => table.iter().for_each(|(key, v)| walk(v, join(key), found)),
        Value::Array(list) => list.iter().enumerate().for_each(|(i, v)| walk(v, join(&i.to_string()), found)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn patterns_match_as_people_expect() {
        assert!(matches("*", "contact.rim.load") && matches("contact.*.load", "contact.rim.load"));
        assert!(matches("*load*", "contact.rim.load") && !matches("contact.*.mu0", "contact.rim.load"));
        assert!(!matches("contact", "contact.rim.load") && matches("contact.rim.load", "contact.rim.load"));
        assert!(matches("**", "") && !matches("a*a", "a"));
    }
}
