//! The Mindlin–Reissner plate: bending and transverse shear, without locking however thin the plate.
//!
//! A fibre at height z moves by z β in the plane, β = (θ₂, −θ₁), and the transverse shear strain is γ = ∇w + β. Energy
//! ½ ∫ κᵀ D κ + κ_s G h γᵀγ dA with the curvatures κ = (β_x,x; β_y,y; β_x,y + β_y,x), and kinetic energy
//! ½ ∫ ρh ẇ² + ρh³/12 β̇ᵀβ̇ dA (Mindlin, J. Appl. Mech. 18 (1951) 31).
//!
//! Discrete shear on the sides ([`Side`]): DKMT and DKMQ, Katili, IJNME 36 (1993) 1859 and 1885. As the plate gets thin
//! they become the discrete Kirchhoff triangle and quadrilateral ([`super::dkt`]); where elements are small beside
//! the thickness the shear strain is that of linear w and β along each side. Along a side all fields depend on its
//! two ends alone, so that triangles and quadrilaterals fit together. Constant curvatures are met exactly on any mesh.

mod quadrilateral;
mod sides;
mod triangle;

pub use quadrilateral::MindlinQuadrilateral;
pub use sides::{PlateSection, Side, corner_shear, sides, slopes};
pub use triangle::{MindlinTriangle, triangle_rotary_inertia, triangle_stiffness};

use super::FacePoint;
use super::waves::mindlin_wavenumber;
use crate::structure::Shell;
use nalgebra::{RowSVector, SMatrix};

/// Curvatures (β_x,x; β_y,y; β_x,y + β_y,x) from the x and y derivatives of (β_x, β_y).
fn curvatures<const C: usize>(gradient: &[[RowSVector<f64, C>; 2]; 2]) -> SMatrix<f64, 3, C> {
    let [[bx_x, by_x], [bx_y, by_y]] = gradient;
    SMatrix::from_rows(&[*bx_x, *by_y, bx_y + by_x])
}

/// Where the corners of the triangle of `at` are among `nodes`; `None` when they are not all there.
fn corners_among<const N: usize>(nodes: &[usize; N], at: &FacePoint) -> Option<[usize; 3]> {
    let place = |node: usize| nodes.iter().position(|n| *n == node);
    let [a, b, c] = at.corners;
    Some([place(a)?, place(b)?, place(c)?])
}

/// k \[rad/m\] of the bending waves of `plate`.
fn wavenumber(plate: &Shell, frequency_hz: f64) -> Option<f64> {
    Some(mindlin_wavenumber(&plate.material, plate.thickness, plate.shear_coefficient(), frequency_hz))
}
