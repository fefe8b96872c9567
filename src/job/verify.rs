//! Verification of the advice: the addition is mounted on the model and everything is recomputed.

use super::modes::{add_modal_damping, real_modes_below};
use super::prepared::Prepared;
use crate::equilibrium::{solve_steady, tangent_stiffness};
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::sparse::multiply_vector;
use crate::modal::{ModesWanted, compute};
use crate::results::Mounted;
use crate::stability::{ComplexMode, complex_modes};
use crate::structure::{PointMass, Spring, assemble};
use crate::system::{Structure, System};

/// The eigenvalue that `mode` becomes when `thing` is mounted: of the modes of the changed rig the one with the largest
/// |φᴴMφ′|.
///
/// # Errors
/// A thing that gives the model other degrees of freedom; an analysis without an answer.
pub fn mounted(prepared: &Prepared, mode: &ComplexMode, thing: &Mounted) -> Result<c64> {
    let refused =
        |found: &str| Error::analysis("mounting what helps", found, "Ask for advice without `verify`");
    let mut model = prepared.model.clone();
    match thing.direction {
        None => model.masses.push(PointMass { node: thing.node, mass: thing.amount, inertia: [0.0; 3] }),
        Some(direction) => model.springs.push(Spring {
            node: thing.node,
            other: None,
            direction,
            rotational: false,
            stiffness: 0.0,
            damping: thing.amount,
        }),
    }
    let assembled = assemble(&model)?;
    if assembled.structure.n_dofs() != prepared.system.n_dofs() {
        return Err(refused("the thing gives the model degrees of freedom that it did not have"));
    }
    let Some(cea) = &prepared.case.cea else { return Err(refused("no complex eigenvalues were requested")) };
    let (structure, coupling) = assembled.rotating(&model)?;
    let mut system = System { structure, coupling, ..prepared.system.clone() };
    let options = prepared.steady_options();
    let steady = solve_steady(&system, &options, &())?;
    let stiffness = tangent_stiffness(&system, &steady.displacement)?.into_owned();
    let preloaded = Structure { stiffness: stiffness.into(), ..system.structure.clone() };
    let below = real_modes_below(prepared.case, cea, cea.basis_below);
    let (basis, _) = compute(&preloaded, ModesWanted::BelowHz(below), &())?;
    add_modal_damping(&mut system.structure, &basis, prepared.case)?;
    let found = complex_modes(&system, &steady, &basis, cea.band, &())?;
    let momentum = multiply_vector(&prepared.system.structure.mass, &mode.right);
    let overlap =
        |other: &ComplexMode| momentum.iter().zip(&other.right).map(|(p, u)| p.conj() * u).sum::<c64>();
    let alike = |other: &&ComplexMode| overlap(other).norm();
    let same = found.modes.iter().max_by(|a, b| alike(a).total_cmp(&alike(b)));
    same.map(|m| m.eigenvalue).ok_or_else(|| refused("no complex mode is left in the band"))
}
