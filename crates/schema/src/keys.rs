//! Names, and paths of scalars: keys joined by dots; a name that has dots itself stands in quotes, as in TOML.

use std::borrow::Cow;

/// `key` as it stands in a path.
pub fn dotted(key: &str) -> Cow<'_, str> {
    match key.is_empty() || key.contains(['.', '"', '\\']) {
        true => Cow::Owned(format!("\"{}\"", key.replace('\\', "\\\\").replace('"', "\\\""))),
        false => Cow::Borrowed(key),
    }
}

/// A name: at least one character, none of them for control.
pub fn is_name(name: &str) -> bool {
    !name.is_empty() && !name.contains(char::is_control)
}

/// The keys of `path`.
pub fn keys_of(path: &str) -> Vec<String> {
    let mut keys = Vec::new();
    let mut rest = Some(path);
    while let Some(path) = rest {
        let (key, after) = first_key(path);
        keys.push(key);
        rest = after.strip_prefix('.');
    }
    keys
}

/// The first key of a path, and what follows it.
fn first_key(path: &str) -> (String, &str) {
    let Some(quoted) = path.strip_prefix('"') else {
        let end = path.find('.').unwrap_or(path.len());
        return (path[..end].to_string(), &path[end..]);
    };
    let mut key = String::new();
    let mut chars = quoted.char_indices();
    while let Some((at, c)) = chars.next() {
        match c {
            '"' => return (key, &quoted[at + 1..]),
            '\\' => key.extend(chars.next().map(|(_, escaped)| escaped)),
            c => key.push(c),
        }
    }
    (key, "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_a_path_come_back() {
        for name in ["rim", "a.b", "é", "a b", "say \"no\"", "back\\slash", "", "0", "'", "\"", "a.\\"] {
            let path = format!("contact.{}.load.2", dotted(name));
            assert_eq!(keys_of(&path), ["contact", name, "load", "2"], "{path}");
        }
        assert_eq!((keys_of("contact.a b.load").len(), keys_of("a.\"b.c").len()), (3, 2));
    }
}
