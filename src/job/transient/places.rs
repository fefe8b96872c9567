//! Loads on the structure in time, and the places where its motion is recorded.

use super::names::clashing;
use super::step::check_step;
use crate::case::{FrictionCurve, SpringPer, TransientAnalysis};
use crate::contact::Coulomb;
use crate::error::{Error, Fault, Faults, Result};
use crate::job::contacts::with_laws;
use crate::job::forces::force_form;
use crate::job::motion::{Motion, motion};
use crate::job::prepared::Prepared;
use crate::job::sound::acoustics;
use crate::job::time_function::profile;
use crate::job::travel::tracks;
use crate::linalg::SparseVector;
use crate::results::RecordSize;
use crate::schema::dotted;
use crate::sound::Acoustics;
use crate::system::{ContactPair, System};
use crate::transient::{self, Pulse, Push, Track};

/// Loads on the structure in time, and the places where its motion is recorded.
#[derive(Debug, Clone)]
pub struct TransientPlaces {
    pub(super) pushes: Vec<Push>,
    /// Where motion is recorded.
    pub(super) probes: Vec<ProbePlace>,
    /// Load cells.
    pub(super) gauges: Vec<Gauge>,
    /// How the contact points of each pair travel.
    pub(super) tracks: Vec<Option<Track>>,
    /// The pairs without friction, as they stand still.
    pub(super) still: Vec<ContactPair>,
    /// Plates and microphones, if sound is requested.
    pub(super) acoustics: Option<Acoustics>,
}

impl TransientPlaces {
    /// Without a probe, records the motion of the contact point `point`.
    pub(super) fn probe_contact(&mut self, system: &System, point: usize) {
        if let Some((_, touching)) = system.points().nth(point).filter(|_| self.probes.is_empty()) {
            let direction = touching.tangents[0].clone();
            let place = "the point that carries most".into();
            self.probes.push(ProbePlace { name: "contact".into(), place, direction, measured: Vec::new() });
        }
    }

    /// Smallest record of a run to a folder, without sound and without the rows of an earlier run.
    pub(in crate::job) fn least_record(
        &self,
        prepared: &Prepared<'_>,
        wanted: &TransientAnalysis,
    ) -> RecordSize {
        let points = prepared.system.points().next().is_some();
        let probes = self.probes.len().max(usize::from(points));
        let disturbed = if wanted.disturbance.is_some() { 2 } else { 0 };
        let states = if points { 3 } else { 0 };
        let rows = steps(wanted.duration, wanted.time_step) + 1;
        let fields = wanted.fields_every.map_or(0, |every| 1 + (rows - 1) / steps(every, wanted.time_step));
        RecordSize {
            rows,
            done: rows,
            channels: 3 * probes
                + self.gauges.len()
                + 3 * prepared.system.pairs.len()
                + 2
                + states
                + 5
                + disturbed,
            modes: 0,
            nodes: prepared.model.nodes.len(),
            fields,
            fields_done: fields,
        }
    }
}

/// Whole steps in a time, at least one.
pub(super) fn steps(time: f64, step: f64) -> usize {
    (time / step).round().max(1.0) as usize
}

/// The fault of loss factors, at those of the materials.
fn of_materials(prepared: &Prepared<'_>, error: Error) -> Error {
    let Error::Input(Faults(faults)) = error else { return error };
    let parts = &prepared.model.parts;
    let lossy = prepared.case.material.iter().filter(|(_, material)| {
        material.loss_factor > 0.0 && parts.iter().any(|part| part.kind.material() == *material)
    });
    let places: Vec<String> =
        lossy.map(|(name, _)| format!("`material.{}.loss_factor`", dotted(name))).collect();
    if places.is_empty() {
        return Error::Input(Faults(faults));
    }
    let at = |place: &String| {
        faults.iter().map(|fault| Fault { place: place.clone(), ..fault.clone() }).collect::<Vec<_>>()
    };
    Error::Input(Faults(places.iter().flat_map(at).collect()))
}

/// The places of a run in time; checked before anything is computed or written.
///
/// # Errors
/// Every name that the mesh does not have, and damping that time does not know.
pub fn places(prepared: &Prepared<'_>, wanted: &TransientAnalysis) -> Result<TransientPlaces> {
    transient::refuse_hysteretic(&prepared.system).map_err(|error| of_materials(prepared, error))?;
    let mut faults = Faults::new();
    faults.take(check_step(&prepared.system.structure, wanted.time_step));
    faults.0.extend(clashing(prepared.case, wanted));
    let mut reduced = |on: &str, place: String, vector: [f64; 3]| {
        let nodes = faults.take(prepared.regions.nodes(on, &place)).unwrap_or_default();
        prepared.assembled.dofs.mean_motion(&nodes, vector)
    };
    let pushes = wanted.push.iter().map(|(name, push)| Push {
        direction: reduced(&push.on, format!("`transient.push.{name}.on`"), push.force),
        course: Pulse::HalfSine { begin: push.begin, duration: push.duration },
    });
    let mut pushes: Vec<Push> = pushes.collect();
    // What a force of the case has more or less than itself.
    let on = (&prepared.regions, &prepared.model, &*prepared.assembled);
    pushes.extend(wanted.load.iter().filter_map(|(name, course)| {
        let direction = faults.take(force_form(name, prepared.case.force.get(name)?, on))?;
        Some(Push { direction, course: Pulse::Change(profile(Some(course))) })
    }));
    let (mut probes, mut gauges) = (Vec::new(), Vec::new());
    for (name, probe) in &wanted.probe {
        if let Some(spring) = &probe.spring {
            let measured = probe.measured.clone();
            gauges.push(gauge(prepared, name, spring).map(|gauge| Gauge { measured, ..gauge }));
            continue;
        }
        let (on, direction) = (probe.on.as_deref(), probe.direction.unwrap_or_default());
        let found = motion(prepared, on, probe.at, direction, &format!("transient.probe.{name}"));
        let (name, measured) = (name.clone(), probe.measured.clone());
        probes.push(found.map(|Motion { place, direction, .. }| ProbePlace {
            name,
            place,
            direction,
            measured,
        }));
    }
    let probes: Vec<ProbePlace> = probes.into_iter().filter_map(|probe| faults.take(probe)).collect();
    let gauges: Vec<Gauge> = gauges.into_iter().filter_map(|gauge| faults.take(gauge)).collect();
    let tracks = faults.take(tracks(prepared, wanted)).unwrap_or_default();
    let mut smooth = prepared.case.clone();
    smooth
        .contact
        .values_mut()
        .for_each(|contact| contact.friction.law = FrictionCurve::Coulomb { law: Coulomb { mu0: 0.0 } });
    let still = faults.take(with_laws(&prepared.system.pairs, &smooth)).unwrap_or_default();
    let acoustics = wanted.sound.as_ref().and_then(|sound| faults.take(acoustics(prepared, sound)));
    faults.into_result(TransientPlaces { pushes, probes, gauges, tracks, still, acoustics })
}

/// A place whose motion is recorded.
#[derive(Debug, Clone)]
pub struct ProbePlace {
    pub(super) name: String,
    /// Where it is, in words.
    pub(super) place: String,
    pub(super) direction: SparseVector,
    /// Peaks that were measured there \[Hz\].
    pub(super) measured: Vec<f64>,
}

/// A spring whose force is recorded.
#[derive(Debug, Clone)]
pub struct Gauge {
    pub(super) name: String,
    /// The name of the spring.
    pub(super) spring: String,
    /// Its force is kᵀu + cᵀv \[N\], positive when its nodes have moved along its direction.
    pub(super) stiffness: SparseVector,
    pub(super) damping: SparseVector,
    /// Peaks that were measured there \[Hz\].
    pub(super) measured: Vec<f64>,
}

/// A spring of the case as a load cell.
fn gauge(prepared: &Prepared<'_>, name: &str, spring: &str) -> Result<Gauge> {
    let place = format!("`transient.probe.{name}.spring`");
    let known: Vec<&str> = prepared.case.spring.keys().map(String::as_str).collect();
    let Some(set) = prepared.case.spring.get(spring) else {
        let expected = format!("one of the case's springs ({})", known.join(", "));
        return Err(Error::input(Fault::new(place, format!("\"{spring}\""), expected)));
    };
    if set.per == SpringPer::Area {
        let found = format!("\"{spring}\", springs per area");
        return Err(Error::input(Fault::new(
            place,
            found,
            "springs with one force: those with `per = \"region\"`",
        )));
    }
    let nodes = prepared.regions.nodes(&set.on, &format!("`spring.{spring}.on`"))?;
    let other = set.to.as_ref().map(|to| prepared.regions.node(to, &format!("`spring.{spring}.to`")));
    let other = other.transpose()?;
    let length = set.direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    let first = if set.rotational { 3 } else { 0 };
    let form = |total: f64| {
        let share = set.direction.map(|d| total / nodes.len() as f64 * d / length);
        let entries = nodes.iter().flat_map(|node| {
            let own = share.iter().enumerate().map(move |(axis, s)| (*node, first + axis, *s));
            let far = share.iter().enumerate().map(move |(axis, s)| (other, first + axis, -s));
            own.chain(far.filter_map(|(node, axis, s)| node.map(|node| (node, axis, s))))
        });
        prepared.assembled.dofs.reduce(&entries.collect::<Vec<_>>())
    };
    let (stiffness, damping) = (form(set.stiffness), form(set.damping));
    Ok(Gauge { name: name.to_string(), spring: spring.to_string(), stiffness, damping, measured: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::super::names::{OF_CONTACTS, OF_PLACES, OF_SPRINGS, OWN};
    use super::*;
    use crate::case::Case;
    use crate::job::Prepared;

    const TWO_DOF: &str = r#"
point.block = [0, 0, 0]
mass.block = { on = "block", mass = 1 }
support.plane = { on = "block", held = ["uz", "rx", "ry", "rz"] }
spring.k1 = { on = "block", direction = [1, 0, 0], stiffness = 1 }
spring.kt = { on = "block", direction = [1, -1, 0], stiffness = 1 }
force.press = { on = "block", force = [0, 1, 0] }
[contact.belt]
body = "block"
counter = "ground"
into = [0, 1, 0]
approach = 0
sliding_velocity = 1
sliding_direction = [-1, 0, 0]
normal = { per = "point", stiffness = 1, unilateral = false }
friction = { law = "coulomb", mu0 = 0.7 }
"#;

    /// Every name of a probe that makes the name of another channel is refused at its key, whatever it measures; others are not.
    #[test]
    fn probes_whose_channels_have_the_name_of_another_are_refused() {
        let refused = |name: &str, spring: bool| {
            let of = if spring { "spring = \"kt\"" } else { "on = \"block\"\ndirection = [1, 0, 0]" };
            let text = format!(
                "{TWO_DOF}[cea]\nband = [0, \"1 Hz\"]\n[transient]\nduration = \"10 s\"\ntime_step = \"0.1 s\"\n\
                 [transient.probe.{name}]\n{of}\n"
            );
            let case = Case::parse("a.toml", &text, "".into()).unwrap();
            let prepared = Prepared::new(&case).unwrap();
            let found = places(&prepared, case.transient.as_ref().unwrap());
            found.err().is_some_and(|error| {
                let text = error.to_string();
                assert!(
                    text.contains(&format!("`transient.probe.{name}`")) && error.exit_code() == 2,
                    "{text}"
                );
                true
            })
        };
        let taken =
            OWN.iter().map(|name| name.to_string()).chain(OF_CONTACTS.map(|end| format!("belt{end}")));
        let mut count = 0;
        for channel in taken {
            for (spring, ends) in [(false, &OF_PLACES[..]), (true, &OF_SPRINGS[..])] {
                for name in ends.iter().filter_map(|end| channel.strip_suffix(end)) {
                    assert!(refused(name, spring), "{name}");
                    assert!(!refused(&format!("{name}2"), spring) && !refused(name, !spring), "{name}");
                    count += 1;
                }
            }
        }
        // `slip`, `belt_sliding` along a direction; `belt_normal`, `belt_friction` of a spring.
        assert_eq!(count, 4);
    }
}
