//! Statistics of samples.

use statrs::function::gamma::ln_gamma;

/// A probability estimated as the share of samples, with its confidence interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proportion {
    /// Samples that have the property.
    pub count: usize,
    /// All samples.
    pub of: usize,
    /// `count` / `of`; not a number without samples.
    pub share: f64,
    /// Limits of the interval.
    pub limits: [f64; 2],
}

/// The share `count` / `of` and its interval of this `confidence`, by Clopper and Pearson (Biometrika 26 (1934) 404): exact for independent
/// samples, so that it covers the probability at least so often.
pub fn proportion(count: usize, of: usize, confidence: f64) -> Proportion {
    let (k, n, tail) = (count as f64, of as f64, 0.5 * (1.0 - confidence));
    let low = if count == 0 { 0.0 } else { beta_quantile(tail, k, n - k + 1.0) };
    // From above as from below with the samples that do not have the property.
    let high = if count == of { 1.0 } else { 1.0 - beta_quantile(tail, n - k, k + 1.0) };
    Proportion { count, of, share: k / n, limits: [low, high] }
}

/// x with I_x(a, b) = `p`, by halving.
fn beta_quantile(p: f64, a: f64, b: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    // Until there is no number between them.
    loop {
        let middle: f64 = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if incomplete_beta(a, b, middle) < p { low = middle } else { high = middle }
    }
}

/// Regularised incomplete beta function I_x(a, b), 0 < x < 1, by its continued fraction (Abramowitz and Stegun 26.5.8) in the form of Lentz.
/// Those of statrs stops too early where a and b are in the thousands.
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    // Where the fraction converges in about √max(a, b) steps.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(b, a, 1.0 - x);
    }
    let factor = ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (-x).ln_1p();
    let away = |value: f64| if value.abs() < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { value };
    // 1/(1 + t₁/(1 + t₂/(1 + …))).
    let (mut c, mut d, mut fraction) = (f64::INFINITY, 1.0, 1.0);
    for step in 1..100_000 {
        let m = f64::from(step / 2);
        let term = match step % 2 {
            0 => m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)),
            _ => -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0)),
        };
        d = 1.0 / away(1.0 + term * d);
        c = away(1.0 + term / c);
        fraction *= c * d;
        if (c * d - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    factor.exp() * fraction / a
}

/// Quantile `p` of ascending values, linear between them (type 7 of Hyndman and Fan, Am. Stat. 50 (1996) 361); not a number without values.
pub fn quantile(ascending: &[f64], p: f64) -> f64 {
    let Some(last) = ascending.len().checked_sub(1) else { return f64::NAN };
    let place = p * last as f64;
    let below = (place as usize).min(last);
    let above = (below + 1).min(last);
    ascending[below] + (place - below as f64) * (ascending[above] - ascending[below])
}

/// Spearman's rank correlation ρ of x and y, from −1 to 1; not a number where one of them does not vary.
pub fn spearman(x: &[f64], y: &[f64]) -> f64 {
    let (x, y) = (ranks(x), ranks(y));
    // The mean rank.
    let mean = 0.5 * (x.len() as f64 - 1.0);
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>();
    product(&x, &y) / (product(&x, &x) * product(&y, &y)).sqrt()
}

/// The rank of every value, from 0; equal values share their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let order = ascending(values);
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for equal in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = first as f64 + 0.5 * (equal.len() as f64 - 1.0);
        equal.iter().for_each(|k| ranks[*k] = rank);
        first += equal.len();
    }
    ranks
}

/// The indices of values in ascending order.
fn ascending(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    order
}

/// First-order Sobol index S = Var(E(y | x)) / Var(y) of a scalar x that is independent of the others: the share of the variance of y
/// that would vanish on average if x were known.
///
/// Estimated from the samples themselves, each compared with that of the next larger x (Gamboa, Gremaud, Klein and Lagnoux, Bernoulli 28
/// (2022) 2345): S ≈ (Σ yᵢ yₙ₍ᵢ₎ / n − ȳ²) / (Σ yᵢ² / n − ȳ²). Its standard deviation is about 1/√n, so that it may be a little below zero.
/// Not a number where y does not vary.
pub fn first_order(x: &[f64], y: &[f64]) -> f64 {
    let (order, n) = (ascending(x), x.len());
    let mean = y.iter().sum::<f64>() / n as f64;
    let away = |k: usize| y[order[k % n]] - mean;
    let square = (0..n).map(|k| away(k) * away(k)).sum::<f64>();
    (0..n).map(|k| away(k) * away(k + 1)).sum::<f64>() / square
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::uncertainty::{Distribution, Sampling, samples};
    use std::f64::consts::PI;

    #[test]
    fn intervals_are_those_of_tables() {
        // None of n: 1 − (α/2)^(1/n). The others: quantiles of the beta distribution by R.
        let none = proportion(0, 10, 0.95);
        assert!(
            none.limits[0] == 0.0
                && within((none.limits[1] - (1.0 - 0.025_f64.powf(0.1))).abs(), 1e-8, Tolerance)
        );
        let all = proportion(10, 10, 0.95);
        assert!(within((all.limits[0] - 0.025_f64.powf(0.1)).abs(), 1e-8, Tolerance) && all.limits[1] == 1.0);
        for (count, of, limits) in [(5, 10, [0.187_086, 0.812_914]), (1, 20, [0.001_265, 0.248_733])] {
            let found = proportion(count, of, 0.95).limits;
            assert!(
                found.iter().zip(limits).all(|(a, b)| within((a - b).abs(), 1e-6, Reference)),
                "{found:?}"
            );
        }
        // Of very many samples the normal distribution has it, too.
        let many = proportion(300_000, 1_000_000, 0.95).limits;
        let half = 1.959_964 * (0.3 * 0.7 / 1e6_f64).sqrt();
        assert!(
            within((many[0] - (0.3 - half)).abs(), 2e-6, Theory)
                && within((many[1] - (0.3 + half)).abs(), 2e-6, Theory),
            "{many:?}"
        );
        // One of n: 1 − (1 − p)^n = α/2 at the lower limit p.
        let seldom = -f64::exp_m1(f64::ln_1p(-0.0005) / 1e6);
        let found = proportion(1, 1_000_000, 0.999).limits[0];
        assert!(within((found / seldom - 1.0).abs(), 1e-6, Tolerance), "{found:e} {seldom:e}");
    }

    #[test]
    fn quantiles_are_linear_between_values() {
        let values = [1.0, 2.0, 4.0, 8.0];
        assert_eq!([0.0, 0.5, 1.0].map(|p| quantile(&values, p)), [1.0, 3.0, 8.0]);
        assert_eq!(quantile(&[3.0], 0.95), 3.0);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn ranks_correlate_along_any_monotonic_curve() {
        let x = [3.0, 1.0, 2.0, 5.0, 4.0];
        let y = x.map(|x: f64| x.exp());
        assert!(within((spearman(&x, &y) - 1.0).abs(), 1e-15, RoundOff));
        assert!(within((spearman(&x, &y.map(|y| -y)) + 1.0).abs(), 1e-15, RoundOff));
        // With ties, by hand: ranks 0.5, 0.5, 2 and 0, 1, 2.
        let rho = spearman(&[1.0, 1.0, 2.0], &[1.0, 2.0, 3.0]);
        assert!(within((rho - 0.75_f64.sqrt()).abs(), 10.0 * f64::EPSILON, RoundOff), "{rho}");
        assert!(spearman(&x, &[1.0; 5]).is_nan() && first_order(&x, &[1.0; 5]).is_nan());
    }

    #[test]
    fn first_order_indices_are_those_of_the_function_of_ishigami() {
        // sin x₁ + 7 sin² x₂ + x₃⁴ sin x₁ / 10: 0.3139, 0.4424 and 0 in closed form.
        let own = Distribution { between: [-PI, PI], normal: None, log: false };
        for sampling in [Sampling::Random, Sampling::LatinHypercube] {
            let all = samples(&[own; 3], 20_000, sampling, 1);
            let ishigami =
                |x: &Vec<f64>| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin();
            let y: Vec<f64> = all.iter().map(ishigami).collect();
            for (j, exact) in [0.3139, 0.4424, 0.0].into_iter().enumerate() {
                let x: Vec<f64> = all.iter().map(|sample| sample[j]).collect();
                let found = first_order(&x, &y);
                assert!(within((found - exact).abs(), 0.03, RandomSample), "{sampling:?} {j}: {found}");
            }
        }
    }
}
