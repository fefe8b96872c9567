//! Sentences in lines of the width of a terminal.

/// The widest line of a sentence.
const WIDTH: usize = 100;

/// Lines of at most [`WIDTH`] columns, or of `width` where that is less, indented by one.
pub(super) fn wrap(text: &str, width: Option<usize>) -> String {
    let width = width.unwrap_or(WIDTH).min(WIDTH) - 1;
    wrapped(text, width).iter().map(|line| format!(" {line}\n")).collect()
}

/// The words of `text` in lines of at most `width` columns; longer words are broken.
pub(super) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let letters: Vec<char> = word.chars().collect();
        for piece in letters.chunks(width) {
            let line = lines.last_mut().expect("there is one");
            let joined = !line.is_empty() && length(line) + 1 + piece.len() <= width;
            if joined {
                line.push(' ');
            }
            match joined || line.is_empty() {
                true => line.extend(piece),
                false => lines.push(piece.iter().collect()),
            }
        }
    }
    lines
}

/// The columns that a text takes.
pub(super) fn length(text: &str) -> usize {
    text.chars().count()
}
