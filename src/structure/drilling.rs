//! The rotation about the normal of a membrane where an edge is clamped or follows a rigid body.

use super::elements::{FlatTriangle, split_face};
use super::model::Model;
use crate::mesh::Cell;
use nalgebra::Vector3;

/// Normals of elements at one node that differ by less than this angle \[rad\] are those of one surface.
const SMOOTH: f64 = 0.2;
/// Components of a normal below this part are none: what is held along such an axis does not hold along the normal.
const ACROSS: f64 = 1e-3;
/// Components of unit directions below this are round-off.
const ROUND_OFF: f64 = 1e-12;

/// Nodes whose rotation about the normal n of the membranes that meet there stays free, though all else is held or follows.
///
/// That rotation of a continuum is θ_n = ½(∂v/∂x − ∂u/∂y). Along an edge with u = v = 0 it is half the shear strain γ, which a
/// clamp does not prevent: θ_n = 0 would be a natural condition too many, and an in-plane frequency converges to its value by one
/// order less. It stays free where the displacements of the edge leave no doubt about its rigid rotation, which takes two nodes of
/// one element, and where nothing but membranes of one smooth surface takes moments about n. An element between nodes that
/// all move as one rigid body has no strain and takes their own rotation.
#[derive(Debug, Clone)]
pub(super) struct Drilling {
    /// n of each node; `None` where the rotation about it is held or follows as all others.
    normals: Vec<Option<[f64; 3]>>,
    /// The rigid body that each node is part of: its master, or the ground.
    bodies: Vec<Option<usize>>,
}

impl Drilling {
    /// Those of `model`, whose nodes have the last masters `masters` and are `held` by supports.
    pub(super) fn new(model: &Model, masters: &[usize], held: &[[bool; 6]]) -> Self {
        let n = model.nodes.len();
        let ground = n;
        let normals = surface_normals(model);
        let mut leads = vec![false; n];
        masters
            .iter()
            .enumerate()
            .filter(|(slave, master)| slave != *master)
            .for_each(|(_, m)| leads[*m] = true);
        let mut turned = vec![false; n];
        let bars = model.parts.iter().filter(|part| part.kind.dimension() == 1).flat_map(|part| &part.cells);
        bars.flat_map(Cell::nodes).for_each(|node| turned[*node] = true);
        for spring in model.springs.iter().filter(|spring| spring.rotational) {
            turned[spring.node] = true;
            spring.other.iter().for_each(|node| turned[*node] = true);
        }
        let inert = model.masses.iter().filter(|mass| mass.inertia != [0.0; 3]);
        inert.for_each(|mass| turned[mass.node] = true);

        let fixed_in_plane = |held: &[bool; 6], normal: &[f64; 3]| {
            (0..3).all(|k| held[k] || 1.0 - normal[k].powi(2) < ACROSS.powi(2))
        };
        let fixed_about =
            |held: &[bool; 6], normal: &[f64; 3]| (0..3).all(|k| held[3 + k] || normal[k].abs() < ACROSS);
        let body = |node: usize| match normals[node] {
            _ if masters[node] != node || leads[node] => Some(masters[node]),
            Some(normal) if fixed_in_plane(&held[node], &normal) => Some(ground),
            None if held[node][..3] == [true; 3] => Some(ground),
            _ => None,
        };
        let bodies: Vec<Option<usize>> = (0..n).map(body).collect();
        // Whether an element joins a node to another of its body, and to one that is none of it.
        let (mut along, mut beyond) = (vec![false; n], vec![false; n]);
        let faces = model.shells().filter(|(_, shell)| !shell.bending_only).flat_map(|(part, _)| &part.cells);
        for nodes in faces.map(Cell::nodes) {
            for node in nodes.iter().filter(|node| bodies[**node].is_some()) {
                for other in nodes.iter().filter(|other| *other != node) {
                    let same = bodies[*other] == bodies[*node];
                    along[*node] |= same;
                    beyond[*node] |= !same;
                }
            }
        }
        let free = |node: usize| {
            let normal = normals[node]?;
            let follows = masters[node] != node;
            let stuck = follows || (bodies[node] == Some(ground) && fixed_about(&held[node], &normal));
            (stuck && along[node] && beyond[node] && !turned[node]).then_some(normal)
        };
        Drilling { normals: (0..n).map(free).collect(), bodies }
    }

    /// None at all.
    pub(super) fn none() -> Self {
        Drilling { normals: Vec::new(), bodies: Vec::new() }
    }

    /// n of a node whose rotation about it is free.
    pub(super) fn normal(&self, node: usize) -> Option<[f64; 3]> {
        self.normals.get(node).copied().flatten()
    }

    /// Whether all nodes of an element move as one rigid body.
    pub(super) fn is_rigid(&self, nodes: &[usize]) -> bool {
        let body = |node: &usize| self.bodies.get(*node).copied().flatten();
        nodes.len() > 2 && body(&nodes[0]).is_some() && nodes.iter().all(|node| body(node) == body(&nodes[0]))
    }
}

/// The unit normal at every node where plates, a membrane among them, meet in one smooth surface.
fn surface_normals(model: &Model) -> Vec<Option<[f64; 3]>> {
    let mut sums = vec![Vector3::zeros(); model.nodes.len()];
    let mut membrane = vec![false; model.nodes.len()];
    let mut triangles = Vec::new();
    for (part, shell) in model.shells() {
        for triangle in part.cells.iter().flat_map(split_face) {
            let Some(flat) = FlatTriangle::new(&triangle.nodes.map(|node| model.nodes[node])) else {
                continue;
            };
            let normal = Vector3::from(flat.normal());
            triangles.push((triangle.nodes, normal));
            for node in triangle.nodes {
                // Parts need not be turned the same way.
                let sign = if sums[node].dot(&normal) < 0.0 { -1.0 } else { 1.0 };
                sums[node] += sign * triangle.weight * flat.area * normal;
                membrane[node] |= !shell.bending_only;
            }
        }
    }
    let units: Vec<Vector3<f64>> =
        sums.iter().map(|sum| sum.try_normalize(0.0).unwrap_or_default()).collect();
    let mut smooth = membrane;
    for (nodes, normal) in triangles {
        nodes.into_iter().for_each(|node| smooth[node] &= normal.dot(&units[node]).abs() > SMOOTH.cos());
    }
    let tidy = |unit: &Vector3<f64>| -> [f64; 3] {
        let largest = unit[unit.iamax()];
        std::array::from_fn(|k| match unit[k] {
            v if v.abs() < ROUND_OFF => 0.0,
            v if 1.0 - v.abs() < ROUND_OFF => 1.0,
            v => v * largest.signum(),
        })
    };
    units.iter().zip(smooth).map(|(unit, smooth)| smooth.then(|| tidy(unit))).collect()
}

#[cfg(test)]
mod tests {
    use super::super::samples::STEEL;
    use super::super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::random::Random;
    use crate::linalg::sparse::multiply_vector;
    use crate::mesh::Cell;
    use nalgebra::{Rotation3, Vector3};

    /// A plate of 4 × 3 cells of random sizes, in a random plane, of triangles or quadrilaterals: its model without supports, the
    /// nodes of the edge x = 0, and the axes of its plane.
    fn plate(
        random: &mut Random,
        triangles: bool,
        theory: PlateTheory,
    ) -> (Model, Vec<usize>, Rotation3<f64>) {
        let (across, along) = (4, 3);
        let turn = Rotation3::from_euler_angles(
            random.between(-3.0, 3.0),
            random.between(-1.5, 1.5),
            random.between(-3.0, 3.0),
        );
        let mut nodes = Vec::new();
        for i in 0..=across {
            for j in 0..=along {
                let inside = i > 0 && i < across && j > 0 && j < along;
                let mut shift = || if inside { random.between(-0.2, 0.2) } else { 0.0 };
                let flat = Vector3::new(0.1 * (i as f64 + shift()), 0.08 * (j as f64 + shift()), 0.0);
                nodes.push((turn * flat).into());
            }
        }
        let mut faces = Vec::new();
        for i in 0..across {
            for j in 0..along {
                let [a, b, c, d] =
                    [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| i * (along + 1) + j);
                if triangles {
                    faces.extend([Cell::triangle([a, b, c]), Cell::triangle([a, c, d])]);
                } else {
                    faces.push(Cell::quadrilateral([a, b, c, d]));
                }
            }
        }
        let part = Part::new("plate", faces, Shell { theory, ..Shell::new(STEEL, 2e-3) });
        (Model { nodes, parts: vec![part], ..Model::default() }, (0..=along).collect(), turn)
    }

    /// Uniform shear v = γ x beside a clamped or a rigid edge turns the material by γ/2 right up to it: the strain energy is ½ G γ² V.
    #[test]
    fn uniform_shear_reaches_a_clamped_edge_and_a_rigid_one() {
        let mut random = Random::seeded(7);
        let gamma = 1e-3;
        let shear_modulus = STEEL.youngs_modulus / (2.0 * (1.0 + STEEL.poissons_ratio));
        let exact = 0.5 * shear_modulus * gamma * gamma * (0.4 * 0.24 * 2e-3);
        for k in 0..24 {
            let theory = if k % 2 == 0 { PlateTheory::Kirchhoff } else { PlateTheory::Mindlin };
            let (mut model, edge, turn) = plate(&mut random, k % 4 < 2, theory);
            match k % 3 {
                0 => model.supports.push(Support { nodes: edge, held: [true; 6] }),
                1 => {
                    let master = model.nodes.len();
                    model.nodes.push([random.between(-1.0, 1.0), 0.3, -0.2]);
                    model.links.push(RigidLink { master, slaves: edge });
                    model.supports.push(Support { nodes: vec![master], held: [true; 6] });
                }
                // Two rows of nodes: the elements between them have no strain.
                _ => {
                    let nodes: Vec<usize> = (0..8).collect();
                    model.supports.push(Support { nodes, held: [true; 6] });
                }
            }
            let rigid = if k % 3 == 2 {
                model.nodes[4..8].iter().map(|x| (turn.inverse() * Vector3::from(*x)).x).fold(0.0, f64::max)
            } else {
                0.0
            };
            if k % 3 == 2 {
                // The second row on one line.
                for node in 4..8 {
                    let mut flat = turn.inverse() * Vector3::from(model.nodes[node]);
                    flat.x = rigid;
                    model.nodes[node] = (turn * flat).into();
                }
            }
            let assembled = assemble(&model).unwrap();
            let field = |node: usize| -> [f64; 6] {
                let x = (turn.inverse() * Vector3::from(model.nodes[node])).x - rigid;
                let (u, w) =
                    (turn * Vector3::new(0.0, gamma * x, 0.0), turn * Vector3::new(0.0, 0.0, 0.5 * gamma));
                [u[0], u[1], u[2], w[0], w[1], w[2]]
            };
            let dofs = assembled.dofs.free_dofs();
            let q: Vec<f64> = dofs
                .iter()
                .map(|dof| field(dof.node).iter().zip(dof.direction).map(|(u, d)| u * d).sum())
                .collect();
            let force = multiply_vector(&assembled.structure.stiffness, &q);
            let energy = 0.5 * q.iter().zip(&force).map(|(q, f)| q * f).sum::<f64>();
            let expected = exact * (1.0 - rigid / 0.4);
            // Linear fields are exact: what is left is round-off.
            assert!(
                within((energy / expected - 1.0).abs(), 1e-9, RoundOff),
                "{k} {theory:?}: {energy:e} {expected:e}"
            );
        }
    }

    /// One node alone, a bar at the edge, and a support that leaves the plate free to turn about an edge point hold as before.
    #[test]
    fn a_rotation_that_something_needs_stays_held() {
        let mut random = Random::seeded(9);
        let (bare, edge, _) = plate(&mut random, true, PlateTheory::Kirchhoff);
        let all = 6 * bare.nodes.len();
        let count = |support: Vec<usize>, bar: bool| {
            let mut model = bare.clone();
            model.supports.push(Support { nodes: support, held: [true; 6] });
            if bar {
                let end = model.nodes.len();
                model.nodes.push([0.0, 0.0, 5.0]);
                let section = Section::round(0.01);
                model.parts.push(Part::new(
                    "bar",
                    vec![Cell::line([0, end])],
                    Bar { material: STEEL, section, orientation: [0.3, 1.0, 0.2] },
                ));
            }
            assemble(&model).unwrap().dofs.n_dofs()
        };
        assert_eq!(count(vec![0], false), all - 6);
        assert_eq!(count(edge.clone(), false), all - 5 * edge.len());
        assert_eq!(count(edge.clone(), true), all + 6 - 5 * edge.len() - 1);
    }
}
