//! Matrices with known eigenvalues, and random ones: membranes, plates.

use super::SparseMatrix;
use super::random::Random;
use super::sparse::entry;
use faer::{Mat, MatRef};

/// The entries of `a` that are not zero.
pub fn from_dense(a: MatRef<'_, f64>) -> SparseMatrix {
    let entries: Vec<_> = (0..a.ncols())
        .flat_map(|j| (0..a.nrows()).map(move |i| (i, j)))
        .filter(|p| a[*p] != 0.0)
        .map(|(i, j)| entry(i, j, a[(i, j)]))
        .collect();
    SparseMatrix::try_new_from_triplets(a.nrows(), a.ncols(), &entries).unwrap()
}

/// Symmetric with about one entry in five, indefinite.
pub fn random_symmetric(n: usize, seed: u64) -> SparseMatrix {
    let mut random = Random::seeded(seed);
    let mut a = Mat::zeros(n, n);
    for j in 0..n {
        for i in 0..=j {
            let keep = random.next() > 0.6 || i == j;
            let value = random.next();
            a[(i, j)] = if keep { random.perturbed(value) } else { 0.0 };
            a[(j, i)] = a[(i, j)];
        }
    }
    from_dense(a.as_ref())
}

/// G Gᵀ + I/10 for a random G: symmetric positive definite.
pub fn random_definite(n: usize, seed: u64) -> SparseMatrix {
    let mut random = Random::seeded(seed);
    let g = Mat::from_fn(n, n, |_, _| random.next());
    from_dense((&g * g.transpose() + Mat::<f64>::identity(n, n) * faer::Scale(0.1)).as_ref())
}

/// Square membrane of m × m inner nodes with a fixed edge, five-point stencil, unit spacing, M = I.
/// Eigenvalues 4 sin²(iπ/2(m+1)) + 4 sin²(jπ/2(m+1)): double for i ≠ j.
pub fn membrane(m: usize) -> (SparseMatrix, SparseMatrix) {
    let n = m * m;
    let mut k = Vec::new();
    for i in 0..m {
        for j in 0..m {
            let p = i * m + j;
            k.push(entry(p, p, 4.0));
            if i + 1 < m {
                k.extend([entry(p, p + m, -1.0), entry(p + m, p, -1.0)]);
            }
            if j + 1 < m {
                k.extend([entry(p, p + 1, -1.0), entry(p + 1, p, -1.0)]);
            }
        }
    }
    (SparseMatrix::try_new_from_triplets(n, n, &k).unwrap(), identity(n))
}

/// The eigenvalues of [`membrane`], ascending.
pub fn membrane_eigenvalues(m: usize) -> Vec<f64> {
    let s = |i: usize| 4.0 * (i as f64 * std::f64::consts::PI / (2 * (m + 1)) as f64).sin().powi(2);
    let mut values: Vec<f64> = (1..=m).flat_map(|i| (1..=m).map(move |j| s(i) + s(j))).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// A free chain of n unit masses and unit springs: eigenvalues 4 sin²(jπ/2n), j = 0 … n−1.
pub fn free_chain(n: usize) -> (SparseMatrix, SparseMatrix) {
    let mut k = Vec::new();
    for p in 0..n - 1 {
        k.extend([entry(p, p, 1.0), entry(p + 1, p + 1, 1.0)]);
        k.extend([entry(p, p + 1, -1.0), entry(p + 1, p, -1.0)]);
    }
    (SparseMatrix::try_new_from_triplets(n, n, &k).unwrap(), identity(n))
}

/// I of order n.
pub fn identity(n: usize) -> SparseMatrix {
    super::sparse::diagonal_matrix(&vec![1.0; n])
}

/// Free square steel plate, 0.15 m × 0.15 m × 1 mm, m × m rectangular bending elements (twelve-term polynomial of
/// Adini and Clough) with (w, w_x, w_y) at each node and consistent mass; `clamped` holds the edge.
pub fn plate(m: usize, clamped: bool) -> (SparseMatrix, SparseMatrix) {
    let (e, nu, rho, side, t) = (210e9, 0.3, 7850.0, 0.15, 1e-3);
    let h: f64 = side / m as f64;
    let d = e * t * t * t / (12.0 * (1.0 - nu * nu));
    const POWERS: [(i32, i32); 12] =
        [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3), (3, 1), (1, 3)];
    // Derivative of order (a, b) of x^p y^q.
    let term = |p: i32, q: i32, a: i32, b: i32, x: f64, y: f64| {
        let one = |p: i32, a: i32, x: f64| match a {
            0 => x.powi(p),
            1 if p >= 1 => p as f64 * x.powi(p - 1),
            2 if p >= 2 => (p * (p - 1)) as f64 * x.powi(p - 2),
            _ => 0.0,
        };
        one(p, a, x) * one(q, b, y)
    };
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let mut c = Mat::zeros(12, 12);
    for (node, (x, y)) in corners.iter().enumerate() {
        for (col, (p, q)) in POWERS.iter().enumerate() {
            c[(3 * node, col)] = term(*p, *q, 0, 0, *x, *y);
            c[(3 * node + 1, col)] = term(*p, *q, 1, 0, *x, *y) / h;
            c[(3 * node + 2, col)] = term(*p, *q, 0, 1, *x, *y) / h;
        }
    }
    let inverse = {
        use faer::prelude::*;
        c.partial_piv_lu().solve(Mat::<f64>::identity(12, 12))
    };
    let (mut ke, mut me) = (Mat::<f64>::zeros(12, 12), Mat::<f64>::zeros(12, 12));
    let gauss = [
        (-0.861136311594053, 0.347854845137454),
        (-0.339981043584856, 0.652145154862546),
        (0.339981043584856, 0.652145154862546),
        (0.861136311594053, 0.347854845137454),
    ];
    for (gx, wx) in gauss {
        for (gy, wy) in gauss {
            let (x, y) = (0.5 + 0.5 * gx, 0.5 + 0.5 * gy);
            let weight = 0.25 * wx * wy * h * h;
            let row = |a, b| -> Vec<f64> { POWERS.iter().map(|(p, q)| term(*p, *q, a, b, x, y)).collect() };
            let (w, xx, yy, xy) = (row(0, 0), row(2, 0), row(0, 2), row(1, 1));
            for i in 0..12 {
                for j in 0..12 {
                    me[(i, j)] += weight * rho * t * w[i] * w[j];
                    let bending = xx[i] * (xx[j] + nu * yy[j]) + yy[i] * (yy[j] + nu * xx[j]);
                    ke[(i, j)] += weight * d * (bending + 2.0 * (1.0 - nu) * xy[i] * xy[j]) / h.powi(4);
                }
            }
        }
    }
    let ke = inverse.transpose() * ke * &inverse;
    let me = inverse.transpose() * me * &inverse;
    let n = m + 1;
    let inner = if clamped { n - 2 } else { n };
    let index = |i: usize, j: usize| {
        if !clamped {
            Some(i * n + j)
        } else if i == 0 || j == 0 || i == m || j == m {
            None
        } else {
            Some((i - 1) * inner + j - 1)
        }
    };
    let (mut k, mut mass) = (Vec::new(), Vec::new());
    for i in 0..m {
        for j in 0..m {
            let nodes = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
            for p in 0..12 {
                for q in 0..12 {
                    if let (Some(a), Some(b)) = (nodes[p / 3], nodes[q / 3]) {
                        let (row, col) = (3 * a + p % 3, 3 * b + q % 3);
                        k.push(entry(row, col, 0.5 * (ke[(p, q)] + ke[(q, p)])));
                        mass.push(entry(row, col, 0.5 * (me[(p, q)] + me[(q, p)])));
                    }
                }
            }
        }
    }
    let n = 3 * inner * inner;
    (
        SparseMatrix::try_new_from_triplets(n, n, &k).unwrap(),
        SparseMatrix::try_new_from_triplets(n, n, &mass).unwrap(),
    )
}
