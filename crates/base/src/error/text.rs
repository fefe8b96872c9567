//! Text of the input as messages show it.

/// The most characters of one piece of the input that a message shows.
const PIECE: usize = 80;
/// The most characters of one phrase of a message.
const PHRASE: usize = 800;

/// `text` with the characters that steer a terminal, turn the direction of writing or are not seen as `\u{…}`.
pub fn printable(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() || is_unseen(c) { safe.extend(c.escape_debug()) } else { safe.push(c) }
    }
    safe
}

/// [`printable`] line by line.
pub fn printable_lines(text: &str) -> String {
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

/// `words` with a capital letter at the beginning.
pub fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Format characters of Unicode: marks of direction, joiners, separators, tags.
fn is_unseen(c: char) -> bool {
    matches!(
        c,
        '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}'
    )
}

/// A phrase of a message: printable, what it quotes and its words cut in the middle, and all cut at the end.
pub(super) fn phrase(text: &str) -> String {
    let whole = cut_pieces(text, true);
    match whole.char_indices().nth(PHRASE) {
        Some((end, _)) => format!("{}…", &whole[..end]),
        None => whole,
    }
}

/// The place of a fault: printable, what it quotes cut in the middle; the path of a file stays whole.
pub(super) fn place(text: &str) -> String {
    cut_pieces(text, false)
}

/// Cuts what stands between quotation marks or back-ticks and, if `words`, words outside of them.
fn cut_pieces(text: &str, words: bool) -> String {
    let text = printable(text);
    let mut rest = text.as_str();
    let mut whole = String::with_capacity(rest.len());
    while !rest.is_empty() {
        let quoted = rest.find(['"', '`']).and_then(|start| {
            let mark = rest[start..].chars().next()?;
            Some((start, start + 1 + rest[start + 1..].find(mark)?))
        });
        let (start, end) = quoted.unwrap_or((rest.len(), rest.len()));
        for word in rest[..start].split_inclusive(' ') {
            whole += &if words { cut(word) } else { word.to_string() };
        }
        if start < end {
            let mark = &rest[start..=start];
            whole += &format!("{mark}{}{mark}", cut(&rest[start + 1..end]));
        }
        rest = rest.get(end + 1..).unwrap_or("");
    }
    whole
}

/// `text` with `…` in the place of its middle when it has more than [`PIECE`] characters.
fn cut(text: &str) -> String {
    let count = text.chars().count();
    if count <= PIECE {
        return text.to_string();
    }
    let head: String = text.chars().take(PIECE / 2).collect();
    let tail: String = text.chars().skip(count + 1 + PIECE / 2 - PIECE).collect();
    format!("{head}…{tail}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_quoted_is_cut_in_the_middle_on_whole_characters() {
        let long: String = "ä".repeat(5000) + " m";
        let text = phrase(&format!("\"{long}\", a unit of another dimension"));
        let (_, quoted) = text.split_once('"').unwrap();
        let (quoted, rest) = quoted.split_once('"').unwrap();
        assert_eq!(quoted.chars().count(), PIECE);
        assert!(quoted.starts_with("ää") && quoted.contains('…') && quoted.ends_with("ä m"), "{quoted}");
        assert_eq!(rest, ", a unit of another dimension");
        // Without quotation marks, with only one of them, and many short ones.
        assert_eq!(phrase(&"7".repeat(900)).chars().count(), PIECE);
        assert!(phrase(&format!("\"{}", "7".repeat(900))).chars().count() <= PIECE);
        assert_eq!(phrase(&"\"7\" ".repeat(900)).chars().count(), PHRASE + 1);
        assert_eq!(phrase("\"1 mm\", a `key`"), "\"1 mm\", a `key`");
    }

    #[test]
    fn paths_stay_whole_and_keys_are_cut() {
        let path = format!("/{}/rig.toml:3", "folder/".repeat(40));
        let shown = place(&format!("{path} `contact.{}.stiffness`", "x".repeat(500)));
        assert!(shown.starts_with(&path), "{shown}");
        assert!(shown.contains("`contact.x") && shown.ends_with("x.stiffness`"), "{shown}");
        assert!(shown.chars().count() < path.len() + 4 + PIECE);
    }

    #[test]
    fn nothing_steers_the_terminal() {
        let shown = printable("a\u{1b}[31mb\u{202e}c\r\n\u{7}\u{9b}\u{200d}é\u{301}");
        assert_eq!(shown, "a\\u{1b}[31mb\\u{202e}c\\r\\n\\u{7}\\u{9b}\\u{200d}é\u{301}");
        assert_eq!(printable_lines("a\n\u{1b}b\n"), "a\n\\u{1b}b\n");
    }
}
