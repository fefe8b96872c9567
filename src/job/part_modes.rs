//! Modes of parts alone, and which of them the parts move in, in modes of the whole.

use super::modes::{labels, of_the_whole};
use super::part_shares::motion;
use super::prepared::Prepared;
use crate::linalg::c64;
use crate::measured::compare::subspace_mac;
use crate::modal::levels;
use crate::results::{NamedModes, PartMode, PartShares};
use crate::structure::DofMap;

/// More nodes of a part add nothing to a MAC; evenly chosen ones of so many are compared.
const MOST_NODES: usize = 4000;

/// The translations of `nodes`.
fn translations(dofs: &DofMap, nodes: &[usize], q: impl Fn(usize) -> c64 + Copy) -> Vec<c64> {
    nodes.iter().flat_map(|node| (0..3).map(move |dof| motion(dofs, *node, dof, q))).collect()
}

/// The modes of some parts alone, as the case asks for them by `[modes.NAME]` with `parts`.
pub struct PartsAlone {
    parts: Vec<String>,
    nodes: Vec<usize>,
    /// The name of each level, and the translations of its modes at the nodes.
    levels: Vec<(String, Vec<Vec<f64>>)>,
}

/// Whether a set of real modes of the case is of some of its parts alone.
pub fn is_of_parts_alone(prepared: &Prepared, set: &str) -> bool {
    let analysis = prepared.case.modes.get(set);
    analysis.is_some_and(|set| !set.parts.is_empty() && !of_the_whole(prepared, set))
        && prepared.model.parts.len() > 1
}

impl PartsAlone {
    /// Those of the sets of modes that are of parts alone.
    pub fn of(prepared: &Prepared, sets: &[&NamedModes]) -> Vec<PartsAlone> {
        let alone = sets.iter().filter(|set| is_of_parts_alone(prepared, &set.name));
        alone.map(|set| PartsAlone::new(prepared, set)).collect()
    }

    fn new(prepared: &Prepared, set: &NamedModes) -> PartsAlone {
        let parts = prepared.case.modes[&set.name].parts.clone();
        let own = prepared.model.parts.iter().filter(|part| parts.contains(&part.name));
        let mut nodes: Vec<usize> = own.flat_map(|part| part.nodes()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let every = nodes.len().div_ceil(MOST_NODES).max(1);
        let nodes: Vec<usize> = nodes.into_iter().step_by(every).collect();
        let modes = &set.modes;
        let identities: Vec<_> = set.moving_part.iter().cloned().zip(set.names.iter().copied()).collect();
        let labels = labels(&identities, modes);
        let shape = |k: usize| -> Vec<f64> {
            let real = |i: usize| c64::new(modes.shapes[(i, k)], 0.0);
            translations(&set.dofs, &nodes, real).into_iter().map(|u| u.re).collect()
        };
        let rigid = modes.rigid_bodies;
        let hz: Vec<f64> = (rigid..modes.len()).map(|k| modes.frequency_hz(k)).collect();
        let mut named: Vec<(String, Vec<Vec<f64>>)> = Vec::new();
        if rigid > 0 {
            named.push((format!("{} rigid", parts.join(", ")), (0..rigid).map(shape).collect()));
        }
        for level in levels(&hz, &set.names[rigid..]) {
            let level = level.start + rigid..level.end + rigid;
            named.push((labels[level.start].clone(), level.map(shape).collect()));
        }
        PartsAlone { parts, nodes, levels: named }
    }

    /// The most similar level to a motion of all nodes.
    fn most_similar(&self, dofs: &DofMap, q: impl Fn(usize) -> c64 + Copy) -> Option<PartMode> {
        let moved = translations(dofs, &self.nodes, q);
        let macs = self.levels.iter().map(|(name, shapes)| (name, subspace_mac(&moved, shapes)));
        let (name, mac) = macs.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(PartMode { name: name.clone(), mac })
    }
}

/// Gives the shares of each mode the modes of parts alone that their motions are most similar to: mode `k` is `shape(k, i)` at the degree
/// of freedom `i` of `dofs`.
pub fn compare_with_parts(
    shares: &mut PartShares,
    alone: &[PartsAlone],
    dofs: &DofMap,
    shape: impl Fn(usize, usize) -> c64 + Copy,
) {
    let PartShares { parts, modes } = shares;
    for (k, shares) in modes.iter_mut().enumerate() {
        for set in alone {
            let Some(found) = set.most_similar(dofs, |i| shape(k, i)) else { continue };
            for (part, share) in parts.iter().zip(shares.iter_mut()) {
                let better = share.alone.as_ref().is_none_or(|other| other.mac < found.mac);
                if set.parts.contains(part) && better {
                    share.alone = Some(found.clone());
                }
            }
        }
    }
}
