//! Quadrature on the reference cell of every kind.
//!
//! Lines, quadrilaterals and hexahedra take Gauss's points; triangles and tetrahedra symmetric points of positive weight (D. A.
//! Dunavant, Int. J. Numer. Meth. Eng. 21 (1985) 1129; N. J. Walkington, Quadrature on simplices of arbitrary dimension, 2000); wedges the products
//! of those of a triangle and a line; pyramids the points of a box shrunk to the apex, x = (1−z) ξ, y = (1−z) η, with those of Jacobi for
//! the weight (1−z)² along z.

use super::{CellKind, CellShape};
use nalgebra::{DMatrix, SymmetricEigen};

/// A point of a quadrature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadraturePoint {
    /// (ξ, η, ζ).
    pub at: [f64; 3],
    /// Its weight; the weights add up to the measure of the reference cell.
    pub weight: f64,
}

/// Points and weights for ∫ f(t) (1 − t)^α dt over \[−1, 1\], exact to the degree 2n − 1, from the eigenvalues of the matrix of the recurrence (G. H. Golub
/// & J. H. Welsch, Math. Comp. 23 (1969) 221).
fn jacobi(n: usize, alpha: u32) -> Vec<(f64, f64)> {
    let a = f64::from(alpha);
    let diagonal = |k: f64| {
        if alpha == 0 { 0.0 } else { -a * a / ((2.0 * k + a) * (2.0 * k + a + 2.0)) }
    };
    let beside = |k: f64| {
        let (s, m) = (2.0 * k + a, k + a);
        (4.0 * k * k * m * m / (s * s * (s * s - 1.0))).sqrt()
    };
    let matrix = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
        0 => diagonal(i as f64),
        1 => beside(i.max(j) as f64),
        _ => 0.0,
    });
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(matrix);
    // ∫ (1 − t)^α dt.
    let whole = 2_f64.powi(alpha as i32 + 1) / (a + 1.0);
    let mut points: Vec<(f64, f64)> =
        (0..n).map(|k| (eigenvalues[k], whole * eigenvectors[(0, k)].powi(2))).collect();
    points.sort_by(|p, q| p.0.total_cmp(&q.0));
    points
}

/// Points of the triangle, exact to the degree; the weights add up to ½.
fn triangle(degree: usize) -> Vec<([f64; 2], f64)> {
    // (a, a, 1 − 2a) and its turns, with the weight of each as part of the area.
    let turned = |a: f64, weight: f64| {
        let b = 1.0 - 2.0 * a;
        [[a, a], [b, a], [a, b]].map(|at| (at, 0.5 * weight))
    };
    match degree {
        0 | 1 => vec![([1.0 / 3.0; 2], 0.5)],
        2 => turned(1.0 / 6.0, 1.0 / 3.0).to_vec(),
        3 | 4 => [turned(0.445948490915965, 0.223381589678011), turned(0.091576213509771, 0.109951743655322)]
            .concat(),
        _ => {
            let root = 15_f64.sqrt();
            let mut points = vec![([1.0 / 3.0; 2], 0.5 * 9.0 / 40.0)];
            points.extend(turned((6.0 - root) / 21.0, (155.0 - root) / 1200.0));
            points.extend(turned((6.0 + root) / 21.0, (155.0 + root) / 1200.0));
            points
        }
    }
}

/// Points of the tetrahedron, exact to the degree; the weights add up to 1/6.
fn tetrahedron(degree: usize) -> Vec<([f64; 3], f64)> {
    let corner = |a: f64, weight: f64| {
        let b = 1.0 - 3.0 * a;
        [[a, a, a], [b, a, a], [a, b, a], [a, a, b]].map(|at| (at, weight / 6.0)).to_vec()
    };
    match degree {
        0 | 1 => vec![([0.25; 3], 1.0 / 6.0)],
        2 => corner((5.0 - 5_f64.sqrt()) / 20.0, 0.25),
        _ => {
            let mut points = corner(0.310_885_919_263_300_6, 0.112_687_925_718_015_85);
            points.extend(corner(0.092_735_250_310_891_23, 0.073_493_043_116_361_95));
            let (a, b) = (0.045_503_704_125_649_65, 0.454_496_295_874_350_35);
            let edges = [[a, a, b], [a, b, a], [b, a, a], [a, b, b], [b, a, b], [b, b, a]];
            points.extend(edges.map(|at| (at, 0.042_546_020_777_081_47 / 6.0)));
            points
        }
    }
}

impl CellKind {
    /// The points of a quadrature on the reference cell, exact for polynomials of `degree` (five at most) in each coordinate of boxes, and in all together
    /// of triangles and tetrahedra.
    pub fn quadrature(self, degree: usize) -> Vec<QuadraturePoint> {
        use CellShape::*;
        let gauss = jacobi((degree + 2) / 2, 0);
        let point = |at: [f64; 3], weight: f64| QuadraturePoint { at, weight };
        let line = gauss.iter().copied();
        let square = || gauss.iter().flat_map(|(x, a)| gauss.iter().map(move |(y, b)| ([*x, *y], a * b)));
        match self.table().shape {
            Point => vec![point([0.0; 3], 1.0)],
            Line => line.map(|(x, w)| point([x, 0.0, 0.0], w)).collect(),
            Triangle => triangle(degree).into_iter().map(|([x, y], w)| point([x, y, 0.0], w)).collect(),
            Quadrilateral => square().map(|([x, y], w)| point([x, y, 0.0], w)).collect(),
            Tetrahedron => tetrahedron(degree).into_iter().map(|(at, w)| point(at, w)).collect(),
            Hexahedron => {
                let along = |(z, c): (f64, f64)| square().map(move |([x, y], w)| point([x, y, z], w * c));
                line.flat_map(along).collect()
            }
            Wedge => {
                let faces = triangle(degree);
                let along = |(z, c): (f64, f64)| {
                    faces.iter().map(move |([x, y], w)| point([*x, *y, z], w * c)).collect::<Vec<_>>()
                };
                line.flat_map(along).collect()
            }
            Pyramid => {
                let along = |(t, c): (f64, f64)| {
                    // z = (1 + t)/2; (1 − z)² dz = (1 − t)² dt/8.
                    let height = 0.5 * (1.0 - t);
                    square()
                        .map(move |([x, y], w)| point([height * x, height * y, 1.0 - height], w * c / 8.0))
                };
                jacobi((degree + 2) / 2, 2).into_iter().flat_map(along).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    fn factorial(n: i32) -> f64 {
        (1..=n).map(f64::from).product()
    }

    /// ∫ x^a y^b z^c over the reference cell.
    fn exact(kind: CellKind, [a, b, c]: [i32; 3]) -> f64 {
        let line = |e: i32| if e % 2 == 0 { 2.0 / f64::from(e + 1) } else { 0.0 };
        let triangle = factorial(a) * factorial(b) / factorial(a + b + 2);
        match kind.table().shape {
            CellShape::Point => 1.0,
            CellShape::Line => line(a),
            CellShape::Triangle => triangle,
            CellShape::Quadrilateral => line(a) * line(b),
            CellShape::Tetrahedron => factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 3),
            CellShape::Hexahedron => line(a) * line(b) * line(c),
            CellShape::Wedge => triangle * line(c),
            // ∫ (1−z)^(a+b+2) z^c dz times the square's.
            CellShape::Pyramid => {
                line(a) * line(b) * factorial(a + b + 2) * factorial(c) / factorial(a + b + c + 3)
            }
        }
    }

    #[test]
    fn polynomials_are_integrated_exactly() {
        for kind in CellKind::all() {
            let d = kind.dimension();
            for degree in 1..=5_i32 {
                let points = kind.quadrature(degree as usize);
                let most = |k: usize| if d > k { degree } else { 0 };
                for a in 0..=most(0) {
                    for b in 0..=most(1) - a * i32::from(d > 1) {
                        for c in 0..=most(2) - (a + b) * i32::from(d > 2) {
                            let powers = [a, b, c];
                            let value = |p: &QuadraturePoint| {
                                p.weight * (0..3).map(|k| p.at[k].powi(powers[k])).product::<f64>()
                            };
                            let found: f64 = points.iter().map(value).sum();
                            let right = exact(kind, powers);
                            // Fifteen digits of the tabulated points.
                            assert!(
                                within((found - right).abs(), 1e-14, Reference),
                                "{kind:?} {degree} {powers:?}: {found} {right}"
                            );
                        }
                    }
                }
                assert!(points.iter().all(|p| p.weight > 0.0), "{kind:?} {degree}");
            }
        }
    }
}
