//! Curves that nodes are generated on, and how far apart they are.

use crate::abaqus::frames::unit;
use stridor_mesh::quality::{cross, dot, minus};

/// A curve between two points, by t from 0 to 1.
#[derive(Debug, Clone, Copy)]
pub(super) enum Curve {
    /// a (1 − t) + b t.
    Line([[f64; 3]; 2]),
    /// The parabola through a, m and b at t = 0, ½ and 1.
    Parabola([[f64; 3]; 3]),
    /// c + r (cos φ e₁ + sin φ e₂) + h n, with φ, r and h linear in t.
    Arc {
        centre: [f64; 3],
        /// e₁, e₂ and n.
        axes: [[f64; 3]; 3],
        /// φ at t = 1 \[rad\].
        angle: f64,
        /// r at both ends.
        radii: [f64; 2],
        /// h at both ends.
        heights: [f64; 2],
    },
}

impl Curve {
    /// The arc from a to b about a centre: the shorter one, or that which turns by the right-hand rule about a normal, all round where a is
    /// b. None where a, b and the centre are in one line and there is no normal, or where an end is on the axis.
    pub fn arc([a, b]: [[f64; 3]; 2], centre: [f64; 3], normal: Option<[f64; 3]>) -> Option<Curve> {
        let [u, v] = [a, b].map(|end| minus(end, centre));
        let n = unit(normal.unwrap_or_else(|| cross(u, v)))?;
        let heights = [dot(u, n), dot(v, n)];
        let [u, v] = [along(u, -heights[0], n), along(v, -heights[1], n)];
        let first = unit(u)?;
        let second = cross(n, first);
        let radii = [u, v].map(|x| dot(x, x).sqrt());
        // In a line with the centre up to round-off: no plane.
        if normal.is_none() && dot(v, second) <= ROUND_OFF * radii[1] {
            return None;
        }
        let mut angle = dot(v, second).atan2(dot(v, first));
        if angle < ROUND_OFF {
            angle += std::f64::consts::TAU;
        }
        unit(v)?;
        Some(Curve::Arc { centre, axes: [first, second, n], angle, radii, heights })
    }

    /// The point at t.
    pub fn at(&self, t: f64) -> [f64; 3] {
        match self {
            Curve::Line([a, b]) => std::array::from_fn(|k| (1.0 - t) * a[k] + t * b[k]),
            Curve::Parabola([a, m, b]) => {
                let [of_a, of_m, of_b] =
                    [(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)];
                std::array::from_fn(|k| of_a * a[k] + of_m * m[k] + of_b * b[k])
            }
            Curve::Arc { centre, axes: [first, second, n], angle, radii, heights } => {
                let (sin, cos) = (angle * t).sin_cos();
                let r = (1.0 - t) * radii[0] + t * radii[1];
                let h = (1.0 - t) * heights[0] + t * heights[1];
                let in_plane = along(along(*centre, r * cos, *first), r * sin, *second);
                along(in_plane, h, *n)
            }
        }
    }
}

/// Sines and angles that are round-off.
const ROUND_OFF: f64 = 1e-9;

/// tₖ, the part of a line of n intervals that the first k of them are, where Lᵢ/Lᵢ₊₁ = b: with s = −ln b,
/// tₖ = (eᵏˢ − 1)/(eⁿˢ − 1).
pub(super) fn part(k: usize, n: usize, bias: f64) -> f64 {
    let (k, n, s) = (k as f64, n as f64, -bias.ln());
    if s == 0.0 {
        k / n
    } else if s < 0.0 {
        (k * s).exp_m1() / (n * s).exp_m1()
    } else {
        // The same with both sides by e⁻ⁿˢ, which does not overflow.
        ((k - n) * s).exp() * (-k * s).exp_m1() / (-n * s).exp_m1()
    }
}

/// a + x b.
fn along(a: [f64; 3], x: f64, b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + x * b[k])
}
