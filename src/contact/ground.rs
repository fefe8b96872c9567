//! Points that touch rigid ground.

use super::Reduce;
use super::sliding::Sliding;
use crate::system::ContactPoint;
use nalgebra::Vector3;

/// Why nodes have no contact points with the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GroundFault {
    /// The direction into the ground has no length.
    NoDirection,
    /// The sliding direction is that into the ground.
    SlidesIntoTheGround,
}

/// Contact points of nodes at `coordinates` \[m\] against rigid ground, each with its weight: g along `into`, t₁ along the part of
/// the direction of sliding that is across it, t₂ = g × t₁. Gaps are zero.
///
/// # Errors
/// Directions of which these cannot be made.
pub fn ground_points(
    nodes: &[(usize, f64)],
    coordinates: &[[f64; 3]],
    (into, sliding): ([f64; 3], Sliding),
    reduce: &Reduce<'_>,
) -> Result<Vec<ContactPoint>, GroundFault> {
    let g = Vector3::from(into).try_normalize(0.0).ok_or(GroundFault::NoDirection)?;
    let direction = |node: usize, d: &Vector3<f64>| reduce(&[(node, 0, d.x), (node, 1, d.y), (node, 2, d.z)]);
    let point = |(node, weight): &(usize, f64)| {
        let position = coordinates[*node];
        let (t1, speed) = sliding.tangent(g.into(), position).ok_or(GroundFault::SlidesIntoTheGround)?;
        let t1 = Vector3::from(t1);
        let t2 = g.cross(&t1);
        Ok(ContactPoint {
            position,
            gap: 0.0,
            weight: *weight,
            speed,
            normal: direction(*node, &g),
            tangents: [direction(*node, &t1), direction(*node, &t2)],
        })
    };
    nodes.iter().map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::SparseVector;

    #[test]
    fn directions_are_orthonormal_and_right_handed_and_poor_ones_are_refused() {
        let reduce = |terms: &[(usize, usize, f64)]| {
            SparseVector::from_entries(terms.iter().map(|(node, axis, v)| (3 * node + axis, *v)))
        };
        let coordinates = [[0.0; 3], [1.0, 2.0, 3.0]];
        let of = |[into, along]: [[f64; 3]; 2]| {
            ground_points(&[(1, 1.0)], &coordinates, (into, Sliding::Along(along)), &reduce)
        };
        let points = of([[0.0, 0.0, -2.0], [3.0, 0.0, 4.0]]).unwrap();
        let expected = |values: &[(usize, f64)]| SparseVector::from_entries(values.iter().copied());
        assert_eq!(points[0].normal, expected(&[(5, -1.0)]));
        assert_eq!(points[0].tangents, [expected(&[(3, 1.0)]), expected(&[(4, -1.0)])]);
        assert_eq!((points[0].position, points[0].weight), (coordinates[1], 1.0));
        assert_eq!(of([[0.0; 3], [1.0, 0.0, 0.0]]).unwrap_err(), GroundFault::NoDirection);
        let along = [[0.0, 1.0, 0.0], [0.0, -2.0, 0.0]];
        assert_eq!(of(along).unwrap_err(), GroundFault::SlidesIntoTheGround);
    }
}
