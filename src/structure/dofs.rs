//! From the six degrees of freedom of every node to the free ones: u = T q.
//!
//! A node moves in the directions in which something gives it stiffness or mass and nothing holds it:
//!
//! * A full shell or a bar acts on all six. A *bending-only* plate acts on three, in the axes of its own plane:
//!   the deflection along its normal and the two rotations in its plane. Directions on which nothing acts are
//!   dropped, so a node used only by a bending-only plate has three degrees of freedom, however the plate is
//!   turned in space. A node that a bending-only plate shares with a bar, a full shell or a spring also keeps
//!   what those act on; the bending-only plate neither stiffens nor loads it in the plate's own plane.
//! * A support takes away its directions, exactly, also when the node's own directions are inclined to it.
//! * A rigid slave at x_s follows its master at x_m: u_s = u_m + θ_m × (x_s − x_m), θ_s = θ_m. Links may be chained;
//!   the last master leads. What acts on the slaves acts on their master. Supports belong on the master: one on a
//!   slave would hold a combination of the master's motions and is refused.
//!
//! The free degrees of freedom of a node are orthonormal directions, along the global axes wherever possible.

use super::elements::{FlatShell, mass_diagonal, split_face, spring_direction};
use super::model::Model;
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::{SparseVector, c64};
use nalgebra::{SMatrix, SVector, Vector3};

/// Angles \[rad\] below which two directions are the same one.
const SAME_DIRECTION: f64 = 1e-3;
/// Components of unit directions below this are round-off.
const ROUND_OFF: f64 = 1e-12;
const NAMES: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];

/// The map u = T q between nodes and free degrees of freedom.
#[derive(Debug, Clone)]
pub struct DofMap {
    nodes: Vec<[f64; 3]>,
    free: Vec<FreeDof>,
    /// Row r = 6 node + dof of T has the terms `terms[starts[r]..starts[r + 1]]`.
    starts: Vec<usize>,
    terms: Vec<(usize, f64)>,
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

    /// Tᵀ v of a sparse v given as (node, dof, coefficient): a force, or the coefficients of a linear form of u.
    pub fn reduce(&self, entries: &[(usize, usize, f64)]) -> SparseVector {
        SparseVector::from_entries(entries.iter().flat_map(|(node, dof, coefficient)| {
            self.terms(*node, *dof).iter().map(move |(k, t)| (*k, t * coefficient))
        }))
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

    /// The map of `model`, whose node indices and geometry are known to be sound.
    pub(super) fn new(model: &Model) -> Result<Self> {
        let masters = resolve_links(model)?;
        let mut spaces = active_spaces(model);
        let lengths = lead(model, &masters, &mut spaces);

        let mut held = vec![[false; 6]; model.nodes.len()];
        for support in &model.supports {
            for node in &support.nodes {
                for (h, s) in held[*node].iter_mut().zip(support.held) {
                    *h |= s;
                }
            }
        }
        let mut free = Vec::new();
        let mut first = vec![0; model.nodes.len() + 1];
        for node in 0..model.nodes.len() {
            first[node] = free.len();
            if masters[node] == node {
                let directions = spaces[node].free_directions(held[node], lengths[node]);
                free.extend(directions.into_iter().map(|direction| FreeDof { node, direction }));
            }
        }
        first[model.nodes.len()] = free.len();
        if free.is_empty() {
            return Err(Error::input(
                Fault::new("supports", "every degree of freedom held", "at least one that can move")
                    .with_help("Release a support, or add a part with stiffness and mass"),
            ));
        }

        let mut starts = Vec::with_capacity(6 * model.nodes.len() + 1);
        let mut terms = Vec::with_capacity(free.len());
        starts.push(0);
        for node in 0..model.nodes.len() {
            let master = masters[node];
            let arm = Vector3::from(model.nodes[node]) - Vector3::from(model.nodes[master]);
            let motions: Vec<(usize, [f64; 6])> =
                (first[master]..first[master + 1]).map(|k| (k, moved(&free[k].direction, &arm))).collect();
            for dof in 0..6 {
                terms.extend(motions.iter().filter(|(_, m)| m[dof] != 0.0).map(|(k, m)| (*k, m[dof])));
                starts.push(terms.len());
            }
        }
        Ok(DofMap { nodes: model.nodes.clone(), free, starts, terms })
    }
}

/// The last master of every node; its own number for a node that follows none.
fn resolve_links(model: &Model) -> Result<Vec<usize>> {
    let mut faults = Faults::new();
    let mut leader: Vec<usize> = (0..model.nodes.len()).collect();
    for (k, link) in model.links.iter().enumerate() {
        let place = format!("rigid link {}", k + 1);
        for slave in &link.slaves {
            if *slave == link.master {
                faults.push(Fault::new(
                    &place,
                    format!("node {} as its own slave", slave + 1),
                    "slaves other than the master",
                ));
            } else if leader[*slave] != *slave && leader[*slave] != link.master {
                faults.push(
                    Fault::new(
                        &place,
                        format!("node {} that already follows node {}", slave + 1, leader[*slave] + 1),
                        "one master for each slave",
                    )
                    .with_help("Link the two masters instead"),
                );
            } else {
                leader[*slave] = link.master;
            }
        }
    }
    let mut masters = leader.clone();
    for (node, master) in masters.iter_mut().enumerate() {
        let mut steps = 0;
        while leader[*master] != *master && steps <= leader.len() {
            *master = leader[*master];
            steps += 1;
        }
        if steps > leader.len() {
            faults.push(Fault::new(
                "rigid links",
                format!("a circle through node {}", node + 1),
                "a master that follows no one in the end",
            ));
            return faults.into_result(Vec::new());
        }
    }
    let on_slaves = |support: &super::model::Support| {
        if !support.held.contains(&true) {
            return None;
        }
        support.nodes.iter().copied().find(|node| masters[*node] != *node)
    };
    for (k, support) in model.supports.iter().enumerate() {
        if let Some(node) = on_slaves(support) {
            faults.push(
                Fault::new(
                    format!("support {}", k + 1),
                    format!("node {} held, which follows node {} rigidly", node + 1, masters[node] + 1),
                    "supports on free nodes or masters",
                )
                .with_help(format!("Hold the master, node {}", masters[node] + 1)),
            );
        }
    }
    faults.into_result(masters)
}

/// The directions in which something acts on a node: an orthonormal basis.
#[derive(Debug, Clone, Default)]
struct Space {
    basis: Vec<SVector<f64, 6>>,
}

impl Space {
    fn is_full(&self) -> bool {
        self.basis.len() == 6
    }

    fn fill(&mut self) {
        if !self.is_full() {
            self.basis = (0..6).map(|k| SVector::<f64, 6>::ith(k, 1.0)).collect();
        }
    }

    /// Adds a direction unless it is (nearly) among those there are.
    fn add(&mut self, direction: SVector<f64, 6>) {
        let norm = direction.norm();
        if self.is_full() || norm == 0.0 {
            return;
        }
        let mut rest = direction / norm;
        // Twice, so that the basis is orthogonal to round-off.
        for _ in 0..2 {
            for b in &self.basis {
                rest -= b * b.dot(&rest);
            }
        }
        if rest.norm() > SAME_DIRECTION {
            self.basis.push(rest.normalize());
        }
    }

    /// The directions left free by `held`. The space's rotations are scaled by `length` (they are θ · length).
    fn free_directions(&self, held: [bool; 6], length: f64) -> Vec<[f64; 6]> {
        if self.is_full() {
            let free = (0..6).filter(|k| !held[*k]);
            return free.map(|k| std::array::from_fn(|i| f64::from(u8::from(i == k)))).collect();
        }
        let mut projector =
            self.basis.iter().fold(SMatrix::<f64, 6, 6>::zeros(), |sum, b| sum + b * b.transpose());
        let mut count = self.basis.len();
        // Within the space, the motion that an axis sees is that axis projected onto it; a held axis takes it away.
        for k in (0..6).filter(|k| held[*k]) {
            let seen = projector.column(k).into_owned();
            if seen.norm() > ROUND_OFF {
                let seen = seen.normalize();
                projector -= seen * seen.transpose();
                count -= 1;
            }
        }
        // The basis nearest to the axes: the axis that the space holds best, projected, then the rest.
        let mut directions = Vec::with_capacity(count);
        for _ in 0..count {
            let best =
                (0..6).fold(0, |b, k| if projector[(k, k)] > projector[(b, b)] + ROUND_OFF { k } else { b });
            let axis = projector.column(best).normalize();
            projector -= axis * axis.transpose();
            let mut direction: [f64; 6] =
                std::array::from_fn(|i| if axis[i].abs() < ROUND_OFF { 0.0 } else { axis[i] });
            if direction.iter().filter(|d| **d != 0.0).count() == 1 {
                direction[best] = 1.0;
            }
            if direction[..3].iter().any(|d| *d != 0.0) {
                direction[3..].iter_mut().for_each(|d| *d /= length);
            }
            directions.push(direction);
        }
        directions
    }
}

/// What acts on every node through the elements that use it.
fn active_spaces(model: &Model) -> Vec<Space> {
    let mut spaces = vec![Space::default(); model.nodes.len()];
    for part in &model.shells {
        for triangle in part.faces.iter().flat_map(split_face) {
            if !part.bending_only {
                triangle.nodes.iter().for_each(|n| spaces[*n].fill());
                continue;
            }
            if triangle.nodes.iter().all(|n| spaces[*n].is_full()) {
                continue;
            }
            if let Some(shell) = FlatShell::new(&triangle.nodes.map(|n| model.nodes[n])) {
                let frame = &shell.triangle().frame;
                let axis = |row: usize, offset: usize| {
                    let mut a = SVector::<f64, 6>::zeros();
                    a.fixed_rows_mut::<3>(offset).copy_from(&frame.row(row).transpose());
                    a
                };
                for node in triangle.nodes {
                    [axis(2, 0), axis(0, 3), axis(1, 3)].into_iter().for_each(|a| spaces[node].add(a));
                }
            }
        }
    }
    for node in model.bars.iter().flat_map(|part| part.elements.iter().flatten()) {
        spaces[*node].fill();
    }
    for point in &model.masses {
        for (k, mass) in mass_diagonal(point).into_iter().enumerate() {
            if mass > 0.0 {
                spaces[point.node].add(SVector::<f64, 6>::ith(k, 1.0));
            }
        }
    }
    for spring in model.springs.iter().filter(|s| s.stiffness != 0.0 || s.damping != 0.0) {
        if let Some(a) = spring_direction(spring) {
            for node in std::iter::once(spring.node).chain(spring.other) {
                spaces[node].add(SVector::from(a));
            }
        }
    }
    spaces
}

/// Hands what acts on slaves to their masters; gives for every node the length by which its rotations are scaled.
fn lead(model: &Model, masters: &[usize], spaces: &mut [Space]) -> Vec<f64> {
    let mut lengths = vec![0.0_f64; masters.len()];
    let arm =
        |slave: usize, master: usize| Vector3::from(model.nodes[slave]) - Vector3::from(model.nodes[master]);
    for (slave, master) in masters.iter().enumerate() {
        lengths[*master] = lengths[*master].max(arm(slave, *master).norm());
    }
    for length in lengths.iter_mut().filter(|l| **l == 0.0) {
        *length = 1.0;
    }
    // A master's own directions in its scaled rotations: they are purely translations or rotations, unit either way.
    for (slave, master) in masters.iter().enumerate().filter(|(s, m)| s != *m) {
        let acting = std::mem::take(&mut spaces[slave].basis);
        if acting.len() == 6 {
            spaces[*master].fill();
        }
        let r = arm(slave, *master);
        for a in acting {
            // a · u_s = a_t · u_m + (a_r + r × a_t) · θ_m.
            let (force, moment) = (a.fixed_rows::<3>(0).into_owned(), a.fixed_rows::<3>(3).into_owned());
            let moment = (moment + r.cross(&force)) / lengths[*master];
            let mut handed = SVector::<f64, 6>::zeros();
            handed.fixed_rows_mut::<3>(0).copy_from(&force);
            handed.fixed_rows_mut::<3>(3).copy_from(&moment);
            spaces[*master].add(handed);
        }
    }
    lengths
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
