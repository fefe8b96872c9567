//! Real modes by shift-invert Lanczos, with the Sturm count that proves none is missing.

use super::{RealModes, SturmCertificate};
use crate::error::Result;
use crate::linalg::{self, lowest_eigenpairs};
use crate::progress::Observer;
use crate::system::Structure;
use std::f64::consts::TAU;

/// Which modes are wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wanted {
    /// All below this frequency \[Hz\].
    BelowHz(f64),
    /// This many of the lowest.
    Count(usize),
}

/// Real modes of `structure`: K φ = ω² M φ, damping left out.
///
/// # Errors
/// Those of [`lowest_eigenpairs`].
pub fn compute(structure: &Structure, wanted: Wanted, observer: &dyn Observer) -> Result<RealModes> {
    let wanted = match wanted {
        Wanted::BelowHz(hz) => linalg::Wanted::Below((TAU * hz).powi(2)),
        Wanted::Count(count) => linalg::Wanted::Count(count),
    };
    let pairs = lowest_eigenpairs(&structure.stiffness, &structure.mass, wanted, observer)?;
    let hz = |theta: f64| theta.max(0.0).sqrt() / TAU;
    let first_elastic =
        pairs.values.iter().copied().find(|v| *v > 1e-6 * pairs.values.last().copied().unwrap_or(0.0));
    let rigid_bodies = pairs.values.iter().filter(|v| **v < 1e-6 * first_elastic.unwrap_or(0.0)).count();
    Ok(RealModes {
        rigid_bodies,
        certificate: SturmCertificate {
            below_hz: hz(pairs.sturm.bound),
            shifts_hz: pairs.sturm.shifts.map(hz),
            counted: pairs.sturm.counted,
            found: pairs.values.len(),
        },
        eigenvalues: pairs.values,
        shapes: pairs.vectors,
        backward_errors: pairs.backward_errors,
    })
}

/// temp
pub fn effective_mass(s: &Structure, shapes: faer::MatRef<'_, f64>, dirs: &[Vec<f64>; 3]) -> Vec<[f64; 3]> {
    (0..shapes.ncols())
        .map(|k| {
            let c: Vec<f64> = shapes.col(k).iter().copied().collect();
            let m = linalg::sparse::multiply_vector(&s.mass, &c);
            [0, 1, 2].map(|a| {
                let g: f64 = dirs[a].iter().zip(&m).map(|(x, y)| x * y).sum();
                g * g
            })
        })
        .collect()
}
/// temp
pub fn name_disc_mode(_p: &[[f64; 2]], _w: &[f64]) -> Option<super::DiscModeName> {
    None
}
