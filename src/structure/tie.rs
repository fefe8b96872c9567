//! Ties: nodes of one surface follow another one, whose mesh does not match.
//!
//! A slave point p is projected on the nearest point x̄ of the faces of the master and moves with it as one rigid body,
//! u(p) = ū + θ̄ × (p − x̄): gaps stay as they are, and rigid motions are met exactly. Where faces meet, x̄ is on each of them and the
//! motion is the mean.
//!
//! * On a solid ū = Σ N_i(ξ) u_i, and θ̄ is the rotation of its face: with the gradients g_i of N_i along the face, its normal n and
//!   W = Σ g_i × u_i, θ̄ = W − ½ n (n·W): the slopes of the face, and half the curl about its normal. It counts where there is a gap.
//! * On a shell ū and θ̄ are those of its mid-surface, by its elements.
//!
//! What follows:
//! * the nodes of a solid with ux, uy, uz;
//! * the face of a shell: the point of the plate nearest to the master, c along the normal m of the plate, |c| ≤ h/2, so that
//!   u_s = u(p) − c θ_s × m; rotations of the plate stay its own;
//! * the edge of a shell on a solid: two points at ±h/2 along m, so that u_s is their mean, the rotation across m is
//!   m × (u₊ − u₋)/h, and the one about m that of the face, the mean of θ̄ at both;
//! * the edge of a shell on a shell: u_s and all of θ_s = θ̄.

use super::elements::{FacePoint, FlatTriangle, on_triangles, split_face};
use super::model::Constraint;
use super::part::Part;
use super::properties::PlateTheory;
use crate::mesh::{Cell, FaceTree, LocatedPoint, cell_nodes};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// `within` where it is not said, as a share of the mean size of the master's faces.
const WITHIN: f64 = 0.1;
/// Gaps below this share of the mean size of the master's faces are none.
const NO_GAP: f64 = 1e-6;
/// Barycentric coordinates below this are of points on a side.
const ON_SIDE: f64 = 1e-6;
/// Coefficients below this share of the largest of a sum are rounding.
const ROUNDING: f64 = 1e-13;

/// Two surfaces to be tied.
#[derive(Debug, Clone, Copy)]
pub struct Tie<'a> {
    /// Coordinates of all nodes \[m\].
    pub nodes: &'a [[f64; 3]],
    /// The solid or shell that follows.
    pub slave: &'a Part,
    /// What of it: faces, or lines on the edge of a shell.
    pub cells: &'a [Cell],
    /// The solid or shell that leads.
    pub master: &'a Part,
    /// Faces of it.
    pub faces: &'a [Cell],
    /// The largest gap of nodes that follow \[m\]; a tenth of the mean size of the master's faces when absent.
    pub within: Option<f64>,
}

/// The constraints of a tie, and the nodes that it joins and leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct Tied {
    /// One constraint for each slave degree of freedom.
    pub constraints: Vec<Constraint>,
    /// The nodes that follow.
    pub following: Vec<usize>,
    /// Nodes that the master has, too: they are joined anyway.
    pub shared: Vec<usize>,
    /// Nodes whose gap is larger than `within`, with the gap \[m\]: they do not follow.
    pub far: Vec<(usize, f64)>,
    /// The largest gap of the nodes that follow \[m\]; zero where it is round-off.
    pub largest_gap: f64,
    /// The largest gap that is tied \[m\].
    pub within: f64,
}

/// A linear form of the degrees of freedom of nodes.
type Form = BTreeMap<(usize, usize), f64>;

/// The motion of a point: ux, uy, uz, rx, ry, rz.
type Motion = [Form; 6];

/// The constraints of a tie.
pub fn tied(tie: &Tie<'_>) -> Tied {
    let tree = FaceTree::new(tie.nodes, tie.faces);
    let count = tie.faces.len().max(1) as f64;
    let size = (0..tie.faces.len()).map(|face| tree.size(face)).sum::<f64>() / count;
    let surface = Master { tie, tree };
    let own = cell_nodes(tie.cells);
    let normals = normals(tie.slave, tie.nodes, &own);
    let masters = cell_nodes(tie.faces);
    let mut found = Tied {
        constraints: Vec::new(),
        following: Vec::new(),
        shared: Vec::new(),
        far: Vec::new(),
        largest_gap: 0.0,
        within: tie.within.unwrap_or(WITHIN * size),
    };
    let is_edge = tie.cells.iter().any(|cell| cell.dimension() == 1);
    for node in own {
        if masters.binary_search(&node).is_ok() {
            found.shared.push(node);
            continue;
        }
        let x = Vector3::from(tie.nodes[node]);
        let feet = surface.tree.nearest(tie.nodes[node]);
        let Some(first) = feet.first() else { continue };
        // The point of a plate that is nearest to the master.
        let normal = normals.get(&node).copied().unwrap_or_default();
        let half = 0.5 * tie.slave.thickness();
        let to_foot = Vector3::from(first.position) - x;
        let arm = if is_edge { 0.0 } else { to_foot.dot(&normal).clamp(-half, half) };
        let gap = surface.gap(first, x + arm * normal);
        if gap > found.within {
            found.far.push((node, gap));
            continue;
        }
        found.following.push(node);
        if gap > NO_GAP * size {
            found.largest_gap = found.largest_gap.max(gap);
        }
        let slave = Slave { node, x, normal, half };
        let rows = match (tie.slave.as_shell(), is_edge) {
            (Some(_), true) => slave.edge(&surface),
            (Some(_), false) => slave.face(&surface, arm),
            (None, _) => slave.translations(surface.motion(x)),
        };
        found.constraints.extend(rows.into_iter().map(|(component, form)| constraint(node, component, form)));
    }
    found
}

fn constraint(node: usize, component: usize, form: Form) -> Constraint {
    let largest = form.values().fold(0.0_f64, |m, c| m.max(c.abs()));
    let kept = form.into_iter().filter(|(_, c)| c.abs() > ROUNDING * largest);
    Constraint { slave: (node, component), terms: kept.map(|((node, k), c)| (node, k, c)).collect() }
}

/// A node that follows.
struct Slave {
    node: usize,
    x: Vector3<f64>,
    /// m of a shell.
    normal: Vector3<f64>,
    /// h/2 of a shell \[m\].
    half: f64,
}

impl Slave {
    fn translations(&self, motion: Motion) -> Vec<(usize, Form)> {
        motion.into_iter().take(3).enumerate().collect()
    }

    /// u_s = u(p) − c θ_s × m.
    fn face(&self, master: &Master, arm: f64) -> Vec<(usize, Form)> {
        let mut rows = self.translations(master.motion(self.x + arm * self.normal));
        for (k, form) in &mut rows {
            let (i, j) = ((*k + 1) % 3, (*k + 2) % 3);
            add(form, -arm * self.normal[j], &one(self.node, 3 + i));
            add(form, arm * self.normal[i], &one(self.node, 3 + j));
        }
        rows
    }

    fn edge(&self, master: &Master) -> Vec<(usize, Form)> {
        if master.tie.master.as_shell().is_some() {
            return master.motion(self.x).into_iter().enumerate().collect();
        }
        let [up, down] = [1.0, -1.0].map(|side| master.motion(self.x + side * self.half * self.normal));
        let mut rows: Vec<(usize, Form)> = (0..3)
            .map(|k| {
                let mut mean = Form::new();
                add(&mut mean, 0.5, &up[k]);
                add(&mut mean, 0.5, &down[k]);
                (k, mean)
            })
            .collect();
        // Θ = m × (u₊ − u₋)/h.
        let m = self.normal;
        let rotation: Vec<Form> = (0..3)
            .map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                let mut form = Form::new();
                for (motion, sign) in [(&up, 0.5 / self.half), (&down, -0.5 / self.half)] {
                    add(&mut form, sign * m[i], &motion[j]);
                    add(&mut form, -sign * m[j], &motion[i]);
                }
                form
            })
            .collect();
        // With the rotation of the face about m.
        let mut about = Form::new();
        for motion in [&up, &down] {
            (0..3).for_each(|k| add(&mut about, 0.5 * m[k], &motion[3 + k]));
        }
        for (k, mut form) in rotation.into_iter().enumerate() {
            add(&mut form, m[k], &about);
            rows.push((3 + k, form));
        }
        rows
    }
}

fn one(node: usize, component: usize) -> Form {
    Form::from([((node, component), 1.0)])
}

/// Adds `factor` times a form.
fn add(to: &mut Form, factor: f64, form: &Form) {
    if factor != 0.0 {
        form.iter().for_each(|(at, c)| *to.entry(*at).or_default() += factor * c);
    }
}

/// The surface that leads.
struct Master<'a> {
    tie: &'a Tie<'a>,
    tree: FaceTree<'a>,
}

impl Master<'_> {
    /// The distance of a point from the surface at its foot \[m\], half the thickness of a shell off its mid-surface.
    fn gap(&self, foot: &LocatedPoint, p: Vector3<f64>) -> f64 {
        let [a, b] = self.tree.tangents(foot.face, foot.at).map(Vector3::from);
        let normal = a.cross(&b).try_normalize(0.0).unwrap_or_default();
        let way = p - Vector3::from(foot.position);
        let height = way.dot(&normal);
        let along = (way - height * normal).norm();
        along.hypot((height.abs() - 0.5 * self.tie.master.thickness()).max(0.0))
    }

    /// The motion of a point that the surface takes with it.
    fn motion(&self, p: Vector3<f64>) -> Motion {
        let feet = self.tree.nearest(p.into());
        let share = 1.0 / feet.len().max(1) as f64;
        let mut sum = Motion::default();
        for foot in &feet {
            let own = match self.tie.master.as_shell() {
                Some(_) => self.on_shell(foot),
                None => self.on_solid(foot),
            };
            let way = p - Vector3::from(foot.position);
            // Of a solid without a gap the rotation has no arm, and does not count.
            let way = if way.norm() <= NO_GAP * self.tree.size(foot.face) { Vector3::zeros() } else { way };
            for k in 0..3 {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                add(&mut sum[k], share, &own[k]);
                add(&mut sum[k], share * way[j], &own[3 + i]);
                add(&mut sum[k], -share * way[i], &own[3 + j]);
                add(&mut sum[3 + k], share, &own[3 + k]);
            }
        }
        sum
    }

    fn on_solid(&self, foot: &LocatedPoint) -> Motion {
        let cell = &self.tie.faces[foot.face];
        let kind = cell.kind();
        let [a, b] = self.tree.tangents(foot.face, foot.at).map(Vector3::from);
        let n = a.cross(&b);
        // The tangents' reciprocals along the face.
        let [along_a, along_b] = [b.cross(&n), n.cross(&a)].map(|v| v / n.norm_squared());
        let n = n.normalize();
        let mut shares = kind.shape_functions(foot.at);
        shares.iter_mut().filter(|share| share.abs() < ROUNDING).for_each(|share| *share = 0.0);
        let all: f64 = shares.iter().sum();
        let mut motion = Motion::default();
        for ((node, share), slope) in cell.nodes().iter().zip(shares).zip(kind.shape_gradients(foot.at)) {
            let g = slope[0] * along_a + slope[1] * along_b;
            for component in 0..3 {
                add(&mut motion[component], share / all, &one(*node, component));
                let turned = g.cross(&Vector3::ith(component, 1.0));
                let turned = turned - 0.5 * n.dot(&turned) * n;
                (0..3).for_each(|k| add(&mut motion[3 + k], turned[k], &one(*node, component)));
            }
        }
        motion
    }

    fn on_shell(&self, foot: &LocatedPoint) -> Motion {
        let cell = &self.tie.faces[foot.face];
        let mut motion = Motion::default();
        for (at, share) in on_triangles(self.tie.nodes, cell, foot.position) {
            let mut own = Motion::default();
            for (node, component, by) in self.tie.master.displacement_on(self.tie.nodes, cell, &at) {
                (0..6).for_each(|k| add(&mut own[k], by[k], &one(node, component)));
            }
            self.turn_linearly_about_sides(&at, &mut own);
            (0..6).for_each(|k| add(&mut motion[k], share, &own[k]));
        }
        motion
    }

    /// On the side of a thin plate the rotation about the side is linear between its ends, as the discrete Kirchhoff triangle has it; the slope
    /// of the cubic deflection across the side is not.
    fn turn_linearly_about_sides(&self, at: &FacePoint, motion: &mut Motion) {
        let thin = self.tie.master.as_shell().is_some_and(|shell| shell.theory == PlateTheory::Kirchhoff);
        let across = (0..3).find(|k| at.barycentric[*k].abs() < ON_SIDE);
        let Some(opposite) = across.filter(|_| thin) else { return };
        let [a, b] = [1, 2].map(|k| at.corners[(opposite + k) % 3]);
        let side = Vector3::from(self.tie.nodes[b]) - Vector3::from(self.tie.nodes[a]);
        let Some(side) = side.try_normalize(0.0) else { return };
        let mut change = Form::new();
        for k in 0..3 {
            for (corner, share) in at.corners.iter().zip(at.barycentric) {
                add(&mut change, side[k] * share, &one(*corner, 3 + k));
            }
            add(&mut change, -side[k], &motion[3 + k]);
        }
        (0..3).for_each(|k| add(&mut motion[3 + k], side[k], &change));
    }
}

/// The mean unit normal of a shell at some of its nodes, ascending; none of other parts.
fn normals(part: &Part, nodes: &[[f64; 3]], of: &[usize]) -> BTreeMap<usize, Vector3<f64>> {
    let mut sums: BTreeMap<usize, Vector3<f64>> = BTreeMap::new();
    if part.as_shell().is_none() {
        return sums;
    }
    for triangle in part.cells.iter().flat_map(split_face) {
        let Some(flat) = FlatTriangle::new(&triangle.nodes.map(|node| nodes[node])) else { continue };
        for node in triangle.nodes.iter().filter(|node| of.binary_search(node).is_ok()) {
            *sums.entry(*node).or_default() += triangle.weight * flat.area * Vector3::from(flat.normal());
        }
    }
    sums.values_mut().for_each(|sum| *sum = sum.try_normalize(0.0).unwrap_or_default());
    sums
}
