//! Shape of elements: edges, areas, angles, warp.

use super::{Cell, Mesh};

/// a − b.
pub fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a · b.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// |a|.
pub fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Shape of one face.
///
/// For a quadrilateral the area vector is half the cross product of its diagonals; the corner areas are those of
/// the triangles at each corner projected on it, so that one of them is ≤ 0 where it is not convex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceShape {
    /// Area \[m²\].
    pub area: f64,
    /// Unit normal by the right-hand rule; zero when the area is.
    pub normal: [f64; 3],
    /// Smallest and largest corner angle \[rad\].
    pub angles: [f64; 2],
    /// Shortest and longest edge \[m\].
    pub edges: [f64; 2],
    /// Smallest signed corner area over the face's area; ≤ 0 where a quadrilateral is folded or not convex.
    pub convexity: f64,
    /// Distance of the corners from the mean plane over the mean edge; 0 for a triangle.
    pub warp: f64,
}

/// The shape of a face; `None` for points and lines.
///
/// ```
/// use stridor_mesh::{Cell, Mesh, quality};
/// let nodes = vec![[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// let mesh = Mesh { nodes, elements: vec![Cell::triangle([0, 1, 2])], ..Default::default() };
/// let shape = quality::face_shape(&mesh, &mesh.elements[0]).unwrap();
/// assert_eq!((shape.area, shape.normal, shape.edges), (6.0, [0.0, 0.0, 1.0], [3.0, 5.0]));
/// assert!((shape.angles[0] - (3.0f64 / 4.0).atan()).abs() < 1e-15);
/// ```
pub fn face_shape(mesh: &Mesh, element: &Cell) -> Option<FaceShape> {
    if element.dimension() != 2 {
        return None;
    }
    let corners: Vec<[f64; 3]> = element.corners().iter().map(|n| mesh.nodes[*n]).collect();
    let n = corners.len();
    let at = |i: usize| corners[i % n];
    let vector = match n {
        3 => cross(minus(at(1), at(0)), minus(at(2), at(0))),
        _ => cross(minus(at(2), at(0)), minus(at(3), at(1))),
    };
    let twice = norm(vector);
    let normal = if twice > 0.0 { vector.map(|v| v / twice) } else { [0.0; 3] };
    let mut shape = FaceShape {
        area: twice / 2.0,
        normal,
        angles: [f64::INFINITY, 0.0],
        edges: [f64::INFINITY, 0.0],
        convexity: f64::INFINITY,
        warp: 0.0,
    };
    let mut perimeter = 0.0;
    for i in 0..n {
        let (next, back) = (minus(at(i + 1), at(i)), minus(at(i + n - 1), at(i)));
        let turn = cross(next, back);
        let angle = norm(turn).atan2(dot(next, back));
        let edge = norm(next);
        perimeter += edge;
        shape.angles = [shape.angles[0].min(angle), shape.angles[1].max(angle)];
        shape.edges = [shape.edges[0].min(edge), shape.edges[1].max(edge)];
        shape.convexity = if twice > 0.0 { shape.convexity.min(dot(turn, normal) / twice) } else { 0.0 };
    }
    if n == 4 {
        shape.warp = dot(minus(at(1), at(0)), normal).abs() / 2.0 / (perimeter / 4.0);
    }
    Some(shape)
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    fn quad(nodes: [[f64; 3]; 4]) -> FaceShape {
        let mesh = Mesh { nodes: nodes.to_vec(), ..Default::default() };
        face_shape(&mesh, &Cell::quadrilateral([0, 1, 2, 3])).unwrap()
    }

    #[test]
    fn a_square_an_arrowhead_a_bow_tie_and_a_warped_one_are_told_apart() {
        let square = quad([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]);
        assert_eq!((square.area, square.warp, square.convexity), (4.0, 0.0, 0.5));
        let arrow = quad([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 2.0, 0.0]]);
        assert!(arrow.convexity < 0.0);
        let bow = quad([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [3.0, 1.5, 0.0]]);
        assert!(bow.convexity < 0.0);
        // Corners alternately 0.1 above and below a plane: warp 0.1 / 2.
        let warped = quad([[0.0, 0.0, 0.1], [2.0, 0.0, -0.1], [2.0, 2.0, 0.1], [0.0, 2.0, -0.1]]);
        assert!(
            within((warped.warp - 0.1 / (4.0f64 + 0.04).sqrt()).abs(), 1e-15, RoundOff),
            "{}",
            warped.warp
        );
    }
}
