//! The power that a plate, or a face of a solid, sends out.

use super::{Air, Plate};
use faer::Mat;
use rayon::prelude::*;
use std::f64::consts::PI;
use stridor_linalg::dense::product;
use stridor_linalg::multivector::{expand, gram};

/// How the modes of a plate radiate together, over both its sides, or over the front where its back is not heard: half of that.
///
/// Far away, in the direction (ϑ, ψ) from the normal, p = ρ₀/(2πr) Σ_m q̈_m Â_m(κ) with the wavevector κ = k sin ϑ
/// (cos ψ, sin ψ) in the plane and Â_m(κ) = Σ_i s_im e^{iκ·x_i}. The power W = ∮ p̄²/(ρ₀c) r² dΩ over the half-spaces in
/// front and behind is
///
/// W = ρ₀/(πc) Σ_mn S_mn R_mn(k), R_mn(k) = ∫₀¹ G_mn(k √(1−μ²)) dμ, G_mn(κ) = 1/(2π) ∫ Re(Â_m Â_n*) dψ,
///
/// with S_mn the mean of q̈_m q̈_n and μ = cos ϑ: the hemisphere of directions, seen from the wavenumbers (E. G. Williams,
/// *Fourier Acoustics*, 1999, § 2.13). G is the transform of what is as wide as the plate, so G and R are polynomials in
/// k² but for round-off: they are sampled at N Chebyshev points in k², with N angles over half a turn, where 2N is k
/// times the plate's extent and a margin, and N Gauss points in μ.
#[derive(Debug)]
pub struct Radiation {
    /// k_max².
    top: f64,
    modes: usize,
    sides: f64,
    /// R at the Chebyshev points: entries m ≥ n row by row, one column a point.
    forms: Mat<f64>,
}

impl Radiation {
    /// Of a plate, up to the wavenumber `k_max` \[rad/m\].
    pub fn new(plate: &Plate, k_max: f64) -> Self {
        let places = plate.in_plane();
        let reach = places.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
        let extent = 2.0 * reach * k_max;
        let count = (0.5 * (extent + 6.0 * extent.cbrt())) as usize + 6;
        let (top, modes) = (k_max * k_max, plate.strength.ncols());
        let at_wavenumber = |j: usize| -> Vec<f64> {
            let kappa = (top * chebyshev(j, count)).sqrt();
            let mut waves = Mat::<f64>::zeros(places.len(), 2 * count);
            for w in 0..count {
                let (sin, cos) = (PI * w as f64 / count as f64).sin_cos();
                for (i, [x, y]) in places.iter().enumerate() {
                    let (im, re) = (kappa * (x * cos + y * sin)).sin_cos();
                    waves[(i, 2 * w)] = re;
                    waves[(i, 2 * w + 1)] = im;
                }
            }
            let sums = gram(waves.as_ref(), plate.strength.as_ref());
            let mean = gram(sums.as_ref(), sums.as_ref());
            entries(modes).map(|(m, n)| mean[(m, n)] / count as f64).collect()
        };
        let columns: Vec<Vec<f64>> = (0..count).into_par_iter().map(at_wavenumber).collect();
        let sampled = Mat::from_fn(modes * (modes + 1) / 2, count, |e, j| columns[j][e]);
        // ∫ dμ of the interpolating polynomial.
        let mut integral = Mat::<f64>::zeros(count, count);
        for (mu, weight) in gauss(count) {
            for j in 0..count {
                let square = chebyshev(j, count) * (1.0 - mu * mu);
                let parts = lagrange(square, count);
                parts.iter().enumerate().for_each(|(l, part)| integral[(l, j)] += weight * part);
            }
        }
        let sides = if plate.both_sides { 2.0 } else { 1.0 };
        Radiation { top, modes, sides, forms: product(sampled.as_ref(), integral.as_ref()) }
    }

    /// Contribution of each mode m to the power of its sides at the wavenumber `k`, ρ₀/(πc) Σ_n S_mn R_mn \[W\], for the mean
    /// products S_mn \[m²/s⁴ in modal units\] of the modal accelerations: entries m ≥ n row by row. The sum over the modes
    /// is W; it is negative for a mode that absorbs power radiated by others.
    ///
    /// # Panics
    /// When the entries are not those of as many modes as the plate has.
    pub fn power(&self, air: Air, k: f64, products: &[f64]) -> Vec<f64> {
        assert_eq!(products.len(), self.forms.nrows(), "an entry for each pair of modes");
        let parts = lagrange((k * k / self.top).min(1.0), self.forms.ncols());
        let resistance = expand(self.forms.as_ref(), Mat::from_fn(parts.len(), 1, |j, _| parts[j]).as_ref());
        let factor = 0.5 * self.sides * air.density / (PI * air.speed);
        let mut power = vec![0.0; self.modes];
        for (((m, n), r), s) in entries(self.modes).zip(resistance.col_as_slice(0)).zip(products) {
            power[m] += factor * r * s;
            if n != m {
                power[n] += factor * r * s;
            }
        }
        power
    }
}

/// The pairs (m, n), n ≤ m < `modes`, row by row.
pub(super) fn entries(modes: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..modes).flat_map(|m| (0..=m).map(move |n| (m, n)))
}

/// Chebyshev point j of `count` on \[0, 1\].
fn chebyshev(j: usize, count: usize) -> f64 {
    0.5 + 0.5 * (PI * (2 * j + 1) as f64 / (2 * count) as f64).cos()
}

/// The values at `x` of the polynomials that are 1 at one Chebyshev point and 0 at the others, in barycentric form
/// (J.-P. Berrut & L. N. Trefethen, SIAM Rev. 46 (2004) 501).
fn lagrange(x: f64, count: usize) -> Vec<f64> {
    let mut parts = Vec::with_capacity(count);
    for j in 0..count {
        let away = x - chebyshev(j, count);
        if away == 0.0 {
            return (0..count).map(|l| if l == j { 1.0 } else { 0.0 }).collect();
        }
        let weight = (PI * (2 * j + 1) as f64 / (2 * count) as f64).sin();
        parts.push(if j % 2 == 0 { weight / away } else { -weight / away });
    }
    let sum: f64 = parts.iter().sum();
    parts.iter_mut().for_each(|part| *part /= sum);
    parts
}

/// Gauss–Legendre points and weights on \[0, 1\], by Newton's method from Tricomi's estimate.
fn gauss(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let point = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut before, mut now) = (1.0, x);
            for degree in 2..=count {
                let d = degree as f64;
                (before, now) = (now, ((2.0 * d - 1.0) * x * now - (d - 1.0) * before) / d);
            }
            slope = n * (x * now - before) / (x * x - 1.0);
            x -= now / slope;
        }
        (0.5 + 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::super::plate::samples::disc;
    use super::*;
    use puruspe::Jn;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn the_quadratures_are_exact_for_polynomials() {
        for (p, exact) in [(0, 1.0), (1, 0.5), (8, 1.0 / 9.0), (23, 1.0 / 24.0)] {
            let sum: f64 = gauss(12).iter().map(|(x, w)| w * x.powi(p)).sum();
            assert!(within((sum - exact).abs(), 1e-14, RoundOff), "{p}: {sum}");
        }
        let parts = lagrange(0.3217, 9);
        let back: f64 = parts.iter().enumerate().map(|(j, part)| part * chebyshev(j, 9).powi(8)).sum();
        assert!(within((back - 0.3217f64.powi(8)).abs(), 1e-15, RoundOff));
    }

    #[test]
    fn a_piston_radiates_by_its_resistance() {
        // One side: W = ½ ρ₀ c π a² (1 − 2J₁(2ka)/(2ka)) |v|²; L. E. Kinsler et al., Fundamentals of Acoustics, 4th ed.,
        // § 7.5.
        let (a, air) = (0.075, Air::default());
        let plate = disc(a, 36, &[&|_, _| 1.0]);
        let radiation = Radiation::new(&plate, 220.0);
        for ka in [1e-3, 0.3, 1.0, 2.5, 5.0, 10.0, 16.0] {
            let k = ka / a;
            let omega = k * air.speed;
            let found = radiation.power(air, k, &[0.5 * omega * omega])[0];
            let resistance = 1.0 - Jn(1, 2.0 * ka) / ka;
            let exact = 2.0 * 0.5 * air.density * air.speed * PI * a * a * resistance;
            // Discretisation: the largest k is 213 of 220 that the points are made for.
            assert!(within((found / exact - 1.0).abs(), 2e-3, Discretisation), "{ka}: {found} {exact}");
        }
        // A small piston is a monopole of volume acceleration Q̇ in a baffle: ρ₀ Q̇²/(4πc) a side, Q̇ its amplitude.
        let small = Radiation::new(&disc(1e-3, 10, &[&|_, _| 1.0]), 100.0);
        let volume = PI * 1e-6;
        let exact = 2.0 * air.density * volume * volume / (4.0 * PI * air.speed);
        assert!(within((small.power(air, 50.0, &[0.5])[0] / exact - 1.0).abs(), 1e-3, Discretisation));
    }

    #[test]
    fn modes_that_move_together_radiate_like_their_sum() {
        let (one, two) = (|r: f64, _: f64| 1.0 - 2.0 * r * r, |r: f64, t: f64| r * r + r * (2.0 * t).cos());
        let sum = |r: f64, t: f64| one(r, t) - 0.7 * two(r, t);
        let radiation = Radiation::new(&disc(0.1, 20, &[&one, &two, &sum]), 100.0);
        let air = Air::default();
        let parts = radiation.power(air, 63.0, &[1.0, -0.7, 0.49, 0.0, 0.0, 0.0]);
        let whole = radiation.power(air, 63.0, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0])[2];
        assert!(
            within(((parts[0] + parts[1]) / whole - 1.0).abs(), 1e-12, RoundOff) && parts[2] == 0.0,
            "{parts:?} {whole}"
        );
    }

    #[test]
    fn a_supported_square_radiates_as_published() {
        // Radiation efficiency σ = W/(½ρ₀ c A ⟨v²⟩) of one side for ka ≪ 1: C. E. Wallace, J. Acoust. Soc. Am. 51 (1972)
        // 946. Mode (1, 1) is a monopole, mode (2, 1) a dipole.
        let (side, cells, air) = (0.2, 40, Air::default());
        let (mut points, mut values) = (Vec::new(), Vec::new());
        for i in 0..cells {
            for j in 0..cells {
                let [x, y] = [i, j].map(|k| side * (k as f64 + 0.5) / cells as f64);
                points.push([x - 0.5 * side, y - 0.5 * side, 0.0]);
                let mode = |m: f64, n: f64| (m * PI * x / side).sin() * (n * PI * y / side).sin();
                values.push([mode(1.0, 1.0), mode(2.0, 1.0)]);
            }
        }
        let cell = (side / cells as f64).powi(2);
        let strength = Mat::from_fn(points.len(), 2, |i, m| cell * values[i][m]);
        let plate = Plate {
            name: "square".into(),
            normal: [0.0, 0.0, 1.0],
            both_sides: true,
            middle: [0.0; 3],
            points,
            strength,
        };
        let radiation = Radiation::new(&plate, 60.0);
        let efficiency = |k: f64, products: [f64; 3]| {
            let omega = k * air.speed;
            // ⟨v²⟩ = v²/4 of amplitude v over the plate.
            let per = 0.5 * air.density * air.speed * side * side * 0.25;
            0.5 * radiation.power(air, k, &products.map(|p| 0.5 * p * omega * omega)).iter().sum::<f64>()
                / per
        };
        let k = 0.3 / side;
        let (ka, first) = ((k * side).powi(2), 1.0 - 8.0 / (PI * PI));
        let odd = 32.0 * ka / PI.powi(5) * (1.0 - ka / 12.0 * 2.0 * first);
        let found = efficiency(k, [1.0, 0.0, 0.0]);
        // The next terms of the series in (k side)² = 0.09, and discretisation.
        assert!(within((found / odd - 1.0).abs(), 2e-3, Theory), "{found} {odd}");
        let second = 1.0 - 24.0 / (4.0 * PI * PI);
        let even = 8.0 * ka * ka / (3.0 * 4.0 * PI.powi(5)) * (1.0 - ka / 20.0 * (first + second));
        let found = efficiency(k, [0.0, 0.0, 1.0]);
        assert!(within((found / even - 1.0).abs(), 4e-3, Theory), "{found} {even}");
        // Two modes of unlike symmetry do not know of each other.
        let both = efficiency(k, [1.0, 0.7, 1.0]) - efficiency(k, [1.0, 0.0, 1.0]);
        assert!(within(both.abs(), 1e-9 * odd, RoundOff));
        // Far above coincidence every plate reaches one.
        let high = Radiation::new(&plate, 400.0);
        let omega = 380.0 * air.speed;
        let per = 0.5 * air.density * air.speed * side * side * 0.25;
        let found = 0.5 * high.power(air, 380.0, &[0.5 * omega * omega, 0.0, 0.0])[0] / per;
        assert!(within((found - 1.0).abs(), 0.01, Theory), "{found}");
    }
}
