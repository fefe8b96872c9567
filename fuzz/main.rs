//! Random inputs for every reader, from changed copies of sound ones: none may panic, hang, or take more memory than its
//! bound. An input whose outcome is of a new kind is changed further. README.md says how to run it.

mod memory;
mod mutate;
mod readers;
mod watch;

use mutate::{Random, mutated};
use readers::{READERS, Reader};
use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Mutex;
use std::time::{Duration, Instant};
use stridor::error::Error;

#[global_allocator]
static ALLOCATOR: memory::Counting = memory::Counting;

/// Inputs that are kept in memory for further changes.
const KEPT: usize = 2048;
/// Most kinds of outcomes that are kept.
const KINDS: usize = 1 << 16;
/// Inputs of a run that go to the corpus.
const MOST_KEPT: usize = 32;
/// The longest file of the repository to begin with \[byte\].
const LONGEST_SAMPLE: usize = 16 << 10;
/// The longest input that goes to the corpus \[byte\].
const LONGEST_KEPT: usize = 512;

/// The options of the command line; those of `cargo test` for other tests are passed over.
#[derive(Clone)]
struct Options {
    names: Vec<String>,
    executions: u64,
    seconds: u64,
    seed: u64,
    /// Inputs of a new kind are added to the corpus.
    keep: bool,
    /// This process reads; without it, it starts one process a reader.
    alone: bool,
}

impl Options {
    fn read() -> Options {
        let mut options =
            Options { names: Vec::new(), executions: 0, seconds: 0, seed: 1, keep: false, alone: false };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut number = || words.next().and_then(|w| w.parse().ok()).expect("a whole number");
            match word.as_str() {
                "--executions" => options.executions = number(),
                "--seconds" => options.seconds = number(),
                "--seed" => options.seed = number(),
                "--keep" => options.keep = true,
                "--alone" => options.alone = true,
                other if other.starts_with('-') => {}
                name => options.names.push(name.to_string()),
            }
        }
        if options.executions == 0 {
            options.executions = if options.seconds == 0 { 2000 } else { u64::MAX };
        }
        options
    }

    fn readers(&self) -> impl Iterator<Item = &'static Reader> {
        let chosen = |reader: &&Reader| self.names.is_empty() || self.names.iter().any(|n| n == reader.name);
        READERS.iter().filter(chosen)
    }
}

fn main() -> ExitCode {
    let options = Options::read();
    if options.alone {
        rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool");
        let all: Vec<bool> = options.readers().map(|reader| holds(reader, &options)).collect();
        return ExitCode::from(u8::from(all.contains(&false)));
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let waiting = Mutex::new(options.readers().collect::<Vec<_>>());
    let failed = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                while let Some(reader) = { waiting.lock().expect("no panic").pop() } {
                    let program = std::env::current_exe().expect("the path of this program");
                    let words = std::env::args().skip(1).filter(|w| !options.names.contains(w));
                    let status = Command::new(program).args(words).args(["--alone", reader.name]).status();
                    if !status.is_ok_and(|status| status.success()) {
                        failed.lock().expect("no panic").push(reader.name);
                    }
                }
            });
        }
    });
    let failed = failed.into_inner().expect("no panic");
    if !failed.is_empty() {
        eprintln!("readers that fail: {}; their inputs are in {}", failed.join(", "), found_in().display());
    }
    ExitCode::from(u8::from(!failed.is_empty()))
}

/// The folder of inputs that something is wrong with.
fn found_in() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz")
}

fn holds(reader: &Reader, options: &Options) -> bool {
    let out = found_in();
    std::fs::create_dir_all(&out).expect("a folder for what is found");
    watch::begin(&out.join(format!("{}-ended-the-process", reader.name)));
    let mut run = Run {
        reader,
        kinds: BTreeSet::new(),
        wrong: BTreeMap::new(),
        executions: 0,
        sound: 0,
        most: 0,
        times: 0.0,
    };
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(reader.name);
    let mut inputs = Vec::new();
    for input in samples(reader, &corpus) {
        run.try_input(&input);
        inputs.push(input);
    }
    if run.sound == 0 {
        eprintln!("{}: none of the files to begin with is sound", reader.name);
        return false;
    }
    let words = words(&inputs);
    let mut random = Random::new(options.seed);
    let begun = Instant::now();
    let until = begun + Duration::from_secs(if options.seconds == 0 { 1 << 30 } else { options.seconds });
    let mut new = Vec::new();
    while run.executions < options.executions && run.wrong.len() < 10 {
        if run.executions.is_multiple_of(64) && Instant::now() > until {
            break;
        }
        let input = mutated(&mut random, &inputs, &words);
        if run.try_input(&input) && input.len() <= LONGEST_SAMPLE {
            if options.keep && new.len() < MOST_KEPT && input.len() <= LONGEST_KEPT {
                new.push(input.clone());
            }
            if inputs.len() < KEPT {
                inputs.push(input);
            } else {
                let at = random.below(KEPT);
                inputs[at] = input;
            }
        }
    }
    if !new.is_empty() {
        std::fs::create_dir_all(&corpus).expect("a folder for the corpus");
        for input in &new {
            std::fs::write(corpus.join(format!("{:016x}", hash(input))), input)
                .expect("a file of the corpus");
        }
    }
    run.report(&out, begun.elapsed().as_secs_f64());
    run.wrong.is_empty()
}

/// The corpus of the reader and the short ones of its samples, in the order of their paths.
fn samples(reader: &Reader, corpus: &Path) -> Vec<Vec<u8>> {
    let mut files = Vec::new();
    let list = |folder: &Path| std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path());
    files.extend(list(corpus));
    for (folder, end) in reader.samples {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let below =
            list(&folder).filter(|path| path.is_dir()).flat_map(|path| list(&path).collect::<Vec<_>>());
        files.extend(list(&folder).chain(below).filter(|path| path.to_string_lossy().ends_with(end)));
    }
    files.sort();
    let read: Vec<Vec<u8>> = files.iter().filter_map(|file| std::fs::read(file).ok()).collect();
    let short: Vec<Vec<u8>> = read.into_iter().filter(|bytes| bytes.len() <= LONGEST_SAMPLE).collect();
    assert!(!short.is_empty(), "{} has nothing to begin with", reader.name);
    short
}

/// The words of the inputs, each once.
fn words(inputs: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let word = |b: &u8| b.is_ascii_alphanumeric() || b"_$.\"[]%".contains(b);
    let all = inputs.iter().flat_map(|input| input.split(move |b| !word(b)));
    let words: BTreeSet<&[u8]> = all.filter(|w| (2..24).contains(&w.len())).collect();
    words.into_iter().map(<[u8]>::to_vec).chain([b"x".to_vec()]).collect()
}

fn hash(of: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    hasher.finish()
}

/// The kinds of the faults of an error, each by itself: what is found word by word, and combinations of faults, are without
/// number.
fn kinds(error: &Error) -> Vec<u64> {
    match error {
        Error::Input(faults) => faults
            .0
            .iter()
            .map(|fault| kind(&format!("{}; {}", begin(&fault.found), fault.expected)))
            .collect(),
        other => vec![kind(&other.to_string())],
    }
}

/// The first three words of a message, up to one that has more than small letters.
fn begin(message: &str) -> String {
    let plain = |word: &&str| word.bytes().all(|b| b.is_ascii_lowercase());
    message.split_whitespace().take(3).take_while(plain).collect::<Vec<_>>().join(" ")
}

/// The letters of a message, without what it quotes.
fn kind(message: &str) -> u64 {
    let mut quoted = None;
    let kept = message.chars().filter(|c| match (quoted, *c) {
        (Some(mark), c) => {
            if c == mark {
                quoted = None;
            }
            false
        }
        (None, c @ ('"' | '`')) => {
            quoted = Some(c);
            true
        }
        (None, c) => c.is_ascii_alphabetic(),
    });
    hash(kept.collect::<String>())
}

struct Run<'a> {
    reader: &'a Reader,
    /// The kinds of outcomes so far.
    kinds: BTreeSet<u64>,
    /// What went wrong, each once, with its input.
    wrong: BTreeMap<String, Vec<u8>>,
    executions: u64,
    /// How many inputs were sound.
    sound: u64,
    /// The most memory \[byte\].
    most: usize,
    /// The most memory beyond the constant, as a multiple of the input.
    times: f64,
}

impl Run<'_> {
    /// Reads `input`: whether the outcome is of a new kind.
    fn try_input(&mut self, input: &[u8]) -> bool {
        static PLACE: Mutex<String> = Mutex::new(String::new());
        if self.executions == 0 {
            std::panic::set_hook(Box::new(|info| *PLACE.lock().expect("no panic") = info.to_string()));
        }
        self.executions += 1;
        let read = || catch_unwind(AssertUnwindSafe(|| (self.reader.read)(input)));
        let (outcome, bytes) = watch::during(input, || memory::peak_of(read));
        self.most = self.most.max(bytes);
        let beyond = bytes.saturating_sub(self.reader.constant) as f64;
        self.times = self.times.max(beyond / input.len().max(1) as f64);
        let limit = self.reader.times * input.len() + self.reader.constant;
        if bytes > limit {
            let what = format!("memory above {} × input + {} bytes", self.reader.times, self.reader.constant);
            let worst = self.wrong.entry(what).or_insert_with(|| input.to_vec());
            if bytes * worst.len() > limit * input.len() {
                *worst = input.to_vec();
            }
        }
        match outcome {
            Ok(Ok(found)) => {
                self.sound += 1;
                self.is_new(&[hash(found)])
            }
            Ok(Err(error)) => self.is_new(&kinds(&error)),
            Err(_) => {
                let place = PLACE.lock().expect("no panic").clone();
                self.wrong.entry(place).or_insert_with(|| input.to_vec());
                false
            }
        }
    }

    /// Adds kinds of outcomes: whether one of them is new.
    fn is_new(&mut self, kinds: &[u64]) -> bool {
        let before = self.kinds.len();
        self.kinds.extend(kinds.iter().take(KINDS.saturating_sub(before)));
        self.kinds.len() > before
    }

    fn report(&self, out: &Path, seconds: f64) {
        println!(
            "{}: {} executions ({} of sound inputs) in {seconds:.0} s, {} kinds of outcomes, {} KiB of memory at most, \
             at most {:.1} × input beyond the first {} KiB",
            self.reader.name,
            self.executions,
            self.sound,
            self.kinds.len(),
            self.most >> 10,
            self.times,
            self.reader.constant >> 10
        );
        for (what, input) in &self.wrong {
            let file = out.join(format!("{}-{:016x}", self.reader.name, hash(input)));
            let written = std::fs::write(&file, input).map_or("not written", |()| "written");
            println!("{}: {what}\n  input {written}: {}", self.reader.name, file.display());
        }
    }
}
