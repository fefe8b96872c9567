//! A structure as harmonic forces see it: at full order, and by its modes with static residuals.

use super::modes::add_modal_damping;
use super::prepared::Prepared;
use crate::equilibrium::{SteadyOptions, SteadySliding, solve_steady, tangent_stiffness};
use crate::error::Result;
use crate::linalg::SparseVector;
use crate::modal::{ModesWanted, RealModes, compute};
use crate::progress::Observer;
use crate::reduction::{Reduced, reduce};
use crate::system::{Structure, System};

/// Real modes are taken up to this many times the highest frequency.
const MODES: f64 = 2.0;

/// A structure about its rest or its steady sliding.
pub struct Receptance {
    /// At full order.
    pub system: System,
    /// What it moves about.
    pub steady: SteadySliding,
    /// Its real modes up to twice the highest frequency.
    pub real: RealModes,
    /// The small system of these modes and of what forces move besides.
    pub reduced: Reduced,
}

impl Receptance {
    /// For forces along `forms` up to `highest_hz`; `steady` is steady sliding, where the contacts slide.
    ///
    /// # Errors
    /// Modes that cannot be computed.
    pub fn new(
        prepared: &Prepared<'_>,
        steady: Option<&SteadySliding>,
        highest_hz: f64,
        forms: &[SparseVector],
        observer: &dyn Observer,
    ) -> Result<Receptance> {
        let (mut system, steady) = match steady {
            Some(steady) => (prepared.system.clone(), steady.clone()),
            None => {
                let free = alone(&prepared.system);
                let still = solve_steady(&free, &SteadyOptions::default(), &())?;
                (free, still)
            }
        };
        let stiffness = tangent_stiffness(&system, &steady.displacement)?.into_owned();
        let structure = Structure { stiffness: stiffness.into(), ..system.structure.clone() };
        let (real, _) = compute(&structure, ModesWanted::BelowHz(MODES * highest_hz), observer)?;
        add_modal_damping(&mut system.structure, &real, prepared)?;
        // Besides the static responses, what their inertia moves: the residual is right to ω², the response to ω⁴.
        let first = reduce(&system, &steady, &real, forms)?;
        let inertia = (first.modes..first.inertia.ncols())
            .map(|k| SparseVector::from_dense(first.inertia.col_as_slice(k)));
        let forms: Vec<SparseVector> = forms.iter().cloned().chain(inertia).collect();
        let reduced = reduce(&system, &steady, &real, &forms)?;
        Ok(Receptance { system, steady, real, reduced })
    }
}

/// A system whose contacts are open, and that nothing loads.
fn alone(system: &System) -> System {
    System { pairs: Vec::new(), load: vec![0.0; system.n_dofs()], prestress: None, ..system.clone() }
}
