//! Pairs measured on the full order: residuals, errors, and the corrections that make them better.

use super::basis::Basis;
use super::responses::SKETCH;
use super::{CONTACT_ROUNDING, NEAR_ZERO, ROUNDING};
use crate::dynamics::{Block, Forms, Operator, Side};
use crate::linalg::SymmetricFactor;
use crate::linalg::c64;
use crate::linalg::multivector::{append, combine, expand};
use crate::linalg::random::Random;
use crate::linalg::sparse::times;
use faer::{Accum, Mat};
use rayon::prelude::*;

/// Aims of the refinement, below what [`super::ComplexMode::accepted`] asks.
const BACKWARD_ERROR: f64 = 5e-11;
const EIGENVALUE_ERROR: f64 = 1e-10;

/// |Δλ|/|λ| that rounding leaves of three eigenvalues that have become one: ∛(10 ε), the most that is stated.
const DEFECTIVE: f64 = 1.4e-5;
/// Below this part of the band's top an eigenvalue may be zero but for rounding.
const SLOW: f64 = 1e-3;

/// Pairs that are measured together: few, so that little memory is held.
pub(super) const TOGETHER: usize = 8;

/// A few pairs with their measures on the full order. Its memory serves the next few.
#[derive(Default)]
pub(super) struct MeasuredPairs {
    pub(super) lambda: Vec<c64>,
    /// φ, with unit mass.
    pub(super) right: Block,
    /// ψ in coordinates of the basis, with unit mass.
    pub(super) left: Block,
    /// ψᴴQ′(λ)φ.
    pub(super) steepness: Vec<c64>,
    /// z = −A⁻¹Q(λ)φ.
    pub(super) correction: Block,
    pub(super) backward_error: Vec<f64>,
    /// |ψᴴQ(λ)z| / |λ ψᴴQ′(λ)φ|: what the vectors leave, which a larger basis brings down.
    pub(super) eigenvalue_error: Vec<f64>,
    /// What rounding leaves at the least, relative to λ ([`super::ComplexMode::eigenvalue_error`]).
    pub(super) rounding: Vec<f64>,
    /// |Δλ| where λ is zero but for rounding \[1/s\].
    pub(super) zero: Vec<Option<f64>>,
    pub(super) condition: Vec<f64>,
    /// ‖Q(λ)(φ + z)‖ / (|λ|²‖M‖ + |λ|‖C‖ + ‖K‖).
    pub(super) corrected: Vec<f64>,
    /// Bilinear forms of φ with φ, and of φ + z with φ + z.
    pub(super) forms: Vec<[Forms; 2]>,
}

/// Operator and scales by which pairs are measured.
pub(super) struct PairMeasurement<'a> {
    pub(super) operator: &'a Operator<'a>,
    pub(super) basis: &'a Basis<'a>,
    /// A.
    pub(super) factor: &'a dyn SymmetricFactor,
    /// The top of the band \[rad/s\].
    pub(super) top: f64,
}

impl PairMeasurement<'_> {
    /// Measures pairs, given λ, φ and what is known of ψ. The right corrections, which are solved for, give the errors of λ
    /// and φ.
    pub(super) fn measure(&self, pairs: &mut MeasuredPairs) {
        let PairMeasurement { operator, basis, factor, top } = *self;
        let MeasuredPairs { lambda, right, left, steepness, correction, .. } = pairs;
        let columns = 0..lambda.len();
        // Q(λ)φ and Q(λ)z are not held longer than this, as the vectors that are given add up.
        let [mut residual, mut image] = [(); 2].map(|()| Block::zeros(operator.n(), lambda.len()));
        let of_right = operator.add_value(lambda, right, &mut residual, &[right]);
        let sizes: Vec<f64> = lambda.iter().map(|lambda| operator.size(*lambda)).collect();
        // A system without stiffness has nothing at λ = 0.
        let error = |j: usize| residual.norm(j) / (sizes[j] * right.norm(j)).max(f64::MIN_POSITIVE);
        pairs.backward_error = columns.clone().into_par_iter().map(error).collect();
        correction.set_scaled(-1.0, &residual);
        factor.solve_in_place(correction.parts_mut());
        let of_correction = operator.add_value(lambda, correction, &mut image, &[right, correction]);
        // ψᴴQ(λ)z in coordinates of the basis. Without Q(λ)φ, which is nothing but rounding to ψ, and that of a large K.
        let rise = image.map(|image| basis.columns().gram(image));
        let corrected = |j: usize| residual.norm_of_sum(j, &image) / sizes[j].max(f64::MIN_POSITIVE);
        pairs.corrected = columns.clone().into_par_iter().map(corrected).collect();
        // Where two eigenvalues have become one ψᴴQ′(λ)φ vanishes, and may do so exactly.
        let steep = |j: usize| steepness[j].norm().max(f64::EPSILON * top);
        let size = |j: usize| steep(j) * lambda[j].norm().max(1e-6 * top);
        pairs.eigenvalue_error = columns.clone().map(|j| left.dot(j, &rise).norm() / size(j)).collect();
        pairs.condition =
            columns.clone().map(|j| (2.0 * lambda[j].norm()).max(f64::EPSILON * top) / steep(j)).collect();
        let rounding = |j: usize| {
            let [of_left, of_right] =
                [basis.extents(left.vector(j)), operator.interface.extents(right.vector(j))];
            let work = operator.interface.gross_work(lambda[j], &of_left, &of_right);
            (ROUNDING * pairs.condition[j], work)
        };
        let (own, works): (Vec<f64>, Vec<f64>) = columns.clone().map(rounding).unzip();
        let relative = |j: usize| own[j].min(DEFECTIVE) + CONTACT_ROUNDING * works[j] / size(j);
        pairs.rounding = columns.clone().map(relative).collect();
        pairs.zero = vec![None; lambda.len()];
        let small = |j: &usize| {
            let size = lambda[*j].norm();
            size <= SLOW * top || size <= top && may_be_zero(operator, lambda[*j], right.norm(*j).powi(2))
        };
        if columns.clone().any(|j| small(&j)) {
            let value = residual.map(|residual| basis.columns().gram(residual));
            let inertia = right.map(|x| basis.columns().gram(times(operator.mass, x).as_ref()));
            for j in columns.clone().filter(small) {
                let gross = operator.gross_stiffness(right.vector(j));
                // No digit of λ is known below those of the band.
                let digits = ROUNDING * SLOW * top * steepness[j].norm();
                let least = ROUNDING * gross + CONTACT_ROUNDING * works[j] + digits;
                let [of_vectors, of_value] = [&rise, &value].map(|image| left.dot(j, image).norm());
                let (change, mass) = (least + of_vectors + 2.0 * of_value, left.dot(j, &inertia).norm());
                if lambda[j].norm_sqr() * mass > NEAR_ZERO * change {
                    continue;
                }
                let uncertainty = root_shift(change, steepness[j].norm(), mass);
                let scale = gross.sqrt().max(SLOW * top);
                pairs.zero[j] = Some(uncertainty);
                pairs.rounding[j] = uncertainty / scale;
                pairs.eigenvalue_error[j] =
                    if of_vectors <= least { 0.0 } else { root_shift(of_vectors, steep(j), mass) / scale };
            }
        }
        let forms = |j: usize| {
            [of_right[0][j], Forms::of_sum(of_right[0][j], of_correction[0][j], of_correction[1][j])]
        };
        pairs.forms = columns.map(forms).collect();
    }
}

/// How far a change p of q(λ) = ψᴴQ(λ)φ, of slope s = |q′| and curvature m = |½ q″|, moves the nearest root at most: p/s of a single
/// one, √(p/m) of a double one.
fn root_shift(p: f64, s: f64, m: f64) -> f64 {
    let double = (p / m).sqrt();
    let single = 2.0 * p / (s + (s * s - 4.0 * m * p).max(0.0).sqrt());
    // The smaller of the two, whichever is a number.
    double.min(single)
}

impl MeasuredPairs {
    /// |Δλ| of pair `j` \[1/s\], in a band up to `top` \[rad/s\].
    pub(super) fn uncertainty(&self, j: usize, top: f64) -> f64 {
        self.zero[j].unwrap_or_else(|| self.error(j) * self.lambda[j].norm().max(1e-6 * top))
    }

    /// |Δλ| / |λ| of pair `j`.
    pub(super) fn error(&self, j: usize) -> f64 {
        self.eigenvalue_error[j] + self.rounding[j]
    }

    /// Whether pair `j` is as exact as the refinement aims at.
    pub(super) fn exact(&self, j: usize) -> bool {
        self.backward_error[j] <= BACKWARD_ERROR && self.eigenvalue_error[j] <= EIGENVALUE_ERROR
    }
}

/// The corrections that pairs ask for, right and left, each divided by |λ|: their squared E-norm is then about the relative
/// error of λ that they represent.
pub(super) struct Corrections {
    /// The most pairs that can ask for some.
    most: usize,
    /// Re and Im of z, with memory for the left ones after them.
    right: Mat<f64>,
    /// Re and Im of Q(λ)ᴴψ; of many only as many random combinations as reveal what they have in common (Halko, Martinsson &
    /// Tropp, SIAM Rev. 53 (2011) 217), as the contact forces of many pairs come from few motions.
    left: Mat<f64>,
    /// The factors of those combinations, once there are any.
    random: Option<Random>,
}

impl Corrections {
    /// None yet, of at most so many pairs.
    pub(super) fn of_at_most(most: usize) -> Self {
        Corrections { most, right: Mat::new(), left: Mat::new(), random: None }
    }

    /// Adds those of the pairs that are not exact. Left ones are of use as long as λ is not exact, and where left vectors are `kept`.
    pub(super) fn add(&mut self, scale: &PairMeasurement<'_>, measured: &MeasuredPairs, kept: bool) {
        let open: Vec<usize> = (0..measured.lambda.len()).filter(|j| !measured.exact(*j)).collect();
        if open.is_empty() {
            return;
        }
        if self.is_empty() {
            let (n, left) = (scale.operator.n(), SKETCH.min(2 * self.most));
            self.right = Mat::with_capacity(n, 2 * self.most + left);
            self.left = Mat::with_capacity(n, left);
        }
        let scaled = |which: &[usize], mut block: Block| {
            let factor = |j: &usize| 1.0 / measured.lambda[*j].norm().max(1e-3 * scale.top);
            block.scale(&which.iter().map(factor).collect::<Vec<f64>>());
            block.into_parts()
        };
        append(&mut self.right, scaled(&open, Block::gathered(&measured.correction, &open)).as_ref());
        let mut left = open;
        left.retain(|j| kept || measured.eigenvalue_error[*j] > EIGENVALUE_ERROR);
        if left.is_empty() {
            return;
        }
        let lambda: Vec<c64> = left.iter().map(|j| measured.lambda[*j]).collect();
        let vectors = scale.basis.expand(&Block::gathered(&measured.left, &left));
        self.add_left(scaled(&left, scale.operator.value(Side::Left, &lambda, &vectors)));
    }

    fn add_left(&mut self, new: Mat<f64>) {
        let known = self.left.ncols();
        if self.random.is_none() && known + new.ncols() <= SKETCH {
            return append(&mut self.left, new.as_ref());
        }
        let mut random = self.random.take().unwrap_or_else(|| {
            let mut random = Random::new();
            self.left = expand(self.left.as_ref(), mixing(known, &mut random).as_ref());
            random
        });
        let factors = mixing(new.ncols(), &mut random);
        combine(self.left.as_mut(), Accum::Add, new.as_ref(), factors.as_ref(), 1.0);
        self.random = Some(random);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.right.ncols() == 0
    }

    /// The corrections, one a column; the left ones are solved for here.
    pub(super) fn corrections(self, factor: &dyn SymmetricFactor) -> Mat<f64> {
        let Corrections { right: mut all, mut left, .. } = self;
        if left.ncols() > 0 {
            factor.solve_in_place(left.as_mut());
            append(&mut all, left.as_ref());
        }
        all
    }
}

/// Random factors of `rows` vectors in [`SKETCH`] combinations.
fn mixing(rows: usize, random: &mut Random) -> Mat<f64> {
    Mat::from_fn(rows, SKETCH, |_, _| random.next())
}

/// Whether |λ| may be zero but for rounding, of a vector with ‖φ‖² = `square`: a bound, which costs nothing.
fn may_be_zero(operator: &Operator<'_>, lambda: c64, square: f64) -> bool {
    lambda.norm_sqr() <= NEAR_ZERO * ROUNDING * operator.stiffness_size() * square
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    /// Left corrections of `count` columns, all multiples of (1, 2, …), eight at a time.
    fn alike(count: usize) -> Mat<f64> {
        let mut corrections = Corrections::of_at_most(count);
        for first in (0..count).step_by(8) {
            let new = Mat::from_fn(5, 8.min(count - first), |i, j| (i + 1) as f64 * (first + j + 1) as f64);
            corrections.add_left(new);
        }
        corrections.left
    }

    #[test]
    fn many_left_corrections_become_combinations_that_span_what_they_span() {
        let few = alike(SKETCH);
        assert!(few.ncols() == SKETCH && (0..SKETCH).all(|j| few[(0, j)] == (j + 1) as f64));
        let many = alike(3 * SKETCH);
        assert_eq!(many.ncols(), SKETCH);
        for column in many.col_iter() {
            let size = column[0].abs();
            assert!(size > 1e-3, "a random combination does not vanish");
            assert!((0..5).all(|i| within(
                (column[i] - (i + 1) as f64 * column[0]).abs(),
                1e-9 * size.max(1e3),
                RoundOff
            )));
        }
    }
}
