//! Names of the channels of a run in time, each of which there is once.

use crate::case::{Case, TransientAnalysis};
use crate::error::Fault;
use crate::schema::dotted;
use std::collections::BTreeMap;

/// Ends of the names of the channels of a place, of a spring, and of a contact; channels that every run may have.
pub(super) const OF_PLACES: [&str; 3] = ["_displacement", "_velocity", "_acceleration"];
pub(super) const OF_SPRINGS: [&str; 1] = ["_force"];
pub(super) const OF_CONTACTS: [&str; 3] = ["_normal_force", "_friction_force", "_sliding_velocity"];
pub(super) const OWN: [&str; 13] = [
    "time",
    "penetration",
    "slip_velocity",
    "points_sticking",
    "points_backwards",
    "points_forwards",
    "energy_stored",
    "energy_drive",
    "energy_heat",
    "energy_damping",
    "energy_algorithm",
    "mode_re",
    "mode_im",
];

/// The probes of which a channel has the name of another one, of a contact's or of every run's, as faults at their keys.
pub(super) fn clashing(case: &Case, wanted: &TransientAnalysis) -> Vec<Fault> {
    let named = |name: &str, ends: &[&str]| ends.iter().map(|end| format!("{name}{end}")).collect::<Vec<_>>();
    let mut taken: BTreeMap<String, String> =
        OWN.map(|name| (name.to_string(), "every run".to_string())).into();
    for name in case.contact.keys() {
        let of = named(name, &OF_CONTACTS).into_iter();
        taken.extend(of.map(|channel| (channel, format!("the contact `{name}`"))));
    }
    let mut faults = Vec::new();
    for (name, probe) in &wanted.probe {
        let ends: &[&str] = if probe.spring.is_some() { &OF_SPRINGS } else { &OF_PLACES };
        for channel in named(name, ends) {
            if let Some(other) = taken.get(&channel) {
                let found = format!("a probe with the channel `{channel}`, which {other} has");
                let place = format!("`transient.probe.{}`", dotted(name));
                faults.push(Fault::new(place, found, "another name"));
            }
            taken.insert(channel, format!("the probe `{name}`"));
        }
    }
    faults
}
