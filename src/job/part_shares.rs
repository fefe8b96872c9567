//! Shares of the parts in the energies and the damping of modes, and the motion of discs in complex modes.

use super::prepared::Prepared;
use crate::linalg::c64;
use crate::modal::{DiscModeName, RealModes};
use crate::results::{MODAL, POINTS, PartShare, PartShares};
use crate::stability::ComplexMode;
use crate::structure::{Assembled, DofMap, Model, PartForms, PartMatrix};
use crate::system::ModalDamping;
use faer::{Mat, MatRef};
use std::f64::consts::TAU;

/// Complex modes whose parts are held at once.
const PANEL: usize = 8;
/// A disc's motion has a name where the disc has this share of the kinetic energy.
const MOVES: f64 = 0.1;

/// What is needed beside the shape of a mode: ω \[rad/s\], and φᴴCφ of damping that the case gives by mode, for φᴴMφ = 1.
#[derive(Clone, Copy)]
struct Swing {
    /// `None` of a motion that does not oscillate, which has neither strain nor damping in a period.
    omega: Option<f64>,
    modal: f64,
}

/// The shares in real modes of a structure, whose modal damping ratios are `ratios`; `None` of one without parts.
pub fn real_shares(
    (model, assembled): (&Model, &Assembled),
    modes: &RealModes,
    ratios: &[f64],
) -> Option<PartShares> {
    let forms = forms(model, assembled)?;
    let swing = |k: usize| {
        let omega = TAU * modes.frequency_hz(k);
        let omega = (k >= modes.rigid_bodies && omega > 0.0).then_some(omega);
        Swing { omega, modal: omega.map_or(0.0, |omega| 2.0 * ratios[k] * omega) }
    };
    let swings: Vec<Swing> = (0..modes.len()).map(swing).collect();
    Some(named(model, shares(&forms, modes.shapes.as_ref(), &swings)))
}

/// The shares in complex modes of the whole, whose system has the damping `modal`; `None` without parts.
pub fn complex_shares(
    prepared: &Prepared,
    modes: &[ComplexMode],
    modal: Option<&ModalDamping>,
) -> Option<PartShares> {
    let forms = forms(&prepared.model, &prepared.assembled)?;
    let mut all = Vec::with_capacity(modes.len());
    for modes in modes.chunks(PANEL) {
        // The form of a symmetric matrix is the sum of those of the real and the imaginary part.
        let n = prepared.assembled.dofs.n_dofs();
        let columns = Mat::from_fn(n, 2 * modes.len(), |i, c| {
            let z = modes[c / 2].right[i];
            [z.re, z.im][c % 2]
        });
        let along = modal.map(|modal| (modal, modal.basis.transpose() * &columns));
        let swing = |(k, mode): (usize, &ComplexMode)| {
            let of = |(modal, along): &(&ModalDamping, Mat<f64>)| -> f64 {
                let motion = |i: usize| along[(i, 2 * k)].powi(2) + along[(i, 2 * k + 1)].powi(2);
                modal.coefficients.iter().enumerate().map(|(i, c)| c * motion(i)).sum()
            };
            let omega = (mode.frequency_hz() > 0.0 && !mode.is_zero()).then_some(mode.eigenvalue.im);
            Swing { omega, modal: along.as_ref().map_or(0.0, of) }
        };
        let swings: Vec<Swing> = modes.iter().enumerate().map(swing).collect();
        all.extend(shares(&forms, columns.as_ref(), &swings));
    }
    Some(named(&prepared.model, all))
}

fn forms<'a>(model: &'a Model, assembled: &'a Assembled) -> Option<PartForms<'a>> {
    (!model.parts.is_empty()).then(|| PartForms::new(model, assembled))
}

/// The shares of parts, masses and springs, and modal damping in modes that are each as many columns as there are columns for a mode.
fn shares(forms: &PartForms, columns: MatRef<'_, f64>, swings: &[Swing]) -> Vec<Vec<PartShare>> {
    use PartMatrix::{Hysteretic, Mass, Stiffness, Viscous};
    let each = columns.ncols() / swings.len().max(1);
    let all = forms.of([Mass, Stiffness, Viscous, Hysteretic], columns);
    let of = |(k, swing): (usize, &Swing)| {
        let form =
            |which: usize, p: usize| (k * each..(k + 1) * each).map(|c| all[which][(p, c)]).sum::<f64>();
        let n = all[0].nrows();
        let kinetic = parted((0..n).map(|p| form(0, p)).chain([0.0]));
        let none = vec![None; n + 1];
        let [strain, damping] = match swing.omega {
            None => [none.clone(), none],
            Some(omega) => {
                let lost = (0..n).map(|p| omega * form(2, p) + form(3, p));
                let modal = omega * swing.modal;
                [parted((0..n).map(|p| form(1, p)).chain([0.0])), parted(lost.chain([modal]))]
            }
        };
        let share =
            |p: usize| PartShare { kinetic: kinetic[p], strain: strain[p], damping: damping[p], alone: None };
        (0..=n).map(share).collect()
    };
    swings.iter().enumerate().map(of).collect()
}

/// Values as parts of their sum; none where that is zero.
fn parted(values: impl Iterator<Item = f64>) -> Vec<Option<f64>> {
    let values: Vec<f64> = values.collect();
    let sum: f64 = values.iter().sum();
    values.iter().map(|value| (sum > 0.0).then(|| value / sum)).collect()
}

/// The shares with the names of their parts, without those beyond the parts that are zero in all modes.
fn named(model: &Model, mut modes: Vec<Vec<PartShare>>) -> PartShares {
    let mut parts: Vec<String> = model.parts.iter().map(|part| part.name.clone()).collect();
    for (name, place) in [(MODAL, parts.len() + 1), (POINTS, parts.len())] {
        let there = |share: &PartShare| {
            [share.kinetic, share.strain, share.damping].iter().any(|s| s.is_some_and(|s| s != 0.0))
        };
        if modes.iter().any(|shares| there(&shares[place])) {
            parts.insert(model.parts.len(), name.into());
        } else {
            modes.iter_mut().for_each(|shares| drop(shares.remove(place)));
        }
    }
    PartShares { parts, modes }
}

/// The name of the motion of the disc in each complex mode: of the one that moves most, where it has a tenth of the kinetic energy.
pub fn moving_discs(
    prepared: &Prepared,
    modes: &[ComplexMode],
    shares: Option<&PartShares>,
) -> Vec<Option<DiscModeName>> {
    let (discs, dofs) = (prepared.discs(), &prepared.assembled.dofs);
    let of = |(k, mode): (usize, &ComplexMode)| {
        let moves = |name: &str| shares.map_or(0.0, |shares| shares.kinetic(k, name));
        let most = discs.iter().max_by(|a, b| moves(a.0).total_cmp(&moves(b.0)));
        let (_, disc) = most.filter(|(name, _)| moves(name) >= MOVES && mode.frequency_hz() > 0.0)?;
        disc.name_complex(|node| [0, 1, 2, 3, 4, 5].map(|dof| motion(dofs, node, dof, |i| mode.right[i])))
    };
    modes.iter().enumerate().map(of).collect()
}

/// A displacement of a node, from what the free degrees of freedom do.
pub fn motion(dofs: &DofMap, node: usize, dof: usize, q: impl Fn(usize) -> c64) -> c64 {
    dofs.terms(node, dof).iter().map(|(free, factor)| q(*free) * *factor).sum()
}

#[cfg(test)]
mod tests;
