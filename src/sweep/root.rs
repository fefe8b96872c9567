//! Roots of a function of one variable, bracketed.

use crate::error::Result;

/// A bracket: f ≤ 0 at `below`, f > 0 at `above`; either may be the larger.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bracket {
    pub(super) below: (f64, f64),
    pub(super) above: (f64, f64),
}

/// Halvings one after the other after which the method begins anew; the next time twice as many.
const HALVINGS: i32 = 6;

/// Narrows a bracket by the ITP method (Oliveira & Takahashi, ACM Trans. Math. Softw. 47 (2020) 5) until it is no
/// longer than `tolerance`: faster than bisection where f is smooth, and slower by some steps at most. Once its only step in reserve is
/// used up, as at a kink of f, the largest of several functions, it would halve the bracket to the end: it begins anew then. At a
/// square root, where f jumps out of the round-off, it bisects. After `most` values of f, or one that is no number, the bracket is as
/// long as it is.
pub(super) fn narrow(
    mut bracket: Bracket,
    tolerance: f64,
    most: usize,
    mut f: impl FnMut(f64) -> Result<f64>,
) -> Result<Bracket> {
    let length = |b: &Bracket| (b.above.0 - b.below.0).abs();
    let mut first = length(&bracket);
    if tolerance.is_nan() || tolerance <= 0.0 || first <= tolerance {
        return Ok(bracket);
    }
    let most_steps = |first: f64| (first / tolerance).log2().ceil() as i32 + 1;
    let (mut steps, mut step, mut halvings) = (most_steps(first), 0, HALVINGS);
    for _ in 0..most {
        let (a, b) = (bracket.below, bracket.above);
        let size = length(&bracket);
        let middle = 0.5 * (a.0 + b.0);
        if size <= tolerance || middle == a.0 || middle == b.0 {
            break;
        }
        if step >= halvings && size > 0.9 * first * 0.5f64.powi(step) {
            (first, steps, step, halvings) = (size, most_steps(size), 0, 2 * halvings);
        }
        let secant = (b.1 * a.0 - a.1 * b.0) / (b.1 - a.1);
        let towards = (middle - secant).signum();
        let nudge = 0.2 * size * size / first;
        let truncated = if nudge <= (middle - secant).abs() { secant + towards * nudge } else { middle };
        let radius = (0.5 * tolerance * 2f64.powi(steps - step) - 0.5 * size).max(0.0);
        let x = if (truncated - middle).abs() <= radius { truncated } else { middle - towards * radius };
        let x = if x.is_finite() && x != a.0 && x != b.0 { x } else { middle };
        let value = f(x)?;
        step += 1;
        if value.is_nan() {
            break;
        }
        if value > 0.0 { bracket.above = (x, value) } else { bracket.below = (x, value) }
    }
    Ok(bracket)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn smooth_roots_take_few_steps_and_square_roots_as_many_as_bisection() {
        let mut count = 0;
        let smooth = |x: f64| {
            count += 1;
            Ok(x * x * x - 2.0)
        };
        let bracket = Bracket { below: (1.0, -1.0), above: (2.0, 6.0) };
        let found = narrow(bracket, 1e-12, usize::MAX, smooth).unwrap();
        assert!(within((found.above.0 - 2f64.cbrt()).abs(), 1e-12, Stated) && count < 20, "{count}");
        let mut count = 0;
        let onset = |x: f64| {
            count += 1;
            Ok(if x > 0.3 { (x - 0.3f64).sqrt() } else { -1e-9 })
        };
        let bracket = Bracket { below: (0.0, -1e-9), above: (1.0, 0.8) };
        let found = narrow(bracket, 1e-12, usize::MAX, onset).unwrap();
        assert!(within((found.above.0 - 0.3).abs(), 1e-12, Stated) && count <= 44, "{count}");
        let bracket = Bracket { below: (3.0, -1.0), above: (0.0, 2.0) };
        let falling = narrow(bracket, 1e-10, usize::MAX, |x| Ok(2.0 - x));
        assert!(within((falling.unwrap().below.0 - 2.0).abs(), 1e-10, Stated));
        // The largest of two: one that hardly changes, one that rises.
        let mut count = 0;
        let kink = |x: f64| {
            count += 1;
            Ok((-1.0 + 0.01 * x).max(40.0 * (x - 0.42)))
        };
        let bracket = Bracket { below: (0.0, -1.0), above: (1.0, 23.2) };
        let found = narrow(bracket, 3e-8, usize::MAX, kink).unwrap();
        assert!(within((found.above.0 - 0.42).abs(), 3e-8, Stated) && count <= 16, "{count}");
    }
}
