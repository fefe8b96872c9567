//! What the analyses are made of, timed on square plates of two sizes in one run: assembly, factorisation, solution, real
//! modes; and the assembly of a solid. `cargo bench --bench kernels [-- --threads N]`.
//!
//! Factorisations are given as ratios to the LLᵀ of faer on the same matrix, and growth with the size as an exponent.

use faer::sparse::SparseColMat;
use faer::{Mat, Side};
use std::error::Error;
use std::time::Instant;
use stridor::linalg::c64;
use stridor::linalg::eigenpairs::{Wanted, lowest_eigenpairs};
use stridor::linalg::factor::SymbolicFactor;
use stridor::linalg::sparse::add_scaled;
use stridor::linalg::unsymmetric::spectrum;
use stridor::mesh::generate::structured_box;
use stridor::mesh::{Cell, CellKind};
use stridor::structure::{Material, Model, Part, RayleighDamping, Shell, Solid, assemble};

/// Seconds of `work`, and what it gives.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let started = Instant::now();
    let value = work();
    (started.elapsed().as_secs_f64(), value)
}

fn steel() -> Material {
    Material {
        youngs_modulus: 2.1e11,
        poissons_ratio: 0.3,
        density: 7850.0,
        loss_factor: 0.0,
        rayleigh: RayleighDamping::default(),
        orthotropic: None,
    }
}

/// A free square plate of n × n × 2 triangles, 1 m wide and 10 mm thick, in bending.
fn plate(n: usize) -> Model {
    let at = |i: usize| i as f64 / n as f64;
    let id = |i: usize, j: usize| i * (n + 1) + j;
    let nodes = (0..=n).flat_map(|i| (0..=n).map(move |j| [at(i), at(j), 0.0])).collect();
    let cell = |i: usize, j: usize| {
        [
            Cell::triangle([id(i, j), id(i + 1, j), id(i + 1, j + 1)]),
            Cell::triangle([id(i, j), id(i + 1, j + 1), id(i, j + 1)]),
        ]
    };
    let faces = (0..n).flat_map(|i| (0..n).flat_map(move |j| cell(i, j))).collect();
    let part = Part::new(
        "plate",
        faces,
        Shell { bending_only: true, rotary_inertia: false, ..Shell::new(steel(), 0.01) },
    );
    Model { nodes, parts: vec![part], ..Model::default() }
}

/// Prints how fast a box of 10-node tetrahedra is assembled.
fn measure_solids() -> Result<(), Box<dyn Error>> {
    let mesh = structured_box(CellKind::Tetrahedron10, [0.3, 0.2, 0.1], [36, 24, 12])?;
    let cells: Vec<Cell> = mesh.elements.iter().filter(|cell| cell.dimension() == 3).cloned().collect();
    let count = cells.len() as f64;
    let part = Part::new("box", cells, Solid::new(steel()));
    let model = Model { nodes: mesh.nodes, parts: vec![part], ..Model::default() };
    let (time, assembled) = timed(|| assemble(&model));
    let n = assembled?.structure.n_dofs();
    let rate = 60e-6 * count / (time * rayon::current_num_threads() as f64);
    println!(
        "\n{count} tetrahedra of 10 nodes, {n} degrees of freedom: M and K in {time:.2} s, {rate:.2} million a minute and thread"
    );
    Ok(())
}

/// Prints the times of one size; the seconds of the real modes and the degrees of freedom.
fn measure(n: usize) -> Result<(f64, f64), Box<dyn Error>> {
    let model = plate(n);
    let (assembly, assembled) = timed(|| assemble(&model));
    let assembled = assembled?;
    let (k, m) = (&assembled.structure.stiffness, &assembled.structure.mass);
    println!(
        "\n{} degrees of freedom, {} entries of K: assembly {assembly:.3} s",
        k.nrows(),
        k.compute_nnz()
    );
    // Below the first elastic mode K is positive definite but for the rigid bodies, which the shift takes away.
    let shifted = |w: f64| add_scaled(&[(1.0, k), (-w, m)]);
    let definite = shifted(-1e4);
    let (reference, llt) = timed(|| definite.sp_cholesky(Side::Lower));
    llt.map_err(|e| format!("{e:?}"))?;
    println!("  LLᵀ of faer, analysis included                {reference:.3} s");
    let (analysis, symbolic) = timed(|| SymbolicFactor::new(definite.symbolic()));
    let symbolic = symbolic?;
    println!(
        "  analysis of the pattern                       {analysis:.3} s, {:.1} M entries of L",
        symbolic.fill() as f64 / 1e6
    );
    let indefinite = shifted((2.0 * std::f64::consts::PI * 500.0_f64).powi(2));
    let values = indefinite.val().iter().map(|v| c64::new(*v, 0.01 * v)).collect();
    let complex = SparseColMat::new(indefinite.symbolic().to_owned()?, values);
    let (real_time, real) = timed(|| symbolic.factorize(&indefinite));
    let (complex_time, lossy) = timed(|| symbolic.factorize_here(&complex));
    let (real, lossy) = (real?, lossy?);
    let ratio = |t: f64| t / reference;
    println!(
        "  real LBLᵀ                                     {real_time:.3} s, {:.2} × faer, {} MiB",
        ratio(real_time),
        real.memory_bytes() >> 20
    );
    println!(
        "  complex LBLᵀ                                  {complex_time:.3} s, {:.2} × faer, {} MiB",
        ratio(complex_time),
        lossy.memory_bytes() >> 20
    );
    let mut one = 0.0;
    for columns in [1, 8, 32] {
        let mut x = Mat::from_fn(k.nrows(), columns, |i, j| ((3 * i + j) as f64).sin());
        let (time, ()) = timed(|| real.solve_in_place(x.as_mut()));
        if columns == 1 {
            one = time;
        }
        println!(
            "  solution, {columns:>2} right-hand sides                 {time:.4} s, {:.2} × one a side",
            time / columns as f64 / one
        );
    }
    let (modes, pairs) = timed(|| lowest_eigenpairs(k, m, Wanted::Count(50), &()));
    let pairs = pairs?;
    let worst = pairs.backward_errors.iter().fold(0.0f64, |w, e| w.max(*e));
    println!("  50 lowest real modes                          {modes:.2} s, backward error {worst:.1e}");
    Ok((modes, k.nrows() as f64))
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let threads = arguments.iter().position(|a| a == "--threads").and_then(|i| arguments.get(i + 1));
    if let Some(threads) = threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads.parse()?).build_global()?;
    }
    let (small, large) = (measure(81)?, measure(257)?);
    let exponent = (large.0 / small.0).ln() / (large.1 / small.1).ln();
    measure_solids()?;
    println!("\nTime of the real modes grows like (degrees of freedom)^{exponent:.2}");
    println!("\nDense eigenvalues with left and right vectors");
    for n in [100, 200, 400] {
        let a = Mat::from_fn(n, n, |i, j| ((7 * i + 13 * j + i * j) as f64).sin());
        let (time, found) = timed(|| spectrum(a.as_ref()));
        found?;
        println!("  order {n}: {:.1} ms", 1e3 * time);
    }
    Ok(())
}
