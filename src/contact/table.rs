//! A friction coefficient from measured values μ(v, p).

use super::coefficient::{Coefficient, FrictionCoefficient};
use crate::error::{Error, Fault, Faults, Result};

/// μ(v, p) through given values: monotone cubic in the speed (Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980)
/// 238: no overshoot between the values, continuous ∂μ/∂v, which is what falling friction depends on), linear in
/// the pressure, constant beyond the first and last values.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionTable {
    speeds: Vec<f64>,
    pressures: Vec<f64>,
    /// One row a pressure: μ at every speed.
    values: Vec<Vec<f64>>,
    /// ∂μ/∂v at every speed of every row.
    slopes: Vec<Vec<f64>>,
}

impl FrictionTable {
    /// `values[i][j]` is μ at `pressures[i]` and `speeds[j]` \[m/s\]; `place` names the table in faults.
    ///
    /// # Errors
    /// Speeds or pressures that are not finite, not ascending or negative, a coefficient that is not finite or is
    /// negative, rows of another length: all at once.
    pub fn new(place: &str, speeds: Vec<f64>, pressures: Vec<f64>, values: Vec<Vec<f64>>) -> Result<Self> {
        let mut faults = Faults::new();
        check_axis(&mut faults, &format!("{place}, speeds"), &speeds);
        check_axis(&mut faults, &format!("{place}, pressures"), &pressures);
        if values.len() != pressures.len() {
            let expected = format!("a row for each of the {} pressures", pressures.len());
            faults.push(Fault::new(place, format!("{} rows", values.len()), expected));
        }
        for (row, mus) in values.iter().enumerate() {
            let place = format!("{place}, row {}", row + 1);
            if mus.len() != speeds.len() {
                let expected = format!("one for each of the {} speeds", speeds.len());
                faults.push(Fault::new(&place, format!("{} coefficients", mus.len()), expected));
            }
            if let Some(bad) = mus.iter().find(|mu| !(mu.is_finite() && **mu >= 0.0)) {
                faults.push(Fault::new(&place, bad.to_string(), "finite coefficients, zero or more"));
            }
        }
        if !faults.0.is_empty() {
            return Err(Error::Input(faults));
        }
        let slopes = values.iter().map(|mus| monotone_slopes(&speeds, mus)).collect();
        Ok(FrictionTable { speeds, pressures, values, slopes })
    }

    /// μ and ∂μ/∂v on one row.
    fn along_speed(&self, row: usize, speed: f64) -> (f64, f64) {
        let (mus, slopes) = (&self.values[row], &self.slopes[row]);
        let Some((k, s)) = locate(&self.speeds, speed) else {
            let end = if speed <= self.speeds[0] { 0 } else { mus.len() - 1 };
            return (mus[end], 0.0);
        };
        let h = self.speeds[k + 1] - self.speeds[k];
        let (y0, y1, d0, d1) = (mus[k], mus[k + 1], h * slopes[k], h * slopes[k + 1]);
        // Cubic Hermite: y0 + s (d0 + s (c2 + s c3)).
        let c3 = 2.0 * (y0 - y1) + d0 + d1;
        let c2 = 3.0 * (y1 - y0) - 2.0 * d0 - d1;
        (y0 + s * (d0 + s * (c2 + s * c3)), (d0 + s * (2.0 * c2 + 3.0 * s * c3)) / h)
    }
}

impl FrictionCoefficient for FrictionTable {
    fn mu(&self, speed: f64, pressure: f64) -> Coefficient {
        let Some((k, s)) = locate(&self.pressures, pressure) else {
            let end = if pressure <= self.pressures[0] { 0 } else { self.pressures.len() - 1 };
            let (value, by_speed) = self.along_speed(end, speed);
            return Coefficient { value, by_speed, by_pressure: 0.0 };
        };
        let ((low, low_slope), (high, high_slope)) =
            (self.along_speed(k, speed), self.along_speed(k + 1, speed));
        Coefficient {
            value: low + s * (high - low),
            by_speed: low_slope + s * (high_slope - low_slope),
            by_pressure: (high - low) / (self.pressures[k + 1] - self.pressures[k]),
        }
    }
}

/// The interval that holds `x` and the fraction of it; `None` outside (or when there is no interval).
fn locate(axis: &[f64], x: f64) -> Option<(usize, f64)> {
    if !(x > axis[0] && x < axis[axis.len() - 1]) {
        return None;
    }
    let k = axis.partition_point(|a| *a <= x) - 1;
    Some((k, (x - axis[k]) / (axis[k + 1] - axis[k])))
}

/// Slopes at the values such that the cubic through them is monotone wherever they are; flat at an inner extremum.
fn monotone_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let secant: Vec<f64> = (1..n).map(|k| (y[k] - y[k - 1]) / (x[k] - x[k - 1])).collect();
    if secant.is_empty() {
        return vec![0.0; n];
    }
    let mut slope: Vec<f64> = (0..n)
        .map(|k| match k {
            0 => secant[0],
            k if k == n - 1 => secant[n - 2],
            k if secant[k - 1] * secant[k] <= 0.0 => 0.0,
            k => 0.5 * (secant[k - 1] + secant[k]),
        })
        .collect();
    for (k, s) in secant.iter().enumerate() {
        if *s == 0.0 {
            (slope[k], slope[k + 1]) = (0.0, 0.0);
            continue;
        }
        let (a, b) = (slope[k] / s, slope[k + 1] / s);
        let radius = a.hypot(b);
        if radius > 3.0 {
            (slope[k], slope[k + 1]) = (3.0 * a / radius * s, 3.0 * b / radius * s);
        }
    }
    slope
}

fn check_axis(faults: &mut Faults, place: &str, axis: &[f64]) {
    if axis.is_empty() {
        faults.push(Fault::new(place, "no value", "at least one"));
    }
    if let Some(bad) = axis.iter().find(|x| !(x.is_finite() && **x >= 0.0)) {
        faults.push(Fault::new(place, bad.to_string(), "finite values, zero or more"));
    } else if let Some(pair) = axis.windows(2).find(|pair| pair[1] <= pair[0]) {
        faults.push(Fault::new(place, format!("{} after {}", pair[1], pair[0]), "ascending values"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    fn falling() -> FrictionTable {
        let values = vec![vec![0.6, 0.5, 0.42, 0.4], vec![0.5, 0.45, 0.41, 0.41]];
        FrictionTable::new("friction", vec![0.0, 0.5, 1.0, 3.0], vec![1e5, 1e6], values).unwrap()
    }

    #[test]
    fn goes_through_its_values_without_overshoot_and_is_constant_beyond() {
        let table = falling();
        assert!(within((table.mu(0.5, 1e5).value - 0.5).abs(), 1e-15, RoundOff));
        assert!(within((table.mu(0.5, 5.5e5).value - 0.475).abs(), 1e-15, RoundOff));
        assert_eq!(table.mu(9.0, 2e6), Coefficient { value: 0.41, by_speed: 0.0, by_pressure: 0.0 });
        let mut last = f64::INFINITY;
        for k in 0..=300 {
            let mu = table.mu(k as f64 * 0.01, 1e5).value;
            assert!(mu <= last && (0.4..=0.6).contains(&mu));
            last = mu;
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let table = falling();
        for (v, p) in [(0.2, 3e5), (0.77, 9e5), (2.5, 2e5), (0.9, 1e3)] {
            let mu = table.mu(v, p);
            let (h, q) = (1e-6, 1.0);
            let by_speed = (table.mu(v + h, p).value - table.mu(v - h, p).value) / (2.0 * h);
            let by_pressure = (table.mu(v, p + q).value - table.mu(v, p - q).value) / (2.0 * q);
            assert!(
                within((mu.by_speed - by_speed).abs(), 1e-8, Reference)
                    && within((mu.by_pressure - by_pressure).abs(), 1e-13, Reference)
            );
        }
    }

    #[test]
    fn a_bad_table_is_refused_with_every_fault() {
        let values = vec![vec![0.5, f64::NAN], vec![0.4]];
        let text =
            FrictionTable::new("mu.csv", vec![1.0, 0.5], vec![0.0, -1.0], values).unwrap_err().to_string();
        for part in
            ["speeds: found 0.5 after 1", "pressures: found -1", "row 1: found NaN", "row 2: found 1 coeff"]
        {
            assert!(text.contains(part), "{text}");
        }
    }
}
