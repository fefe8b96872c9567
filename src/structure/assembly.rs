//! M, C and K of a model on its free degrees of freedom: Tᵀ (Σ elements) T.

use super::check::check_model;
use super::dofs::DofMap;
use super::elements::{ElementMatrix, FiniteElement};
use super::material::{Material, RayleighDamping};
use super::model::Model;
use super::part::AnyElement;
use super::scatter::{Couplings, Pattern, Reduction};
use crate::error::{Error, Fault, Result};
use crate::linalg::{Engine, SparseMatrix};
use crate::system::{Damping, Prestress, Structure};
use std::sync::Arc;

/// A model's matrices, and how its free degrees of freedom relate to its nodes.
#[derive(Debug, Clone)]
pub struct Assembled {
    /// M, C (Rayleigh and dashpots), η K, K; modal damping is added when the modes are known.
    pub structure: Structure,
    /// u = T q.
    pub dofs: Arc<DofMap>,
    /// Mass of all parts and points \[kg\], held nodes included.
    pub total_mass: f64,
    /// Its centre \[m\]; the origin when there is no mass.
    pub center_of_mass: [f64; 3],
    /// K as it was assembled, whose pattern geometric stiffness takes.
    pub(super) stiffness: Arc<SparseMatrix>,
}

/// Assembles M, C and K of `model`.
///
/// M and K are symmetric to the last bit, share one sparsity pattern, and do not depend on the number of threads.
///
/// # Errors
/// Every fault of the model at once: see the rules of a valid [`Model`] (positive thickness, E > 0, −1 < ν < ½, ρ ≥ 0,
/// nodes that exist, elements with an extent, links without circles, supports on nodes that lead).
pub fn assemble(model: &Model) -> Result<Assembled> {
    check_model(model)?;
    let elements = model.elements();
    let dofs = DofMap::new(model, &elements)?;
    let couplings = Couplings::new(&dofs, &elements);
    let symbolic = couplings.pattern();
    let pattern = Pattern { couplings: &couplings, symbolic: symbolic.as_ref() };
    let [mass, stiffness, viscous, hysteretic] =
        pattern.sum(kinds(&elements), |work: &mut Workspace, p, coupled, small| {
            work.add_matrices(&dofs, elements[p].as_ref(), coupled, small);
        });
    let (mut total_mass, mut moment) = (0.0, [0.0; 3]);
    for element in &elements {
        let (mass, center) = element.mass_and_center();
        total_mass += mass;
        for (m, c) in moment.iter_mut().zip(center) {
            *m += mass * c;
        }
    }
    let center_of_mass = if total_mass > 0.0 { moment.map(|m| m / total_mass) } else { [0.0; 3] };
    let structure = Structure {
        mass: mass.unwrap_or_else(|| pattern.zero()).into(),
        stiffness: stiffness.unwrap_or_else(|| pattern.zero()).into(),
        damping: Damping {
            viscous: viscous.map(Into::into),
            modal: None,
            hysteretic: hysteretic.map(Into::into),
        },
        engine: Engine::default(),
    };
    let stiffness = Arc::clone(&structure.stiffness);
    Ok(Assembled { structure, dofs: Arc::new(dofs), total_mass, center_of_mass, stiffness })
}

/// Which of M, K, C and η K there are.
fn kinds(elements: &[AnyElement]) -> [bool; 4] {
    let (mut viscous, mut hysteretic) = (false, false);
    for element in elements {
        let damping = element.material().map_or((RayleighDamping::default(), 0.0), damping);
        viscous |= damping.0 != RayleighDamping::default() || element.has_dashpot();
        hysteretic |= damping.1 != 0.0;
    }
    [true, true, viscous, hysteretic]
}

fn damping(material: &Material) -> (RayleighDamping, f64) {
    (material.rayleigh, material.loss_factor)
}

/// Work arrays of the element loop.
#[derive(Debug, Default)]
pub(super) struct Workspace {
    reduction: Reduction,
    mass: ElementMatrix,
    stiffness: ElementMatrix,
    other: ElementMatrix,
}

impl Workspace {
    /// Adds M, K, C and η K of an element on the free degrees of freedom that it couples.
    pub fn add_matrices(
        &mut self,
        dofs: &DofMap,
        element: &dyn FiniteElement,
        coupled: &[usize],
        [mass, stiffness, viscous, hysteretic]: &mut [&mut [f64]; 4],
    ) {
        let Workspace { reduction, mass: m, stiffness: k, other } = self;
        reduction.set(dofs, element, coupled);
        for matrix in [&mut *m, &mut *k, &mut *other] {
            matrix.reset(element.n_freedoms());
        }
        let (has_mass, has_stiffness) = (element.mass(m), element.stiffness(k));
        if has_mass {
            reduction.apply(m, mass);
        }
        if has_stiffness {
            reduction.apply(k, stiffness);
        }
        let (rayleigh, loss_factor) = element.material().map_or((RayleighDamping::default(), 0.0), damping);
        if rayleigh != RayleighDamping::default() {
            other.set_sum([rayleigh.alpha, rayleigh.beta], [m, k]);
            reduction.apply(other, viscous);
        } else if element.dashpot(other) {
            reduction.apply(other, viscous);
        }
        if loss_factor != 0.0 {
            other.set_sum([0.0, loss_factor], [m, k]);
            reduction.apply(other, hysteretic);
        }
    }

    /// Adds K_σ of an element on the free degrees of freedom that it couples.
    fn add_geometric_stiffness(
        &mut self,
        dofs: &DofMap,
        element: &dyn FiniteElement,
        coupled: &[usize],
        displacement: &[[f64; 6]],
        small: &mut [f64],
    ) {
        self.other.reset(element.n_freedoms());
        if element.geometric_stiffness(displacement, &mut self.other) {
            self.reduction.set(dofs, element, coupled);
            self.reduction.apply(&self.other, small);
        }
    }
}

impl Assembled {
    /// The geometric stiffness of `model`, the one that was assembled, under a static displacement.
    pub fn prestress(&self, model: Model) -> GeometricStiffness {
        GeometricStiffness { model, dofs: Arc::clone(&self.dofs), stiffness: Arc::clone(&self.stiffness) }
    }
}

/// K_σ(u₀) of shells (their mean membrane forces) and bars (their axial forces), on the pattern of K.
///
/// Bending-only plates carry no membrane forces and give none. The turning of the lever arms of rigid links under
/// load is not part of it.
#[derive(Debug)]
pub struct GeometricStiffness {
    model: Model,
    dofs: Arc<DofMap>,
    /// K, for its pattern.
    stiffness: Arc<SparseMatrix>,
}

impl Prestress for GeometricStiffness {
    fn geometric_stiffness(&self, displacement: &[f64]) -> Result<SparseMatrix> {
        geometric_stiffness(&self.model, &self.dofs, &self.stiffness, displacement)
    }
}

/// K_σ of `model` under a static displacement of its degrees of freedom, on the pattern of its `stiffness`.
pub(super) fn geometric_stiffness(
    model: &Model,
    dofs: &DofMap,
    stiffness: &SparseMatrix,
    displacement: &[f64],
) -> Result<SparseMatrix> {
    if displacement.len() != dofs.n_dofs() || displacement.iter().any(|u| !u.is_finite()) {
        return Err(Error::input(Fault::new(
            "geometric stiffness",
            format!("a displacement of {} values, or one that is not finite", displacement.len()),
            format!("{} finite values", dofs.n_dofs()),
        )));
    }
    let u = dofs.expand(displacement);
    let elements = model.elements();
    let couplings = Couplings::new(dofs, &elements);
    let pattern = Pattern { couplings: &couplings, symbolic: stiffness.symbolic() };
    let [sum] = pattern.sum([true], |work: &mut Workspace, p, coupled, small| {
        work.add_geometric_stiffness(dofs, elements[p].as_ref(), coupled, &u, small[0]);
    });
    Ok(sum.unwrap_or_else(|| pattern.zero()))
}

#[cfg(test)]
mod tests {
    use super::super::*;
    use crate::bounds::{Origin::*, within};
    use crate::mesh::Cell;
    use crate::system::Prestress;

    /// A wavy strip of `n` × `n` quadrilaterals and triangles with a bar, a mass, a spring and a rigid link.
    fn strip(n: usize, theory: PlateTheory) -> Model {
        let material = Material {
            youngs_modulus: 70e9,
            poissons_ratio: 0.33,
            density: 2700.0,
            loss_factor: 0.01,
            rayleigh: RayleighDamping { alpha: 2.0, beta: 1e-7 },
            orthotropic: None,
        };
        let id = |i: usize, j: usize| i * (n + 1) + j;
        let mut nodes = Vec::new();
        for i in 0..=n {
            for j in 0..=n {
                let (x, y) = (i as f64 / n as f64, j as f64 / n as f64);
                nodes.push([x, y, 0.05 * (3.0 * x + y).sin()]);
            }
        }
        let mut faces = Vec::new();
        for i in 0..n {
            for j in 0..n {
                let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
                if (i + j) % 3 == 0 {
                    faces.push(Cell::quadrilateral([a, b, c, d]));
                } else {
                    faces.extend([Cell::triangle([a, b, c]), Cell::triangle([a, c, d])]);
                }
            }
        }
        let last = nodes.len();
        nodes.push([1.2, 0.5, 0.2]);
        nodes.push([1.5, 0.5, 0.4]);
        Model {
            nodes,
            parts: vec![
                Part::new("strip", faces, Shell { theory, ..Shell::new(material, 2e-3) }),
                Part::new(
                    "bar",
                    vec![Cell::line([last, last + 1])],
                    Bar { material, section: Section::round(0.01), orientation: [0.0, 1.0, 0.0] },
                ),
            ],
            masses: vec![PointMass { node: last + 1, mass: 0.3, inertia: [1e-4; 3] }],
            springs: vec![Spring {
                node: 0,
                other: Some(last + 1),
                direction: [1.0, 1.0, 0.0],
                rotational: false,
                stiffness: 1e5,
                damping: 3.0,
            }],
            links: vec![RigidLink { master: last, slaves: (0..=n).map(|j| id(n, j)).collect() }],
            supports: vec![Support {
                nodes: (0..=n).collect(),
                held: [true, true, true, false, true, false],
            }],
            ..Model::default()
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits_and_symmetry_is_exact() {
        same_bits(&strip(24, PlateTheory::Kirchhoff));
        same_bits(&strip(24, PlateTheory::Mindlin));
    }

    fn same_bits(model: &Model) {
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let assembled = assemble(model).unwrap();
                let u: Vec<f64> = (0..assembled.dofs.n_dofs()).map(|k| 1e-5 * (k as f64).sin()).collect();
                let k_sigma = assembled.prestress(model.clone()).geometric_stiffness(&u).unwrap();
                (assembled.structure, k_sigma)
            })
        };
        let ((one, one_sigma), (three, three_sigma)) = (with(1), with(3));
        for (a, b) in [
            (&one.mass, &three.mass),
            (&one.stiffness, &three.stiffness),
            (one.damping.viscous.as_ref().unwrap(), three.damping.viscous.as_ref().unwrap()),
            (one.damping.hysteretic.as_ref().unwrap(), three.damping.hysteretic.as_ref().unwrap()),
            (&one_sigma.into(), &three_sigma.into()),
        ] {
            assert_eq!(a.val(), b.val());
            assert_eq!(a.symbolic().row_idx(), b.symbolic().row_idx());
            assert!(a.val().iter().any(|v| *v != 0.0));
            let transposed = a.transpose().to_col_major().unwrap();
            assert_eq!(a.val(), transposed.val());
        }
    }

    #[test]
    fn geometric_stiffness_is_linear_and_free_of_rigid_displacements() {
        linear_and_free_of_rigid_displacements(strip(6, PlateTheory::Kirchhoff));
        linear_and_free_of_rigid_displacements(strip(6, PlateTheory::Mindlin));
    }

    fn linear_and_free_of_rigid_displacements(mut model: Model) {
        model.supports.clear();
        let assembled = assemble(&model).unwrap();
        let prestress = assembled.prestress(model);
        let u: Vec<f64> = (0..assembled.dofs.n_dofs()).map(|k| 1e-5 * (k as f64).cos()).collect();
        let a = prestress.geometric_stiffness(&u).unwrap();
        let twice = prestress.geometric_stiffness(&u.iter().map(|x| 2.0 * x).collect::<Vec<_>>()).unwrap();
        assert!(a.val().iter().zip(twice.val()).all(|(x, y)| 2.0 * x == *y));
        let size = a.val().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for rigid in assembled.dofs.rigid_body_vectors([0.1, 0.2, 0.3]) {
            let scaled: Vec<f64> = rigid.iter().map(|x| 1e-5 * x).collect();
            let none = prestress.geometric_stiffness(&scaled).unwrap();
            assert!(none.val().iter().all(|v| within(v.abs(), 1e-9 * size, RoundOff)));
        }
    }

    #[test]
    fn every_fault_of_a_model_is_told_at_once() {
        let mut model = strip(2, PlateTheory::Mindlin);
        let [
            Part { kind: PartKind::Shell(shell), cells: faces, .. },
            Part { kind: PartKind::Bar(bar), cells: lines, .. },
        ] = &mut model.parts[..]
        else {
            panic!("a plate and a bar")
        };
        shell.rotary_inertia = false;
        shell.thickness = -1e-3;
        shell.material.poissons_ratio = 0.5;
        shell.material.youngs_modulus = f64::NAN;
        bar.material.density = -1.0;
        lines.push(Cell::line([3, 3]));
        faces.push(Cell::triangle([0, 1, 999]));
        faces.push(Cell::triangle([0, 0, 1]));
        faces.push(Cell::quadrilateral([0, 2, 1, 5]));
        model.masses[0].mass = f64::INFINITY;
        model.springs[0].direction = [0.0; 3];
        model.supports[0].nodes.push(1000);
        model.nodes[4][1] = f64::NAN;
        let crate::error::Error::Input(faults) = assemble(&model).unwrap_err() else { panic!("input error") };
        let text = faults.to_string();
        for word in [
            "thickness",
            "Poisson",
            "Young",
            "density",
            "no length",
            "node 1000",
            "node 1001",
            "without area",
            "re-entrant",
            "mass inf",
            "direction",
            "finite",
            "rotary inertia",
        ] {
            assert!(text.contains(word), "{word} missing in {text}");
        }
        assert_eq!(faults.0.len(), 13, "{text}");
    }

    #[test]
    fn an_empty_model_is_an_explained_fault() {
        assert!(assemble(&Model::default()).unwrap_err().to_string().contains("can move"));
    }
}
