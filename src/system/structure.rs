//! M, C and K of the structure without its contacts.

use crate::error::Result;
use crate::linalg::{Engine, SparseMatrix, SparseVector};
use faer::Mat;
use std::fmt::Debug;
use std::sync::Arc;

/// M ü + C u̇ + K u: mass positive (semi-)definite, stiffness positive semi-definite but for what preload and rotation soften, all symmetric,
/// both triangles stored, M and K on the same sparsity pattern or not.
#[derive(Debug, Clone)]
pub struct Structure {
    /// M \[kg, kg m²\].
    pub mass: Arc<SparseMatrix>,
    /// K \[N/m, N m\].
    pub stiffness: Arc<SparseMatrix>,
    /// C and the loss factors.
    pub damping: Damping,
    /// Where its matrices are factorised.
    pub engine: Engine,
}

impl Structure {
    /// The number of degrees of freedom.
    pub fn n_dofs(&self) -> usize {
        self.mass.nrows()
    }
}

/// The ways a structure loses energy; those present add up.
#[derive(Debug, Clone, Default)]
pub struct Damping {
    /// Sparse viscous matrix: Rayleigh damping and dashpots \[N s/m\].
    pub viscous: Option<Arc<SparseMatrix>>,
    /// Modal damping ratios, of low rank.
    pub modal: Option<ModalDamping>,
    /// Loss factors: the imaginary part of K(1 + iη) \[N/m\]; valid for harmonic motion (eigenvalues, FRF) only.
    pub hysteretic: Option<Arc<SparseMatrix>>,
}

/// C = B diag(c) Bᵀ with B = M Φ and c = 2 ζ ω: each real mode has its own damping ratio ζ.
#[derive(Debug, Clone)]
pub struct ModalDamping {
    /// B = M Φ, n × m, for mass-normalised modes Φ.
    pub basis: Mat<f64>,
    /// 2 ζ ω of each mode \[1/s\].
    pub coefficients: Vec<f64>,
}

/// A structure that can give its geometric stiffness K_σ under a static displacement.
///
/// K_σ is affine in the load. The implementation holds elements and thicknesses; the analyses only add the matrix.
pub trait Prestress: Debug + Send + Sync {
    /// K_σ(u₀) \[N/m, N m\] on the degrees of freedom of the system, symmetric, both triangles stored.
    fn geometric_stiffness(&self, displacement: &[f64]) -> Result<SparseMatrix>;
}

/// The part of imported matrices, or of a rotating structure, that is not symmetric, constant: K gains W k Wᵀ, C gains W c Wᵀ, of low rank r, and where the
/// rank is high both gain sparse skew-symmetric matrices.
#[derive(Debug, Clone)]
pub struct Coupling {
    /// The columns of W, r of them.
    pub directions: Vec<SparseVector>,
    /// k \[N/m\], r × r.
    pub stiffness: Mat<f64>,
    /// c \[N s/m\], r × r.
    pub damping: Mat<f64>,
    /// The part of high rank.
    pub skew: Option<Skew>,
}

/// Sparse skew-symmetric parts of K and C, both triangles stored: gyroscopic terms (C), circulatory ones (K).
#[derive(Debug, Clone)]
pub struct Skew {
    /// Of K \[N/m\].
    pub stiffness: Arc<SparseMatrix>,
    /// Of C \[N s/m\].
    pub damping: Arc<SparseMatrix>,
}
