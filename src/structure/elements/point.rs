//! Point masses, springs and dashpots.

use crate::structure::{PointMass, Spring};

/// The diagonal of M of a point mass on (ux, uy, uz, rx, ry, rz) \[kg, kg m²\].
pub fn mass_diagonal(point: &PointMass) -> [f64; 6] {
    let [ix, iy, iz] = point.inertia;
    [point.mass, point.mass, point.mass, ix, iy, iz]
}

/// The unit vector a on (ux, uy, uz, rx, ry, rz) of one end: the spring's matrix is k a aᵀ to the ground, and
/// k (a, −a)(a, −a)ᵀ between two nodes. `None` when the direction has no length.
pub fn spring_direction(spring: &Spring) -> Option<[f64; 6]> {
    let norm = spring.direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    if !(norm > 0.0 && norm.is_finite()) {
        return None;
    }
    let mut a = [0.0; 6];
    let offset = if spring.rotational { 3 } else { 0 };
    for (k, d) in spring.direction.iter().enumerate() {
        a[offset + k] = d / norm;
    }
    Some(a)
}
