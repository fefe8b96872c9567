//! The loud part of a record.

use super::Plate;
use faer::Mat;

/// An earlier half is taken where it is louder than the last one by more than 1 dB.
const LOUDER: f64 = 1.26;
/// Pieces of the record of which the mean square is kept.
const PIECES: usize = 1024;

/// Finds the half of a record in which the plates move most: that of the largest Σ a_i², a_i the volume acceleration of piston i. It is
/// the last half, in which a squeal has grown, unless an earlier one is louder by more than 1 dB, as where the motion decays.
pub struct LoudHalf {
    /// Σ s_im s_in over all pistons.
    products: Mat<f64>,
    rows: usize,
    /// Rows of a piece, and Σ a² of the pieces so far.
    every: usize,
    sums: Vec<f64>,
    taken: usize,
}

impl LoudHalf {
    /// Of a record of so many rows, the start among them.
    pub(super) fn new(plates: &[Plate], modes: usize, rows: usize) -> Self {
        let products = Mat::from_fn(modes, modes, |m, n| {
            let of = |plate: &Plate| -> f64 {
                let strength = &plate.strength;
                (0..strength.nrows()).map(|i| strength[(i, m)] * strength[(i, n)]).sum()
            };
            plates.iter().map(of).sum()
        });
        let every = rows.div_ceil(PIECES).max(1);
        LoudHalf { products, rows, every, sums: vec![0.0; rows.div_ceil(every)], taken: 0 }
    }

    /// The next accelerations of the modes, one list each, all of one length.
    pub fn add(&mut self, block: &[Vec<f64>]) {
        let length = block.first().map_or(0, Vec::len);
        for k in 0..length {
            let mut square = 0.0;
            for (m, a) in block.iter().enumerate() {
                square +=
                    block.iter().enumerate().map(|(n, b)| self.products[(m, n)] * a[k] * b[k]).sum::<f64>();
            }
            if let Some(sum) = self.sums.get_mut((self.taken + k) / self.every) {
                *sum += square;
            }
        }
        self.taken += length;
    }

    /// The first row of that half.
    pub fn begin(&self) -> usize {
        let last = (self.rows - 1) / 2;
        let pieces = (self.rows - last).div_ceil(self.every);
        let of = |first: usize| self.sums[first..(first + pieces).min(self.sums.len())].iter().sum::<f64>();
        let latest = last / self.every;
        let (first, loudest) = (0..=latest)
            .map(|first| (first, of(first)))
            .fold((latest, of(latest)), |best, next| if next.1 > best.1 { next } else { best });
        if loudest > LOUDER * of(latest) { first * self.every } else { last }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two modes that move a piston each: bursts of half a record at any place are found, and a steady tone, whatever its modulation below
    /// 1 dB, is that of the last half.
    #[test]
    fn a_burst_is_found_and_a_steady_tone_is_that_of_the_last_half() {
        for rows in [101usize, 4_001, 20_000] {
            let last = (rows - 1) / 2;
            for part in 0..=16 {
                let start = last * part / 16;
                let mut loud = LoudHalf { products: Mat::identity(2, 2), ..LoudHalf::new(&[], 2, rows) };
                let inside = |k: usize| k >= start && k < start + rows - last;
                let tone = |k: usize, mode: usize| (0.9 * k as f64 + mode as f64).sin();
                let motion =
                    |mode: usize| (0..rows).map(|k| if inside(k) { tone(k, mode) } else { 0.0 }).collect();
                let block: Vec<Vec<f64>> = (0..2).map(motion).collect();
                loud.add(&block);
                // Within 1 dB of the whole burst: a fifth of it may be missed.
                let missed = loud.begin().abs_diff(start);
                assert!(missed <= (rows - last) / 5 + rows / PIECES + 1, "{rows} {start}: {}", loud.begin());
            }
            let mut steady = LoudHalf { products: Mat::identity(1, 1), ..LoudHalf::new(&[], 1, rows) };
            let grown = |k: usize| 1.0 - 0.05 * k as f64 / rows as f64;
            steady.add(&[(0..rows).map(|k| grown(k) * (0.9 * k as f64).sin()).collect()]);
            assert_eq!(steady.begin(), last);
        }
    }
}
