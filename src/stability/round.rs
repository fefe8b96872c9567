//! Pairs measured on the full order: residuals, errors, and the corrections that make them better.

use super::block::Block;
use super::operator::{Images, Operator, Side};
use super::projected::SmallPair;
use super::responses::SKETCH;
use crate::linalg::SymmetricFactor;
use crate::linalg::c64;
use crate::linalg::random::Random;
use crate::linalg::tall::{beside, expand};
use faer::Mat;
use rayon::prelude::*;

/// Aims of the refinement, below what [`super::ComplexMode::accepted`] asks.
const BACKWARD_ERROR: f64 = 5e-11;
const EIGENVALUE_ERROR: f64 = 1e-10;
/// Two eigenvalues nearer than this part of |λ| may be taken for each other.
const ALONE: f64 = 1e-6;

/// Pairs with their measures on the full order.
pub(super) struct Round {
    pub(super) lambda: Vec<c64>,
    pub(super) phi: Block,
    pub(super) psi: Block,
    pub(super) backward_error: Vec<f64>,
    pub(super) eigenvalue_error: Vec<f64>,
    pub(super) condition: Vec<f64>,
    /// z = −A⁻¹Q(λ)φ and Q(λ)ᴴψ of the pairs that were measured last, whose places are `measured`.
    correction: Block,
    left_residual: Block,
    measured: Vec<usize>,
}

impl Round {
    /// Those measured last that are not yet as exact as the refinement aims at, as places in `measured`.
    pub(super) fn open(&self) -> Vec<usize> {
        (0..self.measured.len()).filter(|k| !self.exact(self.measured[*k])).collect()
    }

    /// φ + z of some pairs, φ of those that were not measured last.
    pub(super) fn corrected(&self, pairs: &[usize]) -> Block {
        let mut sum = Block::gathered(pairs.iter().map(|j| (&self.phi, *j)));
        for (k, j) in pairs.iter().enumerate() {
            if let Ok(place) = self.measured.binary_search(j) {
                sum.add_column(k, &self.correction, place);
            }
        }
        sum
    }

    /// Gives back the memory of corrections and residuals.
    pub(super) fn forget_corrections(&mut self) {
        let n = self.phi.re.nrows();
        (self.correction, self.left_residual) = (Block::zeros(n, 0), Block::zeros(n, 0));
    }

    fn exact(&self, j: usize) -> bool {
        self.backward_error[j] <= BACKWARD_ERROR && self.eigenvalue_error[j] <= EIGENVALUE_ERROR
    }

    /// These pairs and, where `kept` says so, those of a round before, in the order of `kept`.
    pub(super) fn beside(self, before: &Round, kept: &[Option<usize>]) -> Round {
        let fresh: Vec<usize> = (0..kept.len()).filter(|j| kept[*j].is_none()).collect();
        let from = |j: usize| match kept[j] {
            Some(k) => (before, k),
            None => (&self, fresh.partition_point(|f| *f < j)),
        };
        let of = |list: fn(&Round) -> &Vec<f64>| -> Vec<f64> {
            (0..kept.len()).map(|j| list(from(j).0)[from(j).1]).collect()
        };
        let block = |pick: fn(&Round) -> &Block| {
            Block::gathered((0..kept.len()).map(|j| (pick(from(j).0), from(j).1)))
        };
        Round {
            lambda: (0..kept.len()).map(|j| from(j).0.lambda[from(j).1]).collect(),
            phi: block(|round| &round.phi),
            psi: block(|round| &round.psi),
            backward_error: of(|round| &round.backward_error),
            eigenvalue_error: of(|round| &round.eigenvalue_error),
            condition: of(|round| &round.condition),
            correction: self.correction,
            left_residual: self.left_residual,
            measured: fresh,
        }
    }

    /// The pair that is exact enough and no other than the one with this λ, when both rounds have just one there.
    pub(super) fn settled(&self, all: &[SmallPair], lambda: c64) -> Option<usize> {
        let near = |z: c64| (z - lambda).norm() <= ALONE * lambda.norm();
        let mut own = (0..self.lambda.len()).filter(|j| near(self.lambda[*j]));
        let alone = all.iter().filter(|pair| near(pair.lambda)).count() == 1;
        let j = own.next().filter(|j| alone && own.next().is_none() && self.exact(*j))?;
        ((self.lambda[j] - lambda).norm() <= EIGENVALUE_ERROR * lambda.norm()).then_some(j)
    }
}

/// A few pairs with what the structure makes of their vectors, whose mass is one.
pub(super) struct Vectors {
    pub(super) lambda: Vec<c64>,
    pub(super) right: Images,
    pub(super) left: Images,
}

/// Pairs with their residuals on the full order.
pub(super) struct Residuals {
    lambda: Vec<c64>,
    phi: Block,
    psi: Block,
    /// Q(λ)φ.
    right: Block,
    /// Q(λ)ᴴψ.
    left: Block,
    backward_error: Vec<f64>,
    /// |ψᴴQ′(λ)φ|.
    steepness: Vec<f64>,
}

/// The residuals of pairs that come a few at a time, so that little memory is held.
pub(super) fn residuals(operator: &Operator<'_>, pairs: impl Iterator<Item = Vectors>) -> Residuals {
    let n = operator.n();
    let empty = || Block::zeros(n, 0);
    let mut all = Residuals {
        lambda: Vec::new(),
        phi: empty(),
        psi: empty(),
        right: empty(),
        left: empty(),
        backward_error: Vec::new(),
        steepness: Vec::new(),
    };
    for Vectors { lambda, right: phi, left: psi } in pairs {
        let right = operator.value(Side::Right, &lambda, &phi);
        let left = operator.value(Side::Left, &lambda, &psi);
        all.steepness.extend(operator.steepness(&lambda, &psi.vectors, &phi).iter().map(|s| s.norm()));
        let (phi, psi) = (phi.vectors, psi.vectors);
        let error = |(j, z): (usize, &c64)| right.norm(j) / (operator.size(*z) * phi.norm(j));
        all.backward_error.par_extend(lambda.par_iter().enumerate().map(error));
        all.lambda.extend(lambda);
        all.phi.append(phi);
        all.psi.append(psi);
        all.right.append(right);
        all.left.append(left);
    }
    all
}

/// Solves for the right corrections, which tell the errors of λ and φ.
pub(super) fn measure(factor: &dyn SymmetricFactor, band: [f64; 2], pairs: Residuals) -> Round {
    let Residuals { lambda, phi, psi, right: mut correction, left, backward_error, steepness } = pairs;
    for part in [&mut correction.re, &mut correction.im] {
        *part *= faer::Scale(-1.0);
        factor.solve_in_place(part.as_mut());
    }
    let floor = 1e-6 * band[1];
    let of =
        |f: &(dyn Fn(usize) -> f64 + Sync)| (0..lambda.len()).into_par_iter().map(f).collect::<Vec<f64>>();
    Round {
        eigenvalue_error: of(&|j| {
            left.dot(j, &correction).norm() / (steepness[j] * lambda[j].norm().max(floor))
        }),
        condition: of(&|j| 2.0 * lambda[j].norm() / steepness[j]),
        measured: (0..lambda.len()).collect(),
        left_residual: left,
        lambda,
        phi,
        psi,
        backward_error,
        correction,
    }
}

/// Re and Im of the corrections of the `open` pairs of those measured last, right and left, each divided by |λ|: their
/// squared E-norm is then about the relative error of λ that they stand for.
///
/// The left ones are still to be solved for: of many only as many random combinations as reveal what they have in common
/// (Halko, Martinsson & Tropp, SIAM Rev. 53 (2011) 217), as the contact forces of many pairs come from few motions.
pub(super) fn wanted_corrections(
    round: &Round,
    factor: &dyn SymmetricFactor,
    open: &[usize],
    floor: f64,
) -> Mat<f64> {
    let size = |k: usize| 1.0 / round.lambda[round.measured[k]].norm().max(floor);
    let scaled = |block: &Block| {
        Mat::from_fn(factor.n(), 2 * open.len(), |i, c| {
            let part = if c % 2 == 0 { &block.re } else { &block.im };
            part[(i, open[c / 2])] * size(open[c / 2])
        })
    };
    let mut left = scaled(&round.left_residual);
    if left.ncols() > SKETCH {
        let mut random = Random::new();
        left = expand(left.as_ref(), Mat::from_fn(left.ncols(), SKETCH, |_, _| random.next()).as_ref());
    }
    factor.solve_in_place(left.as_mut());
    beside(&scaled(&round.correction), &left)
}
