//! Numbers and texts as bytes, little endian, and back. Reading never allocates more than the bytes at hand allow.

/// Value read from bytes, or their fault.
pub(super) type Read<T> = std::result::Result<T, &'static str>;

const SHORT: &str = "it ends too early";

/// Bytes to be written.
#[derive(Default)]
pub(super) struct Bytes(pub(super) Vec<u8>);

impl Bytes {
    pub(super) fn count(&mut self, count: usize) {
        self.0.extend((count as u64).to_le_bytes());
    }

    pub(super) fn text(&mut self, text: &str) {
        self.count(text.len());
        self.0.extend(text.as_bytes());
    }

    pub(super) fn doubles<'a>(&mut self, values: impl IntoIterator<Item = &'a f64>) {
        values.into_iter().for_each(|value| self.0.extend(value.to_le_bytes()));
    }

    pub(super) fn singles(&mut self, values: impl IntoIterator<Item = f32>) {
        values.into_iter().for_each(|value| self.0.extend(value.to_le_bytes()));
    }
}

/// Bytes that are read from their start.
#[derive(Clone, Copy)]
pub(super) struct RecordCursor<'a>(pub(super) &'a [u8]);

impl<'a> RecordCursor<'a> {
    pub(super) fn take(&mut self, count: usize) -> Read<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(SHORT)?;
        self.0 = rest;
        Ok(taken)
    }

    pub(super) fn array<const N: usize>(&mut self) -> Read<[u8; N]> {
        Ok(self.take(N)?.try_into().expect("as many as were taken"))
    }

    pub(super) fn whole(&mut self) -> Read<u64> {
        Ok(u64::from_le_bytes(self.array()?))
    }

    /// A number of something that is elsewhere.
    pub(super) fn index(&mut self) -> Read<usize> {
        u32::try_from(self.whole()?).map(|index| index as usize).map_err(|_| "a number that is too large")
    }

    /// How many things of at least `each` bytes follow.
    pub(super) fn count(&mut self, each: usize) -> Read<usize> {
        let count = usize::try_from(self.whole()?).map_err(|_| SHORT)?;
        let bytes = count.checked_mul(each.max(1)).ok_or(SHORT)?;
        if bytes <= self.0.len() { Ok(count) } else { Err(SHORT) }
    }

    pub(super) fn text(&mut self) -> Read<String> {
        let length = self.count(1)?;
        let text = std::str::from_utf8(self.take(length)?).map_err(|_| "a text in it is not UTF-8")?;
        Ok(text.to_string())
    }

    pub(super) fn doubles(&mut self, count: usize) -> Read<Vec<f64>> {
        let bytes = self.take(count.checked_mul(8).ok_or(SHORT)?)?;
        Ok(bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight"))).collect())
    }

    pub(super) fn singles(&mut self, count: usize) -> Read<Vec<f32>> {
        let bytes = self.take(count.checked_mul(4).ok_or(SHORT)?)?;
        Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().expect("four"))).collect())
    }

    /// `value`, when nothing follows.
    pub(super) fn end<T>(self, value: T) -> Read<T> {
        if self.0.is_empty() { Ok(value) } else { Err("it is longer than its stated length") }
    }
}
