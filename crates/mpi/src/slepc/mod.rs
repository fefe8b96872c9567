//! PETSc, SLEPc and MUMPS over MPI, as far as the distributed engine needs them: a thin wrapper, and the only place of the crate
//! that calls foreign functions of theirs.
//!
//! * [`World`]: the ranks of the program, and messages between them.
//! * [`DistributedFactor`]: A = L B Lᵀ of a real symmetric matrix by MUMPS, with its inertia. A complex PETSc has no inertia, and
//!   real arithmetic takes a quarter of the operations.
//! * [`DistributedMatrix`]: a sparse matrix of PETSc.
//! * [`KrylovSchur`], [`Quadratic`]: eigenvalue problems by SLEPc.
//!
//! The C files hold what only the headers of the machine know. An error code becomes an [`Error`] with the text of
//! the library. All functions that say *collective* must be called by all ranks in the same order.

mod eigen;
mod ffi;
mod matrix;
mod mumps;
mod world;

pub use eigen::{KrylovSchur, Quadratic};
pub use matrix::{DistributedMatrix, Rows};
pub use mumps::{DistributedFactor, Entries};
pub use world::World;

use std::ffi::{CStr, c_int};
use std::sync::{Mutex, MutexGuard};
use stridor_base::error::Error;

/// MPI is started for calls of one thread at a time.
fn alone() -> MutexGuard<'static, ()> {
    static CALLS: Mutex<()> = Mutex::new(());
    CALLS.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// The error behind a code of a library that is not zero.
fn check(call: &str, code: c_int) -> stridor_base::error::Result<()> {
    if code == 0 {
        return Ok(());
    }
    // SAFETY: the text is a static array that ends with a zero.
    let text = unsafe { CStr::from_ptr(ffi::stridor_error_text()) }.to_string_lossy().into_owned();
    let found = if text.is_empty() { format!("error {code}") } else { text };
    Err(Error::analysis(call, found, "The message is that of the MPI, PETSc or SLEPc library"))
}
