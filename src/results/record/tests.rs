use super::*;
use crate::error::{Error, Fault, Faults};
use crate::linalg::c64;
use crate::results::{Channel, FieldSnapshot, NodalField, RecordPiece, Recording};
use crate::sweep::Modes;
use crate::transient::{Checkpoint, Event, EventKind};
use faer::Mat;

const MODES: usize = 2;

fn origin() -> RecordOrigin {
    let input = InputFile { path: "a.msh".into(), bytes: 3, sha256: "00".into() };
    RecordOrigin { case: "title = \"a case\"\n".into(), inputs: vec![input] }
}

fn channels() -> [Channel; 2] {
    ["a", "b"].map(|name| Channel::new(name.into(), "m", "a channel".into()))
}

fn checkpoint(row: usize) -> Checkpoint {
    let mut checkpoint = Checkpoint::default();
    checkpoint.put("counts", &[row as f64]);
    checkpoint.put("motion", &[0.1 * row as f64; 7]);
    checkpoint.put("nothing", &[]);
    checkpoint
}

fn motion(number: usize) -> NodalField<f64> {
    (0..3).map(|node| [number as f64, node as f64 + 0.5, -1.0, 0.0, 0.0, 0.0]).collect()
}

fn begin(record: &Record) {
    let channels = channels();
    let recording = Recording {
        time_step: 1e-3,
        rows: 100,
        done: 0,
        happened: 0,
        channels: &channels,
        modes: MODES,
        pairs: &[],
        fields: None,
    };
    record.begin_transient(&recording);
}

/// Ten rows, two events and the motion of all nodes.
fn add(record: &Record, first: usize) {
    let number = first / 10;
    record.add_field(&FieldSnapshot { number, displacement: &motion(number), velocity: &motion(100) });
    let rows = first..first + 10;
    let values = [1.0, 2.0].map(|c| rows.clone().map(|row| c * row as f64).collect::<Vec<f64>>());
    let modal = [0.5_f32; MODES].map(|c| rows.clone().map(|row| c * row as f32).collect::<Vec<f32>>());
    let event = |k: usize| Event { time: k as f64, point: k, kind: EventKind::ALL[k % 5] };
    let events = [event(first), event(first + 1)];
    let checkpoint = checkpoint(first + 9);
    let piece =
        RecordPiece { first, values: &values, modal: &modal, events: &events, checkpoint: &checkpoint };
    record.add_piece(&piece).unwrap();
}

fn modes(rows: usize) -> Result<Modes> {
    let vectors = Mat::from_fn(rows, 2, |i, j| c64::new(i as f64, -0.5 * j as f64));
    Ok(Modes { eigenvalues: vec![c64::new(-0.1, 7.0), c64::new(f64::NAN, 1e300)], vectors })
}

/// Answers of a sweep, with shapes, and of a map, without and with errors of every kind.
fn answers() -> Vec<(&'static str, Vec<u64>, Result<Modes>)> {
    let fault = |place: &str| Fault::new(place, "this", "that").with_help("Do so");
    vec![
        ("sweep.a", vec![0], modes(3)),
        ("map.b", vec![0, 9], modes(0)),
        ("map.b", vec![2, 9], Err(Error::analysis("steady sliding", "no contact", "Press harder"))),
        ("map.b", vec![3, 9], Err(Error::Input(Faults(vec![fault("here"), fault("there")])))),
        ("map.b", vec![5, 9], Err(Error::io("a/b", "Permission denied", "Ask for it"))),
    ]
}

fn keep(record: &Record) {
    answers().iter().for_each(|(study, place, modes)| record.keep(study, place, modes).unwrap());
}

fn knows_all(record: &Record) -> bool {
    let known = |(study, place, modes): &(&str, Vec<u64>, Result<Modes>)| {
        assert!(record.has(study, place));
        format!("{:?}", record.answer(study, place).unwrap()) == format!("{modes:?}")
    };
    answers().iter().all(known)
        && record.answer("map.b", &[0]).is_none()
        && record.answer("c", &[0]).is_none()
}

/// Answers of studies, and thirty rows.
fn record(dir: &Path) {
    let record = Record::new(dir, origin());
    record.compare_by([7; 32]).unwrap();
    keep(&record);
    begin(&record);
    [0, 10, 20].into_iter().for_each(|first| add(&record, first));
    assert!(knows_all(&record));
}

fn resume(dir: &Path) -> Result<Record> {
    Record::resume(dir, origin())
}

/// Entries without the state of the run in time, in words: numbers may be no numbers.
fn words(dir: &Path) -> String {
    format!("{:?}", entries(&dir.join(RECORD)).unwrap())
}

#[test]
fn a_record_is_resumed() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    assert!(resume(dir).unwrap().in_time() == Earlier::default() && !dir.join(RECORD).exists());
    record(dir);
    let again = resume(dir).unwrap();
    assert!(
        !again.ended() && knows_all(&again) && again.has_study("map.") && !again.has_study("uncertainty.")
    );
    let earlier = again.in_time();
    assert_eq!((earlier.rows, earlier.events, earlier.fields), (30, 6, 3));
    assert_eq!(earlier.channels, [("a".to_string(), 0.0), ("b".to_string(), 0.0)]);
    assert_eq!(earlier.march, Some(checkpoint(29)));
    let (mut rows, mut fields) = (Vec::new(), 0);
    again
        .replay(&mut |entry| {
            match entry {
                Entry::Rows { first, values, modal, events } => {
                    assert_eq!((first, values[1][3]), (rows.len(), 2.0 * (first + 3) as f64));
                    assert_eq!((modal[1][4], events[1].point), (0.5 * (first + 4) as f32, first + 1));
                    rows.extend(values[0].clone());
                }
                Entry::Field { number, motion: [displacement, velocity] } => {
                    assert!(number == fields && displacement == motion(number) && velocity == motion(100));
                    fields += 1;
                }
                _ => {}
            }
            Ok(())
        })
        .unwrap();
    assert!(rows == (0..30).map(f64::from).collect::<Vec<f64>>() && fields == 3);
    // What a kill leaves behind the last entry that counts is overwritten.
    let path = dir.join(RECORD);
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, [&whole[..], &[4; 1000]].concat()).unwrap();
    again.keep("uncertainty.s", &[1], &modes(0)).unwrap();
    assert!(again.answer("uncertainty.s", &[1]).is_some());
    again.end().unwrap();
    let last = resume(dir).unwrap();
    assert!(last.ended() && last.has("uncertainty.s", &[1]) && last.in_time().rows == 30 && knows_all(&last));
    // One that was read is written again as it was.
    assert_eq!(to_bytes(&entries(&path).unwrap()), std::fs::read(&path).unwrap());
    last.end().unwrap();
    last.keep("uncertainty.s", &[2], &modes(0)).unwrap();
    assert!(!resume(dir).unwrap().ended());
}

#[test]
fn files_at_any_moment_are_resumed() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let record = Record::new(dir, origin());
    begin(&record);
    assert_eq!(resume(dir).unwrap().in_time(), Earlier::default());
    add(&record, 0);
    let one = std::fs::read(dir.join(CHECKPOINT)).unwrap();
    let begun = std::fs::read(dir.join(RECORD)).unwrap().len();
    let before = resume(dir).unwrap().in_time();
    add(&record, 10);
    // Killed before the checkpoint was replaced, with any part of the second piece there.
    std::fs::write(dir.join(CHECKPOINT), &one).unwrap();
    let two = std::fs::read(dir.join(RECORD)).unwrap();
    for length in (begun..=two.len()).step_by(17) {
        std::fs::write(dir.join(RECORD), &two[..length]).unwrap();
        assert_eq!(resume(dir).unwrap().in_time(), before, "{length} bytes");
    }
}

/// Answers before a damage count, those behind it are computed again.
#[test]
fn answers_up_to_a_damage_are_those_that_were_written() {
    let dir = tempfile::tempdir().unwrap();
    let (dir, path) = (dir.path(), dir.path().join(RECORD));
    let record = Record::new(dir, origin());
    keep(&record);
    record.end().unwrap();
    let (whole, all) = (std::fs::read(&path).unwrap(), words(dir));
    let (mut fewer, mut refused) = (0, 0);
    let mut look = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        match resume(dir) {
            Ok(again) => {
                let begin = words(dir);
                assert!(
                    all.starts_with(&begin[..begin.len() - 1]) && begin.len() < all.len() && !again.ended()
                );
                fewer += 1;
            }
            // The head, without which nothing is known of the file.
            Err(error) => {
                let said = error.to_string();
                assert!(
                    error.exit_code() == 2 && said.contains(RECORD) && said.contains("--resume"),
                    "{said}"
                );
                refused += 1;
            }
        }
    };
    for at in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << (at % 8);
        look(&bytes);
        look(&whole[..at]);
    }
    assert!(fewer > whole.len() && refused > 50, "{fewer} with fewer entries, {refused} refused");
}

/// The rows of a run in time cannot be computed again without the state before them.
#[test]
fn a_run_in_time_that_was_changed_anywhere_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    record(dir);
    for name in [RECORD, CHECKPOINT] {
        let path = dir.join(name);
        let whole = std::fs::read(&path).unwrap();
        let refused = |bytes: &[u8], what: &str| {
            std::fs::write(&path, bytes).unwrap();
            let error = resume(dir).expect_err(what);
            let said = error.to_string();
            assert!(error.exit_code() == 2 && said.contains(name) && said.contains("--resume"), "{said}");
        };
        for at in (0..whole.len()).step_by(5) {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << (at % 8);
            refused(&bytes, &format!("{name}: byte {at} flipped"));
        }
        for length in (0..whole.len()).step_by(31) {
            refused(&whole[..length], &format!("{name}: cut to {length} bytes"));
        }
        std::fs::write(&path, &whole).unwrap();
    }
    std::fs::remove_file(dir.join(RECORD)).unwrap();
    assert_eq!(resume(dir).unwrap_err().exit_code(), 2);
}

/// Bytes that are wrong and have the right checksums are refused or read, and nothing else.
#[test]
fn wrong_bytes_with_right_checksums_do_no_harm() {
    let dir = tempfile::tempdir().unwrap();
    record(dir.path());
    let path = dir.path().join(RECORD);
    let saved = std::fs::read(dir.path().join(CHECKPOINT)).unwrap();
    let (mut refused, mut read) = (0, 0);
    let changes: [fn(u8) -> u8; 4] = [|b| b ^ 1, |b| b ^ 0x80, |_| 0, |_| 0xff];
    let all: Vec<Vec<u8>> = entries(&path).unwrap().iter().map(Entry::to_bytes).collect();
    for change in changes {
        for bytes in &all {
            for at in 0..bytes.len() {
                let mut other = bytes.clone();
                other[at] = change(other[at]);
                for bytes in [&other[..], &other[..at], &bytes[..at]] {
                    match Entry::read(bytes) {
                        Ok(entry) => {
                            assert!(entry.to_bytes().len() <= bytes.len());
                            read += 1;
                        }
                        Err(_) => refused += 1,
                    }
                }
            }
        }
        for at in 16..saved.len() - 32 {
            let mut bytes = saved.clone();
            bytes[at] = change(bytes[at]);
            bytes.truncate(saved.len() - 32);
            let digest = Sha256::digest(&bytes);
            bytes.extend(digest);
            if let Ok(found) = Saved::from_bytes(&bytes) {
                assert!(found.to_bytes().len() <= bytes.len());
            }
        }
    }
    assert!(refused > 1000 && read > 100, "{refused} refused, {read} read");
    // Entries in another order, or twice.
    let whole = entries(&path).unwrap();
    for k in 0..whole.len() {
        let mut other = whole.clone();
        let moved = other.remove(k);
        other.insert((k * 7 + 3) % whole.len(), moved);
        other.push(whole[k].clone());
        std::fs::write(&path, to_bytes(&other)).unwrap();
        assert_eq!(resume(dir.path()).unwrap_err().exit_code(), 2);
    }
}

#[test]
fn another_case_other_files_and_earlier_formats_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    record(dir);
    let case = RecordOrigin { case: "title = \"another\"\n".into(), ..origin() };
    let said = Record::resume(dir, case).unwrap_err().to_string();
    assert!(said.contains("`title` was `\"a case\"` and is `\"another\"`"), "{said}");
    let mut files = origin();
    files.inputs[0].sha256 = "01".into();
    let said = Record::resume(dir, files).unwrap_err().to_string();
    assert!(said.contains("`a.msh` has changed"), "{said}");
    let mut all = entries(&dir.join(RECORD)).unwrap();
    all[0] = Entry::Head(Head { program: "0.0.1 (0123456789ab)".into(), ..Head::new(origin(), None) });
    std::fs::write(dir.join(RECORD), to_bytes(&all)).unwrap();
    let said = resume(dir).unwrap_err().to_string();
    assert!(said.contains("results of version 0.0.1;") && said.contains("without --resume"), "{said}");
    for (name, bytes) in [(RECORD, &b"\x01................."[..]), (CHECKPOINT, b"stridor resume 1....")] {
        std::fs::write(dir.join(name), bytes).unwrap();
        let said = resume(dir).unwrap_err().to_string();
        assert!(
            said.contains("of this version of the program") && said.contains("without --resume"),
            "{said}"
        );
    }
}

#[test]
fn a_part_resumes_and_its_shapes_are_compared_by_one_reference() {
    let dir = tempfile::tempdir().unwrap();
    let (dir, part) = (dir.path(), Part { number: 1, of: 2 });
    let file = Record::open_part(dir, part, &origin()).unwrap();
    let twice = Record::open_part(dir, part, &origin()).unwrap_err();
    assert!(twice.to_string().contains("part 1 of 2 is in use by process"), "{twice}");
    file.begin_part(part, [7; 32]).unwrap();
    keep(&file);
    file.end().unwrap();
    drop(file);
    let file = Record::open_part(dir, part, &origin()).unwrap();
    assert!(knows_all(&file) && file.ended() && file.begin_part(part, [7; 32]).is_ok());
    let error = file.begin_part(part, [8; 32]).unwrap_err();
    assert!(error.exit_code() == 2 && error.to_string().contains("1-of-2.bin"), "{error}");
    // So are those of its neighbours; eigenvalues alone fit all.
    let other = Part { number: 2, of: 2 };
    let neighbour = Record::open_part(dir, other, &origin()).unwrap();
    assert!(neighbour.begin_part(other, [8; 32]).is_err());
    let mut alone = entries(&dir.join(part.file())).unwrap();
    alone.retain(|entry| !matches!(entry, Entry::Answer { study, .. } if study == "sweep.a"));
    drop(file);
    std::fs::write(dir.join(part.file()), to_bytes(&alone)).unwrap();
    Record::open_part(dir, part, &origin()).unwrap().begin_part(part, [8; 32]).unwrap();
    neighbour.begin_part(other, [9; 32]).unwrap();
    let read = read_parts(dir, &origin()).unwrap();
    assert_eq!(read.iter().map(|record| record.part()).collect::<Vec<_>>(), [Some(part), Some(other)]);
}
