//! Eigenvalue problems of distributed matrices by SLEPc.

use super::{DistributedFactor, DistributedMatrix, World, alone, check, ffi};
use std::ffi::c_int;
use stridor_base::error::{Error, Result};
use stridor_linalg::c64;

/// The eigenpairs nearest `shift` of K x = θ M x by Krylov–Schur with the factors of K − shift M; collective.
#[derive(Debug)]
pub struct KrylovSchur<'a> {
    /// K and M.
    pub pencil: [&'a DistributedMatrix; 2],
    /// L B Lᵀ = K − shift M.
    pub factor: &'a mut DistributedFactor,
    /// On rank 0, the row of the factors that is row k of the matrices; empty on others.
    pub order: &'a [c_int],
    /// σ.
    pub shift: f64,
}

impl KrylovSchur<'_> {
    /// `count` of them, nearest first: θ on every rank, x (n × count, column after column, xᵀMx = 1) on rank 0.
    ///
    /// # Errors
    /// They do not converge to ‖A x − ν x‖ ≤ `tolerance` |ν|.
    pub fn solve(self, world: &World, count: usize, tolerance: f64) -> Result<(Vec<f64>, Vec<f64>)> {
        let [k, m] = self.pencil;
        assert!(self.factor.n() == m.n() && k.n() == m.n(), "matrices of one order");
        let held = if world.rank() == 0 { m.n() } else { 0 };
        assert!(self.order.len() == held, "the order of the rows on rank 0");
        let (mut values, mut vectors) = (vec![0.0; count], vec![0.0; held * count]);
        let mut found = 0;
        let _alone = alone();
        // SAFETY: the objects live; the arrays have the lengths that the function writes to, `order` has one number a row on rank 0
        // and is not read elsewhere.
        let code = unsafe {
            ffi::stridor_krylov_schur(
                k.matrix.as_ptr(),
                m.matrix.as_ptr(),
                self.factor.as_ptr(),
                self.order.as_ptr(),
                self.shift,
                count as c_int,
                tolerance,
                &mut found,
                values.as_mut_ptr(),
                vectors.as_mut_ptr(),
            )
        };
        check("real modes by Krylov-Schur of SLEPc", code)?;
        all_of(count, found, "Krylov-Schur of SLEPc")?;
        Ok((values, vectors))
    }
}

/// (λ² M + λ (C + B diag(c) Bᵀ) + K) x = 0.
#[derive(Debug)]
pub struct Quadratic {
    /// K, C and M.
    pub matrices: [DistributedMatrix; 3],
    /// The own rows of B, column after column.
    pub basis: Vec<f64>,
    /// c.
    pub coefficients: Vec<f64>,
}

impl Quadratic {
    /// `count` eigenvalues nearest `shift`, nearest first, by TOAR, with MUMPS for the sparse part of Q(shift); collective.
    ///
    /// # Errors
    /// They do not converge to a relative residual of `tolerance`; MUMPS refuses.
    pub fn nearest(&self, _: &World, shift: c64, count: usize, tolerance: f64) -> Result<Vec<c64>> {
        let Quadratic { matrices: [k, c, m], basis, coefficients } = self;
        let rank = coefficients.len();
        assert!(basis.len() == m.own() * rank, "the own rows of the basis");
        let (mut values, mut found) = (vec![0.0; 2 * count], 0);
        let _alone = alone();
        // SAFETY: the objects live; the arrays have the lengths that the function reads and writes.
        let code = unsafe {
            ffi::stridor_toar(
                k.matrix.as_ptr(),
                c.matrix.as_ptr(),
                m.matrix.as_ptr(),
                basis.as_ptr(),
                coefficients.as_ptr(),
                rank as c_int,
                shift.re,
                shift.im,
                count as c_int,
                tolerance,
                &mut found,
                values.as_mut_ptr(),
            )
        };
        check("complex eigenvalues by TOAR of SLEPc", code)?;
        all_of(count, found, "TOAR of SLEPc")?;
        Ok(values.chunks_exact(2).map(|pair| c64::new(pair[0], pair[1])).collect())
    }
}

/// That all have converged.
fn all_of(count: usize, found: c_int, method: &str) -> Result<()> {
    if found as usize >= count {
        return Ok(());
    }
    Err(Error::analysis(
        method,
        format!("{found} of {count} eigenvalues converged"),
        "Ask for fewer modes or a lower frequency",
    ))
}
