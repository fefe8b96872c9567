//! Complex eigenvalues at steady sliding.

use super::analysis::{Analysis, Planned, Scope};
use crate::case::{Case, CeaAnalysis};
use crate::error::Result;
use crate::job::complex::complex_result;
use crate::job::mesh_split::growth_without_split;
use crate::job::part_modes::{PartsAlone, compare_with_parts};
use crate::job::part_shares::{complex_shares, moving_discs};
use crate::job::prepared::Prepared;
use crate::job::run::Run;
use crate::results::NamedModes;

/// Complex eigenvalue analysis.
pub const CEA: Analysis = Analysis {
    name: "cea",
    about: "Steady sliding and complex eigenvalues only",
    example: Some("[cea] with `band = [0, \"6 kHz\"]`"),
    listed: |case| case.cea.is_some(),
    ready: |case| case.cea.is_some(),
    needs: &[],
    left_vectors: false,
    plan,
};

fn plan<'a>(prepared: &'a Prepared<'a>, _: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
    let wanted = prepared.case.cea.as_ref().ok_or_else(|| CEA.no_table())?;
    Ok(Box::new(PlannedCea { wanted, case: prepared.case }))
}

struct PlannedCea<'a> {
    wanted: &'a CeaAnalysis,
    case: &'a Case,
}

impl<'a> Planned<'a> for PlannedCea<'a> {
    fn slides(&self) -> bool {
        true
    }

    fn warnings(&self) -> Vec<String> {
        not_all_of_the_band(self.wanted).into_iter().chain(damped_in_part(self.case, self.wanted)).collect()
    }

    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()> {
        let steady = run.steady()?;
        run.basis()?;
        let (basis, left_vectors) = (run.basis.take(), run.left_vectors);
        let at = (run.prepared, steady);
        let (mut complex, point) =
            complex_result(at, self.wanted, basis, left_vectors, &mut run.clock, run.observer)?;
        let (prepared, modes) = (run.prepared, &complex.modes.modes);
        complex.shares = complex_shares(prepared, modes, point.system.structure.damping.modal.as_ref());
        complex.discs = moving_discs(prepared, modes, complex.shares.as_ref());
        if let Some(shares) = &mut complex.shares {
            let alone = PartsAlone::of(prepared, &run.results.all::<NamedModes>());
            compare_with_parts(shares, &alone, &complex.dofs, |k, i| modes[k].right[i]);
        }
        let found = run.timed("growth without the split of double modes", |observer| {
            growth_without_split(&point, modes, observer)
        });
        match found {
            Ok(growth) => complex.without_split = growth,
            Err(error) => {
                run.results.warnings.push(format!("No growth without the split of double modes: {error}"))
            }
        }
        run.results.warnings.extend(complex.modes.warnings.iter().cloned());
        run.operating_point = Some(point.into());
        run.found(complex)
    }
}

/// Says that `nearest` leaves modes of a band that the case gives beside it.
fn not_all_of_the_band(cea: &CeaAnalysis) -> Option<String> {
    let (hz, count) = cea.nearest.zip(cea.count)?;
    let [low, high] = cea.band;
    let given = low != 0.0 || high != 4.0 * hz;
    given.then(|| {
        format!(
            "[cea] looks for the {count} complex modes nearest to {hz} Hz alone, not for all from {low} to {high} Hz; \
             without `nearest` and `count` it looks for all"
        )
    })
}

/// Says that some real modes of the band have no modal damping.
fn damped_in_part(case: &Case, cea: &CeaAnalysis) -> Option<String> {
    let below = case.damping.modal_below.filter(|below| *below < cea.band[1])?;
    (case.damping.modal_ratio > 0.0).then(|| {
        format!(
            "Modes from {below} to {} Hz have no modal damping, as `damping.modal_below` is below the upper end of `cea.band`",
            cea.band[1]
        )
    })
}
