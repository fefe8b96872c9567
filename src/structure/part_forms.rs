//! What each part of a model has of φᵀ M φ, φᵀ K φ, φᵀ C φ and φᵀ H φ: the energies of a motion, and what damps it.
//!
//! A = Σ A_p over the parts p. Where only elements of part p couple a degree of freedom i, (A φ)_i = (A_p φ)_i, which the sparse product
//! has; only elements at rows where parts meet are formed again. No matrix of a part is kept, and the sum over the parts is
//! φᵀ A φ but for rounding.

use super::assembly::{Assembled, Workspace};
use super::model::Model;
use super::part::AnyElement;
use super::scatter::coupled_dofs;
use crate::linalg::sparse::times;
use faer::{Mat, MatRef};
use rayon::prelude::*;

/// Shapes whose products are held at once.
const PANEL: usize = 16;
/// Elements whose forms are held at once.
const CHUNK: usize = 4096;

/// Whose elements couple a degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Owner {
    Nothing,
    Part(usize),
    Several,
}

/// An element at a degree of freedom that several parts couple.
struct Meeting<'a> {
    part: usize,
    element: AnyElement<'a>,
    coupled: Vec<usize>,
}

/// The quadratic forms of a model by its parts; masses and springs are as one more part, the last.
pub struct PartForms<'a> {
    assembled: &'a Assembled,
    n_parts: usize,
    owners: Vec<Owner>,
    meetings: Vec<Meeting<'a>>,
}

/// One of the symmetric matrices of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartMatrix {
    /// M \[kg\].
    Mass,
    /// K without geometric stiffness \[N/m\].
    Stiffness,
    /// C: Rayleigh damping and dashpots \[N s/m\].
    Viscous,
    /// H: loss factors \[N/m\].
    Hysteretic,
}

impl<'a> PartForms<'a> {
    /// Those of `model`, from which `assembled` was made.
    pub fn new(model: &'a Model, assembled: &'a Assembled) -> Self {
        let dofs = &assembled.dofs;
        let n_parts = model.parts.len() + 1;
        let mut owners = vec![Owner::Nothing; dofs.n_dofs()];
        for part in 0..n_parts {
            let elements = model.elements_of(part);
            let lists: Vec<Vec<usize>> =
                elements.par_iter().map(|element| coupled_dofs(dofs, element.as_ref())).collect();
            for dof in lists.into_iter().flatten() {
                let owner = &mut owners[dof];
                *owner = match *owner {
                    Owner::Nothing => Owner::Part(part),
                    Owner::Part(other) if other == part => Owner::Part(part),
                    _ => Owner::Several,
                };
            }
        }
        let at_meeting = |coupled: &[usize]| coupled.iter().any(|dof| owners[*dof] == Owner::Several);
        let meetings = (0..n_parts).flat_map(|part| {
            let elements = model.elements_of(part).into_par_iter().filter_map(|element| {
                let coupled = coupled_dofs(dofs, element.as_ref());
                at_meeting(&coupled).then_some(Meeting { part, element, coupled })
            });
            elements.collect::<Vec<_>>()
        });
        let meetings = meetings.collect();
        PartForms { assembled, n_parts, owners, meetings }
    }

    /// φᵀ A_p φ of every part (a row) and of every one of `shapes` (a column), for each of some matrices A: zero where the model has no
    /// such matrix.
    ///
    /// # Panics
    /// When the shapes have another number of rows than the model has degrees of freedom.
    pub fn of<const K: usize>(&self, matrices: [PartMatrix; K], shapes: MatRef<'_, f64>) -> [Mat<f64>; K] {
        let structure = &self.assembled.structure;
        let mut sums = matrices.map(|_| Mat::zeros(self.n_parts, shapes.ncols()));
        for start in (0..shapes.ncols()).step_by(PANEL) {
            let panel = shapes.subcols(start, PANEL.min(shapes.ncols() - start));
            for (which, sum) in matrices.iter().zip(&mut sums) {
                let matrix = match which {
                    PartMatrix::Mass => Some(&structure.mass),
                    PartMatrix::Stiffness => Some(&self.assembled.stiffness),
                    PartMatrix::Viscous => structure.damping.viscous.as_ref(),
                    PartMatrix::Hysteretic => structure.damping.hysteretic.as_ref(),
                };
                let Some(matrix) = matrix else { continue };
                let product = times(matrix, panel);
                for c in 0..panel.ncols() {
                    let column = panel.col(c).iter().zip(product.col(c).iter());
                    for (owner, (x, y)) in self.owners.iter().zip(column) {
                        if let Owner::Part(part) = owner {
                            sum[(*part, start + c)] += x * y;
                        }
                    }
                }
            }
            for chunk in self.meetings.chunks(CHUNK) {
                let forms: Vec<Vec<f64>> = chunk
                    .par_iter()
                    .map_init(Workspace::default, |workspace, meeting| {
                        self.of_element(workspace, meeting, matrices, panel)
                    })
                    .collect();
                for (meeting, forms) in chunk.iter().zip(forms) {
                    for (sum, forms) in sums.iter_mut().zip(forms.chunks_exact(panel.ncols())) {
                        forms.iter().enumerate().for_each(|(c, f)| sum[(meeting.part, start + c)] += f);
                    }
                }
            }
        }
        sums
    }

    /// Σ φ_i (A_e φ)_i over the rows i of an element that several parts couple: of each matrix, of each shape.
    fn of_element<const K: usize>(
        &self,
        workspace: &mut Workspace,
        Meeting { element, coupled, .. }: &Meeting<'_>,
        matrices: [PartMatrix; K],
        shapes: MatRef<'_, f64>,
    ) -> Vec<f64> {
        let size = coupled.len();
        let mut small: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; size * size]);
        let mut all = small.each_mut().map(Vec::as_mut_slice);
        workspace.add_matrices(&self.assembled.dofs, element.as_ref(), coupled, &mut all);
        let rows: Vec<usize> = (0..size).filter(|i| self.owners[coupled[*i]] == Owner::Several).collect();
        let of = |which: PartMatrix, c: usize| -> f64 {
            let values = &small[which as usize];
            let x = |i: usize| shapes[(coupled[i], c)];
            // Symmetric: row i is column i.
            let along = |i: &usize| -> f64 {
                x(*i) * values[i * size..][..size].iter().enumerate().map(|(j, a)| a * x(j)).sum::<f64>()
            };
            rows.iter().map(along).sum()
        };
        matrices
            .iter()
            .flat_map(|which| (0..shapes.ncols()).map(move |c| (*which, c)))
            .map(|(w, c)| of(w, c))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::STEEL;
    use super::super::*;
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::random::Random;
    use crate::linalg::sparse::quadratic_forms;
    use crate::mesh::generate::structured_box;
    use crate::mesh::{Cell, CellKind};

    /// Two plates that share an edge, a bar on a rigid link, a mass on a spring, and a solid by itself; the loss factor and α of one part alone are 1.
    fn model(alone: Option<usize>) -> Model {
        let material = |k: usize| Material {
            loss_factor: f64::from(alone == Some(k)),
            rayleigh: RayleighDamping { alpha: f64::from(alone == Some(k)), beta: 0.0 },
            ..STEEL
        };
        let id = |i: usize, j: usize| i * 4 + j;
        let mut nodes: Vec<[f64; 3]> =
            (0..28).map(|k| [0.01 * (k / 4) as f64, 0.01 * (k % 4) as f64, 0.0]).collect();
        let faces = |range: std::ops::Range<usize>| -> Vec<Cell> {
            let quad = |i: usize, j: usize| [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            range.flat_map(|i| (0..3).map(move |j| Cell::quadrilateral(quad(i, j)))).collect()
        };
        nodes.extend([[0.08, 0.01, 0.01], [0.12, 0.01, 0.02]]);
        let box_mesh = structured_box(CellKind::Hexahedron8, [0.02, 0.02, 0.01], [2, 2, 1]).unwrap();
        let first = nodes.len();
        nodes.extend(box_mesh.nodes.iter().map(|[x, y, z]| [x + 1.0, *y, *z]));
        let solids: Vec<Cell> = box_mesh
            .elements
            .iter()
            .filter(|c| c.dimension() == 3)
            .map(|c| c.renumbered(|node| node + first))
            .collect();
        let section = Section::round(0.004);
        Model {
            nodes,
            parts: vec![
                Part::new("left", faces(0..3), Shell::new(material(0), 1e-3)),
                Part::new("right", faces(3..6), Shell::new(material(1), 2e-3)),
                Part::new(
                    "bar",
                    vec![Cell::line([28, 29])],
                    Bar { material: material(2), section, orientation: [0.0, 0.0, 1.0] },
                ),
                Part::new("solid", solids, Solid::new(material(3))),
            ],
            masses: vec![PointMass { node: 29, mass: 0.2, inertia: [1e-6; 3] }],
            springs: vec![Spring {
                node: 29,
                other: Some(5),
                direction: [0.0, 0.0, 1.0],
                rotational: false,
                stiffness: 1e4,
                damping: 2.0,
            }],
            links: vec![RigidLink { master: 28, slaves: vec![24, 25, 26] }],
            ..Model::default()
        }
    }

    /// Against the matrices of a model in which one part alone has a loss factor of 1, H = K_p, and α = 1, C = M_p beside the dashpots.
    #[test]
    fn the_forms_of_a_part_are_those_of_its_own_matrices_and_add_up() {
        let whole = model(None);
        let assembled = assemble(&whole).unwrap();
        let mut random = Random::new();
        let shapes = Mat::from_fn(assembled.dofs.n_dofs(), 19, |_, _| random.next());
        let [mass, stiffness, viscous, loss] = PartForms::new(&whole, &assembled).of(
            [PartMatrix::Mass, PartMatrix::Stiffness, PartMatrix::Viscous, PartMatrix::Hysteretic],
            shapes.as_ref(),
        );
        let near = |a: f64, b: f64, size: f64| within((a - b).abs(), 1e-11 * size, RoundOff);
        let [kinetic, strain] = [&assembled.structure.mass, &assembled.structure.stiffness]
            .map(|matrix| quadratic_forms(matrix, shapes.as_ref()));
        for c in 0..shapes.ncols() {
            let sum = |forms: &Mat<f64>| (0..5).map(|p| forms[(p, c)]).sum::<f64>();
            assert!(near(sum(&mass), kinetic[c], kinetic[c]) && near(sum(&stiffness), strain[c], strain[c]));
            assert!((0..5).all(|p| mass[(p, c)] > 0.0 && stiffness[(p, c)] > 0.0 && loss[(p, c)] == 0.0));
            assert!((0..4).all(|p| viscous[(p, c)] == 0.0) && viscous[(4, c)] > 0.0);
        }
        for part in 0..4 {
            let other = assemble(&model(Some(part))).unwrap();
            let damping = &other.structure.damping;
            let own_k = quadratic_forms(damping.hysteretic.as_ref().unwrap(), shapes.as_ref());
            let own_m = quadratic_forms(damping.viscous.as_ref().unwrap(), shapes.as_ref());
            for c in 0..shapes.ncols() {
                assert!(near(stiffness[(part, c)], own_k[c], strain[c]), "{part}");
                assert!(near(mass[(part, c)], own_m[c] - viscous[(4, c)], kinetic[c]), "{part}");
            }
        }
    }
}
