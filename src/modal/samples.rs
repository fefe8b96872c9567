//! Real modes by a dense solver, for the tests of what is built on modes.

use super::{RealModes, SturmCertificate};
use crate::system::System;
use faer::{Mat, Side};
use std::f64::consts::TAU;

/// The lowest real modes by a dense solver.
pub(crate) fn dense_modes(system: &System, count: usize) -> RealModes {
    let l = system.structure.mass.to_dense().llt(Side::Lower).unwrap().L().to_owned();
    let mut k = system.structure.stiffness.to_dense();
    l.solve_lower_triangular_in_place(k.as_mut());
    let mut k = k.transpose().to_owned();
    l.solve_lower_triangular_in_place(k.as_mut());
    let symmetric = Mat::from_fn(k.nrows(), k.ncols(), |i, j| 0.5 * (k[(i, j)] + k[(j, i)]));
    let eigen = symmetric.self_adjoint_eigen(Side::Lower).unwrap();
    let mut shapes = eigen.U().subcols(0, count).to_owned();
    l.transpose().solve_upper_triangular_in_place(shapes.as_mut());
    // Complete up to just below the next one.
    let next = (count < eigen.S().dim()).then(|| eigen.S()[count]);
    let below_hz = next.unwrap_or(2.0 * eigen.S()[count - 1]).max(0.0).sqrt() * (1.0 - 1e-9) / TAU;
    let certificate =
        SturmCertificate { below_hz, shifts_hz: [below_hz; 2], counted: [count; 2], found: count };
    RealModes {
        eigenvalues: (0..count).map(|i| eigen.S()[i]).collect(),
        shapes,
        backward_errors: vec![0.0; count],
        rigid_bodies: 0,
        negative: 0,
        certificate,
    }
}
