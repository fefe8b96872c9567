//! Random changes of an input: of bytes, of lines, of numbers, of words, and parts of other inputs.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Pseudo-random numbers, the same for a seed.
pub struct Random(ChaCha8Rng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(ChaCha8Rng::seed_from_u64(seed))
    }

    /// A number below `count`; 0 for 0.
    pub fn below(&mut self, count: usize) -> usize {
        if count == 0 { 0 } else { self.0.gen_range(0..count) }
    }

    fn byte(&mut self) -> u8 {
        self.0.r#gen()
    }

    fn pick<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }

    /// A part of `length` things, mostly short.
    fn part(&mut self, length: usize) -> std::ops::Range<usize> {
        let start = self.below(length);
        let longest = if self.below(8) == 0 { length } else { 16 };
        start..(start + 1 + self.below(longest)).min(length)
    }
}

const NUMBERS: [&str; 40] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "4",
    "5",
    "7",
    "8",
    "9",
    "15",
    "16",
    "21",
    "55",
    "58",
    "151",
    "164",
    "255",
    "256",
    "2411",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "1e308",
    "-1e308",
    "1e-320",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "0.1",
    "1e5",
    "1D+03",
];

const BITS: [u64; 12] = [
    0,
    1,
    2,
    15,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    u64::MAX,
    1 << 40,
    0x7ff0_0000_0000_0000,
    0x7ff8_0000_0000_0000,
    0x7fef_ffff_ffff_ffff,
];

/// The longest input, but for few long ones.
const LONG: usize = 8 << 10;

/// A changed copy of one of `inputs`; `words` are put where words stand.
pub fn mutated(random: &mut Random, inputs: &[Vec<u8>], words: &[Vec<u8>]) -> Vec<u8> {
    // The later inputs are the newer ones: every second time one of them.
    let newest = if random.below(2) == 0 { 64 } else { inputs.len() }.min(inputs.len());
    let mut bytes = inputs[inputs.len() - 1 - random.below(newest)].clone();
    for _ in 0..1 + random.below(4) {
        let other = random.pick(inputs);
        change(random, &mut bytes, other, words);
    }
    if random.below(4000) == 0 {
        repeat_lines(random, &mut bytes);
    } else {
        bytes.truncate(LONG);
    }
    bytes
}

fn change(random: &mut Random, bytes: &mut Vec<u8>, other: &[u8], words: &[Vec<u8>]) {
    let length = bytes.len();
    let at = random.below(length);
    match random.below(15) {
        _ if length == 0 => bytes.extend_from_slice(other),
        0 => bytes[at] ^= 1 << random.below(8),
        1 => bytes[at] = random.byte(),
        2 => {
            let new = (0..1 + random.below(8)).map(|_| random.byte()).collect::<Vec<_>>();
            bytes.splice(at..at, new);
        }
        3 => drop(bytes.drain(random.part(length))),
        4 => {
            let copied = bytes[random.part(length)].to_vec();
            bytes.splice(at..at, copied);
        }
        5 => bytes.truncate(at),
        6 | 7 => change_lines(random, bytes),
        8..=10 => {
            let number = random.pick(&NUMBERS).as_bytes().to_vec();
            replace_word(random, bytes, number, |b| b.is_ascii_digit());
        }
        11 | 12 => {
            let word = random.pick(words).clone();
            replace_word(random, bytes, word, |b| b.is_ascii_alphabetic());
        }
        13 => {
            let part = other[random.part(other.len())].to_vec();
            bytes.splice(at..at, part);
        }
        _ => {
            let mut value = random.pick(&BITS).to_le_bytes();
            if random.below(2) == 0 {
                value.reverse();
            }
            let width = *random.pick(&[4, 8]);
            let end = (at + width).min(length);
            bytes[at..end].copy_from_slice(&value[..end - at]);
        }
    }
}

/// Puts `new` in the place of a word that holds a byte which `begins` one.
fn replace_word(random: &mut Random, bytes: &mut Vec<u8>, new: Vec<u8>, begins: impl Fn(u8) -> bool) {
    let from = random.below(bytes.len());
    let Some(at) = (from..bytes.len()).chain(0..from).find(|k| begins(bytes[*k])) else { return };
    let inside = |b: &u8| b.is_ascii_alphanumeric() || b"+-._$".contains(b);
    let start = at - bytes[..at].iter().rev().take_while(|b| inside(b)).count();
    let end = at + bytes[at..].iter().take_while(|b| inside(b)).count();
    bytes.splice(start..end, new);
}

fn change_lines(random: &mut Random, bytes: &mut Vec<u8>) {
    let mut lines: Vec<Vec<u8>> = bytes.split_inclusive(|b| *b == b'\n').map(<[u8]>::to_vec).collect();
    let (part, at) = (random.part(lines.len()), random.below(lines.len()));
    match random.below(4) {
        0 => drop(lines.drain(part)),
        1 => {
            let copied = lines[part].to_vec();
            lines.splice(at..at, copied);
        }
        2 => lines.swap(part.start, at),
        _ => {
            let taken: Vec<Vec<u8>> = lines.drain(part).collect();
            let at = at.min(lines.len());
            lines.splice(at..at, taken);
        }
    }
    *bytes = lines.concat();
}

/// Repeats some lines until the input is long, so that memory and time show what grows with it.
fn repeat_lines(random: &mut Random, bytes: &mut Vec<u8>) {
    let lines: Vec<&[u8]> = bytes.split_inclusive(|b| *b == b'\n').collect();
    let part = random.part(lines.len());
    let (before, repeated, after) =
        (lines[..part.start].concat(), lines[part.clone()].concat(), lines[part.end..].concat());
    let times = (16 * LONG) / repeated.len().max(1);
    *bytes = [before, repeated.repeat(times), after].concat();
}
