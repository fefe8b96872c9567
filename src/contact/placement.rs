//! A body set on its counter-body, turned by the lead angle (theory of the rig: x slides, z is up).

/// How a body stands on a counter-body.
#[derive(Debug, Clone, Copy)]
pub struct BodyPlacement<'a> {
    /// Whether a node moves with the body, one a node.
    pub moves: &'a [bool],
    /// Nodes of the body of which the lowest touches.
    pub touching: &'a [usize],
    /// Nodes of the counter-body, on its mid-plane.
    pub counter: &'a [usize],
    /// Thickness h of the counter-body \[m\].
    pub thickness: f64,
    /// Lead angle θ about y \[rad\].
    pub lead_angle: f64,
    /// Where the lowest node stands, from the middle of the counter-body along x and y \[m\].
    pub position: [f64; 2],
}

/// A position that is off the counter-body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OffCounter {
    /// Along x (0) or y (1).
    pub axis: usize,
    /// The counter-body reaches so far from its middle \[m\].
    pub reach: f64,
}

/// Turns the body by the lead angle and moves it until its lowest touching node stands at `position` on the upper face
/// of the counter-body, h/2 above the mid-plane.
///
/// x′ = x cos θ + z sin θ, z′ = −x sin θ + z cos θ: the lowest point moves towards −x when θ > 0. Since the body is
/// then moved as a whole, the point it is turned about does not matter. Of nodes that are equally low the one nearest to
/// y = 0 touches.
///
/// # Errors
/// A position off the counter-body, the nodes then turned and not moved.
pub fn place(nodes: &mut [[f64; 3]], placement: &BodyPlacement<'_>) -> Result<(), OffCounter> {
    let BodyPlacement { moves, touching, counter, thickness, lead_angle, position } = *placement;
    let (sin, cos) = lead_angle.sin_cos();
    for (node, _) in nodes.iter_mut().zip(moves).filter(|(_, moves)| **moves) {
        let [x, y, z] = *node;
        *node = [x * cos + z * sin, y, -x * sin + z * cos];
    }
    let key = |n: usize| (nodes[n][2], nodes[n][1].abs());
    let lower = |a: &&usize, b: &&usize| key(**a).partial_cmp(&key(**b)).unwrap_or(std::cmp::Ordering::Equal);
    let Some(lowest) = touching.iter().min_by(lower).map(|n| nodes[*n]) else { return Ok(()) };
    let bound = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
        counter.iter().map(|n| nodes[*n][axis]).fold(start, pick)
    };
    let low = [0, 1, 2].map(|axis| bound(axis, f64::min, f64::INFINITY));
    let high = [0, 1, 2].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY));
    let target = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]) + position[axis]);
    for axis in 0..2 {
        if target[axis] < low[axis] || target[axis] > high[axis] {
            return Err(OffCounter { axis, reach: 0.5 * (high[axis] - low[axis]) });
        }
    }
    let top = high[2] + 0.5 * thickness;
    let shift = [target[0] - lowest[0], target[1] - lowest[1], top - lowest[2]];
    for (node, _) in nodes.iter_mut().zip(moves).filter(|(_, moves)| **moves) {
        (0..3).for_each(|axis| node[axis] += shift[axis]);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    /// A square in the plane y = 0 on one corner, and a plate of 2 × 2 m at z = −3.
    fn bodies() -> Vec<[f64; 3]> {
        let mut nodes = vec![[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]];
        nodes.extend([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [x, y, -3.0]));
        nodes
    }

    #[test]
    fn the_body_turns_by_the_lead_angle_and_its_lowest_node_stands_on_the_upper_face() {
        let moves: Vec<bool> = (0..8).map(|k| k < 4).collect();
        let own = BodyPlacement {
            moves: &moves,
            touching: &[0, 1, 2, 3],
            counter: &[4, 5, 6, 7],
            thickness: 0.2,
            lead_angle: 0.1,
            position: [0.3, -0.4],
        };
        let mut nodes = bodies();
        place(&mut nodes, &own).unwrap();
        // Ten times the rounding of coordinates up to 3.
        let near = |a: [f64; 3], b: [f64; 3]| {
            (0..3).all(|k| within((a[k] - b[k]).abs(), 30.0 * f64::EPSILON, RoundOff))
        };
        assert!(near(nodes[0], [0.3, -0.4, -2.9]));
        // From the lowest corner to the upper one: (0, 2) turned by θ about y.
        assert!(near(nodes[2], [0.3 + 2.0 * 0.1f64.sin(), -0.4, -2.9 + 2.0 * 0.1f64.cos()]));
        assert_eq!(nodes[4..], bodies()[4..]);
        let off = BodyPlacement { position: [0.0, 1.5], ..own };
        assert_eq!(place(&mut bodies(), &off), Err(OffCounter { axis: 1, reach: 1.0 }));
    }
}
