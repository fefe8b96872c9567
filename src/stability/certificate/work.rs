//! How many floating-point operations and how much memory a count of the unstable modes takes, worked out beforehand.

/// Sizes that a count depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CountSize {
    /// Degrees of freedom.
    pub dofs: f64,
    /// Entries of a factor of K.
    pub fill: f64,
    /// Multiplications of a factorisation.
    pub multiplications: f64,
    /// Real modes in the basis of the analysis.
    pub real_modes: f64,
    /// Vectors of that basis.
    pub basis: f64,
    /// Directions in which the interface acts.
    pub directions: f64,
}

/// Vectors that a narrow basis has besides the real modes, for each of these: 1.4 and 1.7 were counted.
const ADDED: f64 = 2.0;
/// Vectors of the basis of an analysis whose contact has many directions, for each of the real modes: 6.9 and 8.1 were counted.
const BASIS: f64 = 8.0;
/// Directions up to which the whole basis costs little and proves at least as much.
const FEW_DIRECTIONS: f64 = 300.0;
/// Factorisations of a count: of M, of the damping, and two or so for the fastest growth.
const FACTORISATIONS: f64 = 4.0;
/// Factorisations of an analysis: steady sliding, real modes and their counts, of the open and of the closed structure.
const FACTORISATIONS_OF_ANALYSIS: f64 = 6.0;
/// The part of the operations of the analysis that a count takes at most unless it is requested.
pub(super) const SHARE: f64 = 1.0;
/// Refinements of an analysis as a rule.
const REFINEMENTS: usize = 2;
/// Operations a second on one core, on an AVX-512 machine of 2026.
const SPEED: f64 = 3e10;

impl CountSize {
    /// Those expected of an analysis before it runs.
    pub fn expected(
        dofs: usize,
        fill: usize,
        multiplications: f64,
        real_modes: f64,
        directions: f64,
    ) -> Self {
        let many = directions > real_modes;
        let basis = if many { BASIS * real_modes } else { real_modes + directions };
        let dofs = dofs as f64;
        CountSize { dofs, fill: fill as f64, multiplications, real_modes, basis: basis.min(dofs), directions }
    }

    /// Whether the count is that of a narrow basis.
    pub(super) fn is_narrow(&self) -> bool {
        self.directions > self.real_modes.max(FEW_DIRECTIONS)
    }

    /// Vectors of the basis that is counted in, besides the real modes.
    fn added(&self) -> f64 {
        let all = (self.basis - self.real_modes).max(0.0);
        if self.is_narrow() { all.min(ADDED * self.real_modes) } else { all }
    }

    /// Columns of the forces whose compliances bound what a basis with so many vectors besides the real modes leaves out.
    fn columns(&self, added: f64) -> f64 {
        let m = self.real_modes + added;
        added + m + self.directions.min(3.0 * m)
    }

    /// Floating-point operations from the spectrum.
    pub fn operations(&self) -> f64 {
        let first = if self.is_narrow() { dense(self.basis) } else { 0.0 };
        first + self.operations_with(self.added())
    }

    /// Those in the whole basis.
    pub(super) fn operations_in_whole_basis(&self) -> f64 {
        self.operations_with(self.basis - self.real_modes)
    }

    /// Half a solution and the products with all others for each column, and the factorisations that count, besides the dense problem.
    fn operations_with(&self, added: f64) -> f64 {
        let f = self.columns(added);
        let columns = f * (2.0 * self.fill + self.dofs * (2.0 * self.real_modes + f));
        let factors = 2.0 * FACTORISATIONS * self.multiplications;
        dense(self.real_modes + added) + columns + 9.0 * f.powi(3) + factors
    }

    /// About the floating-point operations of the whole analysis: factors, a solution and as many products for each vector, the dense
    /// problem of the basis once and after each of `refinements`, 25 (2m)³ with vectors (G. H. Golub & C. F. Van Loan, Matrix
    /// Computations, QR algorithm).
    pub(super) fn operations_of_analysis(&self, refinements: usize) -> f64 {
        let dense = 25.0 * (2.0 * self.basis).powi(3) * (refinements + 1) as f64;
        dense
            + 2.0 * FACTORISATIONS_OF_ANALYSIS * self.multiplications
            + 4.0 * self.fill * (self.basis + 4.0 * self.real_modes)
    }

    /// Whether the count takes no more operations than the analysis: then it is made unless the case says otherwise.
    pub fn within_the_analysis(&self) -> bool {
        self.operations() <= SHARE * self.operations_of_analysis(REFINEMENTS)
    }

    /// Seconds on one core.
    pub fn seconds(&self) -> f64 {
        self.operations() / SPEED
    }

    /// Bytes of the forces and of their half solutions, beside the vectors of the basis.
    pub fn bytes(&self) -> f64 {
        8.0 * self.dofs * (2.0 * self.columns(self.added()) + self.added())
    }
}

/// Of a reduced model in `m` vectors: its eigenvectors, their inverse and the check.
pub(super) fn dense(m: f64) -> f64 {
    60.0 * (2.0 * m).powi(3)
}
