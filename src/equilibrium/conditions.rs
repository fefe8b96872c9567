//! What steady sliding needs, and what a state must not have.

use super::balance::by_pair;
use super::{PointState, SteadyOptions};
use crate::error::{Error, Fault, Faults, Result};
use crate::numbers::significant;
use crate::system::{Closing, ContactPair, FrictionAtRest};

/// Sliding velocities, loads and points with which there can be a steady state, on `n` degrees of freedom.
pub(super) fn check_input(pairs: &[ContactPair], load: &[f64], n: usize) -> Result<()> {
    let mut faults = Faults::new();
    for pair in pairs {
        let v = pair.sliding_velocity;
        let elastic = pair.law.at_rest() == FrictionAtRest::Elastic;
        if !(v.is_finite() && (v != 0.0 || elastic)) {
            let place = format!("contact `{}`, sliding velocity", pair.name);
            let expected = "a velocity other than zero, or a contact that sticks elastically (`bristle`)";
            faults.push(
                Fault::new(place, format!("{v} m/s"), expected)
                    .with_help("Friction that is set-valued at rest can have any value up to μN"),
            );
        }
        let (place, bad) = match pair.closing {
            Closing::Load(load) => ("closing load", (!(load.is_finite() && load > 0.0)).then_some(load)),
            Closing::Approach(a) => ("approach", (!a.is_finite()).then_some(a)),
        };
        if let Some(value) = bad {
            let place = format!("contact `{}`, {place}", pair.name);
            faults.push(Fault::new(place, value.to_string(), "a finite value, positive for a load"));
        }
        if pair.points.is_empty() {
            faults.push(Fault::new(
                format!("contact `{}`", pair.name),
                "no point",
                "at least one contact point",
            ));
        }
    }
    if load.len() != n || load.iter().any(|f| !f.is_finite()) {
        let expected = format!("{n} finite forces");
        faults.push(Fault::new(
            "external load",
            format!("{} values, some not finite or too few", load.len()),
            expected,
        ));
    }
    faults.into_result(())
}

/// Pairs that touch, no deeper than the limit.
pub(super) fn check_contact(
    pairs: &[ContactPair],
    approach: &[f64],
    points: &[PointState],
    options: &SteadyOptions,
) -> Result<()> {
    for ((pair, states), approach) in by_pair(pairs, points).zip(approach) {
        let deepest = states.iter().map(|s| s.penetration).fold(f64::NEG_INFINITY, f64::max);
        if states.iter().all(|s| s.forces.normal == 0.0) && !pair.is_bilateral() {
            let gaps = || pair.points.iter().map(|point| point.gap);
            let [least, most] = [gaps().fold(f64::INFINITY, f64::min), gaps().fold(0.0, f64::max)];
            let mut found = format!(
                "no point touches: the nearest stays {} m away at an approach of {} m",
                significant(0.0 - deepest, 4),
                significant(*approach, 4)
            );
            let mut help =
                "Close the contact with a load, move the bodies nearer or press harder".to_string();
            if least > *approach {
                found += &format!(
                    "; the mesh leaves gaps from {} to {} m",
                    significant(least, 4),
                    significant(most, 4)
                );
                help += "; `initial_gap = \"closed\"` in its table takes the bodies as touching where they are, as of flat faces on curved bodies, \
                         whose gaps are those of the mesh";
            }
            return Err(Error::analysis(format!("steady sliding, contact `{}`", pair.name), found, help));
        }
        if deepest > options.penetration_limit {
            let limit = options.penetration_limit;
            return Err(Error::analysis(
                format!("steady sliding, contact `{}`", pair.name),
                format!(
                    "the load crushes the bodies through: penetration {} m, limit {} m",
                    significant(deepest, 4),
                    significant(limit, 4)
                ),
                "Lower the load or raise the contact stiffness",
            ));
        }
    }
    Ok(())
}
