//! How far a state is from equilibrium on the full system.

use super::PointState;
use super::linear::{add_reaction, elastic_force};
use super::point_laws::{respond, slid};
use crate::linalg::SparseMatrix;
use crate::system::{ContactPair, ContactPoint, System};

/// f − K u − r_c, and its size relative to ‖f‖ + ‖r_c‖.
pub(super) fn residual(
    system: &System,
    k: &SparseMatrix,
    u: &[f64],
    states: &[PointState],
) -> (Vec<f64>, f64) {
    let mut contact = vec![0.0; u.len()];
    for ((_, point), state) in system.points().zip(states) {
        add_reaction(point, &state.forces, &mut contact);
    }
    let elastic = elastic_force(k, system.coupling.as_ref(), u);
    let r: Vec<f64> = (0..u.len()).map(|i| system.load[i] - elastic[i] - contact[i]).collect();
    let scale = norm_2(&system.load) + norm_2(&contact);
    let size = if scale > 0.0 { norm_2(&r) / scale } else { norm_2(&r) };
    (r, size)
}

/// The law of every point at its penetration and the displacement `u`, with the derivatives for small motions about that: where a point
/// sticks, or has slid to where it stands, those of its elastic deflection.
pub(super) fn states(pairs: &[ContactPair], penetrations: &[f64], u: &[f64]) -> Vec<PointState> {
    let points = pairs.iter().flat_map(|pair| pair.points.iter().map(move |p| (pair, p)));
    let at = |((pair, point), penetration): ((&ContactPair, &ContactPoint), &f64)| {
        let slid = slid(pair, point, u);
        let (forces, mut tangent) = respond(pair, point, *penetration, slid);
        let mut slips = false;
        if pair.sticks() {
            tangent = respond(pair, point, *penetration, [0.0; 2]).1;
            let [_, along, across] = tangent.springs();
            slips = forces.friction != [along * slid[0], across * slid[1]];
        }
        PointState { penetration: *penetration, forces, tangent, slips }
    };
    points.zip(penetrations).map(at).collect()
}

/// Each pair with the states of its points.
pub fn by_pair<'a>(
    pairs: &'a [ContactPair],
    mut states: &'a [PointState],
) -> impl Iterator<Item = (&'a ContactPair, &'a [PointState])> {
    pairs.iter().map(move |pair| {
        let (own, others) = states.split_at(pair.points.len());
        states = others;
        (pair, own)
    })
}

/// ‖x‖₂.
pub(super) fn norm_2(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}
