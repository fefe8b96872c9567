//! Numbers one after the other, from text or binary, each with the place it came from.

use stridor_base::error::{Error, Fault, Result};
use stridor_base::numbers;

/// How numbers are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Words between white space.
    Ascii,
    /// Four-byte integers and eight-byte floats, lowest byte first.
    LittleEndian,
    /// The same, highest byte first.
    BigEndian,
}

/// Reads a file from front to back.
pub(super) struct ByteReader<'a> {
    bytes: &'a [u8],
    at: usize,
    pub encoding: Encoding,
    place: &'a str,
}

/// `line 12` of a text file or `byte 345` of a binary one.
fn position(bytes: &[u8], at: usize, encoding: Encoding) -> String {
    match encoding {
        Encoding::Ascii => {
            let before = &bytes[..at.min(bytes.len())];
            format!("line {}", 1 + before.iter().filter(|b| **b == b'\n').count())
        }
        _ => format!("byte {at}"),
    }
}

impl<'a> ByteReader<'a> {
    pub fn new(bytes: &'a [u8], at: usize, encoding: Encoding, place: &'a str) -> Self {
        ByteReader { bytes, at, encoding, place }
    }

    /// How many bytes are left: no count of things can be larger.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// How many bytes lie behind.
    pub fn offset(&self) -> usize {
        self.at
    }

    /// The file and the current position in it.
    pub fn place(&self) -> String {
        format!("{}, {}", self.place, position(self.bytes, self.at, self.encoding))
    }

    /// A fault at the current position.
    pub fn wrong(&self, found: impl Into<String>, expected: impl Into<String>) -> Error {
        Error::input(Fault::new(self.place(), found, expected))
    }

    fn skip_space(&mut self) {
        let space = self.bytes[self.at..].iter().take_while(|b| b.is_ascii_whitespace()).count();
        self.at += space;
    }

    /// The next word; empty at the end of the file.
    pub fn word(&mut self) -> &'a str {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(rest.len());
        self.at += length;
        std::str::from_utf8(&rest[..length]).unwrap_or("(bytes that are not UTF-8)")
    }

    /// Leaves the line: binary numbers begin after its end.
    pub fn end_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|b| *b == b'\n').map_or(rest.len(), |n| n + 1);
    }

    /// Expects the line of a text to be over: each thing has lines of its own.
    pub fn line_is_over(&mut self, what: &str) -> Result<()> {
        if self.encoding != Encoding::Ascii {
            return Ok(());
        }
        match self.at_line_end() {
            true => Ok(()),
            false => Err(self.wrong(format!("more in the line of {what}"), "the end of the line")),
        }
    }

    /// Leaves the section `name`, whose content is of no interest.
    pub fn skip_section(&mut self, name: &str) -> Result<()> {
        let end = format!("$End{name}");
        match self.bytes[self.at..].windows(end.len()).position(|w| w == end.as_bytes()) {
            Some(n) => {
                self.at += n + end.len();
                Ok(())
            }
            None => Err(self.wrong("the end of the file", format!("`{end}`: the file is cut off"))),
        }
    }

    /// Expects `word` next.
    pub fn expect(&mut self, word: &str) -> Result<()> {
        let found = self.word();
        if found == word { Ok(()) } else { Err(self.wrong(shown(found), format!("`{word}`"))) }
    }

    /// A word that is a whole number, whatever the encoding.
    pub fn text_number<T: TryFrom<i128>>(&mut self, what: &str) -> Result<T> {
        let word = self.word();
        let number = word.parse::<i128>().ok().and_then(|number| T::try_from(number).ok());
        number.ok_or_else(|| self.wrong(shown(word), format!("a number, the {what}")))
    }

    /// Whether the line of a text is over.
    pub fn at_line_end(&self) -> bool {
        let rest = &self.bytes[self.at..];
        matches!(rest.iter().find(|b| !b.is_ascii_whitespace() || **b == b'\n'), None | Some(b'\n'))
    }

    /// Goes to the next line that begins with a `$`; what stands before it is a comment. Gives the word, empty at the end.
    pub fn section(&mut self) -> &'a str {
        loop {
            match self.word() {
                word if word.is_empty() || word.starts_with('$') => return word,
                _ => self.end_line(),
            }
        }
    }

    /// An integer.
    pub fn int(&mut self, what: &str) -> Result<i64> {
        match self.encoding {
            Encoding::Ascii => self.text_number(what),
            Encoding::LittleEndian => Ok(i64::from(i32::from_le_bytes(self.take(what)?))),
            Encoding::BigEndian => Ok(i64::from(i32::from_be_bytes(self.take(what)?))),
        }
    }

    /// A count or a tag of MSH 4.1, eight bytes where it is binary.
    pub fn size(&mut self, what: &str) -> Result<u64> {
        match self.encoding {
            Encoding::Ascii => self.text_number(what),
            Encoding::LittleEndian => Ok(u64::from_le_bytes(self.take(what)?)),
            Encoding::BigEndian => Ok(u64::from_be_bytes(self.take(what)?)),
        }
    }

    /// A floating-point number.
    pub fn float(&mut self, what: &str) -> Result<f64> {
        match self.encoding {
            Encoding::Ascii => {
                let word = self.word();
                numbers::parse(word).ok_or_else(|| self.wrong(shown(word), format!("a number, the {what}")))
            }
            Encoding::LittleEndian => Ok(f64::from_le_bytes(self.take(what)?)),
            Encoding::BigEndian => Ok(f64::from_be_bytes(self.take(what)?)),
        }
    }

    fn take<const N: usize>(&mut self, what: &str) -> Result<[u8; N]> {
        match self.bytes[self.at..].first_chunk() {
            Some(chunk) => {
                self.at += N;
                Ok(*chunk)
            }
            None => Err(self.wrong("the end of the file", format!("{what}: the file is cut off"))),
        }
    }
}

/// A word for a message.
fn shown(word: &str) -> String {
    match word {
        "" => "the end of the file".into(),
        _ => format!("`{}`", word.chars().take(40).collect::<String>().escape_debug()),
    }
}
