//! Small tools of the tests: steel, rigid motions, structured meshes, dense oracles.
#![allow(dead_code)]

#[path = "../../src/job/samples.rs"]
pub mod samples;

use faer::Mat;
use faer::linalg::solvers::Solve;
use stridor::linalg::SparseMatrix;
use stridor::mesh::generate::structured_box;
use stridor::mesh::{CellKind, Mesh};
use stridor::structure::{Material, RayleighDamping};

/// E = 210 GPa, ν = 0.3, ρ = 7850 kg/m³.
pub fn steel() -> Material {
    Material {
        youngs_modulus: 210e9,
        poissons_ratio: 0.3,
        density: 7850.0,
        loss_factor: 0.0,
        rayleigh: RayleighDamping::default(),
        orthotropic: None,
    }
}

/// A box named `name` at a place, of a size [m] and as many cells; its faces are `name`, `between` and `x_min`, `x_max` and so on.
pub fn named_box(
    name: &str,
    between: &str,
    (kind, size, cells): (CellKind, [f64; 3], [usize; 3]),
    at: [f64; 3],
) -> Mesh {
    let mut mesh = structured_box(kind, size, cells).unwrap();
    mesh.nodes.iter_mut().for_each(|x| (0..3).for_each(|k| x[k] += at[k]));
    for region in &mut mesh.regions {
        region.name =
            if region.dimension == 3 { name.into() } else { format!("{name}{between}{}", region.name) };
    }
    mesh
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

/// The `count` lowest natural frequencies \[Hz\] by subspace iteration on K + s M, s = (2π shift_hz)², with
/// Rayleigh–Ritz until the wanted ones stand still to 1e-8.
pub fn lowest_frequencies(structure: &stridor::system::Structure, count: usize, shift_hz: f64) -> Vec<f64> {
    let tau = std::f64::consts::TAU;
    let s = (tau * shift_hz).powi(2);
    let (k, m) = (&*structure.stiffness, &*structure.mass);
    let shifted = {
        let mut sum = k.clone();
        for (a, b) in sum.val_mut().iter_mut().zip(m.val()) {
            *a += s * b;
        }
        sum
    };
    let factor = shifted.sp_cholesky(faer::Side::Lower).unwrap();
    let n = structure.n_dofs();
    let width = (2 * count).max(count + 8).min(n);
    // A fixed pseudo-random start.
    let mut seed = 1_u64;
    let mut x = Mat::from_fn(n, width, |_, _| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    });
    let mut last: Vec<f64> = vec![0.0; count];
    for _ in 0..60 {
        let y = factor.solve(m * &x);
        let (a, b) = (y.transpose() * (&shifted * &y), y.transpose() * (m * &y));
        let l = b.llt(faer::Side::Lower).unwrap().L().to_owned();
        let mut half = a.clone();
        l.solve_lower_triangular_in_place(half.as_mut());
        let mut c = half.transpose().to_owned();
        l.solve_lower_triangular_in_place(c.as_mut());
        let c = Mat::from_fn(width, width, |i, j| 0.5 * (c[(i, j)] + c[(j, i)]));
        let eigen = c.self_adjoint_eigen(faer::Side::Lower).unwrap();
        let mut v = eigen.U().to_owned();
        l.transpose().solve_upper_triangular_in_place(v.as_mut());
        x = &y * v;
        let values: Vec<f64> = (0..count).map(|i| eigen.S()[i]).collect();
        let still = values.iter().zip(&last).all(|(v, w)| (v - w).abs() <= 1e-8 * v.abs().max(s));
        last = values;
        if still {
            break;
        }
    }
    last.iter().map(|v| (v - s).max(0.0).sqrt() / tau).collect()
}
