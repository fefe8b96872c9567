//! Cross-sections of bars and beams.
//!
//! I₁ = ∫y² dA is of bending in the plane of the first axis y, I₂ = ∫z² dA of bending across it.

use super::fields::Fields;
use crate::deck::Profile;
use crate::ledger::Weight;
use std::f64::consts::PI;

/// Material, profile, and mass that stiffens nothing of PBAR, PBARL, PBEAM or PBEAML.
pub(super) fn profile(fields: &mut Fields) -> Option<(u64, Profile, f64)> {
    let material = fields.id(2)?;
    let name = fields.name();
    if name.ends_with('L') {
        let (profile, carried) = by_dimensions(fields)?;
        return Some((material, profile, carried));
    }
    let area = fields.real(3)?;
    let second_moments = [fields.real_or(4, 0.0)?, fields.real_or(5, 0.0)?];
    // PBEAM has I12 before J.
    let torsion_at = if name == "PBAR" { 6 } else { 7 };
    let torsion = fields.real_or(torsion_at, 0.0)?;
    let carried = fields.real_or(torsion_at + 1, 0.0)?;
    if name == "PBAR" {
        fields.unread(9, 16, Weight::Nothing, "places where stresses are wanted");
        fields.unread(17, 18, Weight::Perhaps, "factors of shear are not read");
        fields.unread(
            19,
            19,
            Weight::Matters,
            "I12 of a section whose axes are not principal ones is not read",
        );
    } else {
        fields.unread(
            6,
            6,
            Weight::Matters,
            "I12 of a section whose axes are not principal ones is not read",
        );
        fields.unread(9, 16, Weight::Nothing, "places where stresses are wanted");
        let last = fields.last();
        if last > 16 {
            let why = "stations along a beam, shear, mass and offsets are not read: the section of its first end holds";
            fields.unread(17, last, Weight::Matters, why);
        }
    }
    Some((material, Profile::General { area, second_moments, torsion }, carried))
}

/// A profile by its kind and dimensions. Source of the kinds: PBARL in the Quick Reference Guide; torsion of the full rectangle
/// J = a b³ (1/3 − 0.21 b/a (1 − b⁴/(12 a⁴))), of the thin-walled box 4 A²/∮ds/t and of thin open sections Σ b t³/3: Young, *Roark's Formulas for Stress and Strain*, table 10.1.
fn by_dimensions(fields: &mut Fields) -> Option<(Profile, f64)> {
    let kind = fields.word(4);
    fields.unread(3, 3, Weight::Nothing, "the group of profiles is not read");
    let mut dimension = |k: usize| fields.real(8 + k);
    let rectangle = |z: f64, y: f64| (z * y, [z * y.powi(3) / 12.0, y * z.powi(3) / 12.0]);
    let (n, profile) = match kind {
        "ROD" => (1, Profile::Round { diameter: 2.0 * dimension(1)? }),
        "TUBE" => {
            let (outer, inner) = (dimension(1)?, dimension(2)?);
            let moment = PI / 4.0 * (outer.powi(4) - inner.powi(4));
            let area = PI * (outer * outer - inner * inner);
            (2, Profile::General { area, second_moments: [moment; 2], torsion: 2.0 * moment })
        }
        "BAR" => {
            let (z, y) = (dimension(1)?, dimension(2)?);
            let (area, second_moments) = rectangle(z, y);
            let (a, b) = (z.max(y), z.min(y));
            let torsion = a * b.powi(3) * (1.0 / 3.0 - 0.21 * b / a * (1.0 - (b / a).powi(4) / 12.0));
            (2, Profile::General { area, second_moments, torsion })
        }
        "I" => {
            let [height, bottom, top] = [1, 2, 3].map(&mut dimension);
            let [web, t_bottom, t_top] = [4, 5, 6].map(&mut dimension);
            let (height, bottom, top, web, t_bottom, t_top) =
                (height?, bottom?, top?, web?, t_bottom?, t_top?);
            let clear = height - t_bottom - t_top;
            // Flanges and web: width, thickness and the height of the middle.
            let parts = [
                (bottom, t_bottom, 0.5 * t_bottom),
                (web, clear, t_bottom + 0.5 * clear),
                (top, t_top, height - 0.5 * t_top),
            ];
            let area: f64 = parts.iter().map(|(z, y, _)| z * y).sum();
            let middle = parts.iter().map(|(z, y, at)| z * y * at).sum::<f64>() / area;
            let along =
                parts.iter().map(|(z, y, at)| rectangle(*z, *y).1[0] + z * y * (at - middle).powi(2)).sum();
            let across = parts.iter().map(|(z, y, _)| rectangle(*z, *y).1[1]).sum();
            let torsion = (bottom * t_bottom.powi(3) + top * t_top.powi(3) + clear * web.powi(3)) / 3.0;
            (6, Profile::General { area, second_moments: [along, across], torsion })
        }
        "BOX" => {
            let (z, y, flange, web) = (dimension(1)?, dimension(2)?, dimension(3)?, dimension(4)?);
            let (outer, hollow) = (rectangle(z, y), rectangle(z - 2.0 * web, y - 2.0 * flange));
            let second_moments = [0, 1].map(|k| outer.1[k] - hollow.1[k]);
            let (width, height) = (z - web, y - flange);
            let torsion = 2.0 * (width * height).powi(2) / (width / flange + height / web);
            (4, Profile::General { area: outer.0 - hollow.0, second_moments, torsion })
        }
        _ => {
            let why = format!(
                "profiles {kind} are not read: PBAR or PBEAM has the area and the moments of the section"
            );
            let place = fields.place();
            fields.notes.ledger.note(Weight::Matters, fields.name(), why, place);
            return None;
        }
    };
    let last = fields.last();
    let carried = fields.real_or(9 + n, 0.0)?;
    if last > 9 + n {
        fields.unread(
            10 + n,
            last,
            Weight::Matters,
            "stations along a beam are not read: the section of its first end holds",
        );
    }
    Some((profile, carried))
}
