//! Numbers of arrays: text, base64 or raw bytes, plain or packed by zlib.
//!
//! In front of plain data is their length in bytes; in front of packed ones how many blocks there are, the size of each and of the last
//! before packing (0: like the others), and of each after it.

use super::grid::{Array, Format, Grid, Scalar, ScalarKind};
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, general_purpose::PAD};
use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;
use std::borrow::Cow;

/// Base64 with or without the `=` at its end.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    PAD.with_decode_allow_trailing_bits(true).with_decode_padding_mode(DecodePaddingMode::Indifferent),
);
/// Numbers of eight bytes are at most so many times as large as the file, also where arrays share their data: those of a grid, of types of one
/// byte and of constants, are packed by some ten times …
const MOST: usize = 64;
/// … and this \[byte\].
const LEAST: usize = 1 << 16;

/// Gives the numbers of arrays.
pub(super) struct Unpacker<'a> {
    big_endian: bool,
    header: usize,
    packed: bool,
    appended: Option<(&'a [u8], bool)>,
    /// Where appended arrays begin, ascending.
    offsets: Vec<usize>,
    /// How many bytes may still be decoded.
    left: usize,
}

/// Numbers of an array.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Numbers {
    Whole(Vec<i64>),
    Real(Vec<f64>),
}

impl Numbers {
    /// As real numbers.
    pub fn reals(self) -> Vec<f64> {
        match self {
            Numbers::Whole(all) => all.into_iter().map(|value| value as f64).collect(),
            Numbers::Real(all) => all,
        }
    }
}

impl<'a> Unpacker<'a> {
    pub fn new(grid: &Grid<'a>, file_size: usize) -> Self {
        let arrays = grid.pieces.iter().flat_map(|piece| piece.arrays.iter().chain(&piece.cell_data));
        let offset = |array: &Array<'_>| match array.format {
            Format::Appended(at) => Some(at),
            _ => None,
        };
        let mut offsets: Vec<usize> = arrays.filter_map(offset).collect();
        offsets.sort_unstable();
        let Grid { big_endian, header, packed, appended, .. } = *grid;
        let left = file_size.saturating_mul(MOST).saturating_add(LEAST);
        Unpacker { big_endian, header, packed, appended, offsets, left }
    }

    /// The numbers of an array.
    ///
    /// # Errors
    /// What is found instead.
    pub fn numbers(&mut self, array: &Array<'_>) -> Result<Numbers, String> {
        let Some(scalar) = array.scalar else { return Err("a type of numbers that is none of VTK".into()) };
        if array.format == Format::Text {
            return text(&array.text, scalar);
        }
        // Of a byte each may come a number of eight.
        let growth = 8 / scalar.size;
        let stream = self.stream(array)?;
        let bytes = match array.format {
            Format::Bytes => Cow::Borrowed(&stream[..]),
            _ if self.packed => self.unpacked(&stream, growth)?,
            _ => self.plain(&stream)?,
        };
        if !self.packed {
            self.charge(bytes.len() * growth)?;
        }
        if bytes.len() % scalar.size != 0 {
            return Err(format!("{} bytes, no whole numbers of {}", bytes.len(), scalar.size));
        }
        let each = bytes.chunks_exact(scalar.size);
        Ok(match scalar.kind {
            ScalarKind::Real => Numbers::Real(each.map(|own| self.real(own)).collect()),
            ScalarKind::Signed => Numbers::Whole(each.map(|own| self.whole(own, true)).collect()),
            ScalarKind::Unsigned => Numbers::Whole(each.map(|own| self.whole(own, false)).collect()),
        })
    }

    /// The bytes from the header of an array on; those of others may follow.
    fn stream<'b>(&mut self, array: &'b Array<'_>) -> Result<Cow<'b, [u8]>, String>
    where
        'a: 'b,
    {
        let at = match array.format {
            Format::Appended(at) => at,
            Format::Bytes => return Ok(Cow::Borrowed(&array.text)),
            Format::Base64 | Format::Text => return decoded(&array.text).map(Cow::Owned),
        };
        let Some((bytes, encoded)) = self.appended else {
            return Err("data that are appended, but no AppendedData".into());
        };
        let missing = || format!("offset {at}, which is behind the appended data of {} bytes", bytes.len());
        if !encoded {
            return bytes.get(at..).map(Cow::Borrowed).ok_or_else(missing);
        }
        let next = self.offsets.get(self.offsets.partition_point(|other| *other <= at));
        let end = next.map_or(bytes.len(), |next| (*next).min(bytes.len()));
        let own = bytes.get(at..end).ok_or_else(missing)?;
        self.charge(own.len())?;
        let own = own.split(|byte| *byte == b'<').next().unwrap_or_default();
        decoded(own).map(Cow::Owned)
    }

    /// Counts bytes that are decoded.
    fn charge(&mut self, bytes: usize) -> Result<(), String> {
        self.left = self.left.checked_sub(bytes).ok_or_else(|| {
            format!("data that unpack to {bytes} bytes, with the others more than {MOST} times the file")
        })?;
        Ok(())
    }

    /// The number of a header at a byte.
    fn size(&self, bytes: &[u8], at: usize) -> Result<usize, String> {
        let own = at.checked_add(self.header).and_then(|end| bytes.get(at..end));
        let own = own.ok_or_else(|| format!("{} bytes, which end within a header", bytes.len()))?;
        usize::try_from(self.whole(own, false)).map_err(|_| "a size above 2⁶³ bytes".into())
    }

    fn plain<'b>(&self, stream: &'b [u8]) -> Result<Cow<'b, [u8]>, String> {
        let size = self.size(stream, 0)?;
        let data = &stream[self.header..];
        data.get(..size).map(Cow::Borrowed).ok_or_else(|| format!("{} of {size} bytes", data.len()))
    }

    fn unpacked<'b>(&mut self, stream: &[u8], growth: usize) -> Result<Cow<'b, [u8]>, String> {
        let [count, size, last] = [0, 1, 2].map(|k| self.size(stream, k * self.header));
        let (count, size, last) = (count?, size?, last?);
        let begin = count.checked_add(3).and_then(|numbers| numbers.checked_mul(self.header));
        let mut begin = begin
            .filter(|begin| *begin <= stream.len())
            .ok_or_else(|| format!("{count} blocks, whose sizes {} bytes do not hold", stream.len()))?;
        let mut data = Vec::new();
        for block in 0..count {
            let packed = self.size(stream, (3 + block) * self.header)?;
            let end = begin.checked_add(packed).filter(|end| *end <= stream.len());
            let end = end.ok_or_else(|| format!("a block of {packed} bytes, which is behind the end"))?;
            let expected = if block + 1 == count && last > 0 { last } else { size };
            self.charge(expected.saturating_mul(growth))?;
            let own = decompress_to_vec_zlib_with_limit(&stream[begin..end], expected)
                .map_err(|error| format!("a block of zlib that does not unpack: {:?}", error.status))?;
            if own.len() != expected {
                return Err(format!("a block of {} bytes instead of {expected}", own.len()));
            }
            data.extend(own);
            begin = end;
        }
        Ok(Cow::Owned(data))
    }

    /// A number of at most eight bytes in the order of the file.
    fn whole(&self, own: &[u8], signed: bool) -> i64 {
        let leads = if self.big_endian { own.first() } else { own.last() };
        let negative = signed && leads.is_some_and(|byte| *byte >= 0x80);
        let mut all = [if negative { 0xff } else { 0 }; 8];
        for (k, byte) in own.iter().take(8).enumerate() {
            all[if self.big_endian { own.len() - 1 - k } else { k }] = *byte;
        }
        i64::from_le_bytes(all)
    }

    fn real(&self, own: &[u8]) -> f64 {
        let bits = self.whole(own, false) as u64;
        if own.len() == 4 { f64::from(f32::from_bits(bits as u32)) } else { f64::from_bits(bits) }
    }
}

/// Numbers as text.
fn text(text: &[u8], scalar: Scalar) -> Result<Numbers, String> {
    let text = String::from_utf8_lossy(text);
    let words = text.split_ascii_whitespace();
    if scalar.kind == ScalarKind::Real {
        let number = |word: &str| word.parse().map_err(|_| format!("`{}`, no number", short(word)));
        return Ok(Numbers::Real(words.map(number).collect::<Result<_, _>>()?));
    }
    let number = |word: &str| word.parse().map_err(|_| format!("`{}`, no whole number", short(word)));
    Ok(Numbers::Whole(words.map(number).collect::<Result<_, _>>()?))
}

fn short(word: &str) -> String {
    word.chars().take(30).collect()
}

/// Base64, of which header and data may end in `=` each.
fn decoded(text: &[u8]) -> Result<Vec<u8>, String> {
    use base64::Engine;
    let text: Vec<u8> = text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    for own in text.split(|byte| *byte == b'=').filter(|own| !own.is_empty()) {
        BASE64.decode_vec(own, &mut bytes).map_err(|error| format!("what is no base64: {error}"))?;
    }
    Ok(bytes)
}
