//! Keywords with their options and lines of data, in the order in which they stand once files are included.

use crate::deck::Place;
use crate::text::Files;
use std::path::{Path, PathBuf};
use stridor_base::error::{Error, Fault, Result};

/// An input file with all that it includes.
#[derive(Debug, Default)]
pub(super) struct Blocks {
    /// Texts of the files.
    texts: Vec<String>,
    /// The blocks in their order.
    pub blocks: Vec<Block>,
    /// Lines before the first keyword.
    pub before: Vec<Place>,
}

/// A keyword, its options and its lines of data.
#[derive(Debug)]
pub(super) struct Block {
    /// Capitals without blanks: `SOLIDSECTION`.
    pub keyword: String,
    /// Options in their order.
    pub options: Vec<BlockOption>,
    /// Lines of data, those of comments and blank ones left out.
    lines: Vec<Line>,
    /// Where the keyword stands.
    pub place: Place,
}

/// An option of a keyword.
#[derive(Debug)]
pub(super) struct BlockOption {
    /// Capitals without blanks.
    pub name: String,
    /// What stands behind the equals sign, without quotation marks; empty without one.
    pub value: String,
}

/// A line of data.
#[derive(Debug, Clone, Copy)]
struct Line {
    place: Place,
    start: usize,
    end: usize,
}

/// The most files that are read: each may include others.
const MOST_FILES: usize = 10_000;
/// The most bytes of all of them: a file may be included many times.
const MOST_BYTES: usize = 16 << 30;

impl Block {
    /// The value of an option.
    pub fn option(&self, name: &str) -> Option<&str> {
        self.options.iter().find(|option| option.name == name).map(|option| option.value.as_str())
    }

    /// Whether an option is there, with or without a value.
    pub fn has(&self, name: &str) -> bool {
        self.options.iter().any(|option| option.name == name)
    }

    /// The number of its lines of data.
    pub fn n_lines(&self) -> usize {
        self.lines.len()
    }
}

impl Blocks {
    /// Reads a file and all that it includes.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(path: &Path, files: &mut Files) -> Result<Blocks> {
        let mut reader = Reader { all: Blocks::default(), bytes: 0, open: Vec::new(), complete: true };
        reader.file(path, files)?;
        Ok(reader.all)
    }

    /// The lines of data of a block with their places.
    pub fn lines<'a>(&'a self, block: &'a Block) -> impl Iterator<Item = (Place, &'a str)> + Clone {
        block
            .lines
            .iter()
            .map(|line| (line.place, &self.texts[line.place.file as usize][line.start..line.end]))
    }
}

struct Reader {
    all: Blocks,
    bytes: usize,
    /// The files that are being read, from the first to the innermost.
    open: Vec<PathBuf>,
    /// Whether the last line of options does not go on in the next one.
    complete: bool,
}

impl Reader {
    fn file(&mut self, path: &Path, files: &mut Files) -> Result<()> {
        let (number, text) = files.read(path)?;
        self.bytes += text.len();
        if number as usize >= MOST_FILES || self.bytes > MOST_BYTES {
            let found = format!("{} files of {} bytes in all", number + 1, self.bytes);
            let expected = format!("at most {MOST_FILES} files and {} GiB", MOST_BYTES >> 30);
            return Err(Error::input(Fault::new(path.display().to_string(), found, expected)));
        }
        self.open.push(path.canonicalize().unwrap_or_else(|_| path.to_path_buf()));
        self.all.texts.push(String::new());
        let mut start = 0;
        for (line, whole) in text.split_inclusive('\n').enumerate() {
            let begin = start;
            start += whole.len();
            let place = Place { file: number, line: 1 + line as u32 };
            let trimmed = whole.trim();
            if trimmed.is_empty() || trimmed.starts_with("**") {
                continue;
            }
            if !self.complete {
                if let Some(block) = self.all.blocks.last_mut() {
                    block.options.extend(options(trimmed));
                }
                self.complete = !trimmed.ends_with(',');
            } else if let Some(words) = trimmed.strip_prefix('*') {
                let mut parts = split(words);
                let keyword = capitals(parts.next().unwrap_or_default());
                let block =
                    Block { keyword, options: parts.filter_map(option).collect(), lines: Vec::new(), place };
                self.complete = !trimmed.ends_with(',');
                self.all.blocks.push(block);
            } else {
                let from = begin + whole.len() - whole.trim_start().len();
                let line = Line { place, start: from, end: from + trimmed.len() };
                match self.all.blocks.last_mut() {
                    Some(block) => block.lines.push(line),
                    // What other programs write above it.
                    None => self.all.before.push(place),
                }
            }
            if self.complete && self.all.blocks.last().is_some_and(|block| block.keyword == "INCLUDE") {
                // What stands in the file belongs to the block before, as if it stood here.
                let include = self.all.blocks.pop().expect("there is one");
                self.include(&include, path, files)?;
            }
            if files.too_many() {
                break;
            }
        }
        self.all.texts[number as usize] = text;
        self.complete = true;
        self.open.pop();
        Ok(())
    }

    fn include(&mut self, block: &Block, from: &Path, files: &mut Files) -> Result<()> {
        let Some(name) = block.option("INPUT").filter(|name| !name.is_empty()) else {
            files.fault(block.place, "*INCLUDE without a file", "*INCLUDE, INPUT=file");
            return Ok(());
        };
        let path = from.parent().unwrap_or(Path::new("")).join(name.replace('\\', "/"));
        let whole = path.canonicalize().unwrap_or_else(|_| path.clone());
        if self.open.contains(&whole) {
            files.fault(
                block.place,
                format!("*INCLUDE of \"{name}\", which is being read"),
                "files that do not include themselves",
            );
            return Ok(());
        }
        match self.file(&path, files) {
            Ok(()) => Ok(()),
            Err(Error::Input(faults)) if !path.exists() => {
                let found =
                    format!("*INCLUDE of \"{name}\": {}", faults.0.first().map_or("", |fault| &fault.found));
                files.fault(block.place, found, "a file beside this one");
                Ok(())
            }
            Err(error) => Err(error),
        }
    }
}

/// What stands between commas outside of quotation marks, without blanks around.
pub(super) fn split(text: &str) -> impl Iterator<Item = &str> {
    let mut quoted = false;
    text.split(move |c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    })
    .map(str::trim)
}

fn options(text: &str) -> impl Iterator<Item = BlockOption> {
    split(text).filter_map(option)
}

fn option(text: &str) -> Option<BlockOption> {
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let name = capitals(name);
    (!name.is_empty()).then(|| BlockOption { name, value: unquoted(value).to_string() })
}

/// A name without blanks around and without quotation marks.
pub(super) fn unquoted(text: &str) -> &str {
    text.trim().trim_matches('"').trim()
}

/// Capitals without blanks, in which names and keywords are compared.
fn capitals(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_uppercase).collect()
}

/// The beginning of a line, for messages.
pub(super) fn short(text: &str) -> &str {
    text.char_indices().nth(40).map_or(text, |(end, _)| &text[..end])
}
