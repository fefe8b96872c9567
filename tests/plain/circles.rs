//! No files of the library import each other in a circle: whoever reads one needs no file that needs it.
//!
//! Imports are `use` and paths that begin with `crate`, `super` or a module below the file, without unit tests; a name that a
//! `mod.rs` re-exports belongs to the file that defines it.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::ops::Range;
use std::path::Path;

type Module = Vec<String>;

#[derive(Default)]
struct Sources {
    text: BTreeMap<Module, String>,
    /// Names that a module re-exports, with their full paths.
    exported: BTreeMap<(Module, String), Module>,
}

/// Reads the code below `folder`, without comments and unit tests.
fn read(folder: &Path, inside: &[String], text: &mut BTreeMap<Module, String>) {
    for entry in std::fs::read_dir(folder).expect("a folder of the crate").flatten() {
        let path = entry.path();
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let mut module = inside.to_vec();
        if ["tests", "sample", "samples"].contains(&name.as_str()) {
            continue;
        }
        if path.is_dir() {
            module.push(name);
            read(&path, &module, text);
        } else if path.extension().is_some_and(|e| e == "rs") && name != "main" {
            if !["mod", "lib"].contains(&name.as_str()) {
                module.push(name);
            }
            let code = std::fs::read_to_string(&path).expect("source is text");
            let code = code.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
            let code = code.lines().filter(|line| !line.trim_start().starts_with("//"));
            text.insert(module, code.collect::<Vec<_>>().join("\n"));
        }
    }
}

/// The paths of a tree such as `a::{b, c::{d, e}}`.
fn branches(tree: &str, before: &[String], all: &mut Vec<Module>) {
    let (path, inner) = match tree.split_once('{') {
        Some((path, inner)) => (path, inner.rsplit_once('}').map(|(inner, _)| inner)),
        None => (tree, None),
    };
    let words = path.split(" as ").next().unwrap_or_default().split("::");
    let mut here = before.to_vec();
    here.extend(words.map(|word| word.trim().to_string()).filter(|word| !word.is_empty()));
    let Some(inner) = inner else {
        all.push(here);
        return;
    };
    let (mut depth, mut start) = (0, 0);
    for (at, c) in inner.char_indices().chain([(inner.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                if !inner[start..at].trim().is_empty() {
                    branches(inner[start..at].trim(), &here, all);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

/// The statements `use …;` as places in the text, and whether they re-export.
fn statements(code: &str) -> Vec<(Range<usize>, bool)> {
    let statement = |(at, _): (usize, &str)| {
        let line = code[..at].rsplit('\n').next().unwrap_or_default().trim();
        let exports = line.starts_with("pub") && line.split_whitespace().count() == 1;
        let end = code[at..].find(';')?;
        (line.is_empty() || exports).then_some((at..at + end, exports))
    };
    code.match_indices("use ").filter_map(statement).collect()
}

/// The paths of these statements.
fn uses(code: &str) -> Vec<(bool, Module)> {
    let mut found = Vec::new();
    for (place, exports) in statements(code) {
        let mut paths = Vec::new();
        branches(&code[place.start + 4..place.end].replace('\n', " "), &[], &mut paths);
        found.extend(paths.into_iter().map(|path| (exports, path)));
    }
    found
}

/// Paths such as `crate::a::b` and `a::b` in the code itself.
fn inline(code: &str) -> Vec<Module> {
    let part = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let mut code = code.to_string();
    for (place, _) in statements(&code).into_iter().rev() {
        code.replace_range(place, "");
    }
    let words = code.split(|c: char| !part(c)).filter(|word| word.contains("::"));
    words.map(|word| word.split("::").map(str::to_string).collect()).collect()
}

impl Sources {
    fn new(root: &Path) -> Self {
        let mut sources = Sources::default();
        read(root, &[], &mut sources.text);
        let exports = |(module, code): (&Module, &String)| {
            let all = uses(code).into_iter().filter(|(exports, _)| *exports);
            let named = all.filter_map(|(_, path)| {
                let full = sources.absolute(module, &path)?;
                Some(((module.clone(), full.last()?.clone()), full))
            });
            named.collect::<Vec<_>>()
        };
        sources.exported = sources.text.iter().flat_map(exports).collect();
        sources
    }

    /// A path from the root of the crate; none for one of another crate.
    fn absolute(&self, module: &Module, path: &[String]) -> Option<Module> {
        let first = path.first()?.as_str();
        let mut base = module.clone();
        match first {
            "crate" => Some(path[1..].to_vec()),
            "super" | "self" => {
                let ups = path.iter().take_while(|word| ["super", "self"].contains(&word.as_str())).count();
                let levels = path[..ups].iter().filter(|word| *word == "super").count();
                base.truncate(base.len().checked_sub(levels)?);
                base.extend_from_slice(&path[ups..]);
                Some(base)
            }
            _ => {
                base.push(first.to_string());
                self.text.contains_key(&base).then(|| [module.clone(), path.to_vec()].concat())
            }
        }
    }

    /// The module that defines what a path names.
    fn file_of(&self, path: &[String], depth: usize) -> Option<Module> {
        let length = (1..=path.len()).rev().find(|k| self.text.contains_key(&path[..*k])).unwrap_or(0);
        let module = path[..length].to_vec();
        let exported = path.get(length).and_then(|name| self.exported.get(&(module.clone(), name.clone())));
        match exported.filter(|full| depth < 5 && full.as_slice() != path) {
            Some(full) => self.file_of(&[full, &path[length + 1..]].concat(), depth + 1),
            None => (length > 0).then_some(module),
        }
    }

    /// The modules that `module` imports.
    fn imports(&self, module: &Module) -> BTreeSet<Module> {
        let code = &self.text[module];
        let used = uses(code).into_iter().filter(|(exports, _)| !exports).map(|(_, path)| path);
        let body: String =
            code.lines().filter(|line| !line.contains("pub(in ")).collect::<Vec<_>>().join("\n");
        let paths = used.chain(inline(&body).into_iter().filter(|path| !path[0].is_empty()));
        let found = paths.filter_map(|path| self.file_of(&self.absolute(module, &path)?, 0));
        found.filter(|other| other != module).collect()
    }
}

/// The circles among the files below `root`; how many files there are, and how many imports.
fn circles(root: &Path) -> (Vec<String>, usize, usize) {
    let sources = Sources::new(root);
    let files = sources.text.keys().filter(|module| !module.is_empty());
    let imports: BTreeMap<&Module, BTreeSet<Module>> =
        files.map(|module| (module, sources.imports(module))).collect();
    let arrows: usize = imports.values().map(BTreeSet::len).sum();
    let reaches = |module: &Module| {
        let mut seen: BTreeSet<&Module> = imports[module].iter().collect();
        let mut left: VecDeque<&Module> = imports[module].iter().collect();
        while let Some(next) = left.pop_front() {
            left.extend(imports[next].iter().filter(|further| seen.insert(further)));
        }
        seen
    };
    let reached: BTreeMap<&Module, BTreeSet<&Module>> =
        imports.keys().map(|module| (*module, reaches(module))).collect();
    let mut circles = Vec::new();
    for (module, used) in &imports {
        let back = used.iter().filter(|other| reached[other].contains(module));
        circles.extend(back.map(|other| format!("{} imports {}", module.join("/"), other.join("/"))));
    }
    (circles, imports.len(), arrows)
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let members = std::fs::read_dir(root.join("crates")).expect("members of the workspace").flatten();
    let (mut found, mut files, mut imports) = circles(&root.join("src"));
    for member in members.map(|member| member.path().join("src")) {
        let (circles, more_files, more_imports) = circles(&member);
        found.extend(circles.into_iter().map(|circle| format!("{}: {circle}", member.display())));
        (files, imports) = (files + more_files, imports + more_imports);
    }
    assert!(files > 300 && imports > 1000, "{files} files, {imports} imports");
    assert!(found.is_empty(), "circles of imports:\n{}", found.join("\n"));
}
