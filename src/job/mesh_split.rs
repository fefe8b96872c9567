//! How the mesh of a body of revolution splits its double modes, and what complex modes would be without that.
//!
//! A body of revolution has its modes with nodal diameters twice at one frequency. A mesh that is not symmetric parts the two, and friction may then
//! couple them, or be kept from coupling them. With the modes φ of the part alone, free but for what holds it all around, φᵀMφ = 1, and the mean ω̄² of each pair,
//!
//! ΔK = Σ (ω̄² − ω²) Mφ φᵀM
//!
//! takes the split away and leaves all else as it is.

use super::model::part_model;
use super::operating_point::OperatingPoint;
use super::prepared::Prepared;
use crate::case::{ContactState, ModesAnalysis};
use crate::error::Result;
use crate::linalg::sparse::multiply_vector;
use crate::modal::{self, Disc, ModesWanted, RealModes, levels};
use crate::progress::Observer;
use crate::stability::{ComplexMode, StiffnessChange, changed_eigenvalues};
use crate::structure::{
    Assembled, Model, Rotation, RotationAxis, Support, assemble, deviation, is_even_around,
};
use std::collections::HashSet;
use std::f64::consts::TAU;

/// Modes of parts are taken up to this many times the highest frequency of the complex modes.
const REACH: f64 = 1.2;
/// Two modes of one name with nodal diameters are a pair where ω² differs by less than this part.
const PAIR: f64 = 0.1;
/// The rim is round where its radius varies by less than this part, in so many sectors.
const ROUND: f64 = 1e-4;
const SECTORS: usize = 12;
/// A split below this part of ω² is rounding.
const ROUNDING: f64 = 1e-10;

/// σ \[1/s\] of each unstable mode without the split, to first order; `None` of others, and of all where no part is a body of revolution.
///
/// # Errors
/// Modes of a part that cannot be computed.
pub fn growth_without_split(
    point: &OperatingPoint<'_>,
    modes: &[ComplexMode],
    observer: &dyn Observer,
) -> Result<Vec<Option<f64>>> {
    let mut growth = vec![None; modes.len()];
    let unstable: Vec<usize> = (0..modes.len()).filter(|k| modes[*k].unstable()).collect();
    let highest = unstable.iter().map(|k| modes[*k].frequency_hz()).fold(0.0, f64::max);
    if highest > 0.0
        && let Some(change) = without_split(point.prepared, REACH * highest, observer)?
    {
        let found = match change.terms.is_empty() {
            true => unstable.iter().map(|k| Some(modes[*k].eigenvalue)).collect(),
            false => {
                changed_eigenvalues((&point.system, &point.steady), (modes, &point.real), &unstable, &change)?
            }
        };
        unstable.iter().zip(found).for_each(|(k, lambda)| growth[*k] = lambda.map(|lambda| lambda.re));
    }
    Ok(growth)
}

/// ΔK of all parts that are bodies of revolution, of their modes below `hz`; `None` where there is no such part.
fn without_split(prepared: &Prepared, hz: f64, observer: &dyn Observer) -> Result<Option<StiffnessChange>> {
    let mut change = None;
    for (name, disc) in prepared.discs() {
        // What falls upon itself when turned by one element is round, too, and that is soon seen.
        let even = is_even(prepared, name, &disc);
        if !is_of_revolution(prepared, name, &disc, even) {
            continue;
        }
        let change = change.get_or_insert_with(StiffnessChange::default);
        if even {
            continue;
        }
        let alone = ModesAnalysis {
            parts: vec![name.to_string()],
            clamp: Vec::new(),
            free: true,
            below: Some(hz),
            count: None,
            contact: ContactState::Open,
            frequency_scale: 1.0,
            measured: Vec::new(),
            measured_source: String::new(),
            uff: false,
        };
        let mut model = part_model(&prepared.regions, &prepared.model, name, &alone)?;
        model.masses.clear();
        model.supports.extend(all_around(prepared, &disc, &model));
        let mut assembled = assemble(&model)?;
        assembled.structure.engine = prepared.system.structure.engine.clone();
        let (modes, _) = modal::compute(&assembled.structure, ModesWanted::BelowHz(hz), observer)?;
        for (k, split) in splits(&modes, &disc, &assembled) {
            change.terms.push((split, on_the_whole(prepared, &assembled, modes.shapes.col_as_slice(k))));
        }
    }
    Ok(change)
}

/// The supports of a part that hold every displacement in all sectors about its axis, of its own nodes.
fn all_around(prepared: &Prepared, disc: &Disc, part: &Model) -> Vec<Support> {
    let own: HashSet<usize> = part.parts.iter().flat_map(|part| part.nodes()).collect();
    let axis = axis_of(disc);
    let across = axis.arm(prepared.model.nodes[disc.nodes[0]]);
    let beside = disc.normal.cross(&across);
    let sector = |node: &usize| {
        let arm = axis.arm(prepared.model.nodes[*node]);
        sector(beside.dot(&arm).atan2(across.dot(&arm)))
    };
    let of = |support: &Support| {
        let nodes: Vec<usize> = support.nodes.iter().copied().filter(|node| own.contains(node)).collect();
        let sectors: HashSet<usize> = nodes.iter().map(sector).collect();
        (support.held[..3] == [true; 3] && sectors.len() == SECTORS)
            .then_some(Support { nodes, held: support.held })
    };
    prepared.model.supports.iter().filter_map(of).collect()
}

fn axis_of(disc: &Disc) -> RotationAxis {
    RotationAxis { point: disc.centre.into(), direction: disc.normal.into() }
}

/// Whether the mesh of the part splits no double mode, which needs no modes to see.
fn is_even(prepared: &Prepared, name: &str, disc: &Disc) -> bool {
    prepared.model.part(name).is_some_and(|part| is_even_around(part, &prepared.model.nodes, &axis_of(disc)))
}

fn is_of_revolution(prepared: &Prepared, name: &str, disc: &Disc, even: bool) -> bool {
    let axis = axis_of(disc);
    let isotropic =
        prepared.model.part(name).is_some_and(|part| part.kind.material().is_isotropic_about(axis.direction));
    let rotation = Rotation {
        parts: vec![name.to_string()],
        axis,
        speed: 0.0,
        gyroscopic: false,
        transport: false,
        spin_stiffness: false,
    };
    isotropic && has_round_rim(disc) && (even || deviation(&prepared.model, &rotation).is_none())
}

/// Whether the outermost nodes of all sectors are on one circle; [`deviation`] allows for as much as coarse faces are off one.
fn has_round_rim(disc: &Disc) -> bool {
    let mut radii = [0.0_f64; SECTORS];
    for (r, angle) in &disc.polar {
        let outermost = &mut radii[sector(*angle)];
        *outermost = outermost.max(*r);
    }
    let [least, most] =
        [radii.iter().fold(f64::INFINITY, |m, r| m.min(*r)), radii.iter().fold(0.0, |m: f64, r| m.max(*r))];
    most - least <= ROUND * most
}

/// In which of the sectors an angle \[rad\] is.
fn sector(angle: f64) -> usize {
    ((angle.rem_euclid(TAU) / TAU * SECTORS as f64) as usize).min(SECTORS - 1)
}

/// The modes of pairs with ω̄² − ω² \[rad²/s²\]: of one name with nodal diameters, or without names all but equal.
fn splits(modes: &RealModes, disc: &Disc, assembled: &Assembled) -> Vec<(usize, f64)> {
    let first = modes.rigid_bodies;
    let motion = |k: usize, node: usize, dof: usize| -> f64 {
        assembled.dofs.terms(node, dof).iter().map(|(free, by)| by * modes.shapes[(*free, k)]).sum()
    };
    let name = |k: usize| disc.name(|node| [0, 1, 2, 3, 4, 5].map(|dof| motion(k, node, dof)));
    let names: Vec<_> = (first..modes.len()).map(name).collect();
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    let mut single: Vec<usize> = Vec::new();
    for k in 0..names.len() {
        let bends = names[k].is_some_and(|name| name.nodal_diameters > 0);
        let near = |other: &usize| {
            modes.eigenvalues[first + k] - modes.eigenvalues[first + other]
                < PAIR * modes.eigenvalues[first + k]
        };
        match single.iter().rposition(|other| bends && names[*other] == names[k] && near(other)) {
            Some(place) => pairs.push([single.remove(place), k]),
            None => single.push(k),
        }
    }
    let nameless: Vec<usize> = single.into_iter().filter(|k| names[*k].is_none()).collect();
    let hz: Vec<f64> = nameless.iter().map(|k| modes.frequency_hz(first + k)).collect();
    let all_but_equal = levels(&hz, &vec![None; hz.len()]);
    pairs.extend(
        all_but_equal
            .iter()
            .filter(|level| level.len() == 2)
            .map(|l| [nameless[l.start], nameless[l.start + 1]]),
    );
    let terms = pairs.into_iter().flat_map(|pair| {
        let [a, b] = pair.map(|k| modes.eigenvalues[first + k]);
        let mean = 0.5 * (a + b);
        let split =
            (b - a > ROUNDING * mean).then(|| [(first + pair[0], mean - a), (first + pair[1], mean - b)]);
        split.into_iter().flatten()
    });
    terms.collect()
}

/// Mφ of a shape of a part on the degrees of freedom of the whole.
fn on_the_whole(prepared: &Prepared, part: &Assembled, shape: &[f64]) -> Vec<f64> {
    let force = multiply_vector(&part.structure.mass, shape);
    let whole = &prepared.assembled.dofs;
    let mut g = vec![0.0; whole.n_dofs()];
    for (node, dof) in (0..prepared.model.nodes.len()).flat_map(|node| (0..6).map(move |dof| (node, dof))) {
        for (own, factor) in part.dofs.terms(node, dof) {
            whole.terms(node, dof).iter().for_each(|(free, by)| g[*free] += by * factor * force[*own]);
        }
    }
    g
}

#[cfg(test)]
mod tests;
