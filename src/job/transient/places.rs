//! What acts on the structure in time, and where its motion is recorded.

use crate::case::{Slide, TransientAnalysis};
use crate::error::{Fault, Faults, Result};
use crate::job::prepared::Prepared;
use crate::linalg::SparseVector;
use crate::transient::{self, Profile, Push};

/// What acts on the structure in time, and where its motion is recorded.
#[derive(Debug, Clone)]
pub struct Places {
    pub(super) pushes: Vec<Push>,
    /// Names and directions.
    pub(super) probes: Vec<(String, SparseVector)>,
}

/// The places of a run in time; asked for before anything is computed or written.
///
/// # Errors
/// Every name that the mesh does not have, and damping that time does not know.
pub fn places(prepared: &Prepared<'_>, wanted: &TransientAnalysis) -> Result<Places> {
    transient::refuse_hysteretic(&prepared.system)?;
    let mut faults = Faults::new();
    let mut reduced = |on: &str, place: String, vector: [f64; 3]| {
        let nodes = faults.take(prepared.regions.nodes(on, &place)).unwrap_or_default();
        let share = vector.map(|v| v / nodes.len().max(1) as f64);
        let entries: Vec<(usize, usize, f64)> = nodes
            .iter()
            .flat_map(|node| share.iter().enumerate().map(|(axis, v)| (*node, axis, *v)))
            .collect();
        prepared.assembled.dofs.reduce(&entries)
    };
    let pushes = wanted.push.iter().map(|(name, push)| Push {
        direction: reduced(&push.on, format!("`transient.push.{name}.on`"), push.force),
        begin: push.begin,
        duration: push.duration,
    });
    let pushes: Vec<Push> = pushes.collect();
    let (mut probes, mut lost) = (Vec::<(String, SparseVector)>::new(), Vec::new());
    for (name, probe) in &wanted.probe {
        let length = probe.direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        let direction = probe.direction.map(|d| d / length);
        let form = match (&probe.on, probe.at) {
            (Some(on), _) => reduced(on, format!("`transient.probe.{name}.on`"), direction),
            (None, at) if !prepared.model.nodes.is_empty() => {
                nearest(prepared, at.unwrap_or_default(), direction)
            }
            (None, _) => {
                let (place, expected) =
                    (format!("`transient.probe.{name}.at`"), "a case whose nodes have coordinates");
                lost.push(Fault::new(place, "a place", expected).with_help("`matrices.dofs` may give them"));
                continue;
            }
        };
        probes.push((name.clone(), form));
    }
    lost.into_iter().for_each(|fault| faults.push(fault));
    for (name, _) in probes.iter().filter(|(_, d)| d.indices().is_empty()) {
        faults.push(Fault::new(
            format!("`transient.probe.{name}`"),
            "a place that is held in this direction",
            "one that can move",
        ));
    }
    faults.into_result(Places { pushes, probes })
}

/// The motion of the node nearest to a place along a direction.
fn nearest(prepared: &Prepared<'_>, place: [f64; 3], direction: [f64; 3]) -> SparseVector {
    let away = |node: &[f64; 3]| (0..3).map(|k| (node[k] - place[k]).powi(2)).sum::<f64>();
    let nodes = prepared.model.nodes.iter().enumerate();
    let node = nodes.min_by(|a, b| away(a.1).total_cmp(&away(b.1))).map_or(0, |(node, _)| node);
    let entries: Vec<_> = direction.iter().enumerate().map(|(axis, d)| (node, axis, *d)).collect();
    prepared.assembled.dofs.reduce(&entries)
}

/// How a counter-body slides.
pub(super) fn profile(slide: Option<&Slide>) -> Profile {
    match slide {
        None => Profile::Constant,
        Some(Slide::Ramp { from, duration }) => Profile::Ramp { from: *from, duration: *duration },
        Some(Slide::Reciprocating { frequency, phase }) => {
            Profile::Reciprocating { frequency_hz: *frequency, phase: *phase }
        }
        Some(Slide::Table { time, factor }) => {
            Profile::Table { times: time.clone(), factors: factor.clone() }
        }
    }
}
