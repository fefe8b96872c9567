//! The full-order quadratic operator Q(λ) = λ² M + λ (C + C_c) + K + K_σ + iH + K_c, applied without forming it.

use super::block::Block;
use super::damper::{Between, Damper, modal_times};
use super::interface::{Interface, Term};
use crate::equilibrium::{SteadySliding, tangent_stiffness};
use crate::error::Result;
use crate::linalg::merged::Merged;
use crate::linalg::sparse::{norm_1, times};
use crate::linalg::tall::Columns;
use crate::linalg::{SparseMatrix, c64};
use crate::system::{Damping, System};
use faer::{Mat, MatRef};
use rayon::prelude::*;
use std::borrow::Cow;
use std::sync::Arc;

/// Q(λ) of a system at steady sliding. What is not symmetric acts through the interface.
pub(super) struct Operator<'a> {
    pub(super) mass: &'a SparseMatrix,
    /// K + K_σ.
    pub(super) stiffness: Cow<'a, SparseMatrix>,
    pub(super) damping: &'a Damping,
    pub(super) interface: Interface<'a>,
    /// The damping of the structure and others that may take part, taken apart.
    pub(super) dampers: Arc<Vec<Damper<'a>>>,
    /// How much of each acts.
    weights: Vec<f64>,
    /// M, K + K_σ, and what is wide of C and H.
    merged: Arc<Merged>,
    mass_norm: f64,
    damping_norm: f64,
    stiffness_norm: f64,
}

/// Complex vectors with what M, K and the wide parts of C and H make of them: the other parts need no more.
#[derive(Default)]
pub(super) struct Images {
    pub(super) vectors: Block,
    pub(super) inertia: Block,
    pub(super) elastic: Block,
    /// Of C, modal damping included.
    damped: Option<Block>,
    /// Of H.
    lossy: Option<Block>,
}

/// m M + k (K + K_σ) + c (C + C_c) + h H + w K_c.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sum {
    pub(super) mass: c64,
    pub(super) stiffness: c64,
    pub(super) damping: c64,
    pub(super) loss: c64,
    pub(super) contact: c64,
}

const ONE: c64 = c64::new(1.0, 0.0);
const ZERO: c64 = c64::new(0.0, 0.0);

impl Sum {
    /// Q(λ), or for the left side what Q(λ)ᴴ is made of.
    pub(super) fn value(side: Side, lambda: c64) -> Self {
        let s = side.of(lambda);
        Sum { mass: s * s, stiffness: ONE, damping: s, loss: side.of(c64::new(0.0, 1.0)), contact: ONE }
    }

    /// Q′(λ) = 2λM + C + C_c, or for the left side what Q′(λ)ᴴ is made of.
    pub(super) fn slope(side: Side, lambda: c64) -> Self {
        Sum { mass: side.of(lambda) * 2.0, damping: ONE, ..Sum::default() }
    }
}

impl Images {
    /// Some columns.
    pub(super) fn gathered(&self, columns: &[usize]) -> Self {
        let some = |block: &Block| Block::gathered(block, columns);
        Images {
            vectors: some(&self.vectors),
            inertia: some(&self.inertia),
            elastic: some(&self.elastic),
            damped: self.damped.as_ref().map(some),
            lossy: self.lossy.as_ref().map(some),
        }
    }

    /// Adds those of other vectors to these.
    pub(super) fn add(&mut self, other: &Images) {
        let one = vec![ONE; other.vectors.ncols()];
        let rest = self.damped.iter_mut().chain(&mut self.lossy);
        let own = [&mut self.vectors, &mut self.inertia, &mut self.elastic].into_iter().chain(rest);
        let rest = other.damped.iter().chain(&other.lossy);
        let others = [&other.vectors, &other.inertia, &other.elastic].into_iter().chain(rest);
        own.zip(others).for_each(|(own, other)| own.add_scaled(&one, other));
    }

    /// Scales every column so that xᴴMx = 1.
    pub(super) fn normalise(&mut self) {
        let columns = 0..self.vectors.ncols();
        let factors: Vec<f64> =
            columns.into_par_iter().map(|j| 1.0 / self.vectors.dot(j, &self.inertia).re.sqrt()).collect();
        let rest = self.damped.iter_mut().chain(&mut self.lossy);
        let all = [&mut self.vectors, &mut self.inertia, &mut self.elastic].into_iter().chain(rest);
        all.for_each(|block| block.scale(&factors));
    }
}

/// Which vectors an operator acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// Q(λ) φ.
    Right,
    /// Q(λ)ᴴ ψ.
    Left,
}

impl Side {
    /// A coefficient of Q, or its conjugate for the left side.
    fn of(self, z: c64) -> c64 {
        if self == Side::Right { z } else { z.conj() }
    }
}

impl<'a> Operator<'a> {
    pub(super) fn new(system: &'a System, steady: &SteadySliding) -> Result<Self> {
        let stiffness = tangent_stiffness(system, &steady.displacement)?;
        Ok(Operator::with_interface(system, stiffness, Interface::new(system, steady), &[]))
    }

    /// The operator with the tangent stiffness `stiffness`, another interface, and `further` dampings, none of which acts.
    pub(super) fn with_interface(
        system: &'a System,
        stiffness: Cow<'a, SparseMatrix>,
        interface: Interface<'a>,
        further: &[&'a Damping],
    ) -> Self {
        let (mass, damping) = (&system.structure.mass, &system.structure.damping);
        let dampings: Vec<&Damping> = std::iter::once(damping).chain(further.iter().copied()).collect();
        let damper = |damping: &&'a Damping| Damper::new(damping, mass, &stiffness);
        let dampers: Vec<Damper<'a>> = dampings.par_iter().map(damper).collect();
        let norm = |m: &Option<Arc<SparseMatrix>>| m.as_ref().map_or(0.0, |m| norm_1(m));
        let mut sparse: Vec<&SparseMatrix> = vec![mass, &stiffness];
        sparse.extend(dampers[0].viscous.wide().into_iter().chain(dampers[0].loss.wide()));
        Operator {
            merged: Arc::new(Merged::new(&sparse)),
            mass,
            mass_norm: norm_1(mass),
            damping_norm: norm(&damping.viscous),
            stiffness_norm: norm_1(&stiffness) + norm(&damping.hysteretic),
            weights: only_first(dampers.len()),
            dampers: Arc::new(dampers),
            stiffness,
            damping,
            interface,
        }
    }

    /// The same operator whose interface has other terms between the same directions, with `weights` for its dampings:
    /// those that are missing are one for the first and none for the others.
    pub(super) fn with_terms(&self, terms: Vec<Term>, weights: &[f64]) -> Operator<'_> {
        let interface = Interface { directions: self.interface.directions.clone(), terms };
        let mut all = only_first(self.dampers.len());
        all.iter_mut().zip(weights).for_each(|(all, weight)| *all = *weight);
        let (stiffness, merged) = (Cow::Borrowed(&*self.stiffness), Arc::clone(&self.merged));
        Operator { stiffness, interface, merged, dampers: Arc::clone(&self.dampers), weights: all, ..*self }
    }

    pub(super) fn n(&self) -> usize {
        self.mass.nrows()
    }

    /// The dampings that act, with their weights.
    fn acting(&self) -> impl Iterator<Item = (f64, &Damper<'a>)> {
        self.weights.iter().copied().zip(&*self.dampers).filter(|(weight, _)| *weight != 0.0)
    }

    /// BᵀMY, BᵀKY, BᵀCY and BᵀHY of the structure's own damping, modal damping included; `images` is memory for the next
    /// call.
    pub(super) fn forms(
        &self,
        b: Columns<'_>,
        y: MatRef<'_, f64>,
        images: &mut Vec<Mat<f64>>,
    ) -> [Mat<f64>; 4] {
        self.merged.times(y, images);
        let [mass, stiffness] = [0, 1].map(|k| b.gram(images[k].as_ref()));
        let own = &self.dampers[0];
        let of = Between { b, y, mass: mass.as_ref(), stiffness: stiffness.as_ref() };
        let [damping, loss] = [own.viscous_form(&of), own.loss.form(&of)];
        [mass, stiffness, damping, loss]
    }

    /// What M, K, C and H make of complex vectors.
    pub(super) fn images(&self, vectors: Block) -> Images {
        let mut images = Images { vectors, ..Images::default() };
        self.renew(&mut images);
        images
    }

    /// What M, K, C and H make of the vectors of `images`, in the memory that it has.
    pub(super) fn renew(&self, images: &mut Images) {
        let Images { vectors, inertia, elastic, damped, lossy } = images;
        let own = &self.dampers[0];
        let room =
            |block: &mut Option<Block>, there: bool| *block = there.then(|| block.take().unwrap_or_default());
        room(damped, own.viscous.wide().is_some());
        room(lossy, own.loss.wide().is_some());
        let mut blocks: Vec<&mut Block> = vec![inertia, elastic];
        blocks.extend(damped.iter_mut().chain(lossy.iter_mut()));
        blocks.iter_mut().for_each(|block| block.resize(self.n(), vectors.ncols()));
        let mut parts: Vec<_> = blocks.into_iter().map(Block::parts_mut).collect();
        self.merged.times_into(vectors.parts(), &mut parts);
        if self.weights[0] != 1.0 {
            let weight = vec![self.weights[0]; vectors.ncols()];
            damped.iter_mut().chain(lossy.iter_mut()).for_each(|block| block.scale(&weight));
        }
        self.add_rest(1, vectors, damped, lossy);
    }

    /// What the wide parts of C and H make of vectors.
    fn wide_images(&self, vectors: &Block) -> [Option<Block>; 2] {
        let [mut damped, mut lossy] = [None, None];
        self.add_rest(0, vectors, &mut damped, &mut lossy);
        [damped, lossy]
    }

    /// Adds what the modal dampings make of vectors, and the wide parts of the dampings from number `first` on.
    fn add_rest(&self, first: usize, x: &Block, damped: &mut Option<Block>, lossy: &mut Option<Block>) {
        for (k, (weight, damper)) in self.weights.iter().zip(&*self.dampers).enumerate() {
            if *weight == 0.0 {
                continue;
            }
            let wide =
                |part: Option<&SparseMatrix>| part.filter(|_| k >= first).map(|a| x.map(|x| times(a, x)));
            let modal = damper.modal.map(|modal| x.map(|x| modal_times(modal, x)));
            for part in [wide(damper.viscous.wide()), modal].into_iter().flatten() {
                add(damped, part, *weight);
            }
            if let Some(part) = wide(damper.loss.wide()) {
                add(lossy, part, *weight);
            }
        }
    }

    /// The factors of M x and K x in a sum.
    fn of_images(&self, sum: &Sum) -> [c64; 2] {
        let mut factors = [sum.mass, sum.stiffness];
        for (weight, damper) in self.acting() {
            for (factor, part) in [(sum.damping, &damper.viscous), (sum.loss, &damper.loss)] {
                factors[0] += factor * weight * part.split.mass_factor;
                factors[1] += factor * weight * part.split.stiffness_factor;
            }
        }
        factors
    }

    /// Yⱼ = sumⱼ Xⱼ for the right side, and for the left with C_c and K_c transposed.
    fn apply(&self, side: Side, sums: &[Sum], x: &Images, y: &mut Block) {
        let (mass, stiffness): (Vec<c64>, Vec<c64>) =
            sums.iter().map(|sum| self.of_images(sum)).map(|[m, k]| (m, k)).unzip();
        y.set_sum([(&mass, &x.inertia), (&stiffness, &x.elastic)]);
        self.add_others(side, sums, &x.vectors, [x.damped.as_ref(), x.lossy.as_ref()], y);
    }

    /// Adds what is not told from M x and K x.
    fn add_others(&self, side: Side, sums: &[Sum], x: &Block, wide: [Option<&Block>; 2], y: &mut Block) {
        let factors = |pick: fn(&Sum) -> c64| sums.iter().map(pick).collect::<Vec<_>>();
        for (wide, pick) in wide.into_iter().zip([|sum: &Sum| sum.damping, |sum: &Sum| sum.loss]) {
            wide.iter().for_each(|wide| y.add_scaled(&factors(pick), wide));
        }
        for (weight, damper) in self.acting() {
            let parts =
                [(factors(|sum| sum.damping), &damper.viscous), (factors(|sum| sum.loss), &damper.loss)];
            for (factors, part) in parts {
                let Some(few) = &part.few else { continue };
                let image = x.map(|x| few.times(x));
                for (j, factor) in factors.iter().enumerate() {
                    let [re, im] = y.vector_mut(j);
                    for (k, i) in few.rows().iter().enumerate() {
                        let value = *factor * weight * image.get(k, j);
                        (re[*i], im[*i]) = (re[*i] + value.re, im[*i] + value.im);
                    }
                }
            }
        }
        for (j, sum) in sums.iter().enumerate() {
            let motion = self.interface.motions(x.vector(j));
            let mut force = vec![ZERO; motion.len()];
            for term in &self.interface.terms {
                let (to, from) = match side {
                    Side::Right => (term.row, term.column),
                    Side::Left => (term.column, term.row),
                };
                force[to] += motion[from] * (sum.contact * term.stiffness + sum.damping * term.damping);
            }
            let [re, im] = y.vector_mut(j);
            for (direction, force) in self.interface.directions.iter().zip(&force) {
                direction.add_to(force.re, re);
                direction.add_to(force.im, im);
            }
        }
    }

    /// What couples the real modes, (sⱼ (C_r + C_c) + iH_r + K_c) xⱼ, where C_r and H_r are C and H but for what is
    /// proportional in them; for the left side iH is conjugated, C_c and K_c are transposed.
    pub(super) fn coupling(&self, side: Side, s: &[c64], x: &Block) -> Block {
        let sum = |s: &c64| Sum { mass: ZERO, stiffness: ZERO, ..Sum::value(side, *s) };
        let sums: Vec<Sum> = s.iter().map(sum).collect();
        let mut y = Block::zeros(self.n(), s.len());
        let [damped, lossy] = self.wide_images(x);
        self.add_others(side, &sums, x, [damped.as_ref(), lossy.as_ref()], &mut y);
        y
    }

    /// Q(λⱼ) xⱼ, or Q(λⱼ)ᴴ xⱼ.
    pub(super) fn value(&self, side: Side, lambda: &[c64], x: &Images) -> Block {
        let mut value = Block::default();
        self.value_into(side, lambda, x, &mut value);
        value
    }

    /// [`Operator::value`] in the memory of `value`.
    pub(super) fn value_into(&self, side: Side, lambda: &[c64], x: &Images, value: &mut Block) {
        let sums: Vec<Sum> = lambda.iter().map(|s| Sum::value(side, *s)).collect();
        self.apply(side, &sums, x, value);
    }

    /// Q′(λⱼ) xⱼ = (2λⱼM + C + C_c) xⱼ, or Q′(λⱼ)ᴴ xⱼ.
    pub(super) fn slope(&self, side: Side, lambda: &[c64], x: &Images) -> Block {
        let sums: Vec<Sum> = lambda.iter().map(|s| Sum::slope(side, *s)).collect();
        let mut slope = Block::default();
        self.apply(side, &sums, x, &mut slope);
        slope
    }

    /// ψⱼᴴQ(λⱼ)xⱼ.
    pub(super) fn form(&self, lambda: &[c64], left: &Block, x: &Images) -> Vec<c64> {
        let one = |j: usize| self.between(j, left, &Sum::value(Side::Right, lambda[j]), x);
        (0..lambda.len()).into_par_iter().map(one).collect()
    }

    /// ψⱼᴴQ′(λⱼ)φⱼ.
    pub(super) fn steepness(&self, lambda: &[c64], left: &Block, right: &Images) -> Vec<c64> {
        let one = |j: usize| self.between(j, left, &Sum::slope(Side::Right, lambda[j]), right);
        (0..lambda.len()).into_par_iter().map(one).collect()
    }

    /// ψⱼᴴ sum xⱼ.
    fn between(&self, j: usize, left: &Block, sum: &Sum, x: &Images) -> c64 {
        let motions = |x: &Block| self.interface.motions(x.vector(j));
        let (to, from) = (motions(left), motions(&x.vectors));
        let term = |t: &Term| {
            to[t.row].conj() * from[t.column] * (sum.contact * t.stiffness + sum.damping * t.damping)
        };
        self.structure_form(j, left, sum, x) + self.interface.terms.iter().map(term).sum::<c64>()
    }

    /// ψⱼᴴ sum xⱼ without the interface.
    pub(super) fn structure_form(&self, j: usize, left: &Block, sum: &Sum, x: &Images) -> c64 {
        let [mass, stiffness] = self.of_images(sum);
        let parts = [(mass, Some(&x.inertia)), (stiffness, Some(&x.elastic))];
        let wide = [(sum.damping, x.damped.as_ref()), (sum.loss, x.lossy.as_ref())];
        let there = parts.into_iter().chain(wide).filter(|(factor, _)| *factor != ZERO);
        let mut form: c64 =
            there.filter_map(|(factor, part)| part.map(|part| factor * left.dot(j, part))).sum();
        for (weight, damper) in self.acting() {
            for (factor, part) in [(sum.damping, &damper.viscous), (sum.loss, &damper.loss)] {
                if let Some(few) = part.few.as_ref().filter(|_| factor != ZERO) {
                    let parts = x.vectors.parts();
                    let [re, im] = [j, left.ncols() + j].map(|part| few.times(parts.subcols(part, 1)));
                    for (k, i) in few.rows().iter().enumerate() {
                        form += factor * weight * left.get(*i, j).conj() * c64::new(re[(k, 0)], im[(k, 0)]);
                    }
                }
            }
        }
        form
    }

    /// |λ|²‖M‖ + |λ|‖C‖ + ‖K‖ in the 1-norm; modal damping and contact left out, so that η is never flattered.
    pub(super) fn size(&self, lambda: c64) -> f64 {
        let r = lambda.norm();
        r * r * self.mass_norm + r * self.damping_norm + self.stiffness_norm
    }
}

/// One for the first, none of the others.
fn only_first(count: usize) -> Vec<f64> {
    (0..count).map(|k| if k == 0 { 1.0 } else { 0.0 }).collect()
}

fn add(sum: &mut Option<Block>, part: Block, weight: f64) {
    let columns = part.ncols();
    let sum = sum.get_or_insert_with(|| Block::zeros(part.nrows(), columns));
    sum.add_scaled(&vec![c64::new(weight, 0.0); columns], &part);
}
