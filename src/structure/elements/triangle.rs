//! A triangle in space and in its own plane.

use nalgebra::{Matrix3, Vector3};

/// A flat triangle with its local frame.
///
/// ```text
///        3
///       / \        e2
///      /   \       |
///     1-----2      +-- e1 (along 1→2), e3 towards the reader
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FlatTriangle {
    /// Corners in the local axes (e₁, e₂), the first at the origin \[m\].
    pub corners: [[f64; 2]; 3],
    /// Rows e₁, e₂, e₃ in global axes.
    pub frame: Matrix3<f64>,
    /// A \[m²\].
    pub area: f64,
}

impl FlatTriangle {
    /// The triangle with corners `nodes` \[m\]; `None` when it has no area (less than 1e-10 of its longest side squared).
    pub fn new(nodes: &[[f64; 3]; 3]) -> Option<Self> {
        let [p1, p2, p3] = nodes.map(Vector3::from);
        let (a, b) = (p2 - p1, p3 - p1);
        let normal = a.cross(&b);
        let longest = a.norm_squared().max(b.norm_squared()).max((p3 - p2).norm_squared());
        let twice_area = normal.norm();
        // Written so that NaN is refused too.
        if !(twice_area > 2e-10 * longest && twice_area.is_finite()) {
            return None;
        }
        let (e1, e3) = (a / a.norm(), normal / twice_area);
        let e2 = e3.cross(&e1);
        let frame = Matrix3::from_rows(&[e1.transpose(), e2.transpose(), e3.transpose()]);
        let corners = [[0.0, 0.0], [a.norm(), 0.0], [b.dot(&e1), b.dot(&e2)]];
        Some(FlatTriangle { corners, frame, area: twice_area / 2.0 })
    }

    /// e₃ in global axes.
    pub fn normal(&self) -> [f64; 3] {
        [self.frame[(2, 0)], self.frame[(2, 1)], self.frame[(2, 2)]]
    }

    /// Barycentric coordinates of the projection of `point` onto the plane; `origin` is the first corner \[m\].
    pub fn barycentric(&self, origin: [f64; 3], point: [f64; 3]) -> [f64; 3] {
        let local = self.frame * (Vector3::from(point) - Vector3::from(origin));
        let [_, l2, l3] = gradients(&self.corners).map(|g| g[0] * local[0] + g[1] * local[1]);
        [1.0 - l2 - l3, l2, l3]
    }
}

/// Twice the signed area of a triangle in its plane \[m²\], positive when its corners turn anticlockwise.
pub(super) fn twice_area(c: &[[f64; 2]; 3]) -> f64 {
    (c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[2][0] - c[0][0]) * (c[1][1] - c[0][1])
}

/// ∂L_i/∂x and ∂L_i/∂y of the barycentric coordinates \[1/m\].
pub(super) fn gradients(c: &[[f64; 2]; 3]) -> [[f64; 2]; 3] {
    let d = twice_area(c);
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        [(c[j][1] - c[k][1]) / d, (c[k][0] - c[j][0]) / d]
    })
}

/// The three sides as pairs of corners.
pub(super) const SIDES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];
