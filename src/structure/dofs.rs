//! From the six degrees of freedom of every node to the free ones: u = T q.
//!
//! A node moves in the directions in which something gives it stiffness or mass and nothing holds it:
//!
//! * A full shell or a bar acts on all six. A *bending-only* plate acts on three, in the axes of its own plane:
//!   the deflection along its normal and the two rotations in its plane. Directions on which nothing acts are
//!   dropped, so a node used only by a bending-only plate has three degrees of freedom, however the plate is
//!   turned in space. A node that a bending-only plate shares with a bar, a full shell or a spring also keeps
//!   what those act on; the bending-only plate neither stiffens nor loads it in the plate's own plane.
//! * A support takes away its directions, exactly, also when they or the node's own directions are inclined.
//! * A slave is a sum of other degrees of freedom, u_s = Σ c u, by a [`Constraint`](super::Constraint) or a rigid link: a slave at x_s
//!   follows its master at x_m, u_s = u_m + θ_m × (x_s − x_m), θ_s = θ_m. Masters may be slaves themselves; those that are none lead.
//!   What acts on slaves acts on their masters. Supports belong on the masters: one on a slave would hold a sum of
//!   motions of the masters and is refused.
//! * The rotation about the normal of a membrane stays free on a clamped edge and on one that follows a master, see `drilling`.
//!
//! The free degrees of freedom of a node are orthonormal directions, along the global axes wherever possible.

use super::constraints::{Sums, check_unnamed, rigid_rows};
use super::drilling::Drilling;
use super::model::Model;
use super::numbering::node_order;
use super::part::AnyElement;
use super::spaces::{active_spaces, lead};
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::{SparseVector, c64};
use nalgebra::{SMatrix, SVector, Vector3};
use std::collections::BTreeMap;

const NAMES: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];

/// The terms of a row of T.
type Row = Vec<(usize, f64)>;
/// The terms of the six rows of a node of T.
type Rows = [Row; 6];

/// The map u = T q between nodes and free degrees of freedom.
#[derive(Debug, Clone)]
pub struct DofMap {
    nodes: Vec<[f64; 3]>,
    free: Vec<FreeDof>,
    /// Row r = 6 node + dof of T has the terms `terms[starts[r]..starts[r + 1]]`.
    starts: Vec<usize>,
    terms: Vec<(usize, f64)>,
    drilling: Drilling,
    /// Rows of the nodes whose rotation about a normal is free, for the elements that move with them as one rigid body.
    rigid: BTreeMap<usize, Rows>,
}

/// A free degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeDof {
    /// The node it belongs to.
    pub node: usize,
    /// The motion (ux, uy, uz, rx, ry, rz) of the node when it is one.
    pub direction: [f64; 6],
}

impl FreeDof {
    /// `ux` … `rz`, or the direction's components when it is inclined.
    pub fn label(&self) -> String {
        let named = |(k, value): (usize, &f64)| match *value {
            0.0 => None,
            1.0 => Some(NAMES[k].to_string()),
            v => Some(format!("{v:.3} {}", NAMES[k])),
        };
        self.direction.iter().enumerate().filter_map(named).collect::<Vec<_>>().join(" + ")
    }
}

impl DofMap {
    /// The number of free degrees of freedom.
    pub fn n_dofs(&self) -> usize {
        self.free.len()
    }

    /// The number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Displacement `dof` (0 … 5 for ux … rz) of `node` as a combination of free degrees of freedom; empty when it
    /// is held or dropped.
    pub fn terms(&self, node: usize, dof: usize) -> &[(usize, f64)] {
        let row = 6 * node + dof;
        &self.terms[self.starts[row]..self.starts[row + 1]]
    }

    /// The terms of `dof` of `node` as an element between `nodes` sees it: one whose nodes all move as one rigid body does
    /// not turn with the free rotation of its edge.
    pub(super) fn terms_of(&self, nodes: &[usize], node: usize, dof: usize) -> &[(usize, f64)] {
        match self.rigid.get(&node) {
            Some(rows) if self.drilling.is_rigid(nodes) => &rows[dof],
            _ => self.terms(node, dof),
        }
    }

    /// Tᵀ v of a sparse v given as (node, dof, coefficient): a force, or the coefficients of a linear form of u.
    pub fn reduce(&self, entries: &[(usize, usize, f64)]) -> SparseVector {
        SparseVector::from_entries(entries.iter().flat_map(|(node, dof, coefficient)| {
            self.terms(*node, *dof).iter().map(move |(k, t)| (*k, t * coefficient))
        }))
    }

    /// The mean over `nodes` of their translations along a vector, as a linear form of the free degrees of freedom; a force
    /// that is that vector, spread evenly over the nodes, is the same form.
    pub fn mean_motion(&self, nodes: &[usize], vector: [f64; 3]) -> SparseVector {
        let share = vector.map(|v| v / nodes.len().max(1) as f64);
        let of = |node: &usize| [0, 1, 2].map(|axis| (*node, axis, share[axis]));
        self.reduce(&nodes.iter().flat_map(of).collect::<Vec<_>>())
    }

    /// u = T q at every node.
    pub fn expand(&self, q: &[f64]) -> Vec<[f64; 6]> {
        (0..self.n_nodes())
            .map(|node| {
                std::array::from_fn(|dof| self.terms(node, dof).iter().map(|(k, t)| t * q[*k]).sum::<f64>())
            })
            .collect()
    }

    /// u = T q at every node, for a complex q.
    pub fn expand_complex(&self, q: &[c64]) -> Vec<[c64; 6]> {
        (0..self.n_nodes())
            .map(|node| {
                std::array::from_fn(|dof| {
                    self.terms(node, dof).iter().fold(c64::new(0.0, 0.0), |sum, (k, t)| sum + q[*k] * *t)
                })
            })
            .collect()
    }

    /// The free degrees of freedom: which node moves, and how.
    pub fn free_dofs(&self) -> &[FreeDof] {
        &self.free
    }

    /// Translations along and rotations about x, y, z through `origin` \[m\], as six vectors of free degrees of
    /// freedom: at each node the nearest motion that its free directions allow.
    pub fn rigid_body_vectors(&self, origin: [f64; 3]) -> [Vec<f64>; 6] {
        let mut vectors: [Vec<f64>; 6] = std::array::from_fn(|_| vec![0.0; self.n_dofs()]);
        let mut first = 0;
        for group in self.free.chunk_by(|a, b| a.node == b.node) {
            // Least squares on the node's directions, padded to 6 × 6 by the identity.
            let mut gram = SMatrix::<f64, 6, 6>::identity();
            for (i, a) in group.iter().enumerate() {
                for (j, b) in group.iter().enumerate() {
                    gram[(i, j)] = dot(&a.direction, &b.direction);
                }
            }
            let inverse = gram.try_inverse().unwrap_or_else(SMatrix::identity);
            let arm = Vector3::from(self.nodes[group[0].node]) - Vector3::from(origin);
            for (k, vector) in vectors.iter_mut().enumerate() {
                let mut motion = [0.0; 6];
                motion[k] = 1.0;
                let at_node = moved(&motion, &arm);
                let projected = SVector::<f64, 6>::from_fn(|i, _| {
                    group.get(i).map_or(0.0, |dof| dot(&dof.direction, &at_node))
                });
                let q = inverse * projected;
                vector[first..first + group.len()].copy_from_slice(&q.as_slice()[..group.len()]);
            }
            first += group.len();
        }
        vectors
    }

    /// The map of degrees of freedom that are given, in their order; every node lies in `nodes`.
    pub(crate) fn given(nodes: Vec<[f64; 3]>, free: Vec<FreeDof>) -> Self {
        let mut of_node = vec![Vec::new(); nodes.len()];
        free.iter().enumerate().for_each(|(k, dof)| of_node[dof.node].push(k));
        let (mut starts, mut terms) = (vec![0], Vec::with_capacity(free.len()));
        for own in &of_node {
            for dof in 0..6 {
                let moves = own.iter().filter(|k| free[**k].direction[dof] != 0.0);
                terms.extend(moves.map(|k| (*k, free[*k].direction[dof])));
                starts.push(terms.len());
            }
        }
        DofMap { nodes, free, starts, terms, drilling: Drilling::none(), rigid: BTreeMap::new() }
    }

    /// The map of `model` with its `elements`, whose node indices and geometry are known to be valid.
    pub(super) fn new(model: &Model, elements: &[AnyElement]) -> Result<Self> {
        let mut faults = Faults::new();
        let masters = check_unnamed(model, &mut faults);
        faults.into_result(())?;
        let n_nodes = model.nodes.len();
        let mut held = vec![[false; 6]; n_nodes];
        for support in &model.supports {
            for node in &support.nodes {
                for (h, s) in held[*node].iter_mut().zip(support.held) {
                    *h |= s;
                }
            }
        }
        let mut inclined: BTreeMap<usize, Vec<[f64; 6]>> = BTreeMap::new();
        for support in &model.inclined_supports {
            inclined.entry(support.node).or_default().extend(&support.held);
        }
        let drilling = Drilling::new(model, &masters, &held);
        let sums = Sums::new(model, &masters, &drilling);
        let mut spaces = active_spaces(n_nodes, elements);
        let lengths = lead(&sums, &mut spaces);

        let leaders: BTreeMap<usize, Vec<usize>> =
            sums.slave_nodes().into_iter().map(|node| (node, sums.nodes_of(node))).collect();
        let coupling = |nodes: &[usize]| -> Vec<usize> {
            let of = |node| leaders.get(node).map_or(std::slice::from_ref(node), Vec::as_slice);
            nodes.iter().flat_map(of).copied().collect()
        };
        let coupled: Vec<Vec<usize>> = elements.iter().map(|e| coupling(e.nodes())).collect();
        let mut free = Vec::new();
        let mut of_node = vec![0..0; n_nodes];
        for node in node_order(n_nodes, &coupled) {
            let first = free.len();
            let inclined = inclined.get(&node).map_or(&[][..], Vec::as_slice);
            let directions = spaces[node].free_directions(held[node], inclined, lengths[node]);
            free.extend(directions.into_iter().map(|direction| FreeDof { node, direction }));
            if let Some([x, y, z]) = drilling.normal(node) {
                free.push(FreeDof { node, direction: [0.0, 0.0, 0.0, x, y, z] });
            }
            of_node[node] = first..free.len();
        }
        if free.is_empty() {
            return Err(Error::input(
                Fault::new("supports", "every degree of freedom held", "at least one that can move")
                    .with_help("Release a support, or add a part with stiffness and mass"),
            ));
        }

        let own = |node: usize, dof: usize| -> Row {
            let moves = of_node[node].clone().map(|k| (k, free[k].direction[dof]));
            moves.filter(|(_, direction)| *direction != 0.0).collect()
        };
        // A sum of degrees of freedom that are no slaves. The rotation about a normal comes last of its node's own.
        let of_sum = |sum: &[(usize, f64)]| -> Row {
            let terms = |(row, c): &(usize, f64)| -> Row {
                let of = match sums.component(*row) {
                    Some((node, dof)) => own(node, dof),
                    None => sums.turning(*row).map(|node| (of_node[node].end - 1, 1.0)).into_iter().collect(),
                };
                of.into_iter().map(|(k, t)| (k, c * t)).collect()
            };
            added(sum.iter().flat_map(terms).collect())
        };
        let of_row = |row: usize| sums.of(row).map_or_else(|| own(row / 6, row % 6), of_sum);
        let mut starts = Vec::with_capacity(6 * n_nodes + 1);
        let mut terms = Vec::with_capacity(free.len());
        let mut rigid = BTreeMap::new();
        starts.push(0);
        for node in 0..n_nodes {
            for row in 6 * node..6 * node + 6 {
                terms.extend(of_row(row));
                starts.push(terms.len());
            }
            // The same without the rotation about the normal: that of the master, or of the ground.
            if drilling.normal(node).is_some() {
                let of_master = |sum: Row| -> Row {
                    let scaled =
                        |(row, c): (usize, f64)| of_row(row).into_iter().map(move |(k, t)| (k, c * t));
                    added(sum.into_iter().flat_map(scaled).collect())
                };
                let rows: Rows = if masters[node] == node {
                    let last = of_node[node].end - 1;
                    std::array::from_fn(|dof| {
                        own(node, dof).into_iter().filter(|(k, _)| *k != last).collect()
                    })
                } else {
                    rigid_rows(model, node, masters[node]).map(of_master)
                };
                rigid.insert(node, rows);
            }
        }
        Ok(DofMap { nodes: model.nodes.clone(), free, starts, terms, drilling, rigid })
    }
}

/// The terms of a row of T, each degree of freedom once, ascending.
fn added(mut terms: Row) -> Row {
    terms.sort_by_key(|(k, _)| *k);
    let mut sum: Row = Vec::with_capacity(terms.len());
    for (k, value) in terms {
        match sum.last_mut() {
            Some((last, total)) if *last == k => *total += value,
            _ => sum.push((k, value)),
        }
    }
    sum.retain(|(_, value)| *value != 0.0);
    sum
}

/// The rigid motion (u, θ) at a point `arm` away: (u + θ × arm, θ).
fn moved(motion: &[f64; 6], arm: &Vector3<f64>) -> [f64; 6] {
    let [ux, uy, uz, rx, ry, rz] = *motion;
    let swung = Vector3::new(rx, ry, rz).cross(arm);
    [ux + swung[0], uy + swung[1], uz + swung[2], rx, ry, rz]
}

fn dot(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::super::samples::STEEL;
    use super::super::*;
    use crate::bounds::{Origin::*, within};
    use crate::mesh::Cell;

    /// A square of two triangles tilted by `angle` about y, bending only or not, and a master below it.
    fn tilted(angle: f64, bending_only: bool) -> Model {
        let (c, s) = (angle.cos(), angle.sin());
        let nodes =
            [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]].map(|[x, y]| [x * c, y, -x * s]).to_vec();
        let part = Part::new(
            "plate",
            vec![Cell::triangle([0, 1, 2]), Cell::triangle([0, 2, 3])],
            Shell { bending_only, ..Shell::new(STEEL, 1e-3) },
        );
        Model { nodes, parts: vec![part], ..Model::default() }
    }

    #[test]
    fn a_bending_only_plate_keeps_deflection_and_two_rotations_however_it_is_tilted() {
        for angle in [0.0, 0.3, std::f64::consts::FRAC_PI_2] {
            let assembled = assemble(&tilted(angle, true)).unwrap();
            assert_eq!(assembled.dofs.n_dofs(), 12);
            let normal = [angle.sin(), 0.0, angle.cos()];
            let along: f64 =
                assembled.dofs.free_dofs()[0].direction.iter().zip(normal).map(|(d, n)| d * n).sum();
            assert!(within((along.abs() - 1.0).abs(), 1e-14, RoundOff));
        }
        let flat = assemble(&tilted(0.0, true)).unwrap();
        let labels: Vec<String> = flat.dofs.free_dofs()[..3].iter().map(FreeDof::label).collect();
        assert_eq!(labels, ["uz", "rx", "ry"]);
        // Held in z alone: an inclined deflection has no freedom left, the rotations have.
        let mut model = tilted(0.3, true);
        model.supports.push(Support { nodes: vec![0], held: [false, false, true, false, false, false] });
        assert_eq!(assemble(&model).unwrap().dofs.n_dofs(), 11);
    }

    #[test]
    fn rigid_slaves_follow_their_master_and_links_chain() {
        let mut model = tilted(0.2, false);
        model.nodes.push([0.02, 0.03, -0.05]);
        model.nodes.push([0.0, 0.0, -0.2]);
        model.links.push(RigidLink { master: 4, slaves: vec![0, 1] });
        model.links.push(RigidLink { master: 5, slaves: vec![4] });
        let assembled = assemble(&model).unwrap();
        // Two nodes that are free, the last master, and the rotations of the edge that follows about the plate's normal.
        assert_eq!(assembled.dofs.n_dofs(), 12 + 6 + 2);
        // Six rigid motions are annihilated by K, carry the mass, and expand to themselves everywhere.
        let origin = [0.3, -0.1, 0.2];
        for (k, q) in assembled.dofs.rigid_body_vectors(origin).iter().enumerate() {
            let mut motion = [0.0; 6];
            motion[k] = 1.0;
            for (node, u) in assembled.dofs.expand(q).iter().enumerate() {
                let arm = nalgebra::Vector3::from(model.nodes[node]) - nalgebra::Vector3::from(origin);
                let exact = super::moved(&motion, &arm);
                assert!(u.iter().zip(exact).all(|(a, b)| within((a - b).abs(), 1e-15, RoundOff)));
            }
            let kq = &*assembled.structure.stiffness * faer::ColRef::from_slice(q);
            let norm: f64 = assembled.structure.stiffness.val().iter().map(|v| v * v).sum::<f64>().sqrt();
            let size: f64 = q.iter().map(|v| v * v).sum::<f64>().sqrt();
            assert!(within(kq.norm_l2(), 1e-12 * norm * size, RoundOff));
            let mq = &*assembled.structure.mass * faer::ColRef::from_slice(q);
            let kinetic: f64 = q.iter().enumerate().map(|(i, v)| v * mq[i]).sum();
            if k < 3 {
                assert!(within((kinetic / assembled.total_mass - 1.0).abs(), 1e-12, RoundOff));
            }
        }
        // The force on a slave is the master's force and moment.
        let force = assembled.dofs.reduce(&[(0, 2, 2.0)]);
        let arm = [0.0, 0.0, 0.2];
        let terms: Vec<(usize, f64)> = force.iter().collect();
        let master = assembled.dofs.free_dofs().iter().position(|d| d.node == 5).unwrap();
        assert_eq!(terms, [(master + 2, 2.0)], "arm {arm:?} is along the force");
    }

    #[test]
    fn a_master_takes_only_what_acts_on_its_slaves() {
        // A bending-only plate hung rigidly on a master off its plane: one deflection and two rotations remain.
        let mut model = tilted(0.4, true);
        model.nodes.push([0.05, 0.05, 0.3]);
        model.links.push(RigidLink { master: 4, slaves: vec![0, 1, 2, 3] });
        let assembled = assemble(&model).unwrap();
        assert_eq!(assembled.dofs.n_dofs(), 3);
        let mass = assembled.structure.mass.to_dense();
        assert!(mass.llt(faer::Side::Lower).is_ok(), "{mass:?}");
    }

    #[test]
    fn circles_double_masters_and_held_slaves_are_refused_with_advice() {
        let mut model = tilted(0.0, false);
        model.nodes.push([0.0, 0.0, 1.0]);
        model.links.push(RigidLink { master: 4, slaves: vec![0] });
        model.supports.push(Support { nodes: vec![0], held: [true; 6] });
        let text = assemble(&model).unwrap_err().to_string();
        assert!(text.contains("Hold the master, node 5"), "{text}");
        model.supports.clear();
        model.links.push(RigidLink { master: 1, slaves: vec![0] });
        assert!(assemble(&model).unwrap_err().to_string().contains("already follows node 5"));
        model.links[1] = RigidLink { master: 0, slaves: vec![4] };
        assert!(assemble(&model).unwrap_err().to_string().contains("circle"));
    }
}
