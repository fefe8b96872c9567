//! A run under way: what its analyses share, and where their results go.

use super::clock::Clock;
use super::complex::{is_spanned_closed, whole_modes};
use super::contact_surfaces::contact_surfaces;
use super::known::KnownAnswers;
use super::modes::{check_damping_frequencies, real_modes_below};
use super::operating_point::OperatingPoint;
use super::prepared::Prepared;
use super::sink::{ResultSink, ResultStage};
use super::steady_warnings;
use crate::case::StiffnessPer;
use crate::equilibrium::{self, SteadySliding};
use crate::error::Result;
use crate::modal::RealModes;
use crate::progress::Observer;
use crate::results::{AnalysisRecord, RunResults, SteadyResult};
use std::rc::Rc;
use std::sync::Arc;

/// The analyses of a case under way.
pub struct Run<'a, 'k> {
    /// The case.
    pub prepared: &'a Prepared<'a>,
    /// Watches the run.
    pub observer: &'k dyn Observer,
    /// Takes results as soon as they are there.
    pub sink: &'k mut dyn ResultSink,
    /// Times the phases.
    pub clock: Clock,
    /// Results so far.
    pub results: &'k mut RunResults,
    /// Answers of studies that are known.
    pub known: &'k KnownAnswers<'k>,
    /// Whether an analysis takes the left vectors of the complex modes.
    pub left_vectors: bool,
    /// The real modes of the whole that span the complex analysis, until that takes them: see [`Run::basis`].
    pub basis: Option<RealModes>,
    /// The state about which complex modes were computed.
    pub operating_point: Option<Rc<OperatingPoint<'a>>>,
    complex: bool,
    steady: Option<Arc<SteadySliding>>,
}

impl<'a, 'k> Run<'a, 'k> {
    /// A run of which nothing is known but answers of its studies; `complex` when it comes to complex modes,
    /// `left_vectors` when these get left vectors.
    pub fn new(
        prepared: &'a Prepared<'a>,
        [complex, left_vectors]: [bool; 2],
        known: &'k KnownAnswers<'k>,
        sink: &'k mut dyn ResultSink,
        results: &'k mut RunResults,
        observer: &'k dyn Observer,
    ) -> Self {
        Run {
            prepared,
            observer,
            sink,
            clock: Clock::default(),
            results,
            known,
            left_vectors,
            basis: None,
            operating_point: None,
            complex,
            steady: None,
        }
    }

    /// Hands a result on and keeps it.
    pub fn found(&mut self, record: impl AnalysisRecord) -> Result<()> {
        self.sink.record(ResultStage::Found(&record))?;
        self.results.records.push(record);
        Ok(())
    }

    /// Times `work` as one phase.
    pub fn timed<T>(&mut self, phase: &str, work: impl FnOnce(&dyn Observer) -> T) -> T {
        let observer = self.observer;
        self.clock.time(phase, || work(observer))
    }

    /// Steady sliding, which is computed on first use.
    ///
    /// # Errors
    /// No steady state: an open contact, a structure that nothing holds. What the sink returns.
    pub fn steady(&mut self) -> Result<Arc<SteadySliding>> {
        if let Some(steady) = &self.steady {
            return Ok(steady.clone());
        }
        let prepared = self.prepared;
        let options = prepared.steady_options();
        let state = self.timed("steady sliding", |observer| {
            equilibrium::solve_steady(&prepared.system, &options, observer)
        })?;
        let steady = Arc::new(state.clone());
        self.steady = Some(steady.clone());
        if !prepared.system.pairs.is_empty() {
            self.results.warnings.extend(steady_warnings::warnings(prepared, &state));
            self.found(steady_result(prepared, state))?;
        }
        Ok(steady)
    }

    /// The real modes of the whole that span the complex analysis, where that is run, looks for a whole band and does not wait
    /// for steady sliding. Other analyses may take their share.
    ///
    /// # Errors
    /// Modes that cannot be computed.
    pub fn basis(&mut self) -> Result<Option<&RealModes>> {
        let case = self.prepared.case;
        if self.basis.is_none()
            && let Some(cea) = case
                .cea
                .as_ref()
                .filter(|cea| !case.prestress && cea.nearest.is_none() && !is_spanned_closed(self.prepared))
            && self.complex
        {
            let structure = &self.prepared.system.structure;
            check_damping_frequencies(structure, case, cea.basis_below)?;
            let below = real_modes_below(case, cea, cea.basis_below);
            self.basis = Some(whole_modes(structure, below, &mut self.clock, self.observer)?);
        }
        Ok(self.basis.as_ref())
    }
}

fn steady_result(prepared: &Prepared, state: SteadySliding) -> SteadyResult {
    let system = &prepared.system;
    let pairs = equilibrium::by_pair(&system.pairs, &state.points)
        .map(|(pair, own)| {
            let load = own.iter().map(|point| point.forces.normal).sum();
            (pair.name.clone(), load, pair.sliding_velocity)
        })
        .collect();
    SteadyResult {
        displacement: prepared.assembled.dofs.expand(&state.displacement),
        points: system.points().map(|(pair, point)| (pair.name.clone(), point.position)).collect(),
        areas: system
            .points()
            .map(|(pair, point)| {
                let per = prepared.case.contact.get(&pair.name).map(|contact| contact.normal.per);
                (per == Some(StiffnessPer::Area)).then_some(point.weight)
            })
            .collect(),
        surfaces: contact_surfaces(prepared),
        pairs,
        directions: prepared.arrows(),
        state,
    }
}
