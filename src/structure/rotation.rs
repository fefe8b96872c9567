//! Bodies of revolution that rotate steadily, seen from outside: the terms that the rotation adds.
//!
//! The body turns at Ω about an axis e through x₀, and u(x, t) is the displacement \[m\], in axes that stand still, of the particle that
//! passes the place x of the turning undeformed body: the mixed description of rolling and braked bodies (U. Nackenhorst, Comput. Methods
//! Appl. Mech. Eng. 193 (2004) 4299; N. Gräbner et al., Z. Angew. Math. Mech. 96 (2016) 1388). A body of revolution fills the same
//! places all the time, so that mesh, contacts and supports stand still. The particle has the velocity
//!
//!   Ω e × (x − x₀) + u̇ + Ω ∂_θu,  ∂_θu = ((e × (x − x₀))·∇) u,
//!
//! and Lagrange's equations of ½ ∫ ρ |velocity|² dV with u = N q are M q̈ + G q̇ + (K + K_σ − Ω² T) q = f,
//!
//! * gyroscopic, skew: G = Ω (D − Dᵀ) \[N s/m\] with D = ∫ ρ Nᵀ ∂_θN dV;
//! * transport, symmetric and softening: T = ∫ ρ (∂_θN)ᵀ ∂_θN dV \[kg\];
//! * spin stiffness: K_σ, the geometric stiffness of the stress under the centrifugal force Ω² ∫ ρ Nᵀ r dV, r the way from the axis.
//!
//! A wave cos(nθ − ωt) that has the frequency ω_r for one who turns with the body has ω = ω_r + nΩ; one that goes against the rotation
//! ω_r − nΩ. Without stress, and where Coriolis forces do nothing, as for the deflection of a thin disc, ω_r is the frequency at rest.
//!
//! What is linear in u beside q̈, q̇ and q is the centrifugal force itself. It stresses the body, and its displacement is not part of
//! the steady state. Damping of the material acts on u̇, as if it were outside of the body: the circulatory forces Ω C ∂_θ of damping
//! that turns with it, which matter above critical speeds, are left out.

use super::assembly::{Assembled, geometric_stiffness};
use super::elements::ElementMatrix;
use super::model::Model;
use super::part::AnyElement;
use super::properties::Rotation;
use super::scatter::{Couplings, Pattern, Reduction};
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::{add_scaled, multiply_vector};
use crate::system::{Coupling, Skew, Structure};
use faer::Mat;
use rayon::prelude::*;
use std::sync::Arc;

/// Work arrays of the element loop.
#[derive(Debug, Default)]
struct Workspace {
    reduction: Reduction,
    convected: ElementMatrix,
    transport: ElementMatrix,
}

/// s ρR²/E of the mass s M that holds a free body while its centrifugal stress is sought, and the rounds of refinement in which it vanishes.
const HELD: f64 = 1e-6;
const ROUNDS: usize = 4;

impl Assembled {
    /// The structure with what the rotations of `model`, the one that was assembled, add to K, and G where there is one.
    ///
    /// # Errors
    /// A stiffness that cannot be factorised, whose centrifugal stress is asked for.
    pub fn rotating(&self, model: &Model) -> Result<(Structure, Option<Coupling>)> {
        let turning = || model.rotations.iter().filter(|rotation| rotation.speed != 0.0);
        let (mut elements, mut of): (Vec<AnyElement>, Vec<&Rotation>) = (Vec::new(), Vec::new());
        for rotation in turning() {
            for part in model.turned_by(rotation) {
                part.cells.iter().for_each(|cell| part.push_elements(cell, &model.nodes, &mut elements));
            }
            of.resize(elements.len(), rotation);
        }
        let couplings = Couplings::new(&self.dofs, &elements);
        let pattern = Pattern { couplings: &couplings, symbolic: self.stiffness.symbolic() };
        let wanted = [turning().any(|r| r.gyroscopic), turning().any(|r| r.transport)];
        let [gyroscopic, transport] = pattern.sum(wanted, |work: &mut Workspace, p, coupled, small| {
            let Workspace { reduction, convected, transport } = work;
            let Rotation { axis, speed, .. } = of[p];
            convected.reset(elements[p].n_freedoms());
            transport.reset(elements[p].n_freedoms());
            if elements[p].transport(axis, [convected, transport]) {
                reduction.set(&self.dofs, elements[p].as_ref(), coupled);
                if of[p].gyroscopic {
                    convected.become_skew(*speed);
                    reduction.apply_skew(convected, small[0]);
                }
                if of[p].transport {
                    transport.scale(-speed * speed);
                    reduction.apply(transport, small[1]);
                }
            }
        });
        let stress = self.spin_stiffness(model, turning().filter(|r| r.spin_stiffness))?;
        let mut structure = self.structure.clone();
        let added: Vec<&SparseMatrix> = transport.iter().chain(&stress).collect();
        if !added.is_empty() {
            let all: Vec<_> =
                std::iter::once(&*self.structure.stiffness).chain(added).map(|k| (1.0, k)).collect();
            structure.stiffness = add_scaled(&all).into();
        }
        let none = SparseMatrix::try_new_from_triplets(self.dofs.n_dofs(), self.dofs.n_dofs(), &[]);
        let stiffness = Arc::new(none.expect("a matrix without entries"));
        let skew = |damping: SparseMatrix| Skew { stiffness, damping: damping.into() };
        Ok((structure, gyroscopic.map(|g| Coupling::sparse(skew(g)))))
    }

    /// K_σ of the centrifugal stress of some rotations; none where there are none.
    fn spin_stiffness<'a>(
        &self,
        model: &Model,
        rotations: impl Iterator<Item = &'a Rotation>,
    ) -> Result<Option<SparseMatrix>> {
        let mut force = vec![0.0; self.dofs.n_dofs()];
        let mut held = 0.0f64;
        for rotation in rotations {
            let entries = centrifugal_force(model, rotation);
            self.dofs.reduce(&entries).add_to(1.0, &mut force);
            for part in model.turned_by(rotation) {
                let radius = |n: &usize| rotation.axis.arm(model.nodes[*n]).norm();
                let radius = part.nodes().iter().map(radius).fold(0.0, f64::max);
                let material = part.kind.material();
                if material.density > 0.0 {
                    held = held.max(HELD * material.youngs_modulus / (material.density * radius * radius));
                }
            }
        }
        if force.iter().all(|f| *f == 0.0) {
            return Ok(None);
        }
        let Structure { mass, stiffness, engine, .. } = &self.structure;
        let factor = engine.factorize(&add_scaled(&[(1.0, stiffness), (held, mass)]))?;
        let mut u = vec![0.0; force.len()];
        for _ in 0..ROUNDS {
            let carried = multiply_vector(stiffness, &u);
            let mut rest = Mat::from_fn(u.len(), 1, |i, _| force[i] - carried[i]);
            factor.solve_in_place(rest.as_mut());
            u.iter_mut().zip(rest.col_as_slice(0)).for_each(|(u, more)| *u += more);
        }
        geometric_stiffness(model, &self.dofs, &self.stiffness, &u).map(Some)
    }
}

/// Ω² ∫ ρ Nᵀ r dV \[N\] on the nodes: node, component, value. As r is linear in x, it is M r of each element.
fn centrifugal_force(model: &Model, rotation: &Rotation) -> Vec<(usize, usize, f64)> {
    let squared = rotation.speed * rotation.speed;
    let of_element = |element: &AnyElement| {
        let (nodes, components) = (element.nodes(), element.components());
        let mut mass = ElementMatrix::default();
        mass.reset(element.n_freedoms());
        element.mass(&mut mass);
        let mut forces = Vec::with_capacity(element.n_freedoms());
        let freedoms = || nodes.iter().flat_map(|n| components.iter().map(|c| (*n, *c)));
        let moved = |(n, c): (usize, usize)| if c < 3 { rotation.axis.arm(model.nodes[n])[c] } else { 0.0 };
        for (column, (node, component)) in freedoms().enumerate() {
            let product = freedoms().zip(mass.column(column)).map(|(freedom, m)| m * moved(freedom));
            forces.push((node, component, squared * product.sum::<f64>()));
        }
        forces
    };
    let cells: Vec<_> =
        model.turned_by(rotation).flat_map(|part| part.cells.iter().map(move |c| (part, c))).collect();
    let forces = cells.par_iter().map(|(part, cell)| {
        part.elements_on(cell, &model.nodes).iter().flat_map(of_element).collect::<Vec<_>>()
    });
    forces.collect::<Vec<_>>().concat()
}
