//! Real modes of one part or of the whole, with names and effective masses.

use super::links::in_terms_of_the_case;
use super::part_shares::real_shares;
use super::prepared::Prepared;
use crate::case::{Case, CeaAnalysis, ContactState, ModesAnalysis};
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::add_scaled;
use crate::modal::{self, DiscModeName, ModesWanted, RealModes};
use crate::numbers::{hertz, typed};
use crate::results::NamedModes;
use crate::structure::{self, Assembled, Model, PartForms, PartMatrix, assemble};
use crate::system::{ModalDamping, Structure};
use faer::Mat;
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Degrees of freedom for each mode at least where a mesh resolves modes: several nodes for each half wave, in both directions.
const DOFS_OF_A_MODE: usize = 10;
/// So many modes are computed whatever the mesh is.
const FEW_MODES: usize = 200;

/// Runs one real-mode analysis of the case on a part alone.
///
/// # Errors
/// Regions that are missing, a part without mass, or an eigensolver that cannot prove its result.
pub fn part_modes(
    prepared: &Prepared,
    name: &str,
    observer: &dyn crate::progress::Observer,
) -> Result<NamedModes> {
    let (model, assembled) = part_assembled(prepared, name)?;
    let wanted = wanted(&prepared.case.modes[name], assembled.dofs.n_dofs());
    let (modes, _) = modal::compute(&assembled.structure, wanted, observer)?;
    Ok(named(prepared, name, modes, (&model, &assembled)))
}

/// The model and its matrices of one real-mode analysis of the case: parts alone, or the whole, held as it says.
///
/// # Errors
/// Regions that are missing, or nothing that can move.
pub fn part_assembled<'p>(prepared: &'p Prepared, name: &str) -> Result<(Cow<'p, Model>, Arc<Assembled>)> {
    let analysis = &prepared.case.modes[name];
    let (model, assembled) = if prepared.case.matrices.is_some() || of_the_whole(prepared, analysis) {
        (Cow::Borrowed(&prepared.model), prepared.assembled.clone())
    } else {
        let model = super::model::part_model(&prepared.regions, &prepared.model, name, analysis)?;
        let clamp = (!analysis.clamp.is_empty()).then(|| format!("`modes.{name}.clamp`"));
        let mut assembled =
            assemble(&model).map_err(|error| in_terms_of_the_case(error, prepared.case, clamp))?;
        assembled.structure.engine = prepared.system.structure.engine.clone();
        (Cow::Owned(model), Arc::new(assembled))
    };
    if assembled.dofs.n_dofs() == 0 {
        return Err(Error::input(Fault::new(
            format!("`modes.{name}`"),
            "no free degree of freedom",
            "parts that can move",
        )));
    }
    Ok((model, assembled))
}

/// Whether the structure of one real-mode analysis can be built.
///
/// # Errors
/// Regions that are missing, or nothing that can move.
pub fn check_part(prepared: &Prepared, name: &str) -> Result<()> {
    let analysis = &prepared.case.modes[name];
    if prepared.case.matrices.is_some() || of_the_whole(prepared, analysis) {
        return Ok(());
    }
    structure::check(&super::model::part_model(&prepared.regions, &prepared.model, name, analysis)?)
}

/// Which modes an analysis of a structure with `n_dofs` degrees of freedom asks for.
pub fn wanted(analysis: &ModesAnalysis, n_dofs: usize) -> ModesWanted {
    match (analysis.below, analysis.count) {
        (Some(below), _) => ModesWanted::BelowHz(below),
        (None, count) => ModesWanted::Count(count.unwrap_or(1).min(n_dofs)),
    }
}

/// Whether an analysis is of the whole structure, held as the case holds it, without contact.
pub fn of_the_whole(prepared: &Prepared, analysis: &ModesAnalysis) -> bool {
    let model = &prepared.model;
    let mut parts = model.parts.iter().map(|part| &part.name);
    analysis.contact == ContactState::Open
        && !analysis.free
        && analysis.clamp.is_empty()
        && (analysis.parts.is_empty() || parts.all(|part| analysis.parts.contains(part)))
}

/// The state of the contacts in a real-mode analysis, and with it whether the stiffness of the preload counts: without contacts the whole
/// is as its forces stress it.
pub fn contact_state(prepared: &Prepared, analysis: &ModesAnalysis) -> ContactState {
    let stressed = prepared.case.stressed_by_forces() && of_the_whole(prepared, analysis);
    if stressed { ContactState::Closed } else { analysis.contact }
}

/// What to know where `prestress` does not act on an analysis at `place` of the whole with open contacts.
pub fn without_prestress(case: &Case, place: &str, other: &str) -> Option<String> {
    (case.prestress && !case.contact.is_empty()).then(|| {
        format!(
            "{place} is of open contacts, where nothing presses: `prestress` does not act on it. `contact = \"{other}\"` has the \
             stiffness of the preload"
        )
    })
}

/// Real modes with names, shares of the parts and effective masses, of `model` and its matrices.
pub fn named(
    prepared: &Prepared,
    name: &str,
    modes: RealModes,
    (model, assembled): (&Model, &Assembled),
) -> NamedModes {
    let ratios = given_ratios(prepared.case, &modes).ratios;
    let shares = real_shares((model, assembled), &modes, &ratios);
    let moving = |k: usize| shares.as_ref().and_then(|shares| shares.moving_part(k).map(String::from));
    let moving_part: Vec<Option<String>> = (0..modes.len()).map(moving).collect();
    NamedModes {
        name: name.to_string(),
        dofs: assembled.dofs.clone(),
        names: disc_names(prepared, &modes, &moving_part, assembled),
        moving_part,
        effective_mass: effective_masses(&modes, assembled),
        total_mass: assembled.total_mass,
        damping_ratio: modal::damping_ratios(&modes, ratios, &assembled.structure.damping),
        shares,
        universal: prepared.case.modes.get(name).is_some_and(|analysis| analysis.uff),
        modes,
    }
}

/// The name of each mode that bends a disc, where that is the part that moves most.
fn disc_names(
    prepared: &Prepared,
    modes: &RealModes,
    moving_part: &[Option<String>],
    assembled: &Assembled,
) -> Vec<Option<DiscModeName>> {
    let discs = prepared.discs();
    let name = |k: usize| {
        let (_, disc) = discs.iter().find(|(name, _)| moving_part[k].as_deref() == Some(*name))?;
        let along = |node: usize, dof: usize| -> f64 {
            assembled
                .dofs
                .terms(node, dof)
                .iter()
                .map(|(free, factor)| factor * modes.shapes[(*free, k)])
                .sum()
        };
        disc.name(|node| [0, 1, 2, 3, 4, 5].map(|dof| along(node, dof)))
    };
    (0..modes.len()).map(|k| if k < modes.rigid_bodies { None } else { name(k) }).collect()
}

/// Effective masses along x, y and z; none of an imported matrix without the places of its rows, which has no directions.
fn effective_masses(modes: &RealModes, assembled: &Assembled) -> Vec<[f64; 3]> {
    if !assembled.total_mass.is_finite() {
        return Vec::new();
    }
    let rigid = assembled.dofs.rigid_body_vectors([0.0; 3]);
    let translations = Mat::from_fn(assembled.dofs.n_dofs(), 3, |i, axis| rigid[axis][i]);
    let mass = &assembled.structure.mass;
    let effective = modal::effective_mass(mass, modes.shapes.as_ref(), translations.as_ref()).effective;
    (0..modes.len()).map(|k| [0, 1, 2].map(|axis| effective[(k, axis)])).collect()
}

/// Damping ratios that the case gives by mode. They are of modes of the whole: a part need not have one near each.
fn given_ratios(case: &Case, modes: &RealModes) -> modal::GivenRatios {
    given_below(case, modes, damped_without_band(case))
}

fn given_below(case: &Case, modes: &RealModes, below: f64) -> modal::GivenRatios {
    modal::given_ratios(modes, (case.damping.modal_ratio, below), &case.damping.modal_ratios)
}

/// The part with the largest share of the kinetic energy of each mode.
fn moving_parts(modes: &RealModes, (model, assembled): (&Model, &Assembled)) -> Vec<Option<String>> {
    if model.parts.is_empty() {
        return vec![None; modes.len()];
    }
    let [kinetic] = PartForms::new(model, assembled).of([PartMatrix::Mass], modes.shapes.as_ref());
    let most = |k: usize| (0..model.parts.len()).max_by(|a, b| kinetic[(*a, k)].total_cmp(&kinetic[(*b, k)]));
    (0..modes.len()).map(|k| most(k).map(|part| model.parts[part].name.clone())).collect()
}

/// The part that moves most in a mode, and the mode's name where that is a disc.
pub type Identity = (Option<String>, Option<DiscModeName>);

/// The identity of each mode of a structure: of `model` and its matrices.
pub fn identify(prepared: &Prepared, modes: &RealModes, of: (&Model, &Assembled)) -> Vec<Identity> {
    let moving_part = moving_parts(modes, of);
    let names = disc_names(prepared, modes, &moving_part, of.1);
    moving_part.into_iter().zip(names).collect()
}

/// A few words on each real mode: the part that moves most and, for a disc, (nodal diameters, circles); rigid-body modes by their number.
pub fn labels(identities: &[Identity], modes: &RealModes) -> Vec<String> {
    let label = |(k, (part, name)): (usize, &Identity)| {
        let part = part.as_deref().unwrap_or("mode");
        match name {
            _ if k < modes.rigid_bodies => format!("{part} rigid body {}", k + 1),
            Some(n) => format!("{part} ({}, {})", n.nodal_diameters, n.nodal_circles),
            None => format!("{part} {} Hz", hertz(modes.frequency_hz(k), 0)),
        }
    };
    identities.iter().enumerate().map(label).collect()
}

/// The frequency \[Hz\] up to which real modes have `modal_ratio` in what is about the complex modes of `cea`: a property of the machine,
/// so that what spans the analysis does not move it. Abaqus likewise damps the modes that `*MODAL DAMPING` names, and no others.
pub fn damped_below(case: &Case, cea: &CeaAnalysis) -> f64 {
    case.damping.modal_below.unwrap_or(1.5 * cea.band[1])
}

/// The frequency \[Hz\] up to which real modes are computed for the complex modes of `cea`, where `basis_below` of them span the first
/// subspace: those that have modal damping are among them.
pub fn real_modes_below(case: &Case, cea: &CeaAnalysis, basis_below: f64) -> f64 {
    basis_below.max(damping_needs(case, damped_below(case, cea)))
}

/// The frequency \[Hz\] up to which the real modes must be known for the modal damping of the case, where those up to `below` have
/// `modal_ratio`; zero where it has none.
fn damping_needs(case: &Case, below: f64) -> f64 {
    let uniform = if case.damping.modal_ratio > 0.0 { below } else { 0.0 };
    case.damping.modal_ratios.iter().fold(uniform, |top, [hz, _]| top.max((1.0 + modal::NEAR) * hz))
}

/// Refuses frequencies of the modal damping below which so many real modes lie that the mesh cannot resolve those near it: all of them would
/// have to be computed. `below` \[Hz\] is up to where they are computed whatever the damping is.
///
/// # Errors
/// Such a frequency; a matrix that cannot be factorised.
pub fn check_damping_frequencies(structure: &Structure, case: &Case, below: f64) -> Result<()> {
    let damping = &case.damping;
    let uniform = damping.modal_below.filter(|_| damping.modal_ratio > 0.0).map(|hz| ("modal_below", hz));
    let given = damping.modal_ratios.iter().map(|[hz, _]| ("modal_ratios", *hz));
    let mut far: Vec<(&str, f64)> = uniform.into_iter().chain(given).filter(|(_, hz)| *hz > below).collect();
    far.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (k, m) = (&structure.stiffness, &structure.mass);
    let dofs = k.ncols();
    let most = (dofs / DOFS_OF_A_MODE).max(FEW_MODES);
    let mut faults = Faults::new();
    for (key, hz) in far.into_iter().filter(|_| dofs > most) {
        let pencil = add_scaled(&[(1.0, k), (-(TAU * hz).powi(2), m)]);
        let count = structure.engine.analyse(pencil.symbolic())?.inertia(&pencil)?.negative;
        if count <= most {
            break;
        }
        let found =
            format!("{} Hz, below which {count} real modes of {dofs} degrees of freedom lie", typed(hz));
        let expected = format!("a frequency below which the mesh resolves the modes: {most} of them at most");
        let fault = Fault::new(format!("`damping.{key}`"), found, expected);
        faults.push(fault.with_help(
            "Modes far above the band do not matter to it: leave the frequency out, or refine the mesh",
        ));
    }
    faults.into_result(())
}

/// What [`modal_damping`] makes of the real modes of a frequency response: all of them have `modal_ratio`, unless the case says up to
/// which.
///
/// # Errors
/// Those of [`modal_damping`].
pub fn damping_of_response(
    mass: &SparseMatrix,
    modes: &RealModes,
    case: &Case,
) -> Result<Option<ModalDamping>> {
    modal_damping(mass, modes, case, damped_without_band(case))
}

/// The frequency \[Hz\] up to which real modes have `modal_ratio` in what is not about complex modes.
pub fn damped_without_band(case: &Case) -> f64 {
    case.damping.modal_below.unwrap_or(f64::INFINITY)
}

/// The frequency \[Hz\] up to which a frequency response needs the real modes for its damping.
pub fn response_needs(case: &Case) -> f64 {
    damping_needs(case, case.damping.modal_below.unwrap_or(0.0))
}

/// Gives a structure the modal damping that the case has for complex modes, if any, from its real modes ([`real_modes_below`]).
///
/// # Errors
/// Those of [`modal_damping`].
pub fn add_modal_damping(structure: &mut Structure, modes: &RealModes, case: &Case) -> Result<()> {
    let Some(cea) = &case.cea else { return Ok(()) };
    if let Some(modal) = modal_damping(&structure.mass, modes, case, damped_below(case, cea))? {
        structure.damping.modal = Some(modal);
    }
    Ok(())
}

/// C = M Φ diag(2ζω) Φᵀ M for the modal damping of the case, given the real modes of the whole; none where it has none.
///
/// # Errors
/// A ratio that names a frequency without a mode near it.
pub fn modal_damping(
    mass: &SparseMatrix,
    modes: &RealModes,
    case: &Case,
    below: f64,
) -> Result<Option<ModalDamping>> {
    if case.damping.modal_ratio == 0.0 && case.damping.modal_ratios.is_empty() {
        return Ok(None);
    }
    let ratios = modal_ratios(case, modes, below)?;
    Ok(Some(modal::modal_damping(mass, modes, &ratios)))
}

/// ζ of every real mode of the whole, where those up to `below` \[Hz\] have `modal_ratio`.
///
/// # Errors
/// A ratio that names a frequency without a mode near it.
pub fn modal_ratios(case: &Case, modes: &RealModes, below: f64) -> Result<Vec<f64>> {
    let modal::GivenRatios { ratios, without_mode } = given_below(case, modes, below);
    let fault = |hz: &f64| {
        Fault::new(
            "`damping.modal_ratios`",
            format!("{hz} Hz, with no mode of the rig within 10 %"),
            "frequencies near modes of the rig",
        )
    };
    Faults(without_mode.iter().map(fault).collect()).into_result(ratios)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::samples::disc;
    use std::collections::BTreeMap;
    use std::f64::consts::PI;

    /// Frequencies \[Hz\] of the modes of each name of a disc clamped at a hub of 20 mm.
    fn named(radial: usize, around: usize, below_hz: f64) -> BTreeMap<(usize, usize), Vec<f64>> {
        let text = disc(radial, around).replace("\"15 mm\"", "\"20 mm\"");
        let text = format!("{text}[modes.disc]\nbelow = {below_hz}\n");
        let case = Case::parse("case.toml", &text, ".".into()).unwrap();
        let found = part_modes(&Prepared::new(&case).unwrap(), "disc", &()).unwrap();
        let mut all: BTreeMap<_, Vec<f64>> = BTreeMap::new();
        for (k, name) in found.names.iter().enumerate() {
            if let Some(name) = name {
                let hz = found.modes.frequency_hz(k);
                all.entry((name.nodal_diameters, name.nodal_circles)).or_default().push(hz);
            }
        }
        all
    }

    /// Chains of masses between walls, ω_j = 2 √(k/m) sin(jπ/(2(n + 1))): frequencies are refused that more modes lie below than are resolved,
    /// by the key that has them, and no others.
    #[test]
    fn damping_is_not_given_where_the_mesh_resolves_nothing() {
        let text = disc(2, 12);
        let mut case = Case::parse("case.toml", &text, ".".into()).unwrap();
        for n in [150usize, 210, 260] {
            let entry = |i: usize, j: usize| match i.abs_diff(j) {
                0 => 2e4,
                1 => -1e4,
                _ => 0.0,
            };
            let chain = crate::equilibrium::samples::structure(n, |i, j| f64::from(i == j), entry);
            let hz = |j: f64| 200.0 * (0.5 * PI * j / (n as f64 + 1.0)).sin() / TAU;
            let most = (n / DOFS_OF_A_MODE).max(FEW_MODES);
            for count in [10, 149, 199, 200, 201, 205, 250].into_iter().filter(|count| *count < n) {
                for uniform in [true, false] {
                    let given = hz(count as f64 + 0.5);
                    case.damping.modal_ratio = if uniform { 0.01 } else { 0.0 };
                    case.damping.modal_below = uniform.then_some(given);
                    case.damping.modal_ratios =
                        if uniform { Vec::new() } else { vec![[1.0, 0.1], [given, 0.01]] };
                    let said = check_damping_frequencies(&chain, &case, 2.0);
                    let said = said.map_or_else(|error| error.to_string(), |()| String::new());
                    let key = if uniform { "`damping.modal_below`" } else { "`damping.modal_ratios`" };
                    let refused = count > most;
                    assert_eq!(
                        said.contains(&format!("below which {count} real modes")),
                        refused,
                        "{n} {count}: {said}"
                    );
                    assert!(said.is_empty() != refused && said.contains(key) == refused, "{said}");
                }
            }
        }
    }

    #[test]
    fn coarse_discs_have_no_wrong_names() {
        let fine = named(12, 60, 8e3);
        let coarse = named(8, 48, 6e3);
        // Kirchhoff's plate by Bessel functions; what is left is of the mesh.
        for (n, exact) in [(0, 4974.8), (1, 5085.8), (2, 5430.9), (3, 6036.4)] {
            for (meshed, bound) in [(&fine, 0.01), (&coarse, 0.02)] {
                let hz = meshed.get(&(n, 2)).unwrap_or_else(|| panic!("no ({n}, 2)"))[0];
                assert!(
                    within((hz / exact - 1.0).abs(), bound, Discretisation),
                    "({n}, 2): {hz} for {exact}"
                );
            }
        }
        for (radial, around) in
            [(8, 48), (8, 96), (6, 36), (5, 24), (4, 12), (8, 12), (2, 40), (1, 30), (12, 20)]
        {
            for (name, all) in named(radial, around, 6e3) {
                assert!(all.len() <= if name.0 > 0 { 2 } else { 1 }, "{radial} × {around} {name:?}: {all:?}");
                let right =
                    fine.get(&name).unwrap_or_else(|| panic!("{radial} × {around} {name:?}: {all:?}"))[0];
                // One element from hub to rim is a fifth too stiff; with another name a frequency is half as far again away, at least.
                assert!(
                    all.iter().all(|hz| within((hz / right - 1.0).abs(), 0.25, Discretisation)),
                    "{radial} × {around} {name:?}: {all:?} for {right}"
                );
            }
        }
    }
}
