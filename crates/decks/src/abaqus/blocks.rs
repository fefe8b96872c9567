//! Keywords with their options and lines of data, in the order in which they stand once files are included.

use crate::deck::Place;
use crate::text::Files;
use crate::written::lost;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use stridor_base::error::{Error, Result};

/// An input file with all that it includes.
#[derive(Debug, Default)]
pub(super) struct Blocks {
    /// Texts of the files.
    texts: Vec<Rc<str>>,
    /// The blocks in their order.
    pub blocks: Vec<Block>,
    /// Lines before the first keyword.
    pub before: Vec<Place>,
    /// What comments say that was not written, and why.
    pub lost: Vec<(String, String)>,
}

/// A keyword, its options and its lines of data.
#[derive(Debug)]
pub(super) struct Block {
    /// Capitals without blanks: `SOLIDSECTION`.
    pub keyword: String,
    /// The name that a comment above gives it.
    pub title: String,
    /// Options in their order.
    pub options: Vec<BlockOption>,
    /// Lines of data, those of comments and blank ones among them.
    spans: Vec<Span>,
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

/// Lines of a file that follow each other.
#[derive(Debug, Clone, Copy)]
struct Span {
    /// The first of them.
    place: Place,
    /// Bytes of the text.
    start: usize,
    end: usize,
}

/// The most files that are included, one that is included again among them.
const MOST_FILES: usize = 10_000;
/// The deepest that files are included in each other.
const MOST_DEPTH: usize = 64;
/// The most bytes that are read again because a file is included again \[byte\], beside as many as there are.
const MOST_AGAIN: usize = 1 << 20;

impl Block {
    /// The value of an option.
    pub fn option(&self, name: &str) -> Option<&str> {
        self.options.iter().find(|option| option.name == name).map(|option| option.value.as_str())
    }

    /// Whether an option is there, with or without a value.
    pub fn has(&self, name: &str) -> bool {
        self.options.iter().any(|option| option.name == name)
    }

    /// The bytes of its lines.
    pub fn n_bytes(&self) -> usize {
        let options = self.options.iter().map(|option| 2 + option.name.len() + option.value.len());
        let lines = self.spans.iter().map(|span| span.end - span.start);
        2 + self.keyword.len() + options.chain(lines).sum::<usize>()
    }
}

impl Blocks {
    /// Reads a file and all that it includes.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(path: &Path, files: &mut Files) -> Result<Blocks> {
        let mut reader = Reader {
            all: Blocks::default(),
            known: HashMap::new(),
            included: 0,
            again: 0,
            open: Vec::new(),
            complete: true,
        };
        let number = reader.number_of(path, files)?;
        reader.file(number, files)?;
        Ok(reader.all)
    }

    /// The lines of data of a block with their places.
    pub fn lines<'a>(&'a self, block: &'a Block) -> impl Iterator<Item = (Place, &'a str)> + Clone {
        block.spans.iter().flat_map(|span| {
            let Place { file, line } = span.place;
            let lines = self.texts[file as usize][span.start..span.end].split('\n').map(str::trim);
            let placed =
                lines.enumerate().map(move |(k, text)| (Place { file, line: line + k as u32 }, text));
            placed.filter(|(_, text)| !text.is_empty() && !text.starts_with("**"))
        })
    }

    /// The bytes of all files.
    pub fn n_bytes(&self) -> usize {
        self.texts.iter().map(|text| text.len()).sum()
    }
}

struct Reader {
    all: Blocks,
    /// Numbers of the files that were read, by their whole paths.
    known: HashMap<PathBuf, u32>,
    /// How many files were included.
    included: usize,
    /// Bytes of files that were included again.
    again: usize,
    /// Numbers of the files that are being read, from the first to the innermost.
    open: Vec<u32>,
    /// Whether the last line of options does not go on in the next one.
    complete: bool,
}

impl Reader {
    /// The number of a file, which is read if it is a new one.
    fn number_of(&mut self, path: &Path, files: &mut Files) -> Result<u32> {
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if let Some(number) = self.known.get(&whole) {
            self.again += self.all.texts[*number as usize].len();
            return Ok(*number);
        }
        let (number, text) = files.read(path)?;
        self.all.texts.push(text.into());
        self.known.insert(whole, number);
        Ok(number)
    }

    fn file(&mut self, number: u32, files: &mut Files) -> Result<()> {
        self.open.push(number);
        let text = self.all.texts[number as usize].clone();
        let mut start = 0;
        // Whether the last block goes on with the next line of data.
        let mut goes_on = false;
        let mut title = String::new();
        for (line, whole) in text.split_inclusive('\n').enumerate() {
            let begin = start;
            start += whole.len();
            let place = Place { file: number, line: 1 + line as u32 };
            let trimmed = whole.trim();
            if trimmed.is_empty() {
                continue;
            }
            if let Some(comment) = trimmed.strip_prefix("**") {
                title = title_in(comment).unwrap_or(title);
                self.all.lost.extend(lost(comment));
                continue;
            }
            if let Some(words) = trimmed.strip_prefix('*') {
                let mut parts = split(words);
                let keyword = capitals(parts.next().unwrap_or_default());
                let options = parts.filter_map(option).collect();
                let title = std::mem::take(&mut title);
                self.all.blocks.push(Block { keyword, title, options, spans: Vec::new(), place });
                self.complete = !trimmed.ends_with(',');
                goes_on = false;
            } else if !self.complete
                && !trimmed.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
            {
                if let Some(block) = self.all.blocks.last_mut() {
                    block.options.extend(split(trimmed).filter_map(option));
                }
                self.complete = !trimmed.ends_with(',');
            } else {
                // A number is no option: the comma above it was one too many.
                self.complete = true;
                match self.all.blocks.last_mut() {
                    Some(Block { spans, .. }) => match spans.last_mut().filter(|_| goes_on) {
                        Some(span) => span.end = start,
                        None => spans.push(Span { place, start: begin, end: start }),
                    },
                    // What other programs write above it.
                    None => self.all.before.push(place),
                }
                goes_on = true;
            }
            if self.complete && self.all.blocks.last().is_some_and(|block| block.keyword == "INCLUDE") {
                // What stands in the file belongs to the block before, as if it stood here.
                let include = self.all.blocks.pop().expect("there is one");
                self.include(&include, number, files)?;
                goes_on = false;
            }
            if files.too_many() {
                break;
            }
        }
        self.complete = true;
        self.open.pop();
        Ok(())
    }

    fn include(&mut self, block: &Block, from: u32, files: &mut Files) -> Result<()> {
        let Some(name) = block.option("INPUT").filter(|name| !name.is_empty()) else {
            files.fault(block.place, "*INCLUDE without a file", "*INCLUDE, INPUT=file");
            return Ok(());
        };
        // Beside the file that includes it, or beside the first one, where the programs look.
        let beside = |number: u32| {
            let folder = files.paths[number as usize].parent().unwrap_or(Path::new(""));
            folder.join(name.replace('\\', "/"))
        };
        let (near, first) = (beside(from), beside(0));
        let path = if !near.exists() && first.exists() { first } else { near };
        let number = match self.number_of(&path, files) {
            Ok(number) => number,
            Err(Error::Input(faults)) => {
                let found = faults.0.first().map_or("", |fault| &fault.found);
                let found = format!("*INCLUDE of \"{name}\": {found}");
                files.fault(block.place, found, "a text file beside this one");
                return Ok(());
            }
            Err(error) => return Err(error),
        };
        if self.open.contains(&number) {
            let found = format!("*INCLUDE of \"{name}\", which is being read");
            files.fault(block.place, found, "files that do not include themselves");
            return Ok(());
        }
        self.included += 1;
        let bytes = self.all.n_bytes();
        let too_many = [
            (self.included > MOST_FILES, format!("{} files that are included", self.included)),
            (self.open.len() >= MOST_DEPTH, format!("files included in each other {MOST_DEPTH} deep")),
            (
                self.again > bytes + MOST_AGAIN,
                format!("{bytes} bytes, and {} more of files that are included again", self.again),
            ),
        ];
        if let Some((_, found)) = too_many.into_iter().find(|(is, _)| *is) {
            let expected = format!(
                "at most {MOST_FILES} files, less than {MOST_DEPTH} deep, and few of them more than once"
            );
            files.fault(block.place, found, expected);
            return Err(Error::Input(std::mem::take(&mut files.faults)));
        }
        self.file(number, files)
    }
}

/// The name in a comment as Abaqus/CAE writes it: `Name: held Type: Displacement/Rotation`, `Interaction: rub`.
fn title_in(comment: &str) -> Option<String> {
    let comment = comment.trim();
    let name =
        comment.strip_prefix("Name: ").and_then(|rest| rest.split_once(" Type: ")).map(|(name, _)| name);
    Some(name.or_else(|| comment.strip_prefix("Interaction: "))?.trim().to_string())
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

/// Options that old decks abbreviate.
const ABBREVIATED: [(&str, &str); 2] = [("GEN", "GENERATE"), ("PERT", "PERTURBATION")];

fn option(text: &str) -> Option<BlockOption> {
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let mut name = capitals(name);
    if let Some((_, whole)) = ABBREVIATED.iter().find(|(short, _)| *short == name) {
        name = (*whole).to_string();
    }
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
