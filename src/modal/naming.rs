//! Names disc modes by their nodal diameters and circles.
//!
//! The transverse displacement at scattered points (r, θ) is fitted, by least squares, with
//!
//!   w(r, θ) ≈ Σ_n Σ_j [ a_nj cos nθ + b_nj sin nθ ] T_j(ρ),   ρ ∈ [−1, 1] from the innermost to the outermost point,
//!
//! T_j the Chebyshev polynomials. The energy of each n is that of the fitted field on the whole annulus, so that it
//! does not matter where the mesh is fine. The mode is named when one n holds most of the energy; its nodal circles
//! are the sign changes of that component along the radius.

use super::DiscModeName;
use crate::linalg::dense::{cholesky, product};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Mat, Par};
use std::f64::consts::{PI, TAU};

/// The most nodal diameters that are distinguished.
const MOST_DIAMETERS: usize = 24;
/// The highest degree of the polynomials in ρ.
const MOST_DEGREE: usize = 8;
/// More points than this add nothing; a fixed selection of them is used.
const MOST_POINTS: usize = 4000;
/// Points for each coefficient of the fit, at least.
const POINTS_A_COEFFICIENT: usize = 4;
/// Share of the points' weight by which smooth fields are preferred where the points leave a choice.
const SMOOTHING: f64 = 1e-4;
/// A mode is named when one n has this share of the energy (what the fit misses counts as energy too).
const DOMINANT: f64 = 0.7;
/// Lobes along the radius smaller than this share of the largest are not counted.
const SMALLEST_LOBE: f64 = 0.05;
/// Radii at which the fitted field is evaluated.
const RADII: usize = 129;

/// The points of a disc, ready to name any number of its modes.
#[derive(Debug, Clone)]
pub struct DiscPoints {
    n_points: usize,
    /// The points used.
    chosen: Vec<usize>,
    diameters: usize,
    degree: usize,
    /// n_chosen × n_coefficients.
    basis: Mat<f64>,
    /// L of L Lᵀ = BᵀB + a small diagonal that grows with n and j.
    factor: Mat<f64>,
    inner: f64,
    outer: f64,
}

impl DiscPoints {
    /// Points at radius r \[m\] and angle θ \[rad\] about the disc's centre. `None` when there are too few of them, or
    /// they leave out more than a quarter of the circle.
    pub fn new(points: &[(f64, f64)]) -> Option<Self> {
        if points.iter().any(|(r, angle)| !r.is_finite() || !angle.is_finite()) {
            return None;
        }
        let inner = points.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
        let outer = points.iter().map(|p| p.0).fold(0.0, f64::max);
        if points.is_empty() || outer - inner <= 1e-9 * outer {
            return None;
        }
        let gap = largest_gap(points);
        if gap > PI / 2.0 {
            return None;
        }
        let chosen = choose(points.len());
        let most = chosen.len() / POINTS_A_COEFFICIENT;
        let degree =
            MOST_DEGREE.min(rings(points, inner, outer) - 1).min(if most < 200 { 4 } else { MOST_DEGREE });
        let by_points = (most / (degree + 1)).saturating_sub(1) / 2;
        let diameters = MOST_DIAMETERS.min((0.9 * PI / gap) as usize).min(by_points);
        if diameters == 0 {
            return None;
        }
        let columns = (2 * diameters + 1) * (degree + 1);
        let mut basis = Mat::zeros(chosen.len(), columns);
        for (row, k) in chosen.iter().enumerate() {
            let (r, angle) = points[*k];
            let radial = chebyshev(2.0 * (r - inner) / (outer - inner) - 1.0);
            for c in 0..=2 * diameters {
                let angular = angular_term(c, angle);
                for j in 0..=degree {
                    basis[(row, c * (degree + 1) + j)] = angular * radial[j];
                }
            }
        }
        let mut normal = product(basis.transpose(), basis.as_ref());
        for c in 0..columns {
            let (n, j) = ((c / (degree + 1)).div_ceil(2) as f64, (c % (degree + 1)) as f64);
            normal[(c, c)] += SMOOTHING * chosen.len() as f64 * (1.0 + n * n / 9.0 + j * j / 4.0);
        }
        let factor = cholesky(normal.as_ref()).ok()?;
        Some(DiscPoints { n_points: points.len(), chosen, diameters, degree, basis, factor, inner, outer })
    }

    /// The name of the mode with transverse displacement `w` at the points, in their order; `None` when no n
    /// dominates or `w` is zero.
    ///
    /// # Panics
    /// When `w` has another length than the points.
    pub fn name(&self, w: &[f64]) -> Option<DiscModeName> {
        assert_eq!(w.len(), self.n_points, "one displacement for each point");
        let field = Mat::from_fn(self.chosen.len(), 1, |i, _| w[self.chosen[i]]);
        let size: f64 = field.norm_l2();
        if size == 0.0 || !size.is_finite() {
            return None;
        }
        let mut fit = product(self.basis.transpose(), field.as_ref());
        solve_lower_triangular_in_place(self.factor.as_ref(), fit.as_mut(), Par::Seq);
        solve_upper_triangular_in_place(self.factor.transpose(), fit.as_mut(), Par::Seq);
        let missed = (product(self.basis.as_ref(), fit.as_ref()) - &field).norm_l2() / size;
        // Cosine and sine amplitudes along the radius, and their energy ∫(a² + b²) r dr, for every n.
        let along: Vec<[Vec<f64>; 2]> = (0..=self.diameters)
            .map(|n| {
                [0, 1].map(|part| {
                    if part == 1 && n == 0 {
                        vec![0.0; RADII]
                    } else {
                        self.radial(&fit, 2 * n - usize::from(part == 0 && n > 0))
                    }
                })
            })
            .collect();
        let energy = |n: usize| -> f64 {
            let factor = if n == 0 { 2.0 } else { 1.0 };
            (0..RADII)
                .map(|i| factor * self.radius(i) * (along[n][0][i].powi(2) + along[n][1][i].powi(2)))
                .sum()
        };
        let energies: Vec<f64> = (0..=self.diameters).map(energy).collect();
        let (n, largest) = energies.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        if largest * (1.0 - missed * missed) < DOMINANT * energies.iter().sum::<f64>() {
            return None;
        }
        Some(DiscModeName { nodal_diameters: n, nodal_circles: sign_changes(&self.principal(&along[n])) })
    }

    /// r of the i-th of the radii evaluated.
    fn radius(&self, i: usize) -> f64 {
        self.inner + (self.outer - self.inner) * i as f64 / (RADII - 1) as f64
    }

    /// The amplitude of one angular term along the radius.
    fn radial(&self, fit: &Mat<f64>, term: usize) -> Vec<f64> {
        (0..RADII)
            .map(|i| {
                let t = chebyshev(2.0 * i as f64 / (RADII - 1) as f64 - 1.0);
                (0..=self.degree).map(|j| fit[(term * (self.degree + 1) + j, 0)] * t[j]).sum()
            })
            .collect()
    }

    /// a cos ψ + b sin ψ with the ψ that holds most energy: the nodal diameters of a single mode stand still along r.
    fn principal(&self, [a, b]: &[Vec<f64>; 2]) -> Vec<f64> {
        let sum = |x: &[f64], y: &[f64]| -> f64 { (0..RADII).map(|i| self.radius(i) * x[i] * y[i]).sum() };
        let psi = 0.5 * (2.0 * sum(a, b)).atan2(sum(a, a) - sum(b, b));
        a.iter().zip(b).map(|(a, b)| a * psi.cos() + b * psi.sin()).collect()
    }
}

/// 1, cos θ, sin θ, cos 2θ, sin 2θ …
fn angular_term(c: usize, angle: f64) -> f64 {
    let n = c.div_ceil(2) as f64;
    if c == 0 {
        1.0
    } else if c % 2 == 1 {
        (n * angle).cos()
    } else {
        (n * angle).sin()
    }
}

/// T_0 … T_8 at ρ.
fn chebyshev(rho: f64) -> [f64; MOST_DEGREE + 1] {
    let mut t = [1.0; MOST_DEGREE + 1];
    t[1] = rho;
    for j in 2..=MOST_DEGREE {
        t[j] = 2.0 * rho * t[j - 1] - t[j - 2];
    }
    t
}

/// The largest angle without a point: it limits the n that can be distinguished (n < π / gap).
fn largest_gap(points: &[(f64, f64)]) -> f64 {
    let mut angles: Vec<f64> = points.iter().map(|p| p.1.rem_euclid(TAU)).collect();
    angles.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return TAU };
    let around = first + TAU - last;
    angles.windows(2).map(|w| w[1] - w[0]).fold(around, f64::max)
}

/// The number of different radii, at least: of fifty bands of equal width, those with a point in them.
fn rings(points: &[(f64, f64)], inner: f64, outer: f64) -> usize {
    let mut occupied = [false; 50];
    for (r, _) in points {
        occupied[((r - inner) / (outer - inner) * 49.0).round().clamp(0.0, 49.0) as usize] = true;
    }
    occupied.iter().filter(|o| **o).count()
}

/// Which points are used: all, or a selection without a pattern (multiples of the golden ratio).
fn choose(n: usize) -> Vec<usize> {
    if n <= MOST_POINTS {
        return (0..n).collect();
    }
    let golden = 0.618_033_988_749_895;
    let mut chosen: Vec<usize> =
        (0..MOST_POINTS).map(|k| ((k as f64 * golden).fract() * n as f64) as usize).collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// Sign changes between lobes that are not small.
fn sign_changes(amplitude: &[f64]) -> usize {
    let threshold = SMALLEST_LOBE * amplitude.iter().fold(0.0f64, |m, a| m.max(a.abs()));
    let signs: Vec<bool> = amplitude.iter().filter(|a| a.abs() > threshold).map(|a| *a > 0.0).collect();
    signs.windows(2).filter(|w| w[0] != w[1]).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::random::Random;

    /// Points scattered over an annulus 0.015 … 0.075 m, finer towards the lowest rim point (θ = −π/2), where the
    /// disc touches.
    fn scattered(n: usize) -> Vec<(f64, f64)> {
        let mut random = Random::seeded(11);
        let mut unit = || 0.5 + 0.5 * random.next();
        (0..n)
            .map(|k| {
                let r = (0.015f64.powi(2) + unit() * (0.075f64.powi(2) - 0.015f64.powi(2))).sqrt();
                let fine = k % 3 == 0;
                let spread = if fine { 0.2 * (unit() - 0.5) } else { unit() - 0.5 };
                let r = if fine { 0.075 - 0.2 * (0.075 - r) } else { r };
                (r, -PI / 2.0 + TAU * spread)
            })
            .collect()
    }

    /// Clamped at the hub, with s sign changes between hub and rim.
    fn radial(r: f64, s: usize) -> f64 {
        let x = (r - 0.015) / 0.06;
        x * x * (1..=s).map(|k| 1.0 - x / (0.35 + 0.55 * k as f64 / (s as f64 + 0.5))).product::<f64>()
    }

    #[test]
    fn analytic_shapes_are_named() {
        // 900 scattered points may leave a lobe of five or eight diameters without one: of 40 scatters 17 do.
        for (count, most) in [(900, 3), (3000, 8), (20_000, 8)] {
            let points = scattered(count);
            let disc = DiscPoints::new(&points).unwrap();
            let mut random = Random::seeded(5);
            for n in [0, 1, 2, 3, 5, 8].into_iter().filter(|n| *n <= most) {
                for s in 0..=2 {
                    // Each of a double pair, turned by any angle, with 3 % noise.
                    for turn in [0.0, 0.3, PI / (2.0 * (n as f64).max(1.0))] {
                        if n == 0 && turn > 1.0 {
                            continue;
                        }
                        let w: Vec<f64> = points
                            .iter()
                            .map(|(r, a)| {
                                radial(*r, s) * (n as f64 * (a - turn)).cos() + 0.003 * random.next()
                            })
                            .collect();
                        let expected = DiscModeName { nodal_diameters: n, nodal_circles: s };
                        assert_eq!(disc.name(&w), Some(expected), "{count} points, turned by {turn}");
                    }
                }
            }
        }
    }

    #[test]
    fn rings_of_few_points_do_not_alias() {
        let points: Vec<(f64, f64)> = (0..10)
            .flat_map(|i| (0..32).map(move |j| (0.02 + 0.005 * i as f64, TAU * j as f64 / 32.0)))
            .collect();
        let disc = DiscPoints::new(&points).unwrap();
        for n in [0, 1, 4, 7] {
            let w: Vec<f64> = points.iter().map(|(r, a)| r * r * (n as f64 * a).cos()).collect();
            assert_eq!(disc.name(&w), Some(DiscModeName { nodal_diameters: n, nodal_circles: 0 }));
        }
    }

    #[test]
    fn mixed_modes_and_nothing_have_no_name() {
        let points = scattered(3000);
        let disc = DiscPoints::new(&points).unwrap();
        let mixed: Vec<f64> =
            points.iter().map(|(r, a)| radial(*r, 0) * ((2.0 * a).cos() + (3.0 * a).sin())).collect();
        assert_eq!(disc.name(&mixed), None);
        assert_eq!(disc.name(&vec![0.0; 3000]), None);
        let mut random = Random::seeded(3);
        let noise: Vec<f64> = points.iter().map(|_| random.next()).collect();
        assert_eq!(disc.name(&noise), None);
    }

    #[test]
    fn too_few_points_or_half_a_disc_cannot_be_named() {
        assert!(DiscPoints::new(&[]).is_none());
        assert!(DiscPoints::new(&[(1.0, 0.0), (1.0, 2.0)]).is_none());
        let half: Vec<(f64, f64)> = scattered(2000).into_iter().map(|(r, a)| (r, 0.5 * a)).collect();
        assert!(DiscPoints::new(&half).is_none());
        assert!(DiscPoints::new(&[(f64::NAN, 0.0)]).is_none());
    }
}
