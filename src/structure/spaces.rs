//! Directions in which elements act on nodes, by themselves and through slaves.

use super::constraints::Sums;
use super::elements::Acting;
use super::part::AnyElement;
use nalgebra::{SMatrix, SVector};
use std::collections::BTreeMap;

/// Angles \[rad\] below which two directions are the same one.
const SAME_DIRECTION: f64 = 1e-3;
/// Components of unit directions below this are round-off.
const ROUND_OFF: f64 = 1e-12;

/// The directions in which something acts on a node: an orthonormal basis.
#[derive(Debug, Clone, Default)]
pub(super) struct Space {
    basis: Vec<SVector<f64, 6>>,
}

impl Space {
    fn is_full(&self) -> bool {
        self.basis.len() == 6
    }

    fn fill(&mut self) {
        if !self.is_full() {
            self.basis = (0..6).map(|k| SVector::<f64, 6>::ith(k, 1.0)).collect();
        }
    }

    /// Adds a direction unless it is (nearly) among those there are.
    fn add(&mut self, direction: SVector<f64, 6>) {
        let norm = direction.norm();
        if self.is_full() || norm == 0.0 {
            return;
        }
        let mut rest = direction / norm;
        // Twice, so that the basis is orthogonal to round-off.
        for _ in 0..2 {
            for b in &self.basis {
                rest -= b * b.dot(&rest);
            }
        }
        if rest.norm() > SAME_DIRECTION {
            self.basis.push(rest.normalize());
        }
    }

    /// The directions left free by `held`, components and directions. The space's rotations are scaled by `length` (they are θ · length).
    pub fn free_directions(&self, held: [bool; 6], inclined: &[[f64; 6]], length: f64) -> Vec<[f64; 6]> {
        if self.is_full() && inclined.is_empty() {
            let free = (0..6).filter(|k| !held[*k]);
            return free.map(|k| std::array::from_fn(|i| f64::from(u8::from(i == k)))).collect();
        }
        let mut projector =
            self.basis.iter().fold(SMatrix::<f64, 6, 6>::zeros(), |sum, b| sum + b * b.transpose());
        let mut count = self.basis.len();
        // Within the space, the motion that an axis sees is that axis projected onto it; a held axis takes it away.
        let axes = (0..6).filter(|k| held[*k]).map(|k| SVector::<f64, 6>::ith(k, 1.0));
        for direction in axes.chain(inclined.iter().map(|direction| SVector::from(*direction))) {
            let seen = projector * direction;
            if seen.norm() > ROUND_OFF {
                let seen = seen.normalize();
                projector -= seen * seen.transpose();
                count -= 1;
            }
        }
        // The basis nearest to the axes, translations first: the axis that the space holds best, projected, then the rest.
        let mut directions = Vec::with_capacity(count);
        for _ in 0..count {
            let held_best = |axes: std::ops::Range<usize>| {
                let start = axes.start;
                axes.fold(start, |b, k| if projector[(k, k)] > projector[(b, b)] + ROUND_OFF { k } else { b })
            };
            let translation = held_best(0..3);
            let moves = projector[(translation, translation)] > SAME_DIRECTION.powi(2);
            let best = if moves { translation } else { held_best(3..6) };
            let axis = projector.column(best).normalize();
            projector -= axis * axis.transpose();
            let mut direction: [f64; 6] =
                std::array::from_fn(|i| if axis[i].abs() < ROUND_OFF { 0.0 } else { axis[i] });
            if direction.iter().filter(|d| **d != 0.0).count() == 1 {
                direction[best] = 1.0;
            }
            if direction[..3].iter().any(|d| *d != 0.0) {
                direction[3..].iter_mut().for_each(|d| *d /= length);
            }
            directions.push(direction);
        }
        directions
    }
}

/// Directions in which elements act on each node, shape (nodes).
pub(super) fn active_spaces(n_nodes: usize, elements: &[AnyElement]) -> Vec<Space> {
    let mut spaces = vec![Space::default(); n_nodes];
    for element in elements {
        let nodes = element.nodes();
        if nodes.iter().all(|n| spaces[*n].is_full()) {
            continue;
        }
        match element.acting() {
            Acting::Everywhere => nodes.iter().for_each(|n| spaces[*n].fill()),
            Acting::Along(directions) => {
                for node in nodes {
                    directions.iter().for_each(|a| spaces[*node].add(SVector::from(*a)));
                }
            }
        }
    }
    spaces
}

/// Hands what acts on slaves to the degrees of freedom that they are sums of; gives for every node the length by which its rotations are
/// scaled: the longest arm at which they move a slave.
pub(super) fn lead(sums: &Sums, spaces: &mut [Space]) -> Vec<f64> {
    let mut lengths = vec![0.0_f64; spaces.len()];
    let slaves = sums.slave_nodes();
    for slave in &slaves {
        // The coefficients of u = θ × r have the square sum 2 r².
        let mut squares: BTreeMap<usize, f64> = BTreeMap::new();
        for (row, coefficient) in (0..3).filter_map(|k| sums.of(6 * slave + k)).flatten() {
            if let Some((master, 3..)) = sums.component(*row) {
                *squares.entry(master).or_default() += 0.5 * coefficient * coefficient;
            }
        }
        squares.into_iter().for_each(|(master, square)| lengths[master] = lengths[master].max(square.sqrt()));
    }
    for length in lengths.iter_mut().filter(|l| **l == 0.0) {
        *length = 1.0;
    }
    // Directions of a node in its scaled rotations: they are purely translations or rotations, unit either way.
    for slave in slaves {
        for acting in std::mem::take(&mut spaces[slave].basis) {
            // a · u_s = Σ a_k c u.
            let mut handed: BTreeMap<usize, SVector<f64, 6>> = BTreeMap::new();
            for (k, a) in acting.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                let own = [(6 * slave + k, 1.0)];
                for (row, coefficient) in sums.of(6 * slave + k).unwrap_or(&own) {
                    let Some((master, component)) = sums.component(*row) else { continue };
                    let scale = if component < 3 { 1.0 } else { lengths[master] };
                    handed.entry(master).or_default()[component] += a * coefficient / scale;
                }
            }
            // What adds up to nothing leaves its rounding.
            handed.retain(|_, direction| direction.norm() > ROUND_OFF);
            handed.into_iter().for_each(|(master, direction)| spaces[master].add(direction));
        }
    }
    lengths
}
