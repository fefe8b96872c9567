//! The guide in `guide/src`: every command in it runs, every case in it is a case, and what it says is printed is printed.
//!
//! The blocks of a chapter run in order in a folder of their own, by what stands behind the three backquotes:
//!
//! * `sh`: commands, which must succeed; with `fails`, which must end with exit code 2;
//! * `text`: lines that the commands before it printed, in this order; `…` stands for any lines between; with `example`, lines that
//!   depend on the release of another program, or commands that are not for the test;
//! * `toml,file=NAME` (or any other language): the content of a file; with `append=NAME`, more of it;
//! * `python`: a script, which must succeed; with `package`, one of the Python package, which `.ci/python` runs.
//!
//! Chapters that need Gmsh are run by `.ci/guide`, which installs it.

use crate::python;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn guide() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("guide/src")
}

/// The chapters with their texts.
fn chapters() -> Vec<(String, String)> {
    let files = std::fs::read_dir(guide()).expect("guide/src");
    let mut found: Vec<_> = files
        .map(|file| file.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .map(|path| {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            (name, std::fs::read_to_string(path).expect("a text"))
        })
        .collect();
    found.sort();
    found
}

/// A fenced block of a chapter: what stands behind the backquotes, the line it begins at, its text.
struct Block {
    info: String,
    line: usize,
    text: String,
}

fn blocks(chapter: &str) -> Vec<Block> {
    let (mut found, mut open) = (Vec::new(), None::<Block>);
    for (i, line) in chapter.lines().enumerate() {
        match (line.strip_prefix("```"), open.take()) {
            (Some(_), Some(block)) => found.push(block),
            (Some(info), None) => open = Some(Block { info: info.into(), line: i + 1, text: String::new() }),
            (None, Some(mut block)) => {
                block.text += line;
                block.text.push('\n');
                open = Some(block);
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a block does not end");
    found
}

/// A run of a chapter: its folder and what the last commands printed.
struct Reader {
    folder: TempDir,
    printed: String,
    python: Option<PathBuf>,
}

impl Reader {
    fn new() -> Self {
        Reader { folder: TempDir::new().expect("a temporary folder"), printed: String::new(), python: None }
    }

    /// Does what the block says; its fault, if any.
    fn follow(&mut self, block: &Block) -> Result<(), String> {
        let mut words = block.info.split(',');
        let language = words.next().unwrap_or_default();
        let options: Vec<&str> = words.collect();
        let file = |key: &str| options.iter().find_map(|o| o.strip_prefix(key));
        match (language, file("file="), file("append=")) {
            (_, Some(name), _) => self.write(name, &block.text, false),
            (_, _, Some(name)) => self.write(name, &block.text, true),
            ("sh", ..) => {
                self.run("bash", &["-euo", "pipefail", "-c", &block.text], options.contains(&"fails"))
            }
            ("text", ..) if options.contains(&"example") => Ok(()),
            ("text", ..) => self.shown(&block.text),
            ("python", ..) if options.contains(&"package") => Ok(()),
            ("python", ..) => {
                let python = self.python.get_or_insert_with(|| python::with(&python::XARRAY)).clone();
                self.run(&python.to_string_lossy(), &["-c", &block.text], false)
            }
            // Equations.
            ("", ..) => Ok(()),
            (other, ..) => Err(format!("a block of `{other}` without file=NAME or append=NAME runs nowhere")),
        }
    }

    fn write(&self, name: &str, text: &str, more: bool) -> Result<(), String> {
        let path = self.folder.path().join(name);
        let before = if more {
            std::fs::read_to_string(&path).map_err(|e| e.to_string())? + "\n"
        } else {
            String::new()
        };
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(|e| e.to_string())?;
        }
        std::fs::write(path, before + text).map_err(|e| e.to_string())
    }

    fn run(&mut self, program: &str, arguments: &[&str], fails: bool) -> Result<(), String> {
        let stridor = Path::new(env!("CARGO_BIN_EXE_stridor")).parent().expect("a folder").to_path_buf();
        let before = std::env::var_os("PATH").unwrap_or_default();
        let path = std::env::join_paths([stridor].into_iter().chain(std::env::split_paths(&before)));
        let done = Command::new(program)
            .args(arguments)
            .current_dir(self.folder.path())
            .env("PATH", path.map_err(|e| e.to_string())?)
            .output()
            .map_err(|e| format!("{program}: {e}"))?;
        let all = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        self.printed = all(&done.stdout) + &all(&done.stderr);
        let expected = if fails { 2 } else { 0 };
        match done.status.code() == Some(expected) {
            true => Ok(()),
            false => Err(format!("{}, not exit code {expected}:\n{}", done.status, self.printed)),
        }
    }

    /// Whether the lines of `text` were printed, in this order, apart from spaces and what `…` at the end of a line stands for, as
    /// the amplitude of a motion on which rounding grows.
    fn shown(&self, text: &str) -> Result<(), String> {
        let plain = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
        let mut printed = self.printed.lines().map(plain);
        for line in text.lines().map(plain).filter(|line| !line.is_empty() && line != "…") {
            let same = |one: String| match line.strip_suffix(" …") {
                Some(start) => one.starts_with(start),
                None => one == line,
            };
            if !printed.any(same) {
                return Err(format!("not printed, or not in this order: {line}\nprinted:\n{}", self.printed));
            }
        }
        Ok(())
    }
}

fn needs_gmsh(chapter: &str) -> bool {
    blocks(chapter).iter().any(|b| b.info.starts_with("sh") && b.text.lines().any(|l| l.starts_with("gmsh ")))
}

/// Follows the chapters that `wanted` picks; all their faults at once.
fn follow(wanted: impl Fn(&str) -> bool) {
    let (mut faults, mut commands) = (Vec::new(), 0);
    for (name, text) in chapters().into_iter().filter(|(_, text)| wanted(text)) {
        let mut reader = Reader::new();
        for block in blocks(&text) {
            commands += usize::from(block.info.starts_with("sh"));
            if let Err(fault) = reader.follow(&block) {
                faults.push(format!("{name}, line {}: {fault}", block.line));
                break;
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
    assert!(commands > 0, "no chapter has a command");
}

#[test]
fn every_chapter_runs_as_written() {
    follow(|text| !needs_gmsh(text));
}

#[test]
#[ignore = "needs Gmsh; .ci/guide runs it"]
fn every_chapter_with_gmsh_runs_as_written() {
    follow(needs_gmsh);
}

/// The messages that the page of troubles explains are messages of the program.
#[test]
fn every_message_of_troubleshooting_is_one_of_the_program() {
    let page = std::fs::read_to_string(guide().join("troubleshooting.md")).expect("troubleshooting.md");
    let messages: Vec<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("| `"))
        .filter_map(|rest| rest.split('`').next())
        .collect();
    assert!(messages.len() > 10, "{messages:?}");
    let mut code = String::new();
    for folder in ["src", "crates"] {
        sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut code);
    }
    let unknown: Vec<_> = messages.iter().filter(|message| !code.contains(**message)).collect();
    assert!(unknown.is_empty(), "no message has {unknown:?}");
}

/// The lines of the program below `folder`, without comments.
fn sources(folder: &Path, code: &mut String) {
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() {
            sources(&entry, code);
        } else {
            let text = std::fs::read_to_string(entry).unwrap_or_default();
            code.extend(text.lines().filter(|l| !l.trim_start().starts_with("//")).flat_map(|l| [l, "\n"]));
        }
    }
}

/// Every chapter stands in SUMMARY.md, and every link within the guide leads to a file.
#[test]
fn every_chapter_is_listed_and_every_link_leads_somewhere() {
    let summary = std::fs::read_to_string(guide().join("SUMMARY.md")).expect("SUMMARY.md");
    let mut faults = Vec::new();
    for (name, text) in chapters() {
        if name != "SUMMARY.md" && !summary.contains(&format!("({name})")) {
            faults.push(format!("{name} is not in SUMMARY.md"));
        }
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = target.split('#').next().unwrap_or_default();
            if !file.is_empty() && !file.contains("://") && !guide().join(file).exists() {
                faults.push(format!("{name}: {target} is not there"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
