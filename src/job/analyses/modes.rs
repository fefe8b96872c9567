//! Real modes of parts and of the whole, each set beside the modes that a test found.

use super::analysis::{Analysis, Planned, Scope};
use crate::case::{ContactState, ModesAnalysis};
use crate::equilibrium;
use crate::error::{Faults, Result};
use crate::job::compare::{Tests, has_measured_modes};
use crate::job::modes::{
    check_part, contact_state, named, of_the_whole, part_modes, wanted, without_prestress,
};
use crate::job::part_modes::{PartsAlone, compare_with_parts, is_of_parts_alone};
use crate::job::prepared::Prepared;
use crate::job::run::Run;
use crate::modal;
use crate::results::NamedModes;
use crate::system::System;

/// Real modes.
pub const MODES: Analysis = Analysis {
    name: "modes",
    about: "Real modes only",
    example: Some("[modes.all] with `count = 10`"),
    // Tests are read even where nothing of them is compared: a file that is wrong is a fault.
    listed: |case| !(case.modes.is_empty() && case.measured.is_empty()),
    ready: |case| !case.modes.is_empty(),
    needs: &[],
    left_vectors: false,
    plan,
};

fn plan<'a>(prepared: &'a Prepared<'a>, scope: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
    let case = prepared.case;
    let mut faults = Faults::new();
    let tests = faults.take(Tests::of_modes(prepared)).unwrap_or_default();
    let taken = |name: &str| scope == Scope::All || has_measured_modes(case, name);
    let sets = case.modes.iter().filter(|(name, _)| taken(name));
    let sets: Vec<_> = sets.map(|(name, wanted)| (name.as_str(), wanted)).collect();
    for (name, _) in &sets {
        faults.take(check_part(prepared, name));
    }
    faults.into_result(Box::new(Sets { prepared, sets, tests }))
}

struct Sets<'a> {
    prepared: &'a Prepared<'a>,
    sets: Vec<(&'a str, &'a ModesAnalysis)>,
    tests: Tests,
}

impl<'a> Planned<'a> for Sets<'a> {
    fn slides(&self) -> bool {
        self.sets.iter().any(|(_, set)| contact_state(self.prepared, set) == ContactState::Closed)
    }

    fn warnings(&self) -> Vec<String> {
        let case = self.prepared.case;
        let unstressed = self.sets.iter().filter_map(|(name, set)| match of_the_whole(self.prepared, set) {
            true => without_prestress(case, &format!("modes.{name}"), "closed"),
            false if !case.prestress || set.contact == ContactState::Closed => None,
            false => Some(format!(
                "modes.{name} is of parts by themselves, or with other supports: `prestress` does not act on it"
            )),
        });
        self.tests.warnings.iter().cloned().chain(unstressed).collect()
    }

    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()> {
        // Those with closed contact wait for steady sliding.
        for state in [ContactState::Open, ContactState::Closed] {
            let of_state = |set: &ModesAnalysis| contact_state(self.prepared, set) == state;
            let mut sets: Vec<_> = self.sets.iter().filter(|(_, set)| of_state(set)).collect();
            // Modes of the whole are compared with those of its parts.
            sets.sort_by_key(|(name, _)| !is_of_parts_alone(self.prepared, name));
            for (name, set) in sets {
                let mut modes = match state {
                    ContactState::Open => open(run, name, set),
                    ContactState::Closed => closed(run, name, set),
                }?;
                if let Some(shares) =
                    modes.shares.as_mut().filter(|_| !is_of_parts_alone(self.prepared, name))
                {
                    let alone = PartsAlone::of(self.prepared, &run.results.all::<NamedModes>());
                    let shape = |k: usize, i: usize| modes.modes.shapes[(i, k)].into();
                    compare_with_parts(shares, &alone, &modes.dofs, shape);
                }
                let compared = self.tests.modes(set, &modes);
                run.found(modes)?;
                compared.into_iter().try_for_each(|comparison| run.found(comparison))?;
            }
        }
        Ok(())
    }
}

/// Real modes without contact. Lists of the whole's modes take their share of those that span the complex analysis, where nothing rotates.
fn open(run: &mut Run, name: &str, set: &ModesAnalysis) -> Result<NamedModes> {
    let prepared = run.prepared;
    if of_the_whole(prepared, set)
        && prepared.model.rotations.is_empty()
        && let Some(basis) = run.basis()?
        && let Some(modes) = basis.lowest(wanted(set, prepared.system.n_dofs()))
    {
        return Ok(named(prepared, name, modes, (&prepared.model, &prepared.assembled)));
    }
    run.timed(&format!("real modes, {name}"), |observer| part_modes(prepared, name, observer))
}

/// Real modes with the contact as it is in steady sliding, at rest for the rest.
fn closed(run: &mut Run, name: &str, set: &ModesAnalysis) -> Result<NamedModes> {
    let prepared = run.prepared;
    let steady = run.steady()?;
    let system = System { structure: prepared.assembled.structure.clone(), ..prepared.system.clone() };
    let structure = equilibrium::closed_structure(&system, &steady)?;
    let wanted = wanted(set, prepared.system.n_dofs());
    let phase = format!("real modes, {name}");
    let (modes, _) = run.timed(&phase, |observer| modal::compute(&structure, wanted, observer))?;
    Ok(named(prepared, name, modes, (&prepared.model, &prepared.assembled)))
}
