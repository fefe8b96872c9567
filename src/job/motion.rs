//! The motion of a place along a direction, as a linear form of the degrees of freedom.

use super::prepared::Prepared;
use crate::error::{Error, Fault, Result};
use crate::linalg::SparseVector;
use crate::structure::Part;

/// A place whose motion is recorded, or on which a load acts.
#[derive(Debug, Clone)]
pub struct Motion {
    /// Where it is, in words.
    pub place: String,
    /// Its coordinates, the mean of its nodes \[m\].
    pub at: [f64; 3],
    /// The unit vector that it is along.
    pub along: [f64; 3],
    /// The nodes whose mean it is.
    pub nodes: Vec<usize>,
    /// The motion; a unit force there is the same form.
    pub direction: SparseVector,
}

/// The motion along `direction`, of whatever length, of the region `on` (the mean of its nodes) or of the node nearest to
/// `at`; `key` is where the case says so.
///
/// # Errors
/// A region that the mesh does not have, nodes without coordinates, a place that is held.
pub fn motion(
    prepared: &Prepared<'_>,
    on: Option<&str>,
    at: Option<[f64; 3]>,
    direction: [f64; 3],
    key: &str,
) -> Result<Motion> {
    let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    let along = direction.map(|d| d / length);
    let (place, nodes) = match on {
        Some(on) => (format!("region {on}"), prepared.regions.nodes(on, &format!("`{key}.on`"))?),
        None if prepared.model.nodes.is_empty() => {
            let fault = Fault::new(format!("`{key}.at`"), "a place", "a case whose nodes have coordinates");
            return Err(Error::input(fault.with_help("`matrices.dofs` may give them")));
        }
        None => {
            let at = at.unwrap_or_default();
            let (words, node) = nearest(prepared, at);
            if let Some(expected) = beyond(&prepared.model.nodes, at) {
                let fault = Fault::new(format!("`{key}.at`"), format!("{at:?} m, {words}"), expected);
                return Err(Error::input(fault.with_help("Is it in another unit?")));
            }
            (words, vec![node])
        }
    };
    let mean = |axis: usize| {
        nodes.iter().map(|n| prepared.model.nodes[*n][axis]).sum::<f64>() / nodes.len().max(1) as f64
    };
    let at = [0, 1, 2].map(mean);
    let direction = prepared.assembled.dofs.mean_motion(&nodes, along);
    if direction.indices().is_empty() {
        let fault =
            Fault::new(format!("`{key}`"), "a place that is held in this direction", "one that can move");
        return Err(Error::input(fault));
    }
    Ok(Motion { place, at, along, nodes, direction })
}

/// Expected range of a place that lies farther from the bounding box of all nodes than a tenth of its diagonal.
fn beyond(nodes: &[[f64; 3]], place: [f64; 3]) -> Option<String> {
    let bound = |pick: fn(f64, f64) -> f64, start: f64| {
        [0, 1, 2].map(|axis| nodes.iter().map(|node| node[axis]).fold(start, pick))
    };
    let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let outside = length([0, 1, 2].map(|k| (low[k] - place[k]).max(place[k] - high[k]).max(0.0)));
    let diagonal = length([0, 1, 2].map(|k| high[k] - low[k]));
    (outside > 0.1 * diagonal)
        .then(|| format!("a place on the model, which reaches from {low:?} to {high:?} m"))
}

/// The node nearest to a place, and where it is in words.
fn nearest(prepared: &Prepared<'_>, place: [f64; 3]) -> (String, usize) {
    let away = |node: &[f64; 3]| (0..3).map(|k| (node[k] - place[k]).powi(2)).sum::<f64>();
    let nodes = prepared.model.nodes.iter().enumerate();
    let node = nodes.min_by(|a, b| away(a.1).total_cmp(&away(b.1))).map_or(0, |(node, _)| node);
    let own = |part: &&Part| part.cells.iter().any(|face| face.nodes().contains(&node));
    let part = prepared.model.parts.iter().find(own);
    let part = part.map_or(String::new(), |part| format!(" of {}", part.name));
    let far = 1e3 * away(&prepared.model.nodes[node]).sqrt();
    (format!("a node{part}, {far:.1} mm from the place"), node)
}
