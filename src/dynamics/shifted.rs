//! Q at a shift, factorised: what shift-and-invert methods and harmonic responses solve with.

use super::operator::{Operator, Side};
use crate::error::Result;
use crate::linalg::dense::product;
use crate::linalg::factor::{SymbolicFactor, SymmetricFactor, System, UnsymmetricFactor, factorize};
use crate::linalg::lu::Lu;
use crate::linalg::multivector::{expand, gram};
use crate::linalg::sparse::{add_scaled, multiply};
use crate::linalg::toar::ShiftedQuadratic;
use crate::linalg::{SparseMatrix, SparseVector, c64};
use faer::{Mat, MatRef};

/// Of more directions than these the interface is part of the sparse matrix, if that takes no more entries than their responses.
const FEW_DIRECTIONS: usize = 300;

/// Q at a shift: P = P_s + F G Fᵀ with the sparse P_s = σ²M + σC + K + iH, complex symmetric unless K and C have sparse skew
/// parts, and F = \[B W\], G = diag(σ c, k + σ c_c) of the modal damping and the interface. An interface of many directions is part
/// of P_s, which is not symmetric then, and F = B: no matrix is dense in the number of contact points.
///
/// P⁻¹ r = y − Y (I + G FᵀY)⁻¹ G Fᵀ y with y = P_s⁻¹ r and Y = P_s⁻¹ F (Sherman, Morrison & Woodbury), and with the adjoints
/// of P_s and G for P⁻ᴴ r.
pub struct Shifted<'a> {
    operator: &'a Operator<'a>,
    shift: c64,
    factors: FactorKind,
    /// W, unless it is part of P_s.
    directions: &'a [&'a SparseVector],
    /// G.
    small: Mat<c64>,
    right: Woodbury,
    left: Option<Woodbury>,
}

/// P_s.
enum FactorKind {
    Symmetric(Box<dyn SymmetricFactor<c64>>),
    Unsymmetric(Box<UnsymmetricFactor>),
}

/// Y and I + G FᵀY, or those of the adjoint.
struct Woodbury {
    responses: Mat<c64>,
    lu: Lu<c64>,
}

impl FactorKind {
    fn solve(&self, side: Side, r: &mut Mat<c64>) {
        match (self, side) {
            (FactorKind::Symmetric(factor), Side::Right) => factor.solve_in_place(r.as_mut()),
            (FactorKind::Symmetric(factor), Side::Left) => {
                let conjugate = |r: &mut Mat<c64>| {
                    (0..r.ncols()).for_each(|j| r.col_mut(j).iter_mut().for_each(|v| *v = v.conj()));
                };
                conjugate(r);
                factor.solve_in_place(r.as_mut());
                conjugate(r);
            }
            (FactorKind::Unsymmetric(factor), side) => {
                let system = if side == Side::Right { System::Plain } else { System::Adjoint };
                factor.solve(system, r.as_mut());
            }
        }
    }
}

impl<'a> Shifted<'a> {
    /// Factorises P = Q(σ) at the shift σ, for solutions with P alone.
    ///
    /// # Errors
    /// A singular sparse part P_s, as at an eigenvalue of it.
    pub fn new(operator: &'a Operator<'a>, shift: c64) -> Result<Self> {
        Shifted::with_pattern(operator, shift, None)
    }

    /// [`Shifted::new`] with the analysis of the pattern, where it is known.
    pub(crate) fn with_pattern(
        operator: &'a Operator<'a>,
        shift: c64,
        known: Option<&SymbolicFactor>,
    ) -> Result<Self> {
        let one = c64::new(1.0, 0.0);
        let mut terms: Vec<(c64, &SparseMatrix)> =
            vec![(one, &operator.stiffness), (shift * shift, operator.mass)];
        terms.extend(operator.damping.viscous.as_deref().map(|c| (shift, c)));
        terms.extend(operator.damping.hysteretic.as_deref().map(|h| (c64::new(0.0, 1.0), h)));
        let assembled = assembles(operator).then(|| operator.interface.assembled(operator.n()));
        // The pattern is a symmetric one.
        let mirrored = assembled.iter().flatten().map(transposed).collect::<Vec<SparseMatrix>>();
        let factors = match (operator.skew, &assembled) {
            (None, None) => FactorKind::Symmetric(factorize(&add_scaled(&terms))?),
            (skew, assembled) => {
                terms.extend(skew.iter().flat_map(|skew| [(one, &*skew.stiffness), (shift, &*skew.damping)]));
                terms.extend(assembled.iter().flat_map(|[k, c]| [(one, k), (shift, c)]));
                terms.extend(mirrored.iter().map(|a| (c64::new(0.0, 0.0), a)));
                let sum = add_scaled(&terms);
                let symbolic = match known {
                    Some(known) => known.clone(),
                    None => SymbolicFactor::new(sum.symbolic())?,
                };
                FactorKind::Unsymmetric(Box::new(UnsymmetricFactor::new(&symbolic, sum)?))
            }
        };
        let directions: &[&SparseVector] =
            if assembled.is_some() { &[] } else { &operator.interface.directions };
        let small = small(operator, shift, directions.len());
        let mut shifted = Shifted {
            operator,
            shift,
            factors,
            directions,
            small,
            right: Woodbury { responses: Mat::zeros(0, 0), lu: Lu::new(Mat::zeros(0, 0)) },
            left: None,
        };
        shifted.right = shifted.woodbury(Side::Right);
        Ok(shifted)
    }

    /// Makes solutions with Pᴴ possible.
    pub(crate) fn two_sided(mut self) -> Self {
        self.left = Some(self.woodbury(Side::Left));
        self
    }

    /// σ.
    pub fn shift(&self) -> c64 {
        self.shift
    }

    /// The analysis of the pattern of P_s, where P_s is not symmetric.
    pub(crate) fn symbolic(&self) -> Option<SymbolicFactor> {
        match &self.factors {
            FactorKind::Symmetric(_) => None,
            FactorKind::Unsymmetric(factor) => Some(factor.symbolic()),
        }
    }

    /// det P / |det P|; `None` where P_s is symmetric, or P is singular.
    pub(crate) fn phase(&self) -> Option<c64> {
        match &self.factors {
            FactorKind::Symmetric(_) => None,
            FactorKind::Unsymmetric(factor) => Some(factor.phase() * self.right.lu.phase()?),
        }
    }

    fn woodbury(&self, side: Side) -> Woodbury {
        let operator = self.operator;
        let modal = operator.damping.modal.as_ref();
        let m = modal.map_or(0, |modal| modal.coefficients.len());
        let size = self.small.nrows();
        let mut responses = Mat::<c64>::zeros(operator.n(), size);
        if let Some(modal) = modal {
            let basis = modal.basis.as_ref();
            responses
                .subcols_mut(0, m)
                .copy_from(Mat::from_fn(operator.n(), m, |i, j| c64::new(basis[(i, j)], 0.0)));
        }
        for (j, direction) in self.directions.iter().enumerate() {
            direction.iter().for_each(|(i, v)| responses[(i, m + j)] = c64::new(v, 0.0));
        }
        if size > 0 {
            self.factors.solve(side, &mut responses);
        }
        let moved = self.force(side, self.along(responses.as_ref()));
        Woodbury { responses, lu: Lu::new(Mat::<c64>::identity(size, size) + moved) }
    }

    /// G z, or Gᴴ z.
    fn force(&self, side: Side, z: Mat<c64>) -> Mat<c64> {
        match side {
            Side::Right => product(self.small.as_ref(), z.as_ref()),
            Side::Left => product(self.small.adjoint(), z.as_ref()),
        }
    }

    /// Fᵀ x.
    fn along(&self, x: MatRef<'_, c64>) -> Mat<c64> {
        let modal = self.operator.damping.modal.as_ref();
        let m = modal.map_or(0, |modal| modal.coefficients.len());
        let mut moved = Mat::zeros(self.small.nrows(), x.ncols());
        if let Some(modal) = modal {
            let part = |f: fn(&c64) -> f64| {
                gram(modal.basis.as_ref(), Mat::from_fn(x.nrows(), x.ncols(), |i, j| f(&x[(i, j)])).as_ref())
            };
            let (re, im) = (part(|z| z.re), part(|z| z.im));
            for j in 0..x.ncols() {
                (0..m).for_each(|i| moved[(i, j)] = c64::new(re[(i, j)], im[(i, j)]));
            }
        }
        for (i, direction) in self.directions.iter().enumerate() {
            for j in 0..x.ncols() {
                moved[(m + i, j)] = direction.iter().map(|(row, v)| x[(row, j)] * v).sum();
            }
        }
        moved
    }

    /// P⁻¹ r of every column r: for σ = iω the amplitudes u of the motion under the forces Re(r e^{iωt}). Not refined; see [`Harmonic`] for
    /// responses next to resonances.
    ///
    /// [`Harmonic`]: super::Harmonic
    pub fn invert(&self, r: Mat<c64>) -> Mat<c64> {
        self.solve_with(Side::Right, &self.right, r)
    }

    fn solve_with(&self, side: Side, woodbury: &Woodbury, mut r: Mat<c64>) -> Mat<c64> {
        self.factors.solve(side, &mut r);
        if self.small.nrows() == 0 {
            return r;
        }
        let force = woodbury.lu.solve(self.force(side, self.along(r.as_ref())));
        r - expand(woodbury.responses.as_ref(), force.as_ref())
    }

    /// P′x + M y = M (2σ x + y) + C x + F (∂G/∂σ) Fᵀ x, or with the adjoint of P′.
    fn slope(&self, side: Side, x: &Mat<c64>, y: Mat<c64>) -> Mat<c64> {
        let times = |a: &SparseMatrix, x: &Mat<c64>| {
            let mut product = Mat::zeros(x.nrows(), x.ncols());
            multiply(a, x.as_ref(), product.as_mut());
            product
        };
        let shift = if side == Side::Right { self.shift } else { self.shift.conj() };
        let mut r = times(self.operator.mass, &(x * faer::Scale(shift * 2.0) + y));
        if let Some(c) = &self.operator.damping.viscous {
            r += times(c, x);
        }
        if let Some(skew) = self.operator.skew {
            // A product with a matrix stored by columns is that with its transpose.
            match side {
                Side::Right => r -= times(&skew.damping, x),
                Side::Left => r += times(&skew.damping, x),
            }
        }
        if let Some(modal) = &self.operator.damping.modal {
            let (m, moved) = (modal.coefficients.len(), self.along(x.as_ref()));
            let part = |f: fn(&c64) -> f64| {
                let force = Mat::from_fn(m, 1, |i, _| modal.coefficients[i] * f(&moved[(i, 0)]));
                expand(modal.basis.as_ref(), force.as_ref())
            };
            let (re, im) = (part(|z| z.re), part(|z| z.im));
            (0..r.nrows()).for_each(|i| r[(i, 0)] += c64::new(re[(i, 0)], im[(i, 0)]));
        }
        let directions = &self.operator.interface.directions;
        for term in self.operator.interface.terms.iter().filter(|term| term.damping != 0.0) {
            let (to, from) = match side {
                Side::Right => (term.row, term.column),
                Side::Left => (term.column, term.row),
            };
            let force = directions[from].iter().map(|(row, v)| x[(row, 0)] * v).sum::<c64>() * term.damping;
            directions[to].iter().for_each(|(i, v)| r[(i, 0)] += force * v);
        }
        r
    }
}

fn transposed(a: &SparseMatrix) -> SparseMatrix {
    a.transpose().to_col_major().expect("indices are below the size")
}

/// Whether the interface is part of P_s.
fn assembles(operator: &Operator<'_>) -> bool {
    let interface = &operator.interface;
    let count = |d: usize| interface.directions[d].indices().len();
    let entries: usize = interface.terms.iter().map(|term| count(term.row) * count(term.column)).sum();
    let directions = interface.directions.len();
    directions > FEW_DIRECTIONS && entries <= operator.n() * directions
}

/// G, with the last `directions` rows of the interface, or with none.
fn small(operator: &Operator<'_>, shift: c64, directions: usize) -> Mat<c64> {
    let modal = operator.damping.modal.as_ref();
    let m = modal.map_or(0, |modal| modal.coefficients.len());
    let size = m + directions;
    let mut small = Mat::<c64>::zeros(size, size);
    for (i, c) in modal.iter().flat_map(|modal| modal.coefficients.iter().enumerate()) {
        small[(i, i)] = shift * *c;
    }
    for term in operator.interface.terms.iter().filter(|_| directions > 0) {
        small[(m + term.row, m + term.column)] += c64::new(term.stiffness, 0.0) + shift * term.damping;
    }
    small
}

impl ShiftedQuadratic for Shifted<'_> {
    fn n(&self) -> usize {
        self.operator.n()
    }

    fn solve(&self, x: Mat<c64>, y: Mat<c64>) -> Mat<c64> {
        self.invert(self.slope(Side::Right, &x, y))
    }
}

/// The problem of the left vectors, Q(μ̄)ᴴ ψ = 0 with μ = λ̄, at the shift σ̄.
pub(crate) struct Adjoint<'s, 'a>(pub(crate) &'s Shifted<'a>);

impl ShiftedQuadratic for Adjoint<'_, '_> {
    fn n(&self) -> usize {
        self.0.operator.n()
    }

    fn solve(&self, x: Mat<c64>, y: Mat<c64>) -> Mat<c64> {
        let woodbury = self.0.left.as_ref().expect("two-sided");
        self.0.solve_with(Side::Left, woodbury, self.0.slope(Side::Left, &x, y))
    }
}
