//! Parts that nothing holds, or not in every motion.

use super::{Assembled, Model};
use crate::connected::lowest_connected;
use crate::error::Result;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::sparse::{add_scaled, diagonal, is_unresisted, sum_of_squares, times};
use crate::linalg::{SparseMatrix, SparseVector};
use crate::mesh::Cell;
use crate::system::Structure;
use faer::Mat;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

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
/// A body takes part in a motion with more than this part of its amplitude.
const TAKES_PART: f64 = 1e-3;
/// More bodies than this that springs and contacts bring together are left to the solution.
const MOST_BODIES: usize = 50;

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

/// Motions of a body at most.
const MOTIONS: usize = 6;

/// The bodies of a group, each with its degrees of freedom and its columns in the motions of the group.
type Bodies = BTreeMap<usize, (Vec<usize>, Range<usize>)>;

/// What can move as rigid bodies where `k` and `springs`, d of d g gᵀ with g, of all contacts closed, answer with no force: the bodies that
/// springs and contacts bring together move against each other. The bodies that take part in such motions, those of one group as
/// one part. The forces are measured as where steady sliding is solved, so that what passes here has a solution.
///
/// # Errors
/// When a matrix holds a NaN or an infinity.
pub fn unresisted_parts(
    model: &Model,
    assembled: &Assembled,
    k: &SparseMatrix,
    springs: &[(f64, &SparseVector)],
) -> Result<Vec<FreePart>> {
    let dofs = &assembled.dofs;
    let free = dofs.free_dofs();
    let of_node = bodies(model, assembled);
    let body: Vec<usize> = free.iter().map(|at| of_node[at.node]).collect();
    let linked = (0..k.ncols()).flat_map(|j| k.row_idx_of_col(j).map(move |i| [i, j]));
    let touching = springs.iter().flat_map(|(_, g)| g.indices().windows(2).map(|pair| [pair[0], pair[1]]));
    let together = linked.chain(touching).map(|entry| entry.map(|dof| body[dof])).filter(|[a, b]| a != b);
    let group_of = lowest_connected(of_node.len(), together);
    let mut groups: BTreeMap<usize, Bodies> = BTreeMap::new();
    for (dof, body) in body.iter().enumerate() {
        groups.entry(group_of[*body]).or_default().entry(*body).or_default().0.push(dof);
    }
    groups.retain(|_, bodies| bodies.len() <= MOST_BODIES);
    let nodes = &model.nodes;
    let center = std::array::from_fn(|k| nodes.iter().map(|x| x[k]).sum::<f64>() / nodes.len().max(1) as f64);
    let motions = dofs.rigid_body_vectors(center);
    // Orthonormal rigid motions of each body: what each of its degrees of freedom has of them.
    let mut own = vec![[0.0; MOTIONS]; free.len()];
    let mut energies: BTreeMap<usize, Mat<f64>> = BTreeMap::new();
    for (group, bodies) in &mut groups {
        let mut columns = 0;
        for (dofs, range) in bodies.values_mut() {
            let x = Mat::from_fn(dofs.len(), MOTIONS, |i, k| motions[k][dofs[i]]);
            let moved = product(x.as_ref(), orthonormal(&x)?.as_ref());
            for (i, dof) in dofs.iter().enumerate() {
                (0..moved.ncols()).for_each(|k| own[*dof][k] = moved[(i, k)]);
            }
            *range = columns..columns + moved.ncols();
            columns = range.end;
        }
        // With room for motions that the last body does not have.
        energies.insert(*group, Mat::zeros(columns + MOTIONS, columns + MOTIONS));
    }
    // XᵀAX, X of the columns of a group: of entries between two bodies by themselves, of those within one by the forces.
    let mut forces = vec![[0.0; MOTIONS]; free.len()];
    let first = |dof: usize| groups.get(&group_of[body[dof]]).map(|bodies| bodies[&body[dof]].1.start);
    for j in 0..k.ncols() {
        for (i, value) in k.row_idx_of_col(j).zip(k.val_of_col(j)) {
            if body[i] == body[j] {
                (0..MOTIONS).for_each(|c| forces[i][c] += value * own[j][c]);
            } else if let Some((a, b)) = first(i).zip(first(j)) {
                add_outer(&mut energies, group_of[body[i]], ([a, b], [&own[i], &own[j]]), *value);
            }
        }
    }
    for (group, bodies) in &groups {
        for (dofs, range) in bodies.values() {
            for dof in dofs {
                add_outer(&mut energies, *group, ([range.start; 2], [&own[*dof], &forces[*dof]]), 1.0);
            }
        }
    }
    let mut largest = diagonal(k);
    for (d, g) in springs {
        for (i, a) in g.iter() {
            largest[i] += d * a * a;
            for (j, b) in g.iter() {
                if let Some((first_i, first_j)) = first(i).zip(first(j)) {
                    let group = group_of[body[i]];
                    add_outer(&mut energies, group, ([first_i, first_j], [&own[i], &own[j]]), d * a * b);
                }
            }
        }
    }
    let mut closed = None;
    let mut found = Vec::new();
    for (group, bodies) in &groups {
        let columns = bodies.values().map(|(_, range)| range.len()).sum();
        let (values, directions) = symmetric_eigen(energies[group].submatrix(0, 0, columns, columns))?;
        let all = || bodies.values().flat_map(|(dofs, range)| dofs.iter().map(move |dof| (*dof, range)));
        let size = all().fold(0.0f64, |m, (dof, _)| m.max(largest[dof]));
        let mut part = FreePart { names: Vec::new(), node: usize::MAX, motions: 0 };
        let mut moving = BTreeSet::new();
        for j in (0..values.len()).filter(|j| values[*j] <= FREE * size) {
            let mut motion = Mat::zeros(free.len(), 1);
            for (dof, range) in all() {
                motion[(dof, 0)] = range.clone().zip(own[dof]).map(|(c, own)| own * directions[(c, j)]).sum();
            }
            let closed = closed.get_or_insert_with(|| {
                add_scaled(&[(1.0, k), (1.0, &sum_of_squares(free.len(), springs.iter().copied()))])
            });
            if !is_unresisted(closed, motion.as_ref()) {
                continue;
            }
            part.motions += 1;
            let takes_part =
                |range: &Range<usize>| range.clone().any(|c| directions[(c, j)].abs() > TAKES_PART);
            moving.extend(bodies.iter().filter(|(_, (_, range))| takes_part(range)).map(|(body, _)| *body));
        }
        for body in moving {
            part.names.extend(names(model, assembled, &of_node, body));
            part.node = part.node.min(free[bodies[&body].0[0]].node);
        }
        if part.motions > 0 {
            found.push(part);
        }
    }
    Ok(found)
}

/// Adds `factor` a bᵀ to the matrix of a group, from the given row and column on.
fn add_outer(
    energies: &mut BTreeMap<usize, Mat<f64>>,
    group: usize,
    ([row, column], [a, b]): ([usize; 2], [&[f64; MOTIONS]; 2]),
    factor: f64,
) {
    let Some(energy) = energies.get_mut(&group) else { return };
    for (j, b) in b.iter().enumerate() {
        for (i, a) in a.iter().enumerate() {
            energy[(row + i, column + j)] += factor * a * b;
        }
    }
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

/// B, with which the columns of X B are orthonormal and span those of X, n × 6.
fn orthonormal(x: &Mat<f64>) -> Result<Mat<f64>> {
    let scale: Vec<f64> =
        (0..6).map(|k| x.col(k).norm_l2()).map(|l| if l > 0.0 { 1.0 / l } else { 0.0 }).collect();
    let gram = product(x.transpose(), x.as_ref());
    let gram = Mat::from_fn(6, 6, |i, j| scale[i] * gram[(i, j)] * scale[j]);
    let (sizes, directions) = symmetric_eigen(gram.as_ref())?;
    let kept: Vec<usize> = (0..6).filter(|j| sizes[*j] > 1e-9).collect();
    Ok(Mat::from_fn(6, kept.len(), |i, j| scale[i] * directions[(i, kept[j])] / sizes[kept[j]].sqrt()))
}

/// For every node, the lowest of those that elements and rigid links connect it to.
fn bodies(model: &Model, assembled: &Assembled) -> Vec<usize> {
    let (dofs, free) = (&assembled.dofs, assembled.dofs.free_dofs());
    let cells = model.parts.iter().flat_map(|part| part.cells.iter().map(|cell| cell.nodes().to_vec()));
    let linked = (0..dofs.n_nodes()).map(|node| vec![node]);
    let moved = |nodes: Vec<usize>| -> Vec<usize> {
        let terms = nodes.into_iter().flat_map(|node| (0..6).flat_map(move |dof| dofs.terms(node, dof)));
        terms.map(|(k, _)| free[*k].node).collect()
    };
    lowest_connected(dofs.n_nodes(), cells.chain(linked).map(moved))
}

/// How many of the motions that the columns of `x` span have xᵀKx / xᵀx of at most `bound`, with `forces` = K x.
fn unheld(x: &Mat<f64>, forces: &Mat<f64>, bound: f64) -> Result<usize> {
    let basis = orthonormal(x)?;
    let energy = product(x.transpose(), forces.as_ref());
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
    let within =
        model.parts.iter().filter(|part| part.cells.iter().flat_map(Cell::nodes).any(|n| inside(*n)));
    within.map(|part| part.name.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::samples::STEEL;
    use super::super::{Bar, Model, Part, Section, Spring, Support, assemble};
    use super::*;
    use crate::linalg::random::Random;

    fn bar(name: &str, nodes: [usize; 2]) -> Part {
        Part::new(
            name,
            vec![Cell::line(nodes)],
            Bar { material: STEEL, section: Section::round(0.02), orientation: [0.0, 0.0, 1.0] },
        )
    }

    #[test]
    fn loose_and_hinged_parts_are_named_with_their_motions() {
        let nodes = (0..6).map(|k| [0.3 * k as f64, 0.1 * (k / 2) as f64, 0.0]).collect();
        let model = Model {
            nodes,
            parts: vec![bar("held", [0, 1]), bar("loose", [2, 3]), bar("hinged", [4, 5])],
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
        let free = |node, direction| is_free_along(&model, &assembled, &[node], direction);
        // The spring along x holds the loose bar in that direction only.
        assert!(free(3, [0.0, 1.0, 0.0]) && free(2, [0.0, 0.0, 1.0]) && !free(3, [1.0, 0.0, 0.0]));
        assert!(!free(1, [0.0, 1.0, 0.0]) && !free(5, [0.0, 1.0, 0.0]));
    }

    /// Pairs of bars at random places on springs of random directions, to the ground, to each other and, as contacts are, beside K: six motions a
    /// pair less the rank of what holds them, by a singular value decomposition. A spring of 1e-6 of the others holds, too.
    #[test]
    fn motions_that_nothing_resists_are_those_outside_of_the_rank_of_what_holds() {
        let mut random = Random::seeded(47);
        let mut seen = [0; 2];
        for _ in 0..200 {
            let bars = 1 + random.below(3);
            let mut place = || [0; 3].map(|_| random.next());
            let nodes: Vec<[f64; 3]> = (0..3 * bars).map(|_| place()).collect();
            let mut model = Model {
                nodes: nodes.clone(),
                parts: (0..2 * bars)
                    .map(|k| bar(&format!("bar {k}"), [3 * (k / 2) + k % 2, 3 * (k / 2) + k % 2 + 1]))
                    .collect(),
                ..Model::default()
            };
            // The force rows on the six motions of each bar: (d, x × d).
            let row = |node: usize, d: [f64; 3], sign: f64, row: &mut [f64]| {
                let x = nodes[node];
                let turn = [x[1] * d[2] - x[2] * d[1], x[2] * d[0] - x[0] * d[2], x[0] * d[1] - x[1] * d[0]];
                let at = 6 * (node / 3);
                d.iter().chain(&turn).enumerate().for_each(|(k, v)| row[at + k] += sign * v);
            };
            let springs = random.below(6 * bars + 3);
            let (mut rows, mut roots, mut contacts) = (Vec::new(), Vec::new(), Vec::new());
            for k in 0..springs {
                let node = random.below(3 * bars);
                let direction = [0; 3].map(|_| random.next());
                let other = Some(random.below(3 * bars)).filter(|other| other / 3 != node / 3);
                let mut own = vec![0.0; 6 * bars];
                row(node, direction, 1.0, &mut own);
                other.into_iter().for_each(|other| row(other, direction, -1.0, &mut own));
                rows.push(own);
                let stiffness = if k % 5 == 4 { 1.0 } else { 1e6 };
                roots.push(f64::sqrt(stiffness));
                let spring = Spring { node, other, direction, rotational: false, stiffness, damping: 0.0 };
                if k % 3 == 2 { contacts.push(spring) } else { model.springs.push(spring) }
            }
            let held = nalgebra::DMatrix::from_fn(rows.len().max(1), 6 * bars, |i, j| {
                rows.get(i).map_or(0.0, |row| row[j])
            });
            let rank = held.rank(1e-6);
            // What holds by less than a hundred times what counts as nothing, 1e-12 of the stiffness of a short bar of 1e9 N/m, may be either.
            let stiff = nalgebra::DMatrix::from_fn(held.nrows(), held.ncols(), |i, j| {
                roots.get(i).unwrap_or(&0.0) * held[(i, j)]
            });
            let mut singular: Vec<f64> = stiff.singular_values().iter().copied().collect();
            singular.sort_by(|a, b| b.total_cmp(a));
            if rank > 0 && singular[rank - 1].powi(2) < 0.1 {
                continue;
            }
            let free = 6 * bars - rank;
            let assembled = assemble(&model).unwrap();
            let terms = |spring: &Spring| {
                let ends = [Some((spring.node, 1.0)), spring.other.map(|node| (node, -1.0))];
                let ends = ends.into_iter().flatten();
                let of = |(node, sign)| [0, 1, 2].map(|c| (node, c, sign * spring.direction[c]));
                assembled.dofs.reduce(&ends.flat_map(of).collect::<Vec<_>>())
            };
            let contacts: Vec<_> = contacts.iter().map(|spring| (spring.stiffness, terms(spring))).collect();
            let contacts: Vec<_> = contacts.iter().map(|(k, g)| (*k, g)).collect();
            let found =
                unresisted_parts(&model, &assembled, &assembled.structure.stiffness, &contacts).unwrap();
            assert_eq!(found.iter().map(|part| part.motions).sum::<usize>(), free, "{model:?}");
            seen[usize::from(free > 0)] += 1;
        }
        assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
    }
}
