//! A number of the lowest eigenpairs.

use super::bounds::extrapolated;
use super::iteration::Iteration;
use super::{
    CLUSTER, EXPLORED, Eigenpairs, Factor, Found, INSIDE, Pencil, SETTLED, SturmCount, capacity, missing,
    none_found,
};
use crate::lanczos::{BlockLanczos, Window};
use stridor_base::error::Result;
use stridor_base::progress::Observer;

impl Pencil<'_> {
    /// The lowest `count` pairs; fewer where M reaches fewer, and more rather than cut a cluster.
    pub(super) fn count(&self, count: usize, observer: &dyn Observer) -> Result<Eigenpairs> {
        let (shift, factor, reach) = self.shift_for(count, observer)?;
        let negative = factor.inertia().negative;
        let (start, accepted) = ((shift, &*factor), self.accepted(reach));
        let mut iteration = Iteration::new([self.k, self.m], start, capacity(count + 1), accepted);
        // One more than wanted shows the gap above them.
        let mut total = (count + 1).max(negative + 1);
        // A bound above all of them and how many there are below it, once a count has shown that some were not seen.
        let mut known: Option<(f64, usize)> = None;
        for _ in 0..20 {
            let floor = known.map_or(0.0, |(bound, _)| 1.0 / (bound - shift));
            let window = Window { negative, largest: total - negative, floor };
            let (values, all) = iteration.values(window, observer)?;
            let Some(last) = values.last().copied() else { return Err(none_found(self.local_scale())) };
            let cut = if values.len() <= count {
                values.len()
            } else {
                let apart = |c: &usize| {
                    values[*c] - values[*c - 1]
                        > (CLUSTER * (values[*c] - shift).abs()).max(self.rigid_below())
                };
                match (count..values.len()).find(apart) {
                    Some(cut) => cut,
                    None => {
                        total += 2;
                        continue;
                    }
                }
            };
            let (low, high) = match values.get(cut) {
                Some(next) => (values[cut - 1], *next),
                None => (last, last + 0.2 * last.abs().max((last - shift).abs())),
            };
            let (bound, counted) = match known {
                Some((bound, counted)) if counted == cut && cut == values.len() => (bound, counted),
                // In a gap one count says all.
                _ => {
                    let part = |part: f64| low + part * (high - low);
                    self.count_near([0.5, 0.4, 0.6].map(part))?
                }
            };
            if counted > cut && !all {
                // Copies of a multiple eigenvalue that the iteration has not seen yet: it goes on until it has all.
                (total, known) = (counted, Some((bound, counted)));
                iteration.look_again();
                continue;
            }
            let (values, vectors) = iteration.pairs()?;
            let mut found = Found { values, vectors, shift, factor };
            found.truncate(cut);
            let sturm = SturmCount { bound, shifts: [bound; 2], counted: [counted; 2] };
            return self.certify(found, sturm);
        }
        Err(missing(total, total + 1, shift))
    }

    /// A shift in the middle of the lowest `count` eigenvalues, from Ritz values of a short run at a small negative one and,
    /// where that went too far, from the counts. Gives also the distance of the farthest.
    fn shift_for(&self, count: usize, observer: &dyn Observer) -> Result<(f64, Factor, f64)> {
        let scale = self.local_scale();
        let guess = [1e-9, 1e-7, 1e-5].map(|part| -part * scale);
        let (mut shift, mut factor) = self.factorize_near(guess)?;
        let (mut values, mut settled) = (Vec::new(), Vec::new());
        let mut lanczos = BlockLanczos::new(self.m, &*factor, count.min(EXPLORED) + 40, 1.0);
        let ritz = lanczos.explore(count.min(EXPLORED) + 32, observer)?;
        for (v, residual) in ritz.values.iter().zip(&ritz.residuals) {
            values.push(shift + 1.0 / v);
            if *residual <= SETTLED * v.abs() {
                settled.push(shift + 1.0 / v);
            }
        }
        drop(lanczos);
        values.sort_by(f64::total_cmp);
        settled.sort_by(f64::total_cmp);
        let lowest = values.first().copied().unwrap_or(0.0);
        let mut estimate = extrapolated(&settled, count)
            .or(values.get(count - 1).or(values.last()).copied())
            .unwrap_or(scale);
        if estimate <= self.rigid_below() {
            // All are negative or rigid-body motions: go below the negative ones, where the shift meets none.
            let reach = (estimate - shift).abs().max((lowest - shift).abs());
            if lowest < 1e3 * shift {
                (shift, factor) = self.factorize_near([1.5, 1.6, 1.7].map(|part| part * lowest))?;
            }
            return Ok((shift, factor, reach));
        }
        for _ in 0..6 {
            (shift, factor) = self.factorize_near(INSIDE.map(|part| part * estimate))?;
            let below = factor.inertia().negative;
            if below <= count + 8 {
                break;
            }
            // The modes of plates are about equally far in ω = √θ.
            estimate = shift * (count as f64 / below as f64).powi(2);
        }
        Ok((shift, factor, (estimate - shift).abs().max((lowest - shift).abs())))
    }
}
