use super::*;
use crate::linalg::c64;
use crate::results::{Channel, NodalField};
use crate::transient::{Event, EventKind};

const MODES: usize = 2;

fn origin() -> RecordOrigin {
    let input = InputFile { path: "a.msh".into(), bytes: 3, sha256: "00".into() };
    RecordOrigin { case: "title = \"a case\"\n".into(), inputs: vec![input] }
}

fn channels() -> [Channel; 2] {
    ["a", "b"].map(|name| Channel::new(name.into(), "m", "a channel".into()))
}

fn point(k: usize) -> MapPoint {
    MapPoint { growth_rate: 0.1 * k as f64, frequency_hz: f64::NAN, unstable: k as u32 }
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

fn begin(record: &mut Record) {
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
    record.begin_transient(&recording).unwrap();
}

/// Ten rows, two events and the motion of all nodes.
fn add(record: &mut Record, first: usize) {
    let number = first / 10;
    record
        .add_field(&FieldSnapshot { number, displacement: &motion(number), velocity: &motion(100) })
        .unwrap();
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

/// Samples of which the second has no answer and the third no mode.
fn samples() -> [SampleModes; 3] {
    [Some(vec![c64::new(-1.0, 2.0), c64::new(f64::NAN, f64::NAN)]), None, Some(Vec::new())]
}

/// Thirty rows, five points of a map and five samples.
fn record(dir: &Path) {
    let mut record = Record::new(dir, origin());
    begin(&mut record);
    [0, 10, 20].into_iter().for_each(|first| add(&mut record, first));
    record.begin_map("m", &[], &[[1.0, 2.0]]).unwrap();
    record.add_map_points("m", 0, &[0, 1, 2].map(point)).unwrap();
    record.add_map_points("m", 3, &[3, 4].map(point)).unwrap();
    record.add_samples("s", 0, &samples()).unwrap();
    record.add_samples("s", 3, &samples()[..2]).unwrap();
}

fn resume(dir: &Path) -> Result<Option<(Record, Earlier)>> {
    Record::resume(dir, &origin())
}

/// The same with numbers that are not numbers.
fn same(a: &Earlier, b: &Earlier) -> bool {
    format!("{a:?}") == format!("{b:?}")
}

#[test]
fn a_record_is_resumed() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    assert!(resume(dir).unwrap().is_none());
    record(dir);
    let (mut again, earlier) = resume(dir).unwrap().unwrap();
    assert!(!again.ended());
    assert_eq!((earlier.rows, earlier.events, earlier.fields), (30, 6, 3));
    assert_eq!(earlier.channels, [("a".to_string(), 0.0), ("b".to_string(), 0.0)]);
    assert_eq!(earlier.march, Some(checkpoint(29)));
    let (points, trained) = &earlier.maps["m"];
    assert_eq!(format!("{points:?}"), format!("{:?}", [0, 1, 2, 3, 4].map(point)));
    assert_eq!(*trained, [[1.0, 2.0]]);
    let all = [&samples()[..], &samples()[..2]].concat();
    assert_eq!(format!("{:?}", earlier.samples["s"]), format!("{all:?}"));
    let (mut rows, mut fields) = (Vec::new(), 0);
    again
        .replay(&mut |block| {
            match block {
                RecordBlock::Rows { first, values, modal, events } => {
                    assert_eq!((first, values[1][3]), (rows.len(), 2.0 * (first + 3) as f64));
                    assert_eq!((modal[1][4], events[1].point), (0.5 * (first + 4) as f32, first + 1));
                    rows.extend(values[0].clone());
                }
                RecordBlock::Field { number, motion: [displacement, velocity] } => {
                    assert!(number == fields && displacement == motion(number) && velocity == motion(100));
                    fields += 1;
                }
                _ => {}
            }
            Ok(())
        })
        .unwrap();
    assert!(rows == (0..30).map(f64::from).collect::<Vec<f64>>() && fields == 3);
    // What a kill leaves behind the last block that counts is overwritten.
    let path = dir.join(RECORD);
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, [&whole[..], &[4; 1000]].concat()).unwrap();
    again.add_map_points("m", 5, &[point(5)]).unwrap();
    again.add_samples("s", 5, &samples()).unwrap();
    again.end().unwrap();
    let (last, later) = resume(dir).unwrap().unwrap();
    assert!(last.ended() && later.maps["m"].0.len() == 6 && later.rows == 30);
    assert_eq!(later.samples["s"].len(), 8);
}

#[test]
fn files_at_any_moment_are_resumed() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let mut record = Record::new(dir, origin());
    begin(&mut record);
    assert!(resume(dir).unwrap().is_none());
    add(&mut record, 0);
    let one = std::fs::read(dir.join(CHECKPOINT)).unwrap();
    let begun = std::fs::read(dir.join(RECORD)).unwrap().len();
    let (_, before) = resume(dir).unwrap().unwrap();
    add(&mut record, 10);
    // Killed before the checkpoint was replaced, with any part of the second piece there.
    std::fs::write(dir.join(CHECKPOINT), &one).unwrap();
    let two = std::fs::read(dir.join(RECORD)).unwrap();
    for length in (begun..=two.len()).step_by(17) {
        std::fs::write(dir.join(RECORD), &two[..length]).unwrap();
        assert!(same(&resume(dir).unwrap().unwrap().1, &before), "{length} bytes");
    }
}

#[test]
fn a_file_that_was_changed_anywhere_is_refused() {
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
    let path = Path::new(RECORD);
    let whole = std::fs::read(dir.path().join(RECORD)).unwrap();
    let saved = std::fs::read(dir.path().join(CHECKPOINT)).unwrap();
    let (mut refused, mut read) = (0, 0);
    let mut look =
        |bytes: &[u8], length: usize| match read_record(path, bytes, length as u64, &mut |_| Ok(())) {
            Ok(_) => read += 1,
            Err(error) => {
                assert_eq!(error.exit_code(), 2);
                refused += 1;
            }
        };
    let changes: [fn(u8) -> u8; 4] = [|b| b ^ 1, |b| b ^ 0x80, |_| 0, |_| 0xff];
    for change in changes {
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] = change(bytes[at]);
            look(&bytes, whole.len());
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
    (0..whole.len()).for_each(|length| look(&whole[..length], length));
    (0..whole.len()).for_each(|length| look(&whole[..length], whole.len()));
    look(&[1, 255, 255, 255, 255, 255, 255, 255, 127], 9);
    assert!(refused > whole.len() && read > 100, "{refused} refused, {read} read");
}

#[test]
fn another_case_and_other_files_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    record(dir.path());
    let case = RecordOrigin { case: "title = \"another\"\n".into(), ..origin() };
    let said = Record::resume(dir.path(), &case).unwrap_err().to_string();
    assert!(said.contains("`title` was `\"a case\"` and is `\"another\"`"), "{said}");
    let mut files = origin();
    files.inputs[0].sha256 = "01".into();
    let said = Record::resume(dir.path(), &files).unwrap_err().to_string();
    assert!(said.contains("`a.msh` has changed"), "{said}");
}
