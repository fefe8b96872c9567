//! Shape functions of every kind of cell, N_k(ξ) = 1 at node k and 0 at the others.
//!
//! They are the combinations of some products x^a y^b z^c r^d of the reference coordinates that have these values, found once a kind by
//! the inverse of the matrix of the products at the nodes:
//! * complete polynomials of degree p on lines, triangles and tetrahedra;
//! * products of polynomials of degree p on quadrilaterals and hexahedra; with nodes on edges alone (8 and 20 nodes) those in which
//!   one exponent is two at most (Arnold & Awanou, Found. Comput. Math. 11 (2011) 337);
//! * triangle × line on wedges; with 15 nodes z² comes with linear functions of x and y;
//! * on pyramids r = xy/(1 − z) besides, which is a polynomial on every face (Bedrosian, Int. J. Numer. Meth. Eng. 35 (1992) 95).

use super::CellKind;
use super::kind::products::Product;
use nalgebra::DMatrix;
use std::sync::OnceLock;

/// A product and its derivatives by x, y and z.
fn value_and_gradient(p: Product, [x, y, z]: [f64; 3]) -> (f64, [f64; 3]) {
    let power = |base: f64, e: u8| base.powi(i32::from(e));
    let slope = |base: f64, e: u8| if e == 0 { 0.0 } else { f64::from(e) * base.powi(i32::from(e) - 1) };
    let (a, b, c) = (power(x, p[0]), power(y, p[1]), power(z, p[2]));
    let plain = [slope(x, p[0]) * b * c, a * slope(y, p[1]) * c, a * b * slope(z, p[2])];
    if p[3] == 0 {
        return (a * b * c, plain);
    }
    // At the apex r = 0, as |x|, |y| ≤ 1 − z.
    let height = (1.0 - z).max(f64::MIN_POSITIVE);
    let (u, v) = (x / height, y / height);
    let (r, of_r) = (u * y, [v, u, u * v]);
    (a * b * c * r, std::array::from_fn(|k| plain[k] * r + a * b * c * of_r[k]))
}

/// The shape functions of one kind: products, and their combinations, a column a node.
struct Basis {
    products: Vec<Product>,
    combinations: DMatrix<f64>,
}

impl Basis {
    fn of(kind: CellKind) -> &'static Basis {
        static ALL: OnceLock<Vec<Basis>> = OnceLock::new();
        let all = ALL.get_or_init(|| CellKind::all().map(Basis::new).collect());
        &all[kind as usize]
    }

    fn new(kind: CellKind) -> Basis {
        let (products, nodes) = (kind.table().products.list(kind.dimension()), kind.reference_coordinates());
        let at_nodes =
            DMatrix::from_fn(nodes.len(), products.len(), |i, j| value_and_gradient(products[j], nodes[i]).0);
        let combinations = at_nodes.try_inverse().expect("the products are independent at the nodes");
        Basis { products, combinations }
    }
}

impl CellKind {
    /// N_k(ξ) of every node at the reference coordinates `at`.
    pub fn shape_functions(self, at: [f64; 3]) -> Vec<f64> {
        let Basis { products, combinations } = Basis::of(self);
        let values: Vec<f64> = products.iter().map(|p| value_and_gradient(*p, at).0).collect();
        (0..self.n_nodes())
            .map(|k| combinations.column(k).iter().zip(&values).map(|(c, v)| c * v).sum())
            .collect()
    }

    /// ∂N_k/∂ξ, ∂N_k/∂η, ∂N_k/∂ζ of every node at the reference coordinates `at`; not at the apex of a pyramid, where they depend on the way
    /// there.
    pub fn shape_gradients(self, at: [f64; 3]) -> Vec<[f64; 3]> {
        let Basis { products, combinations } = Basis::of(self);
        let slopes: Vec<[f64; 3]> = products.iter().map(|p| value_and_gradient(*p, at).1).collect();
        let of = |k: usize, i: usize| combinations.column(k).iter().zip(&slopes).map(|(c, s)| c * s[i]).sum();
        (0..self.n_nodes()).map(|k| std::array::from_fn(|i| of(k, i))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    /// Points inside a kind: means of its nodes with weights that differ.
    fn inside(kind: CellKind) -> Vec<[f64; 3]> {
        let nodes = kind.reference_coordinates();
        (0..6)
            .map(|k| {
                let weight = |i: usize| 1.0 + ((i * 7 + k * 13) % 5) as f64;
                let all: f64 = (0..nodes.len()).map(weight).sum();
                std::array::from_fn(|c| nodes.iter().enumerate().map(|(i, x)| weight(i) * x[c] / all).sum())
            })
            .collect()
    }

    #[test]
    fn they_are_one_at_their_node_and_zero_at_the_others() {
        for kind in CellKind::all() {
            for (i, at) in kind.reference_coordinates().into_iter().enumerate() {
                for (k, value) in kind.shape_functions(at).into_iter().enumerate() {
                    let expected = if i == k { 1.0 } else { 0.0 };
                    // Round-off of the inverse of a matrix of small integers.
                    assert!(
                        within((value - expected).abs(), 1e-13, RoundOff),
                        "{kind:?}: N{k} = {value} at node {i}"
                    );
                }
            }
        }
    }

    /// ΣN = 1, ΣN x = x; kinds of second order have x², xy, … too.
    #[test]
    fn they_give_back_polynomials_of_their_order() {
        for kind in CellKind::all().filter(|kind| kind.dimension() > 0) {
            let nodes = kind.reference_coordinates();
            let order = if kind.is_first_order() { 1 } else { 2 };
            for at in inside(kind) {
                let shape = kind.shape_functions(at);
                for (a, b, c) in (0..=order).flat_map(|a| (0..=order - a).map(move |b| (a, b, order - a - b)))
                {
                    let f = |x: &[f64; 3]| x[0].powi(a) * x[1].powi(b) * x[2].powi(c);
                    let sum: f64 = shape.iter().zip(&nodes).map(|(n, x)| n * f(x)).sum();
                    assert!(
                        within((sum - f(&at)).abs(), 1e-13, RoundOff),
                        "{kind:?} x^{a} y^{b} z^{c}: {sum} {}",
                        f(&at)
                    );
                }
                assert!(within((shape.iter().sum::<f64>() - 1.0).abs(), 1e-13, RoundOff), "{kind:?}");
            }
        }
    }

    /// On a side only the nodes of the side count, and their functions are those of its kind: cells that share a side fit.
    #[test]
    fn on_a_side_they_are_those_of_the_side() {
        for kind in CellKind::all().filter(|kind| kind.dimension() > 1) {
            let nodes = kind.reference_coordinates();
            for (side, of) in kind.table().sides {
                for at in inside(*side) {
                    let own = side.shape_functions(at);
                    let place = std::array::from_fn(|c| {
                        own.iter().zip(*of).map(|(n, k)| n * nodes[usize::from(*k)][c]).sum()
                    });
                    let shape = kind.shape_functions(place);
                    for (k, value) in shape.iter().enumerate() {
                        let expected =
                            of.iter().position(|node| usize::from(*node) == k).map_or(0.0, |j| own[j]);
                        assert!(
                            within((value - expected).abs(), 1e-13, RoundOff),
                            "{kind:?} {of:?}: N{k} = {value}, {expected}"
                        );
                    }
                }
            }
        }
    }

    /// Against central differences, whose error is some h² and round-off over h.
    #[test]
    fn gradients_are_those_of_the_functions() {
        let h = 1e-5;
        for kind in CellKind::all().filter(|kind| kind.dimension() > 0) {
            for at in inside(kind) {
                let gradients = kind.shape_gradients(at);
                for c in 0..kind.dimension() {
                    let moved = |by: f64| {
                        let mut at = at;
                        at[c] += by;
                        kind.shape_functions(at)
                    };
                    let (up, down) = (moved(h), moved(-h));
                    for (k, gradient) in gradients.iter().enumerate() {
                        let difference = (up[k] - down[k]) / (2.0 * h);
                        assert!(
                            within((gradient[c] - difference).abs(), 1e-8, Reference),
                            "{kind:?} N{k} by {c}"
                        );
                    }
                }
            }
        }
    }
}
