//! Columns packed side by side, row by row, as sparse products want them; and back.

use super::scalar::Scalar;
use pulp::{Arch, Simd, WithSimd};

/// Columns that are packed together, and rows and columns that change places in registers when they are unpacked.
const TILE: usize = 8;

/// A value aligned to a cache line (64 bytes): a row that spans two lines takes twice the time to fetch.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct Aligned<L>(pub L);

/// W values side by side.
pub(super) trait Row<T, const W: usize>: Copy + Send + Sync + 'static {
    /// A row of zeros.
    const ZERO: Self;
    fn values(&self) -> &[T; W];
    fn values_mut(&mut self) -> &mut [T; W];
}

impl<T: Scalar, const W: usize> Row<T, W> for [T; W] {
    const ZERO: Self = [T::ZERO; W];

    #[inline(always)]
    fn values(&self) -> &[T; W] {
        self
    }

    #[inline(always)]
    fn values_mut(&mut self) -> &mut [T; W] {
        self
    }
}

impl<T: Scalar, const W: usize> Row<T, W> for Aligned<[T; W]> {
    const ZERO: Self = Aligned([T::ZERO; W]);

    #[inline(always)]
    fn values(&self) -> &[T; W] {
        &self.0
    }

    #[inline(always)]
    fn values_mut(&mut self) -> &mut [T; W] {
        &mut self.0
    }
}

/// rows\[i\]\[c\] = columns\[c\]\[i\]; what a row has beyond the columns is left alone.
pub(super) fn pack<T: Scalar, R: Row<T, W>, const W: usize>(columns: &[&[T]], rows: &mut [R]) {
    Arch::new().dispatch(Lay { columns, rows });
}

/// columns\[c\]\[i\] = row(i)\[c\].
pub(super) fn unpack<'a, T: Scalar + 'a, const W: usize>(
    row: impl Fn(usize) -> &'a [T; W],
    columns: &mut [&mut [T]],
) {
    Arch::new().dispatch(Spread { row, columns });
}

struct Lay<'a, T, R, const W: usize> {
    columns: &'a [&'a [T]],
    rows: &'a mut [R],
}

impl<T: Scalar, R: Row<T, W>, const W: usize> WithSimd for Lay<'_, T, R, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let n = self.rows.len();
        for (columns, first) in self.columns.chunks(TILE).zip((0..).step_by(TILE)) {
            if let Ok(columns) = <[&[T]; TILE]>::try_from(columns) {
                let columns = columns.map(|column| &column[..n]);
                for (i, row) in self.rows.iter_mut().enumerate() {
                    row.values_mut()[first..first + TILE].copy_from_slice(&columns.map(|column| column[i]));
                }
            } else {
                for (column, c) in columns.iter().zip(first..) {
                    self.rows.iter_mut().zip(*column).for_each(|(row, v)| row.values_mut()[c] = *v);
                }
            }
        }
    }
}

struct Spread<'x, 'c, F, T> {
    row: F,
    columns: &'x mut [&'c mut [T]],
}

impl<'a, T: Scalar + 'a, F: Fn(usize) -> &'a [T; W], const W: usize> WithSimd for Spread<'_, '_, F, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (row, n) = (self.row, self.columns.first().map_or(0, |column| column.len()));
        for (columns, first) in self.columns.chunks_mut(TILE).zip((0..).step_by(TILE)) {
            let mut done = 0;
            if columns.len() == TILE {
                for i in (0..n - n % TILE).step_by(TILE) {
                    let turned = turned(std::array::from_fn(|r| tile(row(i + r), first)));
                    for (column, turned) in columns.iter_mut().zip(&turned) {
                        column[i..i + TILE].copy_from_slice(turned);
                    }
                }
                done = n - n % TILE;
            }
            for (column, c) in columns.iter_mut().zip(first..) {
                (done..n).for_each(|i| column[i] = row(i)[c]);
            }
        }
    }
}

#[inline(always)]
fn tile<T: Scalar>(from: &[T], first: usize) -> [T; TILE] {
    from[first..first + TILE].try_into().expect("as long")
}

#[inline(always)]
fn turned<T: Scalar>(rows: [[T; TILE]; TILE]) -> [[T; TILE]; TILE] {
    std::array::from_fn(|r| std::array::from_fn(|c| rows[c][r]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `.ci/widths` limits the vector instructions of the tests; here it shows that they are.
    #[test]
    fn vectors_are_as_wide_as_the_processor_is_said_to_have_them() {
        struct Lanes;
        impl WithSimd for Lanes {
            type Output = usize;

            fn with_simd<S: Simd>(self, _: S) -> usize {
                S::F64_LANES
            }
        }
        let expected = match std::env::var("VECTOR_WIDTH").as_deref() {
            Ok("avx512") => 8,
            Ok("avx2") => 4,
            Ok("sse2") => 1,
            _ => return,
        };
        assert_eq!(Arch::new().dispatch(Lanes), expected);
    }

    #[test]
    fn what_is_laid_spreads_again() {
        for (n, count) in [(19, 11), (8, 8), (5, 16), (32, 3)] {
            let columns: Vec<Vec<f64>> =
                (0..count).map(|c| (0..n).map(|i| (100 * c + i) as f64).collect()).collect();
            let mut rows = vec![Aligned([-1.0; 16]); n];
            pack(&columns.iter().map(|c| &c[..]).collect::<Vec<_>>(), &mut rows);
            for (i, row) in rows.iter().enumerate() {
                let expected = |c: usize| if c < count { columns[c][i] } else { -1.0 };
                assert_eq!(row.0, std::array::from_fn(expected));
            }
            let mut back = vec![vec![0.0; n]; count];
            unpack(|i| rows[i].values(), &mut back.iter_mut().map(|c| &mut c[..]).collect::<Vec<_>>());
            assert_eq!(back, columns);
        }
    }
}
