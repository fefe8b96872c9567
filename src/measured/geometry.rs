//! Where the frame of a test lies in the mesh, and which nodes its points are.

use crate::linalg::c64;

/// A frame: x_mesh = origin + R x_test. The columns of R are `axes`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
}

impl Frame {
    /// The frame whose x axis is along `x`, and whose xy plane holds `y`; neither is zero, nor are they parallel.
    pub fn new(origin: [f64; 3], x: [f64; 3], y: [f64; 3]) -> Frame {
        let unit = |v: [f64; 3]| v.map(|c| c / dot(v, v).sqrt());
        let first = unit(x);
        let along = dot(first, y);
        let second = unit([0, 1, 2].map(|k| y[k] - along * first[k]));
        let [[a, b, c], [d, e, f]] = [first, second];
        let third = [b * f - c * e, c * d - a * f, a * e - b * d];
        Frame { origin, axes: [first, second, third] }
    }

    /// A direction of the test in the mesh.
    pub fn direction(&self, of: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| (0..3).map(|axis| self.axes[axis][k] * of[axis]).sum())
    }

    /// A point of the test in the mesh.
    pub fn point(&self, of: [f64; 3]) -> [f64; 3] {
        let turned = self.direction(of);
        [0, 1, 2].map(|k| self.origin[k] + turned[k])
    }
}

/// The scalar product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The distance of two points \[m\].
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let d = [0, 1, 2].map(|k| a[k] - b[k]);
    dot(d, d).sqrt()
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

/// A shape turned into real numbers as far as it can be: e^(iα)ψ with the greatest real part in the mean square, and the
/// share Σ(Im)²/Σ|ψ|² that stays imaginary, 0 for a shape whose points move in phase and ½ for a travelling wave.
///
/// α = −½ arg Σψ².
pub fn in_phase(shape: &[c64]) -> (Vec<f64>, f64) {
    let square: c64 = shape.iter().map(|v| v * v).sum();
    let turn = c64::from_polar(1.0, -0.5 * square.arg());
    let turned: Vec<c64> = shape.iter().map(|v| v * turn).collect();
    let whole: f64 = turned.iter().map(|v| v.norm_sqr()).sum();
    let rest: f64 = turned.iter().map(|v| v.im * v.im).sum();
    (turned.iter().map(|v| v.re).collect(), if whole > 0.0 { rest / whole } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_keeps_lengths_and_takes_its_axes_where_they_belong() {
        let frame = Frame::new([1.0, 2.0, 3.0], [0.0, 2.0, 0.0], [-3.0, 5.0, 0.0]);
        let near = |a: [f64; 3], b: [f64; 3]| distance(a, b) < 1e-15;
        assert!(near(frame.direction([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]));
        assert!(near(frame.direction([0.0, 1.0, 0.0]), [-1.0, 0.0, 0.0]));
        assert!(near(frame.point([0.0, 0.0, 1.0]), [1.0, 2.0, 4.0]));
        let (a, b) = ([0.3, -0.2, 0.9], [1.0, 0.1, 0.4]);
        assert!((distance(frame.point(a), frame.point(b)) - distance(a, b)).abs() < 1e-15);
    }

    #[test]
    fn the_nearest_of_the_allowed_nodes_is_found() {
        let nodes = [[0.0; 3], [1.0, 0.0, 0.0], [0.9, 0.0, 0.0]];
        assert_eq!(nearest(&[[1.0, 0.0, 0.5]], &nodes, &[0, 2])[0].0, 2);
        assert!(nearest(&[[0.0; 3]], &nodes, &[]).is_empty());
        assert_eq!(largest_and_mean([1.0, 3.0].into_iter()), [3.0, 2.0]);
    }

    #[test]
    fn a_standing_wave_is_real_and_a_travelling_one_is_not() {
        let turn = c64::from_polar(2.0, 0.7);
        let standing: Vec<c64> = [1.0, -0.5, 0.3].iter().map(|v| turn * *v).collect();
        let (real, rest) = in_phase(&standing);
        assert!(rest < 1e-30 && (real[1] / real[0] + 0.5).abs() < 1e-15);
        let travelling: Vec<c64> =
            (0..8).map(|k| c64::from_polar(1.0, f64::from(k) * std::f64::consts::FRAC_PI_4)).collect();
        assert!((in_phase(&travelling).1 - 0.5).abs() < 1e-9);
    }
}
