//! The same levels at other values of the parameters.

use crate::error::Result;
use std::ops::Range;

/// A mode with a smaller MAC than this with the level that it is taken for leaves a doubt.
const SURE: f64 = 0.6;
/// So often at most a way is halved.
const HALVINGS: usize = 3;

/// The modes of each level; none where it was not found.
pub type Picks = Vec<Vec<usize>>;

/// Gives each level as many of the `modes` as it has, the greatest MAC first, and returns whether that is certain.
pub fn most_alike(levels: &Picks, modes: Range<usize>, mac: impl Fn(usize, usize) -> f64) -> (Picks, bool) {
    let wanted = (0..levels.len()).filter(|l| !levels[*l].is_empty());
    let pair = |l: usize| modes.clone().map(move |k| (l, k));
    let mut pairs: Vec<(f64, usize, usize)> = wanted.flat_map(pair).map(|(l, k)| (mac(l, k), l, k)).collect();
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (mut found, mut taken) = (vec![Vec::new(); levels.len()], vec![false; modes.end]);
    let mut sure = true;
    for (mac, l, k) in pairs {
        if !taken[k] && found[l].len() < levels[l].len() {
            taken[k] = true;
            found[l].push(k);
            sure &= mac > SURE;
        }
    }
    for (found, level) in found.iter_mut().zip(levels) {
        found.sort_unstable();
        if found.len() < level.len() {
            found.clear();
        }
    }
    (found, sure)
}

/// Modes at one place: what they are, and how they are followed to another.
pub struct Path<'a, S> {
    /// The modes at a place.
    pub solve: &'a dyn Fn(&[f64]) -> Result<S>,
    /// The levels of the first among the modes of the second, and whether that is sure.
    pub follow: &'a dyn Fn(&S, &Picks, &S) -> (Picks, bool),
}

impl<S> Path<'_, S> {
    /// The levels of `from` among the modes of `to`. Where that leaves a doubt the way is halved: the answer depends on the
    /// two places alone.
    ///
    /// # Errors
    /// Modes on the way that cannot be computed.
    pub fn along(&self, from: (&[f64], &S, &Picks), to: (&[f64], &S)) -> Result<Picks> {
        self.halved(from, to, HALVINGS)
    }

    fn halved(&self, from: (&[f64], &S, &Picks), to: (&[f64], &S), halvings: usize) -> Result<Picks> {
        let (picks, sure) = (self.follow)(from.1, from.2, to.1);
        if sure || halvings == 0 {
            return Ok(picks);
        }
        let middle: Vec<f64> = from.0.iter().zip(to.0).map(|(a, b)| 0.5 * (a + b)).collect();
        let between = (self.solve)(&middle)?;
        let picks = self.halved(from, (&middle, &between), halvings - 1)?;
        self.halved((&middle, &between, &picks), to, halvings - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_that_turn_are_followed_on_the_way() {
        // Two modes in a plane that turn by x: at 50° each looks more like the other.
        let solve = |x: &[f64]| Ok(x[0]);
        let follow = |a: &f64, levels: &Picks, b: &f64| {
            let angle = |own: usize, k: usize| {
                (b - a).to_radians() + if own == k { 0.0 } else { 0.5 * std::f64::consts::PI }
            };
            most_alike(levels, 0..2, |l, k| angle(levels[l][0], k).cos().powi(2))
        };
        let path = Path { solve: &solve, follow: &follow };
        let levels = vec![vec![0], vec![1]];
        assert_eq!(follow(&0.0, &levels, &50.0).0, vec![vec![1], vec![0]]);
        assert_eq!(path.along((&[0.0], &0.0, &levels), (&[50.0], &50.0)).unwrap(), levels);
    }

    #[test]
    fn lost_levels_stay_lost_and_double_ones_take_two() {
        let levels = vec![vec![0, 1], vec![], vec![2]];
        let like = |l: usize, k: usize| [[0.9, 0.1, 0.8, 0.0], [1.0; 4], [0.0, 0.7, 0.0, 0.1]][l][k];
        assert_eq!(most_alike(&levels, 0..4, like), (vec![vec![0, 2], vec![], vec![1]], true));
        assert!(!most_alike(&levels, 2..4, like).1);
    }
}
