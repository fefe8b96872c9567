//! How the counter-body of a pair moves past the body.

use super::projection::{Vector, cross, dot, scale, subtract, unit};
use crate::system::ContactPoint;

/// Least share of the velocity that is along the counter-face.
const ALONG: f64 = 0.1;

/// The motion of a counter-body relative to the body, as a direction at every point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sliding {
    /// Along one direction, of whatever length.
    Along([f64; 3]),
    /// Not at all; t₁ is along a direction, of whatever length, where the face lets it be.
    AtRest([f64; 3]),
    /// About an axis of a direction e, of whatever length, right-handed.
    About {
        /// e.
        axis: [f64; 3],
        /// A point x₀ of the axis \[m\].
        point: [f64; 3],
    },
}

impl Sliding {
    /// The direction of motion at x: as given, or e × (x − x₀) with the unit vector e, whose length is the distance from the axis \[m\].
    pub fn at(&self, x: [f64; 3]) -> [f64; 3] {
        match self {
            Sliding::Along(direction) | Sliding::AtRest(direction) => *direction,
            Sliding::About { axis, point } => cross(unit(*axis).unwrap_or_default(), subtract(x, *point)),
        }
    }

    /// t₁ at x, where the normal is n: the unit vector of the part of the direction across n; and how fast the counter-body slides there: 1 along
    /// one direction, the length of that part \[m\] about an axis. `None` where nearly all of the direction is along n.
    pub(super) fn tangent(&self, normal: Vector, x: Vector) -> Option<(Vector, f64)> {
        let whole = self.at(x);
        let along = subtract(whole, scale(dot(whole, normal), normal));
        let [part, length] = [along, whole].map(|v| dot(v, v).sqrt());
        match self {
            // On the axis nothing slides, and any direction will do.
            Sliding::About { .. } if length == 0.0 => Some((across(normal), 0.0)),
            // Nothing slides, and any direction will do.
            Sliding::AtRest(_) if part.is_nan() || part <= ALONG * length => Some((across(normal), 0.0)),
            _ if part.is_nan() || part <= ALONG * length => None,
            Sliding::Along(_) | Sliding::AtRest(_) => Some((scale(1.0 / part, along), 1.0)),
            Sliding::About { .. } => Some((scale(1.0 / part, along), part)),
        }
    }

    /// The mean distance of points from the axis by their weights \[m\], V/Ω; 1 along one direction.
    pub fn mean_distance(&self, points: &[ContactPoint]) -> f64 {
        match self {
            Sliding::Along(_) | Sliding::AtRest(_) => 1.0,
            Sliding::About { .. } => {
                let distance = |point: &ContactPoint| {
                    let way = self.at(point.position);
                    point.weight * dot(way, way).sqrt()
                };
                points.iter().map(distance).sum::<f64>() / points.iter().map(|p| p.weight).sum::<f64>()
            }
        }
    }
}

/// A unit vector across `n`, in the plane of `n` and the coordinate axis that is most nearly across it.
fn across(n: Vector) -> Vector {
    let k = (0..3).min_by(|a, b| n[*a].abs().total_cmp(&n[*b].abs())).unwrap_or(0);
    let mut e = [0.0; 3];
    e[k] = 1.0;
    unit(subtract(e, scale(n[k], n))).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn a_body_that_turns_slides_across_the_radius_and_faster_outside() {
        let turning = Sliding::About { axis: [0.0, 0.0, 2.0], point: [1.0, 0.0, 5.0] };
        let up = [0.0, 0.0, 1.0];
        assert_eq!(turning.tangent(up, [3.0, 0.0, 0.0]), Some(([0.0, 1.0, 0.0], 2.0)));
        assert_eq!(turning.tangent(up, [1.0, -0.5, 0.0]), Some(([1.0, 0.0, 0.0], 0.5)));
        // On the axis.
        let (t1, speed) = turning.tangent(up, [1.0, 0.0, 0.0]).unwrap();
        assert!(speed == 0.0 && dot(t1, t1) == 1.0 && dot(t1, up) == 0.0);
        // A face that is run against.
        assert_eq!(turning.tangent([0.0, 1.0, 0.0], [3.0, 0.0, 0.0]), None);
        // A wedge: the part across its normal.
        let (t1, speed) = turning.tangent([0.0, 0.6, 0.8], [3.0, 0.0, 0.0]).unwrap();
        assert!(within((speed - 1.6).abs(), 1e-15, RoundOff));
        assert!(within((t1[1] - 0.8).abs() + (t1[2] + 0.6).abs(), 1e-15, RoundOff));
        assert_eq!(Sliding::Along([3.0, 0.0, 4.0]).tangent(up, [9.0; 3]), Some(([1.0, 0.0, 0.0], 1.0)));
        // Faces that nothing slides on may look any way.
        let resting = Sliding::AtRest([0.0, 0.0, 2.0]);
        assert_eq!(resting.tangent([0.0, 1.0, 0.0], [9.0; 3]), Some(([0.0, 0.0, 1.0], 1.0)));
        let (t1, speed) = resting.tangent(up, [9.0; 3]).unwrap();
        assert!(speed == 0.0 && dot(t1, t1) == 1.0 && dot(t1, up) == 0.0);
        assert_eq!(Sliding::Along([0.0, 0.0, 2.0]).tangent(up, [9.0; 3]), None);
    }
}
