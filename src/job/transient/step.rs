//! Time steps that no computer can take.

use crate::error::{Error, Fault, Result};
use crate::linalg::SparseMatrix;
use crate::system::Structure;

/// Refuses a time step Δt \[s\] at which K is lost in the rounding of M/Δt², or M/Δt² is beyond the largest number.
///
/// # Errors
/// The shortest step, Δt² = ε max|M|/max|K|.
pub fn check_step(structure: &Structure, step: f64) -> Result<()> {
    let largest =
        |matrix: &SparseMatrix| matrix.val().iter().fold(0.0, |largest: f64, v| largest.max(v.abs()));
    let (mass, stiffness) = (largest(&structure.mass), largest(&structure.stiffness));
    let shortest = (f64::EPSILON * mass / stiffness).sqrt();
    if stiffness == 0.0 || step >= shortest {
        return Ok(());
    }
    let found = format!("{step:e} s, so short that the stiffness is lost in the rounding of M/Δt²");
    let expected = format!("at least {shortest:.1e} s for this mass and stiffness");
    let help =
        "A twentieth of the period of the highest frequency of interest is short enough; check the unit";
    Err(Error::input(Fault::new("`transient.time_step`", found, expected).with_help(help)))
}
