//! Colours of what is printed for people.

use clap::ColorChoice;
use std::io::IsTerminal;
use std::sync::OnceLock;

/// Codes of the terminal (ECMA-48, SGR).
pub const RED: &str = "\x1b[1;31m";
pub const BOLD: &str = "\x1b[1m";
const YELLOW: &str = "\x1b[1;33m";
const PLAIN: &str = "\x1b[0m";

/// What `--color` says.
static CHOICE: OnceLock<ColorChoice> = OnceLock::new();

/// Takes over what `--color` says, once.
pub fn choose(choice: ColorChoice) {
    let _ = CHOICE.set(choice);
}

/// Whether a stream gets colours: one that is asked for, or a terminal that takes them (`NO_COLOR` and `TERM=dumb` do not).
fn wanted(is_terminal: bool) -> bool {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    match CHOICE.get().copied().unwrap_or(ColorChoice::Auto) {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => {
            is_terminal && set("NO_COLOR").is_none() && set("TERM").is_none_or(|term| term != "dumb")
        }
    }
}

/// Whether stdout gets colours.
pub fn on_stdout() -> bool {
    wanted(std::io::stdout().is_terminal())
}

/// A word in a colour where stderr gets colours.
pub fn on_stderr(colour: &str, word: &str) -> String {
    if wanted(std::io::stderr().is_terminal()) { format!("{colour}{word}{PLAIN}") } else { word.to_string() }
}

/// Marked rows red, the word that begins a warning yellow, captions of tables bold.
pub fn of_lines(text: &str) -> String {
    let lines: Vec<&str> = text.split('\n').collect();
    let is_caption = |k: usize| lines.get(k + 2).is_some_and(|line| line.starts_with(" ─"));
    let coloured = |(k, line): (usize, &&str)| -> String {
        let bare = line.trim_start();
        let warning = ["Warning:", "warning:"].into_iter().find(|word| bare.starts_with(word));
        if let Some(word) = warning {
            let (blank, rest) = (&line[..line.len() - bare.len()], &bare[word.len()..]);
            return format!("{blank}{YELLOW}{word}{PLAIN}{rest}");
        }
        let colour = match line.starts_with('*') {
            true => RED,
            false if is_caption(k) && !bare.is_empty() => BOLD,
            false => return line.to_string(),
        };
        format!("{colour}{line}{PLAIN}")
    };
    lines.iter().enumerate().map(coloured).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_warnings_and_captions_stand_out_and_the_text_stays() {
        let text = "Modes\n no.  f\n ─────\n   1  2\n*  2  3\n Warning: thick\nwarning: none";
        let coloured = of_lines(text);
        let lines: Vec<&str> = coloured.lines().collect();
        assert_eq!(lines[0], "\x1b[1mModes\x1b[0m");
        assert_eq!(lines[1..4], [" no.  f", " ─────", "   1  2"]);
        assert_eq!(lines[4], "\x1b[1;31m*  2  3\x1b[0m");
        assert_eq!(lines[5], " \x1b[1;33mWarning:\x1b[0m thick");
        let plain = [RED, BOLD, YELLOW, PLAIN].iter().fold(coloured, |text, code| text.replace(code, ""));
        assert_eq!(plain, text);
    }
}
