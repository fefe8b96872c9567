//! A structure as harmonic forces see it: at full order, and by its modes with static residuals.

use super::{Reduced, reduce};
use crate::equilibrium::{SteadyOptions, SteadySliding, solve_steady, tangent_stiffness};
use crate::error::Result;
use crate::linalg::{SparseMatrix, SparseVector};
use crate::modal::{ModesWanted, RealModes, compute};
use crate::progress::Observer;
use crate::system::{ModalDamping, Structure, System};

/// Real modes of a response are computed up to this many times the highest frequency.
pub const MODES: f64 = 2.0;

/// Modal damping of a structure.
pub struct DampingOfModes<'a> {
    /// Given M and the real modes; none where there is none.
    pub of: &'a dyn Fn(&SparseMatrix, &RealModes) -> Result<Option<ModalDamping>>,
    /// The frequency \[Hz\] up to which it needs the real modes.
    pub needs_below: f64,
}

/// A structure about its rest or its steady sliding, for receptances u = H(ω) f.
#[derive(Debug)]
pub struct Receptance {
    /// At full order, n degrees of freedom, with its modal damping.
    pub system: System,
    /// State about which it vibrates.
    pub steady: SteadySliding,
    /// Its real modes up to twice the highest frequency, at least.
    pub real: RealModes,
    /// The small system of these modes and of what forces move besides.
    pub reduced: Reduced,
}

impl Receptance {
    /// Of `system` about `steady` sliding, or without its contacts and its load where there is none, for forces along `forms`
    /// up to `highest_hz` \[Hz\].
    ///
    /// The small system holds the static responses to the forces and those to the inertia of what is left of them: its
    /// residual is right to ω², the response to ω⁴.
    ///
    /// # Errors
    /// Modes that cannot be computed; those of `damping`.
    pub fn new(
        system: &System,
        steady: Option<&SteadySliding>,
        (highest_hz, forms): (f64, &[SparseVector]),
        damping: DampingOfModes<'_>,
        observer: &dyn Observer,
    ) -> Result<Receptance> {
        let (mut system, steady) = match steady {
            Some(steady) => (system.clone(), steady.clone()),
            None => {
                let free = alone(system);
                let still = solve_steady(&free, &SteadyOptions::default(), &())?;
                (free, still)
            }
        };
        let stiffness = tangent_stiffness(&system, &steady.displacement)?.into_owned();
        let structure = Structure { stiffness: stiffness.into(), ..system.structure.clone() };
        let below = damping.needs_below.max(MODES * highest_hz);
        let (real, _) = compute(&structure, ModesWanted::BelowHz(below), observer)?;
        if let Some(modal) = (damping.of)(&system.structure.mass, &real)? {
            system.structure.damping.modal = Some(modal);
        }
        let first = reduce(&system, &steady, &real, forms, None)?;
        let inertia = (first.modes..first.inertia.ncols())
            .map(|k| SparseVector::from_dense(first.inertia.col_as_slice(k)));
        let forms: Vec<SparseVector> = forms.iter().cloned().chain(inertia).collect();
        let reduced = reduce(&system, &steady, &real, &forms, None)?;
        Ok(Receptance { system, steady, real, reduced })
    }
}

/// A system whose contacts are open, and that nothing loads.
fn alone(system: &System) -> System {
    System { pairs: Vec::new(), load: vec![0.0; system.n_dofs()], prestress: None, ..system.clone() }
}
