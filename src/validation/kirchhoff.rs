//! Natural frequencies of thin circular plates in closed form.
//!
//! Circular and annular plates: W(r) cos nθ with W = A J_n(kr) + B Y_n(kr) + C I_n(kr) + D K_n(kr), k⁴ = ρhω²/D,
//! D = E h³ / 12(1−ν²). (Leissa, "Vibration of Plates", NASA SP-160 (1969), chapter 2.) At an edge of radius r,
//!
//! * clamped: W = 0, W′ = 0;
//! * free: W″ + ν (W′/r − n²W/r²) = 0 and (∇²W)′ − (1−ν) n²/r² (W′ − W/r) = 0.
//!
//! J and Y have ∇²W = −k²W, I and K have ∇²W = +k²W. Natural frequencies are the zeros of the determinant of the
//! edge conditions in λ = ka; they are found by its changes of sign on a grid much finer than their spacing.

use puruspe::{In, Jn, Kn, Yn};
use std::f64::consts::TAU;

/// A thin isotropic plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinPlate {
    /// E \[Pa\].
    pub youngs_modulus: f64,
    /// ν.
    pub poissons_ratio: f64,
    /// ρ \[kg/m³\].
    pub density: f64,
    /// h \[m\].
    pub thickness: f64,
}

impl ThinPlate {
    /// √(D/ρh) \[m²/s\]: ω = k² √(D/ρh).
    pub fn wave_constant(&self) -> f64 {
        let nu = self.poissons_ratio;
        let rigidity = self.youngs_modulus * self.thickness.powi(3) / (12.0 * (1.0 - nu * nu));
        (rigidity / (self.density * self.thickness)).sqrt()
    }
}

/// The outer or inner edge of a circular plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// No deflection, no slope.
    Clamped,
    /// No deflection, no moment.
    SimplySupported,
    /// No moment, no shear.
    Free,
}

/// A mode of a circular plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateMode {
    /// f \[Hz\].
    pub frequency_hz: f64,
    /// n.
    pub nodal_diameters: usize,
    /// s: its place in the family of n, counted from 0, which is the number of nodal circles (edges not counted)
    /// except that of a free plate's n = 0 and n = 1, where rigid motions come first: there it is the place plus one.
    pub nodal_circles: usize,
    /// λ = ka.
    pub lambda: f64,
}

/// Every mode below `below_hz` of a plate of outer radius `a`, ascending in frequency; each with n > 0 counts twice.
///
/// `inner` is the radius and the condition of the inner edge, `None` for a full disc. Rigid motions are left out.
/// The Bessel functions stay finite up to about λ = 300.
///
/// ```
/// use stridor::validation::kirchhoff::{Edge, ThinPlate, circular_modes};
/// let steel = ThinPlate { youngs_modulus: 210e9, poissons_ratio: 0.3, density: 7850.0, thickness: 1e-3 };
/// let modes = circular_modes(&steel, 0.075, Edge::Free, Some((0.015, Edge::Clamped)), 300.0);
/// assert_eq!(modes.len(), 3);
/// assert_eq!(modes[0].nodal_diameters, 1);
/// assert!((modes[0].frequency_hz - 213.0).abs() < 1.0);
/// ```
pub fn circular_modes(
    plate: &ThinPlate,
    a: f64,
    outer: Edge,
    inner: Option<(f64, Edge)>,
    below_hz: f64,
) -> Vec<PlateMode> {
    let nu = plate.poissons_ratio;
    let limit = a * (TAU * below_hz / plate.wave_constant()).sqrt();
    let inner = inner.map(|(b, edge)| (b / a, edge));
    let rigid_first = outer == Edge::Free && inner.is_none_or(|(_, edge)| edge == Edge::Free);
    let mut modes = Vec::new();
    let mut empty = 0;
    for n in 0.. {
        let roots = sign_changes(|lambda| edge_determinant(n, lambda, nu, outer, inner), 0.05, limit);
        // Beyond n = 2 the lowest frequency of a family grows with n.
        empty = if roots.is_empty() && n > 2 { empty + 1 } else { 0 };
        let first = usize::from(rigid_first && n < 2);
        modes.extend(roots.into_iter().enumerate().map(|(s, lambda)| PlateMode {
            frequency_hz: (lambda / a).powi(2) * plate.wave_constant() / TAU,
            nodal_diameters: n,
            nodal_circles: s + first,
            lambda,
        }));
        if empty == 2 {
            break;
        }
    }
    modes.sort_by(|p, q| p.frequency_hz.total_cmp(&q.frequency_hz));
    modes
}

/// The determinant of the edge conditions with a = 1, k = λ, each column scaled to its largest entry.
fn edge_determinant(n: usize, lambda: f64, nu: f64, outer: Edge, inner: Option<(f64, Edge)>) -> f64 {
    let mut edges = vec![(1.0, outer)];
    edges.extend(inner);
    // J and I are regular at the centre; a hole admits Y and K.
    let solutions: &[fn(u32, f64) -> f64] = if inner.is_some() { &[Jn, In, Yn, Kn] } else { &[Jn, In] };
    let size = solutions.len();
    let mut matrix = nalgebra::DMatrix::zeros(size, size);
    for (column, bessel) in solutions.iter().enumerate() {
        for (edge, (r, condition)) in edges.iter().enumerate() {
            let rows = edge_conditions(*bessel, column, n, lambda, *r, nu, *condition);
            matrix[(2 * edge, column)] = rows[0];
            matrix[(2 * edge + 1, column)] = rows[1];
        }
        let largest = matrix.column(column).amax();
        matrix.column_mut(column).scale_mut(1.0 / largest);
    }
    matrix.determinant()
}

/// The two conditions on one solution at radius `r`: `kind` 0 is J, 1 is I, 2 is Y, 3 is K.
fn edge_conditions(
    bessel: fn(u32, f64) -> f64,
    kind: usize,
    n: usize,
    k: f64,
    r: f64,
    nu: f64,
    condition: Edge,
) -> [f64; 2] {
    let x = k * r;
    let (order, nn) = (n as f64, (n * n) as f64);
    let w = bessel(n as u32, x);
    // Z_n′ = ± Z_{n+1} + (n/x) Z_n: + for I, − for J, Y, K.
    let sign = if kind == 1 { 1.0 } else { -1.0 };
    let slope = k * (sign * bessel(n as u32 + 1, x) + order / x * w);
    let laplace = if kind == 1 || kind == 3 { k * k } else { -k * k };
    let curvature = laplace * w - slope / r + nn / (r * r) * w;
    let moment = curvature + nu * (slope / r - nn * w / (r * r));
    match condition {
        Edge::Clamped => [w, slope],
        Edge::SimplySupported => [w, moment],
        Edge::Free => [moment, laplace * slope - (1.0 - nu) * nn / (r * r) * (slope - w / r)],
    }
}

/// The zeros of `f` in (`from`, `to`) at which it changes sign: a grid of 0.05, then bisection to round-off.
pub fn sign_changes(f: impl Fn(f64) -> f64, from: f64, to: f64) -> Vec<f64> {
    let mut zeros = Vec::new();
    let steps = ((to - from) / 0.05).ceil().max(0.0) as usize;
    let at = |k: usize| (from + 0.05 * k as f64).min(to);
    let mut left = f(from);
    for k in 0..steps {
        let right = f(at(k + 1));
        if left * right < 0.0 {
            zeros.push(bisect(&f, at(k), at(k + 1)));
        }
        left = right;
    }
    zeros
}

fn bisect(f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let positive = f(low) > 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == positive {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    fn unit(nu: f64) -> ThinPlate {
        ThinPlate { youngs_modulus: 12.0 * (1.0 - nu * nu), poissons_ratio: nu, density: 1.0, thickness: 1.0 }
    }

    /// λ² of the first mode of the family n.
    fn first(nu: f64, outer: Edge, inner: Option<(f64, Edge)>, n: usize) -> f64 {
        circular_modes(&unit(nu), 1.0, outer, inner, 100.0 / TAU)
            .into_iter()
            .find(|mode| mode.nodal_diameters == n)
            .unwrap()
            .lambda
            .powi(2)
    }

    fn assert_table(found: impl Fn(usize) -> f64, table: &[f64]) {
        for (n, expected) in table.iter().enumerate() {
            let value = found(n);
            assert!(
                within((value - expected).abs(), 6e-5, Reference),
                "n = {n}: {value} instead of {expected}"
            );
        }
    }

    #[test]
    fn published_tables_are_met() {
        let free = [9.0031, 20.4746, 5.3583, 12.4390, 21.8352, 33.4949];
        assert_table(|n| first(0.3, Edge::Free, None, n), &free);
        let free = [9.0689, 20.5131, 5.2620, 12.2439, 21.5272, 33.0618];
        assert_table(|n| first(0.33, Edge::Free, None, n), &free);
        assert_table(|n| first(0.3, Edge::Clamped, None, n), &[10.2158, 21.2604, 34.8770, 51.0300]);
        for (b, table) in [
            (0.1, [4.2374, 3.4781, 5.6227, 12.4505, 21.8356, 33.4949]),
            (0.3, [6.6604, 6.5523, 7.9565, 13.2757, 22.0738, 33.5574]),
            (0.5, [13.0243, 13.2898, 14.7038, 18.5620, 25.5958, 35.7301]),
        ] {
            assert_table(|n| first(0.3, Edge::Free, Some((b, Edge::Clamped)), n), &table);
        }
    }

    #[test]
    fn no_mode_is_missing_as_far_as_weyl_can_tell() {
        // Weyl: N(λ) = A k²/4π + O(k): for the clamped disc N ≈ λ²/4 − c λ with c ≈ 1 (two-fold modes counted twice).
        let modes = circular_modes(&unit(0.3), 1.0, Edge::Clamped, None, 40.0_f64.powi(2) / TAU);
        let count: usize = modes.iter().map(|m| if m.nodal_diameters == 0 { 1 } else { 2 }).sum();
        let fitted = (400.0 - count as f64) / 40.0;
        assert!((0.8..1.1).contains(&fitted), "{count} {fitted}");
        // The gaps between the roots of a family shrink towards π: one skipped or doubled would break the order.
        for n in 0..30 {
            let family: Vec<f64> =
                modes.iter().filter(|m| m.nodal_diameters == n).map(|m| m.lambda).collect();
            let gaps: Vec<f64> = family.windows(2).map(|w| w[1] - w[0]).collect();
            assert!(gaps.iter().all(|g| (3.0..6.0).contains(g)), "{n}: {family:?}");
            assert!(n == 0 || gaps.windows(2).all(|g| g[1] < g[0]), "{n}: {gaps:?}");
        }
    }
}
