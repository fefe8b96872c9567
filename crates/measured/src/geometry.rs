//! Where the frame of a test lies in the mesh, and which nodes its points are.

use nalgebra::{Matrix3, Vector3};

/// A frame: x_mesh = origin + R x_test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    origin: Vector3<f64>,
    rotation: Matrix3<f64>,
}

impl Frame {
    /// The frame whose x axis is along `x`, and whose xy plane holds `y`; neither is zero, nor are they parallel.
    pub fn new(origin: [f64; 3], x: [f64; 3], y: [f64; 3]) -> Frame {
        let (first, y) = (Vector3::from(x).normalize(), Vector3::from(y));
        let second = (y - first.dot(&y) * first).normalize();
        let rotation = Matrix3::from_columns(&[first, second, first.cross(&second)]);
        Frame { origin: origin.into(), rotation }
    }

    /// A direction of the test in the mesh.
    pub fn direction(&self, of: [f64; 3]) -> [f64; 3] {
        (self.rotation * Vector3::from(of)).into()
    }

    /// A point of the test in the mesh.
    pub fn point(&self, of: [f64; 3]) -> [f64; 3] {
        (self.origin + self.rotation * Vector3::from(of)).into()
    }
}

/// The scalar product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    Vector3::from(a).dot(&Vector3::from(b))
}

/// The distance of two points \[m\].
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    Vector3::from(a).metric_distance(&Vector3::from(b))
}

/// Of the nodes `among`, indices into `nodes`, the one nearest to each point, and how far it is \[m\]; the first of
/// several at one distance. Empty when there is no node.
pub fn nearest(points: &[[f64; 3]], nodes: &[[f64; 3]], among: &[usize]) -> Vec<(usize, f64)> {
    let near = |point: &[f64; 3]| {
        let away = among.iter().map(|node| (*node, distance(nodes[*node], *point)));
        away.min_by(|a, b| a.1.total_cmp(&b.1))
    };
    points.iter().filter_map(near).collect()
}

/// The largest and the mean of distances; zeros when there are none.
pub fn largest_and_mean(distances: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let count = distances.clone().count().max(1);
    [distances.clone().fold(0.0, f64::max), distances.sum::<f64>() / count as f64]
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn a_frame_keeps_lengths_and_takes_its_axes_where_they_belong() {
        let frame = Frame::new([1.0, 2.0, 3.0], [0.0, 2.0, 0.0], [-3.0, 5.0, 0.0]);
        let near = |a: [f64; 3], b: [f64; 3]| within(distance(a, b), 1e-15, RoundOff);
        assert!(near(frame.direction([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]));
        assert!(near(frame.direction([0.0, 1.0, 0.0]), [-1.0, 0.0, 0.0]));
        assert!(near(frame.point([0.0, 0.0, 1.0]), [1.0, 2.0, 4.0]));
        // Four roundings of coordinates up to four, times ten.
        let (a, b) = ([0.3, -0.2, 0.9], [1.0, 0.1, 0.4]);
        assert!(within((distance(frame.point(a), frame.point(b)) - distance(a, b)).abs(), 1e-14, RoundOff));
    }

    #[test]
    fn the_nearest_of_the_allowed_nodes_is_found() {
        let nodes = [[0.0; 3], [1.0, 0.0, 0.0], [0.9, 0.0, 0.0]];
        assert_eq!(nearest(&[[1.0, 0.0, 0.5]], &nodes, &[0, 2])[0].0, 2);
        assert!(nearest(&[[0.0; 3]], &nodes, &[]).is_empty());
        assert_eq!(largest_and_mean([1.0, 3.0].into_iter()), [3.0, 2.0]);
    }
}
