//! How like measured modes the computed ones are, and which is which.

use std::ops::Range;
use stridor_linalg::assignment::least_cost;
use stridor_linalg::c64;

/// |ln f ratio| is counted in units of this.
const FREQUENCY: f64 = 0.1;
/// Largest cost of a pair: 20 % of frequency for like shapes, or where no shape is known.
const ALONE: f64 = 2.0;
/// Shapes less alike than this are not of the same mode.
const LIKE: f64 = 0.5;
/// A motion that is this share of itself beyond the others of its level adds nothing to them.
const RANK: f64 = 1e-6;

/// Computed modes as the test would see them.
#[derive(Debug, Clone, Copy)]
pub struct ComputedModes<'a> {
    /// \[Hz\], ascending.
    pub frequencies_hz: &'a [f64],
    /// The levels: a single mode, or the two of a double one.
    pub levels: &'a [Range<usize>],
    /// The motion of each mode at the measured degrees of freedom; may be empty when no shape is compared.
    pub motions: &'a [Vec<f64>],
}

/// A measured mode to compare.
#[derive(Debug, Clone, Copy)]
pub struct ModeToPair<'a> {
    /// \[Hz\].
    pub frequency_hz: f64,
    /// Its shape at the measured degrees of freedom, if it is known.
    pub shape: Option<&'a [c64]>,
}

/// Which computed mode a measured one is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Index of the computed mode.
    pub mode: usize,
    /// MAC with its level, where the shape is known.
    pub mac: Option<f64>,
}

/// Squared cosine of the angle between a measured shape ψ and the space that computed motions φ span: for one φ it is
///
/// MAC = |φᵀψ|² / (φᵀφ · ψᴴψ)
///
/// (Allemang, Sound and Vibration 37 (2003) 14); for several, ‖Pψ‖²/‖ψ‖² with the orthogonal projection P on their
/// span, which does not depend on how a double mode is turned. Zero when either side is.
///
/// # Panics
/// When the lengths differ.
pub fn subspace_mac(shape: &[c64], motions: &[Vec<f64>]) -> f64 {
    let size: f64 = shape.iter().map(|v| v.norm_sqr()).sum();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for motion in motions {
        assert_eq!(motion.len(), shape.len(), "vectors of two lengths");
        let whole = norm(motion);
        let mut rest = motion.clone();
        // Twice is enough (Kahan; Parlett, The Symmetric Eigenvalue Problem, section 6.9).
        for _ in 0..2 {
            for q in &basis {
                let along: f64 = q.iter().zip(&rest).map(|(a, b)| a * b).sum();
                rest.iter_mut().zip(q).for_each(|(r, q)| *r -= along * q);
            }
        }
        let own = norm(&rest);
        if own > RANK * whole {
            basis.push(rest.iter().map(|r| r / own).collect());
        }
    }
    let along = |q: &Vec<f64>| -> f64 { q.iter().zip(shape).map(|(q, v)| v * *q).sum::<c64>().norm_sqr() };
    let inside: f64 = basis.iter().map(along).sum();
    if size > 0.0 { (inside / size).min(1.0) } else { 0.0 }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// The MAC of every measured mode (a row) with every level; a row without a shape is empty.
pub fn mac_table(measured: &[ModeToPair<'_>], computed: &ComputedModes<'_>) -> Vec<Vec<f64>> {
    let row = |shape: &[c64]| -> Vec<f64> {
        computed.levels.iter().map(|level| subspace_mac(shape, &computed.motions[level.clone()])).collect()
    };
    measured.iter().map(|mode| mode.shape.map_or(Vec::new(), row)).collect()
}

/// The computed mode that each measured one is: the assignment of least total cost
///
/// |ln(f/f′)|/0.1 + 1 − MAC,
///
/// the second part only where a shape is known. Each computed mode is taken once, so that a double level may take two.
/// A mode stays alone where nothing costs less than 2, or is as like as ½.
pub fn pair(
    measured: &[ModeToPair<'_>],
    computed: &ComputedModes<'_>,
    mac_table: &[Vec<f64>],
) -> Vec<Option<Pair>> {
    let modes = computed.frequencies_hz.len();
    let mut level_of = vec![0; modes];
    for (index, level) in computed.levels.iter().enumerate() {
        level.clone().for_each(|k| level_of[k] = index);
    }
    let alike = |row: usize, k: usize| mac_table[row].get(level_of[k]).copied();
    let cost = |row: usize, k: usize| -> f64 {
        let away = (measured[row].frequency_hz / computed.frequencies_hz[k]).ln().abs() / FREQUENCY;
        let cost = match alike(row, k) {
            Some(like) if like < LIKE => ALONE,
            like => away + like.map_or(0.0, |like| 1.0 - like),
        };
        if cost < ALONE { cost } else { 2.0 * ALONE }
    };
    // Beside the modes, a column for each measured mode that stays alone.
    let row = |row: usize| (0..modes).map(|k| cost(row, k)).chain(measured.iter().map(|_| ALONE)).collect();
    let costs: Vec<Vec<f64>> = (0..measured.len()).map(row).collect();
    let mut pairs = vec![None; measured.len()];
    for (row, k) in least_cost(&costs, modes + measured.len()) {
        if k < modes && costs[row][k] < ALONE {
            pairs[row] = Some(Pair { mode: k, mac: alike(row, k) });
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};
    use stridor_linalg::dense::mac;
    use stridor_linalg::random::Random;

    fn complex(values: &[f64]) -> Vec<c64> {
        values.iter().map(|v| c64::new(*v, 0.0)).collect()
    }

    #[test]
    fn mac_does_not_feel_scale_phase_or_the_turn_of_a_double_mode() {
        let mut random = Random::new();
        let mut vector = |n: usize| (0..n).map(|_| random.next()).collect::<Vec<f64>>();
        let (a, b) = (vector(9), vector(9));
        let shape: Vec<c64> = vector(9).iter().zip(vector(9)).map(|(re, im)| c64::new(*re, im)).collect();
        let one = subspace_mac(&shape, std::slice::from_ref(&a));
        assert!(within((one - mac(&complex(&a), &shape)).abs(), 1e-15, RoundOff));
        let turned: Vec<c64> = shape.iter().map(|v| v * c64::from_polar(3.0, 1.1)).collect();
        assert!(within(
            (subspace_mac(&turned, &[a.iter().map(|v| -7.0 * v).collect()]) - one).abs(),
            1e-14,
            RoundOff
        ));
        let double = subspace_mac(&shape, &[a.clone(), b.clone()]);
        for angle in [0.3f64, 1.0, 2.5] {
            let (sin, cos) = angle.sin_cos();
            let mix = |p: f64, q: f64| a.iter().zip(&b).map(|(a, b)| p * a + q * b).collect::<Vec<f64>>();
            assert!(within(
                (subspace_mac(&shape, &[mix(cos, sin), mix(-sin, cos)]) - double).abs(),
                1e-13,
                RoundOff
            ));
        }
        // Any mix of the two, with phases, lies in their span; a copy of one of them adds nothing.
        let inside: Vec<c64> = a.iter().zip(&b).map(|(a, b)| c64::new(*a, 2.0 * b)).collect();
        assert!(within((subspace_mac(&inside, &[a.clone(), b.clone()]) - 1.0).abs(), 1e-14, RoundOff));
        assert!(within((subspace_mac(&shape, &[a.clone(), a.clone()]) - one).abs(), 1e-12, RoundOff));
        assert_eq!(subspace_mac(&complex(&[0.0; 9]), &[a]), 0.0);
    }

    #[test]
    fn shapes_decide_where_frequencies_mislead() {
        let motions = [vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0], vec![0.0, 0.0, 1.0]];
        let hz = [100.0, 103.0, 200.0];
        let levels = [0..1, 1..2, 2..3];
        let computed = ComputedModes { frequencies_hz: &hz, levels: &levels, motions: &motions };
        let shapes = [complex(&[0.1, 1.0, 0.0]), complex(&[1.0, 0.1, 0.0]), complex(&[1.0, 1.0, 1.0])];
        let measured: Vec<ModeToPair> = [100.0, 103.0, 190.0]
            .iter()
            .zip(&shapes)
            .map(|(hz, shape)| ModeToPair { frequency_hz: *hz, shape: Some(shape) })
            .collect();
        let like = mac_table(&measured, &computed);
        let pairs = pair(&measured, &computed, &like);
        let modes: Vec<Option<usize>> = pairs.iter().map(|p| p.map(|p| p.mode)).collect();
        assert_eq!(modes, [Some(1), Some(0), None]);
        assert!(pairs[0].unwrap().mac.unwrap() > 0.98);
        // Without shapes the nearest ones.
        let bare: Vec<ModeToPair> = measured.iter().map(|m| ModeToPair { shape: None, ..*m }).collect();
        let pairs = pair(&bare, &computed, &mac_table(&bare, &computed));
        let modes: Vec<Option<usize>> = pairs.iter().map(|p| p.map(|p| p.mode)).collect();
        assert_eq!(modes, [Some(0), Some(1), Some(2)]);
    }

    #[test]
    fn a_double_level_takes_two_and_what_is_far_stays_alone() {
        let hz = [100.0, 100.05, 160.0];
        let levels = [0..2, 2..3];
        let computed = ComputedModes { frequencies_hz: &hz, levels: &levels, motions: &[] };
        let of = |frequency_hz| ModeToPair { frequency_hz, shape: None };
        let measured = [of(99.0), of(101.0), of(105.0), of(240.0)];
        let none = vec![Vec::new(); 4];
        let modes: Vec<Option<usize>> =
            pair(&measured, &computed, &none).iter().map(|p| p.map(|p| p.mode)).collect();
        assert_eq!(modes, [Some(0), Some(1), None, None]);
    }

    #[test]
    fn the_pairs_do_not_depend_on_greed() {
        // The nearest first would give 104 to 103 and leave 97 beside 112; the sum is less the other way.
        let hz = [100.0, 104.0];
        let levels = [0..1, 1..2];
        let computed = ComputedModes { frequencies_hz: &hz, levels: &levels, motions: &[] };
        let of = |frequency_hz| ModeToPair { frequency_hz, shape: None };
        let pairs = pair(&[of(103.0), of(112.0)], &computed, &[Vec::new(), Vec::new()]);
        assert_eq!(pairs.iter().map(|p| p.unwrap().mode).collect::<Vec<_>>(), [0, 1]);
    }
}
