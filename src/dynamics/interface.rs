//! Unsymmetric terms as a low-rank interface: K_c = W k Wᵀ and C_c = W c Wᵀ.

use crate::connected::lowest_connected;
use crate::equilibrium::{ContactBlock, PointState, SteadySliding, directions, linearize, linearize_points};
use crate::linalg::congruence::congruence;
use crate::linalg::{SparseMatrix, SparseVector, c64};
use crate::system::{Coupling, System};
use faer::Mat;
use std::collections::BTreeMap;

/// The linearised contacts, and what imported matrices have beyond their symmetric part, as one low-rank interface.
#[derive(Debug, Clone)]
pub struct Interface<'a> {
    /// The columns of W (n × r): g, t₁, t₂ of every contact point that is not silent, then the imported ones.
    pub directions: Vec<&'a SparseVector>,
    /// The entries of k and c that are not both zero.
    pub terms: Vec<InterfaceTerm>,
}

/// One entry of k \[N/m\] and c \[N s/m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InterfaceTerm {
    /// The direction that the force is along.
    pub row: usize,
    /// The direction whose motion it answers.
    pub column: usize,
    /// Of k \[N/m\].
    pub stiffness: f64,
    /// Of c \[N s/m\].
    pub damping: f64,
    /// What it comes from.
    pub origin: TermOrigin,
}

/// k and c between directions that terms connect, and no others.
#[derive(Debug, Clone)]
pub(crate) struct InterfaceBlock {
    /// The columns of W, ascending.
    pub(crate) directions: Vec<usize>,
    /// k \[N/m\], r × r.
    pub(crate) stiffness: Mat<f64>,
    /// c \[N s/m\], r × r.
    pub(crate) damping: Mat<f64>,
}

/// Origin of an entry, by which the growth budget sorts it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TermOrigin {
    /// (g, g): stiffness and damping of the normal motion; of points that stick, along the face, too.
    Normal,
    /// (t₁, t₁): friction that falls, or rises, with the slip velocity.
    Falling,
    /// Friction that turns with the transverse slip.
    Transverse,
    /// Friction that follows the normal motion, and whatever else of imported matrices is not symmetric.
    Coupling,
}

impl<'a> Interface<'a> {
    /// The interface of `system` at steady sliding.
    pub fn new(system: &'a System, steady: &SteadySliding) -> Self {
        let points: Vec<_> = system.points().map(|(_, point)| point).collect();
        let mut interface = Interface { directions: Vec::new(), terms: Vec::new() };
        for block in linearize(system, steady).blocks {
            let first = interface.directions.len();
            interface.directions.extend(directions(points[block.point]));
            interface.terms.extend(contact_terms(&block, first));
        }
        if let Some(rest) = &system.coupling {
            interface.terms.extend(imported_terms(rest, interface.directions.len()));
            interface.directions.extend(&rest.directions);
        }
        interface
    }

    /// The directions of every contact point, those that are silent included, then the imported ones; no terms yet.
    pub(crate) fn of_every_point(system: &'a System) -> Self {
        let points = system.points().flat_map(|(_, point)| directions(point));
        let imported = system.coupling.iter().flat_map(|rest| &rest.directions);
        Interface { directions: points.chain(imported).collect(), terms: Vec::new() }
    }

    /// The largest |k| + ω|c| among the terms of each direction \[N/m\]: zero where there is none.
    pub(crate) fn sizes(&self, omega: f64) -> Vec<f64> {
        let mut sizes = vec![0.0f64; self.directions.len()];
        for term in &self.terms {
            let size = term.stiffness.abs() + omega * term.damping.abs();
            for end in [term.row, term.column] {
                sizes[end] = sizes[end].max(size);
            }
        }
        sizes
    }

    /// The directions in which it moves or is moved.
    pub(crate) fn active(&self, omega: f64) -> Vec<usize> {
        let sizes = self.sizes(omega);
        (0..sizes.len()).filter(|d| sizes[*d] > 0.0 && !self.directions[*d].indices().is_empty()).collect()
    }

    /// |ψ|ᵀ|W| |k + λ c| |W|ᵀ|φ| \[N m\], given |ψ|ᵀ|W| and |W|ᵀ|φ|: the work of the interface without cancellation.
    pub(crate) fn gross_work(&self, lambda: c64, left: &[f64], right: &[f64]) -> f64 {
        let work = |term: &InterfaceTerm| {
            left[term.row] * (term.stiffness + lambda * term.damping).norm() * right[term.column]
        };
        self.terms.iter().map(work).sum()
    }

    /// Bounds of ‖W k Wᵀ‖ \[N/m\] and ‖W c Wᵀ‖ \[N s/m\] in the 1-norm.
    pub(crate) fn norms(&self) -> [f64; 2] {
        let mut columns: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        let force: Vec<f64> =
            self.directions.iter().map(|d| d.values().iter().map(|w| w.abs()).sum()).collect();
        for term in &self.terms {
            let [k, c] = [term.stiffness, term.damping].map(|v| v.abs() * force[term.row]);
            for (j, w) in self.directions[term.column].iter() {
                let column = columns.entry(j).or_default();
                column[0] += k * w.abs();
                column[1] += c * w.abs();
            }
        }
        let largest = |which: usize| columns.values().map(|c| c[which]).fold(0.0, f64::max);
        [largest(0), largest(1)]
    }

    /// |W|ᵀ |x|.
    pub(crate) fn extents(&self, [re, im]: [&[f64]; 2]) -> Vec<f64> {
        let extent = |(i, w): (usize, f64)| w.abs() * re[i].hypot(im[i]);
        self.directions.iter().map(|direction| direction.iter().map(extent).sum()).collect()
    }

    /// k and c block by block of the directions that terms connect.
    pub(crate) fn blocks(&self) -> Vec<InterfaceBlock> {
        let ends = self.terms.iter().map(|term| [term.row, term.column]);
        let lowest = lowest_connected(self.directions.len(), ends);
        let mut members = vec![(Vec::new(), Vec::new()); lowest.len()];
        lowest.iter().enumerate().for_each(|(d, first)| members[*first].0.push(d));
        self.terms.iter().for_each(|term| members[lowest[term.row]].1.push(term));
        members.retain(|(_, terms)| !terms.is_empty());
        let block = |(directions, terms): (Vec<usize>, Vec<&InterfaceTerm>)| {
            let place = |d: usize| directions.binary_search(&d).expect("the ends of a term are in its block");
            let r = directions.len();
            let [mut stiffness, mut damping] = [(); 2].map(|()| Mat::<f64>::zeros(r, r));
            for term in terms {
                let at = (place(term.row), place(term.column));
                stiffness[at] += term.stiffness;
                damping[at] += term.damping;
            }
            InterfaceBlock { directions, stiffness, damping }
        };
        members.into_iter().map(block).collect()
    }

    /// The columns of W in a block.
    pub(crate) fn directions_of(&self, block: &InterfaceBlock) -> Vec<&'a SparseVector> {
        block.directions.iter().map(|d| self.directions[*d]).collect()
    }

    /// W k Wᵀ and W c Wᵀ as sparse matrices (n × n).
    pub fn assembled(&self, n: usize) -> [SparseMatrix; 2] {
        let [mut stiffness, mut damping] = [(); 2].map(|()| Vec::new());
        for block in self.blocks() {
            let directions = self.directions_of(&block);
            stiffness.extend(congruence(&directions, block.stiffness.as_ref()));
            damping.extend(congruence(&directions, block.damping.as_ref()));
        }
        [stiffness, damping].map(|entries| {
            SparseMatrix::try_new_from_triplets(n, n, &entries).expect("directions of the system")
        })
    }

    /// Wᵀ x.
    pub fn motions(&self, [re, im]: [&[f64]; 2]) -> Vec<c64> {
        self.directions.iter().map(|d| c64::new(d.dot(re), d.dot(im))).collect()
    }
}

/// The terms of a state of the contact points between the directions of [`Interface::of_every_point`].
pub(crate) fn terms_of_every_point(system: &System, points: &[PointState]) -> Vec<InterfaceTerm> {
    let blocks = linearize_points(points).blocks;
    let mut terms: Vec<InterfaceTerm> =
        blocks.iter().flat_map(|block| contact_terms(block, 3 * block.point)).collect();
    terms.extend(system.coupling.iter().flat_map(|rest| imported_terms(rest, 3 * points.len())));
    terms
}

/// The entries of the imported coupling whose directions are those from `first` on.
fn imported_terms(rest: &Coupling, first: usize) -> impl Iterator<Item = InterfaceTerm> {
    entries(rest.directions.len()).filter_map(move |(row, column)| {
        let (stiffness, damping) = (rest.stiffness[(row, column)], rest.damping[(row, column)]);
        let (row, column) = (first + row, first + column);
        (stiffness != 0.0 || damping != 0.0).then_some(InterfaceTerm {
            row,
            column,
            stiffness,
            damping,
            origin: TermOrigin::Coupling,
        })
    })
}

/// The entries of one contact point whose g, t₁, t₂ are the directions from `first` on.
fn contact_terms(block: &ContactBlock, first: usize) -> impl Iterator<Item = InterfaceTerm> + '_ {
    let sticks = block.stiffness[1][1] != 0.0;
    entries(3).filter_map(move |(a, b)| {
        let (stiffness, damping) = (block.stiffness[a][b], block.damping[a][b]);
        let origin = match (a, b) {
            (0, 0) => TermOrigin::Normal,
            _ if sticks => TermOrigin::Normal,
            (_, 0) | (0, _) => TermOrigin::Coupling,
            (1, 1) => TermOrigin::Falling,
            _ => TermOrigin::Transverse,
        };
        (stiffness != 0.0 || damping != 0.0).then_some(InterfaceTerm {
            row: first + a,
            column: first + b,
            stiffness,
            damping,
            origin,
        })
    })
}

fn entries(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |row| (0..n).map(move |column| (row, column)))
}
