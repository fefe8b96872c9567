//! Decks that are cut, changed, huge: no panic, no endless loop, bounded memory.

use super::*;
use std::time::{Duration, Instant};

/// A deck with every keyword that is read.
const EVERYTHING: &str = include_str!("everything.inp");

/// Reads it within a time that no small deck takes.
fn reads(bytes: &[u8]) {
    let begun = Instant::now();
    let _ = read_bytes("a.inp", bytes, Format::Abaqus);
    assert!(begun.elapsed() < Duration::from_secs(20), "{}", String::from_utf8_lossy(bytes));
}

#[test]
fn a_deck_with_every_keyword_reads() {
    let deck = deck(EVERYTHING);
    assert_eq!((deck.nodes.len(), deck.elements.len(), deck.contacts.len(), deck.ties.len()), (46, 10, 1, 1));
    for row in super::super::keywords::words() {
        let keyword = format!("*{row}");
        let used =
            EVERYTHING.lines().any(|line| line.split(',').next().is_some_and(|word| word.trim() == keyword));
        assert!(used, "{keyword}");
    }
    assert_eq!(
        notes(&deck).iter().filter(|(weight, ..)| *weight == Weight::Matters).count(),
        0,
        "{:?}",
        notes(&deck)
    );
}

#[test]
fn decks_that_are_cut_or_changed_do_no_harm() {
    let bytes = EVERYTHING.as_bytes();
    for at in 0..bytes.len() {
        reads(&bytes[..at]);
        let mut changed = bytes.to_vec();
        for byte in [b'9', b'\n', b'*'] {
            changed[at] = byte;
            reads(&changed);
        }
        changed.remove(at);
        reads(&changed);
    }
    let lines: Vec<&str> = EVERYTHING.split_inclusive('\n').collect();
    for at in 0..lines.len() {
        let mut without = lines.clone();
        without.remove(at);
        reads(without.concat().as_bytes());
        for other in (at + 1..lines.len()).step_by(7) {
            let mut swapped = lines.clone();
            swapped.swap(at, other);
            reads(swapped.concat().as_bytes());
        }
    }
}

/// Each number of the deck in turn as one that is huge, zero, negative or none.
#[test]
fn numbers_that_are_out_of_range_do_no_harm() {
    let is_digit = |byte: u8| byte.is_ascii_digit() || byte == b'.';
    let bytes = EVERYTHING.as_bytes();
    let starts = (1..bytes.len()).filter(|at| is_digit(bytes[*at]) && !is_digit(bytes[at - 1]));
    for start in starts {
        let end = (start..bytes.len()).find(|at| !is_digit(bytes[*at])).unwrap_or(bytes.len());
        for number in
            ["18446744073709551615", "18446744073709551616", "0", "-1", "1e308", "1e-320", "nan", "inf", ""]
        {
            reads(&[&bytes[..start], number.as_bytes(), &bytes[end..]].concat());
        }
    }
}

/// Sets of sets twice as large as the last, a thousand supports of all nodes, ranges over all numbers, names with dots.
#[test]
fn what_grows_beyond_the_file_is_bounded() {
    let mut sets = String::from(BRICKS);
    sets += "*NSET, NSET=A0\nALL\n";
    (0..200).for_each(|k| sets += &format!("*NSET, NSET=A{}\nA{k}, A{k}\n", k + 1));
    assert!(faults(&sets)[0].contains("too many members"));
    let nodes: String = (1..20_000).map(|k| format!("{k}\n")).collect();
    let again = format!("*NODE, NSET=ALL\n{nodes}*BOUNDARY\n{}", "ALL, 1\n1, 2\n".repeat(5000));
    assert!(faults(&again)[0].contains("too many members"));
    let ranges = format!("{BRICKS}*NSET, NSET=A, GENERATE\n{}", "1, 18446744073709551615, 1\n".repeat(2000));
    assert_eq!(set(&deck(&ranges), "A").len(), 12);
    reads(
        format!(
            "{BRICKS}*PART, NAME=P\n*END PART\n*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n*NSET, NSET=A\n{}\n",
            "I.".repeat(500_000)
        )
        .as_bytes(),
    );
    let part = format!("*PART, NAME=P\n{BRICKS}*END PART\n");
    let instances: String =
        (0..20_000).map(|k| format!("*INSTANCE, NAME=I{k}, PART=P\n*END INSTANCE\n")).collect();
    assert!(
        read_bytes("a.inp", format!("{part}{instances}").as_bytes(), Format::Abaqus)
            .is_ok_and(|deck| deck.nodes.len() == 240_000)
    );
    let large = format!("*PART, NAME=P\n*NODE\n{nodes}*END PART\n{instances}");
    assert!(faults(&large)[0].contains("in all instances"));
    let materials: String = (0..20_000).map(|k| format!("*MATERIAL, NAME=M{k}\n")).collect();
    assert_eq!(deck(&materials).materials.len(), 20_000);
    // Free faces of the model for every element, one at a time.
    let free: String = (0..20_000).map(|k| format!("*SURFACE, NAME=S{k}\n1\n")).collect();
    assert_eq!(bricks(&free).surfaces.len(), 20_000);
}

/// Numbers of nodes and elements up to the largest.
#[test]
fn large_numbers_are_numbers() {
    let most = u64::MAX;
    let deck = deck(&format!(
        "*NODE\n{most}, 1., 2., 3.\n1, 0., 0., 0.\n*ELEMENT, TYPE=B31, ELSET=E\n{most}, {most}, 1\n*NSET, NSET=A, GENERATE\n1, {most}, {}\n*NSET, NSET=B\n{most}\n",
        most - 1
    ));
    assert_eq!(
        (set(&deck, "A"), set(&deck, "B"), elements(&deck, "E")),
        (vec![most, 1], vec![most], vec![most])
    );
    fault("*NODE\n18446744073709551616, 0, 0, 0\n", 2, "`18446744073709551616`");
    fault("*NODE\n1, nan, 0, 0\n", 2, "`nan`");
    fault("*NODE\n0, 1, 0, 0\n", 2, "`0`");
    let far = "*PART, NAME=P\n*NODE\n1, 1e308, 1e308, 0\n*END PART\n*INSTANCE, NAME=I, PART=P\n1e308, 1e308, 0\n0, 0, 0, 0, 0, 1, 45\n*END INSTANCE\n";
    assert!(faults(far).iter().any(|fault| fault.contains("a place that is finite")), "{:?}", faults(far));
    assert_eq!(faults("*NODE\nx\ny\nz\n").len(), 3);
    assert!(faults("")[0].contains("no keyword") && faults("version 1\noid 2\n")[0].contains("no keyword"));
}
