//! Small tools of the tests: steel, rigid motions, structured meshes, dense oracles.
#![allow(dead_code)]

use faer::Mat;
use faer::linalg::solvers::Solve;
use stridor::linalg::SparseMatrix;
use stridor::structure::{Material, RayleighDamping};

/// E = 210 GPa, ν = 0.3, ρ = 7850 kg/m³.
pub fn steel() -> Material {
    Material {
        youngs_modulus: 210e9,
        poissons_ratio: 0.3,
        density: 7850.0,
        loss_factor: 0.0,
        rayleigh: RayleighDamping::default(),
    }
}

/// Unit translation (0, 1, 2) or rotation about an axis through the origin (3, 4, 5), six values a node.
pub fn rigid_motion(nodes: &[[f64; 3]], motion: usize) -> Vec<f64> {
    let mut all = Vec::new();
    for [x, y, z] in nodes {
        let mut u = [0.0; 6];
        u[motion] = 1.0;
        match motion {
            3 => (u[1], u[2]) = (-z, *y),
            4 => (u[0], u[2]) = (*z, -x),
            5 => (u[0], u[1]) = (-y, *x),
            _ => {}
        }
        all.extend(u);
    }
    all
}

/// K⁻¹ f.
pub fn solve(k: &SparseMatrix, f: &[f64]) -> Vec<f64> {
    let rhs = Mat::from_fn(f.len(), 1, |i, _| f[i]);
    let x = k.sp_cholesky(faer::Side::Lower).unwrap().solve(&rhs);
    (0..f.len()).map(|i| x[(i, 0)]).collect()
}

/// The smallest p > 0 with det(K + p K_σ) = 0, by dense algebra: −K_σ φ = (1/p) K φ.
pub fn smallest_buckling_load(k: &SparseMatrix, k_sigma: &SparseMatrix) -> f64 {
    let values = generalized_eigenvalues(&(-k_sigma.to_dense()), &k.to_dense());
    1.0 / values[values.len() - 1]
}

/// Eigenvalues of A φ = λ B φ, ascending, dense, B positive definite.
pub fn generalized_eigenvalues(a: &Mat<f64>, b: &Mat<f64>) -> Vec<f64> {
    let l = b.llt(faer::Side::Lower).unwrap().L().to_owned();
    let half = {
        let mut x = a.clone();
        l.solve_lower_triangular_in_place(x.as_mut());
        let mut y = x.transpose().to_owned();
        l.solve_lower_triangular_in_place(y.as_mut());
        y
    };
    let symmetric = Mat::from_fn(half.nrows(), half.ncols(), |i, j| 0.5 * (half[(i, j)] + half[(j, i)]));
    symmetric.self_adjoint_eigenvalues(faer::Side::Lower).unwrap()
}
