//! A clamped block of 8-node bricks whose top touches a moving belt, as matrices.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Elements along x, y and z, and the edge of each \[m\].
const ELEMENTS: [usize; 3] = [10, 8, 4];
const EDGE: f64 = 5e-3;

type Triplets = BTreeMap<(usize, usize), f64>;

/// The case of the block; its files are those of [`write`].
pub const CASE: &str = r#"
title = "A block of solid elements under a belt"
assumptions = ["Everything here is made up."]

[matrices]
mass = "m.mtx"
stiffness = "k.mtx"
damping = "c.mtx"

[modes.block]
below = "60 kHz"

[cea]
band = [0, "40 kHz"]
confirm = true
certify = true
"#;

/// Writes M, C and K of the block, K with the belt's normal stiffness and friction, and `case.toml`.
pub fn write(folder: &Path) {
    let [nx, ny, nz] = ELEMENTS;
    let node = |i: usize, j: usize, k: usize| (i * (ny + 1) + j) * (nz + 1) + k;
    // The face x = 0 is clamped: its nodes come first.
    let free = |node: usize, axis: usize| (3 * node + axis).checked_sub(3 * (ny + 1) * (nz + 1));
    let (stiffness, mass) = brick();
    let (mut k, mut m) = (Triplets::new(), Triplets::new());
    for (i, j, l) in (0..nx * ny * nz).map(|e| (e / (ny * nz), e / nz % ny, e % nz)) {
        let corners: Vec<usize> = (0..8).map(|c| node(i + (c & 1), j + (c >> 1 & 1), l + (c >> 2))).collect();
        let dofs: Vec<Option<usize>> =
            corners.iter().flat_map(|n| (0..3).map(|axis| free(*n, axis))).collect();
        for (a, row) in dofs.iter().enumerate() {
            for (b, column) in dofs.iter().enumerate() {
                if let (Some(row), Some(column)) = (row, column) {
                    *k.entry((*row, *column)).or_default() += stiffness[a][b];
                    if mass[a][b] != 0.0 {
                        *m.entry((*row, *column)).or_default() += mass[a][b];
                    }
                }
            }
        }
    }
    let c = k.iter().map(|(at, v)| (*at, 1e-9 * v)).collect();
    // A belt along y on some nodes of the top: K += k_n (n + μ t) nᵀ.
    for (i, j) in (0..9).map(|p| (nx - p % 3, 2 + p / 3)) {
        let [n, t] = [2, 1].map(|axis| free(node(i, j, nz), axis).expect("not clamped"));
        *k.entry((n, n)).or_default() += 2e7;
        *k.entry((t, n)).or_default() += 0.6 * 2e7;
    }
    let size = 3 * nx * (ny + 1) * (nz + 1);
    for (name, matrix) in [("m.mtx", &m), ("c.mtx", &c), ("k.mtx", &k)] {
        let mut text =
            format!("%%MatrixMarket matrix coordinate real general\n{size} {size} {}\n", matrix.len());
        for ((i, j), v) in matrix {
            writeln!(text, "{} {} {v:e}", i + 1, j + 1).expect("a string");
        }
        std::fs::write(folder.join(name), text).expect("a matrix");
    }
    std::fs::write(folder.join("case.toml"), CASE).expect("a case");
}

/// K and M of a cube of steel with linear shape functions, by 2 × 2 × 2 Gauss points (K. J. Bathe, Finite Element Procedures,
/// section 5.3).
fn brick() -> ([[f64; 24]; 24], [[f64; 24]; 24]) {
    let (young, poisson, density) = (210e9, 0.3, 7850.0);
    let lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let shear = young / (2.0 * (1.0 + poisson));
    let (mut stiffness, mut mass) = ([[0.0; 24]; 24], [[0.0; 24]; 24]);
    let volume = EDGE.powi(3) / 8.0;
    let sign = |corner: usize, axis: usize| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
    for point in 0..8 {
        let at = [0, 1, 2].map(|axis| sign(point, axis) / 3f64.sqrt());
        let along = |corner: usize, axis: usize| 0.5 * (1.0 + sign(corner, axis) * at[axis]);
        let shape = |corner: usize| (0..3).map(|axis| along(corner, axis)).product::<f64>();
        let slope = |corner: usize, of: usize| {
            let others: f64 = (0..3).filter(|axis| *axis != of).map(|axis| along(corner, axis)).product();
            sign(corner, of) / EDGE * others
        };
        for (a, b) in (0..64).map(|p| (p / 8, p % 8)) {
            let inner: f64 = (0..3).map(|d| slope(a, d) * slope(b, d)).sum();
            for (i, j) in (0..9).map(|p| (p / 3, p % 3)) {
                let same = if i == j { shear * inner } else { 0.0 };
                stiffness[3 * a + i][3 * b + j] +=
                    volume * (lame * slope(a, i) * slope(b, j) + shear * slope(a, j) * slope(b, i) + same);
            }
            for i in 0..3 {
                mass[3 * a + i][3 * b + i] += volume * density * shape(a) * shape(b);
            }
        }
    }
    (stiffness, mass)
}
