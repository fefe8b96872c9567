//! Contacts that nothing presses together, or whose load has nothing behind it: found before anything is computed.

use super::prepared::Prepared;
use crate::case::Pressing;
use crate::equilibrium::closed_springs;
use crate::error::{Fault, Faults, Result};
use crate::numbers::{components, significant};
use crate::schema::dotted;
use crate::structure::{Part, is_free_along, unresisted_parts};
use crate::system::{Closing, ContactMotion};

/// Whether steady sliding can have a contact that carries load.
///
/// # Errors
/// A part is free even with every contact closed; all contacts are open where the bodies stand, and no load, approach or force closes one; a load presses a body that nothing
/// holds against it.
pub fn check(prepared: &Prepared) -> Result<()> {
    let mut faults = Faults::new();
    nothing_touches(prepared, &mut faults);
    parts_without_a_support(prepared, &mut faults);
    loads_without_a_support(prepared, &mut faults);
    faults.into_result(())
}

/// Refuses bodies that are apart where nothing moves them: u = 0 is then the steady state, and no contact carries load.
fn nothing_touches(prepared: &Prepared, faults: &mut Faults) {
    let system = &prepared.system;
    let forced = system.load.iter().any(|force| *force != 0.0);
    let mut apart = Vec::new();
    for pair in &system.pairs {
        let Closing::Approach(approach) = pair.closing else { return };
        let closed = pair.points.iter().any(|point| {
            let slip_velocity = [pair.velocity_at(point), 0.0];
            let penetration = approach - point.gap;
            let motion = ContactMotion { penetration, penetration_rate: 0.0, slip_velocity };
            pair.law.respond(&motion, point.weight).0.normal != 0.0
        });
        if forced || closed || pair.is_bilateral() {
            return;
        }
        apart.push((pair, approach, pair.least_gap()));
    }
    for (pair, approach, gap) in apart {
        let place = format!("`contact.{}.approach`", dotted(&pair.name));
        let found = format!(
            "{} m, at which no point touches: the nearest is {} m away",
            significant(approach, 4),
            significant(gap - approach, 3)
        );
        let expected = format!("a `load`, a [force] that presses, or more than {} m", significant(gap, 4));
        let help = "With `load = \"20 N\"` the approach is found; check the unit of the mesh if the bodies should touch";
        faults.push(Fault::new(place, found, expected).with_help(help));
    }
}

/// Refuses parts that can move as rigid bodies without any force, even with every contact closed: they have no steady state, where something
/// pushes.
fn parts_without_a_support(prepared: &Prepared, faults: &mut Faults) {
    let system = &prepared.system;
    let pushed = !system.pairs.is_empty() || system.load.iter().any(|force| *force != 0.0);
    if prepared.case.matrices.is_some() || !pushed {
        return;
    }
    let stiffness = &system.structure.stiffness;
    let springs = closed_springs(system, stiffness);
    // Matrices that hold no numbers are a fault of their own.
    let parts =
        unresisted_parts(&prepared.model, &prepared.assembled, stiffness, &springs).unwrap_or_default();
    for part in parts {
        let place = match part.names.first() {
            Some(name) => prepared.model.part(name).map_or_else(|| "`mass`".to_string(), Part::place),
            None => "`mass`".to_string(),
        };
        let motions = if part.motions == 1 { "motion" } else { "motions" };
        let found = match part.names.len() {
            0 | 1 => "a part that is".to_string(),
            _ => format!("`{}`, which are", part.names.join("`, `")),
        };
        let found = format!(
            "{found} free in {} rigid-body {motions} even with every contact closed ({})",
            part.motions,
            prepared.regions.name_of_node(part.node)
        );
        let fault = Fault::new(place, found, "parts that supports, springs, links or contacts hold");
        faults
            .push(fault.with_help("Add a [support], [spring], [rigid] or [contact], or leave the part out"));
    }
}

/// Refuses a load on a body that can be moved away from it freely: nothing takes its reaction up.
fn loads_without_a_support(prepared: &Prepared, faults: &mut Faults) {
    if prepared.case.matrices.is_some() {
        return;
    }
    for (name, [into, _]) in prepared.system.pairs.iter().map(|pair| &pair.name).zip(prepared.arrows()) {
        let contact = &prepared.case.contact[name];
        let Pressing::Load { load } = contact.pressing else { continue };
        let nodes = prepared.regions.nodes(&contact.body, "").unwrap_or_default();
        if into == [0.0; 3] || !is_free_along(&prepared.model, &prepared.assembled, &nodes, into) {
            continue;
        }
        let place = format!("`contact.{}.load`", dotted(name));
        // Adding zero takes the sign from a negative one.
        let along = components(into.map(|x| x + 0.0));
        let found = format!("a load on a body that nothing holds along {along}");
        let expected = "a support, spring or rigid link behind the body, or a [force] on it and no `load`";
        let force = components(into.map(|x| load * x + 0.0));
        let help = format!(
            "Leave `load` out and press the body itself: [force.NAME] with `on = \"{}\"` and `force = {force}`",
            contact.body
        );
        faults.push(Fault::new(place, found, expected).with_help(help));
    }
}
