//! A structure as harmonic forces see it: at full order, and by its modes with static residuals.

use super::{ManyPoints, Reduced, reduce};
use crate::equilibrium::{SteadyOptions, SteadySliding, solve_steady, tangent_stiffness};
use crate::error::Result;
use crate::linalg::{SparseMatrix, SparseVector};
use crate::modal::{ModesWanted, RealModes, compute};
use crate::progress::Observer;
use crate::system::{ModalDamping, Structure, System};
use faer::Mat;

/// Real modes of a response are computed up to this many times the highest frequency.
pub const MODES: f64 = 2.0;

/// Relative error of the deflections under the forces of contacts of many points.
const CONTACT_TOLERANCE: f64 = 1e-3;

/// Up to this many contact points a response has the deflections under a force at each; of more it would take dense solutions of that
/// size at every frequency.
const LINEAR_POINTS: usize = 32;

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
    /// The small model of these modes and of what forces move besides.
    pub reduced: Reduced,
    /// Its system and its state, with its contacts, which are linear about that, between its coordinates where they have many points.
    pub small: (System, SteadySliding),
}

impl Receptance {
    /// Of `system` about `steady` sliding, or without its contacts and its load where there is none, for forces along `forms`
    /// up to `highest_hz` \[Hz\].
    ///
    /// The small system holds the static responses to the forces and those to the inertia of what is left of them: its
    /// residual is right to ω², the response to ω⁴. Of contacts with many points it has the deflections under the forces that occur in
    /// small motions, within a thousandth.
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
        let reduced = if system.points().count() > LINEAR_POINTS {
            let shapes = Mat::zeros(system.n_dofs(), 0);
            let many = ManyPoints { tolerance: CONTACT_TOLERANCE, linear: true, shapes, states: Vec::new() };
            reduce(&system, &steady, &real, forms, Some(many))?
        } else {
            let first = reduce(&system, &steady, &real, forms, None)?;
            let inertia = (first.modes..first.inertia.ncols())
                .map(|k| SparseVector::from_dense(first.inertia.col_as_slice(k)));
            let forms: Vec<SparseVector> = forms.iter().cloned().chain(inertia).collect();
            reduce(&system, &steady, &real, &forms, None)?
        };
        let linear = reduced.linearised(&system, &steady);
        let small = linear.unwrap_or_else(|| (reduced.system.clone(), reduced.steady(&steady)));
        Ok(Receptance { system, steady, real, reduced, small })
    }
}

/// A system whose contacts are open, and that nothing loads.
fn alone(system: &System) -> System {
    System { pairs: Vec::new(), load: vec![0.0; system.n_dofs()], prestress: None, ..system.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::dynamics::{Harmonic, Interface};
    use crate::equilibrium::samples::fluttering_bar;
    use std::f64::consts::TAU;

    /// Of 531 contact points in steady sliding, beside the dense matrix: at full order, and by superposition.
    #[test]
    fn contacts_of_many_points_answer_as_the_dense_matrix() {
        use faer::prelude::*;
        let system = fluttering_bar(9.0, 9);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let places = [7, 90].map(|at| SparseVector::from_entries([(at, 1.0)]));
        let damping = DampingOfModes { of: &|_, _| Ok(None), needs_below: 0.0 };
        let found = Receptance::new(&system, Some(&steady), (4.0, &places), damping, &()).unwrap();
        assert!(found.reduced.contacts.is_some() && found.reduced.basis.ncols() < 120);
        let few = Harmonic::new(&found.small.0, &found.small.1).unwrap();
        let full = Harmonic::new(&found.system, &found.steady).unwrap();
        let own = system.constant_matrices().unwrap();
        let contact = Interface::new(&system, &steady).assembled(120).map(|a| a.to_dense());
        let [mass, stiffness] = [own.mass.to_dense(), own.stiffness.to_dense() + &contact[0]];
        let damping = own.damping.unwrap().to_dense() + &contact[1];
        for hz in [0.2, 0.9, 1.7, 2.5, 2.6, 3.9] {
            let omega = TAU * hz;
            let q = Mat::from_fn(120, 120, |i, j| {
                c64::new(stiffness[(i, j)] - omega * omega * mass[(i, j)], omega * damping[(i, j)])
            });
            let force = Mat::from_fn(120, 1, |i, _| c64::new(f64::from(i == 7), 0.0));
            let exact = q.partial_piv_lu().solve(&force);
            let exact = [7, 90].map(|i| exact[(i, 0)]);
            let direct = full.at(omega, &places[0], &places).unwrap();
            let [force, seen] = [0, 1].map(|k| found.reduced.form(&places[k]));
            let superposed = few.at(omega, &force, &[force.clone(), seen]).unwrap();
            let apart =
                |a: &[c64]| a.iter().zip(&exact).map(|(a, b)| (a - b).norm() / b.norm()).fold(0.0, f64::max);
            assert!(within(apart(&direct), 1e-9, RoundOff), "{hz}: {direct:?} {exact:?}");
            assert!(within(apart(&superposed), 1e-3, Discretisation), "{hz}: {superposed:?} {exact:?}");
        }
    }
}
