//! Elements: from coordinates and material to small symmetric matrices.
//!
//! The rest of the program knows an element as a [`FiniteElement`]: nodes, freedoms, matrices of any size, the displacement
//! at a point of its face, the range of its theory. A new one is a file here; `structure/part.rs` says what part of a
//! model it stands for.
//!
//! | element | what it is | freedoms | file |
//! |---|---|---|---|
//! | [`KirchhoffTriangle`] | thin flat shell: DKT + OPT | 18 | `kirchhoff` |
//! | [`MindlinTriangle`] | thick flat shell: DKMT + OPT | 18 | `mindlin/triangle` |
//! | [`MindlinQuadrilateral`] | thick flat shell: DKMQ + OPT | 24 | `mindlin/quadrilateral` |
//! | [`BarElement`] | Euler–Bernoulli bar | 12 | `bar` |
//! | [`SolidElement`] | solid of any kind of cell | 3 a node | `solid` |
//! | [`MassElement`] | concentrated mass | 6 | `point` |
//! | [`SpringElement`] | spring and dashpot | 6, 12 | `point` |
//!
//! They are made of pure functions:
//!
//! | function | field | file |
//! |---|---|---|
//! | [`FlatTriangle`] | a triangle in its own plane: local frame, areas, gradients | `triangle` |
//! | [`dkt`] | bending stiffness, discrete Kirchhoff triangle | `dkt` |
//! | [`opt`] | membrane stiffness with drilling rotations, optimal triangle | `opt` |
//! | [`bciz`] | the cubic deflection that mass, geometric stiffness and interpolation use | `bciz` |
//! | [`mass`] | consistent masses of bending and membrane | `mass` |
//! | [`geometric`] | string effect of membrane and axial forces | `geometric` |
//! | [`FlatShell`] | DKT + OPT in space, 18 degrees of freedom | `shell` |
//! | [`mindlin`] | bending and shear with discrete shear constraints on the sides | `mindlin/sides` |
//! | [`plate_transport`] | gyroscopic and transport terms of plates that rotate | `plate_transport` |
//! | [`waves`] | bending waves of both theories, and how far Kirchhoff's is off | `waves` |
//! | [`split_face`] | quadrilaterals as the mean of their two splittings into triangles | `face` |
//! | [`Beam`] | Euler–Bernoulli bar in space, 12 degrees of freedom | `beam` |
//! | [`spring_direction`] | springs, dashpots and point masses | `point` |
//!
//! A triangle's local axes are e₁ along its first side, e₃ its normal, e₂ = e₃ × e₁. Rotations are components of
//! the rotation vector, so a deflection w along e₃ turns the normal by θ₁ = ∂w/∂y and θ₂ = −∂w/∂x.

mod bar;
pub mod bciz;
mod beam;
pub mod dkt;
mod element_matrix;
mod face;
mod finite_element;
pub mod geometric;
mod kirchhoff;
pub mod mass;
pub mod mindlin;
pub mod opt;
mod plate_transport;
mod point;
mod shell;
mod solid;
mod triangle;
pub mod waves;

pub use bar::BarElement;
pub use beam::Beam;
pub use element_matrix::ElementMatrix;
pub use face::{WeightedTriangle, on_triangles, split_face};
pub use finite_element::{Acting, FacePoint, FiniteElement, TheoryError};
pub use kirchhoff::KirchhoffTriangle;
pub use mindlin::{MindlinQuadrilateral, MindlinTriangle};
pub use plate_transport::plate_transport;
pub use point::{MassElement, SpringElement, mass_diagonal, spring_direction};
pub use shell::FlatShell;
pub use solid::SolidElement;
pub use triangle::FlatTriangle;

use nalgebra::SMatrix;

/// (A + Aᵀ)/2: symmetric to the last bit.
pub(crate) fn symmetrized<const N: usize>(a: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    (a + a.transpose()) * 0.5
}

/// Tᵀ A T with T = diag(R, R, …): a matrix in local axes (rows of `frame`) turned into global axes.
pub(crate) fn to_global<const N: usize>(
    local: &SMatrix<f64, N, N>,
    frame: &nalgebra::Matrix3<f64>,
) -> SMatrix<f64, N, N> {
    let mut global = SMatrix::<f64, N, N>::zeros();
    for i in (0..N).step_by(3) {
        for j in (0..N).step_by(3) {
            let block = frame.transpose() * local.fixed_view::<3, 3>(i, j) * frame;
            global.fixed_view_mut::<3, 3>(i, j).copy_from(&block);
        }
    }
    symmetrized(global)
}

/// The mean of the coordinates of some nodes.
fn mean(nodes: &[usize], coordinates: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|k| nodes.iter().map(|n| coordinates[*n][k]).sum::<f64>() / nodes.len() as f64)
}
