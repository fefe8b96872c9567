//! Model of a system for time integration.

use super::drive::{Loading, Push, TimeProfile};
use super::products::Products;
use super::scheme::Weights;
use super::track::Track;
use crate::equilibrium::{SteadySliding, directions, tangent_stiffness};
use crate::error::{Error, Fault, Result};
use crate::linalg::multivector::expand;
use crate::linalg::sparse::add_scaled;
use crate::linalg::{SparseMatrix, SparseVector};
use crate::system::{
    ContactForces, ContactLaw, ContactMotion, ContactPair, ContactTangent, Damping, FrictionAtRest, Skew,
    System,
};
use faer::{Mat, MatRef};
use std::borrow::Cow;

/// M ü + (C + G) u̇ + (K + K_σ + N) u + D r = f: the structure, its sparse skew parts G and N, and the directions D in which contacts and
/// imported unsymmetric terms of low rank act on it.
#[derive(Debug)]
pub struct TransientModel<'a> {
    pub(super) mass: &'a SparseMatrix,
    pub(super) damping: &'a Damping,
    /// K + K_σ(u₀).
    pub(super) stiffness: Cow<'a, SparseMatrix>,
    /// N and G.
    pub(super) skew: Option<&'a Skew>,
    /// Products with M, K and C.
    pub(super) products: Products,
    /// f \[N, N m\].
    pub(super) load: Cow<'a, [f64]>,
    /// P, what the directions D are made of: g, t₁, t₂ of every contact point, at each of its stations where it travels,
    /// then the imported ones.
    pub(super) columns: Vec<&'a SparseVector>,
    /// V, where u = V q are the degrees of freedom that the contact points act on and q those of the model.
    pub(super) basis: Option<&'a Mat<f64>>,
    pub(super) points: Vec<Touch<'a>>,
    /// k and c between the imported directions.
    pub(super) coupling: Option<[&'a Mat<f64>; 2]>,
    /// V \[m/s\] of each pair.
    pub(super) velocities: Vec<f64>,
    /// How each of them runs in time.
    pub(super) profiles: Vec<TimeProfile>,
    /// How the points of each pair change as its counter-body travels; those of the others stay.
    pub(super) tracks: Vec<Option<&'a Track>>,
    /// Pushes on the structure.
    pub(super) pushes: Vec<Push>,
    /// How the load that closes each pair runs in time, if it does.
    pub(super) loadings: Vec<Option<Loading>>,
    /// The approach of each pair \[m\] at the start.
    pub(super) approaches: Vec<f64>,
    /// The load \[N\] that each pair keeps in motion; the others keep their approach.
    pub(super) loads: Vec<Option<f64>>,
}

/// The part of a load that counts as none: where nothing presses a pair, its approach has no value.
pub const NO_LOAD: f64 = 1e-6;

/// A point that may touch, without its directions.
#[derive(Debug)]
pub(super) struct Touch<'a> {
    /// Index of its pair.
    pub(super) pair: usize,
    /// The name of its pair.
    pub(super) name: &'a str,
    /// Where it is \[m\].
    pub(super) position: [f64; 3],
    pub(super) law: &'a dyn ContactLaw,
    pub(super) weight: f64,
    /// Its sliding velocity in parts of that of the pair.
    pub(super) speed: f64,
    /// Its gap where it does not travel \[m\].
    pub(super) gap: f64,
}

impl<'a> TransientModel<'a> {
    /// The system about steady sliding: its approach is kept, as in the complex eigenvalues, and the geometric stiffness
    /// of its preload if the system asks for it.
    ///
    /// # Errors
    /// Input: hysteretic damping, which means something in harmonic motion only.
    pub fn new(system: &'a System, steady: &SteadySliding) -> Result<Self> {
        TransientModel::with_contacts(system, (&system.pairs, None), steady)
    }

    /// The same of a `system` without contacts, and of `pairs` whose points act on V q, `basis` being V.
    ///
    /// # Errors
    /// As [`TransientModel::new`].
    pub fn reduced(
        system: &'a System,
        (pairs, basis): (&'a [ContactPair], &'a Mat<f64>),
        steady: &SteadySliding,
    ) -> Result<Self> {
        TransientModel::with_contacts(system, (pairs, Some(basis)), steady)
    }

    fn with_contacts(
        system: &'a System,
        (contacts, basis): (&'a [ContactPair], Option<&'a Mat<f64>>),
        steady: &SteadySliding,
    ) -> Result<Self> {
        refuse_hysteretic(system)?;
        let pairs = contacts.iter().enumerate();
        let points: Vec<Touch> = pairs
            .flat_map(|(k, pair)| {
                pair.points.iter().map(move |point| Touch {
                    pair: k,
                    name: &pair.name,
                    position: point.position,
                    law: &*pair.law,
                    weight: point.weight,
                    speed: point.speed,
                    gap: point.gap,
                })
            })
            .collect();
        let imported = system.coupling.iter().flat_map(|rest| &rest.directions);
        let (mass, damping) = (&system.structure.mass, &system.structure.damping);
        let stiffness = tangent_stiffness(system, &steady.displacement)?;
        Ok(TransientModel {
            mass,
            damping,
            skew: system.skew(),
            products: Products::new(mass, &stiffness, damping),
            stiffness,
            load: Cow::Borrowed(&system.load),
            columns: contacts
                .iter()
                .flat_map(|pair| &*pair.points)
                .flat_map(directions)
                .chain(imported)
                .collect(),
            basis,
            points,
            coupling: system.coupling.as_ref().map(|rest| [&rest.stiffness, &rest.damping]),
            velocities: contacts.iter().map(|pair| pair.sliding_velocity).collect(),
            profiles: vec![TimeProfile::Constant; contacts.len()],
            tracks: vec![None; contacts.len()],
            pushes: Vec::new(),
            loadings: vec![None; contacts.len()],
            approaches: steady.approach.clone(),
            loads: vec![None; contacts.len()],
        })
    }

    /// The same model in which pairs keep the load \[N\] that closes them, one entry a pair, in place of their approach: the
    /// loading device follows without inertia and without friction, and at the end of every step ΣN = load.
    ///
    /// # Panics
    /// When there is not one entry for each pair.
    pub fn holding(self, loads: Vec<Option<f64>>) -> Self {
        assert!(loads.len() == self.velocities.len(), "one entry a pair");
        TransientModel { loads, ..self }
    }

    /// Whether a pair keeps its load.
    pub fn holds_load(&self) -> bool {
        self.loads.iter().any(Option::is_some)
    }

    /// N′ \[N/m\] of a contact point at a penetration \[m\].
    pub fn normal_stiffness(&self, point: usize, penetration: f64) -> f64 {
        self.normal(point, penetration).1.by_penetration[0]
    }

    /// Whether a contact point also pulls, so that it never opens.
    pub fn is_bilateral(&self, point: usize) -> bool {
        self.normal(point, -1.0).0.normal < 0.0
    }

    /// Whether the friction of a contact point at a penetration \[m\] depends on how fast it slips, not only on where to.
    pub fn friction_varies(&self, point: usize, penetration: f64) -> bool {
        let friction = |part: f64| self.respond(point, penetration, part).0.friction[0];
        friction(0.5) != friction(1.0)
    }

    fn normal(&self, point: usize, penetration: f64) -> (ContactForces, ContactTangent) {
        self.respond(point, penetration, 1.0)
    }

    /// What a contact point answers that slips at a part of the sliding velocity.
    fn respond(&self, point: usize, penetration: f64, part: f64) -> (ContactForces, ContactTangent) {
        let touch = &self.points[point];
        let slip_velocity = [part * touch.speed * self.velocities[touch.pair], 0.0];
        touch.law.respond(&ContactMotion { penetration, penetration_rate: 0.0, slip_velocity }, touch.weight)
    }

    /// The load \[N\] that a pair keeps at a time; `None` where it keeps its approach.
    pub(super) fn held_load(&self, pair: usize, time: f64) -> Option<f64> {
        let factor = self.loadings[pair].as_ref().map_or(1.0, |loading| loading.profile.factor(time));
        self.loads[pair].map(|load| load * factor.max(NO_LOAD))
    }

    /// The same model whose counter-bodies slide as `profiles` say, one a pair, and that is pushed.
    ///
    /// # Panics
    /// When there is not one profile for each pair.
    pub fn driven(self, profiles: Vec<TimeProfile>, pushes: Vec<Push>) -> Self {
        assert!(profiles.len() == self.velocities.len(), "one profile a pair");
        TransientModel { profiles, pushes, ..self }
    }

    /// The same model whose points run along tracks, one a pair, as its counter-body travels.
    ///
    /// # Panics
    /// When there is not one entry for each pair, or a station has not the points of its pair.
    pub fn travelling(mut self, tracks: Vec<Option<&'a Track>>) -> Self {
        assert!(tracks.len() == self.velocities.len(), "one entry a pair");
        let imported = self.columns.split_off(3 * self.points.len());
        let still = std::mem::take(&mut self.columns);
        for (pair, track) in tracks.iter().enumerate() {
            let own: Vec<usize> = (0..self.points.len()).filter(|p| self.points[*p].pair == pair).collect();
            match track {
                Some(track) => {
                    assert!(track.stations.len() > 1, "two stations or more");
                    for station in &track.stations {
                        assert!(station.len() == own.len(), "the points of the pair");
                        self.columns.extend(station.iter().flat_map(directions));
                    }
                }
                None => self.columns.extend(own.iter().flat_map(|p| &still[3 * p..3 * p + 3]).copied()),
            }
        }
        self.columns.extend(imported);
        TransientModel { tracks, ..self }
    }

    /// The same model whose closing loads run in time, one entry a pair.
    ///
    /// # Panics
    /// When there is not one entry for each pair.
    pub fn loaded(self, loadings: Vec<Option<Loading>>) -> Self {
        assert!(loadings.len() == self.velocities.len(), "one entry a pair");
        TransientModel { loadings, ..self }
    }

    /// Where a contact point is, in words; the name of its pair, and friction there at rest.
    pub(super) fn place(&self, point: usize) -> (String, (&'a str, FrictionAtRest)) {
        let Touch { pair, name, position, law, .. } = &self.points[point];
        let number = self.points[..=point].iter().filter(|other| other.pair == *pair).count();
        let [x, y, z] = position.map(|x| 1e3 * x);
        (
            format!(", at point {number} of the contact `{name}`, at ({x:.3}, {y:.3}, {z:.3}) mm"),
            (name, law.at_rest()),
        )
    }

    /// V q, which the contact points act on; `None` where that is q.
    pub(super) fn lifted(&self, q: MatRef<'_, f64>) -> Option<Mat<f64>> {
        self.basis.map(|basis| expand(basis.as_ref(), q))
    }

    /// Whether a direction changes in time.
    pub(super) fn travels(&self) -> bool {
        self.tracks.iter().any(Option::is_some)
    }

    /// Number of directions: three a point, and those that were imported.
    pub(super) fn n_directions(&self) -> usize {
        3 * self.points.len() + self.coupling.map_or(0, |[k, _]| k.nrows())
    }

    /// Whether a pair never slides.
    pub(super) fn sticks(&self, pair: usize) -> bool {
        self.velocities[pair] == 0.0
    }

    /// V of each pair at a time \[m/s\].
    pub fn speeds(&self, time: f64) -> impl Iterator<Item = f64> + '_ {
        self.velocities.iter().zip(&self.profiles).map(move |(v, profile)| v * profile.factor(time))
    }

    /// The number of degrees of freedom.
    pub fn n(&self) -> usize {
        self.mass.nrows()
    }

    /// A₀ = (1−α_m)/(β Δt²) M + (1−α_f) c₁ (C + G) + (1−α_f) (K + N) with the sparse part of C.
    pub(super) fn effective(&self, weights: &Weights) -> SparseMatrix {
        let [m, c, k] = weights.effective();
        let mut terms = vec![(m, self.mass), (k, &*self.stiffness)];
        terms.extend(self.damping.viscous.as_deref().map(|viscous| (c, viscous)));
        terms.extend(self.skew.iter().flat_map(|skew| [(c, &*skew.damping), (k, &*skew.stiffness)]));
        add_scaled(&terms)
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
