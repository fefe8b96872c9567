//! Curves through equally spaced values.

/// Values at `parts` equal parts of each interval, the given ones included: cubics whose slope at a value is
/// (|d₂ − d₁| d₋₁ + |d₋₁ − d₋₂| d₁)/(|d₂ − d₁| + |d₋₁ − d₋₂|) with the differences d before and after it (H. Akima, J. ACM 17
/// (1970) 589). Beside a jump the curve does not overshoot as one through all values or one of a limited band does.
pub fn akima(values: &[f64], parts: usize) -> Vec<f64> {
    if values.len() < 3 || parts < 2 {
        return values.to_vec();
    }
    let mut d: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // Two differences beyond either end, as if the last two went on.
    for _ in 0..2 {
        d.insert(0, 2.0 * d[0] - d[1]);
        d.push(2.0 * d[d.len() - 1] - d[d.len() - 2]);
    }
    let slope = |k: usize| {
        let [before, after] = [(d[k + 1] - d[k]).abs(), (d[k + 3] - d[k + 2]).abs()];
        let whole = before + after;
        if whole > 0.0 { (after * d[k + 1] + before * d[k + 2]) / whole } else { 0.5 * (d[k + 1] + d[k + 2]) }
    };
    let slopes: Vec<f64> = (0..values.len()).map(slope).collect();
    let mut curve = Vec::with_capacity((values.len() - 1) * parts + 1);
    for (pair, slopes) in values.windows(2).zip(slopes.windows(2)) {
        let rise = pair[1] - pair[0];
        for part in 0..parts {
            let t = part as f64 / parts as f64;
            let square = 3.0 * rise - 2.0 * slopes[0] - slopes[1];
            let cube = slopes[0] + slopes[1] - 2.0 * rise;
            curve.push(pair[0] + t * (slopes[0] + t * (square + t * cube)));
        }
    }
    curve.extend(values.last());
    curve
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn a_circle_of_sixteen_points_is_round_and_a_jump_stays_one() {
        let of = |f: fn(f64) -> f64| {
            akima(&(0..=16).map(|k| f(TAU * f64::from(k) / 16.0)).collect::<Vec<f64>>(), 10)
        };
        let (x, y) = (of(f64::cos), of(f64::sin));
        assert_eq!(x.len(), 161);
        // The chords of the polygon come to 0.981; the cubics of the method are off by 1e-3 of sixteen points.
        let radii = x.iter().zip(&y).map(|(x, y)| x.hypot(*y));
        assert!(radii.skip(20).take(120).all(|r| within((r - 1.0).abs(), 0.004, Discretisation)));
        let jump: Vec<f64> = (0..12).map(|k| f64::from(k / 6)).collect();
        assert!(akima(&jump, 10).iter().all(|v| (0.0..=1.0).contains(v)));
        let line: Vec<f64> = (0..9).map(|k| 3.0 - 0.5 * f64::from(k)).collect();
        let curve = akima(&line, 4);
        assert!(curve.iter().enumerate().all(|(k, v)| within(
            (v - (3.0 - 0.125 * k as f64)).abs(),
            1e-12,
            RoundOff
        )));
        assert!(akima(&[1.0, 2.0], 8) == [1.0, 2.0] && akima(&[], 8).is_empty());
    }
}
