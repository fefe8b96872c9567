//! Matrices from elsewhere in the form of an assembled model: whose degrees of freedom they are, when that is known.

use super::assembly::Assembled;
use super::dofs::{DofMap, FreeDof};
use crate::system::Structure;
use std::sync::Arc;

impl Assembled {
    /// M, C and K that another program assembled, with the place of each row.
    ///
    /// `places` gives the node of every row and the motion (ux, uy, uz, rx, ry, rz) of that node; without them
    /// (`None`) six rows after one another share a node at the origin, so that shapes can be written, and masses are
    /// not a number. The total mass is then rᵀMr, r the translation that moves most.
    pub fn imported(structure: Structure, nodes: Vec<[f64; 3]>, places: Option<Vec<FreeDof>>) -> Self {
        let n = structure.n_dofs();
        let known = places.is_some();
        let nodes = if known { nodes } else { vec![[0.0; 3]; n.div_ceil(6)] };
        let free = places.unwrap_or_else(|| (0..n).map(sixth).collect());
        let dofs = DofMap::given(nodes, free);
        let total_mass = if known { largest_translation(&structure, &dofs) } else { f64::NAN };
        Assembled {
            stiffness: Arc::clone(&structure.stiffness),
            structure,
            dofs: Arc::new(dofs),
            total_mass,
            center_of_mass: [f64::NAN; 3],
        }
    }
}

/// Row `k` as one of the six motions of node k / 6.
fn sixth(k: usize) -> FreeDof {
    FreeDof { node: k / 6, direction: std::array::from_fn(|c| f64::from(c == k % 6)) }
}

/// The largest rᵀMr of the translations along x, y, z \[kg\].
fn largest_translation(structure: &Structure, dofs: &DofMap) -> f64 {
    let translations = dofs.rigid_body_vectors([0.0; 3]);
    let mass = |r: &Vec<f64>| {
        let momentum = crate::linalg::sparse::multiply_vector(&structure.mass, r);
        r.iter().zip(momentum).map(|(a, b)| a * b).sum::<f64>()
    };
    translations[..3].iter().map(mass).fold(0.0, f64::max)
}
