//! The file of a search: the case, its numbers that are searched for, and the facts.

use crate::case::{Case, VariedParameter, check_parameter, read_case};
use crate::error::read::read_text;
use crate::error::{Error, Fault, Faults, Result};
use crate::results::record::{InputFile, RecordOrigin};
use crate::schema::reader::{TableReader, read_document};
use crate::schema::units::NUMBER;
use crate::validation::{Check, read_check};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Bound;
use std::path::{Path, PathBuf};

/// A search.
#[derive(Debug)]
pub struct SearchFile {
    /// The file's name, or its folder's for `search.toml`.
    pub name: String,
    /// One line.
    pub title: String,
    /// Where the facts come from.
    pub source: String,
    /// The case at whose values the search starts.
    pub case: Case,
    /// The case and those that the facts are of, by their files.
    pub(super) cases: BTreeMap<String, Case>,
    /// Most different places to compute.
    pub evaluations: usize,
    /// The seed of the random samples.
    pub seed: u64,
    /// The standard deviation of the first samples, as a share of the bounds.
    pub spread: f64,
    /// Parameters of the search by name.
    pub parameters: BTreeMap<String, VariedParameter>,
    /// The values of the case \[SI\].
    pub(super) start: Vec<f64>,
    /// The facts.
    pub(super) checks: Vec<Check>,
    /// The file itself.
    text: String,
}

/// Reads the file of a search, and its cases.
///
/// # Errors
/// Every fault of any of the files.
pub fn read_search(path: &Path) -> Result<SearchFile> {
    let place = path.display().to_string();
    let text = read_text(path, "the file of a search, in TOML")?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let found = SearchFile::parse(&place, &text, |file| read_case(&folder.join(file)))?;
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let stem = whole.file_stem().unwrap_or_default();
    let parent = whole.parent().and_then(Path::file_name);
    let name = parent.filter(|_| stem == "search").unwrap_or(stem);
    Ok(SearchFile { name: name.to_string_lossy().into_owned(), text, ..found })
}

fn read_root(root: &TableReader, file: &str, case: Case) -> SearchFile {
    let scalars = case.parameters();
    let parameters = root.named("parameter", |name, s| {
        let parameter: VariedParameter =
            s.declared(|parameter, report| check_parameter(parameter, "", &case, Some(&scalars), report));
        (name.to_string(), parameter)
    });
    let parameters = parameters.unwrap_or_default();
    let checks = root.named("fact", |name, s| {
        if s.is_table("reference") {
            s.fault("reference", "a table", "a number: what is searched for", "");
        }
        read_check(name, s, file, "")
    });
    let checks = checks.unwrap_or_default();
    for (key, none) in [("parameter", parameters.is_empty()), ("fact", checks.is_empty())] {
        if none {
            root.fault(key, "nothing", format!("at least one table [{key}.NAME]"), "");
        }
    }
    SearchFile {
        name: String::new(),
        title: root.text("title").required("one line"),
        source: root.text("source").required("where the facts come from"),
        cases: BTreeMap::from([(file.to_string(), case.clone())]),
        case,
        evaluations: root.count("evaluations").or(1000),
        seed: root.count("seed").or(1) as u64,
        spread: root.quantity("spread", NUMBER).within(Bound::Excluded(0.0), Bound::Included(1.0)).or(0.2),
        parameters: parameters.into_iter().collect(),
        start: Vec::new(),
        checks,
        text: String::new(),
    }
}

impl SearchFile {
    /// The search of the `text` of the file `place`, without a name; `read` gives the case of a file.
    ///
    /// # Errors
    /// Every fault of the text, and of its cases.
    pub fn parse(place: &str, text: &str, read: impl Fn(&str) -> Result<Case>) -> Result<SearchFile> {
        let mut faults = Faults::new();
        let found = read_document(place, text, |root| {
            let file = root.string("case").or("case.toml".into());
            match faults.take(read(&file)) {
                Some(case) => Some(read_root(root, &file, case)),
                None => {
                    root.skip(&["title", "source", "evaluations", "seed", "spread", "parameter", "fact"]);
                    None
                }
            }
        });
        let found = faults.take(found).flatten();
        let Some(mut found) = found else { return Err(Error::Input(faults)) };
        let files: BTreeSet<&String> = found.checks.iter().map(|check| &check.of.case).collect();
        for file in files {
            if !found.cases.contains_key(file) {
                found.cases.extend(faults.take(read(file)).map(|case| (file.clone(), case)));
            }
        }
        let mut start = Vec::new();
        for (name, parameter) in &found.parameters {
            let key = |key: &str| format!("{place}: `parameter.{name}.{key}`");
            start.extend(faults.take(parameter.start(&found.case, key)));
            for (file, case) in &found.cases {
                for path in parameter.path.iter().filter(|path| case.parameter(path).is_err()) {
                    let found = format!("`{path}`, no number of {file}");
                    faults.push(Fault::new(key("path"), found, "scalars that every case of the facts has"));
                }
            }
        }
        let mut taken: BTreeMap<&String, &String> = BTreeMap::new();
        for (name, path) in
            found.parameters.iter().flat_map(|(name, p)| p.path.iter().map(move |path| (name, path)))
        {
            if let Some(first) = taken.insert(path, name) {
                let words = format!("`{path}`, which `parameter.{first}` moves already");
                faults.push(Fault::new(
                    format!("{place}: `parameter.{name}.path`"),
                    words,
                    "each scalar in one parameter, once",
                ));
            }
        }
        found.start = start;
        faults.into_result(found)
    }

    /// `case` with the numbers at `values` \[SI\].
    pub(super) fn with(&self, case: &Case, values: &[f64]) -> Result<Case> {
        case.with_numbers(self.parameters.values(), values)
    }

    /// Origin of the facts: the cases, the files they read, and the facts without their references.
    pub(super) fn origin(&self) -> Result<RecordOrigin> {
        let table = |text: &str| text.parse::<toml::Table>().unwrap_or_default();
        let mut all = table(&self.text);
        all.retain(|key, _| key == "fact");
        let facts = all.get_mut("fact").and_then(toml::Value::as_table_mut);
        for fact in facts.into_iter().flatten().filter_map(|(_, fact)| fact.as_table_mut()) {
            fact.retain(|key, _| !["reference", "tolerance", "absolute_tolerance", "reason"].contains(&key));
        }
        all.extend(self.cases.iter().map(|(name, case)| (name.clone(), table(&case.to_toml()).into())));
        Ok(RecordOrigin { case: all.to_string(), inputs: self.files_of_cases()? })
    }

    /// The files that the cases read.
    fn files_of_cases(&self) -> Result<Vec<InputFile>> {
        let mut inputs = Vec::new();
        for (name, case) in &self.cases {
            for file in case.files() {
                let input = InputFile::read(&case.folder, &file)?;
                inputs.push(InputFile { path: format!("{file} of {name}"), ..input });
            }
        }
        Ok(inputs)
    }

    /// The cases and the files that they read.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn inputs(&self) -> Result<Vec<InputFile>> {
        let text = |case: &Case| case.places.source().1.to_string();
        let cases = self.cases.iter().map(|(name, case)| InputFile::of_text(name, &text(case)));
        Ok(cases.chain(self.files_of_cases()?).collect())
    }

    /// The file itself.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The paths of the cases and of the files that they read.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let case_file = |(name, case): (&String, &Case)| {
            let own = Path::new(name).file_name().map(PathBuf::from);
            own.into_iter()
                .chain(case.files().into_iter().map(PathBuf::from))
                .map(|file| case.folder.join(file))
                .collect::<Vec<_>>()
        };
        let all = self.cases.iter().flat_map(case_file);
        all.filter_map(|path| std::path::absolute(path).ok()).collect()
    }
}
