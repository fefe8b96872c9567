//! Compliances of forces: what the Ritz vectors have of them, and what rounding makes of them.

use crate::linalg::dense::product;
use crate::linalg::random::Random;
use crate::linalg::sparse::{dot, times};
use crate::stability::analysis::CompletedAnalysis;
use faer::Mat;

/// Ritz vectors x in the basis, with bᵀAb of each.
pub(super) struct RitzPairs<'a> {
    pub(super) x: &'a Mat<f64>,
    pub(super) distances: Vec<f64>,
}

impl RitzPairs<'_> {
    /// (BᵀAB)⁻¹BᵀF, given BᵀF.
    pub(super) fn solution(&self, share: &Mat<f64>) -> Mat<f64> {
        let mut seen = product(self.x.transpose(), share.as_ref());
        for j in 0..seen.ncols() {
            seen.col_as_slice_mut(j).iter_mut().zip(&self.distances).for_each(|(x, d)| *x /= d);
        }
        product(self.x.as_ref(), seen.as_ref())
    }
}

/// A few random combinations c of forces F, with cᵀFᵀA⁻¹Fc to the square of the rounding: a solution x ≈ A⁻¹f of f = Fc leaves
/// r = f − Ax, and fᵀA⁻¹f = fᵀx + rᵀx + rᵀA⁻¹r. What rounding makes of r itself shows as an error, too.
pub(super) struct Probes {
    compliances: Vec<f64>,
}

impl Probes {
    /// How many there are.
    const COUNT: usize = 4;
    /// CouplingFactor on the largest error seen. A symmetric error of norm e with the numbers c between −1 and 1 shows as
    /// e/100 at least in one of four, but for once in three thousand times when it has rank one, and seldomer with more.
    const MARGIN: f64 = 100.0;

    /// Of so many forces.
    pub(super) fn combinations(forces: usize) -> Mat<f64> {
        let mut random = Random::new();
        Mat::from_fn(forces, Self::COUNT, |_, _| random.next())
    }

    /// Of the combined forces.
    pub(super) fn new(analysis: &CompletedAnalysis<'_>, mut sum: Mat<f64>) -> Self {
        let CompletedAnalysis { operator, factor, shift, .. } = analysis;
        let mut x = sum.clone();
        factor.solve_in_place(x.as_mut());
        let image =
            times(&operator.stiffness, x.as_ref()) - times(operator.mass, x.as_ref()) * faer::Scale(*shift);
        let residual = &sum - image;
        sum += residual;
        let compliance = |j: usize| dot(sum.col_as_slice(j), x.col_as_slice(j));
        Probes { compliances: (0..Self::COUNT).map(compliance).collect() }
    }

    /// An upper estimate of the error of FᵀA⁻¹F in the 2-norm, given its products with the combinations.
    pub(super) fn error(&self, combinations: &Mat<f64>, images: &Mat<f64>) -> f64 {
        let error = |j: usize| {
            (dot(combinations.col_as_slice(j), images.col_as_slice(j)) - self.compliances[j]).abs()
        };
        Self::MARGIN * (0..Self::COUNT).map(error).fold(0.0, f64::max)
    }
}
