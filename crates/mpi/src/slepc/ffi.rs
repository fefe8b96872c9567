//! The functions of the C side.

use std::ffi::{c_char, c_int};

/// `struct factor`.
#[repr(C)]
pub struct Factor {
    _private: [u8; 0],
}

/// `Mat` of PETSc.
#[repr(C)]
pub struct Matrix {
    _private: [u8; 0],
}

unsafe extern "C" {
    pub fn stridor_error_text() -> *const c_char;
    pub fn stridor_start(rank: *mut c_int, size: *mut c_int) -> c_int;
    pub fn stridor_stop();
    pub fn stridor_abort(code: c_int);
    pub fn stridor_broadcast(bytes: *mut u8, count: i64) -> c_int;
    pub fn stridor_announce(bytes: *mut u8, count: i64) -> c_int;
    pub fn stridor_send(bytes: *const u8, count: i64, to: c_int) -> c_int;
    pub fn stridor_waiting(from: *mut c_int) -> c_int;
    pub fn stridor_receive(bytes: *mut u8, count: i64, from: c_int) -> c_int;
    pub fn stridor_mumps_new(
        n: c_int,
        entries: i64,
        rows: *mut c_int,
        columns: *mut c_int,
        values: *mut f64,
        place: *mut c_int,
        kept: c_int,
        status: *mut c_int,
    ) -> *mut Factor;
    pub fn stridor_mumps_solve(factor: *mut Factor, columns: *mut f64, count: c_int, stride: c_int) -> c_int;
    pub fn stridor_mumps_infog(factor: *const Factor, k: c_int) -> c_int;
    pub fn stridor_mumps_free(factor: *mut Factor);
    pub fn stridor_matrix_new(
        n: i64,
        own: i64,
        starts: *const i64,
        columns: *const i64,
        values: *const f64,
        parts: c_int,
        matrix: *mut *mut Matrix,
    ) -> c_int;
    pub fn stridor_matrix_free(matrix: *mut Matrix);
    pub fn stridor_krylov_schur(
        k: *mut Matrix,
        m: *mut Matrix,
        factor: *mut Factor,
        order: *const c_int,
        shift: f64,
        count: c_int,
        tolerance: f64,
        found: *mut c_int,
        values: *mut f64,
        vectors: *mut f64,
    ) -> c_int;
    pub fn stridor_toar(
        k: *mut Matrix,
        c: *mut Matrix,
        m: *mut Matrix,
        basis: *const f64,
        coefficients: *const f64,
        rank: c_int,
        shift_re: f64,
        shift_im: f64,
        count: c_int,
        tolerance: f64,
        found: *mut c_int,
        values: *mut f64,
    ) -> c_int;
}
