//! The full-order quadratic operator Q(λ) = λ² M + λ (C + C_c) + K + K_σ + iH + K_c, applied without forming it.

use super::block::Block;
use super::interface::{Interface, Term};
use crate::equilibrium::{SteadySliding, tangent_stiffness};
use crate::error::Result;
use crate::linalg::merged::Merged;
use crate::linalg::sparse::{norm_1, times};
use crate::linalg::tall::{expand, gram};
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
    /// M, K + K_σ, and C and H where there are any.
    merged: Arc<Merged>,
    mass_norm: f64,
    damping_norm: f64,
    stiffness_norm: f64,
}

/// What the matrices of the structure make of real vectors.
pub(super) struct Products {
    /// M x.
    pub(super) inertia: Mat<f64>,
    /// (K + K_σ) x.
    pub(super) elastic: Mat<f64>,
    /// C x.
    pub(super) damped: Option<Mat<f64>>,
    /// H x.
    pub(super) lossy: Option<Mat<f64>>,
}

/// Complex vectors with what M, K, C and H make of them.
#[derive(Default)]
pub(super) struct Images {
    pub(super) vectors: Block,
    pub(super) inertia: Block,
    pub(super) elastic: Block,
    pub(super) damped: Option<Block>,
    pub(super) lossy: Option<Block>,
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
        let one = vec![c64::new(1.0, 0.0); other.vectors.ncols()];
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

impl<'a> Operator<'a> {
    pub(super) fn new(system: &'a System, steady: &SteadySliding) -> Result<Self> {
        let stiffness = tangent_stiffness(system, &steady.displacement)?;
        Ok(Operator::with_interface(system, stiffness, Interface::new(system, steady)))
    }

    /// The operator with the tangent stiffness `stiffness` and another interface.
    pub(super) fn with_interface(
        system: &'a System,
        stiffness: Cow<'a, SparseMatrix>,
        interface: Interface<'a>,
    ) -> Self {
        let damping = &system.structure.damping;
        let norm = |m: &Option<SparseMatrix>| m.as_ref().map_or(0.0, norm_1);
        let mut sparse: Vec<&SparseMatrix> = vec![&system.structure.mass, &stiffness];
        sparse.extend(damping.viscous.iter().chain(&damping.hysteretic));
        Operator {
            merged: Arc::new(Merged::new(&sparse)),
            mass: &system.structure.mass,
            mass_norm: norm_1(&system.structure.mass),
            damping_norm: norm(&damping.viscous),
            stiffness_norm: norm_1(&stiffness) + norm(&damping.hysteretic),
            stiffness,
            damping,
            interface,
        }
    }

    /// The same operator whose interface has other terms between the same directions.
    pub(super) fn with_terms(&self, terms: Vec<Term>) -> Operator<'_> {
        let interface = Interface { directions: self.interface.directions.clone(), terms };
        let (stiffness, merged) = (Cow::Borrowed(&*self.stiffness), Arc::clone(&self.merged));
        Operator { stiffness, interface, merged, ..*self }
    }

    pub(super) fn n(&self) -> usize {
        self.mass.nrows()
    }

    /// M x, K x, C x and H x.
    pub(super) fn products(&self, x: MatRef<'_, f64>) -> Products {
        let mut products = self.merged.times(x).into_iter();
        let mut next = || products.next().expect("one for each matrix");
        let (inertia, elastic) = (next(), next());
        let viscous = self.damping.viscous.as_ref().map(|_| next());
        let lossy = self.damping.hysteretic.as_ref().map(|_| next());
        let damped = match (viscous, modal_times(self.damping, x)) {
            (Some(viscous), Some(modal)) => Some(viscous + modal),
            (viscous, modal) => viscous.or(modal),
        };
        Products { inertia, elastic, damped, lossy }
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
        let viscous = self.damping.viscous.is_some();
        let room =
            |block: &mut Option<Block>, there: bool| *block = there.then(|| block.take().unwrap_or_default());
        room(damped, viscous);
        room(lossy, self.damping.hysteretic.is_some());
        let mut blocks: Vec<&mut Block> = vec![inertia, elastic];
        blocks.extend(damped.iter_mut().chain(lossy.iter_mut()));
        blocks.iter_mut().for_each(|block| block.resize(self.n(), vectors.ncols()));
        let (mut re, mut im): (Vec<_>, Vec<_>) =
            blocks.into_iter().map(|Block { re, im }| (re.as_mut(), im.as_mut())).unzip();
        self.merged.times_into(vectors.re.as_ref(), &mut re);
        self.merged.times_into(vectors.im.as_ref(), &mut im);
        let modal = |part: &Mat<f64>| modal_times(self.damping, part.as_ref());
        if let Some(modal) = Block::both(modal(&vectors.re), modal(&vectors.im)) {
            match damped {
                Some(damped) => damped.add_scaled(&vec![c64::new(1.0, 0.0); modal.ncols()], &modal),
                None => *damped = Some(modal),
            }
        }
    }

    /// y\[:, j\] += W (k + s c) Wᵀ x\[:, j\], with k and c transposed for the left side.
    fn add_interface(&self, s: &[c64], with_stiffness: bool, side: Side, x: &Block, y: &mut Block) {
        for (j, s) in s.iter().enumerate() {
            let motion = self.interface.motions(x.re.col_as_slice(j), x.im.col_as_slice(j));
            let mut force = vec![c64::new(0.0, 0.0); motion.len()];
            for term in &self.interface.terms {
                let (to, from) = match side {
                    Side::Right => (term.row, term.column),
                    Side::Left => (term.column, term.row),
                };
                let k = if with_stiffness { term.stiffness } else { 0.0 };
                force[to] += motion[from] * (c64::new(k, 0.0) + *s * c64::new(term.damping, 0.0));
            }
            for (direction, force) in self.interface.directions.iter().zip(&force) {
                direction.add_to(force.re, y.re.col_as_slice_mut(j));
                direction.add_to(force.im, y.im.col_as_slice_mut(j));
            }
        }
    }

    /// y\[:, j\] += (sⱼ (C + C_c) + iH + K_c) xⱼ; for the left side iH is conjugated, C_c and K_c are transposed.
    pub(super) fn add_rest(&self, side: Side, s: &[c64], x: &Images, y: &mut Block) {
        if let Some(damped) = &x.damped {
            y.add_scaled(s, damped);
        }
        if let Some(lossy) = &x.lossy {
            let i = c64::new(0.0, if side == Side::Right { 1.0 } else { -1.0 });
            y.add_scaled(&vec![i; s.len()], lossy);
        }
        self.add_interface(s, true, side, &x.vectors, y);
    }

    /// Q(λⱼ) xⱼ, or Q(λⱼ)ᴴ xⱼ.
    pub(super) fn value(&self, side: Side, lambda: &[c64], x: &Images) -> Block {
        let mut value = Block::default();
        self.value_into(side, lambda, x, &mut value);
        value
    }

    /// [`Operator::value`] in the memory of `value`.
    pub(super) fn value_into(&self, side: Side, lambda: &[c64], x: &Images, value: &mut Block) {
        let s = on_side(side, lambda);
        value.copy_from(&x.elastic);
        value.add_scaled(&s.iter().map(|s| s * s).collect::<Vec<_>>(), &x.inertia);
        self.add_rest(side, &s, x, value);
    }

    /// Q′(λⱼ) xⱼ = (2λⱼM + C + C_c) xⱼ, or Q′(λⱼ)ᴴ xⱼ.
    pub(super) fn slope(&self, side: Side, lambda: &[c64], x: &Images) -> Block {
        let one = vec![c64::new(1.0, 0.0); lambda.len()];
        let mut slope = Block::zeros(self.n(), lambda.len());
        slope.add_scaled(&on_side(side, lambda).iter().map(|s| s * 2.0).collect::<Vec<_>>(), &x.inertia);
        if let Some(damped) = &x.damped {
            slope.add_scaled(&one, damped);
        }
        self.add_interface(&one, false, side, &x.vectors, &mut slope);
        slope
    }

    /// ψⱼᴴQ(λⱼ)xⱼ.
    pub(super) fn form(&self, lambda: &[c64], left: &Block, x: &Images) -> Vec<c64> {
        let one = |j: usize| {
            let s = lambda[j];
            let mut sum = s * s * left.dot(j, &x.inertia) + left.dot(j, &x.elastic);
            if let Some(damped) = &x.damped {
                sum += s * left.dot(j, damped);
            }
            if let Some(lossy) = &x.lossy {
                sum += c64::new(0.0, 1.0) * left.dot(j, lossy);
            }
            sum + self.between(j, left, &x.vectors, |term| s * term.damping + term.stiffness)
        };
        (0..lambda.len()).into_par_iter().map(one).collect()
    }

    /// ψⱼᴴQ′(λⱼ)φⱼ.
    pub(super) fn steepness(&self, lambda: &[c64], left: &Block, right: &Images) -> Vec<c64> {
        let one = |j: usize| {
            let mut sum = lambda[j] * 2.0 * left.dot(j, &right.inertia);
            if let Some(damped) = &right.damped {
                sum += left.dot(j, damped);
            }
            sum + self.between(j, left, &right.vectors, |term| c64::new(term.damping, 0.0))
        };
        (0..lambda.len()).into_par_iter().map(one).collect()
    }

    /// Σ (Wᵀψⱼ)ᴴ_row value (Wᵀxⱼ)_column over the terms of the interface.
    fn between(&self, j: usize, left: &Block, x: &Block, value: impl Fn(&Term) -> c64) -> c64 {
        let motions = |x: &Block| self.interface.motions(x.re.col_as_slice(j), x.im.col_as_slice(j));
        let (to, from) = (motions(left), motions(x));
        self.interface.terms.iter().map(|t| to[t.row].conj() * from[t.column] * value(t)).sum()
    }

    /// |λ|²‖M‖ + |λ|‖C‖ + ‖K‖ in the 1-norm; modal damping and contact left out, so that η is never flattered.
    pub(super) fn size(&self, lambda: c64) -> f64 {
        let r = lambda.norm();
        r * r * self.mass_norm + r * self.damping_norm + self.stiffness_norm
    }
}

/// λ, or its conjugate for the left side.
fn on_side(side: Side, lambda: &[c64]) -> Vec<c64> {
    lambda.iter().map(|z| if side == Side::Right { *z } else { z.conj() }).collect()
}

/// C x of viscous and modal damping; `None` when there is neither.
pub(super) fn damping_times(damping: &Damping, x: MatRef<'_, f64>) -> Option<Mat<f64>> {
    let viscous = damping.viscous.as_ref().map(|c| times(c, x));
    match (viscous, modal_times(damping, x)) {
        (Some(viscous), Some(modal)) => Some(viscous + modal),
        (viscous, modal) => viscous.or(modal),
    }
}

/// C x of modal damping.
fn modal_times(damping: &Damping, x: MatRef<'_, f64>) -> Option<Mat<f64>> {
    let modal = damping.modal.as_ref()?;
    let mut amplitudes = gram(modal.basis.as_ref(), x);
    for (i, c) in modal.coefficients.iter().enumerate() {
        (0..amplitudes.ncols()).for_each(|j| amplitudes[(i, j)] *= c);
    }
    Some(expand(modal.basis.as_ref(), amplitudes.as_ref()))
}
