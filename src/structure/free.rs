//! Parts that nothing holds, or not in every motion.

use super::{Assembled, Model};
use crate::connected::lowest_connected;
use crate::error::Result;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::sparse::{diagonal, times};
use crate::system::Structure;
use faer::Mat;

/// A piece of the structure that can move as a rigid body without any force.
#[derive(Debug, Clone, PartialEq)]
pub struct FreePart {
    /// The names of the shells and bars in it; none for point masses.
    pub names: Vec<String>,
    /// One of its nodes.
    pub node: usize,
    /// The number of its rigid-body motions that meet no force, 1 to 6.
    pub motions: usize,
}

/// A motion is free when xᵀKx / xᵀx is below this part of the largest K_ii of the piece.
const FREE: f64 = 1e-12;
/// A motion is free when xᵀKx is below this part of Σ |xᵢ Kᵢⱼ xⱼ|: the rounding of K and of the sum.
const ROUNDING: f64 = 1e-14;

/// The connected pieces of `model` that K holds in less than all of their rigid-body motions, contacts left out.
///
/// # Errors
/// When K holds a NaN or an infinity.
pub fn free_parts(model: &Model, assembled: &Assembled) -> Result<Vec<FreePart>> {
    let (dofs, stiffness) = (&assembled.dofs, &assembled.structure.stiffness);
    let free = dofs.free_dofs();
    let of_node = pieces(assembled);
    let mut first_node = vec![None; of_node.len()];
    for dof in free.iter().rev() {
        first_node[of_node[dof.node]] = Some(dof.node);
    }

    // All six motions of all pieces at once, as K does not couple pieces.
    let nodes = &model.nodes;
    let center = std::array::from_fn(|k| nodes.iter().map(|x| x[k]).sum::<f64>() / nodes.len().max(1) as f64);
    let motions = dofs.rigid_body_vectors(center);
    let x = Mat::from_fn(free.len(), 6, |i, k| motions[k][i]);
    let forces = times(stiffness, x.as_ref());
    let largest = diagonal(stiffness);
    let mut found = Vec::new();
    for (number, node) in first_node.iter().enumerate().filter_map(|(p, node)| Some((p, (*node)?))) {
        let own: Vec<usize> = (0..free.len()).filter(|i| of_node[free[*i].node] == number).collect();
        let [x, forces] = [&x, &forces].map(|all| Mat::from_fn(own.len(), 6, |i, k| all[(own[i], k)]));
        let size = own.iter().fold(0.0f64, |m, i| m.max(largest[*i]));
        let motions = unheld(&x, &forces, FREE * size)?;
        if motions > 0 {
            found.push(FreePart { names: names(model, assembled, &of_node, number), node, motions });
        }
    }
    Ok(found)
}

/// The [`free_parts`] that none of `nodes` moves with and no spring is in: nothing but rigid motion is left to them. A piece with
/// springs, however soft, is not among them.
///
/// # Errors
/// Those of [`free_parts`].
pub fn free_parts_without(model: &Model, assembled: &Assembled, nodes: &[usize]) -> Result<Vec<FreePart>> {
    let (dofs, free) = (&assembled.dofs, assembled.dofs.free_dofs());
    let of_node = pieces(assembled);
    let sprung = model.springs.iter().flat_map(|spring| [Some(spring.node), spring.other]).flatten();
    let mut touched: Vec<usize> = Vec::new();
    for node in nodes.iter().copied().chain(sprung) {
        let terms = (0..6).flat_map(|dof| dofs.terms(node, dof));
        touched.extend(terms.map(|(k, _)| of_node[free[*k].node]));
    }
    let parts = free_parts(model, assembled)?.into_iter();
    Ok(parts.filter(|part| !touched.contains(&of_node[part.node])).collect())
}

/// Whether the piece that `nodes` are of can be moved along a direction as a whole without any force, contacts left out.
pub fn is_free_along(model: &Model, assembled: &Assembled, nodes: &[usize], direction: [f64; 3]) -> bool {
    let (dofs, stiffness) = (&assembled.dofs, &assembled.structure.stiffness);
    let free = dofs.free_dofs();
    let of_node = pieces(assembled);
    let center = model.nodes.first().copied().unwrap_or_default();
    let motions = dofs.rigid_body_vectors(center);
    let moved = |piece: usize| -> bool {
        let along = |i: usize| (0..3).map(|k| direction[k] * motions[k][i]).sum::<f64>();
        let inside = |i: usize| of_node[free[i].node] == piece;
        let x: Vec<f64> = (0..free.len()).map(|i| if inside(i) { along(i) } else { 0.0 }).collect();
        // xᵀKx, and what its terms are in size: a motion without force leaves the rounding of that.
        let (mut energy, mut terms) = (0.0, 0.0f64);
        for j in 0..free.len() {
            let entries = stiffness.row_idx_of_col(j).zip(stiffness.val_of_col(j));
            for term in entries.map(|(i, v)| x[i] * v * x[j]) {
                energy += term;
                terms += term.abs();
            }
        }
        terms > 0.0 && energy <= ROUNDING * terms
    };
    let known = nodes.iter().find_map(|node| {
        let terms = (0..6).find_map(|dof| dofs.terms(*node, dof).first().map(|(k, _)| *k));
        terms.map(|k| of_node[free[k].node])
    });
    known.is_some_and(moved)
}

/// For every node, the lowest of those that M or K connect it to.
fn pieces(assembled: &Assembled) -> Vec<usize> {
    let (dofs, free) = (&assembled.dofs, assembled.dofs.free_dofs());
    let Structure { stiffness, mass, .. } = &assembled.structure;
    let same = mass.col_ptr() == stiffness.col_ptr() && mass.row_idx() == stiffness.row_idx();
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for matrix in std::iter::once(stiffness).chain((!same).then_some(mass)) {
        for j in 0..matrix.ncols() {
            let node = free[j].node;
            for i in matrix.row_idx_of_col(j).take_while(|i| *i < j) {
                let pair = [free[i].node, node];
                // The freedoms of a node follow one another.
                if pairs.last() != Some(&pair) {
                    pairs.push(pair);
                }
            }
        }
    }
    lowest_connected(dofs.n_nodes(), pairs)
}

/// How many of the motions that the columns of `x` span have xᵀKx / xᵀx of at most `bound`, with `forces` = K x.
fn unheld(x: &Mat<f64>, forces: &Mat<f64>, bound: f64) -> Result<usize> {
    let scale: Vec<f64> =
        (0..6).map(|k| x.col(k).norm_l2()).map(|l| if l > 0.0 { 1.0 / l } else { 0.0 }).collect();
    let scaled = |a: Mat<f64>| Mat::from_fn(6, 6, |i, j| scale[i] * a[(i, j)] * scale[j]);
    let gram = scaled(product(x.transpose(), x.as_ref()));
    let energy = scaled(product(x.transpose(), forces.as_ref()));
    let (sizes, directions) = symmetric_eigen(gram.as_ref())?;
    let kept: Vec<usize> = (0..6).filter(|j| sizes[*j] > 1e-9).collect();
    let basis = Mat::from_fn(6, kept.len(), |i, j| directions[(i, kept[j])] / sizes[kept[j]].sqrt());
    let small = product(basis.transpose(), product(energy.as_ref(), basis.as_ref()).as_ref());
    let (values, _) = symmetric_eigen(small.as_ref())?;
    Ok(values.iter().filter(|v| **v <= bound).count())
}

/// The names of the parts in a piece.
fn names(model: &Model, assembled: &Assembled, of_node: &[usize], number: usize) -> Vec<String> {
    let free = assembled.dofs.free_dofs();
    let inside = |node: usize| {
        let moved = (0..6).find_map(|dof| assembled.dofs.terms(node, dof).first());
        moved.is_some_and(|(k, _)| of_node[free[*k].node] == number)
    };
    let shells = model
        .shells
        .iter()
        .map(|part| (&part.name, part.faces.iter().flat_map(|f| f.nodes()).any(|n| inside(*n))));
    let bars = model.bars.iter().map(|part| (&part.name, part.elements.iter().flatten().any(|n| inside(*n))));
    shells.chain(bars).filter(|(_, inside)| *inside).map(|(name, _)| name.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::samples::STEEL;
    use super::super::{BarPart, Model, Section, Spring, Support, assemble};
    use super::*;

    fn bar(name: &str, nodes: [usize; 2]) -> BarPart {
        BarPart {
            name: name.into(),
            elements: vec![nodes],
            material: STEEL,
            section: Section::round(0.02),
            orientation: [0.0, 0.0, 1.0],
        }
    }

    #[test]
    fn loose_and_hinged_parts_are_named_with_their_motions() {
        let nodes = (0..6).map(|k| [0.3 * k as f64, 0.1 * (k / 2) as f64, 0.0]).collect();
        let model = Model {
            nodes,
            bars: vec![bar("held", [0, 1]), bar("loose", [2, 3]), bar("hinged", [4, 5])],
            supports: vec![
                Support { nodes: vec![0], held: [true; 6] },
                Support { nodes: vec![4], held: [true, true, true, true, false, true] },
            ],
            springs: vec![Spring {
                node: 2,
                other: None,
                direction: [1.0, 0.0, 0.0],
                rotational: false,
                stiffness: 1e3,
                damping: 0.0,
            }],
            ..Model::default()
        };
        let found = free_parts(&model, &assemble(&model).unwrap()).unwrap();
        let part = |name: &str, node, motions| FreePart { names: vec![name.into()], node, motions };
        let mut found_by_node = found;
        found_by_node.sort_by_key(|part| part.names.clone());
        assert_eq!(found_by_node.len(), 2, "{found_by_node:?}");
        assert_eq!(found_by_node[0], part("hinged", 4 + usize::from(found_by_node[0].node == 5), 1));
        assert_eq!(found_by_node[1], part("loose", 2 + usize::from(found_by_node[1].node == 3), 5));
        let assembled = assemble(&model).unwrap();
        // The loose one has a spring; a contact holds the hinged one or it does not.
        let alone = |nodes: &[usize]| free_parts_without(&model, &assembled, nodes).unwrap().len();
        assert_eq!([alone(&[]), alone(&[0, 3]), alone(&[5])], [1, 1, 0]);
        let free = |node, direction| is_free_along(&model, &assembled, &[node], direction);
        // The spring along x holds the loose bar in that direction only.
        assert!(free(3, [0.0, 1.0, 0.0]) && free(2, [0.0, 0.0, 1.0]) && !free(3, [1.0, 0.0, 0.0]));
        assert!(!free(1, [0.0, 1.0, 0.0]) && !free(5, [0.0, 1.0, 0.0]));
    }
}
