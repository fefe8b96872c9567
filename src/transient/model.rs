//! What time integration needs of a system.

use super::drive::{Profile, Push};
use super::scheme::Weights;
use crate::equilibrium::{SteadySliding, directions, tangent_stiffness};
use crate::error::{Error, Fault, Result};
use crate::linalg::sparse::add_scaled;
use crate::linalg::{SparseMatrix, SparseVector};
use crate::system::{ContactLaw, Damping, System};
use faer::Mat;
use std::borrow::Cow;

/// M ü + C u̇ + (K + K_σ) u + D r = f: the structure, and the directions D in which contacts and imported unsymmetric
/// terms act on it.
#[derive(Debug)]
pub struct Model<'a> {
    pub(super) mass: &'a SparseMatrix,
    pub(super) damping: &'a Damping,
    /// K + K_σ(u₀).
    pub(super) stiffness: Cow<'a, SparseMatrix>,
    /// f \[N, N m\].
    pub(super) load: &'a [f64],
    /// The columns of D: g, t₁, t₂ of every contact point, then the imported ones.
    pub(super) directions: Vec<&'a SparseVector>,
    pub(super) points: Vec<Touch<'a>>,
    /// k and c between the imported directions.
    pub(super) coupling: Option<[&'a Mat<f64>; 2]>,
    /// V \[m/s\] of each pair.
    pub(super) velocities: Vec<f64>,
    /// How each of them runs in time.
    pub(super) profiles: Vec<Profile>,
    /// Pushes on the structure.
    pub(super) pushes: Vec<Push>,
}

/// A point that may touch, without its directions.
#[derive(Debug)]
pub(super) struct Touch<'a> {
    /// Index of its pair.
    pub(super) pair: usize,
    pub(super) law: &'a dyn ContactLaw,
    pub(super) weight: f64,
    /// approach − gap \[m\], δ at gᵀu = 0.
    pub(super) closeness: f64,
}

impl<'a> Model<'a> {
    /// The system about steady sliding: its approach is kept, as in the complex eigenvalues, and the geometric stiffness
    /// of its preload if the system asks for it.
    ///
    /// # Errors
    /// Input: hysteretic damping, which means something in harmonic motion only.
    pub fn new(system: &'a System, steady: &SteadySliding) -> Result<Self> {
        refuse_hysteretic(system)?;
        let pairs = system.pairs.iter().zip(&steady.approach).enumerate();
        let points: Vec<Touch> = pairs
            .flat_map(|(k, (pair, approach))| {
                pair.points.iter().map(move |point| Touch {
                    pair: k,
                    law: &*pair.law,
                    weight: point.weight,
                    closeness: approach - point.gap,
                })
            })
            .collect();
        let imported = system.coupling.iter().flat_map(|rest| &rest.directions);
        Ok(Model {
            mass: &system.structure.mass,
            damping: &system.structure.damping,
            stiffness: tangent_stiffness(system, &steady.displacement)?,
            load: &system.load,
            directions: system.points().flat_map(|(_, point)| directions(point)).chain(imported).collect(),
            points,
            coupling: system.coupling.as_ref().map(|rest| [&rest.stiffness, &rest.damping]),
            velocities: system.pairs.iter().map(|pair| pair.sliding_velocity).collect(),
            profiles: vec![Profile::Constant; system.pairs.len()],
            pushes: Vec::new(),
        })
    }

    /// The same model whose counter-bodies slide as `profiles` say, one a pair, and that is pushed.
    ///
    /// # Panics
    /// When there is not one profile for each pair.
    pub fn driven(self, profiles: Vec<Profile>, pushes: Vec<Push>) -> Self {
        assert!(profiles.len() == self.velocities.len(), "one profile a pair");
        Model { profiles, pushes, ..self }
    }

    /// V of each pair at a time \[m/s\].
    pub fn speeds(&self, time: f64) -> impl Iterator<Item = f64> + '_ {
        self.velocities.iter().zip(&self.profiles).map(move |(v, profile)| v * profile.factor(time))
    }

    /// The number of degrees of freedom.
    pub fn n(&self) -> usize {
        self.mass.nrows()
    }

    /// A₀ = (1−α_m)/(β Δt²) M + (1−α_f) c₁ C + (1−α_f) K with the sparse part of C.
    pub(super) fn effective(&self, weights: &Weights) -> SparseMatrix {
        let [m, c, k] = weights.effective();
        let mut terms = vec![(m, self.mass), (k, &*self.stiffness)];
        terms.extend(self.damping.viscous.iter().map(|viscous| (c, viscous)));
        add_scaled(&terms)
    }

    /// Dᵀx.
    pub(super) fn motions(&self, x: &[f64], out: &mut [f64]) {
        self.directions.iter().zip(out).for_each(|(d, out)| *out = d.dot(x));
    }

    /// x += factor · D r.
    pub(super) fn add_reactions(&self, factor: f64, r: &[f64], x: &mut [f64]) {
        for (d, r) in self.directions.iter().zip(r).filter(|(_, r)| **r != 0.0) {
            d.add_to(factor * r, x);
        }
    }
}

/// Loss factors are defined for harmonic motion only.
///
/// # Errors
/// Input: there are some.
pub fn refuse_hysteretic(system: &System) -> Result<()> {
    if system.structure.damping.hysteretic.is_none() {
        return Ok(());
    }
    let found = "a loss factor, whose damping K(1 + iη) is defined for harmonic motion only";
    let help = "Give the material [rayleigh] with beta = loss_factor/(2π f) at the frequency f of interest, or the \
                structure a modal_ratio = loss_factor/2";
    Err(Error::input(Fault::new("transient", found, "viscous damping").with_help(help)))
}
