//! The operator Q(λ), applied without forming it.

use super::block::Block;
use super::damper::{Between, Damper, DamperPart, modal_times};
use super::interface::{Interface, InterfaceTerm};
use crate::equilibrium::{SteadySliding, tangent_stiffness};
use crate::error::Result;
use crate::linalg::multivector::Columns;
use crate::linalg::proportional::Proportional;
use crate::linalg::shared_pattern::{PerMatrix, SharedPattern};
use crate::linalg::sparse::{norm_1, times};
use crate::linalg::{Engine, SparseMatrix, c64};
use crate::system::{Damping, Skew, System};
use faer::{Mat, MatRef};
use rayon::prelude::*;
use std::borrow::Cow;
use std::sync::Arc;

/// The quadratic operator of a system of n degrees of freedom about steady sliding,
///
/// Q(λ) = λ² M + λ (C + G + C_c) + K + K_σ + N + iH + K_c,
///
/// with the structure's M, C, K and loss factors H, the geometric stiffness K_σ of the preload, the sparse skew parts G (gyroscopic) and N
/// (circulatory), and the linearised contacts K_c = W k Wᵀ, C_c = W c Wᵀ. Products cost one pass over the sparse matrices.
pub struct Operator<'a> {
    pub(crate) mass: &'a SparseMatrix,
    /// K + K_σ.
    pub(crate) stiffness: Cow<'a, SparseMatrix>,
    pub(crate) damping: &'a Damping,
    /// Where the matrices are factorised.
    pub(crate) engine: &'a Engine,
    pub(crate) interface: Interface<'a>,
    /// The sparse skew parts of K and C.
    pub(crate) skew: Option<&'a Skew>,
    /// The damping of the structure and others that may take part, taken apart.
    pub(crate) dampers: Arc<Vec<Damper<'a>>>,
    /// How much of each acts.
    weights: Vec<f64>,
    /// M, K + K_σ, and what is wide of C and H.
    shared: Arc<SharedPattern<'a>>,
    mass_norm: f64,
    damping_norm: f64,
    stiffness_norm: f64,
    /// Those of K_c and C_c.
    contact_norms: [f64; 2],
}

/// Bilinear forms of the matrices of the structure with two vectors: yᴴMx, yᴴ(K + K_σ)x, yᴴCx with modal damping, yᴴHx.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Forms {
    pub(crate) mass: c64,
    pub(crate) stiffness: c64,
    pub(crate) damping: c64,
    pub(crate) loss: c64,
}

/// m M + k (K + K_σ) + c (C + C_c) + h H + w K_c.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sum {
    pub(crate) mass: c64,
    pub(crate) stiffness: c64,
    pub(crate) damping: c64,
    pub(crate) loss: c64,
    pub(crate) contact: c64,
}

/// Dissipative matrix: C or H.
#[derive(Debug, Clone, Copy)]
enum Loss {
    Viscous,
    Hysteretic,
}

impl Loss {
    const BOTH: [Loss; 2] = [Loss::Viscous, Loss::Hysteretic];

    fn part<'d>(self, damper: &'d Damper<'_>) -> &'d DamperPart {
        match self {
            Loss::Viscous => &damper.viscous,
            Loss::Hysteretic => &damper.loss,
        }
    }

    fn factor(self, sum: &Sum) -> c64 {
        match self {
            Loss::Viscous => sum.damping,
            Loss::Hysteretic => sum.loss,
        }
    }

    fn of(self, forms: &mut Forms) -> &mut c64 {
        match self {
            Loss::Viscous => &mut forms.damping,
            Loss::Hysteretic => &mut forms.loss,
        }
    }
}

const ONE: c64 = c64::new(1.0, 0.0);
const ZERO: c64 = c64::new(0.0, 0.0);

impl Sum {
    /// Q(λ), or for the left side what Q(λ)ᴴ is made of.
    pub(crate) fn value(side: Side, lambda: c64) -> Self {
        let s = side.of(lambda);
        Sum { mass: s * s, stiffness: ONE, damping: s, loss: side.of(c64::new(0.0, 1.0)), contact: ONE }
    }

    /// Q′(λ) = 2λM + C + C_c, or for the left side what Q′(λ)ᴴ is made of.
    pub(crate) fn slope(side: Side, lambda: c64) -> Self {
        Sum { mass: side.of(lambda) * 2.0, damping: ONE, ..Sum::default() }
    }
}

impl Forms {
    /// (y + z)ᴴX(y + z) of every matrix, given yᴴXy, yᴴXz and zᴴXz: all matrices are real and symmetric.
    pub(crate) fn of_sum(own: Forms, mixed: Forms, other: Forms) -> Self {
        let sum = |pick: fn(&Forms) -> c64| pick(&own) + 2.0 * pick(&mixed).re + pick(&other);
        Forms {
            mass: sum(|f| f.mass),
            stiffness: sum(|f| f.stiffness),
            damping: sum(|f| f.damping),
            loss: sum(|f| f.loss),
        }
    }

    /// Those of the vectors scaled by the root of `factor` each.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        let Forms { mass, stiffness, damping, loss } = *self;
        Forms {
            mass: mass * factor,
            stiffness: stiffness * factor,
            damping: damping * factor,
            loss: loss * factor,
        }
    }
}

/// Which vectors an operator acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
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

/// A sparse skew part, and what multiplies it in a sum.
type SkewPart<'a> = (&'a SparseMatrix, fn(&Sum) -> c64);

impl<'a> Operator<'a> {
    /// That of `system` about its steady state.
    ///
    /// # Errors
    /// A geometric stiffness that cannot be worked out.
    pub fn new(system: &'a System, steady: &SteadySliding) -> Result<Self> {
        let stiffness = tangent_stiffness(system, &steady.displacement)?;
        Ok(Operator::with_interface(system, stiffness, Interface::new(system, steady), &[]))
    }

    /// The operator with the tangent stiffness `stiffness`, another interface, and `further` dampings, none of which acts.
    pub(crate) fn with_interface(
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
        let shared = match &stiffness {
            Cow::Borrowed(stiffness) if sparse.len() == 2 => SharedPattern::new(&[mass, stiffness]),
            _ => SharedPattern::new(&sparse).into_owned(),
        };
        Operator {
            shared: Arc::new(shared),
            mass,
            mass_norm: norm_1(mass),
            damping_norm: norm(&damping.viscous) + system.skew().map_or(0.0, |skew| norm_1(&skew.damping)),
            stiffness_norm: norm_1(&stiffness)
                + norm(&damping.hysteretic)
                + system.skew().map_or(0.0, |skew| norm_1(&skew.stiffness)),
            contact_norms: interface.norms(),
            weights: only_first(dampers.len()),
            dampers: Arc::new(dampers),
            stiffness,
            damping,
            engine: &system.structure.engine,
            interface,
            skew: system.skew(),
        }
    }

    /// The same operator whose interface has other terms between the same directions, with `weights` for its dampings:
    /// those that are missing are one for the first and none for the others.
    pub(crate) fn with_terms(&self, terms: Vec<InterfaceTerm>, weights: &[f64]) -> Operator<'_> {
        let interface = Interface { directions: self.interface.directions.clone(), terms };
        let mut all = only_first(self.dampers.len());
        all.iter_mut().zip(weights).for_each(|(all, weight)| *all = *weight);
        let (stiffness, shared) = (Cow::Borrowed(&*self.stiffness), Arc::clone(&self.shared));
        let (contact_norms, dampers) = (interface.norms(), Arc::clone(&self.dampers));
        Operator { stiffness, interface, shared, dampers, weights: all, contact_norms, ..*self }
    }

    /// The number of degrees of freedom.
    pub fn n(&self) -> usize {
        self.mass.nrows()
    }

    /// The dampings that act, with their weights.
    fn acting(&self) -> impl Iterator<Item = (f64, &Damper<'a>)> {
        self.weights.iter().copied().zip(&*self.dampers).filter(|(weight, _)| *weight != 0.0)
    }

    /// BᵀMY, BᵀKY, BᵀCY and BᵀHY of the structure's own damping, modal damping included; `images` is memory for the next
    /// call.
    pub(crate) fn forms(
        &self,
        b: Columns<'_>,
        y: MatRef<'_, f64>,
        images: &mut Vec<Mat<f64>>,
    ) -> [Mat<f64>; 4] {
        self.shared.times(y, images);
        let [mass, stiffness] = [0, 1].map(|k| b.gram(images[k].as_ref()));
        let own = &self.dampers[0];
        let of = Between { b, y, mass: mass.as_ref(), stiffness: stiffness.as_ref() };
        let [damping, loss] = [own.viscous_form(&of), own.loss.form(&of)];
        [mass, stiffness, damping, loss]
    }

    /// BᵀXY of the sparse skew parts X of K and C; none where there are none.
    pub(crate) fn skew_between(&self, b: Columns<'_>, y: MatRef<'_, f64>) -> Vec<Mat<f64>> {
        // A product with a matrix stored by columns is that with its transpose.
        let between = |(matrix, _): SkewPart<'_>| -> Mat<f64> { -b.gram(times(matrix, y).as_ref()) };
        self.skew_parts().map(between).collect()
    }

    /// yⱼ += sumⱼ xⱼ for the right side, and for the left with C_c and K_c transposed. Gives what the matrices are between
    /// each of `tests` and x, pair by pair.
    pub(crate) fn add_products(
        &self,
        side: Side,
        sums: &[Sum],
        x: &Block,
        y: &mut Block,
        tests: &[&Block],
    ) -> Vec<Vec<Forms>> {
        let of_images: Vec<[c64; 2]> = sums.iter().map(|sum| self.of_images(sum)).collect();
        let mut factors: Vec<Vec<c64>> = (0..2).map(|a| of_images.iter().map(|f| f[a]).collect()).collect();
        for loss in self.shared_losses() {
            factors.push(sums.iter().map(|sum| loss.factor(sum) * self.weights[0]).collect());
        }
        let parts: Vec<_> = tests.iter().map(|t| t.parts()).collect();
        let between = self.shared.add_weighed(&factors, x.parts(), y.parts_mut(), &parts);
        let mut forms: Vec<Vec<Forms>> =
            between.iter().map(|of| of.iter().map(|entries| self.forms_of(entries)).collect()).collect();
        self.add_others(1, side, sums, x, y, (tests, &mut forms));
        forms
    }

    /// Those whose wide parts share the pattern of M and K.
    fn shared_losses(&self) -> impl Iterator<Item = Loss> {
        Loss::BOTH.into_iter().filter(|loss| loss.part(&self.dampers[0]).wide().is_some())
    }

    /// The part of the forms that the matrices with shared pattern give.
    fn forms_of(&self, entries: &PerMatrix) -> Forms {
        let [mass, stiffness, ref wide @ ..] = *entries;
        let mut forms = Forms { mass, stiffness, ..Forms::default() };
        for (loss, entry) in self.shared_losses().zip(wide) {
            *loss.of(&mut forms) += entry * self.weights[0];
        }
        for (weight, damper) in self.acting() {
            for loss in Loss::BOTH {
                let Proportional { mass_factor, stiffness_factor, .. } = loss.part(damper).split;
                *loss.of(&mut forms) += (mass * mass_factor + stiffness * stiffness_factor) * weight;
            }
        }
        forms
    }

    /// The factors of M x and K x in a sum.
    fn of_images(&self, sum: &Sum) -> [c64; 2] {
        let mut factors = [sum.mass, sum.stiffness];
        for (weight, damper) in self.acting() {
            for loss in Loss::BOTH {
                let Proportional { mass_factor, stiffness_factor, .. } = loss.part(damper).split;
                factors[0] += loss.factor(sum) * weight * mass_factor;
                factors[1] += loss.factor(sum) * weight * stiffness_factor;
            }
        }
        factors
    }

    /// Adds to y and to the forms what does not follow from M x and K x: few rows, modal damping, the wide parts of the dampings
    /// from number `first` on, and to y the interface.
    fn add_others(
        &self,
        first: usize,
        side: Side,
        sums: &[Sum],
        x: &Block,
        y: &mut Block,
        (tests, forms): (&[&Block], &mut [Vec<Forms>]),
    ) {
        for (k, (weight, damper)) in self.weights.iter().zip(&*self.dampers).enumerate() {
            if *weight == 0.0 {
                continue;
            }
            for loss in Loss::BOTH {
                let part = loss.part(damper);
                let factors: Vec<c64> = sums.iter().map(|sum| loss.factor(sum) * *weight).collect();
                let wide = part.wide().filter(|_| k >= first).map(|a| x.map(|x| times(a, x)));
                let modal = damper.modal.filter(|_| matches!(loss, Loss::Viscous));
                let modal = modal.map(|modal| x.map(|x| modal_times(modal, x)));
                let few = part.few.as_ref().map(|few| (few.rows(), x.map(|x| few.times(x))));
                for image in wide.iter().chain(&modal) {
                    y.add_scaled(&factors, image);
                }
                if let Some((rows, image)) = &few {
                    y.add_rows(&factors, rows, image);
                }
                for (test, forms) in tests.iter().zip(forms.iter_mut()) {
                    for (j, forms) in forms.iter_mut().enumerate() {
                        let of_all = wide.iter().chain(&modal).map(|image| test.dot(j, image));
                        let of_few = few.iter().map(|(rows, image)| test.dot_rows(j, rows, image));
                        *loss.of(forms) += of_all.chain(of_few).sum::<c64>() * *weight;
                    }
                }
            }
        }
        for (matrix, factor) in self.skew_parts() {
            // A product with a matrix stored by columns is that with its transpose.
            let sign = if side == Side::Right { -1.0 } else { 1.0 };
            let factors: Vec<c64> = sums.iter().map(|sum| factor(sum) * sign).collect();
            y.add_scaled(&factors, &x.map(|x| times(matrix, x)));
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

    /// The sparse skew parts of K and C, and what multiplies them in a sum.
    fn skew_parts(&self) -> impl Iterator<Item = SkewPart<'a>> {
        let parts = |skew: &'a Skew| -> [SkewPart<'a>; 2] {
            [(&skew.stiffness, |sum| sum.contact), (&skew.damping, |sum| sum.damping)]
        };
        self.skew.map(parts).into_iter().flatten()
    }

    /// xⱼᴴK_k xⱼ / i and xⱼᴴC_k xⱼ / i of the sparse skew parts, which are real.
    pub(crate) fn skew_forms(&self, x: &Block) -> Vec<[f64; 2]> {
        let mut forms = vec![[0.0; 2]; x.ncols()];
        for (which, (matrix, _)) in self.skew_parts().enumerate() {
            let image = x.map(|x| times(matrix, x));
            (0..x.ncols()).for_each(|j| forms[j][which] = -x.dot(j, &image).im);
        }
        forms
    }

    /// Coupling of the real modes, (sⱼ (C_r + C_c) + iH_r + K_c) xⱼ, where C_r and H_r are C and H but for what is
    /// proportional in them; for the left side iH is conjugated, C_c and K_c are transposed.
    pub(crate) fn coupling(&self, side: Side, s: &[c64], x: &Block) -> Block {
        let sum = |s: &c64| Sum { mass: ZERO, stiffness: ZERO, ..Sum::value(side, *s) };
        let sums: Vec<Sum> = s.iter().map(sum).collect();
        let mut y = Block::zeros(self.n(), s.len());
        self.add_others(0, side, &sums, x, &mut y, (&[], &mut []));
        y
    }

    /// Q(λⱼ) xⱼ, or Q(λⱼ)ᴴ xⱼ, of every column j.
    ///
    /// # Panics
    /// When x has not n rows and a column for each λ.
    pub fn value(&self, side: Side, lambda: &[c64], x: &Block) -> Block {
        let sums: Vec<Sum> = lambda.iter().map(|s| Sum::value(side, *s)).collect();
        let mut value = Block::zeros(self.n(), x.ncols());
        self.add_products(side, &sums, x, &mut value, &[]);
        value
    }

    /// y += Q(λⱼ) xⱼ, and what the matrices are between each of `tests` and x.
    pub(crate) fn add_value(
        &self,
        lambda: &[c64],
        x: &Block,
        y: &mut Block,
        tests: &[&Block],
    ) -> Vec<Vec<Forms>> {
        let sums: Vec<Sum> = lambda.iter().map(|s| Sum::value(Side::Right, *s)).collect();
        self.add_products(Side::Right, &sums, x, y, tests)
    }

    /// Q′(λⱼ) xⱼ = (2λⱼM + C + G + C_c) xⱼ, or Q′(λⱼ)ᴴ xⱼ.
    ///
    /// # Panics
    /// As [`Operator::value`].
    pub fn slope(&self, side: Side, lambda: &[c64], x: &Block) -> Block {
        let sums: Vec<Sum> = lambda.iter().map(|s| Sum::slope(side, *s)).collect();
        let mut slope = Block::zeros(self.n(), x.ncols());
        self.add_products(side, &sums, x, &mut slope, &[]);
        slope
    }

    /// ψⱼᴴQ′(λⱼ)φⱼ.
    pub(crate) fn steepness(&self, lambda: &[c64], left: &Block, right: &Block) -> Vec<c64> {
        let slope = self.slope(Side::Right, lambda, right);
        (0..lambda.len()).into_par_iter().map(|j| left.dot(j, &slope)).collect()
    }

    /// |λ|²‖M‖ + |λ|(‖C‖ + ‖C_c‖) + ‖K‖ + ‖K_c‖ in the 1-norm, skew parts included and modal damping left out: what ‖Q(λ)φ‖/‖φ‖ is
    /// measured by, as the backward error η.
    pub fn size(&self, lambda: c64) -> f64 {
        let (r, [contact, contact_damping]) = (lambda.norm(), self.contact_norms);
        r * r * self.mass_norm + r * (self.damping_norm + contact_damping) + self.stiffness_norm + contact
    }

    /// ‖K‖ + ‖K_c‖ in the 1-norm.
    pub(crate) fn stiffness_size(&self) -> f64 {
        self.stiffness_norm + self.contact_norms[0]
    }

    /// |φ|ᵀ|K + K_σ||φ|: the strain energy without cancellation.
    pub(crate) fn gross_stiffness(&self, [re, im]: [&[f64]; 2]) -> f64 {
        let size: Vec<f64> = re.iter().zip(im).map(|(re, im)| re.hypot(*im)).collect();
        let column = |j: usize| {
            let entries = self.stiffness.row_idx_of_col(j).zip(self.stiffness.val_of_col(j));
            entries.map(|(i, k)| size[i] * k.abs()).sum::<f64>() * size[j]
        };
        (0..size.len()).map(column).sum()
    }
}

/// One for the first, none of the others.
fn only_first(count: usize) -> Vec<f64> {
    (0..count).map(|k| if k == 0 { 1.0 } else { 0.0 }).collect()
}
