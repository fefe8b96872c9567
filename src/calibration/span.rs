//! The space of a level's motions where they were measured, and how it turns with the unknowns.

use super::svd::Svd;
use nalgebra::{DMatrix, DVector};

/// A motion that is this share of the largest adds nothing to the space.
const RANK: f64 = 1e-6;

/// The motions that the modes of a level make at the measured degrees of freedom: one column a mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Span {
    /// Φ, in any scale and turn.
    pub motions: DMatrix<f64>,
    /// ∂Φ/∂x_j; what of it lies in the span of Φ does not matter.
    pub slopes: Vec<DMatrix<f64>>,
}

/// A measured shape less its nearest neighbour in a [`Span`].
#[derive(Debug, Clone, PartialEq)]
pub struct Apart {
    /// e = (I − P)ψ.
    pub rest: DVector<f64>,
    /// ∂e/∂x_j.
    pub slopes: Vec<DVector<f64>>,
}

/// Φ = U S Vᵀ without what is no motion of its own: U, V S⁻¹.
struct SpanFactors {
    u: DMatrix<f64>,
    v: DMatrix<f64>,
}

impl Span {
    fn factors(&self) -> SpanFactors {
        let svd = Svd::new(&self.motions);
        let largest = svd.s.first().copied().unwrap_or(0.0);
        let kept = svd.s.iter().filter(|s| **s > RANK * largest).count();
        let v = DMatrix::from_fn(svd.v.nrows(), kept, |i, k| svd.v[(i, k)] / svd.s[k]);
        SpanFactors { u: svd.u.columns(0, kept).into_owned(), v }
    }

    /// How many scale factors a measured shape has in it: the dimension of the space.
    pub fn dimension(&self) -> usize {
        self.factors().u.ncols()
    }

    /// The residual of a measured shape ψ once its scale in the space is eliminated, e = (I − P)ψ with the orthogonal
    /// projection P = ΦΦ⁺ (the modal scale factor: Friswell and Mottershead, Finite Element Model Updating in Structural
    /// Dynamics, 1995, ch. 4), and its derivatives
    ///
    /// ∂e = −(I − P) ∂Φ Φ⁺ψ − (Φ⁺)ᵀ ∂Φᵀ e
    ///
    /// (variable projection: Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973) 413), which do not know how Φ is turned or
    /// scaled. ‖e‖² = (1 − MAC)‖ψ‖².
    pub fn apart(&self, shape: &[f64]) -> Apart {
        let SpanFactors { u, v } = self.factors();
        let shape = DVector::from_column_slice(shape);
        let inside = u.tr_mul(&shape);
        let rest = &shape - &u * &inside;
        let scales = &v * &inside;
        let slope = |turn: &DMatrix<f64>| {
            let moved = turn * &scales;
            let outside = &moved - &u * u.tr_mul(&moved);
            -outside - &u * v.tr_mul(&turn.tr_mul(&rest))
        };
        Apart { slopes: self.slopes.iter().map(slope).collect(), rest }
    }

    /// MAC of a measured shape with the space; zero when either side is.
    pub fn mac(&self, shape: &[f64]) -> f64 {
        let size: f64 = shape.iter().map(|v| v * v).sum();
        let inside = self.factors().u.tr_mul(&DVector::from_column_slice(shape)).norm_squared();
        if size > 0.0 { (inside / size).min(1.0) } else { 0.0 }
    }

    /// The part of a measured shape that lies in the space, as large as the shape.
    pub(super) fn nearest(&self, shape: &[f64]) -> Vec<f64> {
        let SpanFactors { u, .. } = self.factors();
        let shape = DVector::from_column_slice(shape);
        let inside = &u * u.tr_mul(&shape);
        let scale = shape.norm() / inside.norm().max(f64::MIN_POSITIVE);
        inside.iter().map(|v| scale * v).collect()
    }

    /// The space a step d away, to first order.
    pub(super) fn moved(&self, step: &[f64]) -> Span {
        let mut motions = self.motions.clone();
        self.slopes.iter().zip(step).for_each(|(slope, d)| motions += slope * *d);
        Span { motions, slopes: self.slopes.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::turning;
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn what_is_left_of_a_shape_has_the_slopes_of_differences() {
        for modes in [1, 2] {
            let x = [0.3, -0.2];
            let shape: Vec<f64> = (0..9).map(|k| (1.0 + 1.7 * f64::from(k)).sin()).collect();
            let at = |x: &[f64]| turning(9, modes, x).apart(&shape);
            let here = at(&x);
            let mac = turning(9, modes, &x).mac(&shape);
            let size: f64 = shape.iter().map(|v| v * v).sum();
            assert!(within((here.rest.norm_squared() - (1.0 - mac) * size).abs(), 1e-12 * size, RoundOff));
            for j in 0..2 {
                let h = 1e-3;
                let moved = |k: f64| {
                    let mut x = x;
                    x[j] += k * h;
                    at(&x).rest
                };
                let expected = (8.0 * (moved(1.0) - moved(-1.0)) - (moved(2.0) - moved(-2.0))) / (12.0 * h);
                assert!(expected.norm() > 0.01);
                assert!(
                    within((&here.slopes[j] - &expected).norm(), 1e-9 * expected.norm(), Reference),
                    "{modes} {j}"
                );
            }
        }
    }

    #[test]
    fn neither_scale_nor_turn_of_the_modes_matters_and_dependent_ones_count_once() {
        let span = turning(7, 2, &[0.1, 0.4]);
        let shape: Vec<f64> = (0..7).map(|k| f64::from(k).cos()).collect();
        let turn = DMatrix::from_row_slice(2, 2, &[3.0, -4.0, 0.5, 2.0]);
        // What lies in the span may be added to the slopes.
        let slopes = span.slopes.iter().map(|slope| slope * &turn + &span.motions * &turn).collect();
        let other = Span { motions: &span.motions * &turn, slopes };
        let (a, b) = (span.apart(&shape), other.apart(&shape));
        assert!(within((a.rest - b.rest).norm(), 1e-12, RoundOff));
        assert!(a.slopes.iter().zip(&b.slopes).all(|(a, b)| within((a - b).norm(), 1e-12, RoundOff)));
        let twice = DMatrix::from_fn(7, 2, |i, k| span.motions[(i, 0)] * (1.0 + k as f64));
        let one = Span { motions: twice, slopes: vec![] };
        assert!(one.dimension() == 1 && span.dimension() == 2);
        let near = one.nearest(&shape);
        assert!(within((one.mac(&near) - 1.0).abs(), 1e-14, RoundOff));
        let none = Span { motions: DMatrix::zeros(7, 1), slopes: vec![] };
        assert_eq!((none.dimension(), none.mac(&shape)), (0, 0.0));
    }
}
